//! Chains that keep circular and straight spans of the curve as they are.

use super::chain::{Band, Chain, Hold, Joint, Member};
use super::optimise::natural_halves;
use super::start::Density;
use super::stretch::Stretch;
use crate::geom::curve::Shape;

/// Circles count as the same up to this distance of centres and radii, mm.
const SAME: f64 = 1e-7;
/// Share of the band's half width within which kept spans lie.
const INSIDE: f64 = 0.9;
/// First overhang of a kept arc over its span, as a share of the arc beside it.
const OVERHANG: f64 = 0.02;

/// A part of a stretch that is kept as one member, or fitted.
#[derive(Debug, Clone, Copy)]
struct Part {
    /// Shape to be kept; general when it is fitted.
    shape: Shape,
    /// Stations of its ends; the last part of a closed stretch may end beyond its length.
    from: f64,
    to: f64,
}

/// What is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Keep {
    /// Arcs (dwells).
    Arcs,
    /// Arcs and straight lines.
    ArcsAndLines,
}

/// The parts of a stretch in order; a closed stretch starts at the start of a part.
fn parts(stretch: &Stretch<'_>, keep: Keep) -> Vec<Part> {
    let mut out: Vec<Part> = Vec::new();
    for span in &stretch.spans {
        let shape = match stretch.curve.shape(span.index) {
            Shape::Line if keep == Keep::Arcs => Shape::General,
            shape => shape,
        };
        let (from, to) = (stretch.samples[span.samples.0].s, stretch.samples[span.samples.1].s);
        match out.last_mut() {
            Some(last) if same(last.shape, shape) => last.to = to,
            _ => out.push(Part { shape, from, to }),
        }
    }
    if stretch.closed
        && out.len() > 1
        && let (Some(first), Some(last)) = (out.first().copied(), out.last().copied())
        && same(first.shape, last.shape)
    {
        let end = out.len() - 1;
        out[end].to = first.to + stretch.length();
        out.remove(0);
    }
    out
}

fn same(a: Shape, b: Shape) -> bool {
    match (a, b) {
        (Shape::General, Shape::General) | (Shape::Line, Shape::Line) => true,
        (Shape::Arc { centre: c, radius: r, ccw: w }, Shape::Arc { centre: d, radius: s, ccw: v }) => {
            (c - d).norm() < SAME && (r - s).abs() < SAME && w == v
        }
        _ => false,
    }
}

/// Whether the stretch has a span that would be kept, and whether it has nothing else.
pub(super) fn kept(stretch: &Stretch<'_>, keep: Keep) -> (bool, bool) {
    let parts = parts(stretch, keep);
    let general = |p: &Part| matches!(p.shape, Shape::General);
    (parts.iter().any(|p| !general(p)), !parts.iter().any(general))
}

/// A chain with the kept spans as members of their own, and what lies between spread by `density`, `unit` of which
/// is one arc. `None` when it is a single closed part.
pub(super) fn chain(
    stretch: &Stretch<'_>,
    density: &Density,
    unit: f64,
    band: &Band,
    keep: Keep,
) -> Option<Chain> {
    let middle = band.middle;
    // Where the curve itself is at the edge of the band, a concentric arc just inside it is kept.
    let level = 0.0_f64.clamp(middle - INSIDE * band.half, middle + INSIDE * band.half);
    let parts = parts(stretch, keep);
    if stretch.closed && parts.len() < 2 {
        return None;
    }
    let mut joints: Vec<Joint> = Vec::new();
    let mut members = Vec::new();
    for (i, part) in parts.iter().enumerate() {
        let before = if i > 0 { parts.get(i - 1) } else { parts.last().filter(|_| stretch.closed) };
        joints.push(boundary(stretch, before, Some(part), part.from, level, middle));
        match part.shape {
            Shape::Arc { centre, ccw, .. } => members.push(Member::Exact { centre, ccw }),
            Shape::Line => members.push(Member::Line),
            Shape::General => {
                let (a, b) = (density.share(stretch, part.from), density.share(stretch, part.to));
                let n = ((b - a) * density.total() / unit).floor().max(1.0) as usize;
                for j in 1..n {
                    let s = density.station(stretch, a + (b - a) * j as f64 / n as f64);
                    joints.push(Joint::on(stretch, s, middle, Hold::Free));
                }
                members.extend(std::iter::repeat_n(Member::Arc(0.0), n));
            }
        }
    }
    if !stretch.closed {
        joints.push(boundary(stretch, parts.last(), None, stretch.length(), level, middle));
    }
    let mut chain = Chain { joints, members, closed: stretch.closed };
    natural_halves(&mut chain);
    Some(chain)
}

/// The joint between two parts at station `s`.
fn boundary(
    stretch: &Stretch<'_>,
    before: Option<&Part>,
    after: Option<&Part>,
    s: f64,
    level: f64,
    middle: f64,
) -> Joint {
    let circle = |part: Option<&Part>| match part.map(|p| p.shape) {
        Some(Shape::Arc { centre, .. }) => Some(centre),
        _ => None,
    };
    let general = |part: Option<&Part>| part.is_some_and(|p| matches!(p.shape, Shape::General));
    let room = |part: Option<&Part>| part.map_or(0.0, |p| OVERHANG * (p.to - p.from).min(10.0));
    match (circle(before), circle(after)) {
        (Some(centre), None) if general(after) => {
            let hold = Hold::Circle { centre, from: s, to: f64::INFINITY };
            Joint::on(stretch, s, level, hold).slid(stretch, s + room(after))
        }
        (None, Some(centre)) if general(before) => {
            let hold = Hold::Circle { centre, from: f64::NEG_INFINITY, to: s };
            Joint::on(stretch, s, level, hold).slid(stretch, s - room(before))
        }
        (None, None) if before.is_some() && after.is_some() => {
            let line = |part: Option<&Part>| part.is_some_and(|p| matches!(p.shape, Shape::Line));
            Joint::on(stretch, s, if line(before) || line(after) { level } else { middle }, Hold::Free)
        }
        _ => Joint::on(stretch, s, level, Hold::Point),
    }
}
