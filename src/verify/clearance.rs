//! How near a move comes to a wall: the least signed distance, free side positive, against a floor.

use super::measure::Measure;
use super::path::{Jet, Primitive};
use super::rail::{Foot, FootKind, Rail};
use crate::geom::{Point2, Side};

/// Refinement stops this far above the floor, mm.
const ACCURACY: f64 = 5e-7;
/// Evaluations spent on one primitive.
const BUDGET: u32 = 20_000;

/// The deepest place that was found below the floor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Gouge {
    /// Signed distance, mm, below the floor; at least as deep as this.
    pub clearance: f64,
    /// Where.
    pub at: Point2,
}

#[derive(Debug, Clone, Copy)]
struct Look {
    x: f64,
    jet: Jet,
    foot: Foot,
    clearance: f64,
}

/// A wall to stay clear of.
#[derive(Debug)]
pub(super) struct Clearance<'a, 'b> {
    /// Exact contact.
    pub rail: &'a Rail<'b>,
    /// The part's side.
    pub part: Side,
    /// Least clearance allowed, mm (negative: how deep is still fine).
    pub floor: f64,
}

impl Clearance<'_, '_> {
    /// Where the primitive goes below the floor; `None` when it provably does not by more than [`ACCURACY`].
    pub(super) fn gouge(&self, primitive: &Primitive) -> Option<Gouge> {
        let parts = primitive.parts(self.rail.length / 8.0);
        let mut measure = Measure::new(self.rail, primitive, f64::INFINITY);
        let mut worst: Option<Gouge> = None;
        let mut budget = BUDGET;
        let mut from = self.look(primitive, 0.0);
        for i in 1..=parts {
            #[allow(clippy::cast_precision_loss)]
            let to = self.look(primitive, i as f64 / parts as f64);
            self.between(&mut measure, &from, &to, &mut budget, &mut worst);
            from = to;
        }
        worst
    }

    fn look(&self, primitive: &Primitive, x: f64) -> Look {
        let jet = primitive.at(x);
        let foot = self.rail.nearest(jet.p);
        let clearance = match foot.kind {
            // Beside an open wall's end there is nothing to gouge but the end itself.
            FootKind::Beyond(by) => crate::math::hypot(foot.d, by),
            FootKind::Smooth | FootKind::Corner => -self.part.sign() * foot.d,
        };
        Look { x, jet, foot, clearance }
    }

    fn between(
        &self,
        measure: &mut Measure<'_, '_>,
        from: &Look,
        to: &Look,
        budget: &mut u32,
        worst: &mut Option<Gouge>,
    ) {
        self.note(from, worst);
        self.note(to, worst);
        let mut stack = vec![(*from, *to)];
        while let Some((a, b)) = stack.pop() {
            let deepest = worst.map_or(self.floor, |w| w.clearance.min(self.floor));
            if self.below(measure, &a, &b) >= deepest - ACCURACY {
                continue;
            }
            if *budget == 0 {
                worst.get_or_insert(Gouge { clearance: self.below(measure, &a, &b), at: a.jet.p });
                return;
            }
            *budget -= 1;
            let middle = self.look(measure.primitive, 0.5 * (a.x + b.x));
            self.note(&middle, worst);
            stack.push((middle, b));
            stack.push((a, middle));
        }
    }

    fn note(&self, look: &Look, worst: &mut Option<Gouge>) {
        let deeper = worst.is_none_or(|w| look.clearance < w.clearance);
        if look.clearance < self.floor - 2.0 * ACCURACY && deeper {
            *worst = Some(Gouge { clearance: look.clearance, at: look.jet.p });
        }
    }

    /// Lower bound of the clearance between two looks.
    fn below(&self, measure: &Measure<'_, '_>, a: &Look, b: &Look) -> f64 {
        let path = measure.speed() * (b.x - a.x);
        let plain = 0.5 * (a.clearance + b.clearance - path);
        let step = (a.foot.sigma - b.foot.sigma).abs();
        let beside = !matches!((a.foot.kind, b.foot.kind), (FootKind::Smooth, FootKind::Smooth));
        if beside || step > 2.0 * path {
            return plain;
        }
        let sight = |l: &Look| super::measure::Sight { x: l.x, jet: l.jet, foot: l.foot };
        let (above, below) = measure.bound(&sight(a), &sight(b));
        plain.max(if self.part == Side::Left { -above } else { below })
    }
}

/// Least distance of a primitive's points from the origin, bounded from below; for blanks about the origin.
pub(super) fn nearest_to_origin(primitive: &Primitive) -> f64 {
    match primitive {
        Primitive::Line { from, step } => {
            let length = step.norm();
            if length == 0.0 {
                return from.coords.norm();
            }
            let along = (-from.coords.dot(step) / length).clamp(0.0, length);
            (from.coords + step * (along / length)).norm()
        }
        Primitive::Polar { centre, radius, .. } if centre.coords.norm() == 0.0 => {
            radius.0.abs().min((radius.0 + radius.1).abs())
        }
        Primitive::Polar { centre, radius, .. } => {
            let (a, b) = (radius.0.abs(), (radius.0 + radius.1).abs());
            let d = centre.coords.norm();
            (d - a.max(b)).max(a.min(b) - d).max(0.0)
        }
        Primitive::Tilted { .. } => {
            let half = primitive.at(0.5).p;
            (half.coords.norm() - 0.5 * primitive.bounds()[0]).max(0.0)
        }
        Primitive::Rational { bounds, .. } => {
            let first = primitive.at(0.0).p.coords.norm();
            let last = primitive.at(1.0).p.coords.norm();
            (0.5 * (first + last - bounds[0])).max(0.0)
        }
    }
}
