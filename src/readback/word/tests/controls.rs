//! What tells the controls apart.

use super::*;

/// The row's own complaints: control, body of a Fanuc-like program, words of the fault or assumption.
fn said(control: &str, text: &str) -> Vec<String> {
    let trace = trace(control, text);
    trace.faults.into_iter().chain(trace.assumed).map(|f| f.message).collect()
}

fn says(control: &str, text: &str, words: &str) {
    let said = said(control, text);
    assert!(said.iter().any(|m| m.contains(words)), "{control}: {text}\nwanted {words}\ngot {said:#?}");
}

fn dwells(control: &str, text: &str) -> Vec<f64> {
    let seconds = |e: TraceEvent| if let EventKind::Dwell(s) = e.kind { Some(s) } else { None };
    trace(control, text).events.into_iter().filter_map(seconds).collect()
}

fn marlin(body: &str) -> String {
    format!("G21\nG90\nG17\nM3 S1000\nG0 X10 Y0 Z5\nG1 Z-1 F100\n{body}\nM5\n")
}

#[test]
fn dwells_of_blocks() {
    assert_eq!(dwells("fanuc", &fanuc("G4 P500")), [0.5]);
    assert_eq!(dwells("haas", &fanuc("G4 P500\nG4 P0.5")), [0.5, 0.5]);
    assert_eq!(dwells("mazak", &fanuc("G4 X0.5")), [0.5]);
    assert_eq!(dwells("mitsubishi", &fanuc("G4 P500")), [0.5]);
    assert_eq!(dwells("centroid", &fanuc("G4 P0.5")), [0.5]);
    assert_eq!(dwells("grblhal", &grbl("G4 P0.5")), [0.5]);
    assert_eq!(dwells("mach3", &linuxcnc("G4 P0.5")), [0.5]);
    assert_eq!(dwells("mach3-ms", &linuxcnc("G4 P500")), [0.5]);
    assert_eq!(dwells("marlin", &marlin("G4 P500\nG4 S0.5\nG4 S2 P500")), [0.5, 0.5, 2.0]);
    assert_eq!(dwells("smoothieware", &marlin("G4 P500")), [0.5]);
    assert_eq!(dwells("smoothieware-grbl", &marlin("G4 P0.5")), [0.5]);
    let text = "OA1\nG15 H1\nG17 G21 G90 G94\nS100 M3\nF300.\nG4 F0.5\nG1 X1.\nM30\n";
    assert_eq!(dwells("okuma", text), [0.5]);
    // F of a dwell is no feed.
    let moves = moves(trace("okuma", text));
    assert_eq!(moves[0].feed, Some(300.0));
}

#[test]
fn arcs_off_their_circle() {
    let arc = |off: &str| fanuc(&format!("G2 X0. Y0. I-5.0{off} J0."));
    for (control, fine, refused) in [
        ("fanuc", "05", "051"),
        ("haas", "02", "03"),
        ("mazak", "02", "03"),
        ("mitsubishi", "02", "03"),
        ("centroid", "02", "03"),
    ] {
        assert!(!said(control, &arc(fine)).iter().any(|m| m.contains("r1")), "{control}");
        says(control, &arc(refused), "r1");
    }
    let mach = |off: &str| linuxcnc(&format!("G91.1\nG2 X0 Y0 I-5.{off} J0"));
    assert!(!said("mach3", &mach("0005")).iter().any(|m| m.contains("r1")));
    says("mach3", &mach("0015"), "r1");
    says("mach3", &linuxcnc("G2 X0 Y0 I-5 J0"), "neither G90.1 nor G91.1");
    let okuma = |off: &str| {
        format!("OA1\nG15 H1\nG17 G21 G90 G94\nG0 X10. Y0.\nS100 M3\nF300.\nG2 X0. Y0. I-5.0{off} J0.\nM30\n")
    };
    assert!(!said("okuma", &okuma("09")).iter().any(|m| m.contains("2252")));
    says("okuma", &okuma("11"), "alarm B 2252");
}

#[test]
fn numbers_without_a_point() {
    assert!(close(line(&clean("haas", &fanuc("G1 X5000"))[1]).1.x, 5.0));
    for control in ["mitsubishi", "centroid"] {
        says(control, &fanuc("G1 X5"), "is a setting");
        assert!(!said(control, &fanuc("G1 X5.")).iter().any(|m| m.contains("is a setting")));
    }
    says("okuma", "OA1\nG15 H1\nG0 X5\nM30\n", "is a setting");
    assert!(close(line(&clean("marlin", &marlin("G1 X5"))[2]).1.x, 5.0));
    says("fanuc", &fanuc("G1 X100000."), "more digits than the control takes");
    says("haas", &fanuc("G93 G1 X1. F10000."), "the control takes 9999");
}

#[test]
fn lines_and_comments() {
    let long = fanuc(&format!("({})", "A".repeat(250)));
    says("mazak", &long, "the control takes 248");
    assert!(said("haas", &long).is_empty());
    says("marlin", &marlin(&format!("; {}", "a".repeat(100))), "the control takes 96");
    says("haas", &fanuc("(lower)"), "character set has no 'l'");
    assert!(said("centroid", &fanuc("(lower)\n; also")).is_empty());
    says("marlin", &marlin("(what)"), "bad character '('");
}

#[test]
fn codes_that_only_some_know() {
    says("haas", &fanuc("G6.2 P4 K0. X10. Y0."), "unknown code G6.2");
    says("mazak", &fanuc("G6.2 P4 K0. X10. Y0."), "unknown code G6.2");
    says("okuma", "OA1\nG15 H1\nG54\nM30\n", "unknown code G54");
    says("okuma", "OTOOLONG\nG15 H1\nM30\n", "does not start with its name");
    says("mach3", &linuxcnc("G5.2 P1 L3"), "unknown code G5.2");
    says("marlin", &marlin("M30"), "unknown code M30");
    says("marlin", &marlin("G94"), "unknown code G94");
    says("marlin", &marlin("X1"), "not every build");
    says("marlin", &marlin("G81 X1 Z-1 R1"), "unknown code G81");
    says("grblhal", &grbl("G84 X1 Z-1 R1"), "unknown code G84");
    assert!(said("haas", &fanuc("G154 P5\nG0 Z5.\nG0 X1. Y1.\nG187 P2 E0.01\nG1 X2.")).is_empty());
    assert!(said("mazak", &fanuc("G61.1\nG5 P2\nG1 X2.")).is_empty());
}

#[test]
fn work_offsets_must_be_selected() {
    let bare = |text: String| text.replace("G54", "");
    says("linuxcnc", &bare(linuxcnc("G1 X1")), "no work offset");
    let text = fanuc("G1 X1.");
    assert_eq!(clean("fanuc", &text).last().and_then(|m| m.work_offset), Some(1));
    let moves = clean("haas", &fanuc("G154 P5\nG0 X1. Y1. Z1.\nG1 X2."));
    assert_eq!(moves.last().and_then(|m| m.work_offset), Some(11));
    let moves = clean("centroid", &fanuc("G55\nG0 X1. Y1. Z1.\nG1 X2."));
    assert_eq!(moves.last().and_then(|m| m.work_offset), Some(2));
}

#[test]
fn coolant_is_in_the_trace() {
    let washing =
        |body: &str| clean("linuxcnc", &linuxcnc(body)).last().map(|m| (m.coolant.flood, m.coolant.mist));
    assert_eq!(washing("G1 X1"), Some((false, false)));
    assert_eq!(washing("M8\nG1 X1"), Some((true, false)));
    assert_eq!(washing("M7\nM8\nG1 X1"), Some((true, true)));
    assert_eq!(washing("M7\nM9\nG1 X1"), Some((false, false)));
}

#[test]
fn checksums_of_marlin() {
    let sum = |line: &str| format!("{line}*{}", line.bytes().fold(0, |a, b| a ^ b));
    assert!(said("marlin", &marlin(&sum("N10 G1 X5"))).is_empty());
    says("marlin", &marlin("N10 G1 X5*1"), "checksum mismatch");
    says("marlin", &marlin(&sum("G1 X5")), "without a line number");
}

#[test]
fn half_circles_by_radius_are_not_trusted() {
    says("fanuc", &fanuc("G2 X0. Y0. R5."), "nearly half a turn");
    assert!(!said("linuxcnc", &linuxcnc("G2 X0 Y0 R5")).iter().any(|m| m.contains("half a turn")));
}

#[test]
fn further_work_offsets() {
    let selected = |control: &str, text: &str| {
        let last = moves(trace(control, text)).pop().and_then(|m| m.work_offset);
        (last, said(control, text))
    };
    for (control, code, number) in [
        ("fanuc", "G54.1 P48", 54),
        ("haas", "G154 P99", 105),
        ("centroid", "E18", 18),
        ("centroid", "G55", 2),
    ] {
        let text = fanuc(&format!("{code}\nG0 X1. Y1. Z5.")).replace("G64 ", "");
        let (offset, complaints) = selected(control, &text);
        assert_eq!(offset, Some(number), "{control} {code}: {complaints:?}");
    }
    says("fanuc", &fanuc("G54.1 P49"), "not one from 1 to 48");
    says("haas", &fanuc("G154 P100"), "not one from 1 to 99");
    says("centroid", &fanuc("E19"), "not one from 1 to 18");
    says("fanuc", &fanuc("G54.1"), "without its number");
}

#[test]
fn moves_across_from_the_upper_end_of_z_are_told_from_those_at_an_unknown_height() {
    let first = |body: &str| moves(trace("fanuc", &fanuc(body))).pop().expect("a move");
    let parked = first("G91 G28 Z0.\nG90 G0 X5.");
    assert!(parked.parked && !parked.known[2]);
    assert!(!first("G91 G28 X0.\nG90 G0 Y5.").parked);
    assert!(!first("G91 G28 Z0.\nG90 G0 Z5.").parked);
    assert!(!first("G91 G28 Z0.\nG90 G0 Z5.\nX5.").parked);
}
