//! Everything that is not a straight move or an arc: templates, spindle, coolant, dwell, texts.

use minijinja::value::{Serde, Value};

use super::check::template_error;
use super::context::OperationContext;
use super::dialect::{DwellUnit, NumberingMode, Spec};
use super::pattern::Item;
use super::table::{PER_MINUTE, WordFormat, word};
use super::template::Renderer;
use super::writer::{ModalState, Writer, WriterCarry};
use crate::arena::Arena;
use crate::diag::{Code, Diagnostic, codes};
use crate::ir::{Coolant, Origin, Spindle};
use crate::target::number;
use crate::target::{BlockKind, Capabilities, TargetProgram};
use crate::units::LengthUnit;

/// What one part of a program leaves to the next.
#[derive(Debug, Clone)]
pub(super) struct Carry {
    writer: WriterCarry,
    tool: Option<u32>,
    first_operation: bool,
    tool_changes: usize,
    spindle_on: bool,
    coolant_on: bool,
    through: bool,
    speed: i64,
    said_speed: Option<i64>,
}

/// The writer with what templates need.
pub(super) struct Events<'a> {
    pub writer: Writer<'a>,
    pub(super) program: &'a TargetProgram,
    origins: &'a Arena<Origin>,
    renderer: Renderer,
    /// All tools, for templates.
    pub(super) tools: std::cell::OnceCell<Value>,
    tool_changes: usize,
    /// The tool in the spindle.
    tool: Option<u32>,
    first_operation: bool,
    dwell: WordFormat,
    spindle: WordFormat,
    pub(super) spindle_on: bool,
    pub(super) coolant_on: bool,
    /// Coolant through the tool flows, and has a word of its own to end it.
    through: bool,
    /// Speed of the spindle, printed steps.
    pub(super) speed: i64,
    /// Speed that the tool change has said.
    said_speed: Option<i64>,
    /// The drilling cycle that is on.
    pub(super) cycle: Option<u32>,
}

impl<'a> Events<'a> {
    pub fn new(mut writer: Writer<'a>, program: &'a TargetProgram, origins: &'a Arena<Origin>) -> Events<'a> {
        let spec = &writer.dialect.spec;
        let unit = program.capabilities.grid.unit;
        let renderer = Renderer::new(&spec.comments);
        let mut dwell = word(spec, "dwell", false, unit);
        dwell.style.decimals = spec.dwell.decimals;
        let spindle = word(spec, "spindle", false, unit);
        if program.capabilities.rotary.is_none() {
            writer.state.axes[3] = Some(0);
        }
        Events {
            writer,
            program,
            origins,
            renderer,
            tools: std::cell::OnceCell::new(),
            tool_changes: 0,
            tool: None,
            first_operation: true,
            dwell,
            spindle,
            spindle_on: false,
            coolant_on: false,
            through: false,
            speed: 0,
            said_speed: None,
            cycle: None,
        }
    }

    /// What the next part of the program must know.
    pub fn carry(&self) -> Carry {
        Carry {
            writer: self.writer.carry(),
            tool: self.tool,
            first_operation: self.first_operation,
            speed: self.speed,
            said_speed: self.said_speed,
            tool_changes: self.tool_changes,
            spindle_on: self.spindle_on,
            coolant_on: self.coolant_on,
            through: self.through,
        }
    }

    /// Goes on where the part before ended.
    pub fn resume(&mut self, carry: Carry) {
        self.writer.resume(carry.writer);
        self.tool = carry.tool;
        self.first_operation = carry.first_operation;
        self.speed = carry.speed;
        self.said_speed = carry.said_speed;
        self.tool_changes = carry.tool_changes;
        self.spindle_on = carry.spindle_on;
        self.coolant_on = carry.coolant_on;
        self.through = carry.through;
    }

    pub fn into_writer(self) -> Writer<'a> {
        self.writer
    }

    pub(super) fn unit(&self) -> LengthUnit {
        self.program.capabilities.grid.unit
    }

    pub(super) fn error(&mut self, code: &'static Code, message: String) {
        let diagnostic = crate::ir::at_origin(code, self.origins, self.writer.origin, message);
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
            BlockKind::Compensation(on) => self.compensation(*on),
            BlockKind::Dwell(seconds) => self.dwell(*seconds),
            BlockKind::Stop => self.stop(false),
            BlockKind::OptionalStop => self.stop(true),
            BlockKind::Comment(text) => self.comment(text),
            BlockKind::Insert(text) => self.insert(text),
            BlockKind::PathTolerance(tolerance) => self.path_tolerance(*tolerance),
            BlockKind::BeginOperation(name) => self.operation(name),
            BlockKind::BeginCycle(cycle) => self.begin_cycle(*cycle),
            BlockKind::Hole(at) => self.hole(*at),
            BlockKind::EndCycle => self.end_cycle(),
            BlockKind::Motion(_) => {}
        }
    }

    fn begin(&mut self) {
        self.begin_compensation();
        let spec = &self.writer.dialect.spec;
        let context = Value::from(Serde(self.context()));
        self.template("templates.header", &spec.templates.header, &context);
        self.writer.state.mode = Some(PER_MINUTE);
        let unit = self.unit();
        let starts = |code: &str| spec.groups.values().any(|g| g.start.of(unit) == code);
        let said = |item: &String| item.strip_prefix('=').is_some_and(starts);
        if spec.path_control.exact.iter().all(said) {
            self.writer.state.path = Some(None);
        }
        if spec.codes.plane_xy.is_empty() || starts(&spec.codes.plane_xy) {
            self.writer.state.plane = Some(0);
        }
    }

    /// Tool axis, curves and cycles are along Z: the plane of arcs is XY again.
    pub(super) fn home_plane(&mut self) {
        self.writer.begin_line(true);
        self.writer.plane(0);
        self.writer.end_line();
    }

    /// The program leaves the control in feed per minute.
    fn end(&mut self) {
        let spec = &self.writer.dialect.spec;
        self.end_compensation();
        self.home_plane();
        self.through_off();
        if !matches!(self.writer.state.mode, None | Some(PER_MINUTE)) {
            self.writer.text_line(&spec.codes.per_minute, true);
        }
        let context = Value::from(Serde(self.context()));
        self.template("templates.footer", &spec.templates.footer, &context);
    }

    /// What the machine did in a tool change is its own affair: everything is said again after it.
    fn tool_change(&mut self, index: usize, tool: u32) {
        let change = &self.writer.dialect.spec.tool_change;
        self.end_compensation();
        self.tool = Some(tool);
        let Some(tool) = self.program.tools.get(tool as usize) else { return };
        if self.tool_changes > 0 {
            self.home_plane();
        }
        self.through_off();
        let mut context = self.context();
        context.tool = Some(self.tool_context(tool));
        context.first = Some(self.tool_changes == 0);
        let spindle = self.spindle_after(index);
        self.said_speed = Some(spindle.rpm).filter(|rpm| *rpm > 0);
        context.spindle = Some(spindle);
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

    fn operation(&mut self, name: &str) {
        let spec = &self.writer.dialect.spec;
        let mut context = self.context();
        let tool = self.tool.and_then(|index| self.program.tools.get(index as usize));
        let tool = tool.map(|t| self.tool_context(t)).unwrap_or_default();
        let first = core::mem::replace(&mut self.first_operation, false);
        context.operation = Some(OperationContext { name: spec.comments.clean(name), first, tool });
        self.template("templates.operation", &spec.templates.operation, &Value::from(Serde(context)));
    }

    pub(super) fn template(&mut self, path: &str, template: &str, context: &Value) {
        match self.renderer.lines(template, context) {
            Ok(lines) => lines.iter().for_each(|line| self.template_line(line)),
            Err(error) => {
                let diagnostic = template_error(self.writer.dialect, path, &error);
                self.writer.errors.push(diagnostic);
            }
        }
    }

    /// A template that gives words for a block.
    pub(super) fn words(&mut self, path: &str, template: &str, context: &Value) -> Vec<u8> {
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
        if spec.numbering.mode == NumberingMode::Lines {
            return true;
        }
        let comment = !spec.comments.open.is_empty() && line.starts_with(&spec.comments.open);
        !(comment || line.starts_with(['%', 'O', ':', '<']))
    }

    pub(super) fn spindle_code(&self, clockwise: bool) -> &'a str {
        let words = &self.writer.dialect.spec.spindle;
        if clockwise { &words.clockwise } else { &words.counter_clockwise }
    }

    fn spindle(&mut self, spindle: Spindle) {
        self.spindle_on = spindle != Spindle::Off;
        match spindle {
            Spindle::Off => self.writer.text_line(&self.writer.dialect.spec.spindle.off, true),
            Spindle::On { rpm, clockwise, range } => {
                let before = &self.writer.dialect.spec.spindle.range;
                let mut code = self.spindle_code(clockwise).to_owned();
                if let Some(gear) = range.word().filter(|_| !before.is_empty()) {
                    code = code + before + &gear;
                }
                self.turn_spindle(rpm, &code);
            }
        }
    }

    fn turn_spindle(&mut self, rpm: f64, code: &str) {
        let spec = &self.writer.dialect.spec;
        let decimals = self.spindle.style.decimals;
        let range = spec.range("spindle", self.unit());
        let Some(speed) = number::steps(rpm, decimals).filter(|s| (1..=range).contains(s)) else {
            let message =
                format!("the spindle speed {rpm} rev/min does not fit the word `S` of this control");
            self.error(&codes::post::WORD_RANGE, message);
            return;
        };
        let short = &spec.spindle.after_tool_change;
        let said = self.said_speed.take() == Some(speed) && !short.is_empty();
        let items = Item::all(if said { short } else { &spec.spindle.on });
        self.pattern(&items, code, &self.spindle.clone(), speed);
        self.speed = speed;
    }

    /// Prints a pattern that holds one number and one code.
    fn pattern(&mut self, items: &[Item], code: &str, format: &WordFormat, value: i64) {
        self.writer.begin_line(true);
        for item in items {
            match item {
                Item::Text(text) => self.writer.text(text),
                Item::Code => self.writer.text(code.as_bytes()),
                Item::Named(_) => self.writer.number(format, value),
                Item::NewLine => {
                    self.writer.end_line();
                    self.writer.begin_line(true);
                }
                // Other items do not pass the check of the dialect.
                _ => {}
            }
        }
        self.writer.end_line();
    }

    fn coolant(&mut self, coolant: Coolant) {
        let words = &self.writer.dialect.spec.coolant;
        let code = match coolant {
            Coolant::Off if self.through => return self.through_off(),
            Coolant::Off => &words.off,
            Coolant::Flood => &words.flood,
            Coolant::Mist => &words.mist,
            Coolant::Through { .. } => &words.through,
        };
        self.coolant_on = coolant != Coolant::Off;
        self.through = matches!(coolant, Coolant::Through { .. }) && !words.through_off.is_empty();
        self.writer.text_line(code, true);
    }

    /// Where coolant through the tool has a word of its own to end it, templates that say `off` do not end it.
    fn through_off(&mut self) {
        if self.through {
            (self.through, self.coolant_on) = (false, false);
            self.writer.text_line(&self.writer.dialect.spec.coolant.through_off, true);
        }
    }

    fn dwell(&mut self, seconds: f64) {
        let spec = &self.writer.dialect.spec;
        let rules = &spec.dwell;
        let steps = self.dwell_number(seconds, rules.unit, rules.decimals, rules.max);
        let Some(steps) = steps else { return };
        self.pattern(&Item::all(&rules.block), "", &self.dwell.clone(), steps);
    }

    /// A dwell in steps of its number; a message when it does not fit.
    pub(super) fn dwell_number(
        &mut self,
        seconds: f64,
        unit: DwellUnit,
        decimals: u8,
        max: f64,
    ) -> Option<i64> {
        let spec = &self.writer.dialect.spec;
        let scale = dwell_scale(unit, &self.program.capabilities);
        let range = spec.words.get("dwell").and_then(|w| w.max).map_or(f64::INFINITY, |m| m.of(self.unit()));
        let value = seconds * scale;
        let steps = number::steps(value, decimals).filter(|s| *s > 0 || seconds == 0.0);
        let fits = seconds >= 0.0 && seconds <= max && value <= range;
        let steps = steps.filter(|_| fits);
        if steps.is_none() {
            let least = 1.0 / (scale * crate::math::pow(10.0, f64::from(decimals)));
            let most = max.min(range / scale);
            let message = format!(
                "a dwell of {seconds} s does not fit this control's word (at least {least} s, at most {most} s)"
            );
            self.error(&codes::post::WORD_RANGE, message);
        }
        steps
    }

    fn stop(&mut self, optional: bool) {
        let words = &self.writer.dialect.spec.stops;
        let code = if optional { &words.optional } else { &words.stop };
        self.writer.text_line(code, true);
    }

    fn comment(&mut self, text: &str) {
        let lines = self.writer.dialect.spec.comments.lines(text);
        let numbered = self.numbers_all();
        lines.iter().for_each(|line| self.writer.text_line(line, numbered));
    }

    /// Verbatim; what it does is unknown, so every modal word is said again.
    fn insert(&mut self, text: &str) {
        if let Some(bad) = text.chars().find(|c| !(c.is_ascii_graphic() || *c == ' ' || *c == '\t')) {
            let message = format!("INSERT is one line of printable ASCII; it holds {bad:?}");
            self.error(&codes::post::BAD_INSERT, message);
            return;
        }
        let line = format!("{}{}", self.writer.dialect.spec.codes.insert, text.trim_end());
        self.writer.text_line(&line, self.numbers_all());
        self.writer.state = ModalState::default();
        self.said_speed = None;
    }

    fn numbers_all(&self) -> bool {
        self.writer.dialect.spec.numbering.mode == NumberingMode::Lines
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
        let rules = &spec.path_control;
        let items = Item::all(if steps.is_some() { &rules.tolerance } else { &rules.exact });
        self.pattern(&items, "", &format, steps.unwrap_or(0));
        self.writer.state.path = Some(steps);
    }
}

/// What a dwell's number counts in one second.
fn dwell_scale(unit: DwellUnit, capabilities: &Capabilities) -> f64 {
    match unit {
        DwellUnit::Seconds => 1.0,
        DwellUnit::Milliseconds => 1000.0,
        DwellUnit::Hundredths => 100.0,
        // The option was checked with the machine.
        DwellUnit::Declared => match Spec::option(&capabilities.options, "DWELL") {
            Some(unit) if unit.eq_ignore_ascii_case("ms") => 1000.0,
            _ => 1.0,
        },
    }
}
