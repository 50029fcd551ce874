//! Proof: the read-back trace against the exact geometry.
//!
//! # Contract
//! [`prove`] executes the emitted text with [`crate::readback`] and compares what the machine does with what was asked:
//! - every contour piece stays in its band about the exact curve and covers it from end to end, in order, at its height
//!   ([`follow`], [`measure`]: exact per primitive, bounded and refined, no sampling error above 1e-6 mm);
//! - no move goes deeper into a finished wall than its tolerance allows; no rapid runs below the part's top but straight
//!   up, or clear of the blank ([`guard`]);
//! - a finished surface is gouged nowhere, and nowhere is more left on it than allowed ([`surface`]);
//! - every arc, helix, spline and drilled hole of the CL data is made as asked ([`circles`], [`curves`], [`holes`]), every dwell, stop and tool
//!   change stands where it was asked for and nowhere else ([`events`]);
//! - every cut has its feed, its spindle, its tool and its coolant ([`state`]); every block ends where the lowered program says, and
//!   the points of the CL data are reached in order ([`points`]);
//! - the control has nothing to complain about, and nothing is left to its settings; travel limits hold.
//!
//! What passes becomes [`Proven`], the only thing that may be written to a file. Invariant: nothing here uses the fits,
//! the writer or the dialect data; the exact curve is known by its Frenet data alone. The control's own smoothing is
//! taken at what the program allows it (`G64 P Q`) and counts against the band. Grbl and LinuxCNC follow arcs and curves by
//! chords of their own, with an error set in the machine's settings; that is not part of the program and not counted.

// A value that is not a number must be a finding: comparisons are written so that it fails them.
#![allow(clippy::neg_cmp_op_on_partial_ord)]

use rayon::prelude::*;

use crate::arena::Handle;
use crate::cl::Cl;
use crate::diag::Sink;
use crate::ir::Origin;
use crate::readback::{self, EventKind, MachineSetup, Rotary, Trace, TraceMove};
use crate::target::{Block, BlockKind, TargetProgram};

mod certificate;
mod circles;
mod clearance;
mod curves;
mod events;
mod finding;
mod follow;
mod guard;
mod holes;
mod issue;
mod measure;
mod path;
mod pieces;
mod plan;
mod points;
#[cfg(test)]
mod program_tests;
mod rail;
#[cfg(test)]
mod random_tests;
mod spline;
mod state;
pub mod stream;
mod surface;
#[cfg(test)]
mod tests;
mod tree;

pub use certificate::{
    Certificate, ClearedLevel, ClearingProof, Deviation, Moves, OperationProof, PieceProof, Place,
    RAPID_RATE, SurfaceProof, TIME_MODEL, Time, VERSION,
};

pub(crate) use surface::{Left, Remaining, Sweep};

use finding::{Finding, Reporter};
use plan::{Context, Lines, Orders};

/// Certified accuracy of every reported deviation, and the slack of every comparison with a tolerance, mm.
pub const ACCURACY: f64 = 1e-6;

/// A written program: its text, and the lines of every block of the lowered program (first, from 1, and one past the
/// last; empty when nothing was printed).
#[derive(Debug, Clone)]
pub struct Emitted {
    /// The text, as it goes to the file.
    pub text: String,
    /// Lines by block.
    pub lines: Vec<(u32, u32)>,
}

/// A program whose text has been proven. There is no other way to make one than [`prove`].
#[derive(Debug, Clone)]
pub struct Proven {
    text: String,
    certificate: Certificate,
}

impl Proven {
    /// The NC text.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }
    /// What was proven of it.
    #[must_use]
    pub fn certificate(&self) -> &Certificate {
        &self.certificate
    }
    /// Lets go of the text, once somebody else keeps it; [`Proven::text`] is empty from then on.
    pub(crate) fn let_go(&mut self) {
        self.text = String::new();
    }
    /// Says where the operations stand in the source.
    pub fn locate(&mut self, place: impl Fn(crate::source::Span) -> Place) {
        self.certificate.locate(place);
    }
}

/// A move of the text with its line and block.
#[derive(Debug, Clone, Copy)]
struct Placed<'t> {
    line: u32,
    block: Option<usize>,
    /// Index among the moves.
    index: usize,
    cut: &'t TraceMove,
}

/// Something that the text makes happen, with its line and block.
#[derive(Debug, Clone, Copy)]
struct Happening<'t> {
    line: u32,
    block: Option<usize>,
    kind: &'t EventKind,
}

/// Everything the checks look at.
struct Case<'a> {
    cl: &'a Cl,
    target: &'a TargetProgram,
    contexts: &'a [Context],
    orders: &'a Orders,
    needs: readback::Needs,
    moves: &'a [Placed<'a>],
    /// Statements that are moves themselves (`GOTO`), in order.
    written: &'a [Handle<Origin>],
    /// Everything that happens, in order.
    happenings: &'a [Happening<'a>],
    /// Of each CL record, the range of `happenings` that stand for it.
    spans: &'a [(usize, usize)],
    /// Where the CL data have the tool before the first record, in a part of a program.
    start: Option<crate::geom::Point3>,
}

impl<'a> Case<'a> {
    /// Whether the block is a move that the program asks for point by point.
    fn is_written(&self, block: Option<usize>) -> bool {
        let block = block.and_then(|b| self.target.blocks.get(b));
        block.is_some_and(|b| {
            matches!(b.kind, BlockKind::Motion(_)) && self.written.binary_search(&b.origin).is_ok()
        })
    }

    /// What stands for a CL record.
    fn of_record(&self, record: usize) -> &'a [Happening<'a>] {
        let (from, to) = self.spans.get(record).copied().unwrap_or_default();
        self.happenings.get(from..to).unwrap_or_default()
    }
    /// First block of a CL record.
    fn block_of_record(&self, record: usize) -> Option<usize> {
        self.blocks_of_record(record).next().map(|(index, _)| index)
    }
    /// Blocks of a CL record, with their indices.
    fn blocks_of_record(&self, record: usize) -> impl Iterator<Item = (usize, &Block)> {
        let own = move |b: &Block| b.record.is_some_and(|r| r as usize == record);
        self.target.blocks.iter().enumerate().filter(move |(_, b)| own(b))
    }

    fn context(&self, block: Option<usize>) -> Context {
        block.and_then(|b| self.contexts.get(b).copied()).unwrap_or(Context::START)
    }
}

/// A place of a surface where more is left than allowed, which passes that lie closer would mend.
#[derive(Debug, Clone, Copy)]
pub struct Shortfall {
    /// Index of the operation.
    pub operation: usize,
    /// The worst place of its neighbourhood, mm.
    pub at: crate::geom::Point3,
    /// How far the neighbourhood reaches, mm.
    pub reach: f64,
    /// How high cusps may be there, as a share of what they were planned for.
    pub share: f64,
}

/// Proves an emitted program, or says in coded diagnostics why it can't be written.
pub fn prove(
    cl: &Cl,
    target: &TargetProgram,
    emitted: Emitted,
    control: &str,
    sink: &mut Sink,
) -> Option<Proven> {
    prove_or_tell(cl, target, emitted, control, sink).ok()
}

/// The same; where nothing is wrong but that passes lie too far apart, it says where.
///
/// # Errors
/// The places where passes must lie closer; none where that would not do.
pub fn prove_or_tell(
    cl: &Cl,
    target: &TargetProgram,
    emitted: Emitted,
    control: &str,
    sink: &mut Sink,
) -> Result<Proven, Vec<Shortfall>> {
    let lines = Lines::new(&emitted.lines);
    let plan = Plan {
        contexts: plan::contexts(target),
        orders: Orders::new(cl),
        written: plan::written(cl),
        lines: &lines,
    };
    let judged = match judge(cl, target, &emitted, control, &plan) {
        Ok(judged) => judged,
        Err(unknown) => {
            finding::unknown_control(&unknown.to_string(), sink);
            return Err(Vec::new());
        }
    };
    let mut reporter = Reporter::new(cl, target, sink);
    let findings = blame(cl, target, &emitted, control, (&plan, judged.findings));
    findings.iter().for_each(|finding| reporter.report(finding));
    if reporter.finish() {
        return Ok(Proven { text: emitted.text, certificate: judged.certificate });
    }
    let cured = findings.iter().all(|f| !f.short().is_empty());
    Err(findings.iter().filter(|_| cured).flat_map(|f| f.short().iter().copied()).collect())
}

/// What was asked, which does not depend on the text.
struct Plan<'l> {
    contexts: Vec<Context>,
    orders: Orders,
    written: Vec<Handle<Origin>>,
    lines: &'l Lines,
}

/// What a text does, against what was asked.
struct Judged {
    findings: Vec<Finding>,
    certificate: Certificate,
}

fn judge(
    cl: &Cl,
    target: &TargetProgram,
    emitted: &Emitted,
    control: &str,
    plan: &Plan<'_>,
) -> Result<Judged, readback::UnknownControl> {
    let setup = setup(target);
    let needs = readback::needs(control)?;
    let trace = readback::run(emitted.text.as_bytes(), control, &setup)?;
    let moves = placed(&trace, plan.lines);
    let happenings = happenings(&trace, plan.lines);
    let spans = spans(cl, target, &happenings);
    let case = Case {
        cl,
        target,
        contexts: &plan.contexts,
        orders: &plan.orders,
        needs,
        moves: &moves,
        written: &plan.written,
        happenings: &happenings,
        spans: &spans,
        start: None,
    };
    let (findings, operations) = check(&case, &trace, plan.lines, &emitted.lines, None);
    let certificate = issue::certificate(&case, &trace, emitted, control, operations);
    Ok(Judged { findings, certificate })
}

/// Findings that are not there without the blocks that `INSERT` wrote are these blocks' doing: one finding says so, at
/// the last of them before the trouble.
fn blame(
    cl: &Cl,
    target: &TargetProgram,
    emitted: &Emitted,
    control: &str,
    (plan, findings): (&Plan<'_>, Vec<Finding>),
) -> Vec<Finding> {
    let Some(first) = findings.first() else { return findings };
    let Some((text, culprit)) = without_inserts(target, emitted, first.line()) else { return findings };
    let plain = Emitted { text, lines: emitted.lines.clone() };
    match judge(cl, target, &plain, control, plan) {
        Ok(judged) if judged.findings.is_empty() => vec![first.due_to_insert(culprit)],
        _ => findings,
    }
}

/// The text with the lines of `INSERT` blocks empty, and the last such block that does not come after `line`, with its
/// line; nothing when there is none.
fn without_inserts(target: &TargetProgram, emitted: &Emitted, line: u32) -> Option<(String, (usize, u32))> {
    let blocks = target.blocks.iter().zip(&emitted.lines).enumerate();
    let inserts: Vec<(usize, (u32, u32))> = blocks
        .filter(|(_, (block, (from, to)))| matches!(block.kind, BlockKind::Insert(_)) && to > from)
        .map(|(i, (_, lines))| (i, *lines))
        .collect();
    // A finding without a line comes from what is missing: any of them may be the reason.
    let before = |(_, (from, _)): &&(usize, (u32, u32))| line == 0 || *from <= line;
    let (block, (from, _)) = *inserts.iter().rfind(before)?;
    let mut rest = inserts.iter().map(|(_, lines)| *lines).peekable();
    let mut text = String::with_capacity(emitted.text.len());
    for (number, content) in (1u32..).zip(emitted.text.split_inclusive('\n')) {
        while rest.next_if(|(_, to)| *to <= number).is_some() {}
        let inserted = rest.peek().is_some_and(|(from, _)| *from <= number);
        text.push_str(if inserted { "\n" } else { content });
    }
    Some((text, (block, from)))
}

/// The machine as the lowered program declares it.
pub(crate) fn setup(target: &TargetProgram) -> MachineSetup {
    let rotary = target.capabilities.rotary.map(|r| Rotary { letter: r.letter, reversed: r.reversed });
    let names = target.tools.iter().filter_map(|t| t.number.map(|n| (t.name.clone(), n)));
    MachineSetup { rotary, tools: None, tool_names: names.collect() }
}

fn placed<'t>(trace: &'t Trace, lines: &Lines) -> Vec<Placed<'t>> {
    let only_moves = |e: &'t readback::TraceEvent| match &e.kind {
        EventKind::Move(cut) => Some((e.line, cut)),
        _ => None,
    };
    let moves = trace.events.iter().filter_map(only_moves).enumerate();
    moves.map(|(index, (line, cut))| Placed { line, block: lines.block(line), index, cut }).collect()
}

fn happenings<'t>(trace: &'t Trace, lines: &Lines) -> Vec<Happening<'t>> {
    let place =
        |e: &'t readback::TraceEvent| Happening { line: e.line, block: lines.block(e.line), kind: &e.kind };
    trace.events.iter().map(place).collect()
}

/// Range of the happenings of every record; the blocks of one record follow each other.
fn spans(cl: &Cl, target: &TargetProgram, happenings: &[Happening<'_>]) -> Vec<(usize, usize)> {
    let mut spans = vec![(0, 0); cl.records.len()];
    for (i, happening) in happenings.iter().enumerate() {
        let record = happening.block.and_then(|b| target.blocks.get(b)).and_then(|b| b.record);
        if let Some(span) = record.and_then(|r| spans.get_mut(r as usize)) {
            if span.0 == span.1 {
                span.0 = i;
            }
            span.1 = i + 1;
        }
    }
    spans
}

/// What was measured of the operations.
struct Proofs {
    contours: Vec<pieces::Proof>,
    surfaces: Vec<surface::Proof>,
}

/// All checks; findings in the order of the text.
fn check(
    case: &Case<'_>,
    trace: &Trace,
    lines: &Lines,
    block_lines: &[(u32, u32)],
    before: Option<crate::geom::Point3>,
) -> (Vec<Finding>, Proofs) {
    let rails = guard::Rails::new(case);
    let (mut findings, contours) = pieces::all(case, &rails);
    let (found, surfaces) = surface::all(case);
    findings.extend(found);
    findings.extend(finding::of_control(trace, lines));
    let guards = guard::Guards::new(case, &rails);
    let others: Vec<Finding> = case
        .moves
        .par_iter()
        .flat_map_iter(|placed| {
            let mut found = state::check(case, placed);
            found.extend(guards.check(placed));
            found.extend(points::travel(case, placed));
            found
        })
        .collect();
    findings.extend(others);
    findings.extend(points::block_ends(case, block_lines));
    findings.extend(points::cl_points(case, before));
    findings.extend(holes::all(case));
    findings.extend(circles::all(case));
    findings.extend(curves::all(case));
    findings.extend(events::all(case));
    findings.sort_by_key(Finding::line);
    (findings, Proofs { contours, surfaces })
}
