//! Stock as a field of heights over the plan: what a cutter takes away of it, and where it is clear of it.
//!
//! Every cell keeps two heights: one above which its whole area is certainly free, and that in its middle, for
//! volumes. A cutter lowers the first by what it sweeps over the corner that is farthest from it, and is held off by the
//! corner that is nearest: what is told to be clear is clear.

use super::cutter::{Cutter, length};
use crate::geom::{Point2, Point3, Vec2, nearest_on_way};

/// Outline of a blank in plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Blank {
    /// Rectangle between two corners.
    Block {
        /// Lowest corner.
        low: Point2,
        /// Highest corner.
        high: Point2,
    },
    /// Disc about the origin.
    Disc {
        /// Radius, mm.
        radius: f64,
    },
}

impl Blank {
    /// Corners of the box about it.
    #[must_use]
    pub fn bounds(&self) -> (Point2, Point2) {
        match *self {
            Blank::Block { low, high } => (low, high),
            Blank::Disc { radius } => (Point2::new(-radius, -radius), Point2::new(radius, radius)),
        }
    }

    /// Distance of a point from the outline, mm: negative inside.
    #[must_use]
    pub fn distance(&self, p: Point2) -> f64 {
        match *self {
            Blank::Block { low, high } => {
                let beyond = [0, 1].map(|i| (low[i] - p[i]).max(p[i] - high[i]));
                let outside = crate::math::hypot(beyond[0].max(0.0), beyond[1].max(0.0));
                if outside > 0.0 { outside } else { beyond[0].max(beyond[1]) }
            }
            Blank::Disc { radius } => p.coords.norm() - radius,
        }
    }

    /// Unit vector to the nearest outside.
    #[must_use]
    pub fn outward(&self, p: Point2) -> crate::geom::Vec2 {
        match *self {
            Blank::Block { low, high } => {
                let ways = [
                    (low.x - p.x, [-1.0, 0.0]),
                    (p.x - high.x, [1.0, 0.0]),
                    (low.y - p.y, [0.0, -1.0]),
                    (p.y - high.y, [0.0, 1.0]),
                ];
                let best = ways.into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
                best.map_or_else(crate::geom::Vec2::zeros, |(_, [x, y])| crate::geom::Vec2::new(x, y))
            }
            Blank::Disc { .. } => {
                p.coords.try_normalize(1e-9).unwrap_or_else(|| crate::geom::Vec2::new(1.0, 0.0))
            }
        }
    }
}

/// A way whose height changes by less than this share of a cell is looked at as level.
const LEVEL: f64 = 0.1;
/// Cells at most.
const MOST_CELLS: f64 = 1e6;

/// Heights of the stock, cell by cell.
#[derive(Debug, Clone)]
pub struct HeightField {
    low: Point2,
    cell: f64,
    counts: [usize; 2],
    /// Top of the blank, and nothing is told to be lower than this, mm.
    top: f64,
    lowest: f64,
    /// Nothing of a cell's material is higher.
    upper: Vec<f64>,
    /// Height in the middle of the cell.
    middle: Vec<f64>,
}

impl HeightField {
    /// A blank up to `top`, in cells of about `finest` mm; of coarser ones where that are too many.
    #[must_use]
    pub fn new(blank: &Blank, top: f64, finest: f64) -> HeightField {
        let (low, high) = blank.bounds();
        let size = high - low;
        let cell = finest.max((size.x.max(0.0) * size.y.max(0.0) / MOST_CELLS).sqrt()).max(1e-3);
        let counts = [0, 1].map(|i| crate::math::ceil_to_usize(size[i] / cell).clamp(1, 1_000_000));
        let mut field =
            HeightField { low, cell, counts, top, lowest: top, upper: Vec::new(), middle: Vec::new() };
        let none = f64::NEG_INFINITY;
        for k in 0..counts[0] * counts[1] {
            let middle = field.centre(k / counts[1], k % counts[1]);
            let off = blank.distance(middle);
            field.upper.push(if off <= cell { top } else { none });
            field.middle.push(if off <= 0.0 { top } else { none });
        }
        field
    }

    /// Size of a cell, mm.
    #[must_use]
    pub fn cell(&self) -> f64 {
        self.cell
    }

    fn centre(&self, i: usize, j: usize) -> Point2 {
        let at = |k: usize| (crate::math::count(k) + 0.5) * self.cell;
        Point2::new(self.low.x + at(i), self.low.y + at(j))
    }

    /// Cells that a box may touch, as ranges of their index along an axis.
    fn range(&self, axis: usize, (low, high): (f64, f64)) -> core::ops::Range<usize> {
        // Floats saturate: what lies outside counts to the border.
        let index = |x: f64| ((x - self.low[axis]) / self.cell).floor().max(0.0) as usize;
        let first = index(low).min(self.counts[axis]);
        first..(index(high) + 1).min(self.counts[axis])
    }

    /// The cells near a straight way, each with its index and where its middle is.
    fn near(&self, (a, b): (Point2, Point2), radius: f64) -> impl Iterator<Item = (usize, Point2)> {
        let [first, second] =
            [0, 1].map(|i| self.range(i, (a[i].min(b[i]) - radius, a[i].max(b[i]) + radius)));
        let along = move |i: usize| second.clone().map(move |j| (i, j));
        first.flat_map(along).map(|(i, j)| (i * self.counts[1] + j, self.centre(i, j)))
    }

    /// How wide a cutter may be where it touches stock, mm, with its reference point nowhere lower than this.
    fn reach(&self, cutter: &Cutter, lowest: f64) -> f64 {
        cutter.radius_at((self.top - lowest).max(0.0))
    }

    /// The lowest height of the reference point of a cutter at this place that is certainly clear of all stock; minus
    /// infinity where there is none below.
    #[must_use]
    pub fn clear_height(&self, at: Point2, cutter: &Cutter) -> f64 {
        let nearest = |middle: Point2| {
            let [x, y] = [0, 1].map(|i| ((middle[i] - at[i]).abs() - 0.5 * self.cell).max(0.0));
            length(x, y)
        };
        self.held(at, cutter, (&self.upper, &nearest))
    }

    /// The same by the middles of the cells: an estimate, on the low side.
    #[must_use]
    pub fn likely_height(&self, at: Point2, cutter: &Cutter) -> f64 {
        self.held(at, cutter, (&self.middle, &|middle: Point2| (middle - at).norm()))
    }

    fn held(&self, at: Point2, cutter: &Cutter, (heights, beside): (&[f64], &dyn Fn(Point2) -> f64)) -> f64 {
        let radius = self.reach(cutter, self.lowest);
        let held = self.near((at, at), radius).filter_map(|(k, middle)| {
            let profile = cutter.profile(beside(middle))?;
            Some(heights.get(k)? - profile.height)
        });
        held.fold(f64::NEG_INFINITY, f64::max)
    }

    /// Takes away what a cutter on its straight way cuts, given by its reference point; the volume, mm³.
    pub fn cut(&mut self, from: Point3, to: Point3, cutter: &Cutter) -> f64 {
        let parts = self.parts((from, to), cutter);
        let mut volume = 0.0;
        for (a, b) in parts {
            // Straight up or down, all that counts is the lower end.
            let upright = a.xy() == b.xy();
            let (low, high) = (a.z.min(b.z), a.z.max(b.z));
            let (safe, likely) = if upright { (low, low) } else { (high, 0.5 * (low + high)) };
            volume += self.sink((a.xy(), b.xy()), (safe, likely), cutter);
        }
        volume
    }

    /// A way in parts that are nearly level, or upright.
    fn parts(
        &self,
        (from, to): (Point3, Point3),
        cutter: &Cutter,
    ) -> impl Iterator<Item = (Point3, Point3)> + use<> {
        let way = to - from;
        let fall = if way.xy() == Vec2::zeros() { 0.0 } else { way.z.abs() / (LEVEL * self.cell) };
        let size = way.xy().norm() / (4.0 * cutter.radius() + self.cell);
        let count = crate::math::ceil_to_usize(fall.max(size)).clamp(1, 1_000_000);
        let at = move |k: usize| from + way * (crate::math::count(k) / crate::math::count(count));
        (0..count).map(move |k| (at(k), at(k + 1)))
    }

    fn sink(&mut self, way: (Point2, Point2), (safe, likely): (f64, f64), cutter: &Cutter) -> f64 {
        let mut volume = 0.0;
        let half = 0.5 * self.cell;
        let cells: Vec<(usize, Point2)> = self.near(way, self.reach(cutter, likely)).collect();
        for (k, middle) in cells {
            let d = middle - nearest_on_way(way.0, way.1, middle);
            if let Some(profile) = cutter.profile(length(d.x, d.y)) {
                let height = likely + profile.height;
                if self.middle[k] > height {
                    volume += self.middle[k] - height;
                    self.middle[k] = height;
                }
            }
            let far = length(d.x.abs() + half, d.y.abs() + half);
            if let Some(profile) = cutter.profile(far) {
                self.upper[k] = self.upper[k].min(safe + profile.height);
                self.lowest = self.lowest.min(self.upper[k]);
            }
        }
        volume * self.cell * self.cell
    }

    /// The deepest that a cutter on its straight way goes into what may be stock, mm; not positive where it is certainly
    /// clear.
    #[must_use]
    pub fn depth(&self, from: Point3, to: Point3, cutter: &Cutter) -> f64 {
        if from.xy() == to.xy() {
            return self.clear_height(from.xy(), cutter) - from.z.min(to.z);
        }
        // No point of a cell is farther from its middle.
        let within = core::f64::consts::FRAC_1_SQRT_2 * self.cell;
        let mut deepest = f64::NEG_INFINITY;
        for (a, b) in self.parts((from, to), cutter) {
            let low = a.z.min(b.z);
            let way = (a.xy(), b.xy());
            for (k, middle) in self.near(way, self.reach(cutter, low) + within) {
                let d = middle - nearest_on_way(way.0, way.1, middle);
                if let Some(profile) = cutter.profile((length(d.x, d.y) - within).max(0.0)) {
                    deepest = deepest.max(self.upper[k] - profile.height - low);
                }
            }
        }
        deepest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BALL: f64 = 5.0;

    fn block() -> HeightField {
        let blank = Blank::Block { low: Point2::new(0.0, 0.0), high: Point2::new(40.0, 20.0) };
        HeightField::new(&blank, 0.0, 0.1)
    }

    /// Cutters of a radius of 5 or less, from sharp to round.
    fn cutters() -> [Cutter; 4] {
        let taper = Cutter::taper(2.0, 1.0, 1.0, 0.2);
        [Cutter::bull(BALL, 0.0), Cutter::bull(BALL, 1.0), Cutter::ball(BALL), taper]
    }

    /// Across the block's middle, with the tip at this height.
    fn across(cutter: &Cutter, z: f64) -> (Point3, Point3) {
        let at = |x: f64| cutter.reference(Point3::new(x, 10.0, z));
        (at(-10.0), at(50.0))
    }

    #[test]
    fn a_slot_takes_its_section_times_its_length() {
        for cutter in cutters() {
            let (from, to) = across(&cutter, -2.0);
            let volume = block().cut(from, to, &cutter);
            let whole = cutter.section(2.0) * 40.0;
            assert!((volume / whole - 1.0).abs() < 3e-3, "{cutter:?} {volume} {whole}");
        }
    }

    #[test]
    fn what_is_clear_of_the_stock_is_told_on_the_safe_side() {
        for cutter in cutters() {
            let mut field = block();
            let at = Point2::new(20.0, 10.0);
            assert!((field.clear_height(at, &cutter) - cutter.lift()).abs() < 1e-9);
            let (from, to) = across(&cutter, -2.0);
            field.cut(from, to, &cutter);
            // A little narrower, so that upright walls do not touch it.
            let (inner, _) = cutter.shrunk(0.2).expect("a cutter");
            let height = field.clear_height(at, &inner) - inner.lift();
            assert!((-2.2..-1.0).contains(&height), "{cutter:?} {height}");
            assert!((field.likely_height(at, &inner) - field.clear_height(at, &inner)).abs() < 1.0);
            let over = |z: f64| {
                let (from, to) = across(&inner, z);
                field.depth(from, to, &inner)
            };
            assert!(over(-0.5) <= 0.0 && over(-2.3) > 0.1, "{cutter:?} {} {}", over(-0.5), over(-2.3));
            assert!(field.clear_height(Point2::new(-5.2, 10.0), &cutter) < cutter.lift() - 0.9);
        }
        assert_eq!(block().clear_height(Point2::new(-5.2, 10.0), &Cutter::ball(BALL)), f64::NEG_INFINITY);
    }

    #[test]
    fn a_way_down_takes_what_its_end_takes() {
        for cutter in cutters() {
            let (mut slow, mut fast) = (block(), block());
            let at = |z: f64| cutter.reference(Point3::new(20.0, 10.0, z));
            let down = slow.cut(at(3.0), at(-2.0), &cutter);
            assert!((fast.cut(at(-2.0), at(-2.0), &cutter) - down).abs() < 1e-9);
            // A ramp takes about the mean of level ways.
            let ramp = |field: &mut HeightField, a: f64, b: f64| {
                let p = |x: f64, z: f64| cutter.reference(Point3::new(x, 10.0, z));
                field.cut(p(-10.0, a), p(50.0, b), &cutter)
            };
            let (sloped, level) = (ramp(&mut block(), -1.5, -2.5), ramp(&mut block(), -2.0, -2.0));
            assert!((sloped / level - 1.0).abs() < 0.05, "{cutter:?} {sloped} {level}");
        }
    }

    #[test]
    fn a_disc_ends_at_its_radius() {
        let blank = Blank::Disc { radius: 10.0 };
        assert!(blank.distance(Point2::new(3.0, 4.0)) == -5.0);
        let field = HeightField::new(&blank, 0.0, 0.1);
        let ball = Cutter::ball(1.0);
        assert!(field.clear_height(Point2::new(8.5, 8.5), &ball) == f64::NEG_INFINITY);
        assert!(field.clear_height(Point2::new(7.0, 7.0), &ball) > 0.9);
    }
}
