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
    return_to: Return,
    /// The feed is given in the record, not by `FEDRAT`.
    own_feed: bool,
    /// Surface of the holes since the cycle's begin in the CL data.
    open: Option<f64>,
}

/// Least depth of a hole or a peck, mm.
const LEAST_DEPTH: f64 = 0.001;
/// Longest dwell of a cycle, s.
const LONGEST_DWELL: f64 = 99_999.0;

/// Where the tool goes after a hole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Return {
    /// To the clearance level.
    Clearance,
    /// To where it was when the cycle began.
    Begin,
    /// To this height above the hole's point, mm.
    Above(f64),
}

impl Asked {
    /// A cycle with its feed; no peck is deeper than the hole.
    ///
    /// # Errors
    /// When depth or pecks are too small to be meant.
    pub(super) fn new(cycle: Cycle, return_to: Return) -> Result<Asked, String> {
        let depth = cycle.depth;
        if depth.is_nan() || depth < LEAST_DEPTH {
            return Err("the cycle's depth is 0: it would drill nothing".to_owned());
        }
        let within = |peck: Option<f64>| peck.map(|p| p.min(depth));
        let (peck, first_peck) = (within(cycle.peck), within(cycle.first_peck));
        if peck.into_iter().chain(first_peck).any(|p| p < LEAST_DEPTH) {
            return Err(format!("the cycle's pecks are less than {LEAST_DEPTH} mm deep"));
        }
        Ok(Asked { cycle: Cycle { peck, first_peck, ..cycle }, return_to, own_feed: true, open: None })
    }

    /// Depth below the hole's point, mm.
    pub(super) fn depth(&self) -> f64 {
        self.cycle.depth
    }

    /// Height of the tool after a hole on a surface at `z`, mm, coming from `at`.
    fn level(&self, z: f64, at: Option<Point3>) -> f64 {
        let clearance = z + self.cycle.clearance;
        match self.return_to {
            Return::Clearance => clearance,
            Return::Above(height) => z + height,
            Return::Begin => at.map_or(clearance, |at| at.z.max(clearance)),
        }
    }
}

/// Words that change the kind of a cycle or carry a number, by meaning.
pub(super) const DEPTH: &[&str] = &["FEDTO", "DEPTH"];
pub(super) const CLEARANCE: &[&str] = &["RAPTO", "CLEAR", "CLEARP"];
pub(super) const RETURN: &[&str] = &["RTRCTO", "RETURN", "RETRCT"];
pub(super) const PECK: &[&str] = &["STEP", "SUBPECK", "PECK", "INCR", "INCREM"];
pub(super) const FIRST_PECK: &[&str] = &["1STPECK", "STEP1"];
/// Pecks of NX, from the first on: the smallest of the further ones is taken for all of them.
pub(super) const NEXT_PECKS: &[&str] = &["STEP2", "STEP3", "STEP4", "STEP5", "STEP6", "STEP7"];
pub(super) const FEEDS: &[&str] = &["MMPM", "IPM", "MMPR", "IPR", "PERMIN", "PERREV"];
pub(super) const SILENT: &[&str] =
    &["ON", "TOOL", "SYNC", "AUTO", "NONE", "THRU", "RPM", "CLW", "FIX", "FLOAT", "RIGID"];
/// Other words, with a number or without.
pub(super) const OTHER: &[&str] = &["DWELL", "REV", "PITCH", "LEFT", "CCLW", "DRAG", "NODRAG", "ORIENT"];
/// Kinds of cycle by what they do.
pub(super) const KINDS: &[(&[&str], Action)] = &[
    (&["DRILL", "THRU", "CSINK", "SPOTDR"], Action::Drill),
    (&["FACE", "SPOTFC", "SPTFAC", "CBORE", "COUNTR"], Action::Face),
    (&["DEEP", "DEEP2", "DEEPHL", "PECK"], Action::Deep),
    (&["BRKCHP", "BRKCHIP", "BREAK", "CHPBRK", "CHIP"], Action::ChipBreak),
    (&["TAP", "RIGID"], Action::Tap),
    (&["BORE"], Action::Bore),
    (&["REAM"], Action::Ream),
];
/// What a word for a kind of cycle asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Action {
    Drill,
    Face,
    Deep,
    ChipBreak,
    Tap,
    Bore,
    Ream,
}

/// Kinds that may stand behind a more general one: `CYCLE/ DRILL, DEEP`.
pub(super) const FINER: &[&str] = &["DEEP", "BRKCHP", "CSINK", "TAP", "REAM", "FACE", "CBORE"];

impl Reader<'_> {
    pub(super) fn cycle(&mut self, s: &Statement) {
        let Some(word) = s.words().next().map(str::to_owned) else {
            return self.complain(&codes::BAD_CYCLE, "CYCLE takes the kind of cycle, or OFF".to_owned());
        };
        match word.as_str() {
            "OFF" | "NOMORE" => self.leave_cycle(),
            "CLEAR" if s.args.len() == 1 => self.leave_cycle(),
            "INIT" => {}
            "ON" if self.state.cycle.is_some() => {}
            _ => self.begin_asked(&word, s),
        }
    }

    fn begin_asked(&mut self, word: &str, s: &Statement) {
        self.leave_cycle();
        match self.asked(word, s) {
            Ok(asked) => self.state.cycle = Some(asked),
            Err(message) => {
                self.state.cycle_failed = true;
                self.complain(&codes::BAD_CYCLE, message);
            }
        }
    }

    fn asked(&mut self, word: &str, s: &Statement) -> Result<Asked, String> {
        let scale = self.state.scale;
        let value = |words: &[&str]| words.iter().find_map(|w| s.after(w)).map(|v| v * scale);
        self.known_words(word, s)?;
        let bare = bare_numbers(s);
        let depth = value(DEPTH).or_else(|| bare.first().map(|v| v * scale)).map(f64::abs);
        let depth = depth.ok_or("the cycle has no depth: FEDTO or DEPTH")?;
        let spare = if value(DEPTH).is_some() { 0 } else { 1 };
        let last = bare.get(spare..).and_then(<[f64]>::last).map(|v| v * scale);
        let clearance = value(CLEARANCE).or(last).filter(|c| *c >= 0.0);
        let clearance = clearance.ok_or("the cycle has no clearance: RAPTO or CLEAR")?;
        let (feed, own_feed) = self.cycle_feed(s);
        let dwell = self.cycle_dwell(s)?;
        let word = s.words().skip(1).find(|w| FINER.contains(w)).unwrap_or(word);
        let kind = self.kind(word, s, dwell, feed)?;
        let (peck, first_peck) = pecks(s, scale);
        if let Some(v) = spare_number(s) {
            return Err(format!("the cycle has a number that belongs to no word: {v}"));
        }
        if matches!(kind, CycleKind::Deep | CycleKind::ChipBreak) && peck.is_none() {
            return Err("the cycle has no depth of cut: STEP or SUBPECK".to_owned());
        }
        let begin = RETURN.iter().any(|w| word_after(s, w).is_some_and(|w| w == "ON" || w == "AUTO"));
        let return_to = match value(RETURN).filter(|r| *r > clearance) {
            Some(height) => Return::Above(height),
            None if begin => Return::Begin,
            None => Return::Clearance,
        };
        let retract = if return_to == Return::Clearance { RetractTo::Clearance } else { RetractTo::Initial };
        let feed = feed.unwrap_or(Feed::PerMinute(0.0));
        let cycle = Cycle { kind, depth, clearance, retract, peck, first_peck, dwell, feed };
        Ok(Asked { own_feed, ..Asked::new(cycle, return_to)? })
    }

    /// A word that nobody knows may change the hole.
    fn known_words(&mut self, kind: &str, s: &Statement) -> Result<(), String> {
        let lists = [DEPTH, CLEARANCE, RETURN, PECK, FIRST_PECK, NEXT_PECKS, FEEDS, SILENT, FINER, OTHER];
        let known = |w: &str| w == kind || lists.iter().any(|l| l.contains(&w));
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
        let action = KINDS.iter().find(|(words, _)| words.contains(&word)).map(|(_, action)| *action);
        let action = action.ok_or_else(|| format!("the cycle {word} is not known"))?;
        Ok(match (action, dwell) {
            (Action::Drill, None) => CycleKind::Drill,
            (Action::Drill | Action::Face, _) => CycleKind::Dwell,
            (Action::Deep, _) => CycleKind::Deep,
            (Action::ChipBreak, _) => CycleKind::ChipBreak,
            (Action::Tap, _) => {
                CycleKind::Tap { pitch: self.pitch(s, feed)?, left: s.has("LEFT") || s.has("CCLW") }
            }
            (Action::Bore, _) if s.has("NODRAG") || s.has("ORIENT") => {
                let shift = s.after("ORIENT").or_else(|| s.after("NODRAG"));
                let shift = shift.ok_or("the cycle has no distance to move off the wall: ORIENT")?;
                CycleKind::BoreOrient { shift: shift * self.state.scale }
            }
            (Action::Bore, _) if s.has("DRAG") => CycleKind::BoreStop,
            (Action::Bore | Action::Ream, Some(_)) => CycleKind::BoreDwell,
            (Action::Bore | Action::Ream, None) => CycleKind::Bore,
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
            // Depth and feed before their unit, or the feed behind it.
            let at = s.args.iter().position(|a| matches!(a, Arg::Word(w) if w == word));
            let value = at.and_then(|at| feed_before(s, at)).or_else(|| s.after(word).filter(|v| *v > 0.0));
            if let Some(value) = value {
                return (self.feed_of(value, &[word]), true);
            }
        }
        (self.state.feed, false)
    }

    fn cycle_dwell(&self, s: &Statement) -> Result<Option<f64>, String> {
        // `DWELL, 2` are seconds; `DWELL, 2, REV`, `DWELL, REV, 2` and `REV, 2` are turns.
        let turns = s.after("REV").or_else(|| s.after("DWELL").filter(|_| s.has("REV")));
        let seconds = match (turns, s.after("DWELL"), self.state.spindle) {
            (None, Some(seconds), _) => seconds,
            (Some(turns), _, Some(Spindle::On { rpm, .. })) => turns * 60.0 / rpm,
            (Some(_), ..) => return Err("revolutions of dwell need a turning spindle".to_owned()),
            _ => return Ok(None),
        };
        if !(0.0..=LONGEST_DWELL).contains(&seconds) {
            return Err(format!("a dwell of {seconds} s is not between 0 and {LONGEST_DWELL}"));
        }
        Ok(Some(seconds).filter(|s| *s > 0.0))
    }

    /// The cycle of the next hole: goes on where it is the same.
    pub(super) fn ask(&mut self, asked: Asked) {
        let same = |old: &Asked| old.cycle == asked.cycle && old.return_to == asked.return_to;
        if !self.state.cycle.as_ref().is_some_and(same) {
            self.leave_cycle();
            self.state.cycle = Some(asked);
        }
    }

    /// A point while a cycle is in force.
    pub(super) fn hole(&mut self, point: Point3) {
        let Some(asked) = self.state.cycle.clone() else { return };
        if asked.open != Some(point.z) {
            self.open_cycle(asked, point);
        }
        self.emit(RecordKind::Hole(point));
        let at = self.state.at;
        let level = self.state.cycle.as_ref().map_or(point.z, |a| a.level(point.z, at));
        self.state.at = Some(Point3::new(point.x, point.y, level));
    }

    /// Starts the cycle in the CL data at its retract level.
    fn open_cycle(&mut self, mut asked: Asked, point: Point3) {
        self.close_cycle();
        self.ready_to_drill(&mut asked);
        self.make_sure();
        let level = asked.level(point.z, self.state.at);
        match self.state.at {
            Some(at) if at.z < level => self.emit(RecordKind::Rapid(Point3::new(at.x, at.y, level))),
            // From above, over the hole and down: it is where the tool comes back to.
            Some(at) if at.z > level && matches!(asked.return_to, Return::Above(_)) => {
                for z in [at.z, level] {
                    self.emit(RecordKind::Rapid(Point3::new(point.x, point.y, z)));
                }
            }
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
        if self.state.load.is_some() || self.state.loaded.is_none() {
            self.flush_tool();
        }
        self.begin_operation();
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
        self.state.cycle_failed = false;
    }
}

/// Depth of the pecks but the first, and of the first where it differs, mm. Of more than one number behind a word the
/// first is the first peck's, and the smallest of the others that of all others.
fn pecks(s: &Statement, scale: f64) -> (Option<f64>, Option<f64>) {
    let least = |numbers: &[f64]| numbers.iter().copied().filter(|v| *v > 0.0).reduce(f64::min);
    let value = |words: &[&str]| words.iter().find_map(|w| s.after(w)).filter(|v| *v > 0.0);
    let listed = PECK.iter().map(|w| listed(s, w)).find(|l| !l.is_empty()).unwrap_or_default();
    let (head, others) =
        listed.split_first().map_or((None, &[][..]), |(h, o)| (Some(*h).filter(|v| *v > 0.0), o));
    let next = NEXT_PECKS.iter().filter_map(|w| s.after(w)).collect::<Vec<_>>();
    let first = value(FIRST_PECK).or(head.filter(|_| !others.is_empty()));
    let peck = least(others).or(head).or(least(&next)).or(first).map(|v| v * scale);
    (peck, first.map(|v| v * scale).filter(|v| Some(*v) != peck))
}

/// All numbers behind a word, but those that are depth, or peck, and feed before the unit of the feed.
fn listed(s: &Statement, word: &str) -> Vec<f64> {
    let is_it = |w: &[Arg]| matches!(w, [Arg::Word(w), Arg::Number(_)] if w == word);
    let Some(at) = s.args.windows(2).position(is_it) else { return Vec::new() };
    let numbers = s.args[at + 1..].iter().map_while(|a| if let Arg::Number(v) = a { Some(*v) } else { None });
    let mut numbers: Vec<f64> = numbers.collect();
    if feed_before(s, at + 1 + numbers.len()).is_some() {
        numbers.pop();
    }
    numbers
}

/// Whether every number has its word, as in the cycles of NX, Creo and ISO 4343; CATIA's have their order.
fn named(s: &Statement) -> bool {
    CLEARANCE.iter().any(|w| s.after(w).is_some()) && DEPTH.iter().any(|w| s.after(w).is_some())
}

/// In a cycle whose numbers have words, one that has none.
fn spare_number(s: &Statement) -> Option<f64> {
    if !named(s) {
        return None;
    }
    let mut before: Option<&str> = None;
    let mut count = 0;
    for (index, arg) in s.args.iter().enumerate() {
        match arg {
            Arg::Word(word) => (before, count) = (Some(word.as_str()), 0),
            Arg::Number(v) => {
                count += 1;
                let pecks = before.is_some_and(|w| PECK.contains(&w));
                let feed = feed_before(s, index + 1).is_some();
                let kind =
                    before.is_none_or(|w| FINER.contains(&w) || KINDS.iter().any(|(k, _)| k.contains(&w)));
                if !feed && !pecks && (count > 1 || kind) {
                    return Some(*v);
                }
            }
            _ => {}
        }
    }
    None
}

/// The word that stands behind a word.
fn word_after<'s>(s: &'s Statement, wanted: &str) -> Option<&'s str> {
    s.args.windows(2).find_map(|w| match w {
        [Arg::Word(word), Arg::Word(next)] if word == wanted => Some(next.as_str()),
        _ => None,
    })
}

/// Numbers that belong to no word, or stand behind the kind: depth, and clearance at the end.
fn bare_numbers(s: &Statement) -> Vec<f64> {
    let mut out = Vec::new();
    let mut taken = true;
    for (index, arg) in s.args.iter().enumerate() {
        match arg {
            Arg::Number(_) if feed_before(s, index + 1).is_some() => taken = false,
            Arg::Number(v) if !taken || index == 1 => {
                out.push(*v);
                taken = false;
            }
            // The number behind a word is the word's.
            Arg::Number(_) => taken = false,
            _ => taken = feed_before(s, index).is_none(),
        }
    }
    out
}

/// The second of two numbers before the unit of feed at this place: depth, feed, unit.
fn feed_before(s: &Statement, at: usize) -> Option<f64> {
    if !matches!(s.args.get(at)?, Arg::Word(w) if FEEDS.contains(&w.as_str())) {
        return None;
    }
    // Where numbers have words, that of the unit is behind it.
    if named(s) && matches!(s.args.get(at + 1), Some(Arg::Number(_))) {
        return None;
    }
    match (s.args.get(at.checked_sub(2)?)?, s.args.get(at.checked_sub(1)?)?) {
        (Arg::Number(_), Arg::Number(feed)) => Some(*feed),
        _ => None,
    }
}
