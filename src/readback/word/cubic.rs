//! `G5`: cubic Bézier pieces in the XY plane.

use super::block::{Block, bit};
use super::machine::Machine;
use super::motion::Target;
use crate::geom::{Point2, Vec2};
use crate::readback::curve::Plane;
use crate::readback::out::Out;
use crate::readback::polynomial::bezier;
use crate::readback::{Follow, TracePath};

/// What `G5` is: I J from the start and P Q from the end lead to the inner control points; without I J a piece goes on in the
/// direction of the one before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::readback) enum Cubic {
    /// No piece.
    None,
    /// The piece itself is cut.
    Exact,
    /// Chords of it are cut, as Marlin and grblHAL make them.
    Chords,
}

/// Where chords are tried in the parameter: the first step, and the shortest that is halved again.
const STEP: f64 = 0.1;
const SHORTEST: f64 = 0.002;
/// How far the middle of a chord may be from the curve, mm, in X and Y together.
const SAGITTA: f64 = 0.1;

impl Machine<'_> {
    /// A G5 block.
    pub(super) fn cubic<S: Follow>(
        &mut self,
        block: &Block,
        axes: u32,
        used: &mut u32,
        out: &mut Out<'_, S>,
    ) {
        *used |= axes | bit(b'I') | bit(b'J') | bit(b'P') | bit(b'Q');
        let target = self.target(block, out);
        let legs = self.legs(block, &target, out);
        self.state.cubic_leg = legs.map(|(_, arrive)| -arrive);
        let Some((leave, arrive)) = legs.filter(|_| self.feed_is_there(block, out)) else {
            return self.arrive(&target);
        };
        let from = self.state.position;
        let (start, end) = (Point2::new(from[0], from[1]), Point2::new(target.to[0], target.to[1]));
        let z = from[2];
        let points = [start, start + leave, end + arrive, end];
        if self.rules.cubic == Cubic::Chords {
            return self.chords(points, &target, out);
        }
        let place = |p: Point2| (self.in_part(p.x, p.y, from[super::motion::ROTARY]), z);
        self.emit(bezier(&points.map(place), vec![1.0; 4]), from, &target, false, out);
    }

    /// The chords that are cut in the place of a piece.
    fn chords<S: Follow>(&mut self, points: [Point2; 4], target: &Target, out: &mut Out<'_, S>) {
        for end in chord_ends(points) {
            let from = self.state.position;
            let mut leg = *target;
            (leg.to[0], leg.to[1]) = (end.x, end.y);
            let turn = from[super::motion::ROTARY];
            let place = |p: &[f64; 4]| self.in_part(p[0], p[1], turn);
            let path = TracePath::Line { from: place(&from), to: place(&leg.to) };
            self.emit(path, from, &leg, false, out);
        }
    }

    /// The ways from the ends to the inner control points, mm.
    fn legs<S: Follow>(&self, block: &Block, target: &Target, out: &mut Out<'_, S>) -> Option<(Vec2, Vec2)> {
        if self.state.plane != Plane::Xy {
            out.fault("G5 outside the XY plane (G17)");
            return None;
        }
        if target.moved[2] || target.moved[super::motion::ROTARY] {
            out.fault("G5 with an axis other than X and Y");
            return None;
        }
        if !(self.state.known[0] && self.state.known[1]) {
            out.fault("G5 from a position that is not known");
            return None;
        }
        let pair = |a: u8, b: u8| (self.length(block, a), self.length(block, b));
        let leave = match pair(b'I', b'J') {
            (Some(i), Some(j)) => Some(Vec2::new(i, j)),
            (None, None) => self.state.cubic_leg,
            _ => None,
        };
        let arrive = match pair(b'P', b'Q') {
            (Some(p), Some(q)) => Some(Vec2::new(p, q)),
            _ => None,
        };
        if leave.is_none() {
            out.fault("G5 needs I and J, or neither after another G5");
        }
        if arrive.is_none() {
            out.fault("G5 needs P and Q");
        }
        leave.zip(arrive)
    }
}

/// Ends of chords: the step of the parameter is halved while the chord's middle is too far from the curve, and doubled where it
/// is not.
fn chord_ends([a, b, c, d]: [Point2; 4]) -> Vec<Point2> {
    let at = |t: f64| {
        let mid = |p: Point2, q: Point2| p + (q - p) * t;
        let (ab, bc, cd) = (mid(a, b), mid(b, c), mid(c, d));
        mid(mid(ab, bc), mid(bc, cd))
    };
    let near = |t: f64, from: f64, to: f64| {
        let off = at(t) - (at(from) + (at(to) - at(from)) * 0.5);
        off.x.abs() + off.y.abs() <= SAGITTA
    };
    let (mut t, mut step) = (0.0, STEP);
    let mut ends = Vec::new();
    while t < 1.0 {
        let mut next = f64::min(t + step, 1.0);
        let mut whole = true;
        while next - t >= SHORTEST && !near(0.5 * (t + next), t, next) {
            next = 0.5 * (t + next);
            whole = false;
        }
        // Rounding of the firmware's short numbers may double a step of a tenth or not: the longer one counts.
        while whole && next - t <= STEP + 1e-6 {
            let doubled = t + 2.0 * (next - t);
            if doubled >= 1.0 || !near(next, t, doubled) {
                break;
            }
            next = doubled;
        }
        step = next - t;
        t = if 1.0 - next < 1e-9 { 1.0 } else { next };
        ends.push(if t < 1.0 { at(t) } else { d });
    }
    ends
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chords_take_a_fifth_of_a_piece_at_most() {
        let piece = |y: f64| [(0.0, 0.0), (1.0, y), (2.0, y), (3.0, 0.0)].map(|(x, y)| Point2::new(x, y));
        let ends = chord_ends(piece(0.5));
        assert_eq!(ends.len(), 5);
        assert!((ends[0] - Point2::new(0.6, 0.24)).norm() < 1e-12 && ends[4] == Point2::new(3.0, 0.0));
        // A large one is cut finer, and no finer than the shortest step.
        let many = chord_ends(piece(400.0)).len();
        assert!((20..=1000).contains(&many), "{many}");
        assert!(chord_ends(piece(1e9)).len() <= 1000);
    }
}
