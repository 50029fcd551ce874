//! Exact curves and surfaces.
//!
//! Lengths are millimetres, angles radians; derivatives are in closed form.
//! Nothing here knows operations, controllers or text.

pub mod cam;
pub mod crossing;
pub mod curve;
pub(crate) mod extremum;
pub mod follower;
pub mod measure;
pub mod motion;
pub mod parallel;
pub mod project;
mod quadrature;
pub mod surface;
mod tridiagonal;

/// A point of the working plane, mm.
pub type Point2 = nalgebra::Point2<f64>;
/// A vector of the working plane, mm (or of unit length where said).
pub type Vec2 = nalgebra::Vector2<f64>;
/// A point in space, mm.
pub type Point3 = nalgebra::Point3<f64>;
/// A vector in space, mm (or of unit length where said).
pub type Vec3 = nalgebra::Vector3<f64>;

/// The vector turned a quarter turn counter-clockwise: for a unit tangent, the left normal.
#[must_use]
pub fn left(v: Vec2) -> Vec2 {
    Vec2::new(-v.y, v.x)
}

/// z component of the cross product: positive when `b` is to the left of `a`.
#[must_use]
pub fn cross(a: Vec2, b: Vec2) -> f64 {
    a.x * b.y - a.y * b.x
}

/// The point of the straight way from `a` to `b` that is nearest to `p`.
#[must_use]
pub fn nearest_on_way<const D: usize>(
    a: nalgebra::Point<f64, D>,
    b: nalgebra::Point<f64, D>,
    p: nalgebra::Point<f64, D>,
) -> nalgebra::Point<f64, D> {
    let way = b - a;
    let t = ((p - a).dot(&way) / way.norm_squared().max(1e-300)).clamp(0.0, 1.0);
    a + way * t
}

/// A side of a directed curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize)]
pub enum Side {
    /// To the left of travel.
    Left,
    /// To the right of travel.
    Right,
}

impl Side {
    /// The other side.
    #[must_use]
    pub const fn opposite(self) -> Side {
        match self {
            Side::Left => Side::Right,
            Side::Right => Side::Left,
        }
    }
    /// +1 for left, -1 for right: the sign of a left-normal offset towards this side.
    #[must_use]
    pub const fn sign(self) -> f64 {
        match self {
            Side::Left => 1.0,
            Side::Right => -1.0,
        }
    }
}
