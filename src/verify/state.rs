//! Feed, spindle and tool at every cut.

use super::finding::{Finding, Text};
use super::{Case, Placed};
use crate::cl::RecordKind;
use crate::diag::codes::verification as codes;
use crate::ir::{Coolant, Tool};
use crate::readback::{Compensated, TracePath, Washing};
use crate::target::{BlockKind, FeedWord, Motion, power_of_ten};

/// How far a feed along the path may differ from the one commanded, as a share of it. Covers the rounding of F words,
/// inverse time ones included.
pub(super) const FEED_TOLERANCE: f64 = 0.01;
/// How far a spindle speed may differ, rev/min: rounding of S words.
const SPEED_TOLERANCE: f64 = 0.51;

/// Checks a move; rapids need nothing.
pub(super) fn check(case: &Case<'_>, placed: &Placed<'_>) -> Vec<Finding> {
    if placed.cut.rapid {
        return Vec::new();
    }
    let mut found = Vec::new();
    let mut say = |code, text: Text| found.push(Finding::new(code, placed.line, placed.block, text));
    let cut = placed.cut;
    if !cut.known.iter().all(|&k| k) {
        say(&codes::NOT_READY, Text::default().words("a cut from a position that is not known"));
    }
    if cut.spindle == 0.0 {
        say(&codes::NOT_READY, Text::default().words("a cut with the spindle standing"));
    }
    if case.needs.tool_change && cut.tool == 0 {
        say(&codes::NOT_READY, Text::default().words("a cut before a tool is changed in"));
    }
    if case.needs.length_offset && !cut.length_offset {
        say(&codes::NOT_READY, Text::default().words("a cut before the tool's length is taken in (G43)"));
    }
    if let Some(text) = tool(case, placed) {
        say(&codes::NOT_READY, text);
    }
    if let Some(text) = spindle(case, placed) {
        say(&codes::NOT_READY, text);
    }
    if let Some(text) = coolant(case, placed) {
        say(&codes::NOT_READY, text);
    }
    if let Some(text) = compensation(case, placed) {
        say(&codes::NOT_READY, text);
    }
    if let Some(text) = work_offset(case, placed) {
        say(&codes::WRONG_OFFSET, text);
    }
    if let Some(text) = feed(case, placed) {
        say(&codes::WRONG_FEED, text);
    }
    found
}

/// The tool that the block was lowered for.
fn loaded<'a>(case: &Case<'a>, placed: &Placed<'_>) -> Option<&'a Tool> {
    case.target.tools.get(case.context(placed.block).tool? as usize)
}

/// The tool in the spindle is the one the block was lowered for, where it has a number.
fn tool(case: &Case<'_>, placed: &Placed<'_>) -> Option<Text> {
    let wanted = loaded(case, placed)?;
    let number = wanted.number.filter(|_| case.needs.tool_change)?;
    let got = placed.cut.tool;
    (got != 0 && got != number).then(|| {
        Text::default().words(format!("a cut with tool {got} in place of {number} ({})", wanted.name))
    })
}

/// The cutter compensation that was asked for is in force on every cut in X or Y, where the control has one.
fn compensation(case: &Case<'_>, placed: &Placed<'_>) -> Option<Text> {
    let wanted = asked(case, placed)?.compensation.zip(case.target.capabilities.compensation);
    let wanted = wanted.map(|(on, register)| Compensated {
        side: on.side,
        register: register.said(on.register, loaded(case, placed).and_then(|tool| tool.number)),
    });
    let got = placed.cut.compensation;
    let across = !matches!(placed.cut.path, TracePath::Line { from, to } if from == to);
    (got != wanted && across).then(|| {
        Text::default().words(format!("a cut with {} in place of {}", compensated(got), compensated(wanted)))
    })
}

fn compensated(on: Option<Compensated>) -> String {
    on.map_or_else(|| "no cutter compensation".to_owned(), |on| format!("cutter compensation {on}"))
}

/// The work offset in force is the one asked for, where the post selects one.
fn work_offset(case: &Case<'_>, placed: &Placed<'_>) -> Option<Text> {
    let wanted = case.target.capabilities.work_offset?;
    let said = match placed.cut.work_offset {
        Some(got) if got == wanted => return None,
        Some(got) => format!("a cut in work offset {got} in place of {wanted}"),
        None => format!("a cut before work offset {wanted} is selected"),
    };
    Some(Text::default().words(said))
}

/// The coolant that was asked for flows, as far as the control can switch it; an `INSERT` may have switched more on.
fn coolant(case: &Case<'_>, placed: &Placed<'_>) -> Option<Text> {
    let can = &case.target.capabilities;
    let (flood, mist) = (Washing { flood: can.flood, ..OFF }, Washing { mist: can.mist, ..OFF });
    let wanted = match asked(case, placed)?.coolant {
        Coolant::Off => OFF,
        Coolant::Flood if can.flood => flood,
        Coolant::Flood => mist,
        Coolant::Mist if can.mist => mist,
        Coolant::Through { .. } if can.through => Washing { through: true, ..OFF },
        Coolant::Mist | Coolant::Through { .. } => flood,
    };
    let got = placed.cut.coolant;
    if got == wanted {
        return None;
    }
    let more_is_fine = case.target.blocks.iter().any(|b| matches!(b.kind, BlockKind::Insert(_)));
    let missing = wanted.flood && !got.flood || wanted.mist && !got.mist || wanted.through && !got.through;
    (missing || !more_is_fine).then(|| {
        Text::default().words(format!("a cut with {} in place of {}", washing(got), washing(wanted)))
    })
}

/// No coolant.
const OFF: Washing = Washing { flood: false, mist: false, through: false };

fn washing(coolant: Washing) -> String {
    match coolant.names().as_slice() {
        [] => "no coolant".to_owned(),
        names => format!("{} coolant", names.join(" and ")),
    }
}

/// Whether the move is of a hole: they have checks of their own (a tap comes out turning back).
fn in_hole(case: &Case<'_>, placed: &Placed<'_>) -> bool {
    let record = placed.block.and_then(|b| case.target.blocks.get(b)).and_then(|b| b.record);
    record
        .and_then(|r| case.cl.records.get(r as usize))
        .is_some_and(|r| matches!(r.kind, RecordKind::Hole(_)))
}

/// What was asked of the spindle.
fn spindle(case: &Case<'_>, placed: &Placed<'_>) -> Option<Text> {
    if in_hole(case, placed) {
        return None;
    }
    let wanted = asked(case, placed)?.spindle;
    let got = placed.cut.spindle;
    (got != 0.0 && (got - wanted).abs() > SPEED_TOLERANCE)
        .then(|| Text::default().words(format!("a cut at {} in place of {}", turning(got), turning(wanted))))
}

fn turning(rpm: f64) -> String {
    format!("{} rev/min {}", rpm.abs(), if rpm < 0.0 { "counter-clockwise" } else { "clockwise" })
}

/// What was asked for the statement this move is part of.
fn asked(case: &Case<'_>, placed: &Placed<'_>) -> Option<super::plan::Asked> {
    case.orders.record(case.target.blocks.get(placed.block?)?.record?)
}

/// Whether the move has no feed but the one in force: it cuts along a contour or is asked for point by point.
fn is_plain(case: &Case<'_>, placed: &Placed<'_>) -> bool {
    let Some(block) = placed.block.and_then(|b| case.target.blocks.get(b)) else { return false };
    let record = block.record.and_then(|r| case.cl.records.get(r as usize)).map(|r| &r.kind);
    block.piece.is_some()
        || matches!(record, Some(RecordKind::Linear(_) | RecordKind::Circle(_) | RecordKind::Spline(_)))
}

fn feed(case: &Case<'_>, placed: &Placed<'_>) -> Option<Text> {
    let got = placed.cut.feed.unwrap_or(0.0);
    if in_hole(case, placed) || placed.cut.length() == 0.0 {
        return None;
    }
    let text = Text::default();
    if !(got > 0.0 && got.is_finite()) {
        return Some(text.words("a cut without a feed"));
    }
    if let Some(word) = lowered(case, placed).filter(|w| (got - w).abs() > 0.5 * feed_step(case) + 1e-6 * w) {
        return Some(text.words("a feed of ").feed(got).words(" where the lowered program has ").feed(word));
    }
    let near = |wanted: f64| (got - wanted).abs() <= FEED_TOLERANCE * wanted + 0.5 * feed_step(case);
    let said = |wanted: f64| text.clone().words("a feed of ").feed(got).words(" in place of ").feed(wanted);
    if let Some(asked) = asked(case, placed).filter(|_| is_plain(case, placed)) {
        return (!near(asked.feed)).then(|| said(asked.feed));
    }
    let operation = case.context(placed.block).operation;
    if let Some(plunge) = case.orders.plunge(operation).filter(|_| plunges(placed)) {
        return (!near(plunge)).then(|| said(plunge));
    }
    let feeds = case.orders.feeds(operation);
    let nearest = feeds.iter().copied().min_by(|a, b| (a - got).abs().total_cmp(&(b - got).abs()))?;
    (!near(nearest)).then(|| said(nearest))
}

/// Straight down.
fn plunges(placed: &Placed<'_>) -> bool {
    let (from, to) = (placed.cut.start(), placed.cut.end());
    from.xy() == to.xy() && to.z < from.z
}

/// Feed of the lowered block, mm/min along the path; nothing for blocks that turn a table, whose feed depends on more.
#[allow(clippy::cast_precision_loss)]
fn lowered(case: &Case<'_>, placed: &Placed<'_>) -> Option<f64> {
    if matches!(placed.cut.path, crate::readback::TracePath::Spiral { .. }) {
        return None;
    }
    let BlockKind::Motion(motion) = &case.target.blocks.get(placed.block?)?.kind else { return None };
    let feed = match motion {
        Motion::Rapid { .. } => return None,
        Motion::Line { feed, .. } | Motion::Arc { feed, .. } | Motion::Nurbs { feed, .. } => feed,
    };
    let grid = &case.target.capabilities.grid;
    let steps = |decimals: u8, value: i64| value as f64 / power_of_ten(decimals);
    match feed {
        FeedWord::PerMinute(f) => Some(steps(grid.feed_decimals, *f) * grid.unit.in_mm() / grid.feed_scale),
        FeedWord::PerRevolution(f) => {
            let per_turn = steps(grid.feed_per_revolution_decimals, *f) * grid.unit.in_mm();
            Some(per_turn * placed.cut.spindle.abs())
        }
        FeedWord::InverseTime(_) => None,
    }
}

/// One step of the F word, mm/min.
pub(super) fn feed_step(case: &Case<'_>) -> f64 {
    let grid = &case.target.capabilities.grid;
    grid.unit.in_mm() / power_of_ten(grid.feed_decimals) / grid.feed_scale.max(1e-9)
}
