//! `partwright test`.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::Path;

use rayon::prelude::*;

use super::args::golden::{TestArgs, TestFormat};
use super::disk::Disk;
use super::messages::{Messages, to_stderr};
use super::output::{self, Product};
use super::progress::Progress;
use super::{Status, build};
use crate::diag::codes::{command, tools as codes};
use crate::diag::render::{Format, render};
use crate::diag::{Diagnostic, Severity};
use crate::golden::report::Run;
use crate::golden::{self, Made, Outcome, TestFile, Verdict, junit, names, report, sidecar};
use crate::source::SourceMap;

mod find;

use find::{Found, Program};

/// Builds, compares, reports, and accepts when asked to.
pub fn test(args: &TestArgs, messages: Messages) -> Result<Status, Diagnostic> {
    if let Some(jobs) = args.jobs {
        build::set_threads(jobs)?;
    }
    let found = find::find(&args.dir)?;
    let progress = (messages.for_people() && !found.programs.is_empty())
        .then(|| Progress::start(format!("testing {} programs", found.programs.len())));
    let tested: Vec<Tested> = found.programs.par_iter().map(one).collect();
    drop(progress);
    let trouble = show_trouble(&tested, messages);
    if trouble != Status::Done {
        return Ok(trouble);
    }
    let (mut run, mut unreadable) = judge(&found, tested);
    if let Some(filter) = &args.filter {
        run.outcomes.retain(|o| o.name().contains(filter.as_str()));
        run.skipped.clear();
        unreadable.retain(|(name, _)| run.outcomes.iter().any(|o| o.golden == *name));
    }
    if !unreadable.is_empty() {
        let errors: Vec<Diagnostic> = unreadable.into_iter().map(|(_, error)| error).collect();
        messages.show(&errors, &SourceMap::default());
        return Ok(Status::Trouble);
    }
    if run.outcomes.is_empty() {
        return Err(nothing(args));
    }
    refuse_clashes(&run)?;
    let status = status(&run);
    if args.accept {
        accept(&run)?;
        run.accepted = true;
    }
    let text = match args.format {
        TestFormat::Text => report::human(&run),
        TestFormat::Json => report::json(&run),
        TestFormat::Junit => junit::junit(&run),
    };
    output::write_all(&[Product { path: args.output.clone(), bytes: text.into_bytes() }])?;
    if args.format != TestFormat::Text && messages.for_people() && status == Status::Differs {
        to_stderr("some tests differ; `partwright test` shows how\n");
    }
    Ok(if args.accept && status == Status::Differs { accepted_status(&run) } else { status })
}

/// A program with its builds, or with what is wrong with its test file.
struct Tested {
    program: Program,
    made: Result<Vec<Made>, (Vec<Diagnostic>, SourceMap)>,
}

fn one(program: &Program) -> Tested {
    let disk = Disk::for_main(Path::new(&program.path));
    let made = match &program.sidecar {
        None => Ok(golden::make(&program.path, &disk, None)),
        Some(text) => {
            let (name, mut sources) = (names::sidecar(&program.path), SourceMap::default());
            let sidecar = sidecar::parse(&name, text, &mut sources).map_err(|errors| (errors, sources));
            sidecar.map(|sidecar| {
                let test = TestFile { name: &name, text, sidecar: &sidecar };
                golden::make(&program.path, &disk, Some(test))
            })
        }
    };
    Tested { program: program.clone(), made }
}

/// Test files that cannot be used, and files that cannot be read, end the run.
fn show_trouble(tested: &[Tested], messages: Messages) -> Status {
    let mut status = Status::Done;
    for one in tested {
        match &one.made {
            Err((errors, sources)) => {
                messages.show(errors, sources);
                status = Status::Trouble;
            }
            Ok(made) => {
                for made in made.iter().filter(|m| unreadable(m, &one.program)) {
                    messages.show(&made.build.diagnostics, &made.build.sources);
                    status = Status::Trouble;
                }
            }
        }
    }
    status
}

/// File trouble in a program that is a test by its own word; what its test file names belongs to that.
fn unreadable(made: &Made, program: &Program) -> bool {
    let test_file = names::sidecar(&program.path);
    let of_files = |d: &Diagnostic| {
        let placed = d.primary.as_ref().map(|p| &made.build.sources.file(p.span.file).name);
        d.severity == Severity::Error
            && build::is_trouble(d.code.id)
            && placed.is_none_or(|n| *n == test_file)
    };
    program.is_test() && made.build.diagnostics.iter().any(of_files) && !lacks_post(made)
}

/// Whether a program does not say what machine it is for.
fn lacks_post(made: &Made) -> bool {
    made.build.diagnostics.iter().any(|d| d.code.id == command::NO_POST.id)
}

/// The verdict of every test, in order, and the golden files that cannot be read: of theirs nothing can be said.
fn judge(found: &Found, tested: Vec<Tested>) -> (Run, Vec<(String, Diagnostic)>) {
    let mut run = Run::default();
    let included = included(&tested);
    let unreadable = RefCell::new(Vec::new());
    let read = |name: &str| {
        let golden = found.golden(name)?;
        golden.map_err(|error| unreadable.borrow_mut().push((name.to_owned(), error))).ok()
    };
    for one in &tested {
        let Ok(made) = &one.made else { continue };
        if let Some(why) = why_skipped(one, made, &included) {
            run.skipped.push((one.program.path.clone(), why));
            continue;
        }
        for made in made {
            run.outcomes.extend(golden::check(&one.program.path, made, &read));
            let name = names::test(&one.program.path, &made.plan.variant, "");
            run.messages.push((name, rendered(made)));
        }
    }
    let made: Vec<&str> = run.outcomes.iter().map(|o| o.golden.as_str()).collect();
    // A build with errors makes no files; that those are not made says nothing.
    let broken: Vec<&str> =
        run.outcomes.iter().filter(|o| !made_all(o)).map(|o| o.program.as_str()).collect();
    let orphan =
        |name: &&String| !made.contains(&name.as_str()) && !broken.iter().any(|p| names::may_belong(name, p));
    let orphans: Vec<Outcome> =
        found.golden_names().filter(orphan).map(|name| orphaned(name, &tested)).collect();
    run.outcomes.extend(orphans);
    (run, unreadable.into_inner())
}

fn made_all(outcome: &Outcome) -> bool {
    !matches!(outcome.verdict, Verdict::Errors | Verdict::Messages { .. })
}

fn orphaned(name: &str, tested: &[Tested]) -> Outcome {
    let program = tested.iter().map(|t| t.program.path.as_str()).find(|p| names::may_belong(name, p));
    Outcome {
        program: program.unwrap_or(name).to_owned(),
        variant: String::new(),
        post: names::post(name).unwrap_or_default().to_owned(),
        golden: name.to_owned(),
        verdict: Verdict::Orphan,
    }
}

/// Files that other programs include.
fn included(tested: &[Tested]) -> Vec<String> {
    let builds = tested.iter().filter_map(|t| t.made.as_ref().ok()).flatten();
    builds.flat_map(|m| m.build.inputs.iter().skip(1).cloned()).collect()
}

fn why_skipped(one: &Tested, made: &[Made], included: &[String]) -> Option<String> {
    if one.program.is_test() {
        return None;
    }
    let main = made.first().and_then(|m| m.build.inputs.first());
    if main.is_some_and(|m| included.contains(m)) {
        return Some("other programs include it".to_owned());
    }
    let nameless =
        made.iter().all(|m| lacks_post(m) || m.build.ir.as_ref().is_none_or(|p| p.machines.is_empty()));
    nameless.then(|| format!("it names no machine, and there is no {}", names::sidecar(&one.program.path)))
}

/// The errors and warnings of a build.
fn rendered(made: &Made) -> String {
    let serious = made.build.diagnostics.iter().filter(|d| d.severity != Severity::Note);
    serious.map(|d| render(d, &made.build.sources, Format::Human, false)).collect()
}

fn status(run: &Run) -> Status {
    let errors = run.outcomes.iter().any(|o| matches!(o.verdict, Verdict::Errors));
    match (errors, run.passed()) {
        (true, _) => Status::Errors,
        (false, false) => Status::Differs,
        (false, true) => Status::Done,
    }
}

/// Messages cannot be accepted: the test file says what is expected.
fn accepted_status(run: &Run) -> Status {
    let left = run.outcomes.iter().any(|o| matches!(o.verdict, Verdict::Messages { .. }));
    if left { Status::Differs } else { Status::Done }
}

/// Two tests with one golden file: what one accepts the other would not make.
fn refuse_clashes(run: &Run) -> Result<(), Diagnostic> {
    let mut owners: BTreeMap<&str, String> = BTreeMap::new();
    for outcome in run.outcomes.iter().filter(|o| !o.golden.is_empty()) {
        if let Some(other) = owners.insert(&outcome.golden, outcome.name()) {
            let message = format!(
                "{} would be the golden file of `{other}` and of `{}`",
                outcome.golden,
                outcome.name()
            );
            return Err(Diagnostic::global(&command::OUTPUT_CLASH, message)
                .help("give one of the programs or variants another name"));
        }
    }
    Ok(())
}

fn accept(run: &Run) -> Result<(), Diagnostic> {
    let product = |outcome: &Outcome| match &outcome.verdict {
        Verdict::New { text } | Verdict::Different { text, .. } => {
            Some(Product { path: outcome.golden.clone().into(), bytes: text.clone().into_bytes() })
        }
        _ => None,
    };
    output::write_all(&run.outcomes.iter().filter_map(product).collect::<Vec<_>>())?;
    let mut orphans = run.outcomes.iter().filter(|o| matches!(o.verdict, Verdict::Orphan));
    orphans.try_for_each(|o| output::remove(Path::new(&o.golden)))
}

fn nothing(args: &TestArgs) -> Diagnostic {
    let message = match &args.filter {
        Some(filter) => format!("no test has `{filter}` in its name"),
        None => format!("there is no program to test in {}", args.dir.display()),
    };
    Diagnostic::global(&codes::NOTHING_TO_TEST, message)
        .help("a program is a test when it names its machine (MACHIN), or has a NAME.test.toml beside it")
}
