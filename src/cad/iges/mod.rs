//! IGES files in the fixed format: rational B-spline surfaces (entity 128), alone or under faces.

mod entities;
mod faces;
mod records;

pub use records::Drawing;

pub(super) use faces::net;
