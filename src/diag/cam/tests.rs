use super::*;
use crate::geom::cam::{Cam, CamDefinition};
use crate::geom::follower::{ArmSide, Follower};
use crate::geom::motion::{Conditions, Law, Motion, Segment, SegmentLaw};
use crate::source::FileId;

fn nowhere() -> Span {
    Span { file: FileId(0), start: 0, end: 0 }
}

fn deg(v: f64) -> Angle {
    Angle::degrees(v)
}

fn law(name: &str) -> SegmentLaw {
    SegmentLaw::Law(Law::by_name(name).expect("in the table"))
}

fn motion_messages(segments: Vec<Segment>) -> Vec<Diagnostic> {
    let issues = Motion::from_segments(segments).map_or_else(|i| i, |m| m.issues().to_vec());
    let unit = LiftUnit::Length(LengthUnit::Millimetre);
    issues.iter().map(|i| motion(i, nowhere(), |_| None, unit)).collect()
}

fn rise_and_return(lift: f64, rise: f64, law_name: &str) -> Vec<Segment> {
    vec![
        Segment::rise(deg(rise), lift, law(law_name)),
        Segment::fall(deg(180.0), lift, law(law_name)),
        Segment::dwell(deg(180.0 - rise)),
    ]
}

fn cam_messages(base: f64, follower: Follower, segments: Vec<Segment>, unit: LengthUnit) -> Vec<Diagnostic> {
    let m = Motion::from_segments(segments).expect("a motion");
    let issues = Cam::new(CamDefinition::new(base, follower, m)).map_or_else(|i| i, |c| c.issues().to_vec());
    issues.iter().map(|i| cam(i, nowhere(), unit)).collect()
}

const ROLLER: Follower = Follower::TranslatingRoller { radius: 8.0, offset: 0.0 };

#[test]
fn missing_angle_is_named_and_offered_as_a_dwell() {
    let messages = motion_messages(vec![
        Segment::rise(deg(120.0), 5.0, law("MODSIN")),
        Segment::fall(deg(120.0), 5.0, law("MODSIN")),
    ]);
    assert_eq!(messages.len(), 1);
    assert_eq!(messages[0].code.id, "E0401");
    assert_eq!(messages[0].message, "the motion's angles add up to 240 deg, not 360 deg: 120 deg missing");
    assert_eq!(messages[0].help, ["add `DWELL, 120` or widen a segment"]);
}

#[test]
fn lifts_that_do_not_close_name_both_sums() {
    let messages = motion_messages(vec![
        Segment::rise(deg(180.0), 5.0, law("P345")),
        Segment::fall(deg(180.0), 4.5, law("P345")),
    ]);
    assert_eq!(messages[0].code.id, "E0402");
    assert!(messages[0].message.contains("rises by 5 mm and returns by 4.5 mm, 0.5 mm apart"));
}

#[test]
fn velocity_jumps_are_errors_and_acceleration_jumps_warnings() {
    let messages = motion_messages(rise_and_return(10.0, 90.0, "CV"));
    assert_eq!(messages[0].code.id, "E0403");
    assert!(
        messages[0].message.contains("the velocity jumps at cam angle 0 deg from 0 mm/deg to 0.1111 mm/deg"),
        "{}",
        messages[0].message
    );
    let messages = motion_messages(rise_and_return(10.0, 90.0, "SHM"));
    assert!(messages.iter().all(|m| m.code.id == "W0402"));
}

#[test]
fn polynomials_without_a_solution_are_reported() {
    let start = Conditions { j: Some(1.0), ..Conditions::default() };
    let poly = SegmentLaw::Poly { start, end: Conditions::default() };
    let messages = motion_messages(vec![
        Segment::rise(deg(180.0), 5.0, poly),
        Segment::fall(deg(180.0), 5.0, law("P345")),
    ]);
    assert_eq!(messages[0].code.id, "E0404");
}

#[test]
fn table_rows_are_named() {
    let rows = [(deg(0.0), 0.0), (deg(90.0), 5.0), (deg(80.0), 2.0), (deg(200.0), 1.0)];
    let issues = Motion::from_table(&rows, true).expect_err("not ascending");
    let message = motion(&issues[0], nowhere(), |_| None, LiftUnit::Angle);
    assert_eq!(message.code.id, "E0405");
    assert_eq!(message.message, "row 3 of the table has angle 80 deg after 90 deg");
}

#[test]
fn undercut_names_place_radii_and_the_base_that_works() {
    const LARGE: Follower = Follower::TranslatingRoller { radius: 20.0, offset: 0.0 };
    let messages = cam_messages(10.0, LARGE, rise_and_return(20.0, 60.0, "MODSIN"), LengthUnit::Millimetre);
    assert_eq!(messages[0].code.id, "E0408");
    assert!(messages[0].message.contains("the roller's radius 20 mm"), "{}", messages[0].message);
    let help = &messages[0].help[0];
    let base: f64 = help.split(['`', ' ']).find_map(|w| w.parse().ok()).expect("a number");
    let enlarged = cam_messages(base, LARGE, rise_and_return(20.0, 60.0, "MODSIN"), LengthUnit::Millimetre);
    assert!(enlarged.iter().all(|m| m.code.id != "E0408"), "{help}");
    let reduced =
        cam_messages(base - 0.002, LARGE, rise_and_return(20.0, 60.0, "MODSIN"), LengthUnit::Millimetre);
    assert!(reduced.iter().any(|m| m.code.id == "E0408"), "{help}");
}

#[test]
fn the_pressure_angle_warning_offers_the_smallest_base() {
    let messages = cam_messages(10.0, ROLLER, rise_and_return(10.0, 60.0, "MODSIN"), LengthUnit::Inch);
    assert_eq!(messages[0].code.id, "W0401");
    let help = &messages[0].help[0];
    let base: f64 = help.split(['`', ' ']).find_map(|w| w.parse().ok()).expect("a number");
    assert!(
        cam_messages(base * 25.4, ROLLER, rise_and_return(10.0, 60.0, "MODSIN"), LengthUnit::Inch).is_empty()
    );
    assert!(
        !cam_messages((base - 0.002) * 25.4, ROLLER, rise_and_return(10.0, 60.0, "MODSIN"), LengthUnit::Inch)
            .is_empty()
    );
}

#[test]
fn followers_that_do_not_reach_are_told_the_range() {
    let offset = Follower::TranslatingRoller { radius: 8.0, offset: 40.0 };
    let messages = cam_messages(20.0, offset, rise_and_return(5.0, 90.0, "MODSIN"), LengthUnit::Millimetre);
    assert_eq!(messages[0].code.id, "E0407");
    assert!(messages[0].message.contains("must be under 28 mm"));
    let arm = Follower::OscillatingRoller { radius: 8.0, arm: 20.0, pivot: 80.0, side: ArmSide::Right };
    let messages = cam_messages(20.0, arm, rise_and_return(0.1, 90.0, "MODSIN"), LengthUnit::Millimetre);
    assert!(messages[0].help[0].contains("over 52 mm and under 92 mm"), "{}", messages[0].help[0]);
    let face = Follower::OscillatingFlat { pivot: 60.0, offset: 0.0, side: ArmSide::Left };
    let messages = cam_messages(50.0, face, rise_and_return(0.8, 90.0, "MODSIN"), LengthUnit::Millimetre);
    assert_eq!(messages[0].code.id, "E0407", "{messages:?}");
    assert!(messages[0].message.contains("swings"));
}

#[test]
fn flat_faces_have_no_groove() {
    let m = Motion::from_segments(rise_and_return(5.0, 90.0, "P345")).expect("a motion");
    let mut definition = CamDefinition::new(30.0, Follower::TranslatingFlat { offset: 0.0 }, m);
    definition.groove = true;
    let issues = Cam::new(definition).expect_err("no groove");
    assert_eq!(cam(&issues[0], nowhere(), LengthUnit::Millimetre).code.id, "E0410");
}

#[test]
fn a_cutter_too_large_for_a_concave_flank_is_told_the_largest() {
    let m = Motion::from_segments(rise_and_return(20.0, 60.0, "MODSIN")).expect("a motion");
    let built = Cam::new(CamDefinition::new(25.0, ROLLER, m)).expect("a cam");
    let limit = built.max_cutter(Flank::Inner);
    assert!(limit.radius.is_finite());
    assert_eq!(built.cutter_issue(Flank::Inner, limit.radius * 0.99), None);
    let issue = built.cutter_issue(Flank::Inner, limit.radius * 1.01).expect("too large");
    let message = cam(&issue, nowhere(), LengthUnit::Millimetre);
    assert_eq!(message.code.id, "E0411");
    assert!(message.help[0].starts_with("use a cutter of diameter"));
}

#[test]
fn values_must_be_positive() {
    let messages = cam_messages(-1.0, ROLLER, rise_and_return(5.0, 90.0, "P345"), LengthUnit::Millimetre);
    assert_eq!(
        (messages[0].code.id, messages[0].message.as_str()),
        ("E0406", "the base radius must be over 0 and at most 1e9, it is -1")
    );
}

#[test]
fn numbers_are_short_and_without_a_negative_zero() {
    assert_eq!(number(12.5), "12.5");
    assert_eq!(number(-0.000_000_001), "0");
    assert_eq!(number(0.000_123), "0.000123");
    assert_eq!(number(1e6), "1000000");
}
