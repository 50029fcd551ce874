//! Passes of cutters with a flat or a cone: their axis runs over lines in plan, and they are let down everywhere.
//!
//! Where such a cutter touches may leap over the surface from one place to the next; so passes are spread in plan,
//! no farther apart than the step asked for or the ridges between them allow ([`super::apart`]), and go on beyond the edges
//! where the far side of the cutter cuts.

use std::sync::Arc;

use super::apart::Apart;
use super::family::{LINK, Leg};
use super::outline::{self, crossings};
use crate::geom::surface::{Cutter, Guide, Rim, SurfaceTree, Track};
use crate::geom::{Point2, Point3, Vec2};
use crate::ir::{Along, Band, Spacing, Surface};
use crate::math::count;
use crate::plan::closer::Shares;

/// Places on an edge of the outline.
const EDGE: u32 = 200;
/// Places across and along at which the plan's width is measured.
const ACROSS: usize = 256;
const ALONG: u32 = 24;
/// More passes than this are a mistake in the step.
const MOST: f64 = 50_000.0;
/// Passes begin so far inside the outline, as a share of its width: at its border it has no length.
const INSET: f64 = 1e-3;
/// Vertices may be to the side of their line by this share of the step, and of the distance to the next pass where the
/// height of cusps is asked for.
const ASIDE: (f64, f64) = (0.05, 0.02);
/// Where a pass ends because the cutter touches nothing more, it ends so much earlier, mm: on the control's grid it touches
/// still.
const SHORT: f64 = 0.005;
/// Places at which that is told.
const ROOMS: usize = 17;

/// The passes of an operation in this making.
struct Lanes {
    tree: Arc<SurfaceTree>,
    cutter: Cutter,
    rim: Rim,
}

/// A pass and the room beside it, mm.
type Lane = (Track, f64);

/// The cutter with a hull to the middle of its band, and the band about that: the exact track then has a round corner
/// and a normal everywhere.
pub(super) fn within(cutter: &Cutter, leave: f64, band: Band) -> (Cutter, Band) {
    // A sharp rim has no hull inside of itself.
    let into = band.into.min(band.out + cutter.corner() + leave);
    let half = 0.5 * (band.out + into);
    (cutter.grown(leave + half - into), Band { into: half, out: half })
}

/// All passes and the ways between them, in the order they are cut, for a cutter with this hull about it.
pub(super) fn legs(
    surface: &Surface,
    tree: &Arc<SurfaceTree>,
    (hull, bare): (Cutter, &Cutter),
    shares: &Shares,
) -> Result<Vec<Leg>, String> {
    let lanes = Lanes { tree: Arc::clone(tree), cutter: hull, rim: Rim::new(tree.net(), &hull) };
    let apart = match surface.spacing {
        Spacing::Step(step) => Steps::Even(step),
        Spacing::Cusp(cusp) => Steps::Apart(Apart {
            hull,
            bare: *bare,
            by: hull.corner() - bare.corner(),
            cusp,
            shares: shares.clone(),
        }),
    };
    let mut tracks = match surface.along {
        Along::X => lanes.lines(0, &apart)?,
        Along::Y => lanes.lines(1, &apart)?,
        Along::V => lanes.parameters(1, &apart)?,
        Along::U | Along::IsoCusp | Along::Const => lanes.parameters(0, &apart)?,
    };
    if tracks.is_empty() {
        return Err("no pass meets the surface".into());
    }
    if surface.zigzag {
        for (track, _) in tracks.iter_mut().skip(1).step_by(2) {
            *track = track.reversed();
        }
    }
    let mut legs: Vec<Leg> = Vec::with_capacity(2 * tracks.len());
    for (track, room) in tracks {
        let before = legs.last_mut().filter(|_| surface.zigzag);
        let link = before.and_then(|before| lanes.link(&before.track, &track));
        if let Some(before) = legs.last_mut() {
            before.last = link.is_none();
        }
        legs.extend(link.map(|track| Leg { track, room: Vec::new(), link: true, last: false }));
        let room = if matches!(track.guide, Guide::Line { .. }) { Vec::new() } else { vec![room; ROOMS] };
        legs.push(Leg { track, room, link: false, last: false });
    }
    if let Some(end) = legs.last_mut() {
        end.last = true;
    }
    Ok(legs)
}

/// How far passes lie apart.
enum Steps {
    /// By no more than so much, mm.
    Even(f64),
    /// By what the ridges between them allow.
    Apart(Apart),
}

impl Steps {
    /// Passes over a width, mm, each with its room.
    fn over(&self, width: f64, make: &dyn Fn(f64) -> Option<Track>) -> Result<Vec<Lane>, String> {
        match self {
            Steps::Even(step) => {
                let wanted = (width / step).ceil().max(1.0);
                if wanted.is_nan() || wanted > MOST {
                    return Err(format!("this step asks for more than {MOST} passes"));
                }
                // At most MOST, and floats saturate.
                let passes = wanted as usize;
                let lane = |k: usize| Some((make(width * count(k) / count(passes))?, ASIDE.0 * step));
                Ok((0..=passes).filter_map(lane).collect())
            }
            Steps::Apart(apart) => {
                let passes = apart.march(width, make)?;
                let places: Vec<f64> = passes.iter().map(|(at, _)| *at).collect();
                let least = |k: usize| {
                    let near = places.get(k.saturating_sub(1)..(k + 2).min(places.len())).unwrap_or_default();
                    near.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min).min(width)
                };
                let lane = |(k, (_, track)): (usize, (f64, Track))| (track, ASIDE.1 * least(k));
                Ok(passes.into_iter().enumerate().map(lane).collect())
            }
        }
    }
}

impl Lanes {
    fn track(&self, guide: Guide) -> Track {
        Track { tree: Arc::clone(&self.tree), radius: self.cutter.corner(), cutter: self.cutter, guide }
    }

    /// Straight lines along x (0) or y (1).
    fn lines(&self, axis: usize, steps: &Steps) -> Result<Vec<Lane>, String> {
        let outline = self.rim.outline(self.tree.net(), EDGE);
        let across = outline.iter().map(|p| p[1 - axis]);
        let (low, high) = across.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        let inset = INSET * (high - low);
        let (low, high) = (low + inset, high - inset);
        let line = |beyond: f64| {
            let across = low + beyond;
            let (a, b) = crossings(&outline, axis, across)?;
            let place =
                |along: f64| if axis == 0 { Point2::new(along, across) } else { Point2::new(across, along) };
            self.held(place(a), place(b))
        };
        Ok(steps.over(high - low, &line)?.into_iter().flat_map(|lane| self.stretches(lane)).collect())
    }

    /// A line, cut back to where the cutter touches at both ends; between them it may lose the surface.
    fn held(&self, from: Point2, to: Point2) -> Option<Track> {
        const PARTS: usize = 32;
        let all = self.touching(from, to, PARTS);
        self.part((from, to), (all.first()?.0, all.last()?.1))
    }

    /// The stretches of a line on which the cutter touches, looked at closely.
    fn stretches(&self, (track, room): Lane) -> Vec<Lane> {
        let Guide::Line { from, to } = track.guide else { return vec![(track, room)] };
        let all = self.touching(from, to, self.close(from, to));
        all.into_iter().filter_map(|range| Some((self.part((from, to), range)?, room))).collect()
    }

    /// Steps in which it is looked at closely whether the cutter touches.
    fn close(&self, from: Point2, to: Point2) -> usize {
        const CLOSE: f64 = 0.1;
        const MOST: usize = 4096;
        crate::math::ceil_to_usize((to - from).norm() / (CLOSE * self.cutter.radius())).clamp(1, MOST)
    }

    /// The shares of a line on which the cutter touches.
    fn touching(&self, from: Point2, to: Point2, parts: usize) -> Vec<(f64, f64)> {
        let mut hint = None;
        outline::held(parts, &mut |t| {
            let p = from + (to - from) * t;
            let found = self.cutter.drop(&self.tree, p.x, p.y, hint.as_ref());
            hint = found.or(hint);
            found.is_some()
        })
    }

    /// The part of a line on which the cutter touches, and a little less where that ends before the line does.
    fn part(&self, (from, to): (Point2, Point2), (a, b): (f64, f64)) -> Option<Track> {
        const LEAST: f64 = 1e-3;
        let length = (to - from).norm();
        let short = SHORT / length.max(SHORT);
        let (a, b) = (if a > 0.0 { a + short } else { a }, if b < 1.0 { b - short } else { b });
        let at = |t: f64| from + (to - from) * t;
        (length * (b - a) > LEAST).then(|| self.track(Guide::Line { from: at(a), to: at(b) }))
    }

    /// Lines over parameter lines along u (0) or v (1), and over the rim.
    fn parameters(&self, axis: usize, steps: &Steps) -> Result<Vec<Lane>, String> {
        let net = self.tree.net();
        let (range, (first, last)) = (self.rim.range(net, axis), self.rim.range(net, 1 - axis));
        let across = |k: usize| first + (last - first) * count(k) / count(ACROSS);
        let place = |k: usize, i: u32| {
            let along = range.0 + (range.1 - range.0) * f64::from(i) / f64::from(ALONG);
            self.rim.place(net, if axis == 0 { [along, across(k)] } else { [across(k), along] })
        };
        let widest =
            |k: usize| (0..=ALONG).map(|i| (place(k + 1, i) - place(k, i)).norm()).fold(0.0, f64::max);
        let mut sums = vec![0.0];
        for k in 0..ACROSS {
            sums.push(sums[k] + widest(k));
        }
        let track = |wanted: f64| {
            let k = sums.partition_point(|s| *s < wanted).clamp(1, ACROSS);
            let width = sums[k] - sums[k - 1];
            let share = if width > 0.0 { ((wanted - sums[k - 1]) / width).clamp(0.0, 1.0) } else { 0.0 };
            let value = across(k - 1) + (across(k) - across(k - 1)) * share;
            Some(self.track(Guide::Over { axis, value, range, rim: self.rim }))
        };
        steps.over(sums[ACROSS], &track)
    }

    /// The way from the end of one pass to the start of the next, along the surface.
    fn link(&self, from: &Track, to: &Track) -> Option<Track> {
        match (&from.guide, &to.guide) {
            (Guide::Line { to: end, .. }, Guide::Line { from: start, .. }) => {
                let near = (start - end).norm() <= LINK * self.cutter.radius();
                let follows = || self.touching(*end, *start, self.close(*end, *start)) == [(0.0, 1.0)];
                (near && follows()).then(|| self.track(Guide::Line { from: *end, to: *start }))
            }
            (
                Guide::Over { axis, value, range: (_, end), rim },
                Guide::Over { value: next, range: (start, _), .. },
            ) if end == start => {
                let guide = Guide::Over { axis: 1 - axis, value: *end, range: (*value, *next), rim: *rim };
                Some(self.track(guide))
            }
            _ => None,
        }
    }
}

/// Points of the cutter's reference on its way onto a track are clear of the surface, from the first on.
pub(super) fn clear(track: &Track, points: &[Point3]) -> bool {
    let corner = track.cutter.corner();
    points
        .windows(2)
        .all(|w| track.tree.near(&track.cutter, (w[0], w[1]), corner, 1e-9, None).certain >= corner)
}

/// A place where a cutter cannot be set down.
pub(super) struct Spot {
    /// How deep it would go into the surface elsewhere, mm.
    pub depth: f64,
    /// The place.
    pub at: Point3,
    /// Its net parameters.
    pub uv: [f64; 2],
}

/// Of many places, that where a cutter set on the surface would go deepest into it elsewhere.
pub(super) fn deepest(tree: &SurfaceTree, cutter: &Cutter) -> Option<Spot> {
    const PLACES: u32 = 20;
    /// Less is far below every tolerance, mm.
    const COUNTS: f64 = 1e-4;
    let (net, corner) = (tree.net(), cutter.corner());
    let size = net.size().map(count);
    let mut worst: Option<Spot> = None;
    for k in 0..(PLACES + 1) * (PLACES + 1) {
        let [i, j] = [k / (PLACES + 1), k % (PLACES + 1)].map(|i| f64::from(i) / f64::from(PLACES));
        let uv = [size[0] * i, size[1] * j];
        let jet = net.jet(uv[0], uv[1]);
        let Some(n) = jet.normal() else { continue };
        let beside = cutter.touches_beside(Vec2::new(n.x, n.y));
        let reference = Point3::new(jet.p.x + beside.x, jet.p.y + beside.y, jet.p.z + corner * n.z);
        let foot = tree.near(cutter, (reference, reference), corner, COUNTS, None);
        let depth = corner - foot.distance;
        if depth > worst.as_ref().map_or(COUNTS, |w| w.depth) {
            worst = Some(Spot { depth, at: jet.p, uv });
        }
    }
    worst
}
