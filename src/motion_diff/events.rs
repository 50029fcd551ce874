//! Stops, dwells, tool changes and ends, in their order.

use serde::Serialize;
use similar::{Algorithm, ChangeTag, capture_diff_slices};

use super::chords::Path;
use super::coordinates;
use super::state::number;
use crate::geom::Point3;
use crate::readback::{EventKind, Trace};

/// An event that only one of the programs has, or that both have at different places.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EventDifference {
    /// What happens.
    pub event: String,
    /// NC line in each program that has it.
    pub lines: [Option<u32>; 2],
    /// Where, mm, in each program that has it.
    pub points: [Option<[f64; 3]>; 2],
}

struct Event {
    what: String,
    line: u32,
    point: Point3,
}

/// Every difference, in order.
pub(super) fn compare(traces: [&Trace; 2], paths: &[Path<'_>; 2], tolerance: f64) -> Vec<EventDifference> {
    let [a, b] = [of(traces[0], &paths[0]), of(traces[1], &paths[1])];
    let names = |events: &[Event]| events.iter().map(|e| e.what.clone()).collect::<Vec<_>>();
    let (old, new) = (names(&a), names(&b));
    let mut found = Vec::new();
    for op in capture_diff_slices(Algorithm::Myers, &old, &new) {
        for change in op.iter_changes(&old, &new) {
            let own = change.old_index().and_then(|i| a.get(i));
            let theirs = change.new_index().and_then(|i| b.get(i));
            let moved = own.zip(theirs).is_some_and(|(a, b)| (a.point - b.point).norm() > tolerance);
            if change.tag() != ChangeTag::Equal || moved {
                found.push(EventDifference {
                    event: change.value(),
                    lines: [own.map(|e| e.line), theirs.map(|e| e.line)],
                    points: [own.map(|e| coordinates(e.point)), theirs.map(|e| coordinates(e.point))],
                });
            }
        }
    }
    found
}

fn of(trace: &Trace, path: &Path<'_>) -> Vec<Event> {
    let events = trace.events.iter().zip(&path.after);
    let named = |(event, after): (&crate::readback::TraceEvent, &usize)| {
        let what = match &event.kind {
            EventKind::Move(_) => return None,
            EventKind::ToolChange(number) => format!("change to tool {number}"),
            EventKind::Dwell(seconds) => format!("dwell of {} s", number(*seconds)),
            EventKind::Stop { optional: false } => "stop".to_owned(),
            EventKind::Stop { optional: true } => "optional stop".to_owned(),
            EventKind::End => "end of program".to_owned(),
        };
        let point = path.points.get(*after).copied().unwrap_or_else(Point3::origin);
        Some(Event { what, line: event.line, point })
    };
    events.filter_map(named).collect()
}
