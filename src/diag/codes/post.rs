//! Codes of post files and writing.

use crate::diag::Code;

/// unknown post.
pub const UNKNOWN_POST: Code =
    Code { id: "E0701", title: "unknown post", page: include_str!("../../../docs/diagnostics/E0701.md") };

/// the post file is not TOML.
pub const NOT_TOML: Code = Code {
    id: "E0702",
    title: "the post file is not TOML",
    page: include_str!("../../../docs/diagnostics/E0702.md"),
};

/// unknown key in a post file.
pub const UNKNOWN_KEY: Code = Code {
    id: "E0703",
    title: "unknown key in a post file",
    page: include_str!("../../../docs/diagnostics/E0703.md"),
};

/// a key of a post file has a wrong value.
pub const WRONG_VALUE: Code = Code {
    id: "E0704",
    title: "a key of a post file has a wrong value",
    page: include_str!("../../../docs/diagnostics/E0704.md"),
};

/// post files inherit in a circle.
pub const INHERITANCE: Code = Code {
    id: "E0705",
    title: "post files inherit in a circle",
    page: include_str!("../../../docs/diagnostics/E0705.md"),
};

/// a post file cannot be read.
pub const UNREADABLE_POST: Code = Code {
    id: "E0706",
    title: "a post file cannot be read",
    page: include_str!("../../../docs/diagnostics/E0706.md"),
};

/// a post file is not complete.
pub const INCOMPLETE_POST: Code = Code {
    id: "E0707",
    title: "a post file is not complete",
    page: include_str!("../../../docs/diagnostics/E0707.md"),
};

/// names in a post file do not fit together.
pub const BAD_PATTERN: Code = Code {
    id: "E0708",
    title: "names in a post file do not fit together",
    page: include_str!("../../../docs/diagnostics/E0708.md"),
};

/// a template of a post file cannot be used.
pub const BAD_TEMPLATE: Code = Code {
    id: "E0709",
    title: "a template of a post file cannot be used",
    page: include_str!("../../../docs/diagnostics/E0709.md"),
};

/// a line is longer than the control takes.
pub const LINE_TOO_LONG: Code = Code {
    id: "E0710",
    title: "a line is longer than the control takes",
    page: include_str!("../../../docs/diagnostics/E0710.md"),
};

/// an inserted block cannot be written.
pub const BAD_INSERT: Code = Code {
    id: "E0711",
    title: "an inserted block cannot be written",
    page: include_str!("../../../docs/diagnostics/E0711.md"),
};

/// a number does not fit its word.
pub const WORD_RANGE: Code = Code {
    id: "E0712",
    title: "a number does not fit its word",
    page: include_str!("../../../docs/diagnostics/E0712.md"),
};

/// the post has no such machine option.
pub const MACHINE_OPTION: Code = Code {
    id: "E0713",
    title: "the post has no such machine option",
    page: include_str!("../../../docs/diagnostics/E0713.md"),
};

/// an option of a post does not have such a value.
pub const OPTION_VALUE: Code = Code {
    id: "E0714",
    title: "an option of a post does not have such a value",
    page: include_str!("../../../docs/diagnostics/E0714.md"),
};

/// All codes of this area.
pub const ALL: &[&Code] = &[
    &UNKNOWN_POST,
    &NOT_TOML,
    &UNKNOWN_KEY,
    &WRONG_VALUE,
    &INHERITANCE,
    &UNREADABLE_POST,
    &INCOMPLETE_POST,
    &BAD_PATTERN,
    &BAD_TEMPLATE,
    &LINE_TOO_LONG,
    &BAD_INSERT,
    &WORD_RANGE,
    &MACHINE_OPTION,
    &OPTION_VALUE,
];
