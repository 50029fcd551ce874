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
    let program = analyse(main, &mut sources, files, &Options { defines }, &mut sink);
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
fn scratch() {
    let Ok(path) = std::env::var("SCRATCH") else { return };
    let text = std::fs::read_to_string(path).unwrap();
    let (codes, ir) = run(&text);
    println!("{}\n{}", codes.join("\n"), ir.unwrap_or_default());
}
