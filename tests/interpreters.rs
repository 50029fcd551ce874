//! Our readers against interpreters that other people wrote: every example, posted and proven, is executed by both.
//!
//! ncplot7py (Fanuc, SINUMERIK), nc-gcode-interpreter (SINUMERIK) and gcode-toolpath (Grbl); the programs in
//! `tests/tools/execute_*` say what each can't see. `PARTWRIGHT_INTERPRETERS` names the folder where they are installed
//! (`.ci/run` does that); without it the tests are skipped, and say so.

mod common;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use common::Directory;
use partwright::driver::{self, Options};
use partwright::geom::Point3;
use partwright::readback::{EventKind, MachineSetup, TraceMove, TracePath, run};

/// Longest program that is executed; the interpreters are slow.
const LONGEST: usize = 4000;
/// What an interpreter may be off: its arcs keep the start's radius, and radii of printed arcs differ by up to 0.002 mm.
const NEAR: f64 = 0.004;
/// What nc-gcode-interpreter may be off, mm: it keeps 32-bit numbers.
const SINGLE: f64 = 0.000_05;
/// What the time of a cut may be off, as a share.
const TIME: f64 = 0.01;

/// The folder with the interpreters, or nothing.
fn installed() -> Option<PathBuf> {
    let folder = std::env::var_os("PARTWRIGHT_INTERPRETERS").map(PathBuf::from);
    if folder.is_none() {
        eprintln!("SKIPPED: PARTWRIGHT_INTERPRETERS is not set, the readers are not checked against others");
    }
    folder
}

/// A proven program with what our reader says it does.
struct Program {
    name: String,
    text: String,
    /// Millimetres in its unit.
    unit: f64,
    moves: Vec<(u32, TraceMove)>,
}

/// All examples that this post can be made of, as far as they have only motion that others know.
fn programs(post: &str) -> Vec<Program> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let mut found = common::find(&folder, "apt");
    found.retain(|p| p.parent() == Some(folder.as_path()));
    found.iter().filter_map(|path| program(path, &folder, post)).collect()
}

fn program(path: &Path, folder: &Path, post: &str) -> Option<Program> {
    let name = path.strip_prefix(folder).ok()?.to_string_lossy().into_owned();
    let options = Options { posts: vec![post.to_owned()], ..Options::default() };
    let build = driver::build(&name, &Directory(folder.to_owned()), &options);
    let text = build.outputs.first()?.proven.as_ref()?.text().to_owned();
    let trace = run(text.as_bytes(), post, &MachineSetup::default()).ok()?;
    let moves: Vec<(u32, TraceMove)> = trace
        .events
        .into_iter()
        .filter_map(|e| if let EventKind::Move(m) = e.kind { Some((e.line, m)) } else { None })
        .collect();
    let others_know = |m: &TraceMove| {
        !m.in_cycle && matches!(m.path, TracePath::Line { .. } | TracePath::Arc { .. } | TracePath::Tilted(_))
    };
    let plain = trace.faults.is_empty() && moves.iter().all(|(_, m)| others_know(m));
    let short = text.lines().count() <= LONGEST;
    let unit = if text.contains("G20") || text.contains("G700") { 25.4 } else { 1.0 };
    (plain && short).then_some(Program { name, text, unit, moves })
}

/// Writes the program to a file, runs `command` on it and gives what it says.
#[expect(clippy::disallowed_methods, reason = "a scratch file of the test")]
fn executed(program: &Program, tag: &str, command: &mut Command) -> Vec<Vec<String>> {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("interpreters-{tag}"));
    std::fs::create_dir_all(&folder).expect("a directory");
    let file = folder.join("program.nc");
    std::fs::write(&file, &program.text).expect("a file");
    let done = command.arg(&file).output().expect("the interpreter runs");
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{} refused by {tag}: {said}\n{}", program.name, program.text);
    let text = String::from_utf8_lossy(&done.stdout).into_owned();
    text.lines().map(|l| l.split_whitespace().map(str::to_owned).collect()).collect()
}

fn python(installed: &Path, script: &str) -> Command {
    let mut command = Command::new(installed.join("python/bin/python"));
    command.arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/tools").join(script));
    command
}

fn numbers(words: &[String]) -> Vec<f64> {
    words.iter().map(|w| w.parse().expect("a number")).collect()
}

fn points(values: &[f64], unit: f64) -> Vec<Point3> {
    values.chunks_exact(3).map(|p| Point3::new(p[0], p[1], p[2]) * unit).collect()
}

/// Distance of a point from a path, heights of arcs apart.
fn off(path: &TraceMove, p: Point3) -> f64 {
    match &path.path {
        TracePath::Arc { centre, from, .. } => ((p.xy() - centre).norm() - (from - centre).norm()).abs(),
        TracePath::Tilted(arc) => {
            let across = (p - arc.centre) - arc.axis * (p - arc.centre).dot(&arc.axis);
            (across.norm() - arc.radii().0).abs()
        }
        _ => {
            let (a, b) = (path.start(), path.end());
            let along = b - a;
            let x = ((p - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
            (p - (a + along * x)).norm()
        }
    }
}

/// Whether the axes of the move were known before it, so that an interpreter that starts at zero agrees.
fn comparable(cut: &TraceMove) -> bool {
    cut.known.iter().all(|k| *k) && cut.length() > 1e-9
}

fn against_ncplot7py(post: &str, machine: &str) {
    let Some(installed) = installed() else { return };
    let (mut compared, mut files) = (0, 0);
    for program in programs(post) {
        let mut command = python(&installed, "execute_ncplot7py.py");
        let rows = executed(&program, &format!("ncplot7py-{post}"), command.arg(machine));
        let mut theirs: BTreeMap<u32, Vec<(String, f64, Vec<Point3>)>> = BTreeMap::new();
        for row in rows.iter().filter(|r| r.first().is_some_and(|w| w == "M")) {
            let values = numbers(&row[4..]);
            let line = row[1].parse().expect("a line");
            let time = row[3].parse().expect("a time");
            theirs.entry(line).or_default().push((row[2].clone(), time, points(&values, program.unit)));
        }
        files += 1;
        for (line, ours) in program.moves.iter().filter(|(_, m)| comparable(m)) {
            let place = format!("{} for {post}, line {line}", program.name);
            let of_line = theirs.get(line).unwrap_or_else(|| panic!("{place}: ncplot7py does not move"));
            let (kind, time, path) = of_line.first().expect("a motion");
            assert_eq!(kind == "R", ours.rapid, "{place}");
            let (first, last) = (path.first().expect("a start"), path.last().expect("an end"));
            assert!(
                (first - ours.start()).norm() < NEAR && (last - ours.end()).norm() < NEAR,
                "{place}: {path:?} {ours:?}"
            );
            assert!(path.iter().all(|p| off(ours, *p) < NEAR), "{place}: {path:?} {ours:?}");
            if let Some(feed) = ours.feed {
                let wanted = 60.0 * ours.length() / feed;
                assert!((time - wanted).abs() <= TIME * wanted + 0.01, "{place}: {time} s, {wanted} s");
            }
            compared += 1;
        }
    }
    assert!(files > 3 && compared > 100, "{post}: only {compared} moves of {files} programs compared");
    println!("{post}: {compared} moves of {files} programs agree with ncplot7py");
}

#[test]
fn fanuc_as_ncplot7py_executes_it() {
    against_ncplot7py("fanuc", "FANUC_MILL");
}

#[test]
fn sinumerik_as_ncplot7py_executes_it() {
    against_ncplot7py("sinumerik", "SIEMENS_840DI");
}

#[test]
fn sinumerik_as_nc_gcode_interpreter_executes_it() {
    let Some(installed) = installed() else { return };
    let mut compared = 0;
    for program in programs("sinumerik") {
        let rows = executed(&program, "nc-gcode", &mut python(&installed, "execute_nc_gcode_interpreter.py"));
        let mut theirs = BTreeMap::new();
        for row in rows.iter().filter(|r| r.first().is_some_and(|w| w == "P")) {
            let line: u32 = row[1].parse().expect("a line");
            let end = points(&numbers(&row[3..]), program.unit);
            theirs.insert(line, (row[2].clone(), end[0]));
        }
        for (line, ours) in program.moves.iter().filter(|(_, m)| comparable(m)) {
            let place = format!("{} for sinumerik, line {line}", program.name);
            let (code, end) = theirs.get(line).unwrap_or_else(|| panic!("{place}: no block there"));
            let wanted = match &ours.path {
                TracePath::Arc { sweep, .. } => {
                    if *sweep < 0.0 {
                        "G2"
                    } else {
                        "G3"
                    }
                }
                _ if ours.rapid => "G0",
                _ => "G1",
            };
            assert_eq!(code, wanted, "{place}");
            assert!((end - ours.end()).norm() < SINGLE, "{place}: {end:?} {ours:?}");
            compared += 1;
        }
    }
    assert!(compared > 100, "only {compared} blocks compared");
    println!("sinumerik: {compared} blocks agree with nc-gcode-interpreter");
}

/// gcode-toolpath tells the points of an arc in the order of its plane's axes: Z, X, Y in G18 and Y, Z, X in G19.
fn as_the_plane_has_them(points: &[Point3], path: &TracePath) -> Vec<Point3> {
    let turn = match path {
        TracePath::Tilted(arc) if arc.axis.y != 0.0 => |p: &Point3| Point3::new(p.y, p.z, p.x),
        TracePath::Tilted(_) => |p: &Point3| Point3::new(p.z, p.x, p.y),
        _ => |p: &Point3| *p,
    };
    points.iter().map(turn).collect()
}

#[test]
fn grbl_as_gcode_toolpath_executes_it() {
    let Some(installed) = installed() else { return };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/tools/execute_gcode_toolpath.js");
    let mut compared = 0;
    for program in programs("grbl") {
        let mut command = Command::new("node");
        let command = command.env("NODE_PATH", installed.join("node_modules")).arg(&script);
        let rows = executed(&program, "toolpath", command);
        let theirs: Vec<(String, String, Vec<Point3>)> = rows
            .iter()
            .filter(|r| r.len() > 2)
            .map(|r| (r[0].clone(), r[1].clone(), points(&numbers(&r[2..]), 1.0)))
            .filter(|(kind, _, p)| kind == "A" || (p[0] - p[1]).norm() > 1e-9)
            .collect();
        // The first moves come from a place that only they think they know.
        let known = program.moves.iter().position(|(_, m)| comparable(m)).unwrap_or_default();
        let ours: Vec<&(u32, TraceMove)> =
            program.moves[known..].iter().filter(|(_, m)| m.length() > 1e-9).collect();
        let skip = theirs.len().checked_sub(ours.len()).expect("as many moves as ours");
        for ((line, ours), (kind, way, path)) in ours.iter().zip(&theirs[skip..]) {
            let place = format!("{} for grbl, line {line}", program.name);
            let path = as_the_plane_has_them(path, &ours.path);
            assert!(
                (path[0] - ours.start()).norm() < 1e-6 && (path[1] - ours.end()).norm() < 1e-6,
                "{place}: {path:?} {ours:?}"
            );
            match &ours.path {
                TracePath::Arc { centre, sweep, .. } => {
                    assert!(kind == "A" && (way == "C") == (*sweep < 0.0), "{place}: {way}");
                    assert!((path[2].xy() - centre).norm() < 1e-6, "{place}: {path:?} {centre:?}");
                }
                TracePath::Tilted(arc) => {
                    let clockwise = arc.sweep * arc.axis.sum() < 0.0;
                    assert!(kind == "A" && (way == "C") == clockwise, "{place}: {way}");
                    assert!((path[2] - arc.centre).norm() < 1e-6, "{place}: {path:?} {:?}", arc.centre);
                }
                _ => assert!(kind == "L" && (way == "R") == ours.rapid, "{place}"),
            }
            compared += 1;
        }
    }
    assert!(compared > 100, "only {compared} moves compared");
    println!("grbl: {compared} moves agree with gcode-toolpath");
}
