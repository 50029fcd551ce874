//! What a CL file has put in force.

use super::circle::Pending;
use super::cycle::Asked;
use super::nurbs::Spans;
use super::tool::{Data, Doubt, Load};
use crate::geom::{Point3, Vec3};
use crate::ir::{Band, Compensation, Coolant, Feed, Spindle};
use crate::source::Span;

/// Tolerance of a file that states none, mm: of arcs and curves, on either side.
const BAND: f64 = 0.01;

/// State of the reader; lengths in mm.
#[derive(Debug)]
pub(super) struct State {
    /// mm in the file's unit.
    pub scale: f64,
    pub at: Option<Point3>,
    pub from: Option<Point3>,
    /// Where the first tool is wanted, said before it is changed in.
    pub first: Option<(Point3, crate::source::Span)>,
    /// Tool axis, unit vector.
    pub axis: Vec3,
    /// The next move is at rapid.
    pub rapid: bool,
    /// The record before was a `GOTO`, which coordinates alone on a line continue.
    pub continues: bool,
    pub feed: Option<Feed>,
    pub recorded_feed: Option<Feed>,
    pub spindle: Option<Spindle>,
    /// The spindle command is in the CL data since the last tool change.
    pub spindle_recorded: bool,
    /// The file has given a speed since the last one in the CL data.
    pub spindle_due: bool,
    /// As last switched in the CL data.
    pub coolant: Option<Coolant>,
    /// Coolant that the file wants with the first tool, said before its change.
    pub first_coolant: Option<(Coolant, Span)>,
    /// Gear range of the spindle.
    pub range: crate::ir::Gear,
    /// Speed for `SPINDL/ ON`.
    pub last_speed: Option<(f64, bool)>,
    /// The sense of the spindle was said for the tool that is there or called.
    pub sense_of_tool: bool,
    pub band: Band,
    pub tool: Data,
    pub doubt: Option<Doubt>,
    pub load: Option<Load>,
    pub loaded: Option<crate::arena::Handle<crate::ir::Tool>>,
    pub circle: Option<Pending>,
    /// `GOHOME`, where the file does not say where home is, after the last move.
    pub home: Option<Span>,
    /// Arcs give the axis of their plane, and turn clockwise about it.
    pub axes_of_planes: bool,
    pub cycle: Option<Asked>,
    /// A cycle is in force that could not be understood: its holes are no cuts either.
    pub cycle_failed: bool,
    /// The one before, for `CYCLE/ ON`.
    pub cycle_before: Option<Asked>,
    /// What ended a cycle in place of `CYCLE/ OFF`, until what follows tells that no hole is meant.
    pub cycle_cut: Option<Span>,
    /// Surface of the cycle's last hole.
    pub drilled: Option<f64>,
    /// Height of the first rapid move since then.
    pub rapid_in_cycle: Option<(f64, Span)>,
    /// Point of the hole over which the tool is.
    pub hole: Option<Point3>,
    pub nurbs: Option<Spans>,
    pub frame: Option<[f64; 12]>,
    /// Points are in the part's system, not in the operation's.
    pub world: bool,
    pub frame_told: bool,
    /// Cutter compensation that the file wants, and where it says so.
    pub compensation: Option<(Compensation, Span)>,
    /// The same in the CL data.
    pub recorded_compensation: Option<Compensation>,
    /// Side and register that the file has given last.
    pub last_compensation: Option<Compensation>,
    /// The control has been told where the tool is.
    pub sure: bool,
    pub moved: bool,
    pub operation: Option<u32>,
    /// Name of the next operation.
    pub operation_name: Option<String>,
    pub direction: Option<Vec3>,
    pub part_normal: Option<Vec3>,
    pub ended: bool,
    /// What ends a file of its producer, or a tool path, was the last of its kind.
    pub complete: bool,
    /// First line of a Mastercam pair.
    pub pair: Option<(i64, usize)>,
    /// What a Mastercam cycle keeps from its first hole on.
    pub drilling: Option<super::nci_drill::Drilling>,
}

impl State {
    pub fn new(scale: f64) -> State {
        State {
            scale,
            at: None,
            from: None,
            first: None,
            axis: Vec3::z(),
            rapid: false,
            continues: false,
            feed: None,
            recorded_feed: None,
            spindle: None,
            spindle_recorded: false,
            spindle_due: false,
            coolant: None,
            first_coolant: None,
            range: crate::ir::Gear::Any,
            last_speed: None,
            sense_of_tool: false,
            band: Band { into: BAND, out: BAND },
            tool: Data::default(),
            doubt: None,
            load: None,
            loaded: None,
            circle: None,
            home: None,
            axes_of_planes: false,
            cycle: None,
            cycle_failed: false,
            cycle_before: None,
            cycle_cut: None,
            drilled: None,
            rapid_in_cycle: None,
            hole: None,
            nurbs: None,
            frame: None,
            world: false,
            frame_told: false,
            compensation: None,
            recorded_compensation: None,
            last_compensation: None,
            sure: false,
            moved: false,
            operation: None,
            operation_name: None,
            direction: None,
            part_normal: None,
            ended: false,
            complete: false,
            pair: None,
            drilling: None,
        }
    }

    /// How far an arc or a curve may be left, mm.
    pub fn tolerance(&self) -> f64 {
        let least = self.band.into.min(self.band.out);
        if least > 0.0 { least } else { self.band.into.max(self.band.out) }
    }
}
