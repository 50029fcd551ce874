//! Points, vectors, lines, circles, curves.

use super::{
    ANGLE, Choice, Choices, EntityKind, Form, Group, Item, Kind, LENGTH, Member, NOT_NEGATIVE, POSITIVE,
    Statement, Usage, choices, form, member, optional, slot, value, word,
};

const LARGER: &[Choice] = &[
    word("XLARGE", "the one with the larger x"),
    word("XSMALL", "the one with the smaller x"),
    word("YLARGE", "the one with the larger y"),
    word("YSMALL", "the one with the smaller y"),
];
const INTOF: Item = Item::Word("intof", &[word("INTOF", "intersection of")]);
const CENTER: Item = Item::Word("center", &[word("CENTER", "centre")]);
const RADIUS: Item = Item::Word("radius", &[word("RADIUS", "radius")]);
const TANTO: Item = Item::Word("tanto", &[word("TANTO", "tangent to")]);
const ATANGL: Item = Item::Word("atangl", &[word("ATANGL", "at an angle to the X axis, counter-clockwise")]);
const PARLEL: Item = Item::Word("parlel", &[word("PARLEL", "parallel to")]);
const PERPTO: Item = Item::Word("perpto", &[word("PERPTO", "perpendicular to")]);
const XYPLAN: Item = Item::Word("plane", &[word("XYPLAN", "in the XY plane")]);
const LINE_ITEM: Item = value("line", Kind::Entity(&[EntityKind::Line]), "line");
const CIRCLE_ITEM: Item = value("circle", Kind::Entity(&[EntityKind::Circle]), "circle");
const POINT_ITEM: Item = value("point", Kind::Point, "point");
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
    form(
        "lines",
        "intersection of two lines",
        &[INTOF, LINE_ITEM, value("second", Kind::Entity(&[EntityKind::Line]), "line")],
        &[],
    ),
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
    form(
        "on circle",
        "point of a circle at an angle to the X axis",
        &[CIRCLE_ITEM, ATANGL, value("angle", ANGLE, "angle")],
        &[],
    ),
    form(
        "rtheta",
        "polar coordinates",
        &[
            Item::Word("polar", &[word("RTHETA", "radius, angle")]),
            XYPLAN,
            value("r", LENGTH, "radius"),
            value("angle", ANGLE, "angle"),
        ],
        &[],
    ),
    form(
        "thetar",
        "polar coordinates",
        &[
            Item::Word("polar", &[word("THETAR", "angle, radius")]),
            XYPLAN,
            value("angle", ANGLE, "angle"),
            value("r", LENGTH, "radius"),
        ],
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
            value("angle", ANGLE, "angle"),
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
    form("points", "through two points", &[POINT_ITEM, value("to", Kind::Point, "point")], &[]),
    form(
        "angle",
        "through a point at an angle to the X axis or to a line",
        &[
            POINT_ITEM,
            ATANGL,
            value("angle", ANGLE, "angle"),
            Item::Optional(slot("line", Kind::Entity(&[EntityKind::Line]), "line the angle counts from")),
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
            value("second", Kind::Entity(&[EntityKind::Circle]), "circle"),
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
        "an axis",
        &[Item::Word("axis", &[word("XAXIS", "the X axis"), word("YAXIS", "the Y axis")])],
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
            value("second", Kind::Entity(&[EntityKind::Line]), "line"),
            RADIUS,
            value("r", POSITIVE, "radius"),
        ],
        &[],
    ),
];

const CONTROL: Item = Item::Repeat(slot("control point", Kind::Point, "control point"), 3, 10_000);
const CHAIN: Choices =
    choices("chain", &[word("CHAIN", "a chain of cubics: 3 m + 1 points")], "one curve of degree points - 1");

const BEZIER: &[Form] = &[form("bezier", "by its control points", &[CONTROL], &[CHAIN])];
const CURVE: &[Form] = &[form(
    "bezier",
    "by its control points",
    &[Item::Word("kind", &[word("BEZIER", "Bezier curve")]), CONTROL],
    &[CHAIN],
)];

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

const fn row(
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
    row(
        "BEZIER",
        EntityKind::Curve,
        "a Bezier curve in the XY plane",
        "B1 = BEZIER/ P1, P2, P3, P4",
        BEZIER,
        &[],
    ),
    row("CURVE", EntityKind::Curve, "a curve", "B1 = CURVE/ BEZIER, P1, P2, P3, P4", CURVE, &[]),
];
