//! The writer: target blocks to lines.
//!
//! Motion runs on [`MotionTable`]: integers to digits, modality by comparing the integers that are printed.
//! Everything else is cold and goes through words or templates.

use super::dialect::{ArcForm, Dialect, FullCircleWords, NumberingMode};
use super::number;
use super::pattern::{Item, Slot};
use super::table::{
    ARC_CCW, ARC_CW, INVERSE_TIME, LINE, MotionTable, PER_MINUTE, PER_REVOLUTION, RAPID, WordFormat,
};
use crate::arena::Handle;
use crate::diag::Diagnostic;
use crate::ir::Origin;
use crate::target::{FeedWord, Motion, Position, axes};

/// Which pattern a motion takes.
const RAPID_PATTERN: usize = 0;
const LINE_PATTERN: usize = 1;
const ARC_PATTERN: usize = 2;

/// What the control remembers, as far as what was printed tells.
#[derive(Debug, Clone, Default)]
pub(super) struct ModalState {
    /// Printed X, Y, Z, rotary.
    pub axes: [Option<i64>; 4],
    /// Motion code.
    pub motion: Option<usize>,
    /// Feed mode.
    pub mode: Option<usize>,
    /// Feed in that mode.
    pub feed: Option<i64>,
    /// Path tolerance in steps; `Some(None)`: exact path.
    pub path: Option<Option<i64>>,
}

/// A line that the control would not take.
#[derive(Debug, Clone)]
pub(super) struct LineFault {
    pub origin: Handle<Origin>,
    pub length: usize,
    pub text: String,
}

/// Writes blocks to a buffer.
pub(super) struct Writer<'a> {
    pub dialect: &'a Dialect,
    pub table: MotionTable,
    pub out: Vec<u8>,
    pub state: ModalState,
    /// Where the machine is, printed or not.
    pub position: Position,
    /// Words that wait for the first block that moves Z.
    pub with_first_z: Vec<u8>,
    /// Start of the current line in `out`, and of its words after a block number.
    line_start: usize,
    words_start: usize,
    /// Lines finished.
    pub line: u32,
    next_number: u32,
    limit: usize,
    pub origin: Handle<Origin>,
    pub faults: Vec<LineFault>,
    pub errors: Vec<Diagnostic>,
}

impl<'a> Writer<'a> {
    pub fn new(
        dialect: &'a Dialect,
        table: MotionTable,
        origin: Handle<Origin>,
        capacity: usize,
    ) -> Writer<'a> {
        let limit = dialect.spec.line.max_length;
        Writer {
            dialect,
            table,
            out: Vec::with_capacity(capacity),
            state: ModalState::default(),
            position: Position::default(),
            with_first_z: Vec::new(),
            line_start: 0,
            words_start: 0,
            line: 0,
            next_number: dialect.spec.numbering.start,
            limit: if limit == 0 { usize::MAX } else { limit },
            origin,
            faults: Vec::new(),
            errors: Vec::new(),
        }
    }

    /// Starts a line: its number, if it gets one.
    pub fn begin_line(&mut self, numbered: bool) {
        self.line_start = self.out.len();
        self.words_start = self.line_start;
        if numbered && self.table.numbering != NumberingMode::None {
            self.block_number();
        }
    }

    fn block_number(&mut self) {
        let rules = &self.dialect.spec.numbering;
        self.out.extend_from_slice(rules.prefix.as_bytes());
        number::push(&mut self.out, i64::from(self.next_number), &number::Style::default());
        self.out.push(b' ');
        self.words_start = self.out.len();
        self.next_number = self.next_number.saturating_add(rules.step);
        if self.next_number > rules.max {
            self.next_number = rules.start;
        }
    }

    /// Ends a line that has words; takes back one that has none.
    pub fn end_line(&mut self) {
        if self.out.len() == self.words_start {
            self.out.truncate(self.line_start);
            return;
        }
        if self.out.len() - self.line_start > self.limit {
            self.check_length();
        }
        self.out.extend_from_slice(self.table.newline);
        self.line += 1;
    }

    /// A line with this text, unnumbered or not.
    pub fn text_line(&mut self, text: &str, numbered: bool) {
        self.begin_line(numbered);
        self.out.extend_from_slice(text.as_bytes());
        self.end_line();
    }

    #[cold]
    fn check_length(&mut self) {
        let text = String::from_utf8_lossy(&self.out[self.line_start..]).into_owned();
        let length = self.counted_length(&text);
        if length > self.limit {
            self.faults.push(LineFault { origin: self.origin, length, text });
        }
    }

    /// Characters that the control counts.
    fn counted_length(&self, text: &str) -> usize {
        let rules = &self.dialect.spec.line;
        let comments = &self.dialect.spec.comments;
        let mut inside = false;
        let mut length = 0;
        for c in text.chars() {
            let opens = comments.open.starts_with(c);
            inside |= opens;
            let counted = (rules.count_comments || !inside) && (rules.count_spaces || c != ' ');
            length += usize::from(counted);
            inside &= comments.close.is_empty() || !comments.close.ends_with(c);
        }
        length
    }

    /// Separator before every word but the first.
    #[inline]
    fn separate(&mut self) {
        if self.out.len() > self.words_start {
            self.out.extend_from_slice(&self.table.separator);
        }
    }

    /// A text among the words of a line.
    #[inline]
    pub fn text(&mut self, text: &[u8]) {
        if !text.is_empty() {
            self.separate();
            self.out.extend_from_slice(text);
        }
    }

    /// A word.
    #[inline]
    pub fn number(&mut self, format: &WordFormat, value: i64) {
        self.separate();
        self.out.extend_from_slice(&format.prefix);
        number::push(&mut self.out, value, &format.style);
    }

    #[inline]
    fn slot(&mut self, slot: Slot, value: i64) {
        if self.out.len() > self.words_start {
            self.out.extend_from_slice(&self.table.separator);
        }
        let format = &self.table.words[slot as usize];
        self.out.extend_from_slice(&format.prefix);
        number::push(&mut self.out, value, &format.style);
    }

    /// A straight move or an arc.
    pub fn motion(&mut self, motion: &Motion) {
        let block = match *motion {
            Motion::Rapid { to, axes } => MotionBlock {
                pattern: RAPID_PATTERN,
                code: RAPID,
                to,
                axes,
                centre: [0, 0],
                feed: None,
                circle: false,
            },
            Motion::Line { to, feed } => MotionBlock {
                pattern: LINE_PATTERN,
                code: LINE,
                to,
                axes: ALL_AXES,
                centre: [0, 0],
                feed: Some(split_feed(feed)),
                circle: false,
            },
            Motion::Arc { to, centre, clockwise, feed, .. } => MotionBlock {
                pattern: ARC_PATTERN,
                code: if clockwise { ARC_CW } else { ARC_CCW },
                to,
                axes: ALL_AXES,
                centre,
                feed: Some(split_feed(feed)),
                circle: to.x == self.position.x && to.y == self.position.y,
            },
            Motion::Nurbs { .. } => return,
        };
        if self.has_something_to_do(&block) {
            self.begin_line(true);
            if !self.with_first_z.is_empty() && block.axes & axes::Z != 0 {
                let words = core::mem::take(&mut self.with_first_z);
                self.text(&words);
            }
            self.items(&block);
            self.end_line();
            self.arrive(&block);
        }
    }

    /// A straight move to where the machine is prints nothing.
    #[inline]
    fn has_something_to_do(&self, block: &MotionBlock) -> bool {
        block.circle
            || [block.to.x, block.to.y, block.to.z, block.to.r]
                .iter()
                .enumerate()
                .any(|(i, &value)| block.axes & (1 << i) != 0 && self.state.axes[i] != Some(value))
    }

    fn items(&mut self, block: &MotionBlock) {
        // The pattern is taken out of the table so that items can be printed while it is read.
        let pattern = core::mem::take(&mut self.table.patterns[block.pattern]);
        for item in &pattern {
            match item {
                Item::Motion => self.motion_code(block.code),
                Item::FeedMode => self.feed_mode(block),
                Item::Direction => self.direction(block),
                Item::NewLine => {
                    self.end_line();
                    self.begin_line(true);
                }
                Item::Text(text) => self.text(text),
                Item::Word(slot) => self.word(*slot, block),
            }
        }
        self.table.patterns[block.pattern] = pattern;
    }

    #[inline]
    fn motion_code(&mut self, code: usize) {
        if self.table.modal_motion && self.state.motion == Some(code) {
            return;
        }
        if self.out.len() > self.words_start {
            self.out.extend_from_slice(&self.table.separator);
        }
        self.out.extend_from_slice(&self.table.codes[code]);
        self.state.motion = Some(code);
    }

    /// After a change of feed mode no control keeps F.
    #[inline]
    fn feed_mode(&mut self, block: &MotionBlock) {
        let Some((mode, _)) = block.feed else { return };
        if self.state.mode == Some(mode) {
            return;
        }
        let code = core::mem::take(&mut self.table.modes[mode]);
        self.text(&code);
        self.table.modes[mode] = code;
        self.state.mode = Some(mode);
        self.state.feed = None;
    }

    fn direction(&mut self, block: &MotionBlock) {
        let index = usize::from(block.code == ARC_CCW);
        let text = core::mem::take(&mut self.table.directions[index]);
        self.text(&text);
        self.table.directions[index] = text;
    }

    #[inline]
    fn word(&mut self, slot: Slot, block: &MotionBlock) {
        match slot {
            Slot::X => self.axis(slot, 0, block.to.x, block),
            Slot::Y => self.axis(slot, 1, block.to.y, block),
            Slot::Z => self.axis(slot, 2, block.to.z, block),
            Slot::Rotary => self.axis(slot, 3, block.to.r, block),
            Slot::I => self.offset(slot, block.centre[0], block.centre[1]),
            Slot::J => self.offset(slot, block.centre[1], block.centre[0]),
            Slot::Cx => self.slot(slot, self.position.x * self.table.centre_per_linear + block.centre[0]),
            Slot::Cy => self.slot(slot, self.position.y * self.table.centre_per_linear + block.centre[1]),
            Slot::Radius => self.radius(block),
            Slot::Feed => self.feed(block),
        }
    }

    #[inline]
    fn axis(&mut self, slot: Slot, index: usize, value: i64, block: &MotionBlock) {
        let unchanged = self.state.axes[index] == Some(value);
        let print = if block.circle && index < 2 {
            match self.table.full_circle {
                FullCircleWords::Bare | FullCircleWords::Split => false,
                FullCircleWords::OneEndWord => index == 0,
                FullCircleWords::EndWords => true,
            }
        } else {
            block.axes & (1 << index) != 0 && !(unchanged && self.table.words[slot as usize].modal)
        };
        // The rotary word of a machine without one has no letter and never moves.
        if print && !(index == 3 && self.table.words[slot as usize].prefix.is_empty()) {
            self.slot(slot, value);
        }
    }

    #[inline]
    fn offset(&mut self, slot: Slot, value: i64, other: i64) {
        if !(self.table.drop_zero && value == 0 && other != 0) {
            self.slot(slot, value);
        }
    }

    /// R, negative for more than half a turn.
    fn radius(&mut self, block: &MotionBlock) {
        if self.table.form != ArcForm::Radius {
            return;
        }
        let unit = self.table.centre_per_linear;
        let end = [(block.to.x - self.position.x) * unit, (block.to.y - self.position.y) * unit];
        let [cx, cy] = block.centre.map(|v| v as f64);
        let radius = crate::math::hypot(cx, cy).round() as i64;
        let cross = end[0] as f64 * cy - end[1] as f64 * cx;
        let large = if block.code == ARC_CW { cross > 0.0 } else { cross < 0.0 };
        self.slot(Slot::Radius, if large { -radius } else { radius });
    }

    #[inline]
    fn feed(&mut self, block: &MotionBlock) {
        let Some((mode, value)) = block.feed else { return };
        if self.state.feed == Some(value) && mode != INVERSE_TIME && self.table.feeds[mode].modal {
            return;
        }
        if self.out.len() > self.words_start {
            self.out.extend_from_slice(&self.table.separator);
        }
        let format = &self.table.feeds[mode];
        self.out.extend_from_slice(&format.prefix);
        number::push(&mut self.out, value, &format.style);
        self.state.feed = Some(value);
    }

    #[inline]
    fn arrive(&mut self, block: &MotionBlock) {
        let ends = [block.to.x, block.to.y, block.to.z, block.to.r];
        for (index, value) in ends.into_iter().enumerate() {
            if block.axes & (1 << index) != 0 {
                self.state.axes[index] = Some(value);
            }
        }
        let old = self.position;
        let pick = |bit: u8, new: i64, old: i64| if block.axes & bit != 0 { new } else { old };
        self.position = Position {
            x: pick(axes::X, block.to.x, old.x),
            y: pick(axes::Y, block.to.y, old.y),
            z: pick(axes::Z, block.to.z, old.z),
            r: pick(axes::ROTARY, block.to.r, old.r),
        };
    }
}

const ALL_AXES: u8 = axes::X | axes::Y | axes::Z | axes::ROTARY;

/// A motion in the form that patterns read.
struct MotionBlock {
    pattern: usize,
    code: usize,
    to: Position,
    axes: u8,
    centre: [i64; 2],
    feed: Option<(usize, i64)>,
    /// The arc is a full circle.
    circle: bool,
}

pub(super) fn split_feed(feed: FeedWord) -> (usize, i64) {
    match feed {
        FeedWord::PerMinute(value) => (PER_MINUTE, value),
        FeedWord::PerRevolution(value) => (PER_REVOLUTION, value),
        FeedWord::InverseTime(value) => (INVERSE_TIME, value),
    }
}
