//! Arguments matched against the vocabulary: a statement's tokens become typed values.

use std::rc::Rc;

use crate::diag::codes::semantics as codes;
use crate::diag::{Diagnostic, did_you_mean};
use crate::geom::motion::Law;
use crate::source::Span;
use crate::syntax::ast::{Command, Expr, Name};
use crate::units::{Dim, Quantity, number};
use crate::vocab::{Choices, Form, Item, Kind, Range, Slot, Statement};

use super::Analyser;
use super::arithmetic::{Placed, article};
use super::forms::{self, Expected, Extent};
use super::tokens::{POLY, Token, TokenKind};
use super::value::{Entity, Value, Vector};

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

struct Work<'t, 'c> {
    statement: &'static Statement,
    word: Span,
    tokens: &'t [Token<'c>],
    found: Vec<Found>,
    failed: bool,
}

impl Analyser<'_> {
    /// The arguments of a command as typed values. `None` after messages, or when they use something that has
    /// failed before.
    pub(super) fn arguments(&mut self, statement: &'static Statement, command: &Command) -> Option<Matched> {
        let tokens = self.tokens(statement, &command.args);
        let mut work =
            Work { statement, word: command.word.span, tokens: &tokens, found: Vec::new(), failed: false };
        let Some((form, extent)) = forms::choose(statement, &tokens) else {
            self.no_arguments(&mut work);
            return (!work.failed).then(|| Matched { form: "", word: work.word, found: Vec::new() });
        };
        if !self.unknown_in_lead(&mut work, form, extent) {
            if extent.complete {
                self.lead(&mut work, form);
                self.options(&mut work, form, extent.consumed);
            } else {
                self.broken_lead(&mut work, form, extent);
            }
        }
        let poisoned = tokens.iter().any(Token::is_poison);
        (!work.failed && !poisoned).then_some(Matched { form: form.name, word: work.word, found: work.found })
    }

    fn fail(&mut self, work: &mut Work<'_, '_>, problem: Diagnostic) {
        work.failed = true;
        self.report(problem);
    }

    fn no_arguments(&mut self, work: &mut Work<'_, '_>) {
        if let Some(first) = work.tokens.first() {
            let problem = Diagnostic::new(
                &codes::TOO_MANY,
                first.span,
                format!("{} takes no values", work.statement.word),
            );
            self.fail(work, problem);
        }
    }

    /// Names in the lead that stand for nothing; says whether there were any.
    fn unknown_in_lead(&mut self, work: &mut Work<'_, '_>, form: &'static Form, extent: Extent) -> bool {
        let last = extent.consumed + usize::from(!extent.complete);
        let named: Vec<bool> = name_places(form, work.tokens);
        let mut any = false;
        for (i, token) in work.tokens.iter().enumerate().take(last) {
            if !matches!(token.kind, TokenKind::Unknown) || named.get(i).copied().unwrap_or(false) {
                continue;
            }
            let problem =
                self.unknown_argument(work.statement, token, &Expected::at(work.statement, work.tokens, i));
            self.fail(work, problem);
            any = true;
        }
        any
    }

    /// «Unknown word» or «unknown name», whichever is nearer to what is written.
    fn unknown_argument(&self, statement: &Statement, token: &Token<'_>, expected: &Expected) -> Diagnostic {
        let text = forms::written(token);
        let near_word = did_you_mean(&text, expected.words.iter().copied());
        let only =
            |f: fn(Kind) -> bool| expected.words.is_empty() && expected.slots.iter().all(|s| f(s.kind));
        match token.name {
            Some(name) if !expected.slots.is_empty() && only(|k| k == Kind::Binding) => {
                let message = format!("{} wants a value for {}", statement.word, name.text);
                Diagnostic::new(&codes::MISSING_VALUE, token.span, message)
                    .help(format!("write `{} = …`", name.text))
            }
            Some(name) if !expected.slots.is_empty() && only(|k| k == Kind::Text) => {
                let message = format!("{} takes {} here", statement.word, expected.text());
                Diagnostic::new(&codes::WRONG_KIND, token.span, message)
                    .help(format!("write `'{}'`", name.text))
            }
            Some(name)
                if near_word.is_none()
                    && !expected.slots.is_empty()
                    && matches!(token.kind, TokenKind::Unknown) =>
            {
                let problem = self.unknown_name(name);
                problem.note(format!("{} takes {} here", statement.word, expected.text()))
            }
            _ => forms::unknown_minor(statement, &text, token.span, &expected.words),
        }
    }

    fn broken_lead(&mut self, work: &mut Work<'_, '_>, form: &'static Form, extent: Extent) {
        let at = extent.consumed;
        let expected = Expected::at(work.statement, work.tokens, at);
        let before = at.checked_sub(1).and_then(|i| work.tokens.get(i));
        let word = work.statement.word;
        let Some(token) = work.tokens.get(at) else {
            let span = before.filter(|t| t.word().is_some()).map_or(work.word, |t| t.span);
            let problem = self.missing(work.statement, form, span, &expected);
            self.fail(work, problem);
            return;
        };
        if token.is_poison() {
            work.failed = true;
            return;
        }
        let problem = match (&token.kind, before) {
            (TokenKind::Word(w), _) if !work.statement.has_minor_word(w) => {
                self.unknown_argument(work.statement, token, &expected)
            }
            (TokenKind::Word(_), Some(before)) if before.word().is_some() && !expected.slots.is_empty() => {
                self.missing(work.statement, form, before.span, &expected)
                    .label(token.span, format!("{} stands here instead", token.describe()))
            }
            _ => {
                let message = format!("{word} takes {} here, not {}", expected.text(), token.describe());
                self.wrong_kind(message, token)
            }
        };
        self.fail(work, problem);
    }

    fn missing(&self, statement: &Statement, form: &Form, span: Span, expected: &Expected) -> Diagnostic {
        let problem = Diagnostic::new(
            &codes::MISSING_VALUE,
            span,
            format!("{} wants {} here", statement.word, expected.text()),
        )
        .at("nothing follows");
        if form.help.is_empty() || statement.example.is_empty() {
            problem
        } else {
            problem.help(format!("for example `{}`", statement.example))
        }
    }

    /// «Something else belongs here», with the place where the thing was declared.
    fn wrong_kind(&self, message: String, token: &Token<'_>) -> Diagnostic {
        let problem = Diagnostic::new(&codes::WRONG_KIND, token.span, message);
        match token.name.and_then(|n| self.scope.get(&n.upper())) {
            Some(binding) => problem.label(binding.declared, "declared here"),
            None => problem,
        }
    }

    fn lead(&mut self, work: &mut Work<'_, '_>, form: &'static Form) {
        let mut i = 0;
        for item in form.lead {
            match item {
                Item::Word(name, choices) => {
                    if let Some(token) = work.tokens.get(i) {
                        let word =
                            choices.iter().find(|c| token.word() == Some(c.word)).map_or("", |c| c.word);
                        work.found.push(Found { name, span: token.span, typed: Typed::Word(word) });
                    }
                    i += 1;
                }
                Item::Value(slot) | Item::Optional(slot) => {
                    if let Some(token) = work.tokens.get(i).filter(|t| t.fits(slot.kind)) {
                        self.accept(work, None, slot, token);
                        i += 1;
                    }
                }
                Item::Repeat(slot, _, max) => {
                    let rest = work.tokens.get(i..).unwrap_or(&[]);
                    for token in rest.iter().take(*max).take_while(|t| t.fits(slot.kind)) {
                        self.accept(work, None, slot, token);
                        i += 1;
                    }
                }
            }
        }
    }

    fn options(&mut self, work: &mut Work<'_, '_>, form: &'static Form, start: usize) {
        let mut given: Vec<(&'static Choices, &'static str, Span)> = Vec::new();
        let mut i = start;
        while let Some(token) = work.tokens.get(i) {
            if let Some((option, word)) = find_option(form, token) {
                self.check_doubled(work, form, &mut given, (option, word, token.span));
                work.found.push(Found { name: option.name, span: token.span, typed: Typed::Word(word) });
                i = self.option_values(work, (option, word, token.span), i + 1);
                continue;
            }
            if let Some(slot) = unnamed_slot(form, token) {
                if work.found.iter().any(|f| f.name == slot.name) {
                    let message = format!("{} takes {} once", work.statement.word, forms::slot_text(slot));
                    self.fail(work, Diagnostic::new(&codes::TOO_MANY, token.span, message));
                }
                self.accept(work, None, slot, token);
                i += 1;
                continue;
            }
            if !token.is_poison() {
                self.stray(work, form, &mut given, i == start, token);
            }
            i += 1;
            while work.tokens.get(i).is_some_and(|t| find_option(form, t).is_none() && t.word().is_none()) {
                i += 1;
            }
        }
        self.required(work, form, &given);
    }

    fn check_doubled(
        &mut self,
        work: &mut Work<'_, '_>,
        form: &Form,
        given: &mut Vec<(&'static Choices, &'static str, Span)>,
        (option, word, span): (&'static Choices, &'static str, Span),
    ) {
        let first = given.iter().find(|(o, ..)| core::ptr::eq(*o, option)).copied();
        given.push((option, word, span));
        let Some((_, other, first)) = first.filter(|_| !form.ordered) else { return };
        self.fail(work, exclusive(word, span, Some((other, first))));
    }

    /// The values after an option's word; returns where the next option starts.
    fn option_values(
        &mut self,
        work: &mut Work<'_, '_>,
        (option, word, span): (&'static Choices, &'static str, Span),
        start: usize,
    ) -> usize {
        let mut i = start;
        let mut last = (word, span);
        for item in option.values {
            let token = work.tokens.get(i);
            match item {
                Item::Value(slot) => match token {
                    Some(token) if token.fits(slot.kind) => self.accept(work, Some(word), slot, token),
                    Some(token) if !matches!(token.kind, TokenKind::Word(_)) || slot.kind == Kind::Law => {
                        let problem = self.misfit(work.statement, Some(word), slot, token);
                        self.fail(work, problem);
                    }
                    _ => {
                        self.missing_value(work, last, slot, token);
                        return i;
                    }
                },
                Item::Optional(slot) => match token {
                    Some(token) if token.fits(slot.kind) => self.accept(work, Some(word), slot, token),
                    _ => return i,
                },
                Item::Word(name, choices) => {
                    let chosen =
                        token.and_then(|t| choices.iter().find(|c| t.word() == Some(c.word)).map(|c| (t, c)));
                    let Some((token, choice)) = chosen else {
                        let words: Vec<&str> = choices.iter().map(|c| c.word).collect();
                        return self.missing_word(work, last, &words, i);
                    };
                    work.found.push(Found { name, span: token.span, typed: Typed::Word(choice.word) });
                    last = (choice.word, token.span);
                }
                Item::Repeat(..) => {}
            }
            i += 1;
        }
        i
    }

    fn missing_value(
        &mut self,
        work: &mut Work<'_, '_>,
        (word, span): (&str, Span),
        slot: &Slot,
        token: Option<&Token<'_>>,
    ) {
        let mut problem = Diagnostic::new(
            &codes::MISSING_VALUE,
            span,
            format!("{word} of {} wants {} after it", work.statement.word, forms::slot_text(slot)),
        )
        .note(format!("{word} is {}", slot.help));
        if let Some(token) = token {
            problem = problem.label(token.span, format!("{} stands here instead", token.describe()));
        }
        self.fail(work, problem);
    }

    fn missing_word(
        &mut self,
        work: &mut Work<'_, '_>,
        (word, span): (&str, Span),
        words: &[&str],
        at: usize,
    ) -> usize {
        let names: Vec<String> = words.iter().map(|w| (*w).to_owned()).collect();
        match work.tokens.get(at) {
            Some(token)
                if token.name.is_some()
                    && !token.word().is_some_and(|w| work.statement.has_minor_word(w)) =>
            {
                let problem = forms::unknown_minor(work.statement, &forms::written(token), token.span, words);
                self.fail(work, problem);
                at + 1
            }
            _ => {
                let problem = Diagnostic::new(
                    &codes::MISSING_VALUE,
                    span,
                    format!("{word} of {} wants {} after it", work.statement.word, forms::list(&names, "or")),
                );
                self.fail(work, problem);
                at
            }
        }
    }

    /// An argument that is no option where only options may follow.
    fn stray(
        &mut self,
        work: &mut Work<'_, '_>,
        form: &'static Form,
        given: &mut Vec<(&'static Choices, &'static str, Span)>,
        after_lead: bool,
        token: &Token<'_>,
    ) {
        let word = work.statement.word;
        let optional = form.lead.iter().find_map(|i| match i {
            Item::Optional(slot) if after_lead => Some(slot),
            _ => None,
        });
        let options: Vec<&str> = form.options.iter().flat_map(|o| o.words).map(|c| c.word).collect();
        let problem = match &token.kind {
            TokenKind::Word(w) if alternative(work, form, w).is_some() => {
                let first = alternative(work, form, w);
                exclusive(w, token.span, first)
            }
            TokenKind::Word(w) if work.statement.has_minor_word(w) => {
                let what = if form.help.is_empty() { form.name } else { form.help };
                let problem = Diagnostic::new(
                    &codes::UNKNOWN_MINOR,
                    token.span,
                    format!("{w} does not go with this form of {word} ({what})"),
                );
                if options.is_empty() {
                    problem
                } else {
                    problem.note(format!("its words are {}", options.join(", ")))
                }
            }
            TokenKind::Word(_) | TokenKind::Unknown => {
                let text = forms::written(token);
                if let Some(near) = did_you_mean(&text, options.iter().copied())
                    && let Some(option) = form.options.iter().find(|o| o.words.iter().any(|c| c.word == near))
                {
                    given.push((option, near, token.span));
                }
                forms::unknown_minor(work.statement, &text, token.span, &options)
            }
            TokenKind::Binding(name, _) => binding_problem(work.statement, name, &options, given, form),
            TokenKind::Value(_) => match optional {
                Some(slot) if !token.fits(slot.kind) && count_values(work) < lead_values(form) => {
                    self.misfit(work.statement, None, slot, token)
                }
                _ => Diagnostic::new(
                    &codes::TOO_MANY,
                    token.span,
                    format!("{word} has all its values; {} is too many here", token.describe()),
                ),
            },
        };
        self.fail(work, problem);
    }

    fn required(
        &mut self,
        work: &mut Work<'_, '_>,
        form: &'static Form,
        given: &[(&'static Choices, &'static str, Span)],
    ) {
        for option in form.options {
            if !option.required || given.iter().any(|(o, ..)| core::ptr::eq(*o, option)) {
                continue;
            }
            let Some(choice) = option.words.first() else { continue };
            let problem = Diagnostic::new(
                &codes::MISSING_VALUE,
                work.word,
                format!("{} needs {}: {}", work.statement.word, choice.word, choice.help),
            )
            .help(format!("for example `{}`", work.statement.example));
            self.fail(work, problem);
        }
    }

    /// Checks a value against its slot and keeps it.
    fn accept(
        &mut self,
        work: &mut Work<'_, '_>,
        word: Option<&str>,
        slot: &'static Slot,
        token: &Token<'_>,
    ) {
        if token.is_poison() {
            return;
        }
        match self.typed(work.statement, word, slot, token) {
            Ok(typed) => work.found.push(Found { name: slot.name, span: token.span, typed }),
            Err(problem) => self.fail(work, *problem),
        }
    }

    fn typed(
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
            (Value::Vector(v), Kind::Point) => match v.land(Dim::LENGTH, self.unit()) {
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
            },
            (Value::Vector(v), Kind::Vector) => Ok(Typed::Vector(*v)),
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
    fn misfit(
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

/// The word of the lead that excludes `word`, with its place.
fn alternative(work: &Work<'_, '_>, form: &'static Form, word: &str) -> Option<(&'static str, Span)> {
    let item = form.lead.iter().find_map(|item| match item {
        Item::Word(name, choices) if choices.iter().any(|c| c.word == word) => Some(*name),
        _ => None,
    })?;
    work.found.iter().find_map(|f| match f.typed {
        Typed::Word(given) if f.name == item => Some((given, f.span)),
        _ => None,
    })
}

/// Two words of which a statement takes one, or one word twice.
fn exclusive(word: &str, span: Span, first: Option<(&'static str, Span)>) -> Diagnostic {
    let (other, at) = first.unwrap_or(("", span));
    if other == word {
        Diagnostic::new(&codes::DOUBLED_WORD, span, format!("{word} is given twice")).label(at, "first here")
    } else {
        Diagnostic::new(&codes::WORDS_EXCLUDE, span, format!("{word} and {other} exclude each other"))
            .label(at, format!("{other} is given here"))
    }
}

/// `HEIGHT = 12` among the options.
fn binding_problem(
    statement: &Statement,
    name: &Name,
    options: &[&'static str],
    given: &mut Vec<(&'static Choices, &'static str, Span)>,
    form: &'static Form,
) -> Diagnostic {
    let upper = name.upper();
    let near = did_you_mean(&upper, options.iter().copied());
    let option = form.options.iter().find(|o| o.words.iter().any(|c| Some(c.word) == near));
    let (Some(near), Some(option)) = (near, option) else {
        return forms::unknown_minor(statement, &name.text, name.span, options);
    };
    given.push((option, near, name.span));
    let message = format!("the words of {} take their values after a comma, not after `=`", statement.word);
    Diagnostic::new(&codes::UNKNOWN_MINOR, name.span, message).help(format!("write `{near}, …`"))
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

fn find_option(form: &'static Form, token: &Token<'_>) -> Option<(&'static Choices, &'static str)> {
    let word = token.word()?;
    form.options.iter().find_map(|o| o.words.iter().find(|c| c.word == word).map(|c| (o, c.word)))
}

/// The slot of an option that needs no word.
fn unnamed_slot(form: &'static Form, token: &Token<'_>) -> Option<&'static Slot> {
    form.options.iter().filter(|o| o.words.is_empty()).flat_map(|o| o.values).find_map(|item| match item {
        Item::Value(slot) => {
            let value = matches!(token.kind, TokenKind::Value(_)) && !token.is_poison();
            (value && token.fits(slot.kind)).then_some(slot)
        }
        _ => None,
    })
}

/// For every argument in the lead, whether its slot takes any name.
fn name_places(form: &Form, tokens: &[Token<'_>]) -> Vec<bool> {
    let mut places = Vec::new();
    for item in form.lead {
        match item {
            Item::Word(..) => places.push(false),
            Item::Value(slot) | Item::Optional(slot) => places.push(slot.kind == Kind::Name),
            Item::Repeat(slot, ..) => {
                let rest = tokens.get(places.len()..).unwrap_or(&[]);
                let count = rest.iter().take_while(|t| t.fits(slot.kind)).count();
                places.extend(core::iter::repeat_n(slot.kind == Kind::Name, count));
            }
        }
    }
    places
}

fn lead_values(form: &Form) -> usize {
    form.lead.iter().filter(|i| !matches!(i, Item::Word(..))).count()
}

fn count_values(work: &Work<'_, '_>) -> usize {
    work.found.iter().filter(|f| !matches!(f.typed, Typed::Word(_))).count()
}
