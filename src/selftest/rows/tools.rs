//! Tools, offsets, coolant and stops.

use super::super::judge::Finding;
use super::super::sheet::Sheet;
use super::super::trial::Trial;
use super::{Try, row};
use crate::cl::RecordKind;
use crate::geom::Side;
use crate::ir::{Compensation, Coolant, Spindle};
use crate::readback::{Compensated, EventKind, TraceMove};

pub(in super::super) const CHANGE: Try = row(
    "tools",
    "change to a second tool",
    || {
        Sheet::mm()
            .line(10.0, 0.0, 5.0)
            .watch()
            .tool(2)
            .spindle(800.0)
            .rapid(0.0, 0.0, 5.0)
            .line(10.0, 0.0, 5.0)
    },
    change,
);
pub(in super::super) const SPINDLE: Try = row(
    "tools",
    "spindle clockwise, then counter-clockwise",
    || {
        let first = Sheet::mm().line(10.0, 0.0, 5.0).add(RecordKind::Spindle(Spindle::Off));
        let other = Spindle::on(500.0, false);
        first.add(RecordKind::Spindle(other)).line(20.0, 0.0, 5.0)
    },
    spindle,
);
pub(in super::super) const WORK_OFFSET: Try =
    row("tools", "work offset", || Sheet::mm().line(10.0, 0.0, 5.0), work_offset);
pub(in super::super) const COOLANT: Try = row(
    "tools",
    "flood coolant on and off",
    || {
        let on = Sheet::mm().add(RecordKind::Coolant(Coolant::Flood)).line(10.0, 0.0, 5.0);
        on.add(RecordKind::Coolant(Coolant::Off)).line(20.0, 0.0, 5.0)
    },
    coolant,
);
pub(in super::super) const COMPENSATION: Try = row(
    "tools",
    "cutter compensation left, then none",
    || {
        let on = Compensation { side: Side::Left, register: None };
        let cut = Sheet::mm().add(RecordKind::Compensation(Some(on))).line(10.0, 0.0, 5.0);
        cut.add(RecordKind::Compensation(None)).line(10.0, 20.0, 5.0)
    },
    compensation,
);
pub(in super::super) const STOP: Try = row(
    "tools",
    "program stop",
    || Sheet::mm().add(RecordKind::Stop).line(10.0, 0.0, 5.0),
    |t| stop(t, false),
);
pub(in super::super) const OPTIONAL_STOP: Try = row(
    "tools",
    "optional stop",
    || Sheet::mm().add(RecordKind::OptionalStop).line(10.0, 0.0, 5.0),
    |t| stop(t, true),
);

fn change(trial: &Trial) -> Finding {
    let changes: Vec<u32> = trial
        .events()
        .filter_map(|e| if let EventKind::ToolChange(number) = e.kind { Some(number) } else { None })
        .collect();
    let Some(cut) = trial.cuts().last() else { return Finding::wrong("no cut with the second tool") };
    let spindle = format!("spindle {} rev/min", cut.spindle);
    match changes.as_slice() {
        [2] if cut.tool == 2 => {
            let length = if cut.length_offset {
                "tool length taken in"
            } else {
                "tool length is the control's affair"
            };
            Finding::right(format!("tool 2, {spindle}, {length}"))
        }
        [] if stops(trial) > 0 => Finding::expressed(format!("a stop to change by hand, {spindle}")),
        other => Finding::wrong(format!("changes to {other:?}, cuts with tool {}", cut.tool)),
    }
}

fn stops(trial: &Trial) -> usize {
    trial.events().filter(|e| matches!(e.kind, EventKind::Stop { .. })).count()
}

fn spindle(trial: &Trial) -> Finding {
    let speeds: Vec<f64> = trial.cuts().map(|m| m.spindle).collect();
    match speeds.as_slice() {
        [first, second] if *first == 1000.0 && *second == -500.0 => {
            Finding::right("1000 rev/min clockwise, 500 counter-clockwise")
        }
        other => Finding::wrong(format!(
            "turns at {other:?} rev/min (clockwise positive) instead of 1000 and -500"
        )),
    }
}

fn work_offset(trial: &Trial) -> Finding {
    match trial.cuts().last().and_then(|m| m.work_offset) {
        None => Finding::expressed("left to what is active on the control"),
        Some(n) => Finding::right(format!("work offset {n} is selected")),
    }
}

fn coolant(trial: &Trial) -> Finding {
    let states: Vec<bool> = trial.cuts().map(|m: &TraceMove| m.coolant.flood).collect();
    match states.as_slice() {
        [true, false] => Finding::right("on in the first cut, off in the second"),
        [false, false] => Finding::expressed("the control switches no coolant"),
        other => Finding::wrong(format!("flood in the cuts: {other:?}")),
    }
}

fn compensation(trial: &Trial) -> Finding {
    let states: Vec<Option<Compensated>> = trial.cuts().map(|m| m.compensation).collect();
    match states.as_slice() {
        [Some(Compensated { side: Side::Left, register }), None] => {
            let of = register.map_or_else(|| "the tool's own".to_owned(), |n| format!("in register {n}"));
            Finding::right(format!("left in the first cut, none in the second; the radius is {of}"))
        }
        [None, None] => Finding::expressed("the control has none: the path is as the points say"),
        other => Finding::wrong(format!("compensation in the cuts: {other:?}")),
    }
}

fn stop(trial: &Trial, wanted: bool) -> Finding {
    let kinds: Vec<bool> = trial
        .events()
        .filter_map(|e| if let EventKind::Stop { optional } = e.kind { Some(optional) } else { None })
        .collect();
    match kinds.as_slice() {
        [only] if *only == wanted => Finding::right("the machine stops once"),
        [] if wanted => Finding::expressed("the control has no optional stop"),
        [_] => Finding::expressed("the machine stops, but not in this way"),
        other => Finding::wrong(format!("the machine stops {} times", other.len())),
    }
}
