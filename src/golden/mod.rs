//! Golden-file tests for part programs: what is built, and how it differs from what was accepted before.
//!
//! This is the part without files and terminal: a [`Plan`] of builds ([`plan`]), their [`Outcome`] against the golden
//! texts ([`check`]), and reports for people and programs ([`report`]).

use std::collections::BTreeSet;

use crate::clfile;
use crate::diag::{Diagnostic, Severity};
use crate::driver::{self, Build, Output};
use crate::motion_diff::{self, Comparison, Tolerance};
use crate::readback::{MachineSetup, Rotary};
use crate::source::FileProvider;

pub mod junit;
pub mod names;
pub mod report;
pub mod sidecar;
#[cfg(test)]
mod tests;
pub mod text;

pub use sidecar::{Sidecar, Variant};

/// A program's test file, as read.
#[derive(Debug, Clone, Copy)]
pub struct TestFile<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its text.
    pub text: &'a str,
    /// What it says.
    pub sidecar: &'a Sidecar,
}

/// One build of a program: a variant with all its posts.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Name of the variant; empty for the program as it is.
    pub variant: String,
    /// What to build.
    pub options: driver::Options,
    /// Codes that must come, when the test says so.
    pub diagnostics: Option<Vec<String>>,
}

/// The builds of a program; its test file names posts relative to itself.
#[must_use]
pub fn plan(sidecar: &Sidecar, program: &str) -> Vec<Plan> {
    let own = Variant::default();
    let variants = if sidecar.variant.is_empty() { core::slice::from_ref(&own) } else { &sidecar.variant };
    variants.iter().map(|variant| one_plan(sidecar, variant, program)).collect()
}

fn one_plan(sidecar: &Sidecar, variant: &Variant, program: &str) -> Plan {
    let mut defines = sidecar.define.clone();
    defines.extend(variant.define.clone());
    let mut post_set = sidecar.post_set.clone();
    post_set.extend(variant.post_set.clone());
    let posts = variant.posts.as_ref().unwrap_or(&sidecar.posts);
    let options = driver::Options {
        defines: defines.into_iter().collect(),
        posts: posts.iter().map(|post| names::beside(program, post)).collect(),
        post_set: post_set.into_iter().collect(),
        // A name that is none has been told with the file.
        cl: clfile::Options {
            producer: sidecar.producer.as_deref().and_then(|name| clfile::producer_named(name).ok()),
            lenient: sidecar.lenient,
            ..clfile::Options::default()
        },
        card_columns: sidecar.card_columns,
        ..driver::Options::default()
    };
    let diagnostics = variant.diagnostics.clone().or_else(|| sidecar.diagnostics.clone());
    Plan { variant: variant.name.clone(), options, diagnostics }
}

/// A planned build that has been made.
#[derive(Debug)]
pub struct Made {
    /// The plan.
    pub plan: Plan,
    /// What came of it.
    pub build: Build,
}

/// Builds everything of a program; what is wrong with what its test file gives is shown there.
#[must_use]
pub fn make(main: &str, files: &dyn FileProvider, test: Option<TestFile<'_>>) -> Vec<Made> {
    let own = Sidecar::default();
    let plans = plan(test.map_or(&own, |t| t.sidecar), main);
    let one = |(index, plan): (usize, Plan)| {
        let mut build = driver::build(main, files, &plan.options);
        if let Some(test) = test.filter(|_| !build.diagnostics.is_empty()) {
            let file = build.sources.add(test.name, test.text);
            sidecar::locate(&mut build, (test.sidecar, test.text, file), main, index);
        }
        Made { plan, build }
    };
    plans.into_iter().enumerate().map(one).collect()
}

/// What a test found.
#[derive(Debug)]
pub enum Verdict {
    /// As accepted.
    Same,
    /// Nothing has been accepted yet.
    New {
        /// What would be accepted.
        text: String,
    },
    /// Another text than the accepted one.
    Different {
        /// The accepted text.
        old: String,
        /// The text now.
        text: String,
        /// How the motion differs, where both texts could be executed as programs of this control.
        motion: Option<Box<Comparison>>,
    },
    /// The program has errors that the test does not expect.
    Errors,
    /// Other messages than the test expects.
    Messages {
        /// Expected and did not come.
        missing: Vec<String>,
        /// Came and are not expected.
        surplus: Vec<String>,
    },
    /// A golden file that no test makes.
    Orphan,
}

/// One test with its verdict.
#[derive(Debug)]
pub struct Outcome {
    /// The program, as found.
    pub program: String,
    /// The variant; empty for the program as it is.
    pub variant: String,
    /// The post, or `messages`.
    pub post: String,
    /// The golden file; empty for tests of messages.
    pub golden: String,
    /// What was found.
    pub verdict: Verdict,
}

impl Outcome {
    /// `parts/plate.apt [long] fanuc`
    #[must_use]
    pub fn name(&self) -> String {
        names::test(&self.program, &self.variant, &self.post)
    }
    /// Whether the test holds.
    #[must_use]
    pub fn passed(&self) -> bool {
        matches!(self.verdict, Verdict::Same)
    }
}

/// The name of tests of messages, in place of a post.
pub const MESSAGES: &str = "messages";

/// The verdicts of one build. `golden` gives the accepted text by the name of its file.
#[must_use]
pub fn check(program: &str, made: &Made, golden: &dyn Fn(&str) -> Option<String>) -> Vec<Outcome> {
    let outcome = |post: &str, golden: String, verdict: Verdict| Outcome {
        program: program.to_owned(),
        variant: made.plan.variant.clone(),
        post: post.to_owned(),
        golden,
        verdict,
    };
    let mut outcomes = Vec::new();
    match &made.plan.diagnostics {
        Some(expected) => {
            outcomes.push(outcome(MESSAGES, String::new(), messages(expected, &made.build.diagnostics)));
        }
        None if made.build.has_errors() => {
            return vec![outcome(MESSAGES, String::new(), Verdict::Errors)];
        }
        None => {}
    }
    for output in &made.build.outputs {
        let Some(proven) = &output.proven else { continue };
        let file = names::golden(program, &made.plan.variant, &output.post, &output.extension);
        let verdict = against(golden(&file), proven.text(), output);
        outcomes.push(outcome(&output.post, file, verdict));
    }
    outcomes
}

/// Errors and warnings must be exactly those expected; notes only where they are.
fn messages(expected: &[String], diagnostics: &[Diagnostic]) -> Verdict {
    let wanted: BTreeSet<String> = expected.iter().map(|c| c.to_uppercase()).collect();
    let came: BTreeSet<String> = diagnostics.iter().map(|d| d.code.id.to_owned()).collect();
    let serious: BTreeSet<String> =
        diagnostics.iter().filter(|d| d.severity != Severity::Note).map(|d| d.code.id.to_owned()).collect();
    let missing: Vec<String> = wanted.difference(&came).cloned().collect();
    let surplus: Vec<String> = serious.difference(&wanted).cloned().collect();
    if missing.is_empty() && surplus.is_empty() {
        Verdict::Same
    } else {
        Verdict::Messages { missing, surplus }
    }
}

fn against(old: Option<String>, new: &str, output: &Output) -> Verdict {
    let text = new.to_owned();
    match old {
        None => Verdict::New { text },
        Some(old) if old == new => Verdict::Same,
        Some(old) => {
            let motion = motion(&old, new, output).map(Box::new);
            Verdict::Different { old, text, motion }
        }
    }
}

fn motion(old: &str, new: &str, output: &Output) -> Option<Comparison> {
    let control = &output.proven.as_ref()?.certificate().control;
    let rotary = output.target.as_ref().and_then(|t| t.capabilities.rotary);
    let setup = MachineSetup {
        rotary: rotary.map(|r| Rotary { letter: r.letter, reversed: r.reversed }),
        ..MachineSetup::default()
    };
    motion_diff::compare([old.as_bytes(), new.as_bytes()], control, &setup, Tolerance::default()).ok()
}
