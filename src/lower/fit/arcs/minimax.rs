//! Linear minimax problems with a banded (cyclic) structure, by an interior-point method.
//!
//! min t over (x, t) with |a_r·x + v_r| <= c_r t for the rows of kind `Minimax` and |a_r·x| <= d_r for those of
//! kind `Box`. Mehrotra's predictor-corrector on the normal equations, which are banded because a row touches
//! neighbouring blocks of variables only; a closed chain's first blocks and t form a border. Linear time in the rows.

use nalgebra::{DMatrix, DVector};

/// Variables in a block (one block a joint).
pub(in crate::lower::fit) const BLOCK: usize = 3;
/// Most variables a row touches.
pub(in crate::lower::fit) const WIDTH: usize = 12;
/// Interior-point iterations at most.
const ITERATIONS: usize = 40;

/// One two-sided row: |coefficients · x + value| <= limit + slope · t.
#[derive(Debug, Clone, Copy)]
pub(in crate::lower::fit) struct Row {
    /// First block it touches; block numbers wrap.
    pub block: usize,
    /// Coefficients of the variables of four blocks (three at most in a cyclic problem).
    pub coefficients: [f64; WIDTH],
    /// Value at x = 0.
    pub value: f64,
    /// Constant part of the bound.
    pub limit: f64,
    /// Factor of t in the bound.
    pub slope: f64,
}

/// The problem: rows over `blocks` cyclic blocks.
#[derive(Debug)]
pub(in crate::lower::fit) struct Problem {
    /// Number of blocks of variables.
    pub blocks: usize,
    /// Whether rows wrap from the last block to the first.
    pub cyclic: bool,
    /// Rows.
    pub rows: Vec<Row>,
}

/// Solution of a [`Problem`].
#[derive(Debug, Clone)]
pub(in crate::lower::fit) struct Solution {
    /// Variables.
    pub x: Vec<f64>,
    /// Least bound.
    pub t: f64,
}

/// A row without its leading and trailing zeros.
#[derive(Debug, Clone, Copy)]
struct Compact {
    /// First variable; the last may lie beyond the number of variables and wraps.
    first: usize,
    /// Number of coefficients.
    count: usize,
    coefficients: [f64; WIDTH],
    slope: f64,
}

impl Compact {
    fn new(row: &Row) -> Compact {
        let lead = row.coefficients.iter().position(|c| *c != 0.0).unwrap_or(0);
        let count = WIDTH - lead - row.coefficients[lead..].iter().rev().take_while(|c| **c == 0.0).count();
        let mut coefficients = [0.0; WIDTH];
        coefficients[..count].copy_from_slice(&row.coefficients[lead..lead + count]);
        Compact { first: row.block * BLOCK + lead, count, coefficients, slope: row.slope }
    }

    fn values(&self) -> &[f64] {
        &self.coefficients[..self.count]
    }

    /// a·x, where `x` goes on with its first variables.
    fn product(&self, x: &[f64]) -> f64 {
        self.values().iter().zip(&x[self.first..]).map(|(a, x)| a * x).sum()
    }
}

/// Symmetric positive definite arrow matrix: a band and a dense border (t is its last column).
struct Arrow {
    variables: usize,
    banded: usize,
    border: usize,
    offset: usize,
    /// Entries of a row of the band: the diagonal and what lies before it.
    width: usize,
    band: Vec<f64>,
    side: Vec<f64>,
    corner: DMatrix<f64>,
    schur: Option<nalgebra::Cholesky<f64, nalgebra::Dyn>>,
}

impl Arrow {
    fn new(problem: &Problem, rows: &[Compact]) -> Arrow {
        let variables = problem.blocks * BLOCK;
        // Two blocks cut the cycle: a row reaches from a block to the second after it.
        let offset = match (problem.cyclic, problem.blocks <= 5) {
            (_, true) => variables,
            (true, false) => 2 * BLOCK,
            (false, false) => 0,
        };
        let banded = variables - offset;
        let border = offset + 1;
        let width = rows.iter().fold(1, |m, r| m.max(r.count));
        Arrow {
            variables,
            banded,
            border,
            offset,
            width,
            band: vec![0.0; banded * width],
            side: vec![0.0; banded * border],
            corner: DMatrix::zeros(border, border),
            schur: None,
        }
    }

    fn clear(&mut self) {
        self.band.fill(0.0);
        self.side.fill(0.0);
        self.corner.fill(0.0);
    }

    /// Adds w·row rowᵀ for the row (a, -slope t) with weight `w`, and its mirror (-a, -slope t) with weight `m`.
    fn add(&mut self, row: &Compact, w: f64, m: f64) {
        let (both, cross) = (w + m, (m - w) * row.slope);
        let t = self.border - 1;
        self.corner[(t, t)] += both * row.slope * row.slope;
        if row.first < self.offset || row.first + row.count > self.variables {
            return self.add_to_border(row, both, cross);
        }
        let first = row.first - self.offset;
        for (i, a) in row.values().iter().enumerate() {
            self.side[(first + i) * self.border + t] += cross * a;
            let weighted = both * a;
            let line = &mut self.band[(first + i) * self.width..];
            for (j, b) in row.coefficients[..=i].iter().enumerate() {
                line[i - j] += weighted * b;
            }
        }
    }

    /// The general case of [`Arrow::add`]: the row touches the border's variables.
    fn add_to_border(&mut self, row: &Compact, both: f64, cross: f64) {
        for (i, &a) in row.values().iter().enumerate() {
            let vi = (row.first + i) % self.variables;
            self.put(vi, self.variables, cross * a);
            for (j, &b) in row.values().iter().enumerate().skip(i) {
                let vj = (row.first + j) % self.variables;
                self.put(vi, vj, both * a * b);
                if vi == vj && i != j {
                    self.put(vi, vj, both * a * b);
                }
            }
        }
    }

    /// Adds to the entry of variables i and j; `variables` stands for t.
    fn put(&mut self, i: usize, j: usize, value: f64) {
        let (i, j) = if i <= j { (i, j) } else { (j, i) };
        match (i.checked_sub(self.offset), j.checked_sub(self.offset)) {
            (Some(i), Some(j)) if j < self.banded => {
                // Rows of the band store column j, entries j - i below the diagonal.
                self.band[j * self.width + j - i] += value;
            }
            (Some(i), Some(_)) => self.side[i * self.border + self.border - 1] += value,
            (None, Some(j)) if j < self.banded => self.side[j * self.border + i] += value,
            (None, Some(_)) => {
                let t = self.border - 1;
                self.corner[(t, i)] += value;
                self.corner[(i, t)] += value;
            }
            (_, None) => {
                self.corner[(j, i)] += value;
                if i != j {
                    self.corner[(i, j)] += value;
                }
            }
        }
    }

    /// Factors in place; `false` when not positive definite.
    fn factor(&mut self) -> bool {
        let w = self.width;
        let floor = 1e-13 * self.band.iter().step_by(w).fold(0.0_f64, |m, b| m.max(*b));
        for j in 0..self.banded {
            let reach = (w - 1).min(j);
            for d in (0..=reach).rev() {
                // Entry (j, i) with i = j - d: minus the sum over k of the entries (j, k) and (i, k).
                let i = j - d;
                let (above, line) = self.band.split_at_mut(j * w);
                let terms = reach.min(d + (w - 1).min(i)) - d;
                let mut sum = line[d];
                if d == 0 {
                    sum -= line[1..=terms].iter().map(|x| x * x).sum::<f64>();
                    if sum.is_nan() {
                        return false;
                    }
                    line[0] = (if sum > floor { sum } else { floor + sum.abs() + 1e-300 }).sqrt();
                } else {
                    let other = &above[i * w..(i + 1) * w];
                    let pairs = line[d + 1..=d + terms].iter().zip(&other[1..=terms]);
                    sum -= pairs.map(|(a, b)| a * b).sum::<f64>();
                    line[d] = sum / other[0];
                }
            }
        }
        self.factor_border()
    }

    /// The border's part: Schur complement.
    fn factor_border(&mut self) -> bool {
        let w = self.width;
        let b = self.border;
        for i in 0..self.banded {
            let (done, rest) = self.side.split_at_mut(i * b);
            let line = &self.band[i * w..(i + 1) * w];
            for d in 1..=(w - 1).min(i) {
                let from = &done[(i - d) * b..(i - d + 1) * b];
                for (x, y) in rest[..b].iter_mut().zip(from) {
                    *x -= line[d] * y;
                }
            }
            let scale = 1.0 / line[0];
            rest[..b].iter_mut().for_each(|x| *x *= scale);
        }
        let mut schur = self.corner.clone();
        for row in self.side.chunks_exact(b) {
            for c in 0..b {
                for d in 0..=c {
                    schur[(c, d)] -= row[c] * row[d];
                }
            }
        }
        let largest = (0..b).fold(0.0_f64, |m, c| m.max(self.corner[(c, c)]));
        for c in 0..b {
            schur[(c, c)] += 1e-14 * largest + 1e-300;
            for d in 0..c {
                schur[(d, c)] = schur[(c, d)];
            }
        }
        self.schur = nalgebra::Cholesky::new(schur);
        self.schur.is_some()
    }

    /// Solves for a right-hand side over (variables, t).
    fn solve(&self, rhs: &[f64]) -> Option<Vec<f64>> {
        let (b, w) = (self.border, self.width);
        let mut y: Vec<f64> = rhs[self.offset..self.variables].to_vec();
        let mut z = DVector::from_fn(b, |c, _| if c + 1 == b { rhs[self.variables] } else { rhs[c] });
        for i in 0..self.banded {
            let line = &self.band[i * w..(i + 1) * w];
            let reach = (w - 1).min(i);
            let sum: f64 = line[1..=reach].iter().zip(y[i - reach..i].iter().rev()).map(|(a, b)| a * b).sum();
            y[i] = (y[i] - sum) / line[0];
            for (z, side) in z.iter_mut().zip(&self.side[i * b..(i + 1) * b]) {
                *z -= side * y[i];
            }
        }
        let z = self.schur.as_ref()?.solve(&z);
        for i in (0..self.banded).rev() {
            let line = &self.band[i * w..(i + 1) * w];
            let border: f64 = self.side[i * b..(i + 1) * b].iter().zip(z.iter()).map(|(a, b)| a * b).sum();
            y[i] = (y[i] - border) / line[0];
            // What later rows will still subtract is taken off now.
            let (before, here) = y.split_at_mut(i);
            for (d, v) in before.iter_mut().rev().take(w - 1).enumerate() {
                *v -= line[d + 1] * here[0];
            }
        }
        let mut x = Vec::with_capacity(self.variables + 1);
        x.extend((0..self.offset).map(|c| z[c]));
        x.extend(y);
        x.push(z[b - 1]);
        Some(x)
    }
}

/// Slack and multiplier of the two sides of a row.
#[derive(Debug, Clone, Copy, Default)]
struct Side {
    s: f64,
    z: f64,
    /// Right-hand side of the complementarity equation.
    r: f64,
    ds: f64,
    dz: f64,
}

struct Interior<'a> {
    problem: &'a Problem,
    rows: Vec<Compact>,
    sides: Vec<[Side; 2]>,
    x: Vec<f64>,
}

impl Problem {
    fn variables(&self) -> usize {
        self.blocks * BLOCK
    }

    /// The rows without their zeros; `None` when one of them is not finite.
    fn compact(&self) -> Option<Vec<Compact>> {
        let finite =
            |r: &Row| r.value.is_finite() && r.coefficients.iter().map(|c| c * 0.0).sum::<f64>() == 0.0;
        self.rows.iter().all(finite).then(|| self.rows.iter().map(Compact::new).collect())
    }

    /// Damped least squares: the x that makes the rows' values small, `damping` relative to the largest squared
    /// coefficient; with little damping the x of least norm for which they become zero.
    pub fn least_change(&self, damping: f64) -> Option<Vec<f64>> {
        let rows = self.compact()?;
        let mut matrix = Arrow::new(self, &rows);
        let mut rhs = vec![0.0; self.variables() + 1];
        let mut largest = 0.0_f64;
        for (row, full) in rows.iter().zip(&self.rows) {
            matrix.add(row, 1.0, 0.0);
            for (i, &a) in row.values().iter().enumerate() {
                rhs[(row.first + i) % self.variables()] -= a * full.value;
                largest = largest.max(a * a);
            }
        }
        for v in 0..self.variables() {
            matrix.put(v, v, damping * largest + 1e-300);
        }
        if !matrix.factor() {
            return None;
        }
        let mut x = matrix.solve(&rhs)?;
        x.pop();
        Some(x)
    }

    /// Least t within a relative `accuracy`; `None` when the arithmetic breaks down.
    pub fn solve(&self, accuracy: f64) -> Option<Solution> {
        let worst = self
            .rows
            .iter()
            .filter(|r| r.slope > 0.0)
            .fold(0.0_f64, |m, r| m.max((r.value.abs() - r.limit) / r.slope));
        let mut x = vec![0.0; self.variables() + 1];
        x[self.variables()] = 1.1 * worst + 1e-12;
        let rows = self.compact()?;
        let mut matrix = Arrow::new(self, &rows);
        let mut state =
            Interior { problem: self, rows, sides: vec![[Side::default(); 2]; self.rows.len()], x };
        state.start();
        for _ in 0..ITERATIONS {
            if state.step(&mut matrix, accuracy)? {
                break;
            }
        }
        let t = state.x.pop()?;
        Some(Solution { x: state.x, t })
    }
}

impl Interior<'_> {
    fn start(&mut self) {
        let t = self.x[self.problem.variables()];
        let mut weight = 0.0;
        for (row, sides) in self.problem.rows.iter().zip(&mut self.sides) {
            let bound = row.limit + row.slope * t;
            sides[0].s = (bound - row.value).max(1e-9 * bound);
            sides[1].s = (bound + row.value).max(1e-9 * bound);
            weight += row.slope / sides[0].s + row.slope / sides[1].s;
        }
        let mu = 1.0 / weight.max(1e-300);
        for side in self.sides.iter_mut().flatten() {
            side.z = mu / side.s;
        }
    }

    /// Accumulates Gᵀq for q given per side.
    fn transpose(&self, q: impl Fn(&Side) -> f64) -> Vec<f64> {
        let n = self.problem.variables();
        let mut out = vec![0.0; n + WIDTH];
        let mut t = 0.0;
        for (row, sides) in self.rows.iter().zip(&self.sides) {
            let (a, b) = (q(&sides[0]), q(&sides[1]));
            t -= row.slope * (a + b);
            for (x, c) in out[row.first..].iter_mut().zip(row.values()) {
                *x += c * (a - b);
            }
        }
        for i in n..n + WIDTH {
            out[i % n] += out[i];
            out[i] = 0.0;
        }
        out.truncate(n);
        out.push(t);
        out
    }

    /// Newton direction for the complementarity right-hand sides `r`; fills ds and dz.
    fn direction(&mut self, matrix: &Arrow, dual: &[f64]) -> Option<Vec<f64>> {
        let g = self.transpose(|q| q.r / q.s);
        let rhs: Vec<f64> = dual.iter().zip(&g).map(|(d, g)| -d - g).collect();
        let dx = matrix.solve(&rhs)?;
        let n = self.problem.variables();
        let dt = dx[n];
        let wrapped: Vec<f64> = (0..n + WIDTH).map(|i| dx[i % n]).collect();
        for (row, sides) in self.rows.iter().zip(&mut self.sides) {
            let a = row.product(&wrapped);
            sides[0].ds = row.slope * dt - a;
            sides[1].ds = row.slope * dt + a;
            for q in sides {
                q.dz = (q.r - q.z * q.ds) / q.s;
            }
        }
        Some(dx)
    }

    /// Largest steps that keep slacks and multipliers positive.
    fn lengths(&self) -> (f64, f64) {
        self.sides.iter().flatten().fold((1.0_f64, 1.0_f64), |(p, d), q| {
            (if q.ds < 0.0 { p.min(-q.s / q.ds) } else { p }, if q.dz < 0.0 { d.min(-q.z / q.dz) } else { d })
        })
    }

    /// One predictor-corrector step; `true` when the gap is small.
    fn step(&mut self, matrix: &mut Arrow, accuracy: f64) -> Option<bool> {
        let count = 2.0 * self.sides.len() as f64;
        let mu = self.sides.iter().flatten().map(|q| q.s * q.z).sum::<f64>() / count;
        let n = self.problem.variables();
        let mut dual = self.transpose(|q| q.z);
        dual[n] += 1.0;
        let residual = dual.iter().fold(0.0_f64, |m, d| m.max(d.abs()));
        if mu * count <= accuracy * self.x[n].abs() && residual < 1e-6 {
            return Some(true);
        }
        matrix.clear();
        for (row, q) in self.rows.iter().zip(&self.sides) {
            matrix.add(row, q[0].z / q[0].s, q[1].z / q[1].s);
        }
        if !matrix.factor() {
            return None;
        }
        self.sides.iter_mut().flatten().for_each(|q| q.r = -q.s * q.z);
        self.direction(matrix, &dual)?;
        let (p, d) = self.lengths();
        let affine =
            self.sides.iter().flatten().map(|q| (q.s + p * q.ds) * (q.z + d * q.dz)).sum::<f64>() / count;
        let ratio = affine / mu;
        let centre = ratio * ratio * ratio * mu;
        self.sides.iter_mut().flatten().for_each(|q| q.r = centre - q.s * q.z - q.ds * q.dz);
        let dx = self.direction(matrix, &dual)?;
        let (p, d) = self.lengths();
        let (p, d) = ((0.995 * p).min(1.0), (0.995 * d).min(1.0));
        for (x, dx) in self.x.iter_mut().zip(&dx) {
            *x += p * dx;
        }
        for q in self.sides.iter_mut().flatten() {
            q.s += p * q.ds;
            q.z += d * q.dz;
        }
        Some(p < 1e-10 && d < 1e-10)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math;

    /// Best approximation of x⁴ on a grid of [-1, 1] by cubic polynomials in the monomials up to x² (three unknowns)
    /// has the error 1/8 of the Chebyshev polynomial T₄ / 8.
    #[test]
    fn chebyshev_error_is_found() {
        let rows = (0..=200)
            .map(|i| {
                let x = math::cos(f64::from(i) * math::PI / 200.0);
                let mut coefficients = [0.0; WIDTH];
                coefficients[..3].copy_from_slice(&[1.0, x, x * x]);
                Row { block: 0, coefficients, value: x * x * x * x, limit: 0.0, slope: 1.0 }
            })
            .collect();
        let solution = Problem { blocks: 1, cyclic: false, rows }.solve(1e-9).unwrap();
        assert!((solution.t - 0.125).abs() < 1e-6, "{}", solution.t);
    }

    /// A cyclic chain gives the same as the dense arithmetic of a chain that is all border.
    #[test]
    fn cyclic_problems_are_solved() {
        let blocks = 9;
        let mut seed = 1_u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1 << 23) - 1.0
        };
        let rows: Vec<Row> = (0..blocks * 8)
            .map(|i| {
                let mut coefficients = [0.0; WIDTH];
                coefficients.iter_mut().take(8).for_each(|c| *c = random());
                let value = random();
                Row { block: i % blocks, coefficients, value, limit: 0.0, slope: 1.0 }
            })
            .collect();
        let solution = Problem { blocks, cyclic: true, rows: rows.clone() }.solve(1e-9).unwrap();
        let worst = rows.iter().fold(0.0_f64, |m, r| {
            let a: f64 = (0..8)
                .map(|j| r.coefficients[j] * solution.x[(r.block * BLOCK + j) % (blocks * BLOCK)])
                .sum();
            m.max((a + r.value).abs())
        });
        assert!((worst - solution.t).abs() < 1e-7, "{worst} {}", solution.t);
        // Optimal: as many active rows as unknowns, and no direction that lowers all of them.
        let active = rows.iter().filter(|r| {
            let a: f64 = (0..8)
                .map(|j| r.coefficients[j] * solution.x[(r.block * BLOCK + j) % (blocks * BLOCK)])
                .sum();
            (a + r.value).abs() > solution.t - 1e-6
        });
        let count = active.count();
        assert!(count >= blocks * BLOCK, "{count} of {} t {}", rows.len(), solution.t);
    }
}
