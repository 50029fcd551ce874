//! Roughing by circles about the cam's centre: the plan of Kim & Yang (1991), section 3.4.
//!
//! Circle j has its wall at radius r_j = blank − j·step, its centre path at ρ_j = r_j + cutter. Where the
//! contour's centre curve stays inside ρ_j all round, it is cut whole; else on the arcs between contour and
//! contour, to and fro. Arcs of one valley lie within one another.
//!
//! Circles are concentric, so the radial depth is the step; the entries keep it so: the cutter comes to the start
//! of an arc on a tangent of its circle, against the arc's direction, and turns round at the contour. Only where
//! an arc ends against a contour that crosses it steeply does the cutter meet more ([`sickle`]).

use std::sync::Arc;

use super::moves::Plan;
use super::passes::{Interval, Level, Positive};
use super::{Job, MOST_PASSES};
use crate::geom::curve::{CircularArc, CurveRef, into_domain, restarted};
use crate::geom::{Point2, Side, Vec2, cross};
use crate::math::{TAU, acos, asin, atan2, cos, sin_cos};

/// Path left out at the end of a full circle, mm; the ridge between the cutter's first and last place there is
/// GAP²/8 radius high.
const GAP: f64 = 0.5;

/// Clears the blank by full circles as far as the cam's largest radius allows, and leaves it outside the blank.
/// Returns the radius that is left, mm; the blank's own when there is no circle to cut.
pub(super) fn full(job: &Job, plan: &mut Plan) -> f64 {
    let room = job.blank - job.reach().0 - job.leave;
    let count = (room / job.step + 1e-9).floor();
    if !(1.0..=MOST_PASSES as f64).contains(&count) {
        return job.blank;
    }
    let ccw = job.part == Side::Left;
    let mut left = job.blank;
    for _ in 0..count as usize {
        left -= job.step;
        let radius = left + job.cutter;
        let Some(start) = touch(plan, job, radius, ccw) else { return left };
        // Open by a gap that leaves no step, so that the circle starts where the way to it leads.
        let sweep = TAU - GAP / radius;
        let sweep = if ccw { sweep } else { -sweep };
        if let Some(circle) = CircularArc::new(Point2::origin(), radius, start, sweep) {
            plan.cut(Arc::new(circle), job.part, job.band);
        }
    }
    plan.engagement = job.step;
    if let Some(p) = plan.position() {
        plan.up(p + p.coords.normalize() * super::CLEAR);
    }
    left
}

/// Polar angle at which the cutter comes onto the circle along a tangent, from outside the blank or from the
/// circle before.
fn touch(plan: &mut Plan, job: &Job, radius: f64, ccw: bool) -> Option<f64> {
    let turn = if ccw { 1.0 } else { -1.0 };
    let from = match plan.position() {
        Some(p) => p,
        None => {
            let p = at(-turn * acos((radius / job.outside).min(1.0)), job.outside);
            plan.down(p);
            p
        }
    };
    let distance = from.coords.norm();
    (distance >= radius).then(|| atan2(from.y, from.x) + turn * acos((radius / distance).min(1.0)))
}

/// The point at polar angle and radius.
fn at(angle: f64, radius: f64) -> Point2 {
    let (s, c) = sin_cos(angle);
    Point2::new(c * radius, s * radius)
}

/// The paper's plan; `None` when the contour is not seen whole from the centre, or takes too many passes.
pub(super) fn plan(job: &Job) -> Option<Plan> {
    let mut plan = Plan::default();
    let left = full(job, &mut plan);
    let circles = Circles::new(job, left)?;
    for root in circles.intervals(0) {
        circles.valley(&mut plan, 0, root, true);
        circles.lift(&mut plan);
    }
    circles.contour(&mut plan);
    plan.engagement = circles.engagement();
    Some(plan)
}

struct Circles<'a> {
    job: &'a Job,
    /// Centre curve of the contour with its allowance, counter-clockwise or clockwise as the job's profile.
    centre: CurveRef,
    /// Centre-path radii and where each circle has work, outermost first.
    work: Vec<(f64, Positive)>,
    turn: f64,
    /// +1 when the profile runs counter-clockwise.
    sense: f64,
}

impl<'a> Circles<'a> {
    fn new(job: &'a Job, blank: f64) -> Option<Circles<'a>> {
        let reach = job.leave + job.cutter;
        let centre = |f: &crate::geom::curve::Frenet| f.p + job.outward(f) * reach;
        let sense = job.part.sign();
        let seen_whole = job.samples.points.iter().all(|(_, f)| cross(centre(f).coords, f.t) * sense > 0.0);
        let inside = Level::new(&job.samples, |f| -centre(f).coords.norm());
        let count = ((blank + job.cutter + inside.greatest()) / job.step - 1e-9).ceil().max(1.0) - 1.0;
        if !seen_whole || count > MOST_PASSES as f64 {
            return None;
        }
        let work = (1..=count as usize)
            .map(|j| blank - j as f64 * job.step + job.cutter)
            .map(|radius| (radius, inside.above(-radius + super::rings::NO_WORK)))
            .collect();
        let (first, last) = job.profile.domain();
        Some(Circles { job, centre: job.parallel(reach), work, turn: last - first, sense })
    }

    fn intervals(&self, circle: usize) -> Vec<Interval> {
        match self.work.get(circle) {
            Some((_, Positive::Within(intervals))) => intervals.clone(),
            _ => Vec::new(),
        }
    }

    /// The step, or the widest sickle at an arc's end.
    fn engagement(&self) -> f64 {
        let ends = self.work.iter().flat_map(|(_, work)| match work {
            Positive::Within(intervals) => intervals.iter().flat_map(|i| [i.from, i.to]).collect(),
            _ => Vec::new(),
        });
        let sickle = |u: f64| {
            let f = self.centre.at(into_domain(self.centre.as_ref(), u));
            let radial = f.p.coords.normalize();
            let (sine, cosine) = (radial.dot(&f.t).abs(), cross(radial, f.t).abs());
            sickle(self.job.step, self.job.cutter, (sine, cosine))
        };
        ends.map(sickle).fold(self.job.step, f64::max)
    }

    /// The arc of one interval, then what lies deeper in it, in the other direction.
    fn valley(&self, plan: &mut Plan, circle: usize, interval: Interval, forward: bool) {
        let Some((radius, _)) = self.work.get(circle) else { return };
        self.arc(plan, circle, *radius, interval, forward);
        let deeper = self.intervals(circle + 1).into_iter().filter(|i| interval.holds(i, self.turn));
        let mut children: Vec<Interval> = deeper.collect();
        // The one next to where the arc ended comes first.
        if forward {
            children.reverse();
        }
        for (i, child) in children.iter().enumerate() {
            if i > 0 {
                self.lift(plan);
            }
            self.valley(plan, circle + 1, *child, !forward);
        }
    }

    fn arc(&self, plan: &mut Plan, circle: usize, radius: f64, interval: Interval, forward: bool) {
        let polar = |u: f64| {
            let p = self.centre.at(into_domain(self.centre.as_ref(), u)).p;
            atan2(p.y, p.x)
        };
        let (from, to) = (polar(interval.from), polar(interval.to));
        let sweep = (self.sense * (to - from)).rem_euclid(TAU) * self.sense;
        let (start, sweep) = if forward { (from, sweep) } else { (to, -sweep) };
        let Some(arc) = CircularArc::new(Point2::origin(), radius, start, sweep) else { return };
        self.approach(plan, circle, &arc, start);
        let part = if forward { self.job.part } else { self.job.part.opposite() };
        plan.cut(Arc::new(arc), part, self.job.band);
    }

    /// On the tangent that touches the circle at the arc's start, against the arc's direction. The tangent
    /// starts on the circle before, or outside the blank.
    fn approach(&self, plan: &mut Plan, circle: usize, arc: &CircularArc, start: f64) {
        let cleared = circle.checked_sub(1).and_then(|i| self.work.get(i)).map(|(radius, _)| *radius);
        let along = |from: f64| start + arc.sweep().signum() * acos((arc.radius() / from).min(1.0));
        match (plan.position(), cleared) {
            (Some(p), Some(cleared)) => self.go_back(plan, p, (along(cleared), cleared), arc),
            (_, Some(cleared)) => {
                // Above the valley's cleared part, in from outside along the radius.
                let angle = along(cleared);
                plan.down(at(angle, self.job.outside));
                plan.link(at(angle, cleared));
            }
            (_, None) => plan.down(at(along(self.job.outside), self.job.outside)),
        }
        plan.link(at(start, arc.radius()));
    }

    /// Back along the circle before, through its own cut, to a polar angle: straight would cut the contour.
    fn go_back(&self, plan: &mut Plan, from: Point2, (angle, radius): (f64, f64), next: &CircularArc) {
        let turn = next.sweep().signum();
        let sweep = (turn * (angle - atan2(from.y, from.x))).rem_euclid(TAU);
        // Where the tangent starts beyond the place where the cutter is, there is nothing to go back.
        if sweep >= 0.5 * TAU {
            return plan.link(at(angle, radius));
        }
        let part = if turn * self.sense > 0.0 { self.job.part } else { self.job.part.opposite() };
        if let Some(arc) = CircularArc::new(Point2::origin(), radius, atan2(from.y, from.x), turn * sweep) {
            plan.run(Arc::new(arc), part, self.job.band);
        }
    }

    /// Straight up where the last arc ended.
    fn lift(&self, plan: &mut Plan) {
        if let Some(p) = plan.position() {
            plan.up(p);
        }
    }

    /// Once round the contour, starting where the blank was thinnest.
    fn contour(&self, plan: &mut Plan) {
        let radius = |u: f64| self.centre.at(u).p.coords.norm_squared();
        let us = self.job.samples.points.iter().map(|(u, _)| *u);
        let Some(start) = us.max_by(|a, b| radius(*a).total_cmp(&radius(*b))) else { return };
        let curve = restarted(&self.centre, start);
        let first = curve.at(curve.domain().0);
        plan.down(first.p - first.t * way_out(first.p, -first.t, self.job.outside));
        plan.round(&curve, self.job.part, super::contour_band(self.job, self.job.band));
        let away: Vec2 = first.n() * self.job.part.opposite().sign();
        plan.up(first.p + away * super::CLEAR);
    }
}

/// Width across the feed of what the cutter meets at the end of an arc, beyond the step itself, mm; 0 when that is
/// all it meets. α is the angle at which the contour crosses the circle.
///
/// The arc before ended at the same contour, L = step / sin α earlier along it. Of the cutter's front, from the wall
/// (ψ = 0) to straight ahead, what lies past that end is still in the stock up to ψ = α + asin(L / 2 radius).
fn sickle(step: f64, radius: f64, (sine, cosine): (f64, f64)) -> f64 {
    let length = step / sine;
    let ahead = length * cosine / radius;
    if length >= 2.0 * radius || ahead >= 1.0 {
        return 0.0;
    }
    let front = atan2(sine, cosine) + asin(0.5 * length / radius);
    if front <= asin(ahead) { 0.0 } else { radius * (1.0 - cos(front)) }
}

/// Length from `p` along the unit vector `way` to where the distance from the centre is `outside`, mm.
pub(super) fn way_out(p: Point2, way: Vec2, outside: f64) -> f64 {
    let along = p.coords.dot(&way);
    let square = along * along + outside * outside - p.coords.norm_squared();
    (square.max(0.0).sqrt() - along).max(0.0)
}
