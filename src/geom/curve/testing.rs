//! What tests of curves share.

use std::sync::Arc;

use super::{CurveRef, Ends, PlanarCurve, Spline, spans};
use crate::geom::{Point2, cross, left};

/// Compares tangent, speed and curvature with central differences of the positions inside every span;
/// the curvature must agree within `k_tolerance` 1/mm.
pub(crate) fn assert_frenet_matches_differences(curve: &dyn PlanarCurve, k_tolerance: f64) {
    for (span, a, b) in spans(curve) {
        let h = (b - a) * 1e-4;
        for i in 1..10 {
            let u = a + (b - a) * f64::from(i) / 10.0;
            let f = curve.at_in(span, u);
            let (before, after) = (curve.at_in(span, u - h), curve.at_in(span, u + h));
            let d1 = (after.p - before.p) / (2.0 * h);
            let scale = f.speed.abs().max(1e-3);
            assert!((f.t.norm() - 1.0).abs() < 1e-12, "unit tangent at {u}");
            assert!((d1 - f.t * f.speed).norm() < 1e-5 * scale, "first derivative at {u}: {d1} {f:?}");
            let turn = cross(before.t, after.t) / (2.0 * h);
            assert!((turn / f.speed - f.k).abs() < k_tolerance, "curvature at {u}: {} {f:?}", turn / f.speed);
            assert!((left(f.t) - f.n()).norm() == 0.0);
        }
    }
}

/// A smooth closed counter-clockwise curve, convex, about 30 x 20 mm.
pub(crate) fn egg() -> CurveRef {
    let points: Vec<Point2> = (0..12)
        .map(|i| {
            let (s, c) = crate::math::sin_cos(f64::from(i) * crate::math::TAU / 12.0);
            Point2::new(15.0 * c + 2.0 * s * s, 10.0 * s)
        })
        .collect();
    Arc::new(Spline::new(&points, Ends::Periodic).expect("twelve points"))
}
