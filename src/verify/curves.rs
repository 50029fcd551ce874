//! Splines of the CL data against the moves that stand for them.
//!
//! Where the control draws curves, Bézier segment is compared with Bézier segment: the basis functions are positive and sum to
//! one, so the curves are no further apart than their control points. Where it draws lines, the asked curve is cut into chords
//! so fine that what they leave out is a small share of the tolerance, and each line must have its stretch of them, in order
//! and within the tolerance (Alt and Godau's decision of the Fréchet distance, with every place of the chords kept that
//! the end of a line can stand for).

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
/// Share of the tolerance that the chords of a curve may leave out.
const CHORD_SHARE: f64 = 0.02;
/// Chords of one segment at most.
const MOST_CHORDS: f64 = 4096.0;

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
    let segments = cubic(&beziers(ORDER, &control, knots));
    let mut walk = Walk { segments, next: 0, chords: None, allowed };
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
        let text = text.words("a move that does not go on along the curve within ").length(allowed);
        return Some(Finding::new(&codes::NOT_FOLLOWED, line, block, text));
    }
    if !(off <= allowed) {
        let text = text.words("the path deviates ").length(off).words(" from a curve; it may by ");
        return Some(Finding::new(&codes::OUT_OF_TOLERANCE, line, block, text.length(allowed)));
    }
    walk.rest().map(|rest| {
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
    /// The segment that the next curve stands for.
    next: usize,
    /// Of lines.
    chords: Option<Chords>,
    allowed: f64,
}

impl Walk {
    /// Upper bound of the distance between a move and the part of the curve it stands for; infinite when it stands for
    /// none.
    fn along(&mut self, cut: &TraceMove) -> f64 {
        match &cut.path {
            TracePath::Line { .. } => self.line(cut.start(), cut.end(), cut.path_tolerance),
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
        let plain = usize::from(order) == ORDER && weights.iter().all(|w| *w == 1.0) && self.chords.is_none();
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

    /// 0 for a line that has its stretch of the curve, infinite for another one.
    fn line(&mut self, from: Point3, to: Point3, smoothing: f64) -> f64 {
        if self.next > 0 {
            return f64::INFINITY;
        }
        let near = self.allowed - smoothing;
        let chords = self.chords.get_or_insert_with(|| Chords::new(&self.segments, near));
        if chords.line(from, to, near) { 0.0 } else { f64::INFINITY }
    }

    /// What is left of the curve, mm, when its end is not reached.
    fn rest(&self) -> Option<f64> {
        let end = self.segments.last().map(|s| s[ORDER - 1])?;
        match &self.chords {
            Some(chords) => chords.rest(self.allowed),
            None => {
                let left = self.segments.get(self.next..).unwrap_or_default().iter().flatten();
                let most = left.map(|p| (p - end).norm()).fold(0.0, f64::max);
                (most > self.allowed).then_some(most)
            }
        }
    }
}

/// A curve as fine chords, and where on them the lines so far may have come.
struct Chords {
    points: Vec<Point3>,
    /// What the chords leave out, mm.
    slack: f64,
    /// Chords on which the last line may end, and from which share of the chord on.
    reach: Vec<(usize, f64)>,
    last: Option<Point3>,
}

impl Chords {
    fn new(segments: &[Segment], allowed: f64) -> Chords {
        let mut points: Vec<Point3> = segments.first().map(|s| s[0]).into_iter().collect();
        let mut slack = 0.0_f64;
        for segment in segments {
            let [a, b, c, d] = segment.map(|p| p.coords);
            // A cubic's second derivative is between those at its ends.
            let bend = 6.0 * (a - b * 2.0 + c).norm().max((b - c * 2.0 + d).norm());
            let count = (bend / (8.0 * CHORD_SHARE * allowed)).sqrt().ceil().clamp(1.0, MOST_CHORDS);
            slack = slack.max(bend / (8.0 * count * count));
            let mut i = 1.0;
            while i <= count {
                points.push(at(segment, i / count));
                i += 1.0;
            }
        }
        Chords { points, slack, reach: vec![(0, 0.0)], last: None }
    }

    fn chord(&self, index: usize) -> Option<(Point3, Point3)> {
        Some((*self.points.get(index)?, *self.points.get(index + 1)?))
    }

    /// The next line; whether any stretch of the chords can be its.
    fn line(&mut self, from: Point3, to: Point3, allowed: f64) -> bool {
        let near = allowed - self.slack;
        // A square hides its sign.
        if !(near > 0.0) {
            return false;
        }
        let starts = self.points.first().is_some_and(|p| self.last.is_some() || (p - from).norm() <= near);
        let mut reach = Vec::new();
        let mut entries = self.reach.iter().copied().peekable();
        let mut index = self.reach.first().map_or(0, |(index, _)| *index);
        let mut alive = false;
        while let Some((a, b)) = self.chord(index).filter(|_| starts) {
            let entry = entries.next_if(|(i, _)| *i == index).map(|(_, share)| share);
            let begin = if alive { Some(0.0) } else { entry };
            if begin.is_none() && entries.peek().is_none() {
                break;
            }
            if let Some(share) = begin.and_then(|begin| touches(a, b, begin, to, near)) {
                reach.push((index, share));
            }
            alive = begin.is_some() && distance(b, from, to) <= near;
            index += 1;
        }
        self.reach = reach;
        self.last = Some(to);
        !self.reach.is_empty()
    }

    fn rest(&self, allowed: f64) -> Option<f64> {
        let (end, last) = (self.points.last()?, self.last?);
        let there = self.reach.last().is_some_and(|(index, _)| index + 2 == self.points.len());
        let left = (end - last).norm();
        (!there || !(left <= allowed - self.slack)).then_some(left)
    }
}

/// The first share of a chord from `begin` on that is as near to a point as allowed.
fn touches(a: Point3, b: Point3, begin: f64, p: Point3, near: f64) -> Option<f64> {
    let (way, v) = (b - a, p - a);
    let length = way.norm_squared();
    if length == 0.0 {
        return (v.norm() <= near).then_some(begin);
    }
    let middle = v.dot(&way) / length;
    let half = (near * near - (v - way * middle).norm_squared()) / length;
    if !(half >= 0.0) {
        return None;
    }
    let first = (middle - half.sqrt()).max(begin);
    (first <= (middle + half.sqrt()).min(1.0)).then_some(first)
}

/// Point of a segment, by de Casteljau's scheme.
fn at(segment: &Segment, x: f64) -> Point3 {
    let mut work = *segment;
    for round in 1..ORDER {
        for j in 0..ORDER - round {
            work[j] = work[j] + (work[j + 1] - work[j]) * x;
        }
    }
    work[0]
}

/// Distance of a point from the line between two others.
fn distance(p: Point3, from: Point3, to: Point3) -> f64 {
    let (way, v) = (to - from, p - from);
    let length = way.norm_squared();
    let x = if length > 0.0 { (v.dot(&way) / length).clamp(0.0, 1.0) } else { 0.0 };
    (v - way * x).norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arch() -> Segment {
        [[0.0, 0.0, 0.0], [0.0, 10.0, 1.0], [10.0, 10.0, 2.0], [10.0, 0.0, 3.0]].map(Point3::from)
    }

    fn walk_of(segment: Segment) -> Walk {
        Walk { segments: vec![segment], next: 0, chords: None, allowed: 0.01 }
    }

    /// Follows a segment by lines that end at these parameters.
    fn follow(segment: Segment, ends: &[f64]) -> (bool, bool) {
        let mut walk = walk_of(segment);
        let mut from = segment[0];
        let mut fine = true;
        for x in ends {
            let to = at(&segment, *x);
            fine &= walk.line(from, to, 0.0).is_finite();
            from = to;
        }
        (fine, walk.rest().is_none())
    }

    fn even(n: u32) -> Vec<f64> {
        (1..=n).map(|i| f64::from(i) / f64::from(n)).collect()
    }

    #[test]
    fn fine_lines_follow_and_cut_corners_do_not() {
        assert_eq!(follow(arch(), &even(32)), (true, true));
        let mut missing = even(32);
        missing.remove(15);
        assert!(!follow(arch(), &missing).0);
        let mut short = even(32);
        short.pop();
        assert_eq!(follow(arch(), &short), (true, false));
        let mut back = even(32);
        back.swap(9, 10);
        assert!(!follow(arch(), &back).0);
        assert!(walk_of(arch()).rest().is_some());
    }

    #[test]
    fn smoothing_of_the_control_counts() {
        let mut walk = walk_of(arch());
        let to = at(&arch(), 1.0 / 32.0);
        assert!(walk.line(arch()[0], to, 0.009).is_infinite());
    }

    #[test]
    fn a_curve_that_turns_back_on_itself_is_followed_there_and_back() {
        let hook: Segment =
            [[0.0, 0.0, 0.0], [30.0, 0.0, 0.0], [-20.0, 0.001, 0.0], [10.0, 0.0, 0.0]].map(Point3::from);
        assert_eq!(follow(hook, &even(64)), (true, true));
    }

    #[test]
    fn curves_are_compared_segment_by_segment() {
        let control: Vec<[f64; 3]> = arch().iter().map(|p| [p.x, p.y, p.z]).collect();
        let knots = [0.0, 0.0, 0.0, 0.0, 7.0, 7.0, 7.0, 7.0];
        let walk = || walk_of(arch());
        assert_eq!(walk().curve((4, &[1.0; 4]), &control, &knots), 0.0);
        let mut other = control.clone();
        other[2][1] += 0.5;
        assert_eq!(walk().curve((4, &[1.0; 4]), &other, &knots), 0.5);
        assert!(walk().curve((4, &[1.0, 2.0, 1.0, 1.0]), &control, &knots).is_infinite());
        assert!(walk().curve((3, &[1.0; 4]), &control, &[0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0]).is_infinite());
        let mut half = walk();
        assert!(half.rest().is_some());
        half.curve((4, &[1.0; 4]), &control, &knots);
        assert!(half.rest().is_none());
    }
}
