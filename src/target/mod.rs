//! The legal program of one controller, in integers of its output grid.
//!
//! # Contract
//! - Every coordinate is an integer multiple of the controller's decimal step ([`Grid`]); what is printed is
//!   exactly what is here, so rounding is over before text exists.
//! - Every motion is one the controller can do ([`Capabilities`]); arcs satisfy the tightest end-point radius
//!   check known, on the integers.
//! - Positions are absolute; modality, word order and spelling are the writer's.

use std::collections::{BTreeMap, BTreeSet};

use crate::arena::Handle;
use crate::geom::Side;
use crate::geom::curve::CurveRef;
use crate::ir::CycleName;
use crate::ir::{Band, Compensation, Coolant, Origin, Spindle, Tool};
use crate::units::LengthUnit;

mod arc;
pub mod number;
mod nurbs;
pub mod print;

pub use arc::GridArc;
pub use nurbs::{Nurbs, NurbsForm};

/// The output grid: what one integer step means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Output unit.
    pub unit: LengthUnit,
    /// Decimals of a linear axis in that unit.
    pub linear_decimals: u8,
    /// Decimals of a rotary axis in degrees.
    pub rotary_decimals: u8,
    /// Decimals of arc-centre words.
    pub centre_decimals: u8,
    /// Decimals of a feed per minute.
    pub feed_decimals: u8,
    /// Decimals of a feed per revolution.
    pub feed_per_revolution_decimals: u8,
    /// Decimals of an inverse time feed.
    pub inverse_time_decimals: u8,
    /// What is printed for a feed of one output unit a minute (10 where inch feeds are in 0.1 inch/min).
    pub feed_scale: f64,
}

impl Grid {
    /// mm in one step of a linear axis.
    #[must_use]
    pub fn linear_step(&self) -> f64 {
        self.unit.in_mm() / power_of_ten(self.linear_decimals)
    }
    /// Degrees in one step of a rotary axis.
    #[must_use]
    pub fn rotary_step(&self) -> f64 {
        1.0 / power_of_ten(self.rotary_decimals)
    }
    /// mm in one step of an arc-centre word.
    #[must_use]
    pub fn centre_step(&self) -> f64 {
        self.unit.in_mm() / power_of_ten(self.centre_decimals)
    }
}

/// 10^`decimals`.
#[must_use]
pub fn power_of_ten(decimals: u8) -> f64 {
    (0..decimals).fold(1.0, |product, _| product * 10.0)
}

/// A full-circle rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FullCircle {
    /// One block.
    Whole,
    /// Must be split in this many arcs at least.
    Split(u8),
}

/// What a controller can do, as far as lowering must know. Read from its dialect file.
#[derive(Debug, Clone, PartialEq)]
pub struct Capabilities {
    /// Post name, for messages.
    pub name: String,
    /// Output grid.
    pub grid: Grid,
    /// Circular interpolation in the XY plane.
    pub arcs: bool,
    /// Planes of circular interpolation; XY is among them when there are arcs.
    pub planes: BTreeMap<Plane, PlaneArcs>,
    /// Drilling cycles that are kept; others become moves.
    pub cycles: BTreeSet<CycleName>,
    /// Those of them that take a dwell, besides `Dwell` and `BoreDwell`.
    pub dwelling_cycles: BTreeSet<CycleName>,
    /// Z stands at its upper end after a tool change, so that the first move may go across before it goes down.
    pub parks: bool,
    /// Every move says X, Y and Z, and rapid moves go straight to their point.
    pub whole_points: bool,
    /// Largest sweep of one arc block, radians (2π when a full circle is fine).
    pub max_sweep: f64,
    /// Full circles.
    pub full_circle: FullCircle,
    /// Smallest and largest radius, mm.
    pub radius_range: (f64, f64),
    /// Largest |start radius − end radius| in printed numbers, mm.
    pub radius_tolerance: f64,
    /// NURBS form, if any.
    pub nurbs: Option<NurbsForm>,
    /// NURBS may change Z.
    pub nurbs_in_space: bool,
    /// Rotary table, if the machine has one: letter, and whether it turns against ISO 841.
    pub rotary: Option<RotaryAxis>,
    /// Feed per revolution available.
    pub feed_per_revolution: bool,
    /// Inverse time feed available.
    pub inverse_time: bool,
    /// How feed is meant when a linear and a rotary axis move together.
    pub rotary_feed: RotaryFeed,
    /// Largest share of an operation's tolerance that the control's own path smoothing takes, mm; asked of
    /// the control by a word (LinuxCNC `G64 P`), and subtracted from the band. `None`: exact path.
    pub path_tolerance: Option<PathTolerance>,
    /// Travel limits of X, Y, Z in mm, in program coordinates, where declared.
    pub travel: [Option<(f64, f64)>; 3],
    /// Largest numbers that fit the words.
    pub ranges: Ranges,
    /// Mist coolant can be switched.
    pub mist: bool,
    /// Flood coolant can be switched.
    pub flood: bool,
    /// Coolant through the tool can be switched.
    pub through: bool,
    /// Compensation of the cutter's radius by the control, if it has one.
    pub compensation: Option<Register>,
    /// Optional stop.
    pub optional_stop: bool,
    /// After a stop of the program spindle and coolant are said again before the next move.
    pub restart: bool,
    /// What templates read as `options`: the post's own values and those that `MACHIN` changes.
    pub options: std::collections::BTreeMap<String, String>,
    /// The work offset that the program is to select, as the control counts them (1 for the first one); `None` where the
    /// post selects none, or one that is not known by its number.
    pub work_offset: Option<u16>,
    /// Slowest and fastest spindle speed, rev/min, where declared.
    pub spindle: Option<(f64, f64)>,
}

/// The arcs of a plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PlaneArcs {
    /// The third axis may move in an arc block.
    pub helix: bool,
    /// The control is told a place between the ends, not the centre.
    pub by_middle: bool,
}

impl Capabilities {
    /// How full circles are written in a plane.
    #[must_use]
    pub fn full_circle(&self, plane: Plane) -> FullCircle {
        if self.by_middle(plane) { FullCircle::Split(2) } else { self.full_circle }
    }

    /// Whether curves are fitted to contours: the control has some and cuts them as such.
    #[must_use]
    pub fn fits_curves(&self) -> bool {
        match self.nurbs {
            None => false,
            Some(NurbsForm::Pieces { chord, .. }) => chord <= 0.0,
            Some(NurbsForm::G062 { .. } | NurbsForm::G052) => true,
        }
    }

    /// Whether arcs of a plane are told by a place between their ends.
    #[must_use]
    pub fn by_middle(&self, plane: Plane) -> bool {
        self.planes.get(&plane).is_some_and(|arcs| arcs.by_middle)
    }
}

/// Largest printed magnitudes of words, in their steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ranges {
    /// X, Y, Z.
    pub linear: i64,
    /// Rotary axis.
    pub rotary: i64,
    /// Arc centre words.
    pub centre: i64,
    /// Feed per minute.
    pub feed_per_minute: i64,
    /// Feed per revolution.
    pub feed_per_revolution: i64,
    /// Inverse time feed.
    pub inverse_time: i64,
    /// Coefficients of cubic pieces.
    pub coefficient: i64,
}

/// A rotary table axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RotaryAxis {
    /// Address letter.
    pub letter: char,
    /// Turns against ISO 841.
    pub reversed: bool,
}

/// What F means in a block that moves a linear and a rotary axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RotaryFeed {
    /// F is the speed of the linear axes alone where one moves, else degrees a minute (LinuxCNC).
    LinearAxes,
    /// The control mixes the axes as if one output unit were one degree (Fanuc default).
    UnitsAsDegrees,
}

/// The register that holds the radius by which a control moves a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Register {
    /// The control takes the radius of the tool that is in the spindle; it is not said which.
    OfTool,
    /// Said where the program names one.
    AsNamed,
    /// Always said; it has the tool's number where the program names none.
    Always,
}

impl Register {
    /// The register that a block names, for a program's own and the number of the tool.
    #[must_use]
    pub fn said(self, named: Option<u32>, tool: Option<u32>) -> Option<u32> {
        match self {
            Register::OfTool => None,
            Register::AsNamed => named,
            Register::Always => named.or(tool),
        }
    }
}

/// Path-following word of a control.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathTolerance {
    /// Part of the band (0…1) given to the control.
    pub share: f64,
}

/// Index of a contour piece that verification compares with its exact curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PieceId(pub u32);

/// The exact geometry that a run of motion blocks stands for.
#[derive(Debug, Clone)]
pub struct Piece {
    /// Operation, index into [`crate::cl::Cl::operations`].
    pub operation: u32,
    /// Exact cutter-centre curve, directed as cut.
    pub curve: CurveRef,
    /// Part's side of travel.
    pub part: Side,
    /// Band asked for.
    pub band: Band,
    /// Proven lower bound on the number of blocks of this kind for this band, if known.
    pub lower_bound: Option<u32>,
    /// Number of motion blocks that stand for the curve (leads not counted).
    pub blocks: u32,
    /// Interpolation used, for the report.
    pub interpolation: crate::ir::Interpolation,
    /// Tip height, mm.
    pub z: f64,
    /// Part of the band, on both sides, that the control's own path smoothing may use, mm; the fit keeps
    /// that much inside the band.
    pub reserved: f64,
}

/// The program of one controller.
#[derive(Debug, Clone)]
pub struct TargetProgram {
    /// Title.
    pub title: Option<String>,
    /// What was possible.
    pub capabilities: Capabilities,
    /// Tools in use, in order of first use.
    pub tools: Vec<Tool>,
    /// Exact pieces, for verification.
    pub pieces: Vec<Piece>,
    /// NURBS curves that [`Motion::Nurbs`] refers to.
    pub nurbs: Vec<Nurbs>,
    /// Drilling cycles that [`BlockKind::BeginCycle`] refers to.
    pub cycles: Vec<Cycle>,
    /// Blocks in order.
    pub blocks: Vec<Block>,
}

impl TargetProgram {
    /// A program without blocks.
    #[must_use]
    pub fn empty(cl: &crate::cl::Cl, capabilities: &Capabilities, tools: Vec<Tool>) -> TargetProgram {
        TargetProgram {
            title: cl.title.clone(),
            capabilities: capabilities.clone(),
            tools,
            pieces: Vec::new(),
            nurbs: Vec::new(),
            cycles: Vec::new(),
            blocks: Vec::new(),
        }
    }
}

/// One block or event, with its provenance.
#[derive(Debug, Clone)]
pub struct Block {
    /// What.
    pub kind: BlockKind,
    /// Where from.
    pub origin: Handle<Origin>,
    /// The exact piece it is part of, if it cuts along one.
    pub piece: Option<PieceId>,
    /// Index of the CL record that it expresses; `None` for the program's start and end.
    pub record: Option<u32>,
}

/// Position in grid steps: X, Y, Z, rotary.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Position {
    /// X steps.
    pub x: i64,
    /// Y steps.
    pub y: i64,
    /// Z steps.
    pub z: i64,
    /// Rotary steps; 0 when the machine has none.
    pub r: i64,
}

/// Feed of a motion, in the unit of its mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FeedWord {
    /// Output units a minute times [`Grid::feed_scale`], in steps of 10^-[`Grid::feed_decimals`].
    PerMinute(i64),
    /// Output units a revolution, in steps of 10^-[`Grid::feed_per_revolution_decimals`].
    PerRevolution(i64),
    /// 1/minutes, in steps of 10^-[`Grid::inverse_time_decimals`].
    InverseTime(i64),
}

/// A motion. The position before it is that of the block before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// Straight at rapid.
    Rapid {
        /// End; components of axes that do not move here and were never programmed before are meaningless.
        to: Position,
        /// The axes this block moves: bit 0 X, 1 Y, 2 Z, 3 rotary ([`axes`]). The others are not printed.
        axes: u8,
    },
    /// Straight at feed (with a rotary axis: an Archimedean spiral in the part).
    Line {
        /// End.
        to: Position,
        /// Feed.
        feed: FeedWord,
    },
    /// Arc in a plane, helix when the third axis moves.
    Arc {
        /// End.
        to: Position,
        /// The plane.
        plane: Plane,
        /// Centre minus start along the plane's first and second axis, in steps of the centre words.
        centre: [i64; 2],
        /// Clockwise (G2), seen against the plane's third axis.
        clockwise: bool,
        /// Feed.
        feed: FeedWord,
    },
    /// Index into [`TargetProgram::nurbs`].
    Nurbs {
        /// Which.
        curve: u32,
        /// Feed.
        feed: FeedWord,
    },
}

/// The plane of an arc.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Plane {
    /// First axis X, second Y (G17).
    Xy,
    /// First axis Z, second X (G18).
    Zx,
    /// First axis Y, second Z (G19).
    Yz,
}

impl Plane {
    /// First, second and third axis: 0 X, 1 Y, 2 Z; right-handed.
    #[must_use]
    pub fn axes(self) -> [usize; 3] {
        match self {
            Plane::Xy => [0, 1, 2],
            Plane::Zx => [2, 0, 1],
            Plane::Yz => [1, 2, 0],
        }
    }
}

/// Bits of [`Motion::Rapid::axes`].
pub mod axes {
    /// X moves.
    pub const X: u8 = 1;
    /// Y moves.
    pub const Y: u8 = 2;
    /// Z moves.
    pub const Z: u8 = 4;
    /// The rotary axis moves.
    pub const ROTARY: u8 = 8;
}

/// What a block is.
#[derive(Debug, Clone)]
pub enum BlockKind {
    /// Start of the program: the dialect's header.
    Begin,
    /// End of the program: the dialect's footer.
    End,
    /// Tool change: index into [`TargetProgram::tools`].
    ToolChange(u32),
    /// Spindle.
    Spindle(Spindle),
    /// Coolant.
    Coolant(Coolant),
    /// Compensation of the cutter's radius, with the register that the block names, from the straight move in X or Y on that
    /// comes next; `None` ends it there.
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
    /// Path tolerance for what follows, mm; `None`: exact path.
    PathTolerance(Option<f64>),
    /// An operation starts (its name as a comment).
    BeginOperation(String),
    /// A motion.
    Motion(Motion),
    /// A drilling cycle starts: index into [`TargetProgram::cycles`]. The tool is at the cycle's initial level,
    /// which is not below its clearance level. Nothing is drilled by this block itself.
    BeginCycle(u32),
    /// A hole of the cycle: X, Y, and in Z the surface that depth and clearance count from, the same for all
    /// holes of the cycle.
    Hole(Position),
    /// The cycle ends, with the tool at the level it retracts to.
    EndCycle,
}

/// A drilling cycle in grid steps; all levels are absolute.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cycle {
    /// How the hole is made; pitch and shift in mm.
    pub kind: crate::cl::CycleKind,
    /// Surface of the holes, Z steps.
    pub surface: i64,
    /// Bottom, Z steps.
    pub bottom: i64,
    /// Clearance level (R), Z steps.
    pub clearance: i64,
    /// Level at which the cycle begins, Z steps; not below `clearance`.
    pub initial: i64,
    /// Where the tool goes after each hole.
    pub retract: crate::cl::RetractTo,
    /// Largest depth of one peck, steps.
    pub peck: Option<i64>,
    /// Dwell at the bottom, s.
    pub dwell: Option<f64>,
    /// Feed into the hole; for tapping it is pitch times speed.
    pub feed: FeedWord,
}

impl Cycle {
    /// Z after a hole, steps.
    #[must_use]
    pub fn after(&self) -> i64 {
        match self.retract {
            crate::cl::RetractTo::Clearance => self.clearance,
            crate::cl::RetractTo::Initial => self.initial,
        }
    }
}
