//! `partwright export`: a net of a program as a file for CAD systems.

use std::path::Path;

use super::args::ExportArgs;
use super::build;
use super::messages::Messages;
use super::output::{self, Product};
use super::{Status, args};
use crate::cad::{step, stl};
use crate::diag::Diagnostic;
use crate::diag::codes::command as codes;
use crate::driver;
use crate::geom::surface::grid::Grid;
use crate::ir::{NetEntity, Program};

/// Evaluates the program and writes one of its nets.
pub fn export(args: &ExportArgs, messages: Messages) -> Result<Status, Diagnostic> {
    let form = Form::of(&args.output)?;
    let options = driver::Options { check_only: true, ..build::driver_options(&args.common)? };
    let compiled = build::compile(core::slice::from_ref(&args.file), &options, &args.common, messages)?;
    let status = build::show(&compiled, messages);
    let program = compiled.first().and_then(|one| one.build.ir.as_ref());
    let Some(program) = program.filter(|_| status == Status::Done) else { return Ok(status) };
    let bytes = bytes(form, choose(program, args)?, args.tolerance)?;
    output::write_all(&[Product { path: args.output.clone(), bytes }])?;
    Ok(Status::Done)
}

/// Forms of files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    Step,
    Stl,
}

impl Form {
    fn of(path: &Path) -> Result<Form, Diagnostic> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        match extension.as_deref() {
            Some("stp" | "step") => Ok(Form::Step),
            Some("stl") => Ok(Form::Stl),
            _ => {
                let message = format!("{} is neither a .stp, .step nor a .stl file", path.display());
                Err(Diagnostic::global(&codes::EXPORT_FORM, message))
            }
        }
    }
}

/// The net that is meant.
fn choose<'p>(program: &'p Program, args: &args::ExportArgs) -> Result<&'p NetEntity, Diagnostic> {
    let fail = |message: String| Diagnostic::global(&codes::NO_EXPORT, message);
    let nets: Vec<&NetEntity> = program.nets.iter().map(|(_, n)| n).filter(|n| n.declared).collect();
    let names = || nets.iter().map(|n| n.name.as_str()).collect::<Vec<_>>().join(", ");
    match (&args.net, nets.as_slice()) {
        (_, []) => Err(fail("the program has no net".into())),
        (None, [only]) => Ok(only),
        (None, more) => Err(fail(format!("the program has {} nets: {}", more.len(), names()))
            .help(format!("name one: --net {}", more.first().map_or("", |n| n.name.as_str())))),
        // Of a name that was given twice, in a loop for instance, the last.
        (Some(name), nets) => match nets.iter().rev().find(|n| n.name.eq_ignore_ascii_case(name)) {
            Some(net) => Ok(net),
            None => Err(fail(format!("the program has no net {name}; it has {}", names()))),
        },
    }
}

fn bytes(form: Form, net: &NetEntity, tolerance: f64) -> Result<Vec<u8>, Diagnostic> {
    if form == Form::Step {
        return Ok(step::write(&net.name, &Grid::of(&net.net)).into_bytes());
    }
    let fail = |message: String| Diagnostic::global(&codes::NO_EXPORT, message);
    if tolerance.is_nan() || tolerance <= 0.0 {
        return Err(fail(format!("--tolerance {tolerance}: it must be over 0")));
    }
    stl::write(&net.net, tolerance).map_err(|stl::TooFine| {
        fail(format!(
            "--tolerance {tolerance}: {} would take more than {} triangles",
            net.name,
            stl::MOST_TRIANGLES
        ))
        .help("give a larger tolerance, or export STEP, which is exact")
    })
}
