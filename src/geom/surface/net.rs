//! A net of Bezier patches of one degree (p, q): `(p m + 1) × (q n + 1)` poles are m × n patches.
//!
//! Where nothing tells the degree, `(3m+1) × (3n+1)` poles are m × n bicubic patches, other counts one patch.

use super::patch::{MAX_DEGREE, Patch, SurfaceJet};
use crate::geom::Point3;
use crate::units::Angle;

/// What is wrong with a net, with the place.
#[derive(Debug, Clone, PartialEq)]
pub enum NetIssue {
    /// Fewer than two rows or columns, or a degree above the largest.
    Size {
        /// Rows.
        rows: usize,
        /// Columns.
        columns: usize,
    },
    /// The number of poles is not rows times columns.
    Count {
        /// Poles wanted.
        wanted: usize,
        /// Poles given.
        given: usize,
    },
    /// A coordinate or weight that is not finite, or a weight that is not positive.
    NotFinite,
    /// Weights that differ by more than a factor of [`MOST_UNEVEN`].
    Uneven {
        /// Smallest weight.
        least: f64,
        /// Largest weight.
        most: f64,
    },
}

/// The largest weight of a net is at most so many times the smallest: beyond that nothing of some poles is left in the digits of
/// the numbers, and no surface of practice comes near it.
pub const MOST_UNEVEN: f64 = 1e8;

/// What is wrong with weights of these sizes.
#[must_use]
pub fn uneven(least: f64, most: f64) -> String {
    format!("the weights go from {least} to {most}; the largest may be {MOST_UNEVEN} times the smallest")
}

/// How two neighbouring patches meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Joint {
    /// First patch (row, column); the second is the next one in `axis`.
    pub patch: [usize; 2],
    /// 0: the joint runs in v between rows; 1: in u between columns.
    pub axis: usize,
    /// Largest angle between the two normals along the joint (sampled at 65 places).
    pub angle: Angle,
    /// Where it is largest, mm.
    pub at: Point3,
}

/// A net of patches; its parameters run over `0..=patch rows` in u and `0..=patch columns` in v.
#[derive(Debug, Clone, PartialEq)]
pub struct Net {
    rows: usize,
    columns: usize,
    patches: Vec<Patch>,
}

impl Net {
    /// A net from `rows × columns` poles, row by row (a row runs in v), and weights.
    ///
    /// # Errors
    /// [`NetIssue`]: sizes, counts, numbers.
    pub fn new(
        rows: usize,
        columns: usize,
        poles: &[Point3],
        weights: Option<&[f64]>,
    ) -> Result<Net, NetIssue> {
        let cubic = |n: usize| n >= 4 && n % 3 == 1;
        let chain = cubic(rows) && cubic(columns);
        let small = |n: usize| (2..=MAX_DEGREE + 1).contains(&n);
        let single = small(rows) && small(columns);
        check_counts(rows, columns, poles, weights)?;
        if !chain && !single {
            return Err(NetIssue::Size { rows, columns });
        }
        let (degree, size) = if chain {
            ([3, 3], [(rows - 1) / 3, (columns - 1) / 3])
        } else {
            ([rows - 1, columns - 1], [1, 1])
        };
        Net::chain(degree, size, poles, weights)
    }
    /// A net of `size` patches (rows, columns), all of the same degree (p, q): (p rows + 1) × (q columns + 1) poles,
    /// row by row, and weights.
    ///
    /// # Errors
    /// [`NetIssue`]: sizes, counts, numbers.
    pub fn chain(
        degree: [usize; 2],
        size: [usize; 2],
        poles: &[Point3],
        weights: Option<&[f64]>,
    ) -> Result<Net, NetIssue> {
        let [p, q] = degree;
        let length = |degree: usize, patches: usize| degree.saturating_mul(patches).saturating_add(1);
        let (rows, columns) = (length(p, size[0]), length(q, size[1]));
        check_counts(rows, columns, poles, weights)?;
        let usable = |n: usize| (1..=MAX_DEGREE).contains(&n);
        if !usable(p) || !usable(q) || size.contains(&0) {
            return Err(NetIssue::Size { rows, columns });
        }
        check_weights(weights)?;
        let mut patches = Vec::with_capacity(size[0] * size[1]);
        for i in 0..size[0] {
            for j in 0..size[1] {
                let pick = |k: usize| (p * i + k / (q + 1)) * columns + q * j + k % (q + 1);
                let own: Vec<Point3> = (0..(p + 1) * (q + 1)).map(|k| poles[pick(k)]).collect();
                let own_weights: Option<Vec<f64>> =
                    weights.map(|w| (0..own.len()).map(|k| w[pick(k)]).collect());
                let patch = Patch::new(p + 1, q + 1, &own, own_weights.as_deref());
                patches.push(patch.ok_or(NetIssue::NotFinite)?);
            }
        }
        Ok(Net { rows: size[0], columns: size[1], patches })
    }
    /// The net with every pole moved to its image under an affine map: the image of the surface.
    ///
    /// # Errors
    /// [`NetIssue::NotFinite`] when an image is not finite.
    pub fn map(&self, image: impl Fn(Point3) -> Point3) -> Result<Net, NetIssue> {
        let moved = |patch: &Patch| {
            let [m, n] = patch.degree();
            let places = || (0..=m).flat_map(|i| (0..=n).map(move |j| (i, j)));
            let poles: Vec<Point3> = places().map(|(i, j)| image(patch.pole(i, j))).collect();
            let weights: Vec<f64> = places().map(|(i, j)| patch.weight(i, j)).collect();
            Patch::new(m + 1, n + 1, &poles, Some(&weights)).ok_or(NetIssue::NotFinite)
        };
        let patches = self.patches.iter().map(moved).collect::<Result<_, _>>()?;
        Ok(Net { rows: self.rows, columns: self.columns, patches })
    }
    /// Patch rows and columns.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.rows, self.columns]
    }
    /// Patches, row by row.
    #[must_use]
    pub fn patches(&self) -> &[Patch] {
        &self.patches
    }
    /// The patch that holds (u, v), and the parameters inside it; outside the net, the nearest.
    #[must_use]
    pub fn locate(&self, u: f64, v: f64) -> (&Patch, f64, f64) {
        let (patch, s, t) = self.place(u, v);
        (&self.patches[patch], s, t)
    }
    /// The index of the patch that holds (u, v), and the parameters inside it; outside the net, the nearest.
    #[must_use]
    pub fn place(&self, u: f64, v: f64) -> (usize, f64, f64) {
        let split = |t: f64, n: usize| {
            let t = t.clamp(0.0, crate::math::count(n));
            let mut k = 0;
            while k + 1 < n && t >= crate::math::count(k + 1) {
                k += 1;
            }
            (k, t - crate::math::count(k))
        };
        let (i, s) = split(u, self.rows);
        let (j, t) = split(v, self.columns);
        (i * self.columns + j, s, t)
    }
    /// Surface point and derivatives at net parameters.
    #[must_use]
    pub fn jet(&self, u: f64, v: f64) -> SurfaceJet {
        let (patch, s, t) = self.locate(u, v);
        patch.jet(s, t)
    }
    /// The joints between neighbouring patches with their worst normal angle. Poles are shared, so that
    /// every joint is C0 by construction.
    #[must_use]
    pub fn joints(&self) -> Vec<Joint> {
        let mut out = Vec::new();
        for i in 0..self.rows {
            for j in 0..self.columns {
                if i + 1 < self.rows {
                    out.push(self.joint(i, j, 0));
                }
                if j + 1 < self.columns {
                    out.push(self.joint(i, j, 1));
                }
            }
        }
        out
    }
    fn joint(&self, i: usize, j: usize, axis: usize) -> Joint {
        const PLACES: u32 = 64;
        let first = &self.patches[i * self.columns + j];
        let second =
            &self.patches[if axis == 0 { (i + 1) * self.columns + j } else { i * self.columns + j + 1 }];
        let mut worst = (0.0, first.point(1.0, 1.0));
        for k in 0..=PLACES {
            let t = f64::from(k) / f64::from(PLACES);
            let (a, b) = if axis == 0 {
                (first.jet(1.0, t), second.jet(0.0, t))
            } else {
                (first.jet(t, 1.0), second.jet(t, 0.0))
            };
            if let (Some(m), Some(n)) = (a.normal(), b.normal()) {
                let angle = crate::math::atan2(m.cross(&n).norm(), m.dot(&n));
                if angle > worst.0 {
                    worst = (angle, a.p);
                }
            }
        }
        Joint { patch: [i, j], axis, angle: Angle::radians(worst.0), at: worst.1 }
    }
}

/// Whether there is a pole, and a weight where there are weights, for each place.
fn check_counts(
    rows: usize,
    columns: usize,
    poles: &[Point3],
    weights: Option<&[f64]>,
) -> Result<(), NetIssue> {
    let wanted = rows.saturating_mul(columns);
    if poles.len() != wanted || weights.is_some_and(|w| w.len() != wanted) {
        let given = weights.map_or(poles.len(), |w| w.len().min(poles.len()));
        return Err(NetIssue::Count { wanted, given });
    }
    Ok(())
}

/// Whether weights are of the same order, as far as they are sound.
fn check_weights(weights: Option<&[f64]>) -> Result<(), NetIssue> {
    let weights = weights.unwrap_or_default().iter().copied().filter(|w| w.is_finite() && *w > 0.0);
    let (least, most) = weights.fold((f64::INFINITY, 0.0_f64), |(a, b), w| (a.min(w), b.max(w)));
    if most > MOST_UNEVEN * least { Err(NetIssue::Uneven { least, most }) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(rows: usize, columns: usize, z: impl Fn(usize, usize) -> f64) -> Vec<Point3> {
        (0..rows * columns)
            .map(|k| {
                let (i, j) = (k / columns, k % columns);
                Point3::new(10.0 * crate::math::count(i), 10.0 * crate::math::count(j), z(i, j))
            })
            .collect()
    }

    #[test]
    fn counts_decide_the_patches() {
        let net = Net::new(7, 4, &grid(7, 4, |_, _| 0.0), None).expect("a net");
        assert_eq!(net.size(), [2, 1]);
        let net = Net::new(3, 5, &grid(3, 5, |_, _| 0.0), None).expect("a net");
        assert_eq!((net.size(), net.patches()[0].degree()), ([1, 1], [2, 4]));
        assert_eq!(
            Net::new(4, 4, &grid(4, 3, |_, _| 0.0), None),
            Err(NetIssue::Count { wanted: 16, given: 12 })
        );
        assert_eq!(
            Net::new(1, 4, &grid(1, 4, |_, _| 0.0), None),
            Err(NetIssue::Size { rows: 1, columns: 4 })
        );
    }

    #[test]
    fn the_image_of_a_net_is_the_image_of_its_points() {
        let poles = grid(7, 4, |i, j| crate::math::count((3 * i + 5 * j) % 7));
        let weights: Vec<f64> = (0..28).map(|k| 1.0 + crate::math::count(k % 3)).collect();
        let image = |p: Point3| Point3::new(p.y - 2.0 * p.z, 3.0 - p.x, p.x + p.y + 0.5 * p.z);
        for weights in [None, Some(weights.as_slice())] {
            let net = Net::new(7, 4, &poles, weights).expect("a net");
            let moved = net.map(image).expect("a net");
            for (u, v) in [(0.0, 0.0), (0.7, 0.2), (1.4, 1.0)] {
                assert!((moved.jet(u, v).p - image(net.jet(u, v).p)).norm() < 1e-12);
            }
        }
        assert_eq!(Net::new(7, 4, &poles, None).map(|n| n.map(|p| p * 1e308)), Ok(Err(NetIssue::NotFinite)));
    }

    #[test]
    fn a_crease_shows_at_its_joint() {
        let roof =
            |i: usize, _: usize| if i <= 3 { crate::math::count(i) } else { 6.0 - crate::math::count(i) };
        let net = Net::new(7, 4, &grid(7, 4, roof), None).expect("a net");
        let joints = net.joints();
        assert_eq!(joints.len(), 1);
        let slope = crate::math::atan2(1.0, 10.0);
        assert!((joints[0].angle.rad() - 2.0 * slope).abs() < 1e-12);
    }
}
