//! The one place that writes files: whole, and only when everything has been made.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::disk::reason;
use super::temporary::{Beside, commit, stage};
use crate::diag::Diagnostic;
use crate::diag::codes::command as codes;

pub use super::temporary::Staged;

/// A file to be written.
#[derive(Debug)]
pub struct Product {
    /// Where; `-` is standard output.
    pub path: PathBuf,
    /// What.
    pub bytes: Vec<u8>,
}

/// Whether a path means standard output.
pub fn is_stdout(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Makes a directory and those above it.
pub fn make_folder(folder: &Path) -> Result<(), Diagnostic> {
    fs::create_dir_all(folder).map_err(|error| {
        let message = format!("{} cannot be made: {}", folder.display(), reason(&error));
        Diagnostic::global(&codes::CANNOT_WRITE, message)
    })
}

/// Removes a file.
pub fn remove(path: &Path) -> Result<(), Diagnostic> {
    fs::remove_file(path).map_err(|error| {
        let message = format!("{} cannot be removed: {}", path.display(), reason(&error));
        Diagnostic::global(&codes::CANNOT_WRITE, message)
    })
}

/// Writes all products: each to a new file beside its target, and when all are complete they are renamed.
/// When one cannot be written the old files are as they were.
pub fn write_all(products: &[Product]) -> Result<(), Diagnostic> {
    write_with(Vec::new(), products)
}

/// The same, together with what has been staged before.
pub fn write_with(mut staged: Vec<Staged>, products: &[Product]) -> Result<(), Diagnostic> {
    for product in products.iter().filter(|p| !is_stdout(&p.path)) {
        let file = stage(&product.path, &product.bytes, Beside::Target);
        staged.push(file.map_err(|error| unwritable(&product.path, &error))?);
    }
    commit(staged).map_err(|(path, error)| unwritable(&path, &error))?;
    for product in products.iter().filter(|p| is_stdout(&p.path)) {
        to_stdout(&product.bytes).map_err(|e| unwritable(&product.path, &e))?;
    }
    Ok(())
}

/// Stages a file before all that it belongs to has been made; `None` for what is no file (standard output, devices), and
/// where it cannot be done.
pub fn stage_early(path: &Path, bytes: &[u8]) -> Option<Staged> {
    let other = fs::metadata(path).is_ok_and(|old| !old.is_file());
    if is_stdout(path) || other {
        return None;
    }
    stage(path, bytes, Beside::NearestFolder).ok()
}

/// Writes to standard output; a reader that has gone away is no error.
pub fn to_stdout(bytes: &[u8]) -> io::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(e) if e.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result,
    }
}

fn unwritable(path: &Path, error: &io::Error) -> Diagnostic {
    let message = format!("{} cannot be written: {}", path.display(), reason(error));
    Diagnostic::global(&codes::CANNOT_WRITE, message)
}
