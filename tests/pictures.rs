//! Pictures of nets as text: `plot --what path` and `--what deviation` of every program in `tests/programs/pictures`.
//!
//! `INSTA_UPDATE=always cargo test --test pictures` rewrites the snapshots. A line of many coordinates stands there as its head,
//! its length and a digest; where one changes, look at the picture.

mod common;

use std::fmt::Write as _;
use std::path::Path;

use common::scratch::{Scratch, code, stderr};

/// Characters of a line that are shown.
const SHOWN: usize = 160;

fn shortened(svg: &str) -> String {
    let mut text = String::new();
    for line in svg.lines() {
        let head: String = line.chars().take(SHOWN).collect();
        let _ = match line.len() {
            n if n <= SHOWN => writeln!(text, "{line}"),
            n => writeln!(text, "{head}… {n} bytes, fnv1a {:016x}", common::fnv1a(line.as_bytes())),
        };
    }
    text
}

#[test]
fn pictures_of_nets_are_as_reviewed() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let programs = common::find(&root.join("programs/pictures"), "apt");
    assert!(!programs.is_empty(), "no programs found");
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(root.join("snapshots/pictures"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    for program in programs {
        let name = program.file_stem().expect("a name").to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&program).expect("a program");
        let scratch = Scratch::new(&format!("picture-{name}"));
        scratch.write("part.apt", &text);
        // A deviation is what a finished surface has.
        let kinds: &[&str] = if text.contains("SURFAC/") { &["path", "deviation"] } else { &["path"] };
        for what in kinds {
            let output = scratch.run(&["plot", "part.apt", "--what", what, "-o", "part.svg"]);
            assert_eq!(code(&output), 0, "{name} {what}: {}", stderr(&output));
            let svg = scratch.read("part.svg");
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name} {what}");
            settings.bind(|| insta::assert_snapshot!(format!("{name}.{what}"), shortened(&svg)));
        }
    }
}
