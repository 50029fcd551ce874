//! How runs end: every exit status, what is on which stream, and that nothing is written by a run that fails.

mod common;

use common::POINTS;
use common::scratch::{Scratch, code, run_in, stderr};

/// A post whose words do not say what it means: its programs fail their proof.
const LIE: &str = "inherits = \"linuxcnc\"\n[spindle]\nclockwise = \"M4\"\ncounter-clockwise = \"M3\"\n";

/// A program whose cuts are compared with a contour.
const CAM: &str = "\
UNITS/ MM
F1 = FOLLOW/ TRANSL, ROLLER, 8
M1 = MOTION/ DWELL, 30, RISE, 120, 20, MODSIN, DWELL, 60, RETURN, 120, 20, MODSIN, DWELL, 30
C1 = CAM/ PLATE, BASE, 20, FOLLOW, F1, MOTION, M1
T1 = CUTTER/ FLAT, 16, NUMBER, 1
LOADTL/ T1
SPINDL/ 1200, CLW
FEDRAT/ 300
INTOL/ 0.01
OUTTOL/ 0.01
P1 = PROFIL/ C1, LINEAR, DEPTH, 5
FINI
";

fn scratch(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    scratch
        .write("cam.apt", CAM)
        .write("points.apt", POINTS)
        .write("broken.apt", "GOTO/ 1 2\n")
        .write("lie.post.toml", LIE);
    scratch
}

#[test]
fn every_exit_status_has_its_reason() {
    let scratch = scratch("exit-all");
    scratch.write("other.nc", "%\nO1\nG21 G90 G94\nT1 M6\nG43 H1 G0 Z5.\nM30\n%\n");
    assert_eq!(code(&scratch.run(&["build", "points.apt", "--post", "fanuc", "-o", "a.nc"])), 0);
    let cases: [(&[&str], i32, &str); 9] = [
        (&["build", "broken.apt", "--post", "fanuc"], 1, "E0101"),
        (&["build", "points.apt", "--post", "nobody"], 2, "E0701"),
        (&["build", "points.apt", "--post", "fanuc,grbl"], 2, "`--post fanuc --post heidenhain`"),
        (&["build", "points.apt", "--post", "fanuc", "--no-such-option"], 2, "--no-such-option"),
        (&["diff", "a.nc", "other.nc", "--post", "fanuc"], 3, ""),
        (&["test", "points.apt"], 2, "E0956"),
        (&["build", "cam.apt", "--post", "lie.post.toml"], 4, "E08"),
        (&["post", "selftest", "lie.post.toml"], 4, ""),
        (&["post", "selftest", "marlin"], 0, ""),
    ];
    for (args, status, part) in cases {
        let output = scratch.run(args);
        assert_eq!(code(&output), status, "{args:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(part), "{args:?}: {}", stderr(&output));
    }
}

#[test]
fn a_program_that_fails_its_proof_writes_nothing_and_keeps_old_files() {
    let scratch = scratch("exit-proof");
    scratch.write("old.nc", "old").write("old.json", "old");
    let args = ["build", "cam.apt", "--post", "lie.post.toml", "-o", "old.nc"];
    let more = ["--report", "old.json", "--source-map", "map.json"];
    let output = scratch.run(&args.iter().chain(&more).copied().collect::<Vec<_>>());
    assert_eq!(code(&output), 4, "{}", stderr(&output));
    assert!(stderr(&output).contains("nothing was written"), "{}", stderr(&output));
    assert_eq!((scratch.read("old.nc"), scratch.read("old.json")), ("old".to_owned(), "old".to_owned()));
    assert_eq!(
        scratch.names(),
        ["broken.apt", "cam.apt", "lie.post.toml", "old.json", "old.nc", "points.apt"]
    );
    assert!(output.stdout.is_empty());
}

#[test]
fn one_bad_post_of_two_writes_neither() {
    let scratch = scratch("exit-two");
    let output = scratch.run(&[
        "build",
        "points.apt",
        "--post",
        "linuxcnc",
        "--post",
        "lie.post.toml",
        "--out-dir",
        "nc",
    ]);
    assert_eq!(code(&output), 4);
    assert_eq!(scratch.names(), ["broken.apt", "cam.apt", "lie.post.toml", "points.apt"]);
}

#[test]
fn what_cannot_be_written_exits_2_and_leaves_nothing() {
    let scratch = scratch("exit-unwritable");
    scratch.write("file", "not a directory");
    let cases: [&[&str]; 5] = [
        &["build", "points.apt", "--post", "grbl", "--out-dir", "file/nc"],
        &["build", "points.apt", "--post", "grbl", "-o", "x.nc", "--source-map", "file/map.json"],
        &["post", "trace", "points.apt", "-o", "file/page.html"],
        &["post", "new", "file/mill", "--from", "grbl"],
        &["new", "file/shop"],
    ];
    for args in cases {
        let output = scratch.run(args);
        assert_eq!(code(&output), 2, "{args:?}: {}", stderr(&output));
        assert!(stderr(&output).contains("E0905"), "{args:?}: {}", stderr(&output));
        assert_eq!(
            scratch.names(),
            ["broken.apt", "cam.apt", "file", "lie.post.toml", "points.apt"],
            "{args:?}"
        );
    }
}

#[test]
fn data_goes_to_standard_output_and_nothing_else_does() {
    let scratch = scratch("exit-streams");
    let output = scratch.run(&["build", "points.apt", "--post", "linuxcnc", "-o", "-"]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(text.starts_with("(points)\n") && text.ends_with("M2\n"), "{text}");
    assert!(stderr(&output).starts_with("standard output: "), "{}", stderr(&output));
    for format in ["json", "short"] {
        let quiet = scratch.run(&[
            "build",
            "points.apt",
            "--post",
            "linuxcnc",
            "-o",
            "-",
            "--message-format",
            format,
        ]);
        assert_eq!((stderr(&quiet).as_str(), quiet.stdout == text.as_bytes()), ("", true));
        let broken = scratch.run(&[
            "build",
            "broken.apt",
            "--post",
            "linuxcnc",
            "-o",
            "-",
            "--message-format",
            format,
        ]);
        assert!(broken.stdout.is_empty() && stderr(&broken).lines().count() >= 1);
    }
    let piped = run_in(&scratch.0, &["build", "-", "--post", "linuxcnc", "-o", "-"], POINTS);
    assert_eq!(String::from_utf8_lossy(&piped.stdout), text);
}

#[test]
fn no_color_is_honoured() {
    let scratch = scratch("exit-color");
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_partwright"));
    command.args(["check", "broken.apt"]).current_dir(&scratch.0).env("NO_COLOR", "1");
    assert!(!stderr(&command.output().expect("a run")).contains('\u{1b}'));
    command.args(["--color", "always"]);
    assert!(stderr(&command.output().expect("a run")).contains('\u{1b}'), "asked for by name");
}

#[test]
fn every_verb_helps_with_examples() {
    let scratch = Scratch::new("exit-help");
    for verb in [&["build"][..], &["plot"], &["post"], &["test"], &["diff"]] {
        let output = scratch.run(&verb.iter().copied().chain(["--help"]).collect::<Vec<_>>());
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        assert_eq!(code(&output), 0);
        assert!(text.contains("Examples:\n"), "{verb:?}: {text}");
    }
}
