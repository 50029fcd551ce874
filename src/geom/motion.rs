//! Follower motions: the classic laws, polynomials and tables.

use crate::geom::curve::span_of;
use crate::math::TAU;
use crate::units::Angle;

mod form;
mod law;
mod poly;
mod table;
#[cfg(test)]
mod tests;

pub use law::{Law, Peaks};

use form::{Form, Piece};

/// Lift and its derivatives with respect to the cam angle: s, ds/dθ, d²s/dθ², d³s/dθ³ with θ in radians;
/// s in mm (translating) or radians (oscillating).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Lift {
    /// Lift.
    pub s: f64,
    /// Velocity per radian.
    pub v: f64,
    /// Acceleration per radian².
    pub a: f64,
    /// Jerk per radian³.
    pub j: f64,
}

/// Angles that add up to a turn within this many radians do so: rounding of decimal input.
pub const ANGLE_CLOSURE: f64 = 1e-9;
/// Lifts beyond this, mm, are no lifts; tables as well.
pub const LARGEST_LIFT: f64 = 1e9;
/// A jump of lift up to this share of the largest lift is rounding.
pub const LIFT_JUMP: f64 = 1e-9;
/// A jump of velocity or acceleration up to this share of the motion's typical value is rounding: the corner
/// it makes in a profile is below 1e-6 rad.
pub const DERIVATIVE_JUMP: f64 = 1e-6;

/// What a segment of a motion does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SegmentKind {
    /// Stands still.
    Dwell,
    /// Lifts.
    Rise,
    /// Lowers.
    Return,
}

/// How a rise or return goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SegmentLaw {
    /// A classic law. A return is the rise turned downwards; of a law made for one dwell, the rise run
    /// backwards in time, so that its resting end stays at the dwell.
    Law(Law),
    /// The polynomial through the segment's end lifts with these conditions.
    Poly {
        /// At the segment's start.
        start: Conditions,
        /// At its end.
        end: Conditions,
    },
}

/// Boundary conditions of a polynomial at one end, per radian; what is `None` is left free. They are signed
/// as the follower moves: a return has negative velocities.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Conditions {
    /// Velocity, lift per radian.
    pub v: Option<f64>,
    /// Acceleration, lift per radian².
    pub a: Option<f64>,
    /// Jerk, lift per radian³.
    pub j: Option<f64>,
}

impl Conditions {
    /// At rest: no velocity, no acceleration; the jerk is free.
    pub const REST: Conditions = Conditions { v: Some(0.0), a: Some(0.0), j: None };
}

/// A segment of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// What it does.
    pub kind: SegmentKind,
    /// Over which cam angle.
    pub angle: Angle,
    /// By how much, positive; mm, or radians of an oscillating follower; 0 for a dwell.
    pub lift: f64,
    /// How; without meaning for a dwell.
    pub law: SegmentLaw,
}

impl Segment {
    /// Stands still.
    #[must_use]
    pub const fn dwell(angle: Angle) -> Segment {
        Segment { kind: SegmentKind::Dwell, angle, lift: 0.0, law: SegmentLaw::Law(Law::CV) }
    }
    /// Lifts by `lift`.
    #[must_use]
    pub const fn rise(angle: Angle, lift: f64, law: SegmentLaw) -> Segment {
        Segment { kind: SegmentKind::Rise, angle, lift, law }
    }
    /// Lowers by `lift`.
    #[must_use]
    pub const fn fall(angle: Angle, lift: f64, law: SegmentLaw) -> Segment {
        Segment { kind: SegmentKind::Return, angle, lift, law }
    }
    /// Change of lift, signed.
    fn change(&self) -> f64 {
        match self.kind {
            SegmentKind::Dwell => 0.0,
            SegmentKind::Rise => self.lift,
            SegmentKind::Return => -self.lift,
        }
    }
}

/// A derivative of the lift.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Order {
    /// The lift itself.
    Lift,
    /// Velocity.
    Velocity,
    /// Acceleration.
    Acceleration,
}

/// What is wrong with, or to be known of, a motion. Lifts are mm or radians as in the segments.
#[derive(Debug, Clone, PartialEq)]
pub enum MotionIssue {
    /// There is no segment.
    Empty,
    /// A segment's angle is not positive (or not finite).
    SegmentAngle {
        /// Index of the segment.
        segment: usize,
        /// Its angle.
        angle: Angle,
    },
    /// A rise or return has no positive lift.
    SegmentLift {
        /// Index of the segment.
        segment: usize,
        /// Its lift.
        lift: f64,
    },
    /// The angles do not add up to a turn.
    AnglesDoNotClose {
        /// Their sum.
        sum: Angle,
        /// A turn minus the sum.
        missing: Angle,
    },
    /// Rises and returns do not cancel.
    LiftDoesNotClose {
        /// All rises.
        rises: f64,
        /// All returns.
        returns: f64,
    },
    /// The conditions of a `POLY` segment do not determine a polynomial of as many coefficients.
    PolyUndetermined {
        /// Index of the segment.
        segment: usize,
        /// Number of conditions, the two lifts included.
        conditions: usize,
    },
    /// A table has too few rows.
    TableTooShort {
        /// Rows there are.
        rows: usize,
        /// Rows needed.
        need: usize,
    },
    /// Angles of a table must ascend.
    TableNotAscending {
        /// Index of the row that does not lie after the one before it.
        row: usize,
        /// Its angle.
        angle: Angle,
        /// The angle of the row before.
        before: Angle,
    },
    /// A table's value is not a number, or out of any sensible range.
    TableValue {
        /// Index of the row.
        row: usize,
    },
    /// A table does not fill one turn.
    TableSpan {
        /// Angle between its first and last row.
        span: Angle,
    },
    /// A table's last row lies one turn after its first and has another lift.
    TableEnds {
        /// Lift of the first row.
        first: f64,
        /// Lift of the last row.
        last: f64,
    },
    /// A jump: an error for lift and velocity (no cam can do it), a warning for acceleration.
    Discontinuity {
        /// Cam angle.
        at: Angle,
        /// What jumps.
        order: Order,
        /// Value before, per radian^order.
        before: f64,
        /// Value after.
        after: f64,
    },
    /// The lift falls below 0, so that the base circle is not the profile's smallest.
    NegativeLift {
        /// Cam angle of the lowest point.
        at: Angle,
        /// Lift there.
        lift: f64,
    },
}

impl MotionIssue {
    /// Whether no cam can be made of it.
    #[must_use]
    pub fn is_error(&self) -> bool {
        match self {
            MotionIssue::Discontinuity { order, .. } => *order != Order::Acceleration,
            MotionIssue::NegativeLift { .. } => false,
            _ => true,
        }
    }
}

/// A follower's lift over one turn of the cam.
///
/// Between neighbouring [`Motion::breaks`] it is analytic. It repeats every turn.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    spans: Vec<Span>,
    breaks: Vec<f64>,
    issues: Vec<MotionIssue>,
}

/// One closed form of the motion, placed on the cam angle.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Span {
    piece: Piece,
    /// Cam angle of the segment's start, radians.
    start: f64,
    /// 1/(segment's angle), 1/rad.
    per_angle: f64,
    /// Lift added to the scaled form.
    base: f64,
    /// Lift of the segment.
    lift: f64,
    /// The form is run backwards.
    backwards: bool,
}

impl Span {
    fn at(&self, theta: f64) -> Lift {
        if self.piece.form == Form::Rest {
            return Lift { s: self.base, ..Lift::default() };
        }
        let x = (theta - self.start) * self.per_angle;
        let (x, sign) = if self.backwards { (1.0 - x, -1.0) } else { (x, 1.0) };
        let n = self.piece.at(x);
        let (b, h) = (self.per_angle, self.lift);
        Lift {
            s: self.base + h * n.s,
            v: sign * h * b * n.v,
            a: h * b * b * n.a,
            j: sign * h * b * b * b * n.j,
        }
    }
}

impl Motion {
    /// One turn made of segments, from cam angle 0.
    ///
    /// # Errors
    /// Every issue that is an error, and the warnings beside them.
    pub fn from_segments(segments: Vec<Segment>) -> Result<Motion, Vec<MotionIssue>> {
        let issues = segment_issues(&segments);
        if !issues.is_empty() {
            return Err(issues);
        }
        let (spans, breaks, issues) = place(&segments);
        Motion { spans, breaks, issues }.checked()
    }
    /// The C2 cubic spline through a table of angle and lift.
    ///
    /// A periodic table fills one turn with or without its first row repeated at the end. Another one
    /// must reach from its first angle to one turn later, and stands still at both ends.
    ///
    /// # Errors
    /// Every issue that is an error.
    pub fn from_table(rows: &[(Angle, f64)], periodic: bool) -> Result<Motion, Vec<MotionIssue>> {
        let table = table::Table::new(rows, periodic)?;
        Motion { spans: table.spans(), breaks: table.breaks(), issues: Vec::new() }.checked()
    }
    fn checked(mut self) -> Result<Motion, Vec<MotionIssue>> {
        self.issues.extend(self.discontinuities());
        self.issues.extend(self.negative_lift());
        if self.issues.iter().any(MotionIssue::is_error) { Err(self.issues) } else { Ok(self) }
    }
    /// Lift and derivatives at a cam angle; at a break, those of the span that starts there.
    #[must_use]
    pub fn at(&self, theta: Angle) -> Lift {
        let theta = theta.rad();
        let theta = if (0.0..=TAU).contains(&theta) { theta } else { theta - TAU * (theta / TAU).floor() };
        self.at_in(self.span_of(theta), theta)
    }
    /// Lift and derivatives at `theta` radians (0…2π) seen from inside span `span`.
    #[must_use]
    pub fn at_in(&self, span: usize, theta: f64) -> Lift {
        self.spans.get(span).map_or(Lift::default(), |s| s.at(theta))
    }
    /// Index of the span that holds `theta` radians (0…2π).
    #[must_use]
    pub fn span_of(&self, theta: f64) -> usize {
        span_of(&self.breaks, theta)
    }
    /// Ascending cam angles in radians, from 0 to 2π, that bound the analytic spans.
    #[must_use]
    pub fn breaks(&self) -> &[f64] {
        &self.breaks
    }
    /// Whether the follower stands still in a span.
    #[must_use]
    pub fn is_dwell(&self, span: usize) -> bool {
        self.spans.get(span).is_some_and(|s| s.piece.form == Form::Rest)
    }
    /// What is to be known of it (warnings only, since it exists).
    #[must_use]
    pub fn issues(&self) -> &[MotionIssue] {
        &self.issues
    }
    /// The jumps of lift, velocity and acceleration at all breaks, the turn's start included.
    #[must_use]
    pub fn discontinuities(&self) -> Vec<MotionIssue> {
        let scale = self.scales();
        let last = self.spans.len().saturating_sub(1);
        let mut found = Vec::new();
        for (span, w) in self.breaks.windows(2).enumerate() {
            let (before_span, before_theta) = if span == 0 { (last, TAU) } else { (span - 1, w[0]) };
            let (before, after) = (self.at_in(before_span, before_theta), self.at_in(span, w[0]));
            found.extend(jumps(w[0], before, after, scale));
        }
        found
    }
    /// Typical lift, velocity and acceleration: the largest over the spans.
    fn scales(&self) -> [f64; 3] {
        let mut scale = [f64::MIN_POSITIVE; 3];
        for (span, w) in self.breaks.windows(2).enumerate() {
            for i in 0..=8 {
                let l = self.at_in(span, w[0] + (w[1] - w[0]) * f64::from(i) / 8.0);
                scale = [scale[0].max(l.s.abs()), scale[1].max(l.v.abs()), scale[2].max(l.a.abs())];
            }
        }
        scale
    }
    fn negative_lift(&self) -> Option<MotionIssue> {
        let limit = -LIFT_JUMP * self.scales()[0];
        let lowest = |(span, w): (usize, &[f64])| {
            super::extremum::maximum(|theta| -self.at_in(span, theta).s, w[0], w[1], 8)
        };
        let (theta, depth) =
            self.breaks.windows(2).enumerate().map(lowest).max_by(|a, b| a.1.total_cmp(&b.1))?;
        (-depth < limit).then(|| MotionIssue::NegativeLift { at: Angle::radians(theta), lift: -depth })
    }
}

fn jumps(theta: f64, before: Lift, after: Lift, scale: [f64; 3]) -> Vec<MotionIssue> {
    let at = Angle::radians(theta);
    let limits = [LIFT_JUMP, DERIVATIVE_JUMP, DERIVATIVE_JUMP];
    let pairs = [
        (Order::Lift, before.s, after.s),
        (Order::Velocity, before.v, after.v),
        (Order::Acceleration, before.a, after.a),
    ];
    let jump = |(i, (order, before, after)): (usize, (Order, f64, f64))| {
        let real = (after - before).abs() > limits[i] * scale[i];
        real.then_some(MotionIssue::Discontinuity { at, order, before, after })
    };
    pairs.into_iter().enumerate().filter_map(jump).collect()
}

/// Everything that keeps segments from making one turn.
fn segment_issues(segments: &[Segment]) -> Vec<MotionIssue> {
    let mut issues: Vec<MotionIssue> =
        segments.iter().enumerate().filter_map(|(i, segment)| segment_issue(i, segment)).collect();
    if segments.is_empty() {
        issues.push(MotionIssue::Empty);
    }
    if !issues.is_empty() {
        return issues;
    }
    let sum: f64 = segments.iter().map(|s| s.angle.rad()).sum();
    if (sum - TAU).abs() > ANGLE_CLOSURE {
        let (sum, missing) = (Angle::radians(sum), Angle::radians(TAU - sum));
        issues.push(MotionIssue::AnglesDoNotClose { sum, missing });
    }
    let total = |kind| segments.iter().filter(|s| s.kind == kind).map(|s| s.lift).sum::<f64>();
    let (rises, returns) = (total(SegmentKind::Rise), total(SegmentKind::Return));
    if (rises - returns).abs() > LIFT_JUMP * rises.max(returns) {
        issues.push(MotionIssue::LiftDoesNotClose { rises, returns });
    }
    let unsolved = |(i, s): (usize, &Segment)| poly::unsolvable(i, s);
    issues.extend(segments.iter().enumerate().filter_map(unsolved));
    issues
}

fn segment_issue(index: usize, segment: &Segment) -> Option<MotionIssue> {
    let angle = segment.angle.rad();
    if !(angle > ANGLE_CLOSURE && angle.is_finite()) {
        return Some(MotionIssue::SegmentAngle { segment: index, angle: segment.angle });
    }
    let lift_needed = segment.kind != SegmentKind::Dwell;
    let lift_good = segment.lift > 0.0 && segment.lift <= LARGEST_LIFT;
    (lift_needed && !lift_good).then_some(MotionIssue::SegmentLift { segment: index, lift: segment.lift })
}

/// Puts the segments one after the other; the lowest end of a segment has lift 0.
fn place(segments: &[Segment]) -> (Vec<Span>, Vec<f64>, Vec<MotionIssue>) {
    let levels: Vec<f64> = segments
        .iter()
        .scan(0.0, |level, s| {
            let start = *level;
            *level += s.change();
            Some(start)
        })
        .collect();
    let lowest = levels.iter().copied().fold(0.0, f64::min);
    let (mut spans, mut breaks, mut start) = (Vec::new(), Vec::new(), 0.0);
    for (segment, level) in segments.iter().zip(levels) {
        for span in segment_spans(segment, start, level - lowest) {
            let x = if span.backwards { 1.0 - span.piece.to } else { span.piece.from };
            breaks.push(start + x * segment.angle.rad());
            spans.push(span);
        }
        start += segment.angle.rad();
    }
    breaks.push(TAU);
    (spans, breaks, Vec::new())
}

/// The spans of one segment that starts at cam angle `start` with lift `level`.
fn segment_spans(segment: &Segment, start: f64, level: f64) -> Vec<Span> {
    let whole = |form| Piece { from: 0.0, to: 1.0, form };
    let per_angle = 1.0 / segment.angle.rad();
    let span = |piece, base, lift, backwards| Span { piece, start, per_angle, base, lift, backwards };
    match (segment.kind, segment.law) {
        (SegmentKind::Dwell, _) => vec![span(whole(Form::Rest), level, 0.0, false)],
        (SegmentKind::Rise, SegmentLaw::Law(law)) => {
            law.pieces().iter().map(|p| span(*p, level, segment.lift, false)).collect()
        }
        (SegmentKind::Return, SegmentLaw::Law(law)) if law.dwells_at_one_end() => {
            let end = level - segment.lift;
            law.pieces().iter().rev().map(|p| span(*p, end, segment.lift, true)).collect()
        }
        (SegmentKind::Return, SegmentLaw::Law(law)) => {
            law.pieces().iter().map(|p| span(*p, level, -segment.lift, false)).collect()
        }
        (_, SegmentLaw::Poly { .. }) => poly::coefficients(segment)
            .map(|c| span(whole(Form::Polynomial(c)), level, 1.0, false))
            .into_iter()
            .collect(),
    }
}
