//! Figures of a plate cam.

use super::curve::{CamCurve, Geometry};
use super::{CamDefinition, Flank};
use crate::geom::curve::{PlanarCurve, spans};
use crate::geom::extremum::golden;
use crate::geom::measure;
use crate::geom::motion::Lift;
use crate::math::{TAU, hypot};
use crate::units::Angle;

/// Length and area are good to this many mm and mm².
pub const FIGURE_ACCURACY: f64 = 1e-9;

/// A value and the cam angle where it occurs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// Where.
    pub at: Angle,
}

/// Figures of one flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlankFigures {
    /// Smallest radius of curvature where the flank is convex (bulges out of the material), mm.
    pub convex: Option<Extreme>,
    /// Smallest radius of curvature where it is concave, mm.
    pub concave: Option<Extreme>,
    /// Length, mm.
    pub length: f64,
    /// Area inside, mm².
    pub area: f64,
    /// Smallest distance from the centre, mm.
    pub nearest: Extreme,
    /// Largest distance from the centre, mm.
    pub farthest: Extreme,
}

/// Where a flat face is touched, mm along the face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaceContact {
    /// Lowest.
    pub from: Extreme,
    /// Highest.
    pub to: Extreme,
}

impl FaceContact {
    /// The width that the contact runs over, mm.
    #[must_use]
    pub fn width(&self) -> f64 {
        self.to.value - self.from.value
    }
}

/// Peak motion of the follower at a speed; m and radians for the lift's mm and radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dynamics {
    /// Velocity, mm/s or rad/s.
    pub velocity: f64,
    /// Acceleration, m/s² or rad/s².
    pub acceleration: f64,
    /// Jerk, m/s³ or rad/s³; without the shocks where the acceleration jumps.
    pub jerk: f64,
}

/// Figures of a cam.
#[derive(Debug, Clone, PartialEq)]
pub struct CamFigures {
    /// Largest pressure angle, radians, without its sign.
    pub pressure_angle: Extreme,
    /// The profile, or inner flank of a groove.
    pub inner: FlankFigures,
    /// The outer flank of a groove.
    pub outer: Option<FlankFigures>,
    /// The contact on a flat face.
    pub face: Option<FaceContact>,
    /// Largest lift, mm or rad.
    pub lift: Extreme,
    /// Largest velocity without its sign, per rad.
    pub velocity: Extreme,
    /// Largest acceleration without its sign, per rad².
    pub acceleration: Extreme,
    /// Largest jerk without its sign, per rad³, without the shocks where the acceleration jumps.
    pub jerk: Extreme,
    /// Peaks at the cam's speed, if one is given.
    pub dynamics: Option<Dynamics>,
}

impl CamFigures {
    /// Figures of a flank.
    #[must_use]
    pub fn flank(&self, flank: Flank) -> Option<&FlankFigures> {
        match flank {
            Flank::Inner => Some(&self.inner),
            Flank::Outer => self.outer.as_ref(),
        }
    }
}

/// Motion and reference curve, sampled over the turn; curvature and radius do not depend on the frame.
pub(super) struct Samples<'a> {
    geometry: &'a Geometry,
    points: Vec<Sample>,
}

#[derive(Clone, Copy)]
pub(super) struct Sample {
    pub(super) span: usize,
    pub(super) theta: f64,
    pub(super) lift: Lift,
}

impl<'a> Samples<'a> {
    /// At least every half degree, and both ends of every analytic span.
    pub(super) fn new(geometry: &'a Geometry) -> Samples<'a> {
        const STEPS_A_TURN: f64 = 720.0;
        const FEWEST: usize = 4;
        let mut points = Vec::new();
        for (span, w) in geometry.motion.breaks().windows(2).enumerate() {
            let steps = (((w[1] - w[0]) / TAU * STEPS_A_TURN).ceil() as usize).max(FEWEST);
            for i in 0..=steps {
                let theta = if i == steps { w[1] } else { w[0] + (w[1] - w[0]) * i as f64 / steps as f64 };
                points.push(Sample { span, theta, lift: geometry.motion.at_in(span, theta) });
            }
        }
        Samples { geometry, points }
    }
    pub(super) fn points(&self) -> &[Sample] {
        &self.points
    }
    /// The largest value of a function of the lift, refined between the samples beside it.
    pub(super) fn largest(&self, f: impl Fn(Lift) -> f64) -> Extreme {
        let Some((index, value)) = self
            .points
            .iter()
            .map(|p| f(p.lift))
            .enumerate()
            .max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)))
        else {
            return Extreme { value: 0.0, at: Angle::radians(0.0) };
        };
        let here = self.points[index];
        let beside = |i: Option<usize>| {
            i.and_then(|i| self.points.get(i)).filter(|p| p.span == here.span).map_or(here.theta, |p| p.theta)
        };
        let (a, b) = (beside(index.checked_sub(1)), beside(Some(index + 1)));
        let (theta, refined) = golden(|theta| f(self.geometry.motion.at_in(here.span, theta)), a, b);
        // Rounding alone must not move a value that is reached at a sample, at the end of a dwell say.
        if refined > value + 4.0 * f64::EPSILON * value.abs() {
            Extreme { value: refined, at: Angle::radians(theta) }
        } else {
            Extreme { value, at: Angle::radians(here.theta) }
        }
    }
    pub(super) fn smallest(&self, f: impl Fn(Lift) -> f64) -> Extreme {
        let e = self.largest(|l| -f(l));
        Extreme { value: -e.value, at: e.at }
    }
}

impl CamFigures {
    pub(super) fn new(
        definition: &CamDefinition,
        geometry: &Geometry,
        samples: &Samples,
        curve: impl Fn(Flank) -> CamCurve,
    ) -> CamFigures {
        let linkage = geometry.linkage;
        let flank = |flank: Flank| flank_figures(samples, geometry, &curve(flank), flank);
        let velocity = samples.largest(|l| l.v.abs());
        let acceleration = samples.largest(|l| l.a.abs());
        let jerk = samples.largest(|l| l.j.abs());
        let contact = |l: Lift| linkage.face_contact(l).unwrap_or(0.0);
        CamFigures {
            pressure_angle: samples.largest(|l| linkage.pressure_angle(l).abs()),
            inner: flank(Flank::Inner),
            outer: definition.groove.then(|| flank(Flank::Outer)),
            face: (!definition.follower.has_roller())
                .then(|| FaceContact { from: samples.smallest(contact), to: samples.largest(contact) }),
            lift: samples.largest(|l| l.s),
            velocity,
            acceleration,
            jerk,
            dynamics: definition.speed.map(|rpm| dynamics(definition, rpm, velocity, acceleration, jerk)),
        }
    }
}

fn dynamics(definition: &CamDefinition, rpm: f64, v: Extreme, a: Extreme, j: Extreme) -> Dynamics {
    const MM_PER_M: f64 = 1000.0;
    let w = rpm * TAU / 60.0;
    let per_metre = if definition.follower.oscillates() { 1.0 } else { MM_PER_M };
    Dynamics {
        velocity: v.value * w,
        acceleration: a.value * w * w / per_metre,
        jerk: j.value * w * w * w / per_metre,
    }
}

fn flank_figures(samples: &Samples, geometry: &Geometry, curve: &CamCurve, flank: Flank) -> FlankFigures {
    let (shift, sign) = (flank.shift(geometry.linkage.roller), flank.convex_sign());
    let at = |l: Lift| geometry.linkage.frenet(l).offset(shift);
    let radius = |l: Lift| {
        let p = at(l).p;
        hypot(p.x, p.y)
    };
    let convex = samples.largest(|l| sign * at(l).k);
    let concave = samples.largest(|l| -sign * at(l).k);
    let as_radius = |e: Extreme| (e.value > 0.0).then(|| Extreme { value: 1.0 / e.value, at: e.at });
    let share = FIGURE_ACCURACY / spans(curve).count().max(1) as f64;
    FlankFigures {
        convex: as_radius(convex),
        concave: as_radius(concave),
        length: measure::length(curve as &dyn PlanarCurve, share),
        area: measure::signed_area(curve as &dyn PlanarCurve, share),
        nearest: samples.smallest(radius),
        farthest: samples.largest(radius),
    }
}
