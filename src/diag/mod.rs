//! Diagnostics: one type for every message of every stage, one catalogue of
//! codes, one renderer.
//!
//! A stage pushes [`Diagnostic`]s into a [`Sink`] and goes on as far as it can,
//! so that all errors of a file come out of one run. A code is a constant of
//! [`codes`]; its page for `partwright explain` lies in `docs/diagnostics/`.

pub mod cam;
pub mod codes;
mod excerpt;
pub mod render;

use crate::source::Span;

/// How bad it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// For information; never changes the exit status.
    Note,
    /// Suspicious; exit 0 unless denied.
    Warning,
    /// The program is wrong; nothing is written.
    Error,
}

/// A stable diagnostic code with its page.
#[derive(Debug, PartialEq, Eq)]
pub struct Code {
    /// `E0412`, `W0401`, `N0601`: letter by default severity, then four digits by area.
    pub id: &'static str,
    /// One line for listings.
    pub title: &'static str,
    /// The page that `explain` prints (Markdown, see `docs/diagnostics/README.md`).
    pub page: &'static str,
}

impl Code {
    /// Severity by the letter.
    #[must_use]
    pub fn severity(&self) -> Severity {
        match self.id.as_bytes().first() {
            Some(b'W') => Severity::Warning,
            Some(b'N') => Severity::Note,
            _ => Severity::Error,
        }
    }
}

/// Characters of the longest number that messages print with all its digits.
const LONGEST_NUMBER: usize = 24;

/// A message whose numbers of very many digits have an exponent: nobody counts the 301 digits of 1e300.
fn short_numbers(message: String) -> String {
    let in_number = |c: char| c.is_ascii_digit() || c == '.';
    if !message.split(|c| !in_number(c)).any(|number| number.len() > LONGEST_NUMBER) {
        return message;
    }
    let mut out = String::with_capacity(message.len());
    let mut rest = message.as_str();
    while let Some(at) = rest.find(in_number) {
        let (before, number) = rest.split_at(at);
        let (number, after) = number.split_at(number.find(|c| !in_number(c)).unwrap_or(number.len()));
        out.push_str(before);
        match number.parse::<f64>() {
            Ok(value) if number.len() > LONGEST_NUMBER && value.is_finite() => {
                out.push_str(&format!("{value:e}"))
            }
            _ => out.push_str(number),
        }
        rest = after;
    }
    out + rest
}

/// A place with a remark.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    /// Where.
    pub span: Span,
    /// What is there; may be empty.
    pub message: String,
}

/// One message to the user.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// The stable code.
    pub code: &'static Code,
    /// Severity; normally the code's own.
    pub severity: Severity,
    /// One sentence in the user's terms, with the numbers.
    pub message: String,
    /// The place the message is about; `None` for trouble that has no place in a source file.
    pub primary: Option<Label>,
    /// Other places involved: the definition, the call, the other operand.
    pub labels: Vec<Label>,
    /// Further facts, one sentence each.
    pub notes: Vec<String>,
    /// What to do about it.
    pub help: Vec<String>,
}

impl Diagnostic {
    /// A message of `code` at `span`.
    #[must_use]
    pub fn new(code: &'static Code, span: Span, message: impl Into<String>) -> Self {
        Diagnostic {
            code,
            severity: code.severity(),
            message: short_numbers(message.into()),
            primary: Some(Label { span, message: String::new() }),
            labels: Vec::new(),
            notes: Vec::new(),
            help: Vec::new(),
        }
    }
    /// A message without a place in a source file.
    #[must_use]
    pub fn global(code: &'static Code, message: impl Into<String>) -> Self {
        Diagnostic {
            code,
            severity: code.severity(),
            message: short_numbers(message.into()),
            primary: None,
            labels: Vec::new(),
            notes: Vec::new(),
            help: Vec::new(),
        }
    }
    /// Sets the remark shown at the primary place.
    #[must_use]
    pub fn at(mut self, remark: impl Into<String>) -> Self {
        if let Some(primary) = &mut self.primary {
            primary.message = remark.into();
        }
        self
    }
    /// Adds another place.
    #[must_use]
    pub fn label(mut self, span: Span, remark: impl Into<String>) -> Self {
        self.labels.push(Label { span, message: remark.into() });
        self
    }
    /// Adds a fact.
    #[must_use]
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(short_numbers(note.into()));
        self
    }
    /// Adds another message of the same cause, where it says something else.
    pub fn also(&mut self, message: String) {
        if message != self.message && !self.notes.contains(&message) {
            self.notes.push(message);
        }
    }
    /// Adds advice.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help.push(help.into());
        self
    }
}

/// Collects diagnostics.
#[derive(Debug, Clone, Default)]
pub struct Sink {
    items: Vec<Diagnostic>,
}

impl Sink {
    /// Adds a message.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.items.push(diagnostic);
    }
    /// Adds all messages of another sink.
    pub fn append(&mut self, other: Sink) {
        self.items.extend(other.items);
    }
    /// Whether an error is among them.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        self.items.iter().any(|d| d.severity == Severity::Error)
    }
    /// All messages in the order they came.
    #[must_use]
    pub fn items(&self) -> &[Diagnostic] {
        &self.items
    }
    /// Gives the messages away.
    #[must_use]
    pub fn into_items(self) -> Vec<Diagnostic> {
        self.items
    }
}

/// The candidate nearest to `word` by edit distance (case-blind), if near enough to be a slip.
#[must_use]
pub fn did_you_mean<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word = word.to_uppercase();
    let limit = (word.chars().count() / 3).max(1) + usize::from(word.chars().count() > 4);
    candidates
        .into_iter()
        .map(|c| (edit_distance(&word, &c.to_uppercase()), c))
        // Of a word of two letters, one wrong letter is half the word.
        .filter(|&(d, c)| d <= limit && 2 * d < word.chars().count().max(c.chars().count()))
        .min_by_key(|&(d, c)| (d, c.len()))
        .map(|(_, c)| c)
}

/// Optimal string alignment distance: insert, delete, replace, swap neighbours.
fn edit_distance(a: &str, b: &str) -> usize {
    let a: Vec<char> = a.chars().collect();
    let b: Vec<char> = b.chars().collect();
    let mut rows = vec![vec![0usize; b.len() + 1]; a.len() + 1];
    for (i, row) in rows.iter_mut().enumerate() {
        row[0] = i;
    }
    for (j, cell) in rows[0].iter_mut().enumerate() {
        *cell = j;
    }
    for i in 1..=a.len() {
        for j in 1..=b.len() {
            let cost = usize::from(a[i - 1] != b[j - 1]);
            let mut best = (rows[i - 1][j] + 1).min(rows[i][j - 1] + 1).min(rows[i - 1][j - 1] + cost);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                best = best.min(rows[i - 2][j - 2] + 1);
            }
            rows[i][j] = best;
        }
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_very_many_digits_have_an_exponent() {
        assert_eq!(short_numbers(format!("a feed of {} mm/min.", 1e300)), "a feed of 1e300 mm/min.");
        assert_eq!(short_numbers(format!("Ä {:.3}", -2.5e40)), "Ä -2.5e40");
        assert_eq!(short_numbers(format!("{}, {}", 1e-40, 12.5)), "1e-40, 12.5");
        let plain = "X 12.5, version 1.2.3 … 0.1234567890123456789012 mm";
        assert_eq!(short_numbers(plain.to_owned()), plain);
    }

    #[test]
    fn nearest_word_is_offered_only_when_it_is_a_slip() {
        assert_eq!(did_you_mean("CUTTTER", ["CUTTER", "CIRCLE"]), Some("CUTTER"));
        assert_eq!(did_you_mean("SPINLD", ["SPINDL", "FEDRAT"]), Some("SPINDL"));
        assert_eq!(did_you_mean("XYZZY", ["SPINDL", "FEDRAT"]), None);
    }
}
