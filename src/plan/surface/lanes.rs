//! Passes of cutters with a flat or a cone: their axis runs over lines in plan, and they are let down everywhere.
//!
//! Where such a cutter touches may leap over the surface from one place to the next; so passes are spread in plan,
//! no farther apart than the step asked for or the ridges between them allow ([`super::apart`]), and go on beyond the edges
//! where the far side of the cutter cuts.

use std::sync::Arc;

use rayon::prelude::*;

use super::apart::Apart;
use super::bends::{self, Making, Passes};
use super::family::{LINK, Leg, runs};
use super::outline::{self, Outline};
use super::scale::Scale;
use crate::cl::{March, Over};
use crate::geom::surface::{Cutter, Guide, Rim, SurfaceTree, Track};
use crate::geom::{Point2, Point3};
use crate::ir::{Along, Band, Spacing, Surface};
use crate::math::count;
use crate::plan::closer::Shares;

/// Places on an edge of the outline.
const EDGE: u32 = 200;
/// More passes than this are a mistake in the step.
const MOST: f64 = 50_000.0;
/// Passes begin so far inside the outline, mm, or as a share of its width where it is shorter there than this share of the
/// cutter's radius.
const INSET: (f64, f64, f64) = (2e-3, 1e-3, 0.1);
/// Vertices may be to the side of their line by this share of the step, and of the distance to the next pass where the
/// height of cusps is asked for.
const ASIDE: (f64, f64) = (0.05, 0.02);
/// The same for passes that bend.
const BENT: f64 = 0.04;
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

/// A pass.
struct Lane {
    track: Track,
    /// As [`crate::cl::Pass::room`].
    room: Vec<f64>,
    /// About how long it is, mm, where that was found out.
    length: f64,
}

/// The cutter with a hull to the middle of its band, and the band about that: the exact track then has a round corner
/// and a normal everywhere.
pub(super) fn within(cutter: &Cutter, leave: f64, band: Band) -> (Cutter, Band) {
    // A sharp rim has no hull inside of itself.
    let into = band.into.min(band.out + cutter.corner() + leave);
    let half = 0.5 * (band.out + into);
    (cutter.grown(leave + half - into), Band { into: half, out: half })
}

/// All passes and the ways between them, in the order they are cut, for a cutter with this hull about it; those that bend follow
/// one another as known, or as is found to be best.
pub(super) fn legs(
    surface: &Surface,
    tree: &Arc<SurfaceTree>,
    (hull, bare): (Cutter, &Cutter),
    shares: &Shares,
    march: &mut Option<March>,
) -> Result<Vec<Leg>, String> {
    let bends = matches!(surface.along, Along::IsoCusp | Along::Const);
    let lanes = Lanes { tree: Arc::clone(tree), cutter: hull, rim: Rim::new(tree.net(), &hull, bends) };
    let apart = |cusp: f64| Apart {
        hull,
        bare: *bare,
        by: hull.corner() - bare.corner(),
        cusp,
        shares: shares.clone(),
    };
    let steps = || match surface.spacing {
        Spacing::Step(step) => Steps::Even(step),
        Spacing::Cusp(cusp) => Steps::Apart(apart(cusp)),
    };
    let chains = match surface.along {
        Along::IsoCusp | Along::Const => {
            let (cusp, step) = match surface.spacing {
                Spacing::Step(step) => (step, Some(step)),
                Spacing::Cusp(cusp) => (cusp, None),
            };
            let known = if let Some(March::Over(over)) = march { Some(*over) } else { None };
            let (over, chains) = lanes.bent(&apart(cusp), (step, surface.along == Along::Const), known)?;
            *march = Some(March::Over(over));
            chains
        }
        straight => vec![lanes.straight(straight, &steps())?],
    };
    let mut legs: Vec<Leg> = Vec::new();
    for chain in chains {
        lanes.chain(chain, surface.zigzag, &mut legs);
    }
    if legs.is_empty() { Err("no pass meets the surface".into()) } else { Ok(legs) }
}

/// Chains of passes, and their length in all, mm.
type Chains = (f64, Vec<Vec<Lane>>);

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
                let lane =
                    |k: usize| Some(lane(make(width * count(k) / count(passes))?, ASIDE.0 * step, 0.0));
                Ok((0..=passes).filter_map(lane).collect())
            }
            Steps::Apart(apart) => {
                let passes = apart.march(width, make)?;
                let places: Vec<f64> = passes.iter().map(|(at, ..)| *at).collect();
                let least = |k: usize| {
                    let near = places.get(k.saturating_sub(1)..(k + 2).min(places.len())).unwrap_or_default();
                    near.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min).min(width)
                };
                let lane = |(k, (_, track, length)): (usize, (f64, Track, f64))| {
                    lane(track, ASIDE.1 * least(k), length)
                };
                Ok(passes.into_iter().enumerate().map(lane).collect())
            }
        }
    }
}

/// Finds something of passes over a width, mm, given what lays one at a place.
type Finder<'a, T> = dyn Fn(f64, &dyn Fn(f64) -> Option<Track>) -> Result<T, String> + 'a;

/// A pass with the same room everywhere; straight ones stay in their plane.
fn lane(track: Track, room: f64, length: f64) -> Lane {
    let room = if matches!(track.guide, Guide::Line { .. }) { Vec::new() } else { vec![room; ROOMS] };
    Lane { track, room, length }
}

impl Lanes {
    /// The passes of one chain, and the ways between them.
    fn chain(&self, chain: Vec<Lane>, zigzag: bool, legs: &mut Vec<Leg>) {
        for (k, Lane { mut track, mut room, .. }) in chain.into_iter().enumerate() {
            if zigzag && k % 2 == 1 {
                track = track.reversed();
                room.reverse();
            }
            let before = legs.last_mut().filter(|_| zigzag && k > 0);
            let link = before.and_then(|before| self.link(&before.track, &track));
            if let Some(before) = legs.last_mut() {
                before.last = link.is_none();
            }
            legs.extend(link.map(|track| Leg { track, room: Vec::new(), link: true, last: false }));
            legs.push(Leg { track, room, link: false, last: false });
        }
        if let Some(end) = legs.last_mut() {
            end.last = true;
        }
    }

    /// Passes along parameters, or in planes.
    fn straight(&self, along: Along, steps: &Steps) -> Result<Vec<Lane>, String> {
        match along {
            Along::X => self.lines(0, steps),
            Along::Y => self.lines(1, steps),
            Along::V => self.parameters(1, steps),
            _ => self.parameters(0, steps),
        }
    }

    /// The shortest way of passes that bend, in chains of such that lie side by side; passes as far apart as ridges allow may
    /// be straight, too. Which come into question is tried out with higher ridges, unless it is known; with the passes, what
    /// their axis runs over.
    fn bent(
        &self,
        apart: &Apart,
        (step, even): (Option<f64>, bool),
        known: Option<Over>,
    ) -> Result<(Over, Vec<Vec<Lane>>), String> {
        const BENT: [Over; 2] = [Over::Bent(0), Over::Bent(1)];
        const STRAIGHT: [Over; 4] = [
            Over::Straight(Along::U),
            Over::Straight(Along::V),
            Over::Straight(Along::X),
            Over::Straight(Along::Y),
        ];
        /// Straight ways are looked at that are no longer than so many times the bent one.
        const NEARLY: f64 = 1.02;
        let making = Making { tree: &self.tree, cutter: self.cutter, rim: self.rim, apart, step, even };
        let passes = |way: Over| -> Result<Chains, String> {
            match way {
                Over::Straight(along) => {
                    let lanes = self.straight(along, &Steps::Apart(apart.coarser(1.0)))?;
                    Ok((lanes.iter().map(|lane| lane.length).sum(), vec![lanes]))
                }
                Over::Bent(axis) => {
                    making.passes(axis).map(|passes| (passes.length, self.curves(&passes, step)))
                }
            }
        };
        if let Some(way) = known
            && let Ok((_, chains)) = passes(way)
        {
            return Ok((way, chains));
        }
        let coarse = apart.coarser(bends::TRIAL);
        let straight: &[Over] = if even || step.is_some() { &[] } else { &STRAIGHT };
        let tried = |way: &Over| {
            let length = match *way {
                Over::Straight(along) => self.length(along, &coarse),
                Over::Bent(axis) => making.tried(axis, &coarse),
            };
            (length.unwrap_or(f64::INFINITY), *way)
        };
        let ways: Vec<&Over> = BENT.iter().chain(straight).collect();
        let tried: Vec<(f64, Over)> = ways.into_par_iter().map(tried).collect();
        let (bent, straight) = tried.split_at(BENT.len());
        let bent = if bent[1].0 < bent[0].0 * (1.0 - 1e-6) { bent[1] } else { bent[0] };
        let least = straight.iter().map(|way| way.0).fold(bent.0, f64::min);
        let most = NEARLY * if bent.0.is_finite() { bent.0 } else { least };
        let near = straight.iter().filter(|way| way.0 <= most);
        let ways: Vec<Over> = core::iter::once(&bent).chain(near).map(|way| way.1).collect();
        let found: Vec<(Over, Result<Chains, String>)> =
            ways.into_par_iter().map(|way| (way, passes(way))).collect();
        let mut best: Option<(Over, Chains)> = None;
        let mut why = None;
        for (way, chains) in found {
            match chains {
                // Of ways of the same length the first.
                Ok(chains) if best.as_ref().is_none_or(|b| chains.0 < b.1.0 * (1.0 - 1e-6)) => {
                    best = Some((way, chains));
                }
                Ok(_) => {}
                Err(reason) => why = why.or(Some(reason)),
            }
        }
        if best.is_none()
            && let Some((_, way)) = straight.iter().min_by(|a, b| a.0.total_cmp(&b.0))
        {
            best = passes(*way).ok().map(|chains| (*way, chains));
        }
        best.map(|(way, (_, chains))| (way, chains))
            .ok_or_else(|| why.unwrap_or_else(|| "no pass meets the surface".into()))
    }

    /// How long straight passes are in all, mm.
    fn length(&self, along: Along, apart: &Apart) -> Result<f64, String> {
        let length = |(width, make): (f64, &dyn Fn(f64) -> Option<Track>)| -> Result<f64, String> {
            Ok(apart.march(width, make)?.iter().map(|pass| pass.2).sum())
        };
        match along {
            Along::X => self.over_lines(0, &|width, make| length((width, make))),
            Along::Y => self.over_lines(1, &|width, make| length((width, make))),
            Along::V => self.over_parameters(1, &|width, make| length((width, make))),
            _ => self.over_parameters(0, &|width, make| length((width, make))),
        }
    }

    /// Bent passes as they are cut.
    fn curves(&self, passes: &Passes, step: Option<f64>) -> Vec<Vec<Lane>> {
        let share = if step.is_some() { ASIDE.0 } else { BENT };
        let runs: Vec<Vec<(usize, usize)>> =
            passes.places.iter().map(|places| runs(places, Option::is_some)).collect();
        let lane = |&(line, k): &(usize, usize)| -> Option<Lane> {
            let (from, to) = runs[line][k];
            let places: Vec<Point2> = passes.places[line][from..=to].iter().copied().flatten().collect();
            let room = passes.room[line][from..=to].iter().map(|apart| share * apart).collect();
            Some(Lane { track: self.track(Guide::Plan(Arc::new(places))), room, length: 0.0 })
        };
        // Runs that lie side by side have a column in common.
        let ranges: Vec<Vec<(f64, f64)>> = runs
            .iter()
            .map(|line| line.iter().map(|(from, to)| (count(*from), count(to + 1))).collect())
            .collect();
        let chains = outline::chained(&ranges);
        chains.iter().map(|chain| chain.iter().filter_map(lane).collect()).collect()
    }

    fn track(&self, guide: Guide) -> Track {
        Track { tree: Arc::clone(&self.tree), radius: self.cutter.corner(), cutter: self.cutter, guide }
    }

    /// Straight lines along x (0) or y (1).
    fn lines(&self, axis: usize, steps: &Steps) -> Result<Vec<Lane>, String> {
        let lanes = self.over_lines(axis, &|width, make| steps.over(width, make))?;
        Ok(lanes.into_iter().flat_map(|lane| self.stretches(lane)).collect())
    }

    /// What is found for a width and the lines over it.
    fn over_lines<T>(&self, axis: usize, find: &Finder<'_, T>) -> Result<T, String> {
        let outline = Outline::new(axis, self.rim.outline(self.tree.net(), EDGE));
        let (low, high) = outline.width();
        let far = INSET.1 * (high - low);
        let inset = |at: &dyn Fn(f64) -> f64| {
            let near = INSET.0.min(far);
            let long =
                outline.crossings(at(near)).is_some_and(|(a, b)| b - a > INSET.2 * self.cutter.radius());
            if long { at(near) } else { at(far) }
        };
        let (low, high) = (inset(&|by| low + by), inset(&|by| high - by));
        let line = |beyond: f64| {
            let across = low + beyond;
            let (a, b) = outline.crossings(across)?;
            let place =
                |along: f64| if axis == 0 { Point2::new(along, across) } else { Point2::new(across, along) };
            self.held(place(a), place(b))
        };
        find(high - low, &line)
    }

    /// A line, cut back to where the cutter touches at both ends; between them it may lose the surface.
    fn held(&self, from: Point2, to: Point2) -> Option<Track> {
        const PARTS: usize = 32;
        let all = self.touching(from, to, PARTS);
        self.part((from, to), (all.first()?.0, all.last()?.1))
    }

    /// The stretches of a line on which the cutter touches, looked at closely.
    fn stretches(&self, lane: Lane) -> Vec<Lane> {
        let Guide::Line { from, to } = lane.track.guide else { return vec![lane] };
        let all = self.touching(from, to, self.close(from, to));
        let length = lane.length / count(all.len().max(1));
        let part = |range| {
            let track = self.part((from, to), range)?;
            Some(Lane { track, room: lane.room.clone(), length })
        };
        all.into_iter().filter_map(part).collect()
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
        self.over_parameters(axis, &|width, make| steps.over(width, make))
    }

    /// What is found for a width and the lines over it.
    fn over_parameters<T>(&self, axis: usize, find: &Finder<'_, T>) -> Result<T, String> {
        let net = self.tree.net();
        let (range, across) = (self.rim.range(net, axis), Scale::new(net, &self.rim, 1 - axis));
        let track = |wanted: f64| {
            let value = across.value(wanted);
            Some(self.track(Guide::Over { axis, value, range, rim: self.rim }))
        };
        find(across.width(), &track)
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
            (Guide::Plan(before), Guide::Plan(after)) => {
                let (end, start) = (*before.last()?, *after.first()?);
                let near = (start - end).norm() <= LINK * self.cutter.radius();
                let follows = || self.touching(end, start, self.close(end, start)) == [(0.0, 1.0)];
                (near && follows()).then(|| self.track(Guide::Line { from: end, to: start }))
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
        let reference = cutter.set_on(jet.p, n);
        let foot = tree.near(cutter, (reference, reference), corner, COUNTS, None);
        let depth = corner - foot.distance;
        if depth > worst.as_ref().map_or(COUNTS, |w| w.depth) {
            worst = Some(Spot { depth, at: jet.p, uv });
        }
    }
    worst
}
