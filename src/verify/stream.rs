//! Proof part by part, for programs that are longer than memory should hold.
//!
//! The interpreter runs over all parts without a break, so a line is executed in the state that all lines before it made.
//! Every part passes the checks of a whole program; what is in force at its start comes from the part before. Contours need
//! a whole program and are not proven here.

use sha2::{Digest, Sha256};

use super::certificate::{Certificate, Moves, OperationProof, TIME_MODEL, Time, VERSION};
use super::finding::{Finding, Reporter, Text};
use super::plan::{self, Context, InForce, Lines, Orders};
use super::{ACCURACY, Case, Emitted, Proven, check, issue, placed};
use crate::cl::{Cl, Record, RecordKind};
use crate::diag::Sink;
use crate::diag::codes::verification as codes;
use crate::geom::Point3;
use crate::readback::{self, Interpreter, MachineSetup, Needs, Trace};
use crate::target::TargetProgram;

/// A proof under way.
#[derive(Debug)]
pub struct Stream<'s> {
    interpreter: Interpreter<'s>,
    needs: Needs,
    control: String,
    post: String,
    context: (Context, usize),
    in_force: InForce,
    at: Option<Point3>,
    /// The same as the CL data have it.
    asked_at: Option<Point3>,
    moves: Moves,
    time: Time,
    digest: Sha256,
    bytes: u64,
    lines: u32,
    text: String,
    failed: bool,
}

/// The machine as a lowered program declares it.
#[must_use]
pub fn setup(target: &TargetProgram) -> MachineSetup {
    super::setup(target)
}

/// Reports a control that nobody can read.
pub fn unknown_control(unknown: &readback::UnknownControl, sink: &mut Sink) {
    super::finding::unknown_control(&unknown.to_string(), sink);
}

impl<'s> Stream<'s> {
    /// A proof of a program for this control.
    ///
    /// # Errors
    /// When no control has this name.
    pub fn new(control: &str, post: &str, setup: &'s MachineSetup) -> Result<Self, readback::UnknownControl> {
        let needs = readback::needs(control)?;
        Ok(Stream {
            interpreter: Interpreter::new(control, setup)?,
            needs,
            control: control.to_owned(),
            post: post.to_owned(),
            context: (Context::START, 0),
            in_force: InForce::default(),
            at: None,
            asked_at: None,
            moves: Moves::default(),
            time: Time { model: TIME_MODEL, ..Time::default() },
            digest: Sha256::new(),
            bytes: 0,
            lines: 0,
            text: String::new(),
            failed: false,
        })
    }

    /// The next part: its text, and the lines of its blocks counted from the start of the program. Says whether it is
    /// proven; `last` ends the program.
    pub fn part(
        &mut self,
        cl: &Cl,
        target: &TargetProgram,
        emitted: &Emitted,
        last: bool,
        sink: &mut Sink,
    ) -> bool {
        let mut trace = Trace::default();
        for line in emitted.text.as_bytes().split_inclusive(|&c| c == b'\n') {
            self.interpreter.line(line, &mut trace);
            self.lines = self.lines.saturating_add(1);
        }
        if last {
            self.interpreter.finish(&mut trace);
        }
        self.digest.update(emitted.text.as_bytes());
        self.bytes += emitted.text.len() as u64;
        let lines = Lines::new(&emitted.lines);
        let contexts = plan::contexts_from(target, &mut self.context);
        let orders = Orders::after(cl, &mut self.in_force);
        let written = plan::written(cl);
        let moves = placed(&trace, &lines);
        let happenings = super::happenings(&trace, &lines);
        let spans = super::spans(cl, target, &happenings);
        let case = Case {
            cl,
            target,
            contexts: &contexts,
            orders: &orders,
            needs: self.needs,
            moves: &moves,
            written: &written,
            happenings: &happenings,
            spans: &spans,
            start: self.asked_at,
        };
        let (mut findings, _) = check(&case, &trace, &lines, &emitted.lines, self.at);
        if contours(cl) {
            let text = Text::default().words("a contour can only be proven in a whole program");
            findings.push(Finding::new(&codes::NOT_FOLLOWED, 0, None, text));
        }
        issue::count_moves(&case, &mut self.moves);
        issue::add_time(&case, &trace, &mut self.time);
        self.asked_at = cl.records.iter().rev().find_map(point).or(self.asked_at);
        self.at = moves.last().map(|m| m.cut.end()).or(self.at);
        let mut reporter = Reporter::new(cl, target, sink);
        findings.iter().for_each(|finding| reporter.report(finding));
        self.failed |= !reporter.finish();
        if !self.failed {
            self.text.push_str(&emitted.text);
        }
        !self.failed
    }

    /// The program, when every part of it is proven.
    #[must_use]
    pub fn finish(self, operations: Vec<OperationProof>) -> Option<Proven> {
        if self.failed {
            return None;
        }
        let certificate = Certificate {
            version: VERSION,
            post: self.post,
            control: self.control,
            digest: issue::hexadecimal(&self.digest.finalize()),
            bytes: self.bytes,
            lines: self.lines,
            moves: self.moves,
            time: self.time,
            accuracy: ACCURACY,
            operations,
        };
        Some(Proven { text: self.text, certificate })
    }
}

/// Where a record ends; parts end at straight moves.
fn point(record: &Record) -> Option<Point3> {
    match &record.kind {
        RecordKind::From(p) | RecordKind::Rapid(p) | RecordKind::Linear(p) => Some(*p),
        RecordKind::Circle(circle) => Some(circle.to),
        RecordKind::Spline(spline) => Some(spline.end()),
        _ => None,
    }
}

fn contours(cl: &Cl) -> bool {
    cl.records.iter().any(|r| matches!(r.kind, RecordKind::Contour(_)))
}
