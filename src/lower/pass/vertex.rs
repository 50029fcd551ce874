//! Vertices on the control's grid.

use super::axis_of;
use crate::geom::surface::{Contact, Foot, Guide, Track};
use crate::geom::{Point2, Point3, Vec3};

/// Vertices of passes that meet are no farther apart than this, steps, or half the band.
const NEAR: f64 = 3.0;

/// Walls between which a vertex moves less than this off them, for each step of its own, leave it no room.
const STEEPEST: f64 = 0.05;

/// The grid, as the tip of a ball sees it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lattice {
    /// One step, mm.
    pub step: f64,
    /// Height of the centre above the tip, mm.
    tip: f64,
    /// Axis along which a plane pass runs: vertices keep its other coordinate.
    axis: Option<usize>,
}

/// A vertex of a chain.
#[derive(Debug, Clone, Copy)]
pub(super) struct Vertex {
    /// Tip, in steps.
    pub steps: [i64; 3],
    /// Centre, mm.
    pub centre: Point3,
    /// How far it is from the exact track along the normal, mm.
    pub off: f64,
    /// Foot of the exact track there.
    pub foot: Foot,
    /// Parameter of the track, where it is known.
    pub t: f64,
}

impl Lattice {
    pub(super) fn new(step: f64, tip: f64, guide: &Guide) -> Lattice {
        Lattice { step, tip, axis: axis_of(guide) }
    }

    /// A plane pass with its plane on the grid.
    pub(super) fn snapped(&self, track: &Track) -> Track {
        let Guide::Line { from, to } = track.guide else { return track.clone() };
        let snap = |x: f64| (x / self.step).round() * self.step;
        let [from, to] = [from, to].map(|p| Point2::new(snap(p.x), snap(p.y)));
        Track { guide: Guide::Line { from, to }, ..track.clone() }
    }

    /// The centre of a ball whose tip is at a vertex, mm.
    #[allow(clippy::cast_precision_loss)]
    pub(super) fn centre(&self, steps: [i64; 3]) -> Point3 {
        self.raised(Point3::from(steps.map(|s| s as f64 * self.step)))
    }

    /// The centre of a ball whose tip is at a place.
    pub(super) fn raised(&self, tip: Point3) -> Point3 {
        Point3::new(tip.x, tip.y, tip.z + self.tip)
    }

    /// The place of the grid nearest to the tip of a ball with this centre; `None` beyond what integers hold.
    pub(super) fn nearest(&self, centre: Point3) -> Option<[i64; 3]> {
        let tip = [centre.x, centre.y, centre.z - self.tip].map(|c| (c / self.step).round());
        // Far below 2^63.
        tip.iter().all(|b| b.abs() < 9e15).then(|| tip.map(|b| b as i64))
    }

    /// The vertex near `contact` in the direction `n` of it, whose distance along the normal comes nearest to `off` and lies
    /// in `range`.
    pub(super) fn vertex(&self, contact: &Contact, off: f64, range: (f64, f64), n: Vec3) -> Option<Vertex> {
        let ideal = contact.centre + n * (off / n.dot(&contact.normal).max(0.05));
        let base = self.nearest(ideal)?;
        let mut best: Option<(f64, Vertex)> = None;
        for k in 0..27i64 {
            let shift = [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1];
            if self.kept().is_some_and(|kept| shift[kept] != 0) {
                continue;
            }
            let steps: [i64; 3] = core::array::from_fn(|i| base[i] + shift[i]);
            let centre = self.centre(steps);
            let found = (centre - contact.centre).dot(&contact.normal);
            // A vertex far to the side is no better for a tiny gain in height.
            let cost = (found - off).abs() + 0.02 * (centre - ideal).norm();
            if found >= range.0 && found <= range.1 && best.as_ref().is_none_or(|b| cost < b.0) {
                best = Some((cost, Vertex { steps, centre, off: found, foot: contact.foot, t: f64::NAN }));
            }
        }
        best.map(|b| b.1)
    }

    /// The coordinate that a plane pass keeps.
    pub(super) fn kept(&self) -> Option<usize> {
        self.axis.map(|axis| 1 - axis)
    }

    /// A vertex that is given, where it is as good: within the band, in the pass's plane, and near its `own` one.
    pub(super) fn given(
        &self,
        contact: &Contact,
        steps: [i64; 3],
        range: (f64, f64),
        own: [i64; 3],
    ) -> Option<Vertex> {
        let near = (NEAR * self.step).max(0.5 * (range.1 - range.0));
        let near = (self.centre(steps) - self.centre(own)).norm() <= near;
        let beside = self.kept().is_some_and(|kept| steps[kept] != own[kept]);
        let centre = self.centre(steps);
        let off = (centre - contact.centre).dot(&contact.normal);
        let good = near && !beside && off >= range.0 && off <= range.1;
        good.then_some(Vertex { steps, centre, off, foot: contact.foot, t: f64::NAN })
    }

    /// The direction in which a vertex moves off two walls with these normals alike: in its plane for a plane pass. `None` where
    /// there is none.
    pub(super) fn midway(&self, a: Vec3, b: Vec3) -> Option<Vec3> {
        let middle = match self.axis {
            Some(axis) => {
                let apart = a - b;
                let mut across = Vec3::zeros();
                across[axis] = -apart.z;
                across.z = apart[axis];
                across * across.dot(&a).signum()
            }
            None => a + b,
        };
        middle.try_normalize(1e-9).filter(|n| n.dot(&a).min(n.dot(&b)) > STEEPEST)
    }

    /// The direction in which vertices move off the track: in its plane for a plane pass, else along the normal.
    pub(super) fn sideways(&self, normal: Vec3) -> Vec3 {
        let Some(kept) = self.kept() else { return normal };
        let mut flat = normal;
        flat[kept] = 0.0;
        flat.try_normalize(1e-9).unwrap_or(normal)
    }
}
