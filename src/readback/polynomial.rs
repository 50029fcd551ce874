//! Polynomial curves as controls are told them: coefficients of a parameter, to Bézier control points.

use super::{SpaceCurve, TracePath};
use crate::geom::{Point2, Point3};

/// Control points of the polynomial c0 + c1 t + c2 t² + … over 0..1, of degree `degree`.
pub(super) fn bernstein(coefficients: &[f64], degree: usize) -> Vec<f64> {
    let point = |i: usize| {
        // Of the ways to choose: C(i, k) / C(degree, k), from one k to the next.
        let mut share = 1.0;
        let mut sum = 0.0;
        for (k, c) in coefficients.iter().enumerate().take(i + 1) {
            sum += share * c;
            share *= crate::math::count(i - k) / crate::math::count((degree - k).max(1));
        }
        sum
    };
    (0..=degree).map(point).collect()
}

/// One Bézier curve through control points in the part; level where all have the same height.
#[allow(clippy::float_cmp)]
pub(super) fn bezier(points: &[(Point2, f64)], weights: Vec<f64>) -> TracePath {
    let order = u8::try_from(points.len()).unwrap_or(u8::MAX);
    let knots = [vec![0.0; points.len()], vec![1.0; points.len()]].concat();
    if points.windows(2).all(|pair| pair[0].1 == pair[1].1) {
        return TracePath::Nurbs { order, points: points.iter().map(|(p, _)| *p).collect(), weights, knots };
    }
    let points = points.iter().map(|(p, z)| Point3::new(p.x, p.y, *z)).collect();
    TracePath::Space(Box::new(SpaceCurve { order, points, weights, knots }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_is_its_control_points_curve() {
        // 1 + 2 t - 3 t² + 4 t³ as a cubic and as a quintic.
        let c = [1.0, 2.0, -3.0, 4.0];
        let cubic = bernstein(&c, 3);
        for (got, want) in cubic.iter().zip([1.0, 1.0 + 2.0 / 3.0, 1.0 + 4.0 / 3.0 - 1.0, 4.0]) {
            assert!((got - want).abs() < 1e-15, "{cubic:?}");
        }
        let quintic = bernstein(&c, 5);
        let points: Vec<(Point2, f64)> = quintic.iter().map(|v| (Point2::new(*v, 0.0), 1.0)).collect();
        let TracePath::Nurbs { order: 6, points, weights, knots } = bezier(&points, vec![1.0; 6]) else {
            panic!()
        };
        for i in 0..=8 {
            let t = f64::from(i) / 8.0;
            let want = c.iter().rev().fold(0.0, |sum, c| sum * t + c);
            let got = super::super::curve::point(6, &points, &weights, &knots, t);
            assert!((got.x - want).abs() < 1e-14, "{t}");
        }
    }
}
