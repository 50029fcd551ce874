//! `partwright build` and `partwright check`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::args::{BuildArgs, CheckArgs, CommonArgs, Stage};
use super::disk::{Disk, STDIN};
use super::messages::{self, Messages, to_stderr};
use super::output::{self, Product, Staged};
use super::progress::Progress;
use super::staging::{Destination, Staging};
use super::{Status, deps, report, source_map};
use crate::diag::codes::{command as codes, foreign, verification};
use crate::diag::{Diagnostic, Severity};
use crate::driver::{self, Build, Output};
use crate::{clfile, syntax};

/// One source file and what came of it.
pub struct Compiled {
    /// As named on the command line.
    pub path: PathBuf,
    /// The result.
    pub build: Build,
    /// Programs that are in temporary files already, by output.
    pub staged: BTreeMap<usize, Staged>,
}

impl Compiled {
    /// File name without extension.
    pub fn stem(&self) -> String {
        stem(&self.path)
    }
}

fn stem(path: &Path) -> String {
    if path.as_os_str() == STDIN {
        return "stdin".to_owned();
    }
    path.file_stem().map_or_else(|| "program".to_owned(), |s| s.to_string_lossy().into_owned())
}

/// Compiles and writes.
pub fn build(args: &BuildArgs, messages: Messages) -> Result<Status, Diagnostic> {
    build_with(args, driver_options(&args.common)?, messages)
}

/// The same, and every file is a CL file.
pub fn cl(args: &BuildArgs, messages: Messages) -> Result<Status, Diagnostic> {
    build_with(args, driver::Options { is_cl: true, ..driver_options(&args.common)? }, messages)
}

fn build_with(
    args: &BuildArgs,
    mut options: driver::Options,
    messages: Messages,
) -> Result<Status, Diagnostic> {
    options.posts.clone_from(&args.post);
    options.post_set = args.overrides.pairs()?;
    options.keep_ast = args.emit.contains(&Stage::Ast);
    options.only_nc = args.emit.iter().all(|s| *s == Stage::Nc) && args.source_map.is_none();
    options.check_only = !args.emit.iter().any(|s| matches!(s, Stage::Target | Stage::Nc));
    let destination = |path: &Path, output: &Output| nc_file(path, output, args);
    let staging = args.emit.contains(&Stage::Nc).then_some(&destination as NcFile<'_>);
    let mut compiled = compile_to(&args.files, &options, &args.common, messages, staging)?;
    let status = show(&compiled, messages);
    let planned = plan_products(&compiled, args)?;
    if let Some(path) = &args.deps {
        output::write_all(&[deps::product(path, args.deps_format, &compiled, &planned)])?;
    }
    if status == Status::NotProven {
        // What was lowered may be looked at; nothing that a machine could run is written.
        let shown = planned.iter().filter(|p| p.stage != Stage::Nc && p.path.as_os_str() == "-");
        let shown: Vec<Product> = shown.filter_map(|p| p.make(&compiled)).collect();
        output::write_all(&shown)?;
    }
    if status != Status::Done {
        return Ok(status);
    }
    let in_memory = planned.iter().filter(|p| !p.is_staged(&compiled));
    let mut products: Vec<Product> = in_memory.filter_map(|p| p.make(&compiled)).collect();
    if let Some(path) = &args.report {
        products.push(report::product(path, &compiled, &planned));
    }
    if let Some(path) = &args.source_map {
        products.push(source_map::product(path, &compiled, &planned));
    }
    if let Some(folder) = &args.out_dir {
        output::make_folder(folder)?;
    }
    let staged = compiled.iter_mut().flat_map(|one| core::mem::take(&mut one.staged).into_values());
    output::write_with(staged.collect(), &products)?;
    if messages.for_people() && args.emit.contains(&Stage::Nc) {
        to_stderr(&report::summary(&compiled, &planned));
    }
    Ok(Status::Done)
}

/// Checks only.
pub fn check(args: &CheckArgs, messages: Messages) -> Result<Status, Diagnostic> {
    let options = driver::Options { check_only: true, ..driver_options(&args.common)? };
    let compiled = compile(&args.files, &options, &args.common, messages)?;
    Ok(show(&compiled, messages))
}

/// What the common arguments say; sets the number of threads.
pub fn driver_options(common: &CommonArgs) -> Result<driver::Options, Diagnostic> {
    messages::check_deny(&common.deny)?;
    if let Some(jobs) = common.jobs {
        set_threads(jobs)?;
    }
    let defines = common.define.iter().map(|d| define(d)).collect::<Result<_, _>>()?;
    let producer = common.producer.as_deref().map(producer).transpose()?;
    let cl = clfile::Options { producer, lenient: common.lenient, ..clfile::Options::default() };
    Ok(driver::Options { defines, cl, card_columns: common.card_columns, ..driver::Options::default() })
}

fn producer(name: &str) -> Result<clfile::Producer, Diagnostic> {
    clfile::producer_named(name).map_err(|why| Diagnostic::global(&foreign::UNKNOWN_PRODUCER, why))
}

pub fn set_threads(jobs: usize) -> Result<(), Diagnostic> {
    let bad = |why: String| Diagnostic::global(&codes::BAD_THREADS, format!("-j {jobs}: {why}"));
    if jobs == 0 {
        return Err(bad("at least one thread is needed".to_owned()));
    }
    rayon::ThreadPoolBuilder::new().num_threads(jobs).build_global().map_err(|e| bad(e.to_string()))
}

fn define(given: &str) -> Result<(String, String), Diagnostic> {
    match given.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() && !value.trim().is_empty() => {
            Ok((name.trim().to_owned(), value.trim().to_owned()))
        }
        Some((name, _)) if name.trim().is_empty() => {
            Err(Diagnostic::global(&codes::BAD_DEFINE, format!("-D {given} has no name"))
                .help("write -D NAME=VALUE"))
        }
        _ => Err(Diagnostic::global(&codes::BAD_DEFINE, format!("-D {given} has no value"))
            .help("write -D NAME=VALUE")),
    }
}

/// The file of the NC program of an output of a source file.
type NcFile<'a> = &'a (dyn Fn(&Path, &Output) -> PathBuf + Sync);

/// Compiles every file, in parallel when there are several; the order stays.
pub fn compile(
    files: &[PathBuf],
    options: &driver::Options,
    common: &CommonArgs,
    messages: Messages,
) -> Result<Vec<Compiled>, Diagnostic> {
    compile_to(files, options, common, messages, None)
}

/// The same; what has been proven goes to temporary files at once where its file is known.
fn compile_to(
    files: &[PathBuf],
    options: &driver::Options,
    common: &CommonArgs,
    messages: Messages,
    nc_file: Option<NcFile<'_>>,
) -> Result<Vec<Compiled>, Diagnostic> {
    let what = match files {
        [only] => format!("compiling {}", only.display()),
        _ => format!("compiling {} programs", files.len()),
    };
    let progress = messages.for_people().then(|| Progress::start(what));
    let one = |path: &PathBuf| {
        let destination = nc_file.map(|file| move |output: &Output| file(path, output));
        let staging = Staging::new(destination.as_ref().map(|d| d as Destination<'_>));
        let mut build = driver::build_to(&path.to_string_lossy(), &Disk::for_main(path), options, &staging);
        messages::deny(&mut build.diagnostics, &common.deny);
        Compiled { path: path.clone(), build, staged: staging.into_staged() }
    };
    let compiled = if let [only] = files { vec![one(only)] } else { files.par_iter().map(one).collect() };
    drop(progress);
    Ok(compiled)
}

/// Shows all messages; the worst decides how the run ends.
pub fn show(compiled: &[Compiled], messages: Messages) -> Status {
    let mut status = Status::Done;
    for one in compiled {
        messages.show(&one.build.diagnostics, &one.build.sources);
        status = worse(status, status_of(&one.build.diagnostics));
    }
    status
}

/// File trouble comes before errors of a program, and those before what only the proof finds.
pub fn worse(a: Status, b: Status) -> Status {
    let rank = |s: Status| match s {
        Status::Done => 0,
        Status::Differs => 1,
        Status::NotProven => 2,
        Status::Errors => 3,
        Status::Trouble => 4,
        Status::Fault => 5,
    };
    if rank(a) >= rank(b) { a } else { b }
}

pub fn status_of(diagnostics: &[Diagnostic]) -> Status {
    diagnostics.iter().filter(|d| d.severity == Severity::Error).map(status_of_one).fold(Status::Done, worse)
}

fn status_of_one(diagnostic: &Diagnostic) -> Status {
    let id = diagnostic.code.id;
    let of_command = is_trouble(id) && diagnostic.primary.is_none();
    if of_command {
        Status::Trouble
    } else if verification::ALL.iter().any(|c| c.id == id) {
        Status::NotProven
    } else {
        Status::Errors
    }
}

/// Codes of files, the command line and post files.
pub fn is_trouble(id: &str) -> bool {
    use crate::diag::codes::{command, post, tools};
    [command::ALL, post::ALL, tools::OF_COMMANDS, tools::OF_POSTS].into_iter().flatten().any(|c| c.id == id)
}

/// Something that this run will make.
#[derive(Debug)]
pub struct Planned {
    /// Index of the source.
    pub source: usize,
    /// Index into [`Build::outputs`] for what belongs to one post.
    pub output: Option<usize>,
    /// Stage.
    pub stage: Stage,
    /// Where to.
    pub path: PathBuf,
}

impl Planned {
    /// Whether it is in a temporary file already.
    fn is_staged(&self, compiled: &[Compiled]) -> bool {
        let staged = compiled.get(self.source).zip(self.output);
        self.stage == Stage::Nc && staged.is_some_and(|(one, output)| one.staged.contains_key(&output))
    }

    fn make(&self, compiled: &[Compiled]) -> Option<Product> {
        let build = &compiled.get(self.source)?.build;
        let output = self.output.and_then(|i| build.outputs.get(i));
        let text = text_of(self.stage, build, output)?;
        Some(Product { path: self.path.clone(), bytes: text.into_bytes() })
    }
}

/// The text of a stage.
fn text_of(stage: Stage, build: &Build, output: Option<&Output>) -> Option<String> {
    match stage {
        Stage::Ast => build.ast.as_ref().map(|ast| syntax::print::print(ast, &build.sources)),
        Stage::Ir => build.ir.as_ref().map(|ir| crate::ir::print::print(ir, &build.sources)),
        Stage::Cl => build.cl.as_ref().map(crate::cl::print::print),
        Stage::Target => output?.target.as_ref().map(crate::target::print::print),
        Stage::Nc => output?.proven.as_ref().map(|p| p.text().to_owned()),
    }
}

/// Names everything that is to be made, and refuses clashes.
fn plan_products(compiled: &[Compiled], args: &BuildArgs) -> Result<Vec<Planned>, Diagnostic> {
    let mut planned = Vec::new();
    for (source, one) in compiled.iter().enumerate() {
        for &stage in &args.emit {
            let outputs: Vec<Option<usize>> = match stage {
                Stage::Ast | Stage::Ir | Stage::Cl => vec![None],
                Stage::Target | Stage::Nc => (0..one.build.outputs.len()).map(Some).collect(),
            };
            for output in outputs {
                let path = destination(one, output, stage, args);
                planned.push(Planned { source, output, stage, path });
            }
        }
    }
    if let Some(path) = &args.output
        && planned.len() > 1
        && !output::is_stdout(path)
    {
        let message = format!("-o names one file, but this command makes {}", planned.len());
        return Err(Diagnostic::global(&codes::ONE_OUTPUT, message).help("name a directory with --out-dir"));
    }
    refuse_clashes(&planned, compiled, args)?;
    Ok(planned)
}

fn destination(one: &Compiled, output: Option<usize>, stage: Stage, args: &BuildArgs) -> PathBuf {
    let post = output.and_then(|i| one.build.outputs.get(i));
    let file = match (stage, post) {
        (Stage::Nc, Some(post)) => return nc_file(&one.path, post, args),
        (Stage::Target, Some(post)) => format!("{}.{}.target", one.stem(), post.post),
        (stage, _) => format!("{}.{}", one.stem(), stage_name(stage)),
    };
    match (&args.output, &args.out_dir) {
        (Some(path), _) => path.clone(),
        (None, Some(folder)) => folder.join(file),
        (None, None) => PathBuf::from("-"),
    }
}

/// Where the NC program of an output goes.
fn nc_file(source: &Path, output: &Output, args: &BuildArgs) -> PathBuf {
    let file = format!("{}.{}.{}", stem(source), output.post, output.extension);
    match (&args.output, &args.out_dir) {
        (Some(path), _) => path.clone(),
        (None, Some(folder)) => folder.join(file),
        (None, None) if source.as_os_str() == STDIN => PathBuf::from(file),
        (None, None) => source.with_file_name(file),
    }
}

fn stage_name(stage: Stage) -> &'static str {
    match stage {
        Stage::Ast => "ast",
        Stage::Ir => "ir",
        Stage::Cl => "cl",
        Stage::Target => "target",
        Stage::Nc => "nc",
    }
}

/// Two products with one name, or a product with the name of a file that was read.
fn refuse_clashes(planned: &[Planned], compiled: &[Compiled], args: &BuildArgs) -> Result<(), Diagnostic> {
    let extra = args.report.iter().chain(&args.deps).chain(&args.source_map);
    let mut targets: Vec<&Path> =
        planned.iter().map(|p| p.path.as_path()).chain(extra.map(PathBuf::as_path)).collect();
    targets.retain(|p| !output::is_stdout(p) && !is_device(p));
    let mut names: Vec<PathBuf> = targets.iter().map(|p| real(p)).collect();
    names.sort();
    let twice = names.iter().zip(names.iter().skip(1)).find(|(a, b)| a == b);
    if let Some((twice, _)) = twice {
        let shown = targets.iter().find(|p| real(p) == *twice).copied().unwrap_or(twice);
        return Err(clash(shown, "would be written twice"));
    }
    let sources = compiled.iter().flat_map(|c| c.build.sources.iter().map(|(_, f)| PathBuf::from(&f.name)));
    let sources: Vec<PathBuf> = sources.map(|p| real(&p)).collect();
    match targets.iter().find(|p| sources.contains(&real(p))) {
        Some(path) => Err(clash(path, "is a source file; it would be overwritten")),
        None => Ok(()),
    }
}

/// Refuses to write over a file that was read.
pub fn refuse_source(path: &Path, build: &Build) -> Result<(), Diagnostic> {
    let source = build.sources.iter().any(|(_, file)| real(Path::new(&file.name)) == real(path));
    if source { Err(clash(path, "is a source file; it would be overwritten")) } else { Ok(()) }
}

fn clash(path: &Path, what: &str) -> Diagnostic {
    Diagnostic::global(&codes::OUTPUT_CLASH, format!("{} {what}", path.display()))
        .help("name other files with -o, or other directories with --out-dir")
}

fn is_device(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|m| !m.is_file() && !m.is_dir())
}

/// The real path of a file that need not exist yet.
fn real(path: &Path) -> PathBuf {
    if let Ok(real) = path.canonicalize() {
        return real;
    }
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
    path.file_name().map_or_else(|| folder.clone(), |name| folder.join(name))
}
