//! SINUMERIK: its words, arcs, dwells, tools and cycles.

use super::*;

fn program(body: &str) -> String {
    format!(
        "%_N_PART_MPF\nG17 G710 G90 G94 G40 G60 G54\nT1 M6\nD1\nG0 X10 Y0 Z5\nS1000 M3\nF100\n{body}\nM30\n"
    )
}

fn run_it(text: &str) -> Trace {
    let setup = MachineSetup { tool_names: vec![("MILL 10".to_owned(), 7)], ..setup() };
    run(text.as_bytes(), "sinumerik", &setup).expect("a known control")
}

fn fine(body: &str) -> Vec<TraceMove> {
    let trace = run_it(&program(body));
    assert_eq!((&trace.faults[..], &trace.assumed[..]), (&[][..], &[][..]), "{body}");
    moves(trace).into_iter().skip(1).collect()
}

fn legs(body: &str) -> Vec<String> {
    let trace = run_it(&program(body));
    assert_eq!(trace.faults, [], "{body}");
    let leg = |e: TraceEvent| match e.kind {
        EventKind::Move(m) => {
            let p = m.end();
            Some(format!("{} {} {} {}", if m.rapid { 'R' } else { 'F' }, p.x, p.y, (p.z * 1e6).round() / 1e6))
        }
        EventKind::Dwell(s) => Some(format!("D {s}")),
        _ => None,
    };
    trace.events.into_iter().filter_map(leg).skip(1).collect()
}

/// Each body has a fault with these words.
fn refused(cases: &[(&str, &str)]) {
    for (body, words) in cases {
        let got = run_it(&program(body)).faults;
        assert!(got.iter().any(|f| f.message.contains(words)), "{body}: {got:#?}");
    }
}

#[test]
fn words_with_and_without_equals() {
    let moves = fine("n10 G1 x=12.5 Y=-3 Z-1 ; a comment\nX=IC(1) Y=AC(4)\nG91 X1 Y=AC(5)\nG90 X1.25EX1");
    assert_eq!(line(&moves[0]).1, Point2::new(12.5, -3.0));
    assert_eq!(line(&moves[1]).1, Point2::new(13.5, 4.0));
    assert_eq!(line(&moves[2]).1, Point2::new(14.5, 5.0));
    assert!(close(line(&moves[3]).1.x, 12.5));
    assert!(
        moves
            .iter()
            .all(|m| m.length_offset && m.tool == 1 && m.path_tolerance == 0.0 && m.work_offset == Some(1))
    );
}

#[test]
fn arcs_by_offsets_radius_absolute_centre_and_turns() {
    let moves = fine(
        "G3 X0 Y10 I-10 J0\nG2 X10 Y0 CR=10\nG3 X0 Y10 CR=-10\nG2 X10 Y0 I=AC(0) J=AC(0)\nG3 X10 Y0 I-10 J0 Z-4 TURN=2\nG2 I-10",
    );
    assert!(close(arc(&moves[0]).1, PI / 2.0) && close(arc(&moves[1]).1, -PI / 2.0));
    assert!(close(arc(&moves[2]).1, 1.5 * PI));
    assert!(close(arc(&moves[3]).1, -PI / 2.0) && arc(&moves[3]).0.coords.norm() < 1e-12);
    assert!(close(arc(&moves[4]).1, 3.0 * TAU) && moves[4].z == (5.0, -4.0));
    assert!(close(arc(&moves[5]).1, -TAU));
}

#[test]
fn dwells_in_seconds_and_revolutions() {
    assert_eq!(legs("G4 F1.5\nG4 S100"), ["D 1.5", "D 6"]);
    // F of a dwell is no feed, S no speed.
    let moves = fine("G4 F1.5\nG4 S100\nG1 X1");
    assert!(moves[0].feed == Some(100.0) && close(moves[0].spindle, 1000.0));
}

#[test]
fn the_feed_is_gone_when_its_type_changes() {
    let got = run_it(&program("G95\nG1 X1")).faults;
    assert!(got.iter().any(|f| f.message.contains("10860")), "{got:?}");
    assert_eq!(fine("G95 F0.1\nG1 X1")[0].feed, Some(100.0));
    let moves = moves(run_it(&program("F10\nG1 X1").replace("G710", "G700")));
    assert!(close(moves.last().expect("a move").feed.expect("a feed"), 254.0));
}

#[test]
fn tools_by_name_and_lengths_by_d() {
    let trace = run_it(&program("T=\"mill 10\"\nM6\nD1\nS500 M3\nG0 X1 Y1 Z5\nG1 X2\nG0 SUPA Z0 D0\nG0 X3"));
    assert_eq!(trace.faults, []);
    assert!(trace.events.iter().any(|e| matches!(e.kind, EventKind::ToolChange(7))));
    let moves = moves(trace);
    let (cut, after) = (&moves[2], &moves[3]);
    assert!(cut.tool == 7 && cut.length_offset && !after.length_offset && !after.known[2]);
    let got = run_it(&program("T=\"OTHER\" M6")).faults;
    assert!(got.iter().any(|f| f.message.contains("no tool 'OTHER'")), "{got:?}");
}

#[test]
fn path_tolerance_is_what_was_asked_for() {
    let of = |words: &str| fine(&format!("{words}\nG1 X1"))[0].path_tolerance;
    assert_eq!((of("G60"), of("G64"), of("G642")), (0.0, f64::INFINITY, f64::INFINITY));
    assert!(close(of("CYCLE832(0.02,112001)\nG642"), 0.02) && close(of("G642 CTOL=0.03"), 0.03));
    assert!(close(of("CYCLE832(0.02,112001)"), 0.02) && of("CYCLE832(0,0)") == 0.0);
    assert_eq!(of("COMPCAD"), f64::INFINITY);
}

#[test]
fn modal_cycles_drill_at_every_position() {
    let hole = [
        "R 1 2 5", "R 1 2 2", "F 1 2 -8", "D 0.5", "R 1 2 10", "R 4 2 10", "R 4 2 2", "F 4 2 -8", "D 0.5",
        "R 4 2 10", "R 7 2 10",
    ];
    assert_eq!(legs("MCALL CYCLE82(10,0,2,-8,,0.5)\nG0 X1 Y2\nX4\nMCALL\nX7"), hole);
    assert_eq!(legs("MCALL CYCLE82(10,0,2,,8,0.5)\nG0 X1 Y2\nX4\nMCALL\nX7"), hole);
    let deep = "MCALL CYCLE83(10,0,2,-8,,,5,0,0.5,,1,1,,,,,0.5)\nG0 X1 Y2\nMCALL";
    assert_eq!(
        legs(deep)[1..],
        ["R 1 2 2", "F 1 2 -5", "R 1 2 2", "R 1 2 -4.5", "F 1 2 -8", "D 0.5", "R 1 2 10"]
    );
    let chip = deep.replace(",1,1,,,,,0.5", ",1,0,,,0.25");
    assert_eq!(legs(&chip)[1..], ["R 1 2 2", "F 1 2 -5", "R 1 2 -4.75", "F 1 2 -8", "D 0.5", "R 1 2 10"]);
}

#[test]
fn taps_and_bores_of_calls() {
    let moves = fine("MCALL CYCLE84(10,0,2,-8,,,3,,1.5,,400)\nG0 X1 Y2\nMCALL\nG1 X9");
    let cuts: Vec<(f64, Option<f64>)> =
        moves.iter().filter(|m| !m.rapid).map(|m| (m.spindle, m.feed)).collect();
    assert_eq!(cuts, [(400.0, Some(600.0)), (-400.0, Some(600.0)), (1000.0, Some(100.0))]);
    let moves = fine("MCALL CYCLE85(10,0,2,-8,,,80,40)\nG0 X1 Y2\nMCALL");
    let feeds: Vec<Option<f64>> = moves.iter().filter(|m| !m.rapid).map(|m| m.feed).collect();
    assert_eq!(feeds, [Some(80.0), Some(40.0)]);
}

#[test]
fn the_control_refuses_what_it_refuses() {
    refused(&[
        ("G2 X0 Y0 I-5.02 J0", "alarm 14040"),
        ("G2 X10 Y0 CR=5", "ends where it starts"),
        ("G1 X1 WHAT", "unknown word WHAT"),
        ("G43 H1", "unknown code G43"),
        ("G70", "G70 is not followed"),
        ("G1 X1 (comment)", "bad character '('"),
        ("G1 X=R1", "is not followed by a number"),
        ("R1=5", "an R parameter"),
        ("CSPLINE X1", "CSPLINE is not followed"),
        ("CYCLE800(1)", "CYCLE800 is not followed"),
        ("POCKET3(1,2)", "POCKET3 is not followed"),
        ("MCALL CYCLE81(10,0,2,5)\nG0 X1", "must lie over the bottom"),
        ("MCALL CYCLE81(10,0,2)\nG0 X1", "without DP and DPR"),
        ("MCALL CYCLE83(10,0,2,-8)\nG0 X1", "without a first depth"),
        ("MCALL CYCLE81(10,0,2,-8)\nMCALL CYCLE81(10,0,2,-8)", "inside another"),
        ("G1 X1 G2", "two codes of one modal group"),
        ("G1 X1 X2", "multiple X words"),
        ("T=\"OPEN", "not closed by a quotation mark"),
        ("MSG(\"a)b\") X", "unknown word X"),
        ("G0 SUPA Z0 D99", "D99 is no cutting edge"),
        ("MCALL CYCLE81(10,0,2,-8\nG0 X1", "is not closed"),
    ]);
    let long = format!("G1 X1 ;{}", "A".repeat(520));
    assert!(run_it(&program(&long)).faults.iter().any(|f| f.message.contains("the control takes 512")));
}

#[test]
fn a_bspline_starts_where_the_tool_is_and_ends_with_the_next_motion() {
    let moves = fine("BSPLINE SD=3 F50\nX11 Y1\nX12 Y3 PW=2\nX14 Y3\nX15 Y0\nG1 X16");
    let TracePath::Nurbs { order, points, weights, knots } = &moves[0].path else { panic!("{:?}", moves[0]) };
    assert_eq!((*order, points.len()), (4, 5));
    assert_eq!(points[0], Point2::new(10.0, 0.0));
    assert_eq!(weights, &[1.0, 1.0, 2.0, 1.0, 1.0]);
    assert_eq!(knots, &[0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0, 2.0]);
    // The word is modal: said again it goes on, and only another motion ends the curve.
    let moves = fine(
        "BSPLINE SD=3 F50\nX11 Y1\nBSPLINE\nX12 Y3\nX14 Y3 Z7\nX15 Y0 Z8\nG1\nBSPLINE\nX16 Y0\nX17 Y1\nX18 Y1",
    );
    let TracePath::Space(curve) = &moves[0].path else { panic!("{:?}", moves[0]) };
    assert_eq!((curve.points.len(), curve.points[4].z, moves[0].z.1, moves.len()), (5, 8.0, 8.0, 2));
    assert_eq!(moves[1].start(), crate::geom::Point3::new(15.0, 0.0, 8.0));
    let line_of = run_it(&program("BSPLINE SD=3 F50\nX11 Y1\nX12 Y3\nX14 Y3\nX15 Y0\nG1 X16")).events[2].line;
    assert_eq!(line_of, 12);
    refused(&[
        ("BSPLINE SD=3 F50\nX11 Y1\nG1 X12", "needs 4"),
        ("BSPLINE SD=5 F50\nX11 Y1\nG1 X12", "degree 2 or 3"),
        ("BSPLINE\nX11 Y1 PW=0\nX12\nX13\nG1 X12", "PW=0"),
        ("BSPLINE\nX11 Y1 PL=2\nX12\nX13\nG1 X12", "PL=2"),
    ]);
}

fn control(m: &TraceMove) -> Vec<[f64; 4]> {
    match &m.path {
        TracePath::Nurbs { points, weights, .. } => {
            points.iter().zip(weights).map(|(p, w)| [p.x, p.y, m.z.0, *w]).collect()
        }
        TracePath::Space(c) => c.points.iter().zip(&c.weights).map(|(p, w)| [p.x, p.y, p.z, *w]).collect(),
        other => panic!("not a curve: {other:?}"),
    }
}

fn near(got: &[[f64; 4]], want: &[[f64; 4]]) -> bool {
    got.len() == want.len() && got.iter().flatten().zip(want.iter().flatten()).all(|(a, b)| close(*a, *b))
}

#[test]
fn polynomials_get_their_first_coefficient_from_their_end() {
    // x = 10 + 30 p, y = 30 p², and the same over an interval of 2: y = 7.5 q².
    let want = [[10.0, 0.0, 5.0, 1.0], [25.0, 0.0, 5.0, 1.0], [40.0, 30.0, 5.0, 1.0]];
    for body in [
        "POLY PO[X]=(40) PO[Y]=(30,30) F50",
        "POLY X=PO(40) Y=PO(30, 30)",
        "POLY X40 PO[Y]=(30,7.5) PL=2",
        "POLY\npo[x] = (40.0) PO[Y]=(3EX1,0.75EX1) PL=2",
    ] {
        let moves = fine(body);
        assert!(near(&control(&moves[0]), &want), "{body}: {:?}", moves[0]);
    }
    // A climb of the third degree: z = 5 + 3 p² - 2 p³; then straight on, without POLY being said again.
    let moves = fine("POLY PO[X]=(40) PO[Z]=(6,3,-2)\nX50 Y3\nG1 Z7");
    let want = [[10.0, 0.0, 5.0, 1.0], [20.0, 0.0, 5.0, 1.0], [30.0, 0.0, 6.0, 1.0], [40.0, 0.0, 6.0, 1.0]];
    assert!(near(&control(&moves[0]), &want), "{:?}", moves[0]);
    assert!(
        matches!(moves[1].path, TracePath::Line { .. }) && moves[1].end().y == 3.0 && moves[1].z.0 == 6.0
    );
    // The fifth degree.
    let moves = fine("POLY PO[Y]=(1,0,10,-15,6)");
    assert_eq!(control(&moves[0]).len(), 6);
    refused(&[
        ("PO[X]=(40,1) F50", "without POLY"),
        ("G1 PO[X]=(40,1)", "without POLY"),
        ("POLY PO[Y]=(1,0,10,-15,6,7)", "fifth degree"),
        ("POLY PO[X]=(40,1) PL=0", "PL=0"),
        ("POLY PO[A]=(40,1)", "does not follow"),
        ("POLY PO[X]=(40,1", "not closed"),
        ("POLY PO[X=(40,1)", "is not PO[axis]"),
        ("POLY PO[X]=(40,R1)", "is no number"),
        ("POLY PO[X]=(40,1) X7", "multiple X words"),
        ("POLY PO[X]=(1,2) PO[]=(-1)", "a denominator that may be 0"),
        ("POLY PO[X]=(1,2) Y3 PO[]=(2)", "an axis without PO"),
        ("SUPA G0 X0\nPOLY PO[X]=(1,2)", "not known"),
    ]);
}

#[test]
fn a_denominator_makes_a_circle() {
    // x = 10 (1 - p²) / (1 + p²), y = 20 p / (1 + p²).
    let moves = fine("POLY PO[X]=(0,-10) PO[Y]=(10) PO[]=(2,1)");
    let TracePath::Nurbs { order, points, weights, knots } = &moves[0].path else { panic!("{:?}", moves[0]) };
    assert_eq!(*order, 3);
    for i in 0..=8 {
        let at = crate::readback::nurbs_point(3, points, weights, knots, f64::from(i) / 8.0);
        assert!(close(at.coords.norm(), 10.0), "{at:?}");
    }
}

fn tilted(m: &TraceMove) -> &crate::readback::Tilted {
    let TracePath::Tilted(arc) = &m.path else { panic!("{m:?}") };
    arc
}

#[test]
fn cip_goes_through_its_place_between() {
    // Over the top from X10 to X0, in the plane of X and Z.
    let moves = fine("CIP X0 I1=5 J1=0 K1=10\nG1 X-1");
    let arc = tilted(&moves[0]);
    assert!((arc.centre - crate::geom::Point3::new(5.0, 0.0, 5.0)).norm() < 1e-12, "{arc:?}");
    assert!(arc.axis.y == -1.0 && close(arc.sweep, PI) && close(arc.at(0.5).z, 10.0));
    assert_eq!(line(&moves[1]).0, Point2::new(0.0, 0.0));
    // The same under it, in increments; then back, by the word that is still in force.
    let moves = fine("G91 CIP X-10 I1=IC(-5) K1=-5\nG90 X10 Z5 I1=AC(5) K1=AC(10)");
    assert!(close(tilted(&moves[0]).at(0.5).z, 0.0) && close(tilted(&moves[1]).at(0.5).z, 10.0));
    // Level ones are arcs as those of G2 and G3.
    let moves = fine("CIP X0 Y0 I1=5 J1=5\nCIP X10 Y0 I1=5 J1=5 ; back");
    assert!(close(self::arc(&moves[0]).1, PI) && close(self::arc(&moves[1]).1, -PI));
    // Anywhere in space, and for more than half a turn.
    let moves = fine("CIP X11 Y1 Z6 I1=12 J1=5 K1=3");
    let arc = tilted(&moves[0]);
    assert!(
        arc.sweep > 0.0
            && [arc.from, arc.to, crate::geom::Point3::new(12.0, 5.0, 3.0)].iter().all(|p| {
                let arm = p - arc.centre;
                close(arm.norm(), arc.radii().0) && arm.dot(&arc.axis).abs() < 1e-9
            })
    );
    refused(&[
        ("CIP X0", "without a place between"),
        ("CIP X0 I1=5 K1=5", "lie in a line"),
        ("G1 X0 I1=5", "without CIP"),
        ("CIP X0 I1=5 I1=6 K1=7", "multiple I1= words"),
        ("CIP X0 I1=AC(5 K1=7", "not closed"),
        ("CIP X0 I1=R5 K1=7", "is not followed by a number"),
        ("CT X0 Y3", "CT"),
    ]);
}
