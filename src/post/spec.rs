//! The keys of a resolved post file, in types; [`super::schema`] documents every key.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::comment::Comments;
use crate::target::number::Point;
use crate::units::LengthUnit;

/// A value that may differ between millimetre and inch programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(untagged)]
pub enum ByUnit<T> {
    /// The same for both.
    Same(T),
    /// One for each.
    Each {
        /// In millimetre programs.
        mm: T,
        /// In inch programs.
        inch: T,
    },
}

impl<T: Clone> ByUnit<T> {
    /// The value for programs in `unit`.
    #[must_use]
    pub fn of(&self, unit: LengthUnit) -> T {
        match (self, unit) {
            (ByUnit::Same(value), _)
            | (ByUnit::Each { mm: value, .. }, LengthUnit::Millimetre)
            | (ByUnit::Each { inch: value, .. }, LengthUnit::Inch) => value.clone(),
        }
    }
}

/// Who a post is.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)] // The schema documents every key.
pub struct Post {
    pub title: String,
    pub extension: String,
    pub control: String,
    #[serde(default)]
    pub control_when: BTreeMap<String, String>,
    pub confidence: String,
    pub basis: String,
    #[serde(default, rename = "abstract")]
    pub is_abstract: bool,
}

/// A resolved post file; the keys are documented in [`super::schema`].
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct Spec {
    #[serde(default)]
    pub inherits: Option<String>,
    pub post: Post,
    pub file: File,
    pub line: Line,
    pub numbering: Numbering,
    pub numbers: Numbers,
    pub words: BTreeMap<String, Word>,
    pub modal: Modal,
    pub codes: Codes,
    pub patterns: Patterns,
    #[serde(default)]
    pub groups: BTreeMap<String, Group>,
    #[serde(default)]
    pub safe_start: Vec<Vec<String>>,
    pub arcs: Arcs,
    pub feed: Feed,
    pub rotary: Rotary,
    pub dwell: Dwell,
    pub cycle_dwell: CycleDwell,
    #[serde(default)]
    pub cycles: BTreeMap<String, Cycle>,
    pub spindle: Spindle,
    pub coolant: Coolant,
    pub compensation: Compensation,
    pub stops: Stops,
    pub comments: Comments,
    pub path_control: PathControl,
    pub nurbs: Nurbs,
    #[serde(default)]
    pub limits: Limits,
    pub tool_change: ToolChange,
    pub templates: Templates,
    #[serde(default)]
    pub options: BTreeMap<String, String>,
    #[serde(default)]
    pub option_values: BTreeMap<String, Vec<String>>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct File {
    pub newline: String,
    pub number: u32,
    pub name_max: usize,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct Line {
    pub max_length: usize,
    pub count_comments: bool,
    pub count_spaces: bool,
    pub separator: String,
    pub continuation: String,
    #[serde(default)]
    pub end: String,
}

/// Which lines carry a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs)]
pub enum NumberingMode {
    None,
    Blocks,
    Lines,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct Numbering {
    pub mode: NumberingMode,
    pub prefix: String,
    pub start: u32,
    pub step: u32,
    pub max: u32,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct Numbers {
    pub linear_decimals: ByUnit<u8>,
    pub point: Point,
    pub trailing_zeros: bool,
    pub bare_fraction: bool,
    pub plus: bool,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct Word {
    pub prefix: String,
    #[serde(default)]
    pub suffix: Option<ByUnit<String>>,
    #[serde(default)]
    pub decimals: Option<ByUnit<u8>>,
    #[serde(default)]
    pub max: Option<ByUnit<f64>>,
    #[serde(default)]
    pub point: Option<Point>,
    #[serde(default)]
    pub trailing_zeros: Option<bool>,
    #[serde(default)]
    pub bare_fraction: Option<bool>,
    #[serde(default)]
    pub plus: Option<bool>,
    #[serde(default)]
    pub modal: Option<bool>,
    #[serde(default)]
    pub exponent_from: Option<f64>,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct Modal {
    pub motion: bool,
    pub axes: bool,
    pub arc_ends: bool,
    pub whole_points: bool,
    pub feed: bool,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct Codes {
    pub rapid: String,
    pub line: String,
    pub arc_cw: String,
    pub arc_ccw: String,
    #[serde(default)]
    pub direction_cw: String,
    #[serde(default)]
    pub direction_ccw: String,
    pub plane_xy: String,
    pub plane_zx: String,
    pub plane_yz: String,
    pub per_minute: String,
    pub per_revolution: String,
    pub inverse_time: String,
    #[serde(default)]
    pub insert: String,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct Patterns {
    pub rapid: Vec<String>,
    pub line: Vec<String>,
    pub arc: Vec<String>,
    #[serde(default)]
    pub arc_zx: Vec<String>,
    #[serde(default)]
    pub arc_yz: Vec<String>,
    #[serde(default)]
    pub helix: Vec<String>,
    #[serde(default)]
    pub hole: Vec<String>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct Group {
    #[serde(default)]
    pub codes: Vec<String>,
    pub start: ByUnit<String>,
    #[serde(default)]
    pub option: String,
    #[serde(default)]
    pub more: String,
    #[serde(default)]
    pub more_from: u32,
    #[serde(default)]
    pub more_count: u32,
}

impl Group {
    /// The code that a program starts with: the one that the group's option counts to from 1, else `start`. `None` when
    /// the control has none of that number.
    #[must_use]
    pub fn chosen(&self, unit: LengthUnit, options: &BTreeMap<String, String>) -> Option<String> {
        let start = self.start.of(unit);
        let Some(wanted) = Spec::option(options, &self.option).filter(|value| !value.is_empty()) else {
            return Some(start);
        };
        let index = wanted.parse::<usize>().ok()?.checked_sub(1)?;
        if start.is_empty() {
            return None;
        }
        if let Some(code) = self.codes.get(index) {
            return Some(code.clone());
        }
        let further = u32::try_from(index - self.codes.len()).ok().filter(|n| *n < self.more_count)?;
        Some(format!("{}{}", self.more, self.more_from.checked_add(further)?))
    }

    /// Which of the group's codes this is, counted from 1 as its option counts them.
    #[must_use]
    pub fn count(&self, code: &str) -> Option<u16> {
        let plain = self.codes.iter().position(|c| c == code);
        let further = || {
            let number: u32 =
                code.strip_prefix(&self.more).filter(|_| !self.more.is_empty())?.parse().ok()?;
            let further = number.checked_sub(self.more_from).filter(|n| *n < self.more_count)?;
            Some(self.codes.len() + further as usize)
        };
        u16::try_from(plain.or_else(further)? + 1).ok()
    }
}

/// Which end words a full circle carries.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs)]
pub enum FullCircleWords {
    Bare,
    OneEndWord,
    EndWords,
    Split,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct Arcs {
    pub enabled: bool,
    pub planes: Vec<String>,
    pub zero_offsets: String,
    pub signed_radius: bool,
    pub full_circle: FullCircleWords,
    pub split: u8,
    pub max_sweep: f64,
    pub min_radius: f64,
    pub max_radius: f64,
    pub radius_tolerance: f64,
    pub helix: bool,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct Feed {
    pub scale: ByUnit<f64>,
    pub rapid: f64,
    pub per_revolution: bool,
    pub inverse_time: bool,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct Rotary {
    pub enabled: ByUnit<bool>,
    pub letter: String,
    pub letters: String,
    pub feed: String,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct Dwell {
    pub block: Vec<String>,
    pub unit: DwellUnit,
    pub decimals: u8,
    pub max: f64,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct CycleDwell {
    pub unit: DwellUnit,
    pub decimals: u8,
    pub max: f64,
}

/// What a dwell's number counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[allow(missing_docs)]
pub enum DwellUnit {
    #[serde(rename = "s")]
    Seconds,
    #[serde(rename = "ms")]
    Milliseconds,
    #[serde(rename = "0.01s")]
    Hundredths,
    /// A setting of the machine that the option `DWELL` declares.
    #[serde(rename = "option")]
    Declared,
}

/// A drilling cycle that the control keeps.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct Cycle {
    #[serde(default)]
    pub before: String,
    #[serde(default)]
    pub call: String,
    #[serde(default)]
    pub words: String,
    #[serde(default)]
    pub end: String,
    #[serde(default)]
    pub dwell: bool,
    #[serde(default = "yes")]
    pub enabled: bool,
}

fn yes() -> bool {
    true
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct Spindle {
    pub clockwise: String,
    pub counter_clockwise: String,
    pub on: Vec<String>,
    #[serde(default)]
    pub after_tool_change: Vec<String>,
    #[serde(default)]
    pub range: String,
    pub off: String,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct Coolant {
    pub flood: String,
    pub mist: String,
    pub off: String,
    #[serde(default)]
    pub through: String,
    #[serde(default)]
    pub through_off: String,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct Compensation {
    pub left: Vec<String>,
    pub right: Vec<String>,
    pub off: Vec<String>,
    #[serde(default)]
    pub off_alone: Vec<String>,
    pub every_move: bool,
    pub register: String,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct Stops {
    pub stop: String,
    pub optional: String,
    pub restart: bool,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct PathControl {
    pub exact: Vec<String>,
    pub tolerance: Vec<String>,
    pub share: f64,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct Nurbs {
    pub knots: String,
    pub begin: Vec<String>,
    pub point: Vec<String>,
    pub rest: Vec<String>,
    pub end: Vec<String>,
    pub between: Vec<String>,
    pub weight_decimals: u8,
    pub knot_decimals: u8,
    pub max_order: u8,
    #[serde(default)]
    pub chord: f64,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct Limits {
    #[serde(default)]
    pub x: Option<[f64; 2]>,
    #[serde(default)]
    pub y: Option<[f64; 2]>,
    #[serde(default)]
    pub z: Option<[f64; 2]>,
    #[serde(default)]
    pub spindle: Option<[f64; 2]>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct ToolChange {
    pub parks: bool,
    pub parks_with: String,
    pub with_first_z: String,
    pub order: Vec<String>,
    pub blocks: BTreeMap<String, String>,
}

impl ToolChange {
    /// Whether a change leaves Z at its upper end, with these options.
    #[must_use]
    pub fn parks_with(&self, options: &BTreeMap<String, String>) -> bool {
        let name = self.parks_with.as_str();
        let value =
            options.iter().find(|(option, _)| option.eq_ignore_ascii_case(name)).map(|(_, value)| value);
        self.parks && (name.is_empty() || value.is_some_and(|value| !value.is_empty()))
    }
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[allow(missing_docs)]
pub struct Templates {
    pub header: String,
    pub footer: String,
    pub operation: String,
}
