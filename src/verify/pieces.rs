//! Contour pieces: which moves stand for them, and whether these follow the exact curve in the band.

use rayon::prelude::*;

use super::certificate::{Deviation, PieceProof};
use super::finding::{Finding, Text};
use super::follow::{self, Break, Extreme, Followed, Run, Slack};
use super::guard::Rails;
use super::{ACCURACY, Case, Placed};
use crate::diag::codes::verification as codes;
use crate::target::{NurbsForm, Piece};

/// What was measured of a piece.
#[derive(Debug, Clone)]
pub(super) struct Proof {
    pub operation: usize,
    pub proof: PieceProof,
}

/// Moves of every piece, in order.
fn runs<'t>(case: &Case<'t>) -> Vec<Vec<Placed<'t>>> {
    let mut runs: Vec<Vec<Placed<'t>>> = vec![Vec::new(); case.target.pieces.len()];
    for placed in case.moves {
        let piece = placed.block.and_then(|b| case.target.blocks.get(b)).and_then(|b| b.piece);
        if let Some(run) = piece.and_then(|p| runs.get_mut(p.0 as usize)) {
            run.push(*placed);
        }
    }
    runs
}

/// Measures all pieces.
pub(super) fn all(case: &Case<'_>, rails: &Rails<'_>) -> (Vec<Finding>, Vec<Proof>) {
    let runs = runs(case);
    let measured: Vec<(Vec<Finding>, Option<Proof>)> = case
        .target
        .pieces
        .par_iter()
        .zip(runs.par_iter())
        .map(|(piece, run)| one(case, rails, piece, run))
        .collect();
    let mut findings = Vec::new();
    let mut proofs = Vec::new();
    for (found, proof) in measured {
        findings.extend(found);
        proofs.extend(proof);
    }
    (findings, proofs)
}

fn one(
    case: &Case<'_>,
    rails: &Rails<'_>,
    piece: &Piece,
    run: &[Placed<'_>],
) -> (Vec<Finding>, Option<Proof>) {
    let Some(first) = run.first() else {
        let text =
            Text::default().words(format!("nothing is cut along the contour of {}", name(case, piece)));
        return (vec![Finding::new(&codes::NOT_FOLLOWED, 0, block_of(case, piece), text)], None);
    };
    let Some(rail) = rails.of(&piece.curve).filter(|r| !r.degenerate) else {
        let text = Text::default()
            .words("the exact curve runs backwards or stands still: nothing can be measured against it");
        return (vec![Finding::new(&codes::NOT_FOLLOWED, first.line, first.block, text)], None);
    };
    let moves: Run<'_> = run.iter().map(|p| (p.line, p.cut)).collect();
    let step = case.target.capabilities.grid.linear_step();
    let band = piece.band;
    let slack = Slack { along: 2.0 * step + ACCURACY, gross: 20.0 * band.into.max(band.out).max(step) };
    let followed = follow::follow(rail, &moves, slack);
    let mut findings = heights(case, piece, run);
    findings.extend(followed.breaks.iter().map(|b| broken(*b, case, piece, run)));
    let proof = proof(case, piece, run, rail.length, &followed);
    if let Some(proof) = &proof {
        let allowed = run.iter().map(|p| p.cut.path_tolerance).fold(0.0, f64::max);
        findings.extend(band_findings(case, piece, run, proof, allowed));
    }
    (findings, proof.map(|proof| Proof { operation: piece.operation as usize, proof }))
}

fn name(case: &Case<'_>, piece: &Piece) -> String {
    case.cl
        .operations
        .get(piece.operation as usize)
        .map_or_else(|| "an operation".to_owned(), |o| o.name.clone())
}

/// First block of a piece.
fn block_of(case: &Case<'_>, piece: &Piece) -> Option<usize> {
    let id = case.target.pieces.iter().position(|p| core::ptr::eq(p, piece))?;
    case.target.blocks.iter().position(|b| b.piece.is_some_and(|p| p.0 as usize == id))
}

/// Every move of a piece is at its height, and at feed.
fn heights(case: &Case<'_>, piece: &Piece, run: &[Placed<'_>]) -> Vec<Finding> {
    let most = 0.5 * case.target.capabilities.grid.linear_step() + ACCURACY;
    let off = |p: &&Placed<'_>| {
        let (a, b) = p.cut.z;
        p.cut.rapid || !((a - piece.z).abs() <= most && (b - piece.z).abs() <= most)
    };
    run.iter()
        .filter(off)
        .map(|p| {
            let text = if p.cut.rapid {
                Text::default().words("a rapid along a contour")
            } else {
                let (a, b) = p.cut.z;
                Text::default()
                    .words("the contour is cut at Z ")
                    .length(a)
                    .words(" to ")
                    .length(b)
                    .words(" in place of ")
                    .length(piece.z)
            };
            Finding::new(&codes::NOT_FOLLOWED, p.line, p.block, text)
        })
        .collect()
}

fn broken(found: Break, case: &Case<'_>, piece: &Piece, run: &[Placed<'_>]) -> Finding {
    let text = Text::default();
    let (line, text) = match found {
        Break::Start(line, off) => {
            (line, text.words("the path starts ").length(off).words(" along the contour from its start"))
        }
        Break::End(line, short) if short > 0.0 => {
            (line, text.words("the path stops ").length(short).words(" short of the contour's end"))
        }
        Break::End(line, short) => {
            (line, text.words("the path runs ").length(-short).words(" past the contour's end"))
        }
        Break::Back(line, by) => (line, text.words("the path runs back along the contour by ").length(by)),
        Break::Skip(line, step, path) => (
            line,
            text.words("a path of ")
                .length(path)
                .words(" leaves out part of the contour, which is ")
                .length(step)
                .words(" long there"),
        ),
        Break::Jump(line, gap) => {
            (line, text.words("the move starts ").length(gap).words(" from where the contour was left"))
        }
        Break::Nothing => {
            (0, text.words(format!("nothing is cut along the contour of {}", name(case, piece))))
        }
    };
    let block = run.iter().find(|p| p.line == line).or(run.first()).and_then(|p| p.block);
    Finding::new(&codes::NOT_FOLLOWED, line, block, text)
}

fn proof(
    case: &Case<'_>,
    piece: &Piece,
    run: &[Placed<'_>],
    length: f64,
    followed: &Followed,
) -> Option<PieceProof> {
    let (left, right) = (followed.left?, followed.right?);
    let side = piece.part.sign();
    let (inner, outer) = if side > 0.0 { (left, right) } else { (right, left) };
    let deviation = |e: Extreme, sign: f64| Deviation::new(sign * e.d, e.line, e.at, piece.z);
    Some(PieceProof {
        interpolation: piece.interpolation,
        z: piece.z,
        blocks: blocks(case, run),
        lower_bound: piece.lower_bound,
        length,
        into: deviation(inner, side),
        out: deviation(outer, -side),
    })
}

/// NC blocks: moves, and for NURBS their control points after the first, where they are not pieces.
fn blocks(case: &Case<'_>, run: &[Placed<'_>]) -> u32 {
    let pieces = matches!(case.target.capabilities.nurbs, Some(NurbsForm::Pieces { .. }));
    // A control that goes by an arc's angle adds a line to the arc of the same block.
    let first_of_line = |i: &usize| *i == 0 || run.get(i - 1).map(|p| p.line) != run.get(*i).map(|p| p.line);
    (0..run.len())
        .filter(first_of_line)
        .filter_map(|i| run.get(i))
        .map(|p| match &p.cut.path {
            crate::readback::TracePath::Nurbs { points, .. } if !pieces => {
                u32::try_from(points.len()).unwrap_or(u32::MAX).saturating_sub(1)
            }
            _ => 1,
        })
        .fold(0, u32::saturating_add)
}

fn band_findings(
    case: &Case<'_>,
    piece: &Piece,
    run: &[Placed<'_>],
    proof: &PieceProof,
    allowed: f64,
) -> Vec<Finding> {
    let sides = [
        (proof.into, piece.band.into, "into the part", "INTOL"),
        (proof.out, piece.band.out, "out of the part", "OUTTOL"),
    ];
    sides
        .into_iter()
        .filter(|(found, band, ..)| !(found.value + allowed <= band + ACCURACY))
        .map(|(found, band, way, word)| {
            let text = Text::default()
                .words("the path deviates ")
                .length(found.value)
                .words(format!(" {way} at "))
                .point(found.x, found.y)
                .words(format!("; {word} of {} is ", name(case, piece)))
                .length(band);
            let block = run.iter().find(|p| p.line == found.line).and_then(|p| p.block);
            let finding = Finding::new(&codes::OUT_OF_TOLERANCE, found.line, block, text);
            if allowed > 0.0 { finding.note(smoothing(allowed)) } else { finding }
        })
        .collect()
}

fn smoothing(allowed: f64) -> Text {
    if allowed.is_finite() {
        Text::default().words("the control's own smoothing may add ").length(allowed)
    } else {
        Text::default().words("the control may cut corners without a bound: no path tolerance is in force")
    }
}
