//! Printing of the vocabulary as `docs/reference.md`.

use core::fmt::Write as _;

use super::{Choice, Choices, FUNCTIONS, Form, Group, Item, Kind, Range, Slot, Statement, Usage, statements};
use crate::geom::motion::Law;
use crate::units::{LengthUnit, Quantity, UNIT_NAMES, number};

/// The reference, as Markdown.
#[must_use]
pub fn markdown() -> String {
    let mut text = String::from(INTRODUCTION);
    for group in Group::ALL {
        let _ = write!(text, "\n## {}\n", group.title());
        let rows = statements().filter(|s| s.group == group);
        match group {
            Group::Later => text.push_str(&later(rows)),
            _ => rows.for_each(|row| text.push_str(&statement(row))),
        }
    }
    text.push_str(&functions());
    text.push_str(&laws());
    let _ = write!(
        text,
        "\n## Units\n\n`{}`, and products, quotients and powers of them.\n",
        UNIT_NAMES.join("` `")
    );
    text
}

const INTRODUCTION: &str = "# Reference of the Partwright language

Printed from the vocabulary table in `src/vocab` (`UPDATE=1 cargo test reference_is_up_to_date`); do not edit.

Small letters stand for values, `[…]` may be left out, `A|B` means one of them. Minor words after the leading values may stand in any
order, except where a statement says otherwise. A number without a unit takes the dimension of its place, in the program's `UNITS`.
";

fn statement(row: &Statement) -> String {
    let mut text = format!("\n### {}\n\n{}.", row.word, capital(row.help));
    text.push_str(match row.usage {
        Usage::Ignored => " Accepted with a note; does nothing.",
        Usage::Operation => " May be named.",
        _ => "",
    });
    text.push('\n');
    if !row.example.is_empty() {
        let _ = write!(text, "\n```apt\n{}\n```\n", row.example);
    }
    for form in row.forms {
        text.push_str(&form_text(row, form));
    }
    if !row.members.is_empty() {
        text.push_str("\n| member | gives | |\n|---|---|---|\n");
        for m in row.members {
            let names: Vec<String> =
                core::iter::once(&m.name).chain(m.aliases).map(|n| format!("`.{n}`")).collect();
            let _ = writeln!(text, "| {} | {} | {} |", names.join(" "), m.gives, m.help);
        }
    }
    text
}

fn form_text(row: &Statement, form: &Form) -> String {
    let label = match row.usage {
        Usage::Declares(_) | Usage::DeclaresOrActs(_) => "name = ",
        _ => "",
    };
    let lead: Vec<String> = form.lead.iter().map(item).collect();
    let options: Vec<String> = form.options.iter().map(option).collect();
    let parts: Vec<String> = lead.into_iter().chain(options).collect();
    let mut text = String::new();
    if !form.help.is_empty() && row.forms.len() > 1 {
        let _ = write!(text, "\n{}:\n", capital(form.help));
    }
    let _ = write!(text, "\n`{label}{}/ {}`\n", row.word, join(&parts));
    let lines = explanations(form);
    if !lines.is_empty() {
        text.push_str("\n| | | default |\n|---|---|---|\n");
        lines.iter().for_each(|line| text.push_str(line));
    }
    text
}

/// Parts with commas between them, inside the bracket of what may be left out.
fn join(parts: &[String]) -> String {
    let mut text = String::new();
    for part in parts {
        match part.strip_prefix('[') {
            _ if text.is_empty() => text.push_str(part),
            Some(rest) => {
                let _ = write!(text, "[, {rest}");
            }
            None => {
                let _ = write!(text, ", {part}");
            }
        }
    }
    text
}

fn item(item: &Item) -> String {
    match item {
        Item::Word(_, choices) => words(choices),
        Item::Value(slot) => slot.name.into(),
        Item::Optional(slot) => format!("[{}]", slot.name),
        Item::Repeat(slot, min, _) => {
            let fixed: Vec<&str> = core::iter::repeat_n(slot.name, *min).collect();
            format!("{}[, …]", fixed.join(", "))
        }
    }
}

fn option(option: &Choices) -> String {
    let parts: Vec<String> = (!option.words.is_empty())
        .then(|| words(option.words))
        .into_iter()
        .chain(option.values.iter().map(item))
        .collect();
    let text = join(&parts);
    if option.required { text } else { format!("[{text}]") }
}

fn words(choices: &[Choice]) -> String {
    choices.iter().map(|c| c.word).collect::<Vec<_>>().join("|")
}

fn explanations(form: &Form) -> Vec<String> {
    let mut lines = Vec::new();
    for item in form.lead {
        explain_item(&mut lines, item);
    }
    for option in form.options {
        for choice in option.words {
            let default = if option.required { "needed" } else { option.default };
            lines.push(format!("| `{}` | {} | {default} |\n", choice.word, choice.help));
        }
        option.values.iter().for_each(|item| explain_item(&mut lines, item));
    }
    lines.dedup();
    lines
}

fn explain_item(lines: &mut Vec<String>, item: &Item) {
    match item {
        Item::Word(_, choices) => {
            lines.extend(choices.iter().map(|c| format!("| `{}` | {} | |\n", c.word, c.help)));
        }
        Item::Value(slot) | Item::Optional(slot) | Item::Repeat(slot, ..) => {
            lines.push(format!("| {} | {} ({}) | |\n", slot.name, slot.help, takes(slot)));
        }
    }
}

fn takes(slot: &Slot) -> String {
    match slot.kind {
        Kind::Number(dim, range) => format!("{}{}", dim.name(), range_text(range, dim)),
        Kind::Any => "number".into(),
        Kind::Feed => "feed per minute, per revolution or per tooth, over 0".into(),
        Kind::Lift => "length, or angle, over 0".into(),
        Kind::LiftRate(1) => "lift per degree".into(),
        Kind::LiftRate(n) => format!("lift per degree^{n}"),
        Kind::Count(min, max) => format!("whole number from {min} to {max}"),
        Kind::Point => "point: a name or `(x, y[, z])`".into(),
        Kind::Vector => "vector: a name or `(x, y[, z])`".into(),
        Kind::Entity(kinds) => kinds.iter().map(|k| k.name()).collect::<Vec<_>>().join(" or "),
        Kind::Declared(kind) => format!("{}, declared as such", kind.name().trim_start_matches("a ")),
        Kind::PointOrPattern => "point or pattern".into(),
        Kind::Contour => "cam, line, circle, curve or chain".into(),
        Kind::Text => "text in quotes".into(),
        Kind::Law => "motion law, see below".into(),
        Kind::Name => "word".into(),
        Kind::Binding => "`NAME = value`".into(),
    }
}

fn range_text(range: Range, dim: crate::units::Dim) -> String {
    let show = |x: f64| number(Quantity::new(x, dim).in_unit(LengthUnit::Millimetre));
    match range {
        Range::Any => String::new(),
        Range::Positive => ", over 0".into(),
        Range::NotNegative => ", not negative".into(),
        Range::Within(a, b) => format!(", from {} to {}", show(a), show(b)),
        Range::Between(a, b) => format!(", between {} and {}", show(a), show(b)),
    }
}

fn later<'a>(rows: impl Iterator<Item = &'a Statement>) -> String {
    let mut text =
        String::from("\nEach of them is refused with E0202.\n\n| word | what it is for |\n|---|---|\n");
    for row in rows {
        let _ = writeln!(text, "| `{}` | {} |", row.word, row.help);
    }
    text
}

fn functions() -> String {
    let mut text =
        String::from("\n## Functions\n\nAngles are degrees.\n\n| function | also | |\n|---|---|---|\n");
    for f in FUNCTIONS {
        let aliases: Vec<String> = f.aliases.iter().map(|a| format!("`{a}`")).collect();
        let _ = writeln!(text, "| `{}({})` | {} | {} |", f.name, f.signature, aliases.join(" "), f.help);
    }
    text
}

fn laws() -> String {
    let mut text = String::from(
        "\n## Motion laws\n\nPeaks of a rise of 1 over an angle of 1: velocity, acceleration (largest and smallest), jerk.\n\n\
         | law | also | | velocity | acceleration | jerk |\n|---|---|---|---|---|---|\n",
    );
    for law in Law::all() {
        let aliases: Vec<String> = law.aliases().iter().map(|a| format!("`{a}`")).collect();
        let peaks = law.peaks();
        let _ = writeln!(
            text,
            "| `{}` | {} | {} | {} | {} / {} | {} / {} |",
            law.name(),
            aliases.join(" "),
            law.title(),
            peak(peaks.v),
            peak(peaks.a_max),
            peak(peaks.a_min),
            peak(peaks.j_max),
            peak(peaks.j_min)
        );
    }
    text.push_str(
        "\n`POLY` takes boundary values behind it: `RISE, 120, 20, POLY, V0, 0, A0, 0, V1, 0, A1, 0`.\n",
    );
    text
}

fn peak(value: f64) -> String {
    if value.is_finite() { number((value * 1e5).round() / 1e5) } else { "∞".into() }
}

fn capital(text: &str) -> String {
    let mut chars = text.chars();
    match chars.next() {
        Some(first) => first.to_uppercase().chain(chars).collect(),
        None => String::new(),
    }
}
