//! Codes of lowering to a controller.

use crate::diag::Code;

/// the controller cannot do this.
pub const NOT_ON_THIS_CONTROLLER: Code = Code {
    id: "E0601",
    title: "the controller cannot do this",
    page: include_str!("../../../docs/diagnostics/E0601.md"),
};

/// All codes of this area.
pub const ALL: &[&Code] = &[&NOT_ON_THIS_CONTROLLER];
