//! Known primitives against known curves.

use super::clearance::Clearance;
use super::follow::{self, Break, Followed, Slack};
use super::path::Primitive;
use super::rail::Rail;
use crate::geom::curve::{CircularArc, CurveRef, Segment, bezier_chain};
use crate::geom::{Point2, Side};
use crate::math::{PI, TAU, sin_cos};
use crate::readback::{FeedMode, TraceMove, TracePath};

use std::sync::Arc;

fn polar(r: f64, angle: f64) -> Point2 {
    let (s, c) = sin_cos(angle);
    Point2::new(r * c, r * s)
}

fn cut(path: TracePath) -> TraceMove {
    TraceMove {
        path,
        z: (-1.0, -1.0),
        rapid: false,
        feed: Some(100.0),
        feed_mode: FeedMode::PerMinute,
        spindle: 1000.0,
        tool: 1,
        known: [true; 3],
        parked: false,
        length_offset: true,
        coolant: crate::readback::Washing::default(),
        compensation: None,
        work_offset: Some(1),
        in_cycle: false,
        path_tolerance: 0.0,
    }
}

fn followed(curve: &CurveRef, paths: Vec<TracePath>) -> Followed {
    let moves: Vec<TraceMove> = paths.into_iter().map(cut).collect();
    let run = moves.iter().enumerate().map(|(i, m)| (u32::try_from(i).unwrap_or(0) + 1, m)).collect();
    let rail = Rail::new(curve.as_ref());
    assert!(!rail.degenerate);
    follow::follow(&rail, &run, Slack { along: 1e-6, gross: 1.0 })
}

fn polygon(n: u32, r: f64) -> Vec<TracePath> {
    let corner = |i: u32| polar(r, TAU * f64::from(i % n) / f64::from(n));
    (0..n).map(|i| TracePath::Line { from: corner(i), to: corner(i + 1) }).collect()
}

fn circle(r: f64) -> CurveRef {
    Arc::new(CircularArc::circle(Point2::origin(), r, 0.0, true).expect("a circle"))
}

fn left(f: &Followed) -> f64 {
    f.left.expect("measured").d
}

fn right(f: &Followed) -> f64 {
    f.right.expect("measured").d
}

#[test]
fn chords_of_a_circle_deviate_by_their_sagitta() {
    for (n, r) in [(7, 1.0), (60, 48.0), (360, 28.123)] {
        let found = followed(&circle(r), polygon(n, r));
        let sagitta = r * (1.0 - sin_cos(PI / f64::from(n)).1);
        assert!((left(&found) - sagitta).abs() < 1e-9, "{n}: {} {sagitta}", left(&found));
        assert!(right(&found).abs() < 1e-12 && found.breaks.is_empty(), "{:?}", found.breaks);
    }
}

#[test]
fn a_circle_about_another_centre_deviates_by_the_shift() {
    let path = TracePath::Arc {
        from: Point2::new(20.03, 0.0),
        to: Point2::new(20.03, 0.0),
        centre: Point2::new(0.03, 0.0),
        sweep: TAU,
    };
    let found = followed(&circle(20.0), vec![path]);
    assert!((left(&found) - 0.03).abs() < 1e-6 && (right(&found) + 0.03).abs() < 1e-6, "{found:?}");
    assert!(found.breaks.is_empty());
}

#[test]
fn the_spiral_of_an_arc_with_two_radii_is_measured_as_drawn() {
    let path = TracePath::Arc {
        from: polar(20.0, 0.0),
        to: polar(20.004, 1.0),
        centre: Point2::origin(),
        sweep: 1.0,
    };
    let curve: CurveRef = Arc::new(CircularArc::new(Point2::origin(), 20.0, 0.0, 1.0).expect("an arc"));
    let found = followed(&curve, vec![path]);
    assert!((right(&found) + 0.004).abs() < 1e-9 && left(&found).abs() < 1e-12, "{found:?}");
}

#[test]
fn a_chord_of_a_spiral_table_move_bulges_by_the_known_amount() {
    // r = 10 + θ over half a radian, against its own start and end circle sector: the radius is exactly linear.
    let path = TracePath::Spiral { radius: (10.0, 10.0), angle: (0.0, TAU) };
    let found = followed(&circle(10.0), vec![path]);
    assert!(left(&found).abs() < 1e-12 && right(&found).abs() < 1e-12 && found.breaks.is_empty());
    let path = TracePath::Spiral { radius: (9.99, 10.02), angle: (0.0, TAU) };
    let found = followed(&circle(10.0), vec![path]);
    assert!((left(&found) - 0.01).abs() < 1e-9 && (right(&found) + 0.02).abs() < 1e-9);
}

#[test]
fn lines_against_a_line_with_a_corner_in_the_path() {
    let curve: CurveRef =
        Arc::new(Segment::new(Point2::new(0.0, 0.0), Point2::new(10.0, 0.0)).expect("a segment"));
    let paths = vec![
        TracePath::Line { from: Point2::new(0.0, 0.0), to: Point2::new(5.0, 0.02) },
        TracePath::Line { from: Point2::new(5.0, 0.02), to: Point2::new(10.0, -0.01) },
    ];
    let found = followed(&curve, paths);
    assert!(
        (left(&found) - 0.02).abs() < 1e-12
            && (right(&found) + 0.01).abs() < 1e-12
            && found.breaks.is_empty()
    );
    assert_eq!(found.left.expect("there").line, 1);
}

#[test]
fn what_leaves_out_turns_back_or_jumps_is_seen() {
    let r = 20.0;
    let whole = polygon(360, r);
    let mut short = whole.clone();
    short.pop();
    assert!(matches!(followed(&circle(r), short).breaks[..], [Break::End(359, s)] if s > 0.3));
    let mut hole = whole.clone();
    hole.remove(100);
    assert!(
        matches!(followed(&circle(r), hole).breaks[..], [Break::Jump(101, g)] if (g - 0.349).abs() < 0.01)
    );
    let mut twice = whole.clone();
    let again = TracePath::Line { from: whole[50].end(), to: whole[50].start() };
    twice.insert(51, again);
    twice.insert(52, whole[50].clone());
    assert!(matches!(followed(&circle(r), twice).breaks[..], [Break::Back(52, _)]));
    let mut round = whole.clone();
    round.extend(whole);
    assert!(followed(&circle(r), round).breaks.iter().any(|b| matches!(b, Break::End(..))));
    assert_eq!(followed(&circle(r), vec![]).breaks, [Break::Nothing]);
}

#[test]
fn a_path_across_to_a_far_branch_is_not_taken_for_the_curve() {
    // A hairpin: two branches 1 mm apart. The short cut ends exactly on the curve.
    let p = |x: f64, y: f64| Point2::new(x, y);
    let points = [
        p(0., 0.),
        p(10., 0.),
        p(20., 0.),
        p(30., 0.),
        p(40.4, 0.),
        p(40.4, 1.),
        p(30., 1.),
        p(20., 1.),
        p(10., 1.),
        p(0., 1.),
    ];
    let curve: CurveRef = Arc::new(bezier_chain(&points).expect("a chain"));
    let exact = |from: Point2, to: Point2| TracePath::Line { from, to };
    let paths =
        vec![exact(p(0., 0.), p(15., 0.)), exact(p(15., 0.), p(15., 1.)), exact(p(15., 1.), p(0., 1.))];
    let found = followed(&curve, paths);
    let gross = left(&found).max(-right(&found)) > 0.3;
    assert!(gross && !found.breaks.is_empty(), "{found:?}");
}

#[test]
fn a_corner_of_the_curve_is_measured_by_distance() {
    let p = |x: f64, y: f64| Point2::new(x, y);
    let corner = |a: Point2, b: Point2, c: Point2| -> CurveRef {
        let one: CurveRef = Arc::new(Segment::new(a, b).expect("a segment"));
        let two: CurveRef = Arc::new(Segment::new(b, c).expect("a segment"));
        Arc::new(crate::geom::curve::Chain::new(vec![one, two], 1e-9).expect("a chain"))
    };
    let curve = corner(p(0., 0.), p(10., 0.), p(10., 10.));
    // Cut across the inside of the corner: the middle of the chord is 0.01/√2 from both legs.
    let inside = vec![
        TracePath::Line { from: p(0., 0.), to: p(9.99, 0.) },
        TracePath::Line { from: p(9.99, 0.), to: p(10., 0.01) },
        TracePath::Line { from: p(10., 0.01), to: p(10., 10.) },
    ];
    let found = followed(&curve, inside);
    assert!((left(&found) - 0.005).abs() < 1e-6 && found.breaks.is_empty(), "{found:?}");
    // Round the outside of the corner: the tip of the path is √2 · 0.01 from the corner.
    let outside = vec![
        TracePath::Line { from: p(0., -0.01), to: p(10.01, -0.01) },
        TracePath::Line { from: p(10.01, -0.01), to: p(10.01, 10.) },
    ];
    let found = followed(&curve, outside);
    assert!((right(&found) + 0.01 * 2.0f64.sqrt()).abs() < 1e-6 && found.breaks.is_empty(), "{found:?}");
}

#[test]
fn a_tighter_polygon_gives_a_smaller_deviation() {
    let deviations: Vec<f64> =
        [30, 60, 120, 240].map(|n| left(&followed(&circle(30.0), polygon(n, 30.0)))).to_vec();
    assert!(deviations.windows(2).all(|w| (w[0] / w[1] - 4.0).abs() < 0.05), "{deviations:?}");
}

#[test]
fn gouges_are_found_and_touching_is_not_one() {
    let curve = circle(20.0);
    let rail = Rail::new(curve.as_ref());
    let clearance = Clearance { rail: &rail, part: Side::Left, floor: -0.01 };
    let line =
        |x: f64| Primitive::Line { from: Point2::new(x, -30.0), step: crate::geom::Vec2::new(0.0, 60.0) };
    assert_eq!(clearance.gouge(&line(20.0)), None);
    assert_eq!(clearance.gouge(&line(19.990_000_1)), None);
    let gouge = clearance.gouge(&line(19.98)).expect("a gouge");
    assert!((gouge.clearance + 0.02).abs() < 1e-6 && gouge.at.y.abs() < 0.1, "{gouge:?}");
    let lead = Primitive::Polar {
        centre: Point2::new(26.0, 0.0),
        radius: (6.0, 0.0),
        angle: (-PI / 2.0, -PI / 2.0),
    };
    assert_eq!(clearance.gouge(&lead), None);
    let deep = Primitive::Polar {
        centre: Point2::new(26.0, 0.0),
        radius: (6.1, 0.0),
        angle: (-PI / 2.0, -PI / 2.0),
    };
    assert!(clearance.gouge(&deep).is_some_and(|g| (g.clearance + 0.1).abs() < 1e-4));
    let outer = Clearance { rail: &rail, part: Side::Right, floor: -0.01 };
    assert!(outer.gouge(&line(0.0)).is_some());
    let inner = Primitive::Line { from: Point2::new(0.0, -19.0), step: crate::geom::Vec2::new(0.0, 38.0) };
    assert_eq!(outer.gouge(&inner), None);
}
