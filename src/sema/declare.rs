//! Commands, declarations and assignments: which code carries them out, and what may be named how.

use crate::diag::Diagnostic;
use crate::diag::codes::semantics as codes;
use crate::ir::StepKind;
use crate::source::Span;
use crate::syntax::ast::{Command, Expr, Name, Target};
use crate::vocab::{self, EntityKind, Statement, Usage};

use super::matched::Matched;
use super::scope::{Binding, BindingKind};
use super::value::{Entity, Value};
use super::{Analyser, End, limits};

impl Analyser<'_> {
    /// Carries out a command or declaration.
    pub(super) fn command(&mut self, command: &Command, span: Span) {
        let Some(statement) = self.statement_row(command) else {
            if let Some(label) = &command.label {
                self.scope.poison(&label.name);
            }
            return self.state.forget();
        };
        match statement.usage {
            Usage::Declares(kind) => self.declaration(statement, kind, command),
            Usage::DeclaresOrActs(kind) if command.label.is_some() => {
                self.declaration(statement, kind, command)
            }
            Usage::DeclaresOrActs(_) => self.unlabelled_cutter(statement, command, span),
            Usage::Operation => self.operation(statement, command, span),
            Usage::Ignored => self.ignored(statement, command),
            Usage::Command | Usage::Text | Usage::Structure | Usage::Later => {
                self.refuse_label(statement, command);
                self.act(statement, command, span);
            }
        }
    }

    /// The row of the table, unless the word is unknown or not for this version.
    fn statement_row(&mut self, command: &Command) -> Option<&'static Statement> {
        for word in command.prefixes.iter().chain([&command.word]) {
            let Some(row) = self.row_of(word) else {
                self.unknown_word(word);
                return None;
            };
            if row.usage == Usage::Later {
                self.not_yet(row, word.span);
                return None;
            }
        }
        if let Some(first) = command.prefixes.first() {
            let message = format!("{} cannot stand before {}", first.text, command.word.text);
            self.report(Diagnostic::new(&codes::UNKNOWN_MINOR, first.span, message));
            return None;
        }
        let row = self.row_of(&command.word)?;
        if row.usage == Usage::Structure && row.forms.is_empty() {
            let message = format!("{} is not written like this", row.word);
            let first = row.example.lines().next().unwrap_or(row.word);
            self.report(
                Diagnostic::new(&codes::LABEL, command.word.span, message).help(format!("write `{first}`")),
            );
            return None;
        }
        Some(row)
    }

    /// The row of a word; a macro's parameter may stand for one.
    fn row_of(&self, word: &Name) -> Option<&'static Statement> {
        let bound = self.scope.get(&word.upper()).map(|b| &b.kind);
        match bound {
            Some(BindingKind::Variable(Value::Word(meant))) => vocab::find(meant),
            _ => vocab::find(&word.text),
        }
    }

    fn not_yet(&mut self, row: &Statement, span: Span) {
        let message = format!(
            "{} ({}) is a word of the language that this version does not carry out yet",
            row.word, row.help
        );
        self.report(Diagnostic::new(&codes::NOT_YET, span, message));
    }

    fn ignored(&mut self, row: &Statement, command: &Command) {
        let message = format!("{} does nothing here: {}", row.word, row.help);
        self.report(Diagnostic::new(&codes::IGNORED, command.word.span, message));
    }

    fn refuse_label(&mut self, statement: &Statement, command: &Command) {
        if let Some(label) = &command.label {
            let message =
                format!("{} makes nothing that could be called {}", statement.word, label.name.text);
            self.report(
                Diagnostic::new(&codes::LABEL, label.name.span, message)
                    .help("leave out the name and the `=`"),
            );
            self.scope.poison(&label.name);
        }
    }

    /// A statement that makes a named thing.
    fn declaration(&mut self, statement: &'static Statement, kind: EntityKind, command: &Command) {
        let Some(target) = &command.label else {
            let message = format!("{} makes {}, and it has no name", statement.word, kind.name());
            let problem = Diagnostic::new(&codes::LABEL, command.word.span, message)
                .help(format!("write `NAME = {}/ …`", statement.word));
            self.report(problem);
            self.arguments(statement, command);
            return;
        };
        let free = self.may_bind(target);
        let value = self.define(statement, command, &target.name.text);
        if free {
            self.bind(target, kind, value.unwrap_or(Value::Poison));
        }
    }

    /// A definition among arguments or inside an expression.
    pub(super) fn nested(&mut self, command: &Command) -> Value {
        let Some(statement) = self.statement_row(command) else { return Value::Poison };
        let (Usage::Declares(kind) | Usage::DeclaresOrActs(kind)) = statement.usage else {
            let message = format!("{} makes no value that could stand here", statement.word);
            self.report(Diagnostic::new(&codes::WRONG_KIND, command.word.span, message));
            return Value::Poison;
        };
        let free = command.label.as_ref().is_none_or(|target| self.may_bind(target));
        let name = command.label.as_ref().map_or("", |t| t.name.text.as_str());
        let value = self.define(statement, command, name).unwrap_or(Value::Poison);
        if let Some(target) = command.label.as_ref().filter(|_| free) {
            self.bind(target, kind, value.clone());
        }
        value
    }

    /// The value that a declaration makes.
    fn define(&mut self, statement: &'static Statement, command: &Command, name: &str) -> Option<Value> {
        let m = self.arguments(statement, command)?;
        if self.program.curves.len() + self.program.cams.len() + self.program.tools.len() >= limits::ENTITIES
        {
            self.limit(format!("the program declares more than {} things", limits::ENTITIES));
            return None;
        }
        match statement.word {
            "POINT" => self.point(&m),
            "VECTOR" => self.vector_entity(&m),
            "LINE" => self.line(&m, name),
            "CIRCLE" => self.circle(&m, name),
            "BEZIER" | "CURVE" => self.bezier(&m, name),
            "SPLINE" => self.spline(&m, name),
            "TABCYL" => self.tabcyl(&m, name),
            "PLANE" => self.plane(&m),
            "MATRIX" => self.matrix(&m),
            "PATERN" => self.pattern(&m),
            "CUTTER" => self.cutter(&m, name).map(|t| Value::Entity(Entity::Cutter(t))),
            "STOCK" => self.stock(&m, name),
            "NET" => self.net(&m, name),
            "FOLLOW" => self.follow(&m),
            "MOTION" => self.motion(&m),
            "CAM" => self.cam(&m, name),
            _ => None,
        }
    }

    /// Statements that act and take no label.
    fn act(&mut self, statement: &'static Statement, command: &Command, span: Span) {
        match statement.word {
            "MACHIN" => return self.machin(command),
            "RESERV" => return self.reserv(command),
            _ => {}
        }
        let with_axis = statement.word == "GOTO" && self.state.multi_axis && command.args.len() == 6;
        let statement = if with_axis { &crate::vocab::GOTO_WITH_AXIS } else { statement };
        let Some(m) = self.arguments(statement, command) else {
            if statement.word == "PARAM" {
                self.poison_parameter(command);
            }
            return self.state.forget();
        };
        self.act_on(statement.word, &m, span);
    }

    fn act_on(&mut self, word: &str, m: &Matched, span: Span) {
        match word {
            "UNITS" => self.units(m, span),
            "PARAM" => self.param(m),
            "INCLUD" => self.includ(m, span),
            "FINI" => self.ended = Some(End::Fini),
            "LOADTL" => self.loadtl(m, span),
            "SPINDL" => self.spindl(m, span),
            "FEDRAT" => self.fedrat(m, span),
            "COOLNT" => self.coolnt(m),
            "INTOL" | "OUTTOL" | "TOLER" => self.tolerance(word, m, span),
            "THICK" => self.thick(m),
            "TRACUT" => self.tracut(m, span),
            "CLEARP" => self.state.clearance = m.number("height").unwrap_or(self.state.clearance),
            "CYCLE" => self.drill_cycle(m),
            "CUTCOM" => self.cutcom(m),
            "TLAXIS" => self.tool_axis(m),
            "MULTAX" => self.state.multi_axis = m.word("state") != Some("OFF"),
            "CUSP" => self.state.cusp = m.number("height").or(self.state.cusp),
            "DELAY" => self.step(StepKind::Dwell(m.number("time").unwrap_or(0.0))),
            "STOP" => self.step(StepKind::Stop),
            "OPSTOP" => self.step(StepKind::OptionalStop),
            "RAPID" => self.state.rapid = true,
            "FROM" => self.from(m),
            "GOTO" => self.goto(m, span),
            "GODLTA" => self.godlta(m, span),
            // END: the post ends every program.
            _ => {}
        }
    }

    /// A `PARAM` whose arguments are wrong still takes its name.
    fn poison_parameter(&mut self, command: &Command) {
        for arg in &command.args {
            if let crate::syntax::ast::ArgKind::Named { name, .. } = &arg.kind {
                if let Some(define) = self.defines.iter().position(|d| name.is(d.name())) {
                    self.defines.remove(define);
                }
                self.scope.poison(name);
            }
        }
    }

    /// `name = value`.
    pub(super) fn assign(&mut self, target: &Target, value: &Expr) {
        let value = (self.evaluate(value), value.span);
        let value = match value {
            (Value::Word(word), span) => {
                let message = format!("{word} is a word of the language, not a value");
                self.report(Diagnostic::new(&codes::WRONG_KIND, span, message));
                Value::Poison
            }
            (Value::List(_), span) => {
                let message = "a list has no name; name its parts";
                self.report(Diagnostic::new(&codes::WRONG_KIND, span, message));
                Value::Poison
            }
            (value, _) => value,
        };
        self.assign_value(target, value);
    }

    /// Sets a variable or an element.
    pub(super) fn assign_value(&mut self, target: &Target, value: Value) {
        if !target.subscripts.is_empty() {
            return self.set_element(target, None, value);
        }
        let name = &target.name;
        let key = name.upper();
        let declared = match self.scope.get_mut(&key) {
            Some(Binding { kind: BindingKind::Variable(slot), .. }) => {
                *slot = value;
                return;
            }
            Some(Binding { kind: kind @ BindingKind::Poison, .. }) => {
                *kind = BindingKind::Variable(value);
                return;
            }
            Some(binding) => Some((binding.declared, what(&binding.kind))),
            None => None,
        };
        if let Some((declared, what)) = declared {
            let message = format!("{} is {what} and cannot be set again", name.text);
            self.report(
                Diagnostic::new(&codes::ALREADY_DECLARED, name.span, message)
                    .label(declared, "declared here")
                    .help(format!("choose another name, for example `{}`", self.free_name(&key))),
            );
            return;
        }
        if self.check_reserved(name) && self.room_for_names() {
            self.scope.set(key, Binding { kind: BindingKind::Variable(value), declared: name.span });
        }
    }

    /// Whether one more name may be kept; reports when not.
    pub(super) fn room_for_names(&mut self) -> bool {
        if self.scope.len() < limits::NAMES {
            return true;
        }
        self.limit(format!("the program has more than {} names", limits::NAMES));
        false
    }

    /// Whether a name may be declared: not a word of the language, and free. The same statement may declare it
    /// again, in a loop or another call.
    pub(super) fn may_declare(&mut self, name: &Name) -> bool {
        if !self.check_reserved(name) || !self.room_for_names() {
            return false;
        }
        let key = name.upper();
        let Some(binding) = self.scope.get(&key) else { return true };
        if binding.declared == name.span || matches!(binding.kind, BindingKind::Poison) {
            return true;
        }
        let (declared, what) = (binding.declared, what(&binding.kind));
        let message = format!("{} is {what} already", name.text);
        self.report(
            Diagnostic::new(&codes::ALREADY_DECLARED, name.span, message)
                .label(declared, "first here")
                .help(format!("choose another name, for example `{}`", self.free_name(&key))),
        );
        false
    }

    fn may_bind(&mut self, target: &Target) -> bool {
        if target.subscripts.is_empty() {
            self.may_declare(&target.name)
        } else {
            self.check_reserved(&target.name)
        }
    }

    /// Reports a word of the language used as a name.
    pub(super) fn check_reserved(&mut self, name: &Name) -> bool {
        if !vocab::is_reserved(&name.text) {
            return true;
        }
        let message = format!("{} is a word of the language and cannot be a name", name.upper());
        let free = self.free_name(&name.upper());
        self.report(Diagnostic::new(&codes::RESERVED, name.span, message).help(format!("`{free}` is free")));
        self.scope.poison(name);
        false
    }

    /// A free name that resembles `name`.
    fn free_name(&self, name: &str) -> String {
        (1..)
            .map(|n| format!("{name}{n}"))
            .find(|n| self.scope.get(n).is_none() && !vocab::is_reserved(n))
            .unwrap_or_default()
    }

    fn bind(&mut self, target: &Target, kind: EntityKind, value: Value) {
        if !target.subscripts.is_empty() {
            return self.set_element(target, Some(kind), value);
        }
        let kind = match value {
            Value::Poison => BindingKind::Poison,
            value => BindingKind::Entity(kind, value),
        };
        self.scope.set(target.name.upper(), Binding { kind, declared: target.name.span });
    }
}

/// What a name stands for, with its article.
pub(super) fn what(kind: &BindingKind) -> &'static str {
    match kind {
        BindingKind::Variable(_) => "a variable",
        BindingKind::Parameter(_) => "a parameter",
        BindingKind::Entity(kind, _) => kind.name(),
        BindingKind::Array(_) => "a subscripted name",
        BindingKind::Macro(_) => "a macro",
        BindingKind::Poison => "something",
    }
}
