//! Codes of names, words, slots, units and evaluation.

use crate::diag::Code;

/// unknown word.
pub const UNKNOWN_WORD: Code =
    Code { id: "E0201", title: "unknown word", page: include_str!("../../../docs/diagnostics/E0201.md") };

/// All codes of this area.
pub const ALL: &[&Code] = &[&UNKNOWN_WORD];
