//! An independent check of a printed chain: walks it point by point and measures everything from the numbers.

use crate::geom::curve::{Frenet, PlanarCurve};
use crate::geom::{Point2, Vec2, cross, left};
use crate::lower::fit::{Fit, Grid, Primitive};
use crate::math;

/// What was measured.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::lower::fit) struct Measured {
    /// Largest deviation to the left and to the right, mm.
    pub left: f64,
    pub right: f64,
    /// Largest tangent error at a joint that is no corner, degrees.
    pub kink: f64,
    /// Largest difference of an arc's radii, mm.
    pub mismatch: f64,
    /// Gap between the end of a closed chain and its start, steps.
    pub gap: i64,
}

/// Points along the path with tangents.
struct Walk {
    points: Vec<Point2>,
    /// Tangents at start and end of every primitive with the place.
    ends: Vec<(Point2, Vec2, Vec2)>,
    mismatch: f64,
    last: [i64; 2],
}

const POINTS: u32 = 300;

fn walk(fit: &Fit, grid: &Grid) -> Walk {
    let at = |q: [i64; 2]| Point2::new(q[0] as f64 * grid.step, q[1] as f64 * grid.step);
    let mut w = Walk { points: vec![at(fit.start)], ends: Vec::new(), mismatch: 0.0, last: fit.start };
    for primitive in &fit.primitives {
        let from = at(w.last);
        match primitive {
            Primitive::Line { to } => {
                let t = (at(*to) - from).normalize();
                for i in 1..=POINTS {
                    w.points.push(from + (at(*to) - from) * (f64::from(i) / f64::from(POINTS)));
                }
                w.ends.push((from, t, t));
                w.last = *to;
            }
            Primitive::Arc { to, centre, clockwise } => {
                let c = from + Vec2::new(centre[0] as f64, centre[1] as f64) * grid.centre_step;
                walk_arc(&mut w, from, at(*to), c, *clockwise);
                w.last = *to;
            }
            other => panic!("{other:?}"),
        }
    }
    w
}

fn walk_arc(w: &mut Walk, from: Point2, to: Point2, c: Point2, clockwise: bool) {
    let (a, b) = (from - c, to - c);
    let (r0, r1) = (a.norm(), b.norm());
    let sign = if clockwise { -1.0 } else { 1.0 };
    let (a0, a1) = (math::atan2(a.y, a.x), math::atan2(b.y, b.x));
    let mut sweep = (a1 - a0) * sign;
    while sweep <= 1e-12 {
        sweep += math::TAU;
    }
    w.mismatch = w.mismatch.max((r0 - r1).abs());
    w.ends.push((from, left(a) * (sign / r0), left(b) * (sign / r1)));
    for i in 1..=POINTS {
        let f = f64::from(i) / f64::from(POINTS);
        let (s, co) = math::sin_cos(a0 + sign * sweep * f);
        w.points.push(c + Vec2::new(co, s) * (r0 + (r1 - r0) * f));
    }
}

/// Foot of `p` near parameter `u`: signed deviation and parameter.
fn foot(curve: &dyn PlanarCurve, p: Point2, mut u: f64) -> (f64, f64) {
    let (u0, u1) = curve.domain();
    let wrap = |u: f64| {
        if curve.is_closed() {
            u0 + (u - u0) - (u1 - u0) * ((u - u0) / (u1 - u0)).floor()
        } else {
            u.clamp(u0, u1)
        }
    };
    let mut f: Frenet = curve.at(wrap(u));
    for _ in 0..30 {
        let w = p - f.p;
        let slope = f.speed * (1.0 - f.k * w.dot(&f.n())).max(0.2);
        let step = w.dot(&f.t) / slope;
        u = wrap(u + step);
        f = curve.at(u);
        if step.abs() < 1e-13 * (u1 - u0) {
            break;
        }
    }
    ((p - f.p).dot(&f.n()), u)
}

/// Nearest parameter by sampling.
fn locate(curve: &dyn PlanarCurve, p: Point2, from: f64, to: f64) -> f64 {
    let n = 4000;
    let mut best = (f64::INFINITY, from);
    for i in 0..=n {
        let u = from + (to - from) * f64::from(i) / f64::from(n);
        let d = (curve.at(u).p - p).norm();
        if d < best.0 {
            best = (d, u);
        }
    }
    best.1
}

/// Measures a chain against a curve. With corners, deviations count where the foot is inside a smooth span.
pub(in crate::lower::fit) fn measure(fit: &Fit, curve: &dyn PlanarCurve, grid: &Grid) -> Measured {
    let w = walk(fit, grid);
    let (u0, u1) = curve.domain();
    let corners: Vec<Point2> = corner_points(curve);
    let mut out = Measured { mismatch: w.mismatch, ..Measured::default() };
    let mut u = locate(curve, w.points[0], u0, u1);
    for p in &w.points {
        let near_corner = corners.iter().any(|c| (c - p).norm() < 0.05);
        if !corners.is_empty() {
            // Spans may be short: find the foot anew where the walk passes a corner.
            let ahead = locate_near(curve, *p, u);
            u = ahead;
        }
        let (e, at) = foot(curve, *p, u);
        u = at;
        if !near_corner {
            out.left = out.left.max(e);
            out.right = out.right.max(-e);
        }
    }
    let n = w.ends.len();
    for i in 0..n {
        let j = (i + 1) % n;
        if j == 0 && !curve.is_closed() {
            break;
        }
        if corners.iter().any(|c| (c - w.ends[j].0).norm() < 0.05) {
            continue;
        }
        let (a, b) = (w.ends[i].2, w.ends[j].1);
        out.kink = out.kink.max(math::atan2(cross(a, b), a.dot(&b)).abs() / math::DEG);
    }
    if curve.is_closed() {
        out.gap = (w.last[0] - fit.start[0]).abs().max((w.last[1] - fit.start[1]).abs());
    }
    out
}

fn locate_near(curve: &dyn PlanarCurve, p: Point2, u: f64) -> f64 {
    let (u0, u1) = curve.domain();
    let reach = 0.02 * (u1 - u0);
    let mut best = (f64::INFINITY, u);
    for i in -40..=40 {
        let v = u + reach * f64::from(i) / 40.0;
        let v = if curve.is_closed() { u0 + (v - u0).rem_euclid(u1 - u0) } else { v.clamp(u0, u1) };
        let d = (curve.at(v).p - p).norm();
        if d < best.0 {
            best = (d, v);
        }
    }
    best.1
}

fn corner_points(curve: &dyn PlanarCurve) -> Vec<Point2> {
    let b = curve.breaks();
    let spans = b.len() - 1;
    let mut out = Vec::new();
    for i in 0..spans {
        let j = (i + 1) % spans;
        let (x, y) = (curve.at_in(i, b[i + 1]), curve.at_in(j, b[j]));
        if (j > 0 || curve.is_closed()) && cross(x.t, y.t).abs() > 1e-3 {
            out.push(x.p);
        }
    }
    out
}
