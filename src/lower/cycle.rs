//! Drilling cycles: kept where the control has them, else the moves they stand for.
//!
//! The moves are those of the word-address controls: over the hole at the level the cutter is on, but not below the
//! clearance level; at rapid to the clearance level; the hole; at rapid to the clearance or the initial level. Pecks
//! count from the clearance level.

use super::emit::Emitter;
use super::feed;
use crate::cl::{Cycle, CycleKind, RetractTo};
use crate::diag::codes;
use crate::geom::Point3;
use crate::ir::{CycleName, Feed, Spindle, at_origin};
use crate::target::{self, BlockKind, FeedWord, Position, axes};

/// How far a peck is backed out to break the chip, and how far above the last peck rapid ends, mm.
const PECK_GAP: f64 = 0.5;
/// Pecks of one hole at most.
const MOST_PECKS: i64 = 10_000;

/// The cycle in force.
#[derive(Debug, Clone, Copy)]
pub(super) struct Active {
    cycle: Cycle,
    /// Z when it began, if known.
    initial: Option<i64>,
    /// Index of the target cycle that is open.
    open: Option<usize>,
    /// It has been said that its moves are written out.
    told: bool,
    /// It has been said that the spindle turns against its hand.
    hand_told: bool,
}

/// Levels of a hole, Z steps.
#[derive(Debug, Clone, Copy)]
struct Hole {
    x: i64,
    y: i64,
    surface: i64,
    bottom: i64,
    clearance: i64,
    initial: i64,
}

impl Emitter<'_> {
    /// A cycle comes into force; nothing moves.
    pub(super) fn begin_cycle(&mut self, cycle: &Cycle) {
        self.end_cycle();
        self.ends_compensation("a drilling cycle");
        self.cycle =
            Some(Active { cycle: *cycle, initial: self.at[2], open: None, told: false, hand_told: false });
    }

    /// The cycle ends.
    pub(super) fn end_cycle(&mut self) {
        self.close_cycle();
        self.cycle = None;
    }

    pub(super) fn close_cycle(&mut self) {
        if let Some(active) = &mut self.cycle
            && active.open.take().is_some()
        {
            self.event(BlockKind::EndCycle);
        }
    }

    /// One hole.
    pub(super) fn hole(&mut self, point: Point3) {
        let Some(active) = self.cycle else { return };
        let cycle = active.cycle;
        let [x, y, surface] = self.round(point);
        let bottom = self.linear(point.z - cycle.depth);
        let clearance = self.linear(point.z + cycle.clearance);
        let initial = active.initial.unwrap_or(clearance).max(clearance);
        let hole = Hole { x, y, surface, bottom, clearance, initial };
        let Some(feed) = self.cycle_feed(&cycle) else { return };
        self.turns_with_tap(&cycle);
        if self.keeps(&cycle) {
            self.keep(active, hole, feed);
        } else {
            self.expand(&cycle, hole, feed);
        }
        self.exact = Some(Point3::new(point.x, point.y, self.mm(self.at[2].unwrap_or(hole.initial))));
    }

    /// A tap goes in the way that its spindle turns, or not at all. CL text says what it was told.
    fn turns_with_tap(&mut self, cycle: &Cycle) {
        let (CycleKind::Tap { left, .. }, Some(Spindle::On { clockwise, .. })) = (cycle.kind, self.spinning)
        else {
            return;
        };
        if left != clockwise || self.capabilities.whole_points {
            return;
        }
        // Once for all holes of the cycle.
        let Some(active) = self.cycle.as_mut().filter(|active| !active.hand_told) else { return };
        active.hand_told = true;
        let (hand, sense, other) =
            if left { ("left", "clockwise", "CCLW") } else { ("right", "counter-clockwise", "CLW") };
        let message = format!("the tap is {hand}-hand, and the spindle turns {sense}");
        let help = format!("put `SPINDL/ …, {other}` before it");
        let code = &codes::lowering::TAP_HAND;
        self.complain_of(at_origin(code, &self.cl.origins, self.origin, message).help(help));
    }

    /// Whether the control has the cycle, with its dwell if there is one, and nothing turns under it.
    fn keeps(&self, cycle: &Cycle) -> bool {
        let name = cycle.kind.name();
        let dwells = cycle.dwell.is_some_and(|s| s > 0.0);
        let may_dwell = matches!(name, CycleName::Dwell | CycleName::BoreDwell)
            || self.capabilities.dwelling_cycles.contains(&name);
        self.capabilities.cycles.contains(&name)
            && self.capabilities.rotary.is_none()
            && (!dwells || may_dwell)
    }

    fn mm(&self, steps: i64) -> f64 {
        steps as f64 * self.capabilities.grid.linear_step()
    }

    /// Feed into the hole; a tap's is pitch times speed.
    fn cycle_feed(&mut self, cycle: &Cycle) -> Option<FeedWord> {
        let wanted = match cycle.kind {
            CycleKind::Tap { pitch, .. } => Feed::PerRevolution(pitch),
            _ => cycle.feed,
        };
        match feed::per_minute(Some(wanted), self.rpm)
            .and_then(|value| feed::minute_word(value, self.capabilities))
        {
            Ok(word) => Some(word),
            Err(trouble) => {
                self.feed_trouble(&trouble);
                None
            }
        }
    }

    fn keep(&mut self, active: Active, hole: Hole, feed: FeedWord) {
        let cycle = active.cycle;
        let open = active.open.and_then(|i| self.cycles.get(i)).copied();
        let same = open.is_some_and(|c| c.surface == hole.surface && c.feed == feed);
        if !same {
            self.close_cycle();
            self.lift(&cycle, &hole);
            let step = self.capabilities.grid.linear_step();
            let initial = self.at[2].unwrap_or(hole.initial);
            let peck = self.one_peck(&cycle).map(|p| ((p / step).round() as i64).max(1));
            let index = self.cycles.len();
            self.cycles.push(target::Cycle {
                kind: cycle.kind,
                surface: hole.surface,
                bottom: hole.bottom,
                clearance: hole.clearance,
                initial,
                retract: cycle.retract,
                peck,
                dwell: cycle.dwell,
                feed,
            });
            self.event(BlockKind::BeginCycle(u32::try_from(index).unwrap_or(u32::MAX)));
            if let Some(active) = &mut self.cycle {
                active.open = Some(index);
            }
        }
        let turn = self.cartesian_turn();
        let position = Position { x: hole.x, y: hole.y, z: hole.surface, r: turn };
        self.check_place(&[position, Position { z: hole.bottom, ..position }]);
        self.event(BlockKind::Hole(position));
        let after = match cycle.retract {
            RetractTo::Clearance => hole.clearance,
            RetractTo::Initial => self.cycles.last().map_or(hole.initial, |c| c.initial),
        };
        self.at = [Some(hole.x), Some(hole.y), Some(after), self.at[3]];
    }

    /// Depth of all pecks of a cycle that is kept: the least that is asked for.
    fn one_peck(&mut self, cycle: &Cycle) -> Option<f64> {
        let peck = cycle.peck?;
        let Some(first) = cycle.first_peck.filter(|f| (f - peck).abs() > 1e-9) else { return Some(peck) };
        let least = first.min(peck);
        let message = format!(
            "the cycle has one depth of cut: {least} mm for all pecks in place of {first} mm for the first and {peck} mm for the others"
        );
        // Once for all cycles alike.
        if self.pecks_told.replace((first, peck)) != Some((first, peck)) {
            self.complain(&codes::lowering::ONE_PECK, message);
        }
        Some(least)
    }

    /// Up to the level at which the cutter goes over the next hole, if it is below.
    fn lift(&mut self, cycle: &Cycle, hole: &Hole) {
        let least = match cycle.retract {
            RetractTo::Clearance => hole.clearance,
            RetractTo::Initial => hole.initial,
        };
        if self.at[2].is_none_or(|z| z < least) {
            self.rapid_axes(Position { z: least, ..self.here() }, axes::Z);
        }
    }

    /// The moves of a cycle that the control does not have.
    fn expand(&mut self, cycle: &Cycle, hole: Hole, feed: FeedWord) {
        let (name, post) = (cycle.kind.name().text(), &self.capabilities.name);
        let refused = matches!(cycle.kind, CycleKind::Tap { .. } | CycleKind::BoreOrient { .. });
        let with = if !self.capabilities.cycles.contains(&cycle.kind.name()) {
            ""
        } else if self.capabilities.rotary.is_some() {
            " beside a rotary axis"
        } else {
            " with a dwell"
        };
        let (code, end) = if refused {
            (&codes::lowering::NO_CYCLE, ", and no moves can stand for it")
        } else {
            (&codes::lowering::CYCLE_EXPANDED, ": its moves are written out")
        };
        let message = format!("`{post}` has no cycle `{name}`{with}{end}");
        // Once for all holes of the cycle.
        if let Some(active) = self.cycle.as_mut().filter(|a| !a.told) {
            active.told = true;
            self.complain(code, message);
        }
        if refused {
            return;
        }
        self.lift(cycle, &hole);
        let turn = self.cartesian_turn();
        let over = Position { x: hole.x, y: hole.y, z: hole.clearance, r: turn };
        self.rapid(over);
        match cycle.kind {
            CycleKind::Deep | CycleKind::ChipBreak => self.pecks(cycle, over, hole, feed),
            _ => self.line(Position { z: hole.bottom, ..over }, feed),
        }
        if let Some(seconds) = cycle.dwell.filter(|s| *s > 0.0) {
            self.event(BlockKind::Dwell(seconds));
        }
        self.leave(cycle, over, hole, feed);
    }

    fn leave(&mut self, cycle: &Cycle, over: Position, hole: Hole, feed: FeedWord) {
        let stopped = matches!(cycle.kind, CycleKind::BoreStop);
        if stopped {
            self.event(BlockKind::Spindle(Spindle::Off));
        }
        if matches!(cycle.kind, CycleKind::Bore | CycleKind::BoreDwell) {
            self.line(over, feed);
        }
        let z = if cycle.retract == RetractTo::Initial { hole.initial } else { hole.clearance };
        self.rapid_axes(Position { z, ..over }, axes::Z);
        if let (true, Some(on)) = (stopped, self.spinning) {
            self.event(BlockKind::Spindle(on));
        }
    }

    /// Down peck by peck, counted from the clearance level.
    fn pecks(&mut self, cycle: &Cycle, over: Position, hole: Hole, feed: FeedWord) {
        let step = self.capabilities.grid.linear_step();
        let whole = hole.clearance - hole.bottom;
        let least = (whole / MOST_PECKS).max(1);
        let peck = cycle.peck.map_or(whole, |p| (p / step).round() as i64).max(least);
        let gap = ((PECK_GAP / step).round() as i64).min(peck);
        let first = cycle.first_peck.map_or(peck, |p| (p / step).round() as i64).max(least);
        let mut z = hole.clearance;
        loop {
            let deeper = if z == hole.clearance { first } else { peck };
            z = (z - deeper).max(hole.bottom);
            self.line(Position { z, ..over }, feed);
            if z <= hole.bottom {
                return;
            }
            if cycle.kind == CycleKind::Deep {
                self.rapid_axes(over, axes::Z);
            }
            self.rapid_axes(Position { z: (z + gap).min(hole.clearance), ..over }, axes::Z);
        }
    }
}
