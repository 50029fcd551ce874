//! One question for the nearest point.

use super::bend::{Bend, Hessian};
use super::place::{Place, descend};
use super::{Area, Foot, Kind, Leaf, MOST_PIECES, ROUND, SAME, SurfaceTree, box_distance, hull};
use crate::geom::surface::interval::Interval;
use crate::geom::{Point3, Vec3};

/// One question.
pub(super) struct Quest<'a> {
    tree: &'a SurfaceTree,
    x: Point3,
    best: Foot,
    /// Whether the best point is a local minimum over the whole of its patch.
    settled: bool,
    /// What is farther is of no interest.
    limit: f64,
    /// Smallest bound of what was given up.
    open: f64,
    /// A point that is nearer than this ends the search.
    enough: f64,
    /// Pieces of leaves that may still be looked at.
    budget: u32,
}

/// Pieces of surface whose bound comes so near to the best distance are given up, mm: what they could hide is far
/// below what counts.
const FLAT: f64 = 1e-9;

impl<'a> Quest<'a> {
    /// From a foot that is known, with whether it is a local minimum over its whole patch; what is farther than `within`
    /// is of no interest.
    pub(super) fn new(
        tree: &'a SurfaceTree,
        x: Point3,
        (best, settled): (Foot, bool),
        within: f64,
    ) -> Quest<'a> {
        let limit = best.distance.min(within);
        Quest {
            tree,
            x,
            best,
            settled,
            limit,
            open: f64::INFINITY,
            enough: 0.0,
            budget: tree.budget(MOST_PIECES),
        }
    }

    /// Any point that is nearer than this will do.
    pub(super) fn until(self, enough: f64) -> Quest<'a> {
        Quest { enough, ..self }
    }

    pub(super) fn finish(mut self) -> Foot {
        self.best.certain = self.limit.min(self.open);
        self.best
    }

    pub(super) fn run(&mut self, stack: &mut Vec<(f64, u32)>) {
        stack.clear();
        let root = &self.tree.nodes[0];
        stack.push((box_distance(&root.low, &root.high, self.x), 0));
        while let Some((bound, next)) = stack.pop() {
            if self.best.distance < self.enough {
                return;
            }
            if bound >= self.limit {
                continue;
            }
            let node = &self.tree.nodes[next as usize];
            if self
                .tree
                .slabs
                .get(node.slab as usize)
                .is_some_and(|s| s.distance(self.x) >= self.limit - SAME)
            {
                continue;
            }
            if bound <= self.tree.reach
                && let Some((patch, area)) = self.tree.sure.get(node.sure as usize)
            {
                self.convex_piece(*patch, area);
                continue;
            }
            match node.kind {
                Kind::Leaf(leaf) => self.leaf(&self.tree.leaves[leaf as usize]),
                Kind::Branch(first, count) => {
                    for child in first..first + count {
                        let node = &self.tree.nodes[child as usize];
                        let bound = box_distance(&node.low, &node.high, self.x);
                        if bound < self.limit {
                            stack.push((bound, child));
                        }
                    }
                }
            }
        }
    }

    /// The least over a rectangle on which F is convex. The best point of all is that, if it lies there: a local minimum
    /// of a convex function is the global one.
    fn convex_piece(&mut self, patch: usize, area: &Area) {
        let own = self.best.patch == patch;
        if own && self.settled && area.holds(self.best.uv) {
            return;
        }
        let whole = &self.tree.net.patches()[patch];
        let start = if own { self.best.uv } else { area.middle() };
        let near = Place::new(whole, self.x, area.clamp(start));
        if !self.above(&near, area) {
            self.take(descend(whole, self.x, near.uv, area), patch);
        }
    }

    fn leaf(&mut self, leaf: &Leaf) {
        let own = self.best.patch == leaf.patch;
        let (middle, half) = self.offset(&leaf.hull);
        if !leaf.bend.hessian(middle, half).positive([true, true]) {
            return self.pieces(leaf);
        }
        let patch = &self.tree.net.patches()[leaf.patch];
        let near =
            Place::new(patch, self.x, leaf.area.clamp(if own { self.best.uv } else { leaf.area.middle() }));
        if self.above(&near, &leaf.area) {
            return;
        }
        self.take(descend(patch, self.x, near.uv, &leaf.area), leaf.patch);
    }

    /// Whether a convex F is above the best over the whole rectangle, by its tangent plane at `at`.
    fn above(&self, at: &Place, area: &Area) -> bool {
        let g = at.gradient(self.x);
        let least = |g: f64, t: f64, (a, b): (f64, f64)| (g * (a - t)).min(g * (b - t));
        let low = 0.5 * at.square + least(g[0], at.uv[0], area.u) + least(g[1], at.uv[1], area.v);
        let best = (self.limit - SAME).max(0.0);
        low >= 0.5 * best * best
    }

    /// x - r for all points r in a box: middle and half width.
    fn offset(&self, hull: &[Interval; 3]) -> (Vec3, Vec3) {
        let middle = Vec3::from(hull.map(|i| 0.5 * (i.lo + i.hi)));
        (self.x.coords - middle, Vec3::from(hull.map(|i| 0.5 * (i.hi - i.lo))) * (1.0 + 1e-12))
    }

    fn take(&mut self, place: Place, patch: usize) {
        let foot = place.foot(patch);
        if foot.distance < self.best.distance {
            self.best = foot;
            self.settled = false;
            self.limit = self.limit.min(foot.distance);
        }
    }

    /// A leaf over which F is not convex: cut up until each piece is, or lies beyond the best. Bounds are Taylor's about a
    /// piece's middle with the leaf's own bounds of the Hessian. Where F certainly grows along a parameter, only the edge
    /// it grows from is looked at.
    fn pieces(&mut self, leaf: &Leaf) {
        let patch = &self.tree.net.patches()[leaf.patch];
        let (middle, half) = self.offset(&leaf.hull);
        let hessian = leaf.bend.hessian(middle, half);
        let mut stack = vec![(leaf.area, 0)];
        while let Some((area, depth)) = stack.pop() {
            let at = Place::new(patch, self.x, area.middle());
            let (g, size) = (at.gradient(self.x), area.half());
            let bound = (2.0 * (0.5 * at.square + hessian.least(g, size))).max(0.0).sqrt();
            if bound >= self.limit - SAME {
                continue;
            }
            self.take(at, leaf.patch);
            if self.best.distance < self.enough {
                return;
            }
            let slopes = hessian.slopes(g, size);
            let lowest = Area { u: lowest(area.u, slopes[0]), v: lowest(area.v, slopes[1]) };
            if lowest != area {
                stack.push((lowest, depth));
                continue;
            }
            if self.convex(leaf, &area, depth, &hessian) {
                self.take(descend(patch, self.x, area.middle(), &area), leaf.patch);
                continue;
            }
            if self.budget == 0 || bound >= self.limit - FLAT {
                self.take(descend(patch, self.x, area.middle(), &area), leaf.patch);
                self.open = self.open.min(bound);
                continue;
            }
            self.budget -= 1;
            self.tree.spend(ROUND);
            area.parts(|part| stack.push((part, depth + 1)));
        }
    }

    /// Whether F is convex over a piece of a leaf; pieces cut off early are not worth a closer look.
    fn convex(&self, leaf: &Leaf, area: &Area, depth: u32, hessian: &Hessian) -> bool {
        const WORTH: u32 = 2;
        let free = area.extends();
        if hessian.positive(free) {
            return true;
        }
        if depth < WORTH {
            return false;
        }
        let boxes = self.tree.derivatives[leaf.patch].boxes(area.u, area.v);
        let piece = self.tree.net.patches()[leaf.patch].restrict(area.u, area.v);
        let (middle, half) = self.offset(&hull(&piece));
        Bend::new(&boxes).hessian(middle, half).positive(free)
    }
}

/// The part of a range where a function of this slope can be lowest.
fn lowest((a, b): (f64, f64), slope: Interval) -> (f64, f64) {
    if slope.lo > 0.0 {
        (a, a)
    } else if slope.hi < 0.0 {
        (b, b)
    } else {
        (a, b)
    }
}
