//! Bezier nets of B-spline surfaces against the definition of B-splines.

use super::*;
use proptest::prelude::*;

/// The Cox-de Boor recursion, straight from the definition.
fn basis(i: usize, p: usize, t: f64, knots: &[f64]) -> f64 {
    if p == 0 {
        return if knots[i] <= t && t < knots[i + 1] { 1.0 } else { 0.0 };
    }
    let part = |a: f64, b: f64| if b > 0.0 { a / b } else { 0.0 };
    part(t - knots[i], knots[i + p] - knots[i]) * basis(i, p - 1, t, knots)
        + part(knots[i + p + 1] - t, knots[i + p + 1] - knots[i + 1]) * basis(i + 1, p - 1, t, knots)
}

fn by_definition(s: &SplineSurface, u: f64, v: f64) -> Point3 {
    let rows = s.knots[0].len() - s.degree[0] - 1;
    let columns = s.poles.len() / rows;
    let (mut sum, mut weight) = (Vec3::zeros(), 0.0);
    for i in 0..rows {
        for j in 0..columns {
            let k = i * columns + j;
            let b = basis(i, s.degree[0], u, &s.knots[0]) * basis(j, s.degree[1], v, &s.knots[1]);
            let w = b * s.weights.as_ref().map_or(1.0, |w| w[k]);
            sum += s.poles[k].coords * w;
            weight += w;
        }
    }
    Point3::from(sum / weight)
}

/// Spans with a length inside the surface's range.
fn spans(knots: &[f64], degree: usize) -> Vec<(f64, f64)> {
    let inside = &knots[degree..knots.len() - degree];
    inside.windows(2).map(|w| (w[0], w[1])).filter(|(a, b)| a < b).collect()
}

fn agrees(s: &SplineSurface) {
    let net = s.net().expect("a sound surface");
    let (along_u, along_v) = (spans(&s.knots[0], s.degree[0]), spans(&s.knots[1], s.degree[1]));
    assert_eq!(net.size(), [along_u.len(), along_v.len()]);
    for (i, (a, b)) in along_u.iter().enumerate() {
        for (j, (c, d)) in along_v.iter().enumerate() {
            for (x, y) in [(0.0, 0.0), (0.3, 0.6), (0.9, 0.2)] {
                let wanted = by_definition(s, a + (b - a) * x, c + (d - c) * y);
                let found = net.patches()[i * along_v.len() + j].point(x, y);
                assert!((found - wanted).norm() < 1e-9, "{found} {wanted}");
            }
        }
    }
}

fn surface(degree: [usize; 2], knots: [Vec<f64>; 2], weighted: bool) -> SplineSurface {
    let rows = knots[0].len() - degree[0] - 1;
    let columns = knots[1].len() - degree[1] - 1;
    let at = |k: usize| (crate::math::count(k / columns), crate::math::count(k % columns));
    let poles = (0..rows * columns).map(at);
    let poles: Vec<Point3> =
        poles.map(|(x, y)| Point3::new(10.0 * x, 8.0 * y, (5.0 * x + 3.0 * y) % 7.0)).collect();
    let weights = weighted.then(|| (0..poles.len()).map(|k| 1.0 + crate::math::count(k % 5) / 4.0).collect());
    SplineSurface { degree, knots, poles, weights }
}

/// Knots with these steps; every one is an interior knot of its own, and the ends may be clamped.
fn knots_of(degree: usize, steps: &[u8], clamped: bool) -> Vec<f64> {
    let mut t = 0.0;
    let mut inner = vec![0.0];
    for step in steps {
        t += f64::from(*step) * 0.25;
        inner.push(t);
    }
    if !clamped {
        return inner;
    }
    let mut knots = vec![0.0; degree];
    knots.extend(inner);
    knots.extend(vec![t; degree]);
    knots
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn nets_are_the_surfaces(
        p in 1usize..6, q in 1usize..5,
        us in proptest::collection::vec(1u8..9, 12), vs in proptest::collection::vec(1u8..9, 11),
        clamped in any::<(bool, bool)>(), weighted in any::<bool>(),
    ) {
        agrees(&surface([p, q], [knots_of(p, &us, clamped.0), knots_of(q, &vs, clamped.1)], weighted));
    }
}

#[test]
fn repeated_knots_are_spans_less() {
    let u = vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0, 3.0, 3.0, 3.0, 3.0];
    agrees(&surface([3, 1], [u, vec![0.0, 0.0, 1.0, 1.0]], true));
}

#[test]
fn bezier_knots_give_back_the_control_points_exactly() {
    let u = vec![0.0, 0.0, 0.0, 0.0, 0.3, 0.3, 0.3, 1.0, 1.0, 1.0, 1.0];
    let s = surface([3, 3], [u, vec![0.0, 0.0, 0.0, 0.0, 7.0, 7.0, 7.0, 7.0]], false);
    let net = Net::new(7, 4, &s.poles, None).expect("a net");
    assert_eq!(s.net(), Ok(net));
}

#[test]
fn unsound_surfaces_are_refused() {
    let flat = vec![0.0, 0.0, 1.0, 1.0];
    let good = surface([1, 1], [flat.clone(), flat.clone()], false);
    assert!(good.net().is_ok());
    let with = |change: &dyn Fn(&mut SplineSurface)| {
        let mut s = good.clone();
        change(&mut s);
        s.net().expect_err("not sound")
    };
    assert_eq!(with(&|s| s.degree[1] = 16), SplineIssue::Degree { axis: 1, degree: 16 });
    assert_eq!(with(&|s| s.knots[1].push(2.0)), SplineIssue::Counts { axis: 1, wanted: 4, given: 5 });
    assert_eq!(with(&|s| s.knots[0] = vec![0.0; 4]), SplineIssue::Knots { axis: 0 });
    assert_eq!(with(&|s| s.knots[1] = vec![0.0, 1.0, 0.5, 2.0]), SplineIssue::Knots { axis: 1 });
    assert_eq!(with(&|s| s.knots[1][3] = f64::NAN), SplineIssue::Knots { axis: 1 });
    assert_eq!(with(&|s| s.weights = Some(vec![1.0, 1.0, 1.0, -1.0])), SplineIssue::Net(NetIssue::NotFinite));
    assert!(matches!(with(&|s| s.poles.clear()), SplineIssue::Counts { axis: 1, .. }));
    assert!(matches!(with(&|s| s.degree[0] = usize::MAX), SplineIssue::Net(_)));
    let broken = surface([1, 1], [vec![0.0, 0.0, 1.0, 1.0, 2.0, 2.0], flat], false);
    assert_eq!(broken.net(), Err(SplineIssue::Broken { axis: 0, knot: 1.0 }));
}

#[test]
fn curves_are_sampled_at_their_ends_and_between() {
    let curve = SplineCurve {
        degree: 2,
        knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
        poles: vec![Point3::new(1.0, 0.0, 0.0), Point3::new(1.0, 1.0, 0.0), Point3::new(0.0, 1.0, 0.0)],
        weights: Some(vec![1.0, 0.5_f64.sqrt(), 1.0]),
    };
    let points = curve.samples(3).expect("a sound curve");
    assert_eq!(points.len(), 5);
    assert!(points.iter().all(|p| (p.coords.norm() - 1.0).abs() < 1e-14));
}
