//! Decimal numbers of a block, without rounding surprises.

/// Powers of ten that are exact in 64-bit floats.
const POW10: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

/// Most significant digits that fit a 53-bit mantissa whatever they are.
const EXACT_DIGITS: u32 = 15;

/// A number as it stands in a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Number {
    /// The value as written, as if in calculator-type input.
    pub value: f64,
    /// Whether it has a decimal point.
    pub point: bool,
}

/// Why there is no number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NumberError {
    /// No digit follows the address.
    NoDigits,
    /// A second decimal point.
    SecondPoint,
    /// More digits than any control takes.
    TooLong,
}

/// Reads `[+-]digits[.digits]` at `at`, skipping blanks between the marks. Gives the number and where it ends.
///
/// The value is the correctly rounded one up to 15 significant digits (an integer divided by an exact power of
/// ten); longer numbers are refused from 25 digits on.
pub(super) fn number(text: &[u8], mut at: usize) -> Result<(Number, usize), (NumberError, usize)> {
    let mut negative = false;
    while let Some(b' ' | b'\t') = text.get(at) {
        at += 1;
    }
    if let Some(&sign @ (b'+' | b'-')) = text.get(at) {
        negative = sign == b'-';
        at += 1;
    }
    let (mut mantissa, mut digits, mut significant, mut decimals) = (0u64, 0u32, 0u32, 0u32);
    let mut point = false;
    while let Some(&c) = text.get(at) {
        match c {
            b'0'..=b'9' => {
                digits += 1;
                significant += u32::from(significant > 0 || c != b'0');
                decimals += u32::from(point);
                if significant > 18 || digits > 24 {
                    return Err((NumberError::TooLong, at));
                }
                mantissa = mantissa * 10 + u64::from(c - b'0');
            }
            b'.' if point => return Err((NumberError::SecondPoint, at)),
            b'.' => point = true,
            b' ' | b'\t' => {}
            _ => break,
        }
        at += 1;
    }
    if digits == 0 {
        return Err((NumberError::NoDigits, at));
    }
    let value = scaled(mantissa, decimals, significant);
    Ok((Number { value: if negative { -value } else { value }, point }, at))
}

/// mantissa / 10^decimals.
#[allow(clippy::cast_precision_loss)]
fn scaled(mantissa: u64, decimals: u32, significant: u32) -> f64 {
    let power = POW10.get(decimals as usize).copied().unwrap_or(1e22);
    if significant <= EXACT_DIGITS {
        return mantissa as f64 / power;
    }
    format!("{mantissa}e-{decimals}").parse().unwrap_or(mantissa as f64 / power)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        number(text.as_bytes(), 0).expect("a number").0.value
    }

    #[test]
    #[allow(clippy::float_cmp)]
    fn the_nearest_float_of_the_decimal_is_read() {
        for text in
            ["0.1", "-245.123", "12.34567", "+.5", "5.", "00012.0400", "123456789.012345678", "-0.00001"]
        {
            assert_eq!(value(text), text.trim_start_matches('+').parse::<f64>().expect("std"), "{text}");
        }
        assert_eq!(value("+0. 12 34"), 0.1234);
    }

    #[test]
    fn what_is_no_number_is_refused() {
        assert_eq!(number(b"-", 0).map_err(|e| e.0), Err(NumberError::NoDigits));
        assert_eq!(number(b".", 0).map_err(|e| e.0), Err(NumberError::NoDigits));
        assert_eq!(number(b"1.2.3", 0).map_err(|e| e.0), Err(NumberError::SecondPoint));
        assert_eq!(number(&[b'9'; 400], 0).map_err(|e| e.0), Err(NumberError::TooLong));
    }
}
