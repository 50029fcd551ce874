//! Lines and arcs through a chain of points, each as long as it stays near the points it passes.
//!
//! All circles through the ends P, Q of a piece, in coordinates x along PQ and y to its left, are x (c - x) - y² = y / w:
//! one number w, 0 for the straight line. A point that may be passed by ±t gives an interval of w; a piece fits
//! while the intervals of its points have one number in common.

use crate::geom::Point2;

/// A piece of a path in the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Piece {
    pub to: Point2,
    /// Centre, and whether it turns counter-clockwise; `None` for a straight line.
    pub arc: Option<(Point2, bool)>,
}

/// Largest radius of an arc, mm: flatter ones are cut as shorter lines.
const FLATTEST: f64 = 2000.0;

/// The pieces from the first to the last of these points; all are straight where none may be bent.
pub(super) fn fit(points: &[Point2], tolerance: f64, bent: bool) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let mut at = 0;
    while at + 1 < points.len() {
        let (end, piece) = longest(points, at, (tolerance, bent));
        pieces.push(piece);
        at = end;
    }
    pieces
}

/// The longest piece from point `at`, looked for by doubling and halving; with the point where it ends.
fn longest(points: &[Point2], at: usize, (tolerance, bent): (f64, bool)) -> (usize, Piece) {
    let last = points.len() - 1;
    let straight = Piece { to: points[at + 1], arc: None };
    let (mut good, mut best) = (at + 1, straight);
    let mut step = 1;
    while good < last {
        let end = (good + step).min(last);
        match piece(&points[at..=end], tolerance).filter(|found| bent || found.arc.is_none()) {
            Some(found) => {
                (good, best) = (end, found);
                step *= 2;
            }
            None if step == 1 => break,
            None => step = (step / 4).max(1),
        }
    }
    (good, best)
}

/// One line or arc along these points, if one does.
fn piece(points: &[Point2], tolerance: f64) -> Option<Piece> {
    let (from, to) = (*points.first()?, *points.last()?);
    let length = (to - from).norm();
    if length <= 4.0 * tolerance {
        return None;
    }
    let along = (to - from) / length;
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    for p in &points[1..points.len() - 1] {
        let d = p - from;
        let (x, y) = (d.dot(&along), crate::geom::cross(along, d));
        let number = |y: f64| {
            let rest = x * (length - x) - y * y;
            (rest > 0.0).then(|| y / rest)
        };
        // Beside the ends, where circles through them can hardly pass, the ends themselves are near enough.
        if d.norm() <= tolerance || (p - to).norm() <= tolerance {
            continue;
        }
        low = low.max(number(y - tolerance)?);
        high = high.min(number(y + tolerance)?);
    }
    if low > high {
        return None;
    }
    if low <= 0.0 && high >= 0.0 {
        return Some(Piece { to, arc: None });
    }
    let w = 0.5 * (low + high);
    let offset = -0.5 / w;
    if crate::math::hypot(offset, 0.5 * length) > FLATTEST {
        return None;
    }
    let centre = from + along * (0.5 * length) + crate::geom::left(along) * offset;
    Some(Piece { to, arc: Some((centre, w < 0.0)) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{TAU, sin_cos};

    fn circle(radius: f64, count: u32) -> Vec<Point2> {
        let at = |k: u32| {
            let (s, c) = sin_cos(TAU * f64::from(k) / f64::from(count));
            Point2::new(radius * c, radius * s)
        };
        (0..=count).map(at).collect()
    }

    #[test]
    fn a_circle_takes_few_arcs() {
        let pieces = fit(&circle(10.0, 200), 0.01, true);
        assert!(pieces.len() <= 4, "{pieces:?}");
        for piece in &pieces[..pieces.len() - 1] {
            let (centre, turns_left) = piece.arc.expect("an arc");
            assert!(centre.coords.norm() < 0.02 && turns_left, "{piece:?}");
        }
    }

    #[test]
    fn a_square_takes_four_lines() {
        let corners = [[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [0.0, 8.0], [0.0, 0.0]];
        let mut points = vec![Point2::new(0.0, 0.0)];
        for pair in corners.windows(2) {
            let (a, b) = (Point2::from(pair[0]), Point2::from(pair[1]));
            points.extend((1..=20u32).map(|k| a + (b - a) * (f64::from(k) / 20.0)));
        }
        let pieces = fit(&points, 0.01, true);
        assert_eq!(pieces.len(), 4, "{pieces:?}");
        assert!(pieces.iter().all(|p| p.arc.is_none()));
    }

    #[test]
    fn points_are_passed_within_the_tolerance() {
        let points: Vec<Point2> = (0..=300u32)
            .map(|k| {
                let x = f64::from(k) * 0.1;
                Point2::new(x, 2.0 * crate::math::sin(0.4 * x))
            })
            .collect();
        let pieces = fit(&points, 0.02, true);
        assert!(pieces.len() < 20, "{}", pieces.len());
        let mut from = points[0];
        let mut k = 0;
        for piece in &pieces {
            while k < points.len() && (points[k] - piece.to).norm() > 1e-12 {
                let off = match piece.arc {
                    Some((centre, _)) => ((points[k] - centre).norm() - (from - centre).norm()).abs(),
                    None => crate::plan::waterline::ground::to_segment(from, piece.to, points[k]),
                };
                assert!(off <= 0.0201, "{off} at {k}");
                k += 1;
            }
            from = piece.to;
        }
    }
}
