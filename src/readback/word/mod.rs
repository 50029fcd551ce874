//! The word-address family: blocks of letters with numbers (ISO 6983 and what controls made of it).
//!
//! A control is a row of [`rules::Rules`] with its two code tables; the interpreter is one.

use super::out::Out;
use super::{Follow, MachineSetup};

mod arc;
mod block;
mod codes;
mod controls;
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

use renamed::Renamed;

pub(super) use controls::CONTROLS;

#[cfg(test)]
mod tests;

/// The control of this name, and the codes that stand behind it.
pub(super) fn find(control: &str) -> Option<(&'static rules::Rules, Vec<Renamed>)> {
    let (name, renamed) = renamed::split(control)?;
    CONTROLS.into_iter().find(|c| c.name == name).map(|rules| (rules, renamed))
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
    pub(super) fn new(rules: &'static rules::Rules, renamed: Vec<Renamed>, setup: &'a MachineSetup) -> Self {
        Reader { machine: machine::Machine::new(rules, setup), block: block::Block::default(), renamed }
    }

    /// Executes a line without its end.
    pub(super) fn line<S: Follow>(&mut self, line: &[u8], out: &mut Out<'_, S>) {
        let rules = self.machine.rules;
        let read = match rules.language {
            rules::Language::Iso => block::read,
            rules::Language::Sinumerik => sinumerik::read,
        };
        read(line, rules, &mut self.block, &mut |message| out.fault(message));
        if !self.renamed.is_empty() {
            self.block.rename(&self.renamed, &mut |message| out.fault(message));
        }
        if rules.line_limit.is_some_and(|limit| self.block.length > limit) {
            out.fault(format!(
                "the line has {} characters, the control takes {}",
                self.block.length,
                rules.line_limit.unwrap_or_default()
            ));
        }
        self.machine.execute(&self.block, out);
    }

    /// The text is over.
    pub(super) fn finish<S: Follow>(&mut self, out: &mut Out<'_, S>) {
        self.machine.end_of_text(out);
    }
}
