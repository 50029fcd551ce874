//! A resolved dialect: the post file and everything it inherits, in types.

use std::collections::BTreeMap;

use super::pattern::Coefficient;
pub use super::spec::{ByUnit, Cycle, DwellUnit, FullCircleWords, NumberingMode, Spec, Word};
use super::tree::Table;
use crate::target::number::Style;
use crate::units::LengthUnit;

/// A dialect, ready for lowering and writing.
#[derive(Debug, Clone)]
pub struct Dialect {
    /// The name it was asked for by: `fanuc`, or the stem of a post file.
    pub(super) name: String,
    pub(super) spec: Spec,
    /// The merged tree, for places.
    pub(super) tree: Table,
    /// The files that were merged, from the child to the parent.
    pub(super) lineage: Vec<String>,
    /// The file that was asked for.
    pub(super) leaf: crate::source::FileId,
}

impl Dialect {
    /// The name on the command line, or the stem of the post file.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }
    /// Control and series, for people.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.spec.post.title
    }
    /// Extension of the NC file, without the point.
    #[must_use]
    pub fn extension(&self) -> &str {
        &self.spec.post.extension
    }
    /// The control that reads the program back for the proof.
    #[must_use]
    pub fn control(&self) -> &str {
        &self.spec.post.control
    }
    /// The control that reads a program back whose options these are.
    #[must_use]
    pub fn control_with(&self, options: &BTreeMap<String, String>) -> &str {
        let says = |when: &str| {
            when.split_once('=').is_some_and(|(name, value)| {
                Spec::option(options, name.trim()).is_some_and(|v| v.eq_ignore_ascii_case(value.trim()))
            })
        };
        let special = self.spec.post.control_when.iter().find(|(when, _)| says(when));
        special.map_or(&self.spec.post.control, |(_, control)| control)
    }
    /// How sure the facts are: `interpreter`, `manual` or `published`.
    #[must_use]
    pub fn confidence(&self) -> &str {
        &self.spec.post.confidence
    }
    /// What the facts rest on.
    #[must_use]
    pub fn basis(&self) -> &str {
        &self.spec.post.basis
    }
    /// The files it was made of, from the child to the parent; built-in ones by name.
    #[must_use]
    pub fn lineage(&self) -> &[String] {
        &self.lineage
    }
    /// The resolved data.
    #[must_use]
    pub fn spec(&self) -> &Spec {
        &self.spec
    }
}

/// Words on the grid of the linear axes.
const LINEAR_WORDS: [&str; 13] = ["x", "y", "z", "i", "j", "k", "cx", "cy", "cz", "mx", "my", "mz", "radius"];

impl Spec {
    /// Decimals of a word in programs in `unit`; 0 where there is no such word.
    #[must_use]
    pub fn decimals(&self, word: &str, unit: LengthUnit) -> u8 {
        let own = self.words.get(word).and_then(|w| w.decimals);
        let linear = LINEAR_WORDS.contains(&word) || Coefficient::by_name(word).is_some();
        let shared = linear.then_some(self.numbers.linear_decimals);
        own.or(shared).map_or(0, |d| d.of(unit))
    }
    /// The coefficients that blocks of cubic pieces say; none where curves have another form.
    pub fn coefficients(&self) -> impl Iterator<Item = Coefficient> {
        let pieces = self.nurbs.knots == "pieces";
        self.nurbs.point.iter().filter(move |_| pieces).filter_map(|item| Coefficient::by_name(item))
    }
    /// Largest printed magnitude of a word, in its steps.
    #[must_use]
    pub fn range(&self, word: &str, unit: LengthUnit) -> i64 {
        let limit = self.words.get(word).and_then(|w| w.max).map_or(f64::INFINITY, |m| m.of(unit));
        crate::target::number::steps(limit, self.decimals(word, unit)).unwrap_or(1_000_000_000_000_000)
    }
    /// Whether straight moves have a place for what cutter compensation says; else it has blocks of its own.
    #[must_use]
    pub fn compensation_in_moves(&self) -> bool {
        [&self.patterns.rapid, &self.patterns.line].iter().all(|p| p.iter().any(|i| i == "compensation"))
    }
    /// The value of an option, whatever its case.
    #[must_use]
    pub fn option<'a>(options: &'a BTreeMap<String, String>, name: &str) -> Option<&'a str> {
        options.iter().find(|(key, _)| key.eq_ignore_ascii_case(name)).map(|(_, value)| value.as_str())
    }
    /// Spelling of a word's number.
    #[must_use]
    pub fn style(&self, name: &str, word: &Word, unit: LengthUnit) -> Style {
        let decimals = self.decimals(name, unit);
        Style {
            decimals,
            point: word.point.unwrap_or(self.numbers.point),
            trailing_zeros: word.trailing_zeros.unwrap_or(self.numbers.trailing_zeros),
            bare_fraction: word.bare_fraction.unwrap_or(self.numbers.bare_fraction),
            plus: word.plus.unwrap_or(self.numbers.plus && decimals > 0),
            exponent_from: word
                .exponent_from
                .and_then(|from| crate::target::number::steps(from, decimals))
                .map_or(0, i64::unsigned_abs),
        }
    }
}
