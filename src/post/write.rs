//! A whole target program to text.

use crate::arena::Arena;
use crate::diag::Diagnostic;
use crate::diag::codes;
use crate::ir::Origin;
use crate::target::{Block, BlockKind, TargetProgram};

use super::dialect::Dialect;
use super::events::{Carry, Events};
use super::table::MotionTable;
use super::writer::{LineFault, Writer};

/// An NC program and where its lines come from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// The text, as it goes to the file.
    pub text: String,
    /// For every block of the target program, its first line (from 1) and one past its last; an empty range
    /// when nothing was printed.
    pub lines: Vec<(u32, u32)>,
}

/// Bytes of a motion block, about.
const BYTES_PER_BLOCK: usize = 32;

/// Writes `program` in `dialect`; `origins` are those that the program's blocks refer to.
///
/// # Errors
/// Lines longer than the control takes, numbers out of a word's range, texts that cannot be written, templates
/// that fail; each with the place in the source it comes from.
pub fn write(
    dialect: &Dialect,
    program: &TargetProgram,
    origins: &Arena<Origin>,
) -> Result<Written, Vec<Diagnostic>> {
    Parts::new(dialect).part(program, origins)
}

/// Writes a program part by part.
#[derive(Debug)]
pub struct Parts<'d> {
    dialect: &'d Dialect,
    carry: Option<Carry>,
}

impl<'d> Parts<'d> {
    /// Nothing is written yet.
    #[must_use]
    pub fn new(dialect: &'d Dialect) -> Parts<'d> {
        Parts { dialect, carry: None }
    }

    /// The text of the next part; lines are counted from the start of the program.
    ///
    /// # Errors
    /// As [`write()`].
    pub fn part(
        &mut self,
        program: &TargetProgram,
        origins: &Arena<Origin>,
    ) -> Result<Written, Vec<Diagnostic>> {
        let (written, carry) = part(self.dialect, program, origins, self.carry.take())?;
        self.carry = carry;
        Ok(written)
    }
}

fn part(
    dialect: &Dialect,
    program: &TargetProgram,
    origins: &Arena<Origin>,
    before: Option<Carry>,
) -> Result<(Written, Option<Carry>), Vec<Diagnostic>> {
    let Some(first) = program.blocks.first() else {
        return Ok((Written { text: String::new(), lines: Vec::new() }, before));
    };
    let table = MotionTable::new(dialect, &program.capabilities);
    let writer = Writer::new(dialect, table, first.origin, program.blocks.len() * BYTES_PER_BLOCK + 1024);
    let mut events = Events::new(writer, program, origins);
    if let Some(before) = before {
        events.resume(before);
    }
    let lines = program.blocks.iter().enumerate().map(|(index, block)| events.block(index, block)).collect();
    let carry = events.carry();
    let mut writer = events.into_writer();
    let faults = core::mem::take(&mut writer.faults);
    writer.errors.extend(faults.iter().map(|fault| too_long(dialect, fault, origins)));
    if !writer.errors.is_empty() {
        return Err(writer.errors);
    }
    // Prefixes, texts and numbers are all ASCII.
    let text = String::from_utf8(writer.out)
        .unwrap_or_else(|error| String::from_utf8_lossy(error.as_bytes()).into_owned());
    Ok((Written { text, lines }, Some(carry)))
}

impl Events<'_> {
    /// Writes a block; gives its lines.
    fn block(&mut self, index: usize, block: &Block) -> (u32, u32) {
        self.writer.origin = block.origin;
        let first = self.writer.line + 1;
        match &block.kind {
            BlockKind::Motion(crate::target::Motion::Nurbs { curve, feed }) => self.nurbs(*curve, *feed),
            BlockKind::Motion(motion) => self.writer.motion(motion),
            _ => self.event(index, &block.kind),
        }
        (first, self.writer.line + 1)
    }
}

fn too_long(dialect: &Dialect, fault: &LineFault, origins: &Arena<Origin>) -> Diagnostic {
    let limit = dialect.spec().line.max_length;
    let message =
        format!("{} takes lines of {limit} characters, this one has {}", dialect.title(), fault.length);
    crate::ir::at_origin(&codes::post::LINE_TOO_LONG, origins, fault.origin, message)
        .note(format!("the line is `{}`", fault.text))
}
