//! The plan of a net, continued beyond its edges.
//!
//! A cutter with a flat touches a surface that falls off at its edge with the far side of its rim: for the edge to be cut
//! its axis must go on beyond it, by as much as the cutter is wide there.

use super::cutter::Cutter;
use super::net::Net;
use crate::geom::{Point2, Vec2};
use crate::math;

/// How far the plan goes on beyond the edges u = 0, u = last, v = 0 and v = last, mm. Beyond an edge, parameters run on by
/// 1 for that way, at right angles to the edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rim {
    beyond: [f64; 4],
    most: f64,
}

/// The axis stays nearer to the surface than the cutter's radius by so much, mm, and by no more than this share of it: there it
/// touches on every control's grid.
const NEARER: (f64, f64) = (2e-3, 0.01);
/// Places on an edge at which its slope is measured.
const PLACES: u32 = 64;
/// Surfaces that are flatter than this (the horizontal part of the normal) do not fall off.
const FLAT: f64 = 1e-4;

impl Rim {
    /// As wide as `cutter` asks for; `swings`: what is laid over it goes through some of its places, and may swing out between
    /// them.
    #[must_use]
    pub fn new(net: &Net, cutter: &Cutter, swings: bool) -> Rim {
        let radius = cutter.radius();
        let share = NEARER.1 * radius;
        let most = radius - if swings { share } else { share.min(NEARER.0) };
        let beyond = core::array::from_fn(|side| widest(net, cutter, side).min(most));
        Rim { beyond, most }
    }

    /// Range of the parameters along an axis, with the rim.
    #[must_use]
    pub fn range(&self, net: &Net, axis: usize) -> (f64, f64) {
        let past = |side: usize| if self.beyond[side] > 0.0 { 1.0 } else { 0.0 };
        (-past(2 * axis), math::count(net.size()[axis]) + past(2 * axis + 1))
    }

    /// The place in plan, mm.
    #[must_use]
    pub fn place(&self, net: &Net, uv: [f64; 2]) -> Point2 {
        let size = net.size().map(math::count);
        let inside: [f64; 2] = core::array::from_fn(|i| uv[i].clamp(0.0, size[i]));
        let jet = net.jet(inside[0], inside[1]);
        let [u, v] = [jet.u, jet.v].map(|t| t.xy().try_normalize(1e-12).unwrap_or_default());
        let mut ways = [across(u, v), across(v, u)];
        let mut wide = [0.0; 2];
        for i in 0..2 {
            let past = uv[i] - inside[i];
            wide[i] = self.beyond[2 * i + usize::from(past > 0.0)];
            ways[i] *= past.signum();
        }
        let [s, t]: [f64; 2] = core::array::from_fn(|i| (uv[i] - inside[i]).abs());
        // At a corner as far out as both of its edges ask for.
        let mixed = ways[0].dot(&ways[1]);
        let det = (1.0 - mixed * mixed).max(1e-6);
        let corner = (ways[0] * (wide[0] - mixed * wide[1]) + ways[1] * (wide[1] - mixed * wide[0])) / det;
        let mut off =
            corner * (s * t) + ways[0] * (wide[0] * s * (1.0 - t)) + ways[1] * (wide[1] * t * (1.0 - s));
        let length = off.norm();
        if length > self.most {
            off *= self.most / length;
        }
        Point2::new(jet.p.x + off.x, jet.p.y + off.y)
    }

    /// The outline of plan and rim, in order around it.
    #[must_use]
    pub fn outline(&self, net: &Net, places: u32) -> Vec<Point2> {
        let [(u0, u1), (v0, v1)] = [self.range(net, 0), self.range(net, 1)];
        let corners = [[u0, v0], [u1, v0], [u1, v1], [u0, v1]];
        let mut points = Vec::new();
        for (k, from) in corners.iter().enumerate() {
            let to = corners[(k + 1) % 4];
            for i in 0..places {
                let t = f64::from(i) / f64::from(places);
                points.push(
                    self.place(net, [from[0] + (to[0] - from[0]) * t, from[1] + (to[1] - from[1]) * t]),
                );
            }
        }
        points
    }
}

/// The direction of a tangent at right angles to that of an edge, unit vectors in plan; the tangent's own where they are one.
fn across(tangent: Vec2, edge: Vec2) -> Vec2 {
    (tangent - edge * tangent.dot(&edge)).try_normalize(1e-6).unwrap_or(tangent)
}

/// How far outside an edge the axis of a cutter is that touches it.
fn widest(net: &Net, cutter: &Cutter, side: usize) -> f64 {
    let (axis, last) = (side / 2, side % 2 == 1);
    let size = net.size().map(math::count);
    let mut widest = 0.0f64;
    for k in 0..=PLACES {
        let mut uv = size.map(|n| n * f64::from(k) / f64::from(PLACES));
        uv[axis] = if last { size[axis] } else { 0.0 };
        let jet = net.jet(uv[0], uv[1]);
        let (out, edge) = if axis == 0 { (jet.u, jet.v) } else { (jet.v, jet.u) };
        let [out, edge] = [out, edge].map(|t| t.xy().try_normalize(1e-12).unwrap_or_default());
        let out = across(out, edge) * if last { 1.0 } else { -1.0 };
        let Some(n) = jet.normal() else { continue };
        let n = Vec2::new(n.x, n.y);
        if n.norm() > FLAT {
            widest = widest.max(cutter.touches_beside(n).dot(&out));
        }
    }
    widest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Point3;

    /// A plane patch that falls off, its sides `aslant` to each other, and the rim of a flat cutter about it.
    fn skew(aslant: f64) -> (Net, Rim) {
        let pole = |k: usize| {
            let (i, j) = (math::count(k / 2), math::count(k % 2));
            Point3::new(20.0 * i + aslant * j, 20.0 * j, 6.0 * i - 5.0 * j)
        };
        let net = Net::new(2, 2, &(0..4).map(pole).collect::<Vec<_>>(), None).expect("a net");
        let rim = Rim::new(&net, &Cutter::bull(4.0, 0.0), false);
        (net, rim)
    }

    #[test]
    fn every_place_of_an_edge_is_left_behind_by_as_much_as_the_cutter_is_wide_there() {
        for aslant in [0.0, 15.0, -30.0] {
            let (net, rim) = skew(aslant);
            let jet = net.jet(0.0, 0.5);
            let touches = Cutter::bull(4.0, 0.0).touches_beside(jet.normal().expect("a normal").xy());
            let edge = jet.v.xy().normalize();
            let out = -across(jet.u.xy().normalize(), edge);
            for v in [0.0, 0.3, 1.0] {
                let off = rim.place(&net, [-1.0, v]) - rim.place(&net, [0.0, v]);
                assert!((off.dot(&out) - touches.dot(&out)).abs() < 1e-9, "{aslant} {v}: {off}");
            }
        }
    }

    /// At a corner that falls off towards both edges the cutter comes to stand where it touches it alone.
    #[test]
    fn a_corner_is_left_behind_towards_both_of_its_edges() {
        for aslant in [0.0, 15.0, 30.0] {
            let (net, rim) = skew(aslant);
            let corner = rim.place(&net, [0.0, 1.0]);
            let touches =
                Cutter::bull(4.0, 0.0).touches_beside(net.jet(0.0, 1.0).normal().expect("one").xy());
            let off = rim.place(&net, [-1.0, 2.0]) - corner;
            assert!((off - touches).norm() < 0.02 * touches.norm(), "{aslant}: {off} {touches}");
        }
    }
}
