//! Messages about a CL file: each cause once, with how often it came.

use std::collections::BTreeMap;

use crate::diag::codes::foreign as codes;
use crate::diag::{Diagnostic, Sink};
use crate::source::{FileId, Span};

/// What several stages say of a CL file, each cause once, in the order given; what is not shown is counted behind it.
pub(crate) fn told_once(file: FileId, diagnostics: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let (mut told, mut sink) = (Told::default(), Sink::default());
    diagnostics.into_iter().for_each(|d| told.tell(d));
    told.finish(Span::new(file, 0, 0), &mut sink);
    sink.into_items()
}

/// Causes of one code at most; the rest are counted.
const MOST: usize = 20;

/// What has been told so far, at its first place.
#[derive(Debug, Default)]
pub(super) struct Told {
    causes: Vec<(Diagnostic, u64)>,
    /// Index of a cause by code and message.
    known: BTreeMap<&'static str, BTreeMap<String, usize>>,
    /// Messages that are not shown, by code.
    hidden: BTreeMap<&'static str, u64>,
}

impl Told {
    /// Adds a message, or counts it where the same has been told before.
    pub(super) fn tell(&mut self, diagnostic: Diagnostic) {
        let id = diagnostic.code.id;
        let of_code = self.known.entry(id).or_default();
        if let Some((_, count)) = of_code.get(&diagnostic.message).and_then(|at| self.causes.get_mut(*at)) {
            *count += 1;
        } else if of_code.len() < MOST {
            of_code.insert(diagnostic.message.clone(), self.causes.len());
            self.causes.push((diagnostic, 1));
        } else {
            *self.hidden.entry(id).or_default() += 1;
        }
    }

    /// Whether nothing has been told.
    pub(super) fn is_empty(&self) -> bool {
        self.causes.is_empty()
    }

    /// Hands all of it over; `start` is the file's first byte.
    pub(super) fn finish(&mut self, start: Span, sink: &mut Sink) {
        let told = core::mem::take(self);
        for (mut diagnostic, count) in told.causes {
            if count > 1 {
                diagnostic.message += &format!(" (and {} more like it)", count - 1);
            }
            sink.push(diagnostic);
        }
        let rest: Vec<String> = told.hidden.iter().map(|(code, n)| format!("{n} more of {code}")).collect();
        if !rest.is_empty() {
            let message = format!("not all messages are shown: {}", rest.join(", "));
            sink.push(Diagnostic::new(&codes::MORE, start, message));
        }
    }
}
