//! Feed, spindle, coolant, dwell, tolerances.

use super::grammar::{Arg, Statement};
use super::reader::Reader;
use crate::cl::RecordKind;
use crate::diag::Diagnostic;
use crate::diag::codes::foreign as codes;
use crate::geom::Side;
use crate::ir::{Compensation, Coolant, Feed, Gear, Spindle};

/// Words of a feed per minute, with the length they count in mm; 0: the file's unit.
pub(super) const PER_MINUTE: &[(&str, f64)] =
    &[("MMPM", 1.0), ("IPM", 25.4), ("FPM", 304.8), ("PERMIN", 0.0), ("MPM", 1000.0), ("UPM", 0.0)];
/// Words of a feed per revolution.
pub(super) const PER_REVOLUTION: &[(&str, f64)] =
    &[("MMPR", 1.0), ("IPR", 25.4), ("PERREV", 0.0), ("UPR", 0.0)];
/// Words that a feed may have without another meaning.
pub(super) const FEED_SILENT: &[&str] = &["NOW", "NEXT"];
/// Words of a speed.
pub(super) const SPEED_WORDS: &[&str] =
    &["RPM", "REVPM", "CLW", "CCLW", "ON", "SFM", "SMM", "RANGE", "MAXRPM", "LOW", "MEDIUM", "HIGH"];
/// Words that stop the spindle.
pub(super) const SPINDLE_OFF: &[&str] = &["OFF", "STOP"];
/// Words of the coolant.
pub(super) const COOLANTS: &[(&str, Coolant)] = &[
    ("ON", Coolant::Flood),
    ("FLOOD", Coolant::Flood),
    ("MIST", Coolant::Mist),
    ("THRU", THROUGH),
    ("OFF", Coolant::Off),
];
/// Where it is needed; `--lenient` takes flood in its place.
const THROUGH: Coolant = Coolant::Through { needed: true };
/// Words that ask for compensation in the control, and that it ends.
pub(super) const COMPENSATION: (&[&str], &[&str]) = (&["LEFT", "RIGHT", "ON"], &["OFF", "NOMORE"]);
/// Words that say more of it: its plane, its offset; compensation of the length is what every tool change has.
pub(super) const OF_COMPENSATION: &[&str] =
    &["XYPLAN", "XAXIS", "YAXIS", "ADJUST", "OSETNO", "LENGTH", "NOW", "NEXT"];

impl Reader<'_> {
    /// `-D SPINDL=…` and the like: what the file lacks.
    pub(super) fn defines(&mut self, defines: &[(String, String)]) {
        for (name, value) in defines {
            let number = super::scan::number(value.trim());
            match (name.to_uppercase().as_str(), number) {
                ("SPINDL", Some(rpm)) if rpm > 0.0 => {
                    self.state.spindle = Some(Spindle::on(rpm, true));
                    self.state.last_speed = Some((rpm, true));
                }
                ("FEDRAT", Some(feed)) if feed > 0.0 => self.set_feed_number(feed),
                ("LOADTL", Some(n)) if n >= 0.0 && n.fract() == 0.0 && n < 1e8 => self.load(Some(n as u32)),
                ("UNITS", _) => {}
                _ => {
                    let message = format!(
                        "-D {name}={value} is not understood: SPINDL, FEDRAT, LOADTL (numbers) and UNITS can be given for a CL file"
                    );
                    self.complain(&codes::BAD_DEFINE, message);
                }
            }
        }
    }

    pub(super) fn process(&mut self, s: &Statement) {
        match s.major() {
            "FEDRAT" => self.fedrat(s),
            "SPINDL" => self.spindl(s),
            "COOLNT" => self.coolnt(s),
            "DELAY" | "DWELL" => self.delay(s),
            "STOP" => self.stop(RecordKind::Stop),
            "OPSTOP" => self.stop(RecordKind::OptionalStop),
            "UNITS" | "UNIT" => self.unit(s),
            "CUTCOM" => self.cutcom(s),
            word => self.tolerance(word, s),
        }
    }

    /// Value and unit in either order.
    pub(super) fn feed_of(&mut self, value: f64, words: &[&str]) -> Option<Feed> {
        let scale = |unit: f64| if unit > 0.0 { unit } else { self.state.scale };
        let find =
            |table: &[(&str, f64)]| table.iter().find(|(w, _)| words.contains(w)).map(|(_, u)| scale(*u));
        if value.is_nan() || value <= 0.0 {
            return None;
        }
        if let Some(unit) = find(PER_REVOLUTION) {
            return Some(Feed::PerRevolution(value * unit));
        }
        Some(Feed::PerMinute(value * find(PER_MINUTE).unwrap_or(self.state.scale)))
    }

    fn fedrat(&mut self, s: &Statement) {
        let words: Vec<&str> = s.words().collect();
        if words.contains(&"RAPID") {
            self.state.rapid = true;
            return;
        }
        let known = |w: &&str| {
            PER_MINUTE.iter().chain(PER_REVOLUTION).any(|(k, _)| k == w) || FEED_SILENT.contains(w)
        };
        if let Some(unknown) = words.iter().find(|w| !known(w)) {
            let message = format!("FEDRAT with {unknown} cannot be carried out");
            return self.soften(&codes::NOT_CARRIED_OUT, message, None);
        }
        let feed = s.numbers().first().and_then(|v| self.feed_of(*v, &words));
        match feed {
            Some(feed) => self.state.feed = Some(feed),
            None => self.complain(&codes::BAD_RECORD, "FEDRAT takes a feed greater than 0".to_owned()),
        }
    }

    /// A bare feed, in the file's unit a minute.
    pub(super) fn set_feed_number(&mut self, value: f64) {
        if let Some(feed) = self.feed_of(value, &[]) {
            self.state.feed = Some(feed);
        }
    }

    pub(super) fn record_feed(&mut self) {
        match self.state.feed {
            Some(feed) => {
                self.state.recorded_feed = Some(feed);
                self.emit(RecordKind::Feed(feed));
            }
            None => self.lacks("FEDRAT"),
        }
    }

    fn spindl(&mut self, s: &Statement) {
        let words: Vec<&str> = s.words().collect();
        if words.iter().any(|w| SPINDLE_OFF.contains(w)) {
            self.cut_cycle();
            self.state.spindle = Some(Spindle::Off);
            self.flush_tool_if_waiting();
            // A cut from here on lacks its spindle.
            self.state.spindle_recorded = false;
            self.state.spindle_due = false;
            return self.emit(RecordKind::Spindle(Spindle::Off));
        }
        if let Some(unknown) = words.iter().find(|w| !SPEED_WORDS.contains(w)) {
            let message = format!("SPINDL with {unknown} cannot be carried out");
            return self.soften(&codes::NOT_CARRIED_OUT, message, None);
        }
        let value = first_number_not_after(s, &["RANGE", "MAXRPM"]);
        let speed = match value {
            Some(v) => self.speed(v, &words).map(|rpm| s.after("MAXRPM").map_or(rpm, |most| rpm.min(most))),
            None => self.state.last_speed.map(|(rpm, _)| rpm),
        };
        let surface = words.iter().any(|w| matches!(*w, "SFM" | "SMM"));
        if surface && value.is_some() && self.current_diameter().is_none() {
            let message = "a surface speed needs the cutter's diameter: put CUTTER before SPINDL";
            return self.complain(&codes::BAD_RECORD, message.to_owned());
        }
        let Some(rpm) = speed.filter(|r| *r > 0.0 && r.is_finite()) else {
            return self.complain(&codes::BAD_RECORD, "SPINDL takes a speed greater than 0".to_owned());
        };
        let clockwise = self.sense(&words);
        if value.is_some() || words.contains(&"RANGE") {
            self.state.range = gear_range(s);
        }
        self.turn_at(rpm, clockwise);
    }

    /// Whether the spindle turns clockwise: as the words say, or as was said last.
    pub(super) fn sense(&mut self, words: &[&str]) -> bool {
        if words.contains(&"CLW") || words.contains(&"CCLW") {
            self.state.sense_of_tool = true;
            return !words.contains(&"CCLW");
        }
        let kept = self.state.last_speed.is_none_or(|(_, clockwise)| clockwise);
        if !kept && !self.state.sense_of_tool {
            self.state.sense_of_tool = true;
            let message = "the spindle turns counter-clockwise, as was said for the tool before";
            let help = "write CLW or CCLW with the speed of this tool";
            self.tell(Diagnostic::new(&codes::SENSE_KEPT, self.span, message).help(help));
        }
        kept
    }

    /// The spindle is to turn so from the next move on.
    pub(super) fn turn_at(&mut self, rpm: f64, clockwise: bool) {
        let on = Some(Spindle::On { rpm, clockwise, range: self.state.range });
        self.state.last_speed = Some((rpm, clockwise));
        self.state.spindle_recorded &= self.state.spindle == on;
        self.state.spindle = on;
        self.state.spindle_due = true;
    }

    /// Starts the spindle before the tool goes down to the work, where the file has done so.
    pub(super) fn start_spindle(&mut self) {
        if self.state.spindle_due && !self.state.spindle_recorded && self.state.loaded.is_some() {
            self.record_spindle();
        }
    }

    /// rev/min; a surface speed needs the cutter's diameter.
    fn speed(&mut self, value: f64, words: &[&str]) -> Option<f64> {
        let metres = if words.contains(&"SFM") {
            value * 0.3048
        } else if words.contains(&"SMM") {
            value
        } else {
            return Some(value);
        };
        let diameter = self.current_diameter()?;
        Some(metres * 1000.0 / (crate::math::PI * diameter))
    }

    pub(super) fn record_spindle(&mut self) {
        match self.state.spindle {
            Some(on @ Spindle::On { .. }) => {
                self.state.spindle_recorded = true;
                self.state.spindle_due = false;
                self.emit(RecordKind::Spindle(on));
            }
            Some(Spindle::Off) => self.lacks("SPINDL/ OFF"),
            None => self.lacks("SPINDL"),
        }
    }

    fn coolnt(&mut self, s: &Statement) {
        let word = s.words().next().unwrap_or("ON");
        match COOLANTS.iter().find(|(w, _)| *w == word) {
            Some((_, Coolant::Through { .. })) => {
                self.switch_coolant(Coolant::Through { needed: !self.lenient() });
            }
            Some((_, coolant)) => self.switch_coolant(*coolant),
            None => {
                let message = format!("COOLNT with {word} cannot be carried out");
                self.soften(&codes::NOT_CARRIED_OUT, message, None);
            }
        }
    }

    /// What is on already needs no record.
    pub(super) fn switch_coolant(&mut self, coolant: Coolant) {
        if self.before_first_tool() {
            // On the machine as it stands it would run until the tool is changed.
            self.state.first_coolant = (coolant != Coolant::Off).then_some((coolant, self.span));
            return;
        }
        self.flush_tool_if_waiting();
        if self.state.coolant != Some(coolant) {
            self.state.coolant = Some(coolant);
            self.emit(RecordKind::Coolant(coolant));
        }
    }

    fn stop(&mut self, kind: RecordKind) {
        self.flush_tool_if_waiting();
        self.emit(kind);
        // Some machines stop the coolant, too: what the file switches on again is switched on.
        self.state.coolant = None;
    }

    /// Seconds, or revolutions with `REV`.
    fn delay(&mut self, s: &Statement) {
        let Some(value) = s.numbers().first().copied().filter(|v| *v >= 0.0 && *v < 1e6) else {
            return self.complain(&codes::BAD_RECORD, format!("{} takes a time", s.major()));
        };
        let seconds = match (s.has("REV"), self.state.spindle) {
            (false, _) => value,
            (true, Some(Spindle::On { rpm, .. })) => value * 60.0 / rpm,
            (true, _) => {
                return self.complain(&codes::BAD_RECORD, "revolutions need a turning spindle".to_owned());
            }
        };
        if seconds > 0.0 {
            self.emit(RecordKind::Dwell(seconds));
        }
    }

    fn unit(&mut self, s: &Statement) {
        match s.words().next().and_then(super::unit::of_word) {
            Some(unit) => self.set_units(unit),
            None => self.complain(&codes::BAD_RECORD, "the unit is MM or INCH".to_owned()),
        }
    }

    /// `CUTCOM/`: with a side from the next move on, with `OFF` at once.
    fn cutcom(&mut self, s: &Statement) {
        let known = |w: &&str| {
            COMPENSATION.0.contains(w) || COMPENSATION.1.contains(w) || OF_COMPENSATION.contains(w)
        };
        if let Some(unknown) = s.words().find(|w| !known(w)) {
            let message = format!("CUTCOM with {unknown} cannot be carried out");
            return self.soften(&codes::NOT_CARRIED_OUT, message, None);
        }
        if s.has("LENGTH") {
            return;
        }
        if COMPENSATION.1.iter().any(|w| s.has(w)) {
            return self.end_compensation();
        }
        let side = match () {
            () if s.has("LEFT") => Some(Side::Left),
            () if s.has("RIGHT") => Some(Side::Right),
            () => None,
        };
        let named = s.after("ADJUST").or_else(|| s.after("OSETNO")).or_else(|| s.numbers().first().copied());
        if let Some(bad) = named.filter(|n| n.fract() != 0.0 || !(0.0..1e8).contains(n)) {
            return self.complain(&codes::BAD_RECORD, format!("CUTCOM with the register {bad}"));
        }
        match Compensation::asked(side, named.map(|n| n as u32), self.state.last_compensation) {
            Some(on) => self.compensate(on),
            None => self.complain(&codes::BAD_RECORD, codes::NO_SIDE.to_owned()),
        }
    }

    /// Compensation from the next move on.
    pub(super) fn compensate(&mut self, on: Compensation) {
        self.state.last_compensation = Some(on);
        self.state.compensation = Some((on, self.span));
    }

    /// No compensation.
    pub(super) fn end_compensation(&mut self) {
        self.state.compensation = None;
        self.record_compensation();
    }

    /// What the file wants is in the CL data before the next move.
    #[inline]
    pub(super) fn record_compensation(&mut self) {
        let wanted = self.state.compensation.map(|(on, _)| on);
        if self.state.recorded_compensation != wanted {
            self.state.recorded_compensation = wanted;
            let span = self.state.compensation.map_or(self.span, |(_, span)| span);
            self.as_of(span, |reader| reader.emit(RecordKind::Compensation(wanted)));
        }
    }

    fn tolerance(&mut self, word: &str, s: &Statement) {
        let Some(value) = s.numbers().first().copied().filter(|v| *v >= 0.0 && v.is_finite()) else {
            return self.complain(&codes::BAD_RECORD, format!("{word} takes a tolerance"));
        };
        let mm = value * self.state.scale;
        let old = self.state.band;
        match word {
            "INTOL" => self.state.band.into = mm,
            "OUTTOL" => self.state.band.out = mm,
            _ => (self.state.band.into, self.state.band.out) = (0.0, mm),
        }
        if self.state.band.into + self.state.band.out <= 0.0 {
            self.state.band = old;
        }
    }

    fn flush_tool_if_waiting(&mut self) {
        if self.state.load.is_some() {
            self.flush_tool();
        }
    }

    pub(super) fn current_diameter(&self) -> Option<f64> {
        // The one that is changed out says nothing of the next.
        let loaded = self.state.loaded.filter(|_| self.state.load.is_none()).map(|t| self.tools[t].diameter);
        self.state.tool.diameter().or(loaded).filter(|d| *d > 0.0)
    }
}

/// The first number that does not belong to one of these words.
/// `RANGE, 2`, `RANGE, LOW`, or the word alone.
fn gear_range(s: &Statement) -> Gear {
    const NAMED: [(&str, Gear); 3] = [("LOW", Gear::Low), ("MEDIUM", Gear::Medium), ("HIGH", Gear::High)];
    let number = s.after("RANGE").filter(|n| n.fract() == 0.0 && (0.0..=9999.0).contains(n));
    let named = || NAMED.iter().find(|(word, _)| s.has(word)).map_or(Gear::Any, |(_, gear)| *gear);
    number.map_or_else(named, |n| Gear::Number(n as u16))
}

fn first_number_not_after(s: &Statement, words: &[&str]) -> Option<f64> {
    let mut skip = false;
    for arg in &s.args {
        match arg {
            Arg::Number(v) if !skip => return Some(*v),
            Arg::Word(w) => skip = words.contains(&w.as_str()),
            _ => skip = false,
        }
    }
    None
}
