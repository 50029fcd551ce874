//! Arcs as the control takes them: radius check, radius range, largest sweep, full circles.

use crate::math::{TAU, atan2, ceil_to_usize, hypot, sin_cos};
use crate::target::{Capabilities, FullCircle};

/// An arc on the grid: start and end in linear steps, centre minus start in centre steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct GridArc {
    pub start: [i64; 2],
    pub to: [i64; 2],
    pub centre: [i64; 2],
    pub clockwise: bool,
}

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

impl GridArc {
    /// Start and end minus the centre, in centre steps.
    fn spokes(&self, scale: i64) -> ([f64; 2], [f64; 2]) {
        let a = [-self.centre[0] as f64, -self.centre[1] as f64];
        let chord = [(self.to[0] - self.start[0]) * scale, (self.to[1] - self.start[1]) * scale];
        (a, [a[0] + chord[0] as f64, a[1] + chord[1] as f64])
    }
    /// Radius at start and end, in centre steps.
    pub fn radii(&self, scale: i64) -> (f64, f64) {
        let (a, b) = self.spokes(scale);
        (hypot(a[0], a[1]), hypot(b[0], b[1]))
    }
    /// Two halves of a full circle.
    pub fn halves(&self, scale: i64) -> [GridArc; 2] {
        // The point opposite to the start, as exactly as centre steps allow.
        let far = self.centre.map(|c| {
            let twice = 2 * c;
            (twice as f64 / scale as f64).round() as i64
        });
        let middle = [self.start[0] + far[0], self.start[1] + far[1]];
        let back = [self.centre[0] - far[0] * scale, self.centre[1] - far[1] * scale];
        [
            GridArc { to: middle, ..*self },
            GridArc { start: middle, to: self.start, centre: back, clockwise: self.clockwise },
        ]
    }
    /// Points of the arc that are furthest out along an axis, in linear steps; ends not counted.
    pub fn extremes(&self, scale: i64) -> Vec<[f64; 2]> {
        let (a, _) = self.spokes(scale);
        let (r0, r1) = self.radii(scale);
        let radius = r0.max(r1) / scale as f64;
        let hub = [0, 1].map(|i| self.start[i] as f64 + self.centre[i] as f64 / scale as f64);
        let (sweep, start) = (self.sweep(scale), atan2(a[1], a[0]));
        let ahead = |angle: f64| if self.clockwise { start - angle } else { angle - start };
        let sides = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)];
        let reached = sides.into_iter().filter(|(c, s)| ahead(atan2(*s, *c)).rem_euclid(TAU) <= sweep);
        reached.map(|(c, s)| [hub[0] + radius * c, hub[1] + radius * s]).collect()
    }
    /// Sweep, 0 < sweep <= 2π, in its own sense.
    pub fn sweep(&self, scale: i64) -> f64 {
        if self.start == self.to {
            return TAU;
        }
        let (a, b) = self.spokes(scale);
        let turn = atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
        let turn = if self.clockwise { -turn } else { turn };
        if turn > 0.0 { turn } else { turn + TAU }
    }
}

/// The blocks for an arc.
///
/// # Errors
/// When the radii at start and end differ by more than the tightest control accepts; a fit never gives that.
pub(super) fn legalise(arc: GridArc, capabilities: &Capabilities) -> Result<Vec<Legal>, RadiusMismatch> {
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
    let pieces = pieces(sweep, arc.start == arc.to, capabilities);
    Ok(split(&arc, pieces, scale).into_iter().map(Legal::Arc).collect())
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
fn pieces(sweep: f64, full: bool, capabilities: &Capabilities) -> usize {
    match (full, capabilities.full_circle) {
        (true, FullCircle::Whole) => 1,
        (true, FullCircle::Split(least)) => {
            usize::from(least).max(ceil_to_usize(TAU / capabilities.max_sweep - 1e-9))
        }
        (false, _) => ceil_to_usize(sweep / capabilities.max_sweep - 1e-9).max(1),
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
