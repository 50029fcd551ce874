//! One character of a dialect file makes a difference, or a coded refusal: never a panic, never a program that is not proven.
//!
//! Every value of every built-in post is changed by one character; two CL files with all that such files can say are
//! posted with it, where that makes no difference the programs of `tests/data/mutations`, and where these make none either,
//! the post itself is checked. The snapshot lists the values for which no change made a difference.

mod common;

use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use partwright::diag::Severity;
use partwright::driver::{self, Options};
use partwright::post::{builtin_names, builtin_text, lint, load};
use partwright::source::{MemoryFiles, SourceMap};

const BODY: &str = "\
COOLNT/ FLOOD
FEDRAT/ 250, UPM
RAPID
GOTO/ 30, 0, 20
GOTO/ 30, 0, 2
GOTO/ 30, 0, -0.12345
FEDRAT/ 0.123456, PERREV
CIRCLE/ 0, 0, -0.12345, 0, 0, 1, 30
GOTO/ 0, 30, -0.12345
CIRCLE/ 0, 0, -0.12345, 0, 0, -1, 30
GOTO/ -30, 0, -0.12345
CIRCLE/ 0, 0, -0.12345, 0, 0, 1, 30
GOTO/ -30, 0, -0.12345
CIRCLE/ 0, 0, -0.12345, 0, 0, 1, 30, TIMES, 2
GOTO/ 30, 0, -4
CIRCLE/ 20, 0, -4, 0, 1, 0, 10
GOTO/ 10, 0, -4
CIRCLE/ 10, 10, -4, 1, 0, 0, 10
GOTO/ 10, 10, 6
DELAY/ 1.2345
STOP
OPSTOP
PPRINT CHECK (THE) CLAMPS, 100 % / a-b_c: *d* =e+f; and go on for more than all of the characters that a comment may hold here
RAPID
GOTO/ 10, 10, 40
COOLNT/ MIST
CYCLE/ DRILL, FEDTO, 12, RAPTO, 2, PERMIN, 120
GOTO/ 1, 1, 0
GOTO/ 2, 1, 0
CYCLE/ OFF
CYCLE/ FACE, FEDTO, 12, RAPTO, 2, RETURN, ON, PERMIN, 120, DWELL, 0.75
GOTO/ 1, 1, 0
CYCLE/ OFF
CYCLE/ DEEP, FEDTO, 12, STEP, 4, RAPTO, 2, PERMIN, 120
GOTO/ 1, 1, 0
CYCLE/ OFF
CYCLE/ BRKCHP, FEDTO, 12, STEP, 4, RAPTO, 2, PERMIN, 120
GOTO/ 1, 1, 0
CYCLE/ OFF
CYCLE/ REAM, FEDTO, 12, RAPTO, 2, PERMIN, 120
GOTO/ 1, 1, 0
CYCLE/ OFF
CYCLE/ REAM, FEDTO, 12, RAPTO, 2, PERMIN, 120, DWELL, 0.5
GOTO/ 1, 1, 0
CYCLE/ OFF
CYCLE/ BORE, FEDTO, 12, RAPTO, 2, PERMIN, 120
GOTO/ 1, 1, 0
CYCLE/ OFF
COOLNT/ OFF
CUTTER/ 6, 3
LOADTL/ 12
SPINDL/ 900.5, CCLW
RAPID
GOTO/ 0, 0, 40
GOTO/ 0, 0, 5
FEDRAT/ 90, UPM
GOTO/ 0, 0, -1
NURBS/
KNOT/ 0.5, 1
CNTRL/ 10, 5, -1
CNTRL/ 20, 5, -1
CNTRL/ 20, 20, -1
CNTRL/ 30, 30, -1
RAPID
GOTO/ 30, 30, 40
";

fn program(unit: &str) -> String {
    format!(
        "PARTNO A (TITLE) OF % THE PART\nUNITS/ {unit}\nCUTTER/ 10\nLOADTL/ 3\nSPINDL/ 1200, CLW, RANGE, 2\n{BODY}FINI\n"
    )
}

/// What comes of the two programs of CL text.
fn outcome(post: &str) -> String {
    let both = ["MM", "INCH"].map(|unit| (format!("{unit}.cls"), program(unit)));
    both.iter().map(|(name, text)| outcome_of(name, text, post)).collect()
}

/// What comes of a program: its proven text or the codes of errors; nothing else may come.
fn outcome_of(name: &str, text: &str, post: &str) -> String {
    let files = [(name.to_owned(), text.to_owned()), ("m.post.toml".to_owned(), post.to_owned())];
    let options = Options {
        posts: vec!["m.post.toml".to_owned()],
        is_cl: name.ends_with(".cls"),
        only_nc: true,
        ..Options::default()
    };
    let build = driver::build(name, &MemoryFiles(files.into()), &options);
    let proven = build.outputs.first().and_then(|o| o.proven.as_ref());
    let errors: BTreeSet<&str> =
        build.diagnostics.iter().filter(|d| d.severity == Severity::Error).map(|d| d.code.id).collect();
    // A text comes exactly where nothing is wrong.
    assert_eq!(proven.is_some(), errors.is_empty(), "{name}: {post}\n{:?}", build.diagnostics);
    let mut all = match proven {
        Some(proven) => proven.text().to_owned(),
        None => format!("{errors:?}\n"),
    };
    if let Some(output) = build.outputs.first() {
        _ = writeln!(all, "{}", output.extension);
    }
    all
}

/// Small programs for what the two long ones do not say, by name.
fn further() -> Vec<(String, String)> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/mutations");
    let entries = std::fs::read_dir(folder).expect("the programs");
    let mut paths: Vec<_> = entries.map(|e| e.expect("an entry").path()).collect();
    paths.sort();
    let read = |path: &std::path::PathBuf| {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        (name, std::fs::read_to_string(path).expect("a program"))
    };
    paths.iter().map(read).collect()
}

/// What comes of a changed post, as far as it may differ: programs, and what `post check` says of the post itself.
struct Before<'a> {
    text: &'a str,
    outcome: String,
    further: Vec<(&'a str, &'a str, String)>,
    findings: OnceCell<String>,
}

impl<'a> Before<'a> {
    fn new(text: &'a str, programs: &'a [(String, String)]) -> Before<'a> {
        let further = programs
            .iter()
            .map(|(name, program)| (name.as_str(), program.as_str(), outcome_of(name, program, text)));
        Before { text, outcome: outcome(text), further: further.collect(), findings: OnceCell::new() }
    }

    fn differs(&self, mutant: &str) -> bool {
        outcome(mutant) != self.outcome
            || self.further.iter().any(|(name, program, before)| outcome_of(name, program, mutant) != *before)
            || findings(mutant) != *self.findings.get_or_init(|| findings(self.text))
    }
}

/// What is said of a post before any program.
fn findings(post: &str) -> String {
    let files = MemoryFiles([("m.post.toml".to_owned(), post.to_owned())].into());
    let mut sources = SourceMap::default();
    let found = match load("m.post.toml", &files, &mut sources) {
        Ok(dialect) => lint(&dialect, &mut sources),
        Err(errors) => errors,
    };
    found.iter().map(|d| format!("{} {}\n", d.code.id, d.message)).collect()
}

/// The values of a file: where each stands, and its key with its table.
fn values(text: &str) -> Vec<(std::ops::Range<usize>, String)> {
    let mut found = Vec::new();
    let (mut table, mut key, mut at, mut open) = (String::new(), String::new(), 0, false);
    for line in text.split_inclusive('\n') {
        let trimmed = line.trim();
        if !open && trimmed.starts_with('[') && trimmed.ends_with(']') && !trimmed.contains('"') {
            table = trimmed.trim_matches(['[', ']']).to_owned() + ".";
        } else if !open && !trimmed.starts_with('#') {
            if let Some((name, _)) = line.split_once(" = ") {
                key = format!("{table}{name}");
            }
            let from = line.find(" = ").map_or(0, |i| i + 3);
            if trimmed.len() > from {
                found.push((at + from..at + line.trim_end().len(), key.clone()));
            }
        } else if open && !trimmed.is_empty() {
            found.push((at..at + line.trim_end().len(), key.clone()));
        }
        open ^= line.matches("\"\"\"").count() % 2 == 1;
        at += line.len();
    }
    found
}

/// The text with one character of a value changed, for a few characters over its length.
fn changed(text: &str, value: &std::ops::Range<usize>) -> Vec<String> {
    let other = |c: char| match c {
        '0'..='8' => char::from_u32(u32::from(c) + 1),
        '9' => Some('8'),
        'a'..='y' | 'A'..='Y' => char::from_u32(u32::from(c) + 1),
        'z' => Some('y'),
        'Z' => Some('Y'),
        '.' => Some(','),
        '%' | ';' | '(' | ')' => Some('!'),
        _ => None,
    };
    let said = &text[value.clone()];
    if said == "true" || said == "false" {
        let flipped = if said == "true" { "false" } else { "true" };
        return vec![format!("{}{flipped}{}", &text[..value.start], &text[value.end..])];
    }
    let places: Vec<(usize, char)> = said.char_indices().filter_map(|(i, c)| Some((i, other(c)?))).collect();
    let few = [0, places.len() / 3, places.len() * 2 / 3, places.len().saturating_sub(1)];
    let few: BTreeSet<usize> = few.into_iter().collect();
    let one = |at: &usize| {
        let (i, new) = *places.get(*at)?;
        let (before, after) = (&text[..value.start + i], &text[value.start + i + 1..]);
        Some(format!("{before}{new}{after}"))
    };
    few.iter().filter_map(one).collect()
}

#[test]
fn one_character_of_a_dialect_file_makes_a_difference_or_is_refused() {
    let mut silent = String::new();
    let programs = further();
    for name in builtin_names() {
        let text = builtin_text(name).expect("a built-in post");
        let before = Before::new(text, &programs);
        assert!(before.outcome.lines().count() > 60, "{name}: {}", before.outcome);
        let mut keys: BTreeMap<String, bool> = BTreeMap::new();
        // For people only: `post list` and `post show` print them.
        let spoken = |key: &str| ["post.title", "post.basis"].contains(&key);
        for (value, key) in values(text).into_iter().filter(|(_, key)| !spoken(key)) {
            // An empty text, for what a control does not have, has no character.
            let mutants = changed(text, &value);
            let matters = mutants.is_empty() || mutants.iter().any(|mutant| before.differs(mutant));
            *keys.entry(key).or_default() |= matters;
        }
        assert!(keys.len() > 5 || text.len() < 900, "{name}: {keys:?}");
        for (key, _) in keys.iter().filter(|(_, matters)| !**matters) {
            _ = writeln!(silent, "{name}: {key}");
        }
    }
    insta::assert_snapshot!(silent);
}
