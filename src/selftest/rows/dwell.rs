//! Dwells: a factor of a thousand is silent in both directions.

use super::super::judge::Finding;
use super::super::sheet::Sheet;
use super::super::trial::Trial;
use super::{Try, number, row};
use crate::cl::{CycleKind, RecordKind, RetractTo};

pub(in super::super) const BLOCK: Try =
    row("dwell", "0.5 s in a block of its own", || dwell(0.5), |t| one(t, 0.5));
pub(in super::super) const LONG: Try =
    row("dwell", "12.25 s in a block of its own", || dwell(12.25), |t| one(t, 12.25));
pub(in super::super) const CYCLE: Try = row(
    "dwell",
    "0.25 s at the bottom of two holes",
    || Sheet::mm().cycle(CycleKind::Dwell, RetractTo::Clearance),
    in_cycle,
);

fn dwell(seconds: f64) -> Sheet {
    Sheet::mm().add(RecordKind::Dwell(seconds))
}

fn one(trial: &Trial, wanted: f64) -> Finding {
    match trial.dwells().as_slice() {
        [only] if (only - wanted).abs() <= 0.0005 => Finding::right(format!("{} s", number(*only))),
        other => Finding::wrong(format!("the machine dwells {other:?} s instead of {wanted} s")),
    }
}

fn in_cycle(trial: &Trial) -> Finding {
    let dwells = trial.dwells();
    if dwells.len() != 2 || dwells.iter().any(|d| (d - 0.25).abs() > 0.0005) {
        return Finding::wrong(format!("the machine dwells {dwells:?} s instead of 0.25 s twice"));
    }
    if trial.moves().any(|m| m.in_cycle) {
        Finding::right("0.25 s, in the control's cycle")
    } else {
        Finding::expressed("0.25 s, in moves of its own")
    }
}
