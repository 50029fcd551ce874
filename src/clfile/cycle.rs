//! Drilling cycles: `CYCLE/` in its variants. A `GOTO` after it is a hole, until `CYCLE/ OFF`.

use super::grammar::{Arg, Statement};
use super::reader::Reader;
use crate::cl::{Cycle, CycleKind, RecordKind, RetractTo};
use crate::diag::Diagnostic;
use crate::diag::codes::foreign as codes;
use crate::geom::Point3;
use crate::ir::{Feed, Spindle};
use crate::units::LengthUnit;

/// A cycle as asked for; lengths in mm.
#[derive(Debug, Clone)]
pub(super) struct Asked {
    cycle: Cycle,
    /// Retract level above the hole's point.
    return_to: Return,
    /// The feed is given in the record, not by `FEDRAT`.
    own_feed: bool,
    /// The pitch of the tap is what feed and speed make at the hole.
    pitch_of_feed: bool,
    /// Turns of the spindle that the dwell takes.
    turns: Option<f64>,
    /// The points are bottoms of holes, and these heights in the part are for rapid and between holes.
    planes: Option<(f64, f64)>,
    /// Surface of the holes since the cycle's begin in the CL data.
    open: Option<f64>,
}

/// Least depth of a hole or a peck, mm.
const LEAST_DEPTH: f64 = 0.001;
/// Distance off the wall of a cutter that is not known, mm, at most.
const FARTHEST_SHIFT: f64 = 10.0;
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
    /// To this height above the hole's point, and not below where the cycle began if that is the same number.
    Clear(f64),
}

/// Heights that differ by less are one, mm.
const SAME_HEIGHT: f64 = 1e-3;

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
        Ok(Asked {
            cycle: Cycle { peck, first_peck, ..cycle },
            return_to,
            own_feed: true,
            pitch_of_feed: false,
            turns: None,
            planes: None,
            open: None,
        })
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
            Return::Clear(height) => {
                let begin = at.map(|at| at.z).filter(|at| (at - height).abs() <= SAME_HEIGHT);
                begin.map_or(z + height, |at| at.max(z + height))
            }
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
pub(super) const OTHER: &[&str] =
    &["DWELL", "REV", "PITCH", "TPI", "LEFT", "CCLW", "DRAG", "NODRAG", "ORIENT"];
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
        self.state.cycle_cut = None;
        match word.as_str() {
            "OFF" | "NOMORE" => self.leave_cycle(),
            "CLEAR" if s.args.len() == 1 => self.leave_cycle(),
            _ if s.args.len() == 2 && s.has("OFF") => self.leave_cycle(),
            "INIT" => {}
            "ON" if self.state.cycle.is_some() => {}
            // The one before is in force again.
            "ON" if s.args.len() == 1 && self.state.cycle_before.is_some() => {
                self.state.cycle = self.state.cycle_before.take();
            }
            _ => self.begin_asked(&word, s),
        }
    }

    fn begin_asked(&mut self, word: &str, s: &Statement) {
        self.leave_cycle();
        // A cycle goes to its holes at rapid anyway.
        self.state.rapid = false;
        self.state.drilled = None;
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
        let word = s.words().skip(1).find(|w| FINER.contains(w)).unwrap_or(word);
        let bare = bare_numbers(s);
        let depth = value(DEPTH).or_else(|| bare.first().map(|v| v * scale)).map(f64::abs);
        let depth = depth.ok_or("the cycle has no depth: FEDTO or DEPTH")?;
        let spare = if value(DEPTH).is_some() { 0 } else { 1 };
        if let Some(v) = spare_number(s).or_else(|| bare.get(spare + 1).copied()) {
            return Err(format!("the cycle has a number that belongs to no word: {v}"));
        }
        let last = bare.get(spare).map(|v| v * scale);
        let planes = match (last, s.after("RAPTO")) {
            (Some(height), Some(down)) if spare > 0 => Some(self.planes(height, down * scale)?),
            _ => None,
        };
        let own_feed = self.own_feed(s);
        let turns = cycle_turns(s);
        let dwell = self.cycle_dwell(s, turns)?;
        let (peck, first_peck) = pecks(s, scale);
        let (kind, pitch_of_feed) = self.kind(word, s, dwell.is_some() || turns.is_some_and(|t| t > 0.0))?;
        match (kind, peck) {
            (CycleKind::Deep | CycleKind::ChipBreak, None) => {
                return Err("the cycle has no depth of cut: STEP or SUBPECK".to_owned());
            }
            (CycleKind::Deep | CycleKind::ChipBreak, _) | (_, None) => {}
            (_, Some(peck)) => {
                let peck = peck / scale;
                return Err(format!(
                    "the cycle {word} has a depth of cut, {peck}: it belongs to DEEP or BRKCHP"
                ));
            }
        }
        let (clearance, return_to) = levels(s, scale, last)?;
        let retract = if return_to == Return::Clearance { RetractTo::Clearance } else { RetractTo::Initial };
        let feed = own_feed.unwrap_or(Feed::PerMinute(0.0));
        let cycle = Cycle { kind, depth, clearance, retract, peck, first_peck, dwell, feed };
        let own_feed = own_feed.is_some();
        Ok(Asked { own_feed, pitch_of_feed, turns, planes, ..Asked::new(cycle, return_to)? })
    }

    /// Heights of the form `DRILL, depth, MMPM, feed, clearance, RAPTO, down`, as Autodesk's ISO 4343 post writes it: the
    /// points are bottoms, the clearance is the plane on which the tool is, and `RAPTO` goes down from it.
    fn planes(&self, height: f64, down: f64) -> Result<(f64, f64), String> {
        match self.state.at {
            Some(at) if (at.z - height).abs() <= SAME_HEIGHT && down >= 0.0 => Ok((height - down, height)),
            _ => Err(
                "the cycle has a clearance and RAPTO, and the tool is not at that height: what they count \
                      from is not known"
                    .to_owned(),
            ),
        }
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

    /// The kind, and whether a tap's pitch is what feed and speed make.
    fn kind(&self, word: &str, s: &Statement, dwells: bool) -> Result<(CycleKind, bool), String> {
        let action = KINDS.iter().find(|(words, _)| words.contains(&word)).map(|(_, action)| *action);
        let action = action.ok_or_else(|| format!("the cycle {word} is not known"))?;
        let shift = s.after("ORIENT").or_else(|| s.after("NODRAG"));
        let kind = match (action, dwells) {
            (Action::Drill, false) => CycleKind::Drill,
            (Action::Drill | Action::Face, _) => CycleKind::Dwell,
            (Action::Deep, _) => CycleKind::Deep,
            (Action::ChipBreak, _) => CycleKind::ChipBreak,
            (Action::Tap, _) => {
                let pitch = match s.after("TPI") {
                    Some(threads) if threads > 0.0 => Some(LengthUnit::Inch.in_mm() / threads),
                    Some(threads) => return Err(format!("a tap cannot cut {threads} threads an inch")),
                    None => s.after("PITCH").map(|pitch| pitch * self.state.scale),
                };
                let left = s.has("LEFT") || s.has("CCLW");
                return Ok((CycleKind::Tap { pitch: pitch.unwrap_or(0.0), left }, pitch.is_none()));
            }
            // An angle of 0 and no distance: it comes out as other boring does.
            (Action::Bore, _) if shift == Some(0.0) && !s.has("NODRAG") => bore(dwells),
            (Action::Bore, _) if s.has("NODRAG") || s.has("ORIENT") => {
                let shift = shift.ok_or("the cycle has no distance to move off the wall: ORIENT")?;
                CycleKind::BoreOrient { shift: self.off_the_wall(shift)? }
            }
            (Action::Bore, _) if s.has("DRAG") => CycleKind::BoreStop,
            (Action::Bore | Action::Ream, _) => bore(dwells),
        };
        Ok((kind, false))
    }

    /// A distance off the wall, mm. Some systems write an angle there.
    fn off_the_wall(&self, shift: f64) -> Result<f64, String> {
        let radius = self.current_diameter().map_or(FARTHEST_SHIFT, |d| d / 2.0);
        let mm = shift * self.state.scale;
        if mm > 0.0 && mm <= radius {
            return Ok(mm);
        }
        Err(format!("{shift} behind ORIENT or NODRAG is no distance for this cutter to move off the wall"))
    }

    /// The tap's kind with what feed and speed make at the hole: its pitch, and its hand.
    fn tap(&self, asked: &Asked) -> Result<CycleKind, String> {
        let CycleKind::Tap { pitch, left } = asked.cycle.kind else { return Ok(asked.cycle.kind) };
        let feed = if asked.own_feed { Some(asked.cycle.feed) } else { self.state.feed };
        let pitch = match (feed, self.state.spindle) {
            _ if !asked.pitch_of_feed => pitch,
            (Some(Feed::PerRevolution(pitch)), _) => pitch,
            (Some(Feed::PerMinute(feed)), Some(Spindle::On { rpm, .. })) => feed / rpm,
            _ => {
                return Err(
                    "tapping has no pitch: a feed per revolution, or a feed and a turning spindle".to_owned()
                );
            }
        };
        let backwards = matches!(self.state.spindle, Some(Spindle::On { clockwise: false, .. }));
        Ok(CycleKind::Tap { pitch, left: left || backwards })
    }

    /// The feed that the record itself gives.
    fn own_feed(&mut self, s: &Statement) -> Option<Feed> {
        FEEDS.iter().find_map(|word| {
            // Depth and feed before their unit, or the feed behind it.
            let at = s.args.iter().position(|a| matches!(a, Arg::Word(w) if w == word));
            let value = at.and_then(|at| feed_before(s, at)).or_else(|| s.after(word).filter(|v| *v > 0.0));
            value.and_then(|value| self.feed_of(value, &[word]))
        })
    }

    /// Seconds of dwell; of turns, for the speed in force.
    fn cycle_dwell(&self, s: &Statement, turns: Option<f64>) -> Result<Option<f64>, String> {
        let seconds = match turns {
            Some(turns) => self.dwell_of_turns(turns)?,
            None => s.after("DWELL").map(dwell_in_range).transpose()?,
        };
        Ok(seconds.filter(|s| *s > 0.0))
    }

    /// Seconds that turns of the spindle take; `None` while it stands.
    fn dwell_of_turns(&self, turns: f64) -> Result<Option<f64>, String> {
        let Some(Spindle::On { rpm, .. }) = self.state.spindle else { return Ok(None) };
        dwell_in_range(turns * 60.0 / rpm).map(Some)
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
        let told = point;
        let (asked, point) = match self.in_force(asked, point) {
            Ok(now) => now,
            Err(message) => {
                self.close_cycle();
                self.state.cycle_failed = true;
                return self.complain(&codes::BAD_CYCLE, message);
            }
        };
        let clearance = asked.cycle.clearance;
        let same = self.state.cycle.as_ref().is_some_and(|old| old.cycle == asked.cycle);
        if !same || asked.open != Some(point.z) || !self.state.spindle_recorded {
            self.open_cycle(asked, point);
        }
        self.state.drilled = Some(point.z);
        self.not_at_rapid(clearance);
        self.emit(RecordKind::Hole(point));
        let at = self.state.at;
        let level = self.state.cycle.as_ref().map_or(point.z, |a| a.level(point.z, at));
        self.state.at = Some(Point3::new(point.x, point.y, level));
        self.state.hole = Some(told);
    }

    /// A point at rapid, perhaps while a cycle is in force.
    pub(super) fn rapid_in_cycle(&mut self, to: Point3) {
        if self.state.cycle.is_some() {
            self.state.rapid_in_cycle.get_or_insert((to.z, self.span));
        }
    }

    /// Over the holes one goes at rapid, but not down to them: such a point may be meant to be one.
    fn not_at_rapid(&mut self, clearance: f64) {
        let Some((z, span)) = self.state.rapid_in_cycle.take() else { return };
        if self.state.drilled.is_some_and(|surface| z >= surface + clearance - SAME_HEIGHT) {
            return;
        }
        let message =
            "a point at rapid, in a cycle, below its clearance: whether this is a hole is not known";
        self.tell(
            Diagnostic::new(&codes::BAD_CYCLE, span, message)
                .help("leave out RAPID, or put CYCLE/ OFF before it"),
        );
    }

    /// The cycle with what the file has put in force until this hole, and the hole's point on the surface.
    fn in_force(&self, mut asked: Asked, mut point: Point3) -> Result<(Asked, Point3), String> {
        asked.cycle.kind = self.tap(&asked)?;
        let tap = matches!(asked.cycle.kind, CycleKind::Tap { .. });
        if let (Some(feed), false, false) = (self.state.feed, asked.own_feed, tap) {
            asked.cycle.feed = feed;
        }
        if let Some(turns) = asked.turns.filter(|turns| *turns != 0.0) {
            let dwell = self.dwell_of_turns(turns)?;
            asked.cycle.dwell = Some(dwell.ok_or("revolutions of dwell need a turning spindle")?);
        }
        if let Some((rapid, back)) = asked.planes {
            point.z += asked.cycle.depth;
            if rapid < point.z - SAME_HEIGHT {
                return Err(format!(
                    "rapid would end {} mm below the top of the hole",
                    ((point.z - rapid) * 1e4).round() / 1e4
                ));
            }
            asked.cycle.clearance = (rapid - point.z).max(0.0);
            asked.cycle.retract = RetractTo::Initial;
            asked.return_to = Return::Above(back - point.z);
        }
        Ok((asked, point))
    }

    /// Starts the cycle in the CL data at its retract level.
    fn open_cycle(&mut self, mut asked: Asked, point: Point3) {
        self.close_cycle();
        self.ready_to_drill(&asked);
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

    fn ready_to_drill(&mut self, asked: &Asked) {
        if self.state.load.is_some() || self.state.loaded.is_none() {
            self.flush_tool();
        }
        self.begin_operation();
        if !self.state.spindle_recorded {
            self.record_spindle();
        }
        let tap = matches!(asked.cycle.kind, CycleKind::Tap { .. });
        if !asked.own_feed && !tap && self.state.feed.is_none() {
            self.lacks("FEDRAT");
        }
    }

    fn close_cycle(&mut self) {
        if let Some(asked) = &mut self.state.cycle
            && asked.open.take().is_some()
        {
            self.emit(RecordKind::EndCycle);
        }
    }

    /// Whether a curve to this point stands among the holes of a cycle, which is told: is its end a hole?
    pub(super) fn curve_in_cycle(&mut self, what: &str, to: Point3) -> bool {
        if self.state.cycle.is_none() {
            return false;
        }
        let message = format!("{what} while a cycle is in force: whether its end is a hole is not known");
        let help = "put CYCLE/ OFF before it, and the cycle again behind it";
        self.tell(Diagnostic::new(&codes::BAD_CYCLE, self.span, message).help(help));
        self.close_cycle();
        self.state.cycle_failed = true;
        self.state.at = Some(to);
        true
    }

    /// A move between holes; the cycle stays in force.
    pub(super) fn pause_cycle(&mut self) {
        self.close_cycle();
    }

    /// The cycle ends.
    pub(super) fn leave_cycle(&mut self) {
        self.close_cycle();
        let clearance = self.state.cycle.as_ref().map(|asked| asked.cycle.clearance);
        if let (Some(clearance), false) = (clearance, self.state.cycle_failed) {
            self.not_at_rapid(clearance);
        }
        self.state.rapid_in_cycle = None;
        self.state.cycle_before = self.state.cycle.take().or(self.state.cycle_before.take());
        self.state.cycle_failed = false;
    }

    /// The cycle ends with something else than its own end.
    pub(super) fn cut_cycle(&mut self) {
        if self.state.cycle.is_some() {
            self.state.cycle_cut = Some(self.span);
        }
        self.leave_cycle();
    }

    /// A point behind what cut a cycle short: was it to be a hole?
    pub(super) fn behind_cycle(&mut self) {
        if let Some(cut) = self.state.cycle_cut.take() {
            let message =
                "a cycle was in force, and ended without CYCLE/ OFF: whether this is a hole is not known";
            self.tell(Diagnostic::new(&codes::BAD_CYCLE, self.span, message).label(cut, "it ended here"));
        }
    }
}

/// Boring that comes out at feed.
fn bore(dwells: bool) -> CycleKind {
    if dwells { CycleKind::BoreDwell } else { CycleKind::Bore }
}

fn dwell_in_range(seconds: f64) -> Result<f64, String> {
    if (0.0..=LONGEST_DWELL).contains(&seconds) {
        return Ok(seconds);
    }
    Err(format!("a dwell of {seconds} s is not between 0 and {LONGEST_DWELL}"))
}

/// Turns of the spindle that a dwell takes: `DWELL, 2` are seconds; `DWELL, 2, REV`, `DWELL, REV, 2` and `REV, 2` are turns.
fn cycle_turns(s: &Statement) -> Option<f64> {
    s.after("REV").or_else(|| s.after("DWELL").filter(|_| s.has("REV")))
}

/// Clearance above the holes, mm, and where the tool goes after them.
fn levels(s: &Statement, scale: f64, last: Option<f64>) -> Result<(f64, Return), String> {
    let value = |words: &[&str]| words.iter().find_map(|w| s.after(w)).map(|v| v * scale);
    let rapid = value(CLEARANCE).or(last).filter(|c| *c >= 0.0);
    let rapid = rapid.ok_or("the cycle has no clearance: RAPTO or CLEAR")?;
    // With RAPTO, CLEAR is the height between the holes; some systems write a plane of the part there.
    let clear = s.after("RAPTO").and_then(|_| value(&["CLEAR", "CLEARP"]));
    let height = value(RETURN);
    let begin = RETURN.iter().any(|w| word_after(s, w).is_some_and(|w| w == "ON" || w == "AUTO"));
    let return_to = match (height, clear) {
        (Some(height), Some(clear)) if height == clear && height > rapid => Return::Clear(height),
        (Some(height), _) if height > rapid => Return::Above(height),
        (None, Some(clear)) if clear > rapid && !begin => Return::Clear(clear),
        (None, _) if begin => Return::Begin,
        _ => Return::Clearance,
    };
    Ok((rapid, return_to))
}

/// Depth of the pecks but the first, and of the first where it differs, mm. Of more than one number behind a word the
/// first is the first peck's, and the smallest of the others that of all others.
fn pecks(s: &Statement, scale: f64) -> (Option<f64>, Option<f64>) {
    let least = |numbers: &[f64]| numbers.iter().copied().filter(|v| *v > 0.0).reduce(f64::min);
    let value = |words: &[&str]| words.iter().find_map(|w| s.after(w)).filter(|v| *v > 0.0);
    let listed = PECK.iter().map(|w| listed_pecks(s, w)).find(|l| !l.is_empty()).unwrap_or_default();
    let (head, others) =
        listed.split_first().map_or((None, &[][..]), |(h, o)| (Some(*h).filter(|v| *v > 0.0), o));
    let next = NEXT_PECKS.iter().filter_map(|w| s.after(w)).collect::<Vec<_>>();
    let first = value(FIRST_PECK).or(head.filter(|_| !others.is_empty()));
    let peck = least(others).or(head).or(least(&next)).or(first).map(|v| v * scale);
    (peck, first.map(|v| v * scale).filter(|v| Some(*v) != peck))
}

/// All pecks behind a word, but what is depth, or peck, and feed before the unit of the feed.
fn listed_pecks(s: &Statement, word: &str) -> Vec<f64> {
    let is_it = |w: &[Arg]| matches!(w, [Arg::Word(w), Arg::Number(_)] if w == word);
    let Some(at) = s.args.windows(2).position(is_it) else { return Vec::new() };
    let numbers = s.args[at + 1..].iter().map_while(|a| if let Arg::Number(v) = a { Some(*v) } else { None });
    let mut numbers: Vec<f64> = numbers.collect();
    if feed_before(s, at + 1 + numbers.len()).is_some() {
        numbers.pop();
    }
    if !has_depth_before(s, at) {
        numbers.truncate(1);
    }
    numbers
}

/// Whether the depth stands before this place, or has its word: a further number behind is not the depth.
fn has_depth_before(s: &Statement, at: usize) -> bool {
    let named = DEPTH.iter().any(|w| s.after(w).is_some());
    named || at > 1 && matches!(s.args.get(1), Some(Arg::Number(_)))
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
    let (mut taken, mut pecks) = (true, false);
    for (index, arg) in s.args.iter().enumerate() {
        match arg {
            Arg::Number(_) if feed_before(s, index + 1).is_some() => taken = false,
            Arg::Number(_) if pecks => {}
            Arg::Number(v) if !taken || index == 1 => {
                out.push(*v);
                taken = false;
            }
            // The number behind a word is the word's.
            Arg::Number(_) => taken = false,
            Arg::Word(word) => {
                taken = feed_before(s, index).is_none();
                pecks = index > 0 && PECK.contains(&word.as_str()) && has_depth_before(s, index);
            }
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
