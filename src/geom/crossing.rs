//! Where a curve crosses itself.

use super::curve::{PlanarCurve, spans};
use super::{Point2, cross};

/// A crossing of a curve with itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// The two parameters, ascending.
    pub u: (f64, f64),
    /// The point, mm.
    pub p: Point2,
}

/// Points of the curve with their parameters, dense enough that every chord is within about `tolerance` mm of
/// the curve and turns by less than a quarter of a radian. Breaks are points.
#[must_use]
pub fn flatten(curve: &dyn PlanarCurve, tolerance: f64) -> Vec<(f64, Point2)> {
    let mut points = Vec::new();
    for (span, a, b) in spans(curve) {
        if points.is_empty() {
            points.push((a, curve.at_in(span, a).p));
        }
        let mut u = a;
        while u < b {
            let next = next_parameter(curve, span, u, b, tolerance);
            points.push((next, curve.at_in(span, next).p));
            u = next;
        }
    }
    points
}

/// The end of the chord that starts at u: from the curvature there, shortened until the chord's end and middle
/// agree with it. A span has a few thousand chords at most.
fn next_parameter(curve: &dyn PlanarCurve, span: usize, u: f64, b: f64, tolerance: f64) -> f64 {
    const LARGEST_TURN: f64 = 0.25;
    const FEWEST_A_SPAN: f64 = 8.0;
    const MOST_A_SPAN: f64 = 4096.0;
    let chord_of = |k: f64| {
        let k = k.abs().max(f64::MIN_POSITIVE);
        (8.0 * tolerance / k).sqrt().min(LARGEST_TURN / k)
    };
    let here = curve.at_in(span, u);
    let whole = b - curve.breaks()[span];
    let smallest = whole / MOST_A_SPAN;
    let wanted = chord_of(here.k) / here.speed.abs().max(f64::MIN_POSITIVE);
    let mut step = wanted.min(whole / FEWEST_A_SPAN).max(smallest).min(b - u);
    while step > smallest {
        let fits = [0.5, 1.0].iter().all(|x| {
            let f = curve.at_in(span, u + step * x);
            f.speed.abs() * step <= 1.5 * chord_of(f.k) && here.t.dot(&f.t) > 0.9
        });
        if fits {
            break;
        }
        step *= 0.5;
    }
    let next = u + step;
    // A last sliver would be shorter than rounding.
    if next <= u || b - next < 1e-3 * step { b } else { next }
}

/// Whether a closed curve runs around the origin counter-clockwise without ever turning back, at all given
/// (span, parameter) samples and in the angle between them: it then does not cross itself.
#[must_use]
pub fn is_star_shaped(curve: &dyn PlanarCurve, samples: &[(usize, f64)]) -> bool {
    samples.iter().all(|&(span, u)| {
        let f = curve.at_in(span, u);
        f.speed > 0.0 && cross(f.p.coords, f.t) > 0.0
    })
}

/// The transversal crossings of a curve with itself, by the first parameter. Chords are within about `chord`
/// mm of the curve; crossings of branches that stay nearer than that may be missed, and so are loops of no
/// more than two chords, which a change of the curve's speed sign betrays.
#[must_use]
pub fn self_crossings(curve: &dyn PlanarCurve, chord: f64) -> Vec<Crossing> {
    let points = flatten(curve, chord);
    let count = points.len().saturating_sub(1);
    let mut order: Vec<usize> = (0..count).collect();
    let low_x = |i: usize| points[i].1.x.min(points[i + 1].1.x);
    order.sort_by(|a, b| low_x(*a).total_cmp(&low_x(*b)).then(a.cmp(b)));
    let mut active: Vec<usize> = Vec::new();
    let mut found = Vec::new();
    for i in order {
        active.retain(|&j| points[j].1.x.max(points[j + 1].1.x) >= low_x(i));
        for &j in &active {
            let (first, second) = (i.min(j), i.max(j));
            let neighbours = second - first <= 1 || (curve.is_closed() && first == 0 && second == count - 1);
            if !neighbours {
                found.extend(chord_crossing(curve, &points, first, second));
            }
        }
        active.push(i);
    }
    found.sort_by(|a: &Crossing, b| a.u.0.total_cmp(&b.u.0));
    found
}

/// The crossing of two chords, moved onto the curve by Newton's method.
fn chord_crossing(curve: &dyn PlanarCurve, points: &[(f64, Point2)], i: usize, j: usize) -> Option<Crossing> {
    let ((u0, a), (u1, b)) = (points[i], points[i + 1]);
    let ((w0, c), (w1, d)) = (points[j], points[j + 1]);
    if a.y.max(b.y) < c.y.min(d.y) || c.y.max(d.y) < a.y.min(b.y) {
        return None;
    }
    let (ab, cd) = (b - a, d - c);
    let denominator = cross(ab, cd);
    if denominator == 0.0 {
        return None;
    }
    let (x, y) = (cross(c - a, cd) / denominator, cross(c - a, ab) / denominator);
    let within = (0.0..1.0).contains(&x) && (0.0..1.0).contains(&y);
    within.then(|| refine(curve, (u0, u1, x), (w0, w1, y)))
}

fn refine(curve: &dyn PlanarCurve, first: (f64, f64, f64), second: (f64, f64, f64)) -> Crossing {
    const STEPS: usize = 8;
    let (mut u, mut w) =
        (first.0 + (first.1 - first.0) * first.2, second.0 + (second.1 - second.0) * second.2);
    for _ in 0..STEPS {
        let (f, g) = (curve.at(u), curve.at(w));
        let (d, e) = (f.t * f.speed, g.t * g.speed);
        let determinant = cross(d, e);
        let gap = g.p - f.p;
        if determinant == 0.0 {
            break;
        }
        u = (u + cross(gap, e) / determinant).clamp(first.0, first.1);
        w = (w + cross(gap, d) / determinant).clamp(second.0, second.1);
    }
    Crossing { u: (u, w), p: curve.at(u).p }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::geom::Vec2;
    use crate::geom::curve::testing::egg;
    use crate::geom::curve::{Bezier, Moved, Offset, Placement};
    use crate::units::Angle;

    fn loop_curve() -> Arc<Bezier> {
        let points = [(0.0, 0.0), (60.0, 40.0), (-30.0, 40.0), (30.0, 0.0)];
        Arc::new(Bezier::new(points.iter().map(|&(x, y)| Point2::new(x, y)).collect()).expect("moves"))
    }

    #[test]
    fn the_loop_of_a_cubic_is_found_once_and_exactly() {
        let curve = loop_curve();
        let found = self_crossings(curve.as_ref(), 1e-3);
        assert_eq!(found.len(), 1);
        let (u, w) = found[0].u;
        assert!((curve.at(u).p - curve.at(w).p).norm() < 1e-12 && (u + w - 1.0).abs() < 1e-9);
    }

    #[test]
    fn crossings_do_not_depend_on_the_place() {
        let placement = Placement::new(true, 2.0, Angle::degrees(71.0), Vec2::new(-3.0, 8.0)).expect("valid");
        let moved = Moved::new(loop_curve(), placement);
        let found = self_crossings(&moved, 1e-3);
        assert_eq!(found.len(), 1);
        let here = self_crossings(loop_curve().as_ref(), 1e-3);
        assert!((found[0].p - placement.point(here[0].p)).norm() < 1e-9);
    }

    #[test]
    fn a_simple_curve_has_no_crossing() {
        assert!(self_crossings(egg().as_ref(), 1e-3).is_empty());
        assert!(!self_crossings(&Offset::new(egg(), 9.0), 1e-3).is_empty());
    }

    #[test]
    fn chords_are_as_near_as_asked_and_finer_when_asked() {
        let count = |tolerance: f64| {
            let points = flatten(egg().as_ref(), tolerance);
            for w in points.windows(2) {
                let mid = egg().at(0.5 * (w[0].0 + w[1].0)).p;
                let chord = (w[1].1 - w[0].1).normalize();
                assert!(cross(chord, mid - w[0].1).abs() < 2.5 * tolerance);
            }
            points.len()
        };
        assert!(count(1e-4) > 2 * count(1e-3));
    }
}
