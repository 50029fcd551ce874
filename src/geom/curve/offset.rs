//! Parallel curves.

use super::{CurveRef, Frenet, PlanarCurve, Shape};
use crate::geom::Point2;

/// The parallel curve at a signed distance to the left of another, point for point along the normals.
///
/// Nothing is trimmed or bridged: beyond the base's centres of curvature the parallel runs backwards (negative
/// speed), and at a corner of the base it has a gap. [`crate::geom::parallel`] deals with corners.
#[derive(Debug, Clone)]
pub struct Offset {
    base: CurveRef,
    distance: f64,
    closed: bool,
}

impl Offset {
    /// At `distance` mm to the left of `base` (negative: to the right).
    #[must_use]
    pub fn new(base: CurveRef, distance: f64) -> Offset {
        let closed = base.is_closed();
        Offset { base, distance, closed }
    }
    /// The curve that this one is parallel to.
    #[must_use]
    pub fn base(&self) -> &CurveRef {
        &self.base
    }
    /// Distance to the left of the base, mm.
    #[must_use]
    pub fn distance(&self) -> f64 {
        self.distance
    }
    fn arc(&self, centre: Point2, radius: f64, ccw: bool) -> Shape {
        let radius = if ccw { radius - self.distance } else { radius + self.distance };
        if radius > 0.0 { Shape::Arc { centre, radius, ccw } } else { Shape::General }
    }
}

impl PlanarCurve for Offset {
    fn domain(&self) -> (f64, f64) {
        self.base.domain()
    }
    fn at(&self, u: f64) -> Frenet {
        self.base.at(u).offset(self.distance)
    }
    fn at_in(&self, span: usize, u: f64) -> Frenet {
        self.base.at_in(span, u).offset(self.distance)
    }
    fn breaks(&self) -> &[f64] {
        self.base.breaks()
    }
    fn shape(&self, span: usize) -> Shape {
        match self.base.shape(span) {
            Shape::Line => Shape::Line,
            Shape::Arc { centre, radius, ccw } => self.arc(centre, radius, ccw),
            Shape::General => Shape::General,
        }
    }
    fn is_closed(&self) -> bool {
        self.closed
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::geom::curve::testing::{assert_frenet_matches_differences, egg};
    use crate::geom::curve::{CircularArc, PlanarCurve};

    #[test]
    fn offsets_of_a_smooth_closed_curve_have_matching_frenet_data() {
        for d in [-8.0, -0.5, 0.5, 2.0] {
            assert_frenet_matches_differences(&Offset::new(egg(), d), 1e-3);
        }
    }

    #[test]
    fn an_offset_circle_is_the_concentric_circle() {
        let circle = Arc::new(CircularArc::circle(Point2::new(1.0, 2.0), 10.0, 0.0, true).expect("circle"));
        let Shape::Arc { radius, .. } = Offset::new(circle.clone(), 4.0).shape(0) else { panic!("an arc") };
        assert_eq!(radius, 6.0);
        assert_eq!(Offset::new(circle, 11.0).shape(0), Shape::General);
    }

    #[test]
    fn past_the_centre_of_curvature_the_offset_runs_backwards() {
        let circle = Arc::new(CircularArc::circle(Point2::origin(), 10.0, 0.0, true).expect("circle"));
        assert!(Offset::new(circle, 11.0).at(0.3).speed < 0.0);
    }
}
