//! Usual slips, and the help that answers them.

use crate::diag::Diagnostic;
use crate::diag::codes::syntax as codes;
use crate::source::Span;

/// The name of a control character.
pub(super) fn control_name(byte: u8) -> &'static str {
    match byte {
        0 => "NUL",
        0x08 => "backspace",
        0x0b => "vertical tab",
        0x0c => "form feed",
        b'\r' => "carriage return without line feed",
        0x1a => "end-of-file mark of DOS",
        0x1b => "escape",
        0x7f => "delete",
        _ => "not printable",
    }
}

/// A character that stands outside strings and comments and means nothing there.
pub(super) fn stray(character: char, span: Span) -> Diagnostic {
    let code_point = u32::from(character);
    let shown = if character.is_ascii_graphic() {
        format!("`{character}`")
    } else {
        format!("`{character}` (U+{code_point:04X})")
    };
    let diagnostic =
        Diagnostic::new(&codes::STRAY_CHARACTER, span, format!("the character {shown} has no meaning here"));
    match advice(character) {
        Some(help) => diagnostic.help(help),
        None => diagnostic,
    }
}

/// What closes a group or a text that this character opens: it needs no message of its own.
pub(super) fn closers(character: char) -> &'static [char] {
    match character {
        '[' => &[']'],
        '{' => &['}'],
        '\u{2018}' | '\u{201a}' | '\u{2019}' => &['\u{2019}', '\u{2018}'],
        '\u{201c}' | '\u{201e}' | '\u{201d}' => &['\u{201d}', '\u{201c}'],
        '«' => &['»'],
        _ => &[],
    }
}

fn advice(character: char) -> Option<String> {
    if let Some(plain) = plain(character) {
        return Some(format!("write `{plain}`"));
    }
    let help = match character {
        '[' | ']' | '{' | '}' => "subscripts and groups stand in `(` and `)`",
        '!' => "not equal is `<>`, negation is `NOT`",
        '%' => "the remainder of a division is `MOD(a, b)`",
        '^' => "a power is `**`",
        '&' => "write `AND`",
        '|' => "write `OR`",
        '#' => "a comment starts with `$$`",
        '\\' | '~' => "a line is continued with `$`",
        ':' => "a label is closed by `)`, as in `LA1)`; a value is given with `=`",
        '°' | 'º' => "write `deg`",
        'µ' | 'μ' => "micrometres are `um`",
        '²' => "write `**2`",
        '³' => "write `**3`",
        '\u{a0}' | '\u{2007}' | '\u{202f}' | '\u{3000}' | '\u{200b}' | '\u{feff}' => {
            "delete it and type an ordinary blank"
        }
        _ => return None,
    };
    Some(help.to_owned())
}

/// The character of the language that was surely meant.
fn plain(character: char) -> Option<char> {
    let plain = match character {
        '\u{2018}' | '\u{2019}' | '\u{201a}' | '\u{2032}' | '`' | '´' => '\'',
        '\u{201c}' | '\u{201d}' | '\u{201e}' | '\u{2033}' | '«' | '»' => '"',
        '\u{2212}' | '\u{2010}' | '\u{2011}' | '\u{2012}' | '\u{2013}' | '\u{2014}' => '-',
        '×' | '·' | '\u{2022}' => '*',
        '÷' | '\u{2044}' | '\u{2215}' => '/',
        '\u{ff01}'..='\u{ff5e}' => char::from_u32(u32::from(character) - 0xfee0)?,
        _ => return None,
    };
    Some(plain)
}

/// A `,`, `/` or `=` at the end of a line behind which a new statement starts.
pub(super) fn unfinished_line(mark: Span, next: Span) -> Diagnostic {
    Diagnostic::new(
        &codes::UNFINISHED_LINE,
        mark,
        "this mark says that the statement goes on, but the next line starts a new one",
    )
    .label(next, "the next statement")
    .help("delete the mark, or finish the list")
}

/// A letter O among digits: `1O.5`, `O.5`. Returns the number that was meant.
pub(super) fn letter_o(written: &str) -> Option<String> {
    let has_o = written.contains(['o', 'O']);
    let digits = written.chars().any(|c| c.is_ascii_digit());
    let only = written.chars().all(|c| c.is_ascii_digit() || matches!(c, 'o' | 'O' | '.'));
    (has_o && digits && only).then(|| written.replace(['o', 'O'], "0"))
}

/// The run of letters, digits and points around byte `at`, as a byte range of `text`.
pub(super) fn number_like(text: &str, at: usize) -> (usize, usize) {
    let inside = |b: &u8| b.is_ascii_alphanumeric() || matches!(b, b'.' | b'_');
    let bytes = text.as_bytes();
    let at = at.min(bytes.len());
    let start = bytes.iter().take(at).rposition(|b| !inside(b)).map_or(0, |i| i + 1);
    let end = bytes.iter().skip(at).position(|b| !inside(b)).map_or(bytes.len(), |i| at + i);
    (start, end)
}
