//! Coordinate systems: `MSYS/`, `CSYS/`, `MCS/`, `TRNTYP/`.
//!
//! Points are in the coordinate system in force. One for the whole file is the work's own; another one later would need the
//! work moved or turned, which a program for three axes cannot do.

use super::grammar::Statement;
use super::reader::Reader;
use crate::diag::codes::foreign as codes;

/// Difference of two systems that is rounding, in the file's unit and in components of directions.
const SAME: f64 = 1e-6;

impl Reader<'_> {
    pub(super) fn frame(&mut self, s: &Statement) {
        if s.major() == "TRNTYP" {
            // Points are in the part's own system, whatever systems the operations have.
            self.state.world |= s.has("WORLD");
            if s.numbers().iter().any(|v| *v != 0.0) {
                let message = "TRNTYP cannot be carried out: it shifts the coordinates";
                self.soften(&codes::NOT_CARRIED_OUT, message.to_owned(), None);
            }
            return;
        }
        self.frame_numbers(s.major(), &s.numbers());
    }

    pub(super) fn frame_numbers(&mut self, word: &str, numbers: &[f64]) {
        let mut frame = [0.0; 12];
        if !matches!(numbers.len(), 9 | 12) {
            let message = format!("{word} takes 9 or 12 numbers, not {}", numbers.len());
            return self.complain(&codes::BAD_RECORD, message);
        }
        for (slot, value) in frame.iter_mut().zip(numbers) {
            *slot = *value;
        }
        let differs =
            self.state.frame.is_some_and(|old| old.iter().zip(&frame).any(|(a, b)| (a - b).abs() > SAME));
        if differs && self.state.moved && !self.state.world && !self.state.frame_told {
            self.state.frame_told = true;
            let message = format!("{word} changes the coordinate system after the first point");
            let help = "write a file for each coordinate system".to_owned();
            self.soften(&codes::NOT_CARRIED_OUT, message, Some(help));
        }
        self.state.frame = Some(frame);
    }
}
