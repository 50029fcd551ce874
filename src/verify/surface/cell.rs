//! Rectangles of a patch's parameters, and where they are halved.

use super::capsule::Corner;
use super::near::Near;
use crate::geom::surface::{Patch, SurfaceTree};

/// Parameter rectangle with its corners, (u₀,v₀) (u₀,v₁) (u₁,v₀) (u₁,v₁); `None` where the surface has no normal.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    pub u: (f64, f64),
    pub v: (f64, f64),
    pub corners: [Option<Corner>; 4],
    /// A move that left little on a larger cell, if any.
    pub best: Option<u32>,
    /// Moves near a larger cell, if they are known.
    pub near: Option<Near>,
    /// How often larger cells have been looked at for ridges.
    pub looks: usize,
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
    pub(super) fn new(patch: &Patch, u: (f64, f64), v: (f64, f64)) -> Cell {
        let corners = [(u.0, v.0), (u.0, v.1), (u.1, v.0), (u.1, v.1)].map(|(u, v)| Corner::new(patch, u, v));
        Cell { u, v, corners, best: None, near: None, looks: 0 }
    }

    pub(super) fn halves(&self, patch: &Patch, axis: usize) -> [Cell; 2] {
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

/// Where a cell is to be halved: across the direction in which what one move leaves at its corners, if that is known,
/// changes most.
pub(super) fn axis(heights: Option<[f64; 4]>, (size, sagitta): ([f64; 2], f64), smallest: f64) -> usize {
    /// Cells that are so much longer than wide are halved in any case.
    const LONG: f64 = 64.0;
    let longest = usize::from(size[1] > size[0]);
    let Some(h) = heights else { return longest };
    if size[longest] > LONG * size[1 - longest] || size[1 - longest] < smallest {
        return longest;
    }
    let along_u = (h[0] - h[2]).abs().max((h[1] - h[3]).abs());
    let along_v = (h[0] - h[1]).abs().max((h[2] - h[3]).abs());
    if !(along_u.is_finite() && along_v.is_finite()) || sagitta > along_u.max(along_v) {
        return longest;
    }
    usize::from(along_v > along_u)
}
