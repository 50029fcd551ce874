//! The files as codespan-reporting sees them: whole, or, where a line concerned is very long or holds what would control a
//! terminal, only the lines concerned and of those only the part around the labels.

use std::collections::BTreeMap;

use codespan_reporting::files::{Error, Files};

use super::{Diagnostic, Label};
use crate::source::{SourceFile, SourceMap, Span};

/// Lines up to this many bytes are shown whole.
const LONG_LINE: usize = 400;
/// Bytes shown to the left of the first label of a long line.
const LEFT: usize = 60;
/// Bytes shown from there on.
const WINDOW: usize = 160;

/// A shown line: part of a line of the file.
struct Line {
    /// Line of the file, from 1.
    number: usize,
    /// Bytes of the file shown.
    source: core::ops::Range<usize>,
    /// Where they start in the excerpt.
    start: usize,
    /// Column of the first character shown, from 1.
    column: usize,
}

struct Clipped {
    text: String,
    lines: Vec<Line>,
}

/// The files of one diagnostic.
pub(super) struct Excerpts<'a> {
    sources: &'a SourceMap,
    clipped: BTreeMap<u32, Clipped>,
}

impl<'a> Excerpts<'a> {
    pub(super) fn of(diagnostic: &Diagnostic, sources: &'a SourceMap) -> Self {
        let mut by_file: BTreeMap<u32, Vec<&Label>> = BTreeMap::new();
        for label in diagnostic.primary.iter().chain(&diagnostic.labels) {
            by_file.entry(label.span.file.0).or_default().push(label);
        }
        let clipped = by_file.into_iter().filter_map(|(id, labels)| {
            let file = sources.file(labels.first()?.span.file);
            let lines = lines_concerned(file, &labels);
            let apart = |line: usize| {
                let range = line_range(file, line);
                range.len() > LONG_LINE || file.text.get(range).is_some_and(|t| t.contains(controls))
            };
            lines.keys().any(|&line| apart(line)).then(|| (id, clip(file, &lines)))
        });
        Excerpts { sources, clipped: clipped.collect() }
    }

    /// The bytes of a span in what is shown.
    pub(super) fn range(&self, span: Span) -> Option<core::ops::Range<usize>> {
        let bytes = snapped(&self.sources.file(span.file).text, span);
        let Some(clipped) = self.clipped.get(&span.file.0) else { return Some(bytes) };
        let start = clipped.place(bytes.start)?;
        Some(start..clipped.place(bytes.end).unwrap_or(start).max(start))
    }

    fn source_file(&self, id: u32) -> &'a SourceFile {
        self.sources.file(crate::source::FileId(id))
    }
}

impl Clipped {
    /// The place of a byte of the file, clamped into the part of its line that is shown.
    fn place(&self, byte: usize) -> Option<usize> {
        let index = self.lines.partition_point(|l| l.source.start <= byte).saturating_sub(1);
        let line = self.lines.get(index)?;
        Some(line.start + byte.clamp(line.source.start, line.source.end) - line.source.start)
    }

    fn line_index(&self, byte: usize) -> usize {
        self.lines.partition_point(|l| l.start <= byte).saturating_sub(1)
    }
}

/// The lines on which labels start or end, with the byte that must be seen there: that of the first label, which
/// is the primary one where it is in this file.
fn lines_concerned(file: &SourceFile, labels: &[&Label]) -> BTreeMap<usize, usize> {
    let mut lines = BTreeMap::new();
    for label in labels {
        let bytes = snapped(&file.text, label.span);
        for byte in [bytes.start, bytes.end] {
            lines.entry(line_of(file, byte)).or_insert(byte);
        }
    }
    lines
}

fn clip(file: &SourceFile, lines: &BTreeMap<usize, usize>) -> Clipped {
    let mut clipped = Clipped { text: String::new(), lines: Vec::new() };
    for (&number, &first) in lines {
        let whole = line_range(file, number);
        let from = floor(&file.text, first.saturating_sub(LEFT).max(whole.start));
        let to = floor(&file.text, (from + WINDOW).min(whole.end)).max(from);
        let column = file.text.get(whole.start..from).map_or(1, |t| t.chars().count() + 1);
        clipped.lines.push(Line { number, source: from..to, start: clipped.text.len(), column });
        clipped.text.extend(file.text.get(from..to).unwrap_or("").chars().map(shown));
        clipped.text.push('\n');
    }
    clipped
}

/// Whether a terminal may take a character for a command.
pub(super) fn controls(c: char) -> bool {
    c.is_control() && c != '\t'
}

/// A character as it is shown; one that is put in its place has as many bytes.
fn shown(c: char) -> char {
    match c {
        c if !controls(c) => c,
        c if c.is_ascii() => '?',
        _ => '¿',
    }
}

fn line_of(file: &SourceFile, byte: usize) -> usize {
    file.line_column(u32::try_from(byte).unwrap_or(u32::MAX)).0
}

/// The bytes of a line (from 1), without its end.
fn line_range(file: &SourceFile, line: usize) -> core::ops::Range<usize> {
    let start = file.line_start(line).map_or(file.text.len(), |s| s as usize);
    let next = file.line_start(line + 1).map_or(file.text.len(), |s| s as usize);
    let text = file.text.get(start..next).unwrap_or("");
    start..start + text.trim_end_matches(['\n', '\r']).len()
}

/// The nearest character boundary at or before `byte`.
fn floor(text: &str, byte: usize) -> usize {
    let mut byte = byte.min(text.len());
    while !text.is_char_boundary(byte) {
        byte -= 1;
    }
    byte
}

/// The bytes of a span, inside the text and on character boundaries.
pub(super) fn snapped(text: &str, span: Span) -> core::ops::Range<usize> {
    let start = floor(text, span.start as usize);
    let mut end = (span.end as usize).clamp(start, text.len());
    while !text.is_char_boundary(end) {
        end += 1;
    }
    start..end
}

impl<'a> Files<'a> for Excerpts<'_> {
    type FileId = u32;
    type Name = &'a str;
    type Source = &'a str;

    fn name(&'a self, id: u32) -> Result<&'a str, Error> {
        Ok(&self.source_file(id).name)
    }

    fn source(&'a self, id: u32) -> Result<&'a str, Error> {
        Ok(self.clipped.get(&id).map_or_else(|| &*self.source_file(id).text, |c| c.text.as_str()))
    }

    fn line_index(&'a self, id: u32, byte: usize) -> Result<usize, Error> {
        match self.clipped.get(&id) {
            Some(clipped) => Ok(clipped.line_index(byte)),
            None => Ok(line_of(self.source_file(id), byte) - 1),
        }
    }

    fn line_number(&'a self, id: u32, index: usize) -> Result<usize, Error> {
        let clipped = self.clipped.get(&id).and_then(|c| c.lines.get(index));
        Ok(clipped.map_or(index + 1, |line| line.number))
    }

    fn column_number(&'a self, id: u32, index: usize, byte: usize) -> Result<usize, Error> {
        let Some(clipped) = self.clipped.get(&id) else {
            let byte = u32::try_from(byte).unwrap_or(u32::MAX);
            return Ok(self.source_file(id).line_column(byte).1);
        };
        let line = clipped.lines.get(index).ok_or(Error::FileMissing)?;
        let before = clipped.text.get(line.start..byte).map_or(0, |t| t.chars().count());
        Ok(line.column + before)
    }

    fn line_range(&'a self, id: u32, index: usize) -> Result<core::ops::Range<usize>, Error> {
        let Some(clipped) = self.clipped.get(&id) else {
            let file = self.source_file(id);
            let start = file.line_start(index + 1).map_or(file.text.len(), |s| s as usize);
            let end = file.line_start(index + 2).map_or(file.text.len(), |s| s as usize);
            return Ok(start..end);
        };
        let line = clipped.lines.get(index).ok_or(Error::FileMissing)?;
        Ok(line.start..line.start + line.source.len() + 1)
    }
}
