//! Legalisation: CL × capabilities → target program.
//!
//! What the controller cannot do is expressed by what it can, with a coded note that gives span, reason and
//! deviation, or refused. Curve moves are fitted here ([`fit`]), in their band and on the controller's grid.

pub mod fit;
pub mod place;
