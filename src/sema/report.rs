//! Messages of the analysis: each mistake once, with the calls that led to it.

use std::collections::BTreeMap;
use std::rc::Rc;

use crate::diag::{Diagnostic, Severity, Sink};
use crate::source::Span;

use super::limits;

/// A call that is being carried out.
#[derive(Debug, Clone)]
pub struct Call {
    /// The macro's name.
    pub name: Rc<str>,
    /// Where it is defined.
    pub definition: Span,
    /// The `CALL` statement.
    pub call: Span,
}

/// Calls shown in one message; of more, the outermost and the innermost.
const CALLS_SHOWN: usize = 4;

/// Collects the messages of the analysis.
#[derive(Debug, Default)]
pub struct Report {
    items: Vec<(Diagnostic, u64)>,
    /// By code and place; what has no place, by its text.
    seen: BTreeMap<(&'static str, Option<Span>, String), usize>,
    errors: usize,
    repeats: u64,
}

impl Report {
    /// Adds a message that arose in `calls`; a repetition of an earlier one is only counted.
    pub fn push(&mut self, diagnostic: Diagnostic, calls: &[Call]) {
        let place = diagnostic.primary.as_ref().map(|p| p.span);
        let text = if place.is_none() { diagnostic.message.clone() } else { String::new() };
        let key = (diagnostic.code.id, place, text);
        if let Some(&index) = self.seen.get(&key) {
            if let Some((_, times)) = self.items.get_mut(index) {
                *times += 1;
                self.repeats += 1;
            }
            return;
        }
        self.errors += usize::from(diagnostic.severity == Severity::Error);
        if self.items.len() >= limits::MESSAGES {
            return;
        }
        self.seen.insert(key, self.items.len());
        self.items.push((with_calls(diagnostic, calls), 1));
    }
    /// Number of errors so far.
    #[must_use]
    pub fn errors(&self) -> usize {
        self.errors
    }
    /// How often earlier messages came again.
    #[must_use]
    pub fn repeats(&self) -> u64 {
        self.repeats
    }
    /// Hands everything to `sink`.
    pub fn finish(self, sink: &mut Sink) {
        for (diagnostic, times) in self.items {
            sink.push(if times > 1 {
                diagnostic.note(format!("the same happens {times} times in all, in loops or calls"))
            } else {
                diagnostic
            });
        }
    }
}

/// Adds the macro definition and the calls, innermost first.
fn with_calls(mut diagnostic: Diagnostic, calls: &[Call]) -> Diagnostic {
    let Some(innermost) = calls.last() else { return diagnostic };
    diagnostic =
        diagnostic.label(innermost.definition, format!("in the macro {}, defined here", innermost.name));
    let hidden = calls.len().saturating_sub(CALLS_SHOWN);
    for (i, call) in calls.iter().rev().enumerate() {
        if i < CALLS_SHOWN - 1 || i + 1 == calls.len() {
            diagnostic = diagnostic.label(call.call, format!("{} is called here", call.name));
        }
    }
    if hidden > 0 { diagnostic.note(format!("{hidden} more calls lie between")) } else { diagnostic }
}
