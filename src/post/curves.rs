//! NURBS curves, from their patterns.

use super::events::Events;
use super::pattern::{Coefficient, Item, Named, Slot};
use super::table::{WordFormat, word};
use super::writer::split_feed;
use crate::diag::codes;
use crate::target::number;
use crate::target::{FeedWord, Nurbs, NurbsForm, Position};

/// Words of NURBS blocks.
struct Words {
    order: WordFormat,
    knot: WordFormat,
    weight: WordFormat,
}

/// What one block of a curve says.
#[derive(Clone, Copy)]
struct CurveBlock {
    order: u8,
    point: Option<(Position, f64)>,
    /// Z is said, where the pattern has it.
    climbs: bool,
    knot: Option<f64>,
    feed: FeedWord,
}

impl Events<'_> {
    /// A curve, in the form that the control takes.
    pub fn nurbs(&mut self, curve: u32, feed: FeedWord) {
        let Some(nurbs) = self.program.nurbs.get(curve as usize) else { return };
        match self.program.capabilities.nurbs {
            Some(NurbsForm::Pieces { .. }) => self.piece(nurbs, feed),
            _ => self.whole_curve(nurbs, feed),
        }
    }

    /// A NURBS curve: its first block, one for every further control point, and those of the knots left.
    fn whole_curve(&mut self, nurbs: &Nurbs, feed: FeedWord) {
        let spec = &self.writer.dialect.spec.nurbs;
        let [begin, point, rest, end] =
            [&spec.begin, &spec.point, &spec.rest, &spec.end].map(|pattern| Item::all(pattern));
        let words = self.nurbs_words();
        self.between_curves();
        self.home_plane();
        self.curve_feed_mode(feed);
        let climbs = nurbs.climbs();
        let knots = nurbs.knots.iter().map(|k| Some(*k)).chain(core::iter::repeat(None));
        let points = nurbs.points.iter().map(|p| Some(*p));
        let mut knots_left = nurbs.knots.len();
        for (index, (at, knot)) in points.zip(knots).enumerate() {
            let items = if index == 0 { &begin } else { &point };
            let climbs = climbs || index == 0;
            let block = CurveBlock { order: nurbs.order, point: at, climbs, knot, feed };
            self.curve_block(items, &words, block);
            knots_left = knots_left.saturating_sub(1);
        }
        if !rest.is_empty() {
            for knot in nurbs.knots.iter().skip(nurbs.knots.len() - knots_left) {
                let block = CurveBlock { knot: Some(*knot), ..rest_of(nurbs, feed) };
                self.curve_block(&rest, &words, block);
            }
        }
        if !end.is_empty() {
            self.curve_block(&end, &words, rest_of(nurbs, feed));
        }
        self.curve_arrive(nurbs);
    }

    /// One cubic piece: where it ends and its coefficients, which are sums of its control points.
    fn piece(&mut self, nurbs: &Nurbs, feed: FeedWord) {
        let Some(end) = nurbs.end() else { return };
        let items = Item::all(&self.writer.dialect.spec.nurbs.point);
        self.home_plane();
        self.curve_feed_mode(feed);
        self.writer.begin_line(true);
        for item in &items {
            match item {
                Item::Text(text) => self.writer.text(text),
                Item::Word(Slot::Feed) => self.curve_feed(feed),
                Item::Word(slot) => self.curve_axis(*slot, Some((end, 1.0))),
                Item::Coefficient(coefficient) => self.coefficient(*coefficient, nurbs),
                Item::NewLine => {
                    self.writer.end_line();
                    self.writer.begin_line(true);
                }
                // Other items do not pass the check of the dialect.
                _ => {}
            }
        }
        self.writer.end_line();
        self.curve_arrive(nurbs);
    }

    fn coefficient(&mut self, coefficient: Coefficient, nurbs: &Nurbs) {
        let along = |p: &Position| match coefficient.axis {
            0 => p.x,
            1 => p.y,
            _ => p.z,
        };
        let terms = coefficient.shares.iter().zip(&nurbs.points);
        // Lowering has bounded the sum.
        let value = terms.map(|(share, (p, _))| share.saturating_mul(along(p))).fold(0, i64::saturating_add);
        let format = word(&self.writer.dialect.spec, coefficient.name, false, self.unit());
        // A comma belongs to the word before it.
        if !format.prefix.starts_with(b",") {
            self.writer.separate();
        }
        number::push_word(&mut self.writer.out, &format.prefix, value, &format.style);
        self.writer.out.extend_from_slice(&format.suffix);
    }

    fn nurbs_words(&self) -> Words {
        let spec = &self.writer.dialect.spec;
        let unit = self.unit();
        let mut weight = word(spec, "weight", false, unit);
        weight.style.decimals = spec.nurbs.weight_decimals;
        let mut knot = word(spec, "knot", false, unit);
        knot.style.decimals = spec.nurbs.knot_decimals;
        Words { order: word(spec, "order", false, unit), knot, weight }
    }

    /// The feed mode, in a line of its own when it changes: a curve's first block holds the curve only.
    fn curve_feed_mode(&mut self, feed: FeedWord) {
        let (mode, _) = split_feed(feed);
        if self.writer.state.mode != Some(mode) {
            let code = self.writer.table.modes[mode].clone();
            self.writer.begin_line(true);
            self.writer.text(&code);
            self.writer.end_line();
            self.writer.state.mode = Some(mode);
            self.writer.state.feed = None;
        }
    }

    fn curve_block(&mut self, items: &[Item], words: &Words, block: CurveBlock) {
        self.writer.begin_line(true);
        for item in items {
            match item {
                Item::Text(text) => self.writer.text(text),
                Item::Word(Slot::Feed) => self.curve_feed(block.feed),
                Item::Word(Slot::Z) if !block.climbs => {}
                Item::Word(slot) => self.curve_axis(*slot, block.point),
                Item::Named(Named::Order) => self.writer.number(&words.order, i64::from(block.order)),
                Item::Named(Named::Knot) => self.real(&words.knot, block.knot),
                Item::Named(Named::Weight) => self.real(&words.weight, block.point.map(|p| p.1)),
                Item::NewLine => {
                    self.writer.end_line();
                    self.writer.begin_line(true);
                }
                // Other items do not pass the check of the dialect.
                _ => {}
            }
        }
        self.writer.end_line();
    }

    fn curve_axis(&mut self, slot: Slot, point: Option<(Position, f64)>) {
        let Some((at, _)) = point else { return };
        let value = match slot {
            Slot::X => at.x,
            Slot::Y => at.y,
            _ => at.z,
        };
        let format = self.writer.table.words[slot as usize].clone();
        self.writer.number(&format, value);
    }

    fn curve_feed(&mut self, feed: FeedWord) {
        let (mode, value) = split_feed(feed);
        if self.writer.state.feed != Some(value) {
            let format = self.writer.table.feeds[mode].clone();
            self.writer.number(&format, value);
            self.writer.state.feed = Some(value);
        }
    }

    fn real(&mut self, format: &WordFormat, value: Option<f64>) {
        let Some(value) = value else { return };
        match number::steps(value, format.style.decimals) {
            Some(steps) => self.writer.number(format, steps),
            None => {
                self.error(&codes::post::WORD_RANGE, format!("{value} cannot be printed in a NURBS block"))
            }
        }
    }

    fn curve_arrive(&mut self, nurbs: &Nurbs) {
        self.writer.state.motion = None;
        self.writer.state.curve = true;
        if let Some(end) = nurbs.end() {
            let (position, axes) = (&mut self.writer.position, &mut self.writer.state.axes);
            (position.x, position.y) = (end.x, end.y);
            (axes[0], axes[1]) = (Some(end.x), Some(end.y));
            if nurbs.climbs() {
                position.z = end.z;
                axes[2] = Some(end.z);
            }
        }
    }

    /// What keeps a curve from going on the one before it.
    fn between_curves(&mut self) {
        let items = Item::all(&self.writer.dialect.spec.nurbs.between);
        if !self.writer.state.curve || items.is_empty() {
            return;
        }
        self.writer.begin_line(true);
        for item in &items {
            if let Item::Text(text) = item {
                self.writer.text(text);
            }
        }
        self.writer.end_line();
    }
}

/// A block after the control points.
fn rest_of(nurbs: &Nurbs, feed: FeedWord) -> CurveBlock {
    CurveBlock { order: nurbs.order, point: None, climbs: false, knot: None, feed }
}
