//! Tests of the arc fit.

mod shapes;
mod survey;
pub(in crate::lower::fit) mod trace;

use std::sync::Arc;

use super::arcs;

use crate::geom::curve::{CurveRef, Frenet, PlanarCurve, Shape};
use crate::geom::{Point2, Vec2};
use crate::lower::fit::{Grid, Tube};
use crate::math;

/// Pitch curve C = (r + s(θ)) u of a plate cam with dwell-rise-dwell-return segments, modified sine.
#[derive(Debug)]
pub(in crate::lower::fit) struct Pitch {
    radius: f64,
    lift: f64,
    breaks: Vec<f64>,
    /// Ends of rise and return.
    rise: (f64, f64),
    fall: (f64, f64),
}

/// Lift, velocity and acceleration of the modified sine over x in 0..1.
fn modified_sine(x: f64) -> (f64, f64, f64) {
    let pi = math::PI;
    let c = pi / (4.0 + pi);
    if x < 0.125 {
        (
            c * (x - math::sin(4.0 * pi * x) / (4.0 * pi)),
            c * (1.0 - math::cos(4.0 * pi * x)),
            c * 4.0 * pi * math::sin(4.0 * pi * x),
        )
    } else if x <= 0.875 {
        let w = 4.0 * pi * x / 3.0 + pi / 3.0;
        (
            c * (2.0 / pi + x - 9.0 / (4.0 * pi) * math::sin(w)),
            c * (1.0 - 3.0 * math::cos(w)),
            c * 4.0 * pi * math::sin(w),
        )
    } else {
        let w = 4.0 * pi * x;
        (
            c * (4.0 / pi + x - math::sin(w) / (4.0 * pi)),
            c * (1.0 - math::cos(w)),
            c * 4.0 * pi * math::sin(w),
        )
    }
}

impl Pitch {
    pub fn paper() -> Pitch {
        Pitch::new(28.0, 20.0, (30.0, 150.0), (210.0, 330.0))
    }
    pub fn new(radius: f64, lift: f64, rise: (f64, f64), fall: (f64, f64)) -> Pitch {
        let d = math::DEG;
        let mut breaks = vec![0.0];
        for (a, b) in [rise, fall] {
            for x in [0.0, 0.125, 0.875, 1.0] {
                breaks.push((a + (b - a) * x) * d);
            }
        }
        breaks.push(360.0 * d);
        breaks.dedup();
        Pitch { radius, lift, breaks, rise: (rise.0 * d, rise.1 * d), fall: (fall.0 * d, fall.1 * d) }
    }
    fn lift(&self, t: f64) -> (f64, f64, f64) {
        let scaled = |x: f64, h: f64| {
            let (s, v, a) = modified_sine(x);
            (self.lift * s, self.lift * v / h, self.lift * a / (h * h))
        };
        if t < self.rise.0 || t > self.fall.1 {
            (0.0, 0.0, 0.0)
        } else if t < self.rise.1 {
            scaled((t - self.rise.0) / (self.rise.1 - self.rise.0), self.rise.1 - self.rise.0)
        } else if t < self.fall.0 {
            (self.lift, 0.0, 0.0)
        } else {
            let h = self.fall.1 - self.fall.0;
            let (s, v, a) = scaled((t - self.fall.0) / h, h);
            (self.lift - s, -v, -a)
        }
    }
}

impl PlanarCurve for Pitch {
    fn shape(&self, span: usize) -> Shape {
        let s = self.lift(0.5 * (self.breaks[span] + self.breaks[span + 1]));
        if s.1 == 0.0 && s.2 == 0.0 {
            Shape::Arc { centre: Point2::origin(), radius: self.radius + s.0, ccw: true }
        } else {
            Shape::General
        }
    }
    fn domain(&self) -> (f64, f64) {
        (0.0, math::TAU)
    }
    fn at(&self, t: f64) -> Frenet {
        let (s, v, a) = self.lift(t);
        let (sin, cos) = math::sin_cos(t);
        let (u, n) = (Vec2::new(cos, sin), Vec2::new(-sin, cos));
        let r = self.radius + s;
        let speed = math::hypot(v, r);
        let k = (r * r + 2.0 * v * v - r * a) / (speed * speed * speed);
        Frenet { p: Point2::from(u * r), t: (u * v + n * r) / speed, speed, k }
    }
    fn at_in(&self, _span: usize, u: f64) -> Frenet {
        self.at(u)
    }
    fn breaks(&self) -> &[f64] {
        &self.breaks
    }
    fn is_closed(&self) -> bool {
        true
    }
}

pub(in crate::lower::fit) fn paper() -> CurveRef {
    Arc::new(Pitch::paper())
}

fn grid(step: f64) -> Grid {
    Grid { step, centre_step: step, angle_step: 0.001 }
}

/// Counts for the paper's cam: 14 and 18 are possible, 16 with the dwells kept.
#[test]
fn papers_cam_needs_few_arcs() {
    let curve = paper();
    for step in [1e-3, 1e-4, 1e-5, 0.00254] {
        for (left, right, exact, most) in
            [(0.01, 0.01, false, 15), (0.01, 0.01, true, 16), (0.01, 0.0, false, 19), (0.0, 0.01, false, 19)]
        {
            let tube = Tube { curve: curve.as_ref(), left, right };
            let fit = arcs(&tube, &grid(step), exact, None).unwrap();
            survey::check("paper", &tube, &grid(step), &fit);
            // Disconnected arcs: 11 are possible with the symmetric band, more with half of it.
            assert!(fit.lower_bound.is_some_and(|b| (8..=18).contains(&b)), "{:?}", fit.lower_bound);
            assert!(fit.primitives.len() <= most, "{step} {left} {right} {exact}: {}", fit.primitives.len());
        }
    }
}

/// Jumps in the third derivative make local optima: these are the best counts known.
#[test]
fn hard_cams_reach_the_best_known_counts() {
    let best = [("paper MODTRAP", 14), ("paper ASYTRAP", 13), ("arm", 14), ("flat", 12), ("paper CA", 12)];
    let cams = survey::cams();
    for (name, most) in best {
        let (_, curve) = cams.iter().find(|(n, _)| n == name).unwrap();
        let tube = Tube { curve: curve.as_ref(), left: 0.01, right: 0.01 };
        let fit = arcs(&tube, &grid(1e-3), false, None).unwrap();
        survey::check(name, &tube, &grid(1e-3), &fit);
        assert!(fit.primitives.len() <= most, "{name}: {}", fit.primitives.len());
    }
}

/// Arcs of long flat curves are flatter than the largest radius of small ones.
#[test]
fn curves_of_a_hundred_metres_are_fitted() {
    let curve = Pitch::new(1.7e5, 5e4, (30.0, 150.0), (210.0, 330.0));
    for band in [0.5, 10.0] {
        let tube = Tube { curve: &curve, left: band, right: band };
        let fit = arcs(&tube, &grid(1e-3), false, None).unwrap();
        survey::check("long", &tube, &grid(1e-3), &fit);
        assert!(fit.lower_bound.is_some_and(|b| fit.primitives.len() <= 2 * b as usize), "{fit:?}");
    }
}
