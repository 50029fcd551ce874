//! Drilling cycles, worked off as the moves the machine makes.
//!
//! The heights: the initial one is where Z stood when the first cycle of a run was called; R is where feed begins. After
//! a hole the cutter goes back to one or the other (G98, G99).

use super::block::{Block, bit};
use super::codes::CycleKind;
use super::machine::Machine;
use super::motion::{ROTARY, Target};
use super::rules::Cycles;
use super::state::Plan;
use crate::readback::curve::Plane;
use crate::readback::out::Out;
use crate::readback::{EventKind, FeedMode, Follow, TracePath};

/// Most pecks of a hole, and most repeats of a block.
pub(super) const MOST_PECKS: f64 = 10_000.0;
const MOST_REPEATS: f64 = 9999.0;

/// Words of a cycle that stay in force with it.
#[derive(Debug, Default)]
pub(in crate::readback) struct Sticky {
    /// Back to R after a hole, or to the initial height.
    pub to_r: Option<bool>,
    /// Height of G71, mm (Okuma).
    pub height: Option<f64>,
    initial: f64,
    /// R and Z as they were said, and whether under G91.
    r: Option<(f64, bool)>,
    z: Option<(f64, bool)>,
    after: Option<f64>,
    q: Option<f64>,
    p: Option<f64>,
}

impl Sticky {
    /// Another cycle code needs its own words (some controls would keep the last ones); a new run of cycles has a new
    /// initial height.
    pub(super) fn begin(&mut self, another: bool, initial: Option<f64>) {
        if another {
            (self.r, self.z, self.q, self.p) = (None, None, None, None);
            self.after = None;
        }
        self.initial = initial.unwrap_or(self.initial);
    }
}

/// A hole as the cycle's words describe it, mm and seconds.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hole {
    pub kind: CycleKind,
    /// Where feed begins.
    pub r: f64,
    /// Bottom.
    pub z: f64,
    /// Where the tool goes after it.
    pub back: f64,
    /// Depth of a peck.
    pub peck: Option<f64>,
    /// What the first peck counts from.
    pub from: f64,
    /// How far a peck is backed out to break the chip, and where the rapid down stops before the last depth.
    pub clearance: f64,
    /// Seconds at the bottom.
    pub dwell: f64,
}

impl Machine<'_> {
    /// G71 Z: where M53 returns to.
    pub(super) fn return_height<S: Follow>(&mut self, block: &Block, used: &mut u32, out: &mut Out<'_, S>) {
        *used |= bit(b'Z');
        match self.length(block, b'Z') {
            Some(z) => self.state.cycle.height = Some(z),
            None => out.fault("G71 without the height Z"),
        }
    }

    /// A block with a cycle in force.
    pub(super) fn cycle<S: Follow>(
        &mut self,
        block: &Block,
        kind: CycleKind,
        plan: &Plan,
        used: &mut u32,
        out: &mut Out<'_, S>,
    ) {
        let Some(cycles) = self.rules.cycles else { return };
        *used |= self.axis_words() | bit(cycles.level) | bit(cycles.bottom) | bit(cycles.peck);
        *used |= cycles.repeats.map_or(0, bit) | cycles.after.map_or(0, bit);
        *used |= if cycles.with_dwell.contains(&kind) { bit(cycles.dwell_word) } else { 0 };
        if !self.cycle_allowed(block, plan, &cycles, out) {
            return;
        }
        let (Some(hole), Some(repeats)) =
            (self.hole(block, kind, &cycles, out), repeats(block, &cycles, out))
        else {
            return;
        };
        let place = self.target(block, out);
        let step = [0, 1].map(|a| place.to[a] - self.state.position[a]);
        let incremental = self.state.incremental == Some(true);
        for i in 0..repeats {
            let mut at = place;
            if incremental && i > 0 {
                at.to[0] = self.state.position[0] + step[0];
                at.to[1] = self.state.position[1] + step[1];
            }
            self.drill(&hole, &at, out);
        }
    }

    fn cycle_allowed<S: Follow>(
        &mut self,
        block: &Block,
        plan: &Plan,
        cycles: &Cycles,
        out: &mut Out<'_, S>,
    ) -> bool {
        if self.state.feed_mode == Some(FeedMode::InverseTime) {
            out.fault("a drilling cycle under G93");
            return false;
        }
        if self.stated_plane(out) != Plane::Xy {
            out.fault("a drilling cycle outside the XY plane (G17), which this reader does not follow");
            return false;
        }
        if self.setup.rotary_letter().is_some_and(|l| block.has(l)) {
            out.fault("a rotary axis in a drilling cycle");
            return false;
        }
        let moves = block.seen & (bit(b'X') | bit(b'Y') | bit(b'Z')) != 0;
        if !moves && cycles.needs_motion {
            out.fault("a drilling cycle without X, Y or Z");
            return false;
        }
        if !moves && plan.motion.is_some() && !block.has(cycles.level) {
            return false;
        }
        self.feed_is_there(block, out)
    }

    /// The hole of this block; what is not in it stays from the block before.
    fn hole<S: Follow>(
        &mut self,
        block: &Block,
        kind: CycleKind,
        cycles: &Cycles,
        out: &mut Out<'_, S>,
    ) -> Option<Hole> {
        let incremental = self.state.incremental == Some(true);
        let (r, z) = (self.length(block, cycles.level), self.length(block, cycles.bottom));
        let after = cycles.after.and_then(|letter| self.length(block, letter));
        let counted = cycles.pecks_counted;
        let q = if counted { block.get(cycles.peck) } else { self.length(block, cycles.peck) };
        let speed = self.state.speed;
        let letter = cycles.dwell_word;
        let p = block.get(letter).and_then(|p| cycles.dwell.seconds(p, block.point(letter), speed));
        let now = &mut self.state.cycle;
        now.r = r.map(|r| (r, incremental)).or(now.r);
        now.z = z.map(|z| (z, incremental)).or(now.z);
        now.after = after.or(now.after);
        now.q = q.or(now.q);
        now.p = p.or(now.p);
        let (level, bottom) = self.levels(cycles, out)?;
        if !self.state.known[2] {
            out.fault("a drilling cycle from a height that is not known");
            return None;
        }
        if level < bottom {
            let u = self.unit();
            let [above, below] = [cycles.level, cycles.bottom].map(|l| self.rules.address(l));
            out.fault(format!("{above}{} is below the bottom {below}{} of the hole", level / u, bottom / u));
            return None;
        }
        let peck = self.peck(kind, level - bottom, cycles, out)?;
        let dwell = self.state.cycle.p.filter(|_| cycles.with_dwell.contains(&kind)).unwrap_or(0.0);
        let back = self.height_after(level, cycles, out)?;
        let clearance = cycles.clearance;
        Some(Hole { kind, r: level, z: bottom, back, peck, from: level, clearance, dwell })
    }

    /// R and the bottom. Words that stay count as the distance mode now in force takes them.
    fn levels<S: Follow>(&mut self, cycles: &Cycles, out: &mut Out<'_, S>) -> Option<(f64, f64)> {
        let incremental = self.state.incremental == Some(true);
        let now = &self.state.cycle;
        let Some((r, r_mode)) = now.r else {
            out.fault(format!("a drilling cycle without {}", self.rules.address(cycles.level)));
            return None;
        };
        let Some((z, z_mode)) = now.z else {
            out.fault(format!("a drilling cycle without {}", self.rules.address(cycles.bottom)));
            return None;
        };
        let level = if incremental { now.initial + r } else { r };
        let bottom = if incremental { level + z } else { z };
        if r_mode != incremental || z_mode != incremental {
            self.assume(
                9,
                out,
                "G90 or G91 changes between holes: whether R and Z are taken anew depends on the control",
            );
        }
        Some((level, bottom))
    }

    /// The peck of G73 and G83, which must be there and lead down; `None` when it isn't.
    #[allow(clippy::option_option)]
    fn peck<S: Follow>(
        &self,
        kind: CycleKind,
        depth: f64,
        cycles: &Cycles,
        out: &mut Out<'_, S>,
    ) -> Option<Option<f64>> {
        if !matches!(kind, CycleKind::Deep | CycleKind::ChipBreak) {
            return Some(None);
        }
        let Some(q) = self.state.cycle.q else {
            out.fault(format!("a peck drilling cycle without {}", self.rules.address(cycles.peck)));
            return None;
        };
        let name = self.rules.address(cycles.peck);
        if cycles.pecks_counted {
            let whole = (1.0..=MOST_PECKS).contains(&q) && q.fract() == 0.0;
            if !whole {
                out.fault(format!("{q} pecks of {name}"));
            }
            return whole.then_some(Some(depth / q));
        }
        if q <= 0.0 || depth / q > MOST_PECKS {
            out.fault(format!("a peck of {name}{} {}", q / self.unit(), self.unit_name()));
            return None;
        }
        Some(Some(q))
    }

    /// The height that a word of the cycle says.
    fn stated_height<S: Follow>(&self, r: f64, word: (u8, f64), out: &mut Out<'_, S>) -> Option<f64> {
        let (name, height, u) = (self.rules.address(word.0), word.1, self.unit());
        if self.state.incremental == Some(true) {
            out.fault(format!("{name} under G91, which this reader does not follow"));
            return None;
        }
        if height < r {
            out.fault(format!("{name}{} is below the height {} where feed begins", height / u, r / u));
        }
        Some(height.max(r))
    }

    /// Where the cutter goes after a hole.
    fn height_after<S: Follow>(&mut self, r: f64, cycles: &Cycles, out: &mut Out<'_, S>) -> Option<f64> {
        let initial = self.state.cycle.initial;
        if let (Some(letter), Some(height)) = (cycles.after, self.state.cycle.after) {
            return self.stated_height(r, (letter, height), out);
        }
        match cycles.returns_to_level.or(self.state.cycle.to_r) {
            Some(true) => Some(r),
            Some(false) if cycles.return_height => {
                let height = self.state.cycle.height;
                if height.is_none() {
                    out.fault("M53 without a height of G71");
                }
                height
            }
            None if cycles.return_height => {
                out.fault("a drilling cycle without M53 or M54");
                None
            }
            stated => {
                if stated.is_none() {
                    self.assume(
                        8,
                        out,
                        "neither G98 nor G99 before the first cycle: it is left to the control's setting",
                    );
                    if cycles.starts_to_r {
                        return Some(r);
                    }
                }
                if initial < r && !cycles.higher_return {
                    let u = self.unit();
                    let name = self.rules.address(cycles.level);
                    out.fault(format!(
                        "the height Z{} before the cycle is below {name}{}",
                        initial / u,
                        r / u
                    ));
                }
                Some(initial.max(r))
            }
        }
    }

    fn drill<S: Follow>(&mut self, hole: &Hole, at: &Target, out: &mut Out<'_, S>) {
        let direction = self.state.direction;
        if let CycleKind::Tap { left } = hole.kind
            && (direction < 0.0) != left
        {
            out.fault(if left { "G74 with the spindle not at M4" } else { "G84 with the spindle not at M3" });
        }
        if self.state.position[2] < hole.r {
            self.vertical(hole.r, true, out);
        }
        self.across(at, out);
        self.drill_down(hole, None, out);
    }

    /// The hole under the tool; `feed_back` is the feed out of it, mm/min, where it is another.
    pub(super) fn drill_down<S: Follow>(
        &mut self,
        hole: &Hole,
        feed_back: Option<f64>,
        out: &mut Out<'_, S>,
    ) {
        self.vertical(hole.r, true, out);
        let direction = self.state.direction;
        match hole.kind {
            CycleKind::Deep => self.pecks(hole, true, out),
            CycleKind::ChipBreak => self.pecks(hole, false, out),
            _ => self.vertical(hole.z, false, out),
        }
        if hole.dwell > 0.0 {
            out.event(EventKind::Dwell(hole.dwell));
        }
        match hole.kind {
            CycleKind::Tap { .. } => self.state.direction = -direction,
            CycleKind::BoreStop | CycleKind::Fine => self.state.direction = 0.0,
            _ => {}
        }
        if matches!(hole.kind, CycleKind::Tap { .. } | CycleKind::Bore | CycleKind::BoreDwell) {
            self.state.feed = feed_back.or(self.state.feed);
            let all_the_way = hole.kind == CycleKind::BoreDwell
                && self.rules.cycles.is_some_and(|c| c.bore_dwell_feeds_back);
            self.vertical(if all_the_way { hole.back } else { hole.r }, false, out);
            self.state.direction = direction;
        }
        self.vertical(hole.back, true, out);
        self.state.direction = direction;
    }

    /// Down in pecks: out of the hole after each, or back by a little.
    fn pecks<S: Follow>(&mut self, hole: &Hole, out_of_hole: bool, out: &mut Out<'_, S>) {
        let peck = hole.peck.unwrap_or(f64::INFINITY);
        let mut depth = hole.from;
        loop {
            depth -= peck;
            // What is left over by rounding is no peck of its own.
            if depth <= hole.z + 1e-9 {
                return self.vertical(hole.z, false, out);
            }
            self.vertical(depth, false, out);
            if out_of_hole {
                self.vertical(hole.r, true, out);
            }
            self.vertical((depth + hole.clearance).min(hole.r), true, out);
        }
    }

    fn vertical<S: Follow>(&mut self, z: f64, rapid: bool, out: &mut Out<'_, S>) {
        let mut to = self.state.position;
        to[2] = z;
        self.leg(Target { to, moved: [false, false, true, false] }, rapid, out);
    }

    fn across<S: Follow>(&mut self, at: &Target, out: &mut Out<'_, S>) {
        let mut to = self.state.position;
        to[0] = at.to[0];
        to[1] = at.to[1];
        self.leg(Target { to, moved: [at.moved[0], at.moved[1], false, false] }, true, out);
    }

    /// A straight leg; none where the cutter stands already.
    fn leg<S: Follow>(&mut self, target: Target, rapid: bool, out: &mut Out<'_, S>) {
        let from = self.departure(&target);
        let all_known = target.moved.iter().zip(&self.state.known).all(|(m, k)| !m || *k);
        if from == target.to && all_known {
            return;
        }
        let place = |p: &[f64; 4]| self.in_part(p[0], p[1], p[ROTARY]);
        let path = TracePath::Line { from: place(&from), to: place(&target.to) };
        self.emit(path, from, &target, rapid, out);
    }
}

/// How often the block is to be worked off; 0 only stores its words.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn repeats<S: Follow>(block: &Block, cycles: &Cycles, out: &mut Out<'_, S>) -> Option<u32> {
    let Some(letter) = cycles.repeats else { return Some(1) };
    match block.get(letter) {
        None => Some(1),
        Some(n) if n.fract() == 0.0 && (0.0..=MOST_REPEATS).contains(&n) => Some(n as u32),
        Some(n) => {
            out.fault(format!("{}{n} is not a number of repeats", char::from(letter)));
            None
        }
    }
}
