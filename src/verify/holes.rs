//! Drilled holes: the moves of each against the cycle that asked for it.
//!
//! A hole may be a cycle of the control or moves written out; both read back as moves, and both must be over the hole
//! before they go down, go down at feed only, in pecks no deeper than asked, reach the bottom and not more, dwell, leave
//! as the kind of cycle says and end at its level.

use super::finding::{Finding, Text};
use super::state::{FEED_TOLERANCE, feed_step};
use super::{ACCURACY, Case, Happening};
use crate::cl::{Cycle, CycleKind, RecordKind, RetractTo};
use crate::diag::codes::verification as codes;
use crate::geom::Point3;
use crate::ir::Feed;
use crate::readback::{EventKind, TraceMove};

/// How far a dwell's time may be off, s: rounding of its word.
pub(super) const DWELL_TOLERANCE: f64 = 0.006;

/// Checks all holes of the CL data.
pub(super) fn all(case: &Case<'_>) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut cycle: Option<&Cycle> = None;
    let mut initial = None;
    for (index, record) in case.cl.records.iter().enumerate() {
        match &record.kind {
            RecordKind::BeginCycle(begun) => {
                cycle = Some(begun);
                initial = None;
            }
            RecordKind::EndCycle => cycle = None,
            RecordKind::Hole(point) => {
                let Some(cycle) = cycle else { continue };
                let happenings = case.of_record(index);
                let surface = point.z + cycle.clearance;
                let from = first_height(happenings).map(|z| z.max(surface));
                initial = initial.or(from);
                let levels = Levels::new(case, cycle, *point, initial.unwrap_or(surface));
                findings.extend(one(case, cycle, *point, &levels, happenings, index));
            }
            _ => {}
        }
    }
    findings
}

fn first_height(happenings: &[Happening<'_>]) -> Option<f64> {
    happenings.iter().find_map(|h| if let EventKind::Move(cut) = h.kind { Some(cut.z.0) } else { None })
}

/// Heights of a hole, mm.
struct Levels {
    clearance: f64,
    bottom: f64,
    after: f64,
    near: f64,
}

impl Levels {
    fn new(case: &Case<'_>, cycle: &Cycle, point: Point3, initial: f64) -> Self {
        let clearance = point.z + cycle.clearance;
        let after = if cycle.retract == RetractTo::Initial { initial } else { clearance };
        let near = case.target.capabilities.grid.linear_step() + ACCURACY;
        Levels { clearance, bottom: point.z - cycle.depth, after, near }
    }
}

fn one(
    case: &Case<'_>,
    cycle: &Cycle,
    point: Point3,
    levels: &Levels,
    happenings: &[Happening<'_>],
    record: usize,
) -> Vec<Finding> {
    let mut follower = Follower {
        case,
        cycle,
        point,
        levels,
        reached: levels.clearance,
        pecks: 0,
        dwelt: 0.0,
        lifted: true,
        last: None,
        findings: Vec::new(),
    };
    for happening in happenings {
        match happening.kind {
            EventKind::Move(cut) => follower.step(happening, cut),
            EventKind::Dwell(seconds) => follower.dwelt += seconds,
            _ => {}
        }
    }
    follower.finish(record)
}

struct Follower<'a> {
    case: &'a Case<'a>,
    cycle: &'a Cycle,
    point: Point3,
    levels: &'a Levels,
    /// Lowest height reached at feed.
    reached: f64,
    pecks: u32,
    dwelt: f64,
    /// The tool has been out of the hole (or back by a little) since the last peck.
    lifted: bool,
    last: Option<(&'a Happening<'a>, f64)>,
    findings: Vec<Finding>,
}

impl<'a> Follower<'a> {
    fn say(&mut self, happening: &Happening<'_>, text: Text) {
        self.findings.push(Finding::new(&codes::NOT_FOLLOWED, happening.line, happening.block, text));
    }

    fn step(&mut self, happening: &'a Happening<'a>, cut: &TraceMove) {
        let (from, to) = (cut.start(), cut.end());
        let near = self.levels.near;
        let known = cut.known[0] && cut.known[1];
        let across = known && (to.xy() - from.xy()).norm() > ACCURACY;
        if across && (!cut.rapid || from.z.min(to.z) < self.levels.clearance - near) {
            self.say(
                happening,
                Text::default().words("the hole is approached below its clearance level or at feed"),
            );
        }
        if !((to.xy() - self.point.xy()).norm() <= near) && (!cut.rapid || to.z < from.z - ACCURACY) {
            let text = Text::default().words("a hole at ").point(to.x, to.y).words(" in place of ");
            self.say(happening, text.point(self.point.x, self.point.y));
        }
        match (cut.rapid, to.z < from.z - ACCURACY) {
            (true, true) => self.rapid_down(happening, to.z),
            (false, true) => self.feed_down(happening, cut),
            (_, false) => self.up(happening, cut),
        }
        self.last = Some((happening, to.z));
    }

    fn rapid_down(&mut self, happening: &Happening<'_>, z: f64) {
        if z < self.reached - self.levels.near {
            let text = Text::default().words("a rapid down to Z ").length(z);
            self.say(happening, text.words("; the hole is open to Z ").length(self.reached));
        }
    }

    fn feed_down(&mut self, happening: &Happening<'_>, cut: &TraceMove) {
        let z = cut.z.1;
        if z < self.reached - ACCURACY {
            self.peck(happening, z);
        }
        self.feed(happening, cut);
    }

    fn peck(&mut self, happening: &Happening<'_>, z: f64) {
        // What lies above the surface is air.
        let depth = self.reached.min(self.point.z) - z;
        let pecked = matches!(self.cycle.kind, CycleKind::Deep | CycleKind::ChipBreak);
        let most = self.cycle.first_peck.filter(|_| self.pecks == 0).or(self.cycle.peck);
        if let Some(most) = most.filter(|most| pecked && depth > most + self.levels.near) {
            let text = Text::default().words("a peck of ").length(depth).words(" in place of ");
            self.say(happening, text.length(most));
        }
        if self.pecks > 0 && !self.lifted {
            self.say(happening, Text::default().words("two pecks without a retract between them"));
        }
        if self.pecks > 0 && !pecked {
            self.say(happening, Text::default().words("a hole in pecks, which the cycle does not ask for"));
        }
        self.pecks += 1;
        self.lifted = false;
        self.reached = z;
    }

    fn up(&mut self, happening: &Happening<'_>, cut: &TraceMove) {
        let (from, to) = cut.z;
        let in_hole = from < self.levels.clearance - self.levels.near;
        if !in_hole {
            return;
        }
        let at_bottom = (from - self.levels.bottom).abs() <= self.levels.near;
        self.lifted |= to >= self.levels.clearance - self.levels.near
            || (self.cycle.kind == CycleKind::ChipBreak && to > from);
        if !at_bottom {
            return;
        }
        let (at_feed, spindle) = match self.cycle.kind {
            CycleKind::Tap { left, .. } => (Some(true), Some(if left { 1.0 } else { -1.0 })),
            CycleKind::Bore | CycleKind::BoreDwell => (Some(true), None),
            // With the spindle stopped a feed out is as good as a rapid.
            CycleKind::BoreStop | CycleKind::BoreOrient { .. } => (None, Some(0.0)),
            _ => (Some(false), None),
        };
        if at_feed == Some(cut.rapid) {
            let way = if cut.rapid { "at rapid" } else { "at feed" };
            self.say(happening, Text::default().words(format!("the tool leaves the hole {way}")));
        }
        if spindle.is_some_and(|sense| sense != sign(cut.spindle)) {
            let text = format!("the tool leaves the hole at {:.1} rev/min", cut.spindle);
            self.say(happening, Text::default().words(text));
        }
        if let (CycleKind::Tap { .. }, false) = (self.cycle.kind, cut.rapid) {
            self.feed(happening, cut);
        }
    }

    /// The feed into the hole; a tap's is pitch times speed.
    fn feed(&mut self, happening: &Happening<'_>, cut: &TraceMove) {
        let wanted = match (self.cycle.kind, self.cycle.feed) {
            (CycleKind::Tap { pitch, .. }, _) => pitch * cut.spindle.abs(),
            (_, Feed::PerRevolution(f)) => f * cut.spindle.abs(),
            (_, Feed::PerMinute(f)) => f,
            (_, Feed::PerTooth(_)) => return,
        };
        let got = cut.feed.unwrap_or(0.0);
        if !((got - wanted).abs() <= FEED_TOLERANCE * wanted + feed_step(self.case)) {
            let text =
                Text::default().words("a hole is cut at ").feed(got).words(" in place of ").feed(wanted);
            self.findings.push(Finding::new(&codes::WRONG_FEED, happening.line, happening.block, text));
        }
        if let CycleKind::Tap { left, .. } = self.cycle.kind
            && cut.z.1 < cut.z.0
            && sign(cut.spindle) != if left { -1.0 } else { 1.0 }
        {
            self.say(
                happening,
                Text::default().words("the tap goes in with the spindle turning the other way"),
            );
        }
    }

    fn finish(mut self, record: usize) -> Vec<Finding> {
        let text = Text::default();
        let Some((happening, z)) = self.last else {
            let block = self.case.block_of_record(record);
            let place = text.words("the hole at ").point(self.point.x, self.point.y).words(" is not drilled");
            return vec![Finding::new(&codes::NOT_FOLLOWED, 0, block, place)];
        };
        if !((self.reached - self.levels.bottom).abs() <= self.levels.near) {
            let text =
                Text::default().words("the hole ends at Z ").length(self.reached).words(" in place of ");
            self.say(happening, text.length(self.levels.bottom));
        }
        if !((z - self.levels.after).abs() <= self.levels.near) {
            let text =
                Text::default().words("the tool is at Z ").length(z).words(" after the hole in place of ");
            self.say(happening, text.length(self.levels.after));
        }
        let asked = self.cycle.dwell.unwrap_or(0.0);
        if !((self.dwelt - asked).abs() <= DWELL_TOLERANCE) {
            let text = format!("a dwell of {:.3} s in a hole in place of {asked:.3} s", self.dwelt);
            self.say(happening, Text::default().words(text));
        }
        self.findings
    }
}

fn sign(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value.signum() }
}
