//! Words by class, strictness, arcs that are not to be trusted, cycles.

use super::{framed, kinds, read, read_as};
use crate::cl::{CycleKind, RecordKind, RetractTo};
use crate::clfile::{Options, Producer, Reader};
use crate::ir::{Coolant, Feed, Gear, Spindle};
use crate::source::FileId;

#[test]
fn nothing_is_dropped_in_silence() {
    for (record, code) in [
        ("FOOBAR/ 1, 2", "E1001"),
        ("GOTO/ 1, 2", "E1002"),
        ("GOTO/ 1, 2, (3", "E1002"),
        ("ROTABL/ 45, CLW", "E1003"),
        ("TRANS/ 0, 0, 5", "E1003"),
        ("AUXFUN/ 77", "E1003"),
        ("GOTO/ 1, 2, 3, 0, 1, 0", "E1004"),
        ("CIRCLE/ 0, 0, 5, 0, 0, 1, 10\nGOTO/ 0, 14, 5", "E1005"),
        ("CYCLE/ DEEP, FEDTO, 20, MMPM, 120, RAPTO, 2", "E1006"),
        ("CYCLE/ DRILL, FEDTO, 20, MMPM, 120", "E1006"),
        ("CYCLE/ DRILL, 15, 200, MMPM", "E1006"),
        ("CYCLE/ DRILL, FEDTO, 20, 7, MMPM, 120, RAPTO, 2", "E1006"),
        ("CYCLE/ DRILL, 7, FEDTO, 20, MMPM, 120, RAPTO, 2", "E1006"),
        ("CYCLE/ DRILL, FEDTO, 20, MMPM, 120, RAPTO, 2, DWELL, 1E9", "E1006"),
        (
            "SPINDL/ OFF\nCYCLE/ FACE, FEDTO, 2, MMPM, 50, RAPTO, 2, DWELL, -3, REV\nSPINDL/ 900, CLW\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "E1006",
        ),
        ("CIRCLE/ 0, 0, 5, 0, 0, 1, 10, TIMES, 1E9\nGOTO/ 10, 0, 5", "E1002"),
        ("CIRCLE/ 0, 0, 5, 0, 0, 1, 10", "E1002"),
        ("CIRCLE/ 0, 0, 5, 0, 0, 1, 10\nRAPID\nGOTO/ 0, 10, 5", "E1002"),
        ("LOADTL/ 3, OSETNO, 13", "E1003"),
        ("SPINDL/ 100, SFM", "E1002"),
        (
            "CUTTER/ 6\nLOADTL/ 2\nSPINDL/ 900\nRAPID\nGOTO/ 1, 1, 9\nLOADTL/ 3\nSPINDL/ 100, SFM\nCUTTER/ 9",
            "E1002",
        ),
        (
            "CUTTER/ 6\nLOADTL/ 2\nRAPID\nGOTO/ 1, 1, 9\nLOADTL/ 3\nRAPID\nGOTO/ 1, 1, 9\nCUTTER/ 6, 1\nLOADTL/ 2\nRAPID\nGOTO/ 1, 1, 9",
            "W1020",
        ),
        ("CUTTER/ 6\nLOADTL/ 2\nRAPID\nGOTO/ 1, 1, 9\nLOADTL/ 2\nCUTTER/ 8\nGOTO/ 1, 1, 9", "W1020"),
        // Two moves at feed are no end of the tool before, and a cutter said anew was not that of the next tool.
        (
            "CUTTER/ 6\nLOADTL/ 2\nRAPID\nGOTO/ 1, 1, 9\nCUTTER/ 8\nGOTO/ 2, 1, 9\nGOTO/ 3, 1, 9\nLOADTL/ 3",
            "W1020",
        ),
        (
            "CUTTER/ 6\nLOADTL/ 2\nRAPID\nGOTO/ 1, 1, 9\nCUTTER/ 8\nRAPID\nGOTO/ 2, 1, 9\nLOADTL/ 3\nCUTTER/ 9\nRAPID\nGOTO/ 1, 1, 9",
            "W1020",
        ),
        ("SPINDL/ OFF\nGOTO/ 1, 1, 1\nGOTO/ 2, 1, 1", "E0502"),
        ("SPINDL/ 9, CCLW\nLOADTL/ 2\nSPINDL/ 90\nRAPID\nGOTO/ 1, 1, 9", "W1021"),
        ("LOADTL/ 3, OFFSET, 13", "E1003"),
        ("LOADTL/ 3, 0, 50.5, 13", "E1003"),
        ("LOADTL/ 3, 0, 50.5, 3, 13", "E1003"),
        ("TLDATA/ TURN, 0.8, 35, 30", "E1003"),
        ("FINI\nGOTO/ 1, 1, 1", "W0252"),
        ("CYCLE/ WOBBLE, FEDTO, 20, MMPM, 120, RAPTO, 2", "E1006"),
        ("NURBS/\nKNOT/ 0.5, 1.0\nCNTRL/ 1, 0, 0", "E1007"),
        ("CUTCOM/ LEFT, YZPLAN", "E1003"),
        ("CUTCOM/ ON", "E1002"),
        ("CUTCOM/ LEFT, ADJUST, 2.5", "E1002"),
        ("CUTCOM/ NORMDS", "E1003"),
        (
            "CYCLE/ DRILL, FEDTO, 9, MMPM, 50, RAPTO, 2\nGOTO/ 1, 1, 0\nCIRCLE/ 0, 1, 0, 0, 0, 1, 1\nGOTO/ -1, 1, 0\nGOTO/ 5, 1, 0",
            "E1006",
        ),
        ("TOOL PATH/FACE,TOOL,FACE_MILL\nSPINDL/500\nRAPID\nGOTO/1,1,1", "W1015"),
        ("CYCLE/ DRILL, FEDTO, 0, MMPM, 50, RAPTO, 2\nGOTO/ 1, 1, 0\nCYCLE/ OFF", "E1006"),
        ("CIRCLE/ 0, 0, 5, 0, 0, 1, 10\nGOTO/ 0, 10, 5, 1, 0, 0", "E1004"),
        ("CIRCLE/ 0, 0, 5, 0, 0, 1, 10\nGOTO/ 0, 10.05, 5", "W1011"),
    ] {
        let (_, codes) = read(&framed(record));
        assert_eq!(codes, [code], "{record}");
    }
    for silent in [
        "CUTTER/ 6\nLOADTL/ 2\nRAPID\nGOTO/ 1, 1, 9\nCUTTER/ 6\nGOTO/ 1, 2, 9\nLOADTL/ 3\nCUTTER/ 8\nRAPID\nGOTO/ 1, 1, 9",
        "LOADTL/ 2\nRAPID\nGOTO/ 1, 1, 9\nCUTTER/ 6\nGOTO/ 1, 1, 5",
        // The cutter of the next tool, before the last moves of this one.
        "CUTTER/ 6\nLOADTL/ 2\nRAPID\nGOTO/ 1, 1, 9\nCUTTER/ 8\nGOTO/ 2, 1, 9\nRAPID\nGOTO/ 2, 1, 50\nLOADTL/ 3\nRAPID\nGOTO/ 1, 1, 9",
        "SPINDL/ OFF\nRAPID\nGOTO/ 1, 1, 9",
        "SPINDL/ OFF\nSPINDL/ ON\nGOTO/ 1, 1, 9",
        "END/\nFINI/",
        "SPINDL/ 9, CCLW\nSPINDL/ 90\nGOTO/ 1, 1, 9",
        "SPINDL/ 9, CCLW\nLOADTL/ 2\nSPINDL/ 90, CLW\nRAPID\nGOTO/ 1, 1, 9\nSPINDL/ 95",
    ] {
        assert_eq!(read(&framed(silent)).1, [""; 0], "{silent}");
    }
    let (_, codes) = read("LOADTL/1\nSPINDL/1000,RPM,CLW\nFEDRAT/200,MMPM\nGOTO/0,0,50\nFINI\n");
    assert_eq!(codes, ["W1012"]);
}

#[test]
fn lenient_reading_makes_warnings_of_what_can_be_left_out() {
    use crate::diag::Severity;
    let text = framed("FOOBAR/ 1\nROTABL/ 45\nGOTO/ 20, 0, 5");
    let options = crate::clfile::Options { lenient: true, ..Default::default() };
    let (cl, sink) = crate::clfile::Reader::new(crate::source::FileId(0), "a.cl", &text, &options).whole();
    assert!(!sink.has_errors() && sink.items().iter().all(|d| d.severity == Severity::Warning));
    assert_eq!((sink.items().len(), kinds(&cl).as_str()), (2, "RL"));
}

#[test]
fn harmless_words_and_zero_shifts_pass() {
    let (_, codes) =
        read(&framed("PAINT/COLOR,31\nSEQNO/10\nTRANS/0,0,0\nSELECT/TOOL,4\nCLPRNT\nREMARK nothing"));
    assert_eq!(codes, [""; 0]);
}

#[test]
fn what_is_missing_is_said_once() {
    let (_, codes) = read("RAPID\nGOTO/0,0,5\nGOTO/1,0,5\nGOTO/2,0,5\n");
    assert_eq!(codes.len(), 3, "{codes:?}");
    let defines = [("SPINDL", "1200"), ("FEDRAT", "300"), ("LOADTL", "1"), ("UNITS", "MM")];
    let defines = defines.map(|(a, b)| (a.to_owned(), b.to_owned())).to_vec();
    let options = crate::clfile::Options { defines, ..Default::default() };
    let text = "RAPID\nGOTO/0,0,5\nGOTO/1,0,5\n";
    let (_, sink) = crate::clfile::Reader::new(crate::source::FileId(0), "a.cl", text, &options).whole();
    assert_eq!(sink.items().len(), 0, "{:?}", sink.items());
    let options =
        crate::clfile::Options { defines: vec![("SPEED".into(), "1".into())], ..Default::default() };
    let (_, sink) = crate::clfile::Reader::new(crate::source::FileId(0), "a.cl", "", &options).whole();
    assert_eq!(sink.items()[0].code.id, "E1008");
}

#[test]
fn feeds_and_speeds_in_either_order_and_in_their_own_units() {
    let feed = |record: &str| {
        let (cl, codes) = read(&framed(&format!("{record}\nGOTO/ 1, 1, 1")));
        assert_eq!(codes, [""; 0], "{record}");
        cl.records.iter().rev().find_map(|r| if let RecordKind::Feed(f) = r.kind { Some(f) } else { None })
    };
    assert_eq!(feed("FEDRAT/ 300, MMPM"), Some(Feed::PerMinute(300.0)));
    assert_eq!(feed("FEDRAT/ MMPM, 300"), Some(Feed::PerMinute(300.0)));
    assert_eq!(feed("FEDRAT/ IPM, 10"), Some(Feed::PerMinute(254.0)));
    assert_eq!(feed("FEDRAT/ MMPR, 0.2"), Some(Feed::PerRevolution(0.2)));
    let speed = |record: &str| {
        let (cl, _) =
            read(&framed(&format!("CUTTER/ 10\nLOADTL/ 2\n{record}\nRAPID\nGOTO/ 1, 1, 1\nGOTO/ 2, 1, 1")));
        cl.records.iter().rev().find_map(|r| if let RecordKind::Spindle(s) = r.kind { Some(s) } else { None })
    };
    assert_eq!(speed("SPINDL/ RPM, 900, CCLW"), Some(Spindle::on(900.0, false)));
    assert_eq!(speed("SPINDL/ 900, RPM"), Some(Spindle::on(900.0, true)));
    assert_eq!(speed("SPINDL/ 800, CCLW\nSPINDL/ 900, RPM"), Some(Spindle::on(900.0, false)));
    assert_eq!(speed("SPINDL/ 800, CCLW\nSPINDL/ 900, CLW\nSPINDL/ 700"), Some(Spindle::on(700.0, true)));
    let Some(Spindle::On { rpm, .. }) = speed("SPINDL/ 47.1238898, SMM, CLW") else { panic!("no speed") };
    assert!((rpm - 1500.0).abs() < 1e-3, "{rpm}");
    assert_eq!(speed("SPINDL/ SMM, 300, MAXRPM, 6000"), Some(Spindle::on(6000.0, true)));
    let geared = |rpm, range| Some(Spindle::On { rpm, clockwise: true, range });
    assert_eq!(speed("SPINDL/ 800, RANGE, 2"), geared(800.0, Gear::Number(2)));
    assert_eq!(speed("SPINDL/ 801, RANGE, LOW"), geared(801.0, Gear::Low));
    assert_eq!(speed("SPINDL/ 803, HIGH"), geared(803.0, Gear::High));
    assert_eq!(speed("SPINDL/ 803, HIGH\nSPINDL/ 700"), geared(700.0, Gear::Any));
}

#[test]
fn what_a_tool_change_says_besides_is_kept_with_the_tool() {
    let words = |record: &str| {
        let (cl, _) = read(&framed(&format!("CUTTER/ 10\n{record}\nRAPID\nGOTO/ 1, 1, 1")));
        cl.tools.iter().last().map(|(_, tool)| tool.words.clone()).unwrap_or_default()
    };
    assert_eq!(words("LOADTL/ 2, ADJUST, 2, LENGTH, 120.5"), "ADJUST, 2, LENGTH, 120.5");
    assert_eq!(words("LOAD/ TOOL, 2, OSETNO, 2"), "OSETNO, 2");
    assert_eq!(words("LOADTL/ 2, SPINDL, 70, MILL"), "MILL");
    assert_eq!(words("LOADTL/ 2"), "");
}

#[test]
fn cycles_in_their_spellings() {
    let cycle = |record: &str| {
        let (cl, codes) =
            read(&framed(&format!("{record}\nGOTO/ 10, 0, 0\nGOTO/ 20, 0, 0\nCYCLE/ OFF\nGOTO/ 20, 0, 30")));
        assert_eq!(codes, [""; 0], "{record}");
        assert!(kinds(&cl).ends_with("BHHEL"), "{} {record}", kinds(&cl));
        cl.records
            .iter()
            .find_map(|r| if let RecordKind::BeginCycle(c) = &r.kind { Some(**c) } else { None })
            .unwrap()
    };
    let nx = cycle("CYCLE/DRILL,RAPTO,3.0,FEDTO,-12.0,RTRCTO,20.0,MMPM,120.0");
    assert_eq!(
        (nx.kind, nx.depth, nx.clearance, nx.retract),
        (CycleKind::Drill, 12.0, 3.0, RetractTo::Initial)
    );
    let creo = cycle("CYCLE / DEEP, DEPTH, 20, STEP, 4, MMPM, 100, CLEAR, 2");
    assert_eq!((creo.kind, creo.peck, creo.retract), (CycleKind::Deep, Some(4.0), RetractTo::Clearance));
    let solid = cycle("CYCLE/DEEP2,FEDTO,9.5,1STPECK,5.,SUBPECK,2.,MMPM,102.5,RAPTO,3.,RTRCTO,25.");
    assert_eq!((solid.peck, solid.first_peck), (Some(2.0), Some(5.0)));
    let positional = cycle("CYCLE/ DRILL, 15, MMPM, 80, 2");
    assert_eq!((positional.depth, positional.clearance), (15.0, 2.0));
    assert_eq!(positional.feed, Feed::PerMinute(80.0));
    // Depth, feed, unit, clearance.
    let catia = cycle("CYCLE/ DEEPHL, 15, 200, MMPM, 2, INCR, 3");
    assert_eq!((catia.depth, catia.clearance, catia.peck), (15.0, 2.0, Some(3.0)));
    assert_eq!(catia.feed, Feed::PerMinute(200.0));
    let nx = cycle("CYCLE/DRILL,DEEP,RAPTO,3,FEDTO,-25,STEP1,5,STEP2,3,STEP3,2,RTRCTO,AUTO,MMPM,150");
    assert_eq!((nx.kind, nx.peck, nx.first_peck), (CycleKind::Deep, Some(2.0), Some(5.0)));
    assert_eq!(nx.retract, RetractTo::Initial);
    // Pecks of NX in a list: none of them is the feed.
    let nx = cycle("CYCLE/DRILL,DEEP,RAPTO,3,FEDTO,-25,RTRCTO,AUTO,STEP,5,2,3,MMPM,150,DWELL,1");
    assert_eq!((nx.peck, nx.first_peck, nx.feed), (Some(2.0), Some(5.0), Feed::PerMinute(150.0)));
    let nx = cycle("CYCLE/DRILL,DEEP,RAPTO,3,FEDTO,-25,STEP,3,3,3,MMPM,150");
    assert_eq!((nx.peck, nx.first_peck, nx.feed), (Some(3.0), None, Feed::PerMinute(150.0)));
    let value_first = cycle("CYCLE/ DEEP, DEPTH, 20, STEP, 4, 100, MMPM, CLEAR, 2");
    assert_eq!((value_first.peck, value_first.feed), (Some(4.0), Feed::PerMinute(100.0)));
    let catia = cycle("CYCLE/ DEEPHL, 15, INCR, 3, 200, MMPM, 2");
    assert_eq!((catia.peck, catia.clearance, catia.feed), (Some(3.0), 2.0, Feed::PerMinute(200.0)));
    let face = cycle("CYCLE/ FACE, FEDTO, 2, MMPM, 50, RAPTO, 2, DWELL, 1.5");
    assert_eq!((face.kind, face.dwell), (CycleKind::Dwell, Some(1.5)));
    let tap = cycle("CYCLE/ TAP, FEDTO, 12, MMPR, 1.25, RAPTO, 5");
    assert_eq!(tap.kind, CycleKind::Tap { pitch: 1.25, left: false });
    assert_eq!(cycle("CYCLE/ BORE, FEDTO, 9, MMPM, 60, RAPTO, 2").kind, CycleKind::Bore);
    assert_eq!(cycle("CYCLE/ BORE, FEDTO, 9, MMPM, 60, RAPTO, 2, DWELL, 1").kind, CycleKind::BoreDwell);
    let dwell = |words: &str| cycle(&format!("CYCLE/ FACE, FEDTO, 2, MMPM, 50, RAPTO, 2, {words}")).dwell;
    assert_eq!(dwell("DWELL, 3, REV"), dwell("DWELL, REV, 3"));
    assert_eq!(dwell("DWELL, 3, REV"), dwell("REV, 3"));
    assert!(dwell("DWELL, 3, REV") < Some(1.0));
}

#[test]
fn words_may_stand_between_a_circle_and_its_point() {
    let (cl, codes) =
        read(&framed("CIRCLE/ 0, 0, 5, 0, 0, 1, 10\nFEDRAT/ 90, MMPM\nPPRINT NOW\nGOTO/ 0, 10, 5"));
    assert_eq!((kinds(&cl).as_str(), codes.as_slice()), ("RC", [""; 0].as_slice()));
}

#[test]
fn points_before_the_first_tool_are_approached_with_it() {
    for before in ["FROM/ 0, 0, 90", "RAPID\nGOTO/ 0, 0, 90"] {
        let text = format!("{before}\nLOADTL/ 1\nSPINDL/ 900\nFEDRAT/ 100\nGOTO/ 5, 0, 90\nFINI\n");
        let (cl, codes) = read(&text);
        assert_eq!(codes, [""; 0], "{before}");
        let mut after_tool =
            cl.records.iter().skip_while(|r| !matches!(r.kind, RecordKind::LoadTool(_))).map(|r| &r.kind);
        assert!(after_tool.any(|kind| matches!(kind, RecordKind::From(p) if p.z == 90.0)), "{before}");
        assert_eq!(kinds(&cl), "L");
    }
}

#[test]
fn after_a_tool_change_an_unarmed_point_is_approached_at_rapid_with_a_warning() {
    let (cl, codes) = read(&framed("GOTO/ 5, 5, 5\nLOADTL/ 2\nSPINDL/ 700\nGOTO/ 0, 0, 60\nGOTO/ 0, 0, 5"));
    assert_eq!((kinds(&cl).as_str(), codes.as_slice()), ("RLRL", ["W1012"].as_slice()));
}

#[test]
fn a_cycle_right_after_the_tool_change_drills_its_first_point() {
    let text = "LOADTL/1\nSPINDL/900\nFEDRAT/100\nCYCLE/DRILL,FEDTO,5,RAPTO,2\nGOTO/1,1,0\nCYCLE/OFF\nFINI\n";
    let (cl, codes) = read(text);
    assert_eq!((kinds(&cl).as_str(), codes.as_slice()), ("RBHE", [""; 0].as_slice()));
}

#[test]
fn a_cycle_that_begins_above_its_return_level_begins_there() {
    let after = |return_to: &str| {
        let cycle = format!("RAPID\nGOTO/ 0, 0, 50\nCYCLE/ DRILL, FEDTO, 5, RAPTO, 2, RTRCTO, {return_to}");
        let (cl, codes) = read(&framed(&format!("{cycle}\nGOTO/ 1, 2, 3\nGOTO/ 4, 5, -3\nCYCLE/ OFF")));
        assert_eq!(codes, [""; 0]);
        let rapids =
            cl.records.iter().filter_map(|r| if let RecordKind::Rapid(p) = r.kind { Some(p) } else { None });
        rapids.skip(2).map(|p| [p.x, p.y, p.z]).collect::<Vec<_>>()
    };
    // Across first, then down; each hole has the level above its own point.
    assert_eq!(after("20"), [[1.0, 2.0, 50.0], [1.0, 2.0, 23.0], [4.0, 5.0, 23.0], [4.0, 5.0, 17.0]]);
    assert_eq!(after("AUTO"), [[0.0; 3]; 0]);
}

#[test]
fn lines_end_as_any_system_ends_them() {
    let (whole, _) = read(&framed("GOTO/ 1, 1, 1\nGOTO/ 2, 2, 2"));
    for end in ["\r\n", "\r"] {
        let (cl, codes) =
            read(&format!("{}\u{1a}", framed("GOTO/ 1, 1, 1\nGOTO/ 2, 2, 2").replace('\n', end)));
        assert_eq!((kinds(&cl), codes.as_slice()), (kinds(&whole), [""; 0].as_slice()));
    }
}

#[test]
fn messages_of_one_code_are_counted_after_the_first_twenty() {
    let words: String = (b'A'..=b'Z')
        .chain(b'A'..=b'D')
        .enumerate()
        .map(|(i, c)| format!("FOO{}{i}/ 1\n", char::from(c)))
        .collect();
    let (_, codes) = read(&framed(&words));
    assert_eq!((codes.len(), codes.last().copied()), (21, Some("N1014")));
}

#[test]
fn records_have_a_bound() {
    for body in ["A".repeat(200_000), format!("FOO/ {}", "1,".repeat(100_000)), "GOTO/ 1,\n".repeat(50_000)] {
        let (_, codes) = read(&framed(&body));
        assert!(codes.contains(&"E1002"), "{codes:?}");
    }
}

#[test]
fn full_circles_of_many_rounded_points_are_full() {
    let body = "GOTO/ 10, 0, 0\nCIRCLE/ 0, 0, 0, 0, 0, 1, 10\nGOTO/ 0, 10, 0\nGOTO/ -10, 0, 0\nGOTO/ 0, -10, 0\nGOTO/ 10, 0.0004, 0\nGOTO/ 20, 0, 0";
    let (cl, codes) = read_as(&framed(body), Some(crate::clfile::Producer::Ncl), false);
    assert_eq!((kinds(&cl).as_str(), codes.as_slice()), ("RLCL", [""; 0].as_slice()));
}

#[test]
fn what_is_off_anyway_may_be_switched_off() {
    let (_, codes) = read(&framed("SET/MODE,ABSOL\nMODE/INCR,OFF\nOPSKIP/OFF\nTRACUT/NOMORE"));
    assert_eq!(codes, [""; 0]);
    let (_, codes) = read(&framed("CYCLE/CLEAR\nCYCLE/INIT\nCYCLE/OFF"));
    assert_eq!(codes, [""; 0]);
    let (_, codes) = read(&framed("SET/MODE,INCR"));
    assert_eq!(codes, ["E1003"]);
}

#[test]
fn a_rapid_between_holes_leaves_the_cycle_in_force() {
    let body =
        "CYCLE/DRILL,FEDTO,5,MMPM,100,RAPTO,2\nGOTO/10,0,0\nRAPID\nGOTO/10,0,40\nGOTO/50,0,0\nCYCLE/OFF";
    let (cl, codes) = read(&framed(body));
    assert_eq!((kinds(&cl).as_str(), codes.as_slice()), ("RBHERBHE", [""; 0].as_slice()));
}

#[test]
fn inch_files_are_read_in_inches() {
    let text = "LOADTL/1\nSPINDL/1000\nFEDRAT/10,IPM\nRAPID\nGOTO/1,0,0\nGOTO/2,0,0\n";
    let (cl, _) = read_as(text, None, false);
    let last = cl
        .records
        .iter()
        .rev()
        .find_map(|r| if let RecordKind::Linear(p) = r.kind { Some(p.x) } else { None });
    assert_eq!(last, Some(50.8));
}

#[test]
fn chunks_are_the_whole() {
    let body: String = (0..500).map(|i| format!("GOTO/{i}.5,{},0\n", i % 7)).collect();
    let text = framed(&body);
    let (whole, _) = read(&text);
    let options = crate::clfile::Options::default();
    let mut reader = crate::clfile::Reader::new(crate::source::FileId(0), "part.cl", &text, &options);
    let mut joined = String::new();
    while let Some(chunk) = reader.chunk(37) {
        joined += &kinds(&chunk);
    }
    assert_eq!(joined, kinds(&whole));
}

#[test]
fn a_cause_is_told_once_with_how_often_it_came() {
    let body = "FEEDRT/1\nGOTO/1,1,1\nFEEDRT/2\nGOTO/2,2,2\nFEEDRT/3\nCOOLNT/HIGH\nCOOLNT/HIGH\nSPINFL/4";
    let options = Options::default();
    let text = framed(body);
    let (_, sink) = Reader::new(FileId(0), "part.cl", &text, &options).whole();
    let told: Vec<String> = sink.into_items().into_iter().map(|d| d.message).collect();
    assert_eq!(
        told,
        [
            "the record `FEEDRT` is not known (and 2 more like it)",
            "COOLNT with HIGH cannot be carried out (and 1 more like it)",
            "the record `SPINFL` is not known",
        ]
    );
}

#[test]
fn an_empty_file_is_an_error_and_one_that_moves_nothing_a_warning() {
    for empty in ["", "\n\r\n\t \n", "$$ nothing\n$$ at all", "%\n\u{1a}", "\u{feff}"] {
        assert_eq!(read(empty).1, ["E1016"], "{empty:?}");
    }
    assert_eq!(read_as("", Some(Producer::Mastercam), false).1, ["E1016"]);
    for still in ["PARTNO X\nFINI\n", "REMARK by hand\nMULTAX/ON\nFINI\n", "LOADTL/1\nCOOLNT/ON\n"] {
        assert_eq!(read(still).1, ["W1018"], "{still:?}");
    }
    // What is wrong is told, and not that nothing moves.
    assert_eq!(read("GOTO/1\n").1, ["E1002"]);
}

#[test]
fn numbers_need_no_commas_between_them() {
    let printed = |body: &str| {
        let (cl, codes) = read(&framed(body));
        assert_eq!(codes, [""; 0], "{body}");
        crate::cl::print::print(&cl)
    };
    for (without, with) in [
        ("GOTO/ 1 -2 3.5", "GOTO/ 1, -2, 3.5"),
        ("GOTO/1.\t-2.  +3.5", "GOTO/ 1, -2, 3.5"),
        ("GOTO/ 1, -2 3.5", "GOTO/ 1, -2, 3.5"),
        ("CIRCLE/ 0 0 5 0 0 1 10\nGOTO/ 0 10 5", "CIRCLE/ 0, 0, 5, 0, 0, 1, 10\nGOTO/ 0, 10, 5"),
        (
            "CYCLE/ DRILL, 15 200, MMPM, 2\nGOTO/ 1 1 0\nCYCLE/ OFF",
            "CYCLE/ DRILL, 15, 200, MMPM, 2\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
        ),
    ] {
        assert_eq!(printed(without), printed(with), "{without}");
    }
    // What is not numbers all through is one word, and there are no fewer numbers than the record takes.
    // The number of a card is no feed.
    for wrong in [
        "GOTO/ 1 2",
        "GOTO/ 1 2 X3",
        "GOTO/ 1 - 2 3",
        "GOTO/ 1 2 3, 4 X",
        "GOTO/ 1, 2, 3       120",
        "GOTO/ 1, 2, 3 00000120",
    ] {
        assert_eq!(read(&framed(wrong)).1, ["E1002"], "{wrong}");
    }
    let operation = read(&framed("TOOL PATH/FACE 1 2,TOOL,MILL 3 4\nGOTO/ 1, 1, 1")).0;
    let operation = crate::cl::print::print(&operation);
    assert!(operation.contains("FACE 1 2"), "{operation}");
}

/// What the machine does with a file, by letter: T a tool change, F a feed in mm a minute, M coolant on, O off, L a cut.
fn done(text: &str) -> String {
    let (cl, codes) = read(text);
    assert!(codes.is_empty(), "{codes:?}");
    let letter = |kind: &RecordKind| match kind {
        RecordKind::LoadTool(_) => "T".to_owned(),
        RecordKind::Feed(Feed::PerMinute(feed)) => format!("F{feed}"),
        RecordKind::Coolant(Coolant::Off) => "O".to_owned(),
        RecordKind::Coolant(_) => "M".to_owned(),
        RecordKind::Linear(_) => "L".to_owned(),
        _ => String::new(),
    };
    cl.records.iter().map(|record| letter(&record.kind)).collect()
}

/// `COOLNT/ ON` at the head of a file, as CATIA writes it, is for the first tool.
#[test]
fn coolant_before_the_first_tool_flows_with_it() {
    let body = "SPINDL/900,RPM,CLW\nFEDRAT/200,MMPM\nRAPID\nGOTO/1,0,5\nGOTO/2,0,5\nFINI\n";
    assert_eq!(done(&format!("COOLNT/ON\nPPRINT A\nLOADTL/1\n{body}")), "TMF200L");
    assert_eq!(done(&format!("COOLNT/ON\nCOOLNT/OFF\nLOADTL/1\n{body}")), "TF200L");
    assert_eq!(done(&format!("COOLNT/ON\nGOTO/0,0,90\nLOADTL/1\nCOOLNT/OFF\n{body}")), "TMOF200L");
}

#[test]
fn a_feed_behind_a_point_or_a_delta_holds() {
    assert_eq!(done(&framed("GOTO/1,2,3,70\nGODLTA/1,0,0,50\nGODLTA/1,0,0")), "TF70LF50LL");
}
