//! Drilling cycles, kept or expanded.

use super::super::judge::Finding;
use super::super::sheet::Sheet;
use super::super::trial::Trial;
use super::{Try, number, row};
use crate::cl::{CycleKind, RetractTo};

pub(in super::super) const DRILL: Try =
    row("cycles", "drill, back to the clearance level", || two(CycleKind::Drill), |t| levels(t, 2.0));
pub(in super::super) const INITIAL: Try = row(
    "cycles",
    "drill, back to the initial level",
    || Sheet::mm().cycle(CycleKind::Drill, RetractTo::Initial),
    |t| levels(t, 5.0),
);
pub(in super::super) const DEEP: Try =
    row("cycles", "peck, out after each peck", || two(CycleKind::Deep), |t| levels(t, 2.0));
pub(in super::super) const CHIP_BREAK: Try =
    row("cycles", "peck, break the chip", || two(CycleKind::ChipBreak), |t| levels(t, 2.0));
pub(in super::super) const TAP: Try =
    row("cycles", "tap", || two(CycleKind::Tap { pitch: 1.25, left: false }), |t| levels(t, 2.0));
pub(in super::super) const BORE: Try = row("cycles", "bore", || two(CycleKind::Bore), |t| levels(t, 2.0));
pub(in super::super) const BORE_DWELL: Try =
    row("cycles", "bore with a dwell", || two(CycleKind::BoreDwell), |t| levels(t, 2.0));
pub(in super::super) const BORE_STOP: Try =
    row("cycles", "bore, stop the spindle, out at rapid", || two(CycleKind::BoreStop), |t| levels(t, 2.0));
pub(in super::super) const BORE_ORIENT: Try = row(
    "cycles",
    "bore, orient, move off the wall",
    || two(CycleKind::BoreOrient { shift: 0.5 }),
    |t| levels(t, 2.0),
);
pub(in super::super) const MOVE_AFTER: Try = row(
    "cycles",
    "a plain move after a cycle drills nothing",
    || two(CycleKind::Drill).rapid(40.0, 10.0, 5.0).line(50.0, 10.0, 5.0),
    after,
);

fn two(kind: CycleKind) -> Sheet {
    Sheet::mm().cycle(kind, RetractTo::Clearance)
}

/// The holes are 6 mm deep, and the tool goes from one to the other at `between`.
fn levels(trial: &Trial, between: f64) -> Finding {
    let deepest = trial.moves().map(|m| m.z.0.min(m.z.1)).fold(f64::INFINITY, f64::min);
    let travel = trial.moves().find(|m| m.start().x > 1.0 && (m.end().x - m.start().x).abs() > 1.0);
    let level = travel.map(|m| m.z.0);
    if !trial.is_at(deepest, -6.0) || !level.is_some_and(|z| trial.is_at(z, between)) {
        return Finding::wrong(format!(
            "drills to Z{} and travels at {level:?} instead of -6 and {between}",
            number(deepest)
        ));
    }
    let how = format!("to Z-6, back to Z{between}");
    if trial.moves().any(|m| m.in_cycle) {
        Finding::right(format!("the control's own cycle: {how}"))
    } else {
        Finding::expressed(format!("moves of its own: {how}"))
    }
}

fn after(trial: &Trial) -> Finding {
    let holes = trial.moves().filter(|m| m.start().x > 30.0 && m.z.0.min(m.z.1) < 0.0).count();
    if holes > 0 {
        return Finding::wrong("the cycle is still on after its end");
    }
    Finding::right("the cycle is over")
}
