//! What a swept cutter that is no ball leaves on the surface.
//!
//! The surface is cut into cells. Where the four corners of a cell, raised by T along their normals, lie in the cutter
//! swept along one move, less a hull of ε (a convex body), the cell raised by T lies in the cutter itself, ε being its
//! sagitta. Cells are cut in two until that tells that no more is left than may be, or, where nobody said how much that is,
//! little more than what is known to be left.
//!
//! A cutter that is too wide for a place leaves something there, however close its passes lie: what stays where it is set
//! on the place and lifted until it rests. So much more may be left there; it is told apart.

use std::rc::Rc;

use rayon::prelude::*;

use super::Swept;
use super::buckets::Buckets;
use super::capsule::Corner;
use super::cell::{self, Bend};
use super::cover::{Cover, STEEPEST, SURE};
use super::field::{TILES, tiles};
use super::moves::Worst;
use super::reached::{Areas, area, areas};
use crate::cl::{Finish, Operation};
use crate::diag::codes::verification as codes;
use crate::geom::surface::{Cutter, Patch};
use crate::geom::{Point3, Vec2, Vec3};
use crate::verify::finding::{Finding, Text};
use crate::verify::{ACCURACY, Shortfall};

/// Heights below this need not be told apart, mm, where nobody said how much may be left.
const FLOOR: f64 = 0.02;
/// A bound this much above what is known to be left is close enough.
const CLOSE: f64 = 1.1;
/// Cells are not cut below this size, mm.
const SMALLEST: f64 = 0.01;
/// Cells at which the cutter does not reach the surface are not cut below this size, mm.
const TOO_WIDE: f64 = 0.3;
/// Cells of a tile at most: where nobody said how much may be left, and where somebody did.
const MOST_CELLS: [u32; 2] = [4_000, 100_000];
/// Moves whose height is looked at for one cell.
const CANDIDATES: usize = 6;

/// The largest height left, and a bound of it; findings are appended.
pub(super) fn check(
    (index, operation): (usize, &Operation),
    finish: &Finish,
    passes: &[Swept],
    findings: &mut Vec<Finding>,
) -> Cover {
    let allowed = finish.cusp.map(|h| h + operation.band.out + ACCURACY);
    let field = Field::new(finish, passes, allowed);
    let tiles = tiles(&finish.tree);
    let found: Vec<Tile> = tiles.par_iter().map(|(patch, tile)| field.tile(*patch, *tile)).collect();
    let mut all = Tile::default();
    for tile in &found {
        all.left.take(tile.left);
        all.bound.take(tile.bound);
        all.too_wide.take(tile.too_wide);
    }
    let holds = allowed.filter(|a| all.bound.value <= *a);
    let too_wide: Vec<&[(Corner, f64)]> = found.iter().map(|tile| tile.lost.as_slice()).collect();
    let areas: Option<Areas> = holds.map(|allowed| areas(finish, &too_wide, allowed));
    if let Some(allowed) = allowed.filter(|_| holds.is_none()) {
        let short = found.iter().filter_map(|tile| tile.short(index, (finish.cusp?, allowed))).collect();
        findings.push(too_much(operation, &all, allowed - ACCURACY).with_short(short));
    }
    let unreachable = (all.too_wide.value > 0.0).then_some(all.too_wide);
    let bound = all.bound.value.max(all.left.value);
    Cover { left: all.left, bound, cusp: None, unreachable, areas }
}

fn too_much(operation: &Operation, found: &Tile, allowed: f64) -> Finding {
    let w = if found.left.value > allowed { &found.left } else { &found.bound };
    let text = if w.value.is_finite() {
        Text::default().words("up to ").length(w.value).words(" is left on the surface at ")
    } else {
        Text::default().words("no move covers the surface at ")
    };
    let text = text.place(w.at).words(format!("; cusps and OUTTOL of {} allow ", operation.name));
    Finding::new(&codes::SURFACE_LEFT, w.line, w.block, text.length(allowed))
}

/// The moves by place in plan.
pub(super) struct Field<'a> {
    finish: &'a Finish,
    passes: &'a [Swept],
    allowed: Option<f64>,
    reach: f64,
    buckets: Buckets,
}

/// What was found on a tile.
struct Tile {
    /// The most that is known to be left where the cutter reaches.
    left: Worst,
    /// No more is left there.
    bound: Worst,
    /// The most that is known to be left where the cutter is too wide.
    too_wide: Worst,
    /// Middles of cells where so much is left, and their areas, mm².
    lost: Vec<(Corner, f64)>,
    /// Size of the tile, mm.
    size: f64,
}

impl Default for Tile {
    fn default() -> Tile {
        Tile { left: Worst::NONE, bound: Worst::NONE, too_wide: Worst::NONE, lost: Vec::new(), size: 0.0 }
    }
}

impl Tile {
    /// Where more is left than is allowed, and by which share cusps must be lower there.
    fn short(&self, index: usize, (h, allowed): (f64, f64)) -> Option<Shortfall> {
        let worst = if self.left.value > allowed { &self.left } else { &self.bound };
        let over = worst.value - allowed;
        let share = ((h - over) / h * SURE).clamp(STEEPEST, 1.0);
        (over > 0.0).then_some(Shortfall { operation: index, at: worst.at, reach: 2.0 * self.size, share })
    }
}

/// Parameter rectangle.
struct Cell {
    u: (f64, f64),
    v: (f64, f64),
    /// Moves that may come near.
    near: Rc<Vec<u32>>,
    /// The move that leaves least on a larger cell, if any.
    best: Option<u32>,
}

/// What the moves near a cell leave on it.
struct Judged {
    /// Proven bound, mm.
    most: f64,
    best: Option<u32>,
    /// Moves that may come near to a part of it.
    near: Vec<u32>,
}

/// What becomes of a cell.
enum Verdict {
    Settled,
    Halved(usize, Judged),
}

impl<'a> Field<'a> {
    pub(super) fn new(finish: &'a Finish, passes: &'a [Swept], allowed: Option<f64>) -> Field<'a> {
        let reach = finish.cutter.radius() + finish.leave;
        let buckets = Buckets::new(passes, finish.cutter.radius() / 3.0, 1000.0);
        Field { finish, passes, allowed, reach, buckets }
    }

    /// Moves that may reach a place.
    fn gather(&self, at: Point3, around: f64, near: &mut Vec<u32>) {
        let around = around + self.reach;
        self.buckets.gather([0, 1].map(|i| (at[i] - around, at[i] + around)), near);
    }

    /// How far each of these moves is from a place, the nearest first.
    fn sorted(&self, near: &[u32], at: Point3) -> Vec<(f64, u32)> {
        let apart = |i: &u32| {
            let swept = self.passes.get(*i as usize)?;
            Some((self.finish.cutter.outside((swept.from, swept.to), at).0, *i))
        };
        let mut found: Vec<(f64, u32)> = near.iter().filter_map(apart).collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        found
    }

    /// What is left at a place of a patch, and by which move; `near` is scratch. Below zero where the cutter has gone deeper,
    /// down to `deepest` mm.
    pub(super) fn lowest(
        &self,
        patch: usize,
        uv: [f64; 2],
        deepest: f64,
        near: &mut Vec<u32>,
    ) -> Option<(f64, &'a Swept)> {
        let corner = Corner::new(self.finish.tree.net().patches().get(patch)?, uv[0], uv[1])?;
        self.gather(corner.p, 0.0, near);
        let (height, by) = self.least(near, &corner, deepest);
        Some((height, self.passes.get(by? as usize)?))
    }

    /// The least that the nearest of some moves leave at a place, and by which.
    fn least(&self, near: &[u32], at: &Corner, deepest: f64) -> (f64, Option<u32>) {
        let found = self.sorted(near, at.p + at.n * self.finish.leave);
        let heights = found.iter().take(CANDIDATES).filter_map(|(_, i)| {
            let swept = self.passes.get(*i as usize)?;
            let height = self.height((&self.finish.cutter, 0.0), swept, at, self.finish.leave - deepest);
            height.is_finite().then_some((height, Some(*i)))
        });
        heights.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, None))
    }

    fn worst(&self, value: f64, by: Option<u32>, at: &Corner) -> Worst {
        let swept = by.and_then(|i| self.passes.get(i as usize));
        let (line, block) = (swept.map_or(0, |s| s.line), swept.and_then(|s| s.block));
        Worst { value, line, block, at: at.p }
    }

    /// What is left on a tile.
    fn tile(&self, patch: usize, tile: u32) -> Tile {
        let part = |k: u32| (f64::from(k) / f64::from(TILES), f64::from(k + 1) / f64::from(TILES));
        let (u, v) = (part(tile / TILES), part(tile % TILES));
        let whole = &self.finish.tree.net().patches()[patch];
        let bend = Bend::new(&self.finish.tree, patch, u, v);
        let size = bend.size(u.1 - u.0, v.1 - v.0).iter().sum::<f64>();
        let mut near = Vec::new();
        if let Some(middle) = Corner::new(whole, middle(u), middle(v)) {
            self.gather(middle.p, 0.5 * size, &mut near);
        }
        let (mut found, mut cells) = (Tile { size, ..Tile::default() }, 0);
        let mut stack = vec![Cell { u, v, near: Rc::new(near), best: None }];
        while let Some(cell) = stack.pop() {
            cells += 1;
            let last = cells >= MOST_CELLS[usize::from(self.allowed.is_some())];
            if let Verdict::Halved(axis, judged) = self.cell(whole, &bend, &cell, last, &mut found) {
                stack.extend(cell.halves(axis, judged));
            }
        }
        found
    }

    /// Looks at a cell; `last`: it may not be halved.
    fn cell(&self, patch: &Patch, bend: &Bend, cell: &Cell, last: bool, found: &mut Tile) -> Verdict {
        let (du, dv) = (cell.u.1 - cell.u.0, cell.v.1 - cell.v.0);
        let (size, sagitta) = (bend.size(du, dv), bend.sagitta(du, dv));
        let longest = usize::from(size[1] > size[0]);
        let last = last || size[longest] < SMALLEST;
        let unknown = |near: &[u32]| Judged { most: f64::INFINITY, best: None, near: near.to_vec() };
        let corners =
            [(cell.u.0, cell.v.0), (cell.u.0, cell.v.1), (cell.u.1, cell.v.0), (cell.u.1, cell.v.1)]
                .map(|(u, v)| Corner::new(patch, u, v));
        let ([Some(a), Some(b), Some(c), Some(d)], Some(middle)) =
            (corners, Corner::new(patch, middle(cell.u), middle(cell.v)))
        else {
            // No normal: a collapsed corner is met by its neighbours.
            return if last { Verdict::Settled } else { Verdict::Halved(longest, unknown(&cell.near)) };
        };
        let corners = [a, b, c, d];
        let enough = self.allowed.unwrap_or(CLOSE * found.left.value.max(FLOOR));
        let first = cell.best.is_none();
        if let Some(most) = cell.best.map(|best| self.on_all(best, &corners, sagitta, enough))
            && most <= enough
        {
            found.bound.take(self.worst(most, cell.best, &middle));
            return Verdict::Settled;
        }
        let judged = self.judge(cell, (&corners, &middle), (0.5 * (size[0] + size[1]), sagitta), enough);
        if judged.most > enough || first {
            let (height, by) = self.least(&judged.near, &middle, 0.0);
            let of = || area(patch, cell.u, cell.v);
            if self.is_lost(self.worst(height, by, &middle), (&middle, &of), size[longest], found) {
                return Verdict::Settled;
            }
        }
        if judged.most <= enough || last {
            let of = || area(patch, cell.u, cell.v);
            self.settle(self.worst(judged.most, judged.best, &middle), (&middle, &of), found);
            return Verdict::Settled;
        }
        Verdict::Halved(self.axis(&judged, &corners, (size, sagitta)), judged)
    }

    /// Takes what is left at the middle of a cell; whether halving it is of no use, because it is too much anyway or because
    /// the cutter is too wide.
    fn is_lost(
        &self,
        left: Worst,
        (at, area): (&Corner, &dyn Fn() -> f64),
        size: f64,
        found: &mut Tile,
    ) -> bool {
        let Some(allowed) = self.allowed.filter(|a| left.value > *a) else {
            if left.value.is_finite() {
                found.left.take(left);
            }
            return false;
        };
        if left.value <= self.stays(at) + allowed {
            if size < TOO_WIDE {
                found.too_wide.take(left);
                found.lost.push((*at, area()));
            }
            return size < TOO_WIDE;
        }
        found.bound.take(left);
        if left.value.is_finite() {
            found.left.take(left);
        }
        true
    }

    /// Takes the bound of a cell that is not halved.
    fn settle(&self, bound: Worst, (at, area): (&Corner, &dyn Fn() -> f64), found: &mut Tile) {
        match self.allowed.filter(|a| bound.value > *a) {
            Some(allowed) if bound.value <= self.stays(at) + allowed => {
                found.too_wide.take(bound);
                found.lost.push((*at, area()));
            }
            _ => found.bound.take(bound),
        }
    }

    /// What stays at a place however close passes lie: no more than the cutter leaves that is set on it and lifted until it
    /// rests, or that is let down nearer to it.
    fn stays(&self, at: &Corner) -> f64 {
        const SHARES: [f64; 3] = [1.0, 0.5, 0.0];
        let cutter = self.finish.cutter.grown(self.finish.leave);
        let beside = cutter.touches_beside(Vec2::new(at.n.x, at.n.y));
        let left = |share: f64| {
            let rest =
                cutter.drop(&self.finish.tree, at.p.x + share * beside.x, at.p.y + share * beside.y, None)?;
            let stands = Swept { from: rest.centre, to: rest.centre, off: 0.0, line: 0, block: None };
            Some(self.height((&self.finish.cutter, 0.0), &stands, at, self.finish.leave))
        };
        SHARES.into_iter().filter_map(left).fold(f64::INFINITY, f64::min)
    }

    /// Bound of what is left on a cell with this radius and sagitta.
    fn judge(
        &self,
        cell: &Cell,
        (corners, middle): (&[Corner; 4], &Corner),
        (radius, sagitta): (f64, f64),
        enough: f64,
    ) -> Judged {
        let found = self.sorted(&cell.near, middle.p + middle.n * self.finish.leave);
        let farthest = found.get(CANDIDATES - 1).map_or(f64::INFINITY, |f| f.0 + 2.0 * (radius + sagitta));
        let near: Vec<u32> = found.iter().take_while(|f| f.0 <= farthest).map(|f| f.1).collect();
        let (mut most, mut best) = (f64::INFINITY, None);
        for i in near.iter().take(CANDIDATES) {
            let own = self.on_all(*i, corners, sagitta, most);
            if own < most {
                (most, best) = (own, Some(*i));
            }
            if most <= enough {
                break;
            }
        }
        Judged { most, best, near }
    }

    /// The most that a move leaves on a cell, if it is less than `of_interest`.
    fn on_all(&self, i: u32, corners: &[Corner; 4], sagitta: f64, of_interest: f64) -> f64 {
        let Some(swept) = self.passes.get(i as usize) else { return f64::INFINITY };
        // Where a move is bent, the cutter on it holds a smaller one on its chord.
        let Some((within, up)) = self.finish.cutter.shrunk(sagitta + swept.off) else { return f64::INFINITY };
        let mut most = 0.0f64;
        for corner in corners {
            most = most.max(self.height((&within, up), swept, corner, self.finish.leave));
            if most > of_interest {
                return f64::INFINITY;
            }
        }
        most
    }

    /// Where a cell is to be halved: across the direction in which what is left on it changes most.
    fn axis(&self, judged: &Judged, corners: &[Corner; 4], (size, sagitta): ([f64; 2], f64)) -> usize {
        let swept = judged.best.and_then(|i| self.passes.get(i as usize));
        let height =
            |swept: &Swept, c: &Corner| self.height((&self.finish.cutter, 0.0), swept, c, self.finish.leave);
        cell::axis(swept.map(|swept| corners.map(|c| height(swept, &c))), (size, sagitta), SMALLEST)
    }

    /// Height along the normal at which a point, raised, enters a cutter on its move; above what is to be left.
    fn height(&self, (cutter, up): (&Cutter, f64), swept: &Swept, at: &Corner, start: f64) -> f64 {
        let way = (swept.from + Vec3::z() * up, swept.to + Vec3::z() * up);
        cutter.enters(way, (at.p, at.n), (start, 2.0 * self.reach)) - self.finish.leave
    }
}

impl Cell {
    fn halves(&self, axis: usize, judged: Judged) -> [Cell; 2] {
        let (best, near) = (judged.best.or(self.best), Rc::new(judged.near));
        let part = |u, v| Cell { u, v, near: Rc::clone(&near), best };
        if axis == 0 {
            let m = middle(self.u);
            [part((self.u.0, m), self.v), part((m, self.u.1), self.v)]
        } else {
            let m = middle(self.v);
            [part(self.u, (self.v.0, m)), part(self.u, (m, self.v.1))]
        }
    }
}

fn middle(range: (f64, f64)) -> f64 {
    0.5 * (range.0 + range.1)
}
