//! What several test programs need.
#![allow(dead_code)]

pub mod schema;
pub mod scratch;

use std::path::{Path, PathBuf};

use partwright::source::{FileError, FileProvider};

/// A program of two points, which every control can do.
pub const POINTS: &str = "\
PARTNO points
T1 = CUTTER/ FLAT, 16, NUMBER, 1
LOADTL/ T1
SPINDL/ 1200, CLW
FEDRAT/ 300
RAPID
GOTO/ 0, 0, 5
GOTO/ 10, 0, 5
FINI
";

/// A digest that tells texts apart.
pub fn fnv1a(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// The files of one directory, named relative to it.
pub struct Directory(pub PathBuf);

impl FileProvider for Directory {
    fn read(&self, from: Option<&str>, path: &str) -> Result<(String, String), FileError> {
        let folder = from.and_then(|f| Path::new(f).parent()).unwrap_or(Path::new(""));
        let name = folder.join(path);
        let bytes = std::fs::read(self.0.join(&name)).map_err(|_| FileError::NotFound)?;
        let text = partwright::source::decode(bytes)?;
        Ok((name.to_string_lossy().into_owned(), text))
    }
}

/// All files below `folder` with the extension, in order, those whose name starts with `_` left out.
pub fn find(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let Ok(entries) = std::fs::read_dir(folder) else { return found };
    for entry in entries.filter_map(Result::ok) {
        let path = entry.path();
        let hidden = entry.file_name().to_string_lossy().starts_with('_');
        if path.is_dir() {
            found.extend(find(&path, extension));
        } else if !hidden && path.extension().is_some_and(|e| e == extension) {
            found.push(path);
        }
    }
    found.sort();
    found
}
