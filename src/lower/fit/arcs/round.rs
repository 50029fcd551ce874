//! Rounding a chain to the controller's grid.
//!
//! A joint may slide along the path without changing it, so among the grid points along the path there is one that
//! lies almost on it; likewise a centre may slide along the perpendicular bisector of the printed chord.

use super::certify::{Extremes, Printed, extremes};
use super::chain::{Band, Chain, Goal, Hold, Joint, Member};
use super::optimise::{Stop, improve};
use super::stretch::{Stretch, turn};
use crate::geom::{Point2, Vec2, left};
use crate::lower::fit::{FitError, Grid, Primitive};
use crate::math;

/// Largest tangent error of a printed joint, radians.
pub(super) const JOINT_TANGENT: f64 = 0.05 * math::DEG;
/// Largest difference of an arc's radii at its ends, mm (0.002 mm or 0.0002 in, whichever is less).
pub(super) const RADIUS_MISMATCH: f64 = 0.002;
/// Share of the shorter arc beside it by which a joint may slide.
const SLIDE: f64 = 0.04;
/// Most grid steps by which a joint slides.
const SLIDE_STEPS: i64 = 60;
/// Tangent errors weigh as much as half the band at this many radians when the half sweeps are adapted to the
/// rounded joints.
const ROUNDED_TANGENT: f64 = 0.03 * math::DEG;
/// Minimax steps that adapt the half sweeps.
const ADAPTATIONS: usize = 4;
/// Share of half the band that a sliding centre may move an arc by.
const CENTRE_SHARE: f64 = 0.02;
/// Most grid steps by which a centre slides.
const CENTRE_STEPS: i64 = 24;
/// Change of an arc's half sweep that a sliding centre may cause, radians.
const CENTRE_TILT: f64 = 0.006 * math::DEG;
/// Coordinates beyond this many steps are refused.
const MOST_STEPS: f64 = 9.0e15;

/// What rounding may do.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// Largest left and right deviation, mm.
    pub left: f64,
    /// Largest right deviation, mm.
    pub right: f64,
    /// Largest radius of an arc, mm; flatter ones become lines.
    pub radius: f64,
}

/// A rounded chain.
#[derive(Debug, Clone)]
pub(super) struct Rounded {
    /// Start in grid steps.
    pub start: [i64; 2],
    /// Primitives.
    pub primitives: Vec<Primitive>,
    /// Certified deviation.
    pub extremes: Extremes,
    /// Largest tangent error at a joint, radians.
    pub kink: f64,
    /// Largest difference of radii, mm.
    pub mismatch: f64,
    /// Where the deviation is worst, mm.
    pub worst_at: Point2,
}

impl Limits {
    /// The band by middle and half width.
    pub fn band(&self) -> Band {
        Band { middle: 0.5 * (self.left - self.right), half: 0.5 * (self.left + self.right) }
    }
}

impl Rounded {
    /// Whether everything is within its limits.
    pub fn good(&self, limits: &Limits) -> bool {
        self.extremes.high <= limits.left
            && self.extremes.low >= -limits.right
            && self.kink <= JOINT_TANGENT
            && self.mismatch <= RADIUS_MISMATCH
    }
}

/// A point of the grid.
pub(super) fn point(grid: &Grid, q: [i64; 2]) -> Point2 {
    Point2::new(q[0] as f64 * grid.step, q[1] as f64 * grid.step)
}

/// Nearest grid point.
pub(super) fn nearest(grid: &Grid, p: Point2) -> Result<[i64; 2], FitError> {
    let (x, y) = ((p.x / grid.step).round(), (p.y / grid.step).round());
    if x.abs() < MOST_STEPS && y.abs() < MOST_STEPS {
        Ok([x as i64, y as i64])
    } else {
        Err(FitError::TooLarge { at: p })
    }
}

/// A joint after rounding.
#[derive(Debug, Clone, Copy)]
struct Node {
    q: [i64; 2],
    p: Point2,
    /// Station of its foot.
    s: f64,
}

/// Rounds a chain and certifies it.
pub(super) fn round(
    chain: &Chain,
    stretch: &Stretch<'_>,
    grid: &Grid,
    limits: &Limits,
) -> Result<Rounded, FitError> {
    let band = limits.band();
    let nodes: Vec<Node> =
        (0..chain.joints.len()).map(|j| node(chain, stretch, grid, &band, j)).collect::<Result<_, _>>()?;
    let fixed = adapted(chain, stretch, &band, &nodes);
    let mut printed = Vec::with_capacity(chain.len());
    let mut primitives = Vec::with_capacity(chain.len());
    for i in 0..chain.len() {
        let (a, b) = (&nodes[i], &nodes[chain.end(i)]);
        let (primitive, arc) = member(&fixed, grid, limits, i, a, b);
        primitives.push(primitive);
        printed.push(arc);
    }
    Ok(judge(chain, stretch, &nodes, primitives, &printed))
}

/// The chain through the nodes, its half sweeps adapted to them.
fn adapted(chain: &Chain, stretch: &Stretch<'_>, band: &Band, nodes: &[Node]) -> Chain {
    let mut fixed = chain.clone();
    for (joint, node) in fixed.joints.iter_mut().zip(nodes) {
        let frame = if joint.hold == Hold::Vertex { joint.frame } else { stretch.at(node.s) };
        let e = (node.p - frame.p).dot(&left(frame.t));
        *joint = Joint { s: node.s, e, hold: Hold::Vertex, frame, p: node.p };
    }
    for i in 0..fixed.len() {
        if let Member::Arc(half) = fixed.members[i] {
            // The same curvature over the rounded chord.
            let ratio = fixed.drawn(i).length / chain.drawn(i).length.max(1e-300);
            let sine = math::sin(half);
            let change = sine * (ratio - 1.0) / math::cos(half).abs().max(0.2) * math::cos(half).signum();
            fixed.members[i] = Member::Arc(half + change);
        }
    }
    let goal = Goal { band: *band, tangent: ROUNDED_TANGENT };
    let stop = Stop { target: 0.0, iterations: ADAPTATIONS, gain: 1e-2, smooth: false };
    improve(fixed, stretch, &goal, &stop).0
}

fn judge(
    chain: &Chain,
    stretch: &Stretch<'_>,
    nodes: &[Node],
    primitives: Vec<Primitive>,
    printed: &[Printed],
) -> Rounded {
    let mut all = Extremes::NONE;
    let (mut mismatch, mut worst_at) = (0.0_f64, nodes[0].p);
    for (i, arc) in printed.iter().enumerate() {
        let to = nodes[chain.end(i)].s + if chain.end(i) == 0 { stretch.length() } else { 0.0 };
        let found = extremes(stretch, *arc, nodes[i].s, to.max(nodes[i].s));
        if found.high > all.high || found.low < all.low {
            worst_at = arc.from;
        }
        all.join(found);
        if let Some((r0, r1)) = arc.radii() {
            mismatch = mismatch.max((r0 - r1).abs());
        }
    }
    let kink = (0..chain.len())
        .filter_map(|j| chain.before(j).map(|i| turn(printed[i].tangents().1, printed[j].tangents().0).abs()))
        .fold(0.0, f64::max);
    Rounded { start: nodes[0].q, primitives, extremes: all, kink, mismatch, worst_at }
}

/// Grid point for joint j: the one that disturbs the path least among those a short slide away.
///
/// A slide by x turns the path by Δk x, a miss by η across it by about η (1/l + 1/l') and moves it by η.
fn node(chain: &Chain, stretch: &Stretch<'_>, grid: &Grid, band: &Band, j: usize) -> Result<Node, FitError> {
    let joint = &chain.joints[j];
    let first = nearest(grid, joint.p)?;
    let arcs = [chain.before(j), (j < chain.len()).then_some(j)]
        .map(|i| i.map(|i| (chain.drawn(i), chain.is_exact(i))));
    let length = arcs.iter().flatten().fold(f64::INFINITY, |m, (d, _)| m.min(d.length));
    let steps = match joint.hold {
        Hold::Free | Hold::Circle { .. } | Hold::Point => {
            ((SLIDE * length / grid.step) as i64).min(SLIDE_STEPS)
        }
        Hold::Station | Hold::Vertex => 0,
    };
    let jump = match arcs {
        [Some((a, _)), Some((b, _))] => (a.curvature() - b.curvature()).abs(),
        _ => 0.0,
    };
    let stiffness: f64 = arcs.iter().flatten().map(|(d, _)| 1.0 / d.length).sum();
    let t = match arcs {
        [_, Some((d, _))] => d.tangents().0,
        [Some((d, _)), None] => d.tangents().1,
        [None, None] => joint.frame.t,
    };
    // Arcs that are kept are missed by as little as possible.
    let exact = if arcs.iter().flatten().any(|(_, exact)| *exact) { 10.0 } else { 1.0 };
    let cost = |p: Point2| {
        let x = (p - joint.p).dot(&t);
        let miss =
            arcs.iter().flatten().fold(0.0_f64, |m, (d, _)| m.max(d.circle().deviation(p, left(t)).abs()));
        (jump * x.abs() + stiffness * miss) / ROUNDED_TANGENT
            + exact * miss / (0.2 * band.half)
            + 1e-6 * x.abs()
    };
    let mut best = (cost(point(grid, first)), first);
    for i in 0..=steps {
        if jump * i as f64 * grid.step > best.0 * ROUNDED_TANGENT {
            break;
        }
        for sign in [-1.0, 1.0] {
            // One candidate per step along the coordinate that changes fastest, the other rounded.
            let along = t * (sign * i as f64 * grid.step / t.x.abs().max(t.y.abs()));
            let bend = left(t) * (0.5 * joint.frame.k * along.norm_squared());
            let q = nearest(grid, joint.p + along + bend)?;
            let found = cost(point(grid, q));
            if found < best.0 {
                best = (found, q);
            }
        }
    }
    let p = point(grid, best.1);
    Ok(Node { q: best.1, p, s: foot(stretch, joint, p) })
}

/// Station of the foot of `p`, near that of the joint.
pub(super) fn foot(stretch: &Stretch<'_>, joint: &Joint, p: Point2) -> f64 {
    let mut s = joint.s;
    for _ in 0..4 {
        let f = stretch.at(s);
        let w = p - f.p;
        let slope = f.speed * (1.0 - f.k * w.dot(&left(f.t)));
        let next = s + w.dot(&f.t) / slope.max(0.1);
        s = if stretch.closed { next } else { next.clamp(0.0, stretch.length()) };
    }
    s
}

/// Prints member i between two nodes.
fn member(chain: &Chain, grid: &Grid, limits: &Limits, i: usize, a: &Node, b: &Node) -> (Primitive, Printed) {
    let line = (Primitive::Line { to: b.q }, Printed { from: a.p, to: b.p, centre: None });
    let arc = |offset: [i64; 2], centre: Point2, ccw: bool| {
        (
            Primitive::Arc { to: b.q, centre: offset, clockwise: !ccw },
            Printed { from: a.p, to: b.p, centre: Some((centre, ccw)) },
        )
    };
    match chain.members[i] {
        Member::Line => line,
        Member::Exact { centre, ccw } => {
            let offset = offset_words(grid, a.p, centre);
            arc(offset, centre_point(grid, a.p, offset), ccw)
        }
        Member::Arc(half) => {
            let length = (b.p - a.p).norm();
            if 2.0 * math::sin(half).abs() * limits.radius < length {
                return line;
            }
            let (offset, centre) = slide_centre(grid, &limits.band(), a, b, half, length);
            arc(offset, centre, half > 0.0)
        }
    }
}

fn offset_words(grid: &Grid, from: Point2, centre: Point2) -> [i64; 2] {
    let d = (centre - from) / grid.centre_step;
    [d.x.round().clamp(-MOST_STEPS, MOST_STEPS) as i64, d.y.round().clamp(-MOST_STEPS, MOST_STEPS) as i64]
}

fn centre_point(grid: &Grid, from: Point2, offset: [i64; 2]) -> Point2 {
    from + Vec2::new(offset[0] as f64, offset[1] as f64) * grid.centre_step
}

/// Centre words near the perpendicular bisector, with the least difference of radii a short slide away.
fn slide_centre(grid: &Grid, band: &Band, a: &Node, b: &Node, half: f64, length: f64) -> ([i64; 2], Point2) {
    let chord = (b.p - a.p) / length;
    let axis = left(chord);
    let (sin, cos) = math::sin_cos(half);
    let ideal = a.p + (b.p - a.p) * 0.5 + axis * (0.5 * length * cos / sin);
    // d(half) = 2 sin² half / length · d(centre)
    let tilt = CENTRE_TILT.min(CENTRE_SHARE * band.half * 4.0 / length);
    let reach = tilt * length / (2.0 * sin * sin);
    let steps = ((reach / grid.centre_step) as i64).min(CENTRE_STEPS);
    let cost = |c: Point2| {
        let radii = ((a.p - c).norm() - (b.p - c).norm()).abs();
        let tilt = (c - ideal).dot(&axis).abs() / reach;
        radii / (0.1 * RADIUS_MISMATCH) + 0.3 * tilt
    };
    let mut best = (f64::INFINITY, [0, 0], ideal);
    for i in -steps..=steps {
        let target = ideal + axis * (i as f64 * grid.centre_step / axis.x.abs().max(axis.y.abs()));
        let offset = offset_words(grid, a.p, target);
        let centre = centre_point(grid, a.p, offset);
        let found = cost(centre);
        if found < best.0 {
            best = (found, offset, centre);
        }
    }
    (best.1, best.2)
}
