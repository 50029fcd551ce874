//! Certified deviation of a chain from its curve: measured on the printed vertices, corners included.
//!
//! At every station's normal and at the extremes in between the distance of the link is measured. Beside corners, where
//! normals meet, it is measured from the link ([`super::near`]), and along the bisector on the inner side of each corner.

use super::Tube;
use super::measure::{Path, Range, Sample, between, foot};
use super::near::Near;
use super::search::Vertex;
use super::tube::{Corner, Plane, Station, Stations};
use crate::geom::Point2;
use crate::geom::curve::Frenet;
use crate::math;

/// Accuracy of the certified deviation, mm.
pub const ACCURACY: f64 = 1e-8;

/// What a chain is measured against.
#[derive(Debug, Clone, Copy)]
pub struct Certificate<'a> {
    /// Curve and band.
    pub tube: &'a Tube<'a>,
    /// The curve's stations.
    pub stations: &'a Stations,
}

impl Certificate<'_> {
    /// Smallest and largest deviation of the chain, on its printed vertices.
    pub fn chain(&self, vertices: &[Vertex]) -> Range {
        let mut range = Range::EMPTY;
        let near = Near { tube: self.tube, stations: self.stations };
        for pair in vertices.windows(2) {
            let stations = [pair[0].next.saturating_sub(1), pair[1].next.saturating_sub(1)];
            if near.corners(stations[0], pair[1].next) {
                let path = self.path(&pair[0], &pair[1]);
                let ends = [0, 1].map(|k| near.vertex(self.part(&pair[k]), stations[k]));
                near.link(&path, ends, &mut range);
                self.bisectors(&path, pair, &mut range);
            } else {
                self.link(pair, [self.foot(&pair[0]), self.foot(&pair[1])], &mut range);
            }
        }
        range
    }

    fn link(&self, pair: &[Vertex], feet: [Foot; 2], range: &mut Range) {
        let path = self.path(&pair[0], &pair[1]);
        range.add(feet[0].d);
        range.add(feet[1].d);
        let n = self.stations.stations.len();
        let mut before = feet[0].u.and_then(|u| self.sample(&path, u, feet[0].span));
        for i in pair[0].next..pair[1].next {
            let station = &self.stations.stations[i % n];
            let Some(sample) = Sample::new(&path, station.u, &station.frenet) else {
                before = None;
                continue;
            };
            range.add(sample.d);
            if let Some(before) = before {
                self.extremes(&path, before, sample, station, i, range);
            }
            before = Some(sample);
        }
        let last = feet[1].u.and_then(|u| self.sample(&path, u, feet[1].span));
        if let (Some(a), Some(b)) = (before, last)
            && b.u > a.u
            && feet[1].span < self.tube.curve.breaks().len()
        {
            between(self.tube.curve, feet[1].span, &path, (a, b), ACCURACY, range);
        }
    }

    /// Extremes between two samples, the second at station `i`.
    fn extremes(
        &self,
        path: &Path,
        a: Sample,
        mut b: Sample,
        station: &Station,
        i: usize,
        range: &mut Range,
    ) {
        let n = self.stations.stations.len();
        if station.frenet.speed == 0.0 {
            return;
        }
        let before = &self.stations.stations[(i + n - 1) % n];
        let breaks = self.tube.curve.breaks();
        let span = before.span;
        // the station at a break belongs to the next span: measured again from this one
        if station.span != span || b.u <= a.u {
            let u = breaks[span + 1];
            let Some(again) = self.sample(path, u, span) else { return };
            b = again;
        }
        if b.u > a.u {
            between(self.tube.curve, span, path, (a, b), ACCURACY, range);
        }
    }

    fn sample(&self, path: &Path, u: f64, span: usize) -> Option<Sample> {
        Sample::new(path, u, &self.tube.curve.at_in(span, u))
    }

    /// Distance from corners to the link, along their bisectors, on the inner side.
    fn bisectors(&self, path: &Path, pair: &[Vertex], range: &mut Range) {
        let n = self.stations.stations.len();
        let lap = pair[1].next / n * n;
        let laps = if lap > 0 { 2 } else { 1 };
        for shift in [0, lap].into_iter().take(laps) {
            let first = self.stations.corners.partition_point(|c| c.last + shift < pair[0].next);
            for corner in &self.stations.corners[first..] {
                if corner.first + shift > pair[1].next {
                    break;
                }
                self.bisector(path, pair, corner, range);
            }
        }
    }

    fn bisector(&self, path: &Path, pair: &[Vertex], corner: &Corner, range: &mut Range) {
        let f = Frenet { p: corner.point, t: corner.along, speed: 0.0, k: 0.0 };
        let Some(meeting) = path.meet(&f) else { return };
        let q = corner.point + corner.bisector() * meeting.d;
        let (a, b) = (self.part(&pair[0]), self.part(&pair[1]));
        let within = (q - a).dot(&(b - a)) >= 0.0 && (q - b).dot(&(a - b)) >= 0.0;
        if within && meeting.d * corner.half_sin > 0.0 {
            range.add(meeting.d);
        }
    }

    fn part(&self, v: &Vertex) -> Point2 {
        self.stations.plane.to_part(v.point())
    }

    fn path(&self, a: &Vertex, b: &Vertex) -> Path {
        match self.stations.plane {
            Plane::Xy { .. } => Path::Line { from: self.part(a), to: self.part(b) },
            Plane::Polar { step, angle_step } => {
                let polar = |v: &Vertex| (v.point().x * step, v.point().y * angle_step * math::DEG);
                Path::Spiral { from: polar(a), to: polar(b) }
            }
        }
    }

    /// The curve's point nearest to a vertex, and the signed distance there.
    fn foot(&self, v: &Vertex) -> Foot {
        let n = self.stations.stations.len();
        let p = self.part(v);
        let before = &self.stations.stations[(v.next + n - 1) % n];
        self.foot_on(p, before.span, before.u).unwrap_or_else(|| {
            // beyond the end of an open curve: on the normal of that end
            let after = &self.stations.stations[v.next % n];
            let off = |s: &Station| (p - s.frenet.p).dot(&s.frenet.t).abs();
            let end = if off(after) < off(before) { after } else { before };
            Foot { u: None, span: before.span, d: (p - end.frenet.p).dot(&end.frenet.n()) }
        })
    }

    fn foot_on(&self, p: Point2, span: usize, guess: f64) -> Option<Foot> {
        let breaks = self.tube.curve.breaks();
        let u = (*breaks.get(span)?, *breaks.get(span + 1)?);
        foot(self.tube.curve, span, p, u, guess.clamp(u.0, u.1)).map(|(u, d)| Foot { u: Some(u), span, d })
    }
}

/// The foot of a vertex on the curve.
#[derive(Debug, Clone, Copy)]
struct Foot {
    /// Parameter, unless it lies beyond an end.
    u: Option<f64>,
    span: usize,
    /// Signed distance, mm.
    d: f64,
}
