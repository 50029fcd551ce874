//! The frame of a program: percent signs, program numbers, ends.

use super::block::{Block, bit};
use super::machine::Machine;
use super::rules::Frame;
use crate::readback::Follow;
use crate::readback::out::Out;

/// What of the program's frame has been seen.
#[derive(Debug, Default)]
pub(super) struct Seen {
    blocks: u32,
    percents: u32,
    closed: bool,
}

impl Machine<'_> {
    /// Percent signs and program numbers; `true` when the block is nothing else.
    pub(super) fn framed<S: Follow>(&mut self, block: &Block, out: &mut Out<'_, S>) -> bool {
        if block.percent {
            self.frame.percents = self.frame.percents.saturating_add(1);
            if self.frame.blocks > 0 && self.frame.percents == 1 && self.rules.frame != Frame::Free {
                out.fault("'%' inside the program without one at its start");
            }
            self.frame.closed = self.frame.percents > 1;
            return true;
        }
        if block.is_empty() {
            return false;
        }
        if self.frame.closed {
            out.fault("a block after the closing '%'");
        }
        let first = self.frame.blocks == 0;
        self.frame.blocks = self.frame.blocks.saturating_add(1);
        let number_only = block.seen == bit(b'O') && block.g.len() + block.m.len() == 0;
        match self.rules.frame {
            Frame::PercentAndNumber if first => self.program_number(block, out),
            Frame::OptionalNumber if first && number_only => self.number_range(block, 99_999.0, out),
            Frame::Name | Frame::PercentName if first => {
                if !block.name {
                    out.fault(match self.rules.frame {
                        Frame::PercentName => "the program does not start with '%' and its number",
                        _ => "the program does not start with its name, O and up to four letters and digits",
                    });
                } else if !number_only {
                    out.fault("words behind the program's name");
                }
                return block.name;
            }
            _ if block.has(b'O') => {
                out.fault("O words inside the program are not followed");
                return true;
            }
            _ => {}
        }
        first && number_only
    }

    fn program_number<S: Follow>(&mut self, block: &Block, out: &mut Out<'_, S>) {
        if self.frame.percents == 0 {
            out.fault("the program does not start with '%'");
        }
        if !block.has(b'O') {
            out.fault("the program has no O number");
        }
        self.number_range(block, 99_999_999.0, out);
    }

    fn number_range<S: Follow>(&self, block: &Block, largest: f64, out: &mut Out<'_, S>) {
        if let Some(o) = block.get(b'O').filter(|o| !(1.0..=largest).contains(o)) {
            out.fault(format!("program number O{o} is not in 1 to {largest}"));
        }
    }

    /// What must be said when the text is over.
    pub(super) fn end_of_text<S: Follow>(&mut self, out: &mut Out<'_, S>) {
        self.nurbs_left_open(out);
        let percents = self.frame.percents;
        match self.rules.frame {
            Frame::PercentAndNumber if percents < 2 => out.fault("the program does not end with '%'"),
            Frame::PercentPairOrEnd | Frame::OptionalNumber if percents == 1 => {
                out.fault("the file starts with '%' and does not end with one")
            }
            _ => {}
        }
        let needs_end = match self.rules.frame {
            Frame::PercentAndNumber
            | Frame::OptionalNumber
            | Frame::Name
            | Frame::PercentName
            | Frame::End => true,
            Frame::PercentPairOrEnd => percents == 0,
            // The control would wait for more, which is fine unless the spindle turns.
            Frame::Free => self.state.direction != 0.0,
        };
        if !self.state.ended && needs_end {
            out.fault(if self.rules.frame == Frame::Free {
                "the text ends with the spindle turning"
            } else {
                "the program has no M2 or M30 at its end"
            });
        }
    }
}
