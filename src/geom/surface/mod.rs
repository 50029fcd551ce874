//! Bezier patches and nets of them: evaluation, fundamental forms, curvature.
//!
//! Sign convention: the unit normal n points to the tool (n·z > 0 where the surface is a graph) and a
//! normal curvature is positive where the surface is **concave**, that is, curves towards the tool.

pub mod curvature;
pub mod interval;
pub mod net;
pub mod patch;

pub use net::{Net, NetIssue};
pub use patch::{Patch, SurfaceJet};
