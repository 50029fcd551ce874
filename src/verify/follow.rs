//! A piece: a run of moves that must stay in the band of one exact curve and cover it from end to end.

use super::measure::{Extremes, Measure, Sight};
use super::path::Primitive;
use super::rail::{Foot, FootKind, Rail};
use crate::geom::Point2;
use crate::readback::TraceMove;

/// A move of a piece with its line.
pub(super) type Run<'t> = Vec<(u32, &'t TraceMove)>;

/// A measured extreme.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extreme {
    /// Signed deviation, left of the curve positive, mm.
    pub d: f64,
    /// Line of the text.
    pub line: u32,
    /// Where on the path.
    pub at: Point2,
}

/// What following the curve found.
#[derive(Debug, Clone, Default)]
pub(super) struct Followed {
    /// Largest to the left.
    pub left: Option<Extreme>,
    /// Largest to the right.
    pub right: Option<Extreme>,
    /// Breaks of the order: what, and where.
    pub breaks: Vec<Break>,
}

/// A way in which the path fails to run along the whole curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Break {
    /// Starts this many mm (along the curve) from the curve's start.
    Start(u32, f64),
    /// Ends this many mm short of the curve's end (negative: beyond).
    End(u32, f64),
    /// Runs back by this many mm.
    Back(u32, f64),
    /// Advances this many mm on the curve in a path of this many mm.
    Skip(u32, f64, f64),
    /// A move does not start where the one before it ended, mm.
    Jump(u32, f64),
    /// Nothing moves along the curve.
    Nothing,
}

/// Limits of following, mm.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slack {
    /// How far ends may lie from the curve's ends along it, and how far a block may run back: rounding to the grid.
    pub along: f64,
    /// Deviations beyond this are gross and only found, not refined.
    pub gross: f64,
}

/// Follows the curve with the moves.
pub(super) fn follow(rail: &Rail<'_>, run: &Run<'_>, slack: Slack) -> Followed {
    let mut walker = Walker { rail, slack, found: Followed::default(), last: None, start: 0.0 };
    for (line, cut) in run {
        for primitive in Primitive::of(&cut.path) {
            walker.primitive(*line, &primitive);
        }
    }
    walker.finish()
}

struct Walker<'a, 'b> {
    rail: &'a Rail<'b>,
    slack: Slack,
    found: Followed,
    last: Option<(u32, Foot, Point2)>,
    start: f64,
}

impl Walker<'_, '_> {
    #[allow(clippy::cast_precision_loss)]
    fn primitive(&mut self, line: u32, primitive: &Primitive) {
        let mut measure = Measure::new(self.rail, primitive, self.slack.gross);
        let mut from = self.first_sight(line, &measure);
        let parts = primitive.parts(self.rail.length / 8.0);
        for i in 1..=parts {
            let to = measure.look(i as f64 / parts as f64, &from.foot);
            let mut best = self.known();
            measure.extremes(&from, &to, &mut best);
            self.keep(line, primitive, &best);
            self.advance(line, primitive, &from, &to);
            if matches!(primitive, Primitive::Rational { .. }) {
                let back = measure.retreat(&from, &to, self.slack.along);
                if back > self.slack.along {
                    self.found.breaks.push(Break::Back(line, back));
                }
            }
            from = to;
        }
        self.last = Some((line, from.foot, from.jet.p));
    }

    /// Where the primitive starts: at the foot of the last one's end, or anywhere for the first.
    fn first_sight(&mut self, line: u32, measure: &Measure<'_, '_>) -> Sight {
        let p = measure.primitive.at(0.0).p;
        let Some((_, foot, end)) = self.last else {
            let sight = measure.look(0.0, &self.rail.nearest_for_start(p));
            self.begin(line, &sight);
            return sight;
        };
        let gap = (p - end).norm();
        if gap > 1e-6 {
            self.found.breaks.push(Break::Jump(line, gap));
        }
        measure.look(0.0, &foot)
    }

    fn begin(&mut self, line: u32, sight: &Sight) {
        self.start = sight.foot.sigma;
        if self.rail.is_closed() {
            return;
        }
        let off = reach(&sight.foot);
        if off.abs() > self.slack.along {
            self.found.breaks.push(Break::Start(line, off));
        }
        self.start = 0.0;
    }

    /// The step along the curve must be that of the path, forward: ds >= (1 - k d) dσ on a smooth curve; at a corner the
    /// foot jumps by as much as the deviation allows.
    fn advance(&mut self, line: u32, primitive: &Primitive, from: &Sight, to: &Sight) {
        let step = to.foot.sigma - from.foot.sigma;
        let path = primitive.bounds()[0] * (to.x - from.x);
        if step < -self.slack.along {
            self.found.breaks.push(Break::Back(line, -step));
        }
        let deviation =
            [self.found.left, self.found.right].iter().flatten().map(|e| e.d.abs()).fold(0.0, f64::max);
        let curvature = from.foot.k.abs().max(to.foot.k.abs());
        let most = path / (1.0 - (curvature * deviation).min(0.5)) + 8.0 * deviation + self.slack.along;
        if step > most {
            self.found.breaks.push(Break::Skip(line, step, path));
        }
    }

    /// What is known so far, so that only new extremes are refined.
    fn known(&self) -> Extremes {
        let mut known = Extremes::NONE;
        if let Some(e) = self.found.left {
            known.left.0 = e.d;
        }
        if let Some(e) = self.found.right {
            known.right.0 = e.d;
        }
        known
    }

    fn keep(&mut self, line: u32, primitive: &Primitive, best: &Extremes) {
        let place = |(d, x): (f64, f64)| Extreme { d, line, at: primitive.at(x).p };
        if self.found.left.is_none_or(|e| best.left.0 > e.d) {
            self.found.left = Some(place(best.left));
        }
        if self.found.right.is_none_or(|e| best.right.0 < e.d) {
            self.found.right = Some(place(best.right));
        }
    }

    fn finish(mut self) -> Followed {
        let Some((line, foot, _)) = self.last else {
            self.found.breaks.push(Break::Nothing);
            return self.found;
        };
        let goal = if self.rail.is_closed() { self.start + self.rail.length } else { self.rail.length };
        let short = goal - reach(&foot);
        if short.abs() > self.slack.along {
            self.found.breaks.push(Break::End(line, short));
        }
        self.found
    }
}

/// Arc length of a foot, what lies beyond an end included.
fn reach(foot: &Foot) -> f64 {
    match foot.kind {
        FootKind::Beyond(by) => foot.sigma + by,
        FootKind::Smooth | FootKind::Corner => foot.sigma,
    }
}
