//! Programs written by hand.

use crate::geom::Point2;
use crate::math::{PI, TAU};
use crate::readback::*;

fn setup() -> MachineSetup {
    MachineSetup { rotary: Some(Rotary { letter: 'C', reversed: false }), ..MachineSetup::default() }
}

/// Numbers the blocks of a body between start and end.
fn program(unit: &str, body: &str) -> String {
    let start = "TOOL CALL 1 Z S1000\nL Z+5 R0 FMAX M3\nL X+10 Y+0 R0 FMAX";
    let text = format!("BEGIN PGM P1 {unit}\n{start}\n{body}\nL Z+50 R0 FMAX M30\nEND PGM P1 {unit}");
    let mut number = 0;
    let mut goes_on = false;
    text.lines().fold(String::new(), |mut all, line| {
        if !goes_on {
            all += &format!("{number} ");
            number += 1;
        }
        goes_on = line.ends_with('~');
        all + line + "\n"
    })
}

fn trace(text: &str) -> Trace {
    run(text.as_bytes(), "heidenhain", &setup()).expect("a known control")
}

fn clean(body: &str) -> Vec<TraceMove> {
    let trace = trace(&program("MM", body));
    assert_eq!((&trace.faults[..], &trace.assumed[..]), (&[][..], &[][..]), "{body}");
    let only_moves = |e: TraceEvent| if let EventKind::Move(m) = e.kind { Some(m) } else { None };
    trace.events.into_iter().filter_map(only_moves).skip(2).collect()
}

fn legs(body: &str) -> Vec<String> {
    let trace = trace(&program("MM", body));
    assert_eq!(trace.faults, [], "{body}");
    let leg = |e: TraceEvent| match e.kind {
        EventKind::Move(m) => {
            let p = m.end();
            Some(format!("{} {} {} {}", if m.rapid { 'R' } else { 'F' }, p.x, p.y, (p.z * 1e6).round() / 1e6))
        }
        EventKind::Dwell(s) => Some(format!("D {s}")),
        _ => None,
    };
    let legs: Vec<String> = trace.events.into_iter().filter_map(leg).skip(2).collect();
    legs[..legs.len() - 1].to_vec()
}

fn arc(m: &TraceMove) -> (Point2, f64) {
    match m.path {
        TracePath::Arc { centre, sweep, .. } => (centre, sweep),
        ref other => panic!("not an arc: {other:?}"),
    }
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}

/// Each body has a fault with these words.
fn refused(cases: &[(&str, &str)]) {
    for (body, words) in cases {
        let got = trace(&program("MM", body)).faults;
        assert!(got.iter().any(|f| f.message.contains(words)), "{body}: {got:#?}");
    }
}

#[test]
fn lines_with_their_feeds() {
    let moves = clean("L Z-1 F120\nL X+12.5 Y-3 F300 M8\nL IX+1 IY-1");
    assert_eq!((moves[0].feed, moves[1].feed, moves[2].feed), (Some(120.0), Some(300.0), Some(300.0)));
    assert_eq!(moves[2].end().xy(), Point2::new(13.5, -4.0));
    assert!(moves[1].coolant.flood && close(moves[1].spindle, 1000.0) && moves[1].tool == 1);
    // FMAX holds for its block; the feed before it comes back.
    let moves = clean("L Z-1 F120\nL Z+5 FMAX\nL Z-1");
    assert!(moves[1].rapid && !moves[2].rapid && moves[2].feed == Some(120.0));
}

#[test]
fn stops_of_the_program_stop_spindle_and_coolant() {
    for stop in ["STOP", "M0", "M1"] {
        let moves = clean(&format!("L Z-1 F120 M8\n{stop}\nL X+5\nM3\nL X+9"));
        let seen: Vec<(f64, bool)> = moves.iter().map(|m| (m.spindle, m.coolant.flood)).collect();
        assert_eq!(seen[..3], [(1000.0, true), (0.0, false), (1000.0, false)], "{stop}");
    }
}

#[test]
fn inch_feeds_are_in_tenths_of_an_inch() {
    let trace = trace(&program("INCH", "L X+1 F100"));
    assert_eq!(trace.faults, []);
    let EventKind::Move(m) = &trace.events[3].kind else { panic!() };
    assert!(close(m.end().x, 25.4) && close(m.feed.unwrap(), 254.0));
}

#[test]
fn circles_about_a_pole_by_radius_and_by_angle() {
    let moves = clean("L Z-1 F120\nCC X+0 Y+0\nC X+0 Y+10 DR+\nC X+10 Y+0 DR-\nC X+10 Y+0 DR+");
    assert!(close(arc(&moves[1]).1, PI / 2.0) && close(arc(&moves[2]).1, -PI / 2.0));
    assert!(close(arc(&moves[3]).1, TAU));
    let moves = clean("L Z-1 F120\nCR X+0 Y+10 R+10 DR+\nCR X+10 Y+0 R-10 DR+");
    assert!(arc(&moves[1]).0.coords.norm() < 1e-9 && close(arc(&moves[2]).1, 1.5 * PI));
    let moves = clean("L Z-1 F120\nCC X+0 Y+0\nCP IPA+810 IZ-4 DR+\nCP PA+0 DR-");
    assert!(close(arc(&moves[1]).1, 2.25 * TAU) && moves[1].z == (-1.0, -5.0));
    assert!((moves[1].end().xy() - Point2::new(0.0, 10.0)).norm() < 1e-9);
    assert!(close(arc(&moves[2]).1, -PI / 2.0));
}

#[test]
fn circles_about_poles_with_z_lie_in_the_other_planes() {
    let tilted = |m: &TraceMove| match &m.path {
        TracePath::Tilted(arc) => *arc,
        other => panic!("{other:?}"),
    };
    // From Z to X counter-clockwise, as seen against Y.
    let moves = clean("L Z+0 F120\nCC X+0 Z+0\nC X+0 Z-10 DR+\nC X+10 Z+0 DR-\nCC Y+0 Z+5\nC Y+5 Z+5 DR+");
    let arcs = [tilted(&moves[1]), tilted(&moves[2]), tilted(&moves[3])];
    assert!(arcs[0].axis.y == 1.0 && close(arcs[0].sweep, PI / 2.0) && close(arcs[1].sweep, -PI / 2.0));
    assert!(arcs[2].axis.x == 1.0 && close(arcs[2].sweep, PI / 2.0) && close(arcs[2].centre.x, 10.0));
    assert_eq!(moves[3].end(), crate::geom::Point3::new(10.0, 5.0, 5.0));
    refused(&[
        ("CC X+0 Y+0 Z+0", "a pole has two coordinates"),
        ("CC Z+0", "a pole has two coordinates"),
        ("CC X+0 Z+0\nC X+0 Y+1 Z-10 DR+ F100", "Y in a C block"),
        ("L Z+0 F100\nCC X+0 Z+0\nC X+0 Z-10.1 DR+", "circle end point incorrect"),
        ("L Z+0 F100\nCC X+0 Z+0\nCP IPA+90 DR+", "CP about a pole with Z"),
        ("L Z+0 F100\nCR X+0 Z-10 R+10 DR+", "Z in a CR block"),
    ]);
}

#[test]
fn the_control_refuses_what_it_refuses() {
    refused(&[
        ("L X+1", "feed rate is missing"),
        ("L X+1 F100 R0 Q3=1", "Q3 in a motion block"),
        ("L X+1 X+2 F100", "X2 twice"),
        ("L X+1 RL RR F100", "RR twice"),
        ("CC X+0 Y+0\nC X+0 Y+10 DR+ RL F100", "begins or ends on a circle"),
        ("L X+1 RL F100\nTOOL CALL 1 Z S1000", "a tool call under radius compensation"),
        ("L X+100000 F100", "is not in"),
        ("C X+1 Y+1 DR+ F100", "without a pole"),
        ("CC X+0 Y+0\nC X+0 Y+10.017 DR+ F100", "circle end point incorrect"),
        ("CC X+0 Y+0\nC X+0 Y+10 F100", "without DR"),
        ("CC X+0 Y+0\nC X+0 Y+10 DR+ FMAX", "a circle at FMAX"),
        ("CC X+0 Y+0\nC X+0 Y+10 Z-1 DR+ F100", "a helix is CP"),
        ("CC X+0 Y+0\nCP IPA-90 DR+ F100", "have DR's sign"),
        ("CC X+0 Y+0\nCP IPA+5401 DR+ F100", "not be over 5400"),
        ("CR X+0 Y+0 R+2 DR+ F100", "radius too small"),
        ("TOOL CALL 1 Y S100", "the spindle axis Y"),
        ("CYCL CALL", "without a cycle"),
        ("CYCL DEF 9.0 DWELL\nCYCL DEF 9.1 DWELL 4000", "is not in 0 to 3600"),
        ("CYCL DEF 9.1 DWELL 1", "without 9.0"),
        ("CYCL DEF 208 BORE MILLING ~\nQ200=1", "CYCL DEF 208 is not followed"),
        ("FN 0: Q1 = +3", "FN is not followed"),
        ("M128", "M128 is not followed"),
        ("L X+1 WHAT F10", "unknown word WHAT"),
    ]);
}

#[test]
fn the_frame_is_numbered_and_named() {
    let says = |text: &str, words: &str| {
        let got = trace(text).faults;
        assert!(got.iter().any(|f| f.message.contains(words)), "{text}: {got:#?}");
    };
    let good = program("MM", "L X+1 F100");
    assert_eq!(trace(&good).faults, []);
    says(&good.replacen("2 L", "3 L", 1), "block number 3 where 2 is next");
    says(&good.replacen("2 L", "L", 1), "a block without a number");
    says(&good.replacen("END PGM P1 MM", "END PGM P1 INCH", 1), "does not name the program");
    says(&good.replacen("END PGM P1 MM", "END PGM P2 MM", 1), "does not name the program");
    says(&good.replacen("BEGIN PGM P1 MM", "BEGIN PGM P1", 1), "does not start with BEGIN PGM");
    says("0 BEGIN PGM A MM\n1 L X+0 FMAX\n", "no END PGM");
    says(&(good.clone() + "9 L X+1\n"), "after END PGM");
    says(&good.replace(" M30", ""), "spindle");
}

#[test]
fn tools_dwells_stops_and_tolerances() {
    let text = program(
        "MM",
        "CYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1 T0.02\nL X+1 F100\nSTOP\nCYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 1.5\nTOOL CALL 2 Z S500 F80\nL Z+5 FMAX M4\nL X+3 Y+0 FMAX\nCYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1\nL X+4",
    );
    let trace = trace(&text);
    assert_eq!(trace.faults, []);
    let kinds: Vec<String> = trace
        .events
        .iter()
        .map(|e| match &e.kind {
            EventKind::Move(m) => format!("{} {} {} {:?}", m.tool, m.spindle, m.path_tolerance, m.feed),
            other => format!("{other:?}"),
        })
        .collect();
    let wanted = [
        "1 1000 0.02 Some(100.0)",
        "Stop { optional: false }",
        "Dwell(1.5)",
        "ToolChange(2)",
        "2 -500 0.02 None",
        "2 -500 0.02 None",
        "2 -500 0 Some(80.0)",
    ];
    assert_eq!(kinds[3..10], wanted);
}

const DRILL: &str = "CYCL DEF 200 DRILLING ~\nQ200=+2 ;SET-UP CLEARANCE ~\nQ201=-8 ;DEPTH ~\nQ206=+150 ;FEED ~\nQ202=+5 ;PECK ~\nQ210=+0 ~\nQ203=+0 ~\nQ204=+10 ~\nQ211=+0.5";

#[test]
fn drilling_pecks_from_the_surface_and_leaves_to_the_second_clearance() {
    let body = format!("{DRILL}\nL X+1 Y+2 R0 FMAX M99\nL X+4 R0 FMAX\nCYCL CALL");
    let hole = ["R 1 2 2", "F 1 2 -5", "R 1 2 2", "R 1 2 -3", "F 1 2 -8", "D 0.5", "R 1 2 10"];
    let got = legs(&body);
    assert_eq!(got[1..8], hole);
    assert_eq!(got[8], "R 4 2 10");
    assert_eq!(got[9..].len(), 7);
    let text = program("MM", &format!("{DRILL}\nL X+1 Y+2 RL FMAX M99"));
    let faults = trace(&text).faults;
    assert!(faults.iter().any(|f| f.message == "a cycle under radius compensation"), "{faults:?}");
}

#[test]
fn radius_compensation_holds_until_another_word() {
    let body = "L X+20 RL F100\nL Y+10\nCC X+10 Y+10\nC X+10 Y+20 DR+\nL Z+9 R0\nL X+0";
    let trace = trace(&program("MM", body));
    assert!(trace.faults.is_empty(), "{:?}", trace.faults);
    let sides: Vec<bool> = trace
        .events
        .iter()
        .filter_map(|e| if let EventKind::Move(m) = &e.kind { Some(m.compensation.is_some()) } else { None })
        .collect();
    assert_eq!(sides, [false, false, true, true, true, false, false, false]);
}

#[test]
fn chips_break_taps_turn_back_and_bores_come_out_at_feed() {
    let chip = DRILL.replace("200 DRILLING", "203 UNIVERSAL").replace("Q210=+0", "Q213=+9 ~\nQ256=+0.5");
    assert_eq!(
        legs(&format!("{chip}\nL X+1 Y+2 FMAX M99"))[1..],
        ["R 1 2 2", "F 1 2 -5", "R 1 2 -4.5", "F 1 2 -8", "D 0.5", "R 1 2 10"]
    );
    let tap =
        "CYCL DEF 207 TAPPING ~\nQ200=+2 ~\nQ201=-8 ~\nQ239=+1.5 ~\nQ203=+0 ~\nQ204=+10\nL X+1 Y+2 FMAX M99";
    let moves = clean(tap);
    let cuts: Vec<(f64, Option<f64>)> =
        moves.iter().filter(|m| !m.rapid).map(|m| (m.spindle, m.feed)).collect();
    assert_eq!(cuts, [(1000.0, Some(1500.0)), (-1000.0, Some(1500.0))]);
    let bore = "CYCL DEF 201 REAMING ~\nQ200=+2 ~\nQ201=-8 ~\nQ206=+100 ~\nQ211=+0 ~\nQ208=+50 ~\nQ203=+0 ~\nQ204=+10\nL X+1 Y+2 FMAX M99";
    assert_eq!(legs(bore)[1..], ["R 1 2 2", "F 1 2 -8", "F 1 2 2", "R 1 2 10"]);
}

#[test]
fn bad_cycles_are_refused() {
    for (from, to, words) in [
        ("Q201=-8", "Q201=+8", "must be negative"),
        ("Q206=+150 ;FEED ~\n", "", "without Q206"),
        ("Q206=+150", "Q206=+0", "without a feed"),
        ("Q202=+5", "Q202=+0.0001", "a peck of"),
    ] {
        let body = format!("{}\nL X+1 Y+2 FMAX M99", DRILL.replace(from, to));
        let got = trace(&program("MM", &body)).faults;
        assert!(got.iter().any(|f| f.message.contains(words)), "{to}: {got:#?}");
    }
}

fn bezier(m: &TraceMove) -> Vec<[f64; 3]> {
    match &m.path {
        TracePath::Nurbs { points, .. } => points.iter().map(|p| [p.x, p.y, m.z.0]).collect(),
        TracePath::Space(curve) => curve.points.iter().map(|p| [p.x, p.y, p.z]).collect(),
        other => panic!("not a curve: {other:?}"),
    }
}

fn near(got: &[[f64; 3]], want: &[[f64; 3]]) -> bool {
    got.len() == want.len() && got.iter().flatten().zip(want.iter().flatten()).all(|(a, b)| close(*a, *b))
}

#[test]
fn a_spline_runs_from_one_to_zero() {
    // From (10, 0) to (40, 30): x = 40 - 30 t, y = 30 - 60 t + 30 t².
    let body = "L Z-1 F120\nSPL X+40 Y+30 Z-1 ~\nK3X+0 K2X+0 K1X-3E+1 ~\nK3Y0.0 K2Y3.000E+001 K1Y-6 E+1 ~\nK3Z+0 K2Z+0 K1Z+0 F300";
    let moves = clean(body);
    let want = [[10.0, 0.0, -1.0], [20.0, 0.0, -1.0], [30.0, 10.0, -1.0], [40.0, 30.0, -1.0]];
    assert!(near(&bezier(&moves[1]), &want), "{:?}", moves[1]);
    assert_eq!((moves[1].feed, moves[1].z), (Some(300.0), (-1.0, -1.0)));
    // The next one goes on from its end; an axis that is not said stays, and Z climbs by 3 t² - 2 t³ back from 1.
    let body =
        "L Z-1 F120\nSPL X+40 Y+30 K3X+0 K2X+0 K1X-3E1 K3Y0 K2Y3E1 K1Y-6E1\nSPL Z+0 K3Z+2 K2Z-3 K1Z+0\nL X+0";
    let moves = clean(body);
    let want = [[40.0, 30.0, -1.0], [40.0, 30.0, -1.0], [40.0, 30.0, 0.0], [40.0, 30.0, 0.0]];
    assert!(near(&bezier(&moves[2]), &want), "{:?}", moves[2]);
    assert_eq!(moves[3].start().z, 0.0);
    let inch = trace(&program("INCH", "L Z-1 F120\nSPL X+40 Y+0 K3X0 K2X0 K1X-3E1 K3Y0 K2Y0 K1Y0"));
    assert_eq!(inch.faults, []);
    refused(&[
        ("L Z-1 F9\nSPL X+40 Y+30 K3X+0 K2X+0 K1X-3E1 K3Y0 K2Y3E1 K1Y-5.9E1", "the spline starts at Y1.0"),
        ("L Z-1 F9\nSPL X+40.0011 Y+0 K3X+0 K2X+0 K1X-3E1 K3Y0 K2Y0 K1Y0", "the spline starts at X10.001100"),
        ("L Z-1 F9\nSPL X+20 Y+0 K3X+0 K2X+0 K1X-10 K3Y0 K2Y0 K1Y0", "one digit before the point"),
        ("L Z-1 F9\nSPL X+20 Y+0 K3X0.000000001 K2X+0 K1X-1E1 K3Y0 K2Y0 K1Y0", "one digit before the point"),
        ("L Z-1 F9\nSPL X+20 Y+0 K3X+0 K2X+0 K1X-1E300 K3Y0 K2Y0 K1Y0", "exponents go"),
        ("L Z-1 F9\nSPL X+20 Y+0 K2X+0 K3X+0 K1X-1E1 K3Y0 K2Y0 K1Y0", "in the order K3, K2, K1"),
        ("L Z-1 F9\nSPL X+20 Y+0 K3X+0 K2X+0 K1X-1E1", "without K3Y"),
        ("L Z-1 F9\nSPL X+20 K3X+0 K2X+0 K1X-1E1 K3Y0 K2Y0 K1Y0", "coefficients of Y"),
        ("L Z-1 F9\nSPL X+20 K3X+0 K2X+0 K1X-1E1 FMAX", "FMAX"),
        ("L Z-1 F9\nSPL IX+10 K3X+0 K2X+0 K1X-1E1", "its end is absolute"),
        ("SPL X+20 K3X+0 K2X+0 K1X-1E1", "feed rate is missing"),
        ("L Z-1 F9\nL X+20 K3X+0", "outside SPL"),
        ("L Z-1 F9\nSPL F20", "without its end"),
    ]);
}
