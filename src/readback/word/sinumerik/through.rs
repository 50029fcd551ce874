//! `CIP`: a circle through a place between its ends, anywhere in space.

use super::super::block::Block;
use super::super::machine::Machine;
use super::super::motion::ROTARY;
use crate::geom::{Point3, Vec3};
use crate::math::{TAU, atan2};
use crate::readback::out::Out;
use crate::readback::{Follow, Tilted, TracePath};

/// Sine of the angle below which three places lie in a line.
const STRAIGHT: f64 = 1e-9;

impl Machine<'_> {
    /// CIP: its end, and in `I1=`, `J1=`, `K1=` a place between.
    pub(in crate::readback::word) fn through<S: Follow>(
        &mut self,
        block: &Block,
        axes: u32,
        used: &mut u32,
        out: &mut Out<'_, S>,
    ) {
        self.along(block, (axes, used), out, |machine, target, out| {
            let from = machine.state.position;
            let between = machine
                .between(block, out)
                .ok_or_else(|| "CIP without a place between: I1=, J1=, K1=".to_owned())?;
            if !machine.state.known[..3].iter().all(|k| *k) {
                return Err("an arc from a position that is not known".to_owned());
            }
            if from[ROTARY] != 0.0 || target.to[ROTARY] != 0.0 {
                return Err("CIP with a table that is turned".to_owned());
            }
            circle(place(&from), between, place(&target.to))
                .ok_or_else(|| "CIP: its three places lie in a line".to_owned())
        });
    }

    /// The place between; axes without a word keep where the arc starts.
    fn between<S: Follow>(&self, block: &Block, out: &mut Out<'_, S>) -> Option<Point3> {
        let words = block.words.as_ref()?.between;
        words.iter().any(Option::is_some).then_some(())?;
        let mut place = place(&self.state.position);
        for (axis, word) in words.into_iter().enumerate() {
            let Some((value, mode)) = word else { continue };
            let absolute = mode.unwrap_or(self.state.incremental != Some(true));
            if !absolute && !self.state.known[axis] {
                out.fault("an incremental place from a position that is not known");
            }
            let value = value * self.unit();
            place[axis] = if absolute { value } else { place[axis] + value };
        }
        Some(place)
    }
}

fn place(at: &[f64; 4]) -> Point3 {
    Point3::new(at[0], at[1], at[2])
}

/// The circle from `a` through `b` to `c`.
fn circle(a: Point3, b: Point3, c: Point3) -> Option<TracePath> {
    let (p, q) = (b - a, c - a);
    let normal = p.cross(&q);
    let (pp, qq, nn) = (p.norm_squared(), q.norm_squared(), normal.norm_squared());
    let apart = nn > STRAIGHT * STRAIGHT * pp * qq;
    if !apart {
        return None;
    }
    // The centre is as far from `a` as from the two others, in their plane.
    let arm: Vec3 = (q.cross(&normal) * -pp + p.cross(&normal) * qq) / (-2.0 * nn);
    let axis = normal / nn.sqrt();
    let (u, v) = (-arm, axis.cross(&-arm));
    let to = c - a - arm;
    let angle = atan2(to.dot(&v), to.dot(&u));
    let sweep = if angle > 0.0 { angle } else { angle + TAU };
    let centre = a + arm;
    if axis.x == 0.0 && axis.y == 0.0 {
        let sweep = sweep * axis.z;
        return Some(TracePath::Arc { from: a.xy(), to: c.xy(), centre: centre.xy(), sweep });
    }
    Some(TracePath::Tilted(Tilted { from: a, to: c, centre, axis, sweep }))
}
