//! Lines, poles, circles and helices.

use super::Reader;
use super::blocks::Asked;
use crate::geom::{Point2, Vec2, cross, left};
use crate::math::{DEG, TAU, atan2, hypot, sin_cos};
use crate::readback::curve::{Plane, along};
use crate::readback::out::Out;
use crate::readback::{EventKind, FeedMode, Follow, TraceMove, TracePath};

/// How far an arc's end may be off its circle, mm.
const CIRCLE_DEVIATION: f64 = 0.016;
/// Smallest circle, mm.
const SMALLEST: f64 = 1.6e-6;
/// Largest `CP IPA`, degrees.
const LARGEST_ANGLE: f64 = 5400.0;
/// Sweep below which a circle is whole, radians.
const WHOLE: f64 = 1e-9;
/// Index of the rotary axis.
pub(super) const ROTARY: usize = 3;

impl Reader<'_> {
    /// `L`.
    pub(super) fn straight<S: Follow>(&mut self, asked: &Asked, out: &mut Out<'_, S>) {
        if asked.polar.is_some() || asked.clockwise.is_some() || asked.radius.is_some() {
            out.fault("words of a circle in an L block");
        }
        if !asked.moves() {
            return;
        }
        let to = self.target(asked, out);
        if asked.m.contains(&91) || asked.m.contains(&92) {
            for (known, axis) in self.state.known.iter_mut().zip(&asked.axes) {
                *known &= axis.is_none();
            }
            self.state.parked |= asked.axes[2].is_some();
            return;
        }
        if !asked.rapid && !self.feed_is_there(out) {
            return self.arrive(to, asked);
        }
        let from = self.departure(&to, asked);
        if let Some(path) = self.straight_path(&from, &to, out) {
            self.emit(path, from, to, asked, out);
        } else {
            self.arrive(to, asked);
        }
    }

    fn straight_path<S: Follow>(
        &self,
        from: &[f64; 4],
        to: &[f64; 4],
        out: &mut Out<'_, S>,
    ) -> Option<TracePath> {
        if self.setup.rotary.is_none() || from[ROTARY] == to[ROTARY] {
            return Some(TracePath::Line { from: self.in_part(from), to: self.in_part(to) });
        }
        if from[1] != 0.0 || to[1] != 0.0 {
            out.fault("the rotary axis moves while the tool is not on the table's X axis");
            return None;
        }
        Some(TracePath::Spiral { radius: (from[0], to[0]), angle: (self.angle(from), self.angle(to)) })
    }

    /// Angle of the machine's X axis in the part, radians.
    fn angle(&self, at: &[f64; 4]) -> f64 {
        let reversed = self.setup.rotary.is_some_and(|r| r.reversed);
        at[ROTARY] * DEG * if reversed { -1.0 } else { 1.0 }
    }

    pub(super) fn in_part(&self, at: &[f64; 4]) -> Point2 {
        if self.setup.rotary.is_none() || at[ROTARY] == 0.0 {
            return Point2::new(at[0], at[1]);
        }
        let (s, c) = sin_cos(self.angle(at));
        Point2::new(c * at[0] - s * at[1], s * at[0] + c * at[1])
    }

    /// `CC`: the pole; without coordinates where the tool is.
    ///
    /// With Z it lies in the ZX or YZ plane.
    pub(super) fn pole<S: Follow>(&mut self, asked: &Asked, out: &mut Out<'_, S>) {
        if asked.rapid || asked.feed.is_some() {
            out.fault("a pole has only coordinates");
        }
        let named = |axis: usize| asked.axes[axis].is_some();
        let plane = match [named(0), named(1), named(2)] {
            [_, _, false] => Plane::Xy,
            [true, false, true] => Plane::Zx,
            [false, true, true] => Plane::Yz,
            _ => {
                out.fault("a pole has two coordinates");
                return;
            }
        };
        let to = self.target(asked, out);
        let [first, second, _] = plane.axes();
        let none = !(named(first) || named(second));
        if none && !(self.state.known[first] && self.state.known[second]) {
            out.fault("CC at a position that is not known");
        }
        let here = place_in(plane, &to);
        let kept = self.state.pole.filter(|(p, _)| *p == plane).map_or(here, |(_, pole)| pole);
        let x = if named(first) || none { here.x } else { kept.x };
        let y = if named(second) || none { here.y } else { kept.y };
        self.state.pole = Some((plane, Point2::new(x, y)));
    }

    /// `C`: about the pole to an end point.
    pub(super) fn circle<S: Follow>(&mut self, asked: &Asked, out: &mut Out<'_, S>) {
        let to = self.target(asked, out);
        let Some(clockwise) = self.circle_allowed(asked, out) else { return self.arrive(to, asked) };
        let Some((plane, centre)) = self.state.pole else {
            out.fault("C without a pole CC");
            return self.arrive(to, asked);
        };
        let across = plane.axes()[2];
        if asked.axes[across].is_some() {
            let axis = ["X", "Y", "Z"][across];
            out.fault(format!("{axis} in a C block about a pole in another plane: a helix is CP with IPA"));
        }
        if !self.stands_in(plane, out) {
            return self.arrive(to, asked);
        }
        let (start, end) = (place_in(plane, &self.state.position), place_in(plane, &to));
        if self.fits(start, end, centre, out) {
            let sweep = sweep(start - centre, end - centre, clockwise);
            self.arc((plane, centre), sweep, to, asked, out);
        } else {
            self.arrive(to, asked);
        }
    }

    /// `CR`: by radius; a negative one takes the longer way.
    pub(super) fn circle_by_radius<S: Follow>(&mut self, asked: &Asked, out: &mut Out<'_, S>) {
        let to = self.target(asked, out);
        let Some(clockwise) = self.circle_allowed(asked, out) else { return self.arrive(to, asked) };
        if asked.axes[2].is_some() {
            out.fault("Z in a CR block is not followed by this reader");
        }
        if !self.stands_in(Plane::Xy, out) {
            return self.arrive(to, asked);
        }
        let (start, end) = (self.here(), Point2::new(to[0], to[1]));
        let chord = end - start;
        let (length, u) = (chord.norm(), self.unit());
        let Some(radius) = asked.radius.map(|r| r * u) else {
            out.fault("CR without R");
            return self.arrive(to, asked);
        };
        if length == 0.0 {
            out.fault("CR with the end point at the start");
            return self.arrive(to, asked);
        }
        if length / 2.0 > radius.abs() + CIRCLE_DEVIATION {
            out.fault(format!("CR radius too small: R{} for an end point {} away", radius / u, length / u));
            return self.arrive(to, asked);
        }
        let half = length / 2.0;
        let height = (radius * radius - half * half).max(0.0).sqrt();
        let side = if clockwise == (radius > 0.0) { -1.0 } else { 1.0 };
        let centre = start + chord / 2.0 + left(chord / length) * (side * height);
        let sweep = sweep(start - centre, end - centre, clockwise);
        self.arc((Plane::Xy, centre), sweep, to, asked, out);
    }

    /// `CP`: about the pole by an angle, with Z a helix.
    pub(super) fn circle_by_angle<S: Follow>(&mut self, asked: &Asked, out: &mut Out<'_, S>) {
        let mut to = self.target(asked, out);
        let Some(clockwise) = self.circle_allowed(asked, out) else { return self.arrive(to, asked) };
        let (Some((plane, centre)), Some((angle, incremental))) = (self.state.pole, asked.polar) else {
            out.fault("CP without a pole CC or without IPA");
            return self.arrive(to, asked);
        };
        if asked.axes[0].is_some() || asked.axes[1].is_some() {
            out.fault("X or Y in a CP block");
        }
        if plane != Plane::Xy {
            out.fault("CP about a pole with Z is not followed by this reader");
            return self.arrive(to, asked);
        }
        if !self.stands_in(Plane::Xy, out) {
            return self.arrive(to, asked);
        }
        let start = self.here();
        let arm = start - centre;
        if arm.norm() <= SMALLEST {
            out.fault("CP from the pole");
            return self.arrive(to, asked);
        }
        let swept = if incremental {
            if angle.abs() > LARGEST_ANGLE || angle == 0.0 || (angle < 0.0) != clockwise {
                out.fault(format!(
                    "IPA{angle:+} must not be 0, have DR's sign and not be over {LARGEST_ANGLE}"
                ));
                return self.arrive(to, asked);
            }
            angle * DEG
        } else {
            let (s, c) = sin_cos(angle * DEG);
            sweep(arm, Vec2::new(c, s), clockwise)
        };
        let (s, c) = sin_cos(swept);
        let end = centre + Vec2::new(c * arm.x - s * arm.y, s * arm.x + c * arm.y);
        (to[0], to[1]) = (end.x, end.y);
        self.arc((Plane::Xy, centre), swept, to, asked, out);
    }

    fn circle_allowed<S: Follow>(&mut self, asked: &Asked, out: &mut Out<'_, S>) -> Option<bool> {
        if asked.clockwise.is_none() {
            out.fault("a circle without DR+ or DR-");
        }
        if asked.rapid {
            out.fault("a circle at FMAX");
        }
        if asked.axes[ROTARY].is_some() {
            out.fault("the rotary axis moves in a circle");
            return None;
        }
        if !self.feed_is_there(out) || asked.rapid {
            return None;
        }
        asked.clockwise
    }

    /// Whether it is known where in the plane the tool is.
    fn stands_in<S: Follow>(&self, plane: Plane, out: &mut Out<'_, S>) -> bool {
        let [first, second, _] = plane.axes();
        let known = self.state.known[first] && self.state.known[second];
        if !known {
            out.fault("a circle from a position that is not known");
        }
        known
    }

    /// Start and end lie on the circle.
    fn fits<S: Follow>(&self, start: Point2, end: Point2, centre: Point2, out: &mut Out<'_, S>) -> bool {
        let (r1, r2) = ((start - centre).norm(), (end - centre).norm());
        let u = self.unit();
        if r1.min(r2) <= SMALLEST {
            out.fault("a circle of no radius");
            return false;
        }
        let off = (r1 - r2).abs();
        if off > CIRCLE_DEVIATION {
            out.fault(format!(
                "circle end point incorrect: radii {:.6} and {:.6}, difference {:.6}",
                r1 / u,
                r2 / u,
                off / u
            ));
        }
        off <= CIRCLE_DEVIATION
    }

    fn arc<S: Follow>(
        &mut self,
        (plane, centre): (Plane, Point2),
        sweep: f64,
        to: [f64; 4],
        asked: &Asked,
        out: &mut Out<'_, S>,
    ) {
        let from = self.state.position;
        if plane != Plane::Xy {
            let across = plane.axes()[2];
            if from[ROTARY] != 0.0 || !self.state.known[across] {
                out.fault("a circle with Z on a turned table, or from a position that is not known");
                return self.arrive(to, asked);
            }
            let places = [place_in(plane, &from), place_in(plane, &to), centre];
            let path = TracePath::Tilted(plane.turn(places, (from[across], to[across]), sweep));
            return self.emit(path, from, to, asked, out);
        }
        let middle = self.in_part(&[centre.x, centre.y, 0.0, from[ROTARY]]);
        let path = TracePath::Arc { from: self.in_part(&from), to: self.in_part(&to), centre: middle, sweep };
        self.emit(path, from, to, asked, out);
    }

    fn here(&self) -> Point2 {
        Point2::new(self.state.position[0], self.state.position[1])
    }

    /// Where the axis words lead.
    pub(super) fn target<S: Follow>(&self, asked: &Asked, out: &mut Out<'_, S>) -> [f64; 4] {
        let mut to = self.state.position;
        let axes = to.iter_mut().zip(&asked.axes).zip(self.state.known).enumerate();
        for (axis, ((place, word), known)) in axes {
            let Some((value, incremental)) = *word else { continue };
            let value = if axis == ROTARY { value } else { value * self.unit() };
            if incremental && !known {
                out.fault("an incremental move from a position that is not known");
            }
            *place = if incremental { *place + value } else { value };
        }
        to
    }

    /// Where the move starts; an axis that is not known yet is taken to stand where it goes.
    fn departure(&self, to: &[f64; 4], asked: &Asked) -> [f64; 4] {
        let mut from = self.state.position;
        for axis in 0..4 {
            if asked.axes[axis].is_some() && !self.state.known[axis] {
                from[axis] = to[axis];
            }
        }
        from
    }

    /// Whether there is a feed to cut with.
    pub(super) fn feed_is_there<S: Follow>(&mut self, out: &mut Out<'_, S>) -> bool {
        if self.state.feed.is_none_or(|f| f <= 0.0) {
            out.fault("feed rate is missing");
            return false;
        }
        if self.state.per_revolution && self.state.direction * self.state.speed == 0.0 {
            out.fault("feed per revolution with the spindle standing");
            return false;
        }
        true
    }

    pub(super) fn arrive(&mut self, to: [f64; 4], asked: &Asked) {
        self.state.position = to;
        for axis in 0..4 {
            self.state.known[axis] |= asked.axes[axis].is_some();
        }
        self.state.parked &= asked.axes[2].is_none();
    }

    /// What a move may not be while radius compensation begins, is in force or ends; `from_afar` in the plane, from where
    /// nobody knows.
    fn compensates<S: Follow>(&mut self, path: &TracePath, from_afar: bool, out: &mut Out<'_, S>) {
        let on = self.state.compensation.is_some();
        if !on && !self.state.compensation_due {
            return;
        }
        match path {
            _ if on && self.state.in_cycle => out.fault("a cycle under radius compensation"),
            TracePath::Line { from, to } => self.state.compensation_due &= from == to && !from_afar,
            TracePath::Arc { .. } if core::mem::take(&mut self.state.compensation_due) => {
                out.fault("radius compensation begins or ends on a circle");
            }
            TracePath::Arc { .. } => {}
            _ if on => out.fault("only lines and circles of the XY plane under radius compensation"),
            _ => {}
        }
    }

    /// Hands a move on and stands at its end.
    pub(super) fn emit<S: Follow>(
        &mut self,
        path: TracePath,
        from: [f64; 4],
        to: [f64; 4],
        asked: &Asked,
        out: &mut Out<'_, S>,
    ) {
        let from_afar = (0..2).any(|axis| asked.axes[axis].is_some() && !self.state.known[axis]);
        self.compensates(&path, from_afar, out);
        let state = &self.state;
        let table = state.known[ROTARY] || asked.axes[ROTARY].is_none();
        let feed = if asked.rapid { None } else { self.path_feed(&path, &from, &to) };
        let cut = TraceMove {
            path,
            z: (from[2], to[2]),
            rapid: asked.rapid,
            feed,
            feed_mode: self.feed_mode(),
            spindle: state.direction * state.speed,
            tool: state.tool,
            known: [state.known[0] && table, state.known[1] && table, state.known[2]],
            parked: state.parked && asked.axes[2].is_none(),
            length_offset: state.tool != 0,
            coolant: state.coolant,
            compensation: state.compensation,
            work_offset: state.work_offset,
            in_cycle: state.in_cycle,
            path_tolerance: state.path_tolerance,
        };
        self.arrive(to, asked);
        out.event(EventKind::Move(cut));
    }

    /// Feed along the path in the part, mm/min. With a table, 1 deg counts as 1 mm.
    fn path_feed(&self, path: &TracePath, from: &[f64; 4], to: &[f64; 4]) -> Option<f64> {
        let feed = self.state.feed?;
        let per_minute = match self.feed_mode() {
            FeedMode::PerRevolution => feed * self.state.speed,
            FeedMode::PerMinute | FeedMode::InverseTime => feed,
        };
        let TracePath::Spiral { .. } = path else { return Some(per_minute) };
        let linear = hypot(to[0] - from[0], to[2] - from[2]);
        let reference = hypot(linear, to[ROTARY] - from[ROTARY]);
        Some(per_minute * along(path, to[2] - from[2]) / reference)
    }
}

/// A position's place in a plane.
fn place_in(plane: Plane, at: &[f64; 4]) -> Point2 {
    let [first, second, _] = plane.axes();
    Point2::new(at[first], at[second])
}

/// Signed sweep from one radius vector to another; a whole circle when they agree.
fn sweep(from: Vec2, to: Vec2, clockwise: bool) -> f64 {
    let angle = atan2(cross(from, to), from.dot(&to));
    match clockwise {
        true if angle >= -WHOLE => angle - TAU,
        false if angle <= WHOLE => angle + TAU,
        _ => angle,
    }
}
