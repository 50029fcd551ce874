//! Making the certificate.

use sha2::{Digest, Sha256};

use super::Proofs;
use super::certificate::{Certificate, Moves, OperationProof, RAPID_RATE, TIME_MODEL, Time, VERSION};
use super::pieces::Proof;
use super::surface::Found;
use super::{ACCURACY, Case, Emitted};
use crate::readback::{EventKind, Trace, TracePath};

/// The certificate of a text with these proofs.
pub(super) fn certificate(
    case: &Case<'_>,
    trace: &Trace,
    emitted: &Emitted,
    control: &str,
    proofs: Proofs,
) -> Certificate {
    let text = &emitted.text;
    Certificate {
        version: VERSION,
        post: case.target.capabilities.name.clone(),
        control: control.to_owned(),
        digest: digest(text),
        bytes: text.len() as u64,
        lines: u32::try_from(text.lines().count()).unwrap_or(u32::MAX),
        moves: moves(case),
        time: time(case, trace),
        accuracy: ACCURACY,
        operations: operations(case, proofs),
    }
}

fn digest(text: &str) -> String {
    hexadecimal(&Sha256::digest(text.as_bytes()))
}

/// Bytes as hexadecimal digits.
pub(super) fn hexadecimal(bytes: &[u8]) -> String {
    let mut hex = String::with_capacity(2 * bytes.len());
    for byte in bytes {
        for nibble in [byte >> 4, byte & 15] {
            hex.push(char::from_digit(u32::from(nibble), 16).unwrap_or('0'));
        }
    }
    hex
}

fn moves(case: &Case<'_>) -> Moves {
    let mut moves = Moves::default();
    count_moves(case, &mut moves);
    moves
}

/// Adds the moves by kind.
pub(super) fn count_moves(case: &Case<'_>, moves: &mut Moves) {
    for placed in case.moves {
        let counter = match (&placed.cut.path, placed.cut.rapid) {
            (_, true) => &mut moves.rapids,
            (TracePath::Line { .. }, false) => &mut moves.lines,
            (TracePath::Arc { .. } | TracePath::Tilted(_), false) => &mut moves.arcs,
            (TracePath::Spiral { .. }, false) => &mut moves.spirals,
            (TracePath::Nurbs { .. } | TracePath::Space(_), false) => &mut moves.nurbs,
        };
        *counter += 1;
    }
}

fn time(case: &Case<'_>, trace: &Trace) -> Time {
    let mut time = Time { model: TIME_MODEL, ..Time::default() };
    add_time(case, trace, &mut time);
    time
}

/// Adds the time of the moves and dwells.
pub(super) fn add_time(case: &Case<'_>, trace: &Trace, time: &mut Time) {
    for placed in case.moves {
        let length = placed.cut.length();
        match placed.cut.feed {
            _ if placed.cut.rapid => time.rapid += 60.0 * length / RAPID_RATE,
            Some(feed) if feed > 0.0 => time.cutting += 60.0 * length / feed,
            _ => {}
        }
    }
    for event in &trace.events {
        if let EventKind::Dwell(seconds) = event.kind {
            time.dwell += seconds;
        }
    }
}

fn operations(case: &Case<'_>, proofs: Proofs) -> Vec<OperationProof> {
    let mut operations: Vec<OperationProof> = case
        .cl
        .operations
        .iter()
        .map(|o| OperationProof::unmeasured(o, Some(case.cl.origins[o.origin].span)))
        .collect();
    for Proof { operation, proof } in proofs.contours {
        let Some(of) = operations.get_mut(operation) else { continue };
        of.into = Some(proof.into.or_larger(of.into));
        of.out = Some(proof.out.or_larger(of.out));
        of.blocks = of.blocks.saturating_add(proof.blocks);
        of.pieces.push(proof);
    }
    for surface in proofs.surfaces {
        let Some(of) = operations.get_mut(surface.operation) else { continue };
        match surface.proof {
            Found::Finished(proof) => {
                of.into = Some(proof.into);
                of.out = Some(proof.out);
                of.blocks = proof.blocks;
                of.surface = Some(*proof);
            }
            Found::Cleared(into, proof) => {
                of.into = Some(into);
                of.clearing = Some(proof);
            }
        }
    }
    operations
}
