//! How near the core of a cutter on a straight way comes to the surface.
//!
//! The core swept along a straight way is convex as well: one search tells its distance from the whole surface.

use core::cell::Cell;

use super::search::{Aim, Search, solve};
use super::{Foot, SurfaceTree};
use crate::geom::surface::cutter::{Cutter, length};
use crate::geom::surface::patch::SurfaceJet;
use crate::geom::{Point3, Vec3};

/// A core on its way; scores are distances with the sign turned.
struct Sweep<'a> {
    cutter: &'a Cutter,
    from: Point3,
    way: Vec3,
    /// The point asked about last: much is asked about each.
    last: Cell<Option<(Point3, Nearest)>>,
}

/// Where on the way the core comes nearest to a point: share of the way, the point seen from there, distance and
/// outward normal.
#[derive(Clone, Copy)]
struct Nearest {
    share: f64,
    q: Vec3,
    distance: f64,
    normal: Vec3,
}

/// Rounds in which the nearest place of a way is found, at most.
const ROUNDS: u32 = 60;
/// Distances that agree so well are the same, mm.
const SAME: f64 = 1e-12;

impl<'a> Sweep<'a> {
    fn new(cutter: &'a Cutter, (from, to): (Point3, Point3)) -> Sweep<'a> {
        Sweep { cutter, from, way: to - from, last: Cell::new(None) }
    }

    fn at(&self, offset: Vec3, share: f64) -> Nearest {
        let q = offset - self.way * share;
        let (distance, normal) = self.cutter.outside_core(q);
        Nearest { share, q, distance, normal }
    }

    fn nearest(&self, q: Point3) -> Nearest {
        if let Some((_, near)) = self.last.get().filter(|(last, _)| *last == q) {
            return near;
        }
        let near = self.find(q);
        self.last.set(Some((q, near)));
        near
    }

    /// The distance is convex along the way, with the slope -n·way: where that changes its sign, by the rule of false
    /// position (with Illinois' weights), until the tangents at both sides leave nothing below.
    fn find(&self, q: Point3) -> Nearest {
        let offset = q - self.from;
        let slope = |near: &Nearest| -near.normal.dot(&self.way);
        let mut a = self.at(offset, 0.0);
        let mut low = slope(&a);
        if low >= 0.0 {
            return a;
        }
        let mut b = self.at(offset, 1.0);
        let mut high = slope(&b);
        if high <= 0.0 {
            return b;
        }
        let (mut weights, mut moved) = ((-low, high), false);
        for _ in 0..ROUNDS {
            let width = b.share - a.share;
            let crossing = a.distance + low * (b.distance - a.distance - high * width) / (low - high);
            if a.distance.min(b.distance) - crossing <= SAME {
                break;
            }
            let middle = self.at(offset, a.share + width * (weights.0 / (weights.0 + weights.1)));
            let bend = slope(&middle);
            if bend < 0.0 {
                weights = (-bend, if moved { 0.5 * weights.1 } else { high });
                (a, low, moved) = (middle, bend, true);
            } else {
                weights = (if moved { -low } else { 0.5 * weights.0 }, bend);
                (b, high, moved) = (middle, bend, false);
            }
        }
        if a.distance <= b.distance { a } else { b }
    }

    /// Support function of the swept core.
    fn support(&self, n: Vec3) -> f64 {
        self.cutter.core_support(n) + n.dot(&self.from.coords) + n.dot(&self.way).max(0.0)
    }
}

impl Aim for Sweep<'_> {
    fn in_box(&self, low: [f64; 3], high: [f64; 3]) -> f64 {
        let middle = Vec3::from(core::array::from_fn(|i| 0.5 * (low[i] + high[i])));
        let axis = self.from.coords;
        let flat = self.way.x * self.way.x + self.way.y * self.way.y;
        let along = (middle.x - axis.x) * self.way.x + (middle.y - axis.y) * self.way.y;
        let share = if flat > 0.0 { (along / flat).clamp(0.0, 1.0) } else { 0.0 };
        let off = middle - axis - self.way * share;
        let beside = length(off.x, off.y);
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
    fn along_rim(&self, q: Point3) -> Option<Vec3> {
        let near = self.nearest(q);
        if near.share <= 0.0 || near.share >= 1.0 {
            return None;
        }
        let e = Vec3::new(near.q.x, near.q.y, 0.0).try_normalize(0.0)?;
        let n = (e * self.way.z - Vec3::z() * e.dot(&self.way)).try_normalize(1e-9)?;
        let n = if n.z < 0.0 { -n } else { n };
        (n.dot(&e) <= 0.0).then_some(n)
    }
    fn plane(&self, n: Vec3) -> Option<(f64, f64)> {
        Some((1.0, self.support(-n)))
    }
    fn sizes(&self) -> [f64; 4] {
        let radius = self.cutter.corner() + self.cutter.flat();
        [4.0 * radius, radius, 0.25 * radius, 0.06 * radius]
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
    pub fn outside(&self, way: (Point3, Point3), q: Point3) -> (f64, Vec3) {
        let near = Sweep::new(self, way).find(q);
        (near.distance - self.corner(), near.normal)
    }

    /// How far a point must go along `n` to enter this cutter on its way, from `start` on; infinite where it does not
    /// within `most` mm.
    #[must_use]
    pub fn enters(&self, way: (Point3, Point3), (p, n): (Point3, Vec3), (start, most): (f64, f64)) -> f64 {
        const STEPS: u32 = 60;
        const TOUCHES: f64 = 1e-8;
        let mut t = start;
        for _ in 0..STEPS {
            let (d, normal) = self.outside(way, p + n * t);
            if d <= TOUCHES {
                return t + TOUCHES;
            }
            let rate = normal.dot(&n);
            // The distance is convex along the normal: its tangent never leads into the cutter.
            if rate > -1e-6 || t > start + most {
                return f64::INFINITY;
            }
            t -= d / rate;
        }
        f64::INFINITY
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
        let aim = Sweep::new(cutter, way);
        let search = Search::new(self, &aim, accuracy).above(-within).run(hint);
        let certain = -search.bound();
        match search.spot {
            Some(s) => Foot { patch: s.patch, uv: s.uv, point: s.point, distance: -search.best, certain },
            None => Foot { patch: 0, uv: [0.0, 0.0], point: way.0, distance: certain, certain },
        }
    }

    /// Whether the core of a cutter on the way of its reference point comes nearer to the surface than `distance`, which is
    /// a little less than `within`; yes as well where it cannot be told that it stays farther away than `within`.
    #[must_use]
    pub fn comes_nearer(
        &self,
        cutter: &Cutter,
        way: (Point3, Point3),
        (within, distance): (f64, f64),
        hint: Option<&Foot>,
    ) -> bool {
        let aim = Sweep::new(cutter, way);
        let search = Search::new(self, &aim, within - distance).above(-within).until(-distance).run(hint);
        search.best > -distance || search.gave_up()
    }

    /// The point near `hint` that the core of a cutter with its reference point at `x` comes nearest to, or one on the way
    /// there: the surface is no farther away.
    #[must_use]
    pub fn beside(&self, cutter: &Cutter, x: Point3, hint: &Foot) -> Foot {
        let aim = Sweep::new(cutter, (x, x));
        let mut search = Search::new(self, &aim, SAME);
        search.start(hint);
        match search.spot {
            Some(s) => {
                Foot { patch: s.patch, uv: s.uv, point: s.point, distance: -search.best, certain: 0.0 }
            }
            None => *hint,
        }
    }
}
