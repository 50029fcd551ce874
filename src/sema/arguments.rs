//! Arguments matched against the vocabulary: a statement's tokens become typed values.

use crate::diag::Diagnostic;
use crate::diag::codes::semantics as codes;
use crate::source::Span;
use crate::syntax::ast::Command;
use crate::vocab::{Choices, Form, Item, Kind, Slot, Statement};

use super::Analyser;
use super::forms::{self, Expected, Extent};
use super::matched::{Found, Matched, Typed};
use super::misfits::exclusive;
use super::tokens::{Token, TokenKind};

/// An option that has been given: its row, the word it was given by, where.
pub(super) type Given = (&'static Choices, &'static str, Span);

/// The arguments of a statement while they are matched.
pub(super) struct Work<'t, 'c> {
    pub(super) statement: &'static Statement,
    /// The major word.
    pub(super) word: Span,
    pub(super) tokens: &'t [Token<'c>],
    pub(super) found: Vec<Found>,
    pub(super) failed: bool,
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

    pub(super) fn fail(&mut self, work: &mut Work<'_, '_>, problem: Diagnostic) {
        work.failed = true;
        self.report(problem);
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
        let mut given: Vec<Given> = Vec::new();
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
        given: &mut Vec<Given>,
        (option, word, span): Given,
    ) {
        let first = given.iter().find(|(o, ..)| core::ptr::eq(*o, option)).copied();
        given.push((option, word, span));
        let Some((_, other, first)) = first.filter(|_| !form.ordered) else { return };
        self.fail(work, exclusive(word, span, Some((other, first))));
    }

    /// The values after an option's word; returns where the next option starts.
    fn option_values(&mut self, work: &mut Work<'_, '_>, (option, word, span): Given, start: usize) -> usize {
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
                        let later = |t: &Token<'_>| {
                            option.values.iter().any(|v| matches!(v, Item::Value(s) if t.fits(s.kind)))
                        };
                        if token.is_some_and(later) {
                            continue;
                        }
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
                Item::Repeat(slot, min, max) => {
                    let rest = work.tokens.get(i..).unwrap_or(&[]);
                    let count = rest.iter().take(*max).take_while(|t| t.fits(slot.kind)).count();
                    for token in rest.iter().take(count) {
                        self.accept(work, Some(word), slot, token);
                    }
                    i += count;
                    if count < *min {
                        let tokens = work.tokens;
                        self.missing_value(work, last, slot, tokens.get(i));
                        return i;
                    }
                    continue;
                }
            }
            i += 1;
        }
        i
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
}

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
