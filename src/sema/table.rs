//! `MOTION/ TABLE`: lifts from a CSV file.

use crate::diag::Diagnostic;
use crate::diag::codes::cam as codes;
use crate::source::{FileId, Span};
use crate::units::{Dim, Quantity, Unit, parse_unit};

use super::include::unreadable_file;
use super::matched::Matched;
use super::value::MotionSource;
use super::{Analyser, limits};

/// Where a column lies and what its numbers are.
struct Column {
    index: usize,
    unit: Unit,
}

/// Trouble with a table: the line it is on, and what.
struct Trouble {
    line: u64,
    message: String,
    help: Option<&'static str>,
}

const HEADING: &str = "the first line names the columns and their units: `angle[deg],lift[mm]`";

impl Analyser<'_> {
    pub(super) fn table(&mut self, m: &Matched) -> Option<MotionSource> {
        let path = m.text("file")?.to_owned();
        let at = m.span("file");
        let from = self.sources.file(at.file).name.clone();
        let (name, text) = match self.files.read(Some(&from), &path) {
            Ok(read) => read,
            Err(error) => {
                let problem = unreadable_file(&path, &error, at);
                self.report(problem);
                return None;
            }
        };
        let file = self.sources.add(name, text.as_str());
        match read_table(&text) {
            Ok((rows, dim)) => Some(MotionSource::Table { rows, dim, periodic: m.get("periodic").is_some() }),
            Err(trouble) => {
                self.table_trouble(&path, file, at, &trouble);
                None
            }
        }
    }

    fn table_trouble(&mut self, path: &str, file: FileId, at: Span, trouble: &Trouble) {
        let message = format!("{path}, line {}: {}", trouble.line, trouble.message);
        let mut problem = Diagnostic::new(&codes::TABLE, at, message);
        let source = self.sources.file(file);
        let line = usize::try_from(trouble.line).unwrap_or(1);
        if let Some(start) = source.line_start(line) {
            let start = start as usize;
            let end =
                source.text.get(start..).and_then(|t| t.find('\n')).map_or(source.text.len(), |n| start + n);
            problem = problem.label(Span::new(file, start, end), "this line");
        }
        if let Some(help) = trouble.help {
            problem = problem.help(help);
        }
        self.report(problem);
    }
}

/// Rows of cam angle in degrees and lift in base units, with the lift's dimension.
fn read_table(text: &str) -> Result<(Vec<(f64, f64)>, Dim), Trouble> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .flexible(true)
        .from_reader(text.as_bytes());
    let mut columns: Option<(Column, Column)> = None;
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| Trouble {
            line: e.position().map_or(1, csv::Position::line),
            message: "this is not CSV".into(),
            help: None,
        })?;
        let line = record.position().map_or(1, csv::Position::line);
        let Some((angle, lift)) = &columns else {
            columns =
                Some(heading(&record).map_err(|message| Trouble { line, message, help: Some(HEADING) })?);
            continue;
        };
        if rows.len() >= limits::TABLE_ROWS {
            let message = format!("the table has more than {} rows", limits::TABLE_ROWS);
            return Err(Trouble { line, message, help: None });
        }
        let value =
            |column: &Column| cell(&record, column).map_err(|message| Trouble { line, message, help: None });
        rows.push((value(angle)?, value(lift)?));
    }
    match columns {
        Some((_, lift)) => Ok((rows, lift.unit.dim)),
        None => Err(Trouble { line: 1, message: "the file is empty".into(), help: Some(HEADING) }),
    }
}

fn cell(record: &csv::StringRecord, column: &Column) -> Result<f64, String> {
    let Some(text) = record.get(column.index) else {
        return Err(format!("there is no column {}", column.index + 1));
    };
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(Quantity::of(value, column.unit).value),
        _ => Err(format!("`{text}` in column {} is not a number", column.index + 1)),
    }
}

/// The columns of angle and lift: by name, else the first two.
fn heading(record: &csv::StringRecord) -> Result<(Column, Column), String> {
    if record.iter().all(|field| field.parse::<f64>().is_ok()) {
        return Err("a heading is missing".into());
    }
    let named = |names: &[&str]| {
        record.iter().position(|f| names.contains(&split_heading(f).0.to_ascii_lowercase().as_str()))
    };
    let angle = named(&["angle", "theta", "cam angle", "cam_angle"]).unwrap_or(0);
    let lift = named(&["lift", "s", "displacement"]).unwrap_or(1);
    if angle == lift || lift >= record.len() {
        return Err("the heading names no two columns".into());
    }
    let degrees = Unit { factor: 1.0, dim: Dim::ANGLE };
    let bare = Unit { factor: 1.0, dim: Dim::NONE };
    let angle = column(record, angle, degrees)?;
    let lift = column(record, lift, bare)?;
    if angle.unit.dim != Dim::ANGLE {
        return Err(format!("the cam angle is no {}", angle.unit.dim.name()));
    }
    if ![Dim::NONE, Dim::LENGTH, Dim::ANGLE].contains(&lift.unit.dim) {
        return Err(format!("a lift is a length or an angle, not a {}", lift.unit.dim.name()));
    }
    Ok((angle, lift))
}

fn column(record: &csv::StringRecord, index: usize, default: Unit) -> Result<Column, String> {
    let field = record.get(index).unwrap_or("");
    let unit = match split_heading(field).1 {
        Some(unit) => parse_unit(unit).ok_or_else(|| format!("there is no unit `{unit}`"))?,
        None => default,
    };
    Ok(Column { index, unit })
}

/// Name and unit of `lift[mm]` or `lift (mm)`.
fn split_heading(field: &str) -> (&str, Option<&str>) {
    let Some(open) = field.find(['[', '(']) else { return (field.trim(), None) };
    let (name, rest) = field.split_at(open);
    let unit = rest.get(1..).unwrap_or("").trim_end_matches([']', ')']);
    (name.trim(), Some(unit.trim()))
}
