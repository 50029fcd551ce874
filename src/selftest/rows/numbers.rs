//! Spelling of numbers.

use super::super::judge::Finding;
use super::super::sheet::Sheet;
use super::super::trial::Trial;
use super::{Try, row};

pub(in super::super) const ZERO: Try = row(
    "numbers",
    "-0.00004 and zero",
    || Sheet::mm().line(10.0, 10.0, 5.0).line(-0.00004, -0.00004, 5.0).watch_from(5),
    zero,
);
pub(in super::super) const POINT: Try = Try {
    whole: true,
    ..row("numbers", "integers of tool, spindle and codes", || Sheet::mm().line(5.0, 7.25, 5.0), point)
};
pub(in super::super) const EXPONENT: Try =
    row("numbers", "0.001 and 1234.567", || Sheet::mm().line(0.001, 1234.567, 5.0), exponent);
pub(in super::super) const LARGE: Try = row(
    "numbers",
    "a coordinate of 10 km",
    || Sheet::mm().line(10_000_000.0, 0.0, 5.0),
    |_| Finding::right("fits the control's words"),
);

/// Words of the lines: letters with the number that follows, outside comments.
fn words(lines: &[String]) -> Vec<String> {
    let mut found = Vec::new();
    for line in lines {
        let mut word = String::new();
        let mut comment = false;
        for c in line.chars().chain([' ']) {
            match c {
                '(' => comment = true,
                ')' => comment = false,
                ';' => break,
                _ if comment => {}
                c if c.is_ascii_digit() || ".+-=".contains(c) => word.push(c),
                c if c.is_ascii_alphabetic() => {
                    // A letter between digits belongs to the number: an exponent.
                    if !(matches!(c, 'E' | 'e') && word.ends_with(|d: char| d.is_ascii_digit())) {
                        found.push(core::mem::take(&mut word));
                    }
                    word.push(c);
                }
                _ => found.push(core::mem::take(&mut word)),
            }
        }
        found.push(word);
    }
    found.retain(|w| w.len() > 1 && w.ends_with(|c: char| c.is_ascii_digit() || c == '.'));
    found
}

fn zero(trial: &Trial) -> Finding {
    let bad = words(&trial.lines()).into_iter().find(|w| {
        let number = w.trim_start_matches(|c: char| c.is_ascii_alphabetic() || c == '=');
        number.strip_prefix('-').is_some_and(|n| n.chars().all(|c| "0.".contains(c)))
    });
    match bad {
        Some(word) => Finding::wrong(format!("prints `{word}`")).by_spelling(),
        None => Finding::right("no negative zero").by_spelling(),
    }
}

fn point(trial: &Trial) -> Finding {
    let integer = |w: &&String| w.starts_with(['T', 'H', 'D', 'M', 'S', 'N', 'O']) && w.contains('.');
    let words = words(&trial.text);
    match words.iter().find(integer) {
        Some(word) => Finding::wrong(format!("an integer carries a point: `{word}`")).by_spelling(),
        None => Finding::right("integers carry no point").by_spelling(),
    }
}

fn exponent(trial: &Trial) -> Finding {
    let bad = words(&trial.lines()).into_iter().find(|w| {
        let number = w.get(1..).unwrap_or_default();
        number.contains(['E', 'e'])
    });
    match bad {
        Some(word) => Finding::wrong(format!("prints an exponent: `{word}`")).by_spelling(),
        None => Finding::right("no exponent").by_spelling(),
    }
}
