//! The flat tables the writer runs on, compiled from a dialect for one program.

use super::dialect::{ArcForm, Dialect, FullCircleWords, NumberingMode, Spec};
use super::number::Style;
use super::pattern::{Item, SLOTS, Slot};
use crate::target::Capabilities;
use crate::units::LengthUnit;

/// A word: prefix, spelling of its number, and whether it may be left out when unchanged.
#[derive(Debug, Clone, Default)]
pub(super) struct WordFormat {
    pub prefix: Box<[u8]>,
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

/// Everything a motion block needs.
#[derive(Debug, Clone)]
pub(super) struct MotionTable {
    pub words: [WordFormat; SLOTS],
    pub feeds: [WordFormat; 3],
    pub patterns: [Box<[Item]>; 3],
    pub codes: [Box<[u8]>; 4],
    pub directions: [Box<[u8]>; 2],
    pub modes: [Box<[u8]>; 3],
    pub modal_motion: bool,
    pub form: ArcForm,
    pub drop_zero: bool,
    pub full_circle: FullCircleWords,
    /// Steps of centre words in one step of linear words.
    pub centre_per_linear: i64,
    pub separator: Box<[u8]>,
    pub newline: &'static [u8],
    pub numbering: NumberingMode,
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
            }
        }
        let codes = &spec.codes;
        let bytes = |text: &str| -> Box<[u8]> { text.as_bytes().into() };
        MotionTable {
            words,
            feeds: ["feed", "feed-per-revolution", "feed-inverse-time"]
                .map(|name| word(spec, name, spec.modal.feed, unit)),
            patterns: [&spec.patterns.rapid, &spec.patterns.line, &spec.patterns.arc].map(|p| items(p)),
            codes: [&codes.rapid, &codes.line, &codes.arc_cw, &codes.arc_ccw].map(|c| bytes(c)),
            directions: [bytes(&codes.direction_cw), bytes(&codes.direction_ccw)],
            modes: [bytes(&codes.per_minute), bytes(&codes.per_revolution), bytes(&codes.inverse_time)],
            modal_motion: spec.modal.motion,
            form: spec.arcs.form,
            drop_zero: spec.arcs.zero_offsets == "drop",
            full_circle: spec.arcs.full_circle,
            centre_per_linear: centre_per_linear(capabilities),
            separator: bytes(&spec.line.separator),
            newline: if spec.file.newline == "crlf" { b"\r\n" } else { b"\n" },
            numbering: spec.numbering.mode,
        }
    }
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
        Slot::I | Slot::J | Slot::Cx | Slot::Cy | Slot::Radius => false,
    }
}

pub(super) fn word(spec: &Spec, name: &str, modal: bool, unit: LengthUnit) -> WordFormat {
    spec.words.get(name).map_or_else(WordFormat::default, |word| WordFormat {
        prefix: word.prefix.as_bytes().into(),
        style: spec.style(name, word, unit),
        modal: word.modal.unwrap_or(modal),
    })
}

/// Items were checked when the dialect was loaded.
fn items(pattern: &[String]) -> Box<[Item]> {
    pattern.iter().filter_map(|item| Item::parse(item)).collect()
}
