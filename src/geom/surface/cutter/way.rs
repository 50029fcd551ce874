//! How near a cutter on a straight way comes to a surface, and how far it leaves it, with proven bounds.
//!
//! The least distance is that of the swept core, which is convex: one search. For the largest, the distance is sampled:
//! from a sample on, the surface's point may slide along with the cutter, which bounds the distance from above by a
//! parabola. What it falls away by is bounded by the patch's second derivatives; where the patch ends and the point has
//! to stay behind, by that of the core's own distance.

use super::Cutter;
use crate::geom::surface::swept::{self, Extreme, Extremes, Question};
use crate::geom::surface::tree::{Foot, SurfaceTree};
use crate::geom::{Point3, Vec3};

/// Samples of one way before its bound is reported in place of values.
const BUDGET: u32 = 20_000;
/// Accuracy of sampled distances, mm.
const SAMPLED: f64 = 1e-8;

/// Extremes of the distance between a cutter's core and the surface while its reference point goes from `from` to `to`; the
/// cutter touches where the distance is its corner radius. Of the least, only what is below [`Question::enough`] is told.
#[must_use]
pub fn extremes(
    tree: &SurfaceTree,
    cutter: &Cutter,
    from: Point3,
    to: Point3,
    question: &Question,
    hint: Option<&Foot>,
) -> Extremes {
    if cutter.is_ball() {
        return swept::extremes(tree, from, to, question, hint);
    }
    let foot = tree.near(cutter, (from, to), question.enough, question.accuracy, hint);
    let distance =
        if foot.certain < foot.distance - question.accuracy { foot.certain } else { foot.distance };
    let least =
        Extreme { distance: distance.min(question.enough), at: nearest_place(cutter, from, to, &foot) };
    let enters = least.distance < question.enough - question.accuracy;
    if question.little.is_infinite() || enters && distance <= 0.0 {
        return Extremes { least, most: least, foot };
    }
    let hunt = Hunt { tree, cutter, from, to, question, exact: true };
    let (most, foot) = hunt.most(&foot);
    Extremes { least, most, foot }
}

/// Whether the distance stays in the band that a question asks about, but for its accuracy: as [`extremes`] tells it, without
/// looking for values.
#[must_use]
pub fn stays(
    tree: &SurfaceTree,
    cutter: &Cutter,
    (from, to): (Point3, Point3),
    question: &Question,
    hint: &Foot,
) -> bool {
    let Question { enough, little, accuracy } = *question;
    if cutter.is_ball() {
        let found = swept::extremes(tree, from, to, question, Some(hint));
        return found.least.distance >= enough - accuracy && found.most.distance <= little + accuracy;
    }
    let hunt = Hunt { tree, cutter, from, to, question, exact: false };
    // What leaves the surface is told the sooner.
    hunt.most(hint).0.distance <= little + accuracy
        && !tree.comes_nearer(cutter, (from, to), (enough, enough - accuracy), Some(hint))
}

/// Where on the way the core comes nearest to a point.
fn nearest_place(cutter: &Cutter, from: Point3, to: Point3, foot: &Foot) -> Point3 {
    const PLACES: u32 = 200;
    let place = |k: u32| from + (to - from) * (f64::from(k) / f64::from(PLACES));
    let apart = |p: &Point3| cutter.outside_core(foot.point - p).0;
    (0..=PLACES).map(place).min_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap_or(from)
}

struct Hunt<'a> {
    tree: &'a SurfaceTree,
    cutter: &'a Cutter,
    from: Point3,
    to: Point3,
    question: &'a Question,
    /// Whether the largest distance is wanted, where it is more than what is little: else any such distance ends the hunt.
    exact: bool,
}

#[derive(Clone, Copy)]
struct Sample {
    s: f64,
    d: f64,
    normal: Vec3,
    foot: Foot,
}

/// An upper bound from a sample on: d + slope t + curve t²/2.
struct Parabola {
    slope: f64,
    curve: f64,
}

impl Hunt<'_> {
    /// A place of the way. Any point of the surface bounds the distance from above: one near a hint will do, if it is no
    /// farther away than `enough`.
    fn look(&self, s: f64, along: Vec3, hints: &[&Foot], enough: f64) -> Sample {
        let x = self.from + along * s;
        let sample = |foot: Foot| {
            let (d, normal) = self.cutter.outside_core(foot.point - x);
            Sample { s, d, normal, foot }
        };
        let mut best: Option<Sample> = None;
        for hint in hints {
            let own = sample(self.tree.beside(self.cutter, x, hint));
            if own.d <= enough {
                return own;
            }
            best = best.filter(|b| b.d <= own.d).or(Some(own));
        }
        let hint = best.as_ref().map(|b| &b.foot);
        sample(self.tree.near(self.cutter, (x, x), f64::INFINITY, SAMPLED, hint))
    }

    /// The largest distance along the way, and the foot of its end.
    fn most(&self, hint: &Foot) -> (Extreme, Foot) {
        let way = self.to - self.from;
        let length = way.norm();
        let along = if length > 0.0 { way / length } else { Vec3::zeros() };
        let little = self.question.little;
        let first = self.look(0.0, along, &[hint], little);
        let last = self.look(length, along, &[&first.foot], little);
        let mut best = if last.d > first.d { (last.d, last.s) } else { (first.d, first.s) };
        let mut stack = vec![(first, last)];
        let mut left = BUDGET;
        while let Some((a, b)) = stack.pop() {
            if !self.exact && best.0 > little + self.question.accuracy {
                break;
            }
            let wanted = (best.0 + self.question.accuracy).max(little);
            let (high, at) = self.above(&a, &b, along);
            if high <= wanted || b.s - a.s <= 1e-9 {
                continue;
            }
            if left == 0 {
                best = (best.0.max(high), a.s);
                continue;
            }
            left -= 1;
            let h = b.s - a.s;
            let place = at.clamp(a.s + 0.1 * h, b.s - 0.1 * h);
            let middle = self.look(place, along, &[&a.foot, &b.foot], best.0.max(little));
            if middle.d > best.0 {
                best = (middle.d, middle.s);
            }
            stack.push((middle, b));
            stack.push((a, middle));
        }
        (Extreme { distance: best.0, at: self.from + along * best.1 }, last.foot)
    }

    /// Upper bound between two samples, and where to look next.
    fn above(&self, a: &Sample, b: &Sample, along: Vec3) -> (f64, f64) {
        let h = b.s - a.s;
        // The distance from one point is convex along the way.
        let stays = |near: &Sample, far: &Sample| {
            let x = self.from + along * far.s;
            near.d.max(self.cutter.outside_core(near.foot.point - x).0)
        };
        let still = stays(a, b).min(stays(b, a));
        let (p, q) = (self.parabola(a, along, h), self.parabola(b, -along, h));
        let from_a = |t: f64| a.d + p.slope * t + 0.5 * p.curve * t * t;
        let from_b = |t: f64| b.d + q.slope * (h - t) + 0.5 * q.curve * (h - t) * (h - t);
        let (high, t) = crossing(&from_a, &from_b, h);
        if still < high { (still, a.s + 0.5 * h) } else { (high, a.s + t) }
    }

    /// The surface's point slides with the cutter as far as its patch goes: with the way as the core's normal sees it, or with
    /// all of it. A sharp rim's normal is not the surface's: then the second follows better.
    fn parabola(&self, sample: &Sample, along: Vec3, h: f64) -> Parabola {
        let level = along - sample.normal * sample.normal.dot(&along);
        let [a, b] = [level, along].map(|velocity| self.sliding(sample, (along, velocity), h));
        let end = |p: &Parabola| p.slope + 0.5 * p.curve * h;
        if end(&a) <= end(&b) { a } else { b }
    }

    /// The surface's point slides with this velocity. Seen from the core it then moves by what that leaves of the way: along the
    /// normal the distance changes as the point does, and a way `w` at right angles makes a distance d no more than
    /// √(d² + w²), and no more than d + w. Past the boundary the core may be thin: there no more is known than that the point is
    /// inside. Distances from a convex core are convex along a straight line, so that their chord bounds them.
    fn sliding(&self, sample: &Sample, (along, velocity): (Vec3, Vec3), h: f64) -> Parabola {
        let n = sample.normal;
        let slide = self.tree.slide(&sample.foot, velocity, h);
        let rest = along - velocity + slide.left;
        let slope = -n.dot(&rest);
        let aside = (rest + n * slope).norm();
        let room = sample.d - h * slope.abs();
        let round = if room > 0.0 { aside * aside / room } else { f64::INFINITY };
        if round * h * 0.5 < aside {
            return Parabola { slope, curve: slide.curve + round };
        }
        Parabola { slope: slope.max(-sample.d / h) + aside, curve: slide.curve }
    }
}

/// The largest value of the lower of two parabolas over 0..=h, and where it is: at an end, or where they cross.
fn crossing(f: &dyn Fn(f64) -> f64, g: &dyn Fn(f64) -> f64, h: f64) -> (f64, f64) {
    let gap = |t: f64| f(t) - g(t);
    let (start, middle, end) = (gap(0.0), gap(0.5 * h), gap(h));
    // gap(x h) = start + p x + q x².
    let (p, q) = (4.0 * middle - 3.0 * start - end, 2.0 * (start + end) - 4.0 * middle);
    let root = (p * p - 4.0 * q * start).max(0.0).sqrt();
    let half = -0.5 * (p + root.copysign(p));
    let inside = |x: &f64| *x > 0.0 && *x < 1.0;
    let places = [half / q, start / half].into_iter().filter(inside).map(|x| x * h);
    let lower = |t: f64| f(t).min(g(t));
    let mut best = if lower(0.0) >= lower(h) { (lower(0.0), 0.0) } else { (lower(h), h) };
    for t in places {
        // Either of the two is right there, but for rounding.
        let high = f(t).max(g(t));
        if high > best.0 {
            best = (high, t);
        }
    }
    best
}
