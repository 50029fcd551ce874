//! What a block prints, compiled from the dialect's patterns.
//!
//! A pattern is a list of items: names of words and codes, `/` for a new line, `=TEXT` as it is. Which names mean
//! something depends on what the pattern is for ([`Place`]).

/// The numeric words of motion blocks.
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
    K,
    Cx,
    Cy,
    Cz,
    Mx,
    My,
    Mz,
    Radius,
    Sweep,
    Feed,
}

/// Number of [`Slot`]s.
pub const SLOTS: usize = 16;

impl Slot {
    /// All, in the order of their numbers.
    pub const ALL: [Slot; SLOTS] = [
        Slot::X,
        Slot::Y,
        Slot::Z,
        Slot::Rotary,
        Slot::I,
        Slot::J,
        Slot::K,
        Slot::Cx,
        Slot::Cy,
        Slot::Cz,
        Slot::Mx,
        Slot::My,
        Slot::Mz,
        Slot::Radius,
        Slot::Sweep,
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
            Slot::K => "k",
            Slot::Cx => "cx",
            Slot::Cy => "cy",
            Slot::Cz => "cz",
            Slot::Mx => "mx",
            Slot::My => "my",
            Slot::Mz => "mz",
            Slot::Radius => "radius",
            Slot::Sweep => "sweep",
            Slot::Feed => "feed",
        }
    }
}

/// Words that stand in blocks of one kind only.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)] // The variants are the words' names.
pub enum Named {
    Spindle,
    Dwell,
    PathTolerance,
    Order,
    Knot,
    Weight,
    Axis,
}

impl Named {
    const ALL: [Named; 7] = [
        Named::Spindle,
        Named::Dwell,
        Named::PathTolerance,
        Named::Order,
        Named::Knot,
        Named::Weight,
        Named::Axis,
    ];
    /// Name in post files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Named::Spindle => "spindle",
            Named::Dwell => "dwell",
            Named::PathTolerance => "path-tolerance",
            Named::Order => "order",
            Named::Knot => "knot",
            Named::Weight => "weight",
            Named::Axis => "axis",
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
    /// The plane of an arc, when it changes.
    Plane,
    /// The code of a spindle command.
    Code,
    /// The call of a drilling cycle, where it must be said.
    Cycle,
    /// The words of a drilling cycle, with its call.
    CycleWords,
    /// A new line.
    NewLine,
    /// A number of a motion.
    Word(Slot),
    /// A number of another block.
    Named(Named),
    /// Text as it is.
    Text(Box<[u8]>),
}

/// What a pattern is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Place {
    Rapid,
    Line,
    Arc,
    Hole,
    Nurbs,
    Between,
    Spindle,
    Dwell,
    Path,
}

impl Place {
    /// The items that mean something here, besides `/` and `=TEXT`.
    #[must_use]
    pub const fn items(self) -> &'static [&'static str] {
        match self {
            Place::Rapid => &["motion", "x", "y", "z", "rotary", "feed"],
            Place::Line => &["feed-mode", "motion", "x", "y", "z", "rotary", "feed"],
            Place::Arc => &[
                "feed-mode",
                "plane",
                "motion",
                "direction",
                "axis",
                "x",
                "y",
                "z",
                "i",
                "j",
                "k",
                "cx",
                "cy",
                "cz",
                "mx",
                "my",
                "mz",
                "radius",
                "sweep",
                "feed",
            ],
            Place::Hole => &["cycle", "motion", "x", "y", "z", "cycle-words"],
            Place::Nurbs => &["x", "y", "z", "order", "knot", "weight", "feed"],
            Place::Between => &[],
            Place::Spindle => &["spindle", "code"],
            Place::Dwell => &["dwell"],
            Place::Path => &["path-tolerance"],
        }
    }
}

impl Item {
    /// Reads an item of a post file; `None` when it is neither a name nor a text that starts with `=`.
    #[must_use]
    pub fn parse(text: &str) -> Option<Item> {
        match text {
            "motion" => Some(Item::Motion),
            "feed-mode" => Some(Item::FeedMode),
            "direction" => Some(Item::Direction),
            "plane" => Some(Item::Plane),
            "code" => Some(Item::Code),
            "cycle" => Some(Item::Cycle),
            "cycle-words" => Some(Item::CycleWords),
            "/" => Some(Item::NewLine),
            _ => match text.strip_prefix('=') {
                Some(literal) if literal.bytes().all(|b| b.is_ascii_graphic() || b == b' ') => {
                    Some(Item::Text(literal.as_bytes().into()))
                }
                Some(_) => None,
                None => Self::word(text),
            },
        }
    }

    fn word(text: &str) -> Option<Item> {
        let slot = Slot::ALL.into_iter().find(|s| s.name() == text).map(Item::Word);
        slot.or_else(|| Named::ALL.into_iter().find(|n| n.name() == text).map(Item::Named))
    }

    /// Items that were checked when the dialect was loaded.
    #[must_use]
    pub fn all(pattern: &[String]) -> Box<[Item]> {
        pattern.iter().filter_map(|item| Item::parse(item)).collect()
    }

    /// The name of the word that the item prints.
    #[must_use]
    pub const fn word_name(&self) -> Option<&'static str> {
        match self {
            Item::Word(slot) => Some(slot.name()),
            Item::Named(named) => Some(named.name()),
            _ => None,
        }
    }
}
