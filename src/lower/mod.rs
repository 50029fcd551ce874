//! Legalisation: CL × capabilities → target program.
//!
//! What the controller cannot do is expressed by what it can, with a coded note that gives span, reason and
//! deviation, or refused. Curve moves are fitted here ([`fit`]), in their band and on the controller's grid.
//!
//! # Contract
//! - Contours are fitted once each, before anything is emitted ([`contour`]); every level of a contour uses the
//!   same fit.
//! - What is emitted ([`emit`]) is checked once, where it is pushed: word ranges and travel.
//! - Rapid moves never move Z together with another axis: up first, or down last.
//! - After a tool change, and at the start, the position is unknown: Z moves first, alone.
//! - A machine with a rotary axis is at a multiple of a full turn whenever a move is Cartesian.

mod arc;
pub(crate) mod circle;
mod compensation;
pub mod contour;
mod cut;
mod cycle;
mod emit;
mod feed;
pub mod fit;
mod lead;
mod pass;
mod path;
mod pieces;
mod process;
mod rotary;
mod spline;
pub mod stream;
#[cfg(test)]
mod tests;
mod tools;

use crate::cl::Cl;
use crate::diag::Sink;
use crate::target::{Capabilities, TargetProgram};

/// Makes the program of one controller; `None` after errors.
pub fn lower(cl: &Cl, capabilities: &Capabilities, sink: &mut Sink) -> Option<TargetProgram> {
    let mut messages = Sink::default();
    let fitted = contour::fit_all(cl, capabilities, &mut messages);
    let passes = pass::fit_all(cl, capabilities, &mut messages);
    let program = if messages.has_errors() {
        None
    } else {
        emit::program(cl, capabilities, (&fitted, &passes), &mut messages)
    };
    let failed = messages.has_errors();
    sink.append(messages);
    program.filter(|_| !failed)
}
