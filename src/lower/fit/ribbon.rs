//! Fewest straight links along a ribbon: a sequence of gates in a plane, between two given points.
//!
//! For paths whose vertices are rounded later (passes over surfaces): the search runs on a grid of its own that is much
//! finer than any control's.

use super::search::{Effort, Goal, Search, Vertex};
use super::tube::Gates;
use super::window::Course;
use crate::geom::{Point2, Vec2, cross};

/// mm in one step of the search's own grid.
pub const STEP: f64 = 2e-5;

/// A ribbon: left and right ends of its gates, mm, in order.
#[derive(Debug, Clone, Default)]
pub struct Ribbon {
    /// Left ends.
    pub left: Vec<Point2>,
    /// Right ends.
    pub right: Vec<Point2>,
}

/// A vertex of a path along a ribbon.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Knot {
    /// Where, mm.
    pub at: Point2,
    /// The first gate after it.
    pub next: usize,
}

/// The vertices strictly between `head`, on the first gate, and `tail`, on the last, of a path with the fewest links
/// that passes every gate; `None` where none was found.
#[must_use]
pub fn fewest(ribbon: &Ribbon, head: Point2, tail: Point2) -> Option<Vec<Knot>> {
    let n = ribbon.left.len();
    if n < 3 {
        return Some(Vec::new());
    }
    let grid = |points: &[Point2]| points.iter().map(|p| p.coords / STEP).collect();
    let gates = Gates { l: grid(&ribbon.left), r: grid(&ribbon.right), lap: Vec2::zeros(), closed: false };
    let sound = (0..n).all(|i| gates.left(i).iter().chain(gates.right(i).iter()).all(|c| c.is_finite()));
    if !sound || !ordered(&gates) {
        return None;
    }
    let whole = |p: Point2| [p.x, p.y].map(|c| (c / STEP).round() as i64);
    let (head, target) = (whole(head), tail.coords / STEP);
    let course = Course { gates: &gates, end: n - 1, target: Some(target) };
    let effort = Effort { beam: 2, tries: 3, columns: 8, all: false };
    let root = Vertex { at: head, next: 1 };
    // No path needs more links than there are gates.
    let most = u32::try_from(n).unwrap_or(u32::MAX);
    let chain = Search::new(most).run(&course, &[root], Goal::Target, effort).ok()?;
    let knot = |v: &Vertex| Knot { at: Point2::from(v.point() * STEP), next: v.next };
    Some(chain.iter().skip(1).map(knot).collect())
}

/// Whether every gate lies ahead of the one before it.
fn ordered(gates: &Gates) -> bool {
    (1..gates.len()).all(|i| {
        let across = gates.left(i - 1) - gates.right(i - 1);
        let (l, r) = (gates.left(i) - gates.right(i - 1), gates.right(i) - gates.right(i - 1));
        cross(across, l) < 0.0 && cross(across, r) < 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math;

    #[test]
    fn an_arc_takes_the_links_that_its_sagitta_asks_for() {
        let (radius, band) = (50.0, 0.01);
        let at = |r: f64, k: u32| {
            let (sin, cos) = math::sin_cos(math::PI / 3.0 * f64::from(k) / 2000.0);
            Point2::new(r * sin, r * cos)
        };
        let ring = |r: f64| (0..=2000).map(|k| at(r, k)).collect::<Vec<_>>();
        let ribbon = Ribbon { left: ring(radius + band), right: ring(radius) };
        let (head, tail) = (at(radius + band, 0), at(radius + band, 2000));
        let knots = fewest(&ribbon, head, tail).expect("a path");
        // A link from rim to rim spans 2 acos(r/(r + band)).
        let link = 2.0 * math::acos(radius / (radius + band));
        let links = (math::PI / 3.0 / link).ceil();
        assert!((math::count(knots.len() + 1) - links).abs() <= 1.0, "{} {links}", knots.len() + 1);
    }
}
