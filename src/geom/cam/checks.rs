//! Whether a follower can run on a cam, and the smallest base circle on which it can.

use super::figures::{CamFigures, Extreme, Samples};
use super::{Cam, CamDefinition, CamIssue, Flank, LARGEST_VALUE};
use crate::geom::crossing;
use crate::geom::curve::PlanarCurve;
use crate::geom::follower::{Follower, Linkage};
use crate::geom::motion::Lift;
use crate::units::Angle;

/// A pressure angle over its limit by no more than this, in radians, is rounding.
const PRESSURE_ROUNDING: f64 = 1e-7;
/// A base circle is found to this share of itself.
const BASE_ACCURACY: f64 = 1e-7;
/// Chords for the search of crossings are within this share of the cam's radius.
pub(super) const CROSSING_CHORD: f64 = 2e-5;

/// Values that make no cam, whatever the motion.
pub(super) fn value_issues(definition: &CamDefinition) -> Vec<CamIssue> {
    let mut values = vec![("base radius", definition.base)];
    match definition.follower {
        Follower::TranslatingRoller { radius, .. } => values.push(("roller radius", radius)),
        Follower::TranslatingFlat { .. } => {}
        Follower::OscillatingRoller { radius, arm, pivot, .. } => {
            values.extend([("roller radius", radius), ("arm length", arm), ("pivot distance", pivot)]);
        }
        Follower::OscillatingFlat { pivot, .. } => values.push(("pivot distance", pivot)),
    }
    values.extend(definition.speed.map(|s| ("speed", s)));
    let bad = |(what, value): (&'static str, f64)| {
        let good = value > 0.0 && value <= LARGEST_VALUE;
        (!good).then_some(CamIssue::NotPositive { what, value })
    };
    let mut issues: Vec<CamIssue> = values.into_iter().filter_map(bad).collect();
    if definition.groove && !definition.follower.has_roller() {
        issues.push(CamIssue::GrooveNeedsRoller);
    }
    issues
}

/// The worst pressure angle or flank condition of a follower on a base circle.
#[derive(Clone, Copy)]
enum Criterion {
    /// Every flank runs forwards everywhere.
    Undercut,
    /// The pressure angle stays within the limit, and no undercut.
    Pressure,
}

/// Speed of a flank over speed of the reference curve; 0 or less is undercut. Of a flat face: the radius of
/// curvature over the base radius.
fn forwardness(linkage: &Linkage, l: Lift, shift: f64, base: f64) -> f64 {
    let f = linkage.frenet(l);
    if linkage.roller > 0.0 { 1.0 - shift * f.k } else { f.speed / base }
}

impl Criterion {
    fn holds(self, definition: &CamDefinition, base: f64, samples: &Samples) -> bool {
        let Ok(linkage) = Linkage::new(&definition.follower, base) else { return false };
        let swings =
            || samples.largest(|l| linkage.swing(l).map_or(-1.0, |(psi, end)| psi - end)).value < 0.0;
        let forwards = |flank: &Flank| {
            samples.smallest(|l| forwardness(&linkage, l, flank.shift(linkage.roller), base)).value > 0.0
        };
        let limit = definition.max_pressure_angle.rad();
        let presses = || samples.largest(|l| linkage.pressure_angle(l).abs()).value <= limit;
        let pressed = matches!(self, Criterion::Undercut) || presses();
        pressed && swings() && definition.flanks().iter().all(forwards)
    }
    /// The smallest base radius that satisfies it: the first that does on a scan upwards, then bisection.
    fn smallest_base(self, definition: &CamDefinition, samples: &Samples) -> Option<f64> {
        const GROWTH: f64 = 1.15;
        const STEPS: usize = 90;
        let largest_lift = samples.largest(|l| l.s.abs() + l.v.abs() + l.a.abs()).value;
        let mut low = 1e-3 * definition.base.min(largest_lift.max(1e-3));
        let mut high = low;
        let mut tries = 0;
        while !self.holds(definition, high, samples) {
            low = high;
            high *= GROWTH;
            tries += 1;
            if tries > STEPS {
                return None;
            }
        }
        while high - low > BASE_ACCURACY * high {
            let mid = 0.5 * (low + high);
            if self.holds(definition, mid, samples) { high = mid } else { low = mid }
        }
        Some(high * (1.0 + BASE_ACCURACY))
    }
}

impl Cam {
    /// The smallest base radius, mm, with which this motion and follower keep the pressure angle within its
    /// limit and the flanks free of undercut; `None` when there is none.
    #[must_use]
    pub fn smallest_base(&self) -> Option<f64> {
        Criterion::Pressure.smallest_base(&self.definition, &Samples::new(&self.geometry))
    }
}

/// Undercut and swing, which leave no cam.
pub(super) fn local_errors(
    definition: &CamDefinition,
    linkage: &Linkage,
    samples: &Samples,
) -> Vec<CamIssue> {
    let mut issues = Vec::new();
    let swung = samples.largest(|l| linkage.swing(l).map_or(-1.0, |(psi, end)| psi - end));
    if swung.value >= 0.0 {
        let limit = linkage.swing(Lift::default()).map_or(0.0, |(_, end)| end);
        let angle = Angle::radians(swung.value + limit);
        issues.push(CamIssue::SwingsTooFar { at: swung.at, angle, limit: Angle::radians(limit) });
        return issues;
    }
    issues.extend(
        definition.flanks().iter().filter_map(|flank| undercut(definition, linkage, samples, *flank)),
    );
    issues
}

fn undercut(
    definition: &CamDefinition,
    linkage: &Linkage,
    samples: &Samples,
    flank: Flank,
) -> Option<CamIssue> {
    let shift = flank.shift(linkage.roller);
    let ratio = |l: Lift| forwardness(linkage, l, shift, definition.base);
    let worst = samples.smallest(ratio);
    if worst.value > 0.0 {
        return None;
    }
    let bad: Vec<f64> = samples.points().iter().filter(|p| ratio(p.lift) <= 0.0).map(|p| p.theta).collect();
    let (from, to) = stretch(&bad, worst);
    let reference = samples.smallest(|l| {
        if linkage.roller > 0.0 { -shift * linkage.frenet(l).k } else { linkage.frenet(l).speed }
    });
    let radius = if linkage.roller > 0.0 { -linkage.roller / reference.value } else { reference.value };
    let smallest_base = Criterion::Undercut.smallest_base(definition, samples);
    Some(CamIssue::Undercut { flank, at: worst.at, from, to, radius, roller: linkage.roller, smallest_base })
}

/// The run of bad samples around the worst one.
fn stretch(bad: &[f64], worst: Extreme) -> (Angle, Angle) {
    const GAP: f64 = 0.02;
    let here = worst.at.rad();
    let near = bad.partition_point(|t| *t < here);
    let mut from = here;
    for t in bad[..near].iter().rev().take_while(|t| **t > here - core::f64::consts::TAU) {
        if from - t > GAP {
            break;
        }
        from = *t;
    }
    let mut to = here;
    for t in &bad[near..] {
        if t - to > GAP {
            break;
        }
        to = *t;
    }
    (Angle::radians(from), Angle::radians(to))
}

/// Crossing flanks: errors that no curvature shows.
pub(super) fn global_errors(cam: &Cam) -> Vec<CamIssue> {
    cam.definition.flanks().iter().filter_map(|flank| flank_crossing(cam, *flank, 0.0)).collect()
}

/// The first crossing of the curve at `offset` mm off a flank.
pub(super) fn flank_crossing(cam: &Cam, flank: Flank, offset: f64) -> Option<CamIssue> {
    let curve = cam.centre_curve(flank, offset);
    if crossing::is_star_shaped(&curve, &cam.sample_parameters()) {
        return None;
    }
    let chord = CROSSING_CHORD * cam.figures.inner.farthest.value;
    let hit = crossing::self_crossings(&curve as &dyn PlanarCurve, chord).into_iter().next()?;
    let angle = |u: f64| cam.cam_angle(u);
    Some(CamIssue::SelfIntersection {
        flank,
        offset,
        at: hit.p,
        first: angle(hit.u.0),
        second: angle(hit.u.1),
    })
}

/// What is worth a warning.
pub(super) fn warnings(
    definition: &CamDefinition,
    figures: &CamFigures,
    smallest_base: impl Fn() -> Option<f64>,
) -> Vec<CamIssue> {
    let limit = definition.max_pressure_angle;
    let found = figures.pressure_angle;
    if found.value <= limit.rad() + PRESSURE_ROUNDING {
        return Vec::new();
    }
    let angle = Angle::radians(found.value);
    vec![CamIssue::PressureAngle { at: found.at, angle, limit, smallest_base: smallest_base() }]
}
