//! Descent to the point of a patch nearest to a point in space.

use super::{Area, Foot, SETTLED};
use crate::geom::Point3;
use crate::geom::surface::patch::{Patch, SurfaceJet};

/// A point of a patch and its square distance.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub uv: [f64; 2],
    jet: SurfaceJet,
    pub square: f64,
}

impl Place {
    pub fn new(patch: &Patch, x: Point3, uv: [f64; 2]) -> Place {
        let jet = patch.jet(uv[0], uv[1]);
        Place { uv, square: (x - jet.p).norm_squared(), jet }
    }
    pub fn foot(&self, patch: usize) -> Foot {
        let distance = self.square.sqrt();
        Foot { patch, uv: self.uv, point: self.jet.p, distance, certain: distance }
    }
    /// Gradient of F.
    pub fn gradient(&self, x: Point3) -> [f64; 2] {
        let offset = x - self.jet.p;
        [-offset.dot(&self.jet.u), -offset.dot(&self.jet.v)]
    }
    /// Newton's step in the free parameters, or Gauss and Newton's where F is not convex.
    fn step(&self, x: Point3, g: [f64; 2], free: [bool; 2]) -> [f64; 2] {
        let (offset, jet) = (x - self.jet.p, &self.jet);
        let [g11, g12, g22] = jet.first();
        let curved = [g11 - offset.dot(&jet.uu), g12 - offset.dot(&jet.uv), g22 - offset.dot(&jet.vv)];
        let positive = |h: &[f64; 3]| match free {
            [true, true] => h[0] > 0.0 && h[0] * h[2] > h[1] * h[1] * (1.0 + 1e-9),
            [true, false] => h[0] > 0.0,
            _ => h[2] > 0.0,
        };
        let h = if positive(&curved) { curved } else { [g11, g12, g22] };
        match free {
            [true, true] => {
                let det = h[0] * h[2] - h[1] * h[1];
                if det.is_nan() || det <= 0.0 {
                    return [0.0, 0.0];
                }
                [(h[1] * g[1] - h[2] * g[0]) / det, (h[1] * g[0] - h[0] * g[1]) / det]
            }
            [true, false] if h[0] > 0.0 => [-g[0] / h[0], 0.0],
            [false, true] if h[2] > 0.0 => [0.0, -g[1] / h[2]],
            _ => [0.0, 0.0],
        }
    }
}

/// Which parameters may move: not those at an edge that the gradient pushes against.
fn free(uv: [f64; 2], g: [f64; 2], area: &Area) -> [bool; 2] {
    let one = |t: f64, g: f64, (a, b): (f64, f64)| !(t <= a && g >= 0.0 || t >= b && g <= 0.0);
    [one(uv[0], g[0], area.u), one(uv[1], g[1], area.v)]
}

/// Minimises the distance over a rectangle from `start`; exact where F is convex.
pub(super) fn descend(patch: &Patch, x: Point3, start: [f64; 2], area: &Area) -> Place {
    settle(patch, x, start, area).0
}

/// As [`descend`], with whether a local minimum was reached.
pub(super) fn settle(patch: &Patch, x: Point3, start: [f64; 2], area: &Area) -> (Place, bool) {
    const STEPS: u32 = 40;
    let mut at = Place::new(patch, x, area.clamp(start));
    for _ in 0..STEPS {
        let g = at.gradient(x);
        let free = free(at.uv, g, area);
        if free == [false, false] {
            return (at, true);
        }
        let step = at.step(x, g, free);
        // Half of this is what F can still fall by, Newton's decrement.
        let decrement = -(g[0] * step[0] + g[1] * step[1]);
        if decrement < SETTLED * SETTLED {
            // A step of nothing is no sign of a minimum where there is no direction to step in.
            return (at, decrement >= 0.0 && (step != [0.0, 0.0] || g == [0.0, 0.0]));
        }
        let Some(next) = improve(patch, x, &at, step, area) else { return (at, false) };
        at = next;
    }
    (at, false)
}

/// The step, halved until it makes the distance smaller; `None` where it cannot.
fn improve(patch: &Patch, x: Point3, at: &Place, step: [f64; 2], area: &Area) -> Option<Place> {
    let mut part = 1.0;
    for _ in 0..12 {
        let uv = area.clamp([at.uv[0] + part * step[0], at.uv[1] + part * step[1]]);
        let moved = (at.jet.u * (uv[0] - at.uv[0]) + at.jet.v * (uv[1] - at.uv[1])).norm();
        if moved.is_nan() || moved <= 1e-13 {
            return None;
        }
        let next = Place::new(patch, x, uv);
        if next.square <= at.square {
            return Some(next);
        }
        part *= 0.5;
    }
    None
}
