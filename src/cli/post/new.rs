//! `partwright post new`.

use std::path::{Component, Path, PathBuf};

use super::super::Status;
use super::super::args::post::PostNewArgs;
use super::super::disk::Disk;
use super::super::messages::{Messages, to_stderr};
use super::super::output::{self, Product};
use crate::diag::Diagnostic;
use crate::diag::codes::tools as codes;
use crate::driver;
use crate::post::{self, Dialect};
use crate::source::FileProvider;

/// Writes a post that inherits from another.
pub fn new(args: &PostNewArgs, messages: Messages) -> Result<Status, Diagnostic> {
    let name = check_name(&args.name)?;
    let parent = match super::load(&args.from, &[], messages) {
        Ok((parent, _)) => parent,
        Err(status) => return Ok(status),
    };
    let path = args.name.with_file_name(format!("{name}.post.toml"));
    if path.symlink_metadata().is_ok() {
        let message = format!("{} is there already", path.display());
        return Err(Diagnostic::global(&codes::ALREADY_THERE, message).help("choose another name"));
    }
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    if let Some(folder) = folder {
        output::make_folder(folder)?;
    }
    let from = from_there(&args.from, folder);
    check_reach(&path, &from)?;
    let text = text(&name, &from, &parent);
    output::write_all(&[Product { path: path.clone(), bytes: text.into_bytes() }])?;
    if messages.for_people() {
        to_stderr(&format!("{} inherits from {}\n", path.display(), args.from));
    }
    Ok(Status::Done)
}

/// The last part of the path, which is the post's name.
fn check_name(path: &Path) -> Result<String, Diagnostic> {
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    let name = name.strip_suffix(".post.toml").unwrap_or(&name).to_owned();
    let why = if name.is_empty() {
        Some("it is empty".to_owned())
    } else if let Some(bad) = name.chars().find(|c| !(c.is_ascii_alphanumeric() || "-_".contains(*c))) {
        Some(format!("it holds `{}`", bad.escape_default()))
    } else if post::builtin_text(&name).is_some() {
        Some("it is the name of a built-in post".to_owned())
    } else {
        None
    };
    match why {
        None => Ok(name),
        Some(why) => {
            let message = format!("`{}` is no name for a post: {why}", name.escape_default());
            Err(Diagnostic::global(&codes::BAD_NAME, message).help("use letters, digits, `-` and `_`"))
        }
    }
}

/// A post file may inherit only from files of its own project.
fn check_reach(path: &Path, from: &str) -> Result<(), Diagnostic> {
    if post::builtin_text(from).is_some() {
        return Ok(());
    }
    let read = Disk::for_main(path).read(Some(&path.to_string_lossy()), from);
    read.map(|_| ()).map_err(|error| driver::unreadable(from, &error))
}

/// The parent as the new file names it: post files name others relative to themselves.
fn from_there(from: &str, folder: Option<&Path>) -> String {
    let (Some(folder), true) = (folder, from.ends_with(".toml") && Path::new(from).is_relative()) else {
        return from.to_owned();
    };
    let back = folder.components().filter(|c| matches!(c, Component::Normal(_))).map(|_| "..");
    let path: PathBuf = back.map(PathBuf::from).chain([PathBuf::from(from)]).collect();
    path.to_string_lossy().replace('\\', "/")
}

fn text(name: &str, from: &str, parent: &Dialect) -> String {
    let quoted = |text: &str| toml::Value::String(text.to_owned()).to_string();
    let title = quoted(&format!("{name}, after {}", parent.title()));
    let basis = quoted(&format!("inherits from {}; not yet checked on the machine", parent.name()));
    format!(
        "# Say here only what is different from {parent}. All keys and their values, with the places they come from:\n\
         #   partwright post show {from} --resolved\n\
         # When something was changed:\n\
         #   partwright post check {name}.post.toml\n\
         inherits = {inherits}\n\n\
         [post]\ntitle = {title}\nconfidence = \"published\"\nbasis = {basis}\n",
        parent = parent.name(),
        inherits = quoted(from),
    )
}
