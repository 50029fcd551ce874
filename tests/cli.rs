//! The command: exit codes, where outputs go, and that a failed build leaves old files alone.

mod common;

use common::scratch::{Scratch, code, run_in, stderr};

const BROKEN: &str = "PARTNO broken\nGOTO/ 1, 2 3\n";

#[test]
fn errors_of_the_program_exit_1_and_show_their_place() {
    let scratch = Scratch::new("errors");
    scratch.write("a.apt", BROKEN);
    let output = scratch.run(&["check", "a.apt", "--message-format", "short"]);
    assert_eq!(code(&output), 1);
    assert!(stderr(&output).contains("a.apt:2:12: error[E0101]: expected a comma\n"), "{}", stderr(&output));
    assert!(output.stdout.is_empty());
}

#[test]
fn json_messages_are_one_object_a_line() {
    let scratch = Scratch::new("json");
    scratch.write("a.apt", BROKEN);
    let output = scratch.run(&["check", "a.apt", "--message-format", "json"]);
    let text = stderr(&output);
    for line in text.lines() {
        let object: serde_json::Value = serde_json::from_str(line).expect("an object");
        assert_eq!(object["source"], "partwright");
    }
    let first: serde_json::Value =
        serde_json::from_str(text.lines().next().expect("a line")).expect("an object");
    assert_eq!(first["range"]["start"]["line"], 1);
    assert_eq!(first["range"]["start"]["character"], 11);
    assert_eq!(first["file"], "a.apt");
}

#[test]
fn usage_and_file_trouble_exit_2() {
    let scratch = Scratch::new("trouble");
    scratch.write("a.apt", "PARTNO fine\n").write("latin.apt", b"PARTNO caf\xe9\n");
    assert_eq!(code(&scratch.run(&["build"])), 2);
    assert_eq!(code(&scratch.run(&["build", "--no-such-option", "a.apt"])), 2);
    let cases: [(&[&str], &str); 7] = [
        (&["check", "nothing.apt"], "E0901"),
        (&["check", "."], "E0901"),
        (&["check", "latin.apt"], "E0903"),
        (&["explain", "E9999"], "E0908"),
        (&["check", "a.apt", "--deny", "W9999"], "E0908"),
        (&["check", "a.apt", "-D", "X"], "E0910"),
        (&["check", "a.apt", "-j", "0"], "E0911"),
    ];
    for (args, id) in cases {
        let output = scratch.run(args);
        assert_eq!(code(&output), 2, "{args:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(id), "{args:?}: {}", stderr(&output));
    }
}

#[test]
fn a_failed_build_leaves_old_outputs_alone() {
    let scratch = Scratch::new("old");
    scratch.write("a.apt", BROKEN).write("a.linuxcnc.ngc", "old").write("b.nc", "old");
    assert_eq!(code(&scratch.run(&["build", "a.apt", "--post", "linuxcnc"])), 1);
    assert_eq!(code(&scratch.run(&["build", "a.apt", "--post", "fanuc", "-o", "b.nc"])), 1);
    assert_eq!((scratch.read("a.linuxcnc.ngc"), scratch.read("b.nc")), ("old".to_owned(), "old".to_owned()));
    assert_eq!(scratch.names(), ["a.apt", "a.linuxcnc.ngc", "b.nc"]);
}

#[test]
fn warnings_can_be_denied() {
    let scratch = Scratch::new("deny");
    scratch.write("a.apt", "PARTNO a\nA = 1 + $ comment\n2\n");
    assert_eq!(code(&scratch.run(&["check", "a.apt"])), 0);
    assert_eq!(code(&scratch.run(&["check", "a.apt", "--deny", "warnings"])), 1);
    assert_eq!(code(&scratch.run(&["check", "a.apt", "--deny", "W0101"])), 1);
}

#[test]
fn standard_input_is_a_program_too() {
    let scratch = Scratch::new("stdin");
    let output = run_in(&scratch.0, &["check", "-", "--message-format", "short"], BROKEN);
    assert_eq!(code(&output), 1);
    assert!(stderr(&output).contains("<stdin>:2:12: error[E0101]"), "{}", stderr(&output));
}

#[test]
fn explain_prints_pages_and_the_list() {
    let scratch = Scratch::new("explain");
    let page = scratch.run(&["explain", "e0101"]);
    assert_eq!(code(&page), 0);
    assert!(String::from_utf8_lossy(&page.stdout).starts_with("# E0101: "));
    let list = scratch.run(&["explain"]);
    assert!(String::from_utf8_lossy(&list.stdout).contains("\nE0102  "));
}

#[test]
fn color_is_asked_for_or_left_out() {
    let scratch = Scratch::new("color");
    scratch.write("a.apt", BROKEN);
    assert!(!stderr(&scratch.run(&["check", "a.apt"])).contains('\u{1b}'));
    assert!(stderr(&scratch.run(&["check", "a.apt", "--color", "always"])).contains('\u{1b}'));
}
