//! A fitted spline as Bézier pieces in integers.

use super::spline::{ORDER, Spline, clamped};
use crate::cl::spline::segments;
use crate::geom::{Point2, Point3};
use crate::lower::fit::Grid;
use crate::lower::fit::arcs::{grid_point, nearest_grid_point};
use crate::lower::pieces::rounded;

/// The pieces of a spline between `ends` as a spline with threefold inner knots, and its control points in steps of the
/// grid divided by 10^`finer`. `None` beyond what the grid holds.
pub(super) fn cut(
    spline: &Spline<2>,
    grid: &Grid,
    ends: [[i64; 2]; 2],
    finer: u8,
) -> Option<(Spline<2>, Vec<[i64; 2]>)> {
    let points: Vec<Point3> = spline.points.iter().map(|p| Point3::new(p.x, p.y, 0.0)).collect();
    let parts: Vec<[Point3; ORDER]> = segments(&points, &spline.knots).collect();
    let lift = |[x, y]: [i64; 2]| [x, y, 0];
    let mut steps: Vec<[i64; 2]> = Vec::new();
    let mut from = ends[0];
    for (i, part) in parts.iter().enumerate() {
        let to = if i + 1 == parts.len() { ends[1] } else { nearest_grid_point(grid, part[3].xy()).ok()? };
        let piece = rounded(part, [lift(from), lift(to)], grid.step, finer)?;
        let fresh = usize::from(!steps.is_empty());
        steps.extend(piece.iter().skip(fresh).map(|[x, y, _]| [*x, *y]));
        from = to;
    }
    // Finer points are points of a finer grid.
    let fine = Grid { step: (0..finer).fold(grid.step, |step, _| step / 10.0), ..*grid };
    let points: Vec<Point2> = steps.iter().map(|q| grid_point(&fine, *q)).collect();
    let mut breaks: Vec<f64> = spline.knots.get(ORDER..spline.points.len())?.to_vec();
    breaks.dedup();
    let inner: Vec<f64> = breaks.into_iter().flat_map(|k| [k; ORDER - 1]).collect();
    let knots = clamped(*spline.knots.first()?, &inner, *spline.knots.last()?);
    (knots.len() == points.len() + ORDER).then_some((Spline { knots, points }, steps))
}
