//! The exact curve made ready for measuring: nodes with exact Frenet data, arc length, and the search for the foot of
//! a point.
//!
//! Nothing is measured against the nodes: they only tell where to look. A foot is found on the exact curve, by Newton's
//! method on its Frenet data. Between neighbouring nodes the curve turns by at most [`MOST_TURN`]; the range of
//! curvature between them is taken from the nodes with a margin of half their largest step.

use crate::geom::curve::{Frenet, PlanarCurve, spans};
use crate::geom::{Point2, Vec2, cross};
use crate::math::atan2;

/// Largest turn of the tangent between neighbouring nodes, radians.
const MOST_TURN: f64 = 0.03;
/// Cells of a smooth span before it is refined.
const FIRST_CELLS: usize = 8;
/// Deepest halving of a cell.
const DEEPEST: u32 = 12;
/// A tangent jump above this, radians, is a corner.
const CORNER: f64 = 1e-7;
/// Newton's method stops at a tangential residue below this, mm.
const FOOT_ACCURACY: f64 = 1e-12;

/// A sample of the exact curve.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    span: usize,
    u: f64,
    f: Frenet,
    /// Arc length from the curve's start, mm.
    sigma: f64,
}

/// How a point sees the curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum FootKind {
    /// Perpendicular on a smooth place.
    Smooth,
    /// The nearest place is a corner.
    Corner,
    /// Beyond an end of an open curve, by this many mm along its tangent.
    Beyond(f64),
}

/// The foot of a point on the curve.
#[derive(Debug, Clone, Copy)]
pub(super) struct Foot {
    /// Cell (index of its first node) in which it lies.
    pub cell: usize,
    /// Whole turns of a closed curve.
    pub turn: f64,
    /// Signed distance, left positive, mm.
    pub d: f64,
    /// Unit tangent of the curve there.
    pub t: Vec2,
    /// Curvature there.
    pub k: f64,
    /// Arc length from the start of the curve, whole turns included, mm.
    pub sigma: f64,
    /// Kind.
    pub kind: FootKind,
}

/// An exact curve with its nodes.
#[derive(Debug)]
pub(super) struct Rail<'a> {
    curve: &'a dyn PlanarCurve,
    nodes: Vec<Node>,
    /// Node indices after which a corner lies.
    corners: Vec<usize>,
    closed: bool,
    /// Whole arc length, mm.
    pub length: f64,
    /// The curve runs backwards or stands still somewhere: it can't be measured against.
    pub degenerate: bool,
    tree: super::tree::Tree,
}

impl<'a> Rail<'a> {
    pub(super) fn new(curve: &'a dyn PlanarCurve) -> Self {
        let mut builder = Builder { curve, nodes: Vec::new(), degenerate: false };
        for (span, a, b) in spans(curve) {
            if b > a {
                builder.span(span, a, b);
            }
        }
        let nodes = builder.nodes;
        let closed = curve.is_closed();
        let length = nodes.last().map_or(0.0, |n| n.sigma);
        let degenerate = builder.degenerate || nodes.len() < 2 || !length.is_finite() || length <= 0.0;
        let corners = corners(&nodes, closed);
        let tree = super::tree::Tree::new(nodes.iter().map(|n| n.f.p));
        Rail { curve, nodes, corners, closed, length, degenerate, tree }
    }

    /// Whether the curve is closed.
    pub(super) fn is_closed(&self) -> bool {
        self.closed
    }

    /// Point and tangent at the start (`false`) or the end of the curve.
    pub(super) fn end(&self, last: bool) -> Frenet {
        let node = if last { self.nodes.last() } else { self.nodes.first() };
        node.map_or(Frenet { p: Point2::origin(), t: Vec2::x(), speed: 0.0, k: 0.0 }, |n| n.f)
    }

    /// How far `q` is ahead of the node along its tangent.
    fn ahead(&self, node: usize, q: Point2) -> f64 {
        self.nodes.get(node).map_or(0.0, |n| (q - n.f.p).dot(&n.f.t))
    }

    /// The nearest foot of all.
    pub(super) fn nearest(&self, q: Point2) -> Foot {
        let cell = self.tree.nearest(q).min(self.nodes.len().saturating_sub(2));
        self.foot(q, cell, 0.0)
    }

    /// A foot to start following from: the nearest on a closed curve, the start of an open one.
    pub(super) fn nearest_for_start(&self, q: Point2) -> Foot {
        if self.closed { self.nearest(q) } else { self.foot(q, 0, 0.0) }
    }

    /// The foot nearest to the given cell, walking along the curve from there; `turn` counts whole turns.
    pub(super) fn foot(&self, q: Point2, cell: usize, turn: f64) -> Foot {
        let mut best = self.walk(q, cell, turn);
        let first = best;
        for &corner in self.corners.iter().filter(|&&c| self.near(&first, c)) {
            for (cell, turn) in self.beside(corner, &first) {
                let other = self.walk(q, cell, turn);
                if other.d.abs() < best.d.abs() {
                    best = other;
                }
            }
        }
        best
    }

    /// Whether a corner is so near to a foot that another foot may lie behind it.
    fn near(&self, foot: &Foot, corner: usize) -> bool {
        let Some(node) = self.nodes.get(corner) else { return false };
        let gap = (node.sigma - (foot.sigma - foot.turn * self.length)).abs();
        let gap = if self.closed { gap.min((self.length - gap).abs()) } else { gap };
        gap <= 4.0 * foot.d.abs() + 1e-6
    }

    /// The cells before and after a corner, each with its turn, as seen from a foot near it.
    fn beside(&self, corner: usize, foot: &Foot) -> [(usize, f64); 2] {
        let last = self.nodes.len().saturating_sub(2);
        if corner + 1 < self.nodes.len() {
            return [(corner.saturating_sub(1), foot.turn), ((corner + 1).min(last), foot.turn)];
        }
        let before_the_seam = foot.sigma - foot.turn * self.length > 0.5 * self.length;
        let turn = if before_the_seam { foot.turn } else { foot.turn - 1.0 };
        [(last, turn), (0, turn + 1.0)]
    }

    fn walk(&self, q: Point2, cell: usize, turn: f64) -> Foot {
        let last = self.nodes.len().saturating_sub(2);
        let (mut cell, mut turn) = (cell.min(last), turn);
        for _ in 0..=self.nodes.len() {
            if self.ahead(cell, q) < 0.0 {
                if cell > 0 {
                    cell -= 1;
                } else if !self.closed {
                    return self.beyond(q, 0, turn);
                } else if self.wraps_corner(q, last) {
                    return self.corner(q, last + 1, 0, turn - 1.0);
                } else {
                    cell = last;
                    turn -= 1.0;
                }
            } else if self.ahead(cell + 1, q) > 0.0 {
                if cell < last {
                    cell += 1;
                } else if !self.closed {
                    return self.beyond(q, last + 1, turn);
                } else if self.ahead(0, q) < 0.0 {
                    return self.corner(q, last + 1, 0, turn);
                } else {
                    cell = 0;
                    turn += 1.0;
                }
            } else {
                break;
            }
        }
        self.in_cell(q, cell, turn)
    }

    /// Behind the first node of a closed curve and ahead of its last: the seam is a corner.
    fn wraps_corner(&self, q: Point2, last: usize) -> bool {
        self.ahead(last + 1, q) > 0.0
    }

    fn in_cell(&self, q: Point2, cell: usize, turn: f64) -> Foot {
        let (Some(a), Some(b)) = (self.nodes.get(cell), self.nodes.get(cell + 1)) else {
            return self.beyond(q, cell, turn);
        };
        if a.span != b.span {
            return self.corner(q, cell, cell + 1, turn);
        }
        let (fa, fb) = (self.ahead(cell, q), self.ahead(cell + 1, q));
        let (mut lo, mut hi) = (a.u, b.u);
        let mut u = if fa > fb { a.u + (b.u - a.u) * (fa / (fa - fb)).clamp(0.0, 1.0) } else { a.u };
        let mut f = self.curve.at_in(a.span, u);
        for _ in 0..60 {
            let residue = (q - f.p).dot(&f.t);
            if residue.abs() <= FOOT_ACCURACY {
                break;
            }
            if residue > 0.0 {
                lo = u
            } else {
                hi = u
            }
            let d = (q - f.p).dot(&f.n());
            let step = residue / (f.speed * (1.0 - f.k * d));
            let next = u + step;
            let next = if next > lo && next < hi { next } else { 0.5 * (lo + hi) };
            if next.to_bits() == u.to_bits() {
                break;
            }
            u = next;
            f = self.curve.at_in(a.span, u);
        }
        let sigma = a.sigma + part_length(a, b, u) + turn * self.length;
        Foot { cell, turn, d: (q - f.p).dot(&f.n()), t: f.t, k: f.k, sigma, kind: FootKind::Smooth }
    }

    /// The foot at a corner between nodes `a` and `b` (equal points).
    fn corner(&self, q: Point2, a: usize, b: usize, turn: f64) -> Foot {
        let (Some(before), Some(after)) = (self.nodes.get(a), self.nodes.get(b)) else {
            return self.beyond(q, a, turn);
        };
        let r = q - before.f.p;
        let middle = before.f.t + after.f.t;
        let t = middle / middle.norm().max(f64::MIN_POSITIVE);
        let jump = cross(before.f.t, after.f.t).abs() > CORNER;
        let d = if jump { r.norm().copysign(cross(t, r)) } else { cross(t, r) };
        let kind = if jump { FootKind::Corner } else { FootKind::Smooth };
        let cell = a.min(self.nodes.len().saturating_sub(2));
        Foot { cell, turn, d, t, k: before.f.k, sigma: before.sigma + turn * self.length, kind }
    }

    fn beyond(&self, q: Point2, node: usize, turn: f64) -> Foot {
        let last = node > 0;
        let f = self.end(last);
        let r = q - f.p;
        let sigma = if last { self.length } else { 0.0 };
        let cell = node.min(self.nodes.len().saturating_sub(2));
        let kind = FootKind::Beyond(r.dot(&f.t));
        Foot { cell, turn, d: r.dot(&f.n()), t: f.t, k: f.k, sigma: sigma + turn * self.length, kind }
    }

    /// Range of curvature from one foot to the other, and whether a corner lies between them.
    pub(super) fn curvature(&self, a: &Foot, b: &Foot) -> ((f64, f64), bool) {
        let (from, to) = if a.sigma <= b.sigma { (a, b) } else { (b, a) };
        let count = self.nodes.len();
        let mut range = (from.k.min(to.k), from.k.max(to.k));
        let mut corner = a.kind == FootKind::Corner || b.kind == FootKind::Corner;
        let mut cell = from.cell;
        let mut turn = from.turn;
        for _ in 0..count {
            corner |= self.widen(cell, &mut range);
            if cell == to.cell && turn >= to.turn || turn > to.turn {
                break;
            }
            cell += 1;
            if cell + 1 >= count {
                corner |= self.corners.last() == Some(&(count - 1));
                cell = 0;
                turn += 1.0;
            }
        }
        (range, corner)
    }

    /// Widens the range by the curvature of a cell; says whether the cell is a corner.
    fn widen(&self, cell: usize, range: &mut (f64, f64)) -> bool {
        let (Some(a), Some(b)) = (self.nodes.get(cell), self.nodes.get(cell + 1)) else { return false };
        if a.span != b.span {
            range.0 = range.0.min(a.f.k).min(b.f.k);
            range.1 = range.1.max(a.f.k).max(b.f.k);
            return self.corners.binary_search(&cell).is_ok();
        }
        let step = |i: usize, j: usize| match (self.nodes.get(i), self.nodes.get(j)) {
            (Some(x), Some(y)) if x.span == a.span && y.span == a.span => (x.f.k - y.f.k).abs(),
            _ => 0.0,
        };
        let margin =
            0.5 * step(cell, cell + 1).max(step(cell.wrapping_sub(1), cell)).max(step(cell + 1, cell + 2));
        range.0 = range.0.min(a.f.k.min(b.f.k) - margin);
        range.1 = range.1.max(a.f.k.max(b.f.k) + margin);
        false
    }
}

fn corners(nodes: &[Node], closed: bool) -> Vec<usize> {
    let jumps = |a: &Node, b: &Node| {
        a.span != b.span && cross(a.f.t, b.f.t).abs() > CORNER || a.f.t.dot(&b.f.t) < 0.0
    };
    let mut found: Vec<usize> = nodes
        .windows(2)
        .enumerate()
        .filter(|(_, w)| matches!(w, [a, b] if jumps(a, b)))
        .map(|(i, _)| i)
        .collect();
    if let (true, Some(first), Some(last)) = (closed, nodes.first(), nodes.last())
        && (cross(last.f.t, first.f.t).abs() > CORNER || last.f.t.dot(&first.f.t) < 0.0)
    {
        found.push(nodes.len() - 1);
    }
    found
}

/// Arc length from node `a` to parameter `u` in the cell to `b`: the cubic whose slopes are the speeds.
fn part_length(a: &Node, b: &Node, u: f64) -> f64 {
    let h = b.u - a.u;
    if h <= 0.0 {
        return 0.0;
    }
    let x = (u - a.u) / h;
    let (s, m0, m1) = (b.sigma - a.sigma, a.f.speed * h, b.f.speed * h);
    x * (m0 + x * (3.0 * s - 2.0 * m0 - m1 + x * (m0 + m1 - 2.0 * s)))
}

struct Builder<'a> {
    curve: &'a dyn PlanarCurve,
    nodes: Vec<Node>,
    degenerate: bool,
}

impl Builder<'_> {
    #[allow(clippy::cast_precision_loss)]
    fn span(&mut self, span: usize, a: f64, b: f64) {
        let sigma = self.nodes.last().map_or(0.0, |n| n.sigma);
        let mut from = Node { span, u: a, f: self.curve.at_in(span, a), sigma };
        self.push(from);
        for i in 1..=FIRST_CELLS {
            let u = if i == FIRST_CELLS { b } else { a + (b - a) * i as f64 / FIRST_CELLS as f64 };
            let f = self.curve.at_in(span, u);
            self.cell(from, Node { span, u, f, sigma: 0.0 }, 0);
            from = self.nodes.last().copied().unwrap_or(from);
        }
    }

    /// Adds the nodes after `a` up to `b`.
    fn cell(&mut self, a: Node, b: Node, depth: u32) {
        let u = 0.5 * (a.u + b.u);
        let middle = self.curve.at_in(a.span, u);
        let turn = turn(a.f.t, middle.t).max(turn(middle.t, b.f.t));
        if turn > 0.5 * MOST_TURN && depth < DEEPEST {
            self.cell(a, Node { span: a.span, u, f: middle, sigma: 0.0 }, depth + 1);
            let from = self.nodes.last().copied().unwrap_or(a);
            return self.cell(from, b, depth + 1);
        }
        let step = (b.u - a.u) / 6.0 * (a.f.speed + 4.0 * middle.speed + b.f.speed);
        self.degenerate |= middle.speed <= 0.0;
        self.push(Node { sigma: a.sigma + step, ..b });
    }

    fn push(&mut self, node: Node) {
        let f = &node.f;
        let finite = f.p.x.is_finite() && f.p.y.is_finite() && f.k.is_finite() && f.t.norm().is_finite();
        self.degenerate |= !finite || f.speed < 0.0;
        self.nodes.push(node);
    }
}

fn turn(a: Vec2, b: Vec2) -> f64 {
    atan2(cross(a, b), a.dot(&b)).abs()
}
