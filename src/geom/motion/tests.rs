use super::*;
use crate::math::{DEG, cos, sin};

fn deg(v: f64) -> Angle {
    Angle::degrees(v)
}

fn law(name: &str) -> SegmentLaw {
    SegmentLaw::Law(Law::by_name(name).expect("in the table"))
}

/// The motion of Kim & Yang's example with any law.
fn dwell_rise_dwell_return(name: &str) -> Motion {
    Motion::from_segments(vec![
        Segment::dwell(deg(30.0)),
        Segment::rise(deg(120.0), 20.0, law(name)),
        Segment::dwell(deg(60.0)),
        Segment::fall(deg(120.0), 20.0, law(name)),
        Segment::dwell(deg(30.0)),
    ])
    .expect("a motion")
}

#[test]
fn the_papers_motion_has_its_lifts_and_peaks() {
    let m = dwell_rise_dwell_return("MODSIN");
    assert_eq!(m.at(deg(10.0)).s, 0.0);
    assert!((m.at(deg(90.0)).s - 10.0).abs() < 1e-13);
    assert!((m.at(deg(180.0)).s - 20.0).abs() < 1e-13);
    assert!((m.at(deg(90.0)).v - 16.802_97).abs() < 1e-5);
    assert!((m.at(deg(270.0)).v + 16.802_97).abs() < 1e-5);
    assert!((m.at(deg(45.0)).a - 25.204_46).abs() < 1e-5);
    assert!(m.issues().is_empty());
    assert_eq!(m.breaks().len(), 12);
    assert!(m.is_dwell(0) && m.is_dwell(5) && m.is_dwell(10) && !m.is_dwell(1));
}

#[test]
fn a_return_is_the_rise_turned_down_or_for_one_dwell_run_backwards() {
    let one_dwell: Vec<&str> =
        Law::all().iter().filter(|l| l.dwells_at_one_end()).map(|l| l.name()).collect();
    let expected = [
        "DBLHAR",
        "DBLHARREV",
        "ONECYCLO",
        "ONECYCLO23",
        "ONETRAP",
        "ONETRAP23",
        "FERGUSON",
        "ONESIN",
        "ONETRAPEC",
    ];
    assert_eq!(one_dwell, expected);
    for l in Law::all().iter().filter(|l| l.name() != "CV") {
        let m = dwell_rise_dwell_return(l.name());
        for i in 1..40 {
            let x = 3.0 * f64::from(i) - 0.1;
            let backwards = l.dwells_at_one_end();
            let (up, down) = (m.at(deg(30.0 + x)), m.at(deg(if backwards { 330.0 - x } else { 210.0 + x })));
            let (lift, accel) = if backwards { (down.s, down.a) } else { (20.0 - down.s, -down.a) };
            assert!((up.s - lift).abs() < 1e-12 && (up.v + down.v).abs() < 1e-11, "{}", l.name());
            assert!((up.a - accel).abs() < 1e-10, "{}", l.name());
        }
    }
}

#[test]
fn a_one_dwell_rise_and_return_meet_smoothly_at_the_top() {
    for name in ["ONECYCLO", "FERGUSON", "ONESIN", "DBLHAR"] {
        let m = Motion::from_segments(vec![
            Segment::rise(deg(140.0), 20.0, law(name)),
            Segment::fall(deg(140.0), 20.0, law(name)),
            Segment::dwell(deg(80.0)),
        ])
        .expect("a motion");
        assert!(m.issues().is_empty(), "{name}: {:?}", m.issues());
    }
}

#[test]
fn angles_and_lifts_that_do_not_close_are_reported_with_the_amount() {
    let issues = Motion::from_segments(vec![
        Segment::rise(deg(120.0), 20.0, law("MODSIN")),
        Segment::fall(deg(230.0), 15.0, law("MODSIN")),
    ])
    .expect_err("does not close");
    let missing = issues.iter().find_map(|i| match i {
        MotionIssue::AnglesDoNotClose { missing, .. } => Some(missing.deg()),
        _ => None,
    });
    assert!((missing.expect("angles reported") - 10.0).abs() < 1e-9);
    assert!(issues.contains(&MotionIssue::LiftDoesNotClose { rises: 20.0, returns: 15.0 }));
}

#[test]
fn bad_segments_are_all_reported() {
    let issues =
        Motion::from_segments(vec![Segment::dwell(deg(0.0)), Segment::rise(deg(360.0), 0.0, law("CYCLO"))])
            .expect_err("bad");
    assert_eq!(issues.len(), 2);
    assert_eq!(Motion::from_segments(Vec::new()), Err(vec![MotionIssue::Empty]));
}

#[test]
fn a_velocity_jump_is_an_error_with_place_and_values() {
    let issues = Motion::from_segments(vec![
        Segment::dwell(deg(90.0)),
        Segment::rise(deg(90.0), 10.0, law("CV")),
        Segment::fall(deg(180.0), 10.0, law("CYCLO")),
    ])
    .expect_err("velocity jumps");
    let first = issues.iter().find(|i| i.is_error()).expect("an error");
    let MotionIssue::Discontinuity { at, order: Order::Velocity, before, after } = first else {
        panic!("{first:?}")
    };
    assert!((at.deg() - 90.0).abs() < 1e-9 && *before == 0.0 && (after - 10.0 / (90.0 * DEG)).abs() < 1e-12);
}

#[test]
fn an_acceleration_jump_is_a_warning_at_every_place() {
    let m = dwell_rise_dwell_return("SHM");
    assert_eq!(m.issues().len(), 4);
    assert!(m.issues().iter().all(|i| !i.is_error()));
    assert_eq!(dwell_rise_dwell_return("CA").issues().len(), 6);
}

#[test]
fn a_motion_that_starts_high_has_its_lowest_lift_at_0() {
    let m = Motion::from_segments(vec![
        Segment::fall(deg(180.0), 20.0, law("CYCLO")),
        Segment::rise(deg(180.0), 20.0, law("CYCLO")),
    ])
    .expect("a motion");
    assert!((m.at(deg(0.0)).s - 20.0).abs() < 1e-13 && m.at(deg(180.0)).s.abs() < 1e-13);
}

#[test]
fn poly_conditions_give_the_3_4_5_and_the_4_5_6_7_polynomial() {
    let jerk = Conditions { j: Some(0.0), ..Conditions::REST };
    for (conditions, name) in [(Conditions::REST, "P345"), (jerk, "P4567")] {
        let poly = SegmentLaw::Poly { start: conditions, end: conditions };
        let m = Motion::from_segments(vec![
            Segment::rise(deg(150.0), 12.0, poly),
            Segment::fall(deg(210.0), 12.0, poly),
        ])
        .expect("a motion");
        let classic = Motion::from_segments(vec![
            Segment::rise(deg(150.0), 12.0, law(name)),
            Segment::fall(deg(210.0), 12.0, law(name)),
        ])
        .expect("a motion");
        for i in 0..360 {
            let (a, b) = (m.at(deg(f64::from(i))), classic.at(deg(f64::from(i))));
            assert!((a.s - b.s).abs() < 1e-11 && (a.v - b.v).abs() < 1e-10 && (a.a - b.a).abs() < 1e-9);
        }
    }
}

#[test]
fn a_constant_velocity_run_blends_through_polynomials() {
    let run = 10.0 / (60.0 * DEG);
    let moving = Conditions { v: Some(run), a: Some(0.0), j: None };
    let m = Motion::from_segments(vec![
        Segment::rise(deg(40.0), 4.0, SegmentLaw::Poly { start: Conditions::REST, end: moving }),
        Segment::rise(deg(60.0), 10.0, law("CV")),
        Segment::rise(deg(40.0), 4.0, SegmentLaw::Poly { start: moving, end: Conditions::REST }),
        Segment::fall(deg(220.0), 18.0, law("CYCLO")),
    ])
    .expect("smooth");
    assert!(m.issues().is_empty());
    assert!((m.at(deg(70.0)).v - run).abs() < 1e-12);
}

#[test]
fn conditions_that_determine_nothing_are_reported() {
    let only_jerk = Conditions { j: Some(1.0), ..Conditions::default() };
    let poly = SegmentLaw::Poly { start: only_jerk, end: Conditions::default() };
    let issues = Motion::from_segments(vec![
        Segment::rise(deg(180.0), 5.0, poly),
        Segment::fall(deg(180.0), 5.0, law("P345")),
    ])
    .expect_err("a parabola has no jerk");
    assert_eq!(issues, vec![MotionIssue::PolyUndetermined { segment: 0, conditions: 3 }]);
}

#[test]
fn a_periodic_table_approaches_the_function_with_the_fourth_power_of_its_step() {
    let lift = |t: f64| 5.0 - 4.0 * cos(t) + sin(2.0 * t);
    let error = |n: u32| {
        let rows: Vec<(Angle, f64)> =
            (0..n).map(|i| deg(360.0 * f64::from(i) / f64::from(n))).map(|a| (a, lift(a.rad()))).collect();
        let m = Motion::from_table(&rows, true).expect("a motion");
        (0..1000)
            .map(|i| f64::from(i) * 0.006)
            .map(|t| (m.at(Angle::radians(t)).s - lift(t)).abs())
            .fold(0.0, f64::max)
    };
    let (coarse, fine) = (error(24), error(48));
    assert!(coarse < 1e-3 && fine < coarse / 12.0, "{coarse} {fine}");
}

#[test]
fn a_table_may_start_anywhere_and_repeat_its_first_row() {
    let lift = |t: f64| 3.0 - 3.0 * cos(t - 1.0);
    let rows: Vec<(Angle, f64)> =
        (0..=36).map(|i| deg(5.0 + 10.0 * f64::from(i))).map(|a| (a, lift(a.rad()))).collect();
    for rows in [&rows[..36], &rows[..]] {
        let m = Motion::from_table(rows, true).expect("a motion");
        assert!(m.issues().is_empty(), "{:?}", m.issues());
        assert_eq!((m.breaks()[0], m.breaks()[m.breaks().len() - 1]), (0.0, TAU));
        assert!(m.breaks().windows(2).all(|w| w[0] < w[1]));
        for i in 0..360 {
            let t = f64::from(i) * DEG;
            assert!((m.at(Angle::radians(t)).s - lift(t)).abs() < 1e-4);
        }
    }
}

#[test]
fn a_clamped_table_stands_still_at_both_ends() {
    let rows = [(deg(0.0), 0.0), (deg(90.0), 4.0), (deg(200.0), 9.0), (deg(300.0), 2.0), (deg(360.0), 0.0)];
    let m = Motion::from_table(&rows, false);
    let issues = m.as_ref().map_or_else(Clone::clone, |m| m.issues().to_vec());
    assert!(issues.iter().all(|i| !i.is_error()), "{issues:?}");
    let m = m.expect("a motion");
    assert!(m.at(deg(0.0)).v.abs() < 1e-12 && m.at(Angle::radians(TAU - 1e-9)).v.abs() < 1e-6);
}

#[test]
fn faulty_tables_say_which_row() {
    let row = |a: f64, s: f64| (deg(a), s);
    let faulty = |rows: &[(Angle, f64)], periodic| Motion::from_table(rows, periodic).expect_err("faulty");
    assert_eq!(
        faulty(&[row(0.0, 0.0), row(10.0, 1.0)], true),
        vec![MotionIssue::TableTooShort { rows: 2, need: 3 }]
    );
    let unsorted = faulty(&[row(0.0, 0.0), row(90.0, 1.0), row(80.0, 2.0), row(200.0, 1.0)], true);
    assert_eq!(
        unsorted,
        vec![MotionIssue::TableNotAscending { row: 2, angle: deg(80.0), before: deg(90.0) }]
    );
    assert!(matches!(
        faulty(&[row(0.0, 0.0), row(90.0, f64::NAN), row(360.0, 0.0)], false)[0],
        MotionIssue::TableValue { row: 1 }
    ));
    assert!(matches!(
        faulty(&[row(0.0, 0.0), row(90.0, 1.0), row(350.0, 0.0)], false)[0],
        MotionIssue::TableSpan { .. }
    ));
    let ends = faulty(&[row(0.0, 0.0), row(90.0, 1.0), row(180.0, 3.0), row(360.0, 0.5)], true);
    assert_eq!(ends, vec![MotionIssue::TableEnds { first: 0.0, last: 0.5 }]);
}

#[test]
fn cam_angles_repeat_every_turn() {
    let m = dwell_rise_dwell_return("P4567");
    for turn in [-2.0, 1.0, 3.0] {
        let (a, b) = (m.at(deg(77.0)), m.at(deg(77.0 + 360.0 * turn)));
        assert!((a.s - b.s).abs() < 1e-12);
    }
}
