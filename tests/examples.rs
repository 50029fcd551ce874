//! Every example, every stage, every dialect: compiled, proven and snapshotted, found by directory.
//!
//! `INSTA_UPDATE=always cargo test --test examples` rewrites the snapshots; the difference is then reviewed
//! as if one ran the machine. `EXAMPLES=part-of-a-name` runs some of them.

mod common;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use common::Directory;
use partwright::diag::{Diagnostic, Severity, render};
use partwright::driver::{self, Build, Options};
use partwright::{cl, ir, target};

/// Lines of an emitted text that a snapshot shows in full; of longer ones, head, tail and the digest.
const WHOLE: usize = 400;
const EXCERPT: usize = 60;

fn examples() -> Vec<PathBuf> {
    let wanted = std::env::var("EXAMPLES").unwrap_or_default();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let kinds = ["apt", "cls", "aptsource"];
    let mut found: Vec<PathBuf> = kinds.iter().flat_map(|kind| common::find(&folder, kind)).collect();
    found.sort();
    // Folders hold what programs include.
    found.retain(|p| p.parent() == Some(folder.as_path()) && p.to_string_lossy().contains(&wanted));
    found
}

fn compile(path: &Path, posts: &[&str]) -> (String, Build) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let name = path.strip_prefix(&folder).expect("an example").to_string_lossy().replace('\\', "/");
    let options = Options { posts: posts.iter().map(|p| (*p).to_owned()).collect(), ..Options::default() };
    let build = driver::build(&name, &Directory(folder), &options);
    (name, build)
}

/// The text, or its head and tail with a digest of all of it.
fn excerpt(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    if lines.len() <= WHOLE {
        return text.to_owned();
    }
    let mut out = lines[..EXCERPT].join("\n");
    let left_out = lines.len() - 2 * EXCERPT;
    let _ =
        write!(out, "\n… {left_out} lines, fnv1a {:016x} of the whole …\n", common::fnv1a(text.as_bytes()));
    out.push_str(&lines[lines.len() - EXCERPT..].join("\n"));
    out.push('\n');
    out
}

fn messages(build: &Build) -> String {
    build
        .diagnostics
        .iter()
        .map(|d| render::render(d, &build.sources, render::Format::Short, false))
        .collect()
}

fn snapshot(name: &str, stage: &str, text: &str) {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/snapshots/examples"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    let file = format!("{}.{stage}", name.trim_end_matches(".apt").replace('/', "-"));
    settings.bind(|| insta::assert_snapshot!(file, text));
}

#[test]
fn every_stage_of_every_example_is_as_reviewed() {
    let examples = examples();
    assert!(!examples.is_empty(), "no examples found");
    for path in examples {
        // A CL file names no target.
        let is_program = path.extension().is_some_and(|e| e == "apt");
        let (name, build) = compile(&path, if is_program { &[] } else { &["linuxcnc"] });
        assert!(!build.has_errors(), "{name}:\n{}", messages(&build));
        snapshot(&name, "messages", &messages(&build));
        // A CL file has no program before its records.
        if let Some(ir) = &build.ir {
            snapshot(&name, "ir", &excerpt(&ir::print::print(ir, &build.sources)));
        }
        snapshot(&name, "cl", &excerpt(&cl::print::print(build.cl.as_ref().expect("CL data"))));
        for output in &build.outputs {
            let target = target::print::print(output.target.as_ref().expect("a lowered program"));
            snapshot(&name, &format!("{}.target", output.post), &excerpt(&target));
        }
    }
}

/// Examples that a control cannot run: the example, the dialect, the code of the error, and why.
const REFUSED: &[(&str, &str, &str, &str)] = &[];

/// Every example comes out proven for every dialect, those apart that the list above gives a reason for.
#[test]
fn every_example_posts_to_every_dialect() {
    for path in examples() {
        let posts: Vec<&str> = partwright::post::builtin_names().collect();
        let (name, together) = compile(&path, &posts);
        if !together.has_errors() {
            // What is planned once for all of them is the same for one.
            for output in &together.outputs {
                let proven = output.proven.as_ref().expect("a program without errors is proven");
                snapshot(&name, &format!("{}.nc", output.post), &excerpt(proven.text()));
            }
            assert_eq!(together.outputs.len(), posts.len(), "{name}");
            continue;
        }
        for post in posts {
            let (name, build) = compile(&path, &[post]);
            let text = build.outputs.first().and_then(|o| o.proven.as_ref()).map(|p| excerpt(p.text()));
            assert_eq!(text.is_none(), build.has_errors(), "{name} for {post}:\n{}", messages(&build));
            let listed = REFUSED.iter().find(|(n, p, ..)| *n == name && *p == post);
            let error = |d: &&Diagnostic| d.severity == Severity::Error;
            let errors: Vec<&str> = build.diagnostics.iter().filter(error).map(|d| d.code.id).collect();
            match listed {
                None => assert!(text.is_some(), "{name} for {post} is refused:\n{}", messages(&build)),
                Some((_, _, code, why)) => assert_eq!(errors, [*code], "{name} for {post}: {why}"),
            }
            let text = text.unwrap_or_else(|| format!("refused:\n{}", messages(&build)));
            snapshot(&name, &format!("{post}.nc"), &text);
        }
    }
}
