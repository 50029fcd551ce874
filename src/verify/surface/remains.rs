//! What a swept cutter that is no ball leaves on the surface.
//!
//! The surface is cut into cells. Where the four corners of a cell, raised by T along their normals, lie in the cutter
//! swept along one move, less a hull of ε (a convex body), the cell raised by T lies in the cutter itself, ε being its
//! sagitta. Cells are cut in two until that tells little more than what is known to be left.

use rayon::prelude::*;

use super::Swept;
use super::buckets::Buckets;
use super::cover::Cover;
use super::field::{TILES, tiles};
use super::moves::Worst;
use crate::cl::Finish;
use crate::geom::surface::{Cutter, Patch};
use crate::geom::{Point3, Vec3};

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
    let tiles = tiles(&finish.tree);
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
    buckets: Buckets,
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
        let reach = finish.cutter.radius() + finish.leave;
        let buckets = Buckets::new(passes, finish.cutter.radius() / 3.0, 1000.0);
        Field { finish, passes, reach, buckets }
    }

    /// The moves that come nearest to a place, with their distance from it.
    fn nearest(&self, at: Point3) -> Vec<(f64, u32)> {
        let mut near = Vec::new();
        self.buckets.gather([0, 1].map(|i| (at[i] - self.reach, at[i] + self.reach)), &mut near);
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
