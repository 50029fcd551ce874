//! `PROFIL`: one cut along a wall, in levels.

use std::sync::Arc;

use super::Planner;
use super::levels::levels;
use super::room::{self, Placed, Samples, Wall as RoomWall};
use super::state::Ready;
use crate::arena::Handle;
use crate::cl::{Contour, Guard, Lead, Operation, RecordKind, Wall};
use crate::diag::Diagnostic;
use crate::diag::codes::planning::NO_ROOM_FOR_LEAD;
use crate::geom::Side;
use crate::geom::curve::{CurveRef, Reversed};
use crate::ir::{Band, Cut, Entry, Interpolation, Origin, Profile, ProfileTarget};

/// Height above the part's top down to which an approach may be at rapid, mm.
pub(super) const APPROACH: f64 = 1.0;

/// What a profile runs along.
pub(super) struct Track {
    /// Cutter-centre curve, the stock to leave included.
    pub cut: CurveRef,
    /// The part's side of it.
    pub part: Side,
    /// Walls that the cutter must not touch, the contact curve's own included.
    pub walls: Vec<Wall>,
}

impl Track {
    /// The same track with the part on side `part` of travel.
    fn with_part_on(self, part: Side) -> Track {
        if self.part == part {
            return self;
        }
        Track { cut: Arc::new(Reversed::new(self.cut)), part, walls: self.walls }
    }
}

/// The part's side of travel for a way of cutting: climb with a clockwise spindle has it on the right.
pub(super) fn part_side(cut: Cut, clockwise: bool) -> Side {
    match (cut, clockwise) {
        (Cut::Climb, true) | (Cut::Conventional, false) => Side::Right,
        (Cut::Climb, false) | (Cut::Conventional, true) => Side::Left,
    }
}

impl Planner<'_> {
    pub(super) fn profile(&mut self, profile: &Profile, origin: Handle<Origin>) {
        let what = self.operation_name("PROFIL", profile.name.as_deref());
        let ready = self.ready(&what, Some(profile.tool), origin);
        let reaches = self.check_cutter(profile.tool, profile.depth, origin);
        let track = self.track(profile, origin);
        let (Some(ready), true, Some(track)) = (ready, reaches, track) else { return };
        let track = self.directed(profile, track, ready);
        self.contour(profile, &track, ready, &what, origin);
    }

    /// A user's label, or kind and number.
    pub(super) fn operation_name(&self, kind: &str, label: Option<&str>) -> String {
        label.map_or_else(|| format!("{kind} {}", self.cl.operations.len() + 1), ToOwned::to_owned)
    }

    /// An edge without a cutter side is followed as it is drawn.
    fn directed(&self, profile: &Profile, track: Track, ready: Ready) -> Track {
        match profile.target {
            ProfileTarget::Curve { cutter: None, .. } => track,
            _ => track.with_part_on(part_side(profile.cut, ready.clockwise)),
        }
    }

    fn track(&mut self, profile: &Profile, origin: Handle<Origin>) -> Option<Track> {
        let radius = self.program.tools[profile.tool].diameter / 2.0;
        match &profile.target {
            ProfileTarget::Cam(cam, flank) => self.cam_track(*cam, *flank, (radius, profile.leave), origin),
            ProfileTarget::Curve { edges, cutter } => {
                self.curve_track(edges, *cutter, (radius, profile.leave), origin)
            }
        }
    }

    fn contour(
        &mut self,
        profile: &Profile,
        track: &Track,
        ready: Ready,
        name: &str,
        origin: Handle<Origin>,
    ) {
        let placed = self.place_leads(profile, track, origin);
        let operation = Operation {
            name: name.to_owned(),
            kind: "PROFIL",
            origin,
            band: profile.band,
            guard: guard(track.walls.clone(), profile.depth),
            effort: None,
        };
        let record = Contour {
            curve: track.cut.clone(),
            part: track.part,
            band: profile.band,
            interpolation: profile.interpolation,
            exact_dwells: profile.exact_dwells,
            levels: levels(profile.depth, profile.step),
            entry: placed.lead,
            exit: placed.lead,
            clearance: profile.clearance,
            approach: profile.clearance.min(APPROACH),
            plunge_feed: plunge_feed(placed.lead, ready),
            start: placed.start,
        };
        let index = self.begin(operation, origin);
        self.emit(RecordKind::Contour(Box::new(record)), origin);
        self.emit(RecordKind::EndOperation(index), origin);
    }

    pub(super) fn begin(&mut self, operation: Operation, origin: Handle<Origin>) -> u32 {
        self.start_operation();
        let index = u32::try_from(self.cl.operations.len()).unwrap_or(u32::MAX);
        self.cl.operations.push(operation);
        self.emit(RecordKind::BeginOperation(index), origin);
        index
    }

    fn place_leads(&mut self, profile: &Profile, track: &Track, origin: Handle<Origin>) -> Placed {
        let radius = self.program.tools[profile.tool].diameter / 2.0;
        let (kind, asked): (fn(f64) -> Lead, Option<f64>) = match profile.entry {
            Entry::Plunge => (|_| Lead::Plunge, None),
            Entry::TangentArc(asked) => (Lead::Arc, asked),
            Entry::TangentLine(asked) => (Lead::Line, asked),
        };
        let walls: Vec<RoomWall> = track
            .walls
            .iter()
            .map(|w| RoomWall { samples: Samples::new(w.centre.as_ref()), part: w.part })
            .collect();
        let wanted = asked.unwrap_or_else(|| usual_lead(radius));
        let placed = room::place(track.cut.as_ref(), track.part, &walls, wanted, kind);
        self.note_lead(profile.entry, asked, placed.lead, origin);
        placed
    }

    /// Says when a lead came out other than asked for.
    fn note_lead(&mut self, entry: Entry, asked: Option<f64>, placed: Lead, origin: Handle<Origin>) {
        let message = match (entry, placed, asked) {
            (Entry::Plunge, ..) => return,
            (_, Lead::Plunge, _) => {
                "there is no room for a tangent lead: the cutter plunges at the contour's start".to_owned()
            }
            (_, Lead::Arc(size) | Lead::Line(size), Some(asked)) if size < asked => format!(
                "a tangent lead of {} touches the part: {} is used",
                self.show(asked),
                self.show(size)
            ),
            _ => return,
        };
        let diagnostic = Diagnostic::new(&NO_ROOM_FOR_LEAD, self.span(origin), message);
        self.report(diagnostic, origin);
    }

    /// A length rounded down, so that what is printed still fits.
    pub(super) fn show_down(&self, mm: f64) -> String {
        let digit = 1e-3 * self.program.units.in_mm();
        self.show((mm / digit).floor() * digit)
    }
}

/// The guard of an operation that reaches `depth` mm below Z0.
pub(super) fn guard(walls: Vec<Wall>, depth: f64) -> Guard {
    Guard { walls, bottom: -depth, ..Guard::default() }
}

/// Lead size when nothing is asked: the cutter's radius, within what is handy, mm.
fn usual_lead(radius: f64) -> f64 {
    radius.clamp(1.0, 12.0)
}

/// A plunge goes down into the stock and so slower; a lead starts beside it.
fn plunge_feed(lead: Lead, ready: Ready) -> Option<f64> {
    const SHARE: f64 = 0.5;
    ready.per_minute().filter(|_| lead == Lead::Plunge).map(|feed| feed * SHARE)
}

/// The parts of a roughing contour that do not come from the program.
pub(super) fn rough_contour(curve: CurveRef, part: Side, band: Band, z: f64, clearance: f64) -> Contour {
    Contour {
        curve,
        part,
        band,
        interpolation: Interpolation::Circular,
        exact_dwells: false,
        levels: vec![z],
        entry: Lead::None,
        exit: Lead::None,
        clearance,
        approach: clearance.min(APPROACH),
        plunge_feed: None,
        start: None,
    }
}
