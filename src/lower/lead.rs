//! Leads: how the cutter comes to a fitted chain and leaves it, on the grid.
//!
//! A quarter arc is made of a whole vector d from its centre to the chain's end point and the same vector turned
//! by a quarter, so that both ends are exactly as far from the centre and no radius check can fail.

use crate::cl::Lead;
use crate::geom::{Side, Vec2, left};
use crate::target::{FeedWord, Position};
use crate::target::{Motion, Plane};

/// A lead: the point it goes to (or comes from), and how.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LeadPath {
    /// The end away from the chain, in linear steps.
    pub far: [i64; 2],
    /// Arc: centre minus the lead's first point in linear steps, and the sense. `None`: a line.
    pub arc: Option<([i64; 2], bool)>,
}

/// The lead into `start`, where the chain has the unit tangent `tangent`; `step` is a linear step in mm.
pub(super) fn entry(
    lead: Lead,
    start: [i64; 2],
    tangent: Option<Vec2>,
    part: Side,
    step: f64,
) -> Option<LeadPath> {
    let tangent = tangent?;
    match lead {
        Lead::None | Lead::Plunge => None,
        Lead::Line(length) => {
            Some(LeadPath { far: add(start, round(-tangent * (length / step))), arc: None })
        }
        Lead::Arc(radius) => {
            let (spoke, clockwise) = spoke(tangent, part, radius / step)?;
            // A quarter earlier on the circle: the spoke turned back.
            let centre = sub(start, spoke);
            let far = add(centre, if clockwise { quarter_left(spoke) } else { quarter_right(spoke) });
            Some(LeadPath { far, arc: Some((sub(centre, far), clockwise)) })
        }
    }
}

/// The lead out of `end`.
pub(super) fn exit(
    lead: Lead,
    end: [i64; 2],
    tangent: Option<Vec2>,
    part: Side,
    step: f64,
) -> Option<LeadPath> {
    let tangent = tangent?;
    match lead {
        Lead::None | Lead::Plunge => None,
        Lead::Line(length) => Some(LeadPath { far: add(end, round(tangent * (length / step))), arc: None }),
        Lead::Arc(radius) => {
            let (spoke, clockwise) = spoke(tangent, part, radius / step)?;
            let centre = sub(end, spoke);
            let far = add(centre, if clockwise { quarter_right(spoke) } else { quarter_left(spoke) });
            Some(LeadPath { far, arc: Some((sub(centre, end), clockwise)) })
        }
    }
}

/// Whole vector from the centre of a tangent circle on the side away from the part to the point of contact, and
/// whether the circle is run clockwise.
fn spoke(tangent: Vec2, part: Side, radius: f64) -> Option<([i64; 2], bool)> {
    let away = -left(tangent) * part.sign();
    let spoke = round(-away * radius);
    // A circle on the right of travel is run clockwise.
    (spoke != [0, 0]).then_some((spoke, part == Side::Left))
}

/// The motion along a lead.
pub(super) fn motion(lead: &LeadPath, to: Position, feed: FeedWord, centre_per_linear: i64) -> Motion {
    match lead.arc {
        Some((centre, clockwise)) => Motion::Arc {
            to,
            plane: Plane::Xy,
            centre: centre.map(|v| v * centre_per_linear),
            clockwise,
            feed,
        },
        None => Motion::Line { to, feed },
    }
}

/// Chords of a lead's quarter arc that starts at `from`, for controls without arcs: their ends in order. They
/// lie inside the circle and so further from the part than the arc.
pub(super) fn chords(path: &LeadPath, from: [i64; 2], to: [i64; 2]) -> Vec<[i64; 2]> {
    let Some((centre, clockwise)) = path.arc else { return vec![to] };
    let hub = add(from, centre);
    let spoke = Vec2::new(-(centre[0] as f64), -(centre[1] as f64));
    let quarter = if clockwise { -crate::math::PI / 2.0 } else { crate::math::PI / 2.0 };
    let point = |i: u8| {
        let (s, c) = crate::math::sin_cos(quarter * f64::from(i) / f64::from(CHORDS));
        add(hub, round(Vec2::new(c * spoke.x - s * spoke.y, s * spoke.x + c * spoke.y)))
    };
    (1..CHORDS).map(point).chain([to]).collect()
}

/// Chords of a quarter arc.
const CHORDS: u8 = 6;

fn round(v: Vec2) -> [i64; 2] {
    // Leads are at most metres long.
    [v.x.round() as i64, v.y.round() as i64]
}
fn add(a: [i64; 2], b: [i64; 2]) -> [i64; 2] {
    [a[0] + b[0], a[1] + b[1]]
}
fn sub(a: [i64; 2], b: [i64; 2]) -> [i64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}
fn quarter_left(v: [i64; 2]) -> [i64; 2] {
    [-v[1], v[0]]
}
fn quarter_right(v: [i64; 2]) -> [i64; 2] {
    [v[1], -v[0]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_arcs_are_exact_and_on_the_side_away_from_the_part() {
        let t = Vec2::new(0.8, 0.6);
        for part in [Side::Left, Side::Right] {
            let path = entry(Lead::Arc(3.0), [10_000, -2_000], Some(t), part, 0.001).unwrap();
            let (centre, clockwise) = path.arc.unwrap();
            let hub = add(path.far, centre);
            let to_hub = sub(hub, [10_000, -2_000]);
            assert_eq!(centre[0].pow(2) + centre[1].pow(2), to_hub[0].pow(2) + to_hub[1].pow(2));
            let side = t.x * to_hub[1] as f64 - t.y * to_hub[0] as f64;
            assert!(side * part.sign() < 0.0, "the hub lies on the part's side");
            assert_eq!(clockwise, part == Side::Left);
            // The lead starts behind the point and away from the part.
            let back = sub(path.far, [10_000, -2_000]);
            assert!(back[0] as f64 * t.x + back[1] as f64 * t.y < 0.0);
        }
    }
    #[test]
    fn the_way_out_mirrors_the_way_in() {
        let t = Vec2::new(1.0, 0.0);
        let path = exit(Lead::Arc(2.0), [0, 0], Some(t), Side::Left, 0.001).unwrap();
        assert_eq!(path.far, [2_000, -2_000]);
        assert_eq!(path.arc, Some(([0, -2_000], true)));
        let line = exit(Lead::Line(2.0), [0, 0], Some(t), Side::Left, 0.001).unwrap();
        assert_eq!(line, LeadPath { far: [2_000, 0], arc: None });
    }
}
