//! Cubic B-splines in a band, with few control points on the grid.
//!
//! Only the deviation across the curve counts, the spline's parameter is free; so the control points are moved by
//! Gauss-Newton steps (least squares, then linear minimax) on (X(t) - C(s))·n(s) at the feet s of fixed spline
//! parameters t. Knots lie at equal shares of a density that is corrected by the deviation found in every interval.

mod certify;
mod knots;
mod pieces;
mod spline;
#[cfg(test)]
mod tests;

use certify::{extremes, stations};
pub use knots::Knots;
use spline::{ORDER, Spline, basis, clamped, interval};

use super::arcs::minimax::{BLOCK, Problem, Row, WIDTH};
use super::arcs::start::Density;
use super::arcs::stretch::{Stretch, stretches};
use super::guard::guarded;
use super::{Fit, FitError, Grid, Primitive, Tube};
use crate::geom::{Point2, left};
use crate::math;

/// Rows per knot interval.
const ROWS: u32 = 8;
/// Rounds that correct the density of knots.
const ROUNDS: usize = 4;
/// Gauss-Newton steps of a round.
const STEPS: usize = 3;
/// Minimax steps.
const MINIMAX_STEPS: usize = 10;
/// Damping of Gauss-Newton steps, relative.
const DAMPING: f64 = 1e-6;
/// Turning of one knot interval in the first density, radians.
const TURN: f64 = 1.2;
/// Splines that the grid may spoil before it is blamed.
const REFUSALS: u32 = 6;
/// More points than this factor of the first guess …
const GROWTH: usize = 2;
/// … and these are no use.
const SPARE: usize = 24;
/// A first guess that exceeds the number allowed by this factor is no use either.
const HOPELESS: f64 = 1.5;
/// Widest band that an error asks for, mm.
const MOST_NEEDED: f64 = 1e6;
/// Most control points of one curve.
const MOST_POINTS: usize = 100_000;

/// Fits cubic B-splines, one for every stretch between corners, with few control points.
///
/// `start` is the preferred start parameter of a closed curve without corners.
///
/// # Errors
/// [`FitError::BandTooNarrow`] when no spline on the grid keeps the band, [`FitError::BadCurve`] for cusps.
pub fn nurbs(tube: &Tube<'_>, grid: &Grid, knots: Knots, start: Option<f64>) -> Result<Fit, FitError> {
    let guarded = guarded(tube, grid)?;
    splines(&guarded.tube, grid, knots, start, usize::MAX).map(|fit| guarded.answer(fit))
}

/// The same with at most `most` control points in all (pieces, where the control takes those); `None` when that many were
/// not enough.
///
/// # Errors
/// Those of [`nurbs`] that do not depend on the number of points.
pub fn nurbs_of(
    tube: &Tube<'_>,
    grid: &Grid,
    knots: Knots,
    start: Option<f64>,
    most: usize,
) -> Result<Option<Fit>, FitError> {
    let guarded = guarded(tube, grid)?;
    match splines(&guarded.tube, grid, knots, start, most) {
        Ok(fit) => Ok(Some(guarded.answer(fit))),
        Err(FitError::BandTooNarrow { .. }) => Ok(None),
        Err(error) => Err(error),
    }
}

fn splines(
    tube: &Tube<'_>,
    grid: &Grid,
    knots: Knots,
    start: Option<f64>,
    most: usize,
) -> Result<Fit, FitError> {
    let half = 0.5 * (tube.left + tube.right);
    let origin = tube.curve.at(tube.curve.domain().0).p;
    if half.is_nan() || half < 0.25 * grid.step {
        return Err(FitError::BandTooNarrow { needed: grid.step, have: 2.0 * half, at: origin });
    }
    let list = stretches(tube.curve, half)?;
    let vertices = super::arcs::vertices(tube, grid, &list)?;
    let mut fit = Fit { start: [0, 0], primitives: Vec::new(), lower_bound: None, deviation: (0.0, 0.0) };
    let mut left = most;
    for (i, stretch) in list.iter().enumerate() {
        // Every stretch that follows takes one knot interval at least.
        let points = left.saturating_sub((1 + knots.more_blocks()) * (list.len() - 1 - i));
        let from = if stretch.closed { station_of(stretch, start) } else { 0.0 };
        let ends = if stretch.closed {
            let q = super::arcs::vertex_at(tube, grid, stretch, from)?;
            [q, q]
        } else {
            [vertices[i], vertices[(i + 1) % vertices.len()]]
        };
        let fitter = Fitter { tube, grid, stretch, from, ends, knots, most: points };
        let (points, primitive, deviation) = fitter.fit()?;
        left -= points;
        if i == 0 {
            fit.start = ends[0];
        }
        fit.primitives.push(primitive);
        fit.deviation = (fit.deviation.0.max(deviation.0), fit.deviation.1.max(deviation.1));
    }
    Ok(fit)
}

/// Station of a curve parameter on a closed stretch.
fn station_of(stretch: &Stretch<'_>, start: Option<f64>) -> f64 {
    let Some(u) = start else { return 0.0 };
    let samples = &stretch.samples;
    let j = samples.partition_point(|q| q.u <= u).clamp(1, samples.len() - 1);
    let (a, b) = (&samples[j - 1], &samples[j]);
    let f = if b.u > a.u { ((u - a.u) / (b.u - a.u)).clamp(0.0, 1.0) } else { 0.0 };
    a.s + f * (b.s - a.s)
}

struct Fitter<'a> {
    tube: &'a Tube<'a>,
    grid: &'a Grid,
    stretch: &'a Stretch<'a>,
    /// Station where the spline starts, mm.
    from: f64,
    /// First and last control point.
    ends: [[i64; 2]; 2],
    knots: Knots,
    /// Most control points, or pieces.
    most: usize,
}

/// Cumulative share of knots as a function of the station from the start of the spline, piecewise linear.
#[derive(Debug, Clone)]
struct Shares {
    stations: Vec<f64>,
    sums: Vec<f64>,
}

impl Shares {
    /// Station at share x of the total.
    fn station(&self, x: f64) -> f64 {
        let want = x * self.sums[self.sums.len() - 1];
        let j = self.sums.partition_point(|v| *v <= want).clamp(1, self.sums.len() - 1);
        let (a, b) = (self.sums[j - 1], self.sums[j]);
        let f = if b > a { ((want - a) / (b - a)).min(1.0) } else { 0.0 };
        self.stations[j - 1] + f * (self.stations[j] - self.stations[j - 1])
    }

    /// The density multiplied by `factors` of `n` equal shares.
    fn scaled(&self, factors: &[f64]) -> Shares {
        let n = factors.len();
        let total = self.sums[self.sums.len() - 1];
        let mut stations = vec![self.stations[0]];
        let mut sums = vec![0.0];
        let pieces = 8 * n;
        for j in 1..=pieces {
            let x = j as f64 / pieces as f64;
            let middle = (j as f64 - 0.5) / pieces as f64 * n as f64;
            stations.push(self.station(x));
            sums.push(sums[j - 1] + smooth(factors, middle) * total / pieces as f64);
        }
        Shares { stations, sums }
    }
}

/// Linear interpolation of values given at the middles of unit intervals.
fn smooth(values: &[f64], x: f64) -> f64 {
    let y = (x - 0.5).clamp(0.0, values.len() as f64 - 1.0);
    let i = (y as usize).min(values.len().saturating_sub(2));
    let f = y - i as f64;
    values[i] * (1.0 - f) + values[(i + 1).min(values.len() - 1)] * f
}

impl Fitter<'_> {
    fn middle(&self) -> f64 {
        0.5 * (self.tube.left - self.tube.right)
    }

    fn half(&self) -> f64 {
        0.5 * (self.tube.left + self.tube.right)
    }

    /// Number of control points (or pieces), the curve and its deviation.
    fn fit(&self) -> Result<(usize, Primitive, (f64, f64)), FitError> {
        let shares = self.first_shares();
        // What rounding of the control points may take: half a step in each coordinate.
        let limit = (self.half() - 0.71 * self.grid.step).max(0.4 * self.half());
        let guess = self.count(&shares, limit);
        let most =
            (GROWTH * guess + SPARE).min(MOST_POINTS).min(self.most.saturating_sub(self.knots.more_blocks()));
        let mut n = if guess as f64 > HOPELESS * most as f64 { most + 1 } else { guess.min(most) };
        let mut best = None;
        let (mut needed, mut refused) = (f64::INFINITY, 0);
        while n <= most && refused < REFUSALS {
            match self.attempt(&shares, n, limit) {
                Ok(found) => {
                    best = Some(found);
                    break;
                }
                Err(worst) => {
                    // kept the band before rounding: more points would not help the grid
                    refused += u32::from(worst <= self.half());
                    needed = needed.min(worst);
                    n += 1 + n / 40;
                }
            }
        }
        while n > 1 && best.is_some() {
            match self.attempt(&shares, n - 1, limit) {
                Ok(found) => {
                    best = Some(found);
                    n -= 1;
                }
                Err(_) => break,
            }
        }
        let best = best.map(|(primitive, deviation)| (n + self.knots.more_blocks(), primitive, deviation));
        best.ok_or(FitError::BandTooNarrow {
            needed: (2.0 * needed).clamp(2.0 * self.half() + self.grid.step, MOST_NEEDED),
            have: 2.0 * self.half(),
            at: self.stretch.at(self.from).p,
        })
    }

    /// First density of knots: that of arcs, and a share for the turning.
    fn first_shares(&self) -> Shares {
        let stretch = self.stretch;
        let window = stretch.length() / 40.0;
        let density = Density::new(stretch, window);
        let unit = math::cbrt(2000.0 * self.half());
        let pieces = 400;
        let mut stations = vec![0.0];
        let mut sums = vec![0.0];
        let mut last = stretch.at(self.from);
        for j in 1..=pieces {
            let s = stretch.length() * f64::from(j) / f64::from(pieces);
            let f = stretch.at(self.from + s);
            let turn = super::arcs::stretch::turn(last.t, f.t).abs();
            let ds = stretch.length() / f64::from(pieces);
            let share = density.share(stretch, self.from + s) - density.share(stretch, self.from + s - ds);
            stations.push(s);
            sums.push(
                sums[sums.len() - 1] + share.max(0.0) * density.total() / unit + turn / TURN + 1e-6 * ds,
            );
            last = f;
        }
        Shares { stations, sums }
    }

    /// Number of knot intervals to begin with, from the deviation of a guess: it falls with the sixth power.
    fn count(&self, shares: &Shares, limit: f64) -> usize {
        let guess = (shares.sums[shares.sums.len() - 1].ceil() as usize).clamp(2, MOST_POINTS);
        let worst = self.equalised(shares, guess).1;
        let ratio = math::pow((worst / limit).clamp(1e-6, 1e6), 1.0 / 5.0);
        ((guess as f64 * ratio * 0.95).floor() as usize).clamp(1, MOST_POINTS)
    }

    /// Spline of `n` knot intervals with equalised deviations, and the largest of those from the middle.
    fn equalised(&self, shares: &Shares, n: usize) -> (Spline, f64) {
        let mut shares = shares.clone();
        let mut best: Option<(Spline, f64)> = None;
        for _ in 0..ROUNDS {
            let mut spline = self.first(&shares, n);
            for _ in 0..STEPS {
                self.improve(&mut spline, None);
            }
            let errors = self.errors(&spline);
            let worst = errors.iter().fold(0.0_f64, |m, v| m.max(*v));
            if best.as_ref().is_none_or(|(_, w)| worst < *w) {
                best = Some((spline, worst));
            }
            let mean = errors.iter().sum::<f64>() / errors.len() as f64;
            let factors: Vec<f64> = errors
                .iter()
                .map(|e| math::pow((e / mean.max(1e-12)).clamp(0.05, 20.0), 1.0 / 7.0))
                .collect();
            shares = shares.scaled(&factors);
        }
        best.unwrap_or_else(|| (self.first(&shares, n), f64::INFINITY))
    }

    /// Largest distance from the middle of the band in every knot interval, mm.
    fn errors(&self, spline: &Spline) -> Vec<f64> {
        let mut out = Vec::new();
        let mut last = None;
        for (i, q) in stations(spline, self.stretch, self.from, ROWS) {
            if last != Some(i) {
                out.push(0.0_f64);
                last = Some(i);
            }
            if let Some(worst) = out.last_mut() {
                *worst = worst.max((q.e - self.middle()).abs());
            }
        }
        out
    }

    /// Spline of `n` knot intervals through points of the curve at the knot averages, then fitted in least squares
    /// to the curve in both coordinates.
    fn first(&self, shares: &Shares, n: usize) -> Spline {
        let length = self.stretch.length();
        let inside: Vec<f64> = (1..n).map(|j| shares.station(j as f64 / n as f64)).collect();
        let knots = match self.knots {
            Knots::Uniform => clamped(0.0, &(1..n).map(|j| j as f64).collect::<Vec<_>>(), n as f64),
            Knots::Printed { decimals } => {
                let scale = (0..decimals).fold(1.0, |s, _| s * 10.0);
                let print = |x: f64| (x * scale).round() / scale;
                clamped(0.0, &inside.iter().map(|&x| print(x)).collect::<Vec<_>>(), print(length))
            }
            Knots::Pieces { .. } => clamped(0.0, &inside, length),
        };
        let place = |t: f64| match self.knots {
            Knots::Uniform => shares.station(t / n as f64),
            Knots::Printed { .. } | Knots::Pieces { .. } => t,
        };
        let points = (0..n + ORDER - 1)
            .map(|j| {
                let t = (knots[j + 1] + knots[j + 2] + knots[j + 3]) / 3.0;
                let f = self.stretch.at(self.from + place(t).min(length));
                f.p + left(f.t) * self.middle()
            })
            .collect();
        let mut spline = Spline { knots, points };
        let last = spline.points.len() - 1;
        spline.points[0] = super::arcs::grid_point(self.grid, self.ends[0]);
        spline.points[last] = super::arcs::grid_point(self.grid, self.ends[1]);
        self.interpolate(&mut spline, place);
        spline
    }

    /// Least squares to the curve, points at parameter t against the station `place(t)`.
    fn interpolate(&self, spline: &mut Spline, place: impl Fn(f64) -> f64) {
        let mut problem = self.empty(spline);
        for i in ORDER - 1..spline.points.len() {
            let (a, b) = (spline.knots[i], spline.knots[i + 1]);
            if b <= a {
                continue;
            }
            for j in 0..ROWS {
                let t = a + (b - a) * (f64::from(j) + 0.5) / f64::from(ROWS);
                let f = self.stretch.at(self.from + place(t));
                let w = spline.jet(i, t).p - (f.p + left(f.t) * self.middle());
                let weights = basis(&spline.knots, i, t);
                for (axis, value) in [(0, w.x), (1, w.y)] {
                    let mut direction = [0.0; 2];
                    direction[axis] = 1.0;
                    problem.rows.push(self.row(spline, i, &weights, direction, value));
                }
            }
        }
        if let Some(x) = problem.least_change(1e-12) {
            apply(spline, &x, 1.0);
        }
    }

    fn empty(&self, spline: &Spline) -> Problem {
        Problem { blocks: spline.points.len(), cyclic: false, rows: Vec::new() }
    }

    /// A row for the motion of the four points of interval `i` along `direction`; the end points stay.
    fn row(&self, spline: &Spline, i: usize, weights: &[f64; ORDER], direction: [f64; 2], value: f64) -> Row {
        let mut coefficients = [0.0; WIDTH];
        let last = spline.points.len() - 1;
        for (j, weight) in weights.iter().enumerate() {
            let point = i + 1 + j - ORDER;
            if point != 0 && point != last {
                coefficients[j * BLOCK] = weight * direction[0];
                coefficients[j * BLOCK + 1] = weight * direction[1];
            }
        }
        Row { block: i + 1 - ORDER, coefficients, value, limit: 0.0, slope: 1.0 }
    }

    /// One step: least squares, or minimax within a box of `reach` mm for every coordinate.
    fn improve(&self, spline: &mut Spline, reach: Option<f64>) -> Option<f64> {
        let mut problem = self.empty(spline);
        for (i, q) in stations(spline, self.stretch, self.from, ROWS) {
            let n = left(self.stretch.at(q.s).t);
            let i = i.min(interval(&spline.knots, q.t));
            let weights = basis(&spline.knots, i, q.t);
            problem.rows.push(self.row(spline, i, &weights, [n.x, n.y], q.e - self.middle()));
        }
        let Some(reach) = reach else {
            for row in &mut problem.rows {
                row.slope = 0.0;
            }
            let x = problem.least_change(DAMPING)?;
            apply(spline, &x, 1.0);
            return None;
        };
        for row in &mut problem.rows {
            row.coefficients.iter_mut().for_each(|c| *c *= reach);
        }
        for v in 0..spline.points.len() * BLOCK {
            let mut coefficients = [0.0; WIDTH];
            coefficients[v % BLOCK] = 1.0;
            problem.rows.push(Row { block: v / BLOCK, coefficients, value: 0.0, limit: 1.0, slope: 0.0 });
        }
        let solution = problem.solve(1e-3)?;
        apply(spline, &solution.x, reach);
        Some(solution.t)
    }

    /// A printed spline of `n` knot intervals, or the deviation that was reached.
    fn attempt(&self, shares: &Shares, n: usize, limit: f64) -> Result<(Primitive, (f64, f64)), f64> {
        let (mut spline, mut worst) = self.equalised(shares, n);
        let mut reach = 20.0 * worst;
        for _ in 0..MINIMAX_STEPS {
            if worst > 30.0 * limit || reach < 0.05 * limit {
                break;
            }
            let mut next = spline.clone();
            let Some(expected) = self.improve(&mut next, Some(reach)) else { break };
            let found = self.errors(&next).iter().fold(0.0_f64, |m, v| m.max(*v));
            let gain = worst - found;
            reach *= if gain > 0.5 * (worst - expected) { 1.5 } else { 0.4 };
            if gain > 0.0 {
                (spline, worst) = (next, found);
            }
            if worst - expected < 2e-3 * worst {
                break;
            }
        }
        if worst > 1.05 * limit {
            return Err(worst);
        }
        self.print(&spline).ok_or(worst.max(self.half()))
    }

    /// The spline with its points on the grid, when it keeps the band.
    fn print(&self, spline: &Spline) -> Option<(Primitive, (f64, f64))> {
        let (printed, steps, pieces) = match self.knots {
            Knots::Pieces { finer } => {
                let (printed, steps) = pieces::cut(spline, self.grid, self.ends, finer)?;
                (printed, steps, Some(finer))
            }
            Knots::Printed { .. } | Knots::Uniform => {
                let (printed, steps) = self.on_grid(spline)?;
                (printed, steps, None)
            }
        };
        let (low, high) = extremes(&printed, self.stretch, self.from);
        if high > self.tube.left || low < -self.tube.right {
            return None;
        }
        let primitive = Primitive::Nurbs {
            order: ORDER as u8,
            points: steps.into_iter().map(|q| (q, 1.0)).collect(),
            knots: printed.knots,
            pieces,
        };
        Some((primitive, (high.max(0.0), (-low).max(0.0))))
    }

    fn on_grid(&self, spline: &Spline) -> Option<(Spline, Vec<[i64; 2]>)> {
        let grid_points: Vec<[i64; 2]> = spline
            .points
            .iter()
            .map(|&p| super::arcs::nearest_grid_point(self.grid, p).ok())
            .collect::<Option<_>>()?;
        let points: Vec<Point2> =
            grid_points.iter().map(|&q| super::arcs::grid_point(self.grid, q)).collect();
        Some((Spline { knots: spline.knots.clone(), points }, grid_points))
    }
}

fn apply(spline: &mut Spline, x: &[f64], scale: f64) {
    let last = spline.points.len() - 1;
    for (j, p) in spline.points.iter_mut().enumerate().take(last).skip(1) {
        p.x += scale * x[j * BLOCK];
        p.y += scale * x[j * BLOCK + 1];
    }
}
