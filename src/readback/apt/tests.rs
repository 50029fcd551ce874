//! Programs written by hand.

use crate::geom::{Point2, Point3, Vec3};
use crate::math::{PI, TAU};
use crate::readback::*;

const START: &str = "PARTNO/ PLATE (X/Y), $$ 5\nUNITS/MM\nCUTTER/10, 0\nLOADTL/3\nSPINDL/1000, CLW\n$$ a comment\nRAPID\nGOTO/10, 0, 5\nFEDRAT/300, MMPM\n";

fn trace(body: &str) -> Trace {
    let text = format!("{START}{body}\nSPINDL/OFF\nFINI\n");
    run(text.as_bytes(), "apt-cl", &MachineSetup::default()).expect("a known control")
}

fn clean(body: &str) -> Vec<TraceMove> {
    let trace = trace(body);
    assert_eq!(trace.faults, [], "{body}");
    let only_moves = |e: TraceEvent| if let EventKind::Move(m) = e.kind { Some(m) } else { None };
    trace.events.into_iter().filter_map(only_moves).skip(1).collect()
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}

#[test]
fn points_with_their_state() {
    let moves = clean(
        "COOLNT/FLOOD\nGOTO/1.5, 2, -1\nFEDRAT/IPM, 10\nGOTO/2, 2, -1\nRAPID\nGOTO/2, 2, 5\nGOTO/3, 2, 5",
    );
    assert_eq!(moves[0].end(), Point3::new(1.5, 2.0, -1.0));
    assert!(
        moves[0].feed == Some(300.0)
            && moves[0].tool == 3
            && moves[0].coolant.flood
            && close(moves[0].spindle, 1000.0)
    );
    assert!(close(moves[1].feed.unwrap(), 254.0) && moves[2].rapid && !moves[3].rapid);
    let inch = trace("UNITS/INCH\nFEDRAT/10, PERMIN\nGOTO/1, 0, 0");
    let EventKind::Move(m) = &inch.events[2].kind else { panic!("{inch:?}") };
    assert!(close(m.end().x, 25.4) && close(m.feed.unwrap(), 254.0));
}

#[test]
fn circles_turn_right_handed_about_their_axis() {
    let moves = clean(
        "CIRCLE/0, 0, 5, 0, 0, 1, 10\nGOTO/0, 10, 5\nCIRCLE/0, 0, 0, 0, 0, -1, 10\nGOTO/10, 0, 5\nCIRCLE/0, 0, 5, 0, 0, 1, 10\nGOTO/10, 0, 5\nCIRCLE/0, 0, 5, 0, -1, 0, 10\nGOTO/0, 0, 15",
    );
    let sweep = |m: &TraceMove| match m.path {
        TracePath::Arc { centre, sweep, .. } if centre == Point2::origin() => sweep,
        ref other => panic!("{other:?}"),
    };
    assert!(
        close(sweep(&moves[0]), PI / 2.0)
            && close(sweep(&moves[1]), -PI / 2.0)
            && close(sweep(&moves[2]), TAU)
    );
    let TracePath::Tilted(arc) = moves[3].path else { panic!("{:?}", moves[3]) };
    assert!(arc.axis == -Vec3::y() && close(arc.sweep, PI / 2.0));
}

#[test]
fn cycles_make_holes_of_points() {
    let legs = |body: &str| -> Vec<String> {
        let trace = trace(body);
        assert_eq!(trace.faults, [], "{body}");
        let leg = |e: TraceEvent| match e.kind {
            EventKind::Move(m) => {
                Some(format!("{} {} {}", if m.rapid { 'R' } else { 'F' }, m.end().x, m.end().z))
            }
            EventKind::Dwell(s) => Some(format!("D {s}")),
            _ => None,
        };
        trace.events.into_iter().filter_map(leg).skip(1).collect()
    };
    assert_eq!(
        legs(
            "CYCLE/DRILL, FEDTO, 8, MMPM, 100, CLEAR, 2, RETURN, ON, DWELL, 0.5\nGOTO/1, 0, 0\nCYCLE/OFF\nRAPID\nGOTO/9, 0, 5"
        ),
        ["R 1 5", "R 1 2", "F 1 -8", "D 0.5", "R 1 5", "R 9 5"]
    );
    assert_eq!(
        legs("CYCLE/DEEP, FEDTO, 8, STEP, 6, MMPM, 100, CLEAR, 2\nGOTO/1, 0, 0\nCYCLE/OFF"),
        ["R 1 5", "R 1 2", "F 1 -4", "R 1 2", "R 1 -3.5", "F 1 -8", "R 1 2"]
    );
    let moves = clean("CYCLE/TAP, FEDTO, 8, PITCH, 1.5, CLW, CLEAR, 2\nGOTO/1, 0, 0\nCYCLE/OFF");
    let cuts: Vec<(f64, Option<f64>)> =
        moves.iter().filter(|m| !m.rapid).map(|m| (m.spindle, m.feed)).collect();
    assert_eq!(cuts, [(1000.0, Some(1500.0)), (-1000.0, Some(1500.0))]);
}

#[test]
fn what_is_not_understood_is_said() {
    for (body, words) in [
        ("GOTO/1, 2", "three coordinates"),
        ("GOTO/1, 2, 3, 0, 0, 1", "three coordinates"),
        ("MULTAX/ON", "MULTAX is not followed"),
        ("CIRCLE/0, 0, 5, 0, 0, 1, 9\nGOTO/0, 10, 5", "the radius is 9"),
        ("CIRCLE/0, 0, 5, 0, 0, 1\nGOTO/0, 10, 5", "seven numbers"),
        ("CYCLE/DRILL, CLEAR, 2\nGOTO/1, 0, 0", "without FEDTO"),
        ("CYCLE/DEEP, FEDTO, 8, CLEAR, 2\nGOTO/1, 0, 0", "without a STEP"),
        ("CYCLE/TAP, FEDTO, 8, CLEAR, 2\nGOTO/1, 0, 0", "without PITCH"),
        ("FEDRAT/0", "without a feed"),
        ("MSYS/1, 0, 0, 1, 0, 0, 0, 1, 0", "another coordinate system"),
        ("SPINDL/FAST", "FAST in SPINDL"),
        ("GOTO/1, 0, $", "goes on in the next line"),
        ("FINI\nGOTO/1, 0, 0", "after FINI"),
    ] {
        let got = trace(body).faults;
        assert!(got.iter().any(|f| f.message.contains(words)), "{body}: {got:#?}");
    }
    let got = run(b"GOTO/1, 0, 0\n", "apt-cl", &MachineSetup::default()).expect("known").faults;
    assert!(
        got.iter().any(|f| f.message.contains("no FINI"))
            && got.iter().any(|f| f.message.contains("without FEDRAT"))
    );
}
