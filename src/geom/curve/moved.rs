//! Curves moved, turned, mirrored and scaled.

use super::{CurveRef, Frenet, PlanarCurve, Shape};
use crate::geom::{Point2, Vec2};
use crate::math::sin_cos;
use crate::units::Angle;

/// A similarity of the plane: mirror in the x axis (if asked), scale, turn, shift, in this order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Image of the x axis' unit vector, times the scale.
    x: Vec2,
    mirrored: bool,
    scale: f64,
    shift: Vec2,
}

impl Placement {
    /// Scale must be positive and everything finite, else `None`.
    #[must_use]
    pub fn new(mirrored: bool, scale: f64, turn: Angle, shift: Vec2) -> Option<Placement> {
        let finite = [scale, turn.rad(), shift.x, shift.y].iter().all(|v| v.is_finite());
        let (s, c) = sin_cos(turn.rad());
        (finite && scale > 0.0).then(|| Placement { x: Vec2::new(c, s), mirrored, scale, shift })
    }
    /// Image of a direction, length kept.
    fn direction(&self, v: Vec2) -> Vec2 {
        let y = if self.mirrored { -v.y } else { v.y };
        Vec2::new(self.x.x * v.x - self.x.y * y, self.x.y * v.x + self.x.x * y)
    }
    /// Image of a point.
    #[must_use]
    pub fn point(&self, p: Point2) -> Point2 {
        Point2::from(self.direction(p.coords) * self.scale + self.shift)
    }
    fn frenet(&self, f: Frenet) -> Frenet {
        let k = if self.mirrored { -f.k } else { f.k };
        Frenet { p: self.point(f.p), t: self.direction(f.t), speed: f.speed * self.scale, k: k / self.scale }
    }
}

/// A curve under a similarity; the parameter stays.
#[derive(Debug, Clone)]
pub struct Moved {
    base: CurveRef,
    placement: Placement,
}

impl Moved {
    /// `base` under `placement`.
    #[must_use]
    pub fn new(base: CurveRef, placement: Placement) -> Moved {
        Moved { base, placement }
    }
}

impl PlanarCurve for Moved {
    fn domain(&self) -> (f64, f64) {
        self.base.domain()
    }
    fn at(&self, u: f64) -> Frenet {
        self.placement.frenet(self.base.at(u))
    }
    fn at_in(&self, span: usize, u: f64) -> Frenet {
        self.placement.frenet(self.base.at_in(span, u))
    }
    fn breaks(&self) -> &[f64] {
        self.base.breaks()
    }
    fn shape(&self, span: usize) -> Shape {
        match self.base.shape(span) {
            Shape::Arc { centre, radius, ccw } => Shape::Arc {
                centre: self.placement.point(centre),
                radius: radius * self.placement.scale,
                ccw: ccw != self.placement.mirrored,
            },
            other => other,
        }
    }
    fn is_closed(&self) -> bool {
        self.base.is_closed()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::curve::testing::{assert_frenet_matches_differences, egg};

    #[test]
    fn placed_curves_have_matching_frenet_data() {
        for (mirrored, scale) in [(false, 1.0), (true, 1.0), (false, 25.4), (true, 0.5)] {
            let placement =
                Placement::new(mirrored, scale, Angle::degrees(33.0), Vec2::new(5.0, -7.0)).expect("valid");
            assert_frenet_matches_differences(&Moved::new(egg(), placement), 1e-3);
        }
    }

    #[test]
    fn mirroring_turns_a_counter_clockwise_arc_clockwise() {
        let circle =
            super::super::CircularArc::circle(Point2::new(1.0, 2.0), 3.0, 0.0, true).expect("circle");
        let placement = Placement::new(true, 2.0, Angle::degrees(0.0), Vec2::zeros()).expect("valid");
        let moved = Moved::new(std::sync::Arc::new(circle), placement);
        assert_eq!(moved.shape(0), Shape::Arc { centre: Point2::new(2.0, -4.0), radius: 6.0, ccw: false });
        assert_frenet_matches_differences(&moved, 1e-5);
    }
}
