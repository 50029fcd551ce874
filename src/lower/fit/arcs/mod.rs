//! Tangent-continuous chains of circular arcs in a band, with the fewest arcs.
//!
//! The exact curve is cut at its corners into stretches ([`stretch`]). On a stretch a chain of arcs is described by
//! its joints (station s, deviation e) and half sweeps ([`chain`]); for a given number of arcs the largest distance
//! from the middle of the band is minimised by sequential linear minimax programming ([`optimise`], [`minimax`]),
//! from joints at equal shares of ∫|k'|^(1/3) ds ([`start`]): the deviation obeys e'' = k_arc - k, so this is best
//! approximation by C1 quadratic splines with free knots. The count is found by inserting and removing arcs
//! ([`search`], [`descend`]), with the proven [`bound`] beside it; the result is rounded to the grid ([`round`]) and certified there ([`certify`]).

mod bound;
mod certify;
mod chain;
mod descend;
mod exact;
pub(in crate::lower::fit) mod minimax;
mod optimise;
mod round;
mod search;
pub(in crate::lower::fit) mod start;
pub(in crate::lower::fit) mod stretch;
#[cfg(test)]
pub(in crate::lower::fit) mod tests;

use certify::Extremes;
use chain::{Band, Chain, Goal, Hold, Joint};
use round::{Limits, Rounded};
use search::Wish;
use stretch::Stretch;

use super::guard::guarded;
use super::{Fit, FitError, Grid, Primitive, Tube};
use crate::geom::curve::Shape;
use crate::geom::{Point2, left};
use crate::math;

/// Flatter arcs than this become lines, mm …
const LARGEST_RADIUS: f64 = 1e5;
/// … unless the stretch is so long that arcs of this many times its length matter.
const FLATTEST: f64 = 4.0;
/// Tangent error at a joint before rounding that weighs as much as half the band, radians.
const INNER_TANGENT: f64 = 2e-6;
/// Shares of the band that are tried before rounding.
const SHARES: [f64; 4] = [1.0, 0.9, 0.75, 0.5];

/// Fits a tangent-continuous chain of arcs (and lines).
///
/// `exact_spans` keeps the circular spans of the curve (dwells) exactly; `start` is the preferred start parameter of
/// a closed curve without corners.
///
/// # Errors
/// [`FitError::BandTooNarrow`] when no chain on the grid keeps the band, [`FitError::BadCurve`] for cusps.
pub fn arcs(tube: &Tube<'_>, grid: &Grid, exact_spans: bool, start: Option<f64>) -> Result<Fit, FitError> {
    let guarded = guarded(tube, grid)?;
    chained(&guarded.tube, grid, exact_spans, start).map(|fit| guarded.answer(fit))
}

fn chained(tube: &Tube<'_>, grid: &Grid, exact_spans: bool, start: Option<f64>) -> Result<Fit, FitError> {
    let half = 0.5 * (tube.left + tube.right);
    let (u, _) = tube.curve.domain();
    let origin = tube.curve.at(u).p;
    if half.is_nan() || half < 0.25 * grid.step {
        return Err(FitError::BandTooNarrow { needed: grid.step, have: 2.0 * half, at: origin });
    }
    if let Some(fit) = circle(tube, grid, start)? {
        return Ok(fit);
    }
    let list = stretch::stretches(tube.curve, half)?;
    let vertices = vertices(tube, grid, &list)?;
    let mut fits = Vec::with_capacity(list.len());
    for (i, stretch) in list.iter().enumerate() {
        let ends = (!stretch.closed).then(|| [vertices[i], vertices[(i + 1) % vertices.len()]]);
        fits.push(fit_stretch(tube, grid, stretch, ends, exact_spans, start)?);
    }
    let mut fit = joined(fits);
    fit.lower_bound = bound::fewest(tube, &list);
    Ok(fit)
}

fn joined(fits: Vec<Rounded>) -> Fit {
    let start = fits.first().map_or([0, 0], |f| f.start);
    let mut all = Extremes::NONE;
    let mut primitives = Vec::new();
    for fit in fits {
        all.join(fit.extremes);
        primitives.extend(fit.primitives);
    }
    Fit { start, primitives, lower_bound: None, deviation: (all.high.max(0.0), (-all.low).max(0.0)) }
}

/// Grid points at the ends of the stretches; an open curve has one more than stretches.
pub(in crate::lower::fit) fn vertices(
    tube: &Tube<'_>,
    grid: &Grid,
    list: &[Stretch<'_>],
) -> Result<Vec<[i64; 2]>, FitError> {
    let mut out = Vec::new();
    let closed = tube.curve.is_closed();
    for (i, stretch) in list.iter().enumerate() {
        if stretch.closed {
            return Ok(out);
        }
        let before = if i > 0 { Some(&list[i - 1]) } else { closed.then(|| &list[list.len() - 1]) };
        out.push(vertex(tube, grid, before, Some(stretch))?);
    }
    if !closed {
        out.push(vertex(tube, grid, list.last(), None)?);
    }
    Ok(out)
}

/// Grid point near station `s` of a closed stretch, in the middle of the band.
pub(in crate::lower::fit) fn vertex_at(
    tube: &Tube<'_>,
    grid: &Grid,
    stretch: &Stretch<'_>,
    s: f64,
) -> Result<[i64; 2], FitError> {
    let frame = stretch.at(s);
    round::nearest(grid, frame.p + left(frame.t) * (0.5 * (tube.left - tube.right)))
}

/// A point of the grid, mm.
pub(in crate::lower::fit) fn grid_point(grid: &Grid, q: [i64; 2]) -> Point2 {
    round::point(grid, q)
}

/// Nearest grid point.
pub(in crate::lower::fit) fn nearest_grid_point(grid: &Grid, p: Point2) -> Result<[i64; 2], FitError> {
    round::nearest(grid, p)
}

/// Grid steps about its place in which a vertex is looked for.
const VERTEX_STEPS: i64 = 3;
/// Most grid steps by which a vertex may slide along the path, so that the path neither runs past its end nor stops
/// short of it by more than rounding does.
const VERTEX_REACH: f64 = 1.2;
/// What a slide of a vertex along the path counts beside a miss across it: little, for arcs of little sweep agree
/// in their radii only when both ends lie on the circle.
const VERTEX_SLIDE: f64 = 0.05;

/// The grid point that misses the middle of both bands least, near where they meet.
fn vertex(
    tube: &Tube<'_>,
    grid: &Grid,
    before: Option<&Stretch<'_>>,
    after: Option<&Stretch<'_>>,
) -> Result<[i64; 2], FitError> {
    let frames: Vec<_> =
        [before.map(|s| s.end(true)), after.map(|s| s.end(false))].into_iter().flatten().collect();
    let corner = frames.first().map_or(Point2::origin(), |f| f.p);
    let normals: Vec<_> = frames.iter().map(|f| left(f.t)).collect();
    let middle = 0.5 * (tube.left - tube.right);
    let sum = normals.iter().fold(crate::geom::Vec2::zeros(), |a, n| a + n);
    let scale = normals.len() as f64 * middle / sum.norm_squared().max(0.25);
    let ideal = corner + sum * scale;
    let centre = round::nearest(grid, ideal)?;
    let mut best = (f64::INFINITY, centre);
    for dx in -VERTEX_STEPS..=VERTEX_STEPS {
        for dy in -VERTEX_STEPS..=VERTEX_STEPS {
            let q = [centre[0] + dx, centre[1] + dy];
            let p = round::point(grid, q);
            let miss = normals.iter().fold(0.0_f64, |m, n| m.max(((p - corner).dot(n) - middle).abs()));
            let slide = (p - ideal).norm();
            let beyond = (slide - VERTEX_REACH * grid.step).max(0.0);
            let cost = miss + VERTEX_SLIDE * slide + beyond;
            if cost < best.0 {
                best = (cost, q);
            }
        }
    }
    Ok(best.1)
}

fn fit_stretch(
    tube: &Tube<'_>,
    grid: &Grid,
    stretch: &Stretch<'_>,
    ends: Option<[[i64; 2]; 2]>,
    exact: bool,
    start: Option<f64>,
) -> Result<Rounded, FitError> {
    let radius = LARGEST_RADIUS.max(FLATTEST * stretch.length());
    let limits = Limits { left: tube.left, right: tube.right, radius };
    let (middle, half) = (0.5 * (tube.left - tube.right), 0.5 * (tube.left + tube.right));
    let mut last: Option<Rounded> = None;
    for share in SHARES {
        let goal = Goal { band: Band { middle, half: half * share }, tangent: INNER_TANGENT };
        let joints = ends.map(|[a, b]| {
            [
                end_joint(stretch, round::point(grid, a), 0.0),
                end_joint(stretch, round::point(grid, b), stretch.length()),
            ]
        });
        let wish = Wish { goal, ends: joints, exact, radius };
        let Some((chain, _)) = search::fewest(stretch, &wish) else { continue };
        let chain = from_start(chain, stretch, start);
        let rounded = round::round(&chain, stretch, grid, &limits)?;
        if rounded.good(&limits) {
            return Ok(rounded);
        }
        last = Some(rounded);
    }
    Err(too_narrow(tube, last.as_ref(), stretch))
}

fn too_narrow(tube: &Tube<'_>, last: Option<&Rounded>, stretch: &Stretch<'_>) -> FitError {
    let have = tube.left + tube.right;
    match last {
        Some(r) if r.extremes.high <= tube.left && r.extremes.low >= -tube.right => {
            FitError::GridTooCoarse { kink: r.kink, mismatch: r.mismatch, at: r.worst_at }
        }
        Some(r) => {
            let needed = r.extremes.high.max(tube.left) - r.extremes.low.min(-tube.right);
            FitError::BandTooNarrow { needed, have, at: r.worst_at }
        }
        None => FitError::BandTooNarrow { needed: 2.0 * have, have, at: stretch.samples[0].p },
    }
}

/// A joint fixed at `p`, whose foot is the end `s` of an open stretch.
fn end_joint(stretch: &Stretch<'_>, p: Point2, s: f64) -> Joint {
    let frame = stretch.end(s > 0.0);
    Joint { s, e: (p - frame.p).dot(&left(frame.t)), hold: Hold::Vertex, frame, p }
}

/// The closed chain counted from the joint nearest to the preferred start parameter.
fn from_start(chain: Chain, stretch: &Stretch<'_>, start: Option<f64>) -> Chain {
    let Some(u) = start.filter(|_| chain.closed) else { return chain };
    let (u0, u1) = stretch.curve.domain();
    let want = u0 + (u - u0) - (u1 - u0) * ((u - u0) / (u1 - u0)).floor();
    let gap = |u: f64| {
        let d = (u - want).abs();
        d.min((u1 - u0) - d)
    };
    let first = (0..chain.joints.len())
        .min_by(|&a, &b| {
            let at = |j: usize| gap(stretch.parameter(chain.joints[j].s).0);
            at(a).total_cmp(&at(b))
        })
        .unwrap_or(0);
    search::rotate(&chain, stretch, first)
}

/// A closed curve that is one circle.
fn circle(tube: &Tube<'_>, grid: &Grid, start: Option<f64>) -> Result<Option<Fit>, FitError> {
    let spans = tube.curve.breaks().len().saturating_sub(1);
    let mut shape = None;
    for i in 0..spans {
        let Shape::Arc { centre, radius, ccw } = tube.curve.shape(i) else { return Ok(None) };
        match shape {
            None => shape = Some((centre, radius, ccw)),
            Some((c, r, w)) if (c - centre).norm() < 1e-9 && (r - radius).abs() < 1e-9 && w == ccw => {}
            Some(_) => return Ok(None),
        }
    }
    let Some((centre, radius, ccw)) = shape.filter(|_| tube.curve.is_closed()) else { return Ok(None) };
    let from = tube.curve.at(start.unwrap_or(tube.curve.domain().0)).p;
    Ok(whole_circle(tube, grid, from, centre, radius, ccw))
}

/// A full circle in one block, when the grid allows it within the band.
fn whole_circle(
    tube: &Tube<'_>,
    grid: &Grid,
    from: Point2,
    centre: Point2,
    radius: f64,
    ccw: bool,
) -> Option<Fit> {
    let middle = 0.5 * (tube.left - tube.right);
    let sign = if ccw { -1.0 } else { 1.0 };
    let want = radius + sign * middle;
    let outward = (from - centre).normalize();
    let side = left(outward);
    let mut best: Option<(f64, [i64; 2], [i64; 2])> = None;
    for i in -200..=200 {
        let (sin, cos) = math::sin_cos(f64::from(i) * grid.step / radius);
        let q = round::nearest(grid, centre + (outward * cos + side * sin) * want).ok()?;
        let p = round::point(grid, q);
        let d = (centre - p) / grid.centre_step;
        let words = [d.x.round() as i64, d.y.round() as i64];
        let c = p + crate::geom::Vec2::new(words[0] as f64, words[1] as f64) * grid.centre_step;
        let miss =
            ((p - c).norm() - want).abs() + (c - centre).norm() + 1e-6 * f64::from(i).abs() * grid.step;
        if best.is_none_or(|(m, _, _)| miss < m) {
            best = Some((miss, q, words));
        }
    }
    let (_, q, words) = best?;
    let p = round::point(grid, q);
    let c = p + crate::geom::Vec2::new(words[0] as f64, words[1] as f64) * grid.centre_step;
    let (off, r) = ((c - centre).norm(), (p - c).norm());
    // Deviations of a circle from a circle: radial, between r - off and r + off, to second order in off.
    let (inner, outer) = (r - off - radius, r + off - radius);
    let (left_most, right_most) = if ccw { (-inner, outer) } else { (outer, -inner) };
    let slack = off * off / radius;
    (left_most + slack <= tube.left && right_most + slack <= tube.right).then(|| Fit {
        start: q,
        primitives: vec![Primitive::Arc { to: q, centre: words, clockwise: !ccw }],
        lower_bound: Some(1),
        deviation: ((left_most + slack).max(0.0), (right_most + slack).max(0.0)),
    })
}
