//! Fewest primitives in a tolerance band, vertices on the controller's decimal grid.
//!
//! The problem: an exact directed curve, a band of allowed signed normal deviation about it (left positive),
//! and a grid. Find a chain of primitives (lines, tangent-continuous arcs, Archimedean spirals, NURBS) with
//! all its *printed* numbers on the grid, that stays in the band, covers the whole curve and has the fewest
//! members; among equals, the smallest deviation. Say the proven lower bound beside it.

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
