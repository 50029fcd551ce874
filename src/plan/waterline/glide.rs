//! From one ring to the next along the first: the cutter leaves a ring little by little, so that the stock beside it
//! grows slowly up to what rings are apart. Straight across it would cut a slot.

use super::chain::around;
use super::path::{Path, over};
use super::slice::{Ring, pieces};
use crate::geom::{Point2, nearest_on_way};
use crate::math::count;

/// Length of the way along the ring that is left, as a share of the distance of rings, and of that ring at most.
const LENGTH: (f64, f64) = (3.0, 0.5);
/// Points of it.
const POINTS: usize = 60;
/// Rings farther apart than this share of their distance are no neighbours there.
const NEIGHBOURS: f64 = 1.5;

impl Path<'_> {
    /// From the end of a closed ring on to the next one, which is turned so that it begins where this ends. `false` where there
    /// is no such way.
    pub(super) fn glide(&mut self, z: f64, left: &[Point2], ring: &mut Ring) -> bool {
        let Some(way) = self.way_along(z, left, ring) else { return false };
        let Some((end, at)) = way.last().and_then(|p| Some((*p, piece_at(ring, *p)?))) else { return false };
        ring.points.rotate_left(at + 1);
        ring.points.insert(0, end);
        let before = self.tally.rings;
        self.run(&way, (z, z));
        self.tally.links += self.tally.rings - before;
        self.tally.rings = before;
        true
    }

    fn way_along(&self, z: f64, left: &[Point2], ring: &Ring) -> Option<Vec<Point2>> {
        let length = (LENGTH.0 * self.manner.width).min(LENGTH.1 * around(left));
        let mut way: Vec<Point2> = Vec::with_capacity(POINTS + 1);
        let mut last: Option<(Point2, Point2)> = None;
        for k in 0..=POINTS {
            let t = count(k) / count(POINTS);
            let p = along(left, t * length)?;
            let q = nearest_of(ring, p)?;
            // Both run the same way, side by side.
            let turns = last.is_some_and(|(a, b)| (p - a).dot(&(q - b)) < 0.0);
            if turns || (q - p).norm() > NEIGHBOURS * self.manner.width {
                return None;
            }
            last = Some((p, q));
            way.push(p + (q - p) * (t * t * (3.0 - 2.0 * t)));
        }
        let is_free = way.windows(2).all(|pair| self.free((pair[0], pair[1]), z));
        let ahead = piece_at(ring, *way.last()?).and_then(|k| pieces(&ring.points, true).nth(k));
        let onward = ahead.is_some_and(|(a, b)| (b - a).dot(&(way[POINTS] - way[POINTS - 1])) > 0.0);
        let from_here =
            self.at.is_some_and(|p| (p - over(*left.first().unwrap_or(&p.xy()), z)).norm() < 1e-6);
        (is_free && onward && from_here).then_some(way)
    }
}

/// The place so far along a closed chain of points.
fn along(points: &[Point2], length: f64) -> Option<Point2> {
    let mut rest = length;
    for (a, b) in pieces(points, true) {
        let own = (b - a).norm();
        if own >= rest && own > 0.0 {
            return Some(a + (b - a) * (rest / own));
        }
        rest -= own;
    }
    points.first().copied()
}

/// The place of a ring that is nearest to another.
fn nearest_of(ring: &Ring, p: Point2) -> Option<Point2> {
    let feet = pieces(&ring.points, true).map(|(a, b)| nearest_on_way(a, b, p));
    feet.min_by(|a, b| (a - p).norm().total_cmp(&(b - p).norm()))
}

/// The piece of a ring on which a place lies.
fn piece_at(ring: &Ring, p: Point2) -> Option<usize> {
    let off = |(a, b): (Point2, Point2)| (nearest_on_way(a, b, p) - p).norm();
    let all = pieces(&ring.points, true).map(off).enumerate();
    all.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(k, _)| k)
}
