//! The linear systems of cubic splines.

/// What holds at the ends of a cubic spline of one variable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum End {
    /// Value, slope and second derivative are the same at both ends.
    Periodic,
    /// Second derivative 0.
    Natural,
    /// Slopes at the start and at the end; without one, the second derivative there is 0.
    Clamped(Option<f64>, Option<f64>),
}

/// Slopes at the nodes of the C2 cubic spline through `values` at the ascending `nodes` (at least two, three
/// for a periodic one, whose last value must equal its first).
///
/// The unknown slopes m satisfy, between spans of lengths g (before) and h (after) and rises r and q,
/// m₋/g + 2 m (1/g + 1/h) + m₊/h = 3 (r/g + q/h).
pub(crate) fn slopes(nodes: &[f64], values: &[f64], end: End) -> Vec<f64> {
    let n = nodes.len();
    let inverse: Vec<f64> = nodes.windows(2).map(|w| 1.0 / (w[1] - w[0])).collect();
    let rise: Vec<f64> = (0..n - 1).map(|i| (values[i + 1] - values[i]) * inverse[i]).collect();
    let inner = |i: usize| {
        (
            inverse[i - 1],
            2.0 * (inverse[i - 1] + inverse[i]),
            inverse[i],
            3.0 * (rise[i - 1] * inverse[i - 1] + rise[i] * inverse[i]),
        )
    };
    match end {
        End::Clamped(a, b) => {
            let free = |rise: f64| (1.0, 2.0, 1.0, 3.0 * rise);
            let first = a.map_or(free(rise[0]), |a| (0.0, 1.0, 0.0, a));
            let last = b.map_or(free(rise[n - 2]), |b| (0.0, 1.0, 0.0, b));
            let rows: Vec<_> = [first].into_iter().chain((1..n - 1).map(inner)).chain([last]).collect();
            thomas(&rows)
        }
        End::Natural => slopes(nodes, values, End::Clamped(None, None)),
        End::Periodic => periodic(&inverse, &rise, inner),
    }
}

/// (below, diagonal, above, right-hand side) of one row.
type Row = (f64, f64, f64, f64);

/// Cyclic system by Sherman & Morrison: two tridiagonal solutions.
fn periodic(inverse: &[f64], rise: &[f64], inner: impl Fn(usize) -> Row) -> Vec<f64> {
    let n = inverse.len();
    let wrap = inverse[n - 1];
    let mut rows: Vec<Row> =
        vec![(0.0, 2.0 * (wrap + inverse[0]), inverse[0], 3.0 * (rise[n - 1] * wrap + rise[0] * inverse[0]))];
    rows.extend((1..n).map(inner));
    // The cyclic matrix is the tridiagonal one plus (γ, 0, …, w)ᵀ (1, 0, …, w/γ).
    let gamma = -rows[0].1;
    rows[0].1 -= gamma;
    rows[n - 1].1 -= wrap * wrap / gamma;
    rows[n - 1].2 = 0.0;
    let y = thomas(&rows);
    for (i, row) in rows.iter_mut().enumerate() {
        row.3 = if i == 0 {
            gamma
        } else if i == n - 1 {
            wrap
        } else {
            0.0
        };
    }
    let z = thomas(&rows);
    let factor = (y[0] + wrap / gamma * y[n - 1]) / (1.0 + z[0] + wrap / gamma * z[n - 1]);
    let mut m: Vec<f64> = y.iter().zip(&z).map(|(y, z)| y - factor * z).collect();
    m.push(m[0]);
    m
}

/// Tridiagonal elimination; the systems here are diagonally dominant.
fn thomas(rows: &[Row]) -> Vec<f64> {
    let mut above = Vec::with_capacity(rows.len());
    let mut right: Vec<f64> = Vec::with_capacity(rows.len());
    for (i, &(below, diagonal, next, rhs)) in rows.iter().enumerate() {
        let (previous_above, previous_right) = if i == 0 { (0.0, 0.0) } else { (above[i - 1], right[i - 1]) };
        let pivot = diagonal - below * previous_above;
        above.push(next / pivot);
        right.push((rhs - below * previous_right) / pivot);
    }
    for i in (0..rows.len().saturating_sub(1)).rev() {
        right[i] -= above[i] * right[i + 1];
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clamped_spline_reproduces_a_cubic() {
        let nodes = [0.0, 0.5, 1.7, 2.0, 3.1];
        let cubic = |x: f64| 1.0 + x * (2.0 + x * (-3.0 + 0.5 * x));
        let slope = |x: f64| 2.0 + x * (-6.0 + 1.5 * x);
        let values: Vec<f64> = nodes.iter().map(|x| cubic(*x)).collect();
        for (m, x) in
            slopes(&nodes, &values, End::Clamped(Some(slope(0.0)), Some(slope(3.1)))).iter().zip(nodes)
        {
            assert!((m - slope(x)).abs() < 1e-12);
        }
    }

    #[test]
    fn a_periodic_spline_satisfies_every_row_of_its_system() {
        let nodes = [0.0, 1.0, 1.5, 3.0, 4.0];
        let values = [1.0, 3.0, -2.0, 0.5, 1.0];
        let m = slopes(&nodes, &values, End::Periodic);
        for i in 0..4 {
            let before = if i == 0 { 3 } else { i - 1 };
            let (g, h) = (nodes[before + 1] - nodes[before], nodes[i + 1] - nodes[i]);
            let (r, q) = ((values[before + 1] - values[before]) / g, (values[i + 1] - values[i]) / h);
            let residual =
                m[before] / g + 2.0 * m[i] * (1.0 / g + 1.0 / h) + m[i + 1] / h - 3.0 * (r / g + q / h);
            assert!(residual.abs() < 1e-12, "row {i}: {residual}");
        }
    }
}
