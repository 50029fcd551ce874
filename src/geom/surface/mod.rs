//! Bezier patches and nets of them: evaluation, fundamental forms, curvature.
//!
//! Sign convention: the unit normal n points to the tool (n·z > 0 where the surface is a graph) and a
//! normal curvature is positive where the surface is **concave**, that is, curves towards the tool.

mod crease;
pub mod curvature;
pub mod cutter;
pub mod drop;
pub mod grid;
pub mod heights;
pub mod interval;
pub mod net;
pub mod patch;
mod peaks;
pub mod rim;
pub mod spline;
pub mod standing;
pub mod swept;
pub mod track;
pub mod tree;

pub use cutter::Cutter;
pub use drop::{Contact, drop_ball};
pub use net::{Net, NetIssue};
pub use patch::{Patch, SurfaceJet};
pub use rim::Rim;
pub use spline::{SplineCurve, SplineIssue, SplineSurface};
pub use standing::{Island, Standing};
pub use track::{Guide, Track};
pub use tree::{Foot, SurfaceTree};
