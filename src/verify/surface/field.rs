//! The moves of an operation by place, and what they leave at a point of the surface.

use rayon::prelude::*;

use super::Swept;
use super::capsule::{Capsule, Corner};
use super::moves::Worst;
use crate::cl::{Finish, Operation};
use crate::geom::surface::{Foot, SurfaceTree};

/// Tiles of a patch in each direction, checked in parallel.
pub(super) const TILES: u32 = 16;
/// Moves that leave more than this times what is allowed are not looked for: what is then reported is more than allowed,
/// too.
const INTEREST: f64 = 1.5;
/// Bounds may be above what is known to be left by this share of the heights of no interest.
const SLACK: f64 = 0.0125;

/// The moves by place.
pub(super) struct Field<'a> {
    pub tree: &'a SurfaceTree,
    /// Radius of the ball, and of the ball with what it leaves, mm.
    pub radius: f64,
    pub ball: f64,
    /// Heights of no interest.
    pub floor: f64,
    /// Heights looked at at most.
    pub ceiling: f64,
    /// What may be left, mm.
    allowed: f64,
    /// How far the path may be off the surface.
    pub out: f64,
    /// Whether the height of cusps is of interest.
    pub cusps: bool,
    pub passes: &'a [Swept],
    pub capsules: Vec<Capsule>,
    /// Moves whose centres pass farther beside a point leave more there than is of interest, mm.
    around: f64,
    low: [f64; 2],
    cell: f64,
    counts: [usize; 2],
    buckets: Vec<Vec<u32>>,
}

impl<'a> Field<'a> {
    pub(super) fn new(
        operation: &Operation,
        finish: &'a Finish,
        passes: &'a [Swept],
        (allowed, bulge): (f64, f64),
    ) -> Field<'a> {
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for swept in passes {
            for p in [swept.from, swept.to] {
                for i in 0..2 {
                    low[i] = low[i].min(p[i]);
                    high[i] = high[i].max(p[i]);
                }
            }
        }
        let extent = (high[0] - low[0]).max(high[1] - low[1]).max(1e-3);
        let cell = (finish.radius / 6.0).max(extent / 2000.0);
        let empty = passes.is_empty();
        let counts = [0, 1].map(|i| if empty { 1 } else { ((high[i] - low[i]) / cell).floor() as usize + 1 });
        let mut field = Field {
            tree: &finish.tree,
            radius: finish.radius,
            ball: finish.radius + finish.leave,
            floor: 0.5 * allowed,
            allowed,
            ceiling: 4.0 * allowed + finish.radius * 0.5,
            out: operation.band.out,
            cusps: finish.cusp.is_some(),
            passes,
            capsules: passes.iter().map(Capsule::new).collect(),
            around: 0.0,
            low,
            cell,
            counts,
            buckets: vec![Vec::new(); counts[0] * counts[1]],
        };
        field.look_around(allowed, bulge);
        if field.cusps {
            let (tree, ball) = (field.tree, field.ball);
            field.capsules.par_iter_mut().for_each(|c| c.measure(tree, ball));
        }
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

    /// Cells with a bound of at most this are settled where so much is known to be left elsewhere.
    pub(super) fn settles(&self, known: f64) -> f64 {
        known.max((known + SLACK * self.floor).min(self.allowed))
    }

    /// Looks so far around a place that what is not seen leaves more than is allowed.
    pub(super) fn look_around(&mut self, allowed: f64, bulge: f64) {
        self.around = (2.0 * self.radius * INTEREST * allowed * bulge).sqrt().min(self.radius);
    }

    /// The most that is left at a few places of a tile.
    pub(super) fn sampled(&self, patch: usize, tile: u32) -> Worst {
        const PLACES: [[f64; 2]; 4] = [[0.13, 0.41], [0.62, 0.19], [0.37, 0.83], [0.88, 0.66]];
        let (whole, mut near) = (&self.tree.net().patches()[patch], Vec::new());
        let mut most = Worst::NONE;
        for [u, v] in PLACES {
            let place = |k: u32, t: f64| (f64::from(k) + t) / f64::from(TILES);
            let Some(corner) = Corner::new(whole, place(tile / TILES, u), place(tile % TILES, v)) else {
                continue;
            };
            self.gather(&[corner; 4], &mut near);
            let least =
                near.iter().map(|i| (self.height(*i, &corner), *i)).min_by(|a, b| a.0.total_cmp(&b.0));
            let (height, by) = least.unwrap_or((f64::INFINITY, u32::MAX));
            let value = height.min(self.ceiling);
            if value > most.value && self.reaches(patch, &corner) {
                most = self.worst(value, by, &corner);
            }
        }
        most
    }

    /// The least that any move near a place of a patch leaves there, and that move; `near` is scratch.
    pub(super) fn lowest(&self, patch: usize, uv: [f64; 2], near: &mut Vec<u32>) -> Option<(f64, &'a Swept)> {
        let corner = Corner::new(self.tree.net().patches().get(patch)?, uv[0], uv[1])?;
        self.gather(&[corner], near);
        let heights = near.iter().map(|i| (self.height(*i, &corner), *i));
        let (height, by) = heights.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(h, _)| h.is_finite())?;
        Some((height, self.passes.get(by as usize)?))
    }

    pub(super) fn worst(&self, value: f64, by: u32, at: &Corner) -> Worst {
        let swept = self.passes.get(by as usize);
        let (line, block) = (swept.map_or(0, |s| s.line), swept.and_then(|s| s.block));
        Worst { value, line, block, at: at.p }
    }

    /// Bucket numbers of a range of a coordinate.
    fn index(&self, axis: usize, range: (f64, f64)) -> (usize, usize) {
        let most = self.counts[axis] - 1;
        // Floats saturate: what lies outside counts to the border.
        let of = |x: f64| (((x - self.low[axis]) / self.cell).floor().max(0.0) as usize).min(most);
        (of(range.0), of(range.1))
    }

    /// Moves that may reach the corners of a cell.
    pub(super) fn gather(&self, corners: &[Corner], near: &mut Vec<u32>) {
        near.clear();
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for c in corners {
            let centre = c.p + c.n * self.ball;
            for i in 0..2 {
                low[i] = low[i].min(centre[i]);
                high[i] = high[i].max(centre[i]);
            }
        }
        let around = self.around;
        let (x, y) = (
            self.index(0, (low[0] - around, high[0] + around)),
            self.index(1, (low[1] - around, high[1] + around)),
        );
        for a in x.0..=x.1 {
            for b in y.0..=y.1 {
                near.extend(&self.buckets[a * self.counts[1] + b]);
            }
        }
        near.sort_unstable();
        near.dedup();
    }

    /// Whether the ball can be set on a point without gouging elsewhere.
    pub(super) fn reaches(&self, patch: usize, at: &Corner) -> bool {
        let centre = at.p + at.n * self.ball;
        let foot = Foot { patch, uv: at.uv, point: at.p, distance: self.ball, certain: 0.0 };
        !self.tree.comes_within(centre, &foot, self.ball - 1e-7)
    }

    /// What a move leaves along the normal at a point, stock to leave taken off.
    pub(super) fn height(&self, i: u32, at: &Corner) -> f64 {
        let height = self.capsules.get(i as usize).map(|c| c.height(at, self.radius));
        height.unwrap_or(f64::INFINITY) - (self.ball - self.radius)
    }
}
