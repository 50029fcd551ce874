//! Limits that keep any input from taking long or much memory, and what is said when they are met.

use crate::diag::Diagnostic;
use crate::diag::codes::syntax as codes;
use crate::source::Span;

/// Open parentheses at one place.
pub const DEPTH: usize = 64;
/// Operators in one argument, subexpressions included: bounds the depth of the tree.
pub const OPERATORS: usize = 400;
/// Bytes of one logical statement.
pub const STATEMENT_BYTES: usize = 256 * 1024;
/// Diagnostics after which the rest of a file is not read any more.
pub const ERRORS: usize = 200;
/// Statements that are parsed in parallel at a time; fewer are parsed one after the other.
pub const BATCH: usize = 4096;
/// Stray characters reported in one statement.
pub const STRAY_PER_STATEMENT: usize = 5;
/// Rule calls of the grammar for one statement; a statement of full length takes about a tenth of it.
pub const GRAMMAR_CALLS: usize = 50_000_000;

pub(super) fn too_deep(span: Span) -> Diagnostic {
    Diagnostic::new(&codes::TOO_COMPLEX, span, format!("more than {DEPTH} parentheses are open here"))
        .help("name a part of it in a statement of its own")
}

pub(super) fn too_long(span: Span, bytes: usize) -> Diagnostic {
    Diagnostic::new(
        &codes::TOO_COMPLEX,
        span,
        format!("this statement is {bytes} bytes long; at most {STATEMENT_BYTES} are allowed"),
    )
    .help("split it, or put bulk data into a CSV file")
}

pub(super) fn too_many_operators(span: Span) -> Diagnostic {
    Diagnostic::new(&codes::TOO_COMPLEX, span, format!("this expression has more than {OPERATORS} operators"))
        .help("name a part of it in a statement of its own")
}

/// Sets pest's guard against a grammar that goes astray; the guard belongs to the process, and is the same for
/// every caller.
pub(super) fn guard_grammar() {
    pest::set_call_limit(core::num::NonZeroUsize::new(GRAMMAR_CALLS));
}
