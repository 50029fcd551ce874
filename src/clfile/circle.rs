//! Arcs: a `CIRCLE` (ISO 4343: `MOVARC`) record and the points after it.
//!
//! A record is trusted as far as its points lie on it. What lies on it within [`TRUST`] is an arc. Where start and end are
//! at different distances from the centre by no more than [`SPIRAL`], the tool goes from one to the other about the centre,
//! with a warning; beyond that the record and its points contradict each other, which is an error.

use super::grammar::Statement;
use super::producer::Producer;
use super::reader::Reader;
use crate::cl::{Circle, RecordKind};
use crate::diag::codes::foreign as codes;
use crate::geom::{Point3, Vec3};
use crate::math::{TAU, atan2};

/// Distance of a point from its circle that is rounding, mm.
const TRUST: f64 = 0.005;
/// Distance that is bridged by a spiral, mm; or [`SPIRAL_SHARE`] of the radius if that is more.
const SPIRAL: f64 = 0.1;
/// See [`SPIRAL`].
const SPIRAL_SHARE: f64 = 0.02;
/// Angle of an arc that is rounding, radians; or that of [`TRUST`] if that is more.
const ANGLE_ROUNDING: f64 = 0.002;
/// Distance in the circle's plane below which an arc's end is its start, mm: no arc is as short, a full circle is meant.
pub(super) const SAME: f64 = 5e-4;
/// Full turns of one record at most.
const MOST_TURNS: f64 = 10_000.0;

/// A circle that waits for its points.
#[derive(Debug, Clone)]
pub(super) struct Pending {
    centre: Point3,
    axis: Vec3,
    radius: Option<f64>,
    turns: u32,
    /// Degrees that it turns, where the record says so.
    angle: Option<f64>,
    /// Points so far, where there may be many.
    points: Vec<Point3>,
}

impl Pending {
    /// Distances of a point from the axis and along it.
    fn place(&self, p: Point3) -> (f64, f64) {
        let v = p - self.centre;
        let h = v.dot(&self.axis);
        ((v - self.axis * h).norm(), h)
    }

    /// Angle from `a` to `b` by the right-hand rule, 0..2π.
    fn angle(&self, a: Point3, b: Point3) -> f64 {
        let (u, v) = (a - self.centre, b - self.centre);
        let turn = atan2(self.axis.dot(&u.cross(&v)), {
            let (hu, hv) = (u.dot(&self.axis), v.dot(&self.axis));
            u.dot(&v) - hu * hv
        });
        if turn < 0.0 { turn + TAU } else { turn }
    }
}

/// Turns that an arc of so many degrees begins.
fn turns_of(angle: f64) -> f64 {
    const ROUNDING: f64 = 1e-3;
    ((angle.abs() - ROUNDING) / 360.0).floor().max(0.0) + 1.0
}

impl Reader<'_> {
    /// `CIRCLE/ x, y, z, i, j, k[, r[, …]][, TIMES, n]`, or `MOVARC/ x, y, z, i, j, k, r, ANGLE, degrees`.
    pub(super) fn circle(&mut self, s: &Statement) {
        let numbers = s.numbers();
        let [x, y, z, i, j, k, rest @ ..] = numbers.as_slice() else {
            let word = s.major();
            let message = format!("{word} takes centre, axis and radius, and has {} numbers", numbers.len());
            return self.complain(&codes::BAD_RECORD, message);
        };
        let Some(centre) = self.point([*x, *y, *z]) else { return };
        let axis = Vec3::new(*i, *j, *k);
        let length = axis.norm();
        if !(length > 0.0 && length.is_finite()) {
            return self.complain(&codes::BAD_RECORD, "the circle's axis has no length".to_owned());
        }
        let angle = s.after("ANGLE").or_else(|| self.angle_of_autodesk(rest));
        let times = s.after("TIMES").or_else(|| angle.map(turns_of)).unwrap_or(1.0);
        if !(1.0..=MOST_TURNS).contains(&times) || times.fract() != 0.0 {
            let word = s.major();
            let message = format!("{word} with {times} turns: a whole number of 1 to {MOST_TURNS}");
            return self.complain(&codes::BAD_RECORD, message);
        }
        let radius = rest.first().filter(|_| !s.has("TIMES") || rest.len() > 1);
        self.state.circle = Some(Pending {
            centre,
            axis: axis / length,
            radius: radius.map(|r| r.abs() * self.state.scale).filter(|r| *r > 0.0),
            turns: (times - 1.0) as u32,
            angle,
            points: Vec::new(),
        });
    }

    /// `CIRCLE/ x, y, z, i, j, k, r, degrees, 0, 0, 0`, as the posts of Autodesk for CAMplete write it.
    fn angle_of_autodesk(&self, rest: &[f64]) -> Option<f64> {
        match rest {
            [_, angle, 0.0, 0.0, 0.0] if self.producer == Producer::Plain && *angle > 0.0 => Some(*angle),
            _ => None,
        }
    }

    /// Some posts give the axis of the plane whatever the sense of the arc: where the angle that the record says is that of
    /// the arc about the other axis, this is meant, and so it is for arcs of the same file whose angle cannot tell.
    fn turn_by_angle(&mut self, pending: &mut Pending, start: Point3, to: Point3) {
        let Some(said) = pending.angle else { return };
        if said < 0.0 {
            pending.axis = -pending.axis;
            return;
        }
        let about = pending.angle(start, to);
        let room = (4.0 * TRUST / pending.place(start).0.max(TRUST)).clamp(ANGLE_ROUNDING, TAU / 8.0);
        let off = |turn: f64| {
            let rest = (said.to_radians() - turn).rem_euclid(TAU);
            rest.min(TAU - rest)
        };
        let (along, against) = (off(about) <= room, off(-about) <= room);
        if along == against {
            if along && self.state.axes_of_planes {
                pending.axis = -pending.axis;
            } else if !along {
                let message = format!(
                    "the arc turns by {:.2} degrees about its axis from its start to its end, and the record says {said}: \
                     its points and its axis are trusted",
                    about.to_degrees()
                );
                self.complain(&codes::ARC_NOT_TRUSTED, message);
            }
            return;
        }
        self.state.axes_of_planes = against;
        if against {
            let message = format!(
                "the arc turns by {said} degrees as its record says, which is against its axis: it is taken to be clockwise \
                 about it"
            );
            self.complain(&codes::ARC_NOT_TRUSTED, message);
            pending.axis = -pending.axis;
        }
    }

    /// A point after a circle.
    pub(super) fn on_circle(&mut self, to: Point3) {
        if !self.producer.many_points() {
            if let Some(mut pending) = self.state.circle.take() {
                if let Some(start) = self.state.at {
                    self.turn_by_angle(&mut pending, start, to);
                }
                self.arc_to(&pending, to);
            }
            return;
        }
        let Some(pending) = &self.state.circle else { return };
        let (Some(start), radius) = (self.state.at, pending.radius) else {
            self.state.circle = None;
            return self.move_to(to);
        };
        let (r, h) = pending.place(to);
        let (r0, h0) = pending.place(start);
        let wanted = radius.unwrap_or(r0);
        let on = (r - wanted).abs() <= TRUST && (h - h0).abs() <= TRUST;
        if on && (r0 - wanted).abs() <= TRUST {
            if let Some(pending) = &mut self.state.circle {
                pending.points.push(to);
            }
            return;
        }
        let first = self.state.circle.as_ref().is_some_and(|c| c.points.is_empty());
        self.flush_circle();
        self.state.circle = None;
        if first {
            let off = (r - wanted).abs().max((r0 - wanted).abs()).max((h - h0).abs());
            let off = self.show(off);
            let message = format!("the points after this circle are {off} off it: they are joined by lines");
            self.complain(&codes::ARC_NOT_TRUSTED, message);
        }
        self.move_to(to);
    }

    /// The arc over the points gathered; a circle without points is none.
    pub(super) fn end_circle(&mut self) {
        self.flush_circle();
        if self.state.circle.take().is_some() {
            let message = "a CIRCLE without a point after it: where its arc ends is not known";
            self.complain(&codes::BAD_RECORD, message.to_owned());
        }
    }

    /// The arc over the points gathered; a circle without points waits on.
    pub(super) fn flush_circle(&mut self) {
        if self.state.circle.as_ref().is_none_or(|pending| pending.points.is_empty()) {
            return;
        }
        let Some(mut pending) = self.state.circle.take() else { return };
        let (Some(start), Some(&first), Some(&last)) =
            (self.state.at, pending.points.first(), pending.points.last())
        else {
            return;
        };
        // The points tell the sense: each step is less than half a turn.
        if pending.points.len() > 1 && pending.angle(start, first) > TAU / 2.0 {
            pending.axis = -pending.axis;
        }
        let mut turned = 0.0;
        let mut from = start;
        for &point in &pending.points {
            turned += pending.angle(from, point);
            from = point;
        }
        let rounding = 2.0 * TRUST / pending.place(start).0.max(TRUST);
        if (turned - TAU).abs() <= rounding {
            // The last point is the first one, as far as it is printed: a full circle, not next to nothing.
            return self.emit_arc(&pending, start);
        }
        if turned > TAU {
            let message = "the points after this circle go round more than once: they are joined by lines";
            self.complain(&codes::ARC_NOT_TRUSTED, message.to_owned());
            let points = core::mem::take(&mut pending.points);
            return points.into_iter().for_each(|p| self.move_to(p));
        }
        self.emit_arc(&pending, last);
    }

    /// An arc to its only point.
    fn arc_to(&mut self, pending: &Pending, to: Point3) {
        let Some(start) = self.state.at else {
            let message = "an arc from nowhere: no point stands before it";
            self.complain(&codes::BAD_RECORD, message.to_owned());
            self.state.at = Some(to);
            return;
        };
        // Even where its end is printed as its start.
        let short = pending.angle.is_some_and(|angle| angle.abs() < 180.0);
        if short && (to - start).norm() <= TRUST {
            return self.cut_to(to);
        }
        let (r0, _) = pending.place(start);
        let (r1, _) = pending.place(to);
        let radius = pending.radius.unwrap_or(r0);
        let off = (r0 - radius).abs().max((r1 - radius).abs());
        if off > TRUST {
            let places = format!(
                "start and end of the arc are {} and {} from its centre, and its radius is {}",
                self.show(r0),
                self.show(r1),
                self.show(radius)
            );
            if off > SPIRAL.max(SPIRAL_SHARE * radius) || r0 == 0.0 || r1 == 0.0 {
                self.soften(&codes::ARC_OFF, places, None);
                if self.lenient() {
                    self.cut_to(to);
                }
                self.state.at = Some(to);
                return;
            }
            self.complain(&codes::ARC_NOT_TRUSTED, format!("{places}: the radius changes along it"));
        }
        self.emit_arc(pending, to);
    }

    /// An arc that is known to be one, at feed.
    fn emit_arc(&mut self, pending: &Pending, to: Point3) {
        self.state.rapid = false;
        if self.curve_in_cycle("an arc", to) {
            return;
        }
        self.make_sure();
        self.state.moved = true;
        let axis = pending.axis;
        let to = self.state.at.map_or(to, |start| {
            let rise = axis * (to - start).dot(&axis);
            match (to - start - rise).norm() <= SAME {
                true if rise.norm() <= SAME => start,
                true => start + rise,
                false => to,
            }
        });
        if self.ready() {
            let Pending { centre, turns, .. } = *pending;
            let tolerance = self.state.tolerance();
            self.emit(RecordKind::Circle(Box::new(Circle { to, centre, axis, turns, tolerance })));
        }
        self.state.at = Some(to);
    }

    /// An arc whose circle, sense and end are known.
    pub(super) fn known_arc(&mut self, centre: Point3, axis: Vec3, radius: f64, turns: u32, to: Point3) {
        let pending = Pending { centre, axis, radius: Some(radius), turns, angle: None, points: Vec::new() };
        self.arc_to(&pending, to);
    }

    /// A length in the file's unit.
    pub(super) fn show(&self, mm: f64) -> String {
        let unit = self.units();
        format!("{:.4} {}", mm / unit.in_mm(), unit.symbol())
    }
}
