//! Roughing of nets: the forms of `ROUGH` that take one.

use super::surfaces::{ALONG, ORDER};
use super::{Choices, EntityKind, Form, Item, Kind, POSITIVE, form, value, with, word};

const NET: Item = value("net", Kind::Entity(&[EntityKind::Net]), "the net");

const STEP: Choices = with(
    "step",
    &[word("STEP", "largest distance between passes, in place of a height of cusps")],
    &[value("step", POSITIVE, "length")],
    false,
    "from the height of cusps",
);

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
    "one pass over a net, with the ball larger by what is left",
    &[
        NET,
        Item::Word("how", &[word("OFFSET", "stock left on the surface")]),
        value("leave", POSITIVE, "length"),
    ],
    &[ORDER, ALONG, CUSP, STEP],
);
