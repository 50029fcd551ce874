//! The bulk scanner against the grammar.

use proptest::prelude::*;

use crate::clfile::grammar::{self, Arg};
use crate::clfile::scan;

/// What the grammar makes of a line, if it is a `GOTO` with three or six numbers.
fn by_grammar(line: &str) -> Option<Vec<f64>> {
    let statement = grammar::parse(line.trim()).ok()?;
    if statement.major() != "GOTO" || statement.majors.len() != 1 {
        return None;
    }
    let numbers: Vec<f64> = statement
        .args
        .iter()
        .map(|a| if let Arg::Number(v) = a { Some(*v) } else { None })
        .collect::<Option<_>>()?;
    matches!(numbers.len(), 3 | 6).then_some(numbers)
}

fn by_scanner(line: &str) -> Option<Vec<f64>> {
    scan::goto(line.as_bytes()).map(|g| g.values[..g.count].to_vec())
}

fn spelled() -> impl Strategy<Value = String> {
    let digits = "[0-9]{1,12}";
    prop_oneof![
        (prop_oneof![Just(""), Just("-"), Just("+")], digits, "[0-9]{0,9}")
            .prop_map(|(s, a, b)| format!("{s}{a}.{b}")),
        (prop_oneof![Just(""), Just("-")], digits).prop_map(|(s, a)| format!("{s}{a}")),
        (prop_oneof![Just(""), Just("-")], "[0-9]{1,9}").prop_map(|(s, b)| format!("{s}.{b}")),
        ("[0-9]{1,3}", "[0-9]{1,6}", "-?[0-9]").prop_map(|(a, b, e)| format!("{a}.{b}E{e}")),
        "[0-9A-Z.+-]{0,6}",
    ]
}

proptest! {
    #[test]
    fn scanner_and_grammar_read_the_same_points(
        word in prop_oneof![Just("GOTO/"), Just("goto /"), Just("  GOTO / "), Just("GOTO"), Just("GODLTA/")],
        values in prop::collection::vec(spelled(), 1..8),
        gap in prop_oneof![Just(","), Just(", "), Just(" ,"), Just(",,")],
        end in prop_oneof![Just(""), Just(" "), Just(","), Just(" $")],
    ) {
        let line = format!("{word}{}{end}", values.join(gap));
        if let Some(scanned) = by_scanner(&line) {
            prop_assert_eq!(Some(scanned), by_grammar(&line), "{}", line);
        } else {
            // What the scanner leaves is read by the grammar or refused by it; nothing is lost.
            prop_assert!(by_grammar(&line).is_none(), "{}", line);
        }
    }

    #[test]
    fn numbers_between_blanks_are_read_as_between_commas(
        values in prop::collection::vec(spelled().prop_filter("a number", |v| scan::number(v).is_some()), 1..8),
        gaps in prop::collection::vec(prop_oneof![Just(" "), Just("   "), Just("\t"), Just(" , "), Just(",")], 8),
    ) {
        let line: String = values.iter().zip(&gaps).map(|(value, gap)| format!("{gap}{value}")).collect();
        let line = format!("FROM/ {}", line.trim_start_matches([' ', '\t', ',']));
        let read = grammar::parse(&line).map(|statement| statement.args);
        let numbers: Vec<Arg> = values.iter().filter_map(|v| scan::number(v).map(Arg::Number)).collect();
        prop_assert_eq!(read, Ok(numbers), "{}", line);
    }

    #[test]
    fn numbers_are_rounded_as_the_standard_library_rounds(text in "-?[0-9]{1,20}(\\.[0-9]{0,20})?") {
        let read = scan::number(&text);
        let exact: f64 = text.parse().unwrap();
        prop_assert_eq!(read.map(f64::to_bits), Some(exact.to_bits()));
    }

    #[test]
    fn any_text_is_read_without_panic(text in "(?s).{0,200}") {
        let _ = super::read(&text);
        let _ = super::read_as(&text, Some(crate::clfile::Producer::Mastercam), true);
    }
}
