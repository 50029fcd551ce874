//! How close passes lie: as far apart as the height of cusps (or the step) allows, and evenly used up.
//!
//! The distance is not taken from a formula of the curvature but from the ridge that two passes leave, computed
//! at many places of the pass: Jeong and Jeong's equation (23) is its first approximation.

use rayon::prelude::*;

use super::family::Family;
use super::share::{Place, Target};
use crate::math::count;

/// Places of a pass at which the ridge is computed.
pub(super) const PLACES: usize = 96;
/// Places that are looked at one after the other, each from the one before.
const STRETCH: usize = 13;
/// Share of the allowed distance that is used: what the places between those computed may need.
const USED: f64 = 0.998;
/// The same for passes in planes: at corners and on steep flanks, where they end at all angles, ridges rise more between
/// the places that are looked at.
const USED_IN_PLANES: f64 = 0.93;
/// More passes than this are a mistake in the tolerance.
const MOST: usize = 50_000;

/// *Across* of all passes, the first and the last at the ends of the surface.
pub(super) fn places(family: &Family, target: Target) -> Result<Vec<f64>, String> {
    let (first, last) = family.across();
    let whole = last - first;
    let mut found = vec![first];
    let (mut at, mut guess) = (first, whole / 50.0);
    while at < last {
        let step = next(family, target, at, guess, last);
        if !(step > 1e-7 * whole) || found.len() > MOST {
            let what = if let Target::Cusp(h) = target {
                format!("a height of cusps of {h} mm")
            } else {
                "this step".into()
            };
            return Err(format!("{what} asks for more than {MOST} passes"));
        }
        at += step;
        guess = step;
        found.push(at);
    }
    Ok(even(&found, last))
}

/// The places moved together evenly, so that the last one lies at the end: each distance is used up to the same share.
fn even(found: &[f64], last: f64) -> Vec<f64> {
    let n = found.len() - 1;
    if n == 0 {
        return vec![last];
    }
    let (a, b) = (found[n - 1], found[n]);
    let whole = count(n - 1) + (last - a) / (b - a);
    let mut places: Vec<f64> = (0..n).map(|k| at_count(found, count(k) * whole / count(n))).collect();
    places.push(last);
    places
}

/// The place between passes, by a quadratic through three of them.
fn at_count(found: &[f64], x: f64) -> f64 {
    let n = found.len() - 1;
    let i = (x.floor() as usize).min(n - 1);
    let f = x - count(i);
    let (a, b) = (found[i], found[i + 1]);
    let linear = a + (b - a) * f;
    let second = match (i.checked_sub(1).map(|j| found[j]), found.get(i + 2)) {
        (Some(before), _) => b - 2.0 * a + before,
        (None, Some(after)) => after - 2.0 * b + a,
        _ => 0.0,
    };
    linear - 0.5 * second * f * (1.0 - f)
}

fn used(family: &Family, target: Target) -> f64 {
    if family.is_plane() && matches!(target, Target::Cusp(_)) { USED_IN_PLANES } else { USED }
}

/// The largest step from `at` that every place of the pass allows.
fn next(family: &Family, target: Target, at: f64, guess: f64, last: f64) -> f64 {
    let Some((from, to)) = family.along(at) else { return guess };
    let places: Vec<f64> = (0..=PLACES).map(|k| from + (to - from) * count(k) / count(PLACES)).collect();
    let stretch = |stretch: &[f64]| {
        let (mut hint, mut least) = (None, f64::INFINITY);
        for along in stretch {
            let Some(a) = family.contact(at, *along, hint.as_ref()) else { continue };
            let place = Place::new(family, a, [*along, at], 0.0, (from, to));
            let allowed = place.and_then(|place| step(family, target, &place, (guess, last)));
            least = least.min(allowed.unwrap_or(f64::INFINITY));
            hint = Some(a);
        }
        least
    };
    let least = places.par_chunks(STRETCH).map(stretch).reduce(|| f64::INFINITY, f64::min);
    if least.is_finite() { least * used(family, target) } else { (last - at).max(guess) }
}

/// The step from a place that the target allows; what would lie beyond `last` is told from the share of the step up to
/// there.
fn step(family: &Family, target: Target, place: &Place, (guess, last): (f64, f64)) -> Option<f64> {
    const ROUNDS: u32 = 8;
    let at = place.at[1];
    let mut step = guess;
    for _ in 0..ROUNDS {
        if at + step > last {
            step = last - at;
            let share = place.share(family, target, last)?;
            if share <= 1.0 {
                return Some(step / share.max(1e-3));
            }
        }
        let Some(share) = place.share(family, target, at + step) else {
            step *= 0.5;
            continue;
        };
        if !(share > 0.0) {
            step *= 2.0;
            continue;
        }
        let factor = (1.0 / share).clamp(0.25, 4.0);
        step *= factor;
        if (factor - 1.0).abs() < 2e-4 {
            break;
        }
    }
    Some(step)
}

/// Passes whose distance is used up everywhere: for each of [`CURVE`] places along, *across* of every pass. All passes
/// run from end to end, so that the place that takes the most of them decides about their number.
pub(super) fn curves(family: &Family, target: Target) -> Result<Vec<Vec<[f64; 2]>>, String> {
    let (first, last) = family.across();
    let Some((from, to)) = family.along(first) else { return Err("no pass meets the surface".into()) };
    let at = |k: usize| from + (to - from) * count(k) / count(CURVE - 1);
    let mut columns: Vec<Vec<f64>> = vec![vec![first]; CURVE];
    while columns.iter().any(|c| c[c.len() - 1] < last) {
        let front: Vec<[f64; 2]> =
            columns.iter().enumerate().map(|(k, c)| [at(k), c[c.len() - 1].min(last)]).collect();
        let steps: Vec<Option<f64>> =
            (0..CURVE).into_par_iter().map(|k| ahead(family, target, &front, k, last)).collect();
        for (column, step) in columns.iter_mut().zip(steps) {
            let end = column[column.len() - 1];
            let step = step.unwrap_or(0.0);
            if !(step > 1e-7 * (last - first)) || column.len() > MOST {
                return Err(format!("the height of cusps asks for more than {MOST} passes"));
            }
            if end < last {
                column.push(end + step * USED);
            }
        }
    }
    let used = |c: &Vec<f64>| {
        let n = c.len() - 1;
        count(n - 1) + (last - c[n - 1]) / (c[n] - c[n - 1])
    };
    let passes = columns.iter().map(used).fold(1.0, f64::max).ceil();
    let pass = |j: f64| -> Vec<[f64; 2]> {
        let place =
            |(k, c): (usize, &Vec<f64>)| [at(k), at_count(c, used(c) * j / passes).clamp(first, last)];
        columns.iter().enumerate().map(place).collect()
    };
    // The number of passes is below MOST.
    Ok((0..=passes as u32).map(|j| pass(f64::from(j))).collect())
}

/// Places along a pass of constant height of cusps.
const CURVE: usize = 129;

/// The step from a place of a curved front.
fn ahead(family: &Family, target: Target, front: &[[f64; 2]], k: usize, last: f64) -> Option<f64> {
    let [along, across] = front[k];
    if across >= last {
        return Some(1.0);
    }
    let other = front[if k + 1 < front.len() { k + 1 } else { k - 1 }];
    let slope = (other[1] - across) / (other[0] - along);
    let range = (front[0][0], front[front.len() - 1][0]);
    let place = Place::new(family, family.contact(across, along, None)?, [along, across], slope, range)?;
    step(family, target, &place, (0.02 * last.max(1e-9), last))
}
