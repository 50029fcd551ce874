//! Circular interpolation: centre, sweep and the controls' own checks.

use super::block::{Block, bit};
use super::machine::{Machine, Out};
use super::motion::{ROTARY, Target};
use super::{Follow, TracePath};
use crate::geom::{Point2, Vec2, cross, left};
use crate::math::{TAU, atan2};

/// An R that misses half the chord by less than this many mm still makes a half circle.
const HALF_CIRCLE_SLACK: f64 = 1e-6;

/// Why an arc can't be drawn.
enum Refusal {
    Said(String),
}

impl Machine<'_> {
    /// G2 and G3.
    pub(super) fn arc<S: Follow>(
        &mut self,
        block: &Block,
        clockwise: bool,
        used: &mut u32,
        out: &mut Out<'_, S>,
    ) {
        let in_plane = bit(b'X') | bit(b'Y');
        *used |= (self.axis_words() | bit(b'I') | bit(b'J')) & block.seen;
        if !self.in_xy_plane("an arc", out) {
            *used |= bit(b'K') | bit(b'R') | bit(b'P');
            return;
        }
        let target = self.target(block, out);
        if self.rules.arc_needs_end && block.seen & in_plane == 0 {
            let code =
                if block.has(b'Z') { "error:32, no axis words in plane" } else { "error:26, no axis words" };
            out.fault(format!("{code}: an arc needs X or Y"));
            return self.arrive(&target);
        }
        if !self.feed_is_there(block, out) {
            return self.arrive(&target);
        }
        match self.arc_path(block, clockwise, &target, used, out) {
            Ok(path) => self.emit(path, self.state.position, &target, false, out),
            Err(Refusal::Said(message)) => {
                out.fault(message);
                self.arrive(&target);
            }
        }
    }

    fn arc_path<S: Follow>(
        &self,
        block: &Block,
        clockwise: bool,
        target: &Target,
        used: &mut u32,
        out: &mut Out<'_, S>,
    ) -> Result<TracePath, Refusal> {
        let state = &self.state;
        let say = |text: &str| Err(Refusal::Said(text.to_owned()));
        if !(state.known[0] && state.known[1]) {
            return say("an arc from a position that is not known");
        }
        if target.moved[ROTARY] && target.to[ROTARY] != state.position[ROTARY] {
            return say("the rotary axis moves in an arc");
        }
        let start = Point2::new(state.position[0], state.position[1]);
        let end = Point2::new(target.to[0], target.to[1]);
        let offsets = block.has(b'I') || block.has(b'J');
        *used |= bit(b'R');
        let centre = match self.length(block, b'R') {
            Some(_) if offsets && !self.rules.radius_wins => {
                return say("R and I J in one arc");
            }
            Some(radius) => self.centre_by_radius(start, end, radius, clockwise)?,
            None if offsets => self.centre_by_offsets(block, start)?,
            None => return say("an arc without R, I and J"),
        };
        self.radius_check(start, end, centre)?;
        let turns = self.turns(block, used, out);
        let sweep = self.sweep(start - centre, end - centre, clockwise, turns);
        let c = state.position[ROTARY];
        let place = |p: Point2| self.in_part(p.x, p.y, c);
        Ok(TracePath::Arc { from: place(start), to: place(end), centre: place(centre), sweep })
    }

    fn centre_by_offsets(&self, block: &Block, start: Point2) -> Result<Point2, Refusal> {
        let (i, j) = (self.length(block, b'I'), self.length(block, b'J'));
        if self.state.arc_incremental {
            return Ok(start + Vec2::new(i.unwrap_or(0.0), j.unwrap_or(0.0)));
        }
        match (i, j) {
            (Some(i), Some(j)) => Ok(Point2::new(i, j)),
            _ => Err(Refusal::Said("I and J must both stand in an arc under G90.1".to_owned())),
        }
    }

    /// The centre of an arc of this radius: the shorter arc when it is positive, the longer when negative.
    fn centre_by_radius(
        &self,
        start: Point2,
        end: Point2,
        radius: f64,
        clockwise: bool,
    ) -> Result<Point2, Refusal> {
        let chord = end - start;
        let length = chord.norm();
        let u = self.unit();
        if length == 0.0 {
            return Err(Refusal::Said(format!("an arc by R{} that ends where it starts", radius / u)));
        }
        let half = length / 2.0;
        if half > radius.abs() + HALF_CIRCLE_SLACK {
            return Err(Refusal::Said(format!(
                "the arc's radius R{} is too small to reach the end point {} {} away",
                radius / u,
                length / u,
                self.unit_name()
            )));
        }
        let height = (radius * radius - half * half).max(0.0).sqrt();
        let side = if clockwise == (radius > 0.0) { -1.0 } else { 1.0 };
        Ok(start + chord / 2.0 + left(chord / length) * (side * height))
    }

    fn radius_check(&self, start: Point2, end: Point2, centre: Point2) -> Result<(), Refusal> {
        let (r1, r2) = ((start - centre).norm(), (end - centre).norm());
        let u = self.unit();
        if r1.min(r2) <= self.rules.smallest_radius {
            return Err(Refusal::Said(format!(
                "an arc of zero radius ({:.6} {})",
                r1.min(r2) / u,
                self.unit_name()
            )));
        }
        let difference = (r1 - r2).abs();
        if difference <= (self.rules.largest_difference)(r1.max(r2)) {
            return Ok(());
        }
        Err(Refusal::Said(format!(
            "{}: start ({:.5}, {:.5}), centre ({:.5}, {:.5}), end ({:.5}, {:.5}), r1 {:.6}, r2 {:.6}, difference {:.6} {}",
            self.rules.arc_complaint,
            start.x / u,
            start.y / u,
            centre.x / u,
            centre.y / u,
            end.x / u,
            end.y / u,
            r1 / u,
            r2 / u,
            difference / u,
            self.unit_name()
        )))
    }

    /// P: number of turns, where the control has it.
    fn turns<S: Follow>(&self, block: &Block, used: &mut u32, out: &mut Out<'_, S>) -> f64 {
        if !self.rules.arc_turns {
            return 1.0;
        }
        *used |= bit(b'P');
        match block.get(b'P') {
            None => 1.0,
            Some(p) if p >= 1.0 && p.fract() == 0.0 => p,
            Some(p) => {
                out.fault(format!("P{p} in an arc is not a whole number of turns"));
                1.0
            }
        }
    }

    /// Signed sweep from the start's radius vector to the end's; a full circle when they agree.
    fn sweep(&self, from: Vec2, to: Vec2, clockwise: bool, turns: f64) -> f64 {
        let angle = atan2(cross(from, to), from.dot(&to));
        let fuzz = self.rules.full_circle_fuzz;
        let extra = TAU * (turns - 1.0);
        if clockwise {
            (if angle >= -fuzz { angle - TAU } else { angle }) - extra
        } else {
            (if angle <= fuzz { angle + TAU } else { angle }) + extra
        }
    }
}
