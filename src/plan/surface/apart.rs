//! How far apart passes of cutters with a flat or a cone may lie for the height of the ridges between them.
//!
//! Between two passes the cutter is let down as if there were one more. What the two leave on the points it touches there
//! is the ridge: what a pass in between would take away. What no pass takes, because the cutter is too wide, is none. Where
//! too much was left before and the cutter leans on an edge, places just inside of it are asked about, too: it leaves the
//! edge at once, and a ridge there may lie between any places at which it is let down.
//! Each pass is put as far from the one before as its own ridge allows.

use rayon::prelude::*;

use crate::geom::surface::{Contact, Cutter, SurfaceTree, Track};
use crate::geom::{Point3, Vec2, Vec3, cross};
use crate::math::count;
use crate::plan::closer::Shares;

/// What distances are found for.
pub(super) struct Apart {
    /// The cutter with the hull its tracks have, and without.
    pub hull: Cutter,
    pub bare: Cutter,
    /// Thickness of the hull, mm.
    pub by: f64,
    /// Height of ridges, mm.
    pub cusp: f64,
    /// Where they must be lower.
    pub shares: Shares,
}

/// What a cutter is let down along.
pub(super) trait Course: Sync {
    /// The contact at a share of it.
    fn at(&self, share: f64, hint: Option<&Contact>) -> Option<Contact>;
    /// About how long it is, mm.
    fn length(&self) -> f64;
    /// Whether it may bend where its neighbours do not.
    fn bends(&self) -> bool;
    /// The surface.
    fn tree(&self) -> &SurfaceTree;
}

impl Course for Track {
    fn at(&self, share: f64, hint: Option<&Contact>) -> Option<Contact> {
        Track::at(self, share, hint)
    }
    fn length(&self) -> f64 {
        let ends = [0.0, 1.0].map(|t| Track::at(self, t, None).map(|c| c.centre));
        if let [Some(a), Some(b)] = ends { (b - a).norm() } else { 0.0 }
    }
    fn bends(&self) -> bool {
        false
    }
    fn tree(&self) -> &SurfaceTree {
        &self.tree
    }
}

/// A pass and where the cutter is on it.
pub(super) struct Lane<C> {
    /// Where it lies among the others, mm.
    at: f64,
    pub track: C,
    /// Places at which the cutter was let down.
    pub stations: Vec<Station>,
    /// The reference point's way, with chords that leave it by little; broken where nothing is touched.
    pub way: Vec<Point>,
    /// The cutter set on places just inside of edges on which it leans.
    insides: Vec<Inside>,
}

/// The cutter set on a place, with the surface's normal there.
struct Inside {
    touched: (Contact, Vec3),
    /// How far it is beside a station in plan, and the station's share of the pass.
    beside: Vec2,
    share: f64,
}

/// A point of the reference point's way, and the share of the pass at which it is.
pub(super) type Point = (f64, Option<Point3>);

/// A place of a pass, as a share of it.
#[derive(Clone, Copy)]
pub(super) struct Station {
    pub share: f64,
    pub contact: Option<Contact>,
}

/// Ridges are made so high, as a share of what is asked for: the rest is for what lies between the stations.
pub(super) const AIM: f64 = 0.87;
/// Ridges of this share of that are high enough.
const HIGH: f64 = 0.8;
/// Between passes the cutter is let down at so many places at least, and no farther apart than this share of its radius: where
/// it touches may leap.
const BETWEEN: (usize, f64) = (3, 0.12);
/// Attempts at the place of one pass.
const TRIES: u32 = 16;
/// Passes closer than this are too close, mm.
pub(super) const CLOSEST: f64 = 2e-3;
/// Stations of a pass at first, an even number, and their distance as a share of the radius.
const STATIONS: (usize, usize, f64) = (8, 400, 0.16);
/// Between stations a pass leaves its chord, or the cubic through its neighbours, upwards by no more than this share of the
/// height of ridges …
const STRAIGHT: f64 = 0.04;
/// … unless they were halved so often.
const DEEPEST: u32 = 5;
/// How much of what a bent pass leaves its chord by sideways counts.
const BESIDE: f64 = 0.2;
/// Where a cubic tells the way between two stations, it is followed by so many chords at most.
const CHORDS: f64 = 64.0;
/// Stations of all passes, tried ones included, before that is given up.
pub(super) const MOST: usize = 4_000_000;
/// Stations with a ridge of this share of the highest are looked at closer, if their neighbours have less.
const PEAK: f64 = 0.85;
/// Stations that share their hints.
const CHUNK: usize = 8;
/// The cutter leans on an edge where its normal there is farther from the surface's than this (the cosine between them).
const LEANS: f64 = 0.999;
/// Contacts nearer to an edge, in parameters, are at the edge.
const EDGE: f64 = 1e-6;
/// How far inside of the edge it is set on the surface, as shares of the height of ridges.
const INSIDES: [f64; 6] = [0.12, 0.2, 0.3, 0.45, 0.7, 1.0];

impl Apart {
    /// The same for ridges that are `factor` times as high.
    pub(super) fn coarser(&self, factor: f64) -> Apart {
        Apart { cusp: factor * self.cusp, shares: self.shares.clone(), ..*self }
    }

    /// Passes over a width, mm, each with its place and length; `make` lays the pass at a place.
    pub(super) fn march(
        &self,
        width: f64,
        make: &dyn Fn(f64) -> Option<Track>,
    ) -> Result<Vec<(f64, Track, f64)>, String> {
        const FIRST: usize = 1000;
        let first = (0..FIRST).map(|k| width * count(k) / count(FIRST)).find_map(|at| Some((at, make(at)?)));
        let Some((at, track)) = first else { return Ok(Vec::new()) };
        let mut last = self.lane(at, track, None);
        let mut step = 2.0 * (2.0 * self.hull.radius() * self.cusp).sqrt();
        let (mut passes, mut spent) = (Vec::new(), 0);
        loop {
            let mut next = |insides: bool| self.next(&last, (width, step), make, (insides, &mut spent));
            // How passes leave edges is told by few places of theirs: no passes are refused for that.
            let Some((lane, next)) = next(true).or_else(|_| next(false))? else { break };
            let length = last.length();
            passes.push((last.at, last.track, length));
            (last, step) = (lane, next);
        }
        let length = last.length();
        passes.push((last.at, last.track, length));
        Ok(passes)
    }

    /// The widest that passes are put apart, mm: beyond that their flats could leave a strip that neither covers.
    pub(super) fn widest(&self) -> f64 {
        1.6 * self.hull.flat() + 2.0 * (2.0 * self.hull.corner() * self.cusp).sqrt()
    }

    /// The pass after one, and the step it took; `None` after the last.
    fn next(
        &self,
        last: &Lane<Track>,
        (width, step): (f64, f64),
        make: &dyn Fn(f64) -> Option<Track>,
        (insides, spent): (bool, &mut usize),
    ) -> Result<Option<(Lane<Track>, f64)>, String> {
        let rest = (width - last.at).min(self.widest());
        if width - last.at <= CLOSEST {
            return Ok(None);
        }
        let (mut good, mut bad) = (0.0, f64::INFINITY);
        let mut best = None;
        let mut lost = false;
        let mut step = step.min(rest);
        for _ in 0..TRIES {
            let Some(track) = make(last.at + step) else {
                (lost, bad) = (true, step);
                step = 0.5 * (good + step);
                continue;
            };
            lost = false;
            let lane = self.lane(last.at + step, track, Some(last));
            *spent += lane.stations.len();
            let inside = if insides { highest(&self.inside(last, &lane)) } else { 0.0 };
            let ridge = self.ridge((last, &lane), inside, make, spent);
            if ridge <= AIM * self.cusp {
                (good, best) = (step, Some(lane));
                if ridge >= HIGH * AIM * self.cusp || step >= rest {
                    break;
                }
            } else {
                bad = step;
            }
            if bad < 1.1 * good || bad < CLOSEST {
                break;
            }
            let share = (0.5 * (1.0 + HIGH) * AIM * self.cusp / ridge.max(1e-9)).clamp(0.0, 8.0);
            let wanted = step * crate::math::pow(share, 0.6).clamp(0.2, 2.0);
            step = if bad.is_finite() {
                wanted.clamp(0.9 * good + 0.1 * bad, 0.1 * good + 0.9 * bad)
            } else {
                wanted
            };
            step = step.min(rest);
            if *spent > MOST {
                return Err(format!("this height of cusps asks for too many passes: {}", self.place(last)));
            }
        }
        match best {
            Some(lane) => Ok(Some((lane, good))),
            None if lost => Ok(None),
            None => Err(format!("no distance of passes keeps this height of cusps: {}", self.place(last))),
        }
    }

    /// Where a pass is, in words.
    pub(super) fn place<C>(&self, lane: &Lane<C>) -> String {
        let middle = lane.contact(0.5);
        middle.map_or_else(String::new, |c| {
            format!(
                "they would lie {:.3} mm or less apart about X {:.3}, Y {:.3} mm",
                CLOSEST, c.centre.x, c.centre.y
            )
        })
    }

    /// A pass with its stations; `beside`: a pass near by.
    pub(super) fn lane<C: Course>(&self, at: f64, track: C, beside: Option<&Lane<C>>) -> Lane<C> {
        let mut stations = self.stations(&track, beside);
        let (mut way, mut more): (Vec<Point>, Vec<Station>) = Default::default();
        let last = stations.len() - 1;
        let kept: Vec<bool> = (0..last / 2).map(|k| self.is_smooth(&stations, 2 * k)).collect();
        for (k, smooth) in kept.iter().enumerate() {
            for i in 2 * k..2 * k + 2 {
                let (from, to) = (stations[i], stations[i + 1]);
                way.push(from.point());
                if *smooth {
                    self.follow(&stations, i, track.bends(), &mut way);
                } else {
                    let first = more.len();
                    self.between(&track, (from, to), 1, &mut more);
                    way.extend(more[first..].iter().map(Station::point));
                }
            }
        }
        way.push(stations[last].point());
        let inside = |station: &Station| self.insides(track.tree(), station);
        let insides = stations.par_iter().flat_map_iter(inside).collect();
        stations.extend(more);
        Lane { at, track, stations, way, insides }
    }

    /// Places just inside of the edge on which the cutter leans at a station, where it can be set on them and ridges must be
    /// lower than elsewhere.
    fn insides(&self, tree: &SurfaceTree, station: &Station) -> Vec<Inside> {
        let Some(leaning) = station.contact else { return Vec::new() };
        let foot = leaning.foot;
        if self.shares.share(foot.point) >= 1.0 {
            return Vec::new();
        }
        let Some(patch) = tree.net().patches().get(foot.patch) else { return Vec::new() };
        let edge = patch.jet(foot.uv[0], foot.uv[1]);
        if edge.normal().is_none_or(|n| n.dot(&leaning.normal) > LEANS) {
            return Vec::new();
        }
        let set = |uv: [f64; 2]| {
            let jet = patch.jet(uv[0], uv[1]);
            let n = jet.normal()?;
            let at = self.hull.set_on(jet.p, n);
            let rest = self.hull.drop(tree, at.x, at.y, Some(&leaning))?;
            let settles = rest.centre.z <= at.z + STRAIGHT * self.cusp;
            let beside = (rest.centre - leaning.centre).xy();
            settles.then_some(Inside { touched: (rest, n), beside, share: station.share })
        };
        let mut found = Vec::new();
        for (axis, along) in [edge.u, edge.v].iter().enumerate() {
            let inwards = match foot.uv[axis] {
                t if t <= EDGE => 1.0,
                t if t >= 1.0 - EDGE => -1.0,
                _ => continue,
            };
            let away = |share: &f64| {
                let mut uv = foot.uv;
                uv[axis] += inwards * (share * self.cusp / along.norm()).min(1.0);
                set(uv)
            };
            found.extend(INSIDES.iter().filter_map(away));
        }
        found
    }

    /// What two passes leave just inside of edges on which they lean, where a pass between them would take it, by its share.
    pub(super) fn inside<C: Course>(&self, a: &Lane<C>, b: &Lane<C>) -> Vec<(f64, f64)> {
        let left = |inside: &Inside| {
            let (place, share) = (inside.touched.0.centre, inside.share);
            let near = |lane: &Lane<C>| lane.way[lane.nearest(place, share)].1;
            let (from, to) = (near(a)?.xy(), near(b)?.xy());
            let (across, gone) = (to - from, place.xy() - from);
            let between = (0.0..across.norm_squared()).contains(&gone.dot(&across));
            // Over an edge that lies across them, passes come to such places by themselves.
            let beside = inside.beside.dot(&across).abs() >= cross(inside.beside, across).abs();
            (between && beside).then(|| (share, self.adds([Some(a), Some(b)], &inside.touched, share)))
        };
        let all: Vec<&Inside> = a.insides.iter().chain(&b.insides).collect();
        all.par_iter().filter_map(|inside| left(inside)).collect()
    }

    /// An odd number of stations at equal distances.
    fn stations<C: Course>(&self, track: &C, beside: Option<&Lane<C>>) -> Vec<Station> {
        let parts = crate::math::ceil_to_usize(0.5 * track.length() / (STATIONS.2 * self.hull.radius()));
        let parts = 2 * parts.clamp(STATIONS.0 / 2, STATIONS.1 / 2);
        let chunks: Vec<usize> = (0..=parts).step_by(CHUNK).collect();
        let chunk = |first: &usize| {
            let mut hint = beside.and_then(|lane| lane.contact(count(*first) / count(parts)));
            let mut found = Vec::with_capacity(CHUNK);
            for k in *first..(first + CHUNK).min(parts + 1) {
                let here = station(track, count(k) / count(parts), hint.as_ref());
                hint = here.contact.or(hint);
                found.push(here);
            }
            found
        };
        chunks.par_iter().flat_map_iter(chunk).collect()
    }

    /// Whether the way at the middle one of three stations is as the cubic through their outer neighbours has it.
    fn is_smooth(&self, stations: &[Station], first: usize) -> bool {
        let height = |k: Option<usize>| stations.get(k?)?.contact.map(|c| c.centre.z);
        let at = |k: usize| height(Some(k));
        let (Some(a), Some(m), Some(b)) = (at(first), at(first + 1), at(first + 2)) else { return false };
        let cubic = match (height(first.checked_sub(2)), at(first + 4)) {
            (Some(before), Some(after)) => (9.0 * (a + b) - before - after) / 16.0,
            (None, Some(after)) => (3.0 * a + 6.0 * b - after) / 8.0,
            (Some(before), None) => (6.0 * a + 3.0 * b - before) / 8.0,
            (None, None) => 0.5 * (a + b),
        };
        (m - cubic).abs() <= 0.5 * STRAIGHT * self.cusp
    }

    /// Points between a station and the next on the cubic through these and their neighbours.
    fn follow(&self, stations: &[Station], i: usize, beside: bool, way: &mut Vec<Point>) {
        let centre = |k: Option<usize>| stations.get(k?)?.contact.map(|c| c.centre.coords);
        let (Some(a), Some(b)) = (centre(Some(i)), centre(Some(i + 1))) else { return };
        let before = centre(i.checked_sub(1)).unwrap_or(a * 2.0 - b);
        let after = centre(Some(i + 2)).unwrap_or(b * 2.0 - a);
        let (first, second) = (before - a * 2.0 + b, a - b * 2.0 + after);
        let bend = first.z.abs().max(second.z.abs());
        // Beside the pass a chord may leave it by more, as it does not where passes are straight.
        let bend = bend.max(if beside { BESIDE * first.xy().norm().max(second.xy().norm()) } else { 0.0 });
        let parts = (bend / (8.0 * STRAIGHT * self.cusp)).sqrt().ceil().clamp(1.0, CHORDS);
        let mut k = 1.0;
        while k < parts {
            let t = k / parts;
            let weights = [
                -t * (t - 1.0) * (t - 2.0) / 6.0,
                (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
                -(t + 1.0) * t * (t - 2.0) / 2.0,
                (t + 1.0) * t * (t - 1.0) / 6.0,
            ];
            let p = before * weights[0] + a * weights[1] + b * weights[2] + after * weights[3];
            let share = stations[i].share + (stations[i + 1].share - stations[i].share) * t;
            way.push((share, Some(p.into())));
            k += 1.0;
        }
    }

    /// Stations between two, where the pass is not straight enough.
    fn between<C: Course>(
        &self,
        track: &C,
        (from, to): (Station, Station),
        depth: u32,
        found: &mut Vec<Station>,
    ) {
        let middle = station(track, 0.5 * (from.share + to.share), from.contact.as_ref());
        if let [Some(a), Some(b), Some(c)] = [from, middle, to].map(|s| s.contact) {
            let above = b.centre.z - 0.5 * (a.centre.z + c.centre.z);
            if above <= STRAIGHT * self.cusp || depth >= DEEPEST {
                found.push(middle);
                return;
            }
        } else if depth >= 2 {
            return;
        }
        self.between(track, (from, middle), depth + 1, found);
        found.push(middle);
        self.between(track, (middle, to), depth + 1, found);
    }

    /// The highest ridge between two passes, or one that is too high; `highest`: one that is known.
    fn ridge(
        &self,
        (a, b): (&Lane<Track>, &Lane<Track>),
        mut highest: f64,
        make: &dyn Fn(f64) -> Option<Track>,
        spent: &mut usize,
    ) -> f64 {
        let places = self.places(b.at - a.at);
        let middle = places.div_ceil(2);
        if highest > AIM * self.cusp {
            return highest;
        }
        // The highest are near the middle: those come first.
        for k in 0..places {
            let place = if k % 2 == 0 { middle + k / 2 } else { middle - k.div_ceil(2) };
            let at = a.at + (b.at - a.at) * count(place) / count(places + 1);
            let Some(track) = make(at) else { continue };
            let here = self.left_along(&track, [Some(a), Some(b)], highest, spent);
            highest = self::highest(&here).max(highest);
            if highest > AIM * self.cusp {
                break;
            }
        }
        highest
    }

    /// At how many places between passes that lie so far apart the cutter is let down: an odd number.
    pub(super) fn places(&self, apart: f64) -> usize {
        let wanted = crate::math::ceil_to_usize(apart / (BETWEEN.1 * self.hull.radius()));
        wanted.max(BETWEEN.0) | 1
    }

    /// What passes on either side leave along a way between them, by its share; `highest`: the highest ridge known.
    pub(super) fn left_along<C: Course>(
        &self,
        track: &C,
        passes: [Option<&Lane<C>>; 2],
        highest: f64,
        spent: &mut usize,
    ) -> Vec<(f64, f64)> {
        let stations = self.stations(track, passes[0].or(passes[1]));
        *spent += stations.len();
        let left = |station: &Station| {
            let touched = station.contact.map(|c| (c, self.normal(track.tree(), &c)));
            touched.as_ref().map_or(0.0, |t| self.adds(passes, t, station.share))
        };
        let here: Vec<f64> = stations.par_iter().map(left).collect();
        let highest = here.iter().copied().fold(highest, f64::max);
        let mut out: Vec<(f64, f64)> = stations.iter().map(|s| s.share).zip(here.iter().copied()).collect();
        // About the highest ones the ridge is looked at closer.
        for k in crests(&here, PEAK * highest) {
            let (from, own, to) = (&stations[k - 1], &stations[k], &stations[k + 1]);
            for share in [0.5 * (from.share + own.share), 0.5 * (own.share + to.share)] {
                out.push((share, left(&station(track, share, own.contact.as_ref()))));
            }
        }
        out
    }

    /// What passes leave on a point that the cutter touches between them, above what it leaves there itself: at an edge
    /// it may lean on that with its side.
    fn adds<C: Course>(&self, passes: [Option<&Lane<C>>; 2], touched: &(Contact, Vec3), share: f64) -> f64 {
        let (centre, ray) = (touched.0.centre, (touched.0.foot.point, touched.1));
        let own = self.leaves((centre, centre), ray);
        if !own.is_finite() {
            return 0.0;
        }
        let left = passes.into_iter().flatten().map(|lane| self.left(lane, touched, share));
        (left.fold(f64::INFINITY, f64::min) - own) / self.shares.share(touched.0.foot.point)
    }

    /// What the cutter on its way leaves on a point.
    fn leaves(&self, way: (Point3, Point3), ray: (Point3, Vec3)) -> f64 {
        self.bare.enters(way, ray, (self.by, 2.0 * self.hull.radius())) - self.by
    }

    /// The surface's normal where the cutter touches it, be it at an edge.
    fn normal(&self, tree: &SurfaceTree, contact: &Contact) -> Vec3 {
        let foot = &contact.foot;
        let patch = tree.net().patches().get(foot.patch);
        patch.and_then(|p| p.jet(foot.uv[0], foot.uv[1]).normal()).unwrap_or(contact.normal)
    }

    /// What a pass leaves on a point that the cutter touches beside it, about a share of its length.
    fn left<C: Course>(&self, lane: &Lane<C>, (touched, normal): &(Contact, Vec3), share: f64) -> f64 {
        const AROUND: usize = 2;
        const PATIENCE: usize = 4;
        let bends = lane.track.bends();
        let (last, nearest) = (lane.way.len() - 1, lane.nearest(touched.centre, share));
        let ray = (touched.foot.point, *normal);
        let part = |k: usize| {
            let at = |k: usize| lane.way.get(k)?.1;
            let (Some(from), Some(to)) = (at(k), at(k + 1)) else { return f64::INFINITY };
            self.leaves((from, to), ray)
        };
        let parts = nearest.saturating_sub(AROUND)..(nearest + AROUND).min(last);
        let mut least = parts.clone().map(part).fold(f64::INFINITY, f64::min);
        // A pass that bends takes most of it farther on.
        let mut onwards = |beyond: &mut dyn Iterator<Item = usize>| {
            let mut idle = 0;
            for k in beyond {
                let own = part(k);
                idle = if own < least { 0 } else { idle + 1 };
                least = least.min(own);
                if idle >= PATIENCE {
                    break;
                }
            }
        };
        if bends {
            onwards(&mut (0..parts.start).rev());
            onwards(&mut (parts.end..last));
        }
        least
    }
}

impl<C> Lane<C> {
    /// The point of its way that is the nearest in plan of those about a share of it.
    fn nearest(&self, place: Point3, share: f64) -> usize {
        let last = self.way.len() - 1;
        let apart = |k: usize| {
            let at = self.way[k].1.map(|c| (c - place).xy().norm_squared());
            at.unwrap_or(f64::INFINITY)
        };
        let mut nearest = self.way.partition_point(|p| p.0 < share).min(last);
        while nearest > 0 && apart(nearest - 1) < apart(nearest) {
            nearest -= 1;
        }
        while nearest < last && apart(nearest + 1) < apart(nearest) {
            nearest += 1;
        }
        nearest
    }

    /// Length of the pass, mm.
    pub(super) fn length(&self) -> f64 {
        let chord = |w: &[Point]| w[0].1.zip(w[1].1).map_or(0.0, |(a, b)| (b - a).norm());
        self.way.windows(2).map(chord).sum()
    }

    /// A contact about a share of the pass.
    fn contact(&self, share: f64) -> Option<Contact> {
        let near = self.stations.iter().min_by(|a, b| {
            let off = |s: &Station| (s.share - share).abs();
            off(a).total_cmp(&off(b))
        });
        near.and_then(|s| s.contact)
    }
}

impl Station {
    fn point(&self) -> Point {
        (self.share, self.contact.map(|c| c.centre))
    }
}

/// The highest of ridges that are told by their shares.
fn highest(ridges: &[(f64, f64)]) -> f64 {
    ridges.iter().map(|r| r.1).fold(0.0, f64::max)
}

/// The inner places that are at least so high, and as high as their neighbours.
fn crests(heights: &[f64], least: f64) -> Vec<usize> {
    let is_crest = |w: &[f64]| w[1] >= least && w[1] >= w[0].max(w[2]);
    heights.windows(3).enumerate().filter(|(_, w)| is_crest(w)).map(|(k, _)| k + 1).collect()
}

fn station<C: Course>(track: &C, share: f64, hint: Option<&Contact>) -> Station {
    Station { share, contact: track.at(share, hint) }
}
