use super::*;
use crate::geom::motion::{Law, Segment, SegmentLaw};

pub(super) fn deg(v: f64) -> Angle {
    Angle::degrees(v)
}

/// Dwell to 30, rise to 150, dwell to 210, return to 330, dwell.
pub(super) fn example_motion(lift: f64, law: &str) -> Motion {
    let law = SegmentLaw::Law(Law::by_name(law).expect("in the table"));
    Motion::from_segments(vec![
        Segment::dwell(deg(30.0)),
        Segment::rise(deg(120.0), lift, law),
        Segment::dwell(deg(60.0)),
        Segment::fall(deg(120.0), lift, law),
        Segment::dwell(deg(30.0)),
    ])
    .expect("a motion")
}

/// The cam of Kim & Yang's example.
pub(super) fn paper() -> Cam {
    let roller = Follower::TranslatingRoller { radius: 8.0, offset: 0.0 };
    Cam::new(CamDefinition::new(20.0, roller, example_motion(20.0, "MODSIN"))).expect("a cam")
}

#[test]
fn the_papers_cam_has_its_figures() {
    let cam = paper();
    let f = cam.figures();
    assert!((f.inner.length - 195.222_941_379).abs() < 1e-9);
    assert!((f.inner.area - 2_992.968_087).abs() < 1e-6);
    assert!((f.pressure_angle.value / crate::math::DEG - 24.577_835).abs() < 1e-6);
    assert!((f.pressure_angle.at.deg() - 81.428_58).abs() < 1e-4);
    assert!((f.inner.nearest.value - 20.0).abs() < 1e-13 && (f.inner.farthest.value - 40.0).abs() < 1e-13);
    assert_eq!(f.inner.concave, None);
    assert!(cam.issues().is_empty());
}
