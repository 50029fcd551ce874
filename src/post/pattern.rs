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
    Register,
}

impl Named {
    const ALL: [Named; 8] = [
        Named::Spindle,
        Named::Dwell,
        Named::PathTolerance,
        Named::Order,
        Named::Knot,
        Named::Weight,
        Named::Axis,
        Named::Register,
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
            Named::Register => "register",
        }
    }
}

/// A number of a cubic piece: a share of each of its four control points, along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Coefficient {
    /// Name in post files.
    pub name: &'static str,
    /// How many times each control point counts.
    pub shares: [i64; 4],
    /// 0 X, 1 Y, 2 Z.
    pub axis: usize,
}

const fn along(names: [&'static str; 3], shares: [i64; 4]) -> [Coefficient; 3] {
    let [x, y, z] = names;
    [
        Coefficient { name: x, shares, axis: 0 },
        Coefficient { name: y, shares, axis: 1 },
        Coefficient { name: z, shares, axis: 2 },
    ]
}

/// All numbers that pieces may be told by: the end, the ways from the ends to the inner control points, the coefficients
/// of a parameter that runs from 0 to 1, and those of one that runs from 1 to 0.
const COEFFICIENTS: [[Coefficient; 3]; 9] = [
    along(["end-x", "end-y", "end-z"], [0, 0, 0, 1]),
    along(["leave-x", "leave-y", "leave-z"], [-1, 1, 0, 0]),
    along(["arrive-x", "arrive-y", "arrive-z"], [0, 0, 1, -1]),
    along(["a1-x", "a1-y", "a1-z"], [-3, 3, 0, 0]),
    along(["a2-x", "a2-y", "a2-z"], [3, -6, 3, 0]),
    along(["a3-x", "a3-y", "a3-z"], [-1, 3, -3, 1]),
    along(["k1-x", "k1-y", "k1-z"], [0, 0, 3, -3]),
    along(["k2-x", "k2-y", "k2-z"], [0, 3, -6, 3]),
    along(["k3-x", "k3-y", "k3-z"], [1, -3, 3, -1]),
];

impl Coefficient {
    /// The one of this name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<Coefficient> {
        COEFFICIENTS.iter().flatten().find(|c| c.name == name).copied()
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
    /// What cutter compensation says in a straight move.
    Compensation,
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
    /// A number of a cubic piece.
    Coefficient(Coefficient),
    /// Text as it is.
    Text(Box<[u8]>),
}

/// Items of a cubic piece.
const PIECE: [&str; 4 + 3 * COEFFICIENTS.len()] = {
    let mut names = ["feed"; 4 + 3 * COEFFICIENTS.len()];
    (names[0], names[1], names[2]) = ("x", "y", "z");
    let mut i = 0;
    while i < 3 * COEFFICIENTS.len() {
        names[4 + i] = COEFFICIENTS[i / 3][i % 3].name;
        i += 1;
    }
    names
};

/// What a pattern is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Place {
    Rapid,
    Line,
    Arc,
    Hole,
    Nurbs,
    Piece,
    Between,
    Spindle,
    Dwell,
    Path,
    Compensation,
}

impl Place {
    /// The items that mean something here, besides `/` and `=TEXT`.
    #[must_use]
    pub const fn items(self) -> &'static [&'static str] {
        match self {
            Place::Rapid => &["motion", "compensation", "x", "y", "z", "rotary", "feed"],
            Place::Line => &["feed-mode", "motion", "compensation", "x", "y", "z", "rotary", "feed"],
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
            Place::Piece => &PIECE,
            Place::Between => &[],
            Place::Spindle => &["spindle", "code"],
            Place::Dwell => &["dwell"],
            Place::Path => &["path-tolerance"],
            Place::Compensation => &["register"],
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
            "compensation" => Some(Item::Compensation),
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
            .or_else(|| Coefficient::by_name(text).map(Item::Coefficient))
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
            Item::Coefficient(coefficient) => Some(coefficient.name),
            _ => None,
        }
    }
}
