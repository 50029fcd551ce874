//! How far apart passes of cutters with a flat or a cone may lie for the height of the ridges between them.
//!
//! Between two passes the cutter is let down as if there were one more. What the two leave on the points it touches there
//! is the ridge: what a pass in between would take away. What no pass takes, because the cutter is too wide, is none.
//! Each pass is put as far from the one before as its own ridge allows.

use rayon::prelude::*;

use crate::geom::surface::{Contact, Cutter, Track};
use crate::geom::{Point3, Vec3};
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

/// A pass and where the cutter is on it.
struct Lane {
    /// Where it lies among the others, mm.
    at: f64,
    track: Track,
    stations: Vec<Station>,
}

/// A place of a pass, as a share of it.
#[derive(Clone, Copy)]
struct Station {
    share: f64,
    contact: Option<Contact>,
}

/// Ridges are made so high, as a share of what is asked for: the rest is for what lies between the stations.
const AIM: f64 = 0.87;
/// Ridges of this share of that are high enough.
const HIGH: f64 = 0.8;
/// Between passes the cutter is let down at so many places at least, and no farther apart than this share of its radius: where
/// it touches may leap.
const BETWEEN: (usize, f64) = (3, 0.12);
/// Attempts at the place of one pass.
const TRIES: u32 = 16;
/// Passes closer than this are too close, mm.
const CLOSEST: f64 = 2e-3;
/// Stations of a pass at first, and their distance as a share of the radius.
const STATIONS: (usize, usize, f64) = (8, 400, 0.3);
/// Between stations a pass leaves its chord upwards by no more than this share of the height of ridges …
const STRAIGHT: f64 = 0.04;
/// … unless they were halved so often.
const DEEPEST: u32 = 5;
/// Stations of all passes, tried ones included, before that is given up.
const MOST: usize = 4_000_000;
/// Stations that share their hints.
const CHUNK: usize = 8;

impl Apart {
    /// Passes over a width, mm, each with its place; `make` lays the pass at a place.
    pub(super) fn march(
        &self,
        width: f64,
        make: &dyn Fn(f64) -> Option<Track>,
    ) -> Result<Vec<(f64, Track)>, String> {
        const FIRST: usize = 1000;
        let first = (0..FIRST).map(|k| width * count(k) / count(FIRST)).find_map(|at| Some((at, make(at)?)));
        let Some((at, track)) = first else { return Ok(Vec::new()) };
        let mut last = self.lane(at, track);
        let mut step = 2.0 * (2.0 * self.hull.radius() * self.cusp).sqrt();
        let (mut passes, mut spent) = (Vec::new(), 0);
        while let Some((lane, next)) = self.next(&last, (width, step), make, &mut spent)? {
            passes.push((last.at, last.track));
            (last, step) = (lane, next);
        }
        passes.push((last.at, last.track));
        Ok(passes)
    }

    /// The widest that passes are put apart, mm: beyond that their flats could leave a strip that neither covers.
    fn widest(&self) -> f64 {
        1.6 * self.hull.flat() + 2.0 * (2.0 * self.hull.corner() * self.cusp).sqrt()
    }

    /// The pass after one, and the step it took; `None` after the last.
    fn next(
        &self,
        last: &Lane,
        (width, step): (f64, f64),
        make: &dyn Fn(f64) -> Option<Track>,
        spent: &mut usize,
    ) -> Result<Option<(Lane, f64)>, String> {
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
            let lane = self.lane(last.at + step, track);
            let ridge = self.ridge(last, &lane, make, spent);
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
    fn place(&self, lane: &Lane) -> String {
        let middle = lane.stations.get(lane.stations.len() / 2).and_then(|s| s.contact);
        middle.map_or_else(String::new, |c| {
            format!(
                "they would lie {:.3} mm or less apart about X {:.3}, Y {:.3} mm",
                CLOSEST, c.centre.x, c.centre.y
            )
        })
    }

    /// A pass with its stations.
    fn lane(&self, at: f64, track: Track) -> Lane {
        let ends = [0.0, 1.0].map(|t| track.at(t, None).map(|c| c.centre));
        let length = if let [Some(a), Some(b)] = ends { (b - a).norm() } else { 0.0 };
        let parts = crate::math::ceil_to_usize(length / (STATIONS.2 * self.hull.radius()));
        let parts = parts.clamp(STATIONS.0, STATIONS.1);
        let chunks: Vec<usize> = (0..parts).step_by(CHUNK).collect();
        let chunk = |first: &usize| {
            let mut found = Vec::with_capacity(2 * CHUNK);
            let mut from = station(&track, count(*first) / count(parts), None);
            for k in *first..(first + CHUNK).min(parts) {
                let to = station(&track, count(k + 1) / count(parts), from.contact.as_ref());
                found.push(from);
                self.between(&track, (from, to), 0, &mut found);
                from = to;
            }
            found
        };
        let mut stations: Vec<Station> = chunks.par_iter().flat_map_iter(chunk).collect();
        stations.push(station(&track, 1.0, None));
        Lane { at, track, stations }
    }

    /// Stations between two, where the pass is not straight enough.
    fn between(&self, track: &Track, (from, to): (Station, Station), depth: u32, found: &mut Vec<Station>) {
        let middle = station(track, 0.5 * (from.share + to.share), from.contact.as_ref());
        if let [Some(a), Some(b), Some(c)] = [from, middle, to].map(|s| s.contact) {
            let above = b.centre.z - 0.5 * (a.centre.z + c.centre.z);
            if above <= STRAIGHT * self.cusp || depth >= DEEPEST {
                found.push(middle);
                return;
            }
        } else if depth >= 1 {
            return;
        }
        self.between(track, (from, middle), depth + 1, found);
        found.push(middle);
        self.between(track, (middle, to), depth + 1, found);
    }

    /// The highest ridge between two passes.
    fn ridge(&self, a: &Lane, b: &Lane, make: &dyn Fn(f64) -> Option<Track>, spent: &mut usize) -> f64 {
        let wanted = crate::math::ceil_to_usize((b.at - a.at) / (BETWEEN.1 * self.hull.radius()));
        let places = wanted.max(BETWEEN.0) | 1;
        let middle = places.div_ceil(2);
        let mut highest = 0.0f64;
        // The highest are near the middle: those come first.
        for k in 0..places {
            let place = if k % 2 == 0 { middle + k / 2 } else { middle - k.div_ceil(2) };
            let at = a.at + (b.at - a.at) * count(place) / count(places + 1);
            let Some(track) = make(at) else { continue };
            let lane = self.lane(at, track);
            *spent += lane.stations.len();
            let left = |station: &Station| {
                let touched = station.contact.map(|c| (c, self.normal(&lane.track, &c)));
                touched.as_ref().map_or(0.0, |t| self.adds((a, b), t, station.share))
            };
            let here: Vec<f64> = lane.stations.par_iter().map(left).collect();
            highest = here.into_iter().fold(highest, f64::max);
            if highest > AIM * self.cusp {
                break;
            }
        }
        highest
    }

    /// What two passes leave on a point that the cutter touches between them, above what it leaves there itself: at an edge
    /// it may lean on that with its side.
    fn adds(&self, (a, b): (&Lane, &Lane), touched: &(Contact, Vec3), share: f64) -> f64 {
        let (centre, ray) = (touched.0.centre, (touched.0.foot.point, touched.1));
        let own = self.leaves((centre, centre), ray);
        if !own.is_finite() {
            return 0.0;
        }
        let left = self.left(a, touched, share).min(self.left(b, touched, share));
        (left - own) / self.shares.share(touched.0.foot.point)
    }

    /// What the cutter on its way leaves on a point.
    fn leaves(&self, way: (Point3, Point3), ray: (Point3, Vec3)) -> f64 {
        self.bare.enters(way, ray, (self.by, 2.0 * self.hull.radius())) - self.by
    }

    /// The surface's normal where the cutter touches it, be it at an edge.
    fn normal(&self, track: &Track, contact: &Contact) -> Vec3 {
        let foot = &contact.foot;
        let patch = track.tree.net().patches().get(foot.patch);
        patch.and_then(|p| p.jet(foot.uv[0], foot.uv[1]).normal()).unwrap_or(contact.normal)
    }

    /// What a pass leaves on a point that the cutter touches beside it, about a share of its length.
    fn left(&self, lane: &Lane, (touched, normal): &(Contact, Vec3), share: f64) -> f64 {
        const AROUND: usize = 2;
        let last = lane.stations.len() - 1;
        let apart = |k: usize| {
            let at = lane.stations[k].contact.map(|c| (c.centre - touched.centre).xy().norm_squared());
            at.unwrap_or(f64::INFINITY)
        };
        let mut nearest = lane.stations.partition_point(|s| s.share < share).min(last);
        while nearest > 0 && apart(nearest - 1) < apart(nearest) {
            nearest -= 1;
        }
        while nearest < last && apart(nearest + 1) < apart(nearest) {
            nearest += 1;
        }
        let ray = (touched.foot.point, *normal);
        let part = |k: usize| {
            let at = |k: usize| Some(lane.stations.get(k)?.contact?.centre);
            let (Some(from), Some(to)) = (at(k), at(k + 1)) else { return f64::INFINITY };
            self.leaves((from, to), ray)
        };
        let parts = nearest.saturating_sub(AROUND)..(nearest + AROUND).min(last);
        parts.map(part).fold(f64::INFINITY, f64::min)
    }
}

fn station(track: &Track, share: f64, hint: Option<&Contact>) -> Station {
    Station { share, contact: track.at(share, hint) }
}
