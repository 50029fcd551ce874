//! Programs, their test files and golden files below a directory.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use super::super::disk::{LARGEST, LARGEST_CL, reason};
use crate::clfile;
use crate::diag::Diagnostic;
use crate::diag::codes::command as codes;
use crate::golden::names;

/// Extension of programs in the language; CL files are known by theirs.
const PROGRAM: &str = "apt";
/// Directories that hold no programs.
const LEFT_OUT: &[&str] = &["target", "node_modules"];
/// Directories below one another at most.
const DEEPEST: u32 = 64;

/// A program.
#[derive(Debug, Clone)]
pub struct Program {
    /// Where it is, with `/` between the parts.
    pub path: String,
    /// The text of its test file.
    pub sidecar: Option<String>,
    /// Whether there are golden files of it.
    pub accepted: bool,
}

impl Program {
    /// Whether it is meant as a test, whatever it says itself.
    pub fn is_test(&self) -> bool {
        self.sidecar.is_some() || self.accepted
    }
}

/// What there is.
#[derive(Debug, Default)]
pub struct Found {
    /// By path.
    pub programs: Vec<Program>,
    golden: BTreeMap<String, PathBuf>,
}

impl Found {
    /// The text of a golden file, when there is one.
    pub fn golden(&self, name: &str) -> Option<Result<String, Diagnostic>> {
        let path = self.golden.get(name)?;
        // What is not text differs from every text.
        Some(limited(path, LARGEST_CL).map(|bytes| String::from_utf8_lossy(&bytes).into_owned()))
    }

    /// Names of all golden files, in order.
    pub fn golden_names(&self) -> impl Iterator<Item = &String> {
        self.golden.keys()
    }
}

/// Looks through a directory, or takes one program.
pub fn find(start: &Path) -> Result<Found, Diagnostic> {
    let mut files = Vec::new();
    let only = (!start.is_dir()).then_some(start);
    match only {
        Some(program) => walk(parent(program), 0, &mut files)?,
        None => walk(start, DEEPEST, &mut files)?,
    }
    files.sort();
    let mut found = Found::default();
    for file in files.iter().filter(|f| names::is_golden(&file_name(f))) {
        found.golden.insert(name(file), file.clone());
    }
    let is_program = |path: &Path| match only {
        Some(only) => path.file_name() == only.file_name(),
        None if names::is_golden(&file_name(path)) => false,
        None => {
            extension(path).is_some_and(|e| e == PROGRAM) || clfile::recognise(&file_name(path), "").is_some()
        }
    };
    for file in files.iter().filter(|f| is_program(f)) {
        let path = name(file);
        let accepted = found.golden.keys().any(|golden| names::may_belong(golden, &path));
        found.programs.push(Program { sidecar: sidecar(&path)?, path, accepted });
    }
    if let Some(only) = only {
        if found.programs.is_empty() {
            let message = format!("there is no file {}", only.display());
            return Err(Diagnostic::global(&codes::CANNOT_READ, message));
        }
        found.golden.retain(|golden, _| found.programs.iter().any(|p| names::may_belong(golden, &p.path)));
    }
    Ok(found)
}

fn parent(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn walk(folder: &Path, depth: u32, files: &mut Vec<PathBuf>) -> Result<(), Diagnostic> {
    let entries = fs::read_dir(folder).map_err(|e| unreadable(folder, &e))?;
    for entry in entries {
        let entry = entry.map_err(|e| unreadable(folder, &e))?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if name.starts_with('.') {
            continue;
        }
        // Links to directories are not followed: they could lead in a circle.
        let kind = entry.file_type().map_err(|e| unreadable(&entry.path(), &e))?;
        if kind.is_dir() {
            if depth > 0 && !LEFT_OUT.contains(&name.as_str()) {
                walk(&entry.path(), depth - 1, files)?;
            }
        } else {
            files.push(entry.path());
        }
    }
    Ok(())
}

fn sidecar(program: &str) -> Result<Option<String>, Diagnostic> {
    let path = PathBuf::from(names::sidecar(program));
    if fs::symlink_metadata(&path).is_err() {
        return Ok(None);
    }
    let text = String::from_utf8(limited(&path, LARGEST)?).map_err(|_| {
        Diagnostic::global(&codes::NOT_UTF8, format!("{} is not UTF-8", path.display()))
            .help("save the file as UTF-8")
    })?;
    Ok(Some(text))
}

/// The bytes of a file; pipes and the like are none.
fn limited(path: &Path, largest: u64) -> Result<Vec<u8>, Diagnostic> {
    let metadata = fs::metadata(path).map_err(|e| unreadable(path, &e))?;
    if !metadata.is_file() {
        let message = format!("{} cannot be read: it is no file", path.display());
        return Err(Diagnostic::global(&codes::CANNOT_READ, message));
    }
    if metadata.len() > largest {
        let message = format!("{} has more than {largest} bytes", path.display());
        return Err(Diagnostic::global(&codes::TOO_LARGE, message));
    }
    fs::read(path).map_err(|e| unreadable(path, &e))
}

fn unreadable(path: &Path, error: &std::io::Error) -> Diagnostic {
    let message = format!("{} cannot be read: {}", path.display(), reason(error));
    Diagnostic::global(&codes::CANNOT_READ, message)
}

fn file_name(path: &Path) -> String {
    path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default()
}

fn extension(path: &Path) -> Option<String> {
    path.extension().map(|e| e.to_string_lossy().to_lowercase())
}

/// The path as tests name it: `/` between the parts, no `./` before it.
fn name(path: &Path) -> String {
    let path = path.strip_prefix(".").unwrap_or(path);
    path.to_string_lossy().replace('\\', "/")
}
