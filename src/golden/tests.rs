use super::{names, sidecar, text};
use crate::source::SourceMap;

#[test]
fn names_lead_from_programs_to_golden_files_and_back() {
    assert_eq!(names::golden("parts/plate.apt", "", "fanuc", "nc"), "parts/plate.fanuc.golden.nc");
    assert_eq!(names::golden("a.b/plate", "long", "mill", "H"), "a.b/plate.long.mill.golden.H");
    assert!(names::is_golden("plate.fanuc.golden.nc") && names::is_golden("plate.long.fanuc.golden.nc"));
    assert!(
        !names::is_golden("plate.fanuc.nc")
            && !names::is_golden("golden.nc")
            && !names::is_golden("x.golden.nc")
    );
    assert!(names::may_belong("p/plate.fanuc.golden.nc", "p/plate.apt"));
    assert!(!names::may_belong("p/plate2.fanuc.golden.nc", "p/plate.apt"));
    assert_eq!(names::sidecar("p/plate.apt"), "p/plate.test.toml");
    assert_eq!(names::post("out/plate.fanuc.nc"), Some("fanuc"));
    assert_eq!(names::post("out.d/plate.long.haas.golden.nc"), Some("haas"));
    assert_eq!(names::post("fanuc.nc"), None);
}

#[test]
fn posts_are_named_relative_to_the_test_file() {
    assert_eq!(names::beside("parts/plate.apt", "fanuc"), "fanuc");
    assert_eq!(names::beside("parts/plate.apt", "../posts/mill.post.toml"), "posts/mill.post.toml");
    assert_eq!(names::beside("plate.apt", "../mill.post.toml"), "../mill.post.toml");
    assert_eq!(names::beside("../a/plate.apt", "./mill.post.toml"), "../a/mill.post.toml");
    assert_eq!(names::beside("/a/b/plate.apt", "../mill.post.toml"), "/a/mill.post.toml");
    assert_eq!(names::beside("a/plate.apt", "/x/mill.post.toml"), "/x/mill.post.toml");
}

/// The mistakes of a test file: what the place holds, the message, the help.
fn mistakes(text: &str) -> Vec<String> {
    let mut sources = SourceMap::default();
    let errors = sidecar::parse("a.test.toml", text, &mut sources).expect_err("mistakes");
    let shown = |d: &crate::diag::Diagnostic| {
        let place = d.primary.as_ref().map_or("", |p| sources.text(p.span));
        format!("{} `{place}` {} {}", d.code.id, d.message, d.help.join(" ")).trim_end().to_owned()
    };
    errors.iter().map(shown).collect()
}

#[test]
fn mistakes_in_test_files_have_their_places() {
    assert_eq!(
        mistakes("post = [\"fanuc\"]\n"),
        [
            "E0955 `post` unknown field `post`, expected one of `posts`, `define`, `post-set`, `producer`, `lenient`, `card-columns`, `diagnostics`, `variant`"
        ]
    );
    assert!(mistakes("posts = 3\n")[0].starts_with("E0955 `3` invalid type"));
    assert!(mistakes("posts = [\n")[0].starts_with("E0955"));
    assert_eq!(
        mistakes(
            "posts = [\"fanuc\", \"FANUC\"]\ndiagnostics = [\"W9999\", \"E010\"]\n[[variant]]\nname = \"a b\"\n[[variant]]\nname = \"c\"\n[[variant]]\nname = \"C\"\n"
        ),
        [
            "E0955 `\"FANUC\"` the post `FANUC` is named twice",
            "E0955 `\"W9999\"` there is no diagnostic W9999",
            "E0955 `\"E010\"` there is no diagnostic E010 did you mean E0101?",
            "E0955 `\"a b\"` `a b` is no name for a variant: use letters, digits, `-` and `_`",
            "E0955 `\"C\"` two variants are called `C`",
        ]
    );
}

#[test]
fn differences_of_texts_show_what_changed_with_its_surroundings() {
    let old = "a\nb\nc\nd\ne\n";
    assert_eq!(
        text::difference(old, "a\nb\nX\u{1b}\nd\ne\n"),
        "@@ -1,5 +1,5 @@\n a\n b\n-c\n+X\\u{1b}\n d\n e\n"
    );
    assert_eq!(text::difference("a\n", "a"), "@@ -1 +1 @@\n-a\n+a\n");
    let long: String = (0..30_000).map(|i| format!("X{i}\n")).collect();
    let other = long.replace("X29000\n", "X29000.5\n");
    assert_eq!(text::difference(&long, &other), "@@ line 29001 @@\n-X29000\n+X29000.5\n");
}
