//! The fixed format of IGES: lines of 80 columns in sections, the directory, and parameters with their delimiters.

use std::sync::Arc;

use super::super::Trouble;

/// Columns of data in a line of parameters; the rest points back to the directory.
const DATA: usize = 64;
/// Parameters of one entity, at most.
const LONGEST: usize = 5_000_000;

/// An entity of the directory.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    /// Type number.
    pub kind: u32,
    /// First line of its parameters in their section, from 1.
    first: u32,
    /// Number of their lines.
    count: u32,
    /// Directory line of its transformation; 0 without one.
    pub matrix: u32,
}

/// An IGES file that has been indexed.
#[derive(Debug)]
pub struct Drawing {
    text: Arc<str>,
    /// In the order of the file.
    entries: Vec<Entry>,
    /// Start of every line of parameters in the text, and of the line's number in the file.
    parameters: Vec<(u32, u32)>,
    delimiters: [u8; 2],
    /// mm of a unit of the file; `None` when it names none.
    unit: Option<f64>,
}

/// A parameter.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Parameter {
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
    /// Left out.
    Default,
}

impl Drawing {
    /// Indexes a text.
    ///
    /// # Errors
    /// [`Trouble`] with the line.
    pub fn open(text: Arc<str>) -> Result<Drawing, Trouble> {
        let mut global = String::new();
        let mut directory: Vec<(usize, usize)> = Vec::new();
        let mut parameters = Vec::new();
        let mut ended = false;
        let mut start = 0;
        for (number, line) in text.split('\n').enumerate() {
            let at = start;
            start += line.len() + 1;
            let line = line.trim_end_matches('\r');
            if line.trim().is_empty() || ended {
                continue;
            }
            // Characters beyond ASCII stand in texts only; they make a line longer in bytes.
            let section = column(line, 72..73);
            match section {
                "S" => {}
                "G" => global.push_str(column(line, 0..72)),
                "D" => directory.push((at, number + 1)),
                "P" => parameters.push((place(at)?, place(number + 1)?)),
                "T" => ended = true,
                _ if number == 0 => {
                    let message =
                        "this is no IGES file in the fixed format: column 73 of its first line is no `S`";
                    return Err(Trouble::file(1, message));
                }
                _ => {
                    let message = format!("column 73 says `{section}` in place of S, G, D, P or T");
                    return Err(Trouble::file(number + 1, message));
                }
            }
        }
        if !ended {
            let message = "the file ends before its line T: it was cut off";
            return Err(Trouble::file(text.lines().count().max(1), message));
        }
        let entries = entries(&text, &directory)?;
        let (delimiters, unit) = header(&global)?;
        Ok(Drawing { text, entries, parameters, delimiters, unit })
    }

    /// The entities in the order of the file.
    pub(super) fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// mm of a unit of the file.
    pub(super) fn unit(&self) -> Option<f64> {
        self.unit
    }

    /// The index of the entity at a line of the directory.
    pub(super) fn index(&self, pointer: f64) -> Option<usize> {
        let whole = (1.0..1e9).contains(&pointer) && pointer.fract() == 0.0;
        let line = whole.then(|| crate::math::ceil_to_usize(pointer))?;
        (line % 2 == 1 && line / 2 < self.entries.len()).then_some(line / 2)
    }

    /// Bytes of an entity's parameters.
    pub(super) fn size(&self, index: usize) -> usize {
        self.entries.get(index).map_or(0, |e| e.count as usize * DATA)
    }

    /// The line of the file on which an entity's parameters start.
    pub(super) fn line(&self, index: usize) -> usize {
        let first = self.entries.get(index).map_or(0, |e| e.first as usize);
        first.checked_sub(1).and_then(|i| self.parameters.get(i)).map_or(1, |(_, line)| *line as usize)
    }

    /// An entity's parameters, its type number left out.
    pub(super) fn parameters(&self, index: usize) -> Result<Vec<Parameter>, Trouble> {
        let entry = self.entries.get(index).ok_or_else(|| Trouble::file(1, "there is no such entity"))?;
        let from = entry.first as usize;
        let lines =
            from.checked_sub(1).and_then(|f| self.parameters.get(f..f.checked_add(entry.count as usize)?));
        let Some(lines) = lines.filter(|l| !l.is_empty()) else {
            let message = format!("directory entry {} names parameters that are not there", 2 * index + 1);
            return Err(Trouble::file(1, message));
        };
        let mut text = String::with_capacity(lines.len() * DATA);
        for (start, _) in lines {
            let line = self.text.get(*start as usize..).and_then(|t| t.split('\n').next()).unwrap_or("");
            text.push_str(column(line.trim_end_matches('\r'), 0..DATA));
        }
        let mut parameters = split(&text, self.delimiters).map_err(|what| {
            Trouble::file(self.line(index), format!("directory entry {}: {what}", 2 * index + 1))
        })?;
        match parameters.first() {
            Some(Parameter::Number(kind)) if *kind == f64::from(entry.kind) => {
                parameters.remove(0);
                Ok(parameters)
            }
            _ => {
                let message = format!("these parameters are not those of an entity of type {}", entry.kind);
                Err(Trouble::file(self.line(index), message))
            }
        }
    }
}

fn place(n: usize) -> Result<u32, Trouble> {
    u32::try_from(n).map_err(|_| Trouble::file(1, "the file has more than 4 GB"))
}

/// Columns of a line, filled with nothing where it is short.
fn column(line: &str, range: core::ops::Range<usize>) -> &str {
    if line.is_ascii() {
        return line.get(range.start.min(line.len())..range.end.min(line.len())).unwrap_or("");
    }
    let byte = |n: usize| line.char_indices().nth(n).map_or(line.len(), |(i, _)| i);
    line.get(byte(range.start)..byte(range.end)).unwrap_or("")
}

fn entries(text: &str, directory: &[(usize, usize)]) -> Result<Vec<Entry>, Trouble> {
    let mut entries = Vec::with_capacity(directory.len() / 2);
    for pair in directory.chunks(2) {
        let [first, second] = pair else {
            let line = pair.first().map_or(1, |p| p.1);
            return Err(Trouble::file(line, "this directory entry has no second line"));
        };
        let field = |(start, number): &(usize, usize), n: usize| {
            let line = text.get(*start..).and_then(|t| t.split('\n').next()).unwrap_or("");
            let field = column(line, 8 * n..8 * n + 8).trim();
            let value = if field.is_empty() { Ok(0) } else { field.parse::<u32>() };
            // Attributes may be negative: pointers to definitions that are not followed here.
            value.or_else(|e| if field.starts_with('-') { Ok(0) } else { Err(e) }).map_err(|_| {
                Trouble::file(*number, format!("`{field}` in field {} of the directory is no number", n + 1))
            })
        };
        entries.push(Entry {
            kind: field(first, 0)?,
            first: field(first, 1)?,
            count: field(second, 3)?,
            matrix: field(first, 6)?,
        });
    }
    Ok(entries)
}

/// Delimiters and the unit in mm of the global section.
fn header(global: &str) -> Result<([u8; 2], Option<f64>), Trouble> {
    let bad = |what: &str| Trouble::file(1, format!("the global section {what}"));
    let delimiter = |text: &str, default: u8| match text.as_bytes() {
        [b'1', b'H', c, ..] => (*c, 3),
        _ => (default, 0),
    };
    let (parameter, used) = delimiter(global, b',');
    let rest = global.get(used..).unwrap_or("");
    let rest =
        rest.strip_prefix(char::from(parameter)).ok_or_else(|| bad("does not begin with its delimiters"))?;
    let (record, _) = delimiter(rest, b';');
    // From the start again: the two delimiters are fields 1 and 2, and cannot be split off by themselves.
    let tail = rest.get(delimiter(rest, b';').1..).unwrap_or("");
    let tail = tail.strip_prefix(char::from(parameter)).unwrap_or(tail);
    let fields = split(tail, [parameter, record]).map_err(|what| bad(&what))?;
    let field = |n: usize| fields.get(n - 3);
    let scale = match field(13) {
        Some(Parameter::Number(x)) if *x > 0.0 && x.is_finite() => *x,
        _ => 1.0,
    };
    let flag = match field(14) {
        Some(Parameter::Number(x)) => Some(*x),
        _ => None,
    };
    let name = match field(15) {
        Some(Parameter::Text(name)) => name.trim().to_ascii_uppercase(),
        _ => String::new(),
    };
    Ok(([parameter, record], unit_of(flag, &name).map(|mm| mm / scale)))
}

/// mm of the unit with this flag or name.
fn unit_of(flag: Option<f64>, name: &str) -> Option<f64> {
    const UNITS: [(f64, &[&str], f64); 10] = [
        (1.0, &["IN", "INCH"], 25.4),
        (2.0, &["MM"], 1.0),
        (4.0, &["FT"], 304.8),
        (5.0, &["MI"], 1_609_344.0),
        (6.0, &["M"], 1000.0),
        (7.0, &["KM"], 1_000_000.0),
        (8.0, &["MIL"], 0.0254),
        (9.0, &["UM"], 0.001),
        (10.0, &["CM"], 10.0),
        (11.0, &["UIN"], 0.000_025_4),
    ];
    let by_name = || UNITS.iter().find(|(_, names, _)| names.contains(&name));
    let row = match flag {
        Some(flag) if flag != 3.0 => UNITS.iter().find(|(f, ..)| *f == flag),
        _ => by_name(),
    };
    row.map(|(.., mm)| *mm)
}

/// The parameters up to the record's end.
fn split(text: &str, [parameter, record]: [u8; 2]) -> Result<Vec<Parameter>, String> {
    let bytes = text.as_bytes();
    let mut out = Vec::new();
    let mut at = 0;
    loop {
        while bytes.get(at) == Some(&b' ') {
            at += 1;
        }
        let digits = bytes.get(at..).unwrap_or(&[]).iter().take_while(|b| b.is_ascii_digit()).count();
        let value = if digits > 0 && bytes.get(at + digits) == Some(&b'H') {
            let length: usize = text.get(at..at + digits).and_then(|d| d.parse().ok()).unwrap_or(usize::MAX);
            let start = at + digits + 1;
            let rest = text.get(start..).unwrap_or("");
            let end = rest.char_indices().nth(length).map_or(rest.len(), |(i, _)| i);
            at = start + end;
            Parameter::Text(rest.get(..end).unwrap_or("").to_owned())
        } else {
            let rest = bytes.get(at..).unwrap_or(&[]);
            let length = rest.iter().take_while(|b| **b != parameter && **b != record).count();
            let word = text.get(at..at + length).unwrap_or("").trim();
            at += length;
            number(word)?
        };
        out.push(value);
        if out.len() > LONGEST {
            return Err(format!("it has more than {LONGEST} parameters"));
        }
        while bytes.get(at) == Some(&b' ') {
            at += 1;
        }
        match bytes.get(at) {
            Some(b) if *b == parameter => at += 1,
            Some(b) if *b == record => return Ok(out),
            Some(_) => return Err("a delimiter must follow a text".into()),
            None => return Err("there is no delimiter at its end".into()),
        }
    }
}

/// A number; Fortran's `D` counts as `E`. Anything else that no entity here needs is taken as left out.
fn number(word: &str) -> Result<Parameter, String> {
    if word.is_empty() {
        return Ok(Parameter::Default);
    }
    let plain = word.replace(['D', 'd'], "E");
    match plain.parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(Parameter::Number(x)),
        _ => Err(format!("`{word}` is no number")),
    }
}
