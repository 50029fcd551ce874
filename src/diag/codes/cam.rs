//! Codes of cams, followers and motions.

use crate::diag::Code;

/// the motion's angles do not add up to 360 degrees.
pub const ANGLES_DO_NOT_CLOSE: Code = Code {
    id: "E0401",
    title: "the motion's angles do not add up to 360 degrees",
    page: include_str!("../../../docs/diagnostics/E0401.md"),
};

/// All codes of this area.
pub const ALL: &[&Code] = &[&ANGLES_DO_NOT_CLOSE];
