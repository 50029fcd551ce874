use proptest::prelude::*;

use super::*;
use crate::geom::curve::testing::assert_frenet_matches_differences;
use crate::geom::curve::{Shape, ends};
use crate::geom::follower::ArmSide;
use crate::geom::measure::{length, signed_area};
use crate::geom::motion::{Law, Segment, SegmentLaw};
use crate::math::{DEG, PI, cos, hypot, sin, sin_cos};

fn deg(v: f64) -> Angle {
    Angle::degrees(v)
}

fn law(name: &str) -> SegmentLaw {
    SegmentLaw::Law(Law::by_name(name).expect("in the table"))
}

/// Dwell to 30, rise to 150, dwell to 210, return to 330, dwell.
fn example_motion(lift: f64, name: &str) -> Motion {
    Motion::from_segments(vec![
        Segment::dwell(deg(30.0)),
        Segment::rise(deg(120.0), lift, law(name)),
        Segment::dwell(deg(60.0)),
        Segment::fall(deg(120.0), lift, law(name)),
        Segment::dwell(deg(30.0)),
    ])
    .expect("a motion")
}

fn roller(radius: f64, offset: f64) -> Follower {
    Follower::TranslatingRoller { radius, offset }
}

fn build(base: f64, follower: Follower, motion: Motion) -> Cam {
    Cam::new(CamDefinition::new(base, follower, motion)).expect("a cam")
}

/// The cam of Kim & Yang's example, 20 mm being the profile's or the pitch curve's smallest radius.
fn paper() -> Cam {
    build(20.0, roller(8.0, 0.0), example_motion(20.0, "MODSIN"))
}

fn paper_by_pitch() -> Cam {
    build(12.0, roller(8.0, 0.0), example_motion(20.0, "MODSIN"))
}

fn near(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance, "{a} for {b}");
}

/// A row of the reference points.
#[derive(serde::Deserialize)]
struct Row {
    cam: String,
    kind: String,
    base: f64,
    roller: f64,
    offset: f64,
    pivot: f64,
    arm: f64,
    side: i8,
    lift: f64,
    law: String,
    flank: String,
    turns: String,
    angle: f64,
    s: f64,
    x: f64,
    y: f64,
    normal_x: f64,
    normal_y: f64,
    curvature: f64,
}

impl Row {
    fn cam(&self) -> Cam {
        let side = if self.side < 0 { ArmSide::Left } else { ArmSide::Right };
        let follower = match self.kind.as_str() {
            "tr" => roller(self.roller, self.offset),
            "tf" => Follower::TranslatingFlat { offset: self.offset },
            "or" => {
                Follower::OscillatingRoller { radius: self.roller, arm: self.arm, pivot: self.pivot, side }
            }
            "of" => Follower::OscillatingFlat { pivot: self.pivot, offset: self.offset, side },
            other => panic!("{other}"),
        };
        let mut definition = CamDefinition::new(self.base, follower, example_motion(self.lift, &self.law));
        definition.groove = self.flank() == Flank::Outer;
        if self.turns == "cclw" {
            definition.rotation = Rotation::CounterClockwise;
        }
        Cam::new(definition).expect("a cam")
    }
    fn flank(&self) -> Flank {
        if self.flank == "outer" { Flank::Outer } else { Flank::Inner }
    }
}

#[test]
fn points_normals_and_curvatures_are_those_of_an_independent_computation() {
    let mut reader = csv::Reader::from_reader(include_str!("../../../tests/data/cams.csv").as_bytes());
    let rows: Vec<Row> = reader.deserialize().collect::<Result<_, _>>().expect("a table");
    assert_eq!(rows.len(), 264);
    for rows in rows.chunk_by(|a, b| a.cam == b.cam) {
        let cam = rows[0].cam();
        for row in rows {
            let f = cam.contact(row.flank(), deg(row.angle));
            let error = hypot(f.p.x - row.x, f.p.y - row.y);
            assert!(error < 1e-12 * row.base + 1e-11, "{} at {}: {error}", row.cam, row.angle);
            near(cam.lift(deg(row.angle)).s, row.s, 1e-12);
            near(f.k, row.curvature, 1e-12);
            let outwards = -f.n();
            near(hypot(outwards.x - row.normal_x, outwards.y - row.normal_y), 0.0, 1e-12);
        }
    }
}

#[test]
fn the_papers_cam_has_its_figures() {
    let cam = paper();
    let f = cam.figures();
    near(f.inner.length, 195.222_941_379, 1e-9);
    near(f.inner.area, 2_992.968_087, 1e-6);
    near(f.pressure_angle.value / DEG, 24.577_835, 1e-6);
    assert!([81.428_58, 278.571_42].iter().any(|a| (f.pressure_angle.at.deg() - a).abs() < 1e-4));
    near(f.inner.nearest.value, 20.0, 1e-13);
    near(f.inner.farthest.value, 40.0, 1e-13);
    near(f.velocity.value, 16.802_97, 1e-5);
    assert_eq!(f.inner.concave, None);
    near(f.inner.convex.map_or(0.0, |c| c.value), 20.0, 1e-12);
    let least = cam.pitch().at(cam.parameter(deg(44.083))).k;
    near(least, 0.005_172_439, 1e-9);
    for (cutter, path) in [(5.0, 226.638_868), (8.0, 245.488_424), (10.0, 258.054_794)] {
        near(length(cam.centre(Flank::Inner, cutter).as_ref(), 1e-9), path, 1e-6);
    }
    assert!(cam.issues().is_empty());
}

#[test]
fn the_papers_cam_on_a_pitch_circle_of_20_has_its_figures() {
    let cam = paper_by_pitch();
    let f = cam.figures();
    near(f.inner.length, 146.662_836_073, 1e-9);
    near(f.inner.area, 1_672.422_526, 1e-6);
    near(f.pressure_angle.value / DEG, 30.625_788, 1e-6);
    near(f.inner.concave.map_or(0.0, |c| c.value), 136.325, 1e-3);
    let hollow = f.inner.concave.map_or(0.0, |c| c.at.rad());
    near(cam.pitch().at(hollow).k, -0.007_792_731, 1e-8);
    for inflection in [39.0006, 50.0594, 309.9404, 320.9992] {
        let k = |angle: f64| cam.pitch().at(cam.parameter(deg(angle))).k;
        assert!(k(inflection - 2e-4) * k(inflection + 2e-4) < 0.0, "{inflection}");
    }
    assert!(matches!(cam.issues(), [CamIssue::PressureAngle { .. }]));
    near(length(cam.centre(Flank::Inner, 10.0).as_ref(), 1e-9), 209.494_689, 1e-6);
}

#[test]
fn the_smallest_base_keeps_the_pressure_angle_and_one_a_little_smaller_does_not() {
    for (limit, pitch) in [(20.0, 37.175), (25.0, 27.320), (30.0, 20.682), (35.0, 15.891)] {
        let mut definition = CamDefinition::new(60.0, roller(4.0, 0.0), example_motion(20.0, "MODSIN"));
        definition.max_pressure_angle = deg(limit);
        let base = Cam::new(definition.clone()).expect("a cam").smallest_base().expect("exists");
        near(base + 4.0, pitch, 1e-3);
        definition.base = base;
        assert!(Cam::new(definition.clone()).expect("a cam").issues().is_empty());
        definition.base = base - 1e-3;
        assert!(!Cam::new(definition).expect("a cam").issues().is_empty());
    }
}

#[test]
fn the_papers_motion_on_a_flat_face_needs_its_width_and_base() {
    let cam = build(30.0, Follower::TranslatingFlat { offset: 0.0 }, example_motion(20.0, "MODSIN"));
    near(cam.figures().face.map_or(0.0, |f| f.width()), 33.606, 1e-3);
    near(cam.smallest_base().expect("exists"), 5.721, 1e-3);
    let too_small =
        CamDefinition::new(5.7, Follower::TranslatingFlat { offset: 0.0 }, example_motion(20.0, "MODSIN"));
    let issues = Cam::new(too_small).expect_err("undercut");
    assert!(
        matches!(issues[..], [CamIssue::Undercut { radius, roller: 0.0, .. }] if radius < 0.0),
        "{issues:?}"
    );
}

/// Every kind of follower, side and rotation.
fn all_kinds() -> Vec<CamDefinition> {
    let mut all = Vec::new();
    for rotation in [Rotation::Clockwise, Rotation::CounterClockwise] {
        let mut add = |base, follower, lift, groove| {
            let motion = example_motion(lift, "MODSIN");
            all.push(CamDefinition { rotation, groove, ..CamDefinition::new(base, follower, motion) });
        };
        for offset in [0.0, 6.0, -6.0] {
            add(30.0, roller(8.0, offset), 15.0, true);
        }
        add(60.0, Follower::TranslatingFlat { offset: 3.0 }, 15.0, false);
        for side in [ArmSide::Left, ArmSide::Right] {
            add(35.0, Follower::OscillatingRoller { radius: 7.0, arm: 70.0, pivot: 85.0, side }, 0.25, true);
            for offset in [0.0, 8.0, -8.0] {
                add(50.0, Follower::OscillatingFlat { pivot: 120.0, offset, side }, 0.15, false);
            }
        }
    }
    all
}

#[test]
fn flanks_and_centre_paths_have_matching_frenet_data_and_run_counter_clockwise() {
    for definition in all_kinds() {
        let cam = Cam::new(definition.clone()).expect("a cam");
        for flank in definition.flanks() {
            for offset in [0.0, 3.0] {
                let curve = cam.centre(*flank, offset);
                assert_frenet_matches_differences(curve.as_ref(), 1e-4);
                assert!(signed_area(curve.as_ref(), 1e-6) > 0.0);
                let (first, last) = ends(curve.as_ref());
                assert!((first - last).norm() < 1e-12 && curve.is_closed());
            }
        }
    }
}

#[test]
fn centre_paths_lie_off_the_material_by_their_offset() {
    for definition in all_kinds() {
        let cam = Cam::new(definition.clone()).expect("a cam");
        for flank in definition.flanks() {
            let (wall, path) = (cam.flank(*flank), cam.centre(*flank, 4.0));
            for i in 0..36 {
                let u = f64::from(i) * 10.0 * DEG;
                let gap = path.at(u).p - wall.at(u).p;
                near(gap.norm(), 4.0, 1e-12);
                near(gap.dot(&wall.at(u).n()) * cam.material(*flank).sign(), -4.0, 1e-12);
            }
        }
    }
}

#[test]
fn a_counter_clockwise_cam_is_the_mirror_image() {
    for definition in all_kinds().into_iter().filter(|d| d.rotation == Rotation::Clockwise) {
        let mirrored = CamDefinition { rotation: Rotation::CounterClockwise, ..definition.clone() };
        let (a, b) = (Cam::new(definition).expect("a cam"), Cam::new(mirrored).expect("a cam"));
        near(a.figures().inner.length, b.figures().inner.length, 1e-9);
        for i in 0..72 {
            let angle = deg(f64::from(i) * 5.0 + 1.0);
            let (f, g) = (a.contact(Flank::Inner, angle), b.contact(Flank::Inner, angle));
            near(hypot(f.p.x - g.p.x, f.p.y + g.p.y), 0.0, 1e-12);
            near(f.k, g.k, 1e-13);
        }
    }
}

#[test]
fn a_larger_scale_gives_the_same_cam_larger() {
    let scale = 25.4;
    let small = build(20.0 / scale, roller(8.0 / scale, 2.0 / scale), example_motion(20.0 / scale, "CYCLO"));
    let large = build(20.0, roller(8.0, 2.0), example_motion(20.0, "CYCLO"));
    for i in 0..72 {
        let angle = deg(f64::from(i) * 5.0);
        let (f, g) = (small.contact(Flank::Inner, angle), large.contact(Flank::Inner, angle));
        near((f.p * scale - g.p).norm(), 0.0, 1e-12);
        near(f.k / scale, g.k, 1e-13);
    }
    near(small.figures().inner.length * scale, large.figures().inner.length, 1e-7);
    near(small.figures().pressure_angle.value, large.figures().pressure_angle.value, 1e-12);
}

#[test]
fn a_motion_that_starts_later_gives_the_cam_turned() {
    let later = Motion::from_segments(vec![
        Segment::rise(deg(120.0), 20.0, law("MODSIN")),
        Segment::dwell(deg(60.0)),
        Segment::fall(deg(120.0), 20.0, law("MODSIN")),
        Segment::dwell(deg(60.0)),
    ])
    .expect("a motion");
    let (a, b) = (paper(), build(20.0, roller(8.0, 0.0), later));
    let (s, c) = sin_cos(30.0 * DEG);
    for i in 0..72 {
        let angle = f64::from(i) * 5.0;
        let (p, q) = (a.contact(Flank::Inner, deg(angle + 30.0)).p, b.contact(Flank::Inner, deg(angle)).p);
        near(hypot(c * q.x - s * q.y - p.x, s * q.x + c * q.y - p.y), 0.0, 1e-12);
    }
}

#[test]
fn dwells_are_exact_arcs_about_the_centre() {
    for definition in all_kinds() {
        let cam = Cam::new(definition.clone()).expect("a cam");
        for flank in definition.flanks() {
            let curve = cam.centre(*flank, 2.0);
            let mut arcs = 0;
            for (span, a, b) in spans(curve.as_ref()) {
                let Shape::Arc { centre, radius, ccw } = curve.shape(span) else { continue };
                arcs += 1;
                assert!(ccw && centre == Point2::origin());
                for i in 0..=8 {
                    let f = curve.at_in(span, a + (b - a) * f64::from(i) / 8.0);
                    near(hypot(f.p.x, f.p.y), radius, 1e-13);
                    near(f.k, 1.0 / radius, 1e-14);
                }
            }
            assert_eq!(arcs, 3, "{definition:?}");
        }
    }
}

#[test]
fn a_flat_face_in_harmonic_motion_over_half_turns_runs_on_an_excentric_circle() {
    let motion = Motion::from_segments(vec![
        Segment::rise(deg(180.0), 30.0, law("SHM")),
        Segment::fall(deg(180.0), 30.0, law("SHM")),
    ])
    .expect("a motion");
    let cam = build(20.0, Follower::TranslatingFlat { offset: 0.0 }, motion);
    let curve = cam.flank(Flank::Inner);
    for (span, _, _) in spans(curve.as_ref()) {
        let Shape::Arc { centre, radius, .. } = curve.shape(span) else { panic!("an arc") };
        near(hypot(centre.x + 15.0, centre.y), 0.0, 1e-12);
        near(radius, 35.0, 1e-12);
    }
}

#[test]
fn speed_gives_the_followers_motion_in_time() {
    let mut definition = CamDefinition::new(20.0, roller(8.0, 0.0), example_motion(20.0, "MODSIN"));
    definition.speed = Some(600.0);
    let d = Cam::new(definition).expect("a cam").figures().dynamics.expect("a speed");
    let w = 20.0 * PI;
    near(d.velocity, 16.802_974_6 * w, 1e-4);
    near(d.acceleration, 25.204_461_9 * w * w / 1000.0, 1e-4);
}

#[test]
fn a_cutter_must_fit_the_concave_part_and_its_path_must_not_cross_itself() {
    let cam = build(20.0, roller(6.0, 0.0), {
        Motion::from_segments(vec![
            Segment::rise(deg(60.0), 22.0, law("MODSIN")),
            Segment::dwell(deg(30.0)),
            Segment::fall(deg(60.0), 22.0, law("MODSIN")),
            Segment::dwell(deg(210.0)),
        ])
        .expect("a motion")
    });
    let concave = cam.figures().inner.concave.expect("hollow").value;
    let limit = cam.max_cutter(Flank::Inner);
    assert!(limit.radius <= concave && limit.radius > 0.2 * concave && limit.at.is_some());
    assert_eq!(cam.cutter_issue(Flank::Inner, 0.99 * limit.radius), None);
    let issue = cam.cutter_issue(Flank::Inner, 1.01 * limit.radius);
    assert!(matches!(issue, Some(CamIssue::CutterTooLarge { .. })));
    assert!(paper().max_cutter(Flank::Inner).radius.is_infinite());
    assert_eq!(paper().cutter_issue(Flank::Inner, 500.0), None);
}

#[test]
fn a_groove_takes_no_cutter_larger_than_its_roller() {
    let mut definition = CamDefinition::new(35.0, roller(8.0, 0.0), example_motion(15.0, "MODSIN"));
    definition.groove = true;
    let cam = Cam::new(definition).expect("a cam");
    near(cam.max_cutter(Flank::Outer).radius, 8.0, 1e-12);
    assert_eq!(cam.cutter_issue(Flank::Outer, 8.0), None);
    assert!(cam.cutter_issue(Flank::Outer, 8.1).is_some());
    assert!(cam.figures().outer.is_some());
}

#[test]
fn cams_go_between_threads() {
    fn check<T: Send + Sync + Clone + core::fmt::Debug>() {}
    check::<Cam>();
    check::<CamDefinition>();
}

/// Random numbers that make a cam.
#[derive(Debug, Clone, Copy)]
struct Dice {
    kind: u8,
    base: f64,
    radius: f64,
    lift: f64,
    rise: f64,
    offset: f64,
    law: usize,
    ccw: bool,
}

fn dice() -> impl Strategy<Value = Dice> {
    let lengths = (10.0f64..60.0, 3.0f64..16.0, 2.0f64..25.0, 60.0f64..200.0, -8.0f64..8.0);
    (0u8..8, lengths, 0usize..8, any::<bool>()).prop_map(
        |(kind, (base, radius, lift, rise, offset), law, ccw)| Dice {
            kind,
            base,
            radius,
            lift,
            rise,
            offset,
            law,
            ccw,
        },
    )
}

/// A definition from random numbers; lifts of swinging followers are small angles.
fn definition(dice: Dice) -> CamDefinition {
    let Dice { kind, base, radius, lift, rise, offset, law: law_index, ccw } = dice;
    let names = ["MODSIN", "CYCLO", "P345", "P4567", "MODTRAP", "TRAPEC", "ONESIN", "SHM"];
    let side = if kind.is_multiple_of(2) { ArmSide::Left } else { ArmSide::Right };
    let pivot = 2.6 * (base + radius);
    let swings = kind >= 4;
    let lift = if swings { (lift / pivot).min(3.0) } else { lift };
    let follower = match kind {
        0 | 1 => roller(radius, offset),
        2 | 3 => Follower::TranslatingFlat { offset },
        4 | 5 => Follower::OscillatingRoller { radius, arm: 0.9 * pivot, pivot, side },
        _ => Follower::OscillatingFlat { pivot, offset: 0.3 * offset, side },
    };
    let l = law(names[law_index % names.len()]);
    let motion = Motion::from_segments(vec![
        Segment::dwell(deg(20.0)),
        Segment::rise(deg(rise), lift, l),
        Segment::dwell(deg(15.0)),
        Segment::fall(deg(360.0 - 55.0 - rise), lift, l),
        Segment::dwell(deg(20.0)),
    ])
    .expect("a motion");
    let rotation = if ccw { Rotation::CounterClockwise } else { Rotation::Clockwise };
    let groove = follower.has_roller() && kind % 2 == 1;
    CamDefinition { rotation, groove, ..CamDefinition::new(base, follower, motion) }
}

/// How far the follower at `theta` stays clear of a point of the profile that belongs to a clockwise cam: of a
/// roller, the distance less its radius; of a face, the distance to its line on the cam's side.
fn clearance(definition: &CamDefinition, theta: f64, p: Point2) -> f64 {
    let s = definition.motion.at(Angle::radians(theta)).s;
    let u = |a: f64| Vec2::new(cos(a), sin(a));
    let sign = |side| if side == ArmSide::Left { -1.0 } else { 1.0 };
    match definition.follower {
        Follower::TranslatingRoller { radius, offset } => {
            let d0 = ((definition.base + radius) * (definition.base + radius) - offset * offset).sqrt();
            let centre = u(theta) * (d0 + s) - u(theta + PI / 2.0) * offset;
            (p.coords - centre).norm() - radius
        }
        Follower::TranslatingFlat { .. } => definition.base + s - p.coords.dot(&u(theta)),
        Follower::OscillatingRoller { radius, arm, pivot, side } => {
            let reach = definition.base + radius;
            let s0 = crate::math::acos((pivot * pivot + arm * arm - reach * reach) / (2.0 * pivot * arm));
            let centre = u(theta) * pivot - u(theta - sign(side) * (s0 + s)) * arm;
            (p.coords - centre).norm() - radius
        }
        Follower::OscillatingFlat { pivot, offset, side } => {
            let psi = crate::math::asin((definition.base + offset) / pivot) + s;
            let normal = u(theta - sign(side) * (psi - PI / 2.0));
            pivot * sin(psi) - offset - p.coords.dot(&normal)
        }
    }
}

/// Smallest clearance of the follower over a fine net of cam angles and profile points, and how nearly it
/// touches at its own contact.
fn brute_force(definition: &CamDefinition, curves: &[CurveRef]) -> (f64, f64) {
    let flip = if definition.rotation == Rotation::CounterClockwise { -1.0 } else { 1.0 };
    let (mut least, mut touch) = (f64::INFINITY, 0.0_f64);
    for curve in curves {
        let wall: Vec<Point2> = (0..720)
            .map(|i| curve.at(f64::from(i) * TAU / 720.0).p)
            .map(|p| Point2::new(p.x, flip * p.y))
            .collect();
        for i in 0..120 {
            let theta = (f64::from(i) + 0.5) * TAU / 120.0;
            least = wall.iter().map(|p| clearance(definition, theta, *p)).fold(least, f64::min);
            let u = if flip < 0.0 { TAU - theta } else { theta };
            let p = curve.at(u).p;
            touch = touch.max(clearance(definition, theta, Point2::new(p.x, flip * p.y)).abs());
        }
    }
    (least, touch)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, ..ProptestConfig::default() })]

    /// The envelope property: at every cam angle the follower touches the profile and cuts it nowhere. A cam is
    /// refused exactly when it would.
    #[test]
    fn the_follower_touches_the_profile_and_never_cuts_it(dice in dice()) {
        const SEEN: f64 = 1e-3;
        let definition = definition(dice);
        match Cam::new(definition.clone()) {
            Ok(cam) => {
                let curves: Vec<CurveRef> = definition.flanks().iter().map(|f| cam.flank(*f)).collect();
                let (least, touch) = brute_force(&definition, &curves);
                prop_assert!(least > -1e-9, "cuts by {least}");
                prop_assert!(touch < 1e-9, "misses by {touch}");
            }
            Err(issues) if issues.iter().any(|i| matches!(i, CamIssue::Undercut { .. })) => {
                let linkage = Linkage::new(&definition.follower, definition.base).expect("reaches");
                let geometry = Arc::new(Geometry::new(linkage, definition.motion.clone(), dice.ccw));
                let curves: Vec<CurveRef> = definition.flanks().iter()
                    .map(|f| Arc::new(CamCurve::new(geometry.clone(), f.shift(linkage.roller))) as CurveRef)
                    .collect();
                let (least, _) = brute_force(&definition, &curves);
                let deep = issues.iter().any(|i| match i {
                    CamIssue::Undercut { radius: r, roller, .. } => *r < (1.0 - 0.1) * roller - SEEN,
                    _ => false,
                });
                prop_assert!(!deep || least < 0.0, "refused, but clear by {least}: {issues:?}");
            }
            Err(issues) => prop_assert!(!issues.is_empty()),
        }
    }

    /// Whatever the numbers, there is an answer.
    #[test]
    fn extreme_values_are_answered(
        kind in 0u8..8, exponents in proptest::array::uniform6(-12i32..13), rise in 1e-6f64..304.0, ccw in any::<bool>(),
    ) {
        let [base, radius, lift, offset, law, _] = exponents.map(|e| (0..e.abs()).fold(1.0, |v, _| if e < 0 { v / 10.0 } else { v * 10.0 }));
        let dice = Dice { kind, base, radius, lift: lift.min(1e9), rise, offset, law: law.min(7.0) as usize, ccw };
        if let Ok(cam) = Cam::new(definition(dice)) {
            prop_assert!(cam.figures().inner.length > 0.0);
            let _ = (cam.max_cutter(Flank::Inner), cam.smallest_base());
        }
    }
}
