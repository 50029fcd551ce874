//! Drilling cycles that the control keeps: calls from templates, holes from a pattern.

use minijinja::value::{Serde, Value};

use super::context::CycleContext;
use super::events::Events;
use super::pattern::Slot;
use super::writer::split_feed;
use crate::cl::{CycleKind, RetractTo};
use crate::diag::codes;
use crate::target::number::{self, Style};
use crate::target::{Cycle, Position};

impl Events<'_> {
    /// Prints what stands before the first hole, and keeps what goes into its block.
    pub(super) fn begin_cycle(&mut self, index: u32) {
        let Some(cycle) = self.program.cycles.get(index as usize).copied() else { return };
        self.end_compensation();
        let name = cycle.kind.name().text();
        let Some(rules) = self.writer.dialect.spec.cycles.get(name).filter(|c| c.enabled) else {
            // Lowering keeps only the cycles that the dialect has.
            let message = format!("the post has no cycle `{name}`");
            return self.error(&codes::post::BAD_PATTERN, message);
        };
        self.home_plane();
        self.cycle_feed_mode(&cycle);
        let Some(context) = self.cycle_context(&cycle) else { return };
        let path = |key: &str| format!("cycles.{name}.{key}");
        self.template(&path("before"), &rules.before, &context);
        self.writer.cycle = [
            self.words(&path("call"), &rules.call, &context),
            self.words(&path("words"), &rules.words, &context),
        ];
        self.writer.state.motion = None;
        self.writer.state.axes[0] = None;
        self.writer.state.axes[1] = None;
        self.cycle = Some(index);
    }

    pub(super) fn hole(&mut self, at: Position) {
        let Some(cycle) = self.open_cycle() else { return };
        self.writer.hole(at, cycle.after());
    }

    /// Whatever the cycle left on is said again after it.
    pub(super) fn end_cycle(&mut self) {
        let Some(cycle) = self.open_cycle() else { return };
        self.cycle = None;
        let Some(context) = self.cycle_context(&cycle) else { return };
        let name = cycle.kind.name().text();
        if let Some(rules) = self.writer.dialect.spec.cycles.get(name) {
            self.template(&format!("cycles.{name}.end"), &rules.end, &context);
        }
        self.writer.cycle = [Vec::new(), Vec::new()];
        self.writer.state.motion = None;
        self.writer.state.feed = None;
    }

    fn open_cycle(&self) -> Option<Cycle> {
        self.cycle.and_then(|index| self.program.cycles.get(index as usize).copied())
    }

    fn cycle_feed_mode(&mut self, cycle: &Cycle) {
        let (mode, _) = split_feed(cycle.feed);
        if self.writer.state.mode != Some(mode) {
            let code = self.writer.table.modes[mode].clone();
            if !code.is_empty() {
                self.writer.begin_line(true);
                self.writer.text(&code);
                self.writer.end_line();
            }
            self.writer.state.mode = Some(mode);
        }
    }

    fn cycle_context(&mut self, cycle: &Cycle) -> Option<Value> {
        let grid = &self.program.capabilities.grid;
        let level = self.writer.table.words[Slot::Z as usize].style;
        let distance = Style { plus: false, ..level };
        let mm = |mm: f64| number::steps(mm / grid.unit.in_mm(), grid.linear_decimals);
        let shift = if let CycleKind::BoreOrient { shift } = cycle.kind { mm(shift) } else { None };
        let pitch = match cycle.kind {
            CycleKind::Tap { pitch, .. } => {
                fine(pitch / grid.unit.in_mm(), grid.linear_decimals, &distance).unwrap_or_default()
            }
            _ => String::new(),
        };
        let whole = cycle.clearance - cycle.bottom;
        let pecks = matches!(cycle.kind, CycleKind::Deep | CycleKind::ChipBreak);
        let peck = cycle.peck.or_else(|| pecks.then_some(whole));
        let dwells = matches!(cycle.kind, CycleKind::Dwell | CycleKind::BoreDwell);
        let optional = |steps: Option<i64>| steps.map_or_else(String::new, |s| spelled(s, &distance));
        let rules = &self.writer.dialect.spec.cycle_dwell;
        let dwell = match cycle.dwell.or_else(|| dwells.then_some(0.0)) {
            None => None,
            Some(seconds) => Some(self.dwell_number(seconds, rules.unit, rules.decimals, rules.max)?),
        };
        let mut dwell_style = super::table::word(&self.writer.dialect.spec, "dwell", false, grid.unit).style;
        dwell_style.decimals = rules.decimals;
        let (mode, feed) = split_feed(cycle.feed);
        let mut context = self.context();
        context.cycle = Some(CycleContext {
            kind: cycle.kind.name().text(),
            z: spelled(cycle.bottom, &level),
            r: spelled(cycle.clearance, &level),
            surface: spelled(cycle.surface, &level),
            initial: spelled(cycle.initial, &level),
            after: spelled(cycle.after(), &level),
            depth: spelled(cycle.surface - cycle.bottom, &distance),
            clearance: spelled(cycle.clearance - cycle.surface, &distance),
            above: spelled(cycle.initial - cycle.surface, &distance),
            peck: optional(peck),
            pecks: peck
                .filter(|p| *p > 0)
                .map_or_else(String::new, |p| ((whole + p - 1) / p).max(1).to_string()),
            shift: optional(shift),
            pitch,
            dwell: dwell.map_or_else(String::new, |steps| spelled(steps, &dwell_style)),
            feed: spelled(feed, &self.writer.table.feeds[mode].style),
            retract: match cycle.retract {
                RetractTo::Clearance => "clearance",
                RetractTo::Initial => "initial",
            },
            rpm: self.speed,
        });
        Some(Value::from(Serde(context)))
    }
}

/// A pitch in a word's spelling: with up to five decimals, where it needs them, since it adds up over the whole thread (32
/// threads an inch are 0.03125).
fn fine(value: f64, least: u8, style: &Style) -> Option<String> {
    const FINEST: u8 = 5;
    let mut decimals = least.max(FINEST);
    let mut steps = number::steps(value, decimals)?;
    while decimals > least && steps % 10 == 0 {
        (steps, decimals) = (steps / 10, decimals - 1);
    }
    Some(spelled(steps, &Style { decimals, ..*style }))
}

/// A number in a word's spelling, without its prefix.
fn spelled(steps: i64, style: &Style) -> String {
    let mut out = Vec::with_capacity(16);
    number::push(&mut out, steps, style);
    String::from_utf8(out).unwrap_or_default()
}
