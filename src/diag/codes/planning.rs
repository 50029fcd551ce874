//! Codes of tool path planning.

use crate::diag::Code;

/// no tool is loaded.
pub const NO_TOOL: Code = Code {
    id: "E0501",
    title: "no tool is loaded",
    page: include_str!("../../../docs/diagnostics/E0501.md"),
};

/// All codes of this area.
pub const ALL: &[&Code] = &[&NO_TOOL];
