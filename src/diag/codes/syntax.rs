//! Codes of the syntax stage.

use crate::diag::Code;

/// something else was expected here.
pub const UNEXPECTED: Code = Code {
    id: "E0101",
    title: "something else was expected here",
    page: include_str!("../../../docs/diagnostics/E0101.md"),
};

/// All codes of this area.
pub const ALL: &[&Code] = &[&UNEXPECTED];
