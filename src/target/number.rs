//! The one place that prints numbers of NC programs.
//!
//! A number is an integer count of decimal steps, so nothing is rounded here, no exponent appears but where a word wants
//! one, and zero has one spelling: `-0` cannot be written.

use serde::Deserialize;

/// When the decimal point is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Point {
    /// Only before a fraction: `5`, `5.25`.
    #[default]
    Needed,
    /// Always, also after an integer: `5.`, `5.25`.
    Always,
    /// Always with at least one digit after it: `5.0`, `5.25`.
    Digit,
}

/// How a number is spelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Style {
    /// Decimals that one step stands for.
    pub decimals: u8,
    /// The decimal point; ignored without decimals: an integer never carries one.
    pub point: Point,
    /// Zeros at the end of the fraction stay.
    pub trailing_zeros: bool,
    /// The zero before the point is left out: `.5`.
    pub bare_fraction: bool,
    /// `+` before a number that is not negative.
    pub plus: bool,
    /// From this many steps on a number has one digit before the point and an exponent, `1.25E+2`; 0: none has.
    pub exponent_from: u64,
}

/// Digits of the largest number, with sign and point, and room for what stands before it.
const LONGEST: usize = 48 + LEAD;
/// Longest text that is put before a number without a step of its own.
const LEAD: usize = 32;

/// Appends `steps · 10^-style.decimals`.
pub fn push(out: &mut Vec<u8>, steps: i64, style: &Style) {
    push_word(out, &[], steps, style);
}

/// Appends `lead` and the number in one go: a word.
#[inline]
pub fn push_word(out: &mut Vec<u8>, lead: &[u8], steps: i64, style: &Style) {
    let mut rest = steps.unsigned_abs();
    if style.exponent_from != 0 && rest >= style.exponent_from {
        return push_scaled(out, lead, steps, style);
    }
    let mut buffer = [0u8; LONGEST];
    let mut at = LONGEST;
    let decimals = style.decimals.min(18);
    if decimals > 0 {
        (rest, at) = push_fraction(&mut buffer, at, rest, decimals, style);
    }
    if rest > 0 || at == LONGEST || !style.bare_fraction || buffer[at] != b'.' || at + 1 == LONGEST {
        at = push_digits(&mut buffer, at, rest);
    }
    if steps < 0 || style.plus {
        at -= 1;
        buffer[at] = if steps < 0 { b'-' } else { b'+' };
    }
    if lead.len() <= LEAD {
        for &byte in lead.iter().rev() {
            at -= 1;
            buffer[at] = byte;
        }
    } else {
        out.extend_from_slice(lead);
    }
    out.extend_from_slice(&buffer[at..]);
}

/// Appends `lead` and the number with one digit before the point, and the power of ten that this takes.
#[cold]
fn push_scaled(out: &mut Vec<u8>, lead: &[u8], steps: i64, style: &Style) {
    // An integer of 64 bits has 20 digits at most.
    let places = u8::try_from(steps.unsigned_abs().checked_ilog10().unwrap_or(0)).unwrap_or(0).min(18);
    push_word(out, lead, steps, &Style { decimals: places, exponent_from: 0, ..*style });
    let power = i64::from(places) - i64::from(style.decimals);
    if power != 0 {
        push_word(out, b"E", power, &Style { plus: true, ..Style::default() });
    }
}

/// Writes the fraction's digits and the point in front of `at`; gives the whole part and the new front.
#[inline]
fn push_fraction(
    buffer: &mut [u8; LONGEST],
    mut at: usize,
    mut rest: u64,
    decimals: u8,
    style: &Style,
) -> (u64, usize) {
    let mut left = decimals;
    if !style.trailing_zeros {
        while left > 0 && rest.is_multiple_of(10) {
            rest /= 10;
            left -= 1;
        }
    }
    if left == 0 && style.point == Point::Digit {
        at -= 1;
        buffer[at] = b'0';
    }
    let fraction = left > 0;
    while left > 0 {
        at -= 1;
        buffer[at] = b'0' + (rest % 10) as u8;
        rest /= 10;
        left -= 1;
    }
    if fraction || style.point != Point::Needed {
        at -= 1;
        buffer[at] = b'.';
    }
    (rest, at)
}

/// Writes an integer's digits in front of `at`; at least one.
#[inline]
fn push_digits(buffer: &mut [u8; LONGEST], mut at: usize, mut rest: u64) -> usize {
    loop {
        at -= 1;
        buffer[at] = b'0' + (rest % 10) as u8;
        rest /= 10;
        if rest == 0 {
            return at;
        }
    }
}

/// The nearest number of steps of 10^-`decimals` to `value`, halves away from zero.
/// `None` if it is not finite or beyond ±10^15 steps.
#[must_use]
pub fn steps(value: f64, decimals: u8) -> Option<i64> {
    let scaled = (value * crate::target::power_of_ten(decimals)).round();
    // 1e15 is exact in f64 and in i64, so the conversion is exact.
    (scaled.abs() <= 1e15).then_some(scaled as i64)
}

/// `steps · 10^-decimals` as plain text: `12.5`, `-0.003`, `7`.
#[must_use]
pub fn plain(steps: i64, decimals: u8) -> String {
    let mut out = Vec::with_capacity(16);
    push(&mut out, steps, &Style { decimals, ..Style::default() });
    String::from_utf8(out).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn text(steps: i64, style: Style) -> String {
        let mut out = Vec::new();
        push(&mut out, steps, &style);
        String::from_utf8(out).unwrap()
    }
    const MM: Style = Style {
        decimals: 3,
        point: Point::Needed,
        trailing_zeros: false,
        bare_fraction: false,
        plus: false,
        exponent_from: 0,
    };

    #[test]
    fn fractions_are_as_short_as_they_can_be() {
        assert_eq!(text(12_500, MM), "12.5");
        assert_eq!(text(-3, MM), "-0.003");
        assert_eq!(text(0, MM), "0");
        assert_eq!(text(100_000, MM), "100");
    }
    #[test]
    fn a_forced_point_stands_also_after_integers() {
        let forced = Style { point: Point::Always, ..MM };
        assert_eq!(text(5_000, forced), "5.");
        assert_eq!(text(0, forced), "0.");
        assert_eq!(text(-250, forced), "-0.25");
        assert_eq!(text(5_000, Style { point: Point::Digit, ..MM }), "5.0");
    }
    #[test]
    fn integers_never_carry_a_point() {
        assert_eq!(text(12, Style { decimals: 0, point: Point::Always, ..MM }), "12");
    }
    #[test]
    fn signs_zeros_and_bare_fractions() {
        assert_eq!(text(0, Style { plus: true, ..MM }), "+0");
        assert_eq!(text(500, Style { bare_fraction: true, ..MM }), ".5");
        assert_eq!(text(0, Style { bare_fraction: true, point: Point::Always, ..MM }), "0.");
        assert_eq!(text(500, Style { trailing_zeros: true, ..MM }), "0.500");
        assert_eq!(text(i64::MIN, MM), "-9223372036854775.808");
    }
    #[test]
    fn large_numbers_have_an_exponent_where_their_word_wants_one() {
        let style = Style { exponent_from: 10_000, plus: true, ..MM };
        assert_eq!(text(9_999, style), "+9.999");
        assert_eq!(text(-10_000, style), "-1E+1");
        assert_eq!(text(123_456_789, style), "+1.23456789E+5");
        assert_eq!(text(i64::MIN, style), "-9.223372036854775808E+15");
    }
    #[test]
    fn steps_round_halves_away_from_zero_and_refuse_what_is_too_large() {
        assert_eq!(steps(0.0004, 3), Some(0));
        assert_eq!(steps(-0.0005, 3), Some(-1));
        assert_eq!(steps(f64::NAN, 3), None);
        assert_eq!(steps(1e13, 3), None);
    }
    proptest! {
        #[test]
        fn text_parses_back_to_the_same_integer(value: i64, decimals in 0u8..=6, point in 0..3, trailing: bool, bare: bool, plus: bool) {
            let point = [Point::Needed, Point::Always, Point::Digit][point as usize];
            let s = text(value, Style { decimals, point, trailing_zeros: trailing, bare_fraction: bare, plus, exponent_from: 0 });
            let digits: String = s.chars().filter(char::is_ascii_digit).collect();
            let fraction = s.split_once('.').map_or(0, |(_, f)| f.len());
            let back: i128 = digits.parse::<i128>().unwrap() * if s.starts_with('-') { -1 } else { 1 };
            let scale = |n: usize| (0..n).fold(1i128, |a, _| a * 10);
            prop_assert!(!s.starts_with("-0") || value != 0);
            prop_assert_eq!(back * scale(usize::from(decimals)), i128::from(value) * scale(fraction));
        }
    }
}
