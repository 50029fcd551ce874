//! The flat tables the writer runs on, compiled from a dialect for one program.

use super::dialect::{Dialect, FullCircleWords, NumberingMode, Spec};
use super::pattern::{Item, SLOTS, Slot};
use crate::target::number::{self, Style};
use crate::target::{Capabilities, axes};
use crate::units::LengthUnit;

/// A word: prefix, spelling of its number, and whether it may be left out when unchanged.
#[derive(Debug, Clone, Default)]
pub(super) struct WordFormat {
    pub prefix: Box<[u8]>,
    /// The prefix after the separator of words.
    pub spaced: Box<[u8]>,
    pub suffix: Box<[u8]>,
    pub style: Style,
    pub modal: bool,
}

/// Feed modes as indices.
pub(super) const PER_MINUTE: usize = 0;
pub(super) const PER_REVOLUTION: usize = 1;
pub(super) const INVERSE_TIME: usize = 2;

/// Motion codes as indices.
pub(super) const RAPID: usize = 0;
pub(super) const LINE: usize = 1;
pub(super) const ARC_CW: usize = 2;
pub(super) const ARC_CCW: usize = 3;

/// Patterns as indices.
pub(super) const RAPID_PATTERN: usize = 0;
pub(super) const LINE_PATTERN: usize = 1;
pub(super) const HOLE_PATTERN: usize = 2;
/// The first of those of arcs: in XY, ZX and YZ.
pub(super) const ARC_PATTERN: usize = 3;
pub(super) const HELIX_PATTERN: usize = 6;
const PATTERNS: usize = 7;

/// Everything a motion block needs.
#[derive(Debug, Clone)]
pub(super) struct MotionTable {
    pub words: [WordFormat; SLOTS],
    pub feeds: [WordFormat; 3],
    pub axis: WordFormat,
    pub patterns: [Box<[Item]>; PATTERNS],
    /// For every pattern, whether it prints where the block ends; the control knows it only then to the step.
    pub says_end: [bool; PATTERNS],
    pub codes: [Box<[u8]>; 4],
    pub directions: [Box<[u8]>; 2],
    pub planes: [Box<[u8]>; 3],
    pub modes: [Box<[u8]>; 3],
    pub modal_motion: bool,
    pub modal_arc_ends: bool,
    /// Axes that rapid moves say whether they move or not.
    pub rapid_axes: u8,
    pub drop_zero: bool,
    pub signed_radius: bool,
    pub full_circle: FullCircleWords,
    /// Straight moves have a place for what cutter compensation says.
    pub compensation_in_moves: bool,
    /// And say what is in force each time.
    pub compensation_every_move: bool,
    /// F of rapid moves, in steps, where they need one.
    pub rapid_feed: Option<i64>,
    /// Steps of centre words in one step of linear words.
    pub centre_per_linear: i64,
    pub separator: Box<[u8]>,
    pub newline: &'static [u8],
    pub numbering: NumberingMode,
    pub continuation: Box<[u8]>,
    pub ending: Box<[u8]>,
}

impl MotionTable {
    pub fn new(dialect: &Dialect, capabilities: &Capabilities) -> MotionTable {
        let spec = &dialect.spec;
        let unit = capabilities.grid.unit;
        let mut words: [WordFormat; SLOTS] =
            Slot::ALL.map(|slot| word(spec, slot.name(), axis_modal(spec, slot), unit));
        if let Some(rotary) = capabilities.rotary {
            let rotary_word = &mut words[Slot::Rotary as usize];
            if rotary_word.prefix.is_empty() {
                rotary_word.prefix = rotary.letter.to_string().into_bytes().into();
                let spaced = format!("{}{}", spec.line.separator, rotary.letter);
                rotary_word.spaced = spaced.into_bytes().into();
            }
        }
        let codes = &spec.codes;
        let bytes = |text: &str| -> Box<[u8]> { text.as_bytes().into() };
        let patterns = patterns(spec);
        MotionTable {
            words,
            feeds: ["feed", "feed-per-revolution", "feed-inverse-time"]
                .map(|name| word(spec, name, spec.modal.feed, unit)),
            axis: word(spec, "axis", false, unit),
            says_end: core::array::from_fn(|i| {
                i <= LINE_PATTERN || [Slot::X, Slot::Y].iter().any(|s| patterns[i].contains(&Item::Word(*s)))
            }),
            patterns,
            codes: [&codes.rapid, &codes.line, &codes.arc_cw, &codes.arc_ccw].map(|c| bytes(c)),
            directions: [bytes(&codes.direction_cw), bytes(&codes.direction_ccw)],
            planes: [&codes.plane_xy, &codes.plane_zx, &codes.plane_yz].map(|c| bytes(c)),
            modes: [bytes(&codes.per_minute), bytes(&codes.per_revolution), bytes(&codes.inverse_time)],
            modal_motion: spec.modal.motion,
            modal_arc_ends: spec.modal.arc_ends,
            rapid_axes: if spec.modal.whole_points { axes::X | axes::Y | axes::Z } else { 0 },
            drop_zero: spec.arcs.zero_offsets == "drop",
            signed_radius: spec.arcs.signed_radius,
            full_circle: spec.arcs.full_circle,
            compensation_in_moves: spec.compensation_in_moves(),
            compensation_every_move: spec.compensation.every_move && spec.compensation_in_moves(),
            rapid_feed: rapid_feed(spec, capabilities),
            centre_per_linear: centre_per_linear(capabilities),
            separator: bytes(&spec.line.separator),
            newline: if spec.file.newline == "crlf" { b"\r\n" } else { b"\n" },
            numbering: spec.numbering.mode,
            continuation: bytes(&spec.line.continuation),
            ending: bytes(&spec.line.end),
        }
    }
}

fn patterns(spec: &Spec) -> [Box<[Item]>; PATTERNS] {
    let patterns = &spec.patterns;
    let arc = &patterns.arc;
    let own = |pattern| if Vec::is_empty(pattern) { arc } else { pattern };
    let arcs = [arc, own(&patterns.arc_zx), own(&patterns.arc_yz), own(&patterns.helix)];
    let [xy, zx, yz, helix] = arcs;
    [&patterns.rapid, &patterns.line, &patterns.hole, xy, zx, yz, helix].map(|p| Item::all(p))
}

fn rapid_feed(spec: &Spec, capabilities: &Capabilities) -> Option<i64> {
    let grid = &capabilities.grid;
    let value = spec.feed.rapid / grid.unit.in_mm() * grid.feed_scale;
    number::steps(value, grid.feed_decimals).filter(|steps| *steps > 0)
}

fn centre_per_linear(capabilities: &Capabilities) -> i64 {
    let grid = &capabilities.grid;
    (grid.linear_decimals..grid.centre_decimals).fold(1, |factor, _| factor * 10)
}

/// Arc words are never modal, whatever a post file says of axes.
fn axis_modal(spec: &Spec, slot: Slot) -> bool {
    match slot {
        Slot::X | Slot::Y | Slot::Z | Slot::Rotary => spec.modal.axes,
        Slot::Feed => spec.modal.feed,
        _ => false,
    }
}

pub(super) fn word(spec: &Spec, name: &str, modal: bool, unit: LengthUnit) -> WordFormat {
    spec.words.get(name).map_or_else(WordFormat::default, |word| WordFormat {
        prefix: word.prefix.as_bytes().into(),
        spaced: format!("{}{}", spec.line.separator, word.prefix).into_bytes().into(),
        suffix: word.suffix.as_ref().map_or_else(String::new, |s| s.of(unit)).into_bytes().into(),
        style: spec.style(name, word, unit),
        modal: word.modal.unwrap_or(modal),
    })
}
