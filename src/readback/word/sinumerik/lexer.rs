//! Cutting a SINUMERIK block into words: addresses with numbers, addresses with `=`, names, calls, comments.

use super::super::block::{Block, bit};
use super::super::rules::Rules;
use super::{Call, Words, keyword};
use crate::readback::number::{Number, number};

/// Most arguments of a call.
const MOST_ARGUMENTS: usize = 40;

/// Where the lexer stands.
struct Lexer<'l, 'f> {
    line: &'l [u8],
    at: usize,
    fault: &'f mut dyn FnMut(String),
}

/// Cuts `line` into the words of `block`; complaints go to `fault`.
pub(in crate::readback::word) fn read(
    line: &[u8],
    rules: &Rules,
    block: &mut Block,
    fault: &mut dyn FnMut(String),
) {
    block.clear();
    block.length = line.len();
    let trimmed = line.trim_ascii_start();
    if trimmed.starts_with(b"%_N_") || trimmed.starts_with(b"%MPF") {
        block.name = true;
        return;
    }
    let mut lexer = Lexer { line, at: 0, fault };
    while let Some(&c) = lexer.line.get(lexer.at) {
        match c {
            b' ' | b'\t' => lexer.at += 1,
            b';' => {
                lexer.comment(rules);
                return;
            }
            b'/' if block.is_empty() && !block.optional => {
                block.optional = true;
                lexer.at += 1;
            }
            b'A'..=b'Z' | b'a'..=b'z' | b'$' | b'_' => lexer.word(rules, block),
            _ => {
                let shown = if c.is_ascii_graphic() {
                    format!("'{}'", char::from(c))
                } else {
                    format!("byte 0x{c:02X}")
                };
                (lexer.fault)(format!("bad character {shown} in column {}", lexer.at + 1));
                lexer.at += 1;
            }
        }
    }
}

impl Lexer<'_, '_> {
    fn peek(&self) -> Option<u8> {
        self.line.get(self.at).copied()
    }

    fn skip_blanks(&mut self) {
        while matches!(self.peek(), Some(b' ' | b'\t')) {
            self.at += 1;
        }
    }

    fn eat(&mut self, wanted: u8) -> bool {
        self.skip_blanks();
        let there = self.peek() == Some(wanted);
        self.at += usize::from(there);
        there
    }

    fn comment(&mut self, rules: &Rules) {
        let body = self.line.get(self.at + 1..).unwrap_or_default();
        if let Some(&c) = body.iter().find(|&&c| !(rules.comment_character)(c)) {
            (self.fault)(format!("{} byte 0x{c:02X} in a comment", rules.comment_complaint));
        }
    }

    /// A word that starts with a letter.
    fn word(&mut self, rules: &Rules, block: &mut Block) {
        let start = self.at;
        let letters =
            self.line.get(start..).unwrap_or_default().iter().take_while(|c| c.is_ascii_alphabetic()).count();
        let first = self.line.get(start).copied().unwrap_or_default().to_ascii_uppercase();
        let next = self.line.get(start + 1).copied();
        let address =
            letters == 1 && matches!(next, Some(b'0'..=b'9' | b'+' | b'-' | b'.' | b'=' | b' ' | b'\t'));
        if let Some(axis) = b"IJK".iter().position(|l| *l == first).filter(|_| letters == 1)
            && self.assigns_place()
        {
            return self.place_between(axis, block);
        }
        if address {
            self.at += 1;
            return self.address(first, rules, block);
        }
        let name = self.name();
        self.named(&name, rules, block);
    }

    /// Whether a letter is followed by `1=`.
    fn assigns_place(&self) -> bool {
        let rest = self.line.get(self.at + 1..).unwrap_or_default();
        rest.strip_prefix(b"1").is_some_and(|rest| rest.trim_ascii_start().starts_with(b"="))
    }

    /// `I1=5`, `J1=AC(5)`, `K1=IC(5)`.
    fn place_between(&mut self, axis: usize, block: &mut Block) {
        let name = format!("{}1=", char::from(b"IJK"[axis]));
        self.at += 2;
        self.eat(b'=');
        let mode = self.coordinate_mode();
        let Some(value) = self.number() else {
            (self.fault)(format!("{name} is not followed by a number this reader can follow"));
            self.at = self.line.len();
            return;
        };
        if mode.is_some() && !self.eat(b')') {
            (self.fault)(format!("the bracket of {name} is not closed"));
        }
        if block.words().between[axis].replace((value.value, mode)).is_some() {
            (self.fault)(format!("multiple {name} words in one block"));
        }
    }

    fn name(&mut self) -> String {
        let start = self.at;
        while self.peek().is_some_and(|c| c.is_ascii_alphanumeric() || matches!(c, b'_' | b'$')) {
            self.at += 1;
        }
        String::from_utf8_lossy(self.line.get(start..self.at).unwrap_or_default()).to_ascii_uppercase()
    }

    /// A number, with `EX` for the power of ten.
    fn number(&mut self) -> Option<Number> {
        self.skip_blanks();
        let (mut read, end) = number(self.line, self.at).ok()?;
        self.at = end;
        let rest = self.line.get(end..).unwrap_or_default();
        if rest.get(..2).is_some_and(|e| e.eq_ignore_ascii_case(b"EX"))
            && let Ok((power, end)) = number(self.line, end + 2)
        {
            read.value *= crate::math::pow(10.0, power.value.clamp(-300.0, 300.0));
            self.at = end;
        }
        Some(read)
    }

    fn address(&mut self, letter: u8, rules: &Rules, block: &mut Block) {
        let name = char::from(letter);
        if letter == b'R' {
            (self.fault)("an R parameter, which this reader does not follow".to_owned());
        }
        let equals = self.eat(b'=');
        if equals && letter == b'T' && self.peek() == Some(b'"') {
            return self.tool_name(block);
        }
        if equals && self.rest_starts(b"PO(") {
            self.at += b"PO(".len();
            return self.powers(Some(letter), rules, block);
        }
        let mode = if equals { self.coordinate_mode() } else { None };
        let Some(value) = self.number() else {
            (self.fault)(format!(
                "{name} in column {} is not followed by a number this reader can follow",
                self.at + 1
            ));
            self.at = self.line.len();
            return;
        };
        if let Some(absolute) = mode {
            if !self.eat(b')') {
                (self.fault)(format!("the bracket of {name} is not closed"));
            }
            let words = block.words();
            let mask = if absolute { &mut words.absolute } else { &mut words.incremental };
            *mask |= bit(letter);
        }
        super::super::block::store(letter, value, rules, block, self.fault);
    }

    /// `AC(` and `IC(`, and the ways round of a rotary axis; `Some(true)` for absolute.
    fn coordinate_mode(&mut self) -> Option<bool> {
        self.skip_blanks();
        let rest = self.line.get(self.at..).unwrap_or_default();
        for (name, absolute) in [("AC(", true), ("IC(", false), ("DC(", true), ("ACP(", true), ("ACN(", true)]
        {
            if rest.get(..name.len()).is_some_and(|start| start.eq_ignore_ascii_case(name.as_bytes())) {
                self.at += name.len();
                return Some(absolute);
            }
        }
        None
    }

    fn tool_name(&mut self, block: &mut Block) {
        let body = self.line.get(self.at + 1..).unwrap_or_default();
        let Some(end) = body.iter().position(|&c| c == b'"') else {
            (self.fault)("the name of the tool is not closed by a quotation mark".to_owned());
            self.at = self.line.len();
            return;
        };
        let name = String::from_utf8_lossy(body.get(..end).unwrap_or_default()).into_owned();
        self.at += end + 2;
        if block.has(b'T') || block.words().tool.is_some() {
            (self.fault)("multiple T words in one block".to_owned());
        }
        block.words().tool = Some(name);
    }

    /// Keywords, words of more than one letter and calls.
    fn named(&mut self, name: &str, rules: &Rules, block: &mut Block) {
        match name {
            "CR" if self.eat(b'=') => self.assigned(b'R', rules, block),
            "TURN" if self.eat(b'=') => {
                let turns = self.number().map(|n| n.value);
                block.words().turns = turns;
            }
            "CTOL" | "ADIS" | "ADISPOS" if self.eat(b'=') => {
                let value = self.number().map(|n| n.value);
                block.words().tolerance = value;
            }
            "SD" | "PW" | "PL" if self.eat(b'=') => {
                let value = self.number().map(|n| n.value);
                if value.is_none() {
                    (self.fault)(format!("{name} without its number"));
                }
                let words = block.words();
                match name {
                    "SD" => words.degree = value,
                    "PW" => words.weight = value,
                    _ => words.interval = value,
                }
            }
            "PO" if self.eat(b'[') => self.polynomial(rules, block),
            "MCALL" => {
                block.words().modal_call = true;
            }
            "MSG" => self.message(),
            _ if self.eat(b'(') => self.call(name, block),
            _ => match keyword(name) {
                Some(code) => block.push_g(code, self.fault),
                None => {
                    (self.fault)(format!("unknown word {name}"));
                    self.skip_value();
                }
            },
        }
    }

    fn rest_starts(&mut self, name: &[u8]) -> bool {
        self.skip_blanks();
        let rest = self.line.get(self.at..).unwrap_or_default();
        rest.get(..name.len()).is_some_and(|start| start.eq_ignore_ascii_case(name))
    }

    /// `X]=(…)` after `PO[`; without an axis it is the denominator.
    fn polynomial(&mut self, rules: &Rules, block: &mut Block) {
        self.skip_blanks();
        let letter = self.peek().map(|c| c.to_ascii_uppercase()).filter(u8::is_ascii_uppercase);
        self.at += usize::from(letter.is_some());
        if !(self.eat(b']') && self.eat(b'=') && self.eat(b'(')) {
            (self.fault)(format!("PO in column {} is not PO[axis]=(end, coefficients)", self.at + 1));
            self.at = self.line.len();
            return;
        }
        self.powers(letter, rules, block);
    }

    /// End and coefficients up to the bracket; the end is the axis's word.
    fn powers(&mut self, letter: Option<u8>, rules: &Rules, block: &mut Block) {
        let mut given = Vec::new();
        loop {
            let Some(value) = self.number() else {
                (self.fault)(format!("a coefficient of PO in column {} is no number", self.at + 1));
                self.at = self.line.len();
                return;
            };
            given.push(value);
            if !self.eat(b',') {
                break;
            }
        }
        if !self.eat(b')') {
            (self.fault)("the bracket of PO is not closed".to_owned());
        }
        if given.len() > super::poly::DEGREE {
            (self.fault)(format!("PO of {} numbers: polynomials go to the fifth degree", given.len()));
            given.truncate(super::poly::DEGREE);
        }
        let values = |of: &[Number]| of.iter().map(|n| n.value).collect();
        let place = letter.and_then(|l| b"XYZ".iter().position(|a| *a == l));
        match (letter, place, given.split_first()) {
            (Some(letter), Some(axis), Some((end, rest))) => {
                super::super::block::store(letter, *end, rules, block, self.fault);
                let told = block.words().polynomials.get_or_insert_default();
                told.axes[axis] = Some(values(rest));
            }
            (None, ..) => {
                let told = block.words().polynomials.get_or_insert_default();
                if told.denominator.replace(values(&given)).is_some() {
                    (self.fault)("two denominators PO[] in one block".to_owned());
                }
            }
            _ => (self.fault)("PO of an axis that this reader does not follow".to_owned()),
        }
    }

    fn assigned(&mut self, letter: u8, rules: &Rules, block: &mut Block) {
        match self.number() {
            Some(value) => super::super::block::store(letter, value, rules, block, self.fault),
            None => (self.fault)(format!("no number in column {}", self.at + 1)),
        }
    }

    /// Passes over `[…]`, `=` and what follows of a word that is not known.
    fn skip_value(&mut self) {
        while self.peek().is_some_and(|c| !matches!(c, b' ' | b'\t' | b';')) {
            self.at += 1;
        }
    }

    /// `MSG("text")`, which is shown and does nothing.
    fn message(&mut self) {
        let rest = self.line.get(self.at..).unwrap_or_default();
        let body = rest.trim_ascii_start();
        let closed = body.starts_with(b"(\"") && body.iter().rposition(|&c| c == b')').is_some();
        let quotes = body.iter().filter(|&&c| c == b'"').count();
        if !(closed && quotes == 2 || body.starts_with(b"()")) {
            (self.fault)("MSG without a text in quotation marks and brackets".to_owned());
        }
        let close = rest.iter().rposition(|&c| c == b')').map_or(rest.len(), |i| i + 1);
        self.at += close;
    }

    /// The arguments of a call; empty ones are none.
    fn call(&mut self, name: &str, block: &mut Block) {
        let mut arguments = Vec::new();
        loop {
            self.skip_blanks();
            match self.peek() {
                Some(b',') => arguments.push(None),
                Some(b')') => {
                    arguments.push(None);
                }
                Some(b'"') => {
                    self.at += 1;
                    while self.peek().is_some_and(|c| c != b'"') {
                        self.at += 1;
                    }
                    self.at += 1;
                    arguments.push(None);
                }
                _ => match self.number() {
                    Some(value) => arguments.push(Some(value.value)),
                    None => {
                        (self.fault)(format!("an argument of {name} in column {} is no number", self.at + 1));
                        self.at = self.line.len();
                    }
                },
            }
            if self.eat(b',') && arguments.len() < MOST_ARGUMENTS {
                continue;
            }
            if !self.eat(b')') {
                (self.fault)(format!("the call of {name} is not closed"));
                self.at = self.line.len();
            }
            break;
        }
        let words: &mut Words = block.words();
        if words.call.is_some() {
            (self.fault)("two calls in one block".to_owned());
        }
        words.call = Some(Call { name: name.to_owned(), arguments });
    }
}
