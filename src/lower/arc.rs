//! Arcs as the control takes them: radius check, radius range, largest sweep, full circles.

use crate::math::{TAU, atan2, ceil_to_usize, hypot, sin_cos};
use crate::target::{Capabilities, FullCircle, GridArc, Plane};

/// What an arc becomes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Legal {
    Arc(GridArc),
    Line([i64; 2]),
}

/// Why an arc cannot be output.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RadiusMismatch {
    /// Radius at the start and at the end, mm.
    pub radii: (f64, f64),
}

/// The blocks for an arc.
///
/// # Errors
/// When the radii at start and end differ by more than the tightest control accepts; a fit never gives that.
pub(super) fn legalise(
    arc: GridArc,
    plane: Plane,
    capabilities: &Capabilities,
) -> Result<Vec<Legal>, RadiusMismatch> {
    let grid = &capabilities.grid;
    let scale = centre_per_linear(capabilities);
    let (r0, r1) = arc.radii(scale);
    let mm = grid.centre_step();
    if (r0 - r1).abs() * mm > capabilities.radius_tolerance {
        return Err(RadiusMismatch { radii: (r0 * mm, r1 * mm) });
    }
    let radius = r0.max(r1) * mm;
    let sweep = arc.sweep(scale);
    let (smallest, largest) = capabilities.radius_range;
    // A line is the same to the control where neither the sagitta nor the turn at the joints shows.
    let sagitta = radius * (1.0 - crate::math::cos((sweep / 2.0).min(crate::math::PI)));
    if arc.start != arc.to && sagitta < grid.linear_step() / 4.0 && sweep / 2.0 < STRAIGHT {
        return Ok(vec![Legal::Line(arc.to)]);
    }
    if radius < smallest || radius > largest {
        let chords = chords_for(sagitta, grid.linear_step() / 4.0);
        return Ok(split(&arc, chords, scale).into_iter().map(|a| Legal::Line(a.to)).collect());
    }
    let circle = (arc.start == arc.to).then(|| capabilities.full_circle(plane));
    let pieces = pieces(sweep, circle, capabilities);
    // The place between may come to lie on the chord.
    let straight = |a: &GridArc| capabilities.by_middle(plane) && a.centre_by_middle(scale).is_none();
    let part = |a: GridArc| if straight(&a) { Legal::Line(a.to) } else { Legal::Arc(a) };
    Ok(split(&arc, pieces, scale).into_iter().map(part).collect())
}

/// An arc that turns less than this to either side of its chord is a line, radians: a fifth of what joints may turn.
const STRAIGHT: f64 = 0.01 * crate::math::DEG;

/// Centre steps in a linear step.
pub(super) fn centre_per_linear(capabilities: &Capabilities) -> i64 {
    (capabilities.grid.linear_decimals..capabilities.grid.centre_decimals).fold(1, |f, _| f * 10)
}

/// Chords that bring a sagitta down to `wanted`: it goes with the square of their number.
fn chords_for(sagitta: f64, wanted: f64) -> usize {
    ceil_to_usize((sagitta / wanted).sqrt()).clamp(2, 10_000)
}

/// Blocks for an arc of this sweep.
fn pieces(sweep: f64, circle: Option<FullCircle>, capabilities: &Capabilities) -> usize {
    match circle {
        Some(FullCircle::Whole) => 1,
        Some(FullCircle::Split(least)) => {
            usize::from(least).max(ceil_to_usize(TAU / capabilities.max_sweep - 1e-9))
        }
        None => ceil_to_usize(sweep / capabilities.max_sweep - 1e-9).max(1),
    }
}

/// Equal parts of an arc about the same centre, joints on the grid where the radius fits best.
fn split(arc: &GridArc, count: usize, scale: i64) -> Vec<GridArc> {
    let sweep = arc.sweep(scale);
    let mut parts = Vec::with_capacity(count);
    let mut start = arc.start;
    for index in 1..=count {
        let to = if index == count {
            arc.to
        } else {
            joint(arc, sweep * index as f64 / count as f64, sweep / count as f64, scale)
        };
        let moved = [(start[0] - arc.start[0]) * scale, (start[1] - arc.start[1]) * scale];
        let centre = [arc.centre[0] - moved[0], arc.centre[1] - moved[1]];
        if to != start || count == 1 {
            parts.push(GridArc { start, to, centre, clockwise: arc.clockwise });
        }
        start = to;
    }
    parts
}

/// The grid point near the arc's point at `turn` from its start that is nearest to the arc: among the
/// roundings of points within a twentieth of a part.
fn joint(arc: &GridArc, turn: f64, part: f64, scale: i64) -> [i64; 2] {
    let (a, _) = arc.spokes(scale);
    let (r0, r1) = arc.radii(scale);
    let sweep = arc.sweep(scale);
    let hub = [
        arc.start[0] as f64 + arc.centre[0] as f64 / scale as f64,
        arc.start[1] as f64 + arc.centre[1] as f64 / scale as f64,
    ];
    let candidate = |offset: f64| {
        let angle = turn + offset;
        let radius = (r0 + (r1 - r0) * angle / sweep) / scale as f64;
        let (s, c) = sin_cos(atan2(a[1], a[0]) + if arc.clockwise { -angle } else { angle });
        let point = [(hub[0] + radius * c).round(), (hub[1] + radius * s).round()];
        let error = (hypot(point[0] - hub[0], point[1] - hub[1]) - radius).abs();
        (error, offset.abs(), [point[0] as i64, point[1] as i64])
    };
    let best = (-32i32..=32)
        .map(|k| candidate(f64::from(k) * part / 640.0))
        .min_by(|x, y| x.0.total_cmp(&y.0).then(x.1.total_cmp(&y.1)));
    best.map_or(arc.to, |(_, _, point)| point)
}
