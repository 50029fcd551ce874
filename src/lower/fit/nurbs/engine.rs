//! The spline with the fewest knot intervals whose deviation from a course stays in a band, whatever the course is.
//!
//! Only the deviation across the course counts, and to the side of it no more than there is room; the spline's parameter is
//! free. So the control points are moved by Gauss-Newton steps (least squares, then linear minimax) on the deviations at
//! fixed parameters. Knots lie at equal shares of a density that is corrected by the deviation found in every interval.

use nalgebra::{Const, OPoint, SVector};

use super::knots::Knots;
use super::shares::Shares;
use super::spline::{ORDER, Spline, basis, clamped, interval};
use crate::lower::fit::arcs::minimax::{BLOCK, Problem, Row, WIDTH};
use crate::math;

/// Rows per knot interval.
pub(in crate::lower) const ROWS: u32 = 8;
/// The deviation falls with this power of the number of intervals, where the theory says the sixth.
const FALL: f64 = 5.0;
/// Rounds that correct the density of knots.
const ROUNDS: usize = 4;
/// Gauss-Newton steps of a round.
const STEPS: usize = 3;
/// Minimax steps.
const MINIMAX_STEPS: usize = 10;
/// Share of the deviation that another minimax step should take off at least …
const SETTLED: f64 = 2e-3;
/// … and in haste.
const HASTE: f64 = 0.03;
/// Damping of Gauss-Newton steps, relative.
const DAMPING: f64 = 1e-6;
/// Splines that the grid may spoil before it is blamed.
const REFUSALS: u32 = 6;
/// More intervals than this factor of the first guess …
const GROWTH: usize = 2;
/// … and these are no use.
const SPARE: usize = 24;
/// A first guess that exceeds the number allowed by this factor is no use either.
const HOPELESS: f64 = 1.5;
/// Most knot intervals of one curve.
const MOST: usize = 100_000;
/// Weight of what is to the side in least squares, where the whole room weighs as much as this many half bands.
const ASIDE: f64 = 0.5;

/// How a spline deviates at one parameter.
#[derive(Debug, Clone, Copy)]
pub(in crate::lower) struct Deviation<const D: usize> {
    /// Knot interval.
    pub interval: usize,
    /// Spline parameter.
    pub t: f64,
    /// Unit vector across the course, in the direction in which the band is told.
    pub across: SVector<f64, D>,
    /// Deviation from the middle of the band, mm.
    pub off: f64,
    /// Direction to the side, the deviation in it and the room there, mm.
    pub aside: Option<(SVector<f64, D>, f64, f64)>,
}

/// What a spline is to follow, by its length.
pub(in crate::lower) trait Course<const D: usize> {
    /// A spline as it is printed.
    type Printed;

    /// Length, mm.
    fn length(&self) -> f64;
    /// Half the width of the band, mm.
    fn half(&self) -> f64;
    /// What of it is left when control points are rounded, mm.
    fn limit(&self) -> f64;
    /// The place in the middle of the band at a station.
    fn middle(&self, s: f64) -> OPoint<f64, Const<D>>;
    /// First and last control point.
    fn ends(&self) -> [OPoint<f64, Const<D>>; 2];
    /// Deviations at [`ROWS`] parameters of every knot interval.
    fn deviations(&self, spline: &Spline<D>) -> Vec<Deviation<D>>;
    /// The spline with its points on the grid, when it keeps the band.
    fn print(&self, spline: &Spline<D>) -> Option<Self::Printed>;
}

/// A course, and what is asked of its spline.
pub(in crate::lower) struct Engine<'a, C, const D: usize> {
    pub course: &'a C,
    pub knots: Knots,
    /// Most control points, or pieces.
    pub most: usize,
    /// A spline that keeps the band will do, and need not be the one that deviates least.
    pub haste: bool,
}

impl<C: Course<D>, const D: usize> Engine<'_, C, D> {
    /// Number of control points (or pieces) and the printed spline; else half the band that would be needed, mm.
    pub fn fit(&self, shares: &Shares) -> Result<(usize, C::Printed), f64> {
        let limit = self.course.limit();
        let guess = self.count(shares, limit);
        let most = (GROWTH * guess + SPARE).min(MOST).min(self.most.saturating_sub(self.knots.more_blocks()));
        let mut n = if guess as f64 > HOPELESS * most as f64 { most + 1 } else { guess.min(most) };
        let mut best = None;
        let (mut needed, mut refused) = (f64::INFINITY, 0);
        while n <= most && refused < REFUSALS {
            match self.attempt(shares, n, limit) {
                Ok(found) => {
                    best = Some(found);
                    break;
                }
                Err(worst) => {
                    // kept the band before rounding: more points would not help the grid
                    refused += u32::from(worst <= self.course.half());
                    needed = needed.min(worst);
                    n += self.growth(n, worst / limit);
                }
            }
        }
        while n > 1 && best.is_some() {
            match self.attempt(shares, n - 1, limit) {
                Ok(found) => {
                    best = Some(found);
                    n -= 1;
                }
                Err(_) => break,
            }
        }
        best.map(|printed| (n + self.knots.more_blocks(), printed)).ok_or(needed)
    }

    /// How many more intervals to try where `n` of them deviate by `ratio` times what they may.
    fn growth(&self, n: usize, ratio: f64) -> usize {
        let least = 1 + n / 40;
        if !self.haste || !ratio.is_finite() {
            return least;
        }
        let factor = math::pow(ratio.clamp(1.0, 4.0), 1.0 / FALL) - 1.0;
        least.max((factor * n as f64).floor() as usize)
    }

    /// Number of knot intervals to begin with, from the deviation of a guess.
    fn count(&self, shares: &Shares, limit: f64) -> usize {
        let guess = (shares.total().ceil() as usize).clamp(2, MOST);
        let worst = self.equalised(shares, guess).1;
        let ratio = math::pow((worst / limit).clamp(1e-6, 1e6), 1.0 / FALL);
        ((guess as f64 * ratio * 0.95).floor() as usize).clamp(1, MOST)
    }

    /// Spline of `n` knot intervals with equalised deviations, and the largest of those from the middle.
    fn equalised(&self, shares: &Shares, n: usize) -> (Spline<D>, f64) {
        let mut shares = shares.clone();
        let mut best: Option<(Spline<D>, f64)> = None;
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

    /// Largest distance from the middle of the band in every knot interval, mm; where the spline is farther to the side than
    /// there is room, by that much more of the band.
    fn errors(&self, spline: &Spline<D>) -> Vec<f64> {
        let mut out = Vec::new();
        let mut last = None;
        for q in self.course.deviations(spline) {
            if last != Some(q.interval) {
                out.push(0.0_f64);
                last = Some(q.interval);
            }
            if let Some(worst) = out.last_mut() {
                let aside = q.aside.map_or(0.0, |(_, off, room)| off.abs() / room * self.course.limit());
                *worst = worst.max(q.off.abs()).max(aside);
            }
        }
        out
    }

    /// Spline of `n` knot intervals through points of the curve at the knot averages, then fitted in least squares
    /// to the curve in all coordinates.
    fn first(&self, shares: &Shares, n: usize) -> Spline<D> {
        let length = self.course.length();
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
                self.course.middle(place(t).min(length))
            })
            .collect();
        let mut spline = Spline { knots, points };
        let last = spline.points.len() - 1;
        [spline.points[0], spline.points[last]] = self.course.ends();
        self.interpolate(&mut spline, place);
        spline
    }

    /// Least squares to the curve, points at parameter t against the station `place(t)`.
    fn interpolate(&self, spline: &mut Spline<D>, place: impl Fn(f64) -> f64) {
        let mut problem = Self::empty(spline);
        for i in ORDER - 1..spline.points.len() {
            let (a, b) = (spline.knots[i], spline.knots[i + 1]);
            if b <= a {
                continue;
            }
            for j in 0..ROWS {
                let t = a + (b - a) * (f64::from(j) + 0.5) / f64::from(ROWS);
                let w = spline.jet(i, t).p - self.course.middle(place(t));
                let weights = basis(&spline.knots, i, t);
                for axis in 0..D {
                    let direction = SVector::<f64, D>::from_fn(|k, _| if k == axis { 1.0 } else { 0.0 });
                    problem.rows.push(row(spline, i, &weights, direction, w[axis]));
                }
            }
        }
        if let Some(x) = problem.least_change(1e-12) {
            apply(spline, &x, 1.0);
        }
    }

    fn empty(spline: &Spline<D>) -> Problem {
        Problem { blocks: spline.points.len(), cyclic: false, rows: Vec::new() }
    }

    /// One step: least squares, or minimax within a box of `reach` mm for every coordinate.
    fn improve(&self, spline: &mut Spline<D>, reach: Option<f64>) -> Option<f64> {
        let mut problem = Self::empty(spline);
        for q in self.course.deviations(spline) {
            let i = q.interval.min(interval(&spline.knots, q.t));
            let weights = basis(&spline.knots, i, q.t);
            problem.rows.push(row(spline, i, &weights, q.across, q.off));
            if let Some((direction, off, room)) = q.aside {
                let aside = row(spline, i, &weights, direction, off);
                let weight = ASIDE * self.course.half() / room;
                problem.rows.push(match reach {
                    None => scaled(&aside, weight),
                    Some(_) => scaled(&aside, self.course.limit() / room),
                });
            }
        }
        let Some(reach) = reach else {
            let x = problem.least_change(DAMPING)?;
            apply(spline, &x, 1.0);
            return None;
        };
        for row in &mut problem.rows {
            row.slope = 1.0;
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
    fn attempt(&self, shares: &Shares, n: usize, limit: f64) -> Result<C::Printed, f64> {
        let (mut spline, mut worst) = self.equalised(shares, n);
        let mut reach = 20.0 * worst;
        for _ in 0..MINIMAX_STEPS {
            if worst > 30.0 * limit || reach < 0.05 * limit || self.haste && worst <= limit {
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
            let settled = if self.haste { HASTE } else { SETTLED };
            if worst - expected < settled * worst {
                break;
            }
        }
        if worst > 1.05 * limit {
            return Err(worst);
        }
        self.course.print(&spline).ok_or(worst.max(self.course.half()))
    }
}

/// A row for the motion of the four points of interval `i` along `direction`; the end points stay.
fn row<const D: usize>(
    spline: &Spline<D>,
    i: usize,
    weights: &[f64; ORDER],
    direction: SVector<f64, D>,
    value: f64,
) -> Row {
    let mut coefficients = [0.0; WIDTH];
    let last = spline.points.len() - 1;
    for (j, weight) in weights.iter().enumerate() {
        let point = i + 1 + j - ORDER;
        if point != 0 && point != last {
            let own = &mut coefficients[j * BLOCK..(j + 1) * BLOCK];
            own.iter_mut().zip(direction.iter()).for_each(|(slot, d)| *slot = weight * d);
        }
    }
    Row { block: i + 1 - ORDER, coefficients, value, limit: 0.0, slope: 0.0 }
}

fn scaled(row: &Row, by: f64) -> Row {
    Row { coefficients: row.coefficients.map(|c| c * by), value: row.value * by, ..*row }
}

fn apply<const D: usize>(spline: &mut Spline<D>, x: &[f64], scale: f64) {
    let last = spline.points.len() - 1;
    for (j, p) in spline.points.iter_mut().enumerate().take(last).skip(1) {
        for (slot, step) in p.coords.iter_mut().zip(&x[j * BLOCK..(j + 1) * BLOCK]) {
            *slot += scale * step;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::{Point3, Vec3};

    /// A half wave over the plane of constant y, that is measured along a normal aslant to the plane.
    struct Wave;

    impl Wave {
        fn place(s: f64) -> (Point3, Vec3, Vec3) {
            let (sin, cos) = math::sin_cos(0.3 * s);
            let normal = Vec3::new(-0.3 * cos, 0.4, 1.0).normalize();
            (Point3::new(s, 5.0, sin), normal, Vec3::new(1.0, 0.0, 0.3 * cos))
        }
    }

    impl Course<3> for Wave {
        type Printed = Spline<3>;

        fn length(&self) -> f64 {
            20.0
        }
        fn half(&self) -> f64 {
            1e-3
        }
        fn limit(&self) -> f64 {
            1e-3
        }
        fn middle(&self, s: f64) -> Point3 {
            Wave::place(s).0
        }
        fn ends(&self) -> [Point3; 2] {
            [self.middle(0.0), self.middle(20.0)]
        }
        fn deviations(&self, spline: &Spline<3>) -> Vec<Deviation<3>> {
            let mut out = Vec::new();
            for interval in ORDER - 1..spline.points.len() {
                let (a, b) = (spline.knots[interval], spline.knots[interval + 1]);
                for k in 0..=ROWS {
                    let t = a + (b - a) * f64::from(k) / f64::from(ROWS);
                    let p = spline.jet(interval, t).p;
                    let (foot, mut across, _) = Wave::place(p.x);
                    let off = (p - foot).dot(&across);
                    across.y = 0.0;
                    out.push(Deviation { interval, t, across, off, aside: None });
                }
            }
            out
        }
        fn print(&self, spline: &Spline<3>) -> Option<Spline<3>> {
            Some(spline.clone())
        }
    }

    #[test]
    fn what_no_row_moves_stays() {
        for knots in [Knots::Uniform, Knots::Printed { decimals: 4 }] {
            let engine = Engine { course: &Wave, knots, most: usize::MAX, haste: false };
            let shares = Shares { stations: vec![0.0, 20.0], sums: vec![0.0, 8.0] };
            let (points, spline) = engine.fit(&shares).expect("a spline");
            assert!(points < 16, "{points}");
            for p in &spline.points {
                assert!((p.y - 5.0).abs() < 1e-9, "{spline:?}");
            }
            let worst = Wave.deviations(&spline).iter().map(|q| q.off.abs()).fold(0.0, f64::max);
            assert!(worst <= 1.05e-3, "{worst}");
        }
    }
}
