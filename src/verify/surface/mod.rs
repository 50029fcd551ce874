//! Finished surfaces: the moves of the text, swept with the ball, against the exact surface.
//!
//! [`moves`] proves that no move goes deeper into the surface than `INTOL`, and that passes leave it by no more than
//! `OUTTOL`; [`clearing`] that rapids of a roughing are clear of what is left of the blank; [`cover`] that the swept ball leaves nowhere more than the height of cusps and `OUTTOL` together.

mod buckets;
mod capsule;
mod cell;
mod clearing;
#[cfg(test)]
mod clearing_tests;
mod cover;
mod field;
mod moves;
mod near;
mod reached;
mod remaining;
mod remains;
#[cfg(test)]
mod tests;
mod tile;

pub use remaining::{Left, Remaining, Sweep};

use super::certificate::{ClearingProof, Deviation, SurfaceProof};
use super::finding::{Finding, Text};
use super::{Case, Placed};
use crate::cl::Finish;
use crate::diag::codes::verification as codes;

/// What was measured of all moves of one operation.
#[derive(Debug)]
pub(super) struct Proof {
    pub operation: usize,
    pub proof: Found,
}

/// It depends on what the operation is for.
#[derive(Debug)]
pub(super) enum Found {
    Finished(Box<SurfaceProof>),
    /// With the deepest way into what is to be left.
    Cleared(Deviation, ClearingProof),
}

/// Any move of the ball's centre, as straight ways.
#[derive(Debug)]
struct Moved {
    ways: Vec<(crate::geom::Point3, crate::geom::Point3)>,
    line: u32,
    block: Option<usize>,
    rapid: bool,
}

/// A straight move of the ball's centre along the surface, or a chord of one that is bent.
#[derive(Debug, Clone, Copy)]
struct Swept {
    from: crate::geom::Point3,
    to: crate::geom::Point3,
    /// No point of it is farther from the move, mm.
    off: f64,
    line: u32,
    block: Option<usize>,
}

/// Proves all operations that finish a surface.
pub(super) fn all(case: &Case<'_>) -> (Vec<Finding>, Vec<Proof>) {
    let mut findings = Vec::new();
    let mut proofs = Vec::new();
    for (index, operation) in case.cl.operations.iter().enumerate() {
        let Some(finish) = &operation.guard.surface else { continue };
        let own: Vec<Placed<'_>> =
            case.moves.iter().filter(|p| case.context(p.block).operation == Some(index)).copied().collect();
        let swept = moves::check(case, operation, finish, &own, &mut findings);
        let proof = match &operation.guard.clearing {
            Some(clearing) => {
                let into = deviation(&swept.into);
                let proof = clearing::check(operation, (finish, clearing), &swept.moves, &mut findings);
                let left = (finish.leave - into.value).max(0.0);
                Found::Cleared(into, ClearingProof { left, ..proof })
            }
            None => {
                let cover = if finish.cutter.is_ball() {
                    cover::check((index, operation), finish, &swept.passes, &mut findings)
                } else {
                    remains::check((index, operation), finish, &swept.passes, &mut findings)
                };
                Found::Finished(Box::new(proof(finish, &swept, &cover)))
            }
        };
        if finish.tree.is_exhausted() {
            let line = own.first().map_or(0, |placed| placed.line);
            let text = Text::default().words(format!(
                "distances from the surface of {} take more work than can be done",
                operation.name
            ));
            findings.push(Finding::new(&codes::CANNOT_PROVE, line, None, text));
        }
        proofs.push(Proof { operation: index, proof });
    }
    (findings, proofs)
}

fn deviation(e: &moves::Worst) -> Deviation {
    Deviation { value: e.value.max(0.0), line: e.line, x: e.at.x, y: e.at.y, z: e.at.z }
}

fn proof(finish: &Finish, swept: &moves::Measured, cover: &cover::Cover) -> SurfaceProof {
    let at = deviation;
    SurfaceProof {
        radius: finish.radius,
        leave: finish.leave,
        cusp_asked: finish.cusp,
        passes: swept.runs,
        blocks: swept.blocks,
        length: swept.length,
        into: at(&swept.into),
        out: at(&swept.out),
        cusp: cover.cusp.map(|w| at(&w)),
        left: at(&cover.left),
        left_bound: cover.bound,
        unreachable: cover.unreachable.map(|w| at(&w)),
        area: reached::whole(finish),
        unreachable_area: cover.areas.map(|a| a.unreachable),
        beside_area: cover.areas.map(|a| a.beside),
    }
}
