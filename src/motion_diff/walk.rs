//! Walking along two paths at once.
//!
//! Every corner of one path is matched with a point of the other at or after the match of the corner before. Between
//! matched corners of both, each path is straight, and the distance of two straight pieces is largest at an end: so
//! when all corners match within the tolerance, both ways, nothing lies farther apart.

use super::chords::Path;
use super::{PathDifference, coordinates};
use crate::geom::Point3;

/// How much longer than a step of one path the way along the other may be, relative to the step …
const LONGER: f64 = 1.05;
/// … and beyond that, in tolerances.
const SLACK: f64 = 20.0;
/// How much farther a match is looked for, in distances from the nearest point so far: a detour that leads so far off
/// is about that long.
const DETOUR: f64 = 4.0;

/// A point of a path: on the chord that ends at corner `chord`, `x` of the way along it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Match {
    /// Index of the corner that ends the chord; 0 when the path has no chord.
    pub chord: usize,
    /// Part of the chord, 0..1.
    pub x: f64,
    /// Distance of the corner that was matched, mm.
    pub distance: f64,
}

/// The match of every corner of each path on the other; empty where the other path is.
#[derive(Debug)]
pub(super) struct Walked {
    pub matches: [Vec<Match>; 2],
}

/// Matches both ways.
pub(super) fn both(paths: &[Path<'_>; 2], tolerance: f64) -> Walked {
    let [a, b] = paths;
    Walked { matches: [along(a, b, tolerance), along(b, a, tolerance)] }
}

fn along(path: &Path<'_>, other: &Path<'_>, tolerance: f64) -> Vec<Match> {
    let mut here = (1, 0.0);
    let mut matches = Vec::with_capacity(path.points.len());
    if other.points.is_empty() {
        return matches;
    }
    for (index, point) in path.points.iter().enumerate() {
        let step = index.checked_sub(1).map_or(0.0, |before| length_between(path, before, index));
        let found = find(*point, other, here, LONGER * step + SLACK * tolerance, tolerance);
        here = (found.chord.max(1), found.x);
        matches.push(found);
    }
    matches
}

fn length_between(path: &Path<'_>, a: usize, b: usize) -> f64 {
    path.at.get(b).zip(path.at.get(a)).map_or(0.0, |(b, a)| b - a)
}

/// The match of a point: near by, or else behind a detour of the other path.
fn find(point: Point3, other: &Path<'_>, here: (usize, f64), window: f64, tolerance: f64) -> Match {
    let near = next(point, other, here, window, tolerance);
    if near.distance <= tolerance {
        return near;
    }
    let behind = next(point, other, here, window + DETOUR * near.distance, tolerance);
    if behind.distance <= tolerance { behind } else { near }
}

/// The first point from `here` on, within `window` mm of path, at which the distance is least and within the
/// tolerance; or else the nearest in the window.
fn next(point: Point3, other: &Path<'_>, here: (usize, f64), window: f64, tolerance: f64) -> Match {
    let start = at(other, here);
    let mut best = Match { chord: here.0, x: here.1, distance: (point - start.0).norm() };
    for chord in here.0..other.points.len() {
        let from = if chord == here.0 { here.1 } else { 0.0 };
        let found = nearest(point, other, chord, from);
        if found.distance < best.distance {
            best = found;
        } else if best.distance <= tolerance {
            return best;
        }
        // Only at the end of a chord may the way still lead nearer.
        if found.x < 1.0 && found.distance <= tolerance {
            return found;
        }
        if other.at.get(chord).is_some_and(|at| at - start.1 > window) {
            break;
        }
    }
    best
}

/// The point at a place, and its length along the path.
fn at(path: &Path<'_>, (chord, x): (usize, f64)) -> (Point3, f64) {
    let end = path.points.get(chord).or(path.points.last()).copied().unwrap_or_else(Point3::origin);
    let start = chord.checked_sub(1).and_then(|c| path.points.get(c)).copied().unwrap_or(end);
    let before = chord.checked_sub(1).and_then(|c| path.at.get(c)).copied().unwrap_or(0.0);
    (start + (end - start) * x, before + (end - start).norm() * x)
}

/// The nearest point of a chord at or after `from`.
fn nearest(point: Point3, path: &Path<'_>, chord: usize, from: f64) -> Match {
    let ends = chord.checked_sub(1).and_then(|c| Some((path.points.get(c)?, path.points.get(chord)?)));
    let Some((start, end)) = ends else {
        let only = path.points.first().copied().unwrap_or_else(Point3::origin);
        return Match { chord, x: 0.0, distance: (point - only).norm() };
    };
    let step = end - start;
    let square = step.norm_squared();
    let x = if square > 0.0 { ((point - start).dot(&step) / square).clamp(from, 1.0) } else { 1.0 };
    Match { chord, x, distance: (point - (start + step * x)).norm() }
}

/// The move at a match.
pub(super) fn owner(path: &Path<'_>, place: Match) -> Option<usize> {
    path.owner.get(place.chord.min(path.owner.len().saturating_sub(1))).copied()
}

/// Where the paths part, if they do.
pub(super) fn difference(paths: &[Path<'_>; 2], walked: &Walked, tolerance: f64) -> Option<PathDifference> {
    let [a, b] = paths;
    if a.points.is_empty() != b.points.is_empty() {
        return Some(one_is_empty(paths));
    }
    let [of_a, of_b] = &walked.matches;
    let differing = [moves(a, of_a, tolerance), moves(b, of_b, tolerance)];
    let largest = of_a.iter().chain(of_b).map(|m| m.distance).fold(0.0, f64::max);
    if largest <= tolerance {
        return None;
    }
    // The earlier of both first moves that differ, along the paths.
    let first = [first(a, b, of_a, &differing[0]), first(b, a, of_b, &differing[1])];
    let [from_a, from_b] = first;
    let swapped = match (&from_a, &from_b) {
        (Some(a), Some(b)) => b.along < a.along,
        (a, _) => a.is_none(),
    };
    let chosen = if swapped { from_b } else { from_a }?;
    Some(PathDifference {
        lines: ordered([chosen.line, chosen.other_line], swapped),
        points: ordered([chosen.point, chosen.other_point], swapped),
        distance: chosen.distance,
        largest,
        moves: [differing[0].len(), differing[1].len()],
    })
}

fn one_is_empty(paths: &[Path<'_>; 2]) -> PathDifference {
    let line = |path: &Path<'_>| path.moves.first().map_or(0, |m| m.0);
    let point = |path: &Path<'_>| path.points.first().copied().unwrap_or_else(Point3::origin);
    let length = paths[0].length().max(paths[1].length());
    PathDifference {
        lines: [line(&paths[0]), line(&paths[1])],
        points: [coordinates(point(&paths[0])), coordinates(point(&paths[1]))],
        distance: length,
        largest: length,
        moves: [paths[0].moves.len(), paths[1].moves.len()],
    }
}

/// In the order of the programs.
pub(super) fn ordered<T>([own, other]: [T; 2], swapped: bool) -> [T; 2] {
    if swapped { [other, own] } else { [own, other] }
}

/// Moves with a corner beyond the tolerance, in order.
fn moves(path: &Path<'_>, matches: &[Match], tolerance: f64) -> Vec<usize> {
    let mut found: Vec<usize> = path
        .owner
        .iter()
        .zip(matches)
        .filter(|(_, m)| m.distance > tolerance)
        .map(|(owner, _)| *owner)
        .collect();
    found.dedup();
    found
}

/// The first move that differs, at its farthest corner.
struct First {
    line: u32,
    other_line: u32,
    point: [f64; 3],
    other_point: [f64; 3],
    distance: f64,
    along: f64,
}

fn first(path: &Path<'_>, other: &Path<'_>, matches: &[Match], differing: &[usize]) -> Option<First> {
    let which = *differing.first()?;
    let of_move = path.owner.iter().zip(matches).enumerate().filter(|(_, (owner, _))| **owner == which);
    let (corner, (_, found)) = of_move.max_by(|a, b| a.1.1.distance.total_cmp(&b.1.1.distance))?;
    let begins = path.owner.partition_point(|owner| *owner < which);
    let other_owner = owner(other, *found);
    Some(First {
        line: path.moves.get(which)?.0,
        other_line: other_owner.and_then(|o| other.moves.get(o)).map_or(0, |m| m.0),
        point: coordinates(*path.points.get(corner)?),
        other_point: coordinates(at(other, (found.chord, found.x)).0),
        distance: found.distance,
        along: path.at.get(begins).copied().unwrap_or(0.0),
    })
}

/// The match of a point of chord `chord` (its middle) between the matches of the chord's ends.
pub(super) fn middle(path: &Path<'_>, other: &Path<'_>, matches: &[Match], chord: usize) -> Option<Match> {
    let (from, to) = (matches.get(chord.checked_sub(1)?)?, matches.get(chord)?);
    let middle = nalgebra::center(path.points.get(chord - 1)?, path.points.get(chord)?);
    let mut best: Option<Match> = None;
    for between in from.chord.max(1)..=to.chord {
        let low = if between == from.chord { from.x } else { 0.0 };
        let found = nearest(middle, other, between, low);
        if best.is_none_or(|b| found.distance < b.distance) {
            best = Some(found);
        }
    }
    best
}
