//! Where a ball rests that is let down on a surface, exactly.
//!
//! The centre c = (x, y, z) has the distance R from the surface, which is its Lipschitz and semiconcave distance
//! function d: z is found by Newton's method on d(z) = R with ∂d/∂z = n·z, on the foot that is nearest; the answer is
//! accepted when no other point of the surface, edges included, is nearer than R.

use super::cutter::Cutter;
use super::tree::{Foot, SurfaceTree};
use crate::geom::{Point3, Vec3};

/// A ball that touches a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// Its centre, mm.
    pub centre: Point3,
    /// Unit vector from the point of contact to the centre.
    pub normal: Vec3,
    /// The point of contact.
    pub foot: Foot,
}

/// Distances that agree so well with the radius touch, mm.
pub const TOUCHES: f64 = 1e-10;
/// A ball that touches beside its equator (n·z below this) does not rest.
const UPRIGHT: f64 = 1e-3;
/// Steps of the search.
const STEPS: u32 = 200;

/// The highest position above (x, y) at which a ball of `radius` touches the surface; `None` where it touches nothing.
/// `hint`: the contact at a place near by.
#[must_use]
pub fn drop_ball(tree: &SurfaceTree, radius: f64, x: f64, y: f64, hint: Option<&Contact>) -> Option<Contact> {
    let hinted = hint.filter(|c| c.normal.z > UPRIGHT).and_then(|c| {
        let (low, high) = tree.bounds();
        let slope = -(c.normal.x * (x - c.centre.x) + c.normal.y * (y - c.centre.y)) / c.normal.z;
        let z = (c.centre.z + slope).clamp(low.z - radius, high.z + radius);
        settled(tree, radius, (Point3::new(x, y, z), c.foot), false)
    });
    // A part of the surface above could hold the ball higher up.
    if let Some(contact) = hinted.filter(|c| tree.is_upright() || !covered(tree, radius, c.centre)) {
        return Some(contact);
    }
    let start = Point3::new(x, y, ceiling(tree, radius, x, y)?);
    settled(tree, radius, (start, tree.nearest(start, None)), true).or_else(|| {
        // Beside a wall that is nearer than what holds the ball.
        let rest = tree.rest(&Cutter::ball(radius), [x, y], None)?;
        settled(tree, radius, (rest.centre, rest.foot), false).or(Some(rest))
    })
}

/// The position that a search up and down from a centre and a foot of it comes to; `from_above`: nothing touches above it.
fn settled(
    tree: &SurfaceTree,
    radius: f64,
    (mut centre, mut foot): (Point3, Foot),
    from_above: bool,
) -> Option<Contact> {
    let mut certain = false;
    for _ in 0..STEPS {
        foot = if certain { tree.nearest(centre, Some(&foot)) } else { tree.nearby(centre, &foot) };
        let off = radius - foot.distance;
        if off.abs() <= TOUCHES {
            if certain {
                return Some(Contact { centre, normal: (centre - foot.point) / foot.distance, foot });
            }
            certain = true;
            continue;
        }
        let up = (centre.z - foot.point.z) / foot.distance;
        if up < UPRIGHT {
            // The foot is beside or above: whether anything touches is seen from above only.
            let beside = beside(centre, &foot);
            if !from_above || beside >= radius {
                return None;
            }
            centre.z = foot.point.z + (radius * radius - beside * beside).sqrt();
            continue;
        }
        // Only a step up may be trusted blindly: what is nearer than the radius must be cleared.
        certain = certain && off > 0.0;
        centre.z += (off / up).clamp(-radius, radius);
    }
    None
}

/// A height above which a ball over (x, y) touches nothing; `None` where it touches nothing at any height.
fn ceiling(tree: &SurfaceTree, radius: f64, x: f64, y: f64) -> Option<f64> {
    let at = [x, y];
    let mut most = f64::NEG_INFINITY;
    tree.visit(&mut |low, high, leaf| {
        let beyond = |i: usize| (low[i] - at[i]).max(at[i] - high[i]).max(0.0);
        let rest = radius * radius - beyond(0) * beyond(0) - beyond(1) * beyond(1);
        let top = high[2] + rest.max(0.0).sqrt();
        let enter = rest > 0.0 && top > most;
        if enter && leaf {
            most = top;
        }
        enter
    });
    most.is_finite().then_some(most)
}

/// Distance in plan.
fn beside(centre: Point3, foot: &Foot) -> f64 {
    crate::math::hypot(centre.x - foot.point.x, centre.y - foot.point.y)
}

/// Whether some box of surface within the ball's plan rises above its centre.
fn covered(tree: &SurfaceTree, radius: f64, centre: Point3) -> bool {
    if tree.bounds().1.z <= centre.z {
        return false;
    }
    let mut found = false;
    tree.visit(&mut |low, high, leaf| {
        let beyond = |i: usize| (low[i] - centre[i]).max(centre[i] - high[i]).max(0.0);
        let inside = crate::math::hypot(beyond(0), beyond(1)) < radius && high[2] > centre.z;
        found |= inside && leaf;
        inside && !found
    });
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::surface::Net;

    fn graph(x: [f64; 4], y: [f64; 4], z: [[f64; 4]; 4]) -> Net {
        let poles: Vec<Point3> = (0..16).map(|k| Point3::new(x[k / 4], y[k % 4], z[k / 4][k % 4])).collect();
        Net::new(4, 4, &poles, None).expect("a net")
    }
    fn cavity() -> SurfaceTree {
        let z = [[0.0; 4], [0.0, -52.0, -46.0, 0.0], [0.0, -44.0, -56.0, 0.0], [0.0; 4]];
        SurfaceTree::new(graph([0.0, 20.0, 40.0, 60.0], [0.0, 16.0, 32.0, 48.0], z), 8.0)
    }

    /// The highest centre over a grid of surface points: from below, a little too low.
    fn brute(tree: &SurfaceTree, radius: f64, x: f64, y: f64) -> f64 {
        let mut best = f64::NEG_INFINITY;
        for i in 0..=600 {
            for j in 0..=600 {
                let p = tree.net().patches()[0].point(f64::from(i) / 600.0, f64::from(j) / 600.0);
                let rest = radius * radius - (p.x - x) * (p.x - x) - (p.y - y) * (p.y - y);
                if rest >= 0.0 {
                    best = best.max(p.z + rest.sqrt());
                }
            }
        }
        best
    }

    #[test]
    fn a_ball_rests_where_the_highest_point_of_the_surface_holds_it() {
        let tree = cavity();
        for (radius, x, y) in [
            (5.0, 31.0, 22.0),
            (8.0, 3.0, 3.5),
            (8.0, 57.0, 45.0),
            (5.0, -2.0, 20.0),
            (8.0, 30.0, 50.0),
            (3.0, 7.0, 40.0),
        ] {
            let rest = drop_ball(&tree, radius, x, y, None).expect("a contact");
            let brute = brute(&tree, radius, x, y);
            assert!(
                (-TOUCHES..2e-3).contains(&(rest.centre.z - brute)),
                "{radius} {x} {y}: {rest:?}, {brute}"
            );
        }
    }

    #[test]
    fn the_hint_does_not_matter() {
        let tree = cavity();
        let mut hint = None;
        for k in 0..=80 {
            let x = -3.0 + 66.0 * f64::from(k) / 80.0;
            let plain = drop_ball(&tree, 8.0, x, 9.0, None).expect("a contact");
            let hinted = drop_ball(&tree, 8.0, x, 9.0, hint.as_ref()).expect("a contact");
            assert!((plain.centre.z - hinted.centre.z).abs() < 1e-9, "{x}");
            hint = Some(hinted);
        }
    }

    /// A ball beside steep walls, over the net and past its border, is held where the search for other cutters finds it held.
    #[test]
    fn a_ball_beside_steep_walls_finds_what_holds_it() {
        let z = [
            [-1.0, -6.0, -5.0, 3.0],
            [0.0, -10.0, -8.0, -10.0],
            [10.0, 4.0, -11.0, 6.0],
            [5.0, -10.0, 4.0, 11.0],
        ];
        let tree = SurfaceTree::new(graph([0.0, 3.0, 6.0, 9.0], [0.0, 3.3, 6.7, 10.0], z), 1.0);
        let mut held = 0;
        for k in 0..400u32 {
            let (x, y) = (-1.2 + 11.4 * f64::from(k % 20) / 19.0, -1.2 + 12.4 * f64::from(k / 20) / 19.0);
            let own = drop_ball(&tree, 1.0, x, y, None);
            let other = tree.rest(&Cutter::ball(1.0), [x, y], None);
            assert_eq!(own.is_some(), other.is_some(), "{x} {y}");
            if let (Some(own), Some(other)) = (own, other) {
                held += 1;
                assert!((own.centre.z - other.centre.z).abs() < 1e-6, "{x} {y}: {own:?} {other:?}");
            }
        }
        assert!(held > 300, "{held}");
    }

    #[test]
    fn far_from_the_surface_nothing_holds_the_ball() {
        assert_eq!(drop_ball(&cavity(), 5.0, -6.0, 20.0, None), None);
    }
}
