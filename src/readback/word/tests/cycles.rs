//! Drilling cycles as the moves they make.

use super::*;

/// Legs as text: `R x y z` at rapid, `F x y z` at feed, `D s` a dwell; the start-up moves left out.
fn legs(control: &str, text: &str, skip: usize) -> Vec<String> {
    let trace = trace(control, text);
    assert_eq!((&trace.faults[..], &trace.assumed[..]), (&[][..], &[][..]), "{control}: {text}");
    let leg = |e: TraceEvent| match e.kind {
        EventKind::Move(m) => {
            let p = m.end();
            Some(format!("{} {} {} {}", if m.rapid { 'R' } else { 'F' }, p.x, p.y, (p.z * 1e6).round() / 1e6))
        }
        EventKind::Dwell(s) => Some(format!("D {s}")),
        _ => None,
    };
    trace.events.into_iter().filter_map(leg).skip(skip).collect()
}

#[test]
fn drilling_goes_by_r_and_returns_as_g98_and_g99_say() {
    let wanted = [
        "R 1 2 5", "R 1 2 2", "F 1 2 -3", "R 1 2 2", "R 4 2 2", "F 4 2 -3", "R 4 2 2", "R 4 6 2", "F 4 6 -3",
        "R 4 6 5",
    ];
    assert_eq!(legs("linuxcnc", &linuxcnc("G99 G81 X1 Y2 Z-3 R2\nX4\nG98 Y6\nG80"), 2), wanted);
    assert_eq!(legs("fanuc", &fanuc("G99 G81 X1. Y2. Z-3. R2.\nX4.\nG98 Y6.\nG80"), 1), wanted);
    assert_eq!(legs("haas", &fanuc("G99 G81 X1. Y2. Z-3. R2.\nX4.\nG98 Y6.\nG80"), 1), wanted);
    assert_eq!(legs("grblhal", &grbl("G99 G81 X1 Y2 Z-3 R2\nX4\nG98 Y6\nG80"), 1), wanted);
}

#[test]
fn a_motion_code_ends_a_cycle() {
    let body = "G98 G81 X1. Y2. Z-3. R2.\nG0 X9.\nG80";
    assert_eq!(legs("fanuc", &fanuc(body), 1)[4], "R 9 2 5");
}

#[test]
fn the_end_of_cycles_may_share_a_block_with_a_motion() {
    let body = "G98 G81 X1. Y2. Z-3. R2.\nG90 G80 G0 X9.";
    for control in ["fanuc", "haas", "linuxcnc"] {
        let (text, skip) = if control == "linuxcnc" { (linuxcnc(body), 2) } else { (fanuc(body), 1) };
        assert_eq!(legs(control, &text, skip)[4], "R 9 2 5", "{control}");
    }
    // Grbl counts G80 among the motions.
    let faults = trace("grbl", &grbl("G80 G0 X9")).faults;
    assert!(faults.iter().any(|f| f.message.contains("two codes of one modal group")), "{faults:?}");
    let faults = trace("fanuc", &fanuc("G80 G98 G81 X1. Y2. Z-3. R2.")).faults;
    assert!(faults.iter().any(|f| f.message.contains("G80 and a drilling cycle")), "{faults:?}");
}

#[test]
fn a_forgotten_cancel_drills_again() {
    let body = "G98 G81 X1. Y2. Z-3. R2.\nX9.\nG80";
    assert_eq!(legs("fanuc", &fanuc(body), 1)[4..], ["R 9 2 5", "R 9 2 2", "F 9 2 -3", "R 9 2 5"]);
}

#[test]
fn pecks_leave_the_hole_or_break_the_chip() {
    let deep = [
        "R 1 2 5",
        "R 1 2 2",
        "F 1 2 -1",
        "R 1 2 2",
        "R 1 2 -0.5",
        "F 1 2 -4",
        "R 1 2 2",
        "R 1 2 -3.5",
        "F 1 2 -5",
        "R 1 2 5",
    ];
    assert_eq!(legs("fanuc", &fanuc("G98 G83 X1. Y2. Z-5. R2. Q3.\nG80"), 1), deep);
    let chip =
        ["R 1 2 5", "R 1 2 2", "F 1 2 -1", "R 1 2 -0.5", "F 1 2 -4", "R 1 2 -3.5", "F 1 2 -5", "R 1 2 5"];
    assert_eq!(legs("fanuc", &fanuc("G98 G73 X1. Y2. Z-5. R2. Q3.\nG80"), 1), chip);
    let chip = chip.map(|l| l.replace("-0.5", "-0.746").replace("-3.5", "-3.746"));
    assert_eq!(legs("linuxcnc", &linuxcnc("G98 G73 X1 Y2 Z-5 R2 Q3\nG80"), 2), chip);
    assert_eq!(
        legs("mach3", &mach("G98 G73 X1 Y2 Z-5 R2 Q7\nG80"), 2),
        ["R 1 2 5", "R 1 2 2", "F 1 2 -5", "R 1 2 5"]
    );
}

fn mach(body: &str) -> String {
    linuxcnc(body).replace("G17", "G91.1 G17")
}

#[test]
fn dwells_count_as_each_control_counts_them() {
    let with = |p: &str| format!("G99 G82 X1. Y2. Z-3. R2. P{p}\nG80");
    let dwell =
        |control: &str, text: &str, skip| legs(control, text, skip).into_iter().find(|l| l.starts_with('D'));
    assert_eq!(dwell("fanuc", &fanuc(&with("1500")), 0), Some("D 1.5".to_owned()));
    assert_eq!(dwell("haas", &fanuc(&with("1500")), 0), Some("D 1.5".to_owned()));
    assert_eq!(dwell("haas", &fanuc(&with("1.5")), 0), Some("D 1.5".to_owned()));
    assert_eq!(dwell("linuxcnc", &linuxcnc(&with("1.5")), 0), Some("D 1.5".to_owned()));
    assert_eq!(dwell("mach3", &mach(&with("1.5")), 0), Some("D 1.5".to_owned()));
    assert_eq!(dwell("mach3-ms", &mach(&with("1500")), 0), Some("D 1.5".to_owned()));
}

#[test]
fn taps_turn_back_and_bores_come_out_at_feed() {
    let moves = clean("fanuc", &fanuc("G99 G84 X1. Y2. Z-3. R2. F1000.\nG80"));
    let spindles: Vec<f64> = moves.iter().skip(3).map(|m| m.spindle).collect();
    assert_eq!(spindles, [1000.0, -1000.0]);
    assert!(moves.iter().skip(3).all(|m| !m.rapid && m.in_cycle && m.feed == Some(1000.0)));
    assert_eq!(legs("fanuc", &fanuc("G98 G85 X1. Y2. Z-3. R2.\nG80"), 3), ["F 1 2 -3", "F 1 2 2", "R 1 2 5"]);
    let moves = clean("fanuc", &fanuc("G98 G86 X1. Y2. Z-3. R2.\nG80\nG1 X3."));
    assert_eq!(moves.iter().skip(3).map(|m| m.spindle).collect::<Vec<_>>(), [1000.0, 0.0, 1000.0]);
}

#[test]
fn increments_and_repeats_make_a_row() {
    let body = "G91 G99 G81 X1. Y0. Z-5. R-3. K2\nG80\nG90";
    let wanted = ["R 11 0 5", "R 11 0 2", "F 11 0 -3", "R 11 0 2", "R 12 0 2", "F 12 0 -3", "R 12 0 2"];
    assert_eq!(legs("fanuc", &fanuc(body), 1), wanted);
    assert_eq!(legs("linuxcnc", &linuxcnc(&body.replace("K2", "L2")), 2), wanted);
}

#[test]
fn okuma_returns_to_the_height_of_g71() {
    let text = okuma("G71 Z8.\nG81 X1. Y2. Z-3. R2. F100. M53\nX4.\nX6. M54\nG0 Z20.");
    let wanted = ["R 1 2 5", "R 1 2 2", "F 1 2 -3", "R 1 2 8", "R 4 2 8", "R 4 2 2", "F 4 2 -3", "R 4 2 8"];
    assert_eq!(legs("okuma", &text, 1)[..8], wanted);
    assert_eq!(legs("okuma", &text, 1).last().map(String::as_str), Some("R 6 2 20"));
}

fn okuma(body: &str) -> String {
    format!("OPART\nG15 H1\nG17 G21 G40 G90 G94\nT1 M6\nG56 H1\nG0 X10. Y0. Z5.\nS1000 M3\n{body}\nM30\n")
        .replace("OPART", "OP1")
}

#[test]
fn the_traps_of_cycles_are_faults() {
    for (body, words) in [
        ("G81 X1. Z-3. R-4.", "R-4 is below the bottom Z-3"),
        ("G81 X1. Z-3.", "without R"),
        ("G81 X1. R1.", "without Z"),
        ("G83 X1. Z-3. R1.", "without Q"),
        ("G83 X1. Z-3. R1. Q0.", "a peck of Q0"),
        ("G83 X1. Z-300. R1. Q0.001", "a peck of Q0.001"),
        ("G81 X1. Z-3. R1. P500", "P500"),
        ("G81 X1. Z-3. R8.", "is below R8"),
        ("G18 G81 X1. Z-3. R1.", "outside the XY plane"),
        ("G81 X1. C5. Z-3. R1.", "rotary axis in a drilling cycle"),
        ("G84 X1. Z-3. R1. M4", "G84 with the spindle not at M3"),
        ("G93 G81 X1. Z-3. R1. F10.", "cycle under G93"),
        ("M5\nG95 G81 X1. Z-3. R1. F0.1", "spindle standing"),
        ("G81 X1. Z-3. R1. K1.5", "not a number of repeats"),
        ("G87 X1. Z-3. R1. Q1.", "G87 is not followed"),
    ] {
        let got = trace("fanuc", &fanuc(&format!("G98\n{body}"))).faults;
        assert!(got.iter().any(|f| f.message.contains(words)), "{body}: {got:?}");
    }
    let got = trace("linuxcnc", &linuxcnc("G98 G81 X1 Z-3 R1\nG81 R2")).faults;
    assert!(got.iter().any(|f| f.message.contains("without X, Y or Z")), "{got:?}");
    let got = trace("okuma", &okuma("G81 X1. Z-3. R2. F100.")).faults;
    assert!(got.iter().any(|f| f.message.contains("without M53 or M54")), "{got:?}");
    let got = trace("grbl", &grbl("G98")).faults;
    assert!(got.iter().any(|f| f.message.contains("unknown code G98")), "{got:?}");
    let assumed = trace("fanuc", &fanuc("G81 X1. Z-3. R1.")).assumed;
    assert!(assumed.iter().any(|f| f.message.contains("neither G98 nor G99")), "{assumed:?}");
}
