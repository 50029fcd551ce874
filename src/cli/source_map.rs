//! The file of `--source-map`.

use std::path::Path;

use serde::Serialize;

use super::args::Stage;
use super::build::{Compiled, Planned};
use super::output::Product;
use crate::links::{self, Links, VERSION};

#[derive(Serialize)]
struct SourceMapFile<'a> {
    schema: &'static str,
    version: &'static str,
    partwright: &'static str,
    programs: Vec<Program<'a>>,
}

#[derive(Serialize)]
struct Program<'a> {
    post: &'a str,
    /// The NC file.
    file: String,
    #[serde(flatten)]
    links: Links,
}

/// The links of all NC programs of a run.
pub fn product(path: &Path, compiled: &[Compiled], planned: &[Planned]) -> Product {
    let program = |planned: &Planned| {
        let build = &compiled.get(planned.source)?.build;
        let output = build.outputs.get(planned.output?)?;
        let links = links::of(build, output)?;
        Some(Program { post: &output.post, file: planned.path.to_string_lossy().into_owned(), links })
    };
    let map = SourceMapFile {
        schema: "partwright-source-map",
        version: VERSION,
        partwright: env!("CARGO_PKG_VERSION"),
        programs: planned.iter().filter(|p| p.stage == Stage::Nc).filter_map(program).collect(),
    };
    let text = serde_json::to_string_pretty(&map).unwrap_or_default() + "\n";
    Product { path: path.to_path_buf(), bytes: text.into_bytes() }
}
