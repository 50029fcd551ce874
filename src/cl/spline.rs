//! Cubic B-splines in space.

use crate::geom::Point3;

/// Order (degree + 1) of every [`Spline`].
pub const ORDER: usize = 4;

/// A cubic B-spline without weights, at feed, from where the cutter is.
#[derive(Debug, Clone, PartialEq)]
pub struct Spline {
    points: Vec<Point3>,
    knots: Vec<f64>,
    tolerance: f64,
}

impl Spline {
    /// A clamped spline; `None` when the numbers make none: knots are points + [`ORDER`], finite and rising, and the
    /// first and the last [`ORDER`] of them are the same.
    ///
    /// `points` and `tolerance` (how far the path may leave the curve) in mm; the first point is where the cutter is.
    #[must_use]
    #[allow(clippy::float_cmp)]
    pub fn new(points: Vec<Point3>, knots: Vec<f64>, tolerance: f64) -> Option<Spline> {
        let (first, last) = (knots.get(..ORDER)?, knots.get(knots.len() - ORDER..)?);
        let same = |run: &[f64]| run.iter().all(|k| Some(k) == run.first());
        let whole = points.len() >= ORDER && knots.len() == points.len() + ORDER;
        let rising = knots.windows(2).all(|w| w[0] <= w[1]) && first[0] < last[0];
        let finite = points.iter().all(|p| p.iter().all(|v| v.is_finite()))
            && knots.iter().all(|k| k.is_finite())
            && tolerance.is_finite();
        let good = whole && rising && finite && same(first) && same(last);
        good.then_some(Spline { points, knots, tolerance })
    }

    /// Control points, mm.
    #[must_use]
    pub fn points(&self) -> &[Point3] {
        &self.points
    }

    /// Knots, points + [`ORDER`] of them.
    #[must_use]
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// How far the path may leave the curve, mm.
    #[must_use]
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Last point, mm.
    #[must_use]
    pub fn end(&self) -> Point3 {
        self.points.last().copied().unwrap_or_else(Point3::origin)
    }

    /// Control points of the Bézier segments, one for every knot interval that is not empty.
    pub fn segments(&self) -> impl Iterator<Item = [Point3; ORDER]> {
        segments(&self.points, &self.knots)
    }
}

/// The same for control points and knots of their own (as many as a [`Spline`] has).
pub fn segments<'s>(
    points: &'s [Point3],
    knots: &'s [f64],
) -> impl Iterator<Item = [Point3; ORDER]> + use<'s> {
    (ORDER - 1..points.len()).filter_map(|span| {
        let (a, b) = (*knots.get(span)?, *knots.get(span + 1)?);
        let corners = [[a, a, a], [a, a, b], [a, b, b], [b, b, b]];
        (b > a).then(|| corners.map(|at| blossom(points, knots, span, at)))
    })
}

/// De Boor's scheme with an argument of its own for every level (Ramshaw's blossom).
fn blossom(points: &[Point3], knots: &[f64], span: usize, at: [f64; 3]) -> Point3 {
    let first = span + 1 - ORDER;
    let mut d: [Point3; ORDER] =
        core::array::from_fn(|j| points.get(first + j).copied().unwrap_or_else(Point3::origin));
    for (level, at) in (1..ORDER).zip(at) {
        for j in (level..ORDER).rev() {
            let i = first + j;
            let knot = |i: usize| knots.get(i).copied().unwrap_or(at);
            let (low, high) = (knot(i), knot(i + ORDER - level));
            let x = if high > low { (at - low) / (high - low) } else { 0.0 };
            d[j] = d[j - 1] + (d[j] - d[j - 1]) * x;
        }
    }
    d[ORDER - 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(n: u32) -> Vec<Point3> {
        (0..n)
            .map(|i| {
                let x = f64::from(i);
                Point3::new(x, f64::from(i * i % 7), f64::from(i * 5 % 11))
            })
            .collect()
    }

    #[test]
    fn segments_join_and_end_where_the_spline_does() {
        let knots = vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.5, 4.0, 4.0, 6.0, 6.0, 6.0, 6.0];
        let spline = Spline::new(points(8), knots, 0.01).expect("a spline");
        let parts: Vec<[Point3; 4]> = spline.segments().collect();
        assert_eq!(parts.len(), 4);
        assert_eq!((parts[0][0], parts[3][3]), (spline.points()[0], spline.end()));
        for (pair, (left, right)) in parts.windows(2).zip([(1.0, 0.5), (0.5, 2.5)]) {
            assert!((pair[0][3] - pair[1][0]).norm() < 1e-12);
            // Once continuous by the parameter.
            let slope = |leg: nalgebra::Vector3<f64>, interval: f64| leg / interval;
            let jump = slope(pair[0][3] - pair[0][2], left) - slope(pair[1][1] - pair[1][0], right);
            assert!(jump.norm() < 1e-12, "{jump}");
        }
    }

    #[test]
    fn what_is_no_clamped_cubic_is_none() {
        let good = [0.0, 0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0, 1.0];
        assert!(Spline::new(points(5), good.to_vec(), 0.01).is_some());
        for (at, wrong) in [(4, -0.5), (4, f64::NAN), (0, -1.0), (8, 2.0), (8, f64::INFINITY)] {
            let mut knots = good;
            knots[at] = wrong;
            assert!(Spline::new(points(5), knots.to_vec(), 0.01).is_none(), "{knots:?}");
        }
        assert!(Spline::new(points(4), good.to_vec(), 0.01).is_none());
        assert!(Spline::new(points(5), vec![1.0; 9], 0.01).is_none());
        assert!(Spline::new(Vec::new(), Vec::new(), 0.01).is_none());
    }
}
