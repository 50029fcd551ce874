//! Polynomial motions from boundary conditions.

use super::form::Coefficients;
use super::{Conditions, MotionIssue, Segment, SegmentKind, SegmentLaw};

/// The polynomial's coefficients over x = 0…1, constant first (0), so that the degree is one less than the
/// number of conditions; `None` when the conditions do not determine it.
pub(super) fn coefficients(segment: &Segment) -> Option<Coefficients> {
    let SegmentLaw::Poly { start, end } = segment.law else { return None };
    let mut rows = conditions(segment, start, end);
    let n = rows.len();
    solve(&mut rows, n)
}

/// The issue of a `POLY` segment whose conditions do not determine a polynomial.
pub(super) fn unsolvable(index: usize, segment: &Segment) -> Option<MotionIssue> {
    let SegmentLaw::Poly { start, end } = segment.law else { return None };
    if segment.kind == SegmentKind::Dwell || coefficients(segment).is_some() {
        return None;
    }
    Some(MotionIssue::PolyUndetermined { segment: index, conditions: conditions(segment, start, end).len() })
}

/// One linear condition on the coefficients: factors, and the value.
type Condition = ([f64; 8], f64);

/// Lift at both ends and what else is given; derivatives are scaled from per radian to per segment.
fn conditions(segment: &Segment, start: Conditions, end: Conditions) -> Vec<Condition> {
    let beta = segment.angle.rad();
    let given = |c: Conditions| {
        [c.v.map(|v| v * beta), c.a.map(|a| a * beta * beta), c.j.map(|j| j * beta * beta * beta)]
    };
    let at_end = |x: f64, s: f64, c: Conditions| {
        let derivatives = given(c)
            .into_iter()
            .enumerate()
            .filter_map(move |(i, value)| Some((derivative_row(i + 1, x), value?)));
        [(derivative_row(0, x), s)].into_iter().chain(derivatives)
    };
    at_end(0.0, 0.0, start).chain(at_end(1.0, segment.change(), end)).collect()
}

/// Factors of the coefficients in the `order`-th derivative at x = 0 or 1.
fn derivative_row(order: usize, x: f64) -> [f64; 8] {
    let mut row = [0.0; 8];
    for (power, entry) in row.iter_mut().enumerate().skip(order) {
        let falling: f64 = (0..order).map(|i| (power - i) as f64).product();
        *entry = if power == order || x == 1.0 { falling } else { 0.0 };
    }
    row
}

/// Gauss elimination with row pivots on the first `n` unknowns.
fn solve(rows: &mut [Condition], n: usize) -> Option<Coefficients> {
    /// The entries are whole numbers up to 210: a pivot this small is rounding of 0.
    const SINGULAR: f64 = 1e-9;
    for column in 0..n {
        let pivot =
            (column..n).max_by(|a, b| rows[*a].0[column].abs().total_cmp(&rows[*b].0[column].abs()))?;
        rows.swap(column, pivot);
        let (factors, value) = rows[column];
        if factors[column].abs() < SINGULAR {
            return None;
        }
        for row in rows.iter_mut().skip(column + 1) {
            let ratio = row.0[column] / factors[column];
            row.0.iter_mut().zip(factors).for_each(|(r, f)| *r -= ratio * f);
            row.1 -= ratio * value;
        }
    }
    let mut c = [0.0; 8];
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| rows[i].0[k] * c[k]).sum();
        c[i] = (rows[i].1 - known) / rows[i].0[i];
    }
    c.iter().all(|v| v.is_finite()).then_some(c)
}
