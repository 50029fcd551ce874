//! Stock that is cleared in levels: rapids clear of what is left of it, how much of the path cuts air, and that every level is
//! cleared.
//!
//! The text's moves are swept through a field of heights. Rapids are told to be clear by heights that nothing of the
//! stock exceeds; volumes and air are estimates at the middles of its cells. Of every level no more may stand untouched than the
//! plan has told.

use super::Moved;
use crate::cl::{Clearing, Finish, Level, Operation};
use crate::diag::codes::verification as codes;
use crate::geom::surface::heights::HeightField;
use crate::geom::surface::{Cutter, Standing};
use crate::geom::{Point2, Point3};
use crate::verify::ACCURACY;
use crate::verify::certificate::{ClearedLevel, ClearingProof};
use crate::verify::finding::{Finding, Text};

/// Size of the field's cells as a share of the radius.
const CELLS: f64 = 0.05;
/// A way of this length, mm, that takes less than this share of a full cut's volume cuts air.
const AIR: (f64, f64) = (0.5, 1e-3);

/// Sweeps all moves in order; findings are appended.
pub(super) fn check(
    operation: &Operation,
    (finish, clearing): (&Finish, &Clearing),
    moves: &[Moved],
    findings: &mut Vec<Finding>,
) -> ClearingProof {
    let cutter = &finish.cutter;
    let section = cutter.section(clearing.step);
    let mut stock = HeightField::new(&clearing.blank, clearing.top, CELLS * cutter.radius());
    let mut proof = empty(clearing);
    for moved in moves {
        for (from, to) in &moved.ways {
            if moved.rapid {
                // What stands around the cutter stands below it: straight up it is clear.
                if from.xy() == to.xy() && to.z >= from.z {
                    continue;
                }
                let depth = stock.depth(*from, *to, cutter);
                if depth > ACCURACY {
                    findings.push(through_stock((operation, cutter), moved, (*from, *to), depth));
                }
                continue;
            }
            let length = (to - from).norm();
            let parts = crate::math::ceil_to_usize(length / AIR.0).max(1);
            let at = |k: usize| from + (to - from) * (crate::math::count(k) / crate::math::count(parts));
            let share = length / crate::math::count(parts);
            for k in 0..parts {
                let volume = stock.cut(at(k), at(k + 1), cutter);
                proof.volume += volume;
                if volume <= AIR.1 * section * share {
                    proof.air += share;
                }
            }
            proof.cut += length;
        }
    }
    proof.bound = proof.volume / section;
    levels((operation, finish, clearing), moves, &mut proof.levels, findings);
    proof
}

/// Path of every level, and what stands there.
fn levels(
    (operation, finish, clearing): (&Operation, &Finish, &Clearing),
    moves: &[Moved],
    levels: &mut [ClearedLevel],
    findings: &mut Vec<Finding>,
) {
    let cutter = finish.cutter;
    let kept = (cutter, finish.leave + clearing.margin);
    let mut standing = Standing::new(&finish.tree, kept, clearing.blank, ISLANDS * cutter.radius());
    let reach = cutter.half_width(clearing.step) + ACCURACY;
    for (level, told) in levels.iter_mut().zip(&clearing.levels) {
        let near = |p: &Point3| (p.z - cutter.lift() - level.z).abs() < 0.01 * clearing.step;
        let of = |moved: &&Moved| !moved.rapid;
        let feeds = moves.iter().filter(of).flat_map(|m| &m.ways);
        let own: Vec<(Point2, Point2)> =
            feeds.filter(|(a, b)| near(a) && near(b)).map(|(a, b)| (a.xy(), b.xy())).collect();
        level.length = own.iter().map(|(a, b)| (b - a).norm()).sum();
        let islands = standing.after(level.z, &own, reach);
        level.standing = islands.iter().fold(0.0, |sum, island| sum + island.area);
        let allowed = ROUNDED.0 * told.standing + ROUNDED.1 * cutter.radius() * cutter.radius();
        if let Some(island) = islands.first().filter(|_| level.standing > allowed) {
            let text = Text::default()
                .words(format!(
                    "{:.3} mm² of stock stand untouched at a level of {}, around ",
                    level.standing, operation.name
                ))
                .place(Point3::new(island.place.x, island.place.y, level.z));
            findings.push(Finding::new(&codes::SURFACE_LEFT, 0, None, text));
        }
    }
}

/// What stands may be more than was told by this share, and by this share of the cutter's radius squared: the control rounds.
const ROUNDED: (f64, f64) = (1.02, 0.01);
/// Cells in which islands are looked for, as a share of the radius.
const ISLANDS: f64 = 0.09;

fn empty(clearing: &Clearing) -> ClearingProof {
    let level = |l: &Level| ClearedLevel { z: l.z, area: l.area, length: 0.0, standing: 0.0 };
    ClearingProof {
        levels: clearing.levels.iter().map(level).collect(),
        cut: 0.0,
        air: 0.0,
        volume: 0.0,
        bound: 0.0,
        left: 0.0,
    }
}

fn through_stock(
    (operation, cutter): (&Operation, &Cutter),
    moved: &Moved,
    (from, to): (Point3, Point3),
    depth: f64,
) -> Finding {
    let what = if cutter.is_ball() { "ball's centre" } else { "cutter's tip" };
    let [from, to] = [from, to].map(|p| if cutter.is_ball() { p } else { cutter.tip(p) });
    let text = Text::default()
        .words("a rapid goes ")
        .length(depth)
        .words(format!(" into what may be left of the blank, with the {what} between "))
        .place(from)
        .words(" and ")
        .place(to)
        .words(format!(", in {}", operation.name));
    Finding::new(&codes::RAPID_IN_STOCK, moved.line, moved.block, text)
}
