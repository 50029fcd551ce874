//! Diagnostics at the place of a record.

use super::Origin;
use crate::arena::{Arena, Handle};
use crate::diag::{Code, Diagnostic};

/// A message at a statement, with the calls that led to it.
#[must_use]
pub fn at_origin(
    code: &'static Code,
    origins: &Arena<Origin>,
    origin: Handle<Origin>,
    message: impl Into<String>,
) -> Diagnostic {
    let origin = &origins[origin];
    let diagnostic = Diagnostic::new(code, origin.span, message);
    origin.calls.iter().rev().fold(diagnostic, |d, call| d.label(*call, "called from here"))
}
