//! Arcs and helices of the CL data against the moves that stand for them.
//!
//! With (r, h, θ) cylindrical coordinates about the asked axis, the asked curve has r and h linear in θ. A move deviates by
//! at most the distance to the point of the curve at its own θ. Moves are sampled, and what lies between the samples is
//! bounded by the curvature that the move has in these coordinates.

use super::finding::{Finding, Text};
use super::{ACCURACY, Case, Happening};
use crate::cl::{Circle, RecordKind};
use crate::diag::codes::verification as codes;
use crate::geom::{Point3, Vec3};
use crate::math::{TAU, atan2, hypot};
use crate::readback::{EventKind, Tilted, TraceMove, TracePath};

/// Samples of a line; what lies between adds its sagitta over this squared.
const SAMPLES: u32 = 256;
/// Samples of a full turn of an arc.
const TURN_SAMPLES: f64 = 512.0;
/// Samples of an arc at most.
const MOST_SAMPLES: f64 = 100_000.0;
/// Angles below this, radians, from start to end mean a full turn.
const NO_ANGLE: f64 = 1e-9;

/// Checks every circle of the CL data.
pub(super) fn all(case: &Case<'_>) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut at: Option<Point3> = case.start;
    let mut depth = 0.0;
    for (index, record) in case.cl.records.iter().enumerate() {
        match &record.kind {
            RecordKind::Circle(circle) => {
                if let Some(from) = at {
                    findings.extend(one(case, from, circle, case.of_record(index), index));
                }
                at = Some(circle.to);
            }
            RecordKind::Spline(spline) => at = Some(spline.end()),
            RecordKind::From(p) | RecordKind::Rapid(p) | RecordKind::Linear(p) => at = Some(*p),
            RecordKind::BeginCycle(cycle) => depth = cycle.depth,
            RecordKind::Hole(p) => at = Some(Point3::new(p.x, p.y, p.z - depth)),
            RecordKind::Contour(_) => at = None,
            _ => {}
        }
    }
    findings
}

/// The asked curve: r and h linear in the angle.
struct Asked {
    centre: Point3,
    axis: Vec3,
    u: Vec3,
    v: Vec3,
    radius: (f64, f64),
    height: (f64, f64),
    sweep: f64,
}

impl Asked {
    fn new(from: Point3, circle: &Circle) -> Option<Self> {
        let (a, b) = (from - circle.centre, circle.to - circle.centre);
        let height = (a.dot(&circle.axis), b.dot(&circle.axis));
        let (ra, rb) = (a - circle.axis * height.0, b - circle.axis * height.1);
        let u = ra.try_normalize(1e-12)?;
        let v = circle.axis.cross(&u);
        let angle = atan2(rb.dot(&v), rb.dot(&u));
        let angle = if angle <= NO_ANGLE { angle + TAU } else { angle };
        let sweep = angle + TAU * f64::from(circle.turns);
        Some(Asked {
            centre: circle.centre,
            axis: circle.axis,
            u,
            v,
            radius: (ra.norm(), rb.norm()),
            height,
            sweep,
        })
    }

    /// Radius, height and angle of a point, the angle that is nearest to `about`.
    fn place(&self, p: Point3, about: f64) -> (f64, f64, f64) {
        let d = p - self.centre;
        let h = d.dot(&self.axis);
        let (x, y) = (d.dot(&self.u), d.dot(&self.v));
        let angle = atan2(y, x);
        let turns = ((about - angle) / TAU).round();
        (hypot(x, y), h, angle + TAU * turns)
    }

    /// Distance of a point to the curve's point at its angle.
    fn off(&self, (r, h, angle): (f64, f64, f64)) -> f64 {
        let x = angle / self.sweep;
        let (r0, r1) = self.radius;
        let (h0, h1) = self.height;
        hypot(r - (r0 + (r1 - r0) * x), h - (h0 + (h1 - h0) * x))
    }

    /// Bounds on how fast the curve moves and bends with the angle.
    fn bend(&self) -> f64 {
        let r = self.radius.0.max(self.radius.1);
        r + 2.0 * (self.radius.1 - self.radius.0).abs() / self.sweep
    }
}

fn one(
    case: &Case<'_>,
    from: Point3,
    circle: &Circle,
    happenings: &[Happening<'_>],
    record: usize,
) -> Vec<Finding> {
    let say =
        |line: u32, block: Option<usize>, text: Text| Finding::new(&codes::NOT_FOLLOWED, line, block, text);
    let Some(asked) = Asked::new(from, circle) else { return Vec::new() };
    let grid = &case.target.capabilities.grid;
    let rounding = 2.0 * grid.linear_step() + grid.centre_step();
    let allowed = circle.tolerance.max(rounding) + ACCURACY;
    let mut turned = 0.0;
    let mut worst: Option<(f64, &Happening<'_>)> = None;
    let mut findings = Vec::new();
    let mut any = false;
    for happening in happenings {
        let EventKind::Move(cut) = happening.kind else { continue };
        any = true;
        let (off, next) = measure(&asked, cut, turned);
        if next <= turned && cut.length() > rounding {
            let text = Text::default().words("a move that does not go on round the arc");
            findings.push(say(happening.line, happening.block, text));
        }
        turned = next;
        let off = off + cut.path_tolerance;
        if worst.is_none_or(|(w, _)| !(off <= w)) {
            worst = Some((off, happening));
        }
    }
    if !any {
        let text = Text::default().words("an arc that nothing is cut along");
        return vec![say(0, case.block_of_record(record), text)];
    }
    let radius = asked.radius.0.max(asked.radius.1);
    if let Some((off, happening)) = worst {
        if !((turned - asked.sweep).abs() * radius <= 2.0 * rounding) {
            let degrees = |a: f64| a / crate::math::DEG;
            let text =
                format!("an arc of {:.4} deg in place of {:.4} deg", degrees(turned), degrees(asked.sweep));
            findings.push(say(happening.line, happening.block, Text::default().words(text)));
        }
        if !(off <= allowed) {
            let text =
                Text::default().words("the path deviates ").length(off).words(" from an arc; it may by ");
            let text = text.length(circle.tolerance);
            findings.push(Finding::new(&codes::OUT_OF_TOLERANCE, happening.line, happening.block, text));
        }
    }
    findings
}

/// Upper bound of a move's deviation, and the angle at its end.
fn measure(asked: &Asked, cut: &TraceMove, turned: f64) -> (f64, f64) {
    match &cut.path {
        TracePath::Arc { centre, sweep, .. } => {
            let (from, to) = (cut.start(), cut.end());
            let centre = Point3::new(centre.x, centre.y, from.z);
            arc(asked, &Tilted { from, to, centre, axis: Vec3::z(), sweep: *sweep }, turned)
        }
        TracePath::Tilted(tilted) => arc(asked, tilted, turned),
        TracePath::Line { .. } => line(asked, cut, turned),
        TracePath::Spiral { .. } | TracePath::Nurbs { .. } | TracePath::Space(_) => (f64::INFINITY, turned),
    }
}

/// An arc's own radius and height are linear in its angle; as seen from the asked axis they swing by as much as the axes
/// are apart or tilted.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn arc(asked: &Asked, drawn: &Tilted, turned: f64) -> (f64, f64) {
    let apart = drawn.centre - asked.centre;
    let apart = (apart - asked.axis * apart.dot(&asked.axis)).norm();
    let tilt =
        drawn.axis.cross(&asked.axis).norm() * (drawn.radii().0.max(drawn.radii().1) + drawn.rise().abs());
    let samples = (drawn.sweep.abs() / TAU * TURN_SAMPLES).ceil().clamp(8.0, MOST_SAMPLES);
    let mut last = asked.place(drawn.from, turned);
    let mut off = asked.off(last);
    let way = drawn.sweep * drawn.axis.dot(&asked.axis).signum() / samples;
    for i in 1..=samples as u32 {
        last = asked.place(drawn.at(f64::from(i) / samples), last.2 + way);
        off = off.max(asked.off(last));
    }
    let step = drawn.sweep.abs() / samples;
    (off + 2.0 * (apart + tilt) * step * step / 8.0, last.2)
}

fn line(asked: &Asked, cut: &TraceMove, turned: f64) -> (f64, f64) {
    let (from, to) = (cut.start(), cut.end());
    let mut last = asked.place(from, turned);
    let first = last.2;
    let mut off = asked.off(last);
    for i in 1..=SAMPLES {
        let p = from + (to - from) * (f64::from(i) / f64::from(SAMPLES));
        last = asked.place(p, last.2);
        off = off.max(asked.off(last));
    }
    let step = (last.2 - first).abs() / f64::from(SAMPLES);
    (off + asked.bend() * step * step / 8.0, last.2)
}
