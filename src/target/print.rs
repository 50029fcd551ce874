//! The target program as text (`--emit target`): one line a block, numbers as they will be printed.

use core::fmt::Write as _;

use super::number::plain;
use super::{Block, BlockKind, FeedWord, Grid, Motion, Nurbs, Plane, Position, TargetProgram, axes};
use crate::cl::{CycleKind, RetractTo};
use crate::ir::{Coolant, Spindle};

/// The whole program.
#[must_use]
pub fn print(program: &TargetProgram) -> String {
    let mut out = String::new();
    header(&mut out, program);
    for block in &program.blocks {
        line(&mut out, program, block);
    }
    out
}

fn header(out: &mut String, program: &TargetProgram) {
    let capabilities = &program.capabilities;
    let grid = &capabilities.grid;
    // Writing to a String cannot fail.
    let _ = writeln!(
        out,
        "target {} unit {} decimals {} centre {} rotary {}",
        capabilities.name,
        grid.unit.symbol(),
        grid.linear_decimals,
        grid.centre_decimals,
        grid.rotary_decimals
    );
    if let Some(title) = &program.title {
        let _ = writeln!(out, "title {title:?}");
    }
    for (index, tool) in program.tools.iter().enumerate() {
        let _ = writeln!(out, "tool {index} number {} name {}", tool.number.unwrap_or(0), tool.name);
    }
    for (index, piece) in program.pieces.iter().enumerate() {
        let _ = write!(
            out,
            "piece {index} operation {} {:?} z {} band {} {} part {:?} blocks {}",
            piece.operation,
            piece.interpolation,
            piece.z,
            piece.band.into,
            piece.band.out,
            piece.part,
            piece.blocks
        );
        let bound = piece.lower_bound.map_or_else(String::new, |b| format!(" at least {b}"));
        let _ = writeln!(out, "{bound}");
    }
}

fn line(out: &mut String, program: &TargetProgram, block: &Block) {
    let piece = block.piece.map_or_else(String::new, |p| format!(" ; piece {}", p.0));
    let text = match &block.kind {
        BlockKind::Begin => "begin".into(),
        BlockKind::End => "end".into(),
        BlockKind::ToolChange(tool) => format!("tool-change {tool}"),
        BlockKind::Spindle(Spindle::Off) => "spindle off".into(),
        BlockKind::Spindle(Spindle::On { rpm, clockwise, .. }) => {
            format!("spindle {rpm} {}", if *clockwise { "clockwise" } else { "counter-clockwise" })
        }
        BlockKind::Coolant(coolant) => format!("coolant {}", coolant_name(*coolant)),
        BlockKind::Compensation(None) => "compensation off".into(),
        BlockKind::Compensation(Some(on)) => format!("compensation {on}"),
        BlockKind::Dwell(seconds) => format!("dwell {seconds} s"),
        BlockKind::Stop => "stop".into(),
        BlockKind::OptionalStop => "optional-stop".into(),
        BlockKind::Comment(text) => format!("comment {text:?}"),
        BlockKind::Insert(text) => format!("insert {text:?}"),
        BlockKind::PathTolerance(None) => "path exact".into(),
        BlockKind::PathTolerance(Some(tolerance)) => format!("path {tolerance} mm"),
        BlockKind::BeginOperation(name) => format!("operation {name:?}"),
        BlockKind::Motion(motion) => motion_text(program, motion),
        BlockKind::BeginCycle(cycle) => cycle_text(program, *cycle),
        BlockKind::Hole(at) => {
            let grid = &program.capabilities.grid;
            let rotary = program.capabilities.rotary.map(|r| r.letter);
            format!("hole{}", position(grid, rotary, at, ALL))
        }
        BlockKind::EndCycle => "end-cycle".into(),
    };
    let _ = writeln!(out, "{text}{piece}");
}

fn coolant_name(coolant: Coolant) -> &'static str {
    match coolant {
        Coolant::Off => "off",
        Coolant::Flood => "flood",
        Coolant::Mist => "mist",
        Coolant::Through { .. } => "through the tool",
    }
}

fn motion_text(program: &TargetProgram, motion: &Motion) -> String {
    let grid = &program.capabilities.grid;
    let rotary = program.capabilities.rotary.map(|r| r.letter);
    match motion {
        Motion::Rapid { to, axes } => format!("rapid{}", position(grid, rotary, to, *axes)),
        Motion::Line { to, feed } => {
            format!("line{}{}", position(grid, rotary, to, ALL), feed_text(grid, *feed))
        }
        Motion::Arc { to, plane, centre, clockwise, feed } => format!(
            "arc {}{}{} {} {} {} {}{}",
            if *clockwise { "cw" } else { "ccw" },
            plane_text(*plane),
            position(grid, rotary, to, ALL),
            offset_name(*plane, 0),
            plain(centre[0], grid.centre_decimals),
            offset_name(*plane, 1),
            plain(centre[1], grid.centre_decimals),
            feed_text(grid, *feed)
        ),
        Motion::Nurbs { curve, feed } => match program.nurbs.get(*curve as usize) {
            Some(nurbs) => format!("nurbs{}{}", nurbs_text(grid, nurbs), feed_text(grid, *feed)),
            None => "nurbs".into(),
        },
    }
}

/// Nothing for the XY plane.
fn plane_text(plane: Plane) -> &'static str {
    match plane {
        Plane::Xy => "",
        Plane::Zx => " zx",
        Plane::Yz => " yz",
    }
}

fn offset_name(plane: Plane, which: usize) -> char {
    ['i', 'j', 'k'][plane.axes()[which % 3]]
}

fn cycle_text(program: &TargetProgram, index: u32) -> String {
    let Some(cycle) = program.cycles.get(index as usize) else { return "cycle".into() };
    let grid = &program.capabilities.grid;
    let z = |steps: i64| plain(steps, grid.linear_decimals);
    let retract = match cycle.retract {
        RetractTo::Clearance => "clearance",
        RetractTo::Initial => "initial",
    };
    let mut text = format!(
        "cycle {} surface {} bottom {} clearance {} initial {} retract {retract}",
        cycle.kind.name().text(),
        z(cycle.surface),
        z(cycle.bottom),
        z(cycle.clearance),
        z(cycle.initial)
    );
    match cycle.kind {
        CycleKind::Tap { pitch, .. } => _ = write!(text, " pitch {pitch} mm"),
        CycleKind::BoreOrient { shift } => _ = write!(text, " shift {shift} mm"),
        _ => {}
    }
    if let Some(peck) = cycle.peck {
        let _ = write!(text, " peck {}", z(peck));
    }
    if let Some(dwell) = cycle.dwell {
        let _ = write!(text, " dwell {dwell} s");
    }
    text + &feed_text(grid, cycle.feed)
}

const ALL: u8 = axes::X | axes::Y | axes::Z | axes::ROTARY;

fn position(grid: &Grid, rotary: Option<char>, to: &Position, moved: u8) -> String {
    let mut text = String::new();
    let linear = [("x", to.x, axes::X), ("y", to.y, axes::Y), ("z", to.z, axes::Z)];
    for (name, value, _) in linear.into_iter().filter(|(_, _, bit)| moved & bit != 0) {
        let _ = write!(text, " {name} {}", plain(value, grid.linear_decimals));
    }
    if let Some(letter) = rotary.filter(|_| moved & axes::ROTARY != 0) {
        let _ = write!(text, " {} {}", letter.to_ascii_lowercase(), plain(to.r, grid.rotary_decimals));
    }
    text
}

fn feed_text(grid: &Grid, feed: FeedWord) -> String {
    match feed {
        FeedWord::PerMinute(f) => format!(" f {}", plain(f, grid.feed_decimals)),
        FeedWord::PerRevolution(f) => format!(" f {} per rev", plain(f, grid.feed_per_revolution_decimals)),
        FeedWord::InverseTime(f) => format!(" f {} inverse time", plain(f, grid.inverse_time_decimals)),
    }
}

fn nurbs_text(grid: &Grid, nurbs: &Nurbs) -> String {
    let mut text = format!(" order {}", nurbs.order);
    let decimals = grid.linear_decimals + nurbs.finer;
    for (p, w) in &nurbs.points {
        let _ = write!(text, " ({} {}", plain(p.x, decimals), plain(p.y, decimals));
        if nurbs.climbs() {
            let _ = write!(text, " {}", plain(p.z, decimals));
        }
        let _ = write!(text, " {w})");
    }
    let _ = write!(text, " knots {:?}", nurbs.knots);
    text
}
