//! Which form of a statement its arguments mean, and what is wrong when they mean none.

use crate::diag::codes::semantics as codes;
use crate::diag::{Diagnostic, did_you_mean};
use crate::source::Span;
use crate::vocab::{Form, Item, Kind, Range, Slot, Statement};

use super::arithmetic::article;
use super::tokens::{Token, TokenKind};

/// How far the arguments follow a form's lead.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Extent {
    /// Arguments that fit.
    pub consumed: usize,
    /// The whole lead is there.
    pub complete: bool,
}

/// Follows the lead of `form` as far as the arguments go.
pub(super) fn extent(form: &Form, tokens: &[Token<'_>]) -> Extent {
    let mut i = 0;
    for item in form.lead {
        let token = tokens.get(i);
        match item {
            Item::Word(_, choices) => {
                let fits = token.and_then(Token::word).is_some_and(|w| choices.iter().any(|c| c.word == w));
                if !fits {
                    return Extent { consumed: i, complete: false };
                }
                i += 1;
            }
            Item::Value(slot) => {
                if !token.is_some_and(|t| t.fits(slot.kind)) {
                    return Extent { consumed: i, complete: false };
                }
                i += 1;
            }
            Item::Optional(slot) => {
                if !token.is_some_and(|t| t.fits(slot.kind)) {
                    break;
                }
                i += 1;
            }
            Item::Repeat(slot, min, max) => {
                let count = tokens[i..].iter().take(*max).take_while(|t| t.fits(slot.kind)).count();
                i += count;
                if count < *min {
                    return Extent { consumed: i, complete: false };
                }
            }
        }
    }
    Extent { consumed: i, complete: true }
}

/// The form that the arguments follow furthest, the first option counted; of equals, the first.
pub(super) fn choose(statement: &'static Statement, tokens: &[Token<'_>]) -> Option<(&'static Form, Extent)> {
    let mut best: Option<(Extent, &'static Form, Extent)> = None;
    for form in statement.forms {
        let found = extent(form, tokens);
        let option = found.complete
            && tokens
                .get(found.consumed)
                .and_then(Token::word)
                .is_some_and(|word| form.options.iter().any(|o| o.words.iter().any(|c| c.word == word)));
        let reach = Extent { consumed: found.consumed + usize::from(option), ..found };
        if best.is_none_or(|(r, ..)| reach > r) {
            best = Some((reach, form, found));
        }
    }
    best.map(|(_, form, found)| (form, found))
}

/// What may stand at argument `at`, over all forms that the arguments follow up to there.
#[derive(Debug, Default)]
pub(super) struct Expected {
    /// Words.
    pub words: Vec<&'static str>,
    /// Values.
    pub slots: Vec<&'static Slot>,
    /// Words of options, where the lead may end.
    pub options: Vec<&'static str>,
}

impl Expected {
    /// Collects it.
    pub fn at(statement: &'static Statement, tokens: &[Token<'_>], at: usize) -> Expected {
        let mut expected = Expected::default();
        for form in statement.forms {
            if extent(form, tokens).consumed < at {
                continue;
            }
            let item = item_at(form, tokens, at);
            if matches!(item, None | Some(Item::Optional(_))) {
                expected.options.extend(form.options.iter().flat_map(|o| o.words).map(|c| c.word));
            }
            match item {
                Some(Item::Word(_, choices)) => expected.words.extend(choices.iter().map(|c| c.word)),
                Some(Item::Value(slot) | Item::Optional(slot) | Item::Repeat(slot, ..)) => {
                    expected.slots.push(slot)
                }
                None => {}
            }
        }
        expected.words.sort_unstable();
        expected.words.dedup();
        expected.slots.dedup_by_key(|s| (s.name, describe(s.kind)));
        expected
    }
    /// «BASE, FOLLOW or a length».
    pub fn text(&self) -> String {
        let mut parts: Vec<String> = self.words.iter().map(|w| (*w).to_owned()).collect();
        for slot in &self.slots {
            let text = slot_text(slot);
            if !parts.contains(&text) {
                parts.push(text);
            }
        }
        list(&parts, "or")
    }
}

fn item_at(form: &'static Form, tokens: &[Token<'_>], at: usize) -> Option<&'static Item> {
    let mut i = 0;
    for item in form.lead {
        let count = match item {
            Item::Repeat(slot, _, max) => {
                tokens.get(i..).unwrap_or(&[]).iter().take(*max).take_while(|t| t.fits(slot.kind)).count()
            }
            _ => 1,
        };
        if at < i + count || (at == i + count && matches!(item, Item::Repeat(_, min, _) if count < *min)) {
            return Some(item);
        }
        i += count;
    }
    None
}

/// «`x` (a length)», or the kind alone where the name says the same.
pub(super) fn slot_text(slot: &Slot) -> String {
    let kind = describe(slot.kind);
    if kind.ends_with(slot.name) { kind } else { format!("{} ({kind})", slot.name) }
}

/// What a slot takes, with its article.
pub(super) fn describe(kind: Kind) -> String {
    match kind {
        Kind::Number(dim, _) => article(dim),
        Kind::Any => "a number".into(),
        Kind::Feed => "a feed".into(),
        Kind::Lift => "a lift".into(),
        Kind::LiftRate(1) => "a lift per degree".into(),
        Kind::LiftRate(n) => format!("a lift per degree^{n}"),
        Kind::Count(..) => "a whole number".into(),
        Kind::Point => "a point".into(),
        Kind::Vector => "a vector".into(),
        Kind::Entity(kinds) => {
            let names: Vec<String> = kinds.iter().map(|k| k.name().to_owned()).collect();
            list(&names, "or")
        }
        Kind::Declared(kind) => kind.name().into(),
        Kind::PointOrPattern => "a point or a pattern".into(),
        Kind::Contour => "a cam, a curve or a chain of curves".into(),
        Kind::Text => "a text in quotes".into(),
        Kind::Law => "a motion law".into(),
        Kind::Name => "a name".into(),
        Kind::Binding => "`NAME = value`".into(),
    }
}

/// «must be greater than 0».
pub(super) fn range_text(range: Range, show: impl Fn(f64) -> String) -> String {
    match range {
        Range::Any => "may be anything".into(),
        Range::Positive => "must be greater than 0".into(),
        Range::NotNegative => "must not be negative".into(),
        Range::Within(a, b) => format!("must lie from {} to {}", show(a), show(b)),
        Range::Between(a, b) => format!("must lie between {} and {}", show(a), show(b)),
    }
}

/// Whether a value lies in a range.
pub(super) fn in_range(range: Range, value: f64) -> bool {
    match range {
        Range::Any => true,
        Range::Positive => value > 0.0,
        Range::NotNegative => value >= 0.0,
        Range::Within(a, b) => (a..=b).contains(&value),
        Range::Between(a, b) => a < value && value < b,
    }
}

/// «a, b or c».
pub(super) fn list(parts: &[String], last: &str) -> String {
    match parts {
        [] => String::new(),
        [only] => only.clone(),
        [rest @ .., end] => format!("{} {last} {end}", rest.join(", ")),
    }
}

/// «Unknown word» in a statement.
pub(super) fn unknown_minor(statement: &Statement, word: &str, span: Span, allowed: &[&str]) -> Diagnostic {
    let problem =
        Diagnostic::new(&codes::UNKNOWN_MINOR, span, format!("{} has no word {word} here", statement.word));
    match did_you_mean(word, allowed.iter().copied()) {
        Some(near) => problem.help(format!("did you mean `{near}`?")),
        None if allowed.is_empty() => problem,
        None => {
            let words: Vec<String> = allowed.iter().map(|w| (*w).to_owned()).collect();
            problem.note(format!("possible here: {}", list(&words, "or")))
        }
    }
}

/// The text of an unknown or misplaced word.
pub(super) fn written(token: &Token<'_>) -> String {
    match (&token.kind, token.name) {
        (_, Some(name)) => name.text.clone(),
        (TokenKind::Word(word), None) => word.clone(),
        _ => String::new(),
    }
}
