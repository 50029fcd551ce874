//! The exchange structure of ISO 10303-21: which instance stands where.
//!
//! One pass finds the instances of all DATA sections and checks what holds the text together: strings, comments,
//! parentheses and semicolons. What is inside an instance is parsed when it is asked for.

use std::sync::Arc;

use super::super::Trouble;
use super::value::{Instance, Malformed, parse};

/// Instances of a file, at most.
const LARGEST: usize = 20_000_000;
/// Bytes of a point, a vertex or a unit, at most.
const SMALL: usize = 4096;

/// Where an instance stands.
#[derive(Debug, Clone, Copy)]
struct Entry {
    id: u64,
    /// The text behind `=`, without the semicolon.
    start: u32,
    end: u32,
}

/// A STEP file that has been indexed.
#[derive(Debug)]
pub struct Exchange {
    text: Arc<str>,
    /// In the order of the file.
    entries: Vec<Entry>,
    /// Indices of `entries`, by id.
    by_id: Vec<u32>,
}

/// Section of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Section {
    /// Between sections.
    Outside,
    /// `DATA`.
    Data,
    /// `HEADER` and those of later editions.
    Other,
}

impl Exchange {
    /// Indexes a text.
    ///
    /// # Errors
    /// [`Trouble`] with the line: no STEP file, a broken one, or one that was cut off.
    pub fn open(text: Arc<str>) -> Result<Exchange, Trouble> {
        let mut entries = Vec::new();
        let mut section = Section::Outside;
        let mut scan = Scan { bytes: text.as_bytes(), at: 0 };
        if !scan
            .next_statement(&text)
            .is_ok_and(|s| s.is_some_and(|(a, b)| text[a..b].trim_end() == "ISO-10303-21"))
        {
            let message = "this is no STEP file: it does not begin with `ISO-10303-21;`";
            return Err(Trouble::file(1, message));
        }
        loop {
            let Some((start, end)) = scan.next_statement(&text)? else {
                let message = "the file ends before `END-ISO-10303-21;`: it was cut off";
                return Err(Trouble::file(line_of(&text, text.len()), message));
            };
            let statement = text[start..end].trim_end();
            if statement == "END-ISO-10303-21" {
                break;
            }
            section = match (section, statement) {
                (Section::Outside, s) if s == "DATA" || s.starts_with("DATA") && s.ends_with(')') => {
                    Section::Data
                }
                (Section::Outside, _) => Section::Other,
                (_, "ENDSEC") => Section::Outside,
                (Section::Data, _) => {
                    entries.push(entry(&text, start, end)?);
                    Section::Data
                }
                (Section::Other, _) => Section::Other,
            };
            if entries.len() > LARGEST {
                let message = format!("the file has more than {LARGEST} instances");
                return Err(Trouble::file(line_of(&text, start), message));
            }
        }
        Exchange::sorted(text, entries)
    }

    fn sorted(text: Arc<str>, entries: Vec<Entry>) -> Result<Exchange, Trouble> {
        let count = u32::try_from(entries.len()).unwrap_or(u32::MAX);
        let mut by_id: Vec<u32> = (0..count).collect();
        by_id.sort_by_key(|&i| entries[i as usize].id);
        let twin = by_id.windows(2).find(|w| entries[w[0] as usize].id == entries[w[1] as usize].id);
        if let Some(second) = twin.and_then(|w| entries.get(w[1] as usize)) {
            let message = format!("there is an instance #{} before this one", second.id);
            return Err(Trouble::file(line_of(&text, second.start as usize), message));
        }
        Ok(Exchange { text, entries, by_id })
    }

    /// Number of instances.
    pub(super) fn len(&self) -> usize {
        self.entries.len()
    }

    /// The place of the instance in the file's order.
    pub(super) fn place(&self, id: u64) -> Option<usize> {
        let found = self.by_id.binary_search_by_key(&id, |&i| self.entries[i as usize].id).ok()?;
        self.by_id.get(found).map(|&i| i as usize)
    }

    /// The id of the instance at a place.
    pub(super) fn id(&self, place: usize) -> u64 {
        self.entries.get(place).map_or(0, |e| e.id)
    }

    /// The text of the instance at a place.
    pub(super) fn body(&self, place: usize) -> &str {
        self.entries.get(place).and_then(|e| self.text.get(e.start as usize..e.end as usize)).unwrap_or("")
    }

    /// The type of a simple instance; empty for one of several types.
    pub(super) fn keyword(&self, place: usize) -> &str {
        let body = self.body(place);
        let end = body.find(|c: char| !c.is_ascii_alphanumeric() && c != '_' && c != '!');
        body.get(..end.unwrap_or(body.len())).unwrap_or("")
    }

    /// The line on which the instance at a place starts.
    pub(super) fn line(&self, place: usize) -> usize {
        line_of(&self.text, self.entries.get(place).map_or(0, |e| e.start as usize))
    }

    /// The instance at a place.
    pub(super) fn instance(&self, place: usize) -> Result<Instance<'_>, Trouble> {
        parse(self.body(place)).map_err(|Malformed { at, what }| {
            let start = self.entries.get(place).map_or(0, |e| e.start as usize);
            Trouble::file(line_of(&self.text, start + at), format!("instance #{}: {what}", self.id(place)))
        })
    }

    /// The instance that is referred to from `from`.
    pub(super) fn get(&self, id: u64, from: usize) -> Result<(usize, Instance<'_>), Trouble> {
        let place = self.place(id).ok_or_else(|| self.dangling(id, from))?;
        Ok((place, self.instance(place)?))
    }

    /// The same, of an instance that is asked for often and must be short.
    pub(super) fn small(&self, id: u64, from: usize) -> Result<(usize, Instance<'_>), Trouble> {
        let place = self.place(id).ok_or_else(|| self.dangling(id, from))?;
        if self.body(place).len() > SMALL {
            let message = format!("instance #{id} is longer than {SMALL} bytes");
            return Err(Trouble::file(self.line(place), message));
        }
        Ok((place, self.instance(place)?))
    }

    /// Bytes of the instance with this id.
    pub(super) fn size(&self, id: u64) -> usize {
        self.place(id).map_or(0, |place| self.body(place).len())
    }

    /// `from` refers to an instance that is not there.
    pub(super) fn dangling(&self, id: u64, from: usize) -> Trouble {
        let message = format!("there is no instance #{id}, to which #{} refers", self.id(from));
        Trouble::file(self.line(from), message)
    }

    /// Instance `from` does not have what its type must have.
    pub(super) fn wrong(&self, from: usize, what: &str) -> Trouble {
        Trouble::file(
            self.line(from),
            format!("instance #{} has no {what} where one must stand", self.id(from)),
        )
    }
}

/// The line, from 1, of a byte.
fn line_of(text: &str, byte: usize) -> usize {
    let before = text.as_bytes().get(..byte.min(text.len())).unwrap_or(&[]);
    1 + memchr::memchr_iter(b'\n', before).count()
}

/// `#12 = …`.
fn entry(text: &str, start: usize, end: usize) -> Result<Entry, Trouble> {
    let broken = |what: &str| Trouble::file(line_of(text, start), what.to_owned());
    let statement = text.get(start..end).unwrap_or("");
    let digits = statement.strip_prefix('#').unwrap_or("");
    let length = digits.bytes().take_while(u8::is_ascii_digit).count();
    let Some(id) = digits.get(..length).and_then(|d| d.parse::<u64>().ok()) else {
        return Err(broken("an instance `#n = …;` must stand here"));
    };
    let after = skip_blanks(text.as_bytes(), start + 1 + length);
    if text.as_bytes().get(after) != Some(&b'=') {
        return Err(broken("a `=` must follow the name of an instance"));
    }
    let body = skip_blanks(text.as_bytes(), after + 1).min(end);
    let place = |byte: usize| u32::try_from(byte).map_err(|_| broken("the file has more than 4 GB"));
    Ok(Entry { id, start: place(body)?, end: place(end)? })
}

/// The first byte from `at` on that is neither a blank nor part of a comment.
fn skip_blanks(bytes: &[u8], mut at: usize) -> usize {
    loop {
        match bytes.get(at) {
            Some(b) if b.is_ascii_whitespace() => at += 1,
            Some(b'/') if bytes.get(at + 1) == Some(&b'*') => match comment_end(bytes, at) {
                Some(end) => at = end,
                None => return at,
            },
            _ => return at,
        }
    }
}

/// Behind the comment that starts at `at`.
fn comment_end(bytes: &[u8], at: usize) -> Option<usize> {
    let inside = bytes.get(at + 2..)?;
    memchr::memmem::find(inside, b"*/").map(|n| at + 2 + n + 2)
}

struct Scan<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Scan<'_> {
    /// Start and end (its semicolon) of the next statement; `None` at the end of the text.
    fn next_statement(&mut self, text: &str) -> Result<Option<(usize, usize)>, Trouble> {
        let broken = |at: usize, what: &str| Trouble::file(line_of(text, at), what.to_owned());
        let start = skip_blanks(self.bytes, self.at);
        // A byte order mark is no part of the first statement.
        let start =
            if text[..start.min(text.len())].is_empty() && text.starts_with('\u{feff}') { 3 } else { start };
        if start >= self.bytes.len() {
            return Ok(None);
        }
        let (mut at, mut depth) = (start, 0_u32);
        while let Some(&byte) = self.bytes.get(at) {
            match byte {
                b'\'' | b'"' => {
                    let inside = self.bytes.get(at + 1..).unwrap_or(&[]);
                    let end = memchr::memchr(byte, inside);
                    at += 1 + end.ok_or_else(|| broken(at, "the text that begins here has no end"))?;
                }
                b'/' if self.bytes.get(at + 1) == Some(&b'*') => {
                    at = comment_end(self.bytes, at)
                        .ok_or_else(|| broken(at, "the comment that begins here has no end"))?
                        - 1;
                }
                b'(' => depth += 1,
                b')' => {
                    depth = depth.checked_sub(1).ok_or_else(|| broken(at, "there is a `)` without a `(`"))?;
                }
                b';' if depth > 0 => return Err(broken(at, "there is a `(` without a `)` before this `;`")),
                b';' => {
                    self.at = at + 1;
                    return Ok(Some((start, at)));
                }
                _ => {}
            }
            at += 1;
        }
        Err(broken(start, "the statement that begins here has no `;`: the file was cut off"))
    }
}
