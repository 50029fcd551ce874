//! Arcs, circles and helices, and curves.

use super::super::judge::Finding;
use super::super::sheet::Sheet;
use super::super::trial::Trial;
use super::{Try, number, row};
use crate::ir::Interpolation;
use crate::math::{PI, TAU};
use crate::readback::TracePath;

pub(in super::super) const FULL: Try = row(
    "arcs",
    "full circle",
    || down(10.0, 0.0).circle([10.0, 0.0, -1.0], [0.0, 0.0, -1.0], UP, 0),
    |t| sweep(t, TAU),
);
pub(in super::super) const SEMICIRCLE: Try = row(
    "arcs",
    "semicircle, clockwise",
    || down(10.0, 0.0).circle([-10.0, 0.0, -1.0], [0.0, 0.0, -1.0], DOWN, 0),
    |t| sweep(t, -PI),
);
pub(in super::super) const LARGE: Try = row(
    "arcs",
    "arc of 270 degrees",
    || down(10.0, 0.0).circle([0.0, -10.0, -1.0], [0.0, 0.0, -1.0], UP, 0),
    |t| sweep(t, 1.5 * PI),
);
pub(in super::super) const QUARTER: Try = row(
    "arcs",
    "quarter circle that ends level with its centre",
    || down(10.0, 0.0).circle([0.0, 10.0, -1.0], [0.0, 0.0, -1.0], UP, 0),
    |t| sweep(t, 0.5 * PI),
);
pub(in super::super) const TINY: Try = row(
    "arcs",
    "arc of 0.004 mm radius",
    || down(0.004, 0.0).circle([0.0, 0.004, -1.0], [0.0, 0.0, -1.0], UP, 0),
    tiny,
);
pub(in super::super) const SHALLOW: Try = row(
    "arcs",
    "arc of 2000 mm radius over 1 mm",
    || {
        let angle = 1.0 / 2000.0;
        let (s, c) = crate::math::sin_cos(angle);
        let to = [2000.0 * s, 2000.0 - 2000.0 * c, -1.0];
        down(0.0, 0.0).circle(to, [0.0, 2000.0, -1.0], UP, 0)
    },
    shallow,
);
pub(in super::super) const HELIX: Try = row(
    "arcs",
    "helix of half a turn",
    || down(10.0, 0.0).circle([-10.0, 0.0, -3.0], [0.0, 0.0, -1.0], UP, 0),
    |t| sweep(t, PI),
);
pub(in super::super) const HELIX_TURNS: Try = row(
    "arcs",
    "helix of two and a half turns",
    || down(10.0, 0.0).circle([-10.0, 0.0, -6.0], [0.0, 0.0, -1.0], UP, 2),
    |t| sweep(t, 5.0 * PI),
);
pub(in super::super) const ZX: Try = row(
    "arcs",
    "arc in the ZX plane",
    || down(10.0, 0.0).circle([-10.0, 0.0, -1.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0], 0),
    |t| sweep(t, PI),
);
pub(in super::super) const YZ: Try = row(
    "arcs",
    "arc in the YZ plane",
    || down(0.0, 10.0).circle([0.0, -10.0, -1.0], [0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], 0),
    |t| sweep(t, -PI),
);
pub(in super::super) const CURVE: Try =
    row("curves", "NURBS round a part", || Sheet::mm().contour(Interpolation::Nurbs, &[-1.0]), curve);

const UP: [f64; 3] = [0.0, 0.0, 1.0];
const DOWN: [f64; 3] = [0.0, 0.0, -1.0];

/// The cutter at the start of an arc.
fn down(x: f64, y: f64) -> Sheet {
    Sheet::mm().rapid(x, y, super::super::sheet::CLEAR).line(x, y, -1.0).watch()
}

/// Sweeps of the arcs, radians, counter-clockwise against the plane's axis positive.
fn sweeps(trial: &Trial) -> Vec<f64> {
    let of = |path: &TracePath| match path {
        TracePath::Arc { sweep, .. } => Some(*sweep),
        TracePath::Tilted(arc) => Some(arc.sweep),
        _ => None,
    };
    trial.cuts().filter_map(|m| of(&m.path)).collect()
}

/// The arcs turn this far together; the proof has compared where they go.
fn sweep(trial: &Trial, wanted: f64) -> Finding {
    let sweeps = sweeps(trial);
    if sweeps.is_empty() {
        return Finding::expressed(format!("{} lines", trial.cuts().count()));
    }
    let total: f64 = sweeps.iter().sum();
    if (total.abs() - wanted.abs()).abs() > 0.001 {
        let degrees = |radians: f64| number(radians.to_degrees());
        return Finding::wrong(format!("turns {} degrees instead of {}", degrees(total), degrees(wanted)));
    }
    match sweeps.len() {
        1 => Finding::right(format!("one block; {}", radii(trial))),
        n => Finding::expressed(format!("{n} blocks; {}", radii(trial))),
    }
}

/// How far the radii at both ends of an arc are apart in printed numbers.
fn radii(trial: &Trial) -> String {
    let of = |path: &TracePath| match path {
        TracePath::Arc { from, to, centre, .. } => {
            Some(((from - centre).norm() - (to - centre).norm()).abs())
        }
        TracePath::Tilted(arc) => Some((arc.radii().0 - arc.radii().1).abs()),
        _ => None,
    };
    let largest = trial.cuts().filter_map(|m| of(&m.path)).fold(0.0, f64::max);
    format!("radii at start and end differ by at most {} mm", number(largest))
}

fn tiny(trial: &Trial) -> Finding {
    match sweeps(trial).as_slice() {
        [] => Finding::expressed("a line: too small for an arc"),
        [one] if one.abs() < PI => Finding::right(radii(trial)),
        other => Finding::wrong(format!("turns {other:?} radians: a small arc has become a circle")),
    }
}

fn shallow(trial: &Trial) -> Finding {
    match sweeps(trial).as_slice() {
        [] => Finding::expressed("a line: flatter than the tolerance"),
        [one] if one.abs() < 0.01 => Finding::right(radii(trial)),
        other => Finding::wrong(format!("turns {other:?} radians instead of 0.0005")),
    }
}

fn curve(trial: &Trial) -> Finding {
    let curves = trial.cuts().filter(|m| matches!(m.path, TracePath::Nurbs { .. })).count();
    match (curves, sweeps(trial).len()) {
        (0, 0) => Finding::expressed(format!("{} lines", trial.cuts().count())),
        (0, arcs) => Finding::expressed(format!("{arcs} arcs")),
        (curves, _) => {
            Finding::right(format!("NURBS in {curves} piece{}", if curves == 1 { "" } else { "s" }))
        }
    }
}
