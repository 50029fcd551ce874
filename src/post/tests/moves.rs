//! Motion: numbers, modality, arcs, feeds.

use super::build::{Sheet, builtin};
use crate::ir::Spindle;
use crate::target::{BlockKind, FeedWord, Nurbs, Position, axes};
use crate::units::LengthUnit;

#[test]
fn words_are_printed_when_their_printed_number_changes() {
    let sheet = Sheet::at("fanuc", 0, 0).line(1000, 0).line(1000, 0).line(1000, 2500).line(-1, 2500);
    assert_eq!(sheet.rest(), ["G1 X1. F300.", "Y2.5", "X-0.001"]);
}

#[test]
fn a_point_is_forced_on_fanuc_and_never_on_integers() {
    let sheet = Sheet::at("fanuc", 0, 0).event(BlockKind::Spindle(Spindle::on(1200.0, false)));
    assert_eq!(sheet.rest(), ["S1200 M4"]);
    assert_eq!(Sheet::at("linuxcnc", 0, 0).line(10_000, 5).rest(), ["G1 X1 Y0.0005 F300"]);
    assert_eq!(Sheet::at("grbl", 0, 0).line(1_000, 5).rest(), ["G1 X1 Y0.005 F300"]);
}

#[test]
fn inch_programs_have_their_own_decimals() {
    let sheet = Sheet::new(builtin("fanuc"), LengthUnit::Inch, None).rapid(12_500, -5, 0, axes::X | axes::Y);
    assert_eq!(sheet.body(), ["G0 X1.25 Y-0.0005"]);
}

#[test]
fn full_circles_have_the_end_words_that_the_control_wants() {
    let circle = |name: &str| {
        let scale = if name == "linuxcnc" { 10 } else { 1 };
        Sheet::at(name, 1000 * scale, 0).arc(1000 * scale, 0, [-1000 * scale, 0], true).rest()
    };
    assert_eq!(circle("linuxcnc"), ["G2 I-1 J0 F300"]);
    assert_eq!(circle("fanuc"), ["G2 I-1. J0. F300."]);
    assert_eq!(circle("grbl"), ["G2 X1 I-1 J0 F300"]);
}

#[test]
fn centre_words_are_never_left_out_and_end_words_are_modal() {
    let sheet = Sheet::at("grbl", 0, 0).arc(2000, 0, [1000, 0], true).arc(4000, 0, [1000, 0], true);
    assert_eq!(sheet.rest(), ["G2 X2 I1 J0 F300", "X4 I1 J0"]);
}

#[test]
fn a_helix_prints_z() {
    let mut sheet = Sheet::at("fanuc", 0, 0).arc(2000, 0, [1000, 0], false);
    if let Some(BlockKind::Motion(crate::target::Motion::Arc { to, .. })) =
        sheet.program.blocks.last_mut().map(|b| &mut b.kind)
    {
        to.z = -500;
    }
    assert_eq!(sheet.rest(), ["G3 X2. Z-0.5 I1. J0. F300."]);
}

#[test]
fn feed_is_said_again_after_a_mode_change_and_always_in_inverse_time() {
    let per_revolution = FeedWord::PerRevolution(100);
    let sheet = Sheet::at("fanuc", 0, 0)
        .line(1000, 0)
        .line_at(2000, 0, 0, 0, per_revolution)
        .line_at(3000, 0, 0, 0, per_revolution)
        .line(4000, 0);
    let rest = sheet.rest();
    assert_eq!(rest[rest.len() - 4..], ["G1 X1. F300.", "G95 X2. F0.1", "X3.", "G94 X4. F300."]);
    let inverse = FeedWord::InverseTime(25_000);
    let sheet = Sheet::new(builtin("linuxcnc"), LengthUnit::Millimetre, Some('C'))
        .rapid(0, 0, 0, 15)
        .line_at(10_000, 0, 0, 900_000, inverse)
        .line_at(20_000, 0, 0, 1_800_000, inverse)
        .line_at(30_000, 0, 0, 1_800_000, FeedWord::PerMinute(3_000));
    assert_eq!(sheet.rest(), ["G93 G1 X1 C90 F2.5", "X2 C180 F2.5", "G94 X3 F300"]);
}

#[test]
fn feed_motion_code_and_positions_are_said_again_after_a_tool_change() {
    let sheet = Sheet::at("linuxcnc", 0, 0)
        .line(10_000, 0)
        .event(BlockKind::ToolChange(0))
        .line(20_000, 0)
        .line(30_000, 0);
    let rest = sheet.rest();
    assert_eq!(rest[rest.len() - 2..], ["G1 X2 Y0 Z0 F300", "X3"]);
}

#[test]
fn length_compensation_goes_with_the_first_z_move_where_it_would_move_alone() {
    let sheet = Sheet::mm("fanuc").event(BlockKind::ToolChange(0)).rapid(0, 0, 5_000, axes::X | axes::Y);
    let body = sheet.rapid(0, 0, 5_000, axes::Z).line_z(1_000).body();
    assert_eq!(body[body.len() - 3..], ["G0 X0. Y0.", "G43 H1 Z5.", "G1 Z1. F300."]);
}

#[test]
fn inserted_text_is_verbatim_and_everything_is_said_again_after_it() {
    let sheet =
        Sheet::at("linuxcnc", 0, 0).line(10_000, 0).event(BlockKind::Insert("G10 L2 P1 X0 (as is %)".into()));
    let sheet = sheet.line(10_000, 10_000);
    assert_eq!(sheet.rest(), ["G1 X1 F300", "G10 L2 P1 X0 (as is %)", "G94 G1 X1 Y1 Z0 F300"]);
    for bad in ["G0 X1\nM30", "G0\rX1", "G0 \u{0}", "G0 ä"] {
        let sheet = Sheet::at("linuxcnc", 0, 0).event(BlockKind::Insert(bad.into()));
        assert_eq!(sheet.codes(), ["E0711"], "{bad:?}");
    }
}

#[test]
fn axes_that_do_not_move_are_not_printed() {
    let sheet = Sheet::mm("grbl").rapid(0, 0, 5_000, axes::Z).rapid(1000, 0, 5_000, axes::X | axes::Y);
    assert_eq!(sheet.body(), ["G0 Z5", "X1 Y0"]);
}

#[test]
fn the_rotary_axis_has_the_letter_of_the_machine() {
    let sheet = Sheet::new(builtin("fanuc"), LengthUnit::Millimetre, Some('B')).rapid(0, 0, 0, 15).line_at(
        1000,
        0,
        0,
        45_500,
        FeedWord::PerMinute(1_000),
    );
    assert_eq!(sheet.rest(), ["G1 X1. B45.5 F100."]);
    let grbl = builtin("grbl");
    let sheet = Sheet::mm("grbl");
    let machine = crate::ir::Machine {
        post: "grbl".into(),
        rotary: Some(crate::ir::Rotary { letter: None, reversed: false }),
        options: Vec::new(),
        origin: sheet.program.blocks.first().map_or_else(|| sheet.program.tools[0].origin, |b| b.origin),
    };
    assert_eq!(grbl.capabilities(LengthUnit::Millimetre, Some(&machine)).unwrap_err().code.id, "E0713");
}

#[test]
fn a_line_longer_than_the_control_takes_is_refused_and_comments_do_not_count_on_grbl() {
    let long = "G1 X1 Y2 Z3 ".repeat(20);
    let sheet = Sheet::at("linuxcnc", 0, 0).event(BlockKind::Insert(long.clone() + &long));
    assert_eq!(sheet.codes(), ["E0710"]);
    let commented = format!("G1 X1 ({})", "a".repeat(90));
    assert_eq!(Sheet::at("grbl", 0, 0).event(BlockKind::Insert(commented)).codes(), [""; 0]);
    assert_eq!(Sheet::at("grbl", 0, 0).event(BlockKind::Insert(long)).codes(), ["E0710"]);
}

#[test]
fn nurbs_are_spelled_as_the_control_wants() {
    let p = |x: i64, y: i64| Position { x, y, z: 0, r: 0 };
    let nurbs = |scale: i64| Nurbs {
        order: 4,
        points: vec![(p(0, 0), 1.0), (p(scale, 0), 1.0), (p(scale, scale), 0.5), (p(0, scale), 1.0)],
        knots: vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0],
        finer: 0,
    };
    let linuxcnc = Sheet::at("linuxcnc", 0, 0).nurbs(nurbs(10_000)).line(20_000, 10_000);
    assert_eq!(linuxcnc.rest(), ["G5.2 P1 L4 F300", "X1 Y0 P1", "X1 Y1 P0.5", "X0 Y1 P1", "G5.3", "G1 X2"]);
    let fanuc = Sheet::at("fanuc", 0, 0).nurbs(nurbs(1_000)).line(2_000, 1_000);
    assert_eq!(
        fanuc.rest(),
        [
            "G6.2 P4 K0. X0. Y0. Z0. R1. F300.",
            "K0. X1. Y0. R1.",
            "K0. X1. Y1. R0.5",
            "K0. X0. Y1. R1.",
            "K1.",
            "K1.",
            "K1.",
            "K1.",
            "G1 X2."
        ]
    );
    let sinumerik = Sheet::at("sinumerik", 0, 0).nurbs(nurbs(1_000)).nurbs(back(1_000)).line(2_000, 1_000);
    let [first, second, third, fourth] = ["BSPLINE SD=3 F300", "X1 Y0 PW=1", "X1 Y1 PW=0.5", "X0 Y1 PW=1"];
    let again = ["G1", "BSPLINE SD=3", "X1 Y1 PW=1", "X1 Y0 PW=1", "X0 Y0 PW=1", "G1 X2 Y1"];
    assert_eq!(sinumerik.rest(), [&[first, second, third, fourth][..], &again].concat());
}

/// From (0, 1) back to (0, 0).
fn back(scale: i64) -> Nurbs {
    let p = |x: i64, y: i64| (Position { x: x * scale, y: y * scale, z: 0, r: 0 }, 1.0);
    let knots = vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
    Nurbs { order: 4, points: vec![p(0, 1), p(1, 1), p(1, 0), p(0, 0)], knots, finer: 0 }
}

#[test]
fn curves_that_climb_say_their_heights() {
    let p = |x: i64, z: i64| (Position { x, y: 0, z, r: 0 }, 1.0);
    let knots = vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
    let climb = Nurbs {
        order: 4,
        points: vec![p(0, 0), p(1_000, 0), p(2_000, 500), p(3_000, 1_000)],
        knots,
        finer: 0,
    };
    let fanuc = Sheet::at("fanuc", 0, 0).nurbs(climb.clone()).line(0, 0);
    let points = [
        "G6.2 P4 K0. X0. Y0. Z0. R1. F300.",
        "K0. X1. Y0. Z0. R1.",
        "K0. X2. Y0. Z0.5 R1.",
        "K0. X3. Y0. Z1. R1.",
    ];
    assert_eq!(fanuc.rest()[..4], points);
    // The line after it goes on at the curve's height.
    assert_eq!(fanuc.rest().last().map(String::as_str), Some("G1 X0."));
    let sinumerik = Sheet::at("sinumerik", 0, 0).nurbs(climb);
    assert_eq!(sinumerik.rest()[1..], ["X1 Y0 Z0 PW=1", "X2 Y0 Z0.5 PW=1", "X3 Y0 Z1 PW=1"]);
}

/// From (0, 0) to (4, 0) by (1, 2) and (3, 2.000007), inner points five decimals fine, falling by `fall`; the grid has three.
fn piece(fall: i64, scale: i64) -> Nurbs {
    let p = |x: i64, y: i64, z: i64| (Position { x: x * scale, y: y * scale, z, r: 0 }, 1.0);
    let mut points = vec![p(0, 0, 0), p(1, 2, 0), p(3, 2, -fall), p(4, 0, -fall)];
    points[2].0.y += 7 * scale / 1_000_000;
    Nurbs { order: 4, points, knots: vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0], finer: 3 }
}

#[test]
fn pieces_say_their_end_and_their_coefficients() {
    let poly = Sheet::at("sinumerik_poly", 0, 0).nurbs(piece(0, 1_000_000)).line(5_000, 0);
    assert_eq!(
        poly.rest(),
        ["POLY PO[X]=(4,3,-2) PO[Y]=(0,-5.999979,-0.000021) PO[Z]=(0,0,0) F300", "G1 X5"]
    );
    let falls = Sheet::at("sinumerik_poly", 0, 0).nurbs(piece(500_000, 1_000_000)).line(5_000, 0);
    assert_eq!(falls.rest()[0], "POLY PO[X]=(4,3,-2) PO[Y]=(0,-5.999979,-0.000021) PO[Z]=(-0.5,-1.5,1) F300");
    let g5 = Sheet::at("linuxcnc_g5", 0, 0).nurbs(Nurbs { finer: 2, ..piece(0, 1_000_000) }).line(50_000, 0);
    assert_eq!(g5.rest(), ["G5 X4 Y0 I1 J2 P-1 Q2.000007 F300", "G1 X5"]);
}

#[test]
fn splines_of_heidenhain_run_back_from_their_end() {
    let spl = Sheet::at("itnc530", 0, 0).nurbs(Nurbs { finer: 2, ..piece(50_000, 100_000) }).line(5_000, 0);
    let lines = spl.rest();
    let [first, x, y, z, after] = lines.as_slice() else { panic!("{lines:?}") };
    assert!(first.ends_with("SPL X+4 Y+0 Z-0.5 ~"), "{first}");
    assert_eq!(x, "K3X+2 K2X-3 K1X-3 ~");
    assert_eq!(y, "K3Y+0 K2Y-6 K1Y+6 ~");
    assert_eq!(z, "K3Z-1 K2Z+1.5 K1Z+0 F300");
    assert!(after.ends_with("L X+5 Y+0 R0") || after.ends_with("L X+5 R0"), "{after}");
    // A coefficient of ten and more has an exponent.
    let far = Sheet::at("itnc530", 0, 0).nurbs(Nurbs { finer: 2, ..piece(0, 10_000_000) });
    assert_eq!(far.rest()[1], "K3X+2E+2 K2X-3E+2 K1X-3E+2 ~");
}
