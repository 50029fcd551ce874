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
        "V1 = VECTOR/ 1, 0\nDO/ I = 1, 100000\nP(I) = PATERN/ LINEAR, (0, 0), V1, 100000\nENDDO\n",
        "DO/ I = 1, 10000\nP(I) = POINT/ I, 0\nENDDO\nDO/ J = 1, 100000\nS(J) = SPLINE/ P(ALL)\nENDDO\n",
    ] {
        let start = Instant::now();
        let build = compile(text);
        assert!(start.elapsed() < PATIENCE, "{text} took {:?}", start.elapsed());
        assert!(build.has_errors(), "{text} was accepted");
    }
}

#[test]
fn a_mistake_in_a_loop_is_looked_at_a_few_times_only() {
    let wrong = "M1 = MOTION/ RISE, 180, 20, MODSINE, RETURN, 180, 20, MODSIN\n";
    for text in [
        format!("I = 1\nWHILE/ I > 0\n{wrong}ENDWHILE\nGOTO/ P9\n"),
        format!("DO/ I = 1, 300000\nDO/ J = 1, 300000\n{wrong}ENDDO\nENDDO\nGOTO/ P9\n"),
    ] {
        let start = Instant::now();
        let build = compile(&text);
        let codes: Vec<&str> = build.diagnostics.iter().map(|d| d.code.id).collect();
        assert_eq!(codes, ["E0204", "E0203"], "{text}");
        assert!(start.elapsed() < PATIENCE / 4, "{text} took {:?}", start.elapsed());
    }
    let jumping = format!("LOOPST\nA1) N = 1\n{wrong}JUMPTO/ A1\nLOOPND\n");
    let codes: Vec<String> = compile(&jumping).diagnostics.iter().map(|d| d.code.id.to_owned()).collect();
    assert_eq!(codes, ["E0204", "E0228"]);
}

/// The place (line, column) and code of every message.
fn places(text: &str) -> Vec<(usize, usize, String)> {
    let build = compile(text);
    let place = |d: &partwright::diag::Diagnostic| {
        let primary = d.primary.as_ref().expect("a place");
        let (line, column) = build.sources.file(primary.span.file).line_column(primary.span.start);
        (line, column, d.code.id.to_owned())
    };
    build.diagnostics.iter().map(place).collect()
}

#[test]
fn places_count_characters_whatever_the_file_looks_like() {
    let wanted = [(2, 12, "E0101".to_owned()), (3, 7, "E0203".to_owned())];
    let program = |end: &str| format!("UNITS/ MM{end}GOTO/ 1, 2 3{end}GOTO/ P9{end}FINI{end}");
    assert_eq!(places(&program("\n")), wanted);
    assert_eq!(places(&program("\r\n")), wanted);
    assert_eq!(places(&program("\t\r\n")), wanted);
    assert_eq!(places(&format!("\u{feff}{}", program("\n"))), wanted);
    assert_eq!(places("GOTO/\t1,\t2\t3\n"), [(1, 12, "E0101".to_owned())]);
    assert_eq!(
        places("GOTO/ 1, \0 2, 3\nGOTO/ P9\n"),
        [(1, 10, "E0107".to_owned()), (2, 7, "E0203".to_owned()),]
    );
    let far = format!("GOTO/ 1, 2, 3{}4\n", " ".repeat(5000));
    assert_eq!(places(&far), [(1, 5014, "E0101".to_owned())]);
    assert_eq!(places("PARTNO é\nPPRINT Dréhen; x\nINCLUD/ 'é'\n"), [(3, 9, "E0230".to_owned())]);
}

/// A program that uses every stage.
const WHOLE: &str = "\
PARTNO robustness
UNITS/ MM
PARAM/ LIFT = 20mm, MIN, 5mm, MAX, 30mm, 'lift'
F1 = FOLLOW/ TRANSL, ROLLER, 8, OFFSET, 2
M1 = MOTION/ DWELL, 30, RISE, 120, LIFT, MODSIN, DWELL, 60, RETURN, 120, LIFT, CYCLO, DWELL, 30
C1 = CAM/ PLATE, BASE, 20, FOLLOW, F1, MOTION, M1, MAXPA, 45
T1 = CUTTER/ FLAT, 16, NUMBER, 1, FLUTES, 4
B1 = STOCK/ ROUND, 55, HEIGHT, 6
LOADTL/ T1
SPINDL/ 1200, CLW
FEDRAT/ 300
COOLNT/ FLOOD
INTOL/ 0.02
OUTTOL/ 0.02
CLEARP/ 5
H1 = MACRO/ A, B = 2
IF/ A > 1 AND B <> 3
GOTO/ 60, A, 10
ELSE
GODLTA/ 0, 0, B
ENDIF
TERMAC
RAPID
GOTO/ 60, 0, 20
DO/ I = 1, 3
CALL/ H1, A = I
ENDDO
P1 = PROFIL/ C1, CIRCUL, DEPTH, 5, STEP, 3
P2 = PROFIL/ C1, LINEAR, DEPTH, 5, DWELLS, EXACT
PPRINT done
FINI
";

/// Where a text may be cut: between words, numbers and marks.
fn pieces(text: &str) -> Vec<&str> {
    let kind = |c: char| if c.is_alphanumeric() || c == '.' { 0 } else { 1 + c as u32 };
    let mut found = Vec::new();
    let mut start = 0;
    let mut last = None;
    for (i, c) in text.char_indices() {
        if last.is_some_and(|l| l != kind(c)) {
            found.push(&text[start..i]);
            start = i;
        }
        last = Some(kind(c));
    }
    found.push(&text[start..]);
    found
}

/// The whole program with some pieces replaced, removed, doubled or swapped.
fn mutated(changes: &[(prop::sample::Index, u8, prop::sample::Index)]) -> String {
    const INSERTS: [&str; 14] =
        ["0", "-1", "1E9", "1E-9", "360", "mm", "deg", ",", "/", "(", ")", "\n", "(1, 2)", "C1"];
    let mut parts: Vec<&str> = pieces(WHOLE);
    for (at, kind, other) in changes {
        let (i, j) = (at.index(parts.len()), other.index(parts.len()));
        match kind % 5 {
            0 => drop(parts.remove(i)),
            1 => parts.insert(i, parts[j]),
            2 => parts[i] = parts[j],
            3 => parts[i] = INSERTS[other.index(INSERTS.len())],
            _ => parts.swap(i, j),
        }
    }
    parts.concat()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, ..ProptestConfig::default() })]

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

    #[test]
    fn damaged_programs_are_answered(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), any::<prop::sample::Index>()), 1..4)
    ) {
        let start = Instant::now();
        compile(&mutated(&changes));
        prop_assert!(start.elapsed() < PATIENCE, "took {:?}", start.elapsed());
    }
}

/// A job on a net of 4 by 4 poles, row by row.
fn net_job(poles: &[[f64; 3]; 16], operation: &str) -> String {
    let poles: Vec<String> = poles.iter().map(|[x, y, z]| format!("({x:?}, {y:?}, {z:?})")).collect();
    format!(
        "UNITS/ MM\nMACHIN/ LINUXCNC\nN1 = NET/ 4, 4, $\n{}\nT1 = CUTTER/ BALL, 6, NUMBER, 1\nLOADTL/ T1\nSPINDL/ 8000\n\
         FEDRAT/ 800\nINTOL/ 0\nOUTTOL/ 0.05\nCLEARP/ 90\nSURFAC/ N1, {operation}\nFINI\n",
        poles.join(", $\n")
    )
}

/// A gentle hill over 30 by 30 mm.
fn hill() -> [[f64; 3]; 16] {
    const X: [f64; 4] = [0.0, 10.0, 20.0, 30.0];
    const Z: [f64; 4] = [0.0, 4.0, 3.0, 0.0];
    core::array::from_fn(|k| [X[k / 4], X[k % 4], Z[k / 4] + Z[k % 4]])
}

#[test]
fn degenerate_nets_get_a_coded_answer() {
    let bent = |change: &dyn Fn(usize, [f64; 3]) -> [f64; 3]| {
        let net = hill();
        net_job(&core::array::from_fn(|k| change(k, net[k])), "U, STEP, 6")
    };
    for (what, text) in [
        ("an edge collapses", bent(&|k, [x, y, z]| [x, if k < 4 { 0.0 } else { y }, z])),
        ("a corner collapses", bent(&|k, p| if k < 2 { [0.0; 3] } else { p })),
        ("all poles are one", bent(&|_, _| [5.0; 3])),
        ("all poles lie on a line", bent(&|_, [x, _, _]| [x, 0.0, 0.0])),
        ("columns change places", bent(&|k, _| hill()[k ^ 1])),
        ("the surface stands upright", bent(&|_, [x, y, _]| [0.0, y, x])),
    ] {
        assert_eq!(first_code(&text), "E0542", "{what}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, ..ProptestConfig::default() })]

    /// Nets of any shape are refused with a code, or cut without a number that is none.
    #[test]
    fn any_net_is_refused_or_proven(moves in proptest::collection::vec(-9.0..9.0f64, 48)) {
        let net = hill();
        let poles: [[f64; 3]; 16] =
            core::array::from_fn(|k| core::array::from_fn(|i| net[k][i] + moves[3 * k + i]));
        let build = compile(&net_job(&poles, "X, STEP, 8"));
        match build.outputs.first().and_then(|o| o.proven.as_ref()) {
            Some(proven) => {
                let text = proven.text().to_ascii_lowercase();
                prop_assert!(!text.contains("nan") && !text.contains("inf"), "{text}");
                prop_assert!(!build.has_errors());
            }
            None => prop_assert!(build.has_errors()),
        }
    }
}
