//! Definitions of geometry, with values that were worked out by hand.

use super::*;
use crate::source::MemoryFiles;

/// Names that the cases use.
const GIVEN: &str = "\
A = POINT/ 2, 3
B = POINT/ 6, 3
H = LINE/ 0, 0, 10, 0
V = LINE/ 0, 0, 0, 10
D = LINE/ 0, 0, 10, 10
K5 = CIRCLE/ 0, 0, 5
K2 = CIRCLE/ 10, 0, 2
E1 = VECTOR/ 1, 0, 0
E2 = VECTOR/ 0, 3, 0
X5 = PLANE/ 1, 0, 0, 5
Y2 = PLANE/ 0, 2, 0, 4
Z1 = PLANE/ 0, 0, 1, 1
ROW = PATERN/ LINEAR, (0, 0), (8, 0), 5
R90 = MATRIX/ XYROT, 90
SHIFT = MATRIX/ TRANSL, 10, 20, 30
RESERV/ P, 4, N, 4
P(1) = POINT/ 0, 0
P(2) = POINT/ 1, 10
P(3) = POINT/ 2, 20
P(4) = POINT/ 3, 30
N(1) = 1
N(2) = 2
N(3) = 7
N(4) = 5
";

/// The points that the moves of `statements` go to.
fn points(statements: &str) -> Vec<[f64; 3]> {
    let text = format!("{GIVEN}CUTTER/ 4\nSPINDL/ 1000\nFEDRAT/ 100\nFROM/ 0, 0, 50\n{statements}\nFINI\n");
    let mut sources = SourceMap::default();
    let main = sources.add("main.apt", text.as_str());
    let mut sink = Sink::default();
    let files = MemoryFiles::default();
    let program = analyse(main, &mut sources, &files, &Options::default(), &mut sink);
    let problems: Vec<String> = sink.into_items().into_iter().map(|d| d.message).collect();
    let program = program.unwrap_or_else(|| panic!("{statements}\n{problems:#?}"));
    let moves = program.steps.iter().filter_map(|s| match s.kind {
        ir::StepKind::Goto { to, .. } => Some([to.x, to.y, to.z]),
        _ => None,
    });
    moves.collect()
}

fn check(cases: &[(&str, [f64; 3])]) {
    for (statements, wanted) in cases {
        let found = points(statements);
        let [p] = found.as_slice() else { panic!("{statements}: {found:?}") };
        let off = p.iter().zip(wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-9, "{statements}: {p:?}, not {wanted:?}");
    }
}

const ROOT2: f64 = core::f64::consts::SQRT_2;

#[test]
fn points_are_where_their_definitions_say() {
    check(&[
        ("GOTO/ (POINT/ CANON, 1, 2, 3)", [1.0, 2.0, 3.0]),
        ("GOTO/ (POINT/ INTOF, X5, Y2, Z1)", [5.0, 2.0, 1.0]),
        ("GOTO/ (POINT/ INTOF, Z1, X5, Y2)", [5.0, 2.0, 1.0]),
        ("GOTO/ (POINT/ RTHETA, YZPLAN, 4, 30)", [0.0, 4.0 * 3f64.sqrt() / 2.0, 2.0]),
        ("GOTO/ (POINT/ THETAR, ZXPLAN, 90, 4)", [4.0, 0.0, 0.0]),
        ("GOTO/ (POINT/ ROW, 4)", [6.0, 0.0, 0.0]),
        ("GOTO/ (POINT/ K5, ATANGL, 90)", [0.0, 5.0, 0.0]),
    ]);
}

#[test]
fn lines_meet_the_axes_where_their_definitions_say() {
    let meet = |line: &str, other: &str| format!("L = LINE/ {line}\nGOTO/ (POINT/ INTOF, L, {other})");
    let cases: &[(&str, &str, [f64; 3])] = &[
        ("A, SLOPE, 2", "H", [0.5, 0.0, 0.0]),
        ("SLOPE, 2, INTERC, 4", "V", [0.0, 4.0, 0.0]),
        ("SLOPE, 2, INTERC, XAXIS, 4", "V", [0.0, -8.0, 0.0]),
        ("ATANGL, 45, INTERC, 1", "H", [-1.0, 0.0, 0.0]),
        ("ATANGL, 45, INTERC, XAXIS, 1", "V", [0.0, -1.0, 0.0]),
        ("ATANGL, 135, INTERC, YAXIS, 1", "H", [1.0, 0.0, 0.0]),
        ("A, ATANGL, 45, XAXIS", "H", [-1.0, 0.0, 0.0]),
        ("A, ATANGL, -45, YAXIS", "H", [-1.0, 0.0, 0.0]),
        ("XAXIS, 4", "V", [0.0, 4.0, 0.0]),
        ("YAXIS, 4", "H", [4.0, 0.0, 0.0]),
        ("INTOF, X5, Z1", "H", [5.0, 0.0, 0.0]),
        ("INTOF, Z1, (PLANE/ 0, 1, 1, 5)", "V", [0.0, 4.0, 0.0]),
        ("CANON, 3, 4, 0, 12", "H", [4.0, 0.0, 0.0]),
        ("0, 7, -3, 10, 7, 8", "V", [0.0, 7.0, 0.0]),
    ];
    for (line, other, wanted) in cases {
        check(&[(&meet(line, other), *wanted)]);
    }
    // The canonical form runs with its normal on the right: x = 5 runs up.
    check(&[("L = LINE/ CANON, 2, 0, 0, 10\nGOTO/ L.ANGLE / 1deg, 0, 0", [90.0, 0.0, 0.0])]);
}

#[test]
fn circles_touch_what_their_definitions_say() {
    // In every case: centre x, centre y, radius.
    let circle = |definition: &str| format!("K = CIRCLE/ {definition}\nGOTO/ K.X, K.Y, K.RADIUS");
    let cases: &[(&str, [f64; 3])] = &[
        ("CANON, 1, 2, 0, 0, 0, 1, 4", [1.0, 2.0, 4.0]),
        // Right triangle with legs 6 and 8 on the axes: its inscribed circle has radius 2.
        ("XLARGE, V, YLARGE, H, XSMALL, (LINE/ 8, 0, 0, 6)", [2.0, 2.0, 2.0]),
        // A lies 3 above H: centres 2 above it, 2 from A, so 1 below it and √3 to the side.
        ("TANTO, H, XSMALL, A, RADIUS, 2", [2.0 - 3f64.sqrt(), 2.0, 2.0]),
        ("TANTO, H, XLARGE, A, RADIUS, 2", [2.0 + 3f64.sqrt(), 2.0, 2.0]),
        ("TANTO, (LINE/ 10, 0, 0, 0), XLARGE, A, RADIUS, 2", [2.0 + 3f64.sqrt(), 2.0, 2.0]),
        // Centre 3 above H and 8 from the origin, or 2 inside the circle of 5.
        ("YLARGE, H, XSMALL, OUT, K5, RADIUS, 3", [-(55f64.sqrt()), 3.0, 3.0]),
        ("YLARGE, H, XLARGE, OUT, K5, RADIUS, 3", [55f64.sqrt(), 3.0, 3.0]),
        ("YLARGE, H, XLARGE, IN, K5, RADIUS, 1", [15f64.sqrt(), 1.0, 1.0]),
        // Distances 8 and 5 from centres 10 apart: x = (64 - 25 + 100) / 20.
        ("YLARGE, OUT, K5, OUT, K2, RADIUS, 3", [6.95, (64.0 - 6.95f64 * 6.95).sqrt(), 3.0]),
        ("YSMALL, OUT, K5, OUT, K2, RADIUS, 3", [6.95, -(64.0 - 6.95f64 * 6.95).sqrt(), 3.0]),
        // Around both: distances 20 - 5 and 20 - 2: x = (225 - 324 + 100) / 20.
        ("YLARGE, IN, K5, IN, K2, RADIUS, 20", [0.05, (225.0 - 0.0025f64).sqrt(), 20.0]),
        ("YLARGE, A, B, RADIUS, 2.5", [4.0, 4.5, 2.5]),
        ("YSMALL, A, B, RADIUS, 2.5", [4.0, 1.5, 2.5]),
        ("XLARGE, A, B, RADIUS, 2", [4.0, 3.0, 2.0]),
    ];
    for (definition, wanted) in cases {
        check(&[(&circle(definition), *wanted)]);
    }
}

#[test]
fn planes_have_the_normals_their_definitions_say() {
    let plane = |definition: &str| {
        format!("Q = PLANE/ {definition}\nGOTO/ Q.NORMAL.X, Q.NORMAL.Y, Q.NORMAL.Z\nGOTO/ Q.DISTANCE, 0, 0")
    };
    let cases: &[(&str, [f64; 3], f64)] = &[
        ("0, 0, 2, 8", [0.0, 0.0, 1.0], 4.0),
        ("CANON, 3, 4, 0, 10", [0.6, 0.8, 0.0], 2.0),
        ("(1, 0, 2), (5, 0, 2), (1, 4, 2)", [0.0, 0.0, 1.0], 2.0),
        ("(1, 1, 9), PARLEL, Z1", [0.0, 0.0, 1.0], 9.0),
        ("PARLEL, Z1, ZLARGE, 3", [0.0, 0.0, 1.0], 4.0),
        ("PARLEL, X5, XSMALL, 3", [1.0, 0.0, 0.0], 2.0),
        ("(3, 4, 5), PERPTO, E2", [0.0, 1.0, 0.0], 4.0),
        ("(3, 4, 5), PERPTO, X5, Y2", [0.0, 0.0, 1.0], 5.0),
        ("(0, 4, 0), (9, 4, 0), PERPTO, Z1", [0.0, -1.0, 0.0], -4.0),
        ("YZPLAN", [1.0, 0.0, 0.0], 0.0),
        ("XYPLAN, 7", [0.0, 0.0, 1.0], 7.0),
    ];
    for (definition, normal, distance) in cases {
        assert_eq!(points(&plane(definition)), [*normal, [*distance, 0.0, 0.0]], "{definition}");
    }
}

#[test]
fn matrices_move_points_as_their_definitions_say() {
    let moved = |definition: &str| format!("M = MATRIX/ {definition}\nTRACUT/ M\nGOTO/ 3, 1, 2");
    let cases: &[(&str, [f64; 3])] = &[
        ("TRANSL, 10, 20", [13.0, 21.0, 2.0]),
        ("XYROT, 90", [-1.0, 3.0, 2.0]),
        ("YZROT, 90", [3.0, -2.0, 1.0]),
        ("ZXROT, 90", [2.0, 1.0, -3.0]),
        ("SCALE, 2", [6.0, 2.0, 4.0]),
        ("XYROT, 90, TRANSL, 10, 0, 0", [9.0, 3.0, 2.0]),
        ("TRANSL, 10, 0, 0, XYROT, 90", [-1.0, 13.0, 2.0]),
        ("TRANSL, 1, 0, 0, SCALE, 2, TRANSL, 0, 0, 1", [8.0, 2.0, 5.0]),
        ("SHIFT, R90", [9.0, 23.0, 32.0]),
        ("R90, SHIFT", [-21.0, 13.0, 32.0]),
        ("INVERS, SHIFT", [-7.0, -19.0, -28.0]),
        ("INVERS, (MATRIX/ XYROT, 90, TRANSL, 10, 0, 0)", [1.0, 7.0, 2.0]),
        ("MIRROR, ZXPLAN", [3.0, -1.0, 2.0]),
        ("MIRROR, X5", [7.0, 1.0, 2.0]),
        ("(1, 1, 1), (VECTOR/ 0, 5, 0), (VECTOR/ -1, 0, 0)", [0.0, 4.0, 3.0]),
        ("1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7", [8.0, 7.0, 9.0]),
    ];
    for (definition, wanted) in cases {
        check(&[(&moved(definition), *wanted)]);
    }
    check(&[("TRACUT/ SHIFT\nTRACUT/ NOMORE\nGOTO/ 3, 1, 2", [3.0, 1.0, 2.0])]);
    // Increments count in the program's own frame.
    assert_eq!(points("TRACUT/ R90\nGODLTA/ 1, 0, 0\nGODLTA/ 1, 0, 0"), [[0.0, 1.0, 50.0], [0.0, 2.0, 50.0]]);
}

fn plane_points(statements: &str) -> Vec<[f64; 2]> {
    points(statements).into_iter().map(|p| [p[0], p[1]]).collect()
}

fn assert_near(found: &[[f64; 2]], wanted: &[[f64; 2]], what: &str) {
    let near = |(a, b): (&[f64; 2], &[f64; 2])| (a[0] - b[0]).abs() < 1e-9 && (a[1] - b[1]).abs() < 1e-9;
    assert!(found.len() == wanted.len() && found.iter().zip(wanted).all(near), "{what}: {found:?}");
}

#[test]
fn patterns_hold_the_points_their_definitions_say() {
    let root3 = 3f64.sqrt();
    let cases: &[(&str, &[[f64; 2]])] = &[
        ("LINEAR, A, E2, 3", &[[2.0, 3.0], [2.0, 6.0], [2.0, 9.0]]),
        ("LINEAR, A, B, 3", &[[2.0, 3.0], [4.0, 3.0], [6.0, 3.0]]),
        ("LINEAR, A, E2, INCR, 2, AT, 1.5", &[[2.0, 3.0], [2.0, 4.5], [2.0, 6.0]]),
        ("LINEAR, A, E2, INCR, 1, 2", &[[2.0, 3.0], [2.0, 4.0], [2.0, 6.0]]),
        (
            "LINEAR, A, E1, INCR, 2, AT, 1, INCR, 4, INCR, 1, AT, 7",
            &[[2.0, 3.0], [3.0, 3.0], [4.0, 3.0], [8.0, 3.0], [15.0, 3.0]],
        ),
        ("ARC, K2, 0, 90, CCLW, 4", &[[12.0, 0.0], [10.0 + root3, 1.0], [11.0, root3], [10.0, 2.0]]),
        ("ARC, K2, 0, 90, CLW, 4", &[[12.0, 0.0], [10.0, -2.0], [8.0, 0.0], [10.0, 2.0]]),
        ("ARC, K2, 90, CLW, INCR, 30, 60", &[[10.0, 2.0], [11.0, root3], [12.0, 0.0]]),
        ("ARC, K2, 0, CCLW, INCR, 2, AT, 90", &[[12.0, 0.0], [10.0, 2.0], [8.0, 0.0]]),
        ("PARLEL, (PATERN/ LINEAR, A, B, 2), E2, 2", &[[2.0, 3.0], [6.0, 3.0], [6.0, 6.0], [2.0, 6.0]]),
        (
            "PARLEL, (PATERN/ LINEAR, A, B, 2), E2, INCR, 1, AT, 5",
            &[[2.0, 3.0], [6.0, 3.0], [6.0, 8.0], [2.0, 8.0]],
        ),
        (
            "PARLEL, (PATERN/ LINEAR, A, B, 2), (PATERN/ RANDOM, (1, 1), (2, 8))",
            &[[2.0, 3.0], [6.0, 3.0], [7.0, 10.0], [3.0, 10.0]],
        ),
        ("RANDOM, B, (PATERN/ LINEAR, A, B, 2), A", &[[6.0, 3.0], [2.0, 3.0], [6.0, 3.0], [2.0, 3.0]]),
    ];
    for (definition, wanted) in cases {
        let found = plane_points(&format!("Q = PATERN/ {definition}\nGOTO/ Q"));
        assert_near(&found, wanted, definition);
    }
    check(&[("GOTO/ NUM(ROW), ROW.COUNT, 0", [5.0, 5.0, 0.0])]);
}

#[test]
fn a_motion_takes_the_points_of_a_pattern_that_it_names() {
    let x = |statement: &str| -> Vec<f64> { points(statement).into_iter().map(|p| p[0]).collect() };
    assert_eq!(x("GOTO/ ROW"), [0.0, 2.0, 4.0, 6.0, 8.0]);
    assert_eq!(x("GOTO/ ROW, INVERS"), [8.0, 6.0, 4.0, 2.0, 0.0]);
    assert_eq!(x("GOTO/ ROW, OMIT, 2, 4"), [0.0, 4.0, 8.0]);
    assert_eq!(x("GOTO/ ROW, RETAIN, 2, THRU, 4"), [2.0, 4.0, 6.0]);
    assert_eq!(x("GOTO/ ROW, INVERS, OMIT, 1"), [6.0, 4.0, 2.0, 0.0]);
    assert_eq!(x("GOTO/ ROW, INVERS, CONST, OMIT, 1"), [8.0, 6.0, 4.0, 2.0]);
    let raised: Vec<[f64; 3]> = points("GOTO/ ROW, AVOID, 3, 4");
    assert_eq!(raised[3..], [[6.0, 0.0, 0.0], [6.0, 0.0, 3.0], [8.0, 0.0, 3.0], [8.0, 0.0, 0.0]]);
}

#[test]
fn inclusive_subscripts_stand_for_their_elements() {
    assert_eq!(points("GOTO/ N(1, THRU, 3)"), [[1.0, 2.0, 7.0]]);
    assert_eq!(points("GOTO/ N(1, THRU, 4, INCR, 3), 0"), [[1.0, 5.0, 0.0]]);
    assert_eq!(points("GOTO/ N(3, THRU, 1, DECR, 1)"), [[7.0, 2.0, 1.0]]);
    assert_eq!(points("GOTO/ (PATERN/ RANDOM, P(ALL))").len(), 4);
    assert_eq!(plane_points("GOTO/ (PATERN/ RANDOM, P(ALL, DECR, 2))"), [[3.0, 30.0], [1.0, 10.0]]);
    assert_eq!(plane_points("GOTO/ (PATERN/ RANDOM, P(3, THRU, ALL))"), [[2.0, 20.0], [3.0, 30.0]]);
    check(&[(
        "K = CIRCLE/ (0, 5), (5, 0), (-5, 0)\nL = LINE/ N(ALL)\nGOTO/ K.RADIUS, L.LENGTH, 0",
        [5.0, 3.0 * 5f64.sqrt(), 0.0],
    )]);
}

#[test]
fn splines_go_through_their_points() {
    // Four points of y = x: the spline is straight.
    let text = "S1 = SPLINE/ (0, 0), (1, 1), (2, 2), (4, 4)\nS2 = TABCYL/ NOZ, SPLINE, 0, 0, SLOPE, 1, 3, 3\nGOTO/ 0, 0, 0";
    assert_eq!(points(text).len(), 1);
    assert_eq!(points("S3 = TABCYL/ NOZ, SPLINE, P(ALL)\nGOTO/ 0, 0, 0").len(), 1);
    let slanted =
        "S4 = SPLINE/ (0, 0), (5, 2), (9, 0), ATANGL, 90, 0\nS5 = SPLINE/ (0, 0), (5, 2), (9, 0), PERIODIC";
    assert_eq!(points(&format!("{slanted}\nGOTO/ {}, 0, 0", 2.0 * ROOT2)).len(), 1);
}
