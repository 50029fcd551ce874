//! `CYCLE/`: drilling cycles.

use super::Analyser;
use super::matched::{Matched, Typed};
use crate::diag::Diagnostic;
use crate::diag::codes::semantics as codes;
use crate::ir::{Cycle, CycleKind, RetractTo};
use crate::ir::{DrillCycle, Feed, StepKind};

impl Analyser<'_> {
    pub(super) fn drill_cycle(&mut self, m: &Matched) {
        if m.word("state") == Some("OFF") {
            if core::mem::take(&mut self.state.cycle) {
                self.step(StepKind::EndCycle);
            }
            return;
        }
        let feed = self.feed_of_cycle(m);
        let Some(kind) = self.kind_of_cycle(m, feed) else { return };
        let (Some(depth), Some(clearance)) = (m.number("depth"), m.number("clearance")) else { return };
        let peck = m.number("peck");
        if matches!(kind, CycleKind::Deep | CycleKind::ChipBreak) && peck.is_none() {
            return self.lacks(m, "DEEP and BRKCHP need the depth of a peck", "add it: `STEP, 4`");
        }
        self.words_of_other_cycles(m, kind);
        let return_to = m.number("return").filter(|r| *r > clearance);
        let retract = if return_to.is_some() { RetractTo::Initial } else { RetractTo::Clearance };
        let dwell = m.number("dwell").filter(|s| *s > 0.0);
        let own_feed = feed.is_some();
        let feed = feed.unwrap_or(Feed::PerMinute(0.0));
        let cycle = Cycle { kind, depth, clearance, retract, peck, first_peck: None, dwell, feed };
        self.state.cycle = true;
        self.state.cycle_feeds = own_feed || matches!(kind, CycleKind::Tap { .. });
        self.step(StepKind::BeginCycle(Box::new(DrillCycle { cycle, own_feed, return_to })));
    }

    fn feed_of_cycle(&mut self, m: &Matched) -> Option<Feed> {
        let quantity = |f: &super::matched::Found| match f.typed {
            Typed::Quantity(q) => Some((q, f.span)),
            _ => None,
        };
        let (q, at) = m.all("feed").find_map(quantity)?;
        self.feed(q, m.word("feed"), at)
    }

    fn kind_of_cycle(&mut self, m: &Matched, feed: Option<Feed>) -> Option<CycleKind> {
        let dwells = m.number("dwell").is_some_and(|s| s > 0.0);
        Some(match m.word("kind")? {
            "FACE" => CycleKind::Dwell,
            "DRILL" if dwells => CycleKind::Dwell,
            "DEEP" => CycleKind::Deep,
            "BRKCHP" => CycleKind::ChipBreak,
            "BORE" | "REAM" if dwells => CycleKind::BoreDwell,
            "BORE" | "REAM" => CycleKind::Bore,
            "TAP" => {
                let pitch = match (m.number("pitch"), feed) {
                    (Some(pitch), _) | (None, Some(Feed::PerRevolution(pitch))) => pitch,
                    _ => {
                        self.lacks(m, "TAP needs its pitch", "add it: `PITCH, 1.25`");
                        return None;
                    }
                };
                CycleKind::Tap { pitch, left: m.word("hand") == Some("LEFT") }
            }
            _ => CycleKind::Drill,
        })
    }

    /// What the kind of cycle does not do is not left out in silence.
    fn words_of_other_cycles(&mut self, m: &Matched, kind: CycleKind) {
        let pecks = matches!(kind, CycleKind::Deep | CycleKind::ChipBreak);
        let tap = matches!(kind, CycleKind::Tap { .. });
        let kind = m.word("kind").unwrap_or_default();
        for (slot, word, fits, whose) in [
            ("peck", "STEP", pecks, "DEEP and BRKCHP have pecks"),
            ("pitch", "PITCH", tap, "TAP has a pitch"),
            ("hand", "LEFT", tap, "TAP has a hand"),
        ] {
            if let (Some(found), false) = (m.get(slot), fits) {
                let message = format!("{kind} and {word} exclude each other: {whose}");
                self.report(Diagnostic::new(&codes::WORDS_EXCLUDE, found.span, message));
            }
        }
    }

    fn lacks(&mut self, m: &Matched, message: &str, help: &str) {
        self.report(Diagnostic::new(&codes::MISSING_VALUE, m.word, message).help(help));
    }
}
