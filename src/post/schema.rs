//! The keys of a post file: one table that checking, «did you mean», the published JSON Schema and the
//! documentation read.

/// What a key holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// Text.
    Text,
    /// `true` or `false`.
    Flag,
    /// `true` or `false`, or one each for mm and inch.
    FlagByUnit,
    /// An integer in a range.
    Integer(i64, i64),
    /// A number in a range.
    Number(f64, f64),
    /// An integer, or one each for mm and inch: `{ mm = 3, inch = 4 }`.
    IntegerByUnit(i64, i64),
    /// A number, or one each for mm and inch.
    NumberByUnit(f64, f64),
    /// A text, or one each for mm and inch.
    TextByUnit,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// A list of these words.
    Choices(&'static [&'static str]),
    /// A list of texts.
    TextList,
    /// A list of lists of texts.
    TextLists,
    /// Two numbers, the first smaller.
    Range,
    /// A table of these keys.
    Table(&'static [Key]),
    /// A table of freely named tables of these keys.
    Tables(&'static [Key]),
    /// A table of freely named texts.
    Texts,
    /// A table of freely named lists of texts.
    TextListTable,
}

/// One key.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Key {
    /// Its name.
    pub name: &'static str,
    /// What it holds.
    pub shape: Shape,
    /// What it means.
    pub doc: &'static str,
}

const fn key(name: &'static str, shape: Shape, doc: &'static str) -> Key {
    Key { name, shape, doc }
}

/// The keys at the top of a post file.
pub const ROOT: &[Key] = &[
    key(
        "inherits",
        Shape::Text,
        "built-in post, or post file relative to this one, whose keys hold where this file is silent",
    ),
    key("post", Shape::Table(POST), "who it is"),
    key("file", Shape::Table(FILE), "the file as a whole"),
    key("line", Shape::Table(LINE), "the line as a whole"),
    key("numbering", Shape::Table(NUMBERING), "block numbers"),
    key("numbers", Shape::Table(NUMBERS), "spelling of numbers with decimals, unless a word says otherwise"),
    key("words", Shape::Tables(WORD), "the words, by the names that patterns use"),
    key("modal", Shape::Table(MODAL), "what is left out when it has not changed"),
    key("codes", Shape::Table(CODES), "motion and feed-mode codes"),
    key("patterns", Shape::Table(PATTERNS), "what a motion block prints, in order"),
    key("groups", Shape::Tables(GROUP), "modal groups of the control, by name"),
    key(
        "safe-start",
        Shape::TextLists,
        "groups whose start codes the variable `safe_start` prints, line by line",
    ),
    key("arcs", Shape::Table(ARCS), "circular interpolation"),
    key("feed", Shape::Table(FEED), "feeds"),
    key("rotary", Shape::Table(ROTARY), "rotary table"),
    key("dwell", Shape::Table(DWELL), "dwell in a block of its own"),
    key("cycle-dwell", Shape::Table(CYCLE_DWELL), "dwell inside drilling cycles"),
    key(
        "cycles",
        Shape::Tables(CYCLE),
        "drilling cycles that the control keeps, by kind; others become moves",
    ),
    key("spindle", Shape::Table(SPINDLE), "spindle"),
    key("coolant", Shape::Table(COOLANT), "coolant"),
    key("compensation", Shape::Table(COMPENSATION), "cutter compensation of the control"),
    key("stops", Shape::Table(STOPS), "program stops"),
    key("comments", Shape::Table(COMMENTS), "comments"),
    key("path-control", Shape::Table(PATH_CONTROL), "how closely the control follows the path"),
    key("nurbs", Shape::Table(NURBS), "NURBS output"),
    key("limits", Shape::Table(LIMITS), "limits of the machine"),
    key("tool-change", Shape::Table(TOOL_CHANGE), "what a tool change prints"),
    key("templates", Shape::Table(TEMPLATES), "start and end of the program"),
    key(
        "options",
        Shape::Texts,
        "values that templates read as `options.NAME`; `--post-set` and MACHIN options override them",
    ),
    key(
        "option-values",
        Shape::TextListTable,
        "by the name of an option, the values that it may have: texts, `<integer>`, or `<z>` for numbers as the word `z` has them",
    ),
];

const POST: &[Key] = &[
    key("title", Shape::Text, "control and series, for people"),
    key("extension", Shape::Text, "of the NC file, without the point"),
    key("control", Shape::Text, "the control that reads the program back for the proof"),
    key(
        "control-when",
        Shape::Texts,
        "other controls for values of options: `{ \"DWELL=ms\" = \"mach3-ms\" }`",
    ),
    key(
        "confidence",
        Shape::Choice(&["interpreter", "manual", "published"]),
        "checked by the control's own interpreter, taken from its manual, or from published posts",
    ),
    key("basis", Shape::Text, "what the facts rest on"),
    key("abstract", Shape::Flag, "only to be inherited from"),
];
const FILE: &[Key] = &[
    key("newline", Shape::Choice(&["lf", "crlf"]), "end of line"),
    key("number", Shape::Integer(0, 99_999_999), "program number where the frame has one"),
    key("name-max", Shape::Integer(1, 256), "longest program name"),
];
const LINE: &[Key] = &[
    key("max-length", Shape::Integer(0, 65_535), "characters in a line, 0 without limit"),
    key("count-comments", Shape::Flag, "comments count for `max-length`"),
    key("count-spaces", Shape::Flag, "spaces count for `max-length`"),
    key("separator", Shape::Text, "between the words of a block"),
    key(
        "continuation",
        Shape::Text,
        "at the end of a line: the block goes on in the next one, which gets no number; empty: there is none",
    ),
    key("end", Shape::Text, "at the end of every line but a lone `%` and those that go on; empty: nothing"),
];
const NUMBERING: &[Key] = &[
    key(
        "mode",
        Shape::Choice(&["none", "blocks", "lines"]),
        "nothing, or blocks but not comments and frame, or every line",
    ),
    key("prefix", Shape::Text, "before the number"),
    key("start", Shape::Integer(0, 99_999_999), "first number"),
    key("step", Shape::Integer(1, 10_000), "distance of numbers"),
    key("max", Shape::Integer(1, 999_999_999), "largest number; numbering starts again after it"),
];
const NUMBERS: &[Key] = &[
    key(
        "linear-decimals",
        Shape::IntegerByUnit(0, 9),
        "decimals of x, y, z, i, j, k, cx, cy, cz and radius, unless the word says otherwise",
    ),
    key("point", Shape::Choice(&["needed", "always", "digit"]), "`5`, `5.` or `5.0`"),
    key("trailing-zeros", Shape::Flag, "`5.250`"),
    key("bare-fraction", Shape::Flag, "`.5`"),
    key("plus", Shape::Flag, "`+5`"),
];
const WORD: &[Key] = &[
    key("prefix", Shape::Text, "what stands before the number: `X`, `CR=`"),
    key("suffix", Shape::TextByUnit, "what stands after it: `)` with the prefix `I=AC(`"),
    key(
        "decimals",
        Shape::IntegerByUnit(0, 9),
        "decimals; without them the word is an integer and never carries a point",
    ),
    key("max", Shape::NumberByUnit(0.0, 1e12), "largest magnitude"),
    key("point", Shape::Choice(&["needed", "always", "digit"]), "as in `numbers`"),
    key("trailing-zeros", Shape::Flag, "as in `numbers`"),
    key("bare-fraction", Shape::Flag, "as in `numbers`"),
    key("plus", Shape::Flag, "as in `numbers`"),
    key("modal", Shape::Flag, "left out when its printed number has not changed"),
    key(
        "exponent-from",
        Shape::Number(0.0, 1e12),
        "from this magnitude on, in words of curves, the number has one digit before the point and an exponent: `1.25E+2`",
    ),
];
const MODAL: &[Key] = &[
    key("motion", Shape::Flag, "motion codes"),
    key("axes", Shape::Flag, "axis words"),
    key("arc-ends", Shape::Flag, "the end words of arcs"),
    key(
        "whole-points",
        Shape::Flag,
        "every move says X, Y and Z, and rapid moves go straight to their point, as in CL data",
    ),
    key("feed", Shape::Flag, "feed"),
];
const CODES: &[Key] = &[
    key("rapid", Shape::Text, "straight at rapid"),
    key("line", Shape::Text, "straight at feed"),
    key("arc-cw", Shape::Text, "clockwise"),
    key("arc-ccw", Shape::Text, "counter-clockwise"),
    key("direction-cw", Shape::Text, "the pattern item `direction` of a clockwise arc"),
    key("direction-ccw", Shape::Text, "the pattern item `direction` of a counter-clockwise arc"),
    key("plane-xy", Shape::Text, "the pattern item `plane` of an arc in the XY plane"),
    key("plane-zx", Shape::Text, "the same in the ZX plane; empty: the control has none"),
    key("plane-yz", Shape::Text, "the same in the YZ plane; empty: the control has none"),
    key("per-minute", Shape::Text, "feed per minute"),
    key("per-revolution", Shape::Text, "feed per revolution"),
    key("inverse-time", Shape::Text, "inverse time feed"),
    key("insert", Shape::Text, "before the text of INSERT"),
];
const PATTERNS: &[Key] = &[
    key(
        "rapid",
        Shape::TextList,
        "straight at rapid: names of words, `motion`, `/` for a new line, `=TEXT` as it is",
    ),
    key("line", Shape::TextList, "straight at feed"),
    key("arc", Shape::TextList, "arc, and helix unless that has its own pattern"),
    key(
        "arc-zx",
        Shape::TextList,
        "arc of the ZX plane, where it is spelled unlike one of the XY plane; there are no helices then",
    ),
    key("arc-yz", Shape::TextList, "the same for the YZ plane"),
    key("helix", Shape::TextList, "helix, where it is spelled unlike an arc"),
    key("hole", Shape::TextList, "a hole of a drilling cycle"),
];
const GROUP: &[Key] = &[
    key("codes", Shape::TextList, "all codes of the group that programs may use"),
    key(
        "start",
        Shape::TextByUnit,
        "the code every program starts with; empty: the control does not have the group",
    ),
    key("option", Shape::Text, "the option whose number, from 1, picks another one of `codes` for the start"),
    key(
        "more",
        Shape::Text,
        "what stands before the number of further codes, which the option counts after `codes`",
    ),
    key("more-from", Shape::Integer(0, 65_535), "number of the first of them"),
    key("more-count", Shape::Integer(0, 65_535), "how many there are"),
];
const ARCS: &[Key] = &[
    key("enabled", Shape::Flag, "the control has circular interpolation"),
    key("planes", Shape::Choices(&["xy", "zx", "yz"]), "planes of arcs; arcs elsewhere become lines"),
    key(
        "zero-offsets",
        Shape::Choice(&["keep", "drop"]),
        "a centre word that is zero is printed, or left out when the other is not zero",
    ),
    key(
        "full-circle",
        Shape::Choice(&["bare", "one-end-word", "end-words", "split"]),
        "end words of a full circle: none, one, both; or no full circles",
    ),
    key("signed-radius", Shape::Flag, "the word `radius` is negative for more than half a turn"),
    key("split", Shape::Integer(2, 16), "arcs a full circle is split in where the control has none"),
    key("max-sweep", Shape::Number(1.0, 360.0), "degrees in one block"),
    key("min-radius", Shape::Number(0.0, 1e6), "mm; smaller arcs become lines"),
    key("max-radius", Shape::Number(0.001, 1e9), "mm; larger arcs become lines"),
    key(
        "radius-tolerance",
        Shape::Number(1e-6, 1.0),
        "largest difference of start and end radius in printed numbers, mm",
    ),
    key("helix", Shape::Flag, "Z may move in an arc block"),
];
const FEED: &[Key] = &[
    key("scale", Shape::NumberByUnit(0.001, 1000.0), "what is printed for one output unit a minute"),
    key(
        "rapid",
        Shape::Number(0.0, 1e6),
        "mm/min of the word `feed` in rapid moves, for a control whose G0 goes at F; 0: it does not",
    ),
    key("per-revolution", Shape::Flag, "the control has feed per revolution"),
    key("inverse-time", Shape::Flag, "the control has inverse time feed"),
];
const ROTARY: &[Key] = &[
    key("enabled", Shape::FlagByUnit, "a rotary axis is possible"),
    key("letter", Shape::Text, "the usual letter"),
    key("letters", Shape::Text, "the letters that are possible"),
    key(
        "feed",
        Shape::Choice(&["linear-axes", "units-as-degrees"]),
        "what F means when a linear and the rotary axis move together",
    ),
];
const DWELL_UNITS: Shape = Shape::Choice(&["s", "ms", "0.01s", "option"]);
const DWELL_UNIT_DOC: &str = "unit of the number; `option`: a setting of the machine, which the option `DWELL` declares as `s` or `ms`";
const DWELL: &[Key] = &[
    key("block", Shape::TextList, "what a dwell prints, with the word `dwell`"),
    key("unit", DWELL_UNITS, DWELL_UNIT_DOC),
    key("decimals", Shape::Integer(0, 6), "decimals of the number"),
    key("max", Shape::Number(0.0, 1e9), "longest, seconds"),
];
const CYCLE_DWELL: &[Key] = &[
    key("unit", DWELL_UNITS, DWELL_UNIT_DOC),
    key("decimals", Shape::Integer(0, 6), "decimals of the number"),
    key("max", Shape::Number(0.0, 1e9), "longest, seconds"),
];
const CYCLE: &[Key] = &[
    key("before", Shape::Text, "template of the lines before the first hole"),
    key("call", Shape::Text, "template of the pattern item `cycle` of the first hole"),
    key("words", Shape::Text, "template of the pattern item `cycle-words` of the first hole"),
    key("end", Shape::Text, "template of the lines after the last hole"),
    key("dwell", Shape::Flag, "the cycle takes a dwell; `dwell` and `bore-dwell` always do"),
    key("enabled", Shape::Flag, "`false`: the parent's control keeps it, this one does not"),
];
const SPINDLE: &[Key] = &[
    key("clockwise", Shape::Text, "the code that turns it clockwise"),
    key("counter-clockwise", Shape::Text, "the code that turns it counter-clockwise"),
    key("on", Shape::TextList, "what turning it on prints: `spindle` is the speed, `code` the direction"),
    key(
        "after-tool-change",
        Shape::TextList,
        "the same, where the tool change has said the speed already; empty: as `on`",
    ),
    key(
        "range",
        Shape::Text,
        "what stands behind the code before a gear range, a number or LOW, MEDIUM, HIGH; empty: none is said",
    ),
    key("off", Shape::Text, "off"),
];
const COOLANT: &[Key] = &[
    key("flood", Shape::Text, "flood on; empty: the control has none"),
    key("mist", Shape::Text, "mist on; empty: the control has none"),
    key("through", Shape::Text, "coolant through the tool on; empty: the control has none"),
    key("through-off", Shape::Text, "that off, also before a tool change and at the end; empty: `off` does"),
    key("off", Shape::Text, "off"),
];
const COMPENSATION: &[Key] = &[
    key(
        "left",
        Shape::TextList,
        "what begins it with the cutter left of the path, with the word `register` where that is said: in the pattern item `compensation` of the first straight move in X or Y, or in a block of its own where `rapid` or `line` has no such item; empty: the control has no compensation",
    ),
    key("right", Shape::TextList, "the same with the cutter right of the path"),
    key("off", Shape::TextList, "what ends it, in the same place"),
    key(
        "off-alone",
        Shape::TextList,
        "the block that ends it where no straight move in X or Y comes before a tool change, a drilling cycle or the end; empty: as `off`",
    ),
    key("every-move", Shape::Flag, "every straight move says what is in force"),
    key(
        "register",
        Shape::Choice(&["of-tool", "as-named", "always", "none"]),
        "the register of the radius: the tool's own and never said; said where the program names one; or always said, with the number of the tool where the program names none. `none`: programs are written without compensation",
    ),
];
const STOPS: &[Key] = &[
    key("stop", Shape::Text, "program stop"),
    key("optional", Shape::Text, "optional stop; empty: the control has none"),
    key(
        "restart",
        Shape::Flag,
        "after a stop, spindle and coolant are said again before the next move: many controls stop both",
    ),
];
const COMMENTS: &[Key] = &[
    key("open", Shape::Text, "before the text; empty: the control has no comments"),
    key("close", Shape::Text, "after the text"),
    key("allowed", Shape::Text, "characters besides letters, digits and space"),
    key("upper-case", Shape::Flag, "letters are printed in upper case"),
    key("replace", Shape::Text, "stands for a character that is not allowed"),
    key(
        "max-length",
        Shape::Integer(0, 65_535),
        "characters of text in one comment, 0 without limit; longer ones are wrapped",
    ),
    key("active-words", Shape::TextList, "words that the control would obey at the start of a comment"),
];
const PATH_CONTROL: &[Key] = &[
    key("exact", Shape::TextList, "exact path; empty: nothing to say"),
    key(
        "tolerance",
        Shape::TextList,
        "the control's own tolerance, with the word `path-tolerance`; empty: the control has none",
    ),
    key(
        "share",
        Shape::Number(0.0, 0.9),
        "part of an operation's band that the control may use; 0 asks for the exact path",
    ),
];
const NURBS: &[Key] = &[
    key(
        "knots",
        Shape::Choice(&["none", "printed", "uniform", "pieces"]),
        "no curves; knots are printed; they are 0, 0, 0, 0, 1, 2, … and not printed; or there are none: cubic pieces, one a block",
    ),
    key("begin", Shape::TextList, "first block, with the first control point, where the curve starts"),
    key(
        "point",
        Shape::TextList,
        "block of every further control point; with `z`, which is printed where the height changes, curves may climb. Of `pieces`: the block of a piece, with its end and its coefficients",
    ),
    key("rest", Shape::TextList, "block of every knot after those of the points"),
    key("end", Shape::TextList, "after the curve"),
    key(
        "between",
        Shape::TextList,
        "between two curves that follow each other, where the second would go on the first",
    ),
    key("weight-decimals", Shape::Integer(0, 9), "decimals of weights"),
    key("knot-decimals", Shape::Integer(0, 9), "decimals of knots"),
    key("max-order", Shape::Integer(2, 6), "largest degree + 1"),
    key(
        "chord",
        Shape::Number(0.0, 1.0),
        "largest step, as a part of a piece's parameter, of the chords that the control cuts in the place of `pieces`; 0: it cuts the pieces themselves",
    ),
];
const LIMITS: &[Key] = &[
    key("x", Shape::Range, "travel of X in program coordinates, mm"),
    key("y", Shape::Range, "travel of Y, mm"),
    key("z", Shape::Range, "travel of Z, mm"),
    key("spindle", Shape::Range, "revolutions per minute"),
];
const TOOL_CHANGE: &[Key] = &[
    key("order", Shape::TextList, "names of the blocks to print, in order"),
    key(
        "parks",
        Shape::Flag,
        "the change leaves Z at its upper end: the first rapid goes across before it goes down",
    ),
    key(
        "parks-with",
        Shape::Text,
        "name of an option: the change parks only where that has a value; empty: always",
    ),
    key(
        "with-first-z",
        Shape::Text,
        "template of words that go into the first block that moves Z, before its own",
    ),
    key("blocks", Shape::Texts, "the blocks, each a template; an empty answer prints nothing"),
];
const TEMPLATES: &[Key] = &[
    key("header", Shape::Text, "start of the program"),
    key("footer", Shape::Text, "end of the program"),
    key("operation", Shape::Text, "start of an operation"),
];
