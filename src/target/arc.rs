//! Arcs on the output grid.

use crate::math::{TAU, atan2, hypot, sin_cos};

/// An arc in a plane on the grid; `scale` is what its methods call the centre steps in a linear step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GridArc {
    /// Where it starts.
    pub start: [i64; 2],
    /// Where it ends; where it starts, too, in a full circle.
    pub to: [i64; 2],
    /// Its centre from the start, in centre steps.
    pub centre: [i64; 2],
    /// As seen against the plane's third axis.
    pub clockwise: bool,
}

impl GridArc {
    /// Start and end minus the centre, in centre steps.
    pub(crate) fn spokes(&self, scale: i64) -> ([f64; 2], [f64; 2]) {
        let a = [-self.centre[0] as f64, -self.centre[1] as f64];
        let chord = [(self.to[0] - self.start[0]) * scale, (self.to[1] - self.start[1]) * scale];
        (a, [a[0] + chord[0] as f64, a[1] + chord[1] as f64])
    }
    /// Radius at start and end, in centre steps.
    #[must_use]
    pub fn radii(&self, scale: i64) -> (f64, f64) {
        let (a, b) = self.spokes(scale);
        (hypot(a[0], a[1]), hypot(b[0], b[1]))
    }
    /// Two halves of a full circle.
    #[must_use]
    pub fn halves(&self, scale: i64) -> [GridArc; 2] {
        // The point opposite to the start, as exactly as centre steps allow.
        let far = self.centre.map(|c| {
            let twice = 2 * c;
            (twice as f64 / scale as f64).round() as i64
        });
        let middle = [self.start[0] + far[0], self.start[1] + far[1]];
        let back = [self.centre[0] - far[0] * scale, self.centre[1] - far[1] * scale];
        [
            GridArc { to: middle, ..*self },
            GridArc { start: middle, to: self.start, centre: back, clockwise: self.clockwise },
        ]
    }
    /// Points of the arc that are furthest out along an axis, in linear steps; ends not counted.
    #[must_use]
    pub fn extremes(&self, scale: i64) -> Vec<[f64; 2]> {
        let (a, _) = self.spokes(scale);
        let (r0, r1) = self.radii(scale);
        let radius = r0.max(r1) / scale as f64;
        let hub = [0, 1].map(|i| self.start[i] as f64 + self.centre[i] as f64 / scale as f64);
        let (sweep, start) = (self.sweep(scale), atan2(a[1], a[0]));
        let ahead = |angle: f64| if self.clockwise { start - angle } else { angle - start };
        let sides = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)];
        let reached = sides.into_iter().filter(|(c, s)| ahead(atan2(*s, *c)).rem_euclid(TAU) <= sweep);
        reached.map(|(c, s)| [hub[0] + radius * c, hub[1] + radius * s]).collect()
    }
    /// Sweep, 0 < sweep <= 2π, in its own sense.
    #[must_use]
    pub fn sweep(&self, scale: i64) -> f64 {
        if self.start == self.to {
            return TAU;
        }
        let (a, b) = self.spokes(scale);
        let turn = atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
        let turn = if self.clockwise { -turn } else { turn };
        if turn > 0.0 { turn } else { turn + TAU }
    }

    /// The step nearest to the middle of the arc: what a control is told that takes arcs by a place between.
    #[must_use]
    pub fn middle(&self, scale: i64) -> [i64; 2] {
        let (a, _) = self.spokes(scale);
        let (r0, r1) = self.radii(scale);
        let half = 0.5 * self.sweep(scale);
        let (s, c) = sin_cos(if self.clockwise { -half } else { half });
        let stretch = if r0 > 0.0 { 0.5 * (1.0 + r1 / r0) } else { 1.0 };
        let arm = [c * a[0] - s * a[1], s * a[0] + c * a[1]];
        [0, 1].map(|i| self.start[i] + ((arm[i] * stretch - a[i]) / scale as f64).round() as i64)
    }

    /// The centre, in linear steps from the start, of the arc through the start, the middle on the grid, and the end;
    /// `None` where they lie in a line.
    #[must_use]
    pub fn centre_by_middle(&self, scale: i64) -> Option<[f64; 2]> {
        let arm = |p: [i64; 2]| [0, 1].map(|i| (p[i] - self.start[i]) as f64);
        let (p, q) = (arm(self.middle(scale)), arm(self.to));
        let area = 2.0 * (p[0] * q[1] - p[1] * q[0]);
        let (pp, qq) = (p[0] * p[0] + p[1] * p[1], q[0] * q[0] + q[1] * q[1]);
        (area != 0.0).then(|| [(q[1] * pp - p[1] * qq) / area, (p[0] * qq - q[0] * pp) / area])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arcs_are_told_by_their_middle() {
        let arc = GridArc { start: [1000, 0], to: [0, 1000], centre: [-1000, 0], clockwise: false };
        assert_eq!(arc.middle(1), [707, 707]);
        let centre = arc.centre_by_middle(1).expect("an arc");
        assert!(hypot(centre[0] + 1000.0, centre[1]) < 1.0, "{centre:?}");
        let long = GridArc { clockwise: true, ..arc };
        assert_eq!(long.middle(1), [-707, -707]);
        let fine = GridArc { centre: [-10_000, 0], ..arc };
        assert_eq!(fine.middle(10), [707, 707]);
        let flat = GridArc { start: [0, 0], to: [10, 0], centre: [5, 1_000_000], clockwise: false };
        assert_eq!((flat.middle(1), flat.centre_by_middle(1)), ([5, 0], None));
    }
}
