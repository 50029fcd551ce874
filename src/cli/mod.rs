//! The `partwright` command: the only part that touches files, the terminal and the environment.

use std::process::ExitCode;

use clap::Parser;

use crate::diag::Diagnostic;

mod args;
mod build;
mod deps;
mod diff;
pub mod disk;
mod explain;
mod export;
mod messages;
mod new;
mod output;
mod plot;
mod post;
mod progress;
mod report;
mod schema;
mod source_map;
mod staging;
mod temporary;
mod test;

use args::{Cli, Verb};
use messages::Messages;

/// The controller of pictures and pages when nothing names one.
const DEFAULT_POST: &str = "linuxcnc";

/// How a run ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Status {
    /// Done.
    Done = 0,
    /// The program has errors.
    Errors = 1,
    /// Usage, configuration or file trouble.
    Trouble = 2,
    /// A golden file, or the other program of a comparison, differs.
    Differs = 3,
    /// Verification found something.
    NotProven = 4,
    /// Our own fault.
    Fault = 101,
}

impl From<Status> for ExitCode {
    fn from(status: Status) -> Self {
        ExitCode::from(status as u8)
    }
}

/// Runs the command line of this process.
#[must_use]
pub fn run() -> ExitCode {
    let status = guarded(|| match Cli::try_parse() {
        Ok(cli) => dispatch(&cli),
        Err(error) => usage(&error),
    });
    status.into()
}

/// How `work` ends; when it panics, [`Status::Fault`], with a request to report it on standard error.
#[must_use]
pub fn guarded(work: impl FnOnce() -> Status + std::panic::UnwindSafe) -> Status {
    std::panic::set_hook(Box::new(|info| messages::to_stderr(&fault(info))));
    std::panic::catch_unwind(work).unwrap_or(Status::Fault)
}

/// The message for a panic.
fn fault(info: &std::panic::PanicHookInfo<'_>) -> String {
    let payload = info.payload();
    let text = payload.downcast_ref::<&str>().map(|s| (*s).to_owned());
    let text = text.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_default();
    let place = info.location().map_or_else(String::new, |l| format!(" at {}:{}", l.file(), l.line()));
    format!(
        "partwright {} has failed: this is a fault of partwright, not of your program.\n  {text}{place}\n\
         Please report it with the program that caused it. Nothing was written.\n",
        env!("CARGO_PKG_VERSION")
    )
}

/// Help and version go to standard output, mistakes to standard error.
fn usage(error: &clap::Error) -> Status {
    // Nobody is left to tell when the terminal is gone.
    let _ = error.print();
    if error.use_stderr() { Status::Trouble } else { Status::Done }
}

fn dispatch(cli: &Cli) -> Status {
    let messages = Messages::of(cli);
    let result = match &cli.verb {
        Verb::Build(args) => build::build(args, messages),
        Verb::Cl(args) => build::cl(args, messages),
        Verb::Check(args) => build::check(args, messages),
        Verb::Explain(args) => explain::explain(args.code.as_deref()).and_then(|page| print(&page)),
        Verb::Export(args) => export::export(args, messages),
        Verb::Plot(args) => plot::plot(args, messages),
        Verb::Test(args) => test::test(args, messages),
        Verb::Diff(args) => diff::diff(args, messages),
        Verb::New(args) => new::new(args, messages),
        Verb::Post(args) => post::post(&args.verb, messages),
        Verb::Schema(args) => print(&schema::text(args.of)),
    };
    result.unwrap_or_else(|diagnostic| {
        messages.global(&diagnostic);
        Status::Trouble
    })
}

/// Prints data to standard output.
fn print(text: &str) -> Result<Status, Diagnostic> {
    output::write_all(&[output::Product { path: "-".into(), bytes: text.as_bytes().to_vec() }])?;
    Ok(Status::Done)
}
