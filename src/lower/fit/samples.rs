//! Curves for the tests of fitting: the plate cam's pitch curve, Fourier curves, polygons, and wrappers.

use crate::geom::curve::{Frenet, PlanarCurve, Shape};
use crate::geom::{Point2, Vec2, left};
use crate::math;

/// Position with two derivatives to Frenet data.
fn frenet(p: Vec2, d: Vec2, dd: Vec2) -> Frenet {
    let speed = d.norm();
    Frenet { p: Point2::from(p), t: d / speed, speed, k: crate::geom::cross(d, dd) / (speed * speed * speed) }
}

/// Pitch curve of a translating roller cam with modified sine motion: rise 30-150 deg, return 210-330 deg.
#[derive(Debug)]
pub struct Pitch {
    base: f64,
    lift: f64,
    breaks: Vec<f64>,
}

impl Pitch {
    /// `base`: radius of the pitch circle, mm; `lift`, mm.
    pub fn new(base: f64, lift: f64) -> Pitch {
        let zones = [0.0, 30.0, 45.0, 135.0, 150.0, 210.0, 225.0, 315.0, 330.0, 360.0];
        Pitch { base, lift, breaks: zones.iter().map(|d| d * math::DEG).collect() }
    }
    /// s, v, a per radian in a zone between breaks.
    fn lift(&self, span: usize, u: f64) -> (f64, f64, f64) {
        let beta = 120.0 * math::DEG;
        let (x, sign) = match span {
            0 | 8 => return (0.0, 0.0, 0.0),
            4 => return (self.lift, 0.0, 0.0),
            1..=3 => ((u - 30.0 * math::DEG) / beta, 1.0),
            _ => ((330.0 * math::DEG - u) / beta, -1.0),
        };
        let pi = math::PI;
        let (s, v, a) = match span {
            2 | 6 => {
                let (sin, cos) = math::sin_cos((4.0 * pi * x + pi) / 3.0);
                (2.0 + pi * x - 2.25 * sin, pi - 3.0 * pi * cos, 4.0 * pi * pi * sin)
            }
            zone => {
                let (sin, cos) = math::sin_cos(4.0 * pi * x);
                let whole = if zone == 3 || zone == 5 { 4.0 } else { 0.0 };
                (whole + pi * x - 0.25 * sin, pi - pi * cos, 4.0 * pi * pi * sin)
            }
        };
        let c = self.lift / (4.0 + pi);
        (c * s, c * v * sign / beta, c * a / (beta * beta))
    }
}

impl PlanarCurve for Pitch {
    fn domain(&self) -> (f64, f64) {
        (0.0, math::TAU)
    }
    fn at(&self, u: f64) -> Frenet {
        let span = self.breaks.partition_point(|b| *b <= u).clamp(1, self.breaks.len() - 1) - 1;
        self.at_in(span, u)
    }
    fn at_in(&self, span: usize, u: f64) -> Frenet {
        let (s, v, a) = self.lift(span, u);
        let (sin, cos) = math::sin_cos(u);
        let (radial, around) = (Vec2::new(cos, sin), Vec2::new(-sin, cos));
        let y = self.base + s;
        frenet(radial * y, radial * v + around * y, radial * (a - y) + around * (2.0 * v))
    }
    fn breaks(&self) -> &[f64] {
        &self.breaks
    }
    fn is_closed(&self) -> bool {
        true
    }
}

/// r(θ) = a₀ + Σ aₖ cos kθ + bₖ sin kθ about a centre, over a range of θ.
#[derive(Debug)]
pub struct Fourier {
    /// Centre, mm.
    pub centre: Vec2,
    /// aₖ, bₖ from k = 0 on.
    pub terms: Vec<(f64, f64)>,
    /// Range of θ.
    pub breaks: [f64; 2],
}

impl PlanarCurve for Fourier {
    fn domain(&self) -> (f64, f64) {
        (self.breaks[0], self.breaks[1])
    }
    fn at(&self, u: f64) -> Frenet {
        let (mut r, mut v, mut a) = (0.0, 0.0, 0.0);
        for (k, (c, s)) in self.terms.iter().enumerate() {
            let k = k as f64;
            let (sin, cos) = math::sin_cos(k * u);
            r += c * cos + s * sin;
            v += k * (s * cos - c * sin);
            a -= k * k * (c * cos + s * sin);
        }
        let (sin, cos) = math::sin_cos(u);
        let (radial, around) = (Vec2::new(cos, sin), Vec2::new(-sin, cos));
        frenet(self.centre + radial * r, radial * v + around * r, radial * (a - r) + around * (2.0 * v))
    }
    fn at_in(&self, _: usize, u: f64) -> Frenet {
        self.at(u)
    }
    fn breaks(&self) -> &[f64] {
        &self.breaks
    }
    fn is_closed(&self) -> bool {
        self.breaks[1] - self.breaks[0] > math::TAU - 1e-3
    }
}

/// Straight spans between points; closed when it ends where it starts.
#[derive(Debug)]
pub struct Polygon {
    points: Vec<Vec2>,
    breaks: Vec<f64>,
}

impl Polygon {
    /// Through these points, mm.
    pub fn new(points: &[(f64, f64)]) -> Polygon {
        let breaks = (0..points.len()).map(|i| i as f64).collect();
        Polygon { points: points.iter().map(|p| Vec2::new(p.0, p.1)).collect(), breaks }
    }
}

impl PlanarCurve for Polygon {
    fn domain(&self) -> (f64, f64) {
        (0.0, (self.points.len() - 1) as f64)
    }
    fn at(&self, u: f64) -> Frenet {
        self.at_in((u as usize).min(self.points.len() - 2), u)
    }
    fn at_in(&self, span: usize, u: f64) -> Frenet {
        let (a, b) = (self.points[span], self.points[span + 1]);
        let d = b - a;
        let speed = d.norm();
        Frenet { p: Point2::from(a + d * (u - span as f64)), t: d / speed, speed, k: 0.0 }
    }
    fn breaks(&self) -> &[f64] {
        &self.breaks
    }
    fn shape(&self, _: usize) -> Shape {
        Shape::Line
    }
    fn is_closed(&self) -> bool {
        self.points.first() == self.points.last()
    }
}

/// A curve seen in a mirror (x to -x), turned a quarter, reversed, or started elsewhere.
#[derive(Debug)]
pub struct Seen<C> {
    curve: C,
    how: How,
    breaks: Vec<f64>,
}

/// How a curve is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum How {
    /// x to -x.
    Mirrored,
    /// A quarter turn counter-clockwise.
    Turned,
    /// Travelled the other way.
    Reversed,
}

impl<C: PlanarCurve> Seen<C> {
    /// The curve so seen.
    pub fn new(curve: C, how: How) -> Seen<C> {
        let breaks: Vec<f64> = match how {
            How::Reversed => curve.breaks().iter().rev().map(|b| -b).collect(),
            _ => curve.breaks().to_vec(),
        };
        Seen { curve, how, breaks }
    }
}

impl<C: PlanarCurve> PlanarCurve for Seen<C> {
    fn domain(&self) -> (f64, f64) {
        (self.breaks[0], self.breaks[self.breaks.len() - 1])
    }
    fn at(&self, u: f64) -> Frenet {
        let span = self.breaks.partition_point(|b| *b <= u).clamp(1, self.breaks.len() - 1) - 1;
        self.at_in(span, u)
    }
    fn at_in(&self, span: usize, u: f64) -> Frenet {
        match self.how {
            How::Mirrored => {
                let f = self.curve.at_in(span, u);
                let flip = |v: Vec2| Vec2::new(-v.x, v.y);
                Frenet { p: Point2::from(flip(f.p.coords)), t: flip(f.t), speed: f.speed, k: -f.k }
            }
            How::Turned => {
                let f = self.curve.at_in(span, u);
                Frenet { p: Point2::from(left(f.p.coords)), t: left(f.t), speed: f.speed, k: f.k }
            }
            How::Reversed => self.curve.at_in(self.breaks.len() - 2 - span, -u).reversed(),
        }
    }
    fn breaks(&self) -> &[f64] {
        &self.breaks
    }
    fn is_closed(&self) -> bool {
        self.curve.is_closed()
    }
}
