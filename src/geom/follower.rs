//! Followers: the four kinds of Kim & Yang (1991), sections 2.1–2.4, by envelope theory.
//!
//! Everything is written in the follower's frame: x along the follower's line from the cam's centre, in which
//! the cam turns. With u = (cos t, sin t) and n = (−sin t, cos t) at cam angle t the part sees the same turned
//! by t. v and a are per radian of cam angle.
//!
//! | follower | reference curve | radius |
//! |---|---|---|
//! | translating roller | C = (d₀ + s) u − e n, d₀² = (r_b + r_f)² − e² | roller |
//! | translating flat face | P = (r_b + s) u + v n | 0 |
//! | oscillating roller | C = r_a u(t) − r_r u(t − σψ), ψ = s₀ + s | roller |
//! | oscillating flat face | envelope of the face at distance r_a sin ψ − f from the centre | 0 |

use super::Point2;
use super::Vec2;
use super::cam::CamIssue;
use super::curve::Frenet;
use super::motion::Lift;
use crate::math::{acos, asin, atan, atan2, hypot, sin_cos};

/// The side to which an oscillating follower's arm swings as it lifts, looking from its pivot towards the
/// cam's centre, for a cam that turns clockwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ArmSide {
    /// To the left.
    Left,
    /// To the right: the paper's.
    #[default]
    Right,
}

impl ArmSide {
    /// σ: +1 for the paper's side.
    const fn sign(self) -> f64 {
        match self {
            ArmSide::Left => -1.0,
            ArmSide::Right => 1.0,
        }
    }
}

/// A follower; lengths in mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Follower {
    /// Translating, with a roller.
    TranslatingRoller {
        /// r_f: roller radius.
        radius: f64,
        /// e: the follower's line passes the centre at this distance; positive raises the pressure angle of
        /// the rise.
        offset: f64,
    },
    /// Translating, with a flat face square to its line.
    TranslatingFlat {
        /// e: does not change the profile.
        offset: f64,
    },
    /// Oscillating, with a roller.
    OscillatingRoller {
        /// r_f: roller radius.
        radius: f64,
        /// r_r: from pivot to roller centre.
        arm: f64,
        /// r_a: from cam centre to pivot.
        pivot: f64,
        /// Where the arm swings to.
        side: ArmSide,
    },
    /// Oscillating, with a flat face.
    OscillatingFlat {
        /// r_a: from cam centre to pivot.
        pivot: f64,
        /// f: how far the face lies off the pivot, towards the cam.
        offset: f64,
        /// Where the arm swings to.
        side: ArmSide,
    },
}

impl Follower {
    /// Roller radius, mm; 0 for a flat face.
    #[must_use]
    pub fn roller(&self) -> f64 {
        match self {
            Follower::TranslatingRoller { radius, .. } | Follower::OscillatingRoller { radius, .. } => {
                *radius
            }
            Follower::TranslatingFlat { .. } | Follower::OscillatingFlat { .. } => 0.0,
        }
    }
    /// Whether it has a roller.
    #[must_use]
    pub fn has_roller(&self) -> bool {
        matches!(self, Follower::TranslatingRoller { .. } | Follower::OscillatingRoller { .. })
    }
    /// Whether its lift is an angle.
    #[must_use]
    pub fn oscillates(&self) -> bool {
        matches!(self, Follower::OscillatingRoller { .. } | Follower::OscillatingFlat { .. })
    }
}

/// A follower placed on a base circle: the constants of its equations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Linkage {
    kind: Kind,
    /// Roller radius, mm; 0 for a flat face.
    pub(crate) roller: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    TranslatingRoller { d0: f64, e: f64 },
    TranslatingFlat { base: f64 },
    OscillatingRoller { arm: f64, pivot: f64, s0: f64, sigma: f64 },
    OscillatingFlat { pivot: f64, offset: f64, s0: f64, sigma: f64 },
}

impl Linkage {
    /// The follower on a profile whose smallest radius is `base` mm.
    pub(crate) fn new(follower: &Follower, base: f64) -> Result<Linkage, CamIssue> {
        let kind = match *follower {
            Follower::TranslatingRoller { radius, offset } => translating_roller(base + radius, offset),
            Follower::TranslatingFlat { .. } => Ok(Kind::TranslatingFlat { base }),
            Follower::OscillatingRoller { radius, arm, pivot, side } => {
                oscillating_roller(base, radius, arm, pivot, side.sign())
            }
            Follower::OscillatingFlat { pivot, offset, side } => {
                oscillating_flat(base, pivot, offset, side.sign())
            }
        }?;
        Ok(Linkage { kind, roller: follower.roller() })
    }

    /// Frenet data of the reference curve in the follower's frame: the pitch curve of a roller, the profile of
    /// a flat face. Directed counter-clockwise.
    pub(crate) fn frenet(&self, l: Lift) -> Frenet {
        match self.kind {
            Kind::TranslatingRoller { d0, e } => translating_pitch(d0 + l.s, e, l),
            Kind::TranslatingFlat { base } => envelope(l.s + base, Vec2::new(1.0, 0.0), 1.0, l.v, l.a, 0.0),
            Kind::OscillatingRoller { arm, pivot, s0, sigma } => {
                oscillating_pitch(arm, pivot, s0 + l.s, sigma, l)
            }
            Kind::OscillatingFlat { pivot, offset, s0, sigma } => {
                let psi = s0 + l.s;
                let (sin, cos) = sin_cos(psi);
                let normal = Vec2::new(sin, sigma * cos);
                let (h, dh) = (pivot * sin - offset, pivot * cos * l.v);
                let ddh = pivot * (cos * l.a - sin * l.v * l.v);
                envelope(h, normal, 1.0 - sigma * l.v, dh, ddh, -sigma * l.a)
            }
        }
    }

    /// Pressure angle, signed radians: between the contact normal and the direction in which the contact point
    /// of the follower moves.
    pub(crate) fn pressure_angle(&self, l: Lift) -> f64 {
        match self.kind {
            Kind::TranslatingRoller { d0, e } => atan2(l.v + e, d0 + l.s),
            Kind::TranslatingFlat { .. } => 0.0,
            Kind::OscillatingRoller { arm, pivot, s0, sigma } => {
                let (sin, cos) = sin_cos(s0 + l.s);
                atan2(pivot * cos - arm * (1.0 - sigma * l.v), pivot * sin)
            }
            Kind::OscillatingFlat { offset, .. } => {
                atan(offset / self.face_contact(l).unwrap_or(f64::INFINITY))
            }
        }
    }

    /// Where a flat face is touched, mm: along a translating face from the follower's line, along an
    /// oscillating face from the foot of its pivot. `None` for rollers.
    pub(crate) fn face_contact(&self, l: Lift) -> Option<f64> {
        match self.kind {
            Kind::TranslatingFlat { .. } => Some(l.v),
            Kind::OscillatingFlat { pivot, s0, sigma, .. } => {
                Some(pivot * crate::math::cos(s0 + l.s) / (1.0 - sigma * l.v))
            }
            _ => None,
        }
    }

    /// The follower's position in its own frame, for pictures: pivot (oscillating) and roller centre or, of a
    /// flat face, contact point; and the face's direction.
    pub(crate) fn posture(&self, l: Lift) -> Posture {
        let contact = self.frenet(l);
        match self.kind {
            Kind::TranslatingRoller { .. } => Posture { pivot: None, tip: contact.p, face: None },
            Kind::TranslatingFlat { base } => {
                let tip = Point2::new(base + l.s, 0.0);
                Posture { pivot: None, tip, face: Some(Vec2::new(0.0, 1.0)) }
            }
            Kind::OscillatingRoller { pivot, .. } => {
                Posture { pivot: Some(Point2::new(pivot, 0.0)), tip: contact.p, face: None }
            }
            Kind::OscillatingFlat { pivot, s0, sigma, .. } => {
                let (sin, cos) = sin_cos(s0 + l.s);
                let face = Vec2::new(-cos, sigma * sin);
                Posture { pivot: Some(Point2::new(pivot, 0.0)), tip: contact.p, face: Some(face) }
            }
        }
    }

    /// How far ψ may go, radians: a roller arm must not stretch, a face must stay before its pivot.
    pub(crate) fn swing(&self, l: Lift) -> Option<(f64, f64)> {
        match self.kind {
            Kind::OscillatingRoller { s0, .. } => Some((s0 + l.s, crate::math::PI)),
            Kind::OscillatingFlat { s0, .. } => Some((s0 + l.s, crate::math::PI / 2.0)),
            _ => None,
        }
    }
}

/// Where a follower stands, in its own frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Posture {
    /// Pivot of an oscillating follower.
    pub(crate) pivot: Option<Point2>,
    /// Roller centre, or a point of the face.
    pub(crate) tip: Point2,
    /// Direction of a flat face.
    pub(crate) face: Option<Vec2>,
}

fn translating_roller(reach: f64, e: f64) -> Result<Kind, CamIssue> {
    if e.abs() >= reach {
        return Err(CamIssue::OffsetTooLarge { offset: e, limit: reach });
    }
    Ok(Kind::TranslatingRoller { d0: (reach * reach - e * e).sqrt(), e })
}

/// cos s₀ = (r_a² + r_r² − (r_b + r_f)²)/(2 r_a r_r).
fn oscillating_roller(base: f64, radius: f64, arm: f64, pivot: f64, sigma: f64) -> Result<Kind, CamIssue> {
    let reach = base + radius;
    let (smallest, largest) = ((pivot - arm).abs() - radius, pivot + arm - radius);
    if !(smallest < base && base < largest) {
        return Err(CamIssue::ArmDoesNotReach { base, smallest, largest });
    }
    let s0 = acos((pivot * pivot + arm * arm - reach * reach) / (2.0 * pivot * arm));
    Ok(Kind::OscillatingRoller { arm, pivot, s0, sigma })
}

/// sin s₀ = (r_b + f)/r_a.
fn oscillating_flat(base: f64, pivot: f64, offset: f64, sigma: f64) -> Result<Kind, CamIssue> {
    let reach = base + offset;
    if reach.abs() >= pivot {
        return Err(CamIssue::ArmDoesNotReach { base, smallest: 0.0, largest: pivot - offset });
    }
    Ok(Kind::OscillatingFlat { pivot, offset, s0: asin(reach / pivot), sigma })
}

/// C = Y u − e n: C' = (v + e) u + Y n, κ = [(v+e)(2v+e) − Y(a − Y)]/|C'|³.
fn translating_pitch(y: f64, e: f64, l: Lift) -> Frenet {
    let x = l.v + e;
    let speed = hypot(x, y);
    let bend = x * (2.0 * l.v + e) - y * (l.a - y);
    Frenet { p: Point2::new(y, -e), t: Vec2::new(x, y) / speed, speed, k: bend / (speed * speed * speed) }
}

/// C = r_a u(t) − r_r u(q), q = t − σψ, q' = 1 − σv:
/// C' = r_a n(t) − r_r q' n(q), C'' = −r_a u(t) + r_r (q'² u(q) + σ a n(q)).
fn oscillating_pitch(arm: f64, pivot: f64, psi: f64, sigma: f64, l: Lift) -> Frenet {
    let (sin, cos) = sin_cos(psi);
    let (u, n) = (Vec2::new(cos, -sigma * sin), Vec2::new(sigma * sin, cos));
    let q = 1.0 - sigma * l.v;
    let p = Point2::new(pivot - arm * u.x, -arm * u.y);
    let d1 = Vec2::new(-arm * q * n.x, pivot - arm * q * n.y);
    let d2 = Vec2::new(-pivot, 0.0) + (u * (q * q) + n * (sigma * l.a)) * arm;
    let speed = hypot(d1.x, d1.y);
    Frenet { p, t: d1 / speed, speed, k: super::cross(d1, d2) / (speed * speed * speed) }
}

/// Envelope of the line at distance h from the origin with unit normal N, which turns at the rate w per
/// radian: P = h N + (h'/w) L with L the left normal of N, P' = (h w + h''/w − h' w'/w²) L.
fn envelope(h: f64, normal: Vec2, w: f64, dh: f64, ddh: f64, dw: f64) -> Frenet {
    let tangent = super::left(normal);
    let speed = h * w + ddh / w - dh * dw / (w * w);
    Frenet { p: Point2::from(normal * h + tangent * (dh / w)), t: tangent, speed, k: w / speed }
}
