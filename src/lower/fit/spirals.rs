//! Fewest Archimedean spirals about the origin (RTHETA).

use super::guard::guarded;
use super::tube::Plane;
use super::{Fit, FitError, Grid, Tube, chain};

/// Fits the fewest spirals, radius linear in the table's angle, with vertices on the grid of radius and angle.
///
/// Angles run on from the start's, whole turns included; the band is that of the normal distance in XY.
///
/// # Errors
/// [`FitError::NotStarShaped`] where the curve is not seen from the origin in one sense; see [`FitError`].
pub fn spirals(tube: &Tube, grid: &Grid, start: Option<f64>) -> Result<Fit, FitError> {
    let guarded = guarded(tube, grid)?;
    chain::fit(&guarded.tube, Plane::polar(grid), start).map(|fit| guarded.answer(fit))
}
