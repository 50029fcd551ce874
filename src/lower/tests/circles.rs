//! Circles and drilling cycles of CL data.

use super::cl::Draft;
use super::{Made, dialect, lowered, made};
use crate::cl::{Circle, Cycle, CycleKind, RecordKind, RetractTo};
use crate::geom::{Point3, Vec3};
use crate::ir::Feed;
use crate::target::{BlockKind, Motion, Plane};

fn circle(to: [f64; 3], centre: [f64; 3], axis: [f64; 3], turns: u32) -> RecordKind {
    let axis = Vec3::from(axis).normalize();
    let (to, centre) = (Point3::from(to), Point3::from(centre));
    RecordKind::Circle(Box::new(Circle { to, centre, axis, turns, tolerance: 0.01 }))
}

fn arcs(made: &Made) -> Vec<(Plane, bool, [i64; 3])> {
    let of = |b: &crate::target::Block| match b.kind {
        BlockKind::Motion(Motion::Arc { to, plane, clockwise, .. }) => {
            Some((plane, clockwise, [to.x, to.y, to.z]))
        }
        _ => None,
    };
    made.target.blocks.iter().filter_map(of).collect()
}

fn start() -> Draft {
    Draft::new().rapid(10.0, 0.0, 5.0).linear(10.0, 0.0, -1.0)
}

#[test]
fn arcs_turn_by_the_right_hand_rule_about_their_axis() {
    let up = start().add(circle([0.0, 10.0, -1.0], [0.0, 0.0, -1.0], [0.0, 0.0, 1.0], 0));
    let down = start().add(circle([0.0, 10.0, -1.0], [0.0, 0.0, -1.0], [0.0, 0.0, -1.0], 0));
    for post in ["linuxcnc", "fanuc", "grbl"] {
        let arcs = |draft: &Draft| arcs(&made(&draft.cl, post, None));
        let ends = |draft: &Draft| arcs(draft).iter().map(|a| (a.0, a.1)).collect::<Vec<_>>();
        assert_eq!(ends(&up), [(Plane::Xy, false)], "{post}");
        assert!(ends(&down).iter().all(|a| *a == (Plane::Xy, true)) && !ends(&down).is_empty(), "{post}");
    }
}

#[test]
fn full_circles_and_turns_become_as_many_arcs_as_the_control_wants() {
    let helix = start().add(circle([10.0, 0.0, -4.0], [0.0, 0.0, -1.0], [0.0, 0.0, 1.0], 2));
    let made = made(&helix.cl, "linuxcnc", None);
    let step = made.target.capabilities.grid.linear_step();
    let ends: Vec<f64> =
        arcs(&made).iter().map(|(_, _, p)| (p[2] as f64 * step * 1e3).round() / 1e3).collect();
    // Three turns of 1 mm, each in two halves.
    assert_eq!(ends, [-1.5, -2.0, -2.5, -3.0, -3.5, -4.0]);
    let flat = start().add(circle([10.0, 0.0, -1.0], [0.0, 0.0, -1.0], [0.0, 0.0, -1.0], 0));
    assert_eq!(arcs(&super::made(&flat.cl, "linuxcnc", None)).len(), 1);
}

#[test]
fn circles_that_are_off_the_grid_keep_their_radii_in_printed_numbers() {
    for k in 1..40 {
        let angle = 0.157_3 * f64::from(k);
        let r = 7.123_456_7 + f64::from(k) * 3.3;
        let at = |t: f64| [r * crate::math::cos(t) + 0.1234, r * crate::math::sin(t) - 5.4321, -1.0];
        let from = at(0.3);
        let draft = Draft::new().rapid(from[0], from[1], 5.0).linear(from[0], from[1], -1.0);
        let draft = draft.add(circle(at(0.3 + angle), [0.1234, -5.4321, -1.0], [0.0, 0.0, 1.0], 0));
        let made = made(&draft.cl, "grbl", None);
        assert_eq!(arcs(&made).len(), 1, "{k}");
    }
}

#[test]
fn tilted_circles_are_cut_by_lines_in_tolerance_and_say_so() {
    let to = [0.0, 10.0 / 2.0_f64.sqrt(), -1.0 + 10.0 / 2.0_f64.sqrt()];
    let draft = start().add(circle(to, [0.0, 0.0, -1.0], [0.0, -1.0, 1.0], 0));
    let made = made(&draft.cl, "linuxcnc", None);
    assert!(made.notes.contains(&"N0609"));
    let step = made.target.capabilities.grid.linear_step();
    let radii: Vec<f64> = made
        .target
        .blocks
        .iter()
        .filter_map(|b| match b.kind {
            BlockKind::Motion(Motion::Line { to, .. }) => {
                let [x, y, z] = [to.x, to.y, to.z].map(|v| v as f64 * step);
                Some((x * x + y * y + (z + 1.0) * (z + 1.0)).sqrt())
            }
            _ => None,
        })
        .skip(1)
        .collect();
    assert!(radii.len() > 10 && radii.iter().all(|r| (r - 10.0).abs() < step), "{radii:?}");
}

fn drill(kind: CycleKind, retract: RetractTo) -> Cycle {
    Cycle {
        kind,
        depth: 6.0,
        clearance: 2.0,
        retract,
        peck: Some(3.0),
        first_peck: None,
        dwell: None,
        feed: Feed::PerMinute(120.0),
    }
}

fn holes(cycle: Cycle) -> Draft {
    Draft::new()
        .rapid(0.0, 0.0, 20.0)
        .add(RecordKind::BeginCycle(Box::new(cycle)))
        .add(RecordKind::Hole(Point3::new(10.0, 0.0, 0.0)))
        .add(RecordKind::Hole(Point3::new(20.0, 0.0, 4.0)))
        .add(RecordKind::EndCycle)
}

fn heights(made: &Made) -> Vec<(bool, f64)> {
    let step = made.target.capabilities.grid.linear_step();
    let mut last = i64::MIN;
    let mut out = Vec::new();
    for block in &made.target.blocks {
        let (rapid, z) = match block.kind {
            BlockKind::Motion(Motion::Rapid { to, .. }) => (true, to.z),
            BlockKind::Motion(Motion::Line { to, .. }) => (false, to.z),
            _ => continue,
        };
        if z != last {
            out.push((rapid, (z as f64 * step * 1e3).round() / 1e3));
            last = z;
        }
    }
    out
}

#[test]
fn expanded_cycles_keep_the_levels_of_g98_and_g99() {
    let low = made(&holes(drill(CycleKind::Drill, RetractTo::Clearance)).cl, "grbl", None);
    assert_eq!(
        heights(&low),
        [(true, 20.0), (true, 2.0), (false, -6.0), (true, 2.0), (true, 6.0), (false, -2.0), (true, 6.0)]
    );
    let high = made(&holes(drill(CycleKind::Drill, RetractTo::Initial)).cl, "grbl", None);
    assert_eq!(
        heights(&high),
        [(true, 20.0), (true, 2.0), (false, -6.0), (true, 20.0), (true, 6.0), (false, -2.0), (true, 20.0)]
    );
    assert!(high.notes.contains(&"N0610"));
}

#[test]
fn pecks_count_from_the_clearance_level() {
    let deep = made(&holes(drill(CycleKind::Deep, RetractTo::Clearance)).cl, "grbl", None);
    let first: Vec<(bool, f64)> = heights(&deep).into_iter().skip(1).take(9).collect();
    assert_eq!(
        first,
        [
            (true, 2.0),
            (false, -1.0),
            (true, 2.0),
            (true, -0.5),
            (false, -4.0),
            (true, 2.0),
            (true, -3.5),
            (false, -6.0),
            (true, 2.0)
        ]
    );
    let chips = made(&holes(drill(CycleKind::ChipBreak, RetractTo::Clearance)).cl, "grbl", None);
    let first: Vec<(bool, f64)> = heights(&chips).into_iter().skip(2).take(5).collect();
    assert_eq!(first, [(false, -1.0), (true, -0.5), (false, -4.0), (true, -3.5), (false, -6.0)]);
}

#[test]
fn a_tap_without_its_cycle_is_refused() {
    let cycle = drill(CycleKind::Tap { pitch: 1.25, left: false }, RetractTo::Clearance);
    let (target, messages) = lowered(&holes(cycle).cl, &dialect("grbl", None), None);
    assert!(target.is_none());
    assert!(messages.iter().any(|m| m.code.id == "E0608"), "{messages:#?}");
}
