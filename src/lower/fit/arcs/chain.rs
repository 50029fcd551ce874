//! A chain of arcs about a stretch: joints (station, offset) and the half sweep of every arc, its deviation from
//! the curve, and the derivatives of that.

use super::minimax::{BLOCK, Row, WIDTH};
use super::stretch::{Sample, Stretch, turn};
use crate::geom::curve::Frenet;
use crate::geom::{Point2, Vec2, cross, left};
use crate::math;

/// What a joint is free to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Hold {
    /// Slides along the curve and across it.
    Free,
    /// Stays on the normal of its station.
    Station,
    /// Stays where it is; rounding may slide it along the path.
    Point,
    /// Stays where it is, on the grid already.
    Vertex,
    /// Slides along a circle (an arc that is kept exactly), beyond the span that is kept.
    Circle {
        /// Centre, mm.
        centre: Point2,
        /// Least station.
        from: f64,
        /// Largest station.
        to: f64,
    },
}

/// A joint of two arcs, or an end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Joint {
    /// Arc length of the foot on the curve, mm; on a closed stretch not reduced.
    pub s: f64,
    /// Left deviation, mm.
    pub e: f64,
    /// What is free.
    pub hold: Hold,
    /// The curve at the foot.
    pub frame: Frenet,
    /// The joint, mm.
    pub p: Point2,
}

impl Joint {
    /// Joint at station `s` with left deviation `e`.
    pub fn on(stretch: &Stretch<'_>, s: f64, e: f64, hold: Hold) -> Joint {
        let frame = stretch.at(s);
        Joint { s, e, hold, frame, p: frame.p + left(frame.t) * e }
    }
    /// A joint on a circle moved along it to station `s`; any other joint as it is.
    pub fn slid(self, stretch: &Stretch<'_>, s: f64) -> Joint {
        match self.hold {
            Hold::Circle { centre, from, to } => on_circle(stretch, &self, centre, s.clamp(from, to)),
            _ => self,
        }
    }
    /// Derivatives of the position by station and by deviation.
    pub fn directions(&self) -> (Vec2, Vec2) {
        let along = self.frame.t * (self.frame.speed * (1.0 - self.e * self.frame.k));
        match self.hold {
            Hold::Free => (along, left(self.frame.t)),
            Hold::Station => (Vec2::zeros(), left(self.frame.t)),
            Hold::Point | Hold::Vertex => (Vec2::zeros(), Vec2::zeros()),
            Hold::Circle { centre, .. } => {
                let r = self.p - centre;
                let tangent = left(r) * (1.0 / r.norm().max(1e-12));
                (tangent * tangent.dot(&along).signum() * along.norm(), Vec2::zeros())
            }
        }
    }
}

/// One arc of the chain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Member {
    /// Through its two joints with this half sweep, radians, positive to the left.
    Arc(f64),
    /// The straight line through its joints.
    Line,
    /// Kept exactly: part of this circle.
    Exact {
        /// Centre, mm.
        centre: Point2,
        /// Turns left.
        ccw: bool,
    },
}

/// A chain of n arcs with n (closed) or n + 1 (open) joints.
#[derive(Debug, Clone)]
pub(super) struct Chain {
    /// Joints in order.
    pub joints: Vec<Joint>,
    /// Arcs; arc i goes from joint i to joint i + 1.
    pub members: Vec<Member>,
    /// Whether the last arc ends at the first joint, one turn further.
    pub closed: bool,
}

/// An arc in the plane, with what its deviation needs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Drawn {
    /// Start, mm.
    pub from: Point2,
    /// Unit vector from start to end.
    pub chord: Vec2,
    /// Distance from start to end, mm.
    pub length: f64,
    /// Half sweep, radians, left positive.
    pub half: f64,
}

impl Drawn {
    /// The arc from `from` to `to` with half sweep `half`.
    pub fn new(from: Point2, to: Point2, half: f64) -> Drawn {
        let d = to - from;
        let length = d.norm();
        let chord = if length > 0.0 { d / length } else { Vec2::new(1.0, 0.0) };
        Drawn { from, chord, length, half }
    }
    /// Curvature, left positive, 1/mm.
    pub fn curvature(&self) -> f64 {
        2.0 * math::sin(self.half) / self.length.max(1e-300)
    }
    /// Tangents at start and end.
    pub fn tangents(&self) -> (Vec2, Vec2) {
        let (s, c) = math::sin_cos(self.half);
        let n = left(self.chord);
        (self.chord * c - n * s, self.chord * c + n * s)
    }
    /// A circle that can be asked for deviations.
    pub fn circle(&self) -> Circle {
        let tangent = self.tangents().0;
        Circle { p: self.from, n: left(tangent), k: self.curvature() }
    }
    /// Derivatives of the deviation at path point `q` by start, end and half sweep.
    pub fn gradient(&self, q: Point2) -> (Vec2, Vec2, f64) {
        let w = q - self.from;
        let n = left(self.chord);
        let (x, y, l) = (w.dot(&self.chord), w.dot(&n), self.length);
        let (s, c) = math::sin_cos(self.half);
        // F = sin h (x² + y² - l x) - l cos h y vanishes on the circle with |∇F| = l.
        let by_half = (c * (x * x + y * y - l * x) + l * s * y) / l;
        let by = |dx: f64, dy: f64, dl: f64| {
            (s * (2.0 * x * dx + 2.0 * y * dy - dl * x - l * dx) - dl * c * y - l * c * dy) / l
        };
        // Moving an end along the chord changes l (and x); across it turns the chord.
        let end = (by(0.0, 0.0, 1.0), by(y / l, -x / l, 0.0));
        let start = (by(-1.0, 0.0, -1.0), by(-y / l, x / l - 1.0, 0.0));
        let vector = |(along, across): (f64, f64)| self.chord * along + n * across;
        (vector(start), vector(end), by_half)
    }
}

/// A directed circle or line through `p` with left normal `n` there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Circle {
    /// A point on it, mm.
    pub p: Point2,
    /// Left unit normal at that point.
    pub n: Vec2,
    /// Curvature, left positive, 1/mm.
    pub k: f64,
}

impl Circle {
    /// How far the circle is to the left of point `q`, measured along the unit normal `n` of the curve at q, mm;
    /// infinite when the normal misses the circle.
    pub fn deviation(&self, q: Point2, n: Vec2) -> f64 {
        let w = q - self.p;
        let f = w.dot(&self.n) - 0.5 * self.k * w.norm_squared();
        let g = n.dot(&self.n) - self.k * w.dot(&n);
        let root = g * g + 2.0 * self.k * f;
        if root < 0.0 || g <= 0.0 { f64::INFINITY } else { -2.0 * f / (g + root.sqrt()) }
    }
}

/// Band about the curve as centre and half width, both mm, left positive.
#[derive(Debug, Clone, Copy)]
pub(super) struct Band {
    /// Middle of the band.
    pub middle: f64,
    /// Half its width.
    pub half: f64,
}

/// Weights of the minimax problem.
#[derive(Debug, Clone, Copy)]
pub(super) struct Goal {
    /// The band.
    pub band: Band,
    /// Tangent error at a joint that counts as much as a deviation of half the band, radians.
    pub tangent: f64,
}

impl Chain {
    /// Number of arcs.
    pub fn len(&self) -> usize {
        self.members.len()
    }

    /// Whether arc i is kept exactly.
    pub fn is_exact(&self, i: usize) -> bool {
        matches!(self.members[i], Member::Exact { .. })
    }

    /// The joint at the end of arc i.
    pub fn end(&self, i: usize) -> usize {
        if i + 1 < self.joints.len() { i + 1 } else { 0 }
    }

    /// Station where arc i ends, unwrapped from that of its start.
    pub fn station_after(&self, stretch: &Stretch<'_>, i: usize) -> f64 {
        let j = self.end(i);
        self.joints[j].s + if j == 0 { stretch.length() } else { 0.0 }
    }

    /// Arc i as drawn.
    pub fn drawn(&self, i: usize) -> Drawn {
        let (a, b) = (self.joints[i].p, self.joints[self.end(i)].p);
        match self.members[i] {
            Member::Arc(half) => Drawn::new(a, b, half),
            Member::Line => Drawn::new(a, b, 0.0),
            Member::Exact { centre, ccw } => Drawn::new(a, b, exact_half(a, b, centre, ccw)),
        }
    }

    /// Tangent error at joint j, radians: direction after minus direction before; 0 at an open end.
    pub fn kink(&self, j: usize) -> f64 {
        match self.before(j) {
            Some(i) if j < self.len() => turn(self.drawn(i).tangents().1, self.drawn(j).tangents().0),
            _ => 0.0,
        }
    }

    /// The arc that ends at joint j.
    pub fn before(&self, j: usize) -> Option<usize> {
        if j > 0 { Some(j - 1) } else { self.closed.then(|| self.len() - 1) }
    }

    /// Moves the joints by station and deviation, `step` holding a block per joint, and the half sweeps.
    pub fn moved(&self, stretch: &Stretch<'_>, step: &[f64]) -> Chain {
        let mut chain = self.clone();
        for (j, joint) in chain.joints.iter_mut().enumerate() {
            let (ds, de) = (step[j * BLOCK], step[j * BLOCK + 1]);
            match joint.hold {
                Hold::Free => *joint = Joint::on(stretch, joint.s + ds, joint.e + de, Hold::Free),
                Hold::Station => {
                    joint.e += de;
                    joint.p = joint.frame.p + left(joint.frame.t) * joint.e;
                }
                Hold::Point | Hold::Vertex => {}
                Hold::Circle { .. } => *joint = joint.slid(stretch, joint.s + ds),
            }
        }
        for (i, member) in chain.members.iter_mut().enumerate() {
            if let Member::Arc(half) = member {
                *half += step[i * BLOCK + 2];
            }
        }
        chain
    }
}

/// Half sweep of the arc about `centre` from a to b.
pub(super) fn exact_half(a: Point2, b: Point2, centre: Point2, ccw: bool) -> f64 {
    let angle = turn(a - centre, b - centre);
    let sweep = match (ccw, angle > 0.0) {
        (true, false) => angle + math::TAU,
        (false, true) => angle - math::TAU,
        _ => angle,
    };
    0.5 * sweep
}

/// The joint moved along its circle to station `s`.
fn on_circle(stretch: &Stretch<'_>, joint: &Joint, centre: Point2, s: f64) -> Joint {
    let frame = stretch.at(s);
    let w = frame.p - centre;
    let r = joint.p - centre;
    let n = left(frame.t);
    // |w + e n| = |r|
    let (b, q) = (n.dot(&w), w.norm_squared() - r.norm_squared());
    let root = (b * b - q).max(0.0).sqrt();
    let e = if b >= 0.0 { -q / (b + root) } else { -q / (b - root) };
    Joint { s, e, frame, p: frame.p + n * e, ..*joint }
}

/// Rows of an arc besides those at its extremes, about.
const ROWS: usize = 7;

/// Row with no coefficients.
fn empty(block: usize, value: f64, slope: f64) -> Row {
    Row { block, coefficients: [0.0; WIDTH], value, limit: 0.0, slope }
}

/// Builds the rows of the linearised minimax problem about `chain`.
pub(super) fn rows(chain: &Chain, stretch: &Stretch<'_>, goal: &Goal, out: &mut Vec<Row>) {
    for i in 0..chain.len() {
        deviation_rows(chain, stretch, goal, i, out);
    }
    for (j, joint) in chain.joints.iter().enumerate() {
        let mut row = empty(j, joint.e - goal.band.middle, 1.0);
        let (along, across) = joint.directions();
        let n = left(joint.frame.t);
        row.coefficients[0] = along.dot(&n);
        row.coefficients[1] = across.dot(&n);
        out.push(row);
        if j < chain.len()
            && let Some(i) = chain.before(j)
        {
            out.push(kink_row(chain, goal.band.half / goal.tangent, i, j));
        }
    }
}

fn deviation_rows(chain: &Chain, stretch: &Stretch<'_>, goal: &Goal, i: usize, out: &mut Vec<Row>) {
    if chain.is_exact(i) {
        return;
    }
    let drawn = chain.drawn(i);
    let circle = drawn.circle();
    let (a, b) = (&chain.joints[i], &chain.joints[chain.end(i)]);
    let (a_dir, b_dir) = (a.directions(), b.directions());
    let values: Vec<(f64, &Sample)> = stretch
        .between(a.s, chain.station_after(stretch, i))
        .map(|(_, q)| (circle.deviation(q.p, q.n).clamp(-1e3, 1e3), q))
        .collect();
    let stride = values.len() / ROWS + 1;
    for (j, (e, q)) in values.iter().enumerate() {
        let extreme = j > 0 && j + 1 < values.len() && (e - values[j - 1].0) * (e - values[j + 1].0) >= 0.0;
        if !extreme && j % stride != stride / 2 {
            continue;
        }
        let (by_a, by_b, by_half) = drawn.gradient(q.p + q.n * *e);
        let mut row = empty(i, e - goal.band.middle, 1.0);
        row.coefficients[0] = by_a.dot(&a_dir.0);
        row.coefficients[1] = by_a.dot(&a_dir.1);
        row.coefficients[2] = if matches!(chain.members[i], Member::Arc(_)) { by_half } else { 0.0 };
        row.coefficients[3] = by_b.dot(&b_dir.0);
        row.coefficients[4] = by_b.dot(&b_dir.1);
        out.push(row);
    }
}

/// Derivatives of a member's tangent angle at its start (or end) by (start s, e, half, end s, e).
fn tangent_row(chain: &Chain, i: usize, at_end: bool) -> [f64; 5] {
    let d = chain.drawn(i);
    let (a, b) = (&chain.joints[i], &chain.joints[chain.end(i)]);
    let (a_dir, b_dir) = (a.directions(), b.directions());
    if let Member::Exact { centre, .. } = chain.members[i] {
        let (joint, dir) = if at_end { (b, b_dir) } else { (a, a_dir) };
        let r = joint.p - centre;
        let by_s = cross(r, dir.0) / r.norm_squared();
        return if at_end { [0.0, 0.0, 0.0, by_s, 0.0] } else { [by_s, 0.0, 0.0, 0.0, 0.0] };
    }
    let turn_by = |v: Vec2| cross(d.chord, v) / d.length;
    let by_half = match (chain.members[i], at_end) {
        (Member::Arc(_), true) => 1.0,
        (Member::Arc(_), false) => -1.0,
        _ => 0.0,
    };
    [-turn_by(a_dir.0), -turn_by(a_dir.1), by_half, turn_by(b_dir.0), turn_by(b_dir.1)]
}

/// Rows of the tangent errors in radians, stations of free joints held.
pub(super) fn kink_rows(chain: &Chain) -> Vec<Row> {
    let free = |j: usize| chain.joints.get(j).is_some_and(|q| q.hold == Hold::Free);
    let mut out = Vec::with_capacity(chain.len());
    for j in 0..chain.len() {
        if let Some(i) = chain.before(j) {
            let mut row = Row { slope: 0.0, ..kink_row(chain, 1.0, i, j) };
            for (k, at) in [i, j, chain.end(j)].into_iter().enumerate() {
                if free(at) {
                    row.coefficients[k * BLOCK] = 0.0;
                }
            }
            out.push(row);
        }
    }
    out
}

fn kink_row(chain: &Chain, scale: f64, i: usize, j: usize) -> Row {
    let mut row = empty(i, chain.kink(j) * scale, 1.0);
    for (k, v) in tangent_row(chain, i, true).into_iter().enumerate() {
        row.coefficients[k] -= v * scale;
    }
    for (k, v) in tangent_row(chain, j, false).into_iter().enumerate() {
        row.coefficients[BLOCK + k] += v * scale;
    }
    row
}

/// Largest |value| of the minimax rows of `chain` without building them: deviation from the middle of the band at
/// samples (with the peak between samples by a parabola), at joints, and weighted tangent errors.
pub(super) fn measure(chain: &Chain, stretch: &Stretch<'_>, goal: &Goal) -> f64 {
    let mut worst = 0.0_f64;
    if (0..chain.len()).any(|i| chain.station_after(stretch, i) <= chain.joints[i].s) {
        return f64::INFINITY;
    }
    for (j, joint) in chain.joints.iter().enumerate() {
        worst = worst.max((joint.e - goal.band.middle).abs());
        worst = worst.max(chain.kink(j).abs() * goal.band.half / goal.tangent);
    }
    for i in 0..chain.len() {
        worst = worst.max(arc_measure(chain, stretch, goal, i));
    }
    worst
}

/// Largest distance of arc i from the middle of the band, mm.
pub(super) fn arc_measure(chain: &Chain, stretch: &Stretch<'_>, goal: &Goal, i: usize) -> f64 {
    if chain.is_exact(i) {
        return 0.0;
    }
    let circle = chain.drawn(i).circle();
    let a = &chain.joints[i];
    let b = &chain.joints[chain.end(i)];
    let mut worst = 0.0_f64;
    let mut last = [a.e - goal.band.middle; 2];
    for (_, q) in stretch.between(a.s, chain.station_after(stretch, i)) {
        let e = circle.deviation(q.p, q.n) - goal.band.middle;
        worst = worst.max(e.abs()).max(peak(last[0], last[1], e));
        last = [last[1], e];
    }
    worst.max(peak(last[0], last[1], b.e - goal.band.middle))
}

/// |peak| of the parabola through three equidistant values, 0 when the middle one is no extreme.
fn peak(a: f64, b: f64, c: f64) -> f64 {
    let (first, second) = (0.5 * (c - a), a - 2.0 * b + c);
    if (b - a) * (b - c) > 0.0 && second != 0.0 && first.abs() <= second.abs() {
        (b - 0.5 * first * first / second).abs()
    } else {
        0.0
    }
}
