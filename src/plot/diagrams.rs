//! Motion, pressure angle and curvature over the cam angle.

use super::canvas::{Anchor, Canvas, Pen, Pixel, label};
use super::chart::{Chart, Scale};
use super::theme;
use crate::geom::cam::{Cam, Dynamics, Extreme, Flank};
use crate::geom::curve::Frenet;
use crate::geom::motion::Lift;
use crate::math::{DEG, TAU};
use crate::units::LengthUnit;

/// One quantity over the cam angle.
struct Quantity {
    name: String,
    figure: String,
    color: &'static str,
    /// Runs of (degrees, value) between which it may jump.
    runs: Vec<Vec<(f64, f64)>>,
    /// A limit on both sides of zero, and its name.
    limit: Option<(f64, String)>,
}

/// Six diagrams, one under the other.
pub(super) fn draw(canvas: &mut Canvas, cam: &Cam, units: LengthUnit, at: Pixel, size: Pixel) {
    const GAP: f64 = 38.0;
    let quantities = quantities(cam, units);
    let height = (size.1 + GAP) / quantities.len() as f64 - GAP;
    for (i, quantity) in quantities.iter().enumerate() {
        let top = at.1 + i as f64 * (height + GAP);
        let last = i + 1 == quantities.len();
        diagram(canvas, cam, quantity, (at.0, top), (size.0, height), last);
    }
    let below = (at.0 + size.0 / 2.0, at.1 + size.1 + 38.0);
    canvas.text(below, "cam angle, deg", theme::text(13.0, theme::MUTED, Anchor::Middle));
}

fn diagram(canvas: &mut Canvas, cam: &Cam, quantity: &Quantity, at: Pixel, size: Pixel, x_labels: bool) {
    let values = || quantity.runs.iter().flatten().map(|p| p.1);
    let (low, high) = values().fold((0.0_f64, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
    let limits = quantity.limit.as_ref().map(|l| l.0 * 1.15);
    // A limit far above the values would flatten the curve: it is left out then.
    let shown = limits.filter(|l| *l < 4.0 * low.abs().max(high));
    let (low, high) = (low.min(-shown.unwrap_or(0.0)), high.max(shown.unwrap_or(0.0)));
    // Room above and below, so that no curve runs on the frame; rounding of 0 needs none.
    let room = 0.06 * (high - low);
    let (low, high) =
        (if low < -room { low - room } else { 0.0 }, if high > room { high + room } else { 0.0 });
    let chart = Chart { at, size, x: Scale::fixed(0.0, 360.0, 30.0), y: Scale::between(low, high) };
    chart.axes(canvas, x_labels);
    dwells(canvas, cam, &chart);
    if let Some((limit, name)) = &quantity.limit {
        limit_lines(canvas, &chart, *limit, name);
    }
    for run in &quantity.runs {
        chart.curve(canvas, run, Pen::solid(quantity.color, 2.0));
    }
    chart.caption(canvas, &quantity.name, &quantity.figure, quantity.color);
}

fn limit_lines(canvas: &mut Canvas, chart: &Chart, limit: f64, name: &str) {
    const PEN: Pen = Pen::dashed(theme::LIMIT, 1.2, "7 4");
    for value in [limit, -limit] {
        if chart.y.low <= value && value <= chart.y.high {
            chart.horizontal(canvas, value, PEN);
        }
    }
    if limit <= chart.y.high {
        let p = chart.point(chart.x.high, limit);
        canvas.text((p.0 - 5.0, p.1 - 4.0), name, theme::text(11.0, theme::LIMIT, Anchor::End));
    }
}

/// Where the follower rests.
fn dwells(canvas: &mut Canvas, cam: &Cam, chart: &Chart) {
    let motion = &cam.definition().motion;
    for (span, w) in motion.breaks().windows(2).enumerate() {
        if motion.is_dwell(span) {
            chart.shade_x(canvas, w[0] / DEG, w[1] / DEG, "#5f6f7e14");
        }
    }
}

fn quantities(cam: &Cam, units: LengthUnit) -> Vec<Quantity> {
    let f = cam.figures();
    let lift = LiftUnits::of(cam, units);
    let mm = units.in_mm();
    let motion = |name: &str, order: usize, peak: Extreme, color, pick: fn(Lift) -> f64| Quantity {
        name: format!("{name}, {}", lift.symbol(order)),
        figure: lift.figure(order, peak, f.dynamics),
        color,
        runs: runs(cam, |l, _| lift.scale(order) * pick(l)),
        limit: None,
    };
    let limit = cam.definition().max_pressure_angle.deg();
    vec![
        motion("lift s", 0, f.lift, "#0b4a8f", |l| l.s),
        motion("velocity v", 1, f.velocity, "#0e7490", |l| l.v),
        motion("acceleration a", 2, f.acceleration, "#a3460a", |l| l.a),
        motion("jerk j", 3, f.jerk, "#7b3fa0", |l| l.j),
        Quantity {
            name: "pressure angle, deg".into(),
            figure: at_angle("max", f.pressure_angle.value / DEG, 2, "°", f.pressure_angle),
            color: "#b02a4c",
            runs: pressure_runs(cam),
            limit: Some((limit, format!("limit {}°", super::canvas::decimal(limit, 2)))),
        },
        Quantity {
            name: format!("curvature of the profile, 1/{}", units.symbol()),
            figure: radius_figure(cam, units),
            color: "#2f7d32",
            runs: runs(cam, |_, k| k.k * mm),
            limit: None,
        },
    ]
}

/// The smallest radii of the profile.
fn radius_figure(cam: &Cam, units: LengthUnit) -> String {
    let f = &cam.figures().inner;
    let one = |what: &str, e: Extreme| {
        let unit = format!(" {}", units.symbol());
        at_angle(what, e.value / units.in_mm(), 3, &unit, e)
    };
    let convex = f.convex.map(|e| one("smallest radius", e));
    let concave = f.concave.map(|e| one("concave", e));
    [convex, concave].into_iter().flatten().collect::<Vec<_>>().join(" · ")
}

fn at_angle(what: &str, value: f64, decimals: usize, unit: &str, e: Extreme) -> String {
    format!("{what} {}{unit} at {}°", label(value, decimals), label(e.at.deg(), 1))
}

/// Units of a lift and its derivatives.
struct LiftUnits {
    angular: bool,
    unit: LengthUnit,
}

impl LiftUnits {
    fn of(cam: &Cam, unit: LengthUnit) -> LiftUnits {
        LiftUnits { angular: cam.definition().follower.oscillates(), unit }
    }
    /// Shown units per mm or radian.
    fn scale(&self, order: usize) -> f64 {
        match (self.angular, order) {
            (true, 0) => 1.0 / DEG,
            (true, _) => 1.0,
            (false, _) => 1.0 / self.unit.in_mm(),
        }
    }
    fn symbol(&self, order: usize) -> String {
        let mm = self.unit.symbol();
        match (self.angular, order) {
            (true, 0) => "deg".into(),
            (true, 1) => "rad/rad".into(),
            (true, 2) => "rad/rad²".into(),
            (true, _) => "rad/rad³".into(),
            (false, 0) => mm.into(),
            (false, 1) => format!("{mm}/rad"),
            (false, 2) => format!("{mm}/rad²"),
            (false, _) => format!("{mm}/rad³"),
        }
    }
    fn figure(&self, order: usize, peak: Extreme, dynamics: Option<Dynamics>) -> String {
        let decimals = if self.angular || self.unit == LengthUnit::Inch { 4 } else { 3 };
        let value = label(peak.value * self.scale(order), decimals);
        let physical =
            dynamics.and_then(|d| self.physical(order, d)).map_or(String::new(), |p| format!(" = {p}"));
        format!("max {value}{physical} at {}°", label(peak.at.deg(), 1))
    }
    fn physical(&self, order: usize, d: Dynamics) -> Option<String> {
        match (self.angular, order) {
            (false, 1) => Some(format!("{} mm/s", label(d.velocity, 1))),
            (false, 2) => Some(format!("{} m/s²", label(d.acceleration, 2))),
            (false, 3) => Some(format!("{} m/s³", label(d.jerk, 0))),
            (true, 1) => Some(format!("{} rad/s", label(d.velocity, 3))),
            (true, 2) => Some(format!("{} rad/s²", label(d.acceleration, 1))),
            (true, 3) => Some(format!("{} rad/s³", label(d.jerk, 0))),
            _ => None,
        }
    }
}

/// Cam angles of a span, in steps of about a degree.
fn angles(a: f64, b: f64) -> impl Iterator<Item = f64> {
    const STEP: f64 = TAU / 360.0;
    let steps = ((b - a) / STEP).ceil().clamp(6.0, 400.0) as usize;
    (0..=steps).map(move |i| a + (b - a) * i as f64 / steps as f64)
}

/// A function of lift and profile, span by span.
fn runs(cam: &Cam, f: impl Fn(Lift, Frenet) -> f64) -> Vec<Vec<(f64, f64)>> {
    let motion = &cam.definition().motion;
    let flank = cam.flank(Flank::Inner);
    let count = motion.breaks().len() - 1;
    let mirrored = cam.parameter(crate::units::Angle::radians(0.0)) != 0.0;
    let value = |span: usize, theta: f64| {
        let (own, u) = if mirrored { (count - 1 - span, TAU - theta) } else { (span, theta) };
        f(motion.at_in(span, theta), flank.at_in(own, u))
    };
    let run = |(span, w): (usize, &[f64])| angles(w[0], w[1]).map(|t| (t / DEG, value(span, t))).collect();
    motion.breaks().windows(2).enumerate().map(run).collect()
}

fn pressure_runs(cam: &Cam) -> Vec<Vec<(f64, f64)>> {
    let motion = &cam.definition().motion;
    let run = |(span, w): (usize, &[f64])| {
        angles(w[0], w[1]).map(|t| (t / DEG, cam.pressure_angle_of(motion.at_in(span, t)).deg())).collect()
    };
    motion.breaks().windows(2).enumerate().map(run).collect()
}
