//! Some points of a surface, the highest of each cell: enough to tell at most places that a cutter cannot be there.

use super::{Cutter, Patch, SurfaceTree};
use crate::geom::{Point2, Point3};
use crate::math::{ceil_to_usize, count};

/// Cells, and points of a patch along an axis, at most.
const MOST: (f64, usize) = (1e5, 256);

/// Points of a surface.
#[derive(Debug)]
pub struct Peaks {
    low: Point2,
    cell: f64,
    counts: [usize; 2],
    highest: Vec<Option<Point3>>,
}

impl Peaks {
    /// `cell`: size of the cells, mm; each has a point where the surface is not much steeper than upright.
    #[must_use]
    pub fn new(tree: &SurfaceTree, cell: f64) -> Peaks {
        let (low, high) = tree.bounds();
        let size = (high - low).xy();
        let cell = cell.max((size.x * size.y / MOST.0).sqrt()).max(size.max() / MOST.0).max(1e-3);
        let counts = [0, 1].map(|i| ceil_to_usize(size[i] / cell).max(1));
        let mut peaks = Peaks { low: low.xy(), cell, counts, highest: vec![None; counts[0] * counts[1]] };
        for patch in tree.net().patches() {
            let [rows, columns] = spacing(patch, 0.5 * cell);
            for (i, j) in (0..=rows).flat_map(|i| (0..=columns).map(move |j| (i, j))) {
                peaks.add(patch.point(count(i) / count(rows), count(j) / count(columns)));
            }
        }
        peaks
    }

    fn add(&mut self, p: Point3) {
        let [i, j] = [0, 1].map(|axis| self.index(p[axis], axis));
        let cell = &mut self.highest[i * self.counts[1] + j];
        if cell.is_none_or(|q| q.z < p.z) {
            *cell = Some(p);
        }
    }

    /// Floats saturate: what lies outside counts to the border.
    fn index(&self, x: f64, axis: usize) -> usize {
        (((x - self.low[axis]) / self.cell).max(0.0) as usize).min(self.counts[axis] - 1)
    }

    /// Whether a cutter with its reference point here, endless upwards, certainly has a point of the surface in it.
    #[must_use]
    pub fn reach_into(&self, cutter: &Cutter, reference: Point3) -> bool {
        let end = reference.z - cutter.corner();
        let [columns, rows] = [0, 1].map(|axis| {
            let around = cutter.radius();
            self.index(reference[axis] - around, axis)..=self.index(reference[axis] + around, axis)
        });
        let cells = columns.flat_map(|i| rows.clone().map(move |j| i * self.counts[1] + j));
        cells.filter_map(|k| self.highest[k]).any(|p| {
            let depth = p.z - end;
            depth > 0.0 && (p - reference).xy().norm() < cutter.half_width(depth) - 1e-6
        })
    }
}

/// Steps along the axes of a patch that are no longer than this in plan, mm.
fn spacing(patch: &Patch, longest: f64) -> [usize; 2] {
    let [m, n] = patch.degree();
    let poles = |(i, j): (usize, usize)| patch.pole(i, j).xy();
    let along_u = (0..=n).map(|j| (0..m).map(|i| (poles((i + 1, j)) - poles((i, j))).norm()).sum());
    let along_v = (0..=m).map(|i| (0..n).map(|j| (poles((i, j + 1)) - poles((i, j))).norm()).sum());
    let steps = |length: f64| ceil_to_usize(length / longest).clamp(1, MOST.1);
    [steps(along_u.fold(0.0, f64::max)), steps(along_v.fold(0.0, f64::max))]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::surface::Net;

    /// A roof, 40 x 30 mm: its ridge at Y 15 is 10 mm high.
    fn roof() -> SurfaceTree {
        let poles: Vec<Point3> = [0.0, 40.0]
            .into_iter()
            .flat_map(|x| [(0.0, 0.0), (15.0, 20.0), (30.0, 0.0)].map(|(y, z)| Point3::new(x, y, z)))
            .collect();
        SurfaceTree::new(Net::new(2, 3, &poles, None).expect("a net"), 8.0)
    }

    #[test]
    fn what_is_told_is_true_and_nearly_all_is_told() {
        let tree = roof();
        let peaks = Peaks::new(&tree, 1.0);
        for cutter in
            [Cutter::ball(4.0), Cutter::bull(5.0, 1.0).grown(0.3), Cutter::taper(2.0, 1.0, 1.0, 0.2)]
        {
            let (mut told, mut all) = (0, 0);
            for n in 0..400 {
                let (x, y, z) = (count(n % 20) * 2.0 + 1.0, count(n / 20) * 1.5 + 0.7, 0.03 * count(n));
                let Some(contact) = cutter.drop(&tree, x, y, None) else { continue };
                let within = peaks.reach_into(&cutter, Point3::new(x, y, z));
                assert!(!within || contact.centre.z > z, "({x}, {y}, {z}) {cutter:?}");
                told += u32::from(within);
                all += u32::from(contact.centre.z > z);
            }
            assert!(all > 100 && told * 10 > all * 9, "{told} of {all} {cutter:?}");
        }
    }
}
