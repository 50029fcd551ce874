//! What no fit should meet: bands that are no numbers or wider than the curve, coordinates beyond the arithmetic.

use super::tube::checked;
use super::{Fit, FitError, Grid, Tube};
use crate::geom::Point2;

/// Largest coordinate, mm: beyond it double precision cannot tell nanometres apart.
const FARTHEST: f64 = 1e7;
/// Largest coordinate in grid steps, so that sums of a few and their halves are exact.
const MOST_STEPS: f64 = 1e12;
/// Widest side of a band, as a share of the curve's extent; in a wider one a chain need not look like the curve.
const WIDEST: f64 = 1.0 / 16.0;
/// Points of a span that are looked at, when there are few spans.
const LOOKS: u32 = 16;

/// The tube that is fitted in.
#[derive(Debug)]
pub(super) struct Guarded<'a> {
    /// The tube asked for, or a narrower one inside it.
    pub tube: Tube<'a>,
    /// Whether it is narrower: then its lower bound is none of the tube asked for.
    narrowed: bool,
}

impl Guarded<'_> {
    /// The fit as one of the tube asked for.
    pub fn answer(&self, mut fit: Fit) -> Fit {
        if self.narrowed {
            fit.lower_bound = None;
        }
        fit
    }
}

/// The tube with a band that can be fitted in.
///
/// # Errors
/// [`FitError::BadCurve`] where the curve has no finite data, [`FitError::TooLarge`] beyond the range of the
/// arithmetic, [`FitError::BandTooNarrow`] for a band with a side that is negative or no number.
pub(super) fn guarded<'a>(tube: &Tube<'a>, grid: &Grid) -> Result<Guarded<'a>, FitError> {
    let (low, high) = extent(tube)?;
    for at in [low, high] {
        let most = at.x.abs().max(at.y.abs());
        if !(most <= FARTHEST && most <= MOST_STEPS * grid.step) {
            return Err(FitError::TooLarge { at });
        }
    }
    let (left, right) = (tube.left, tube.right);
    if !(left >= 0.0 && right >= 0.0) {
        return Err(FitError::BandTooNarrow { needed: grid.step, have: 0.0, at: low });
    }
    let widest = WIDEST * (high - low).norm();
    let narrowed = left > widest || right > widest;
    let tube = Tube { curve: tube.curve, left: left.min(widest), right: right.min(widest) };
    Ok(Guarded { tube, narrowed })
}

/// Corners of a box about points of the curve.
fn extent(tube: &Tube<'_>) -> Result<(Point2, Point2), FitError> {
    let breaks = tube.curve.breaks();
    let looks = if breaks.len() > 256 { 1 } else { LOOKS };
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for (span, pair) in breaks.windows(2).enumerate() {
        for i in 0..=looks {
            let share = f64::from(i) / f64::from(looks);
            let p = checked(tube.curve, span, pair[0] + (pair[1] - pair[0]) * share)?.p;
            low = [low[0].min(p.x), low[1].min(p.y)];
            high = [high[0].max(p.x), high[1].max(p.y)];
        }
    }
    if low[0] > high[0] {
        return Err(FitError::BadCurve { u: tube.curve.domain().0 });
    }
    Ok((Point2::new(low[0], low[1]), Point2::new(high[0], high[1])))
}
