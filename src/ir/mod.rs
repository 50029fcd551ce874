//! The evaluated program.
//!
//! # Contract
//! - Every name is resolved, every macro and loop is unrolled, every quantity is in mm, radians, seconds,
//!   newtons; nothing here knows text. A node's place in the source is its [`Origin`], beside it.
//! - Entities (cams, tools, stocks, curves) live in arenas and are immutable; [`Step`]s are in program order.
//! - Modal settings (tolerance, clearance, tool) that an operation depends on are copied into the operation:
//!   the planner looks at one step at a time and never back.
//! - A program that reaches this stage has passed all checks of `sema`: handles are valid, numbers finite,
//!   tolerances not both zero, radii positive, a tool is loaded before each operation that cuts.

use crate::arena::{Arena, Handle};
use crate::geom::cam::Cam;
use crate::geom::curve::CurveRef;
use crate::geom::surface::{Cutter, Net};
use crate::geom::{Point3, Side};
use crate::source::Span;
use crate::units::{Angle, LengthUnit};

pub mod cycle;
mod place;
pub mod print;

/// Where a node came from: the statement, and the chain of macro calls that led to it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Origin {
    /// The statement.
    pub span: Span,
    /// `CALL` statements from the outermost to the innermost; of more than eight, the four at either end.
    pub calls: Vec<Span>,
}

/// The evaluated program.
#[derive(Debug, Clone, Default)]
pub struct Program {
    /// `PARTNO` text.
    pub title: Option<String>,
    /// `UNITS`.
    pub units: LengthUnit,
    /// `MACHIN` statements in order.
    pub machines: Vec<Machine>,
    /// Plate cams.
    pub cams: Arena<CamEntity>,
    /// Cutters.
    pub tools: Arena<Tool>,
    /// Blanks.
    pub stocks: Arena<Stock>,
    /// Surfaces.
    pub nets: Arena<NetEntity>,
    /// Planar curves (`CURVE`, `LINE`, `CIRCLE`, chains, `TABCYL` …).
    pub curves: Arena<CurveEntity>,
    /// Where nodes came from.
    pub origins: Arena<Origin>,
    /// What happens, in order.
    pub steps: Vec<Step>,
}

/// `MACHIN/ post[, option…]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Machine {
    /// Post name as written, lower case.
    pub post: String,
    /// `ROTABL, C`: the rotary axis to use for R-theta output.
    pub rotary: Option<Rotary>,
    /// Other options as written, for the post (`KEY` or `KEY=value`).
    pub options: Vec<(String, Option<String>)>,
    /// The statement.
    pub origin: Handle<Origin>,
}

/// A rotary table for R-theta output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rotary {
    /// Axis letter; `None`: the dialect's default.
    pub letter: Option<char>,
    /// The table turns the other way than ISO 841 says.
    pub reversed: bool,
}

/// A named plate cam.
#[derive(Debug, Clone)]
pub struct CamEntity {
    /// The user's name.
    pub name: String,
    /// The cam.
    pub cam: Cam,
    /// Where it was declared.
    pub origin: Handle<Origin>,
}

/// A named surface.
#[derive(Debug, Clone)]
pub struct NetEntity {
    /// The user's name.
    pub name: String,
    /// The surface.
    pub net: Net,
    /// Whether the program declares it; otherwise it is the image of one that does, under `TRACUT`.
    pub declared: bool,
    /// Where it was declared.
    pub origin: Handle<Origin>,
}

/// A named curve.
#[derive(Debug, Clone)]
pub struct CurveEntity {
    /// The user's name.
    pub name: String,
    /// The curve.
    pub curve: CurveRef,
    /// Where it was declared.
    pub origin: Handle<Origin>,
}

/// Kinds of milling cutter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub enum CutterKind {
    /// Cylindrical, flat end.
    Flat,
    /// Spherical end.
    Ball,
    /// Corner radius.
    Bull,
    /// Conical.
    Taper,
    /// A drill: cuts with its point only.
    Drill,
}

/// A cutter; APT's seven parameters plus what a shop knows of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Tool {
    /// The user's name.
    pub name: String,
    /// Kind, stated or derived from the seven parameters.
    pub kind: CutterKind,
    /// d: diameter, mm.
    pub diameter: f64,
    /// r: corner radius, mm.
    pub corner: f64,
    /// e, f: radial and axial distance of the corner circle's centre, mm; α, β in radians; h height, mm.
    pub profile: [f64; 5],
    /// Tool number in the magazine, if given.
    pub number: Option<u32>,
    /// Flutes.
    pub flutes: Option<u32>,
    /// Helix angle.
    pub helix: Option<Angle>,
    /// Gauge length, mm.
    pub length: Option<f64>,
    /// Free length out of the holder, mm.
    pub stick_out: Option<f64>,
    /// Tool material as written.
    pub material: Option<String>,
    /// Minor words of its change in a CL file, behind its number: `ADJUST, 4, LENGTH, 120`.
    pub words: String,
    /// Where it was declared.
    pub origin: Handle<Origin>,
}

impl Tool {
    /// The cutter as a solid; `None` for drills, cutters with a sloping bottom, and tapered ones without an angle.
    #[must_use]
    pub fn solid(&self) -> Option<Cutter> {
        const AGREES: f64 = 1e-6;
        let radius = self.diameter / 2.0;
        let [e, f, alpha, beta, _] = if self.profile == [0.0; 5] {
            [radius - self.corner, self.corner, 0.0, 0.0, 0.0]
        } else {
            self.profile
        };
        if alpha != 0.0 || e < -AGREES || (f - self.corner).abs() > AGREES {
            return None;
        }
        let straight = beta == 0.0 && (e + self.corner - radius).abs() <= AGREES;
        match self.kind {
            CutterKind::Ball if straight => Some(Cutter::ball(radius)),
            CutterKind::Flat | CutterKind::Bull if straight => Some(Cutter::bull(radius, self.corner)),
            CutterKind::Taper if beta > 0.0 => Some(Cutter::taper(e.max(0.0), f, self.corner, beta)),
            _ => None,
        }
    }
    /// A flat end mill of which no more is known than its diameter in mm and its number.
    #[must_use]
    pub fn flat(name: impl Into<String>, diameter: f64, number: Option<u32>, origin: Handle<Origin>) -> Tool {
        Tool {
            name: name.into(),
            kind: CutterKind::Flat,
            diameter,
            corner: 0.0,
            profile: [0.0; 5],
            number,
            flutes: None,
            helix: None,
            length: None,
            stick_out: None,
            material: None,
            words: String::new(),
            origin,
        }
    }
}

/// A blank.
#[derive(Debug, Clone, PartialEq)]
pub struct Stock {
    /// The user's name.
    pub name: String,
    /// Its shape.
    pub shape: StockShape,
    /// Where it was declared.
    pub origin: Handle<Origin>,
}

/// Shapes of a blank; the top of a round is Z0.
#[derive(Debug, Clone, PartialEq)]
pub enum StockShape {
    /// Cylinder about the origin: radius and height, mm.
    Round {
        /// Radius, mm.
        radius: f64,
        /// Height below Z0, mm, if given.
        height: Option<f64>,
    },
    /// Box between two corners.
    Block {
        /// Lowest corner.
        min: Point3,
        /// Highest corner.
        max: Point3,
    },
}

/// How far the cut may go into the part and how much it may leave on it, mm, both >= 0.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Band {
    /// `INTOL`: into the part.
    pub into: f64,
    /// `OUTTOL`: left on the part.
    pub out: f64,
}

/// One thing that happens.
#[derive(Debug, Clone)]
pub struct Step {
    /// What.
    pub kind: StepKind,
    /// Where it came from.
    pub origin: Handle<Origin>,
}

/// The things that happen.
#[derive(Debug, Clone)]
pub enum StepKind {
    /// `LOADTL`.
    LoadTool(Handle<Tool>),
    /// `SPINDL`.
    Spindle(Spindle),
    /// `FEDRAT`.
    Feed(Feed),
    /// `COOLNT`.
    Coolant(Coolant),
    /// `CUTCOM`; `None` ends it.
    Compensation(Option<Compensation>),
    /// `DELAY`, seconds.
    Dwell(f64),
    /// `STOP`.
    Stop,
    /// `OPSTOP`.
    OptionalStop,
    /// `PPRINT`.
    Comment(String),
    /// `INSERT`: verbatim block.
    Insert(String),
    /// `FROM`: where the cutter is, without a move.
    From(Point3),
    /// `GOTO`, `GODLTA` made absolute; rapid when a `RAPID` stood before it.
    Goto {
        /// End point, mm.
        to: Point3,
        /// At rapid.
        rapid: bool,
    },
    /// `CYCLE`: every hole until the end is made by it.
    BeginCycle(Box<DrillCycle>),
    /// `GOTO` while a cycle is in force: a hole at this point of the surface, mm.
    Hole(Point3),
    /// `CYCLE/ OFF`.
    EndCycle,
    /// `PROFIL`.
    Profile(Profile),
    /// `ROUGH` of a plate cam.
    RoughCam(RoughCam),
    /// `SURFAC`, `ROUGH` of a net in one pass.
    Surface(Surface),
    /// `ROUGH` of a net in levels.
    RoughNet(RoughNet),
}

/// `CYCLE/ …`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrillCycle {
    /// The cycle; its feed is that of `FEDRAT` where [`DrillCycle::own_feed`] is not set.
    pub cycle: Cycle,
    /// The feed stands in the statement.
    pub own_feed: bool,
    /// Level above the hole's point after each hole, mm, where it is not the clearance level.
    pub return_to: Option<f64>,
}

/// Spindle command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spindle {
    /// Off.
    Off,
    /// On.
    On {
        /// Revolutions per minute.
        rpm: f64,
        /// Clockwise (M3).
        clockwise: bool,
        /// Gear range.
        range: Gear,
    },
}

impl Spindle {
    /// On, in any gear.
    #[must_use]
    pub const fn on(rpm: f64, clockwise: bool) -> Spindle {
        Spindle::On { rpm, clockwise, range: Gear::Any }
    }
}

/// Gear range of a spindle, as CL files name it (`RANGE, 2`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Gear {
    /// None is asked for.
    #[default]
    Any,
    /// LOW.
    Low,
    /// MEDIUM.
    Medium,
    /// HIGH.
    High,
    /// By its number.
    Number(u16),
}

impl Gear {
    /// Its word in CL text; none for [`Gear::Any`].
    #[must_use]
    pub fn word(self) -> Option<String> {
        match self {
            Gear::Any => None,
            Gear::Low => Some("LOW".to_owned()),
            Gear::Medium => Some("MEDIUM".to_owned()),
            Gear::High => Some("HIGH".to_owned()),
            Gear::Number(n) => Some(n.to_string()),
        }
    }
}

/// Feed command.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Feed {
    /// mm/min.
    PerMinute(f64),
    /// mm/rev.
    PerRevolution(f64),
    /// mm/tooth: becomes per minute from spindle speed and flutes when the operation is planned.
    PerTooth(f64),
}

/// Coolant command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Coolant {
    /// Off.
    #[default]
    Off,
    /// Flood (M8).
    Flood,
    /// Mist (M7).
    Mist,
    /// Through the spindle and the tool; each machine has its own word for it.
    Through {
        /// Where the control has no word for it, flood will not do.
        needed: bool,
    },
}

/// Compensation of the cutter's radius by the control: it moves the path by what its register holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Compensation {
    /// The side of the path to which it is moved, seen along the way.
    pub side: Side,
    /// The register, where the program names one.
    pub register: Option<u32>,
}

impl Compensation {
    /// What `CUTCOM` asks for: a side begins anew, without one it goes on as `last`, whose register holds unless another is
    /// named. `None` where there was no last one.
    #[must_use]
    pub fn asked(side: Option<Side>, named: Option<u32>, last: Option<Compensation>) -> Option<Compensation> {
        match side {
            Some(side) => Some(Compensation { side, register: named }),
            None => last.map(|last| Compensation { register: named.or(last.register), ..last }),
        }
    }
}

impl core::fmt::Display for Compensation {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(if self.side == Side::Left { "left" } else { "right" })?;
        self.register.map_or(Ok(()), |register| write!(f, " by register {register}"))
    }
}

/// How a contour is to be expressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub enum Interpolation {
    /// Straight lines.
    Linear,
    /// Tangent-continuous arcs (and lines where the curve is straight).
    Circular,
    /// Archimedean spirals: table angle and radius.
    RTheta,
    /// NURBS where the control has it.
    Nurbs,
    /// Whatever takes the fewest blocks on the target.
    Auto,
}

/// Cutting direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub enum Cut {
    /// Climb (down) milling: part to the right of travel with a clockwise spindle.
    Climb,
    /// Conventional (up) milling.
    Conventional,
}

/// How a contour is entered and left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Entry {
    /// Quarter circle tangent to the contour; radius in mm, `None`: chosen by the planner.
    TangentArc(Option<f64>),
    /// Straight, tangent to the contour; length in mm, `None`: chosen.
    TangentLine(Option<f64>),
    /// Straight down (and up) at the contour's first (last) point.
    Plunge,
}

pub use crate::geom::cam::Flank;
pub use cycle::{Cycle, CycleKind, CycleName, RetractTo};
pub use place::at_origin;

/// What a profile operation follows.
#[derive(Debug, Clone, PartialEq)]
pub enum ProfileTarget {
    /// A flank of a cam; a groove cam gives one operation a flank.
    Cam(Handle<CamEntity>, Flank),
    /// A chain of curves: the part's edge, and the side of the directed edge on which the cutter runs.
    Curve {
        /// The edges in order, each with «reversed».
        edges: Vec<(Handle<CurveEntity>, bool)>,
        /// The cutter's side; `None`: on the curve.
        cutter: Option<Side>,
    },
}

/// `PROFIL/`.
#[derive(Debug, Clone)]
pub struct Profile {
    /// The user's label.
    pub name: Option<String>,
    /// What is followed.
    pub target: ProfileTarget,
    /// Interpolation.
    pub interpolation: Interpolation,
    /// `DWELLS, EXACT`: spans that are exact arcs or lines stay exact.
    pub exact_dwells: bool,
    /// Climb or conventional.
    pub cut: Cut,
    /// The cutter.
    pub tool: Handle<Tool>,
    /// Bottom below Z0, mm, positive.
    pub depth: f64,
    /// Largest axial step, mm.
    pub step: Option<f64>,
    /// Stock to leave on the contour (`THICK`), mm.
    pub leave: f64,
    /// Entry and exit.
    pub entry: Entry,
    /// Tolerance.
    pub band: Band,
    /// Clearance plane, mm above Z0.
    pub clearance: f64,
}

/// `ROUGH/ cam, STOCK, b …`.
#[derive(Debug, Clone)]
pub struct RoughCam {
    /// The user's label.
    pub name: Option<String>,
    /// The cam.
    pub cam: Handle<CamEntity>,
    /// The blank.
    pub stock: Handle<Stock>,
    /// Largest radial depth of cut, mm.
    pub radial_step: f64,
    /// Stock left on the contour, mm.
    pub leave: f64,
    /// Bottom below Z0, mm, positive.
    pub depth: f64,
    /// Largest axial step, mm.
    pub axial_step: Option<f64>,
    /// Climb or conventional for the contour pass.
    pub cut: Cut,
    /// The cutter.
    pub tool: Handle<Tool>,
    /// Tolerance.
    pub band: Band,
    /// Clearance plane, mm above Z0.
    pub clearance: f64,
}

/// Along what the passes of a surface run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub enum Along {
    /// u, at constant v.
    U,
    /// v, at constant u.
    V,
    /// x, in planes of constant y.
    X,
    /// y, in planes of constant x.
    Y,
    /// u or v, bent so that the height of cusps is the same nearly everywhere.
    IsoCusp,
    /// u or v, bent so that neighbours have the same distance everywhere.
    Const,
}

/// What decides about the distance of passes.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub enum Spacing {
    /// Largest height of cusps, mm.
    Cusp(f64),
    /// Largest distance, mm.
    Step(f64),
}

/// What passes over a surface may be made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PassShape {
    /// Straight lines.
    #[default]
    Lines,
    /// Arcs too, where the control has them in the plane of a pass.
    Arcs,
    /// Curves too, where the control has them in space; else arcs.
    Curves,
}

/// `ROUGH/ net, LEVELS …`.
#[derive(Debug, Clone)]
pub struct RoughNet {
    /// The user's label.
    pub name: Option<String>,
    /// The surface.
    pub net: Handle<NetEntity>,
    /// The blank.
    pub stock: Handle<Stock>,
    /// Largest depth of a level, mm.
    pub step: f64,
    /// Largest distance of passes, mm.
    pub width: f64,
    /// Stock left on the surface, mm.
    pub leave: f64,
    /// Steepest way down into material, radians.
    pub ramp: f64,
    /// Climb or conventional.
    pub cut: Cut,
    /// Each level from the outside inwards, or from the inside outwards; without it, as the cutter comes in best.
    pub inward: Option<bool>,
    /// The cutter.
    pub tool: Handle<Tool>,
    /// Tolerance.
    pub band: Band,
    /// Clearance plane, mm above Z0.
    pub clearance: f64,
}

/// `SURFAC/`, and `ROUGH/ net, OFFSET`.
#[derive(Debug, Clone)]
pub struct Surface {
    /// The user's label.
    pub name: Option<String>,
    /// The surface.
    pub net: Handle<NetEntity>,
    /// To and fro, or all in the same sense.
    pub zigzag: bool,
    /// Along what.
    pub along: Along,
    /// How close.
    pub spacing: Spacing,
    /// Lift the path where the cutter does not fit; otherwise that is an error.
    pub avoid: bool,
    /// The cutter.
    pub tool: Handle<Tool>,
    /// Stock to leave, mm.
    pub leave: f64,
    /// Tolerance.
    pub band: Band,
    /// Clearance plane, mm above Z0.
    pub clearance: f64,
    /// Top of the blank, mm, if one is declared.
    pub stock_top: Option<f64>,
    /// `ROUGH`: from the blank, or what an operation before has left of it.
    pub rough: bool,
    /// What passes may be made of.
    pub shape: PassShape,
}
