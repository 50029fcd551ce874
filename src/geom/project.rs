//! Nearest points of planar curves, and signed normal deviations.

use super::curve::{Frenet, PlanarCurve, span_of, spans};
use super::extremum::golden;
use super::measure::arc_length;
use super::{Point2, cross};
use crate::math::hypot;

/// The nearest point of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foot {
    /// Parameter.
    pub u: f64,
    /// Place, mm.
    pub p: Point2,
    /// Distance, mm.
    pub distance: f64,
    /// Signed distance, mm: positive when the point lies to the left of the curve there.
    pub deviation: f64,
}

/// Finds nearest points of one curve for many points.
///
/// The curve is divided into pieces of about equal parameter within its smooth spans. A piece cannot hold a point
/// nearer than its ends' distances less half its length, so pieces that cannot win are never looked at: the
/// result is the global minimum as long as the distance has one minimum within each piece.
#[derive(Debug, Clone)]
pub struct Projector<'a> {
    curve: &'a dyn PlanarCurve,
    pieces: Vec<Piece>,
}

#[derive(Debug, Clone, Copy)]
struct Piece {
    span: usize,
    from: f64,
    to: f64,
    start: Point2,
    end: Point2,
    length: f64,
}

impl<'a> Projector<'a> {
    /// Divides every smooth span so that no piece spans more than `1/steps` of the whole domain.
    #[must_use]
    pub fn new(curve: &'a dyn PlanarCurve, steps: usize) -> Projector<'a> {
        let (first, last) = curve.domain();
        let step = (last - first) / steps.max(1) as f64;
        let mut pieces = Vec::new();
        for (span, a, b) in spans(curve) {
            let count = ((b - a) / step).ceil().max(1.0) as usize;
            let at = |i: usize| if i == count { b } else { a + (b - a) * i as f64 / count as f64 };
            pieces.extend((0..count).map(|i| Piece::new(curve, span, at(i), at(i + 1))));
        }
        Projector { curve, pieces }
    }
    /// The nearest point of the whole curve.
    #[must_use]
    pub fn nearest(&self, q: Point2) -> Foot {
        let mut order: Vec<(f64, usize)> =
            self.pieces.iter().enumerate().map(|(i, piece)| (piece.lower_bound(q), i)).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut best: Option<Foot> = None;
        for (bound, index) in order {
            if best.is_some_and(|b| bound >= b.distance) {
                break;
            }
            let foot = self.pieces[index].nearest(self.curve, q);
            if best.is_none_or(|b| foot.distance < b.distance) {
                best = Some(foot);
            }
        }
        best.unwrap_or_else(|| foot_at(self.curve.at(self.curve.domain().0), self.curve.domain().0, q))
    }
}

impl Piece {
    fn new(curve: &dyn PlanarCurve, span: usize, from: f64, to: f64) -> Piece {
        /// The length only bounds distances: a micrometre more costs nothing.
        const SLACK: f64 = 1e-3;
        let length = arc_length(curve, from, to, SLACK) + SLACK;
        let (start, end) = (curve.at_in(span, from).p, curve.at_in(span, to).p);
        Piece { span, from, to, start, end, length }
    }
    fn lower_bound(&self, q: Point2) -> f64 {
        let ends = distance(self.start, q) + distance(self.end, q);
        // A point of the piece is x from one end and at most length − x from the other.
        0.5 * (ends - self.length)
    }
    fn nearest(&self, curve: &dyn PlanarCurve, q: Point2) -> Foot {
        let negative = |u: f64| -distance(curve.at_in(self.span, u).p, q);
        let (u, _) = golden(negative, self.from, self.to);
        let u = newton(curve, self.span, q, u, (self.from, self.to));
        [self.from, u, self.to]
            .into_iter()
            .map(|u| foot_at(curve.at_in(self.span, u), u, q))
            .min_by(|a, b| a.distance.total_cmp(&b.distance))
            .unwrap_or_else(|| foot_at(curve.at_in(self.span, u), u, q))
    }
}

fn distance(a: Point2, b: Point2) -> f64 {
    hypot(a.x - b.x, a.y - b.y)
}

fn foot_at(f: Frenet, u: f64, q: Point2) -> Foot {
    let gap = q - f.p;
    let distance = hypot(gap.x, gap.y);
    let deviation = if cross(f.t, gap) < 0.0 { -distance } else { distance };
    Foot { u, p: f.p, distance, deviation }
}

/// Newton's method on (c(u) − q)·c'(u) = 0 within an interval: with d the signed distance of q to the left and s
/// the speed, the derivative is s (1 − κ d). Steps that leave the interval or do not reduce the distance stop it.
fn newton(curve: &dyn PlanarCurve, span: usize, q: Point2, start: f64, (from, to): (f64, f64)) -> f64 {
    const STEPS: usize = 12;
    /// Near the minimum, distances are equal but for rounding.
    const SAME: f64 = 1.0 + 8.0 * f64::EPSILON;
    let mut u = start.clamp(from, to);
    let mut f = curve.at_in(span, u);
    for _ in 0..STEPS {
        let gap = q - f.p;
        let slope = f.speed * (1.0 - f.k * cross(f.t, gap));
        let next = (u + gap.dot(&f.t) / slope).clamp(from, to);
        if !next.is_finite() || next == u {
            break;
        }
        let there = curve.at_in(span, next);
        if distance(there.p, q) > SAME * distance(f.p, q) {
            break;
        }
        (u, f) = (next, there);
    }
    u
}

/// The nearest point near parameter `hint`, by Newton's method in its smooth span; `None` when that ends at the
/// span's end, where the nearest point may lie beyond.
#[must_use]
pub fn nearest_near(curve: &dyn PlanarCurve, q: Point2, hint: f64) -> Option<Foot> {
    let span = span_of(curve.breaks(), hint);
    let ends = (curve.breaks()[span], curve.breaks()[span + 1]);
    let u = newton(curve, span, q, hint, ends);
    let inside = ends.0 < u && u < ends.1;
    inside.then(|| foot_at(curve.at_in(span, u), u, q))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::curve::testing::egg;
    use crate::geom::curve::{CircularArc, Segment};
    use crate::math::{TAU, sin_cos};

    #[test]
    fn feet_on_a_circle_are_radial_and_signed_by_side() {
        let circle = CircularArc::circle(Point2::new(1.0, 2.0), 5.0, 0.0, true).expect("circle");
        let projector = Projector::new(&circle, 16);
        for i in 0..37 {
            let (s, c) = sin_cos(f64::from(i) * 0.17);
            for r in [2.0, 4.9, 5.3, 20.0] {
                let foot = projector.nearest(Point2::new(1.0 + r * c, 2.0 + r * s));
                assert!((foot.deviation - (5.0 - r)).abs() < 1e-12, "{r} {i}");
                // Feet this near give the same distance but for rounding.
                assert!((foot.p - Point2::new(1.0 + 5.0 * c, 2.0 + 5.0 * s)).norm() < 1e-6);
            }
        }
    }

    #[test]
    fn points_off_the_normal_come_back_to_their_parameter() {
        let curve = egg();
        let projector = Projector::new(curve.as_ref(), 64);
        for i in 0..50 {
            let u = curve.domain().1 * (f64::from(i) + 0.37) / 50.0;
            for d in [-3.0, -1e-3, 0.0, 1e-6, 2.0] {
                let q = curve.at(u).offset(d).p;
                let foot = projector.nearest(q);
                assert!((foot.deviation - d).abs() < 1e-10 && (foot.u - u).abs() < 1e-5, "{u} {d} {foot:?}");
                let near = nearest_near(curve.as_ref(), q, u + 1e-3).expect("inside its span");
                assert!((near.deviation - d).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn the_nearest_point_is_global() {
        let curve = egg();
        let projector = Projector::new(curve.as_ref(), 32);
        for i in 0..100 {
            let (s, c) = sin_cos(f64::from(i) * TAU / 100.0);
            let q = Point2::new(11.0 * c, 3.0 * s);
            let brute = (0..20_000)
                .map(|k| distance(curve.at(curve.domain().1 * f64::from(k) / 20_000.0).p, q))
                .fold(f64::INFINITY, f64::min);
            assert!((projector.nearest(q).distance - brute).abs() < 1e-5);
        }
    }

    #[test]
    fn beyond_an_open_end_the_end_is_nearest() {
        let line = Segment::new(Point2::new(0.0, 0.0), Point2::new(10.0, 0.0)).expect("two points");
        let foot = Projector::new(&line, 4).nearest(Point2::new(13.0, -4.0));
        assert_eq!((foot.p, foot.distance, foot.deviation), (Point2::new(10.0, 0.0), 5.0, -5.0));
        assert_eq!(nearest_near(&line, Point2::new(13.0, 4.0), 5.0), None);
    }
}
