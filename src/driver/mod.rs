//! The pipeline: source text to proven NC programs, without a file, a clock or a terminal.
//!
//! [`build`] runs every stage as far as it can and hands back every stage's value, for whoever wants to print
//! it. What may be written to a file is [`Output::proven`], which only `verify` can make.

use std::sync::{Mutex, PoisonError};

use crate::cl::Cl;
use crate::diag::codes::command as codes;
use crate::diag::{Diagnostic, Severity, Sink};
use crate::source::{FileError, FileId, FileProvider, SourceMap};
use crate::syntax::{self, ast};
use crate::target::TargetProgram;
use crate::units::LengthUnit;
use crate::verify::Proven;
use crate::{ir, plan, sema};

mod targets;

/// What to build.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// `-D NAME=VALUE`, as given.
    pub defines: Vec<(String, String)>,
    /// Posts by name or file; when empty, the program's `MACHIN` statements decide.
    pub posts: Vec<String>,
    /// `--post-set KEY=VALUE`, as given; they hold for every post.
    pub post_set: Vec<(String, String)>,
    /// The post when neither [`Options::posts`] nor the program names one; without it that is an error.
    pub default_post: Option<String>,
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
    /// One for every post, in the order asked for.
    pub outputs: Vec<Output>,
    /// Names of all files that were read, sources, tables and post files, in order of first reading.
    pub inputs: Vec<String>,
}

/// What came of one post.
#[derive(Debug)]
pub struct Output {
    /// The post's name, as it stands in file names.
    pub post: String,
    /// The extension of its programs, without the point.
    pub extension: String,
    /// The program's unit of length.
    pub units: LengthUnit,
    /// The lowered program.
    pub target: Option<TargetProgram>,
    /// The NC program, when it has been proven: the only thing that may be written.
    pub proven: Option<Proven>,
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
    let files = Recorder { files, names: Mutex::default() };
    match files.read(None, main) {
        Ok((name, text)) => {
            let file = build.sources.add(name, text);
            stages(&mut build, file, &files, options, &mut sink);
        }
        Err(error) => sink.push(unreadable(main, &error)),
    }
    build.inputs = files.names.into_inner().unwrap_or_else(PoisonError::into_inner);
    build.diagnostics = in_source_order(sink.into_items());
    build
}

/// Hands files on and remembers their names.
struct Recorder<'a> {
    files: &'a dyn FileProvider,
    names: Mutex<Vec<String>>,
}

impl FileProvider for Recorder<'_> {
    fn read(&self, from: Option<&str>, path: &str) -> Result<(String, String), FileError> {
        let (name, text) = self.files.read(from, path)?;
        let mut names = self.names.lock().unwrap_or_else(PoisonError::into_inner);
        if !names.contains(&name) {
            names.push(name.clone());
        }
        Ok((name, text))
    }
}

/// Runs the stages as far as they go.
fn stages(build: &mut Build, file: FileId, files: &dyn FileProvider, options: &Options, sink: &mut Sink) {
    let text = build.sources.file(file).text.clone();
    let tree = syntax::parse(file, &text, sink);
    if options.keep_ast {
        build.ast = Some(tree.clone());
    }
    let evaluation = sema::Options { defines: options.defines.clone() };
    build.ir = sema::analyse_tree(tree, &mut build.sources, files, &evaluation, sink);
    back(build, files, options, sink);
}

/// From the evaluated program on. What is wrong with the posts of the command line is said in any case.
fn back(build: &mut Build, files: &dyn FileProvider, options: &Options, sink: &mut Sink) {
    build.cl = build.ir.as_ref().and_then(|ir| plan::plan(ir, sink));
    if options.check_only {
        return;
    }
    let (Some(ir), Some(cl)) = (&build.ir, &build.cl) else {
        return targets::check(options, files, &mut build.sources, sink);
    };
    let wanted = targets::wanted(options, &ir.machines, sink);
    build.outputs = targets::make(cl, &wanted, options, files, &mut build.sources, sink);
}

/// By file and place; what has no place comes last. Messages at one place stay in the order they came.
/// What several posts say alike is said once.
fn in_source_order(mut items: Vec<Diagnostic>) -> Vec<Diagnostic> {
    items.sort_by_key(|d| d.primary.as_ref().map_or((u32::MAX, 0), |p| (p.span.file.0, p.span.start)));
    items.dedup();
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
        FileError::TooLarge(limit) => {
            Diagnostic::global(&codes::TOO_LARGE, format!("{path} has more than {limit} bytes"))
                .help("put bulk data into CSV files")
        }
        FileError::Other(reason) => {
            Diagnostic::global(&codes::CANNOT_READ, format!("{path} cannot be read: {reason}"))
        }
    }
}
