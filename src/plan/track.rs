//! From what a profile names to the cutter-centre curves it runs along.

use std::sync::Arc;

use super::Planner;
use super::profile::Track;
use super::room::{self, Samples};
use crate::arena::Handle;
use crate::cl::Wall;
use crate::diag::Diagnostic;
use crate::diag::codes::planning::{CUTTER_TOO_LARGE, CUTTER_WIDER_THAN_GROOVE, EDGES_DO_NOT_JOIN};
use crate::geom::Side;
use crate::geom::cam::CutterLimit;
use crate::geom::curve::{Chain, ChainError, CurveRef, Joint, Reversed};
use crate::geom::parallel::{ParallelError, parallel};
use crate::ir::{CamEntity, CurveEntity, Flank, Origin};

/// Edges join when their ends are this near, mm: a thousandth of what a machine resolves.
const JOIN: f64 = 1e-6;

impl Planner<'_> {
    /// Along a flank of a cam: the parallel of the profile at the cutter's radius, and the stock to leave.
    pub(super) fn cam_track(
        &mut self,
        cam: Handle<CamEntity>,
        flank: Flank,
        (radius, leave): (f64, f64),
        origin: Handle<Origin>,
    ) -> Option<Track> {
        let entity = &self.program.cams[cam];
        let cam_shape = &entity.cam;
        // A negative allowance is a cut into the drawn part that is asked for.
        let contact = radius + leave.min(0.0);
        let wall = |flank| Wall { centre: cam_shape.centre(flank, contact), part: cam_shape.material(flank) };
        let track = Track {
            cut: cam_shape.centre(flank, radius + leave),
            part: cam_shape.material(flank),
            walls: cam_shape.definition().flanks().iter().map(|f| wall(*f)).collect(),
        };
        self.cutter_fits_cam(cam, flank, (radius, leave), origin).then_some(track)
    }

    /// Whether the cutter (and the stock to leave) can follow the whole flank; reports when not.
    pub(super) fn cutter_fits_cam(
        &mut self,
        cam: Handle<CamEntity>,
        flank: Flank,
        (radius, leave): (f64, f64),
        origin: Handle<Origin>,
    ) -> bool {
        let entity = &self.program.cams[cam];
        let definition = entity.cam.definition();
        if entity.cam.cutter_issue(flank, radius + leave).is_none() {
            return true;
        }
        let limit = entity.cam.max_cutter(flank);
        let roller = definition.follower.roller();
        let diagnostic = if definition.groove && radius + leave > roller {
            self.wider_than_groove((radius, leave), roller, &entity.name, origin)
        } else {
            self.larger_than_hollow((radius, leave), &limit, &entity.name, origin)
        };
        let declared = self.span(entity.origin);
        self.report(diagnostic.label(declared, "the cam is declared here"), origin);
        false
    }

    fn wider_than_groove(
        &self,
        (radius, leave): (f64, f64),
        roller: f64,
        name: &str,
        origin: Handle<Origin>,
    ) -> Diagnostic {
        let message = format!(
            "{} does not fit the groove of cam {name}, which is {} wide",
            self.cutter_words(radius, leave),
            self.show(2.0 * roller)
        );
        Diagnostic::new(&CUTTER_WIDER_THAN_GROOVE, self.span(origin), message)
            .help(self.cutter_help(roller, leave))
    }

    fn larger_than_hollow(
        &self,
        (radius, leave): (f64, f64),
        limit: &CutterLimit,
        name: &str,
        origin: Handle<Origin>,
    ) -> Diagnostic {
        let place = limit.at.map_or(String::new(), |a| {
            format!(" at cam angle {} deg", crate::cl::print::number((a.deg() * 100.0).round() / 100.0))
        });
        let message = format!(
            "{} does not fit the hollow of cam {name}{place}, which takes a radius below {}",
            self.cutter_words(radius, leave),
            self.show(limit.radius)
        );
        Diagnostic::new(&CUTTER_TOO_LARGE, self.span(origin), message)
            .help(self.cutter_help(limit.radius, leave))
    }

    pub(super) fn cutter_words(&self, radius: f64, leave: f64) -> String {
        let diameter = self.show(2.0 * radius);
        if leave > 0.0 {
            format!("a cutter of {diameter} diameter with {} to leave", self.show(leave))
        } else {
            format!("a cutter of {diameter} diameter")
        }
    }

    pub(super) fn cutter_help(&self, largest: f64, leave: f64) -> String {
        let diameter = 2.0 * (largest - leave);
        if diameter > 0.0 {
            format!("take a cutter of at most {} diameter", self.show_down(diameter))
        } else {
            "no cutter reaches into this hollow: make it rounder".to_owned()
        }
    }

    /// Along a chain of curves, at the cutter's radius to the side asked for.
    pub(super) fn curve_track(
        &mut self,
        edges: &[(Handle<CurveEntity>, bool)],
        cutter: Option<Side>,
        (radius, leave): (f64, f64),
        origin: Handle<Origin>,
    ) -> Option<Track> {
        let chain = self.chain(edges, origin)?;
        let Some(side) = cutter else {
            let walls = Vec::new();
            return Some(Track { cut: chain, part: Side::Right, walls });
        };
        if !self.check_fit(&chain, side, (radius, leave), origin) {
            return None;
        }
        // A negative allowance is a cut into the drawn part that is asked for.
        let contact = self.parallel(&chain, side, radius + leave.min(0.0), origin)?;
        let cut =
            if leave > 0.0 { self.parallel(&chain, side, radius + leave, origin)? } else { contact.clone() };
        let part = side.opposite();
        Some(Track { cut, part, walls: vec![Wall { centre: contact, part }] })
    }

    fn parallel(
        &mut self,
        chain: &CurveRef,
        side: Side,
        distance: f64,
        origin: Handle<Origin>,
    ) -> Option<CurveRef> {
        let (at, why) = match parallel(chain, side, distance) {
            Ok(curve) => return Some(curve),
            Err(ParallelError::TooCurved { radius, at }) => {
                (at, format!("where the hollow has a radius of {}", self.show(radius)))
            }
            Err(ParallelError::EdgeOutOfReach { at }) => {
                (at, "where an edge is too short for it to reach".to_owned())
            }
        };
        let message = format!(
            "{} does not fit the contour at ({}, {}), {why}",
            self.cutter_words(distance, 0.0),
            self.show(at.x),
            self.show(at.y)
        );
        let diagnostic =
            Diagnostic::new(&CUTTER_TOO_LARGE, self.span(origin), message).help("take a smaller cutter");
        self.report(diagnostic, origin);
        None
    }

    /// The cutter fits a smooth closed wall when its circle rolls along the whole of it; corners are for
    /// [`parallel`].
    fn check_fit(
        &mut self,
        wall: &CurveRef,
        side: Side,
        (radius, leave): (f64, f64),
        origin: Handle<Origin>,
    ) -> bool {
        /// Equal up to this share of the radius is a fit: the samples' rounding.
        const ROUNDING: f64 = 1e-7;
        if Joint::all(wall.as_ref()).iter().any(|j| j.turn * side.sign() > 0.0) {
            return true;
        }
        let limit = room::largest_rolling(&Samples::new(wall.as_ref()), side);
        let Some((largest, at)) = limit.filter(|(largest, _)| *largest < (radius + leave) * (1.0 - ROUNDING))
        else {
            return true;
        };
        let message = format!(
            "{} does not fit the contour at ({}, {}), which takes a radius of {} at most",
            self.cutter_words(radius, leave),
            self.show(at.x),
            self.show(at.y),
            self.show(largest)
        );
        let diagnostic = Diagnostic::new(&CUTTER_TOO_LARGE, self.span(origin), message)
            .help(self.cutter_help(largest, leave));
        self.report(diagnostic, origin);
        false
    }

    fn chain(&mut self, edges: &[(Handle<CurveEntity>, bool)], origin: Handle<Origin>) -> Option<CurveRef> {
        let curves = edges.iter().map(|(handle, reversed)| {
            let curve = self.program.curves[*handle].curve.clone();
            if *reversed { Arc::new(Reversed::new(curve)) as CurveRef } else { curve }
        });
        let mut curves: Vec<CurveRef> = curves.collect();
        if curves.len() == 1 {
            return curves.pop();
        }
        match Chain::new(curves, JOIN) {
            Ok(chain) => Some(Arc::new(chain)),
            Err(error) => {
                self.report_gap(edges, &error, origin);
                None
            }
        }
    }

    fn report_gap(
        &mut self,
        edges: &[(Handle<CurveEntity>, bool)],
        error: &ChainError,
        origin: Handle<Origin>,
    ) {
        let ChainError::Gap { after, from, to, distance } = error else { return };
        let name = |i: usize| edges.get(i).map_or("", |(h, _)| self.program.curves[*h].name.as_str());
        let message = format!(
            "{} ends at ({}, {}), but {} starts at ({}, {}), {} away",
            name(*after),
            self.show(from.x),
            self.show(from.y),
            name(after + 1),
            self.show(to.x),
            self.show(to.y),
            self.show(*distance)
        );
        let diagnostic = Diagnostic::new(&EDGES_DO_NOT_JOIN, self.span(origin), message)
            .help("name the edges in the order and direction in which they are cut, or write REV before one that runs the other way");
        self.report(diagnostic, origin);
    }
}
