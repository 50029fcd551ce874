//! Codes of the tools for post authors and of golden tests. Findings in post files are numbered with those.

use crate::diag::Code;

/// a template reads a variable that does not exist.
pub const UNKNOWN_VARIABLE: Code = Code {
    id: "E0751",
    title: "a template reads a variable that does not exist",
    page: include_str!("../../../docs/diagnostics/E0751.md"),
};

/// a post claims what its words cannot express.
pub const INEXPRESSIBLE: Code = Code {
    id: "E0752",
    title: "a post claims what its words cannot express",
    page: include_str!("../../../docs/diagnostics/E0752.md"),
};

/// a part of a post file is never used.
pub const UNREACHABLE: Code = Code {
    id: "W0753",
    title: "a part of a post file is never used",
    page: include_str!("../../../docs/diagnostics/W0753.md"),
};

/// two meanings have one code.
pub const ALIKE: Code = Code {
    id: "E0754",
    title: "two meanings have one code",
    page: include_str!("../../../docs/diagnostics/E0754.md"),
};

/// an override is not KEY=VALUE.
pub const BAD_POST_SET: Code = Code {
    id: "E0951",
    title: "an override is not KEY=VALUE",
    page: include_str!("../../../docs/diagnostics/E0951.md"),
};

/// a new file would overwrite an old one.
pub const ALREADY_THERE: Code = Code {
    id: "E0952",
    title: "a new file would overwrite an old one",
    page: include_str!("../../../docs/diagnostics/E0952.md"),
};

/// a name cannot be used.
pub const BAD_NAME: Code = Code {
    id: "E0953",
    title: "a name cannot be used",
    page: include_str!("../../../docs/diagnostics/E0953.md"),
};

/// the control cannot execute an NC program.
pub const NOT_EXECUTABLE: Code = Code {
    id: "E0954",
    title: "the control cannot execute an NC program",
    page: include_str!("../../../docs/diagnostics/E0954.md"),
};

/// a test file cannot be used.
pub const BAD_SIDECAR: Code = Code {
    id: "E0955",
    title: "a test file cannot be used",
    page: include_str!("../../../docs/diagnostics/E0955.md"),
};

/// there is nothing to test.
pub const NOTHING_TO_TEST: Code = Code {
    id: "E0956",
    title: "there is nothing to test",
    page: include_str!("../../../docs/diagnostics/E0956.md"),
};

/// Findings in post files.
pub const OF_POSTS: &[&Code] = &[&UNKNOWN_VARIABLE, &INEXPRESSIBLE, &UNREACHABLE, &ALIKE];

/// Codes of the command line.
pub const OF_COMMANDS: &[&Code] =
    &[&BAD_POST_SET, &ALREADY_THERE, &BAD_NAME, &NOT_EXECUTABLE, &BAD_SIDECAR, &NOTHING_TO_TEST];
