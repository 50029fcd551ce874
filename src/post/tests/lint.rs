//! Findings in post files that load, and the resolved listing.

use crate::post::variables::{Scope, VARIABLES};
use crate::post::{builtin_names, lint, load};
use crate::source::{MemoryFiles, SourceMap};

/// What lint says of a file that inherits from LinuxCNC: code, message, help.
fn findings(text: &str) -> Vec<String> {
    let text = format!("inherits = \"linuxcnc\"\n{text}");
    let files = MemoryFiles([("my.post.toml".to_owned(), text)].into());
    let mut sources = SourceMap::default();
    let dialect = load("my.post.toml", &files, &mut sources).unwrap_or_else(|e| panic!("{e:#?}"));
    let shown = |d: &crate::diag::Diagnostic| format!("{} {} {}", d.code.id, d.message, d.help.join(" "));
    lint(&dialect, &mut sources).iter().map(|d| shown(d).trim_end().to_owned()).collect()
}

fn only(text: &str) -> String {
    let found = findings(text);
    assert_eq!(found.len(), 1, "{found:#?}");
    found.concat()
}

#[test]
fn built_in_posts_have_no_findings() {
    for name in builtin_names() {
        let mut sources = SourceMap::default();
        let dialect = load(name, &MemoryFiles::default(), &mut sources).unwrap();
        let found = lint(&dialect, &mut sources);
        assert!(found.is_empty(), "{name}: {found:#?}");
    }
}

#[test]
fn variables_are_checked_where_they_are_used() {
    assert_eq!(
        only("[templates]\nheader = \"({{ program.titel }})\""),
        "E0751 the template `templates.header` has no variable `program.titel` did you mean `program.title`?"
    );
    assert!(
        only("[templates]\nfooter = \"T{{ tool.number }}\\nM30\"").contains("has no variable `tool.number`")
    );
    assert_eq!(
        only("[templates]\noperation = \"{% if options.LOUD %}M64{% endif %}\""),
        "E0751 the template `templates.operation` has no variable `options.LOUD` say `LOUD = \"…\"` in [options]"
    );
    assert_eq!(
        findings("[templates]\noperation = \"{% set n = 3 %}{% for i in range(n) %}M64{% endfor %}\""),
        [""; 0]
    );
}

#[test]
fn parts_without_effect_are_named() {
    assert_eq!(
        only("[tool-change.blocks]\nwait = \"M0\""),
        "W0753 no tool change prints the block `wait`: `tool-change.order` does not name it"
    );
    assert_eq!(only("[words.extra]\nprefix = \"Q\""), "W0753 nothing prints the word `extra`");
    assert_eq!(only("[words.radius]\nmax = 5000"), "W0753 no pattern prints the word `radius`");
    assert_eq!(only("[options]\nVISE = \"left\""), "W0753 no template reads `options.VISE`");
}

#[test]
fn claims_that_words_cannot_express_are_errors() {
    let claims = [
        ("[codes]\narc-ccw = \"G2\"", "clockwise and counter-clockwise arcs are printed alike"),
        ("[patterns]\nline = [\"feed-mode\", \"motion\", \"x\", \"y\", \"z\", \"rotary\"]", "no `feed`"),
        ("[codes]\ninverse-time = \"\"", "`codes.inverse-time` is empty"),
        ("[path-control]\ntolerance = []\nshare = 0.5", "`path-control.tolerance` is empty"),
        ("[post]\ncontrol = \"linuxcmc\"", "did you mean `linuxcnc`?"),
    ];
    for (text, part) in claims {
        let found = only(text);
        assert!(found.starts_with("E0752 ") && found.contains(part), "{text}: {found}");
    }
}

#[test]
fn codes_with_two_meanings_are_errors() {
    assert_eq!(only("[spindle]\ncounter-clockwise = \"M3\""), "E0754 both senses of the spindle are `M3`");
    assert_eq!(only("[coolant]\nflood = \"M5\""), "E0754 `spindle.off` and `coolant.flood` are both `M5`");
    assert_eq!(
        only("[codes]\nplane-zx = \"G17\""),
        "E0754 `codes.plane-xy` and `codes.plane-zx` are both `G17`"
    );
    assert_eq!(
        only("[groups.units]\ncodes = [\"G17\", \"G20\", \"G21\"]"),
        "E0754 `G17` is in two modal groups, `plane` and `units`"
    );
}

/// What loading says of a file that inherits from LinuxCNC: message, and the line it points at.
fn refused(text: &str) -> Vec<(String, usize)> {
    let text = format!("inherits = \"linuxcnc\"\n{text}");
    let files = MemoryFiles([("my.post.toml".to_owned(), text)].into());
    let mut sources = SourceMap::default();
    let errors = load("my.post.toml", &files, &mut sources).err().unwrap_or_default();
    let line = |d: &crate::diag::Diagnostic| {
        d.primary.as_ref().map_or(0, |p| sources.file(p.span.file).line_column(p.span.start).0)
    };
    errors.iter().map(|d| (d.message.clone(), line(d))).collect()
}

#[test]
fn words_alike_are_said_once_and_where_the_file_says_them() {
    let alike = "the words `x` and `y` are both spelled `Y`".to_owned();
    assert_eq!(refused("[words.x]\nprefix = \"Y\""), [(alike, 3)]);
}

#[test]
fn comments_cannot_be_given_what_ends_them() {
    for text in ["replace = \")\"", "allowed = \".(\"", "allowed = \"%\"", "replace = \"\\n\""] {
        let found = refused(&format!("[comments]\n{text}"));
        assert!(
            matches!(found.as_slice(), [(m, 3)] if m.contains("could end a comment")),
            "{text}: {found:?}"
        );
    }
    assert_eq!(refused("[comments]\nreplace = \" \"\nallowed = \"+#\""), []);
}

#[test]
fn a_rotary_axis_cannot_be_called_like_a_linear_one() {
    let found = refused("[rotary]\nletter = \"X\"\nletters = \"XC\"");
    assert_eq!(found, [("`rotary.letters` has `X`, which is the word `x`".to_owned(), 4)]);
}

#[test]
fn every_variable_of_the_table_exists_where_the_table_says_and_is_documented() {
    let guide = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/posts.md")).unwrap();
    for variable in VARIABLES {
        let (table, key) = match variable.scope {
            Scope::Everywhere => ("templates", "header"),
            Scope::ToolChange => ("tool-change.blocks", "text"),
            Scope::Operation => ("templates", "operation"),
            Scope::Cycle => ("cycles.drill", "end"),
        };
        let probe = format!(
            "inherits = \"linuxcnc\"\n[{table}]\n{key} = \"{{% if {} is defined %}}(yes){{% endif %}}\"\n",
            variable.name
        );
        let files = MemoryFiles([("my.post.toml".to_owned(), probe)].into());
        let dialect = load("my.post.toml", &files, &mut SourceMap::default()).unwrap();
        let sheet = super::build::Sheet::new(dialect, crate::units::LengthUnit::Millimetre, None);
        let sheet = match variable.scope {
            Scope::Everywhere => sheet,
            Scope::ToolChange => sheet.event(crate::target::BlockKind::ToolChange(0)),
            Scope::Operation => sheet.event(crate::target::BlockKind::BeginOperation("OP1".into())),
            Scope::Cycle => sheet.drill(crate::cl::CycleKind::Drill, &[(0, 0)]),
        };
        assert!(sheet.text().contains("(yes)"), "{} is not defined in {table}.{key}", variable.name);
        let last = variable.name.rsplit('.').next().unwrap();
        let named = [format!("`{}`", variable.name), format!("`.{last}`")];
        let parent = VARIABLES.iter().any(|v| v.name.starts_with(&format!("{}.", variable.name)));
        assert!(
            parent || named.iter().any(|n| guide.contains(n.as_str())) || variable.name == "options",
            "{} is not in docs/posts.md",
            variable.name
        );
    }
}

#[test]
fn the_resolved_listing_is_the_same_post() {
    for name in builtin_names() {
        let mut sources = SourceMap::default();
        let dialect = load(name, &MemoryFiles::default(), &mut sources).unwrap();
        let text = dialect.resolved_text(&sources);
        let files = MemoryFiles([("all.post.toml".to_owned(), text.clone())].into());
        let again = load("all.post.toml", &files, &mut SourceMap::default())
            .unwrap_or_else(|e| panic!("{name}: {e:#?}\n{text}"));
        let plain = |d: &crate::post::Dialect| {
            let mut tree = crate::post::tree::plain(&d.tree);
            tree.remove("inherits");
            tree
        };
        assert_eq!(plain(&again), plain(&dialect), "{name}");
    }
}

#[test]
fn the_resolved_listing_names_the_file_of_every_value() {
    let text = "inherits = \"grbl\"\n[post]\ntitle = \"router\"\n";
    let files = MemoryFiles([("my.post.toml".to_owned(), text.to_owned())].into());
    let mut sources = SourceMap::default();
    let set = ("line.separator".to_owned(), "\" \"".to_owned());
    let dialect = crate::post::load_with("my.post.toml", &[set], &files, &mut sources).unwrap();
    let listed = dialect.resolved_text(&sources);
    let has = |part: &str| assert!(listed.contains(part), "{part} is not in\n{listed}");
    has("title = \"router\"  # my.post.toml:3\n");
    has("control = \"grbl\"  # builtin grbl.post.toml:");
    has("radius-tolerance = 0.002  # builtin iso.post.toml:");
    has("separator = \" \"  # --post-set:1\n");
    assert_eq!(dialect.lineage(), ["my.post.toml", "grbl", "iso"]);
}
