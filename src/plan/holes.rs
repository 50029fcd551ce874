//! Drilling cycles: a cycle begins in the CL data with its first hole, at the level it retracts to.

use super::Planner;
use crate::arena::Handle;
use crate::cl::{CycleKind, RecordKind};
use crate::geom::Point3;
use crate::ir::{DrillCycle, Origin};

/// The cycle in force.
#[derive(Debug)]
pub(super) struct Drilling {
    asked: DrillCycle,
    /// Surface of the holes since the cycle began in the CL data.
    open: Option<f64>,
}

impl Planner<'_> {
    pub(super) fn begin_cycle(&mut self, asked: &DrillCycle) {
        self.state.drilling = Some(Drilling { asked: *asked, open: None });
    }

    pub(super) fn end_cycle(&mut self, origin: Handle<Origin>) {
        self.close_cycle(origin);
        self.state.drilling = None;
    }

    /// Anything but a hole ends the cycle in the CL data; it stays in force.
    pub(super) fn close_cycle(&mut self, origin: Handle<Origin>) {
        if let Some(drilling) = &mut self.state.drilling
            && drilling.open.take().is_some()
        {
            self.emit(RecordKind::EndCycle, origin);
        }
    }

    pub(super) fn hole(&mut self, point: Point3, origin: Handle<Origin>) {
        let Some(drilling) = &self.state.drilling else { return };
        let (mut asked, open, fed) = (drilling.asked, drilling.open, drilling.asked.cycle.feed);
        if asked.own_feed || matches!(asked.cycle.kind, CycleKind::Tap { .. }) {
            if !self.turns("a hole", origin) {
                return;
            }
        } else {
            let Some(ready) = self.ready("a hole", None, origin) else { return };
            asked.cycle.feed = ready.feed;
        }
        if open != Some(point.z) || fed != asked.cycle.feed {
            self.close_cycle(origin);
            let level = point.z + asked.return_to.unwrap_or(asked.cycle.clearance);
            match self.state.height {
                Some(z) if z == level || z > level && asked.return_to.is_none() => {}
                // From above, over the hole and down: it is where the tool comes back to.
                Some(z) if z > level => {
                    self.rapid(Point3::new(point.x, point.y, z), origin);
                    self.rapid(Point3::new(point.x, point.y, level), origin);
                }
                _ => {
                    let over = self.state.at.unwrap_or(point);
                    self.rapid(Point3::new(over.x, over.y, level), origin);
                }
            }
            self.emit(RecordKind::BeginCycle(Box::new(asked.cycle)), origin);
            self.state.drilling = Some(Drilling { asked, open: Some(point.z) });
        }
        self.emit(RecordKind::Hole(point), origin);
        let level = point.z + asked.return_to.unwrap_or(asked.cycle.clearance);
        self.arrive(Point3::new(point.x, point.y, level));
    }

    /// The cutter is here.
    pub(super) fn arrive(&mut self, at: Point3) {
        self.state.at = Some(at);
        self.state.height = Some(at.z);
    }
}
