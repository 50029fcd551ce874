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

/// What has been said with one code at one place.
#[derive(Debug)]
struct Seen {
    /// The statement, as carried out, that said it first: what else it says there are mistakes of their own.
    execution: u64,
    /// In [`Report::items`].
    items: Vec<usize>,
}

/// Collects the messages of the analysis.
#[derive(Debug, Default)]
pub struct Report {
    items: Vec<(Diagnostic, u64)>,
    /// By code and place; what has no place, by its text.
    seen: BTreeMap<(&'static str, Option<Span>, String), Seen>,
    errors: usize,
    repeats: u64,
}

impl Report {
    /// Adds a message that arose in `calls`, when statement number `execution` was carried out; what a later statement
    /// says with the same code at the same place is only counted.
    pub fn push(&mut self, diagnostic: Diagnostic, calls: &[Call], execution: u64) {
        let place = diagnostic.primary.as_ref().map(|p| p.span);
        let text = if place.is_none() { diagnostic.message.clone() } else { String::new() };
        let next = self.items.len();
        let seen = self
            .seen
            .entry((diagnostic.code.id, place, text))
            .or_insert_with(|| Seen { execution, items: Vec::new() });
        let same = |i: &&usize| self.items.get(**i).is_some_and(|(d, _)| d.message == diagnostic.message);
        let earlier = seen.items.iter().find(same);
        let earlier = if seen.execution == execution { earlier } else { earlier.or(seen.items.first()) };
        if let Some(&index) = earlier {
            if let Some((_, times)) = self.items.get_mut(index) {
                *times += u64::from(seen.execution != execution);
                self.repeats += 1;
            }
            return;
        }
        self.errors += usize::from(diagnostic.severity == Severity::Error);
        if next < limits::MESSAGES {
            seen.items.push(next);
            self.items.push((with_calls(diagnostic, calls), 1));
        }
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
