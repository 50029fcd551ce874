//! Parallel curves with their corners: the path of a circle's centre that rolls along one side of a chain.
//!
//! Smooth spans give their parallels ([`Offset`]). At a corner that points towards the circle the circle rolls
//! about it: an arc joins the parallels. At a corner that opens towards it the parallels cross: both are cut
//! back to the crossing, and the circle does not reach into the corner.

use std::sync::Arc;

use super::curve::{Chain, CircularArc, CurveRef, Frenet, Joint, Offset, Part, PlanarCurve};
use super::{Point2, Side, cross};
use crate::math::atan2;

/// A tangent that turns less than this at a break, radians, is smooth: over 100 mm of radius it opens 10 nm.
const SMOOTH: f64 = 1e-7;
/// Ends of pieces meet as nearly as this, mm.
const JOIN: f64 = 1e-6;

/// Why a circle cannot roll along a curve.
#[derive(Debug, Clone, PartialEq)]
pub enum ParallelError {
    /// A smooth stretch is curved more than the circle.
    TooCurved {
        /// Its smallest radius, mm.
        radius: f64,
        /// Where.
        at: Point2,
    },
    /// An edge between corners is too short for the circle to reach it.
    EdgeOutOfReach {
        /// The corner where it starts or ends.
        at: Point2,
    },
}

/// The exact parallel of `curve` at `distance` mm (positive) to side `side`, in the same direction.
///
/// Only neighbours are trimmed against each other: a circle that is held between distant stretches is for the
/// caller to find.
///
/// # Errors
/// [`ParallelError`].
pub fn parallel(curve: &CurveRef, side: Side, distance: f64) -> Result<CurveRef, ParallelError> {
    check_curvature(curve.as_ref(), side, distance)?;
    let offset: CurveRef = Arc::new(Offset::new(curve.clone(), side.sign() * distance));
    let corners: Vec<Joint> =
        Joint::all(curve.as_ref()).into_iter().filter(|j| j.turn.abs() > SMOOTH).collect();
    if corners.is_empty() {
        return Ok(offset);
    }
    let pieces = Pieces { offset: &offset, curve: curve.as_ref(), side, distance };
    pieces.join(&corners)
}

/// Steps in which a span is looked at for its curvature.
const LOOKS: usize = 64;

fn check_curvature(curve: &dyn PlanarCurve, side: Side, distance: f64) -> Result<(), ParallelError> {
    let mut worst: Option<(f64, Point2)> = None;
    for (span, pair) in curve.breaks().windows(2).enumerate() {
        for i in 0..=LOOKS {
            let f = curve.at_in(span, pair[0] + (pair[1] - pair[0]) * i as f64 / LOOKS as f64);
            let bend = f.k * side.sign();
            if bend > 0.0 && worst.is_none_or(|(b, _)| bend > b) {
                worst = Some((bend, f.p));
            }
        }
    }
    match worst {
        Some((bend, at)) if bend * distance > 1.0 + 1e-9 => {
            Err(ParallelError::TooCurved { radius: 1.0 / bend, at })
        }
        _ => Ok(()),
    }
}

struct Pieces<'a> {
    offset: &'a CurveRef,
    curve: &'a dyn PlanarCurve,
    side: Side,
    distance: f64,
}

/// What stands between two edges.
enum Between {
    /// The circle rolls about the corner.
    Arc(CircularArc),
    /// The edge before ends, and the edge after starts, at these parameters.
    Crossing(f64, f64),
}

impl Pieces<'_> {
    /// The edges between corners, cut back and joined.
    fn join(&self, corners: &[Joint]) -> Result<CurveRef, ParallelError> {
        let edges = self.edges(corners);
        let between = self.between(corners, &edges)?;
        let mut curves: Vec<CurveRef> = Vec::new();
        for (i, &(from, to)) in edges.iter().enumerate() {
            let before = between.get(self.joint_before(i, edges.len()));
            let after = between.get(self.joint_after(i, edges.len()));
            let from = if let Some(Between::Crossing(_, u)) = before { *u } else { from };
            let to = if let Some(Between::Crossing(u, _)) = after { *u } else { to };
            let at = self.curve.at(edges[i].0).p;
            let edge = self.stretch(from, to).ok_or(ParallelError::EdgeOutOfReach { at })?;
            curves.push(edge);
            if let Some(Between::Arc(arc)) = after {
                curves.push(Arc::new(arc.clone()));
            }
        }
        let at = corners.first().map_or(Point2::origin(), |c| c.p);
        Chain::new(curves, JOIN)
            .map(|c| Arc::new(c) as CurveRef)
            .map_err(|_| ParallelError::EdgeOutOfReach { at })
    }

    /// First and last parameter of every edge; on a closed curve the last may run past the domain's end.
    fn edges(&self, corners: &[Joint]) -> Vec<(f64, f64)> {
        let (first, last) = self.curve.domain();
        let us = corners.iter().map(|c| c.u);
        if !self.curve.is_closed() {
            let starts: Vec<f64> = [first].into_iter().chain(us).collect();
            let ends = starts.iter().copied().skip(1).chain([last]).collect::<Vec<_>>();
            return starts.into_iter().zip(ends).collect();
        }
        let starts: Vec<f64> = us.collect();
        let wrapped = starts.first().map(|u| u + (last - first));
        let ends: Vec<f64> = starts.iter().copied().skip(1).chain(wrapped).collect();
        starts.into_iter().zip(ends).collect()
    }

    /// Index of the corner before edge `i`; out of range when there is none. On a closed curve edge i starts
    /// at corner i; on an open one edge i ends at corner i.
    fn joint_before(&self, i: usize, _count: usize) -> usize {
        if self.curve.is_closed() { i } else { i.checked_sub(1).unwrap_or(usize::MAX) }
    }

    fn joint_after(&self, i: usize, count: usize) -> usize {
        if self.curve.is_closed() { (i + 1) % count } else { i }
    }

    fn between(&self, corners: &[Joint], edges: &[(f64, f64)]) -> Result<Vec<Between>, ParallelError> {
        let count = edges.len();
        (0..corners.len())
            .map(|c| {
                let (before, after) =
                    if self.curve.is_closed() { ((c + count - 1) % count, c) } else { (c, c + 1) };
                self.corner(&corners[c], edges[before], edges[after])
            })
            .collect()
    }

    fn corner(
        &self,
        corner: &Joint,
        before: (f64, f64),
        after: (f64, f64),
    ) -> Result<Between, ParallelError> {
        if corner.turn * self.side.sign() < 0.0 {
            let normal = self.end_of(before).n() * self.side.sign();
            let arc = CircularArc::new(corner.p, self.distance, atan2(normal.y, normal.x), corner.turn);
            return arc.map(Between::Arc).ok_or(ParallelError::EdgeOutOfReach { at: corner.p });
        }
        self.crossing(before, after)
            .map(|(u, v)| Between::Crossing(u, v))
            .ok_or(ParallelError::EdgeOutOfReach { at: corner.p })
    }

    /// Frenet data of the base at an edge's last parameter, seen from inside the edge.
    fn end_of(&self, (_, to): (f64, f64)) -> Frenet {
        let (first, last) = self.curve.domain();
        let u = if to > last { to - (last - first) } else { to };
        let spans = self.curve.breaks();
        let span = spans.iter().skip(1).position(|b| *b >= u - (last - first) * 1e-12);
        self.curve.at_in(span.unwrap_or(0).min(spans.len().saturating_sub(2)), u)
    }

    /// Frenet data of the parallel at a parameter that may run past the domain's end.
    fn at(&self, u: f64, from_left: bool) -> Frenet {
        let (first, last) = self.curve.domain();
        if from_left {
            return self.end_of((0.0, u)).offset(self.side.sign() * self.distance);
        }
        let u = if u >= last && self.curve.is_closed() { u - (last - first) } else { u };
        self.offset.at(u)
    }

    /// Parameters at which the parallels of two neighbouring edges cross nearest to their corner.
    fn crossing(&self, before: (f64, f64), after: (f64, f64)) -> Option<(f64, f64)> {
        const STEPS: usize = 96;
        let back = self.polyline(before, STEPS, true);
        let ahead = self.polyline(after, STEPS, false);
        for (i, a) in back.windows(2).enumerate() {
            for b in ahead.windows(2).take(i.saturating_mul(4) + STEPS) {
                if let Some((x, y)) = segments_cross(a[0].1, a[1].1, b[0].1, b[1].1) {
                    let guess = (a[0].0 + (a[1].0 - a[0].0) * x, b[0].0 + (b[1].0 - b[0].0) * y);
                    return Some(self.polish(guess));
                }
            }
        }
        None
    }

    /// Parameters and points of an edge's parallel, from the corner away.
    fn polyline(&self, (from, to): (f64, f64), steps: usize, backwards: bool) -> Vec<(f64, Point2)> {
        (0..=steps)
            .map(|i| {
                let x = i as f64 / steps as f64;
                let u = if backwards { to + (from - to) * x } else { from + (to - from) * x };
                (u, self.at(u, backwards && i == 0).p)
            })
            .collect()
    }

    /// Newton's method on A(u) = B(v).
    fn polish(&self, (mut u, mut v): (f64, f64)) -> (f64, f64) {
        const ROUNDS: u32 = 20;
        for _ in 0..ROUNDS {
            let (a, b) = (self.at(u, false), self.at(v, false));
            let gap = b.p - a.p;
            let (da, db) = (a.t * a.speed, b.t * b.speed);
            let det = cross(da, db);
            if det == 0.0 {
                break;
            }
            let (du, dv) = (cross(gap, db) / det, cross(gap, da) / det);
            u += du;
            v += dv;
            if gap.norm() < 1e-13 {
                break;
            }
        }
        (u, v)
    }

    /// The parallel between two parameters; `to` may run past the domain's end.
    fn stretch(&self, from: f64, to: f64) -> Option<CurveRef> {
        let (first, last) = self.curve.domain();
        let turn = last - first;
        let part = |a: f64, b: f64| Part::new(self.offset.clone(), a, b).map(|p| Arc::new(p) as CurveRef);
        if from >= last {
            return part(from - turn, to - turn);
        }
        if to <= last {
            return part(from, to);
        }
        let (tail, head) = (part(from, last)?, part(first, to - turn)?);
        Chain::new(vec![tail, head], JOIN).ok().map(|c| Arc::new(c) as CurveRef)
    }
}

/// Where two segments cross, as shares of each.
fn segments_cross(a: Point2, b: Point2, c: Point2, d: Point2) -> Option<(f64, f64)> {
    let (p, q, gap) = (b - a, d - c, c - a);
    let det = cross(p, q);
    if det == 0.0 {
        return None;
    }
    let (x, y) = (cross(gap, q) / det, cross(gap, p) / det);
    ((0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y)).then_some((x, y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::curve::Segment;
    use crate::geom::curve::testing::assert_frenet_matches_differences;
    use crate::geom::measure::length;
    use crate::math::PI;

    fn polygon(corners: &[(f64, f64)], closed: bool) -> CurveRef {
        let count = if closed { corners.len() } else { corners.len() - 1 };
        let point = |i: usize| {
            let (x, y) = corners[i % corners.len()];
            Point2::new(x, y)
        };
        let side = |i: usize| Arc::new(Segment::new(point(i), point(i + 1)).expect("two points")) as CurveRef;
        Arc::new(Chain::new((0..count).map(side).collect(), 1e-9).expect("joined"))
    }

    const RECTANGLE: [(f64, f64); 4] = [(0.0, 0.0), (30.0, 0.0), (30.0, 20.0), (0.0, 20.0)];

    #[test]
    fn outside_a_rectangle_the_circle_rolls_about_the_corners() {
        let path = parallel(&polygon(&RECTANGLE, true), Side::Right, 5.0).expect("free");
        assert!(path.is_closed());
        assert!((length(path.as_ref(), 1e-9) - (100.0 + 10.0 * PI)).abs() < 1e-8);
        assert_frenet_matches_differences(path.as_ref(), 1e-6);
    }

    #[test]
    fn inside_a_rectangle_the_path_is_the_smaller_rectangle() {
        let path = parallel(&polygon(&RECTANGLE, true), Side::Left, 5.0).expect("fits");
        assert!(path.is_closed());
        assert!((length(path.as_ref(), 1e-9) - 60.0).abs() < 1e-9);
    }

    #[test]
    fn a_circle_wider_than_the_pocket_is_an_error() {
        let error = parallel(&polygon(&RECTANGLE, true), Side::Left, 11.0);
        assert!(matches!(error, Err(ParallelError::EdgeOutOfReach { .. })), "{error:?}");
    }

    #[test]
    fn an_open_angle_has_an_arc_outside_and_a_crossing_inside() {
        let angle = polygon(&[(0.0, 0.0), (20.0, 0.0), (20.0, 20.0)], false);
        let outer = parallel(&angle, Side::Right, 4.0).expect("free");
        assert!((length(outer.as_ref(), 1e-9) - (40.0 + 2.0 * PI)).abs() < 1e-9);
        let inner = parallel(&angle, Side::Left, 4.0).expect("fits");
        assert!((length(inner.as_ref(), 1e-9) - 32.0).abs() < 1e-9);
        assert!(!inner.is_closed());
    }

    #[test]
    fn a_curve_rounder_than_the_circle_is_an_error_with_its_radius() {
        let circle: CurveRef =
            Arc::new(CircularArc::circle(Point2::origin(), 6.0, 0.0, true).expect("circle"));
        let Err(ParallelError::TooCurved { radius, .. }) = parallel(&circle, Side::Left, 7.0) else {
            panic!("too curved")
        };
        assert!((radius - 6.0).abs() < 1e-12);
        assert!(parallel(&circle, Side::Left, 5.0).is_ok());
    }
}
