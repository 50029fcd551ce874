//! Transformations of space: `MATRIX/`, `TRACUT/`.

use crate::math::hypot;

use super::functions::sin_cos_degrees;

/// An affine map: three rows of a linear part and a shift, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transform(pub [[f64; 4]; 3]);

/// A determinant below this, relative to the lengths of the rows, counts as zero.
const SINGULAR: f64 = 1e-12;

impl Transform {
    /// The map that changes nothing.
    pub const IDENTITY: Transform =
        Transform([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]);

    /// Shift by `d` mm.
    #[must_use]
    pub fn shift(d: [f64; 3]) -> Transform {
        let mut t = Transform::IDENTITY;
        for (row, d) in t.0.iter_mut().zip(d) {
            row[3] = d;
        }
        t
    }

    /// Scale about the origin, by axis.
    #[must_use]
    pub fn scale(factors: [f64; 3]) -> Transform {
        let [x, y, z] = factors;
        Transform([[x, 0.0, 0.0, 0.0], [0.0, y, 0.0, 0.0], [0.0, 0.0, z, 0.0]])
    }

    /// Turn by an angle in degrees from axis `from` to axis `to` (0 = X, 1 = Y, 2 = Z).
    #[must_use]
    pub fn turn(from: usize, to: usize, degrees: f64) -> Transform {
        let (sin, cos) = sin_cos_degrees(degrees);
        let mut t = Transform::IDENTITY;
        t.0[from][from] = cos;
        t.0[from][to] = -sin;
        t.0[to][from] = sin;
        t.0[to][to] = cos;
        t
    }

    /// Mirror at the plane normal · p = distance (unit normal, mm).
    #[must_use]
    pub fn mirror(normal: [f64; 3], distance: f64) -> Transform {
        let mut t = Transform::IDENTITY;
        for (row, n) in t.0.iter_mut().zip(normal) {
            for (element, m) in row.iter_mut().zip(normal) {
                *element -= 2.0 * n * m;
            }
            row[3] = 2.0 * n * distance;
        }
        t
    }

    /// The map with these axes as columns, and this origin.
    #[must_use]
    pub fn frame(axes: [[f64; 3]; 3], origin: [f64; 3]) -> Transform {
        let row = |i: usize| [axes[0][i], axes[1][i], axes[2][i], origin[i]];
        Transform([row(0), row(1), row(2)])
    }

    /// This map after `first`.
    #[must_use]
    pub fn after(&self, first: &Transform) -> Transform {
        Transform(self.0.map(|row| {
            let mut product = [0.0, 0.0, 0.0, row[3]];
            for (factor, other) in row.iter().take(3).zip(&first.0) {
                for (sum, element) in product.iter_mut().zip(other) {
                    *sum += factor * element;
                }
            }
            product
        }))
    }

    /// Whether what goes on in plan is mirrored.
    #[must_use]
    pub fn mirrors_plan(&self) -> bool {
        let [[a, b, ..], [c, d, ..], _] = self.0;
        a * d - b * c < 0.0
    }
    /// The image of a point.
    #[must_use]
    pub fn point(&self, p: [f64; 3]) -> [f64; 3] {
        self.0.map(|row| row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3])
    }

    /// The map that undoes this one; `None` when it flattens space.
    #[must_use]
    pub fn inverse(&self) -> Option<Transform> {
        let [a, b, c] = self.0.map(|r| [r[0], r[1], r[2]]);
        let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
        let determinant = dot(a, bc);
        let size = norm(a) * norm(b) * norm(c);
        if determinant.abs() <= SINGULAR * size || size == 0.0 {
            return None;
        }
        let linear = Transform::frame([bc, ca, ab].map(|v| v.map(|x| x / determinant)), [0.0; 3]);
        let back = linear.point(self.0.map(|r| r[3])).map(|x| 0.0 - x);
        Some(Transform::shift(back).after(&linear))
    }
}

/// Scalar product.
pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product.
pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Length.
pub(super) fn norm(v: [f64; 3]) -> f64 {
    hypot(hypot(v[0], v[1]), v[2])
}

/// a - b.
pub(super) fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The vector scaled to length 1; `None` without a length.
pub(super) fn unit(v: [f64; 3]) -> Option<[f64; 3]> {
    let length = norm(v);
    (length > 0.0 && length.is_finite()).then(|| v.map(|x| x / length))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_go_from_the_first_axis_to_the_second() {
        assert_eq!(Transform::turn(0, 1, 90.0).point([3.0, 1.0, 2.0]), [-1.0, 3.0, 2.0]);
        assert_eq!(Transform::turn(1, 2, 90.0).point([3.0, 1.0, 2.0]), [3.0, -2.0, 1.0]);
        assert_eq!(Transform::turn(2, 0, 90.0).point([3.0, 1.0, 2.0]), [2.0, 1.0, -3.0]);
    }

    #[test]
    fn the_right_factor_of_a_product_acts_first() {
        let (shift, turn) = (Transform::shift([10.0, 20.0, 30.0]), Transform::turn(0, 1, 90.0));
        assert_eq!(shift.after(&turn).point([3.0, 1.0, 2.0]), [9.0, 23.0, 32.0]);
        assert_eq!(turn.after(&shift).point([3.0, 1.0, 2.0]), [-21.0, 13.0, 32.0]);
    }

    #[test]
    fn an_inverse_undoes_and_a_flat_map_has_none() {
        let t = Transform::shift([5.0, -1.0, 2.0])
            .after(&Transform::turn(1, 2, 37.0))
            .after(&Transform::scale([2.0, 3.0, 0.5]));
        let p = [1.0, -7.0, 4.0];
        let back = t.inverse().expect("not flat").point(t.point(p));
        assert!(norm(minus(back, p)) < 1e-12);
        assert_eq!(Transform::scale([1.0, 0.0, 1.0]).inverse(), None);
    }

    #[test]
    fn mirrors_keep_their_plane() {
        let t = Transform::mirror([0.0, 1.0, 0.0], 3.0);
        assert_eq!(t.point([1.0, 3.0, 2.0]), [1.0, 3.0, 2.0]);
        assert_eq!(t.point([1.0, 5.0, 2.0]), [1.0, 1.0, 2.0]);
    }
}
