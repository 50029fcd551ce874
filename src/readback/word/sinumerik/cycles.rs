//! `MCALL CYCLE8x(…)`: positions after it are drilled, until a bare `MCALL`. `CYCLE832` sets the path tolerance.

use super::super::block::Block;
use super::super::codes::CycleKind;
use super::super::cycle::Hole;
use super::super::machine::Machine;
use super::Call;
use crate::readback::out::Out;
use crate::readback::{FeedMode, Follow};

/// A cycle that every position calls.
#[derive(Debug, Clone)]
pub(in crate::readback) struct Modal {
    hole: Hole,
    /// Feed in and out, mm/min, where the cycle has its own.
    feeds: Option<(f64, f64)>,
    /// Pitch, mm, and speed, rev/min, negative counter-clockwise, of a tap.
    tap: Option<(f64, f64)>,
}

impl Machine<'_> {
    /// Calls of the block; `true` when the block is over with them.
    pub(in crate::readback::word) fn calls<S: Follow>(
        &mut self,
        block: &Block,
        out: &mut Out<'_, S>,
    ) -> bool {
        let Some(words) = &block.words else { return false };
        let call = words.call.as_ref();
        match (words.modal_call, call) {
            (true, None) => self.modal_cycle = None,
            (true, Some(call)) => {
                if self.modal_cycle.is_some() {
                    out.fault("a modal call inside another");
                }
                self.modal_cycle = self.called(call, out);
            }
            (false, Some(call)) if call.name == "CYCLE832" => self.tolerance(call),
            (false, Some(call)) if call.name.starts_with("CYCLE8") => {
                if let Some(modal) = self.called(call, out) {
                    self.drill_here(&modal, out);
                }
            }
            (false, Some(call)) if matches!(call.name.as_str(), "WORKPIECE" | "FGROUP") => {}
            (false, Some(call)) => out.fault(format!("{} is not followed by this reader", call.name)),
            (false, None) => return false,
        }
        true
    }

    /// `CYCLE832(tolerance, mode)`: 0 switches it off.
    fn tolerance(&mut self, call: &Call) {
        let value = call.arguments.first().copied().flatten().unwrap_or(0.0);
        let off = call.arguments.get(1).copied().flatten() == Some(0.0) || value == 0.0;
        self.state.path_stated = true;
        self.state.path_tolerance = if off { 0.0 } else { value * self.unit() };
        self.state.contour_tolerance = (!off).then(|| value * self.unit());
    }

    /// The cycle of a call.
    fn called<S: Follow>(&mut self, call: &Call, out: &mut Out<'_, S>) -> Option<Modal> {
        let u = self.unit();
        let raw = |i: usize| call.arguments.get(i).copied().flatten();
        let length = |i: usize| raw(i).map(|v| v * u);
        let kind = match call.name.as_str() {
            "CYCLE81" => CycleKind::Drill,
            "CYCLE82" => CycleKind::Dwell,
            "CYCLE83" if raw(11) == Some(1.0) => CycleKind::Deep,
            "CYCLE83" => CycleKind::ChipBreak,
            "CYCLE84" => CycleKind::Tap { left: raw(8).is_some_and(|p| p < 0.0) },
            "CYCLE85" => CycleKind::Bore,
            "CYCLE86" => CycleKind::Fine,
            "CYCLE89" => CycleKind::BoreDwell,
            name => {
                out.fault(format!("{name} is not followed by this reader"));
                return None;
            }
        };
        let (Some(back), Some(surface)) = (length(0), length(1)) else {
            out.fault(format!("{} without RTP and RFP", call.name));
            return None;
        };
        // The safety clearance has no sign, nor has the depth relative to the surface.
        let r = surface + length(2).unwrap_or(0.0).abs();
        let Some(z) = length(4).map(|d| surface - d.abs()).filter(|_| raw(4) != Some(0.0)).or(length(3))
        else {
            out.fault(format!("alarm 61101, {} without DP and DPR", call.name));
            return None;
        };
        if z >= surface || back < surface {
            out.fault(format!(
                "alarm 61101, reference point: RFP {} must lie over the bottom {} and not over RTP {}",
                surface / u,
                z / u,
                back / u
            ));
            return None;
        }
        let dwell = raw(if call.name == "CYCLE83" { 8 } else { 5 }).unwrap_or(0.0);
        let dwell = if call.name == "CYCLE81" { 0.0 } else { self.seconds_or_turns(dwell, out) };
        let mut hole = Hole { kind, r, z, back, peck: None, from: surface, clearance: 1.0, dwell };
        if let CycleKind::Deep | CycleKind::ChipBreak = kind {
            self.pecks_of(call, &mut hole, surface, out)?;
        }
        let feeds = length(6).zip(length(7)).filter(|_| call.name == "CYCLE85");
        let tap = self.tap(call, kind, out);
        Some(Modal { hole, feeds, tap })
    }

    /// Negative dwells count revolutions.
    fn seconds_or_turns<S: Follow>(&self, dwell: f64, out: &mut Out<'_, S>) -> f64 {
        if dwell >= 0.0 {
            return dwell;
        }
        if self.state.speed <= 0.0 {
            out.fault("a dwell in revolutions without a spindle speed");
            return 0.0;
        }
        -dwell * 60.0 / self.state.speed
    }

    /// First depth and its decrease. Only equal pecks are followed.
    fn pecks_of<S: Follow>(
        &self,
        call: &Call,
        hole: &mut Hole,
        surface: f64,
        out: &mut Out<'_, S>,
    ) -> Option<()> {
        let u = self.unit();
        let raw = |i: usize| call.arguments.get(i).copied().flatten();
        let first = raw(6).filter(|v| *v != 0.0).map(|v| v.abs() * u).or(raw(5).map(|v| surface - v * u));
        let Some(first) =
            first.filter(|f| *f > 0.0 && (surface - hole.z) / f <= super::super::cycle::MOST_PECKS)
        else {
            out.fault("alarm 61107, CYCLE83 without a first depth FDEP or FDPR");
            return None;
        };
        if raw(7).is_some_and(|d| d != 0.0) {
            out.fault("CYCLE83 with a degression DAM, which this reader does not follow");
            return None;
        }
        hole.peck = Some(first);
        let back = if hole.kind == CycleKind::ChipBreak { raw(14) } else { raw(16) };
        hole.clearance = back.filter(|v| *v > 0.0).map_or(1.0, |v| v * u);
        Some(())
    }

    /// Speed of a tap: SST, turning as the pitch's sign says.
    fn tap<S: Follow>(&self, call: &Call, kind: CycleKind, out: &mut Out<'_, S>) -> Option<(f64, f64)> {
        let CycleKind::Tap { left } = kind else { return None };
        let raw = |i: usize| call.arguments.get(i).copied().flatten();
        let Some((pitch, speed)) = raw(8).zip(raw(10)) else {
            out.fault("CYCLE84 without the pitch PIT and the speed SST");
            return None;
        };
        Some((pitch.abs() * self.unit(), if left { -speed } else { speed }))
    }

    /// Drills where the tool is, if a modal call asks for it.
    pub(in crate::readback::word) fn drill_after_move<S: Follow>(&mut self, out: &mut Out<'_, S>) {
        if let Some(modal) = self.modal_cycle.clone() {
            self.drill_here(&modal, out);
        }
    }

    fn drill_here<S: Follow>(&mut self, modal: &Modal, out: &mut Out<'_, S>) {
        let kept = (self.state.feed, self.state.feed_mode, self.state.speed, self.state.direction);
        if self.state.feed_mode == Some(FeedMode::InverseTime) {
            return out.fault("a drilling cycle under G93");
        }
        if let Some((pitch, speed)) = modal.tap {
            self.state.speed = speed.abs();
            self.state.direction = speed.signum();
            self.state.feed = Some(pitch * speed.abs());
            self.state.feed_mode = Some(FeedMode::PerMinute);
        }
        if let Some((feed, _)) = modal.feeds {
            self.state.feed = Some(feed);
        }
        if self.cut_is_ready(out) {
            self.state.in_call = true;
            self.drill_down(&modal.hole, modal.feeds.map(|(_, back)| back), out);
            self.state.in_call = false;
        }
        (self.state.feed, self.state.feed_mode, self.state.speed, self.state.direction) = kept;
    }
}
