//! What to say about a statement that the grammar refuses.

use pest::Parser;
use pest::error::{Error, ErrorVariant, InputLocation};

use super::ast::Name;
use super::grammar::{Grammar, Rule};
use super::slips;
use super::words::{Expected, expected, list};
use crate::diag::Diagnostic;
use crate::diag::codes::syntax as codes;
use crate::source::{FileId, Span};
use crate::vocab;

/// A statement in its file.
pub(super) struct Place<'a> {
    pub(super) file: FileId,
    /// Byte of the statement's first character in the file.
    pub(super) offset: usize,
    /// The statement.
    pub(super) text: &'a str,
    /// Bytes in the file at which a line ended in `,` `/` `=` inside the statement.
    pub(super) joints: &'a [usize],
}

impl Place<'_> {
    fn span(&self, start: usize, end: usize) -> Span {
        Span::new(self.file, self.offset + start, self.offset + end)
    }
}

/// The message for a statement that did not parse.
pub(super) fn explain(place: &Place<'_>, error: &Error<Rule>) -> Diagnostic {
    let at = match error.location {
        InputLocation::Pos(at) | InputLocation::Span((at, _)) => at.min(place.text.len()),
    };
    let expected = expectations(error);
    let found = Found::at(place.text, at);
    let slip = unfinished_line(place, at, &found)
        .or_else(|| two_words(place, at))
        .or_else(|| bad_number(place, at))
        .or_else(|| missing_slash(place, at))
        .or_else(|| operator_slip(place, at, &expected))
        .or_else(|| assignment_in_condition(place, at, &found))
        .or_else(|| doubled_comma(place, at, &found, &expected))
        .or_else(|| parenthesis(place, at, &found, &expected))
        .or_else(|| missing_value(place, at, &found, &expected));
    slip.unwrap_or_else(|| plain(place, at, &found, &expected))
}

fn expectations(error: &Error<Rule>) -> Vec<Expected> {
    let mut list: Vec<Expected> = match &error.variant {
        ErrorVariant::ParsingError { positives, .. } => {
            positives.iter().filter_map(|&r| expected(r)).collect()
        }
        ErrorVariant::CustomError { .. } => Vec::new(),
    };
    list.sort_unstable();
    list.dedup();
    list
}

/// The mark at which the grammar stopped.
struct Found<'a> {
    text: &'a str,
}

impl<'a> Found<'a> {
    fn at(text: &'a str, at: usize) -> Self {
        let rest = text.get(at..).unwrap_or("");
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let length = match rest.chars().next() {
            None => 0,
            Some(c) if is_word(c) => rest.find(|c| !is_word(c)).unwrap_or(rest.len()),
            Some(c @ ('\'' | '"')) => rest.get(1..).and_then(|r| r.find(c)).map_or(rest.len(), |i| i + 2),
            Some(c) => c.len_utf8(),
        };
        Found { text: rest.get(..length).unwrap_or("") }
    }

    fn is_end(&self) -> bool {
        self.text.is_empty()
    }

    fn starts_value(&self) -> bool {
        self.text.starts_with(|c: char| c.is_ascii_alphanumeric() || matches!(c, '\'' | '"' | '(' | '.'))
    }

    fn words(&self) -> String {
        if self.is_end() { "the end of the statement".to_owned() } else { format!("`{}`", self.text) }
    }
}

/// The word before byte `at`, and where it starts.
fn word_before(text: &str, at: usize) -> Option<(usize, &str)> {
    let head = text.get(..at)?.trim_end_matches([' ', '\t']);
    let start = head.rfind(|c: char| !c.is_ascii_alphanumeric() && c != '_').map_or(0, |i| i + 1);
    let word = head.get(start..)?;
    word.starts_with(|c: char| c.is_ascii_alphabetic()).then_some((start, word))
}

/// A line that ends in a comma, and the next statement behind it.
fn unfinished_line(place: &Place<'_>, at: usize, found: &Found<'_>) -> Option<Diagnostic> {
    let joint = *place.joints.iter().rfind(|&&j| j < place.offset + at)?;
    let after = place.text.get(joint + 1 - place.offset..at)?;
    let (start, word) = word_before(place.text, at).filter(|&(s, _)| place.offset + s > joint)?;
    let only_word = after.trim_end().ends_with(word) && !after.contains(',');
    let starts_statement = matches!(found.text, "=" | "/") || vocab::is_statement_word(word);
    let next = place.span(start, start + word.len());
    (only_word && starts_statement)
        .then(|| slips::unfinished_line(Span::new(place.file, joint, joint + 1), next))
}

/// `GO TO/ 1, 2`: a word with a blank in it.
fn two_words(place: &Place<'_>, at: usize) -> Option<Diagnostic> {
    let pairs = Grammar::parse(Rule::compat_two_words, place.text).ok()?;
    let words: Vec<_> = pairs.flatten().filter(|p| p.as_rule() == Rule::compat_word).collect();
    let [first, second] = words.as_slice() else { return None };
    let joined = format!("{}{}", first.as_str(), second.as_str()).to_ascii_uppercase();
    let known = vocab::is_statement_word(&joined) || STRUCTURAL.contains(&joined.as_str());
    let (start, end) = (first.as_span().start(), second.as_span().end());
    if !known || at > end {
        return None;
    }
    let rest = place.text.get(end..).unwrap_or("").trim_start().trim_start_matches('/').trim_start();
    let rest = rest.lines().next().unwrap_or("");
    let shown = if rest.is_empty() { joined } else { format!("{joined}/ {rest}") };
    Some(
        Diagnostic::new(
            &codes::BLANK_IN_WORD,
            place.span(start, end),
            format!("`{} {}` are two words here: a blank ends a word", first.as_str(), second.as_str()),
        )
        .help(format!("write `{shown}`")),
    )
}

/// The structural words.
pub(super) const STRUCTURAL: [&str; 16] = [
    "IF", "ELSEIF", "ELSE", "ENDIF", "DO", "ENDDO", "WHILE", "ENDWHILE", "UNTIL", "ENDUNTIL", "MACRO",
    "TERMAC", "CALL", "LOOPST", "LOOPND", "JUMPTO",
];

/// `1.2.3`, and letters O in a number.
fn bad_number(place: &Place<'_>, at: usize) -> Option<Diagnostic> {
    let (start, end) = slips::number_like(place.text, at);
    let written = place.text.get(start..end)?;
    if let Some(meant) = slips::letter_o(written) {
        let message = format!("`{written}` has the letter O where the digit 0 is meant");
        return Some(
            Diagnostic::new(&codes::BAD_NUMBER, place.span(start, end), message)
                .help(format!("write `{meant}`")),
        );
    }
    let points = written.matches('.').count();
    let digits = written.starts_with(|c: char| c.is_ascii_digit() || c == '.')
        && written.bytes().all(|b| b.is_ascii_digit() || b == b'.')
        && written.len() > points;
    (digits && points > 1 && at > start).then(|| {
        let message = format!("`{written}` is not a number: it has {points} decimal points");
        Diagnostic::new(&codes::BAD_NUMBER, place.span(start, end), message)
            .help("write one decimal point, or a comma between two numbers")
    })
}

/// `GOTO 1, 2, 3` and `P1 = POINT, 1, 2`.
fn missing_slash(place: &Place<'_>, at: usize) -> Option<Diagnostic> {
    let pairs = Grammar::parse(Rule::compat_no_slash, place.text).ok()?;
    let mut parts = pairs.flatten();
    let major = parts.by_ref().find(|p| p.as_rule() == Rule::compat_major)?;
    let operand = parts.find(|p| p.as_rule() == Rule::compat_operand)?;
    let end = major.as_span().end();
    let operand = operand.as_span().start();
    let comma = place.text.get(end..operand).unwrap_or("").contains(',');
    // `GOTO(1, 2)` reads as a subscripted name up to its end.
    let group = place.text.get(operand..).is_some_and(|t| t.starts_with('(')) && end == operand;
    if at < end || (at > operand && !group) || (comma && !vocab::is_statement_word(major.as_str())) {
        return None;
    }
    let glued = end == operand;
    // `R + 1 = 6` adds; it lacks no slash.
    let sign = place.text.get(operand..).is_some_and(|t| t.starts_with(['+', '-']));
    if sign && !vocab::is_statement_word(major.as_str()) {
        return None;
    }
    if glued && !vocab::is_statement_word(major.as_str()) {
        return None;
    }
    let word = major.as_str();
    let rest = place.text.get(operand..).unwrap_or("").lines().next().unwrap_or("").trim_end();
    let head = place.text.get(..end).unwrap_or("").lines().last().unwrap_or("");
    Some(
        Diagnostic::new(
            &codes::MISSING_SLASH,
            place.span(operand, operand + Found::at(place.text, operand).text.len()),
            format!("expected `/` between {word} and its arguments"),
        )
        .label(place.span(major.as_span().start(), end), "")
        .help(format!("write `{head}/ {rest}`")),
    )
}

/// `IF/ A = 3`.
fn assignment_in_condition(place: &Place<'_>, at: usize, found: &Found<'_>) -> Option<Diagnostic> {
    let first = place.text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').next()?;
    let condition = ["IF", "ELSEIF", "WHILE", "UNTIL"].iter().any(|w| first.eq_ignore_ascii_case(w));
    (condition && found.text == "=" && at > first.len()).then(|| {
        Diagnostic::new(
            &codes::ASSIGNMENT_IN_CONDITION,
            place.span(at, at + 1),
            "`=` gives a value to a name; it does not compare",
        )
        .help("two values are compared with `==` (or `.EQ.`)")
    })
}

/// `=<`, `=>`, `><`, `.EQ` and the like.
fn operator_slip(place: &Place<'_>, at: usize, expected: &[Expected]) -> Option<Diagnostic> {
    const SLIPS: [(&str, &str); 9] = [
        ("=<", "<="),
        ("=>", ">="),
        ("><", "<>"),
        (".EQ", "=="),
        (".NE", "<>"),
        (".LE", "<="),
        (".GE", ">="),
        (".LT", "<"),
        (".GT", ">"),
    ];
    if expected.iter().all(|e| matches!(e, Expected::Name | Expected::Statement)) {
        return None;
    }
    let near = |written: &str, back: usize| {
        let start = at.checked_sub(back)?;
        let here = place.text.get(start..start + written.len())?;
        here.eq_ignore_ascii_case(written).then_some(start)
    };
    SLIPS.iter().find_map(|&(written, meant)| {
        let back = if written.starts_with('.') {
            place.text.get(..at)?.len() - place.text.get(..at)?.trim_end().len() + 3
        } else {
            0
        };
        let start = near(written, back).or_else(|| if back == 0 { near(written, 1) } else { None })?;
        Some(
            Diagnostic::new(
                &codes::UNEXPECTED,
                place.span(start, start + written.len()),
                format!(
                    "`{}` is not an operator",
                    place.text.get(start..start + written.len()).unwrap_or(written)
                ),
            )
            .help(format!("write `{meant}`")),
        )
    })
}

/// Two commas in a row, or a comma at the end.
fn doubled_comma(
    place: &Place<'_>,
    at: usize,
    found: &Found<'_>,
    expected: &[Expected],
) -> Option<Diagnostic> {
    let value = expected.contains(&Expected::Value);
    let before = place.text.get(..at)?.trim_end();
    (value && found.text == "," && before.ends_with([',', '/', '('])).then(|| {
        Diagnostic::new(&codes::DOUBLED_COMMA, place.span(at, at + 1), "expected a value before this comma")
            .help("delete the comma, or write the value that is missing")
    })
}

/// A `)` that is missing or too many.
fn parenthesis(place: &Place<'_>, at: usize, found: &Found<'_>, expected: &[Expected]) -> Option<Diagnostic> {
    let head = place.text.get(..at)?;
    if found.text == ")" && head.matches('(').count() <= head.matches(')').count() {
        return Some(
            Diagnostic::new(&codes::UNBALANCED, place.span(at, at + 1), "this `)` closes nothing")
                .help("delete it, or open its parenthesis"),
        );
    }
    (found.is_end() && expected.contains(&Expected::Close))
        .then(|| Diagnostic::new(&codes::UNBALANCED, place.span(at, at), "expected `)`"))
}

/// An operator or a comma with nothing behind it.
fn missing_value(
    place: &Place<'_>,
    at: usize,
    found: &Found<'_>,
    expected: &[Expected],
) -> Option<Diagnostic> {
    if !expected.contains(&Expected::Value) || found.starts_value() {
        return None;
    }
    let before = place.text.get(..at)?.trim_end();
    let mark = before.chars().last()?;
    if !",/=(+-*<>.".contains(mark) {
        return None;
    }
    let end = at + found.text.len();
    let message = format!("expected a value after `{mark}`, found {}", found.words());
    Some(Diagnostic::new(&codes::MISSING_VALUE, place.span(at, end), message))
}

fn plain(place: &Place<'_>, at: usize, found: &Found<'_>, expected: &[Expected]) -> Diagnostic {
    let span = place.span(at, at + found.text.len());
    if expected.contains(&Expected::Comma) && found.starts_value() {
        return Diagnostic::new(&codes::UNEXPECTED, span, "expected a comma")
            .at(format!("before {}", found.words()));
    }
    if expected.contains(&Expected::Statement) {
        return Diagnostic::new(
            &codes::UNEXPECTED,
            span,
            format!("a statement cannot start with {}", found.words()),
        )
        .help("a statement starts with a word, as in `GOTO/ 1, 2`, or with a name and `=`");
    }
    let wanted: Vec<Expected> = expected.iter().copied().filter(|e| *e != Expected::Open).collect();
    let wanted = if wanted.is_empty() { expected.to_vec() } else { wanted };
    Diagnostic::new(&codes::UNEXPECTED, span, format!("expected {}, found {}", list(&wanted), found.words()))
}

/// The name that a broken statement would have declared: `name = …`.
pub(super) fn declared(file: FileId, offset: usize, text: &str) -> Option<Name> {
    let head: &str = text.get(..text.find('=')?)?;
    let name = head.split('(').next()?.rsplit(')').next()?;
    let start = head.find(name)?;
    let start = start + (name.len() - name.trim_start().len());
    let name = name.trim();
    let valid = name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    valid.then(|| Name {
        text: name.to_owned(),
        span: Span::new(file, offset + start, offset + start + name.len()),
    })
}
