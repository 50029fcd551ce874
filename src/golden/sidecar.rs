//! Test files: `NAME.test.toml` beside `NAME.apt`.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::diag::codes::tools as codes;
use crate::diag::{self, Diagnostic, did_you_mean};
use crate::source::{SourceMap, Span};

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
    Err(errors.into_iter().map(|e| place(e, text, file, whole)).collect())
}

/// A mistake, and the text of the file that it is about.
struct Mistake {
    message: String,
    about: String,
    help: Option<String>,
}

fn place(mistake: Mistake, text: &str, file: crate::source::FileId, whole: Span) -> Diagnostic {
    let found = text.find(&mistake.about).filter(|_| !mistake.about.is_empty());
    let span = found.map_or(whole, |at| Span::new(file, at, at + mistake.about.len()));
    let diagnostic = Diagnostic::new(&codes::BAD_SIDECAR, span, mistake.message);
    match mistake.help {
        Some(help) => diagnostic.help(help),
        None => diagnostic,
    }
}

fn check(sidecar: &Sidecar) -> Vec<Mistake> {
    let mut mistakes = Vec::new();
    let mut seen: Vec<&str> = Vec::new();
    for variant in &sidecar.variant {
        let name = variant.name.as_str();
        let plain = name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'-' || b == b'_');
        if name.is_empty() || !plain {
            let message = format!(
                "`{}` is no name for a variant: use letters, digits, `-` and `_`",
                name.escape_default()
            );
            mistakes.push(Mistake { message, about: name.to_owned(), help: None });
        }
        if seen.contains(&name) {
            let message = format!("two variants are called `{name}`");
            mistakes.push(Mistake { message, about: name.to_owned(), help: None });
        }
        seen.push(name);
    }
    let lists = sidecar.variant.iter().map(|v| &v.diagnostics).chain([&sidecar.diagnostics]);
    for code in lists.flatten().flatten().filter(|code| diag::codes::find(code).is_none()) {
        let near = did_you_mean(code, diag::codes::all().map(|c| c.id));
        mistakes.push(Mistake {
            message: format!("there is no diagnostic {code}"),
            about: code.clone(),
            help: near.map(|n| format!("did you mean {n}?")),
        });
    }
    mistakes
}
