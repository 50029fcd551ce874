//! Circular arcs and full circles.

use super::{Frenet, PlanarCurve, Shape};
use crate::geom::{Point2, Vec2, cross};
use crate::math::{TAU, atan2, hypot, sin_cos};

/// A circular arc; the parameter is the angle travelled in radians, from 0.
#[derive(Debug, Clone, PartialEq)]
pub struct CircularArc {
    centre: Point2,
    radius: f64,
    start: f64,
    ccw: bool,
    breaks: [f64; 2],
    closed: bool,
}

impl CircularArc {
    /// About `centre` from polar angle `start` over the signed `sweep` (radians, counter-clockwise positive).
    /// `None` when the radius is not positive, the sweep is 0 or over a full turn, or a value is not finite.
    #[must_use]
    pub fn new(centre: Point2, radius: f64, start: f64, sweep: f64) -> Option<CircularArc> {
        let finite = [centre.x, centre.y, radius, start, sweep].iter().all(|v| v.is_finite());
        let valid = finite && radius > 0.0 && sweep != 0.0 && sweep.abs() <= TAU;
        valid.then(|| CircularArc {
            centre,
            radius,
            start,
            ccw: sweep > 0.0,
            breaks: [0.0, sweep.abs()],
            closed: sweep.abs() == TAU,
        })
    }
    /// The full circle from polar angle `start` radians.
    #[must_use]
    pub fn circle(centre: Point2, radius: f64, start: f64, ccw: bool) -> Option<CircularArc> {
        CircularArc::new(centre, radius, start, if ccw { TAU } else { -TAU })
    }
    /// From `from` to `to` about `centre`; the radius is that of `from`, and only the direction of `to`
    /// counts. The same direction gives the full circle.
    #[must_use]
    pub fn between(from: Point2, to: Point2, centre: Point2, ccw: bool) -> Option<CircularArc> {
        let (a, b) = (from - centre, to - centre);
        let turn = atan2(cross(a, b), a.dot(&b));
        let travelled = if ccw { turn } else { -turn };
        let travelled = if travelled > 0.0 { travelled } else { travelled + TAU };
        let sweep = if ccw { travelled } else { -travelled };
        CircularArc::new(centre, hypot(a.x, a.y), atan2(a.y, a.x), sweep)
    }
    /// From `a` through `b` to `c`; `None` when they lie on a line.
    #[must_use]
    pub fn through(a: Point2, b: Point2, c: Point2) -> Option<CircularArc> {
        let (ab, ac) = (b - a, c - a);
        let twice_area = cross(ab, ac);
        if twice_area == 0.0 {
            return None;
        }
        let (ab2, ac2) = (ab.norm_squared(), ac.norm_squared());
        let to_centre = Vec2::new(ac.y * ab2 - ab.y * ac2, ab.x * ac2 - ac.x * ab2) / (2.0 * twice_area);
        CircularArc::between(a, c, a + to_centre, twice_area > 0.0)
    }
    /// Centre, mm.
    #[must_use]
    pub fn centre(&self) -> Point2 {
        self.centre
    }
    /// Radius, mm.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }
    /// Signed sweep, radians, counter-clockwise positive.
    #[must_use]
    pub fn sweep(&self) -> f64 {
        self.sign() * self.breaks[1]
    }
    fn sign(&self) -> f64 {
        if self.ccw { 1.0 } else { -1.0 }
    }
}

impl PlanarCurve for CircularArc {
    fn domain(&self) -> (f64, f64) {
        (0.0, self.breaks[1])
    }
    fn at(&self, u: f64) -> Frenet {
        let turn = if self.closed && u == self.breaks[1] { 0.0 } else { u };
        let (s, c) = sin_cos(self.start + self.sign() * turn);
        Frenet {
            p: self.centre + Vec2::new(c, s) * self.radius,
            t: Vec2::new(-s, c) * self.sign(),
            speed: self.radius,
            k: self.sign() / self.radius,
        }
    }
    fn at_in(&self, _span: usize, u: f64) -> Frenet {
        self.at(u)
    }
    fn breaks(&self) -> &[f64] {
        &self.breaks
    }
    fn shape(&self, _span: usize) -> Shape {
        Shape::Arc { centre: self.centre, radius: self.radius, ccw: self.ccw }
    }
    fn is_closed(&self) -> bool {
        self.closed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::curve::ends;
    use crate::geom::curve::testing::assert_frenet_matches_differences;
    use crate::math::PI;

    #[test]
    fn both_senses_have_matching_frenet_data() {
        for sweep in [2.5, -2.5, TAU, -TAU] {
            let arc = CircularArc::new(Point2::new(3.0, -1.0), 7.0, 0.4, sweep).expect("arc");
            assert_frenet_matches_differences(&arc, 1e-7);
        }
    }

    #[test]
    fn an_arc_through_three_points_passes_them() {
        let (a, b, c) = (Point2::new(5.0, 0.0), Point2::new(0.0, -5.0), Point2::new(-5.0, 0.0));
        let arc = CircularArc::through(a, b, c).expect("not on a line");
        assert!((arc.sweep() + PI).abs() < 1e-12);
        assert!((arc.at(PI / 2.0).p - b).norm() < 1e-12);
        assert_eq!(CircularArc::through(a, Point2::new(6.0, 0.0), Point2::new(9.0, 0.0)), None);
    }

    #[test]
    fn a_full_circle_ends_where_it_starts_to_the_bit() {
        let c = CircularArc::circle(Point2::new(0.1, 0.2), 3.3, 1.234, true).expect("circle");
        let (first, last) = ends(&c);
        assert_eq!(first, last);
        assert!(c.is_closed());
    }

    #[test]
    fn between_takes_the_asked_way_round() {
        let (o, x, y) = (Point2::origin(), Point2::new(2.0, 0.0), Point2::new(0.0, 2.0));
        let near = CircularArc::between(x, y, o, true).expect("arc");
        let far = CircularArc::between(x, y, o, false).expect("arc");
        assert!((near.sweep() - PI / 2.0).abs() < 1e-15);
        assert!((far.sweep() + 1.5 * PI).abs() < 1e-15);
    }
}
