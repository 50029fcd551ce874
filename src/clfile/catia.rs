//! Arcs as CATIA writes them: `INDIRV` and `TLON,GOFWD`, and `HELICAL`.

use super::circle::SAME;
use super::grammar::{Arg, Statement};
use super::reader::Reader;
use crate::diag::codes::foreign as codes;
use crate::geom::{Point3, Vec3};
use crate::math::{TAU, atan2};

/// How far a check line may miss its circle, as a share of the radius.
const MISS: f64 = 1e-4;
/// Full turns of one helix at most.
const MOST_TURNS: f64 = 10_000.0;

impl Reader<'_> {
    pub(super) fn catia(&mut self, s: &Statement) {
        match s.major() {
            "INDIRV" => self.state.direction = vector(&s.numbers()),
            "PSIS" => {
                let flat = flatten(s);
                self.state.part_normal = flat.get(flat.len().saturating_sub(3)..).and_then(vector);
            }
            "HELICAL" => self.helical(s),
            _ => self.follow(s),
        }
    }

    /// `TLON,GOFWD/ (CIRCLE/ …), ON, [n, INTOF,] (LINE/ …)`.
    fn follow(&mut self, s: &Statement) {
        let mut nested = s.nested();
        let (Some(drive), Some(check)) = (nested.next(), nested.next()) else {
            let message = "TLON,GOFWD takes a circle and what it ends on";
            return self.complain(&codes::BAD_RECORD, message.to_owned());
        };
        let order = s.numbers().first().copied().unwrap_or(1.0);
        let arc = self.drive(drive).and_then(|d| self.end_on(&d, check, order).map(|to| (d, to)));
        match arc {
            Ok((drive, to)) => self.known_arc(drive.centre, drive.axis, drive.radius, 0, to),
            Err(message) => self.complain(&codes::BAD_RECORD, message),
        }
    }

    fn drive(&self, s: &Statement) -> Result<Drive, String> {
        let numbers = flatten(s);
        let normal = self.state.part_normal.unwrap_or_else(Vec3::z);
        let (centre, axis, radius) = match (s.major(), numbers.as_slice()) {
            ("CIRCLE", [x, y, z, r]) => ([*x, *y, *z], normal, *r),
            ("CIRCLE" | "CYLNDR", [x, y, z, i, j, k, r]) => ([*x, *y, *z], Vec3::new(*i, *j, *k), *r),
            (word, _) => {
                return Err(format!("the tool cannot follow a {word} with {} numbers", numbers.len()));
            }
        };
        let scale = self.state.scale;
        let centre = Point3::from(centre.map(|v| v * scale));
        let start = self.state.at.ok_or("an arc from nowhere: no point stands before it")?;
        let direction = self.state.direction.ok_or("an arc without INDIRV: its sense is not known")?;
        let length = axis.norm();
        if length.is_nan() || length <= 0.0 {
            return Err("the circle's axis has no length".to_owned());
        }
        let axis = axis / length;
        let forward = axis.cross(&(start - centre)).dot(&direction);
        let axis = if forward < 0.0 { -axis } else { axis };
        Ok(Drive { centre, axis, radius: radius.abs() * scale, start })
    }

    /// Where the circle meets the line (or the plane through two points) for the n-th time.
    fn end_on(&self, drive: &Drive, check: &Statement, order: f64) -> Result<Point3, String> {
        let numbers = flatten(check);
        let [.., x, y, z, u, v, w] = *numbers.as_slice() else {
            return Err("the arc's end is no line through two points".to_owned());
        };
        let scale = self.state.scale;
        let flat = |p: [f64; 3]| {
            let d = Point3::from(p.map(|c| c * scale)) - drive.centre;
            d - drive.axis * d.dot(&drive.axis)
        };
        let (p, q) = (flat([x, y, z]), flat([u, v, w]));
        let d = q - p;
        let length = d.norm();
        if length.is_nan() || length <= 0.0 {
            return Err("the line on which the arc ends has no length".to_owned());
        }
        let d = d / length;
        let along = -p.dot(&d);
        let foot = p + d * along;
        let room = drive.radius * drive.radius - foot.norm_squared();
        if room < -MISS * drive.radius * drive.radius {
            return Err("the line on which the arc ends does not meet the circle".to_owned());
        }
        let half = room.max(0.0).sqrt();
        let from = drive.start - drive.centre;
        let height = drive.axis * from.dot(&drive.axis);
        let mut ends = [foot + d * half, foot - d * half].map(|e| {
            let turn = atan2(drive.axis.dot(&from.cross(&e)), (from - height).dot(&e));
            (if turn <= no_angle(drive.radius) { turn + TAU } else { turn }, e)
        });
        ends.sort_by(|a, b| a.0.total_cmp(&b.0));
        let chosen = if order >= 2.0 { ends[1] } else { ends[0] };
        Ok(drive.centre + chosen.1 + height)
    }

    /// `HELICAL/ centre, tangent, axis, pitch, radius[, angle, height, turns], end`.
    fn helical(&mut self, s: &Statement) {
        let numbers = s.numbers();
        let [cx, cy, cz, tx, ty, tz, ax, ay, az, pitch, radius, rest @ ..] = numbers.as_slice() else {
            let message = format!("HELICAL takes 14 or 17 numbers, not {}", numbers.len());
            return self.complain(&codes::BAD_RECORD, message);
        };
        let (Some(start), [.., x, y, z]) = (self.state.at, rest) else {
            let message = "a helix needs a point before it and an end";
            return self.complain(&codes::BAD_RECORD, message.to_owned());
        };
        let (Some(centre), Some(end)) = (self.point([*cx, *cy, *cz]), self.point([*x, *y, *z])) else {
            return;
        };
        let (Some(axis), tangent) = (vector(&[*ax, *ay, *az]), Vec3::new(*tx, *ty, *tz)) else {
            return self.complain(&codes::BAD_RECORD, "the helix's axis has no length".to_owned());
        };
        let axis = if axis.cross(&(start - centre)).dot(&tangent) < 0.0 { -axis } else { axis };
        let rise = (end - start).dot(&axis).abs();
        let pitch = pitch.abs() * self.state.scale;
        let (u, v) = (start - centre, end - centre);
        let turn = atan2(axis.dot(&u.cross(&v)), u.dot(&v) - u.dot(&axis) * v.dot(&axis));
        let sweep = if turn <= no_angle(radius.abs() * self.state.scale) { turn + TAU } else { turn };
        let turns = if pitch > 0.0 { rise / pitch - sweep / TAU } else { 0.0 };
        let turns = turns.round().clamp(0.0, MOST_TURNS) as u32;
        self.known_arc(centre, axis, radius.abs() * self.state.scale, turns, end);
    }
}

/// A circle that the tool follows from where it is, in mm; its axis gives the sense.
struct Drive {
    centre: Point3,
    axis: Vec3,
    radius: f64,
    start: Point3,
}

/// Angles up to this, radians, are none: the start of an arc is not its own end.
fn no_angle(radius: f64) -> f64 {
    SAME / radius.max(SAME)
}

fn vector(numbers: &[f64]) -> Option<Vec3> {
    let [i, j, k] = *numbers else { return None };
    let v = Vec3::new(i, j, k);
    let length = v.norm();
    (length > 0.0 && length.is_finite()).then(|| v / length)
}

/// All numbers of a definition, those of definitions within it at their place.
fn flatten(s: &Statement) -> Vec<f64> {
    s.args
        .iter()
        .flat_map(|a| match a {
            Arg::Number(v) => vec![*v],
            Arg::Nested(inner) => flatten(inner),
            Arg::Word(_) | Arg::Empty => Vec::new(),
        })
        .collect()
}
