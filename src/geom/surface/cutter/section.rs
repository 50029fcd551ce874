//! Sections of a cutter through its axis.

use super::Cutter;
use crate::math;

impl Cutter {
    /// Radius of its widest place up to a height above the reference point, mm.
    #[must_use]
    pub fn radius_at(&self, height: f64) -> f64 {
        let [sin, cos] = self.side;
        if sin <= 0.0 {
            return self.radius();
        }
        self.radius() + (height + self.corner * sin).max(0.0) * sin / cos
    }

    /// How far from its axis it cuts at a depth above its tip, mm.
    #[must_use]
    pub fn half_width(&self, depth: f64) -> f64 {
        let [sin, cos] = self.side;
        let (r, depth) = (self.corner, depth.max(0.0));
        let ends = r * (1.0 - sin);
        if depth < ends {
            return self.disc + (2.0 * r * depth - depth * depth).max(0.0).sqrt();
        }
        self.radius() + (depth - ends) * sin / cos
    }

    /// Area of its section up to a height above the tip, mm²: what a full cut of this depth takes for every mm of its length.
    #[must_use]
    pub fn section(&self, depth: f64) -> f64 {
        let [sin, cos] = self.side;
        let (r, depth) = (self.corner, depth.max(0.0));
        let ends = r * (1.0 - sin);
        let low = depth.min(ends);
        let round = if r > 0.0 {
            r * r * math::acos(1.0 - low / r) - (r - low) * (2.0 * r * low - low * low).max(0.0).sqrt()
        } else {
            0.0
        };
        let above = depth - low;
        2.0 * self.disc * low + round + above * (2.0 * self.radius() + above * sin / cos)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same by many thin slices of the profile.
    fn sliced(cutter: &Cutter, depth: f64) -> f64 {
        const PARTS: u32 = 20_000;
        let widest = cutter.radius_at(depth - cutter.lift());
        let thin = widest / f64::from(PARTS);
        let high = |k: u32| cutter.profile((f64::from(k) + 0.5) * thin).map_or(f64::MAX, |p| p.height);
        let covered = |k: u32| (depth - cutter.lift() - high(k)).max(0.0);
        2.0 * thin * (0..PARTS).map(covered).sum::<f64>()
    }

    #[test]
    fn it_is_as_wide_at_a_depth_as_its_profile_is_high_there() {
        let cutters = [Cutter::ball(5.0), Cutter::bull(5.0, 1.0), Cutter::taper(2.0, 0.5, 0.5, 0.2)];
        for cutter in cutters {
            for depth in [0.1, 0.3, 0.95] {
                let height = cutter.profile(cutter.half_width(depth)).map_or(f64::MAX, |p| p.height);
                assert!((height + cutter.lift() - depth).abs() < 1e-9, "{cutter:?} {depth}");
            }
        }
        assert_eq!(Cutter::bull(4.0, 0.0).half_width(0.5), 4.0);
        assert_eq!(Cutter::ball(5.0).half_width(2.0), 4.0);
        assert_eq!(Cutter::ball(5.0).half_width(9.0), 5.0);
    }

    #[test]
    fn sections_are_those_of_thin_slices() {
        let cutters = [
            Cutter::ball(5.0),
            Cutter::bull(5.0, 0.0),
            Cutter::bull(5.0, 1.0),
            Cutter::taper(0.0, 1.5, 1.5, 0.1),
            Cutter::taper(2.0, 0.0, 0.0, 0.2),
            Cutter::taper(2.0, 0.5, 0.5, 0.2),
        ];
        for cutter in cutters {
            for depth in [0.1, 0.7, 2.0, 7.0] {
                let (exact, sliced) = (cutter.section(depth), sliced(&cutter, depth));
                assert!((exact / sliced - 1.0).abs() < 1e-3, "{cutter:?} {depth}: {exact} {sliced}");
            }
        }
    }
}
