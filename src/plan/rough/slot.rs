//! Roughing of a groove: a slot along the roller's path, then both flanks wider, leaving the allowance.
//!
//! The cutter ramps down along the slot, for a flat cutter cannot plunge into the full.

use std::sync::Arc;

use super::moves::Plan;
use crate::geom::cam::{Cam, Flank};
use crate::geom::crossing::flatten;
use crate::geom::curve::{CurveRef, Part, Reversed, into_domain, restarted};
use crate::geom::{Point2, Side, measure};
use crate::ir::Band;

/// What a slot is cut for.
pub(super) struct Groove<'a> {
    pub cam: &'a Cam,
    /// Cutter radius, mm.
    pub cutter: f64,
    /// Stock left on both flanks, mm.
    pub leave: f64,
    /// Largest radial depth of the widening passes, mm.
    pub step: f64,
    /// Largest depth of one level, mm.
    pub drop: f64,
    /// Part's side of travel along a flank.
    pub part: Side,
    pub band: Band,
}

/// The moves of one level; the slot's whole width is cut at once.
pub(super) fn plan(groove: &Groove<'_>) -> Plan {
    let mut plan = Plan::default();
    plan.engagement = 2.0 * groove.cutter;
    let roller = groove.cam.definition().follower.roller();
    let path = groove.along(Flank::Inner, roller);
    let ramp = groove.ramp(&path);
    let end = ramp.last().map_or(path.domain().0, |(u, _, _)| *u);
    plan.ramp(ramp.into_iter().map(|(_, p, share)| (p, share)).collect());
    let round = restarted(&path, end);
    plan.round(&round, groove.part, groove.slot_band());
    for flank in [Flank::Inner, Flank::Outer] {
        groove.widen(&mut plan, flank, roller);
    }
    if let Some(p) = plan.position() {
        plan.up(p);
    }
    plan
}

impl Groove<'_> {
    /// The centre path at `offset` mm off a flank, with the flank on the part's side.
    fn along(&self, flank: Flank, offset: f64) -> CurveRef {
        let curve = self.cam.centre(flank, offset);
        if self.cam.material(flank) == self.part { curve } else { Arc::new(Reversed::new(curve)) }
    }

    /// Length of the slot's centre path, mm.
    pub fn length(&self) -> f64 {
        measure::length(self.cam.pitch().as_ref(), 1e-6)
    }

    /// Neither flank may be cut deeper than half the allowance; without one, than the tolerance.
    fn slot_band(&self) -> Band {
        let roller = self.cam.definition().follower.roller();
        let room = roller - self.cutter;
        let most = (0.5 * room).max(self.band.into.min(self.band.out)).min(0.05);
        Band { into: most, out: most }
    }

    /// Parameter, place and share of the level's depth along the ramp. With no tolerance to draw chords in,
    /// the ramp is a plunge.
    fn ramp(&self, path: &CurveRef) -> Vec<(f64, Point2, f64)> {
        /// Slope of the ramp: 3 degrees.
        const SLOPE: f64 = 0.0524;
        let (first, last) = path.domain();
        let share = (self.drop / SLOPE / self.length().max(f64::MIN_POSITIVE)).min(0.9);
        let tolerance = 0.5 * self.slot_band().into;
        let start = (first, path.at(first).p, 1.0);
        let part = Part::new(path.clone(), first, first + share * (last - first));
        let Some(part) = part.filter(|_| tolerance > 0.0) else { return vec![start] };
        let points = flatten(&part, tolerance);
        let mut travelled = 0.0;
        let mut lengths = vec![0.0];
        for pair in points.windows(2) {
            travelled += (pair[1].1 - pair[0].1).norm();
            lengths.push(travelled);
        }
        points.into_iter().zip(lengths).map(|((u, p), s)| (u, p, s / travelled)).collect()
    }

    /// Passes from the slot to the allowance of one flank.
    fn widen(&self, plan: &mut Plan, flank: Flank, roller: f64) {
        let room = roller - self.cutter - self.leave;
        if room <= 1e-6 {
            return;
        }
        let count = (room / self.step - 1e-9).ceil().max(1.0);
        let depth = room / count;
        plan.link_to_slot(self.cam, roller);
        for i in 1..=count as usize {
            let offset = roller - depth * i as f64;
            let curve = self.along(flank, offset);
            let start = self.ahead(&curve, plan.position(), depth);
            plan.round(&restarted(&curve, start), self.part, self.band_at(i as f64 == count));
        }
    }

    /// Parameter of a point on the next pass far enough ahead that the way to it is slant.
    fn ahead(&self, curve: &CurveRef, from: Option<Point2>, depth: f64) -> f64 {
        let near = from.map_or(curve.domain().0, |p| nearest(curve, p));
        let length = (2.0 * self.cutter * depth).sqrt();
        into_domain(curve.as_ref(), near + length / curve.at(near).speed.abs().max(f64::MIN_POSITIVE))
    }

    fn band_at(&self, last: bool) -> Band {
        let loose = 0.25 * self.leave;
        if last && self.leave == 0.0 {
            return self.band;
        }
        Band { into: self.band.into.max(loose).min(0.05), out: self.band.out.max(loose).min(0.05) }
    }
}

impl Plan {
    /// Straight into the middle of the slot, from beside it.
    fn link_to_slot(&mut self, cam: &Cam, roller: f64) {
        let path = cam.centre(Flank::Inner, roller);
        if let Some(p) = self.position() {
            self.link(path.at(nearest(&path, p)).p);
        }
    }
}

/// Parameter of the nearest of evenly spread points of a curve.
fn nearest(curve: &CurveRef, p: Point2) -> f64 {
    const LOOKS: u32 = 720;
    let (first, last) = curve.domain();
    let at = |i: u32| first + (last - first) * f64::from(i) / f64::from(LOOKS);
    let distance = |i: &u32| (curve.at(at(*i)).p - p).norm_squared();
    (0..LOOKS).min_by(|a, b| distance(a).total_cmp(&distance(b))).map_or(first, at)
}
