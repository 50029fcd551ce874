//! Executing blocks: modal state, checks that do not depend on the motion, order of execution.

use super::block::{Block, bit};
use super::codes::{G, Group, M, Mode};
use super::cubic::Cubic;
use super::renamed;
use super::rules::{FeedReset, Language, Rules, Unpointed};
use super::state::{Plan, State};
use crate::readback::out::Out;
use crate::readback::trace::UNKNOWN_CODE;
use crate::readback::{EventKind, FeedMode, Follow, MachineSetup, Washing};

/// Millimetres in an inch.
pub(super) const INCH: f64 = 25.4;
/// Words that are never left unused.
const ALWAYS_USED: u32 = bit(b'N') | bit(b'F') | bit(b'S') | bit(b'T') | bit(b'O');
/// Work offsets that have a code of their own where further ones are counted by P: G54 to G59.
const PLAIN_OFFSETS: u16 = 6;
/// Words that hold lengths.
const LENGTHS: &[u8] = b"XYZIJKUVW";
const LENGTH_BITS: u32 = bit(b'X') | bit(b'Y') | bit(b'Z') | bit(b'I') | bit(b'J') | bit(b'K') | bit(b'R');

/// The executing half of the interpreter.
#[derive(Debug)]
pub(super) struct Machine<'a> {
    pub rules: Rules,
    pub setup: &'a MachineSetup,
    pub state: State,
    pub nurbs: super::nurbs::Open,
    pub frame: super::frame::Seen,
    pub modal_cycle: Option<super::sinumerik::Modal>,
}

impl<'a> Machine<'a> {
    pub(super) fn new(rules: Rules, setup: &'a MachineSetup) -> Self {
        Machine {
            rules,
            setup,
            state: State::new(&rules),
            nurbs: super::nurbs::Open::default(),
            frame: super::frame::Seen::default(),
            modal_cycle: None,
        }
    }

    /// mm in the unit in force.
    pub(super) fn unit(&self) -> f64 {
        if self.state.inch == Some(true) { INCH } else { 1.0 }
    }

    /// Unit name for messages.
    pub(super) fn unit_name(&self) -> &'static str {
        if self.state.inch == Some(true) { "in" } else { "mm" }
    }

    /// A length word in mm.
    pub(super) fn length(&self, block: &Block, letter: u8) -> Option<f64> {
        let value = block.get(letter)?;
        if self.rules.unpointed != Unpointed::Whole && !block.point(letter) {
            let least = if self.state.inch == Some(true) { 10_000.0 } else { 1000.0 };
            return Some(value / least * self.unit());
        }
        Some(value * self.unit())
    }

    /// A rotary word in degrees.
    pub(super) fn degrees(&self, block: &Block, letter: u8) -> Option<f64> {
        let value = block.get(letter)?;
        let least = self.rules.unpointed != Unpointed::Whole && !block.point(letter);
        Some(if least { value / 1000.0 } else { value })
    }

    /// Says once what the program leaves to the control's settings.
    pub(super) fn assume<S: Follow>(&mut self, which: u8, out: &mut Out<'_, S>, message: &str) {
        if self.state.assumed & (1 << which) == 0 {
            self.state.assumed |= 1 << which;
            out.assumed(message);
        }
    }

    /// Executes a block.
    pub(super) fn execute<S: Follow>(&mut self, block: &Block, out: &mut Out<'_, S>) {
        if self.framed(block, out) || block.is_empty() {
            return;
        }
        if self.state.ended {
            return out.fault("a block after the end of the program");
        }
        let Some(plan) = self.decode(block, out) else { return };
        self.spline_over(block, &plan, out);
        self.limits(block, out);
        let mut used = ALWAYS_USED;
        self.modal(block, &plan, &mut used, out);
        if !plan.unfollowed {
            if !self.calls(block, out) {
                self.motion(block, &plan, &mut used, out);
            }
            self.unused(block, used, out);
        }
        self.finish_block(&plan, out);
    }

    /// Gathers the codes by group; `None` when they contradict each other or are unknown.
    fn decode<S: Follow>(&self, block: &Block, out: &mut Out<'_, S>) -> Option<Plan> {
        let mut plan = Plan::default();
        let mut good = true;
        for code in block.g.iter() {
            let piece = code == 50 && self.rules.cubic != Cubic::None;
            let g = if piece { Some(G::Motion(Mode::Cubic)) } else { (self.rules.g)(code) };
            let Some(g) = g else {
                out.fault(format!("{UNKNOWN_CODE}{}", g_name(code)));
                good = false;
                continue;
            };
            good &= self.gather_g(code, g, &mut plan, out);
        }
        for code in block.m.iter() {
            let Some(m) = renamed::inside(code).or_else(|| (self.rules.m)(code)) else {
                out.fault(format!("{UNKNOWN_CODE}M{}", tenths(code)));
                good = false;
                continue;
            };
            good &= gather_m(code, m, &mut plan, out);
        }
        if block.m.len() > self.rules.most_m {
            out.fault(format!(
                "{} M codes in one block, the control takes {}",
                block.m.len(),
                self.rules.most_m
            ));
        }
        if plan.cycle_end {
            plan.motion = plan.motion.or(Some(Mode::None));
            if let Some(Mode::Cycle(_)) = plan.motion {
                out.fault("G80 and a drilling cycle in one block");
                good = false;
            }
        }
        good.then_some(plan)
    }

    fn gather_g<S: Follow>(&self, code: u16, g: G, plan: &mut Plan, out: &mut Out<'_, S>) -> bool {
        let group = g.group();
        let mask = 1u32 << (group as u32);
        if plan.groups & mask != 0 && group != Group::Other {
            out.fault(format!(
                "two codes of one modal group ({}) in a block, the second is {}",
                group.name(),
                g_name(code)
            ));
            return false;
        }
        plan.groups |= mask;
        match g {
            G::Motion(mode) => plan.motion = Some(mode),
            G::CycleEnd => plan.cycle_end = true,
            G::NurbsEnd => plan.nurbs_end = true,
            G::Dwell | G::MachineCoordinates | G::Reference | G::ReturnHeight => plan.once = Some(g),
            G::Return { to_r } => plan.return_to_r = Some(to_r),
            G::Plane(plane) => plan.plane = Some(plane),
            G::Units { inch } => plan.inch = Some(inch),
            G::Distance { incremental } => plan.incremental = Some(incremental),
            G::ArcDistance { incremental } => plan.arc_incremental = Some(incremental),
            G::Feed(mode) => plan.feed = Some(mode),
            G::LengthOn => plan.length = Some(true),
            G::LengthOff => plan.length = Some(false),
            G::ExactPath | G::Blend | G::Smoothing => plan.path = Some(g),
            G::WorkOffset(number) => plan.offset = Some(number),
            G::Compressor => plan.compressor = true,
            G::RadiusOff | G::Radius { .. } => plan.radius = Some(g),
            G::NoEffect(_) => plan.loose = true,
            G::Unfollowed(_) => {
                plan.unfollowed = true;
                out.fault(format!("{} is not followed by this reader", g_name(code)));
            }
        }
        true
    }

    /// Ranges of N, T, S and of lengths.
    fn limits<S: Follow>(&mut self, block: &Block, out: &mut Out<'_, S>) {
        for (letter, largest) in [(b'N', self.rules.largest_n), (b'T', self.rules.largest_t), (b'S', 1e6)] {
            let Some(value) = block.get(letter) else { continue };
            if !(0.0..=largest).contains(&value) {
                out.fault(format!("{}{value} is not in 0 to {largest}", char::from(letter)));
            }
            if letter != b'S' && value.fract() != 0.0 {
                out.fault(format!("{}{value} is not an integer", char::from(letter)));
            }
        }
        if let Some((mm, inch)) = self.rules.largest_length {
            let largest = if self.state.inch == Some(true) { inch } else { mm };
            for letter in LENGTHS.iter().copied().filter(|&l| block.get(l).is_some_and(|v| v.abs() > largest))
            {
                let value = block.get(letter).unwrap_or_default();
                out.fault(format!("{}{value} has more digits than the control takes", char::from(letter)));
            }
        }
        if self.rules.unpointed == Unpointed::Setting && block.seen & LENGTH_BITS & !block.pointed != 0 {
            self.assume(
                5,
                out,
                "a length without a decimal point: whether it counts units or least increments is a setting",
            );
        }
    }

    /// Everything that comes before the motion, in the controls' order of execution.
    fn modal<S: Follow>(&mut self, block: &Block, plan: &Plan, used: &mut u32, out: &mut Out<'_, S>) {
        if plan.inch.is_some_and(|inch| self.state.inch == Some(!inch)) && block.has(b'F') {
            out.assumed(
                "F in the block that changes the unit: in which unit it counts depends on the control",
            );
        }
        self.units(plan.inch);
        self.feed_mode(plan.feed);
        let dwell = plan.once == Some(G::Dwell);
        let of_dwell = |letter: u8| dwell && self.rules.dwell.iter().flatten().any(|(l, _)| *l == letter);
        if let Some(speed) = block.get(b'S').filter(|_| !of_dwell(b'S')) {
            self.state.speed = speed;
        }
        if !of_dwell(b'F') {
            self.feed_word(block, out);
        }
        self.tool(block, plan, out);
        self.spindle(plan.spindle);
        self.dwell(block, plan, used, out);
        if plan.plane.is_some_and(|plane| plane != self.state.plane) {
            self.not_compensated("another plane", out);
        }
        self.state.plane_stated |= plan.plane.is_some();
        self.state.plane = plan.plane.unwrap_or(self.state.plane);
        self.radius(block, plan, used, out);
        self.tool_length(block, plan, used, out);
        self.offset(block, plan, used, out);
        self.path(block, plan.path, used, out);
        if self.rules.language == Language::Sinumerik {
            self.contour_path(block, plan.path, plan.compressor);
        }
        self.state.incremental = plan.incremental.or(self.state.incremental);
        self.state.arc_incremental = plan.arc_incremental.unwrap_or(self.state.arc_incremental);
        self.state.arc_mode_stated |= plan.arc_incremental.is_some();
        self.state.cycle.to_r = plan.return_to_r.or(self.state.cycle.to_r);
        self.coolant(plan);
        *used |= if plan.loose { bit(b'P') | bit(b'Q') | bit(b'R') | bit(b'E') } else { 0 };
    }

    /// The position in another work offset is not known; that in the same one stays.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn offset<S: Follow>(&mut self, block: &Block, plan: &Plan, used: &mut u32, out: &mut Out<'_, S>) {
        let alone = self.rules.offset_word.filter(|l| plan.offset.is_none() && block.has(*l));
        let number = match plan.offset {
            None if alone.is_none() => return,
            None | Some(0) => {
                let letters = alone.map_or([b'P', b'H'], |l| [l, l]);
                let word = letters.into_iter().find_map(|l| block.get(l).map(|v| (l, v)));
                let Some((letter, value)) = word else {
                    return out.fault("a work offset without its number");
                };
                *used |= bit(letter);
                if value.fract() != 0.0 || !(1.0..=self.rules.most_offsets).contains(&value) {
                    return out.fault(format!(
                        "the work offset {}{value} is not one from 1 to {}",
                        char::from(letter),
                        self.rules.most_offsets
                    ));
                }
                value as u16 + if letter == b'P' { PLAIN_OFFSETS } else { 0 }
            }
            Some(number) => number,
        };
        if self.state.work_offset != Some(number) {
            self.state.known = [false; 4];
        }
        self.state.work_offset = Some(number);
    }

    fn coolant(&mut self, plan: &Plan) {
        match plan.coolant {
            Some(M::CoolantOn { mist: true }) => self.state.coolant.mist = true,
            Some(M::CoolantOn { mist: false }) => self.state.coolant.flood = true,
            Some(M::ThroughOn) => self.state.coolant.through = true,
            Some(M::ThroughOff) => self.state.coolant.through = false,
            Some(M::WashOff) => (self.state.coolant.flood, self.state.coolant.mist) = (false, false),
            Some(_) => self.state.coolant = Washing::default(),
            None => {}
        }
    }

    fn units(&mut self, inch: Option<bool>) {
        let Some(inch) = inch else { return };
        if self.state.inch.is_some_and(|now| now != inch) {
            self.state.feed = None;
        }
        self.state.inch = Some(inch);
    }

    /// A feed of one mode means nothing in another: it is gone when the mode changes, on some controls at every word.
    fn feed_mode(&mut self, mode: Option<FeedMode>) {
        let Some(mode) = mode else { return };
        if self.state.feed_mode.is_some_and(|now| now != mode)
            || self.rules.feed_reset == FeedReset::EveryWord
        {
            self.state.feed = None;
        }
        self.state.feed_mode = Some(mode);
    }

    fn feed_word<S: Follow>(&mut self, block: &Block, out: &mut Out<'_, S>) {
        let Some(value) = block.get(b'F') else { return };
        if value < 0.0 {
            return out.fault(format!("negative feed F{value}"));
        }
        let unpointed = self.rules.unpointed == Unpointed::Least && !block.point(b'F');
        let inch = self.state.inch == Some(true);
        self.state.feed = Some(match self.state.feed_mode {
            Some(FeedMode::InverseTime) => {
                if value > self.rules.largest_inverse {
                    out.fault(format!(
                        "F{value} under G93, the control takes {}",
                        self.rules.largest_inverse
                    ));
                }
                value
            }
            Some(FeedMode::PerRevolution) if unpointed => value * if inch { 0.0001 * INCH } else { 0.01 },
            None | Some(FeedMode::PerMinute) if unpointed && inch => value * 0.01 * INCH,
            _ => value * self.unit(),
        });
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn tool<S: Follow>(&mut self, block: &Block, plan: &Plan, out: &mut Out<'_, S>) {
        if let Some(name) = block.words.as_ref().and_then(|w| w.tool.as_ref()) {
            match self.setup.tool_names.iter().find(|(n, _)| n.eq_ignore_ascii_case(name)) {
                Some((_, number)) => self.state.prepared = Some(*number),
                None => out.fault(format!("alarm 6413, no tool '{name}' in the tool table")),
            }
        }
        if let Some(t) = block.get(b'T').filter(|t| (0.0..=self.rules.largest_t).contains(t)) {
            let tool = t as u32;
            self.state.prepared = Some(tool);
            if self.setup.tools.as_ref().is_some_and(|known| tool != 0 && !known.contains(&tool)) {
                out.fault(format!("T{tool} is not in the tool table"));
            }
            if !self.rules.tool_change {
                self.state.tool = tool;
            }
        }
        if plan.tool_change {
            self.change_tool(out);
        }
    }

    /// After a change the machine may stand anywhere, and stands still.
    fn change_tool<S: Follow>(&mut self, out: &mut Out<'_, S>) {
        let Some(tool) = self.state.prepared else { return out.fault("M6 without a T word before it") };
        self.not_compensated("a tool change", out);
        self.forget_compensation();
        self.state.tool = tool;
        self.state.direction = 0.0;
        self.state.length = false;
        self.state.known = [false, false, false, self.state.known[3]];
        out.event(EventKind::ToolChange(tool));
    }

    fn spindle(&mut self, spindle: Option<M>) {
        match spindle {
            Some(M::SpindleOn { clockwise }) => self.state.direction = if clockwise { 1.0 } else { -1.0 },
            Some(M::SpindleOff) => self.state.direction = 0.0,
            _ => {}
        }
    }

    fn dwell<S: Follow>(&mut self, block: &Block, plan: &Plan, used: &mut u32, out: &mut Out<'_, S>) {
        if plan.once != Some(G::Dwell) {
            return;
        }
        let word =
            self.rules.dwell.iter().flatten().find_map(|&(l, unit)| block.get(l).map(|v| (l, unit, v)));
        for &(letter, _) in self.rules.dwell.iter().flatten() {
            *used |= bit(letter);
        }
        let Some((letter, unit, value)) = word else { return out.fault("G4 without the dwell's time") };
        if value < 0.0 {
            let name = self.rules.address(letter);
            return out.fault(format!("G4 with the negative time {name}{value}"));
        }
        match unit.seconds(value, block.point(letter), self.state.direction.abs() * self.state.speed) {
            Some(seconds) => out.event(EventKind::Dwell(seconds)),
            None => out.fault("G4 in revolutions with the spindle standing"),
        }
    }

    fn tool_length<S: Follow>(&mut self, block: &Block, plan: &Plan, used: &mut u32, out: &mut Out<'_, S>) {
        if self.rules.length_by_d {
            return self.length_by_d(block, used, out);
        }
        let Some(on) = plan.length else { return };
        self.state.known[2] = false;
        self.state.length = on;
        if !on {
            return;
        }
        let letter = self.rules.length_word;
        *used |= bit(letter);
        let (tool, name) = (f64::from(self.state.tool), self.rules.address(letter));
        match block.get(letter) {
            None if self.rules.length_needs_h => out.fault(format!("G43 without the word {name}")),
            Some(h) if h.fract() != 0.0 || h < 0.0 => out.fault(format!("G43 with {name}{h}")),
            Some(h) if (h - tool).abs() > 0.5 => {
                out.assumed(format!(
                    "G43 {name}{h} takes in the length of another tool than T{tool} in the spindle"
                ));
            }
            _ => {}
        }
    }

    /// D: the edge whose length and radius count; D0 none.
    fn length_by_d<S: Follow>(&mut self, block: &Block, used: &mut u32, out: &mut Out<'_, S>) {
        let letter = self.rules.length_word;
        let Some(d) = block.get(letter) else { return };
        *used |= bit(letter);
        let most = if self.rules.language == Language::Sinumerik { 12.0 } else { 9999.0 };
        if d.fract() != 0.0 || !(0.0..=most).contains(&d) {
            out.fault(format!("{}{d} is no cutting edge", self.rules.address(letter)));
        }
        let on = d > 0.0;
        if self.state.length != on {
            self.state.known[2] = false;
        }
        self.state.length = on;
    }

    /// The path on a SINUMERIK: exact under G60; else within the tolerance that CYCLE832, CTOL or ADIS gave, if one did.
    fn contour_path(&mut self, block: &Block, path: Option<G>, compressor: bool) {
        let unit = self.unit();
        if let Some(tolerance) = block.words.as_ref().and_then(|w| w.tolerance) {
            self.state.contour_tolerance = Some(tolerance * unit);
        }
        if path.is_none() && !compressor {
            return;
        }
        self.state.path_stated = true;
        let exact = path == Some(G::ExactPath) && !compressor;
        self.state.path_tolerance =
            if exact { 0.0 } else { self.state.contour_tolerance.unwrap_or(f64::INFINITY) };
    }

    /// G64 P: blending cuts a corner by up to P, and the naive-cam detector drops points up to Q (P when it is
    /// not given) off the line; the two add up.
    fn path<S: Follow>(&mut self, block: &Block, path: Option<G>, used: &mut u32, out: &mut Out<'_, S>) {
        if self.rules.language == Language::Sinumerik {
            return;
        }
        let Some(path) = path else { return };
        self.state.path_stated = true;
        if path == G::ExactPath {
            self.state.path_tolerance = 0.0;
            return;
        }
        *used |= bit(b'P') | bit(b'Q');
        if path == G::Smoothing {
            *used |= bit(b'E');
            self.state.path_tolerance = self.length(block, b'E').unwrap_or(0.0);
            return;
        }
        let naive = self.length(block, b'Q');
        self.state.path_tolerance = match self.length(block, b'P') {
            Some(p) if p < 0.0 || naive.is_some_and(|q| q < 0.0) => {
                out.fault("G64 with a negative tolerance");
                f64::INFINITY
            }
            Some(p) if p > 0.0 => p + naive.unwrap_or(p),
            _ => f64::INFINITY,
        };
    }

    /// Words that no code of the block takes.
    fn unused<S: Follow>(&self, block: &Block, used: u32, out: &mut Out<'_, S>) {
        let left = block.seen & !used;
        if left == 0 {
            return;
        }
        for letter in (b'A'..).take(32).filter(|&l| left & bit(l) != 0) {
            let value = block.get(letter).unwrap_or_default();
            let name = self.rules.address(letter);
            if matches!(letter, b'A'..=b'C' | b'U'..=b'W') && self.setup.rotary_letter() != Some(letter) {
                out.fault(format!("{name}{value}: the machine has no axis {name}"));
            } else {
                out.fault(format!("{name}{value}: {}", self.rules.unused));
            }
        }
    }

    /// Stops and ends come last.
    fn finish_block<S: Follow>(&mut self, plan: &Plan, out: &mut Out<'_, S>) {
        match plan.stop {
            Some(M::Stop { optional }) => {
                if self.rules.stop_stands {
                    self.state.direction = 0.0;
                    self.state.coolant = Washing::default();
                }
                out.event(EventKind::Stop { optional });
            }
            Some(M::End) => {
                self.state.ended = true;
                self.state.direction = 0.0;
                self.state.coolant = Washing::default();
                out.event(EventKind::End);
            }
            _ => {}
        }
    }
}

fn gather_m<S: Follow>(code: u16, m: M, plan: &mut Plan, out: &mut Out<'_, S>) -> bool {
    let mask = 1u8 << m.group();
    let several_are_fine = matches!(m, M::NoEffect | M::Unfollowed);
    if plan.m_groups & mask != 0 && !several_are_fine {
        out.fault(format!("two M codes of one modal group in a block, the second is M{}", tenths(code)));
        return false;
    }
    plan.m_groups |= mask;
    match m {
        M::Stop { .. } | M::End => plan.stop = Some(m),
        M::SpindleOn { .. } | M::SpindleOff => plan.spindle = Some(m),
        M::ToolChange => plan.tool_change = true,
        M::CoolantOn { .. } | M::CoolantOff | M::WashOff | M::ThroughOn | M::ThroughOff => {
            plan.coolant = Some(m);
        }
        M::CycleReturn { to_r } => plan.return_to_r = Some(to_r),
        M::NoEffect => {}
        M::Unfollowed => {
            plan.unfollowed = true;
            out.fault(format!("M{} is not followed by this reader", tenths(code)));
        }
    }
    true
}

/// A code in tenths as it is written: 52 is `5.2`, 10 is `1`.
pub(super) fn tenths(code: u16) -> String {
    if code.is_multiple_of(10) { format!("{}", code / 10) } else { format!("{}.{}", code / 10, code % 10) }
}

/// A G code, or the name that stands for one.
fn g_name(code: u16) -> String {
    super::sinumerik::name(code).map_or_else(|| format!("G{}", tenths(code)), str::to_owned)
}
