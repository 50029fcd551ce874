//! Where a cutter has room: the largest that fits a wall, and leads that touch nothing.
//!
//! Everything here chooses; nothing here proves. Walls are looked at through samples, and what was chosen is
//! proven exactly later, on the written text.

use crate::cl::Lead;
use crate::cl::lead::{self, LeadPath};
use crate::geom::curve::{Frenet, PlanarCurve, Shape};
use crate::geom::{Point2, Side, Vec2, cross};
use crate::math::{atan2, sin_cos};

/// Samples of one curve: enough that chords of a cam of 100 mm lie within about a micron of it.
const SAMPLES: usize = 720;
/// Samples a smooth span has at least.
const SAMPLES_PER_SPAN: usize = 4;
/// A lead may come this near to a wall by the samples' chord error, mm.
const CHORD_ERROR: f64 = 0.003;

/// A curve as points with tangents.
#[derive(Debug, Clone)]
pub(super) struct Samples {
    pub points: Vec<(f64, Frenet)>,
}

impl Samples {
    /// Evenly over the smooth spans by their share of the domain.
    pub fn new(curve: &dyn PlanarCurve) -> Samples {
        let (first, last) = curve.domain();
        let whole = (last - first).max(f64::MIN_POSITIVE);
        let mut points = Vec::with_capacity(SAMPLES + SAMPLES_PER_SPAN * curve.breaks().len());
        for (span, pair) in curve.breaks().windows(2).enumerate() {
            let share = (SAMPLES as f64 * (pair[1] - pair[0]) / whole).ceil() as usize;
            let count = share.clamp(SAMPLES_PER_SPAN, SAMPLES);
            points.extend((0..count).map(|i| {
                let u = pair[0] + (pair[1] - pair[0]) * i as f64 / count as f64;
                (u, curve.at_in(span, u))
            }));
        }
        let spans = curve.breaks().len().saturating_sub(1);
        points.push((last, curve.at_in(spans.saturating_sub(1), last)));
        Samples { points }
    }

    /// Signed distance of `p` from the sampled curve, positive on side `side`, mm.
    pub fn distance(&self, p: Point2, side: Side) -> f64 {
        let mut best = (f64::INFINITY, 1.0);
        for pair in self.points.windows(2) {
            let (a, b) = (pair[0].1.p, pair[1].1.p);
            let (squared, sign) = to_chord(p, a, b);
            if squared < best.0 {
                best = (squared, sign);
            }
        }
        best.0.sqrt() * best.1 * side.sign()
    }
}

/// Squared distance of `p` from the chord a-b, and +1 when it lies to the left of it.
fn to_chord(p: Point2, a: Point2, b: Point2) -> (f64, f64) {
    let (chord, to) = (b - a, p - a);
    let squared = chord.norm_squared();
    let x = if squared > 0.0 { (to.dot(&chord) / squared).clamp(0.0, 1.0) } else { 0.0 };
    let sign = if cross(chord, to) >= 0.0 { 1.0 } else { -1.0 };
    ((to - chord * x).norm_squared(), sign)
}

/// The largest circle that can roll along side `side` of a curve, touching it at every point: its radius, mm,
/// and where it is held. `None` when any circle can.
///
/// A circle that touches the curve at p (unit normal n towards the side) and passes through q has radius
/// |q - p|^2 / (2 (q - p)·n); the smallest over all pairs is the limit, the centre of curvature included.
pub(super) fn largest_rolling(samples: &Samples, side: Side) -> Option<(f64, Point2)> {
    let mut best: Option<(f64, Point2)> = None;
    let mut offer = |radius: f64, p: Point2| {
        if best.is_none_or(|(r, _)| radius < r) {
            best = Some((radius, p));
        }
    };
    for (_, f) in &samples.points {
        let bend = f.k * side.sign();
        if bend > 0.0 {
            offer(1.0 / bend, f.p);
        }
    }
    if samples.points.iter().any(|(_, f)| f.k * side.sign() > 0.0) {
        across(samples, side, &mut offer);
    }
    best
}

/// Pairs of points that are not neighbours.
fn across(samples: &Samples, side: Side, offer: &mut impl FnMut(f64, Point2)) {
    let normals: Vec<Vec2> = samples.points.iter().map(|(_, f)| f.n() * side.sign()).collect();
    for ((_, f), n) in samples.points.iter().zip(&normals) {
        for (_, g) in &samples.points {
            let d = g.p - f.p;
            let height = d.dot(n);
            let squared = d.norm_squared();
            // Neighbours say what the curvature says, with rounding; they are left to it.
            let is_neighbour = height * height < squared * 1e-4;
            if height > 0.0 && !is_neighbour {
                offer(squared / (2.0 * height), f.p);
            }
        }
    }
}

/// A wall that leads must stay clear of: the curve of exact contact of the cutter's centre.
pub(super) struct Wall {
    pub samples: Samples,
    pub part: Side,
}

/// Whether no point of the lead comes nearer to a wall than contact.
fn clear(path: &LeadPath, walls: &[Wall]) -> bool {
    let free = |p: Point2| walls.iter().all(|w| w.samples.distance(p, w.part.opposite()) >= -CHORD_ERROR);
    points_of(path).into_iter().all(free)
}

/// Points along a lead, ends included.
fn points_of(path: &LeadPath) -> Vec<Point2> {
    const PIECES: i32 = 16;
    match *path {
        LeadPath::Point(p) => vec![p],
        LeadPath::Line { from, to } => {
            (0..=PIECES).map(|i| from + (to - from) * (f64::from(i) / f64::from(PIECES))).collect()
        }
        LeadPath::Arc { from, centre, radius, ccw, .. } => {
            let start = from - centre;
            let angle = atan2(start.y, start.x);
            let turn = if ccw { 1.0 } else { -1.0 } * core::f64::consts::FRAC_PI_2;
            (0..=PIECES)
                .map(|i| {
                    let (s, c) = sin_cos(angle + turn * f64::from(i) / f64::from(PIECES));
                    centre + Vec2::new(c, s) * radius
                })
                .collect()
        }
    }
}

/// Whether the lead and its mirror image, the lead out, are clear at this point of the contour.
fn fits(lead: Lead, at: &Frenet, end: &Frenet, part: Side, walls: &[Wall]) -> bool {
    clear(&lead::entry(lead, at, part), walls) && clear(&lead::exit(lead, end, part), walls)
}

/// A lead that fits, and where.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Placed {
    pub lead: Lead,
    /// Start parameter of a closed contour.
    pub start: Option<f64>,
}

/// The longest lead of the wanted kind not over `wanted` mm that fits somewhere, at the best place for it;
/// a plunge when there is none.
pub(super) fn place(
    curve: &dyn PlanarCurve,
    part: Side,
    walls: &[Wall],
    wanted: f64,
    kind: fn(f64) -> Lead,
) -> Placed {
    /// A lead shorter than this, mm, is of no use.
    const SHORTEST: f64 = 0.1;
    const SHRINK: f64 = 0.75;
    let places = candidates(curve);
    let mut size = wanted;
    while size >= SHORTEST {
        let found = places.iter().find(|(_, at, end)| fits(kind(size), at, end, part, walls));
        if let Some((u, _, _)) = found {
            return Placed { lead: kind(size), start: curve.is_closed().then_some(*u) };
        }
        size *= SHRINK;
    }
    let start = places.first().map(|(u, _, _)| *u).filter(|_| curve.is_closed());
    Placed { lead: Lead::Plunge, start }
}

/// Places for the start, best first, with the Frenet data of first and last point: the middles of exact arcs
/// and lines, longest first, then where the curvature is smallest. An open curve starts where it starts.
fn candidates(curve: &dyn PlanarCurve) -> Vec<(f64, Frenet, Frenet)> {
    const SPREAD: usize = 30;
    let (first, last) = curve.domain();
    let spans = curve.breaks().len().saturating_sub(1);
    if !curve.is_closed() {
        return vec![(first, curve.at(first), curve.at_in(spans.saturating_sub(1), last))];
    }
    let mut exact: Vec<(f64, f64)> = curve
        .breaks()
        .windows(2)
        .enumerate()
        .filter(|(span, _)| curve.shape(*span) != Shape::General)
        .map(|(span, pair)| {
            let middle = 0.5 * (pair[0] + pair[1]);
            (middle, (pair[1] - pair[0]) * curve.at_in(span, middle).speed.abs())
        })
        .collect();
    exact.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut spread: Vec<(f64, f64)> = (0..SPREAD)
        .map(|i| first + (last - first) * (i as f64 + 0.5) / SPREAD as f64)
        .map(|u| (u, curve.at(u).k.abs()))
        .collect();
    spread.sort_by(|a, b| a.1.total_cmp(&b.1));
    exact.into_iter().chain(spread).map(|(u, _)| (u, curve.at(u), curve.at(u))).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::geom::curve::{CircularArc, CurveRef};

    fn circle(radius: f64) -> CurveRef {
        Arc::new(CircularArc::circle(Point2::origin(), radius, 0.0, true).expect("circle"))
    }

    #[test]
    fn inside_a_circle_the_circle_itself_is_the_largest_that_rolls() {
        let samples = Samples::new(circle(12.0).as_ref());
        let (radius, _) = largest_rolling(&samples, Side::Left).expect("held inside");
        assert!((radius - 12.0).abs() < 1e-9);
        assert_eq!(largest_rolling(&samples, Side::Right), None);
    }

    #[test]
    fn leads_in_a_ring_shrink_to_its_width() {
        let inner = Wall { samples: Samples::new(circle(20.0).as_ref()), part: Side::Left };
        let outer = Wall { samples: Samples::new(circle(23.0).as_ref()), part: Side::Right };
        let walls = [inner, outer];
        let placed = place(circle(20.0).as_ref(), Side::Left, &walls, 8.0, Lead::Arc);
        let Lead::Arc(radius) = placed.lead else { panic!("{placed:?}") };
        assert!(radius > 1.5 && radius < 3.0, "{radius}");
        let free = place(circle(20.0).as_ref(), Side::Left, &walls[..1], 8.0, Lead::Arc);
        assert_eq!(free.lead, Lead::Arc(8.0));
    }

    #[test]
    fn with_no_room_at_all_the_cutter_plunges() {
        let inner = Wall { samples: Samples::new(circle(20.0).as_ref()), part: Side::Left };
        let outer = Wall { samples: Samples::new(circle(20.0).as_ref()), part: Side::Right };
        let placed = place(circle(20.0).as_ref(), Side::Left, &[inner, outer], 8.0, Lead::Arc);
        assert_eq!(placed.lead, Lead::Plunge);
    }
}
