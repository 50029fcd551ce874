//! The checked arguments of one statement.

use std::rc::Rc;

use crate::geom::motion::Law;
use crate::source::Span;
use crate::syntax::ast::{Expr, Name};
use crate::units::Quantity;

use super::arithmetic::Placed;
use super::value::{Entity, Vector};

/// A typed value.
#[derive(Debug, Clone)]
pub(super) enum Typed {
    /// A number in base units, of the slot's dimension.
    Number(f64),
    /// A number whose dimension is part of the answer.
    Quantity(Quantity),
    /// A point (mm) or vector.
    Vector(Vector),
    /// A named thing.
    Entity(Entity),
    /// Curves.
    Contour(Vec<Placed>),
    /// A text.
    Text(Rc<str>),
    /// A motion law; `None` is POLY.
    Law(Option<Law>),
    /// A word as written.
    Name(String),
    /// A word of the table.
    Word(&'static str),
    /// `name = value`.
    Binding(Name, Expr),
}

/// A value with the name of its slot.
#[derive(Debug, Clone)]
pub(super) struct Found {
    /// Name of the slot, lead word or option.
    pub name: &'static str,
    /// Where.
    pub span: Span,
    /// What.
    pub typed: Typed,
}

/// The arguments of one statement, checked.
#[derive(Debug, Clone)]
pub(super) struct Matched {
    /// The form they follow.
    pub form: &'static str,
    /// The major word.
    pub word: Span,
    /// Values in order.
    pub found: Vec<Found>,
}

impl Matched {
    /// The first value of this name.
    pub fn get(&self, name: &str) -> Option<&Found> {
        self.found.iter().find(|f| f.name == name)
    }
    /// All values of this name.
    pub fn all<'m>(&'m self, name: &'m str) -> impl Iterator<Item = &'m Found> {
        self.found.iter().filter(move |f| f.name == name)
    }
    /// A number in base units.
    pub fn number(&self, name: &str) -> Option<f64> {
        self.found.iter().filter(|f| f.name == name).find_map(|f| match f.typed {
            Typed::Number(value) => Some(value),
            _ => None,
        })
    }
    /// A word of the table.
    pub fn word(&self, name: &str) -> Option<&'static str> {
        self.found.iter().filter(|f| f.name == name).find_map(|f| match f.typed {
            Typed::Word(word) => Some(word),
            _ => None,
        })
    }
    /// A point or vector.
    pub fn vector(&self, name: &str) -> Option<Vector> {
        self.found.iter().filter(|f| f.name == name).find_map(|f| match f.typed {
            Typed::Vector(v) => Some(v),
            _ => None,
        })
    }
    /// A named thing.
    pub fn entity(&self, name: &str) -> Option<&Entity> {
        self.found.iter().filter(|f| f.name == name).find_map(|f| match &f.typed {
            Typed::Entity(entity) => Some(entity),
            _ => None,
        })
    }
    /// A text or name.
    pub fn text(&self, name: &str) -> Option<&str> {
        self.found.iter().filter(|f| f.name == name).find_map(|f| match &f.typed {
            Typed::Text(text) => Some(text.as_ref()),
            Typed::Name(text) => Some(text.as_str()),
            _ => None,
        })
    }
    /// Where the value of this name stands; the major word without one.
    pub fn span(&self, name: &str) -> Span {
        let values = self.found.iter().filter(|f| f.name == name);
        values
            .clone()
            .find(|f| !matches!(f.typed, Typed::Word(_)))
            .or(values.clone().next())
            .map_or(self.word, |f| f.span)
    }
}
