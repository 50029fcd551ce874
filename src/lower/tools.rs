//! Tool numbers.

use crate::arena::{Arena, Handle};
use crate::cl::{Cl, RecordKind};
use crate::ir::Tool;

/// The tools of a program in order of first use, each with its number.
#[derive(Debug, Default)]
pub(super) struct Tools {
    handles: Vec<Handle<Tool>>,
    pub list: Vec<Tool>,
}

impl Tools {
    /// Tools without a number of their own get the smallest that nobody has.
    pub fn of(cl: &Cl) -> Tools {
        let loads = cl.records.iter().filter_map(|record| match record.kind {
            RecordKind::LoadTool(handle) => Some(handle),
            _ => None,
        });
        Tools::of_loads(loads, &cl.tools)
    }

    /// The same, from the tool changes in order.
    pub fn of_loads(loads: impl Iterator<Item = Handle<Tool>>, arena: &Arena<Tool>) -> Tools {
        let mut tools = Tools::default();
        for handle in loads {
            if !tools.handles.contains(&handle) {
                tools.handles.push(handle);
                tools.list.push(arena[handle].clone());
            }
        }
        let mut next = 1;
        for index in 0..tools.list.len() {
            if tools.list[index].number.is_none() {
                while tools.list.iter().any(|t| t.number == Some(next)) {
                    next += 1;
                }
                tools.list[index].number = Some(next);
            }
        }
        tools
    }

    /// Index of a tool in the list.
    pub fn index(&self, handle: Handle<Tool>) -> u32 {
        let index = self.handles.iter().position(|h| *h == handle).unwrap_or(0);
        u32::try_from(index).unwrap_or(0)
    }
}
