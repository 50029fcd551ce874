use crate::cl::{Cl, RecordKind};
use crate::diag::Sink;
use crate::driver::{self, Build, Options};
use crate::post::{load, write};
use crate::source::{MemoryFiles, SourceMap};
use crate::target::{BlockKind, Motion, TargetProgram};
use crate::verify::{Emitted, SurfaceProof, prove};

/// A hollow of 30 by 24 mm, finished with a ball of 6 mm diameter.
fn program(operation: &str) -> String {
    format!(
        "UNITS/ MM\nMACHIN/ LINUXCNC\n\
         N1 = NET/ 4, 4, (0, 0, 0), (0, 8, 0), (0, 16, 0), (0, 24, 0), $\n\
         (10, 0, 0), (10, 8, -11), (10, 16, -9), (10, 24, 0), $\n\
         (20, 0, 0), (20, 8, -8), (20, 16, -12), (20, 24, 0), $\n\
         (30, 0, 0), (30, 8, 0), (30, 16, 0), (30, 24, 0)\n\
         T1 = CUTTER/ BALL, 6, NUMBER, 1\nLOADTL/ T1\nSPINDL/ 8000\nFEDRAT/ 800\nINTOL/ 0\nOUTTOL/ 0.01\nCLEARP/ 10\n\
         S1 = SURFAC/ N1, {operation}\nFINI\n"
    )
}

fn build(operation: &str) -> Build {
    build_for("linuxcnc", operation)
}

fn build_for(post: &str, operation: &str) -> Build {
    built(post, program(operation))
}

fn built(post: &str, text: String) -> Build {
    let mut files = MemoryFiles::default();
    files.0.insert("part.apt".to_owned(), text);
    let options = Options { posts: vec![post.to_owned()], ..Options::default() };
    let build = driver::build("part.apt", &files, &options);
    assert!(!build.has_errors(), "{post}, {:?}: {:#?}", files.0, build.diagnostics);
    build
}

fn proof(build: &Build) -> SurfaceProof {
    let proven = build.outputs[0].proven.as_ref().expect("a proven program");
    proven.certificate().operations[0].surface.clone().expect("a surface")
}

#[test]
fn every_kind_of_pass_keeps_its_tolerances() {
    for along in ["U", "V", "X", "Y", "ISOCSP", "CONST"] {
        let proof = proof(&build(&format!("ZIGZAG, {along}, CUSP, 0.02")));
        assert!(proof.into.value <= 1e-6 && proof.out.value <= 0.01 + 1e-6, "{along}: {proof:?}");
        let cusp = proof.cusp.expect("cusps").value;
        assert!(cusp > 0.01 && cusp <= 0.0201, "{along}: {cusp}");
        assert!(proof.left.value <= proof.left_bound && proof.unreachable.is_none(), "{along}: {proof:?}");
    }
}

/// Number and length, mm, of the lines that follow lines.
fn lines(build: &Build) -> (usize, f64) {
    let target = build.outputs[0].target.as_ref().expect("a target");
    let (mut before, mut count, mut length) = (None, 0, 0.0);
    for block in &target.blocks {
        let BlockKind::Motion(Motion::Line { to, .. }) = &block.kind else {
            before = None;
            continue;
        };
        let now = (to.x, to.y, to.z);
        if let Some((x, y, z)) = before {
            let square = |a: i64, b: i64| ((a - b) * (a - b)) as f64;
            length += (square(now.0, x) + square(now.1, y) + square(now.2, z)).sqrt() * 1e-3;
            count += 1;
        }
        before = Some(now);
    }
    (count, length)
}

#[test]
fn passes_that_bend_are_shorter_than_straight_ones() {
    let [u, v, iso, even] =
        ["U", "V", "ISOCSP", "CONST"].map(|along| lines(&build(&format!("ZIGZAG, {along}, CUSP, 0.02"))));
    assert!(iso.1 < 0.985 * u.1.min(v.1), "{iso:?} {u:?} {v:?}");
    assert!(iso.1 < even.1, "{iso:?} {even:?}");
    assert!(iso.0 < 2 * u.0.max(v.0), "{iso:?} {u:?} {v:?}");
}

#[test]
fn passes_in_planes_take_fewer_arcs_than_lines() {
    for along in ["X", "Y"] {
        let [straight, arcs] =
            ["", ", CIRCUL"].map(|kind| proof(&build(&format!("ZIGZAG, {along}{kind}, CUSP, 0.02"))));
        assert!(2 * arcs.blocks < straight.blocks, "{along}: {} {}", arcs.blocks, straight.blocks);
        assert!(arcs.into.value <= 1e-6 && arcs.out.value <= 0.01 + 1e-6, "{along}: {arcs:?}");
        assert!(arcs.left.value <= arcs.left_bound && arcs.left_bound < 0.033, "{along}: {arcs:?}");
        assert!((arcs.length - straight.length).abs() < 0.01 * straight.length, "{along}: {arcs:?}");
    }
}

#[test]
fn what_is_told_by_an_exhausted_surface_is_no_proof() {
    let build = build("ZIGZAG, U, STEP, 6");
    let (cl, target) = (build.cl.as_ref().expect("CL"), build.outputs[0].target.as_ref().expect("a target"));
    cl.operations[0].guard.surface.as_ref().expect("a surface").tree.exhaust();
    assert!(refused(cl, target).contains(&"E0810"));
}

#[test]
fn an_arc_that_ends_too_deep_or_too_high_is_found() {
    let build = build("ZIGZAG, X, CIRCUL, CUSP, 0.02");
    let cl = build.cl.as_ref().expect("CL");
    let arcs = |target: &mut TargetProgram, n: usize, steps: i64| {
        let ends = target.blocks.iter_mut().filter_map(|block| match &mut block.kind {
            BlockKind::Motion(Motion::Arc { to, centre, .. }) => Some((to, centre)),
            _ => None,
        });
        // The end and, so that the radii stay the same, the centre by half of it: the arc is another one.
        let (to, centre) = { ends }.nth(n).expect("an arc");
        to.z += steps;
        centre[0] += steps / 2;
    };
    for n in [3, 20, 41] {
        for (steps, code) in [(-60, "E0820"), (60, "E0821")] {
            let mut target = build.outputs[0].target.clone().expect("a target");
            arcs(&mut target, n, steps);
            let found = refused(cl, &target);
            assert!(found.contains(&code) || found.contains(&"E0802"), "{n} {steps}: {found:?}");
        }
    }
}

/// Blocks of the moves along passes and links: of a curve one for each control point after the first.
fn blocks(build: &Build) -> usize {
    let target = build.outputs[0].target.as_ref().expect("a target");
    let of = |motion: &Motion| match motion {
        Motion::Nurbs { curve, .. } => target.nurbs[*curve as usize].points.len() - 1,
        Motion::Line { .. } | Motion::Arc { .. } => 1,
        Motion::Rapid { .. } => 0,
    };
    let moves = target
        .blocks
        .iter()
        .filter_map(|b| if let BlockKind::Motion(m) = &b.kind { Some(of(m)) } else { None });
    moves.sum()
}

#[test]
fn passes_take_fewer_points_of_curves_than_lines() {
    for (post, along, times) in [("sinumerik", "U", 2.5), ("mitsubishi", "X", 2.0), ("fanuc", "ISOCSP", 1.3)]
    {
        let [straight, bent] =
            ["LINEAR", "NURBS"].map(|kind| build_for(post, &format!("ZIGZAG, {along}, {kind}, CUSP, 0.05")));
        let (curves, lines) = (proof(&bent), proof(&straight));
        let blocks = [&bent, &straight].map(|build| blocks(build) as f64);
        assert!(times * blocks[0] < blocks[1], "{post} {along}: {blocks:?}");
        assert!(curves.into.value <= 1e-6 && curves.out.value <= 0.01 + 1e-6, "{along}: {curves:?}");
        assert!(curves.left.value <= curves.left_bound && curves.left_bound < 0.0601, "{along}: {curves:?}");
        assert!((curves.length - lines.length).abs() < 0.02 * lines.length, "{along}: {curves:?} {lines:?}");
    }
}

#[test]
fn arcs_and_curves_are_proven_for_a_corner_radius() {
    for (post, along) in [("linuxcnc", "X, CIRCUL"), ("sinumerik", "X, NURBS")] {
        let [straight, bent] = ["X", along].map(|along| {
            let text = program(&format!("ZIGZAG, {along}, CUSP, 0.1")).replace("BALL, 6", "BULL, 6, 2");
            built(post, text)
        });
        let found = proof(&bent);
        assert!(4 * blocks(&bent) < 3 * blocks(&straight), "{post}: {} {}", blocks(&bent), blocks(&straight));
        assert!(found.into.value <= 1e-6 && found.out.value <= 0.01 + 1e-6, "{post}: {found:?}");
        assert!(found.left_bound < 0.1101, "{post}: {found:?}");
    }
}

#[test]
fn curves_leave_the_control_its_share_of_a_band_to_both_sides() {
    let text = program("ZIGZAG, U, NURBS, STEP, 4")
        .replace("BALL, 6", "TAPER, 6, 2, ANGLE, 5")
        .replace("INTOL/ 0", "INTOL/ 0.01");
    let found = proof(&built("sinumerik", text));
    // A quarter of the band is CYCLE832's.
    assert!(found.into.value > 0.005 && found.into.value <= 0.0075 + 1e-6, "{found:?}");
    assert!(found.out.value > 0.005 && found.out.value <= 0.0075 + 1e-6, "{found:?}");
}

#[test]
fn passes_are_lines_where_there_are_no_curves_for_them() {
    for (post, feed, why) in [
        ("grbl", "800", "`grbl` has no NURBS"),
        ("linuxcnc", "800", "in the XY plane only"),
        ("fanuc", "0.1, MMPR", "feed is per revolution"),
    ] {
        let text = program("ZIGZAG, U, NURBS, STEP, 6").replace("FEDRAT/ 800", &format!("FEDRAT/ {feed}"));
        let build = built(post, text);
        let told = build.diagnostics.iter().find(|d| d.code.id == "N0603").expect("a note");
        assert!(
            told.message.starts_with("the passes are cut by lines") && told.message.contains(why),
            "{told:?}"
        );
        assert!(build.outputs[0].target.as_ref().expect("a target").nurbs.is_empty(), "{post}");
    }
}

#[test]
fn a_curve_that_bends_too_deep_or_too_high_is_found() {
    let build = build_for("mitsubishi", "ZIGZAG, U, NURBS, CUSP, 0.02");
    let cl = build.cl.as_ref().expect("CL");
    let curves = build.outputs[0].target.as_ref().expect("a target").nurbs.len();
    for n in [0, curves / 3, curves - 1] {
        for (steps, code) in [(-60, "E0820"), (60, "E0821")] {
            let mut target = build.outputs[0].target.clone().expect("a target");
            let points = &mut target.nurbs[n].points;
            let middle = points.len() / 2;
            points[middle].0.z += steps;
            let found = refused_for("mitsubishi", cl, &target);
            assert!(found.contains(&code), "{n} {steps}: {found:?}");
        }
    }
}

/// The program with another net in place of its own.
fn with_net(operation: &str, net: &str) -> Build {
    let text = program(operation);
    let (first, tool) = (text.find("N1 =").expect("a net"), text.find("T1 =").expect("a cutter"));
    let mut files = MemoryFiles::default();
    files.0.insert("part.apt".to_owned(), format!("{}{net}{}", &text[..first], &text[tool..]));
    let build = driver::build("part.apt", &files, &Options::default());
    assert!(!build.has_errors(), "{operation}: {:#?}", build.diagnostics);
    build
}

/// A banana: lines of constant y near its ends meet both tips and nothing between them.
const BANANA: &str = "N1 = NET/ 4, 4, (0, 0, 0), (0, 8, 1), (0, 16, 2), (0, 24, 0), $\n\
                      (12, 16, 1), (12, 24, 4), (12, 32, 3), (12, 40, 2), $\n\
                      (24, 16, 2), (24, 24, 3), (24, 32, 5), (24, 40, 1), $\n\
                      (36, 0, 0), (36, 8, 2), (36, 16, 1), (36, 24, 0)\n";

#[test]
fn plan_passes_over_a_hollow_outline_run_in_stretches() {
    for along in ["X", "Y"] {
        let build = with_net(&format!("ZIGZAG, {along}, CUSP, 0.03"), BANANA);
        let proof = proof(&build);
        assert!(proof.into.value <= 1e-6 && proof.out.value <= 0.01 + 1e-6, "{along}: {proof:?}");
        assert!(proof.cusp.expect("cusps").value <= 0.0301, "{along}: {proof:?}");
        let records = &build.cl.as_ref().expect("CL").records;
        let passes: Vec<bool> = records
            .iter()
            .filter_map(|r| if let RecordKind::Pass(p) = &r.kind { Some(p.link) } else { None })
            .collect();
        let links = passes.iter().filter(|link| **link).count();
        assert_eq!(passes.len() - links, proof.passes as usize, "{along}: links are no passes");
        // Lines along x are in two parts where they meet the tips.
        assert!(
            along == "Y" || links + 1 < proof.passes as usize,
            "{links} links of {} passes",
            proof.passes
        );
    }
}

#[test]
fn the_first_and_the_last_pass_lie_half_a_distance_inside() {
    let plane = "N1 = NET/ 2, 2, (0, 0, 0), (0, 19.5, 0), (30, 0, 0), (30, 19.5, 0)\n";
    let passes = |along: &str| {
        let build = with_net(&format!("ONEWAY, {along}, CUSP, 0.02"), plane);
        let records = &build.cl.as_ref().expect("CL").records;
        records.iter().filter(|r| matches!(r.kind, RecordKind::Pass(_))).count()
    };
    // 19.5 mm at no more than 2 sqrt(0.02 (6 - 0.02)) mm take 29 passes; with one on either border it were 30.
    for along in ["U", "X", "CONST"] {
        assert_eq!(passes(along), 29, "{along}");
    }
}

#[test]
fn a_smaller_height_of_cusps_takes_more_passes() {
    let passes = |h: &str| proof(&build(&format!("ONEWAY, U, CUSP, {h}"))).passes;
    let (coarse, fine) = (passes("0.04"), passes("0.01"));
    assert!(fine > coarse * 9 / 5 && fine < coarse * 23 / 10, "{coarse} {fine}");
}

#[test]
fn one_roughing_pass_leaves_what_it_is_asked_to_leave() {
    let mut files = MemoryFiles::default();
    let text = program("U").replace("SURFAC/ N1, U", "ROUGH/ N1, OFFSET, 0.5, CUSP, 0.02");
    let blank = "B1 = STOCK/ BLOCK, (0, 0, -20), (30, 24, 2)\nLOADTL/";
    files.0.insert("part.apt".to_owned(), text.replace("LOADTL/", blank));
    let build = driver::build("part.apt", &files, &Options::default());
    assert!(!build.has_errors(), "{:#?}", build.diagnostics);
    let said: Vec<&str> = build.diagnostics.iter().map(|d| d.code.id).collect();
    assert_eq!(said, ["W0532"], "the blank stands 6.1 mm deep, and the ball has 6 mm");
    let proof = proof(&build);
    assert!(proof.leave == 0.5 && proof.into.value <= 1e-6 && proof.out.value <= 0.01 + 1e-6, "{proof:?}");
    assert!(proof.left_bound <= 0.02 + 0.011, "{proof:?}");
}

#[test]
fn a_ball_that_does_not_fit_is_lifted_and_says_what_stays() {
    let mut files = MemoryFiles::default();
    files.0.insert("part.apt".to_owned(), program("U, STEP, 2").replace("BALL, 6", "BALL, 40"));
    let build = driver::build("part.apt", &files, &Options::default());
    assert!(build.diagnostics.iter().any(|d| d.code.id == "W0541"), "{:#?}", build.diagnostics);
    let proof = proof(&build);
    assert!(proof.into.value <= 1e-6, "{proof:?}");
    assert!(proof.unreachable.expect("material stays").value > 0.05);
}

/// Codes that come when some vertices of passes, by their number, are moved in z by so many steps of the grid.
fn bent(build: &Build, moved: &[(usize, i64)]) -> Vec<&'static str> {
    let (cl, mut target) =
        (build.cl.as_ref().expect("CL"), build.outputs[0].target.clone().expect("a target"));
    for (n, steps) in moved {
        *passes(cl, &mut target).nth(*n).expect("a vertex") += steps;
    }
    refused(cl, &target)
}

/// Codes with which the proof of a program fails.
pub(super) fn refused(cl: &Cl, target: &TargetProgram) -> Vec<&'static str> {
    refused_for("linuxcnc", cl, target)
}

fn refused_for(post: &str, cl: &Cl, target: &TargetProgram) -> Vec<&'static str> {
    let dialect = load(post, &MemoryFiles::default(), &mut SourceMap::default()).expect("a post");
    let written = write(&dialect, target, &cl.origins).expect("a text");
    let emitted = Emitted { text: written.text, lines: written.lines };
    let mut sink = Sink::default();
    assert!(prove(cl, target, emitted, dialect.control(), &mut sink).is_none());
    sink.items().iter().map(|d| d.code.id).collect()
}

fn passes<'t>(cl: &'t Cl, target: &'t mut TargetProgram) -> impl Iterator<Item = &'t mut i64> {
    target.blocks.iter_mut().filter_map(|block| {
        let record = cl.records.get(block.record? as usize)?;
        match (&record.kind, &mut block.kind) {
            (RecordKind::Pass(_), BlockKind::Motion(Motion::Line { to, .. })) => Some(&mut to.z),
            _ => None,
        }
    })
}

#[test]
fn a_vertex_too_deep_or_too_high_is_found() {
    let build = build("ZIGZAG, U, CUSP, 0.02");
    for n in [5, 60, 150] {
        assert!(bent(&build, &[(n, -200)]).contains(&"E0820"), "{n}");
        assert!(bent(&build, &[(n, 200)]).contains(&"E0821"), "{n}");
    }
}

#[test]
fn cutters_with_a_flat_or_a_cone_keep_their_band() {
    for cutter in ["FLAT, 6", "BULL, 6, 1", "TAPER, 4, 0.5, ANGLE, 6"] {
        for along in ["U", "Y"] {
            let text = program(&format!("ZIGZAG, {along}, STEP, 4")).replace("BALL, 6", cutter);
            let mut files = MemoryFiles::default();
            files.0.insert("part.apt".to_owned(), text);
            let build = driver::build("part.apt", &files, &Options::default());
            assert!(!build.has_errors(), "{cutter} {along}: {:#?}", build.diagnostics);
            let proof = proof(&build);
            assert!(
                proof.into.value <= 1e-6 && proof.out.value <= 0.01 + 1e-6,
                "{cutter} {along}: {proof:?}"
            );
            assert!(proof.out.value > 0.005 && proof.cusp.is_none(), "{cutter} {along}: {proof:?}");
            assert!(proof.left.value <= proof.left_bound, "{cutter} {along}: {proof:?}");
            for (low, high) in [(3, 20), (20, 3)] {
                let found = bent(&build, &[(low, -400), (high, 600)]);
                assert!(
                    found.contains(&"E0820") && found.contains(&"E0821"),
                    "{cutter} {along} {low}: {found:?}"
                );
            }
        }
    }
}

/// A small crown, finished with another cutter than a ball.
fn crowned(cutter: &str, operation: &str) -> Build {
    let net = "N1 = NET/ 3, 3, (0, 0, 0), (0, 7, 2), (0, 14, 1), (9, 0, 2), (9, 7, 5), (9, 14, 2), \
               (18, 0, 0), (18, 7, 3), (18, 14, 1)\n";
    finished(net, cutter, operation)
}

/// A net finished with another cutter than a ball.
fn finished(net: &str, cutter: &str, operation: &str) -> Build {
    let text = program(operation).replace("BALL, 6", cutter);
    let (from, to) = (text.find("N1 =").expect("a net"), text.find("T1 =").expect("a cutter"));
    let mut files = MemoryFiles::default();
    files.0.insert("part.apt".to_owned(), format!("{}{net}{}", &text[..from], &text[to..]));
    driver::build("part.apt", &files, &Options::default())
}

#[test]
fn lines_of_cutters_with_a_flat_run_in_stretches_over_a_hollow_outline() {
    let build = finished(BANANA, "BULL, 4, 1", "ZIGZAG, X, STEP, 2");
    assert!(!build.has_errors(), "{:#?}", build.diagnostics);
    let proof = proof(&build);
    assert!(proof.into.value <= 1e-6 && proof.out.value <= 0.01 + 1e-6, "{proof:?}");
    let across = |pass: &crate::cl::Pass| match pass.track.guide {
        crate::geom::surface::Guide::Line { from, .. } if !pass.link => Some(from.y),
        _ => None,
    };
    let records = &build.cl.as_ref().expect("CL").records;
    let places: Vec<f64> = records
        .iter()
        .filter_map(|r| if let RecordKind::Pass(p) = &r.kind { across(p) } else { None })
        .collect();
    let twice = places.windows(2).filter(|w| w[0] == w[1]).count();
    assert!(twice >= 3, "{places:?}");
}

#[test]
fn cutters_with_a_flat_or_a_cone_keep_the_height_of_cusps() {
    for (cutter, along) in [("FLAT, 6", "X"), ("BULL, 6, 1", "U"), ("TAPER, 4, 0.5, ANGLE, 6", "V")] {
        let [coarse, fine] = ["0.2", "0.1"].map(|h| {
            let build = crowned(cutter, &format!("ZIGZAG, {along}, CUSP, {h}"));
            assert!(!build.has_errors(), "{cutter} {along}: {:#?}", build.diagnostics);
            proof(&build)
        });
        for (proof, h) in [(&coarse, 0.2), (&fine, 0.1)] {
            assert!(
                proof.left_bound <= h + 0.01 + 1e-5 && proof.left.value > 0.5 * h,
                "{cutter} {along}: {proof:?}"
            );
            assert!(
                proof.left.value <= proof.left_bound && proof.unreachable.is_none(),
                "{cutter} {along}: {proof:?}"
            );
        }
        assert!(fine.passes > coarse.passes * 5 / 4, "{cutter} {along}: {} {}", fine.passes, coarse.passes);
    }
}

#[test]
fn what_no_path_reaches_is_told_apart_from_what_passes_leave() {
    let net = "NET/ 3, 3, (0, 0, 0), (0, 10, 0), (0, 20, 0), (15, 0, 0), (15, 10, -16), (15, 20, 0), \
               (30, 0, 0), (30, 10, 0), (30, 20, 0)";
    let job = |cutter: &str| {
        let mut files = MemoryFiles::default();
        let text = format!(
            "UNITS/ MM\nMACHIN/ LINUXCNC\nN1 = {net}\nT1 = CUTTER/ {cutter}, NUMBER, 1\nLOADTL/ T1\nSPINDL/ 6000, CLW\n\
             FEDRAT/ 900, MMPM\nOUTTOL/ 0.02\nCLEARP/ 20\nS1 = SURFAC/ N1, ZIGZAG, X, CUSP, 0.3\nFINI\n"
        );
        files.0.insert("part.apt".to_owned(), text);
        let build = driver::build("part.apt", &files, &Options::default());
        assert!(!build.has_errors(), "{cutter}: {:#?}", build.diagnostics);
        proof(&build)
    };
    let [narrow, wide] = ["BULL, 4, 1.5", "BULL, 12, 1"].map(job);
    assert!((narrow.area / wide.area - 1.0).abs() < 1e-12 && narrow.area > 600.0, "{narrow:?}");
    assert_eq!(narrow.unreachable_area, Some(0.0), "{narrow:?}");
    let [out, beside] = [wide.unreachable_area, wide.beside_area].map(|a| a.expect("an area"));
    let most = wide.unreachable.expect("material stays").value;
    assert!(out > 0.5 && out + beside < 0.5 * wide.area && most > 0.32, "{wide:?}");
}

#[test]
fn passes_that_lie_too_far_apart_for_their_cusps_are_found() {
    let build = crowned("BULL, 6, 1", "ZIGZAG, Y, CUSP, 0.05");
    let (mut cl, target) =
        (build.cl.clone().expect("CL"), build.outputs[0].target.clone().expect("a target"));
    let finish = cl.operations[0].guard.surface.as_mut().expect("a surface");
    finish.cusp = Some(0.02);
    let found = refused(&cl, &target);
    assert!(found.iter().all(|code| *code == "E0821"), "{found:?}");
}
