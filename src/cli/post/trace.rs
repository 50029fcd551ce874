//! `partwright post trace`.

use std::path::PathBuf;

use super::super::args::post::PostTraceArgs;
use super::super::build::{self, Compiled};
use super::super::disk::STDIN;
use super::super::messages::{Messages, to_stderr};
use super::super::output::{self, Product, is_stdout};
use super::super::{DEFAULT_POST, Status};
use crate::diag::Diagnostic;
use crate::driver::{self, Output};
use crate::trace_page;

/// Compiles the program and writes the page of its first output.
pub fn trace(args: &PostTraceArgs, messages: Messages) -> Result<Status, Diagnostic> {
    let options = driver::Options {
        posts: args.post.iter().cloned().collect(),
        post_set: args.overrides.pairs()?,
        default_post: Some(DEFAULT_POST.to_owned()),
        ..build::driver_options(&args.common)?
    };
    let compiled = build::compile(core::slice::from_ref(&args.file), &options, &args.common, messages)?;
    let status = build::show(&compiled, messages);
    let first = compiled.first().and_then(|one| Some((one, one.build.outputs.first()?)));
    let Some((one, output)) = first.filter(|_| status == Status::Done) else { return Ok(status) };
    let Some(page) = trace_page::page(&one.build, output) else { return Ok(status) };
    let path = destination(args, one, output);
    build::refuse_source(&path, &one.build)?;
    output::write_all(&[Product { path: path.clone(), bytes: page.into_bytes() }])?;
    if messages.for_people() && !is_stdout(&path) {
        to_stderr(&format!("{}: open it in a browser\n", path.display()));
    }
    Ok(Status::Done)
}

fn destination(args: &PostTraceArgs, one: &Compiled, output: &Output) -> PathBuf {
    if let Some(path) = &args.output {
        return path.clone();
    }
    let file = format!("{}.{}.html", one.stem(), output.post);
    if args.file.as_os_str() == STDIN { PathBuf::from(file) } else { args.file.with_file_name(file) }
}
