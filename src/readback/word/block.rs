//! One block of a word-address program: cutting the line into words.

use super::renamed::{self, Meant, Renamed};
use super::rules::{ADDRESSES, Frame, Rules};
use crate::readback::number::{Number, NumberError, number};

/// Most G (or M) codes that a block may hold before it is refused.
const MAX_CODES: usize = 16;

/// Addresses that a block may hold: letters, and longer ones behind them.
const PLACES: usize = 26 + ADDRESSES;

/// Bit of an address letter in a mask.
pub(in crate::readback) const fn bit(letter: u8) -> u32 {
    1 << (letter - b'A')
}

/// The mask of some letters.
pub(in crate::readback) const fn letters(of: &[u8]) -> u32 {
    match of {
        [] => 0,
        [first, rest @ ..] => bit(*first) | letters(rest),
    }
}

/// The G or M codes of a block, in tenths (G5.2 is 52).
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::readback) struct Codes {
    items: [u16; MAX_CODES],
    len: usize,
}

impl Codes {
    fn push(&mut self, code: u16) -> bool {
        let room = self.items.get_mut(self.len);
        let fits = room.is_some();
        if let Some(slot) = room {
            *slot = code;
            self.len += 1;
        }
        fits
    }
    /// The codes in the order they stand.
    pub(in crate::readback) fn iter(&self) -> impl Iterator<Item = u16> + '_ {
        self.items.iter().take(self.len).copied()
    }
    /// How many.
    pub(in crate::readback) fn len(&self) -> usize {
        self.len
    }
}

/// The words of a block. Values are as written; scaling to units is the interpreter's.
#[derive(Debug, Clone, Default)]
pub(in crate::readback) struct Block {
    /// G codes in tenths.
    pub g: Codes,
    /// M codes in tenths.
    pub m: Codes,
    /// Letters present, G and M excepted.
    pub seen: u32,
    /// Letters whose number has a decimal point.
    pub pointed: u32,
    /// Characters that count towards the line limit.
    pub length: usize,
    /// A slash stood first: skipped when the switch is on.
    pub optional: bool,
    /// The block is nothing but a percent sign.
    pub percent: bool,
    /// The block is nothing but a program name of letters and digits.
    pub name: bool,
    /// Words of a SINUMERIK block that no other control has.
    pub words: Option<Box<super::sinumerik::Words>>,
    values: [f64; PLACES],
}

impl Block {
    /// The value of a letter, if it is there.
    pub(in crate::readback) fn get(&self, letter: u8) -> Option<f64> {
        let index = usize::from(letter.wrapping_sub(b'A'));
        self.values.get(index).copied().filter(|_| self.seen & bit(letter) != 0)
    }
    /// Whether a letter is there.
    pub(in crate::readback) fn has(&self, letter: u8) -> bool {
        self.seen & bit(letter) != 0
    }
    /// Whether the number of the letter was written with a point.
    pub(in crate::readback) fn point(&self, letter: u8) -> bool {
        self.pointed & bit(letter) != 0
    }
    /// Whether it holds no word at all.
    pub(in crate::readback) fn is_empty(&self) -> bool {
        self.seen == 0 && self.g.len == 0 && self.m.len == 0 && self.words.is_none()
    }
    /// The words of a SINUMERIK block, made when the first one comes.
    pub(super) fn words(&mut self) -> &mut super::sinumerik::Words {
        self.words.get_or_insert_default()
    }
    /// Adds a G code.
    pub(super) fn push_g(&mut self, code: u16, fault: &mut dyn FnMut(String)) {
        if !self.g.push(code) {
            fault(format!("more than {MAX_CODES} G codes in one block"));
        }
    }
    /// Takes the codes as the reader calls them; what it calls otherwise than the machine is none of the machine's.
    pub(super) fn rename(&mut self, renamed: &[Renamed], fault: &mut dyn FnMut(String)) {
        for (letter, codes) in [(b'G', &mut self.g), (b'M', &mut self.m)] {
            let written = core::mem::take(codes);
            for code in written.iter() {
                let known = renamed.iter().find(|r| r.letter == letter && r.written == code);
                let other = renamed.iter().find(|r| r.letter == letter && r.meant == Meant::Code(code));
                let meant = match (known.map(|r| r.meant), other) {
                    (Some(Meant::Nothing), _) => continue,
                    (Some(Meant::Unknown), _) => {
                        fault(format!("unknown code {}", renamed::name(letter, code)));
                        continue;
                    }
                    (Some(Meant::Code(meant)), _) => meant,
                    (Some(Meant::Through(on)), _) => renamed::through(on),
                    (None, Some(other)) => {
                        let (meant, written) = (renamed::name(letter, code), other.name());
                        fault(format!("unknown code {meant}: this machine calls it {written}"));
                        code
                    }
                    (None, None) => code,
                };
                // There were no more of them before.
                codes.push(meant);
            }
        }
    }
    pub(super) fn clear(&mut self) {
        self.g.len = 0;
        self.m.len = 0;
        self.seen = 0;
        self.pointed = 0;
        self.length = 0;
        self.optional = false;
        self.percent = false;
        self.name = false;
        self.words = None;
    }
    fn put(&mut self, letter: u8, number: Number) -> bool {
        let fresh = !self.has(letter);
        if let Some(slot) = self.values.get_mut(usize::from(letter - b'A')) {
            *slot = number.value;
        }
        self.seen |= bit(letter);
        self.pointed |= if number.point { bit(letter) } else { 0 };
        fresh
    }
}

/// Cuts `line` (without its line end) into words. What the control would refuse goes to `fault`; the words
/// that could be read are in the block all the same.
pub(in crate::readback) fn read(
    line: &[u8],
    rules: &Rules,
    block: &mut Block,
    fault: &mut dyn FnMut(String),
) {
    block.clear();
    let line = if rules.checksum { without_checksum(line, fault) } else { line };
    let mut at = match rules.frame {
        Frame::Name => program_name(line, block),
        Frame::PercentName => percent_name(line, block),
        _ => 0,
    };
    while let Some(&c) = line.get(at) {
        at = match c {
            b'A'..=b'Z' => word(line, at, address(line, at, c, rules), rules, block, fault),
            b' ' | b'\t' => at + 1,
            b'(' if rules.parentheses => comment(line, at, rules, fault),
            b';' if rules.semicolon_comment => {
                check_comment(line.get(at + 1..).unwrap_or_default(), rules, fault);
                line.len()
            }
            b'/' => slash(block, at, rules, fault),
            b'%' => percent(line, at, rules, block, fault),
            b'a'..=b'z' => {
                lower_case(c, at, rules, fault);
                word(line, at, address(line, at, c.to_ascii_uppercase(), rules), rules, block, fault)
            }
            _ => {
                fault(stray(c, at));
                at + 1
            }
        };
    }
    block.length = match rules.line_limit {
        Some(limit) if line.len() > limit && !rules.limit_counts_all => stripped_length(line),
        _ => line.len(),
    };
}

/// The line up to its checksum: the exclusive or of all bytes before the star.
fn without_checksum<'l>(line: &'l [u8], fault: &mut dyn FnMut(String)) -> &'l [u8] {
    let code = line.split(|&c| c == b';').next().unwrap_or_default();
    let Some(star) = code.iter().rposition(|&c| c == b'*') else { return line };
    let (body, sum) = code.split_at(star);
    let wanted = body.iter().fold(0u8, |sum, c| sum ^ c);
    let said =
        core::str::from_utf8(sum.get(1..).unwrap_or_default()).ok().and_then(|s| s.trim().parse().ok());
    if said != Some(wanted) {
        fault(format!("checksum mismatch: the line's is {wanted}"));
    }
    if !body.trim_ascii_start().starts_with(b"N") {
        fault("a checksum without a line number".to_owned());
    }
    body
}

/// A line `O` with one to four letters and digits is a program name; gives where the rest begins.
fn program_name(line: &[u8], block: &mut Block) -> usize {
    let text = line.trim_ascii();
    let Some(name) = text.strip_prefix(b"O") else { return 0 };
    let fits = (1..=4).contains(&name.len()) && name.iter().all(u8::is_ascii_alphanumeric);
    if !fits {
        return 0;
    }
    block.name = true;
    block.put(b'O', Number { value: 0.0, point: false });
    line.len()
}

/// `%` and the digits of a program's number; gives where the rest begins.
fn percent_name(line: &[u8], block: &mut Block) -> usize {
    let Some(rest) = line.strip_prefix(b"%") else { return 0 };
    let digits = rest.iter().take_while(|c| c.is_ascii_digit()).count();
    if !(1..=8).contains(&digits) {
        return 0;
    }
    block.name = true;
    block.put(b'O', Number { value: 0.0, point: false });
    1 + digits
}

/// Characters of a line that are neither blanks nor in a comment.
fn stripped_length(line: &[u8]) -> usize {
    let mut inside = false;
    let mut count = 0;
    for &c in line {
        match c {
            b';' if !inside => break,
            b'(' => inside = true,
            b')' => inside = false,
            c if !inside && c > b' ' => count += 1,
            _ => {}
        }
    }
    count
}

fn stray(c: u8, at: usize) -> String {
    let shown = if c.is_ascii_graphic() { format!("'{}'", char::from(c)) } else { format!("byte 0x{c:02X}") };
    format!("bad character {shown} in column {}", at + 1)
}

fn lower_case(c: u8, at: usize, rules: &Rules, fault: &mut dyn FnMut(String)) {
    if !rules.lower_case {
        fault(format!("lower case letter '{}' in column {}", char::from(c), at + 1));
    }
}

fn slash(block: &mut Block, at: usize, rules: &Rules, fault: &mut dyn FnMut(String)) -> usize {
    if !rules.slash_anywhere && !block.is_empty() {
        fault(format!("'/' in column {} is not at the start of the block", at + 1));
    }
    block.optional = true;
    at + 1
}

fn percent(line: &[u8], at: usize, rules: &Rules, block: &mut Block, fault: &mut dyn FnMut(String)) -> usize {
    let alone = line.iter().enumerate().all(|(i, c)| i == at || c.is_ascii_whitespace());
    if !alone || !rules.percent_allowed {
        fault(format!(
            "'%' in column {} {}",
            at + 1,
            if alone { "is not a command" } else { "is not alone on its line" }
        ));
    }
    block.percent |= alone;
    line.len()
}

/// The address at `at` and its length: the longest that the machine has there, or the letter.
fn address(line: &[u8], at: usize, letter: u8, rules: &Rules) -> (u8, usize) {
    let rest = line.get(at..).unwrap_or_default();
    let stands = |name: &[u8]| {
        rest.get(..name.len()).is_some_and(|start| start.eq_ignore_ascii_case(name))
            && !rest.get(name.len()).is_some_and(u8::is_ascii_alphabetic)
    };
    let longer = rules.longer_addresses().filter(|(name, _)| stands(name)).max_by_key(|(name, _)| name.len());
    longer.map_or((letter, 1), |(name, letter)| (letter, name.len()))
}

/// An address and its number; gives where to go on.
fn word(
    line: &[u8],
    at: usize,
    (letter, length): (u8, usize),
    rules: &Rules,
    block: &mut Block,
    fault: &mut dyn FnMut(String),
) -> usize {
    let from = at + length;
    let (value, end) = match number(line, from) {
        Ok(read) => read,
        Err((error, end)) => {
            fault(bad_number(&rules.address(letter), error, line.get(from), at));
            return after_number(line, end.max(from));
        }
    };
    store(letter, value, rules, block, fault);
    end
}

/// Where a broken number is over.
fn after_number(line: &[u8], from: usize) -> usize {
    let rest = line.get(from..).unwrap_or_default();
    let part = |c: &u8| {
        matches!(
            c,
            b'0'..=b'9' | b'.' | b'+' | b'-' | b' ' | b'\t' | b'#' | b'[' | b']' | b'*' | b'<' | b'>' | b'_'
        )
    };
    from + rest.iter().position(|c| !part(c)).unwrap_or(rest.len())
}

fn bad_number(letter: &str, error: NumberError, next: Option<&u8>, at: usize) -> String {
    match error {
        NumberError::NoDigits if matches!(next, Some(b'[' | b'#')) => {
            format!("{letter} is followed by an expression, which this reader does not follow")
        }
        NumberError::NoDigits => format!("{letter} in column {} is not followed by a number", at + 1),
        NumberError::SecondPoint => {
            format!("the number of {letter} in column {} has two decimal points", at + 1)
        }
        NumberError::TooLong => format!("the number of {letter} in column {} has too many digits", at + 1),
    }
}

pub(super) fn store(
    letter: u8,
    value: Number,
    rules: &Rules,
    block: &mut Block,
    fault: &mut dyn FnMut(String),
) {
    if matches!(letter, b'G' | b'M') {
        return store_code(letter, value, block, fault);
    }
    if rules.whole_numbers & bit(letter) != 0 && value.point {
        let (name, value) = (rules.address(letter), value.value);
        fault(format!("{name}{value} carries a decimal point; the control wants an integer"));
    }
    if !block.put(letter, value) {
        fault(format!("multiple {} words in one block", rules.address(letter)));
    }
}

/// G and M codes, in tenths: integers within 0.0001 of a tenth.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn store_code(letter: u8, value: Number, block: &mut Block, fault: &mut dyn FnMut(String)) {
    let tenths = value.value * 10.0;
    let nearest = tenths.round();
    if !(0.0..=9999.0).contains(&nearest) || (tenths - nearest).abs() > 1e-3 {
        return fault(format!("unknown code {}{}", char::from(letter), value.value));
    }
    let codes = if letter == b'G' { &mut block.g } else { &mut block.m };
    if !codes.push(nearest as u16) {
        fault(format!("more than {MAX_CODES} {} codes in one block", char::from(letter)));
    }
}

/// A comment in parentheses that starts at `at`; gives where the block goes on.
fn comment(line: &[u8], at: usize, rules: &Rules, fault: &mut dyn FnMut(String)) -> usize {
    let rest = line.get(at + 1..).unwrap_or_default();
    let close = rest.iter().position(|&c| c == b')');
    let body = rest.get(..close.unwrap_or(rest.len())).unwrap_or_default();
    if close.is_none() && !rules.comment_may_stay_open {
        fault(format!("the comment in column {} is not closed", at + 1));
    }
    if let Some(nested) = body.iter().position(|&c| c == b'(').filter(|_| !rules.comment_may_nest) {
        fault(format!("a comment in a comment, column {}", at + nested + 2));
    }
    let nested = !rules.comment_may_nest && body.contains(&b'(');
    let close = if nested { rest.iter().rposition(|&c| c == b')') } else { close };
    check_comment(body, rules, fault);
    at + 1 + close.map_or(rest.len(), |c| c + 1)
}

fn check_comment(body: &[u8], rules: &Rules, fault: &mut dyn FnMut(String)) {
    if let Some(&c) = body.iter().find(|&&c| !(rules.comment_character)(c)) {
        let shown =
            if c.is_ascii_graphic() { format!("'{}'", char::from(c)) } else { format!("byte 0x{c:02X}") };
        fault(format!("{} {shown} in a comment", rules.comment_complaint));
    }
    let text = body.trim_ascii_start();
    for command in rules.active_comments {
        if text.get(..command.len()).is_some_and(|start| start.eq_ignore_ascii_case(command.as_bytes())) {
            fault(format!("the comment starts with {command}, which the control obeys as a command"));
        }
    }
}
