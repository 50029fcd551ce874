//! A track laid out in the plane: a curve whose curvature is that of the track along the surface's normal.
//!
//! With e the chord between neighbouring stations and n their normals, the chord of the layout makes the same angles
//! with the layout's normals: sin α = e·n/|e|. Deviations along the normal are then those in space, to the third order
//! in the length of a link.
//!
//! Few stations are exact ([`super::anchors`]): where the track is smooth cubics through these tell the others.

use crate::geom::surface::{Contact, Track};
use crate::geom::{Point2, Vec2, Vec3};

use super::super::fit::ribbon::Ribbon;
use super::anchors::{self, Anchor, NEAREST, Spot};
use super::vertex::Vertex;

/// Normals of neighbouring stations that differ by more, rad, are those of a corner.
const CORNER: f64 = 0.02;

#[derive(Debug, Clone, Copy)]
struct Station {
    spot: Spot,
    /// Place in the plane, mm.
    at: Point2,
    /// The normal there.
    normal: Vec2,
    /// By how much chords to its neighbours cut a corner, mm: inside (the curve is hollow) and outside.
    slack: (f64, f64),
}

/// A developed track.
#[derive(Debug)]
pub(super) struct Chart {
    stations: Vec<Station>,
    corners: Vec<usize>,
    anchors: Vec<Anchor>,
}

impl Chart {
    /// Stations so dense that chords deviate by `sagitta` mm at most, but for corners; `None` where the track is lost.
    pub(super) fn new(track: &Track, sagitta: f64, ends: (Contact, Contact)) -> Option<Chart> {
        let anchors = anchors::of(track, sagitta, ends)?;
        let spots = anchors::spots(&anchors, sagitta);
        Some(Chart::lay_out(&spots, anchors))
    }

    fn lay_out(spots: &[Spot], anchors: Vec<Anchor>) -> Chart {
        let mut stations: Vec<Station> = Vec::with_capacity(spots.len());
        let mut corners = Vec::new();
        let (mut at, mut normal) = (Point2::origin(), Vec2::new(0.0, 1.0));
        for (i, &spot) in spots.iter().enumerate() {
            let mut slack = (0.0, 0.0);
            if let Some(before) = i.checked_sub(1).and_then(|j| spots.get(j)) {
                let chord = spot.centre - before.centre;
                let length = chord.norm();
                let rise = |n: &Vec3| {
                    if length > 0.0 { (chord.dot(n) / length).clamp(-1.0, 1.0) } else { 0.0 }
                };
                let (a, b) = (rise(&before.normal), rise(&spot.normal));
                let along = Vec2::new(normal.y, -normal.x);
                let way = along * (1.0 - a * a).sqrt() + normal * a;
                at += way * length;
                normal = Vec2::new(-way.y, way.x) * (1.0 - b * b).sqrt() + way * b;
                normal /= normal.norm();
                let sagitta = length * (a - b) / 8.0;
                slack = (sagitta.max(0.0), (-sagitta).max(0.0));
                if (spot.normal - before.normal).norm() > CORNER && length < 2.0 * NEAREST {
                    corners.push(i);
                    slack = (0.0, 0.0);
                }
                if let Some(previous) = stations.last_mut() {
                    previous.slack = (previous.slack.0.max(slack.0), previous.slack.1.max(slack.1));
                }
            }
            stations.push(Station { spot, at, normal, slack });
        }
        Chart { stations, corners, anchors }
    }

    pub(super) fn len(&self) -> usize {
        self.stations.len()
    }
    /// The contact at a station, with a foot near by.
    pub(super) fn contact(&self, i: usize) -> Contact {
        let Spot { centre, normal, anchor, .. } = self.stations[i].spot;
        Contact { centre, normal, foot: self.anchors[anchor].contact.foot }
    }
    /// Parameter of the track at a station.
    pub(super) fn t(&self, i: usize) -> f64 {
        self.stations[i].spot.t
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
        s.at + s.normal * off
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
        let next = next.min(self.stations.len() - 1);
        let before = next.saturating_sub(1);
        let (a, b) = (&self.stations[before], &self.stations[next]);
        let chord = b.at - a.at;
        let normal = |share: f64| {
            let n = a.normal + (b.normal - a.normal) * share;
            n / n.norm().max(1e-300)
        };
        let (mut share, mut off) = (0.5, 0.0);
        for _ in 0..4 {
            let foot = p - normal(share) * off;
            share = ((foot - a.at).dot(&chord) / chord.norm_squared().max(1e-300)).clamp(0.0, 1.0);
            let on = a.at + chord * share;
            off = (p - on).dot(&normal(share));
        }
        // The curve lies off the chord by its own sagitta.
        let bulge = (a.slack.1.min(b.slack.1) - a.slack.0.min(b.slack.0)) * 4.0 * share * (1.0 - share);
        (a.spot.t + (b.spot.t - a.spot.t) * share, off - bulge, self.contact(before))
    }
    /// Parameters of vertices: those that are known, and the ends; corners lie between their neighbours.
    pub(super) fn parameters(&self, vertices: &[Vertex]) -> Vec<f64> {
        let last = vertices.len().saturating_sub(1);
        let mut before = 0.0;
        let nearest = |v: &Vertex, from: f64| {
            let ahead = self.stations.iter().filter(|s| s.spot.t >= from);
            let gap = |s: &&Station| (s.spot.centre - v.centre).norm_squared();
            ahead.min_by(|a, b| gap(a).total_cmp(&gap(b))).map_or(from, |s| s.spot.t)
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
