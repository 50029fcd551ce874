//! `partwright test`, `diff` and `new`.

mod common;

use common::schema;
use common::scratch::{Scratch, code, run_in, stderr};
use serde_json::Value;

const PART: &str = "\
PARTNO part
PARAM/ DEPS = 2mm, MIN, 1mm, MAX, 9mm, 'depth'
MACHIN/ LINUXCNC
MACHIN/ FANUC
T1 = CUTTER/ FLAT, 10, NUMBER, 1
LOADTL/ T1
SPINDL/ 1000, CLW
FEDRAT/ 200
RAPID
GOTO/ 0, 0, 5
GOTO/ 0, 0, -DEPS
GOTO/ 30, 0, -DEPS
GOTO/ 30, 0, 5
FINI
";

fn stdout(output: &std::process::Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
fn what_was_accepted_passes_and_a_change_is_shown_as_text_and_as_motion() {
    let scratch = Scratch::new("golden");
    scratch.write("part.apt", PART);
    let first = scratch.run(&["test"]);
    assert_eq!(code(&first), 3, "{}", stderr(&first));
    assert!(stdout(&first).contains("new       part.apt linuxcnc\n"), "{}", stdout(&first));
    assert!(
        stdout(&first)
            .ends_with("0 ok, 2 new; --accept takes what is new and different and removes orphans\n")
    );
    assert_eq!(scratch.names(), ["part.apt"]);
    let accepted = scratch.run(&["test", "--accept"]);
    assert_eq!(code(&accepted), 0, "{}", stdout(&accepted));
    assert_eq!(scratch.names(), ["part.apt", "part.fanuc.golden.nc", "part.linuxcnc.golden.ngc"]);
    let again = scratch.run(&["test"]);
    assert_eq!(
        (code(&again), stdout(&again)),
        (0, "ok        part.apt linuxcnc\nok        part.apt fanuc\n2 ok\n".to_owned())
    );

    scratch.write("part.apt", PART.replace("GOTO/ 30, 0, -DEPS", "GOTO/ 30, 0.5, -DEPS"));
    let changed = scratch.run(&["test", "--filter", "linuxcnc"]);
    assert_eq!(code(&changed), 3);
    insta::assert_snapshot!(stdout(&changed));
    assert_eq!(code(&scratch.run(&["test", "--accept", "--filter", "linuxcnc"])), 0);
    assert_eq!(code(&scratch.run(&["test", "--filter", "linuxcnc"])), 0);
    assert_eq!(code(&scratch.run(&["test"])), 3, "fanuc was not accepted");
}

#[test]
fn a_text_that_moves_the_same_says_so() {
    let scratch = Scratch::new("golden-same");
    scratch.write("part.apt", PART);
    assert_eq!(code(&scratch.run(&["test", "--accept"])), 0);
    scratch.write("part.apt", PART.replace("PARTNO part", "PARTNO other name"));
    let changed = stdout(&scratch.run(&["test"]));
    assert_eq!(changed.matches("motion: the same").count(), 2, "{changed}");
}

#[test]
fn variants_posts_and_messages_come_from_the_test_file() {
    let scratch = Scratch::new("golden-variants");
    scratch
        .write("parts/part.apt", PART)
        .write("posts/own.post.toml", "inherits = \"grbl\"\n[tool-change]\norder = [\"text\"]\n")
        .write("parts/part.test.toml", "posts = [\"haas\"]\n[post-set]\n'numbers.plus' = 'true'\n[[variant]]\nname = \"deep\"\ndefine = { DEPS = \"3mm\" }\n[[variant]]\nname = \"own\"\nposts = [\"../posts/own.post.toml\"]\n[[variant]]\nname = \"tooDeep\"\ndefine = { DEPS = \"30mm\" }\ndiagnostics = [\"E0234\"]\n");
    let first = scratch.run(&["test", "--accept", "parts"]);
    let text = stdout(&first);
    assert_eq!(code(&first), 3, "{text}");
    assert!(
        text.contains("parts/part.apt [deep] haas\n") && text.contains("parts/part.apt [own] own\n"),
        "{text}"
    );
    assert!(text.contains("messages  parts/part.apt [tooDeep] messages\n"), "{text}");
    assert!(text.contains("expected and did not come: E0234"), "{text}");
    let came = text.split("came and is not expected: ").nth(1).expect("another code")[..5].to_owned();
    let sidecar = scratch.read("parts/part.test.toml").replace("E0234", &came);
    scratch.write("parts/part.test.toml", sidecar);
    let second = scratch.run(&["test"]);
    assert_eq!(code(&second), 0, "{}", stdout(&second));
    assert!(scratch.read("parts/part.deep.haas.golden.nc").contains("Z-3."));
    assert!(scratch.read("parts/part.own.own.golden.gcode").contains("Z-2"));
}

#[test]
fn orphans_are_reported_and_removed_when_accepting() {
    let scratch = Scratch::new("golden-orphan");
    scratch.write("part.apt", PART);
    assert_eq!(code(&scratch.run(&["test", "--accept"])), 0);
    scratch
        .write("part.haas.golden.nc", "old")
        .write("gone.fanuc.golden.nc", "old")
        .write("part.haas.nc", "not golden");
    let found = scratch.run(&["test"]);
    assert_eq!(code(&found), 3);
    let text = stdout(&found);
    assert!(
        text.contains("orphan    part.apt haas\n          part.haas.golden.nc: no test makes this file"),
        "{text}"
    );
    assert!(text.contains("gone.fanuc.golden.nc"), "{text}");
    assert_eq!(code(&scratch.run(&["test", "--accept"])), 0);
    assert_eq!(
        scratch.names(),
        ["part.apt", "part.fanuc.golden.nc", "part.haas.nc", "part.linuxcnc.golden.ngc"]
    );
}

#[test]
fn line_ends_that_differ_are_said_and_not_shown_line_by_line() {
    let scratch = Scratch::new("line-ends");
    scratch.write("part.apt", PART);
    assert_eq!(code(&scratch.run(&["test", "--accept"])), 0);
    let golden = scratch.read("part.fanuc.golden.nc");
    scratch.write("part.fanuc.golden.nc", golden.replace('\n', "\r\n"));
    let output = scratch.run(&["test", "--filter", "fanuc"]);
    assert_eq!(code(&output), 3);
    assert_eq!(
        stdout(&output),
        "different part.apt fanuc\n          part.fanuc.golden.nc\n          only the line ends differ: CR LF in the \
         golden file, LF in the new program; `*.golden.* -text` in .gitattributes keeps git from changing them\n          \
         motion: the same\n0 ok, 1 different; --accept takes what is new and different and removes orphans\n"
    );
}

#[test]
fn two_programs_with_one_golden_file_are_refused() {
    let scratch = Scratch::new("one-golden");
    let points = "LOADTL/1\nSPINDL/100,RPM\nFEDRAT/5,MMPM\nRAPID\nGOTO/1,0,9\nGOTO/2,0,0\nFINI\n";
    scratch.write("part.apt", PART).write("part.cls", points);
    scratch.write("part.test.toml", "posts = [\"fanuc\"]\n");
    for args in [&["test"][..], &["test", "--accept"]] {
        let output = scratch.run(args);
        assert_eq!(code(&output), 2, "{}", stdout(&output));
        let message =
            "part.fanuc.golden.nc would be the golden file of `part.apt fanuc` and of `part.cls fanuc`";
        assert!(
            stderr(&output).contains("E0909") && stderr(&output).contains(message),
            "{}",
            stderr(&output)
        );
    }
    assert_eq!(scratch.names(), ["part.apt", "part.cls", "part.test.toml"]);
}

#[test]
fn programs_that_are_no_tests_are_left_out_and_broken_ones_are_not() {
    let scratch = Scratch::new("golden-skip");
    scratch
        .write("main.apt", PART.replace("RAPID\n", "INCLUD/ 'lib.apt'\nRAPID\n"))
        .write("lib.apt", "A = 5\n")
        .write("alone.apt", "B = 5\n")
        .write(".hidden/x.apt", "GOTO/ 1 2\n")
        .write("target/x.apt", "GOTO/ 1 2\n");
    let accepted = scratch.run(&["test", "--accept"]);
    let text = stdout(&accepted);
    assert_eq!(code(&accepted), 0, "{text}{}", stderr(&accepted));
    assert!(text.contains("skipped   lib.apt: other programs include it\n"), "{text}");
    assert!(
        text.contains("skipped   alone.apt: it names no machine, and there is no alone.test.toml\n"),
        "{text}"
    );
    scratch.write("main.apt", PART.replace("GOTO/ 30, 0, 5", "GOTO/ 30 0, 5"));
    let broken = scratch.run(&["test"]);
    assert_eq!(code(&broken), 1, "{}", stdout(&broken));
    assert!(
        stdout(&broken).contains("errors    main.apt messages\n          error[E0101]"),
        "{}",
        stdout(&broken)
    );
    assert!(!stdout(&broken).contains("orphan"), "{}", stdout(&broken));
    let accepted = scratch.run(&["test", "--accept"]);
    assert_eq!(code(&accepted), 1);
    assert!(scratch.names().contains(&"main.fanuc.golden.nc".to_owned()));
}

#[test]
fn trouble_with_test_files_and_nothing_to_do_exit_2() {
    let scratch = Scratch::new("golden-trouble");
    scratch
        .write("empty/readme", "nothing")
        .write("a/part.apt", PART)
        .write("a/part.test.toml", "post = [\"fanuc\"]\n");
    scratch
        .write("b/part.apt", PART)
        .write("b/part.test.toml", "posts = [\"fanuk\"]\n")
        .write("c/part.apt", PART);
    let cases: [(&[&str], &str); 6] = [
        (&["test", "empty"], "E0956"),
        (&["test", "c", "--filter", "xyzzy"], "E0956"),
        (&["test", "nowhere"], "E0901"),
        (&["test", "a"], "E0955"),
        (&["test", "b"], "E0701"),
        (&["test", "c", "-j", "0"], "E0911"),
    ];
    for (args, id) in cases {
        let output = scratch.run(args);
        assert_eq!(code(&output), 2, "{args:?}: {}{}", stdout(&output), stderr(&output));
        assert!(stderr(&output).contains(id), "{args:?}: {}", stderr(&output));
    }
    let place = scratch.run(&["test", "a", "--message-format", "short"]);
    assert!(stderr(&place).starts_with("a/part.test.toml:1:1: error[E0955]"), "{}", stderr(&place));
}

#[test]
fn what_a_test_file_gives_is_shown_in_it() {
    let scratch = Scratch::new("golden-given");
    scratch.write("part.apt", PART);
    let posts = "posts = [\"haas\"]\n[[variant]]\nname = \"fanuk\"\nposts = [\"fanuc\", \"fanuk\"]\n";
    let cases = [
        (posts, 2, "part.test.toml:4:19: error[E0701]"),
        ("posts = [\"./x.post.toml\"]\n", 2, "part.test.toml:1:10: error[E0706]"),
        (
            "[[variant]]\nname = \"a\"\ndefine = { DEPS = \"3\", NOPE = \"3mm\" }\n",
            1,
            "──── part.test.toml:3:31",
        ),
        ("posts = [\"fanuc\", \"Fanuc\"]\n", 2, "part.test.toml:1:19: error[E0955]"),
        ("post-set = { 'numbers.plus' = 'no' }\n", 2, "part.test.toml:1:31: error[E0704]"),
        ("[post-set]\n'options.WCZ' = '7'\n", 2, "part.test.toml:2:17: error[E0713]"),
    ];
    for (text, status, place) in cases {
        scratch.write("part.test.toml", text);
        let output = scratch.run(&["test", "--message-format", "short"]);
        let place = place.replace("──── ", "┌─ ");
        let said = stderr(&output) + &stdout(&output);
        assert_eq!((code(&output), said.contains(&place)), (status, true), "{place}: {said}");
    }
}

#[cfg(unix)]
#[test]
fn a_golden_file_that_cannot_be_read_is_not_a_new_one() {
    let scratch = Scratch::new("golden-unreadable");
    scratch.write("part.apt", PART);
    assert_eq!(code(&scratch.run(&["test", "--accept"])), 0);
    let link = scratch.0.join("part.fanuc.golden.nc");
    std::fs::remove_file(&link).expect("removed");
    std::os::unix::fs::symlink("nowhere", &link).expect("a link");
    for args in [&["test"][..], &["test", "--accept"]] {
        let output = scratch.run(args);
        assert_eq!(code(&output), 2, "{}", stdout(&output));
        assert!(stderr(&output).contains("E0901") && stderr(&output).contains("part.fanuc.golden.nc"));
    }
    // Other tests do not need it.
    assert_eq!(code(&scratch.run(&["test", "--filter", "linuxcnc"])), 0);
    assert!(link.is_symlink());
    // What a killed process left is no golden file.
    std::fs::remove_file(&link).expect("removed");
    scratch.write(".part.fanuc.golden.nc.77.tmp", "half").write(".gone.fanuc.golden.nc.77.tmp", "half");
    assert_eq!(code(&scratch.run(&["test", "--accept"])), 0);
    let output = scratch.run(&["test"]);
    assert_eq!(code(&output), 0, "{}", stdout(&output));
}

#[test]
fn one_program_can_be_tested_alone_and_threads_do_not_matter() {
    let scratch = Scratch::new("golden-one");
    scratch.write("one.apt", PART).write("two.apt", PART);
    assert_eq!(code(&scratch.run(&["test", "one.apt", "--accept"])), 0);
    assert_eq!(scratch.names(), ["one.apt", "one.fanuc.golden.nc", "one.linuxcnc.golden.ngc", "two.apt"]);
    let texts: Vec<String> = ["1", "2"].iter().map(|j| stdout(&scratch.run(&["test", "-j", j]))).collect();
    assert_eq!(texts[0], texts[1]);
    assert!(
        texts[0]
            .starts_with("ok        one.apt linuxcnc\nok        one.apt fanuc\nnew       two.apt linuxcnc\n"),
        "{}",
        texts[0]
    );
}

#[test]
fn reports_for_programs_are_as_their_schemas_say() {
    let scratch = Scratch::new("golden-reports");
    scratch.write("part.apt", PART);
    assert_eq!(code(&scratch.run(&["test", "--accept"])), 0);
    scratch.write("part.apt", PART.replace("30, 0, 5", "31, 0, 5").replace("FEDRAT/ 200", "FEDRAT/ 250"));
    scratch.write("part.x.golden.nc", "old").write("lib.apt", "A = '<&>'\n");
    let json = scratch.run(&["test", "--format", "json", "-o", "report.json"]);
    assert_eq!((code(&json), stdout(&json).as_str()), (3, ""));
    let report: Value = serde_json::from_str(&scratch.read("report.json")).expect("JSON");
    let schema: Value =
        serde_json::from_str(&stdout(&scratch.run(&["schema", "test-report"]))).expect("JSON");
    schema::check(&schema, &schema, &report, "report").expect("as the schema says");
    let words: Vec<&str> =
        report["tests"].as_array().expect("tests").iter().filter_map(|t| t["verdict"].as_str()).collect();
    assert_eq!(words, ["different", "different", "orphan"]);
    assert_eq!(report["tests"][0]["motion"]["path"]["largest"], 1.0);
    let junit = scratch.run(&["test", "--format", "junit"]);
    assert_eq!(code(&junit), 3);
    insta::assert_snapshot!(stdout(&junit));
}

#[test]
fn diff_compares_programs_as_motion() {
    let scratch = Scratch::new("diff");
    scratch.write("part.apt", PART);
    let build = |out: &str, post: &str, extra: &[&str]| {
        let args: Vec<&str> =
            ["build", "part.apt", "--post", post, "-o", out].iter().chain(extra).copied().collect();
        assert_eq!(code(&scratch.run(&args)), 0);
    };
    build("a.fanuc.nc", "fanuc", &[]);
    build("b.nc", "fanuc", &["--post-set", "modal.axes=false"]);
    build("deep.nc", "fanuc", &["-D", "DEPS=2.5mm"]);
    let same = scratch.run(&["diff", "a.fanuc.nc", "b.nc"]);
    assert_eq!(code(&same), 0, "{}{}", stdout(&same), stderr(&same));
    assert!(stdout(&same).starts_with("same motion: "), "{}", stdout(&same));
    let deeper = scratch.run(&["diff", "a.fanuc.nc", "deep.nc"]);
    assert_eq!(code(&deeper), 3);
    assert!(stdout(&deeper).contains("at most 0.5 mm apart anywhere"), "{}", stdout(&deeper));
    assert_eq!(code(&scratch.run(&["diff", "a.fanuc.nc", "deep.nc", "--tolerance", "0.6"])), 0);
    let json = scratch.run(&["diff", "a.fanuc.nc", "deep.nc", "--format", "json"]);
    let value: Value = serde_json::from_str(&stdout(&json)).expect("JSON");
    let schema: Value = serde_json::from_str(&stdout(&scratch.run(&["schema", "diff"]))).expect("JSON");
    schema::check(&schema, &schema, &value, "diff").expect("as the schema says");
    assert_eq!(code(&scratch.run(&["diff", "b.nc", "deep.nc", "--post", "fanuc"])), 3);
}

#[test]
fn diff_says_what_it_cannot_compare() {
    let scratch = Scratch::new("diff-trouble");
    scratch.write("a.nc", "%\nO1\nG1 X10.\nM30\n%\n");
    let cases: [(&[&str], i32, &str); 5] = [
        (&["diff", "a.nc", "a.nc"], 2, "E0907"),
        (&["diff", "a.nc", "nothing.nc", "--post", "fanuc"], 2, "E0901"),
        (&["diff", "a.nc", "a.nc", "--post", "fanuk"], 2, "E0701"),
        (&["diff", "a.nc", "a.nc", "--post", "fanuc", "--tolerance", "0"], 2, "a number above 0"),
        (&["diff", "a.nc", "a.nc", "--post", "fanuc"], 4, "E0954"),
    ];
    for (args, status, id) in cases {
        let output = scratch.run(args);
        assert_eq!(code(&output), status, "{args:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(id), "{args:?}: {}", stderr(&output));
    }
}

#[test]
fn diff_tells_what_it_could_follow_and_takes_tools_by_any_name() {
    let scratch = Scratch::new("diff-names");
    let program = |tool: &str, more: &str| {
        format!("T=\"{tool}\"\nM6\nD1\nS1000 M3\nG0 G90 G17 G40 G710 X0 Y0 Z5\nG1 Z-1 F100\n{more}M30\n")
    };
    scratch.write("a.mpf", program("MILL 10", "")).write("b.mpf", program("Mill 12", ""));
    let diff = |a: &str, b: &str| scratch.run(&["diff", a, b, "--post", "sinumerik"]);
    assert_eq!(code(&diff("a.mpf", "a.mpf")), 0, "{}", stderr(&diff("a.mpf", "a.mpf")));
    let other = diff("a.mpf", "b.mpf");
    assert_eq!((code(&other), stdout(&other).starts_with("tool: ")), (3, true), "{}", stdout(&other));
    scratch.write("c.mpf", program("MILL 10", "CYCLE999(1)\n"));
    let broken = diff("a.mpf", "c.mpf");
    assert_eq!(code(&broken), 4);
    let said = "not compared as a whole: the control complains of 0 blocks of a.mpf and 1 of c.mpf\n";
    assert!(stdout(&broken).starts_with(said), "{}", stdout(&broken));
}

#[test]
fn diff_shows_the_first_block_that_differs_of_those_it_cannot_follow() {
    let scratch = Scratch::new("diff-blocks");
    let diff = |a: &str, b: &str| {
        for (name, cycles) in [("a.mpf", a), ("b.mpf", b)] {
            scratch.write(name, format!("G0 G90 G17 G40 G710 X0 Y0 Z5\n{cycles}M30\n"));
        }
        let output = scratch.run(&["diff", "a.mpf", "b.mpf", "--post", "sinumerik"]);
        assert_eq!(code(&output), 4, "{}", stderr(&output));
        stdout(&output)
    };
    let said = |blocks: [&str; 2], how: &str| {
        let [a, b] = blocks;
        format!(
            "not compared as a whole: the control complains of {a} of a.mpf and {b} of b.mpf\n\
             what can be followed is the same\n{how}\n"
        )
    };
    let (one, other) = ("CYCLE999(1)\n", "CYCLE999(2)\n");
    let (both, twice) = (format!("{one}{other}"), format!("{one}{one}"));
    assert_eq!(
        diff(one, other),
        said(
            ["1 block", "1"],
            "of what cannot be followed, line 2 of a.mpf is `CYCLE999(1)`, and line 2 of b.mpf is `CYCLE999(2)`"
        )
    );
    assert_eq!(
        diff(&twice, &both),
        said(
            ["2 blocks", "2"],
            "of what cannot be followed, line 3 of a.mpf is `CYCLE999(1)`, and line 3 of b.mpf is `CYCLE999(2)`"
        )
    );
    assert_eq!(
        diff(one, ""),
        said(
            ["1 block", "0"],
            "of what cannot be followed, line 2 of a.mpf is `CYCLE999(1)`, and b.mpf has none"
        )
    );
    assert_eq!(
        diff(one, &both),
        said(
            ["1 block", "2"],
            "of what cannot be followed, a.mpf has none, and line 3 of b.mpf is `CYCLE999(2)`"
        )
    );
    // Blocks in between that are followed do not count.
    assert_eq!(
        diff(&both, &format!("{one}G17\n{other}")),
        said(["2 blocks", "2"], "what cannot be followed is written the same")
    );
    // Several complaints of one block; long ones are cut off, characters that a terminal obeys left out.
    let long = format!("CYCLE999(\u{1b}{}\n", "7".repeat(80));
    let shown = "7".repeat(60 - "CYCLE999(".len());
    assert_eq!(
        diff("", &long),
        said(
            ["0 blocks", "1"],
            &format!("of what cannot be followed, a.mpf has none, and line 2 of b.mpf is `CYCLE999({shown}`")
        )
    );
}

#[test]
fn a_new_project_passes_every_step_of_its_own_ci_file() {
    let readable = |name: &&str| partwright::readback::needs(name).is_ok();
    for from in partwright::post::builtin_names().filter(readable) {
        let scratch = Scratch::new(&format!("new-{from}"));
        let made = scratch.run(&["new", "shop", "--from", from]);
        assert_eq!(code(&made), 0, "{from}: {}", stderr(&made));
        let workflow = scratch.read("shop/.github/workflows/partwright.yml");
        let steps: Vec<&str> =
            workflow.lines().filter_map(|l| l.trim().strip_prefix("- run: partwright ")).collect();
        assert_eq!(steps.len(), 2, "{workflow}");
        for step in steps {
            let args: Vec<&str> = step.split(' ').collect();
            let output = run_in(&scratch.0.join("shop"), &args, "");
            assert_eq!(code(&output), 0, "{from}: {step}: {}{}", stdout(&output), stderr(&output));
        }
        let tested = stdout(&run_in(&scratch.0.join("shop"), &["test"], ""));
        assert_eq!(
            tested, "ok        parts/cam.apt [standard] mill\nok        parts/cam.apt [long] mill\n2 ok\n",
            "{from}"
        );
    }
}

#[test]
fn a_project_is_not_made_over_another() {
    let scratch = Scratch::new("new-there");
    scratch.write("shop/notes", "mine").write("file", "mine");
    for dir in ["shop", "file"] {
        let output = scratch.run(&["new", dir]);
        assert_eq!(code(&output), 2);
        assert!(stderr(&output).contains("E0952"), "{}", stderr(&output));
    }
    let unknown = scratch.run(&["new", "other", "--from", "fanuk"]);
    assert_eq!(code(&unknown), 2);
    assert!(stderr(&unknown).contains("E0701"), "{}", stderr(&unknown));
    assert_eq!(scratch.names(), ["file", "shop"]);
}

/// What the command line says of a CL file, its test file can say, too.
#[test]
fn test_files_say_how_to_read_cl_files() {
    let scratch = Scratch::new("golden-cl");
    // In columns 73 to 80 there is a card's name; TWIDDLE is no record; nothing tells that it is a CL file but GOTO.
    let card = format!("{:72}CARD0012\n", "GOTO/ 1, 0, 5");
    let text = format!(
        "UNITS/ MM\nLOADTL/ 1\nSPINDL/ 900, CLW\nFEDRAT/ 90\nRAPID\nGOTO/ 0, 0, 5\nTWIDDLE/ 1\n{card}FINI\nA = B\n"
    );
    scratch.write("part.apt", &text);
    let cases = [
        ("", "E0201", "E1001"),
        ("producer = \"plain\"\n", "part.apt:8", "E0201"),
        ("producer = \"plain\"\ncard-columns = true\n", "E1001", "part.apt:8"),
        ("producer = \"plain\"\nlenient = true\ncard-columns = true\n", "is not there yet", "E1001]"),
    ];
    for (keys, said, not) in cases {
        scratch.write("part.test.toml", format!("posts = [\"fanuc\"]\n{keys}"));
        let output = scratch.run(&["test"]);
        let all = stderr(&output) + &stdout(&output);
        assert!(code(&output) != 0 && all.contains(said) && !all.contains(not), "{keys}: {all}");
    }
    scratch.write("part.test.toml", "posts = [\"fanuc\"]\nproducer = \"catja\"\n");
    let output = scratch.run(&["test", "--message-format", "short"]);
    assert!(stderr(&output).contains("part.test.toml:2:12: error[E0955]"), "{}", stderr(&output));
    assert!(stderr(&output).contains("did you mean `catia`?"), "{}", stderr(&output));
}
