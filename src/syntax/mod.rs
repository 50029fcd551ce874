//! Source text to [`ast`]: statement splitter, pest grammar, Pratt parser.
//!
//! [`parse`] cuts the file into logical statements and gives each one alone to the grammar in
//! `grammar/partwright.pest`, so every mistake of a file comes out of one run, at its own place. Time is linear
//! in the text, memory bounded by the limits in `limits.rs`.

use pest::Parser;
use rayon::prelude::*;

pub mod ast;
mod card;
mod failure;
mod grammar;
mod limits;
pub mod print;
mod slips;
mod split;
#[cfg(test)]
mod tests;
mod tree;
mod words;

use crate::diag::{Diagnostic, Sink};
use crate::source::{FileId, Span};
use ast::{Name, Program, Statement, StatementKind};
use grammar::{Grammar, Rule};
use split::{Logical, LogicalKind};

/// Parses one file. What is wrong goes to `sink`, in source order; a statement that could not be parsed is
/// [`StatementKind::Bad`] in the tree.
pub fn parse(file: FileId, text: &str, sink: &mut Sink) -> Program {
    limits::guard_grammar();
    let mut mistakes = Sink::default();
    let split = split::split(file, text, &mut mistakes);
    let mut mistakes = mistakes.into_items();
    let mut statements = Vec::with_capacity(split.statements.len());
    // Batches bound the work that is lost when a file is refused after too many mistakes.
    for batch in split.statements.chunks(limits::BATCH) {
        if mistakes.len() >= limits::ERRORS {
            break;
        }
        for (parsed, found) in parse_batch(file, text, batch) {
            statements.push(parsed);
            mistakes.extend(found);
        }
    }
    report(mistakes, sink);
    Program { file, statements, comments: split.comments }
}

/// Parses a file of which, with `card_columns`, what stands behind column 72 is no part of the program.
pub fn parse_columns(file: FileId, text: &str, card_columns: bool, sink: &mut Sink) -> Program {
    if card_columns { parse(file, &card::blank_card_columns(text), sink) } else { parse(file, text, sink) }
}

/// Statements with their mistakes, in order; in parallel when there are enough of them.
fn parse_batch(file: FileId, text: &str, batch: &[Logical]) -> Vec<(Statement, Vec<Diagnostic>)> {
    let one = |piece: &Logical| {
        let mut mistakes = Vec::new();
        let parsed = statement(file, text, piece, &mut mistakes);
        (parsed, mistakes)
    };
    if batch.len() < limits::BATCH {
        batch.iter().map(one).collect()
    } else {
        batch.par_iter().map(one).collect()
    }
}

fn report(mut mistakes: Vec<Diagnostic>, sink: &mut Sink) {
    mistakes.sort_by_key(|d| d.primary.as_ref().map_or(0, |p| p.span.start));
    let many = mistakes.len() >= limits::ERRORS;
    mistakes.truncate(limits::ERRORS);
    if let Some(last) = mistakes.last_mut().filter(|_| many) {
        last.notes.push(format!("the rest of the file was not read after {} mistakes", limits::ERRORS));
    }
    mistakes.into_iter().for_each(|d| sink.push(d));
}

fn statement(file: FileId, text: &str, piece: &Logical, mistakes: &mut Vec<Diagnostic>) -> Statement {
    let span = Span::new(file, piece.start, piece.end);
    let kind = match piece.kind {
        LogicalKind::Statement => return parse_piece(file, text, piece, mistakes),
        LogicalKind::Text { word, text: range } => StatementKind::Text {
            word: Name { text: slice(text, word).to_owned(), span: Span::new(file, word.0, word.1) },
            text: slice(text, range).to_owned(),
            text_span: Span::new(file, range.0, range.1),
        },
        LogicalKind::Broken => StatementKind::Bad {
            declares: failure::declared(file, piece.start, slice(text, (piece.start, piece.end))),
        },
    };
    Statement { span, jump_label: None, kind }
}

fn slice(text: &str, range: (usize, usize)) -> &str {
    text.get(range.0..range.1).unwrap_or("")
}

fn parse_piece(file: FileId, text: &str, piece: &Logical, mistakes: &mut Vec<Diagnostic>) -> Statement {
    let span = Span::new(file, piece.start, piece.end);
    let source = slice(text, (piece.start, piece.end));
    match Grammar::parse(Rule::statement, source) {
        Ok(mut pairs) => {
            let mut builder = tree::Builder {
                file,
                offset: piece.start,
                joints: &piece.joints,
                mistakes: Vec::new(),
                operators: limits::OPERATORS,
            };
            let inner = pairs.next().map(pest::iterators::Pair::into_inner);
            let statement = match inner {
                Some(inner) => builder.statement(span, inner),
                None => Statement { span, jump_label: None, kind: StatementKind::Bad { declares: None } },
            };
            mistakes.append(&mut builder.mistakes);
            statement
        }
        Err(error) => {
            let place = failure::Place { file, offset: piece.start, text: source, joints: &piece.joints };
            mistakes.push(failure::explain(&place, &error));
            let declares = failure::declared(file, piece.start, source);
            Statement { span, jump_label: None, kind: StatementKind::Bad { declares } }
        }
    }
}
