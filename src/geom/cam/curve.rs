//! The curves of a plate cam: pitch curve, flanks, cutter-centre curves.

use std::sync::Arc;

use crate::geom::curve::{Frenet, PlanarCurve, Shape, span_of};
use crate::geom::follower::Linkage;
use crate::geom::motion::Motion;
use crate::geom::{Point2, Vec2};
use crate::math::{TAU, sin_cos};

/// What all curves of a cam share.
#[derive(Debug, Clone)]
pub(crate) struct Geometry {
    pub(crate) linkage: Linkage,
    pub(crate) motion: Motion,
    /// The cam turns counter-clockwise: everything is mirrored in the x axis.
    pub(crate) mirrored: bool,
    /// Parameters that bound the analytic spans.
    breaks: Vec<f64>,
    /// Circles that spans of the reference curve lie on.
    circles: Vec<Option<(Point2, f64)>>,
}

impl Geometry {
    pub(crate) fn new(linkage: Linkage, motion: Motion, mirrored: bool) -> Geometry {
        let mut breaks: Vec<f64> = motion.breaks().to_vec();
        if mirrored {
            breaks = breaks.iter().rev().map(|b| TAU - b).collect();
        }
        let mut geometry = Geometry { linkage, motion, mirrored, breaks, circles: Vec::new() };
        geometry.circles =
            (0..geometry.breaks.len().saturating_sub(1)).map(|span| geometry.circle(span)).collect();
        geometry
    }
    /// Cam angle and motion span at parameter u in curve span `span`.
    fn cam_angle(&self, span: usize, u: f64) -> (usize, f64) {
        if self.mirrored { (self.breaks.len() - 2 - span, TAU - u) } else { (span, u) }
    }
    /// Frenet data of the reference curve in the part, directed counter-clockwise.
    fn reference(&self, span: usize, u: f64) -> Frenet {
        let (motion_span, theta) = self.cam_angle(span, u);
        let local = self.linkage.frenet(self.motion.at_in(motion_span, theta));
        let (s, c) = sin_cos(theta);
        let turn = |x: f64, y: f64| Vec2::new(c * x - s * y, s * x + c * y);
        let (p, t) = (turn(local.p.x, local.p.y), turn(local.t.x, local.t.y));
        if self.mirrored {
            return Frenet { p: Point2::new(p.x, -p.y), t: Vec2::new(-t.x, t.y), ..local };
        }
        Frenet { p: Point2::from(p), t, ..local }
    }
    /// The circle of a span: about the cam's centre in a dwell, about any point where the curvature is
    /// constant (a flat face in simple harmonic motion over half a turn).
    fn circle(&self, span: usize) -> Option<(Point2, f64)> {
        /// Curvatures of an analytic span that agree this well at all samples are one.
        const SAME: f64 = 1e-12;
        const SAMPLES: u32 = 7;
        let (a, b) = (self.breaks[span], self.breaks[span + 1]);
        let (motion_span, _) = self.cam_angle(span, a);
        let first = self.reference(span, a);
        if self.motion.is_dwell(motion_span) {
            return Some((Point2::origin(), crate::math::hypot(first.p.x, first.p.y)));
        }
        let same = |f: Frenet| (f.k - first.k).abs() <= SAME * first.k.abs() && f.speed > 0.0;
        let constant = (1..=SAMPLES)
            .all(|i| same(self.reference(span, a + (b - a) * f64::from(i) / f64::from(SAMPLES))));
        (constant && first.k > 0.0).then(|| (first.p + first.n() / first.k, 1.0 / first.k))
    }
}

/// A curve parallel to a cam's reference curve (its pitch curve, or the profile of a flat face), directed
/// counter-clockwise in the part. The parameter is the polar angle of the follower's line in the part, radians.
#[derive(Debug, Clone)]
pub struct CamCurve {
    geometry: Arc<Geometry>,
    /// Distance to the left of the reference curve, mm.
    distance: f64,
}

impl CamCurve {
    pub(crate) fn new(geometry: Arc<Geometry>, distance: f64) -> CamCurve {
        CamCurve { geometry, distance }
    }
}

impl PlanarCurve for CamCurve {
    fn domain(&self) -> (f64, f64) {
        (0.0, TAU)
    }
    fn at(&self, u: f64) -> Frenet {
        self.at_in(span_of(&self.geometry.breaks, u), u)
    }
    fn at_in(&self, span: usize, u: f64) -> Frenet {
        self.geometry.reference(span, u).offset(self.distance)
    }
    fn breaks(&self) -> &[f64] {
        &self.geometry.breaks
    }
    fn shape(&self, span: usize) -> Shape {
        match self.geometry.circles.get(span) {
            Some(Some((centre, radius))) if radius - self.distance > 0.0 => {
                Shape::Arc { centre: *centre, radius: radius - self.distance, ccw: true }
            }
            _ => Shape::General,
        }
    }
    fn is_closed(&self) -> bool {
        true
    }
}
