//! A program's path as chords that know their moves.

use crate::geom::{Point2, Point3, Vec2};
use crate::math::{TAU, sin_cos};
use crate::readback::{EventKind, Trace, TraceMove, TracePath, nurbs_point};

/// Halvings of a chord at most.
const DEEPEST: u32 = 14;
/// Chords that a full turn is started with: none hides more than an eighth of it.
const CHORDS_PER_TURN: f64 = 16.0;

/// The moves of a program, those without length left out, and their chords.
#[derive(Debug)]
pub(super) struct Path<'t> {
    /// Moves with their NC lines.
    pub moves: Vec<(u32, &'t TraceMove)>,
    /// Corners: the start and the end of every chord. Empty when nothing moves.
    pub points: Vec<Point3>,
    /// The move of the chord that ends at each corner; that of the first corner is the first move.
    pub owner: Vec<usize>,
    /// Length up to each corner, mm.
    pub at: Vec<f64>,
    /// Corner at which the path stands after each event of the trace.
    pub after: Vec<usize>,
}

impl Path<'_> {
    /// Length of the path, mm.
    pub fn length(&self) -> f64 {
        self.at.last().copied().unwrap_or(0.0)
    }
    fn push(&mut self, point: Point3, owner: usize) {
        let step = self.points.last().map_or(0.0, |last| (point - last).norm());
        self.at.push(self.length() + step);
        self.points.push(point);
        self.owner.push(owner);
    }
}

/// The path of a trace; chords stay within `chord` mm of it.
pub(super) fn path(trace: &Trace, chord: f64) -> Path<'_> {
    let mut path =
        Path { moves: Vec::new(), points: Vec::new(), owner: Vec::new(), at: Vec::new(), after: Vec::new() };
    for event in &trace.events {
        if let EventKind::Move(cut) = &event.kind
            && cut.length() > 0.0
        {
            let owner = path.moves.len();
            path.moves.push((event.line, cut));
            add(&mut path, cut, owner, chord);
        }
        path.after.push(path.points.len().saturating_sub(1));
    }
    path
}

fn add(path: &mut Path<'_>, cut: &TraceMove, owner: usize, chord: f64) {
    let start = cut.start();
    // A program may start anywhere; what a control does not know yet is taken from the move.
    if path.points.last().is_none_or(|last| (start - last).norm() > 0.0) {
        path.push(start, owner);
    }
    let pieces = pieces(&cut.path);
    let mut from = (0.0, start);
    for index in 1..=pieces {
        let x = if index == pieces { 1.0 } else { f64::from(index) / f64::from(pieces) };
        let to = (x, at(cut, x));
        halve(path, cut, (from, to), owner, chord, DEEPEST);
        path.push(to.1, owner);
        from = to;
    }
}

/// Adds the corners between two, not the ends.
fn halve(
    path: &mut Path<'_>,
    cut: &TraceMove,
    ends: ((f64, Point3), (f64, Point3)),
    owner: usize,
    chord: f64,
    depth: u32,
) {
    if depth == 0 || matches!(cut.path, TracePath::Line { .. }) {
        return;
    }
    let (from, to) = ends;
    let x = 0.5 * (from.0 + to.0);
    let middle = at(cut, x);
    if (middle - nalgebra::center(&from.1, &to.1)).norm() <= chord {
        return;
    }
    halve(path, cut, (from, (x, middle)), owner, chord, depth - 1);
    path.push(middle, owner);
    halve(path, cut, ((x, middle), to), owner, chord, depth - 1);
}

/// Parts that a move is cut into before halving, so that a middle cannot lie on the chord by symmetry.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn pieces(path: &TracePath) -> u32 {
    let of_turn = |sweep: f64| (CHORDS_PER_TURN * sweep.abs() / TAU).ceil().clamp(1.0, 1e6) as u32;
    match path {
        TracePath::Line { .. } => 1,
        TracePath::Arc { sweep, .. } => of_turn(*sweep),
        TracePath::Tilted(arc) => of_turn(arc.sweep),
        TracePath::Spiral { angle, .. } => of_turn(angle.1 - angle.0),
        TracePath::Space(curve) => 8 * u32::try_from(curve.points.len()).unwrap_or(u32::MAX / 8).min(1 << 20),
        TracePath::Nurbs { points, .. } => {
            8 * u32::try_from(points.len()).unwrap_or(u32::MAX / 8).min(1 << 20)
        }
    }
}

/// Point of a move at `x` in 0..1.
fn at(cut: &TraceMove, x: f64) -> Point3 {
    let z = cut.z.0 + (cut.z.1 - cut.z.0) * x;
    let flat = match &cut.path {
        _ if x >= 1.0 => return cut.end(),
        TracePath::Line { from, to } => from + (to - from) * x,
        TracePath::Arc { from, to, centre, sweep } => {
            let (a, b) = (from - centre, to - centre);
            let radius = a.norm() + (b.norm() - a.norm()) * x;
            let (s, c) = sin_cos(sweep * x);
            let towards = a.try_normalize(0.0).unwrap_or_else(nalgebra::zero);
            centre + Vec2::new(towards.x * c - towards.y * s, towards.x * s + towards.y * c) * radius
        }
        TracePath::Tilted(arc) => return arc.at(x),
        TracePath::Space(curve) => return curve.at(x),
        TracePath::Spiral { radius, angle } => {
            let (s, c) = sin_cos(angle.0 + (angle.1 - angle.0) * x);
            Point2::new(c, s) * (radius.0 + (radius.1 - radius.0) * x)
        }
        TracePath::Nurbs { order, points, weights, knots } => {
            let order = usize::from(*order);
            let (first, last) = (knots.get(order.saturating_sub(1)), knots.get(points.len()));
            let (first, last) = (first.copied().unwrap_or(0.0), last.copied().unwrap_or(1.0));
            nurbs_point(order, points, weights, knots, first + (last - first) * x)
        }
    };
    Point3::new(flat.x, flat.y, z)
}
