//! Stock that is cleared in levels: rapids clear of what is left of it, and how much of the path cuts air.
//!
//! The text's moves are swept through a field of heights. Rapids are told to be clear by heights that nothing of the
//! stock exceeds; volumes and air are estimates at the middles of its cells.

use super::Moved;
use crate::cl::{Clearing, Finish, Operation};
use crate::diag::codes::verification as codes;
use crate::geom::Point3;
use crate::geom::surface::Cutter;
use crate::geom::surface::heights::HeightField;
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
    let mut places: Vec<(f64, f64)> = Vec::new();
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
            places.push((0.5 * (from.z + to.z) - cutter.lift(), length));
        }
    }
    proof.bound = proof.volume / section;
    for level in &mut proof.levels {
        let own = places.iter().filter(|(z, _)| (z - level.z).abs() < 0.01 * clearing.step);
        level.length = own.map(|(_, length)| length).sum();
    }
    proof
}

fn empty(clearing: &Clearing) -> ClearingProof {
    let level = |(z, area): &(f64, f64)| ClearedLevel { z: *z, area: *area, length: 0.0 };
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
