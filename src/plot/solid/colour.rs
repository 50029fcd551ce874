//! Colours of signed deviations: blue into the part, white on the surface, orange to brown for what is left. The two hues
//! stay apart for every kind of colour vision, and lightness falls on either side.

use super::mesh::Mesh;
use crate::cl::{Finish, Operation};

/// Red, green, blue.
pub(in crate::plot) type Rgb = [u8; 3];

/// From the surface into the part.
pub(in crate::plot) const INTO: [Rgb; 5] =
    [[252, 251, 247], [198, 219, 239], [107, 174, 214], [33, 113, 181], [8, 48, 107]];
/// From the surface outwards.
pub(in crate::plot) const LEFT: [Rgb; 5] =
    [[252, 251, 247], [253, 226, 178], [245, 178, 94], [214, 112, 22], [140, 62, 6]];
/// More than the scale shows, into the part and outwards.
pub(in crate::plot) const BEYOND: [Rgb; 2] = [[45, 10, 90], [64, 0, 18]];
/// Where nothing is cut.
pub(in crate::plot) const UNCUT: Rgb = [150, 157, 164];

/// Ends of the scale, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::plot) struct Range {
    /// Below 0.
    pub(in crate::plot) low: f64,
    /// Above 0.
    pub(in crate::plot) high: f64,
}

impl Range {
    /// From INTOL to what cusps and OUTTOL allow together; without a height of cusps up to what is left on all but few
    /// places.
    pub(in crate::plot) fn of(operation: &Operation, finish: &Finish, mesh: &Mesh) -> Range {
        let high = match finish.cusp {
            Some(cusp) => cusp + operation.band.out,
            None => most_of(mesh).max(operation.band.out),
        };
        let high = high.max(1e-4);
        Range { low: -operation.band.into.max(0.1 * high), high }
    }

    /// The share of its side of the scale, -1 to 1, beyond that larger.
    fn share(&self, value: f64) -> f64 {
        if value < 0.0 { -value / self.low } else { value / self.high }
    }

    /// Whether the scale shows a deviation; the accuracy of its measurement is not beyond it.
    pub(in crate::plot) fn holds(&self, value: f64) -> bool {
        self.share(value).abs() <= 1.0 + 1e-3
    }

    /// The colour of a deviation, mm; `None` where nothing is cut.
    pub(in crate::plot) fn colour(&self, value: Option<f64>) -> Rgb {
        let Some(value) = value else { return UNCUT };
        let share = self.share(value);
        if !self.holds(value) {
            return BEYOND[usize::from(share > 0.0)];
        }
        let ramp = if share < 0.0 { &INTO } else { &LEFT };
        let place = share.abs().min(1.0) * crate::math::count(ramp.len() - 1);
        let index = (place.floor() as usize).min(ramp.len() - 2);
        let part = place - crate::math::count(index);
        let mix = |k: usize| {
            let (a, b) = (f64::from(ramp[index][k]), f64::from(ramp[index + 1][k]));
            (a + (b - a) * part).round() as u8
        };
        [mix(0), mix(1), mix(2)]
    }
}

/// The largest height, or, where that is far above what is left on 99 of 100 places, twice that.
fn most_of(mesh: &Mesh) -> f64 {
    let mut heights: Vec<f64> = mesh.places().filter_map(|p| p.left).map(|l| l.height).collect();
    heights.sort_by(f64::total_cmp);
    let usual = heights.get(heights.len() * 99 / 100).copied().unwrap_or(0.0);
    heights.last().copied().unwrap_or(0.0).min(2.0 * usual)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lightness_falls_on_both_sides_and_beyond_is_darkest() {
        let range = Range { low: -0.01, high: 0.05 };
        let light = |v: f64| {
            let c = range.colour(Some(v)).map(f64::from);
            0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]
        };
        for side in [-0.01, 0.05] {
            let steps: Vec<f64> = (0..=20).map(|i| light(side * f64::from(i) / 20.0)).collect();
            assert!(steps.windows(2).all(|w| w[1] < w[0]), "{steps:?}");
            assert!(light(side * 1.1) < steps[20]);
        }
        assert_eq!(range.colour(Some(0.0)), INTO[0]);
        assert_eq!(range.colour(None), UNCUT);
    }
}
