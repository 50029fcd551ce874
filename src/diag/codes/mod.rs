//! The catalogue of diagnostic codes, one table per area.
//!
//! | area | codes |
//! |---|---|
//! | syntax | 01xx |
//! | names, words, slots, units, evaluation | 02xx |
//! | geometry, curves, surfaces | 03xx |
//! | cams, followers, motions | 04xx |
//! | tool path planning | 05xx |
//! | lowering to a controller | 06xx |
//! | post files and writing | 07xx |
//! | read-back and verification | 08xx |
//! | files, command line, configuration | 09xx |
//! | CL files and foreign input | 10xx |
//!
//! To add a code: a constant in its area's file and in that file's `ALL`, and a
//! page `docs/diagnostics/CODE.md` with a wrong and a right example.

use super::Code;

pub mod cam;
pub mod command;
pub mod foreign;
pub mod geometry;
pub mod lowering;
pub mod planning;
pub mod post;
pub mod semantics;
pub mod syntax;
pub mod tools;
pub mod verification;

/// Every code, by area, in order.
pub fn all() -> impl Iterator<Item = &'static Code> {
    [
        syntax::ALL,
        semantics::ALL,
        geometry::ALL,
        cam::ALL,
        planning::ALL,
        lowering::ALL,
        post::ALL,
        tools::OF_POSTS,
        verification::ALL,
        command::ALL,
        tools::OF_COMMANDS,
        foreign::ALL,
    ]
    .into_iter()
    .flatten()
    .copied()
}

/// The code with this id, case-blind.
#[must_use]
pub fn find(id: &str) -> Option<&'static Code> {
    all().find(|c| c.id.eq_ignore_ascii_case(id))
}
