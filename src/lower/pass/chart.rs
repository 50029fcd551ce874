//! A track laid out in the plane: a curve whose curvature is that of the track along the surface's normal.
//!
//! With e the chord between neighbouring stations and n their normals, the chord of the layout makes the same angles
//! with the layout's normals: sin α = e·n/|e|. Deviations along the normal are then those in space, to the third order
//! in the length of a link.

use crate::geom::surface::{Contact, Track};
use crate::geom::{Point2, Vec2};
use crate::math;

use super::super::fit::ribbon::Ribbon;
use super::vertex::Vertex;

/// Stations are no farther apart than this part of the track.
const PARTS: u32 = 24;
/// … and no nearer than this, mm.
const NEAREST: f64 = 2e-3;
/// Normals of neighbouring stations that differ by more, rad, are those of a corner.
const CORNER: f64 = 0.02;
/// Stations of one track at most.
const MOST: usize = 400_000;

#[derive(Debug, Clone, Copy)]
struct Station {
    t: f64,
    contact: Contact,
    /// Place in the plane, mm.
    at: Point2,
    /// Direction of travel there.
    heading: f64,
    /// By how much chords to its neighbours cut a corner, mm: inside (the curve is hollow) and outside.
    slack: (f64, f64),
}

/// A developed track.
#[derive(Debug)]
pub(super) struct Chart {
    stations: Vec<Station>,
    corners: Vec<usize>,
}

impl Chart {
    /// Stations so dense that chords deviate by `sagitta` mm at most, but for corners; `None` where the track is lost.
    pub(super) fn new(track: &Track, sagitta: f64, (first, last): (Contact, Contact)) -> Option<Chart> {
        let mut found = vec![(0.0, first)];
        for k in 1..=PARTS {
            let t = f64::from(k) / f64::from(PARTS);
            let (_, before) = *found.last()?;
            let contact = if k == PARTS { last } else { track.at(t, Some(&before))? };
            refine(track, (t, contact), sagitta, &mut found)?;
        }
        Some(Chart::lay_out(&found))
    }

    fn lay_out(found: &[(f64, Contact)]) -> Chart {
        let mut stations: Vec<Station> = Vec::with_capacity(found.len());
        let mut corners = Vec::new();
        let (mut at, mut heading) = (Point2::origin(), 0.0);
        for (i, (t, contact)) in found.iter().enumerate() {
            let mut slack = (0.0, 0.0);
            if let Some((_, before)) = i.checked_sub(1).and_then(|j| found.get(j)) {
                let chord = contact.centre - before.centre;
                let length = chord.norm();
                let rise = |c: &Contact| {
                    if length > 0.0 { (chord.dot(&c.normal) / length).clamp(-1.0, 1.0) } else { 0.0 }
                };
                let (a, b) = (rise(before), rise(contact));
                let way = heading + math::asin(a);
                at += Vec2::new(math::cos(way), math::sin(way)) * length;
                heading = way - math::asin(b);
                let sagitta = length * (a - b) / 8.0;
                slack = (sagitta.max(0.0), (-sagitta).max(0.0));
                if turn(before, contact) > CORNER && length < 2.0 * NEAREST {
                    corners.push(i);
                    slack = (0.0, 0.0);
                }
                if let Some(previous) = stations.last_mut() {
                    previous.slack = (previous.slack.0.max(slack.0), previous.slack.1.max(slack.1));
                }
            }
            stations.push(Station { t: *t, contact: *contact, at, heading, slack });
        }
        Chart { stations, corners }
    }

    pub(super) fn len(&self) -> usize {
        self.stations.len()
    }
    pub(super) fn contact(&self, i: usize) -> Contact {
        self.stations[i].contact
    }
    /// Parameter of the track at a station.
    pub(super) fn t(&self, i: usize) -> f64 {
        self.stations[i].t
    }
    /// Smooth stretches, as their first and last stations.
    pub(super) fn pieces(&self) -> Vec<(usize, usize)> {
        let mut pieces = Vec::new();
        let mut start = 0;
        for &corner in &self.corners {
            if corner > start + 1 {
                pieces.push((start, corner - 1));
            }
            start = corner;
        }
        let last = self.stations.len() - 1;
        if last > start || pieces.is_empty() {
            pieces.push((start, last));
        }
        pieces
    }
    /// The place `off` the track at station `i`.
    pub(super) fn place(&self, i: usize, off: f64) -> Point2 {
        let s = &self.stations[i];
        s.at + normal(s.heading) * off
    }
    /// How far off the track a band from `low` to `high` reaches at a station, less what chords to its neighbours cut off.
    pub(super) fn gate(&self, i: usize, (low, high): (f64, f64)) -> (f64, f64) {
        let (slack, middle) = (self.stations[i].slack, 0.5 * (low + high));
        // Where the track is hollow a chord between gates' ends lies above it, where it is round below.
        ((low + slack.1).min(middle), (high - slack.0).max(middle))
    }
    /// The band from `low` to `high` along a piece.
    pub(super) fn ribbon(&self, piece: (usize, usize), low: f64, high: f64) -> Ribbon {
        let mut ribbon = Ribbon::default();
        for i in piece.0..=piece.1 {
            let (lower, upper) = self.gate(i, (low, high));
            ribbon.left.push(self.place(i, upper));
            ribbon.right.push(self.place(i, lower));
        }
        ribbon
    }
    /// Parameter of the track and distance off it of a place before station `next`; with a contact near by.
    pub(super) fn locate(&self, next: usize, p: Point2) -> (f64, f64, Contact) {
        let b = &self.stations[next.min(self.stations.len() - 1)];
        let a = &self.stations[next.min(self.stations.len() - 1).saturating_sub(1)];
        let chord = b.at - a.at;
        let (mut share, mut off) = (0.5, 0.0);
        for _ in 0..4 {
            let heading = a.heading + (b.heading - a.heading) * share;
            let n = normal(heading);
            let foot = p - n * off;
            share = ((foot - a.at).dot(&chord) / chord.norm_squared().max(1e-300)).clamp(0.0, 1.0);
            let on = a.at + chord * share;
            off = (p - on).dot(&normal(a.heading + (b.heading - a.heading) * share));
        }
        // The curve lies off the chord by its own sagitta.
        let bulge = (a.slack.1.min(b.slack.1) - a.slack.0.min(b.slack.0)) * 4.0 * share * (1.0 - share);
        (a.t + (b.t - a.t) * share, off - bulge, a.contact)
    }
    /// Parameters of vertices: those that are known, and the ends; corners lie between their neighbours.
    pub(super) fn parameters(&self, vertices: &[Vertex]) -> Vec<f64> {
        let last = vertices.len().saturating_sub(1);
        let mut before = 0.0;
        let nearest = |v: &Vertex, from: f64| {
            let ahead = self.stations.iter().filter(|s| s.t >= from);
            let gap = |s: &&Station| (s.contact.centre - v.centre).norm_squared();
            ahead.min_by(|a, b| gap(a).total_cmp(&gap(b))).map_or(from, |s| s.t)
        };
        let place = |(i, v): (usize, &Vertex)| {
            before = match i {
                0 => 0.0,
                _ if i == last => 1.0,
                _ if v.t.is_finite() => v.t,
                _ => nearest(v, before),
            };
            before
        };
        vertices.iter().enumerate().map(place).collect()
    }
}

fn normal(heading: f64) -> Vec2 {
    Vec2::new(-math::sin(heading), math::cos(heading))
}

/// Angle between the normals, rad (for small angles).
fn turn(a: &Contact, b: &Contact) -> f64 {
    (b.normal - a.normal).norm()
}

/// Stations up to `to`, halved until chords deviate little.
fn refine(track: &Track, to: (f64, Contact), sagitta: f64, found: &mut Vec<(f64, Contact)>) -> Option<()> {
    let mut stack = vec![to];
    while let Some((t, contact)) = stack.pop() {
        let (from, before) = *found.last()?;
        let length = (contact.centre - before.centre).norm();
        let fine = length * turn(&before, &contact) / 8.0 <= sagitta;
        if fine || length <= NEAREST || t - from < 1e-12 || found.len() >= MOST {
            found.push((t, contact));
            continue;
        }
        let middle = 0.5 * (from + t);
        stack.push((t, contact));
        stack.push((middle, track.at(middle, Some(&before))?));
    }
    Some(())
}
