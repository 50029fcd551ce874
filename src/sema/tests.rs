use proptest::prelude::*;

use super::*;
use crate::source::MemoryFiles;

/// The codes of a program with line and column, in source order, and its IR as text.
pub(super) fn run(text: &str) -> (Vec<String>, Option<String>) {
    run_with(text, &MemoryFiles::default(), &[])
}

pub(super) fn run_with(
    text: &str,
    files: &MemoryFiles,
    defines: &[(&str, &str)],
) -> (Vec<String>, Option<String>) {
    let mut sources = SourceMap::default();
    let main = sources.add("main.apt", text);
    let mut sink = Sink::default();
    let defines = defines.iter().map(|(n, v)| ((*n).to_owned(), (*v).to_owned())).collect();
    let program = analyse(main, &mut sources, files, &Options { defines, ..Options::default() }, &mut sink);
    let items = sink.into_items();
    let codes = items.iter().map(|d| match &d.primary {
        Some(p) => {
            let file = sources.file(p.span.file);
            let (line, column) = file.line_column(p.span.start);
            format!("{}:{line}:{column} {} {} {:?}", file.name, d.code.id, d.message, d.help)
        }
        None => format!("{} {} {:?}", d.code.id, d.message, d.help),
    });
    (codes.collect(), program.map(|p| crate::ir::print::print(&p, &sources)))
}

const PAPER: &str = "PARTNO PLATE CAM
UNITS/ MM
MACHIN/ LINUXCNC, ROTABL, C
F1 = FOLLOW/ TRANSL, ROLLER, 8
M1 = MOTION/ DWELL, 30, RISE, 120, 20, MODSIN, DWELL, 60, RETURN, 120, 20, MODSIN, DWELL, 30
C1 = CAM/ PLATE, BASE, 20, FOLLOW, F1, MOTION, M1
B1 = STOCK/ ROUND, 42, HEIGHT, 12
T1 = CUTTER/ FLAT, 16, NUMBER, 1, FLUTES, 4
LOADTL/ T1
SPINDL/ 1200, CLW
FEDRAT/ 300, MMPM
COOLNT/ FLOOD
INTOL/ 0.01
OUTTOL/ 0.01
ROUGH/ C1, STOCK, B1, STEP, 2, LEAVE, 0.3
OP1 = PROFIL/ C1, CIRCUL, CLIMB, DEPTH, 10
FINI
";

#[test]
fn the_papers_cam_comes_through() {
    let (codes, ir) = run(PAPER);
    assert_eq!(codes, Vec::<String>::new());
    insta::assert_snapshot!(ir.unwrap_or_default());
}

#[test]
fn an_infinite_loop_ends_with_a_message() {
    let (codes, _) = run("WHILE/ 1 < 2\nX = 1\nENDWHILE\n");
    assert!(codes.len() == 1 && codes[0].contains(":1:1 E0226"), "{codes:?}");
}

#[test]
fn definitions_of_the_command_line_set_parameters() {
    let text = "PARAM/ STROKE = 20mm, MIN, 5mm, MAX, 40mm\nFROM/ STROKE, 0, 0\n";
    let none = MemoryFiles::default();
    let (codes, ir) = run_with(text, &none, &[("stroke", "25mm")]);
    assert_eq!(codes, Vec::<String>::new());
    assert!(ir.unwrap_or_default().contains("from (25, 0, 0)"));
    let (_, ir) = run_with(text, &none, &[("STROKE", "1in")]);
    assert!(ir.unwrap_or_default().contains("from (25.4, 0, 0)"));
    for (value, code) in
        [("50mm", "E0233"), ("3deg", "E0232"), ("abc", "E0232"), ("", "E0232"), ("1;2", "E0232")]
    {
        let (codes, _) = run_with(text, &none, &[("STROKE", value)]);
        assert!(codes.len() == 1 && codes[0].starts_with(code), "{value}: {codes:?}");
    }
    let (codes, _) = run_with(text, &none, &[("STROK", "5mm")]);
    assert!(codes[0].contains("did you mean `STROKE`"), "{codes:?}");
}

/// The same program in a unit: `lengths` are thousandths of an inch.
fn program_in(unit: &str, lengths: &[i32]) -> String {
    let bare = |k: usize| {
        let thousandths = f64::from(lengths[k]);
        if unit == "INCH" {
            format!("{}", thousandths / 1000.0)
        } else {
            format!("{:.4}", thousandths * 0.0254)
        }
    };
    format!(
        "UNITS/ {unit}\nP1 = POINT/ {}, {}\nP2 = P1 + ({}, {})\nK1 = CIRCLE/ CENTER, P2, RADIUS, {}\n\
         T1 = CUTTER/ {}\nLOADTL/ T1\nSPINDL/ 1000\nFEDRAT/ {}\nGOTO/ P2\nGODLTA/ {}, 10mm, K1.RADIUS * 2\nTHICK/ {}\n\
         PROFIL/ K1, DEPTH, {}\n",
        bare(0),
        bare(1),
        bare(2),
        bare(3),
        bare(4),
        bare(5),
        bare(6),
        bare(7),
        bare(8),
        bare(9)
    )
}

/// The IR without its unit and places, numbers to twelve digits.
fn comparable(text: &str) -> String {
    let ir = run(text).1.unwrap_or_default();
    let lines = ir.lines().filter(|l| !l.starts_with("units"));
    let words = lines.flat_map(|l| l.split([' ', '(', ')', ',']));
    words
        .map(|w| w.parse::<f64>().map_or_else(|_| w.to_owned(), |x| format!("{x:.9}")))
        .collect::<Vec<_>>()
        .join(" ")
}

/// A sum of products in the language, and its value.
fn any_sum() -> impl Strategy<Value = (String, f64)> {
    let number = (-2000i32..2000).prop_map(|n| (format!("({})", f64::from(n) / 16.0), f64::from(n) / 16.0));
    number.prop_recursive(4, 32, 2, |inner| {
        (inner.clone(), inner, 0..4u8).prop_map(|((a, x), (b, y), op)| match op {
            0 => (format!("{a} + {b}"), x + y),
            1 => (format!("{a} - ({b})"), x - y),
            2 => (format!("({a}) * ({b})"), x * y),
            _ => (format!("MAX({a}, {b})"), x.max(y)),
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn the_same_program_in_another_unit_is_the_same(lengths in prop::collection::vec(1i32..4000, 10)) {
        let (inch, mm) = (comparable(&program_in("INCH", &lengths)), comparable(&program_in("MM", &lengths)));
        prop_assert!(inch.contains("goto"));
        prop_assert_eq!(inch, mm);
    }

    #[test]
    fn expressions_have_their_value((text, value) in any_sum()) {
        let (codes, ir) = run(&format!("X = {text}\nFROM/ X * 1mm, 0, 0\n"));
        prop_assert_eq!(codes, Vec::<String>::new());
        let ir = ir.unwrap_or_default();
        let printed = ir.split("from (").nth(1).and_then(|t| t.split(',').next()).unwrap_or("");
        let got: f64 = printed.parse().unwrap_or(f64::NAN);
        prop_assert!((got - value).abs() <= 1e-12 * value.abs().max(1.0), "{} gave {}, not {}", text, got, value);
    }

    #[test]
    fn any_arguments_give_an_answer(
        word in prop::sample::select(crate::vocab::major_words().collect::<Vec<_>>()),
        arguments in prop::collection::vec(
            prop::sample::select(vec![
                "1", "-2", "3deg", "4mm", "P1", "K1", "(1, 2)", "'t'", "NOSUCH", "CENTER", "RADIUS", "ROLLER", "TRANSL",
                "RISE", "MODSIN", "POLY", "BASE", "X = 3", "(POINT/ 1, 2)", "CLW", "SQRT(2)", "1mm/s", "PLATE", "DEPTH",
            ]),
            0..6,
        ),
    ) {
        let text = format!("P1 = POINT/ 1, 2\nK1 = CIRCLE/ 1, 2, 3\nQ1 = {word}/ {}\n", arguments.join(", "));
        run(&text);
    }
}
