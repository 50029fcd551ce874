//! Plate cams: profile, pitch curve, checks and figures.
//!
//! # Conventions
//! The cam's centre is the origin. At cam angle 0 the follower acts along +X. A cam that turns clockwise sees
//! the follower's line at polar angle +t at cam angle t; one that turns counter-clockwise is the mirror image
//! in the x axis, its follower included. All curves are directed counter-clockwise in the part, and their
//! parameter is the polar angle of the follower's line.

use std::sync::Arc;

mod checks;
mod curve;
mod figures;
#[cfg(test)]
mod tests;

pub use curve::CamCurve;
pub use figures::{CamFigures, Dynamics, Extreme, FIGURE_ACCURACY, FaceContact, FlankFigures};

use super::curve::{CurveRef, Frenet, PlanarCurve, spans};
use super::follower::{Follower, Linkage};
use super::motion::{Lift, Motion};
use super::{Point2, Side, Vec2};
use crate::math::TAU;
use crate::units::Angle;
use curve::Geometry;
use figures::Samples;

/// Which flank of a cam.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
pub enum Flank {
    /// The profile that the roller or face runs on from outside; the inner flank of a groove.
    Inner,
    /// The outer flank of a groove.
    Outer,
}

impl Flank {
    /// Left offset of the flank from the pitch curve of a roller.
    fn shift(self, roller: f64) -> f64 {
        match self {
            Flank::Inner => roller,
            Flank::Outer => -roller,
        }
    }
    /// Sign of the curvature where the flank is convex.
    fn convex_sign(self) -> f64 {
        match self {
            Flank::Inner => 1.0,
            Flank::Outer => -1.0,
        }
    }
    /// The side of the directed flank on which the material lies.
    #[must_use]
    pub const fn material(self) -> Side {
        match self {
            Flank::Inner => Side::Left,
            Flank::Outer => Side::Right,
        }
    }
}

/// Which way the cam turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Rotation {
    /// Clockwise: the paper's.
    #[default]
    Clockwise,
    /// Counter-clockwise: the mirror image.
    CounterClockwise,
}

/// Lengths (mm) and speeds (rpm) beyond this are no cam's.
pub const LARGEST_VALUE: f64 = 1e9;

/// What makes a cam.
#[derive(Debug, Clone, PartialEq)]
pub struct CamDefinition {
    /// r_b: smallest radius of the profile, mm.
    pub base: f64,
    /// The follower.
    pub follower: Follower,
    /// Its motion.
    pub motion: Motion,
    /// Which way the cam turns.
    pub rotation: Rotation,
    /// Both flanks of a groove.
    pub groove: bool,
    /// Revolutions per minute.
    pub speed: Option<f64>,
    /// `MAXPA`: the pressure angle from which on a warning is given.
    pub max_pressure_angle: Angle,
}

impl CamDefinition {
    /// A clockwise plate cam without speed, with the usual limit of 30 degrees.
    #[must_use]
    pub fn new(base: f64, follower: Follower, motion: Motion) -> CamDefinition {
        CamDefinition {
            base,
            follower,
            motion,
            rotation: Rotation::Clockwise,
            groove: false,
            speed: None,
            max_pressure_angle: Angle::degrees(30.0),
        }
    }
    /// The flanks that are cut.
    #[must_use]
    pub fn flanks(&self) -> &'static [Flank] {
        if self.groove { &[Flank::Inner, Flank::Outer] } else { &[Flank::Inner] }
    }
}

/// What is wrong with, or to be known of, a cam. Lengths in mm.
#[derive(Debug, Clone, PartialEq)]
pub enum CamIssue {
    /// A value must be over 0 and at most [`LARGEST_VALUE`].
    NotPositive {
        /// Which.
        what: &'static str,
        /// Its value, mm or rpm.
        value: f64,
    },
    /// A groove holds a roller; a flat face has no second flank.
    GrooveNeedsRoller,
    /// The follower's line passes the centre at more than base plus roller radius.
    OffsetTooLarge {
        /// The offset e.
        offset: f64,
        /// It must be smaller than this.
        limit: f64,
    },
    /// The arm cannot put the follower on the base circle.
    ArmDoesNotReach {
        /// The base radius.
        base: f64,
        /// It must be larger than this …
        smallest: f64,
        /// … and smaller than this.
        largest: f64,
    },
    /// An oscillating follower swings past what its linkage allows.
    SwingsTooFar {
        /// Cam angle.
        at: Angle,
        /// Angle between the arm (or face) and the line from pivot to centre.
        angle: Angle,
        /// It must be smaller than this.
        limit: Angle,
    },
    /// The flank runs backwards: the follower would cut away what it has to run on.
    Undercut {
        /// The flank.
        flank: Flank,
        /// Cam angle of the worst place.
        at: Angle,
        /// Where it starts …
        from: Angle,
        /// … and ends, to half a degree.
        to: Angle,
        /// The smallest radius of curvature of the pitch curve (a roller), or of the profile (a flat face;
        /// negative).
        radius: f64,
        /// Roller radius that it must exceed; 0 for a flat face.
        roller: f64,
        /// The smallest base radius without undercut, if there is one.
        smallest_base: Option<f64>,
    },
    /// A flank, or the cutter's path along it, crosses itself.
    SelfIntersection {
        /// The flank.
        flank: Flank,
        /// Distance of the curve from the flank, into the air: 0 for the flank itself.
        offset: f64,
        /// Where.
        at: Point2,
        /// Cam angle of one branch …
        first: Angle,
        /// … and the other.
        second: Angle,
    },
    /// The pressure angle is over its limit: a warning.
    PressureAngle {
        /// Cam angle.
        at: Angle,
        /// The largest pressure angle.
        angle: Angle,
        /// The limit.
        limit: Angle,
        /// The smallest base radius that keeps it, if there is one.
        smallest_base: Option<f64>,
    },
    /// The cutter does not fit a concave part of the flank.
    CutterTooLarge {
        /// The flank.
        flank: Flank,
        /// The cutter's radius plus what is left on the flank.
        radius: f64,
        /// The largest that fits.
        limit: CutterLimit,
    },
}

impl CamIssue {
    /// Whether there is no cam because of it.
    #[must_use]
    pub fn is_error(&self) -> bool {
        !matches!(self, CamIssue::PressureAngle { .. })
    }
}

/// The largest cutter for a flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CutterLimit {
    /// The cutter's radius must be smaller than this, mm; infinite where nothing is concave.
    pub radius: f64,
    /// The cam angle of the place that sets the limit.
    pub at: Option<Angle>,
}

/// A plate cam, checked and ready for use.
#[derive(Debug, Clone)]
pub struct Cam {
    definition: Arc<CamDefinition>,
    geometry: Arc<Geometry>,
    figures: Arc<CamFigures>,
    issues: Vec<CamIssue>,
}

impl Cam {
    /// Computes a cam and checks it.
    ///
    /// # Errors
    /// Every issue that leaves no cam.
    pub fn new(definition: CamDefinition) -> Result<Cam, Vec<CamIssue>> {
        let issues = checks::value_issues(&definition);
        if !issues.is_empty() {
            return Err(issues);
        }
        let linkage = Linkage::new(&definition.follower, definition.base).map_err(|issue| vec![issue])?;
        let mirrored = definition.rotation == Rotation::CounterClockwise;
        let geometry = Arc::new(Geometry::new(linkage, definition.motion.clone(), mirrored));
        let samples = Samples::new(&geometry);
        let issues = checks::local_errors(&definition, &linkage, &samples);
        if !issues.is_empty() {
            return Err(issues);
        }
        let curve = |flank: Flank| CamCurve::new(geometry.clone(), flank.shift(linkage.roller));
        let figures = Arc::new(CamFigures::new(&definition, &geometry, &samples, curve));
        let mut cam =
            Cam { definition: Arc::new(definition), geometry: geometry.clone(), figures, issues: Vec::new() };
        let issues = checks::global_errors(&cam);
        if !issues.is_empty() {
            return Err(issues);
        }
        cam.issues = checks::warnings(&cam.definition, &cam.figures, || cam.smallest_base());
        Ok(cam)
    }
    /// What makes it.
    #[must_use]
    pub fn definition(&self) -> &CamDefinition {
        &self.definition
    }
    /// What is to be known of it: warnings, since it exists.
    #[must_use]
    pub fn issues(&self) -> &[CamIssue] {
        &self.issues
    }
    /// Its figures.
    #[must_use]
    pub fn figures(&self) -> &CamFigures {
        &self.figures
    }
    /// The exact flank, directed counter-clockwise in the part.
    #[must_use]
    pub fn flank(&self, flank: Flank) -> CurveRef {
        self.centre(flank, 0.0)
    }
    /// The exact curve at `offset` mm off the flank into the air: the path of the centre of a cutter whose
    /// radius plus allowance is `offset`. Directed counter-clockwise in the part.
    #[must_use]
    pub fn centre(&self, flank: Flank, offset: f64) -> CurveRef {
        Arc::new(self.centre_curve(flank, offset))
    }
    fn centre_curve(&self, flank: Flank, offset: f64) -> CamCurve {
        let shift = flank.shift(self.geometry.linkage.roller) - flank.convex_sign() * offset;
        CamCurve::new(self.geometry.clone(), shift)
    }
    /// The path of the roller's centre in the part; the profile of a flat face.
    #[must_use]
    pub fn pitch(&self) -> CurveRef {
        Arc::new(CamCurve::new(self.geometry.clone(), 0.0))
    }
    /// The side of a directed flank on which the material lies.
    #[must_use]
    pub fn material(&self, flank: Flank) -> Side {
        flank.material()
    }
    /// The follower's lift at a cam angle.
    #[must_use]
    pub fn lift(&self, theta: Angle) -> Lift {
        self.definition.motion.at(theta)
    }
    /// Pressure angle at a cam angle, signed: positive on the side that grows with the rise's velocity.
    #[must_use]
    pub fn pressure_angle(&self, theta: Angle) -> Angle {
        Angle::radians(self.geometry.linkage.pressure_angle(self.lift(theta)))
    }
    /// Pressure angle that belongs to a lift and its velocity.
    #[must_use]
    pub fn pressure_angle_of(&self, lift: Lift) -> Angle {
        Angle::radians(self.geometry.linkage.pressure_angle(lift))
    }
    /// Frenet data of a flank at a cam angle.
    #[must_use]
    pub fn contact(&self, flank: Flank, theta: Angle) -> Frenet {
        let u = self.parameter(theta);
        self.centre_curve(flank, 0.0).at(u)
    }
    /// The curves' parameter at a cam angle.
    #[must_use]
    pub fn parameter(&self, theta: Angle) -> f64 {
        let theta = theta.rad();
        let theta = if (0.0..=TAU).contains(&theta) { theta } else { theta - TAU * (theta / TAU).floor() };
        if self.geometry.mirrored { TAU - theta } else { theta }
    }
    /// The cam angle of a curve's parameter.
    #[must_use]
    pub fn cam_angle(&self, u: f64) -> Angle {
        Angle::radians(if self.geometry.mirrored { TAU - u } else { u })
    }
    /// Where the follower stands at cam angle 0, in the part: pivot, roller centre or point of the face,
    /// direction of the face.
    #[must_use]
    pub fn follower_at_zero(&self) -> FollowerPosture {
        let posture = self.geometry.linkage.posture(self.lift(Angle::radians(0.0)));
        let flip = if self.geometry.mirrored { -1.0 } else { 1.0 };
        FollowerPosture {
            pivot: posture.pivot,
            tip: Point2::new(posture.tip.x, flip * posture.tip.y),
            face: posture.face.map(|f| Vec2::new(f.x, flip * f.y)),
        }
    }
    /// The largest cutter that can cut a flank whole.
    ///
    /// Local curvature, then crossings of the centre path, found to a thousandth of the radius.
    #[must_use]
    pub fn max_cutter(&self, flank: Flank) -> CutterLimit {
        let concave = self.figures.flank(flank).and_then(|f| f.concave);
        let groove = self.definition.groove.then(|| self.geometry.linkage.roller);
        let local = CutterLimit {
            radius: concave.map_or(f64::INFINITY, |c| c.value).min(groove.unwrap_or(f64::INFINITY)),
            at: concave.filter(|c| groove.is_none_or(|g| c.value <= g)).map(|c| c.at),
        };
        if !local.radius.is_finite() { local } else { self.without_crossing(flank, local) }
    }
    fn without_crossing(&self, flank: Flank, local: CutterLimit) -> CutterLimit {
        const ACCURACY: f64 = 1e-3;
        const JUST_BELOW: f64 = 1.0 - 1e-9;
        let crossing = |offset: f64| checks::flank_crossing(self, flank, offset);
        let Some(CamIssue::SelfIntersection { first, .. }) = crossing(local.radius * JUST_BELOW) else {
            return local;
        };
        let (mut fits, mut crosses, mut at) = (0.0, local.radius, first);
        while crosses - fits > ACCURACY * local.radius {
            let mid = 0.5 * (fits + crosses);
            match crossing(mid) {
                Some(CamIssue::SelfIntersection { first, .. }) => (crosses, at) = (mid, first),
                _ => fits = mid,
            }
        }
        CutterLimit { radius: fits, at: Some(at) }
    }
    /// Whether a cutter of this radius (plus allowance) cannot cut a flank whole.
    #[must_use]
    pub fn cutter_issue(&self, flank: Flank, radius: f64) -> Option<CamIssue> {
        let concave = self.figures.flank(flank).and_then(|f| f.concave);
        let groove = self.definition.groove.then(|| self.geometry.linkage.roller);
        let too_curved = concave.is_some_and(|c| radius >= c.value) || groove.is_some_and(|g| radius > g);
        if !too_curved && concave.is_none() {
            return None;
        }
        let too_large = too_curved || checks::flank_crossing(self, flank, radius).is_some();
        too_large.then(|| CamIssue::CutterTooLarge { flank, radius, limit: self.max_cutter(flank) })
    }
    /// Spans and parameters, half a degree apart, at which curves of this cam are looked at.
    fn sample_parameters(&self) -> Vec<(usize, f64)> {
        const STEP: f64 = TAU / 720.0;
        let curve = self.centre_curve(Flank::Inner, 0.0);
        spans(&curve)
            .flat_map(|(span, a, b)| {
                let steps = ((b - a) / STEP).ceil().max(2.0) as usize;
                (0..=steps).map(move |i| (span, a + (b - a) * i as f64 / steps as f64))
            })
            .collect()
    }
}

/// Where a follower stands in the part at cam angle 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FollowerPosture {
    /// Pivot of an oscillating follower, mm.
    pub pivot: Option<Point2>,
    /// Roller centre, or a point of the face, mm.
    pub tip: Point2,
    /// Unit direction of a flat face.
    pub face: Option<Vec2>,
}
