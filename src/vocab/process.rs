//! Cutters, stock, machine state, tolerances.

use super::{
    ANGLE, Choice, Choices, EntityKind, Form, Group, Item, Kind, LENGTH, Member, NOT_NEGATIVE, POSITIVE,
    Range, Statement, Usage, choices, form, member, optional, program::SPEED, slot, value, with, word,
};
use crate::units::Dim;

const CUTTER_OPTIONS: &[Choices] = &[
    with(
        "number",
        &[word("NUMBER", "place in the magazine")],
        &[value("number", Kind::Count(0, 99_999_999), "tool number")],
        false,
        "counted from 1",
    ),
    with(
        "flutes",
        &[word("FLUTES", "cutting edges")],
        &[value("flutes", Kind::Count(1, 100), "count")],
        false,
        "",
    ),
    with(
        "helix",
        &[word("HELIX", "helix angle")],
        &[value("helix", Kind::Number(Dim::ANGLE, Range::Between(-90.0, 90.0)), "angle")],
        false,
        "",
    ),
    with(
        "angle",
        &[word("ANGLE", "angle of the side to the axis (TAPER)")],
        &[value("angle", Kind::Number(Dim::ANGLE, Range::Between(0.0, 80.0)), "angle")],
        false,
        "0",
    ),
    with("length", &[word("LENGTH", "gauge length")], &[value("length", POSITIVE, "length")], false, ""),
    with(
        "stick",
        &[word("STICK", "free length out of the holder")],
        &[value("stick", POSITIVE, "length")],
        false,
        "",
    ),
    with(
        "material",
        &[word("MATERL", "material of the cutter")],
        &[value("material", Kind::Name, "name")],
        false,
        "",
    ),
];

const KINDS: &[Choice] = &[
    word("FLAT", "flat end"),
    word("BALL", "spherical end"),
    word("BULL", "corner radius r"),
    word("TAPER", "conical"),
    word("DRILL", "drill, for CYCLE"),
];

const CUTTER: &[Form] = &[
    form(
        "seven",
        "APT's seven parameters",
        &[
            value("d", POSITIVE, "diameter"),
            optional("r", NOT_NEGATIVE, "corner radius; 0 without it"),
            optional("e", LENGTH, "radial distance of the corner circle's centre; d/2 - r without it"),
            optional("f", LENGTH, "axial distance of the corner circle's centre; r without it"),
            optional("a", ANGLE, "angle of the bottom to the radius"),
            optional("b", ANGLE, "angle of the side to the axis"),
            optional("h", POSITIVE, "height"),
        ],
        CUTTER_OPTIONS,
    ),
    form(
        "kind",
        "by kind",
        &[
            Item::Word("kind", KINDS),
            value("d", POSITIVE, "diameter"),
            optional("r", NOT_NEGATIVE, "corner radius (BULL, TAPER)"),
        ],
        CUTTER_OPTIONS,
    ),
];

const CUTTER_MEMBERS: &[Member] = &[
    Member { aliases: &["DIA", "D"], ..member("DIAMETER", "length", "diameter") },
    Member { aliases: &["R"], ..member("RADIUS", "length", "half the diameter") },
    member("CORNER", "length", "corner radius"),
    member("NUMBER", "number", "tool number"),
    member("FLUTES", "number", "cutting edges"),
    member("LENGTH", "length", "gauge length"),
];

const STOCK: &[Form] = &[
    form(
        "round",
        "cylinder about the origin, its top at Z0",
        &[Item::Word("shape", &[word("ROUND", "cylinder")]), value("radius", POSITIVE, "radius")],
        &[with(
            "height",
            &[word("HEIGHT", "height below Z0")],
            &[value("height", POSITIVE, "length")],
            false,
            "unknown",
        )],
    ),
    form(
        "block",
        "box between two opposite corners",
        &[
            Item::Word("shape", &[word("BLOCK", "box")]),
            value("corner", Kind::Point, "one corner"),
            value("opposite", Kind::Point, "the opposite corner"),
        ],
        &[],
    ),
    form(
        "stl",
        "any shape; a later version reads it",
        &[
            Item::Word("shape", &[word("STL", "triangles from a file")]),
            value("file", Kind::Text, "path, relative to this file"),
        ],
        &[],
    ),
];

const STOCK_MEMBERS: &[Member] = &[
    member("RADIUS", "length", "radius of a round"),
    member("DIAMETER", "length", "diameter of a round"),
    member("HEIGHT", "length", "height"),
];

const LOADTL: &[Form] = &[
    form("tool", "a named cutter", &[value("tool", Kind::Entity(&[EntityKind::Cutter]), "cutter")], &[]),
    form(
        "number",
        "a cutter by its tool number",
        &[value("number", Kind::Count(0, 99_999_999), "tool number")],
        &[],
    ),
];

const SENSE: Choices =
    choices("sense", &[word("CLW", "clockwise, M3"), word("CCLW", "counter-clockwise, M4")], "CLW");

const SPINDL: &[Form] = &[
    form(
        "speed",
        "starts the spindle",
        &[value("speed", SPEED, "revolutions per minute")],
        &[SENSE, choices("unit", &[word("RPM", "revolutions per minute")], "RPM")],
    ),
    form(
        "rpm",
        "starts the spindle",
        &[Item::Word("unit", &[word("RPM", "revolutions per minute")]), value("speed", SPEED, "speed")],
        &[SENSE],
    ),
    form(
        "state",
        "stops it, or starts it again as before",
        &[Item::Word("state", &[word("OFF", "stop"), word("ON", "as before")])],
        &[],
    ),
];

const FEED_UNITS: &[Choice] = &[
    word("MMPM", "mm per minute"),
    word("IPM", "inches per minute"),
    word("PERREV", "per revolution, in the program's unit"),
    word("MMPR", "mm per revolution"),
    word("IPR", "inches per revolution"),
    word("PERTOO", "per tooth, in the program's unit"),
    word("PERMIN", "per minute, in the program's unit"),
];

const FEDRAT: &[Form] = &[
    form(
        "feed",
        "feed of what follows",
        &[value("feed", Kind::Feed, "feed")],
        &[choices("unit", FEED_UNITS, "PERMIN")],
    ),
    form(
        "unit",
        "feed of what follows",
        &[Item::Word("unit", FEED_UNITS), value("feed", Kind::Feed, "feed")],
        &[],
    ),
];

const COOLNT: &[Form] = &[form(
    "coolant",
    "coolant of what follows",
    &[Item::Word(
        "state",
        &[
            word("FLOOD", "flood, M8"),
            word("MIST", "mist, M7"),
            word("THRU", "through the tool, where the post has a word for it"),
            word("OFF", "off, M9"),
            word("ON", "as before, or flood"),
        ],
    )],
    &[],
)];

const PLANE: Choices = choices(
    "plane",
    &[word("XYPLAN", "the XY plane"), word("YZPLAN", "the YZ plane"), word("ZXPLAN", "the ZX plane")],
    "XYPLAN",
);

const CUTCOM: &[Form] = &[
    form("off", "switches it off", &[Item::Word("state", &[word("OFF", "none, G40")])], &[]),
    form(
        "on",
        "from the next straight move in X or Y on, or the straight lead of a contour, the control moves the path by what its register holds; it ends on a straight move, too",
        &[
            Item::Word(
                "side",
                &[
                    word("LEFT", "to the left of travel, G41"),
                    word("RIGHT", "to the right of travel, G42"),
                    word("ON", "as before"),
                ],
            ),
            optional(
                "register",
                Kind::Count(0, 99_999_999),
                "the control's register of the radius; the number of the tool where it is not said",
            ),
        ],
        &[PLANE],
    ),
];

/// Wider bands than this, mm, are a mistake of the unit.
const TOLERANCE: Kind = Kind::Number(Dim::LENGTH, Range::Within(0.0, 10.0));

const fn four(help: &'static str) -> Item {
    Item::Repeat(slot("tolerance", TOLERANCE, help), 1, 4)
}

const INTOL: &[Form] =
    &[form("in", "", &[four("part surface[, drive surface, check surfaces]; the last repeats")], &[])];
const OUTTOL: &[Form] =
    &[form("out", "", &[four("part surface[, drive surface, check surfaces]; the last repeats")], &[])];
const TOLER: &[Form] = &[form("both", "", &[four("tolerance; the last repeats")], &[])];
const THICK: &[Form] = &[form(
    "thick",
    "",
    &[Item::Repeat(
        slot("thickness", LENGTH, "part surface[, drive surface, check surfaces]; the last repeats"),
        1,
        4,
    )],
    &[],
)];
const CUSP: &[Form] = &[form("height", "", &[value("height", POSITIVE, "height")], &[])];
const CLEARP: &[Form] = &[
    form("height", "", &[value("height", POSITIVE, "height above Z0")], &[]),
    form(
        "plane",
        "",
        &[
            Item::Word("plane", &[word("XYPLAN", "parallel to the XY plane")]),
            value("height", POSITIVE, "height above Z0"),
        ],
        &[],
    ),
];
const TRACUT: &[Form] = &[
    form(
        "matrix",
        "from here on, points of motion and nets that are finished are transformed",
        &[value("matrix", Kind::Entity(&[EntityKind::Matrix]), "matrix")],
        &[],
    ),
    form("end", "ends it", &[Item::Word("state", &[word("NOMORE", "no transformation")])], &[]),
];
const CYCLE_KINDS: &[Choice] = &[
    word("DRILL", "to the bottom at feed, back at rapid"),
    word("FACE", "the same with a dwell: spot facing, counterboring"),
    word("DEEP", "by pecks, each backed out to the clearance level"),
    word("BRKCHP", "by pecks, the chip broken by a short retract"),
    word("TAP", "tapping"),
    word("BORE", "in and out at feed"),
    word("REAM", "in and out at feed"),
];

const CYCLE_OPTIONS: &[Choices] = &[
    with(
        "depth",
        &[word("FEDTO", "depth below the point"), word("DEPTH", "depth below the point")],
        &[value("depth", POSITIVE, "length")],
        true,
        "",
    ),
    with(
        "clearance",
        &[word("RAPTO", "clearance above the point"), word("CLEAR", "clearance above the point")],
        &[value("clearance", NOT_NEGATIVE, "length")],
        true,
        "",
    ),
    with(
        "return",
        &[word("RTRCTO", "level above the point after each hole")],
        &[value("return", POSITIVE, "length")],
        false,
        "the clearance",
    ),
    with(
        "peck",
        &[word("STEP", "largest depth of one peck")],
        &[value("peck", POSITIVE, "length")],
        false,
        "",
    ),
    with("feed", FEED_UNITS, &[value("feed", Kind::Feed, "feed into the hole")], false, "that of FEDRAT"),
    with(
        "dwell",
        &[word("DWELL", "dwell at the bottom")],
        &[value("dwell", Kind::Number(Dim::TIME, Range::Within(0.0, 99_999.0)), "seconds")],
        false,
        "none",
    ),
    with("pitch", &[word("PITCH", "pitch of a tap")], &[value("pitch", POSITIVE, "length")], false, ""),
    choices("hand", &[word("LEFT", "left-hand thread")], "right-hand"),
];

const CYCLE: &[Form] = &[
    form("off", "ends the cycle", &[Item::Word("state", &[word("OFF", "no cycle")])], &[]),
    form("cycle", "every GOTO that follows is a hole", &[Item::Word("kind", CYCLE_KINDS)], CYCLE_OPTIONS),
];

const DELAY: &[Form] = &[form(
    "time",
    "",
    &[value("time", Kind::Number(Dim::TIME, Range::Within(0.0, 99_999.0)), "seconds")],
    &[],
)];

const fn row(
    word: &'static str,
    help: &'static str,
    example: &'static str,
    forms: &'static [Form],
) -> Statement {
    Statement {
        word,
        aliases: &[],
        group: Group::Process,
        usage: Usage::Command,
        help,
        example,
        forms,
        members: &[],
    }
}

/// Rows of the table.
pub const ROWS: &[Statement] = &[
    Statement {
        usage: Usage::DeclaresOrActs(EntityKind::Cutter),
        members: CUTTER_MEMBERS,
        ..row(
            "CUTTER",
            "a cutter; without a label it is also loaded",
            "T1 = CUTTER/ FLAT, 16, NUMBER, 1, FLUTES, 4",
            CUTTER,
        )
    },
    Statement {
        usage: Usage::Declares(EntityKind::Stock),
        members: STOCK_MEMBERS,
        ..row("STOCK", "the blank; the top of a round is Z0", "B1 = STOCK/ ROUND, 42, HEIGHT, 12", STOCK)
    },
    row("LOADTL", "changes to a cutter", "LOADTL/ T1", LOADTL),
    row("SPINDL", "spindle speed and sense", "SPINDL/ 1200, CLW", SPINDL),
    row("FEDRAT", "feed", "FEDRAT/ 300, MMPM", FEDRAT),
    row("COOLNT", "coolant", "COOLNT/ FLOOD", COOLNT),
    row("INTOL", "how far the cut may go into the part", "INTOL/ 0.01", INTOL),
    row("OUTTOL", "how much may be left on the part", "OUTTOL/ 0.01", OUTTOL),
    row("TOLER", "sets OUTTOL to the value and INTOL to 0", "TOLER/ 0.01", TOLER),
    row("THICK", "stock to leave on later contours", "THICK/ 0.3", THICK),
    row(
        "TRACUT",
        "transforms the points of FROM, GOTO and GODLTA, and the nets of SURFAC",
        "TRACUT/ M1",
        TRACUT,
    ),
    row("CUSP", "largest height of the cusps between the passes of later finishing", "CUSP/ 0.01", CUSP),
    row("CLEARP", "clearance plane for travel between cuts", "CLEARP/ 5", CLEARP),
    row(
        "CYCLE",
        "drilling cycle: a GOTO after it drills, until CYCLE/ OFF",
        "CYCLE/ DRILL, FEDTO, 12, RAPTO, 2, MMPM, 120",
        CYCLE,
    ),
    row(
        "CUTCOM",
        "cutter compensation by the control: G41 and G42 with D, RL and RR; the path is proven for a radius of 0",
        "CUTCOM/ LEFT",
        CUTCOM,
    ),
    row("DELAY", "dwells", "DELAY/ 2s", DELAY),
    row(
        "STOP",
        "program stop, M0; spindle and coolant are said again before the next move, since many controls stop both",
        "STOP",
        &[],
    ),
    row("OPSTOP", "optional stop, M1; spindle and coolant are said again as after `STOP`", "OPSTOP", &[]),
    row("END", "end of the machine program; the post writes it at the end anyway", "END", &[]),
];
