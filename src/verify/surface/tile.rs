//! Cells of a part of a patch, cut until what is left on each is told.

use super::capsule::{Capsule, Corner};
use super::field::{Field, TILES};
use super::moves::Worst;
use crate::geom::surface::{Foot, Patch, SurfaceTree};

/// Deviations of the path between the places where they are known differ by so much of what is allowed from those of a
/// straight line.
const ABOUT: f64 = 0.03;
/// Cells of one tile at most.
const MOST_CELLS: u32 = 400_000;
/// Cells are not cut below this size, mm.
const SMALLEST: f64 = 2e-3;

pub(super) struct Tile<'a> {
    field: &'a Field<'a>,
    pub left: Worst,
    pub bound: f64,
    pub cusp: Worst,
    pub unreachable: Worst,
    cells: u32,
    near: Vec<u32>,
    /// What each of the moves near a cell leaves at its corners, mm.
    heights: Vec<[f64; 4]>,
    patch: usize,
}

/// Parameter rectangle with its corners, (u₀,v₀) (u₀,v₁) (u₁,v₀) (u₁,v₁); `None` where the surface has no normal.
#[derive(Clone, Copy)]
struct Cell {
    u: (f64, f64),
    v: (f64, f64),
    corners: [Option<Corner>; 4],
    /// A move that left little on a larger cell, if any.
    best: Option<u32>,
}

impl Field<'_> {
    pub(super) fn tile(&self, patch: usize, tile: u32) -> Tile<'_> {
        let part = |k: u32| (f64::from(k) / f64::from(TILES), f64::from(k + 1) / f64::from(TILES));
        let whole = &self.tree.net().patches()[patch];
        let first = Cell::new(whole, part(tile / TILES), part(tile % TILES));
        let mut found = Tile {
            field: self,
            left: Worst::NONE,
            bound: 0.0,
            cusp: Worst::NONE,
            unreachable: Worst::NONE,
            cells: 0,
            near: Vec::new(),
            heights: Vec::new(),
            patch,
        };
        let bend = Bend::new(self.tree, patch, first.u, first.v);
        let mut stack = vec![first];
        while let Some(cell) = stack.pop() {
            if let Some((axis, best)) = found.cell(&bend, &cell) {
                stack.extend(Cell { best, ..cell }.halves(whole, axis));
            }
        }
        found
    }
}

/// Bounds of the derivatives over a tile, mm per unit, and per square, of its patch's parameters.
pub(super) struct Bend {
    uu: f64,
    uv: f64,
    vv: f64,
    u: f64,
    v: f64,
}

impl Bend {
    pub(super) fn new(tree: &SurfaceTree, patch: usize, u: (f64, f64), v: (f64, f64)) -> Bend {
        let [u, v, uu, uv, vv] = tree.derivatives(patch, u, v);
        Bend { uu, uv, vv, u, v }
    }
    /// How far the cell may lie from the hull of its corners, mm.
    pub(super) fn sagitta(&self, du: f64, dv: f64) -> f64 {
        (self.uu * du * du + 2.0 * self.uv * du * dv + self.vv * dv * dv) / 8.0
    }
    /// Largest lengths of a cell, mm.
    pub(super) fn size(&self, du: f64, dv: f64) -> [f64; 2] {
        [self.u * du, self.v * dv]
    }
}

impl Cell {
    fn new(patch: &Patch, u: (f64, f64), v: (f64, f64)) -> Cell {
        let corners = [(u.0, v.0), (u.0, v.1), (u.1, v.0), (u.1, v.1)].map(|(u, v)| Corner::new(patch, u, v));
        Cell { u, v, corners, best: None }
    }
    fn halves(&self, patch: &Patch, axis: usize) -> [Cell; 2] {
        let middle = |t: (f64, f64)| 0.5 * (t.0 + t.1);
        let [a, b, c, d] = self.corners;
        if axis == 0 {
            let m = middle(self.u);
            let (e, f) = (Corner::new(patch, m, self.v.0), Corner::new(patch, m, self.v.1));
            let near = Cell { u: (self.u.0, m), corners: [a, b, e, f], ..*self };
            [near, Cell { u: (m, self.u.1), corners: [e, f, c, d], ..*self }]
        } else {
            let m = middle(self.v);
            let (e, f) = (Corner::new(patch, self.u.0, m), Corner::new(patch, self.u.1, m));
            let near = Cell { v: (self.v.0, m), corners: [a, e, c, f], ..*self };
            [near, Cell { v: (m, self.v.1), corners: [e, b, f, d], ..*self }]
        }
    }
}

impl Tile<'_> {
    /// Looks at a cell; if it must be halved, the axis, and the move that leaves least on it.
    fn cell(&mut self, bend: &Bend, cell: &Cell) -> Option<(usize, Option<u32>)> {
        self.cells += 1;
        let (du, dv) = (cell.u.1 - cell.u.0, cell.v.1 - cell.v.0);
        let size = bend.size(du, dv);
        let axis = usize::from(size[1] > size[0]);
        if size[0].max(size[1]) > 0.25 * self.field.radius {
            return Some((axis, None));
        }
        let [Some(a), Some(b), Some(c), Some(d)] = cell.corners else {
            // No normal: a collapsed corner is met by its neighbours.
            return (size[axis] > SMALLEST).then_some((axis, None));
        };
        let corners = [a, b, c, d];
        let sagitta = bend.sagitta(du, dv);
        if cell.best.is_some_and(|best| self.is_settled(&corners, sagitta, best)) {
            return None;
        }
        let mut near = core::mem::take(&mut self.near);
        self.field.gather(&corners, &mut near);
        let best = self.judge(&corners, sagitta, size[axis], &near);
        self.near = near;
        best.map(|best| (axis, best))
    }

    /// Whether one move is known to leave no more on a cell than what is of no interest.
    fn is_settled(&mut self, corners: &[Corner; 4], sagitta: f64, best: u32) -> bool {
        let field = self.field;
        let known = self.left.value.max(field.floor);
        let most = if field.cusps { known.min(self.cusp.value) } else { known };
        let highest = corners.iter().map(|c| field.height(best, c)).fold(f64::NEG_INFINITY, f64::max);
        let bound = highest + 2.0 * sagitta;
        let settled = highest <= most && bound <= field.settles(known);
        if settled {
            self.bound = self.bound.max(bound);
        }
        settled
    }

    /// `Some` where the cell must be halved, with the move that leaves least on the whole of it.
    #[allow(clippy::option_option)]
    fn judge(&mut self, corners: &[Corner; 4], sagitta: f64, size: f64, near: &[u32]) -> Option<Option<u32>> {
        let field = self.field;
        let mut bound = f64::INFINITY;
        let mut best = None;
        let mut least = [f64::INFINITY; 4];
        let mut by = [0u32; 4];
        self.heights.clear();
        for &i in near {
            let heights = corners.map(|corner| field.height(i, &corner));
            for k in 0..4 {
                if heights[k] < least[k] {
                    (least[k], by[k]) = (heights[k], i);
                }
            }
            self.heights.push(heights);
            let most = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
            if most < bound {
                (bound, best) = (most, Some(i));
            }
        }
        // Raising a point by dT along its normal moves it into the capsule by more than half of that.
        let bound = bound + 2.0 * sagitta;
        for k in 0..4 {
            self.note((&corners[k], k), least[k], by[k], near);
        }
        let known = self.left.value.max(field.floor);
        let settled = bound <= field.settles(known);
        if settled || size < SMALLEST || self.cells >= MOST_CELLS {
            if settled || bound > known && self.reaches(&corners[0]) {
                self.bound = self.bound.max(bound.min(field.ceiling));
            }
            return None;
        }
        // Where the ball cannot reach there is nothing to refine.
        let open =
            bound < f64::INFINITY && least.iter().any(|h| *h < field.ceiling) && self.worth(corners, size);
        open.then_some(best)
    }

    /// Whether some corner of a larger cell can be reached; small ones are looked at in any case until they settle.
    fn worth(&self, corners: &[Corner; 4], size: f64) -> bool {
        size > 0.3 || corners.iter().any(|c| self.reaches(c))
    }

    fn reaches(&self, at: &Corner) -> bool {
        self.field.reaches(self.patch, at)
    }

    /// Takes what is left at corner `k` of a cell into account.
    fn note(&mut self, (at, k): (&Corner, usize), height: f64, by: u32, near: &[u32]) {
        let field = self.field;
        let value = height.min(field.ceiling);
        let cusp = field.cusps && value > self.cusp.value && self.may_be_cusp((at, k), near);
        if value <= self.left.value.max(field.floor) && !cusp {
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

    /// Whether more than the highest cusp known would be left at corner `k` of a cell if the path had no deviation of its
    /// own; yes in doubt, but for rare places.
    fn may_be_cusp(&self, (at, k): (&Corner, usize), near: &[u32]) -> bool {
        let enough = self.cusp.value - ABOUT * self.field.out;
        near.iter().zip(&self.heights).all(|(i, heights)| {
            let height = heights[k];
            // The path is no farther off than it may be.
            height - self.field.out > enough
                || self.field.capsules.get(*i as usize).is_none_or(|c| {
                    let off = c.off_at(at.p + at.n * height);
                    height - off > enough
                })
        })
    }

    /// What would be left at a point if the path had no deviation of its own.
    fn cusp_at(&self, at: &Corner, near: &[u32]) -> f64 {
        let mut found: Vec<(f64, u32)> = near
            .iter()
            .map(|i| (self.field.height(*i, at), *i))
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
            Foot { patch: self.patch, uv: at.uv, point: at.p, distance: self.field.ball, certain: 0.0 };
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
