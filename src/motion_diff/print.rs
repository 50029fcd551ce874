//! A comparison for people.

use core::fmt::Write as _;

use super::state::number;
use super::{Comparison, PathDifference, Property, StateDifference};

/// Differences of one kind that are printed; the rest is counted.
const MOST: usize = 10;

/// The names of both programs in the text.
#[derive(Debug, Clone, Copy)]
pub struct Names<'a> {
    /// The first.
    pub a: &'a str,
    /// The second.
    pub b: &'a str,
}

/// Says how two programs differ, a line for each difference; nothing when they do not.
#[must_use]
pub fn text(comparison: &Comparison, names: Names<'_>) -> String {
    let mut out = String::new();
    if let Some(path) = &comparison.path {
        out.push_str(&path_text(path, names));
    }
    list(&mut out, &comparison.states, |d| state_text(d, names));
    list(&mut out, &comparison.events, |d| event_text(d, names));
    out
}

fn list<T>(out: &mut String, items: &[T], text: impl Fn(&T) -> String) {
    items.iter().take(MOST).for_each(|item| out.push_str(&text(item)));
    if items.len() > MOST {
        // Writing to a String cannot fail.
        let _ = writeln!(out, "  … and {} more of this kind", items.len() - MOST);
    }
}

fn path_text(path: &PathDifference, names: Names<'_>) -> String {
    let [a, b] = path.lines;
    let [p, q] = path.points.map(point);
    let count = |n: usize| format!("{n} move{}", if n == 1 { "" } else { "s" });
    format!(
        "path: the first move that differs is in line {a} of {} and line {b} of {}: {p} and {q}, {} mm apart\n\
         path: at most {} mm apart anywhere; {} of {} and {} of {} differ\n",
        names.a,
        names.b,
        distance(path.distance),
        distance(path.largest),
        count(path.moves[0]),
        names.a,
        count(path.moves[1]),
        names.b,
    )
}

/// At most six decimals: tolerances can be small.
fn distance(value: f64) -> String {
    ((value * 1e6).round() / 1e6).to_string()
}

fn point([x, y, z]: [f64; 3]) -> String {
    format!("X{} Y{} Z{}", number(x), number(y), number(z))
}

fn state_text(difference: &StateDifference, names: Names<'_>) -> String {
    let (what, unit) = match difference.property {
        Property::Rapid => ("motion", ""),
        Property::Feed => ("feed", " mm/min"),
        Property::FeedMode => ("feed mode", ""),
        Property::Spindle => ("spindle", " rev/min"),
        Property::Tool => ("tool", ""),
        Property::LengthOffset => ("tool length offset", ""),
        Property::Coolant => ("coolant", ""),
        Property::Compensation => ("cutter compensation", ""),
        Property::WorkOffset => ("work offset", ""),
        Property::PathTolerance => ("path tolerance", " mm"),
    };
    let ([a, b], [old, new]) = (difference.lines, &difference.values);
    format!(
        "{what}: {old}{unit} in line {a} of {}, {new}{unit} in line {b} of {}, from {} on for {} mm\n",
        names.a,
        names.b,
        point(difference.point),
        number(difference.length),
    )
}

fn event_text(difference: &super::EventDifference, names: Names<'_>) -> String {
    let place = |p: Option<[f64; 3]>| p.map(point).unwrap_or_default();
    let event = &difference.event;
    match (difference.lines, difference.points) {
        ([Some(a), Some(b)], [p, q]) => format!(
            "{event}: at {} in line {a} of {}, at {} in line {b} of {}\n",
            place(p),
            names.a,
            place(q),
            names.b
        ),
        ([Some(line), None], [p, _]) => {
            format!("{event}: only in line {line} of {}, at {}\n", names.a, place(p))
        }
        ([None, line], [_, q]) => {
            format!("{event}: only in line {} of {}, at {}\n", line.unwrap_or(0), names.b, place(q))
        }
    }
}
