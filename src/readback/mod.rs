//! An interpreter for emitted programs.
//!
//! # Contract
//! Written from the controllers' manuals; shares no code and no tables with `post`, `lower` or `target`. It
//! takes bytes and a controller family, executes them as that control would, applies the control's own
//! checks (arc radius, illegal in mode, missing feed, unknown or repeated word, line too long …) and gives
//! the [`Trace`]: what the machine does, in mm, radians and seconds.

use crate::geom::{Point2, Point3};

/// What a program makes the machine do.
#[derive(Debug, Clone, Default)]
pub struct Trace {
    /// Moves and events in order.
    pub events: Vec<TraceEvent>,
    /// What the control would complain about.
    pub faults: Vec<Fault>,
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
