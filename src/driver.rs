//! The pipeline: source text to proven NC programs, without a file, a clock or a terminal.
//!
//! [`build`] runs every stage as far as it can and hands back every stage's value, for whoever wants to print
//! it. What may be written to a file is [`Output::proven`], which only `verify` can make.

use crate::cl::Cl;
use crate::diag::codes::command as codes;
use crate::diag::{Diagnostic, Severity, Sink};
use crate::ir;
use crate::source::{FileError, FileId, FileProvider, SourceMap};
use crate::syntax::{self, ast};

/// What to build.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// `-D NAME=VALUE`, as given.
    pub defines: Vec<(String, String)>,
    /// Posts by name or file; when empty, the program's `MACHIN` statements decide.
    pub posts: Vec<String>,
    /// Stop before lowering: all checks of the program, no output.
    pub check_only: bool,
    /// Keep the syntax tree of the main file.
    pub keep_ast: bool,
}

/// What came of one source file.
#[derive(Debug, Default)]
pub struct Build {
    /// Every file that was read, the main file first.
    pub sources: SourceMap,
    /// All messages, in source order.
    pub diagnostics: Vec<Diagnostic>,
    /// The main file's tree, when asked for.
    pub ast: Option<ast::Program>,
    /// The evaluated program.
    pub ir: Option<ir::Program>,
    /// Its cutter location data.
    pub cl: Option<Cl>,
}

impl Build {
    /// Whether an error is among the diagnostics.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        self.diagnostics.iter().any(|d| d.severity == Severity::Error)
    }
}

/// Compiles the program in file `main`.
#[must_use]
pub fn build(main: &str, files: &dyn FileProvider, options: &Options) -> Build {
    let mut build = Build::default();
    let mut sink = Sink::default();
    match files.read(None, main) {
        Ok((name, text)) => {
            let file = build.sources.add(name, text);
            front(&mut build, file, files, options, &mut sink);
        }
        Err(error) => sink.push(unreadable(main, &error)),
    }
    build.diagnostics = in_source_order(sink.into_items());
    build
}

/// Source text to cutter location data.
fn front(build: &mut Build, file: FileId, _files: &dyn FileProvider, options: &Options, sink: &mut Sink) {
    let text = build.sources.file(file).text.clone();
    let tree = syntax::parse(file, &text, sink);
    if options.keep_ast {
        build.ast = Some(tree);
    }
}

/// By file and place; what has no place comes last. Messages at one place stay in the order they came.
fn in_source_order(mut items: Vec<Diagnostic>) -> Vec<Diagnostic> {
    items.sort_by_key(|d| d.primary.as_ref().map_or((u32::MAX, 0), |p| (p.span.file.0, p.span.start)));
    items
}

/// The message for a file that could not be read.
#[must_use]
pub fn unreadable(path: &str, error: &FileError) -> Diagnostic {
    match error {
        FileError::NotFound => Diagnostic::global(&codes::CANNOT_READ, format!("there is no file {path}")),
        FileError::OutsideRoot => {
            Diagnostic::global(&codes::OUTSIDE_ROOT, format!("{path} lies outside the project"))
                .help("the project is the nearest directory above with a `partwright.toml` or a `.git`, or else that of the main file")
        }
        FileError::NotUtf8(byte) => Diagnostic::global(
            &codes::NOT_UTF8,
            format!("{path} is not UTF-8: the byte at offset {byte} is not part of any character"),
        )
        .help("save the file as UTF-8"),
        FileError::Other(reason) => {
            Diagnostic::global(&codes::CANNOT_READ, format!("{path} cannot be read: {reason}"))
        }
    }
}
