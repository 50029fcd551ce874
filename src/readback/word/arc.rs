//! Circular interpolation: centre, sweep and the controls' own checks.

use super::block::{Block, bit};
use super::machine::Machine;
use super::motion::{ROTARY, Target};
use super::rules::ArcEnd;
use crate::geom::{Point2, Vec2, cross, left};
use crate::math::{TAU, atan2};
use crate::readback::curve::Plane;
use crate::readback::out::Out;
use crate::readback::{Follow, TracePath};

/// An R that misses half the chord by less than this many mm still makes a half circle.
const HALF_CIRCLE_SLACK: f64 = 1e-6;
/// Half the chord as a share of R, from which on the centre of an arc by R is too uncertain for some controls.
const NEAR_HALF_CIRCLE: f64 = 0.9999;
/// An end this near to the circle (mm) lies on it.
const ON_CIRCLE: f64 = 1e-9;

/// Why an arc can't be drawn.
struct Refusal(String);

/// Letters of the axes.
const AXES: [u8; 3] = *b"XYZ";

/// Letters of a plane's two axes.
fn letters(plane: Plane, of: [u8; 3]) -> [u8; 2] {
    let [a, b, _] = plane.axes();
    [of[a], of[b]]
}

/// An arc in its plane.
struct Drawn {
    plane: Plane,
    start: Point2,
    end: Point2,
    centre: Point2,
    sweep: f64,
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
        let plane = self.stated_plane(out);
        let [first, second] = letters(plane, self.rules.arc_offsets);
        *used |= (self.axis_words() | bit(first) | bit(second) | bit(self.rules.arc_radius)) & block.seen;
        let target = self.target(block, out);
        let [a, b] = letters(plane, AXES);
        if self.rules.arc_needs_end && block.seen & (bit(a) | bit(b)) == 0 {
            let code =
                if target.any() { "error:32, no axis words in plane" } else { "error:26, no axis words" };
            out.fault(format!("{code}: an arc needs {} or {}", char::from(a), char::from(b)));
            return self.arrive(&target);
        }
        if !self.feed_is_there(block, out) {
            return self.arrive(&target);
        }
        match self.drawn(block, plane, clockwise, &target, used, out) {
            Ok(drawn) => self.draw(&drawn, &target, out),
            Err(Refusal(message)) => {
                out.fault(message);
                self.arrive(&target);
            }
        }
    }

    fn drawn<S: Follow>(
        &mut self,
        block: &Block,
        plane: Plane,
        clockwise: bool,
        target: &Target,
        used: &mut u32,
        out: &mut Out<'_, S>,
    ) -> Result<Drawn, Refusal> {
        let [a, b, across] = plane.axes();
        let known = &self.state.known;
        let say = |text: &str| Err(Refusal(text.to_owned()));
        if !(known[a] && known[b]) || plane != Plane::Xy && !known[across] {
            return say("an arc from a position that is not known");
        }
        let turns_table = target.moved[ROTARY] && target.to[ROTARY] != self.state.position[ROTARY];
        if turns_table || plane != Plane::Xy && self.state.position[ROTARY] != 0.0 {
            return say("the rotary axis moves in an arc");
        }
        let at = |p: &[f64; 4]| Point2::new(p[a], p[b]);
        let (start, end) = (at(&self.state.position), at(&target.to));
        let [first, second] = letters(plane, self.rules.arc_offsets);
        let offsets = block.has(first) || block.has(second);
        let centre = match self.length(block, self.rules.arc_radius) {
            Some(_) if offsets && !self.rules.radius_wins => return say("R and I J in one arc"),
            Some(radius) => self.centre_by_radius(start, end, radius, clockwise)?,
            None if offsets => self.centre_by_offsets(block, [first, second], start, out)?,
            None => {
                return say(if plane == Plane::Xy {
                    "an arc without R, I and J"
                } else {
                    "an arc without R and offsets in its plane"
                });
            }
        };
        self.radius_check(start, end, centre)?;
        let turns = self.turns(block, used, out);
        let sweep = self.sweep(start - centre, end - centre, clockwise, turns);
        Ok(Drawn { plane, start, end, centre, sweep })
    }

    /// Hands the arc on; where the control goes by the end's angle, with the line to the end.
    fn draw<S: Follow>(&mut self, drawn: &Drawn, target: &Target, out: &mut Out<'_, S>) {
        let radius = (drawn.start - drawn.centre).norm();
        let towards = drawn.end - drawn.centre;
        let beside = (towards.norm() - radius).abs() > ON_CIRCLE;
        if self.rules.arc_end == ArcEnd::Spiral || !beside {
            return self.emit(
                self.arc_path(drawn, drawn.end, target),
                self.state.position,
                target,
                false,
                out,
            );
        }
        let reached = drawn.centre + towards * (radius / towards.norm());
        let [a, b, _] = drawn.plane.axes();
        let mut on_circle = *target;
        on_circle.to[a] = reached.x;
        on_circle.to[b] = reached.y;
        let path = self.arc_path(drawn, reached, &on_circle);
        self.emit(path, self.state.position, &on_circle, false, out);
        let from = self.state.position;
        let line = TracePath::Line {
            from: self.in_part(from[0], from[1], from[ROTARY]),
            to: self.in_part(target.to[0], target.to[1], target.to[ROTARY]),
        };
        self.emit(line, from, target, false, out);
    }

    fn arc_path(&self, drawn: &Drawn, end: Point2, target: &Target) -> TracePath {
        let turned = self.state.position[ROTARY];
        if drawn.plane == Plane::Xy {
            let place = |p: Point2| self.in_part(p.x, p.y, turned);
            return TracePath::Arc {
                from: place(drawn.start),
                to: place(end),
                centre: place(drawn.centre),
                sweep: drawn.sweep,
            };
        }
        let [_, _, across] = drawn.plane.axes();
        let levels = (self.state.position[across], target.to[across]);
        TracePath::Tilted(drawn.plane.turn([drawn.start, end, drawn.centre], levels, drawn.sweep))
    }

    fn centre_by_offsets<S: Follow>(
        &mut self,
        block: &Block,
        letters: [u8; 2],
        start: Point2,
        out: &mut Out<'_, S>,
    ) -> Result<Point2, Refusal> {
        if !self.state.arc_mode_stated {
            self.assume(
                7,
                out,
                "neither G90.1 nor G91.1 before the first arc: what I J K count from is a setting",
            );
        }
        if self.rules.arc_absolute && self.state.incremental == Some(true) {
            return Err(Refusal("an arc under G91, whose centre this reader does not follow".to_owned()));
        }
        let [first, second] = letters.map(|l| self.length(block, l));
        if let Some(absolute) =
            block.words.as_ref().map(|w| w.absolute).filter(|a| a & (bit(letters[0]) | bit(letters[1])) != 0)
        {
            let place = |word: Option<f64>, letter: u8, from: f64| match word {
                Some(value) if absolute & bit(letter) != 0 => value,
                Some(value) => from + value,
                None => from,
            };
            return Ok(Point2::new(place(first, letters[0], start.x), place(second, letters[1], start.y)));
        }
        if self.state.arc_incremental {
            return Ok(start + Vec2::new(first.unwrap_or(0.0), second.unwrap_or(0.0)));
        }
        match (first, second) {
            (Some(i), Some(j)) => Ok(Point2::new(i, j)),
            _ => {
                let [a, b] = letters.map(|l| self.rules.address(l));
                Err(Refusal(format!("{a} and {b} must both stand in an arc with an absolute centre")))
            }
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
            return Err(Refusal(format!("an arc by R{} that ends where it starts", radius / u)));
        }
        let half = length / 2.0;
        if half > radius.abs() + HALF_CIRCLE_SLACK {
            return Err(Refusal(format!(
                "the arc's radius R{} is too small to reach the end point {} {} away",
                radius / u,
                length / u,
                self.unit_name()
            )));
        }
        if self.rules.shaky_half_circle && half > NEAR_HALF_CIRCLE * radius.abs() {
            return Err(Refusal(format!(
                "an arc by R{} of nearly half a turn, whose centre the control may fail to compute",
                radius / u
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
            return Err(Refusal(format!(
                "an arc of zero radius ({:.6} {})",
                r1.min(r2) / u,
                self.unit_name()
            )));
        }
        let difference = (r1 - r2).abs();
        if self.rules.arc_fits(difference, r1.max(r2), self.state.inch == Some(true)) {
            return Ok(());
        }
        Err(Refusal(format!(
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
        if let Some(more) = block.words.as_ref().and_then(|w| w.turns) {
            if more.fract() != 0.0 || !(0.0..=999.0).contains(&more) {
                out.fault(format!("TURN={more} is not a number of turns"));
                return 1.0;
            }
            return 1.0 + more;
        }
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
