//! Cuts a file into logical statements. It knows no more of the words than which of them start statements.
//!
//! A statement ends at the end of its line or at `;`. The line goes on behind `$`, behind a trailing `,` `/` `=`
//! and inside open parentheses. Comments are set aside. What is wrong at this level (characters that the
//! language does not know, open strings and parentheses, a continuation without a next line) is reported here,
//! and the statement is marked as broken, so that it is not complained about twice.
//!
//! Text words (`PARTNO`, `PPRINT` …) take the rest of their line literally, `;`, quotes and a single `$`
//! included; only `$$` ends the text, as everywhere.

use super::limits;
use super::slips;
use crate::diag::codes::syntax as codes;
use crate::diag::{Diagnostic, Sink};
use crate::source::{FileId, Span};
use crate::vocab;

/// The words that take the rest of the line as text.
pub const TEXT_WORDS: [&str; 5] = ["PARTNO", "REMARK", "PPRINT", "INSERT", "TITLES"];

/// A piece of the file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Logical {
    /// First byte.
    pub start: usize,
    /// One past the last mark.
    pub end: usize,
    /// What it is.
    pub kind: LogicalKind,
    /// Bytes of the marks (`,` `/` `=`) at which a line ended and the statement went on.
    pub joints: Vec<usize>,
}

/// Kinds of piece.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LogicalKind {
    /// For the grammar.
    Statement,
    /// A text word and its text, as byte ranges.
    Text {
        /// The word.
        word: (usize, usize),
        /// The text, without the blanks or slash before it and the blanks behind it.
        text: (usize, usize),
    },
    /// Its mistakes have been reported.
    Broken,
}

/// A file in pieces.
#[derive(Debug, Default)]
pub struct Split {
    /// The statements in order.
    pub statements: Vec<Logical>,
    /// The `$$` comments in order.
    pub comments: Vec<Span>,
}

/// Cuts `text` into logical statements.
pub fn split(file: FileId, text: &str, sink: &mut Sink) -> Split {
    let mut splitter =
        Splitter { file, text, bytes: text.as_bytes(), at: 0, line: (1, 0), out: Split::default(), sink };
    if text.starts_with('\u{feff}') {
        splitter.at = '\u{feff}'.len_utf8();
    }
    while splitter.skip_to_statement() {
        let statement = splitter.statement();
        splitter.out.statements.push(statement);
        if splitter.sink.items().len() >= limits::ERRORS {
            break;
        }
    }
    splitter.out
}

struct Splitter<'a> {
    file: FileId,
    text: &'a str,
    bytes: &'a [u8],
    at: usize,
    /// Start and end of the stretch that [`Splitter::line_end`] searched last; empty at first.
    line: (usize, usize),
    out: Split,
    sink: &'a mut Sink,
}

/// The statement being scanned.
struct Scan {
    start: usize,
    /// One past the last mark.
    end: usize,
    /// Open parentheses, up to the depth limit.
    open: Vec<usize>,
    joints: Vec<usize>,
    /// Mistakes found in it.
    mistakes: usize,
    /// Characters that close what a reported stray character opened.
    closers: &'static [char],
    /// The `$` that nothing has followed yet.
    dollar: Option<usize>,
}

impl Scan {
    fn finish(self) -> Logical {
        let kind = if self.mistakes > 0 { LogicalKind::Broken } else { LogicalKind::Statement };
        Logical { start: self.start, end: self.end, kind, joints: self.joints }
    }
}

/// What to do after a mark.
enum Next {
    GoOn,
    End,
}

impl Splitter<'_> {
    fn peek(&self, ahead: usize) -> Option<u8> {
        self.bytes.get(self.at + ahead).copied()
    }

    fn span(&self, start: usize, end: usize) -> Span {
        Span::new(self.file, start, end)
    }

    /// Goes to the first mark of the next statement; false at the end of the file.
    fn skip_to_statement(&mut self) -> bool {
        loop {
            match self.peek(0) {
                None => return false,
                Some(b' ' | b'\t' | b'\n' | b';') => self.at += 1,
                Some(b'\r') if self.peek(1) == Some(b'\n') => self.at += 2,
                Some(b'$') if self.peek(1) == Some(b'$') => self.comment(),
                // The end mark of old DOS files.
                Some(0x1a) if self.at + 1 == self.bytes.len() => return false,
                Some(_) => return true,
            }
        }
    }

    /// Byte of the end of the line that holds `from` (its line feed, or the end of the file).
    fn line_end(&mut self, from: usize) -> usize {
        // Remembered, or a long line full of strings would be searched to its end again and again.
        if !(self.line.0..=self.line.1).contains(&from) {
            let rest = self.bytes.get(from..).unwrap_or(&[]);
            let end = rest.iter().position(|&b| b == b'\n').map_or(self.bytes.len(), |i| from + i);
            self.line = (from, end);
        }
        self.line.1
    }

    /// Takes a `$$` comment up to the end of the line; its control characters are mistakes too.
    fn comment(&mut self) {
        let end = self.line_end(self.at);
        let trimmed = trim_end(self.bytes, self.at, end);
        self.out.comments.push(self.span(self.at, trimmed));
        self.control_characters(self.at, trimmed);
        self.at = end;
    }

    /// Reports the first control character of a stretch of comment or text.
    fn control_characters(&mut self, start: usize, end: usize) -> bool {
        let slice = self.bytes.get(start..end).unwrap_or(&[]);
        let bad = slice.iter().position(|&b| is_control(b));
        if let Some(i) = bad {
            self.report_control(start + i);
        }
        bad.is_some()
    }

    fn report_control(&mut self, at: usize) {
        let byte = self.bytes.get(at).copied().unwrap_or(0);
        self.sink.push(
            Diagnostic::new(
                &codes::CONTROL_CHARACTER,
                self.span(at, at + 1),
                format!("control character {byte:#04x} ({}) in the source", slips::control_name(byte)),
            )
            .help("delete it; only tabs and line ends may stand beside the visible characters"),
        );
    }

    fn statement(&mut self) -> Logical {
        if let Some(text) = self.text_statement() {
            return text;
        }
        let mut scan = Scan {
            start: self.at,
            end: self.at,
            open: Vec::new(),
            joints: Vec::new(),
            mistakes: 0,
            closers: &[],
            dollar: None,
        };
        while let Next::GoOn = self.mark(&mut scan) {}
        self.check_length(&mut scan);
        scan.finish()
    }

    /// Takes one mark of a statement.
    fn mark(&mut self, scan: &mut Scan) -> Next {
        let Some(byte) = self.peek(0) else { return self.end_of_file(scan) };
        match byte {
            b' ' | b'\t' => self.at += 1,
            b'\r' if self.peek(1) == Some(b'\n') => self.at += 1,
            b'\n' => return self.end_of_line(scan),
            b';' => {
                self.missing_close(scan, self.at);
                return Next::End;
            }
            b'$' if self.peek(1) == Some(b'$') => self.comment(),
            b'$' => self.continuation(scan),
            b'\'' | b'"' => self.string(scan, byte),
            b'(' => self.open(scan),
            b')' => {
                scan.open.pop();
                self.take(scan, 1);
            }
            b if is_mark(b) => self.take(scan, 1),
            _ => self.stray(scan),
        }
        Next::GoOn
    }

    fn take(&mut self, scan: &mut Scan, bytes: usize) {
        self.at += bytes;
        scan.end = self.at;
        scan.dollar = None;
    }

    fn open(&mut self, scan: &mut Scan) {
        if scan.open.len() == limits::DEPTH {
            if scan.mistakes == 0 {
                self.sink.push(limits::too_deep(self.span(self.at, self.at + 1)));
            }
            scan.mistakes += 1;
        } else {
            scan.open.push(self.at);
        }
        self.take(scan, 1);
    }

    fn string(&mut self, scan: &mut Scan, quote: u8) {
        let start = self.at;
        let line_end = self.line_end(start);
        let body = self.bytes.get(start + 1..line_end).unwrap_or(&[]);
        if let Some(i) = body.iter().position(|&b| b == quote) {
            let end = start + i + 2;
            if self.control_characters(start, end) {
                scan.mistakes += 1;
            }
            self.take(scan, end - start);
            return;
        }
        let end = trim_end(self.bytes, start, line_end);
        let quote = char::from(quote);
        self.sink.push(
            Diagnostic::new(
                &codes::UNTERMINATED_STRING,
                self.span(start, end),
                format!("this string is not closed by `{quote}` before the end of the line"),
            )
            .help(format!("close it with `{quote}`; a string cannot go over the end of a line")),
        );
        scan.mistakes += 1;
        scan.open.clear();
        self.take(scan, end - start);
    }

    /// `$`: the statement goes on in the next line.
    fn continuation(&mut self, scan: &mut Scan) {
        let start = self.at;
        let end = self.line_end(start);
        let text_end = trim_end(self.bytes, start, end);
        let rest = self.text.get(start + 1..text_end).unwrap_or("").trim_start();
        if let Some(at) = rest.find("$$").filter(|&i| i == 0) {
            let comment = text_end - rest.len() + at;
            self.out.comments.push(self.span(comment, text_end));
        } else if !rest.is_empty() {
            let from = text_end - rest.len();
            self.sink.push(
                Diagnostic::new(
                    &codes::TEXT_AFTER_CONTINUATION,
                    self.span(from, text_end),
                    "the text behind `$` is taken as a comment, and the statement goes on in the next line",
                )
                .help("write `$$` before a comment, and nothing behind `$`"),
            );
        }
        self.control_characters(start, text_end);
        scan.dollar = Some(start);
        self.at = (end + 1).min(self.bytes.len());
    }

    fn stray(&mut self, scan: &mut Scan) {
        let at = self.at;
        let rest = self.text.get(at..).unwrap_or("");
        let Some(first) = rest.chars().next() else {
            self.at += 1;
            return;
        };
        let run: usize = rest.chars().take_while(|&c| c == first).map(char::len_utf8).sum();
        if scan.closers.contains(&first) {
            scan.closers = &[];
            return self.take(scan, run);
        }
        scan.closers = slips::closers(first);
        if scan.mistakes < limits::STRAY_PER_STATEMENT {
            if u8::try_from(first).is_ok_and(is_control) {
                self.report_control(at);
            } else {
                self.sink.push(slips::stray(first, self.span(at, at + run)));
            }
        }
        scan.mistakes += 1;
        self.take(scan, run);
    }

    fn end_of_file(&mut self, scan: &mut Scan) -> Next {
        let last = self.last(scan);
        let (mark, place) = match scan.dollar {
            Some(dollar) => ("`$`", self.span(dollar, dollar + 1)),
            None => match last {
                Some(b',') => ("a comma", self.span(scan.end - 1, scan.end)),
                Some(b'/') => ("`/`", self.span(scan.end - 1, scan.end)),
                Some(b'=') => ("`=`", self.span(scan.end - 1, scan.end)),
                _ => {
                    self.missing_close(scan, scan.end);
                    return Next::End;
                }
            },
        };
        if scan.mistakes == 0 {
            self.sink.push(
                Diagnostic::new(
                    &codes::DANGLING_CONTINUATION,
                    place,
                    format!("{mark} at the end of the line says that the statement goes on, but the file ends here"),
                )
                .help("finish the statement, or delete the mark"),
            );
        }
        scan.mistakes += 1;
        Next::End
    }

    /// The last mark of the statement so far.
    fn last(&self, scan: &Scan) -> Option<u8> {
        (scan.end > scan.start).then(|| self.bytes.get(scan.end - 1).copied()).flatten()
    }

    fn end_of_line(&mut self, scan: &mut Scan) -> Next {
        let last = self.last(scan);
        let joint = matches!(last, Some(b',' | b'/' | b'='));
        if scan.mistakes > 0 && scan.open.is_empty() && !joint {
            return Next::End;
        }
        if !joint && scan.open.is_empty() {
            return if scan.end == scan.start { self.skip_line() } else { Next::End };
        }
        self.skip_lines();
        let next = self.bytes.get(self.at..).unwrap_or(&[]);
        if !joint && last.is_some_and(ends_operand) && starts_operand(next) {
            self.missing_close(scan, scan.end);
            return Next::End;
        }
        if joint && starts_statement(next, last == Some(b'/')) {
            self.unfinished(scan, last);
            return Next::End;
        }
        if joint {
            scan.joints.push(scan.end - 1);
        }
        Next::GoOn
    }

    /// The line promised more, and a new statement follows. A slash with nothing behind it is fine: `RAPID/`,
    /// `M1 = MACRO/`.
    fn unfinished(&mut self, scan: &mut Scan, last: Option<u8>) {
        if !scan.open.is_empty() {
            self.missing_close(scan, scan.end);
        } else if last != Some(b'/') {
            if scan.mistakes == 0 {
                let next = self.span(self.at, word_end(self.bytes, self.at));
                self.sink.push(slips::unfinished_line(self.span(scan.end - 1, scan.end), next));
            }
            scan.mistakes += 1;
        }
    }

    /// A line that held nothing but `$`.
    fn skip_line(&mut self) -> Next {
        self.at += 1;
        Next::GoOn
    }

    /// Goes over line ends, blanks and comments inside a statement.
    fn skip_lines(&mut self) {
        loop {
            match self.peek(0) {
                Some(b' ' | b'\t' | b'\n') => self.at += 1,
                Some(b'\r') if self.peek(1) == Some(b'\n') => self.at += 2,
                Some(b'$') if self.peek(1) == Some(b'$') => self.comment(),
                _ => return,
            }
        }
    }

    /// Reports an open parenthesis that is not closed at `end`, where the statement ends.
    fn missing_close(&mut self, scan: &mut Scan, end: usize) {
        let Some(&open) = scan.open.last() else { return };
        if scan.mistakes == 0 {
            let end = trim_end(self.bytes, scan.start, end.min(scan.end));
            self.sink.push(
                Diagnostic::new(&codes::UNBALANCED, self.span(end, end), "expected `)`")
                    .at("a `)` is missing here")
                    .label(self.span(open, open + 1), "to close this parenthesis"),
            );
        }
        scan.mistakes += 1;
    }

    fn check_length(&mut self, scan: &mut Scan) {
        if scan.end - scan.start <= limits::STATEMENT_BYTES {
            return;
        }
        if scan.mistakes == 0 {
            self.sink.push(limits::too_long(self.span(scan.start, scan.start + 1), scan.end - scan.start));
        }
        scan.mistakes += 1;
    }

    /// `PARTNO …` and its like, also behind a jump label (which is a mistake).
    fn text_statement(&mut self) -> Option<Logical> {
        let start = self.at;
        let word_end = word_end(self.bytes, start);
        if let Some(inner) = self.labelled_text_word(start, word_end) {
            return Some(self.labelled_text(start, inner));
        }
        let (word, glued) = text_word(self.bytes.get(start..word_end)?)?;
        if glued && !self.is_glued_text(word_end) {
            return None;
        }
        Some(self.text_piece(start, start, start + word.len()))
    }

    /// A text word that has run into its text: `INSERTG0G90`. Names of one's own may start like that, so
    /// what follows must not make it a variable.
    fn is_glued_text(&self, word_end: usize) -> bool {
        let rest = self.bytes.get(word_end..).unwrap_or(&[]);
        !matches!(rest.iter().find(|b| !matches!(b, b' ' | b'\t')), Some(b'=' | b'(' | b'/' | b')' | b','))
    }

    /// Where the text word starts in `LA1) PPRINT …`.
    fn labelled_text_word(&self, start: usize, end: usize) -> Option<usize> {
        let close = skip_blanks(self.bytes, end);
        if end == start || self.bytes.get(close) != Some(&b')') {
            return None;
        }
        let inner = skip_blanks(self.bytes, close + 1);
        let word = self.bytes.get(inner..word_end(self.bytes, inner))?;
        text_word(word).filter(|&(_, glued)| !glued).map(|_| inner)
    }

    fn labelled_text(&mut self, start: usize, inner: usize) -> Logical {
        let word = self.text.get(inner..inner + TEXT_WORDS[0].len()).unwrap_or("").to_ascii_uppercase();
        let label_end = word_end(self.bytes, start);
        self.sink.push(
            Diagnostic::new(
                &codes::LABEL_BEFORE_TEXT,
                self.span(start, skip_blanks(self.bytes, label_end) + 1),
                format!("a label cannot stand before {word}, whose line is text"),
            )
            .help("give the label to the next statement"),
        );
        let mut piece = self.text_piece(start, inner, inner + TEXT_WORDS[0].len());
        piece.kind = LogicalKind::Broken;
        piece
    }

    fn text_piece(&mut self, start: usize, word_start: usize, word_end: usize) -> Logical {
        let line_end = self.line_end(word_end);
        let line = self.text.get(word_end..line_end).unwrap_or("");
        let code_end = line.find("$$").map_or(line_end, |i| word_end + i);
        let mut from = skip_blanks(self.bytes, word_end).min(code_end);
        if from < code_end && self.bytes.get(from) == Some(&b'/') {
            from = skip_blanks(self.bytes, from + 1).min(code_end);
        }
        let to = trim_end(self.bytes, from, code_end);
        let bad = self.control_characters(from, to);
        self.at = code_end;
        let kind = if bad {
            LogicalKind::Broken
        } else {
            LogicalKind::Text { word: (word_start, word_end), text: (from, to) }
        };
        let end = if to > from { to } else { word_end };
        Logical { start, end, kind, joints: Vec::new() }
    }
}

/// The text word that `word` is or starts with, and whether more follows without a blank.
fn text_word(word: &[u8]) -> Option<(&'static str, bool)> {
    TEXT_WORDS.into_iter().find_map(|w| {
        let head = word.get(..w.len())?;
        head.eq_ignore_ascii_case(w.as_bytes()).then_some((w, word.len() > w.len()))
    })
}

fn word_end(bytes: &[u8], start: usize) -> usize {
    let rest = bytes.get(start..).unwrap_or(&[]);
    start + rest.iter().position(|&b| !is_word(b)).unwrap_or(rest.len())
}

fn skip_blanks(bytes: &[u8], start: usize) -> usize {
    let rest = bytes.get(start..).unwrap_or(&[]);
    start + rest.iter().position(|b| !matches!(b, b' ' | b'\t')).unwrap_or(rest.len())
}

fn trim_end(bytes: &[u8], start: usize, end: usize) -> usize {
    let slice = bytes.get(start..end).unwrap_or(&[]);
    start + slice.iter().rposition(|b| !matches!(b, b' ' | b'\t' | b'\r' | b'\n')).map_or(0, |i| i + 1)
}

fn is_word(b: u8) -> bool {
    b.is_ascii_alphanumeric() || b == b'_'
}

fn is_mark(b: u8) -> bool {
    is_word(b) || b".+-*/=,<>".contains(&b)
}

fn is_control(b: u8) -> bool {
    (b < 0x20 && b != b'\t' && b != b'\n') || b == 0x7f
}

fn ends_operand(b: u8) -> bool {
    is_word(b) || matches!(b, b')' | b'\'' | b'"')
}

/// Whether a line surely starts a statement: `WORD/ …` or `name = WORD/ …` with a word that starts statements, or
/// such a word alone where that counts (`alone`).
fn starts_statement(next: &[u8], alone: bool) -> bool {
    let head_end = word_end(next, 0);
    let word = |start: usize, end: usize| {
        let word = next.get(start..end).and_then(|w| core::str::from_utf8(w).ok()).unwrap_or("");
        vocab::is_statement_word(word)
            || super::failure::STRUCTURAL.iter().any(|s| s.eq_ignore_ascii_case(word))
    };
    let after = skip_blanks(next, head_end);
    match next.get(after..).unwrap_or(&[]) {
        [b'/', ..] => word(0, head_end),
        [] | [b'\n' | b';', ..] | [b'\r', b'\n', ..] | [b'$', b'$', ..] => alone && word(0, head_end),
        [b'=', rest @ ..] if rest.first() != Some(&b'=') && head_end > 0 => {
            let start = skip_blanks(next, after + 1);
            let end = word_end(next, start);
            next.get(skip_blanks(next, end)) == Some(&b'/') && word(start, end)
        }
        _ => false,
    }
}

/// Whether a line starts with something that cannot follow an operand.
fn starts_operand(next: &[u8]) -> bool {
    match next.first() {
        Some(b'\'' | b'"') => true,
        Some(&b) if is_word(b) => {
            let word = next.get(..word_end(next, 0)).unwrap_or(&[]);
            !word.eq_ignore_ascii_case(b"AND") && !word.eq_ignore_ascii_case(b"OR")
        }
        _ => false,
    }
}
