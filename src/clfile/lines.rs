//! Physical lines to records: comments, continuation, line numbers of other systems.

/// One record of the text, continuation lines joined.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Piece<'t> {
    /// A line of its own, without its line end.
    Line(&'t str),
    /// Lines joined; blanks stand for the marks and line ends between them, so that byte offsets stay true.
    Joined(String),
    /// A comment `$$->` of several lines, joined.
    Metadata(String),
    /// A comment with its `$$`.
    Comment(&'t str),
}

/// A piece and its byte range in the text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Placed<'t> {
    /// What.
    pub piece: Piece<'t>,
    /// First byte.
    pub start: usize,
    /// One past the last byte, line end not included.
    pub end: usize,
}

/// A joined record is not longer than this, bytes.
const LONGEST: usize = 1 << 20;

/// Cuts a text into pieces.
#[derive(Debug, Clone)]
pub struct Lines<'t> {
    text: &'t str,
    at: usize,
    /// Bytes of a line that belong to the record.
    width: usize,
}

/// Columns of a record on a punched card; the others number the cards.
const CARD: usize = 72;

impl<'t> Lines<'t> {
    /// From the start.
    #[must_use]
    pub fn new(text: &'t str) -> Lines<'t> {
        Lines { text, at: usize::from(text.starts_with('\u{feff}')) * 3, width: usize::MAX }
    }

    /// The same, where `cards` without what stands behind column 72.
    #[must_use]
    pub fn of_cards(text: &'t str, cards: bool) -> Lines<'t> {
        Lines { width: if cards { CARD } else { usize::MAX }, ..Lines::new(text) }
    }

    /// The whole text.
    #[must_use]
    pub fn text(&self) -> &'t str {
        self.text
    }

    /// The next physical line, and where it starts.
    pub fn line(&mut self) -> Option<(&'t str, usize)> {
        let start = self.at;
        let rest = self.text.get(start..).filter(|r| !r.is_empty())?;
        // Lines end with LF, CR LF, or CR alone.
        let length = memchr::memchr2(b'\n', b'\r', rest.as_bytes());
        let end = length.unwrap_or(rest.len());
        let mark = match rest.as_bytes().get(end..) {
            Some([b'\r', b'\n', ..]) => 2,
            Some([_, ..]) => 1,
            _ => 0,
        };
        self.at = start + end + mark;
        let line = rest.get(..end)?;
        // Columns count bytes; a character across the last one belongs to neither part.
        let record = if end <= self.width { line } else { line.get(..self.width).unwrap_or(line) };
        Some((record, start))
    }

    /// The piece that starts with this line.
    pub fn piece(&mut self, line: &'t str, start: usize) -> Placed<'t> {
        let trimmed = line.trim_start();
        if let Some(metadata) = trimmed.strip_prefix("$$->").map(str::trim_end).filter(|m| m.ends_with('$')) {
            let mut joined = format!("$$->{}", metadata.trim_end_matches('$'));
            let mut end = start + line.len();
            while let Some((next, at)) = self.line() {
                let (body, more) = cut(next);
                joined.push_str(body);
                end = at + next.len();
                if !more || joined.len() > LONGEST {
                    break;
                }
            }
            return Placed { piece: Piece::Metadata(joined), start, end };
        }
        if trimmed.starts_with("$$") {
            return Placed { piece: Piece::Comment(trimmed.trim_end()), start, end: start + line.len() };
        }
        let (body, more) = cut(line);
        if !more || raw(trimmed) {
            let whole = if raw(trimmed) { line } else { body };
            return Placed { piece: Piece::Line(whole), start, end: start + line.len() };
        }
        let mut joined = body.to_owned();
        let mut end = start + line.len();
        while let Some((next, at)) = self.line() {
            let (body, more) = cut(next);
            if joined.len() + body.len() > LONGEST {
                break;
            }
            // Blanks up to where the next line starts keep offsets true.
            joined.extend(core::iter::repeat_n(' ', (at - start).saturating_sub(joined.len())));
            joined.push_str(body);
            end = at + next.len();
            if !more {
                break;
            }
        }
        Placed { piece: Piece::Joined(joined), start, end }
    }
}

/// A line without its comment and mark, and whether it goes on in the next line: after `$` or `~`, and after a comma.
fn cut(line: &str) -> (&str, bool) {
    let line = line.find("$$").map_or(line, |at| line.get(..at).unwrap_or(line));
    let trimmed = line.trim_end();
    if let Some(rest) = trimmed.strip_suffix(['$', '~']) {
        return (rest, true);
    }
    // The comma of a line number asks for nothing.
    (trimmed, trimmed.ends_with(',') && !without_number(trimmed.trim_start()).is_empty())
}

/// A record without the number of its input line: `N12 ,`, or `C12 ,` for what belongs to the same line.
#[must_use]
pub fn without_number(text: &str) -> &str {
    let digits = |rest: &'_ str| rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_digit()).len();
    let rest = text.strip_prefix(['N', 'n', 'C', 'c']).unwrap_or("");
    let length = digits(rest);
    let record = rest.get(length..).and_then(|r| r.trim_start().strip_prefix(','));
    record.filter(|_| length > 0).map_or(text, str::trim_start)
}

/// Words that take the rest of the line as text.
const RAW: [&str; 12] = [
    "PARTNO",
    "PPRINT",
    "TPRINT",
    "INSERT",
    "REMARK",
    "TITLES",
    "LETTER",
    "TOOL PATH",
    "DISPLY",
    "LEADER",
    "TITLE",
    "CSI_PROGRAM_COMMENT",
];

/// Whether a record is raw text after its word.
#[must_use]
pub fn raw(line: &str) -> bool {
    raw_word(line).is_some()
}

/// The word and the text of a raw record.
#[must_use]
pub fn raw_word(line: &str) -> Option<(&'static str, &str)> {
    RAW.into_iter().find_map(|word| {
        let head = line.get(..word.len())?;
        let rest = line.get(word.len()..)?;
        let ends = rest.chars().next().is_none_or(|c| !c.is_ascii_alphanumeric() && c != '_');
        let text = rest.trim_start();
        (ends && head.eq_ignore_ascii_case(word))
            .then(|| (word, text.strip_prefix('/').unwrap_or(text).trim()))
    })
}
