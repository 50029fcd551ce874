//! The plan of a net, continued beyond its edges.
//!
//! A cutter with a flat touches a surface that falls off at its edge with the far side of its rim: for the edge to be cut
//! its axis must go on beyond it, by as much as the cutter is wide there.

use super::cutter::Cutter;
use super::net::Net;
use crate::geom::{Point2, Vec2};
use crate::math;

/// How far the plan goes on beyond the edges u = 0, u = last, v = 0 and v = last, mm. Beyond an edge, parameters run on by
/// 1 for that way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rim {
    beyond: [f64; 4],
    most: f64,
}

/// The axis stays nearer to the surface than this share of the cutter's radius: there it still touches.
const SHARE: f64 = 0.99;
/// Places on an edge at which its slope is measured.
const PLACES: u32 = 64;
/// Surfaces that are flatter than this (the horizontal part of the normal) do not fall off.
const FLAT: f64 = 1e-4;

impl Rim {
    /// As wide as `cutter` asks for.
    #[must_use]
    pub fn new(net: &Net, cutter: &Cutter) -> Rim {
        let most = SHARE * cutter.radius();
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
        let mut off = Vec2::zeros();
        for (i, along) in [jet.u, jet.v].iter().enumerate() {
            let past = uv[i] - inside[i];
            let beyond = self.beyond[2 * i + usize::from(past > 0.0)] * past;
            off += Vec2::new(along.x, along.y).try_normalize(1e-12).unwrap_or_default() * beyond;
        }
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

/// How far outside an edge the axis of a cutter is that touches it.
fn widest(net: &Net, cutter: &Cutter, side: usize) -> f64 {
    let (axis, last) = (side / 2, side % 2 == 1);
    let size = net.size().map(math::count);
    let mut widest = 0.0f64;
    for k in 0..=PLACES {
        let mut uv = size.map(|n| n * f64::from(k) / f64::from(PLACES));
        uv[axis] = if last { size[axis] } else { 0.0 };
        let jet = net.jet(uv[0], uv[1]);
        let (out, along) = if axis == 0 { (jet.u, jet.v) } else { (jet.v, jet.u) };
        let edge = Vec2::new(along.x, along.y).try_normalize(1e-12).unwrap_or_default();
        let out = Vec2::new(out.x, out.y) * if last { 1.0 } else { -1.0 };
        let out = (out - edge * out.dot(&edge)).try_normalize(1e-12);
        let (Some(n), Some(out)) = (jet.normal(), out) else { continue };
        let n = Vec2::new(n.x, n.y);
        if n.norm() > FLAT {
            widest = widest.max(cutter.touches_beside(n).dot(&out));
        }
    }
    widest
}
