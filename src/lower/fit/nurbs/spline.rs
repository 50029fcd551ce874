//! Clamped cubic B-splines: basis functions by de Boor's recursion, points and derivatives.

use nalgebra::{Const, OPoint, SVector};

/// Order (degree + 1) of every curve fitted here.
pub(in crate::lower) const ORDER: usize = 4;

/// A clamped cubic B-spline curve without weights, in D dimensions.
#[derive(Debug, Clone)]
pub(in crate::lower) struct Spline<const D: usize> {
    /// Knots, points + [`ORDER`] of them, the first and last repeated [`ORDER`] times.
    pub knots: Vec<f64>,
    /// Control points, mm.
    pub points: Vec<OPoint<f64, Const<D>>>,
}

/// Point and derivatives by the parameter.
#[derive(Debug, Clone, Copy)]
pub(in crate::lower) struct Jet<const D: usize> {
    /// Point, mm.
    pub p: OPoint<f64, Const<D>>,
    /// First derivative.
    pub d: SVector<f64, D>,
    /// Second derivative.
    pub dd: SVector<f64, D>,
}

/// Clamped knots around ascending interior knots.
pub(in crate::lower) fn clamped(first: f64, inside: &[f64], last: f64) -> Vec<f64> {
    let mut knots = vec![first; ORDER];
    knots.extend_from_slice(inside);
    knots.extend([last; ORDER]);
    knots
}

/// Index i of the knot interval [k_i, k_{i+1}) of positive length that holds `t`.
pub(in crate::lower) fn interval(knots: &[f64], t: f64) -> usize {
    let points = knots.len() - ORDER;
    let mut i = knots.partition_point(|k| *k <= t).clamp(ORDER, points) - 1;
    while i > ORDER - 1 && knots[i + 1] <= knots[i] {
        i -= 1;
    }
    i
}

/// The four basis functions that do not vanish on interval `i`, at `t`: those of points i - 3 … i.
pub(in crate::lower) fn basis(knots: &[f64], i: usize, t: f64) -> [f64; ORDER] {
    let mut b = [1.0, 0.0, 0.0, 0.0];
    for degree in 1..ORDER {
        raise(knots, i, t, degree, &mut b);
    }
    b
}

/// One step of de Boor's recursion, from degree - 1 to degree.
fn raise(knots: &[f64], i: usize, t: f64, degree: usize, b: &mut [f64; ORDER]) {
    let mut saved = 0.0;
    for j in 0..degree {
        let (low, high) = (knots[i + 1 + j - degree], knots[i + 1 + j]);
        let part = b[j] / (high - low);
        b[j] = saved + (high - t) * part;
        saved = (t - low) * part;
    }
    b[degree] = saved;
}

impl<const D: usize> Spline<D> {
    /// First and last parameter.
    #[cfg(test)]
    pub fn domain(&self) -> (f64, f64) {
        (self.knots[ORDER - 1], self.knots[self.points.len()])
    }

    /// Point and derivatives at `t`, by blossoming on interval `i`.
    pub fn jet(&self, i: usize, t: f64) -> Jet<D> {
        let k = &self.knots;
        let mut q: [SVector<f64, D>; ORDER] = core::array::from_fn(|j| self.points[i + 1 + j - ORDER].coords);
        // Degree 3 → 2 → 1: after two rounds the difference gives the derivatives.
        let mix = |q: &mut [SVector<f64, D>; ORDER], round: usize| {
            for j in (round..ORDER).rev() {
                let (low, high) = (k[i + 1 + j - ORDER], k[i + 1 + j - round]);
                let x = (t - low) / (high - low);
                q[j] = q[j - 1] * (1.0 - x) + q[j] * x;
            }
        };
        mix(&mut q, 1);
        let second = self.second(&q, i);
        mix(&mut q, 2);
        let h = k[i + 1] - k[i];
        let d = (q[3] - q[2]) * (3.0 / h);
        mix(&mut q, 3);
        Jet { p: OPoint::from(q[3]), d, dd: second }
    }

    /// Second derivative from the points after the first round.
    fn second(&self, q: &[SVector<f64, D>; ORDER], i: usize) -> SVector<f64, D> {
        let k = &self.knots;
        let a = (q[2] - q[1]) / (k[i + 1] - k[i - 1]);
        let b = (q[3] - q[2]) / (k[i + 2] - k[i]);
        (b - a) * (6.0 / (k[i + 1] - k[i]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::{Point2, Vec2};

    fn example() -> Spline<2> {
        let knots = clamped(0.0, &[1.0, 1.5, 4.0, 4.0], 6.0);
        let points = (0..8).map(|i| Point2::new(f64::from(i * i % 7), f64::from(i * 5 % 11))).collect();
        Spline { knots, points }
    }

    #[test]
    fn basis_and_blossoming_agree() {
        let s = example();
        for j in 0..=120 {
            let t = f64::from(j) * 0.05;
            let i = interval(&s.knots, t);
            let b = basis(&s.knots, i, t);
            let p = (0..ORDER).fold(Vec2::zeros(), |p, j| p + s.points[i + 1 + j - ORDER].coords * b[j]);
            assert!((p - s.jet(i, t).p.coords).norm() < 1e-12, "{t}");
            assert!((b.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn derivatives_are_those_of_the_points() {
        let s = example();
        let h = 1e-4;
        for t in [0.3, 1.2, 2.7, 3.9, 5.5] {
            let i = interval(&s.knots, t);
            let (a, m, b) = (s.jet(i, t - h), s.jet(i, t), s.jet(i, t + h));
            assert!(((b.p - a.p) / (2.0 * h) - m.d).norm() < 1e-6);
            assert!(((b.d - a.d) / (2.0 * h) - m.dd).norm() < 1e-6);
        }
    }

    #[test]
    fn ends_are_the_first_and_last_points() {
        let s = example();
        let (a, b) = s.domain();
        assert_eq!(s.jet(interval(&s.knots, a), a).p, s.points[0]);
        assert!((s.jet(interval(&s.knots, b), b).p - s.points[7]).norm() < 1e-14);
    }
}
