//! `partwright plot`.

use std::path::{Path, PathBuf};

use super::args::{Picture, PlotArgs};
use super::build;
use super::disk::STDIN;
use super::messages::Messages;
use super::output::{self, Product, is_stdout};
use super::{DEFAULT_POST, Status};
use crate::diag::Diagnostic;
use crate::diag::codes::command as codes;
use crate::driver;
use crate::plot::{self, PlotError, What};

/// Compiles the program and draws it.
pub fn plot(args: &PlotArgs, messages: Messages) -> Result<Status, Diagnostic> {
    let path = destination(args);
    let form = Form::of(&path)?;
    let options = driver::Options {
        posts: args.post.iter().cloned().collect(),
        default_post: Some(DEFAULT_POST.to_owned()),
        ..build::driver_options(&args.common)?
    };
    let compiled = build::compile(core::slice::from_ref(&args.file), &options, &args.common, messages)?;
    let status = build::show(&compiled, messages);
    let Some(one) = compiled.first().filter(|_| status == Status::Done) else { return Ok(status) };
    let what = what(args);
    let output = one.build.outputs.first();
    let figure = || plot::draw_output(&what, &one.build, output);
    let bytes = match form {
        Form::Svg => figure().map(|f| f.svg().as_bytes().to_vec()),
        Form::Png => figure().and_then(|f| f.png(args.scale)),
        Form::Html => plot::page(&what, &one.build, output).map(String::into_bytes),
    };
    let bytes = bytes.map_err(|e| no_picture(&e))?;
    output::write_all(&[Product { path, bytes }])?;
    Ok(Status::Done)
}

/// Forms of pictures: drawings, and pages to be turned.
enum Form {
    Svg,
    Png,
    Html,
}

impl Form {
    fn of(path: &Path) -> Result<Form, Diagnostic> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        match extension.as_deref() {
            _ if is_stdout(path) => Ok(Form::Svg),
            Some("svg") => Ok(Form::Svg),
            Some("png") => Ok(Form::Png),
            Some("html") => Ok(Form::Html),
            _ => Err(Diagnostic::global(
                &codes::PICTURE_FORM,
                format!("{} is neither a .svg nor a .png nor a .html file", path.display()),
            )),
        }
    }
}

fn destination(args: &PlotArgs) -> PathBuf {
    if let Some(path) = &args.output {
        return path.clone();
    }
    if args.file.as_os_str() == STDIN {
        return PathBuf::from("-");
    }
    args.file.with_extension(match args.what {
        Picture::Cam => "cam.svg",
        Picture::Path => "path.svg",
        Picture::Deviation => "deviation.svg",
    })
}

fn what(args: &PlotArgs) -> What {
    match args.what {
        Picture::Cam => What::Cam(args.cam.clone()),
        Picture::Path => What::Path,
        Picture::Deviation => What::Deviation,
    }
}

fn no_picture(error: &PlotError) -> Diagnostic {
    Diagnostic::global(&codes::NO_PICTURE, error.to_string())
}
