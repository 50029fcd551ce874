//! `PARAM` and the definitions of the command line.

use crate::diag::codes::semantics as codes;
use crate::diag::{Diagnostic, did_you_mean};
use crate::source::Span;
use crate::syntax;
use crate::syntax::ast::{ExprKind, Name, StatementKind};
use crate::units::Quantity;

use super::arithmetic::article;
use super::matched::{Matched, Typed};
use super::scope::{Binding, BindingKind};
use super::value::Value;
use super::{Analyser, Options};

/// A `-D NAME=VALUE`.
#[derive(Debug)]
pub(super) struct Define {
    name: String,
    text: String,
    used: bool,
}

/// The definitions of the command line; of several for one name, the last counts.
pub(super) fn defines(options: &Options) -> Vec<Define> {
    let mut defines: Vec<Define> = Vec::new();
    for (name, text) in &options.defines {
        defines.retain(|d| !d.name.eq_ignore_ascii_case(name));
        defines.push(Define { name: name.clone(), text: text.clone(), used: false });
    }
    defines
}

impl Analyser<'_> {
    /// `PARAM/ NAME = default, MIN, a, MAX, b, 'text'`.
    pub(super) fn param(&mut self, m: &Matched) {
        let Some(Typed::Binding(name, expr)) = m.get("default").map(|f| &f.typed) else { return };
        let default = self.evaluate(expr);
        let span = expr.span;
        if !self.may_declare(name) {
            self.use_define(name);
            return;
        }
        let value = match self.use_define(name) {
            Some(text) => self.defined_value(name, &default, &text),
            None => default.clone(),
        };
        let value = match (default, value) {
            (Value::Number(default), Value::Number(value)) => self.limited(name, m, (default, span), value),
            (Value::Text(_), value @ Value::Text(_)) => value,
            (Value::Poison, _) | (_, Value::Poison) => Value::Poison,
            (other, _) => {
                let message =
                    format!("the default of a parameter is a number or a text, not {}", other.kind_name());
                self.report(Diagnostic::new(&codes::WRONG_KIND, span, message));
                Value::Poison
            }
        };
        let kind =
            if matches!(value, Value::Poison) { BindingKind::Poison } else { BindingKind::Parameter(value) };
        self.scope.set(name.upper(), Binding { kind, declared: name.span });
    }

    fn use_define(&mut self, name: &Name) -> Option<String> {
        let define = self.defines.iter_mut().find(|d| name.is(&d.name))?;
        define.used = true;
        Some(define.text.clone())
    }

    /// The command line's value, in the dimension of the default.
    fn defined_value(&mut self, name: &Name, default: &Value, text: &str) -> Value {
        let value = if matches!(default, Value::Text(_)) {
            Some(Value::Text(text.trim_matches(['\'', '"']).into()))
        } else {
            self.read_value(text)
        };
        let problem = match (default, value) {
            (_, None) => format!("-D {}={text}: this is no value", name.text),
            (Value::Number(wanted), Some(Value::Number(given))) => {
                match given.land(wanted.dim, self.unit()) {
                    Some(landed) => return Value::Number(landed),
                    // A bare default leaves the dimension to the places where the parameter is used.
                    None if wanted.is_bare() => return Value::Number(given),
                    None => format!(
                        "-D {}={text}: {} is {}, and this is {}",
                        name.text,
                        name.text,
                        article(wanted.dim),
                        article(given.dim)
                    ),
                }
            }
            (_, Some(value)) => return value,
        };
        self.report(Diagnostic::global(&codes::DEFINE, problem).label(name.span, "the parameter"));
        Value::Poison
    }

    /// Reads the text of a definition as an expression without names.
    fn read_value(&mut self, text: &str) -> Option<Value> {
        let mut sink = crate::diag::Sink::default();
        let mut sources = crate::source::SourceMap::default();
        let source = format!("X = {text}");
        let file = sources.add("-D", source.as_str());
        let tree = syntax::parse(file, &source, &mut sink);
        let [statement] = tree.statements.as_slice() else { return None };
        let StatementKind::Assign { value, .. } = &statement.kind else { return None };
        let plain = matches!(
            value.kind,
            ExprKind::Number { .. }
                | ExprKind::Text(_)
                | ExprKind::Unary { .. }
                | ExprKind::Paren(_)
                | ExprKind::Binary { .. }
        );
        if sink.has_errors() || !plain {
            return None;
        }
        let silent = core::mem::take(&mut self.report);
        let value = self.evaluate(value);
        self.report = silent;
        (!matches!(value, Value::Poison)).then_some(value)
    }

    /// Checks a value against `MIN` and `MAX`, which are in the default's dimension.
    fn limited(
        &mut self,
        name: &Name,
        m: &Matched,
        (default, span): (Quantity, Span),
        value: Quantity,
    ) -> Value {
        let mut sound = true;
        for (limit, word, beyond) in [("min", "less", -1.0), ("max", "more", 1.0)] {
            let found = m.found.iter().find(|f| f.name == limit && matches!(f.typed, Typed::Quantity(_)));
            let Some((Typed::Quantity(bound), at)) = found.map(|f| (f.typed.clone(), f.span)) else {
                continue;
            };
            for (checked, whose, place) in [(default, "default", Some(span)), (value, "value", None)] {
                let Some((bound, checked)) = self.level(at, (bound, at), (checked, span)).filter(|_| sound)
                else {
                    sound = false;
                    continue;
                };
                if (checked.value - bound.value) * beyond <= 0.0 {
                    continue;
                }
                let (shown, limit_shown) = (self.show(checked), self.show(bound));
                let text = format!("the {whose} of {} is {shown}, {word} than {limit_shown}", name.text);
                let problem = match place {
                    Some(place) => Diagnostic::new(&codes::PARAMETER_RANGE, place, text),
                    None => Diagnostic::global(&codes::PARAMETER_RANGE, format!("-D {}: {text}", name.text)),
                };
                self.report(problem.label(at, format!("{} is {limit_shown}", limit.to_uppercase())));
                sound = false;
            }
        }
        if sound { Value::Number(value) } else { Value::Poison }
    }

    /// Reports definitions of the command line that no `PARAM` took.
    pub(super) fn unused_defines(&mut self) {
        if self.ended == Some(super::End::Limit) {
            return;
        }
        let unused: Vec<String> = self.defines.iter().filter(|d| !d.used).map(|d| d.name.clone()).collect();
        for name in unused {
            let parameters: Vec<&str> = self
                .scope
                .names()
                .filter(|n| matches!(self.scope.get(n).map(|b| &b.kind), Some(BindingKind::Parameter(_))))
                .collect();
            let problem =
                Diagnostic::global(&codes::DEFINE, format!("-D {name}: the program has no parameter {name}"));
            let problem = match did_you_mean(&name, parameters.iter().copied()) {
                Some(near) => problem.help(format!("did you mean `{near}`?")),
                None if parameters.is_empty() => problem.note("it has no PARAM statement"),
                None => problem.note(format!("its parameters are {}", parameters.join(", "))),
            };
            self.report(problem);
        }
    }
}

impl Define {
    /// The name it defines.
    pub(super) fn name(&self) -> &str {
        &self.name
    }
}
