//! Cycles: defined once, called at positions.

use super::Reader;
use super::blocks::Asked;
use super::words::Word;
use crate::readback::out::Out;
use crate::readback::{EventKind, Follow, TracePath};
use std::collections::BTreeMap;

/// Most pecks of a hole.
const MOST_PECKS: f64 = 10_000.0;

/// A cycle that CYCL CALL and M99 call.
#[derive(Debug, Clone)]
pub(super) struct Defined {
    number: u32,
    values: BTreeMap<u32, f64>,
}

/// A hole, mm and seconds, feeds mm/min.
#[derive(Debug, Clone, Copy)]
struct Hole {
    clearance: f64,
    surface: f64,
    bottom: f64,
    second: f64,
    feed: f64,
    peck: f64,
    dwell: f64,
    leave: Leave,
    /// Back by this to break the chip, for so many pecks between full retracts.
    chip: Option<(f64, u32)>,
    /// Where the rapid down stops before the last depth.
    advance: f64,
}

/// How the tool leaves a hole.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Leave {
    /// At FMAX.
    Rapid,
    /// At this feed.
    Feed(f64),
    /// Spindle oriented, at this feed.
    Oriented(f64),
    /// With the spindle reversed, at the feed in.
    Reversed,
}

impl Reader<'_> {
    /// `CYCL DEF`.
    pub(super) fn define<S: Follow>(&mut self, words: &[Word], out: &mut Out<'_, S>) {
        let Some(Word::Name(title)) = words.first() else { return out.fault("CYCL DEF without a number") };
        let rest = words.get(1..).unwrap_or_default();
        if let Some((number, part)) = title.split_once('.') {
            return self.old_cycle(number, part, rest, out);
        }
        let Ok(number) = title.parse::<u32>() else {
            return out.fault(format!("CYCL DEF {title} is no cycle"));
        };
        let mut values = BTreeMap::new();
        for word in rest {
            if let Word::Parameter(index, value) = word
                && values.insert(*index, *value).is_some()
            {
                out.fault(format!("Q{index} twice in one cycle"));
            }
        }
        match number {
            247 => self.preset(&values, out),
            200..=203 | 205..=207 => self.state.cycle = Some(Defined { number, values }),
            _ => {
                self.state.cycle = None;
                out.fault(format!("CYCL DEF {number} is not followed by this reader"));
            }
        }
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn preset<S: Follow>(&mut self, values: &BTreeMap<u32, f64>, out: &mut Out<'_, S>) {
        let Some(&number) = values.get(&339).filter(|n| n.fract() == 0.0 && (0.0..=65_000.0).contains(*n))
        else {
            return out.fault("CYCL DEF 247 without the preset's number Q339");
        };
        let number = Some(number as u16);
        if self.state.work_offset != number {
            self.state.known = [false; 4];
        }
        self.state.work_offset = number;
    }

    /// Cycles whose lines are numbered `9.0`, `9.1` …
    fn old_cycle<S: Follow>(&mut self, number: &str, part: &str, words: &[Word], out: &mut Out<'_, S>) {
        let Ok(number) = number.parse::<u32>() else { return out.fault("CYCL DEF without a number") };
        if part == "0" {
            self.state.titled = Some(number);
            if !matches!(number, 7 | 9 | 32) {
                out.fault(format!("CYCL DEF {number} is not followed by this reader"));
            }
            return;
        }
        if self.state.titled != Some(number) {
            return out.fault(format!("CYCL DEF {number}.{part} without {number}.0"));
        }
        match number {
            9 => dwell(words, out),
            32 if part == "1" => self.tolerance(words, out),
            32 => {}
            7 => self.shift(words, out),
            _ => {}
        }
    }

    /// `32.1 T0.01`; without a value the machine's own tolerance is back.
    fn tolerance<S: Follow>(&mut self, words: &[Word], out: &mut Out<'_, S>) {
        self.state.path_tolerance = match words.first() {
            None => 0.0,
            Some(Word::Name(name)) => match name.strip_prefix('T').and_then(super::words::value_of) {
                Some(t) if t >= 0.0 => t * self.unit(),
                _ => return out.fault(format!("{name} is no tolerance")),
            },
            Some(_) => return out.fault("CYCL DEF 32.1 without T"),
        };
    }

    fn shift<S: Follow>(&mut self, words: &[Word], out: &mut Out<'_, S>) {
        for word in words {
            match word {
                Word::Address(_, value) if *value == 0.0 => {}
                _ => out.fault("a datum shift, which this reader does not follow"),
            }
        }
    }

    /// `CYCL CALL`, also `CYCL CALL POS X Y Z`.
    pub(super) fn call<S: Follow>(&mut self, words: &[Word], out: &mut Out<'_, S>) {
        match words.first() {
            None => self.drill(out),
            Some(Word::Address(a, m)) if a == "M" && matches!(*m as i64, 3 | 8 | 13) => self.drill(out),
            _ => out.fault("CYCL CALL with words that this reader does not follow"),
        }
    }

    /// Drills where the tool is.
    pub(super) fn drill<S: Follow>(&mut self, out: &mut Out<'_, S>) {
        let Some(cycle) = self.state.cycle.clone() else { return out.fault("a cycle call without a cycle") };
        if !self.state.known.iter().take(3).all(|k| *k) {
            out.fault("a cycle call at a position that is not known");
            return;
        }
        let Some(hole) = self.hole(&cycle, out) else { return };
        self.state.in_cycle = true;
        self.work_off(&hole, out);
        self.state.in_cycle = false;
    }

    fn hole<S: Follow>(&self, cycle: &Defined, out: &mut Out<'_, S>) -> Option<Hole> {
        let u = self.unit();
        let mut missing = Vec::new();
        let mut need = |index: u32| {
            cycle.values.get(&index).copied().unwrap_or_else(|| {
                missing.push(format!("Q{index}"));
                0.0
            })
        };
        let raw = |index: u32| cycle.values.get(&index).copied().unwrap_or(0.0);
        let (surface, clearance, depth) = (need(203) * u, need(200).abs() * u, need(201) * u);
        let second = need(204) * u;
        let feed = if cycle.number == 207 {
            need(239).abs() * u * self.state.speed
        } else {
            self.scaled_feed(need(206))
        };
        let pecked = matches!(cycle.number, 200 | 203 | 205);
        let peck = if pecked { need(202).abs() * u } else { 0.0 };
        let back = self.scaled_feed(raw(208));
        let back = if back > 0.0 { back } else { feed };
        let (leave, chip, advance) = match cycle.number {
            201 => (Leave::Feed(back), None, clearance),
            202 => (Leave::Oriented(back), None, clearance),
            203 => (
                if raw(208) > 0.0 { Leave::Feed(back) } else { Leave::Rapid },
                self.chip_break(cycle, &raw),
                clearance,
            ),
            205 => (Leave::Rapid, None, need(258).abs() * u),
            206 | 207 => (Leave::Reversed, None, clearance),
            _ => (Leave::Rapid, None, clearance),
        };
        if !missing.is_empty() {
            out.fault(format!("cycle {} without {}", cycle.number, missing.join(", ")));
            return None;
        }
        self.sound(cycle, depth, feed, peck, out)?;
        let dwell = if cycle.number == 207 { 0.0 } else { raw(211) };
        let bottom = surface + depth;
        Some(Hole {
            clearance: surface + clearance,
            surface,
            bottom,
            second: surface + second,
            feed,
            peck,
            dwell,
            leave,
            chip,
            advance,
        })
    }

    /// Cycle 203 breaks the chip Q213 times before it leaves the hole.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn chip_break(&self, cycle: &Defined, raw: &dyn Fn(u32) -> f64) -> Option<(f64, u32)> {
        let times = raw(213);
        let back = cycle.values.get(&256).copied().unwrap_or(0.2) * self.unit();
        (times >= 1.0).then(|| (back, times.min(1e6) as u32))
    }

    /// What the control or the proof can't do with.
    fn sound<S: Follow>(
        &self,
        cycle: &Defined,
        depth: f64,
        feed: f64,
        peck: f64,
        out: &mut Out<'_, S>,
    ) -> Option<()> {
        let raw = |index: u32| cycle.values.get(&index).copied().unwrap_or(0.0);
        if depth >= 0.0 {
            out.fault(format!(
                "the depth Q201={} of cycle {} must be negative",
                depth / self.unit(),
                cycle.number
            ));
            return None;
        }
        if feed.is_nan() || feed <= 0.0 {
            out.fault(format!("cycle {} without a feed", cycle.number));
            return None;
        }
        if peck > 0.0 && -depth / peck > MOST_PECKS {
            out.fault(format!("a peck of Q202={}", peck / self.unit()));
            return None;
        }
        if let Some(index) = [212, 257, 379].into_iter().find(|&i| raw(i) != 0.0) {
            out.fault(format!("Q{index} of cycle {}, which this reader does not follow", cycle.number));
            return None;
        }
        if matches!(cycle.number, 206 | 207) && self.state.speed <= 0.0 {
            out.fault("tapping without a speed");
            return None;
        }
        if cycle.number == 206 && self.state.direction == 0.0 {
            out.fault("tapping with the spindle standing");
            return None;
        }
        Some(())
    }

    fn work_off<S: Follow>(&mut self, hole: &Hole, out: &mut Out<'_, S>) {
        let kept = (self.state.feed, self.state.direction, self.state.per_revolution);
        self.state.per_revolution = false;
        let pitch =
            self.state.cycle.as_ref().filter(|c| c.number == 207).and_then(|c| c.values.get(&239).copied());
        if let Some(pitch) = pitch {
            self.state.direction = if pitch < 0.0 { -1.0 } else { 1.0 };
        }
        self.state.feed = Some(hole.feed);
        self.vertical(hole.clearance, true, out);
        self.pecks(hole, out);
        if hole.dwell > 0.0 {
            out.event(EventKind::Dwell(hole.dwell));
        }
        match hole.leave {
            Leave::Rapid => {}
            Leave::Feed(feed) => {
                self.state.feed = Some(feed);
                self.vertical(hole.clearance, false, out);
            }
            Leave::Oriented(feed) => {
                self.state.direction = 0.0;
                self.state.feed = Some(feed);
                self.vertical(hole.clearance, false, out);
            }
            Leave::Reversed => {
                self.state.direction = -self.state.direction;
                self.vertical(hole.clearance, false, out);
            }
        }
        self.vertical(hole.clearance.max(hole.second), true, out);
        (self.state.feed, self.state.direction, self.state.per_revolution) = kept;
    }

    /// Down in pecks counted from the surface.
    fn pecks<S: Follow>(&mut self, hole: &Hole, out: &mut Out<'_, S>) {
        let mut depth = hole.surface;
        let mut breaks = 0;
        loop {
            depth -= if hole.peck > 0.0 { hole.peck } else { f64::INFINITY };
            if depth <= hole.bottom + 1e-9 {
                return self.vertical(hole.bottom, false, out);
            }
            self.vertical(depth, false, out);
            match hole.chip {
                Some((back, times)) if breaks < times => {
                    breaks += 1;
                    self.vertical((depth + back).min(hole.clearance), true, out);
                }
                _ => {
                    breaks = 0;
                    self.vertical(hole.clearance, true, out);
                    self.vertical((depth + hole.advance).min(hole.clearance), true, out);
                }
            }
        }
    }

    fn vertical<S: Follow>(&mut self, z: f64, rapid: bool, out: &mut Out<'_, S>) {
        let from = self.state.position;
        if from[2] == z {
            return;
        }
        let mut to = from;
        to[2] = z;
        let asked = Asked { axes: [None, None, Some((z, false)), None], rapid, ..Asked::default() };
        let place = self.in_part(&from);
        self.emit(TracePath::Line { from: place, to: place }, from, to, &asked, out);
    }
}

/// `9.1 DWELL 1.5`, seconds.
fn dwell<S: Follow>(words: &[Word], out: &mut Out<'_, S>) {
    let seconds =
        words.iter().rev().find_map(|w| if let Word::Name(n) = w { super::words::value_of(n) } else { None });
    match seconds {
        Some(s) if (0.0..=3600.0).contains(&s) => out.event(EventKind::Dwell(s)),
        Some(s) => out.fault(format!("a dwell of {s} s is not in 0 to 3600")),
        None => out.fault("CYCL DEF 9.1 without the dwell's time"),
    }
}
