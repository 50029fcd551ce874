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

/// a CAD file cannot be understood.
pub const CAD_FILE: Code = Code {
    id: "E0311",
    title: "a CAD file cannot be understood",
    page: include_str!("../../../docs/diagnostics/E0311.md"),
};

/// no such B-spline face in a CAD file.
pub const CAD_FACE: Code = Code {
    id: "E0312",
    title: "no such B-spline face in a CAD file",
    page: include_str!("../../../docs/diagnostics/E0312.md"),
};

/// a surface of a CAD file cannot be a net.
pub const CAD_SURFACE: Code = Code {
    id: "E0313",
    title: "a surface of a CAD file cannot be a net",
    page: include_str!("../../../docs/diagnostics/E0313.md"),
};

/// a face is only a part of its surface.
pub const TRIMMED: Code = Code {
    id: "W0311",
    title: "a face is only a part of its surface",
    page: include_str!("../../../docs/diagnostics/W0311.md"),
};

/// a CAD file names no unit of length.
pub const NO_CAD_UNIT: Code = Code {
    id: "W0312",
    title: "a CAD file names no unit of length",
    page: include_str!("../../../docs/diagnostics/W0312.md"),
};

/// a CAD file places parts in assemblies.
pub const CAD_PLACED: Code = Code {
    id: "N0311",
    title: "a CAD file places parts in assemblies",
    page: include_str!("../../../docs/diagnostics/N0311.md"),
};

/// All codes of this area.
pub const ALL: &[&Code] = &[
    &UNDEFINED_GEOMETRY,
    &NET_SHAPE,
    &CREASE,
    &CAD_FILE,
    &CAD_FACE,
    &CAD_SURFACE,
    &TRIMMED,
    &NO_CAD_UNIT,
    &CAD_PLACED,
];
