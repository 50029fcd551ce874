//! Codes of tool path planning.

use crate::diag::Code;

/// no tool is loaded.
pub const NO_TOOL: Code = Code {
    id: "E0501",
    title: "no tool is loaded",
    page: include_str!("../../../docs/diagnostics/E0501.md"),
};

/// the spindle is off at a cut.
pub const SPINDLE_OFF: Code = Code {
    id: "E0502",
    title: "the spindle is off at a cut",
    page: include_str!("../../../docs/diagnostics/E0502.md"),
};

/// no feed is set at a cut.
pub const NO_FEED: Code = Code {
    id: "E0503",
    title: "no feed is set at a cut",
    page: include_str!("../../../docs/diagnostics/E0503.md"),
};

/// a feed per tooth needs the number of flutes.
pub const NO_FLUTES: Code = Code {
    id: "E0504",
    title: "a feed per tooth needs the number of flutes",
    page: include_str!("../../../docs/diagnostics/E0504.md"),
};

/// the cutter is too large for the contour.
pub const CUTTER_TOO_LARGE: Code = Code {
    id: "E0505",
    title: "the cutter is too large for the contour",
    page: include_str!("../../../docs/diagnostics/E0505.md"),
};

/// the cutter does not fit the groove.
pub const CUTTER_WIDER_THAN_GROOVE: Code = Code {
    id: "E0506",
    title: "the cutter does not fit the groove",
    page: include_str!("../../../docs/diagnostics/E0506.md"),
};

/// the cut is deeper than the cutter reaches.
pub const TOO_DEEP: Code = Code {
    id: "E0507",
    title: "the cut is deeper than the cutter reaches",
    page: include_str!("../../../docs/diagnostics/E0507.md"),
};

/// the blank is smaller than the part.
pub const STOCK_TOO_SMALL: Code = Code {
    id: "E0508",
    title: "the blank is smaller than the part",
    page: include_str!("../../../docs/diagnostics/E0508.md"),
};

/// a plate cam is roughed from a round blank only.
pub const STOCK_NOT_ROUND: Code = Code {
    id: "E0509",
    title: "a plate cam is roughed from a round blank only",
    page: include_str!("../../../docs/diagnostics/E0509.md"),
};

/// the edges of a contour do not join.
pub const EDGES_DO_NOT_JOIN: Code = Code {
    id: "E0510",
    title: "the edges of a contour do not join",
    page: include_str!("../../../docs/diagnostics/E0510.md"),
};

/// no roughing plan clears the blank.
pub const NO_ROUGHING_PLAN: Code = Code {
    id: "E0511",
    title: "no roughing plan clears the blank",
    page: include_str!("../../../docs/diagnostics/E0511.md"),
};

/// a cut from an unknown place.
pub const NO_START: Code = Code {
    id: "E0512",
    title: "a cut from an unknown place",
    page: include_str!("../../../docs/diagnostics/E0512.md"),
};

/// a rapid move goes through the stock.
pub const RAPID_THROUGH_STOCK: Code = Code {
    id: "E0513",
    title: "a rapid move goes through the stock",
    page: include_str!("../../../docs/diagnostics/E0513.md"),
};

/// a move cuts into the finished part.
pub const MOVE_CUTS_PART: Code = Code {
    id: "E0514",
    title: "a move cuts into the finished part",
    page: include_str!("../../../docs/diagnostics/E0514.md"),
};

/// an inserted block spoils the program.
pub const INSERT_SPOILS: Code = Code {
    id: "E0515",
    title: "an inserted block spoils the program",
    page: include_str!("../../../docs/diagnostics/E0515.md"),
};

/// roughing takes this path and time.
pub const ROUGHING_FIGURES: Code = Code {
    id: "N0520",
    title: "roughing takes this path and time",
    page: include_str!("../../../docs/diagnostics/N0520.md"),
};

/// the cutter's rounded end does not reach the foot of the wall.
pub const ROUNDED_END: Code = Code {
    id: "N0521",
    title: "the cutter's rounded end does not reach the foot of the wall",
    page: include_str!("../../../docs/diagnostics/N0521.md"),
};

/// there is no room for a tangent lead.
pub const NO_ROOM_FOR_LEAD: Code = Code {
    id: "N0522",
    title: "there is no room for a tangent lead",
    page: include_str!("../../../docs/diagnostics/N0522.md"),
};

/// one roughing pass takes all of the material.
pub const ROUGH_MATERIAL: Code = Code {
    id: "N0523",
    title: "one roughing pass takes all of the material",
    page: include_str!("../../../docs/diagnostics/N0523.md"),
};

/// a roughing pass is deeper than the cutter can take.
pub const ROUGH_TOO_DEEP: Code = Code {
    id: "W0532",
    title: "a roughing pass is deeper than the cutter can take",
    page: include_str!("../../../docs/diagnostics/W0532.md"),
};

/// stock stands between the cuts of a level.
pub const STOCK_STANDS: Code = Code {
    id: "W0533",
    title: "stock stands between the cuts of a level",
    page: include_str!("../../../docs/diagnostics/W0533.md"),
};

/// there is no room for a helix.
pub const NO_ROOM_FOR_HELIX: Code = Code {
    id: "N0524",
    title: "there is no room for a helix",
    page: include_str!("../../../docs/diagnostics/N0524.md"),
};

/// the way down into material asks for teeth near the axis.
pub const TEETH_AT_CENTRE: Code = Code {
    id: "N0525",
    title: "the way down into material asks for teeth near the axis",
    page: include_str!("../../../docs/diagnostics/N0525.md"),
};

/// roughing passes are wider than the cutter.
pub const ROUGH_TOO_WIDE: Code = Code {
    id: "E0545",
    title: "roughing passes are wider apart than the cutter",
    page: include_str!("../../../docs/diagnostics/E0545.md"),
};

/// there is nothing to clear.
pub const NOTHING_TO_CLEAR: Code = Code {
    id: "E0546",
    title: "there is nothing to clear over the surface",
    page: include_str!("../../../docs/diagnostics/E0546.md"),
};

/// a tapered cutter leaves a sloping wall.
pub const TAPERED_WALL: Code = Code {
    id: "W0530",
    title: "a tapered cutter leaves a sloping wall",
    page: include_str!("../../../docs/diagnostics/W0530.md"),
};

/// the cut is deeper than the cutter sticks out.
pub const HOLDER_RUBS: Code = Code {
    id: "W0531",
    title: "the cut is deeper than the cutter sticks out of its holder",
    page: include_str!("../../../docs/diagnostics/W0531.md"),
};

/// a drill is to mill.
pub const DRILL_MILLS: Code = Code {
    id: "E0516",
    title: "a drill is to cut a contour",
    page: include_str!("../../../docs/diagnostics/E0516.md"),
};

/// the cutter cannot finish a surface.
pub const NO_BALL: Code = Code {
    id: "E0540",
    title: "the cutter cannot finish a surface",
    page: include_str!("../../../docs/diagnostics/E0540.md"),
};

/// the cutter is too large for the surface.
pub const SURFACE_TOO_HOLLOW: Code = Code {
    id: "E0541",
    title: "the cutter is too large for the surface",
    page: include_str!("../../../docs/diagnostics/E0541.md"),
};

/// the cutter cannot reach all of the surface.
pub const SURFACE_LIFTED: Code = Code {
    id: "W0541",
    title: "the cutter cannot reach all of the surface",
    page: include_str!("../../../docs/diagnostics/W0541.md"),
};

/// the surface has no side that the cutter could reach.
pub const OVERHANG: Code = Code {
    id: "E0542",
    title: "the surface has no side that the cutter could reach",
    page: include_str!("../../../docs/diagnostics/E0542.md"),
};

/// the clearance plane lies below the surface.
pub const CLEARANCE_TOO_LOW: Code = Code {
    id: "E0543",
    title: "the clearance plane lies below the surface",
    page: include_str!("../../../docs/diagnostics/E0543.md"),
};

/// no passes can be laid over the surface.
pub const NO_PASSES: Code = Code {
    id: "E0544",
    title: "no passes can be laid over the surface",
    page: include_str!("../../../docs/diagnostics/E0544.md"),
};

/// passes that no arcs can follow.
pub const NO_ARCS: Code = Code {
    id: "E0547",
    title: "passes that no arcs can follow",
    page: include_str!("../../../docs/diagnostics/E0547.md"),
};

/// All codes of this area.
pub const ALL: &[&Code] = &[
    &NO_TOOL,
    &SPINDLE_OFF,
    &NO_FEED,
    &NO_FLUTES,
    &CUTTER_TOO_LARGE,
    &CUTTER_WIDER_THAN_GROOVE,
    &TOO_DEEP,
    &STOCK_TOO_SMALL,
    &STOCK_NOT_ROUND,
    &EDGES_DO_NOT_JOIN,
    &NO_ROUGHING_PLAN,
    &NO_START,
    &RAPID_THROUGH_STOCK,
    &MOVE_CUTS_PART,
    &INSERT_SPOILS,
    &DRILL_MILLS,
    &ROUGHING_FIGURES,
    &ROUNDED_END,
    &NO_ROOM_FOR_LEAD,
    &ROUGH_MATERIAL,
    &NO_ROOM_FOR_HELIX,
    &TEETH_AT_CENTRE,
    &ROUGH_TOO_WIDE,
    &NOTHING_TO_CLEAR,
    &ROUGH_TOO_DEEP,
    &STOCK_STANDS,
    &TAPERED_WALL,
    &HOLDER_RUBS,
    &NO_BALL,
    &SURFACE_TOO_HOLLOW,
    &SURFACE_LIFTED,
    &OVERHANG,
    &CLEARANCE_TOO_LOW,
    &NO_PASSES,
    &NO_ARCS,
];
