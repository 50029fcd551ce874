//! The way onto a surface: from above down to the start of an arc that ends on the pass with its tangent.

use super::{lanes, start_of};
use crate::geom::surface::swept::{self, Question};
use crate::geom::surface::{Contact, Track};
use crate::geom::{Point3, Vec3};
use crate::math;

/// Radius of the arc as a share of the ball's.
const SHARE: f64 = 0.5;
/// Chords of the quarter arc.
const CHORDS: u32 = 9;
/// Arcs are tried down to this part of the radius.
const TRIES: u32 = 4;
/// What is nearer than the radius by no more than this grazes, mm.
const GRAZES: f64 = 1e-6;

/// Centre points of a ball on its way onto a track, from the highest down to its start (that one left out): chords of a
/// quarter circle in the plane of the pass's tangent and the surface's normal, on the clear side of it. Where no arc
/// is clear of the surface, a point straight above the start.
pub(super) fn onto(track: &Track) -> Vec<Point3> {
    let Some(start) = start_of(track) else { return Vec::new() };
    let ball = track.cutter.is_ball();
    let radius = SHARE * if ball { track.radius } else { track.cutter.radius() };
    let tangent = tangent(track, &start);
    for halvings in 0..TRIES {
        let radius = radius / f64::from(1 << halvings);
        let Some(points) = tangent.and_then(|t| arc(&start, t, radius)) else { break };
        let free = if ball { clear(track, &start, &points) } else { lanes::clear(track, &points) };
        if free {
            return points;
        }
    }
    vec![start.centre + Vec3::z() * radius]
}

/// Whether a ball is clear of the surface on straight ways between points, and from the last of them to the start.
fn clear(track: &Track, start: &Contact, points: &[Point3]) -> bool {
    let question = Question { enough: track.radius, little: f64::INFINITY, accuracy: GRAZES };
    let ends = points.iter().skip(1).chain([&start.centre]);
    points.iter().zip(ends).all(|(from, to)| {
        let found = swept::extremes(&track.tree, *from, *to, &question, Some(&start.foot));
        found.least.distance >= track.radius - GRAZES
    })
}

fn tangent(track: &Track, start: &Contact) -> Option<Vec3> {
    let next = track.at(1e-4, Some(start))?;
    (next.centre - start.centre).try_normalize(1e-12)
}

fn arc(start: &Contact, tangent: Vec3, radius: f64) -> Option<Vec<Point3>> {
    let up = (start.normal - tangent * start.normal.dot(&tangent)).try_normalize(1e-9)?;
    // The arc's first point must be reached from above without another obstacle than those tested.
    let point = |k: u32| {
        let (sin, cos) = math::sin_cos(math::PI / 2.0 * f64::from(k) / f64::from(CHORDS));
        start.centre + up * (radius * (1.0 - cos)) - tangent * (radius * sin)
    };
    Some((1..=CHORDS).rev().map(point).collect())
}
