//! Finding, inheriting and checking post files.

use super::check;
use super::dialect::{Dialect, Spec};
use super::tree::{self, Node, Table};
use crate::diag::{Diagnostic, Label, codes, did_you_mean};
use crate::source::{FileError, FileId, FileProvider, SourceMap, Span};

/// The built-in post files, by name.
const BUILTIN: &[(&str, &str)] = &[
    ("apt-cl", include_str!("dialects/apt-cl.post.toml")),
    ("centroid", include_str!("dialects/centroid.post.toml")),
    ("fanuc", include_str!("dialects/fanuc.post.toml")),
    ("grbl", include_str!("dialects/grbl.post.toml")),
    ("grblhal", include_str!("dialects/grblhal.post.toml")),
    ("haas", include_str!("dialects/haas.post.toml")),
    ("heidenhain", include_str!("dialects/heidenhain.post.toml")),
    ("iso", include_str!("dialects/iso.post.toml")),
    ("linuxcnc", include_str!("dialects/linuxcnc.post.toml")),
    ("mach3", include_str!("dialects/mach3.post.toml")),
    ("marlin", include_str!("dialects/marlin.post.toml")),
    ("mazak", include_str!("dialects/mazak.post.toml")),
    ("mitsubishi", include_str!("dialects/mitsubishi.post.toml")),
    ("okuma", include_str!("dialects/okuma.post.toml")),
    ("sinumerik", include_str!("dialects/sinumerik.post.toml")),
];

/// The largest post file, bytes.
const LARGEST: usize = 1 << 20;

fn too_large(name: &str, bytes: usize, at: Option<Span>) -> Diagnostic {
    let message = format!("the post file {name} has {bytes} bytes; a post has {LARGEST} at most");
    match at {
        Some(span) => Diagnostic::new(&codes::command::TOO_LARGE, span, message),
        None => Diagnostic::global(&codes::command::TOO_LARGE, message),
    }
}

/// Longest chain of `inherits`.
const MAX_DEPTH: usize = 8;

/// The names that can be given on the command line, in alphabetical order.
pub fn builtin_names() -> impl Iterator<Item = &'static str> {
    // `iso` is there to be inherited from.
    BUILTIN.iter().map(|(name, _)| *name).filter(|name| *name != "iso")
}

/// The text of a built-in post file, `iso` included.
#[must_use]
pub fn builtin_text(name: &str) -> Option<&'static str> {
    BUILTIN.iter().find(|(n, _)| n.eq_ignore_ascii_case(name)).map(|(_, text)| *text)
}

/// Loads a post: a built-in name, or a path to a `*.post.toml` file.
///
/// Files that are read, and built-in ones that an error points into, are added to `sources`.
///
/// # Errors
/// Every error that was found, with its place in the post file.
pub fn load(
    name_or_path: &str,
    files: &dyn FileProvider,
    sources: &mut SourceMap,
) -> Result<Dialect, Vec<Diagnostic>> {
    load_with(name_or_path, &[], files, sources)
}

/// Loads a post with overrides: each a dotted key and its value, as `--post-set` gives them.
///
/// # Errors
/// As [`load`]; a bad override is shown in its own little file.
pub fn load_with(
    name_or_path: &str,
    overrides: &[(String, String)],
    files: &dyn FileProvider,
    sources: &mut SourceMap,
) -> Result<Dialect, Vec<Diagnostic>> {
    let mut loader =
        Loader { files, sources, chain: Vec::new(), lineage: Vec::new(), leaf: None, user: false };
    let result = loader.dialect(name_or_path, overrides);
    result.map_err(|errors| name_builtins(errors, sources))
}

impl Loader<'_> {
    fn dialect(
        &mut self,
        name_or_path: &str,
        overrides: &[(String, String)],
    ) -> Result<Dialect, Vec<Diagnostic>> {
        let mut tree = self.tree(name_or_path, None, None)?;
        if !overrides.is_empty() {
            tree = tree::merge(tree, self.overrides(overrides)?);
        }
        let user = self.user || !overrides.is_empty();
        let spec = typed(&tree).map_err(|message| vec![incomplete(name_or_path, &message)])?;
        let lineage = core::mem::take(&mut self.lineage);
        let dialect = Dialect {
            name: stem(name_or_path),
            spec,
            tree,
            lineage,
            leaf: self.leaf.unwrap_or(FileId(FIRST_BUILTIN)),
        };
        if dialect.spec.post.is_abstract {
            return Err(vec![unknown(name_or_path, None)]);
        }
        let errors = check::check(&dialect, self.sources, user);
        if errors.is_empty() { Ok(dialect) } else { Err(errors) }
    }
}

/// Places in built-in files have this file number and those below it, until a message needs them.
const FIRST_BUILTIN: u32 = u32::MAX;

/// The built-in file behind a file number of [`FIRST_BUILTIN`] and below: its name and its text.
pub(super) fn builtin_file(file: FileId) -> Option<(&'static str, &'static str)> {
    BUILTIN.get((FIRST_BUILTIN - file.0) as usize).copied()
}

/// The name of overrides in messages.
const OVERRIDES: &str = "--post-set";

/// The key that an override gives, when a place is in one.
pub(crate) fn override_key(file: FileId, sources: &SourceMap) -> Option<&str> {
    if !is_override(file, sources) {
        return None;
    }
    sources.file(file).text.split_once(" = ").map(|(key, _)| key)
}

/// Whether a place is in the post file that was asked for, or in an override, not in what it inherits.
pub(super) fn is_own(dialect: &Dialect, file: FileId, sources: &SourceMap) -> bool {
    file == dialect.leaf || is_override(file, sources)
}

/// Whether a place is in an override.
pub(crate) fn is_override(file: FileId, sources: &SourceMap) -> bool {
    builtin_file(file).is_none() && sources.file(file).name == OVERRIDES
}

/// Adds the built-in files that messages point into to `sources`, and points the messages there.
pub(super) fn name_builtins(mut errors: Vec<Diagnostic>, sources: &mut SourceMap) -> Vec<Diagnostic> {
    let mut given: Vec<Option<FileId>> = vec![None; BUILTIN.len()];
    let mut place = |label: &mut Label| {
        let index = (FIRST_BUILTIN - label.span.file.0) as usize;
        if let (Some((name, text)), Some(slot)) = (BUILTIN.get(index), given.get_mut(index)) {
            label.span.file =
                *slot.get_or_insert_with(|| sources.add(format!("builtin {name}.post.toml"), *text));
        }
    };
    for error in &mut errors {
        error.primary.iter_mut().chain(&mut error.labels).for_each(&mut place);
    }
    errors
}

/// `post/mill.post.toml` → `mill`.
fn stem(name_or_path: &str) -> String {
    let file = name_or_path.rsplit(['/', '\\']).next().unwrap_or(name_or_path);
    let file = file.strip_suffix(".toml").unwrap_or(file);
    file.strip_suffix(".post").unwrap_or(file).to_lowercase()
}

fn typed(tree: &Table) -> Result<Spec, String> {
    toml::Value::Table(tree::plain(tree)).try_into::<Spec>().map_err(|e| e.message().to_owned())
}

struct Loader<'a> {
    files: &'a dyn FileProvider,
    sources: &'a mut SourceMap,
    /// Names of the files being resolved, from the child to the parent.
    chain: Vec<String>,
    /// Names of all files that were merged, from the child to the parent.
    lineage: Vec<String>,
    /// The file that was asked for.
    leaf: Option<FileId>,
    /// Whether a file of the user is among them.
    user: bool,
}

impl Loader<'_> {
    /// The merged tree of a post; `from` is the file that inherits it, `at` the place where it says so.
    fn tree(&mut self, name: &str, from: Option<&str>, at: Option<Span>) -> Result<Table, Vec<Diagnostic>> {
        if let Some(index) = BUILTIN.iter().position(|(n, _)| n.eq_ignore_ascii_case(name)) {
            return self.builtin(index);
        }
        if !name.ends_with(".toml") {
            return Err(vec![unknown(name, at)]);
        }
        let (display, text) =
            self.files.read(from, name).map_err(|error| vec![unreadable(name, &error, at)])?;
        if text.len() > LARGEST {
            return Err(vec![too_large(&display, text.len(), at)]);
        }
        if self.chain.contains(&display) || self.chain.len() >= MAX_DEPTH {
            return Err(vec![self.cycle(&display, at)]);
        }
        self.user = true;
        self.chain.push(display.clone());
        self.lineage.push(display.clone());
        let file = self.sources.add(display.clone(), text.as_str());
        self.leaf.get_or_insert(file);
        let own = tree::parse(file, &text)?;
        self.inherit(own, Some(&display))
    }

    fn builtin(&mut self, index: usize) -> Result<Table, Vec<Diagnostic>> {
        let (name, text) = BUILTIN[index];
        self.lineage.push(name.to_owned());
        let file = FileId(FIRST_BUILTIN - index as u32);
        self.leaf.get_or_insert(file);
        let own = tree::parse(file, text)?;
        self.inherit(own, None)
    }

    fn inherit(&mut self, own: Table, from: Option<&str>) -> Result<Table, Vec<Diagnostic>> {
        let Some(entry) = own.get("inherits") else { return Ok(own) };
        let Node::Leaf(toml::Value::String(parent)) = &entry.node else { return Ok(own) };
        let (parent, at) = (parent.clone(), entry.value);
        let mut base = self.tree(&parent, from, Some(at))?;
        // A parent that is only for inheriting does not make its children so.
        if let Some(Node::Table(post)) = base.get_mut("post").map(|e| &mut e.node) {
            post.remove("abstract");
        }
        Ok(tree::merge(base, own))
    }

    fn cycle(&self, name: &str, at: Option<Span>) -> Diagnostic {
        let chain: Vec<&str> = self.chain.iter().map(String::as_str).chain([name]).collect();
        let message = format!("post files inherit in a circle or too deeply: {}", chain.join(" > "));
        at.map_or_else(
            || Diagnostic::global(&codes::post::INHERITANCE, message.clone()),
            |span| Diagnostic::new(&codes::post::INHERITANCE, span, message.clone()),
        )
    }

    fn overrides(&mut self, overrides: &[(String, String)]) -> Result<Table, Vec<Diagnostic>> {
        let (mut merged, mut errors) = (Table::new(), Vec::new());
        for (key, value) in overrides {
            let bare = format!("{key} = {value}\n");
            // Options are texts, also those that are numbers.
            let option = key.trim_start().starts_with("options.");
            let quoted = value.starts_with(['"', '\'']);
            let text = if bare.parse::<toml::Table>().is_ok() && (quoted || !option) {
                bare
            } else {
                format!("{key} = {}\n", toml::Value::String(value.clone()))
            };
            let file: FileId = self.sources.add(OVERRIDES, text.as_str());
            match tree::parse(file, &text) {
                Ok(table) => merged = tree::merge(merged, table),
                Err(wrong) => errors.extend(wrong),
            }
        }
        if let Some(entry) = merged.get("inherits") {
            let message =
                "`inherits` cannot be set for one run: what a post inherits is read before".to_owned();
            errors.push(
                Diagnostic::new(&codes::post::WRONG_VALUE, entry.key, message)
                    .help("name the other post with --post, or write a post file that inherits it"),
            );
        }
        if errors.is_empty() { Ok(merged) } else { Err(errors) }
    }
}

fn unknown(name: &str, at: Option<Span>) -> Diagnostic {
    let message = format!("there is no post `{name}`");
    let error = match at {
        Some(span) => Diagnostic::new(&codes::post::UNKNOWN_POST, span, message),
        None => Diagnostic::global(&codes::post::UNKNOWN_POST, message),
    };
    if name.contains(',') {
        return error.help("each post is asked for by itself: `--post fanuc --post heidenhain`");
    }
    match did_you_mean(name, builtin_names()) {
        Some(near) => error.help(format!("did you mean `{near}`?")),
        None => {
            let names: Vec<&str> = builtin_names().collect();
            error.help(format!(
                "built-in posts are {}; a post file of your own ends in `.post.toml`",
                names.join(", ")
            ))
        }
    }
}

fn unreadable(name: &str, error: &FileError, at: Option<Span>) -> Diagnostic {
    let reason = match error {
        FileError::NotFound => "there is no such file".to_owned(),
        FileError::OutsideRoot => "it lies outside the project's root".to_owned(),
        FileError::NotUtf8(byte) => format!("{byte} is not UTF-8"),
        FileError::TooLarge(limit) => format!("it is larger than {limit} bytes"),
        FileError::Other(text) => text.clone(),
    };
    let message = format!("the post file `{name}` cannot be read: {reason}");
    match at {
        Some(span) => Diagnostic::new(&codes::post::UNREADABLE_POST, span, message),
        None => Diagnostic::global(&codes::post::UNREADABLE_POST, message),
    }
}

fn incomplete(name: &str, message: &str) -> Diagnostic {
    Diagnostic::global(&codes::post::INCOMPLETE_POST, format!("the post `{name}` is not complete: {message}"))
        .help("inherit from a built-in post, for example `inherits = \"fanuc\"`; it has every key")
}
