//! An interpreter for emitted programs.
//!
//! # Contract
//! Written from the controllers' manuals; shares no code and no tables with `post`, `lower` or `target`. It
//! takes bytes and a controller family, executes them as that control would, applies the control's own
//! checks (arc radius, illegal in mode, missing feed, unknown or repeated word, line too long …) and gives
//! the [`Trace`]: what the machine does, in mm, radians and seconds.

//!
//! A control is a row of [`rules::Rules`] and its two code tables for the word-address family; another family is
//! another interpreter beside this one, behind the same [`run`]. Blocks are executed one by one and handed to a
//! [`Follow`]er as they come, so that the length of a program is no bound on memory.

use crate::geom::{Point2, Point3};

mod arc;
mod block;
mod codes;
mod fanuc;
mod grbl;
mod length;
mod linuxcnc;
mod machine;
mod motion;
mod number;
mod nurbs;
mod rules;

#[cfg(test)]
pub(crate) use nurbs::point as nurbs_point;

#[cfg(test)]
mod tests;

/// The machine about the control, as far as a program's meaning depends on it.
#[derive(Debug, Clone, Default)]
pub struct MachineSetup {
    /// Rotary table under the spindle, if there is one.
    pub rotary: Option<Rotary>,
    /// Tool numbers in the tool table; `None`: any.
    pub tools: Option<Vec<u32>>,
}

/// A rotary table whose axis is the part's Z axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rotary {
    /// Address letter, upper case.
    pub letter: char,
    /// Against ISO 841: programmed + moves the tool clockwise relative to the work.
    pub reversed: bool,
}

impl MachineSetup {
    fn rotary_letter(&self) -> Option<u8> {
        self.rotary
            .and_then(|r| u8::try_from(r.letter).ok())
            .filter(|l| matches!(l, b'A'..=b'C' | b'U'..=b'W'))
    }
}

/// Takes what the machine does, as it does it.
pub trait Follow {
    /// A move or an event.
    fn event(&mut self, event: TraceEvent);
    /// A complaint of the control.
    fn fault(&mut self, fault: Fault);
    /// Something the program leaves to the control's settings.
    fn assumed(&mut self, what: Fault);
}

/// No control of this name is known.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownControl(pub String);

impl core::fmt::Display for UnknownControl {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(
            f,
            "no interpreter for the control '{}'; there are {}",
            self.0,
            CONTROLS.map(|c| c.name).join(", ")
        )
    }
}

impl core::error::Error for UnknownControl {}

const CONTROLS: [&rules::Rules; 3] = [&linuxcnc::RULES, &fanuc::RULES, &grbl::RULES];

/// Names of the controls that can be read.
pub fn controls() -> impl Iterator<Item = &'static str> {
    CONTROLS.into_iter().map(|c| c.name)
}

/// What a cut on this control needs, as facts of the control.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Needs {
    /// A tool must have been changed in by the program.
    pub tool_change: bool,
    /// Tool length must have been taken in by the program (G43).
    pub length_offset: bool,
}

/// What a cut on `control` needs; `None` for an unknown control.
#[must_use]
pub fn needs(control: &str) -> Option<Needs> {
    find(control).map(|r| Needs { tool_change: r.tool_change, length_offset: r.length_offset })
}

fn find(control: &str) -> Option<&'static rules::Rules> {
    CONTROLS.into_iter().find(|c| c.name == control)
}

/// Executes a program and gathers what the machine does.
///
/// # Errors
/// When no control has this name.
pub fn run(text: &[u8], control: &str, machine: &MachineSetup) -> Result<Trace, UnknownControl> {
    let mut trace = Trace::default();
    run_with(text, control, machine, &mut trace)?;
    Ok(trace)
}

/// Executes a program and hands on what the machine does while it does it. Memory is bounded by the longest line (and
/// the longest NURBS curve).
///
/// # Errors
/// When no control has this name.
pub fn run_with<S: Follow>(
    text: &[u8],
    control: &str,
    machine: &MachineSetup,
    sink: &mut S,
) -> Result<(), UnknownControl> {
    let mut interpreter = Interpreter::new(control, machine)?;
    for line in text.split_inclusive(|&c| c == b'\n') {
        interpreter.line(line, sink);
    }
    interpreter.finish(sink);
    Ok(())
}

/// An interpreter that is fed line by line.
#[derive(Debug)]
pub struct Interpreter<'a> {
    machine: machine::Machine<'a>,
    block: block::Block,
    line: u32,
}

impl<'a> Interpreter<'a> {
    /// A control as it stands after power-on.
    ///
    /// # Errors
    /// When no control has this name.
    pub fn new(control: &str, setup: &'a MachineSetup) -> Result<Self, UnknownControl> {
        let rules = find(control).ok_or_else(|| UnknownControl(control.to_owned()))?;
        Ok(Interpreter {
            machine: machine::Machine::new(rules, setup),
            block: block::Block::default(),
            line: 0,
        })
    }

    /// Executes a line, with or without its line end.
    pub fn line<S: Follow>(&mut self, line: &[u8], sink: &mut S) {
        self.line = self.line.saturating_add(1);
        let line = line.strip_suffix(b"\n").unwrap_or(line);
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        let mut out = machine::Out { sink, line: self.line };
        let rules = self.machine.rules;
        block::read(line, rules, &mut self.block, &mut |message| out.fault(message));
        if rules.line_limit.is_some_and(|limit| self.block.length > limit) {
            out.fault(format!(
                "the line has {} characters, the control takes {}",
                self.block.length,
                rules.line_limit.unwrap_or_default()
            ));
        }
        self.machine.execute(&self.block, &mut out);
    }

    /// The text is over.
    pub fn finish<S: Follow>(&mut self, sink: &mut S) {
        let mut out = machine::Out { sink, line: self.line };
        self.machine.end_of_text(&mut out);
    }
}

/// Most complaints kept in a [`Trace`]; a program with more is broken all over.
pub const MOST_FAULTS: usize = 1000;

impl Follow for Trace {
    fn event(&mut self, event: TraceEvent) {
        self.events.push(event);
    }
    fn fault(&mut self, fault: Fault) {
        if self.faults.len() < MOST_FAULTS {
            self.faults.push(fault);
        }
    }
    fn assumed(&mut self, what: Fault) {
        if self.assumed.len() < MOST_FAULTS {
            self.assumed.push(what);
        }
    }
}

/// What a program makes the machine do.
#[derive(Debug, Clone, Default)]
pub struct Trace {
    /// Moves and events in order.
    pub events: Vec<TraceEvent>,
    /// What the control would complain about, the first [`MOST_FAULTS`].
    pub faults: Vec<Fault>,
    /// What the program leaves to the control's settings, instead of saying it.
    pub assumed: Vec<Fault>,
}

/// The control's complaint.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// Line of the NC text, from 1.
    pub line: u32,
    /// In the control's terms, with the numbers.
    pub message: String,
}

/// One thing the machine does.
#[derive(Debug, Clone)]
pub struct TraceEvent {
    /// Line of the NC text, from 1.
    pub line: u32,
    /// What.
    pub kind: EventKind,
}

/// Kinds of event.
#[derive(Debug, Clone)]
pub enum EventKind {
    /// A move.
    Move(TraceMove),
    /// Tool change to this number.
    ToolChange(u32),
    /// Dwell, seconds.
    Dwell(f64),
    /// Program stop (M0/M1).
    Stop {
        /// Optional (M1).
        optional: bool,
    },
    /// End of program.
    End,
}

/// A move with the modal state at its time. 64-bit floats in mm; `rotary` in degrees.
#[derive(Debug, Clone)]
pub struct TraceMove {
    /// Where the cutter goes, in the part's frame.
    pub path: TracePath,
    /// Tip height at start and end, mm (linear along the move).
    pub z: (f64, f64),
    /// Rapid.
    pub rapid: bool,
    /// Feed, mm/min along the path in the part (`None` at rapid); see [`TraceMove::feed_mode`].
    pub feed: Option<f64>,
    /// How the feed was programmed.
    pub feed_mode: FeedMode,
    /// Spindle: revolutions per minute, negative counter-clockwise, 0 off.
    pub spindle: f64,
    /// Tool number, 0 none.
    pub tool: u32,
    /// Whether X, Y, Z were known before this move (a program may start anywhere).
    pub known: [bool; 3],
    /// Tool length is taken in (G43).
    pub length_offset: bool,
    /// How far the control may leave the path by its own smoothing, mm: 0 on exact path, infinite without a bound.
    pub path_tolerance: f64,
}

/// Feed modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FeedMode {
    /// G94.
    PerMinute,
    /// G95.
    PerRevolution,
    /// G93.
    InverseTime,
}

/// Path of the cutter axis in the XY plane of the part.
#[derive(Debug, Clone)]
pub enum TracePath {
    /// Straight line (also a pure Z move, where both ends are the same).
    Line {
        /// Start.
        from: Point2,
        /// End.
        to: Point2,
    },
    /// Arc or circle as the control draws it: about `centre`, the radius going linearly with the angle from
    /// |from − centre| to |to − centre|.
    Arc {
        /// Start.
        from: Point2,
        /// End.
        to: Point2,
        /// Centre.
        centre: Point2,
        /// Signed sweep in radians, counter-clockwise positive.
        sweep: f64,
    },
    /// Archimedean spiral: polar radius and angle about the table's centre both linear in time.
    Spiral {
        /// Signed radius (machine X) at start and end, mm.
        radius: (f64, f64),
        /// Angle of the cutter in the part at start and end, radians, not reduced.
        angle: (f64, f64),
    },
    /// NURBS curve.
    Nurbs {
        /// Order.
        order: u8,
        /// Control points.
        points: Vec<Point2>,
        /// Weights.
        weights: Vec<f64>,
        /// Knots.
        knots: Vec<f64>,
    },
}

impl TraceMove {
    /// Length of the path in space, mm.
    #[must_use]
    pub fn length(&self) -> f64 {
        length::along(&self.path, self.z.1 - self.z.0)
    }
    /// First point of the move.
    #[must_use]
    pub fn start(&self) -> Point3 {
        let p = self.path.start();
        Point3::new(p.x, p.y, self.z.0)
    }
    /// Last point of the move.
    #[must_use]
    pub fn end(&self) -> Point3 {
        let p = self.path.end();
        Point3::new(p.x, p.y, self.z.1)
    }
}

impl TracePath {
    /// First point.
    #[must_use]
    pub fn start(&self) -> Point2 {
        match self {
            TracePath::Line { from, .. } | TracePath::Arc { from, .. } => *from,
            TracePath::Spiral { radius, angle } => polar(radius.0, angle.0),
            TracePath::Nurbs { points, .. } => points.first().copied().unwrap_or_else(Point2::origin),
        }
    }
    /// Last point.
    #[must_use]
    pub fn end(&self) -> Point2 {
        match self {
            TracePath::Line { to, .. } | TracePath::Arc { to, .. } => *to,
            TracePath::Spiral { radius, angle } => polar(radius.1, angle.1),
            TracePath::Nurbs { points, .. } => points.last().copied().unwrap_or_else(Point2::origin),
        }
    }
}

fn polar(radius: f64, angle: f64) -> Point2 {
    let (s, c) = crate::math::sin_cos(angle);
    Point2::new(radius * c, radius * s)
}
