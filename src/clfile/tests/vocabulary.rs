//! The whole vocabulary, there and back: what every word says is printed as CL text and read again to the same records.

use std::collections::BTreeSet;

use super::{framed, read_as};
use crate::cl::{Cl, CycleKind, RecordKind, print};
use crate::clfile::{Producer, words};
use crate::driver::Options;
use crate::ir::Feed;
use crate::source::MemoryFiles;

/// Records of every word, in a program that has moved already. A word without an example fails the test below.
const EXAMPLES: &[(&str, &[&str])] = &[
    ("GOTO", &["GOTO/ 1, 2, 3", "GOTO/ 1.5, -2.25, 3, 0, 0, 1", "GOTO/ 1, 2, 3, 450"]),
    ("GODLTA", &["GODLTA/ 1, 2, 3", "GODLTA/ -4"]),
    ("FROM", &["FROM/ 0, 0, 40"]),
    ("GOHOME", &["GOHOME/ 0, 0, 60", "FROM/ 0, 0, 40\nGOTO/ 1, 1, 1\nGOHOME"]),
    ("RAPID", &["RAPID\nGOTO/ 5, 5, 5\nGOTO/ 6, 6, 6", "RAPID/\nGOTO/ 5, 5, 5"]),
    (
        "FEDRAT",
        &[
            "FEDRAT/ 150, MMPM\nGOTO/ 1, 1, 1",
            "FEDRAT/ IPM, 10\nGOTO/ 1, 1, 1",
            "FEDRAT/ 1.5, FPM\nGOTO/ 1, 1, 1",
            "FEDRAT/ PERMIN, 90, NOW\nGOTO/ 1, 1, 1",
            "FEDRAT/ 0.4, MPM, NEXT\nGOTO/ 1, 1, 1",
            "FEDRAT/ 75, UPM\nGOTO/ 1, 1, 1",
            "FEDRAT/ 0.2, MMPR\nGOTO/ 1, 1, 1",
            "FEDRAT/ IPR, 0.005\nGOTO/ 1, 1, 1",
            "FEDRAT/ 0.1, PERREV\nGOTO/ 1, 1, 1",
            "FEDRAT/ UPR, 0.15\nGOTO/ 1, 1, 1",
            "FEDRAT/ RAPID\nGOTO/ 1, 1, 1",
        ],
    ),
    (
        "SPINDL",
        &[
            "SPINDL/ RPM, 900, CCLW\nGOTO/ 1, 1, 1",
            "SPINDL/ 950, REVPM, CLW\nGOTO/ 1, 1, 1",
            "CUTTER/ 10\nLOADTL/ 2\nSPINDL/ 60, SMM\nRAPID\nGOTO/ 1, 1, 1",
            "CUTTER/ 10\nLOADTL/ 2\nSPINDL/ SFM, 200, MAXRPM, 8000\nRAPID\nGOTO/ 1, 1, 1",
            "SPINDL/ 800, RANGE, 2\nGOTO/ 1, 1, 1",
            "SPINDL/ 801, RANGE, LOW\nGOTO/ 1, 1, 1",
            "SPINDL/ 802, RANGE, MEDIUM\nGOTO/ 1, 1, 1",
            "SPINDL/ 803, HIGH\nGOTO/ 1, 1, 1",
            "SPINDL/ OFF\nSPINDL/ ON\nGOTO/ 1, 1, 1",
            "SPINDL/ STOP",
        ],
    ),
    (
        "COOLNT",
        &[
            "COOLNT/ ON",
            "COOLNT/ FLOOD\nCOOLNT/ OFF",
            "COOLNT/ MIST\nGOTO/ 1, 1, 1\nCOOLNT/ OFF",
            "COOLNT/ THRU\nGOTO/ 1, 1, 1\nCOOLNT/ OFF",
            "COOLNT",
        ],
    ),
    (
        "CYCLE",
        &[
            "CYCLE/ DRILL, FEDTO, 12, RAPTO, 2, RTRCTO, 20, MMPM, 120\nGOTO/ 1, 1, 0\nGOTO/ 2, 1, 0\nCYCLE/ OFF",
            "CYCLE/ DRILL, DEPTH, 12, CLEAR, 2, RETURN, 20, IPM, 5\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ DRILL, DEPTH, 12, CLEARP, 2, RETRCT, 20, PERMIN, 50\nGOTO/ 1, 1, 0\nCYCLE/ NOMORE",
            "CYCLE/ THRU, FEDTO, 12, RAPTO, 2, RTRCTO, AUTO, MMPM, 120\nGOTO/ 1, 1, 0\nGOTO/ 1, 4, 0\nCYCLE/ OFF",
            "CYCLE/ CSINK, FEDTO, 2, RAPTO, 2, RTRCTO, NONE, MMPM, 120\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ SPOTDR, FEDTO, 2, RAPTO, 2, RETURN, ON, MMPM, 120\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ DRILL, CSINK, FEDTO, 2, RAPTO, 2, MMPM, 120, DWELL, 0.5\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ FACE, FEDTO, 2, RAPTO, 2, MMPR, 0.1, DWELL, 1\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ SPOTFC, FEDTO, 2, RAPTO, 2, IPR, 0.004, DWELL, REV, 3\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ SPTFAC, FEDTO, 2, RAPTO, 2, PERREV, 0.1, REV, 4\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ CBORE, FEDTO, 2, RAPTO, 2, MMPM, 50\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ COUNTR, FEDTO, 2, RAPTO, 2, MMPM, 50\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ DRILL, FACE, FEDTO, 2, RAPTO, 2, MMPM, 50\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ DRILL, CBORE, FEDTO, 2, RAPTO, 2, MMPM, 50\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ DEEP, FEDTO, 20, STEP, 4, RAPTO, 2, MMPM, 50\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ DEEP2, FEDTO, 20, 1STPECK, 5, SUBPECK, 2, RAPTO, 2, MMPM, 50\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ DEEPHL, 20, 50, MMPM, 2, INCR, 4\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ PECK, FEDTO, 20, PECK, 4, RAPTO, 2, MMPM, 50\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ DRILL, DEEP, FEDTO, 20, STEP1, 5, STEP2, 4, STEP3, 3, STEP4, 3, STEP5, 2, STEP6, 2, STEP7, 1, \
             RAPTO, 2, MMPM, 50\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ BRKCHP, FEDTO, 20, INCREM, 4, RAPTO, 2, MMPM, 50\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ BRKCHIP, FEDTO, 20, STEP, 4, RAPTO, 2, MMPM, 50\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ BREAK, FEDTO, 20, STEP, 4, RAPTO, 2, MMPM, 50\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ CHPBRK, FEDTO, 20, STEP, 4, RAPTO, 2, MMPM, 50\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ CHIP, FEDTO, 20, STEP, 4, RAPTO, 2, MMPM, 50\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ DRILL, BRKCHP, FEDTO, 20, STEP, 4, RAPTO, 2, MMPM, 50\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ TAP, FEDTO, 12, PITCH, 1.25, RAPTO, 2\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ TAP, DEPTH, 12, TPI, 20, CLEAR, 2\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ TAP, FEDTO, 12, MMPR, 1.25, RAPTO, 2, LEFT\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ TAP, FIX, FEDTO, 12, MMPM, 1500, RAPTO, 2, CCLW\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ TAP, FLOAT, FEDTO, 12, MMPM, 1500, RAPTO, 2, CLW\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ TAP, RIGID, SYNC, FEDTO, 12, MMPM, 1500, RAPTO, 2, RPM\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ DRILL, TAP, ON, TOOL, FEDTO, 12, MMPR, 1, RAPTO, 2\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ BORE, DRAG, FEDTO, 12, MMPM, 60, RAPTO, 2\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ BORE, FEDTO, 12, MMPM, 60, RAPTO, 2\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ BORE, NODRAG, 0.5, FEDTO, 12, MMPM, 60, RAPTO, 2\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ BORE, ORIENT, 0.5, FEDTO, 12, MMPM, 60, RAPTO, 2\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ REAM, FEDTO, 12, MMPM, 60, RAPTO, 2, DWELL, 1\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
            "CYCLE/ DRILL, REAM, FEDTO, 12, MMPM, 60, RAPTO, 2\nGOTO/ 1, 1, 0\nCYCLE/ OFF",
        ],
    ),
    ("MOVARC", &["MOVARC/ 0, 0, 5, 0, 0, 1, 10, ANGLE, 90\nGOTO/ 0, 10, 5"]),
    (
        "CIRCLE",
        &[
            "CIRCLE/ 0, 0, 5, 0, 0, 1, 10\nGOTO/ 0, 10, 5",
            "CIRCLE/ 0, 0, 5, 0, 0, -1\nGOTO/ 10, 0, 5",
            "CIRCLE/ 0, 0, 5, 0, 0, 1, 10, 0.06, 0.5, 12, 1, TIMES, 3\nGOTO/ 0, 10, -5",
            "CIRCLE/ 0, 0, 5, 0, 1, 0, 10\nGOTO/ 0, 0, -5",
        ],
    ),
    (
        "CUTTER",
        &[
            "CUTTER/ 12, 1\nLOADTL/ 3\nRAPID\nGOTO/ 1, 1, 1",
            "CUTTER/ 12, 2, 4, 2, 10, 5, 60\nLOADTL/ 3\nRAPID\nGOTO/ 1, 1, 1",
            "CUTTER/ 16, 0, 8, 8, 45, 0, 60\nLOADTL/ 3\nRAPID\nGOTO/ 1, 1, 1",
            "CUTTER/ DISPLY, SHANK, 8, 40",
        ],
    ),
    (
        "TLDATA",
        &[
            "TLDATA/ MILL, 12, 1, 50, 0, 0\nLOADTL/ 3\nRAPID\nGOTO/ 1, 1, 1",
            "TLDATA/ DRILL, MILL, 8, 0, 90, 118, 60\nLOADTL/ 3\nRAPID\nGOTO/ 1, 1, 1",
        ],
    ),
    (
        "LOADTL",
        &[
            "LOADTL/ 4, ADJUST, 4, LENGTH, 120\nRAPID\nGOTO/ 1, 1, 1",
            "LOADTL/ 4, OSETNO, 4\nRAPID\nGOTO/ 1, 1, 1",
            "LOADTL/ 4, OFFSET, 4\nRAPID\nGOTO/ 1, 1, 1",
            "LOADTL/ 4, OFSTNO, 4\nRAPID\nGOTO/ 1, 1, 1",
            "LOADTL/ 4, ZOFF, 4, SPINDL, 70, MILL\nRAPID\nGOTO/ 1, 1, 1",
        ],
    ),
    ("LOAD", &["LOAD/ TOOL, 5, ADJUST, 5\nRAPID\nGOTO/ 1, 1, 1"]),
    ("TOOLNO", &["TOOLNO/ 6, 12\nRAPID\nGOTO/ 1, 1, 1"]),
    ("DELAY", &["DELAY/ 1.5", "DELAY/ REV, 10"]),
    ("DWELL", &["DWELL/ 0.25"]),
    ("STOP", &["STOP"]),
    ("OPSTOP", &["OPSTOP"]),
    ("END", &["GOTO/ 1, 1, 1\nEND"]),
    ("FINI", &["GOTO/ 1, 1, 1\nFINI"]),
    ("UNITS", &["UNITS/ MM"]),
    ("UNIT", &["UNIT/ MM"]),
    ("INTOL", &["INTOL/ 0.02\nCIRCLE/ 0, 0, 5, 0, 0, 1, 10\nGOTO/ 0, 10, 5"]),
    ("OUTTOL", &["OUTTOL/ 0.03\nCIRCLE/ 0, 0, 5, 0, 0, 1, 10\nGOTO/ 0, 10, 5"]),
    ("TOLER", &["TOLER/ 0.05\nCIRCLE/ 0, 0, 5, 0, 0, 1, 10\nGOTO/ 0, 10, 5"]),
    ("MULTAX", &["MULTAX/ ON\nGOTO/ 1, 1, 1, 0, 0, 1\nMULTAX/ OFF"]),
    ("TLAXIS", &["TLAXIS/ 0, 0, 1\nGOTO/ 1, 1, 1"]),
    (
        "CUTCOM",
        &[
            "CUTCOM/ LEFT, XYPLAN\nGOTO/ 1, 1, 1\nCUTCOM/ OFF",
            "CUTCOM/ RIGHT",
            "CUTCOM/ LEFT\nGOTO/ 1, 1, 1\nCUTCOM/ OFF\nGOTO/ 2, 1, 1\nCUTCOM/ ON",
            "CUTCOM/ ON, LENGTH, 3, NOW",
            "CUTCOM/ LEFT, XYPLAN, ADJUST, 3, XAXIS, NEXT",
            "CUTCOM/ RIGHT, XYPLAN, OSETNO, 3, YAXIS\nGOTO/ 1, 1, 1\nCUTCOM/ NOMORE",
        ],
    ),
    ("MSYS", &["MSYS/ 0, 0, 0, 1, 0, 0, 0, 1, 0"]),
    ("CSYS", &["CSYS/ 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0"]),
    ("TRNTYP", &["TRNTYP/ WORLD, 0, 0, 0"]),
    (
        "NURBS",
        &["NURBS/\nKNOT/ 0.5, 1\nCNTRL/ 10, 5, 5\nCNTRL/ 20, 5, 5\nCNTRL/ 20, 20, 5\nCNTRL/ 30, 30, 5"],
    ),
    ("KNOT", &["NURBS/\nKNOT/ 1\nCNTRL/ 10, 5, 5\nCNTRL/ 20, 5, 5\nCNTRL/ 20, 20, 5"]),
    ("CNTRL", &["NURBS/\nKNOT/ 1\nCNTRL/ 11, 0, 5\nCNTRL/ 12, 0, 5\nCNTRL/ 13, 0, 5"]),
    ("INDIRV", &["INDIRV/ 0, 1, 0\nTLON,GOFWD/ (CIRCLE/ 0, 0, 5, 10),ON,(LINE/ 0, 0, 5, 0, 10, 5)"]),
    (
        "PSIS",
        &["PSIS/ (PLANE/ (POINT/ 0, 0, 5), PERPTO, (VECTOR/ 0, 0, 1))\nINDIRV/ 0, -1, 0\n\
           TLON,GOFWD/ (CIRCLE/ 0, 0, 5, 10),ON,2,INTOF,(LINE/ 0, 0, 5, 10, 0, 5)"],
    ),
    ("TLON", &["INDIRV/ 0, 1, 0\nTLON,GOFWD/ (CYLNDR/ 0, 0, 5, 0, 0, 1, 10),ON,(LINE/ 0, 0, 5, 0, 10, 5)"]),
    ("HELICAL", &["HELICAL/ 0, 0, 5, 0, 1, 0, 0, 0, 1, 2, 10, 10, 0, 0"]),
    ("END-OF-PATH", &["GOTO/ 1, 1, 1\nEND-OF-PATH\nGOTO/ 2, 2, 2"]),
    ("PARTNO", &["PARTNO/ SECOND"]),
    ("PPRINT", &["PPRINT CHECK THE CLAMPS", "PPRINT/ TURN $ OVER"]),
    ("TPRINT", &["TPRINT/ T1 END MILL"]),
    ("INSERT", &["INSERT M60"]),
    ("REMARK", &["REMARK nothing"]),
];

/// Speed of the spindle in the frame of the examples.
const RPM: f64 = 1000.0;

/// Numbers of a text to a nanometre.
fn rounded(text: &str) -> String {
    rounded_to(text, 1e6)
}

/// Numbers of a text in as many parts of 1.
fn rounded_to(text: &str, parts: f64) -> String {
    let mut out = String::new();
    let mut number = String::new();
    for c in text.chars().chain(['\n']) {
        if c.is_ascii_digit() || matches!(c, '.' | '-') || (c == 'e' && !number.is_empty()) {
            number.push(c);
            continue;
        }
        match number.parse::<f64>() {
            Ok(value) => out += &format!("{}", (value * parts).round() / parts + 0.0),
            Err(_) => out += &number,
        }
        number.clear();
        out.push(c);
    }
    out
}

/// Everything a record says, tools by their data and not by their place.
fn said(cl: &Cl) -> Vec<String> {
    cl.records
        .iter()
        .map(|record| match &record.kind {
            RecordKind::LoadTool(tool) => {
                let t = &cl.tools[*tool];
                let mut profile = t.profile.map(|v| (v * 1e6).round() / 1e6);
                if t.kind == crate::ir::CutterKind::Drill {
                    // Where a cone is centred follows from its angle.
                    profile[..2].fill(0.0);
                }
                format!(
                    "tool {:?} {:?} {} {} {profile:?} {}",
                    t.number, t.kind, t.diameter, t.corner, t.words
                )
            }
            RecordKind::BeginOperation(index) => format!("begin {}", cl.operations[*index as usize].name),
            // The feed of a tap follows from its pitch and is not read.
            RecordKind::BeginCycle(cycle) if matches!(cycle.kind, CycleKind::Tap { .. }) => {
                let feed = crate::ir::Feed::PerMinute(0.0);
                rounded(&format!("{:?}", crate::cl::Cycle { feed, ..**cycle }))
            }
            kind => rounded(&format!("{kind:?}")),
        })
        .collect()
}

#[test]
fn every_word_is_written_as_it_was_read() {
    for (word, examples) in EXAMPLES {
        for example in *examples {
            let (first, codes) = read_as(&framed(example), Some(Producer::Plain), false);
            let errors: Vec<_> = codes.iter().filter(|c| c.starts_with('E')).collect();
            assert!(errors.is_empty(), "{word}: {example}: {errors:?}");
            let text = print::print(&first);
            let (second, codes) = read_as(&text, Some(Producer::Plain), false);
            assert!(codes.iter().all(|c| !c.starts_with('E')), "{word}: {codes:?} in\n{text}");
            assert_eq!(print::print(&second), text, "{word}: {example}");
            assert_eq!(said(&second), said(&first), "{word}: {example}\n{text}");
        }
    }
}

/// What is left of a program when it is written for a CL reader and read again, but for its points: those are fitted to
/// decimals, and a curve comes as lines.
fn facts(cl: &Cl) -> Vec<String> {
    let mut plain = cl.clone();
    for record in &mut plain.records {
        match &mut record.kind {
            // One depth of peck is kept, the smaller one; the feed into a hole is written per minute.
            RecordKind::BeginCycle(cycle) => {
                cycle.first_peck = None;
                if let Feed::PerRevolution(feed) = cycle.feed {
                    cycle.feed = Feed::PerMinute(feed * RPM);
                }
            }
            // A dollar would go on in the next line.
            RecordKind::Comment(text) => *text = text.replace('$', "_"),
            _ => {}
        }
    }
    let points = ["Rapid", "Linear", "Circle", "Spline", "From", "begin", "EndOperation"];
    let mut facts = said(&plain);
    facts.retain(|fact| !points.iter().any(|p| fact.starts_with(p)));
    // A program ends with what is on switched off.
    while facts.last().is_some_and(|f| f.starts_with("Spindle(Off)") || f.starts_with("Coolant(Off)")) {
        facts.pop();
    }
    // Surface speeds come as speeds with three decimals.
    facts.iter().map(|fact| rounded_to(fact, 1e3)).collect()
}

/// The CL text that a flavour of the post `apt-cl` makes of a CL file.
fn posted(text: &str, flavour: &str) -> String {
    let files = MemoryFiles([("part.cls".to_owned(), text.to_owned())].into());
    let options = Options {
        posts: vec!["apt-cl".to_owned()],
        post_set: vec![("options.FLAVOUR".to_owned(), flavour.to_owned())],
        is_cl: true,
        only_nc: true,
        ..Options::default()
    };
    let build = crate::driver::build("part.cls", &files, &options);
    let proven = build.outputs.first().and_then(|o| o.proven.as_ref());
    proven.unwrap_or_else(|| panic!("{text}\n{:?}", build.diagnostics)).text().to_owned()
}

#[test]
fn every_word_survives_the_post_for_cl_text_in_both_flavours() {
    for flavour in ["plain", "nx"] {
        for (word, examples) in EXAMPLES {
            for example in *examples {
                let first = read_as(&framed(example), Some(Producer::Plain), false).0;
                let text = posted(&framed(example), flavour);
                let (second, codes) = read_as(&text, None, false);
                assert!(codes.iter().all(|c| !c.starts_with('E')), "{word}: {codes:?} in\n{text}");
                assert_eq!(facts(&second), facts(&first), "{word}: {example}\n{text}");
                assert_eq!(facts(&read_as(&posted(&text, flavour), None, false).0), facts(&second), "{text}");
            }
        }
    }
}

#[test]
fn every_word_has_an_example() {
    let majors: BTreeSet<&str> = EXAMPLES.iter().map(|(word, _)| *word).collect();
    let wanted: BTreeSet<&str> = words::CARRIED_OUT.iter().copied().collect();
    assert_eq!(majors, wanted);
    for (major, minors) in words::minor_words() {
        let (_, examples) = EXAMPLES.iter().find(|(word, _)| *word == major).expect("an example");
        let said: BTreeSet<&str> = examples
            .iter()
            .flat_map(|e| e.lines())
            .filter_map(|line| line.strip_prefix(major))
            .flat_map(|rest| rest.split([',', '/']))
            .map(str::trim)
            .collect();
        let forgotten: Vec<_> = minors.into_iter().filter(|m| !said.contains(m)).collect();
        assert!(forgotten.is_empty(), "{major}: no example with {forgotten:?}");
    }
}

#[test]
fn nothing_is_carried_out_without_being_in_the_vocabulary() {
    // The other way round: what the reader does not refuse as unknown is listed.
    for (word, examples) in EXAMPLES {
        let (_, codes) = read_as(&framed(examples[0]), Some(Producer::Plain), false);
        assert!(!codes.contains(&"E1001"), "{word}");
    }
    let (_, codes) = read_as(&framed("FOOBAR/ 1"), Some(Producer::Plain), false);
    assert_eq!(codes, ["E1001"]);
}
