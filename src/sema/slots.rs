//! Values in the slots of the vocabulary: kind, dimension, range.

use crate::diag::codes::semantics as codes;
use crate::diag::{Diagnostic, did_you_mean};
use crate::geom::motion::Law;
use crate::source::Span;
use crate::units::{Dim, Quantity, number};
use crate::vocab::{EntityKind, Kind, Range, Slot, Statement};

use super::Analyser;
use super::arithmetic::article;
use super::forms;
use super::matched::Typed;
use super::tokens::{POLY, Token, TokenKind};
use super::value::{Value, Vector};

impl Analyser<'_> {
    /// The value of an argument that fits a slot, checked against it.
    pub(super) fn typed(
        &mut self,
        statement: &Statement,
        word: Option<&str>,
        slot: &Slot,
        token: &Token<'_>,
    ) -> Result<Typed, Box<Diagnostic>> {
        if slot.kind == Kind::Name {
            return Ok(match (&token.kind, token.name) {
                (TokenKind::Value(Value::Text(text)), _) => Typed::Text(text.clone()),
                (TokenKind::Word(word), None) => Typed::Name(word.clone()),
                (_, name) => Typed::Name(name.map_or_else(String::new, |n| n.text.clone())),
            });
        }
        match (&token.kind, slot.kind) {
            (TokenKind::Binding(name, value), _) => Ok(Typed::Binding((*name).clone(), (*value).clone())),
            (TokenKind::Word(law), Kind::Law) => {
                Ok(Typed::Law(if law == POLY { None } else { Law::by_name(law) }))
            }
            (TokenKind::Value(value), kind) => self.typed_value(statement, word, slot, kind, (value, token)),
            _ => Err(Box::new(self.misfit(statement, word, slot, token))),
        }
    }

    fn typed_value(
        &mut self,
        statement: &Statement,
        word: Option<&str>,
        slot: &Slot,
        kind: Kind,
        (value, token): (&Value, &Token<'_>),
    ) -> Result<Typed, Box<Diagnostic>> {
        match (value, kind) {
            (Value::Number(q), Kind::Number(dim, range)) => {
                self.in_slot(statement, word, slot, (*q, token.span), dim, range).map(Typed::Number)
            }
            (Value::Number(q), Kind::Count(min, max)) => {
                self.whole(statement, word, slot, (*q, token.span), min, max).map(Typed::Number)
            }
            (Value::Number(q), Kind::Lift) => {
                let fits = q.is_bare() || q.dim == Dim::LENGTH || q.dim == Dim::ANGLE;
                self.quantity(statement, word, slot, (*q, token.span), fits)
            }
            (Value::Number(q), Kind::LiftRate(n)) => {
                let per = Dim { angle: -i8::try_from(n).unwrap_or(1), ..Dim::NONE };
                let swing = Dim { angle: per.angle + 1, ..Dim::NONE };
                let fits = q.is_bare() || q.dim == Dim { length: 1, ..per } || q.dim == swing;
                self.quantity(statement, word, slot, (*q, token.span), fits)
            }
            (Value::Number(q), Kind::Feed) => {
                let fits =
                    q.is_bare() || [Dim::FEED, Dim::FEED_PER_REV, Dim::FEED_PER_TOOTH].contains(&q.dim);
                if fits && q.value <= 0.0 {
                    return Err(Box::new(self.out_of_range(
                        statement,
                        word,
                        slot,
                        (*q, token.span),
                        Range::Positive,
                    )));
                }
                self.quantity(statement, word, slot, (*q, token.span), fits)
            }
            (Value::Number(q), Kind::Any) => Ok(Typed::Quantity(*q)),
            (Value::Vector(v), Kind::Declared(EntityKind::Vector)) => Ok(Typed::Vector(*v)),
            (Value::Vector(v), Kind::Point | Kind::Declared(_) | Kind::PointOrPattern) => {
                match v.land(Dim::LENGTH, self.unit()) {
                    Some(landed) => {
                        self.note_bare(*v, token.span);
                        Ok(Typed::Vector(landed))
                    }
                    None => Err(Box::new(self.wrong_dimension(
                        statement,
                        word,
                        slot,
                        (Quantity::new(v.v[0], v.dim), token.span),
                    ))),
                }
            }
            (Value::Vector(v), Kind::Vector) => Ok(Typed::Vector(*v)),
            (Value::Entity(entity), Kind::PointOrPattern) => Ok(Typed::Entity(entity.clone())),
            (Value::Entity(entity), Kind::Entity(kinds)) if kinds.contains(&entity.kind()) => {
                Ok(Typed::Entity(entity.clone()))
            }
            (Value::Entity(_), Kind::Contour) => Ok(Typed::Contour(vec![(value.clone(), token.span)])),
            (Value::List(items), Kind::Contour) => Ok(Typed::Contour(items.to_vec())),
            (Value::Text(text), Kind::Text) => Ok(Typed::Text(text.clone())),
            _ => Err(Box::new(self.misfit(statement, word, slot, token))),
        }
    }

    /// Remembers that a bare point was read in the program's unit.
    pub(super) fn note_bare(&mut self, v: Vector, span: Span) {
        if v.dim == Dim::NONE && v.v.iter().any(|x| *x != 0.0) && self.unit_used.is_none() {
            self.unit_used = Some(span);
        }
    }

    fn quantity(
        &mut self,
        statement: &Statement,
        word: Option<&str>,
        slot: &Slot,
        q: (Quantity, Span),
        fits: bool,
    ) -> Result<Typed, Box<Diagnostic>> {
        if fits {
            Ok(Typed::Quantity(q.0))
        } else {
            Err(Box::new(self.wrong_dimension(statement, word, slot, q)))
        }
    }

    fn in_slot(
        &mut self,
        statement: &Statement,
        word: Option<&str>,
        slot: &Slot,
        (q, span): (Quantity, Span),
        dim: Dim,
        range: Range,
    ) -> Result<f64, Box<Diagnostic>> {
        let Some(landed) = self.land(q, dim, span) else {
            return Err(Box::new(self.wrong_dimension(statement, word, slot, (q, span))));
        };
        if forms::in_range(range, landed.value) {
            return Ok(landed.value);
        }
        Err(Box::new(self.out_of_range(statement, word, slot, (landed, span), range)))
    }

    fn whole(
        &mut self,
        statement: &Statement,
        word: Option<&str>,
        slot: &Slot,
        (q, span): (Quantity, Span),
        min: u32,
        max: u32,
    ) -> Result<f64, Box<Diagnostic>> {
        if !q.is_bare() {
            return Err(Box::new(self.wrong_dimension(statement, word, slot, (q, span))));
        }
        if q.value.fract() != 0.0 || q.value < f64::from(min) || q.value > f64::from(max) {
            let place = place(statement, word, slot);
            let message =
                format!("{place} is a whole number from {min} to {max}, and this is {}", number(q.value));
            return Err(Box::new(Diagnostic::new(&codes::OUT_OF_RANGE, span, message)));
        }
        Ok(q.value)
    }

    fn out_of_range(
        &self,
        statement: &Statement,
        word: Option<&str>,
        slot: &Slot,
        (q, span): (Quantity, Span),
        range: Range,
    ) -> Diagnostic {
        let rule = forms::range_text(range, |x| self.show(Quantity::new(x, q.dim)));
        let message = format!("{} {rule}, and this is {}", place(statement, word, slot), self.show(q));
        Diagnostic::new(&codes::OUT_OF_RANGE, span, message).note(format!("{}: {}", slot.name, slot.help))
    }

    fn wrong_dimension(
        &self,
        statement: &Statement,
        word: Option<&str>,
        slot: &Slot,
        (q, span): (Quantity, Span),
    ) -> Diagnostic {
        let message = format!(
            "{} is {}, and {} is {}",
            place(statement, word, slot),
            forms::describe(slot.kind),
            self.show(q),
            article(q.dim)
        );
        Diagnostic::new(&codes::WRONG_DIMENSION, span, message)
    }

    /// An argument that cannot stand in a slot.
    pub(super) fn misfit(
        &self,
        statement: &Statement,
        word: Option<&str>,
        slot: &Slot,
        token: &Token<'_>,
    ) -> Diagnostic {
        match (&token.kind, slot.kind) {
            (TokenKind::Word(_) | TokenKind::Unknown, Kind::Law) => self.unknown_law(statement, token),
            (TokenKind::Unknown, _) => match token.name {
                Some(name) => self.unknown_name(name),
                None => Diagnostic::new(&codes::UNKNOWN_NAME, token.span, "unknown name"),
            },
            _ => {
                let message = format!(
                    "{} is {}, not {}",
                    place(statement, word, slot),
                    forms::describe(slot.kind),
                    token.describe()
                );
                self.wrong_kind(message, token)
            }
        }
    }

    fn unknown_law(&self, statement: &Statement, token: &Token<'_>) -> Diagnostic {
        let text = forms::written(token);
        let problem = Diagnostic::new(
            &codes::UNKNOWN_MINOR,
            token.span,
            format!("{} knows no motion law {text}", statement.word),
        );
        let names =
            Law::all().iter().flat_map(|l| core::iter::once(l.name()).chain(l.aliases().iter().copied()));
        match did_you_mean(&text, names.chain([POLY])) {
            Some(near) => problem.help(format!("did you mean `{near}`?")),
            None => {
                let names: Vec<&str> = Law::all().iter().map(|l| l.name()).collect();
                problem.note(format!("the laws are {} and {POLY}", names.join(", ")))
            }
        }
    }
}

/// «BASE of CAM».
fn place(statement: &Statement, word: Option<&str>, slot: &Slot) -> String {
    let of = statement.word;
    match word {
        Some(word) if word.eq_ignore_ascii_case(slot.name) => format!("{word} of {of}"),
        Some(word) => format!("the {} after {word} of {of}", slot.name),
        None if slot.name == slot.help && slot.name.len() <= SHORT_NAME => format!("`{}` of {of}", slot.name),
        None if slot.name.len() <= SHORT_NAME => format!("`{}` of {of} ({})", slot.name, slot.help),
        None => format!("the {} of {of}", slot.name),
    }
}

/// Slots with names up to this length are explained in messages.
const SHORT_NAME: usize = 2;
