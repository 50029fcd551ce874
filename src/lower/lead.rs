//! Leads: how the cutter comes to a fitted chain and leaves it, on the grid.
//!
//! A quarter arc is made of a whole vector d from its centre to the chain's end point and the same vector turned
//! by a quarter, so that both ends are exactly as far from the centre and no radius check can fail.
//!
//! A chain's end lies in the band, not on the curve, and the chain's tangent there is not the curve's: a chord of a
//! hollow runs into the wall when it is drawn longer. So a lead follows the tangent of the exact curve; the chain's own
//! where that is smooth and keeps clear; and where neither does, one turned away from the part by a little ([`Ways`]).

use crate::cl::{Contour, Lead};
use crate::geom::curve::PlanarCurve;
use crate::geom::project::Projector;
use crate::geom::{Point2, Side, Vec2, left};
use crate::math::{DEG, sin_cos};

/// A lead: the point it goes to (or comes from), and how.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LeadPath {
    /// The end away from the chain, in linear steps.
    pub far: [i64; 2],
    /// Arc: centre minus the lead's first point in linear steps, and the sense. `None`: a line.
    pub arc: Option<([i64; 2], bool)>,
}

/// Which end of the chain a lead belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    /// Before its first vertex.
    Entry,
    /// After its last one.
    Exit,
}

/// Finds leads for the ends of a chain that stands for a contour.
pub(super) struct Ways<'a> {
    contour: &'a Contour,
    projector: Projector<'a>,
    /// mm in a linear step.
    step: f64,
}

impl<'a> Ways<'a> {
    pub(super) fn new(contour: &'a Contour, step: f64) -> Ways<'a> {
        /// Pieces that the curve is looked at in.
        const PIECES: usize = 64;
        Ways { contour, projector: Projector::new(contour.curve.as_ref(), PIECES), step }
    }

    /// The lead of the contour at the chain's vertex `at`; `own` is the chain's tangent there where the chain is
    /// smooth. `None`: no lead is asked for, or every one would touch the part.
    pub(super) fn lead(&self, end: End, at: [i64; 2], own: Option<Vec2>) -> Option<LeadPath> {
        let lead = match end {
            End::Entry => self.contour.entry,
            End::Exit => self.contour.exit,
        };
        if matches!(lead, Lead::None | Lead::Plunge) {
            return None;
        }
        let exact = self.tangent(end, at);
        let turned = TURNS.iter().map(|degrees| self.away(exact, end, degrees * DEG));
        own.into_iter()
            .chain([exact])
            .chain(turned)
            .filter_map(|tangent| path(lead, end, at, tangent, self.contour.part, self.step))
            .find(|path| self.is_clear(path, end, at))
    }

    /// Tangent of the exact curve at the foot of a vertex.
    fn tangent(&self, end: End, at: [i64; 2]) -> Vec2 {
        let curve: &dyn PlanarCurve = self.contour.curve.as_ref();
        let (first, last) = curve.domain();
        if curve.is_closed() {
            return curve.at(self.projector.nearest(self.place(at)).u).t;
        }
        match end {
            End::Entry => curve.at(first).t,
            End::Exit => curve.at_in(curve.breaks().len().saturating_sub(2), last).t,
        }
    }

    /// A tangent turned so that the lead lies further from the part.
    fn away(&self, tangent: Vec2, end: End, angle: f64) -> Vec2 {
        let towards = self.contour.part.sign();
        let (s, c) = sin_cos(angle * if end == End::Entry { towards } else { -towards });
        Vec2::new(c * tangent.x - s * tangent.y, s * tangent.x + c * tangent.y)
    }

    fn place(&self, at: [i64; 2]) -> Point2 {
        Point2::new(at[0] as f64 * self.step, at[1] as f64 * self.step)
    }

    /// Whether a lead goes nowhere deeper into the part than the band allows.
    fn is_clear(&self, path: &LeadPath, end: End, at: [i64; 2]) -> bool {
        /// Rounding, mm; a tenth of what the proof allows for it.
        const ROUNDING: f64 = 1e-7;
        let deepest = self.contour.band.into + ROUNDING;
        let part = self.contour.part.sign();
        self.points(path, end, at).all(|p| self.projector.nearest(p).deviation * part <= deepest)
    }

    /// Places along a lead, dense near the contour.
    fn points(&self, path: &LeadPath, end: End, at: [i64; 2]) -> impl Iterator<Item = Point2> {
        const COUNT: i32 = 24;
        let (near, far) = (self.place(at), self.place(path.far));
        let hub = path.arc.map(|(centre, clockwise)| {
            let from = if end == End::Entry { far } else { near };
            let back = (end == End::Entry) != clockwise;
            (from + Vec2::new(centre[0] as f64, centre[1] as f64) * self.step, if back { -1.0 } else { 1.0 })
        });
        (1..=COUNT).map(move |i| {
            let even = f64::from(i) / f64::from(COUNT);
            let share = even * even * even;
            let Some((hub, turn)) = hub else { return near + (far - near) * share };
            let (s, c) = sin_cos(turn * share * crate::math::PI / 2.0);
            let spoke = near - hub;
            hub + Vec2::new(c * spoke.x - s * spoke.y, s * spoke.x + c * spoke.y)
        })
    }
}

/// By how much a lead is turned away from the part where its tangent touches it, degrees.
const TURNS: [f64; 7] = [0.01, 0.03, 0.1, 0.2, 0.5, 1.0, 2.0];

/// The lead at vertex `at` with the unit tangent `tangent`; `step` is a linear step in mm.
fn path(lead: Lead, end: End, at: [i64; 2], tangent: Vec2, part: Side, step: f64) -> Option<LeadPath> {
    let ahead = if end == End::Entry { -1.0 } else { 1.0 };
    match lead {
        Lead::None | Lead::Plunge => None,
        Lead::Line(length) => {
            let far = add(at, round(tangent * (ahead * length / step)));
            (far != at).then_some(LeadPath { far, arc: None })
        }
        Lead::Arc(radius) => {
            let (spoke, clockwise) = spoke(tangent, part, radius / step)?;
            let centre = sub(at, spoke);
            // A quarter earlier (later) on the circle: the spoke turned back (on).
            let leftwards = (end == End::Entry) == clockwise;
            let far = add(centre, if leftwards { quarter_left(spoke) } else { quarter_right(spoke) });
            let first = if end == End::Entry { far } else { at };
            Some(LeadPath { far, arc: Some((sub(centre, first), clockwise)) })
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

/// Chords of a lead's quarter arc that starts at `from`, for controls without arcs: their ends in order. They
/// lie inside the circle and so further from the part than the arc.
pub(super) fn chords(path: &LeadPath, from: [i64; 2], to: [i64; 2]) -> Vec<[i64; 2]> {
    let Some((centre, clockwise)) = path.arc else { return vec![to] };
    let hub = add(from, centre);
    let spoke = Vec2::new(-(centre[0] as f64), -(centre[1] as f64));
    let quarter = if clockwise { -crate::math::PI / 2.0 } else { crate::math::PI / 2.0 };
    let point = |i: u8| {
        let (s, c) = sin_cos(quarter * f64::from(i) / f64::from(CHORDS));
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
            let found = path(Lead::Arc(3.0), End::Entry, [10_000, -2_000], t, part, 0.001).unwrap();
            let (centre, clockwise) = found.arc.unwrap();
            let hub = add(found.far, centre);
            let to_hub = sub(hub, [10_000, -2_000]);
            assert_eq!(centre[0].pow(2) + centre[1].pow(2), to_hub[0].pow(2) + to_hub[1].pow(2));
            let side = t.x * to_hub[1] as f64 - t.y * to_hub[0] as f64;
            assert!(side * part.sign() < 0.0, "the hub lies on the part's side");
            assert_eq!(clockwise, part == Side::Left);
            // The lead starts behind the point and away from the part.
            let back = sub(found.far, [10_000, -2_000]);
            assert!(back[0] as f64 * t.x + back[1] as f64 * t.y < 0.0);
        }
    }
    #[test]
    fn the_way_out_mirrors_the_way_in() {
        let t = Vec2::new(1.0, 0.0);
        let found = path(Lead::Arc(2.0), End::Exit, [0, 0], t, Side::Left, 0.001).unwrap();
        assert_eq!(found.far, [2_000, -2_000]);
        assert_eq!(found.arc, Some(([0, -2_000], true)));
        let line = path(Lead::Line(2.0), End::Exit, [0, 0], t, Side::Left, 0.001).unwrap();
        assert_eq!(line, LeadPath { far: [2_000, 0], arc: None });
    }

    /// A hollow of radius 24 mm with the part around it, cut clockwise inside.
    fn hollow(entry: Lead) -> Contour {
        use crate::geom::curve::CircularArc;
        let circle = CircularArc::circle(Point2::origin(), 24.0, 0.0, true).unwrap();
        Contour {
            curve: std::sync::Arc::new(circle),
            part: Side::Right,
            band: crate::ir::Band { into: 0.01, out: 0.01 },
            interpolation: crate::ir::Interpolation::Linear,
            exact_dwells: false,
            levels: vec![0.0],
            entry,
            exit: entry,
            clearance: 5.0,
            approach: 1.0,
            plunge_feed: None,
            start: None,
        }
    }

    #[test]
    fn leads_in_a_hollow_keep_out_of_the_wall_at_the_deepest_vertex() {
        // A vertex of a chord chain lies as deep as the band allows, and its chord turns into the wall.
        let at = [24_010, 0];
        for lead in [Lead::Arc(6.0), Lead::Line(0.4)] {
            let contour = hollow(lead);
            let ways = Ways::new(&contour, 0.001);
            for end in [End::Entry, End::Exit] {
                let found = ways.lead(end, at, None).unwrap();
                let reach = |p: Point2| p.coords.norm();
                let deepest = ways.points(&found, end, at).map(reach).fold(0.0, f64::max);
                assert!(deepest <= 24.010_001, "{lead:?} {end:?}: {deepest}");
            }
        }
    }

    #[test]
    fn a_lead_that_touches_the_wall_everywhere_is_none() {
        let contour = hollow(Lead::Line(20.0));
        assert_eq!(Ways::new(&contour, 0.001).lead(End::Entry, [24_000, 0], None), None);
    }
}
