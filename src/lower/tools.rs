//! Tool numbers, and how high the program goes with each tool.

use crate::arena::{Arena, Handle};
use crate::cl::{Cl, Record, RecordKind};
use crate::ir::Tool;

/// The tools of a program in order of first use, each with its number.
#[derive(Debug, Default)]
pub(super) struct Tools {
    handles: Vec<Handle<Tool>>,
    pub list: Vec<Tool>,
    /// Highest Z of the points between every tool change and the next, mm.
    pub heights: Vec<f64>,
}

/// What tool changes say of a program, record by record.
#[derive(Debug, Clone, Default)]
pub struct Changes {
    /// The tools, each once, in the order in which they are first changed in.
    pub loads: Vec<Handle<Tool>>,
    /// Highest Z of the points between every tool change and the next, mm.
    pub heights: Vec<f64>,
}

impl Changes {
    /// The next record of the program.
    pub fn record(&mut self, record: &Record) {
        let z = match &record.kind {
            RecordKind::LoadTool(tool) => {
                if !self.loads.contains(tool) {
                    self.loads.push(*tool);
                }
                return self.heights.push(f64::NEG_INFINITY);
            }
            RecordKind::From(p) | RecordKind::Rapid(p) | RecordKind::Linear(p) => p.z,
            RecordKind::Contour(contour) => contour.clearance,
            _ => return,
        };
        if let Some(height) = self.heights.last_mut() {
            *height = height.max(z);
        }
    }
}

impl Tools {
    /// Tools without a number of their own get the smallest that nobody has.
    pub fn of(cl: &Cl) -> Tools {
        let mut changes = Changes::default();
        cl.records.iter().for_each(|record| changes.record(record));
        Tools::of_changes(&changes, &cl.tools)
    }

    /// The same, from the tool changes.
    pub fn of_changes(changes: &Changes, arena: &Arena<Tool>) -> Tools {
        let mut tools = Tools {
            list: changes.loads.iter().map(|handle| arena[*handle].clone()).collect(),
            handles: changes.loads.clone(),
            heights: changes.heights.clone(),
        };
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
