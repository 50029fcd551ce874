//! Parts of a patch, cut into cells until what is left on each is told.
//!
//! Ridges between passes are looked for first, on cells that are not settled yet: the highest of them all tells which cells
//! are of no interest.

use super::capsule::{Capsule, Corner};
use super::cell::{Bend, Cell, axis};
use super::field::{Field, TILES};
use super::moves::Worst;
use super::near::{Lists, Near};
use crate::geom::surface::{Foot, Patch};

/// Deviations of the path between the places where they are known differ by so much of what is allowed from those of a
/// straight line.
const ABOUT: f64 = 0.03;
/// Cells of one tile at most.
const MOST_CELLS: u32 = 400_000;
/// Cells are not cut below this size, mm.
const SMALLEST: f64 = 2e-3;
/// Ridges are looked for on cells of no more than this, as shares of the ball's radius.
const RIDGED: [f64; 2] = [0.12, 0.03];
/// Steps to a ridge between two corners.
const STEPS: u32 = 6;

pub(super) struct Tile<'a> {
    field: &'a Field<'a>,
    pub left: Worst,
    pub bound: Worst,
    pub cusp: Worst,
    pub unreachable: Worst,
    /// What is known to be left, and to stand as a cusp, elsewhere, mm.
    elsewhere: (f64, f64),
    cells: u32,
    patch: &'a Patch,
    place: usize,
    bend: Bend,
    lists: Lists,
    /// Cells that wait for what other tiles tell.
    waiting: Vec<Cell>,
}

/// What becomes of a cell.
enum Verdict {
    Settled,
    Waits,
    Halved { axis: usize, best: Option<u32>, near: Option<Near>, looks: usize },
}

/// What the moves near a cell leave at its corners.
struct Least {
    heights: [f64; 4],
    by: [u32; 4],
    /// The move that leaves least on all of them, and what it leaves there.
    best: Option<(u32, [f64; 4])>,
    /// The most of that.
    most: f64,
}

impl Field<'_> {
    /// What is left on a tile, but for cells that wait.
    pub(super) fn tile(&self, patch: usize, tile: u32) -> Tile<'_> {
        let part = |k: u32| (f64::from(k) / f64::from(TILES), f64::from(k + 1) / f64::from(TILES));
        let whole = &self.tree.net().patches()[patch];
        let first = Cell::new(whole, part(tile / TILES), part(tile % TILES));
        let mut found = Tile {
            field: self,
            left: Worst::NONE,
            bound: Worst::NONE,
            cusp: Worst::NONE,
            unreachable: Worst::NONE,
            elsewhere: (self.floor, 0.0),
            cells: 0,
            patch: whole,
            place: patch,
            bend: Bend::new(self.tree, patch, first.u, first.v),
            lists: Lists::new(),
            waiting: vec![first],
        };
        found.work(self.cusps);
        found
    }
}

impl Tile<'_> {
    /// Goes on with the cells that wait, now that so much is known to be left, and to stand as a cusp, elsewhere.
    pub(super) fn finish(&mut self, (left, cusp): (f64, f64)) {
        self.elsewhere = (left.max(self.field.floor), cusp);
        self.work(false);
    }

    /// Works on the cells that wait; some may wait again.
    fn work(&mut self, may_wait: bool) {
        let mut stack = core::mem::take(&mut self.waiting);
        while let Some(cell) = stack.pop() {
            match self.cell(&cell, may_wait) {
                Verdict::Settled => {}
                Verdict::Waits => self.waiting.push(Cell { near: None, looks: 1, ..cell }),
                Verdict::Halved { axis, best, near, looks } => {
                    stack.extend(Cell { best, near, looks, ..cell }.halves(self.patch, axis));
                }
            }
        }
    }

    /// What is known to be left somewhere, mm.
    fn known(&self) -> f64 {
        self.left.value.max(self.elsewhere.0)
    }

    /// The highest cusp known, mm.
    fn ridge(&self) -> f64 {
        self.cusp.value.max(self.elsewhere.1)
    }

    fn cell(&mut self, cell: &Cell, may_wait: bool) -> Verdict {
        self.cells += 1;
        let (du, dv) = (cell.u.1 - cell.u.0, cell.v.1 - cell.v.0);
        let size = self.bend.size(du, dv);
        let longest = usize::from(size[1] > size[0]);
        let halved = |axis, near| Verdict::Halved { axis, best: None, near, looks: cell.looks };
        if size[longest] > 0.25 * self.field.radius {
            return halved(longest, None);
        }
        let [Some(a), Some(b), Some(c), Some(d)] = cell.corners else {
            // No normal: a collapsed corner is met by its neighbours.
            return if size[longest] > SMALLEST { halved(longest, None) } else { Verdict::Settled };
        };
        let corners = [a, b, c, d];
        let sagitta = self.bend.sagitta(du, dv);
        if cell.best.is_some_and(|best| self.settles(&corners, sagitta, best).is_ok()) {
            return Verdict::Settled;
        }
        let near = self.field.near(&corners, cell.near, &mut self.lists);
        let Some(least) = self.judge(&corners, sagitta, near) else { return Verdict::Settled };
        let across = least.by.iter().any(|i| *i != least.by[0]);
        let looks = self.field.cusps
            && across
            && RIDGED.get(cell.looks).is_some_and(|share| size[longest] < share * self.field.radius);
        if looks && least.most > self.known().min(self.ridge()) {
            self.ridges(cell, &corners, &least, near);
        }
        if !self.is_open(&corners, (least.most + 2.0 * sagitta, size[longest]), &least) {
            return Verdict::Settled;
        }
        if looks && may_wait && cell.looks == 0 {
            return Verdict::Waits;
        }
        let (best, heights) = least.best.unzip();
        Verdict::Halved {
            axis: axis(heights, (size, sagitta), SMALLEST),
            best,
            near: Some(near),
            looks: cell.looks + usize::from(looks),
        }
    }

    /// What a move leaves at the corners of a cell: `Ok` where it is known to leave no more on the whole cell than what is of
    /// no interest.
    fn settles(&mut self, corners: &[Corner; 4], sagitta: f64, i: u32) -> Result<(), [f64; 4]> {
        let field = self.field;
        let known = self.known();
        let heights = corners.map(|corner| field.height(i, &corner));
        let most = highest(&heights);
        // Raising a point by dT along its normal moves it into the capsule by more than half of that.
        let bound = most + 2.0 * sagitta;
        let low = most <= known && bound <= field.settles(known);
        if !low || field.cusps && (0..4).any(|k| self.may_be_cusp(&corners[k], heights[k], i)) {
            return Err(heights);
        }
        self.bound.take(field.worst(bound, i, &corners[0]));
        Ok(())
    }

    /// What the moves near a cell leave at its corners; `None` where one of them settles it.
    fn judge(&mut self, corners: &[Corner; 4], sagitta: f64, near: Near) -> Option<Least> {
        let mut least = Least { heights: [f64::INFINITY; 4], by: [0; 4], best: None, most: f64::INFINITY };
        for k in near.first..near.end {
            let i = self.lists[k].1;
            let Err(heights) = self.settles(corners, sagitta, i) else { return None };
            for (k, height) in heights.into_iter().enumerate() {
                if height < least.heights[k] {
                    (least.heights[k], least.by[k]) = (height, i);
                }
            }
            let most = highest(&heights);
            if most < least.most {
                (least.most, least.best) = (most, Some((i, heights)));
            }
        }
        for (k, corner) in corners.iter().enumerate() {
            self.note(corner, (least.heights[k], least.by[k]), near);
        }
        Some(least)
    }

    /// Whether a cell with this bound and size must be halved; the bound of others is taken into account.
    fn is_open(&mut self, corners: &[Corner; 4], (bound, size): (f64, f64), least: &Least) -> bool {
        let field = self.field;
        let known = self.known();
        let settled = bound <= field.settles(known);
        if settled || size < SMALLEST || self.cells >= MOST_CELLS {
            if settled || bound > known && self.reaches(&corners[0]) {
                let by = least.best.map_or(u32::MAX, |best| best.0);
                self.bound.take(field.worst(bound.min(field.ceiling), by, &corners[0]));
            }
            return false;
        }
        // Where the ball cannot reach there is nothing to refine.
        bound < f64::INFINITY && least.heights.iter().any(|h| *h < field.ceiling) && self.worth(corners, size)
    }

    /// Whether some corner of a larger cell can be reached; small ones are looked at in any case until they settle.
    fn worth(&self, corners: &[Corner; 4], size: f64) -> bool {
        size > 0.3 || corners.iter().any(|c| self.reaches(c))
    }

    fn reaches(&self, at: &Corner) -> bool {
        self.field.reaches(self.place, at)
    }

    /// Looks at the ridges that cross the edges of a cell.
    fn ridges(&mut self, cell: &Cell, corners: &[Corner; 4], least: &Least, near: Near) {
        const EDGES: [(usize, usize); 4] = [(0, 1), (2, 3), (0, 2), (1, 3)];
        let at = |k: usize| [[cell.u.0, cell.u.1][k / 2], [cell.v.0, cell.v.1][k % 2]];
        for (a, b) in EDGES.into_iter().filter(|(a, b)| least.by[*a] != least.by[*b]) {
            let between = |t: f64| {
                let (p, q) = (at(a), at(b));
                Corner::new(self.patch, p[0] + (q[0] - p[0]) * t, p[1] + (q[1] - p[1]) * t)
            };
            let higher = |c: &Corner| self.field.height(least.by[a], c) - self.field.height(least.by[b], c);
            // Regula falsi (Illinois): one move leaves less at one end, the other at the other.
            let (mut low, mut high) = ((0.0, higher(&corners[a])), (1.0, higher(&corners[b])));
            let mut found = None;
            for _ in 0..STEPS {
                let share = low.1 / (low.1 - high.1);
                let t =
                    if share.is_finite() { low.0 + (high.0 - low.0) * share } else { 0.5 * (low.0 + high.0) };
                let Some(corner) = between(t) else { break };
                let d = higher(&corner);
                found = Some(corner);
                if d > 0.0 {
                    (high, low.1) = ((t, d), 0.5 * low.1);
                } else {
                    (low, high.1) = ((t, d), 0.5 * high.1);
                }
            }
            if let Some(corner) = found {
                let heights = self.lists[near.first..near.end]
                    .iter()
                    .map(|(_, i)| (self.field.height(*i, &corner), *i));
                let lowest = heights.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, u32::MAX));
                self.note(&corner, lowest, near);
            }
        }
    }

    /// Takes what is left at a place, and by which move, into account.
    fn note(&mut self, at: &Corner, (height, by): (f64, u32), near: Near) {
        let field = self.field;
        let value = height.min(field.ceiling);
        let cusp = field.cusps
            && value > self.ridge()
            && self.lists[near.first..near.end]
                .iter()
                .all(|(_, i)| self.may_be_cusp(at, field.height(*i, at), *i));
        if value <= self.known() && !cusp {
            return;
        }
        let worst = |value: f64| field.worst(value, by, at);
        if !self.reaches(at) {
            self.unreachable.take(worst(value));
            return;
        }
        if value > field.floor {
            self.left.take(worst(value));
        }
        if cusp {
            self.cusp.take(worst(self.cusp_at(at, near)));
        }
    }

    /// Whether a move that leaves so much at a place would leave more than the highest cusp known if it had no deviation of
    /// its own; yes in doubt, but for rare places.
    fn may_be_cusp(&self, at: &Corner, height: f64, i: u32) -> bool {
        let enough = self.ridge() - ABOUT * self.field.out;
        // The path is no farther off than it may be.
        height - self.field.out > enough
            || height > enough
                && self
                    .field
                    .capsules
                    .get(i as usize)
                    .is_none_or(|c| height - c.off_at(at.p + at.n * height) > enough)
    }

    /// What would be left at a place if the path had no deviation of its own.
    fn cusp_at(&self, at: &Corner, near: Near) -> f64 {
        let mut found: Vec<(f64, u32)> = self.lists[near.first..near.end]
            .iter()
            .map(|(_, i)| (self.field.height(*i, at), *i))
            .filter(|(height, _)| height.is_finite())
            .collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut best = f64::INFINITY;
        for (height, i) in found {
            if height - self.field.out >= best {
                break;
            }
            let deviation =
                self.field.capsules.get(i as usize).map_or(0.0, |c| self.deviation(c, at, height));
            best = best.min(height - deviation);
        }
        if best.is_finite() { best } else { 0.0 }
    }

    /// How far the path itself is off the surface where it cuts nearest to a point, mm.
    fn deviation(&self, swept: &Capsule, at: &Corner, height: f64) -> f64 {
        let q = at.p + at.n * height;
        let along = swept.along;
        let centre = swept.from + along * (q - swept.from).dot(&along).clamp(0.0, swept.length);
        let foot =
            Foot { patch: self.place, uv: at.uv, point: at.p, distance: self.field.ball, certain: 0.0 };
        // Where the move is not parallel to the surface, it cuts beside the foot: at right angles to the move.
        let foot = self.field.tree.nearby(centre, &foot);
        let offset = foot.point - centre;
        let (tilt, level) =
            (offset.dot(&along), along - offset * (offset.dot(&along) / offset.norm_squared()));
        let beside = foot.point - level * (tilt / level.dot(&along).max(0.1));
        let beside = self.field.tree.nearby(beside, &foot).point - centre;
        let across = (beside - along * beside.dot(&along)).norm();
        (across - self.field.ball).max(0.0)
    }
}

fn highest(heights: &[f64; 4]) -> f64 {
    heights.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}
