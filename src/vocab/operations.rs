//! Point-to-point motion and operations.

use super::{
    Choices, EntityKind, Form, Group, Item, Kind, LENGTH, NOT_NEGATIVE, POSITIVE, Range, Statement, Usage,
    choices, form, optional, slot, value, with, word,
};
use crate::units::Dim;

const FEED: Item = optional("feed", Kind::Feed, "feed from here on");

const COMPONENT: Kind = Kind::Number(Dim::NONE, Range::Any);
const AXIS_I: Item = value("i", COMPONENT, "of the tool axis in x");
const AXIS_J: Item = value("j", COMPONENT, "of the tool axis in y");
const AXIS_K: Item = value("k", COMPONENT, "of the tool axis in z");

const TOOL_AXIS: &[Form] = &[
    form("vector", "a vector", &[value("vector", Kind::Vector, "from the tool's tip to its holder")], &[]),
    form("components", "its components", &[AXIS_I, AXIS_J, AXIS_K], &[]),
];

const WITH_AXIS: &[Form] = &[form(
    "axis",
    "coordinates and tool axis, which must be Z",
    &[value("x", LENGTH, "x"), value("y", LENGTH, "y"), value("z", LENGTH, "z"), AXIS_I, AXIS_J, AXIS_K],
    &[],
)];

/// `GOTO` with six numbers, after `MULTAX/ ON`.
pub static GOTO_WITH_AXIS: Statement =
    motion("GOTO", "straight to a point, with a tool axis", "GOTO/ 10, 20, 5, 0, 0, 1", WITH_AXIS);

const MULTI_AXIS: &[Form] = &[form(
    "state",
    "",
    &[],
    &[choices("state", &[word("ON", "points may have a tool axis"), word("OFF", "they have none")], "ON")],
)];

const TO_POINT: &[Form] = &[
    form("point", "a point", &[value("point", Kind::Point, "where to"), FEED], &[]),
    form(
        "coordinates",
        "coordinates",
        &[value("x", LENGTH, "x"), value("y", LENGTH, "y"), optional("z", LENGTH, "z; 0 without it"), FEED],
        &[],
    ),
    Form {
        name: "pattern",
        help: "to every point of a pattern",
        lead: &[value("pattern", Kind::Entity(&[EntityKind::Pattern]), "pattern")],
        options: PATTERN_POINTS,
        ordered: true,
    },
];

const WHICH: Item =
    Item::Repeat(slot("which", Kind::Count(1, 1_000_000), "number in the pattern, from 1"), 1, 1000);

const PATTERN_POINTS: &[Choices] = &[
    choices("order", &[word("INVERS", "from the last point to the first")], "as declared"),
    choices(
        "count",
        &[word("CONST", "numbers count as declared, also after INVERS")],
        "in the order of travel",
    ),
    with("omit", &[word("OMIT", "points to leave out")], &[WHICH], false, "none"),
    with("retain", &[word("RETAIN", "the only points to keep")], &[WHICH], false, "all"),
    with("thru", &[word("THRU", "up to this one")], &[WHICH], false, ""),
    with(
        "avoid",
        &[word("AVOID", "points after which the way to the next one is raised")],
        &[value("height", POSITIVE, "how far it is raised"), WHICH],
        false,
        "none",
    ),
];

const AT_POINT: &[Form] = &[
    form("point", "a point", &[value("point", Kind::Point, "where")], &[]),
    form(
        "coordinates",
        "coordinates",
        &[value("x", LENGTH, "x"), value("y", LENGTH, "y"), optional("z", LENGTH, "z; 0 without it")],
        &[],
    ),
];

const BY_DELTA: &[Form] = &[
    form("vector", "a vector", &[value("vector", Kind::Vector, "how far"), FEED], &[]),
    form(
        "deltas",
        "increments",
        &[value("dx", LENGTH, "in x"), value("dy", LENGTH, "in y"), value("dz", LENGTH, "in z"), FEED],
        &[],
    ),
    form("axis", "along the tool axis", &[value("dz", LENGTH, "in z")], &[]),
];

const fn motion(
    word: &'static str,
    help: &'static str,
    example: &'static str,
    forms: &'static [Form],
) -> Statement {
    Statement {
        word,
        aliases: &[],
        group: Group::Motion,
        usage: Usage::Command,
        help,
        example,
        forms,
        members: &[],
    }
}

/// Point-to-point motion.
pub const MOTION: &[Statement] = &[
    motion(
        "FROM",
        "where the cutter is: it goes there at rapid, unless it is there",
        "FROM/ 0, 0, 50",
        AT_POINT,
    ),
    motion("GOTO", "straight to a point", "GOTO/ 10, 20, 5", TO_POINT),
    motion("GODLTA", "straight by increments", "GODLTA/ 0, 0, -5", BY_DELTA),
    motion("RAPID", "the next move is at rapid", "RAPID", &[]),
    motion(
        "MULTAX",
        "after it GOTO may have three numbers more: a tool axis, which must be Z, for the posts are for three axes",
        "MULTAX/ OFF",
        MULTI_AXIS,
    ),
    motion("TLAXIS", "tool axis of the points that follow, which must be Z", "TLAXIS/ 0, 0, 1", TOOL_AXIS),
];

pub(super) const CUT: Choices = choices(
    "cut",
    &[
        word("CLIMB", "climb milling: the edge enters at full chip thickness"),
        word("CONVEN", "conventional milling"),
    ],
    "CLIMB",
);

pub(super) const STOCK: Choices = with(
    "stock",
    &[word("STOCK", "the blank")],
    &[value("stock", Kind::Entity(&[EntityKind::Stock]), "stock")],
    true,
    "",
);

const DEPTH: Choices = with(
    "depth",
    &[word("DEPTH", "bottom below Z0")],
    &[value("depth", POSITIVE, "length")],
    false,
    "the stock's height",
);

const STEP: Choices = with(
    "step",
    &[word("STEP", "largest axial step")],
    &[value("step", POSITIVE, "length")],
    false,
    "the depth in one pass",
);

const ENTRY: Choices = with(
    "entry",
    &[word("ENTRY", "how the contour is entered and left")],
    &[
        Item::Word(
            "entry",
            &[
                word("TANARC", "quarter circle tangent to the contour"),
                word("TANLIN", "straight and tangent to the contour"),
                word("PLUNGE", "straight down at the contour"),
            ],
        ),
        optional("size", POSITIVE, "radius of the arc, length of the line; chosen without it"),
    ],
    false,
    "TANARC",
);

const PROFIL: &[Form] = &[form(
    "profile",
    "follows a contour",
    &[value("contour", Kind::Contour, "a cam, a curve, or a chain of curves `(A, B, C)`")],
    &[
        choices(
            "interpolation",
            &[
                word("LINEAR", "straight lines"),
                word("CIRCUL", "tangent-continuous arcs"),
                word("RTHETA", "table angle and radius"),
                word("NURBS", "NURBS of the control"),
                word("AUTO", "whatever takes the fewest blocks on the target"),
            ],
            "AUTO",
        ),
        choices(
            "side",
            &[
                word("IN", "inside a closed curve"),
                word("OUT", "outside a closed curve"),
                word("LEFT", "left of a directed curve"),
                word("RIGHT", "right of a directed curve"),
                word("ON", "with the cutter's centre on the curve"),
            ],
            "the cam's own; OUT of a closed curve, ON an open one",
        ),
        CUT,
        DEPTH,
        STEP,
        ENTRY,
        with(
            "dwells",
            &[word("DWELLS", "how dwell circles are made")],
            &[Item::Word("dwells", &[word("EXACT", "spans that are exact arcs stay exact")])],
            false,
            "fitted with the rest",
        ),
        choices(
            "flank",
            &[word("INNER", "inner flank of a groove cam"), word("OUTER", "outer flank of a groove cam")],
            "both, the inner one first",
        ),
    ],
)];

const ROUGH: &[Form] = &[CAM, super::roughing::OFFSET, super::roughing::LEVELS];

const CAM: Form = form(
    "cam",
    "plate cam from round stock",
    &[value("cam", Kind::Entity(&[EntityKind::Cam]), "the cam")],
    &[
        STOCK,
        with(
            "step",
            &[word("STEP", "largest axial step, and largest radial step unless WIDTH gives that")],
            &[value("step", POSITIVE, "length")],
            true,
            "",
        ),
        with(
            "width",
            &[word("WIDTH", "largest radial step")],
            &[value("width", POSITIVE, "length")],
            false,
            "as STEP",
        ),
        with(
            "leave",
            &[word("LEAVE", "stock left on the contour")],
            &[value("leave", NOT_NEGATIVE, "length")],
            false,
            "0",
        ),
        DEPTH,
        CUT,
    ],
);

const fn operation(
    word: &'static str,
    help: &'static str,
    example: &'static str,
    forms: &'static [Form],
) -> Statement {
    Statement {
        word,
        aliases: &[],
        group: Group::Operations,
        usage: Usage::Operation,
        help,
        example,
        forms,
        members: &[],
    }
}

/// Operations.
pub const ROWS: &[Statement] = &[
    operation(
        "PROFIL",
        "follows a cam's profile, a curve or a chain of curves",
        "OP1 = PROFIL/ C1, CIRCUL, CLIMB, DEPTH, 10",
        PROFIL,
    ),
    operation(
        "ROUGH",
        "clears stock down to a plate cam or a net",
        "ROUGH/ C1, STOCK, B1, STEP, 2, LEAVE, 0.3",
        ROUGH,
    ),
];
