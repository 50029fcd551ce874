//! Everything that is not a straight move or an arc: templates, spindle, coolant, dwell, texts, curves.

use minijinja::value::{Serde, Value};
use serde::Serialize;

use super::check::template_error;
use super::dialect::Dwell;
use super::number;
use super::table::{PER_MINUTE, WordFormat, word};
use super::template::Renderer;
use super::writer::{ModalState, Writer, split_feed};
use crate::arena::Arena;
use crate::diag::{Code, Diagnostic, codes};
use crate::ir::{Coolant, CutterKind, Origin, Spindle, Tool};
use crate::target::{BlockKind, FeedWord, NurbsForm, TargetProgram};
use crate::units::LengthUnit;

/// What every template can read.
#[derive(Serialize)]
struct Context<'a> {
    post: PostContext<'a>,
    program: ProgramContext,
    tools: Vec<ToolContext>,
    rotary: Option<String>,
    safe_start: String,
    options: &'a std::collections::BTreeMap<String, String>,
    /// Whether the spindle turns.
    spindle_on: bool,
    /// Whether coolant flows.
    coolant_on: bool,
    /// The tool being changed to, in tool-change blocks.
    #[serde(skip_serializing_if = "Option::is_none")]
    tool: Option<ToolContext>,
    /// Whether it is the first tool of the program.
    #[serde(skip_serializing_if = "Option::is_none")]
    first: Option<bool>,
    /// The spindle command that follows the tool change: `rpm` and `code`; `rpm` is 0 when there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    spindle: Option<SpindleContext>,
    #[serde(skip_serializing_if = "Option::is_none")]
    operation: Option<OperationContext>,
}

#[derive(Serialize)]
struct PostContext<'a> {
    name: &'a str,
    title: &'a str,
}

#[derive(Serialize)]
struct ProgramContext {
    /// Cleaned for comments; empty when there is none.
    title: String,
    /// Letters and digits only.
    name: String,
    number: u32,
    units: &'static str,
}

#[derive(Serialize, Clone)]
struct ToolContext {
    number: u32,
    name: String,
    kind: &'static str,
    diameter: String,
    corner: String,
    text: String,
}

#[derive(Serialize)]
struct SpindleContext {
    rpm: i64,
    code: String,
}

#[derive(Serialize)]
struct OperationContext {
    name: String,
}

/// The writer with what templates need.
pub(super) struct Events<'a> {
    pub writer: Writer<'a>,
    program: &'a TargetProgram,
    origins: &'a Arena<Origin>,
    renderer: Renderer,
    tool_changes: usize,
    dwell: WordFormat,
    spindle: WordFormat,
    spindle_on: bool,
    coolant_on: bool,
}

impl<'a> Events<'a> {
    pub fn new(mut writer: Writer<'a>, program: &'a TargetProgram, origins: &'a Arena<Origin>) -> Events<'a> {
        let spec = &writer.dialect.spec;
        let unit = program.capabilities.grid.unit;
        let renderer = Renderer::new(&spec.comments);
        let dwell = word(spec, &spec.dwell.word, false, unit);
        let spindle = word(spec, "spindle", false, unit);
        if program.capabilities.rotary.is_none() {
            writer.state.axes[3] = Some(0);
        }
        Events {
            writer,
            program,
            origins,
            renderer,
            tool_changes: 0,
            dwell,
            spindle,
            spindle_on: false,
            coolant_on: false,
        }
    }

    pub fn into_writer(self) -> Writer<'a> {
        self.writer
    }

    fn unit(&self) -> LengthUnit {
        self.program.capabilities.grid.unit
    }

    fn error(&mut self, code: &'static Code, message: String) {
        let diagnostic = crate::lower::place::at_origin(code, self.origins, self.writer.origin, message);
        self.writer.errors.push(diagnostic);
    }

    /// Any block that is not a motion.
    pub fn event(&mut self, index: usize, kind: &BlockKind) {
        match kind {
            BlockKind::Begin => self.begin(),
            BlockKind::End => self.end(),
            BlockKind::ToolChange(tool) => self.tool_change(index, *tool),
            BlockKind::Spindle(spindle) => self.spindle(*spindle),
            BlockKind::Coolant(coolant) => self.coolant(*coolant),
            BlockKind::Dwell(seconds) => self.dwell(*seconds),
            BlockKind::Stop => self.stop(false),
            BlockKind::OptionalStop => self.stop(true),
            BlockKind::Comment(text) => self.comment(text),
            BlockKind::Insert(text) => self.insert(text),
            BlockKind::PathTolerance(tolerance) => self.path_tolerance(*tolerance),
            BlockKind::BeginOperation(name) => self.operation(name),
            // No dialect lists cycles yet, so none are kept.
            BlockKind::Motion(_) | BlockKind::BeginCycle(_) | BlockKind::Hole(_) | BlockKind::EndCycle => {}
        }
    }

    fn begin(&mut self) {
        let spec = &self.writer.dialect.spec;
        let context = Value::from(Serde(self.context()));
        self.template("templates.header", &spec.templates.header, &context);
        self.writer.state.mode = Some(PER_MINUTE);
        let exact = &spec.path_control.exact;
        let starts_exact =
            exact.is_empty() || spec.groups.values().any(|g| g.start.of(self.unit()) == *exact);
        if starts_exact {
            self.writer.state.path = Some(None);
        }
    }

    /// The program leaves the control in feed per minute.
    fn end(&mut self) {
        let spec = &self.writer.dialect.spec;
        if !matches!(self.writer.state.mode, None | Some(PER_MINUTE)) {
            self.writer.text_line(&spec.codes.per_minute, true);
        }
        let context = Value::from(Serde(self.context()));
        self.template("templates.footer", &spec.templates.footer, &context);
    }

    /// What the machine did in a tool change is its own affair: everything is said again after it.
    fn tool_change(&mut self, index: usize, tool: u32) {
        let change = &self.writer.dialect.spec.tool_change;
        let Some(tool) = self.program.tools.get(tool as usize) else { return };
        let mut context = self.context();
        context.tool = Some(self.tool_context(tool));
        context.first = Some(self.tool_changes == 0);
        context.spindle = Some(self.spindle_after(index));
        let context = Value::from(Serde(context));
        for name in &change.order {
            if let Some(template) = change.blocks.get(name) {
                self.template(&format!("tool-change.blocks.{name}"), template, &context);
            }
        }
        self.writer.with_first_z = self.words("tool-change.with-first-z", &change.with_first_z, &context);
        self.tool_changes += 1;
        self.spindle_on = false;
        self.coolant_on = false;
        self.writer.state.feed = None;
        self.writer.state.motion = None;
        let rotary = self.program.capabilities.rotary.is_none().then_some(0);
        self.writer.state.axes = [None, None, None, rotary];
    }

    /// The spindle command before the next tool change.
    fn spindle_after(&self, index: usize) -> SpindleContext {
        let rest = self.program.blocks.get(index + 1..).unwrap_or_default();
        let found = rest
            .iter()
            .take_while(|b| !matches!(b.kind, BlockKind::ToolChange(_) | BlockKind::Motion(_)))
            .find_map(|b| if let BlockKind::Spindle(spindle) = b.kind { Some(spindle) } else { None });
        match found {
            Some(Spindle::On { rpm, clockwise }) => {
                let code = self.spindle_code(clockwise).to_owned();
                SpindleContext { rpm: number::steps(rpm, 0).unwrap_or(0), code }
            }
            _ => SpindleContext { rpm: 0, code: String::new() },
        }
    }

    fn operation(&mut self, name: &str) {
        let spec = &self.writer.dialect.spec;
        let mut context = self.context();
        context.operation = Some(OperationContext { name: spec.comments.clean(name) });
        self.template("templates.operation", &spec.templates.operation, &Value::from(Serde(context)));
    }

    fn template(&mut self, path: &str, template: &str, context: &Value) {
        match self.renderer.lines(template, context) {
            Ok(lines) => lines.iter().for_each(|line| self.template_line(line)),
            Err(error) => {
                let diagnostic = template_error(self.writer.dialect, path, &error);
                self.writer.errors.push(diagnostic);
            }
        }
    }

    /// A template that gives words for a block.
    fn words(&mut self, path: &str, template: &str, context: &Value) -> Vec<u8> {
        match self.renderer.lines(template, context) {
            Ok(lines) => lines.join(" ").into_bytes(),
            Err(error) => {
                let diagnostic = template_error(self.writer.dialect, path, &error);
                self.writer.errors.push(diagnostic);
                Vec::new()
            }
        }
    }

    fn template_line(&mut self, line: &str) {
        if !line.bytes().all(|b| b.is_ascii_graphic() || b == b' ') {
            let message = format!("a template printed a character that is no printable ASCII: {line:?}");
            self.writer.errors.push(Diagnostic::global(&codes::post::BAD_TEMPLATE, message));
            return;
        }
        let numbered = self.is_block(line);
        self.writer.text_line(line, numbered);
    }

    /// Whether a line is a block of the program rather than its frame or a comment.
    fn is_block(&self, line: &str) -> bool {
        let spec = &self.writer.dialect.spec;
        if spec.numbering.mode == super::dialect::NumberingMode::Lines {
            return true;
        }
        let comment = !spec.comments.open.is_empty() && line.starts_with(&spec.comments.open);
        !(comment || line.starts_with(['%', 'O', ':', '<']))
    }

    fn spindle_code(&self, clockwise: bool) -> &'a str {
        let words = &self.writer.dialect.spec.spindle;
        if clockwise { &words.clockwise } else { &words.counter_clockwise }
    }

    fn spindle(&mut self, spindle: Spindle) {
        let words = &self.writer.dialect.spec.spindle;
        self.spindle_on = spindle != Spindle::Off;
        self.writer.begin_line(true);
        match spindle {
            Spindle::Off => self.writer.text(words.off.as_bytes()),
            Spindle::On { rpm, clockwise } => {
                self.spindle_on(rpm, self.spindle_code(clockwise), &words.order)
            }
        }
        self.writer.end_line();
    }

    fn spindle_on(&mut self, rpm: f64, code: &str, order: &str) {
        let decimals = self.spindle.style.decimals;
        let range = self.writer.dialect.spec.range("spindle", self.unit());
        let Some(speed) = number::steps(rpm, decimals).filter(|s| (1..=range).contains(s)) else {
            let message =
                format!("the spindle speed {rpm} rev/min does not fit the word `S` of this control");
            self.error(&codes::post::WORD_RANGE, message);
            return;
        };
        if order == "code-first" {
            self.writer.text(code.as_bytes());
        }
        self.writer.number(&self.spindle, speed);
        if order == "speed-first" {
            self.writer.text(code.as_bytes());
        }
    }

    fn coolant(&mut self, coolant: Coolant) {
        self.coolant_on = coolant != Coolant::Off;
        let words = &self.writer.dialect.spec.coolant;
        let code = match coolant {
            Coolant::Off => &words.off,
            Coolant::Flood => &words.flood,
            Coolant::Mist => &words.mist,
        };
        self.writer.text_line(code, true);
    }

    fn dwell(&mut self, seconds: f64) {
        let rules = &self.writer.dialect.spec.dwell;
        let range = self.writer.dialect.spec.range(&rules.word, self.unit());
        let steps = dwell_steps(seconds, rules).filter(|s| (0..=range).contains(s) && seconds <= rules.max);
        let Some(steps) = steps else {
            let message =
                format!("a dwell of {seconds} s does not fit this control's word (at most {} s)", rules.max);
            self.error(&codes::post::WORD_RANGE, message);
            return;
        };
        self.writer.begin_line(true);
        self.writer.text(rules.code.as_bytes());
        self.dwell.style.decimals = rules.decimals;
        self.writer.number(&self.dwell, steps);
        self.writer.end_line();
    }

    fn stop(&mut self, optional: bool) {
        let words = &self.writer.dialect.spec.stops;
        let code = if optional { &words.optional } else { &words.stop };
        self.writer.text_line(code, true);
    }

    fn comment(&mut self, text: &str) {
        let lines = self.writer.dialect.spec.comments.lines(text);
        let numbered = self.writer.dialect.spec.numbering.mode == super::dialect::NumberingMode::Lines;
        lines.iter().for_each(|line| self.writer.text_line(line, numbered));
    }

    /// Verbatim; what it does is unknown, so every modal word is said again.
    fn insert(&mut self, text: &str) {
        if let Some(bad) = text.chars().find(|c| !(c.is_ascii_graphic() || *c == ' ' || *c == '\t')) {
            let message = format!("INSERT is one line of printable ASCII; it holds {bad:?}");
            self.error(&codes::post::BAD_INSERT, message);
            return;
        }
        self.writer.text_line(text.trim_end(), false);
        self.writer.state = ModalState::default();
    }

    fn path_tolerance(&mut self, tolerance: Option<f64>) {
        let spec = &self.writer.dialect.spec;
        let unit = self.unit();
        let format = word(spec, "path-tolerance", false, unit);
        // Rounded down: the control never gets more than it was given.
        let decimals = format.style.decimals;
        let down = |mm: f64| {
            number::steps(mm / unit.in_mm() - 0.5 / crate::target::power_of_ten(decimals), decimals)
        };
        let steps = tolerance.and_then(down).filter(|s| *s > 0 && !spec.path_control.tolerance.is_empty());
        if self.writer.state.path == Some(steps) {
            return;
        }
        self.writer.begin_line(true);
        match steps {
            Some(steps) => {
                self.writer.text(spec.path_control.tolerance.as_bytes());
                self.writer.number(&format, steps);
                self.writer.text(spec.path_control.after.as_bytes());
            }
            None => self.writer.text(spec.path_control.exact.as_bytes()),
        }
        self.writer.end_line();
        self.writer.state.path = Some(steps);
    }

    /// A NURBS curve, one block a control point.
    pub fn nurbs(&mut self, curve: u32, feed: FeedWord) {
        let Some(form) = self.program.capabilities.nurbs else { return };
        match form {
            NurbsForm::G062 { .. } => self.nurbs_fanuc(curve, feed),
            NurbsForm::G052 => self.nurbs_linuxcnc(curve, feed),
        }
    }

    fn begin_nurbs(&mut self, feed: FeedWord) {
        let (mode, _) = split_feed(feed);
        if self.writer.state.mode != Some(mode) {
            let code = self.writer.table.modes[mode].clone();
            self.writer.begin_line(true);
            self.writer.text(&code);
            self.writer.end_line();
            self.writer.state.mode = Some(mode);
            self.writer.state.feed = None;
        }
    }

    fn nurbs_feed(&mut self, feed: FeedWord) {
        let (mode, value) = split_feed(feed);
        if self.writer.state.feed != Some(value) {
            let format = self.writer.table.feeds[mode].clone();
            self.writer.number(&format, value);
            self.writer.state.feed = Some(value);
        }
    }

    fn nurbs_words(&self) -> (WordFormat, WordFormat, WordFormat) {
        let spec = &self.writer.dialect.spec;
        let mut weight = word(spec, "weight", false, self.unit());
        weight.style.decimals = spec.nurbs.weight_decimals;
        let mut knot = word(spec, "knot", false, self.unit());
        knot.style.decimals = spec.nurbs.knot_decimals;
        (weight, knot, word(spec, "order", false, self.unit()))
    }

    fn real(&mut self, format: &WordFormat, value: f64) {
        match number::steps(value, format.style.decimals) {
            Some(steps) => self.writer.number(format, steps),
            None => {
                self.error(&codes::post::WORD_RANGE, format!("{value} cannot be printed in a NURBS block"))
            }
        }
    }

    fn nurbs_point(&mut self, position: crate::target::Position) {
        let words = [super::pattern::Slot::X, super::pattern::Slot::Y]
            .map(|s| self.writer.table.words[s as usize].clone());
        self.writer.number(&words[0], position.x);
        self.writer.number(&words[1], position.y);
    }

    /// `G5.2 P L F`, then `X Y P` for every point but the first, then `G5.3`.
    fn nurbs_linuxcnc(&mut self, curve: u32, feed: FeedWord) {
        let Some(nurbs) = self.program.nurbs.get(curve as usize) else { return };
        let (weight, _, order) = self.nurbs_words();
        self.begin_nurbs(feed);
        for (index, (position, w)) in nurbs.points.iter().enumerate() {
            self.writer.begin_line(true);
            if index == 0 {
                self.writer.text(b"G5.2");
                self.real(&weight, *w);
                self.writer.number(&order, i64::from(nurbs.order));
                self.nurbs_feed(feed);
            } else {
                self.nurbs_point(*position);
                self.real(&weight, *w);
            }
            self.writer.end_line();
        }
        self.writer.text_line("G5.3", true);
        self.nurbs_arrive(nurbs);
    }

    /// `G06.2 P K X Y R F`, then `K X Y R` for every point, then knots alone.
    fn nurbs_fanuc(&mut self, curve: u32, feed: FeedWord) {
        let Some(nurbs) = self.program.nurbs.get(curve as usize) else { return };
        let (weight, knot, order) = self.nurbs_words();
        self.begin_nurbs(feed);
        for (index, k) in nurbs.knots.iter().enumerate() {
            self.writer.begin_line(true);
            if index == 0 {
                self.writer.text(b"G6.2");
                self.writer.number(&order, i64::from(nurbs.order));
            }
            self.real(&knot, *k);
            if let Some((position, w)) = nurbs.points.get(index) {
                self.nurbs_point(*position);
                self.real(&weight, *w);
            }
            if index == 0 {
                self.nurbs_feed(feed);
            }
            self.writer.end_line();
        }
        self.nurbs_arrive(nurbs);
    }

    fn nurbs_arrive(&mut self, nurbs: &crate::target::Nurbs) {
        self.writer.state.motion = None;
        if let Some((end, _)) = nurbs.points.last() {
            self.writer.position = *end;
            self.writer.state.axes[0] = Some(end.x);
            self.writer.state.axes[1] = Some(end.y);
        }
    }

    fn context(&self) -> Context<'a> {
        let dialect = self.writer.dialect;
        Context {
            post: PostContext { name: &dialect.name, title: &dialect.spec.post.title },
            program: self.program_context(),
            tools: self.program.tools.iter().map(|tool| self.tool_context(tool)).collect(),
            rotary: self.program.capabilities.rotary.map(|r| r.letter.to_string()),
            safe_start: self.safe_start(),
            options: &self.program.capabilities.options,
            spindle_on: self.spindle_on,
            coolant_on: self.coolant_on,
            tool: None,
            first: None,
            spindle: None,
            operation: None,
        }
    }

    fn program_context(&self) -> ProgramContext {
        let spec = &self.writer.dialect.spec;
        let title = self.program.title.as_deref().unwrap_or_default();
        let name: String = title
            .chars()
            .filter(char::is_ascii_alphanumeric)
            .take(spec.file.name_max)
            .collect::<String>()
            .to_uppercase();
        ProgramContext {
            title: spec.comments.clean(title),
            name: if name.is_empty() { "PART".into() } else { name },
            number: spec.file.number,
            units: match self.unit() {
                LengthUnit::Millimetre => "mm",
                LengthUnit::Inch => "inch",
            },
        }
    }

    fn tool_context(&self, tool: &Tool) -> ToolContext {
        let grid = &self.program.capabilities.grid;
        let length = |mm: f64| {
            number::steps(mm / grid.unit.in_mm(), grid.linear_decimals)
                .map_or_else(String::new, |s| number::plain(s, grid.linear_decimals))
        };
        let kind = match tool.kind {
            CutterKind::Flat => "flat",
            CutterKind::Ball => "ball",
            CutterKind::Bull => "bull",
            CutterKind::Taper => "taper",
        };
        let number = tool.number.unwrap_or(0);
        let name = self.writer.dialect.spec.comments.clean(&tool.name);
        let called = format!("T{number}");
        let label = if name.eq_ignore_ascii_case(&called) { called } else { format!("{called} {name}") };
        let text = format!("{label}, {kind}, D={}", length(tool.diameter));
        ToolContext { number, name, kind, diameter: length(tool.diameter), corner: length(tool.corner), text }
    }

    fn safe_start(&self) -> String {
        let spec = &self.writer.dialect.spec;
        let separator = &spec.line.separator;
        let lines: Vec<String> = spec
            .safe_start
            .iter()
            .map(|line| {
                let starts = line.iter().filter_map(|g| spec.groups.get(g)).map(|g| g.start.of(self.unit()));
                let codes: Vec<String> = starts.filter(|code| !code.is_empty()).collect();
                codes.join(separator)
            })
            .collect();
        lines.join("\n")
    }
}

/// Seconds in steps of the dwell word.
fn dwell_steps(seconds: f64, rules: &Dwell) -> Option<i64> {
    let scale = match rules.unit.as_str() {
        "ms" => 1000.0,
        "0.01s" => 100.0,
        _ => 1.0,
    };
    number::steps(seconds * scale, rules.decimals)
}
