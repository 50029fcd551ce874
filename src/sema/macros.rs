//! Macros and their calls.

use std::collections::BTreeMap;
use std::rc::Rc;

use crate::diag::codes::semantics as codes;
use crate::diag::{Diagnostic, did_you_mean};
use crate::source::Span;
use crate::syntax::ast::{Arg, ArgKind, CallArgument, Name, Parameter};

use super::blocks::{Code, Link};
use super::report::Call;
use super::scope::{Binding, BindingKind, MacroDefinition};
use super::value::Value;
use super::{Analyser, limits};

impl Analyser<'_> {
    /// `name = MACRO/ …`: remembers it and goes on behind its `TERMAC`.
    pub(super) fn define_macro(
        &mut self,
        code: &Rc<Code>,
        (name, parameters): (&Name, &[Parameter]),
        link: Link,
        at: usize,
    ) -> Option<usize> {
        let Link::Start { end } = link else {
            self.scope.poison(name);
            for parameter in parameters {
                self.scope.poison(&parameter.name);
            }
            return None;
        };
        let sound = self.check_parameters(parameters);
        if self.may_declare(name) {
            let kind = if sound {
                BindingKind::Macro(Rc::new(MacroDefinition {
                    name: Rc::from(name.text.as_str()),
                    span: name.span,
                    parameters: parameters.to_vec(),
                    code: code.clone(),
                    body: at + 1..end,
                }))
            } else {
                BindingKind::Poison
            };
            self.scope.set(name.upper(), Binding { kind, declared: name.span });
        }
        Some(end + 1)
    }

    fn check_parameters(&mut self, parameters: &[Parameter]) -> bool {
        let mut sound = true;
        for (i, parameter) in parameters.iter().enumerate() {
            sound &= self.check_reserved(&parameter.name);
            let first = parameters.iter().take(i).find(|p| p.name.upper() == parameter.name.upper());
            if let Some(first) = first {
                let message = format!("the parameter {} stands here twice", parameter.name.text);
                self.report(
                    Diagnostic::new(&codes::MACRO_ARGUMENTS, parameter.name.span, message)
                        .label(first.name.span, "first here"),
                );
                sound = false;
            }
        }
        sound
    }

    /// `CALL/ name, …`.
    pub(super) fn call(&mut self, name: &Name, arguments: &[CallArgument], span: Span) {
        let definition = match self.scope.get(&name.upper()).map(|b| (b.kind.clone(), b.declared)) {
            Some((BindingKind::Macro(definition), _)) => definition,
            Some((BindingKind::Poison, _)) => return self.state.forget(),
            other => {
                let problem = self.unknown_macro(name, other.map(|(_, declared)| declared));
                self.report(problem);
                return self.state.forget();
            }
        };
        if self.calls.len() >= limits::CALL_DEPTH {
            self.too_deep(&definition, span);
            return;
        }
        let Some(frame) = self.bind_arguments(name, &definition, arguments) else {
            return self.state.forget();
        };
        self.calls.push(Call { name: definition.name.clone(), definition: definition.span, call: span });
        self.call_spans.push(span);
        self.scope.enter(frame);
        self.run(&definition.code, definition.body.clone());
        self.scope.leave();
        self.call_spans.pop();
        self.calls.pop();
        self.here = span;
    }

    fn unknown_macro(&self, name: &Name, other: Option<Span>) -> Diagnostic {
        let problem = Diagnostic::new(
            &codes::UNKNOWN_MACRO,
            name.span,
            format!("no macro is called {} so far", name.text),
        );
        if let Some(declared) = other {
            return problem.label(declared, format!("{} is something else", name.text));
        }
        let macros: Vec<&str> = self
            .scope
            .names()
            .filter(|n| matches!(self.scope.get(n).map(|b| &b.kind), Some(BindingKind::Macro(_))))
            .collect();
        match did_you_mean(&name.text, macros) {
            Some(near) => problem.help(format!("did you mean `{near}`?")),
            None => problem.help("a macro must be defined, or included, above its first call"),
        }
    }

    fn too_deep(&mut self, definition: &MacroDefinition, span: Span) {
        let message = format!(
            "macros call one another {} deep, and {} would be the next",
            limits::CALL_DEPTH,
            definition.name
        );
        self.report(
            Diagnostic::new(&codes::CALL_LIMIT, span, message)
                .help("does the macro call itself without a condition that ends it?"),
        );
        self.ended = Some(super::End::Limit);
    }

    fn bind_arguments(
        &mut self,
        name: &Name,
        definition: &MacroDefinition,
        arguments: &[CallArgument],
    ) -> Option<BTreeMap<String, Binding>> {
        let mut frame: BTreeMap<String, Binding> = BTreeMap::new();
        let before = self.report.errors();
        for (i, argument) in arguments.iter().enumerate() {
            let Some(parameter) = self.parameter_for(name, definition, argument, i) else { continue };
            let value = self.argument_value(&argument.value);
            let (key, binding) = self.bind_parameter(&parameter, value);
            let place = argument.name.as_ref().map_or(argument.value.span, |n| n.span);
            if let Some(first) = frame.insert(key, Binding { declared: place, ..binding }) {
                let message = format!("{} of {} is given twice", parameter.text, name.text);
                self.report(
                    Diagnostic::new(&codes::MACRO_ARGUMENTS, place, message)
                        .label(first.declared, "first here"),
                );
            }
        }
        let faulty = self.report.errors() > before;
        for parameter in &definition.parameters {
            if frame.contains_key(&parameter.name.upper()) {
                continue;
            }
            let value = match &parameter.default {
                Some(default) => self.argument_value(default),
                None => {
                    if !faulty {
                        self.no_argument(name, definition, parameter);
                    }
                    Value::Poison
                }
            };
            let (key, binding) = self.bind_parameter(&parameter.name, value);
            frame.insert(key, binding);
        }
        (self.report.errors() == before).then_some(frame)
    }

    fn no_argument(&mut self, name: &Name, definition: &MacroDefinition, parameter: &Parameter) {
        let message = format!("{} needs a value for {}", name.text, parameter.name.text);
        self.report(
            Diagnostic::new(&codes::MACRO_ARGUMENTS, name.span, message)
                .label(parameter.name.span, "this parameter has no default")
                .help(format!("write `CALL/ {}, {} = …`", definition.name, parameter.name.text)),
        );
    }

    /// The parameter that an argument is for.
    fn parameter_for(
        &mut self,
        name: &Name,
        definition: &MacroDefinition,
        argument: &CallArgument,
        index: usize,
    ) -> Option<Name> {
        let Some(wanted) = &argument.name else {
            let Some(parameter) = definition.parameters.get(index) else {
                let message = format!(
                    "{} has {} parameters; this is one value more",
                    name.text,
                    definition.parameters.len()
                );
                self.report(
                    Diagnostic::new(&codes::MACRO_ARGUMENTS, argument.value.span, message)
                        .label(definition.span, "the macro"),
                );
                return None;
            };
            return Some(parameter.name.clone());
        };
        let known = definition.parameters.iter().find(|p| p.name.upper() == wanted.upper());
        if let Some(parameter) = known {
            return Some(parameter.name.clone());
        }
        let problem = Diagnostic::new(
            &codes::MACRO_ARGUMENTS,
            wanted.span,
            format!("{} has no parameter {}", name.text, wanted.text),
        )
        .label(definition.span, "the macro");
        let names: Vec<&str> = definition.parameters.iter().map(|p| p.name.text.as_str()).collect();
        let problem = match did_you_mean(&wanted.text, names.iter().copied()) {
            Some(near) => problem.help(format!("did you mean `{near}`?")),
            None if names.is_empty() => problem.note("it takes no values"),
            None => problem.note(format!("its parameters are {}", names.join(", "))),
        };
        self.report(problem);
        None
    }

    /// The value handed over; a word of the language stands for itself.
    fn argument_value(&mut self, argument: &Arg) -> Value {
        match &argument.kind {
            ArgKind::Expr(expr) => self.evaluate(expr),
            ArgKind::Nested(command) => self.nested(command),
            ArgKind::Named { value, .. } => self.evaluate(value),
        }
    }
}
