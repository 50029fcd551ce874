//! Full circles about the cam's centre, and the paper's plan of clipped circles.

use std::sync::Arc;

use super::Job;
use super::moves::Plan;
use crate::geom::curve::CircularArc;
use crate::geom::{Point2, Side, Vec2};
use crate::math::{acos, atan2, sin_cos};

/// Clears the blank by full circles as far as the cam's largest radius allows, and leaves it outside the blank.
/// Returns the radius that is left, mm; the blank's own when there is no circle to cut.
pub(super) fn full(job: &Job, plan: &mut Plan) -> f64 {
    let room = job.blank - job.reach().0 - job.leave;
    let count = (room / job.step + 1e-9).floor();
    if !(1.0..=super::MOST_PASSES as f64).contains(&count) {
        return job.blank;
    }
    let ccw = job.part == Side::Left;
    let mut left = job.blank;
    for _ in 0..count as usize {
        left -= job.step;
        let radius = left + job.cutter;
        let Some(start) = touch(plan, job, radius, ccw) else { return left };
        if let Some(circle) = CircularArc::circle(Point2::origin(), radius, start, ccw) {
            plan.cut(Arc::new(circle), job.part, job.band);
        }
    }
    plan.engagement = job.step;
    if let Some(p) = plan.position() {
        plan.up(p + p.coords.normalize() * (job.outside - p.coords.norm()));
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
            let (s, c) = sin_cos(-turn * acos((radius / job.outside).min(1.0)));
            let p = Point2::from(Vec2::new(c, s) * job.outside);
            plan.down(p);
            p
        }
    };
    let distance = from.coords.norm();
    (distance >= radius).then(|| atan2(from.y, from.x) + turn * acos((radius / distance).min(1.0)))
}
