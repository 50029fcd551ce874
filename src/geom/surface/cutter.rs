//! Milling cutters as solids: a convex core, rounded by a ball.
//!
//! The core of a ball-end cutter is its axis above the ball's centre; that of a flat or bull-nose cutter a cylinder as
//! wide as the flat, that of a tapered one a cone. All are solids of revolution about +z, endless upwards, that stand on
//! a disc. The *reference point* is that disc's middle: the centre of a ball, the tip of a flat cutter.
//!
//! A point q is outside a convex solid C by σ(q) = max over unit n of n·q − h(n), with h the support function of C; below
//! zero, −σ is how deep it is inside. Every n gives a bound, so that questions about a surface are settled by planes
//! ([`super::tree`]): no sharp rim is in the way.

use super::drop::{Contact, drop_ball};
use super::tree::SurfaceTree;
use crate::geom::{Point3, Vec2, Vec3};
use crate::math;

/// A cutter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cutter {
    /// Radius of the ball that rounds the core, mm.
    corner: f64,
    /// Radius of the core's disc, mm.
    disc: f64,
    /// Height of the disc above the tip, mm.
    lift: f64,
    /// Sine and cosine of the side's angle to the axis.
    side: [f64; 2],
}

/// The profile at a distance from the axis, above the reference point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Profile {
    pub height: f64,
    /// Outward unit normal: away from the axis, and along it.
    pub normal: [f64; 2],
}

/// Points beside the profile by less count as on it, mm.
const GRAZES: f64 = 1e-12;
/// Length of a plan vector; far from the ends of the range of numbers, as points of surfaces are.
pub(super) fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}

/// Height of the solid, mm: far above any surface.
const ENDLESS: f64 = 1e5;

impl Cutter {
    /// A ball-end cutter.
    #[must_use]
    pub fn ball(radius: f64) -> Cutter {
        Cutter { corner: radius, disc: 0.0, lift: radius, side: [0.0, 1.0] }
    }
    /// A flat (`corner` 0) or bull-nose cutter.
    #[must_use]
    pub fn bull(radius: f64, corner: f64) -> Cutter {
        let corner = corner.min(radius);
        Cutter { corner, disc: radius - corner, lift: corner, side: [0.0, 1.0] }
    }
    /// A tapered cutter: its side leaves the corner, whose circle's centre is `disc` off the axis and `lift` above the
    /// tip, under this angle, rad, to the axis, and goes on so.
    #[must_use]
    pub fn taper(disc: f64, lift: f64, corner: f64, angle: f64) -> Cutter {
        let (sin, cos) = math::sin_cos(angle);
        Cutter { corner, disc, lift, side: [sin, cos] }
    }
    /// The same cutter with a hull of `by` mm about it.
    #[must_use]
    pub fn grown(&self, by: f64) -> Cutter {
        Cutter { corner: self.corner + by, ..*self }
    }
    /// A cutter inside of this one, everywhere at least `by` mm from its hull, and how far above this one's reference point
    /// its own is; `None` where nothing is left.
    #[must_use]
    pub fn shrunk(&self, by: f64) -> Option<(Cutter, f64)> {
        if by <= self.corner {
            return Some((Cutter { corner: self.corner - by, ..*self }, 0.0));
        }
        let [sin, cos] = self.side;
        let sharp = by - self.corner;
        let disc = self.disc - sharp * (1.0 - sin) / cos;
        (disc >= 0.0).then_some((Cutter { corner: 0.0, disc, ..*self }, sharp))
    }
    /// Radius of the ball that rounds it, mm.
    #[must_use]
    pub fn corner(&self) -> f64 {
        self.corner
    }
    /// Height of the reference point above the tip, mm.
    #[must_use]
    pub fn lift(&self) -> f64 {
        self.lift
    }
    /// Radius of the core's disc, mm: of its flat.
    #[must_use]
    pub fn flat(&self) -> f64 {
        self.disc
    }
    /// From the point where it touches a surface to its axis, in plan, mm; `n` is the plan part of the surface's normal.
    #[must_use]
    pub fn touches_beside(&self, n: Vec2) -> Vec2 {
        n.try_normalize(0.0).map_or_else(Vec2::zeros, |e| e * self.disc + n * self.corner)
    }
    /// Its reference point where it touches a surface with this point and unit normal.
    #[must_use]
    pub fn set_on(&self, p: Point3, n: Vec3) -> Point3 {
        let beside = self.touches_beside(n.xy());
        Point3::new(p.x + beside.x, p.y + beside.y, p.z + self.corner * n.z)
    }
    /// Outward normal of its side: away from the axis, and along it.
    pub(super) fn side_normal(&self) -> [f64; 2] {
        [self.side[1], -self.side[0]]
    }
    /// Radius of its end, mm: where the side begins.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.disc + self.corner * self.side[1]
    }
    /// Whether it is a ball-end cutter.
    #[must_use]
    pub fn is_ball(&self) -> bool {
        self.disc == 0.0 && self.side[0] == 0.0
    }

    /// The highest position over (x, y) at which it touches the surface; the contact's centre is the reference point.
    /// `None` where it touches nothing. `hint`: the contact at a place near by.
    #[must_use]
    pub fn drop(&self, tree: &SurfaceTree, x: f64, y: f64, hint: Option<&Contact>) -> Option<Contact> {
        if self.is_ball() {
            return drop_ball(tree, self.corner, x, y, hint);
        }
        tree.rest(self, [x, y], hint.map(|c| &c.foot))
    }

    /// The profile `beside` mm off the axis; `None` outside of it.
    pub(super) fn profile(&self, beside: f64) -> Option<Profile> {
        let [sin, cos] = self.side;
        let (r, off) = (self.corner, beside - self.disc);
        if off <= 0.0 {
            return Some(Profile { height: -r, normal: [0.0, -1.0] });
        }
        let edge = r * cos;
        if off <= edge || sin <= 0.0 && off <= edge + GRAZES {
            let down = (r * r - off * off).max(0.0).sqrt();
            let normal = if r > 0.0 { [(off / r).min(1.0), -down / r] } else { [0.0, -1.0] };
            return Some(Profile { height: -down, normal });
        }
        let on_side = Profile { height: (off - edge) * cos / sin - r * sin, normal: [cos, -sin] };
        (sin > 0.0).then_some(on_side)
    }

    /// Bounds over a range of distances from the axis: of the profile's slope, least and most, and of the slope's own
    /// slope, 1/mm, from below. `None` where it stands upright in the range or ends.
    pub(super) fn slopes(&self, low: f64, high: f64) -> Option<([f64; 2], f64)> {
        let [sin, cos] = self.side;
        let (r, edge) = (self.corner, self.corner * cos);
        let slope = |beside: f64| {
            let off = beside - self.disc;
            match off {
                _ if off <= 0.0 => Some(0.0),
                _ if off < edge => Some(off / (r * r - off * off).sqrt()),
                _ => (sin > 0.0).then(|| cos / sin),
            }
        };
        let (a, b) = (low - self.disc, high - self.disc);
        let round = if a > 0.0 && b < edge {
            {
                let square = (r - a) * (r + a);
                r * r / (square * square.sqrt())
            }
        } else {
            0.0
        };
        let slopes = [slope(low)?, slope(high)?];
        slopes[1].is_finite().then_some((slopes, round))
    }

    /// Support function of the cutter: largest n·q of its points; `n` is a unit vector.
    pub(super) fn support(&self, n: Vec3) -> f64 {
        self.core_support(n) + self.corner
    }

    /// Support function of the core.
    pub(super) fn core_support(&self, n: Vec3) -> f64 {
        let beside = length(n.x, n.y);
        let [sin, cos] = self.side;
        self.disc * beside + (beside * sin + n.z * cos).max(0.0) * ENDLESS
    }

    /// How far `q`, seen from the reference point, is outside the core (below zero: how deep inside), with the outward unit
    /// normal there.
    pub(super) fn outside_core(&self, q: Vec3) -> (f64, Vec3) {
        let beside = length(q.x, q.y);
        let (d, [across, up]) = self.flat_distance(beside, q.z);
        let e = if beside > 0.0 { [q.x / beside, q.y / beside] } else { [1.0, 0.0] };
        (d, Vec3::new(e[0] * across, e[1] * across, up))
    }

    /// The same in the half plane of the profile.
    fn flat_distance(&self, beside: f64, height: f64) -> (f64, [f64; 2]) {
        let [sin, cos] = self.side;
        let off = beside - self.disc;
        // Along the side's line from the corner, and to its right.
        let (along, right) = (off * sin + height * cos, off * cos - height * sin);
        if right <= 0.0 && height >= 0.0 {
            return if right >= -height { (right, [cos, -sin]) } else { (-height, [0.0, -1.0]) };
        }
        if off <= 0.0 && height < 0.0 {
            return (-height, [0.0, -1.0]);
        }
        if along >= 0.0 {
            return (right, [cos, -sin]);
        }
        let d = length(off, height);
        if d > 0.0 { (d, [off / d, height / d]) } else { (0.0, [0.0, -1.0]) }
    }

    /// Curvature of the core's distance at such a point: about the axis, and in the plane of the profile.
    pub(super) fn core_bend(&self, q: Vec3) -> [f64; 2] {
        let beside = length(q.x, q.y);
        let (d, [across, up]) = self.flat_distance(beside, q.z);
        let round = if beside > 0.0 { across / beside } else { 0.0 };
        let [sin, cos] = self.side;
        let at_corner = up < 0.0 && across > 0.0 && across * sin + up * cos < -1e-12;
        [round, if at_corner && d > 0.0 { 1.0 / d } else { 0.0 }]
    }

    /// The tip of the cutter whose reference point is here.
    #[must_use]
    pub fn tip(&self, reference: Point3) -> Point3 {
        Point3::new(reference.x, reference.y, reference.z - self.lift)
    }
    /// The reference point of the cutter whose tip is here.
    #[must_use]
    pub fn reference(&self, tip: Point3) -> Point3 {
        Point3::new(tip.x, tip.y, tip.z + self.lift)
    }
}

pub mod bent;
pub mod reach;
mod section;
mod way;

pub use way::{extremes, stays};

#[cfg(test)]
mod tests;
