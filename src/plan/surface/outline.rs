//! The outline of a surface in plan, as plan passes along an axis cross it, and the stretches that passes run in.

use crate::geom::surface::SurfaceTree;
use crate::geom::{Point2, Point3, Vec3};
use crate::math::count;

/// Outline points on an edge of a patch.
const EDGE: u32 = 400;

/// The edges of the surface as plan passes along an axis (0: x) see them.
#[derive(Debug)]
pub(super) struct Rim {
    pub axis: usize,
    pub places: Vec<RimPlace>,
    /// The centres in plan: the outline of the offset surface.
    outline: Outline,
}

/// A place on an edge, with the centre of the ball that touches there.
#[derive(Debug)]
pub(super) struct RimPlace {
    pub point: Point3,
    pub normal: Vec3,
    pub centre: Point3,
}

impl Rim {
    /// Places along the four edges of the net, in order around it.
    pub(super) fn new(axis: usize, tree: &SurfaceTree, ball: f64) -> Rim {
        let net = tree.net();
        let [rows, columns] = net.size().map(count);
        let corners = [[0.0, 0.0], [rows, 0.0], [rows, columns], [0.0, columns]];
        let mut places = Vec::new();
        for (k, from) in corners.iter().enumerate() {
            let to = corners[(k + 1) % 4];
            for i in 0..EDGE {
                let t = f64::from(i) / f64::from(EDGE);
                let jet = net.jet(from[0] + (to[0] - from[0]) * t, from[1] + (to[1] - from[1]) * t);
                if let Some(normal) = jet.normal() {
                    places.push(RimPlace { point: jet.p, normal, centre: jet.p + normal * ball });
                }
            }
        }
        let centres = places.iter().map(|p| Point2::new(p.centre.x, p.centre.y)).collect();
        Rim { axis, places, outline: Outline::new(axis, centres) }
    }

    /// Range of *across*.
    pub(super) fn width(&self) -> (f64, f64) {
        self.outline.width()
    }

    /// First and last crossing of the pass at `across`.
    pub(super) fn crossings(&self, across: f64) -> Option<(f64, f64)> {
        self.outline.crossings(across)
    }

    /// The stretches of the pass at `across` on which the ball touches inside of the edges, in rising order.
    pub(super) fn inside(&self, across: f64) -> Vec<(f64, f64)> {
        self.outline.inside(across)
    }

    /// A place in plan.
    pub(super) fn place(&self, along: f64, across: f64) -> Point2 {
        if self.axis == 0 { Point2::new(along, across) } else { Point2::new(across, along) }
    }
}

/// A closed outline that lines along an axis (0: x) cross.
#[derive(Debug)]
pub(super) struct Outline {
    axis: usize,
    points: Vec<Point2>,
    width: (f64, f64),
    /// The edges, by the number of their first point, that have part of each of equally wide strips *across*: so that a
    /// line looks at few.
    strips: Vec<Vec<usize>>,
}

impl Outline {
    /// The outline through these points.
    pub(super) fn new(axis: usize, points: Vec<Point2>) -> Outline {
        let across = points.iter().map(|p| p[1 - axis]);
        let width = across.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        let strips = vec![Vec::new(); points.len().max(1)];
        let mut outline = Outline { axis, points, width, strips };
        for i in 0..outline.points.len() {
            let (p, q) = outline.edge(i);
            let (a, b) = (outline.strip(p[1 - axis]), outline.strip(q[1 - axis]));
            for strip in &mut outline.strips[a.min(b)..=a.max(b)] {
                strip.push(i);
            }
        }
        outline
    }

    fn edge(&self, i: usize) -> (Point2, Point2) {
        (self.points[i], self.points[(i + 1) % self.points.len()])
    }

    /// The strip in which a place *across* lies; it never falls as the place rises.
    fn strip(&self, across: f64) -> usize {
        let share = (across - self.width.0) / (self.width.1 - self.width.0);
        // Floats saturate, and what is no number is nought.
        ((share * count(self.strips.len())) as usize).min(self.strips.len() - 1)
    }

    /// Range of *across*.
    pub(super) fn width(&self) -> (f64, f64) {
        self.width
    }

    /// Where a line crosses, in rising order; with the side to which the outline goes on.
    fn crossed(&self, across: f64) -> Vec<(f64, i32)> {
        let mut found = Vec::new();
        for &i in &self.strips[self.strip(across)] {
            let (p, q) = self.edge(i);
            let (a, b) = (p[1 - self.axis] - across, q[1 - self.axis] - across);
            // A vertex on the line belongs to the side above it.
            if (a < 0.0) != (b < 0.0) {
                let along = p[self.axis] + (q[self.axis] - p[self.axis]) * (a / (a - b));
                found.push((along, if a < b { 1 } else { -1 }));
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found
    }

    /// First and last crossing with a line.
    pub(super) fn crossings(&self, across: f64) -> Option<(f64, f64)> {
        let found = self.crossed(across);
        let (first, last) = (found.first()?.0, found.last()?.0);
        (first < last).then_some((first, last))
    }

    /// The stretches of a line that lie inside, in rising order.
    fn inside(&self, across: f64) -> Vec<(f64, f64)> {
        let mut out: Vec<(f64, f64)> = Vec::new();
        let (mut winding, mut start) = (0, 0.0);
        for (at, side) in self.crossed(across) {
            let before = winding;
            winding += side;
            if before == 0 {
                start = at;
            } else if winding == 0 && at > start {
                out.push((start, at));
            }
        }
        out
    }
}

/// Halvings that find the border of what holds.
const HALVINGS: u32 = 24;

/// The last place on the way from `on`, where something holds, to `off`, where it does not, on which it does.
pub(super) fn border(mut on: f64, mut off: f64, holds: &mut dyn FnMut(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (on + off);
        if holds(middle) { on = middle } else { off = middle }
    }
    on
}

/// The ranges of 0..=1 on which something holds, in rising order; looked at in so many equal steps.
pub(super) fn held(parts: usize, holds: &mut dyn FnMut(f64) -> bool) -> Vec<(f64, f64)> {
    let at = |k: usize| count(k) / count(parts.max(1));
    let seen: Vec<bool> = (0..=parts).map(|k| holds(at(k))).collect();
    let mut out: Vec<(f64, f64)> = Vec::new();
    for k in (0..=parts).filter(|k| seen[*k]) {
        if k == 0 || !seen[k - 1] {
            out.push((if k == 0 { 0.0 } else { border(at(k), at(k - 1), holds) }, at(k)));
        }
        if let Some(last) = out.last_mut() {
            last.1 = if k < parts && !seen[k + 1] { border(at(k), at(k + 1), holds) } else { at(k) };
        }
    }
    out
}

/// Ranges in rising order, those that overlap united.
pub(super) fn united(ranges: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let mut sorted: Vec<(f64, f64)> = ranges.collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut out: Vec<(f64, f64)> = Vec::new();
    for (a, b) in sorted {
        match out.last_mut().filter(|before| a <= before.1) {
            Some(before) => before.1 = before.1.max(b),
            None => out.push((a, b)),
        }
    }
    out
}

/// Stretches, each a range of places along, of lines that lie beside one another: in chains of such that have places in
/// common, by line and number.
pub(super) fn chained(lines: &[Vec<(f64, f64)>]) -> Vec<Vec<(usize, usize)>> {
    let mut open: Vec<Vec<usize>> = lines.iter().map(|l| (0..l.len()).collect()).collect();
    let mut chains = Vec::new();
    for first in 0..open.len() {
        while !open[first].is_empty() {
            let mut last = (first, open[first].remove(0));
            let mut chain = vec![last];
            while let Some(beside) = open.get_mut(last.0 + 1) {
                let own = lines[last.0][last.1];
                let shared = |i: usize| {
                    let other = lines[last.0 + 1][i];
                    other.1.min(own.1) - other.0.max(own.0)
                };
                let best = (0..beside.len())
                    .filter(|k| shared(beside[*k]) > 0.0)
                    .max_by(|a, b| shared(beside[*a]).total_cmp(&shared(beside[*b])));
                let Some(k) = best else { break };
                last = (last.0 + 1, beside.remove(k));
                chain.push(last);
            }
            chains.push(chain);
        }
    }
    chains
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crescent() -> Outline {
        let points = [(0.0, 0.0), (10.0, 0.0), (10.0, 4.0), (5.0, 1.0), (0.0, 4.0)];
        Outline::new(0, points.map(|(x, y)| Point2::new(x, y)).to_vec())
    }

    #[test]
    fn a_line_over_a_hollow_outline_runs_in_two_stretches() {
        let outline = crescent();
        assert_eq!(outline.inside(0.5), [(0.0, 10.0)]);
        let two = outline.inside(2.5);
        assert_eq!(two.len(), 2, "{two:?}");
        assert!((two[0].1 - 2.5).abs() < 1e-12 && (two[1].0 - 7.5).abs() < 1e-12, "{two:?}");
        assert_eq!(outline.crossings(2.5), Some((0.0, 10.0)));
        assert!(outline.inside(5.0).is_empty());
    }

    #[test]
    fn lines_find_what_crosses_them_among_many_edges() {
        let corner = |i: u32| {
            let turn = f64::from(i) * std::f64::consts::TAU / 400.0;
            let radius = 10.0 + 3.0 * libm::sin(7.0 * turn);
            Point2::new(radius * libm::cos(turn), 2.0 * radius * libm::sin(turn))
        };
        let points: Vec<Point2> = (0..400).map(corner).collect();
        for axis in [0, 1] {
            let outline = Outline::new(axis, points.clone());
            let (low, high) = outline.width();
            for k in 0..=100 {
                let across = low + (high - low) * f64::from(k) / 100.0;
                let crosses = |i: &usize| {
                    let (p, q) = outline.edge(*i);
                    (p[1 - axis] < across) != (q[1 - axis] < across)
                };
                let all = (0..points.len()).filter(crosses).count();
                assert_eq!(outline.crossed(across).len(), all, "{axis} {across}");
            }
            assert!(outline.crossed(low - 1.0).is_empty() && outline.crossed(high + 1.0).is_empty());
        }
    }

    #[test]
    fn what_holds_is_found_with_its_borders() {
        let mut holds = |t: f64| (0.13..=0.41).contains(&t) || t >= 0.77;
        let found = held(20, &mut holds);
        assert_eq!(found.len(), 2, "{found:?}");
        let near = |a: f64, b: f64| (a - b).abs() < 1e-6;
        assert!(near(found[0].0, 0.13) && near(found[0].1, 0.41), "{found:?}");
        assert!(near(found[1].0, 0.77) && found[1].1 == 1.0, "{found:?}");
        assert!(held(8, &mut |_| false).is_empty());
        assert_eq!(held(8, &mut |_| true), [(0.0, 1.0)]);
    }

    #[test]
    fn stretches_beside_one_another_make_chains() {
        let lines = [vec![(0.0, 10.0)], vec![(0.0, 4.0), (6.0, 10.0)], vec![(0.0, 3.0), (7.0, 10.0)]];
        assert_eq!(chained(&lines), [vec![(0, 0), (1, 1), (2, 1)], vec![(1, 0), (2, 0)]]);
    }
}
