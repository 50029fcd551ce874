//! CL files in each producer's style: read, posted to every control, proven, snapshotted; found by directory.
//!
//! `INSTA_UPDATE=always cargo test --test cl_files` rewrites the snapshots.

mod common;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use common::Directory;
use partwright::diag::Severity;
use partwright::driver::{self, Build, Options};
use partwright::source::MemoryFiles;
use rayon::prelude::*;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cl")
}

fn files() -> Vec<String> {
    let entries = std::fs::read_dir(folder()).expect("the folder");
    let mut names: Vec<String> =
        entries.filter_map(Result::ok).map(|e| e.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

fn options(posts: &[&str], only_nc: bool) -> Options {
    Options { posts: posts.iter().map(|p| (*p).to_owned()).collect(), only_nc, ..Options::default() }
}

fn messages(build: &Build) -> String {
    let mut out = String::new();
    for d in &build.diagnostics {
        let place = d.primary.as_ref().map(|p| build.sources.file(p.span.file).line_column(p.span.start).0);
        let _ = writeln!(out, "{} line {}: {}", d.code.id, place.unwrap_or(0), d.message);
    }
    out
}

#[test]
fn every_file_posts_and_its_programs_are_as_reviewed() {
    for name in files() {
        let build = driver::build(&name, &Directory(folder()), &options(&["linuxcnc", "fanuc"], false));
        let mut text = messages(&build);
        let cl = build.cl.as_ref().map(partwright::cl::print::print).unwrap_or_default();
        let _ = writeln!(text, "== cl\n{cl}");
        for output in &build.outputs {
            let proven = output.proven.as_ref().unwrap_or_else(|| panic!("{name}: {text}"));
            let _ = writeln!(text, "== {}\n{}", output.post, proven.text());
        }
        insta::assert_snapshot!(name.replace('.', "_"), text);
    }
}

/// Workers of the pool that all wait for a proof would wait for ever.
#[test]
fn many_files_are_posted_at_once() {
    let posted = (0..32).into_par_iter().map(|_| {
        let posts = ["linuxcnc", "fanuc", "heidenhain"];
        let build = driver::build("nx_pocket.cls", &Directory(folder()), &options(&posts, true));
        build.outputs.iter().filter(|o| o.proven.is_some()).count()
    });
    assert_eq!(posted.sum::<usize>(), 3 * 32);
}

#[test]
fn every_control_gets_a_proven_program_or_a_reason() {
    let posts: Vec<&str> = partwright::post::builtin_names().collect();
    for name in files() {
        let build = driver::build(&name, &Directory(folder()), &options(&posts, true));
        // A post whose control nobody reads back makes no program.
        let unread = |d: &&partwright::diag::Diagnostic| d.code.id == "E0810";
        let errors: Vec<_> = build
            .diagnostics
            .iter()
            .filter(|d| d.severity == Severity::Error && !unread(d))
            .map(|d| (d.code.id, &d.message))
            .collect();
        assert!(errors.is_empty(), "{name}: {errors:#?}");
        let unproven = build.outputs.iter().filter(|o| o.proven.is_none()).count();
        assert!(
            !build.outputs.is_empty() && unproven <= build.diagnostics.iter().filter(unread).count(),
            "{name}"
        );
    }
}

/// Lowering has one thing to say of many arcs.
#[test]
fn notes_on_many_arcs_are_told_once() {
    let mut text = String::from("LOADTL/1\nSPINDL/2000,RPM,CLW\nFEDRAT/500,MMPM\nRAPID\nGOTO/10,0,0\n");
    for turn in 1..=50_u32 {
        let (x, z) = (if turn % 2 == 0 { 10 } else { -10 }, -0.5 * f64::from(turn));
        let _ = writeln!(text, "CIRCLE/0,0,0,0,0,1,10\nGOTO/{x},0,{z}");
    }
    let files = MemoryFiles([("turns.cl".to_owned(), text + "FINI\n")].into());
    let build = driver::build("turns.cl", &files, &options(&["grbl"], true));
    let post_set = vec![("arcs.helix".to_owned(), "false".to_owned())];
    let as_lines = driver::build("turns.cl", &files, &Options { post_set, ..options(&["grbl"], true) });
    assert_eq!(messages(&build), "");
    let told = messages(&as_lines);
    assert!(told.lines().count() <= 21 && told.contains("more like it"), "{told}");
}

/// A long file with everything in it that a part may end beside.
fn long() -> String {
    let mut text = String::from("LOADTL/1\nSPINDL/2000,RPM,CLW\nFEDRAT/500,MMPM\nRAPID\nGOTO/0,0,10\n");
    for i in 0..60_000_u32 {
        let (x, y) = (f64::from(i % 500) * 0.25, f64::from(i / 500) * 0.5);
        let _ = writeln!(text, "GOTO/{x:.4},{y:.4},{:.4}", f64::from(i % 7) * 0.01 - 1.0);
        match i % 9_973 {
            5_000 => text += "FEDRAT/650,MMPM\n",
            6_000 => {
                let _ =
                    writeln!(text, "CIRCLE/{},{y:.4},-1,0,0,1,5\nGOTO/{:.4},{y:.4},-1", x + 5.0, x + 10.0);
            }
            7_000 => {
                let _ = writeln!(
                    text,
                    "CYCLE/DRILL,FEDTO,4,MMPM,90,RAPTO,12\nGOTO/{x},{y},0\nGOTO/{},{y},0\nCYCLE/OFF",
                    x + 8.0
                );
            }
            8_000 => text += "LOADTL/2\nSPINDL/1500,RPM,CLW\nRAPID\nGOTO/0,0,20\n",
            _ => {}
        }
    }
    text + "FINI\n"
}

#[test]
fn a_file_built_in_parts_is_the_file_built_at_once() {
    let files = MemoryFiles([("long.cl".to_owned(), long())].into());
    for post in ["linuxcnc", "fanuc", "grbl"] {
        let whole = driver::build("long.cl", &files, &options(&[post], false));
        let parts = driver::build("long.cl", &files, &options(&[post], true));
        let text = |build: &Build| {
            let proven = build.outputs.first().and_then(|o| o.proven.as_ref());
            proven.unwrap_or_else(|| panic!("{}", messages(build))).text().to_owned()
        };
        assert!(text(&whole) == text(&parts), "{post}");
        let certificate = |build: &Build| {
            let proven = build.outputs[0].proven.as_ref().expect("proven");
            serde_json::to_string(&(proven.certificate().moves, &proven.certificate().digest)).expect("json")
        };
        assert_eq!(certificate(&whole), certificate(&parts), "{post}");
    }
}

#[test]
fn a_wrong_line_is_found_in_any_part() {
    // The proof of a part must fail as that of a whole program does: a point beyond the machine's words.
    let text = long().replace("FINI\n", "GOTO/ 1, 1, 1, 0, 1, 0\nFINI\n");
    let files = MemoryFiles([("long.cl".to_owned(), text)].into());
    let build = driver::build("long.cl", &files, &options(&["linuxcnc"], true));
    assert!(build.outputs.iter().all(|o| o.proven.is_none()));
    assert!(messages(&build).contains("E1004"), "{}", messages(&build));
}

#[test]
fn a_program_drills_as_a_cl_file_does() {
    let frame = |cycle: &str| {
        format!(
            "T1 = CUTTER/ FLAT, 8\nLOADTL/ T1\nSPINDL/ 1000\nFEDRAT/ 300\nRAPID\nGOTO/ 0, 0, 20\n{cycle}\n\
             GOTO/ 10, 0, 0\nGOTO/ 20, 0, 4\nCYCLE/ OFF\nRAPID\nGOTO/ 0, 0, 50\nFINI\n"
        )
    };
    let build = |cycle: &str, post: &str| {
        let files = MemoryFiles([("holes.apt".to_owned(), frame(cycle))].into());
        driver::build("holes.apt", &files, &options(&[post], false))
    };
    for post in ["linuxcnc", "fanuc", "grbl"] {
        for cycle in [
            "CYCLE/ DRILL, FEDTO, 6, RAPTO, 2, RTRCTO, 20, MMPM, 120",
            "CYCLE/ DEEP, DEPTH, 12, CLEAR, 2, STEP, 4",
            "CYCLE/ FACE, FEDTO, 1, RAPTO, 2, DWELL, 0.5, MMPR, 0.1",
            "CYCLE/ BORE, FEDTO, 5, RAPTO, 1",
        ] {
            let build = build(cycle, post);
            assert!(build.outputs[0].proven.is_some(), "{post} {cycle}: {}", messages(&build));
        }
    }
    let tap = build("CYCLE/ TAP, FEDTO, 6, RAPTO, 2", "fanuc");
    assert!(tap.has_errors() && messages(&tap).contains("pitch"), "{}", messages(&tap));
    let deep = build("CYCLE/ DEEP, FEDTO, 6, RAPTO, 2", "fanuc");
    assert!(deep.has_errors() && messages(&deep).contains("peck"), "{}", messages(&deep));
}

#[test]
fn cl_text_of_either_flavour_is_read_to_the_same_text() {
    let write = |name: &str, text: String, flavour: &str| {
        let files = MemoryFiles([(name.to_owned(), text)].into());
        let post_set = vec![("options.FLAVOUR".to_owned(), flavour.to_owned())];
        let build = driver::build(name, &files, &Options { post_set, ..options(&["apt-cl"], false) });
        let proven = build.outputs.first().and_then(|o| o.proven.as_ref());
        proven.unwrap_or_else(|| panic!("{name}, {flavour}: {}", messages(&build))).text().to_owned()
    };
    for name in files() {
        let text = std::fs::read_to_string(folder().join(&name)).expect("a text");
        for (flavour, again) in [("plain", "again.cl"), ("nx", "again.cls")] {
            let first = write(&name, text.clone(), flavour);
            assert_eq!(first.contains("TOOL PATH/"), flavour == "nx");
            let second = write(again, first.clone(), flavour);
            // A tool that coolant has already changed in keeps the name it was loaded by, its number.
            let unnamed = |text: &str| {
                let line = |l: &str| l.split(",TOOL,").next().unwrap_or(l).to_owned();
                text.lines().map(line).collect::<Vec<_>>()
            };
            assert_eq!(unnamed(&first), unnamed(&second), "{name}, {flavour}");
        }
    }
}

#[test]
fn hostile_texts_give_a_coded_error_or_a_proven_program() {
    let frame = |body: &str| {
        format!(
            "LOADTL/1\nSPINDL/1000,RPM,CLW\nFEDRAT/200,MMPM\nRAPID\nGOTO/10,0,5\n{body}\nGOTO/1,1,1\nFINI\n"
        )
    };
    let mut texts: Vec<String> = [
        "GOTO/1,\0 2,3",
        "PPRINT A\0B",
        "PPRINT ) M3 S9000 ( %",
        "PARTNO ) G0 Z-100 (",
        "PPRINT A\u{b}B\u{c}C\u{85}D\u{2028}G0 Z-50",
        "INSERT )%\0",
        "GOTO/1e308,1e308,1e308",
        "GOTO/1e999,2,3",
        "GOTO/inf,nan,3",
        "FEDRAT/1e300,MMPM",
        "SPINDL/1e300,RPM",
        "DELAY/1e300",
        "CIRCLE/10,0,5,0,0,1,0\nGOTO/10,0,5",
        "CIRCLE/0,1e8,5,0,0,1,1e8\nGOTO/-10,0,5",
        "CYCLE/DEEP,FEDTO,1e6,STEP,1e-6,MMPM,100,RAPTO,2\nGOTO/1,1,0\nCYCLE/OFF",
        "NURBS/\nKNOT/nan,1\nCNTRL/1,2,3",
        "NURBS/\nKNOT/1\nCNTRL/1e6,2,3\nCNTRL/-1e6,2e6,3\nCNTRL/1,2,3",
        "PPRINT 'not ended \" (",
        "\u{c}GOTO/2,2,2",
        "GOTO/2,2,2\u{b}",
    ]
    .map(frame)
    .into();
    texts.push(frame(&"(".repeat(200_000)));
    texts.push(frame(&format!("TLON,GOFWD/{}", "(".repeat(200_000))));
    texts.push(frame(&"A".repeat(2_000_000)));
    texts.push(frame(&format!("GOTO/{},2,3", "1".repeat(1_000_000))));
    texts.push(frame(&"GOTO/5,5,5\n".repeat(40_000)));
    texts.push(format!("\u{feff}{}", frame("")));
    let tools = (1..600).map(|i| {
        format!(
            "TOOL PATH/A)%{i},TOOL,B)%{i}\nLOAD/TOOL,{i}\nSPINDL/900,CLW\nRAPID\nGOTO/0,0,9\nGOTO/1,0,0\n"
        )
    });
    texts.push(format!("FEDRAT/100\n{}", tools.collect::<String>()));
    for text in texts {
        let shown: String = text.chars().skip(74).take(60).collect();
        let files = MemoryFiles([("hostile.cl".to_owned(), text)].into());
        let build = driver::build("hostile.cl", &files, &options(&["fanuc", "heidenhain", "apt-cl"], true));
        for output in &build.outputs {
            match &output.proven {
                // Nobody's text opens or ends a program.
                Some(proven) if output.post == "fanuc" => {
                    assert_eq!(proven.text().matches('%').count(), 2, "{shown}")
                }
                Some(_) => {}
                None => assert!(build.has_errors(), "{shown}"),
            }
        }
        assert!(build.has_errors() || !build.outputs.is_empty(), "{shown}");
    }
}
