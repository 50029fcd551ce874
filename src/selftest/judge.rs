//! Verdicts on rows.

use super::rows::Try;
use super::trial::Trial;
use super::{RestsOn, Row, Verdict};
use crate::diag::codes::{lowering, post as post_codes};
use crate::diag::{Code, Severity};
use crate::post::Dialect;
use crate::units::LengthUnit;

/// Codes with which a post may refuse what its control cannot do.
const REFUSALS: &[&Code] =
    &[&post_codes::WORD_RANGE, &post_codes::LINE_TOO_LONG, &post_codes::MACHINE_OPTION];

/// What a row finds in a program that was proven.
pub(super) struct Finding {
    pub verdict: Verdict,
    pub remark: String,
    pub rests_on: RestsOn,
}

impl Finding {
    pub fn right(remark: impl Into<String>) -> Finding {
        Finding { verdict: Verdict::Right, remark: remark.into(), rests_on: RestsOn::ReadBack }
    }
    pub fn expressed(remark: impl Into<String>) -> Finding {
        Finding { verdict: Verdict::Expressed, ..Finding::right(remark) }
    }
    /// What the control cannot do, with the reason.
    pub fn not_applicable(remark: impl Into<String>) -> Finding {
        Finding { verdict: Verdict::NotApplicable, ..Finding::right(remark) }
    }
    pub fn wrong(remark: impl Into<String>) -> Finding {
        Finding { verdict: Verdict::Wrong, ..Finding::right(remark) }
    }
    /// It was judged by how it is spelled.
    pub fn by_spelling(self) -> Finding {
        Finding { rests_on: RestsOn::Spelling, ..self }
    }
}

/// Tries and judges a row in a program of this unit.
pub(super) fn row(row: &Try, dialect: &Dialect, units: LengthUnit) -> Row {
    let mut sheet = (row.program)();
    if units == LengthUnit::Inch {
        // Lengths of CL data are mm whatever the program's unit.
        sheet.cl.units = units;
    }
    if sheet.rotary && !dialect.spec().rotary.enabled.of(sheet.cl.units) {
        return finished(
            row,
            Vec::new(),
            Finding {
                verdict: Verdict::NotApplicable,
                remark: "the control has no rotary table".to_owned(),
                rests_on: RestsOn::Message,
            },
        );
    }
    let trial = Trial::of(&sheet, dialect);
    let finding = if trial.proven { with_notes((row.judge)(&trial), &trial) } else { not_proven(&trial) };
    let emitted = if row.whole { trial.text.clone() } else { trial.lines() };
    finished(row, emitted, finding)
}

fn finished(row: &Try, emitted: Vec<String>, finding: Finding) -> Row {
    Row {
        area: row.area,
        title: row.title,
        emitted,
        verdict: finding.verdict,
        remark: finding.remark,
        rests_on: finding.rests_on,
    }
}

/// What the compiler had to do otherwise belongs to the remark.
fn with_notes(finding: Finding, trial: &Trial) -> Finding {
    let mut notes: Vec<String> = trial
        .messages
        .iter()
        .filter(|d| d.severity == Severity::Note && d.code.id.starts_with("N06"))
        .map(|d| format!("{}: {}", d.code.id, d.message))
        .collect();
    notes.dedup();
    let verdict = match finding.verdict {
        Verdict::Right if !notes.is_empty() => Verdict::Expressed,
        other => other,
    };
    let remark = core::iter::once(finding.remark).chain(notes).collect::<Vec<_>>().join("; ");
    Finding { verdict, remark, ..finding }
}

/// A refusal that names what the control cannot do is honest; everything else is a fault of the post.
fn not_proven(trial: &Trial) -> Finding {
    let errors: Vec<String> = trial.errors().map(|d| format!("{}: {}", d.code.id, d.message)).collect();
    let honest = |code: &Code| lowering::ALL.iter().chain(REFUSALS).any(|c| c.id == code.id);
    let refused = trial.text.is_empty() && !errors.is_empty() && trial.errors().all(|d| honest(d.code));
    let verdict = if refused { Verdict::Refused } else { Verdict::Wrong };
    let remark = if errors.is_empty() { "no program and no reason".to_owned() } else { errors.join("; ") };
    Finding { verdict, remark, rests_on: RestsOn::Message }
}
