//! Fewest primitives in a tolerance band, vertices on the controller's decimal grid.
//!
//! The problem: an exact directed curve, a band of allowed signed normal deviation about it (left positive),
//! and a grid. Find a chain of primitives (lines, tangent-continuous arcs, Archimedean spirals, NURBS) with
//! all its *printed* numbers on the grid, that stays in the band, covers the whole curve and has the fewest
//! members; among equals, the smallest deviation. Say the proven lower bound beside it.
//!
//! # Contract
//! - Every number of a [`Primitive`] is an integer of the [`Grid`]; a coordinate is `step * integer`.
//! - [`Fit::deviation`] is certified on those integers (never on the real numbers before rounding) and lies in the band.
//! - On a closed curve the last primitive ends at [`Fit::start`] (a spiral chain: a whole turn of the angle further).
//! - On an open curve the first and the last vertex lie in the band on the normals of the curve's ends, as near as the grid allows.

use core::fmt;

pub mod arcs;
pub mod bound;
mod certify;
mod chain;
mod ends;
mod guard;
mod lines;
pub mod measure;
mod near;
pub mod nurbs;
pub mod ribbon;
#[cfg(test)]
mod samples;
mod search;
mod spirals;
#[cfg(test)]
mod tests;
pub mod tube;
mod turns;
mod window;

pub use arcs::arcs;
pub use lines::lines;
pub use nurbs::{Knots, nurbs, nurbs_of};
pub use spirals::spirals;

use crate::geom::Point2;
use crate::geom::curve::PlanarCurve;

/// The curve and its band.
#[derive(Debug, Clone, Copy)]
pub struct Tube<'a> {
    /// Exact curve, directed.
    pub curve: &'a dyn PlanarCurve,
    /// How far the path may be to the left of the curve, mm, >= 0.
    pub left: f64,
    /// How far it may be to the right, mm, >= 0.
    pub right: f64,
}

/// The controller's decimal grid, as far as fitting must know it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// One step of a linear axis, mm.
    pub step: f64,
    /// One step of an arc-centre word, mm.
    pub centre_step: f64,
    /// One step of the rotary axis, degrees.
    pub angle_step: f64,
}

impl From<&crate::target::Grid> for Grid {
    fn from(grid: &crate::target::Grid) -> Grid {
        Grid { step: grid.linear_step(), centre_step: grid.centre_step(), angle_step: grid.rotary_step() }
    }
}

/// One motion of a fitted chain; it starts where the one before it ends.
#[derive(Debug, Clone, PartialEq)]
pub enum Primitive {
    /// Straight line.
    Line {
        /// End: x and y in linear steps.
        to: [i64; 2],
    },
    /// Circular arc.
    Arc {
        /// End: x and y in linear steps.
        to: [i64; 2],
        /// Centre minus start, in centre steps.
        centre: [i64; 2],
        /// Clockwise (G2).
        clockwise: bool,
    },
    /// Archimedean spiral about the origin: radius linear in the polar angle.
    Spiral {
        /// End: radius in linear steps, cutter polar angle in rotary steps, not reduced to one turn.
        to: [i64; 2],
    },
    /// NURBS curve; its first control point is the start.
    Nurbs {
        /// Degree + 1.
        order: u8,
        /// Control points in linear steps with their weights; in finer ones for `pieces`.
        points: Vec<([i64; 2], f64)>,
        /// Knots, points + order of them.
        knots: Vec<f64>,
        /// Bézier pieces, with inner knots threefold: the decimals that their control points have beyond the grid's.
        pieces: Option<u8>,
    },
}

/// A chain of primitives that stays in its band.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// First vertex: x and y in linear steps; for spirals radius in linear and angle in rotary steps.
    pub start: [i64; 2],
    /// The chain.
    pub primitives: Vec<Primitive>,
    /// Proven lower bound on the number of primitives of this class for this band, whatever the grid; of an open
    /// curve between the ends that the grid allows.
    pub lower_bound: Option<u32>,
    /// Largest certified deviation to the left and to the right of the curve, mm, both >= 0.
    pub deviation: (f64, f64),
}

/// Why a curve cannot be fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FitError {
    /// The band is narrower than the grid can follow.
    BandTooNarrow {
        /// Width of the band that would do, mm.
        needed: f64,
        /// Width of the band asked for, mm.
        have: f64,
        /// Where it fails, mm.
        at: Point2,
    },
    /// Arcs on the grid stay in the band, but not tangent-continuous with one radius each.
    GridTooCoarse {
        /// Largest tangent error at a joint, rad.
        kink: f64,
        /// Largest difference of the radii at an arc's ends, mm.
        mismatch: f64,
        /// Where the path is worst, mm.
        at: Point2,
    },
    /// A curve in polar coordinates must be seen from the origin in one sense of rotation.
    NotStarShaped {
        /// A point where the curve runs radially, backwards or through the origin, mm.
        at: Point2,
    },
    /// The curve has a cusp, a vanishing tangent or a number that is not finite.
    BadCurve {
        /// Parameter where it happens.
        u: f64,
    },
    /// A coordinate does not fit the grid's integers.
    TooLarge {
        /// Where, mm.
        at: Point2,
    },
}

impl fmt::Display for FitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FitError::BandTooNarrow { needed, have, at } => write!(
                f,
                "the band is {have:.6} mm wide, but the decimals of the control need about {needed:.6} mm near ({:.4}, {:.4}) mm",
                at.x, at.y
            ),
            FitError::GridTooCoarse { kink, mismatch, at } => write!(
                f,
                "arcs with the decimals of the control miss the tangent by {:.3} deg and a radius by {mismatch:.6} mm near ({:.4}, {:.4}) mm",
                kink / crate::math::DEG,
                at.x,
                at.y
            ),
            FitError::NotStarShaped { at } => write!(
                f,
                "the path is not seen from the rotary centre in one sense of rotation at ({:.4}, {:.4}) mm",
                at.x, at.y
            ),
            FitError::BadCurve { u } => write!(f, "the path has a cusp or no tangent at parameter {u:.6}"),
            FitError::TooLarge { at } => {
                write!(
                    f,
                    "the coordinate ({:.4}, {:.4}) mm is beyond the range of the control's numbers",
                    at.x, at.y
                )
            }
        }
    }
}

impl std::error::Error for FitError {}
