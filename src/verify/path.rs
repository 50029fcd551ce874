//! The primitives that a control draws, with derivatives and their bounds.

use crate::geom::{Point2, Vec2};
use crate::math::{TAU, atan2, sin_cos};
use crate::readback::TracePath;

/// A primitive over x in 0..1.
#[derive(Debug, Clone)]
pub(super) enum Primitive {
    /// Straight.
    Line {
        /// Start.
        from: Point2,
        /// End minus start.
        step: Vec2,
    },
    /// Radius and angle about a centre both linear in x: a control's arc, and a rotary table's spiral.
    Polar {
        /// Centre.
        centre: Point2,
        /// Radius at the start and its change, mm.
        radius: (f64, f64),
        /// Angle at the start and its change, radians.
        angle: (f64, f64),
    },
    /// An arc about an axis that is not Z, seen along Z: p = centre + (r0 + dr x) (u cos wx + v sin wx) + rise x.
    Tilted {
        /// Centre.
        centre: Point2,
        /// Radius at the start and its change, mm.
        radius: (f64, f64),
        /// The unit vectors across the axis, as seen.
        frame: (Vec2, Vec2),
        /// Sweep, radians.
        sweep: f64,
        /// Way along the axis, as seen.
        rise: Vec2,
    },
    /// Rational Bézier segment: homogeneous control points (w x, w y, w).
    Rational {
        /// Control points.
        points: Vec<[f64; 3]>,
        /// Bounds on the lengths of the first three derivatives.
        bounds: [f64; 3],
    },
}

/// Point and derivatives with respect to x.
#[derive(Debug, Clone, Copy)]
pub(super) struct Jet {
    /// Point, mm.
    pub p: Point2,
    /// First derivative.
    pub v: Vec2,
    /// Second derivative.
    pub a: Vec2,
}

impl Primitive {
    /// The primitives of a trace path, in order: one, or the Bézier segments of a NURBS curve.
    pub(super) fn of(path: &TracePath) -> Vec<Primitive> {
        match path {
            TracePath::Line { from, to } => vec![Primitive::Line { from: *from, step: to - from }],
            TracePath::Arc { from, to, centre, sweep } => {
                let (r0, r1) = (from - centre, to - centre);
                let radius = (r0.norm(), r1.norm() - r0.norm());
                vec![Primitive::Polar { centre: *centre, radius, angle: (atan2(r0.y, r0.x), *sweep) }]
            }
            TracePath::Tilted(arc) => {
                let (r0, r1) = arc.radii();
                let (u, v) = arc.frame();
                vec![Primitive::Tilted {
                    centre: arc.centre.xy(),
                    radius: (r0, r1 - r0),
                    frame: (u.xy(), v.xy()),
                    sweep: arc.sweep,
                    rise: arc.axis.xy() * arc.rise(),
                }]
            }
            TracePath::Spiral { radius, angle } => vec![Primitive::Polar {
                centre: Point2::origin(),
                radius: (radius.0, radius.1 - radius.0),
                angle: (angle.0, angle.1 - angle.0),
            }],
            TracePath::Space(curve) => {
                let flat: Vec<Point2> = curve.points.iter().map(|p| p.xy()).collect();
                super::spline::segments(usize::from(curve.order), &flat, &curve.weights, &curve.knots)
            }
            TracePath::Nurbs { order, points, weights, knots } => {
                super::spline::segments(usize::from(*order), points, weights, knots)
            }
        }
    }

    /// Point and derivatives at x.
    pub(super) fn at(&self, x: f64) -> Jet {
        match self {
            Primitive::Line { from, step } => Jet { p: from + step * x, v: *step, a: Vec2::zeros() },
            Primitive::Polar { centre, radius, angle } => {
                let (r, w) = (radius.0 + radius.1 * x, angle.1);
                let (s, c) = sin_cos(angle.0 + w * x);
                let (e, q) = (Vec2::new(c, s), Vec2::new(-s, c));
                let a = q * (2.0 * radius.1 * w) - e * (r * w * w);
                Jet { p: centre + e * r, v: e * radius.1 + q * (r * w), a }
            }
            Primitive::Tilted { centre, radius, frame: (u, v), sweep, rise } => {
                let (r, w) = (radius.0 + radius.1 * x, *sweep);
                let (s, c) = sin_cos(w * x);
                let (e, q) = (u * c + v * s, v * c - u * s);
                let a = q * (2.0 * radius.1 * w) - e * (r * w * w);
                Jet { p: centre + e * r + rise * x, v: e * radius.1 + q * (r * w) + rise, a }
            }
            Primitive::Rational { points, .. } => super::spline::jet(points, x),
        }
    }

    /// Upper bounds on the lengths of the first three derivatives over 0..1.
    pub(super) fn bounds(&self) -> [f64; 3] {
        match self {
            Primitive::Line { step, .. } => [step.norm(), 0.0, 0.0],
            Primitive::Polar { radius, angle, .. } => polar_bounds(*radius, angle.1),
            Primitive::Tilted { radius, sweep, rise, .. } => {
                let [first, second, third] = polar_bounds(*radius, *sweep);
                [first + rise.norm(), second, third]
            }
            Primitive::Rational { bounds, .. } => *bounds,
        }
    }

    /// Into how many parts it must be cut so that none turns by more than an eighth of a turn or is longer than `most` mm.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    pub(super) fn parts(&self, most: f64) -> usize {
        let turn = match self {
            Primitive::Polar { angle, .. } => angle.1.abs() / (TAU / 8.0),
            Primitive::Tilted { sweep, .. } => sweep.abs() / (TAU / 8.0),
            Primitive::Line { .. } | Primitive::Rational { .. } => 1.0,
        };
        let long = self.bounds()[0] / most.max(1e-6);
        turn.max(long).ceil().clamp(1.0, 4096.0) as usize
    }
}

/// Bounds on the derivatives of a polar primitive whose angle changes by `sweep`.
pub(super) fn polar_bounds(radius: (f64, f64), sweep: f64) -> [f64; 3] {
    let r = radius.0.abs().max((radius.0 + radius.1).abs());
    let (dr, w) = (radius.1.abs(), sweep.abs());
    [dr + r * w, 2.0 * dr * w + r * w * w, 3.0 * dr * w * w + r * w * w * w]
}
