//! Feeds, speeds and the rest of the state, where the paths agree.

use serde::Serialize;

use super::chords::Path;
use super::walk::{self, Walked, ordered};
use super::{Tolerance, coordinates};
use crate::readback::{Compensated, FeedMode, TraceMove, Washing};

/// What can differ while the path is the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Property {
    /// Rapid or feed.
    Rapid,
    /// Feed, mm/min.
    Feed,
    /// How the feed is programmed.
    FeedMode,
    /// Spindle, rev/min, negative counter-clockwise.
    Spindle,
    /// Tool number.
    Tool,
    /// Tool length taken in.
    LengthOffset,
    /// Coolant.
    Coolant,
    /// Cutter compensation by the control.
    Compensation,
    /// Work offset, 1 for the first.
    WorkOffset,
    /// How far the control may leave the path, mm.
    PathTolerance,
}

/// A stretch of the path on which something differs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StateDifference {
    /// What.
    pub property: Property,
    /// NC lines at its start, in both programs.
    pub lines: [u32; 2],
    /// Where it starts, mm.
    pub point: [f64; 3],
    /// What each says there.
    pub values: [String; 2],
    /// Length of the stretch, mm.
    pub length: f64,
}

/// Every stretch with a difference, in order of the path; per property, values that stay are one stretch.
pub(super) fn compare(paths: &[Path<'_>; 2], walked: &Walked, tolerance: Tolerance) -> Vec<StateDifference> {
    let [a, b] = paths;
    let [of_a, of_b] = &walked.matches;
    let mut found = one_way(a, b, of_a, tolerance, false);
    // A change that begins and ends within a block of the first program shows from the second only.
    let seen = |d: &StateDifference, list: &[StateDifference]| {
        list.iter()
            .any(|o| o.property == d.property && (o.lines[0] == d.lines[0] || o.lines[1] == d.lines[1]))
    };
    for difference in one_way(b, a, of_b, tolerance, true) {
        if !seen(&difference, &found) {
            found.push(difference);
        }
    }
    found.sort_by_key(|d| d.lines);
    found
}

fn one_way(
    path: &Path<'_>,
    other: &Path<'_>,
    matches: &[walk::Match],
    tolerance: Tolerance,
    swapped: bool,
) -> Vec<StateDifference> {
    let mut open: Vec<Open> = Vec::new();
    let mut found = Vec::new();
    for chord in 1..path.points.len() {
        let length = path.at.get(chord).zip(path.at.get(chord - 1)).map_or(0.0, |(b, a)| b - a);
        let near = |index: usize| matches.get(index).is_some_and(|m| m.distance <= tolerance.distance);
        // Too short to say which block of the other it belongs to, or off the path.
        if length <= 4.0 * tolerance.distance || !near(chord) || !near(chord - 1) {
            continue;
        }
        let Some(place) = walk::middle(path, other, matches, chord) else { continue };
        let owners = path.owner.get(chord).copied().zip(walk::owner(other, place));
        let moves = owners.and_then(|(o, p)| Some((path.moves.get(o)?, other.moves.get(p)?)));
        let Some((own, theirs)) = moves else { continue };
        let differing = differences(own.1, theirs.1, tolerance.rate);
        close(&mut open, &mut found, &differing);
        for (property, values) in differing {
            extend(
                &mut open,
                property,
                values,
                length,
                || StateDifference {
                    property,
                    lines: ordered([own.0, theirs.0], swapped),
                    point: path.points.get(chord - 1).map_or([0.0; 3], |p| coordinates(*p)),
                    values: [String::new(), String::new()],
                    length: 0.0,
                },
                swapped,
            );
        }
    }
    found.extend(open.into_iter().map(|o| o.difference));
    found
}

/// A stretch that may go on.
struct Open {
    values: [String; 2],
    difference: StateDifference,
}

fn close(open: &mut Vec<Open>, found: &mut Vec<StateDifference>, differing: &[(Property, [String; 2])]) {
    let goes_on = |o: &Open| differing.iter().any(|(p, v)| *p == o.difference.property && *v == o.values);
    let (on, over): (Vec<Open>, Vec<Open>) = core::mem::take(open).into_iter().partition(goes_on);
    *open = on;
    found.extend(over.into_iter().map(|o| o.difference));
}

fn extend(
    open: &mut Vec<Open>,
    property: Property,
    values: [String; 2],
    length: f64,
    start: impl FnOnce() -> StateDifference,
    swapped: bool,
) {
    if let Some(same) = open.iter_mut().find(|o| o.difference.property == property) {
        same.difference.length += length;
        return;
    }
    let difference = StateDifference { values: ordered(values.clone(), swapped), length, ..start() };
    open.push(Open { values, difference });
}

fn differences(a: &TraceMove, b: &TraceMove, rate: f64) -> Vec<(Property, [String; 2])> {
    let mut found = Vec::new();
    let mut note = |property, a: String, b: String| found.push((property, [a, b]));
    let same = |a: f64, b: f64| a == b || (a - b).abs() <= rate * a.abs().max(b.abs());
    if a.rapid != b.rapid {
        let word = |rapid| if rapid { "rapid" } else { "feed" }.to_owned();
        note(Property::Rapid, word(a.rapid), word(b.rapid));
    } else {
        let (feed_a, feed_b) = (a.feed.unwrap_or(0.0), b.feed.unwrap_or(0.0));
        if !same(feed_a, feed_b) {
            note(Property::Feed, number(feed_a), number(feed_b));
        }
        if !a.rapid && a.feed_mode != b.feed_mode {
            note(Property::FeedMode, mode(a.feed_mode), mode(b.feed_mode));
        }
    }
    if !same(a.spindle, b.spindle) {
        note(Property::Spindle, number(a.spindle), number(b.spindle));
    }
    if a.tool != b.tool {
        note(Property::Tool, a.tool.to_string(), b.tool.to_string());
    }
    if a.length_offset != b.length_offset {
        let word = |on| if on { "on" } else { "off" }.to_owned();
        note(Property::LengthOffset, word(a.length_offset), word(b.length_offset));
    }
    if a.coolant != b.coolant {
        note(Property::Coolant, coolant(a.coolant), coolant(b.coolant));
    }
    if a.compensation != b.compensation {
        let said = |on: Option<Compensated>| on.map_or_else(|| "off".to_owned(), |on| on.to_string());
        note(Property::Compensation, said(a.compensation), said(b.compensation));
    }
    if a.work_offset != b.work_offset {
        let said = |offset: Option<u16>| offset.map_or_else(|| "none".to_owned(), |n| n.to_string());
        note(Property::WorkOffset, said(a.work_offset), said(b.work_offset));
    }
    if a.path_tolerance != b.path_tolerance {
        note(Property::PathTolerance, number(a.path_tolerance), number(b.path_tolerance));
    }
    found
}

fn coolant(on: Washing) -> String {
    match on.names().as_slice() {
        [] => "off".to_owned(),
        names => names.join(" and "),
    }
}

/// At most four decimals.
pub(super) fn number(value: f64) -> String {
    let rounded = (value * 1e4).round() / 1e4;
    if rounded == 0.0 { "0".to_owned() } else { rounded.to_string() }
}

fn mode(mode: FeedMode) -> String {
    match mode {
        FeedMode::PerMinute => "per minute",
        FeedMode::PerRevolution => "per revolution",
        FeedMode::InverseTime => "inverse time",
    }
    .to_owned()
}
