//! Lowering chunk by chunk, for CL data that are longer than memory should hold.

use super::emit::{self, Carry};
pub use super::tools::Changes;
use super::tools::Tools;
use crate::arena::Arena;
use crate::cl::Cl;
use crate::diag::Sink;
use crate::ir::Tool;
use crate::target::{Capabilities, TargetProgram};

/// Lowers the chunks of one program in order. Contours are not taken: they need the whole program.
#[derive(Debug)]
pub struct Stream {
    capabilities: Capabilities,
    carry: Option<Result<Carry, Tools>>,
}

impl Stream {
    /// For a program with these tool changes.
    #[must_use]
    pub fn new(capabilities: Capabilities, changes: &Changes, tools: &Arena<Tool>) -> Stream {
        let tools = Tools::of_changes(changes, tools);
        Stream { capabilities, carry: Some(Err(tools)) }
    }

    /// The blocks of the next chunk; `last` ends the program.
    pub fn chunk(&mut self, cl: &Cl, last: bool, sink: &mut Sink) -> TargetProgram {
        let carry = self.carry.take().unwrap_or_else(|| Err(Tools::default()));
        let (program, carry) = emit::chunk(cl, &self.capabilities, carry, last, sink);
        self.carry = Some(Ok(carry));
        program
    }
}
