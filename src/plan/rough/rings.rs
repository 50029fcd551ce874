//! Roughing by rings parallel to the contour, each cut only where the blank reaches out of it.
//!
//! Ring k leaves the wall at distance d_k = leave + k·spacing from the profile. With δ(u) the distance from the
//! profile to the blank's edge along the normal at u, ring k has work where δ(u) > d_k. On a closed curve these
//! sets are intervals, and those of ring k + 1 lie within those of ring k: a forest of valleys, cut from its
//! leaves to its roots, to and fro. The rings that have work all round come last, in the direction asked for;
//! ring 0 is the contour with its allowance.

use std::sync::Arc;

use super::circles::{self, way_out};
use super::moves::{Move, Plan};
use super::passes::{Interval, Level, Positive};
use super::{CLEAR, Job, MOST_PASSES, contour_band};
use crate::geom::curve::{CurveRef, Frenet, Part, PlanarCurve, Reversed, into_domain, restarted};
use crate::geom::{Point2, Side, Vec2, cross};
use crate::ir::Band;
use crate::plan::room::largest_rolling;

/// The shorter of: rings alone, and rings after full circles down to the cam's largest radius.
pub(super) fn plan(job: &Job) -> Option<Plan> {
    let alone = Rings::new(job, job.blank).map(|rings| rings.plan(Plan::default()));
    let mut first = Plan::default();
    let left = circles::full(job, &mut first);
    let after = (left < job.blank).then(|| Rings::new(job, left)).flatten().map(|rings| rings.plan(first));
    [alone, after].into_iter().flatten().min_by(|a, b| a.length().total_cmp(&b.length()))
}

/// A way to the start of a pass.
enum Detour {
    /// Straight.
    None,
    /// Over a point.
    Over(Point2),
    /// Only from outside.
    Blocked,
}

/// Less than this on a wall, mm, is no work: the rounding of a blank that just holds the cam.
pub(super) const NO_WORK: f64 = 1e-6;

struct Rings<'a> {
    job: &'a Job,
    spacing: f64,
    /// Band of the passes.
    band: Band,
    /// Where each ring has work, ring 0 first.
    work: Vec<Positive>,
    /// Length of the profile's domain.
    turn: f64,
}

impl<'a> Rings<'a> {
    /// Rings for a blank of radius `blank`; `None` when there are too many, or when the cutter cannot follow
    /// one of them: a hollow narrower than the ring is wide.
    fn new(job: &'a Job, blank: f64) -> Option<Rings<'a>> {
        let depth = Level::new(&job.samples, |f| to_edge(f, job.outward(f), blank));
        let total = (depth.greatest() - job.leave).max(0.0);
        let count = (total / job.step - 1e-9).ceil().max(1.0);
        if count > MOST_PASSES as f64 {
            return None;
        }
        let spacing = total / count;
        let widest = job.cutter + job.leave + (count - 1.0) * spacing;
        let follows = largest_rolling(&job.samples, job.part.opposite()).is_none_or(|(r, _)| r > widest);
        let work =
            (0..count as usize).map(|k| depth.above(job.leave + k as f64 * spacing + NO_WORK)).collect();
        let (first, last) = job.profile.domain();
        follows.then(|| Rings { job, spacing, band: band(job, spacing), work, turn: last - first })
    }

    fn plan(&self, mut plan: Plan) -> Plan {
        plan.engagement = plan.engagement.max(self.spacing);
        let outermost_closed = self.closed() - 1;
        let roots = self.intervals(outermost_closed + 1);
        let count = roots.len();
        for (i, root) in roots.into_iter().enumerate() {
            self.valley(&mut plan, outermost_closed + 1, root);
            if i + 1 < count {
                self.lift(&mut plan);
            }
        }
        for ring in (0..=outermost_closed).rev() {
            self.round(&mut plan, ring);
        }
        self.finish(&mut plan);
        plan
    }

    /// How many rings go all the way round; ring 0 always does.
    fn closed(&self) -> usize {
        self.work.iter().skip(1).take_while(|w| **w == Positive::Everywhere).count() + 1
    }

    fn intervals(&self, ring: usize) -> Vec<Interval> {
        match self.work.get(ring) {
            Some(Positive::Within(intervals)) => intervals.clone(),
            _ => Vec::new(),
        }
    }

    /// Whether an open ring is cut in the contour's direction: the outermost closed ring follows the ring
    /// before it in the same direction, and the others alternate.
    fn forward(&self, ring: usize) -> bool {
        (ring - self.closed()).is_multiple_of(2)
    }

    /// The valley under `interval` of `ring`, leaves first.
    fn valley(&self, plan: &mut Plan, ring: usize, interval: Interval) {
        let mut children: Vec<Interval> =
            self.intervals(ring + 1).into_iter().filter(|c| interval.holds(c, self.turn)).collect();
        // The child at the end where this ring starts comes last.
        if self.forward(ring) {
            children.reverse();
        }
        for (i, child) in children.iter().enumerate() {
            if i > 0 {
                self.lift(plan);
            }
            self.valley(plan, ring + 1, *child);
        }
        self.pass(plan, ring, interval);
    }

    fn centre_curve(&self, ring: usize) -> CurveRef {
        self.job.parallel(self.wall(ring) + self.job.cutter)
    }

    /// Distance of the ring's wall from the profile, mm.
    fn wall(&self, ring: usize) -> f64 {
        self.job.leave + ring as f64 * self.spacing
    }

    /// One open pass.
    fn pass(&self, plan: &mut Plan, ring: usize, interval: Interval) {
        let Some(curve) = piece(&self.centre_curve(ring), interval) else { return };
        let (curve, part): (CurveRef, Side) = if self.forward(ring) {
            (curve, self.job.part)
        } else {
            (Arc::new(Reversed::new(curve)), self.job.part.opposite())
        };
        let start = curve.at(curve.domain().0);
        self.reach(plan, ring, &start);
        plan.cut(curve, part, self.band);
    }

    /// To the start of a pass: on its tangent from outside the blank, or from the end of the pass before.
    fn reach(&self, plan: &mut Plan, ring: usize, start: &Frenet) {
        let Some(from) = plan.position() else {
            return plan.down(start.p - start.t * way_out(start.p, -start.t, self.job.outside));
        };
        match self.detour(ring, from, start) {
            Detour::None => {}
            Detour::Over(p) => plan.link(p),
            Detour::Blocked => {
                self.lift(plan);
                plan.down(start.p - start.t * way_out(start.p, -start.t, self.job.outside));
            }
        }
    }

    /// How to come from `from` to `start` without cutting below the ring's wall. The pass before ended short of
    /// `start` on the same side of the valley; where the wall bulges between the two, the way goes over a point
    /// on the tangent at `start`.
    fn detour(&self, ring: usize, from: Point2, start: &Frenet) -> Detour {
        const PIECES: i32 = 24;
        if self.is_clear(ring, from, start.p) {
            return Detour::None;
        }
        let longest = (start.p - from).norm();
        (1..=PIECES)
            .map(|i| start.p + start.t * (longest * f64::from(i) / f64::from(PIECES)))
            .find(|p| self.is_clear(ring, from, *p) && self.is_clear(ring, *p, start.p))
            .map_or(Detour::Blocked, Detour::Over)
    }

    /// Whether a straight move stays outside the ring's centre curve.
    fn is_clear(&self, ring: usize, from: Point2, to: Point2) -> bool {
        const PIECES: i32 = 12;
        let least = self.wall(ring) + self.job.cutter - 0.01 * self.spacing;
        (0..=PIECES).all(|i| {
            let p = from + (to - from) * (f64::from(i) / f64::from(PIECES));
            self.job.samples.distance(p, self.job.part.opposite()) >= least
        })
    }

    /// Straight up where the last pass ended.
    fn lift(&self, plan: &mut Plan) {
        if let Some(p) = plan.position() {
            plan.up(p);
        }
    }

    /// A little away from the contour, and up.
    fn finish(&self, plan: &mut Plan) {
        let Some(Move::Cut { curve, part, .. }) = plan.moves.last() else { return };
        let end = last_of(curve.as_ref());
        let away = end.n() * part.opposite().sign();
        plan.up(end.p + away * CLEAR);
    }

    /// One ring all the way round.
    fn round(&self, plan: &mut Plan, ring: usize) {
        let curve = self.centre_curve(ring);
        let start = match plan.position() {
            Some(from) => self.touch(curve.as_ref(), from),
            None => self.nearest_to_edge(),
        };
        let band = if ring == 0 { contour_band(self.job, self.band) } else { self.band };
        let round = restarted(&curve, start);
        if plan.position().is_none() {
            let first = round.at(round.domain().0);
            plan.down(first.p - first.t * way_out(first.p, -first.t, self.job.outside));
        }
        plan.round(&round, self.job.part, band);
    }

    /// Parameter of the point where a tangent from `from` meets the curve in its direction of travel; where
    /// there is none, that of the nearest point.
    fn touch(&self, curve: &dyn PlanarCurve, from: Point2) -> f64 {
        let (first, last) = curve.domain();
        let near = self.nearest(curve, from);
        let miss = |u: f64| {
            let f = curve.at(into_domain(curve, u));
            cross(f.p - from, f.t) * self.job.part.sign()
        };
        let step = (last - first) / 360.0;
        let reach = 120;
        let Some(i) = (0..reach).find(|i| miss(near + step * f64::from(i + 1)) >= 0.0) else { return near };
        let (mut a, mut b) = (near + step * f64::from(i), near + step * f64::from(i + 1));
        for _ in 0..50 {
            let m = 0.5 * (a + b);
            if miss(m) >= 0.0 { b = m } else { a = m }
        }
        into_domain(curve, b)
    }

    fn nearest(&self, curve: &dyn PlanarCurve, p: Point2) -> f64 {
        let distance = |u: f64| (curve.at(u).p - p).norm_squared();
        let nearest = self.job.samples.points.iter().min_by(|a, b| distance(a.0).total_cmp(&distance(b.0)));
        nearest.map_or(curve.domain().0, |(u, _)| *u)
    }

    /// Where the blank is thinnest.
    fn nearest_to_edge(&self) -> f64 {
        let radius = |f: &Frenet| f.p.coords.norm_squared();
        let farthest = self.job.samples.points.iter().max_by(|a, b| radius(&a.1).total_cmp(&radius(&b.1)));
        farthest.map_or(self.job.profile.domain().0, |(u, _)| *u)
    }
}

/// Band of the rings: what the spacing leaves of the step, but not tighter than the operation's own.
fn band(job: &Job, spacing: f64) -> Band {
    /// Looser than this brings no fewer blocks worth having, mm.
    const LOOSE: f64 = 0.05;
    let half = (0.5 * (job.step - spacing)).min(LOOSE);
    Band { into: half.max(job.band.into), out: half.max(job.band.out) }
}

/// Distance from the profile's point to the edge of the blank along the outward normal, mm; negative when the
/// normal misses the blank.
fn to_edge(f: &Frenet, outward: Vec2, blank: f64) -> f64 {
    let along = f.p.coords.dot(&outward);
    let square = along * along + blank * blank - f.p.coords.norm_squared();
    if square < 0.0 { -1.0 } else { square.sqrt() - along }
}

/// The part of a closed curve within an interval that may run over its start.
fn piece(curve: &CurveRef, interval: Interval) -> Option<CurveRef> {
    let (_, last) = curve.domain();
    if interval.to <= last {
        return Part::new(curve.clone(), interval.from, interval.to).map(|p| Arc::new(p) as CurveRef);
    }
    let from_start = restarted(curve, interval.from);
    let first = from_start.domain().0;
    Part::new(from_start, first, first + interval.to - interval.from).map(|p| Arc::new(p) as CurveRef)
}

/// Frenet data at a curve's end.
fn last_of(curve: &dyn PlanarCurve) -> Frenet {
    let span = curve.breaks().len().saturating_sub(2);
    curve.at_in(span, curve.domain().1)
}
