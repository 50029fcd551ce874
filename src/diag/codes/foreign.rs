//! Codes of CL files and foreign input.

use crate::diag::Code;

/// unknown CL record.
pub const UNKNOWN_RECORD: Code = Code {
    id: "E1001",
    title: "unknown CL record",
    page: include_str!("../../../docs/diagnostics/E1001.md"),
};

/// All codes of this area.
pub const ALL: &[&Code] = &[&UNKNOWN_RECORD];
