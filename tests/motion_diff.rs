//! NC programs compared as motion.

use proptest::prelude::*;

use partwright::math::sin_cos;
use partwright::motion_diff::{Comparison, Property, Tolerance, compare, print};
use partwright::readback::MachineSetup;

const HEAD: &str = "G17 G21 G40 G49 G80 G90 G94 G91.1 G54 G61\nT1 M6\nG43 H1\nS1000 M3\nG0 Z5\nG0 X0 Y0\n";

fn program(body: &str) -> String {
    format!("{HEAD}{body}\nM30\n")
}

fn within(a: &str, b: &str, distance: f64) -> Comparison {
    let (a, b) = (program(a), program(b));
    let tolerance = Tolerance { distance, ..Tolerance::default() };
    let found =
        compare([a.as_bytes(), b.as_bytes()], "linuxcnc", &MachineSetup::default(), tolerance).unwrap();
    assert!(found.is_executable(), "{:?}\n{a}\n{b}", found.faults);
    found
}

fn same(a: &str, b: &str, distance: f64) {
    for (a, b) in [(a, b), (b, a)] {
        let found = within(a, b, distance);
        assert!(found.is_same(), "{a}\n--\n{b}\n--\n{}", text(&found));
    }
}

fn text(comparison: &Comparison) -> String {
    print::text(comparison, print::Names { a: "A", b: "B" })
}

#[test]
fn the_same_path_may_be_cut_into_other_blocks() {
    same("G1 X10 F300\nX20\nY5", "G1 X20 F300\nY2\nY5", 0.001);
    same("G1 Z-1 F300\nZ-2\nZ5\nX10\nX0\nX10", "G1 Z-2 F300\nZ5\nX10\nX4\nX0\nX10", 0.001);
    same("G3 X0 Y20 I0 J10 F300", "G3 X10 Y10 I0 J10 F300\nG3 X0 Y20 I-10 J0", 0.001);
    same("G2 I5 J0 F300", "G2 X10 Y0 I5 J0 F300\nX0 I-5", 0.001);
}

#[test]
fn chords_are_the_same_as_an_arc_only_within_their_sagitta() {
    let arc = "G3 X10 Y10 I0 J10 F300";
    let chords: String = (1..=18)
        .map(|i| {
            let angle = f64::from(i) * core::f64::consts::FRAC_PI_2 / 18.0;
            let (sin, cos) = sin_cos(angle);
            format!("G1 X{:.6} Y{:.6} F300\n", 10.0 * sin, 10.0 - 10.0 * cos)
        })
        .collect();
    let sagitta = 10.0 * (1.0 - sin_cos(core::f64::consts::FRAC_PI_2 / 36.0).1);
    same(arc, &chords, sagitta * 1.05);
    let found = within(arc, &chords, sagitta * 0.9).path.expect("a difference");
    assert!((found.largest - sagitta).abs() < 0.02 * sagitta, "{found:?}, sagitta {sagitta}");
}

#[test]
fn the_first_move_that_differs_is_shown_with_its_distance() {
    let found = within("G1 X10 F300\nY10\nX0", "G1 X10 F300\nY10.5\nX0", 0.001);
    let path = found.path.as_ref().expect("a difference");
    assert_eq!(path.points, [[10.0, 10.0, 5.0], [10.0, 10.5, 5.0]]);
    assert_eq!((path.distance, path.largest, path.moves), (0.5, 0.5, [1, 2]));
    insta::assert_snapshot!(text(&found));
}

#[test]
fn a_detour_of_either_program_is_found() {
    for (a, b) in [("G1 X10 F300", "G1 X5 F300\nY3\nY0\nX10"), ("G1 X5 F300\nY3\nY0\nX10", "G1 X10 F300")] {
        let path = within(a, b, 0.001).path.expect("a difference");
        assert!((path.largest - 3.0).abs() < 1e-9, "{path:?}");
    }
    let longer = within("G1 X10 F300", "G1 X10 F300\nX0\nX10", 0.001).path.expect("a difference");
    assert!((longer.largest - 10.0).abs() < 1e-9, "{longer:?}");
    assert!(within("G1 X10 F300", "G4 P1", 0.001).path.is_some());
}

#[test]
fn feeds_and_speeds_are_compared_where_they_hold() {
    let found = within("G1 X10 F300\nX20", "G1 X5 F300\nX7 F100\nX20 F300", 0.001);
    assert!(found.path.is_none());
    let [only] = found.states.as_slice() else { panic!("{:#?}", found.states) };
    assert_eq!((only.property, only.lines), (Property::Feed, [7, 8]));
    assert_eq!((only.values.clone(), only.point), (["300".to_owned(), "100".to_owned()], [5.0, 0.0, 5.0]));
    assert!((only.length - 2.0).abs() < 1e-9);
    let found = within("S900 M3\nG1 X10 F300", "G0 X10", 0.001);
    let properties: Vec<Property> = found.states.iter().map(|s| s.property).collect();
    assert_eq!(properties, [Property::Rapid, Property::Spindle]);
    insta::assert_snapshot!(text(&found));
}

#[test]
fn stops_and_dwells_are_compared_in_their_order() {
    let found = within("G1 X10 F300\nG4 P0.5\nX20\nM0\nX30", "G1 X10 F300\nX20\nX25\nM0\nX30", 0.001);
    assert!(found.path.is_none() && found.states.is_empty());
    insta::assert_snapshot!(text(&found));
}

#[test]
fn complaints_of_the_control_are_handed_on() {
    let texts = [program("G1 X10"), program("G1 X10 F300")];
    let found = compare(
        [texts[0].as_bytes(), texts[1].as_bytes()],
        "linuxcnc",
        &MachineSetup::default(),
        Tolerance::default(),
    )
    .unwrap();
    assert!(!found.is_executable() && found.faults[1].is_empty());
    assert!(compare([b"", b""], "none", &MachineSetup::default(), Tolerance::default()).is_err());
}

/// Straight moves between points of a coarse lattice, so that paths cross and run back on themselves.
fn corners() -> impl Strategy<Value = Vec<(i32, i32, i32)>> {
    proptest::collection::vec((-3..4i32, -3..4i32, -1..2i32), 1..12)
}

fn lines(points: &[(f64, f64, f64)]) -> String {
    points.iter().map(|(x, y, z)| format!("G1 X{x:.4} Y{y:.4} Z{z:.4} F300\n")).collect()
}

proptest! {
    #[test]
    fn cutting_moves_anywhere_changes_nothing(points in corners(), cuts in proptest::collection::vec(0.05..0.95f64, 12)) {
        let points: Vec<(f64, f64, f64)> =
            points.iter().map(|&(x, y, z)| (f64::from(x) * 5.0, f64::from(y) * 5.0, f64::from(z) * 5.0)).collect();
        let mut cut = Vec::new();
        let mut from = (0.0, 0.0, 5.0);
        for (&to, &x) in points.iter().zip(&cuts) {
            cut.push((from.0 + (to.0 - from.0) * x, from.1 + (to.1 - from.1) * x, from.2 + (to.2 - from.2) * x));
            cut.push(to);
            from = to;
        }
        same(&lines(&points), &lines(&cut), 0.001);
    }

    #[test]
    fn a_moved_corner_is_found(points in corners(), which in 0..12usize, by in 0.1..0.4f64) {
        let points: Vec<(f64, f64, f64)> =
            points.iter().map(|&(x, y, z)| (f64::from(x) * 5.0, f64::from(y) * 5.0, f64::from(z) * 5.0)).collect();
        let mut moved = points.clone();
        let index = which % moved.len();
        moved[index].2 += by;
        let before = if index == 0 { (0.0, 0.0, 5.0) } else { points[index - 1] };
        // A corner that is no corner can hide on a line that is there anyway.
        prop_assume!(points[index] != before);
        let found = within(&lines(&points), &lines(&moved), 0.001).path;
        let found = found.ok_or_else(|| TestCaseError::fail("no difference"))?;
        prop_assert!(found.largest > 0.001 && found.largest <= by + 1e-4, "{found:?}");
    }
}
