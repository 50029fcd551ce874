//! Cubic Bézier pieces in integers: ends on the grid, inner control points finer.
//!
//! The inner points go with the ends they belong to, so that pieces which join smoothly do so after rounding, up to the
//! finer steps. By the convex hull a rounded piece is no further off than its ends.

use super::fit::Primitive;
use crate::cl::spline::ORDER;
use crate::geom::Point3;
use crate::target::{Nurbs, Position, number};

/// Knots of one piece.
pub(super) const KNOTS: [f64; 2 * ORDER] = [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];

/// Control points of a segment (mm) in steps of `step`/10^`finer`, between two ends in steps of `step`, mm.
///
/// `None` beyond what integers hold.
pub(super) fn rounded(
    segment: &[Point3; ORDER],
    ends: [[i64; 3]; 2],
    step: f64,
    finer: u8,
) -> Option<[[i64; 3]; ORDER]> {
    let fine = (0..finer).try_fold(1_i64, |factor, _| factor.checked_mul(10))?;
    let end = |at: [i64; 3]| -> Option<[i64; 3]> {
        let [x, y, z] = at.map(|v| v.checked_mul(fine));
        Some([x?, y?, z?])
    };
    let [a, b, c, d] = segment;
    let (from, to) = (end(ends[0])?, end(ends[1])?);
    let beside = |at: [i64; 3], leg: crate::geom::Vec3| -> Option<[i64; 3]> {
        let [x, y, z] = [(at[0], leg.x), (at[1], leg.y), (at[2], leg.z)]
            .map(|(at, leg)| at.checked_add(number::steps(leg / step, finer)?));
        Some([x?, y?, z?])
    };
    Some([from, beside(from, b - a)?, beside(to, c - d)?, to])
}

/// One piece through rounded control points, with the table at `r`.
pub(super) fn nurbs(points: [[i64; 3]; ORDER], r: i64, finer: u8) -> Nurbs {
    let point = |[x, y, z]: [i64; 3]| (Position { x, y, z, r }, 1.0);
    Nurbs { order: ORDER as u8, points: points.map(point).to_vec(), knots: KNOTS.to_vec(), finer }
}

/// Whether the coefficients of a piece's polynomials, from either end, are `largest` fine steps at most.
pub(super) fn fits(piece: &Nurbs, largest: i64) -> bool {
    let [a, b, c, d] = *piece.points else { return true };
    let axis = |of: fn(&Position) -> i64| {
        let [a, b, c, d] = [a, b, c, d].map(|(p, _)| i128::from(of(&p)));
        [3 * (b - a), 3 * (a - 2 * b + c), d - 3 * c + 3 * b - a, 3 * (b - 2 * c + d), 3 * (c - d)]
    };
    let all = [axis(|p| p.x), axis(|p| p.y), axis(|p| p.z)];
    all.iter().flatten().all(|v| v.abs() <= i128::from(largest))
}

/// Upper bound of the distance of a segment from its chords over `step` of the parameter, mm: an eighth of the square of the
/// step times the largest second derivative.
pub(super) fn sagitta([a, b, c, d]: &[Point3; ORDER], step: f64) -> f64 {
    let bend = |p: &Point3, q: &Point3, r: &Point3| ((p - q) + (r - q)).norm();
    step * step / 8.0 * 6.0 * bend(a, b, c).max(bend(b, c, d))
}

/// The two halves of a segment, by de Casteljau's scheme.
pub(super) fn halves([a, b, c, d]: [Point3; ORDER]) -> [[Point3; ORDER]; 2] {
    let mid = |p: Point3, q: Point3| p + (q - p) * 0.5;
    let (ab, bc, cd) = (mid(a, b), mid(b, c), mid(c, d));
    let (abc, bcd) = (mid(ab, bc), mid(bc, cd));
    let middle = mid(abc, bcd);
    [[a, ab, abc, middle], [middle, bcd, cd, d]]
}

/// The pieces of a fitted curve whose inner knots are threefold, at the height and table position of `at`.
pub(super) fn of_fitted(points: &[([i64; 2], f64)], at: Position, finer: u8) -> Vec<Nurbs> {
    let z = (0..finer).fold(at.z, |z, _| z.saturating_mul(10));
    let lift = |&([x, y], _): &([i64; 2], f64)| [x, y, z];
    let starts = (0..points.len().saturating_sub(1)).step_by(ORDER - 1);
    let piece = |i: usize| match points.get(i..i + ORDER)? {
        [a, b, c, d] => Some(nurbs([a, b, c, d].map(lift), at.r, finer)),
        _ => None,
    };
    starts.filter_map(piece).collect()
}

/// Blocks of a fitted curve: one a control point, or one a piece.
pub(super) fn blocks(primitive: &Primitive) -> usize {
    match primitive {
        Primitive::Nurbs { points, pieces: Some(_), .. } => points.len() / (ORDER - 1),
        Primitive::Nurbs { points, .. } => points.len(),
        Primitive::Line { .. } | Primitive::Arc { .. } | Primitive::Spiral { .. } => 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn segment() -> [Point3; ORDER] {
        [
            Point3::new(0.0004, 0.0, 0.0),
            Point3::new(1.0, 2.0, 0.0),
            Point3::new(3.0, 2.0, -0.5),
            Point3::new(4.0, 0.0, -1.0),
        ]
    }

    #[test]
    fn inner_points_go_with_the_ends_they_belong_to() {
        let points = rounded(&segment(), [[0, 0, 0], [4000, 0, -1000]], 1e-3, 2).unwrap();
        assert_eq!(points[0], [0, 0, 0]);
        // 0.9996 mm on from the start, not 1 mm.
        assert_eq!(points[1], [99_960, 200_000, 0]);
        assert_eq!(points[2..], [[300_000, 200_000, -50_000], [400_000, 0, -100_000]]);
        assert_eq!(rounded(&segment(), [[i64::MAX, 0, 0]; 2], 1e-3, 2), None);
        assert_eq!(rounded(&segment(), [[0; 3]; 2], 1e-15, 2), None);
    }

    #[test]
    fn coefficients_from_either_end_are_bounded() {
        let piece = nurbs([[0, 0, 0], [1, 0, 0], [2, 0, 0], [30, 0, 0]], 0, 0);
        // 3 (c - d) = -84 is the largest of them.
        assert!(fits(&piece, 84) && !fits(&piece, 83));
    }

    #[test]
    fn halves_join_in_the_middle() {
        let [left, right] = halves(segment());
        assert_eq!((left[0], left[3], right[3]), (segment()[0], right[0], segment()[3]));
        let middle = segment().iter().zip([1.0, 3.0, 3.0, 1.0]).fold(0.0, |s, (p, w)| s + p.y * w / 8.0);
        assert!((left[3].y - middle).abs() < 1e-15);
    }
}
