//! The word-address family: blocks of letters with numbers (ISO 6983 and what controls made of it).
//!
//! A control is a row of [`rules::Rules`] with its two code tables; the interpreter is one. A machine that is none of them
//! says what it does otherwise in [`stated`].

use super::out::Out;
use super::{Follow, MachineSetup};

mod arc;
mod block;
mod codes;
mod compensation;
mod controls;
mod cubic;
mod cycle;
mod frame;
mod iso;
mod machine;
mod motion;
mod nurbs;
mod renamed;
mod rules;
mod sinumerik;
mod state;
mod stated;

use renamed::Renamed;

pub(super) use controls::CONTROLS;
pub(super) use stated::Stated;
pub use stated::{Statement, statements};

#[cfg(test)]
mod tests;

/// The control that a text names, with what the machine says of itself; `None` where the name is none of this family.
///
/// # Errors
/// The first statement that means nothing.
pub(super) fn find(control: &str) -> Option<Result<Stated, String>> {
    stated::read(control)
}

/// Reads lines and executes them.
#[derive(Debug)]
pub(super) struct Reader<'a> {
    machine: machine::Machine<'a>,
    block: block::Block,
    renamed: Vec<Renamed>,
}

impl<'a> Reader<'a> {
    /// A control as it stands after power-on.
    pub(super) fn new(stated: Stated, setup: &'a MachineSetup) -> Self {
        let Stated { rules, renamed } = stated;
        Reader { machine: machine::Machine::new(rules, setup), block: block::Block::default(), renamed }
    }

    /// Executes a line without its end.
    pub(super) fn line<S: Follow>(&mut self, line: &[u8], out: &mut Out<'_, S>) {
        let rules = &self.machine.rules;
        let read = match rules.language {
            rules::Language::Iso => block::read,
            rules::Language::Sinumerik => sinumerik::read,
        };
        let line = if rules.line_end == 0 { line } else { without_end(line, rules.line_end, out) };
        read(line, rules, &mut self.block, &mut |message| out.fault(message));
        if !self.renamed.is_empty() {
            self.block.rename(&self.renamed, &mut |message| out.fault(message));
        }
        if let Some(limit) = rules.line_limit.filter(|limit| self.block.length > *limit) {
            out.fault(format!("the line has {} characters, the control takes {limit}", self.block.length));
        }
        self.machine.execute(&self.block, out);
    }

    /// The text is over.
    pub(super) fn finish<S: Follow>(&mut self, out: &mut Out<'_, S>) {
        self.machine.end_of_text(out);
    }
}

/// The line up to the character that ends it.
fn without_end<'l, S: Follow>(line: &'l [u8], end: u8, out: &mut Out<'_, S>) -> &'l [u8] {
    let name = char::from(end);
    let body = line.trim_ascii_end();
    if body.is_empty() || body == b"%" {
        return line;
    }
    let Some(body) = body.strip_suffix(&[end]) else {
        out.fault(format!("the line does not end with `{name}`"));
        return line;
    };
    if body.contains(&end) {
        out.fault(format!("`{name}` ends the block before the end of its line"));
    }
    body
}
