//! Odd but valid programs: each is proven for every control that an interpreter here knows, or else the compiler would
//! refuse its own output (exit status 4).

mod common;

use std::path::Path;

use partwright::diag::Severity;
use partwright::driver;

const POSTS: [&str; 3] = ["linuxcnc", "fanuc", "grbl"];

#[test]
fn every_valid_program_is_proven_for_every_control() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/programs/valid");
    let filter = std::env::var("VALID").unwrap_or_default();
    let programs = common::find(&root, "apt");
    assert!(programs.len() >= 10, "the programs are missing");
    let failures: Vec<String> =
        programs.iter().filter(|p| p.to_string_lossy().contains(&filter)).flat_map(|p| check(p)).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

fn check(path: &Path) -> Vec<String> {
    let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
    let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    let posts = POSTS.map(str::to_owned).to_vec();
    let options = driver::Options { posts, ..driver::Options::default() };
    let build = driver::build(&name, &common::Directory(folder), &options);
    let errors = build.diagnostics.iter().filter(|d| d.severity == Severity::Error);
    let said = errors.map(|d| format!("{name}: {} {}", d.code.id, d.message));
    let missing =
        POSTS.iter().filter(|post| !build.outputs.iter().any(|o| o.post == **post && o.proven.is_some()));
    said.chain(missing.map(|post| format!("{name}: not proven for {post}"))).collect()
}
