//! Input that tries to crash, hang or blow up the compiler. The cargo-fuzz target `fuzz/fuzz_targets/source.rs`
//! looks for more of it; what it finds becomes a case here.

use std::time::{Duration, Instant};

use partwright::diag::render::{Format, render};
use partwright::driver::{self, Build, Options};
use partwright::source::MemoryFiles;
use proptest::prelude::*;

/// More than any case takes in a debug build on a busy machine.
const PATIENCE: Duration = Duration::from_secs(20);

fn compile(text: &str) -> Build {
    let mut files = MemoryFiles::default();
    files.0.insert("a.apt".to_owned(), text.to_owned());
    let options = Options { posts: vec!["linuxcnc".to_owned()], ..Options::default() };
    let build = driver::build("a.apt", &files, &options);
    for diagnostic in &build.diagnostics {
        let shown = render(diagnostic, &build.sources, Format::Human, false);
        assert!(shown.len() < 100_000, "a message of {} bytes", shown.len());
        assert!(render(diagnostic, &build.sources, Format::Json, false).starts_with('{'));
    }
    build
}

/// The code of the first message, after checking that it came in time.
fn first_code(text: &str) -> String {
    let start = Instant::now();
    let build = compile(text);
    assert!(start.elapsed() < PATIENCE, "took {:?}", start.elapsed());
    assert!(build.outputs.iter().all(|o| o.proven.is_none()));
    build.diagnostics.first().map(|d| d.code.id.to_owned()).unwrap_or_default()
}

#[test]
fn very_long_lines_get_a_quick_answer() {
    let megabytes = 10_000_000;
    assert_eq!(first_code(&format!("GOTO/ {}1\n", "1,".repeat(megabytes / 2))), "E0111");
    assert_eq!(first_code(&"(".repeat(megabytes)), "E0111");
    assert_eq!(first_code(&"@".repeat(megabytes)), "E0106");
    assert_eq!(first_code(&"'".repeat(megabytes)), "E0111");
    assert_eq!(first_code(&"A".repeat(megabytes)), "E0111");
    assert_eq!(first_code(&"\0".repeat(megabytes)), "E0107");
    assert_eq!(first_code(&"A=(1,\n".repeat(megabytes / 6)), "E0111");
    assert_eq!(first_code(&format!("GOTO/ 1, {}", "$\n".repeat(megabytes / 2))), "E0109");
}

#[test]
fn deep_nesting_does_not_overflow_the_stack() {
    let nested = |open: &str, n: usize| format!("A = {}1{}\n", open.repeat(n), ")".repeat(n));
    assert_eq!(first_code(&nested("(", 1000)), "E0111");
    assert_eq!(first_code(&nested("(B = POINT/ ", 1000)), "E0111");
    assert_eq!(first_code(&format!("A = {}1\n", "-".repeat(100_000))), "E0111");
    assert_eq!(first_code(&format!("A = {}1\n", "1 + ".repeat(50_000))), "E0111");
    assert_eq!(first_code(&format!("A = {}2\n", "2 ** ".repeat(50_000))), "E0111");
    assert_eq!(first_code(&format!("A = x{}\n", ".y".repeat(1000))), "E0111");
    // Just inside the limits.
    for text in [
        nested("(", 60),
        format!("A = {}1\n", "-".repeat(390)),
        format!("A = {}1\n", "1 + ".repeat(390)),
        nested("1 + (-", 60),
    ] {
        assert_ne!(first_code(&text), "E0111");
    }
}

#[test]
fn backtracking_stays_linear() {
    let nested =
        |open: &str, n: usize, tail: &str| format!("A = {}1 1{}{tail}\n", open.repeat(n), ")".repeat(n));
    for open in ["(", "(a/", "(a = b/", "f(", "(1, f(", "-(", "(a/1, (b = c/ "] {
        let depth = 60 / open.matches('(').count();
        let closes = ")".repeat(depth * open.matches('(').count());
        assert_eq!(first_code(&format!("A = {}1 1{closes}\n", open.repeat(depth))), "E0101", "{open}");
    }
    assert_eq!(first_code(&nested("(", 60, " 5")), "E0101");
}

#[test]
fn loops_and_macros_that_never_end_are_stopped() {
    for text in [
        "I = 1\nWHILE/ I > 0\nI = 1\nENDWHILE\n",
        "LOOPST\nA1) JUMPTO/ A1\nLOOPND\n",
        "M = MACRO\nCALL/ M\nTERMAC\nCALL/ M\n",
        "DO/ I = 1, 1E12\nDO/ J = 1, 1E12\nX = I\nENDDO\nENDDO\n",
        "M1 = MACRO\nDO/ I = 1, 1000000\nGOTO/ I, 0, 0\nENDDO\nTERMAC\nDO/ J = 1, 1000000\nCALL/ M1\nENDDO\n",
    ] {
        let start = Instant::now();
        let build = compile(text);
        assert!(start.elapsed() < PATIENCE, "{text} took {:?}", start.elapsed());
        assert!(build.has_errors(), "{text} was accepted");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn any_text_is_answered(text in "\\PC{0,200}") {
        compile(&text);
    }

    #[test]
    fn any_soup_of_marks_and_words_is_answered(
        parts in prop::collection::vec(
            prop::sample::select(vec![
                "GOTO", "POINT", "IF", "MACRO", "TERMAC", "A", "B1", "=", "/", ",", "(", ")", "$", "$$", ";", "\n",
                " ", "1", "2.5", ".", "mm", "deg", "'", "\"", "+", "-", "*", "**", "==", "<", ".EQ.", "AND", "NOT",
                "PARTNO x", "CAM", "CIRCLE", "DO", "ENDDO", "CALL", "JUMPTO", "LOOPST", "\r\n", "é", "UNITS/MM\n",
            ]),
            0..60,
        )
    ) {
        compile(&parts.concat());
    }
}
