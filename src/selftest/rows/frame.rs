//! The program as a whole: start, end, lines, smoothing.

use super::super::judge::Finding;
use super::super::sheet::Sheet;
use super::super::trial::Trial;
use super::{Try, number, row};
use crate::ir::{Feed, Interpolation};
use crate::readback::EventKind;

pub(in super::super) const LENGTH: Try = row(
    "lines",
    "long numbers in all words",
    || {
        let long = Sheet::mm().feed(Feed::PerMinute(1234.5)).line(-1234.567, -1234.567, -123.456);
        long.circle([1234.567, 1234.567, -123.456], [0.0, 0.0, -123.456], [0.0, 0.0, 1.0], 0)
    },
    length,
);
pub(in super::super) const SMOOTHING: Try = row(
    "smoothing",
    "path control for a contour",
    || Sheet::mm().contour(Interpolation::Circular, &[-1.0]),
    smoothing,
);
pub(in super::super) const LEVELS: Try = row(
    "subprograms",
    "a contour at two depths",
    || Sheet::mm().contour(Interpolation::Circular, &[-1.0, -2.0]),
    levels,
);
pub(in super::super) const START: Try = Try {
    whole: true,
    ..row(
        "frame",
        "safe start: nothing is left to the control's settings",
        || Sheet::mm().line(1.0, 0.0, 5.0),
        start,
    )
};
pub(in super::super) const END: Try =
    Try { whole: true, ..row("frame", "end of program", || Sheet::mm().line(1.0, 0.0, 5.0), end) };

fn length(trial: &Trial) -> Finding {
    let longest = trial.lines().iter().map(String::len).max().unwrap_or(0);
    Finding::right(format!("at most {longest} characters, which the control takes"))
}

fn smoothing(trial: &Trial) -> Finding {
    let most = trial.cuts().map(|m| m.path_tolerance).fold(0.0, f64::max);
    if most == 0.0 {
        Finding::right("exact path")
    } else if most.is_finite() {
        Finding::right(format!(
            "the control may leave the path by {} mm; it counts in the proof",
            number(most)
        ))
    } else {
        Finding::expressed("how far the control rounds corners is its own setting")
    }
}

fn levels(trial: &Trial) -> Finding {
    let at = |z: f64| trial.cuts().any(|m| trial.is_at(m.z.0, z) && trial.is_at(m.z.1, z));
    if at(-1.0) && at(-2.0) {
        Finding::right("cut at both depths, without a subprogram")
    } else {
        Finding::wrong("one of the depths is not cut")
    }
}

fn start(trial: &Trial) -> Finding {
    match trial.trace.assumed.as_slice() {
        [] => Finding::right("every modal group is said"),
        several => {
            Finding::expressed(several.iter().map(|f| f.message.clone()).collect::<Vec<_>>().join("; "))
        }
    }
}

fn end(trial: &Trial) -> Finding {
    let ends = trial.trace.events.iter().filter(|e| matches!(e.kind, EventKind::End)).count();
    match (ends, trial.trace.events.last().map(|e| &e.kind)) {
        (1, Some(EventKind::End)) => Finding::right("the program ends once, at its end"),
        (0, _) => Finding::expressed("the control has no end of program: the file just ends"),
        (n, _) => Finding::wrong(format!("the program ends {n} times")),
    }
}
