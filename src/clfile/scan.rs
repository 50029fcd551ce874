//! The bulk scanner: `GOTO` records with three or six numbers, byte by byte.
//!
//! It takes a line only if the grammar would read it the same way (the tests compare them on random lines) and
//! leaves everything else to the grammar.

/// A `GOTO` record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Goto {
    /// Numbers as written.
    pub values: [f64; 6],
    /// Three, or six with a tool axis.
    pub count: usize,
}

/// Reads a line that is one `GOTO` record and nothing else; `None` when it is anything else.
#[inline]
#[must_use]
pub fn goto(line: &[u8]) -> Option<Goto> {
    let line = line.trim_ascii_start();
    let (word, rest) = line.split_at_checked(4)?;
    if !word.eq_ignore_ascii_case(b"GOTO") {
        return None;
    }
    let rest = rest.trim_ascii_start().strip_prefix(b"/")?;
    let mut out = Goto { values: [0.0; 6], count: 0 };
    let mut at = skip(rest, 0);
    loop {
        let (value, next) = decimal(rest, at)?;
        *out.values.get_mut(out.count)? = value;
        out.count += 1;
        at = skip(rest, next);
        match rest.get(at) {
            None => break,
            Some(b',') => at = skip(rest, at + 1),
            Some(_) => return None,
        }
    }
    (out.count == 3 || out.count == 6).then_some(out)
}

#[inline]
fn skip(bytes: &[u8], mut at: usize) -> usize {
    while let Some(b' ' | b'\t') = bytes.get(at) {
        at += 1;
    }
    at
}

/// A number as CL files write them: sign, digits with or without a point, exponent.
#[must_use]
pub fn number(text: &str) -> Option<f64> {
    let bytes = text.as_bytes();
    let (value, end) = decimal(bytes, 0)?;
    (end == bytes.len()).then_some(value)
}

/// Powers of ten that are exact.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

/// The number that starts at `at`, and where it ends. Up to 15 digits are exact by one division; others go the long way.
#[inline]
fn decimal(bytes: &[u8], at: usize) -> Option<(f64, usize)> {
    let negative = bytes.get(at) == Some(&b'-');
    let start = at + usize::from(matches!(bytes.get(at), Some(b'-' | b'+')));
    let (mut end, mut mantissa, mut digits, mut fraction) = (start, 0_u64, 0_usize, 0_usize);
    let mut point = false;
    while let Some(&byte) = bytes.get(end) {
        match byte {
            b'0'..=b'9' => {
                mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(byte - b'0'));
                digits += 1;
                fraction += usize::from(point);
            }
            b'.' if !point => point = true,
            _ => break,
        }
        end += 1;
    }
    if digits == 0 {
        return None;
    }
    if matches!(bytes.get(end), Some(b'e' | b'E' | b'd' | b'D')) {
        return with_exponent(bytes, at, end);
    }
    let value = match POWERS.get(fraction) {
        // Both are exact, so their quotient is rounded once.
        Some(power) if digits <= 15 => mantissa as f64 / power,
        _ => long(bytes.get(start..end)?)?,
    };
    Some((if negative { -value } else { value }, end))
}

#[cold]
fn long(bytes: &[u8]) -> Option<f64> {
    core::str::from_utf8(bytes).ok()?.parse().ok()
}

#[cold]
fn with_exponent(bytes: &[u8], start: usize, mark: usize) -> Option<(f64, usize)> {
    let mut end = mark + 1;
    end += usize::from(matches!(bytes.get(end), Some(b'-' | b'+')));
    let first = end;
    while bytes.get(end).is_some_and(u8::is_ascii_digit) {
        end += 1;
    }
    if end == first {
        return None;
    }
    let text = core::str::from_utf8(bytes.get(start..end)?).ok()?.replace(['d', 'D'], "E");
    let value: f64 = text.parse().ok()?;
    value.is_finite().then_some((value, end))
}
