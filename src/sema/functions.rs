//! The functions of expressions.

use crate::diag::Diagnostic;
use crate::diag::codes::semantics as codes;
use crate::math::{self, DEG};
use crate::source::Span;
use crate::syntax::ast::{Expr, ExprKind, Name};
use crate::units::{Dim, Quantity, number};
use crate::vocab::{Function, FunctionId};

use super::Analyser;
use super::arithmetic::{Placed, article};
use super::scope::BindingKind;
use super::transform::{cross, dot, norm};
use super::value::{Entity, Value, Vector};

impl Analyser<'_> {
    /// `name(args)`.
    pub(super) fn call_function(
        &mut self,
        function: &'static Function,
        name: &Name,
        args: &[Expr],
        span: Span,
    ) -> Value {
        if args.len() < function.min || args.len() > function.max {
            let message = format!(
                "{} takes {}({}); {} given",
                name.text,
                function.name,
                function.signature,
                args.len()
            );
            self.report(Diagnostic::new(&codes::FUNCTION_ARGUMENTS, name.span, message));
            return Value::Poison;
        }
        if function.id == FunctionId::Num {
            return self.count_elements(args);
        }
        let values: Vec<Placed> = args.iter().map(|e| (self.evaluate(e), e.span)).collect();
        if values.iter().any(|(v, _)| matches!(v, Value::Poison)) {
            return Value::Poison;
        }
        self.function_value(function, &values, span).unwrap_or(Value::Poison)
    }

    pub(super) fn function_value(
        &mut self,
        function: &Function,
        args: &[Placed],
        span: Span,
    ) -> Option<Value> {
        let first = args.first()?;
        let second = args.get(1);
        let value = match function.id {
            FunctionId::Abs => self.map(first, f64::abs)?,
            FunctionId::Int => self.map(first, f64::trunc)?,
            FunctionId::Round => self.map(first, f64::round)?,
            FunctionId::Sqrt => self.square_root(first)?,
            FunctionId::Sin => Value::bare(sine(self.angle_argument(first)?)),
            FunctionId::Cos => Value::bare(sine(self.angle_argument(first)? + 90.0)),
            FunctionId::Tan => self.tangent_of(first)?,
            FunctionId::Asin => self.inverse(first, math::asin)?,
            FunctionId::Acos => self.inverse(first, math::acos)?,
            FunctionId::Atan => Value::number(math::atan(self.pure(first)?) / DEG, Dim::ANGLE),
            FunctionId::Atan2 => self.atan2(first, second?, span)?,
            FunctionId::Exp => {
                let x = self.pure(first)?;
                self.finite(span, Quantity::bare(math::exp(x)))
            }
            FunctionId::Log => Value::bare(math::ln(self.positive(first)?)),
            FunctionId::Log10 => Value::bare(math::log10(self.positive(first)?)),
            FunctionId::Min => self.extreme(args, |a, b| a < b)?,
            FunctionId::Max => self.extreme(args, |a, b| a > b)?,
            FunctionId::Mod => self.modulo(first, second?)?,
            FunctionId::Dist => self.distance(first, second?, span)?,
            FunctionId::Angle => self.angle_of(first, second, span)?,
            FunctionId::Dot => self.dot(first, second?)?,
            FunctionId::Cross => self.cross(first, second?)?,
            FunctionId::Unit => self.unit_vector(first)?,
            FunctionId::Norm => self.norm(first)?,
            FunctionId::Num => return None,
        };
        Some(value)
    }

    fn count_elements(&mut self, args: &[Expr]) -> Value {
        let Some(ExprKind::Name(name)) = args.first().map(|e| &e.kind) else { return Value::Poison };
        match self.scope.get(&name.upper()).map(|b| &b.kind) {
            Some(BindingKind::Array(array)) => {
                let largest = array.items.keys().filter_map(|k| k.first()).max().copied().unwrap_or(0);
                #[allow(clippy::cast_precision_loss)]
                Value::bare(array.size.unwrap_or(largest) as f64)
            }
            Some(BindingKind::Entity(_, Value::Entity(Entity::Pattern(points)))) => {
                Value::bare(math::count(points.len()))
            }
            Some(BindingKind::Poison) => Value::Poison,
            _ => {
                let message = format!("{} is neither subscripted nor a pattern", name.text);
                self.report(Diagnostic::new(&codes::SUBSCRIPT, name.span, message));
                Value::Poison
            }
        }
    }

    /// The argument as a number.
    fn number_argument(&mut self, (value, span): &Placed) -> Option<Quantity> {
        if let Value::Number(q) = value {
            return Some(*q);
        }
        let message = format!("a number is wanted here, and this is {}", value.kind_name());
        self.report(Diagnostic::new(&codes::WRONG_KIND, *span, message));
        None
    }

    fn dimension_argument(&mut self, argument: &Placed, dim: Dim) -> Option<f64> {
        let q = self.number_argument(argument)?;
        if let Some(landed) = self.land(q, dim, argument.1) {
            return Some(landed.value);
        }
        let message = format!("{} is wanted here, and {} is {}", article(dim), self.show(q), article(q.dim));
        self.report(Diagnostic::new(&codes::WRONG_DIMENSION, argument.1, message));
        None
    }

    fn pure(&mut self, argument: &Placed) -> Option<f64> {
        self.dimension_argument(argument, Dim::NONE)
    }

    fn angle_argument(&mut self, argument: &Placed) -> Option<f64> {
        self.dimension_argument(argument, Dim::ANGLE)
    }

    fn map(&mut self, argument: &Placed, f: impl Fn(f64) -> f64) -> Option<Value> {
        let q = self.number_argument(argument)?;
        let shown = q.dim.factor(self.unit());
        // Whole parts are those of the number as the user sees it: INT(2.5in) is 2in.
        let value = if q.is_bare() { f(q.value) } else { f(q.in_unit(self.unit())) * shown };
        Some(Value::number(value, q.dim))
    }

    fn no_value(&mut self, span: Span, message: String) -> Option<Value> {
        self.report(Diagnostic::new(&codes::NO_VALUE, span, message));
        None
    }

    fn square_root(&mut self, argument: &Placed) -> Option<Value> {
        let q = self.number_argument(argument)?;
        if q.value < 0.0 {
            let shown = self.show(q);
            return self.no_value(argument.1, format!("there is no square root of {shown}"));
        }
        match q.dim.power(1, 2) {
            Some(dim) => Some(Value::number(q.value.sqrt(), dim)),
            None => {
                let message = format!(
                    "the square root of {} has no dimension; of an area it is a length",
                    article(q.dim)
                );
                self.report(Diagnostic::new(&codes::WRONG_DIMENSION, argument.1, message));
                None
            }
        }
    }

    fn tangent_of(&mut self, argument: &Placed) -> Option<Value> {
        let angle = self.angle_argument(argument)?;
        let cosine = sine(angle + 90.0);
        if cosine == 0.0 {
            return self.no_value(argument.1, format!("the tangent of {} deg is infinite", number(angle)));
        }
        Some(Value::bare(sine(angle) / cosine))
    }

    fn inverse(&mut self, argument: &Placed, f: impl Fn(f64) -> f64) -> Option<Value> {
        let x = self.pure(argument)?;
        if x.abs() > 1.0 {
            return self.no_value(argument.1, format!("no angle has the sine or cosine {}", number(x)));
        }
        Some(Value::number(f(x) / DEG, Dim::ANGLE))
    }

    fn positive(&mut self, argument: &Placed) -> Option<f64> {
        let x = self.pure(argument)?;
        if x <= 0.0 {
            self.no_value(argument.1, format!("there is no logarithm of {}", number(x)));
            return None;
        }
        Some(x)
    }

    fn atan2(&mut self, y: &Placed, x: &Placed, span: Span) -> Option<Value> {
        let (a, b) = (self.number_argument(y)?, self.number_argument(x)?);
        let (a, b) = self.level(span, (a, y.1), (b, x.1))?;
        if a.value == 0.0 && b.value == 0.0 {
            return self.no_value(span, "the vector (0, 0) has no angle".into());
        }
        Some(Value::number(math::atan2(a.value, b.value) / DEG, Dim::ANGLE))
    }

    fn extreme(&mut self, args: &[Placed], better: impl Fn(f64, f64) -> bool) -> Option<Value> {
        let (first, rest) = args.split_first()?;
        let mut best = (self.number_argument(first)?, first.1);
        for other in rest {
            let q = self.number_argument(other)?;
            let (a, b) = self.level(other.1, best, (q, other.1))?;
            best = if better(b.value, a.value) { (b, other.1) } else { (a, best.1) };
        }
        Some(Value::Number(best.0))
    }

    fn modulo(&mut self, a: &Placed, b: &Placed) -> Option<Value> {
        let (x, y) = (self.number_argument(a)?, self.number_argument(b)?);
        let (x, y) = self.level(b.1, (x, a.1), (y, b.1))?;
        if y.value == 0.0 {
            let message = format!("the remainder of {} divided by zero", self.show(x));
            self.report(Diagnostic::new(&codes::DIVISION_BY_ZERO, b.1, message));
            return None;
        }
        Some(Value::number(x.value - y.value * (x.value / y.value).floor(), x.dim))
    }

    /// The argument as a vector; a line counts as the vector along it.
    fn vector_argument(&mut self, (value, span): &Placed) -> Option<Vector> {
        match value {
            Value::Vector(v) => Some(*v),
            Value::Entity(Entity::Line(line)) => {
                let v = [line.to[0] - line.from[0], line.to[1] - line.from[1], 0.0];
                Some(Vector { v, dim: Dim::LENGTH })
            }
            other => {
                let message = format!("a point or vector is wanted here, and this is {}", other.kind_name());
                self.report(Diagnostic::new(&codes::WRONG_KIND, *span, message));
                None
            }
        }
    }

    fn direction(&mut self, argument: &Placed) -> Option<[f64; 3]> {
        let v = self.vector_argument(argument)?;
        let length = norm(v.v);
        if length == 0.0 {
            self.no_value(argument.1, "a vector of length 0 has no direction".into());
            return None;
        }
        Some(v.v.map(|x| x / length))
    }

    fn distance(&mut self, a: &Placed, b: &Placed, span: Span) -> Option<Value> {
        let (a, b) = (self.as_vector(a)?, self.as_vector(b)?);
        let difference = self.binary(crate::syntax::ast::BinaryOp::Subtract, span, a, b);
        match difference {
            Value::Vector(v) => Some(self.norm_value(v)),
            _ => None,
        }
    }

    fn as_vector(&mut self, argument: &Placed) -> Option<Placed> {
        Some((Value::Vector(self.vector_argument(argument)?), argument.1))
    }

    /// The length of a vector; bare components stay bare.
    fn norm_value(&self, v: Vector) -> Value {
        Value::number(norm(v.v), v.dim)
    }

    fn norm(&mut self, argument: &Placed) -> Option<Value> {
        let v = self.vector_argument(argument)?;
        Some(self.norm_value(v))
    }

    fn angle_of(&mut self, a: &Placed, b: Option<&Placed>, span: Span) -> Option<Value> {
        let u = self.direction(a)?;
        let degrees = match b {
            None => {
                if u[0] == 0.0 && u[1] == 0.0 {
                    return self.no_value(span, "a vector along Z has no angle in the XY plane".into());
                }
                math::atan2(u[1], u[0]) / DEG
            }
            Some(b) => {
                let w = self.direction(b)?;
                let (sine, cosine) = (norm(cross(u, w)), dot(u, w));
                math::atan2(sine, cosine) / DEG
            }
        };
        Some(Value::number(degrees, Dim::ANGLE))
    }

    fn dot(&mut self, a: &Placed, b: &Placed) -> Option<Value> {
        let (u, w) = (self.vector_argument(a)?, self.vector_argument(b)?);
        let dim = u.dim.times(w.dim)?;
        Some(self.finite(a.1, Quantity::new(dot(u.v, w.v), dim)))
    }

    fn cross(&mut self, a: &Placed, b: &Placed) -> Option<Value> {
        let (u, w) = (self.vector_argument(a)?, self.vector_argument(b)?);
        Some(Value::Vector(Vector { v: cross(u.v, w.v), dim: u.dim.times(w.dim)? }))
    }

    fn unit_vector(&mut self, argument: &Placed) -> Option<Value> {
        Some(Value::Vector(Vector { v: self.direction(argument)?, dim: Dim::NONE }))
    }
}

/// Sine and cosine of an angle in degrees; see [`sine`].
pub(super) fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    (sine(degrees), sine(degrees + 90.0))
}

/// Sine of an angle in degrees, exact at the multiples of 30 that have a short value.
fn sine(degrees: f64) -> f64 {
    let turn = degrees - 360.0 * (degrees / 360.0).floor();
    let quarter = |x: f64| {
        if x == 0.0 {
            0.0
        } else if x == 30.0 {
            0.5
        } else if x == 90.0 {
            1.0
        } else {
            math::sin(x * DEG)
        }
    };
    match turn {
        x if x <= 90.0 => quarter(x),
        x if x <= 180.0 => quarter(180.0 - x),
        x if x <= 270.0 => -quarter(x - 180.0),
        x => -quarter(360.0 - x),
    }
}
