//! The guide to posts shows every key and every variable, from the tables that the compiler itself uses.
//!
//! `UPDATE_DOCS=1 cargo test --lib guide` rewrites its tables.

use std::fmt::Write as _;

use crate::post::schema::{Key, ROOT, Shape};
use crate::post::tree::describe;
use crate::post::variables::{Scope, VARIABLES};

const GUIDE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/posts.md");
const READERS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/readers.md");
const ROUTER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/posts/router.post.toml");

/// What a key holds, in words.
fn holds(shape: Shape) -> String {
    match shape {
        Shape::Choice(words) => format!("`{}`", words.join("`, `")),
        Shape::Choices(words) => format!("a list of `{}`", words.join("`, `")),
        other => describe(other),
    }
}

fn table(out: &mut String, path: &str, keys: &[Key]) {
    let _ = writeln!(out, "| {path} | holds | what |\n|---|---|---|");
    let is_table = |shape: Shape| matches!(shape, Shape::Table(_) | Shape::Tables(_));
    for key in keys.iter().filter(|k| !is_table(k.shape)) {
        let _ = writeln!(out, "| `{}` | {} | {} |", key.name, holds(key.shape), key.doc);
    }
    out.push('\n');
}

fn keys() -> String {
    let mut out = String::new();
    table(&mut out, "top of the file", ROOT);
    for key in ROOT {
        match key.shape {
            Shape::Table(keys) => table(&mut out, &format!("`[{}]`: {}", key.name, key.doc), keys),
            Shape::Tables(keys) => table(&mut out, &format!("`[{}.NAME]`: {}", key.name, key.doc), keys),
            _ => {}
        }
    }
    out
}

fn variables() -> String {
    let mut out = String::from("| variable | where | what |\n|---|---|---|\n");
    for variable in VARIABLES {
        let scope = match variable.scope {
            Scope::Everywhere => "everywhere",
            Scope::Operation => "`templates.operation`",
            Scope::ToolChange => "tool changes",
            Scope::Cycle => "cycles",
        };
        let _ = writeln!(out, "| `{}` | {scope} | {} |", variable.name, variable.doc);
    }
    out.push_str(
        "| `options.NAME` | everywhere | `[options]`; an option of the same name in `MACHIN` overrides the value |\n",
    );
    out
}

/// The text with what stands between the two marks replaced.
fn with_section(text: &str, name: &str, section: &str) -> String {
    let (open, close) = (format!("<!-- {name} -->\n"), format!("<!-- end of {name} -->"));
    let (before, rest) = text.split_once(&open).expect("the mark is in the guide");
    let (_, after) = rest.split_once(&close).expect("the end is in the guide");
    format!("{before}{open}{}\n{close}{after}", section.trim_end())
}

fn statements() -> String {
    let mut out = String::from("| statement | value | what |\n|---|---|---|\n");
    for statement in crate::readback::statements() {
        let _ = writeln!(out, "| `{}=` | {} | {} |", statement.name, statement.values, statement.doc);
    }
    out
}

#[test]
#[allow(clippy::disallowed_methods)] // Writes the page only when asked to.
fn the_guide_to_readers_has_every_statement() {
    let page = std::fs::read_to_string(READERS).unwrap();
    let wanted = with_section(&page, "statements", &statements());
    let update = std::env::var("UPDATE_DOCS").is_ok();
    if update {
        std::fs::write(READERS, &wanted).unwrap();
    }
    assert!(page == wanted || update, "run UPDATE_DOCS=1 cargo test --lib guide");
}

#[test]
#[allow(clippy::disallowed_methods)] // Writes the guide only when asked to.
fn the_guide_has_every_key_and_every_variable() {
    let guide = std::fs::read_to_string(GUIDE).unwrap();
    let router = std::fs::read_to_string(ROUTER).unwrap();
    let wanted = with_section(&guide, "keys", &keys());
    let wanted = with_section(&wanted, "variables", &variables());
    let wanted = with_section(&wanted, "example", &format!("```toml\n{router}```"));
    if std::env::var("UPDATE_DOCS").is_ok() {
        std::fs::write(GUIDE, &wanted).unwrap();
    }
    assert!(
        guide == wanted || std::env::var("UPDATE_DOCS").is_ok(),
        "run UPDATE_DOCS=1 cargo test --lib guide"
    );
}
