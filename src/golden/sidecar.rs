//! Test files: `NAME.test.toml` beside `NAME.apt`.

use std::collections::BTreeMap;
use std::ops::Range;

use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::clfile;
use crate::diag::codes::tools as codes;
use crate::diag::{self, Diagnostic, Label, did_you_mean};
use crate::driver::Build;
use crate::post;
use crate::source::{FileId, SourceMap, Span};

/// How a program is tested.
#[derive(Debug, Clone, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Sidecar {
    /// Posts to build for; when empty, the program's `MACHIN` statements decide.
    #[serde(default)]
    pub posts: Vec<String>,
    /// Values of `PARAM`s, as `-D` gives them.
    #[serde(default)]
    pub define: BTreeMap<String, String>,
    /// Overrides of the posts, as `--post-set` gives them.
    #[serde(default)]
    pub post_set: BTreeMap<String, String>,
    /// The system that wrote a CL file, as `--producer` gives it.
    #[serde(default)]
    pub producer: Option<String>,
    /// A CL file is read as with `--lenient`.
    #[serde(default)]
    pub lenient: bool,
    /// Columns from 73 on are left out, as with `--card-columns`.
    #[serde(default)]
    pub card_columns: bool,
    /// Codes of all errors and warnings that must come, and of notes that must.
    #[serde(default)]
    pub diagnostics: Option<Vec<String>>,
    /// Variants; without any the program is tested once, as it is.
    #[serde(default)]
    pub variant: Vec<Variant>,
}

/// A variant: what it says adds to or replaces what the file says for all.
#[derive(Debug, Clone, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Variant {
    /// Its name, a part of the names of golden files.
    pub name: String,
    /// Posts, instead of those for all.
    #[serde(default)]
    pub posts: Option<Vec<String>>,
    /// More values of `PARAM`s.
    #[serde(default)]
    pub define: BTreeMap<String, String>,
    /// More overrides of the posts.
    #[serde(default)]
    pub post_set: BTreeMap<String, String>,
    /// Codes, instead of those for all.
    #[serde(default)]
    pub diagnostics: Option<Vec<String>>,
}

/// Reads a test file.
///
/// # Errors
/// Every mistake, with its place; the file is then in `sources`.
pub fn parse(name: &str, text: &str, sources: &mut SourceMap) -> Result<Sidecar, Vec<Diagnostic>> {
    let file = sources.add(name, text);
    let whole = Span::new(file, 0, text.len().min(1));
    let sidecar: Sidecar = toml::from_str(text).map_err(|error| {
        let span = error.span().map_or(whole, |range| Span::new(file, range.start, range.end));
        vec![Diagnostic::new(&codes::BAD_SIDECAR, span, error.message().to_owned())]
    })?;
    let errors = check(&sidecar);
    if errors.is_empty() {
        return Ok(sidecar);
    }
    let places = Places::of(text);
    let placed = |mistake: Mistake| {
        let span = places.span(&mistake.path, file).unwrap_or(whole);
        let diagnostic = Diagnostic::new(&codes::BAD_SIDECAR, span, mistake.message);
        match mistake.help {
            Some(help) => diagnostic.help(help),
            None => diagnostic,
        }
    };
    Err(errors.into_iter().map(placed).collect())
}

/// Where the values of a test file stand, by dotted path with indices: `variant.0.posts.1`.
struct Places(BTreeMap<String, Range<usize>>);

impl Places {
    fn of(text: &str) -> Places {
        let mut places = Places(BTreeMap::new());
        let (root, _) = DeTable::parse_recoverable(text);
        places.table("", root.get_ref());
        places
    }

    fn table(&mut self, path: &str, table: &DeTable<'_>) {
        for (key, value) in table {
            self.value(&join(path, key.get_ref()), value);
        }
    }

    fn value(&mut self, path: &str, value: &Spanned<DeValue<'_>>) {
        self.0.insert(path.to_owned(), value.span());
        match value.get_ref() {
            DeValue::Table(table) => self.table(path, table),
            DeValue::Array(items) => {
                items.iter().enumerate().for_each(|(i, item)| self.value(&join(path, &i.to_string()), item));
            }
            _ => {}
        }
    }

    fn span(&self, path: &str, file: FileId) -> Option<Span> {
        self.0.get(path).map(|range| Span::new(file, range.start, range.end))
    }
}

fn join(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") }
}

/// Shows messages about what the test file gives where it does: about posts and definitions, which have no place, and
/// about overrides of posts. `file` is the test file in the sources of the messages; `index` that of the variant, when
/// there are any.
pub fn locate(
    build: &mut Build,
    (sidecar, text, file): (&Sidecar, &str, FileId),
    program: &str,
    index: usize,
) {
    let places = Places::of(text);
    let mentions = sidecar.mentions(program, index);
    for diagnostic in &mut build.diagnostics {
        if diagnostic.primary.is_none() {
            let about = mentions.iter().find(|(_, name)| names(&diagnostic.message, name));
            let span = about.and_then(|(path, _)| places.span(path, file));
            diagnostic.primary = span.map(|span| Label { span, message: String::new() });
        }
        for label in diagnostic.primary.iter_mut().chain(&mut diagnostic.labels) {
            let key = post::override_key(label.span.file, &build.sources);
            let path = key.and_then(|key| sidecar.override_path(key, index));
            if let Some(span) = path.and_then(|path| places.span(&path, file)) {
                label.span = span;
            }
        }
    }
}

/// Whether a message names something as a whole: `fanuc2` does not name `fanuc`.
fn names(message: &str, name: &str) -> bool {
    let part = |c: char| c.is_alphanumeric() || c == '_';
    message.match_indices(name).any(|(at, _)| {
        let before = message.get(..at).and_then(|m| m.chars().next_back());
        let after = message.get(at + name.len()..).and_then(|m| m.chars().next());
        !name.is_empty() && !before.is_some_and(part) && !after.is_some_and(part)
    })
}

impl Sidecar {
    /// Where the file gives an override of a variant.
    fn override_path(&self, key: &str, index: usize) -> Option<String> {
        let own = self.variant.get(index).is_some_and(|v| v.post_set.contains_key(key));
        let path = if own { format!("variant.{index}.post-set") } else { "post-set".to_owned() };
        (own || self.post_set.contains_key(key)).then(|| join(&path, key))
    }

    /// What a variant hands to the build: the path in the file and the name in messages.
    fn mentions(&self, program: &str, index: usize) -> Vec<(String, String)> {
        let mut found = Vec::new();
        let mut posts = |path: &str, posts: &[String]| {
            let named = posts.iter().enumerate();
            found.extend(
                named.map(|(i, post)| (format!("{path}posts.{i}"), super::names::beside(program, post))),
            );
        };
        let variant = self.variant.get(index);
        match variant.and_then(|v| v.posts.as_ref()) {
            Some(own) => posts(&format!("variant.{index}."), own),
            None => posts("", &self.posts),
        }
        for (path, define) in variant
            .map(|v| (format!("variant.{index}."), &v.define))
            .into_iter()
            .chain([(String::new(), &self.define)])
        {
            found.extend(define.keys().map(|name| (format!("{path}define.{name}"), format!("-D {name}"))));
        }
        found
    }
}

/// A mistake, and the path of the value that it is about.
struct Mistake {
    message: String,
    path: String,
    help: Option<String>,
}

fn check(sidecar: &Sidecar) -> Vec<Mistake> {
    let mut mistakes = Vec::new();
    let mut seen: Vec<String> = Vec::new();
    if let Some(Err(message)) = sidecar.producer.as_deref().map(clfile::producer_named) {
        mistakes.push(Mistake { message, path: "producer".to_owned(), help: None });
    }
    check_lists("", Some(&sidecar.posts), sidecar.diagnostics.as_ref(), &mut mistakes);
    for (index, variant) in sidecar.variant.iter().enumerate() {
        let (name, path) = (variant.name.as_str(), format!("variant.{index}.name"));
        let plain = name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'-' || b == b'_');
        if name.is_empty() || !plain {
            let message = format!(
                "`{}` is no name for a variant: use letters, digits, `-` and `_`",
                name.escape_default()
            );
            mistakes.push(Mistake { message, path: path.clone(), help: None });
        }
        // File systems may not tell capitals from small letters.
        let alike = name.to_ascii_lowercase();
        if seen.contains(&alike) {
            mistakes.push(Mistake { message: format!("two variants are called `{name}`"), path, help: None });
        }
        seen.push(alike);
        let path = format!("variant.{index}.");
        check_lists(&path, variant.posts.as_ref(), variant.diagnostics.as_ref(), &mut mistakes);
    }
    mistakes
}

/// Posts that are named twice, and codes that there are not.
fn check_lists(
    path: &str,
    posts: Option<&Vec<String>>,
    codes: Option<&Vec<String>>,
    mistakes: &mut Vec<Mistake>,
) {
    let posts = posts.map_or(&[][..], Vec::as_slice);
    for (i, post) in posts.iter().enumerate() {
        if posts.iter().take(i).any(|other| other.eq_ignore_ascii_case(post)) {
            let message = format!("the post `{post}` is named twice");
            mistakes.push(Mistake { message, path: format!("{path}posts.{i}"), help: None });
        }
    }
    let unknown = |code: &&String| diag::codes::find(code).is_none();
    for (i, code) in codes.into_iter().flatten().enumerate().filter(|(_, code)| unknown(code)) {
        let near = did_you_mean(code, diag::codes::all().map(|c| c.id));
        mistakes.push(Mistake {
            message: format!("there is no diagnostic {code}"),
            path: format!("{path}diagnostics.{i}"),
            help: near.map(|n| format!("did you mean {n}?")),
        });
    }
}
