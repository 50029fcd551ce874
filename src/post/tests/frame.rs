//! Frames, comments, dwells, tool changes: whole small programs, as snapshots.

use super::build::{Sheet, builtin};
use crate::cl::CycleKind;
use crate::ir::{Coolant, Gear, Spindle};
use crate::target::{BlockKind, Motion, Plane, Position, axes};
use crate::units::LengthUnit;

/// A program that goes through every kind of block that the control has.
fn tour(name: &str, unit: LengthUnit) -> String {
    let mut sheet = Sheet::new(builtin(name), unit, None).title("Cam) plate %\nØ40; G0 X0");
    let step = 10i64.pow(u32::from(sheet.program.capabilities.grid.linear_decimals));
    sheet = sheet
        .event(BlockKind::ToolChange(0))
        .event(BlockKind::Spindle(Spindle::on(1200.0, true)))
        .event(BlockKind::Coolant(Coolant::Flood))
        .event(BlockKind::BeginOperation("FINISH".into()))
        .event(BlockKind::PathTolerance(Some(0.0025)))
        .rapid(10 * step, 0, 5 * step, axes::X | axes::Y | axes::Z)
        .line_z(-step);
    sheet = arcs(sheet, step);
    sheet = sheet
        .event(BlockKind::Dwell(0.5))
        .event(BlockKind::Comment("MSG, not a message".into()))
        .event(BlockKind::Stop)
        .rapid(10 * step, 0, 50 * step, axes::Z);
    sheet = drilling(sheet);
    sheet
        .event(BlockKind::Coolant(Coolant::Off))
        .event(BlockKind::Spindle(Spindle::Off))
        .event(BlockKind::ToolChange(0))
        .event(BlockKind::Spindle(Spindle::on(900.5, false)))
        .event(BlockKind::Spindle(Spindle::On { rpm: 800.0, clockwise: false, range: Gear::Number(2) }))
        .rapid(0, 0, 5 * step, axes::X | axes::Y | axes::Z)
        .line_z(0)
        .event(BlockKind::Insert("M64".into()))
        .line(step, step)
        .event(BlockKind::End)
        .text()
}

/// A whole circle, a long arc, a helix, a half turn in every plane.
fn arcs(sheet: Sheet, step: i64) -> Sheet {
    let centre = step * 10i64.pow(u32::from(sheet.program.capabilities.grid.centre_decimals))
        / 10i64.pow(u32::from(sheet.program.capabilities.grid.linear_decimals));
    let planes: Vec<Plane> = sheet.program.capabilities.planes.keys().copied().collect();
    let feed = sheet.minute();
    let mut sheet = sheet
        .arc(10 * step, 0, [-10 * centre, 0], false)
        .arc(0, 10 * step, [-10 * centre, 0], true)
        .arc(0, -10 * step, [0, -10 * centre], true);
    let to = Position { x: 10 * step, y: 0, z: -2 * step, r: 0 };
    let helix = Motion::Arc { to, plane: Plane::Xy, centre: [0, 10 * centre], clockwise: false, feed };
    sheet = sheet.event(BlockKind::Motion(helix)).at_position(to);
    for plane in planes.into_iter().filter(|p| *p != Plane::Xy) {
        let to = match plane {
            Plane::Zx => Position { x: -10 * step, ..sheet.position() },
            _ => Position { y: sheet.position().y + 20 * step, ..sheet.position() },
        };
        let centre = match plane {
            Plane::Zx => [0, -10 * centre],
            _ => [10 * centre, 0],
        };
        let motion = Motion::Arc { to, plane, centre, clockwise: true, feed };
        sheet = sheet.event(BlockKind::Motion(motion)).at_position(to);
    }
    let at = sheet.position();
    sheet.line(at.x + step, at.y)
}

/// Three holes of every cycle that is kept, two of them at the same place.
fn drilling(mut sheet: Sheet) -> Sheet {
    let kinds = [
        CycleKind::Drill,
        CycleKind::Dwell,
        CycleKind::Deep,
        CycleKind::ChipBreak,
        CycleKind::Tap { pitch: 1.5, left: false },
        CycleKind::Tap { pitch: 1.25, left: true },
        CycleKind::Bore,
        CycleKind::BoreDwell,
        CycleKind::BoreStop,
        CycleKind::BoreOrient { shift: 0.25 },
    ];
    for kind in kinds {
        if sheet.program.capabilities.cycles.contains(&kind.name()) {
            sheet = sheet.drill(kind, &[(10, 20), (10, 30), (10, 30)]);
        }
    }
    sheet
}

#[test]
fn a_tour_of_every_control() {
    for name in crate::post::builtin_names() {
        insta::assert_snapshot!(format!("tour_{name}"), tour(name, LengthUnit::Millimetre));
        insta::assert_snapshot!(format!("tour_{name}_inch"), tour(name, LengthUnit::Inch));
    }
}

#[test]
fn dwells_are_in_the_units_of_the_control() {
    let dwell = |name: &str| Sheet::at(name, 0, 0).event(BlockKind::Dwell(1.25)).rest();
    assert_eq!(dwell("linuxcnc"), ["G4 P1.25"]);
    assert_eq!(dwell("grbl"), ["G4 P1.25"]);
    assert_eq!(dwell("fanuc"), ["G4 P1250"]);
    assert_eq!(Sheet::at("fanuc", 0, 0).event(BlockKind::Dwell(1e6)).codes(), ["E0712"]);
}

#[test]
fn the_control_gets_no_more_of_the_tolerance_than_it_was_given() {
    let path = |mm| Sheet::at("linuxcnc", 0, 0).event(BlockKind::PathTolerance(mm)).rest();
    assert_eq!(path(Some(0.00259)), ["G64 P0.0025 Q0"]);
    assert_eq!(path(Some(0.0025)), ["G64 P0.0025 Q0"]);
    assert_eq!(path(None), [""; 0], "the header has said so");
    let back = Sheet::at("linuxcnc", 0, 0)
        .event(BlockKind::PathTolerance(Some(0.004)))
        .event(BlockKind::PathTolerance(Some(0.004)))
        .event(BlockKind::PathTolerance(None));
    assert_eq!(back.rest(), ["G64 P0.004 Q0", "G61"]);
    assert_eq!(Sheet::at("fanuc", 0, 0).event(BlockKind::PathTolerance(Some(0.01))).rest(), [""; 0]);
}

#[test]
fn long_titles_are_wrapped_and_never_cut_inside_a_bracket() {
    let text = Sheet::mm("linuxcnc").title(&"word ".repeat(100)).text();
    let comments: Vec<&str> = text.lines().take_while(|l| l.starts_with("(word")).collect();
    assert_eq!(comments.len(), 3);
    assert!(comments.iter().all(|l| l.len() <= 202 && l.ends_with(')')));
}

#[test]
fn a_spindle_speed_that_rounds_to_nothing_is_refused() {
    let sheet = Sheet::at("fanuc", 0, 0).event(BlockKind::Spindle(Spindle::on(0.2, true)));
    assert_eq!(sheet.codes(), ["E0712"]);
}

#[test]
fn lines_belong_to_their_blocks() {
    let sheet = Sheet::mm("grbl").rapid(0, 0, 0, 7).line(0, 0).line(1000, 0).event(BlockKind::End);
    let written = sheet.written().unwrap();
    assert_eq!(written.lines, [(1, 2), (2, 3), (3, 3), (3, 4), (4, 5)]);
    assert_eq!(written.text.lines().count(), 4);
}
