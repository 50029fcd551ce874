//! `partwright post selftest`: what a post makes of everything that controls do differently.
//!
//! Every [`rows::ROWS`] row is a small program of its own ([`sheet`]), lowered and written for the post, executed by the
//! interpreter of its control and proven like any other ([`trial`]), then judged by what the machine did or by how it is
//! spelled ([`judge`]). A row never judges by the post's data: a wrong word in a post is a wrong row.

use std::collections::BTreeSet;

use serde::Serialize;

use crate::diag::{Diagnostic, codes};
use crate::post::Dialect;
use crate::units::LengthUnit;

mod judge;
pub mod print;
mod rows;
mod sheet;
mod trial;

/// Version of the JSON form; minor steps only add members.
pub const VERSION: &str = "1.1";

/// What a post makes of every row.
#[derive(Debug, Serialize)]
pub struct Matrix {
    /// Always `partwright-selftest`.
    pub schema: &'static str,
    /// [`VERSION`].
    pub version: &'static str,
    /// The post.
    pub post: String,
    /// Control and series.
    pub title: String,
    /// The control that read the rows back.
    pub control: String,
    /// How sure the post's facts are.
    pub confidence: String,
    /// What they rest on.
    pub basis: String,
    /// Unit of the programs: `mm` or `inch`.
    pub units: &'static str,
    /// The rows in order.
    pub rows: Vec<Row>,
}

impl Matrix {
    /// Whether no row is wrong.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.rows.iter().all(|row| row.verdict != Verdict::Wrong)
    }
}

/// A row with its verdict.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Row {
    /// What it is about: `dwell`, `arcs` …
    pub area: &'static str,
    /// What it tries.
    pub title: &'static str,
    /// The lines that were emitted for it; empty when the program was refused.
    pub emitted: Vec<String>,
    /// What is thought of it.
    pub verdict: Verdict,
    /// Why, with the numbers.
    pub remark: String,
    /// What the verdict rests on.
    pub rests_on: RestsOn,
}

/// Verdicts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The control does what was asked, in its own words.
    Right,
    /// The control has no words for it; what it can do was used instead, and proven.
    Expressed,
    /// Refused with a coded message, because the control cannot do it.
    Refused,
    /// The post does not apply here.
    NotApplicable,
    /// Something else than what was asked, or no proof.
    Wrong,
}

/// What a verdict rests on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum RestsOn {
    /// What the interpreter of the control did with the lines, and the proof of the whole program.
    ReadBack,
    /// The spelling of the lines, in a program that was read back and proven.
    Spelling,
    /// The message of the compiler.
    Message,
}

/// What comes out wrong, as errors of the post that was asked for as `name`: each fault once, with the first row that
/// has it and how many do.
#[must_use]
pub fn findings(dialect: &Dialect, name: &str) -> Vec<Diagnostic> {
    let metric = run(dialect, LengthUnit::Millimetre);
    let inches = run(dialect, LengthUnit::Inch);
    let wrong = |row: &&Row| row.verdict == Verdict::Wrong;
    let known: BTreeSet<&str> = metric.rows.iter().filter(wrong).map(|row| row.title).collect();
    // What is wrong in both is told for mm.
    let in_inches = inches.rows.iter().filter(wrong).filter(|row| !known.contains(row.title));
    let mut findings = told(metric.rows.iter().filter(wrong), "", name);
    findings.extend(told(in_inches, " in inches", &format!("{name} --inch")));
    findings
}

/// The faults of rows, each once; `units` and `command` are for the message.
fn told<'a>(rows: impl Iterator<Item = &'a Row>, units: &str, command: &str) -> Vec<Diagnostic> {
    let mut found: Vec<(&str, &str, u32)> = Vec::new();
    for row in rows {
        for fault in faults(&row.remark) {
            match found.iter_mut().find(|(known, ..)| *known == fault) {
                Some((_, _, rows)) => *rows += 1,
                None => found.push((fault, row.title, 1)),
            }
        }
    }
    let finding = |(fault, title, rows): (&str, &str, u32)| {
        let more = match rows - 1 {
            0 => String::new(),
            1 => ", and so does another".to_owned(),
            n => format!(", and so do {n} others"),
        };
        let message = format!("the row `{title}` of the selftest comes out wrong{units}{more}: {fault}");
        Diagnostic::global(&codes::tools::INEXPRESSIBLE, message)
            .help(format!("`partwright post selftest {command}` shows its lines"))
    };
    found.into_iter().map(finding).collect()
}

/// The faults of a row without their lines.
fn faults(remark: &str) -> Vec<&str> {
    let coded = |part: &str| part.len() > 5 && part.starts_with('E') && part.as_bytes().get(5) == Some(&b':');
    if !coded(remark) {
        return vec![remark];
    }
    let without_line = |part| match str::split_once(part, " program: ") {
        Some((before, fault)) if before.contains(": line ") => fault,
        _ => part,
    };
    let mut faults: Vec<&str> = remark.split("; ").filter(|p| coded(p)).map(without_line).collect();
    let mut known = BTreeSet::new();
    faults.retain(|fault| known.insert(*fault));
    faults
}

/// Tries every row, in programs of this unit; a row about inches is in inches always.
#[must_use]
pub fn run(dialect: &Dialect, units: LengthUnit) -> Matrix {
    Matrix {
        schema: "partwright-selftest",
        version: VERSION,
        post: dialect.name().to_owned(),
        title: dialect.title().to_owned(),
        control: dialect.control().to_owned(),
        confidence: dialect.confidence().to_owned(),
        basis: dialect.basis().to_owned(),
        units: match units {
            LengthUnit::Millimetre => "mm",
            LengthUnit::Inch => "inch",
        },
        rows: rows::ROWS.iter().map(|row| judge::row(row, dialect, units)).collect(),
    }
}
