//! What `partwright test` prints: for people, as JSON, as JUnit XML.

use core::fmt::Write as _;

use serde::Serialize;

use super::{Outcome, Verdict, text};
use crate::motion_diff::{Comparison, print};

/// Version of the JSON form; minor steps only add members.
const VERSION: &str = "1.0";

/// A run: all tests in order, and the programs that were left out with the reason.
#[derive(Debug, Default)]
pub struct Run {
    /// Tests.
    pub outcomes: Vec<Outcome>,
    /// Messages of builds, by the name of the program and variant, rendered.
    pub messages: Vec<(String, String)>,
    /// Programs that are no tests, and why.
    pub skipped: Vec<(String, String)>,
    /// Whether what differs has been accepted.
    pub accepted: bool,
}

impl Run {
    /// Whether every test holds.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.outcomes.iter().all(Outcome::passed)
    }
    fn messages_of(&self, outcome: &Outcome) -> &str {
        let name = super::names::test(&outcome.program, &outcome.variant, "");
        self.messages.iter().find(|(n, _)| *n == name).map_or("", |(_, text)| text)
    }
}

/// One word for a verdict.
pub(super) fn word(verdict: &Verdict) -> &'static str {
    match verdict {
        Verdict::Same => "ok",
        Verdict::New { .. } => "new",
        Verdict::Different { .. } => "different",
        Verdict::Errors => "errors",
        Verdict::Messages { .. } => "messages",
        Verdict::Orphan => "orphan",
    }
}

/// Why a test does not hold; several lines, empty for one that does.
#[must_use]
pub fn reason(run: &Run, outcome: &Outcome) -> String {
    match &outcome.verdict {
        Verdict::Same => String::new(),
        Verdict::New { text } => {
            format!("{} is not there yet: {} lines to accept\n", outcome.golden, text.lines().count())
        }
        Verdict::Different { old, text, motion } => {
            let mut out = format!("{}\n{}", outcome.golden, text::difference(old, text));
            out.push_str(&motion_text(motion.as_deref()));
            out
        }
        Verdict::Errors => run.messages_of(outcome).to_owned(),
        Verdict::Messages { missing, surplus } => {
            let mut out = String::new();
            if !missing.is_empty() {
                let _ = writeln!(out, "expected and did not come: {}", missing.join(", "));
            }
            if !surplus.is_empty() {
                let _ = writeln!(out, "came and is not expected: {}", surplus.join(", "));
            }
            out + run.messages_of(outcome)
        }
        Verdict::Orphan => format!("{}: no test makes this file\n", outcome.golden),
    }
}

fn motion_text(motion: Option<&Comparison>) -> String {
    let Some(motion) = motion else { return String::new() };
    if let Some(fault) = motion.faults.iter().flatten().next() {
        return format!(
            "motion: not compared: the control complains of line {}: {}\n",
            fault.line, fault.message
        );
    }
    if motion.is_same() {
        return "motion: the same\n".to_owned();
    }
    print::text(motion, print::Names { a: "the golden file", b: "the new program" })
}

/// For people.
#[must_use]
pub fn human(run: &Run) -> String {
    let mut out = String::new();
    for outcome in &run.outcomes {
        let _ = writeln!(out, "{:9} {}", word(&outcome.verdict), outcome.name());
        for line in reason(run, outcome).lines() {
            let _ = writeln!(out, "          {line}");
        }
    }
    for (program, why) in &run.skipped {
        let _ = writeln!(out, "{:9} {program}: {why}", "skipped");
    }
    out + &summary(run)
}

fn summary(run: &Run) -> String {
    let passed = run.outcomes.iter().filter(|o| o.passed()).count();
    let words = ["new", "different", "errors", "messages", "orphan"];
    let counted = words.iter().filter_map(|w| {
        let count = run.outcomes.iter().filter(|o| word(&o.verdict) == *w).count();
        (count > 0).then(|| format!("{count} {w}"))
    });
    let parts: Vec<String> = core::iter::once(format!("{passed} ok")).chain(counted).collect();
    let accepts =
        |o: &Outcome| matches!(o.verdict, Verdict::New { .. } | Verdict::Different { .. } | Verdict::Orphan);
    let hint = match (run.accepted, run.outcomes.iter().any(accepts)) {
        (true, true) => "; golden files were brought up to date",
        (false, true) => "; --accept takes what is new and different and removes orphans",
        _ => "",
    };
    format!("{}{hint}\n", parts.join(", "))
}

#[derive(Serialize)]
struct JsonRun<'a> {
    schema: &'static str,
    version: &'static str,
    partwright: &'static str,
    passed: bool,
    accepted: bool,
    tests: Vec<JsonTest<'a>>,
    skipped: Vec<JsonSkipped<'a>>,
}

#[derive(Serialize)]
struct JsonTest<'a> {
    program: &'a str,
    variant: &'a str,
    post: &'a str,
    golden: &'a str,
    verdict: &'static str,
    reason: String,
    motion: Option<&'a Comparison>,
}

#[derive(Serialize)]
struct JsonSkipped<'a> {
    program: &'a str,
    reason: &'a str,
}

fn json_test<'a>(run: &Run, outcome: &'a Outcome) -> JsonTest<'a> {
    JsonTest {
        program: &outcome.program,
        variant: &outcome.variant,
        post: &outcome.post,
        golden: &outcome.golden,
        verdict: word(&outcome.verdict),
        reason: reason(run, outcome),
        motion: match &outcome.verdict {
            Verdict::Different { motion, .. } => motion.as_deref(),
            _ => None,
        },
    }
}

/// As JSON.
#[must_use]
pub fn json(run: &Run) -> String {
    let run = JsonRun {
        schema: "partwright-test",
        version: VERSION,
        partwright: env!("CARGO_PKG_VERSION"),
        passed: run.passed(),
        accepted: run.accepted,
        tests: run.outcomes.iter().map(|o| json_test(run, o)).collect(),
        skipped: run.skipped.iter().map(|(program, reason)| JsonSkipped { program, reason }).collect(),
    };
    serde_json::to_string_pretty(&run).unwrap_or_default() + "\n"
}
