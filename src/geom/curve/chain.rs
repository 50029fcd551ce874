//! Curves one after the other.

use super::{CurveRef, Frenet, PlanarCurve, Shape, ends, span_of};
use crate::geom::{Point2, cross};
use crate::math::{atan2, hypot};

/// Curves that follow each other, joined smoothly or in corners, open or closed.
///
/// The parameter runs through the members' own parameters, one after the other, from 0.
#[derive(Debug, Clone)]
pub struct Chain {
    members: Vec<Member>,
    /// Breaks of all members, in the chain's parameter.
    breaks: Vec<f64>,
    /// Member and its own span, for every span of the chain.
    spans: Vec<(usize, usize)>,
    closed: bool,
}

#[derive(Debug, Clone)]
struct Member {
    curve: CurveRef,
    /// Chain parameter minus the member's parameter.
    shift: f64,
}

/// Why curves do not make a chain.
#[derive(Debug, Clone, PartialEq)]
pub enum ChainError {
    /// There is no curve.
    Empty,
    /// Member `after` ends at `from`, and the next one starts at `to`.
    Gap {
        /// Index of the member before the gap.
        after: usize,
        /// Where it ends, mm.
        from: Point2,
        /// Where the next one starts, mm.
        to: Point2,
        /// Distance, mm.
        distance: f64,
    },
}

/// How two smooth spans meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Joint {
    /// Parameter.
    pub u: f64,
    /// Place, mm.
    pub p: Point2,
    /// Turn of the tangent, radians, left positive; 0 for a smooth joint.
    pub turn: f64,
    /// Jump of the curvature, 1/mm.
    pub bend: f64,
}

impl Chain {
    /// Joins curves whose ends meet within `join_tolerance` mm; the chain is closed when its last end meets
    /// its first start as nearly.
    ///
    /// # Errors
    /// [`ChainError`] when there is no curve or a gap between two of them.
    pub fn new(curves: Vec<CurveRef>, join_tolerance: f64) -> Result<Chain, ChainError> {
        let mut chain = Chain { members: Vec::new(), breaks: vec![0.0], spans: Vec::new(), closed: false };
        let mut meets: Option<Point2> = None;
        let first = curves.first().map(|c| ends(c.as_ref()).0).ok_or(ChainError::Empty)?;
        for (index, curve) in curves.into_iter().enumerate() {
            let (from, to) = ends(curve.as_ref());
            if let Some(end) = meets {
                check_gap(index - 1, end, from, join_tolerance)?;
            }
            meets = Some(to);
            chain.push(curve);
        }
        chain.closed = meets.is_some_and(|end| distance(end, first) <= join_tolerance);
        Ok(chain)
    }
    fn push(&mut self, curve: CurveRef) {
        let start = self.breaks.last().copied().unwrap_or(0.0);
        let shift = start - curve.domain().0;
        let member = self.members.len();
        self.breaks.extend(curve.breaks().iter().skip(1).map(|b| b + shift));
        self.spans.extend((0..curve.breaks().len().saturating_sub(1)).map(|span| (member, span)));
        self.members.push(Member { curve, shift });
    }
    /// The member curves, in order.
    pub fn members(&self) -> impl Iterator<Item = &CurveRef> {
        self.members.iter().map(|m| &m.curve)
    }
}

fn distance(a: Point2, b: Point2) -> f64 {
    hypot(a.x - b.x, a.y - b.y)
}

fn check_gap(after: usize, from: Point2, to: Point2, tolerance: f64) -> Result<(), ChainError> {
    let distance = distance(from, to);
    if distance <= tolerance { Ok(()) } else { Err(ChainError::Gap { after, from, to, distance }) }
}

impl Joint {
    /// The joints at all inner breaks of a curve, and at its start when it is closed.
    #[must_use]
    pub fn all(curve: &dyn PlanarCurve) -> Vec<Joint> {
        let breaks = curve.breaks();
        let last = breaks.len().saturating_sub(2);
        let inner = (1..breaks.len().saturating_sub(1)).map(|i| (i - 1, breaks[i], i, breaks[i]));
        let (a, b) = curve.domain();
        let closing = curve.is_closed().then_some((last, b, 0, a));
        closing
            .into_iter()
            .chain(inner)
            .map(|(before, u_before, after, u)| {
                joint(u, curve.at_in(before, u_before), curve.at_in(after, u))
            })
            .collect()
    }
}

fn joint(u: f64, before: Frenet, after: Frenet) -> Joint {
    let turn = atan2(cross(before.t, after.t), before.t.dot(&after.t));
    Joint { u, p: after.p, turn, bend: after.k - before.k }
}

impl PlanarCurve for Chain {
    fn domain(&self) -> (f64, f64) {
        (0.0, self.breaks[self.breaks.len() - 1])
    }
    fn at(&self, u: f64) -> Frenet {
        self.at_in(span_of(&self.breaks, u), u)
    }
    fn at_in(&self, span: usize, u: f64) -> Frenet {
        let (member, own) = self.spans[span];
        let Member { curve, shift } = &self.members[member];
        let (a, b) = curve.domain();
        curve.at_in(own, (u - shift).clamp(a, b))
    }
    fn breaks(&self) -> &[f64] {
        &self.breaks
    }
    fn shape(&self, span: usize) -> Shape {
        let (member, own) = self.spans[span];
        self.members[member].curve.shape(own)
    }
    fn is_closed(&self) -> bool {
        self.closed
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::geom::curve::testing::assert_frenet_matches_differences;
    use crate::geom::curve::{CircularArc, Segment};
    use crate::math::PI;

    fn segment(a: (f64, f64), b: (f64, f64)) -> CurveRef {
        Arc::new(Segment::new(Point2::new(a.0, a.1), Point2::new(b.0, b.1)).expect("two points"))
    }

    #[test]
    fn a_rectangle_is_closed_and_has_four_corners() {
        let corners = [(0.0, 0.0), (30.0, 0.0), (30.0, 20.0), (0.0, 20.0)];
        let sides = (0..4).map(|i| segment(corners[i], corners[(i + 1) % 4])).collect();
        let chain = Chain::new(sides, 1e-9).expect("closed");
        assert!(chain.is_closed());
        let joints = Joint::all(&chain);
        assert_eq!(joints.len(), 4);
        assert!(joints.iter().all(|j| (j.turn - PI / 2.0).abs() < 1e-15));
        assert_frenet_matches_differences(&chain, 1e-9);
    }

    #[test]
    fn line_and_tangent_arc_meet_smoothly_with_a_curvature_jump() {
        let arc = CircularArc::new(Point2::new(10.0, 5.0), 5.0, -PI / 2.0, PI).expect("arc");
        let chain = Chain::new(vec![segment((0.0, 0.0), (10.0, 0.0)), Arc::new(arc)], 1e-9).expect("joined");
        let joints = Joint::all(&chain);
        assert_eq!(joints.len(), 1);
        assert!(joints[0].turn.abs() < 1e-15 && (joints[0].bend - 0.2).abs() < 1e-15);
        assert!(!chain.is_closed());
        assert!(matches!(chain.shape(1), Shape::Arc { .. }));
    }

    #[test]
    fn a_gap_is_reported_with_its_ends() {
        let error = Chain::new(vec![segment((0.0, 0.0), (1.0, 0.0)), segment((1.0, 0.5), (2.0, 0.0))], 0.1);
        let Err(ChainError::Gap { after: 0, distance, .. }) = error else { panic!("{error:?}") };
        assert_eq!(distance, 0.5);
        assert_eq!(Chain::new(Vec::new(), 0.1).err(), Some(ChainError::Empty));
    }
}
