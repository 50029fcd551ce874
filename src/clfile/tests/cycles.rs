//! Cycles: what is put in force between their holes, heights, words that belong to no hole.

use super::{framed, kinds, read};
use crate::cl::{Cl, Cycle, CycleKind, RecordKind, RetractTo};
use crate::ir::{Feed, Spindle};

/// The cycles of the CL data, in order.
fn cycles(cl: &Cl) -> Vec<Cycle> {
    cl.records
        .iter()
        .filter_map(|r| if let RecordKind::BeginCycle(cycle) = &r.kind { Some(**cycle) } else { None })
        .collect()
}

/// The cycles of records that give no message.
fn clean(body: &str) -> Vec<Cycle> {
    let (cl, codes) = read(&framed(body));
    assert_eq!(codes, [""; 0], "{body}");
    cycles(&cl)
}

#[test]
fn feed_and_speed_between_holes_count_from_the_next_hole_on() {
    let body = "CYCLE/ DRILL, FEDTO, 9, RAPTO, 2\nGOTO/ 1, 0, 0\nFEDRAT/ 90, MMPM\nGOTO/ 2, 0, 0\nGOTO/ 3, 0, 0\n\
                SPINDL/ 700\nGOTO/ 4, 0, 0\nCYCLE/ OFF";
    let (cl, codes) = read(&framed(body));
    assert_eq!((kinds(&cl).as_str(), codes.as_slice()), ("RBHEBHHEBHE", [""; 0].as_slice()));
    let feeds: Vec<Feed> = cycles(&cl).iter().map(|c| c.feed).collect();
    assert_eq!(feeds, [200.0, 90.0, 90.0].map(Feed::PerMinute));
    let last = cl.records.iter().rev().find(|r| matches!(r.kind, RecordKind::Spindle(Spindle::On { .. })));
    assert!(last.is_some_and(|r| matches!(r.kind, RecordKind::Spindle(s) if s == Spindle::on(700.0, true))));
    // A feed of the record's own stays.
    let own =
        clean("CYCLE/ DRILL, FEDTO, 9, RAPTO, 2, MMPM, 50\nGOTO/ 1, 0, 0\nFEDRAT/ 90, MMPM\nGOTO/ 2, 0, 0");
    assert_eq!(own.iter().map(|c| c.feed).collect::<Vec<_>>(), [Feed::PerMinute(50.0)]);
}

#[test]
fn a_tap_has_the_pitch_and_hand_of_the_speed_at_its_hole() {
    let taps = |body: &str| clean(body).iter().map(|c| c.kind).collect::<Vec<_>>();
    let tap = |pitch: f64, left: bool| CycleKind::Tap { pitch, left };
    let late = "CYCLE/ TAP, FEDTO, 9, RAPTO, 2\nSPINDL/ 400\nFEDRAT/ 500, MMPM\nGOTO/ 1, 0, 0\nFEDRAT/ 600, MMPM\nGOTO/ 2, 0, 0";
    assert_eq!(taps(late), [tap(1.25, false), tap(1.5, false)]);
    assert_eq!(
        taps("CYCLE/ TAP, FEDTO, 9, RAPTO, 2, MMPM, 500\nSPINDL/ 250, CCLW\nGOTO/ 1, 0, 0"),
        [tap(2.0, true)]
    );
    assert_eq!(
        taps("CYCLE/ TAP, FEDTO, 9, RAPTO, 2, PITCH, 1\nSPINDL/ 250\nGOTO/ 1, 0, 0"),
        [tap(1.0, false)]
    );
    // Threads an inch, whatever the file counts in.
    assert_eq!(
        taps("SPINDL/ 250\nCYCLE/ TAP, DEPTH, 9, TPI, 20, CLEAR, 2\nGOTO/ 1, 0, 0"),
        [tap(1.27, false)]
    );
}

#[test]
fn turns_of_dwell_are_those_of_the_speed_at_the_hole() {
    let body =
        "CYCLE/ FACE, FEDTO, 9, RAPTO, 2, REV, 5\nSPINDL/ 600\nGOTO/ 1, 0, 0\nSPINDL/ 300\nGOTO/ 2, 0, 0";
    assert_eq!(clean(body).iter().map(|c| c.dwell).collect::<Vec<_>>(), [Some(0.5), Some(1.0)]);
}

#[test]
fn numbers_that_do_not_belong_to_the_hole_are_told() {
    for record in [
        // Pecks of a cycle that has none.
        "CYCLE/ DRILL, FEDTO, 20, STEP, 5, RAPTO, 2",
        "CYCLE/ TAP, FEDTO, 20, STEP, 5, RAPTO, 2, PITCH, 1",
        // Threads that nobody can cut.
        "CYCLE/ TAP, FEDTO, 20, RAPTO, 2, TPI, 0",
        // An angle where a distance off the wall is meant.
        "CYCLE/ BORE, FEDTO, 20, RAPTO, 2, ORIENT, 90",
        "CYCLE/ BORE, FEDTO, 20, RAPTO, 2, ORIENT, -1",
        "CYCLE/ BORE, NODRAG, FEDTO, 20, RAPTO, 2",
        "CYCLE/ BORE, 20, MMPM, 60, 5, 0.2",
        // Is it above the part or above the hole?
        "CYCLE/ DRILL, 12, MMPM, 300, 15, RAPTO, 10",
    ] {
        let (_, codes) = read(&framed(&format!("{record}\nGOTO/ 1, 1, 0\nCYCLE/ OFF")));
        assert_eq!(codes, ["E1006"], "{record}");
    }
    let kind = |record: &str| clean(&format!("{record}\nGOTO/ 1, 1, 0"))[0].kind;
    // Autodesk's posts write it where they know no angle.
    assert_eq!(kind("CYCLE/ BORE, FEDTO, 12, MMPM, 60, CLEAR, 5, ORIENT, 0"), CycleKind::Bore);
    assert_eq!(
        kind("CUTTER/ 30\nLOADTL/ 4\nSPINDL/ 900\nCYCLE/ BORE, FEDTO, 12, RAPTO, 5, NODRAG, 12"),
        CycleKind::BoreOrient { shift: 12.0 }
    );
}

#[test]
fn further_pecks_of_a_cycle_in_order_are_no_clearance() {
    let one = |record: &str| clean(&format!("{record}\nGOTO/ 1, 1, 0"))[0];
    let listed = one("CYCLE/ DEEPHL, 20, 50, MMPM, 2, STEP, 5, 4, 3");
    assert_eq!((listed.depth, listed.clearance), (20.0, 2.0));
    assert_eq!((listed.first_peck, listed.peck), (Some(5.0), Some(3.0)));
    let first = one("CYCLE/ DEEPHL, INCR, 5, 20, 300, MMPM, 2");
    assert_eq!((first.depth, first.peck, first.clearance), (20.0, Some(5.0), 2.0));
    assert_eq!(first.feed, Feed::PerMinute(300.0));
}

#[test]
fn clear_beside_rapto_is_the_height_between_the_holes() {
    let levels = |words: &str| {
        let (cl, codes) =
            read(&framed(&format!("RAPID\nGOTO/ 0, 0, 15\n{words}\nGOTO/ 1, 1, -4\nGOTO/ 2, 1, -4")));
        assert_eq!(codes, [""; 0], "{words}");
        let mut rapids = cl
            .records
            .iter()
            .filter_map(|r| if let RecordKind::Rapid(p) = r.kind { Some(p.z) } else { None });
        let c = cycles(&cl)[0];
        (c.clearance, c.retract, rapids.next_back().unwrap_or_default())
    };
    // A plane of the part, where the tool is; else above the hole.
    let plane = (5.0, RetractTo::Initial, 15.0);
    assert_eq!(levels("CYCLE/ REAM, FEDTO, 12, MMPM, 60, CLEAR, 15, RAPTO, 5"), plane);
    assert_eq!(levels("CYCLE/ REAM, FEDTO, 12, MMPM, 60, CLEAR, 15, RETURN, 15, RAPTO, 5"), plane);
    assert_eq!(
        levels("CYCLE/ REAM, FEDTO, 12, MMPM, 60, CLEAR, 25, RAPTO, 5"),
        (5.0, RetractTo::Initial, 21.0)
    );
    assert_eq!(levels("CYCLE/ REAM, FEDTO, 12, MMPM, 60, CLEAR, 4, RAPTO, 5").1, RetractTo::Clearance);
}

#[test]
fn planes_and_bottoms_of_the_post_for_iso_4343() {
    let body = "RAPID\nGOTO/ 0, 0, 15\nCYCLE/DRILL, 12, MMPM, 300, 15, RAPTO, 10\nFEDRAT/300, MMPM\nGOTO/ 1, 1, -12\n\
                FEDRAT/300, MMPM\nGOTO/ 2, 1, -13\nCYCLE/OFF";
    let (cl, codes) = read(&framed(body));
    assert_eq!((kinds(&cl).as_str(), codes.as_slice()), ("RRBHEBHE", [""; 0].as_slice()));
    let bottoms = cl
        .records
        .iter()
        .filter_map(|r| if let RecordKind::Hole(p) = r.kind { Some(p.z - 12.0) } else { None });
    assert_eq!(bottoms.collect::<Vec<_>>(), [-12.0, -13.0]);
    assert_eq!(cycles(&cl).iter().map(|c| c.clearance).collect::<Vec<_>>(), [5.0, 6.0]);
    let low = body.replace("-12\n", "0\n");
    assert_eq!(read(&framed(&low)).1, ["E1006"]);
}

#[test]
fn a_point_behind_a_cycle_that_was_cut_short_is_told() {
    let cycle = "CYCLE/ DRILL, FEDTO, 9, RAPTO, 2\nGOTO/ 1, 0, 0";
    let codes = |behind: &str| read(&framed(&format!("{cycle}\n{behind}"))).1;
    assert_eq!(codes("SPINDL/ OFF\nSPINDL/ ON\nGOTO/ 2, 0, 0"), ["E1006"]);
    assert!(codes("LOADTL/ 2\nSPINDL/ 700\nGOTO/ 2, 0, 0").contains(&"E1006"));
    for behind in [
        "LOADTL/ 2\nSPINDL/ 700\nRAPID\nGOTO/ 2, 0, 0\nGOTO/ 3, 0, 0",
        "LOADTL/ 2\nSPINDL/ 700\nCYCLE/ DRILL, FEDTO, 9, RAPTO, 2\nGOTO/ 2, 0, 0",
        "CYCLE/ OFF\nSPINDL/ OFF\nSPINDL/ ON\nGOTO/ 2, 0, 2",
    ] {
        assert_eq!(codes(behind), [""; 0], "{behind}");
    }
}

#[test]
fn a_cycle_goes_off_and_on_again() {
    let body = "CYCLE/ DRILL, FEDTO, 9, RAPTO, 2\nGOTO/ 1, 0, 0\nCYCLE/ OFF\nRAPID\nGOTO/ 5, 0, 9\nCYCLE/ ON\nGOTO/ 7, 0, 0\nCYCLE/ DRILL, OFF\nGOTO/ 7, 0, 20";
    let (cl, codes) = read(&framed(body));
    assert_eq!((kinds(&cl).as_str(), codes.as_slice()), ("RBHERBHEL", [""; 0].as_slice()));
    assert_eq!(read(&framed("CYCLE/ ON")).1, ["E1006"]);
}

#[test]
fn steps_from_a_hole_count_from_its_point() {
    let body = "CYCLE/ DRILL, FEDTO, 9, RAPTO, 2\nGOTO/ 1, 0, -3\nGODLTA/ 10, 0, 0\nRAPID\nGODLTA/ 0, 0, 30\nCYCLE/ OFF\nGODLTA/ 0, 0, 5";
    let (cl, codes) = read(&framed(body));
    assert_eq!((kinds(&cl).as_str(), codes.as_slice()), ("RBHHERL", [""; 0].as_slice()));
    let ends: Vec<[f64; 3]> = cl
        .records
        .iter()
        .filter_map(|r| match r.kind {
            RecordKind::Hole(p) | RecordKind::Rapid(p) | RecordKind::Linear(p) => Some([p.x, p.y, p.z]),
            _ => None,
        })
        .skip(2)
        .collect();
    assert_eq!(ends, [[11.0, 0.0, -3.0], [11.0, 0.0, 27.0], [11.0, 0.0, 32.0]]);
}

#[test]
fn a_point_at_rapid_at_the_height_of_holes_is_told() {
    let cycle = "RAPID\nGOTO/ 0, 0, 40\nCYCLE/ DRILL, FEDTO, 9, RAPTO, 2";
    let codes = |body: &str| read(&framed(&format!("{cycle}\n{body}\nCYCLE/ OFF"))).1;
    for body in [
        "RAPID\nGOTO/ 1, 0, 0",
        "RAPID\nGOTO/ 1, 0, 0\nGOTO/ 2, 0, 0",
        "GOTO/ 1, 0, 0\nRAPID\nGOTO/ 2, 0, 0",
        "GOTO/ 1, 0, 0\nRAPID\nGOTO/ 2, 0, 0\nRAPID\nGOTO/ 2, 0, 9",
    ] {
        assert_eq!(codes(body), ["E1006"], "{body}");
    }
    for body in [
        "RAPID\nGOTO/ 1, 0, 9\nGOTO/ 2, 0, 0\nRAPID\nGOTO/ 1, 0, 60\nRAPID\nGOTO/ 1, 0, 2",
        "GOTO/ 1, 0, 0\nRAPID\nGOTO/ 2, 0, 2\nGOTO/ 2, 0, -5",
    ] {
        assert_eq!(codes(body), [""; 0], "{body}");
    }
    // Before the cycle it arms nothing: the way to a hole is at rapid.
    let (cl, codes) =
        read(&framed("RAPID\nCYCLE/ DRILL, FEDTO, 9, RAPTO, 2\nGOTO/ 1, 0, 0\nCYCLE/ OFF\nGOTO/ 1, 0, 30"));
    assert_eq!((kinds(&cl).as_str(), codes.as_slice()), ("RBHEL", [""; 0].as_slice()));
}
