//! NX curves: `NURBS/`, `KNOT/` and `CNTRL/`.
//!
//! The curve is cubic and clamped over 0..1; its first control point is the point before it, and the record lists the inner
//! knots and the last one: k knots for k + 2 further control points. It is flattened here, within the tolerance: the
//! distance of a Bézier segment's inner control points from its chord bounds the distance of the curve.

use super::grammar::Statement;
use super::reader::Reader;
use crate::diag::Diagnostic;
use crate::diag::codes::foreign as codes;
use crate::geom::Point3;

/// Control points of one curve at most.
const MOST_POINTS: usize = 1_000_000;
/// Halvings of one segment at most.
const DEEPEST: u32 = 16;

/// Finest tolerance, mm: a tenth of the step that controls count in.
const FINEST: f64 = 1e-4;

/// A curve being read.
#[derive(Debug, Clone, Default)]
pub(super) struct Spans {
    knots: Vec<f64>,
    points: Vec<Point3>,
}

impl Reader<'_> {
    pub(super) fn nurbs(&mut self, s: &Statement) {
        let numbers = s.numbers();
        match s.major() {
            "NURBS" => {
                self.flush_nurbs();
                self.state.nurbs = Some(Spans::default());
            }
            word => {
                let points = if word == "CNTRL" { self.control_points(&numbers) } else { Vec::new() };
                let Some(spans) = &mut self.state.nurbs else {
                    return self.complain(&codes::BAD_RECORD, format!("{word} without NURBS/ before it"));
                };
                if word == "KNOT" {
                    spans.knots.extend(numbers);
                } else {
                    spans.points.extend(points);
                }
                if spans.points.len().max(spans.knots.len()) > MOST_POINTS {
                    self.state.nurbs = None;
                    self.complain(&codes::BAD_CURVE, format!("the curve has more than {MOST_POINTS} points"));
                }
            }
        }
    }

    /// Says once what became of all curves.
    pub(super) fn report_curves(&mut self) {
        let Some((span, curves, lines)) = self.state.flattened.take() else { return };
        let tolerance = self.show(self.state.tolerance().max(FINEST));
        let message = format!("{curves} curves (NURBS) are cut by {lines} lines, at most {tolerance} off");
        self.tell(Diagnostic::new(&codes::CURVE_AS_LINES, span, message));
    }

    fn control_points(&mut self, numbers: &[f64]) -> Vec<Point3> {
        let [x, y, z, ..] = *numbers else {
            self.complain(&codes::BAD_RECORD, "CNTRL takes 3 numbers".to_owned());
            return Vec::new();
        };
        self.point([x, y, z]).into_iter().collect()
    }

    /// The curve read so far becomes lines.
    pub(super) fn flush_nurbs(&mut self) {
        let Some(spans) = self.state.nurbs.take() else { return };
        let Some(start) = self.state.at else {
            return self
                .complain(&codes::BAD_CURVE, "a curve from nowhere: no point stands before it".to_owned());
        };
        let (knots, points) = (spans.knots.len(), spans.points.len());
        let rising = spans.knots.windows(2).all(|w| w[0] <= w[1]);
        let clamped = spans.knots.first().is_some_and(|k| *k >= 0.0)
            && spans.knots.last().is_some_and(|k| (k - 1.0).abs() < 1e-6);
        if points != knots + 2 || !rising || !clamped {
            let message = format!(
                "the curve has {knots} knots and {points} control points; a cubic one has 2 control points more than knots, and its knots rise from 0 to 1"
            );
            return self.complain(&codes::BAD_CURVE, message);
        }
        let mut full = vec![0.0; 4];
        full.extend(spans.knots);
        full.extend([1.0; 3]);
        let mut control = vec![start];
        control.extend(spans.points);
        let tolerance = self.state.tolerance().max(FINEST);
        let mut ends = Vec::new();
        for span in 3..control.len() {
            let (a, b) = (full[span], full[span + 1]);
            if b > a {
                let bezier =
                    [[a, a, a], [a, a, b], [a, b, b], [b, b, b]].map(|at| blossom(&control, &full, span, at));
                flatten(bezier, tolerance, 0, &mut ends);
            }
        }
        let flattened = self.state.flattened.get_or_insert((self.span, 0, 0));
        flattened.1 += 1;
        flattened.2 += ends.len();
        for end in ends {
            self.move_to(end);
        }
    }
}

/// De Boor's scheme with an argument of its own for every level.
fn blossom(control: &[Point3], knots: &[f64], span: usize, at: [f64; 3]) -> Point3 {
    let mut d = [0, 1, 2, 3].map(|j| control.get(span - 3 + j).copied().unwrap_or_else(Point3::origin));
    for level in 1..=3 {
        for j in (level..=3).rev() {
            let i = span - 3 + j;
            let (low, high) = (knots[i], knots[i + 4 - level]);
            let x = if high > low { (at[level - 1] - low) / (high - low) } else { 0.0 };
            d[j] = d[j - 1] + (d[j] - d[j - 1]) * x;
        }
    }
    d[3]
}

fn flatten(b: [Point3; 4], tolerance: f64, depth: u32, ends: &mut Vec<Point3>) {
    let off = distance(b[1], b[0], b[3]).max(distance(b[2], b[0], b[3]));
    // A cubic comes to three quarters of its control points' distance at most.
    if 0.75 * off <= tolerance || depth >= DEEPEST {
        return ends.push(b[3]);
    }
    let mid = |p: Point3, q: Point3| p + (q - p) * 0.5;
    let (ab, bc, cd) = (mid(b[0], b[1]), mid(b[1], b[2]), mid(b[2], b[3]));
    let (abc, bcd) = (mid(ab, bc), mid(bc, cd));
    let middle = mid(abc, bcd);
    flatten([b[0], ab, abc, middle], tolerance, depth + 1, ends);
    flatten([middle, bcd, cd, b[3]], tolerance, depth + 1, ends);
}

/// Distance of a point from the segment between two others.
fn distance(p: Point3, a: Point3, b: Point3) -> f64 {
    let (v, d) = (p - a, b - a);
    let length = d.norm_squared();
    let x = if length > 0.0 { (v.dot(&d) / length).clamp(0.0, 1.0) } else { 0.0 };
    (v - d * x).norm()
}
