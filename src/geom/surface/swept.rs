//! How near a ball on a straight way comes to a surface, and how far it leaves it, with proven bounds.
//!
//! d, the distance of the centre from the surface, is the smallest of the distances |x - q| from its points q; each of
//! these has a second derivative along a unit direction of at most 1/|x - q|. So d'' <= K = 1/min d in the sense of
//! semiconcave functions: between two samples d lies above chord - K/2 (s - a)(b - s), and below the parabolas of
//! second derivative K that touch it at the samples. Both bounds need nothing but samples of d and its gradient. Where the
//! surface is mild K is far less ([`super::tree::glide`]), and a few samples do.

use super::tree::glide::Glide;
use super::tree::{Foot, SurfaceTree};
use crate::geom::{Point3, Vec3};

/// An extreme of the distance along a way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extreme {
    /// The distance, mm.
    pub distance: f64,
    /// Where the centre is, mm.
    pub at: Point3,
}

/// The least and the largest distance along a way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extremes {
    /// Smallest; the true one is no smaller than this less the accuracy.
    pub least: Extreme,
    /// Largest; the true one is no larger than this plus the accuracy.
    pub most: Extreme,
    /// Foot of the way's end.
    pub foot: Foot,
}

impl Extremes {
    /// Those of a way that goes on by another one.
    #[must_use]
    pub fn with(self, next: &Extremes) -> Extremes {
        Extremes {
            least: if next.least.distance < self.least.distance { next.least } else { self.least },
            most: if next.most.distance > self.most.distance { next.most } else { self.most },
            foot: next.foot,
        }
    }
}

/// What is asked about a way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Question {
    /// Distances of at least this are as good as any other: the least is not looked for above it.
    pub enough: f64,
    /// Distances of at most this are as good as any other: the most is not looked for below it. Infinite when the
    /// largest distance is of no interest.
    pub little: f64,
    /// Accuracy of both, mm.
    pub accuracy: f64,
}

/// Distances above what is enough are told up to so much more, mm.
const CLEAR: f64 = 2.0;
/// Evaluations for one way before its bounds are reported in place of values.
const BUDGET: u32 = 20_000;
/// After so many of these more is asked about parts of the way …
const LOOKS: u32 = 12;
/// … that are so much shorter than what is known.
const CLOSER: f64 = 8.0;

#[derive(Debug, Clone, Copy)]
struct Sample {
    s: f64,
    /// No point of the surface is nearer.
    d: f64,
    /// The foot's own distance, and how it grows along the way.
    above: f64,
    slope: f64,
    foot: Foot,
}

/// Extremes of the distance from `from` to `to`.
#[must_use]
pub fn extremes(
    tree: &SurfaceTree,
    from: Point3,
    to: Point3,
    question: &Question,
    hint: Option<&Foot>,
) -> Extremes {
    let way = to - from;
    let length = way.norm();
    let along = if length > 0.0 { way / length } else { Vec3::zeros() };
    let within = if question.little.is_finite() { f64::INFINITY } else { question.enough + CLEAR };
    let look = |s: f64, hint: Option<&Foot>| {
        let x = from + along * s;
        let foot = tree.nearest_within(x, hint, within);
        let d = foot.certain.min(foot.distance);
        // Any point of the surface bounds the distance from above, the foot best.
        let slope = (x - foot.point).dot(&along) / foot.distance.max(1e-12);
        Sample { s, d, above: foot.distance, slope, foot }
    };
    let first = look(0.0, hint);
    let last = look(length, Some(&first.foot));
    let farthest = 0.5 * (first.above + last.above + length);
    let glide = tree.glide(from + way * 0.5, (along, length), farthest);
    let part = Part { from: 0.0, to: length, glide };
    let mut hunt = Hunt {
        tree,
        from,
        along,
        question,
        whole: part,
        parts: Vec::new(),
        least: first,
        most: first,
        left: BUDGET,
    };
    hunt.take(&last);
    let mut stack = vec![(first, last)];
    while let Some((a, b)) = stack.pop() {
        let Some(s) = hunt.next(&a, &b) else { continue };
        let middle = look(s, Some(&a.foot));
        hunt.take(&middle);
        stack.push((middle, b));
        stack.push((a, middle));
    }
    let at = |distance: f64, sample: &Sample| Extreme { distance, at: from + along * sample.s };
    let (least, most) = (at(hunt.least.d, &hunt.least), at(hunt.most.above, &hunt.most));
    Extremes { least, most, foot: last.foot }
}

/// What is known of a part of the way.
struct Part {
    from: f64,
    to: f64,
    glide: Option<Glide>,
}

struct Hunt<'a> {
    tree: &'a SurfaceTree,
    from: Point3,
    along: Vec3,
    question: &'a Question,
    whole: Part,
    /// Parts within one another: what is near the whole way need not be near all of it.
    parts: Vec<Part>,
    least: Sample,
    most: Sample,
    left: u32,
}

impl Hunt<'_> {
    fn take(&mut self, sample: &Sample) {
        if sample.d < self.least.d {
            self.least = *sample;
        }
        if sample.above > self.most.above {
            self.most = *sample;
        }
    }

    /// Where to look next between two samples; `None` when nothing of interest can be there.
    fn next(&mut self, a: &Sample, b: &Sample) -> Option<f64> {
        let h = b.s - a.s;
        let nearest = a.d.min(b.d) - 0.5 * h;
        if h <= 1e-9 || nearest >= self.question.enough && self.question.little.is_infinite() {
            return None;
        }
        if nearest <= 0.0 {
            return Some(0.5 * (a.s + b.s));
        }
        let farthest = 0.5 * (a.above + b.above + h);
        let mild = self.mild(a, b, (nearest, farthest));
        let k = mild.map_or(1.0 / nearest, |k| k.min(1.0 / nearest));
        let (low, low_at) = below(a, b, k);
        let (high, high_at) = above(a, b, k);
        let deeper = low < (self.least.d - self.question.accuracy).min(self.question.enough);
        let farther = high > (self.most.above + self.question.accuracy).max(self.question.little);
        if !deeper && !farther {
            return None;
        }
        if self.left == 0 {
            self.bound(a, (low, deeper), (high, farther));
            return None;
        }
        self.left -= 1;
        let wanted = if deeper { low_at } else { high_at };
        Some(wanted.clamp(a.s + 0.1 * h, b.s - 0.1 * h))
    }

    /// Bound of the second derivative between two samples, where the surface is mild.
    ///
    /// Where that is not known of all of the way, it may be of a part of it.
    fn mild(&mut self, a: &Sample, b: &Sample, range: (f64, f64)) -> Option<f64> {
        let h = b.s - a.s;
        while self.parts.last().is_some_and(|p| a.s < p.from || b.s > p.to) {
            self.parts.pop();
        }
        let bound =
            |known: &Part| known.glide.and_then(|g| g.bound((a.s - known.from, b.s - known.from), range));
        let known = self.parts.last().unwrap_or(&self.whole);
        let found = bound(known);
        if found.is_some() || self.left + LOOKS > BUDGET || h * CLOSER > known.to - known.from {
            return found;
        }
        let middle = self.from + self.along * (0.5 * (a.s + b.s));
        let glide = self.tree.glide(middle, (self.along, h), range.1);
        let part = Part { from: a.s, to: b.s, glide };
        let found = bound(&part);
        self.parts.push(part);
        found
    }

    /// The bounds stand in for values.
    fn bound(&mut self, a: &Sample, low: (f64, bool), high: (f64, bool)) {
        if low.1 {
            self.least = Sample { d: low.0, ..*a };
        }
        if high.1 {
            self.most = Sample { above: high.0, ..*a };
        }
        debug_assert!(self.from.x.is_finite() && self.along.x.is_finite());
    }
}

/// Lower bound between two samples, and where it is.
fn below(a: &Sample, b: &Sample, k: f64) -> (f64, f64) {
    let h = b.s - a.s;
    let s = 0.5 * h - (b.d - a.d) / (h * k);
    if s <= 0.0 || s >= h {
        return if a.d <= b.d { (a.d, a.s) } else { (b.d, b.s) };
    }
    (a.d + (b.d - a.d) * s / h - 0.5 * k * s * (h - s), a.s + s)
}

/// Upper bound between two samples, and where it is.
fn above(a: &Sample, b: &Sample, k: f64) -> (f64, f64) {
    let h = b.s - a.s;
    let from_a = |s: f64| a.above + a.slope * s + 0.5 * k * s * s;
    let from_b = |s: f64| b.above - b.slope * (h - s) + 0.5 * k * (h - s) * (h - s);
    let lower = |s: f64| from_a(s).min(from_b(s));
    let mut best = if lower(0.0) >= lower(h) { (lower(0.0), a.s) } else { (lower(h), b.s) };
    let (gap, rate) = (from_b(0.0) - a.above, a.slope - b.slope + k * h);
    let meet = gap / rate;
    if rate.abs() > 0.0 && meet > 0.0 && meet < h && lower(meet) > best.0 {
        best = (lower(meet), a.s + meet);
    }
    best
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::geom::surface::Net;

    pub(in crate::geom::surface) fn bowl() -> SurfaceTree {
        let z = [[0.0, 4.0, 4.0, 0.0], [4.0, 16.0, 16.0, 4.0], [4.0, 16.0, 16.0, 4.0], [0.0, 4.0, 4.0, 0.0]];
        let poles: Vec<Point3> = (0..16u32)
            .map(|k| {
                Point3::new(
                    f64::from(k / 4) * 20.0,
                    f64::from(k % 4) * 20.0,
                    z[k as usize / 4][k as usize % 4],
                )
            })
            .collect();
        SurfaceTree::new(Net::new(4, 4, &poles, None).expect("a net"), 5.0)
    }

    #[test]
    fn extremes_are_those_of_dense_samples() {
        let tree = bowl();
        let (from, to) = (Point3::new(12.0, 20.0, 12.2), Point3::new(30.0, 24.0, 14.9));
        let question = Question { enough: f64::INFINITY, little: 0.0, accuracy: 1e-9 };
        let found = extremes(&tree, from, to, &question, None);
        let samples: Vec<f64> = (0..=2000u32)
            .map(|k| tree.nearest(from + (to - from) * (f64::from(k) / 2000.0), None).distance)
            .collect();
        let least = samples.iter().copied().fold(f64::INFINITY, f64::min);
        let most = samples.iter().copied().fold(0.0, f64::max);
        assert!(
            found.least.distance <= least + 1e-9 && found.least.distance > least - 1e-5,
            "{found:?} {least}"
        );
        assert!(found.most.distance >= most - 1e-7 && found.most.distance < most + 1e-5, "{found:?} {most}");
    }
}
