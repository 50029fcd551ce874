//! The certificate file of `--report`, and the few lines that say the same on standard error.

use std::path::Path;

use serde::Serialize;
use sha2::{Digest, Sha256};

use super::build::{Compiled, Planned};
use super::output::Product;
use crate::diag::Diagnostic;
use crate::driver::Output;

/// Version of the report's form: minor steps only add members.
const VERSION: &str = "1.0";

#[derive(Serialize)]
struct Report<'a> {
    schema: &'static str,
    version: &'static str,
    partwright: &'static str,
    programs: Vec<Program<'a>>,
}

#[derive(Serialize)]
struct Program<'a> {
    source: String,
    inputs: &'a [String],
    outputs: Vec<NcFile<'a>>,
}

#[derive(Serialize)]
struct NcFile<'a> {
    post: &'a str,
    file: Option<String>,
    bytes: usize,
    sha256: String,
    certificate: serde_json::Value,
    #[serde(skip)]
    output: &'a Output,
}

fn nc_files<'a>(source: usize, one: &'a Compiled, planned: &[Planned]) -> Vec<NcFile<'a>> {
    let file = |index: usize| {
        let found = planned
            .iter()
            .find(|p| p.source == source && p.output == Some(index) && p.stage == super::args::Stage::Nc);
        found.map(|p| p.path.to_string_lossy().into_owned())
    };
    let outputs = one.build.outputs.iter().enumerate();
    let proven = outputs.filter_map(|(index, output)| Some((index, output, output.text()?)));
    proven
        .map(|(index, output, text)| NcFile {
            post: &output.post,
            file: file(index),
            bytes: text.len(),
            sha256: digest(text.as_bytes()),
            certificate: output.certificate_json(),
            output,
        })
        .collect()
}

fn digest(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect()
}

/// The report of a run.
pub fn product(path: &Path, compiled: &[Compiled], planned: &[Planned]) -> Result<Product, Diagnostic> {
    let programs = compiled.iter().enumerate().map(|(i, one)| Program {
        source: one.path.to_string_lossy().into_owned(),
        inputs: &one.build.inputs,
        outputs: nc_files(i, one, planned),
    });
    let report = Report {
        schema: "partwright-report",
        version: VERSION,
        partwright: env!("CARGO_PKG_VERSION"),
        programs: programs.collect(),
    };
    let mut text = serde_json::to_string_pretty(&report).unwrap_or_default();
    text.push('\n');
    Ok(Product { path: path.to_path_buf(), bytes: text.into_bytes() })
}

/// A few lines for people: what was written and how good it is.
pub fn summary(compiled: &[Compiled], planned: &[Planned]) -> String {
    let mut text = String::new();
    for (i, one) in compiled.iter().enumerate() {
        for file in nc_files(i, one, planned) {
            let name = file.file.as_deref().filter(|n| *n != "-").unwrap_or("standard output");
            text.push_str(&format!("{name} ({}): {}\n", file.post, file.output.summary()));
        }
    }
    text
}
