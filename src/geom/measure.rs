//! Length, area and extent of planar curves.

use super::curve::{PlanarCurve, spans};
use super::{Point2, cross};
use crate::geom::quadrature::integral;

/// Arc length between two parameters, mm, within `accuracy` mm. Stretches that run backwards count too.
#[must_use]
pub fn arc_length(curve: &dyn PlanarCurve, from: f64, to: f64, accuracy: f64) -> f64 {
    sum(curve, from, to, accuracy, |span, u| curve.at_in(span, u).speed.abs())
}

/// Length of the whole curve, mm, within `accuracy` mm.
#[must_use]
pub fn length(curve: &dyn PlanarCurve, accuracy: f64) -> f64 {
    let (a, b) = curve.domain();
    arc_length(curve, a, b, accuracy)
}

/// Area inside a closed curve, mm², counter-clockwise positive, within `accuracy` mm². Of an open curve: with
/// the two straight lines from its ends to the origin.
#[must_use]
pub fn signed_area(curve: &dyn PlanarCurve, accuracy: f64) -> f64 {
    let (a, b) = curve.domain();
    sum(curve, a, b, accuracy, |span, u| {
        let f = curve.at_in(span, u);
        0.5 * cross(f.p.coords, f.t) * f.speed
    })
}

fn sum(curve: &dyn PlanarCurve, from: f64, to: f64, accuracy: f64, f: impl Fn(usize, f64) -> f64) -> f64 {
    let share = accuracy / curve.breaks().len().max(1) as f64;
    spans(curve)
        .map(|(span, a, b)| (span, a.max(from), b.min(to)))
        .filter(|(_, a, b)| a < b)
        .map(|(span, a, b)| integral(&|u| f(span, u), a, b, share))
        .sum()
}

/// The smallest axis-parallel box around a curve: lowest and highest corner, mm.
///
/// Each smooth span is searched in `steps` equal steps for the places where the tangent is parallel to an
/// axis; two such places within one step are missed.
#[must_use]
pub fn bounding_box(curve: &dyn PlanarCurve, steps: usize) -> (Point2, Point2) {
    let (mut low, mut high) =
        (Point2::new(f64::INFINITY, f64::INFINITY), Point2::new(f64::NEG_INFINITY, f64::NEG_INFINITY));
    let mut take = |p: Point2| {
        low = Point2::new(low.x.min(p.x), low.y.min(p.y));
        high = Point2::new(high.x.max(p.x), high.y.max(p.y));
    };
    for (span, a, b) in spans(curve) {
        for u in turning_points(curve, span, a, b, steps.max(1)) {
            take(curve.at_in(span, u).p);
        }
    }
    (low, high)
}

/// The ends of a span and the parameters where x or y turns back.
fn turning_points(curve: &dyn PlanarCurve, span: usize, a: f64, b: f64, steps: usize) -> Vec<f64> {
    let tangent = |u: f64| {
        let f = curve.at_in(span, u);
        f.t * f.speed
    };
    let mut found = vec![a, b];
    let mut before = (a, tangent(a));
    for i in 1..=steps {
        let u = if i == steps { b } else { a + (b - a) * i as f64 / steps as f64 };
        let after = (u, tangent(u));
        if before.1.x * after.1.x < 0.0 {
            found.push(super::extremum::root(|u| tangent(u).x, before.0, u));
        }
        if before.1.y * after.1.y < 0.0 {
            found.push(super::extremum::root(|u| tangent(u).y, before.0, u));
        }
        before = after;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::curve::testing::egg;
    use crate::geom::curve::{Bezier, CircularArc, Reversed};
    use crate::math::{PI, hypot, ln};

    #[test]
    fn circle_and_parabola_have_their_lengths() {
        let circle = CircularArc::circle(Point2::new(1.0, 2.0), 3.0, 0.7, true).expect("circle");
        assert!((length(&circle, 1e-12) - 6.0 * PI).abs() < 1e-12);
        assert!((signed_area(&circle, 1e-12) - 9.0 * PI).abs() < 1e-12);
        let points = [(0.0, 0.0), (0.5, 0.0), (1.0, 1.0)];
        let parabola = Bezier::new(points.iter().map(|&(x, y)| Point2::new(x, y)).collect()).expect("moves");
        let root = hypot(1.0, 2.0);
        let exact = 0.5 * root + 0.25 * ln(2.0 + root);
        assert!((length(&parabola, 1e-13) - exact).abs() < 1e-13);
    }

    #[test]
    fn length_converges_with_its_accuracy_and_area_changes_sign_with_direction() {
        let exact = length(egg().as_ref(), 1e-13);
        for accuracy in [1e-1, 1e-4, 1e-8] {
            assert!((length(egg().as_ref(), accuracy) - exact).abs() <= accuracy);
        }
        let area = signed_area(egg().as_ref(), 1e-10);
        assert!(area > 0.0 && (area + signed_area(&Reversed::new(egg()), 1e-10)).abs() < 1e-9);
    }

    #[test]
    fn partial_lengths_add_up() {
        let (a, b) = egg().domain();
        let mid = a + 0.37 * (b - a);
        let parts = arc_length(egg().as_ref(), a, mid, 1e-12) + arc_length(egg().as_ref(), mid, b, 1e-12);
        assert!((parts - length(egg().as_ref(), 1e-12)).abs() < 1e-11);
    }

    #[test]
    fn the_box_of_a_circle_touches_it() {
        let circle = CircularArc::circle(Point2::new(1.0, 2.0), 3.0, 0.7, false).expect("circle");
        let (low, high) = bounding_box(&circle, 8);
        assert!(
            (low - Point2::new(-2.0, -1.0)).norm() < 1e-14 && (high - Point2::new(4.0, 5.0)).norm() < 1e-14
        );
    }
}
