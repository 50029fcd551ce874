//! NURBS curves as rational Bézier segments, by their polar forms.

use super::path::{Jet, Primitive};
use crate::geom::{Point2, Vec2};
use crate::readback::SpaceCurve;

/// Largest order that is taken apart.
const MOST_ORDER: usize = 16;

/// The rational Bézier segments of a clamped NURBS curve; none when its numbers don't make a curve.
pub(super) fn segments(order: usize, points: &[Point2], weights: &[f64], knots: &[f64]) -> Vec<Primitive> {
    if weights.len() != points.len() {
        return Vec::new();
    }
    let control: Vec<[f64; 3]> = points.iter().zip(weights).map(|(p, &w)| [p.x * w, p.y * w, w]).collect();
    let of = |points: Vec<[f64; 3]>| {
        let bounds = derivative_bounds(&points);
        Primitive::Rational { points, bounds }
    };
    beziers(order, &control, knots).into_iter().map(of).collect()
}

/// The heights of the segments of a curve in space, as the X of segments over the same parameters.
pub(super) fn heights(curve: &SpaceCurve) -> Vec<Primitive> {
    let points: Vec<Point2> = curve.points.iter().map(|p| Point2::new(p.z, 0.0)).collect();
    segments(usize::from(curve.order), &points, &curve.weights, &curve.knots)
}

/// Control points of the Bézier segments of a B-spline, one for every knot interval that is not empty; none when the
/// numbers don't make a curve.
pub(super) fn beziers<const D: usize>(
    order: usize,
    control: &[[f64; D]],
    knots: &[f64],
) -> Vec<Vec<[f64; D]>> {
    let whole =
        (2..=MOST_ORDER).contains(&order) && control.len() >= order && knots.len() == control.len() + order;
    if !whole {
        return Vec::new();
    }
    let spans = order - 1..control.len();
    spans.filter_map(|span| segment(order, control, knots, span)).collect()
}

/// The segment over knot interval `span`: point j is the polar form with j arguments at the interval's end and the rest
/// at its start.
fn segment<const D: usize>(
    order: usize,
    control: &[[f64; D]],
    knots: &[f64],
    span: usize,
) -> Option<Vec<[f64; D]>> {
    let (start, end) = (*knots.get(span)?, *knots.get(span + 1)?);
    let local = control.get(span + 1 - order..=span)?;
    let around = knots.get(span + 2 - order..span + order)?;
    let point = |j: usize| {
        let arguments = (1..order).map(|i| if i + j < order { start } else { end });
        polar(local, around, arguments)
    };
    (end > start).then(|| (0..order).map(point).collect())
}

/// The polar form of one interval by de Boor's scheme, an argument for every round. `around` are the 2 (order - 1) knots
/// about the interval.
fn polar<const D: usize>(
    local: &[[f64; D]],
    around: &[f64],
    arguments: impl Iterator<Item = f64>,
) -> [f64; D] {
    let mut work = [[0.0; D]; MOST_ORDER];
    let n = local.len().min(MOST_ORDER);
    for (slot, p) in work.iter_mut().zip(local) {
        *slot = *p;
    }
    for (round, argument) in (1..n).zip(arguments) {
        for j in (round..n).rev() {
            let key = |i: usize| around.get(i).copied().unwrap_or(argument);
            let (low, high) = (key(j - 1), key(j + n - 1 - round));
            let alpha = if high > low { (argument - low) / (high - low) } else { 0.0 };
            let (before, here) = (work[j - 1], work[j]);
            work[j] = core::array::from_fn(|c| (1.0 - alpha) * before[c] + alpha * here[c]);
        }
    }
    work[n.saturating_sub(1)]
}

/// Point and derivatives of a rational Bézier segment.
#[allow(clippy::cast_precision_loss)]
pub(super) fn jet(points: &[[f64; 3]], x: f64) -> Jet {
    let n = points.len().saturating_sub(1) as f64;
    let differences = |p: &[[f64; 3]]| -> Vec<[f64; 3]> {
        p.windows(2).map(|w| [0, 1, 2].map(|c| w[1][c] - w[0][c])).collect()
    };
    let first = differences(points);
    let second = differences(&first);
    let h = casteljau(points, x);
    let h1 = casteljau(&first, x).map(|v| v * n);
    let h2 = casteljau(&second, x).map(|v| v * n * (n - 1.0));
    let (w, w1, w2) = (h[2], h1[2], h2[2]);
    let p = Vec2::new(h[0], h[1]) / w;
    let v = (Vec2::new(h1[0], h1[1]) - p * w1) / w;
    let a = (Vec2::new(h2[0], h2[1]) - v * (2.0 * w1) - p * w2) / w;
    Jet { p: Point2::from(p), v, a }
}

fn casteljau(points: &[[f64; 3]], x: f64) -> [f64; 3] {
    let mut work = [[0.0; 3]; MOST_ORDER];
    let n = points.len().min(MOST_ORDER);
    for (slot, p) in work.iter_mut().zip(points) {
        *slot = *p;
    }
    for round in 1..n {
        for i in 0..n - round {
            work[i] = [0, 1, 2].map(|c| work[i][c] * (1.0 - x) + work[i + 1][c] * x);
        }
    }
    work[0]
}

/// Bounds on the first three derivatives. Exact (control polygon) for equal weights; for others, the largest of 17
/// samples, doubled.
#[allow(clippy::float_cmp, clippy::cast_precision_loss)]
fn derivative_bounds(points: &[[f64; 3]]) -> [f64; 3] {
    let n = points.len().saturating_sub(1) as f64;
    let weight = points.first().map_or(1.0, |p| p[2]);
    if points.iter().all(|p| p[2] == weight) {
        let mut run: Vec<Vec2> = points.iter().map(|p| Vec2::new(p[0], p[1]) / weight).collect();
        let mut factor = 1.0;
        return [n, n - 1.0, n - 2.0].map(|order| {
            run = run.windows(2).map(|w| w[1] - w[0]).collect();
            factor *= order.max(0.0);
            factor * run.iter().map(|v| v.norm()).fold(0.0, f64::max)
        });
    }
    let samples = 17;
    let jets: Vec<Jet> = (0..samples).map(|i| jet(points, i as f64 / (samples - 1) as f64)).collect();
    let largest = |f: &dyn Fn(&Jet) -> f64| 2.0 * jets.iter().map(f).fold(0.0, f64::max);
    let step = (samples - 1) as f64;
    let third = jets.windows(2).map(|w| (w[1].a - w[0].a).norm() * step).fold(0.0, f64::max);
    [largest(&|j| j.v.norm()), largest(&|j| j.a.norm()), 2.0 * third]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::sin_cos;

    #[test]
    fn a_rational_quadratic_is_a_circle() {
        let half = 0.5f64.sqrt();
        let points = [
            Point2::new(2.0, 0.0),
            Point2::new(2.0, 2.0),
            Point2::new(0.0, 2.0),
            Point2::new(-2.0, 2.0),
            Point2::new(-2.0, 0.0),
        ];
        let knots = [0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0];
        let parts = segments(3, &points, &[1.0, half, 1.0, half, 1.0], &knots);
        assert_eq!(parts.len(), 2);
        for part in &parts {
            for i in 0..=10 {
                let j = part.at(f64::from(i) / 10.0);
                assert!((j.p.coords.norm() - 2.0).abs() < 1e-14 && j.p.coords.dot(&j.v).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn segments_are_the_curve() {
        let points: Vec<Point2> = (0..7)
            .map(|i| {
                let (s, c) = sin_cos(f64::from(i));
                Point2::new(f64::from(i) + c, s)
            })
            .collect();
        let weights = [1.0, 2.0, 0.5, 1.0, 1.5, 1.0, 1.0];
        let knots = [0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 2.5, 4.0, 4.0, 4.0, 4.0];
        let parts = segments(4, &points, &weights, &knots);
        assert_eq!(parts.len(), 4);
        for (part, (a, b)) in parts.iter().zip([(0.0, 1.0), (1.0, 2.0), (2.0, 2.5), (2.5, 4.0)]) {
            for i in 0..=8 {
                let x = f64::from(i) / 8.0;
                let want = crate::readback::nurbs_point(4, &points, &weights, &knots, a + (b - a) * x);
                assert!((part.at(x).p - want).norm() < 1e-12, "{x}");
            }
        }
    }
}
