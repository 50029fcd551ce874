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
/// Where a round has not helped, so much more is asked for in the next …
const HARDER: f64 = 0.6;
/// … and after so many such rounds in a row nothing helps.
const IDLE: u32 = 3;
/// Places of two rounds are the same within this share of their reach.
const SAME: f64 = 0.5;

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

/// A place that the proof of one round found, and how many rounds in a row have not helped there.
#[derive(Debug, Clone, Copy)]
struct Found {
    operation: usize,
    place: Place,
    idle: u32,
}

/// Such places, operation by operation.
#[derive(Debug, Clone, Default)]
pub struct Closer {
    places: Vec<(usize, Place)>,
    /// Those of the last round.
    last: Vec<Found>,
    marches: BTreeMap<usize, March>,
}

impl Closer {
    /// Nothing asked for yet; what the plan so far tried out is kept.
    #[must_use]
    pub fn after(cl: &Cl) -> Closer {
        let march = |(k, operation): (usize, &Operation)| Some((k, operation.guard.surface.as_ref()?.march?));
        Closer { marches: cl.operations.iter().enumerate().filter_map(march).collect(), ..Closer::default() }
    }

    /// How the bent passes of an operation follow one another, where that is known.
    pub(super) fn march(&self, operation: usize) -> Option<March> {
        self.marches.get(&operation).copied()
    }

    /// Asks for lower cusps in an operation (by its index) at some places: `share` counts on top of what was asked before.
    /// `everywhere`: by the same share all over the operation's surface, too. Whether that may help: not where rounds in a row
    /// have left a place as it was.
    pub fn add(&mut self, short: &[(usize, Place)], everywhere: bool) -> bool {
        let mut asked = Vec::new();
        let found: Vec<Found> = short.iter().map(|short| self.found(short)).collect();
        for Found { operation, place, idle } in &found {
            let before = self.of(*operation);
            let harder = (0..*idle).fold(place.share, |share, _| share * HARDER);
            let lower = |share: f64| (harder * share).max(LEAST);
            asked.push((*operation, Place { share: lower(before.share(place.at)), ..*place }));
            if everywhere {
                let share = lower(before.everywhere());
                asked.push((*operation, Place { reach: f64::INFINITY, share, ..*place }));
            }
        }
        self.places.extend(asked);
        self.last = found;
        self.last.iter().all(|found| found.idle < IDLE)
    }

    /// A place beside what the last round found about it.
    fn found(&self, &(operation, place): &(usize, Place)) -> Found {
        let away = |f: &Found| (f.place.at - place.at).norm();
        let known = self.last.iter().filter(|f| f.operation == operation);
        let before =
            known.min_by(|a, b| away(a).total_cmp(&away(b))).filter(|f| away(f) <= SAME * place.reach);
        let idle = before.filter(|f| place.share <= f.place.share).map_or(0, |f| f.idle + 1);
        Found { operation, place, idle }
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
        closer.last.clear();
        closer.add(&asked, false);
        assert_eq!(closer.of(0).share(at), 1.0);
        let own = closer.of(1);
        assert!((own.share(at) - 0.81).abs() < 1e-12);
        assert!((own.share(Point3::new(4.0, 2.0, 3.0)) - 0.905).abs() < 1e-12);
        assert_eq!(own.share(Point3::new(6.0, 2.0, 3.0)), 1.0);
        for share in [0.9, 0.81] {
            closer.last.clear();
            closer.add(&asked, true);
            assert!((closer.of(1).share(Point3::new(1e3, 0.0, 0.0)) - share).abs() < 1e-12);
        }
        assert!((closer.of(1).share(at) - 0.81 * 0.81).abs() < 1e-12);
    }

    /// What helps is asked for again as it is; what does not, harder, and not for ever.
    #[test]
    fn rounds_that_do_not_help_ask_for_more_and_come_to_an_end() {
        let place = |share: f64| [(0, Place { at: Point3::origin(), reach: 2.0, share })];
        let mut helped = Closer::default();
        for share in [0.8, 0.85, 0.9, 0.95, 0.99] {
            assert!(helped.add(&place(share), false));
        }
        let all = 0.8 * 0.85 * 0.9 * 0.95 * 0.99;
        assert!((helped.of(0).share(Point3::origin()) - all).abs() < 1e-12);
        let mut idle = Closer::default();
        assert!(idle.add(&place(0.9), false));
        assert!(idle.add(&place(0.9), false));
        assert!((idle.of(0).share(Point3::origin()) - 0.9 * 0.9 * HARDER).abs() < 1e-12);
        assert!(idle.add(&place(0.9), false));
        assert!(!idle.add(&place(0.9), false));
    }
}
