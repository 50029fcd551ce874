//! From the part's plane to the canvas.

use core::fmt::Write as _;

use super::canvas::{Pixel, px};
use crate::geom::Point2;
use crate::geom::curve::{PlanarCurve, spans};

/// A view of the part's plane: millimetres to pixels, y upwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct View {
    /// The pixel of the part's origin.
    pub(super) origin: Pixel,
    /// Pixels per millimetre.
    pub(super) scale: f64,
}

impl View {
    /// The view that shows the box from `low` to `high` in the middle of a rectangle.
    pub(super) fn fit(low: Point2, high: Point2, at: Pixel, size: Pixel) -> View {
        let (w, h) = ((high.x - low.x).max(1e-6), (high.y - low.y).max(1e-6));
        let scale = (size.0 / w).min(size.1 / h);
        let middle = (at.0 + size.0 / 2.0, at.1 + size.1 / 2.0);
        let centre = (0.5 * (low.x + high.x), 0.5 * (low.y + high.y));
        View { origin: (middle.0 - scale * centre.0, middle.1 + scale * centre.1), scale }
    }
    pub(super) fn point(&self, p: Point2) -> Pixel {
        (self.origin.0 + self.scale * p.x, self.origin.1 - self.scale * p.y)
    }
    /// Path data of a whole curve.
    pub(super) fn curve(&self, curve: &dyn PlanarCurve) -> String {
        let mut data = String::new();
        for (span, a, b) in spans(curve) {
            self.span(&mut data, curve, span, (a, b));
        }
        if curve.is_closed() {
            data.push('Z');
        }
        data
    }
    /// Cubic arcs by Hermite's data; a twelfth of a turn each is exact to well below a pixel.
    fn span(&self, data: &mut String, curve: &dyn PlanarCurve, span: usize, (a, b): (f64, f64)) {
        const LARGEST_TURN: f64 = 0.5;
        let turn: f64 = (0..8)
            .map(|i| {
                let f = curve.at_in(span, a + (b - a) * (f64::from(i) + 0.5) / 8.0);
                (f.k * f.speed * (b - a) / 8.0).abs()
            })
            .sum();
        let steps = (turn / LARGEST_TURN).ceil().clamp(4.0, 400.0) as usize;
        let h = (b - a) / steps as f64;
        for i in 0..steps {
            let u = a + h * i as f64;
            let (f, g) = (curve.at_in(span, u), curve.at_in(span, if i + 1 == steps { b } else { u + h }));
            let (p, s) = (self.point(f.p), self.point(g.p));
            let q = self.point(f.p + f.t * (f.speed * h / 3.0));
            let r = self.point(g.p - g.t * (g.speed * h / 3.0));
            if data.is_empty() {
                let _ = write!(data, "M{} {}", px(p.0), px(p.1));
            }
            let c = [q.0, q.1, r.0, r.1, s.0, s.1].map(px);
            let _ = write!(data, "C{} {} {} {} {} {}", c[0], c[1], c[2], c[3], c[4], c[5]);
        }
    }
    /// Path data of a polyline.
    pub(super) fn polyline(&self, points: &[Point2]) -> String {
        polyline(&points.iter().map(|p| self.point(*p)).collect::<Vec<_>>())
    }
}

/// Path data of a polyline of pixels.
pub(super) fn polyline(points: &[Pixel]) -> String {
    let mut data = String::new();
    for (i, p) in points.iter().enumerate() {
        let _ = write!(data, "{}{} {}", if i == 0 { 'M' } else { 'L' }, px(p.0), px(p.1));
    }
    data
}
