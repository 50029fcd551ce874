//! Fewest straight lines (LINEAR).

use super::guard::guarded;
use super::tube::Plane;
use super::{Fit, FitError, Grid, Tube, chain};

/// Fits the fewest straight lines with vertices on the grid.
///
/// `start`: preferred start parameter on a closed curve; the first vertex lies within about one link of it.
///
/// # Errors
/// See [`FitError`].
pub fn lines(tube: &Tube, grid: &Grid, start: Option<f64>) -> Result<Fit, FitError> {
    let guarded = guarded(tube, grid)?;
    chain::fit(&guarded.tube, Plane::xy(grid), start).map(|fit| guarded.answer(fit))
}
