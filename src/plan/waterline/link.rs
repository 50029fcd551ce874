//! How the cutter comes from one cut to the next: down at the level where that is free, low over what stands, or over all of it.
//!
//! Rapids need not run straight on every control: of two axes one may come first. A low way is free wherever they run, then: it
//! runs along one axis, or all of the rectangle about it is free.

use super::ground::Hints;
use super::path::{Move, Path, over};
use super::slice::Slice;
use crate::geom::Point2;
use crate::geom::surface::Cutter;
use crate::math::{ceil_to_usize, count};

/// A rapid stops so far above the stock, mm.
const GAP: f64 = 0.5;
/// A rapid runs so far above what stands below its way, mm.
const SKIM: f64 = 0.2;
/// The cutter is looked at larger by this share of the stock's cells.
const LARGER: f64 = 0.25;
/// Places at which the surface is looked at along a way: so many in the grid's step.
const PLACES: f64 = 4.0;

/// A way across at one height.
struct Across {
    places: Vec<Point2>,
    height: f64,
    /// How far it is, up and down included, mm.
    length: f64,
}

impl Path<'_> {
    /// Up, if the tip is down.
    pub(super) fn lift(&mut self) {
        if let Some(p) = self.at.take() {
            self.moves.push(Move::Rapid(over(p.xy(), self.manner.safe)));
        }
    }

    /// To a place that is clear of material at a height, and down.
    pub(super) fn descend(&mut self, to: Point2, z: f64) {
        let safe = self.manner.safe;
        let from = match self.low_way(to, z) {
            Some(way) => {
                if self.at.is_some_and(|p| way.height > p.z) {
                    self.moves.extend(self.at.map(|p| Move::Rapid(over(p.xy(), way.height))));
                }
                self.moves.extend(way.places.iter().map(|p| Move::Rapid(over(*p, way.height))));
                way.height
            }
            None => {
                self.lift();
                self.moves.push(Move::Rapid(over(to, safe)));
                safe
            }
        };
        let height = self.top_at(to).map_or(z, |top| (top + GAP).max(z)).min(from);
        if height < from {
            self.moves.push(Move::Rapid(over(to, height)));
        }
        self.at = Some(over(to, height));
        if height > z {
            self.tally.links += height - z;
            self.line(over(to, z));
        }
    }

    /// The shortest way across below the height of rapids: straight, or along one axis and then along the other.
    fn low_way(&self, to: Point2, z: f64) -> Option<Across> {
        let from = self.at?;
        let low = from.z.max(z);
        let corners = [None, Some(Point2::new(to.x, from.y)), Some(Point2::new(from.x, to.y))];
        let ways = corners.into_iter().filter_map(|corner| {
            let places: Vec<Point2> = corner.into_iter().chain([to]).collect();
            let mut at = from.xy();
            let (mut height, mut length) = (low, 0.0);
            for p in &places {
                height = self.height_over((at, *p), height)?;
                length += (p - at).norm();
                at = *p;
            }
            Some(Across { places, height, length: length + 2.0 * (height - low) })
        });
        let best = ways.min_by(|a, b| a.length.total_cmp(&b.length))?;
        (best.height < self.manner.safe - GAP).then_some(best)
    }

    /// Height at which all of the rectangle between two places is free, not below `low`; `None` where none is known.
    fn height_over(&self, (a, b): (Point2, Point2), low: f64) -> Option<f64> {
        let d = b - a;
        let across = usize::from(d.x.abs() > d.y.abs());
        let lines = ceil_to_usize(d[across].abs() / self.stock.cell());
        let cutter = self.larger();
        let mut height = low;
        for k in 0..=lines {
            let share = if lines == 0 { 0.0 } else { count(k) / count(lines) };
            let (mut from, mut to) = (a, b);
            from[across] = a[across] + d[across] * share;
            to[across] = from[across];
            let walls = self.walls_along((from, to), low);
            let ends = [from, to].map(|p| cutter.reference(over(p, low)));
            let depth = self.stock.depth(ends[0], ends[1], &cutter);
            height = height.max(walls).max(if depth > 0.0 { low + depth + SKIM } else { low });
            if height >= self.manner.safe {
                return None;
            }
        }
        Some(height)
    }

    /// Height at which the tip is free of the surface along a way, not below `low`.
    fn walls_along(&self, (from, to): (Point2, Point2), low: f64) -> f64 {
        let parts = ceil_to_usize((to - from).norm() * PLACES / self.ground.grid.step).max(1);
        let mut hints = Hints::default();
        let free = |k: usize| {
            let p = from + (to - from) * (count(k) / count(parts));
            self.ground.free_height(p, low, &mut hints)
        };
        (0..=parts).map(free).fold(low, f64::max)
    }

    /// Whether the tip may run straight between two places.
    pub(super) fn free(&self, (from, to): (Point2, Point2), z: f64) -> bool {
        let parts = ceil_to_usize((to - from).norm() / (0.5 * self.ground.grid.step)).max(1);
        let mut hints = Hints::default();
        (1..=parts).all(|k| {
            let p = from + (to - from) * (count(k) / count(parts));
            self.ground.value(p, z, &mut hints) <= 0.0
        })
    }

    /// Whether a straight way keeps out of the walls.
    pub(super) fn stays(&self, slice: &Slice, (from, to): (Point2, Point2)) -> bool {
        let length = (to - from).norm();
        let parts = ceil_to_usize(length / (0.5 * self.ground.grid.step)).max(1);
        length <= 3.0 * self.manner.width
            && (0..parts).all(|k| {
                let p = from + (to - from) * (count(k) / count(parts));
                slice.room_at(&self.ground.grid, p) >= -0.02 * self.ground.grid.step
            })
            && self.free((from, from + (to - from) * 0.95), slice.z)
    }

    /// The cutter a little larger: the control rounds.
    fn larger(&self) -> Cutter {
        self.cutter().grown(LARGER * self.stock.cell())
    }

    /// Height of the tip at which the cutter touches the stock.
    pub(super) fn top_at(&self, p: Point2) -> Option<f64> {
        let cutter = self.larger();
        let height = self.stock.clear_height(p, &cutter);
        height.is_finite().then_some(height - cutter.lift())
    }
}
