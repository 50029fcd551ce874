//! Parallel projections from space to the canvas.

use crate::geom::{Point3, Vec3};
use crate::plot::canvas::Pixel;

/// A view without perspective.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Camera {
    right: Vec3,
    up: Vec3,
    /// Towards the eye.
    pub(super) eye: Vec3,
    /// Pixel of the part's origin.
    pub(super) origin: Pixel,
    /// Pixels per mm.
    pub(super) scale: f64,
}

impl Camera {
    /// From above: X to the right, Y upwards.
    pub(super) fn plan() -> Camera {
        Camera { right: Vec3::x(), up: Vec3::y(), eye: Vec3::z(), origin: (0.0, 0.0), scale: 1.0 }
    }
    /// From the front left above.
    pub(super) fn oblique() -> Camera {
        let eye = Vec3::new(-0.62, -1.0, 0.78).normalize();
        let right = Vec3::z().cross(&eye).normalize();
        Camera { right, up: eye.cross(&right), eye, origin: (0.0, 0.0), scale: 1.0 }
    }
    /// The same direction, so that the box from `low` to `high` fills the middle of a rectangle but for a margin.
    pub(super) fn fit(self, (low, high): (Point3, Point3), at: Pixel, size: Pixel) -> Camera {
        const MARGIN: f64 = 1.1;
        let corner = |k: usize| {
            let pick = |i: usize| if k >> i & 1 == 0 { low[i] } else { high[i] };
            let p = Vec3::new(pick(0), pick(1), pick(2));
            (p.dot(&self.right), p.dot(&self.up))
        };
        let mut ends = [(f64::INFINITY, f64::NEG_INFINITY); 2];
        for k in 0..8 {
            let (x, y) = corner(k);
            ends[0] = (ends[0].0.min(x), ends[0].1.max(x));
            ends[1] = (ends[1].0.min(y), ends[1].1.max(y));
        }
        let [w, h] = ends.map(|(a, b)| (b - a).max(1e-6) * MARGIN);
        let scale = (size.0 / w).min(size.1 / h);
        let [x, y] = ends.map(|(a, b)| 0.5 * (a + b));
        let middle = (at.0 + 0.5 * size.0, at.1 + 0.5 * size.1);
        Camera { origin: (middle.0 - scale * x, middle.1 + scale * y), scale, ..self }
    }
    /// The pixel of a point.
    pub(super) fn point(&self, p: Point3) -> Pixel {
        let p = p.coords;
        (self.origin.0 + self.scale * p.dot(&self.right), self.origin.1 - self.scale * p.dot(&self.up))
    }
    /// How near a point is to the eye, mm.
    pub(super) fn depth(&self, p: Point3) -> f64 {
        p.coords.dot(&self.eye)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_fills_the_middle_of_its_rectangle() {
        let (low, high) = (Point3::new(-3.0, 2.0, -8.0), Point3::new(40.0, 30.0, 1.0));
        for camera in [Camera::plan(), Camera::oblique()] {
            let fitted = camera.fit((low, high), (100.0, 50.0), (400.0, 300.0));
            for k in 0..8 {
                let pick = |i: usize| if k >> i & 1 == 0 { low[i] } else { high[i] };
                let (x, y) = fitted.point(Point3::new(pick(0), pick(1), pick(2)));
                assert!((100.0..=500.0).contains(&x) && (50.0..=350.0).contains(&y), "{x} {y}");
            }
            assert!(fitted.depth(low + Vec3::z()) > fitted.depth(low));
        }
    }
}
