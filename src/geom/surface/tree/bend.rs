//! Bounds of the Hessian of F(u,v) = |x - r(u,v)|²/2, that is G - (x - r)·D, over a rectangle of a patch.

use crate::geom::Vec3;
use crate::geom::surface::interval::Interval;
use crate::geom::surface::patch::SurfaceJet;

/// What the Hessian of F takes from the derivatives over a rectangle, for any x.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bend {
    /// Bounds of r_u², r_u·r_v, r_v².
    first: [(f64, f64); 3],
    /// Middles and half widths of r_uu, r_uv, r_vv.
    second: [(Vec3, Vec3); 3],
}

/// Bounds of F_uu, F_uv, F_vv.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hessian([Interval; 3]);

/// Relative slack for rounding: a few dozen operations.
const ROUNDING: f64 = 1e-13;

impl Bend {
    pub(super) fn new(derivatives: &[[Interval; 3]; 5]) -> Bend {
        let [ru, rv, ruu, ruv, rvv] = derivatives;
        let square = |a: &[Interval; 3]| a[0].square() + a[1].square() + a[2].square();
        let mixed = ru[0] * rv[0] + ru[1] * rv[1] + ru[2] * rv[2];
        let split = |a: &[Interval; 3]| {
            let middle = a.map(|i| 0.5 * (i.lo + i.hi));
            let half = core::array::from_fn(|k| (a[k].hi - middle[k]).max(middle[k] - a[k].lo));
            (Vec3::from(middle), Vec3::from(half))
        };
        let first = [square(ru), mixed, square(rv)].map(|i| (i.lo, i.hi));
        Bend { first, second: [split(ruu), split(ruv), split(rvv)] }
    }

    /// Bounds of n·r_uu, n·r_uv, n·r_vv over the rectangle.
    pub(super) fn along(&self, n: Vec3) -> [Interval; 3] {
        let size = n.abs();
        self.second.map(|(c, r)| {
            let (value, spread) = (n.dot(&c), size.dot(&r));
            let slack = spread + ROUNDING * (size.dot(&c.abs()) + spread);
            Interval { lo: value - slack, hi: value + slack }
        })
    }

    /// The largest lengths of r_uu, r_uv, r_vv over the rectangle.
    pub(super) fn lengths(&self) -> [f64; 3] {
        self.second.map(|(c, r)| (c.abs() + r).norm() * (1.0 + ROUNDING))
    }

    /// How far a rectangle with these half widths spreads about its middle along each axis, mm.
    pub(super) fn spread(&self, jet: &SurfaceJet, [du, dv]: [f64; 2]) -> Vec3 {
        let [uu, uv, vv] = self.second.map(|(c, r)| c.abs() + r);
        let curved = uu * (0.5 * du * du) + uv * (du * dv) + vv * (0.5 * dv * dv);
        (jet.u.abs() * du + jet.v.abs() * dv + curved) * (1.0 + ROUNDING)
    }

    /// The Hessian for all x - r within `half` of `middle`, over the whole rectangle.
    pub(super) fn hessian(&self, middle: Vec3, half: Vec3) -> Hessian {
        let size = middle.abs();
        Hessian(core::array::from_fn(|k| {
            let ((low, high), (c, r)) = (self.first[k], self.second[k]);
            let value = middle.dot(&c);
            let spread = size.dot(&r) + c.abs().dot(&half) + half.dot(&r);
            let slack = ROUNDING * (size.dot(&c.abs()) + spread + low.abs().max(high.abs()));
            Interval { lo: low - value - spread - slack, hi: high - value + spread + slack }
        }))
    }
}

impl Bend {
    /// Whether F is convex over the rectangle for every x within `reach` of a box that holds its piece of surface.
    pub(super) fn is_convex_within(&self, hull: &[Interval; 3], reach: f64) -> bool {
        let half = Vec3::from(hull.map(|i| (i.hi - i.lo) * (1.0 + ROUNDING) + reach));
        self.hessian(Vec3::zeros(), half).positive([true, true])
    }
}

impl Hessian {
    /// Whether it is certainly positive definite, where only the parameters that are `free` vary.
    pub(super) fn positive(&self, free: [bool; 2]) -> bool {
        let [uu, uv, vv] = &self.0;
        let most = uv.magnitude();
        match free {
            [true, true] => uu.lo > 0.0 && vv.lo > 0.0 && uu.lo * vv.lo > most * most * (1.0 + ROUNDING),
            [true, false] => uu.lo > 0.0,
            [false, true] => vv.lo > 0.0,
            [false, false] => true,
        }
    }

    /// The least that F can differ from its value in the middle of a rectangle with these half widths, where its gradient
    /// there is `g`.
    pub(super) fn least(&self, g: [f64; 2], size: [f64; 2]) -> f64 {
        let [uu, uv, vv] = &self.0;
        let curved = |h: &Interval, d: f64| 0.5 * h.lo.min(0.0) * d * d;
        let fall = |g: f64, d: f64| -g.abs() * d;
        let linear = fall(g[0], size[0]) + fall(g[1], size[1]);
        let square = curved(uu, size[0]) + curved(vv, size[1]) - uv.magnitude() * size[0] * size[1];
        (linear + square) * (1.0 + ROUNDING)
    }

    /// Bounds of the gradient over such a rectangle.
    pub(super) fn slopes(&self, g: [f64; 2], [du, dv]: [f64; 2]) -> [Interval; 2] {
        let [uu, uv, vv] = &self.0;
        let spread = [uu.magnitude() * du + uv.magnitude() * dv, uv.magnitude() * du + vv.magnitude() * dv];
        core::array::from_fn(|k| {
            let spread = spread[k] * (1.0 + ROUNDING) + ROUNDING * g[k].abs();
            Interval { lo: g[k] - spread, hi: g[k] + spread }
        })
    }
}
