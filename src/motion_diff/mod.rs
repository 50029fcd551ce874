//! Two NC programs compared as motion: what the machine does, not how it is written.
//!
//! Both are executed by the control's interpreter ([`crate::readback`]). Their paths are then walked together
//! ([`walk`]): every corner of one lies within the tolerance of the other, in order, both ways, however the path is
//! cut into blocks. Curves are followed by chords of a hundredth of the tolerance ([`chords`]), so that no
//! reported distance is off by more. Where the paths agree, feeds, spindle, tool and the rest of the state are compared
//! ([`state`]), and stops, dwells and tool changes in their order ([`events`]).

use serde::Serialize;

use crate::geom::Point3;
use crate::readback::{self, Fault, MachineSetup, UnknownControl};

mod chords;
mod events;
pub mod print;
mod state;
mod walk;

pub use events::EventDifference;
pub use state::{Property, StateDifference};

/// When two programs are the same.
#[derive(Debug, Clone, Copy)]
pub struct Tolerance {
    /// Largest distance of the paths, mm.
    pub distance: f64,
    /// Largest relative difference of feeds and spindle speeds.
    pub rate: f64,
}

impl Default for Tolerance {
    fn default() -> Self {
        Tolerance { distance: 0.001, rate: 0.001 }
    }
}

/// How two programs differ.
#[derive(Debug, Clone, Serialize)]
pub struct Comparison {
    /// Length of both paths, mm.
    pub lengths: [f64; 2],
    /// Moves of both programs.
    pub moves: [usize; 2],
    /// Where the paths part, if they do.
    pub path: Option<PathDifference>,
    /// Different feeds, speeds, tools …, one for each stretch.
    pub states: Vec<StateDifference>,
    /// Stops, dwells and tool changes that only one has.
    pub events: Vec<EventDifference>,
    /// What the control has to complain about each.
    pub faults: [Vec<Complaint>; 2],
}

/// A control's complaint.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Complaint {
    /// NC line, from 1.
    pub line: u32,
    /// In the control's terms.
    pub message: String,
}

impl From<&Fault> for Complaint {
    fn from(fault: &Fault) -> Self {
        Complaint { line: fault.line, message: fault.message.clone() }
    }
}

/// Where and how far two paths part.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PathDifference {
    /// NC line of the first move that differs, in both programs.
    pub lines: [u32; 2],
    /// Farthest point of the first move that differs, and the nearest point of the other path that comes in turn, mm.
    pub points: [[f64; 3]; 2],
    /// Their distance, mm.
    pub distance: f64,
    /// Largest distance anywhere, mm.
    pub largest: f64,
    /// Moves that differ, in both programs.
    pub moves: [usize; 2],
}

impl Comparison {
    /// Whether both do the same.
    #[must_use]
    pub fn is_same(&self) -> bool {
        self.path.is_none() && self.states.is_empty() && self.events.is_empty()
    }
    /// Whether the control executes both without a complaint.
    #[must_use]
    pub fn is_executable(&self) -> bool {
        self.faults.iter().all(Vec::is_empty)
    }
}

/// Executes and compares two programs.
///
/// # Errors
/// When no control has this name.
pub fn compare(
    programs: [&[u8]; 2],
    control: &str,
    setup: &MachineSetup,
    tolerance: Tolerance,
) -> Result<Comparison, UnknownControl> {
    let [a, b] = programs;
    let traces = [readback::run(a, control, setup)?, readback::run(b, control, setup)?];
    let [first, second] = &traces;
    let chord = tolerance.distance / 100.0;
    let paths = [chords::path(first, chord), chords::path(second, chord)];
    let walked = walk::both(&paths, tolerance.distance);
    let states = state::compare(&paths, &walked, tolerance);
    Ok(Comparison {
        lengths: [paths[0].length(), paths[1].length()],
        moves: [paths[0].moves.len(), paths[1].moves.len()],
        path: walk::difference(&paths, &walked, tolerance.distance),
        states,
        events: events::compare([first, second], &paths, tolerance.distance),
        faults: [faults(first), faults(second)],
    })
}

fn faults(trace: &readback::Trace) -> Vec<Complaint> {
    trace.faults.iter().map(Complaint::from).collect()
}

fn coordinates(p: Point3) -> [f64; 3] {
    [p.x, p.y, p.z]
}
