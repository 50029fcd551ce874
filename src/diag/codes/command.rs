//! Codes of files, the command line and configuration.

use crate::diag::Code;

/// a file cannot be read.
pub const CANNOT_READ: Code = Code {
    id: "E0901",
    title: "a file cannot be read",
    page: include_str!("../../../docs/diagnostics/E0901.md"),
};

/// All codes of this area.
pub const ALL: &[&Code] = &[&CANNOT_READ];
