//! What posts make of everything that controls do differently.

use partwright::post::{builtin_names, load};
use partwright::selftest::{Matrix, Verdict, print, run};
use partwright::source::{MemoryFiles, SourceMap};

fn matrix(name: &str, text: &str) -> Matrix {
    let files = MemoryFiles([(name.to_owned(), text.to_owned())].into());
    let dialect = load(name, &files, &mut SourceMap::default()).unwrap_or_else(|e| panic!("{name}: {e:#?}"));
    run(&dialect)
}

/// Rows that are wrong.
fn wrong(matrix: &Matrix) -> Vec<&'static str> {
    matrix.rows.iter().filter(|r| r.verdict == Verdict::Wrong).map(|r| r.title).collect()
}

#[test]
fn every_built_in_post_is_as_reviewed_and_nothing_is_wrong() {
    for name in builtin_names() {
        let matrix = matrix(name, "");
        let text = print::text(&matrix);
        assert!(matrix.passed(), "{name}:\n{text}");
        insta::assert_snapshot!(format!("selftest_{name}"), text);
    }
}

#[test]
fn a_wrong_unit_of_dwells_is_found() {
    let text = "inherits = \"fanuc\"\n[dwell]\nunit = \"s\"\ndecimals = 3\n";
    assert_eq!(
        wrong(&matrix("my.post.toml", text)),
        ["0.5 s in a block of its own", "12.25 s in a block of its own"]
    );
}

#[test]
fn a_wrong_code_is_found_wherever_it_is_used() {
    let turned =
        matrix("my.post.toml", "inherits = \"linuxcnc\"\n[codes]\narc-cw = \"G3\"\narc-ccw = \"G2\"\n");
    let found = wrong(&turned);
    for title in ["full circle", "semicircle, clockwise", "helix of half a turn"] {
        assert!(found.contains(&title), "{title} is not among {found:?}");
    }
    let lines = matrix(
        "my.post.toml",
        "inherits = \"linuxcnc\"\n[spindle]\nclockwise = \"M4\"\ncounter-clockwise = \"M3\"\n",
    );
    assert!(wrong(&lines).len() > 30, "{:?}", wrong(&lines));
}

#[test]
fn a_template_that_fails_is_a_wrong_row_and_not_the_end() {
    let text = "inherits = \"fanuc\"\n[templates]\noperation = \"{{ operation.nmae }}\"\n";
    let found = matrix("my.post.toml", text);
    assert!(wrong(&found).contains(&"a contour at two depths"), "{}", print::text(&found));
    assert!(!wrong(&found).contains(&"full circle"));
}
