//! Whole programs that only differ by where they are cut.

use std::collections::BTreeMap;

use super::*;
use crate::source::MemoryFiles;

const CAVITY: &str = "\
UNITS/ MM
N1 = NET/ 4, 4, (0, 0, 0), (0, 10, 0), (0, 20, 0), (0, 30, 0), $
  (12, 0, 0), (12, 10, -7), (12, 20, -6), (12, 30, 0), $
  (24, 0, 0), (24, 10, -5), (24, 20, -8), (24, 30, 0), $
  (36, 0, 0), (36, 10, 0), (36, 20, 0), (36, 30, 0)
T1 = CUTTER/ BALL, 8, NUMBER, 1
LOADTL/ T1
SPINDL/ 8000, CLW
FEDRAT/ 900, MMPM
TOLER/ 0.02
CLEARP/ 20
MOVE
FINISH = SURFAC/ N1, ZIGZAG, U, STEP, 5
FINI
";

/// The positions of the program's blocks, in thousandths; words that are left out stay as they were.
fn positions(placed: &str) -> Vec<[i64; 3]> {
    let files = MemoryFiles(BTreeMap::from([("a.apt".to_owned(), CAVITY.replace("MOVE\n", placed))]));
    let options = Options { posts: vec!["linuxcnc".to_owned()], ..Options::default() };
    let build = build("a.apt", &files, &options);
    let errors: Vec<&str> =
        build.diagnostics.iter().filter(|d| d.code.id.starts_with('E')).map(|d| d.message.as_str()).collect();
    assert!(errors.is_empty(), "{errors:?}");
    let proven = build.outputs[0].proven.as_ref().expect("an NC program");
    let mut at = [i64::MIN; 3];
    let mut out = Vec::new();
    for line in proven.text().lines() {
        let moves = line.starts_with(['G', 'X', 'Y', 'Z']) && !line.contains("G53");
        for word in line.split_whitespace().filter(|_| moves) {
            let axis = word.chars().next().and_then(|c| ['X', 'Y', 'Z'].iter().position(|a| *a == c));
            if let (Some(axis), Ok(x)) = (axis, word[1..].parse::<f64>()) {
                #[allow(clippy::cast_possible_truncation)]
                let thousandths = (x * 1000.0).round() as i64;
                at[axis] = thousandths;
            }
        }
        if at.iter().all(|x| *x != i64::MIN) && out.last() != Some(&at) {
            out.push(at);
        }
    }
    assert!(out.len() > 50, "{} positions", out.len());
    out
}

/// The same positions within one step of the grid: halves are rounded away from zero, wherever that is.
fn near(wanted: impl ExactSizeIterator<Item = [i64; 3]>, found: &[[i64; 3]]) {
    assert_eq!(wanted.len(), found.len());
    for (a, b) in wanted.zip(found) {
        assert!(a.iter().zip(b).all(|(x, y)| (x - y).abs() <= 1), "{a:?} {b:?}");
    }
}

#[test]
fn a_net_that_is_shifted_by_steps_of_the_grid_gives_the_same_numbers_shifted() {
    let (here, there) = (positions(""), positions("TRACUT/ (MATRIX/ TRANSL, 64, -32, 0)\n"));
    near(here.iter().map(|p| [p[0] + 64_000, p[1] - 32_000, p[2]]), &there);
}

#[test]
fn a_net_that_is_turned_by_a_right_angle_gives_the_path_turned() {
    let (here, there) = (positions(""), positions("TRACUT/ (MATRIX/ XYROT, 90)\n"));
    near(here.iter().map(|p| [-p[1], p[0], p[2]]), &there);
}

/// Two planes that meet in a ridge.
const ROOF: &str = "\
UNITS/ MM
N1 = NET/ 4, 7, (0, 0, 0), (0, 3, 2), (0, 6, 4), (0, 9, 6), (0, 12, 4), (0, 15, 2), (0, 18, 0), $
  (5, 0, 0), (5, 3, 2), (5, 6, 4), (5, 9, 6), (5, 12, 4), (5, 15, 2), (5, 18, 0), $
  (10, 0, 0), (10, 3, 2), (10, 6, 4), (10, 9, 6), (10, 12, 4), (10, 15, 2), (10, 18, 0), $
  (15, 0, 0), (15, 3, 2), (15, 6, 4), (15, 9, 6), (15, 12, 4), (15, 15, 2), (15, 18, 0)
T1 = CUTTER/ BALL, 8, NUMBER, 1
LOADTL/ T1
SPINDL/ 8000, CLW
FEDRAT/ 900, MMPM
TOLER/ 0.004
CLEARP/ 20
FINISH = SURFAC/ N1, ZIGZAG, WAY, CUSP, 0.04
FINI
";

fn roof(way: &str) -> Build {
    let files = MemoryFiles(BTreeMap::from([("a.apt".to_owned(), ROOF.replace("WAY", way))]));
    build("a.apt", &files, &Options { posts: vec!["linuxcnc".to_owned()], ..Options::default() })
}

#[test]
fn every_way_of_passes_goes_over_a_ridge() {
    for way in ["U", "V", "X", "Y", "ISOCSP", "CONST"] {
        let build = roof(way);
        assert!(!build.has_errors(), "{way}: {:?}", build.diagnostics);
        assert!(build.outputs[0].proven.is_some(), "{way}");
    }
}

#[test]
fn passes_lie_closer_only_where_that_is_asked_for() {
    let ir = roof("U").ir.expect("a program");
    let passes = |asked: &[(usize, Place)], everywhere: bool| {
        let (mut closer, mut sink) = (Closer::default(), Sink::default());
        closer.add(asked, everywhere);
        let cl = plan::plan_closer(&ir, &closer, &mut sink).expect("CL data");
        cl.records.iter().filter(|r| matches!(r.kind, crate::cl::RecordKind::Pass(_))).count()
    };
    let place = Place { at: crate::geom::Point3::new(7.0, 3.0, 2.0), reach: 2.0, share: 0.25 };
    let (before, near, all) = (passes(&[], false), passes(&[(0, place)], false), passes(&[(0, place)], true));
    assert!(before < near && near < all && all < 3 * before, "{before} {near} {all}");
    assert_eq!(before, passes(&[(1, place)], true));
}
