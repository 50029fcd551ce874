//! `partwright plot`.

use super::Status;
use super::args::PlotArgs;
use super::build;
use super::messages::Messages;
use crate::diag::Diagnostic;
use crate::driver;

/// Compiles the program and draws it.
pub fn plot(args: &PlotArgs, messages: Messages) -> Result<Status, Diagnostic> {
    let options = driver::Options { check_only: true, ..build::driver_options(&args.common)? };
    let compiled = build::compile(core::slice::from_ref(&args.file), &options, &args.common, messages)?;
    Ok(build::show(&compiled, messages))
}
