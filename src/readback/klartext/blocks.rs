//! What each block says: moves, tools, cycles, switches.

use super::words::Word;
use super::{LARGEST, Reader};
use crate::geom::Side;
use crate::readback::out::Out;
use crate::readback::{Compensated, EventKind, Follow, Washing};

/// What the words of a motion block ask for.
#[derive(Debug, Default, Clone)]
pub(super) struct Asked {
    /// X, Y, Z, rotary: value and whether it counts from where the tool is.
    pub axes: [Option<(f64, bool)>; 4],
    /// `IPA` and `PA`, degrees.
    pub polar: Option<(f64, bool)>,
    /// Signed radius of `CR`, program units.
    pub radius: Option<f64>,
    /// `DR-`.
    pub clockwise: Option<bool>,
    /// R0, RL, RR.
    pub compensation: Option<Option<Side>>,
    /// FMAX.
    pub rapid: bool,
    /// F word, program units.
    pub feed: Option<f64>,
    /// M codes.
    pub m: Vec<u32>,
    /// S word.
    pub speed: Option<f64>,
    /// `K` words of a spline.
    pub spline: super::spline::Coefficients,
    /// Length of `MB`: the tool axis retracts, by this or to its end.
    pub back: bool,
}

impl Asked {
    /// Whether an axis is named.
    pub(super) fn moves(&self) -> bool {
        self.axes.iter().any(Option::is_some)
    }
}

impl Reader<'_> {
    /// Executes a block.
    pub(super) fn block<S: Follow>(&mut self, words: &[Word], out: &mut Out<'_, S>) {
        let name = |i: usize| match words.get(i) {
            Some(Word::Name(name)) => name.as_str(),
            _ => "",
        };
        if self.state.ended && name(0) != "END" {
            return out.fault("a block after the end of the program");
        }
        let rest = words.get(1..).unwrap_or_default();
        let coefficient = |w: &Word| matches!(w, Word::Address(a, _) if a.starts_with('K'));
        if name(0) != "SPL" && words.iter().any(coefficient) {
            return out.fault("coefficients of a spline outside SPL");
        }
        match (name(0), name(1)) {
            ("END", "PGM") => self.end(words, out),
            ("L", _) => self.with(rest, out, Self::straight),
            ("CC", _) => self.with(rest, out, Self::pole),
            ("C", _) => self.with(rest, out, Self::circle),
            ("SPL", _) => self.with(rest, out, Self::spline),
            ("CR", _) => self.with(rest, out, Self::circle_by_radius),
            ("CP", _) => self.with(rest, out, Self::circle_by_angle),
            ("TOOL", "CALL") => self.tool_call(words.get(2..).unwrap_or_default(), out),
            ("TOOL", "DEF") => {}
            ("CYCL", "DEF") => self.define(words.get(2..).unwrap_or_default(), out),
            ("CYCL", "CALL") => self.call(words.get(2..).unwrap_or_default(), out),
            ("BLK", "FORM") | ("FUNCTION", "RESET") | ("PLANE", "RESET") => {}
            ("STOP", _) => {
                self.stop(false, out);
                self.with(rest, out, |_, _, _| {});
            }
            ("M140", "MB") | ("M140", _) => self.with(words, out, |_, _, _| {}),
            _ if matches!(words.first(), Some(Word::Address(a, _)) if a == "M") => {
                self.with(words, out, |_, _, _| {});
            }
            (first, _) => {
                let shown = if first.is_empty() { "the block" } else { first };
                out.fault(format!("{shown} is not followed by this reader"));
            }
        }
    }

    /// Takes the words of a motion block apart and executes it: switches that come first, the motion, those that come
    /// last.
    fn with<S: Follow>(
        &mut self,
        words: &[Word],
        out: &mut Out<'_, S>,
        motion: impl FnOnce(&mut Self, &Asked, &mut Out<'_, S>),
    ) {
        let asked = self.asked(words, out);
        if let Some(feed) = asked.feed {
            self.state.feed = Some(self.scaled_feed(feed));
        }
        self.state.speed = asked.speed.unwrap_or(self.state.speed);
        for &m in &asked.m {
            self.early(m, out);
        }
        if let Some(side) = asked.compensation {
            let on = side.map(|side| Compensated { side, register: None });
            self.state.compensation_due |= self.state.compensation != on;
            self.state.compensation = on;
        }
        motion(self, &asked, out);
        for &m in &asked.m {
            self.late(m, &asked, out);
        }
    }

    /// F in mm/min, 0.1 inch/min in inch programs; a revolution in the place of the minute under M136.
    pub(super) fn scaled_feed(&self, feed: f64) -> f64 {
        if self.state.inch { feed * 2.54 } else { feed }
    }

    fn asked<S: Follow>(&self, words: &[Word], out: &mut Out<'_, S>) -> Asked {
        let mut asked = Asked::default();
        for word in words {
            let fresh = match word {
                Word::Address(address, value) => self.address(&mut asked, address, *value, out),
                Word::Name(name) => named(&mut asked, name, out),
                Word::Parameter(index, _) => {
                    out.fault(format!("Q{index} in a motion block"));
                    true
                }
                Word::Quoted(text) => {
                    out.fault(format!("\"{text}\" in a motion block"));
                    true
                }
            };
            if !fresh {
                out.fault(format!("{} twice in one block", shown(word)));
            }
        }
        asked
    }

    /// Stores an address; `false` when it was there already.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn address<S: Follow>(&self, asked: &mut Asked, address: &str, value: f64, out: &mut Out<'_, S>) -> bool {
        if address.starts_with('K') {
            if let Err(fault) = asked.spline.put(address, value) {
                out.fault(fault);
            }
            return true;
        }
        if value.abs() > LARGEST {
            out.fault(format!("{address}{value} is not in -{LARGEST} to {LARGEST}"));
        }
        let (incremental, letter) = match address.strip_prefix('I') {
            Some(rest) => (true, rest),
            None => (false, address),
        };
        let axis = match letter {
            "X" => Some(0),
            "Y" => Some(1),
            "Z" => Some(2),
            l if self
                .setup
                .rotary_letter()
                .is_some_and(|r| l.len() == 1 && l.as_bytes().first() == Some(&r)) =>
            {
                Some(3)
            }
            _ => None,
        };
        if let Some(slot) = axis.and_then(|a: usize| asked.axes.get_mut(a)) {
            return slot.replace((value, incremental)).is_none();
        }
        match address {
            "PA" | "IPA" => asked.polar.replace((value, incremental)).is_none(),
            "R" if value == 0.0 => asked.compensation.replace(None).is_none(),
            "R" => asked.radius.replace(value).is_none(),
            "F" => asked.feed.replace(value).is_none(),
            "S" => asked.speed.replace(value).is_none(),
            "M" if value.fract() == 0.0 && (0.0..1000.0).contains(&value) => {
                let code = value as u32;
                let fresh = !asked.m.contains(&code);
                asked.m.push(code);
                fresh
            }
            "MB" => !core::mem::replace(&mut asked.back, true),
            _ => {
                out.fault(format!("{address}{value} is not followed here by this reader"));
                true
            }
        }
    }

    /// M codes that act at the start of a block.
    fn early<S: Follow>(&mut self, m: u32, out: &mut Out<'_, S>) {
        let state = &mut self.state;
        match m {
            3 | 13 => state.direction = 1.0,
            4 | 14 => state.direction = -1.0,
            7 => state.coolant.mist = true,
            8 => state.coolant.flood = true,
            136 | 137 => {
                state.per_revolution = m == 136;
                state.feed = None;
            }
            0 | 1 | 2 | 5 | 6 | 9 | 30 | 91 | 92 | 94 | 99 | 117 | 129 | 140 => {}
            _ => out.fault(format!("M{m} is not followed by this reader")),
        }
        if matches!(m, 13 | 14) {
            state.coolant.flood = true;
        }
    }

    /// M codes that act at the end of a block.
    fn late<S: Follow>(&mut self, m: u32, asked: &Asked, out: &mut Out<'_, S>) {
        match m {
            0 | 1 => self.stop(m == 1, out),
            2 | 30 => self.over(),
            5 => self.state.direction = 0.0,
            9 => self.state.coolant = Washing::default(),
            99 => self.drill(out),
            140 => self.state.known[2] = false,
            _ => {}
        }
        if m == 140 && !asked.back {
            out.fault("M140 without MB");
        }
    }

    /// M0, M1 and STOP stop the spindle and the coolant, too.
    fn stop<S: Follow>(&mut self, optional: bool, out: &mut Out<'_, S>) {
        self.state.direction = 0.0;
        self.state.coolant = Washing::default();
        out.event(EventKind::Stop { optional });
    }

    /// M2 and M30: what follows but END PGM is never reached.
    fn over(&mut self) {
        self.state.ended = true;
        self.state.direction = 0.0;
        self.state.coolant = Washing::default();
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn tool_call<S: Follow>(&mut self, words: &[Word], out: &mut Out<'_, S>) {
        let mut number = None;
        for word in words {
            match word {
                Word::Name(name) if name == "Z" => self.state.tool_axis = true,
                Word::Name(name) if matches!(name.as_str(), "X" | "Y" | "U" | "V" | "W") => {
                    self.state.tool_axis = false;
                    out.fault(format!("the spindle axis {name}, which this reader does not follow"));
                }
                Word::Name(name) => match super::words::value_of(name) {
                    Some(n) if n.fract() == 0.0 && (0.0..=32_767.0).contains(&n) => number = Some(n as u32),
                    _ => out.fault(format!("{name} in a tool call")),
                },
                Word::Quoted(name) => match self.setup.tool_names.iter().find(|(n, _)| n == name) {
                    Some((_, n)) => number = Some(*n),
                    None => out.fault(format!("no tool \"{name}\" in the tool table")),
                },
                Word::Address(a, value) if a == "S" && (0.0..=99_999.999).contains(value) => {
                    self.state.speed = *value
                }
                Word::Address(a, value) if a == "F" => self.state.feed = Some(self.scaled_feed(*value)),
                other => out.fault(format!("{} in a tool call", shown(other))),
            }
        }
        let Some(tool) = number else { return };
        if !self.state.tool_axis {
            out.fault("a tool call without the spindle axis");
        }
        if self.setup.tools.as_ref().is_some_and(|known| tool != 0 && !known.contains(&tool)) {
            out.fault(format!("tool {tool} is not in the tool table"));
        }
        if self.state.compensation.is_some() {
            out.fault("a tool call under radius compensation");
        }
        self.state.compensation_due = false;
        self.state.tool = tool;
        self.state.direction = 0.0;
        self.state.known = [false, false, false, self.state.known[3]];
        out.event(EventKind::ToolChange(tool));
    }
}

fn named<S: Follow>(asked: &mut Asked, name: &str, out: &mut Out<'_, S>) -> bool {
    match name {
        "FMAX" => !core::mem::replace(&mut asked.rapid, true),
        "RL" => asked.compensation.replace(Some(Side::Left)).is_none(),
        "RR" => asked.compensation.replace(Some(Side::Right)).is_none(),
        "DR+" => asked.clockwise.replace(false).is_none(),
        "DR-" => asked.clockwise.replace(true).is_none(),
        "MB" | "MAX" => {
            asked.back = true;
            true
        }
        _ => {
            out.fault(format!("unknown word {name}"));
            true
        }
    }
}

fn shown(word: &Word) -> String {
    match word {
        Word::Address(address, value) => format!("{address}{value}"),
        Word::Name(name) => name.clone(),
        Word::Parameter(index, value) => format!("Q{index}={value}"),
        Word::Quoted(text) => format!("\"{text}\""),
    }
}
