//! Evaluation of expressions.

use std::rc::Rc;

use crate::diag::codes::{semantics as codes, syntax};
use crate::diag::{Diagnostic, did_you_mean};
use crate::source::Span;
use crate::syntax::ast::{BinaryOp, Expr, ExprKind, Name, UnaryOp};
use crate::units::{Dim, Quantity, UNIT_NAMES, parse_unit};
use crate::vocab;

use super::Analyser;
use super::arithmetic::{Placed, article};
use super::scope::{Binding, BindingKind};
use super::value::{Value, Vector};

impl Analyser<'_> {
    /// The value of an expression; poison after a message.
    pub(super) fn evaluate(&mut self, expr: &Expr) -> Value {
        match &expr.kind {
            ExprKind::Number { value, unit } => self.literal(*value, unit.as_ref()),
            ExprKind::Text(text) => Value::Text(Rc::from(text.as_str())),
            ExprKind::Name(name) => self.name_value(name),
            ExprKind::Apply { name, args } => self.apply(name, args, expr.span),
            ExprKind::Member { base, member } => {
                let value = self.evaluate(base);
                self.member(&(value, base.span), member)
            }
            ExprKind::Tuple(items) => self.tuple(items),
            ExprKind::Nested(command) => self.nested(command),
            ExprKind::Paren(inner) => self.evaluate(inner),
            ExprKind::Unary { op, op_span, operand } => self.unary(*op, *op_span, operand),
            ExprKind::Binary { op, op_span, left, right } => {
                if *op == BinaryOp::Power {
                    return self.power_expression(*op_span, left, right);
                }
                let left = (self.evaluate(left), left.span);
                if let (BinaryOp::And, Value::Truth(false)) | (BinaryOp::Or, Value::Truth(true)) =
                    (op, &left.0)
                {
                    return left.0;
                }
                let right = (self.evaluate(right), right.span);
                self.binary(*op, *op_span, left, right)
            }
        }
    }

    fn literal(&mut self, value: f64, unit: Option<&Name>) -> Value {
        let Some(name) = unit else { return Value::bare(value) };
        match parse_unit(&name.text) {
            Some(unit) => self.finite(name.span, Quantity::of(value, unit)),
            None => {
                let mut problem = Diagnostic::new(
                    &codes::UNKNOWN_UNIT,
                    name.span,
                    format!("there is no unit {}", name.text),
                );
                problem = match did_you_mean(&name.text, UNIT_NAMES) {
                    Some(near) => problem.help(format!("did you mean `{near}`?")),
                    None => problem.note(format!("the units are {}", UNIT_NAMES.join(", "))),
                };
                self.report(problem);
                Value::Poison
            }
        }
    }

    /// The value a name stands for; a word of the language stands for itself.
    pub(super) fn name_value(&mut self, name: &Name) -> Value {
        let upper = name.upper();
        if let Some(binding) = self.scope.get(&upper) {
            let binding = binding.clone();
            return self.bound_value(name, &binding);
        }
        if vocab::is_reserved(&upper) {
            return Value::Word(Rc::from(upper));
        }
        let problem = self.unknown_name(name);
        self.report(problem);
        Value::Poison
    }

    /// The value of a bound name.
    pub(super) fn bound_value(&mut self, name: &Name, binding: &Binding) -> Value {
        match &binding.kind {
            BindingKind::Variable(value) | BindingKind::Parameter(value) | BindingKind::Entity(_, value) => {
                value.clone()
            }
            BindingKind::Poison => Value::Poison,
            BindingKind::Array(_) => {
                let message = format!("{} is subscripted; which of its elements is meant?", name.text);
                self.report(
                    Diagnostic::new(&codes::SUBSCRIPT, name.span, message)
                        .help(format!("write `{}(1)`", name.text))
                        .label(binding.declared, "made subscripted here"),
                );
                Value::Poison
            }
            BindingKind::Macro(_) => {
                let message = format!("{} is a macro, not a value", name.text);
                self.report(
                    Diagnostic::new(&codes::WRONG_KIND, name.span, message)
                        .label(binding.declared, "the macro")
                        .help(format!("write `CALL/ {}`", name.text)),
                );
                Value::Poison
            }
        }
    }

    /// «Unknown name», with the nearest of the names in reach.
    pub(super) fn unknown_name(&self, name: &Name) -> Diagnostic {
        let problem = Diagnostic::new(
            &codes::UNKNOWN_NAME,
            name.span,
            format!("nothing is called {} so far", name.text),
        );
        match did_you_mean(&name.text, self.scope.names()) {
            Some(near) => {
                let declared = self.scope.get(near).map(|b| b.declared);
                let problem = problem.help(format!("did you mean `{near}`?"));
                match declared {
                    Some(span) => problem.label(span, format!("{near} is declared here")),
                    None => problem,
                }
            }
            None => problem.help("a name must be declared, above its first use"),
        }
    }

    fn apply(&mut self, name: &Name, args: &[Expr], span: Span) -> Value {
        let upper = name.upper();
        match self.scope.get(&upper).map(|b| (b.kind.clone(), b.declared)) {
            Some((BindingKind::Array(array), declared)) => self.element(name, &array, declared, args),
            Some((BindingKind::Poison, _)) => Value::Poison,
            Some((_, declared)) => {
                let message = format!("{} is not subscripted", name.text);
                self.report(
                    Diagnostic::new(&codes::SUBSCRIPT, name.span, message)
                        .label(declared, "declared here without one"),
                );
                Value::Poison
            }
            None => match vocab::find_function(&upper) {
                Some(function) => self.call_function(function, name, args, span),
                None if vocab::is_word(&upper) => self.missing_comma(name),
                None => self.unknown_function(name),
            },
        }
    }

    /// `CENTER (0, 0)`: a word with its value straight behind it.
    fn missing_comma(&mut self, name: &Name) -> Value {
        let at = Span { start: name.span.end, ..name.span };
        let problem =
            Diagnostic::new(&syntax::UNEXPECTED, at, format!("expected a comma after {}", name.upper()));
        self.report(problem.label(name.span, "a word of the language"));
        Value::Poison
    }

    fn unknown_function(&mut self, name: &Name) -> Value {
        let message = format!("there is no function and no subscripted name {}", name.text);
        let problem = Diagnostic::new(&codes::UNKNOWN_FUNCTION, name.span, message);
        let functions = did_you_mean(&name.text, vocab::function_names());
        let problem = match functions.or_else(|| did_you_mean(&name.text, self.scope.names())) {
            Some(near) => problem.help(format!("did you mean `{near}`?")),
            None => problem,
        };
        self.report(problem);
        Value::Poison
    }

    fn unary(&mut self, op: UnaryOp, op_span: Span, operand: &Expr) -> Value {
        if op == UnaryOp::Minus
            && let ExprKind::Binary { op: BinaryOp::Power, op_span, left, right } = &operand.kind
        {
            return self.signed_power(*op_span, op_span.to(operand.span), left, right);
        }
        let value = self.evaluate(operand);
        self.apply_sign(op, op_span, value, operand.span)
    }

    fn apply_sign(&mut self, op: UnaryOp, op_span: Span, value: Value, span: Span) -> Value {
        match (op, value) {
            (_, Value::Poison) => Value::Poison,
            (UnaryOp::Minus, Value::Number(q)) => Value::number(-q.value, q.dim),
            (UnaryOp::Minus, Value::Vector(v)) => Value::Vector(Vector { v: v.v.map(|x| -x), dim: v.dim }),
            (UnaryOp::Plus, value @ (Value::Number(_) | Value::Vector(_))) => value,
            (UnaryOp::Not, value) => match self.condition(&(value, span)) {
                Some(truth) => Value::Truth(!truth),
                None => Value::Poison,
            },
            (_, other) => {
                let message = format!("a sign does not go with {}", other.kind_name());
                self.report(
                    Diagnostic::new(&codes::WRONG_OPERAND, op_span, message).label(span, other.kind_name()),
                );
                Value::Poison
            }
        }
    }

    /// A tuple of numbers is a point or vector; of other things, a list.
    fn tuple(&mut self, items: &[Expr]) -> Value {
        let mut values: Vec<Placed> = Vec::with_capacity(items.len());
        for item in items {
            let several = match &item.kind {
                ExprKind::Apply { name, args } => self.inclusive(name, args),
                _ => None,
            };
            match several {
                Some(elements) => values.extend(elements.into_iter().map(|e| (e.value, item.span))),
                None => values.push((self.evaluate(item), item.span)),
            }
        }
        if values.iter().any(|(v, _)| matches!(v, Value::Poison)) {
            return Value::Poison;
        }
        let numbers: Option<Vec<(Quantity, Span)>> = values
            .iter()
            .map(|(v, span)| match v {
                Value::Number(q) => Some((*q, *span)),
                _ => None,
            })
            .collect();
        match numbers {
            Some(numbers) if numbers.len() <= 3 => self.vector(&numbers),
            _ => Value::List(values.into()),
        }
    }

    /// Two or three numbers as a vector; bare ones take the dimension of the others.
    pub(super) fn vector(&mut self, numbers: &[(Quantity, Span)]) -> Value {
        let dim = numbers.iter().map(|(q, _)| q.dim).find(|d| *d != Dim::NONE).unwrap_or(Dim::NONE);
        let mut v = [0.0; 3];
        for (slot, &(q, span)) in v.iter_mut().zip(numbers) {
            match self.land(q, dim, span) {
                Some(landed) => *slot = landed.value,
                None => {
                    let message = format!(
                        "the components of a point or vector agree: this is {}, the others are {}",
                        article(q.dim),
                        article(dim)
                    );
                    self.report(Diagnostic::new(&codes::DIMENSIONS_DIFFER, span, message));
                    return Value::Poison;
                }
            }
        }
        Value::Vector(Vector { v, dim })
    }

    /// `left ** right`, with a warning where readers differ.
    fn power_expression(&mut self, op_span: Span, left: &Expr, right: &Expr) -> Value {
        if let ExprKind::Unary { op: UnaryOp::Minus, operand, .. } = &left.kind {
            return self.signed_power(op_span, left.span.to(right.span), operand, right);
        }
        let base = (self.evaluate(left), left.span);
        let exponent = (self.evaluate(right), right.span);
        let value = self.binary(BinaryOp::Power, op_span, base.clone(), exponent);
        if let ExprKind::Binary { op: BinaryOp::Power, left: b, right: c, .. } = &right.kind {
            let (b, c) = (self.evaluate(b), self.evaluate(c));
            self.warn_chain(left.span.to(right.span), &base.0, &b, &c, &value);
        }
        value
    }

    /// `-base ** exponent`: as APT, the sign binds first.
    fn signed_power(&mut self, op_span: Span, span: Span, base: &Expr, exponent: &Expr) -> Value {
        let plain = (self.evaluate(base), base.span);
        let exponent = (self.evaluate(exponent), exponent.span);
        let negative = (self.apply_sign(UnaryOp::Minus, op_span, plain.0.clone(), base.span), base.span);
        let value = self.binary(BinaryOp::Power, op_span, negative, exponent.clone());
        if let (Value::Number(kept), Value::Number(p), Value::Number(e)) = (&value, &plain.0, &exponent.0) {
            let other = Quantity::new(-super::arithmetic::raise(p.value, e.value), kept.dim);
            if other.value.is_finite() && other.value != kept.value {
                self.warn_power(span, "the sign counts before the power, as in APT", *kept, other);
            }
        }
        value
    }

    fn warn_chain(&mut self, span: Span, a: &Value, b: &Value, c: &Value, kept: &Value) {
        let (Value::Number(a), Value::Number(b), Value::Number(c), Value::Number(kept)) = (a, b, c, kept)
        else {
            return;
        };
        let other = super::arithmetic::raise(super::arithmetic::raise(a.value, b.value), c.value);
        if other.is_finite() && other != kept.value {
            let other = Quantity::new(other, kept.dim);
            self.warn_power(span, "the right power counts first, as in APT", *kept, other);
        }
    }

    fn warn_power(&mut self, span: Span, rule: &str, kept: Quantity, other: Quantity) {
        let (kept, other) = (self.show(kept), self.show(other));
        self.report(
            Diagnostic::new(&codes::POWER_ORDER, span, format!("{rule}: the result is {kept}, not {other}"))
                .help("put parentheses around the part that counts first"),
        );
    }
}
