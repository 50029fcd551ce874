//! A net as one grid of poles, as CAD files want it.

use super::net::Net;
use crate::geom::Point3;
use crate::math::count;

/// All poles of a net: (p m + 1) × (q n + 1) of m × n patches of degree (p, q), row by row; shared ones stand once.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// Degrees in u and v.
    pub degree: [usize; 2],
    /// Patches in u and v.
    pub size: [usize; 2],
    /// Rows and columns of poles.
    pub counts: [usize; 2],
    /// Poles, mm.
    pub poles: Vec<Point3>,
    /// Their weights, where they differ.
    pub weights: Option<Vec<f64>>,
}

impl Grid {
    /// The grid of a net.
    #[must_use]
    pub fn of(net: &Net) -> Grid {
        let size = net.size();
        let degree = net.patches().first().map_or([1, 1], super::Patch::degree);
        let counts = [degree[0] * size[0] + 1, degree[1] * size[1] + 1];
        let scales = scales(net, degree);
        let mut poles = Vec::with_capacity(counts[0] * counts[1]);
        let mut weights = Vec::with_capacity(counts[0] * counts[1]);
        for row in 0..counts[0] {
            let (i, a) = within(row, degree[0], size[0]);
            for column in 0..counts[1] {
                let (j, b) = within(column, degree[1], size[1]);
                let k = i * size[1] + j;
                poles.push(net.patches()[k].pole(a, b));
                weights.push(net.patches()[k].weight(a, b) * scales[k]);
            }
        }
        let rational = net.patches().iter().any(super::Patch::is_rational);
        Grid { degree, size, counts, poles, weights: rational.then_some(weights) }
    }
    /// The knots of an axis and their multiplicities: one unit for each patch.
    #[must_use]
    pub fn knots(&self, axis: usize) -> (Vec<f64>, Vec<usize>) {
        let spans = self.size[axis];
        let inner = |k: usize| k > 0 && k < spans;
        let multiplicity = |k: usize| self.degree[axis] + usize::from(!inner(k));
        ((0..=spans).map(count).collect(), (0..=spans).map(multiplicity).collect())
    }
    /// Poles along a side: axis 0 runs in u at the first or last column, axis 1 in v at the first or last row; as
    /// indices into the poles.
    #[must_use]
    pub fn side(&self, axis: usize, last: bool) -> Vec<usize> {
        let [rows, columns] = self.counts;
        match axis {
            0 => (0..rows).map(|i| i * columns + if last { columns - 1 } else { 0 }).collect(),
            _ => (0..columns).map(|j| if last { (rows - 1) * columns } else { 0 } + j).collect(),
        }
    }
}

/// The patch, and the pole in it, of a row of poles; shared rows belong to the later patch, as in [`Net::place`].
fn within(row: usize, degree: usize, patches: usize) -> (usize, usize) {
    let patch = (row / degree).min(patches - 1);
    (patch, row - patch * degree)
}

/// What the weights of each patch are multiplied by, so that shared poles have one weight: a patch of equal weights
/// is kept with weights of 1, whatever its neighbours have.
fn scales(net: &Net, degree: [usize; 2]) -> Vec<f64> {
    let [rows, columns] = net.size();
    let patches = net.patches();
    let mut scales: Vec<f64> = Vec::with_capacity(rows * columns);
    for k in 0..rows * columns {
        let before = match (k / columns, k % columns) {
            (0, 0) => None,
            (_, 0) => Some((k - columns, degree[0], 0)),
            _ => Some((k - 1, 0, degree[1])),
        };
        let scale = before.map_or(1.0, |(b, i, j)| {
            let (own, other) = (patches[k].weight(0, 0), patches[b].weight(i, j) * scales[b]);
            if own == other { 1.0 } else { other / own }
        });
        scales.push(scale);
    }
    scales
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_has_the_poles_and_weights_that_made_the_net() {
        let place = |k: usize| (count(k / 7), count(k % 7));
        let poles: Vec<Point3> =
            (0..49).map(place).map(|(x, y)| Point3::new(x, y, (3.0 * x + y) % 4.0)).collect();
        let plain = Grid::of(&Net::new(7, 7, &poles, None).expect("a net"));
        assert_eq!((plain.counts, &plain.poles, &plain.weights), ([7, 7], &poles, &None));
        assert_eq!(plain.knots(0), (vec![0.0, 1.0, 2.0], vec![4, 3, 4]));
        assert_eq!(plain.side(0, true), (0..7).map(|i| 7 * i + 6).collect::<Vec<_>>());
        assert_eq!(plain.side(1, true), (42..49).collect::<Vec<_>>());
        // The first patch has equal weights of 2, the others do not.
        let weights: Vec<f64> = (0..49).map(|k| if k / 7 <= 3 && k % 7 <= 3 { 2.0 } else { 3.0 }).collect();
        let grid = Grid::of(&Net::new(7, 7, &poles, Some(&weights)).expect("a net"));
        let ratio = weights[0] / grid.weights.as_ref().expect("weights")[0];
        assert!(grid.weights.iter().flatten().zip(&weights).all(|(a, b)| (a * ratio - b).abs() < 1e-12));
    }
}
