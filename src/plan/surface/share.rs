//! The distance of two passes as a share of what is allowed.

use rayon::prelude::*;

use super::family::Family;
use super::march::PLACES;
use crate::geom::Vec3;
use crate::geom::surface::{Contact, Track, ridge};
use crate::math::count;

/// What decides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Target {
    /// Height of cusps, mm.
    Cusp(f64),
    /// Distance on the surface, mm.
    Step(f64),
}

/// A place of a pass.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub contact: Contact,
    /// *Along* and *across*.
    pub at: [f64; 2],
    /// Unit tangent, and mm of the centre's way per unit of *along*.
    tangent: Vec3,
    speed: f64,
    /// How *across* changes with *along* on the pass.
    slope: f64,
    /// Range of *along*.
    range: (f64, f64),
}

impl Place {
    /// `None` where the pass has no tangent.
    pub(super) fn new(
        family: &Family,
        contact: Contact,
        at: [f64; 2],
        slope: f64,
        range: (f64, f64),
    ) -> Option<Place> {
        let whole = range.1 - range.0;
        let d = 1e-4 * whole * if at[0] > 0.5 * (range.0 + range.1) { -1.0 } else { 1.0 };
        let near = family.contact(at[1] + slope * d, at[0] + d, Some(&contact))?;
        let way = (near.centre - contact.centre) / d;
        let speed = way.norm();
        Some(Place { contact, at, tangent: way.try_normalize(1e-9)?, speed, slope, range })
    }

    /// The distance from the pass at `across` as a share of what is allowed; `None` where there is none.
    pub(super) fn share(&self, family: &Family, target: Target, across: f64) -> Option<f64> {
        let on = |along: f64| {
            family.contact(across + self.slope * (along - self.at[0]), along, Some(&self.contact))
        };
        let (b, tangent) = self.opposite(&on)?;
        Some(share(family, target, &self.contact, &b, tangent))
    }

    /// The contact of the other pass that lies at right angles to this one; beside the end of a pass, that end. With the
    /// direction in which distances do not count.
    fn opposite(&self, on: &dyn Fn(f64) -> Option<Contact>) -> Option<(Contact, Vec3)> {
        let first = on(self.at[0])?;
        let ahead = (first.centre - self.contact.centre).dot(&self.tangent) / self.speed.max(1e-9);
        let along = self.at[0] - ahead;
        let inside = along.clamp(self.range.0, self.range.1);
        let b = on(inside)?;
        Some((b, if inside == along { self.tangent } else { Vec3::zeros() }))
    }
}

/// A path may be to the side of its track by this share of the distance of passes, at least and at most.
const ASIDE: (f64, f64) = (0.0015, 0.05);

/// How far the path of each pass may be to the side: half of what its distance from both neighbours leaves, at
/// equidistant parameters.
pub(super) fn rooms(family: &Family, target: Target, tracks: &[Track]) -> Vec<Vec<f64>> {
    let gaps: Vec<Vec<f64>> =
        tracks.par_windows(2).map(|pair| gap(family, target, &pair[0], &pair[1])).collect();
    let own = |j: usize, k: usize| {
        let sides = [j.checked_sub(1), Some(j)].into_iter().flatten().filter_map(|i| gaps.get(i)?.get(k));
        sides.copied().fold(f64::INFINITY, f64::min)
    };
    (0..tracks.len()).map(|j| (0..=PLACES).map(|k| own(j, k)).collect()).collect()
}

/// What the distance of two passes leaves to each, mm.
fn gap(family: &Family, target: Target, a: &Track, b: &Track) -> Vec<f64> {
    let room = |k: usize| {
        let t = count(k) / count(PLACES);
        let contact = a.at(t, None)?;
        let d = if t < 0.5 { 1e-4 } else { -1e-4 };
        let way = (a.at(t + d, Some(&contact))?.centre - contact.centre) / d;
        let tangent = way.try_normalize(1e-9)?;
        let place =
            Place { contact, at: [t, 0.0], tangent, speed: way.norm(), slope: 0.0, range: (0.0, 1.0) };
        let (other, tangent) = place.opposite(&|t| b.at(t, None))?;
        let apart = ridge::across(&contact, &other, tangent).norm();
        let spare = match target {
            Target::Cusp(_) => 0.5 * (1.0 / share(family, target, &contact, &other, tangent).max(1e-3) - 1.0),
            Target::Step(_) => ASIDE.1,
        };
        Some(apart * spare.clamp(ASIDE.0, ASIDE.1))
    };
    (0..=PLACES).map(|k| room(k).unwrap_or(f64::INFINITY)).collect()
}

/// The distance of two passes as a share of what is allowed.
fn share(family: &Family, target: Target, a: &Contact, b: &Contact, tangent: Vec3) -> f64 {
    match target {
        Target::Step(step) => {
            let apart = b.foot.point - a.foot.point;
            (apart - tangent * apart.dot(&tangent)).norm() / step
        }
        Target::Cusp(h) => {
            let flat = ridge::across(a, b, tangent).norm() / (2.0 * (h * (2.0 * family.ball - h)).sqrt());
            let height = ridge::height(&family.tree, family.ball, a, b, tangent);
            // Where the ball cannot reach the surface, what stays is no cusp: passes need not be any closer there.
            const CLOSEST: f64 = 4.0;
            if height.is_finite() { (height.max(0.0) / h).sqrt().min(CLOSEST * flat) } else { flat }
        }
    }
}
