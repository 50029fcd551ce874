//! Nets from files of CAD systems.

use std::collections::BTreeMap;
use std::rc::Rc;

use crate::cad::{Document, Format, Import, Notice, Trouble, TroubleKind};
use crate::diag::Diagnostic;
use crate::diag::codes::geometry as codes;
use crate::geom::surface::Net;
use crate::source::{FileId, Span};

use super::Analyser;
use super::include::unreadable_file;
use super::limits;
use super::matched::Matched;

/// Bytes of a line of a CAD file that a message shows.
const SHOWN: usize = 72;

/// A file that has been opened once.
#[derive(Debug, Clone)]
struct Opened {
    file: FileId,
    document: Rc<Result<Document, Trouble>>,
}

/// The CAD files of a program, by the file that names them, their name and their format; and their bytes.
#[derive(Debug, Default)]
pub(super) struct CadFiles {
    open: BTreeMap<(FileId, String, &'static str), Opened>,
    bytes: usize,
}

impl Analyser<'_> {
    /// `NET/ STEP, 'part.stp', FACE, 3`.
    pub(super) fn net_cad(&mut self, m: &Matched) -> Option<Net> {
        let format = if m.word("format") == Some("IGES") { Format::Iges } else { Format::Step };
        let path = m.text("file")?.to_owned();
        let at = m.span("file");
        let opened = self.open_cad(format, &path, at)?;
        let face = m.number("face").map(crate::math::ceil_to_usize);
        let import = match opened.document.as_ref() {
            Ok(document) => document.net(face),
            Err(trouble) => Err(trouble.clone()),
        };
        match import {
            Ok(import) => {
                self.cad_notices(&path, &import, at);
                Some(import.net)
            }
            Err(trouble) => {
                let place = if trouble.kind == TroubleKind::Face { m.span("face") } else { at };
                let place = if place == m.word { at } else { place };
                self.cad_trouble(&path, opened.file, place, &trouble);
                None
            }
        }
    }

    fn open_cad(&mut self, format: Format, path: &str, at: Span) -> Option<Opened> {
        let key = (at.file, path.to_owned(), format.name());
        if let Some(opened) = self.cad.open.get(&key) {
            return Some(opened.clone());
        }
        let from = self.sources.file(at.file).name.clone();
        let (name, text) = match self.files.read_cad(Some(&from), path) {
            Ok(read) => read,
            Err(error) => {
                let problem = unreadable_file(path, &error, at);
                self.report(problem);
                return None;
            }
        };
        self.cad.bytes = self.cad.bytes.saturating_add(text.len());
        if self.cad.bytes > limits::CAD_BYTES {
            self.limit(format!("the CAD files have more than {} bytes in all", limits::CAD_BYTES));
            return None;
        }
        let file = self.sources.add(name, text);
        let document = Rc::new(Document::open(format, &self.sources.file(file).text));
        let opened = Opened { file, document };
        self.cad.open.insert(key, opened.clone());
        Some(opened)
    }

    fn cad_trouble(&mut self, path: &str, file: FileId, at: Span, trouble: &Trouble) {
        let code = match trouble.kind {
            TroubleKind::File => &codes::CAD_FILE,
            TroubleKind::Face => &codes::CAD_FACE,
            TroubleKind::Surface => &codes::CAD_SURFACE,
        };
        let place = trouble.line.map_or_else(String::new, |line| format!(", line {line}"));
        let mut problem = Diagnostic::new(code, at, format!("{path}{place}: {}", trouble.message));
        let source = self.sources.file(file);
        if let Some(start) = trouble.line.and_then(|line| source.line_start(line)) {
            let start = start as usize;
            let line = source.text.get(start..).and_then(|t| t.lines().next()).unwrap_or("");
            let short = line.char_indices().nth(SHOWN).map_or(line.len(), |(i, _)| i);
            // A file in one line would be shown whole.
            if short == line.len() {
                problem = problem.label(Span::new(file, start, start + short), "this line");
            }
        }
        if let Some(help) = &trouble.help {
            problem = problem.help(help.clone());
        }
        self.report(problem);
    }

    fn cad_notices(&mut self, path: &str, import: &Import, at: Span) {
        for notice in &import.notices {
            let face = import.face;
            let problem = match notice {
                Notice::Trimmed => Diagnostic::new(
                    &codes::TRIMMED,
                    at,
                    format!(
                        "face {face} of {path} is only a part of its surface: the net is the whole surface"
                    ),
                ),
                Notice::EdgesUnknown => Diagnostic::new(
                    &codes::TRIMMED,
                    at,
                    format!(
                        "whether face {face} of {path} is its whole surface cannot be told from its edges: the net is the whole surface"
                    ),
                ),
                Notice::NoUnit => Diagnostic::new(
                    &codes::NO_CAD_UNIT,
                    at,
                    format!("{path} names no unit of length: its numbers are taken as mm"),
                ),
                Notice::Placed => Diagnostic::new(
                    &codes::CAD_PLACED,
                    at,
                    format!("{path} places parts in assemblies: the net lies where its own part has it"),
                ),
            };
            let problem = match notice {
                Notice::Trimmed | Notice::EdgesUnknown => problem
                    .help("untrim or extend the face in the CAD system for a net that ends where it does"),
                Notice::Placed => problem.help("`NET/ N1, TRFORM, M1` moves a net"),
                Notice::NoUnit => problem,
            };
            self.report(problem);
        }
    }
}
