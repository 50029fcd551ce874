//! Drilling in NCI: 81 starts a cycle with its first hole, 100 is a further hole, anything else ends it.
//!
//! 81: kind, bottom (3), dwell, feed, first peck, further pecks, peck clearance, chip-break retract, initial height,
//! reference height, top of the stock, shift, point at the initial height (3), flags, 1 when the two points are swapped.
//! 100: compensation, bottom (3), initial height, reference height, dwell, feed, point at the initial height (3), flags,
//! 1 when swapped. The heights are along the tool's axis; the point at the initial height may be anywhere along it.

use super::cycle::{Asked, Return};
use super::reader::Reader;
use crate::cl::{Cycle, CycleKind, RetractTo};
use crate::diag::codes::foreign as codes;
use crate::geom::{Point3, Vec3};
use crate::ir::{Feed, Spindle};

/// Heights that differ by less, mm, are one.
const SAME: f64 = 1e-6;

/// What a cycle keeps from its first hole on; lengths as in the file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Drilling {
    kind: f64,
    pecks: [f64; 2],
    top: f64,
    shift: f64,
}

/// A hole: numbers that both records have.
#[derive(Debug, Clone, Copy)]
struct Hole {
    bottom: [f64; 3],
    above: [f64; 3],
    initial: f64,
    reference: f64,
    dwell: f64,
    feed: f64,
}

impl Reader<'_> {
    /// Code 81.
    pub(super) fn nci_first_hole(&mut self, n: &[f64]) {
        self.leave_cycle();
        self.state.drilling = None;
        let [kind, x, y, z, dwell, feed, first, next, _, _, initial, reference, top, shift, u, v, w, ..] = *n
        else {
            return self.nci_no_cycle(|r| r.nci_short(81, 17, n.len()));
        };
        let swapped = n.get(18) == Some(&1.0);
        let (bottom, above) = ends([x, y, z], [u, v, w], swapped);
        let drilling = Drilling { kind, pecks: [first, next], top, shift };
        self.state.drilling = Some(drilling);
        self.nci_hole(drilling, Hole { bottom, above, initial, reference, dwell, feed });
    }

    /// Code 100.
    pub(super) fn nci_next_hole(&mut self, n: &[f64]) {
        if self.state.cycle_failed {
            return;
        }
        let Some(drilling) = self.state.drilling else {
            let message = "a further hole (100) without the cycle it belongs to (81)".to_owned();
            return self.complain(&codes::BAD_CYCLE, message);
        };
        let [_, x, y, z, initial, reference, dwell, feed, u, v, w, ..] = *n else {
            return self.nci_no_cycle(|r| r.nci_short(100, 11, n.len()));
        };
        let (bottom, above) = ends([x, y, z], [u, v, w], n.get(12) == Some(&1.0));
        self.nci_hole(drilling, Hole { bottom, above, initial, reference, dwell, feed });
    }

    /// The holes that follow are not drilled either.
    fn nci_no_cycle(&mut self, complain: impl FnOnce(&mut Self)) {
        self.state.cycle_failed = true;
        complain(self);
    }

    fn nci_hole(&mut self, drilling: Drilling, hole: Hole) {
        let (Some(bottom), Some(above)) = (self.point(hole.bottom), self.point(hole.above)) else { return };
        let up: Vec3 = above - bottom;
        if up.norm() > SAME {
            self.state.axis = up.normalize();
        }
        if self.off_axis() {
            return;
        }
        match self.nci_asked(&drilling, &hole, up.norm()) {
            Ok(asked) => {
                let surface = Point3::new(bottom.x, bottom.y, bottom.z + asked.depth());
                self.state.moved = true;
                self.ask(asked);
                self.hole(surface);
            }
            Err(message) => self.nci_no_cycle(|r| r.complain(&codes::BAD_CYCLE, message)),
        }
    }

    fn nci_asked(&mut self, drilling: &Drilling, hole: &Hole, height: f64) -> Result<Asked, String> {
        let scale = self.state.scale;
        let [initial, reference, top] = [hole.initial, hole.reference, drilling.top].map(|v| v * scale);
        let depth = height + top - initial;
        if depth.is_nan() || depth <= SAME {
            return Err(format!("the hole's bottom is {} mm above the top of the stock", -depth + 0.0));
        }
        let clearance = reference - top;
        if clearance.is_nan() || clearance < 0.0 || initial < reference - SAME {
            return Err(
                "the heights of the cycle are not in order: initial, reference, top of stock".to_owned()
            );
        }
        if hole.feed > 0.0 {
            self.set_feed_number(hole.feed);
        }
        let feed = self.state.feed.ok_or("the cycle has no feed")?;
        let dwell = Some(hole.dwell).filter(|s| *s > 0.0);
        let (peck, first_peck) = drilling.pecks(scale);
        let kind = self.nci_kind(drilling, dwell.is_some(), peck.is_some(), feed)?;
        let back = initial - reference > SAME;
        let (retract, return_to) = match back {
            true => (RetractTo::Initial, Return::Above(initial - top)),
            false => (RetractTo::Clearance, Return::Clearance),
        };
        let cycle = Cycle { kind, depth, clearance, retract, peck, first_peck, dwell, feed };
        Asked::new(cycle, return_to)
    }

    fn nci_kind(
        &self,
        drilling: &Drilling,
        dwell: bool,
        pecks: bool,
        feed: Feed,
    ) -> Result<CycleKind, String> {
        let kind = match (drilling.kind as i64, dwell) {
            (0, false) => CycleKind::Drill,
            (0, true) => CycleKind::Dwell,
            (1, _) => CycleKind::Deep,
            (2, _) => CycleKind::ChipBreak,
            (3, _) => self.nci_tap(feed)?,
            (4, false) => CycleKind::Bore,
            (4, true) => CycleKind::BoreDwell,
            (5, _) => CycleKind::BoreStop,
            (6, _) if drilling.shift > 0.0 => {
                CycleKind::BoreOrient { shift: drilling.shift * self.state.scale }
            }
            (6, _) => return Err("the fine boring cycle has no shift".to_owned()),
            (kind, _) => return Err(format!("the drilling cycle {kind} is one of the shop's own")),
        };
        match kind {
            CycleKind::Deep | CycleKind::ChipBreak if !pecks => {
                Err("the cycle has no depth of a peck".to_owned())
            }
            kind => Ok(kind),
        }
    }

    fn nci_tap(&self, feed: Feed) -> Result<CycleKind, String> {
        match (feed, self.state.spindle) {
            (Feed::PerMinute(feed), Some(Spindle::On { rpm, clockwise, .. })) if rpm > 0.0 => {
                Ok(CycleKind::Tap { pitch: feed / rpm, left: !clockwise })
            }
            _ => Err("tapping has no pitch: it takes a feed and a turning spindle".to_owned()),
        }
    }
}

impl Drilling {
    /// Depth of the pecks but the first, and of the first where it differs, mm.
    fn pecks(&self, scale: f64) -> (Option<f64>, Option<f64>) {
        let [first, next] = self.pecks.map(|v| Some(v * scale).filter(|v| *v > 0.0));
        match (first, next) {
            (Some(first), Some(next)) if (first - next).abs() > SAME => (Some(next), Some(first)),
            (first, next) => (next.or(first), None),
        }
    }
}

/// Bottom and top of a hole.
fn ends(bottom: [f64; 3], above: [f64; 3], swapped: bool) -> ([f64; 3], [f64; 3]) {
    if swapped { (above, bottom) } else { (bottom, above) }
}
