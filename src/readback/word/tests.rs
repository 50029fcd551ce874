//! Programs written by hand for each control: what they do, and what the controls say to bad ones.

use crate::geom::Point2;
use crate::math::{PI, TAU};
use crate::readback::*;

fn setup() -> MachineSetup {
    MachineSetup { rotary: Some(Rotary { letter: 'C', reversed: false }), ..MachineSetup::default() }
}

fn trace(control: &str, text: &str) -> Trace {
    run(text.as_bytes(), control, &setup()).expect("a known control")
}

/// A trace that must have no complaint.
fn clean(control: &str, text: &str) -> Vec<TraceMove> {
    let trace = trace(control, text);
    assert_eq!(trace.faults, [], "{text}");
    moves(trace)
}

fn moves(trace: Trace) -> Vec<TraceMove> {
    let only_moves = |e: TraceEvent| if let EventKind::Move(m) = e.kind { Some(m) } else { None };
    trace.events.into_iter().filter_map(only_moves).collect()
}

/// Asserts that the program's faults are exactly on these lines with these words in them.
fn faults(control: &str, text: &str, wanted: &[(u32, &str)]) {
    let got = trace(control, text).faults;
    let fits = got.len() == wanted.len()
        && got.iter().zip(wanted).all(|(f, (line, words))| f.line == *line && f.message.contains(words));
    assert!(fits, "{control}: {text}\nwanted {wanted:?}\ngot {got:#?}");
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}

fn line(m: &TraceMove) -> (Point2, Point2) {
    match m.path {
        TracePath::Line { from, to } => (from, to),
        ref other => panic!("not a line: {other:?}"),
    }
}

fn arc(m: &TraceMove) -> (Point2, f64) {
    match m.path {
        TracePath::Arc { centre, sweep, .. } => (centre, sweep),
        ref other => panic!("not an arc: {other:?}"),
    }
}

const LINUXCNC_START: &str = "G21 G90 G17 G94 G61 G54\nT1 M6\nG43 H1\nG0 X10 Y0\nZ5\nS1000 M3\nF100\n";

fn linuxcnc(body: &str) -> String {
    format!("{LINUXCNC_START}{body}\nM30\n")
}

#[test]
fn lines_carry_modal_state() {
    let moves = clean("linuxcnc", &linuxcnc("G1 Z-1\nX12.5 Y-3\nG0 Z5"));
    assert_eq!(moves.len(), 5);
    let cut = &moves[3];
    assert_eq!(line(cut), (Point2::new(10.0, 0.0), Point2::new(12.5, -3.0)));
    assert_eq!((cut.z, cut.rapid, cut.feed, cut.tool), ((-1.0, -1.0), false, Some(100.0), 1));
    assert!(close(cut.spindle, 1000.0) && cut.length_offset && cut.known == [true; 3]);
    assert_eq!(moves[0].known, [false, false, false]);
    assert!(moves[4].rapid && moves[4].z == (-1.0, 5.0));
}

#[test]
fn inches_and_increments_become_millimetres() {
    let moves =
        clean("linuxcnc", "G20 G90 G17 G94 G61\nG0 X1 Y0 Z0.1\nM3 S500\nG1 G91 X0.5 F10\nG90 X2\nM2\n");
    assert!(close(line(&moves[1]).1.x, 1.5 * 25.4) && close(line(&moves[2]).1.x, 50.8));
    assert!(close(moves[1].feed.unwrap(), 254.0));
}

#[test]
fn arcs_by_centre_and_by_radius_agree() {
    let body = "G1 Z-1\nG3 X0 Y10 I-10 J0\nG3 X-10 Y0 R10\nG2 X0 Y10 R10\nG2 X-10 Y0 R-10";
    let moves = clean("linuxcnc", &linuxcnc(body));
    let (centre, sweep) = arc(&moves[3]);
    assert!(centre.coords.norm() < 1e-12 && close(sweep, PI / 2.0));
    let (centre, sweep) = arc(&moves[4]);
    assert!(centre.coords.norm() < 1e-9 && close(sweep, PI / 2.0));
    let (centre, sweep) = arc(&moves[5]);
    assert!(centre.coords.norm() < 1e-9 && close(sweep, -PI / 2.0));
    let (centre, sweep) = arc(&moves[6]);
    assert!(centre.coords.norm() < 1e-9 && close(sweep, -1.5 * PI));
}

#[test]
fn full_circles_helices_and_turns() {
    let moves = clean("linuxcnc", &linuxcnc("G1 Z-1\nG2 I-10\nG3 I-10 Z-2 P3\nG90.1 G3 X10 Y0 I0 J0\nG91.1"));
    assert!(close(arc(&moves[3]).1, -TAU));
    assert!(close(arc(&moves[4]).1, 3.0 * TAU) && moves[4].z == (-1.0, -2.0));
    assert!(close(arc(&moves[5]).1, TAU) && arc(&moves[5]).0.coords.norm() < 1e-12);
}

#[test]
fn a_machine_may_call_codes_otherwise() {
    let text = linuxcnc("G1 X1 M21").replace("G21", "G71");
    assert_eq!(
        clean("linuxcnc G70=G20 G71=G21 M21=M8", &text).len(),
        clean("linuxcnc", &linuxcnc("G1 X1 M8")).len()
    );
    let other = trace("linuxcnc G71=G21", &linuxcnc("G1 X1")).faults;
    assert!(other.iter().any(|f| f.message == "unknown code G21: this machine calls it G71"), "{other:?}");
    for bad in [
        "linuxcnc G71",
        "linuxcnc G71=M21",
        "linuxcnc X1=X2",
        "linuxcnc G71=G71",
        "G71=G21",
        "fanuk G71=G21",
        "",
    ] {
        assert!(run(b"M2", bad, &setup()).is_err(), "{bad}");
    }
}

#[test]
fn linuxcnc_refuses_what_it_refuses() {
    for (body, line, words) in [
        ("G1 G0 X1", 8, "two codes of one modal group"),
        ("X1 X2", 8, "multiple X words"),
        ("G1 X1 Q3", 8, "Q3: no code in the block uses it"),
        ("G12 X1", 8, "unknown code G12"),
        ("G1 X1 A5", 8, "no axis A"),
        ("G1 Y1 X", 8, "X in column 7 is not followed by a number"),
        ("G1 X1.2.3", 8, "two decimal points"),
        ("G1 X#5", 8, "expression"),
        ("G1 X1 (open", 8, "not closed"),
        ("G1 X1 (a (b) c)", 8, "a comment in a comment"),
        ("(DEBUG,#100)", 8, "obeys as a command"),
        ("G2 X10 Y0", 8, "an arc without R, I and J"),
        ("G2 X0 Y0 R2", 8, "too small to reach the end point"),
        ("G2 R5", 8, "ends where it starts"),
        ("G2 X10 Y0 I-5 R5", 8, "R and I J in one arc"),
        ("G2 X0 Y0 I-5.1 J0", 8, "Radius to end of arc differs"),
        ("G2 X10 Y0 I0 J0", 8, "zero radius"),
        ("G90.1 G2 X0 Y10 I0", 8, "I and J must both stand"),
        ("G18 G2 X0 Z1 I-5 K0", 8, "Radius to end of arc differs"),
        ("G18 G2 X0", 8, "an arc without R and offsets in its plane"),
        ("G93 G1 X1", 8, "F word missing with inverse time"),
        ("G94 G1 X1", 8, "with zero feed rate"),
        ("G1 X1 F0", 8, "with zero feed rate"),
        ("M5\nG95 G1 X1 F0.1", 9, "spindle standing"),
        ("G4", 8, "G4 without"),
        ("G4 P-1", 8, "negative time"),
        ("G53 G2 X0", 8, "G53 without G0 or G1"),
        ("G80\nX1", 9, "without a motion code"),
        ("G87 X1 Z-1 R1", 8, "G87 is not followed"),
        ("M3 M4", 8, "two M codes of one modal group"),
        ("M345.5", 8, "unknown code M345.5"),
        ("T-1", 8, "T-1 is not in"),
        ("N100000000 G1 X1", 8, "N100000000 is not in 0 to 99999999"),
        ("G1 X1 $", 8, "bad character '$'"),
        ("G5.3", 8, "G5.3 without G5.2"),
        ("G5.2 P1 L3\nX0 Y1 P1\nG5.3", 10, "2 control points, the order L 3 needs 3"),
        ("G5.2 P1 L3\nX0 Y1\nX2 Y2 P1\nG5.3", 9, "positive weight"),
        ("G5.2 P1 L3\nX0 Y1 P1\nG0 X1", 10, "not closed by G5.3"),
    ] {
        faults("linuxcnc", &linuxcnc(body), &[(line, words)]);
    }
    let long = format!("G1 X1 ({})", "x".repeat(250));
    faults("linuxcnc", &linuxcnc(&long), &[(8, "the line has 258 characters, the control takes 255")]);
}

#[test]
fn the_frame_of_a_linuxcnc_file() {
    faults("linuxcnc", "G21 G90\nG0 X1\n", &[(2, "no M2 or M30")]);
    faults("linuxcnc", "%\nG21 G90\nG0 X1\n%\n", &[]);
    faults("linuxcnc", "%\nG21 G90\nG0 X1\nM2\n", &[(4, "does not end with one")]);
    faults("linuxcnc", "G21 G90\nM2\nG0 X1\n", &[(3, "after the end of the program")]);
    faults("linuxcnc", "%\nM2\n%\nG0 X1\n", &[(4, "after the closing '%'"), (4, "after the end")]);
    faults("linuxcnc", "", &[(0, "no M2 or M30")]);
}

#[test]
fn what_is_left_to_settings_is_said_once() {
    let said = |text: &str| trace("linuxcnc", text).assumed.iter().map(|a| a.line).collect::<Vec<_>>();
    assert!(said(&linuxcnc("G1 X1\nX2\nG2 X4 I1")).is_empty());
    let text = "G0 X1\nF100 S100 M3 G1 X2\nX3\nG2 X5 I1\nM2\n";
    assert_eq!(said(text), [1, 1, 2, 2, 2, 4]);
}

#[test]
fn path_tolerance_is_what_blending_and_the_naive_cam_may_add() {
    let of = |code: &str| clean("linuxcnc", &linuxcnc(&format!("{code}\nG1 X1")))[3 - 1].path_tolerance;
    assert_eq!(of("G61"), 0.0);
    assert_eq!(of("G64"), f64::INFINITY);
    assert!(close(of("G64 P0.002"), 0.004) && close(of("G64 P0.002 Q0.001"), 0.003));
    assert!(close(of("G20 G64 P0.001 Q0\nF5"), 0.0254));
}

#[test]
fn a_turning_table_makes_spirals() {
    let moves = clean("linuxcnc", &linuxcnc("G0 Y0 C0\nG93 G1 X12 C90 F2\nX12 C180 F1\nG94 G1 X14 F50"));
    let TracePath::Spiral { radius, angle } = moves[3].path else { panic!("{:?}", moves[3]) };
    assert_eq!(radius, (10.0, 12.0));
    assert!(angle.0 == 0.0 && close(angle.1, PI / 2.0));
    // Half a minute for a quarter turn at 10 to 12 mm.
    let length = moves[3].length();
    assert!(
        (length - crate::math::hypot(11.0 * PI / 2.0, 2.0)).abs() < 0.01
            && close(moves[3].feed.unwrap(), 2.0 * length)
    );
    // With the table turned by 180 deg, machine +X is the part's -X.
    let (from, to) = line(&moves[5]);
    assert!((from - Point2::new(-12.0, 0.0)).norm() < 1e-12 && (to - Point2::new(-14.0, 0.0)).norm() < 1e-12);
    faults(
        "linuxcnc",
        &linuxcnc("G0 C0\nG1 Y1\nG1 X1 C5"),
        &[(10, "the tool must be on the table's X axis")],
    );
    let reversed =
        MachineSetup { rotary: Some(Rotary { letter: 'A', reversed: true }), ..MachineSetup::default() };
    let text = linuxcnc("G0 A0\nG1 A10");
    let moves = moves_of(run(text.as_bytes(), "linuxcnc", &reversed).expect("known"));
    let TracePath::Spiral { angle, .. } = moves[3].path else { panic!() };
    assert!(close(angle.1, -10.0 * crate::math::DEG));
}

fn moves_of(trace: Trace) -> Vec<TraceMove> {
    assert_eq!(trace.faults, []);
    moves(trace)
}

#[test]
fn feeds_with_a_table_follow_each_control() {
    // X and C together: LinuxCNC's F is the speed of X alone; Fanuc takes 1 deg for 1 mm.
    let feed = |control: &str, text: &str| {
        let m = moves_of(run(text.as_bytes(), control, &setup()).expect("known")).pop().expect("a move");
        (m.feed.expect("a feed"), m.length())
    };
    let (f, length) = feed("linuxcnc", &linuxcnc("G0 C0\nG1 X13 C4 F100"));
    assert!(close(f, 100.0 * length / 3.0));
    let (f, length) = feed("fanuc", &fanuc("G0 C0.\nG1 X13. C4. F100."));
    assert!(close(f, 100.0 * length / 5.0));
    let (f, length) = feed("linuxcnc", &linuxcnc("G0 C0\nG1 C4 F100"));
    assert!(close(f, 100.0 * length / 4.0));
}

#[test]
fn a_nurbs_of_linuxcnc_has_uniform_clamped_knots() {
    let moves =
        clean("linuxcnc", &linuxcnc("G1 X0 Y0\nG5.2 P1 L3\nX0 Y1 P1\nX2 Y2 P1\nX2 Y0 P2\nX0 Y0 P1\nG5.3"));
    let TracePath::Nurbs { order, points, weights, knots } = &moves[3].path else { panic!("{:?}", moves[3]) };
    assert_eq!((*order, points.len()), (3, 5));
    assert_eq!(weights, &[1.0, 1.0, 1.0, 2.0, 1.0]);
    assert_eq!(knots, &[0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 3.0]);
    assert_eq!(moves[3].feed, Some(100.0));
}

#[test]
fn pieces_of_g5_go_by_the_ways_to_their_inner_points() {
    let body = "G1 X0 Y0\nG5 X10 Y10 I0 J5 P-5 Q0\nX20 Y0 P0 Q5\nG91 G5 X1 Y2 I1 J0 P0 Q-1\nG90 G1 X3";
    let moves = clean("linuxcnc", &linuxcnc(body));
    let points = |m: &TraceMove| match &m.path {
        TracePath::Nurbs { points, .. } => points.iter().map(|p| (p.x, p.y)).collect::<Vec<_>>(),
        other => panic!("{other:?}"),
    };
    let [a, b, c] = [&moves[3], &moves[4], &moves[5]].map(points);
    assert_eq!(a, [(0.0, 0.0), (0.0, 5.0), (5.0, 10.0), (10.0, 10.0)]);
    // Without I and J it goes on as the one before arrived.
    assert_eq!(b, [(10.0, 10.0), (15.0, 10.0), (20.0, 5.0), (20.0, 0.0)]);
    assert_eq!(c, [(20.0, 0.0), (21.0, 0.0), (21.0, 1.0), (21.0, 2.0)]);
    let last = (moves[6].start().xy(), moves[3].feed);
    assert_eq!(last, (Point2::new(21.0, 2.0), Some(100.0)));
    // Firmware cuts chords of the same piece; the stock one has none.
    let start = "G17 G21 G90\nG1 X0 Y0 Z0 F100\n";
    let piece = format!("{start}G5 X3 Y0 I1 J0.5 P-1 Q0.5\n");
    let made = |control: &str| run(piece.as_bytes(), control, &setup()).expect("known");
    let ends: Vec<f64> = moves_of(made("marlin splines=chords")).iter().skip(1).map(|m| m.end().x).collect();
    assert!(ends.len() == 5 && close(ends[0], 0.6) && close(ends[4], 3.0), "{ends:?}");
    assert!(made("marlin").faults.iter().any(|f| f.message.contains("G5 is not followed")));
    assert!(made("grbl").faults.iter().any(|f| f.message.contains("G5")));
    for (body, words) in [
        ("G5 X1 Y1 P1 Q1", "needs I and J"),
        ("G5 X1 Y1 I1 J1 P1 Q1\nG1 X2\nG5 X3 P1 Q1", "needs I and J"),
        ("G5 X1 Y1 I1 P1 Q1", "needs I and J"),
        ("G5 X1 Y1 I1 J1 Q1", "needs P and Q"),
        ("G5 X1 Y1 Z1 I1 J1 P1 Q1", "an axis other than X and Y"),
        ("G18 G5 X1 Y1 I1 J1 P1 Q1", "outside the XY plane"),
        ("G5 I1 J1 P1 Q1", "no code in the block uses it"),
    ] {
        let got = trace("linuxcnc", &linuxcnc(body)).faults;
        assert!(got.iter().any(|f| f.message.contains(words)), "{body}: {got:#?}");
    }
}

fn fanuc(body: &str) -> String {
    format!(
        "%\nO0001\nG17 G21 G40 G49 G80 G90 G94 G54\nT1 M6\nG43 H1\nG0 X10. Y0. Z5.\nS1000 M3\nF100.\n{body}\nM30\n%\n"
    )
}

#[test]
fn fanuc_counts_least_increments_without_a_point() {
    let moves = clean("fanuc", &fanuc("G1 X12500 Y-3 Z-1. F200\nG4 P1500\nG4 X2.5"));
    assert_eq!((line(&moves[1]).1, moves[1].z.1), (Point2::new(12.5, -0.003), -1.0));
    assert_eq!(moves[1].feed, Some(200.0));
    let trace = trace("fanuc", &fanuc("G4 P1500\nG4 X2.5"));
    let dwells: Vec<f64> = trace
        .events
        .iter()
        .filter_map(|e| if let EventKind::Dwell(s) = e.kind { Some(s) } else { None })
        .collect();
    assert!(close(dwells[0], 1.5) && close(dwells[1], 2.5));
    let text = fanuc("G1 X5000 F3.").replace("G21", "G20");
    assert!(close(line(&clean("fanuc", &text)[1]).1.x, 0.5 * 25.4));
}

#[test]
fn fanuc_refuses_what_it_refuses() {
    for (body, line, words) in [
        ("g1 x1.", 9, "lower case letter 'g'"),
        ("T1. M6", 9, "T1 carries a decimal point"),
        ("G4 P1.5", 9, "P1.5 carries a decimal point"),
        ("(lower)", 9, "character set has no 'l'"),
        ("G1 X1. ; end", 9, "bad character ';'"),
        ("M3 M8", 9, "2 M codes in one block"),
        ("G2 X0. Y0. I-5.02 J0.", 9, "PS0020"),
        ("G1 X1. K2.", 9, "K2: no code in the block uses it"),
        ("G2 X0. Y0. I-5. K1.", 9, "K1: no code in the block uses it"),
        ("G41 X1.", 9, "cutter compensation without D"),
        ("G41 D1.5 X1.", 9, "D1.5 carries a decimal point"),
        ("G41 D1 G2 X0. Y0. I-5. J0.", 9, "begins or ends on an arc"),
        ("G41 D1 X1.\nG40 G2 X0. Y0. I-.5 J0.", 10, "begins or ends on an arc"),
        ("G41 D1 X1.\nG18", 10, "another plane under cutter compensation"),
        ("G41 D1 X1.\nG28 Z0.", 10, "G28 under cutter compensation"),
        ("G41 D1 X1.\nT1 M6", 10, "a tool change under cutter compensation"),
        ("G41 D1 X1.\nG81 X2. Z-1. R1.", 10, "a drilling cycle under cutter compensation"),
        ("G18 G41 D1 X1.", 9, "in another plane than G17"),
        ("D1 X1.", 9, "D1: no code in the block uses it"),
        ("G43", 9, "G43 without the word H"),
        ("G95 G1 X1.", 9, "PS0011"),
        ("G90.1 X1.", 9, "unknown code G90.1"),
    ] {
        let text = fanuc(body);
        let got = trace("fanuc", &text).faults;
        let fits = got.iter().any(|f| f.line == line && f.message.contains(words));
        assert!(fits, "{body}: {got:#?}");
    }
    faults(
        "fanuc",
        "O1\nG21 G90\nG0 X1.\nM30\n%\n",
        &[(1, "does not start with '%'"), (5, "'%' inside"), (5, "does not end")],
    );
    faults("fanuc", "%\nG21 G90\nM30\n%\n", &[(2, "no O number")]);
    faults("fanuc", "%\nO5\nG21 G90\n%\n", &[(4, "no M2 or M30")]);
    faults("fanuc", "%\nO5\nG21 G90\nM30\n", &[(4, "does not end with '%'")]);
}

#[test]
fn fanuc_lets_r_win_and_takes_a_full_circle_without_end() {
    let moves = clean("fanuc", &fanuc("G3 X0. Y10. R10. I99.\nG3 J-10."));
    assert!(arc(&moves[1]).0.coords.norm() < 1e-9);
    assert!(close(arc(&moves[2]).1, TAU) && arc(&moves[2]).0.coords.norm() < 1e-12);
}

#[test]
fn a_nurbs_of_fanuc_obeys_its_knot_rules() {
    let good =
        "G6.2 P3 K0. X10. Y0. R1.\nK0. X12. Y0. R1.\nK0. X12. Y2. R2.\nK1. X10. Y4. R1.\nK2.\nK2.\nK2.";
    let moves = clean("fanuc", &fanuc(good));
    let TracePath::Nurbs { order, points, weights, knots } = &moves[1].path else { panic!() };
    assert_eq!((*order, points.len(), knots.len()), (3, 4, 7));
    assert_eq!(weights, &[1.0, 1.0, 2.0, 1.0]);
    for (from, to, line, words) in [
        ("K0. X10. Y0. R1.", "K0. X10.5 Y0. R1.", 9, "is not the current position"),
        ("K0. X12. Y2.", "X12. Y2.", 11, "PS1002"),
        ("\nK2.\nK2.\nK2.", "\nK2.\nK2.\nG0 X1.", 15, "PS1005"),
        ("\nK2.\nK2.\nK2.", "\nK2.\nK3.\nK3.", 15, "PS1007"),
        ("K1. X10. Y4. R1.", "K0. X10. Y4. R1.", 15, "PS1008"),
        ("K1. X10. Y4. R1.", "K-1. X10. Y4. R1.", 12, "PS1008"),
        ("\nK2.\nK2.", "\nK2.\nX1. Y1. K2.", 14, "PS1004"),
        ("P3", "P7", 9, "rank P7"),
        ("K1. X10. Y4. R1.", "K1. X10. Y4. R0.", 12, "positive weight"),
        ("K1. X10. Y4. R1.", "K1. X10. Y4. Z-1. R1.", 12, "Z is no axis of the first block"),
    ] {
        let got = trace("fanuc", &fanuc(&good.replacen(from, to, 1))).faults;
        assert!(got.iter().any(|f| f.line == line && f.message.contains(words)), "{words}: {got:#?}");
    }
    let climbing = good
        .replace("X10. Y0. R1.", "X10. Y0. Z5. R1.")
        .replace("X12. Y2. R2.", "X12. Y2. Z7. R2.")
        .replace("X10. Y4. R1.", "X10. Y4. Z9. R1.");
    let moves = clean("fanuc", &fanuc(&climbing));
    let TracePath::Space(curve) = &moves[1].path else { panic!("{:?}", moves[1]) };
    assert_eq!(curve.points.iter().map(|p| p.z).collect::<Vec<_>>(), [5.0, 5.0, 7.0, 9.0]);
    assert_eq!((moves[1].z, moves[1].heights(), moves[1].end().z), ((5.0, 9.0), (5.0, 9.0), 9.0));
    assert!(moves[1].length() > 7.0 && moves[1].length() < 8.0, "{}", moves[1].length());
    let got = trace("fanuc", &fanuc(&format!("G95 F0.1\n{good}"))).faults;
    assert!(got.iter().any(|f| f.message.contains("PS1006")), "{got:?}");
}

fn grbl(body: &str) -> String {
    format!("G21 G90 G17 G94 G61 G54\nG0 X10 Y0 Z5\nS1000 M3\nF100\n{body}\nM30\n")
}

#[test]
fn grbl_refuses_what_it_refuses() {
    for (body, words) in [
        ("G64", "unknown code G64"),
        ("G95", "unknown code G95"),
        ("G43 H1", "unknown code G43"),
        ("M6 T1", "unknown code M6"),
        ("G83 X1 Z-1 R1 Q1", "unknown code G83"),
        ("O100", "O words"),
        ("%", "is not a command"),
        ("G1 X1 X2", "multiple X words"),
        ("G1 X1 P5", "error:36"),
        ("G1 X1 H5", "error:36"),
        ("G2 I-10", "error:26"),
        ("G2 Z1 I-10", "error:32"),
        ("G2 X0 Y10", "an arc without R, I and J"),
        ("G2 X10 Y0 R5", "ends where it starts"),
        ("G2 X0 Y0 R2", "too small to reach"),
        ("G2 X0 Y0 I-5.02 J0", "error:33"),
        ("G93 G1 X1", "error:22"),
        ("G93 G1 X1 F2\nG94 X2", "error:22"),
        ("G80\nX1", "without a motion code"),
        ("T300", "T300 is not in 0 to 255"),
        ("N10000001 X1", "N10000001 is not in"),
        ("G1 X1 (stop!)", "acts at once on '!'"),
        ("(caf\u{e9})", "acts at once on byte 0xC3"),
        ("$H", "bad character '$'"),
    ] {
        let got = trace("grbl", &grbl(body)).faults;
        assert!(!got.is_empty() && got[0].message.contains(words), "{body}: {got:#?}");
    }
    // Comments and blanks don't count: 79 characters are taken, 80 are not.
    let block =
        |digits: usize| format!("G1 X1.{} (a comment of some length to be left out) Y2", "0".repeat(digits));
    faults("grbl", &grbl(&block(71)), &[(5, "too many digits")]);
    let words = |n: usize| {
        let zeros = "0".repeat(16);
        format!("N1 G1 X1.{zeros} Y1.{zeros} Z1.{zeros} F100.{} (left out)", "0".repeat(n))
    };
    faults("grbl", &grbl(&words(13)), &[]);
    faults("grbl", &grbl(&words(14)), &[(5, "the line has 80 characters, the control takes 79")]);
}

#[test]
fn grbl_accepts_what_it_accepts() {
    let moves =
        clean("grbl", &grbl("g1x12y3 (open comment\nG2 X12 I-1 / ; semi\nG4P0.5\nG93 G1 X1 F2\nG94 F100 X2"));
    assert_eq!(moves.len(), 5);
    assert!(close(arc(&moves[2]).1, -TAU));
    assert!(close(moves[3].feed.unwrap(), 2.0 * moves[3].length()));
    // A program may end without M2, but not with the spindle turning.
    assert_eq!(trace("grbl", "G21 G90\nG0 X1\n").faults, []);
    assert!(trace("grbl", "G21 G90\nS100 M3\n").faults[0].message.contains("the spindle turning"));
}

#[test]
fn positions_are_not_known_after_a_tool_change_or_a_retract() {
    let moves = clean("fanuc", &fanuc("G91 G28 Z0.\nG90\nM5\nT2 M6\nG43 H2\nG0 X1. Y2.\nZ3."));
    let last = &moves[moves.len() - 2];
    assert_eq!((last.known, last.tool, last.spindle), ([false, false, false], 2, 0.0));
    assert_eq!(moves[moves.len() - 1].known, [true, true, false]);
}

#[test]
fn an_unknown_control_is_named() {
    let error = run(b"", "fnauc", &setup()).expect_err("unknown");
    assert!(error.to_string().contains("'fnauc'") && error.to_string().contains("grbl"));
}

#[test]
fn faults_are_capped() {
    let text = "X1 X2\n".repeat(5000);
    assert_eq!(trace("grbl", &text).faults.len(), MOST_FAULTS);
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(300))]

    /// Any bytes are read without a panic, for every control.
    #[test]
    fn any_bytes_are_read(bytes in proptest::collection::vec(proptest::prelude::any::<u8>(), 0..400)) {
        for control in controls() {
            let _ = run(&bytes, control, &setup());
        }
    }

    /// So is anything that looks like a program.
    #[test]
    fn any_words_are_read(text in "([GMXYZIJKRFSTPQLNOHDC%()/;. \n-][0-9.]{0,6}){0,120}") {
        for control in controls() {
            let trace = run(text.as_bytes(), control, &setup()).expect("known");
            for event in trace.events {
                if let EventKind::Move(m) = event.kind {
                    let _ = (m.start(), m.end(), m.length());
                }
            }
        }
    }
}

mod arcs;
mod controls;
mod cycles;
mod sinumerik;
mod stated;
