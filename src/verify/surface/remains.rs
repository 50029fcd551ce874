//! What a swept cutter that is no ball leaves on the surface.
//!
//! The surface is cut into cells. Where the four corners of a cell, raised by T along their normals, lie in the cutter
//! swept along one move, less a hull of ε (a convex body), the cell raised by T lies in the cutter itself, ε being its
//! sagitta. Cells are cut in two until that tells little more than what is known to be left.

use rayon::prelude::*;

use super::Swept;
use super::cover::Cover;
use super::moves::Worst;
use crate::cl::Finish;
use crate::geom::surface::{Cutter, Patch};
use crate::geom::{Point3, Vec3};

/// Tiles of a patch in each direction.
const TILES: u32 = 16;
/// Heights below this need not be told apart, mm.
const FLOOR: f64 = 0.02;
/// A bound this much above what is known to be left is close enough.
const CLOSE: f64 = 1.1;
/// Cells are not cut below this size, mm.
const SMALLEST: f64 = 0.01;
/// Cells of a tile at most.
const MOST_CELLS: u32 = 4_000;
/// Moves whose height is looked at for one cell.
const CANDIDATES: usize = 6;

/// The largest height left, and a bound of it.
pub(super) fn check(finish: &Finish, passes: &[Swept]) -> Cover {
    let field = Field::new(finish, passes);
    let tiles: Vec<(usize, u32)> = (0..finish.tree.net().patches().len())
        .flat_map(|patch| (0..TILES * TILES).map(move |tile| (patch, tile)))
        .collect();
    let found: Vec<(Worst, f64)> = tiles.par_iter().map(|(patch, tile)| field.tile(*patch, *tile)).collect();
    let mut cover = Cover { left: Worst::NONE, bound: 0.0, cusp: None, unreachable: None };
    for (left, bound) in found {
        cover.left.take(left);
        cover.bound = cover.bound.max(bound);
    }
    cover.bound = cover.bound.max(cover.left.value);
    cover
}

/// The moves by place in plan.
struct Field<'a> {
    finish: &'a Finish,
    passes: &'a [Swept],
    reach: f64,
    low: [f64; 2],
    cell: f64,
    counts: [usize; 2],
    buckets: Vec<Vec<u32>>,
}

#[derive(Clone, Copy)]
struct Cell {
    u: (f64, f64),
    v: (f64, f64),
}

#[derive(Clone, Copy)]
struct Corner {
    p: Point3,
    n: Vec3,
}

impl<'a> Field<'a> {
    fn new(finish: &'a Finish, passes: &'a [Swept]) -> Field<'a> {
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for p in passes.iter().flat_map(|s| [s.from, s.to]) {
            for i in 0..2 {
                low[i] = low[i].min(p[i]);
                high[i] = high[i].max(p[i]);
            }
        }
        let extent = (high[0] - low[0]).max(high[1] - low[1]).max(1e-3);
        let cell = (finish.cutter.radius() / 3.0).max(extent / 1000.0);
        // Floats saturate.
        let count =
            |i: usize| if passes.is_empty() { 1 } else { ((high[i] - low[i]) / cell).floor() as usize + 1 };
        let counts = [count(0), count(1)];
        let reach = finish.cutter.radius() + finish.leave;
        let buckets = vec![Vec::new(); counts[0] * counts[1]];
        let mut field = Field { finish, passes, reach, low, cell, counts, buckets };
        for (i, swept) in passes.iter().enumerate() {
            let range = |k: usize| (swept.from[k].min(swept.to[k]), swept.from[k].max(swept.to[k]));
            let (x, y) = (field.index(0, range(0)), field.index(1, range(1)));
            for a in x.0..=x.1 {
                for b in y.0..=y.1 {
                    field.buckets[a * counts[1] + b].push(u32::try_from(i).unwrap_or(u32::MAX));
                }
            }
        }
        field
    }

    fn index(&self, axis: usize, range: (f64, f64)) -> (usize, usize) {
        let most = self.counts[axis] - 1;
        let of = |x: f64| (((x - self.low[axis]) / self.cell).floor().max(0.0) as usize).min(most);
        (of(range.0), of(range.1))
    }

    /// The moves that come nearest to a place, with their distance from it.
    fn nearest(&self, at: Point3) -> Vec<(f64, u32)> {
        let around = |i: usize| (at[i] - self.reach, at[i] + self.reach);
        let (x, y) = (self.index(0, around(0)), self.index(1, around(1)));
        let mut near = Vec::new();
        for a in x.0..=x.1 {
            for b in y.0..=y.1 {
                near.extend(&self.buckets[a * self.counts[1] + b]);
            }
        }
        near.sort_unstable();
        near.dedup();
        let apart = |i: &u32| {
            let swept = self.passes.get(*i as usize)?;
            Some((self.finish.cutter.outside((swept.from, swept.to), at).0, *i))
        };
        let mut found: Vec<(f64, u32)> = near.iter().filter_map(apart).collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        found.truncate(CANDIDATES);
        found
    }

    /// Largest height found on a tile, and the bound of all of it.
    fn tile(&self, patch: usize, tile: u32) -> (Worst, f64) {
        let part = |k: u32| (f64::from(k) / f64::from(TILES), f64::from(k + 1) / f64::from(TILES));
        let first = Cell { u: part(tile / TILES), v: part(tile % TILES) };
        let whole = &self.finish.tree.net().patches()[patch];
        let bends = bends(&whole.restrict(first.u, first.v), f64::from(TILES));
        let (mut left, mut bound, mut cells) = (Worst::NONE, 0.0f64, 0);
        let mut stack = vec![first];
        while let Some(cell) = stack.pop() {
            cells += 1;
            let (du, dv) = (cell.u.1 - cell.u.0, cell.v.1 - cell.v.0);
            let [u, v, uu, uv, vv] = bends;
            let size = [u * du, v * dv];
            let axis = usize::from(size[1] > size[0]);
            let sagitta = (uu * du * du + 2.0 * uv * du * dv + vv * dv * dv) / 8.0;
            let (most, lowest) = self.judge(whole, &cell, sagitta);
            left.take(lowest);
            let settled = most <= CLOSE * left.value.max(FLOOR);
            if settled || size[axis] < SMALLEST || cells >= MOST_CELLS {
                bound = bound.max(most);
                continue;
            }
            stack.extend(cell.halves(axis));
        }
        (left, bound)
    }

    /// Bound of what is left on a cell, and the most found at its corners.
    fn judge(&self, patch: &Patch, cell: &Cell, sagitta: f64) -> (f64, Worst) {
        let mut left = Worst::NONE;
        let corners =
            [(cell.u.0, cell.v.0), (cell.u.0, cell.v.1), (cell.u.1, cell.v.0), (cell.u.1, cell.v.1)].map(
                |(u, v)| {
                    let jet = patch.jet(u, v);
                    jet.normal().map(|n| Corner { p: jet.p, n })
                },
            );
        let [Some(a), Some(b), Some(c), Some(d)] = corners else { return (f64::INFINITY, left) };
        let corners = [a, b, c, d];
        let middle = Point3::from((a.p.coords + b.p.coords + c.p.coords + d.p.coords) / 4.0);
        let normal = (a.n + b.n + c.n + d.n) / 4.0;
        let near = self.nearest(middle + normal * self.finish.leave);
        let within = self.finish.cutter.shrunk(sagitta);
        let mut least = [(f64::INFINITY, 0u32); 4];
        let mut bound = f64::INFINITY;
        for (_, i) in near {
            let Some(swept) = self.passes.get(i as usize) else { continue };
            for (k, corner) in corners.iter().enumerate() {
                let height = self.height((&self.finish.cutter, 0.0), swept, corner);
                if height < least[k].0 {
                    least[k] = (height, i);
                }
            }
            if let Some((within, up)) = &within {
                let most = corners.iter().map(|c| self.height((within, *up), swept, c)).fold(0.0, f64::max);
                bound = bound.min(most);
            }
        }
        for (corner, (height, by)) in corners.iter().zip(least) {
            let swept = self.passes.get(by as usize);
            let (line, block) = (swept.map_or(0, |s| s.line), swept.and_then(|s| s.block));
            // What no move near by reaches is told by its bound.
            if height.is_finite() {
                left.take(Worst { value: height, line, block, at: corner.p });
            }
        }
        (bound, left)
    }

    /// Height along the normal at which a point, raised, enters a cutter on its move; above what is to be left.
    fn height(&self, (cutter, up): (&Cutter, f64), swept: &Swept, at: &Corner) -> f64 {
        const STEPS: u32 = 60;
        const TOUCHES: f64 = 1e-8;
        let start = self.finish.leave;
        let mut t = start;
        let way = (swept.from + Vec3::z() * up, swept.to + Vec3::z() * up);
        for _ in 0..STEPS {
            let (d, n) = cutter.outside(way, at.p + at.n * t);
            if d <= TOUCHES {
                return t - start + TOUCHES;
            }
            let rate = n.dot(&at.n);
            // The distance is convex along the normal: its tangent never leads into the cutter.
            if rate > -1e-6 || t > start + 2.0 * self.reach {
                return f64::INFINITY;
            }
            t -= d / rate;
        }
        f64::INFINITY
    }
}

impl Cell {
    fn halves(&self, axis: usize) -> [Cell; 2] {
        let middle = |t: (f64, f64)| 0.5 * (t.0 + t.1);
        if axis == 0 {
            let m = middle(self.u);
            [Cell { u: (self.u.0, m), ..*self }, Cell { u: (m, self.u.1), ..*self }]
        } else {
            let m = middle(self.v);
            [Cell { v: (self.v.0, m), ..*self }, Cell { v: (m, self.v.1), ..*self }]
        }
    }
}

/// Bounds of |r_u|, |r_v|, |r_uu|, |r_uv|, |r_vv| of a piece, per the whole patch's parameters.
fn bends(piece: &Patch, scale: f64) -> [f64; 5] {
    let [u, v] = [piece.hodograph(0), piece.hodograph(1)];
    let most =
        |p: &Patch| p.homogeneous().iter().map(|h| Vec3::new(h.x, h.y, h.z).norm()).fold(0.0, f64::max);
    // A rational patch bends with its weights as well: a generous factor that refinement makes harmless.
    let rational = if piece.is_rational() { 4.0 } else { 1.0 };
    let (one, two) = (scale * rational, scale * scale * rational);
    [
        most(&u) * one,
        most(&v) * one,
        most(&u.hodograph(0)) * two,
        most(&u.hodograph(1)) * two,
        most(&v.hodograph(1)) * two,
    ]
}
