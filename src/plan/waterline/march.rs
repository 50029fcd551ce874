//! Curves of a constant value of a field on a grid, cell by cell.

use std::collections::BTreeMap;

use super::ground::Grid;
use crate::geom::Point2;

/// A curve on which a field changes its sign; what is not positive lies to its left.
#[derive(Debug, Clone)]
pub(super) struct Line {
    /// In order; of a closed one the first is not repeated.
    pub points: Vec<Point2>,
    pub closed: bool,
    /// A node beside it, inside.
    pub node: usize,
}

/// Two nodes beside each other, the one inside first.
type Edge = (usize, usize);

/// All curves; `root` says where the sign changes between a node inside and one outside.
pub(super) fn lines(grid: &Grid, values: &[f64], root: &dyn Fn(usize, usize) -> Point2) -> Vec<Line> {
    let mut next: BTreeMap<Edge, Edge> = BTreeMap::new();
    let rows = grid.counts[1];
    for i in 0..grid.counts[0] - 1 {
        for j in 0..rows - 1 {
            let k = i * rows + j;
            cell([k, k + rows, k + rows + 1, k + 1], values, &mut next);
        }
    }
    let mut heads: Vec<Edge> = next.keys().copied().collect();
    let ends: std::collections::BTreeSet<Edge> = next.values().copied().collect();
    // Curves that begin at the border first; what is left is closed.
    heads.sort_by_key(|e| (ends.contains(e), *e));
    let mut found = Vec::new();
    for head in heads {
        if !next.contains_key(&head) {
            continue;
        }
        let mut edges = vec![head];
        let mut at = head;
        while let Some(to) = next.remove(&at) {
            if to == head {
                break;
            }
            edges.push(to);
            at = to;
        }
        let closed = ends.contains(&head);
        found.push(Line { points: edges.iter().map(|(a, b)| root(*a, *b)).collect(), closed, node: head.0 });
    }
    found
}

/// The parts of curves in a cell with these corners, counter-clockwise.
fn cell(corners: [usize; 4], values: &[f64], next: &mut BTreeMap<Edge, Edge>) {
    let inside = |k: usize| values.get(k).is_some_and(|v| *v <= 0.0);
    let mut crossings: Vec<(bool, Edge)> = Vec::with_capacity(4);
    for (n, a) in corners.iter().enumerate() {
        let b = corners[(n + 1) % 4];
        match (inside(*a), inside(b)) {
            (true, false) => crossings.push((true, (*a, b))),
            (false, true) => crossings.push((false, (b, *a))),
            _ => {}
        }
    }
    let count = crossings.len();
    let middle: f64 = corners.iter().filter_map(|k| values.get(*k)).sum();
    for (n, (leaves, edge)) in crossings.iter().enumerate() {
        if *leaves {
            // Round the cell, a curve starts where its inside is left. Where two cross, the middle says what belongs together.
            let partner = if count == 4 && middle <= 0.0 { n + 1 } else { n + count - 1 };
            if let Some((_, end)) = crossings.get(partner % count) {
                next.insert(*edge, *end);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> Grid {
        Grid { low: Point2::new(-5.0, -5.0), step: 0.25, counts: [41, 41] }
    }

    fn area(line: &Line) -> f64 {
        let n = line.points.len();
        let cross = |k: usize| crate::geom::cross(line.points[k].coords, line.points[(k + 1) % n].coords);
        0.5 * (0..n).map(cross).sum::<f64>()
    }

    fn of(f: &dyn Fn(Point2) -> f64) -> Vec<Line> {
        let grid = grid();
        let values: Vec<f64> = (0..grid.len()).map(|k| f(grid.node(k))).collect();
        lines(&grid, &values, &|a, b| {
            let t = values[a] / (values[a] - values[b]);
            grid.node(a) + (grid.node(b) - grid.node(a)) * t
        })
    }

    #[test]
    fn a_ring_has_its_inside_to_the_left() {
        let found = of(&|p| (p.coords.norm() - 3.0).abs() - 1.0);
        let mut areas: Vec<f64> = found.iter().map(area).collect();
        areas.sort_by(f64::total_cmp);
        assert!(found.iter().all(|l| l.closed) && areas.len() == 2, "{areas:?}");
        let pi = core::f64::consts::PI;
        assert!((areas[0] + 4.0 * pi).abs() < 0.1 && (areas[1] - 16.0 * pi).abs() < 0.1, "{areas:?}");
    }

    #[test]
    fn a_curve_that_leaves_the_grid_is_open() {
        let found = of(&|p| p.y - 0.3);
        assert!(found.len() == 1 && !found[0].closed && found[0].points.len() == 41);
        assert!(found[0].points.iter().all(|p| (p.y - 0.3).abs() < 1e-9));
        assert!(found[0].points[0].x > found[0].points[40].x);
    }

    #[test]
    fn two_peaks_that_touch_at_a_corner_stay_two_curves() {
        let found = of(&|p| 0.3 - (p.x * p.y).signum() * (p.x * p.y).abs().min(1.0));
        assert_eq!(found.len(), 2);
    }
}
