//! STEP files (ISO 10303-21): the exchange structure, and the B-spline surfaces of its faces.
//!
//! AP203, AP214 and AP242 have the same entities for these.

mod faces;
mod part21;
mod splines;
mod units;
mod value;
mod write;

pub use part21::Exchange;
pub use write::write;

pub(super) use faces::net;
