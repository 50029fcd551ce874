//! The matrix for people.

use core::fmt::Write as _;

use super::{Matrix, RestsOn, Row, Verdict};

/// Lines of a row that are shown.
const MOST_LINES: usize = 6;

/// The matrix as text.
#[must_use]
pub fn text(matrix: &Matrix) -> String {
    let mut out = format!(
        "{}: {}\nread back as {}; facts of the post: {} ({})\n",
        matrix.post, matrix.title, matrix.control, matrix.confidence, matrix.basis
    );
    if matrix.units == "inch" {
        out += "programs in inches\n";
    }
    let mut area = "";
    for row in &matrix.rows {
        if row.area != area {
            area = row.area;
            // Writing to a String cannot fail.
            let _ = writeln!(out, "\n{area}");
        }
        row_text(&mut out, row);
    }
    out + &summary(matrix)
}

fn row_text(out: &mut String, row: &Row) {
    let _ = writeln!(out, "  {:9}  {}", word(row.verdict), row.title);
    let shown: Vec<&String> = row.emitted.iter().filter(|l| !l.is_empty()).collect();
    for line in shown.iter().take(MOST_LINES) {
        let _ = writeln!(out, "             | {line}");
    }
    if shown.len() > MOST_LINES {
        let _ = writeln!(out, "             | … {} more lines", shown.len() - MOST_LINES);
    }
    let _ = writeln!(out, "             {} ({})", row.remark, rests(row.rests_on));
}

/// One word for a verdict.
#[must_use]
pub const fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Right => "right",
        Verdict::Expressed => "expressed",
        Verdict::Refused => "refused",
        Verdict::NotApplicable => "-",
        Verdict::Wrong => "WRONG",
    }
}

const fn rests(on: RestsOn) -> &'static str {
    match on {
        RestsOn::ReadBack => "read back",
        RestsOn::Spelling => "spelling",
        RestsOn::Message => "compiler",
    }
}

fn summary(matrix: &Matrix) -> String {
    let count = |verdict| matrix.rows.iter().filter(|r| r.verdict == verdict).count();
    format!(
        "\n{} rows: {} right, {} expressed by other means, {} refused, {} not applicable, {} wrong\n",
        matrix.rows.len(),
        count(Verdict::Right),
        count(Verdict::Expressed),
        count(Verdict::Refused),
        count(Verdict::NotApplicable),
        count(Verdict::Wrong),
    )
}
