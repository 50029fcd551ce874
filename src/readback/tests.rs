//! Programs written by hand for each control: what they do, and what the controls say to bad ones.

use super::*;
use crate::math::{PI, TAU};

fn setup() -> MachineSetup {
    MachineSetup { rotary: Some(Rotary { letter: 'C', reversed: false }), tools: None }
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

const LINUXCNC_START: &str = "G21 G90 G17 G94 G61\nT1 M6\nG43 H1\nG0 X10 Y0\nZ5\nS1000 M3\nF100\n";

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
