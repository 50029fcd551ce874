//! Files on disk, as the compiler may read them.
//!
//! A program may read files of its project only: below the nearest directory with a `partwright.toml` or a
//! `.git` above the main file, or else below the main file's directory. Links are followed before the check.
//! What the command line names (`from` is `None`) may lie anywhere.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Component, Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use crate::source::{FileError, FileProvider, decode};

/// The largest file that is read, bytes.
pub const LARGEST: u64 = 64 * 1024 * 1024;
/// The largest CL file, bytes; places in it are counted in 32 bits.
pub const LARGEST_CL: u64 = 4_000_000_000;
/// The largest file of a CAD system, bytes.
pub const LARGEST_CAD: u64 = 512 * 1024 * 1024;
/// The name of standard input on the command line.
pub const STDIN: &str = "-";
/// Its name in messages.
const STDIN_NAME: &str = "<stdin>";

/// The files that one program may read.
#[derive(Debug)]
pub struct Disk {
    root: PathBuf,
    /// Names in messages by real path: the same file has the same name however it is reached.
    names: Mutex<BTreeMap<PathBuf, String>>,
}

impl Disk {
    /// For the program in `main`.
    #[must_use]
    pub fn for_main(main: &Path) -> Self {
        let folder = main.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
        let marked = |p: &&Path| p.join("partwright.toml").is_file() || p.join(".git").exists();
        let root = folder.ancestors().find(marked).unwrap_or(&folder).to_path_buf();
        Disk { root, names: Mutex::default() }
    }

    /// Name and bytes of a file that `from` names.
    fn bytes(&self, from: Option<&str>, path: &str, largest: u64) -> Result<(String, Vec<u8>), FileError> {
        let folder = from.and_then(|f| Path::new(f).parent()).unwrap_or(Path::new(""));
        let path = folder.join(path);
        let real = path.canonicalize().map_err(|e| system(&e))?;
        if from.is_some() && !real.starts_with(&self.root) {
            return Err(FileError::OutsideRoot);
        }
        if real.is_dir() {
            return Err(FileError::Other("it is a directory".to_owned()));
        }
        let file = std::fs::File::open(&real).map_err(|e| system(&e))?;
        Ok((self.display_name(real, &path), read_limited(file, largest)?))
    }

    fn display_name(&self, real: PathBuf, path: &Path) -> String {
        let mut names = self.names.lock().unwrap_or_else(PoisonError::into_inner);
        names.entry(real).or_insert_with(|| tidy(path)).clone()
    }
}

impl FileProvider for Disk {
    fn read(&self, from: Option<&str>, path: &str) -> Result<(String, String), FileError> {
        if from.is_none() && path == STDIN {
            let text = decode(read_limited(std::io::stdin().lock(), LARGEST)?)?;
            return Ok((STDIN_NAME.to_owned(), text));
        }
        let (name, bytes) = self.bytes(from, path, LARGEST)?;
        Ok((name, decode(bytes)?))
    }

    fn read_cad(&self, from: Option<&str>, path: &str) -> Result<(String, String), FileError> {
        let (name, bytes) = self.bytes(from, path, LARGEST_CAD)?;
        Ok((name, decode_anyhow(bytes)))
    }

    fn read_cl(&self, path: &str) -> Result<(String, String), FileError> {
        if path == STDIN {
            return Ok((
                STDIN_NAME.to_owned(),
                decode_anyhow(read_limited(std::io::stdin().lock(), LARGEST_CL)?),
            ));
        }
        let path = Path::new(path);
        let real = path.canonicalize().map_err(|e| system(&e))?;
        if real.is_dir() {
            return Err(FileError::Other("it is a directory".to_owned()));
        }
        let file = std::fs::File::open(&real).map_err(|e| system(&e))?;
        let text = decode_anyhow(read_limited(file, LARGEST_CL)?);
        Ok((self.display_name(real, path), text))
    }
}

fn read_limited(source: impl Read, largest: u64) -> Result<Vec<u8>, FileError> {
    let mut bytes = Vec::new();
    source.take(largest + 1).read_to_end(&mut bytes).map_err(|e| system(&e))?;
    if bytes.len() as u64 > largest {
        return Err(FileError::TooLarge(largest));
    }
    Ok(bytes)
}

/// UTF-16 by its mark; of the rest, bytes that are not UTF-8 become replacement characters.
fn decode_anyhow(bytes: Vec<u8>) -> String {
    let wide = |rest: &[u8], unit: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = rest.as_chunks::<2>().0.iter().map(|pair| unit(*pair)).collect();
        String::from_utf16_lossy(&units)
    };
    match bytes.as_slice() {
        [0xff, 0xfe, rest @ ..] => return wide(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => return wide(rest, u16::from_be_bytes),
        _ => {}
    }
    String::from_utf8(bytes).unwrap_or_else(|e| String::from_utf8_lossy(e.as_bytes()).into_owned())
}

fn system(error: &std::io::Error) -> FileError {
    match error.kind() {
        std::io::ErrorKind::NotFound => FileError::NotFound,
        _ => FileError::Other(reason(error)),
    }
}

/// The system's words without its error number.
pub(super) fn reason(error: &std::io::Error) -> String {
    let text = error.to_string();
    match text.find(" (os error") {
        Some(end) => text.get(..end).unwrap_or(&text).to_owned(),
        None => text,
    }
}

/// A path without `.` and without `x/..`, with `/` between its parts.
fn tidy(path: &Path) -> String {
    let mut parts: Vec<Component<'_>> = Vec::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if matches!(parts.last(), Some(Component::Normal(_))) => drop(parts.pop()),
            part => parts.push(part),
        }
    }
    parts.iter().collect::<PathBuf>().to_string_lossy().replace('\\', "/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_other_systems_are_read_whatever_their_encoding() {
        let text = "GOTO/ 1, 2, 3\n";
        let wide = |unit: fn(u16) -> [u8; 2]| {
            "\u{feff}GOTO/ 1, 2, 3\n".encode_utf16().flat_map(unit).collect::<Vec<u8>>()
        };
        assert_eq!(decode_anyhow(wide(u16::to_le_bytes)), text);
        assert_eq!(decode_anyhow(wide(u16::to_be_bytes)), text);
        assert_eq!(decode_anyhow(text.into()), text);
        assert_eq!(decode_anyhow(b"Geh\xe4use".to_vec()), "Geh\u{fffd}use");
    }

    #[test]
    fn names_are_tidied() {
        assert_eq!(tidy(Path::new("./a/../b/./c.apt")), "b/c.apt");
        assert_eq!(tidy(Path::new("../x.apt")), "../x.apt");
    }
}
