//! Codes of the syntax stage.

use crate::diag::Code;

/// something else was expected here.
pub const UNEXPECTED: Code = Code {
    id: "E0101",
    title: "something else was expected here",
    page: include_str!("../../../docs/diagnostics/E0101.md"),
};

/// the slash after a word is missing.
pub const MISSING_SLASH: Code = Code {
    id: "E0102",
    title: "the slash after a word is missing",
    page: include_str!("../../../docs/diagnostics/E0102.md"),
};

/// a comma too many.
pub const DOUBLED_COMMA: Code =
    Code { id: "E0103", title: "a comma too many", page: include_str!("../../../docs/diagnostics/E0103.md") };

/// a parenthesis is missing or too many.
pub const UNBALANCED: Code = Code {
    id: "E0104",
    title: "a parenthesis is missing or too many",
    page: include_str!("../../../docs/diagnostics/E0104.md"),
};

/// a string is not closed.
pub const UNTERMINATED_STRING: Code = Code {
    id: "E0105",
    title: "a string is not closed",
    page: include_str!("../../../docs/diagnostics/E0105.md"),
};

/// a character that has no meaning here.
pub const STRAY_CHARACTER: Code = Code {
    id: "E0106",
    title: "a character that has no meaning here",
    page: include_str!("../../../docs/diagnostics/E0106.md"),
};

/// a control character in the source.
pub const CONTROL_CHARACTER: Code = Code {
    id: "E0107",
    title: "a control character in the source",
    page: include_str!("../../../docs/diagnostics/E0107.md"),
};

/// a number is not well formed.
pub const BAD_NUMBER: Code = Code {
    id: "E0108",
    title: "a number is not well formed",
    page: include_str!("../../../docs/diagnostics/E0108.md"),
};

/// the file ends in a continued statement.
pub const DANGLING_CONTINUATION: Code = Code {
    id: "E0109",
    title: "the file ends in a continued statement",
    page: include_str!("../../../docs/diagnostics/E0109.md"),
};

/// a line promises more, and a new statement follows.
pub const UNFINISHED_LINE: Code = Code {
    id: "E0110",
    title: "a line promises more, and a new statement follows",
    page: include_str!("../../../docs/diagnostics/E0110.md"),
};

/// a statement is too long or too deeply nested.
pub const TOO_COMPLEX: Code = Code {
    id: "E0111",
    title: "a statement is too long or too deeply nested",
    page: include_str!("../../../docs/diagnostics/E0111.md"),
};

/// a label before a line of text.
pub const LABEL_BEFORE_TEXT: Code = Code {
    id: "E0112",
    title: "a label before a line of text",
    page: include_str!("../../../docs/diagnostics/E0112.md"),
};

/// a value is missing.
pub const MISSING_VALUE: Code = Code {
    id: "E0113",
    title: "a value is missing",
    page: include_str!("../../../docs/diagnostics/E0113.md"),
};

/// an assignment where a comparison is meant.
pub const ASSIGNMENT_IN_CONDITION: Code = Code {
    id: "E0114",
    title: "an assignment where a comparison is meant",
    page: include_str!("../../../docs/diagnostics/E0114.md"),
};

/// a blank inside a word.
pub const BLANK_IN_WORD: Code = Code {
    id: "E0115",
    title: "a blank inside a word",
    page: include_str!("../../../docs/diagnostics/E0115.md"),
};

/// an arithmetic IF without three labels.
pub const ARITHMETIC_IF: Code = Code {
    id: "E0116",
    title: "an arithmetic IF without three labels",
    page: include_str!("../../../docs/diagnostics/E0116.md"),
};

/// text behind a continuation mark.
pub const TEXT_AFTER_CONTINUATION: Code = Code {
    id: "W0101",
    title: "text behind a continuation mark",
    page: include_str!("../../../docs/diagnostics/W0101.md"),
};

/// All codes of this area.
pub const ALL: &[&Code] = &[
    &UNEXPECTED,
    &MISSING_SLASH,
    &DOUBLED_COMMA,
    &UNBALANCED,
    &UNTERMINATED_STRING,
    &STRAY_CHARACTER,
    &CONTROL_CHARACTER,
    &BAD_NUMBER,
    &DANGLING_CONTINUATION,
    &UNFINISHED_LINE,
    &TOO_COMPLEX,
    &LABEL_BEFORE_TEXT,
    &MISSING_VALUE,
    &ASSIGNMENT_IN_CONDITION,
    &BLANK_IN_WORD,
    &ARITHMETIC_IF,
    &TEXT_AFTER_CONTINUATION,
];
