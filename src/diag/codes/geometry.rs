//! Codes of geometry.

use crate::diag::Code;

/// the geometry does not exist.
pub const UNDEFINED_GEOMETRY: Code = Code {
    id: "E0301",
    title: "the geometry does not exist",
    page: include_str!("../../../docs/diagnostics/E0301.md"),
};

/// the control net is not sound.
pub const NET_SHAPE: Code = Code {
    id: "E0310",
    title: "the control net is not sound",
    page: include_str!("../../../docs/diagnostics/E0310.md"),
};

/// patches of a net meet at an angle.
pub const CREASE: Code = Code {
    id: "W0310",
    title: "patches of a net meet at an angle",
    page: include_str!("../../../docs/diagnostics/W0310.md"),
};

/// All codes of this area.
pub const ALL: &[&Code] = &[&UNDEFINED_GEOMETRY, &NET_SHAPE, &CREASE];
