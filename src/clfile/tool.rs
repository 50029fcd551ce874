//! Tools and operations.

use super::grammar::{Arg, Statement};
use super::reader::Reader;
use crate::cl::print::number as number_of;
use crate::cl::{Guard, Operation, RecordKind};
use crate::diag::codes::foreign as codes;
use crate::ir::{CutterKind, Gear, Tool};
use crate::math;
use crate::source::Span;

/// What is known of the next tool.
#[derive(Debug, Clone, Default)]
pub(super) struct Data {
    name: Option<String>,
    /// d, r, e, f, α, β, h as written: lengths in mm, angles in radians.
    cutter: [f64; 7],
    stated: bool,
    /// It is a drill.
    drill: bool,
    /// It was stated for a tool that has not been changed in yet.
    fresh: bool,
    /// It was stated since the tool moved last, or it is doubted and what follows may tell that the next tool has it.
    pub unseen: bool,
}

/// A cutter that is not that of the tool in the spindle, and that has not been taken for the next one's.
#[derive(Debug, Clone)]
pub(super) struct Doubt {
    message: String,
    span: Span,
    /// Moves at feed since then.
    cuts: u32,
}

/// The cutter of the next tool may stand before the last moves of the one before, of which so many are at feed.
const LAST_CUTS: u32 = 1;

/// A tool change that waits for what the file says of the tool.
#[derive(Debug, Clone)]
pub(super) struct Load {
    number: Option<u32>,
    /// Its further words.
    words: String,
    span: Span,
}

/// Words of a tool change with the number of an offset in the control.
pub(super) const OFFSETS: &[&str] = &["ADJUST", "OSETNO", "ZOFF", "OFFSET", "OFSTNO"];

/// Sizes of cutters that differ by less are one, mm.
const SAME_SIZE: f64 = 1e-3;
/// How far the tip of a cone may be off the tool's axis, in diameters.
const CONE: f64 = 0.01;
/// Point angle of a drill that is none, degrees.
const STRAIGHT: f64 = 180.0;
/// Tools that do not turn.
const NOT_MILLING: &[&str] = &["TURN", "LATHE", "THREAD", "GROOVE", "WEDM", "LASER", "PUNCH"];

/// What a tool change says besides the tool's number and the speed, which has a record of its own.
fn further_words(s: &Statement) -> String {
    let mut said: Vec<String> = Vec::new();
    let mut args = s.args.iter().skip_while(|arg| !matches!(arg, Arg::Number(_))).skip(1).peekable();
    while let Some(arg) = args.next() {
        match arg {
            Arg::Word(word) if word == "SPINDL" => _ = args.next_if(|next| matches!(next, Arg::Number(_))),
            Arg::Word(word) if word.bytes().all(|b| b.is_ascii_alphanumeric()) => said.push(word.clone()),
            Arg::Number(value) if value.is_finite() => said.push(crate::cl::print::number(*value)),
            _ => {}
        }
    }
    said.join(", ")
}

/// Whether the bottom is a cone up to the tool's axis: the numbers of `CUTTER/`, angles in radians.
fn is_cone([d, r, e, f, a, b, _]: [f64; 7]) -> bool {
    r == 0.0 && b == 0.0 && a > 0.0 && (f - e * math::tan(a)).abs() <= CONE * d
}

impl Data {
    /// Diameter in mm, if the file gave one.
    pub fn diameter(&self) -> Option<f64> {
        self.stated.then_some(self.cutter[0])
    }
}

impl Reader<'_> {
    pub(super) fn tool(&mut self, s: &Statement) {
        match s.major() {
            // What a screen shows of the holder.
            "CUTTER" if s.has("DISPLY") || s.has("HOLDER") => {}
            "CUTTER" => self.cutter(&s.numbers()),
            "TLDATA" => self.nx_data(s),
            "TOOLNO" | "LOADTL" => self.load_words(s),
            "LOAD" if s.has("TOOL") => self.load_words(s),
            "LOAD" => {}
            _ => {
                self.leave_cycle();
                self.end_operation();
                self.state.complete = true;
            }
        }
    }

    pub(super) fn cutter(&mut self, numbers: &[f64]) {
        const LENGTHS: [bool; 7] = [true, true, true, true, false, false, true];
        let Some(d) = numbers.first().filter(|d| **d >= 0.0 && d.is_finite()) else {
            return self.complain(&codes::BAD_RECORD, "CUTTER starts with the diameter".to_owned());
        };
        self.tell_doubt();
        let mut cutter = [0.0; 7];
        for ((slot, value), length) in cutter.iter_mut().zip(numbers).zip(LENGTHS) {
            *slot = if length { value * self.state.scale } else { value.to_radians() };
        }
        if numbers.len() < 3 {
            cutter[2] = d * self.state.scale / 2.0 - cutter[1];
            cutter[3] = cutter[1];
        }
        self.state.tool.cutter = cutter;
        self.state.tool.drill = is_cone(cutter);
        self.state.tool.stated = true;
        self.state.tool.fresh = true;
        self.state.tool.unseen = true;
    }

    /// `TLDATA/ MILL, d, r, length, taper, tip` or `DRILL, MILL, d, r, length, point angle, …`.
    fn nx_data(&mut self, s: &Statement) {
        if let Some(word) = s.words().find(|w| NOT_MILLING.contains(w)) {
            let message = format!("TLDATA with {word} cannot be carried out: the posts are for milling");
            return self.soften(&codes::NOT_CARRIED_OUT, message, None);
        }
        let numbers = s.numbers();
        let [d, r, ..] = *numbers else { return };
        let more = |at: usize| numbers.get(at).copied().filter(|v| v.is_finite()).unwrap_or(0.0);
        let (length, angle) = (more(2), more(3));
        if s.has("DRILL") {
            let slope = if angle > 0.0 && angle < STRAIGHT { (STRAIGHT - angle) / 2.0 } else { 0.0 };
            self.cutter(&[d, 0.0, 0.0, 0.0, slope, 0.0, length]);
            self.state.tool.drill = true;
        } else {
            self.cutter(&[d, r, d / 2.0 - r, r, more(4), angle, length]);
        }
    }

    /// `TOOL PATH/ operation, TOOL, tool`.
    pub(super) fn tool_path(&mut self, text: &str) {
        self.state.complete = false;
        self.state.cycle_cut = None;
        let parts: Vec<&str> = text.split(',').map(str::trim).collect();
        let word = parts.iter().rposition(|p| p.eq_ignore_ascii_case("TOOL")).unwrap_or(parts.len());
        let joined = |parts: &[&str]| parts.join(",");
        self.begin_named(joined(parts.get(..word).unwrap_or_default()));
        let tool = joined(parts.get(word + 1..).unwrap_or_default());
        let Some(tool) = Some(tool.as_str()).filter(|t| !t.is_empty()) else { return };
        let same = self.state.tool.name.as_deref() == Some(tool) || self.named_behind(tool);
        if !same {
            self.tell_doubt();
            self.state.tool = Data { name: Some(tool.to_owned()), ..Data::default() };
            self.state.sense_of_tool = false;
            self.state.load = Some(Load { number: None, words: String::new(), span: self.span });
        }
    }

    /// Whether a tool that was changed in by its number alone, and has not moved yet, gets its name here.
    fn named_behind(&mut self, name: &str) -> bool {
        if self.state.tool.name.is_some() || self.state.at.is_some() && self.state.load.is_none() {
            return false;
        }
        if self.state.load.as_ref().is_some_and(|load| load.number.is_none()) {
            return false;
        }
        if self.state.load.is_none() && self.state.loaded.is_none() {
            return false;
        }
        self.state.tool.name = Some(name.to_owned());
        true
    }

    /// `LOADTL/ n`, `LOAD/ TOOL, n`, `TOOLNO/ n`.
    fn load_words(&mut self, s: &Statement) {
        let number = s.numbers().first().copied();
        let number = number.filter(|n| *n >= 0.0 && n.fract() == 0.0 && *n <= 99_999_999.0).map(|n| n as u32);
        if number.is_none() && !s.args.is_empty() && !s.words().any(|w| w != "TOOL") {
            return self.complain(&codes::BAD_RECORD, "the tool number is no whole number".to_owned());
        }
        if s.major() == "TOOLNO" {
            // It describes the tool that LOADTL changes in; some systems write nothing else.
            if self.state.load.is_none() {
                self.load(number);
            }
            return;
        }
        let named = OFFSETS.iter().filter_map(|word| Some((format!("{word}, "), s.after(word)?)));
        // tool, pocket, length, offset of the length, offset of the diameter: as the posts of Autodesk write it
        let numbers = if s.only_numbers() { s.numbers() } else { Vec::new() };
        let placed = numbers.iter().skip(3).take(2).map(|offset| ("offset ".to_owned(), *offset));
        for (word, offset) in named.chain(placed) {
            if number.is_some_and(|number| offset != 0.0 && offset != f64::from(number)) {
                let message = format!(
                    "{} with {word}{offset} cannot be carried out: the offsets used are those of the tool's own number, {}",
                    s.major(),
                    number.unwrap_or_default()
                );
                self.soften(&codes::NOT_CARRIED_OUT, message, None);
            }
        }
        self.load(number);
        if let Some(load) = self.state.load.as_mut().filter(|_| number.is_some()) {
            load.words = further_words(s);
        }
        if number.is_none()
            && let Some(name) = s.words().find(|w| *w != "TOOL")
        {
            self.state.tool.name = Some(name.to_owned());
        }
        if let Some(rpm) = s.after("SPINDL").filter(|rpm| *rpm > 0.0 && rpm.is_finite()) {
            self.state.range = Gear::Any;
            let clockwise = self.sense(&s.words().collect::<Vec<_>>());
            self.turn_at(rpm, clockwise);
        }
    }

    pub(super) fn load(&mut self, number: Option<u32>) {
        let current = self.state.loaded.map(|t| &self.tools[t]);
        let same = number.is_some() && current.is_some_and(|t| t.number == number);
        if same && self.state.load.is_none() {
            return;
        }
        if self.state.loaded.is_some() && self.state.load.is_none() && !self.state.tool.fresh {
            // What is known is known of the tool before.
            self.state.tool = Data::default();
        } else if self.state.loaded.is_some() && self.state.load.is_none() {
            // The cutter is its own, the name is not.
            self.state.tool.name = None;
        }
        self.cut_cycle();
        self.state.sense_of_tool = false;
        self.state.load = Some(Load { number, words: String::new(), span: self.span });
    }

    /// The tool change that waits is due.
    pub(super) fn flush_tool(&mut self) {
        let Some(load) = self.state.load.take() else {
            if self.state.loaded.is_none() {
                self.lacks("LOADTL");
            }
            return;
        };
        let span = core::mem::replace(&mut self.span, load.span);
        // The cutter was that of this tool all along.
        self.state.doubt = None;
        self.state.tool.fresh = false;
        self.state.tool.unseen = false;
        let data = self.state.tool.clone();
        let [d, r, e, f, a, b, h] = data.cutter;
        let kind = match (r, d) {
            _ if data.drill => CutterKind::Drill,
            _ if a > 0.0 || b > 0.0 => CutterKind::Taper,
            (r, _) if r <= 0.0 => CutterKind::Flat,
            (r, d) if r >= d / 2.0 => CutterKind::Ball,
            _ => CutterKind::Bull,
        };
        let name = match (data.name, load.number) {
            (Some(name), _) => name,
            (None, Some(n)) => format!("T{n}"),
            (None, None) => "TOOL".to_owned(),
        };
        let origin = self.here();
        let known = self
            .tools
            .iter()
            .find(|(_, t)| t.number == load.number && t.name == name && t.diameter == d && t.corner == r);
        let known = known.map(|(handle, _)| handle);
        if known.is_none()
            && let Some(message) = self.other_cutter(load.number, d, r)
        {
            self.complain(&codes::OTHER_CUTTER, message);
        }
        let tool = match known {
            Some(tool) => tool,
            None => self.tools.push(Tool {
                kind,
                corner: r,
                profile: [e, f, a, b, h],
                words: load.words,
                ..Tool::flat(name, d, load.number, origin)
            }),
        };
        if self.state.loaded != Some(tool) {
            if self.tools[tool].number.is_none() {
                let name = &self.tools[tool].name;
                let message =
                    format!("the file gives {name} no number: it is called by the smallest that is free");
                self.complain(&codes::NO_TOOL_NUMBER, message);
            }
            self.emit(RecordKind::LoadTool(tool));
            self.state.loaded = Some(tool);
            self.state.spindle_recorded = false;
            self.state.recorded_feed = None;
            self.state.at = None;
            self.state.sure = false;
        }
        self.span = span;
        self.forget_origin();
        if let Some((coolant, span)) = self.state.first_coolant.take() {
            self.as_of(span, |reader| reader.switch_coolant(coolant));
        }
        self.go_to_first();
    }

    /// A cutter that is said of the tool that is there already, or early of the next one.
    #[cold]
    pub(super) fn see_cutter(&mut self) {
        if self.state.doubt.is_none() {
            let number = self.state.loaded.and_then(|tool| self.tools[tool].number);
            let [diameter, corner, ..] = self.state.tool.cutter;
            let message = self.other_cutter(number, diameter, corner);
            self.state.doubt = message.map(|message| Doubt { message, span: self.span, cuts: 0 });
        }
        let at_feed = !self.state.rapid;
        let told = match &mut self.state.doubt {
            Some(doubt) => {
                doubt.cuts += u32::from(at_feed);
                doubt.cuts > LAST_CUTS
            }
            None => true,
        };
        if told {
            self.tell_doubt();
            self.state.tool.unseen = false;
        }
    }

    /// The doubted cutter is one of the tool that is there.
    pub(super) fn tell_doubt(&mut self) {
        if let Some(doubt) = self.state.doubt.take() {
            self.as_of(doubt.span, |reader| reader.complain(&codes::OTHER_CUTTER, doubt.message));
        }
    }

    /// What to say of a number that has been that of another cutter: in the machine it is one tool.
    fn other_cutter(&self, number: Option<u32>, diameter: f64, corner: f64) -> Option<String> {
        let number = number.filter(|_| diameter > 0.0)?;
        let differ = |a: f64, b: f64| (a - b).abs() > SAME_SIZE;
        let other = self.tools.iter().map(|(_, t)| t).find(|t| {
            t.number == Some(number)
                && t.diameter > 0.0
                && (differ(t.diameter, diameter) || differ(t.corner, corner))
        })?;
        let scale = self.state.scale;
        let size = |d: f64, r: f64| {
            let corner =
                if r > 0.0 { format!(" and corner {}", number_of(r / scale)) } else { String::new() };
            format!("diameter {}{corner}", number_of(d / scale))
        };
        Some(format!(
            "tool {number} has {}, and had {} before: in the machine it is one tool",
            size(diameter, corner),
            size(other.diameter, other.corner)
        ))
    }

    /// The point at which the file wants the first tool: given before its change.
    fn go_to_first(&mut self) {
        if let Some((point, span)) = self.state.first.take() {
            self.begin_operation();
            self.as_of(span, |reader| reader.emit(RecordKind::From(point)));
            self.state.at = Some(point);
            self.state.sure = true;
        }
    }

    /// An operation with a name of its own comes next.
    pub(super) fn begin_named(&mut self, name: String) {
        self.leave_cycle();
        self.end_operation();
        self.state.operation_name = Some(name);
    }

    /// The operation of the moves that follow.
    pub(super) fn begin_operation(&mut self) {
        if self.state.operation.is_some() {
            return;
        }
        let index = u32::try_from(self.operations.len()).unwrap_or(u32::MAX);
        let name = self.state.operation_name.take().unwrap_or_else(|| format!("CL {}", index + 1));
        let origin = self.here();
        // Walls and blank are not known: nothing is guarded.
        let guard = Guard { top: f64::NEG_INFINITY, bottom: f64::NEG_INFINITY, ..Guard::default() };
        self.operations.push(Operation {
            name,
            kind: "CL",
            origin,
            band: self.state.band,
            guard,
            effort: None,
        });
        self.places.push(self.span);
        self.state.operation = Some(index);
        self.emit(RecordKind::BeginOperation(index));
    }

    pub(super) fn end_operation(&mut self) {
        if let Some(index) = self.state.operation.take() {
            self.emit(RecordKind::EndOperation(index));
        }
    }
}
