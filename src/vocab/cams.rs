//! Followers, motions, cams.

use super::{
    Choices, EntityKind, Form, Group, Item, Kind, LENGTH, Member, POSITIVE, Range, Statement, Usage, choices,
    form, member, program::SPEED, value, with, word,
};
use crate::units::Dim;

const TRANSL: Item = Item::Word("movement", &[word("TRANSL", "the follower moves on a straight line")]);
const OSCIL: Item = Item::Word("movement", &[word("OSCIL", "the follower swings about a pivot")]);
const ROLLER: Item = Item::Word("contact", &[word("ROLLER", "roller")]);
const FLAT: Item = Item::Word("contact", &[word("FLAT", "flat face")]);
const ROLLER_RADIUS: Item = value("radius", POSITIVE, "radius of the roller");

const OFFSET: Choices = with(
    "offset",
    &[word(
        "OFFSET",
        "distance of the follower's line from the cam's centre; of an oscillating face from its pivot",
    )],
    &[value("offset", LENGTH, "length; positive raises the pressure angle of the rise")],
    false,
    "0",
);
const ARM: Choices =
    with("arm", &[word("ARM", "pivot to roller centre")], &[value("arm", POSITIVE, "length")], true, "");
const PIVOT: Choices =
    with("pivot", &[word("PIVOT", "cam centre to pivot")], &[value("pivot", POSITIVE, "length")], true, "");
const SIDE: Choices = choices(
    "side",
    &[word("LEFT", "the arm swings to the left"), word("RIGHT", "the arm swings to the right")],
    "RIGHT",
);

const FOLLOW: &[Form] = &[
    form("translating roller", "translating roller", &[TRANSL, ROLLER, ROLLER_RADIUS], &[OFFSET]),
    form("translating flat", "translating flat face", &[TRANSL, FLAT], &[OFFSET]),
    form("oscillating roller", "oscillating roller", &[OSCIL, ROLLER, ROLLER_RADIUS], &[ARM, PIVOT, SIDE]),
    form("oscillating flat", "oscillating flat face", &[OSCIL, FLAT], &[PIVOT, OFFSET, SIDE]),
];

const FOLLOW_MEMBERS: &[Member] = &[
    member("RADIUS", "length", "radius of the roller; 0 of a flat face"),
    member("OFFSET", "length", "offset"),
    member("ARM", "length", "arm of an oscillating roller"),
    member("PIVOT", "length", "centre distance of an oscillating follower"),
];

const LIFT: Kind = Kind::Lift;
const SPAN: Kind = Kind::Number(Dim::ANGLE, Range::Positive);

const VELOCITY: &[Item] = &[value("velocity", Kind::LiftRate(1), "lift per degree")];
const ACCELERATION: &[Item] = &[value("acceleration", Kind::LiftRate(2), "lift per degree squared")];
const JERK: &[Item] = &[value("jerk", Kind::LiftRate(3), "lift per degree cubed")];

const MOTION: &[Form] = &[
    Form {
        name: "segments",
        help: "segments in order; boundary values follow a segment whose law is POLY",
        lead: &[],
        options: &[
            with(
                "dwell",
                &[word("DWELL", "the follower rests")],
                &[value("angle", SPAN, "cam angle")],
                false,
                "",
            ),
            with(
                "rise",
                &[word("RISE", "the follower lifts")],
                &[
                    value("angle", SPAN, "cam angle"),
                    value("lift", LIFT, "lift; an angle for an oscillating follower"),
                    value("law", Kind::Law, "motion law, or POLY"),
                ],
                false,
                "",
            ),
            with(
                "return",
                &[word("RETURN", "the follower sinks")],
                &[
                    value("angle", SPAN, "cam angle"),
                    value("lift", LIFT, "lift; an angle for an oscillating follower"),
                    value("law", Kind::Law, "motion law, or POLY"),
                ],
                false,
                "",
            ),
            with("v0", &[word("V0", "velocity at the start of a POLY segment")], VELOCITY, false, ""),
            with("a0", &[word("A0", "acceleration at its start")], ACCELERATION, false, ""),
            with("j0", &[word("J0", "jerk at its start")], JERK, false, ""),
            with("v1", &[word("V1", "velocity at its end")], VELOCITY, false, ""),
            with("a1", &[word("A1", "acceleration at its end")], ACCELERATION, false, ""),
            with("j1", &[word("J1", "jerk at its end")], JERK, false, ""),
        ],
        ordered: true,
    },
    form(
        "table",
        "lift over cam angle from a CSV file, interpolated with continuous acceleration",
        &[
            Item::Word("table", &[word("TABLE", "discrete data")]),
            value("file", Kind::Text, "CSV file with a heading such as `angle[deg],lift[mm]`"),
        ],
        &[choices(
            "periodic",
            &[word("PERIODIC", "the motion goes on over the seam as between rows")],
            "rest at both ends",
        )],
    ),
];

const MOTION_MEMBERS: &[Member] =
    &[member("LIFT", "length or angle", "largest lift"), member("ANGLE", "angle", "sum of the segments")];

const CAM: &[Form] = &[form(
    "plate",
    "plate cam",
    &[Item::Word("kind", &[word("PLATE", "plate cam")])],
    &[
        with(
            "base",
            &[word("BASE", "smallest radius of the profile")],
            &[value("base", POSITIVE, "length")],
            true,
            "",
        ),
        with(
            "follower",
            &[word("FOLLOW", "the follower")],
            &[value("follower", Kind::Entity(&[EntityKind::Follower]), "follower")],
            true,
            "",
        ),
        with(
            "motion",
            &[word("MOTION", "its motion")],
            &[value("motion", Kind::Entity(&[EntityKind::Motion]), "motion")],
            true,
            "",
        ),
        choices(
            "rotation",
            &[word("CLW", "the cam turns clockwise"), word("CCLW", "counter-clockwise")],
            "CLW",
        ),
        with("speed", &[word("SPEED", "speed of the cam")], &[value("speed", SPEED, "rpm")], false, ""),
        with(
            "maxpa",
            &[word("MAXPA", "largest pressure angle without a warning")],
            &[value("maxpa", Kind::Number(Dim::ANGLE, Range::Between(0.0, 90.0)), "angle")],
            false,
            "30 deg",
        ),
        choices(
            "groove",
            &[word("GROOVE", "both flanks of a groove for the roller")],
            "outside profile only",
        ),
        with(
            "width",
            &[word("WIDTH", "width of the follower's flat face")],
            &[value("width", POSITIVE, "length")],
            false,
            "wide enough",
        ),
    ],
)];

const CAM_MEMBERS: &[Member] = &[
    Member {
        aliases: &["MAXPRESSURE"],
        ..member("MAXPA", "angle", "largest pressure angle, without its sign")
    },
    Member { aliases: &["ATMAXPA"], ..member("MAXPAAT", "angle", "cam angle at which it occurs") },
    member("MINRAD", "length", "smallest radius of curvature of the profile where it is convex"),
    member("MINCONCAVE", "length", "smallest radius of curvature where it is concave"),
    member("LENGTH", "length", "length of the profile"),
    member("FACEWIDTH", "length", "width that a flat face needs"),
    member("AREA", "area", "area inside the profile"),
    member("BASE", "length", "smallest radius of the profile"),
    member("MAXRADIUS", "length", "largest radius of the profile"),
    member("LIFT", "length or angle", "largest lift"),
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
        group: Group::Cams,
        usage: Usage::Declares(kind),
        help,
        example,
        forms,
        members,
    }
}

/// Rows of the table.
pub const ROWS: &[Statement] = &[
    row(
        "FOLLOW",
        EntityKind::Follower,
        "a follower; at cam angle 0 it acts along +X",
        "F1 = FOLLOW/ TRANSL, ROLLER, 8",
        FOLLOW,
        FOLLOW_MEMBERS,
    ),
    row(
        "MOTION",
        EntityKind::Motion,
        "a follower's motion over one turn of the cam; its angles add up to 360 degrees",
        "M1 = MOTION/ DWELL, 30, RISE, 120, 20, MODSIN, DWELL, 60, RETURN, 120, 20, MODSIN, DWELL, 30",
        MOTION,
        MOTION_MEMBERS,
    ),
    row(
        "CAM",
        EntityKind::Cam,
        "a plate cam, its centre at the origin, its top at Z0",
        "C1 = CAM/ PLATE, BASE, 20, FOLLOW, F1, MOTION, M1",
        CAM,
        CAM_MEMBERS,
    ),
];
