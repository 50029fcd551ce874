//! Checks of a resolved dialect that no single key can show.

use super::dialect::{Dialect, FullCircleWords};
use super::load::builtin_file;
use super::pattern::{Item, Place};
use super::template::Renderer;
use super::tree;
use super::variables::Scope;
use crate::diag::{Code, Diagnostic, codes, did_you_mean};
use crate::ir::CycleName;
use crate::readback;
use crate::source::{SourceMap, Span};
use crate::units::LengthUnit;

/// Every error of a resolved dialect; `templates`: compile all of them, used or not.
#[must_use]
pub fn check(dialect: &Dialect, sources: &SourceMap, templates: bool) -> Vec<Diagnostic> {
    let mut errors = Vec::new();
    check_patterns(dialect, &mut errors);
    check_words(dialect, &mut errors);
    check_cycles(dialect, &mut errors);
    check_decimals(dialect, &mut errors);
    check_safe_start(dialect, &mut errors);
    check_tool_change(dialect, &mut errors);
    check_rotary(dialect, &mut errors);
    check_comments(dialect, &mut errors);
    check_extension(dialect, &mut errors);
    check_control(dialect, &mut errors);
    if templates {
        check_templates(dialect, &mut errors);
        super::options::check(dialect, sources, &mut errors);
    }
    errors
}

/// What is said behind a control's name must mean something; `post check` names the controls there are.
fn check_control(dialect: &Dialect, errors: &mut Vec<Diagnostic>) {
    let spec = &dialect.spec.post;
    let given = core::iter::once(("post.control", &spec.control))
        .chain(spec.control_when.values().map(|control| ("post.control-when", control)));
    for (path, control) in given {
        if let Err(unknown) = readback::needs(control)
            && unknown.name().is_none()
        {
            let error = at(dialect, path, &codes::post::WRONG_VALUE, unknown.to_string());
            errors.push(error.help("docs/readers.md lists the statements that a machine may make"));
        }
    }
}

/// Longest extension of NC files.
const MAX_EXTENSION: usize = 16;

/// The extension becomes part of a file name, and of nothing else.
fn check_extension(dialect: &Dialect, errors: &mut Vec<Diagnostic>) {
    let extension = dialect.extension();
    let fits = (1..=MAX_EXTENSION).contains(&extension.len());
    if !fits || !extension.bytes().all(|b| b.is_ascii_alphanumeric() || matches!(b, b'-' | b'_')) {
        let message = format!("`{}` is no extension of a file", extension.escape_debug());
        let help = format!("1 to {MAX_EXTENSION} letters, digits, `-` and `_`, without the point");
        errors.push(at(dialect, "post.extension", &codes::post::WRONG_VALUE, message).help(help));
    }
}

/// A message at the value of `path`, or without a place when no file says it.
pub(super) fn at(dialect: &Dialect, path: &str, code: &'static Code, message: String) -> Diagnostic {
    match tree::find(&dialect.tree, path) {
        Some(entry) => Diagnostic::new(code, entry.value, message),
        None => Diagnostic::global(code, message),
    }
}

/// Whether a file of the user says the value, and not a built-in post.
pub(super) fn in_a_file(dialect: &Dialect, path: &str) -> bool {
    tree::find(&dialect.tree, path).is_some_and(|entry| builtin_file(entry.value.file).is_none())
}

/// Every pattern with its place in the file and what it is for.
pub(super) fn patterns(dialect: &Dialect) -> Vec<(&'static str, Place, &[String])> {
    let spec = &dialect.spec;
    let pieces = spec.nurbs.knots == "pieces";
    vec![
        ("patterns.rapid", Place::Rapid, &spec.patterns.rapid),
        ("patterns.line", Place::Line, &spec.patterns.line),
        ("patterns.arc", Place::Arc, &spec.patterns.arc),
        ("patterns.arc-zx", Place::Arc, &spec.patterns.arc_zx),
        ("patterns.arc-yz", Place::Arc, &spec.patterns.arc_yz),
        ("patterns.helix", Place::Arc, &spec.patterns.helix),
        ("patterns.hole", Place::Hole, &spec.patterns.hole),
        ("nurbs.begin", Place::Nurbs, &spec.nurbs.begin),
        ("nurbs.point", if pieces { Place::Piece } else { Place::Nurbs }, &spec.nurbs.point),
        ("nurbs.rest", Place::Nurbs, &spec.nurbs.rest),
        ("nurbs.end", Place::Nurbs, &spec.nurbs.end),
        ("nurbs.between", Place::Between, &spec.nurbs.between),
        ("spindle.on", Place::Spindle, &spec.spindle.on),
        ("spindle.after-tool-change", Place::Spindle, &spec.spindle.after_tool_change),
        ("dwell.block", Place::Dwell, &spec.dwell.block),
        ("compensation.left", Place::Compensation, &spec.compensation.left),
        ("compensation.right", Place::Compensation, &spec.compensation.right),
        ("compensation.off", Place::Compensation, &spec.compensation.off),
        ("compensation.off-alone", Place::Compensation, &spec.compensation.off_alone),
        ("path-control.tolerance", Place::Path, &spec.path_control.tolerance),
        ("path-control.exact", Place::Path, &spec.path_control.exact),
    ]
}

fn check_patterns(dialect: &Dialect, errors: &mut Vec<Diagnostic>) {
    for (path, place, items) in patterns(dialect) {
        for item in items {
            if let Some(problem) = check_item(dialect, place, item) {
                errors.push(at(dialect, path, &codes::post::BAD_PATTERN, problem));
            }
        }
        for wanted in needed(dialect, path).iter().filter(|w| !items.iter().any(|i| i == *w)) {
            let problem = format!("the pattern has no `{wanted}`: it could never be said");
            errors.push(at(dialect, path, &codes::post::BAD_PATTERN, problem));
        }
        check_collision(dialect, items, path, errors);
    }
    check_arc(dialect, errors);
    check_compensation(dialect, errors);
    super::check_curves::check(dialect, errors);
}

/// Items that a pattern cannot do without.
fn needed(dialect: &Dialect, path: &str) -> &'static [&'static str] {
    let spec = &dialect.spec;
    let pieces = spec.nurbs.knots == "pieces";
    let curves = spec.nurbs.knots != "none" && !pieces;
    let compensates = !spec.compensation.left.is_empty();
    match path {
        "patterns.rapid" | "patterns.line" => &["x", "y", "z"],
        "patterns.hole" if spec.cycles.values().any(|c| c.enabled) => &["x", "y"],
        "nurbs.point" if curves => &["x", "y"],
        "nurbs.begin" if curves => &["feed"],
        "nurbs.point" if pieces => &["feed"],
        "spindle.on" => &["spindle"],
        "dwell.block" => &["dwell"],
        "compensation.left" | "compensation.right"
            if spec.compensation.register == "always" && compensates =>
        {
            &["register"]
        }
        "path-control.tolerance" if !spec.path_control.tolerance.is_empty() => &["path-tolerance"],
        _ => &[],
    }
}

/// Cutter compensation that begins can end.
fn check_compensation(dialect: &Dialect, errors: &mut Vec<Diagnostic>) {
    let rules = &dialect.spec.compensation;
    let mut say = |path: &str, message: &str| {
        errors.push(at(dialect, path, &codes::post::BAD_PATTERN, message.to_owned()));
    };
    let parts = [("left", &rules.left), ("right", &rules.right), ("off", &rules.off)];
    if parts.iter().any(|(_, p)| p.is_empty()) && parts.iter().any(|(_, p)| !p.is_empty()) {
        for (name, _) in parts.iter().filter(|(_, p)| p.is_empty()) {
            let message = "of `left`, `right` and `off` all are said, or none";
            say(&format!("compensation.{name}"), message);
        }
    }
}

/// Arcs say where they end and what they turn about, in every plane they are claimed for.
fn check_arc(dialect: &Dialect, errors: &mut Vec<Diagnostic>) {
    let spec = &dialect.spec;
    if !spec.arcs.enabled {
        return;
    }
    let mut say = |path: &str, message: String| {
        errors.push(at(dialect, path, &codes::post::BAD_PATTERN, message));
    };
    let patterns = &spec.patterns;
    let helix = if patterns.helix.is_empty() { &patterns.arc } else { &patterns.helix };
    let helix_path = if patterns.helix.is_empty() { "patterns.arc" } else { "patterns.helix" };
    let mut claimed: Vec<(&str, &[String], [usize; 2])> = vec![("patterns.arc", &patterns.arc, [0, 1])];
    if helix_path != "patterns.arc" {
        claimed.push((helix_path, helix, [0, 1]));
    }
    let others = [
        ("zx", "patterns.arc-zx", &patterns.arc_zx, [0, 2]),
        ("yz", "patterns.arc-yz", &patterns.arc_yz, [1, 2]),
    ];
    let mut shared = false;
    for (_, path, own, axes) in others.into_iter().filter(|o| has(&spec.arcs.planes, o.0)) {
        let inherits = own.is_empty();
        claimed.push(if inherits { ("patterns.arc", &patterns.arc, axes) } else { (path, own, axes) });
        shared |= inherits;
    }
    for (path, items, axes) in claimed {
        for problem in arc_problems(items, axes, spec.arcs.full_circle) {
            say(path, problem);
        }
    }
    if shared && !has(&patterns.arc, "plane") && !has(&patterns.arc, "axis") {
        say(
            "patterns.arc",
            "arcs are claimed for several planes, and the pattern has no `plane`; `patterns.arc-zx` and `patterns.arc-yz` spell them otherwise".into(),
        );
    }
    if spec.arcs.helix && !has(helix, "z") {
        say(helix_path, "helices are claimed, and the pattern has no `z`".into());
    }
    if !has(&spec.arcs.planes, "xy") {
        say("arcs.planes", "there are arcs, but none in the XY plane".into());
    }
    // One message for a pattern that several planes share.
    errors.dedup_by(|a, b| a.message == b.message && a.primary == b.primary);
}

fn has(items: &[String], word: &str) -> bool {
    items.iter().any(|i| i == word)
}

/// What a pattern of arcs in the plane of two axes (0 X, 1 Y, 2 Z) leaves unsaid.
fn arc_problems(items: &[String], axes: [usize; 2], circles: FullCircleWords) -> Vec<String> {
    let both = |words: [&'static str; 3]| axes.iter().all(|axis| has(items, words[*axis]));
    let listed = |words: [&'static str; 3]| format!("`{}`, `{}`", words[axes[0]], words[axes[1]]);
    const ENDS: [&str; 3] = ["x", "y", "z"];
    const OFFSETS: [&str; 3] = ["i", "j", "k"];
    const CENTRES: [&str; 3] = ["cx", "cy", "cz"];
    let mut problems = Vec::new();
    if !both(ENDS) && !has(items, "sweep") {
        problems.push(format!(
            "the pattern says neither where an arc ends ({}) nor how far it turns (`sweep`)",
            listed(ENDS)
        ));
    }
    let between = axes != [0, 1] && both(super::capabilities::BETWEEN);
    let centre = both(OFFSETS) || both(CENTRES);
    if !(centre || between || has(items, "radius")) {
        let (offsets, centres) = (listed(OFFSETS), listed(CENTRES));
        problems.push(format!("the pattern has no centre ({offsets} or {centres}) and no `radius`"));
    }
    if !(centre || between) && has(items, "radius") && circles != FullCircleWords::Split {
        problems.push("a radius alone is no full circle: `arcs.full-circle` must be \"split\"".into());
    }
    problems
}

fn check_item(dialect: &Dialect, place: Place, item: &str) -> Option<String> {
    let known = place.items();
    match Item::parse(item) {
        Some(Item::Text(_) | Item::NewLine) => None,
        Some(parsed) if known.contains(&item) => match parsed.word_name() {
            Some(word) if !dialect.spec.words.contains_key(word) => {
                Some(format!("the word `{word}` is not in [words]"))
            }
            _ => None,
        },
        _ => {
            let near = did_you_mean(item, known.iter().copied())
                .map(|n| format!("; did you mean `{n}`?"))
                .unwrap_or_else(|| format!("; there are {}", known.join(", ")));
            Some(format!("`{item}` is no item of this pattern{near}; texts start with `=`"))
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
        let parsed = Item::parse(item);
        let Some(name) = parsed.as_ref().and_then(Item::word_name) else { continue };
        let Some(word) = dialect.spec.words.get(name) else { continue };
        // Numbers that are told apart by their place have no address.
        if !word.prefix.bytes().any(|b| b.is_ascii_alphabetic()) {
            continue;
        }
        if let Some((other, _)) = seen.iter().find(|(_, prefix)| *prefix == word.prefix) {
            let problem = format!("the words `{other}` and `{item}` are both spelled `{}`", word.prefix);
            let said = [format!("words.{name}.prefix"), format!("words.{other}.prefix"), path.to_owned()];
            let place = said.iter().find(|p| in_a_file(dialect, p)).map_or(path, String::as_str);
            let error = at(dialect, place, &codes::post::BAD_PATTERN, problem);
            // One message, however many patterns hold both.
            if !errors.iter().any(|e| e.message == error.message && e.primary == error.primary) {
                errors.push(error);
            }
        }
        seen.push((item, &word.prefix));
    }
}

/// Words that are spelled in a way no control could read.
fn check_words(dialect: &Dialect, errors: &mut Vec<Diagnostic>) {
    for (name, word) in &dialect.spec.words {
        let suffix = |unit| word.suffix.as_ref().map_or_else(String::new, |s| s.of(unit));
        let texts = [
            ("prefix", word.prefix.clone()),
            ("suffix", suffix(LengthUnit::Millimetre)),
            ("suffix", suffix(LengthUnit::Inch)),
        ];
        for (key, text) in texts {
            if text.len() > 16 || text.bytes().any(|b| !(b.is_ascii_graphic() || b == b' ')) {
                let message = format!("the {key} of `{name}` is not a short printable text");
                errors.push(at(dialect, &format!("words.{name}.{key}"), &codes::post::WRONG_VALUE, message));
            }
        }
    }
}

/// Cycles are ones that exist, and are said somewhere.
fn check_cycles(dialect: &Dialect, errors: &mut Vec<Diagnostic>) {
    let names = || CycleName::ALL.into_iter().map(CycleName::text);
    for (name, cycle) in &dialect.spec.cycles {
        let path = format!("cycles.{name}");
        if CycleName::by_text(name).is_none() {
            let help = match did_you_mean(name, names()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("there are {}", names().collect::<Vec<_>>().join(", ")),
            };
            let message = format!("`{name}` is no drilling cycle");
            errors.push(at(dialect, &path, &codes::post::BAD_PATTERN, message).help(help));
        } else if cycle.enabled && cycle.before.is_empty() && cycle.call.is_empty() {
            let message = format!("the cycle `{name}` has neither `before` nor `call`: nothing would drill");
            errors.push(at(dialect, &path, &codes::post::BAD_PATTERN, message));
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
            "j" | "k" => decimals(word) != decimals("i"),
            "cx" | "cy" | "cz" => decimals(word) != decimals("i").max(linear),
            "mx" | "my" | "mz" => decimals(word) != linear,
            _ => decimals(word) < linear,
        };
        for word in ["y", "z", "i", "j", "k", "cx", "cy", "cz", "mx", "my", "mz", "radius"].iter().filter(bad)
        {
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
    let enabled = [LengthUnit::Millimetre, LengthUnit::Inch].iter().any(|u| rotary.enabled.of(*u));
    if enabled && !single {
        let message =
            format!("`rotary.letter` is \"{}\", not one letter of \"{}\"", rotary.letter, rotary.letters);
        errors.push(at(dialect, "rotary.letter", &codes::post::WRONG_VALUE, message));
    }
    let words = dialect.spec.patterns.line.iter().filter(|item| *item != "rotary");
    let prefixes = words.filter_map(|item| Some((item, &dialect.spec.words.get(item)?.prefix)));
    for (item, prefix) in
        prefixes.filter(|(_, p)| enabled && p.len() == 1 && rotary.letters.contains(p.as_str()))
    {
        let message = format!("`rotary.letters` has `{prefix}`, which is the word `{item}`");
        errors.push(at(dialect, "rotary.letters", &codes::post::WRONG_VALUE, message));
    }
}

/// What stands for a character that a comment may not hold is one that it may; those that end a comment never are.
fn check_comments(dialect: &Dialect, errors: &mut Vec<Diagnostic>) {
    let comments = &dialect.spec.comments;
    for (key, text) in [("allowed", &comments.allowed), ("replace", &comments.replace)] {
        if let Some(c) = text.chars().find(|c| !comments.may_hold(*c)) {
            let message = format!("{c:?} in `comments.{key}` could end a comment, or is no character of one");
            errors.push(at(dialect, &format!("comments.{key}"), &codes::post::WRONG_VALUE, message));
        }
    }
}

/// Every template with its place in the file and what it can read.
pub(super) fn templates(dialect: &Dialect) -> Vec<(String, Scope, &str)> {
    let spec = &dialect.spec;
    let templates = &spec.templates;
    let mut all = vec![
        ("templates.header".to_owned(), Scope::Everywhere, templates.header.as_str()),
        ("templates.operation".to_owned(), Scope::Operation, &templates.operation),
        ("templates.footer".to_owned(), Scope::Everywhere, &templates.footer),
        ("tool-change.with-first-z".to_owned(), Scope::ToolChange, &spec.tool_change.with_first_z),
    ];
    for (name, text) in &spec.tool_change.blocks {
        all.push((format!("tool-change.blocks.{name}"), Scope::ToolChange, text));
    }
    for (name, cycle) in &spec.cycles {
        let parts =
            [("before", &cycle.before), ("call", &cycle.call), ("words", &cycle.words), ("end", &cycle.end)];
        for (key, text) in parts {
            all.push((format!("cycles.{name}.{key}"), Scope::Cycle, text));
        }
    }
    all
}

fn check_templates(dialect: &Dialect, errors: &mut Vec<Diagnostic>) {
    let renderer = Renderer::new(&dialect.spec.comments);
    for (path, _, template) in templates(dialect) {
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
