//! What is said about arguments that do not fit the vocabulary.

use crate::diag::codes::semantics as codes;
use crate::diag::{Diagnostic, did_you_mean};
use crate::source::Span;
use crate::syntax::ast::Name;
use crate::vocab::{Form, Item, Kind, Slot, Statement};

use super::Analyser;
use super::arguments::{Given, Work};
use super::forms::{self, Expected, Extent};
use super::matched::Typed;
use super::tokens::{Token, TokenKind};

impl Analyser<'_> {
    pub(super) fn no_arguments(&mut self, work: &mut Work<'_, '_>) {
        if let Some(first) = work.tokens.first() {
            let problem = Diagnostic::new(
                &codes::TOO_MANY,
                first.span,
                format!("{} takes no values", work.statement.word),
            );
            self.fail(work, problem);
        }
    }

    /// «Unknown word» or «unknown name», whichever is nearer to what is written.
    pub(super) fn unknown_argument(
        &self,
        statement: &Statement,
        token: &Token<'_>,
        expected: &Expected,
    ) -> Diagnostic {
        let text = forms::written(token);
        let near_word = did_you_mean(&text, expected.words.iter().copied());
        let near_option = did_you_mean(&text, expected.options.iter().copied());
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
            Some(_) if near_word.is_none() && near_option.is_some() => {
                forms::unknown_minor(statement, &text, token.span, &expected.options)
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

    pub(super) fn broken_lead(&mut self, work: &mut Work<'_, '_>, form: &'static Form, extent: Extent) {
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
        if work.tokens.iter().take(at + 1).any(Token::is_poison) {
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
    pub(super) fn wrong_kind(&self, message: String, token: &Token<'_>) -> Diagnostic {
        let problem = Diagnostic::new(&codes::WRONG_KIND, token.span, message);
        match token.name.and_then(|n| self.scope.get(&n.upper())) {
            Some(binding) => problem.label(binding.declared, "declared here"),
            None => problem,
        }
    }

    pub(super) fn missing_value(
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

    pub(super) fn missing_word(
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
    pub(super) fn stray(
        &mut self,
        work: &mut Work<'_, '_>,
        form: &'static Form,
        given: &mut Vec<Given>,
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

    pub(super) fn required(&mut self, work: &mut Work<'_, '_>, form: &'static Form, given: &[Given]) {
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
pub(super) fn exclusive(word: &str, span: Span, first: Option<(&'static str, Span)>) -> Diagnostic {
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
    given: &mut Vec<Given>,
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

fn lead_values(form: &Form) -> usize {
    form.lead.iter().filter(|i| !matches!(i, Item::Word(..))).count()
}

fn count_values(work: &Work<'_, '_>) -> usize {
    work.found.iter().filter(|f| !matches!(f.typed, Typed::Word(_))).count()
}
