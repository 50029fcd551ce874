//! Stock as a field of heights over the plan: what a ball takes away of it, and where it is clear of it.
//!
//! Every cell keeps two heights: one above which its whole area is certainly free, and that in its middle, for
//! volumes. A ball lowers the first by what it sweeps over the corner that is farthest from it, and is held off by the
//! corner that is nearest: what is told to be clear is clear.

use crate::geom::{Point2, Point3};

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

/// Cells at most.
const MOST_CELLS: f64 = 1e6;

/// Heights of the stock, cell by cell.
#[derive(Debug, Clone)]
pub struct HeightField {
    low: Point2,
    cell: f64,
    counts: [usize; 2],
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
        let mut field = HeightField { low, cell, counts, upper: Vec::new(), middle: Vec::new() };
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

    /// Cells that a disc may touch, as ranges of both indices.
    fn range(&self, axis: usize, at: f64, radius: f64) -> core::ops::Range<usize> {
        // Floats saturate: what lies outside counts to the border.
        let index = |x: f64| ((x - self.low[axis]) / self.cell).floor().max(0.0) as usize;
        let first = index(at - radius).min(self.counts[axis]);
        first..(index(at + radius) + 1).min(self.counts[axis])
    }

    /// The lowest height of the centre of a ball at this place that is certainly clear of all stock; minus infinity
    /// where there is none below.
    #[must_use]
    pub fn clear_height(&self, at: Point2, radius: f64) -> f64 {
        let mut height = f64::NEG_INFINITY;
        for i in self.range(0, at.x, radius) {
            for j in self.range(1, at.y, radius) {
                let d = self.centre(i, j) - at;
                let near = [d.x, d.y].map(|v| (v.abs() - 0.5 * self.cell).max(0.0));
                let rest = radius * radius - near[0] * near[0] - near[1] * near[1];
                if rest > 0.0 {
                    height = height.max(self.upper[i * self.counts[1] + j] + rest.sqrt());
                }
            }
        }
        height
    }

    /// The same by the middles of the cells: an estimate, on the low side.
    #[must_use]
    pub fn likely_height(&self, at: Point2, radius: f64) -> f64 {
        let mut height = f64::NEG_INFINITY;
        for i in self.range(0, at.x, radius) {
            for j in self.range(1, at.y, radius) {
                let rest = radius * radius - (self.centre(i, j) - at).norm_squared();
                if rest > 0.0 {
                    height = height.max(self.middle[i * self.counts[1] + j] + rest.sqrt());
                }
            }
        }
        height
    }

    /// Takes away what a ball on its straight way cuts; the volume, mm³.
    pub fn cut(&mut self, from: Point3, to: Point3, radius: f64) -> f64 {
        let parts = crate::math::ceil_to_usize((to - from).norm() / self.cell).clamp(1, 1_000_000);
        let mut volume = 0.0;
        for k in 0..=parts {
            volume +=
                self.sink(from + (to - from) * (crate::math::count(k) / crate::math::count(parts)), radius);
        }
        volume
    }

    fn sink(&mut self, centre: Point3, radius: f64) -> f64 {
        let square = radius * radius;
        let mut volume = 0.0;
        for i in self.range(0, centre.x, radius) {
            for j in self.range(1, centre.y, radius) {
                let d = self.centre(i, j) - centre.xy();
                let k = i * self.counts[1] + j;
                let rest = square - d.norm_squared();
                if rest > 0.0 && self.middle[k] > centre.z - rest.sqrt() {
                    let height = centre.z - rest.sqrt();
                    volume += self.middle[k] - height;
                    self.middle[k] = height;
                }
                let far = [d.x, d.y].map(|v| v.abs() + 0.5 * self.cell);
                let rest = square - far[0] * far[0] - far[1] * far[1];
                if rest > 0.0 {
                    self.upper[k] = self.upper[k].min(centre.z - rest.sqrt());
                }
            }
        }
        volume * self.cell * self.cell
    }

    /// The deepest that a ball on its straight way goes into what may be stock, mm; not positive where it is certainly
    /// clear.
    #[must_use]
    pub fn depth(&self, from: Point3, to: Point3, radius: f64) -> f64 {
        // Between two looks the ball is inside a larger one.
        let parts = crate::math::ceil_to_usize(4.0 * (to - from).norm() / self.cell).clamp(1, 1_000_000);
        let larger = radius + 0.125 * self.cell;
        let depth = |k: usize| {
            let p = from + (to - from) * (crate::math::count(k) / crate::math::count(parts));
            self.clear_height(p.xy(), larger) - p.z
        };
        (0..=parts).map(depth).fold(f64::NEG_INFINITY, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block() -> HeightField {
        let blank = Blank::Block { low: Point2::new(0.0, 0.0), high: Point2::new(40.0, 20.0) };
        HeightField::new(&blank, 0.0, 0.1)
    }

    #[test]
    fn a_slot_takes_its_section_times_its_length() {
        let (radius, depth) = (5.0_f64, 2.0_f64);
        let section = radius * radius * crate::math::acos(1.0 - depth / radius)
            - (radius - depth) * (2.0 * radius * depth - depth * depth).sqrt();
        let z = radius - depth;
        let volume = block().cut(Point3::new(-10.0, 10.0, z), Point3::new(50.0, 10.0, z), radius);
        assert!((volume / (section * 40.0) - 1.0).abs() < 2e-3, "{volume} {}", section * 40.0);
    }

    #[test]
    fn what_is_clear_of_the_stock_is_told_on_the_safe_side() {
        let mut field = block();
        let at = Point2::new(20.0, 10.0);
        assert!((field.clear_height(at, 5.0) - 5.0).abs() < 1e-9);
        field.cut(Point3::new(-10.0, 10.0, 3.0), Point3::new(50.0, 10.0, 3.0), 5.0);
        let height = field.clear_height(at, 5.0);
        assert!((3.0..3.6).contains(&height), "{height}");
        let over = |z: f64| field.depth(Point3::new(0.0, 10.0, z), Point3::new(40.0, 10.0, z), 5.0);
        assert!(over(3.7) <= 0.0 && over(2.9) > 0.1);
        assert!(field.clear_height(Point2::new(-5.2, 10.0), 5.0) == f64::NEG_INFINITY);
    }

    #[test]
    fn a_disc_ends_at_its_radius() {
        let blank = Blank::Disc { radius: 10.0 };
        assert!(blank.distance(Point2::new(3.0, 4.0)) == -5.0);
        let field = HeightField::new(&blank, 0.0, 0.1);
        assert!(field.clear_height(Point2::new(8.5, 8.5), 1.0) == f64::NEG_INFINITY);
        assert!(field.clear_height(Point2::new(7.0, 7.0), 1.0) > 0.9);
    }
}
