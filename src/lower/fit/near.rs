//! Certified deviation of a link that passes corners, measured from the link.
//!
//! Beside a corner the normals of the curve run into one another, and only the nearest point of the curve counts. From a
//! point of the link that point is looked for among the stations about it (what is left out can only make the
//! deviation larger). While it stays on one span the deviation is that of the span; where it changes from one to another
//! the deviation changes no faster than the link runs, and the stretch is halved until it cannot exceed what is known.

use super::Tube;
use super::certify::ACCURACY;
use super::measure::{Path, Range, foot, on_span};
use super::tube::{Station, Stations};
use crate::geom::curve::Shape;
use crate::geom::{Point2, Vec2};

/// Halvings of a link.
const DEEPEST: u32 = 60;
/// Stations ahead and behind that are looked at beyond those about a point.
const AROUND: usize = 64;

/// What a point of the link is nearest to.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Feature {
    /// The inside of a span.
    Span(usize),
    /// A corner, by its number.
    Corner(usize),
    /// A smooth joint of spans, or an end of an open curve, measured along its normal.
    Joint(usize),
}

/// A point of the link and what it sees.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sight {
    /// Share of the link.
    share: f64,
    /// Station before the nearest point, whole laps included.
    station: usize,
    feature: Feature,
    /// Parameter of the nearest point.
    u: f64,
    /// Signed distance, mm.
    d: f64,
}

/// Measures links of one chain.
#[derive(Debug, Clone, Copy)]
pub(super) struct Near<'a> {
    /// Curve and band.
    pub tube: &'a Tube<'a>,
    /// The curve's stations.
    pub stations: &'a Stations,
}

impl Near<'_> {
    /// Whether a corner is so near that a link whose ends lie at these stations may see it.
    pub fn corners(&self, first: usize, last: usize) -> bool {
        let n = self.stations.stations.len();
        let reach = 4.0 * self.tube.left.max(self.tube.right);
        let (low, high) = (self.back(first, reach), self.ahead(last, reach));
        let within = |low: usize, high: usize| {
            let from = self.stations.corners.partition_point(|c| c.last < low);
            self.stations.corners.get(from).is_some_and(|c| c.first <= high)
        };
        let lap = low / n * n;
        let mut shift = lap.saturating_sub(n);
        while shift <= high {
            if within(low.saturating_sub(shift), high - shift) {
                return true;
            }
            shift += n;
        }
        false
    }

    /// The nearest point of the curve to an end of a link, among the stations about `near`.
    pub fn vertex(&self, q: Point2, near: usize) -> Sight {
        let n = self.stations.stations.len();
        let near = if self.stations.closed { near + n } else { near };
        let from = self.stations.stations[near % n].frenet.p;
        let reach = (q - from).norm() + 4.0 * self.tube.left.max(self.tube.right);
        let mut sight = self.look(q, 0.0, self.back(near, reach), self.ahead(near, reach));
        if self.stations.closed {
            sight.station -= n.min(sight.station);
        }
        sight
    }

    /// Adds the deviation of a link between its ends' sights.
    pub fn link(&self, path: &Path, [from, to]: [Sight; 2], range: &mut Range) {
        let length = path.length();
        range.add(from.d);
        range.add(to.d);
        let (from, to) = (Sight { share: 0.0, ..from }, Sight { share: 1.0, ..to });
        let mut stack = vec![(from, to, 0)];
        while let Some((a, b, depth)) = stack.pop() {
            let run = length * (b.share - a.share);
            if depth >= DEEPEST || self.settled(path, run, (&a, &b), range) {
                continue;
            }
            let share = f64::midpoint(a.share, b.share);
            let q = path.at(share);
            let reach = 2.0 * a.d.abs().max(b.d.abs()) + run;
            let (low, high) = (a.station.min(b.station), a.station.max(b.station));
            let middle = self.look(q, share, self.back(low, reach), self.ahead(high, reach));
            range.add(middle.d);
            stack.push((middle, b, depth + 1));
            stack.push((a, middle, depth + 1));
        }
    }

    /// Whether nothing between two points of the link can widen the range; what can be measured is added to it.
    fn settled(&self, path: &Path, run: f64, (a, b): (&Sight, &Sight), range: &mut Range) -> bool {
        // the signed distance changes no faster than the link runs
        let (sum, slack) = (a.d + b.d, 2.0 * ACCURACY);
        let within = sum + run <= 2.0 * range.high + slack && sum - run >= 2.0 * range.low - slack;
        if within || run <= slack {
            return true;
        }
        if a.feature != b.feature {
            return false;
        }
        let straight = matches!(path, Path::Line { .. });
        match a.feature {
            Feature::Span(span) => {
                if straight && matches!(self.tube.curve.shape(span), Shape::Line) {
                    return true;
                }
                let u = (a.u.min(b.u), a.u.max(b.u));
                on_span(self.tube.curve, span, path, u, ACCURACY, range).is_some()
            }
            // the distance from a point is convex along a line
            Feature::Corner(_) | Feature::Joint(_) => straight,
        }
    }

    /// First station no farther behind than `reach`, mm.
    fn back(&self, from: usize, reach: f64) -> usize {
        let n = self.stations.stations.len();
        let p = self.stations.stations[from % n].frenet.p;
        let mut i = from;
        while i > 0 && from - i < AROUND && (self.stations.stations[(i - 1) % n].frenet.p - p).norm() <= reach
        {
            i -= 1;
        }
        i.saturating_sub(1)
    }

    /// Last station no farther ahead.
    fn ahead(&self, from: usize, reach: f64) -> usize {
        let n = self.stations.stations.len();
        let end = if self.stations.closed { usize::MAX } else { n - 1 };
        let p = self.stations.stations[from % n].frenet.p;
        let mut i = from;
        while i < end
            && i - from < AROUND
            && (self.stations.stations[(i + 1) % n].frenet.p - p).norm() <= reach
        {
            i += 1;
        }
        i.saturating_add(1).min(end)
    }

    /// What `q` is nearest to between two stations.
    fn look(&self, q: Point2, share: f64, low: usize, high: usize) -> Sight {
        let n = self.stations.stations.len();
        let at = |i: usize| &self.stations.stations[i % n];
        let mut best = (f64::INFINITY, low, 0.0);
        for i in low..high.max(low + 1) {
            let (s, distance) = on_chord(q, at(i).frenet.p, at(i + 1).frenet.p);
            if distance < best.0 {
                best = (distance, i, s);
            }
        }
        let (_, i, s) = best;
        self.inside(q, share, i, s).unwrap_or_else(|| {
            let end = if s >= 0.5 { i + 1 } else { i };
            self.end(q, share, end)
        })
    }

    /// The nearest point inside the span between stations `i` and `i + 1`.
    fn inside(&self, q: Point2, share: f64, i: usize, s: f64) -> Option<Sight> {
        let n = self.stations.stations.len();
        let station = &self.stations.stations[i % n];
        let span = station.span;
        let breaks = self.tube.curve.breaks();
        let (start, end) = (*breaks.get(span)?, *breaks.get(span + 1)?);
        let next = &self.stations.stations[(i + 1) % n];
        let until = if next.span == span && !(i + 1).is_multiple_of(n) { next.u } else { end };
        let chord = (next.frenet.p - station.frenet.p).norm();
        let sharp = s <= 0.0 && self.corner(i).is_some() || s >= 1.0 && self.corner(i + 1).is_some();
        if chord == 0.0 || sharp {
            return None;
        }
        let guess = station.u + (until - station.u) * s;
        let (u, d) = foot(self.tube.curve, span, q, (start, end), guess.clamp(start, end))?;
        Some(Sight { share, station: i, feature: Feature::Span(span), u, d })
    }

    /// A station as the nearest point.
    fn end(&self, q: Point2, share: f64, i: usize) -> Sight {
        let n = self.stations.stations.len();
        let station: &Station = &self.stations.stations[i % n];
        let w: Vec2 = q - station.frenet.p;
        let (feature, d) = match self.corner(i) {
            Some(c) => {
                let side = w.dot(&self.stations.corners[c].bisector());
                (Feature::Corner(c), if side < 0.0 { -w.norm() } else { w.norm() })
            }
            None => (Feature::Joint(i % n), w.dot(&station.frenet.n())),
        };
        Sight { share, station: i, feature, u: station.u, d }
    }

    /// The corner at a station.
    fn corner(&self, i: usize) -> Option<usize> {
        let (n, corners) = (self.stations.stations.len(), &self.stations.corners);
        let has = |i: usize| {
            let at = corners.partition_point(|c| c.last < i);
            corners.get(at).is_some_and(|c| c.first <= i).then_some(at)
        };
        has(i % n).or_else(|| if i.is_multiple_of(n) { has(n) } else { None })
    }
}

/// Share of a chord nearest to `q`, and the distance.
fn on_chord(q: Point2, a: Point2, b: Point2) -> (f64, f64) {
    let d = b - a;
    let square = d.norm_squared();
    let s = if square > 0.0 { ((q - a).dot(&d) / square).clamp(0.0, 1.0) } else { 0.0 };
    (s, (q - (a + d * s)).norm())
}
