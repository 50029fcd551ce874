//! Links of polar chains turn the table by less than half a turn.
//!
//! A rotary axis that rolls over takes the shorter way to the angle it is given: a dwell of 240 degrees in one block would turn
//! it by 120 degrees, backwards. Links that turn less than half a turn are followed alike by an axis that counts on.

use super::search::Vertex;
use super::tube::{Gates, Plane};
use super::window::Course;

/// Largest turn of a link, degrees.
const MOST: f64 = 179.0;

/// The chain with every link that turns farther divided, as evenly as the grid of the radius allows.
pub(super) fn turned(gates: &Gates, plane: Plane, vertices: Vec<Vertex>) -> Vec<Vertex> {
    let Plane::Polar { angle_step, .. } = plane else { return vertices };
    let most = MOST / angle_step;
    let far = |pair: &[Vertex]| (pair[1].at[1] - pair[0].at[1]).unsigned_abs() as f64 > most;
    if !vertices.windows(2).any(far) {
        return vertices;
    }
    let end = vertices.last().map_or(0, |v| v.next);
    let course = Course { gates, end, target: None };
    let mut chain = vec![vertices[0]];
    for pair in vertices.windows(2) {
        for at in between(pair[0].at, pair[1].at, most) {
            let p = Vertex { at, next: 0 }.point();
            let gate = course.locate(p, pair[1].next.saturating_sub(1), pair[0].next);
            chain.push(Vertex { at, next: gate.map_or(pair[0].next, |gate| gate + 1) });
        }
        chain.push(pair[1]);
    }
    chain
}

/// Where a link is divided: at whole steps of the radius, where the angle is as near to the link as its grid allows.
fn between(from: [i64; 2], to: [i64; 2], most: f64) -> Vec<[i64; 2]> {
    let (rise, turn) = ((to[0] - from[0]) as f64, (to[1] - from[1]) as f64);
    let parts = (turn.abs() / most).ceil();
    let even =
        |k: f64| [from[0] + (rise * k / parts).round() as i64, from[1] + (turn * k / parts).round() as i64];
    let on_link = |k: f64| {
        let [radius, angle] = even(k);
        let share = (radius - from[0]) as f64 / rise;
        [radius, if rise == 0.0 { angle } else { from[1] + (turn * share).round() as i64 }]
    };
    let inner = || (1..parts as u32).map(f64::from);
    let exact: Vec<[i64; 2]> = inner().map(on_link).collect();
    let mut before = from[1];
    let short = exact.iter().chain([&to]).all(|v| {
        let step = v[1] - core::mem::replace(&mut before, v[1]);
        step.unsigned_abs() as f64 <= most && step as f64 * turn > 0.0
    });
    if short { exact } else { inner().map(even).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dwells_are_divided_evenly() {
        assert_eq!(between([20_000, 0], [20_000, 240_000], 179_000.0), [[20_000, 120_000]]);
        assert_eq!(
            between([20_000, 0], [20_000, -360_000], 179_000.0),
            [[20_000, -120_000], [20_000, -240_000]]
        );
        assert!(between([20_000, 0], [20_000, 179_000], 179_000.0).is_empty());
    }

    #[test]
    fn spirals_are_divided_where_the_radius_is_a_whole_number_of_steps() {
        // 3 steps in 240 degrees: two of them at 160
        assert_eq!(between([20_000, 0], [20_003, 240_000], 179_000.0), [[20_002, 160_000]]);
        // one step: no radius in between, so half a step off
        assert_eq!(between([20_000, 0], [20_001, 240_000], 179_000.0), [[20_001, 120_000]]);
        // the step in the middle would leave a part that is too long
        assert_eq!(between([20_000, 0], [20_003, 350_000], 179_000.0), [[20_002, 175_000]]);
    }
}
