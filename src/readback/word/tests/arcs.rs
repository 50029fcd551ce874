//! Arcs outside the XY plane, and controls that go by the end's angle.

use super::*;
use crate::geom::{Point3, Vec3};
use crate::math::hypot;

fn tilted(m: &TraceMove) -> Tilted {
    match m.path {
        TracePath::Tilted(arc) => arc,
        ref other => panic!("not a tilted arc: {other:?}"),
    }
}

#[test]
fn arcs_in_the_other_planes_turn_about_their_axis() {
    // G18: Z is the first axis, X the second; clockwise as seen from +Y.
    let moves = clean("linuxcnc", &linuxcnc("G18 G3 X0 Z15 I-10 K0\nG2 X10 Z5 I0 K-10\nG17"));
    let arc = tilted(&moves[2]);
    assert_eq!((arc.from, arc.to), (Point3::new(10.0, 0.0, 5.0), Point3::new(0.0, 0.0, 15.0)));
    assert_eq!((arc.centre, arc.axis), (Point3::new(0.0, 0.0, 5.0), Vec3::y()));
    // From +X to +Z about Y is clockwise, so that G3 goes the long way round.
    assert!(close(arc.sweep, 1.5 * PI));
    assert!(close(tilted(&moves[3]).sweep, -1.5 * PI));
    let moves = clean("linuxcnc", &linuxcnc("G19 G2 Y10 Z5 R5\nG17"));
    let arc = tilted(&moves[2]);
    assert!((arc.centre - Point3::new(10.0, 5.0, 5.0)).norm() < 1e-9 && close(arc.sweep, -PI));
    assert!(close(arc.heights().1, 10.0) && close(arc.heights().0, 5.0));
}

#[test]
fn a_helix_about_x_rises_with_its_angle() {
    let moves = clean("linuxcnc", &linuxcnc("G19 G3 X16 Y0 Z5 J4 K0 P2\nG17"));
    let arc = tilted(&moves[2]);
    assert!(close(arc.sweep, 2.0 * TAU) && close(arc.rise(), 6.0));
    assert!((arc.at(0.25) - Point3::new(11.5, 8.0, 5.0)).norm() < 1e-9);
    assert!((arc.at(1.0) - arc.to).norm() < 1e-9);
    assert!(close(moves[2].length(), hypot(4.0 * 2.0 * TAU, 6.0)));
    assert_eq!(moves[2].heights(), (1.0, 9.0));
}

#[test]
fn extents_of_arcs_hold_their_points() {
    for (body, seed) in
        [("G18 G2 X7 Z9 R8", 1), ("G18 G3 X7 Z9 R8", 2), ("G19 G2 Y7 Z1 R-6", 3), ("G19 G3 Y7 Z1 X12 R9", 4)]
    {
        let moves = clean("linuxcnc", &linuxcnc(&format!("{body}\nG17")));
        let arc = tilted(&moves[2]);
        for axis in 0..3 {
            let (low, high) = arc.extent(axis);
            for i in 0..=100 {
                let p = arc.at(f64::from(i) / 100.0);
                assert!(p[axis] >= low - 1e-9 && p[axis] <= high + 1e-9, "{seed} {axis} {p:?} {low} {high}");
            }
        }
    }
}

#[test]
fn marlin_ends_an_arc_at_the_angle_of_its_end() {
    let text = "G21\nG90\nG17\nM3 S1000\nG0 X10 Y0 Z5\nG1 Z-1 F100\nG3 X0.01 Y10.02 I-10 J0 F200\nM5\n";
    let moves = clean("marlin", text);
    let TracePath::Arc { to, centre, .. } = moves[2].path else { panic!("{:?}", moves[2]) };
    assert!(centre.coords.norm() < 1e-12 && close(to.coords.norm(), 10.0));
    let (from, end) = line(&moves[3]);
    assert_eq!((from, end), (to, Point2::new(0.01, 10.02)));
}
