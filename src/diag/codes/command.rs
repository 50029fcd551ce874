//! Codes of files, the command line and configuration.

use crate::diag::Code;

/// a file cannot be read.
pub const CANNOT_READ: Code = Code {
    id: "E0901",
    title: "a file cannot be read",
    page: include_str!("../../../docs/diagnostics/E0901.md"),
};

/// a file lies outside the project.
pub const OUTSIDE_ROOT: Code = Code {
    id: "E0902",
    title: "a file lies outside the project",
    page: include_str!("../../../docs/diagnostics/E0902.md"),
};

/// a file is not UTF-8.
pub const NOT_UTF8: Code = Code {
    id: "E0903",
    title: "a file is not UTF-8",
    page: include_str!("../../../docs/diagnostics/E0903.md"),
};

/// a file is too large.
pub const TOO_LARGE: Code = Code {
    id: "E0904",
    title: "a file is too large",
    page: include_str!("../../../docs/diagnostics/E0904.md"),
};

/// a file cannot be written.
pub const CANNOT_WRITE: Code = Code {
    id: "E0905",
    title: "a file cannot be written",
    page: include_str!("../../../docs/diagnostics/E0905.md"),
};

/// one output file for several programs.
pub const ONE_OUTPUT: Code = Code {
    id: "E0906",
    title: "one output file for several programs",
    page: include_str!("../../../docs/diagnostics/E0906.md"),
};

/// no post is named.
pub const NO_POST: Code =
    Code { id: "E0907", title: "no post is named", page: include_str!("../../../docs/diagnostics/E0907.md") };

/// unknown diagnostic code.
pub const UNKNOWN_CODE: Code = Code {
    id: "E0908",
    title: "unknown diagnostic code",
    page: include_str!("../../../docs/diagnostics/E0908.md"),
};

/// two results would go to the same file.
pub const OUTPUT_CLASH: Code = Code {
    id: "E0909",
    title: "two results would go to the same file",
    page: include_str!("../../../docs/diagnostics/E0909.md"),
};

/// a definition on the command line is not NAME=VALUE.
pub const BAD_DEFINE: Code = Code {
    id: "E0910",
    title: "a definition on the command line is not NAME=VALUE",
    page: include_str!("../../../docs/diagnostics/E0910.md"),
};

/// the number of threads is not usable.
pub const BAD_THREADS: Code = Code {
    id: "E0911",
    title: "the number of threads is not usable",
    page: include_str!("../../../docs/diagnostics/E0911.md"),
};

/// there is nothing to draw.
pub const NO_PICTURE: Code = Code {
    id: "E0912",
    title: "there is nothing to draw",
    page: include_str!("../../../docs/diagnostics/E0912.md"),
};

/// unknown form of picture.
pub const PICTURE_FORM: Code = Code {
    id: "E0913",
    title: "unknown form of picture",
    page: include_str!("../../../docs/diagnostics/E0913.md"),
};

/// unknown form of export.
pub const EXPORT_FORM: Code = Code {
    id: "E0917",
    title: "unknown form of export",
    page: include_str!("../../../docs/diagnostics/E0917.md"),
};

/// there is no net to export.
pub const NO_EXPORT: Code = Code {
    id: "E0918",
    title: "there is no net to export",
    page: include_str!("../../../docs/diagnostics/E0918.md"),
};

/// All codes of this area.
pub const ALL: &[&Code] = &[
    &CANNOT_READ,
    &OUTSIDE_ROOT,
    &NOT_UTF8,
    &TOO_LARGE,
    &CANNOT_WRITE,
    &ONE_OUTPUT,
    &NO_POST,
    &UNKNOWN_CODE,
    &OUTPUT_CLASH,
    &BAD_DEFINE,
    &BAD_THREADS,
    &NO_PICTURE,
    &PICTURE_FORM,
    &EXPORT_FORM,
    &NO_EXPORT,
];
