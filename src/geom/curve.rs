//! Directed planar curves: the one interface through which planning, fitting,
//! verification and plotting see exact geometry.
//!
//! A curve is described by its Frenet data, because that description is closed
//! under offsetting: an offset needs no further derivative ([`Frenet::offset`]).

use std::sync::Arc;

use super::{Point2, Vec2, left};

mod arc;
mod bezier;
mod chain;
mod moved;
mod offset;
mod part;
mod reversed;
mod segment;
mod spline;
#[cfg(test)]
pub(crate) mod testing;

pub use arc::CircularArc;
pub use bezier::{Bezier, bezier_chain};
pub use chain::{Chain, ChainError, Joint};
pub use moved::{Moved, Placement};
pub use offset::Offset;
pub use part::{Part, restarted};
pub use reversed::Reversed;
pub use segment::Segment;
pub use spline::{Ends, Spline, SplineError};

/// Point of a curve with its tangent and curvature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frenet {
    /// Position, mm.
    pub p: Point2,
    /// Unit tangent in the direction of travel.
    pub t: Vec2,
    /// Arc length per parameter, mm per unit of u; negative where an offset runs backwards (past a cusp).
    pub speed: f64,
    /// Signed curvature, 1/mm, positive when the curve turns left.
    pub k: f64,
}

impl Frenet {
    /// Left unit normal.
    #[must_use]
    pub fn n(&self) -> Vec2 {
        left(self.t)
    }
    /// The same point of the parallel curve at distance `d` mm to the left (negative: right):
    /// p + d n, same tangent, speed (1 - d k), curvature k/(1 - d k).
    #[must_use]
    pub fn offset(&self, d: f64) -> Frenet {
        let f = 1.0 - d * self.k;
        Frenet { p: self.p + self.n() * d, t: self.t, speed: self.speed * f, k: self.k / f }
    }
    /// The same point travelled the other way.
    #[must_use]
    pub fn reversed(&self) -> Frenet {
        Frenet { p: self.p, t: -self.t, speed: self.speed, k: -self.k }
    }
}

/// What is known of a smooth span of a curve, for consumers that can use more than samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// A straight line.
    Line,
    /// A circular arc about `centre`; `ccw` in the direction of travel.
    Arc {
        /// Centre, mm.
        centre: Point2,
        /// Radius, mm, positive.
        radius: f64,
        /// Counter-clockwise in the direction of travel.
        ccw: bool,
    },
    /// Anything else.
    General,
}

/// A directed planar curve, parameter u over [`PlanarCurve::domain`].
///
/// Between two neighbouring [`PlanarCurve::breaks`] the curve is analytic; at a break, position is
/// continuous, and tangent or curvature may jump. A closed curve ends where it starts.
pub trait PlanarCurve: core::fmt::Debug + Send + Sync {
    /// First and last parameter.
    fn domain(&self) -> (f64, f64);
    /// Frenet data at u. At a break, those of the span that starts there, except at the domain's end.
    fn at(&self, u: f64) -> Frenet;
    /// Frenet data at `u` seen from inside span `span` (index into the spans between breaks).
    fn at_in(&self, span: usize, u: f64) -> Frenet;
    /// Ascending parameters that bound the smooth spans, both ends of the domain included.
    fn breaks(&self) -> &[f64];
    /// Shape of the smooth span `span`.
    fn shape(&self, span: usize) -> Shape {
        let _ = span;
        Shape::General
    }
    /// Whether the curve ends where it starts.
    fn is_closed(&self) -> bool;
}

/// A shared curve.
pub type CurveRef = Arc<dyn PlanarCurve>;

/// Index of the smooth span that holds `u`: at a break the span that starts there, at and past the end the
/// last one, before the start the first one.
#[must_use]
pub fn span_of(breaks: &[f64], u: f64) -> usize {
    let last = breaks.len().saturating_sub(2);
    breaks.partition_point(|b| *b <= u).saturating_sub(1).min(last)
}

/// The smooth spans of a curve in order: index, first and last parameter.
pub fn spans(curve: &dyn PlanarCurve) -> impl Iterator<Item = (usize, f64, f64)> + '_ {
    curve.breaks().windows(2).enumerate().map(|(i, w)| (i, w[0], w[1]))
}

/// First and last point of a curve.
#[must_use]
pub fn ends(curve: &dyn PlanarCurve) -> (Point2, Point2) {
    let (a, b) = curve.domain();
    (curve.at(a).p, curve.at(b).p)
}

/// A parameter of a closed curve brought into its domain by whole turns; of an open curve, clamped to it.
#[must_use]
pub fn into_domain(curve: &dyn PlanarCurve, u: f64) -> f64 {
    let (a, b) = curve.domain();
    if (a..=b).contains(&u) {
        return u;
    }
    if !curve.is_closed() {
        return u.clamp(a, b);
    }
    let turns = ((u - a) / (b - a)).floor();
    (u - turns * (b - a)).clamp(a, b)
}
