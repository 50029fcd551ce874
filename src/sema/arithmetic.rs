//! Operators on values.

use crate::diag::Diagnostic;
use crate::diag::codes::semantics as codes;
use crate::math;
use crate::source::Span;
use crate::syntax::ast::BinaryOp;
use crate::units::{Dim, Quantity, number};

use super::Analyser;
use super::value::{Value, Vector};

/// A value with the place it comes from.
pub(super) type Placed = (Value, Span);

impl Analyser<'_> {
    /// `left op right`, written with `op` at `op_span`; the whole expression is at `span`.
    pub(super) fn binary(&mut self, op: BinaryOp, op_span: Span, left: Placed, right: Placed) -> Value {
        if matches!(left.0, Value::Poison) || matches!(right.0, Value::Poison) {
            return Value::Poison;
        }
        match op {
            BinaryOp::Or | BinaryOp::And => self.logic(op, &left, &right),
            BinaryOp::Equal
            | BinaryOp::NotEqual
            | BinaryOp::Less
            | BinaryOp::LessEqual
            | BinaryOp::Greater
            | BinaryOp::GreaterEqual => self.compare(op, op_span, &left, &right),
            BinaryOp::Add | BinaryOp::Subtract => self.sum(op, op_span, &left, &right),
            BinaryOp::Multiply => self.product(op_span, &left, &right),
            BinaryOp::Divide => self.quotient(op_span, &left, &right),
            BinaryOp::Power => self.power(op_span, &left, &right),
        }
    }

    fn logic(&mut self, op: BinaryOp, left: &Placed, right: &Placed) -> Value {
        match (self.condition(left), self.condition(right)) {
            (Some(a), Some(b)) => Value::Truth(if op == BinaryOp::Or { a || b } else { a && b }),
            _ => Value::Poison,
        }
    }

    /// The value as a condition; reports what is none.
    pub(super) fn condition(&mut self, (value, span): &Placed) -> Option<bool> {
        match value {
            Value::Truth(truth) => Some(*truth),
            Value::Poison => None,
            other => {
                let message = format!("a condition is wanted here, and this is {}", other.kind_name());
                self.report(
                    Diagnostic::new(&codes::NOT_A_CONDITION, *span, message)
                        .help("compare it with something: `N > 0`, `MODE == 2`"),
                );
                None
            }
        }
    }

    fn compare(&mut self, op: BinaryOp, op_span: Span, left: &Placed, right: &Placed) -> Value {
        let ordering = match (&left.0, &right.0) {
            (Value::Number(a), Value::Number(b)) => match self.level(op_span, (*a, left.1), (*b, right.1)) {
                Some((a, b)) => a.value.partial_cmp(&b.value),
                None => return Value::Poison,
            },
            (Value::Text(a) | Value::Word(a), Value::Text(b) | Value::Word(b)) if is_equality(op) => {
                Some(a.cmp(b))
            }
            (Value::Truth(a), Value::Truth(b)) if is_equality(op) => Some(a.cmp(b)),
            _ => return self.wrong_operands("compared with", op_span, left, right),
        };
        use core::cmp::Ordering::{Equal, Greater, Less};
        Value::Truth(match op {
            BinaryOp::Equal => ordering == Some(Equal),
            BinaryOp::NotEqual => ordering != Some(Equal),
            BinaryOp::Less => ordering == Some(Less),
            BinaryOp::LessEqual => matches!(ordering, Some(Less | Equal)),
            BinaryOp::Greater => ordering == Some(Greater),
            _ => matches!(ordering, Some(Greater | Equal)),
        })
    }

    fn wrong_operands(&mut self, verb: &str, op_span: Span, left: &Placed, right: &Placed) -> Value {
        let (a, b) = (left.0.kind_name(), right.0.kind_name());
        self.report(
            Diagnostic::new(&codes::WRONG_OPERAND, op_span, format!("{a} cannot be {verb} {b}"))
                .label(left.1, a)
                .label(right.1, b),
        );
        Value::Poison
    }

    /// Two quantities in one dimension: a bare number takes that of the other.
    pub(super) fn level(
        &mut self,
        at: Span,
        left: (Quantity, Span),
        right: (Quantity, Span),
    ) -> Option<(Quantity, Quantity)> {
        let ((a, a_span), (b, b_span)) = (left, right);
        if a.dim == b.dim {
            return Some((a, b));
        }
        let pair = if a.is_bare() {
            self.land(a, b.dim, a_span).map(|a| (a, b))
        } else {
            self.land(b, a.dim, b_span).map(|b| (a, b))
        };
        if pair.is_none() {
            let message = format!("{} and {} do not go together", article(a.dim), article(b.dim));
            let (a, b) = (
                format!("{}: {}", self.show(a), a.dim.name()),
                format!("{}: {}", self.show(b), b.dim.name()),
            );
            self.report(
                Diagnostic::new(&codes::DIMENSIONS_DIFFER, at, message).label(a_span, a).label(b_span, b),
            );
        }
        pair
    }

    fn level_vectors(
        &mut self,
        at: Span,
        left: (Vector, Span),
        right: (Vector, Span),
    ) -> Option<(Vector, Vector)> {
        let ((a, a_span), (b, b_span)) = (left, right);
        let (ra, rb) = (Quantity::new(1.0, a.dim), Quantity::new(1.0, b.dim));
        self.level(at, (ra, a_span), (rb, b_span))?;
        let dim = if a.dim == Dim::NONE { b.dim } else { a.dim };
        Some((a.land(dim, self.unit())?, b.land(dim, self.unit())?))
    }

    fn sum(&mut self, op: BinaryOp, op_span: Span, left: &Placed, right: &Placed) -> Value {
        let sign = if op == BinaryOp::Add { 1.0 } else { -1.0 };
        match (&left.0, &right.0) {
            (Value::Number(a), Value::Number(b)) => match self.level(op_span, (*a, left.1), (*b, right.1)) {
                Some((a, b)) => self.finite(op_span, Quantity::new(a.value + sign * b.value, a.dim)),
                None => Value::Poison,
            },
            (Value::Vector(a), Value::Vector(b)) => {
                match self.level_vectors(op_span, (*a, left.1), (*b, right.1)) {
                    Some((a, b)) => {
                        let v = [0, 1, 2].map(|i| a.v[i] + sign * b.v[i]);
                        self.finite_vector(op_span, Vector { v, dim: a.dim })
                    }
                    None => Value::Poison,
                }
            }
            _ => {
                let verb = if op == BinaryOp::Add { "added to" } else { "reduced by" };
                self.wrong_operands(verb, op_span, left, right)
            }
        }
    }

    fn product(&mut self, op_span: Span, left: &Placed, right: &Placed) -> Value {
        match (&left.0, &right.0) {
            (Value::Number(a), Value::Number(b)) => match a.dim.times(b.dim) {
                Some(dim) => self.finite(op_span, Quantity::new(a.value * b.value, dim)),
                None => self.odd_dimension(op_span),
            },
            (Value::Number(k), Value::Vector(v)) | (Value::Vector(v), Value::Number(k)) => {
                match k.dim.times(v.dim) {
                    Some(dim) => self.finite_vector(op_span, Vector { v: v.v.map(|x| x * k.value), dim }),
                    None => self.odd_dimension(op_span),
                }
            }
            (Value::Vector(_), Value::Vector(_)) => {
                let at = op_span;
                self.report(
                    Diagnostic::new(&codes::WRONG_OPERAND, at, "two vectors have two products")
                        .help("write DOT(a, b) for the number, CROSS(a, b) for the vector"),
                );
                Value::Poison
            }
            _ => self.wrong_operands("multiplied by", op_span, left, right),
        }
    }

    fn quotient(&mut self, op_span: Span, left: &Placed, right: &Placed) -> Value {
        let Value::Number(b) = right.0 else {
            return self.wrong_operands("divided by", op_span, left, right);
        };
        if b.value == 0.0 && matches!(left.0, Value::Number(_) | Value::Vector(_)) {
            let divided = match &left.0 {
                Value::Number(a) => self.show(*a),
                other => other.kind_name(),
            };
            let remark = format!("this is {}", self.show(b));
            self.report(
                Diagnostic::new(&codes::DIVISION_BY_ZERO, right.1, format!("{divided} is divided by zero"))
                    .at(remark),
            );
            return Value::Poison;
        }
        match &left.0 {
            Value::Number(a) => match a.dim.over(b.dim) {
                Some(dim) => self.finite(op_span, Quantity::new(a.value / b.value, dim)),
                None => self.odd_dimension(op_span),
            },
            Value::Vector(a) => match a.dim.over(b.dim) {
                Some(dim) => self.finite_vector(op_span, Vector { v: a.v.map(|x| x / b.value), dim }),
                None => self.odd_dimension(op_span),
            },
            _ => self.wrong_operands("divided by", op_span, left, right),
        }
    }

    pub(super) fn power(&mut self, op_span: Span, left: &Placed, right: &Placed) -> Value {
        let (Value::Number(base), Value::Number(exponent)) = (&left.0, &right.0) else {
            return self.wrong_operands("raised to the power of", op_span, left, right);
        };
        if !exponent.is_bare() {
            let message = format!("an exponent is a pure number, and this is {}", article(exponent.dim));
            self.report(Diagnostic::new(&codes::WRONG_OPERAND, right.1, message).at(self.show(*exponent)));
            return Value::Poison;
        }
        if base.value == 0.0 && exponent.value < 0.0 {
            let message = format!("zero to the power {} divides by zero", number(exponent.value));
            self.report(Diagnostic::new(&codes::DIVISION_BY_ZERO, op_span, message));
            return Value::Poison;
        }
        let Some(dim) = power_dim(base.dim, exponent.value) else { return self.odd_dimension(op_span) };
        self.finite(op_span, Quantity::new(raise(base.value, exponent.value), dim))
    }

    fn odd_dimension(&mut self, at: Span) -> Value {
        self.report(Diagnostic::new(
            &codes::DIMENSIONS_DIFFER,
            at,
            "the result would have a dimension with an exponent that is not whole, or too large",
        ));
        Value::Poison
    }

    /// The quantity, unless it is infinite or not a number.
    pub(super) fn finite(&mut self, at: Span, quantity: Quantity) -> Value {
        if quantity.value.is_finite() {
            return Value::Number(quantity);
        }
        let message = if quantity.value.is_nan() {
            "this has no real result"
        } else {
            "the result is too large; the largest number is about 1.7E308"
        };
        self.report(Diagnostic::new(&codes::NO_VALUE, at, message));
        Value::Poison
    }

    fn finite_vector(&mut self, at: Span, vector: Vector) -> Value {
        let worst = vector.v.into_iter().find(|x| !x.is_finite());
        match worst {
            None => Value::Vector(vector),
            Some(x) => self.finite(at, Quantity::new(x, vector.dim)),
        }
    }
}

/// Largest exponent that is carried out by multiplication, which is exact where powers of small whole numbers are.
const BY_MULTIPLICATION: f64 = 64.0;

/// `base ** exponent`.
pub(super) fn raise(base: f64, exponent: f64) -> f64 {
    if exponent.fract() != 0.0 || exponent.abs() > BY_MULTIPLICATION {
        return math::pow(base, exponent);
    }
    let mut result = 1.0;
    let mut left = exponent.abs();
    while left >= 1.0 {
        result *= base;
        left -= 1.0;
    }
    if exponent < 0.0 { 1.0 / result } else { result }
}

/// The dimension of a power: whole exponents and halves.
fn power_dim(dim: Dim, exponent: f64) -> Option<Dim> {
    if dim == Dim::NONE {
        return Some(Dim::NONE);
    }
    let twice = exponent * 2.0;
    if twice.fract() != 0.0 || twice.abs() > 100.0 {
        return None;
    }
    #[allow(clippy::cast_possible_truncation)]
    dim.power(twice as i8, 2)
}

fn is_equality(op: BinaryOp) -> bool {
    matches!(op, BinaryOp::Equal | BinaryOp::NotEqual)
}

/// The name of a dimension with its article.
pub(super) fn article(dim: Dim) -> String {
    let name = dim.name();
    let vowel = name.starts_with(['a', 'e', 'i', 'o', 'u']);
    format!("{} {name}", if vowel { "an" } else { "a" })
}
