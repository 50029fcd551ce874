//! Planes, matrices, patterns of points.

use super::geometry::{ANGLE_ITEM, BARE, CANON, CIRCLE_ITEM, PARLEL, PERPTO, POINT_ITEM, row};
use super::{
    ANGLE, Choice, Choices, EntityKind, Form, Item, Kind, LENGTH, Member, NOT_NEGATIVE, POSITIVE, Range,
    Statement, form, member, optional, slot, value, with, word,
};
use crate::units::Dim;

const PLANE_KIND: Kind = Kind::Entity(&[EntityKind::Plane]);
const MATRIX_KIND: Kind = Kind::Entity(&[EntityKind::Matrix]);
const PATTERN_KIND: Kind = Kind::Entity(&[EntityKind::Pattern]);
const PLANE_ITEM: Item = value("plane", PLANE_KIND, "plane");
/// The side of a plane, seen along an axis.
const SIX: &[Choice] = &[
    word("XLARGE", "the one with the larger x"),
    word("XSMALL", "the one with the smaller x"),
    word("YLARGE", "the one with the larger y"),
    word("YSMALL", "the one with the smaller y"),
    word("ZLARGE", "the one with the larger z"),
    word("ZSMALL", "the one with the smaller z"),
];
const COORDINATE_PLANES: &[Choice] =
    &[word("XYPLAN", "the XY plane"), word("YZPLAN", "the YZ plane"), word("ZXPLAN", "the ZX plane")];

const PLANE: &[Form] = &[
    form(
        "coefficients",
        "a x + b y + c z = d",
        &[value("a", BARE, "a"), value("b", BARE, "b"), value("c", BARE, "c"), value("d", LENGTH, "d")],
        &[],
    ),
    form(
        "canonical",
        "a x + b y + c z = d",
        &[
            CANON,
            value("a", BARE, "a"),
            value("b", BARE, "b"),
            value("c", BARE, "c"),
            value("d", LENGTH, "d"),
        ],
        &[],
    ),
    form(
        "points",
        "through three points",
        &[POINT_ITEM, value("second", Kind::Point, "point"), value("third", Kind::Point, "point")],
        &[],
    ),
    form("parallel through", "through a point, parallel to a plane", &[POINT_ITEM, PARLEL, PLANE_ITEM], &[]),
    form(
        "parallel",
        "parallel to a plane at a distance",
        &[PARLEL, PLANE_ITEM, Item::Word("which", SIX), value("distance", NOT_NEGATIVE, "distance")],
        &[],
    ),
    form(
        "normal",
        "through a point, perpendicular to a vector",
        &[POINT_ITEM, PERPTO, value("vector", Kind::Vector, "vector")],
        &[],
    ),
    form(
        "perpendicular to two",
        "through a point, perpendicular to two planes",
        &[POINT_ITEM, PERPTO, PLANE_ITEM, value("second plane", PLANE_KIND, "plane")],
        &[],
    ),
    form(
        "perpendicular through two",
        "through two points, perpendicular to a plane",
        &[POINT_ITEM, value("second", Kind::Point, "point"), PERPTO, PLANE_ITEM],
        &[],
    ),
    form(
        "coordinate plane",
        "parallel to a coordinate plane",
        &[
            Item::Word("base", COORDINATE_PLANES),
            optional("distance", LENGTH, "z, x or y of all its points; 0 without it"),
        ],
        &[],
    ),
];

const PLANE_MEMBERS: &[Member] = &[
    member("NORMAL", "vector", "unit normal (a, b, c)"),
    member("DISTANCE", "length", "d: distance from the origin along the normal"),
];

const TURN: &[Item] = &[ANGLE_ITEM];

const fn turn(word: &'static [Choice]) -> Choices {
    with("rotation", word, TURN, false, "")
}

const MATRIX: &[Form] = &[
    Form {
        name: "steps",
        help: "shifts, turns, scales and mirrors, the first written carried out first",
        lead: &[],
        options: &[
            with(
                "shift",
                &[word("TRANSL", "shift by x, y[, z]")],
                &[
                    value("x", LENGTH, "in x"),
                    value("y", LENGTH, "in y"),
                    optional("z", LENGTH, "in z; 0 without it"),
                ],
                false,
                "",
            ),
            turn(&[word("XYROT", "turn about Z, from X to Y")]),
            turn(&[word("YZROT", "turn about X, from Y to Z")]),
            turn(&[word("ZXROT", "turn about Y, from Z to X")]),
            with(
                "scale",
                &[word("SCALE", "scale about the origin")],
                &[value("factor", Kind::Number(Dim::NONE, Range::Positive), "factor")],
                false,
                "",
            ),
            with(
                "mirror",
                &[word("MIRROR", "mirror at a plane")],
                &[Item::Word("mirror plane", COORDINATE_PLANES)],
                false,
                "",
            ),
        ],
        ordered: true,
    },
    form(
        "mirror",
        "mirror at a plane",
        &[Item::Word("mirror", &[word("MIRROR", "mirror at a plane")]), PLANE_ITEM],
        &[],
    ),
    form(
        "inverse",
        "the inverse of a matrix",
        &[Item::Word("inverse", &[word("INVERS", "the inverse")]), value("matrix", MATRIX_KIND, "matrix")],
        &[],
    ),
    form(
        "product",
        "the product of two matrices: the second acts first",
        &[value("matrix", MATRIX_KIND, "matrix"), value("second", MATRIX_KIND, "matrix")],
        &[],
    ),
    form(
        "frame",
        "from a frame: its origin, its X axis, and a vector on its Y side",
        &[
            POINT_ITEM,
            value("x axis", Kind::Vector, "X axis of the frame"),
            value("y side", Kind::Vector, "vector on the Y side"),
        ],
        &[],
    ),
    form(
        "elements",
        "twelve elements, row by row; the fourth of a row is a length",
        &[Item::Repeat(slot("element", Kind::Any, "element"), 12, 12)],
        &[],
    ),
];

const LINEAR: Item = Item::Word("kind", &[word("LINEAR", "on a line")]);
const ARC: Item = Item::Word("kind", &[word("ARC", "on a circle")]);
const ROWS_OF: Item = Item::Word("kind", &[word("PARLEL", "rows parallel to a pattern, to and fro")]);
const BASE: Item = value("pattern", PATTERN_KIND, "pattern");
const VECTOR: Item = value(
    "vector",
    Kind::Declared(EntityKind::Vector),
    "vector: the distance of two neighbours, or the direction",
);
const COUNT: Item = value("count", Kind::Count(2, 100_000), "number of points");
const START: Item = value("start", ANGLE, "angle of the first point");
const SENSE: Item = Item::Word("sense", &[word("CLW", "clockwise"), word("CCLW", "counter-clockwise")]);
const STEP_LENGTHS: [Choices; 2] = [
    with(
        "incr",
        &[word("INCR", "distances from point to point, or their number before AT")],
        &[Item::Repeat(slot("increment", Kind::Any, "distance, or number before AT"), 1, 10_000)],
        true,
        "",
    ),
    with("at", &[word("AT", "the distance of all those")], &[value("each", POSITIVE, "distance")], false, ""),
];
const STEP_ANGLES: [Choices; 2] = [
    with(
        "incr",
        &[word("INCR", "angles from point to point, or their number before AT")],
        &[Item::Repeat(slot("increment", Kind::Any, "angle, or number before AT"), 1, 10_000)],
        true,
        "",
    ),
    with(
        "at",
        &[word("AT", "the angle of all those")],
        &[value("each", Kind::Number(Dim::ANGLE, Range::Positive), "angle")],
        false,
        "",
    ),
];

const fn steps(
    name: &'static str,
    help: &'static str,
    lead: &'static [Item],
    options: &'static [Choices],
) -> Form {
    Form { name, help, lead, options, ordered: true }
}

const PATERN: &[Form] = &[
    form(
        "from to",
        "equally spaced from one point to another",
        &[LINEAR, POINT_ITEM, value("end", Kind::Declared(EntityKind::Point), "the last point"), COUNT],
        &[],
    ),
    form("vector", "equally spaced by a vector", &[LINEAR, POINT_ITEM, VECTOR, COUNT], &[]),
    steps("linear", "at given distances along a vector", &[LINEAR, POINT_ITEM, VECTOR], &STEP_LENGTHS),
    form(
        "arc",
        "equally spaced on a circle, both ends included",
        &[ARC, CIRCLE_ITEM, START, value("end angle", ANGLE, "angle of the last point"), SENSE, COUNT],
        &[],
    ),
    steps("arc steps", "at given angles on a circle", &[ARC, CIRCLE_ITEM, START, SENSE], &STEP_ANGLES),
    form(
        "rows",
        "equally spaced rows",
        &[ROWS_OF, BASE, VECTOR, value("count", Kind::Count(1, 100_000), "number of rows")],
        &[],
    ),
    steps("row steps", "rows at given distances along a vector", &[ROWS_OF, BASE, VECTOR], &STEP_LENGTHS),
    form(
        "rows on pattern",
        "one row for every point of a second pattern",
        &[ROWS_OF, BASE, value("second", PATTERN_KIND, "pattern")],
        &[],
    ),
    form(
        "random",
        "points and patterns in any order",
        &[
            Item::Word("kind", &[word("RANDOM", "any points")]),
            Item::Repeat(slot("part", Kind::PointOrPattern, "point or pattern"), 1, 10_000),
        ],
        &[],
    ),
];

const PATTERN_MEMBERS: &[Member] = &[member("COUNT", "number", "number of points")];

/// Rows of the table.
pub const ROWS: &[Statement] = &[
    row("PLANE", EntityKind::Plane, "a plane", "PL1 = PLANE/ 0, 0, 1, 5", PLANE, PLANE_MEMBERS),
    row(
        "MATRIX",
        EntityKind::Matrix,
        "a transformation",
        "M1 = MATRIX/ XYROT, 90, TRANSL, 10, 0, 0",
        MATRIX,
        &[],
    ),
    row(
        "PATERN",
        EntityKind::Pattern,
        "a pattern of points",
        "PA1 = PATERN/ LINEAR, (0, 0), (40, 0), 5",
        PATERN,
        PATTERN_MEMBERS,
    ),
];
