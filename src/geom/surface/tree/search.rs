//! The best place of a surface for a convex tool: how high it must stand, how near it comes.
//!
//! Every plane that touches the tool from outside bounds what a piece of surface can score, by Taylor's formula about
//! the piece's middle with its leaf's bounds of the second derivatives. The planes tried are parallel to the surface
//! in the middle of the piece, to the tool where it faces the piece or the best place so far, and to both as far as a sharp
//! rim lets them. Near the best place they are right to the second order, whether the tool is rounded there or sharp: a
//! few pieces of every size settle it. About a place where the tool's own roundness makes the score concave, a rectangle is
//! settled at once: where a concave function does not rise, it is largest.

use std::collections::BinaryHeap;

use super::bend::Bend;
use super::{Area, Foot, Kind, Leaf, SurfaceTree};
use crate::geom::extremum::Section;
use crate::geom::surface::patch::SurfaceJet;
use crate::geom::{Point3, Vec3};

/// What is wanted of a point.
pub(super) trait Aim {
    /// No point of the box scores more.
    fn in_box(&self, low: [f64; 3], high: [f64; 3]) -> f64;
    /// What a point scores; below [`NOTHING`] where it does not count.
    fn score(&self, q: Point3) -> f64;
    /// The normal, into the tool, of the plane that touches it where it faces a point.
    fn facing(&self, q: Point3) -> Option<Vec3>;
    /// The normal in the plane through the tool's axis and a point that is nearest to `n`.
    fn radial(&self, q: Point3, n: Vec3) -> Option<Vec3>;
    /// The normal of the plane that touches the tool on its way along a rim which faces a point; `None` where there is no such
    /// plane, or many.
    fn along_rim(&self, _q: Point3) -> Option<Vec3> {
        None
    }
    /// (k, c) such that no point q scores more than k (n·q + c), for a unit vector `n` into the tool.
    fn plane(&self, n: Vec3) -> Option<(f64, f64)>;
    /// Newton's step in the patch's parameters towards the best place.
    fn step(&self, jet: &SurfaceJet) -> Option<[f64; 2]>;
    /// Sizes of a rectangle about a best place on which the score may be concave, mm, the larger first.
    fn sizes(&self) -> [f64; 4] {
        [0.0; 4]
    }
    /// The score's gradient at a place, if the score is certainly concave over a rectangle of these half widths about it, over
    /// which `bend` bounds the derivatives.
    fn concave(&self, _at: &SurfaceJet, _bend: &Bend, _half: [f64; 2]) -> Option<[f64; 2]> {
        None
    }
}

/// Scores below this are no scores.
pub(super) const NOTHING: f64 = -1e8;

/// The best place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spot {
    pub patch: usize,
    pub uv: [f64; 2],
    pub point: Point3,
}

/// A search.
pub(super) struct Search<'a, A> {
    tree: &'a SurfaceTree,
    aim: &'a A,
    /// Best score found, and where.
    pub best: f64,
    pub spot: Option<Spot>,
    facing: Option<Vec3>,
    /// Whether Newton's method, or a search along an edge, led to the best place.
    polished: bool,
    /// Nothing in this rectangle of a patch is better than the best place, but for the accuracy.
    summit: Option<(usize, Area)>,
    /// Whether such a rectangle about the best place has been looked for.
    surveyed: bool,
    /// Scores of at most this are of no interest.
    floor: f64,
    /// Once a better score is found nothing more is asked.
    until: f64,
    accuracy: f64,
    /// Largest bound of what was given up.
    open: f64,
    budget: u32,
}

/// A part of the surface that is still to be looked at, the most promising first.
struct Open {
    bound: f64,
    part: Part,
}

enum Part {
    Node(u32),
    Piece(u32, Area, u32),
}

impl PartialEq for Open {
    fn eq(&self, other: &Open) -> bool {
        self.bound.total_cmp(&other.bound).is_eq()
    }
}
impl Eq for Open {}
impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Open) -> Option<core::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Open {
    fn cmp(&self, other: &Open) -> core::cmp::Ordering {
        self.bound.total_cmp(&other.bound)
    }
}

/// Pieces that one search may cut up.
const MOST_PIECES: u32 = 20_000;
/// Newton steps of one attempt.
const STEPS: u32 = 8;
/// Depths between attempts to come to the best place by Newton's method.
const EVERY: u32 = 3;
/// From this depth on, pieces are bounded by their poles as well.
const HULL_FROM: u32 = 5;
/// From this depth on, pieces about the best place are not left to the bounds of their leaf.
const SURVEYED_FROM: u32 = 2;
/// Pieces are not cut below this size of their parameters.
const SMALLEST: f64 = 1e-11;

impl<'a, A: Aim> Search<'a, A> {
    pub(super) fn new(tree: &'a SurfaceTree, aim: &'a A, accuracy: f64) -> Search<'a, A> {
        Search {
            tree,
            aim,
            best: f64::NEG_INFINITY,
            spot: None,
            facing: None,
            polished: false,
            summit: None,
            surveyed: false,
            floor: NOTHING,
            until: f64::INFINITY,
            accuracy,
            open: f64::NEG_INFINITY,
            budget: tree.budget(MOST_PIECES),
        }
    }
    /// Scores of at most `floor` are of no interest.
    pub(super) fn above(self, floor: f64) -> Search<'a, A> {
        Search { floor: floor.max(NOTHING), ..self }
    }

    /// The search may end at any score above this.
    pub(super) fn until(self, until: f64) -> Search<'a, A> {
        Search { until, ..self }
    }

    /// No point of the surface scores more than this (the floor, where all score less).
    pub(super) fn bound(&self) -> f64 {
        self.best.max(self.floor).max(self.open) + if self.best > self.floor { self.accuracy } else { 0.0 }
    }

    /// Whether something was given up that may be of interest.
    pub(super) fn gave_up(&self) -> bool {
        self.open > self.floor
    }

    fn limit(&self) -> f64 {
        if self.best > self.floor { self.best + self.accuracy } else { self.floor }
    }

    /// Tries a place from which the best one may be near.
    pub(super) fn start(&mut self, near: &Foot) {
        self.approach(near.patch, Area::WHOLE.clamp(near.uv));
    }

    /// Looks for the best place, first from one near by.
    pub(super) fn run(mut self, hint: Option<&Foot>) -> Search<'a, A> {
        if let Some(foot) = hint {
            self.start(foot);
        }
        self.look();
        self
    }

    fn look(&mut self) {
        let mut open = BinaryHeap::from([Open { bound: f64::INFINITY, part: Part::Node(0) }]);
        while let Some(Open { bound, part }) = open.pop() {
            if bound <= self.limit() || self.best > self.until {
                return;
            }
            match part {
                Part::Node(node) => self.node(node, &mut open),
                Part::Piece(leaf, area, depth) => {
                    if depth >= SURVEYED_FROM {
                        self.survey(leaf, &area);
                    }
                    if self.is_settled(leaf, &area) {
                        continue;
                    }
                    let [du, dv] = area.half();
                    if self.budget == 0 || du.max(dv) < SMALLEST {
                        self.open = self.open.max(bound);
                        return;
                    }
                    self.budget -= 1;
                    self.tree.spend(1);
                    area.parts(|area| self.piece(leaf, area, depth + 1, bound, &mut open));
                }
            }
        }
    }

    fn node(&mut self, node: u32, open: &mut BinaryHeap<Open>) {
        match self.tree.nodes[node as usize].kind {
            Kind::Leaf(leaf) => {
                let area = self.tree.leaves[leaf as usize].area;
                self.piece(leaf, area, 0, f64::INFINITY, open);
            }
            Kind::Branch(first, count) => {
                for child in first..first + count {
                    let node = &self.tree.nodes[child as usize];
                    let bound = self.aim.in_box(node.low, node.high);
                    if bound > self.limit() {
                        open.push(Open { bound, part: Part::Node(child) });
                    }
                }
            }
        }
    }

    /// Looks at a piece, and keeps it for later if it may hold something better than what is known.
    fn piece(&mut self, leaf: u32, area: Area, depth: u32, before: f64, open: &mut BinaryHeap<Open>) {
        let own = &self.tree.leaves[leaf as usize];
        if self.is_settled(leaf, &area) {
            return;
        }
        let Some(bound) = self.bound_of(own, &area, depth) else { return };
        if depth.is_multiple_of(EVERY) && !(self.polished && self.is_about_best(own.patch, &area)) {
            self.approach(own.patch, area.middle());
            self.edges(own.patch, &area);
        }
        let bound = bound.min(before);
        if bound > self.limit() {
            open.push(Open { bound, part: Part::Piece(leaf, area, depth) });
        }
    }

    /// Whether the best place lies on a piece or beside it.
    fn is_about_best(&self, patch: usize, area: &Area) -> bool {
        let [du, dv] = area.half();
        let around = Area { u: (area.u.0 - du, area.u.1 + du), v: (area.v.0 - dv, area.v.1 + dv) };
        self.spot.is_some_and(|s| s.patch == patch && around.holds(s.uv))
    }

    /// Whether nothing on a piece is better than the best place.
    fn is_settled(&self, leaf: u32, area: &Area) -> bool {
        let patch = self.tree.leaves[leaf as usize].patch;
        self.summit.is_some_and(|(own, top)| {
            own == patch
                && top.u.0 <= area.u.0
                && area.u.1 <= top.u.1
                && top.v.0 <= area.v.0
                && area.v.1 <= top.v.1
        })
    }

    /// Looks for a rectangle about the best place over which the score is concave, once a piece with it on is to be cut up.
    fn survey(&mut self, leaf: u32, area: &Area) {
        let patch = self.tree.leaves[leaf as usize].patch;
        if self.surveyed || !self.polished || !self.is_about_best(patch, area) {
            return;
        }
        let Some(Spot { patch, uv: [u, v], .. }) = self.spot else { return };
        self.surveyed = true;
        let jet = self.tree.net.patches()[patch].jet(u, v);
        for size in self.aim.sizes() {
            let half = [size / jet.u.norm(), size / jet.v.norm()];
            if !half.iter().all(|h| h.is_finite() && *h > 0.0) {
                return;
            }
            let part = |t: f64, h: f64| ((t - h).max(0.0), (t + h).min(1.0));
            let about = Area { u: part(u, half[0]), v: part(v, half[1]) };
            let bend = Bend::new(&self.tree.derivatives[patch].boxes(about.u, about.v));
            let most = |g: f64, t: f64, (a, b): (f64, f64)| (g * (a - t)).max(g * (b - t));
            let rises = |g: [f64; 2]| most(g[0], u, about.u) + most(g[1], v, about.v);
            let curved = || self.aim.concave(&jet, &bend, half).is_some_and(|g| rises(g) <= self.accuracy);
            if self.falls_off(&jet, &bend, &rises) || curved() {
                self.summit = Some((patch, about));
                return;
            }
        }
    }

    /// Whether all of a rectangle about the best place lies below a plane that touches the tool there, but for the accuracy.
    fn falls_off(&self, at: &SurfaceJet, bend: &Bend, rises: &dyn Fn([f64; 2]) -> f64) -> bool {
        let below = |n: Vec3| {
            let Some((scale, offset)) = self.aim.plane(n) else { return false };
            let above = scale * (n.dot(&at.p.coords) + offset) - self.best;
            is_concave(bend, n) && above + scale * rises([n.dot(&at.u), n.dot(&at.v)]) <= self.accuracy
        };
        at.normal().is_some_and(below) || self.facing.is_some_and(below)
    }

    /// The bound of a piece, if it may hold something better than what is known.
    fn bound_of(&mut self, leaf: &Leaf, area: &Area, depth: u32) -> Option<f64> {
        let uv = area.middle();
        let jet = self.tree.net.patches()[leaf.patch].jet(uv[0], uv[1]);
        self.offer(leaf.patch, uv, jet.p);
        let limit = self.limit();
        let half = area.half();
        let about = leaf.bend.spread(&jet, half);
        let mut bound = self.aim.in_box((jet.p.coords - about).into(), (jet.p.coords + about).into());
        if bound <= limit {
            return None;
        }
        let mut planes = [None; 5];
        for (k, plane) in planes.iter_mut().enumerate() {
            let normal = match k {
                0 => self.aim.facing(jet.p),
                1 => jet.normal(),
                2 => self.facing,
                3 => self.aim.along_rim(jet.p),
                _ => jet.normal().and_then(|n| self.aim.radial(jet.p, n)),
            };
            *plane = normal.and_then(|n| Some((n, self.aim.plane(n)?)));
            let Some((n, (scale, offset))) = *plane else { continue };
            bound = bound.min(scale * (n.dot(&jet.p.coords) + offset + rise(leaf, &jet, n, half)));
            if bound <= limit {
                return None;
            }
        }
        bound = bound.min(self.beside_best(leaf, area));
        if bound > limit && depth >= HULL_FROM {
            bound = bound.min(self.hull(leaf.patch, area, &planes));
        }
        (bound > limit).then_some(bound)
    }

    /// The bound of a piece beside the best place, or with it on, from the piece's place nearest to it: where a concave
    /// function falls, it goes on falling.
    fn beside_best(&self, leaf: &Leaf, area: &Area) -> f64 {
        let Some(spot) = self.spot.filter(|s| s.patch == leaf.patch && self.polished) else {
            return f64::INFINITY;
        };
        let [u, v] = area.clamp(spot.uv);
        let jet = self.tree.net.patches()[leaf.patch].jet(u, v);
        let most = |g: f64, t: f64, (a, b): (f64, f64)| (g * (a - t)).max(g * (b - t));
        let rises = |g: [f64; 2]| most(g[0], u, area.u) + most(g[1], v, area.v);
        let below = |n: Vec3| {
            let (scale, offset) = self.aim.plane(n).filter(|_| is_concave(&leaf.bend, n))?;
            Some(scale * (n.dot(&jet.p.coords) + offset + rises([n.dot(&jet.u), n.dot(&jet.v)])))
        };
        if let Some(bound) = self.facing.and_then(below) {
            return bound;
        }
        let half = [(u - area.u.0).max(area.u.1 - u), (v - area.v.0).max(area.v.1 - v)];
        let curved = self.aim.concave(&jet, &leaf.bend, half);
        curved.map_or(f64::INFINITY, |g| self.aim.score(jet.p) + rises(g))
    }

    /// The least bound by planes over the poles of a piece: right where the tool lies on a whole line.
    fn hull(&self, patch: usize, area: &Area, planes: &[Option<(Vec3, (f64, f64))>]) -> f64 {
        let piece = self.tree.net.patches()[patch].restrict(area.u, area.v);
        let most = |(n, (scale, offset)): (Vec3, (f64, f64))| {
            let of = |h: &nalgebra::Vector4<f64>| n.dot(&h.xyz()) / h.w;
            scale * (piece.homogeneous().iter().map(of).fold(f64::NEG_INFINITY, f64::max) + offset)
        };
        planes.iter().flatten().copied().map(most).fold(f64::INFINITY, f64::min)
    }

    fn offer(&mut self, patch: usize, uv: [f64; 2], point: Point3) {
        let score = self.aim.score(point);
        if score > self.best {
            self.best = score;
            self.spot = Some(Spot { patch, uv, point });
            self.facing = self.aim.facing(point);
            (self.polished, self.surveyed, self.summit) = (false, false, None);
        }
    }

    /// Newton's method from a place.
    fn approach(&mut self, patch: usize, from: [f64; 2]) {
        let (surface, before) = (&self.tree.net.patches()[patch], self.best);
        let mut uv = from;
        for _ in 0..=STEPS {
            let jet = surface.jet(uv[0], uv[1]);
            self.offer(patch, uv, jet.p);
            let Some(step) = self.aim.step(&jet) else { return };
            let next = Area::WHOLE.clamp([uv[0] + step[0], uv[1] + step[1]]);
            let moved = (next[0] - uv[0]).abs().max((next[1] - uv[1]).abs());
            if !moved.is_finite() {
                return;
            }
            if moved < 1e-12 {
                break;
            }
            uv = next;
        }
        self.polished |= self.best > before;
    }

    /// The best places on edges of the patch that a piece touches.
    fn edges(&mut self, patch: usize, area: &Area) {
        let [u, v] = area.middle();
        for (t, near) in [(0.0, area.u.0), (1.0, area.u.1)] {
            if t == near {
                self.along_edge(patch, area.v, v, &|x| [t, x]);
            }
        }
        for (t, near) in [(0.0, area.v.0), (1.0, area.v.1)] {
            if t == near {
                self.along_edge(patch, area.u, u, &|x| [x, t]);
            }
        }
    }

    /// Golden section about a part of an edge.
    fn along_edge(&mut self, patch: usize, (a, b): (f64, f64), middle: f64, place: &dyn Fn(f64) -> [f64; 2]) {
        const ROUNDS: usize = 48;
        let (surface, before) = (&self.tree.net.patches()[patch], self.best);
        let reach = b - a;
        let range = ((middle - reach).max(0.0), (middle + reach).min(1.0));
        let score = |t: f64| {
            let [u, v] = place(t);
            self.aim.score(surface.point(u, v))
        };
        let Section { ends: (a, b), inner: [(x, _), (y, _)] } = Section::about_maximum(score, range, ROUNDS);
        for t in [a, x, y, b] {
            let [u, v] = place(t);
            self.offer(patch, [u, v], surface.point(u, v));
        }
        self.polished |= self.best > before;
    }
}

/// Whether n·r is certainly concave over a rectangle.
fn is_concave(bend: &Bend, n: Vec3) -> bool {
    let [uu, uv, vv] = bend.along(n);
    let mixed = uv.magnitude();
    uu.hi < 0.0 && vv.hi < 0.0 && uu.hi * vv.hi > mixed * mixed * (1.0 + 1e-9)
}

/// How far a piece with these half widths rises along `n` above its middle at most.
fn rise(leaf: &Leaf, jet: &SurfaceJet, n: Vec3, [du, dv]: [f64; 2]) -> f64 {
    let [uu, uv, vv] = leaf.bend.along(n);
    let linear = n.dot(&jet.u).abs() * du + n.dot(&jet.v).abs() * dv;
    let curved = 0.5 * (uu.hi.max(0.0) * du * du + vv.hi.max(0.0) * dv * dv) + uv.magnitude() * du * dv;
    (linear + curved) * (1.0 + 1e-13)
}

/// Solves a x = b for the 2 x 2 matrix with columns `a`.
pub(super) fn solve(a: [[f64; 2]; 2], b: [f64; 2]) -> Option<[f64; 2]> {
    let det = a[0][0] * a[1][1] - a[1][0] * a[0][1];
    let size = a.iter().flatten().map(|x| x.abs()).fold(0.0, f64::max);
    (det.abs() > 1e-14 * size * size)
        .then(|| [(b[0] * a[1][1] - a[1][0] * b[1]) / det, (a[0][0] * b[1] - b[0] * a[0][1]) / det])
}
