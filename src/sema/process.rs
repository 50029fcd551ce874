//! Program frame and modal state: units, machine, tool, spindle, feed, coolant, tolerances.

use std::rc::Rc;

use crate::arena::Handle;
use crate::diag::codes::{planning, semantics as codes};
use crate::diag::{Diagnostic, did_you_mean};
use crate::ir::{self, Band, Coolant, Feed, Spindle, StepKind, Tool};
use crate::math::TAU;
use crate::source::Span;
use crate::syntax::ast::{ArgKind, Command, Expr, ExprKind, Name, UnaryOp};
use crate::units::{Dim, LengthUnit, Quantity, number, tidy};

use super::Analyser;
use super::matched::{Matched, Typed};
use super::scope::{Array, Binding, BindingKind};
use super::transform::Transform;
use super::value::{Entity, Value};

/// A modal setting.
#[derive(Debug, Clone, Copy, Default)]
pub(super) enum Setting<T> {
    /// Not given so far.
    #[default]
    Unset,
    /// Given by the statement at the span.
    Set(T, Span),
    /// A statement that failed may have given it.
    Unknown,
}

impl<T> Setting<T> {
    fn forget(&mut self) {
        if matches!(self, Setting::Unset) {
            *self = Setting::Unknown;
        }
    }
}

/// What holds at this point of the program.
#[derive(Debug)]
pub(super) struct State {
    /// Loaded cutter.
    pub tool: Setting<Handle<Tool>>,
    /// Spindle.
    pub spindle: Setting<Spindle>,
    /// What `SPINDL/ ON` goes back to.
    pub last_speed: Option<Spindle>,
    /// Feed.
    pub feed: Setting<Feed>,
    /// What `COOLNT/ ON` goes back to.
    pub last_coolant: Coolant,
    /// `INTOL`, `OUTTOL`.
    pub band: Band,
    /// Where they were given last.
    pub band_at: Option<Span>,
    /// `THICK`, mm.
    pub thick: f64,
    /// `CUSP`, mm.
    pub cusp: Option<f64>,
    /// `CLEARP`, mm.
    pub clearance: f64,
    /// `RAPID` stands before the next move.
    pub rapid: bool,
    /// A drilling cycle is in force.
    pub cycle: bool,
    /// It has a feed of its own, or a pitch.
    pub cycle_feeds: bool,
    /// The `TRACUT` that has been told to tilt holes.
    pub tilt_told: Option<Span>,
    /// Side and register that `CUTCOM` has given last.
    pub last_compensation: Option<ir::Compensation>,
    /// `MULTAX/ ON`: points may have a tool axis.
    pub multi_axis: bool,
    /// A tool axis off Z has had its error.
    pub axis_told: bool,
    /// The cutter's position, mm, once it is known.
    pub position: Option<[f64; 3]>,
    /// `FROM` gave the position, and nothing has moved since.
    pub at_from: bool,
    /// A statement that failed may have moved the cutter.
    pub lost: bool,
    /// `TRACUT`, and where it was given.
    pub transform: Option<(Rc<Transform>, Span)>,
    /// `LOADTL/ n` before the cutter of that number.
    pub pending_number: Option<u32>,
    /// The last stock declared, for the depth of operations.
    pub stock: Option<Handle<ir::Stock>>,
}

/// Tolerances without a statement, mm.
const DEFAULT_BAND: Band = Band { into: 0.01, out: 0.01 };
/// Clearance without a statement, mm above the part.
const DEFAULT_CLEARANCE: f64 = 5.0;
/// `RESERV` takes at most this many elements for one name.
const ARRAY_SIZE: f64 = 1_000_000.0;

impl Default for State {
    fn default() -> Self {
        State {
            tool: Setting::Unset,
            spindle: Setting::Unset,
            last_speed: None,
            feed: Setting::Unset,
            last_coolant: Coolant::Flood,
            band: DEFAULT_BAND,
            band_at: None,
            thick: 0.0,
            cusp: None,
            clearance: DEFAULT_CLEARANCE,
            rapid: false,
            cycle: false,
            cycle_feeds: false,
            tilt_told: None,
            last_compensation: None,
            multi_axis: false,
            axis_told: false,
            position: None,
            at_from: false,
            lost: false,
            transform: None,
            pending_number: None,
            stock: None,
        }
    }
}

impl State {
    /// A statement has failed that may have set anything: what is missing later is not missed.
    pub fn forget(&mut self) {
        self.tool.forget();
        self.spindle.forget();
        self.feed.forget();
        self.lost = true;
    }
}

/// The tolerance of the drive surface: APT's second value; a single one counts for all.
fn drive_value(m: &Matched, name: &str) -> Option<f64> {
    let values: Vec<f64> = m
        .all(name)
        .filter_map(|f| match f.typed {
            Typed::Number(value) => Some(value),
            _ => None,
        })
        .collect();
    values.get(1).or(values.first()).copied()
}

impl Analyser<'_> {
    pub(super) fn units(&mut self, m: &Matched, span: Span) {
        let unit = match m.word("unit") {
            Some("MM") => LengthUnit::Millimetre,
            _ => LengthUnit::Inch,
        };
        if let Some(first) = self.unit_stated.filter(|_| unit != self.program.units) {
            let message = "the program's unit is set twice, and not to the same";
            self.report(Diagnostic::new(&codes::UNITS_LATE, span, message).label(first, "first here"));
            return;
        }
        if let Some(used) = self.unit_used.filter(|_| unit != self.program.units) {
            let message = "UNITS comes too late: bare numbers have been read in the other unit before";
            self.report(
                Diagnostic::new(&codes::UNITS_LATE, span, message)
                    .label(used, format!("read in {}", self.program.units.symbol()))
                    .help("put UNITS at the start of the program"),
            );
            return;
        }
        self.unit_stated = Some(span);
        self.program.units = unit;
    }

    /// `MACHIN/ post, ROTABL, C, REVERS, option…`: options that the vocabulary does not know are the post's.
    pub(super) fn machin(&mut self, command: &Command) {
        let mut words = command.args.iter();
        let Some(post) = words.next() else {
            let problem = Diagnostic::new(
                &codes::MISSING_VALUE,
                command.word.span,
                "MACHIN wants the name of a post here",
            )
            .help("for example `MACHIN/ LINUXCNC`");
            return self.report(problem);
        };
        let Some(name) = plain(&post.kind) else {
            let message = "the post of MACHIN is a name or a text in quotes";
            return self.report(Diagnostic::new(&codes::WRONG_KIND, post.span, message));
        };
        let origin = self.origin(self.here);
        let mut machine =
            ir::Machine { post: name.to_lowercase(), rotary: None, options: Vec::new(), origin };
        let mut rest = words.peekable();
        while let Some(arg) = rest.next() {
            let Some(key) = plain(&arg.kind) else {
                let message = "an option of MACHIN is a word or `WORD = value`";
                self.report(Diagnostic::new(&codes::WRONG_KIND, arg.span, message));
                continue;
            };
            if key.eq_ignore_ascii_case("ROTABL") {
                let letter = rest.peek().and_then(|a| plain(&a.kind)).filter(|t| t.len() == 1);
                if letter.is_some() {
                    rest.next();
                }
                let letter = letter.and_then(|t| t.chars().next()).map(|c| c.to_ascii_uppercase());
                let reversed = machine.rotary.is_some_and(|r| r.reversed);
                machine.rotary = Some(ir::Rotary { letter, reversed });
            } else if key.eq_ignore_ascii_case("REVERS") {
                let letter = machine.rotary.and_then(|r| r.letter);
                machine.rotary = Some(ir::Rotary { letter, reversed: true });
            } else {
                let value = option_value(&arg.kind);
                if let (None, ArgKind::Named { value, .. }) = (&value, &arg.kind) {
                    let message = "the value of an option is a number, a word or a text in quotes";
                    self.report(Diagnostic::new(&codes::WRONG_KIND, value.span, message));
                    continue;
                }
                machine.options.push((key.to_uppercase(), value));
            }
        }
        self.program.machines.push(machine);
    }

    pub(super) fn loadtl(&mut self, m: &Matched, span: Span) {
        if let Some(Entity::Cutter(tool)) = m.entity("tool") {
            return self.load_tool(*tool, span);
        }
        let Some(number) = m.number("number") else { return };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let wanted = number as u32;
        let found = self.program.tools.iter().find(|(_, t)| t.number == Some(wanted)).map(|(h, _)| h);
        match (found, &self.state.tool) {
            (Some(tool), _) => self.load_tool(tool, span),
            (None, Setting::Unset | Setting::Set(..)) if self.program.tools.is_empty() => {
                self.state.pending_number = Some(wanted);
            }
            (None, _) => {
                let numbers: Vec<String> =
                    self.program.tools.iter().filter_map(|(_, t)| Some(t.number?.to_string())).collect();
                let message = format!("no cutter has the number {wanted}");
                let mut problem = Diagnostic::new(&codes::UNKNOWN_NAME, m.span("number"), message);
                if !numbers.is_empty() {
                    problem = problem.note(format!("there are the numbers {}", numbers.join(", ")));
                }
                let help = format!("write `T{wanted} = CUTTER/ …, NUMBER, {wanted}` above");
                self.report(
                    problem.help(help).help("a CL file of a CAM system is posted with `partwright cl`"),
                );
                self.state.tool = Setting::Unknown;
            }
        }
    }

    pub(super) fn load_tool(&mut self, tool: Handle<Tool>, span: Span) {
        self.state.tool = Setting::Set(tool, span);
        if matches!(self.state.spindle, Setting::Set(..)) {
            // A tool change stops the spindle, and moves the machine to where it changes.
            self.state.spindle = Setting::Set(Spindle::Off, span);
        }
        if !self.state.at_from {
            self.state.position = None;
        }
        self.step(StepKind::LoadTool(tool));
    }

    pub(super) fn spindl(&mut self, m: &Matched, span: Span) {
        let spindle = match m.word("state") {
            Some("OFF") => Spindle::Off,
            Some(_) => match self.state.last_speed {
                Some(spindle) => spindle,
                None => {
                    let message = "SPINDL/ ON goes back to an earlier speed, and there is none";
                    self.report(
                        Diagnostic::new(&planning::SPINDLE_OFF, m.span("state"), message)
                            .help("write `SPINDL/ 1200`"),
                    );
                    self.state.spindle = Setting::Unknown;
                    return;
                }
            },
            None => {
                let rpm = tidy(m.number("speed").unwrap_or(0.0) * 60.0);
                Spindle::on(rpm, m.word("sense") != Some("CCLW"))
            }
        };
        if spindle != Spindle::Off {
            self.state.last_speed = Some(spindle);
        }
        self.state.spindle = Setting::Set(spindle, span);
        self.step(StepKind::Spindle(spindle));
    }

    pub(super) fn fedrat(&mut self, m: &Matched, span: Span) {
        let Some(Typed::Quantity(q)) = m.found.iter().find(|f| f.name == "feed").map(|f| f.typed.clone())
        else {
            return;
        };
        let at = m.span("feed");
        match self.feed(q, m.word("unit"), at) {
            Some(feed) => self.set_feed(feed, span),
            None => self.state.feed = Setting::Unknown,
        }
    }

    pub(super) fn set_feed(&mut self, feed: Feed, span: Span) {
        self.state.feed = Setting::Set(feed, span);
        self.step(StepKind::Feed(feed));
    }

    /// A feed from its number and unit word.
    pub(super) fn feed(&mut self, q: Quantity, word: Option<&str>, at: Span) -> Option<Feed> {
        let unit = match word {
            Some("MMPM" | "MMPR") => LengthUnit::Millimetre,
            Some("IPM" | "IPR") => LengthUnit::Inch,
            _ => self.unit(),
        };
        let dim = match word {
            Some("MMPM" | "IPM" | "PERMIN") => Dim::FEED,
            Some("MMPR" | "IPR" | "PERREV") => Dim::FEED_PER_REV,
            Some("PERTOO") => Dim::FEED_PER_TOOTH,
            _ if q.is_bare() => Dim::FEED,
            _ => q.dim,
        };
        if q.is_bare() && unit == self.unit() && self.unit_used.is_none() {
            self.unit_used = Some(at);
        }
        let Some(landed) = q.land(dim, unit) else {
            let message = format!(
                "{} says a {}, and {} is a {}",
                word.unwrap_or(""),
                dim.name(),
                self.show(q),
                q.dim.name()
            );
            self.report(Diagnostic::new(&codes::WRONG_DIMENSION, at, message));
            return None;
        };
        Some(match dim {
            Dim::FEED_PER_REV => Feed::PerRevolution(landed.value),
            Dim::FEED_PER_TOOTH => Feed::PerTooth(landed.value),
            _ => Feed::PerMinute(tidy(landed.value * 60.0)),
        })
    }

    pub(super) fn coolnt(&mut self, m: &Matched) {
        let coolant = match m.word("state") {
            Some("FLOOD") => Coolant::Flood,
            Some("MIST") => Coolant::Mist,
            Some("THRU") => Coolant::Through { needed: true },
            Some("ON") => self.state.last_coolant,
            _ => Coolant::Off,
        };
        if coolant != Coolant::Off {
            self.state.last_coolant = coolant;
        }
        self.step(StepKind::Coolant(coolant));
    }

    pub(super) fn tolerance(&mut self, word: &str, m: &Matched, span: Span) {
        let Some(value) = drive_value(m, "tolerance") else { return };
        match word {
            "INTOL" => self.state.band.into = value,
            "OUTTOL" => self.state.band.out = value,
            _ => self.state.band = Band { into: 0.0, out: value },
        }
        self.state.band_at = Some(span);
    }

    pub(super) fn tracut(&mut self, m: &Matched, span: Span) {
        self.state.transform = match m.entity("matrix") {
            Some(Entity::Matrix(matrix)) => Some((matrix.clone(), span)),
            _ => None,
        };
    }

    pub(super) fn thick(&mut self, m: &Matched) {
        if let Some(value) = drive_value(m, "thickness") {
            self.state.thick = value;
        }
    }

    /// `RESERV/ P, 6, A, 10`.
    pub(super) fn reserv(&mut self, command: &Command) {
        for pair in command.args.chunks(2) {
            let Some(name) = pair.first().and_then(lone_name) else {
                let span = pair.first().map_or(command.word.span, |a| a.span);
                let message = "RESERV takes pairs of a name and its largest subscript: `RESERV/ P, 6`";
                self.report(Diagnostic::new(&codes::WRONG_KIND, span, message));
                continue;
            };
            let Some(size) = pair.get(1) else {
                let message = format!("RESERV wants the largest subscript of {} after it", name.text);
                self.report(Diagnostic::new(&codes::MISSING_VALUE, name.span, message));
                continue;
            };
            let value = match &size.kind {
                ArgKind::Expr(expr) => self.evaluate(expr),
                _ => Value::Truth(false),
            };
            self.reserve(name, &value, size.span);
        }
        if command.args.is_empty() {
            let problem =
                Diagnostic::new(&codes::MISSING_VALUE, command.word.span, "RESERV wants a name here")
                    .help("for example `RESERV/ P, 6`");
            self.report(problem);
        }
    }

    fn reserve(&mut self, name: &Name, value: &Value, span: Span) {
        let size = match value {
            Value::Number(q) if q.is_bare() && q.value >= 1.0 && q.value <= ARRAY_SIZE => q.value,
            Value::Poison => return self.scope.poison(name),
            Value::Number(q) => {
                let message = format!(
                    "the largest subscript of {} is a number from 1 to {}, and this is {}",
                    name.text,
                    number(ARRAY_SIZE),
                    self.show(*q)
                );
                self.report(Diagnostic::new(&codes::OUT_OF_RANGE, span, message));
                return self.scope.poison(name);
            }
            other => {
                let message =
                    format!("the largest subscript of {} is a number, not {}", name.text, other.kind_name());
                self.report(Diagnostic::new(&codes::WRONG_KIND, span, message));
                return self.scope.poison(name);
            }
        };
        if self.may_declare(name) {
            #[allow(clippy::cast_possible_truncation)]
            let array = Array { size: Some(size as i64), ..Array::default() };
            self.scope
                .set(name.upper(), Binding { kind: BindingKind::Array(Rc::new(array)), declared: name.span });
        }
    }

    /// `PARTNO`, `PPRINT`, `INSERT` …
    pub(super) fn text(&mut self, word: &Name, text: &str) {
        match word.upper().as_str() {
            "PARTNO" if self.program.title.is_none() => self.program.title = Some(text.to_owned()),
            "PPRINT" => self.step(StepKind::Comment(text.to_owned())),
            "INSERT" => self.step(StepKind::Insert(text.to_owned())),
            _ => {}
        }
    }

    /// An unknown word at the start of a statement.
    pub(super) fn unknown_word(&mut self, word: &Name) {
        let message = format!("there is no statement {}", word.text);
        let problem = Diagnostic::new(&codes::UNKNOWN_WORD, word.span, message);
        let binding = self.scope.get(&word.upper());
        let problem = match (binding, did_you_mean(&word.text, crate::vocab::major_words())) {
            (Some(Binding { kind: BindingKind::Macro(_), declared }), _) => {
                problem.label(*declared, "this is a macro").help(format!("write `CALL/ {}, …`", word.text))
            }
            _ if is_nc_word(&word.text) => {
                problem.help("a block of the control's own language is copied by `INSERT`")
            }
            (_, Some(near)) => problem.help(format!("did you mean `{near}`?")),
            (_, None) => problem,
        };
        self.report(problem);
    }
}

/// `G01`, `M30`, `T1`: a letter and figures.
fn is_nc_word(text: &str) -> bool {
    let mut characters = text.chars();
    let letter = characters.next().is_some_and(|c| "GMTSFN".contains(c.to_ascii_uppercase()));
    let rest = characters.as_str();
    letter && !rest.is_empty() && rest.bytes().all(|b| b.is_ascii_digit())
}

/// The word, text or number that an argument is written as.
fn plain(kind: &ArgKind) -> Option<String> {
    match kind {
        ArgKind::Expr(Expr { kind: ExprKind::Name(name), .. }) | ArgKind::Named { name, .. } => {
            Some(name.text.clone())
        }
        ArgKind::Expr(Expr { kind: ExprKind::Text(text), .. }) => Some(text.clone()),
        ArgKind::Expr(Expr { kind: ExprKind::Number { value, unit }, .. }) => {
            Some(format!("{value}{}", unit.as_ref().map_or("", |u| u.text.as_str())))
        }
        _ => None,
    }
}

fn option_value(kind: &ArgKind) -> Option<String> {
    match kind {
        ArgKind::Named { value, .. } => match &value.kind {
            ExprKind::Unary { op: UnaryOp::Minus, operand, .. } => match operand.kind {
                ExprKind::Number { value, unit: None } => Some(format!("-{value}")),
                _ => None,
            },
            kind => plain(&ArgKind::Expr(Expr { kind: kind.clone(), span: value.span })),
        },
        _ => None,
    }
}

fn lone_name(arg: &crate::syntax::ast::Arg) -> Option<&Name> {
    match &arg.kind {
        ArgKind::Expr(Expr { kind: ExprKind::Name(name), .. }) => Some(name),
        _ => None,
    }
}

/// Radians of an angle in degrees.
pub(super) fn radians(degrees: f64) -> f64 {
    degrees * (TAU / 360.0)
}
