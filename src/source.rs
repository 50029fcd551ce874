//! Source files, byte spans and the trait through which the compiler reads files.
//!
//! The core never touches the file system: it asks a [`FileProvider`].

use std::collections::BTreeMap;
use std::sync::Arc;

/// Handle of a file in a [`SourceMap`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
pub struct FileId(pub u32);

/// A byte range of one source file, end exclusive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
pub struct Span {
    /// The file.
    pub file: FileId,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Span {
    /// The span `start..end` of `file`.
    #[must_use]
    pub fn new(file: FileId, start: usize, end: usize) -> Self {
        let clamp = |v: usize| u32::try_from(v).unwrap_or(u32::MAX);
        Span { file, start: clamp(start), end: clamp(end) }
    }
    /// The smallest span that holds both; `other` must be of the same file.
    #[must_use]
    pub fn to(self, other: Span) -> Span {
        Span { file: self.file, start: self.start.min(other.start), end: self.end.max(other.end) }
    }
    /// The bytes as a `usize` range.
    #[must_use]
    pub fn range(self) -> core::ops::Range<usize> {
        self.start as usize..self.end as usize
    }
}

/// One file: its name as the user would write it, and its text.
#[derive(Debug, Clone)]
pub struct SourceFile {
    /// Display name, relative where the user gave a relative path.
    pub name: String,
    /// The text; at most 4 GiB.
    pub text: Arc<str>,
    line_starts: Vec<u32>,
}

impl SourceFile {
    /// Line and column, both from 1; columns count characters, not bytes.
    #[must_use]
    pub fn line_column(&self, byte: u32) -> (usize, usize) {
        let line = self.line_starts.partition_point(|&s| s <= byte).saturating_sub(1);
        let start = self.line_starts[line] as usize;
        let byte = (byte as usize).min(self.text.len());
        let column = self.text.get(start..byte).map_or(byte - start, |t| t.chars().count());
        (line + 1, column + 1)
    }
    /// Byte offset at which line `line` (from 1) starts, if there is one.
    #[must_use]
    pub fn line_start(&self, line: usize) -> Option<u32> {
        self.line_starts.get(line.checked_sub(1)?).copied()
    }
}

/// All source files of one compilation.
#[derive(Debug, Clone, Default)]
pub struct SourceMap {
    files: Vec<SourceFile>,
}

impl SourceMap {
    /// Adds a file and returns its handle.
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<Arc<str>>) -> FileId {
        let text: Arc<str> = text.into();
        let bytes = text.as_bytes();
        // LF, CR LF, or CR alone.
        let ends = |i: usize, b: u8| b == b'\n' || b == b'\r' && bytes.get(i + 1) != Some(&b'\n');
        let starts = text.bytes().enumerate().filter(|&(i, b)| ends(i, b));
        let line_starts = core::iter::once(0)
            .chain(starts.map(|(i, _)| u32::try_from(i + 1).unwrap_or(u32::MAX)))
            .collect();
        self.files.push(SourceFile { name: name.into(), text, line_starts });
        FileId(u32::try_from(self.files.len() - 1).unwrap_or(u32::MAX))
    }
    /// The file behind a handle that this map gave out.
    #[must_use]
    pub fn file(&self, id: FileId) -> &SourceFile {
        &self.files[id.0 as usize]
    }
    /// The text of a span (empty if the span is not on character boundaries).
    #[must_use]
    pub fn text(&self, span: Span) -> &str {
        self.file(span.file).text.get(span.range()).unwrap_or("")
    }
    /// All files, in the order they were added.
    pub fn iter(&self) -> impl Iterator<Item = (FileId, &SourceFile)> {
        self.files.iter().enumerate().map(|(i, f)| (FileId(u32::try_from(i).unwrap_or(u32::MAX)), f))
    }
}

/// Why a file could not be had.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FileError {
    /// No such file.
    NotFound,
    /// The path leaves the project's root.
    OutsideRoot,
    /// The bytes are not UTF-8; the first bad one.
    NotUtf8(BadByte),
    /// The file is larger than this many bytes.
    TooLarge(u64),
    /// Anything else, in the system's words.
    Other(String),
}

/// A byte that is not part of any character.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BadByte {
    /// Its offset from 0.
    pub offset: usize,
    /// Its line from 1.
    pub line: usize,
    /// Its column from 1, in characters.
    pub column: usize,
}

impl core::fmt::Display for BadByte {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "line {}, column {} (byte {})", self.line, self.column, self.offset)
    }
}

/// The text that the bytes are.
///
/// # Errors
/// [`FileError::NotUtf8`] with the first byte that is not part of a character.
pub fn decode(bytes: Vec<u8>) -> Result<String, FileError> {
    String::from_utf8(bytes).map_err(|e| {
        let offset = e.utf8_error().valid_up_to();
        let before = String::from_utf8_lossy(e.as_bytes().get(..offset).unwrap_or(&[]));
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |l| l.chars().count()) + 1;
        FileError::NotUtf8(BadByte { offset, line, column })
    })
}

/// How the compiler reads files (includes, tables, post files).
pub trait FileProvider: Sync {
    /// Reads `path`, given relative to the file `from` (a display name), or to the
    /// working directory when `from` is `None`. Returns the canonical display name
    /// (the identity for «each file once») and the text.
    ///
    /// # Errors
    /// [`FileError`], in particular when the file lies above the project's root.
    fn read(&self, from: Option<&str>, path: &str) -> Result<(String, String), FileError>;

    /// Reads a CL file: bytes that are not UTF-8, which comments of CAM systems have, become replacement characters,
    /// and it may be larger than a program.
    ///
    /// # Errors
    /// As [`FileProvider::read`].
    fn read_cl(&self, path: &str) -> Result<(String, String), FileError> {
        self.read(None, path)
    }

    /// Reads a file of a CAD system, which may be larger than a program; bytes that are not UTF-8 become replacement
    /// characters.
    ///
    /// # Errors
    /// As [`FileProvider::read`].
    fn read_cad(&self, from: Option<&str>, path: &str) -> Result<(String, String), FileError> {
        self.read(from, path)
    }
}

/// Files held in memory: for tests, fuzzing and the playground.
#[derive(Debug, Clone, Default)]
pub struct MemoryFiles(pub BTreeMap<String, String>);

impl FileProvider for MemoryFiles {
    fn read(&self, _from: Option<&str>, path: &str) -> Result<(String, String), FileError> {
        let text = self.0.get(path).ok_or(FileError::NotFound)?;
        Ok((path.to_owned(), text.clone()))
    }
}
