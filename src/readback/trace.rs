//! What a program makes the machine do.

use super::{Follow, curve};
use crate::geom::{Point2, Point3, Side, Vec3};

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

/// How complaints of G and M codes begin that the machine does not have.
pub(crate) const UNKNOWN_CODE: &str = "unknown code ";

impl Fault {
    /// The code, when the complaint is that neither control nor machine has it.
    #[must_use]
    pub fn unknown_code(&self) -> Option<&str> {
        self.message.strip_prefix(UNKNOWN_CODE).filter(|name| !name.contains(':'))
    }
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
    /// Tip height at start and end, mm; linear along the move but for [`TracePath::Tilted`] and
    /// [`TracePath::Space`].
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
    /// Z stands where a move to the reference point or in machine coordinates left it, and this move leaves it there.
    pub parked: bool,
    /// Tool length is taken in (G43).
    pub length_offset: bool,
    /// Coolant.
    pub coolant: Washing,
    /// Cutter compensation in force, by which the control moves the path.
    pub compensation: Option<Compensated>,
    /// Work offset in force, as the control counts them: 1 for the first one (G54), 7 for the one after G59; a preset's own
    /// number. `None` when the program has not selected one.
    pub work_offset: Option<u16>,
    /// The move is part of a drilling cycle that the control works off by itself.
    pub in_cycle: bool,
    /// How far the control may leave the path by its own smoothing, mm: 0 on exact path, infinite without a bound.
    pub path_tolerance: f64,
}

/// Compensation of the cutter's radius by the control. Paths are as programmed: the control moves them by what its register
/// holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Compensated {
    /// The side of the path to which it is moved, seen along the way.
    pub side: Side,
    /// The register of the radius, where the program has named one.
    pub register: Option<u32>,
}

impl core::fmt::Display for Compensated {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(if self.side == Side::Left { "left" } else { "right" })?;
        self.register.map_or(Ok(()), |register| write!(f, " by register {register}"))
    }
}

/// What is switched on to wash the cutter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Washing {
    /// M8.
    pub flood: bool,
    /// M7.
    pub mist: bool,
    /// Through the spindle and the tool.
    pub through: bool,
}

impl Washing {
    /// What is on.
    #[must_use]
    pub fn names(self) -> Vec<&'static str> {
        let all = [(self.flood, "flood"), (self.mist, "mist"), (self.through, "through-tool")];
        all.into_iter().filter_map(|(on, name)| on.then_some(name)).collect()
    }
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

/// Path of the cutter axis, seen along Z unless said otherwise.
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
    /// Arc, circle or helix about an axis other than Z: the radius goes linearly with the angle, and so does the way
    /// along the axis.
    Tilted(Tilted),
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
    /// NURBS curve whose height changes.
    Space(Box<SpaceCurve>),
}

/// A NURBS curve in space.
#[derive(Debug, Clone, PartialEq)]
pub struct SpaceCurve {
    /// Order.
    pub order: u8,
    /// Control points.
    pub points: Vec<Point3>,
    /// Weights.
    pub weights: Vec<f64>,
    /// Knots.
    pub knots: Vec<f64>,
}

impl SpaceCurve {
    /// Point at `x` in 0..1 of the domain.
    #[must_use]
    pub fn at(&self, x: f64) -> Point3 {
        curve::space_point(self, x)
    }
    /// Least and greatest coordinate of the control points on an axis (0 X, 1 Y, 2 Z): the curve is between them.
    #[must_use]
    pub fn extent(&self, of: usize) -> (f64, f64) {
        let values = self.points.iter().filter_map(|p| p.coords.get(of));
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)))
    }
    fn first(&self) -> Point3 {
        self.points.first().copied().unwrap_or_else(Point3::origin)
    }
    fn last(&self) -> Point3 {
        self.points.last().copied().unwrap_or_else(Point3::origin)
    }
}

/// An arc, circle or helix in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tilted {
    /// Start.
    pub from: Point3,
    /// End.
    pub to: Point3,
    /// Point of the axis, level with the start.
    pub centre: Point3,
    /// Direction of the axis, of unit length.
    pub axis: Vec3,
    /// Signed sweep in radians, right-handed about `axis` positive.
    pub sweep: f64,
}

impl Tilted {
    /// Radius at the start and at the end, mm.
    #[must_use]
    pub fn radii(&self) -> (f64, f64) {
        let (from, to) = (self.from - self.centre, self.to - self.centre);
        (from.norm(), (to - self.axis * self.axis.dot(&to)).norm())
    }
    /// Way along the axis, mm.
    #[must_use]
    pub fn rise(&self) -> f64 {
        (self.to - self.from).dot(&self.axis)
    }
    /// Unit vectors across the axis: towards the start, and a quarter turn further.
    #[must_use]
    pub fn frame(&self) -> (Vec3, Vec3) {
        let towards = (self.from - self.centre).try_normalize(0.0).unwrap_or_else(Vec3::zeros);
        (towards, self.axis.cross(&towards))
    }
    /// Point at `x` in 0..1.
    #[must_use]
    pub fn at(&self, x: f64) -> Point3 {
        let (r0, r1) = self.radii();
        let (u, v) = self.frame();
        let (s, c) = crate::math::sin_cos(self.sweep * x);
        self.centre + (u * c + v * s) * (r0 + (r1 - r0) * x) + self.axis * (self.rise() * x)
    }
    /// Least and greatest Z.
    #[must_use]
    pub fn heights(&self) -> (f64, f64) {
        self.extent(2)
    }
    /// Least and greatest coordinate on an axis (0 X, 1 Y, 2 Z), up to the change of the radius and the rise along the
    /// axis, which are taken whole.
    #[must_use]
    pub fn extent(&self, of: usize) -> (f64, f64) {
        let mut unit = Vec3::zeros();
        if let Some(slot) = unit.get_mut(of) {
            *slot = 1.0;
        }
        let (r0, r1) = self.radii();
        let (u, v) = self.frame();
        let (a, b) = (u.dot(&unit), v.dot(&unit));
        let (from, to) = ((self.from.coords).dot(&unit), (self.to.coords).dot(&unit));
        let middle = self.centre.coords.dot(&unit);
        let along = self.rise() * self.axis.dot(&unit);
        let swing = r0.max(r1) * crate::math::hypot(a, b);
        let peak = crate::math::atan2(b, a);
        let passes = |angle: f64| {
            let ahead = angle * self.sweep.signum();
            ahead.rem_euclid(crate::math::TAU) <= self.sweep.abs()
        };
        let (mut least, mut most) = (from.min(to), from.max(to));
        if swing > 0.0 && passes(peak) {
            most = most.max(middle + swing + along.max(0.0));
        }
        if swing > 0.0 && passes(peak + crate::math::PI) {
            least = least.min(middle - swing + along.min(0.0));
        }
        (least, most)
    }
}

impl TraceMove {
    /// Length of the path in space, mm.
    #[must_use]
    pub fn length(&self) -> f64 {
        curve::along(&self.path, self.z.1 - self.z.0)
    }
    /// Least and greatest height of the move, mm.
    #[must_use]
    pub fn heights(&self) -> (f64, f64) {
        match &self.path {
            TracePath::Tilted(arc) => arc.heights(),
            TracePath::Space(curve) => curve.extent(2),
            _ => (self.z.0.min(self.z.1), self.z.0.max(self.z.1)),
        }
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
            TracePath::Tilted(arc) => arc.from.xy(),
            TracePath::Spiral { radius, angle } => polar(radius.0, angle.0),
            TracePath::Nurbs { points, .. } => points.first().copied().unwrap_or_else(Point2::origin),
            TracePath::Space(curve) => curve.first().xy(),
        }
    }
    /// Last point.
    #[must_use]
    pub fn end(&self) -> Point2 {
        match self {
            TracePath::Line { to, .. } | TracePath::Arc { to, .. } => *to,
            TracePath::Tilted(arc) => arc.to.xy(),
            TracePath::Spiral { radius, angle } => polar(radius.1, angle.1),
            TracePath::Nurbs { points, .. } => points.last().copied().unwrap_or_else(Point2::origin),
            TracePath::Space(curve) => curve.last().xy(),
        }
    }
}

fn polar(radius: f64, angle: f64) -> Point2 {
    let (s, c) = crate::math::sin_cos(angle);
    Point2::new(radius * c, radius * s)
}
