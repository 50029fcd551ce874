//! Values of options: what `[options]` gives, what `MACHIN` and overrides give instead, and which values there are.

use std::collections::{BTreeMap, BTreeSet};

use super::check::{at, in_a_file, templates};
use super::dialect::{Dialect, Spec};
use super::load::is_override;
use super::template::Renderer;
use super::tree::{self, Node};
use crate::diag::{Diagnostic, codes, did_you_mean};
use crate::ir::Machine;
use crate::source::SourceMap;
use crate::target::number;
use crate::units::LengthUnit;

/// Options of `MACHIN` that are none of a post file: lowering knows them.
pub(super) const SHARE: &str = "SHARE";
const ROTABL: &str = "ROTABL";
/// In a list of values: a number without sign and point.
const INTEGER: &str = "<integer>";
/// Digits of an integer.
const DIGITS: usize = 9;

impl Spec {
    /// The value as templates see it: one of those that the option may have, spelled as the list spells it; a number
    /// as its word spells it. Every value of an option without a list.
    pub(super) fn option_value(&self, name: &str, value: &str, unit: LengthUnit) -> Option<String> {
        let Some(values) = self.allowed(name) else { return Some(value.to_owned()) };
        values.iter().find_map(|allowed| self.fits(allowed, value, unit))
    }

    /// The list of values of an option.
    fn allowed(&self, name: &str) -> Option<&[String]> {
        self.option_values.iter().find(|(key, _)| key.eq_ignore_ascii_case(name)).map(|(_, v)| v.as_slice())
    }

    fn fits(&self, allowed: &str, value: &str, unit: LengthUnit) -> Option<String> {
        if allowed == INTEGER {
            let plain = (1..=DIGITS).contains(&value.len()) && value.bytes().all(|b| b.is_ascii_digit());
            return plain.then(|| value.to_owned());
        }
        if let Some(name) = word_of(allowed) {
            let word = self.words.get(name)?;
            let style = self.style(name, word, unit);
            let steps = decimal(value).and_then(|v| number::steps(v, style.decimals))?;
            if steps.abs() > self.range(name, unit) {
                return None;
            }
            let mut out = Vec::new();
            number::push(&mut out, steps, &style);
            return String::from_utf8(out).ok();
        }
        allowed.eq_ignore_ascii_case(value).then(|| allowed.to_owned())
    }

    /// What a value that is none of those says of itself: the message, and what was probably meant.
    fn no_such_value(&self, name: &str, value: &str) -> (String, Option<String>) {
        let values = self.allowed(name).unwrap_or_default();
        let shown: Vec<String> = values.iter().map(|v| self.shown(v)).collect();
        let message =
            format!("`{}` is no value of the option `{name}`: {}", value.escape_debug(), listed(&shown));
        let near = did_you_mean(value, values.iter().map(String::as_str).filter(|v| !is_kind(v)));
        (message, near.map(|near| format!("did you mean `{near}`?")))
    }

    fn shown(&self, allowed: &str) -> String {
        match allowed {
            "" => "nothing".to_owned(),
            INTEGER => "an integer".to_owned(),
            kind if is_kind(kind) => {
                format!("a number as the word `{}` has it", word_of(kind).unwrap_or_default())
            }
            text => format!("`{text}`"),
        }
    }
}

/// `` `a`, `b` or `c` ``
fn listed(shown: &[String]) -> String {
    match shown {
        [rest @ .., last] if !rest.is_empty() => format!("it is {} or {last}", rest.join(", ")),
        all => format!("it is {}", all.concat()),
    }
}

/// The word whose numbers an entry of a list stands for: `<z>`.
fn word_of(allowed: &str) -> Option<&str> {
    allowed.strip_prefix('<')?.strip_suffix('>').filter(|name| !name.is_empty())
}

fn is_kind(allowed: &str) -> bool {
    word_of(allowed).is_some()
}

/// A decimal number without exponent.
fn decimal(text: &str) -> Option<f64> {
    let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
    let plain = digits.bytes().all(|b| b.is_ascii_digit() || b == b'.');
    (plain && digits.bytes().any(|b| b.is_ascii_digit())).then(|| text.parse().ok()).flatten()
}

impl Dialect {
    /// The post's options, with the machine's values: texts that stay on their line.
    ///
    /// # Errors
    /// An option that there is not, twice the same, or a value that the option does not have.
    pub(super) fn options(
        &self,
        machine: Option<&Machine>,
        unit: LengthUnit,
    ) -> Result<BTreeMap<String, String>, Diagnostic> {
        let mut options = self.spec.options.clone();
        let (mut given, mut bare) = (BTreeSet::new(), BTreeSet::new());
        for (key, value) in machine.iter().flat_map(|m| &m.options) {
            if !given.insert(key.to_ascii_uppercase()) {
                return Err(Diagnostic::global(
                    &codes::post::MACHINE_OPTION,
                    format!("the option `{key}` is given twice"),
                ));
            }
            if value.is_none() {
                bare.insert(key.to_ascii_uppercase());
            }
            match options.iter_mut().find(|(k, _)| k.eq_ignore_ascii_case(key)) {
                Some((_, slot)) => *slot = value.clone().unwrap_or_else(|| "yes".to_owned()),
                None if key.eq_ignore_ascii_case(SHARE) => {}
                None => return Err(self.unknown_option(key)),
            }
        }
        for (name, slot) in &mut options {
            *slot = self.spec.option_value(name, slot, unit).ok_or_else(|| {
                let (message, help) = self.spec.no_such_value(name, slot);
                let message = if bare.contains(&name.to_ascii_uppercase()) {
                    message.replacen(
                        "`yes` is no value of the option",
                        "there is no value behind the option",
                        1,
                    )
                } else {
                    message
                };
                let error = Diagnostic::global(&codes::post::OPTION_VALUE, message);
                help.into_iter().fold(error, Diagnostic::help)
            })?;
        }
        Ok(options)
    }

    fn unknown_option(&self, key: &str) -> Diagnostic {
        let known = || self.spec.options.keys().map(String::as_str).chain([SHARE, ROTABL]);
        let error = Diagnostic::global(
            &codes::post::MACHINE_OPTION,
            format!("the post `{}` has no option `{key}`", self.name),
        );
        match did_you_mean(key, known()) {
            Some(near) => error.help(format!("did you mean `{near}`?")),
            None => error.help(format!("its options are {}", known().collect::<Vec<_>>().join(", "))),
        }
    }

    /// Options that something of the post reads; `None` when a template may read any.
    pub(super) fn read_options(&self) -> Option<BTreeSet<String>> {
        let renderer = Renderer::new(&self.spec.comments);
        let read: BTreeSet<String> =
            templates(self).into_iter().flat_map(|(_, _, t)| renderer.variables(t)).collect();
        if read.contains("options") {
            return None;
        }
        let by_templates = read.iter().filter_map(|name| name.strip_prefix("options."));
        let proof =
            self.spec.post.control_when.keys().filter_map(|when| Some(when.split_once('=')?.0.trim()));
        let groups = self.spec.groups.values().map(|group| group.option.as_str());
        Some(by_templates.chain(proof).chain(groups).map(str::to_owned).collect())
    }
}

/// Options have values that they may have, and names that something reads.
pub(super) fn check(dialect: &Dialect, sources: &SourceMap, errors: &mut Vec<Diagnostic>) {
    let spec = &dialect.spec;
    for (name, values) in &spec.option_values {
        check_list(dialect, name, values, errors);
    }
    for (name, value) in &spec.options {
        let units = [LengthUnit::Millimetre, LengthUnit::Inch];
        if units.iter().any(|unit| spec.option_value(name, value, *unit).is_none()) {
            let (message, help) = spec.no_such_value(name, value);
            let error = at(dialect, &format!("options.{name}"), &codes::post::OPTION_VALUE, message);
            errors.push(help.into_iter().fold(error, Diagnostic::help));
        }
    }
    for when in spec.post.control_when.keys() {
        check_when(dialect, when, errors);
    }
    check_names(dialect, sources, errors);
}

/// A list is of an option that there is, and its values can be told apart.
fn check_list(dialect: &Dialect, name: &str, values: &[String], errors: &mut Vec<Diagnostic>) {
    let spec = &dialect.spec;
    let path = format!("option-values.{name}");
    let wrong = |message: String| at(dialect, &path, &codes::post::WRONG_VALUE, message);
    if !spec.options.contains_key(name) {
        let error = wrong(format!("`{path}` lists values of an option that is not in [options]"));
        let near = did_you_mean(name, spec.options.keys().map(String::as_str));
        errors.push(near.into_iter().fold(error, |e, n| e.help(format!("did you mean `{n}`?"))));
    }
    if values.is_empty() {
        errors.push(wrong(format!("`{path}` is empty: the option could have no value")));
    }
    for (index, value) in values.iter().enumerate() {
        if values.iter().take(index).any(|other| other.eq_ignore_ascii_case(value)) {
            errors.push(wrong(format!("`{path}` lists `{value}` twice; capitals make no difference")));
        }
        if let Some(word) =
            word_of(value).filter(|word| *value != *INTEGER && !spec.words.contains_key(*word))
        {
            let error =
                wrong(format!("`{path}` takes numbers as `{word}` has them, which is not in [words]"));
            let known = spec.words.keys().map(String::as_str).chain(["integer"]);
            let near = did_you_mean(word, known);
            errors.push(near.into_iter().fold(error, |e, n| e.help(format!("did you mean `<{n}>`?"))));
        }
    }
}

/// `OPTION=VALUE` names an option, and a value that it may have.
fn check_when(dialect: &Dialect, when: &str, errors: &mut Vec<Diagnostic>) {
    let spec = &dialect.spec;
    let mut wrong = |message: String, help: Option<String>| {
        // Names hold `=`, and points perhaps: they are looked up as they are.
        let place = match tree::find(&dialect.tree, "post.control-when").map(|entry| &entry.node) {
            Some(Node::Table(table)) => table.get(when).map(|entry| entry.key),
            _ => None,
        };
        let error = match place {
            Some(span) => Diagnostic::new(&codes::post::WRONG_VALUE, span, message),
            None => Diagnostic::global(&codes::post::WRONG_VALUE, message),
        };
        errors.push(help.into_iter().fold(error, Diagnostic::help));
    };
    let Some((name, value)) = when.split_once('=') else {
        return wrong(
            format!("`{when}` says no value of an option"),
            Some("write `\"NAME=VALUE\" = \"CONTROL\"`".to_owned()),
        );
    };
    let (name, value) = (name.trim(), value.trim());
    if Spec::option(&spec.options, name).is_none() {
        let near = did_you_mean(name, spec.options.keys().map(String::as_str));
        let help = near.map(|n| format!("did you mean `{n}`?"));
        return wrong(format!("`{when}` is about an option that is not in [options]"), help);
    }
    if spec.option_value(name, value, LengthUnit::Millimetre).is_none() {
        let (message, help) = spec.no_such_value(name, value);
        wrong(message, help);
    }
}

/// An option that nothing reads, and whose name is nearly that of another, is that one misspelt; an override does
/// not make options.
fn check_names(dialect: &Dialect, sources: &SourceMap, errors: &mut Vec<Diagnostic>) {
    let options = &dialect.spec.options;
    let Some(read) = dialect.read_options() else { return };
    let is_read = |name: &str| read.iter().any(|r| r == name);
    for name in options.keys().filter(|name| !is_read(name)) {
        let path = format!("options.{name}");
        let Some(entry) = tree::find(&dialect.tree, &path).filter(|_| in_a_file(dialect, &path)) else {
            continue;
        };
        let near = did_you_mean(name, options.keys().map(String::as_str).filter(|other| is_read(other)));
        let set = is_override(entry.key.file, sources);
        if near.is_none() && !set {
            continue;
        }
        let message = format!("the post `{}` has no option `{name}`", dialect.name);
        let error = Diagnostic::new(&codes::post::MACHINE_OPTION, entry.key, message);
        errors.push(match near {
            Some(near) => error.help(format!("did you mean `{near}`?")),
            None if read.is_empty() => error.help("it has no options"),
            None => {
                let known: Vec<&str> = options.keys().map(String::as_str).filter(|n| is_read(n)).collect();
                error.help(format!("its options are {}", known.join(", ")))
            }
        });
    }
}
