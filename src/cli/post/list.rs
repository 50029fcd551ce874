//! `partwright post list`.

use serde::Serialize;

use super::super::args::post::{PostListArgs, TextOrJson};
use super::super::{Status, print};
use super::confidence;
use crate::diag::Diagnostic;
use crate::post::{self, Dialect};
use crate::source::{MemoryFiles, SourceMap};

#[derive(Serialize)]
struct Row {
    name: String,
    title: String,
    extension: String,
    control: String,
    confidence: String,
    basis: String,
}

impl Row {
    fn of(dialect: &Dialect) -> Row {
        Row {
            name: dialect.name().to_owned(),
            title: dialect.title().to_owned(),
            extension: dialect.extension().to_owned(),
            control: dialect.control().to_owned(),
            confidence: dialect.confidence().to_owned(),
            basis: dialect.basis().to_owned(),
        }
    }
}

/// Prints the built-in posts by name.
pub fn list(args: &PostListArgs) -> Result<Status, Diagnostic> {
    // A built-in post that does not load is a fault that the tests of `post` find.
    let load = |name| post::load(name, &MemoryFiles::default(), &mut SourceMap::default()).ok();
    let rows: Vec<Row> = post::builtin_names().filter_map(load).map(|d| Row::of(&d)).collect();
    print(&match args.format {
        TextOrJson::Json => serde_json::to_string_pretty(&rows).unwrap_or_default() + "\n",
        TextOrJson::Text => table(&rows),
    })
}

fn table(rows: &[Row]) -> String {
    let width = |of: fn(&Row) -> &String| rows.iter().map(|r| of(r).chars().count()).max().unwrap_or(0);
    let (name, title, extension) = (width(|r| &r.name), width(|r| &r.title), width(|r| &r.extension));
    let line = |r: &Row| {
        let sure = confidence(&r.confidence);
        format!("{:name$}  {:title$}  .{:extension$}  {sure}: {}\n", r.name, r.title, r.extension, r.basis)
    };
    rows.iter().map(line).collect()
}
