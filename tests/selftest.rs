//! What posts make of everything that controls do differently.

mod common;

use partwright::post::{Dialect, builtin_names, load};
use partwright::selftest::{Matrix, Row, Verdict, findings, print, run};
use partwright::source::{MemoryFiles, SourceMap};
use partwright::units::LengthUnit;

fn dialect(name: &str, text: &str) -> Dialect {
    let files = MemoryFiles([(name.to_owned(), text.to_owned())].into());
    load(name, &files, &mut SourceMap::default()).unwrap_or_else(|e| panic!("{name}: {e:#?}"))
}

fn matrix(name: &str, text: &str) -> Matrix {
    run(&dialect(name, text), LengthUnit::Millimetre)
}

fn in_inches(name: &str, text: &str) -> Matrix {
    run(&dialect(name, text), LengthUnit::Inch)
}

/// Rows that are wrong.
fn wrong(matrix: &Matrix) -> Vec<&'static str> {
    matrix.rows.iter().filter(|r| r.verdict == Verdict::Wrong).map(|r| r.title).collect()
}

#[test]
fn no_row_of_a_built_in_post_is_wrong() {
    for name in builtin_names() {
        for matrix in [matrix(name, ""), in_inches(name, "")] {
            let units = matrix.units;
            assert!(matrix.passed(), "{name}, {units}: {:?}\n{}", wrong(&matrix), print::text(&matrix));
        }
    }
}

/// A mistake that only programs in inches have.
#[test]
fn what_is_wrong_in_inches_alone_is_found() {
    let text = "inherits = \"fanuc\"\n[feed]\nscale = { mm = 1, inch = 10 }\n";
    assert!(wrong(&matrix("my.post.toml", text)) == ["10 inch a minute in an inch program"]);
    let found = wrong(&in_inches("my.post.toml", text));
    assert!(found.contains(&"per minute, per revolution, per minute again"), "{found:?}");
    let told = findings(&dialect("my.post.toml", text), "my.post.toml");
    assert!(told.iter().any(|d| d.message.contains("comes out wrong in inches")), "{told:#?}");
}

/// Rows that do not apply to a post, with the reason that the matrix gives.
const NOT_APPLICABLE: &[(&str, &str, &str)] = &[
    ("apt-cl", "rapid that moves all axes", "CL data say where a rapid goes"),
    ("apt-cl", ROTARY, "no rotary table"),
    ("grbl", ROTARY, "no rotary table"),
    ("grblhal", ROTARY, "no rotary table"),
    ("okuma", ROTARY, "no rotary table"),
    ("centroid", ROTARY, "no rotary table"),
    ("marlin", ROTARY, "no rotary table"),
];
const ROTARY: &str = "feed along the part with a rotary table";

#[test]
fn what_does_not_apply_is_said_with_its_reason() {
    for name in builtin_names() {
        let matrix = matrix(name, "");
        let rows: Vec<&Row> = matrix.rows.iter().filter(|r| r.verdict == Verdict::NotApplicable).collect();
        let known: Vec<_> = NOT_APPLICABLE.iter().filter(|(post, ..)| *post == name).collect();
        assert_eq!(rows.len(), known.len(), "{name}: {rows:#?}");
        for (_, title, reason) in known {
            assert!(rows.iter().any(|r| r.title == *title && r.remark.contains(reason)), "{name}: {rows:#?}");
        }
    }
}

/// Facts of controls: the post, the row, a line that it must emit.
const FACTS: &[(&str, &str, &str)] = &[
    ("fanuc", "0.5 s in a block of its own", "G4 P500"),
    ("linuxcnc", "0.5 s in a block of its own", "G4 P0.5"),
    ("grbl", "12.25 s in a block of its own", "G4 P12.25"),
    ("fanuc", "cutter compensation left, then none", "G1 G41 D1 X10. F300."),
    ("okuma", "cutter compensation left, then none", "G40 Y20."),
    ("sinumerik", "cutter compensation left, then none", "G1 G41 X10 F300"),
    ("heidenhain", "cutter compensation left, then none", "7 L X+10 RL F300"),
    ("apt-cl", "cutter compensation left, then none", "CUTCOM/LEFT"),
    ("fanuc", "full circle", "G3 I-10. J0."),
    ("linuxcnc", "full circle", "G3 I-10 J0"),
    ("grbl", "full circle", "G3 X10 I-10 J0"),
    ("fanuc", "-0.00004 and zero", "X0. Y0."),
    ("linuxcnc", "-0.00004 and zero", "X0 Y0"),
    ("linuxcnc", "comment that a control would obey", "(- MSG, DEBUG, PRINT, LOG)"),
    ("fanuc", "per minute, per revolution, per minute again", "G94 X30. F300."),
    ("grbl", "per minute, per revolution, per minute again", "X20 F200"),
];

#[test]
fn rows_are_emitted_as_the_controls_want_them() {
    for &(post, title, line) in FACTS {
        let matrix = matrix(post, "");
        let row = matrix.rows.iter().find(|r| r.title == title).expect("a row");
        assert!(row.emitted.iter().any(|l| l == line), "{post}: {title}: {:?}", row.emitted);
    }
}

#[test]
fn the_matrix_is_as_its_schema_says() {
    let schema = include_str!("../docs/schema/selftest.schema.json");
    let schema: serde_json::Value = serde_json::from_str(schema).expect("JSON");
    let value = serde_json::to_value(matrix("grbl", "")).expect("JSON");
    common::schema::check(&schema, &schema, &value, "matrix").expect("as the schema says");
}

#[test]
fn a_wrong_unit_of_dwells_is_found() {
    let text = "inherits = \"fanuc\"\n[dwell]\nunit = \"s\"\ndecimals = 3\n";
    let matrix = matrix("my.post.toml", text);
    let found = wrong(&matrix);
    assert!(
        found.starts_with(&["0.5 s in a block of its own", "12.25 s in a block of its own"]),
        "{found:?}"
    );
    assert!(!found.contains(&"full circle"), "{found:?}");
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
    assert!(wrong(&lines).contains(&"spindle clockwise, then counter-clockwise"), "{:?}", wrong(&lines));
}

#[test]
fn a_template_that_fails_is_a_wrong_row_and_not_the_end() {
    let text = "inherits = \"fanuc\"\n[templates]\noperation = \"{{ operation.nmae }}\"\n";
    let found = matrix("my.post.toml", text);
    assert!(wrong(&found).contains(&"a contour at two depths"), "{}", print::text(&found));
    assert!(!wrong(&found).contains(&"full circle"));
}

/// Posts whose curves are pieces: the row of curves is right where the control cuts them, and arcs where it cuts chords.
#[test]
fn posts_with_pieces_have_their_curves() {
    let right = [
        ("itnc530.post.toml", include_str!("../examples/posts/itnc530.post.toml")),
        ("linuxcnc_g5.post.toml", include_str!("../examples/posts/linuxcnc_g5.post.toml")),
        ("sinumerik_poly.post.toml", include_str!("../examples/posts/sinumerik_poly.post.toml")),
    ];
    let chords = [
        ("grblhal_g5.post.toml", include_str!("../examples/posts/grblhal_g5.post.toml")),
        ("marlin_g5.post.toml", include_str!("../examples/posts/marlin_g5.post.toml")),
    ];
    let right = right.map(|post| (post, Verdict::Right, "NURBS in"));
    for ((name, text), verdict, remark) in
        right.into_iter().chain(chords.map(|post| (post, Verdict::Expressed, "arcs")))
    {
        let matrix = matrix(name, text);
        assert!(matrix.passed(), "{name}: {:?}", wrong(&matrix));
        let row = matrix.rows.iter().find(|r| r.title == "NURBS round a part").expect("the row");
        assert!(row.verdict == verdict && row.remark.contains(remark), "{name}: {row:#?}");
    }
}
