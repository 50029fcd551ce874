//! `G5`: cubic Bézier pieces in the XY plane.

use super::block::{Block, bit};
use super::machine::Machine;
use super::motion::Target;
use crate::geom::{Point2, Vec2};
use crate::readback::Follow;
use crate::readback::curve::Plane;
use crate::readback::out::Out;
use crate::readback::polynomial::bezier;

/// How a control takes `G5`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::readback) enum Cubic {
    /// Not at all, or as something else.
    None,
    /// I J from the start and P Q from the end to the inner control points; without I J the piece goes on in the direction
    /// of the one before it.
    Joined,
}

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
        let place = |p: Point2| (self.in_part(p.x, p.y, from[super::motion::ROTARY]), z);
        let points = [start, start + leave, end + arrive, end].map(place);
        self.emit(bezier(&points, vec![1.0; 4]), from, &target, false, out);
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
