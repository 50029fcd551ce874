//! Points of the surface that slide along with a tool.

use super::{Derivatives, Foot, SurfaceTree};
use crate::geom::Vec3;
use crate::geom::surface::interval::Interval;

/// What becomes of a point that slides in a straight line of its patch's parameters.
#[derive(Debug, Clone, Copy)]
pub struct Slide {
    /// The part of the wanted velocity that it cannot follow.
    pub left: Vec3,
    /// Bound of its acceleration, for a velocity of 1: mm per square mm.
    pub curve: f64,
}

/// Bounds of |r_uu|, |r_uv|, |r_vv| over a patch.
pub(super) fn swings(derivatives: &Derivatives) -> [f64; 3] {
    let [_, _, uu, uv, vv] = sizes(&derivatives.boxes((0.0, 1.0), (0.0, 1.0)));
    [uu, uv, vv]
}

/// The largest lengths of vectors in boxes.
pub(super) fn sizes(boxes: &[[Interval; 3]; 5]) -> [f64; 5] {
    boxes.map(|d| d.iter().map(|i| i.magnitude() * i.magnitude()).sum::<f64>().sqrt())
}

impl SurfaceTree {
    /// Bounds of |r_u|, |r_v|, |r_uu|, |r_uv|, |r_vv| over a rectangle of a patch.
    #[must_use]
    pub fn derivatives(&self, patch: usize, u: (f64, f64), v: (f64, f64)) -> [f64; 5] {
        sizes(&self.derivatives[patch].boxes(u, v))
    }

    /// How a foot can follow a velocity over a time `h` without leaving its patch.
    #[must_use]
    pub fn slide(&self, foot: &Foot, velocity: Vec3, h: f64) -> Slide {
        let jet = self.net.patches()[foot.patch].jet(foot.uv[0], foot.uv[1]);
        let [a, b, c] = jet.first();
        let (p, q) = (jet.u.dot(&velocity), jet.v.dot(&velocity));
        let det = a * c - b * b;
        let along = |g: f64, p: f64| if g > 0.0 { p / g } else { 0.0 };
        let both =
            if det > 1e-12 * a * c { [(p * c - q * b) / det, (a * q - b * p) / det] } else { [0.0; 2] };
        let stays = |w: &[f64; 2]| (0..2).all(|i| (0.0..=1.0).contains(&(foot.uv[i] + h * w[i])));
        let left = |w: [f64; 2]| velocity - jet.u * w[0] - jet.v * w[1];
        let choices = [both, [along(a, p), 0.0], [0.0, along(c, q)], [0.0; 2]];
        let free = choices.into_iter().filter(stays);
        let rate = free.min_by(|x, y| left(*x).norm().total_cmp(&left(*y).norm())).unwrap_or([0.0; 2]);
        let [uu, uv, vv] = self.swings[foot.patch];
        let [x, y] = rate.map(f64::abs);
        Slide { left: left(rate), curve: uu * x * x + 2.0 * uv * x * y + vv * y * y }
    }
}
