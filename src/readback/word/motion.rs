//! Motions: rapids, lines, spirals of a rotary table, and what they need.

use super::block::{Block, bit, letters};
use super::codes::{G, Mode};
use super::machine::Machine;
use super::rules::RotaryFeed;
use super::state::Plan;
use crate::geom::Point2;
use crate::math::{DEG, hypot};
use crate::readback::curve::{Plane, along};
use crate::readback::out::Out;
use crate::readback::{EventKind, FeedMode, Follow, TraceMove, TracePath};

/// Index of the rotary axis in a position.
pub(super) const ROTARY: usize = 3;

/// Where a motion goes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Target {
    /// X, Y, Z in mm, rotary in degrees.
    pub to: [f64; 4],
    /// Axes that have a word in the block.
    pub moved: [bool; 4],
}

impl Target {
    pub(super) fn any(&self) -> bool {
        self.moved.iter().any(|&m| m)
    }
}

impl Machine<'_> {
    /// The motion of a block, if it has one.
    pub(super) fn motion<S: Follow>(
        &mut self,
        block: &Block,
        plan: &Plan,
        used: &mut u32,
        out: &mut Out<'_, S>,
    ) {
        if plan.once == Some(G::Reference) {
            return self.reference(block, used, out);
        }
        if self.nurbs_block(block, plan, used, out) {
            return;
        }
        if plan.once == Some(G::ReturnHeight) {
            return self.return_height(block, used, out);
        }
        let axes = self.axis_words() & block.seen & !*used;
        if let Some(mode) = plan.motion {
            self.change_motion(mode);
        }
        let between = block.words.as_ref().is_some_and(|w| w.between.iter().any(Option::is_some));
        if between && self.state.motion != Mode::Through {
            out.fault("I1=, J1=, K1= without CIP");
        }
        let told = block.words.as_ref().and_then(|w| w.polynomials.as_ref());
        if told.is_some() && self.state.motion != Mode::Polynomial {
            out.fault("PO without POLY: the control goes straight to the end");
        }
        if plan.once == Some(G::Dwell) && axes != 0 {
            return out.fault("axis words in a dwell");
        }
        if axes != 0 || self.moves_without_axes(block, plan) {
            self.moving(block, plan, axes, used, out);
        }
    }

    /// Full circles, and cycles that are defined or repeated on the spot.
    fn moves_without_axes(&self, block: &Block, plan: &Plan) -> bool {
        let arc_words = letters(&self.rules.arc_offsets) | bit(self.rules.arc_radius);
        let level = self.rules.cycles.is_some_and(|c| block.has(c.level));
        match self.state.motion {
            Mode::Arc { .. } => plan.motion.is_some() || (block.seen & arc_words != 0 && plan.once.is_none()),
            Mode::Cycle(_) => plan.motion.is_some() || (level && plan.once.is_none()),
            _ => false,
        }
    }

    /// A motion code ends a cycle; one cycle follows another from the same initial height.
    fn change_motion(&mut self, mode: Mode) {
        let stays = matches!((self.state.motion, mode), (Mode::Cycle(_), Mode::Cycle(_)));
        if let Mode::Cycle(_) = mode {
            let begins = self.state.motion != mode;
            self.state.cycle.begin(begins, (!stays).then_some(self.state.position[2]));
        }
        if self.state.motion != mode {
            self.state.cubic_leg = None;
        }
        self.state.motion = mode;
    }

    fn moving<S: Follow>(
        &mut self,
        block: &Block,
        plan: &Plan,
        axes: u32,
        used: &mut u32,
        out: &mut Out<'_, S>,
    ) {
        let machine_coordinates = plan.once == Some(G::MachineCoordinates);
        if machine_coordinates {
            *used |= axes | bit(b'H');
            return self.machine_move(block, out);
        }
        if self.rules.repeat_motion && plan.motion.is_none() {
            out.fault("axis words without a motion code: not every build of this control keeps the last one");
        }
        self.state_assumptions(out);
        match self.state.motion {
            Mode::None => {
                *used |= axes;
                out.fault("axis words without a motion code that uses them");
            }
            Mode::Rapid | Mode::Linear => {
                self.straight(block, axes, used, out);
                if axes & (bit(b'X') | bit(b'Y')) != 0 {
                    self.drill_after_move(out);
                }
            }
            Mode::Arc { clockwise } => self.arc(block, clockwise, used, out),
            Mode::Through => self.through(block, axes, used, out),
            Mode::Cubic => self.cubic(block, axes, used, out),
            Mode::Polynomial => self.polynomial(block, axes, used, out),
            Mode::Cycle(kind) => self.cycle(block, kind, plan, used, out),
            // Blocks of an open curve never come here.
            Mode::NurbsPoints | Mode::NurbsKnots | Mode::BSpline => {}
        }
    }

    /// What a program must state before its first move, or leave to the control's settings.
    fn state_assumptions<S: Follow>(&mut self, out: &mut Out<'_, S>) {
        if self.state.inch.is_none() {
            self.assume(
                0,
                out,
                "neither G20 nor G21 before the first move: the unit is left to the control's setting",
            );
        }
        if self.state.incremental.is_none() {
            self.assume(
                1,
                out,
                "neither G90 nor G91 before the first move: it is left to the control's setting",
            );
        }
    }

    /// What a program must state before its first cut.
    fn cut_assumptions<S: Follow>(&mut self, out: &mut Out<'_, S>) {
        if self.state.feed_mode.is_none() {
            self.assume(
                2,
                out,
                "none of G93, G94, G95 before the first cut: the feed mode is left to the control's setting",
            );
        }
        if !self.state.path_stated {
            self.assume(
                3,
                out,
                &format!(
                    "neither {} nor a path tolerance before the first cut: how far corners are cut is left to the control",
                    self.rules.exact_code
                ),
            );
        }
        if self.rules.work_offset && self.state.work_offset.is_none() {
            self.assume(
                6,
                out,
                "no work offset before the first cut: the part's zero is left to what was in force",
            );
        }
    }

    /// Letters of the configured axes.
    pub(super) fn axis_words(&self) -> u32 {
        bit(b'X') | bit(b'Y') | bit(b'Z') | self.setup.rotary_letter().map_or(0, bit)
    }

    /// End point of the block from its axis words.
    pub(super) fn target<S: Follow>(&self, block: &Block, out: &mut Out<'_, S>) -> Target {
        let incremental = self.state.incremental == Some(true);
        let mut target = Target { to: self.state.position, moved: [false; 4] };
        let rotary = self.setup.rotary_letter().and_then(|l| self.degrees(block, l));
        let words = [self.length(block, b'X'), self.length(block, b'Y'), self.length(block, b'Z'), rotary];
        let modes = block.words.as_ref().map_or((0, 0), |w| (w.absolute, w.incremental));
        let letters = [b'X', b'Y', b'Z', self.setup.rotary_letter().unwrap_or(b'C')];
        for (axis, word) in words.into_iter().enumerate() {
            let letter = bit(letters[axis]);
            let incremental = (incremental || modes.1 & letter != 0) && modes.0 & letter == 0;
            let (Some(value), Some(slot)) = (word, target.to.get_mut(axis)) else { continue };
            if incremental && value != 0.0 && !self.state.known[axis] {
                out.fault("an incremental move from a position that is not known");
            }
            *slot = if incremental { *slot + value } else { value };
            target.moved[axis] = true;
        }
        target
    }

    fn straight<S: Follow>(&mut self, block: &Block, axes: u32, used: &mut u32, out: &mut Out<'_, S>) {
        *used |= axes;
        let target = self.target(block, out);
        let rapid = self.state.motion == Mode::Rapid;
        if !rapid && !self.feed_is_there(block, out) {
            return self.arrive(&target);
        }
        let from = self.departure(&target);
        match self.straight_path(&from, &target, out) {
            Some(path) => self.emit(path, from, &target, rapid, out),
            None => self.arrive(&target),
        }
    }

    /// Where the move starts; an axis that is not known yet is taken to stand where it goes.
    pub(super) fn departure(&self, target: &Target) -> [f64; 4] {
        let mut from = self.state.position;
        for (axis, place) in from.iter_mut().enumerate() {
            if target.moved[axis] && !self.state.known[axis] {
                *place = target.to[axis];
            }
        }
        from
    }

    /// A straight machine move as the part sees it: a line, or a spiral when the table turns under it.
    fn straight_path<S: Follow>(
        &self,
        from: &[f64; 4],
        target: &Target,
        out: &mut Out<'_, S>,
    ) -> Option<TracePath> {
        let to = &target.to;
        if self.setup.rotary.is_none() || (to[ROTARY] - from[ROTARY]).abs() == 0.0 {
            let from = self.in_part(from[0], from[1], from[ROTARY]);
            return Some(TracePath::Line { from, to: self.in_part(to[0], to[1], to[ROTARY]) });
        }
        if from[1] != 0.0 || to[1] != 0.0 {
            let unit = self.unit();
            let letter = self.setup.rotary_letter().map_or('C', char::from);
            out.fault(format!(
                "{letter} moves while Y is {} to {} {}: the tool must be on the table's X axis",
                from[1] / unit,
                to[1] / unit,
                self.unit_name()
            ));
            return None;
        }
        let angle = (self.table_angle(from[ROTARY]), self.table_angle(to[ROTARY]));
        Some(TracePath::Spiral { radius: (from[0], to[0]), angle })
    }

    /// Angle of the machine's X axis in the part at this rotary position, radians.
    pub(super) fn table_angle(&self, degrees: f64) -> f64 {
        let reversed = self.setup.rotary.is_some_and(|r| r.reversed);
        if reversed { -degrees * DEG } else { degrees * DEG }
    }

    /// A machine point in the part's frame.
    pub(super) fn in_part(&self, x: f64, y: f64, degrees: f64) -> Point2 {
        if self.setup.rotary.is_none() || degrees == 0.0 {
            return Point2::new(x, y);
        }
        let (s, c) = crate::math::sin_cos(self.table_angle(degrees));
        Point2::new(c * x - s * y, s * x + c * y)
    }

    /// Whether a cutting block has its feed; says what is missing.
    pub(super) fn feed_is_there<S: Follow>(&mut self, block: &Block, out: &mut Out<'_, S>) -> bool {
        let mode = self.state.feed_mode.unwrap_or(FeedMode::PerMinute);
        if mode == FeedMode::InverseTime && !block.has(b'F') {
            self.cut_assumptions(out);
            out.fault(format!("{}: F word missing with inverse time motion", self.rules.no_feed));
            return false;
        }
        self.cut_is_ready(out)
    }

    /// Whether a cut has a feed, F words of its own block apart.
    pub(super) fn cut_is_ready<S: Follow>(&mut self, out: &mut Out<'_, S>) -> bool {
        self.cut_assumptions(out);
        let mode = self.state.feed_mode.unwrap_or(FeedMode::PerMinute);
        if self.state.feed.is_none_or(|f| f <= 0.0) {
            out.fault(self.rules.no_feed);
            return false;
        }
        if mode == FeedMode::PerRevolution && self.spindle_speed() == 0.0 {
            out.fault("feed per revolution with the spindle standing");
            return false;
        }
        true
    }

    pub(super) fn spindle_speed(&self) -> f64 {
        self.state.direction * self.state.speed
    }

    /// Hands the move on and stands at its end.
    pub(super) fn emit<S: Follow>(
        &mut self,
        path: TracePath,
        from: [f64; 4],
        target: &Target,
        rapid: bool,
        out: &mut Out<'_, S>,
    ) {
        let z = (from[2], target.to[2]);
        let feed = if rapid { None } else { self.path_feed(&path, &from, target) };
        let in_cycle = matches!(self.state.motion, Mode::Cycle(_)) || self.state.in_call;
        let from_afar = (0..2).any(|axis| target.moved[axis] && !self.state.known[axis]);
        self.compensates(&path, (in_cycle, from_afar), out);
        let known = self.known_before(target);
        let cut = TraceMove {
            path,
            z,
            rapid,
            feed,
            feed_mode: self.state.feed_mode.unwrap_or(FeedMode::PerMinute),
            spindle: self.spindle_speed(),
            tool: self.state.tool,
            known,
            parked: self.state.parked && !target.moved[2],
            length_offset: self.state.length,
            coolant: self.state.coolant,
            compensation: self.state.radius.on,
            work_offset: self.state.work_offset,
            in_cycle,
            path_tolerance: self.state.path_tolerance,
        };
        self.arrive(target);
        out.event(EventKind::Move(cut));
    }

    /// X and Y of the part are known when the machine's are, and the table's angle if it turns.
    fn known_before(&self, target: &Target) -> [bool; 3] {
        let known = &self.state.known;
        let table = known[ROTARY] || !target.moved[ROTARY];
        [known[0] && table, known[1] && table, known[2]]
    }

    /// Feed along the path in the part, mm/min.
    fn path_feed(&self, path: &TracePath, from: &[f64; 4], target: &Target) -> Option<f64> {
        let feed = self.state.feed?;
        let per_minute = match self.state.feed_mode.unwrap_or(FeedMode::PerMinute) {
            FeedMode::InverseTime => return Some(feed * along(path, target.to[2] - from[2])),
            FeedMode::PerRevolution => feed * self.state.speed,
            FeedMode::PerMinute => feed,
        };
        let TracePath::Spiral { .. } = path else { return Some(per_minute) };
        let (dx, dz, turn) = (target.to[0] - from[0], target.to[2] - from[2], target.to[3] - from[3]);
        let linear = hypot(dx, dz);
        // `per_minute` has been scaled by the unit.
        let turn = turn * self.unit();
        let reference = match self.rules.rotary_feed {
            RotaryFeed::LinearAxes if linear > 0.0 => linear,
            RotaryFeed::LinearAxes => turn.abs(),
            RotaryFeed::UnitsAsDegrees => hypot(linear, turn),
            RotaryFeed::MillimetresAsDegrees => hypot(linear, turn / self.unit()),
        };
        Some(per_minute * along(path, dz) / reference)
    }

    /// The control now stands at the target.
    pub(super) fn arrive(&mut self, target: &Target) {
        self.state.position = target.to;
        for axis in 0..4 {
            self.state.known[axis] |= target.moved[axis];
        }
        self.state.parked &= !target.moved[2];
    }

    /// G53: a move in machine coordinates leaves the part's frame.
    fn machine_move<S: Follow>(&mut self, block: &Block, out: &mut Out<'_, S>) {
        if self.rules.radius_word != super::rules::RadiusWord::Free {
            self.not_compensated("G53", out);
        }
        if !matches!(self.state.motion, Mode::Rapid | Mode::Linear) {
            out.fault("G53 without G0 or G1");
        }
        if self.state.incremental == Some(true) {
            out.fault("G53 with G91");
        }
        let target = self.target(block, out);
        self.forget(&target);
    }

    /// G28/G30: over the given point to the machine's reference point.
    fn reference<S: Follow>(&mut self, block: &Block, used: &mut u32, out: &mut Out<'_, S>) {
        *used |= self.axis_words();
        self.not_compensated("G28", out);
        let target = self.target(block, out);
        if !target.any() && self.rules.reference_needs_axis {
            return out.fault("G28 without an axis word");
        }
        let from = self.departure(&target);
        if target.to != from
            && let Some(path) = self.straight_path(&from, &target, out)
        {
            self.emit(path, from, &target, true, out);
        }
        let all = Target { moved: if target.any() { target.moved } else { [true; 4] }, ..target };
        self.forget(&all);
    }

    fn forget(&mut self, target: &Target) {
        self.forget_compensation();
        for axis in 0..4 {
            self.state.known[axis] &= !target.moved[axis];
        }
        self.state.parked |= target.moved[2];
    }

    /// The working plane, which a program must have chosen.
    pub(super) fn stated_plane<S: Follow>(&mut self, out: &mut Out<'_, S>) -> Plane {
        if !self.state.plane_stated {
            self.assume(
                4,
                out,
                "no plane (G17) before the first arc or cycle: it is left to the control's setting",
            );
        }
        self.state.plane
    }
}
