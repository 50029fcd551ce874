//! The reader: record by record, chunk by chunk.

use super::grammar::{self, Statement};
use super::lines::{Lines, Piece, raw_word, without_number};
use super::scan;
use super::state::State;
use super::told::Told;
use super::words::{self, Class};
use super::{Options, Producer, producer, unit};
use crate::arena::{Arena, Handle};
use crate::cl::{Cl, Operation, Record, RecordKind};
use crate::diag::codes::{foreign as codes, semantics};
use crate::diag::{Code, Diagnostic, Severity, Sink, did_you_mean};
use crate::ir::{Origin, Tool};
use crate::source::{FileId, Span};
use crate::units::LengthUnit;

/// A record that is not text for people has at most this many bytes.
const LONGEST_RECORD: usize = 1 << 16;
/// Of a word that is not known, messages show this many characters.
const SHOWN: usize = 40;

/// A line that says nothing: blank, or the marks at the ends of old files.
fn nothing(line: &str) -> bool {
    line.trim_matches(['%', '\u{1a}', '\u{feff}', ' ', '\t']).is_empty()
}

/// Reads a CL file.
#[derive(Debug)]
pub struct Reader<'t> {
    lines: Lines<'t>,
    file: FileId,
    pub(super) producer: Producer,
    lenient: bool,
    pub(super) state: State,
    title: Option<String>,
    units: LengthUnit,
    pub(super) tools: Arena<Tool>,
    pub(super) operations: Vec<Operation>,
    origins: Arena<Origin>,
    records: Vec<Record>,
    /// The record in hand.
    pub(super) span: Span,
    /// Its origin, once a CL record came of it.
    origin: Option<Handle<Origin>>,
    told: Told,
    /// The file says its unit, or the command does.
    unit_stated: bool,
    pub(super) axis_trouble: Option<AxisTrouble>,
    pub(super) missing: Vec<&'static str>,
    sink: Sink,
    over: bool,
    /// Tools and operations of the chunks before.
    known: (usize, usize),
    pub(super) places: Vec<Span>,
}

/// Points whose tool axis is off Z.
#[derive(Debug, Clone, Copy)]
pub(super) struct AxisTrouble {
    pub first: Span,
    pub axis: [f64; 3],
    pub count: u64,
    /// All of them have the same axis.
    pub same: bool,
}

impl<'t> Reader<'t> {
    /// A reader of `text`, which is file `file` called `name`.
    #[must_use]
    pub fn new(file: FileId, name: &str, text: &'t str, options: &Options) -> Reader<'t> {
        let producer =
            options.producer.or_else(|| producer::recognise(name, text)).unwrap_or(Producer::Plain);
        let stated = unit::stated(text, options);
        let units = stated.unwrap_or_default();
        let mut reader = Reader {
            lines: Lines::of_cards(text, options.card_columns),
            file,
            producer,
            lenient: options.lenient,
            state: State::new(units.in_mm()),
            title: None,
            units,
            tools: Arena::default(),
            operations: Vec::new(),
            origins: Arena::default(),
            records: Vec::new(),
            span: Span::new(file, 0, 0),
            origin: None,
            told: Told::default(),
            unit_stated: stated.is_some(),
            axis_trouble: None,
            missing: Vec::new(),
            sink: Sink::default(),
            over: false,
            known: (0, 0),
            places: Vec::new(),
        };
        reader.defines(&options.defines);
        reader
    }

    /// Who wrote the file.
    #[must_use]
    pub fn producer(&self) -> Producer {
        self.producer
    }

    /// Unit of the file.
    #[must_use]
    pub fn units(&self) -> LengthUnit {
        self.units
    }

    /// CL data of about `records` further records; `None` when the file is over. Tools and operations are those of
    /// the file so far.
    pub fn chunk(&mut self, records: usize) -> Option<Cl> {
        if self.over {
            return None;
        }
        self.records.reserve(records.min(1 << 20));
        while !self.state.ended && (self.records.len() < records || !self.between_moves()) {
            let Some((line, start)) = self.lines.line() else {
                self.state.ended = true;
                break;
            };
            self.line(line, start);
        }
        if self.state.ended {
            self.finish();
        }
        self.over = self.state.ended;
        let mut cl = Cl {
            title: self.title.clone(),
            units: self.units,
            tools: Arena::default(),
            origins: core::mem::take(&mut self.origins),
            operations: self.operations.clone(),
            records: core::mem::take(&mut self.records),
        };
        self.of_chunk(&mut cl);
        Some(cl)
    }

    /// A chunk ends between two moves, so that what belongs together stays together.
    fn between_moves(&self) -> bool {
        let straight = |r: &Record| matches!(r.kind, RecordKind::Linear(_) | RecordKind::Rapid(_));
        self.records.last().is_some_and(straight)
            && self.state.cycle.is_none()
            && self.state.circle.is_none()
            && self.state.nurbs.is_none()
    }

    /// Tools and operations of earlier chunks get an origin of this one: theirs are gone.
    fn of_chunk(&mut self, cl: &mut Cl) {
        let first = cl.origins.iter().next().map(|(handle, _)| handle);
        let any = match first {
            Some(handle) => handle,
            None => cl.origins.push(Origin { span: Span::new(self.file, 0, 0), calls: Vec::new() }),
        };
        let (tools, operations) = self.known;
        for (index, operation) in cl.operations.iter_mut().enumerate() {
            operation.origin = if index < operations { any } else { operation.origin };
        }
        for (index, (_, tool)) in self.tools.iter().enumerate() {
            let mut tool = tool.clone();
            tool.origin = if index < tools { any } else { tool.origin };
            cl.tools.push(tool);
        }
        self.known = (self.tools.len(), self.operations.len());
    }

    /// Where the operations stand in the file, in order.
    #[must_use]
    pub fn operation_places(&self) -> &[Span] {
        &self.places
    }

    /// Whether the last chunk was the last.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.over
    }

    /// The whole file at once.
    pub fn whole(mut self) -> (Cl, Sink) {
        let cl = self.chunk(usize::MAX).unwrap_or_default();
        (cl, self.sink)
    }

    /// Messages so far.
    pub fn messages(&mut self) -> Sink {
        core::mem::take(&mut self.sink)
    }

    fn line(&mut self, line: &'t str, start: usize) {
        self.origin = None;
        if self.producer == Producer::Mastercam {
            self.span = Span::new(self.file, start, start + line.len());
            return self.pair_line(line, start);
        }
        if let Some(goto) = scan::goto(line.as_bytes()) {
            self.span = Span::new(self.file, start, start + line.len());
            return self.goto(&goto.values, goto.count);
        }
        let placed = self.lines.piece(line, start);
        self.span = Span::new(self.file, placed.start, placed.end);
        match &placed.piece {
            Piece::Comment(text) => self.comment(text),
            Piece::Metadata(text) => self.comment(text),
            Piece::Line(text) => self.record_text(text),
            Piece::Joined(text) => self.record_text(text),
        }
    }

    /// Comments hold what CATIA and Creo say nowhere else.
    fn comment(&mut self, text: &str) {
        let body = text.trim_start_matches('$').trim();
        if let Some(metadata) = text.strip_prefix("$$->") {
            return self.metadata(metadata.trim());
        }
        let upper = body.to_uppercase();
        if let Some(name) = upper.strip_prefix("OPERATION NAME") {
            let name = name.trim_start_matches([' ', ':']).trim();
            self.begin_named(name.to_owned());
        } else if let Some(name) =
            body.strip_prefix("OPERATION ").filter(|_| self.producer == Producer::Plain)
        {
            // As `--emit cl` and the post `apt-cl` write it: with a number before it, or without.
            let (number, rest) = name.split_once(": ").unwrap_or(("", name));
            let name = if number.parse::<u32>().is_ok() { rest } else { name };
            let name = name.strip_prefix("CL ").filter(|n| n.parse::<u32>().is_err()).unwrap_or(name);
            self.begin_named(name.to_owned());
        }
    }

    fn record_text(&mut self, text: &str) {
        let trimmed = text.trim();
        let record = without_number(trimmed);
        if nothing(record) {
            return;
        }
        if let Some((word, rest)) = raw_word(record) {
            return self.raw(word, rest);
        }
        if text.len() > LONGEST_RECORD {
            let message = format!(
                "a record of {} bytes with its blanks: they have {LONGEST_RECORD} at most",
                text.len()
            );
            return self.complain(&codes::BAD_RECORD, message);
        }
        if self.state.continues && trimmed.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) {
            let goto = format!("GOTO/{trimmed}");
            if let Some(goto) = scan::goto(goto.as_bytes()) {
                return self.goto(&goto.values, goto.count);
            }
        }
        match grammar::parse(text) {
            Ok(statement) => self.statement(&statement),
            Err(at) => self.not_a_record(text, at.0),
        }
    }

    fn not_a_record(&mut self, text: &str, at: usize) {
        let rest: String = text.get(at..).unwrap_or("").trim().chars().take(20).collect();
        let message = if rest.is_empty() {
            "the record stops too early".to_owned()
        } else {
            format!("this is no CL record from `{rest}` on")
        };
        self.complain(&codes::BAD_RECORD, message);
    }

    /// Words whose text stands as it is.
    fn raw(&mut self, word: &'static str, text: &str) {
        self.state.continues = false;
        match word {
            "PARTNO" if self.title.is_none() && !text.is_empty() => self.title = Some(text.to_owned()),
            "PARTNO" => {}
            "TOOL PATH" => self.tool_path(text),
            "INSERT" if !self.producer.inserts_are_comments() => {
                self.settle();
                self.emit(RecordKind::Insert(text.to_owned()));
            }
            "PPRINT" | "TPRINT" | "INSERT" | "CSI_PROGRAM_COMMENT" => {
                self.settle();
                if !text.is_empty() {
                    self.emit(RecordKind::Comment(text.to_owned()));
                }
            }
            _ => {}
        }
    }

    /// A record by its major word.
    pub(super) fn statement(&mut self, s: &Statement) {
        if !matches!(s.major(), "KNOT" | "CNTRL") {
            self.flush_nurbs();
        }
        // Points of an arc may have colours among them; what moves nothing may stand before its point.
        match s.major() {
            "GOTO" | "GODLTA" | "PAINT" => {}
            "FEDRAT" | "SPINDL" | "COOLNT" | "CUTCOM" | "DELAY" | "DWELL" | "INTOL" | "OUTTOL" | "TOLER"
            | "MULTAX" => self.flush_circle(),
            word if words::class(word) == Some(Class::Harmless) => self.flush_circle(),
            _ => self.end_circle(),
        }
        self.state.continues = false;
        match s.major() {
            "GOTO" | "GODLTA" | "FROM" | "GOHOME" | "RAPID" | "MULTAX" | "TLAXIS" => self.motion(s),
            "CIRCLE" | "MOVARC" => self.circle(s),
            "CYCLE" => self.cycle(s),
            "NURBS" | "KNOT" | "CNTRL" => self.nurbs(s),
            "INDIRV" | "PSIS" | "TLON" | "TLLFT" | "TLRGT" | "HELICAL" => self.catia(s),
            "CUTTER" | "TLDATA" | "LOADTL" | "LOAD" | "TOOLNO" | "END-OF-PATH" => self.tool(s),
            "MSYS" | "CSYS" | "MCS" | "TRNTYP" => self.frame(s),
            "END" | "FINI" => {
                self.state.ended = true;
                self.state.complete = true;
            }
            "FEDRAT" | "SPINDL" | "COOLNT" | "DELAY" | "DWELL" | "STOP" | "OPSTOP" | "UNITS" | "UNIT"
            | "INTOL" | "OUTTOL" | "TOLER" | "CUTCOM" => self.process(s),
            other => self.other(other, s),
        }
    }

    fn other(&mut self, word: &str, s: &Statement) {
        match words::class(word) {
            Some(Class::Harmless) => {}
            Some(Class::Matters(_)) if s.only_numbers() && zero(s) && matches!(word, "ORIGIN" | "TRANS") => {}
            Some(Class::Matters(_)) if words::already_so(word, &s.words().collect::<Vec<_>>()) => {}
            Some(Class::Matters(why)) => {
                let message = format!("{word} cannot be carried out: {why}");
                let place = words::PLACES.contains(&word);
                let help = place.then(|| "without it what follows is cut where its points stand".to_owned());
                self.soften(&codes::NOT_CARRIED_OUT, message, help);
            }
            None => {
                let short: String = word.chars().take(SHOWN).collect();
                let near = did_you_mean(&short, words::CARRIED_OUT.iter().copied());
                let help = near.map(|n| format!("did you mean `{n}`?"));
                let more = if short.len() < word.len() { "…" } else { "" };
                let message = format!("the record `{short}{more}` is not known");
                self.soften(&codes::UNKNOWN_RECORD, message, help);
            }
        }
    }

    /// What stands behind the end is not read; that it does is said.
    fn look_behind(&mut self) {
        let silent = |line: &str| {
            let word = line.trim();
            nothing(word)
                || word.starts_with("$$")
                || matches!(word.trim_end_matches(['/', ' ']), "FINI" | "END" | "END-OF-PATH")
        };
        while let Some((line, start)) = self.lines.line() {
            if !silent(without_number(line.trim())) {
                self.span = Span::new(self.file, start, start + line.len());
                let message = "this and what follows stands behind the end of the program: it is not read";
                return self.complain(&semantics::AFTER_FINI, message.to_owned());
            }
        }
    }

    fn finish(&mut self) {
        self.flush_nurbs();
        self.end_circle();
        if self.producer != Producer::Mastercam {
            self.look_behind();
        }
        self.leave_cycle();
        self.end_operation();
        self.tell_doubt();
        if let Some(trouble) = self.axis_trouble.take() {
            self.report_axis(&trouble);
        }
        self.doubts();
        self.told.finish(Span::new(self.file, 0, 0), &mut self.sink);
    }

    /// What is odd about the file as a whole.
    fn doubts(&mut self) {
        self.span = Span::new(self.file, 0, 0);
        if self.state.at.is_some() {
            let end = self.producer.end().filter(|_| !self.state.complete);
            if let Some(end) = end {
                let message = format!("the file stops without {end}: it may not be all there");
                self.complain(&codes::CUT_OFF, message);
            }
            if !self.unit_stated {
                let message = format!("the file does not say its unit: {} is taken", self.units.symbol());
                let help = "say it with -D UNITS=INCH or -D UNITS=MM";
                self.tell(Diagnostic::new(&codes::UNIT_ASSUMED, self.span, message).help(help));
            }
        } else if self.told.is_empty() {
            let silent = |line: &str| nothing(line) || line.trim_start().starts_with("$$");
            let empty = self.lines.text().split(['\n', '\r']).all(silent);
            let (code, message) = if empty {
                (&codes::NO_RECORDS, "there is no CL record in this file")
            } else {
                (&codes::NO_MOTION, "no record of this file moves the tool")
            };
            self.complain(code, message.to_owned());
        }
    }

    /// What was waiting for more records is done with.
    pub(super) fn settle(&mut self) {
        self.flush_nurbs();
        self.flush_circle();
    }

    /// Adds a record; its origin is the record in hand.
    pub(super) fn emit(&mut self, kind: RecordKind) {
        if self.state.home.is_some() {
            match kind {
                // It goes to where tools are changed from anywhere.
                RecordKind::LoadTool(_) => self.state.home = None,
                RecordKind::From(_)
                | RecordKind::Rapid(_)
                | RecordKind::Linear(_)
                | RecordKind::Circle(_)
                | RecordKind::Spline(_)
                | RecordKind::Hole(_) => self.move_from_home(),
                _ => {}
            }
        }
        let origin = match self.origin {
            Some(origin) => origin,
            None => {
                let origin = self.origins.push(Origin { span: self.span, calls: Vec::new() });
                self.origin = Some(origin);
                origin
            }
        };
        self.records.push(Record { kind, origin });
    }

    /// The origin of what comes next, without a record.
    pub(super) fn here(&mut self) -> Handle<Origin> {
        match self.origin {
            Some(origin) => origin,
            None => {
                let origin = self.origins.push(Origin { span: self.span, calls: Vec::new() });
                self.origin = Some(origin);
                origin
            }
        }
    }

    /// The next record has an origin of its own.
    pub(super) fn forget_origin(&mut self) {
        self.origin = None;
    }

    /// Does what a statement before asked for, and says so.
    pub(super) fn as_of(&mut self, span: Span, what: impl FnOnce(&mut Self)) {
        let here = core::mem::replace(&mut self.span, span);
        self.forget_origin();
        what(self);
        self.span = here;
        self.forget_origin();
    }

    /// `$$->` comments of Creo.
    fn metadata(&mut self, text: &str) {
        let Ok(s) = grammar::parse(text) else { return };
        match s.major() {
            "CUTTER" => self.cutter(&s.numbers()),
            "CSYS" => self.frame_numbers("CSYS", &s.numbers()),
            _ => {}
        }
    }

    /// An error, or what the code is, at the record in hand.
    pub(super) fn complain(&mut self, code: &'static Code, message: String) {
        self.tell(Diagnostic::new(code, self.span, message));
    }

    /// An error that `--lenient` makes a warning of.
    pub(super) fn soften(&mut self, code: &'static Code, message: String, help: Option<String>) {
        let mut diagnostic = Diagnostic::new(code, self.span, message);
        if let Some(help) = help {
            diagnostic = diagnostic.help(help);
        }
        if self.lenient {
            diagnostic.severity = Severity::Warning;
        } else {
            diagnostic = diagnostic.help("`--lenient` goes on without it, with a warning");
        }
        self.tell(diagnostic);
    }

    pub(super) fn lenient(&self) -> bool {
        self.lenient
    }

    pub(super) fn tell(&mut self, diagnostic: Diagnostic) {
        self.told.tell(diagnostic);
    }

    pub(super) fn set_units(&mut self, unit: LengthUnit) {
        if self.state.moved && unit != self.units {
            return self.complain(&codes::BAD_RECORD, "the unit changes after the first point".to_owned());
        }
        self.units = unit;
        self.state.scale = unit.in_mm();
    }
}

fn zero(s: &Statement) -> bool {
    s.numbers().iter().all(|v| *v == 0.0)
}
