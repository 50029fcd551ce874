//! Diagrams: axes with ticks, curves, bands.

use super::canvas::{Anchor, Canvas, Pen, Pixel, label};
use super::theme;
use super::world::polyline;

/// A scale with round ticks.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scale {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) step: f64,
    pub(super) decimals: usize,
}

impl Scale {
    /// The scale from `low` to `high` with three to seven round ticks.
    pub(super) fn between(low: f64, high: f64) -> Scale {
        let finite = low.is_finite() && high.is_finite() && high > low;
        let (low, high) = if finite { (low, high) } else { (0.0, 1.0) };
        let step = round_step((high - low) / 7.0);
        Scale { low, high, step, decimals: decimals_of(step) }
    }
    /// A scale with given ends and step.
    pub(super) fn fixed(low: f64, high: f64, step: f64) -> Scale {
        Scale { low, high, step, decimals: decimals_of(step) }
    }
    pub(super) fn ticks(&self) -> Vec<f64> {
        let (first, last) =
            ((self.low / self.step).ceil() as i64, (self.high / self.step + 1e-9).floor() as i64);
        (first..=last.min(first + 100)).map(|i| i as f64 * self.step).collect()
    }
    fn share(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }
}

/// 1, 2 or 5 times a power of ten, not less than `rough`.
pub(super) fn round_step(rough: f64) -> f64 {
    let mut power = 1.0;
    while power > rough && power > 1e-12 {
        power /= 10.0;
    }
    while power * 10.0 <= rough {
        power *= 10.0;
    }
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * power).find(|s| *s >= rough * 0.999).unwrap_or(power * 10.0)
}

fn decimals_of(step: f64) -> usize {
    let mut decimals = 0;
    let mut scaled = step;
    while (scaled - scaled.round()).abs() > 1e-6 * scaled.abs() && decimals < 9 {
        scaled *= 10.0;
        decimals += 1;
    }
    decimals
}

/// A diagram in a rectangle.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Chart {
    pub(super) at: Pixel,
    pub(super) size: Pixel,
    pub(super) x: Scale,
    pub(super) y: Scale,
}

impl Chart {
    pub(super) fn point(&self, x: f64, y: f64) -> Pixel {
        (self.at.0 + self.size.0 * self.x.share(x), self.at.1 + self.size.1 * (1.0 - self.y.share(y)))
    }
    /// Frame, grid, tick labels; those of x only when asked for.
    pub(super) fn axes(&self, canvas: &mut Canvas, x_labels: bool) {
        canvas.rect(self.at, self.size, "#ffffff", None);
        for value in self.x.ticks() {
            let (top, bottom) = (self.point(value, self.y.high), self.point(value, self.y.low));
            canvas.line(top, bottom, theme::GRID);
            if x_labels {
                let at = (bottom.0, bottom.1 + 17.0);
                canvas.text(
                    at,
                    &label(value, self.x.decimals),
                    theme::text(12.0, theme::MUTED, Anchor::Middle),
                );
            }
        }
        for value in self.y.ticks() {
            let (left, right) = (self.point(self.x.low, value), self.point(self.x.high, value));
            canvas.line(left, right, if value == 0.0 { theme::AXIS } else { theme::GRID });
            canvas.text((left.0 - 8.0, left.1 + 4.0), &label(value, self.y.decimals), theme::TICK);
        }
        canvas.rect(self.at, self.size, "none", Some(theme::AXIS));
    }
    /// A vertical strip.
    pub(super) fn shade_x(&self, canvas: &mut Canvas, from: f64, to: f64, color: &str) {
        let (a, b) = (self.point(from, self.y.high), self.point(to, self.y.low));
        canvas.rect(a, (b.0 - a.0, b.1 - a.1), color, None);
    }
    /// A horizontal strip.
    pub(super) fn shade_y(&self, canvas: &mut Canvas, from: f64, to: f64, color: &str) {
        let (a, b) = (self.point(self.x.low, to), self.point(self.x.high, from));
        canvas.rect(a, (b.0 - a.0, b.1 - a.1), color, None);
    }
    pub(super) fn horizontal(&self, canvas: &mut Canvas, y: f64, pen: Pen) {
        canvas.line(self.point(self.x.low, y), self.point(self.x.high, y), pen);
    }
    /// A curve through points, clipped to the rectangle.
    pub(super) fn curve(&self, canvas: &mut Canvas, points: &[(f64, f64)], pen: Pen) {
        let pixels: Vec<Pixel> = points.iter().map(|&(x, y)| self.point(x, y)).collect();
        canvas.clipped(self.at, self.size, |c| c.stroke(&polyline(&pixels), pen));
    }
    /// Name on the left above, figure on the right above.
    pub(super) fn caption(&self, canvas: &mut Canvas, name: &str, figure: &str, color: &'static str) {
        let y = self.at.1 - 7.0;
        canvas.text((self.at.0, y), name, theme::text(14.0, color, Anchor::Start));
        canvas.text((self.at.0 + self.size.0, y), figure, theme::text(13.0, theme::INK, Anchor::End));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_have_a_few_round_ticks() {
        let s = Scale::between(-18.1, 18.1);
        assert_eq!(s.ticks(), [-10.0, 0.0, 10.0]);
        let s = Scale::between(0.0, 20.8);
        assert_eq!(s.ticks(), [0.0, 5.0, 10.0, 15.0, 20.0]);
        assert_eq!(Scale::between(0.0, 0.0314).decimals, 3);
        let flat = Scale::between(0.0, 0.0);
        assert!(flat.high > flat.low);
        for high in [0.37, 1.0, 9.0, 77.0, 1234.5] {
            assert!((3..=8).contains(&Scale::between(0.0, high).ticks().len()), "{high}");
        }
    }
}
