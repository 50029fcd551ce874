//! Where an interpreter hands on what it finds.

use super::{EventKind, Fault, Follow, TraceEvent};

/// Where messages and events of the block in hand go.
pub(super) struct Out<'a, S: Follow> {
    pub sink: &'a mut S,
    pub line: u32,
}

impl<S: Follow> Out<'_, S> {
    #[cold]
    pub(super) fn fault(&mut self, message: impl Into<String>) {
        self.sink.fault(Fault { line: self.line, message: message.into() });
    }
    #[cold]
    pub(super) fn assumed(&mut self, message: impl Into<String>) {
        self.sink.assumed(Fault { line: self.line, message: message.into() });
    }
    pub(super) fn event(&mut self, kind: EventKind) {
        self.sink.event(TraceEvent { line: self.line, kind });
    }
}
