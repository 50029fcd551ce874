//! Codes of read-back and verification.

use crate::diag::Code;

/// The emitted program is out of tolerance.
pub const OUT_OF_TOLERANCE: Code = Code {
    id: "E0801",
    title: "the emitted program is out of tolerance",
    page: include_str!("../../../docs/diagnostics/E0801.md"),
};

/// The control would refuse the emitted program.
pub const REFUSED_BY_CONTROL: Code = Code {
    id: "E0802",
    title: "the control would refuse the emitted program",
    page: include_str!("../../../docs/diagnostics/E0802.md"),
};

/// The emitted program does not follow the whole contour.
pub const NOT_FOLLOWED: Code = Code {
    id: "E0803",
    title: "the emitted program does not follow the whole contour",
    page: include_str!("../../../docs/diagnostics/E0803.md"),
};

/// A rapid runs through stock that may still be there.
pub const RAPID_IN_STOCK: Code = Code {
    id: "E0804",
    title: "a rapid runs through stock that may still be there",
    page: include_str!("../../../docs/diagnostics/E0804.md"),
};

/// The cutter goes into a finished wall.
pub const GOUGE: Code = Code {
    id: "E0805",
    title: "the cutter goes into a finished wall",
    page: include_str!("../../../docs/diagnostics/E0805.md"),
};

/// A cut has the wrong feed.
pub const WRONG_FEED: Code = Code {
    id: "E0806",
    title: "a cut has the wrong feed",
    page: include_str!("../../../docs/diagnostics/E0806.md"),
};

/// A cut without its spindle, tool or position.
pub const NOT_READY: Code = Code {
    id: "E0807",
    title: "a cut without its spindle, tool or position",
    page: include_str!("../../../docs/diagnostics/E0807.md"),
};

/// A move goes beyond the machine's travel.
pub const BEYOND_TRAVEL: Code = Code {
    id: "E0808",
    title: "a move goes beyond the machine's travel",
    page: include_str!("../../../docs/diagnostics/E0808.md"),
};

/// The program leaves something to the control's settings.
pub const LEFT_TO_SETTINGS: Code = Code {
    id: "E0809",
    title: "the program leaves something to the control's settings",
    page: include_str!("../../../docs/diagnostics/E0809.md"),
};

/// The emitted program cannot be proven.
pub const CANNOT_PROVE: Code = Code {
    id: "E0810",
    title: "the emitted program cannot be proven",
    page: include_str!("../../../docs/diagnostics/E0810.md"),
};

/// The text does not do what the lowered program says.
pub const NOT_AS_LOWERED: Code = Code {
    id: "E0811",
    title: "the text does not do what the lowered program says",
    page: include_str!("../../../docs/diagnostics/E0811.md"),
};

/// the part would be cut in another work offset.
pub const WRONG_OFFSET: Code = Code {
    id: "E0812",
    title: "a cut in another work offset than asked for",
    page: include_str!("../../../docs/diagnostics/E0812.md"),
};

/// the cutter goes into a finished surface.
pub const SURFACE_GOUGED: Code = Code {
    id: "E0820",
    title: "the cutter goes into a finished surface",
    page: include_str!("../../../docs/diagnostics/E0820.md"),
};

/// more is left on a surface than its tolerances allow.
pub const SURFACE_LEFT: Code = Code {
    id: "E0821",
    title: "more is left on a surface than its tolerances allow",
    page: include_str!("../../../docs/diagnostics/E0821.md"),
};

/// All codes of this area.
pub const ALL: &[&Code] = &[
    &OUT_OF_TOLERANCE,
    &REFUSED_BY_CONTROL,
    &NOT_FOLLOWED,
    &RAPID_IN_STOCK,
    &GOUGE,
    &WRONG_FEED,
    &NOT_READY,
    &BEYOND_TRAVEL,
    &LEFT_TO_SETTINGS,
    &CANNOT_PROVE,
    &NOT_AS_LOWERED,
    &WRONG_OFFSET,
    &SURFACE_GOUGED,
    &SURFACE_LEFT,
];
