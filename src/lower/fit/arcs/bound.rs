//! A proven lower bound on the number of arcs (and lines) in the band, tangent-continuous or not, on any grid.
//!
//! Every arc crosses the normals of the curve ("gates", segments as wide as the band) between its ends in order, so
//! the gates are divided into runs of neighbours each of which one circle or line can cross. After the lifting
//! (x, y) → (x, y, x² + y²) that is a linear problem in three unknowns: c₀ + c₁ x + c₂ (x² + y²) - y <= 0 at the
//! left end of a gate and >= 0 at its right end, in the frame of the run's middle gate. Four constraints with
//! positive multipliers that cannot hold together prove that a run is too long. Runs as long as possible are fewest;
//! on a closed curve the best of all starts counts. What cannot be decided counts as possible.

use nalgebra::{Matrix4, Vector4};

use super::stretch::Stretch;
use crate::geom::{Point2, Vec2, left};
use crate::lower::fit::Tube;

/// Samples from one gate to the next.
const STRIDE: usize = 3;
/// Exchanges for one run at most.
const EXCHANGES: usize = 40;
/// A contradiction smaller than this is none, mm.
const CERTAIN: f64 = 1e-9;
/// Most gates; longer curves get no bound.
const MOST_GATES: usize = 200_000;

/// A normal of the curve within the band.
#[derive(Debug, Clone, Copy)]
struct Gate {
    p: Point2,
    n: Vec2,
}

/// Fewest arcs and lines that can follow the curve in the band; `None` when there are too few or too many gates.
pub(super) fn fewest(tube: &Tube<'_>, stretches: &[Stretch<'_>]) -> Option<u32> {
    let mut gates: Vec<Gate> = Vec::new();
    for stretch in stretches {
        let last = stretch.samples.len() - 1;
        for (i, q) in stretch.samples.iter().enumerate() {
            let twice =
                gates.last().is_some_and(|g| (g.p - q.p).norm() < 1e-9 && g.n.dot(&q.n) > 1.0 - 1e-12);
            if !twice && (i % STRIDE == 0 || i == last) {
                gates.push(Gate { p: q.p, n: q.n });
            }
        }
    }
    let closed = tube.curve.is_closed();
    if closed {
        gates.pop();
    }
    if gates.len() < 5 || gates.len() > MOST_GATES {
        return None;
    }
    let runs = runs(tube, &gates, closed);
    u32::try_from(count(&runs, closed)).ok()
}

/// For every gate the first one that a run from it cannot reach, unwrapped.
fn runs(tube: &Tube<'_>, gates: &[Gate], closed: bool) -> Vec<usize> {
    let n = gates.len();
    let mut end = 0;
    let mut out = Vec::with_capacity(n);
    for first in 0..n {
        let most = if closed { first + n } else { n };
        end = end.max(first + 1);
        while end < most && crossable(tube, gates, first, end) {
            end += 1;
        }
        out.push(end);
    }
    out
}

/// Fewest runs that cover all gates.
fn count(runs: &[usize], closed: bool) -> usize {
    let n = runs.len();
    let from = |start: usize| {
        let (mut at, mut count) = (start, 0);
        while at < start + n {
            let laps = at / n * n;
            at = (runs[at % n] + laps).min(start + n);
            count += 1;
        }
        count
    };
    let starts = if closed { runs[0].min(n) } else { 1 };
    (0..starts).map(from).min().unwrap_or(1)
}

/// One constraint: `row`·(c₀, c₁, c₂, t) <= `bound`.
#[derive(Debug, Clone, Copy)]
struct Constraint {
    row: Vector4<f64>,
    bound: f64,
}

/// Whether one circle or line may cross the gates first..=last; `false` is proven.
fn crossable(tube: &Tube<'_>, gates: &[Gate], first: usize, last: usize) -> bool {
    let n = gates.len();
    let count = last - first + 1;
    if count < 4 {
        return true;
    }
    let middle = gates[(first + count / 2) % n];
    let reach = (first..=last).fold(0.0_f64, |m, i| m.max((gates[i % n].p - middle.p).norm()));
    // A circle about a point within the band could cross only gates nearer than this.
    if reach < 4.0 * (tube.left + tube.right) {
        return true;
    }
    let constraints = constraints(tube, gates, (first, last), &middle, reach);
    !contradictory(&constraints, reach)
}

/// Left and right end of every gate in the frame of the middle gate, x in units of `reach`.
fn constraints(
    tube: &Tube<'_>,
    gates: &[Gate],
    (first, last): (usize, usize),
    middle: &Gate,
    reach: f64,
) -> Vec<Constraint> {
    let tangent = -left(middle.n);
    let mut out = Vec::with_capacity(2 * (last - first + 1));
    for i in first..=last {
        let gate = gates[i % gates.len()];
        for (side, offset) in [(1.0, tube.left), (-1.0, -tube.right)] {
            let w = gate.p + gate.n * offset - middle.p;
            let (x, y) = (w.dot(&tangent) / reach, w.dot(&middle.n));
            let square = w.norm_squared() / (reach * reach);
            out.push(Constraint { row: Vector4::new(side, side * x, side * square, -1.0), bound: side * y });
        }
    }
    out
}

/// Whether four constraints prove that t > 0 is needed: dual simplex, from four gates with alternating sides.
fn contradictory(constraints: &[Constraint], reach: f64) -> bool {
    let gates = constraints.len() / 2;
    let mut basis = [0; 4];
    for (i, b) in basis.iter_mut().enumerate() {
        // Near the extremes of the Chebyshev polynomial of the third degree.
        let gate = [0, gates / 4, 3 * gates / 4, gates - 1][i];
        *b = 2 * gate + i % 2;
    }
    if basis[0] == basis[1] || basis[2] == basis[3] {
        return false;
    }
    for _ in 0..EXCHANGES {
        let rows = Matrix4::from_fn(|i, j| constraints[basis[i]].row[j]);
        let Some(inverse) = rows.try_inverse() else { return false };
        let bounds = Vector4::from_fn(|i, _| constraints[basis[i]].bound);
        let solution = inverse * bounds;
        // Multipliers: λᵀ rows = (0, 0, 0, -1).
        let multipliers = -inverse.row(3).transpose();
        if multipliers.iter().any(|l| *l < -1e-12) || !solution.iter().all(|v| v.is_finite()) {
            return false;
        }
        if solution[3] > CERTAIN + 1e-12 * reach {
            return true;
        }
        let (enter, excess) = constraints
            .iter()
            .enumerate()
            .map(|(i, c)| (i, c.row.dot(&solution) - c.bound))
            .fold((0, f64::NEG_INFINITY), |best, now| if now.1 > best.1 { now } else { best });
        if excess <= 1e-13 * reach {
            return false;
        }
        // The entering row as a combination of the basis decides which multiplier reaches zero first.
        let combination = inverse.transpose() * constraints[enter].row;
        let leave = (0..4)
            .filter(|&i| combination[i] > 1e-14)
            .min_by(|&i, &j| (multipliers[i] / combination[i]).total_cmp(&(multipliers[j] / combination[j])));
        let Some(leave) = leave else { return false };
        basis[leave] = enter;
    }
    false
}
