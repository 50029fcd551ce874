//! Length of a path, for feeds and times.

use super::TracePath;
use crate::geom::Point2;
use crate::math::hypot;

/// Nodes and weights of the five-point Gauss rule on [0, 1].
const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_5),
    (0.230_765_344_947_158_5, 0.239_314_335_249_683_2),
    (0.5, 0.284_444_444_444_444_4),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_2),
    (0.953_089_922_969_332, 0.118_463_442_528_094_5),
];

/// Length of the path in space, mm, when the height changes by `rise` along it.
pub(super) fn along(path: &TracePath, rise: f64) -> f64 {
    hypot(flat(path), rise)
}

/// Length of the path's projection on the XY plane, mm. Arcs and spirals are integrated by five Gauss points (relative
/// error below 1e-9 for radii that change by less than half their size); NURBS as chains of 256 chords a control
/// point.
fn flat(path: &TracePath) -> f64 {
    match path {
        TracePath::Line { from, to } => (to - from).norm(),
        TracePath::Arc { from, to, centre, sweep } => {
            polar_length((from - centre).norm(), (to - centre).norm(), *sweep)
        }
        TracePath::Spiral { radius, angle } => polar_length(radius.0, radius.1, angle.1 - angle.0),
        TracePath::Nurbs { order, points, weights, knots } => {
            nurbs_length(usize::from(*order), points, weights, knots)
        }
    }
}

/// Length of r = r0..r1 linear over `sweep`: the integral of sqrt(r² + (dr/dθ)²).
fn polar_length(r0: f64, r1: f64, sweep: f64) -> f64 {
    let d = r1 - r0;
    GAUSS.iter().map(|&(x, w)| w * hypot((r0 + d * x) * sweep, d)).sum()
}

#[allow(clippy::cast_precision_loss)]
fn nurbs_length(order: usize, points: &[Point2], weights: &[f64], knots: &[f64]) -> f64 {
    let chords = 256 * points.len().min(4096);
    let (Some(&u0), Some(&u1)) = (knots.get(order.saturating_sub(1)), knots.get(points.len())) else {
        return 0.0;
    };
    let at = |i: usize| {
        let u = u0 + (u1 - u0) * i as f64 / chords as f64;
        super::nurbs::point(order, points, weights, knots, u)
    };
    let mut length = 0.0;
    let mut last = at(0);
    for i in 1..=chords {
        let next = at(i);
        length += (next - last).norm();
        last = next;
    }
    length
}
