//! The unit of a CL file.

use super::Options;
use super::lines::Lines;
use crate::units::LengthUnit;

/// Lines of a file that are searched for its unit.
const LOOK: usize = 200_000;

/// Words of records that tell a unit.
const TELLING: [&str; 4] = ["UNIT", "FEDRAT", "CYCLE", "$$->"];

/// The unit: as given, else as the first record with a unit says; `None` where none does.
pub(super) fn stated(text: &str, options: &Options) -> Option<LengthUnit> {
    let given = options.defines.iter().find(|(name, _)| name.eq_ignore_ascii_case("UNITS"));
    if let Some((_, value)) = given {
        return Some(of_word(value).unwrap_or_default());
    }
    let mut lines = Lines::of_cards(text, options.card_columns);
    core::iter::from_fn(|| lines.line()).take(LOOK).find_map(|(line, _)| of_record(line))
}

/// The unit called so.
pub(super) fn of_word(word: &str) -> Option<LengthUnit> {
    let word = word.trim().to_uppercase();
    if word.starts_with("MM") || word.starts_with("MILLI") {
        Some(LengthUnit::Millimetre)
    } else {
        word.starts_with("IN").then_some(LengthUnit::Inch)
    }
}

fn of_record(line: &str) -> Option<LengthUnit> {
    let record = super::lines::without_number(line.trim_start());
    let starts = |w: &&str| record.get(..w.len()).is_some_and(|head| head.eq_ignore_ascii_case(w));
    let word = TELLING.iter().find(|w| starts(w))?;
    if *word == "UNIT" {
        return of_word(record.split_once('/')?.1);
    }
    let upper = record.to_uppercase();
    let has = |words: [&str; 2]| words.iter().any(|w| upper.contains(w));
    if has(["MMPM", "MMPR"]) {
        Some(LengthUnit::Millimetre)
    } else {
        has(["IPM", "IPR"]).then_some(LengthUnit::Inch)
    }
}
