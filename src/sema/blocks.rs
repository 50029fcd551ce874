//! Which block ends belong to which beginnings.

use std::collections::BTreeMap;

use crate::diag::Diagnostic;
use crate::diag::codes::semantics as codes;
use crate::source::Span;
use crate::syntax::ast::{Program, Statement, StatementKind};

/// A parsed file with its blocks matched.
#[derive(Debug)]
pub struct Code {
    /// The file.
    pub program: Program,
    /// For every statement, how it is linked to the rest of its block.
    pub links: Vec<Link>,
    /// For every statement, the innermost `LOOPST` or `MACRO` it stands in.
    pub arenas: Vec<Option<usize>>,
    /// Jump labels by the arena they stand in (`None`: outside) and name, upper case.
    pub labels: BTreeMap<(Option<usize>, String), usize>,
}

/// A statement's place in its block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Link {
    /// Not part of a block's frame, or of a broken one.
    None,
    /// `IF`, `ELSEIF`, `ELSE`: the next branch (or the end), and the end.
    Branch {
        /// Next `ELSEIF`, `ELSE` or `ENDIF`.
        next: usize,
        /// `ENDIF`.
        end: usize,
    },
    /// Start of a loop or macro.
    Start {
        /// Its end.
        end: usize,
    },
    /// End of a loop or macro.
    End {
        /// Its start.
        start: usize,
    },
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Block {
    If,
    Do,
    While,
    Until,
    Macro,
    Loop,
}

impl Block {
    const fn words(self) -> (&'static str, &'static str) {
        match self {
            Block::If => ("IF", "ENDIF"),
            Block::Do => ("DO", "ENDDO"),
            Block::While => ("WHILE", "ENDWHILE"),
            Block::Until => ("UNTIL", "ENDUNTIL"),
            Block::Macro => ("MACRO", "TERMAC"),
            Block::Loop => ("LOOPST", "LOOPND"),
        }
    }
}

enum Role {
    Open(Block),
    Middle(&'static str),
    Close(Block),
    Plain,
}

fn role(statement: &Statement, text: &str) -> Role {
    match &statement.kind {
        StatementKind::If(_) => Role::Open(Block::If),
        StatementKind::ElseIf(_) => Role::Middle("ELSEIF"),
        StatementKind::Else => Role::Middle("ELSE"),
        StatementKind::EndIf => Role::Close(Block::If),
        StatementKind::Do { .. } => Role::Open(Block::Do),
        StatementKind::EndDo => Role::Close(Block::Do),
        StatementKind::While(_) => Role::Open(Block::While),
        StatementKind::EndWhile => Role::Close(Block::While),
        StatementKind::Until(_) => Role::Open(Block::Until),
        StatementKind::EndUntil => Role::Close(Block::Until),
        StatementKind::Macro { .. } => Role::Open(Block::Macro),
        StatementKind::TerMac => Role::Close(Block::Macro),
        StatementKind::LoopStart => Role::Open(Block::Loop),
        StatementKind::LoopEnd => Role::Close(Block::Loop),
        StatementKind::Command(_)
        | StatementKind::Assign { .. }
        | StatementKind::Text { .. }
        | StatementKind::ArithmeticIf { .. }
        | StatementKind::Call { .. }
        | StatementKind::JumpTo(_) => Role::Plain,
        StatementKind::Bad { .. } => lost_role(text.get(statement.span.range()).unwrap_or("")),
    }
}

/// The role that a statement was meant to have that could not be read: by its words.
fn lost_role(text: &str) -> Role {
    let text = text.to_ascii_uppercase();
    let body = text
        .split_once(')')
        .filter(|(label, _)| is_word(label.trim()))
        .map_or(text.as_str(), |(_, rest)| rest);
    let after_name =
        body.split_once('=').filter(|(name, _)| is_word(name.trim())).map(|(_, rest)| first_word(rest));
    if after_name == Some("MACRO") {
        return Role::Open(Block::Macro);
    }
    match first_word(body) {
        "IF" if !is_arithmetic(body) => Role::Open(Block::If),
        "ELSEIF" => Role::Middle("ELSEIF"),
        "ELSE" => Role::Middle("ELSE"),
        "ENDIF" => Role::Close(Block::If),
        "DO" => Role::Open(Block::Do),
        "ENDDO" => Role::Close(Block::Do),
        "WHILE" => Role::Open(Block::While),
        "ENDWHILE" => Role::Close(Block::While),
        "UNTIL" => Role::Open(Block::Until),
        "ENDUNTIL" => Role::Close(Block::Until),
        "TERMAC" => Role::Close(Block::Macro),
        "LOOPST" => Role::Open(Block::Loop),
        "LOOPND" => Role::Close(Block::Loop),
        _ => Role::Plain,
    }
}

fn is_word(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_')
}

fn first_word(text: &str) -> &str {
    let text = text.trim_start();
    let end = text.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(text.len());
    text.get(..end).unwrap_or("")
}

/// `IF (e) a, b, c`: something stands behind the closing parenthesis.
fn is_arithmetic(text: &str) -> bool {
    let opens = text.trim_start().get(2..).is_some_and(|t| t.trim_start().starts_with('('));
    opens && text.rsplit_once(')').is_some_and(|(_, rest)| !first_word(rest).is_empty())
}

struct Open {
    block: Block,
    /// The opening statement and, for `IF`, its branches.
    branches: Vec<usize>,
    has_else: bool,
}

struct Matcher<'a> {
    statements: &'a [Statement],
    text: &'a str,
    links: Vec<Link>,
    open: Vec<Open>,
    problems: Vec<Diagnostic>,
}

/// Matches the blocks of a file with this text; the second value lists what does not match.
#[must_use]
pub fn match_blocks(program: Program, text: &str) -> (Code, Vec<Diagnostic>) {
    let mut matcher = Matcher {
        statements: &program.statements,
        text,
        links: vec![Link::None; program.statements.len()],
        open: Vec::new(),
        problems: Vec::new(),
    };
    matcher.run();
    let (links, mut problems) = (matcher.links, matcher.problems);
    let arenas = arenas(&program.statements, &links);
    let labels = labels(&program.statements, &arenas, &mut problems);
    (Code { program, links, arenas, labels }, problems)
}

impl Matcher<'_> {
    fn run(&mut self) {
        for (i, statement) in self.statements.iter().enumerate() {
            match role(statement, self.text) {
                Role::Plain => {}
                Role::Open(block) => self.open.push(Open { block, branches: vec![i], has_else: false }),
                Role::Middle(word) => self.middle(i, word),
                Role::Close(block) => self.close(i, block),
            }
        }
        while let Some(open) = self.open.pop() {
            self.unclosed(&open, None);
        }
    }

    /// Whether a statement could not be read; its own message is enough.
    fn is_lost(&self, index: usize) -> bool {
        self.statements.get(index).is_some_and(|s| matches!(s.kind, StatementKind::Bad { .. }))
    }

    fn span(&self, index: usize) -> Option<Span> {
        self.statements.get(index).map(|s| s.span)
    }

    fn middle(&mut self, i: usize, word: &'static str) {
        let Some(open) = self.open.last_mut().filter(|o| o.block == Block::If) else {
            self.stray(i, word, "IF");
            return;
        };
        let first_else = open.branches.last().copied().filter(|_| open.has_else);
        open.branches.push(i);
        open.has_else |= word == "ELSE";
        if let (Some(first), Some(span)) = (first_else, self.span(i)) {
            let mut problem =
                Diagnostic::new(&codes::BLOCK, span, format!("{word} after the ELSE of the same IF"));
            if let Some(first) = self.span(first) {
                problem = problem.label(first, "the ELSE");
            }
            self.problems.push(problem);
        }
    }

    fn close(&mut self, i: usize, block: Block) {
        let Some(depth) = self.open.iter().rposition(|o| o.block == block) else {
            let (start, end) = block.words();
            self.stray(i, end, start);
            return;
        };
        while self.open.len() > depth + 1 {
            if let Some(inner) = self.open.pop() {
                self.unclosed(&inner, Some(i));
            }
        }
        let Some(open) = self.open.pop() else { return };
        self.link(&open, i);
    }

    fn link(&mut self, open: &Open, end: usize) {
        let mut set = |index: usize, link: Link| {
            if let Some(slot) = self.links.get_mut(index) {
                *slot = link;
            }
        };
        let Some(&start) = open.branches.first() else { return };
        if open.block == Block::If {
            let nexts = open.branches.iter().skip(1).copied().chain([end]);
            for (&branch, next) in open.branches.iter().zip(nexts) {
                set(branch, Link::Branch { next, end });
            }
        } else {
            set(start, Link::Start { end });
        }
        set(end, Link::End { start });
    }

    fn unclosed(&mut self, open: &Open, found: Option<usize>) {
        if open.branches.first().is_some_and(|&i| self.is_lost(i)) {
            return;
        }
        let Some(span) = open.branches.first().and_then(|&i| self.span(i)) else { return };
        let (start, end) = open.block.words();
        let mut problem = Diagnostic::new(&codes::BLOCK, span, format!("this {start} has no {end}"))
            .help(format!("write {end} where the block ends"));
        if let Some(at) = found.and_then(|i| self.span(i)) {
            problem = problem.label(at, format!("{end} must come before this"));
        }
        self.problems.push(problem);
    }

    fn stray(&mut self, i: usize, word: &str, start: &str) {
        if self.is_lost(i) {
            return;
        }
        let Some(span) = self.span(i) else { return };
        let mut problem = Diagnostic::new(&codes::BLOCK, span, format!("{word} without {start}"));
        if let Some(open) = self.open.last()
            && let Some(at) = open.branches.first().and_then(|&i| self.span(i))
        {
            let (start, end) = open.block.words();
            problem = problem.label(at, format!("this {start} is open and ends with {end}"));
        }
        self.problems.push(problem);
    }
}

/// The innermost `LOOPST` or `MACRO` of each statement.
fn arenas(statements: &[Statement], links: &[Link]) -> Vec<Option<usize>> {
    let mut stack: Vec<(usize, usize)> = Vec::new();
    let mut result = Vec::with_capacity(statements.len());
    for (i, statement) in statements.iter().enumerate() {
        while stack.last().is_some_and(|&(_, end)| i > end) {
            stack.pop();
        }
        result.push(stack.last().map(|&(start, _)| start));
        let opens = matches!(statement.kind, StatementKind::Macro { .. } | StatementKind::LoopStart);
        if let (true, Some(Link::Start { end })) = (opens, links.get(i)) {
            stack.push((i, *end));
        }
    }
    result
}

fn labels(
    statements: &[Statement],
    arenas: &[Option<usize>],
    problems: &mut Vec<Diagnostic>,
) -> BTreeMap<(Option<usize>, String), usize> {
    let mut labels = BTreeMap::new();
    for (i, statement) in statements.iter().enumerate() {
        let Some(label) = &statement.jump_label else { continue };
        let arena = arenas.get(i).copied().flatten();
        if let Some(first) = labels.insert((arena, label.upper()), i) {
            let mut problem = Diagnostic::new(
                &codes::JUMP,
                label.span,
                format!("the jump label {} stands here twice", label.text),
            );
            if let Some(first) = statements.get(first).and_then(|s| s.jump_label.as_ref()) {
                problem = problem.label(first.span, "first here");
            }
            problems.push(problem);
        }
    }
    labels
}
