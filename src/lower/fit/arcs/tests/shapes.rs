//! Shapes with corners, straight lines, ends; mirrored, turned, reversed and restarted; random curves.

use std::sync::Arc;

use proptest::prelude::*;

use super::super::arcs;
use super::survey::{Harmonic, check};
use super::{Pitch, grid};
use crate::geom::curve::{
    Chain, CircularArc, CurveRef, Moved, Part, Placement, Reversed, Segment, restarted,
};
use crate::geom::{Point2, Vec2};
use crate::lower::fit::{FitError, Primitive, Tube};
use crate::math;
use crate::units::Angle;

fn tube(curve: &CurveRef, left: f64, right: f64) -> Tube<'_> {
    Tube { curve: curve.as_ref(), left, right }
}

fn segment(a: (f64, f64), b: (f64, f64)) -> CurveRef {
    Arc::new(Segment::new(Point2::new(a.0, a.1), Point2::new(b.0, b.1)).unwrap())
}

fn bow(centre: (f64, f64), radius: f64, start: f64, sweep: f64) -> CurveRef {
    let c = Point2::new(centre.0, centre.1);
    Arc::new(CircularArc::new(c, radius, start * math::DEG, sweep * math::DEG).unwrap())
}

fn chain(members: Vec<CurveRef>) -> CurveRef {
    Arc::new(Chain::new(members, 1e-6).unwrap())
}

/// A slot: two straight lines and two half circles, tangent.
fn slot() -> CurveRef {
    chain(vec![
        segment((0.0, -7.3), (31.1, -7.3)),
        bow((31.1, 0.0), 7.3, -90.0, 180.0),
        segment((31.1, 7.3), (0.0, 7.3)),
        bow((0.0, 0.0), 7.3, 90.0, 180.0),
    ])
}

/// A sector of a disc: corners between lines and an arc.
fn sector() -> CurveRef {
    let end = |a: f64| (20.0 * math::cos(a * math::DEG), 20.0 * math::sin(a * math::DEG));
    chain(vec![
        segment((0.0, 0.0), end(10.0)),
        bow((0.0, 0.0), 20.0, 10.0, 250.0),
        segment(end(260.0), (0.0, 0.0)),
    ])
}

fn kinds(primitives: &[Primitive]) -> (usize, usize) {
    let arcs = primitives.iter().filter(|p| matches!(p, Primitive::Arc { .. })).count();
    (primitives.len() - arcs, arcs)
}

#[test]
fn a_slot_is_two_lines_and_two_arcs() {
    let curve = slot();
    for (left, right) in [(0.01, 0.01), (0.01, 0.0), (0.0, 0.004)] {
        let t = tube(&curve, left, right);
        let fit = arcs(&t, &grid(0.001), false, None).unwrap();
        check("slot", &t, &grid(0.001), &fit);
        assert_eq!(kinds(&fit.primitives), (2, 2), "{left} {right} {fit:?}");
    }
}

#[test]
fn corners_part_the_chain() {
    let curve = sector();
    for (left, right) in [(0.01, 0.01), (0.005, 0.005)] {
        let t = tube(&curve, left, right);
        let fit = arcs(&t, &grid(0.001), false, None).unwrap();
        check("sector", &t, &grid(0.001), &fit);
        assert_eq!(kinds(&fit.primitives), (2, 1), "{fit:?}");
    }
}

#[test]
fn a_circle_is_one_arc() {
    let curve: CurveRef = Arc::new(CircularArc::circle(Point2::new(3.1, -2.7), 17.0, 0.4, true).unwrap());
    for step in [0.001, 1e-5, 0.00254] {
        let t = tube(&curve, 0.01, 0.01);
        let fit = arcs(&t, &grid(step), false, None).unwrap();
        assert_eq!(fit.primitives.len(), 1);
        assert_eq!(fit.lower_bound, Some(1));
        assert!(fit.deviation.0 < step && fit.deviation.1 < step, "{fit:?}");
        check("circle", &t, &grid(step), &fit);
    }
}

#[test]
fn open_curves_start_and_end_at_their_ends() {
    let curve: CurveRef = Arc::new(Part::new(super::paper(), 0.3, 3.6).unwrap());
    let t = tube(&curve, 0.01, 0.01);
    let fit = arcs(&t, &grid(0.001), false, None).unwrap();
    check("open", &t, &grid(0.001), &fit);
    let start = Point2::new(fit.start[0] as f64, fit.start[1] as f64) * 0.001;
    assert!((start - curve.at(0.3).p.coords).coords.norm() < 0.002);
    assert!(fit.primitives.len() <= 8, "{}", fit.primitives.len());
}

#[test]
fn a_band_finer_than_the_grid_is_refused() {
    let curve = super::paper();
    let found = arcs(&tube(&curve, 1e-5, 1e-5), &grid(0.001), false, None);
    assert!(matches!(found, Err(FitError::BandTooNarrow { .. })), "{found:?}");
}

/// The same cam moved, mirrored, reversed and started elsewhere needs about as many arcs.
#[test]
fn counts_do_not_depend_on_the_placement() {
    let base: CurveRef = Arc::new(Pitch::new(31.0, 11.0, (23.0, 161.0), (187.0, 311.0)));
    let placed = |mirror: bool, turn: f64| -> CurveRef {
        let p = Placement::new(mirror, 1.0, Angle::degrees(turn), Vec2::new(1.234_56, -7.891)).unwrap();
        Arc::new(Moved::new(base.clone(), p))
    };
    let variants = [
        base.clone(),
        placed(false, 33.0),
        placed(true, 90.0),
        Arc::new(Reversed::new(base.clone())) as CurveRef,
        restarted(&base, 2.0),
    ];
    let counts: Vec<usize> = variants
        .iter()
        .map(|curve| {
            let t = tube(curve, 0.01, 0.01);
            let fit = arcs(&t, &grid(0.001), false, Some(1.0)).unwrap();
            check("variant", &t, &grid(0.001), &fit);
            fit.primitives.len()
        })
        .collect();
    let (low, high) = (counts.iter().min().unwrap(), counts.iter().max().unwrap());
    assert!(high - low <= 1, "{counts:?}");
}

/// A tighter band needs more arcs.
#[test]
fn a_tighter_band_needs_more_arcs() {
    let curve = super::paper();
    let counts: Vec<usize> = [0.04, 0.02, 0.01, 0.005, 0.0025]
        .iter()
        .map(|&b| arcs(&tube(&curve, b, b), &grid(1e-4), false, None).unwrap().primitives.len())
        .collect();
    assert!(counts.windows(2).all(|w| w[0] <= w[1]), "{counts:?}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    /// Whatever the smooth curve, the printed chain keeps the band, its tangents and its radii, or is refused.
    #[test]
    fn random_curves_are_followed(
        radius in 15.0..80.0_f64,
        sizes in proptest::array::uniform4(0.0..1.0_f64),
        phases in proptest::array::uniform4(0.0..crate::math::TAU),
        band in (0.001..0.03_f64, 0.001..0.03_f64),
        step in prop_oneof![Just(0.001), Just(1e-4), Just(0.00254)],
    ) {
        let mut terms = vec![(0.0, radius, 0.0)];
        for (i, (size, phase)) in sizes.iter().zip(phases).enumerate() {
            let k = i as f64 + 1.0;
            terms.push((k, 0.25 * radius * size / (k * k), phase));
        }
        let curve: CurveRef = Arc::new(Harmonic::new(terms));
        let t = tube(&curve, band.0, band.1);
        match arcs(&t, &grid(step), false, None) {
            Ok(fit) => { check("random", &t, &grid(step), &fit); }
            Err(error) => prop_assert!(band.0 + band.1 < 4.0 * step, "{error}"),
        }
    }
}
