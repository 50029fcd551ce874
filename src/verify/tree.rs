//! Nearest sample of a curve: a binary tree of circles over consecutive samples.

use crate::geom::Point2;

/// Samples in a leaf.
const LEAF: usize = 8;

/// Circles over runs of samples; node `i` has the children `2i + 1` and `2i + 2`.
#[derive(Debug)]
pub(super) struct Tree {
    points: Vec<Point2>,
    circles: Vec<(Point2, f64)>,
}

impl Tree {
    pub(super) fn new(points: impl Iterator<Item = Point2>) -> Self {
        let points: Vec<Point2> = points.collect();
        let mut tree = Tree { circles: Vec::new(), points };
        tree.build(0, 0, tree.points.len());
        tree
    }

    fn build(&mut self, node: usize, from: usize, to: usize) {
        if self.circles.len() <= node {
            self.circles.resize(node + 1, (Point2::origin(), 0.0));
        }
        let run = self.points.get(from..to).unwrap_or_default();
        let (Some(first), Some(last)) = (run.first(), run.last()) else { return };
        let centre = Point2::from((first.coords + last.coords) / 2.0);
        let radius = run.iter().map(|p| (p - centre).norm()).fold(0.0, f64::max);
        if let Some(slot) = self.circles.get_mut(node) {
            *slot = (centre, radius);
        }
        if to - from > LEAF {
            let middle = usize::midpoint(from, to);
            self.build(2 * node + 1, from, middle);
            self.build(2 * node + 2, middle, to);
        }
    }

    /// Index of the sample nearest to `q`.
    pub(super) fn nearest(&self, q: Point2) -> usize {
        let mut best = (f64::INFINITY, 0);
        self.search(q, 0, 0, self.points.len(), &mut best);
        best.1
    }

    fn bound(&self, q: Point2, node: usize) -> f64 {
        self.circles.get(node).map_or(f64::INFINITY, |(c, r)| (q - c).norm() - r)
    }

    fn search(&self, q: Point2, node: usize, from: usize, to: usize, best: &mut (f64, usize)) {
        if to - from <= LEAF {
            for (i, p) in self.points.iter().enumerate().take(to).skip(from) {
                let distance = (q - p).norm();
                if distance < best.0 {
                    *best = (distance, i);
                }
            }
            return;
        }
        let middle = usize::midpoint(from, to);
        let (left, right) = (2 * node + 1, 2 * node + 2);
        let (a, b) = (self.bound(q, left), self.bound(q, right));
        let mut visit = |child: usize, bound: f64, from: usize, to: usize| {
            if bound < best.0 {
                self.search(q, child, from, to, best);
            }
        };
        if a <= b {
            visit(left, a, from, middle);
            visit(right, b, middle, to);
        } else {
            visit(right, b, middle, to);
            visit(left, a, from, middle);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_of_many_is_found() {
        let points: Vec<Point2> = (0..1000)
            .map(|i| {
                let (s, c) = crate::math::sin_cos(f64::from(i) * 0.013);
                Point2::new(f64::from(i) * 0.1 * c, f64::from(i) * 0.1 * s)
            })
            .collect();
        let tree = Tree::new(points.iter().copied());
        for q in [Point2::new(3.0, 4.0), Point2::new(-70.0, 1.0), Point2::new(500.0, 0.0)] {
            let plain = points.iter().map(|p| (q - p).norm()).fold(f64::INFINITY, f64::min);
            assert!(((points[tree.nearest(q)] - q).norm() - plain).abs() < 1e-12);
        }
    }
}
