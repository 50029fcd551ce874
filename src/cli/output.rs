//! The one place that writes files: whole, and only when everything has been made.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::disk::reason;
use crate::diag::Diagnostic;
use crate::diag::codes::command as codes;

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
    let mut staged = Vec::new();
    for product in products.iter().filter(|p| !is_stdout(&p.path)) {
        match stage(product) {
            Ok(file) => staged.push(file),
            Err(error) => {
                staged.iter().for_each(Staged::discard);
                return Err(unwritable(&product.path, &error));
            }
        }
    }
    for (index, file) in staged.iter().enumerate() {
        if let Err(error) = file.commit() {
            staged.iter().skip(index).for_each(Staged::discard);
            return Err(unwritable(&file.target, &error));
        }
    }
    for product in products.iter().filter(|p| is_stdout(&p.path)) {
        to_stdout(&product.bytes).map_err(|e| unwritable(&product.path, &e))?;
    }
    Ok(())
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

/// A complete file under a temporary name; no temporary name for devices and pipes, which are written at once.
struct Staged {
    target: PathBuf,
    temporary: Option<PathBuf>,
}

impl Staged {
    fn commit(&self) -> io::Result<()> {
        self.temporary.as_ref().map_or(Ok(()), |t| fs::rename(t, &self.target))
    }

    fn discard(&self) {
        if let Some(temporary) = &self.temporary {
            // Nothing can be done about a temporary file that will not go away.
            let _ = fs::remove_file(temporary);
        }
    }
}

fn stage(product: &Product) -> io::Result<Staged> {
    let old = fs::metadata(&product.path).ok();
    if old.as_ref().is_some_and(fs::Metadata::is_dir) {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a directory"));
    }
    if old.as_ref().is_some_and(|m| !m.is_file()) {
        File::options().write(true).open(&product.path)?.write_all(&product.bytes)?;
        return Ok(Staged { target: product.path.clone(), temporary: None });
    }
    // A link is kept: what it points to is replaced.
    let target = product.path.canonicalize().unwrap_or_else(|_| product.path.clone());
    let temporary = temporary_name(&target)?;
    let staged = Staged { target, temporary: Some(temporary.clone()) };
    let written = File::options().write(true).create_new(true).open(&temporary).and_then(|mut file| {
        file.write_all(&product.bytes)?;
        old.map_or(Ok(()), |m| file.set_permissions(m.permissions()))
    });
    if let Err(error) = written {
        staged.discard();
        return Err(error);
    }
    Ok(staged)
}

fn temporary_name(target: &Path) -> io::Result<PathBuf> {
    let name = target
        .file_name()
        .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "it has no file name"))?;
    let mut hidden = std::ffi::OsString::from(".");
    hidden.push(name);
    hidden.push(format!(".{}.tmp", std::process::id()));
    Ok(target.with_file_name(hidden))
}
