//! A resolved post file for people: every value with the file it came from.

use super::Dialect;
use super::load::builtin_file;
use super::schema::{Key, ROOT, Shape};
use super::tree::{Entry, Node, Table};
use crate::source::{SourceMap, Span};

/// One value of a resolved post.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// The table that holds it, dotted: `words.x`; empty at the top of the file.
    pub table: String,
    /// Its key in that table.
    pub key: String,
    /// The value.
    pub value: toml::Value,
    /// Where it is said.
    pub place: Place,
}

/// Where a value is said.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// File, as messages name it.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
}

impl core::fmt::Display for Place {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{}:{}", self.file, self.line)
    }
}

impl Dialect {
    /// Every value after inheritance, in the order of the schema; freely named tables by name.
    #[must_use]
    pub fn settings(&self, sources: &SourceMap) -> Vec<Setting> {
        let mut settings = Vec::new();
        // The parent is resolved: what is left of it stands in the values.
        let keys: Vec<Key> = ROOT.iter().copied().filter(|k| k.name != "inherits").collect();
        collect(&self.tree, &keys, "", sources, &mut settings);
        settings
    }

    /// The resolved post as a post file of its own, every value with the place it came from as a comment.
    #[must_use]
    pub fn resolved_text(&self, sources: &SourceMap) -> String {
        let mut out = String::new();
        let mut table = String::new();
        for setting in self.settings(sources) {
            if setting.table != table {
                out.push_str(&format!("\n[{}]\n", setting.table));
                table.clone_from(&setting.table);
            }
            let value = literal(&setting.value);
            if value.contains('\n') {
                out.push_str(&format!("# {}\n{} = {value}\n", setting.place, bare(&setting.key)));
            } else {
                out.push_str(&format!("{} = {value}  # {}\n", bare(&setting.key), setting.place));
            }
        }
        out
    }
}

/// Values of a table come before its tables, as TOML wants it.
fn collect(table: &Table, keys: &[Key], path: &str, sources: &SourceMap, out: &mut Vec<Setting>) {
    let present = |nested: bool| {
        keys.iter()
            .filter_map(|key| Some((key, table.get(key.name)?)))
            .filter(move |(key, _)| is_table(key.shape) == nested)
    };
    for (key, entry) in present(false) {
        out.push(setting(path, key.name, entry, sources));
    }
    for (key, entry) in present(true) {
        let Node::Table(inner) = &entry.node else { continue };
        let path = join(path, key.name);
        match key.shape {
            Shape::Table(keys) => collect(inner, keys, &path, sources, out),
            Shape::Tables(keys) => {
                for (name, entry) in inner {
                    if let Node::Table(inner) = &entry.node {
                        collect(inner, keys, &join(&path, name), sources, out);
                    }
                }
            }
            _ => out.extend(inner.iter().map(|(name, entry)| setting(&path, name, entry, sources))),
        }
    }
}

const fn is_table(shape: Shape) -> bool {
    matches!(shape, Shape::Table(_) | Shape::Tables(_) | Shape::Texts | Shape::TextListTable)
}

fn setting(table: &str, key: &str, entry: &Entry, sources: &SourceMap) -> Setting {
    let value = super::tree::plain_node(&entry.node);
    Setting { table: table.to_owned(), key: key.to_owned(), value, place: place(entry.key, sources) }
}

/// A place in a built-in file or in one of `sources`.
fn place(span: Span, sources: &SourceMap) -> Place {
    match builtin_file(span.file) {
        Some((name, text)) => {
            let before = text.get(..span.start as usize).unwrap_or(text);
            let line = 1 + before.bytes().filter(|&b| b == b'\n').count();
            Place { file: format!("builtin {name}.post.toml"), line }
        }
        None => {
            let file = sources.file(span.file);
            Place { file: file.name.clone(), line: file.line_column(span.start).0 }
        }
    }
}

fn join(path: &str, name: &str) -> String {
    if path.is_empty() { bare(name) } else { format!("{path}.{}", bare(name)) }
}

/// A key as TOML writes it.
fn bare(key: &str) -> String {
    let plain = !key.is_empty() && key.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'-' || b == b'_');
    if plain { key.to_owned() } else { toml::Value::String(key.to_owned()).to_string() }
}

/// A value as TOML writes it; texts of several lines as such where that is possible.
fn literal(value: &toml::Value) -> String {
    match value {
        toml::Value::String(text) if text.contains('\n') && is_plain(text) => format!("'''\n{text}'''"),
        other => other.to_string(),
    }
}

/// Whether a text may stand between `'''` as it is.
fn is_plain(text: &str) -> bool {
    let control = |c: char| c.is_control() && c != '\n' && c != '\t';
    !text.contains("''") && !text.ends_with('\'') && !text.chars().any(control)
}
