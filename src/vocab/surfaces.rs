//! Surfaces and their finishing.

use super::{
    Choices, EntityKind, Form, Group, Item, Kind, Member, NOT_NEGATIVE, POSITIVE, Range, Statement, Usage,
    choices, form, member, slot, value, with, word,
};
use crate::units::Dim;

/// Rows or columns of a net.
const SIZE: Kind = Kind::Count(2, 1000);

const WEIGHTS: Choices = with(
    "weights",
    &[word("WEIGHT", "weights of the poles, row by row: a rational surface")],
    &[Item::Repeat(slot("weight", Kind::Number(Dim::NONE, Range::Positive), "weight"), 4, 100_000)],
    false,
    "all 1",
);

const NET: &[Form] = &[
    form(
        "file",
        "from a CSV file: a heading `x,y,z[,w]`, one pole a line, row by row, rows parted by an empty line",
        &[value("file", Kind::Text, "file name, relative to this file")],
        &[],
    ),
    form(
        "cad",
        "the whole surface of a face of a CAD file, one Bezier patch per span: any degree up to 15, rational or not",
        &[
            Item::Word(
                "format",
                &[
                    word("STEP", "ISO 10303-21: AP203, AP214, AP242"),
                    word("IGES", "IGES in the fixed format: entity 128"),
                ],
            ),
            value("file", Kind::Text, "file name, relative to this file"),
        ],
        &[with(
            "choice",
            &[word(
                "FACE",
                "which face, counted in the order of the file (in a file without faces, its surfaces count)",
            )],
            &[value("face", Kind::Count(1, 1_000_000), "number of the face, from 1")],
            false,
            "the only face that lies on a B-spline surface",
        )],
    ),
    form(
        "moved",
        "another net, moved by a matrix: its poles are transformed, which is exact",
        &[
            value("net", Kind::Entity(&[EntityKind::Net]), "the net"),
            Item::Word("transform", &[word("TRFORM", "transformed by a matrix")]),
            value("matrix", Kind::Entity(&[EntityKind::Matrix]), "matrix"),
        ],
        &[],
    ),
    form(
        "poles",
        "rows, columns and poles, row by row: up to 16 x 16 poles are one patch, (3m+1) x (3n+1) of them m x n \
         bicubic patches",
        &[
            value("rows", SIZE, "rows; u runs from row to row"),
            value("columns", SIZE, "columns; v runs along a row"),
            Item::Repeat(slot("pole", Kind::Point, "pole"), 4, 100_000),
        ],
        &[WEIGHTS],
    ),
];

const NET_MEMBERS: &[Member] = &[
    member("ROWS", "number", "rows of patches"),
    member("COLUMNS", "number", "columns of patches"),
    member("MINRADIUS", "length", "proven smallest concave radius: a ball up to it fits by curvature"),
];

/// Nets.
pub const NETS: &[Statement] = &[Statement {
    word: "NET",
    aliases: &[],
    group: Group::Geometry,
    usage: Usage::Declares(EntityKind::Net),
    help: "a Bezier control net: a surface of one or more patches",
    example: "N1 = NET/ 2, 2, (0, 0, 0), (0, 40, 3), (60, 0, 2), (60, 40, 0)",
    forms: NET,
    members: NET_MEMBERS,
}];

pub(super) const STEP: Choices = with(
    "step",
    &[word("STEP", "largest distance between passes, in place of a height of cusps")],
    &[value("step", POSITIVE, "length")],
    false,
    "from the height of cusps",
);

pub(super) const LEAVE: Choices = with(
    "leave",
    &[word("LEAVE", "stock left on the surface")],
    &[value("leave", NOT_NEGATIVE, "length")],
    false,
    "as THICK says",
);

/// How passes follow each other.
pub(super) const ORDER: Choices = choices(
    "order",
    &[
        word("ZIGZAG", "to and fro, joined along the surface"),
        word("ONEWAY", "all in the same sense, joined above"),
    ],
    "ZIGZAG",
);

/// Along what passes run.
pub(super) const ALONG: Choices = choices(
    "along",
    &[
        word("U", "passes along u, at constant v"),
        word("V", "passes along v, at constant u"),
        word("X", "passes in planes of constant y"),
        word("Y", "passes in planes of constant x"),
        word("ISOCSP", "bent passes that use the height of cusps up nearly everywhere"),
        word("CONST", "bent passes at the same distance on the surface everywhere"),
    ],
    "U",
);

const SURFAC: &[Form] = &[form(
    "net",
    "passes of a cutter over a net",
    &[value("net", Kind::Entity(&[EntityKind::Net]), "the net")],
    &[
        ORDER,
        ALONG,
        choices(
            "interpolation",
            &[
                word("LINEAR", "straight lines"),
                word("CIRCUL", "arcs in the control's XZ and YZ planes, along X and Y"),
                word("NURBS", "curves of the control in space; else arcs, along X and Y"),
            ],
            "LINEAR",
        ),
        with(
            "cusp",
            &[word("CUSP", "largest height of the cusps between passes")],
            &[value("cusp", POSITIVE, "height")],
            false,
            "as CUSP/ says",
        ),
        STEP,
        with(
            "gouge",
            &[word("GOUGE", "what to do where the cutter does not fit")],
            &[Item::Word(
                "gouge",
                &[
                    word("AVOID", "lift the path, so that nothing is gouged"),
                    word("CHECK", "refuse the program"),
                ],
            )],
            false,
            "AVOID",
        ),
        LEAVE,
    ],
)];

/// Operations on nets.
pub const OPERATIONS: &[Statement] = &[Statement {
    word: "SURFAC",
    aliases: &[],
    group: Group::Operations,
    usage: Usage::Operation,
    help: "finishes a surface",
    example: "OP1 = SURFAC/ N1, ZIGZAG, U, CUSP, 0.01",
    forms: SURFAC,
    members: &[],
}];
