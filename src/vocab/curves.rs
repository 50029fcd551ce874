//! Curves by control points and through points.

use super::geometry::row;
use super::{
    ANGLE, Choices, EntityKind, Form, Item, Kind, LENGTH, Range, Statement, choices, form, slot, value, with,
    word,
};
use crate::units::Dim;

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

const SPLINE: &[Form] = &[form(
    "spline",
    "the C2 cubic spline through points, by chord length; it does not bend at its ends",
    &[Item::Repeat(slot("point", Kind::Point, "point"), 2, 10_000)],
    &[
        choices("periodic", &[word("PERIODIC", "closes smoothly from the last point to the first")], "open"),
        with(
            "angles",
            &[word("ATANGL", "direction at the first and at the last point")],
            &[
                value("first angle", ANGLE, "angle to the X axis"),
                value("last angle", ANGLE, "angle to the X axis"),
            ],
            false,
            "no bend at the ends",
        ),
    ],
)];

const NOZ: Item = Item::Word("ruling", &[word("NOZ", "x and y of every point; the curve stands along Z")]);
const KIND: Item = Item::Word("kind", &[word("SPLINE", "spline through the points")]);
const SLOPE_OF: Item = value(
    "slope",
    Kind::Number(Dim::NONE, Range::Any),
    "dy/dx at the point before it, the first or the last",
);

const TABCYL: &[Form] = &[
    form_in_order(
        "points",
        "through points",
        &[NOZ, KIND, Item::Repeat(slot("point", Kind::Point, "point"), 1, 10_000)],
        &[with(
            "slope",
            &[word("SLOPE", "slope of the curve")],
            &[SLOPE_OF, Item::Repeat(slot("point", Kind::Point, "point"), 0, 10_000)],
            false,
            "no bend at the ends",
        )],
    ),
    form_in_order(
        "coordinates",
        "through points by coordinates",
        &[NOZ, KIND, Item::Repeat(slot("coordinate", LENGTH, "x and y in turn"), 2, 20_000)],
        &[with(
            "slope",
            &[word("SLOPE", "slope of the curve")],
            &[SLOPE_OF, Item::Repeat(slot("coordinate", LENGTH, "x and y in turn"), 0, 20_000)],
            false,
            "no bend at the ends",
        )],
    ),
];

const fn form_in_order(
    name: &'static str,
    help: &'static str,
    lead: &'static [Item],
    options: &'static [Choices],
) -> Form {
    Form { name, help, lead, options, ordered: true }
}

/// Rows of the table.
pub const ROWS: &[Statement] = &[
    row(
        "BEZIER",
        EntityKind::Curve,
        "a Bezier curve in the XY plane",
        "B1 = BEZIER/ P1, P2, P3, P4",
        BEZIER,
        &[],
    ),
    row("CURVE", EntityKind::Curve, "a curve", "B1 = CURVE/ BEZIER, P1, P2, P3, P4", CURVE, &[]),
    row(
        "SPLINE",
        EntityKind::Curve,
        "a curve through points, with continuous curvature",
        "S1 = SPLINE/ P1, P2, P3, P4",
        SPLINE,
        &[],
    ),
    row(
        "TABCYL",
        EntityKind::Curve,
        "APT's curve through points; here with continuous curvature",
        "S1 = TABCYL/ NOZ, SPLINE, P1, P2, P3, P4",
        TABCYL,
        &[],
    ),
];
