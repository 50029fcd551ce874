//! Cubic splines through points.

use super::{Frenet, PlanarCurve, Shape, span_of};
use crate::geom::{Point2, Vec2, cross};
use crate::math::hypot;

/// The C2 cubic spline through given points, by chord length.
#[derive(Debug, Clone, PartialEq)]
pub struct Spline {
    /// Parameters of the points: cumulated chord length, mm.
    breaks: Vec<f64>,
    /// Power coefficients of every span about its start.
    pieces: Vec<[Vec2; 4]>,
    closed: bool,
}

/// What holds at a spline's ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ends {
    /// The spline closes smoothly from the last point to the first (which is not repeated).
    Periodic,
    /// No bending at the ends.
    Natural,
    /// Tangent directions at the start and at the end (any positive length); without one, no bending there.
    Clamped(Option<Vec2>, Option<Vec2>),
}

/// Why there is no spline through the points.
#[derive(Debug, Clone, PartialEq)]
pub enum SplineError {
    /// At least two points are needed, three for a closed spline.
    TooFewPoints {
        /// How many there are.
        have: usize,
        /// How many are needed.
        need: usize,
    },
    /// Two points that follow each other are the same, or a point is not finite.
    Coincident {
        /// Index of the second of them.
        index: usize,
    },
    /// An end tangent has no length.
    NoTangent,
}

impl Spline {
    /// Interpolates `points`.
    ///
    /// # Errors
    /// [`SplineError`] for too few or repeated points.
    pub fn new(points: &[Point2], ends: Ends) -> Result<Spline, SplineError> {
        let closed = ends == Ends::Periodic;
        let need = if closed { 3 } else { 2 };
        if points.len() < need {
            return Err(SplineError::TooFewPoints { have: points.len(), need });
        }
        let mut nodes: Vec<Vec2> = points.iter().map(|p| p.coords).collect();
        nodes.extend(closed.then(|| points[0].coords));
        let breaks = chord_lengths(&nodes)?;
        let slopes = node_slopes(&breaks, &nodes, ends)?;
        let pieces = (0..nodes.len() - 1).map(|i| hermite(i, &breaks, &nodes, &slopes)).collect();
        Ok(Spline { breaks, pieces, closed })
    }
}

fn chord_lengths(nodes: &[Vec2]) -> Result<Vec<f64>, SplineError> {
    let mut breaks = vec![0.0];
    for (i, w) in nodes.windows(2).enumerate() {
        let length = hypot(w[1].x - w[0].x, w[1].y - w[0].y);
        if !(length > 0.0 && length.is_finite()) {
            return Err(SplineError::Coincident { index: (i + 1) % nodes.len() });
        }
        breaks.push(breaks[i] + length);
    }
    Ok(breaks)
}

/// First derivatives at the nodes from continuity of the second derivative.
fn node_slopes(breaks: &[f64], nodes: &[Vec2], ends: Ends) -> Result<Vec<Vec2>, SplineError> {
    let boundary = |pick: fn(Vec2) -> f64| match ends {
        Ends::Periodic => Ok(crate::geom::tridiagonal::End::Periodic),
        Ends::Natural => Ok(crate::geom::tridiagonal::End::Natural),
        Ends::Clamped(a, b) => {
            let unit = |v: Vec2| {
                let length = hypot(v.x, v.y);
                if length > 0.0 { Ok(pick(v / length)) } else { Err(SplineError::NoTangent) }
            };
            Ok(crate::geom::tridiagonal::End::Clamped(a.map(unit).transpose()?, b.map(unit).transpose()?))
        }
    };
    let solve = |pick: fn(Vec2) -> f64| {
        let values: Vec<f64> = nodes.iter().map(|v| pick(*v)).collect();
        boundary(pick).map(|end| crate::geom::tridiagonal::slopes(breaks, &values, end))
    };
    let (x, y) = (solve(|v| v.x)?, solve(|v| v.y)?);
    Ok(x.into_iter().zip(y).map(|(x, y)| Vec2::new(x, y)).collect())
}

/// Power coefficients of span `i` from end values and slopes.
fn hermite(i: usize, breaks: &[f64], nodes: &[Vec2], slopes: &[Vec2]) -> [Vec2; 4] {
    let h = breaks[i + 1] - breaks[i];
    let (p, q, m, n) = (nodes[i], nodes[i + 1], slopes[i], slopes[i + 1]);
    let rise = (q - p) / h;
    [p, m, (rise * 3.0 - m * 2.0 - n) / h, (m + n - rise * 2.0) / (h * h)]
}

impl PlanarCurve for Spline {
    fn domain(&self) -> (f64, f64) {
        (0.0, self.breaks[self.breaks.len() - 1])
    }
    fn at(&self, u: f64) -> Frenet {
        self.at_in(span_of(&self.breaks, u), u)
    }
    fn at_in(&self, span: usize, u: f64) -> Frenet {
        let [a, b, c, d] = self.pieces[span];
        let x = u - self.breaks[span];
        let d1 = b + (c * 2.0 + d * (3.0 * x)) * x;
        let d2 = c * 2.0 + d * (6.0 * x);
        let speed = hypot(d1.x, d1.y);
        let (t, k) = if speed > 0.0 {
            (d1 / speed, cross(d1, d2) / (speed * speed * speed))
        } else {
            (Vec2::new(1.0, 0.0), 0.0)
        };
        Frenet { p: Point2::from(a + (b + (c + d * x) * x) * x), t, speed, k }
    }
    fn breaks(&self) -> &[f64] {
        &self.breaks
    }
    fn shape(&self, span: usize) -> Shape {
        let [_, _, c, d] = self.pieces[span];
        if c == Vec2::zeros() && d == Vec2::zeros() { Shape::Line } else { Shape::General }
    }
    fn is_closed(&self) -> bool {
        self.closed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::curve::Joint;
    use crate::geom::curve::testing::{assert_frenet_matches_differences, egg};

    #[test]
    fn a_periodic_spline_is_smooth_with_continuous_curvature_everywhere() {
        assert_frenet_matches_differences(egg().as_ref(), 1e-3);
        for joint in Joint::all(egg().as_ref()) {
            assert!(joint.turn.abs() < 1e-12 && joint.bend.abs() < 1e-12, "{joint:?}");
        }
        assert!(egg().is_closed());
    }

    #[test]
    fn clamped_ends_have_the_given_directions() {
        let p = [Point2::new(0.0, 0.0), Point2::new(5.0, 3.0), Point2::new(9.0, -1.0)];
        let ends = Ends::Clamped(Some(Vec2::new(0.0, 2.0)), Some(Vec2::new(3.0, 0.0)));
        let spline = Spline::new(&p, ends).expect("three points");
        assert!((spline.at(0.0).t - Vec2::new(0.0, 1.0)).norm() < 1e-12);
        assert!((spline.at(spline.domain().1).t - Vec2::new(1.0, 0.0)).norm() < 1e-12);
        for (u, q) in spline.breaks().iter().zip(p) {
            assert!((spline.at(*u).p - q).norm() < 1e-12);
        }
    }

    #[test]
    fn natural_ends_do_not_bend() {
        let p =
            [Point2::new(0.0, 0.0), Point2::new(5.0, 3.0), Point2::new(9.0, -1.0), Point2::new(12.0, 0.0)];
        let spline = Spline::new(&p, Ends::Natural).expect("four points");
        assert!(spline.at(0.0).k.abs() < 1e-12 && spline.at(spline.domain().1).k.abs() < 1e-12);
    }

    #[test]
    fn repeated_and_missing_points_are_errors() {
        let p = Point2::new(1.0, 1.0);
        assert_eq!(Spline::new(&[p, p], Ends::Natural), Err(SplineError::Coincident { index: 1 }));
        assert_eq!(Spline::new(&[p], Ends::Natural), Err(SplineError::TooFewPoints { have: 1, need: 2 }));
        assert_eq!(
            Spline::new(&[p, Point2::origin()], Ends::Periodic),
            Err(SplineError::TooFewPoints { have: 2, need: 3 })
        );
    }
}
