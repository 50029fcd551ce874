//! Rounding a chain to the controller's grid.
//!
//! A joint may slide along the path without changing it, so among the grid points along the path there is one that
//! lies almost on it; likewise a centre may slide along the perpendicular bisector of the printed chord.

use super::certify::{Extremes, Printed, extremes};
use super::chain::{Chain, Hold, Joint, Member};
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
const SLIDE_STEPS: i64 = 24;
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
    /// Tangent of the path there.
    t: Vec2,
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
    let nodes: Vec<Node> =
        (0..chain.joints.len()).map(|j| node(chain, stretch, grid, j)).collect::<Result<_, _>>()?;
    let mut printed = Vec::with_capacity(chain.len());
    let mut primitives = Vec::with_capacity(chain.len());
    for i in 0..chain.len() {
        let (a, b) = (&nodes[i], &nodes[chain.end(i)]);
        let (primitive, arc) = member(chain, grid, limits, i, a, b);
        primitives.push(primitive);
        printed.push(arc);
    }
    Ok(judge(chain, stretch, &nodes, primitives, &printed))
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

/// Grid point for joint j: the one nearest to the path among those a short slide away.
fn node(chain: &Chain, stretch: &Stretch<'_>, grid: &Grid, j: usize) -> Result<Node, FitError> {
    let joint = &chain.joints[j];
    let before = chain.before(j);
    let after = (j < chain.len()).then_some(j);
    let length = |i: Option<usize>| i.map_or(f64::INFINITY, |i| chain.drawn(i).length);
    let room = SLIDE * length(before).min(length(after));
    let steps = match joint.hold {
        Hold::Free | Hold::Circle { .. } | Hold::Point => ((room / grid.step) as i64).min(SLIDE_STEPS),
        Hold::Station | Hold::Vertex => 0,
    };
    let circles = [before, after].map(|i| i.map(|i| chain.drawn(i).circle()));
    let t = after.map_or_else(
        || before.map_or(joint.frame.t, |i| chain.drawn(i).tangents().1),
        |i| chain.drawn(i).tangents().0,
    );
    let miss = |p: Point2| {
        circles.iter().flatten().fold(0.0_f64, |m, c| m.max(c.deviation(p, left(t)).abs()))
            + 1e-3 * (p - joint.p).norm()
    };
    let mut best = (f64::INFINITY, nearest(grid, joint.p)?);
    for i in -steps..=steps {
        // One candidate per step along the coordinate that changes fastest, the other rounded.
        let along = t * (i as f64 * grid.step / t.x.abs().max(t.y.abs()));
        let bend = left(t) * (0.5 * joint.frame.k * along.norm_squared());
        let q = nearest(grid, joint.p + along + bend)?;
        let found = miss(point(grid, q));
        if found < best.0 {
            best = (found, q);
        }
    }
    Ok(placed(chain, stretch, grid, j, best.1))
}

/// The node at grid point `q` for joint j: its foot and the path's tangent there.
fn placed(chain: &Chain, stretch: &Stretch<'_>, grid: &Grid, j: usize, q: [i64; 2]) -> Node {
    let joint = &chain.joints[j];
    let p = point(grid, q);
    let s = foot(stretch, joint, p);
    let ahead = (p - joint.p).dot(&joint.frame.t);
    let i = if ahead >= 0.0 && j < chain.len() || chain.before(j).is_none() {
        j
    } else {
        chain.before(j).unwrap_or(j)
    };
    let d = chain.drawn(i);
    let base = if i == j { d.tangents().0 } else { d.tangents().1 };
    let (sin, cos) = math::sin_cos(d.curvature() * ahead);
    Node { q, p, t: base * cos + left(base) * sin, s }
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
        Member::Arc(whole) => {
            let half = 0.5 * turn_near(a.t, b.t, 2.0 * whole);
            let length = (b.p - a.p).norm();
            if 2.0 * math::sin(half).abs() * limits.radius < length {
                return line;
            }
            let (offset, centre) = slide_centre(grid, a, b, half, length);
            arc(offset, centre, half > 0.0)
        }
    }
}

/// Angle from `a` to `b` in the turn nearest to `near`.
fn turn_near(a: Vec2, b: Vec2, near: f64) -> f64 {
    let angle = turn(a, b);
    angle + math::TAU * ((near - angle) / math::TAU).round()
}

fn offset_words(grid: &Grid, from: Point2, centre: Point2) -> [i64; 2] {
    let d = (centre - from) / grid.centre_step;
    [d.x.round().clamp(-MOST_STEPS, MOST_STEPS) as i64, d.y.round().clamp(-MOST_STEPS, MOST_STEPS) as i64]
}

fn centre_point(grid: &Grid, from: Point2, offset: [i64; 2]) -> Point2 {
    from + Vec2::new(offset[0] as f64, offset[1] as f64) * grid.centre_step
}

/// Centre words near the perpendicular bisector, with the least difference of radii a short slide away.
fn slide_centre(grid: &Grid, a: &Node, b: &Node, half: f64, length: f64) -> ([i64; 2], Point2) {
    let chord = (b.p - a.p) / length;
    let axis = left(chord);
    let (sin, cos) = math::sin_cos(half);
    let ideal = a.p + (b.p - a.p) * 0.5 + axis * (0.5 * length * cos / sin);
    // d(half) = 2 sin² half / length · d(centre)
    let reach = CENTRE_TILT * length / (2.0 * sin * sin);
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
