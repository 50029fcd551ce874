//! NURBS interpolation: LinuxCNC's G5.2/G5.3 and Fanuc's G06.2.

use super::block::{Block, bit};
use super::codes::Mode;
use super::machine::Machine;
use super::motion::Target;
use super::state::Plan;
use crate::geom::{Point2, Point3};
use crate::readback::curve::Plane;
use crate::readback::out::Out;
use crate::readback::{FeedMode, Follow, SpaceCurve, TracePath};

/// Most control points of one curve; a control's memory is smaller.
const MOST_POINTS: usize = 1_000_000;

/// Axes of control points.
const AXES: [u8; 3] = [b'X', b'Y', b'Z'];

/// A curve whose blocks are being read.
#[derive(Debug, Default)]
pub(super) struct Open {
    order: usize,
    points: Vec<Point3>,
    weights: Vec<f64>,
    knots: Vec<f64>,
    /// Knot-only blocks have begun (Fanuc).
    closing: bool,
    open: bool,
    spoilt: bool,
    /// Line of the last control point.
    line: u32,
    /// The axes of the first block (Fanuc).
    named: [bool; 3],
}

impl Open {
    fn begin(&mut self, order: usize) {
        *self = Open { order, open: true, ..Open::default() };
    }
}

impl Machine<'_> {
    /// Takes a block that opens, continues or closes a curve; `false` when it has nothing to do with one.
    pub(super) fn nurbs_block<S: Follow>(
        &mut self,
        block: &Block,
        plan: &Plan,
        used: &mut u32,
        out: &mut Out<'_, S>,
    ) -> bool {
        if plan.nurbs_end {
            self.close_points(out);
            return true;
        }
        match plan.motion {
            // A modal word that is in force already: the curve goes on.
            Some(Mode::BSpline) if self.nurbs.open => self.spline_point(block, used, out),
            Some(Mode::BSpline) => self.open_spline(block, used, out),
            Some(Mode::NurbsPoints) => self.open_points(block, used, out),
            Some(Mode::NurbsKnots) => self.open_knots(block, used, out),
            Some(_) if self.nurbs.open => {
                self.left_early(out);
                return false;
            }
            None if self.nurbs.open => match self.state.motion {
                Mode::NurbsKnots => self.knot_block(block, used, out),
                Mode::BSpline => self.spline_point(block, used, out),
                _ => self.point_block(block, used, out),
            },
            _ => return false,
        }
        true
    }

    /// Complains about a curve that the text ends in; a BSPLINE simply ends.
    pub(super) fn nurbs_left_open<S: Follow>(&mut self, out: &mut Out<'_, S>) {
        if self.nurbs.open && self.state.motion == Mode::BSpline {
            return self.close_spline(out);
        }
        if self.nurbs.open {
            self.left_early(out);
        }
    }

    fn left_early<S: Follow>(&mut self, out: &mut Out<'_, S>) {
        let points = self.state.motion == Mode::NurbsPoints;
        self.nurbs.open = false;
        self.state.motion = Mode::None;
        out.fault(if points {
            "the curve of G5.2 is not closed by G5.3"
        } else {
            "alarm PS1005, the curve of G06.2 is left before its closing knots"
        });
    }

    fn can_open<S: Follow>(&mut self, block: &Block, name: &str, out: &mut Out<'_, S>) -> bool {
        if self.nurbs.open {
            out.fault(format!("{name} inside a curve that is not closed"));
        }
        if self.state.plane != Plane::Xy && name == "G5.2" {
            out.fault("G5.2 outside the XY plane (G17)");
            return false;
        }
        let mode = self.state.feed_mode.unwrap_or(FeedMode::PerMinute);
        if name == "G06.2" && mode != FeedMode::PerMinute {
            out.fault("alarm PS1006, G06.2 under G93 or G95");
            return false;
        }
        if !(self.state.known[0] && self.state.known[1]) {
            out.fault(format!("{name} from a position that is not known"));
            return false;
        }
        self.feed_is_there(block, out)
    }

    fn open_points<S: Follow>(&mut self, block: &Block, used: &mut u32, out: &mut Out<'_, S>) {
        let fine = self.can_open(block, "G5.2", out);
        self.state.motion = Mode::NurbsPoints;
        let order = self.small_integer(block, b'L', 3, used, out);
        self.nurbs.begin(order);
        self.nurbs.spoilt = !fine;
        self.nurbs.points.push(self.stands());
        *used |= bit(b'P');
        let weight = block.get(b'P').unwrap_or(1.0);
        self.nurbs.weights.push(weight);
        if block.has(b'X') || block.has(b'Y') {
            // The P of an opening block with a point is that point's weight; the start's is 1.
            self.nurbs.weights.clear();
            self.nurbs.weights.push(1.0);
            self.point_block(block, used, out);
        } else if weight <= 0.0 {
            out.fault(format!("P{weight}: a control point needs a positive weight"));
        }
    }

    fn point_block<S: Follow>(&mut self, block: &Block, used: &mut u32, out: &mut Out<'_, S>) {
        *used |= bit(b'X') | bit(b'Y') | bit(b'P');
        let target = self.target(block, out);
        if !target.moved[0] && !target.moved[1] {
            return;
        }
        if !(target.moved[0] && target.moved[1]) {
            out.fault("a control point needs X and Y");
        }
        let weight = block.get(b'P');
        if weight.is_none_or(|w| w <= 0.0) {
            out.fault("a control point needs a positive weight P");
            self.nurbs.spoilt = true;
        }
        self.add_point(&target, weight.unwrap_or(1.0), out);
    }

    fn add_point<S: Follow>(&mut self, target: &Target, weight: f64, out: &mut Out<'_, S>) {
        if self.nurbs.points.len() >= MOST_POINTS {
            self.nurbs.spoilt = true;
            return;
        }
        if self.nurbs.points.len() == MOST_POINTS - 1 {
            out.fault(format!("a curve of {MOST_POINTS} control points"));
        }
        self.nurbs.points.push(Point3::new(target.to[0], target.to[1], target.to[2]));
        self.nurbs.weights.push(weight);
        if target.moved[2] && !self.state.known[2] {
            self.nurbs.spoilt = true;
            out.fault("a curve that climbs from a height that is not known");
        }
        self.arrive_at_point(target);
    }

    /// The programmed position moves on with the control points; the move itself is handed on at the end.
    fn arrive_at_point(&mut self, target: &Target) {
        self.arrive(target);
    }

    fn close_points<S: Follow>(&mut self, out: &mut Out<'_, S>) {
        if !self.nurbs.open || self.state.motion != Mode::NurbsPoints {
            return out.fault("G5.3 without G5.2");
        }
        let curve = core::mem::take(&mut self.nurbs);
        self.state.motion = Mode::None;
        let (n, order) = (curve.points.len(), curve.order);
        if n < order {
            return out
                .fault(format!("G5.3: {n} control points, the order L {order} needs {order} at least"));
        }
        if curve.spoilt {
            return;
        }
        let knots = uniform_knots(n, order);
        self.hand_on(curve, knots, out);
    }

    #[allow(clippy::float_cmp)]
    fn hand_on<S: Follow>(&mut self, curve: Open, knots: Vec<f64>, out: &mut Out<'_, S>) {
        let to = self.state.position;
        let c = to[super::motion::ROTARY];
        let order = u8::try_from(curve.order).unwrap_or(u8::MAX);
        let weights = curve.weights;
        let from = curve.points.first().map_or(to[2], |p| p.z);
        let level = curve.points.windows(2).all(|pair| pair[0].z == pair[1].z);
        let flat: Vec<Point2> = curve.points.iter().map(|p| self.in_part(p.x, p.y, c)).collect();
        let path = if level {
            TracePath::Nurbs { order, points: flat, weights, knots }
        } else {
            let lift = |(p, q): (Point2, &Point3)| Point3::new(p.x, p.y, q.z);
            let points = flat.into_iter().zip(&curve.points).map(lift).collect();
            TracePath::Space(Box::new(SpaceCurve { order, points, weights, knots }))
        };
        self.emit(path, [to[0], to[1], from, to[3]], &Target { to, moved: [false; 4] }, false, out);
    }

    /// Where the tool is.
    fn stands(&self) -> Point3 {
        let [x, y, z, _] = self.state.position;
        Point3::new(x, y, z)
    }

    /// A small positive integer word, with its default.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn small_integer<S: Follow>(
        &self,
        block: &Block,
        letter: u8,
        default: usize,
        used: &mut u32,
        out: &mut Out<'_, S>,
    ) -> usize {
        *used |= bit(letter);
        match block.get(letter) {
            None => default,
            Some(v) if v.fract() == 0.0 && (2.0..=32.0).contains(&v) => v as usize,
            Some(v) => {
                out.fault(format!("{}{v} is not an order of a curve", char::from(letter)));
                default
            }
        }
    }

    /// `BSPLINE SD=3`: the first control point is where the tool is; each next one is as far on in the parameter as PL
    /// says, which must be 1 here.
    fn open_spline<S: Follow>(&mut self, block: &Block, used: &mut u32, out: &mut Out<'_, S>) {
        let fine = self.can_open(block, "BSPLINE", out);
        self.state.motion = Mode::BSpline;
        let degree = block.words.as_ref().and_then(|w| w.degree).unwrap_or(3.0);
        let order = match degree {
            2.0 => 3,
            3.0 => 4,
            _ => {
                out.fault(format!("SD={degree}: a BSPLINE has the degree 2 or 3"));
                4
            }
        };
        self.nurbs.begin(order);
        self.nurbs.spoilt = !fine;
        self.nurbs.points.push(self.stands());
        self.nurbs.weights.push(1.0);
        self.spline_point(block, used, out);
    }

    /// A block without a control point ends a BSPLINE, before anything in it takes effect.
    pub(super) fn spline_over<S: Follow>(&mut self, block: &Block, plan: &Plan, out: &mut Out<'_, S>) {
        let open = self.nurbs.open && self.state.motion == Mode::BSpline;
        let over = plan.motion.map_or_else(|| !has_point(block), |mode| mode != Mode::BSpline);
        if open && over {
            self.close_spline(out);
        }
    }

    fn spline_point<S: Follow>(&mut self, block: &Block, used: &mut u32, out: &mut Out<'_, S>) {
        let words = block.words.as_ref();
        *used |= bit(b'X') | bit(b'Y') | bit(b'Z');
        if !has_point(block) {
            return;
        }
        let weight = words.and_then(|w| w.weight).unwrap_or(1.0);
        let interval = words.and_then(|w| w.interval).unwrap_or(1.0);
        if !(weight > 0.0 && weight <= 3.0) {
            self.nurbs.spoilt = true;
            out.fault(format!("PW={weight}: a control point has a weight over 0 and up to 3"));
        }
        if interval != 1.0 {
            self.nurbs.spoilt = true;
            out.fault(format!("PL={interval}, this reader follows uniform knots (1) only"));
        }
        let target = self.target(block, out);
        self.nurbs.line = out.line;
        self.add_point(&target, weight, out);
    }

    /// The curve is over; it counts to the line of its last point.
    fn close_spline<S: Follow>(&mut self, out: &mut Out<'_, S>) {
        let curve = core::mem::take(&mut self.nurbs);
        self.state.motion = Mode::None;
        let (n, order) = (curve.points.len(), curve.order);
        let line = core::mem::replace(&mut out.line, curve.line.max(1));
        if n < order {
            out.fault(format!("a BSPLINE of {n} control points, its order needs {order} at least"));
        } else if !curve.spoilt {
            let knots = uniform_knots(n, order);
            self.hand_on(curve, knots, out);
        }
        out.line = line;
    }

    fn open_knots<S: Follow>(&mut self, block: &Block, used: &mut u32, out: &mut Out<'_, S>) {
        let fine = self.can_open(block, "G06.2", out);
        self.state.motion = Mode::NurbsKnots;
        let rank = self.small_integer(block, b'P', 4, used, out);
        if !(2..=4).contains(&rank) {
            out.fault(format!("G06.2 with rank P{rank}, the control has 2 to 4"));
        }
        self.nurbs.begin(rank);
        self.nurbs.spoilt = !fine;
        self.nurbs.named = AXES.map(|axis| block.has(axis));
        let target = self.target(block, out);
        if target.to != self.state.position {
            let u = self.unit();
            out.fault(format!(
                "the first control point ({:.5}, {:.5}) is not the current position ({:.5}, {:.5})",
                target.to[0] / u,
                target.to[1] / u,
                self.state.position[0] / u,
                self.state.position[1] / u
            ));
        }
        self.knot_block(block, used, out);
    }

    fn knot_block<S: Follow>(&mut self, block: &Block, used: &mut u32, out: &mut Out<'_, S>) {
        *used |= bit(b'K') | bit(b'R') | bit(b'X') | bit(b'Y') | bit(b'Z');
        let point = has_point(block) || self.nurbs.points.is_empty();
        if !point && !block.has(b'K') {
            return;
        }
        let Some(knot) = block.get(b'K') else {
            self.nurbs.spoilt = true;
            return out.fault("alarm PS1002, a control point without its knot K");
        };
        if self.nurbs.knots.last().is_some_and(|&last| knot < last) {
            self.nurbs.spoilt = true;
            out.fault(format!("alarm PS1008, the knot K{knot} is smaller than the one before it"));
        }
        self.nurbs.knots.push(knot);
        if point {
            self.knot_point(block, out);
        } else {
            self.nurbs.closing = true;
            if self.nurbs.knots.len() >= self.nurbs.points.len() + self.nurbs.order {
                self.close_knots(out);
            }
        }
    }

    fn knot_point<S: Follow>(&mut self, block: &Block, out: &mut Out<'_, S>) {
        if self.nurbs.closing {
            self.nurbs.spoilt = true;
            return out.fault("alarm PS1004, a control point after the closing knots began");
        }
        for (axis, named) in AXES.into_iter().zip(self.nurbs.named) {
            if block.has(axis) && !named {
                self.nurbs.spoilt = true;
                out.fault(format!("{} is no axis of the first block of this G06.2", char::from(axis)));
            }
        }
        let target = self.target(block, out);
        let weight = block.get(b'R').unwrap_or(1.0);
        if weight <= 0.0 {
            self.nurbs.spoilt = true;
            out.fault(format!("R{weight}: a control point needs a positive weight"));
        }
        self.add_point(&target, weight, out);
    }

    fn close_knots<S: Follow>(&mut self, out: &mut Out<'_, S>) {
        let mut curve = core::mem::take(&mut self.nurbs);
        self.state.motion = Mode::None;
        let (n, order) = (curve.points.len(), curve.order);
        if n < order {
            return out.fault(format!(
                "alarm PS1001: {n} control points, the rank P{order} needs {order} at least"
            ));
        }
        if let Some(complaint) = knot_complaint(&curve.knots, order) {
            return out.fault(complaint);
        }
        if !curve.spoilt {
            let knots = core::mem::take(&mut curve.knots);
            self.hand_on(curve, knots, out);
        }
    }
}

/// Whether the block says a control point.
fn has_point(block: &Block) -> bool {
    AXES.into_iter().any(|axis| block.has(axis))
}

/// What is wrong with a clamped knot vector of this order.
#[allow(clippy::float_cmp)]
fn knot_complaint(knots: &[f64], order: usize) -> Option<String> {
    let first = knots.get(..order)?;
    let last = knots.get(knots.len() - order..)?;
    let same = |run: &[f64]| run.windows(2).all(|w| w.first() == w.last());
    if !same(first) || !same(last) {
        return Some(format!("alarm PS1007, the first and the last {order} knots must be the same"));
    }
    let inner = knots.get(order..knots.len() - order).unwrap_or_default();
    let crowded = inner.windows(order).any(|w| w.first() == w.last());
    let touches = inner.first().is_some_and(|k| Some(k) == first.first() || k <= first.first().unwrap_or(k))
        || inner.last().is_some_and(|k| Some(k) == last.first());
    if crowded || touches || first.first() == last.first() {
        return Some(format!("alarm PS1008, a knot is repeated {order} times or more inside the curve"));
    }
    None
}

/// The clamped uniform knots that LinuxCNC makes for `n` control points: 0 … 0, 1, 2 … m … m.
#[allow(clippy::cast_precision_loss)]
fn uniform_knots(n: usize, order: usize) -> Vec<f64> {
    let spans = n + 1 - order;
    (0..n + order).map(|i| (i + 1).saturating_sub(order).min(spans) as f64).collect()
}
