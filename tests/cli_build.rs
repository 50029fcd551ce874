//! `partwright build` from the command line to the files it writes.

mod common;

use common::scratch::{Scratch, code, stderr};

const PLATE: &str = "\
PARTNO plate cam
UNITS/ MM
PARAM/ LIFT = 20mm, MIN, 5mm, MAX, 30mm, 'lift of the follower'
F1 = FOLLOW/ TRANSL, ROLLER, 8
M1 = MOTION/ DWELL, 30, RISE, 120, LIFT, MODSIN, DWELL, 60, RETURN, 120, LIFT, MODSIN, DWELL, 30
C1 = CAM/ PLATE, BASE, 20, FOLLOW, F1, MOTION, M1, MAXPA, 45
T1 = CUTTER/ FLAT, 16, NUMBER, 1
LOADTL/ T1
SPINDL/ 1200, CLW
FEDRAT/ 300
INTOL/ 0.01
OUTTOL/ 0.01
P1 = PROFIL/ C1, LINEAR, DEPTH, 5
FINI
";

#[test]
fn every_post_gets_its_file_beside_the_source() {
    let scratch = Scratch::new("posts");
    scratch.write("plate.apt", PLATE);
    let output =
        scratch.run(&["build", "plate.apt", "--post", "linuxcnc", "--post", "fanuc", "--post", "grbl"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(output.stdout.is_empty());
    assert_eq!(scratch.names().len(), 4, "{:?}", scratch.names());
    assert!(scratch.read("plate.linuxcnc.ngc").contains("G1"));
    let summary = stderr(&output);
    assert_eq!(summary.lines().filter(|l| l.contains("into and")).count(), 3, "{summary}");
}

#[test]
fn one_output_goes_where_it_is_told() {
    let scratch = Scratch::new("one");
    scratch.write("plate.apt", PLATE);
    let to_pipe = scratch.run(&["build", "plate.apt", "--post", "grbl", "-o", "-"]);
    assert_eq!(code(&to_pipe), 0, "{}", stderr(&to_pipe));
    assert_eq!(code(&scratch.run(&["build", "plate.apt", "--post", "grbl", "-o", "x.nc"])), 0);
    assert_eq!(String::from_utf8_lossy(&to_pipe.stdout), scratch.read("x.nc"));
    assert_eq!(scratch.names(), ["plate.apt", "x.nc"]);
}

#[test]
fn names_that_clash_are_refused() {
    let scratch = Scratch::new("clash");
    scratch.write("plate.apt", PLATE).write("sub/plate.apt", PLATE);
    let cases: [(&[&str], &str); 4] = [
        (&["build", "plate.apt", "--post", "grbl", "--post", "fanuc", "-o", "x.nc"], "E0906"),
        (&["build", "plate.apt", "--post", "grbl", "-o", "plate.apt"], "E0909"),
        (&["build", "plate.apt", "sub/plate.apt", "--post", "grbl", "--out-dir", "nc"], "E0909"),
        (&["build", "plate.apt"], "E0907"),
    ];
    for (args, id) in cases {
        let output = scratch.run(args);
        assert_eq!(code(&output), 2, "{args:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(id), "{args:?}: {}", stderr(&output));
    }
    assert_eq!(scratch.read("plate.apt"), PLATE);
    assert_eq!(scratch.names(), ["plate.apt", "sub"]);
}

#[test]
fn an_unwritable_target_exits_2_and_leaves_nothing_behind() {
    let scratch = Scratch::new("unwritable");
    scratch.write("plate.apt", PLATE).write("file", "a file, not a directory");
    let output = scratch.run(&["build", "plate.apt", "--post", "grbl", "-o", "file/x.nc"]);
    assert_eq!(code(&output), 2, "{}", stderr(&output));
    assert!(stderr(&output).contains("E0905"), "{}", stderr(&output));
    assert_eq!(scratch.names(), ["file", "plate.apt"]);
}

const POINTS: &str =
    "LOADTL/1\nSPINDL/1000,RPM,CLW\nFEDRAT/200,MMPM\nRAPID\nGOTO/10,0,5\nGOTO/20,0,0\nFINI\n";

#[test]
fn nothing_is_replaced_and_nothing_left_where_one_program_of_several_cannot_be_made() {
    let scratch = Scratch::new("staged");
    scratch.write("points.cl", POINTS).write("points.fanuc.nc", "the old program");
    // Its words are too short for the points, which is found after the program of the first post has been proven.
    scratch.write("short.post.toml", "inherits = \"fanuc\"\n[post]\ntitle = \"short\"\n[words.x]\nmax = 1\n");
    let names = scratch.names();
    for folder in [&[][..], &["--out-dir", "new/deep"]] {
        let posts = ["build", "points.cl", "--post", "fanuc", "--post", "short.post.toml"];
        let output = scratch.run(&[&posts, folder].concat());
        assert_eq!(code(&output), 1, "{}", stderr(&output));
        assert!(stderr(&output).contains("E0604"), "{}", stderr(&output));
        assert_eq!(scratch.names(), names);
    }
    assert_eq!(scratch.read("points.fanuc.nc"), "the old program");
}

#[test]
fn programs_that_are_staged_get_their_names_together() {
    let scratch = Scratch::new("staging");
    scratch.write("points.cl", POINTS).write("points.fanuc.nc", "the old program");
    let posts = ["build", "points.cl", "--post", "fanuc", "--post", "heidenhain"];
    let output = scratch.run(&posts);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(scratch.names(), ["points.cl", "points.fanuc.nc", "points.heidenhain.H"]);
    let beside = scratch.read("points.fanuc.nc");
    assert!(beside.contains("G1 X20."), "{beside}");
    // Into a directory that is made when all is proven; the certificate is that of the text.
    let output = scratch.run(&[&posts[..], &["--out-dir", "new/deep", "--report", "report.json"]].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(scratch.read("new/deep/points.fanuc.nc"), beside);
    assert!(scratch.read("report.json").contains(&format!("\"bytes\": {}", beside.len())));
    // A directory where a program should go: the other one is not replaced either.
    scratch.write("points.heidenhain.H.d/x", "").write("points.fanuc.nc", "the old program");
    let target = ["--post", "fanuc", "-o", "points.heidenhain.H.d"];
    let output = scratch.run(&[&["build", "points.cl"], &target[..]].concat());
    assert_eq!((code(&output), stderr(&output).contains("E0905")), (2, true), "{}", stderr(&output));
    assert_eq!(scratch.read("points.fanuc.nc"), "the old program");
    assert!(scratch.names().iter().all(|n| !n.ends_with(".tmp")), "{:?}", scratch.names());
}

#[test]
fn the_source_map_of_a_cl_file_has_its_records() {
    let scratch = Scratch::new("cl-map");
    scratch.write("points.cl", POINTS);
    let output = scratch.run(&["build", "points.cl", "--post", "fanuc", "--source-map", "map.json"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(scratch.read("map.json").contains("GOTO/ 20, 0, 0"), "{}", scratch.read("map.json"));
}

#[test]
fn threads_and_repetition_do_not_change_a_byte() {
    let scratch = Scratch::new("threads");
    scratch.write("plate.apt", PLATE);
    let mut texts = Vec::new();
    for jobs in ["1", "2", "2"] {
        let name = format!("{}.nc", texts.len());
        let output = scratch.run(&[
            "build",
            "plate.apt",
            "--post",
            "linuxcnc",
            "-j",
            jobs,
            "-o",
            &name,
            "--report",
            "r.json",
        ]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        texts.push((scratch.read(&name), scratch.read("r.json").replace(&name, "NAME")));
    }
    assert!(texts.iter().all(|t| *t == texts[0]));
}

#[test]
fn a_parameter_is_overridden_within_its_range() {
    let scratch = Scratch::new("define");
    scratch.write("plate.apt", PLATE);
    let with = |value: &str| {
        scratch.run(&["build", "plate.apt", "--post", "grbl", "-o", "-", "-D", &format!("LIFT={value}")])
    };
    let (normal, other) = (with("20mm"), with("1in"));
    assert_eq!((code(&normal), code(&other)), (0, 0), "{}", stderr(&other));
    assert_ne!(normal.stdout, other.stdout);
    assert_eq!(code(&with("99mm")), 1);
    assert_eq!(code(&with("20deg")), 1);
    assert_eq!(code(&scratch.run(&["check", "plate.apt", "-D", "LIFFT=20mm"])), 1);
}

#[test]
fn stages_are_printed_or_written() {
    let scratch = Scratch::new("emit");
    scratch.write("plate.apt", PLATE);
    let cl = scratch.run(&["build", "plate.apt", "--emit", "cl"]);
    assert_eq!(code(&cl), 0, "{}", stderr(&cl));
    assert!(
        String::from_utf8_lossy(&cl.stdout).contains("LOADTL"),
        "{}",
        String::from_utf8_lossy(&cl.stdout)
    );
    let all = ["build", "plate.apt", "--post", "grbl", "--emit", "ast,ir,cl,target,nc", "--out-dir", "out"];
    assert_eq!(code(&scratch.run(&all)), 0);
    for name in ["plate.ast", "plate.ir", "plate.cl", "plate.grbl.target"] {
        assert!(!scratch.read(&format!("out/{name}")).is_empty(), "{name}");
    }
}

#[test]
fn dependencies_name_every_file_also_after_errors() {
    let scratch = Scratch::new("deps");
    scratch.write("plate.apt", format!("INCLUD/ 'lib/one.apt'\n{PLATE}")).write("lib/one.apt", "X1 = 3\n");
    let make = scratch.run(&["build", "plate.apt", "--post", "grbl", "--deps", "plate.d"]);
    assert_eq!(code(&make), 0, "{}", stderr(&make));
    let rule = scratch.read("plate.d");
    assert!(rule.starts_with("plate.grbl.") && rule.contains(": lib/one.apt plate.apt"), "{rule}");
    scratch.write("lib/one.apt", "X1 = 3 4\n");
    let json = ["build", "plate.apt", "--post", "grbl", "--deps", "plate.json", "--deps-format", "json"];
    assert_eq!(code(&scratch.run(&json)), 1);
    let deps: serde_json::Value = serde_json::from_str(&scratch.read("plate.json")).expect("JSON");
    assert_eq!(deps["inputs"], serde_json::json!(["lib/one.apt", "plate.apt"]));
}

#[test]
fn files_outside_the_project_are_not_read() {
    let scratch = Scratch::new("outside");
    let main = format!("INCLUD/ '../secret.apt'\n{PLATE}");
    scratch.write("secret.apt", "X1 = 3\n").write("project/plate.apt", &main);
    let output = scratch.run(&["check", "project/plate.apt"]);
    assert_ne!(code(&output), 0);
    assert!(stderr(&output).contains("outside"), "{}", stderr(&output));
    // A marker further up makes it one project.
    scratch.write("partwright.toml", "");
    assert_eq!(code(&scratch.run(&["check", "project/plate.apt"])), 0);
    #[cfg(unix)]
    {
        std::fs::remove_file(scratch.0.join("partwright.toml")).expect("removed");
        std::os::unix::fs::symlink("../secret.apt", scratch.0.join("project/link.apt")).expect("a link");
        scratch.write("project/plate.apt", main.replace("../secret", "link"));
        assert_ne!(code(&scratch.run(&["check", "project/plate.apt"])), 0);
    }
}

#[test]
fn the_report_follows_its_schema() {
    let scratch = Scratch::new("report");
    scratch.write("plate.apt", PLATE);
    let args = ["build", "plate.apt", "--post", "linuxcnc", "--post", "grbl", "--report", "report.json"];
    let output = scratch.run(&args);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let report: serde_json::Value = serde_json::from_str(&scratch.read("report.json")).expect("JSON");
    let schema = include_str!("../docs/schema/report.schema.json");
    let schema: serde_json::Value = serde_json::from_str(schema).expect("JSON");
    common::schema::check(&schema, &schema, &report, "report").expect("a valid report");
    let operation = &report["programs"][0]["outputs"][0]["certificate"]["operations"][0];
    assert_eq!(operation["source"]["line"], 13);
    assert!(operation["blocks"].as_u64() >= operation["pieces"][0]["lower_bound"].as_u64());
}

#[test]
fn pictures_are_drawn_in_the_form_of_their_name() {
    let scratch = Scratch::new("plot");
    scratch.write("plate.apt", PLATE);
    for what in ["cam", "path", "deviation"] {
        let output = scratch.run(&["plot", "plate.apt", "--what", what]);
        assert_eq!(code(&output), 0, "{what}: {}", stderr(&output));
        assert!(scratch.read(&format!("plate.{what}.svg")).contains("<svg"), "{what}");
    }
    assert_eq!(code(&scratch.run(&["plot", "plate.apt", "-o", "plate.png", "--scale", "0.5"])), 0);
    assert!(std::fs::read(scratch.0.join("plate.png")).expect("a file").starts_with(b"\x89PNG"));
    let cases: [(&[&str], &str); 2] = [
        (&["plot", "plate.apt", "-o", "plate.jpg"], "E0913"),
        (&["plot", "plate.apt", "--cam", "C9"], "E0912"),
    ];
    for (args, id) in cases {
        let output = scratch.run(args);
        assert_eq!(code(&output), 2, "{args:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(id), "{args:?}: {}", stderr(&output));
    }
}

#[test]
fn nets_are_exported_as_step_and_stl() {
    let scratch = Scratch::new("export");
    let net = "NET/ 2, 2, (0, 0, 0), (0, 40, 3), (60, 0, 2), (60, 40, 0)";
    scratch.write("one.apt", format!("UNITS/ MM\nN1 = {net}\nFINI\n"));
    scratch.write("two.apt", format!("UNITS/ MM\nN1 = {net}\nN2 = {net}\nFINI\n"));
    let output = scratch.run(&["export", "one.apt", "-o", "one.stp"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(code(&scratch.run(&["export", "two.apt", "--net", "N2", "-o", "two.stl"])), 0);
    // What was written is a net again, and gives the same file.
    scratch.write("again.apt", "UNITS/ MM\nN1 = NET/ STEP, 'one.stp'\nFINI\n");
    assert_eq!(code(&scratch.run(&["export", "again.apt", "-o", "again.stp"])), 0);
    assert_eq!(scratch.read("again.stp"), scratch.read("one.stp"));
    let stl = std::fs::read(scratch.0.join("two.stl")).expect("a file");
    assert_eq!((stl.len() - 84) % 50, 0);
    let cases: [(&[&str], &str); 5] = [
        (&["export", "one.apt", "-o", "one.obj"], "E0917"),
        (&["export", "two.apt", "-o", "two.stp"], "E0918"),
        (&["export", "one.apt", "--net", "N3", "-o", "one.stp"], "E0918"),
        (&["export", "one.apt", "-o", "one.stl", "--tolerance", "0"], "E0918"),
        (&["export", "one.apt", "-o", "one.stl", "--tolerance", "1e-12"], "E0918"),
    ];
    for (args, id) in cases {
        let output = scratch.run(args);
        assert_eq!(code(&output), 2, "{args:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(id), "{args:?}: {}", stderr(&output));
    }
}

#[test]
fn a_post_that_writes_what_is_not_meant_exits_4_writes_nothing_and_shows_what_was_lowered() {
    let scratch = Scratch::new("unproven");
    scratch
        .write("plate.apt", PLATE.replace("LINEAR", "CIRCUL"))
        .write("swapped.post.toml", "inherits = \"grbl\"\n[codes]\narc-cw = \"G3\"\narc-ccw = \"G2\"\n")
        .write("out.gcode", "old");
    let failed = scratch.run(&["build", "plate.apt", "--post", "swapped.post.toml", "-o", "out.gcode"]);
    assert_eq!(code(&failed), 4, "{}", stderr(&failed));
    assert!(stderr(&failed).contains("E0801"), "{}", stderr(&failed));
    assert_eq!(scratch.read("out.gcode"), "old");
    let shown = scratch.run(&["build", "plate.apt", "--post", "swapped.post.toml", "--emit", "target,nc"]);
    assert_eq!(code(&shown), 4, "{}", stderr(&shown));
    let target = String::from_utf8_lossy(&shown.stdout).into_owned();
    assert!(target.contains("arc c"), "{target}");
    assert!(!target.contains("G1"), "an unproven program is shown: {target}");
    assert_eq!(scratch.names(), ["out.gcode", "plate.apt", "swapped.post.toml"]);
}

#[test]
fn coolant_survives_a_tool_change_and_one_kind_replaces_the_other() {
    let scratch = Scratch::new("coolant");
    let second = "COOLNT/ FLOOD\nP2 = PROFIL/ C1, DEPTH, 6\nT2 = CUTTER/ FLAT, 10, NUMBER, 2\nLOADTL/ T2\nSPINDL/ 900\nCOOLNT/ MIST\nPROFIL/ C1, DEPTH, 7\nFINI";
    scratch.write("plate.apt", PLATE.replace("FINI", second));
    for post in ["linuxcnc", "fanuc", "grbl"] {
        let built = scratch.run(&["build", "plate.apt", "--post", post, "-o", "-"]);
        assert_eq!(code(&built), 0, "{post}: {}", stderr(&built));
        let text = String::from_utf8_lossy(&built.stdout).into_owned();
        assert!(text.contains("M8") && (post == "grbl" || text.contains("M7")), "{text}");
    }
}

/// A CL file that takes a moment.
#[cfg(unix)]
fn long_cl() -> String {
    let mut text = "UNITS/ MM\nCUTTER/ 10\nLOADTL/ 1\nSPINDL/ RPM, 1000, CLW\nFEDRAT/ MMPM, 100\n".to_owned();
    for i in 0..60_000 {
        text += &format!("GOTO/ {}, {}, {}\n", i % 100, i % 7, f64::from(i % 3) / 10.0);
    }
    text + "FINI\n"
}

/// Whether what runs this test, and with it what the test starts, ignores a signal: jobs in the background ignore SIGINT.
#[cfg(unix)]
fn ignored(number: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).unwrap_or("0");
    u64::from_str_radix(mask.trim(), 16).expect("a mask") >> (number - 1) & 1 == 1
}

#[cfg(unix)]
#[test]
fn a_process_that_is_told_to_end_leaves_no_temporary_files() {
    use std::os::unix::process::ExitStatusExt;
    let scratch = Scratch::new("signals");
    scratch.write("long.cl", long_cl()).write("long.fanuc.nc", "the old program");
    for (name, number) in [("INT", 2), ("TERM", 15)] {
        if ignored(number) {
            eprintln!("skipped: SIG{name} is ignored here");
            continue;
        }
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_partwright"));
        command.current_dir(&scratch.0).args(["build", "long.cl"]);
        for post in ["fanuc", "haas", "linuxcnc", "mazak", "mitsubishi", "okuma", "heidenhain", "sinumerik"] {
            command.args(["--post", post]);
        }
        let mut child = command.stderr(std::process::Stdio::null()).spawn().expect("the command starts");
        while !scratch.names().iter().any(|name| name.ends_with(".tmp")) {
            assert!(child.try_wait().expect("its state").is_none(), "it ended before a program was staged");
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
        let kill = format!("kill -{name} {}", child.id());
        std::process::Command::new("sh").args(["-c", &kill]).status().expect("a signal");
        assert_eq!(child.wait().expect("its end").signal(), Some(number));
        assert_eq!(scratch.names(), ["long.cl", "long.fanuc.nc"]);
        assert_eq!(scratch.read("long.fanuc.nc"), "the old program");
    }
}
