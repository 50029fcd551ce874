//! Arguments as the vocabulary sees them: words, names nobody knows, values.

use crate::geom::motion::Law;
use crate::source::Span;
use crate::syntax::ast::{Arg, ArgKind, Command, Expr, ExprKind, Name};
use crate::vocab::{self, EntityKind, Item, Kind, Statement, Usage};

use super::Analyser;
use super::scope::{BindingKind, Element};
use super::value::{Entity, Value};

/// One argument.
#[derive(Debug, Clone)]
pub(super) struct Token<'c> {
    /// Where.
    pub span: Span,
    /// The lone word it is written as.
    pub name: Option<&'c Name>,
    /// What.
    pub kind: TokenKind<'c>,
    /// What it was declared as, if it is a declared thing and nothing calculated.
    pub declared: Option<EntityKind>,
}

/// What an argument is.
#[derive(Debug, Clone)]
pub(super) enum TokenKind<'c> {
    /// A word of the language, upper case; perhaps not one of this statement.
    Word(String),
    /// A name that stands for nothing.
    Unknown,
    /// A value.
    Value(Value),
    /// `name = value`.
    Binding(&'c Name, &'c Expr),
}

impl Token<'_> {
    /// The word it is.
    pub fn word(&self) -> Option<&str> {
        match &self.kind {
            TokenKind::Word(word) => Some(word),
            _ => None,
        }
    }
    /// Whether it is the value of something that failed.
    pub fn is_poison(&self) -> bool {
        matches!(self.kind, TokenKind::Value(Value::Poison))
    }
    /// With its article, for messages.
    pub fn describe(&self) -> String {
        match &self.kind {
            TokenKind::Word(word) => format!("the word {word}"),
            TokenKind::Unknown => "an unknown name".into(),
            TokenKind::Value(Value::Vector(_)) => match self.declared {
                Some(kind) => kind.name().into(),
                None => "a calculated point or vector".into(),
            },
            TokenKind::Value(value) => value.kind_name(),
            TokenKind::Binding(name, _) => format!("`{} = …`", name.text),
        }
    }
    /// Whether it can stand in a slot of this kind, dimension and range apart.
    pub fn fits(&self, kind: Kind) -> bool {
        match (&self.kind, kind) {
            (_, Kind::Name) => self.name.is_some() || matches!(self.kind, TokenKind::Value(Value::Text(_))),
            (TokenKind::Binding(..), Kind::Binding) => true,
            (TokenKind::Binding(..), _) | (_, Kind::Binding) => false,
            (TokenKind::Word(word), Kind::Law) => is_law(word),
            (TokenKind::Word(_), _) => false,
            (TokenKind::Unknown | TokenKind::Value(Value::Poison), _) => true,
            (TokenKind::Value(value), Kind::Declared(kind)) => {
                matches!(value, Value::Vector(_)) && self.declared == Some(kind)
            }
            (TokenKind::Value(value), kind) => value_fits(value, kind),
        }
    }
}

fn value_fits(value: &Value, kind: Kind) -> bool {
    match kind {
        Kind::Number(..) | Kind::Any | Kind::Feed | Kind::Lift | Kind::LiftRate(_) | Kind::Count(..) => {
            matches!(value, Value::Number(_))
        }
        Kind::Point | Kind::Vector => matches!(value, Value::Vector(_)),
        Kind::PointOrPattern => matches!(value, Value::Vector(_) | Value::Entity(Entity::Pattern(_))),
        Kind::Entity(kinds) => matches!(value, Value::Entity(e) if kinds.contains(&e.kind())),
        Kind::Contour => match value {
            Value::Entity(e) => is_contour(e.kind()),
            Value::List(_) => true,
            _ => false,
        },
        Kind::Text => matches!(value, Value::Text(_)),
        Kind::Law | Kind::Name | Kind::Binding | Kind::Declared(_) => false,
    }
}

/// Whether a contour can be made of it.
pub(super) fn is_contour(kind: EntityKind) -> bool {
    matches!(kind, EntityKind::Line | EntityKind::Circle | EntityKind::Curve | EntityKind::Cam)
}

/// The word in place of a law that stands for a polynomial with boundary values.
pub(super) const POLY: &str = "POLY";

fn is_law(word: &str) -> bool {
    word == POLY || Law::by_name(word).is_some()
}

fn takes_laws(statement: &Statement) -> bool {
    statement
        .forms
        .iter()
        .flat_map(|f| f.options)
        .flat_map(|o| o.values)
        .any(|item| matches!(item, Item::Value(slot) | Item::Optional(slot) if slot.kind == Kind::Law))
}

impl Analyser<'_> {
    /// The arguments of `statement`; mistakes inside expressions are reported and give poison. Several elements
    /// of a subscripted name (`P(ALL)`) become several arguments.
    pub(super) fn tokens<'c>(&mut self, statement: &'static Statement, args: &'c [Arg]) -> Vec<Token<'c>> {
        let mut tokens = Vec::with_capacity(args.len());
        for arg in args {
            match self.several(arg) {
                Some(elements) => tokens.extend(elements.into_iter().map(|element| Token {
                    span: arg.span,
                    name: None,
                    declared: element.kind,
                    kind: as_token(element.value),
                })),
                None => tokens.push(self.token(statement, arg)),
            }
        }
        tokens
    }

    /// The elements that `P(ALL)` or `P(2, THRU, 5)` stands for; `None` for everything else.
    fn several(&mut self, arg: &Arg) -> Option<Vec<Element>> {
        match &arg.kind {
            ArgKind::Expr(Expr { kind: ExprKind::Apply { name, args }, .. }) => self.inclusive(name, args),
            _ => None,
        }
    }

    fn token<'c>(&mut self, statement: &'static Statement, arg: &'c Arg) -> Token<'c> {
        let declared = self.declared_kind(arg);
        let (name, kind) = match &arg.kind {
            ArgKind::Named { name, value } => (None, TokenKind::Binding(name, value)),
            ArgKind::Nested(command) => (None, TokenKind::Value(self.nested(command))),
            ArgKind::Expr(Expr { kind: ExprKind::Name(name), .. }) => {
                (Some(name), self.lone_word(statement, name))
            }
            ArgKind::Expr(expr) => (None, as_token(self.evaluate(expr))),
        };
        Token { span: arg.span, name, kind, declared }
    }

    /// What an argument was declared as: by its name, by the word of its definition, as a literal point.
    fn declared_kind(&self, arg: &Arg) -> Option<EntityKind> {
        let expr = match &arg.kind {
            ArgKind::Nested(command) => return declares(command),
            ArgKind::Named { .. } => return None,
            ArgKind::Expr(expr) => expr,
        };
        match &expr.kind {
            ExprKind::Tuple(_) => Some(EntityKind::Point),
            ExprKind::Nested(command) => declares(command),
            ExprKind::Name(name) => match self.scope.get(&name.upper()).map(|b| &b.kind) {
                Some(BindingKind::Entity(kind, _)) => Some(*kind),
                _ => None,
            },
            ExprKind::Apply { name, .. } => match self.scope.get(&name.upper()).map(|b| &b.kind) {
                Some(BindingKind::Array(array)) => array.items.values().find_map(|e| e.kind),
                _ => None,
            },
            _ => None,
        }
    }

    /// A word of the statement comes before a name of the user's; a name before another word of the language.
    fn lone_word<'c>(&mut self, statement: &'static Statement, name: &'c Name) -> TokenKind<'c> {
        let upper = name.upper();
        if statement.has_minor_word(&upper) || (takes_laws(statement) && is_law(&upper)) {
            return TokenKind::Word(upper);
        }
        if let Some(binding) = self.scope.get(&upper) {
            let binding = binding.clone();
            return as_token(self.bound_value(name, &binding));
        }
        // A letter that is a word of other statements is more likely a name.
        if upper.len() > 1 && vocab::is_word(&upper) { TokenKind::Word(upper) } else { TokenKind::Unknown }
    }
}

fn declares(command: &Command) -> Option<EntityKind> {
    match vocab::find(&command.word.text)?.usage {
        Usage::Declares(kind) | Usage::DeclaresOrActs(kind) => Some(kind),
        _ => None,
    }
}

fn as_token<'c>(value: Value) -> TokenKind<'c> {
    match value {
        Value::Word(word) => TokenKind::Word(word.to_string()),
        value => TokenKind::Value(value),
    }
}
