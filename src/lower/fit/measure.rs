//! Certified deviation of one primitive from an exact curve.
//!
//! Where the curve's normal at u meets the primitive, its signed distance d(u) from the curve is the deviation there.
//! With φ the angle from the curve's tangent to the primitive's, d' = (1 - d κ) tan φ per arc length, so extremes lie
//! at the ends and where the two are parallel. Between two evaluations the extreme is found on the cubic that has
//! their values and slopes, evaluated exactly, and accepted when the cubic is right to the accuracy asked.

use crate::geom::curve::{Frenet, PlanarCurve};
use crate::geom::{Point2, Vec2, cross, left};
use crate::math;

/// A primitive as an exact curve of the part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Path {
    /// Straight line.
    Line {
        /// Start, mm.
        from: Point2,
        /// End, mm.
        to: Point2,
    },
    /// Circular arc.
    Arc {
        /// Centre, mm.
        centre: Point2,
        /// Radius, mm.
        radius: f64,
        /// Counter-clockwise.
        ccw: bool,
    },
    /// Archimedean spiral about the origin.
    Spiral {
        /// Start: radius mm, angle rad.
        from: (f64, f64),
        /// End.
        to: (f64, f64),
    },
}

/// Smallest and largest signed deviation, mm, left positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Smallest (farthest to the right).
    pub low: f64,
    /// Largest (farthest to the left).
    pub high: f64,
}

impl Range {
    /// Nothing measured yet.
    pub const EMPTY: Range = Range { low: f64::INFINITY, high: f64::NEG_INFINITY };
    /// With this deviation added.
    pub fn add(&mut self, d: f64) {
        self.low = self.low.min(d);
        self.high = self.high.max(d);
    }
    /// With another range added.
    pub fn join(&mut self, other: Range) {
        self.low = self.low.min(other.low);
        self.high = self.high.max(other.high);
    }
    /// Largest deviations to the left and to the right, both >= 0.
    #[must_use]
    pub fn sides(&self) -> (f64, f64) {
        (self.high.max(0.0), (-self.low).max(0.0))
    }
}

/// Where a curve's normal meets the path.
#[derive(Debug, Clone, Copy)]
pub struct Meeting {
    /// Signed distance from the curve, mm.
    pub d: f64,
    /// tan φ, φ from the curve's tangent to the path's.
    pub slope: f64,
}

impl Meeting {
    /// dd/du at this point of the curve.
    fn rate(&self, f: &Frenet) -> f64 {
        (1.0 - self.d * f.k) * self.slope * f.speed
    }
}

impl Path {
    /// The point at a share of the way; that of an arc, whose ends are not kept, is its centre.
    pub(super) fn at(&self, share: f64) -> Point2 {
        match *self {
            Path::Line { from, to } => from + (to - from) * share,
            Path::Spiral { from, to } => {
                let (r, angle) = (from.0 + (to.0 - from.0) * share, from.1 + (to.1 - from.1) * share);
                let (sin, cos) = math::sin_cos(angle);
                Point2::new(r * cos, r * sin)
            }
            Path::Arc { centre, .. } => centre,
        }
    }
    /// The length, or a little more, mm; of an arc, whose ends are not kept, a turn.
    pub(super) fn length(&self) -> f64 {
        match *self {
            Path::Line { from, to } => (to - from).norm(),
            Path::Spiral { from, to } => {
                (to.0 - from.0).abs() + from.0.abs().max(to.0.abs()) * (to.1 - from.1).abs()
            }
            Path::Arc { radius, .. } => math::TAU * radius,
        }
    }
    /// Where the normal of the curve at `f` meets the path; `None` where it does not.
    #[must_use]
    pub fn meet(&self, f: &Frenet) -> Option<Meeting> {
        match *self {
            Path::Line { from, to } => meet_line(f, from, to),
            Path::Arc { centre, radius, ccw } => meet_arc(f, centre, radius, ccw),
            Path::Spiral { from, to } => meet_spiral(f, from, to),
        }
    }
}

fn meet_line(f: &Frenet, from: Point2, to: Point2) -> Option<Meeting> {
    let e = to - from;
    let cos = f.t.dot(&e);
    let d = -cross(e, f.p - from) / cos;
    (cos > 0.0 && d.is_finite()).then(|| Meeting { d, slope: cross(f.t, e) / cos })
}

fn meet_arc(f: &Frenet, centre: Point2, radius: f64, ccw: bool) -> Option<Meeting> {
    let w = f.p - centre;
    let (along, across) = (w.dot(&f.t), w.dot(&f.n()));
    let root = (radius * radius - along * along).max(0.0).sqrt();
    // the nearer of the two points of the circle on the normal
    let outer = if across >= 0.0 { root } else { -root };
    let q = w + f.n() * (outer - across);
    let tangent = if ccw { left(q) } else { -left(q) };
    let cos = f.t.dot(&tangent);
    (cos > 0.0).then(|| Meeting { d: outer - across, slope: cross(f.t, tangent) / cos })
}

fn meet_spiral(f: &Frenet, from: (f64, f64), to: (f64, f64)) -> Option<Meeting> {
    let (dr, da) = (to.0 - from.0, to.1 - from.1);
    let middle = f64::midpoint(from.1, to.1);
    let n = f.n();
    let mut d = 0.0;
    for _ in 0..12 {
        let q = f.p + n * d;
        let r = math::hypot(q.x, q.y);
        let angle = math::atan2(q.y, q.x);
        let angle = angle + ((middle - angle) / math::TAU).round() * math::TAU;
        let (radial, around) = (n.dot(&q.coords) / r, cross(q.coords, n) / (r * r));
        let residual = (r - from.0) * da - (angle - from.1) * dr;
        let step = residual / (radial * da - around * dr);
        d -= step;
        if !d.is_finite() {
            return None;
        }
        if step.abs() < 1e-13 * (1.0 + r) {
            break;
        }
    }
    let q = (f.p + n * d).coords;
    let tangent = q.normalize() * dr + left(q) * da;
    let cos = f.t.dot(&tangent);
    (cos > 0.0).then(|| Meeting { d, slope: cross(f.t, tangent) / cos })
}

/// One evaluation of d(u).
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample {
    /// Parameter.
    pub u: f64,
    /// Deviation, mm.
    pub d: f64,
    /// dd/du.
    pub rate: f64,
}

impl Sample {
    /// At a point of the curve.
    pub(super) fn new(path: &Path, u: f64, f: &Frenet) -> Option<Sample> {
        path.meet(f).map(|m| Sample { u, d: m.d, rate: m.rate(f) })
    }
}

/// Value at share `s` of the cubic with the values and slopes of two samples.
fn cubic(a: &Sample, b: &Sample, s: f64) -> f64 {
    let h = b.u - a.u;
    let (s2, s3) = (s * s, s * s * s);
    a.d * (2.0 * s3 - 3.0 * s2 + 1.0)
        + h * a.rate * (s3 - 2.0 * s2 + s)
        + b.d * (3.0 * s2 - 2.0 * s3)
        + h * b.rate * (s3 - s2)
}

/// Shares in (0, 1) where that cubic is level.
fn level(a: &Sample, b: &Sample) -> [Option<f64>; 2] {
    let h = b.u - a.u;
    // derivative: c2 s² + c1 s + c0
    let (c0, step) = (h * a.rate, b.d - a.d);
    let c2 = 3.0 * (h * (a.rate + b.rate) - 2.0 * step);
    let c1 = 6.0 * step - 2.0 * h * (2.0 * a.rate + b.rate);
    let inside = |s: f64| (s > 0.0 && s < 1.0).then_some(s);
    let discriminant = c1 * c1 - 4.0 * c2 * c0;
    if discriminant < 0.0 {
        return [None, None];
    }
    let q = -0.5 * (c1 + discriminant.sqrt().copysign(c1));
    [inside(q / c2), inside(c0 / q)]
}

/// Adds the extremes between two neighbouring samples of one smooth span, to `accuracy` mm.
pub(super) fn between(
    curve: &dyn PlanarCurve,
    span: usize,
    path: &Path,
    (a, b): (Sample, Sample),
    accuracy: f64,
    range: &mut Range,
) {
    let mut stack = vec![(a, b, 0_u8)];
    while let Some((a, b, depth)) = stack.pop() {
        for s in level(&a, &b).into_iter().flatten() {
            let guess = cubic(&a, &b, s);
            if guess > range.low && guess < range.high {
                continue;
            }
            let u = a.u + (b.u - a.u) * s;
            let Some(exact) = Sample::new(path, u, &curve.at_in(span, u)) else { continue };
            range.add(exact.d);
            if (exact.d - guess).abs() > accuracy && depth < 40 {
                stack.push((a, exact, depth + 1));
                stack.push((exact, b, depth + 1));
            }
        }
    }
}

/// Smallest and largest deviation of the path from the curve between the parameters `u`, to `accuracy` mm.
///
/// The parameters are those of the feet of the path's ends; `None` where a normal in between does not meet the path.
/// At a break of the tangent the normals of both spans are measured; the fan between them is the caller's.
#[must_use]
pub fn deviation(curve: &dyn PlanarCurve, path: &Path, u: (f64, f64), accuracy: f64) -> Option<Range> {
    let breaks = curve.breaks();
    let mut range = Range::EMPTY;
    for span in 0..breaks.len().saturating_sub(1) {
        let (start, end) = (breaks[span].max(u.0), breaks[span + 1].min(u.1));
        if start <= end {
            on_span(curve, span, path, (start, end), accuracy, &mut range)?;
        }
    }
    (range.low <= range.high).then_some(range)
}

/// Pieces into which a span is cut before the cubic is trusted at all.
const PIECES: u32 = 8;

pub(super) fn on_span(
    curve: &dyn PlanarCurve,
    span: usize,
    path: &Path,
    (start, end): (f64, f64),
    accuracy: f64,
    range: &mut Range,
) -> Option<()> {
    let sample = |u: f64| Sample::new(path, u, &curve.at_in(span, u));
    let mut before = sample(start)?;
    range.add(before.d);
    let mut stack = Vec::new();
    for i in 1..=PIECES {
        let u = if i == PIECES { end } else { start + (end - start) * f64::from(i) / f64::from(PIECES) };
        let after = sample(u)?;
        range.add(after.d);
        stack.push((before, after, 0_u8));
        before = after;
    }
    while let Some((a, b, depth)) = stack.pop() {
        let middle = sample(f64::midpoint(a.u, b.u))?;
        range.add(middle.d);
        if (middle.d - cubic(&a, &b, 0.5)).abs() > accuracy / 4.0 && depth < 30 {
            stack.push((a, middle, depth + 1));
            stack.push((middle, b, depth + 1));
        } else {
            between(curve, span, path, (a, middle), accuracy, range);
            between(curve, span, path, (middle, b), accuracy, range);
        }
    }
    Some(())
}

/// Position of a vertex relative to a smooth span: the foot's parameter within `u` and the signed distance there;
/// `None` when the foot lies outside.
pub(super) fn foot(
    curve: &dyn PlanarCurve,
    span: usize,
    p: Point2,
    u: (f64, f64),
    guess: f64,
) -> Option<(f64, f64)> {
    let mut at = guess;
    for _ in 0..30 {
        let f = curve.at_in(span, at);
        let w: Vec2 = p - f.p;
        let step = w.dot(&f.t) / (f.speed * (1.0 - w.dot(&f.n()) * f.k).max(0.05));
        if !step.is_finite() {
            return None;
        }
        let next = (at + step).clamp(u.0, u.1);
        if (next - at).abs() <= 1e-13 * (u.1 - u.0).max(at.abs()) {
            let f = curve.at_in(span, next);
            let w = p - f.p;
            let inside = w.dot(&f.t).abs() <= 1e-9 * (1.0 + w.norm()) || (next > u.0 && next < u.1);
            return inside.then(|| (next, w.dot(&f.n())));
        }
        at = next;
    }
    None
}
