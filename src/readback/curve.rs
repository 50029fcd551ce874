//! Curves that controls draw: arcs of other planes, lengths, for feeds and times, and points of NURBS.

use super::{SpaceCurve, Tilted, TracePath};
use crate::geom::{Point2, Point3, Vec3};
use crate::math::hypot;

/// Working planes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Plane {
    /// G17.
    Xy,
    /// G18.
    Zx,
    /// G19.
    Yz,
}

impl Plane {
    /// Its first and second axis, and the one across it, by index.
    pub(super) fn axes(self) -> [usize; 3] {
        match self {
            Plane::Xy => [0, 1, 2],
            Plane::Zx => [2, 0, 1],
            Plane::Yz => [1, 2, 0],
        }
    }

    /// A turn in the plane, from and to a level across it.
    pub(super) fn turn(
        self,
        [start, end, centre]: [Point2; 3],
        (from, to): (f64, f64),
        sweep: f64,
    ) -> Tilted {
        let [first, second, across] = self.axes();
        let space = |p: Point2, level: f64| {
            let mut q = Point3::origin();
            q[first] = p.x;
            q[second] = p.y;
            q[across] = level;
            q
        };
        let mut axis = Vec3::zeros();
        axis[across] = 1.0;
        Tilted { from: space(start, from), to: space(end, to), centre: space(centre, from), axis, sweep }
    }
}

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
        TracePath::Space(curve) => {
            chords(curve.points.len(), |x| curve.at(x)).map(|(a, b)| (b - a).norm()).sum()
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
            let order = usize::from(*order);
            let (u0, u1) = domain(order, points.len(), knots);
            let at = |x: f64| point(order, points, weights, knots, u0 + (u1 - u0) * x);
            chords(points.len(), at).map(|(a, b)| (b - a).norm()).sum()
        }
        TracePath::Space(curve) => chords(curve.points.len(), |x| curve.at(x).xy())
            .map(|(a, b): (Point2, Point2)| (b - a).norm())
            .sum(),
    }
}

/// Length of r = r0..r1 linear over `sweep`: the integral of sqrt(r² + (dr/dθ)²).
fn polar_length(r0: f64, r1: f64, sweep: f64) -> f64 {
    let d = r1 - r0;
    GAUSS.iter().map(|&(x, w)| w * hypot((r0 + d * x) * sweep, d)).sum()
}

/// Ends of 256 chords a control point over 0..1.
fn chords<P: Copy>(points: usize, at: impl Fn(f64) -> P) -> impl Iterator<Item = (P, P)> {
    let count = 256 * u32::try_from(points.min(4096)).unwrap_or(4096);
    let mut last = at(0.0);
    (1..=count).map(move |i| {
        let next = at(f64::from(i) / f64::from(count));
        (core::mem::replace(&mut last, next), next)
    })
}

/// First and last parameter of a curve with this many control points.
fn domain(order: usize, points: usize, knots: &[f64]) -> (f64, f64) {
    let first = knots.get(order.saturating_sub(1)).copied().unwrap_or(0.0);
    (first, knots.get(points).copied().unwrap_or(first))
}

/// Point of a rational B-spline at `u`. Parameters outside the domain give the nearest end.
pub(crate) fn point(order: usize, points: &[Point2], weights: &[f64], knots: &[f64], u: f64) -> Point2 {
    let Some(first) = points.first() else { return Point2::origin() };
    let control = |i: usize| points.get(i).unwrap_or(first).coords.into();
    Point2::from(rational(order, (points.len(), control), weights, knots, u))
}

/// Point of a curve in space at `x` in 0..1 of its domain.
pub(super) fn space_point(curve: &SpaceCurve, x: f64) -> Point3 {
    let Some(first) = curve.points.first() else { return Point3::origin() };
    let order = usize::from(curve.order);
    let (u0, u1) = domain(order, curve.points.len(), &curve.knots);
    let control = |i: usize| curve.points.get(i).unwrap_or(first).coords.into();
    let points = (curve.points.len(), control);
    Point3::from(rational(order, points, &curve.weights, &curve.knots, u0 + (u1 - u0) * x))
}

/// De Boor's algorithm on homogeneous coordinates; `points` are how many, and each of them.
fn rational<const D: usize>(
    order: usize,
    (count, control): (usize, impl Fn(usize) -> [f64; D]),
    weights: &[f64],
    knots: &[f64],
    u: f64,
) -> [f64; D] {
    if order < 2 || count < order || knots.len() < count + order {
        return control(0);
    }
    let inside = knots.get(order..count).unwrap_or_default();
    let span = order - 1 + inside.partition_point(|&k| k <= u);
    let mut d = [([0.0; D], 0.0); 32];
    let used = order.min(32);
    for (j, slot) in d.iter_mut().enumerate().take(used) {
        let i = (span + 1 + j - order).min(count - 1);
        let w = weights.get(i).copied().unwrap_or(1.0);
        *slot = (control(i).map(|v| v * w), w);
    }
    let knot = |i: usize| knots.get(i).copied().unwrap_or(0.0);
    for r in 1..used {
        for j in (r..used).rev() {
            let i = span + 1 + j - order;
            let (a, b) = (knot(i), knot(i + order - r));
            let t = if b > a { ((u - a) / (b - a)).clamp(0.0, 1.0) } else { 0.0 };
            let mix = |p: f64, q: f64| p * (1.0 - t) + q * t;
            d[j] = (core::array::from_fn(|c| mix(d[j - 1].0[c], d[j].0[c])), mix(d[j - 1].1, d[j].1));
        }
    }
    let (p, w) = d[used - 1];
    p.map(|v| v / w)
}
