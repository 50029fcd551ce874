//! The rows: what controls do differently, as programs and what must come of them.

mod arcs;
mod cycles;
mod dwell;
mod feeds;
mod frame;
mod numbers;
mod text;
mod tools;

use super::judge::Finding;
use super::sheet::Sheet;
use super::trial::Trial;

/// A row to try.
pub(super) struct Try {
    pub area: &'static str,
    pub title: &'static str,
    pub program: fn() -> Sheet,
    /// Judges a program that was proven.
    pub judge: fn(&Trial) -> Finding,
    /// Show the whole program, not only the row's records.
    pub whole: bool,
}

/// All rows, by area.
pub(super) const ROWS: &[Try] = &[
    dwell::BLOCK,
    dwell::LONG,
    dwell::CYCLE,
    arcs::FULL,
    arcs::SEMICIRCLE,
    arcs::LARGE,
    arcs::QUARTER,
    arcs::TINY,
    arcs::SHALLOW,
    arcs::HELIX,
    arcs::HELIX_TURNS,
    arcs::ZX,
    arcs::YZ,
    text::LONG,
    text::BRACKETS,
    text::ACTIVE,
    text::FOREIGN,
    text::TITLE,
    frame::LENGTH,
    numbers::ZERO,
    numbers::POINT,
    numbers::EXPONENT,
    numbers::LARGE,
    feeds::MODES,
    feeds::INCH,
    feeds::SMALL,
    feeds::ROTARY,
    feeds::RAPID,
    tools::CHANGE,
    tools::SPINDLE,
    tools::WORK_OFFSET,
    tools::COOLANT,
    tools::COMPENSATION,
    tools::STOP,
    tools::OPTIONAL_STOP,
    cycles::DRILL,
    cycles::INITIAL,
    cycles::DEEP,
    cycles::CHIP_BREAK,
    cycles::TAP,
    cycles::BORE,
    cycles::BORE_DWELL,
    cycles::BORE_STOP,
    cycles::BORE_ORIENT,
    cycles::MOVE_AFTER,
    arcs::CURVE,
    frame::SMOOTHING,
    frame::LEVELS,
    frame::START,
    frame::END,
];

/// A row of an area.
const fn row(
    area: &'static str,
    title: &'static str,
    program: fn() -> Sheet,
    judge: fn(&Trial) -> Finding,
) -> Try {
    Try { area, title, program, judge, whole: false }
}

/// At most six decimals.
fn number(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    if rounded == 0.0 { "0".to_owned() } else { rounded.to_string() }
}
