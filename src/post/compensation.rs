//! Cutter compensation: words that wait for the first straight move in X or Y, or blocks of their own.

use super::events::Events;
use super::motion::MotionBlock;
use super::pattern::{Item, Named};
use super::table::{WordFormat, word};
use super::writer::Writer;
use crate::diag::codes;
use crate::geom::Side;
use crate::ir::Compensation;
use crate::target::{axes, number};

/// What the control was told of it, and what it is still to be told.
#[derive(Debug, Clone, Default)]
pub(super) struct Compensating {
    /// Words of what is in force; empty at the start of the program.
    now: Vec<u8>,
    /// Words that wait for a move.
    due: Option<Vec<u8>>,
}

impl Writer<'_> {
    /// In the place of the pattern item `compensation`.
    #[inline]
    pub(super) fn compensation(&mut self, block: &MotionBlock) {
        if self.compensating.due.is_some() || self.table.compensation_every_move {
            self.say_compensation(block);
        }
    }

    fn say_compensation(&mut self, block: &MotionBlock) {
        let goes = |axis: u8, index: usize, to: i64| {
            block.axes & axis != 0 && self.state.axes.get(index).copied().flatten() != Some(to)
        };
        let across = goes(axes::X, 0, block.to.x) || goes(axes::Y, 1, block.to.y);
        if across && let Some(words) = self.compensating.due.take() {
            self.text(&words);
            self.compensating.now = words;
        } else if self.table.compensation_every_move {
            let words = core::mem::take(&mut self.compensating.now);
            self.text(&words);
            self.compensating.now = words;
        }
    }
}

impl Events<'_> {
    /// Nothing is in force at the start.
    pub(super) fn begin_compensation(&mut self) {
        self.writer.compensating.now = self.compensation_words(None);
    }

    /// It begins, or ends.
    pub(super) fn compensation(&mut self, on: Option<Compensation>) {
        let words = self.compensation_words(on);
        self.writer.compensating.due = (self.writer.compensating.now != words).then_some(words);
        if !self.writer.table.compensation_in_moves {
            self.due_compensation(&[]);
        }
    }

    /// What no move has ended ends here.
    pub(super) fn end_compensation(&mut self) {
        let alone = Item::all(&self.writer.dialect.spec.compensation.off_alone);
        self.due_compensation(&alone);
    }

    /// A block of what waits for a move, with the words of `alone` where there are some.
    fn due_compensation(&mut self, alone: &[Item]) {
        let Some(words) = self.writer.compensating.due.take() else { return };
        self.writer.begin_line(true);
        if alone.is_empty() {
            self.writer.text(&words);
        }
        for item in alone {
            if let Item::Text(text) = item {
                self.writer.text(text);
            }
        }
        self.writer.end_line();
        self.writer.compensating.now = words;
    }

    fn compensation_words(&mut self, on: Option<Compensation>) -> Vec<u8> {
        let dialect = self.writer.dialect;
        let rules = &dialect.spec.compensation;
        let (items, register) = match on {
            None => (&rules.off, None),
            Some(Compensation { side: Side::Left, register }) => (&rules.left, register),
            Some(Compensation { side: Side::Right, register }) => (&rules.right, register),
        };
        let format = word(&dialect.spec, "register", false, self.unit());
        let mut words = Vec::new();
        for item in Item::all(items) {
            let said = match item {
                Item::Text(text) => text.to_vec(),
                Item::Named(Named::Register) => {
                    register.map_or_else(Vec::new, |register| self.register(&format, register))
                }
                // Other items do not pass the check of the dialect.
                _ => continue,
            };
            if !words.is_empty() && !said.is_empty() {
                words.extend_from_slice(dialect.spec.line.separator.as_bytes());
            }
            words.extend(said);
        }
        words
    }

    fn register(&mut self, format: &WordFormat, register: u32) -> Vec<u8> {
        let range = self.writer.dialect.spec.range("register", self.unit());
        if i64::from(register) > range {
            let message = format!(
                "register {register} of the cutter's radius is over {range}, the last of this control"
            );
            self.error(&codes::post::WORD_RANGE, message);
        }
        let mut word = format.prefix.to_vec();
        number::push(&mut word, i64::from(register), &format.style);
        word
    }
}
