//! What a motion block prints, compiled from the dialect's patterns.

/// The numeric words that patterns can name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
#[allow(missing_docs)] // The variants are the words' names.
pub enum Slot {
    X,
    Y,
    Z,
    Rotary,
    I,
    J,
    Cx,
    Cy,
    Radius,
    Feed,
}

/// Number of [`Slot`]s.
pub const SLOTS: usize = 10;

impl Slot {
    /// All, in the order of their numbers.
    pub const ALL: [Slot; SLOTS] = [
        Slot::X,
        Slot::Y,
        Slot::Z,
        Slot::Rotary,
        Slot::I,
        Slot::J,
        Slot::Cx,
        Slot::Cy,
        Slot::Radius,
        Slot::Feed,
    ];
    /// Name in post files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Slot::X => "x",
            Slot::Y => "y",
            Slot::Z => "z",
            Slot::Rotary => "rotary",
            Slot::I => "i",
            Slot::J => "j",
            Slot::Cx => "cx",
            Slot::Cy => "cy",
            Slot::Radius => "radius",
            Slot::Feed => "feed",
        }
    }
}

/// One item of a pattern.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Item {
    /// The motion code of the kind of motion.
    Motion,
    /// The feed-mode code, when it changes.
    FeedMode,
    /// The direction of an arc.
    Direction,
    /// A new line.
    NewLine,
    /// A number.
    Word(Slot),
    /// Text as it is.
    Text(Box<[u8]>),
}

/// The names of items, for «did you mean».
pub const ITEM_NAMES: &[&str] = &[
    "motion",
    "feed-mode",
    "direction",
    "/",
    "x",
    "y",
    "z",
    "rotary",
    "i",
    "j",
    "cx",
    "cy",
    "radius",
    "feed",
];

impl Item {
    /// Reads an item of a post file; `None` when it is neither a name nor a text that starts with `=`.
    #[must_use]
    pub fn parse(text: &str) -> Option<Item> {
        match text {
            "motion" => Some(Item::Motion),
            "feed-mode" => Some(Item::FeedMode),
            "direction" => Some(Item::Direction),
            "/" => Some(Item::NewLine),
            _ => match text.strip_prefix('=') {
                Some(literal) if literal.bytes().all(|b| b.is_ascii_graphic() || b == b' ') => {
                    Some(Item::Text(literal.as_bytes().into()))
                }
                Some(_) => None,
                None => Slot::ALL.into_iter().find(|s| s.name() == text).map(Item::Word),
            },
        }
    }
}
