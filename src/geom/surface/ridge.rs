//! The ridge that two neighbouring passes of a ball leave between them.

use super::drop::Contact;
use super::tree::SurfaceTree;
use crate::geom::Vec3;

/// Height above the surface, mm, of the ridge between two passes of a ball of `radius`, at the contacts `a` and `b`;
/// `along`: unit tangent of the passes. Infinite where the two do not meet above the surface.
///
/// The passes are taken for parallel; the ridge is where both balls' sides meet below the line between the centres.
#[must_use]
pub fn height(tree: &SurfaceTree, radius: f64, a: &Contact, b: &Contact, along: Vec3) -> f64 {
    let apart = across(a, b, along);
    let half = 0.5 * apart.norm();
    let Some(direction) = apart.try_normalize(1e-12) else { return 0.0 };
    if half >= radius {
        return f64::INFINITY;
    }
    let up = a.normal + b.normal;
    let up = up - along * up.dot(&along) - direction * up.dot(&direction);
    let Some(up) = up.try_normalize(1e-12) else { return f64::INFINITY };
    let ridge = a.centre + apart * 0.5 - up * (radius * radius - half * half).sqrt();
    let foot = tree.nearby(ridge, &a.foot);
    // Beyond an edge the foot lies aside: only the height counts.
    (ridge - foot.point).dot(&up)
}

/// From the pass through `a` to that through `b`, at right angles to both.
#[must_use]
pub fn across(a: &Contact, b: &Contact, along: Vec3) -> Vec3 {
    let apart = b.centre - a.centre;
    apart - along * apart.dot(&along)
}
