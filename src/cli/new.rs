//! `partwright new`: a project that passes its own tests at once.

use std::path::Path;

use super::Status;
use super::args::golden::NewArgs;
use super::messages::{Messages, to_stderr};
use super::output::{self, Product};
use crate::diag::Diagnostic;
use crate::diag::codes::{post as post_codes, tools as codes};
use crate::golden::{self, TestFile, Verdict, sidecar};
use crate::post;
use crate::source::{MemoryFiles, SourceMap};

/// The files of a project and their texts.
const FILES: &[(&str, &str)] = &[
    ("partwright.toml", include_str!("new/partwright.toml")),
    ("README.md", include_str!("new/README.md")),
    (".gitattributes", include_str!("new/gitattributes")),
    (".gitignore", include_str!("new/gitignore")),
    (".github/workflows/partwright.yml", include_str!("new/workflow.yml")),
    (POST, include_str!("new/mill.post.toml")),
    (PROGRAM, include_str!("new/cam.apt")),
    (SIDECAR, include_str!("new/cam.test.toml")),
];
const POST: &str = "posts/mill.post.toml";
const PROGRAM: &str = "parts/cam.apt";
const SIDECAR: &str = "parts/cam.test.toml";

/// Writes the project.
pub fn new(args: &NewArgs, messages: Messages) -> Result<Status, Diagnostic> {
    check_empty(&args.dir)?;
    if post::builtin_text(&args.from).is_none() {
        let message = format!("there is no post `{}`", args.from);
        return Err(
            Diagnostic::global(&post_codes::UNKNOWN_POST, message).help("`partwright post list` lists them")
        );
    }
    let files = files(&args.from);
    let golden = match golden_files(&files) {
        Ok(golden) => golden,
        Err((diagnostics, sources)) => {
            messages.show(&diagnostics, &sources);
            return Ok(super::build::status_of(&diagnostics));
        }
    };
    let products = files.0.into_iter().chain(golden);
    let products: Vec<Product> = products
        .map(|(name, text)| Product { path: args.dir.join(name), bytes: text.into_bytes() })
        .collect();
    for product in &products {
        output::make_folder(product.path.parent().unwrap_or(&args.dir))?;
    }
    output::write_all(&products)?;
    if messages.for_people() {
        let dir = args.dir.display();
        to_stderr(&format!("{dir}: {} files; try `cd {dir} && partwright test`\n", products.len()));
    }
    Ok(Status::Done)
}

fn check_empty(dir: &Path) -> Result<(), Diagnostic> {
    let taken = match std::fs::read_dir(dir) {
        Ok(mut entries) => entries.next().is_some(),
        Err(_) => dir.symlink_metadata().is_ok(),
    };
    if taken {
        let message = format!("{} is there already and is not empty", dir.display());
        return Err(Diagnostic::global(&codes::ALREADY_THERE, message).help("choose a new directory"));
    }
    Ok(())
}

fn files(from: &str) -> MemoryFiles {
    let filled =
        |text: &str| text.replace("{{from}}", from).replace("{{version}}", env!("CARGO_PKG_VERSION"));
    MemoryFiles(FILES.iter().map(|(name, text)| ((*name).to_owned(), filled(text))).collect())
}

/// Names and texts of files.
type Texts = Vec<(String, String)>;

/// The programs that the project's tests accept.
fn golden_files(files: &MemoryFiles) -> Result<Texts, (Vec<Diagnostic>, SourceMap)> {
    let mut sources = SourceMap::default();
    let text = files.0.get(SIDECAR).map_or("", String::as_str);
    let sidecar = match sidecar::parse(SIDECAR, text, &mut sources) {
        Ok(sidecar) => sidecar,
        Err(errors) => return Err((errors, sources)),
    };
    let mut golden = Vec::new();
    let test = TestFile { name: SIDECAR, text, sidecar: &sidecar };
    for made in golden::make(PROGRAM, files, Some(test)) {
        if made.build.has_errors() {
            return Err((made.build.diagnostics, made.build.sources));
        }
        let outcomes = golden::check(PROGRAM, &made, &|_| None);
        golden.extend(outcomes.into_iter().filter_map(|o| match o.verdict {
            Verdict::New { text } => Some((o.golden, text)),
            _ => None,
        }));
    }
    Ok(golden)
}
