//! The moves of an operation by place, and what they leave at a point of the surface.

use rayon::prelude::*;

use super::Swept;
use super::buckets::Buckets;
use super::capsule::{Capsule, Corner};
use super::moves::Worst;
use crate::cl::{Finish, Operation};
use crate::geom::surface::{Foot, SurfaceTree};
use crate::geom::{Point2, Point3, nearest_on_way};

/// Tiles of a patch in each direction, checked in parallel.
pub(super) const TILES: u32 = 16;
/// All tiles of all patches: patch, and number of the tile.
pub(super) fn tiles(tree: &SurfaceTree) -> Vec<(usize, u32)> {
    let patches = 0..tree.net().patches().len();
    patches.flat_map(|patch| (0..TILES * TILES).map(move |tile| (patch, tile))).collect()
}

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
    pub around: f64,
    buckets: Buckets,
}

impl<'a> Field<'a> {
    pub(super) fn new(
        operation: &Operation,
        finish: &'a Finish,
        passes: &'a [Swept],
        (allowed, bulge): (f64, f64),
    ) -> Field<'a> {
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
            buckets: Buckets::new(passes, finish.radius / 6.0, 2000.0),
        };
        field.look_around(allowed, bulge);
        if field.cusps {
            let (tree, ball) = (field.tree, field.ball);
            field.capsules.par_iter_mut().for_each(|c| c.measure(tree, ball));
        }
        field
    }

    /// Cells with a bound of at most this are settled where so much is known to be left elsewhere.
    pub(super) fn settles(&self, known: f64) -> f64 {
        known.max((known + SLACK * self.floor).min(self.allowed))
    }

    /// Looks so far around a place that what is not seen leaves more than is allowed.
    pub(super) fn look_around(&mut self, allowed: f64, bulge: f64) {
        self.around = self.beside(allowed, bulge);
    }

    /// How far beside a point a move may pass that leaves so much there, mm.
    fn beside(&self, most: f64, bulge: f64) -> f64 {
        (2.0 * self.radius * INTEREST * most * bulge).sqrt().min(self.radius)
    }

    /// How far a tile reaches about a point of it, and a little more than passes are apart, mm.
    pub(super) fn reach(&self, at: Point3, patch: usize, tile: u32) -> f64 {
        let whole = &self.tree.net().patches()[patch];
        let place = |k: u32| f64::from(k) / f64::from(TILES);
        let (u, v) = (tile / TILES, tile % TILES);
        let corners = [(u, v), (u + 1, v), (u, v + 1), (u + 1, v + 1)];
        let far = corners.map(|(u, v)| (whole.jet(place(u), place(v)).p - at).norm());
        far.into_iter().fold(0.0, f64::max) + 2.0 * self.around
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
            self.gather_about((self.centre(&corner).xy(), 0.0), self.around, &mut near);
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

    /// The least that any move near a place of a patch leaves there, and that move, certain up to `most` mm; `near` is
    /// scratch.
    pub(super) fn lowest(
        &self,
        patch: usize,
        uv: [f64; 2],
        most: f64,
        near: &mut Vec<u32>,
    ) -> Option<(f64, &'a Swept)> {
        let corner = Corner::new(self.tree.net().patches().get(patch)?, uv[0], uv[1])?;
        self.gather_about((self.centre(&corner).xy(), 0.0), self.beside(most, 1.0), near);
        let heights = near.iter().map(|i| (self.height(*i, &corner), *i));
        let (height, by) = heights.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(h, _)| h.is_finite())?;
        Some((height, self.passes.get(by as usize)?))
    }

    pub(super) fn worst(&self, value: f64, by: u32, at: &Corner) -> Worst {
        let swept = self.passes.get(by as usize);
        let (line, block) = (swept.map_or(0, |s| s.line), swept.and_then(|s| s.block));
        Worst { value, line, block, at: at.p }
    }

    /// Moves that come so near to a disc in plan.
    pub(super) fn gather_about(&self, (middle, half): (Point2, f64), far: f64, near: &mut Vec<u32>) {
        self.buckets.gather([0, 1].map(|i| (middle[i] - far, middle[i] + far)), near);
        let close = |swept: &Swept| beside(middle, swept) <= far * far && abreast(middle, swept, half);
        near.retain(|i| self.passes.get(*i as usize).is_some_and(close));
    }

    /// The ball's centre when it touches a point.
    pub(super) fn centre(&self, at: &Corner) -> Point3 {
        at.p + at.n * self.ball
    }

    /// Whether the ball can be set on a point without gouging elsewhere.
    pub(super) fn reaches(&self, patch: usize, at: &Corner) -> bool {
        let centre = self.centre(at);
        let foot = Foot { patch, uv: at.uv, point: at.p, distance: self.ball, certain: 0.0 };
        !self.tree.comes_within(centre, &foot, self.ball - 1e-7)
    }

    /// What a move leaves along the normal at a point, stock to leave taken off.
    pub(super) fn height(&self, i: u32, at: &Corner) -> f64 {
        let height = self.capsules.get(i as usize).map(|c| c.height(at, self.radius));
        height.unwrap_or(f64::INFINITY) - (self.ball - self.radius)
    }
}

/// Square distance of a move from a point in plan.
fn beside(p: Point2, swept: &Swept) -> f64 {
    (p - nearest_on_way(swept.from.xy(), swept.to.xy(), p)).norm_squared()
}

/// Whether a chord of a bent move passes a place of this half width, and not others of the same move. Straight moves do.
fn abreast(p: Point2, swept: &Swept, half: f64) -> bool {
    let way = (swept.to - swept.from).xy();
    let length = way.norm();
    let past = |q: Point3| (p - q.xy()).dot(&way) / length.max(1e-300);
    swept.off <= 0.0 || past(swept.from) > -half - length && past(swept.to) < half + length
}
