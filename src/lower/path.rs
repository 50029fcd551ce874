//! Fitted chains as vectors: starts, ends and tangents, in grid steps.

use super::fit::{Fit, Primitive};
use crate::geom::Vec2;

/// End of a primitive, in its own steps.
pub(super) fn end(primitive: &Primitive) -> Option<[i64; 2]> {
    match primitive {
        Primitive::Line { to } | Primitive::Arc { to, .. } | Primitive::Spiral { to } => Some(*to),
        Primitive::Nurbs { points, pieces, .. } => {
            let fine = (0..pieces.unwrap_or(0)).fold(1, |factor: i64, _| factor.saturating_mul(10));
            points.last().map(|(p, _)| p.map(|v| v / fine))
        }
    }
}

/// NC blocks of a chain: one a primitive, one a control point or a piece of a NURBS curve.
pub(super) fn blocks(fit: &Fit) -> usize {
    fit.primitives.iter().map(super::pieces::blocks).sum()
}

/// Start of the chain's last primitive.
pub(super) fn last_start(fit: &Fit) -> [i64; 2] {
    let count = fit.primitives.len();
    let before = count.checked_sub(2).and_then(|i| fit.primitives.get(i));
    before.and_then(end).unwrap_or(fit.start)
}

/// Last vertex of the chain.
pub(super) fn last_end(fit: &Fit) -> [i64; 2] {
    fit.primitives.last().and_then(end).unwrap_or(fit.start)
}

/// Unit tangent where the chain starts; `None` for polar chains and chains without length.
pub(super) fn start_tangent(fit: &Fit, centre_per_linear: i64) -> Option<Vec2> {
    tangent(fit.primitives.first()?, fit.start, false, centre_per_linear)
}

/// Unit tangent where the chain ends.
pub(super) fn end_tangent(fit: &Fit, centre_per_linear: i64) -> Option<Vec2> {
    tangent(fit.primitives.last()?, last_start(fit), true, centre_per_linear)
}

fn tangent(primitive: &Primitive, start: [i64; 2], at_end: bool, centre_per_linear: i64) -> Option<Vec2> {
    let direction = match primitive {
        Primitive::Line { to } => between(start, *to),
        Primitive::Arc { to, centre, clockwise } => {
            // From the centre to the point, in centre steps.
            let spoke = if at_end {
                between(start, *to) * centre_per_linear as f64 - Vec2::new(centre[0] as f64, centre[1] as f64)
            } else {
                Vec2::new(-centre[0] as f64, -centre[1] as f64)
            };
            if *clockwise { Vec2::new(spoke.y, -spoke.x) } else { Vec2::new(-spoke.y, spoke.x) }
        }
        Primitive::Nurbs { points, .. } => {
            let legs = points.windows(2).map(|w| between(w[0].0, w[1].0));
            let mut legs = legs.filter(|l| l.norm() > 0.0);
            if at_end { legs.next_back()? } else { legs.next()? }
        }
        Primitive::Spiral { .. } => return None,
    };
    (direction.norm() > 0.0).then(|| direction.normalize())
}

/// `b` − `a` as a vector.
pub(super) fn between(a: [i64; 2], b: [i64; 2]) -> Vec2 {
    // Steps of any machine are far below 2^53.
    Vec2::new((b[0] - a[0]) as f64, (b[1] - a[1]) as f64)
}
