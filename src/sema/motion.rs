//! `MOTION`: segments and tables.

use std::rc::Rc;

use crate::diag::cam::LiftUnit;
use crate::diag::codes::{cam as codes, semantics};
use crate::diag::{self, Diagnostic};
use crate::geom::motion::{Conditions, Motion, MotionIssue, Segment, SegmentLaw};
use crate::math::DEG;
use crate::source::Span;
use crate::units::{Angle, Dim, Quantity, tidy};

use super::Analyser;
use super::matched::{Found, Matched, Typed};
use super::members::segment_kind;
use super::value::{Entity, MotionSource, MotionValue, SegmentShape, SegmentValue, Value};

impl Analyser<'_> {
    /// `M1 = MOTION/ …`.
    pub(super) fn motion(&mut self, m: &Matched) -> Option<Value> {
        let source = if m.form == "table" { self.table(m)? } else { self.segments(m)? };
        let motion = MotionValue { source, span: m.word };
        let swing = self.lift_dim(&motion) == Dim::ANGLE;
        let result = self.build_motion(&motion, swing);
        let sound = self.motion_issues(&motion, result, swing).is_some();
        sound.then(|| Value::Entity(Entity::Motion(Rc::new(motion))))
    }

    /// The dimension of its lifts; bare when nothing says.
    pub(super) fn lift_dim(&self, motion: &MotionValue) -> Dim {
        match &motion.source {
            MotionSource::Segments(segments) => {
                segments.iter().map(|s| s.lift.dim).find(|d| *d != Dim::NONE).unwrap_or(Dim::NONE)
            }
            MotionSource::Table { dim, .. } => *dim,
        }
    }

    fn segments(&mut self, m: &Matched) -> Option<MotionSource> {
        let mut segments: Vec<SegmentValue> = Vec::new();
        let mut sound = true;
        for (i, found) in m.found.iter().enumerate() {
            let values = m.found.get(i + 1..).unwrap_or(&[]);
            let shape = match found.name {
                "dwell" => SegmentShape::Dwell,
                "rise" => SegmentShape::Rise,
                "return" => SegmentShape::Return,
                "v0" | "a0" | "j0" | "v1" | "a1" | "j1" => {
                    sound &= self.boundary(&mut segments, found, values.first());
                    continue;
                }
                _ => continue,
            };
            match self.segment(shape, found.span, values) {
                Some(segment) => segments.push(segment),
                None => sound = false,
            }
        }
        if segments.is_empty() && sound {
            let problem = Diagnostic::new(
                &semantics::MISSING_VALUE,
                m.word,
                "MOTION wants segments: DWELL, RISE, RETURN",
            )
            .help(
                "for example `MOTION/ DWELL, 60, RISE, 120, 20, MODSIN, DWELL, 60, RETURN, 120, 20, MODSIN`",
            );
            self.report(problem);
            return None;
        }
        sound &= self.same_lift(&segments);
        sound.then_some(MotionSource::Segments(segments))
    }

    fn segment(&mut self, shape: SegmentShape, span: Span, values: &[Found]) -> Option<SegmentValue> {
        let (angle, angle_span) = match values.first() {
            Some(Found { name: "angle", typed: Typed::Number(angle), span }) => (*angle, *span),
            _ => return None,
        };
        if shape == SegmentShape::Dwell {
            let lift = Quantity::bare(0.0);
            return Some(SegmentValue {
                shape,
                angle,
                lift,
                law: None,
                boundary: Vec::new(),
                span: span.to(angle_span),
            });
        }
        let (Some(lift), Some(law)) = (values.get(1), values.get(2)) else { return None };
        let (Typed::Quantity(q), Typed::Law(kind)) = (&lift.typed, &law.typed) else { return None };
        if q.value <= 0.0 {
            let message = format!("a lift must be greater than 0, and this is {}", self.show(*q));
            self.report(
                Diagnostic::new(&codes::NOT_POSITIVE, lift.span, message)
                    .help("RISE lifts and RETURN lowers; both take the lift without a sign"),
            );
            return None;
        }
        if q.is_bare() && self.unit_used.is_none() {
            self.unit_used = Some(lift.span);
        }
        let span = span.to(law.span);
        Some(SegmentValue { shape, angle, lift: *q, law: *kind, boundary: Vec::new(), span })
    }

    /// A boundary value belongs to the POLY segment before it.
    fn boundary(&mut self, segments: &mut [SegmentValue], word: &Found, value: Option<&Found>) -> bool {
        let order = match word.name {
            "v0" | "v1" => 1,
            "a0" | "a1" => 2,
            _ => 3,
        };
        let at_end = word.name.ends_with('1');
        let Some(Found { typed: Typed::Quantity(q), span, .. }) = value else { return false };
        let poly = segments.last_mut().filter(|s| s.shape != SegmentShape::Dwell && s.law.is_none());
        let Some(segment) = poly else {
            let message = format!(
                "{} is a boundary value of a POLY segment, and none stands before it",
                word.name.to_uppercase()
            );
            self.report(
                Diagnostic::new(&codes::POLY_UNDETERMINED, word.span, message)
                    .help("write it behind the segment: `RISE, 120, 20, POLY, V0, 0, A0, 0, V1, 0, A1, 0`"),
            );
            return false;
        };
        let double = segment.boundary.iter().find(|b| (b.0, b.1) == (order, at_end)).map(|b| b.3);
        if let Some(first) = double {
            let message = format!("{} is given twice for one segment", word.name.to_uppercase());
            self.report(
                Diagnostic::new(&semantics::DOUBLED_WORD, word.span, message).label(first, "first here"),
            );
            return false;
        }
        segment.boundary.push((order, at_end, *q, word.span));
        segment.span = segment.span.to(*span);
        true
    }

    fn same_lift(&mut self, segments: &[SegmentValue]) -> bool {
        let mut known: Option<&SegmentValue> = None;
        for segment in segments.iter().filter(|s| s.lift.dim != Dim::NONE) {
            match known {
                Some(first) if first.lift.dim != segment.lift.dim => {
                    let message = "the lifts of a motion are all lengths or all angles";
                    let (a, b) = (first.lift.dim.name(), segment.lift.dim.name());
                    self.report(
                        Diagnostic::new(&codes::LIFT_DIMENSION, segment.span, message)
                            .at(format!("an {b}").replace("an l", "a l"))
                            .label(first.span, format!("an {a}").replace("an l", "a l")),
                    );
                    return false;
                }
                Some(_) => {}
                None => known = Some(segment),
            }
        }
        true
    }

    /// The motion in the geometry's terms; bare lifts are angles in degrees when it swings, else lengths.
    pub(super) fn build_motion(&self, motion: &MotionValue, swing: bool) -> Result<Motion, Vec<MotionIssue>> {
        match &motion.source {
            MotionSource::Segments(segments) => {
                Motion::from_segments(segments.iter().map(|s| self.geometry_segment(s, swing)).collect())
            }
            MotionSource::Table { rows, dim, periodic } => {
                let unit = if *dim == Dim::NONE && !swing { self.unit().in_mm() } else { 1.0 };
                let factor = if swing { DEG } else { unit };
                let rows: Vec<(Angle, f64)> =
                    rows.iter().map(|&(angle, lift)| (Angle::degrees(angle), lift * factor)).collect();
                Motion::from_table(&rows, *periodic)
            }
        }
    }

    fn geometry_segment(&self, segment: &SegmentValue, swing: bool) -> Segment {
        let law = match segment.law {
            Some(law) => SegmentLaw::Law(law),
            None if segment.shape == SegmentShape::Dwell => {
                return Segment::dwell(Angle::degrees(segment.angle));
            }
            None => {
                let (start, end) = self.conditions(segment, swing);
                SegmentLaw::Poly { start, end }
            }
        };
        Segment {
            kind: segment_kind(segment.shape),
            angle: Angle::degrees(segment.angle),
            lift: self.lift_in_base(segment.lift, swing),
            law,
        }
    }

    /// mm, or radians when it swings.
    fn lift_in_base(&self, lift: Quantity, swing: bool) -> f64 {
        let factor = match (swing, lift.is_bare()) {
            (true, _) => DEG,
            (false, true) => self.unit().in_mm(),
            (false, false) => 1.0,
        };
        if factor == DEG { lift.value * DEG } else { tidy(lift.value * factor) }
    }

    fn conditions(&self, segment: &SegmentValue, swing: bool) -> (Conditions, Conditions) {
        let (mut start, mut end) = (Conditions::default(), Conditions::default());
        for &(order, at_end, q, _) in &segment.boundary {
            let per_radian = (0..order).fold(self.lift_in_base(q, swing), |v, _| v / DEG);
            let ends = if at_end { &mut end } else { &mut start };
            match order {
                1 => ends.v = Some(per_radian),
                2 => ends.a = Some(per_radian),
                _ => ends.j = Some(per_radian),
            }
        }
        (start, end)
    }

    /// Reports what is wrong with a motion; the motion, if one came of it.
    pub(super) fn motion_issues(
        &mut self,
        value: &MotionValue,
        result: Result<Motion, Vec<MotionIssue>>,
        swing: bool,
    ) -> Option<Motion> {
        let (motion, issues) = match result {
            Ok(motion) => {
                let issues = motion.issues().to_vec();
                (Some(motion), issues)
            }
            Err(issues) => (None, issues),
        };
        for issue in &issues {
            let problem = self.motion_problem(value, issue, swing);
            self.report(problem);
        }
        motion
    }

    fn motion_problem(&self, value: &MotionValue, issue: &MotionIssue, swing: bool) -> Diagnostic {
        let segment = |i: usize| match &value.source {
            MotionSource::Segments(segments) => segments.get(i).map(|s| s.span),
            MotionSource::Table { .. } => None,
        };
        let unit = if swing { LiftUnit::Angle } else { LiftUnit::Length(self.unit()) };
        let mut problem = diag::cam::motion(issue, value.span, segment, unit);
        let MotionIssue::Discontinuity { at, .. } = issue else { return problem };
        let (next, previous) = neighbours(value, *at);
        if let Some(next) = next {
            problem.primary = Some(diag::Label { span: next, message: "this segment starts there".into() });
        }
        match previous {
            Some(previous) => problem.label(previous, "this one ends there"),
            None => problem,
        }
    }
}

/// The segments that start and end at a cam angle.
fn neighbours(value: &MotionValue, at: Angle) -> (Option<Span>, Option<Span>) {
    let MotionSource::Segments(segments) = &value.source else { return (None, None) };
    let mut sum = 0.0;
    let mut previous = segments.last();
    for segment in segments {
        if (sum - at.deg()).abs() < SAME_ANGLE {
            return (Some(segment.span), previous.map(|s| s.span));
        }
        sum += segment.angle;
        previous = Some(segment);
    }
    (None, None)
}

/// Degrees within which a joint is found again.
const SAME_ANGLE: f64 = 1e-6;
