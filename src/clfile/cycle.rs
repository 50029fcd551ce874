//! Drilling cycles: `CYCLE/` in its variants. A `GOTO` after it is a hole, until `CYCLE/ OFF`.

use super::grammar::{Arg, Statement};
use super::reader::Reader;
use crate::cl::{Cycle, CycleKind, RecordKind, RetractTo};
use crate::diag::codes::foreign as codes;
use crate::geom::Point3;
use crate::ir::{Feed, Spindle};

/// A cycle as asked for; lengths in mm.
#[derive(Debug, Clone)]
pub(super) struct Asked {
    cycle: Cycle,
    /// Retract level above the hole's point.
    return_to: Option<f64>,
    /// The feed is given in the record, not by `FEDRAT`.
    own_feed: bool,
    /// Surface of the holes since the cycle's begin in the CL data.
    open: Option<f64>,
}

/// Words that change the kind of a cycle or carry a number, by meaning.
const DEPTH: &[&str] = &["FEDTO", "DEPTH"];
const CLEARANCE: &[&str] = &["RAPTO", "CLEAR", "CLEARP"];
const RETURN: &[&str] = &["RTRCTO", "RETURN", "RETRCT"];
const PECK: &[&str] = &["STEP", "STEP1", "SUBPECK", "PECK", "INCR", "INCREM"];
const FIRST_PECK: &[&str] = &["1STPECK"];
const FEEDS: &[&str] = &["MMPM", "IPM", "MMPR", "IPR", "PERMIN", "PERREV"];
const SILENT: &[&str] = &["ON", "TOOL", "SYNC", "MANUAL", "AUTO", "NONE", "THRU", "RPM", "CLW"];

impl Reader<'_> {
    pub(super) fn cycle(&mut self, s: &Statement) {
        let Some(word) = s.words().next().map(str::to_owned) else {
            return self.complain(&codes::BAD_CYCLE, "CYCLE takes the kind of cycle, or OFF".to_owned());
        };
        match word.as_str() {
            "OFF" | "NOMORE" => self.leave_cycle(),
            "INIT" => {}
            "ON" if self.state.cycle.is_some() => {}
            _ => self.begin_asked(&word, s),
        }
    }

    fn begin_asked(&mut self, word: &str, s: &Statement) {
        self.leave_cycle();
        match self.asked(word, s) {
            Ok(asked) => self.state.cycle = Some(asked),
            Err(message) => self.complain(&codes::BAD_CYCLE, message),
        }
    }

    fn asked(&mut self, word: &str, s: &Statement) -> Result<Asked, String> {
        let scale = self.state.scale;
        let value = |words: &[&str]| words.iter().find_map(|w| s.after(w)).map(|v| v * scale);
        self.known_words(word, s)?;
        let bare = bare_numbers(s);
        let depth = value(DEPTH).or_else(|| bare.first().map(|v| v * scale)).map(f64::abs);
        let depth = depth.filter(|d| *d > 0.0).ok_or("the cycle has no depth: FEDTO or DEPTH")?;
        let spare = if value(DEPTH).is_some() { 0 } else { 1 };
        let last = bare.get(spare..).and_then(<[f64]>::last).map(|v| v * scale);
        let clearance = value(CLEARANCE).or(last).filter(|c| *c >= 0.0);
        let clearance = clearance.ok_or("the cycle has no clearance: RAPTO or CLEAR")?;
        let (feed, own_feed) = self.cycle_feed(s);
        let dwell = self.cycle_dwell(s);
        let kind = self.kind(word, s, dwell, feed)?;
        let peck = value(PECK).filter(|p| *p > 0.0);
        let first_peck = value(FIRST_PECK).filter(|p| *p > 0.0);
        if matches!(kind, CycleKind::Deep | CycleKind::ChipBreak) && peck.is_none() {
            return Err("the cycle has no depth of cut: STEP or SUBPECK".to_owned());
        }
        let return_to = value(RETURN).filter(|r| *r > clearance);
        let retract = if return_to.is_some() { RetractTo::Initial } else { RetractTo::Clearance };
        let feed = feed.unwrap_or(Feed::PerMinute(0.0));
        let cycle = Cycle { kind, depth, clearance, retract, peck, first_peck, dwell, feed };
        Ok(Asked { cycle, return_to, own_feed, open: None })
    }

    /// A word that nobody knows may change the hole.
    fn known_words(&mut self, kind: &str, s: &Statement) -> Result<(), String> {
        let lists = [DEPTH, CLEARANCE, RETURN, PECK, FIRST_PECK, FEEDS, SILENT];
        let rest = ["DWELL", "REV", "PITCH", "LEFT", "CCLW", "DRAG", "NODRAG", "ORIENT", "CSINK"];
        let known = |w: &str| w == kind || rest.contains(&w) || lists.iter().any(|l| l.contains(&w));
        match s.words().find(|w| !known(w)) {
            Some(word) => Err(format!("the cycle has a word that is not known: {word}")),
            None => Ok(()),
        }
    }

    fn kind(
        &self,
        word: &str,
        s: &Statement,
        dwell: Option<f64>,
        feed: Option<Feed>,
    ) -> Result<CycleKind, String> {
        Ok(match word {
            "DRILL" | "THRU" | "CSINK" if dwell.is_none() => CycleKind::Drill,
            "DRILL" | "THRU" | "CSINK" | "FACE" | "SPOTFC" | "SPTFAC" | "CBORE" | "COUNTR" => {
                CycleKind::Dwell
            }
            "DEEP" | "DEEP2" | "PECK" => CycleKind::Deep,
            "BRKCHP" | "BRKCHIP" | "BREAK" | "CHPBRK" | "CHIP" => CycleKind::ChipBreak,
            "TAP" => CycleKind::Tap { pitch: self.pitch(s, feed)?, left: s.has("LEFT") || s.has("CCLW") },
            "BORE" if s.has("NODRAG") || s.has("ORIENT") => {
                let shift = s.after("ORIENT").or_else(|| s.after("NODRAG"));
                let shift = shift.ok_or("the cycle has no distance to move off the wall: ORIENT")?;
                CycleKind::BoreOrient { shift: shift * self.state.scale }
            }
            "BORE" | "REAM" if dwell.is_some() => CycleKind::BoreDwell,
            "BORE" | "REAM" => CycleKind::Bore,
            other => return Err(format!("the cycle {other} is not known")),
        })
    }

    fn pitch(&self, s: &Statement, feed: Option<Feed>) -> Result<f64, String> {
        if let Some(pitch) = s.after("PITCH") {
            return Ok(pitch * self.state.scale);
        }
        let speed = match self.state.spindle {
            Some(Spindle::On { rpm, .. }) => Some(rpm),
            _ => None,
        };
        match (feed.or(self.state.feed), speed) {
            (Some(Feed::PerRevolution(pitch)), _) => Ok(pitch),
            (Some(Feed::PerMinute(feed)), Some(rpm)) => Ok(feed / rpm),
            _ => {
                Err("tapping has no pitch: a feed per revolution, or a feed and a turning spindle".to_owned())
            }
        }
    }

    fn cycle_feed(&mut self, s: &Statement) -> (Option<Feed>, bool) {
        for word in FEEDS {
            // Behind its word, or two bare numbers before it: depth and feed.
            let value = s.after(word).filter(|v| *v > 0.0).or_else(|| before(s, word));
            if let Some(value) = value {
                return (self.feed_of(value, &[word]), true);
            }
        }
        (self.state.feed, false)
    }

    fn cycle_dwell(&self, s: &Statement) -> Option<f64> {
        let seconds = match (s.after("DWELL"), s.after("REV"), self.state.spindle) {
            (Some(seconds), ..) => seconds,
            (None, Some(turns), Some(Spindle::On { rpm, .. })) => turns * 60.0 / rpm,
            _ => return None,
        };
        (seconds > 0.0 && seconds < 1e6).then_some(seconds)
    }

    /// A point while a cycle is in force.
    pub(super) fn hole(&mut self, point: Point3) {
        let Some(asked) = self.state.cycle.clone() else { return };
        if asked.open != Some(point.z) {
            self.open_cycle(asked, point);
        }
        self.emit(RecordKind::Hole(point));
        let level =
            self.state.cycle.as_ref().map_or(point.z, |a| point.z + a.return_to.unwrap_or(a.cycle.clearance));
        self.state.at = Some(Point3::new(point.x, point.y, level));
    }

    /// Starts the cycle in the CL data at its retract level.
    fn open_cycle(&mut self, mut asked: Asked, point: Point3) {
        self.close_cycle();
        self.ready_to_drill(&mut asked);
        let level = point.z + asked.return_to.unwrap_or(asked.cycle.clearance);
        self.make_sure();
        match self.state.at {
            Some(at) if at.z < level => self.emit(RecordKind::Rapid(Point3::new(at.x, at.y, level))),
            Some(_) => {}
            None => {
                self.emit(RecordKind::Rapid(Point3::new(point.x, point.y, level)));
                self.state.sure = true;
            }
        }
        self.emit(RecordKind::BeginCycle(Box::new(asked.cycle)));
        asked.open = Some(point.z);
        self.state.cycle = Some(asked);
    }

    fn ready_to_drill(&mut self, asked: &mut Asked) {
        self.begin_operation();
        if self.state.load.is_some() || self.state.loaded.is_none() {
            self.flush_tool();
        }
        if !self.state.spindle_recorded {
            self.record_spindle();
        }
        if !asked.own_feed && !matches!(asked.cycle.kind, CycleKind::Tap { .. }) {
            match self.state.feed {
                Some(feed) => asked.cycle.feed = feed,
                None => self.lacks("FEDRAT"),
            }
        }
    }

    fn close_cycle(&mut self) {
        if let Some(asked) = &mut self.state.cycle
            && asked.open.take().is_some()
        {
            self.emit(RecordKind::EndCycle);
        }
    }

    /// A move between holes; the cycle stays in force.
    pub(super) fn pause_cycle(&mut self) {
        self.close_cycle();
    }

    /// The cycle ends.
    pub(super) fn leave_cycle(&mut self) {
        self.close_cycle();
        self.state.cycle = None;
    }
}

/// Numbers that stand behind no word, or behind the kind: depth, and clearance at the end.
fn bare_numbers(s: &Statement) -> Vec<f64> {
    let mut out = Vec::new();
    let mut taken = true;
    for (index, arg) in s.args.iter().enumerate() {
        match arg {
            Arg::Number(v) if !taken || index == 1 => {
                out.push(*v);
                taken = false;
            }
            // The number behind a word is the word's.
            Arg::Number(_) => taken = false,
            _ => taken = true,
        }
    }
    out
}

/// The second of two bare numbers before a word.
fn before(s: &Statement, word: &str) -> Option<f64> {
    let at = s.args.iter().position(|a| matches!(a, Arg::Word(w) if w == word))?;
    match (s.args.get(at.checked_sub(2)?)?, s.args.get(at.checked_sub(1)?)?) {
        (Arg::Number(_), Arg::Number(feed)) => Some(*feed),
        _ => None,
    }
}
