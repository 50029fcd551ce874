//! Codes of CL files and foreign input.

use crate::diag::Code;

/// a CL record is not known.
pub const UNKNOWN_RECORD: Code = Code {
    id: "E1001",
    title: "a CL record is not known",
    page: include_str!("../../../docs/diagnostics/E1001.md"),
};

/// a CL record cannot be read.
pub const BAD_RECORD: Code = Code {
    id: "E1002",
    title: "a CL record cannot be read",
    page: include_str!("../../../docs/diagnostics/E1002.md"),
};

/// a post word cannot be carried out.
pub const NOT_CARRIED_OUT: Code = Code {
    id: "E1003",
    title: "a post word cannot be carried out",
    page: include_str!("../../../docs/diagnostics/E1003.md"),
};

/// the tool axis is off Z.
pub const TOOL_AXIS: Code = Code {
    id: "E1004",
    title: "the tool axis is off Z",
    page: include_str!("../../../docs/diagnostics/E1004.md"),
};

/// an arc's points are not on it.
pub const ARC_OFF: Code = Code {
    id: "E1005",
    title: "an arc's points are not on it",
    page: include_str!("../../../docs/diagnostics/E1005.md"),
};

/// a drilling cycle is not understood.
pub const BAD_CYCLE: Code = Code {
    id: "E1006",
    title: "a drilling cycle is not understood",
    page: include_str!("../../../docs/diagnostics/E1006.md"),
};

/// a curve cannot be read.
pub const BAD_CURVE: Code = Code {
    id: "E1007",
    title: "a curve cannot be read",
    page: include_str!("../../../docs/diagnostics/E1007.md"),
};

/// a value for a CL file is not understood.
pub const BAD_DEFINE: Code = Code {
    id: "E1008",
    title: "a value for a CL file is not understood",
    page: include_str!("../../../docs/diagnostics/E1008.md"),
};

/// no such producer.
pub const UNKNOWN_PRODUCER: Code =
    Code { id: "E1009", title: "no such producer", page: include_str!("../../../docs/diagnostics/E1009.md") };

/// cutter compensation of the control is left out.
pub const NO_COMPENSATION: Code = Code {
    id: "W1010",
    title: "cutter compensation of the control is left out",
    page: include_str!("../../../docs/diagnostics/W1010.md"),
};

/// What `CUTCOM/ ON` lacks where no side was given before.
pub const NO_SIDE: &str = "CUTCOM/ ON goes on with the side that was in force, and there was none";

/// What to do about [`NO_COMPENSATION`].
pub const NO_COMPENSATION_HELP: &str = "if the points are the part's contour and not the cutter's centre, write the path of the centre instead: as it is, it cuts into the part by the radius";

/// the control moves the path by what its register holds.
pub const COMPENSATED: Code = Code {
    id: "W1022",
    title: "the control moves the path by what its register holds",
    page: include_str!("../../../docs/diagnostics/W1022.md"),
};

/// What [`COMPENSATED`] says.
pub const COMPENSATED_MESSAGE: &str =
    "the control moves this path by the radius that it holds: the proof is for a radius of 0";
/// And what to do about it.
pub const COMPENSATED_HELP: &str = "for points of the cutter's centre keep 0 there, or the wear alone, or write them as they are with `--post-set compensation.register=none`; for points of the contour it is the cutter's radius";

/// an arc does not go through its points.
pub const ARC_NOT_TRUSTED: Code = Code {
    id: "W1011",
    title: "an arc does not go through its points",
    page: include_str!("../../../docs/diagnostics/W1011.md"),
};

/// the first move after a tool change is made at rapid.
pub const FIRST_AT_RAPID: Code = Code {
    id: "W1012",
    title: "the first move after a tool change is made at rapid",
    page: include_str!("../../../docs/diagnostics/W1012.md"),
};

/// a curve is cut by lines.
pub const CURVE_AS_LINES: Code = Code {
    id: "N1013",
    title: "a curve is cut by lines",
    page: include_str!("../../../docs/diagnostics/N1013.md"),
};

/// not all messages are shown.
pub const MORE: Code = Code {
    id: "N1014",
    title: "not all messages are shown",
    page: include_str!("../../../docs/diagnostics/N1014.md"),
};

/// a tool has no number.
pub const NO_TOOL_NUMBER: Code = Code {
    id: "W1015",
    title: "a tool has no number",
    page: include_str!("../../../docs/diagnostics/W1015.md"),
};

/// a CL file is empty.
pub const NO_RECORDS: Code = Code {
    id: "E1016",
    title: "a CL file is empty",
    page: include_str!("../../../docs/diagnostics/E1016.md"),
};

/// a CL file does not say its unit.
pub const UNIT_ASSUMED: Code = Code {
    id: "W1017",
    title: "a CL file does not say its unit",
    page: include_str!("../../../docs/diagnostics/W1017.md"),
};

/// a CL file moves nothing.
pub const NO_MOTION: Code = Code {
    id: "W1018",
    title: "a CL file moves nothing",
    page: include_str!("../../../docs/diagnostics/W1018.md"),
};

/// a CL file stops without its end.
pub const CUT_OFF: Code = Code {
    id: "W1019",
    title: "a CL file stops without its end",
    page: include_str!("../../../docs/diagnostics/W1019.md"),
};

/// one tool number has two cutters.
pub const OTHER_CUTTER: Code = Code {
    id: "W1020",
    title: "one tool number has two cutters",
    page: include_str!("../../../docs/diagnostics/W1020.md"),
};

/// the spindle turns counter-clockwise as for the tool before.
pub const SENSE_KEPT: Code = Code {
    id: "W1021",
    title: "the spindle turns counter-clockwise as for the tool before",
    page: include_str!("../../../docs/diagnostics/W1021.md"),
};

/// All codes of this area.
pub const ALL: &[&Code] = &[
    &UNKNOWN_RECORD,
    &BAD_RECORD,
    &NOT_CARRIED_OUT,
    &TOOL_AXIS,
    &ARC_OFF,
    &BAD_CYCLE,
    &BAD_CURVE,
    &BAD_DEFINE,
    &UNKNOWN_PRODUCER,
    &NO_COMPENSATION,
    &COMPENSATED,
    &ARC_NOT_TRUSTED,
    &FIRST_AT_RAPID,
    &CURVE_AS_LINES,
    &MORE,
    &NO_TOOL_NUMBER,
    &NO_RECORDS,
    &UNIT_ASSUMED,
    &NO_MOTION,
    &CUT_OFF,
    &OTHER_CUTTER,
    &SENSE_KEPT,
];
