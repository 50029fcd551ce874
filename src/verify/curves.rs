//! Splines of the CL data against the moves that stand for them.
//!
//! Both are taken apart into Bézier segments. Where the control draws curves, segment is compared with segment: the basis
//! functions are positive and sum to one, so the curves are no further apart than their control points. Where it draws
//! lines, each line's end is looked up on the curve, in order; the distance from a line is a convex function, so between
//! two such places the curve is no further from the line than the Bernstein mean of its control points' distances says.

use super::finding::{Finding, Text};
use super::spline::beziers;
use super::{ACCURACY, Case, Happening};
use crate::cl::{RecordKind, Spline};
use crate::diag::codes::verification as codes;
use crate::geom::Point3;
use crate::readback::{EventKind, TraceMove, TracePath};

/// Order of the curves of the CL data.
const ORDER: usize = 4;
/// Steps of the grid that a curve may always be off.
const LEAST_STEPS: f64 = 2.0;
/// Steps of the search for a line's end on a segment.
const LOOKS: u32 = 64;
/// Parts of a segment whose bounds are taken one by one: the smaller, the closer the bound.
const PARTS: u32 = 8;
/// Steps of refining it.
const REFINE: u32 = 40;

/// A place on the curve: segment, parameter, and how far the point that was looked for is.
#[derive(Debug, Clone, Copy)]
struct Place {
    segment: usize,
    x: f64,
    distance: f64,
}

/// A cubic Bézier segment.
type Segment = [Point3; ORDER];

/// Checks every spline of the CL data.
pub(super) fn all(case: &Case<'_>) -> Vec<Finding> {
    let splines = case.cl.records.iter().enumerate().filter_map(|(index, record)| match &record.kind {
        RecordKind::Spline(spline) => Some((index, spline)),
        _ => None,
    });
    splines.filter_map(|(index, spline)| one(case, spline, case.of_record(index), index)).collect()
}

fn one(case: &Case<'_>, spline: &Spline, happenings: &[Happening<'_>], record: usize) -> Option<Finding> {
    let step = case.target.capabilities.grid.linear_step();
    let allowed = spline.tolerance().max(LEAST_STEPS * step) + ACCURACY;
    let knots = spline.knots();
    let control: Vec<[f64; 3]> = spline.points().iter().map(|p| [p.x, p.y, p.z]).collect();
    let mut walk = Walk { segments: cubic(&beziers(ORDER, &control, knots)), next: 0, from: 0.0, allowed };
    let mut worst: Option<(f64, &Happening<'_>)> = None;
    for happening in happenings {
        let EventKind::Move(cut) = happening.kind else { continue };
        let off = walk.along(cut) + cut.path_tolerance;
        if worst.is_none_or(|(w, _)| !(off <= w)) {
            worst = Some((off, happening));
        }
        if !off.is_finite() {
            break;
        }
    }
    let text = Text::default();
    let at = |happening: &Happening<'_>| (happening.line, happening.block);
    let Some((off, happening)) = worst else {
        // Shorter than a step of the grid.
        let small = spline.points().iter().all(|p| (p - spline.end()).norm() <= LEAST_STEPS * step);
        let text = text.words("a curve that nothing is cut along");
        let finding = Finding::new(&codes::NOT_FOLLOWED, 0, case.block_of_record(record), text);
        return (!small).then_some(finding);
    };
    let (line, block) = at(happening);
    if !off.is_finite() {
        let text = text.words("a move that does not go on along the curve");
        return Some(Finding::new(&codes::NOT_FOLLOWED, line, block, text));
    }
    if !(off <= allowed) {
        let text = text.words("the path deviates ").length(off).words(" from a curve; it may by ");
        return Some(Finding::new(&codes::OUT_OF_TOLERANCE, line, block, text.length(allowed)));
    }
    walk.rest(step).map(|rest| {
        let (line, block) = happenings.last().map_or((line, block), at);
        let text = text.words("the path ends ").length(rest).words(" before the end of its curve");
        Finding::new(&codes::NOT_FOLLOWED, line, block, text)
    })
}

fn cubic(parts: &[Vec<[f64; 3]>]) -> Vec<Segment> {
    let whole = |p: &Vec<[f64; 3]>| Some([*p.first()?, *p.get(1)?, *p.get(2)?, *p.get(3)?].map(Point3::from));
    parts.iter().filter_map(whole).collect()
}

/// How far the moves have come on the asked curve.
struct Walk {
    segments: Vec<Segment>,
    /// The segment under way, and where on it.
    next: usize,
    from: f64,
    allowed: f64,
}

impl Walk {
    /// Upper bound of the distance between a move and the part of the curve it stands for; infinite when it stands for
    /// none.
    fn along(&mut self, cut: &TraceMove) -> f64 {
        match &cut.path {
            TracePath::Line { .. } => self.line(cut.start(), cut.end()),
            TracePath::Nurbs { order, points, weights, knots } => {
                let control: Vec<[f64; 3]> = points.iter().map(|p| [p.x, p.y, cut.z.0]).collect();
                self.curve((*order, weights), &control, knots)
            }
            TracePath::Space(curve) => {
                let control: Vec<[f64; 3]> = curve.points.iter().map(|p| [p.x, p.y, p.z]).collect();
                self.curve((curve.order, &curve.weights), &control, &curve.knots)
            }
            TracePath::Arc { .. } | TracePath::Tilted(_) | TracePath::Spiral { .. } => f64::INFINITY,
        }
    }

    /// A curve without weights against as many segments as it has.
    #[allow(clippy::float_cmp)]
    fn curve(&mut self, (order, weights): (u8, &[f64]), control: &[[f64; 3]], knots: &[f64]) -> f64 {
        let drawn = cubic(&beziers(usize::from(order), control, knots));
        let plain = usize::from(order) == ORDER && weights.iter().all(|w| *w == 1.0) && self.from == 0.0;
        let (true, Some(start)) = (plain, drawn.first().map(|s| s[0])) else { return f64::INFINITY };
        loop {
            let Some(asked) = self.segments.get(self.next..self.next + drawn.len()) else {
                return f64::INFINITY;
            };
            let pairs = asked.iter().flatten().zip(drawn.iter().flatten());
            let off = pairs.map(|(p, q)| (p - q).norm()).fold(0.0, f64::max);
            // A segment that came to less than a step of the grid is not drawn.
            let tiny = asked[0].iter().all(|p| (p - start).norm() <= self.allowed);
            if off <= self.allowed || !tiny {
                self.next += drawn.len();
                return off;
            }
            self.next += 1;
        }
    }

    /// A line against the curve up to the place that its end stands for.
    fn line(&mut self, from: Point3, to: Point3) -> f64 {
        // Where the curve comes by more than once, the place nearest to the end that leaves the line in tolerance.
        let mut best: Option<(Place, f64)> = None;
        for place in self.places(to) {
            let off = self.off(&place, from, to);
            let good = |off: f64| off <= self.allowed;
            let better = best.as_ref().is_none_or(|(b, least)| match (good(off), good(*least)) {
                (true, true) => place.distance < b.distance,
                (a, b) if a == b => off < *least,
                (a, _) => a,
            });
            if better {
                best = Some((place, off));
            }
        }
        let Some((place, off)) = best else { return f64::INFINITY };
        (self.next, self.from) =
            if place.x >= 1.0 { (place.segment + 1, 0.0) } else { (place.segment, place.x) };
        off
    }

    /// Upper bound of the distance between a line and the curve up to a place.
    fn off(&self, place: &Place, from: Point3, to: Point3) -> f64 {
        let mut off = place.distance;
        for index in self.next..=place.segment {
            let Some(segment) = self.segments.get(index) else { return f64::INFINITY };
            let a = if index == self.next { self.from } else { 0.0 };
            let b = if index == place.segment { place.x } else { 1.0 };
            for i in 0..PARTS {
                let at = |i: u32| a + (b - a) * f64::from(i) / f64::from(PARTS);
                off = off.max(bulge(&part(segment, at(i), at(i + 1)), from, to));
            }
        }
        off
    }

    /// Where the rest of the curve comes as near to a point as allowed, on the first segment that does and the next.
    fn places(&self, p: Point3) -> Vec<Place> {
        let mut places = Vec::new();
        let mut first = None;
        for (index, segment) in self.segments.iter().enumerate().skip(self.next) {
            if first.is_some_and(|first| index > first + 1) {
                break;
            }
            let from = if index == self.next { self.from } else { 0.0 };
            let near =
                nearest(segment, from, p).into_iter().filter(|(_, distance)| *distance <= self.allowed);
            places.extend(near.map(|(x, distance)| Place { segment: index, x, distance }));
            if first.is_none() && !places.is_empty() {
                first = Some(index);
            }
        }
        places
    }

    /// What is left of the curve, mm, when that is more than a step of the grid.
    fn rest(&self, step: f64) -> Option<f64> {
        let end = self.segments.last().map(|s| s[ORDER - 1])?;
        let left = self.segments.get(self.next..).unwrap_or_default().iter().enumerate();
        let points = left.flat_map(|(i, s)| part(s, if i == 0 { self.from } else { 0.0 }, 1.0));
        let most = points.map(|p| (p - end).norm()).fold(0.0, f64::max);
        (most > LEAST_STEPS * step).then_some(most)
    }
}

/// Point of a segment.
fn at(segment: &Segment, x: f64) -> Point3 {
    polar(segment, [x; 3])
}

/// The polar form of a segment.
fn polar(segment: &Segment, arguments: [f64; 3]) -> Point3 {
    let mut work = *segment;
    for (round, x) in (1..ORDER).zip(arguments) {
        for j in 0..ORDER - round {
            work[j] = work[j] + (work[j + 1] - work[j]) * x;
        }
    }
    work[0]
}

/// Control points of the part of a segment from `a` to `b`, by its polar form.
fn part(segment: &Segment, a: f64, b: f64) -> Segment {
    [[a, a, a], [a, a, b], [a, b, b], [b, b, b]].map(|arguments| polar(segment, arguments))
}

/// The places from `from` on a segment that are nearer to a point than those beside them, as far as [`LOOKS`] looks
/// tell; and how far they are.
fn nearest(segment: &Segment, from: f64, p: Point3) -> Vec<(f64, f64)> {
    let step = (1.0 - from) / f64::from(LOOKS);
    let distance = |x: f64| (at(segment, x) - p).norm();
    let look = |i: u32| if i == LOOKS { 1.0 } else { from + step * f64::from(i) };
    let mut found = Vec::new();
    let (mut before, mut here) = (f64::INFINITY, distance(from));
    for i in 0..=LOOKS {
        let after = if i < LOOKS { distance(look(i + 1)) } else { f64::INFINITY };
        if here <= before && here <= after {
            found.push(refine(&distance, look(i.saturating_sub(1)), look((i + 1).min(LOOKS))));
        }
        (before, here) = (here, after);
    }
    found
}

/// The least value between two places, by sections; an end of the segment where that is no worse in printed numbers.
fn refine(distance: &impl Fn(f64) -> f64, low: f64, high: f64) -> (f64, f64) {
    let (mut a, mut b) = (low, high);
    for _ in 0..REFINE {
        let (left, right) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
        if distance(left) <= distance(right) { b = right } else { a = left }
    }
    let x = 0.5 * (a + b);
    [x, low, high]
        .into_iter()
        .map(|x| (x, distance(x)))
        .fold((x, f64::INFINITY), |best, next| if next.1 <= best.1 + ACCURACY { next } else { best })
}

/// Upper bound of the distance of a Bézier part from the line between two points.
fn bulge(part: &Segment, from: Point3, to: Point3) -> f64 {
    let way = to - from;
    let length = way.norm_squared();
    let distance = |p: &Point3| {
        let v = p - from;
        let x = if length > 0.0 { (v.dot(&way) / length).clamp(0.0, 1.0) } else { 0.0 };
        (v - way * x).norm()
    };
    let [a, b, c, d] = part.each_ref().map(distance);
    let (ends, inner) = (a.max(d), b.max(c));
    ends.max(0.25 * ends + 0.75 * inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arch() -> Segment {
        [[0.0, 0.0, 0.0], [0.0, 10.0, 1.0], [10.0, 10.0, 2.0], [10.0, 0.0, 3.0]].map(Point3::from)
    }

    #[test]
    fn a_part_is_the_curve_between_its_ends() {
        let whole = arch();
        let half = part(&whole, 0.25, 0.75);
        for i in 0..=8 {
            let x = f64::from(i) / 8.0;
            assert!((at(&half, x) - at(&whole, 0.25 + 0.5 * x)).norm() < 1e-12);
        }
    }

    #[test]
    fn the_bulge_is_no_less_than_any_point_is_off() {
        let whole = arch();
        for (a, b) in [(0.0, 1.0), (0.1, 0.3), (0.5, 0.6)] {
            let piece = part(&whole, a, b);
            let (from, to) = (piece[0], piece[3]);
            let way = to - from;
            let bound = bulge(&piece, from, to);
            let off = (0..=100).map(|i| {
                let v = at(&piece, f64::from(i) / 100.0) - from;
                (v - way * (v.dot(&way) / way.norm_squared()).clamp(0.0, 1.0)).norm()
            });
            let worst = off.fold(0.0, f64::max);
            assert!(worst <= bound + 1e-12 && bound <= 1.4 * worst, "{worst} {bound}");
        }
    }

    fn walk() -> Walk {
        Walk { segments: vec![arch()], next: 0, from: 0.0, allowed: 0.01 }
    }

    #[test]
    fn fine_chords_follow_and_cut_corners_do_not() {
        let chords = |n: u32, skip: u32| {
            let mut walk = walk();
            let mut from = at(&arch(), 0.0);
            let mut worst = 0.0_f64;
            for i in (1..=n).filter(|i| *i != skip) {
                let to = at(&arch(), f64::from(i) / f64::from(n));
                worst = worst.max(walk.line(from, to));
                from = to;
            }
            (worst, walk.rest(0.001))
        };
        let (worst, rest) = chords(32, 0);
        assert!(worst < 0.01 && rest.is_none(), "{worst} {rest:?}");
        assert!(chords(32, 16).0 > 0.01);
        assert!(chords(32, 32).1.is_some());
    }

    #[test]
    fn a_line_that_goes_back_stands_for_nothing() {
        let mut walk = walk();
        let (a, b) = (at(&arch(), 0.25), at(&arch(), 0.5));
        walk.allowed = 100.0;
        assert!(walk.line(at(&arch(), 0.0), b).is_finite());
        walk.allowed = 0.01;
        assert!(walk.line(b, a).is_infinite());
    }

    #[test]
    fn curves_are_compared_segment_by_segment() {
        let control: Vec<[f64; 3]> = arch().iter().map(|p| [p.x, p.y, p.z]).collect();
        let knots = [0.0, 0.0, 0.0, 0.0, 7.0, 7.0, 7.0, 7.0];
        assert_eq!(walk().curve((4, &[1.0; 4]), &control, &knots), 0.0);
        let mut other = control.clone();
        other[2][1] += 0.5;
        assert_eq!(walk().curve((4, &[1.0; 4]), &other, &knots), 0.5);
        assert!(walk().curve((4, &[1.0, 2.0, 1.0, 1.0]), &control, &knots).is_infinite());
        assert!(walk().curve((3, &[1.0; 4]), &control, &[0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0]).is_infinite());
    }
}
