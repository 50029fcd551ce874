//! Roughing of nets: the forms of `ROUGH` that take one.

use super::operations::{CUT, STOCK};
use super::surfaces::{ALONG, LEAVE, ORDER, STEP};
use super::{Choices, EntityKind, Form, Item, Kind, POSITIVE, Range, choices, form, value, with, word};
use crate::units::Dim;

const NET: Item = value("net", Kind::Entity(&[EntityKind::Net]), "the net");

const CUSP: Choices = with(
    "cusp",
    &[word("CUSP", "largest height of the cusps between passes, on top of what is left")],
    &[value("cusp", POSITIVE, "height")],
    false,
    "a fifth of what is left",
);

/// `ROUGH/ N1, OFFSET, 0.5`.
pub(super) const OFFSET: Form = form(
    "offset",
    "one pass over a net, with the cutter larger by what is left",
    &[
        NET,
        Item::Word("how", &[word("OFFSET", "stock left on the surface")]),
        value("leave", POSITIVE, "length"),
    ],
    &[ORDER, ALONG, CUSP, STEP],
);

/// `ROUGH/ N1, LEVELS, STOCK, B1, STEP, 3, LEAVE, 0.5`.
pub(super) const LEVELS: Form = form(
    "levels",
    "a net in levels from a blank: waterlines of the surface with what is left on it, cleared by rings",
    &[NET, Item::Word("how", &[word("LEVELS", "planes, each cleared by rings")])],
    &[
        STOCK,
        with(
            "step",
            &[word(
                "STEP",
                "largest depth of a level, and largest distance of passes unless WIDTH gives that",
            )],
            &[value("step", POSITIVE, "length")],
            true,
            "",
        ),
        with(
            "width",
            &[word("WIDTH", "largest distance of passes")],
            &[value("width", POSITIVE, "length")],
            false,
            "as STEP",
        ),
        LEAVE,
        with(
            "ramp",
            &[word("RAMP", "steepest way down into material, 0.5 to 45 degrees")],
            &[value("ramp", Kind::Number(Dim::ANGLE, Range::Within(0.5, 45.0)), "angle")],
            false,
            "3 degrees",
        ),
        choices(
            "order",
            &[
                word("IN", "each level from the outside inwards"),
                word("OUT", "each level from the inside outwards"),
            ],
            "IN where the cutter comes from beside the blank, else OUT",
        ),
        CUT,
    ],
);
