//! The point of a net nearest to a point in space, certain to be the nearest of all.
//!
//! The net is cut into *leaves* (parameter rectangles of its patches) under a tree of bounding boxes. A branch or
//! leaf whose bound lies beyond the best distance known is left alone. On a leaf where the Hessian of
//! F(u,v) = |x - r(u,v)|²/2, that is G - (x - r)·D, is positive definite by interval arithmetic, F is convex, so
//! that Newton's method over the rectangle gives the one minimum; where it is not, the leaf is cut up further.

mod bend;
pub mod glide;
mod near;
mod place;
mod quest;
pub mod rest;
mod search;
mod slide;

use core::cell::RefCell;
use core::sync::atomic::{AtomicU64, Ordering};

use super::crease::Creases;
use super::curvature::{Derivatives, hulls};
use super::interval::Interval;
use super::net::Net;
use super::patch::Patch;
use crate::geom::{Point3, Vec3};
use bend::Bend;
use glide::Swings;
use place::{descend, settle};
use quest::Quest;

/// The foot of a point on a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foot {
    /// Index of the patch.
    pub patch: usize,
    /// Parameters inside the patch.
    pub uv: [f64; 2],
    /// The surface point, mm.
    pub point: Point3,
    /// Distance from the point asked about, mm.
    pub distance: f64,
    /// No point of the surface is nearer than this, mm (the same as `distance` but where the search was given up).
    pub certain: f64,
}

/// A net prepared for questions of distance.
#[derive(Debug)]
pub struct SurfaceTree {
    net: Net,
    derivatives: Vec<Derivatives>,
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
    sure: Vec<(usize, Area)>,
    slabs: Vec<Slab>,
    reach: f64,
    upright: bool,
    creases: Creases,
    /// Bounds of |r_uu|, |r_uv|, |r_vv| over each patch.
    swings: Vec<[f64; 3]>,
    glides: Vec<Swings>,
    /// Pieces of leaves that questions have cut up so far.
    work: AtomicU64,
}

/// Bounding box with children, or a leaf.
#[derive(Debug, Clone, Copy)]
struct Node {
    low: [f64; 3],
    high: [f64; 3],
    kind: Kind,
    /// The piece over which the distance is convex for every point within the tree's reach of the box, as an index
    /// of `sure`; [`NONE`] where that is not known.
    sure: u32,
    /// The cylinder about it, as an index of `slabs`; [`NONE`] over several patches.
    slab: u32,
}

const NONE: u32 = u32::MAX;

#[derive(Debug, Clone, Copy)]
enum Kind {
    /// First child and how many.
    Branch(u32, u32),
    Leaf(u32),
}

/// A parameter rectangle of one patch.
#[derive(Debug, Clone)]
struct Leaf {
    patch: usize,
    area: Area,
    hull: [Interval; 3],
    bend: Bend,
}

/// Parameter rectangle.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Area {
    u: (f64, f64),
    v: (f64, f64),
}

impl Area {
    const WHOLE: Area = Area { u: (0.0, 1.0), v: (0.0, 1.0) };

    fn middle(&self) -> [f64; 2] {
        [0.5 * (self.u.0 + self.u.1), 0.5 * (self.v.0 + self.v.1)]
    }
    fn quarters(&self) -> [Area; 4] {
        let [mu, mv] = self.middle();
        let (low, high) = ((self.u.0, mu), (mu, self.u.1));
        let (left, right) = ((self.v.0, mv), (mv, self.v.1));
        [(low, left), (low, right), (high, left), (high, right)].map(|(u, v)| Area { u, v })
    }
    /// Whether it has a width in u, and in v.
    fn extends(&self) -> [bool; 2] {
        [self.u.0 < self.u.1, self.v.0 < self.v.1]
    }
    /// Half of its widths.
    fn half(&self) -> [f64; 2] {
        [0.5 * (self.u.1 - self.u.0), 0.5 * (self.v.1 - self.v.0)]
    }
    /// Its quarters, or halves where it is but a line.
    fn parts(&self, mut take: impl FnMut(Area)) {
        let [q, r, s, t] = self.quarters();
        let parts: &[Area] = match self.extends() {
            [true, true] => &[q, r, s, t],
            [true, false] => &[q, s],
            [false, true] => &[q, r],
            [false, false] => &[],
        };
        parts.iter().copied().for_each(&mut take);
    }
    fn holds(&self, [u, v]: [f64; 2]) -> bool {
        (self.u.0..=self.u.1).contains(&u) && (self.v.0..=self.v.1).contains(&v)
    }
    fn clamp(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        [u.clamp(self.u.0, self.u.1), v.clamp(self.v.0, self.v.1)]
    }
}

/// A flat cylinder about a piece of surface: centre, axis, range along the axis, radius.
#[derive(Debug, Clone, Copy)]
struct Slab {
    centre: Point3,
    axis: Vec3,
    low: f64,
    high: f64,
    radius: f64,
}

impl Slab {
    /// About the poles of a piece of surface, which hold it.
    fn new(patch: &Patch) -> Slab {
        let jet = patch.jet(0.5, 0.5);
        let axis = jet.normal().unwrap_or_else(Vec3::z);
        let mut slab = Slab { centre: jet.p, axis, low: 0.0, high: 0.0, radius: 0.0 };
        let [m, n] = patch.degree();
        for k in 0..(m + 1) * (n + 1) {
            let offset = patch.pole(k / (n + 1), k % (n + 1)) - slab.centre;
            let along = offset.dot(&axis);
            slab.low = slab.low.min(along);
            slab.high = slab.high.max(along);
            slab.radius = slab.radius.max((offset - axis * along).norm());
        }
        slab
    }
    /// No point of the piece is nearer to `x` than this.
    fn distance(&self, x: Point3) -> f64 {
        let offset = x - self.centre;
        let along = offset.dot(&self.axis);
        let beside = (offset.norm_squared() - along * along).max(0.0).sqrt();
        let (aside, above) =
            ((beside - self.radius).max(0.0), (along - self.high).max(self.low - along).max(0.0));
        (aside * aside + above * above).sqrt()
    }
}

/// Leaves have at most this depth below their patch when the tree is made …
const DEEPEST: u32 = 7;
/// … but where they are still larger than this share of the reach: there at most this depth, as long as there are no more
/// leaves than this.
const LARGE: f64 = 0.25;
const STEEPEST: u32 = 14;
const MOST_LEAVES: usize = 200_000;
/// … and at least this.
const SHALLOWEST: u32 = 3;
/// Newton steps that would bring half the square distance down by half the square of this, mm, are not made.
const SETTLED: f64 = 1e-7;
/// Pieces of leaves that one question may cut up.
const MOST_PIECES: u32 = 2_000;
/// Pieces that all questions together may cut up, those about a ball counted [`ROUND`]fold for what they cost: some minutes of
/// work. Only surfaces whose poles or weights are so uneven that their bounds tell next to nothing come near to it.
const MOST_WORK: u64 = 100_000_000;
const ROUND: u64 = 3;
/// Distances that agree so well are the same, mm.
const SAME: f64 = 1e-10;

impl SurfaceTree {
    /// Prepares `net` for points up to about `reach` mm from it: there, leaves are made so small that the distance
    /// is convex over each, where the surface's curvature allows.
    #[must_use]
    pub fn new(net: Net, reach: f64) -> SurfaceTree {
        let derivatives: Vec<Derivatives> = net.patches().iter().map(Derivatives::new).collect();
        let swings = derivatives.iter().map(slide::swings).collect();
        let glides = net.patches().iter().map(Swings::new).collect();
        let (nodes, leaves, sure, slabs) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let creases = Creases::new(&net);
        let upright = true;
        let mut tree = SurfaceTree {
            net,
            derivatives,
            nodes,
            leaves,
            sure,
            slabs,
            reach,
            upright,
            creases,
            swings,
            glides,
            work: AtomicU64::new(0),
        };
        let [rows, columns] = tree.net.size();
        tree.nodes.push(EMPTY);
        let root = tree.block((0, rows), (0, columns), reach);
        tree.nodes[0] = root;
        tree
    }
    /// Where the patches of the net meet at an angle.
    pub(super) fn creases(&self) -> &Creases {
        &self.creases
    }
    /// The net.
    #[must_use]
    pub fn net(&self) -> &Net {
        &self.net
    }
    /// Lowest and highest corner of a box that holds the surface, mm.
    #[must_use]
    pub fn bounds(&self) -> (Point3, Point3) {
        let root = &self.nodes[0];
        (Point3::from(root.low), Point3::from(root.high))
    }
    /// Whether the normal is proven to have a component along z everywhere, always of the same sense on a patch: the
    /// surface has no overhang and no vertical wall.
    #[must_use]
    pub fn is_upright(&self) -> bool {
        self.upright
    }
    /// Whether questions have taken more work than is bearable. From then on answers are bounds that say little, and what is
    /// made of them is not to be used: whether it comes to this does not depend on the order of the questions.
    #[must_use]
    pub fn is_exhausted(&self) -> bool {
        self.work.load(Ordering::Relaxed) > MOST_WORK
    }
    /// As if too much work had been done.
    #[cfg(test)]
    pub(crate) fn exhaust(&self) {
        self.spend(2 * MOST_WORK);
    }
    /// The pieces that one question may cut up, of at most so many.
    fn budget(&self, most: u32) -> u32 {
        if self.is_exhausted() { 0 } else { most }
    }
    /// Counts a piece that a question has cut up.
    fn spend(&self, cost: u64) {
        self.work.fetch_add(cost, Ordering::Relaxed);
    }
    /// The number of leaves.
    #[must_use]
    pub fn leaves(&self) -> usize {
        self.leaves.len()
    }

    /// A node over a block of patches.
    fn block(&mut self, rows: (usize, usize), columns: (usize, usize), reach: f64) -> Node {
        if rows.1 - rows.0 == 1 && columns.1 - columns.0 == 1 {
            let patch = rows.0 * self.net.size()[1] + columns.0;
            let whole = self.net.patches()[patch].clone();
            return self.node(patch, &whole, Area::WHOLE, 0, reach);
        }
        let halves = |(a, b): (usize, usize)| match b - a {
            1 => vec![(a, b)],
            n => vec![(a, a + n / 2), (a + n / 2, b)],
        };
        let mut parts = Vec::new();
        for r in halves(rows) {
            for c in halves(columns) {
                parts.push((r, c));
            }
        }
        let first = self.nodes.len();
        self.nodes.resize(first + parts.len(), EMPTY);
        for (k, (r, c)) in parts.iter().enumerate() {
            self.nodes[first + k] = self.block(*r, *c, reach);
        }
        self.branch(first, parts.len())
    }

    fn branch(&self, first: usize, count: usize) -> Node {
        let mut node = EMPTY;
        for child in &self.nodes[first..first + count] {
            for i in 0..3 {
                node.low[i] = node.low[i].min(child.low[i]);
                node.high[i] = node.high[i].max(child.high[i]);
            }
        }
        node.kind = Kind::Branch(index(first), index(count));
        node
    }

    /// A node over a rectangle of a patch; `piece` is that part of it.
    fn node(&mut self, patch: usize, piece: &Patch, area: Area, depth: u32, reach: f64) -> Node {
        let derivatives = self.derivatives[patch].boxes(area.u, area.v);
        let (hull, bend) = (hull(piece), Bend::new(&derivatives));
        let sure = if bend.is_convex_within(&hull, reach) { self.piece(patch, area) } else { NONE };
        self.slabs.push(Slab::new(piece));
        let slab = index(self.slabs.len() - 1);
        if depth == SHALLOWEST {
            self.glides[patch].add(&hull, &derivatives);
        }
        if depth >= SHALLOWEST {
            let size = 2.0 * self.slabs[slab as usize].radius;
            let fits = convex(&derivatives, &cone(&derivatives, reach, size)) && size < reach.max(1e-3);
            let large = size > LARGE * reach && depth < STEEPEST && self.leaves.len() < MOST_LEAVES;
            if fits || depth >= DEEPEST && !large {
                self.upright &= rises(&derivatives);
                self.leaves.push(Leaf { patch, area, hull, bend });
                let kind = Kind::Leaf(index(self.leaves.len() - 1));
                return Node { low: hull.map(|i| i.lo), high: hull.map(|i| i.hi), kind, sure, slab };
            }
        }
        let first = self.nodes.len();
        self.nodes.resize(first + 4, EMPTY);
        let quarters = Area::WHOLE.quarters();
        for (k, (part, inside)) in area.quarters().iter().zip(quarters).enumerate() {
            let child = piece.restrict(inside.u, inside.v);
            self.nodes[first + k] = self.node(patch, &child, *part, depth + 1, reach);
        }
        Node { sure, slab, ..self.branch(first, 4) }
    }

    fn piece(&mut self, patch: usize, area: Area) -> u32 {
        self.sure.push((patch, area));
        index(self.sure.len() - 1)
    }

    /// The foot of `x`: the nearest point of the whole surface. `hint`: a foot of a point near by.
    #[must_use]
    pub fn nearest(&self, x: Point3, hint: Option<&Foot>) -> Foot {
        self.nearest_within(x, hint, f64::INFINITY)
    }

    /// The foot of `x`, if it is nearer than `within`; else some point of the surface, and `certain` is `within` or
    /// more. Far from the surface this is much quicker than the exact foot.
    #[must_use]
    pub fn nearest_within(&self, x: Point3, hint: Option<&Foot>, within: f64) -> Foot {
        let start = match hint {
            Some(foot) => (foot.patch, Area::WHOLE.clamp(foot.uv)),
            None => self.guess(x),
        };
        let (first, settled) = settle(&self.net.patches()[start.0], x, start.1, &Area::WHOLE);
        let mut quest = Quest::new(self, x, (first.foot(start.0), settled), within);
        STACK.with_borrow_mut(|stack| quest.run(stack));
        quest.finish()
    }

    /// Whether some point of the surface is nearer to `x` than `distance`; true as well where the search was given up.
    #[must_use]
    pub fn comes_within(&self, x: Point3, hint: &Foot, distance: f64) -> bool {
        let start = Area::WHOLE.clamp(hint.uv);
        let (first, settled) = settle(&self.net.patches()[hint.patch], x, start, &Area::WHOLE);
        let start = (first.foot(hint.patch), settled);
        let mut quest = Quest::new(self, x, start, distance).until(distance);
        STACK.with_borrow_mut(|stack| quest.run(stack));
        quest.finish().certain < distance
    }

    /// The stationary point of the distance that Newton's method finds from `hint` on its patch: near by, but not
    /// necessarily the nearest of all.
    #[must_use]
    pub fn nearby(&self, x: Point3, hint: &Foot) -> Foot {
        let start = Area::WHOLE.clamp(hint.uv);
        descend(&self.net.patches()[hint.patch], x, start, &Area::WHOLE).foot(hint.patch)
    }

    /// A leaf near `x`.
    fn guess(&self, x: Point3) -> (usize, [f64; 2]) {
        let mut node = &self.nodes[0];
        loop {
            match node.kind {
                Kind::Leaf(leaf) => {
                    let leaf = &self.leaves[leaf as usize];
                    return (leaf.patch, leaf.area.middle());
                }
                Kind::Branch(first, count) => {
                    let children = &self.nodes[first as usize..(first + count) as usize];
                    let near = |n: &&Node| middle_distance(n, x);
                    match children.iter().min_by(|a, b| near(a).total_cmp(&near(b))) {
                        Some(child) => node = child,
                        None => return (0, [0.5, 0.5]),
                    }
                }
            }
        }
    }

    /// Walks down the boxes (low corner, high corner, whether it is a leaf); stops at those for which `enter` is false.
    pub fn visit(&self, enter: &mut dyn FnMut([f64; 3], [f64; 3], bool) -> bool) {
        let mut stack = vec![0u32];
        while let Some(next) = stack.pop() {
            let node = &self.nodes[next as usize];
            let leaf = matches!(node.kind, Kind::Leaf(_));
            if let (true, Kind::Branch(first, count)) = (enter(node.low, node.high, leaf), node.kind) {
                stack.extend(first..first + count);
            }
        }
    }
}

thread_local! {
    /// The branches that a question has yet to look at; kept, because questions are asked by the million.
    static STACK: RefCell<Vec<(f64, u32)>> = const { RefCell::new(Vec::new()) };
}

const EMPTY: Node = Node {
    low: [f64::INFINITY; 3],
    high: [f64::NEG_INFINITY; 3],
    kind: Kind::Branch(0, 0),
    sure: NONE,
    slab: NONE,
};

#[allow(clippy::cast_possible_truncation)]
fn index(n: usize) -> u32 {
    // A net has far fewer than 2^32 leaves: its poles come from a program text.
    n as u32
}

fn hull(piece: &Patch) -> [Interval; 3] {
    if !piece.is_rational() {
        let [x, y, z, _] = hulls(piece);
        return [x, y, z];
    }
    let [m, n] = piece.degree();
    let first = piece.pole(0, 0);
    let mut hull = [first.x, first.y, first.z].map(Interval::point);
    for k in 0..(m + 1) * (n + 1) {
        let p = piece.pole(k / (n + 1), k % (n + 1));
        hull = core::array::from_fn(|i| hull[i].union(Interval::point(p[i])));
    }
    hull.map(|i| i.slackened(64.0))
}

/// Whether the normal certainly has a component along z.
fn rises(derivatives: &[[Interval; 3]; 5]) -> bool {
    let [ru, rv, ..] = derivatives;
    let w = ru[0] * rv[1] - ru[1] * rv[0];
    w.lo > 0.0 || w.hi < 0.0
}

/// Where a tool centre up to `reach` above a piece of surface of this `size` lies, seen from any of its points.
fn cone(derivatives: &[[Interval; 3]; 5], reach: f64, size: f64) -> [Interval; 3] {
    let [ru, rv, ..] = derivatives;
    let cross = |a: usize, b: usize| ru[a] * rv[b] - ru[b] * rv[a];
    let w = [cross(1, 2), cross(2, 0), cross(0, 1)];
    let norm = (w[0].square() + w[1].square() + w[2].square()).sqrt();
    let inverse = norm.recip();
    let around = Interval { lo: -size, hi: size };
    w.map(|c| {
        let unit = c * inverse;
        let limited = Interval { lo: unit.lo.max(-1.0), hi: unit.hi.min(1.0) };
        let most = limited.magnitude().min(1.0) * reach;
        // Normals of either sense: the patch may run either way.
        let both = if limited.lo > 0.0 || limited.hi < 0.0 {
            limited * Interval { lo: 0.0, hi: reach }
        } else {
            Interval { lo: -most, hi: most }
        };
        both + around
    })
}

/// Whether G - offset·D is positive definite for all offsets and derivatives in these boxes.
fn convex(derivatives: &[[Interval; 3]; 5], offset: &[Interval; 3]) -> bool {
    let [ru, rv, ruu, ruv, rvv] = derivatives;
    let dot = |a: &[Interval; 3], b: &[Interval; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let squares = |a: &[Interval; 3]| a[0].square() + a[1].square() + a[2].square();
    let h11 = squares(ru) - dot(offset, ruu);
    let h22 = squares(rv) - dot(offset, rvv);
    let h12 = dot(ru, rv) - dot(offset, ruv);
    let most = h12.magnitude();
    h11.lo > 0.0 && h22.lo > 0.0 && h11.lo * h22.lo > most * most
}

fn middle_distance(node: &Node, x: Point3) -> f64 {
    let at = |i: usize| 0.5 * (node.low[i] + node.high[i]) - x[i];
    at(0) * at(0) + at(1) * at(1) + at(2) * at(2)
}

fn box_distance(low: &[f64; 3], high: &[f64; 3], x: Point3) -> f64 {
    let beyond = |i: usize| (low[i] - x[i]).max(x[i] - high[i]).max(0.0);
    let (dx, dy, dz) = (beyond(0), beyond(1), beyond(2));
    (dx * dx + dy * dy + dz * dz).sqrt()
}

#[cfg(test)]
mod tests;
