//! Cutter compensation: where it may begin and end.

use super::cl::{Draft, plate};
use super::{dialect, lowered, made, made_with};
use crate::cl::{Circle, Cycle, CycleKind, Lead, RecordKind, RetractTo};
use crate::geom::{Point3, Side, Vec3};
use crate::ir::{Compensation, Feed, Interpolation, Spindle};

fn on(side: Side, register: Option<u32>) -> RecordKind {
    RecordKind::Compensation(Some(Compensation { side, register }))
}

const OFF: RecordKind = RecordKind::Compensation(None);

fn left() -> RecordKind {
    on(Side::Left, None)
}

fn start() -> Draft {
    Draft::new().rapid(0.0, 0.0, 5.0).linear(0.0, 0.0, -1.0)
}

/// A quarter of a circle to `x`, 10 about `x`, 0.
fn arc(draft: Draft, x: f64) -> Draft {
    let circle = Circle {
        to: Point3::new(x, 10.0, -1.0),
        centre: Point3::new(x, 0.0, -1.0),
        axis: -Vec3::z(),
        turns: 0,
        tolerance: 0.01,
    };
    draft.add(RecordKind::Circle(Box::new(circle)))
}

fn drilling() -> Cycle {
    Cycle {
        kind: CycleKind::Drill,
        depth: 5.0,
        clearance: 2.0,
        retract: RetractTo::Clearance,
        peck: None,
        first_peck: None,
        dwell: None,
        feed: Feed::PerMinute(100.0),
    }
}

fn lines<'t>(text: &'t str, from: &str, count: usize) -> Vec<&'t str> {
    text.lines().skip_while(|line| !line.contains(from)).take(count).collect()
}

#[test]
fn words_wait_for_the_first_straight_move_in_the_plane() {
    let draft = start().add(left()).linear(0.0, 0.0, -2.0).linear(10.0, 0.0, -2.0);
    let draft = draft.linear(10.0, 5.0, -2.0).add(OFF).linear(10.0, 5.0, 5.0).rapid(0.0, 5.0, 5.0);
    let fanuc = made(&draft.cl, "fanuc", None).text;
    let wanted = ["G1 Z-1. F300.", "Z-2.", "G41 D1 X10.", "Y5.", "Z5.", "G0 G40 X0."];
    assert_eq!(lines(&fanuc, "Z-1.", 6), wanted, "{fanuc}");
    let klartext = made(&draft.cl, "heidenhain", None).text;
    let words: Vec<&str> = lines(&klartext, "L Z-1", 6)
        .into_iter()
        .filter_map(|l| l.split(' ').find(|w| w.starts_with('R')))
        .collect();
    assert_eq!(words, ["R0", "R0", "RL", "RL", "RL", "R0"], "{klartext}");
}

#[test]
fn what_no_move_ends_ends_alone() {
    let draft =
        start().add(on(Side::Right, Some(12))).linear(10.0, 0.0, -1.0).add(OFF).linear(10.0, 0.0, 5.0);
    for (post, block) in
        [("fanuc", "G40"), ("sinumerik", "G40"), ("heidenhain", "L R0 FMAX"), ("apt-cl", "CUTCOM/OFF")]
    {
        let text = made(&draft.cl, post, None).text;
        let alone = |line: &&str| line.trim_start_matches(|c: char| c.is_ascii_digit() || c == ' ') == block;
        assert_eq!(text.lines().filter(alone).count(), 1, "{text}");
    }
    let named = |post: &str, word: &str| made(&draft.cl, post, None).text.contains(word);
    assert!(
        named("fanuc", "G42 D12 X10.") && named("apt-cl", "CUTCOM/RIGHT,12") && named("sinumerik", "G42 X10")
    );
}

#[test]
fn after_it_has_ended_alone_anything_may_come() {
    let draft = start().add(left()).linear(10.0, 0.0, -1.0).add(OFF).rapid(10.0, 0.0, 5.0);
    let tool = draft.cl.tools.iter().map(|(handle, _)| handle).next().unwrap();
    let changed = || start().add(left()).linear(10.0, 0.0, -1.0).add(OFF).rapid(10.0, 0.0, 5.0);
    let changed =
        changed().add(RecordKind::LoadTool(tool)).add(RecordKind::Spindle(Spindle::on(900.0, true)));
    let drilled = draft.add(RecordKind::BeginCycle(Box::new(drilling())));
    let drilled = drilled.add(RecordKind::Hole(Point3::new(0.0, 0.0, 0.0))).add(RecordKind::EndCycle);
    for draft in [changed.rapid(0.0, 0.0, 5.0), drilled.rapid(0.0, 0.0, 5.0)] {
        let draft = arc(draft.linear(0.0, 0.0, -1.0), 10.0);
        for post in ["fanuc", "heidenhain", "sinumerik", "okuma"] {
            made(&draft.cl, post, None);
        }
    }
}

#[test]
fn compensation_that_goes_on_is_not_said_twice() {
    let draft = start().add(left()).linear(10.0, 0.0, -1.0).add(OFF).add(left()).linear(20.0, 0.0, -1.0);
    let draft = draft.add(left()).linear(30.0, 0.0, -1.0).add(OFF).linear(30.0, 9.0, -1.0);
    let text = made(&draft.cl, "linuxcnc", None).text;
    assert_eq!((text.matches("G41").count(), text.matches("G40").count()), (1, 2), "{text}");
}

#[test]
fn a_control_without_it_gets_the_points_and_says_so_once() {
    let draft = start().add(left()).linear(10.0, 0.0, -1.0).add(OFF).linear(20.0, 0.0, -1.0);
    let draft = draft.add(left()).linear(30.0, 0.0, -1.0);
    let made = made(&draft.cl, "grbl", None);
    assert_eq!(made.notes, ["W1010"]);
    assert!(!made.text.contains("G41"), "{}", made.text);
}

#[test]
fn a_register_that_cannot_be_said_is_told() {
    let draft =
        start().add(on(Side::Left, Some(21))).linear(10.0, 0.0, -1.0).add(OFF).linear(20.0, 0.0, -1.0);
    let (_, messages) = lowered(&draft.cl, &dialect("sinumerik", None), None);
    assert!(
        messages.iter().any(|m| m.code.id == "W1022" && m.message.contains("register 21")),
        "{messages:#?}"
    );
}

#[test]
fn the_way_from_a_tool_change_begins_it() {
    let draft = start().rapid(0.0, 0.0, 5.0);
    let tool = draft.cl.tools.iter().map(|(handle, _)| handle).next().unwrap();
    let draft = draft.add(RecordKind::LoadTool(tool)).add(RecordKind::Spindle(Spindle::on(900.0, true)));
    let draft = arc(draft.add(left()).rapid(0.0, 0.0, 5.0).linear(0.0, 0.0, -1.0), 10.0);
    let draft = draft.add(OFF).linear(40.0, 10.0, -1.0);
    for post in ["fanuc", "heidenhain", "sinumerik", "linuxcnc"] {
        made(&draft.cl, post, None);
    }
}

#[test]
fn a_post_may_leave_it_out() {
    let draft = start().add(left()).linear(10.0, 0.0, -1.0).add(OFF).linear(20.0, 0.0, -1.0);
    let text = "inherits = \"linuxcnc\"\n[compensation]\nregister = \"none\"\n";
    let made = made_with(&draft.cl, &dialect("mine.post.toml", Some(text)), None);
    assert_eq!(made.notes, ["W1010"]);
    assert!(!made.text.contains("G41"), "{}", made.text);
}

#[test]
fn fits_under_compensation_are_no_curves() {
    let draft = Draft::new().rapid(90.0, 90.0, 25.0).add(on(Side::Right, None));
    let draft = draft.contour(plate(Interpolation::Auto, Lead::Arc(4.0))).add(OFF).rapid(90.0, 90.0, 25.0);
    let made = made(&draft.cl, "fanuc", None);
    assert!(!made.text.contains("G6.2") && made.text.contains("G42"), "{}", made.text);
}

#[test]
fn a_straight_lead_begins_it_at_depth() {
    let cut = |lead| {
        let draft = Draft::new().rapid(90.0, 90.0, 25.0).add(on(Side::Right, None));
        let draft = draft.contour(plate(Interpolation::Circular, lead)).add(OFF).rapid(90.0, 90.0, 25.0);
        made(&draft.cl, "fanuc", None).text
    };
    let begins = |text: &str| text.lines().position(|line| line.contains("G42 D1")).unwrap();
    let down = |text: &str| text.lines().position(|line| line.contains("G1 Z-")).unwrap();
    let (straight, round) = (cut(Lead::Line(4.0)), cut(Lead::Arc(4.0)));
    assert_eq!(begins(&straight), down(&straight) + 1, "{straight}");
    assert!(begins(&round) < down(&round), "{round}");
}

#[test]
fn compensation_into_the_part_is_refused() {
    // The part lies left of it.
    let cut = |side| {
        let draft = Draft::new().rapid(90.0, 90.0, 25.0).add(on(side, None));
        let draft = draft.contour(plate(Interpolation::Circular, Lead::Arc(4.0)));
        lowered(&draft.add(OFF).rapid(90.0, 90.0, 25.0).cl, &dialect("fanuc", None), None)
    };
    let (target, messages) = cut(Side::Left);
    assert!(target.is_none());
    assert!(messages.iter().any(|m| m.message.contains("into the part, which lies left")), "{messages:#?}");
    assert!(cut(Side::Right).0.is_some());
}

#[test]
fn what_controls_do_not_carry_out_is_refused() {
    let tool = start().cl.tools.iter().map(|(handle, _)| handle).next().unwrap();
    let compensated = || start().add(left()).linear(10.0, 0.0, -1.0);
    for (words, draft) in [
        ("begins on an arc", arc(start().add(left()), 10.0)),
        ("ends on an arc", arc(compensated().add(OFF), 20.0)),
        ("changes its side or its register", compensated().add(on(Side::Right, None))),
        ("changes its side or its register", compensated().add(OFF).add(on(Side::Left, Some(4)))),
        ("before the end", compensated()),
        ("before a tool change", compensated().add(RecordKind::LoadTool(tool)).rapid(0.0, 0.0, 5.0)),
        ("before a drilling cycle", compensated().add(RecordKind::BeginCycle(Box::new(drilling())))),
    ] {
        let draft = draft.linear(40.0, 10.0, -1.0);
        let (target, messages) = lowered(&draft.cl, &dialect("fanuc", None), None);
        assert!(target.is_none(), "{words}");
        let errors: Vec<_> = messages.iter().filter(|m| m.code.id == "E0611").collect();
        assert!(errors.iter().any(|m| m.message.contains(words)), "{words}: {messages:#?}");
    }
}

#[test]
fn tables_and_other_planes_are_refused_under_it() {
    let draft = Draft::new().rapid(90.0, 0.0, 25.0).add(on(Side::Right, None));
    let draft = draft.contour(plate(Interpolation::RTheta, Lead::Plunge)).add(OFF).rapid(90.0, 0.0, 25.0);
    let rotary = Some(crate::ir::Rotary { letter: Some('C'), reversed: false });
    let (target, messages) = lowered(&draft.cl, &dialect("fanuc", None), rotary);
    assert!(target.is_none());
    assert!(messages.iter().any(|m| m.message.contains("while the table turns")), "{messages:#?}");
}
