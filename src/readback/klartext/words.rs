//! Cutting a Klartext block into words: letters with signed numbers, names, cycle parameters.

use super::spline::coefficient;
use crate::readback::number::number;

/// One word of a block.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Word {
    /// An address with its number: `X+12.5`, `IZ-1`, `DR+` has no number and is [`Word::Name`].
    Address(String, f64),
    /// A word without a number: `L`, `FMAX`, `R0`, `DR-`.
    Name(String),
    /// `Q200=+2`.
    Parameter(u32, f64),
    /// `"text"`.
    Quoted(String),
}

/// Addresses of motion blocks, longest first.
const ADDRESSES: [&str; 21] = [
    "IPA", "IPR", "PA", "PR", "IX", "IY", "IZ", "IA", "IB", "IC", "MB", "X", "Y", "Z", "A", "B", "C", "F",
    "S", "M", "R",
];

/// The words of a block without its number and comment; complaints go to `fault`.
pub(super) fn words(text: &str, fault: &mut dyn FnMut(String)) -> Vec<Word> {
    let mut words = Vec::new();
    let mut rest = text.trim_start();
    while !rest.is_empty() {
        if let Some(body) = rest.strip_prefix('"') {
            let Some((name, after)) = body.split_once('"') else {
                fault("a name that is not closed by a quotation mark".to_owned());
                break;
            };
            words.push(Word::Quoted(name.to_owned()));
            rest = after.trim_start();
            continue;
        }
        let end = rest.find(char::is_whitespace).unwrap_or(rest.len());
        let (token, after) = rest.split_at(end);
        rest = after.trim_start();
        if let Some(name) = token.get(..3).filter(|name| is_coefficient(name)) {
            // The exponent may stand behind a blank.
            let end = rest.find(char::is_whitespace).unwrap_or(rest.len());
            let (next, after) = rest.split_at(end);
            let more = next.strip_prefix('E').filter(|e| !e.is_empty());
            if more.is_some() {
                rest = after.trim_start();
            }
            match coefficient(token.get(3..).unwrap_or_default(), more, value_of) {
                Ok(value) => words.push(Word::Address(name.to_owned(), value)),
                Err(complaint) => fault(format!("{name}: {complaint}")),
            }
            continue;
        }
        // `Q206= 150` and `Q206 = 150` are one word.
        if token.starts_with('Q') && token.ends_with('=') {
            let end = rest.find(char::is_whitespace).unwrap_or(rest.len());
            let (value, after) = rest.split_at(end);
            words.push(word(&format!("{token}{value}"), fault));
            rest = after.trim_start();
        } else {
            words.push(word(token, fault));
        }
    }
    words
}

/// `K3X` and the like.
fn is_coefficient(name: &str) -> bool {
    matches!(name.as_bytes(), [b'K', b'1'..=b'3', b'A'..=b'C' | b'U'..=b'Z'])
}

fn word(token: &str, fault: &mut dyn FnMut(String)) -> Word {
    if let Some((name, value)) = token.strip_prefix('Q').and_then(|t| t.split_once('=')) {
        return match (name.parse(), value_of(value)) {
            (Ok(index), Some(value)) => Word::Parameter(index, value),
            _ => {
                fault(format!("{token} is no parameter with a number"));
                Word::Name(token.to_owned())
            }
        };
    }
    for address in ADDRESSES {
        if let Some(value) = token.strip_prefix(address).and_then(value_of) {
            return Word::Address(address.to_owned(), value);
        }
    }
    Word::Name(token.to_owned())
}

/// A whole decimal number.
pub(super) fn value_of(text: &str) -> Option<f64> {
    let bytes = text.as_bytes();
    let (read, end) = number(bytes, 0).ok()?;
    (end == bytes.len() && !text.contains(char::is_whitespace)).then_some(read.value)
}
