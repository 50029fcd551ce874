//! Post files: inheriting, errors with their places.

use crate::diag::Diagnostic;
use crate::post::{Dialect, load, load_with};
use crate::source::{MemoryFiles, SourceMap};
use crate::units::LengthUnit;

fn files(list: &[(&str, &str)]) -> MemoryFiles {
    MemoryFiles(list.iter().map(|(n, t)| ((*n).to_owned(), (*t).to_owned())).collect())
}

fn user(text: &str) -> Result<Dialect, Vec<Diagnostic>> {
    load("my.post.toml", &files(&[("my.post.toml", text)]), &mut SourceMap::default())
}

/// The errors of a post file: code, what the place holds, the message and the help.
fn complaints(text: &str) -> Vec<String> {
    let mut sources = SourceMap::default();
    let result = load("my.post.toml", &files(&[("my.post.toml", text)]), &mut sources);
    let errors = result.err().unwrap_or_default();
    errors
        .iter()
        .map(|e| {
            let place = e.primary.as_ref().map_or("", |p| sources.text(p.span));
            format!("{} `{place}` {} {}", e.code.id, e.message, e.help.join(" ")).trim_end().to_owned()
        })
        .collect()
}

#[test]
fn a_user_file_inherits_and_changes_only_what_it_says() {
    let dialect = user("inherits = \"linuxcnc\"\n[numbers]\nlinear-decimals = 5\n").unwrap();
    assert_eq!(dialect.name(), "my");
    assert_eq!(dialect.control(), "linuxcnc");
    let capabilities = dialect.capabilities(LengthUnit::Inch, None).unwrap();
    assert_eq!(capabilities.grid.linear_decimals, 5);
    assert!(capabilities.inverse_time);
}

#[test]
fn unknown_keys_are_shown_with_what_was_probably_meant() {
    let text = "inherits = \"fanuc\"\n[word.x]\nprefix = \"X\"\n[words.y]\ndecimal = 3\n[arcs]\nxyzzy = 1\n";
    assert_eq!(
        complaints(text),
        [
            "E0703 `xyzzy` [arcs] has no key `xyzzy` its keys are enabled, planes, zero-offsets, full-circle, signed-radius, split, max-sweep, min-radius, max-radius, radius-tolerance, helix",
            "E0703 `word` a post file has no key `word` did you mean `words`?",
            "E0703 `decimal` [words.y] has no key `decimal` did you mean `decimals`?",
        ]
    );
    // A key of another table.
    assert_eq!(
        complaints("inherits = \"fanuc\"\ncontrol = \"fanuc M60=nothing\"\n"),
        ["E0703 `control` a post file has no key `control` `control` is a key of [post]"]
    );
}

#[test]
fn wrong_values_say_what_is_wanted() {
    let text = "inherits = \"fanuc\"\n[post]\ntitle = 7\n[words.x]\ndecimals = 99\nmax = { mm = 5 }\n[arcs]\nfull-circle = \"bares\"\nhelix = \"yes\"\n[limits]\nx = [10, -10]\n";
    assert_eq!(
        complaints(text),
        [
            "E0704 `\"bares\"` `arcs.full-circle` is one of \"bare\", \"one-end-word\", \"end-words\", \"split\"; did you mean \"bare\"?, not \"bares\"",
            "E0704 `\"yes\"` `arcs.helix` is `true` or `false`, not \"yes\"",
            "E0704 `[10, -10]` `limits.x` is a list of two numbers, the smaller first, not [10, -10]",
            "E0704 `7` `post.title` is a text, not 7",
            "E0704 `99` `words.x.decimals` is an integer from 0 to 9, or one each for `mm` and `inch`, not 99",
            "E0704 `{ mm = 5 }` `words.x.max` says nothing for `inch`; give both `mm` and `inch`, or one value",
        ]
    );
}

#[test]
fn broken_toml_and_missing_parents_are_coded() {
    assert!(complaints("inherits = \n")[0].starts_with("E0702"));
    assert!(complaints("inherits = \"fanuk\"\n")[0].starts_with("E0701 `\"fanuk\"`"));
    assert!(complaints("inherits = \"other.post.toml\"\n")[0].starts_with("E0706"));
    assert!(complaints("[post]\ntitle = \"alone\"\n")[0].starts_with("E0707"));
}

#[test]
fn circles_of_inheritance_end() {
    let list =
        [("a.post.toml", "inherits = \"b.post.toml\"\n"), ("b.post.toml", "inherits = \"a.post.toml\"\n")];
    let errors = load("a.post.toml", &files(&list), &mut SourceMap::default()).unwrap_err();
    assert_eq!(errors[0].code.id, "E0705");
    assert!(errors[0].message.ends_with("a.post.toml > b.post.toml > a.post.toml"), "{}", errors[0].message);
}

#[test]
fn names_that_do_not_fit_together_are_refused() {
    let first = |text: &str| {
        complaints(&format!("inherits = \"fanuc\"\n{text}")).first().cloned().unwrap_or_default()
    };
    assert!(first("[patterns]\nline = [\"motion\", \"x\", \"y\"]\n").starts_with("E0708"));
    assert!(
        first("[patterns]\nline = [\"motoin\", \"x\", \"y\", \"z\"]\n").contains("did you mean `motion`?")
    );
    assert!(first("[words.y]\nprefix = \"X\"\n").contains("both spelled `X`"));
    assert!(first("[tool-change]\norder = [\"cal\"]\n").contains("did you mean `call`?"));
    assert!(first("[groups.extra]\nstart = \"G15\"\n").starts_with("E0708"));
    assert!(first("[templates]\nheader = \"{% if %}\"\n").starts_with("E0709"));
}

#[test]
fn errors_of_a_merged_file_point_into_the_built_in_file_they_come_from() {
    let mut sources = SourceMap::default();
    let text = "inherits = \"linuxcnc\"\nsafe-start = [[\"plane\"]]\n";
    let errors = load("my.post.toml", &files(&[("my.post.toml", text)]), &mut sources).unwrap_err();
    let place = errors[0].primary.as_ref().unwrap().span;
    assert_eq!(sources.file(place.file).name, "builtin linuxcnc.post.toml");
}

#[test]
fn options_of_the_machine_reach_the_templates_and_others_are_refused() {
    let dialect = user(
        "inherits = \"grbl\"\n[options]\nVISE = \"left\"\n[templates]\nheader = \"({{ options.VISE }})\"\n",
    )
    .unwrap();
    let mut sheet = super::build::Sheet::new(dialect.clone(), LengthUnit::Millimetre, None);
    let machine = |key: &str| crate::ir::Machine {
        post: "my".into(),
        rotary: None,
        options: vec![(key.into(), Some("right".into()))],
        origin: sheet.program.tools[0].origin,
    };
    let (known, slip) = (machine("vise"), machine("VICE"));
    sheet.program.capabilities = dialect.capabilities(LengthUnit::Millimetre, Some(&known)).unwrap();
    assert_eq!(sheet.text(), "(right)\n");
    let error = dialect.capabilities(LengthUnit::Millimetre, Some(&slip)).unwrap_err();
    assert_eq!((error.code.id, error.help[0].as_str()), ("E0713", "did you mean `VISE`?"));
}

#[test]
fn undefined_variables_are_errors() {
    let dialect = user("inherits = \"linuxcnc\"\n[templates]\nheader = \"({{ program.titel }})\"\n").unwrap();
    let sheet = super::build::Sheet::new(dialect, LengthUnit::Millimetre, None);
    let errors = sheet.event(crate::target::BlockKind::Begin).written().unwrap_err();
    assert_eq!(errors[0].code.id, "E0709");
    assert!(errors[0].message.contains("undefined variable"), "{}", errors[0].message);
}

#[test]
fn overrides_go_through_the_same_checks() {
    let set = |key: &str, value: &str| {
        load_with(
            "linuxcnc",
            &[(key.to_owned(), value.to_owned())],
            &MemoryFiles::default(),
            &mut SourceMap::default(),
        )
    };
    assert_eq!(set("post.extension", "tap").unwrap().extension(), "tap");
    for bad in ["../../x", "", "a.b", "n c", "seventeen-letters", "tap\n", "ü"] {
        assert_eq!(set("post.extension", bad).unwrap_err()[0].code.id, "E0704", "{bad}");
    }
    assert_eq!(set("post.control", "linuxcnc dwell=K:0.01s").unwrap().control(), "linuxcnc dwell=K:0.01s");
    let wrong = set("post.control", "linuxcnc dwell=K").unwrap_err();
    assert!(wrong[0].code.id == "E0704" && wrong[0].message.contains("ADDRESS:UNIT"), "{wrong:?}");
    let finer = set("numbers.linear-decimals", "5").unwrap();
    assert_eq!(finer.capabilities(LengthUnit::Millimetre, None).unwrap().grid.linear_decimals, 5);
    assert_eq!(set("words.x.decimals", "5").unwrap_err()[0].code.id, "E0708");
    assert_eq!(set("words.x.decimals", "many").unwrap_err()[0].code.id, "E0704");
    assert_eq!(set("word.x", "1").unwrap_err()[0].code.id, "E0703");
}

#[test]
fn every_key_of_the_schema_is_understood_and_every_built_in_post_gives_it() {
    // A key that the types do not know would be refused by serde when a file gives it; a key that the types
    // know and the schema does not would be refused by the schema.
    let text = crate::post::builtin_text("iso").unwrap();
    let table: toml::Table = text.parse().unwrap();
    for key in crate::post::schema::ROOT {
        let optional = ["inherits", "safe-start", "limits", "options", "option-values", "cycles"];
        assert!(optional.contains(&key.name) || table.contains_key(key.name), "{} is in no file", key.name);
    }
}

#[test]
fn pieces_that_are_not_wholly_said_are_refused() {
    let post = |nurbs: &str| {
        format!(
            "inherits = \"linuxcnc\"\n[words.leave-x]\nprefix = \"I\"\n[words.leave-y]\nprefix = \"J\"\n[words.arrive-x]\nprefix = \"P\"\n[words.arrive-y]\nprefix = \"Q\"\n[nurbs]\nknots = \"pieces\"\n{nurbs}"
        )
    };
    let whole =
        "point = [\"=G5\", \"x\", \"y\", \"leave-x\", \"leave-y\", \"arrive-x\", \"arrive-y\", \"feed\"]\n";
    assert_eq!(complaints(&post(&format!("begin = []\nend = []\n{whole}"))), [""; 0]);
    let framed = complaints(&post(whole));
    assert_eq!(framed.len(), 2, "{framed:#?}");
    assert!(framed.iter().all(|c| c.starts_with("E0708") && c.contains("it must be []")), "{framed:#?}");
    for (items, words) in [
        ("\"x\", \"y\", \"leave-x\", \"leave-y\", \"arrive-x\", \"feed\"", "whole piece along Y"),
        ("\"x\", \"leave-x\", \"leave-y\", \"arrive-x\", \"arrive-y\", \"feed\"", "whole piece along Y"),
        ("\"x\", \"y\", \"z\", \"leave-x\", \"leave-y\", \"arrive-x\", \"arrive-y\", \"feed\"", "along Z"),
        ("\"x\", \"y\", \"leave-x\", \"leave-y\", \"arrive-x\", \"arrive-y\"", "has no `feed`"),
        (
            "\"x\", \"y\", \"leave-x\", \"leave-y\", \"arrive-x\", \"arrive-y\", \"feed\", \"weight\"",
            "`weight` is no item",
        ),
        (
            "\"x\", \"y\", \"leave-x\", \"leave-y\", \"arrive-x\", \"arrive-y\", \"feed\", \"a2-x\"",
            "`a2-x` is not in [words]",
        ),
    ] {
        let got = complaints(&post(&format!("begin = []\nend = []\npoint = [\"=G5\", {items}]\n")));
        assert!(got.iter().any(|c| c.starts_with("E0708") && c.contains(words)), "{items}: {got:#?}");
    }
    let coarse = format!("begin = []\nend = []\n{whole}[words.arrive-y]\ndecimals = 3\n")
        .replace("prefix = \"Q\"", "");
    let got = complaints(
        &post(&coarse)
            .replace("[words.arrive-y]\nprefix = \"Q\"\n", "")
            .replace("decimals = 3", "decimals = 3\nprefix = \"Q\""),
    );
    assert!(got.iter().any(|c| c.contains("`arrive-y` has 3 decimals")), "{got:#?}");
}
