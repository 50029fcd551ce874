//! How near the core of a cutter on a straight way comes to the surface.
//!
//! The core swept along a straight way is convex as well: one search tells its distance from the whole surface.

use super::search::{Aim, Search, solve};
use super::{Foot, SurfaceTree};
use crate::geom::extremum::Section;
use crate::geom::surface::cutter::Cutter;
use crate::geom::surface::patch::SurfaceJet;
use crate::geom::{Point3, Vec3};
use crate::math;

/// A core on its way; scores are distances with the sign turned.
struct Sweep<'a> {
    cutter: &'a Cutter,
    from: Point3,
    way: Vec3,
}

/// Where on the way the core comes nearest to a point: share of the way, the point seen from there, distance and
/// outward normal.
struct Nearest {
    share: f64,
    q: Vec3,
    distance: f64,
    normal: Vec3,
}

impl Sweep<'_> {
    fn nearest(&self, q: Point3) -> Nearest {
        let offset = q - self.from;
        let at = |share: f64| {
            let q = offset - self.way * share;
            (self.cutter.outside_core(q), q)
        };
        let share = if self.way.norm_squared() > 0.0 { lowest(&|s| at(s).0.0) } else { 0.0 };
        let ((distance, normal), q) = at(share);
        Nearest { share, q, distance, normal }
    }

    /// Support function of the swept core.
    fn support(&self, n: Vec3) -> f64 {
        self.cutter.core_support(n) + n.dot(&self.from.coords) + n.dot(&self.way).max(0.0)
    }
}

/// Where a convex function is lowest between 0 and 1.
fn lowest(f: &dyn Fn(f64) -> f64) -> f64 {
    const ROUNDS: usize = 34;
    let (a, b) = Section::about_maximum(|s| -f(s), (0.0, 1.0), ROUNDS).ends;
    let middle = 0.5 * (a + b);
    [0.0, 1.0].into_iter().fold(middle, |best, end| if f(end) < f(best) { end } else { best })
}

impl Aim for Sweep<'_> {
    fn in_box(&self, low: [f64; 3], high: [f64; 3]) -> f64 {
        let middle = Vec3::from(core::array::from_fn(|i| 0.5 * (low[i] + high[i])));
        let axis = self.from.coords;
        let flat = self.way.x * self.way.x + self.way.y * self.way.y;
        let along = (middle.x - axis.x) * self.way.x + (middle.y - axis.y) * self.way.y;
        let share = if flat > 0.0 { (along / flat).clamp(0.0, 1.0) } else { 0.0 };
        let off = middle - axis - self.way * share;
        let beside = math::hypot(off.x, off.y);
        let e = if beside > 0.0 { [off.x / beside, off.y / beside] } else { [1.0, 0.0] };
        let bound = |[across, up]: [f64; 2]| {
            let n = Vec3::new(across * e[0], across * e[1], up);
            let least: f64 = (0..3).map(|i| (n[i] * low[i]).min(n[i] * high[i])).sum();
            self.support(n) - least
        };
        let diagonal = core::f64::consts::FRAC_1_SQRT_2;
        [[0.0, -1.0], self.cutter.side_normal(), [diagonal, -diagonal]]
            .map(bound)
            .into_iter()
            .fold(f64::INFINITY, f64::min)
    }
    fn score(&self, q: Point3) -> f64 {
        -self.nearest(q).distance
    }
    fn facing(&self, q: Point3) -> Option<Vec3> {
        Some(-self.nearest(q).normal)
    }
    fn radial(&self, q: Point3, n: Vec3) -> Option<Vec3> {
        let near = self.nearest(q);
        super::rest::radial([near.q.x, near.q.y], n)
    }
    fn plane(&self, n: Vec3) -> Option<(f64, f64)> {
        Some((1.0, self.support(-n)))
    }
    /// Newton's step for the distance over the patch.
    fn step(&self, jet: &SurfaceJet) -> Option<[f64; 2]> {
        let near = self.nearest(jet.p);
        let n = near.normal;
        let bend = self.bend(&near);
        let (bu, bv) = (bend * jet.u, bend * jet.v);
        let h = [
            n.dot(&jet.uu) + jet.u.dot(&bu),
            n.dot(&jet.uv) + jet.u.dot(&bv),
            n.dot(&jet.vv) + jet.v.dot(&bv),
        ];
        let round = h[0] > 0.0 && h[0] * h[2] > h[1] * h[1];
        let step = solve([[h[0], h[1]], [h[1], h[2]]], [-n.dot(&jet.u), -n.dot(&jet.v)]);
        step.filter(|_| round)
    }
}

impl Sweep<'_> {
    /// Second derivatives of the swept core's distance.
    fn bend(&self, near: &Nearest) -> nalgebra::Matrix3<f64> {
        let [round, corner] = self.cutter.core_bend(near.q);
        let e = Vec3::new(-near.q.y, near.q.x, 0.0).try_normalize(0.0).unwrap_or_default();
        let m = near.normal.cross(&e);
        let bend = e * e.transpose() * round + m * m.transpose() * corner;
        let way = bend * self.way;
        let along = way.dot(&self.way);
        // Where the core can follow along its way, the distance does not change.
        if near.share > 0.0 && near.share < 1.0 && along > 1e-12 * self.way.norm_squared() {
            return bend - way * way.transpose() / along;
        }
        bend
    }
}

impl Cutter {
    /// How far a point is outside of this cutter on its way (below zero: inside), and the outward normal there. The
    /// reference point goes from `from` to `to`.
    #[must_use]
    pub fn outside(&self, (from, to): (Point3, Point3), q: Point3) -> (f64, Vec3) {
        let near = Sweep { cutter: self, from, way: to - from }.nearest(q);
        (near.distance - self.corner(), near.normal)
    }
}

impl SurfaceTree {
    /// The point of the surface that the core of a cutter comes nearest to on the way of its reference point, if it comes
    /// nearer than `within` (else any point, and `certain` is `within`). The distance is told to `accuracy`, and below
    /// zero where the core enters the surface. `hint`: a foot near by.
    #[must_use]
    pub fn near(
        &self,
        cutter: &Cutter,
        way: (Point3, Point3),
        within: f64,
        accuracy: f64,
        hint: Option<&Foot>,
    ) -> Foot {
        let aim = Sweep { cutter, from: way.0, way: way.1 - way.0 };
        let mut search = Search::new(self, &aim, accuracy).above(-within);
        if let Some(foot) = hint {
            search.start(foot.patch, foot.uv);
        }
        search.run();
        let certain = -search.bound();
        match search.spot {
            Some(s) => Foot { patch: s.patch, uv: s.uv, point: s.point, distance: -search.best, certain },
            None => Foot { patch: 0, uv: [0.0, 0.0], point: way.0, distance: certain, certain },
        }
    }
}
