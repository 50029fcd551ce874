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
/// Half bandwidth of the normal equations.
const BAND: usize = WIDTH - 1;
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

/// Symmetric positive definite arrow matrix: a band and a dense border (t is its last column).
struct Arrow {
    variables: usize,
    banded: usize,
    border: usize,
    offset: usize,
    band: Vec<[f64; BAND + 1]>,
    side: Vec<f64>,
    corner: DMatrix<f64>,
    schur: Option<nalgebra::Cholesky<f64, nalgebra::Dyn>>,
}

impl Arrow {
    fn new(problem: &Problem) -> Arrow {
        let variables = problem.blocks * BLOCK;
        // Two blocks cut the cycle: a row reaches from a block to the second after it.
        let offset = match (problem.cyclic, problem.blocks <= 5) {
            (_, true) => variables,
            (true, false) => 2 * BLOCK,
            (false, false) => 0,
        };
        let banded = variables - offset;
        let border = offset + 1;
        Arrow {
            variables,
            banded,
            border,
            offset,
            band: vec![[0.0; BAND + 1]; banded],
            side: vec![0.0; banded * border],
            corner: DMatrix::zeros(border, border),
            schur: None,
        }
    }

    fn clear(&mut self) {
        self.band.iter_mut().for_each(|b| *b = [0.0; BAND + 1]);
        self.side.iter_mut().for_each(|b| *b = 0.0);
        self.corner.fill(0.0);
    }

    /// Adds w·row rowᵀ for the row (a, -slope t) with weight `w`, and its mirror (-a, -slope t) with weight `m`.
    fn add(&mut self, row: &Row, w: f64, m: f64) {
        let (both, cross) = (w + m, (m - w) * row.slope);
        let t = self.border - 1;
        self.corner[(t, t)] += both * row.slope * row.slope;
        for (i, &a) in row.coefficients.iter().enumerate() {
            if a == 0.0 {
                continue;
            }
            let vi = (row.block * BLOCK + i) % self.variables;
            self.put(vi, self.variables, cross * a);
            for (j, &b) in row.coefficients.iter().enumerate().skip(i) {
                if b != 0.0 {
                    let vj = (row.block * BLOCK + j) % self.variables;
                    self.put(vi, vj, both * a * b);
                    if vi == vj && i != j {
                        self.put(vi, vj, both * a * b);
                    }
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
                self.band[j][j - i] += value;
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
        let floor = 1e-13 * self.band.iter().fold(0.0_f64, |m, b| m.max(b[0]));
        for j in 0..self.banded {
            for d in (0..=BAND.min(j)).rev() {
                // Entry (j, i) with i = j - d.
                let i = j - d;
                let mut sum = self.band[j][d];
                for e in (d + 1)..=BAND.min(j) {
                    let k = j - e;
                    if i - k <= BAND {
                        sum -= self.band[j][e] * self.band[i][i - k];
                    }
                }
                if d == 0 {
                    if sum.is_nan() {
                        return false;
                    }
                    self.band[j][0] = (if sum > floor { sum } else { floor + sum.abs() + 1e-300 }).sqrt();
                } else {
                    self.band[j][d] = sum / self.band[i][0];
                }
            }
        }
        let b = self.border;
        for c in 0..b {
            for i in 0..self.banded {
                let mut sum = self.side[i * b + c];
                for d in 1..=BAND.min(i) {
                    sum -= self.band[i][d] * self.side[(i - d) * b + c];
                }
                self.side[i * b + c] = sum / self.band[i][0];
            }
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
        let b = self.border;
        let mut y: Vec<f64> = rhs[self.offset..self.variables].to_vec();
        for i in 0..self.banded {
            let mut sum = y[i];
            for d in 1..=BAND.min(i) {
                sum -= self.band[i][d] * y[i - d];
            }
            y[i] = sum / self.band[i][0];
        }
        let mut z = DVector::zeros(b);
        for c in 0..b {
            let r = if c + 1 == b { rhs[self.variables] } else { rhs[c] };
            z[c] = r - (0..self.banded).map(|i| self.side[i * b + c] * y[i]).sum::<f64>();
        }
        let z = self.schur.as_ref()?.solve(&z);
        for (i, v) in y.iter_mut().enumerate() {
            *v -= (0..b).map(|c| self.side[i * b + c] * z[c]).sum::<f64>();
        }
        for i in (0..self.banded).rev() {
            y[i] /= self.band[i][0];
            for d in 1..=BAND.min(i) {
                y[i - d] -= self.band[i][d] * y[i];
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
    sides: Vec<[Side; 2]>,
    x: Vec<f64>,
}

impl Problem {
    fn variables(&self) -> usize {
        self.blocks * BLOCK
    }

    fn product(&self, row: &Row, x: &[f64]) -> f64 {
        let n = self.variables();
        let first = row.block * BLOCK;
        let mut sum = 0.0;
        for (i, &a) in row.coefficients.iter().enumerate() {
            if a != 0.0 {
                sum += a * x[(first + i) % n];
            }
        }
        sum
    }

    /// Damped least squares: the x that makes the rows' values small, `damping` relative to the largest squared
    /// coefficient; with little damping the x of least norm for which they become zero.
    pub fn least_change(&self, damping: f64) -> Option<Vec<f64>> {
        let mut matrix = Arrow::new(self);
        let mut rhs = vec![0.0; self.variables() + 1];
        let mut largest = 0.0_f64;
        for row in &self.rows {
            matrix.add(row, 1.0, 0.0);
            for (i, &a) in row.coefficients.iter().enumerate() {
                rhs[(row.block * BLOCK + i) % self.variables()] -= a * row.value;
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
        let mut state = Interior { problem: self, sides: vec![[Side::default(); 2]; self.rows.len()], x };
        state.start();
        let mut matrix = Arrow::new(self);
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
        let mut out = vec![0.0; n + 1];
        for (row, sides) in self.problem.rows.iter().zip(&self.sides) {
            let (a, b) = (q(&sides[0]), q(&sides[1]));
            out[n] -= row.slope * (a + b);
            let first = row.block * BLOCK;
            for (i, &c) in row.coefficients.iter().enumerate() {
                if c != 0.0 {
                    out[(first + i) % n] += c * (a - b);
                }
            }
        }
        out
    }

    /// Newton direction for the complementarity right-hand sides `r`; fills ds and dz.
    fn direction(&mut self, matrix: &Arrow, dual: &[f64]) -> Option<Vec<f64>> {
        let g = self.transpose(|q| q.r / q.s);
        let rhs: Vec<f64> = dual.iter().zip(&g).map(|(d, g)| -d - g).collect();
        let dx = matrix.solve(&rhs)?;
        let dt = dx[self.problem.variables()];
        for (row, sides) in self.problem.rows.iter().zip(&mut self.sides) {
            let a = self.problem.product(row, &dx);
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
        for (row, q) in self.problem.rows.iter().zip(&self.sides) {
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
