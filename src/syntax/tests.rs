//! What files cannot hold well: other line ends, byte order marks, control characters; and spans.

use super::ast::{Program, StatementKind};
use super::print::print;
use crate::diag::Sink;
use crate::source::SourceMap;

fn parse(text: &str) -> (Program, String, Vec<(&'static str, u32)>) {
    let mut sources = SourceMap::default();
    let file = sources.add("a.apt", text);
    let mut sink = Sink::default();
    let program = super::parse(file, text, &mut sink);
    let printed = print(&program, &sources);
    let codes = sink.items().iter().map(|d| (d.code.id, d.primary.as_ref().map_or(0, |p| p.span.start)));
    (program, printed, codes.collect())
}

#[test]
fn line_ends_of_dos_and_a_byte_order_mark_make_no_difference() {
    let unix = "PARTNO a b\nGOTO/ 1,\n 2, $\n 3 $$ up\nA = (1\n + 2)\n";
    let dos = format!("\u{feff}{}", unix.replace('\n', "\r\n"));
    let (expected, found) = (parse(unix), parse(&dos));
    assert_eq!(found.2, []);
    let without_columns =
        |s: &str| s.lines().map(|l| l.split_once(' ').map(|p| p.1.to_owned())).collect::<Vec<_>>();
    assert_eq!(without_columns(&found.1), without_columns(&expected.1));
}

#[test]
fn control_characters_are_found_everywhere() {
    assert_eq!(parse("A = 1\u{0} + 2\n").2, [("E0107", 5)]);
    assert_eq!(parse("$$ a comment\u{7}\n").2, [("E0107", 12)]);
    assert_eq!(parse("PPRINT te\u{1b}xt\n").2, [("E0107", 9)]);
    assert_eq!(parse("A = 'te\u{1}xt'\n").2, [("E0107", 7)]);
    assert_eq!(parse("A = 1\rB = 2\n").2, [("E0107", 5)]);
    assert_eq!(parse("A\t=\t1\n").2, []);
}

#[test]
fn spans_of_a_continued_statement_point_into_the_file() {
    let text = "P1 = POINT/ 1, $\n   (2 + 3), 4\n";
    let (program, _, codes) = parse(text);
    assert_eq!(codes, []);
    let Some(StatementKind::Command(command)) = program.statements.first().map(|s| &s.kind) else {
        panic!("not a command: {program:?}");
    };
    let texts: Vec<_> = command.args.iter().filter_map(|a| text.get(a.span.range())).collect();
    assert_eq!(texts, ["1", "(2 + 3)", "4"]);
}

#[test]
fn a_broken_statement_still_tells_what_it_would_declare() {
    let declared = |text: &str| match parse(text).0.statements.first().map(|s| s.kind.clone()) {
        Some(StatementKind::Bad { declares }) => declares.map(|n| n.text),
        other => panic!("{other:?}"),
    };
    assert_eq!(declared("P1 = POINT/ 1 2\n").as_deref(), Some("P1"));
    assert_eq!(declared("LA1) P(3) = POINT/ 1 2\n").as_deref(), Some("P"));
    assert_eq!(declared("M = MACRO/ 3\n").as_deref(), Some("M"));
    assert_eq!(declared("GOTO/ 1 2\n"), None);
}

#[test]
fn many_statements_parse_as_few_do() {
    let one = "A = 1 + 2 * 3\nGOTO/ 1, 2, (4\n";
    let (program, _, codes) = parse(&one.repeat(20));
    assert_eq!((program.statements.len(), codes.len()), (40, 20));
    let good = "A = 1 + 2 * 3\n".repeat(9000);
    let (program, _, codes) = parse(&good);
    assert_eq!((program.statements.len(), codes.len()), (9000, 0));
    assert!(program.statements.windows(2).all(|w| matches!(w, [a, b] if a.span.end < b.span.start)));
}

#[test]
fn too_many_mistakes_end_the_file() {
    let (_, _, codes) = parse(&"GOTO/ 1 2\n".repeat(100_000));
    assert_eq!(codes.len(), super::limits::ERRORS);
}
