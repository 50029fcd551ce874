//! Checks of a resolved dialect that no single key can show.

use super::dialect::Dialect;
use super::pattern::{self, Item};
use super::template::Renderer;
use super::tree;
use crate::diag::{Code, Diagnostic, codes, did_you_mean};
use crate::source::Span;
use crate::units::LengthUnit;

/// Every error of a resolved dialect; `templates`: compile all of them, used or not.
#[must_use]
pub fn check(dialect: &Dialect, templates: bool) -> Vec<Diagnostic> {
    let mut errors = Vec::new();
    check_patterns(dialect, &mut errors);
    check_named_words(dialect, &mut errors);
    check_decimals(dialect, &mut errors);
    check_safe_start(dialect, &mut errors);
    check_tool_change(dialect, &mut errors);
    check_rotary(dialect, &mut errors);
    if templates {
        check_templates(dialect, &mut errors);
    }
    errors
}

/// A message at the value of `path`, or without a place when no file says it.
pub(super) fn at(dialect: &Dialect, path: &str, code: &'static Code, message: String) -> Diagnostic {
    match tree::find(&dialect.tree, path) {
        Some(entry) => Diagnostic::new(code, entry.value, message),
        None => Diagnostic::global(code, message),
    }
}

fn check_patterns(dialect: &Dialect, errors: &mut Vec<Diagnostic>) {
    let patterns = &dialect.spec.patterns;
    for (name, items) in [("rapid", &patterns.rapid), ("line", &patterns.line), ("arc", &patterns.arc)] {
        let path = format!("patterns.{name}");
        for item in items {
            if let Some(problem) = check_item(dialect, item) {
                errors.push(at(dialect, &path, &codes::post::BAD_PATTERN, problem));
            }
        }
        let wanted: &[&str] =
            if name == "arc" && !dialect.spec.arcs.enabled { &[] } else { &["x", "y", "z"] };
        for axis in wanted.iter().filter(|axis| !items.iter().any(|i| i == *axis)) {
            let problem = format!("the pattern `{name}` has no word `{axis}`: that axis could never move");
            errors.push(at(dialect, &path, &codes::post::BAD_PATTERN, problem));
        }
        check_collision(dialect, items, &path, errors);
    }
}

fn check_item(dialect: &Dialect, item: &str) -> Option<String> {
    match Item::parse(item) {
        Some(Item::Word(slot)) if !dialect.spec.words.contains_key(slot.name()) => {
            Some(format!("the word `{}` is not in [words]", slot.name()))
        }
        Some(_) => None,
        None => {
            let near = did_you_mean(item, pattern::ITEM_NAMES.iter().copied())
                .map(|n| format!("; did you mean `{n}`?"))
                .unwrap_or_default();
            Some(format!("`{item}` is no item of a pattern{near}; texts start with `=`"))
        }
    }
}

/// Two words of one pattern with the same prefix could not be told apart by the control.
fn check_collision(dialect: &Dialect, items: &[String], path: &str, errors: &mut Vec<Diagnostic>) {
    let mut seen: Vec<(&str, &str)> = Vec::new();
    for item in items {
        if item == "/" {
            seen.clear();
        }
        let Some(Item::Word(slot)) = Item::parse(item) else { continue };
        let Some(word) = dialect.spec.words.get(slot.name()) else { continue };
        if word.prefix.is_empty() {
            continue;
        }
        if let Some((other, _)) = seen.iter().find(|(_, prefix)| *prefix == word.prefix) {
            let problem = format!("the words `{other}` and `{item}` are both spelled `{}`", word.prefix);
            errors.push(at(dialect, path, &codes::post::BAD_PATTERN, problem));
        }
        seen.push((item, &word.prefix));
    }
}

/// Words that keys name, and words the writer cannot do without.
fn check_named_words(dialect: &Dialect, errors: &mut Vec<Diagnostic>) {
    let named =
        [("dwell.word", &dialect.spec.dwell.word), ("cycle-dwell.word", &dialect.spec.cycle_dwell.word)];
    for (path, word) in named {
        if !dialect.spec.words.contains_key(word) {
            let message = format!("the word `{word}` is not in [words]");
            errors.push(at(dialect, path, &codes::post::BAD_PATTERN, message));
        }
    }
    for (name, word) in &dialect.spec.words {
        let bad = word.prefix.bytes().any(|b| !(b.is_ascii_graphic() || b == b' '));
        if bad || word.prefix.len() > 12 {
            let message = format!("the prefix of `{name}` is not a short printable text");
            errors.push(at(dialect, &format!("words.{name}.prefix"), &codes::post::WRONG_VALUE, message));
        }
    }
}

/// Linear axes share one grid, and centre words are at least as fine.
fn check_decimals(dialect: &Dialect, errors: &mut Vec<Diagnostic>) {
    let spec = &dialect.spec;
    for unit in [LengthUnit::Millimetre, LengthUnit::Inch] {
        let decimals = |word: &str| spec.decimals(word, unit);
        let linear = decimals("x");
        let bad = |word: &&&str| match **word {
            "y" | "z" => decimals(word) != linear,
            "j" => decimals("j") != decimals("i"),
            "cy" => decimals("cy") != decimals("cx"),
            _ => decimals(word) < linear,
        };
        for word in ["y", "z", "i", "j", "cx", "cy", "radius"].iter().filter(bad) {
            let path = format!("words.{word}.decimals");
            let path = if tree::find(&dialect.tree, &path).is_some() { &path } else { "words.x.decimals" };
            let message = format!(
                "`{word}` has {} decimals in {} programs, `x` has {linear}: linear axes have the same decimals, words of arcs the same as each other and no fewer",
                decimals(word),
                unit.symbol()
            );
            errors.push(at(dialect, path, &codes::post::BAD_PATTERN, message));
        }
    }
    errors.dedup_by(|a, b| a.primary.is_some() && a.primary == b.primary);
}

fn check_safe_start(dialect: &Dialect, errors: &mut Vec<Diagnostic>) {
    let groups = &dialect.spec.groups;
    let listed = || dialect.spec.safe_start.iter().flatten();
    for name in listed().filter(|n| !groups.contains_key(*n)) {
        let near = did_you_mean(name, groups.keys().map(String::as_str))
            .map(|n| format!("; did you mean `{n}`?"))
            .unwrap_or_default();
        let message = format!("`safe-start` names the group `{name}`, which is not in [groups]{near}");
        errors.push(at(dialect, "safe-start", &codes::post::BAD_PATTERN, message));
    }
    if dialect.spec.safe_start.is_empty() {
        return;
    }
    // A group that starts with nothing is one that this control, unlike its parent, does not have.
    let exists =
        |name: &&String| groups.get(*name).is_some_and(|g| !g.start.of(LengthUnit::Millimetre).is_empty());
    for name in groups.keys().filter(exists).filter(|n| !listed().any(|l| l == *n)) {
        let message = format!(
            "the group `{name}` is not in `safe-start`: a program would rely on what the machine happens to have on"
        );
        errors.push(at(dialect, &format!("groups.{name}"), &codes::post::BAD_PATTERN, message));
    }
}

fn check_tool_change(dialect: &Dialect, errors: &mut Vec<Diagnostic>) {
    let change = &dialect.spec.tool_change;
    for name in change.order.iter().filter(|n| !change.blocks.contains_key(*n)) {
        let near = did_you_mean(name, change.blocks.keys().map(String::as_str))
            .map(|n| format!("; did you mean `{n}`?"))
            .unwrap_or_default();
        let message = format!(
            "`tool-change.order` names the block `{name}`, which is not in [tool-change.blocks]{near}"
        );
        errors.push(at(dialect, "tool-change.order", &codes::post::BAD_PATTERN, message));
    }
}

fn check_rotary(dialect: &Dialect, errors: &mut Vec<Diagnostic>) {
    let rotary = &dialect.spec.rotary;
    let single = rotary.letter.len() == 1 && rotary.letters.contains(&rotary.letter);
    if rotary.enabled && !single {
        let message =
            format!("`rotary.letter` is \"{}\", not one letter of \"{}\"", rotary.letter, rotary.letters);
        errors.push(at(dialect, "rotary.letter", &codes::post::WRONG_VALUE, message));
    }
}

/// All templates of a dialect with their paths.
pub(super) fn templates(dialect: &Dialect) -> Vec<(String, &str)> {
    let templates = &dialect.spec.templates;
    let change = &dialect.spec.tool_change;
    let fixed = [
        ("templates.header", &templates.header),
        ("templates.operation", &templates.operation),
        ("templates.footer", &templates.footer),
        ("tool-change.with-first-z", &change.with_first_z),
    ];
    let fixed = fixed.into_iter().map(|(path, text)| (path.to_owned(), text.as_str()));
    let blocks = change.blocks.iter().map(|(n, t)| (format!("tool-change.blocks.{n}"), t.as_str()));
    fixed.chain(blocks).collect()
}

fn check_templates(dialect: &Dialect, errors: &mut Vec<Diagnostic>) {
    let renderer = Renderer::new(&dialect.spec.comments);
    for (path, template) in templates(dialect) {
        if let Err(error) = renderer.check(template) {
            errors.push(template_error(dialect, &path, &error));
        }
    }
}

/// A template's error at its line in the post file.
#[must_use]
pub fn template_error(dialect: &Dialect, path: &str, error: &super::template::TemplateError) -> Diagnostic {
    let message = format!("the template `{path}` cannot be used: {}", error.message);
    let line = error.line.map(|line| format!("line {line} of the template"));
    let diagnostic = match tree::find(&dialect.tree, path).map(|e| e.value) {
        Some(span) => Diagnostic::new(&codes::post::BAD_TEMPLATE, first_byte(span), message),
        None => Diagnostic::global(&codes::post::BAD_TEMPLATE, message),
    };
    match line {
        Some(line) => diagnostic.note(line),
        None => diagnostic,
    }
}

/// Templates are long; a caret under their opening quote is enough.
pub(super) fn first_byte(span: Span) -> Span {
    Span { end: span.start.saturating_add(1).min(span.end), ..span }
}
