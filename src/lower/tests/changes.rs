//! How high the cutter goes at tool changes.

use super::cl::Draft;
use super::{INCH, dialect, lowered, made_with};
use crate::cl::{Cl, RecordKind};
use crate::diag::Sink;
use crate::ir::{Spindle, Tool};
use crate::lower::stream::{Changes, Stream};
use crate::post::Dialect;
use crate::target::{TargetProgram, print};

/// At most 20 mm high with the first tool, 30 mm with the second, 8 mm with the first again; it begins and ends lower with each.
fn program() -> Cl {
    let mut draft = Draft::new();
    let other = draft.cl.tools.push(Tool::flat("T2", 8.0, None, draft.origin));
    let RecordKind::LoadTool(first) = draft.cl.records[0].kind else { panic!("a tool first") };
    let on = || RecordKind::Spindle(Spindle::on(900.0, true));
    draft
        .rapid(0.0, 0.0, 2.0)
        .rapid(0.0, 0.0, 20.0)
        .rapid(10.0, 0.0, 20.0)
        .linear(10.0, 0.0, -1.0)
        .add(RecordKind::LoadTool(other))
        .add(on())
        .rapid(40.0, 5.0, 3.0)
        .linear(40.0, 5.0, -1.0)
        .rapid(40.0, 5.0, 30.0)
        .rapid(60.0, 5.0, 30.0)
        .linear(60.0, 5.0, -1.0)
        .add(RecordKind::LoadTool(first))
        .add(on())
        .rapid(80.0, 5.0, 8.0)
        .linear(80.0, 5.0, -1.0)
        .cl
}

/// A post that goes to this height of the machine before a change, or nowhere.
fn retracting(inherits: &str, to: &str) -> Dialect {
    let text = format!("inherits = {inherits:?}\n[options]\nRETRACT = {to:?}\n");
    dialect("own.post.toml", Some(&text))
}

/// Tool changes and moves at rapid.
fn rapids(program: &TargetProgram) -> Vec<String> {
    let text = print::print(program);
    text.lines()
        .filter(|l| l.starts_with("rapid") || l.starts_with("tool-change"))
        .map(str::to_owned)
        .collect()
}

const LOW: [&str; 15] = [
    "tool-change 0",
    "rapid z 20",
    "rapid x 0 y 0",
    "rapid z 2",
    "rapid z 20",
    "rapid x 10",
    "rapid z 20",
    "tool-change 1",
    "rapid z 30",
    "rapid x 40 y 5",
    "rapid z 3",
    "rapid z 30",
    "rapid x 60",
    "rapid z 30",
    "tool-change 0",
];

#[test]
fn where_nothing_retracts_the_cutter_crosses_as_high_as_the_program_goes_with_each_tool() {
    for post in ["grbl", "linuxcnc", "mach3", "centroid"] {
        let made = made_with(&program(), &retracting(post, ""), None);
        let rapids = rapids(&made.target);
        assert_eq!(rapids[..LOW.len()], LOW, "{post}");
        // With the first tool again it is not as high as it was with it before.
        assert_eq!(rapids[LOW.len()..], ["rapid z 8", "rapid x 80 y 5"], "{post}");
    }
}

#[test]
fn where_the_control_retracts_the_cutter_goes_over_the_first_point_and_down() {
    for post in ["grbl", "linuxcnc", "mach3", "centroid"] {
        let made = made_with(&program(), &retracting(post, "-5"), None);
        let rapids = rapids(&made.target);
        let changes: Vec<usize> =
            (0..rapids.len()).filter(|k| rapids[*k].starts_with("tool-change")).collect();
        let after = |k: usize| &rapids[changes[k]..changes[k] + 3];
        assert_eq!(after(0), ["tool-change 0", "rapid x 0 y 0", "rapid z 2"], "{post}");
        assert_eq!(after(1), ["tool-change 1", "rapid x 40 y 5", "rapid z 3"], "{post}");
        assert_eq!(after(2), ["tool-change 0", "rapid x 80 y 5", "rapid z 8"], "{post}");
        // The last move before the change is the cut.
        assert_eq!(rapids[changes[1] - 1], "rapid x 10", "{post}");
    }
}

#[test]
fn heights_at_changes_are_those_of_the_whole_program_in_the_program_s_unit() {
    let mut cl = program();
    cl.units = INCH;
    let dialect = retracting("linuxcnc", "");
    let whole = lowered(&cl, &dialect, None).0.expect("a program");
    let inches = rapids(&whole);
    assert!(inches.iter().any(|l| l == "rapid z 1.1811"), "{inches:?}");
    // In parts of one record, where the height is told by a part that comes later.
    let mut changes = Changes::default();
    cl.records.iter().for_each(|record| changes.record(record));
    let mut stream = Stream::new(whole.capabilities.clone(), &changes, &cl.tools);
    let mut parts = Vec::new();
    for (k, record) in cl.records.iter().enumerate() {
        let part = Cl { records: vec![record.clone()], ..cl.clone() };
        parts.extend(rapids(&stream.chunk(&part, k + 1 == cl.records.len(), &mut Sink::default())));
    }
    assert_eq!(parts, inches);
}
