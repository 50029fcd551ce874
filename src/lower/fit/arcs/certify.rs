//! Certified deviation of printed arcs from the exact curve.
//!
//! e(s), the signed distance from the curve to the arc along the curve's normal, obeys e'' = kₐ - k up to terms of
//! second order in the tilt, so between two stations |e''| has a known bound and branch and bound finds the extremes.

use super::stretch::Stretch;
use crate::geom::{Point2, Vec2, left};
use crate::math;

/// Error of a certified extreme, mm.
const ACCURACY: f64 = 1e-7;
/// Bisections of one interval at most.
const DEPTH: u32 = 40;
/// Factor on the bound of |e''| for the neglected terms of second order.
const SAFETY: f64 = 1.1;

/// A printed arc: the control goes about `centre`, the radius linear in the swept angle; straight without a centre.
#[derive(Debug, Clone, Copy)]
pub(super) struct Printed {
    /// Start, mm.
    pub from: Point2,
    /// End, mm.
    pub to: Point2,
    /// Centre, mm, and sense (`true`: left).
    pub centre: Option<(Point2, bool)>,
}

impl Printed {
    /// Radii at start and end, mm; none for a line.
    pub fn radii(&self) -> Option<(f64, f64)> {
        self.centre.map(|(c, _)| ((self.from - c).norm(), (self.to - c).norm()))
    }

    /// Sweep, radians, left positive; a whole turn when the ends agree; 0 for a line.
    pub fn sweep(&self) -> f64 {
        self.centre.map_or(0.0, |(c, ccw)| 2.0 * super::chain::exact_half(self.from, self.to, c, ccw))
    }

    /// Unit tangents at start and end, at right angles to the radius.
    pub fn tangents(&self) -> (Vec2, Vec2) {
        match self.centre {
            None => {
                let t = (self.to - self.from).normalize();
                (t, t)
            }
            Some((c, ccw)) => {
                let sign = if ccw { 1.0 } else { -1.0 };
                let at = |p: Point2| left(p - c).normalize() * sign;
                (at(self.from), at(self.to))
            }
        }
    }
}

/// A printed arc prepared for deviations.
struct Probe {
    printed: Printed,
    normal: Vec2,
    curvature: f64,
    /// Radius gained per unit of sweep, mm/rad.
    gain: f64,
    radius: f64,
}

/// Extremes found so far: least and largest deviation, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extremes {
    /// Least, mm.
    pub low: f64,
    /// Largest, mm.
    pub high: f64,
}

impl Extremes {
    /// Nothing seen yet.
    pub const NONE: Extremes = Extremes { low: f64::INFINITY, high: f64::NEG_INFINITY };

    /// Takes in a deviation.
    pub fn add(&mut self, e: f64) {
        self.low = self.low.min(e);
        self.high = self.high.max(e);
    }

    /// Takes in the extremes of another part.
    pub fn join(&mut self, other: Extremes) {
        self.low = self.low.min(other.low);
        self.high = self.high.max(other.high);
    }
}

/// One station: its deviations (as a circle of the start radius, and with the radius drawn linearly) and curvature.
#[derive(Debug, Clone, Copy)]
struct Station {
    s: f64,
    e: [f64; 2],
    k: f64,
}

impl Probe {
    fn new(printed: Printed) -> Probe {
        let (r0, r1) = printed.radii().unwrap_or((f64::INFINITY, f64::INFINITY));
        let ccw = printed.centre.is_some_and(|(_, ccw)| ccw);
        let gain = if printed.centre.is_some() { (r1 - r0) / printed.sweep().abs().max(1e-9) } else { 0.0 };
        let sign = if ccw { 1.0 } else { -1.0 };
        Probe { normal: left(printed.tangents().0), curvature: sign / r0, gain, radius: r0, printed }
    }

    /// Deviation along normal `n` at `q` as a circle of the start radius, and with the radius linear in the angle.
    fn deviations(&self, q: Point2, n: Vec2) -> [f64; 2] {
        let circle = super::chain::Circle { p: self.printed.from, n: self.normal, k: self.curvature };
        let round = circle.deviation(q, n);
        let Some((centre, ccw)) = self.printed.centre else { return [round, round] };
        let angle = super::stretch::turn(self.printed.from - centre, q - centre);
        let sweep = self.printed.sweep().abs();
        let mut along = if ccw { angle } else { -angle };
        if along < 0.5 * sweep - math::PI {
            along += math::TAU;
        }
        // The normal meets the radius at an angle whose cosine differs from one by the square of the tilt.
        let growth = self.gain * along.clamp(0.0, sweep.max(1e-9));
        [round, if ccw { round - growth } else { round + growth }]
    }

    fn station(&self, stretch: &Stretch<'_>, s: f64) -> Station {
        let f = stretch.at(s);
        Station { s, e: self.deviations(f.p, left(f.t)), k: f.k }
    }

    fn search(&self, stretch: &Stretch<'_>, a: Station, b: Station, depth: u32, out: &mut Extremes) {
        let h = b.s - a.s;
        let spread = (a.k - b.k).abs();
        let bend = (a.k - self.curvature).abs().max((b.k - self.curvature).abs()) + spread;
        let spiral = 2.0 * (self.gain / self.radius / self.radius).abs();
        let rise = SAFETY * (bend + spiral) * h * h / 8.0;
        for (x, y) in a.e.into_iter().zip(b.e) {
            out.add(x);
            out.add(y);
        }
        let high = a.e[0].max(b.e[0]).max(a.e[1]).max(b.e[1]) + rise;
        let low = a.e[0].min(b.e[0]).min(a.e[1]).min(b.e[1]) - rise;
        if depth == 0 || (high <= out.high + ACCURACY && low >= out.low - ACCURACY) || !high.is_finite() {
            return;
        }
        let m = self.station(stretch, 0.5 * (a.s + b.s));
        self.search(stretch, a, m, depth - 1, out);
        self.search(stretch, m, b, depth - 1, out);
    }
}

/// Extremes of the deviation of a printed arc between two stations (unwrapped, ascending).
pub(super) fn extremes(stretch: &Stretch<'_>, printed: Printed, from: f64, to: f64) -> Extremes {
    let probe = Probe::new(printed);
    let mut out = Extremes::NONE;
    let mut stations = vec![probe.station(stretch, from)];
    for (s, q) in stretch.between(from, to) {
        stations.push(Station { s, e: probe.deviations(q.p, q.n), k: q.k });
    }
    stations.push(probe.station(stretch, to));
    for e in stations.iter().flat_map(|q| q.e) {
        out.add(e);
    }
    for pair in stations.windows(2) {
        probe.search(stretch, pair[0], pair[1], DEPTH, &mut out);
    }
    out
}
