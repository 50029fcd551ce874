//! The pipeline: source text to proven NC programs, without a file, a clock or a terminal.
//!
//! [`build`] runs every stage as far as it can and hands back every stage's value, for whoever wants to print
//! it. What may be written to a file is [`Output::proven`], which only `verify` can make.

use std::sync::{Mutex, PoisonError};

use crate::cl::Cl;
use crate::diag::codes::command as codes;
use crate::diag::{Diagnostic, Severity, Sink};
use crate::plan::closer::{Closer, Place};
use crate::source::{FileError, FileId, FileProvider, SourceMap};
use crate::syntax::{self, ast};
use crate::target::TargetProgram;
use crate::units::LengthUnit;
use crate::verify::{Proven, Shortfall};
use crate::{clfile, ir, plan, post, sema};

mod parts;
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
    /// How CL files are read.
    pub cl: clfile::Options,
    /// The file is a CL file, whatever it is called and whatever stands in it.
    pub is_cl: bool,
    /// Only the NC programs are wanted: a CL file is built in parts, and no other stage is kept.
    pub only_nc: bool,
    /// Stop before lowering: all checks of the program, no output.
    pub check_only: bool,
    /// What stands behind column 72 of a line is no part of the program (`--card-columns`).
    pub card_columns: bool,
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
    /// Lines of the NC text by block of [`Output::target`]: first, from 1, and one past the last.
    pub lines: Vec<(u32, u32)>,
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

/// Takes proven texts as they are made, so that not all of them are in memory until the last one is proven.
pub trait Shelf: Sync {
    /// Takes the text of the output with this index, in place of an earlier one; with `false` it stays in
    /// [`Output::proven`], and an earlier one is gone.
    fn put(&self, index: usize, output: &Output, text: &str) -> bool;
}

/// Takes nothing.
struct NoShelf;

impl Shelf for NoShelf {
    fn put(&self, _: usize, _: &Output, _: &str) -> bool {
        false
    }
}

/// What is kept of the outputs in memory, and where their texts go.
#[derive(Clone, Copy)]
struct Keep<'a> {
    only_nc: bool,
    shelf: &'a dyn Shelf,
}

/// Hands the text of a proven output to the shelf.
fn shelve(index: usize, output: &mut Output, shelf: &dyn Shelf) {
    let taken = output.proven.as_ref().is_some_and(|proven| shelf.put(index, output, proven.text()));
    if let Some(proven) = output.proven.as_mut().filter(|_| taken) {
        proven.let_go();
    }
}

/// Compiles the program in file `main`.
#[must_use]
pub fn build(main: &str, files: &dyn FileProvider, options: &Options) -> Build {
    build_to(main, files, options, &NoShelf)
}

/// Compiles the program in file `main`; texts that `shelf` takes are not in the outputs. A text is taken when it has been
/// proven, and before it is known whether those of other posts can be: nothing may come of it when the build has errors.
#[must_use]
pub fn build_to(main: &str, files: &dyn FileProvider, options: &Options, shelf: &dyn Shelf) -> Build {
    let mut build = Build::default();
    let mut sink = Sink::default();
    let files = Recorder { files, names: Mutex::default() };
    let mut of_cl = None;
    match read_main(main, &files, options) {
        Ok((name, text)) => {
            let file = build.sources.add(name, text);
            match cl_file(&build.sources, file, options) {
                Some(cl) => {
                    of_cl = Some(file);
                    cl_stages(&mut build, (file, &cl), &files, options, shelf, &mut sink);
                }
                None => stages(&mut build, file, &files, options, shelf, &mut sink),
            }
        }
        Err(error) => sink.push(unreadable(main, &error)),
    }
    build.inputs = files.names.into_inner().unwrap_or_else(PoisonError::into_inner);
    build.diagnostics = once_for_all_posts(in_source_order(sink.into_items()), &build.sources);
    if let Some(file) = of_cl {
        build.diagnostics = clfile::told_once(file, core::mem::take(&mut build.diagnostics));
    }
    build
}

/// A mistake in `--post-set` is one mistake, however many posts it is given to: what others say of it are notes of the first.
fn once_for_all_posts(diagnostics: Vec<Diagnostic>, sources: &SourceMap) -> Vec<Diagnostic> {
    /// Its code, and the text and the place that it is about.
    type Mistake<'a> = (&'static str, &'a str, core::ops::Range<u32>);
    let mut told: Vec<Diagnostic> = Vec::new();
    // With each mistake, where it stands among those told.
    let mut known: Vec<(Mistake<'_>, usize)> = Vec::new();
    for diagnostic in diagnostics {
        let span = diagnostic.primary.as_ref().map(|label| label.span);
        let Some(span) = span.filter(|span| post::is_override(span.file, sources)) else {
            told.push(diagnostic);
            continue;
        };
        let mistake = (diagnostic.code.id, &*sources.file(span.file).text, span.start..span.end);
        if let Some((_, first)) = known.iter().find(|(before, _)| *before == mistake) {
            told[*first].also(diagnostic.message);
        } else {
            known.push((mistake, told.len()));
            told.push(diagnostic);
        }
    }
    told
}

/// The main file; a CL file need not be UTF-8.
fn read_main(main: &str, files: &dyn FileProvider, options: &Options) -> Result<(String, String), FileError> {
    if options.is_cl || options.cl.producer.is_some() || clfile::recognise(main, "").is_some() {
        return files.read_cl(main);
    }
    match files.read(None, main) {
        Err(error @ (FileError::NotUtf8(_) | FileError::TooLarge(_))) => {
            let cl = files.read_cl(main).ok().filter(|(_, text)| clfile::recognise(main, text).is_some());
            cl.ok_or(error)
        }
        read => read,
    }
}

/// How to read the main file as a CL file, if it is one.
fn cl_file(sources: &SourceMap, file: FileId, options: &Options) -> Option<clfile::Options> {
    let source = sources.file(file);
    let found = options.cl.producer.or_else(|| clfile::recognise(&source.name, &source.text));
    let producer = found.or_else(|| options.is_cl.then_some(clfile::Producer::Plain))?;
    Some(clfile::Options {
        producer: Some(producer),
        lenient: options.cl.lenient,
        defines: options.defines.clone(),
        card_columns: options.card_columns,
    })
}

/// From a CL file on.
fn cl_stages(
    build: &mut Build,
    (file, how): (FileId, &clfile::Options),
    files: &dyn FileProvider,
    options: &Options,
    shelf: &dyn Shelf,
    sink: &mut Sink,
) {
    let source = build.sources.file(file);
    let (name, text) = (source.name.clone(), source.text.clone());
    if options.only_nc && !options.check_only {
        let cl_file = parts::ClFile { file, name: &name, text: &text, how };
        build.outputs = parts::make(&cl_file, options, (files, shelf), &mut build.sources, sink);
        return;
    }
    let (cl, messages) = clfile::Reader::new(file, &name, &text, how).whole();
    let failed = messages.has_errors();
    sink.append(messages);
    if failed {
        return targets::check(options, &targets::Machines::default(), files, &mut build.sources, sink);
    }
    if !options.check_only {
        let wanted = targets::wanted(options, &targets::Machines::default(), sink);
        let ready = targets::ready(cl.units, &wanted, options, files, &mut build.sources, sink);
        let made = targets::make(&cl, &ready, &build.sources, Keep { only_nc: options.only_nc, shelf });
        sink.append(made.messages);
        build.outputs = made.outputs;
    }
    build.cl = Some(cl);
}

/// Hands files on and remembers their names.
struct Recorder<'a> {
    files: &'a dyn FileProvider,
    names: Mutex<Vec<String>>,
}

impl FileProvider for Recorder<'_> {
    fn read(&self, from: Option<&str>, path: &str) -> Result<(String, String), FileError> {
        let (name, text) = self.files.read(from, path)?;
        self.remember(&name);
        Ok((name, text))
    }

    fn read_cl(&self, path: &str) -> Result<(String, String), FileError> {
        let (name, text) = self.files.read_cl(path)?;
        self.remember(&name);
        Ok((name, text))
    }

    fn read_cad(&self, from: Option<&str>, path: &str) -> Result<(String, String), FileError> {
        let (name, text) = self.files.read_cad(from, path)?;
        self.remember(&name);
        Ok((name, text))
    }
}

impl Recorder<'_> {
    fn remember(&self, name: &str) {
        let mut names = self.names.lock().unwrap_or_else(PoisonError::into_inner);
        if !names.iter().any(|n| n == name) {
            names.push(name.to_owned());
        }
    }
}

/// Runs the stages as far as they go.
fn stages(
    build: &mut Build,
    file: FileId,
    files: &dyn FileProvider,
    options: &Options,
    shelf: &dyn Shelf,
    sink: &mut Sink,
) {
    let text = build.sources.file(file).text.clone();
    let tree = syntax::parse_columns(file, &text, options.card_columns, sink);
    if options.keep_ast {
        build.ast = Some(tree.clone());
    }
    let evaluation = sema::Options { defines: options.defines.clone(), card_columns: options.card_columns };
    match sema::analyse_tree(tree, &mut build.sources, files, &evaluation, sink) {
        Ok(program) => {
            build.ir = Some(program);
            back(build, files, options, shelf, sink);
        }
        Err(broken) => {
            let machines = targets::Machines::of(&broken);
            targets::check(options, &machines, files, &mut build.sources, sink);
        }
    }
}

/// From the evaluated program on. What is wrong with the posts is said in any case.
fn back(build: &mut Build, files: &dyn FileProvider, options: &Options, shelf: &dyn Shelf, sink: &mut Sink) {
    let Some(ir) = &build.ir else { return };
    let mut planned = Sink::default();
    build.cl = plan::plan(ir, &mut planned);
    let machines = targets::Machines::of(ir);
    let Some(cl) = build.cl.take_if(|_| !options.check_only) else {
        sink.append(planned);
        return targets::check(options, &machines, files, &mut build.sources, sink);
    };
    let wanted = targets::wanted(options, &machines, sink);
    let ready = targets::ready(ir.units, &wanted, options, files, &mut build.sources, sink);
    let keep = Keep { only_nc: options.only_nc, shelf };
    let (cl, made) = closer(ir, (cl, &mut planned), &ready, &build.sources, keep);
    build.cl = Some(cl);
    sink.append(planned);
    sink.append(made.messages);
    build.outputs = made.outputs;
}

/// The programs of all posts; where a proof finds that too much is left between passes, and nothing else is wrong, planned
/// again with passes that lie closer there. Rounds are few, and end where they do not help; what the last one says holds.
fn closer(
    ir: &ir::Program,
    (mut cl, planned): (Cl, &mut Sink),
    ready: &[targets::Ready],
    sources: &SourceMap,
    keep: Keep<'_>,
) -> (Cl, targets::Made) {
    let mut made = targets::make(&cl, ready, sources, keep);
    let mut closer = Closer::after(&cl);
    for round in 1..plan::closer::ROUNDS {
        if made.short.is_empty() {
            break;
        }
        let place = |s: &Shortfall| (s.operation, Place { at: s.at, reach: s.reach, share: s.share });
        let places: Vec<(usize, Place)> = made.short.iter().map(place).collect();
        if !closer.add(&places, round >= plan::closer::EVERYWHERE) {
            break;
        }
        let mut told = Sink::default();
        let Some(next) = plan::plan_closer(ir, &closer, &mut told) else { break };
        *planned = told;
        made = targets::make(&next, ready, sources, keep);
        cl = next;
    }
    (cl, made)
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
            format!("{path} is not UTF-8: {byte} is not part of any character"),
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

#[cfg(test)]
mod tests;
