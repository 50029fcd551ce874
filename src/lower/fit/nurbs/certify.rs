//! Certified deviation of a printed spline from the exact curve.
//!
//! With e(t) = (X(t) - C(s(t)))·n(s) at the foot s(t): e' = X'·n and e'' = X''·n - k (X'·t)²/(1 - k e).

use super::spline::{ORDER, Spline, interval};
use crate::geom::left;
use crate::lower::fit::arcs::stretch::Stretch;

/// Error of a certified extreme, mm.
const ACCURACY: f64 = 1e-7;
/// Bisections of one interval at most.
const DEPTH: u32 = 40;
/// Pieces of a knot interval to begin with.
const PIECES: u32 = 12;
/// Factor on the bound of |e''|.
const SAFETY: f64 = 1.2;

/// Deviation at one parameter.
#[derive(Debug, Clone, Copy)]
pub(super) struct Station {
    /// Spline parameter.
    pub t: f64,
    /// Station of the foot on the curve, mm, unwrapped.
    pub s: f64,
    /// Deviation, left positive, mm.
    pub e: f64,
    /// Second derivative of the deviation by the parameter.
    bend: f64,
    /// Whether the spline goes forward along the curve here.
    forward: bool,
}

/// Deviation of the spline's point at `t` in knot interval `i`, the foot sought from `near`.
pub(super) fn station(spline: &Spline<2>, stretch: &Stretch<'_>, i: usize, t: f64, near: f64) -> Station {
    let jet = spline.jet(i, t);
    let mut s = near;
    let mut f = stretch.at(s);
    for _ in 0..8 {
        let w = jet.p - f.p;
        let along = w.dot(&f.t);
        if along.abs() < 1e-10 {
            break;
        }
        let slope = f.speed * (1.0 - f.k * w.dot(&left(f.t))).max(0.1);
        s += along / slope;
        if !stretch.closed {
            s = s.clamp(0.0, stretch.length());
        }
        f = stretch.at(s);
    }
    let n = left(f.t);
    let e = (jet.p - f.p).dot(&n);
    let run = jet.d.dot(&f.t);
    let bend = jet.dd.dot(&n) - f.k * run * run / (1.0 - f.k * e).max(0.1);
    Station { t, s, e, bend, forward: run > 0.0 }
}

/// Least and largest deviation, mm; without bound for a spline that runs back along the curve somewhere.
pub(super) fn extremes(spline: &Spline<2>, stretch: &Stretch<'_>, start: f64) -> (f64, f64) {
    let mut found = (f64::INFINITY, f64::NEG_INFINITY);
    let mut near = start;
    for i in ORDER - 1..spline.points.len() {
        let (a, b) = (spline.knots[i], spline.knots[i + 1]);
        if b <= a {
            continue;
        }
        let mut from = station(spline, stretch, i, a, near);
        for j in 1..=PIECES {
            let t = if j == PIECES { b } else { a + (b - a) * f64::from(j) / f64::from(PIECES) };
            let to = station(spline, stretch, i, t, from.s);
            search(spline, stretch, i, [from, to], DEPTH, &mut found);
            from = to;
        }
        near = from.s;
    }
    found
}

fn search(
    spline: &Spline<2>,
    stretch: &Stretch<'_>,
    i: usize,
    [a, b]: [Station; 2],
    depth: u32,
    found: &mut (f64, f64),
) {
    found.0 = found.0.min(a.e).min(b.e);
    found.1 = found.1.max(a.e).max(b.e);
    // The last vertex is on the grid: it may lie beyond the end of an open curve, where the foot stands still.
    let at_end = !stretch.closed && a.s <= b.s && (b.s <= 0.0 || a.s >= stretch.length());
    if !(a.forward && b.forward && (b.s > a.s || at_end)) {
        *found = (f64::NEG_INFINITY, f64::INFINITY);
        return;
    }
    let h = b.t - a.t;
    let bend = SAFETY * (a.bend.abs().max(b.bend.abs()) + (a.bend - b.bend).abs());
    let rise = bend * h * h / 8.0;
    let inside = a.e.max(b.e) + rise <= found.1 + ACCURACY && a.e.min(b.e) - rise >= found.0 - ACCURACY;
    if depth == 0 || inside || !rise.is_finite() {
        return;
    }
    let m = station(spline, stretch, i, 0.5 * (a.t + b.t), 0.5 * (a.s + b.s));
    search(spline, stretch, i, [a, m], depth - 1, found);
    search(spline, stretch, i, [m, b], depth - 1, found);
}

/// Evenly spread stations of every knot interval, `pieces` to an interval, both ends included once.
pub(super) fn stations(
    spline: &Spline<2>,
    stretch: &Stretch<'_>,
    start: f64,
    pieces: u32,
) -> Vec<(usize, Station)> {
    let mut out: Vec<(usize, Station)> = Vec::new();
    let mut near = start;
    for i in ORDER - 1..spline.points.len() {
        let (a, b) = (spline.knots[i], spline.knots[i + 1]);
        if b <= a {
            continue;
        }
        let first = u32::from(!out.is_empty());
        for j in first..=pieces {
            let t = a + (b - a) * f64::from(j) / f64::from(pieces);
            let found = station(spline, stretch, interval(&spline.knots, t).min(i), t, near);
            near = found.s;
            out.push((i, found));
        }
    }
    out
}
