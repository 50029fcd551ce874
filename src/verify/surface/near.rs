//! Moves near a place, the nearest first.

use super::capsule::Corner;
use super::field::Field;
use crate::geom::{Point3, Vec3};

/// Moves that pass a place within some distance: a part of a list of them, with their square distances.
#[derive(Clone, Copy)]
pub(super) struct Near {
    middle: Point3,
    far: f64,
    pub first: usize,
    pub end: usize,
}

/// Lists of moves, each with its square distance from a place, mm²; the last one is that of the smallest cell.
pub(super) type Lists = Vec<(f64, u32)>;

/// Places for smaller cells are looked at so much farther than for the cell itself, by its own size.
const MORE: f64 = 1.3;

impl Field<'_> {
    /// Moves that may reach the corners of a cell; taken from those near a larger cell where these are enough.
    pub(super) fn near(&self, corners: &[Corner; 4], larger: Option<Near>, lists: &mut Lists) -> Near {
        let centres = corners.map(|c| self.centre(&c));
        let sum = centres.iter().fold(Vec3::zeros(), |sum, c| sum + c.coords);
        let middle = Point3::from(sum / 4.0);
        let half = centres.iter().map(|c| (c - middle).norm()).fold(0.0, f64::max);
        let (wanted, least) = (self.around + MORE * half, self.around + half);
        let known = larger.map(|l| (l, l.far - (l.middle - middle).norm())).filter(|(_, far)| *far >= least);
        let far = known.map_or(wanted, |(_, far)| far.min(wanted));
        lists.truncate(larger.map_or(0, |l| l.end));
        let first = lists.len();
        let take = |lists: &mut Lists, i: u32| {
            let apart = self.capsules.get(i as usize).map_or(f64::INFINITY, |c| c.apart(middle));
            if apart <= far * far {
                lists.push((apart, i));
            }
        };
        if let Some((larger, _)) = known {
            (larger.first..larger.end).for_each(|k| take(lists, lists[k].1));
        } else {
            let mut found = Vec::new();
            self.gather_about((middle.xy(), half), far, &mut found);
            found.into_iter().for_each(|i| take(lists, i));
        }
        lists[first..].sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        Near { middle, far, first, end: lists.len() }
    }
}
