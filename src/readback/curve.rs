//! Curves that controls draw: lengths, for feeds and times, and points of NURBS.

use super::TracePath;
use crate::geom::{Point2, Vec2};
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
    match path {
        TracePath::Tilted(arc) => {
            let (r0, r1) = arc.radii();
            hypot(polar_length(r0, r1, arc.sweep), arc.rise())
        }
        _ => hypot(flat(path), rise),
    }
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
        TracePath::Tilted(arc) => (arc.to - arc.from).xy().norm(),
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
        point(order, points, weights, knots, u)
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

/// Point of a rational B-spline at `u`, by de Boor's algorithm on homogeneous coordinates. Parameters outside the
/// domain give the nearest end.
pub(crate) fn point(order: usize, points: &[Point2], weights: &[f64], knots: &[f64], u: f64) -> Point2 {
    let Some(first) = points.first() else { return Point2::origin() };
    if order < 2 || points.len() < order || knots.len() < points.len() + order {
        return *first;
    }
    let last = points.len() - 1;
    let inside = knots.get(order..points.len()).unwrap_or_default();
    let span = order - 1 + inside.partition_point(|&k| k <= u);
    let mut d = [(Vec2::zeros(), 0.0); 32];
    let used = order.min(32);
    for (j, slot) in d.iter_mut().enumerate().take(used) {
        let i = (span + 1 + j - order).min(last);
        let w = weights.get(i).copied().unwrap_or(1.0);
        *slot = (points.get(i).unwrap_or(first).coords * w, w);
    }
    let knot = |i: usize| knots.get(i).copied().unwrap_or(0.0);
    for r in 1..used {
        for j in (r..used).rev() {
            let i = span + 1 + j - order;
            let (a, b) = (knot(i), knot(i + order - r));
            let t = if b > a { ((u - a) / (b - a)).clamp(0.0, 1.0) } else { 0.0 };
            d[j] = (d[j - 1].0 * (1.0 - t) + d[j].0 * t, d[j - 1].1 * (1.0 - t) + d[j].1 * t);
        }
    }
    let (p, w) = d[used - 1];
    Point2::from(p / w)
}
