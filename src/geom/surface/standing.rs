//! Material that no move of a level comes near: islands that stand as high as the level is deep.
//!
//! A cutter at one height clears, up to the level's depth over its tip, every place that is nearer to its path than half its
//! width at that depth. What is asked here is which places, over which the tip may stand at this height, are farther from all of it.
//! A cell whose middle is nearer than that by half its diagonal is clear whole; other cells are told by 64 parts, so that
//! an area is known to a part's size. Only a region narrower than a cell may be overlooked.

use super::heights::Blank;
use super::peaks::Peaks;
use super::{Contact, Cutter, SurfaceTree};
use crate::geom::{Point2, Point3, nearest_on_way};
use crate::math::{ceil_to_usize, count};

/// Cells at most.
const MOST_CELLS: f64 = 4e5;
/// Parts of a cell along an axis.
const PARTS: usize = 8;
/// Cells of the points that tell at most places that the tip may not be there, as a share of the radius.
const PEAKS: f64 = 0.2;
/// Radius of the ball that tells whether a place lies over the surface, mm.
const NEEDLE: f64 = 1e-3;

/// What stands together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Island {
    /// Its area in plan, mm²: as far as the tip may stand over it.
    pub area: f64,
    /// The place in it that is farthest from the path.
    pub place: Point2,
    /// How far that is, mm.
    pub off: f64,
}

/// A blank over a surface, in cells.
#[derive(Debug)]
pub struct Standing<'a> {
    tree: &'a SurfaceTree,
    /// The cutter, and the same with what it leaves about it.
    cutters: (Cutter, Cutter),
    blank: Blank,
    low: Point2,
    cell: f64,
    counts: [usize; 2],
    peaks: Peaks,
    /// Lowest height of the tip over the middle of each cell, where it has been asked for.
    tips: Vec<Option<f64>>,
    hint: Option<Contact>,
}

impl<'a> Standing<'a> {
    /// `leave`: what the cutter leaves on the surface, mm; `cell`: size of the cells, mm.
    #[must_use]
    pub fn new(tree: &'a SurfaceTree, (cutter, leave): (Cutter, f64), blank: Blank, cell: f64) -> Self {
        let ((low, high), (a, b)) = (blank.bounds(), tree.bounds());
        let (low, high) = (low.sup(&a.xy()), high.inf(&b.xy()));
        let size = (high - low).map(|x| x.max(0.0));
        let cell = cell.max((size.x * size.y / MOST_CELLS).sqrt()).max(1e-3);
        let counts = [0, 1].map(|i| ceil_to_usize(size[i] / cell).min(1_000_000));
        let tips = vec![None; counts[0] * counts[1]];
        let peaks = Peaks::new(tree, PEAKS * cutter.radius());
        let cutters = (cutter, cutter.grown(leave));
        Standing { tree, cutters, blank, low, cell, counts, peaks, tips, hint: None }
    }

    /// What stands after the tip has gone along these ways at height `z`, farther from them than `reach`: the largest first.
    #[must_use]
    pub fn after(&mut self, z: f64, ways: &[(Point2, Point2)], reach: f64) -> Vec<Island> {
        let off = self.distances(ways, reach);
        let half = core::f64::consts::FRAC_1_SQRT_2 * self.cell;
        let mut areas = vec![(0.0, self.low, 0.0); off.len()];
        for k in (0..off.len()).filter(|k| off[*k] > reach - half) {
            // Beside the cells that the tip may not stand over nothing is asked for; over those far below the level it may everywhere.
            if self.may_stand(k, z) {
                let whole = off[k] > reach + half && self.may_stand(k, z - self.cell);
                areas[k] = if whole { self.whole(k, ways) } else { self.parts(k, z, (ways, reach)) };
            }
        }
        self.islands(&areas)
    }

    fn middle(&self, k: usize) -> Point2 {
        let [i, j] = [k / self.counts[1], k % self.counts[1]].map(|i| (count(i) + 0.5) * self.cell);
        Point2::new(self.low.x + i, self.low.y + j)
    }

    /// Distance of the middles of the cells from the ways, mm; infinite where it is more than a little over `reach`.
    fn distances(&self, ways: &[(Point2, Point2)], reach: f64) -> Vec<f64> {
        let mut off = vec![f64::INFINITY; self.tips.len()];
        let wide = reach + 2.0 * self.cell;
        for (a, b) in ways {
            let [columns, rows] = [0, 1].map(|i| {
                // Floats saturate: what lies outside counts to the border.
                let index = |x: f64| ((x - self.low[i]) / self.cell).floor().max(0.0) as usize;
                let first = index(a[i].min(b[i]) - wide).min(self.counts[i]);
                first..(index(a[i].max(b[i]) + wide) + 1).min(self.counts[i])
            });
            for k in columns.flat_map(|i| rows.clone().map(move |j| i * self.counts[1] + j)) {
                let p = self.middle(k);
                off[k] = off[k].min((p - nearest_on_way(*a, *b, p)).norm());
            }
        }
        off
    }

    fn may_stand(&mut self, k: usize, z: f64) -> bool {
        let p = self.middle(k);
        match self.tips[k] {
            Some(tip) => tip <= z,
            None if self.may_not(p, z) => false,
            None => {
                let tip = self.tip(p);
                self.tips[k] = Some(tip);
                tip <= z
            }
        }
    }

    /// Whether the tip may certainly not be at this height here.
    fn may_not(&self, p: Point2, z: f64) -> bool {
        let (cutter, hull) = self.cutters;
        self.blank.distance(p) > 0.0 || self.peaks.reach_into(&hull, Point3::new(p.x, p.y, z + cutter.lift()))
    }

    /// Lowest height of the tip; infinite beside the surface or the blank.
    fn tip(&mut self, p: Point2) -> f64 {
        if Cutter::ball(NEEDLE).drop(self.tree, p.x, p.y, None).is_none() {
            return f64::INFINITY;
        }
        let (cutter, hull) = self.cutters;
        self.hint = hull.drop(self.tree, p.x, p.y, self.hint.as_ref());
        self.hint.map_or(f64::INFINITY, |c| c.centre.z - cutter.lift())
    }

    /// Area of a cell, with its middle and how far that is from the ways.
    fn whole(&self, k: usize, ways: &[(Point2, Point2)]) -> (f64, Point2, f64) {
        let p = self.middle(k);
        (self.cell * self.cell, p, from_ways(ways, p))
    }

    /// The same of the parts of a cell that are farther than `reach`.
    fn parts(&mut self, k: usize, z: f64, (ways, reach): (&[(Point2, Point2)], f64)) -> (f64, Point2, f64) {
        let middle = self.middle(k);
        let size = self.cell / count(PARTS);
        let near: Vec<(Point2, Point2)> = ways
            .iter()
            .filter(|(a, b)| (middle - nearest_on_way(*a, *b, middle)).norm() <= reach + 2.0 * self.cell)
            .copied()
            .collect();
        let mut found = (0.0, middle, 0.0);
        for n in 0..PARTS * PARTS {
            let [x, y] = [n / PARTS, n % PARTS].map(|i| (count(i) + 0.5) * size - 0.5 * self.cell);
            let p = Point2::new(middle.x + x, middle.y + y);
            let off = from_ways(&near, p);
            if off > reach && !self.may_not(p, z) && self.tip(p) <= z {
                found.0 += size * size;
                if off > found.2 {
                    (found.1, found.2) = (p, off);
                }
            }
        }
        found
    }

    /// Cells side by side, taken together.
    fn islands(&self, areas: &[(f64, Point2, f64)]) -> Vec<Island> {
        let mut seen = vec![false; areas.len()];
        let mut islands = Vec::new();
        for seed in 0..areas.len() {
            if seen[seed] || areas[seed].0 <= 0.0 {
                continue;
            }
            seen[seed] = true;
            let mut island = Island { area: 0.0, place: areas[seed].1, off: 0.0 };
            let mut stack = vec![seed];
            while let Some(k) = stack.pop() {
                let (area, place, off) = areas[k];
                island.area += area;
                if off > island.off {
                    (island.place, island.off) = (place, off);
                }
                for next in self.around(k).filter(|n| areas[*n].0 > 0.0) {
                    if !seen[next] {
                        seen[next] = true;
                        stack.push(next);
                    }
                }
            }
            islands.push(island);
        }
        islands.sort_by(|a, b| b.area.total_cmp(&a.area));
        islands
    }

    /// The cells beside a cell and at its corners.
    fn around(&self, k: usize) -> impl Iterator<Item = usize> + use<> {
        let [columns, rows] = self.counts;
        let (i, j) = (k / rows, k % rows);
        let from_to = |i: usize, most: usize| i.saturating_sub(1)..(i + 2).min(most);
        let own = from_to(j, rows);
        from_to(i, columns).flat_map(move |i| own.clone().map(move |j| i * rows + j))
    }
}

/// Distance of a place from the nearest of some ways, mm; a large one where there are none.
fn from_ways(ways: &[(Point2, Point2)], p: Point2) -> f64 {
    let off = ways.iter().map(|(a, b)| (p - nearest_on_way(*a, *b, p)).norm());
    off.fold(f64::MAX, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Point3;
    use crate::geom::surface::Net;

    /// A plane of 40 x 30 mm at Z 0.
    fn plane() -> SurfaceTree {
        let poles = [[0.0, 0.0], [0.0, 30.0], [40.0, 0.0], [40.0, 30.0]].map(|[x, y]| Point3::new(x, y, 0.0));
        SurfaceTree::new(Net::new(2, 2, &poles, None).expect("a net"), 8.0)
    }

    const BLANK: Blank = Blank::Block { low: Point2::new(-5.0, -5.0), high: Point2::new(45.0, 35.0) };

    fn way(x: f64) -> (Point2, Point2) {
        (Point2::new(x, -10.0), Point2::new(x, 40.0))
    }

    #[test]
    fn a_strip_between_two_ways_has_its_area() {
        let tree = plane();
        let mut standing = Standing::new(&tree, (Cutter::bull(5.0, 0.0), 0.5), BLANK, 0.5);
        let found = standing.after(1.0, &[way(5.0), way(15.0), way(26.0), way(36.0)], 5.0);
        assert_eq!(found.len(), 1, "{found:?}");
        // 20 to 21 over the whole length of the net.
        assert!((found[0].area - 30.0).abs() < 0.5 && (found[0].off - 5.5).abs() < 0.05, "{found:?}");
        assert!((found[0].place.x - 20.5).abs() < 0.05);
        assert!(standing.after(1.0, &[way(5.0), way(15.0), way(25.0), way(35.0)], 5.001).is_empty());
    }

    #[test]
    fn where_the_tip_may_not_stand_nothing_is_asked() {
        let tree = plane();
        let mut standing = Standing::new(&tree, (Cutter::ball(5.0), 0.5), BLANK, 0.5);
        assert!(standing.after(0.4, &[], 5.0).is_empty());
        let found = standing.after(0.6, &[], 5.0);
        assert!(found.len() == 1 && (found[0].area - 1200.0).abs() < 1.0, "{found:?}");
    }
}
