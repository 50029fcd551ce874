//! Cutter location data: moves along exact curves, plus machine events.
//!
//! # Contract
//! - Positions are the tool tip's, mm, part coordinates. Nothing is fitted or rounded: a [`Contour`] carries
//!   the exact cutter-centre curve and the band it may be left in; `lower` chooses its vertices.
//! - Records are in execution order. The state before the first record is: no tool, spindle and coolant off,
//!   position unknown, no feed.
//! - A [`Circle`] starts where the record before it left the cutter, which is known and lies on it; the first control point of
//!   a [`Spline`] is there.
//! - Between `BeginCycle` and `EndCycle` every point is a `Hole`; other motion ends the cycle first.
//! - Before a record that cuts (`Linear`, `Circle`, `Spline`, `Contour`, `Hole`), a tool, a spindle command and a feed have been given;
//!   the planner reports where they are missing.
//! - Every record knows its [`Origin`]; records between `BeginOperation` and `EndOperation` belong to that
//!   operation.

use std::sync::Arc;

use crate::arena::{Arena, Handle};
use crate::geom::curve::CurveRef;
use crate::geom::surface::heights::Blank;
use crate::geom::surface::{Cutter, SurfaceTree, Track};
use crate::geom::{Point3, Side, Vec3};
use crate::ir::{Along, Band, Compensation, Coolant, Feed, Interpolation, Origin, PassShape, Spindle, Tool};
use crate::units::LengthUnit;

pub mod lead;
pub mod print;
pub mod spline;

pub use crate::ir::cycle::{Cycle, CycleKind, RetractTo};
pub use spline::Spline;

/// Cutter location data of one program.
#[derive(Debug, Clone, Default)]
pub struct Cl {
    /// Title.
    pub title: Option<String>,
    /// The program's unit, for output in the user's unit.
    pub units: LengthUnit,
    /// The cutters in use.
    pub tools: Arena<Tool>,
    /// Where records came from.
    pub origins: Arena<Origin>,
    /// The operations, in order.
    pub operations: Vec<Operation>,
    /// Records in order.
    pub records: Vec<Record>,
}

/// What is known of an operation, for proof and report.
#[derive(Debug, Clone)]
pub struct Operation {
    /// The user's label, or a name made from kind and number.
    pub name: String,
    /// `PROFIL`, `ROUGH` …
    pub kind: &'static str,
    /// The statement.
    pub origin: Handle<Origin>,
    /// Tolerance asked for.
    pub band: Band,
    /// What the cutter must stay out of (and rapids clear of).
    pub guard: Guard,
    /// What clearing takes, for operations that remove bulk stock.
    pub effort: Option<Effort>,
}

/// What a clearing operation takes, over all its levels, for the report.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Effort {
    /// Path on which the cutter is meant to be in the stock, mm.
    pub engaged: f64,
    /// Path at feed between passes, mm.
    pub links: f64,
    /// Both at the cutting feed, s; `None` when the feed is not per minute.
    pub time: Option<f64>,
    /// Area to remove at one level, mm².
    pub area: f64,
    /// Largest radial depth of cut, mm.
    pub engagement: f64,
    /// Axial levels.
    pub levels: u32,
    /// Path that no plan of straight or outward-curved passes can go below at this radial depth: area over
    /// depth, times levels, mm.
    pub bound: f64,
}

/// The material that `verify` protects during an operation and after it.
#[derive(Debug, Clone, Default)]
pub struct Guard {
    /// Finished part walls: cutter-centre curves of exact contact, with the part's side of each. A cutter
    /// centre deeper on the part's side than the band's `into` at a height below `top` is a gouge.
    pub walls: Vec<Wall>,
    /// Blank round about the origin, radius in mm, if declared: rapids below `top` must stay clear of it.
    pub blank_radius: Option<f64>,
    /// The surface that is finished, if one is.
    pub surface: Option<Finish>,
    /// What is cleared down to it, where it is not finished but roughed.
    pub clearing: Option<Clearing>,
    /// Height above which everything is clear, mm (part's top).
    pub top: f64,
    /// Bottom of the operation, mm.
    pub bottom: f64,
}

/// A surface that a cutter finishes.
#[derive(Debug, Clone)]
pub struct Finish {
    /// The surface.
    pub tree: Arc<SurfaceTree>,
    /// Radius of the cutter, mm.
    pub radius: f64,
    /// The cutter itself.
    pub cutter: Cutter,
    /// Stock to leave, mm.
    pub leave: f64,
    /// Largest height of the cusps between passes, mm, where that was asked for.
    pub cusp: Option<f64>,
    /// How its passes follow one another, where that was tried out.
    pub march: Option<March>,
}

/// How passes follow one another over a surface, where that is not said. It is tried out; a plan that is made again keeps it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum March {
    /// A ball's contacts on curves in the parameters.
    Contacts(Contacts),
    /// The axis of another cutter over lines in plan.
    Over(Over),
}

/// What the axis of a cutter runs over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Over {
    /// Curves in plan that run about as a parameter does (0: u).
    Bent(usize),
    /// Lines of the parameters, or straight ones.
    Straight(Along),
}

/// How passes that bend in the parameters follow one another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Contacts {
    /// The parameter that passes run along (0: u).
    pub axis: usize,
    /// Where they begin.
    pub start: Start,
    /// Whether they lie closer than they must, and have more room to the side.
    pub roomy: bool,
}

/// Where passes begin that follow one another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// On the border where the other parameter is least.
    First,
    /// On the one where it is most.
    Last,
    /// In the middle, to both sides.
    Middle,
}

/// A blank that is cleared in levels down to a surface.
#[derive(Debug, Clone)]
pub struct Clearing {
    /// Its outline.
    pub blank: Blank,
    /// Its top, mm.
    pub top: f64,
    /// Largest depth of a level, mm.
    pub step: f64,
    /// The plan keeps so much more than is to be left from the surface, mm.
    pub margin: f64,
    /// The levels, from above.
    pub levels: Vec<Level>,
}

/// A level of a clearing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Level {
    /// Height of the tip, mm.
    pub z: f64,
    /// Area in which the tip may be there, mm².
    pub area: f64,
    /// Area of it that the cutter does not come near, and that was told, mm².
    pub standing: f64,
}

/// A wall as the cutter's centre sees it.
#[derive(Debug, Clone)]
pub struct Wall {
    /// Cutter centre curve in exact contact, no allowance.
    pub centre: CurveRef,
    /// The side of the directed curve on which the part lies.
    pub part: Side,
}

/// One record.
#[derive(Debug, Clone)]
pub struct Record {
    /// What.
    pub kind: RecordKind,
    /// Where from.
    pub origin: Handle<Origin>,
}

/// The kinds of record.
#[derive(Debug, Clone)]
pub enum RecordKind {
    /// An operation starts: index into [`Cl::operations`].
    BeginOperation(u32),
    /// The operation ends.
    EndOperation(u32),
    /// Tool change.
    LoadTool(Handle<Tool>),
    /// Spindle.
    Spindle(Spindle),
    /// Feed; never [`Feed::PerTooth`].
    Feed(Feed),
    /// Coolant.
    Coolant(Coolant),
    /// Compensation of the cutter's radius by the control, from the next move in X or Y on; `None` ends it there.
    Compensation(Option<Compensation>),
    /// Dwell, seconds.
    Dwell(f64),
    /// Stop.
    Stop,
    /// Optional stop.
    OptionalStop,
    /// Comment.
    Comment(String),
    /// Verbatim block.
    Insert(String),
    /// The cutter is here, or goes here at rapid.
    From(Point3),
    /// Straight at rapid.
    Rapid(Point3),
    /// Straight at feed.
    Linear(Point3),
    /// Along an arc or a helix at feed, from where the cutter is.
    Circle(Box<Circle>),
    /// Along a spline at feed, from where the cutter is.
    Spline(Box<Spline>),
    /// Along the surface at feed, from where the cutter is.
    Pass(Box<Pass>),
    /// Along an exact curve at feed.
    Contour(Box<Contour>),
    /// A drilling cycle starts: every [`RecordKind::Hole`] until the end is made by it. The height of the cutter
    /// here is the initial level.
    BeginCycle(Box<Cycle>),
    /// A hole: its point on the surface that depth and clearance count from.
    Hole(Point3),
    /// The cycle ends.
    EndCycle,
}

impl RecordKind {
    /// Whether the cutter moves.
    #[must_use]
    pub fn moves(&self) -> bool {
        matches!(
            self,
            RecordKind::From(_)
                | RecordKind::Rapid(_)
                | RecordKind::Linear(_)
                | RecordKind::Circle(_)
                | RecordKind::Spline(_)
                | RecordKind::Hole(_)
                | RecordKind::Pass(_)
                | RecordKind::Contour(_)
        )
    }
}

/// An arc or a helix from where the cutter is, by the right-hand rule about its axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    /// End.
    pub to: Point3,
    /// A point of the axis.
    pub centre: Point3,
    /// Unit vector along the axis; the turn is counter-clockwise seen against it.
    pub axis: Vec3,
    /// Full turns beyond the sweep (of more than 0 and at most a full turn) that the end points ask for.
    pub turns: u32,
    /// How far the path may leave the exact curve, mm.
    pub tolerance: f64,
}

/// A pass over a surface, or the way from one pass to the next.
#[derive(Debug, Clone)]
pub struct Pass {
    /// The exact curve of the cutter's reference point (a ball's centre).
    pub track: Track,
    /// Height of that point above the tip, mm.
    pub tip: f64,
    /// How far into the surface and out of it the path may be, as seen by the cutter: about the track's own hull.
    pub band: Band,
    /// It is the way from one pass to the next.
    pub link: bool,
    /// What it may be made of.
    pub shape: PassShape,
    /// How far the path may be to the side of the track, mm, at equidistant parameters from 0 to 1: what the distance
    /// to its neighbours leaves. Empty: as far as it likes.
    pub room: Vec<f64>,
}

/// A cut along an exact planar curve in the XY plane, at one or several heights.
#[derive(Debug, Clone)]
pub struct Contour {
    /// Exact cutter-centre curve, directed as cut.
    pub curve: CurveRef,
    /// The side of travel on which the part lies; the band's `into` counts towards it.
    pub part: Side,
    /// The band about `curve` in which the cutter centre must stay.
    pub band: Band,
    /// How to express it.
    pub interpolation: Interpolation,
    /// Keep spans that are exact arcs or lines exact.
    pub exact_dwells: bool,
    /// Tip heights, mm, in the order they are cut.
    pub levels: Vec<f64>,
    /// Lead in; from above at `clearance` when it is not [`Lead::None`].
    pub entry: Lead,
    /// Lead out.
    pub exit: Lead,
    /// Height for the approach to each level and the retract after it, mm.
    pub clearance: f64,
    /// Height down to which the approach may be at rapid, mm (>= the stock's top).
    pub approach: f64,
    /// Feed for plunging, mm/min, if other than the cutting feed.
    pub plunge_feed: Option<f64>,
    /// Preferred start parameter of a closed curve; lowering may move it by up to one block.
    pub start: Option<f64>,
}

/// How a contour is joined to the rest ([`lead`] has the geometry). Leads lie on the side away from the part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Lead {
    /// Start (end) of the curve itself, no approach and no retract: the cutter is at the level's height
    /// already, at or near the curve's first point, and goes there straight at feed.
    None,
    /// Straight down at the first (up at the last) point.
    Plunge,
    /// Quarter circle of this radius, mm, tangent to the contour.
    Arc(f64),
    /// Straight tangent line of this length, mm.
    Line(f64),
}
