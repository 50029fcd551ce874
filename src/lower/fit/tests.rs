//! Tests of the line and spiral fits: counts of the reference cam, random curves, corners, degenerate bands.
//!
//! The checker here measures by brute force (dense points of path and curve, nearest distances) and shares nothing
//! with the certificate of the fits.

mod corners;
mod robust;

use std::time::Instant;

use proptest::prelude::*;

use super::samples::{Fourier, How, Pitch, Polygon, Seen};
use super::tube::Plane;
use super::{Fit, FitError, Grid, Primitive, Tube, bound, chain, lines, spirals};
use crate::geom::curve::{Frenet, PlanarCurve};
use crate::geom::{Point2, Vec2, cross};
use crate::math;

type Fitter = fn(&Tube, &Grid, Option<f64>) -> Result<Fit, FitError>;

fn grid(decimals: u8) -> Grid {
    let step = 1.0 / f64::from(10_u32.pow(u32::from(decimals)));
    Grid { step, centre_step: step, angle_step: 0.001 }
}

fn inch() -> Grid {
    Grid { step: 0.00254, centre_step: 0.00254, angle_step: 0.001 }
}

fn paper() -> Pitch {
    Pitch::new(28.0, 20.0)
}

/// Dense points of the path, mm.
fn path(fit: &Fit, grid: &Grid, each: u32) -> Vec<Point2> {
    let mut points = Vec::new();
    let mut at = fit.start;
    for primitive in &fit.primitives {
        let (to, polar) = match primitive {
            Primitive::Line { to } => (*to, false),
            Primitive::Spiral { to } => (*to, true),
            other => panic!("neither line nor spiral: {other:?}"),
        };
        for i in 0..=each {
            let s = f64::from(i) / f64::from(each);
            let mix = |k: usize| at[k] as f64 + (to[k] - at[k]) as f64 * s;
            points.push(if polar {
                let (sin, cos) = math::sin_cos(mix(1) * grid.angle_step * math::DEG);
                Point2::new(mix(0) * grid.step * cos, mix(0) * grid.step * sin)
            } else {
                Point2::new(mix(0) * grid.step, mix(1) * grid.step)
            });
        }
        at = to;
    }
    points
}

/// A dense point of the curve.
#[derive(Clone, Copy)]
struct Dense {
    span: usize,
    u: f64,
    /// Parameters of its neighbours on the span.
    between: (f64, f64),
    f: Frenet,
}

fn dense(curve: &dyn PlanarCurve, each: u32) -> Vec<Dense> {
    let breaks = curve.breaks();
    let mut points = Vec::new();
    for (span, pair) in breaks.windows(2).enumerate() {
        let at = |i: u32| pair[0] + (pair[1] - pair[0]) * f64::from(i) / f64::from(each);
        for i in 0..=each {
            let between = (at(i.saturating_sub(1)), at((i + 1).min(each)));
            points.push(Dense { span, u: at(i), between, f: curve.at_in(span, at(i)) });
        }
    }
    points
}

/// The curve's nearest point among those about a dense point, by Newton's method held between its neighbours.
fn nearest(p: Point2, curve: &dyn PlanarCurve, at: &Dense) -> (f64, Frenet) {
    let (mut u, mut f) = (at.u, at.f);
    for _ in 0..4 {
        let w = p - f.p;
        u += w.dot(&f.t) / (f.speed * (1.0 - w.dot(&f.n()) * f.k).max(0.1));
        u = u.clamp(at.between.0, at.between.1);
        f = curve.at_in(at.span, u);
    }
    (u, f)
}

/// Signed distance of `p` from the curve, searched around index `near` (all of it when `wide`); updates `near`.
fn distance(p: Point2, curve: &dyn PlanarCurve, points: &[Dense], near: &mut usize, wide: bool) -> f64 {
    let n = points.len();
    // of the chord from a dense point to the next: at a sharp corner the nearest point may be one of the wrong side
    let far = |k: usize| segment(p, points[k].f.p, points[if k + 1 < n { k + 1 } else { k }].f.p);
    let best_of = |reach: usize| {
        let around = (0..=2 * reach).map(|k| (*near + n * 2 + k - reach) % n);
        around.min_by(|a, b| far(*a).total_cmp(&far(*b))).unwrap_or(0)
    };
    // downhill from the last one, in strides that pass over small bumps
    let mut best = best_of(if wide { n } else { 12 });
    while !wide && best != *near {
        *near = best;
        let around = (0..=24).map(|k| (*near + n + k - 12) % n);
        best = around.min_by(|a, b| far(*a).total_cmp(&far(*b))).unwrap_or(0);
    }
    *near = best;
    // the nearest point may lie on the span before or after a break
    let feet = [0, 1, 2, n - 1].map(|k| {
        let at = &points[(best + k) % n];
        let (u, f) = nearest(p, curve, at);
        ((p - f.p).norm(), at.span, u, f)
    });
    let (_, span, u, f) = feet.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
    let (w, corner) = (p - f.p, (p - f.p).dot(&f.t).abs() > 1e-6);
    if !corner {
        return w.dot(&f.n());
    }
    let breaks = curve.breaks();
    let spans = breaks.len() - 1;
    let (ends, starts) = (u >= breaks[span + 1] - 1e-9, u <= breaks[span] + 1e-9);
    let last = span + 1 == spans && ends || span == 0 && starts;
    if last && !curve.is_closed() {
        return w.dot(&f.n());
    }
    let other = if ends { (span + 1) % spans } else { (span + spans - 1) % spans };
    let n = f.n() + curve.at_in(other, if ends { breaks[other] } else { breaks[other + 1] }).n();
    w.norm() * w.dot(&n).signum()
}

/// Brute-force check of a fit; returns the largest deviations to the left and right.
fn check(tube: &Tube, grid: &Grid, fit: &Fit, each: u32) -> (f64, f64) {
    let curve = dense(tube.curve, each);
    let turns = matches!(fit.primitives[0], Primitive::Spiral { .. });
    let points = path(fit, grid, if turns { 400 } else { 60 });
    let (mut left, mut right) = (0.0_f64, 0.0_f64);
    let (mut near, mut first) = (0, true);
    for p in &points {
        let d = distance(*p, tube.curve, &curve, &mut near, first);
        first = false;
        left = left.max(d);
        right = right.max(-d);
    }
    assert!(left <= tube.left + 2e-6, "{left} mm to the left of {}", tube.left);
    assert!(right <= tube.right + 2e-6, "{right} mm to the right of {}", tube.right);
    let (l, r) = fit.deviation;
    assert!(l <= tube.left + 1e-8 && r <= tube.right + 1e-8, "certificate {l} {r} leaves the band");
    assert!(left <= l + 2e-6 && right <= r + 2e-6, "measured {left} {right}, certified {l} {r}");
    if tube.curve.is_closed() {
        assert!((points[0] - points[points.len() - 1]).norm() < 1e-9, "does not close");
    } else {
        let ends = [(points[0], curve[0].f.p), (points[points.len() - 1], curve[curve.len() - 1].f.p)];
        let reach = grid.step + tube.left.min(tube.right);
        assert!(ends.iter().all(|(a, b)| (a - b).norm() < 2.0 * reach + 1e-3), "ends are off");
    }
    // every point of the curve has the path near it
    let wide = 1.01 * tube.left.max(tube.right) + 2e-6;
    let mut k = 0;
    for f in curve.iter().step_by(7).map(|d| d.f) {
        let n = points.len();
        let close = |i: usize| segment(f.p, points[i % n], points[(i + 1) % n]) <= wide;
        let found = (0..n).map(|i| (k + i) % n).find(|i| *i + 1 < n && close(*i));
        let least = || (0..n - 1).map(|i| segment(f.p, points[i], points[i + 1])).fold(f64::MAX, f64::min);
        assert!(found.is_some() || !tube.curve.is_closed(), "nothing within {} of {}", least(), f.p);
        k = found.unwrap_or(k);
    }
    (left, right)
}

fn segment(p: Point2, a: Point2, b: Point2) -> f64 {
    let d = b - a;
    let s = if d.norm_squared() > 0.0 { ((p - a).dot(&d) / d.norm_squared()).clamp(0.0, 1.0) } else { 0.0 };
    (p - (a + d * s)).norm()
}

/// Fits, checks by brute force, and holds the count against the proven bound.
fn run(tube: &Tube, grid: &Grid, fitter: Fitter, each: u32) -> usize {
    let fit = fitter(tube, grid, None).unwrap_or_else(|e| panic!("{e}"));
    check(tube, grid, &fit, each);
    let n = fit.primitives.len();
    let bound = fit.lower_bound.unwrap_or(0) as usize;
    assert!(n >= bound, "{n} beats the proven bound {bound}");
    assert!(n as f64 <= 1.04 * bound as f64 + 1.0, "{n} links, bound {bound}");
    n
}

#[test]
#[ignore = "prints figures"]
fn figures() {
    let curve = paper();
    let grids =
        [("mm3", grid(3)), ("mm4", grid(4)), ("mm5", Grid { angle_step: 1e-5, ..grid(5) }), ("in4", inch())];
    for (left, right) in [(0.01, 0.01), (0.0, 0.01), (0.01, 0.0)] {
        let tube = Tube { curve: &curve, left, right };
        for (name, grid) in grids {
            for (kind, fit) in [("lines", lines as Fitter), ("spirals", spirals)] {
                let t = Instant::now();
                let answer: Result<Fit, FitError> = fit(&tube, &grid, None);
                let time = t.elapsed();
                match answer {
                    Ok(f) => println!(
                        "{left} {right} {name} {kind}: {} bound {:?} dev {:?} {time:?}",
                        f.primitives.len(),
                        f.lower_bound,
                        f.deviation
                    ),
                    Err(e) => println!("{left} {right} {name} {kind}: {e} {time:?}"),
                }
            }
        }
    }
}

#[test]
fn the_papers_cam_needs_no_more_lines_than_asked() {
    let curve = paper();
    for (left, right, most) in [(0.01, 0.01, [100, 98]), (0.0, 0.01, [142, 139]), (0.01, 0.0, [142, 139])] {
        let tube = Tube { curve: &curve, left, right };
        for (grid, most) in [(grid(3), most[0]), (inch(), most[0]), (grid(4), most[1]), (grid(5), most[1])] {
            assert!(run(&tube, &grid, lines, 600) <= most);
        }
    }
}

#[test]
fn the_papers_cam_needs_no_more_spirals_than_asked() {
    let curve = paper();
    for (left, right, most) in [(0.01, 0.01, 42), (0.0, 0.01, 59), (0.01, 0.0, 59)] {
        let tube = Tube { curve: &curve, left, right };
        for grid in [grid(3), inch(), Grid { angle_step: 1e-4, ..grid(4) }] {
            assert!(run(&tube, &grid, spirals, 600) <= most);
        }
    }
}

#[test]
fn the_bound_of_the_papers_cam_is_the_known_optimum() {
    let curve = paper();
    for (left, right, many, turns) in [(0.01, 0.01, 97, 40), (0.0, 0.01, 137, 56)] {
        let tube = Tube { curve: &curve, left, right };
        assert_eq!(bound::lines(&tube, &grid(3)), Ok(many));
        assert_eq!(bound::spirals(&tube, &grid(3)), Ok(turns));
    }
}

#[test]
fn a_profile_with_inflections_is_fitted_as_well() {
    let curve = Pitch::new(20.0, 20.0);
    for (left, right) in [(0.01, 0.01), (0.0, 0.01), (0.003, 0.001), (0.05, 0.0)] {
        let tube = Tube { curve: &curve, left, right };
        for grid in [grid(3), grid(4)] {
            run(&tube, &grid, lines, 1200);
            run(&tube, &grid, spirals, 1200);
        }
    }
}

#[test]
fn the_count_does_not_depend_on_how_the_curve_is_seen() {
    let plain = {
        let curve = paper();
        let tube = Tube { curve: &curve, left: 0.002, right: 0.01 };
        (run(&tube, &grid(3), lines, 600), run(&tube, &grid(3), spirals, 600))
    };
    for how in [How::Mirrored, How::Turned, How::Reversed] {
        let curve = Seen::new(paper(), how);
        let (left, right) = if how == How::Turned { (0.002, 0.01) } else { (0.01, 0.002) };
        let tube = Tube { curve: &curve, left, right };
        let seen = (run(&tube, &grid(3), lines, 600), run(&tube, &grid(3), spirals, 600));
        assert!(
            seen.0.abs_diff(plain.0) <= 1 && seen.1.abs_diff(plain.1) <= 1,
            "{how:?}: {seen:?}, {plain:?}"
        );
    }
}

#[test]
fn a_preferred_start_is_honoured() {
    let curve = paper();
    let tube = Tube { curve: &curve, left: 0.01, right: 0.01 };
    for start in [0.3, 2.0, 4.4] {
        let fit = lines(&tube, &grid(3), Some(start)).unwrap();
        let first = path(&fit, &grid(3), 1)[0];
        assert!((first - curve.at(start).p).norm() < 4.5, "starts at {first}");
        assert!(fit.primitives.len() <= 99);
    }
}

/// The gates looked at for a link do not become more as the links do: 30 times as many links in 1000 times less band.
#[test]
fn the_work_grows_as_the_links_do() {
    let curve = paper();
    let fine = Grid { angle_step: 1e-6, ..grid(6) };
    for plane in [Plane::xy(&fine), Plane::polar(&fine)] {
        let each = |band: f64| {
            let tube = Tube { curve: &curve, left: band, right: band };
            let (fit, work) = chain::counted(&tube, plane, None).unwrap();
            let (links, bound) = (fit.primitives.len() as f64, f64::from(fit.lower_bound.unwrap()));
            assert!(links <= 1.04 * bound + 1.0, "{band}: {links} links, bound {bound}");
            work as f64 / links
        };
        let coarse = each(1e-2);
        for band in [1e-3, 1e-4, 1e-5] {
            let fine = each(band);
            assert!(fine < 1.5 * coarse, "{band}: {fine} gates a link, {coarse} at 0.01 mm");
        }
    }
}

#[test]
fn polygons_take_one_line_a_side() {
    let square = Polygon::new(&[(0.0, 0.0), (40.0, 0.0), (40.0, 30.0), (0.0, 30.0), (0.0, 0.0)]);
    for (left, right) in [(0.01, 0.01), (0.0, 0.01), (0.01, 0.0), (0.0, 0.0)] {
        let tube = Tube { curve: &square, left, right };
        let fit = lines(&tube, &grid(3), None).unwrap();
        check(&tube, &grid(3), &fit, 3000);
        assert_eq!(fit.primitives.len(), 4, "{left} {right}");
        assert!(fit.lower_bound <= Some(4));
    }
}

#[test]
fn an_open_polyline_keeps_its_corners() {
    let open = Polygon::new(&[(0.1, 0.2), (10.0, 0.2), (14.3, 7.7), (3.0, 5.0), (3.0, 2.0)]);
    for (left, right) in [(0.01, 0.01), (0.0, 0.01), (0.01, 0.0), (0.003, 0.003)] {
        let tube = Tube { curve: &open, left, right };
        let fit = lines(&tube, &grid(3), None).unwrap();
        check(&tube, &grid(3), &fit, 3000);
        assert_eq!(fit.primitives.len(), 4, "{left} {right}");
    }
}

#[test]
fn open_zigzags_of_many_corners_take_one_line_a_side() {
    for corners in [500_usize, 4000] {
        let sides = corners - 1;
        let point = |k: usize| {
            let (sin, cos) = math::sin_cos(k as f64 / corners as f64 * math::TAU);
            let r = if k.is_multiple_of(2) { 100.5 } else { 100.0 };
            (r * cos, r * sin)
        };
        let points: Vec<(f64, f64)> = (0..=sides).map(point).collect();
        let open = Polygon::new(&points);
        let tube = Tube { curve: &open, left: 0.01, right: 0.01 };
        let fit = lines(&tube, &grid(3), None).unwrap();
        assert_eq!((fit.primitives.len(), fit.lower_bound), (sides, Some(sides as u32)));
    }
}

#[test]
fn the_ends_of_an_open_curve_count_in_the_bound() {
    let curve = Fourier {
        centre: Vec2::new(1.6263287552962287, -2.1971428174232615),
        terms: vec![
            (34.25495718737188, 0.0),
            (0.0, 0.0),
            (1.6165756972656113, 1.928091322199272),
            (0.7731542604186659, -0.17040798556676154),
            (0.2256865810967379, -0.4543781220921744),
            (-0.025277457108059984, -0.06731474570675733),
            (-0.16081201636610312, 0.021644237128500634),
        ],
        breaks: [1.5904311468447954, 5.149527482634128],
    };
    let tube = Tube { curve: &curve, left: 0.01638988692065119, right: 0.003115338914163301 };
    for grid in [grid(3), grid(4), inch()] {
        run(&tube, &grid, lines, 3000);
        run(&tube, &grid, spirals, 3000);
    }
}

#[test]
fn a_straight_line_is_one_link_of_least_deviation() {
    let line = Polygon::new(&[(0.0, 0.0), (37.1234, 11.9876)]);
    let tube = Tube { curve: &line, left: 0.01, right: 0.01 };
    let fit = lines(&tube, &grid(3), None).unwrap();
    assert_eq!(fit.primitives.len(), 1);
    assert!(fit.deviation.0.max(fit.deviation.1) < 0.001);
}

#[test]
fn a_centred_circle_is_one_turn_of_few_spirals() {
    let circle = Fourier { centre: Vec2::zeros(), terms: vec![(25.0, 0.0)], breaks: [0.0, math::TAU] };
    let tube = Tube { curve: &circle, left: 0.01, right: 0.01 };
    let fit = spirals(&tube, &grid(3), None).unwrap();
    // an axis that rolls over by the shorter way must turn the right way too
    assert_eq!(fit.primitives.len(), 3);
    let mut before = fit.start[1];
    for link in &fit.primitives {
        let Primitive::Spiral { to } = link else { panic!("{link:?}") };
        assert!((1..180_000).contains(&(to[1] - before)), "{} to {}", before, to[1]);
        before = to[1];
    }
    assert_eq!(before - fit.start[1], 360_000);
}

#[test]
fn bands_beyond_the_grid_are_refused_with_figures() {
    let off = Polygon::new(&[(0.0, 0.0005), (20.0, 0.0005), (20.0, 15.0005), (0.0, 15.0005), (0.0, 0.0005)]);
    let tube = Tube { curve: &off, left: 0.0001, right: 0.0001 };
    match lines(&tube, &grid(3), None) {
        Err(FitError::BandTooNarrow { needed, have, .. }) => {
            assert!((have - 0.0002).abs() < 1e-12 && needed > 0.0009 && needed < 0.01, "{needed} {have}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_curve_not_seen_from_the_origin_is_refused() {
    let circle = Fourier { centre: Vec2::new(30.0, 0.0), terms: vec![(25.0, 0.0)], breaks: [0.0, math::TAU] };
    let tube = Tube { curve: &circle, left: 0.01, right: 0.01 };
    assert!(matches!(spirals(&tube, &grid(3), None), Err(FitError::NotStarShaped { .. })));
    run(&tube, &grid(3), lines, 2000);
}

#[test]
fn large_and_small_curves_are_fitted() {
    for (radius, band, decimals) in [(2000.0, 0.05, 3), (0.8, 0.002, 4), (5.0, 0.5, 3), (150.0, 0.0005, 4)] {
        let terms = vec![(radius, 0.0), (0.0, 0.0), (0.1 * radius, 0.05 * radius)];
        let curve = Fourier { centre: Vec2::zeros(), terms, breaks: [0.0, math::TAU] };
        let tube = Tube { curve: &curve, left: band, right: band };
        run(&tube, &grid(decimals), lines, 6000);
        run(&tube, &Grid { angle_step: 1e-4, ..grid(decimals) }, spirals, 6000);
    }
}

prop_compose! {
    fn fourier(closed: bool)(
        radius in 8.0..60.0_f64,
        shape in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 1..6),
        centre in (-3.0..3.0_f64, -3.0..3.0_f64),
        range in (0.0..3.0_f64, 0.3..4.0_f64),
    ) -> Fourier {
        let mut terms = vec![(radius, 0.0), (0.0, 0.0)];
        terms.extend(shape.iter().enumerate().map(|(k, (c, s))| {
            let size = 0.25 * radius / ((k + 2) * (k + 2)) as f64;
            (c * size, s * size)
        }));
        let breaks = if closed { [0.0, math::TAU] } else { [range.0, range.0 + range.1] };
        Fourier { centre: Vec2::new(centre.0, centre.1), terms, breaks }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 16, ..ProptestConfig::default() })]

    #[test]
    fn closed_curves_stay_in_their_band(curve in fourier(true), left in 0.0..0.02_f64, right in 0.004..0.02_f64) {
        let tube = Tube { curve: &curve, left, right };
        run(&tube, &grid(3), lines, 6000);
        run(&tube, &grid(3), spirals, 6000);
        run(&tube, &inch(), lines, 6000);
    }

    #[test]
    fn open_curves_stay_in_their_band(curve in fourier(false), left in 0.004..0.02_f64, right in 0.0..0.02_f64) {
        let tube = Tube { curve: &curve, left, right };
        run(&tube, &grid(3), lines, 6000);
        run(&tube, &grid(3), spirals, 6000);
    }
}

/// Fewest links by exhaustive search over all grid points of a short open curve's tube.
fn exhaustive(tube: &Tube, grid: &Grid, fit: &Fit) -> usize {
    let curve = dense(tube.curve, 160);
    let all: Vec<Point2> = curve.iter().map(|d| d.f.p).collect();
    let low = all.iter().fold(Vec2::repeat(f64::MAX), |m, p| Vec2::new(m.x.min(p.x), m.y.min(p.y)));
    let high = all.iter().fold(Vec2::repeat(f64::MIN), |m, p| Vec2::new(m.x.max(p.x), m.y.max(p.y)));
    let mut vertices = Vec::new();
    let range = |a: f64, b: f64| ((a / grid.step).floor() as i64 - 2)..=((b / grid.step).ceil() as i64 + 2);
    for x in range(low.x, high.x) {
        for y in range(low.y, high.y) {
            let p = Point2::new(x as f64 * grid.step, y as f64 * grid.step);
            let mut near = 0;
            let d = distance(p, tube.curve, &curve, &mut near, true);
            if d <= tube.left && d >= -tube.right && near > 0 && near + 1 < curve.len() {
                vertices.push((near, p));
            }
        }
    }
    let ends = path(fit, grid, 1);
    vertices.push((0, ends[0]));
    vertices.push((curve.len() - 1, ends[ends.len() - 1]));
    vertices.sort_by_key(|v| v.0);
    let sees = |a: &(usize, Point2), b: &(usize, Point2)| {
        (a.0 + 1..b.0).all(|i| {
            let f = &curve[i].f;
            let d = -cross(b.1 - a.1, f.p - a.1) / (b.1 - a.1).dot(&f.t);
            d <= tube.left && d >= -tube.right
        })
    };
    let mut links = vec![usize::MAX; vertices.len()];
    links[0] = 0;
    for j in 1..vertices.len() {
        for i in 0..j {
            if links[i] != usize::MAX && links[i] + 1 < links[j] && sees(&vertices[i], &vertices[j]) {
                links[j] = links[i] + 1;
            }
        }
    }
    links[vertices.len() - 1]
}

#[test]
fn small_cases_match_exhaustive_search() {
    for (terms, band) in [
        (vec![(10.0, 0.0)], (0.05, 0.05)),
        (vec![(10.0, 0.0), (0.0, 0.0), (2.0, 0.5)], (0.06, 0.03)),
        (vec![(8.0, 0.0), (0.0, 0.0), (0.0, 0.0), (1.0, -0.6)], (0.0, 0.1)),
        (vec![(12.0, 0.0), (0.0, 0.0), (0.0, 0.0), (0.0, 0.0), (0.7, 0.7)], (0.1, 0.0)),
    ] {
        let curve = Fourier { centre: Vec2::zeros(), terms, breaks: [0.2, 1.3] };
        let tube = Tube { curve: &curve, left: band.0, right: band.1 };
        let coarse = Grid { step: 0.025, centre_step: 0.025, angle_step: 0.1 };
        let fit = lines(&tube, &coarse, None).unwrap();
        check(&tube, &coarse, &fit, 4000);
        let best = exhaustive(&tube, &coarse, &fit);
        assert!(
            fit.primitives.len() <= best + usize::from(best > 6),
            "{} against {best}",
            fit.primitives.len()
        );
    }
}
