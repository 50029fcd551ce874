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
    write_with(Vec::new(), products)
}

/// The same, together with what has been staged before.
pub fn write_with(mut staged: Vec<Staged>, products: &[Product]) -> Result<(), Diagnostic> {
    for product in products.iter().filter(|p| !is_stdout(&p.path)) {
        let file = stage(&product.path, &product.bytes, Beside::Target);
        staged.push(file.map_err(|error| unwritable(&product.path, &error))?);
    }
    for file in &staged {
        file.may_commit().map_err(|error| unwritable(&file.target, &error))?;
    }
    for mut file in staged {
        file.commit().map_err(|error| unwritable(&file.target, &error))?;
    }
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

/// A complete file under a temporary name; no temporary name for devices and pipes, which are written at once, and for
/// what has its name. The temporary file goes with this value.
#[derive(Debug)]
pub struct Staged {
    target: PathBuf,
    temporary: Option<PathBuf>,
}

impl Staged {
    /// Whether the directory is there by now; one that is not would leave some files renamed and some not.
    fn may_commit(&self) -> io::Result<()> {
        match self.target.parent().filter(|p| !p.as_os_str().is_empty()) {
            Some(folder) => fs::metadata(folder).map(|_| ()),
            None => Ok(()),
        }
    }

    fn commit(&mut self) -> io::Result<()> {
        if let Some(temporary) = &self.temporary {
            fs::rename(temporary, &self.target)?;
        }
        self.temporary = None;
        Ok(())
    }
}

impl Drop for Staged {
    fn drop(&mut self) {
        if let Some(temporary) = &self.temporary {
            // Nothing can be done about a temporary file that will not go away.
            let _ = fs::remove_file(temporary);
        }
    }
}

/// Where a temporary file is made.
#[derive(Clone, Copy)]
enum Beside {
    Target,
    /// In the nearest directory above the target that is there: the target's own may be made later.
    NearestFolder,
}

fn stage(path: &Path, bytes: &[u8], beside: Beside) -> io::Result<Staged> {
    let old = fs::metadata(path).ok();
    if old.as_ref().is_some_and(fs::Metadata::is_dir) {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a directory"));
    }
    if old.as_ref().is_some_and(|m| !m.is_file()) {
        File::options().write(true).open(path)?.write_all(bytes)?;
        return Ok(Staged { target: path.to_path_buf(), temporary: None });
    }
    // A link is kept: what it points to is replaced.
    let target = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    let temporary = temporary_name(&target, beside)?;
    let mut file = File::options().write(true).create_new(true).open(&temporary)?;
    let staged = Staged { target, temporary: Some(temporary) };
    file.write_all(bytes)?;
    if let Some(old) = old {
        file.set_permissions(old.permissions())?;
    }
    Ok(staged)
}

fn temporary_name(target: &Path, beside: Beside) -> io::Result<PathBuf> {
    let name = target
        .file_name()
        .ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "it has no file name"))?;
    let mut hidden = std::ffi::OsString::from(".");
    hidden.push(name);
    hidden.push(format!(".{}.tmp", std::process::id()));
    let beside_target = target.with_file_name(hidden.clone());
    match beside {
        Beside::Target => Ok(beside_target),
        Beside::NearestFolder => {
            // Above a relative path's first directory is the working directory.
            let here = |f: &Path| f.as_os_str().is_empty() || f.is_dir();
            let folder = target.ancestors().skip(1).find(|f| here(f));
            Ok(folder.map_or(beside_target, |folder| folder.join(hidden)))
        }
    }
}
