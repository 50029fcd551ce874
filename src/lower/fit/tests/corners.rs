//! Contours of many small turns: they are fitted, or refused for a reason that can be checked.

use proptest::prelude::*;

use super::super::samples::Polygon;
use super::super::{Fit, FitError, Grid, Tube, arcs, lines, spirals};
use super::{Fitter, check, grid, inch};
use crate::geom::cross;
use crate::geom::curve::PlanarCurve;
use crate::math;

/// A grid may keep a path out of a band of fewer steps than this, where the corners are sharp …
const FEW_STEPS: f64 = 3.0;
/// … but one of this many is wide enough.
const ENOUGH_STEPS: f64 = 5.0;
const BANDS: [(f64, f64); 5] = [(0.01, 0.01), (0.0, 0.02), (0.02, 0.0), (0.05, 0.05), (0.003, 0.001)];

/// A star polygon about the origin: the angles and radii of an oval, each point off by a share of `rough`, mm.
fn star(offsets: &[(f64, f64)], rough: f64, closed: bool) -> Polygon {
    let n = offsets.len() as f64;
    let point = |(k, (turn, out)): (usize, &(f64, f64))| {
        let angle = (k as f64 + turn) / n * math::TAU;
        let (sin, cos) = math::sin_cos(angle);
        let r = 40.0 * (1.0 + 0.1 * math::sin(2.0 * angle)) + rough * out;
        (r * cos, r * sin)
    };
    let mut points: Vec<(f64, f64)> = offsets.iter().enumerate().map(point).collect();
    if closed {
        points.push(points[0]);
    }
    Polygon::new(&points)
}

/// The least distance of the lines through the sides from the origin: below 0 the polygon is not seen from there.
fn clearance(polygon: &Polygon) -> f64 {
    let sides = polygon.breaks().len() - 1;
    let arm = |i: usize| {
        let f = polygon.at_in(i, i as f64);
        cross(f.p.coords, f.t)
    };
    (0..sides).map(arm).fold(f64::INFINITY, f64::min)
}

fn spirals_of(tube: &Tube, grid: &Grid, start: Option<f64>) -> Result<Fit, FitError> {
    spirals(tube, grid, start)
}

fn arcs_of(tube: &Tube, grid: &Grid, start: Option<f64>) -> Result<Fit, FitError> {
    arcs(tube, grid, false, start)
}

/// Fits and measures by brute force, or checks that the reason of the refusal is true.
fn answered(name: &str, polygon: &Polygon, band: (f64, f64), grid: &Grid, fitter: Fitter) {
    let tube = Tube { curve: polygon, left: band.0, right: band.1 };
    match fitter(&tube, grid, None) {
        Ok(fit) if name == "arcs" => {
            let sides = polygon.breaks().len() - 1;
            assert!(fit.primitives.len() <= sides, "{name}: {} for {sides}", fit.primitives.len());
        }
        Ok(fit) => {
            check(&tube, grid, &fit, 8);
            let bound = fit.lower_bound.unwrap_or(0) as usize;
            let (n, fine) = (fit.primitives.len(), band.0 + band.1 > 0.008);
            assert!(n >= bound, "{name}: {n} beats the proven bound {bound}");
            assert!(!fine || n as f64 <= 1.1 * bound as f64 + 1.0, "{name}: {n} links, bound {bound}");
        }
        Err(FitError::BandTooNarrow { needed, have, at }) => {
            let unit = grid.step.max(at.coords.norm() * grid.angle_step * math::DEG);
            assert!(have < FEW_STEPS * unit, "{name}: refused {have} at {at}, needs {needed}");
            assert!(needed <= ENOUGH_STEPS * unit, "{name}: claims to need {needed}");
        }
        Err(FitError::NotStarShaped { .. }) => {
            let clear = clearance(polygon);
            assert!(clear < 2.0 * band.0.max(band.1), "{name}: sees {clear} mm past the origin");
        }
        Err(error) => panic!("{name}: {error}"),
    }
}

fn all_answered(polygon: &Polygon, band: (f64, f64)) {
    for grid in [grid(3), inch()] {
        for (name, fitter) in [("lines", lines as Fitter), ("spirals", spirals_of), ("arcs", arcs_of)] {
            answered(name, polygon, band, &grid, fitter);
        }
    }
}

/// Turns and radii of the corners of a star, by the high bits of a linear congruential generator.
fn random_offsets(seed: u32, corners: u32) -> Vec<(f64, f64)> {
    let mut state = u64::from(seed);
    let mut share = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from((state >> 33) as u32) / 2_147_483_648.0 - 0.5
    };
    (0..corners).map(|_| (0.6 * share(), share())).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    #[test]
    fn star_polygons_of_many_corners_are_fitted(
        corners in 50..500_u32,
        seed in any::<u32>(),
        rough in -2.3..0.1_f64,
        band in 0..BANDS.len(),
        closed in any::<bool>(),
    ) {
        let offsets = random_offsets(seed, corners);
        all_answered(&star(&offsets, math::pow(10.0, rough), closed), BANDS[band]);
    }
}

/// Zigzags whose teeth are as small as the band: chords pass many of them, and many corners lie about a vertex.
#[test]
fn closed_zigzags_of_many_corners_are_fitted() {
    for (corners, height) in [(60, 0.4), (200, 0.05), (500, 0.5), (1500, 0.012)] {
        let offsets: Vec<(f64, f64)> = (0..corners).map(|k| (0.0, f64::from(k % 2) - 0.5)).collect();
        for closed in [true, false] {
            for band in [(0.01, 0.01), (0.0, 0.02)] {
                all_answered(&star(&offsets, height, closed), band);
            }
        }
    }
}

/// A corner between gates that nothing but one or two grid points passes.
#[test]
fn a_narrow_band_is_threaded_through_sharp_corners() {
    let sharp: Vec<(f64, f64)> = (0..50).map(|k| (0.0, f64::from(k * 7 % 11) / 11.0 - 0.5)).collect();
    let polygon = star(&sharp, 1.0, true);
    let tube = Tube { curve: &polygon, left: 0.003, right: 0.001 };
    for fitter in [lines as Fitter, spirals_of] {
        let fit = fitter(&tube, &grid(3), None).unwrap();
        check(&tube, &grid(3), &fit, 8);
        assert!(fit.primitives.len() as f64 <= 1.1 * f64::from(fit.lower_bound.unwrap()));
    }
}

/// Sides that stand at such angles to one another that a point of the path is nearer to the ends of the wrong one.
#[test]
fn corners_that_are_acute_are_passed_on_the_right_side() {
    let offsets = random_offsets(898_559_402, 383);
    for closed in [true, false] {
        all_answered(&star(&offsets, 1.25595, closed), BANDS[1]);
    }
}
