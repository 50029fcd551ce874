//! Cubic B-splines in a band, with few control points on the grid.
//!
//! [`engine`] fits any course; here it is a planar curve, whose deviation is (X(t) - C(s))·n(s) at the feet s of the spline's
//! parameters t.

mod certify;
pub(in crate::lower) mod engine;
mod knots;
mod pieces;
pub(in crate::lower) mod shares;
pub(in crate::lower) mod spline;
#[cfg(test)]
mod tests;

use certify::{Station, extremes, stations};
use engine::{Course, Deviation, Engine, ROWS};
pub use knots::Knots;
use shares::Shares;
use spline::{ORDER, Spline};

use super::arcs::start::Density;
use super::arcs::stretch::{Stretch, stretches};
use super::guard::guarded;
use super::{Fit, FitError, Grid, Primitive, Tube};
use crate::geom::{Point2, left};
use crate::math;

/// Turning of one knot interval in the first density, radians.
const TURN: f64 = 1.2;
/// Widest band that an error asks for, mm.
const MOST_NEEDED: f64 = 1e6;

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
        let along = Along { tube, grid, stretch, from, ends, knots };
        let (points, primitive, deviation) = along.fit(points)?;
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

/// A stretch of the curve between corners, and where its spline starts.
struct Along<'a> {
    tube: &'a Tube<'a>,
    grid: &'a Grid,
    stretch: &'a Stretch<'a>,
    /// Station where the spline starts, mm.
    from: f64,
    /// First and last control point.
    ends: [[i64; 2]; 2],
    knots: Knots,
}

impl Along<'_> {
    /// The middle of the band, left of the curve, mm.
    fn offset(&self) -> f64 {
        0.5 * (self.tube.left - self.tube.right)
    }

    /// Number of control points (or pieces), the curve and its deviation.
    fn fit(&self, most: usize) -> Result<(usize, Primitive, (f64, f64)), FitError> {
        let engine = Engine { course: self, knots: self.knots, most, haste: false };
        let found = engine.fit(&self.first_shares());
        found.map(|(blocks, (primitive, deviation))| (blocks, primitive, deviation)).map_err(|needed| {
            FitError::BandTooNarrow {
                needed: (2.0 * needed).clamp(2.0 * self.half() + self.grid.step, MOST_NEEDED),
                have: 2.0 * self.half(),
                at: self.stretch.at(self.from).p,
            }
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

    fn on_grid(&self, spline: &Spline<2>) -> Option<(Spline<2>, Vec<[i64; 2]>)> {
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

impl Course<2> for Along<'_> {
    /// With its deviation.
    type Printed = (Primitive, (f64, f64));

    fn length(&self) -> f64 {
        self.stretch.length()
    }

    fn half(&self) -> f64 {
        0.5 * (self.tube.left + self.tube.right)
    }

    fn limit(&self) -> f64 {
        // What rounding of the control points may take: half a step in each coordinate.
        (self.half() - 0.71 * self.grid.step).max(0.4 * self.half())
    }

    fn middle(&self, s: f64) -> Point2 {
        let f = self.stretch.at(self.from + s);
        f.p + left(f.t) * self.offset()
    }

    fn ends(&self) -> [Point2; 2] {
        self.ends.map(|q| super::arcs::grid_point(self.grid, q))
    }

    fn deviations(&self, spline: &Spline<2>) -> Vec<Deviation<2>> {
        let deviation = |(interval, q): (usize, Station)| {
            let across = left(self.stretch.at(q.s).t);
            Deviation { interval, t: q.t, across, off: q.e - self.offset(), aside: None }
        };
        stations(spline, self.stretch, self.from, ROWS).into_iter().map(deviation).collect()
    }

    fn print(&self, spline: &Spline<2>) -> Option<(Primitive, (f64, f64))> {
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
}
