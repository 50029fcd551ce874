//! Codes of names, words, slots, units and evaluation.

use crate::diag::Code;

/// unknown word at the start of a statement.
pub const UNKNOWN_WORD: Code = Code {
    id: "E0201",
    title: "unknown word at the start of a statement",
    page: include_str!("../../../docs/diagnostics/E0201.md"),
};
/// a statement that this version does not carry out.
pub const NOT_YET: Code = Code {
    id: "E0202",
    title: "a statement that this version does not carry out",
    page: include_str!("../../../docs/diagnostics/E0202.md"),
};
/// unknown name.
pub const UNKNOWN_NAME: Code =
    Code { id: "E0203", title: "unknown name", page: include_str!("../../../docs/diagnostics/E0203.md") };
/// unknown word in a statement.
pub const UNKNOWN_MINOR: Code = Code {
    id: "E0204",
    title: "unknown word in a statement",
    page: include_str!("../../../docs/diagnostics/E0204.md"),
};
/// something else belongs here.
pub const WRONG_KIND: Code = Code {
    id: "E0205",
    title: "something else belongs here",
    page: include_str!("../../../docs/diagnostics/E0205.md"),
};
/// a value or word is missing.
pub const MISSING_VALUE: Code = Code {
    id: "E0206",
    title: "a value or word is missing",
    page: include_str!("../../../docs/diagnostics/E0206.md"),
};
/// given twice.
pub const DOUBLED_WORD: Code =
    Code { id: "E0207", title: "given twice", page: include_str!("../../../docs/diagnostics/E0207.md") };
/// wrong dimension.
pub const WRONG_DIMENSION: Code =
    Code { id: "E0208", title: "wrong dimension", page: include_str!("../../../docs/diagnostics/E0208.md") };
/// value out of range.
pub const OUT_OF_RANGE: Code = Code {
    id: "E0209",
    title: "value out of range",
    page: include_str!("../../../docs/diagnostics/E0209.md"),
};
/// too many values.
pub const TOO_MANY: Code =
    Code { id: "E0210", title: "too many values", page: include_str!("../../../docs/diagnostics/E0210.md") };
/// two dimensions that do not go together.
pub const DIMENSIONS_DIFFER: Code = Code {
    id: "E0211",
    title: "two dimensions that do not go together",
    page: include_str!("../../../docs/diagnostics/E0211.md"),
};
/// unknown unit.
pub const UNKNOWN_UNIT: Code =
    Code { id: "E0212", title: "unknown unit", page: include_str!("../../../docs/diagnostics/E0212.md") };
/// division by zero.
pub const DIVISION_BY_ZERO: Code =
    Code { id: "E0213", title: "division by zero", page: include_str!("../../../docs/diagnostics/E0213.md") };
/// the calculation has no finite real result.
pub const NO_VALUE: Code = Code {
    id: "E0214",
    title: "the calculation has no finite real result",
    page: include_str!("../../../docs/diagnostics/E0214.md"),
};
/// the name is taken.
pub const ALREADY_DECLARED: Code = Code {
    id: "E0215",
    title: "the name is taken",
    page: include_str!("../../../docs/diagnostics/E0215.md"),
};
/// a word of the language as a name.
pub const RESERVED: Code = Code {
    id: "E0216",
    title: "a word of the language as a name",
    page: include_str!("../../../docs/diagnostics/E0216.md"),
};
/// a label is missing or not possible.
pub const LABEL: Code = Code {
    id: "E0217",
    title: "a label is missing or not possible",
    page: include_str!("../../../docs/diagnostics/E0217.md"),
};
/// unknown function.
pub const UNKNOWN_FUNCTION: Code =
    Code { id: "E0218", title: "unknown function", page: include_str!("../../../docs/diagnostics/E0218.md") };
/// wrong number of arguments.
pub const FUNCTION_ARGUMENTS: Code = Code {
    id: "E0219",
    title: "wrong number of arguments",
    page: include_str!("../../../docs/diagnostics/E0219.md"),
};
/// unknown member.
pub const UNKNOWN_MEMBER: Code =
    Code { id: "E0220", title: "unknown member", page: include_str!("../../../docs/diagnostics/E0220.md") };
/// wrong subscript.
pub const SUBSCRIPT: Code =
    Code { id: "E0221", title: "wrong subscript", page: include_str!("../../../docs/diagnostics/E0221.md") };
/// not a condition.
pub const NOT_A_CONDITION: Code =
    Code { id: "E0222", title: "not a condition", page: include_str!("../../../docs/diagnostics/E0222.md") };
/// a block without its other end.
pub const BLOCK: Code = Code {
    id: "E0223",
    title: "a block without its other end",
    page: include_str!("../../../docs/diagnostics/E0223.md"),
};
/// unknown macro.
pub const UNKNOWN_MACRO: Code =
    Code { id: "E0224", title: "unknown macro", page: include_str!("../../../docs/diagnostics/E0224.md") };
/// wrong macro arguments.
pub const MACRO_ARGUMENTS: Code = Code {
    id: "E0225",
    title: "wrong macro arguments",
    page: include_str!("../../../docs/diagnostics/E0225.md"),
};
/// a loop runs too long.
pub const LOOP_LIMIT: Code = Code {
    id: "E0226",
    title: "a loop runs too long",
    page: include_str!("../../../docs/diagnostics/E0226.md"),
};
/// macros call one another too deeply.
pub const CALL_LIMIT: Code = Code {
    id: "E0227",
    title: "macros call one another too deeply",
    page: include_str!("../../../docs/diagnostics/E0227.md"),
};
/// the program is too large.
pub const SIZE_LIMIT: Code = Code {
    id: "E0228",
    title: "the program is too large",
    page: include_str!("../../../docs/diagnostics/E0228.md"),
};
/// a jump without its target.
pub const JUMP: Code = Code {
    id: "E0229",
    title: "a jump without its target",
    page: include_str!("../../../docs/diagnostics/E0229.md"),
};
/// a file that the program names cannot be read.
pub const INCLUDE: Code = Code {
    id: "E0230",
    title: "a file that the program names cannot be read",
    page: include_str!("../../../docs/diagnostics/E0230.md"),
};
/// files include one another.
pub const INCLUDE_CYCLE: Code = Code {
    id: "E0231",
    title: "files include one another",
    page: include_str!("../../../docs/diagnostics/E0231.md"),
};
/// a definition on the command line does not fit.
pub const DEFINE: Code = Code {
    id: "E0232",
    title: "a definition on the command line does not fit",
    page: include_str!("../../../docs/diagnostics/E0232.md"),
};
/// a parameter out of its range.
pub const PARAMETER_RANGE: Code = Code {
    id: "E0233",
    title: "a parameter out of its range",
    page: include_str!("../../../docs/diagnostics/E0233.md"),
};
/// UNITS after numbers, or twice.
pub const UNITS_LATE: Code = Code {
    id: "E0234",
    title: "UNITS after numbers, or twice",
    page: include_str!("../../../docs/diagnostics/E0234.md"),
};
/// an operator on something it does not work on.
pub const WRONG_OPERAND: Code = Code {
    id: "E0235",
    title: "an operator on something it does not work on",
    page: include_str!("../../../docs/diagnostics/E0235.md"),
};
/// two words that exclude each other.
pub const WORDS_EXCLUDE: Code = Code {
    id: "E0236",
    title: "two words that exclude each other",
    page: include_str!("../../../docs/diagnostics/E0236.md"),
};
/// INTOL and OUTTOL are both zero.
pub const NO_TOLERANCE: Code = Code {
    id: "E0240",
    title: "INTOL and OUTTOL are both zero",
    page: include_str!("../../../docs/diagnostics/E0240.md"),
};
/// the depth is unknown.
pub const NO_DEPTH: Code = Code {
    id: "E0241",
    title: "the depth is unknown",
    page: include_str!("../../../docs/diagnostics/E0241.md"),
};
/// a cutter that cannot be.
pub const CUTTER_SHAPE: Code = Code {
    id: "E0242",
    title: "a cutter that cannot be",
    page: include_str!("../../../docs/diagnostics/E0242.md"),
};
/// an increment from an unknown place.
pub const NO_POSITION: Code = Code {
    id: "E0243",
    title: "an increment from an unknown place",
    page: include_str!("../../../docs/diagnostics/E0243.md"),
};
/// a side or flank that the contour does not have.
pub const NO_SUCH_SIDE: Code = Code {
    id: "E0244",
    title: "a side or flank that the contour does not have",
    page: include_str!("../../../docs/diagnostics/E0244.md"),
};
/// powers and signs that readers take in two ways.
pub const POWER_ORDER: Code = Code {
    id: "W0251",
    title: "powers and signs that readers take in two ways",
    page: include_str!("../../../docs/diagnostics/W0251.md"),
};
/// statements after FINI.
pub const AFTER_FINI: Code = Code {
    id: "W0252",
    title: "statements after FINI",
    page: include_str!("../../../docs/diagnostics/W0252.md"),
};
/// a word that does nothing here.
pub const IGNORED: Code = Code {
    id: "N0261",
    title: "a word that does nothing here",
    page: include_str!("../../../docs/diagnostics/N0261.md"),
};

/// nothing says how close the passes are.
pub const NO_SPACING: Code = Code {
    id: "E0245",
    title: "nothing says how close the passes are",
    page: include_str!("../../../docs/diagnostics/E0245.md"),
};

/// All codes of this area.
pub const ALL: &[&Code] = &[
    &UNKNOWN_WORD,
    &NOT_YET,
    &UNKNOWN_NAME,
    &UNKNOWN_MINOR,
    &WRONG_KIND,
    &MISSING_VALUE,
    &DOUBLED_WORD,
    &WRONG_DIMENSION,
    &OUT_OF_RANGE,
    &TOO_MANY,
    &DIMENSIONS_DIFFER,
    &UNKNOWN_UNIT,
    &DIVISION_BY_ZERO,
    &NO_VALUE,
    &ALREADY_DECLARED,
    &RESERVED,
    &LABEL,
    &UNKNOWN_FUNCTION,
    &FUNCTION_ARGUMENTS,
    &UNKNOWN_MEMBER,
    &SUBSCRIPT,
    &NOT_A_CONDITION,
    &BLOCK,
    &UNKNOWN_MACRO,
    &MACRO_ARGUMENTS,
    &LOOP_LIMIT,
    &CALL_LIMIT,
    &SIZE_LIMIT,
    &JUMP,
    &INCLUDE,
    &INCLUDE_CYCLE,
    &DEFINE,
    &PARAMETER_RANGE,
    &UNITS_LATE,
    &WRONG_OPERAND,
    &WORDS_EXCLUDE,
    &NO_TOLERANCE,
    &NO_DEPTH,
    &CUTTER_SHAPE,
    &NO_POSITION,
    &NO_SUCH_SIDE,
    &POWER_ORDER,
    &AFTER_FINI,
    &IGNORED,
    &NO_SPACING,
];
