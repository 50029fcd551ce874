//! One record by the grammar.

use pest::Parser as _;
use pest::iterators::Pair;
use pest_derive::Parser;

/// The generated parser.
#[derive(Parser)]
#[grammar = "../grammar/cl.pest"]
struct Grammar;

/// A record: its major words and its arguments.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Statement {
    /// Major words, upper case; more than one where they are chained.
    pub majors: Vec<String>,
    /// Byte range of the first major word in the record's text.
    pub word: (usize, usize),
    /// Arguments.
    pub args: Vec<Arg>,
}

/// An argument.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Arg {
    /// Nothing between two commas.
    Empty,
    /// A number.
    Number(f64),
    /// Anything else, upper case.
    Word(String),
    /// A definition in parentheses.
    Nested(Box<Statement>),
}

/// Why a text is no record: the byte where it stops being one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NoRecord(pub usize);

/// Nested parentheses at most.
const DEEPEST: usize = 20;

/// Reads one record.
pub(super) fn parse(text: &str) -> Result<Statement, NoRecord> {
    let mut depth = 0_usize;
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'(' => depth += 1,
            b')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > DEEPEST {
            return Err(NoRecord(at));
        }
    }
    let mut pairs = Grammar::parse(Rule::record, text).map_err(|error| {
        NoRecord(match error.location {
            pest::error::InputLocation::Pos(at) | pest::error::InputLocation::Span((at, _)) => at,
        })
    })?;
    let statement = pairs
        .next()
        .and_then(|record| record.into_inner().find(|p| p.as_rule() == Rule::statement))
        .ok_or(NoRecord(0))?;
    Ok(build(statement))
}

fn build(pair: Pair<'_, Rule>) -> Statement {
    let mut statement = Statement { majors: Vec::new(), word: (0, 0), args: Vec::new() };
    for part in pair.into_inner() {
        match part.as_rule() {
            Rule::majors => {
                let span = part.as_span();
                statement.word = (span.start(), span.end());
                statement.majors = part.into_inner().map(|m| word(m.as_str())).collect();
            }
            Rule::args => part.into_inner().for_each(|arg| add(arg, &mut statement.args)),
            _ => {}
        }
    }
    // An argument list of one empty argument is none: `RAPID/`.
    if statement.args == [Arg::Empty] {
        statement.args.clear();
    }
    statement
}

/// Blanks before the number of a card in columns 73 to 80, at least: nobody leaves so many between the numbers of a record.
const CARD_GAP: usize = 5;
/// Figures of a whole number there.
const CARD_FIGURES: usize = 8;

/// Adds what stands between two commas; numbers with nothing but blanks between them are several: some systems leave commas
/// out.
fn add(pair: Pair<'_, Rule>, args: &mut Vec<Arg>) {
    match several(pair.as_str().trim()) {
        Some(numbers) => args.extend(numbers),
        None => args.push(argument(pair)),
    }
}

/// Numbers with blanks between them, if that is what a text is, and the last is no number of a card.
fn several(text: &str) -> Option<Vec<Arg>> {
    let (before, last) = text.rsplit_once(char::is_whitespace)?;
    let gap = before.len() - before.trim_end().len();
    let figures = last.bytes().all(|b| b.is_ascii_digit());
    if figures && (gap >= CARD_GAP || last.len() == CARD_FIGURES && last.starts_with('0')) {
        return None;
    }
    text.split_whitespace().map(|part| super::scan::number(part).map(Arg::Number)).collect()
}

fn argument(pair: Pair<'_, Rule>) -> Arg {
    let Some(inner) = pair.into_inner().next() else { return Arg::Empty };
    if inner.as_rule() == Rule::nested {
        return inner.into_inner().next().map_or(Arg::Empty, |s| Arg::Nested(Box::new(build(s))));
    }
    let text = inner.as_str().trim();
    match super::scan::number(text) {
        Some(value) => Arg::Number(value),
        None if text.is_empty() => Arg::Empty,
        None => Arg::Word(word(text)),
    }
}

/// Upper case, runs of blanks as one.
fn word(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").to_uppercase()
}

impl Statement {
    /// The first major word.
    pub fn major(&self) -> &str {
        self.majors.first().map_or("", String::as_str)
    }
    /// The numbers among the arguments, in order.
    pub fn numbers(&self) -> Vec<f64> {
        self.args.iter().filter_map(|a| if let Arg::Number(v) = a { Some(*v) } else { None }).collect()
    }
    /// The words among the arguments, in order.
    pub fn words(&self) -> impl Iterator<Item = &str> {
        self.args.iter().filter_map(|a| if let Arg::Word(w) = a { Some(w.as_str()) } else { None })
    }
    /// Whether one of the words is this.
    pub fn has(&self, wanted: &str) -> bool {
        self.words().any(|w| w == wanted)
    }
    /// The number after a word.
    pub fn after(&self, wanted: &str) -> Option<f64> {
        self.args.windows(2).find_map(|w| match w {
            [Arg::Word(word), Arg::Number(value)] if word == wanted => Some(*value),
            _ => None,
        })
    }
    /// Nested definitions, in order.
    pub fn nested(&self) -> impl Iterator<Item = &Statement> {
        self.args.iter().filter_map(|a| if let Arg::Nested(s) = a { Some(&**s) } else { None })
    }
    /// Whether nothing but numbers stands in the arguments.
    pub fn only_numbers(&self) -> bool {
        self.args.iter().all(|a| matches!(a, Arg::Number(_) | Arg::Empty))
    }
}
