//! Moves of the ball as capsules, and what they leave on a point of the surface.

use super::Swept;
use crate::geom::surface::{Patch, SurfaceTree};
use crate::geom::{Point3, Vec3};

/// A point of the surface with its normal.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    pub p: Point3,
    pub n: Vec3,
    pub uv: [f64; 2],
}

/// A move's axis: start, unit direction, length; and its end.
#[derive(Clone, Copy)]
pub(super) struct Capsule {
    pub from: Point3,
    pub to: Point3,
    pub along: Vec3,
    pub length: f64,
    /// By so much the ball is taken for smaller than it is, mm: no point of the axis is farther from the move.
    off_axis: f64,
    /// Roughly how far the ball is off the surface, at equal distances along the move, mm.
    pub off: [f64; PLACES],
}

/// Places on a move at which it is told how far the ball is off the surface.
pub(super) const PLACES: usize = 9;

impl Corner {
    pub(super) fn new(patch: &Patch, u: f64, v: f64) -> Option<Corner> {
        let jet = patch.jet(u, v);
        jet.normal().map(|n| Corner { p: jet.p, n, uv: [u, v] })
    }
}

impl Capsule {
    pub(super) fn new(swept: &Swept) -> Capsule {
        let way = swept.to - swept.from;
        let length = way.norm();
        let along = if length > 0.0 { way / length } else { Vec3::zeros() };
        Capsule { from: swept.from, to: swept.to, along, length, off_axis: swept.off, off: [0.0; PLACES] }
    }

    /// The height at which the ray along the normal enters the capsule.
    pub(super) fn height(&self, at: &Corner, radius: f64) -> f64 {
        let radius = radius - self.off_axis;
        let offset = at.p - self.from;
        let end = |p: Point3| enters(at.p - p, at.n, radius).unwrap_or(f64::INFINITY);
        let (oa, na) = (offset.dot(&self.along), at.n.dot(&self.along));
        let (o, n) = (offset - self.along * oa, at.n - self.along * na);
        if self.length <= 0.0 || n.norm_squared() < PARALLEL {
            return end(self.from).min(end(self.to));
        }
        // The cylinder about the whole axis holds the capsule; what enters it before an end enters at the ball of that end,
        // if anywhere.
        let Some(t) = enters(o, n, radius) else { return f64::INFINITY };
        let s = oa + na * t;
        if s < 0.0 {
            end(self.from)
        } else if s > self.length {
            end(self.to)
        } else {
            t
        }
    }

    /// Square distance of the axis from a place.
    pub(super) fn apart(&self, p: Point3) -> f64 {
        let offset = p - self.from;
        let s = offset.dot(&self.along).clamp(0.0, self.length);
        (offset - self.along * s).norm_squared()
    }
}

/// Square of the sine of the angle below which a ray is parallel to an axis.
const PARALLEL: f64 = 1e-12;

impl Capsule {
    /// Looks how far the ball is off the surface.
    pub(super) fn measure(&mut self, tree: &SurfaceTree, ball: f64) {
        let mut foot = tree.nearest(self.from, None);
        for (k, off) in self.off.iter_mut().enumerate() {
            let share = crate::math::count(k) / crate::math::count(PLACES - 1);
            foot = tree.nearby(self.from + (self.to - self.from) * share, &foot);
            *off = (foot.distance - ball).max(0.0);
        }
    }

    /// Roughly how far the ball is off the surface where it passes nearest to a point.
    pub(super) fn off_at(&self, p: Point3) -> f64 {
        if self.length <= 0.0 {
            return self.off[0];
        }
        let share = ((p - self.from).dot(&self.along) / self.length).clamp(0.0, 1.0);
        let x = share * crate::math::count(PLACES - 1);
        // x lies in 0..=PLACES - 1.
        let i = (x.floor() as usize).min(PLACES - 2);
        let f = x - crate::math::count(i);
        self.off[i] * (1.0 - f) + self.off[i + 1] * f
    }
}

/// The first parameter at which o + t n comes within `radius` of the origin; `None` where it never does.
fn enters(o: Vec3, n: Vec3, radius: f64) -> Option<f64> {
    let (a, b, c) = (n.norm_squared(), o.dot(&n), o.norm_squared() - radius * radius);
    let root = b * b - a * c;
    if a < PARALLEL || root < 0.0 {
        return None;
    }
    Some((-b - root.sqrt()) / a)
}
