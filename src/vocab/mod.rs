//! The vocabulary: one table of every statement, its forms, slots and minor words, its members, and the
//! functions of expressions.
//!
//! The table is data. `sema` matches arguments against it, messages quote it, `docs/reference.md` is printed
//! from it. To add a statement: a row in the file of its group, and the code in `sema` that lowers it.
//!
//! A statement has one or more [`Form`]s. A form is a *lead* (items in fixed order) followed by *options*
//! (minor words in any order, each with its values). An [`Form::ordered`] form keeps the order of its
//! options and lets them repeat, as `MOTION/ RISE, 120, 20, MODSIN, DWELL, 60 …` needs.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::LazyLock;

use crate::units::Dim;

mod cams;
mod curves;
mod functions;
mod geometry;
mod later;
mod operations;
mod process;
mod program;
pub mod reference;
mod roughing;
mod space;
mod surfaces;

pub use functions::{FUNCTIONS, Function, FunctionId};
pub use operations::GOTO_WITH_AXIS;
pub use program::STRUCTURE_WORDS;

/// Groups of the reference.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Group {
    /// Frame of a program.
    Program,
    /// Macros, loops, conditions, arrays.
    Structure,
    /// Points, lines, circles, curves.
    Geometry,
    /// Followers, motions, cams.
    Cams,
    /// Cutters, stock, machine state, tolerances.
    Process,
    /// Point-to-point motion.
    Motion,
    /// Operations.
    Operations,
    /// Known words that this version does not carry out.
    Later,
}

impl Group {
    /// All groups in the order of the reference.
    pub const ALL: [Group; 8] = [
        Group::Program,
        Group::Structure,
        Group::Geometry,
        Group::Cams,
        Group::Process,
        Group::Motion,
        Group::Operations,
        Group::Later,
    ];
    /// Heading.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Group::Program => "Program",
            Group::Structure => "Structure",
            Group::Geometry => "Geometry",
            Group::Cams => "Cams",
            Group::Process => "Tools, stock and process",
            Group::Motion => "Point-to-point motion",
            Group::Operations => "Operations",
            Group::Later => "Words of later versions",
        }
    }
}

/// How a statement is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Usage {
    /// `label = WORD/ …`: makes a named thing of this kind.
    Declares(EntityKind),
    /// As [`Usage::Declares`], and without a label it acts on what follows (APT's `CUTTER/ d`).
    DeclaresOrActs(EntityKind),
    /// `WORD/ …`: acts in program order; takes no label.
    Command,
    /// Acts in program order and may be labelled.
    Operation,
    /// Takes the rest of the line as text.
    Text,
    /// Has its own syntax (`IF`, `DO`, `MACRO` …).
    Structure,
    /// Accepted with a note, does nothing.
    Ignored,
    /// Known, but this version does not carry it out.
    Later,
}

/// Kinds of named things.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum EntityKind {
    /// `POINT`
    Point,
    /// `VECTOR`
    Vector,
    /// `LINE`
    Line,
    /// `CIRCLE`
    Circle,
    /// `BEZIER` and other free curves
    Curve,
    /// `PLANE`
    Plane,
    /// `MATRIX`
    Matrix,
    /// `PATERN`
    Pattern,
    /// `FOLLOW`
    Follower,
    /// `MOTION`
    Motion,
    /// `CAM`
    Cam,
    /// `CUTTER`
    Cutter,
    /// `STOCK`
    Stock,
    /// `NET`
    Net,
    /// A labelled operation
    Operation,
}

impl EntityKind {
    /// With its article, for messages.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            EntityKind::Point => "a point",
            EntityKind::Vector => "a vector",
            EntityKind::Line => "a line",
            EntityKind::Circle => "a circle",
            EntityKind::Curve => "a curve",
            EntityKind::Plane => "a plane",
            EntityKind::Matrix => "a matrix",
            EntityKind::Pattern => "a pattern",
            EntityKind::Follower => "a follower",
            EntityKind::Motion => "a motion",
            EntityKind::Cam => "a cam",
            EntityKind::Cutter => "a cutter",
            EntityKind::Stock => "a stock",
            EntityKind::Net => "a net",
            EntityKind::Operation => "an operation",
        }
    }
    /// The word that makes one.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            EntityKind::Point => "POINT",
            EntityKind::Vector => "VECTOR",
            EntityKind::Line => "LINE",
            EntityKind::Circle => "CIRCLE",
            EntityKind::Curve => "BEZIER",
            EntityKind::Plane => "PLANE",
            EntityKind::Matrix => "MATRIX",
            EntityKind::Pattern => "PATERN",
            EntityKind::Follower => "FOLLOW",
            EntityKind::Motion => "MOTION",
            EntityKind::Cam => "CAM",
            EntityKind::Cutter => "CUTTER",
            EntityKind::Stock => "STOCK",
            EntityKind::Net => "NET",
            EntityKind::Operation => "PROFIL",
        }
    }
}

/// One statement.
#[derive(Debug)]
pub struct Statement {
    /// The major word, upper case.
    pub word: &'static str,
    /// Other spellings.
    pub aliases: &'static [&'static str],
    /// Where the reference lists it.
    pub group: Group,
    /// How it is used.
    pub usage: Usage,
    /// One line.
    pub help: &'static str,
    /// A complete example line (or several).
    pub example: &'static str,
    /// Its forms; empty where it takes no arguments or its own syntax.
    pub forms: &'static [Form],
    /// Members of what it declares.
    pub members: &'static [Member],
}

/// A form of a statement.
#[derive(Debug)]
pub struct Form {
    /// Name for the code that lowers it.
    pub name: &'static str,
    /// One line.
    pub help: &'static str,
    /// Items in fixed order.
    pub lead: &'static [Item],
    /// Minor words after the lead, in any order.
    pub options: &'static [Choices],
    /// Options keep their order and may repeat.
    pub ordered: bool,
}

/// An item of a lead.
#[derive(Debug)]
pub enum Item {
    /// One of these words.
    Word(&'static str, &'static [Choice]),
    /// A value.
    Value(Slot),
    /// A value that may be left out, with all that follow it in the lead.
    Optional(Slot),
    /// At least this many values, at most that many.
    Repeat(Slot, usize, usize),
}

/// A word with its meaning.
#[derive(Debug, Clone, Copy)]
pub struct Choice {
    /// Upper case.
    pub word: &'static str,
    /// One line.
    pub help: &'static str,
}

/// An option: one of several words that exclude one another, followed by values.
#[derive(Debug)]
pub struct Choices {
    /// Name for the code that lowers it.
    pub name: &'static str,
    /// The words; none for a value that needs no word (the text of `PARAM`).
    pub words: &'static [Choice],
    /// The values after the word; only the last may be optional.
    pub values: &'static [Item],
    /// Whether the statement needs it.
    pub required: bool,
    /// What holds without it, for the reference.
    pub default: &'static str,
}

/// A place for a value.
#[derive(Debug)]
pub struct Slot {
    /// Name for messages and for the code that lowers it.
    pub name: &'static str,
    /// What it takes.
    pub kind: Kind,
    /// One line.
    pub help: &'static str,
}

/// What a slot takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// A number of this dimension in this range (base units).
    Number(Dim, Range),
    /// A number of any dimension.
    Any,
    /// A feed: per minute, per revolution, per tooth, or a bare number.
    Feed,
    /// A lift: a length, an angle, or a bare number that the follower decides about.
    Lift,
    /// The n-th derivative of a lift by the cam angle (per degreeⁿ).
    LiftRate(u8),
    /// A whole number from, to.
    Count(u32, u32),
    /// A point: a named one or `(x, y[, z])`.
    Point,
    /// A vector: a named one or `(x, y[, z])`.
    Vector,
    /// A named thing of one of these kinds.
    Entity(&'static [EntityKind]),
    /// A point or vector that was declared as just that; a calculated one is neither.
    Declared(EntityKind),
    /// A point, or a pattern of points.
    PointOrPattern,
    /// A line, circle or curve, a cam, or a chain `(A, B, …)` of curves.
    Contour,
    /// A text in quotes.
    Text,
    /// A motion law.
    Law,
    /// Any word; it is not looked up.
    Name,
    /// `NAME = value`.
    Binding,
}

/// Range of a number, in base units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Range {
    /// Any finite number.
    Any,
    /// > 0
    Positive,
    /// >= 0
    NotNegative,
    /// From, to, both included.
    Within(f64, f64),
    /// Both excluded.
    Between(f64, f64),
}

/// A member of a named thing: `C1.MAXPA`.
#[derive(Debug)]
pub struct Member {
    /// Upper case.
    pub name: &'static str,
    /// Other spellings.
    pub aliases: &'static [&'static str],
    /// Unit or kind, for the reference.
    pub gives: &'static str,
    /// One line.
    pub help: &'static str,
}

// Constructors that keep the rows of the table short.

const fn word(word: &'static str, help: &'static str) -> Choice {
    Choice { word, help }
}
const fn slot(name: &'static str, kind: Kind, help: &'static str) -> Slot {
    Slot { name, kind, help }
}
const fn value(name: &'static str, kind: Kind, help: &'static str) -> Item {
    Item::Value(slot(name, kind, help))
}
const fn optional(name: &'static str, kind: Kind, help: &'static str) -> Item {
    Item::Optional(slot(name, kind, help))
}
const fn form(
    name: &'static str,
    help: &'static str,
    lead: &'static [Item],
    options: &'static [Choices],
) -> Form {
    Form { name, help, lead, options, ordered: false }
}
const fn choices(name: &'static str, words: &'static [Choice], default: &'static str) -> Choices {
    Choices { name, words, values: &[], required: false, default }
}
const fn with(
    name: &'static str,
    words: &'static [Choice],
    values: &'static [Item],
    required: bool,
    default: &'static str,
) -> Choices {
    Choices { name, words, values, required, default }
}
const fn member(name: &'static str, gives: &'static str, help: &'static str) -> Member {
    Member { name, aliases: &[], gives, help }
}

const LENGTH: Kind = Kind::Number(Dim::LENGTH, Range::Any);
const POSITIVE: Kind = Kind::Number(Dim::LENGTH, Range::Positive);
const NOT_NEGATIVE: Kind = Kind::Number(Dim::LENGTH, Range::NotNegative);
const ANGLE: Kind = Kind::Number(Dim::ANGLE, Range::Any);

/// The table, by group.
pub const TABLE: [&[Statement]; 11] = [
    program::ROWS,
    geometry::ROWS,
    curves::ROWS,
    space::ROWS,
    cams::ROWS,
    process::ROWS,
    operations::MOTION,
    operations::ROWS,
    surfaces::NETS,
    surfaces::OPERATIONS,
    later::ROWS,
];

/// All statements.
pub fn statements() -> impl Iterator<Item = &'static Statement> {
    TABLE.into_iter().flatten()
}

struct Index {
    majors: BTreeMap<&'static str, &'static Statement>,
    functions: BTreeMap<&'static str, &'static Function>,
    reserved: BTreeSet<&'static str>,
    words: BTreeSet<&'static str>,
}

static INDEX: LazyLock<Index> = LazyLock::new(|| {
    let mut index = Index {
        majors: BTreeMap::new(),
        functions: BTreeMap::new(),
        reserved: BTreeSet::new(),
        words: BTreeSet::new(),
    };
    for row in statements() {
        for name in core::iter::once(&row.word).chain(row.aliases) {
            index.majors.insert(name, row);
            index.reserved.insert(name);
        }
        index.reserved.extend(row.minor_words().filter(|w| w.len() > CONTEXTUAL));
    }
    for function in FUNCTIONS {
        for name in core::iter::once(&function.name).chain(function.aliases) {
            index.functions.insert(name, function);
            index.reserved.insert(name);
        }
    }
    index.reserved.extend(STRUCTURE_WORDS);
    index.words.extend(&index.reserved);
    index.words.extend(statements().flat_map(Statement::minor_words));
    for free in NOT_RESERVED {
        index.reserved.remove(free);
    }
    index
});

/// Minor words up to this length are words only where their statement expects them: users call their
/// variables `X`, `U`, `CV`.
const CONTEXTUAL: usize = 2;

/// Words that stay free as names although the table has them.
const NOT_RESERVED: [&str; 1] = ["CURVE"];

/// The statement with this major word (or alias), case-blind.
#[must_use]
pub fn find(word: &str) -> Option<&'static Statement> {
    INDEX.majors.get(word.to_ascii_uppercase().as_str()).copied()
}

/// Whether `word` (in any case) starts a statement: `CIRCLE`, `CAM`, `GOTO` … The parser asks this to tell
/// `C = CIRCLE/ 2` from `R = D/2`.
#[must_use]
pub fn is_statement_word(word: &str) -> bool {
    find(word).is_some()
}

/// The function of this name (or alias), case-blind.
#[must_use]
pub fn find_function(name: &str) -> Option<&'static Function> {
    INDEX.functions.get(name.to_ascii_uppercase().as_str()).copied()
}

/// Whether a user may not call anything by this name.
#[must_use]
pub fn is_reserved(word: &str) -> bool {
    INDEX.reserved.contains(word.to_ascii_uppercase().as_str())
}

/// Whether this is a word of the language at some place, reserved or not.
#[must_use]
pub fn is_word(word: &str) -> bool {
    INDEX.words.contains(word.to_ascii_uppercase().as_str())
}

/// Every major word and alias, in alphabetical order.
pub fn major_words() -> impl Iterator<Item = &'static str> {
    INDEX.majors.keys().copied()
}

/// Every function name and alias, in alphabetical order.
pub fn function_names() -> impl Iterator<Item = &'static str> {
    INDEX.functions.keys().copied()
}

impl Statement {
    /// Every minor word of its forms; a word of several forms comes several times.
    pub fn minor_words(&self) -> impl Iterator<Item = &'static str> {
        self.forms.iter().flat_map(Form::minor_words)
    }
    /// Whether `word` (upper case) is one of its minor words.
    #[must_use]
    pub fn has_minor_word(&self, word: &str) -> bool {
        self.minor_words().any(|w| w == word)
    }
    /// The member called `name` (or an alias), case-blind.
    #[must_use]
    pub fn member(&self, name: &str) -> Option<&'static Member> {
        self.members.iter().find(|m| {
            m.name.eq_ignore_ascii_case(name) || m.aliases.iter().any(|a| a.eq_ignore_ascii_case(name))
        })
    }
}

impl Form {
    /// Every minor word of the form.
    pub fn minor_words(&self) -> impl Iterator<Item = &'static str> {
        let lead = self.lead.iter().flat_map(Item::words);
        let options = self
            .options
            .iter()
            .flat_map(|o| o.words.iter().map(|c| c.word).chain(o.values.iter().flat_map(Item::words)));
        lead.chain(options)
    }
}

impl Item {
    fn words(&self) -> impl Iterator<Item = &'static str> {
        let choices: &'static [Choice] = match self {
            Item::Word(_, choices) => choices,
            _ => &[],
        };
        choices.iter().map(|c| c.word)
    }
}

#[cfg(test)]
mod tests;
