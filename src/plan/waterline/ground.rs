//! How low the cutter comes over every place of the plan.
//!
//! Z(x, y) is the height of the tip of the cutter that rests on the surface with what it leaves. It is known exactly at any
//! place; on the nodes of a grid it is kept.

use std::sync::Arc;

use rayon::prelude::*;

use crate::geom::surface::heights::Blank;
use crate::geom::surface::{Contact, Cutter, SurfaceTree};
use crate::geom::{Point2, Vec2, nearest_on_way};
use crate::math::{ceil_to_usize, count};

/// A cutter that is let down on the surface.
#[derive(Debug, Clone)]
pub(super) struct Rest {
    pub tree: Arc<SurfaceTree>,
    pub cutter: Cutter,
    /// The cutter with a hull of what it leaves and what is kept for the path's own deviations.
    pub hull: Cutter,
    /// Radius of the cutter's end, mm.
    pub radius: f64,
}

impl Rest {
    /// `leave`: the hull about the cutter, mm.
    pub(super) fn new(tree: Arc<SurfaceTree>, cutter: Cutter, leave: f64) -> Rest {
        Rest { tree, cutter, hull: cutter.grown(leave), radius: cutter.radius() }
    }

    /// Height of the tip at rest, mm; minus infinity where the cutter touches nothing. `hint`: the contact at a place near by.
    pub(super) fn tip(&self, p: Point2, hint: &mut Option<Contact>) -> f64 {
        *hint = self.hull.drop(&self.tree, p.x, p.y, hint.as_ref());
        hint.map_or(f64::NEG_INFINITY, |c| c.centre.z - self.cutter.lift())
    }
}

/// Contacts near by.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Hints {
    own: Option<Contact>,
    border: Option<Contact>,
}

/// Nodes in equal distances.
#[derive(Debug, Clone)]
pub(super) struct Grid {
    pub low: Point2,
    pub step: f64,
    /// Nodes along x and y.
    pub counts: [usize; 2],
}

impl Grid {
    fn new(low: Point2, high: Point2, step: f64) -> Grid {
        let counts = [0, 1].map(|i| ceil_to_usize((high[i] - low[i]) / step).max(1) + 1);
        Grid { low, step, counts }
    }
    pub(super) fn len(&self) -> usize {
        self.counts[0] * self.counts[1]
    }
    pub(super) fn node(&self, k: usize) -> Point2 {
        let [i, j] = [k / self.counts[1], k % self.counts[1]].map(count);
        Point2::new(self.low.x + i * self.step, self.low.y + j * self.step)
    }
    /// The nodes beside a node, along x and y.
    pub(super) fn beside(&self, k: usize) -> impl Iterator<Item = usize> {
        let [columns, rows] = self.counts;
        let (i, j) = (k / rows, k % rows);
        let ways = [
            (i > 0).then(|| k - rows),
            (i + 1 < columns).then(|| k + rows),
            (j > 0).then(|| k - 1),
            (j + 1 < rows).then(|| k + 1),
        ];
        ways.into_iter().flatten()
    }
    /// The nodes around a place.
    pub(super) fn around(&self, p: Point2) -> [usize; 4] {
        let [i, j] = [0, 1].map(|axis| {
            let most = self.counts[axis].saturating_sub(2);
            // Not negative, and floats saturate.
            (((p[axis] - self.low[axis]) / self.step).max(0.0) as usize).min(most)
        });
        let k = i * self.counts[1] + j;
        [k, k + 1, k + self.counts[1], k + self.counts[1] + 1]
    }
    /// A field of the nodes between them, linear in x and y.
    pub(super) fn between(&self, field: &[f64], p: Point2) -> f64 {
        let at = |axis: usize| {
            let x = ((p[axis] - self.low[axis]) / self.step).clamp(0.0, count(self.counts[axis] - 1));
            // x is not negative, and floats saturate.
            let i = (x.floor() as usize).min(self.counts[axis].saturating_sub(2));
            (i, x - count(i))
        };
        let ((i, s), (j, t)) = (at(0), at(1));
        let value = |i: usize, j: usize| {
            let k = i.min(self.counts[0] - 1) * self.counts[1] + j.min(self.counts[1] - 1);
            field.get(k).copied().unwrap_or(0.0)
        };
        let row = |j: usize| value(i, j) * (1.0 - s) + value(i + 1, j) * s;
        row(j) * (1.0 - t) + row(j + 1) * t
    }
}

/// Nodes at most: a coarser grid asks for a larger margin, and takes it.
const MOST_NODES: f64 = 3e5;
/// Distance of the nodes as a share of the cutter's radius.
const NODES: f64 = 0.1;
/// Places on each edge of a patch that make the outline.
const EDGE: u32 = 48;

/// Everything that is known of the part in plan.
#[derive(Debug)]
pub(super) struct Ground {
    pub rest: Rest,
    pub grid: Grid,
    pub blank: Blank,
    /// The cutter may come from beside the blank: it nowhere reaches out of the net by more than the cutter's radius.
    pub open: bool,
    /// Outline of the net.
    outline: Vec<Point2>,
    /// Z at the nodes.
    tips: Vec<f64>,
    /// Distance of the nodes from the net's plan, where the cutter must stay over it.
    beyond: Vec<f64>,
}

/// Distance of nodes that a net and a blank ask for, mm: `air` beyond the blank belongs to the grid.
pub(super) fn spacing(radius: f64, blank: &Blank, tree: &SurfaceTree) -> f64 {
    let (low, high) = blank.bounds();
    let (a, b) = tree.bounds();
    let size = |i: usize| (high[i] - low[i]).max(b[i] - a[i]) + 4.0 * radius;
    (NODES * radius).max((size(0) * size(1) / MOST_NODES).sqrt())
}

impl Ground {
    /// `air`: how far beside the blank the cutter is clear of it, mm.
    pub(super) fn new(rest: Rest, blank: Blank, step: f64, air: f64) -> Ground {
        let outline = outline(&rest.tree);
        let open = rim(&blank).iter().all(|p| distance(&outline, *p) <= rest.radius);
        let (low, high) = if open {
            let (low, high) = blank.bounds();
            let out = Vec2::new(air + 2.0 * step, air + 2.0 * step);
            (low - out, high + out)
        } else {
            let (low, high) = rest.tree.bounds();
            let out = Vec2::new(2.0 * step, 2.0 * step);
            (low.xy() - out, high.xy() + out)
        };
        let grid = Grid::new(low, high, step);
        let rows = grid.counts[1];
        let mut ground = Ground { rest, grid, blank, open, outline, tips: Vec::new(), beyond: Vec::new() };
        let nodes: Vec<(f64, f64)> = (0..ground.grid.counts[0])
            .into_par_iter()
            .flat_map_iter(|i| {
                let mut hints = Hints::default();
                let ground = &ground;
                (i * rows..(i + 1) * rows).map(move |k| {
                    let p = ground.grid.node(k);
                    let (beyond, border) = nearest(&ground.outline, p);
                    let far = !ground.open && beyond > 2.0 * step;
                    let tip =
                        if far { f64::NEG_INFINITY } else { ground.tip(p, (beyond, border), &mut hints) };
                    (tip, beyond)
                })
            })
            .collect();
        ground.tips = nodes.iter().map(|n| n.0).collect();
        if !open {
            ground.beyond = nodes.iter().map(|n| n.1).collect();
        }
        ground
    }

    /// Z at a place; beside the net it is nowhere lower than at the nearest place of its border: the part goes on as high as
    /// it ends.
    fn tip(&self, p: Point2, (beyond, border): (f64, Point2), hints: &mut Hints) -> f64 {
        let own = self.rest.tip(p, &mut hints.own);
        if beyond <= 0.0 || !self.open { own } else { own.max(self.rest.tip(border, &mut hints.border)) }
    }

    /// Lowest height of the tip over the net and the blank.
    pub(super) fn lowest(&self) -> Option<f64> {
        let over = |k: usize| {
            let p = self.grid.node(k);
            self.blank.distance(p) <= 0.0 && distance(&self.outline, p) <= 0.0
        };
        let nodes = (0..self.grid.len()).filter(|k| self.tips[*k].is_finite() && over(*k));
        nodes.map(|k| self.tips[k]).min_by(f64::total_cmp)
    }

    /// Values of a level at the nodes: not positive where the tip may be at height `z`.
    pub(super) fn values(&self, z: f64) -> Vec<f64> {
        (0..self.grid.len()).map(|k| self.joined(self.tips[k] - z, self.beyond.get(k).copied())).collect()
    }

    fn joined(&self, over: f64, beyond: Option<f64>) -> f64 {
        over.max(-self.rest.radius).max(beyond.unwrap_or(f64::NEG_INFINITY))
    }

    /// The same at any place.
    pub(super) fn value(&self, p: Point2, z: f64, hints: &mut Hints) -> f64 {
        let (beyond, border) = nearest(&self.outline, p);
        self.joined(self.tip(p, (beyond, border), hints) - z, (!self.open).then_some(beyond))
    }

    /// Whether a node belongs to what is cleared: outside the blank there is nothing.
    pub(super) fn may_stand(&self, k: usize) -> bool {
        !self.open || self.blank.distance(self.grid.node(k)) <= 0.0
    }

    /// A height at which the tip is free at a place and for a part of the grid's step about it: not above `low` where the nodes
    /// around say so.
    pub(super) fn free_height(&self, p: Point2, low: f64, hints: &mut Hints) -> f64 {
        /// The surface may rise so much, as a share of the grid's step, between two places that are looked at.
        const RISE: f64 = 0.1;
        let around = self.grid.around(p);
        let inside = |k: &usize| self.beyond.get(*k).is_none_or(|off| *off <= 0.0);
        let nodes = around.iter().map(|k| self.tips[*k]).fold(f64::NEG_INFINITY, f64::max);
        if nodes <= low && around.iter().all(inside) {
            return low;
        }
        let (beyond, border) = nearest(&self.outline, p);
        if !self.open && beyond > 0.0 {
            return f64::INFINITY;
        }
        low.max(self.tip(p, (beyond, border), hints) + RISE * self.grid.step)
    }

    /// Where a level's value changes its sign between two nodes, on the side where it is not positive.
    pub(super) fn root(&self, (inside, outside): (Point2, Point2), z: f64) -> Point2 {
        const STEPS: u32 = 24;
        const SETTLED: f64 = 1e-6;
        let mut hints = Hints::default();
        let at = |t: f64| inside + (outside - inside) * t;
        let (mut a, mut b) = (0.0, 1.0);
        let mut fa = self.value(inside, z, &mut hints);
        let mut fb = self.value(outside, z, &mut hints);
        for k in 0..STEPS {
            if (b - a) * self.grid.step <= SETTLED || fa >= -1e-9 {
                break;
            }
            // False position, every third step a half: it cannot stall.
            let t = if k % 3 == 2 { 0.5 * (a + b) } else { a + (b - a) * fa / (fa - fb) };
            let t = t.clamp(a + 0.02 * (b - a), b - 0.02 * (b - a));
            let f = self.value(at(t), z, &mut hints);
            if f <= 0.0 {
                (a, fa) = (t, f);
            } else {
                (b, fb) = (t, f);
            }
        }
        at(a)
    }
}

/// Points around a blank.
fn rim(blank: &Blank) -> Vec<Point2> {
    const POINTS: u32 = 64;
    let (low, high) = blank.bounds();
    let at = |k: u32| {
        let t = f64::from(k) / f64::from(POINTS);
        match blank {
            Blank::Block { .. } => {
                let corners = [low, Point2::new(high.x, low.y), high, Point2::new(low.x, high.y)];
                let (edge, rest) = ((4.0 * t).floor(), (4.0 * t).fract());
                let from = corners[edge as usize % 4];
                from + (corners[(edge as usize + 1) % 4] - from) * rest
            }
            Blank::Disc { radius } => {
                let (s, c) = crate::math::sin_cos(crate::math::TAU * t);
                Point2::new(radius * c, radius * s)
            }
        }
    };
    (0..POINTS).map(at).collect()
}

/// The plan of the net's four edges, in order around it.
fn outline(tree: &SurfaceTree) -> Vec<Point2> {
    let net = tree.net();
    let [rows, columns] = net.size().map(count);
    let corners = [[0.0, 0.0], [rows, 0.0], [rows, columns], [0.0, columns]];
    let mut points = Vec::new();
    for (k, from) in corners.iter().enumerate() {
        let to = corners[(k + 1) % 4];
        for i in 0..EDGE {
            let t = f64::from(i) / f64::from(EDGE);
            let at = [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * t);
            points.push(net.jet(at[0], at[1]).p.xy());
        }
    }
    points
}

/// Distance from a closed outline, mm: negative inside.
fn distance(outline: &[Point2], p: Point2) -> f64 {
    nearest(outline, p).0
}

/// The same with the nearest point of the outline.
fn nearest(outline: &[Point2], p: Point2) -> (f64, Point2) {
    let mut least = (f64::INFINITY, p);
    let mut inside = false;
    for (i, a) in outline.iter().enumerate() {
        let b = outline[(i + 1) % outline.len()];
        let q = nearest_on_way(*a, b, p);
        let off = (p - q).norm();
        if off < least.0 {
            least = (off, q);
        }
        if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y) {
            inside = !inside;
        }
    }
    if inside { (-least.0, least.1) } else { least }
}

/// Distance of a point from a straight way, mm.
pub(super) fn to_segment(a: Point2, b: Point2, p: Point2) -> f64 {
    (p - nearest_on_way(a, b, p)).norm()
}
