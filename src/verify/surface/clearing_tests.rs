//! Roughing in levels, from source to proof.

use super::tests::refused;
use crate::driver::{self, Build, Options};
use crate::source::MemoryFiles;

/// A net, roughed from a block.
fn roughed(net: &str, block: &str, cutter: &str, options: &str) -> Build {
    let mut files = MemoryFiles::default();
    let text = format!(
        "UNITS/ MM\nMACHIN/ LINUXCNC\nN1 = NET/ 4, 4, {net}\nB1 = STOCK/ BLOCK, {block}\n\
         T1 = CUTTER/ {cutter}, NUMBER, 1\nLOADTL/ T1\nSPINDL/ 8000\nFEDRAT/ 800\nINTOL/ 0\nOUTTOL/ 0.01\nCLEARP/ 30\n\
         R1 = ROUGH/ N1, LEVELS, STOCK, B1, {options}\nFINI\n"
    );
    files.0.insert("part.apt".to_owned(), text);
    driver::build("part.apt", &files, &Options::default())
}

const CAVITY: &str = "(0, 0, 0), (0, 16, 0), (0, 32, 0), (0, 48, 0), $\n\
    (20, 0, 0), (20, 16, -52), (20, 32, -46), (20, 48, 0), $\n\
    (40, 0, 0), (40, 16, -44), (40, 32, -56), (40, 48, 0), $\n\
    (60, 0, 0), (60, 16, 0), (60, 32, 0), (60, 48, 0)";
const DOME: &str = "(0, 0, 0), (0, 20, 4), (0, 40, 4), (0, 60, 0), $\n\
    (20, 0, 4), (20, 20, 16), (20, 40, 16), (20, 60, 4), $\n\
    (40, 0, 4), (40, 20, 16), (40, 40, 16), (40, 60, 4), $\n\
    (60, 0, 0), (60, 20, 4), (60, 40, 4), (60, 60, 0)";

fn cleared(build: &Build) -> crate::verify::ClearingProof {
    assert!(!build.has_errors(), "{:#?}", build.diagnostics);
    let proven = build.outputs[0].proven.as_ref().expect("a proven program");
    let operation = &proven.certificate().operations[0];
    assert!(operation.into.expect("a depth").value <= 1e-6);
    operation.clearing.clone().expect("a clearing")
}

#[test]
fn a_cavity_is_cleared_in_levels_and_keeps_its_allowance() {
    let proof =
        cleared(&roughed(CAVITY, "(0, 0, -40), (60, 48, 0)", "BALL, 10", "STEP, 2, WIDTH, 3, LEAVE, 0.5"));
    assert!(proof.left >= 0.5 - 1e-6 && proof.levels.len() == 14, "{proof:?}");
    assert!(proof.bound > 2900.0 && proof.cut < 1.9 * proof.bound, "{proof:?}");
    assert!(proof.air < 0.03 * proof.cut, "{proof:?}");
}

#[test]
fn a_crown_is_entered_from_beside_its_block() {
    for block in ["(0, 0, -5), (60, 60, 9)", "(-2, -2, -5), (62, 62, 12)"] {
        let build = roughed(DOME, block, "BALL, 10", "STEP, 2, WIDTH, 3, LEAVE, 0.5");
        let proof = cleared(&build);
        assert!(proof.left >= 0.5 - 1e-6 && proof.cut < 2.2 * proof.bound, "{proof:?}");
        assert!(proof.air < 0.05 * proof.cut, "{proof:?}");
        assert!(!build.diagnostics.iter().any(|d| d.code.id == "N0524"), "{:#?}", build.diagnostics);
    }
}

#[test]
fn a_crown_in_a_large_block_is_entered_by_a_ramp() {
    let proof =
        cleared(&roughed(DOME, "(-20, -20, -5), (80, 80, 12)", "BALL, 10", "STEP, 3, LEAVE, 0.5, CONVEN"));
    assert!(proof.left >= 0.5 - 1e-6 && proof.levels.len() > 3, "{proof:?}");
}

#[test]
fn a_blank_below_the_surface_leaves_nothing_to_clear() {
    let build = roughed(DOME, "(0, 0, -20), (60, 60, -5)", "BALL, 10", "STEP, 2");
    assert!(build.diagnostics.iter().any(|d| d.code.id == "E0546"), "{:#?}", build.diagnostics);
}

const PIT: &str = "(0, 0, 0), (0, 8, 0), (0, 16, 0), (0, 24, 0), $\n\
    (9, 0, 0), (9, 8, -26), (9, 16, -22), (9, 24, 0), $\n\
    (18, 0, 0), (18, 8, -21), (18, 16, -27), (18, 24, 0), $\n\
    (27, 0, 0), (27, 8, 0), (27, 16, 0), (27, 24, 0)";

#[test]
fn cutters_of_every_form_clear_levels_and_keep_the_allowance() {
    for cutter in ["FLAT, 6", "BULL, 6, 1", "TAPER, 5, 1, ANGLE, 5"] {
        let proof =
            cleared(&roughed(PIT, "(0, 0, -16), (27, 24, 0)", cutter, "STEP, 5, WIDTH, 4, LEAVE, 0.5"));
        // The plan's own margin is 0.03.
        assert!((0.5 - 1e-6..0.54).contains(&proof.left), "{cutter}: {proof:?}");
        assert!(proof.cut > 0.9 * proof.bound && proof.cut < 6.0 * proof.bound, "{cutter}: {proof:?}");
        assert!(proof.air < 0.08 * proof.cut, "{cutter}: {proof:?}");
    }
}

#[test]
fn what_another_cutter_may_a_flat_one_may_not() {
    // The path of a ball, driven by a flat cutter of the same diameter.
    let build = roughed(PIT, "(0, 0, -16), (27, 24, 0)", "BALL, 6", "STEP, 9, WIDTH, 6, LEAVE, 0.5");
    let (mut cl, target) =
        (build.cl.clone().expect("CL"), build.outputs[0].target.clone().expect("a target"));
    let finish = cl.operations[0].guard.surface.as_mut().expect("a surface");
    finish.cutter = crate::geom::surface::Cutter::bull(3.0, 0.0);
    let found = refused(&cl, &target);
    assert!(!found.is_empty() && found.contains(&"E0820"), "{found:?}");
}

/// Rapids of a build, and the places at which cuts at its first level end, in order.
fn moves_of(build: &Build) -> (Vec<crate::geom::Point3>, Vec<crate::geom::Point3>) {
    use crate::cl::RecordKind;
    let cl = build.cl.as_ref().expect("CL");
    let first = cl.operations[0].guard.clearing.as_ref().expect("levels").levels[0].z;
    let (mut rapids, mut cuts) = (Vec::new(), Vec::new());
    for record in &cl.records {
        match &record.kind {
            RecordKind::Rapid(p) => rapids.push(*p),
            RecordKind::Linear(p) if (p.z - first).abs() < 1e-9 => cuts.push(*p),
            RecordKind::Circle(c) if (c.to.z - first).abs() < 1e-9 => cuts.push(c.to),
            _ => {}
        }
    }
    (rapids, cuts)
}

#[test]
fn the_cutter_stays_low_between_cuts() {
    let blocks = [(CAVITY, "(0, 0, -40), (60, 48, 0)", 2.0), (DOME, "(0, 0, -5), (60, 60, 11)", 13.0)];
    for (net, block, safe) in blocks {
        for cutter in ["BALL, 10", "FLAT, 10"] {
            let build = roughed(net, block, cutter, "STEP, 3, WIDTH, 4, LEAVE, 0.5");
            cleared(&build);
            let (rapids, _) = moves_of(&build);
            let high = rapids.iter().filter(|p| (p.z - safe).abs() < 1e-9).count();
            // Down once and up once.
            assert!(high <= 4 && rapids.len() > 12, "{cutter}: {high} of {}", rapids.len());
        }
    }
}

#[test]
fn levels_go_inwards_or_outwards_as_they_are_told() {
    let middle = crate::geom::Point2::new(30.0, 30.0);
    let jobs = [(CAVITY, "(0, 0, -20), (60, 48, 0)", "OUT"), (DOME, "(0, 0, -5), (60, 60, 11)", "IN")];
    for (net, block, usual) in jobs {
        let ways = ["IN", "OUT", ""].map(|word| {
            let options = format!("STEP, 4, WIDTH, 4, LEAVE, 0.5, {word}");
            let build = roughed(net, block, "BALL, 10", options.trim_end_matches([',', ' ']));
            cleared(&build);
            moves_of(&build).1
        });
        // How far from the middle a level begins and ends.
        let ends =
            |cuts: &[crate::geom::Point3]| [cuts[0], cuts[cuts.len() - 1]].map(|p| (p.xy() - middle).norm());
        let [inward, outward, without] = ways.each_ref().map(|cuts| ends(cuts));
        assert!(inward[1] < inward[0] && outward[1] > outward[0] + 2.0, "{inward:?} {outward:?}");
        assert_eq!(without, if usual == "IN" { inward } else { outward });
    }
}

/// Area that stands at all levels together, mm².
fn standing(build: &Build) -> f64 {
    cleared(build).levels.iter().map(|level| level.standing).sum()
}

#[test]
fn passes_as_wide_as_the_cutter_leave_nothing_between_them() {
    let jobs = [
        (CAVITY, "(0, 0, -16), (60, 48, 0)", "BALL, 10", "STEP, 4, WIDTH, 9, LEAVE, 0.5"),
        (CAVITY, "(0, 0, -16), (60, 48, 0)", "FLAT, 10", "STEP, 4, WIDTH, 9.5, LEAVE, 0.5"),
        (DOME, "(0, 0, -5), (60, 60, 11)", "BULL, 10, 1", "STEP, 4, WIDTH, 9, LEAVE, 0.5"),
        (PIT, "(0, 0, -16), (27, 24, 0)", "TAPER, 5, 1, ANGLE, 5", "STEP, 5, WIDTH, 5, LEAVE, 0.5"),
    ];
    for (net, block, cutter, options) in jobs {
        let build = roughed(net, block, cutter, options);
        assert!(standing(&build) < 0.3, "{cutter}: {:?}", cleared(&build).levels);
        assert!(
            !build.diagnostics.iter().any(|d| d.code.id == "W0533"),
            "{cutter}: {:#?}",
            build.diagnostics
        );
    }
}

#[test]
fn what_stands_and_was_not_told_is_refused() {
    let build = roughed(CAVITY, "(0, 0, -8), (60, 48, 0)", "BALL, 10", "STEP, 4, WIDTH, 9, LEAVE, 0.5");
    let (mut cl, target) =
        (build.cl.clone().expect("CL"), build.outputs[0].target.clone().expect("a target"));
    // At half the depth the ball is narrower than its passes are apart.
    let clearing = cl.operations[0].guard.clearing.as_mut().expect("levels");
    clearing.step = 2.0;
    let found = refused(&cl, &target);
    assert!(!found.is_empty() && found.iter().all(|id| *id == "E0821"), "{found:?}");
}

#[test]
fn one_roughing_pass_is_proven_with_every_cutter() {
    for cutter in ["BALL, 8", "FLAT, 6", "BULL, 8, 2", "TAPER, 5, 1, ANGLE, 5"] {
        for along in ["U", "Y"] {
            let mut files = MemoryFiles::default();
            let text = format!(
                "UNITS/ MM\nMACHIN/ LINUXCNC\nN1 = NET/ 4, 4, {PIT}\nT1 = CUTTER/ {cutter}, NUMBER, 1\nLOADTL/ T1\n\
                 SPINDL/ 8000\nFEDRAT/ 800\nINTOL/ 0\nOUTTOL/ 0.05\nCLEARP/ 30\n\
                 R1 = ROUGH/ N1, OFFSET, 0.5, {along}, STEP, 3\nFINI\n"
            );
            files.0.insert("part.apt".to_owned(), text);
            let build = driver::build("part.apt", &files, &Options::default());
            assert!(!build.has_errors(), "{cutter} {along}: {:#?}", build.diagnostics);
            let proven = build.outputs[0].proven.as_ref().expect("a proven program");
            let proof = proven.certificate().operations[0].surface.clone().expect("a surface");
            assert!(proof.leave == 0.5 && proof.passes > 4, "{cutter} {along}: {proof:?}");
            assert!(
                proof.into.value <= 1e-6 && proof.out.value <= 0.05 + 1e-6,
                "{cutter} {along}: {proof:?}"
            );
            // In the middle of passes what is left stays, and no less anywhere.
            assert!(proof.left.value >= 0.0 && proof.left.value < 4.0, "{cutter} {along}: {proof:?}");
        }
    }
}
