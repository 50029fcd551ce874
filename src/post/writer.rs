//! The writer: target blocks to lines.
//!
//! Motion runs on [`MotionTable`]: integers to digits, modality by comparing the integers that are printed.
//! Everything else is cold and goes through words or templates.

use super::compensation::Compensating;
use super::dialect::{Dialect, NumberingMode};
use super::table::{INVERSE_TIME, MotionTable, PER_MINUTE, PER_REVOLUTION, WordFormat};
use crate::arena::Handle;
use crate::diag::Diagnostic;
use crate::ir::Origin;
use crate::target::number;
use crate::target::{FeedWord, Position};

/// What the control remembers, as far as what was printed tells.
#[derive(Debug, Clone, Default)]
pub(super) struct ModalState {
    /// Printed X, Y, Z, rotary.
    pub axes: [Option<i64>; 4],
    /// Motion code.
    pub motion: Option<usize>,
    /// Feed mode.
    pub mode: Option<usize>,
    /// Feed in that mode.
    pub feed: Option<i64>,
    /// Plane of arcs.
    pub plane: Option<usize>,
    /// Path tolerance in steps; `Some(None)`: exact path.
    pub path: Option<Option<i64>>,
    /// The last motion was a NURBS curve.
    pub curve: bool,
}

/// What one part of a program leaves to the next.
#[derive(Debug, Clone)]
pub(super) struct WriterCarry {
    state: ModalState,
    position: Position,
    with_first_z: Vec<u8>,
    compensating: Compensating,
    line: u32,
    next_number: u32,
    last_number: u32,
    continued: bool,
}

/// A line that the control would not take.
#[derive(Debug, Clone)]
pub(super) struct LineFault {
    pub origin: Handle<Origin>,
    pub length: usize,
    pub text: String,
}

/// Writes blocks to a buffer.
pub(super) struct Writer<'a> {
    pub dialect: &'a Dialect,
    pub table: MotionTable,
    pub out: Vec<u8>,
    pub state: ModalState,
    /// Where the machine is, printed or not.
    pub position: Position,
    /// Words that wait for the first block that moves Z.
    pub with_first_z: Vec<u8>,
    /// What cutter compensation has said.
    pub compensating: Compensating,
    /// Call and words of a drilling cycle that wait for its first hole.
    pub cycle: [Vec<u8>; 2],
    /// Start of the current line in `out`, and of its words after a block number.
    line_start: usize,
    pub words_start: usize,
    /// The line before said that its block goes on.
    continued: bool,
    /// Lines finished.
    pub line: u32,
    next_number: u32,
    last_number: u32,
    limit: usize,
    pub origin: Handle<Origin>,
    pub faults: Vec<LineFault>,
    pub errors: Vec<Diagnostic>,
}

impl<'a> Writer<'a> {
    pub fn new(
        dialect: &'a Dialect,
        table: MotionTable,
        origin: Handle<Origin>,
        capacity: usize,
    ) -> Writer<'a> {
        let limit = dialect.spec.line.max_length;
        Writer {
            dialect,
            table,
            out: Vec::with_capacity(capacity),
            state: ModalState::default(),
            position: Position::default(),
            with_first_z: Vec::new(),
            compensating: Compensating::default(),
            cycle: [Vec::new(), Vec::new()],
            continued: false,
            line_start: 0,
            words_start: 0,
            line: 0,
            next_number: dialect.spec.numbering.start,
            last_number: dialect.spec.numbering.start,
            limit: if limit == 0 { usize::MAX } else { limit },
            origin,
            faults: Vec::new(),
            errors: Vec::new(),
        }
    }

    /// What the next part of the program must know.
    pub fn carry(&self) -> WriterCarry {
        WriterCarry {
            state: self.state.clone(),
            position: self.position,
            with_first_z: self.with_first_z.clone(),
            compensating: self.compensating.clone(),
            line: self.line,
            next_number: self.next_number,
            last_number: self.last_number,
            continued: self.continued,
        }
    }

    /// Goes on where the part before ended.
    pub fn resume(&mut self, carry: WriterCarry) {
        self.state = carry.state;
        self.position = carry.position;
        self.with_first_z = carry.with_first_z;
        self.compensating = carry.compensating;
        self.line = carry.line;
        self.next_number = carry.next_number;
        self.last_number = carry.last_number;
        self.continued = carry.continued;
    }

    /// Starts a line: its number, if it gets one.
    pub fn begin_line(&mut self, numbered: bool) {
        self.line_start = self.out.len();
        self.words_start = self.line_start;
        if numbered && self.table.numbering != NumberingMode::None && !self.continued {
            self.block_number();
        }
    }

    fn block_number(&mut self) {
        let rules = &self.dialect.spec.numbering;
        self.out.extend_from_slice(rules.prefix.as_bytes());
        number::push(&mut self.out, i64::from(self.next_number), &number::Style::default());
        self.out.push(b' ');
        self.words_start = self.out.len();
        self.last_number = self.next_number;
        self.next_number = self.next_number.saturating_add(rules.step);
        if self.next_number > rules.max {
            self.next_number = rules.start;
        }
    }

    /// Ends a line that has words; takes back one that has none.
    pub fn end_line(&mut self) {
        if self.out.len() == self.words_start {
            self.take_back();
            return;
        }
        self.continued = !self.table.continuation.is_empty() && self.out.ends_with(&self.table.continuation);
        if !self.table.ending.is_empty() && !self.continued && self.out.get(self.line_start..) != Some(b"%") {
            self.out.extend_from_slice(&self.table.ending);
        }
        if self.out.len() - self.line_start > self.limit {
            self.check_length();
        }
        self.out.extend_from_slice(self.table.newline);
        self.line += 1;
    }

    /// A line without words is none, and its number is free.
    fn take_back(&mut self) {
        if self.words_start > self.line_start {
            self.next_number = self.last_number;
        }
        self.out.truncate(self.line_start);
        self.words_start = self.line_start;
    }

    /// A line with this text, unnumbered or not.
    pub fn text_line(&mut self, text: &str, numbered: bool) {
        self.begin_line(numbered);
        self.out.extend_from_slice(text.as_bytes());
        self.end_line();
    }

    #[cold]
    fn check_length(&mut self) {
        let text = String::from_utf8_lossy(&self.out[self.line_start..]).into_owned();
        let length = self.counted_length(&text);
        if length > self.limit {
            self.faults.push(LineFault { origin: self.origin, length, text });
        }
    }

    /// Characters that the control counts.
    fn counted_length(&self, text: &str) -> usize {
        let rules = &self.dialect.spec.line;
        let comments = &self.dialect.spec.comments;
        let mut inside = false;
        let mut length = 0;
        for c in text.chars() {
            let opens = comments.open.starts_with(c);
            inside |= opens;
            let counted = (rules.count_comments || !inside) && (rules.count_spaces || c != ' ');
            length += usize::from(counted);
            inside &= comments.close.is_empty() || !comments.close.ends_with(c);
        }
        length
    }

    /// Separator before every word but the first.
    #[inline]
    pub fn separate(&mut self) {
        if self.out.len() > self.words_start {
            self.out.extend_from_slice(&self.table.separator);
        }
    }

    /// A text among the words of a line.
    #[inline]
    pub fn text(&mut self, text: &[u8]) {
        if !text.is_empty() {
            self.separate();
            self.out.extend_from_slice(text);
        }
    }

    /// A word.
    #[inline]
    pub fn number(&mut self, format: &WordFormat, value: i64) {
        self.separate();
        self.out.extend_from_slice(&format.prefix);
        number::push(&mut self.out, value, &format.style);
        self.out.extend_from_slice(&format.suffix);
    }
}

pub(super) fn split_feed(feed: FeedWord) -> (usize, i64) {
    match feed {
        FeedWord::PerMinute(value) => (PER_MINUTE, value),
        FeedWord::PerRevolution(value) => (PER_REVOLUTION, value),
        FeedWord::InverseTime(value) => (INVERSE_TIME, value),
    }
}
