//! `FOLLOW` and `CAM`, and what the geometry finds wrong with a cam.

use std::rc::Rc;

use crate::diag::codes::cam as codes;
use crate::diag::{self, Diagnostic};
use crate::geom::cam::{Cam, CamDefinition, CamIssue, Rotation};
use crate::geom::follower::{ArmSide, Follower};
use crate::ir::CamEntity;
use crate::units::{Angle, Dim, show_angle, tidy};

use super::matched::Matched;
use super::value::{Entity, FollowerValue, MotionValue, Value};
use super::{Analyser, limits};

/// Pressure angle from which on a warning is given, unless MAXPA says otherwise, degrees.
const MAX_PRESSURE_ANGLE: f64 = 30.0;

impl Analyser<'_> {
    /// `F1 = FOLLOW/ …`.
    pub(super) fn follow(&mut self, m: &Matched) -> Option<Value> {
        let follower = FollowerValue {
            translating: m.word("movement") == Some("TRANSL"),
            roller: m.number("radius"),
            offset: m.number("offset").unwrap_or(0.0),
            arm: m.number("arm").unwrap_or(0.0),
            pivot: m.number("pivot").unwrap_or(0.0),
            left: m.word("side") == Some("LEFT"),
            span: m.word,
        };
        Some(Value::Entity(Entity::Follower(Rc::new(follower))))
    }

    /// `C1 = CAM/ …`.
    pub(super) fn cam(&mut self, m: &Matched, name: &str) -> Option<Value> {
        let (Some(Entity::Follower(f)), Some(Entity::Motion(motion))) =
            (m.entity("follower"), m.entity("motion"))
        else {
            return None;
        };
        let (f, motion) = (f.clone(), motion.clone());
        if self.program.cams.len() >= limits::CAMS {
            self.limit(format!("the program declares more than {} cams", limits::CAMS));
            return None;
        }
        let swing = !f.translating;
        self.lift_fits(m, &f, &motion)?;
        let built = self.build_motion(&motion, swing);
        let geometry = match built {
            // Warnings were given at the MOTION.
            Ok(geometry) => geometry,
            Err(issues) => return self.motion_issues(&motion, Err(issues), swing).and(None),
        };
        let definition = CamDefinition {
            base: m.number("base")?,
            follower: geometry_follower(&f),
            motion: geometry,
            rotation: if m.word("rotation") == Some("CCLW") {
                Rotation::CounterClockwise
            } else {
                Rotation::Clockwise
            },
            groove: m.word("groove").is_some(),
            speed: m.number("speed").map(|s| tidy(s * 60.0)),
            max_pressure_angle: Angle::degrees(m.number("maxpa").unwrap_or(MAX_PRESSURE_ANGLE)),
        };
        let cam = match Cam::new(definition) {
            Ok(cam) => cam,
            Err(issues) => {
                self.cam_issues(m, &f, &issues);
                return None;
            }
        };
        let issues = cam.issues().to_vec();
        self.cam_issues(m, &f, &issues);
        self.face_width(m, &cam);
        let origin = self.origin(self.here);
        let handle = self.program.cams.push(CamEntity { name: name.to_owned(), cam, origin });
        Some(Value::Entity(Entity::Cam(handle)))
    }

    fn lift_fits(&mut self, m: &Matched, f: &FollowerValue, motion: &MotionValue) -> Option<()> {
        let wanted = if f.translating { Dim::LENGTH } else { Dim::ANGLE };
        let dim = self.lift_dim(motion);
        if dim == Dim::NONE || dim == wanted {
            return Some(());
        }
        let message = if f.translating {
            "the lift of a translating follower is a length, and this motion lifts by an angle"
        } else {
            "the lift of an oscillating follower is an angle, and this motion lifts by a length"
        };
        self.report(
            Diagnostic::new(&codes::LIFT_DIMENSION, m.span("motion"), message)
                .label(motion.span, "the motion")
                .label(f.span, "the follower"),
        );
        None
    }

    fn face_width(&mut self, m: &Matched, cam: &Cam) {
        let (Some(width), Some(face)) = (m.number("width"), cam.figures().face) else { return };
        let needed = face.width();
        if width >= needed {
            return;
        }
        let message = format!(
            "the contact runs over {} of the face, from {} at cam angle {} to {} at {}, and the face is {} wide",
            self.show_length(needed),
            self.show_length(face.from.value),
            show_angle(face.from.at),
            self.show_length(face.to.value),
            show_angle(face.to.at),
            self.show_length(width)
        );
        self.report(
            Diagnostic::new(&codes::FACE_TOO_NARROW, m.span("width"), message)
                .help(format!("WIDTH must be {} at least", self.show_length(needed))),
        );
    }

    fn cam_issues(&mut self, m: &Matched, f: &FollowerValue, issues: &[CamIssue]) {
        for issue in issues {
            let place = match issue {
                CamIssue::GrooveNeedsRoller => m.span("groove"),
                CamIssue::OffsetTooLarge { .. } => m.span("follower"),
                CamIssue::SwingsTooFar { .. } => m.span("motion"),
                CamIssue::ArmDoesNotReach { .. }
                | CamIssue::Undercut { .. }
                | CamIssue::SelfIntersection { .. }
                | CamIssue::PressureAngle { .. } => m.span("base"),
                CamIssue::NotPositive { .. } | CamIssue::CutterTooLarge { .. } => m.word,
            };
            let problem = diag::cam::cam(issue, place, self.unit());
            let names_follower =
                !matches!(issue, CamIssue::PressureAngle { .. } | CamIssue::CutterTooLarge { .. });
            self.report(if names_follower { problem.label(f.span, "the follower") } else { problem });
        }
    }
}

fn geometry_follower(f: &FollowerValue) -> Follower {
    let side = if f.left { ArmSide::Left } else { ArmSide::Right };
    match (f.translating, f.roller) {
        (true, Some(radius)) => Follower::TranslatingRoller { radius, offset: f.offset },
        (true, None) => Follower::TranslatingFlat { offset: f.offset },
        (false, Some(radius)) => Follower::OscillatingRoller { radius, arm: f.arm, pivot: f.pivot, side },
        (false, None) => Follower::OscillatingFlat { pivot: f.pivot, offset: f.offset, side },
    }
}
