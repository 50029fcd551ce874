//! What the swept ball leaves on the surface, everywhere.
//!
//! The surface is cut into cells, rectangles of its parameters. What stands on a cell is bounded from its corners: where
//! all four corners, raised by T along their normals, lie in one capsule (the ball swept along one move, a convex body),
//! the whole raised cell does but for its own sagitta ε, so that no more than T + ε/cos stays on it. Cells whose bound
//! is above what is known to be left somewhere are cut in two, across the ridges.

use rayon::prelude::*;

use super::Swept;
use super::field::{Field, tiles};
use super::moves::Worst;
use super::reached::Areas;
use super::tile::Tile;
use crate::cl::{Finish, Operation};
use crate::diag::codes::verification as codes;
use crate::geom::Point3;
use crate::geom::surface::Patch;
use crate::verify::finding::{Finding, Text};
use crate::verify::{ACCURACY, Shortfall};

/// What was found.
#[derive(Debug)]
pub(super) struct Cover {
    /// Most material left where the ball can reach.
    pub left: Worst,
    /// Proven bound of the same, mm.
    pub bound: f64,
    /// Highest ridge above the path's own deviation beside it, where a height of cusps was asked for.
    pub cusp: Option<Worst>,
    /// Most material left where the ball does not reach for its size.
    pub unreachable: Option<Worst>,
    /// Where that is, of cutters that are no balls.
    pub areas: Option<Areas>,
}

/// What may be left where nobody said, mm, until places have been looked at.
const UNKNOWN: f64 = 0.5;
/// Heights of no interest, as a share of the highest of some places, where the height of cusps was asked for, and where
/// it was not.
const OF_INTEREST: f64 = 0.75;
const ENOUGH: f64 = 2.0;

/// Checks the whole surface; findings are appended.
pub(super) fn check(
    (index, operation): (usize, &Operation),
    finish: &Finish,
    passes: &[Swept],
    findings: &mut Vec<Finding>,
) -> Cover {
    // On a convex surface the chords of a path that is off by OUTTOL leave more at their ends, by the radii' ratio.
    let bulge = (1.0 + (finish.radius + finish.leave) * most_convex(finish)).max(1.0);
    let allowed = finish.cusp.map(|h| h + operation.band.out * bulge + ACCURACY);
    let tiles = tiles(&finish.tree);
    let mut field = Field::new(operation, finish, passes, (allowed.unwrap_or(UNKNOWN), bulge));
    let places: Vec<Worst> = tiles.par_iter().map(|(patch, tile)| field.sampled(*patch, *tile)).collect();
    let mut left = Worst::NONE;
    places.into_iter().for_each(|place| left.take(place));
    if left.value > 0.0 {
        field.floor = left.value * if field.cusps { OF_INTEREST } else { ENOUGH };
        field.look_around(allowed.unwrap_or(4.0 * left.value), bulge);
    }
    let mut found: Vec<Tile<'_>> = tiles.par_iter().map(|(patch, tile)| field.tile(*patch, *tile)).collect();
    // What is more than may be left is told for each tile.
    let most = |of: fn(&Tile<'_>) -> f64| found.iter().map(of).fold(0.0, f64::max);
    let known = most(|tile| tile.left.value).min(allowed.unwrap_or(f64::INFINITY));
    let ridge = most(|tile| tile.cusp.value).min(finish.cusp.unwrap_or(0.0));
    found.par_iter_mut().for_each(|tile| tile.finish((known, ridge)));
    let mut cover = Cover { left, bound: 0.0, cusp: None, unreachable: None, areas: None };
    for tile in &found {
        cover.left.take(tile.left);
        cover.bound = cover.bound.max(tile.bound.value);
        if tile.unreachable.value > 0.0 {
            cover.unreachable.get_or_insert(Worst::NONE).take(tile.unreachable);
        }
        if finish.cusp.is_some() {
            cover.cusp.get_or_insert(Worst::NONE).take(tile.cusp);
        }
    }
    cover.bound = cover.bound.max(cover.left.value);
    let short = || -> Vec<Shortfall> {
        let limits = finish.cusp.zip(allowed);
        let of_tile = |(tile, (patch, number)): (&Tile<'_>, &(usize, u32))| {
            let (at, share) = tile.short(limits?)?;
            let reach = field.reach(at, *patch, *number);
            Some(Shortfall { operation: index, at, reach, share })
        };
        found.iter().zip(&tiles).filter_map(of_tile).collect()
    };
    if let Some(allowed) = allowed.filter(|a| !(cover.bound <= *a)) {
        findings.push(too_much(operation, &cover, allowed - ACCURACY).with_short(short()));
    }
    if let Some((cusp, h)) = cover.cusp.zip(finish.cusp).filter(|(c, h)| !(c.value <= h * (1.0 + CUSP_SLACK)))
    {
        findings.push(too_high(operation, &cusp, h).with_short(short()));
    }
    cover
}

/// The largest convex curvature found at many places, 1/mm.
fn most_convex(finish: &Finish) -> f64 {
    const PLACES: u32 = 24;
    let patches = finish.tree.net().patches().iter();
    let at = |patch: &Patch, k: u32| {
        let [u, v] = [k / (PLACES + 1), k % (PLACES + 1)].map(|i| f64::from(i) / f64::from(PLACES));
        patch.jet(u, v).principal().map_or(0.0, |p| -p.min)
    };
    patches.flat_map(|p| (0..(PLACES + 1) * (PLACES + 1)).map(move |k| at(p, k))).fold(0.0, f64::max)
}

impl Tile<'_> {
    /// Where on this tile more is left than the height of cusps and the whole that is allowed, and by which share cusps must
    /// be lower there.
    fn short(&self, (h, allowed): (f64, f64)) -> Option<(Point3, f64)> {
        let cusp = (self.cusp.value > h * (1.0 + CUSP_SLACK)).then(|| (self.cusp.at, h / self.cusp.value));
        let at = if self.left.value > allowed { self.left.at } else { self.bound.at };
        let over = self.bound.value.max(self.left.value) - allowed;
        let left = (over > 0.0).then(|| (at, (h - over) / h));
        let (at, share) = cusp.into_iter().chain(left).min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some((at, (share * SURE).clamp(STEEPEST, 1.0)))
    }
}

/// Cusps are asked to be lower by a little more than what was too much, and by no more than this at once.
pub(super) const SURE: f64 = 0.995;
pub(super) const STEEPEST: f64 = 0.5;

/// Ridges may be higher than asked for by this share: the accuracy to which the path's own deviation beside them is told.
const CUSP_SLACK: f64 = 0.005;

fn too_much(operation: &Operation, cover: &Cover, allowed: f64) -> Finding {
    let w = &cover.left;
    let text = Text::default()
        .words("up to ")
        .length(cover.bound)
        .words(" is left on the surface at ")
        .place(w.at)
        .words(format!("; cusps and OUTTOL of {} allow ", operation.name))
        .length(allowed);
    Finding::new(&codes::SURFACE_LEFT, w.line, w.block, text)
}

fn too_high(operation: &Operation, cusp: &Worst, allowed: f64) -> Finding {
    let text = Text::default()
        .words("a cusp of ")
        .length(cusp.value)
        .words(" is left at ")
        .place(cusp.at)
        .words(format!("; {} allows ", operation.name))
        .length(allowed);
    Finding::new(&codes::SURFACE_LEFT, cusp.line, cusp.block, text)
}
