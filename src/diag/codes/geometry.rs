//! Codes of geometry.

use crate::diag::Code;

/// the geometry does not exist.
pub const UNDEFINED_GEOMETRY: Code = Code {
    id: "E0301",
    title: "the geometry does not exist",
    page: include_str!("../../../docs/diagnostics/E0301.md"),
};

/// All codes of this area.
pub const ALL: &[&Code] = &[&UNDEFINED_GEOMETRY];
