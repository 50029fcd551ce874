//! `partwright post`, `partwright schema` and `--post-set`.

mod common;

use common::POINTS;
use common::schema;
use common::scratch::{Scratch, code, stderr};
use serde_json::Value;

fn stdout(output: &std::process::Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
fn the_list_says_how_sure_every_post_is() {
    let scratch = Scratch::new("post-list");
    let text = stdout(&scratch.run(&["post", "list"]));
    for name in partwright::post::builtin_names() {
        assert!(text.lines().any(|l| l.starts_with(&format!("{name} "))), "{name} is not in\n{text}");
    }
    assert!(text.contains("checked by the control's own interpreter"), "{text}");
    let rows: Value =
        serde_json::from_str(&stdout(&scratch.run(&["post", "list", "--format", "json"]))).expect("JSON");
    let names: Vec<&str> = rows.as_array().expect("rows").iter().filter_map(|r| r["name"].as_str()).collect();
    assert_eq!(names, partwright::post::builtin_names().collect::<Vec<_>>());
    assert!(rows[0]["confidence"].is_string() && rows[0]["basis"].is_string());
}

#[test]
fn show_prints_the_file_or_every_value_with_its_place() {
    let scratch = Scratch::new("post-show");
    scratch.write("mill.post.toml", "inherits = \"fanuc\"\n[post]\nextension = \"tap\"\n");
    let own = stdout(&scratch.run(&["post", "show", "mill.post.toml"]));
    assert!(own.contains("# inherits: mill.post.toml > fanuc > iso\n# how sure: from the manual ("), "{own}");
    assert!(own.ends_with("[post]\nextension = \"tap\"\n"), "{own}");
    let all = stdout(&scratch.run(&[
        "post",
        "show",
        "mill.post.toml",
        "--resolved",
        "--post-set",
        "file.number=7",
    ]));
    assert!(all.contains("extension = \"tap\"  # mill.post.toml:3\n"), "{all}");
    assert!(all.contains("number = 7  # --post-set:1\n"), "{all}");
    assert!(all.contains("arc-cw = \"G2\"  # builtin iso.post.toml:"), "{all}");
    scratch.write("all.post.toml", &all);
    assert_eq!(code(&scratch.run(&["post", "check", "all.post.toml"])), 0);
    let unknown = scratch.run(&["post", "show", "fanuk"]);
    assert_eq!(code(&unknown), 2);
    assert!(stderr(&unknown).contains("did you mean `fanuc`?"), "{}", stderr(&unknown));
}

#[test]
fn check_finds_what_is_wrong_and_says_where() {
    let scratch = Scratch::new("post-check");
    scratch
        .write(
            "slip.post.toml",
            "inherits = \"fanuc\"\n[templates]\nfooter = \"{{ program.titel }}\\nM30\"\n",
        )
        .write("idle.post.toml", "inherits = \"fanuc\"\n[tool-change.blocks]\nwait = \"M0\"\n")
        .write("key.post.toml", "inherits = \"fanuc\"\n[word.x]\nprefix = \"X\"\n");
    let check = |args: &[&str]| {
        let args: Vec<&str> =
            ["post", "check", "--message-format", "short"].iter().chain(args).copied().collect();
        let output = scratch.run(&args);
        (code(&output), stderr(&output))
    };
    let (status, text) = check(&["slip.post.toml"]);
    assert_eq!(status, 1, "{text}");
    assert!(text.starts_with("slip.post.toml:3:10: error[E0751]: "), "{text}");
    assert_eq!(check(&["idle.post.toml"]).0, 0);
    let (status, text) = check(&["idle.post.toml", "--deny", "warnings"]);
    assert_eq!(status, 1);
    assert!(text.starts_with("idle.post.toml:3:8: error[W0753]: "), "{text}");
    let (status, text) = check(&["fanuc", "key.post.toml", "slip.post.toml"]);
    assert_eq!(status, 1);
    assert!(text.contains("E0703") && text.contains("E0751"), "{text}");
    assert_eq!(check(&["nothing.post.toml"]).0, 2);
}

#[test]
fn z_goes_up_for_a_tool_change_where_the_machine_says_how_far() {
    let scratch = Scratch::new("post-retract");
    for (post, height) in [("LINUXCNC", "0"), ("MACH3", "-1.5"), ("CENTROID", "'0.'"), ("OKUMA", "'300.'")] {
        let machine = format!("MACHIN/ {post}, RETRACT = {height}\nLOADTL");
        scratch.write("points.apt", POINTS.replace("LOADTL", &machine));
        let built = scratch.run(&["build", "points.apt", "-o", "-"]);
        assert_eq!(code(&built), 0, "{post}: {}", stderr(&built));
        let up = format!("G0 Z{}", height.trim_matches('\''));
        let text = stdout(&built);
        let lines: Vec<usize> =
            text.lines().enumerate().filter(|(_, l)| l.ends_with(&up)).map(|(i, _)| i).collect();
        let change = text.lines().position(|l| l.starts_with("T1 M6")).expect("a tool change");
        assert!(lines.iter().any(|l| *l < change) && lines.iter().any(|l| *l > change), "{post}:\n{text}");
    }
}

/// Posts that look right and whose control would do something else, or nothing: each with the row that shows it.
const UNTRUE: &[(&str, &str)] = &[
    ("inherits = \"grbl\"\n[arcs]\nfull-circle = \"bare\"\n", "`full circle`"),
    ("inherits = \"fanuc\"\n[dwell]\nunit = \"s\"\ndecimals = 3\n", "`0.5 s in a block of its own`"),
    ("inherits = \"haas\"\n[numbers]\npoint = \"needed\"\n", "`0.5 s in a block of its own`"),
    (
        "inherits = \"fanuc\"\n[templates]\nheader = \"{% for i in range(9999999) %}{% endfor %}\"\n",
        "`0.5 s in a block of its own`",
    ),
];

#[test]
fn check_tries_the_post_out() {
    let scratch = Scratch::new("post-check-tries");
    for (post, row) in UNTRUE {
        scratch.write("mill.post.toml", post);
        let checked = scratch.run(&["post", "check", "mill.post.toml"]);
        assert_eq!(code(&checked), 1, "{post}");
        let said = stderr(&checked);
        assert!(said.contains(&format!("the row {row} of the selftest comes out wrong")), "{post}: {said}");
        assert!(said.contains("E0752") && said.contains("post selftest mill.post.toml"), "{said}");
    }
}

#[test]
fn a_new_post_passes_its_check_and_builds() {
    let scratch = Scratch::new("post-new");
    scratch.write("points.apt", POINTS);
    for name in partwright::post::builtin_names() {
        let file = format!("posts/my-{name}");
        let made = scratch.run(&["post", "new", &file, "--from", name]);
        assert_eq!(code(&made), 0, "{}", stderr(&made));
        let check = scratch.run(&["post", "check", &format!("{file}.post.toml"), "--deny", "warnings"]);
        assert_eq!(code(&check), 0, "{}", stderr(&check));
        let build = |post: &str| scratch.run(&["build", "points.apt", "-o", "-", "--post", post]);
        let (parent, child) = (build(name), build(&format!("{file}.post.toml")));
        assert_eq!(code(&child), 0, "{}", stderr(&child));
        assert_eq!(stdout(&child), stdout(&parent), "{name}");
    }
    let outside = scratch.run(&["post", "new", "shop/second", "--from", "posts/my-fanuc.post.toml"]);
    assert_eq!(code(&outside), 2);
    assert!(stderr(&outside).contains("E0902"), "{}", stderr(&outside));
    scratch.write("partwright.toml", "");
    let again = scratch.run(&["post", "new", "shop/second", "--from", "posts/my-fanuc.post.toml"]);
    assert_eq!(code(&again), 0, "{}", stderr(&again));
    assert_eq!(code(&scratch.run(&["post", "check", "shop/second.post.toml"])), 0);
}

#[test]
fn a_new_post_needs_a_new_and_usable_name() {
    let scratch = Scratch::new("post-name");
    scratch.write("mill.post.toml", "old");
    let cases = [
        ("mill", "fanuc", "E0952"),
        ("mill 2", "fanuc", "E0953"),
        ("fanuc", "fanuc", "E0953"),
        ("x", "fanuk", "E0701"),
    ];
    for (name, from, id) in cases {
        let output = scratch.run(&["post", "new", name, "--from", from]);
        assert_eq!(code(&output), 2, "{}", stderr(&output));
        assert!(stderr(&output).contains(id), "{}", stderr(&output));
    }
    assert_eq!(
        (scratch.names(), scratch.read("mill.post.toml")),
        (vec!["mill.post.toml".to_owned()], "old".to_owned())
    );
}

#[test]
fn keys_of_the_post_can_be_set_for_one_run() {
    let scratch = Scratch::new("post-set");
    scratch.write("points.apt", POINTS);
    let build =
        |set: &str| scratch.run(&["build", "points.apt", "--post", "linuxcnc", "-o", "-", "--post-set", set]);
    assert!(stdout(&build("numbers.point=always")).contains("X10."));
    assert!(stdout(&build("numbers.plus=true")).contains("X+10"));
    for (set, id, status) in
        [("numbers.plus", "E0951", 2), ("=1", "E0951", 2), ("numbers.pluss=true", "E0703", 1)]
    {
        let output = build(set);
        assert_eq!(code(&output), status, "{set}: {}", stderr(&output));
        assert!(stderr(&output).contains(id), "{set}: {}", stderr(&output));
    }
    let sets = ["words.x.nope=1", "words.y.nope=2", "inherits=heidenhain"];
    let given = sets.iter().flat_map(|set| ["--post-set", set]);
    let args: Vec<&str> = ["build", "points.apt", "--post", "fanuc"].into_iter().chain(given).collect();
    let output = scratch.run(&args);
    scratch.write("large.post.toml", format!("inherits = \"fanuc\"\n#{}\n", "x".repeat(1 << 20)));
    let large = scratch.run(&["post", "check", "large.post.toml"]);
    assert_eq!((code(&large), stderr(&large).contains("1048576 at most")), (2, true), "{}", stderr(&large));
    for part in ["[words.x] has no key", "[words.y] has no key", "`inherits` cannot be set"] {
        assert!(stderr(&output).contains(part), "{part}: {}", stderr(&output));
    }
}

#[test]
fn posts_and_messages_are_as_their_schemas_say() {
    let scratch = Scratch::new("schema");
    let read =
        |of: &str| -> Value { serde_json::from_str(&stdout(&scratch.run(&["schema", of]))).expect("JSON") };
    let post = read("post");
    for name in partwright::post::builtin_names() {
        let text = stdout(&scratch.run(&["post", "show", name, "--resolved"]));
        let value: Value = toml::from_str(&text).expect("TOML");
        schema::check(&post, &post, &value, name).expect("as the schema says");
    }
    let wrong: Value = toml::from_str("[words.x]\ndecimals = 99\nprefx = 'X'").expect("TOML");
    assert!(schema::check(&post, &post, &wrong, "wrong").is_err());
    let diagnostics = read("diagnostics");
    scratch.write("a.apt", "PARTNO broken\nGOTO/ 1, 2 3\n");
    for line in stderr(&scratch.run(&["check", "a.apt", "--message-format", "json"])).lines() {
        let value: Value = serde_json::from_str(line).expect("JSON");
        schema::check(&diagnostics, &diagnostics, &value, "message").expect("as the schema says");
    }
    assert_eq!(read("report")["type"], "object");
}

#[test]
fn the_source_map_links_statements_records_and_blocks() {
    let scratch = Scratch::new("source-map");
    scratch.write("points.apt", POINTS);
    let args = [
        "build",
        "points.apt",
        "--post",
        "linuxcnc",
        "--post",
        "fanuc",
        "--out-dir",
        "nc",
        "--source-map",
        "map.json",
    ];
    assert_eq!(code(&scratch.run(&args)), 0);
    let map: Value = serde_json::from_str(&scratch.read("map.json")).expect("JSON");
    let schema: Value = serde_json::from_str(&stdout(&scratch.run(&["schema", "source-map"]))).expect("JSON");
    schema::check(&schema, &schema, &map, "map").expect("as the schema says");
    let programs = map["programs"].as_array().expect("programs");
    assert_eq!(programs.len(), 2);
    for program in programs {
        let nc = scratch.read(program["file"].as_str().expect("a file"));
        let record =
            program["records"].as_array().and_then(|r| r.iter().find(|r| r["text"] == "GOTO/ 10, 0, 5"));
        let record = record.expect("the move");
        assert_eq!(record["source"]["first"], 8);
        let line = record["nc"][0][0].as_u64().expect("a line") as usize;
        assert!(nc.lines().nth(line - 1).is_some_and(|l| l.starts_with("G1 X10")), "{record}\n{nc}");
    }
}

#[test]
fn trace_writes_a_page_and_never_over_a_source() {
    let scratch = Scratch::new("trace");
    scratch.write("points.apt", POINTS).write("broken.apt", "GOTO/ 1 2\n");
    assert_eq!(code(&scratch.run(&["post", "trace", "points.apt"])), 0);
    assert!(scratch.read("points.linuxcnc.html").contains("<code>GOTO/ 10, 0, 5</code>"));
    let fanuc = scratch.run(&["post", "trace", "points.apt", "--post", "fanuc", "-o", "-"]);
    assert!(stdout(&fanuc).contains("points.apt for fanuc"), "{}", stdout(&fanuc));
    assert_eq!(code(&scratch.run(&["post", "trace", "broken.apt", "-o", "page.html"])), 1);
    let over = scratch.run(&["post", "trace", "points.apt", "-o", "points.apt"]);
    assert_eq!(code(&over), 2);
    assert!(stderr(&over).contains("E0909"), "{}", stderr(&over));
    assert_eq!(scratch.read("points.apt"), POINTS);
    assert_eq!(scratch.names(), ["broken.apt", "points.apt", "points.linuxcnc.html"]);
}

/// A work offset by number: the post, the number, the words of the start.
const OFFSETS: &[(&str, &str, &str)] = &[
    ("fanuc", "2", "G55"),
    ("fanuc", "7", "G54.1 P1"),
    ("mazak", "54", "G54.1 P48"),
    ("mitsubishi", "8", "G54.1 P2"),
    ("haas", "7", "G154 P1"),
    ("haas", "105", "G154 P99"),
    ("sinumerik", "5", "G505"),
    ("sinumerik", "99", "G599"),
    ("okuma", "12", "G15 H12"),
    ("centroid", "18", "E18"),
    ("linuxcnc", "9", "G59.3"),
    ("grbl", "6", "G59"),
    ("grblhal", "9", "G59.3"),
    ("mach3", "6", "G59"),
    ("heidenhain", "3", "Q339=+3"),
];

#[test]
fn work_offsets_are_counted_as_the_control_counts_them() {
    let scratch = Scratch::new("work-offsets");
    for (post, number, words) in OFFSETS {
        scratch.write(
            "points.apt",
            POINTS.replace("LOADTL", &format!("MACHIN/ {post}, WCS = {number}\nLOADTL")),
        );
        let built = scratch.run(&["build", "points.apt", "-o", "-"]);
        let text = stdout(&built);
        assert_eq!(code(&built), 0, "{post} {number}: {}", stderr(&built));
        let is_word = |line: &str| format!(" {line} ").contains(&format!(" {words} "));
        assert!(text.lines().any(is_word), "{post}: no {words} in\n{text}");
    }
    for (post, number, why) in [
        ("fanuc", "55", "from 1 to 54"),
        ("sinumerik", "100", "from 1 to 99"),
        ("linuxcnc", "10", "from 1 to 9"),
        ("grbl", "0", "from 1 to 6"),
        ("marlin", "1", "does not have"),
        ("'apt-cl'", "2", "does not have"),
    ] {
        scratch.write(
            "points.apt",
            POINTS.replace("LOADTL", &format!("MACHIN/ {post}, WCS = {number}\nLOADTL")),
        );
        let refused = scratch.run(&["build", "points.apt", "-o", "-"]);
        assert_eq!(code(&refused), 1, "{post} {number}: {}", stdout(&refused));
        assert!(stderr(&refused).contains(why), "{post} {number}: {}", stderr(&refused));
    }
}
