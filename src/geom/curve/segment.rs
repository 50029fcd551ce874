//! Straight line segments.

use super::{Frenet, PlanarCurve, Shape};
use crate::geom::{Point2, Vec2};

/// A straight line from one point to another, by arc length in mm.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    from: Point2,
    direction: Vec2,
    breaks: [f64; 2],
}

impl Segment {
    /// From `from` to `to`; `None` when they are the same point or not finite.
    #[must_use]
    pub fn new(from: Point2, to: Point2) -> Option<Segment> {
        let d = to - from;
        let length = crate::math::hypot(d.x, d.y);
        let valid = length > 0.0 && length.is_finite();
        valid.then(|| Segment { from, direction: d / length, breaks: [0.0, length] })
    }
    /// Length, mm.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.breaks[1]
    }
}

impl PlanarCurve for Segment {
    fn domain(&self) -> (f64, f64) {
        (0.0, self.breaks[1])
    }
    fn at(&self, u: f64) -> Frenet {
        Frenet { p: self.from + self.direction * u, t: self.direction, speed: 1.0, k: 0.0 }
    }
    fn at_in(&self, _span: usize, u: f64) -> Frenet {
        self.at(u)
    }
    fn breaks(&self) -> &[f64] {
        &self.breaks
    }
    fn shape(&self, _span: usize) -> Shape {
        Shape::Line
    }
    fn is_closed(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::curve::testing::assert_frenet_matches_differences;

    #[test]
    fn segment_runs_from_one_point_to_the_other() {
        let s = Segment::new(Point2::new(1.0, 2.0), Point2::new(4.0, 6.0)).expect("two points");
        assert_eq!(s.length(), 5.0);
        assert!((s.at(5.0).p - Point2::new(4.0, 6.0)).norm() < 1e-15);
        assert_frenet_matches_differences(&s, 1e-9);
    }

    #[test]
    fn a_point_is_no_segment() {
        assert_eq!(Segment::new(Point2::new(1.0, 2.0), Point2::new(1.0, 2.0)), None);
        assert_eq!(Segment::new(Point2::new(f64::NAN, 2.0), Point2::new(1.0, 2.0)), None);
    }
}
