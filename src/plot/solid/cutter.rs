//! Outlines of cutters.

use crate::ir::{CutterKind, Tool};
use crate::math;
use crate::units::LengthUnit;

/// Half the outline of a cutter as (radius, height above the tip), mm, from the tip up.
pub(in crate::plot) fn outline(tool: &Tool) -> Vec<(f64, f64)> {
    let radius = 0.5 * tool.diameter;
    let length = tool.stick_out.or(tool.length).unwrap_or(4.0 * tool.diameter).max(1.5 * tool.diameter);
    let corner = match tool.kind {
        CutterKind::Ball => radius,
        CutterKind::Flat | CutterKind::Drill => 0.0,
        CutterKind::Bull | CutterKind::Taper => tool.corner.min(radius),
    };
    let mut points = vec![(0.0, 0.0)];
    if tool.kind == CutterKind::Drill {
        // A point angle of 118 degrees.
        points.push((radius, radius * math::tan(31.0 * math::DEG)));
    } else {
        points.extend(rounded(radius, corner));
    }
    let widens =
        if tool.kind == CutterKind::Taper { math::tan(tool.profile[3].clamp(0.0, 1.4)) } else { 0.0 };
    points.push((radius + widens * (length - corner), length));
    points.push((0.0, length));
    points
}

/// A quarter circle from the bottom to the side.
fn rounded(radius: f64, corner: f64) -> Vec<(f64, f64)> {
    const CHORDS: u32 = 16;
    if corner <= 0.0 {
        return vec![(radius, 0.0)];
    }
    let at = |k: u32| {
        let (s, c) = math::sin_cos(f64::from(k) / f64::from(CHORDS) * 0.5 * math::PI);
        (radius - corner + corner * s, corner * (1.0 - c))
    };
    (0..=CHORDS).map(at).collect()
}

/// Kind and diameter of a cutter, for people.
pub(in crate::plot) fn words(tool: &Tool, units: LengthUnit) -> String {
    let kind = match tool.kind {
        CutterKind::Flat => "flat-end",
        CutterKind::Ball => "ball-end",
        CutterKind::Bull => "bull-nose",
        CutterKind::Taper => "tapered",
        CutterKind::Drill => "drill",
    };
    let size = crate::plot::canvas::decimal(tool.diameter / units.in_mm(), 4);
    format!("{} {kind} Ø{size}", tool.name)
}
