//! Codes that a machine calls otherwise than the control whose reader reads its programs.

use super::codes::M;

/// `G71=G21`: what the machine writes, and what the reader calls it. Codes in tenths.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::readback) struct Renamed {
    /// `G` or `M`.
    pub letter: u8,
    pub written: u16,
    pub meant: Meant,
}

/// What a machine means by a code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::readback) enum Meant {
    /// What the reader's control means by this one.
    Code(u16),
    /// Nothing that changes the path or what the spindle does.
    Nothing,
    /// Coolant through the tool, on or off.
    Through(bool),
    /// It has no such code.
    Unknown,
}

/// `G71` and `G21`; `nothing`, `unknown`, `through` and `through-off` in place of the
/// second.
///
/// # Errors
/// What stands there instead.
pub(in crate::readback) fn read(written: &str, meant: &str) -> Result<Renamed, String> {
    let no_code = |text: &str| format!("`{text}` is no code: G or M and a number, as in `G54.1`");
    let (letter, number) = code(written).ok_or_else(|| no_code(written))?;
    let meant = match meant {
        "nothing" => Meant::Nothing,
        "unknown" => Meant::Unknown,
        "through" | "through-off" if letter == b'M' => Meant::Through(meant == "through"),
        _ => {
            let (other, meant) = code(meant).ok_or_else(|| no_code(meant))?;
            if other != letter || meant == number {
                return Err("it takes another code of the same letter, `nothing` or `unknown`".to_owned());
            }
            Meant::Code(meant)
        }
    };
    Ok(Renamed { letter, written: number, meant })
}

/// What coolant through the tool is called inside: no program can write these numbers.
pub(in crate::readback) fn through(on: bool) -> u16 {
    u16::MAX - u16::from(on)
}

/// What a number that only [`through`] gives means.
pub(in crate::readback) fn inside(code: u16) -> Option<M> {
    match code {
        _ if code == through(true) => Some(M::ThroughOn),
        _ if code == through(false) => Some(M::ThroughOff),
        _ => None,
    }
}

/// Letter and number in tenths.
fn code(text: &str) -> Option<(u8, u16)> {
    let (letter, digits) = (*text.as_bytes().first()?, text.get(1..)?);
    let (whole, tenth) = digits.split_once('.').unwrap_or((digits, "0"));
    let number = |text: &str, most: usize| {
        let fits = (1..=most).contains(&text.len()) && text.bytes().all(|b| b.is_ascii_digit());
        text.parse::<u16>().ok().filter(|_| fits)
    };
    matches!(letter, b'G' | b'M').then_some((letter, number(whole, 3)? * 10 + number(tenth, 1)?))
}

impl Renamed {
    /// Whether both are about one code as it is written.
    pub fn is_about(&self, other: &Renamed) -> bool {
        (self.letter, self.written) == (other.letter, other.written)
    }

    /// The code as it is written.
    pub fn name(&self) -> String {
        name(self.letter, self.written)
    }
}

/// A code in tenths as it is written.
pub(in crate::readback) fn name(letter: u8, tenths: u16) -> String {
    format!("{}{}", char::from(letter), super::machine::tenths(tenths))
}
