//! Codes of post files and writing.

use crate::diag::Code;

/// unknown post.
pub const UNKNOWN_POST: Code =
    Code { id: "E0701", title: "unknown post", page: include_str!("../../../docs/diagnostics/E0701.md") };

/// All codes of this area.
pub const ALL: &[&Code] = &[&UNKNOWN_POST];
