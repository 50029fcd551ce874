//! Codes that a machine calls otherwise than the control whose reader reads its programs.

/// `G71=G21`: what the machine writes, and what the reader calls it. Codes in tenths.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::readback) struct Renamed {
    /// `G` or `M`.
    pub letter: u8,
    pub written: u16,
    pub meant: u16,
}

/// The name of a control and the codes behind it: `fanuc G70=G20 G71=G21`; `None` when what stands there is none.
pub(in crate::readback) fn split(control: &str) -> Option<(&str, Vec<Renamed>)> {
    let mut words = control.split_whitespace();
    let name = words.next()?;
    Some((name, words.map(renamed).collect::<Option<_>>()?))
}

fn renamed(word: &str) -> Option<Renamed> {
    let (written, meant) = word.split_once('=')?;
    let ((letter, written), (other, meant)) = (code(written)?, code(meant)?);
    (letter == other && written != meant).then_some(Renamed { letter, written, meant })
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
    /// The code as it is written, and as the reader calls it.
    pub fn names(&self) -> [String; 2] {
        let letter = char::from(self.letter);
        [self.written, self.meant].map(|code| match code % 10 {
            0 => format!("{letter}{}", code / 10),
            tenth => format!("{letter}{}.{tenth}", code / 10),
        })
    }
}
