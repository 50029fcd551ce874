//! Points, vectors, lines, circles.

use super::{
    ANGLE, Choice, EntityKind, Form, Group, Item, Kind, LENGTH, Member, NOT_NEGATIVE, POSITIVE, Range,
    Statement, Usage, form, member, optional, slot, value, word,
};

pub(super) const LARGER: &[Choice] = &[
    word("XLARGE", "the one with the larger x"),
    word("XSMALL", "the one with the smaller x"),
    word("YLARGE", "the one with the larger y"),
    word("YSMALL", "the one with the smaller y"),
];
pub(super) const INTOF: Item = Item::Word("intof", &[word("INTOF", "intersection of")]);
const CENTER: Item = Item::Word("center", &[word("CENTER", "centre")]);
const RADIUS: Item = Item::Word("radius", &[word("RADIUS", "radius")]);
const TANTO: Item = Item::Word("tanto", &[word("TANTO", "tangent to")]);
const ATANGL: Item = Item::Word("atangl", &[word("ATANGL", "at an angle to the X axis, counter-clockwise")]);
pub(super) const PARLEL: Item = Item::Word("parlel", &[word("PARLEL", "parallel to")]);
pub(super) const PERPTO: Item = Item::Word("perpto", &[word("PERPTO", "perpendicular to")]);
pub(super) const CANON: Item = Item::Word("canon", &[word("CANON", "canonical form")]);
const SLOPE: Item = Item::Word("slope", &[word("SLOPE", "slope: rise per run")]);
const INTERC: Item = Item::Word("interc", &[word("INTERC", "intercept on an axis")]);
const AXES: &[Choice] = &[word("XAXIS", "the X axis"), word("YAXIS", "the Y axis")];
const IN_OUT: &[Choice] = &[word("IN", "inside the circle"), word("OUT", "outside the circle")];
const PLANES: &[Choice] = &[
    word("XYPLAN", "in the XY plane, from X"),
    word("YZPLAN", "in the YZ plane, from Y"),
    word("ZXPLAN", "in the ZX plane, from Z"),
];
pub(super) const BARE: Kind = Kind::Number(crate::units::Dim::NONE, Range::Any);
/// An angle that needs no more words.
pub(super) const ANGLE_ITEM: Item = value("angle", ANGLE, "angle");
const PLANE_ITEM: Item = value("plane", Kind::Entity(&[EntityKind::Plane]), "plane");
const SECOND_PLANE: Item = value("second", Kind::Entity(&[EntityKind::Plane]), "plane");
const SECOND_LINE: Item = value("second", Kind::Entity(&[EntityKind::Line]), "line");
const SECOND_CIRCLE: Item = value("second", Kind::Entity(&[EntityKind::Circle]), "circle");
const R_ITEM: Item = value("r", POSITIVE, "radius");
const POLAR: Item = Item::Word("plane", PLANES);
const XYPLAN: Item = Item::Word("plane", &[word("XYPLAN", "in the XY plane")]);
const LINE_ITEM: Item = value("line", Kind::Entity(&[EntityKind::Line]), "line");
pub(super) const CIRCLE_ITEM: Item = value("circle", Kind::Entity(&[EntityKind::Circle]), "circle");
pub(super) const POINT_ITEM: Item = value("point", Kind::Point, "point");
const SIDES: &[Choice] =
    &[word("LEFT", "on the left, seen along the line's direction"), word("RIGHT", "on the right")];
const LINE_OR_CIRCLE: Kind = Kind::Entity(&[EntityKind::Line, EntityKind::Circle]);

const POINT: &[Form] = &[
    form(
        "coordinates",
        "coordinates",
        &[value("x", LENGTH, "x"), value("y", LENGTH, "y"), optional("z", LENGTH, "z; 0 without it")],
        &[],
    ),
    form("point", "a point value such as `P1 + V1`", &[POINT_ITEM], &[]),
    form("lines", "intersection of two lines", &[INTOF, LINE_ITEM, SECOND_LINE], &[]),
    form(
        "circles",
        "intersection with a circle",
        &[
            Item::Word("which", LARGER),
            INTOF,
            value("first", LINE_OR_CIRCLE, "line or circle"),
            value("second", LINE_OR_CIRCLE, "line or circle"),
        ],
        &[],
    ),
    form("center", "centre of a circle", &[CENTER, CIRCLE_ITEM], &[]),
    form("on circle", "point of a circle at an angle to the X axis", &[CIRCLE_ITEM, ATANGL, ANGLE_ITEM], &[]),
    form(
        "rtheta",
        "polar coordinates",
        &[
            Item::Word("polar", &[word("RTHETA", "radius, angle")]),
            POLAR,
            value("r", LENGTH, "radius"),
            ANGLE_ITEM,
        ],
        &[],
    ),
    form(
        "thetar",
        "polar coordinates",
        &[
            Item::Word("polar", &[word("THETAR", "angle, radius")]),
            POLAR,
            ANGLE_ITEM,
            value("r", LENGTH, "radius"),
        ],
        &[],
    ),
    form(
        "planes",
        "intersection of three planes",
        &[INTOF, PLANE_ITEM, SECOND_PLANE, value("third", Kind::Entity(&[EntityKind::Plane]), "plane")],
        &[],
    ),
    form(
        "of pattern",
        "a point of a pattern, counted from 1",
        &[
            value("pattern", Kind::Entity(&[EntityKind::Pattern]), "pattern"),
            value("which", Kind::Count(1, 1_000_000), "which point"),
        ],
        &[],
    ),
    form(
        "canonical",
        "by its coordinates",
        &[CANON, value("x", LENGTH, "x"), value("y", LENGTH, "y"), value("z", LENGTH, "z")],
        &[],
    ),
];

const VECTOR: &[Form] = &[
    form(
        "components",
        "components; bare numbers give a direction without dimension",
        &[
            value("x", Kind::Any, "x"),
            value("y", Kind::Any, "y"),
            optional("z", Kind::Any, "z; 0 without it"),
        ],
        &[],
    ),
    form("points", "from one point to another", &[POINT_ITEM, value("to", Kind::Point, "point")], &[]),
    form("vector", "a vector value", &[value("vector", Kind::Vector, "vector")], &[]),
    form(
        "unit",
        "length 1 in the direction of a vector",
        &[Item::Word("unit", &[word("UNIT", "length 1")]), value("vector", Kind::Vector, "vector")],
        &[],
    ),
    form(
        "cross",
        "vector product",
        &[
            value("vector", Kind::Vector, "vector"),
            Item::Word("cross", &[word("CROSS", "vector product")]),
            value("second", Kind::Vector, "vector"),
        ],
        &[],
    ),
    form(
        "times",
        "multiple of a vector",
        &[
            value("factor", Kind::Any, "factor"),
            Item::Word("times", &[word("TIMES", "times")]),
            value("vector", Kind::Vector, "vector"),
        ],
        &[],
    ),
    form(
        "polar",
        "length and angle",
        &[
            Item::Word("length", &[word("LENGTH", "length")]),
            value("size", NOT_NEGATIVE, "length"),
            ATANGL,
            ANGLE_ITEM,
            XYPLAN,
        ],
        &[],
    ),
];

const LINE: &[Form] = &[
    form(
        "coordinates",
        "through two points by coordinates",
        &[
            value("x1", LENGTH, "x of the first point"),
            value("y1", LENGTH, "y of the first point"),
            value("x2", LENGTH, "x of the second point"),
            value("y2", LENGTH, "y of the second point"),
        ],
        &[],
    ),
    form(
        "coordinates in space",
        "through two points by coordinates; seen along Z",
        &[
            value("x1", LENGTH, "x of the first point"),
            value("y1", LENGTH, "y of the first point"),
            value("z1", LENGTH, "z of the first point"),
            value("x2", LENGTH, "x of the second point"),
            value("y2", LENGTH, "y of the second point"),
            value("z2", LENGTH, "z of the second point"),
        ],
        &[],
    ),
    form("points", "through two points", &[POINT_ITEM, value("to", Kind::Point, "point")], &[]),
    form(
        "angle",
        "through a point at an angle to the X axis or to a line",
        &[
            POINT_ITEM,
            ATANGL,
            ANGLE_ITEM,
            Item::Optional(slot("line", Kind::Entity(&[EntityKind::Line]), "line the angle counts from")),
        ],
        &[],
    ),
    form(
        "angle to axis",
        "through a point at an angle to an axis",
        &[POINT_ITEM, ATANGL, ANGLE_ITEM, Item::Word("axis", AXES)],
        &[],
    ),
    form(
        "slope",
        "through a point with a slope",
        &[POINT_ITEM, SLOPE, value("slope", BARE, "rise per run")],
        &[],
    ),
    form(
        "angle intercept",
        "at an angle to the X axis, through a point of the Y axis (or of the axis said)",
        &[ATANGL, ANGLE_ITEM, INTERC, value("intercept", LENGTH, "where it meets the axis")],
        &[],
    ),
    form(
        "angle intercept axis",
        "at an angle to the X axis, through a point of the axis said",
        &[
            ATANGL,
            ANGLE_ITEM,
            INTERC,
            Item::Word("axis", AXES),
            value("intercept", LENGTH, "where it meets the axis"),
        ],
        &[],
    ),
    form(
        "slope intercept",
        "with a slope, through a point of the Y axis",
        &[
            SLOPE,
            value("slope", BARE, "rise per run"),
            INTERC,
            value("intercept", LENGTH, "where it meets the axis"),
        ],
        &[],
    ),
    form(
        "slope intercept axis",
        "with a slope, through a point of the axis said",
        &[
            SLOPE,
            value("slope", BARE, "rise per run"),
            INTERC,
            Item::Word("axis", AXES),
            value("intercept", LENGTH, "where it meets the axis"),
        ],
        &[],
    ),
    form(
        "tangent",
        "through a point, tangent to a circle",
        &[POINT_ITEM, Item::Word("side", SIDES), TANTO, CIRCLE_ITEM],
        &[],
    ),
    form(
        "tangents",
        "tangent to two circles",
        &[
            Item::Word("side", SIDES),
            TANTO,
            CIRCLE_ITEM,
            Item::Word("second side", SIDES),
            TANTO,
            SECOND_CIRCLE,
        ],
        &[],
    ),
    form(
        "parallel",
        "parallel to a line at a distance",
        &[PARLEL, LINE_ITEM, Item::Word("which", LARGER), value("distance", NOT_NEGATIVE, "distance")],
        &[],
    ),
    form("parallel through", "through a point, parallel to a line", &[POINT_ITEM, PARLEL, LINE_ITEM], &[]),
    form("perpendicular", "through a point, perpendicular to a line", &[POINT_ITEM, PERPTO, LINE_ITEM], &[]),
    form(
        "axis",
        "an axis, or parallel to it: y (or x) of all its points",
        &[
            Item::Word("axis", AXES),
            optional("distance", LENGTH, "y of a line along X, x of a line along Y; 0 without it"),
        ],
        &[],
    ),
    form("planes", "intersection of two planes, seen along Z", &[INTOF, PLANE_ITEM, SECOND_PLANE], &[]),
    form(
        "canonical",
        "a x + b y + c z = d, with c = 0; the line runs with (a, b) on its right",
        &[
            CANON,
            value("a", BARE, "a"),
            value("b", BARE, "b"),
            value("c", BARE, "c"),
            value("d", LENGTH, "d"),
        ],
        &[],
    ),
];

const CIRCLE: &[Form] = &[
    form(
        "coordinates",
        "centre and radius",
        &[
            value("x", LENGTH, "x of the centre"),
            value("y", LENGTH, "y of the centre"),
            value("r", POSITIVE, "radius"),
        ],
        &[],
    ),
    form(
        "coordinates in space",
        "centre and radius",
        &[
            value("x", LENGTH, "x of the centre"),
            value("y", LENGTH, "y of the centre"),
            value("z", LENGTH, "z of the centre"),
            value("r", POSITIVE, "radius"),
        ],
        &[],
    ),
    form(
        "three points",
        "through three points",
        &[POINT_ITEM, value("second", Kind::Point, "point"), value("third", Kind::Point, "point")],
        &[],
    ),
    form(
        "center radius",
        "centre and radius",
        &[CENTER, POINT_ITEM, RADIUS, value("r", POSITIVE, "radius")],
        &[],
    ),
    form("center line", "centre, tangent to a line", &[CENTER, POINT_ITEM, TANTO, LINE_ITEM], &[]),
    form(
        "center circle",
        "centre, tangent to a circle",
        &[
            CENTER,
            POINT_ITEM,
            Item::Word("size", &[word("LARGE", "the larger one"), word("SMALL", "the smaller one")]),
            TANTO,
            CIRCLE_ITEM,
        ],
        &[],
    ),
    form(
        "center point",
        "centre and a point of the circle",
        &[CENTER, POINT_ITEM, value("through", Kind::Point, "point")],
        &[],
    ),
    form(
        "two lines",
        "tangent to two lines",
        &[
            Item::Word("which", LARGER),
            LINE_ITEM,
            Item::Word("second which", LARGER),
            SECOND_LINE,
            RADIUS,
            value("r", POSITIVE, "radius"),
        ],
        &[],
    ),
    form(
        "three lines",
        "tangent to three lines",
        &[
            Item::Word("which", LARGER),
            LINE_ITEM,
            Item::Word("second which", LARGER),
            SECOND_LINE,
            Item::Word("third which", LARGER),
            value("third", Kind::Entity(&[EntityKind::Line]), "line"),
        ],
        &[],
    ),
    form(
        "line and point",
        "tangent to a line, through a point; of the two, the one with this centre",
        &[TANTO, LINE_ITEM, Item::Word("which", LARGER), POINT_ITEM, RADIUS, R_ITEM],
        &[],
    ),
    form(
        "line and circle",
        "tangent to a line (on the side said) and a circle; of the two, the one with this centre",
        &[
            Item::Word("which", LARGER),
            LINE_ITEM,
            Item::Word("second which", LARGER),
            Item::Word("touch", IN_OUT),
            CIRCLE_ITEM,
            RADIUS,
            R_ITEM,
        ],
        &[],
    ),
    form(
        "two circles",
        "tangent to two circles; of the two, the one with this centre",
        &[
            Item::Word("which", LARGER),
            Item::Word("touch", IN_OUT),
            CIRCLE_ITEM,
            Item::Word("second touch", IN_OUT),
            SECOND_CIRCLE,
            RADIUS,
            R_ITEM,
        ],
        &[],
    ),
    form(
        "two points",
        "through two points; of the two, the one with this centre",
        &[Item::Word("which", LARGER), POINT_ITEM, value("second", Kind::Point, "point"), RADIUS, R_ITEM],
        &[],
    ),
    form(
        "canonical",
        "centre, axis (along Z), radius",
        &[
            CANON,
            value("x", LENGTH, "x of the centre"),
            value("y", LENGTH, "y of the centre"),
            value("z", LENGTH, "z of the centre"),
            value("i", BARE, "x of the axis"),
            value("j", BARE, "y of the axis"),
            value("k", BARE, "z of the axis"),
            R_ITEM,
        ],
        &[],
    ),
];

const POINT_MEMBERS: &[Member] =
    &[member("X", "length", "x"), member("Y", "length", "y"), member("Z", "length", "z")];
const LINE_MEMBERS: &[Member] = &[
    member("ANGLE", "angle", "angle to the X axis"),
    member("LENGTH", "length", "distance of the two points it was made from"),
];
const CIRCLE_MEMBERS: &[Member] = &[
    member("RADIUS", "length", "radius"),
    member("DIAMETER", "length", "diameter"),
    member("CENTER", "point", "centre"),
    member("X", "length", "x of the centre"),
    member("Y", "length", "y of the centre"),
    member("Z", "length", "z of the centre"),
    member("LENGTH", "length", "circumference"),
];

pub(super) const fn row(
    word: &'static str,
    kind: EntityKind,
    help: &'static str,
    example: &'static str,
    forms: &'static [Form],
    members: &'static [Member],
) -> Statement {
    Statement {
        word,
        aliases: &[],
        group: Group::Geometry,
        usage: Usage::Declares(kind),
        help,
        example,
        forms,
        members,
    }
}

/// Rows of the table.
pub const ROWS: &[Statement] = &[
    row("POINT", EntityKind::Point, "a point", "P1 = POINT/ 10, 20", POINT, POINT_MEMBERS),
    row("VECTOR", EntityKind::Vector, "a vector", "V1 = VECTOR/ 1, 0, 0", VECTOR, POINT_MEMBERS),
    row("LINE", EntityKind::Line, "a line, directed", "L1 = LINE/ P1, P2", LINE, LINE_MEMBERS),
    row(
        "CIRCLE",
        EntityKind::Circle,
        "a circle",
        "K1 = CIRCLE/ CENTER, P1, RADIUS, 5",
        CIRCLE,
        CIRCLE_MEMBERS,
    ),
];
