//! Closed forms that normalised motions are made of.

use super::Lift;
use crate::math::{PI, sin_cos};

/// Coefficients of a polynomial of degree 7 at most, constant first.
pub(crate) type Coefficients = [f64; 8];

/// A closed form on one zone; q is measured from the zone's start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Form {
    /// No motion.
    Rest,
    /// Σ cᵢ qⁱ.
    Polynomial(Coefficients),
    /// Acceleration a sin(w q + p), entered with lift s0 and velocity v0.
    Sine { s0: f64, v0: f64, a: f64, w: f64, p: f64 },
    /// c0 + c1 cos(π q) + c2 cos(2π q).
    Cosines { c0: f64, c1: f64, c2: f64 },
}

impl Form {
    /// Lift and derivatives at q.
    pub(crate) fn at(&self, q: f64) -> Lift {
        match self {
            Form::Rest => Lift::default(),
            Form::Polynomial(c) => polynomial(c, q),
            Form::Sine { s0, v0, a, w, p } => sine(*s0, *v0, *a, *w, *p, q),
            Form::Cosines { c0, c1, c2 } => cosines(*c0, *c1, *c2, q),
        }
    }
}

/// Value and three derivatives by Horner's scheme.
fn polynomial(c: &Coefficients, q: f64) -> Lift {
    let (mut s, mut v, mut a, mut j) = (0.0, 0.0, 0.0, 0.0);
    for c in c.iter().rev() {
        j = j * q + 3.0 * a;
        a = a * q + 2.0 * v;
        v = v * q + s;
        s = s * q + c;
    }
    Lift { s, v, a, j }
}

fn sine(s0: f64, v0: f64, a: f64, w: f64, p: f64, q: f64) -> Lift {
    let (sin0, cos0) = sin_cos(p);
    let (sin1, cos1) = sin_cos(w * q + p);
    let b = a / w;
    Lift {
        s: s0 + (v0 + b * cos0) * q - b / w * (sin1 - sin0),
        v: v0 + b * (cos0 - cos1),
        a: a * sin1,
        j: a * w * cos1,
    }
}

fn cosines(c0: f64, c1: f64, c2: f64, q: f64) -> Lift {
    let (s1, k1) = sin_cos(PI * q);
    let (s2, k2) = sin_cos(2.0 * PI * q);
    let (w1, w2) = (PI, 2.0 * PI);
    Lift {
        s: c0 + c1 * k1 + c2 * k2,
        v: -c1 * w1 * s1 - c2 * w2 * s2,
        a: -c1 * w1 * w1 * k1 - c2 * w2 * w2 * k2,
        j: c1 * w1 * w1 * w1 * s1 + c2 * w2 * w2 * w2 * s2,
    }
}

/// A closed form on [from, to] of the normalised motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Piece {
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) form: Form,
}

impl Piece {
    /// At x, which is measured from the motion's start.
    pub(crate) fn at(&self, x: f64) -> Lift {
        self.form.at(x - self.from)
    }
}

/// Makino's universal curve by its zone ends T1…T6: acceleration A1 sin, A1, A1 cos, 0, −A2 sin, −A2, −A2 cos
/// (quarter waves), A1 and A2 from V(1) = 0 and S(1) = 1. Zones of no length are left out.
///
/// Source: H. Makino, *Automatic machine kinematics* (universal cam curve).
pub(crate) fn universal(t: [f64; 6]) -> Vec<Piece> {
    let unit = |a1: f64, a2: f64| {
        let pieces = zones(&t, a1, a2);
        pieces.last().map_or(Lift::default(), |p| p.at(1.0))
    };
    // V(1) and S(1) are linear in A1 and A2.
    let (first, second) = (unit(1.0, 0.0), unit(0.0, 1.0));
    let determinant = first.v * second.s - second.v * first.s;
    zones(&t, -second.v / determinant, first.v / determinant)
}

fn zones(t: &[f64; 6], a1: f64, a2: f64) -> Vec<Piece> {
    let bounds = [0.0, t[0], t[1], t[2], t[3], t[4], t[5], 1.0];
    let mut pieces: Vec<Piece> = Vec::new();
    let mut state = Lift::default();
    for zone in 0..7 {
        let (from, to) = (bounds[zone], bounds[zone + 1]);
        if to > from {
            let piece = Piece { from, to, form: zone_form(zone, to - from, a1, a2, state) };
            state = piece.at(to);
            pieces.push(piece);
        }
    }
    pieces
}

/// The form of zone 0…6, entered with the lift and velocity of `state`.
fn zone_form(zone: usize, length: f64, a1: f64, a2: f64, state: Lift) -> Form {
    let (s0, v0, w) = (state.s, state.v, PI / 2.0 / length);
    let constant = |a: f64| Form::Polynomial([s0, v0, a / 2.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    match zone {
        0 => Form::Sine { s0, v0, a: a1, w, p: 0.0 },
        1 => constant(a1),
        2 => Form::Sine { s0, v0, a: a1, w, p: PI / 2.0 },
        3 => constant(0.0),
        4 => Form::Sine { s0, v0, a: -a2, w, p: 0.0 },
        5 => constant(-a2),
        _ => Form::Sine { s0, v0, a: -a2, w, p: PI / 2.0 },
    }
}
