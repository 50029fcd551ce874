//! Bezier curves of any degree.

use std::sync::Arc;

use super::{Chain, ChainError, CurveRef, Frenet, PlanarCurve, Segment, Shape};
use crate::geom::{Point2, Vec2, cross};
use crate::math::hypot;

/// A Bezier curve, parameter 0 to 1.
///
/// Where the first derivative vanishes (coincident control points at an end), the tangent is the limit from
/// inside; the curvature there may be infinite in truth and is reported as 0, with speed 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Bezier {
    points: Vec<Point2>,
    /// Control vectors of the first derivative.
    first: Vec<Vec2>,
    /// Control vectors of the second derivative.
    second: Vec<Vec2>,
    breaks: [f64; 2],
    straight: bool,
}

impl Bezier {
    /// Of degree `points.len() - 1`; `None` for fewer than two points, for points that are all the same, or
    /// that are not finite.
    #[must_use]
    pub fn new(points: Vec<Point2>) -> Option<Bezier> {
        let finite = points.iter().all(|p| p.x.is_finite() && p.y.is_finite());
        let moves = points.windows(2).any(|w| w[0] != w[1]);
        if !finite || !moves {
            return None;
        }
        let first = differences(&points.iter().map(|p| p.coords).collect::<Vec<_>>());
        let second = differences(&first);
        let straight = is_straight(&first);
        Some(Bezier { points, first, second, breaks: [0.0, 1.0], straight })
    }
    /// Control points.
    #[must_use]
    pub fn points(&self) -> &[Point2] {
        &self.points
    }
    /// Unit tangent, also where the first derivative vanishes.
    fn direction(&self, u: f64, d1: Vec2, d2: Vec2) -> Vec2 {
        let speed = hypot(d1.x, d1.y);
        if speed > self.vanishing() {
            return d1 / speed;
        }
        let towards_inside = if u < 0.5 { d2 } else { -d2 };
        let bend = hypot(towards_inside.x, towards_inside.y);
        if bend > self.vanishing() {
            return towards_inside / bend;
        }
        let (a, b) = (self.points[0], self.points[self.points.len() - 1]);
        let chord = if a == b {
            self.first.iter().copied().fold(Vec2::zeros(), |m, v| if v.norm() > m.norm() { v } else { m })
        } else {
            b - a
        };
        chord / hypot(chord.x, chord.y)
    }
    /// A derivative below this, in mm, counts as vanished: rounding of the control polygon's size.
    fn vanishing(&self) -> f64 {
        const RELATIVE: f64 = 1e-13;
        RELATIVE * self.first.iter().map(|v| v.x.abs() + v.y.abs()).fold(0.0, f64::max)
    }
}

/// Control vectors of the derivative: degree times the differences.
fn differences(points: &[Vec2]) -> Vec<Vec2> {
    let degree = points.len().saturating_sub(1) as f64;
    points.windows(2).map(|w| (w[1] - w[0]) * degree).collect()
}

/// Whether all legs of the control polygon point the same way, exactly enough to call the curve a line.
fn is_straight(legs: &[Vec2]) -> bool {
    const ROUNDING: f64 = 4.0 * f64::EPSILON;
    let Some(longest) = legs.iter().copied().max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))
    else {
        return false;
    };
    let limit = ROUNDING * longest.norm_squared();
    legs.iter().all(|leg| cross(longest, *leg).abs() <= limit && longest.dot(leg) >= 0.0)
}

/// Value of a polynomial in Bernstein form by Horner's scheme (Schumaker & Volk); no memory is allocated.
fn bernstein(points: impl ExactSizeIterator<Item = Vec2>, u: f64) -> Vec2 {
    let degree = points.len().saturating_sub(1);
    let complement = 1.0 - u;
    let (mut sum, mut power, mut binomial) = (Vec2::zeros(), 1.0, 1.0);
    for (i, p) in points.enumerate() {
        if i > 0 {
            binomial = binomial * (degree - i + 1) as f64 / i as f64;
            power *= u;
            sum *= complement;
        }
        sum += p * (binomial * power);
    }
    sum
}

impl PlanarCurve for Bezier {
    fn domain(&self) -> (f64, f64) {
        (0.0, 1.0)
    }
    fn at(&self, u: f64) -> Frenet {
        let p = Point2::from(bernstein(self.points.iter().map(|p| p.coords), u));
        let d1 = bernstein(self.first.iter().copied(), u);
        let d2 = bernstein(self.second.iter().copied(), u);
        let speed = hypot(d1.x, d1.y);
        let regular = speed > self.vanishing();
        let k = if regular && !self.straight { cross(d1, d2) / (speed * speed * speed) } else { 0.0 };
        Frenet { p, t: self.direction(u, d1, d2), speed, k }
    }
    fn at_in(&self, _span: usize, u: f64) -> Frenet {
        self.at(u)
    }
    fn breaks(&self) -> &[f64] {
        &self.breaks
    }
    fn shape(&self, _span: usize) -> Shape {
        if self.straight { Shape::Line } else { Shape::General }
    }
    fn is_closed(&self) -> bool {
        self.points.first() == self.points.last()
    }
}

/// The chain of cubics through 3n + 1 points, every third of them on the curve.
///
/// # Errors
/// [`ChainError::Empty`] unless there are 3n + 1 points (n >= 1) of which some differ. A cubic whose four
/// points are the same is left out.
pub fn bezier_chain(points: &[Point2]) -> Result<Chain, ChainError> {
    if points.len() < 4 || points.len() % 3 != 1 {
        return Err(ChainError::Empty);
    }
    let cubic = |i: usize| Bezier::new(points[i..i + 4].to_vec());
    let curves: Vec<CurveRef> = (0..points.len() - 1).step_by(3).filter_map(cubic).map(as_curve).collect();
    Chain::new(curves, 0.0)
}

/// A straight cubic becomes a segment, so that its parameter is its length.
fn as_curve(cubic: Bezier) -> CurveRef {
    let ends = (cubic.points[0], cubic.points[3]);
    match Segment::new(ends.0, ends.1) {
        Some(segment) if cubic.straight => Arc::new(segment),
        _ => Arc::new(cubic),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::curve::testing::assert_frenet_matches_differences;

    fn points(list: &[(f64, f64)]) -> Vec<Point2> {
        list.iter().map(|&(x, y)| Point2::new(x, y)).collect()
    }

    #[test]
    fn frenet_data_of_degrees_2_to_7_match_differences() {
        let all = points(&[
            (0.0, 0.0),
            (3.0, 9.0),
            (9.0, 8.0),
            (14.0, -3.0),
            (20.0, 2.0),
            (26.0, 9.0),
            (30.0, 0.0),
            (37.0, 1.0),
        ]);
        for n in 3..=all.len() {
            let curve = Bezier::new(all[..n].to_vec()).expect("points differ");
            assert_frenet_matches_differences(&curve, 1e-4);
            assert!((curve.at(1.0).p - all[n - 1]).norm() < 1e-12);
        }
    }

    #[test]
    fn coincident_end_points_have_the_tangent_from_inside() {
        let curve = Bezier::new(points(&[(0.0, 0.0), (0.0, 0.0), (3.0, 4.0), (10.0, 4.0)])).expect("moves");
        assert!((curve.at(0.0).t - Vec2::new(0.6, 0.8)).norm() < 1e-15);
        assert!((curve.at(1e-7).t - Vec2::new(0.6, 0.8)).norm() < 1e-6);
    }

    #[test]
    fn straight_control_polygons_are_lines() {
        let line = Bezier::new(points(&[(0.0, 0.0), (1.0, 2.0), (2.0, 4.0), (5.0, 10.0)])).expect("moves");
        assert_eq!(line.shape(0), Shape::Line);
        let overshoot = Bezier::new(points(&[(0.0, 0.0), (9.0, 0.0), (5.0, 0.0)])).expect("moves");
        assert_eq!(overshoot.shape(0), Shape::General);
    }

    #[test]
    fn a_chain_of_cubics_has_its_breaks_at_every_third_point() {
        let p =
            points(&[(0.0, 0.0), (1.0, 1.0), (2.0, 1.0), (3.0, 0.0), (4.0, -1.0), (5.0, -1.0), (6.0, 0.0)]);
        let chain = bezier_chain(&p).expect("seven points");
        assert_eq!(chain.breaks(), &[0.0, 1.0, 2.0]);
        assert_frenet_matches_differences(&chain, 1e-5);
        assert!(bezier_chain(&p[..6]).is_err());
    }
}
