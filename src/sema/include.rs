//! `INCLUD`: each file once, cycles reported.

use std::collections::BTreeMap;

use crate::diag::Diagnostic;
use crate::diag::codes::semantics as codes;
use crate::source::{FileError, FileId, SourceMap, Span};
use crate::syntax;

use super::matched::Matched;
use super::{Analyser, limits};

/// Which files have been read, and which are being read.
#[derive(Debug)]
pub(super) struct Includes {
    /// Canonical names of the files being carried out, the main file first, with the `INCLUD` that led there.
    open: Vec<(String, Option<Span>)>,
    /// Canonical names of all files.
    done: BTreeMap<String, FileId>,
    bytes: usize,
}

impl Includes {
    /// Starts with the main file.
    pub fn new(sources: &SourceMap, main: FileId) -> Includes {
        let file = sources.file(main);
        let name = file.name.clone();
        Includes {
            open: vec![(name.clone(), None)],
            done: BTreeMap::from([(name, main)]),
            bytes: file.text.len(),
        }
    }
    /// Number of includes that are being carried out.
    pub fn depth(&self) -> usize {
        self.open.len().saturating_sub(1)
    }
}

impl Analyser<'_> {
    /// `INCLUD/ 'file'`.
    pub(super) fn includ(&mut self, m: &Matched, span: Span) {
        let Some(path) = m.text("file").map(str::to_owned) else { return };
        let at = m.span("file");
        let from = self.sources.file(at.file).name.clone();
        match self.files.read(Some(&from), &path) {
            Ok((name, text)) => self.include_text(&name, text, at, span),
            Err(error) => {
                let problem = unreadable(&path, &error, at);
                self.report(problem);
                self.state.forget();
            }
        }
    }

    fn include_text(&mut self, name: &str, text: String, at: Span, span: Span) {
        if let Some(position) = self.include.open.iter().position(|(n, _)| n == name) {
            let problem = self.cycle(position, name, at);
            return self.report(problem);
        }
        if self.include.done.contains_key(name) {
            return;
        }
        self.include.bytes += text.len();
        if self.include.bytes > limits::SOURCE_BYTES {
            return self
                .limit(format!("the source files have more than {} bytes in all", limits::SOURCE_BYTES));
        }
        if self.include.depth() >= limits::INCLUDE_DEPTH {
            return self.limit(format!("files include one another more than {} deep", limits::INCLUDE_DEPTH));
        }
        let file = self.sources.add(name, text.as_str());
        self.include.done.insert(name.to_owned(), file);
        let tree = syntax::parse_columns(file, &text, self.card_columns, &mut self.syntax);
        let code = self.load(tree);
        self.include.open.push((name.to_owned(), Some(at)));
        self.run(&code, 0..code.program.statements.len());
        self.include.open.pop();
        if self.ended == Some(super::End::Fini) {
            self.ended = None;
        }
        self.here = span;
    }

    fn cycle(&self, position: usize, name: &str, at: Span) -> Diagnostic {
        let mut problem = Diagnostic::new(
            &codes::INCLUDE_CYCLE,
            at,
            format!("{name} is being read already: it includes itself"),
        );
        for (file, span) in self.include.open.iter().skip(position + 1) {
            if let Some(span) = span {
                problem = problem.label(*span, format!("{file} is included here"));
            }
        }
        problem.help("put what both files need into a third one")
    }
}

fn unreadable(path: &str, error: &FileError, at: Span) -> Diagnostic {
    let problem = |message: String| Diagnostic::new(&codes::INCLUDE, at, message);
    match error {
        FileError::NotFound => problem(format!("there is no file {path}"))
            .note("the path counts from the directory of the file that names it"),
        FileError::OutsideRoot => problem(format!("{path} lies outside the project"))
            .note("a program reads nothing above its project's root"),
        FileError::NotUtf8(byte) => {
            problem(format!("{path} is not UTF-8: {byte} is not part of any character"))
        }
        FileError::TooLarge(bytes) => problem(format!("{path} is larger than {bytes} bytes")),
        FileError::Other(reason) => problem(format!("{path} cannot be read: {reason}")),
    }
}

/// The message for a data file that cannot be read.
pub(super) fn unreadable_file(path: &str, error: &FileError, at: Span) -> Diagnostic {
    unreadable(path, error, at)
}
