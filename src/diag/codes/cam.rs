//! Codes of cams, followers and motions.

use crate::diag::Code;

/// The motion's angles do not add up to 360 degrees.
pub const ANGLES_DO_NOT_CLOSE: Code = Code {
    id: "E0401",
    title: "the motion's angles do not add up to 360 degrees",
    page: include_str!("../../../docs/diagnostics/E0401.md"),
};

/// The rises and returns of a motion do not cancel.
pub const LIFT_DOES_NOT_CLOSE: Code = Code {
    id: "E0402",
    title: "the rises and returns of a motion do not cancel",
    page: include_str!("../../../docs/diagnostics/E0402.md"),
};

/// The lift or velocity of a motion jumps.
pub const MOTION_JUMPS: Code = Code {
    id: "E0403",
    title: "the lift or velocity of a motion jumps",
    page: include_str!("../../../docs/diagnostics/E0403.md"),
};

/// The conditions of a POLY segment determine no polynomial.
pub const POLY_UNDETERMINED: Code = Code {
    id: "E0404",
    title: "the conditions of a POLY segment determine no polynomial",
    page: include_str!("../../../docs/diagnostics/E0404.md"),
};

/// A table of lifts cannot be used.
pub const TABLE: Code = Code {
    id: "E0405",
    title: "a table of lifts cannot be used",
    page: include_str!("../../../docs/diagnostics/E0405.md"),
};

/// A value of a motion or cam must be over 0.
pub const NOT_POSITIVE: Code = Code {
    id: "E0406",
    title: "a value of a motion or cam must be over 0",
    page: include_str!("../../../docs/diagnostics/E0406.md"),
};

/// The follower does not reach the base circle, or swings too far.
pub const DOES_NOT_REACH: Code = Code {
    id: "E0407",
    title: "the follower does not reach the base circle, or swings too far",
    page: include_str!("../../../docs/diagnostics/E0407.md"),
};

/// The profile is undercut.
pub const UNDERCUT: Code = Code {
    id: "E0408",
    title: "the profile is undercut",
    page: include_str!("../../../docs/diagnostics/E0408.md"),
};

/// The profile crosses itself.
pub const PROFILE_CROSSES: Code = Code {
    id: "E0409",
    title: "the profile crosses itself",
    page: include_str!("../../../docs/diagnostics/E0409.md"),
};

/// A groove needs a roller.
pub const GROOVE_NEEDS_ROLLER: Code = Code {
    id: "E0410",
    title: "a groove needs a roller",
    page: include_str!("../../../docs/diagnostics/E0410.md"),
};

/// The cutter does not fit a concave part of the cam.
pub const CUTTER_TOO_LARGE: Code = Code {
    id: "E0411",
    title: "the cutter does not fit a concave part of the cam",
    page: include_str!("../../../docs/diagnostics/E0411.md"),
};

/// The pressure angle is over its limit.
pub const PRESSURE_ANGLE: Code = Code {
    id: "W0401",
    title: "the pressure angle is over its limit",
    page: include_str!("../../../docs/diagnostics/W0401.md"),
};

/// The acceleration of a motion jumps.
pub const ACCELERATION_JUMPS: Code = Code {
    id: "W0402",
    title: "the acceleration of a motion jumps",
    page: include_str!("../../../docs/diagnostics/W0402.md"),
};

/// The lift falls below zero.
pub const NEGATIVE_LIFT: Code = Code {
    id: "W0403",
    title: "the lift falls below zero",
    page: include_str!("../../../docs/diagnostics/W0403.md"),
};

/// The flat face is narrower than the contact needs.
pub const FACE_TOO_NARROW: Code = Code {
    id: "W0404",
    title: "the flat face is narrower than the contact needs",
    page: include_str!("../../../docs/diagnostics/W0404.md"),
};

/// a lift that does not fit the follower.
pub const LIFT_DIMENSION: Code = Code {
    id: "E0412",
    title: "a lift that does not fit the follower",
    page: include_str!("../../../docs/diagnostics/E0412.md"),
};

/// All codes of this area.
pub const ALL: &[&Code] = &[
    &ANGLES_DO_NOT_CLOSE,
    &LIFT_DOES_NOT_CLOSE,
    &MOTION_JUMPS,
    &POLY_UNDETERMINED,
    &TABLE,
    &NOT_POSITIVE,
    &DOES_NOT_REACH,
    &UNDERCUT,
    &PROFILE_CROSSES,
    &GROOVE_NEEDS_ROLLER,
    &CUTTER_TOO_LARGE,
    &LIFT_DIMENSION,
    &PRESSURE_ANGLE,
    &ACCELERATION_JUMPS,
    &NEGATIVE_LIFT,
    &FACE_TOO_NARROW,
];
