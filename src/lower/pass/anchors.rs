//! Exact places of a track, as few as tell the others: where the track is smooth, by cubics through four neighbours.

use crate::geom::surface::{Contact, Track};
use crate::geom::{Point3, Vec3};
use crate::math;

/// Anchors are no farther apart than this part of the track …
const PARTS: u32 = 24;
/// … nor, where others lie between them, than this part of the radius of the ball that rounds the cutter: what it meets
/// between them is not missed.
const SHARE: f64 = 0.5;
/// … and no nearer than this, mm.
pub(super) const NEAREST: f64 = 2e-3;
/// A track is smooth where a cubic misses a new anchor by no more than this part of the sagitta that is asked for; with that
/// anchor it misses by a sixteenth of it.
const SMOOTH: f64 = 0.02;
/// … and its normal by no more than this, rad.
const TURN: f64 = 1e-4;
/// Anchors of one track at most.
const MOST: usize = 400_000;

/// An exact place of a track.
#[derive(Debug, Clone, Copy)]
pub(super) struct Anchor {
    pub t: f64,
    pub contact: Contact,
    /// What is known of the track from here to the next anchor.
    next: Next,
}

/// A stretch between two anchors.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Next {
    /// Not known yet.
    Open,
    /// A chord will do, or nothing better is to be had.
    Chord,
    /// Cubics tell the places between.
    Smooth,
}

/// A place of a track, exact or told by its neighbours.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spot {
    pub t: f64,
    /// The centre, mm, and the unit normal.
    pub centre: Point3,
    pub normal: Vec3,
    /// The anchor at it or before it.
    pub anchor: usize,
}

/// The anchors of a track between its ends, for stations whose chords deviate by `sagitta` mm at most; `None` where it is
/// lost.
pub(super) fn of(track: &Track, sagitta: f64, (first, last): (Contact, Contact)) -> Option<Vec<Anchor>> {
    let mut anchors = vec![Anchor { t: 0.0, contact: first, next: Next::Open }];
    for k in 1..=PARTS {
        let t = f64::from(k) / f64::from(PARTS);
        let before = anchors.last()?.contact;
        let contact = if k == PARTS { last } else { track.at(t, Some(&before))? };
        anchors.push(Anchor { t, contact, next: Next::Open });
    }
    loop {
        let found = denser(track, sagitta, &anchors)?;
        if found.len() == anchors.len() {
            return Some(found);
        }
        anchors = found;
    }
}

/// The anchors with another one in the middle of every stretch that needs it.
fn denser(track: &Track, sagitta: f64, anchors: &[Anchor]) -> Option<Vec<Anchor>> {
    let mut out = Vec::with_capacity(2 * anchors.len());
    for (i, a) in anchors.iter().enumerate() {
        let Some(b) = anchors.get(i + 1).filter(|_| a.next == Next::Open) else {
            out.push(*a);
            continue;
        };
        let length = (b.contact.centre - a.contact.centre).norm();
        let fine = bulge(&a.spot(i), &b.spot(i)) <= sagitta;
        if fine || length <= NEAREST || b.t - a.t < 1e-12 || anchors.len() >= MOST {
            out.push(Anchor { next: Next::Chord, ..*a });
            continue;
        }
        let t = 0.5 * (a.t + b.t);
        let contact = track.at(t, Some(&a.contact))?;
        let told = Cubic::new(anchors, i).at(t);
        let near = (told.centre - contact.centre).norm() <= SMOOTH * sagitta
            && (told.normal - contact.normal).norm() <= TURN
            && length <= 2.0 * SHARE * track.radius;
        let next = if near { Next::Smooth } else { Next::Open };
        out.push(Anchor { next, ..*a });
        out.push(Anchor { t, contact, next });
    }
    Some(out)
}

/// How far a chord deviates, mm.
fn bulge(a: &Spot, b: &Spot) -> f64 {
    (b.centre - a.centre).norm() * (b.normal - a.normal).norm() / 8.0
}

/// Places whose chords deviate by `sagitta` mm at most.
pub(super) fn spots(anchors: &[Anchor], sagitta: f64) -> Vec<Spot> {
    let mut out = Vec::with_capacity(4 * anchors.len());
    for (i, a) in anchors.iter().enumerate() {
        out.push(a.spot(i));
        let Some(b) = anchors.get(i + 1).filter(|_| a.next == Next::Smooth) else { continue };
        let cubic = Cubic::new(anchors, i);
        let middle = cubic.at(0.5 * (a.t + b.t));
        for (from, to, is_last) in [(a.spot(i), middle, false), (middle, b.spot(i), true)] {
            let parts = (bulge(&from, &to) / sagitta).sqrt().ceil().clamp(1.0, 1e4);
            // The parts are few.
            let parts = parts as usize;
            let share = |k: usize| from.t + (to.t - from.t) * (math::count(k) / math::count(parts));
            out.extend((1..parts).map(|k| cubic.at(share(k))));
            out.extend((!is_last).then_some(to));
        }
    }
    out
}

impl Anchor {
    fn spot(&self, anchor: usize) -> Spot {
        Spot { t: self.t, centre: self.contact.centre, normal: self.contact.normal, anchor }
    }
}

/// Cubics through the four anchors about a stretch (Lagrange's).
struct Cubic<'a> {
    near: &'a [Anchor],
    /// 1/Π (t_i - t_j).
    weights: [f64; 4],
    anchor: usize,
}

impl<'a> Cubic<'a> {
    fn new(anchors: &'a [Anchor], i: usize) -> Cubic<'a> {
        // There are more than four of them.
        let first = i.saturating_sub(1).min(anchors.len() - 4);
        let near = &anchors[first..first + 4];
        let others = |i: usize| (0..4).filter(move |j| *j != i);
        let weights =
            core::array::from_fn(|i| 1.0 / others(i).map(|j| near[i].t - near[j].t).product::<f64>());
        Cubic { near, weights, anchor: i }
    }

    fn at(&self, t: f64) -> Spot {
        let d: [f64; 4] = core::array::from_fn(|i| t - self.near[i].t);
        let shares = [d[1] * d[2] * d[3], d[0] * d[2] * d[3], d[0] * d[1] * d[3], d[0] * d[1] * d[2]];
        let (mut centre, mut normal) = (Vec3::zeros(), Vec3::zeros());
        for (near, (share, weight)) in self.near.iter().zip(shares.iter().zip(self.weights)) {
            centre += near.contact.centre.coords * (share * weight);
            normal += near.contact.normal * (share * weight);
        }
        Spot {
            t,
            centre: Point3::from(centre),
            normal: normal / normal.norm().max(1e-300),
            anchor: self.anchor,
        }
    }
}
