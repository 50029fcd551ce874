//! Codes of lowering to a controller.

use crate::diag::Code;

/// the path cannot be expressed within the tolerance.
pub const CANNOT_FIT: Code = Code {
    id: "E0602",
    title: "the path cannot be expressed within the tolerance",
    page: include_str!("../../../docs/diagnostics/E0602.md"),
};

/// the path leaves the machine's travel.
pub const OUT_OF_TRAVEL: Code = Code {
    id: "E0603",
    title: "the path leaves the machine's travel",
    page: include_str!("../../../docs/diagnostics/E0603.md"),
};

/// a number is larger than the controller's word.
pub const TOO_LARGE: Code = Code {
    id: "E0604",
    title: "a number is larger than the controller's word",
    page: include_str!("../../../docs/diagnostics/E0604.md"),
};

/// a feed does not fit the controller.
pub const FEED_RANGE: Code = Code {
    id: "E0605",
    title: "a feed does not fit the controller",
    page: include_str!("../../../docs/diagnostics/E0605.md"),
};

/// a feed per revolution needs a turning spindle.
pub const NO_SPINDLE_FOR_FEED: Code = Code {
    id: "E0606",
    title: "a feed per revolution needs a turning spindle",
    page: include_str!("../../../docs/diagnostics/E0606.md"),
};

/// the spindle cannot turn at this speed.
pub const SPINDLE_RANGE: Code = Code {
    id: "E0607",
    title: "the spindle cannot turn at this speed",
    page: include_str!("../../../docs/diagnostics/E0607.md"),
};

/// arcs became lines.
pub const NO_ARCS: Code = Code {
    id: "N0601",
    title: "arcs became lines",
    page: include_str!("../../../docs/diagnostics/N0601.md"),
};

/// R-theta without a rotary axis.
pub const NO_ROTARY: Code = Code {
    id: "N0602",
    title: "R-theta without a rotary axis",
    page: include_str!("../../../docs/diagnostics/N0602.md"),
};

/// NURBS became arcs or lines.
pub const NO_NURBS: Code = Code {
    id: "N0603",
    title: "NURBS became arcs or lines",
    page: include_str!("../../../docs/diagnostics/N0603.md"),
};

/// feed per revolution became feed per minute.
pub const NO_FEED_PER_REVOLUTION: Code = Code {
    id: "N0604",
    title: "feed per revolution became feed per minute",
    page: include_str!("../../../docs/diagnostics/N0604.md"),
};

/// a lead became radial.
pub const RADIAL_LEAD: Code = Code {
    id: "N0605",
    title: "a lead became radial",
    page: include_str!("../../../docs/diagnostics/N0605.md"),
};

/// no tolerance is left for the control's smoothing.
pub const PATH_TOLERANCE: Code = Code {
    id: "N0606",
    title: "no tolerance is left for the control's smoothing",
    page: include_str!("../../../docs/diagnostics/N0606.md"),
};

/// the controller does not have this coolant.
pub const COOLANT: Code = Code {
    id: "N0607",
    title: "the controller does not have this coolant",
    page: include_str!("../../../docs/diagnostics/N0607.md"),
};

/// the controller has no optional stop.
pub const OPTIONAL_STOP: Code = Code {
    id: "N0608",
    title: "the controller has no optional stop",
    page: include_str!("../../../docs/diagnostics/N0608.md"),
};

/// an arc is cut by lines.
pub const ARC_AS_LINES: Code = Code {
    id: "N0609",
    title: "an arc is cut by lines",
    page: include_str!("../../../docs/diagnostics/N0609.md"),
};

/// a drilling cycle is written as moves.
pub const CYCLE_EXPANDED: Code = Code {
    id: "N0610",
    title: "a drilling cycle is written as moves",
    page: include_str!("../../../docs/diagnostics/N0610.md"),
};

/// the cycle needs the control.
pub const NO_CYCLE: Code = Code {
    id: "E0608",
    title: "the controller does not have this cycle",
    page: include_str!("../../../docs/diagnostics/E0608.md"),
};

/// the cycle has one depth of cut.
pub const ONE_PECK: Code = Code {
    id: "N0611",
    title: "the cycle has one depth of cut",
    page: include_str!("../../../docs/diagnostics/N0611.md"),
};

/// coolant through the tool is not a word of the controller.
pub const NO_THROUGH: Code = Code {
    id: "E0609",
    title: "the controller has no word for coolant through the tool",
    page: include_str!("../../../docs/diagnostics/E0609.md"),
};

/// the spindle turns against the hand of the tap.
pub const TAP_HAND: Code = Code {
    id: "E0610",
    title: "the spindle turns against the hand of the tap",
    page: include_str!("../../../docs/diagnostics/E0610.md"),
};

/// cutter compensation cannot be in force here.
pub const COMPENSATION: Code = Code {
    id: "E0611",
    title: "cutter compensation cannot be in force here",
    page: include_str!("../../../docs/diagnostics/E0611.md"),
};

/// All codes of this area.
pub const ALL: &[&Code] = &[
    &CANNOT_FIT,
    &OUT_OF_TRAVEL,
    &TOO_LARGE,
    &FEED_RANGE,
    &NO_SPINDLE_FOR_FEED,
    &SPINDLE_RANGE,
    &NO_ARCS,
    &NO_ROTARY,
    &NO_NURBS,
    &NO_FEED_PER_REVOLUTION,
    &RADIAL_LEAD,
    &PATH_TOLERANCE,
    &COOLANT,
    &OPTIONAL_STOP,
    &ARC_AS_LINES,
    &CYCLE_EXPANDED,
    &NO_CYCLE,
    &ONE_PECK,
    &NO_THROUGH,
    &TAP_HAND,
    &COMPENSATION,
];
