//! NX curves: `NURBS/`, `KNOT/` and `CNTRL/`.
//!
//! The curve is cubic and clamped over 0..1; its first control point is the point before it, and the record lists the inner
//! knots and the last one: k knots for k + 2 further control points.

use super::grammar::Statement;
use super::reader::Reader;
use crate::cl::{RecordKind, Spline};
use crate::diag::codes::foreign as codes;
use crate::geom::Point3;

/// Control points of one curve at most.
const MOST_POINTS: usize = 1_000_000;
/// How far the last knot may be from 1.
const ONE: f64 = 1e-6;

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

    fn control_points(&mut self, numbers: &[f64]) -> Vec<Point3> {
        let [x, y, z, ..] = *numbers else {
            self.complain(&codes::BAD_RECORD, "CNTRL takes 3 numbers".to_owned());
            return Vec::new();
        };
        self.point([x, y, z]).into_iter().collect()
    }

    /// The curve read so far goes to the CL data.
    pub(super) fn flush_nurbs(&mut self) {
        let Some(spans) = self.state.nurbs.take() else { return };
        let Some(start) = self.state.at else {
            return self
                .complain(&codes::BAD_CURVE, "a curve from nowhere: no point stands before it".to_owned());
        };
        let (knots, points) = (spans.knots.len(), spans.points.len());
        let whole = spans.knots.first().is_some_and(|k| *k >= 0.0)
            && spans.knots.last().is_some_and(|k| (k - 1.0).abs() < ONE);
        let mut full = vec![0.0; 4];
        full.extend(spans.knots.iter().map(|k| k.min(1.0)));
        // The last knot counts once among those read, and as 1.
        full.pop();
        full.extend([1.0; 4]);
        let mut control = vec![start];
        control.extend(spans.points);
        let spline =
            Spline::new(control, full, self.state.tolerance()).filter(|_| whole && points == knots + 2);
        let Some(spline) = spline else {
            let message = format!(
                "the curve has {knots} knots and {points} control points; a cubic one has 2 control points more than knots, and its knots rise from 0 to 1"
            );
            return self.complain(&codes::BAD_CURVE, message);
        };
        self.along(spline);
    }

    /// Along a curve at feed; one that is a point moves nothing.
    fn along(&mut self, spline: Spline) {
        let to = spline.end();
        if self.off_axis() || self.state.cycle_failed {
            self.state.at = Some(to);
            return;
        }
        self.state.rapid = false;
        if self.curve_in_cycle("a curve", to) {
            return;
        }
        self.make_sure();
        self.state.moved = true;
        if self.ready() && spline.points().iter().any(|p| *p != to) {
            self.emit(RecordKind::Spline(Box::new(spline)));
        }
        self.state.at = Some(to);
    }
}
