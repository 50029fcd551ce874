//! Every move of an operation against its surface.

use rayon::prelude::*;

use super::{Moved, Swept};
use crate::cl::{Finish, Operation, RecordKind};
use crate::diag::codes::verification as codes;
use crate::geom::Point3;
use crate::geom::surface::cutter::bent::{self, Way};
use crate::geom::surface::cutter::extremes;
use crate::geom::surface::swept::{Extremes, Question};
use crate::readback::{Tilted, TracePath};
use crate::verify::finding::{Finding, Text};
use crate::verify::path::{Primitive, polar_bounds};
use crate::verify::spline;
use crate::verify::{ACCURACY, Case, Placed};

/// A measured extreme.
#[derive(Debug, Clone, Copy)]
pub(super) struct Worst {
    pub value: f64,
    pub line: u32,
    pub block: Option<usize>,
    pub at: Point3,
}

impl Worst {
    pub(super) const NONE: Worst = Worst { value: 0.0, line: 0, block: None, at: Point3::new(0.0, 0.0, 0.0) };

    pub(super) fn take(&mut self, other: Worst) {
        if other.value > self.value {
            *self = other;
        }
    }
}

/// What was measured of the moves of one operation.
#[derive(Debug)]
pub(super) struct Measured {
    pub passes: Vec<Swept>,
    /// Moves along passes.
    pub blocks: u32,
    /// All moves with a known start.
    pub moves: Vec<Moved>,
    pub runs: u32,
    /// Length of the tip's path along passes, mm.
    pub length: f64,
    pub into: Worst,
    pub out: Worst,
}

/// Moves with less than this between are told to be clear by boxes alone, mm.
const CLEAR: f64 = 1.0;

/// Chords of arcs leave them by this at first, and by this at last, mm.
const COARSEST: f64 = 2e-3;
const FINEST: f64 = 1e-7;
/// Chords of arcs that are swept through the stock, mm.
const SIMULATED: f64 = 2e-3;

/// Chords of moves in pictures of what is left, mm: far below what their colours tell apart.
const DRAWN: f64 = 5e-5;
/// Chords of moves along passes leave them by no more than this share of what may be left.
const SWEPT: f64 = 1e-2;
/// Largest distances are told exactly where they are more than this share of what is allowed; others are sampled.
const OFF: f64 = 0.9;

/// Checks all moves; findings are appended.
pub(super) fn check(
    case: &Case<'_>,
    operation: &Operation,
    finish: &Finish,
    own: &[Placed<'_>],
    findings: &mut Vec<Finding>,
) -> Measured {
    // The way from above onto the first vertex of a pass is not part of it.
    let passes: Vec<bool> = own.iter().map(|p| is_pass(case, p)).collect();
    let along = |i: usize| passes[i] && i.checked_sub(1).is_some_and(|before| passes[before]);
    let results: Vec<One> =
        own.par_iter().enumerate().map(|(i, p)| one(case, operation, finish, p, along(i))).collect();
    let mut measured = Measured {
        passes: Vec::new(),
        blocks: 0,
        moves: Vec::new(),
        runs: 0,
        length: 0.0,
        into: Worst::NONE,
        out: Worst::NONE,
    };
    let mut record = None;
    for (placed, found) in own.iter().zip(results) {
        measured.into.take(found.into);
        findings.extend(found.findings);
        if operation.guard.clearing.is_some() {
            let (line, block, rapid) = (placed.line, placed.block, placed.cut.rapid);
            measured.moves.push(Moved { ways: found.ways, line, block, rapid });
        }
        if let Some((swept, out)) = found.pass {
            measured.out.take(out);
            measured.length += swept.iter().map(|s| (s.to - s.from).norm()).sum::<f64>();
            measured.passes.extend(swept);
            measured.blocks += 1;
            let of = record_of(case, placed);
            measured.runs += u32::from(of != record && !is_link(case, of));
            record = of;
        }
    }
    measured
}

struct One {
    into: Worst,
    /// The ways of a move along a pass, and how far it is off the surface.
    pass: Option<(Vec<Swept>, Worst)>,
    findings: Vec<Finding>,
    /// Ways of the ball's centre, where a clearing wants them.
    ways: Vec<(Point3, Point3)>,
}

/// The CL record that a move expresses.
fn record_of(case: &Case<'_>, placed: &Placed<'_>) -> Option<u32> {
    case.target.blocks.get(placed.block?)?.record
}

/// Whether a CL record leads from one pass to the next.
fn is_link(case: &Case<'_>, record: Option<u32>) -> bool {
    let kind = record.and_then(|r| case.cl.records.get(r as usize)).map(|r| &r.kind);
    matches!(kind, Some(RecordKind::Pass(pass)) if pass.link)
}

/// Whether a move is part of a pass.
fn is_pass(case: &Case<'_>, placed: &Placed<'_>) -> bool {
    let record = record_of(case, placed).and_then(|r| case.cl.records.get(r as usize));
    record.is_some_and(|r| matches!(r.kind, RecordKind::Pass(_)))
}

fn one(case: &Case<'_>, operation: &Operation, finish: &Finish, placed: &Placed<'_>, pass: bool) -> One {
    let cut = placed.cut;
    let mut result = One { into: Worst::NONE, pass: None, findings: Vec::new(), ways: Vec::new() };
    if !cut.known.iter().all(|k| *k) {
        return result;
    }
    let ball = finish.cutter.corner() + finish.leave;
    let allowed = if cut.rapid { 0.0 } else { operation.band.into };
    let smoothing = if cut.rapid { 0.0 } else { cut.path_tolerance };
    debug_assert!(!pass || is_pass(case, placed));
    if operation.guard.clearing.is_some() {
        let ways = within(placed, SIMULATED).ways;
        result.ways = ways.into_iter().map(|(from, to)| (raised(finish, from), raised(finish, to))).collect();
    }
    if !pass {
        let (into, held) = deepest(finish, placed, allowed - smoothing);
        result.into.take(into);
        if !held {
            result.findings.push(gouge(operation, placed, &into, allowed));
        }
        return result;
    }
    let (found, swept) = followed(operation, finish, placed);
    let worst = |value: f64, at: Point3| Worst { value, line: placed.line, block: placed.block, at };
    let into = worst(ball - found.least.distance, found.least.at);
    result.into.take(into);
    if !(into.value + smoothing <= allowed + ACCURACY) {
        result.findings.push(gouge(operation, placed, &into, allowed));
    }
    let out = worst(found.most.distance - ball, found.most.at);
    result.findings.extend(excess(operation, placed, &found, &out, smoothing));
    result.pass = Some((swept, out));
    if cut.rapid {
        let text = Text::default().words("a rapid along a surface");
        result.findings.push(Finding::new(&codes::NOT_FOLLOWED, placed.line, placed.block, text));
    }
    result
}

/// How far a move along a pass is off the surface, and its ways through the stock.
fn followed(operation: &Operation, finish: &Finish, placed: &Placed<'_>) -> (Extremes, Vec<Swept>) {
    let ball = finish.cutter.corner() + finish.leave;
    let little = ball + OFF * (operation.band.out - placed.cut.path_tolerance).max(0.0);
    let question = Question { enough: ball, little, accuracy: 0.5 * ACCURACY };
    let (from, to) = (raised(finish, placed.cut.start()), raised(finish, placed.cut.end()));
    let swept = |from, to, off| Swept { from, to, off, line: placed.line, block: placed.block };
    let straight = || extremes(&finish.tree, &finish.cutter, from, to, &question, None);
    if matches!(placed.cut.path, TracePath::Line { .. }) {
        return (straight(), vec![swept(from, to, 0.0)]);
    }
    // What is left is told with the chords' distance from the move: a little of what may be left.
    let fine = (SWEPT * finish.cusp.map_or(operation.band.out, |h| operation.band.out.clamp(0.1 * h, h)))
        .max(FINEST);
    let (mut found, mut ways): (Option<Extremes>, Vec<Swept>) = (None, Vec::new());
    for course in Course::of(placed) {
        let at = |x: f64| raised(finish, course.at(x));
        let way = Way { at: &at, bend: course.bend() };
        let own = bent::along(&finish.tree, &finish.cutter, &way, &question, None);
        found = match (found, own) {
            (Some(a), Some(b)) => Some(a.with(&b)),
            (a, b) => a.or(b),
        };
        let parts = way.parts(fine);
        let place = |k: u32| at(f64::from(k) / f64::from(parts));
        ways.extend((0..parts).map(|k| swept(place(k), place(k + 1), way.sagitta(parts))));
    }
    (found.unwrap_or_else(straight), ways)
}

/// The cutter's reference point (a ball's centre) when its tip is at a point.
pub(super) fn raised(finish: &Finish, p: Point3) -> Point3 {
    finish.cutter.reference(p)
}

/// How deep a move that is no pass goes into the surface at most, and whether that is allowed. Arcs are taken by chords
/// whose distance from them counts; where that is too much, by finer ones.
fn deepest(finish: &Finish, placed: &Placed<'_>, allowed: f64) -> (Worst, bool) {
    let ball = finish.cutter.corner() + finish.leave;
    let mut worst = Worst::NONE;
    for sagitta in [COARSEST, 0.1 * COARSEST, 0.01 * COARSEST, FINEST] {
        worst = Worst { line: placed.line, block: placed.block, ..Worst::NONE };
        let chords = within(placed, sagitta);
        for (from, to) in &chords.ways {
            let (from, to) = (raised(finish, *from), raised(finish, *to));
            if clear(finish, from, to, ball + chords.off) {
                continue;
            }
            let question =
                Question { enough: ball + chords.off, little: f64::INFINITY, accuracy: 0.5 * ACCURACY };
            let found = extremes(&finish.tree, &finish.cutter, from, to, &question, None);
            let value = ball + chords.off - found.least.distance;
            worst.take(Worst { value, line: placed.line, block: placed.block, at: found.least.at });
        }
        let settled = worst.value <= ACCURACY.min(allowed + ACCURACY);
        // What is certainly too deep is so by whatever chords.
        let hopeless = worst.value > allowed + 100.0 * chords.off;
        if chords.off == 0.0 || settled || hopeless {
            break;
        }
    }
    (worst, worst.value <= allowed + ACCURACY)
}

/// Whether boxes tell that a move stays clear.
fn clear(finish: &Finish, from: Point3, to: Point3, ball: f64) -> bool {
    let (low, high) = finish.tree.bounds();
    if !finish.cutter.is_ball() {
        return from.z.min(to.z) > high.z + ball + CLEAR;
    }
    (0..3).any(|i| from[i].min(to[i]) > high[i] + ball + CLEAR || from[i].max(to[i]) < low[i] - ball - CLEAR)
}

/// A move as straight ways of the tip, for pictures.
pub(super) fn chords(placed: &Placed<'_>) -> Vec<(Point3, Point3)> {
    within(placed, DRAWN).ways
}

/// A move as straight ways of the tip.
struct Chords {
    ways: Vec<(Point3, Point3)>,
    /// No point of the move is farther from them, mm.
    off: f64,
}

/// A move by chords that leave it by no more than `sagitta` mm, or by as many as are bearable.
fn within(placed: &Placed<'_>, sagitta: f64) -> Chords {
    let (start, end) = (placed.cut.start(), placed.cut.end());
    if matches!(placed.cut.path, TracePath::Line { .. }) {
        return Chords { ways: vec![(start, end)], off: 0.0 };
    }
    let mut points = vec![start];
    let mut off: f64 = 0.0;
    for course in Course::of(placed) {
        let way = Way { at: &|x| course.at(x), bend: course.bend() };
        let parts = way.parts(sagitta);
        off = off.max(way.sagitta(parts));
        points.extend((1..=parts).map(|k| (way.at)(f64::from(k) / f64::from(parts))));
    }
    Chords { ways: points.windows(2).map(|w| (w[0], w[1])).collect(), off }
}

/// A smooth part of a bent move of the tip, over 0..=1.
enum Course<'a> {
    /// An arc about an axis other than Z.
    Tilted(&'a Tilted),
    /// A curve as seen along Z, and heights that are linear along it.
    Flat(Primitive, (f64, f64)),
    /// A segment of a curve in space as seen along Z, and its heights as the X of another segment.
    Space(Primitive, Primitive),
}

impl Course<'_> {
    fn of<'a>(placed: &Placed<'a>) -> Vec<Course<'a>> {
        if let TracePath::Tilted(arc) = &placed.cut.path {
            return vec![Course::Tilted(arc)];
        }
        if let TracePath::Space(curve) = &placed.cut.path {
            let (plan, heights) = (Primitive::of(&placed.cut.path), spline::heights(curve));
            return plan.into_iter().zip(heights).map(|(p, z)| Course::Space(p, z)).collect();
        }
        let primitives = Primitive::of(&placed.cut.path);
        let (a, b) = placed.cut.z;
        let share = 1.0 / crate::math::count(primitives.len().max(1));
        let height = |k: usize| a + (b - a) * share * crate::math::count(k);
        primitives.into_iter().enumerate().map(|(k, p)| Course::Flat(p, (height(k), height(k + 1)))).collect()
    }

    fn at(&self, x: f64) -> Point3 {
        match self {
            Course::Tilted(arc) => arc.at(x),
            Course::Flat(primitive, (low, high)) => {
                let p = primitive.at(x).p;
                Point3::new(p.x, p.y, low + (high - low) * x)
            }
            Course::Space(plan, heights) => {
                let (p, z) = (plan.at(x).p, heights.at(x).p.x);
                Point3::new(p.x, p.y, z)
            }
        }
    }

    /// Bound of the second derivative, mm.
    fn bend(&self) -> f64 {
        match self {
            Course::Tilted(arc) => {
                let (r0, r1) = arc.radii();
                polar_bounds((r0, r1 - r0), arc.sweep)[1]
            }
            Course::Flat(primitive, _) => primitive.bounds()[1],
            Course::Space(plan, heights) => crate::math::hypot(plan.bounds()[1], heights.bounds()[1]),
        }
    }
}

fn gouge(operation: &Operation, placed: &Placed<'_>, into: &Worst, allowed: f64) -> Finding {
    let text = Text::default()
        .words(if placed.cut.rapid { "a rapid goes " } else { "the cutter goes " })
        .length(into.value)
        .words(" into the surface with its centre at ")
        .place(into.at)
        .words(format!("; {} may go ", operation.name))
        .length(allowed);
    Finding::new(&codes::SURFACE_GOUGED, placed.line, placed.block, text)
}

fn excess(
    operation: &Operation,
    placed: &Placed<'_>,
    found: &Extremes,
    out: &Worst,
    smoothing: f64,
) -> Option<Finding> {
    let allowed = operation.band.out;
    (!(out.value + smoothing <= allowed + ACCURACY)).then(|| {
        let at = found.most.at;
        let text = Text::default()
            .words("the path leaves ")
            .length(out.value)
            .words(" on the surface with the ball's centre at ")
            .place(at)
            .words(format!("; OUTTOL of {} is ", operation.name))
            .length(allowed);
        Finding::new(&codes::SURFACE_LEFT, placed.line, placed.block, text)
    })
}
