//! Signed deviation of a path from the exact curve, bounded and refined.
//!
//! With x along the primitive P, the foot c(u(x)) and d(x) = (P - c)·n, left positive:
//!
//! d' = P'·n, d'' = P''·n - k (P'·t)² / (1 - k d)
//!
//! (t, n, k: the curve's tangent, left normal, curvature at the foot). Over an interval d'' is enclosed from bounds
//! on the primitive's derivatives and the range of the curve's curvature between the two feet; d lies below the
//! parabolas that the enclosure allows. An interval is refined until it can't raise what was found by more than
//! [`ACCURACY`]. Where the enclosure does not hold (a corner of the curve, or a point nearly as far away as the curve's
//! radius) |d'| <= |P'| is used instead.

use super::path::{Jet, Primitive};
use super::rail::{Foot, FootKind, Rail};
use crate::geom::left;

/// Largest amount by which a reported extreme may fall short of the true one, mm.
pub(super) const ACCURACY: f64 = 2e-7;
/// Share of the radius of curvature up to which the second-order bound is used.
const MOST_BEND: f64 = 0.5;
/// Evaluations spent on one primitive before its bound is reported in place of its value.
const BUDGET: u32 = 20_000;

/// Extremes of the signed deviation and where they are.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extremes {
    /// Largest to the left: value, x.
    pub left: (f64, f64),
    /// Largest to the right, negative when it is to the right: value, x.
    pub right: (f64, f64),
}

impl Extremes {
    pub(super) const NONE: Extremes =
        Extremes { left: (f64::NEG_INFINITY, 0.0), right: (f64::INFINITY, 0.0) };

    fn take(&mut self, d: f64, x: f64) {
        if d > self.left.0 {
            self.left = (d, x);
        }
        if d < self.right.0 {
            self.right = (d, x);
        }
    }
}

/// A place on the primitive and how it sees the curve.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sight {
    pub x: f64,
    pub jet: Jet,
    pub foot: Foot,
}

impl Sight {
    /// d'.
    fn slope(&self) -> f64 {
        self.jet.v.dot(&left(self.foot.t))
    }
}

/// One primitive against one curve.
#[derive(Debug)]
pub(super) struct Measure<'a, 'b> {
    pub rail: &'a Rail<'b>,
    pub primitive: &'a Primitive,
    bounds: [f64; 3],
    left: u32,
    /// Values beyond these are gross: found, not refined.
    pub gross: f64,
}

impl<'a, 'b> Measure<'a, 'b> {
    pub(super) fn new(rail: &'a Rail<'b>, primitive: &'a Primitive, gross: f64) -> Self {
        Measure { rail, primitive, bounds: primitive.bounds(), left: BUDGET, gross }
    }

    /// Looks from x, walking along the curve from the foot of `near`.
    pub(super) fn look(&self, x: f64, near: &Foot) -> Sight {
        let jet = self.primitive.at(x);
        Sight { x, jet, foot: self.rail.foot(jet.p, near.cell, near.turn) }
    }

    /// Extremes between two sights; `best` comes in with what is known.
    pub(super) fn extremes(&mut self, a: &Sight, b: &Sight, best: &mut Extremes) {
        best.take(a.foot.d, a.x);
        best.take(b.foot.d, b.x);
        let mut stack = vec![(*a, *b)];
        while let Some((a, b)) = stack.pop() {
            let (above, below) = self.bound(&a, &b);
            if above <= best.left.0 + ACCURACY && below >= best.right.0 - ACCURACY {
                continue;
            }
            let gross = a.foot.d.abs().max(b.foot.d.abs()) > self.gross;
            if self.left == 0 || gross && best.left.0.max(-best.right.0) > self.gross {
                if !gross {
                    best.take(above, a.x);
                    best.take(below, a.x);
                }
                continue;
            }
            self.left -= 1;
            let middle = self.look(split(&a, &b), &a.foot);
            best.take(middle.foot.d, middle.x);
            stack.push((middle, b));
            stack.push((a, middle));
        }
    }

    /// How far the primitive runs back along the curve between two sights, mm; runs shorter than `slack` may stay unseen.
    pub(super) fn retreat(&mut self, a: &Sight, b: &Sight, slack: f64) -> f64 {
        let mut seen = vec![(a.x, a.foot.sigma), (b.x, b.foot.sigma)];
        let mut stack = vec![(*a, *b)];
        while let Some((a, b)) = stack.pop() {
            let short = self.bounds[0] * (b.x - a.x) <= 0.5 * slack;
            if short || self.left == 0 || self.forward(&a, &b) {
                continue;
            }
            self.left -= 1;
            let middle = self.look(0.5 * (a.x + b.x), &a.foot);
            seen.push((middle.x, middle.foot.sigma));
            stack.push((middle, b));
            stack.push((a, middle));
        }
        seen.sort_by(|p, q| p.0.total_cmp(&q.0));
        let (mut furthest, mut back) = (f64::NEG_INFINITY, 0.0f64);
        for (_, sigma) in seen {
            furthest = furthest.max(sigma);
            back = back.max(furthest - sigma);
        }
        back
    }

    /// Whether the primitive certainly advances along the curve between two sights: P'·t > 0.
    fn forward(&self, a: &Sight, b: &Sight) -> bool {
        let ((k_lo, k_hi), corner) = self.rail.curvature(&a.foot, &b.foot);
        let h = b.x - a.x;
        let [v, acceleration, _] = self.bounds;
        let k = k_lo.abs().max(k_hi.abs());
        let bend = k * (a.foot.d.abs().max(b.foot.d.abs()) + 0.5 * v * h);
        let slack = 0.5 * h * (acceleration + v * k * v / (1.0 - bend.min(MOST_BEND)));
        let along = |s: &Sight| s.jet.v.dot(&s.foot.t);
        !corner && bend <= MOST_BEND && along(a).min(along(b)) - slack >= 0.0
    }

    /// Largest speed of the primitive, mm per unit of x.
    pub(super) fn speed(&self) -> f64 {
        self.bounds[0]
    }

    /// Bounds of d between two sights: above, below.
    pub(super) fn bound(&self, a: &Sight, b: &Sight) -> (f64, f64) {
        let h = b.x - a.x;
        let [v, ..] = self.bounds;
        let (da, db) = (a.foot.d, b.foot.d);
        let plain = (0.5 * (da + db + v * h), 0.5 * (da + db - v * h));
        let Some((lo, hi)) = self.second(a, b) else { return plain };
        let above = above(da, a.slope(), db, b.slope(), h, lo, hi).min(plain.0);
        let below = -above_of_negative(da, a.slope(), db, b.slope(), h, lo, hi);
        (above, below.max(plain.1))
    }

    /// Range of d'' between two sights, where it can be enclosed.
    fn second(&self, a: &Sight, b: &Sight) -> Option<(f64, f64)> {
        let ((mut k_lo, mut k_hi), corner) = self.rail.curvature(&a.foot, &b.foot);
        if beyond(&a.foot) || beyond(&b.foot) {
            (k_lo, k_hi) = (k_lo.min(0.0), k_hi.max(0.0));
        }
        let h = b.x - a.x;
        let [v, acceleration, jerk] = self.bounds;
        let k = k_lo.abs().max(k_hi.abs());
        let bend = k * (a.foot.d.abs().max(b.foot.d.abs()) + 0.5 * v * h);
        if corner || bend > MOST_BEND {
            return None;
        }
        let turning = k * v / (1.0 - bend);
        let along = |s: &Sight| s.jet.v.dot(&s.foot.t);
        let slack = 0.5 * h * (acceleration + v * turning);
        let q = square(along(a).min(along(b)) - slack, along(a).max(along(b)) + slack, v);
        let q = (q.0 / (1.0 + bend), q.1 / (1.0 - bend));
        let across = |s: &Sight| s.jet.a.dot(&left(s.foot.t));
        let slack = 0.5 * h * (jerk + acceleration * turning);
        let g = (across(a).min(across(b)) - slack, across(a).max(across(b)) + slack);
        let products = [k_lo * q.0, k_lo * q.1, k_hi * q.0, k_hi * q.1];
        let most = products.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let least = products.into_iter().fold(f64::INFINITY, f64::min);
        Some((g.0 - most, g.1 - least))
    }
}

/// Beyond an end the curve goes on as its tangent.
fn beyond(foot: &Foot) -> bool {
    matches!(foot.kind, FootKind::Beyond(_))
}

/// Range of the square of a number in lo..hi whose magnitude is at most `most`.
fn square(lo: f64, hi: f64, most: f64) -> (f64, f64) {
    let least = if lo > 0.0 { lo } else { (-hi).max(0.0) };
    let largest = lo.abs().max(hi.abs()).min(most);
    (least * least, largest * largest)
}

/// Upper bound of a function with these values and slopes at the ends of an interval of length h, and a second
/// derivative in lo..hi.
fn above(da: f64, sa: f64, db: f64, sb: f64, h: f64, lo: f64, hi: f64) -> f64 {
    let chord = da.max(db) + (-lo).max(0.0) * h * h / 8.0;
    chord.min(parabola(da, sa, h, hi)).min(parabola(db, -sb, h, hi))
}

fn above_of_negative(da: f64, sa: f64, db: f64, sb: f64, h: f64, lo: f64, hi: f64) -> f64 {
    above(-da, -sa, -db, -sb, h, -hi, -lo)
}

/// Largest value on 0..h of d + s x + c x²/2.
fn parabola(d: f64, s: f64, h: f64, c: f64) -> f64 {
    let end = d + s * h + 0.5 * c * h * h;
    let top = -s / c;
    let inner = if c < 0.0 && top > 0.0 && top < h { d - 0.5 * s * s / c } else { d };
    d.max(end).max(inner)
}

/// Where to look next between two sights: at the extreme that their slopes promise, else in the middle.
fn split(a: &Sight, b: &Sight) -> f64 {
    let (sa, sb) = (a.slope(), b.slope());
    let middle = 0.5 * (a.x + b.x);
    if sa * sb >= 0.0 {
        return middle;
    }
    let share = (sa / (sa - sb)).clamp(0.05, 0.95);
    let x = a.x + (b.x - a.x) * share;
    if x > a.x && x < b.x { x } else { middle }
}
