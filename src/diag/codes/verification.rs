//! Codes of read-back and verification.

use crate::diag::Code;

/// the emitted program is out of tolerance.
pub const OUT_OF_TOLERANCE: Code = Code {
    id: "E0801",
    title: "the emitted program is out of tolerance",
    page: include_str!("../../../docs/diagnostics/E0801.md"),
};

/// All codes of this area.
pub const ALL: &[&Code] = &[&OUT_OF_TOLERANCE];
