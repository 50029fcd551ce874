//! Where the cutter goes in the part, block by block, for pictures.

use crate::geom::{Point2, Vec2};
use crate::math::{DEG, TAU, atan2, hypot, sin_cos};
use crate::target::{BlockKind, Motion, Nurbs, PieceId, Plane, Position, TargetProgram};

/// What a block does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Use {
    /// At rapid.
    Rapid,
    /// At feed along a contour.
    Cut,
    /// At feed otherwise: leads and links.
    Link,
    /// Up or down only.
    Plunge,
}

/// How many points stand for a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Detail {
    /// As many as the eye needs.
    Picture,
    /// At least 32, all of them on the block.
    Measure,
}

impl Detail {
    /// Steps for a motion that needs `steps` to look right.
    fn steps(self, steps: f64) -> usize {
        const LEAST: usize = 32;
        let steps = steps.ceil().clamp(1.0, 720.0) as usize;
        if self == Detail::Measure { steps.max(LEAST) } else { steps }
    }
}

/// The path of one block in the plane of the part.
#[derive(Debug, Clone)]
pub(super) struct Stroke {
    pub(super) what: Use,
    pub(super) piece: Option<PieceId>,
    /// Points from start to end; both ends are exact.
    pub(super) points: Vec<Point2>,
}

/// The strokes of a program in order. What happens before X and Y are known is left out.
pub(super) fn strokes(program: &TargetProgram, detail: Detail) -> Vec<Stroke> {
    const X_AND_Y: u8 = 3;
    let mut here = Position::default();
    let mut known = 0;
    let mut found = Vec::new();
    for block in &program.blocks {
        let BlockKind::Motion(motion) = &block.kind else { continue };
        let Some(to) = end_of(program, motion) else { continue };
        if known & X_AND_Y == X_AND_Y {
            let points = path(program, here, motion, detail);
            found.push(Stroke {
                what: usage(program, here, to, motion, block.piece),
                piece: block.piece,
                points,
            });
        }
        known |= if let Motion::Rapid { axes, .. } = motion { *axes } else { X_AND_Y };
        here = to;
    }
    found
}

fn end_of(program: &TargetProgram, motion: &Motion) -> Option<Position> {
    match motion {
        Motion::Rapid { to, .. } | Motion::Line { to, .. } | Motion::Arc { to, .. } => Some(*to),
        Motion::Nurbs { curve, .. } => nurbs(program, *curve).and_then(Nurbs::end),
    }
}

fn nurbs(program: &TargetProgram, index: u32) -> Option<&Nurbs> {
    program.nurbs.get(index as usize)
}

fn usage(
    program: &TargetProgram,
    from: Position,
    to: Position,
    motion: &Motion,
    piece: Option<PieceId>,
) -> Use {
    match motion {
        Motion::Rapid { .. } => Use::Rapid,
        _ if piece.is_some() => Use::Cut,
        Motion::Line { .. } if in_part(program, from) == in_part(program, to) => Use::Plunge,
        _ => Use::Link,
    }
}

/// The cutter's place in the part: the table turns the part under it.
fn in_part(program: &TargetProgram, p: Position) -> Point2 {
    let grid = &program.capabilities.grid;
    let (x, y) = (p.x as f64 * grid.linear_step(), p.y as f64 * grid.linear_step());
    turned(program, x, y, p.r as f64 * grid.rotary_step())
}

fn turned(program: &TargetProgram, x: f64, y: f64, degrees: f64) -> Point2 {
    let reversed = program.capabilities.rotary.is_some_and(|r| r.reversed);
    let (s, c) = sin_cos(if reversed { -degrees } else { degrees } * DEG);
    if degrees == 0.0 { Point2::new(x, y) } else { Point2::new(c * x - s * y, s * x + c * y) }
}

/// Points along a motion.
fn path(program: &TargetProgram, from: Position, motion: &Motion, detail: Detail) -> Vec<Point2> {
    match motion {
        Motion::Rapid { to, .. } | Motion::Line { to, .. } => straight(program, from, *to, detail),
        // Seen from above an arc in another plane is a straight line or there and back on one.
        Motion::Arc { to, plane: Plane::Zx | Plane::Yz, .. } => straight(program, from, *to, detail),
        Motion::Arc { to, centre, clockwise, .. } => arc(program, (from, *to), *centre, *clockwise, detail),
        Motion::Nurbs { curve, .. } => {
            nurbs(program, *curve).map_or_else(Vec::new, |n| spline(program, n, detail))
        }
    }
}

fn straight(program: &TargetProgram, from: Position, to: Position, detail: Detail) -> Vec<Point2> {
    const PER_STEP: f64 = 2.0;
    let grid = &program.capabilities.grid;
    let angle = |p: Position| p.r as f64 * grid.rotary_step();
    let steps = detail.steps((angle(to) - angle(from)).abs() / PER_STEP);
    let mix = |a: i64, b: i64, x: f64| a as f64 + (b - a) as f64 * x;
    let at = |x: f64| {
        let (px, py) = (mix(from.x, to.x, x) * grid.linear_step(), mix(from.y, to.y, x) * grid.linear_step());
        turned(program, px, py, mix(from.r, to.r, x) * grid.rotary_step())
    };
    (0..=steps).map(|i| at(i as f64 / steps as f64)).collect()
}

fn arc(
    program: &TargetProgram,
    (from, to): (Position, Position),
    centre: [i64; 2],
    clockwise: bool,
    detail: Detail,
) -> Vec<Point2> {
    const PER_STEP: f64 = 0.03;
    let grid = &program.capabilities.grid;
    let (a, b) = (in_part(program, from), in_part(program, to));
    let centre = a + Vec2::new(centre[0] as f64, centre[1] as f64) * grid.centre_step();
    let (ra, rb) = (a - centre, b - centre);
    let start = atan2(ra.y, ra.x);
    let mut sweep = atan2(rb.y, rb.x) - start;
    let sign = if clockwise { -1.0 } else { 1.0 };
    while sweep * sign <= 1e-9 {
        sweep += sign * TAU;
    }
    let (r0, r1) = (hypot(ra.x, ra.y), hypot(rb.x, rb.y));
    let steps = detail.steps(sweep.abs() / PER_STEP);
    let at = |i: usize| {
        let x = i as f64 / steps as f64;
        let (s, c) = sin_cos(start + sweep * x);
        if i == steps { b } else { centre + Vec2::new(c, s) * (r0 + (r1 - r0) * x) }
    };
    (0..=steps).map(at).collect()
}

/// De Boor's algorithm in homogeneous coordinates.
fn spline(program: &TargetProgram, n: &Nurbs, detail: Detail) -> Vec<Point2> {
    const PER_SPAN: f64 = 12.0;
    let steps = detail.steps(PER_SPAN);
    let degree = usize::from(n.order).saturating_sub(1);
    let grid = &program.capabilities.grid;
    let step = grid.linear_step() / n.fine_steps() as f64;
    let control: Vec<[f64; 3]> = n
        .points
        .iter()
        .map(|&(p, w)| {
            let (x, y) = (p.x as f64 * step, p.y as f64 * step);
            let q = turned(program, x, y, p.r as f64 * grid.rotary_step());
            [q.x * w, q.y * w, w]
        })
        .collect();
    let mut points = Vec::new();
    for span in degree..n.points.len().min(n.knots.len().saturating_sub(1)) {
        let (a, b) = (n.knots[span], n.knots[span + 1]);
        let first = usize::from(!points.is_empty());
        if b > a {
            points.extend(
                (first..=steps).map(|i| {
                    de_boor(&control, &n.knots, degree, span, a + (b - a) * i as f64 / steps as f64)
                }),
            );
        }
    }
    points
}

fn de_boor(control: &[[f64; 3]], knots: &[f64], degree: usize, span: usize, u: f64) -> Point2 {
    let mut d: Vec<[f64; 3]> = (0..=degree).map(|j| control[span - degree + j]).collect();
    for r in 1..=degree {
        for j in (r..=degree).rev() {
            let i = span - degree + j;
            let gap = knots[i + 1 + degree - r] - knots[i];
            let x = if gap > 0.0 { (u - knots[i]) / gap } else { 0.0 };
            let (before, here) = (d[j - 1], d[j]);
            d[j] = [0, 1, 2].map(|axis| (1.0 - x) * before[axis] + x * here[axis]);
        }
    }
    Point2::new(d[degree][0] / d[degree][2], d[degree][1] / d[degree][2])
}
