//! Frames, comments, dwells, tool changes: whole small programs, as snapshots.

use super::build::{Sheet, builtin};
use crate::ir::{Coolant, Spindle};
use crate::target::{BlockKind, axes};
use crate::units::LengthUnit;

/// A program that goes through every kind of block.
fn tour(name: &str, unit: LengthUnit) -> String {
    let sheet = Sheet::new(builtin(name), unit, None).title("Cam) plate %\nØ40; G0 X0");
    let step = 10i64.pow(u32::from(sheet.program.capabilities.grid.linear_decimals));
    sheet
        .event(BlockKind::ToolChange(0))
        .event(BlockKind::Spindle(Spindle::On { rpm: 1200.0, clockwise: true }))
        .event(BlockKind::Coolant(Coolant::Flood))
        .event(BlockKind::BeginOperation("FINISH".into()))
        .event(BlockKind::PathTolerance(None))
        .rapid(0, 0, 5 * step, axes::Z)
        .rapid(10 * step, 0, 5 * step, axes::X | axes::Y)
        .line_z(-step)
        .arc(10 * step, 0, [-10 * step, 0], false)
        .arc(-10 * step, 0, [-10 * step, 0], false)
        .event(BlockKind::Dwell(0.5))
        .event(BlockKind::Comment("MSG, not a message".into()))
        .event(BlockKind::Stop)
        .event(BlockKind::Coolant(Coolant::Off))
        .event(BlockKind::Spindle(Spindle::Off))
        .event(BlockKind::End)
        .text()
}

#[test]
fn a_tour_of_linuxcnc() {
    insta::assert_snapshot!("tour_linuxcnc", tour("linuxcnc", LengthUnit::Millimetre));
}
#[test]
fn a_tour_of_fanuc() {
    insta::assert_snapshot!("tour_fanuc", tour("fanuc", LengthUnit::Millimetre));
}
#[test]
fn a_tour_of_grbl_in_inches() {
    insta::assert_snapshot!("tour_grbl_inch", tour("grbl", LengthUnit::Inch));
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
    let sheet = Sheet::at("fanuc", 0, 0).event(BlockKind::Spindle(Spindle::On { rpm: 0.2, clockwise: true }));
    assert_eq!(sheet.codes(), ["E0712"]);
}

#[test]
fn lines_belong_to_their_blocks() {
    let sheet = Sheet::mm("grbl").rapid(0, 0, 0, 7).line(0, 0).line(1000, 0).event(BlockKind::End);
    let written = sheet.written().unwrap();
    assert_eq!(written.lines, [(1, 2), (2, 3), (3, 3), (3, 4), (4, 5)]);
    assert_eq!(written.text.lines().count(), 4);
}
