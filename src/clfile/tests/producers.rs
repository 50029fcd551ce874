//! Every producer's forms, in files of our own.

use super::{framed, kinds, read, read_as};
use crate::cl::{Circle, Cl, Cycle, CycleKind, RecordKind, RetractTo};
use crate::clfile::{Producer, recognise};
use crate::geom::{Point3, Side};

fn circles(cl: &Cl) -> Vec<Circle> {
    cl.records
        .iter()
        .filter_map(|r| if let RecordKind::Circle(c) = &r.kind { Some(**c) } else { None })
        .collect()
}

fn near(a: Point3, b: [f64; 3]) -> bool {
    (a - Point3::from(b)).norm() < 1e-6
}

#[test]
fn files_are_recognised_by_name_and_by_content() {
    assert_eq!(recognise("a.cls", ""), Some(Producer::Nx));
    assert_eq!(recognise("a.nci", ""), Some(Producer::Mastercam));
    assert_eq!(recognise("a.apt", "PARTNO/X\nUNIT/MM\nCUTTER/10\n"), Some(Producer::SolidWorks));
    assert_eq!(recognise("a.txt", "$$* Pro/CLfile  Version\n"), Some(Producer::Creo));
    assert_eq!(recognise("a.aptsource", "$$ CATIA APT VERSION 1.0\n$$*CATIA0\n"), Some(Producer::Catia));
    assert_eq!(recognise("a.apt", "PARTNO X\nAUTOPS\nINDIRV/1,0,0\n"), Some(Producer::Catia));
    assert_eq!(recognise("a.txt", "N10 , CUTTER/ 10\nN11 , GOTO/ 1,2,3\n"), Some(Producer::Ncl));
    let bare = "PARTNO A=B\nUNITS/ MM\nloadtl / 1\nCUTTER/ 5\nGOTO/ 1, 2, 3\n";
    assert_eq!(recognise("a.apt", bare), Some(Producer::Plain));
    for program in ["T1 = CUTTER/ 5, NUMBER, 1\n", "INCLUD/ tools.inc\n"] {
        assert_eq!(recognise("a.apt", &format!("{program}{bare}")), None);
    }
    assert_eq!(recognise("a.apt", "LOADTL/ 1\nGOTO/ P1\n"), None);
    // All points of an arc behind its record, and an arc with a polygon's corners behind it.
    let circle = "UNITS/MM\nGOTO/10,0,0\nCIRCLE/0,0,0,0,0,1, $\n10\n";
    let close = "GOTO/9.6593,2.5882,0\nGOTO/8.6603,5,0\ngoto/ 7.0711, 7.0711, 0\n";
    assert_eq!(recognise("a.cl", &format!("{circle}{close}")), Some(Producer::Ncl));
    assert_eq!(recognise("a.txt", &format!("{circle}{close}")), Some(Producer::Ncl));
    let corners = "GOTO/0,10,0\nGOTO/-10,0,0\nGOTO/0,-10,0\nGOTO/10,0,0\n";
    assert_eq!(recognise("a.cl", &format!("{circle}{corners}")), Some(Producer::Plain));
    let cut = "GOTO/9.6593,2.5882,0\nFEDRAT/9\nGOTO/8.6603,5,0\nGOTO/7.0711,7.0711,0\n";
    assert_eq!(recognise("a.cl", &format!("{circle}{cut}")), Some(Producer::Plain));
    assert_eq!(recognise("a.apt", "MACHIN/X\nMODE/MILL\nPARTNO/'1'\n"), Some(Producer::Plain));
    assert_eq!(recognise("a.apt", "T1 = CUTTER/ FLAT, 16\nLOADTL/ T1\n"), None);
}

#[test]
fn nx_helices_turns_and_lines_without_goto() {
    let (cl, codes) = read(
        "TOOL PATH/POCKET_1,TOOL,MILL_10\nTLDATA/MILL,10.0,0.0,50.0,0.0,0.0\nMSYS/0,0,0,1,0,0,0,1,0\n\
         $$ centerline data\nPAINT/PATH\nLOAD/TOOL,3,ADJUST,3\nSPINDL/RPM,2000,CLW\nPAINT/COLOR,186\nRAPID\n\
         GOTO/10.0,0.0,2.0,0.0,0.0,1.0\nFEDRAT/MMPM,300.0\nGOTO/10.0,0.0,0.0\n\
         CIRCLE/0.0,0.0,0.0,0.0,0.0,1.0,10.0,0.06,0.5,10.0,0.0,TIMES,3\nGOTO/0.0,10.0,-3.0\nGOTO/-5.0,10.0,-3.0\n\
         -6.0,10.0,-3.0\n-7.0,11.0,-3.0\nEND-OF-PATH\n",
    );
    assert_eq!(codes, [""; 0]);
    assert_eq!(kinds(&cl), "RLCLLL");
    let circle = circles(&cl)[0];
    assert_eq!((circle.turns, circle.to), (2, Point3::new(0.0, 10.0, -3.0)));
    assert_eq!(cl.operations[0].name, "POCKET_1");
    let (_, tool) = cl.tools.iter().next().unwrap();
    assert_eq!((tool.name.as_str(), tool.number, tool.diameter), ("MILL_10", Some(3), 10.0));
}

#[test]
fn nx_curves_start_where_the_tool_is_and_keep_their_knots() {
    let straight = "NURBS/\nKNOT/1.0\nCNTRL/10,1,5\nCNTRL/10,2,5\nCNTRL/10,3,5\nPAINT/COLOR,31\nGOTO/0,0,5";
    let (cl, codes) = read_as(&framed(straight), Some(Producer::Nx), false);
    assert_eq!((kinds(&cl).as_str(), codes.as_slice()), ("RSL", [""; 0].as_slice()));
    let bent = "NURBS/\nKNOT/0.25\nKNOT/0.5,1.0\nCNTRL/10,5,5\nCNTRL/20,5,5\nCNTRL/20,20,6\nCNTRL/25,25,5\nCNTRL/30,30,5";
    let (cl, _) = read_as(&framed(bent), Some(Producer::Nx), false);
    let spline =
        cl.records.iter().find_map(|r| if let RecordKind::Spline(s) = &r.kind { Some(s) } else { None });
    let spline = spline.expect("a spline");
    assert_eq!(
        (spline.points()[0], spline.end()),
        (Point3::new(10.0, 0.0, 5.0), Point3::new(30.0, 30.0, 5.0))
    );
    assert_eq!(spline.knots(), [0.0, 0.0, 0.0, 0.0, 0.25, 0.5, 1.0, 1.0, 1.0, 1.0]);
    // A curve of no length moves nothing.
    let (cl, codes) =
        read_as(&framed("NURBS/\nKNOT/1\nCNTRL/10,0,5\nCNTRL/10,0,5\nCNTRL/10,0,5"), None, false);
    assert_eq!((kinds(&cl).as_str(), codes.as_slice()), ("R", [""; 0].as_slice()));
}

#[test]
fn catia_arcs_end_on_lines_and_go_the_way_of_the_tangent() {
    let arc = |order: &str, direction: &str| {
        let body = format!(
            "AUTOPS\nINDIRV/ {direction}\nTLON,GOFWD/ (CIRCLE/ 0.0, 0.0, 5.0,$\n 10.0),ON,{order}(LINE/ 0.0, 0.0, 5.0,$\n 0.0, 10.0, 5.0)\nGOTO / 0, 0, 5"
        );
        let (cl, codes) = read_as(&framed(&body), Some(Producer::Catia), false);
        assert_eq!(codes, [""; 0]);
        circles(&cl)[0]
    };
    let quarter = arc("", "0.0, 1.0, 0.0");
    assert!(near(quarter.to, [0.0, 10.0, 5.0]) && quarter.axis.z > 0.0);
    let most = arc("2,INTOF,", "0.0, 1.0, 0.0");
    assert!(near(most.to, [0.0, -10.0, 5.0]) && most.axis.z > 0.0);
    let back = arc("", "0.0, -1.0, 0.0");
    assert!(near(back.to, [0.0, -10.0, 5.0]) && back.axis.z < 0.0);
}

#[test]
fn catia_full_circles_and_helices() {
    let full =
        "AUTOPS\nINDIRV/ 0, 1, 0\nTLON,GOFWD/ (CIRCLE/ 0, 0, 5, 10),ON,2,INTOF,(LINE/ 0, 0, 5, 10, 0, 5)";
    let (cl, codes) = read_as(&framed(full), Some(Producer::Catia), false);
    assert_eq!(codes, [""; 0]);
    assert!(near(circles(&cl)[0].to, [10.0, 0.0, 5.0]));
    // As printed, start, centre and line are a little off each other; it is a full circle all the same.
    for (x, end) in [("10.00001", "9.99999, 0.00002"), ("9.99999", "10.00001, -0.00002")] {
        let arc = format!("(CIRCLE/ 0, 0, 5, 10.00001),ON,2,INTOF,(LINE/ 0, 0, 5, {end}, 5)");
        let full = format!("INDIRV/ 0, 1, 0\nTLON,GOFWD/ {arc}");
        let full = format!("GOTO/ {x}, 0, 5\n{full}\n{full}");
        let (cl, codes) = read_as(&framed(&full), Some(Producer::Catia), false);
        assert_eq!(codes, [""; 0]);
        let start: f64 = x.parse().unwrap();
        assert!(circles(&cl).iter().all(|c| c.to == Point3::new(start, 0.0, 5.0)));
    }
    let helix = "HELICAL/ 0, 0, 5, 0, 1, 0, 0, 0, 1, 2, 10, 10, 0, 0";
    let (cl, codes) = read_as(&framed(helix), Some(Producer::Catia), false);
    // 5 mm down at 2 mm a turn: two whole turns, and the end is over the start.
    assert_eq!((codes.as_slice(), circles(&cl)[0].turns), ([""; 0].as_slice(), 2));
}

#[test]
fn creo_metadata_and_many_points_on_an_arc() {
    let (cl, codes) = read(
        "$$*         Pro/CLfile  Version\n$$-> MFGNO / PART\nPARTNO / PART\n$$-> FEATNO / 12\nMACHIN / UNCX01, 1\n\
         UNITS / MM\nLOADTL / 4\n$$-> CUTTER / 12.000000\n$$-> CSYS / 1.0, 0.0, 0.0, 0.0, $\n 0.0, 1.0, 0.0, 0.0, $\n 0.0, 0.0, 1.0, 0.0\n\
         SPINDL / RPM, 1500.000000,  CLW\nRAPID\nGOTO / 10.0, 0.0, 5.0\nFEDRAT / 250.0,  MMPM\nGOTO / 10.0, 0.0, 0.0\n\
         CIRCLE / 0.0, 0.0, 0.0, $\n 0.0, 0.0, 1.0, 10.0\nGOTO / 7.0710678119, 7.0710678119, 0.0\nGOTO / 0.0, 10.0, 0.0\n\
         GOTO / -20.0, 10.0, 0.0\n$$-> END /\nFINI\n",
    );
    assert_eq!(codes, [""; 0]);
    assert_eq!(kinds(&cl), "RLCL");
    let (_, tool) = cl.tools.iter().next().unwrap();
    assert_eq!((tool.number, tool.diameter), (Some(4), 12.0));
}

#[test]
fn the_points_tell_the_sense_of_an_arc_of_many_points() {
    let body = "GOTO/10,0,0\nCIRCLE/0,0,0,0,0,1,10\nGOTO/7.0710678119,-7.0710678119,0\nGOTO/0,-10,0";
    let (cl, _) = read_as(&framed(body), Some(Producer::Ncl), false);
    assert!(circles(&cl)[0].axis.z < 0.0);
}

#[test]
fn solidworks_circles_without_radius_and_inserts_as_comments() {
    let (cl, codes) = read(
        "PARTNO/1\nUNIT/MM\nINSERT/[HOLDER=A] 10MM END MILL\nCUTTER/10.,0,5.,0,0,0,40.\nLOAD/TOOL,2\nCSI_SET_FLUTE_LENGTH/20.\n\
         COOLNT/FLOOD\nSPINDL/3000,RPM,CLW\nTRNTYP/WORLD,0,0,0\nCSYS/1.,0,0,0,0,1.,0,0,0,0,1.,0\nRAPID/\nGOTO/.5,0,25.\n\
         FEDRAT/200.,MMPM\nGOTO/.5,0,-1.\nCIRCLE/0,0,-1.,0,0,-1.\nGOTO/-.5,0,-1.\nFINI\n",
    );
    assert_eq!(codes, [""; 0]);
    assert_eq!(kinds(&cl), "RLC");
    assert!(cl.records.iter().any(|r| matches!(&r.kind, RecordKind::Comment(t) if t.contains("END MILL"))));
    assert!(!cl.records.iter().any(|r| matches!(r.kind, RecordKind::Insert(_))));
}

#[test]
fn ncl_line_numbers_and_tildes() {
    let (cl, codes) = read(
        "N1 , UNITS/ MM\nN2 , LOADTL/ 1\nN3 , SPINDL/ 800, ~\n CLW\nN4 , FEDRAT/ 100, MMPM\nN5 , RAPID\nN6 , GOTO/ 0, 0, 5\n\
         N7 , GOTO/ 1, 0, 5\n GOTO/ 2, 0, 5\nN8 , FINI\n",
    );
    assert_eq!(codes, [""; 0]);
    assert_eq!(kinds(&cl), "RLL");
}

#[test]
fn ncl_continuation_records_and_comments_behind_numbers() {
    let (cl, codes) = read(
        "N1 , LOADTL/ 1\nN2 , CUTTER/ 12\nC2 , CUTTER/ DISPLY, SHANK, 10, 40\nN3 , SPINDL/ 800, CLW\nN4 , FEDRAT/ 100\n\
         N5 , RAPID\nN6 , GOTO/ 10, 0, 5\nN7 , $$ an arc\nN8 , CIRCLE/ 0, 0, 5, 0, 0, 1, 10\n\
         C8 , GOTO/ 7.0710678, 7.0710678, 5\nC8 , GOTO/ 0, 10, 5\nN9 , FINI\n",
    );
    assert_eq!((kinds(&cl).as_str(), codes.as_slice()), ("RC", [""; 0].as_slice()));
}

#[test]
fn mastercam_pairs() {
    let text = "1050\n9.1 0 0\n1001\n0 100 10 5 5 5 0 -1500 200. 1\n1002\n0 100 10 5 5 5 0 -1500 200. 1\n0\n0 10. 0. 5. -2. 0\n\
                1\n0 10. 0. -1. 100. 0\n3\n0 0 0. 10. -1. 0. 0. -1. 200. 0\n1003\n0\n";
    let (cl, codes) = read_as(text, Some(Producer::Mastercam), false);
    assert_eq!(codes, [""; 0]);
    assert_eq!(kinds(&cl), "RLC");
    assert!(circles(&cl)[0].axis.z > 0.0);
}

/// Tool 1 at 2000 rpm above the first hole.
fn drilled(records: &str) -> (Cl, Vec<&'static str>) {
    let text =
        format!("1002\n0 100 10 1 1 1 0 2000 300. 1\n0\n0 10. 0. 50. -2. 0\n{records}\n80\n0\n1003\n0\n");
    read_as(&text, Some(Producer::Mastercam), false)
}

fn cycles(cl: &Cl) -> Vec<Cycle> {
    let cycle = |r: &crate::cl::Record| match &r.kind {
        RecordKind::BeginCycle(cycle) => Some(**cycle),
        _ => None,
    };
    cl.records.iter().filter_map(cycle).collect()
}

#[test]
fn mastercam_holes() {
    let (cl, codes) = drilled(
        "81\n1 10. 0. -18. 0. 120. 5. 4. 0.5 0.5 50. 3. 1. 0. 10. 0. 50. 0 0\n\
         100\n0 20. 0. -18. 50. 3. 0. 120. 20. 0. 50. 0 0\n\
         100\n0 30. 5. -23. 50. 3. 0. 120. 30. 5. 50. 0 0",
    );
    assert_eq!(codes, [""; 0]);
    assert_eq!(kinds(&cl), "RBHHEBHE");
    let all = cycles(&cl);
    let first = all[0];
    assert_eq!((first.kind, first.retract), (CycleKind::Deep, RetractTo::Initial));
    assert_eq!((first.depth, first.clearance), (19.0, 2.0));
    assert_eq!((first.peck, first.first_peck), (Some(4.0), Some(5.0)));
    assert_eq!((all[1].depth, all[1].clearance, all.len()), (24.0, 2.0, 2));
}

#[test]
fn mastercam_kinds_of_holes() {
    let kind = |record: &str| {
        let (cl, codes) = drilled(record);
        cycles(&cl).first().map(|c| (c.kind, c.retract, c.dwell)).ok_or(codes)
    };
    let (low, at) = (RetractTo::Clearance, "50. 0 0");
    let hole = |kind: u8, dwell: &str, peck: &str, shift: &str| {
        format!("81\n{kind} 10. 0. -18. {dwell} 2500. {peck} 0. 0. 0. 50. 50. 0. {shift} 10. 0. {at}")
    };
    assert_eq!(kind(&hole(0, "0.", "0.", "0.")), Ok((CycleKind::Drill, low, None)));
    assert_eq!(kind(&hole(0, "0.5", "0.", "0.")), Ok((CycleKind::Dwell, low, Some(0.5))));
    assert_eq!(kind(&hole(2, "0.", "3.", "0.")), Ok((CycleKind::ChipBreak, low, None)));
    assert_eq!(
        kind(&hole(3, "0.", "0.", "0.")),
        Ok((CycleKind::Tap { pitch: 1.25, left: false }, low, None))
    );
    assert_eq!(kind(&hole(4, "0.", "0.", "0.")), Ok((CycleKind::Bore, low, None)));
    assert_eq!(kind(&hole(4, "1.", "0.", "0.")), Ok((CycleKind::BoreDwell, low, Some(1.0))));
    assert_eq!(kind(&hole(5, "0.", "0.", "0.")), Ok((CycleKind::BoreStop, low, None)));
    assert_eq!(kind(&hole(6, "0.", "0.", "0.2")), Ok((CycleKind::BoreOrient { shift: 0.2 }, low, None)));
    for refused in [hole(1, "0.", "0.", "0."), hole(6, "0.", "0.", "0."), hole(7, "0.", "0.", "0.")] {
        assert_eq!(kind(&refused), Err(vec!["E1006"]), "{refused}");
    }
    assert_eq!(kind("100\n0 20. 0. -18. 50. 3. 0. 120. 20. 0. 50. 0 0"), Err(vec!["E1006"]));
    // the bottom above the stock, heights out of order, too few numbers
    let heights = |z: &str, initial: &str, reference: &str| {
        format!("81\n0 10. 0. {z} 0. 100. 0. 0. 0. 0. {initial} {reference} 1. 0. 10. 0. {initial} 0 0")
    };
    assert_eq!(kind(&heights("2.", "50.", "3.")), Err(vec!["E1006"]));
    assert_eq!(kind(&heights("-9.", "50.", "0.")), Err(vec!["E1006"]));
    assert_eq!(kind(&heights("-9.", "2.", "3.")), Err(vec!["E1006"]));
    assert_eq!(kind("81\n0 10. 0."), Err(vec!["E1002"]));
}

#[test]
fn mastercam_holes_off_z_and_turned_planes_are_refused() {
    let (_, codes) = drilled("81\n0 10. 0. -18. 0. 120. 0. 0. 0. 0. 50. 3. 1. 0. 60. 0. -18. 0 0");
    assert_eq!(codes, ["E1004"]);
    let (_, codes) = drilled("1014\n1. 0. 0. 0. 0. 1. 0. -1. 0.");
    assert_eq!(codes, ["E1003"]);
    let (_, codes) = drilled("1014\n1. 0. 0. 0. 1. 0. 0. 0. 1.");
    assert_eq!(codes, [""; 0]);
    let (_, codes) = drilled("1\n0 10. zero -1. 100. 0");
    assert_eq!(codes, ["E1002"]);
}

#[test]
fn mastercam_compensation_of_the_control_is_that_of_its_lines() {
    let (cl, codes) = drilled("1\n41 10. 0. -1. 100. 0\n1\n0 20. 0. -1. 100. 0\n1\n40 20. 9. -1. 100. 0");
    assert_eq!(codes, [""; 0]);
    let changes: Vec<Option<Side>> = cl
        .records
        .iter()
        .filter_map(
            |r| if let RecordKind::Compensation(on) = r.kind { Some(on.map(|on| on.side)) } else { None },
        )
        .collect();
    assert_eq!(changes, [Some(Side::Left), None]);
}

#[test]
fn mastercam_swapped_ends_of_holes() {
    let (cl, codes) = drilled("81\n0 10. 0. 50. 0. 120. 0. 0. 0. 0. 50. 3. 1. 0. 10. 0. -18. 0 1");
    assert_eq!((cycles(&cl)[0].depth, codes), (19.0, vec![]));
}

#[test]
fn mastercam_arcs_of_either_sense_are_cut_and_the_start_of_the_file_has_the_first_tool() {
    let text = "1050\n9.0 by hand\n1001\n0 100 10 6 6 6 0 2000. 300. 1\n0\n0 20. 0. 5. -2. 0\n1\n0 20. 0. -1. 150. 0\n\
                3\n0 0 0. 20. -1. 0. 0. -1. 300. 0 0\n2\n0 0 20. 0. -1. 0. 0. -1. 300. 0 0\n1003\n0\n";
    let (cl, codes) = read_as(text, Some(Producer::Mastercam), false);
    assert_eq!((kinds(&cl).as_str(), codes.as_slice()), ("RLCC", [""; 0].as_slice()));
    let senses: Vec<f64> = circles(&cl).iter().map(|c| c.axis.z).collect();
    assert_eq!(senses, [1.0, -1.0]);
    assert_eq!(cl.tools.iter().map(|(_, t)| t.number).collect::<Vec<_>>(), [Some(6)]);
}

#[test]
fn mastercam_records_that_repeat_or_stop_are_refused() {
    let text =
        "1001\n0 100 10 6 6 6 0 2000. 300. 1\n0\n0 0 0 5 -2. 0\n1018\n1 0\n1025\n1 0\n1025\n0 0\n1003\n0\n";
    let (_, codes) = read_as(text, Some(Producer::Mastercam), false);
    assert_eq!(codes.iter().filter(|c| **c == "E1003").count(), 2);
}

#[test]
fn arcs_of_iso_4343_have_an_angle() {
    let arc = |angle: &str, end: &str| {
        let body = format!("MODE/MILL\nMOVARC/ 0., 0., 5., 0., 0., 1., 10., ANGLE, {angle}\nGOTO/ {end}");
        let (cl, codes) = read(&framed(&body));
        assert_eq!(codes, [""; 0]);
        (kinds(&cl), circles(&cl).first().map(|c| c.turns))
    };
    assert_eq!(arc("90.", "0, 10, 5"), ("RC".to_owned(), Some(0)));
    assert_eq!(arc("360.", "10, 0, 5"), ("RC".to_owned(), Some(0)));
    assert_eq!(arc("450.", "0, 10, 3"), ("RC".to_owned(), Some(1)));
    // The angle says the sense where the axis is that of the plane.
    let sense = |record: &str, end: &str| {
        let (cl, codes) = read(&framed(&format!(
            "MODE/MILL\nMOVARC/ 9, 0, 5, 0, 0, 1, 1, ANGLE, 360\nGOTO/ 10, 0, 5\n{record}\nGOTO/ {end}"
        )));
        (circles(&cl).iter().map(|c| c.axis.z).collect::<Vec<_>>(), codes)
    };
    assert_eq!(
        sense("MOVARC/ 0, 0, 5, 0, 0, 1, 10, ANGLE, 270", "0, 10, 5"),
        (vec![1.0, -1.0], vec!["W1011"])
    );
    assert_eq!(sense("MOVARC/ 0, 0, 5, 0, 0, 1, 10, ANGLE, -270", "0, 10, 5"), (vec![1.0, -1.0], vec![]));
    assert_eq!(
        sense("CIRCLE/ 0, 0, 5, 0, 0, 1, 10, 270, 0.0, 0.0, 0.0", "0, 10, 5"),
        (vec![1.0, -1.0], vec!["W1011"])
    );
    assert_eq!(
        sense("CIRCLE/ 0, 0, 5, 0, 0, 1, 10, 90, 0.0, 0.0, 0.0", "0, 10, 5"),
        (vec![1.0, 1.0], vec![])
    );
    assert_eq!(
        sense("MOVARC/ 0, 0, 5, 0, 0, 1, 10, ANGLE, 200", "0, 10, 5"),
        (vec![1.0, 1.0], vec!["W1011"])
    );
    let half =
        "MOVARC/ 0, 0, 5, 0, 0, 1, 10, ANGLE, 270\nGOTO/ 0, 10, 5\nMOVARC/ 0, 0, 5, 0, 0, 1, 10, ANGLE, 180";
    assert_eq!(sense(half, "0, -10, 5").0, [1.0, -1.0, -1.0]);
    // A short arc whose end is printed as its start is no full circle.
    assert_eq!(arc("0.01", "10, 0.0017, 5").0, "RL");
}
