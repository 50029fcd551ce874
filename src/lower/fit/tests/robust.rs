//! Every fit answers, soon, whatever the size of the curve and the width of the band.

use std::time::{Duration, Instant};

use super::super::samples::{Fourier, Pitch, Polygon};
use super::super::{Fit, FitError, Grid, Knots, Tube, arcs, lines, nurbs, spirals};
use crate::geom::Vec2;
use crate::geom::curve::PlanarCurve;
use crate::math;

type Answer = Result<Fit, FitError>;
type Fitter = fn(&Tube<'_>, &Grid) -> Answer;

/// All fits.
const FITTERS: [(&str, Fitter); 6] = [
    ("lines", |t, g| lines(t, g, None)),
    ("spirals", |t, g| spirals(t, g, None)),
    ("arcs", |t, g| arcs(t, g, false, None)),
    ("arcs, dwells exact", |t, g| arcs(t, g, true, None)),
    ("nurbs uniform", |t, g| nurbs(t, g, Knots::Uniform, None)),
    ("nurbs printed", |t, g| nurbs(t, g, Knots::Printed { decimals: 4 }, None)),
];

/// More than any one fit may take here, on a machine that is busy with other tests.
const LONGEST: Duration = Duration::from_secs(30);

fn curves(size: f64) -> Vec<(&'static str, Box<dyn PlanarCurve>)> {
    let wavy = vec![(size, 0.0), (0.0, 0.0), (0.1 * size, 0.05 * size), (0.0, 0.03 * size)];
    let point = |x: f64, y: f64| (x * size, y * size);
    let open = [point(0.1, 0.2), point(1.0, 0.2), point(1.4, 0.7), point(0.3, 0.5), point(0.3, 0.3)];
    vec![
        ("cam", Box::new(Pitch::new(size, 0.7 * size))),
        (
            "closed",
            Box::new(Fourier { centre: Vec2::zeros(), terms: wavy.clone(), breaks: [0.0, math::TAU] }),
        ),
        ("open", Box::new(Fourier { centre: Vec2::new(0.1, 0.0) * size, terms: wavy, breaks: [0.2, 2.9] })),
        ("polygon", Box::new(Polygon::new(&open))),
    ]
}

/// What can be said of any answer: a chain in its band, numbers in an error that a message can show.
fn sane(name: &str, tube: &Tube<'_>, answer: &Answer) {
    match answer {
        Ok(fit) => {
            let (l, r) = fit.deviation;
            assert!(!fit.primitives.is_empty(), "{name}: no primitives");
            assert!(l <= tube.left + 1e-8 && r <= tube.right + 1e-8, "{name}: {l} {r} leave the band");
            let bound = fit.lower_bound.unwrap_or(0) as usize;
            assert!(bound <= fit.primitives.len(), "{name}: {} beat {bound}", fit.primitives.len());
        }
        Err(FitError::BandTooNarrow { needed, have, .. }) => {
            assert!(needed.is_finite() && needed > have, "{name}: needs {needed}, has {have}");
        }
        Err(FitError::GridTooCoarse { kink, mismatch, .. }) => {
            assert!(kink.is_finite() && (*kink > 8e-4 || *mismatch > 0.002), "{name}: {kink} {mismatch}");
        }
        Err(FitError::NotStarShaped { .. } | FitError::BadCurve { .. }) => {}
        Err(FitError::TooLarge { at }) => assert!(at.coords.norm() > 1e5, "{name}: {at} is not large"),
    }
}

fn try_all(size: f64, bands: &[(f64, f64)], grid: &Grid) {
    for (shape, curve) in curves(size) {
        for &(left, right) in bands {
            let tube = Tube { curve: &*curve, left, right };
            for (fitter, fit) in FITTERS {
                let name = format!("{fitter}, {shape} of {size}, band -{right} +{left}, step {}", grid.step);
                let clock = Instant::now();
                let answer = fit(&tube, grid);
                let took = clock.elapsed();
                assert!(took < LONGEST, "{name}: {took:?}");
                sane(&name, &tube, &answer);
            }
        }
    }
}

fn grid(decimals: i32) -> Grid {
    let step = math::pow(10.0, -f64::from(decimals));
    Grid { step, centre_step: step, angle_step: 0.001 }
}

fn bands(widths: &[f64]) -> Vec<(f64, f64)> {
    widths.iter().flat_map(|b| [(*b, *b), (*b, 0.0), (0.0, *b)]).collect()
}

#[test]
fn any_size_and_any_band_is_answered() {
    try_all(1e-3, &bands(&[1e-6, 0.01]), &grid(4));
    try_all(30.0, &bands(&[1e-9, 10.0]), &grid(3));
    try_all(1e5, &[(1e-4, 0.0), (10.0, 10.0)], &grid(3));
}

#[test]
#[ignore = "takes minutes"]
fn every_size_and_every_band_is_answered() {
    for size in [1e-3, 0.01, 0.1, 1.0, 30.0, 1e3, 1e4, 1e5, 1e6] {
        for decimals in [3, 4] {
            try_all(size, &bands(&[1e-9, 1e-6, 1e-4, 0.01, 0.5, 10.0]), &grid(decimals));
        }
    }
}

#[test]
fn bands_wider_than_the_curve_are_answered() {
    for size in [1e-3, 30.0] {
        try_all(size, &[(600.0, 600.0), (600.0, 0.01), (1e9, f64::INFINITY)], &grid(3));
    }
}

#[test]
fn bands_that_are_no_numbers_are_refused() {
    for (_, curve) in curves(30.0) {
        for (left, right) in [(f64::NAN, 0.01), (f64::NAN, f64::NAN), (-0.1, 0.01), (0.01, -1.0)] {
            let tube = Tube { curve: &*curve, left, right };
            for (name, fit) in FITTERS {
                assert!(fit(&tube, &grid(3)).is_err(), "{name} {left} {right}");
            }
        }
    }
}
