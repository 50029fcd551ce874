//! Where passes must lie closer than the target alone asks for, because the proof found that too much was left.
//!
//! Passes are spread on their exact tracks; the blocks that express them deviate, and ridges are measured at columns only.
//! What that takes is a constant margin nearly everywhere; where it is not enough, the plan is made again with these places.

use std::collections::BTreeMap;

use crate::cl::{Cl, March, Operation};
use crate::geom::Point3;

/// Beyond this many times a place's reach nothing is changed; in between the share grows evenly.
const FADES: f64 = 2.0;
/// Shares are not taken below this.
const LEAST: f64 = 0.05;

/// A place where cusps must be lower.
#[derive(Debug, Clone, Copy)]
pub struct Place {
    /// Where, on the surface.
    pub at: Point3,
    /// So far around it, mm.
    pub reach: f64,
    /// The height of cusps there, as a share of the height asked for.
    pub share: f64,
}

/// Such places, operation by operation.
#[derive(Debug, Clone, Default)]
pub struct Closer {
    places: Vec<(usize, Place)>,
    marches: BTreeMap<usize, March>,
}

impl Closer {
    /// Nothing asked for yet; what the plan so far tried out is kept.
    #[must_use]
    pub fn after(cl: &Cl) -> Closer {
        let march = |(k, operation): (usize, &Operation)| Some((k, operation.guard.surface.as_ref()?.march?));
        Closer { places: Vec::new(), marches: cl.operations.iter().enumerate().filter_map(march).collect() }
    }

    /// How the bent passes of an operation follow one another, where that is known.
    pub(super) fn march(&self, operation: usize) -> Option<March> {
        self.marches.get(&operation).copied()
    }

    /// Asks for lower cusps in an operation (by its index) at some places: `share` counts on top of what was asked before.
    /// `everywhere`: by the same share all over the operation's surface, too.
    pub fn add(&mut self, short: &[(usize, Place)], everywhere: bool) {
        let mut asked = Vec::new();
        for (operation, place) in short {
            let before = self.of(*operation);
            let lower = |share: f64| (place.share * share).max(LEAST);
            asked.push((*operation, Place { share: lower(before.share(place.at)), ..*place }));
            if everywhere {
                let share = lower(before.everywhere());
                asked.push((*operation, Place { reach: f64::INFINITY, share, ..*place }));
            }
        }
        self.places.extend(asked);
    }

    /// The places of one operation.
    pub(super) fn of(&self, operation: usize) -> Shares {
        Shares(self.places.iter().filter(|(o, _)| *o == operation).map(|(_, p)| *p).collect())
    }
}

/// The places of one operation.
#[derive(Debug, Clone, Default)]
pub(super) struct Shares(Vec<Place>);

impl Shares {
    /// The share of the height of cusps that may be used at a point.
    pub(super) fn share(&self, p: Point3) -> f64 {
        self.0.iter().map(|place| place.share_at(p)).fold(1.0, f64::min)
    }
}

impl Shares {
    /// Whether nothing is asked for.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The share that may be used all over the surface.
    fn everywhere(&self) -> f64 {
        self.0.iter().filter(|place| place.reach.is_infinite()).map(|place| place.share).fold(1.0, f64::min)
    }
}

impl Place {
    fn share_at(&self, p: Point3) -> f64 {
        let far = if self.reach.is_finite() { (p - self.at).norm() / self.reach.max(1e-9) } else { 0.0 };
        let faded = ((far - 1.0) / (FADES - 1.0)).clamp(0.0, 1.0);
        self.share + (1.0 - self.share) * faded
    }
}

/// Rounds of planning at most, the first included …
pub const ROUNDS: usize = 6;
/// … of which the last ones lower cusps all over the surface.
pub const EVERYWHERE: usize = 4;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_count_on_top_of_each_other_and_fade() {
        let at = Point3::new(1.0, 2.0, 3.0);
        let mut closer = Closer::default();
        let asked = [(1, Place { at, reach: 2.0, share: 0.9 })];
        closer.add(&asked, false);
        closer.add(&asked, false);
        assert_eq!(closer.of(0).share(at), 1.0);
        let own = closer.of(1);
        assert!((own.share(at) - 0.81).abs() < 1e-12);
        assert!((own.share(Point3::new(4.0, 2.0, 3.0)) - 0.905).abs() < 1e-12);
        assert_eq!(own.share(Point3::new(6.0, 2.0, 3.0)), 1.0);
        for share in [0.9, 0.81] {
            closer.add(&asked, true);
            assert!((closer.of(1).share(Point3::new(1e3, 0.0, 0.0)) - share).abs() < 1e-12);
        }
        assert!((closer.of(1).share(at) - 0.81 * 0.81).abs() < 1e-12);
    }
}
