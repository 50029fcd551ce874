//! The LinuxCNC reader against LinuxCNC's own interpreter: `rs274 -g` and `readback` must agree on what a program
//! does, and both must refuse what either refuses.
//!
//! Skipped, and said so, where rs274 is not installed (Debian: `linuxcnc-uspace`); `PARTWRIGHT_REQUIRE_RS274=1` makes it
//! an error.

use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::{Mutex, PoisonError};

use partwright::geom::{Point2, Point3};
use partwright::readback::{EventKind, MachineSetup, Rotary, TraceEvent, TracePath, run};

/// rs274 prints four decimals.
const ROUNDING: f64 = 0.000_051;
const INCH: f64 = 25.4;

/// A canonical call that moves or waits; lengths in mm, angles in degrees.
#[derive(Debug, Clone, PartialEq)]
enum Canonical {
    Rapid { to: Point3, c: f64 },
    Feed { to: Point3, c: f64 },
    Arc { plane: Plane, to: Point3, centre: Point2, turns: i32 },
    Dwell(f64),
    Nurbs(usize),
}

/// The plane of an arc, as it was selected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Plane {
    Xy,
    Zx,
    Yz,
}

impl Plane {
    /// Indices of the first and second axis, and of the one across.
    fn axes(self) -> [usize; 3] {
        match self {
            Plane::Xy => [0, 1, 2],
            Plane::Zx => [2, 0, 1],
            Plane::Yz => [1, 2, 0],
        }
    }
}

struct Executed {
    calls: Vec<Canonical>,
    /// What rs274 said when it stopped.
    error: Option<String>,
    rounding: f64,
}

fn installed() -> bool {
    let there = Command::new("rs274").arg("-h").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok();
    let required = std::env::var_os("PARTWRIGHT_REQUIRE_RS274").is_some_and(|v| v == "1");
    assert!(there || !required, "PARTWRIGHT_REQUIRE_RS274=1, and there is no rs274 to run");
    if !there {
        eprintln!("SKIPPED: rs274 is not installed, the LinuxCNC reader is not checked against LinuxCNC");
    }
    there
}

/// A directory of this test's own.
fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("rs274-{name}"));
    std::fs::create_dir_all(&folder).expect("a directory");
    folder
}

#[expect(clippy::disallowed_methods, reason = "a scratch file of the test")]
fn execute(name: &str, program: &str) -> Executed {
    let folder = folder(name);
    let (nc, table, variables) =
        (folder.join("program.ngc"), folder.join("tool.tbl"), folder.join("rs274.var"));
    std::fs::write(&nc, program).expect("a program");
    // Tool table lengths are inches, whatever the program's unit.
    std::fs::write(&table, "T1 P1 Z0 D0.3\nT2 P2 Z0 D0.2\nT3 P3 Z0 D0\n").expect("a table");
    let mut command = Command::new("rs274");
    command.args(["-g", "-t"]).arg(&table).arg("-v").arg(&variables).arg(&nc).stdin(Stdio::null());
    let done = alive(&mut command);
    let said = String::from_utf8_lossy(&done.stdout).into_owned();
    let error = (!done.status.success()).then(|| String::from_utf8_lossy(&done.stderr).into_owned());
    let rounding = if said.contains("CANON_UNITS_INCHES") { ROUNDING * INCH } else { ROUNDING };
    Executed { calls: calls(&said), error, rounding }
}

/// Runs rs274 until it is not killed by a signal: two at a time get in each other's way (bus errors) now and then, and
/// so may one that somebody else runs.
fn alive(command: &mut Command) -> std::process::Output {
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    let _guard = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    for _ in 0..20 {
        let done = command.output().expect("rs274 runs");
        if done.status.code().is_some() {
            return done;
        }
    }
    panic!("rs274 dies of a signal every time");
}

fn calls(said: &str) -> Vec<Canonical> {
    let mut unit = 1.0;
    let mut plane = Plane::Xy;
    let mut calls = Vec::new();
    for line in said.lines() {
        let Some((head, rest)) = line.split_once('(') else { continue };
        let name = head.split_whitespace().last().unwrap_or_default();
        let inside = rest.strip_suffix(')').unwrap_or(rest);
        if name == "USE_LENGTH_UNITS" {
            unit = if inside.contains("INCHES") { INCH } else { 1.0 };
            continue;
        }
        if name == "SELECT_PLANE" {
            plane = match inside {
                "CANON_PLANE_XZ" => Plane::Zx,
                "CANON_PLANE_YZ" => Plane::Yz,
                _ => Plane::Xy,
            };
            continue;
        }
        let values: Vec<f64> = inside.split(',').filter_map(|v| v.trim().parse().ok()).collect();
        calls.extend(call(name, &values, unit, plane));
    }
    calls
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn call(name: &str, v: &[f64], unit: f64, plane: Plane) -> Option<Canonical> {
    let mm = |i: usize| v.get(i).map_or(0.0, |x| x * unit);
    let raw = |i: usize| v.get(i).copied().unwrap_or_default();
    Some(match name {
        "STRAIGHT_TRAVERSE" => Canonical::Rapid { to: Point3::new(mm(0), mm(1), mm(2)), c: raw(5) },
        "STRAIGHT_FEED" => Canonical::Feed { to: Point3::new(mm(0), mm(1), mm(2)), c: raw(5) },
        "ARC_FEED" => Canonical::Arc {
            plane,
            to: in_space(plane, mm(0), mm(1), mm(5)),
            centre: Point2::new(mm(2), mm(3)),
            turns: raw(4) as i32,
        },
        "DWELL" => Canonical::Dwell(raw(0)),
        "NURBS_FEED" => Canonical::Nurbs(raw(0) as usize),
        _ => return None,
    })
}

fn in_space(plane: Plane, first: f64, second: f64, level: f64) -> Point3 {
    let [a, b, c] = plane.axes();
    let mut p = Point3::origin();
    p[a] = first;
    p[b] = second;
    p[c] = level;
    p
}

fn setup() -> MachineSetup {
    MachineSetup {
        rotary: Some(Rotary { letter: 'C', reversed: false }),
        tools: Some(vec![1, 2, 3]),
        ..MachineSetup::default()
    }
}

/// Both read the program; the events agree one by one.
fn agree(name: &str, program: &str) {
    let theirs = execute(name, program);
    assert_eq!(theirs.error, None, "{name}: rs274 refuses\n{program}");
    let ours = run(program.as_bytes(), "linuxcnc", &setup()).expect("linuxcnc is known");
    assert_eq!(ours.faults, [], "{name}:\n{program}");
    let happens = |e: &&TraceEvent| match &e.kind {
        EventKind::Move(m) => !m.rapid || m.start() != m.end() || m.known != [true; 3],
        kind => matches!(kind, EventKind::Dwell(_)),
    };
    let events: Vec<&TraceEvent> = ours.events.iter().filter(happens).collect();
    let calls = moving(&theirs.calls);
    assert_eq!(events.len(), calls.len(), "{name}: {calls:#?}");
    for (ours, theirs_) in events.iter().zip(calls) {
        assert!(same(ours, theirs_, theirs.rounding), "{name}: line {}: {ours:?}\n{theirs_:?}", ours.line);
    }
}

/// Rapids of no length are no motion: rs274 makes some over and between the holes of a cycle, the reader doesn't.
fn moving(calls: &[Canonical]) -> Vec<&Canonical> {
    let mut at = None;
    let mut kept = Vec::new();
    for call in calls {
        let place = match call {
            Canonical::Rapid { to, c } | Canonical::Feed { to, c } => Some((*to, *c)),
            Canonical::Dwell(_) => at,
            Canonical::Arc { .. } | Canonical::Nurbs(_) => None,
        };
        let stays = matches!(call, Canonical::Rapid { .. }) && place == at;
        if !stays {
            kept.push(call);
        }
        at = place;
    }
    kept
}

fn same(ours: &TraceEvent, theirs: &Canonical, rounding: f64) -> bool {
    let near = |p: Point3, q: Point3| (p - q).amax() <= rounding;
    let near2 = |p: Point2, q: Point2| (p - q).amax() <= rounding;
    // rs274 gives the machine's X, Y, C; the trace is in the part's frame.
    let placed = |to: &Point3, c: f64| {
        let (sin, cos) = partwright::math::sin_cos(c * partwright::math::DEG);
        Point3::new(cos * to.x - sin * to.y, sin * to.x + cos * to.y, to.z)
    };
    match (&ours.kind, theirs) {
        (EventKind::Dwell(a), Canonical::Dwell(b)) => (a - b).abs() <= ROUNDING,
        (EventKind::Move(m), Canonical::Rapid { to, c }) => m.rapid && near(m.end(), placed(to, *c)),
        (EventKind::Move(m), Canonical::Feed { to, c }) => {
            let straight = matches!(m.path, TracePath::Line { .. } | TracePath::Spiral { .. });
            straight && !m.rapid && near(m.end(), placed(to, *c))
        }
        (EventKind::Move(m), Canonical::Arc { plane, to, centre, turns }) => {
            let (sweep, c) = match m.path {
                TracePath::Arc { centre, sweep, .. } if *plane == Plane::Xy => (sweep, centre),
                TracePath::Tilted(arc) if arc.axis[plane.axes()[2]] == 1.0 => {
                    let [a, b, _] = plane.axes();
                    (arc.sweep, Point2::new(arc.centre[a], arc.centre[b]))
                }
                _ => return false,
            };
            let whole = f64::from(turns.unsigned_abs());
            let turn = sweep.abs() / partwright::math::TAU;
            near(m.end(), *to)
                && near2(c, *centre)
                && (sweep > 0.0) == (*turns > 0)
                && turn <= whole + 1e-6
                && turn > whole - 1.0 - 1e-6
        }
        (EventKind::Move(m), Canonical::Nurbs(n)) => {
            matches!(&m.path, TracePath::Nurbs { points, .. } if points.len() == *n)
        }
        _ => false,
    }
}

const START: &str = "G21 G90 G17 G94 G61 G40 G49 G80\nT1 M6\nG43 H1\nG0 X10 Y0 Z5 C0\nS1000 M3\nF100\n";

fn program(body: &str) -> String {
    format!("{START}{body}\nM2\n")
}

#[test]
fn both_read_the_same_motion() {
    if !installed() {
        return;
    }
    for (name, body) in [
        ("lines", "G1 Z-1\nX12.5 Y-3.0001\nG91 X1 Y1\nX-0.5\nG90 G0 Z5\nG4 P0.25"),
        (
            "arcs",
            "G1 Z-1\nG3 X0 Y10 I-10 J0\nG2 X10 Y0 I0 J-10\nG3 X-10 Y0 I-10\nG2 X0 Y10 R10\nG3 X10 Y0 R-10",
        ),
        ("circles", "G1 Z-1\nG2 I5\nG3 J-3\nG2 I5 P3\nG3 X10 Y0 I-5 J2\nG3 I-5 Z-2"),
        ("helix", "G3 X0 Y10 I-10 Z-3\nG2 X10 Y0 J-10 Z-4 P2"),
        ("absolute-centres", "G90.1\nG3 X0 Y10 I0 J0\nG2 X10 Y0 I0 J0\nG91.1\nG2 I1"),
        ("small-mismatch", "G3 X0 Y10.004 I-10 J0"),
        ("inch", "G20 F10\nG1 X1.5 Y0.25\nG2 X2.5 Y0.25 I0.5 J0\nG21 F100\nG1 X10"),
        ("table", "G93 G1 X12 C90 F2\nX12 C180 F1\nG94 G1 X14 F50\nC200\nG0 X20 C0"),
        ("lower case and blanks", "g1 x 1 2 . 5 y-3\ng 2 i 1\n/g1 x3\nN20 g1 x4"),
        ("comments", "(a comment) G1 (another) X11 ; the rest G1 X99\n(MSG, hello)"),
        ("nurbs", "G1 X0 Y0\nG5.2 P1 L3\nX0 Y1 P1\nX2 Y2 P1\nX2 Y0 P2\nX0 Y0 P1\nG5.3\nG1 X1"),
        (
            "pieces",
            "G1 X0 Y0\nG5 X10 Y10 I0 J5 P-5 Q0\nG5 X20 Y0 P0 Q5\nG91 G5 X1 Y2 I1 J0 P0 Q-1\nG90 G1 X3",
        ),
        ("smoothing", "G64 P0.01\nG1 X11\nG64 P0.01 Q0.002\nX12\nG61.1\nX13"),
        ("xz", "G1 Z-1\nG18 G3 X0 Z9 I-10\nG2 X10 Z-1 K-10\nG2 X10 Z-1 I-4 K3\nG3 X4 Z5 R9 Y3\nG17"),
        ("yz", "G19 G3 Y10 Z15 J10\nG2 Y0 Z5 K-10\nG2 J-4 K3\nG3 Y4 Z5 R9 X3\nG2 Y4 Z5 J2 X8 P3\nG17"),
        ("drilling", "G98 G81 X1 Y2 Z-3 R2\nX4\nG99 Y6\nZ-4 X7\nR1 X8\nG80\nG0 Z5"),
        (
            "cycle dwell",
            "G98 G82 X1 Y2 Z-3 R2 P0.5\nX4\nG89 X5 Z-2 R3 P0.25\nG85 X6 Z-3 R2\nG80\nG0 Z6\nG86 X5 Z-1 R2 P1\nG80",
        ),
        ("pecks", "G98 G83 X1 Y2 Z-5 R2 Q3\nX5\nG73 X6 Z-4 R2 Q2\nG80\nG0 Z5"),
        ("below R", "G0 Z1\nG99 G81 X1 Y2 Z-3 R2\nX4\nG98 X5\nG80\nG0 Z5"),
        ("rows", "G91 G81 X1 Y2 Z-5 R-3 L3\nG90 G80 G0 Z5"),
        ("rows from the first height", "G98 G91 G81 X1 Y2 Z-3 R-2 L3\nX5 L2\nG80\nG90 G0 Z6"),
        ("repeats on the spot", "G98 G81 X10 Y0 Z-3 R2 L2\nG80 G0 X1"),
        ("cycle words in another distance mode", "G98 G81 X10 Y0 Z-1 R2\nG91 X1\nZ-2 X1\nR-1 X1\nG80"),
        (
            "compensation by 0",
            "G41 D3 G3 X0 Y0 I-5\nX10 I5\nG40 G2 X0 I-5\nG1 Z-1\nG41 D3 G1 X20\nY10\nG3 X10 Y20 I-10 J0\nG1 Z-2\nX0\nG40\nX-5 Y20\nG0 G42 D3 X0 Y0\nG1 X10\nG40 G0 X20",
        ),
        ("modal", "G1 X11\nG95 F0.1 X12\nG97 S500\nG94 F50 X13\nM5\nM3\nM7\nM8\nM9"),
    ] {
        agree(name, &program(body));
    }
    agree("frame", &format!("%\n{}\n%\n", program("G1 X1").replace("M2\n", "")));
}

#[test]
fn both_refuse_the_same() {
    if !installed() {
        return;
    }
    for (i, body) in [
        "G1 G0 X1",
        "G1 X1 X2",
        "G1 X1 Q3",
        "G1 X1 H3",
        "G1 X1 I3",
        "G12 X1",
        "M3 M4",
        "G1 X",
        "G1 X1.2.3",
        "G1 X1 (open",
        "G1 X1 (a (b) c)",
        "G1 X1 $",
        "G2 X10 Y0",
        "G2 X0 Y0 R2",
        "G2 R5",
        "G2 X10 Y0 I-5 R5",
        "G2 X0 Y0 I-6 J0",
        "G90.1 G2 X0 Y10 I0",
        "G93 G1 X1",
        "G94\nG1 X1",
        "G1 X1 F0",
        "G4",
        "G4 P-1",
        "G80\nX1",
        "G53 G2 X0 I1",
        "T77 M6",
        "G5.3",
        "G5.2 P1 L3\nX0 Y1 P1\nG5.3",
        "G5.2 P1 L3\nX0 Y1\nX2 Y2 P1\nG5.3",
        "G5 X1 Y1 I1 P1 Q1",
        "G5 X1 Y1 I1 J1 Q1",
        "G5 X1 Y1 Z1 I1 J1 P1 Q1",
        "G18 G5 X1 Y1 I1 J1 P1 Q1",
        "G5 I1 J1 P1 Q1",
        "G5.1 X1 Y1",
        "S-1",
        "M7 M8",
        "G81 X1 Z-3 R-4",
        "G81 X1 Z-3",
        "G83 X1 Z-3 R1",
        "G93 G81 X1 Z-3 R1 F1",
        "G81 X1 Z-3 R1\nG81 R2",
        "G81 X1 Z-3 R1\nG82 X2 P1",
        "G83 X1 Z-3 R1 Q1 D1",
        "G99 G74 X1 Z-3 R1",
        "G81 X1 C5 Z-3 R1",
        "G41 D3 G1 X20\nG41 D3 X30",
        "G41 D3 G1 X20\nG42 D3 X30",
        "G41 D3 G1 X20\nG18",
        "G41 D3 G1 X20\nG28 Z5",
        "G41 D3 G1 X20\nG81 X30 Y5 Z-3 R1",
        "G41 D3 G1 X20\nT2 M6",
        "G41 D77 G1 X20",
        "G41 D1.5 G1 X20",
    ]
    .iter()
    .enumerate()
    {
        let program = program(body);
        let theirs = execute(&format!("refused-{i}"), &program);
        assert!(theirs.error.is_some(), "rs274 takes\n{body}");
        let ours = run(program.as_bytes(), "linuxcnc", &setup()).expect("linuxcnc is known");
        assert!(!ours.faults.is_empty(), "readback takes\n{body}\nrs274 says {:?}", theirs.error);
    }
}

#[test]
fn both_want_an_end() {
    if !installed() {
        return;
    }
    for (i, program) in ["G21 G90\nG0 X1\n", "%\nG21 G90\nG0 X1\n"].iter().enumerate() {
        let theirs = execute(&format!("end-{i}"), program);
        assert!(theirs.error.is_some(), "rs274 takes\n{program}");
        assert!(!run(program.as_bytes(), "linuxcnc", &setup()).expect("known").faults.is_empty());
    }
}
