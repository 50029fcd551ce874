//! Measures of chains of points and of arcs in the plane.

use super::arcs::Piece;
use crate::geom::{Point2, Vec2};
use crate::math::TAU;

/// The place on a circle about `centre` in the direction of `p`.
pub(super) fn place_towards(centre: Point2, p: Point2, radius: f64) -> Point2 {
    let way = (p - centre).try_normalize(1e-9).unwrap_or_else(|| Vec2::new(1.0, 0.0));
    centre + way * radius
}

/// Angle from one arm to the other, more than 0 and at most a full turn.
pub(super) fn sweep((a, b): (Vec2, Vec2), ccw: bool) -> f64 {
    let angle = crate::math::atan2(crate::geom::cross(a, b), a.dot(&b));
    let angle = if ccw { angle } else { -angle };
    if angle <= 1e-9 { angle + TAU } else { angle }
}

/// Length of a piece, mm.
pub(super) fn length(from: Point2, piece: &Piece) -> f64 {
    match piece.arc {
        None => (piece.to - from).norm(),
        Some((centre, ccw)) => {
            let (a, b) = (from - centre, piece.to - centre);
            a.norm() * sweep((a, b), ccw)
        }
    }
}

/// Length of a closed ring, mm.
pub(super) fn around(points: &[Point2]) -> f64 {
    points.iter().zip(points.iter().cycle().skip(1)).map(|(a, b)| (b - a).norm()).sum()
}

/// Area that a closed ring encloses, mm², positive where it runs counter-clockwise.
pub(super) fn enclosed(points: &[Point2]) -> f64 {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| 0.5 * crate::geom::cross(a.coords, b.coords)).sum()
}

/// The point of a ring that is nearest to a place.
pub(super) fn closest(points: &[Point2], to: Point2) -> usize {
    let off = |k: &usize| (points[*k] - to).norm_squared();
    (0..points.len()).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0)
}

/// The nearest two of a cleared place and a point of a ring.
pub(super) fn pair(cleared: &[Point2], ring: &[Point2]) -> Option<(Point2, usize)> {
    // A place in so many is near enough.
    const PLACES: usize = 400;
    let stride = cleared.len() / PLACES + 1;
    let found = cleared.iter().step_by(stride).map(|p| {
        let k = closest(ring, *p);
        (*p, k, (ring[k] - p).norm())
    });
    found.min_by(|a, b| a.2.total_cmp(&b.2)).map(|(p, k, _)| (p, k))
}
