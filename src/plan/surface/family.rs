//! The passes of an operation: which curves they follow, and how one leads to the next.

use std::sync::Arc;

use rayon::prelude::*;

use super::march;
use super::outline::{self, Rim};
use super::ridge::Target;
use super::spread::{self, COLUMNS, Line};
use crate::cl::March;
use crate::geom::surface::{Contact, Cutter, Guide, SurfaceTree, Track, drop_ball};
use crate::geom::{Point2, Point3, Vec3};
use crate::ir::{Along, Spacing, Surface};
use crate::math::count;
use crate::plan::closer::Shares;

/// Passes with their room, each beside the next.
type Chain = Vec<(Track, Vec<f64>)>;

/// A pass or a way between two; `last`: the cutter leaves the surface after it.
#[derive(Debug, Clone)]
pub(super) struct Leg {
    pub track: Track,
    /// As [`crate::cl::Pass::room`].
    pub room: Vec<f64>,
    /// As [`crate::cl::Pass::link`].
    pub link: bool,
    pub last: bool,
}

/// What all passes of an operation have in common: one is told from the other by a number, *across*; a place on a pass
/// by another, *along*.
#[derive(Debug)]
pub(super) struct Family {
    pub tree: Arc<SurfaceTree>,
    /// Radius of the ball with what it leaves, mm.
    pub ball: f64,
    /// What it leaves, mm.
    pub leave: f64,
    /// Width of the band the path may lie in, mm.
    band: f64,
    kind: Kind,
    shares: Arc<Shares>,
}

#[derive(Debug)]
enum Kind {
    /// Parameter lines along this axis.
    Parameter(usize),
    /// Plan lines along this axis (0: x), over the edges of the surface.
    Line(Rim),
}

/// How far a plan pass goes on beyond the outline of the offset surface, mm.
const BEYOND: f64 = 0.005;
/// Plan passes begin so far inside the outline, as a share of the ball's radius: what that leaves is far below a
/// micron.
const INSET: f64 = 0.005;
/// Passes that end and begin farther apart than so many radii are joined above the surface.
pub(super) const LINK: f64 = 6.0;

impl Family {
    /// The passes of an operation; those that bend as if they ran along u.
    pub(super) fn new(surface: &Surface, tree: Arc<SurfaceTree>, radius: f64, shares: Shares) -> Family {
        let ball = radius + surface.leave;
        let kind = match surface.along {
            Along::U | Along::IsoCusp | Along::Const => Kind::Parameter(0),
            Along::V => Kind::Parameter(1),
            Along::X => Kind::Line(Rim::new(0, &tree, ball)),
            Along::Y => Kind::Line(Rim::new(1, &tree, ball)),
        };
        let band = surface.band.into + surface.band.out;
        Family { tree, ball, leave: surface.leave, band, kind, shares: Arc::new(shares) }
    }

    /// The same surface with passes along u (0) or v (1).
    fn along_axis(&self, axis: usize) -> Family {
        let (tree, shares) = (Arc::clone(&self.tree), Arc::clone(&self.shares));
        Family { tree, shares, kind: Kind::Parameter(axis), ..*self }
    }

    /// Radius of the ball itself, mm.
    pub(super) fn radius(&self) -> f64 {
        self.ball - self.leave
    }

    /// The share of the height of cusps that may be used at a point of the surface.
    pub(super) fn share(&self, p: Point3) -> f64 {
        self.shares.share(p)
    }

    /// How far the path may be beside its pass, mm, where the surface has this normal: off the surface by the whole band, a
    /// plane pass stays in its plane and goes aside on the surface.
    pub(super) fn aside(&self, normal: Vec3) -> f64 {
        let Kind::Line(rim) = &self.kind else { return 0.0 };
        let out = normal[1 - rim.axis].abs();
        self.band * out / (1.0 - out * out).max(0.01).sqrt()
    }

    /// Whether passes lie in planes: their chords do so, too.
    pub(super) fn is_plane(&self) -> bool {
        matches!(self.kind, Kind::Line(..))
    }

    /// The edges, for plan passes.
    pub(super) fn rim(&self) -> Option<&Rim> {
        match &self.kind {
            Kind::Line(rim) => Some(rim),
            Kind::Parameter(_) => None,
        }
    }

    /// Range of *across*.
    pub(super) fn across(&self) -> (f64, f64) {
        match &self.kind {
            Kind::Parameter(axis) => (0.0, count(self.tree.net().size()[1 - axis])),
            Kind::Line(rim) => {
                // At its very border the outline has no length.
                let (a, b) = rim.width();
                let inset = (INSET * self.ball).min(0.1 * (b - a));
                (a + inset, b - inset)
            }
        }
    }

    /// How wide the passes lie in all, mm: no more than the poles' own way across.
    pub(super) fn width(&self) -> f64 {
        let (first, last) = self.across();
        match &self.kind {
            Kind::Line(..) => last - first,
            Kind::Parameter(axis) => {
                let (low, high) = self.tree.bounds();
                let diagonal = (high - low).norm();
                let net = self.tree.net();
                let size = net.size().map(count);
                let at = |along: f64, across: f64| {
                    let uv = if *axis == 0 { [along, across] } else { [across, along] };
                    net.jet(uv[0], uv[1]).p
                };
                const PARTS: u32 = 16;
                let way = |along: f64| -> f64 {
                    let place = |k: u32| at(along, size[1 - axis] * f64::from(k) / f64::from(PARTS));
                    (0..PARTS).map(|k| (place(k + 1) - place(k)).norm()).sum()
                };
                let widest = [0.0, 0.25, 0.5, 0.75, 1.0].map(|f| way(size[*axis] * f));
                widest.iter().copied().fold(0.0, f64::max).min(4.0 * diagonal)
            }
        }
    }

    /// Range of *along* of the pass at `across`; `None` where there is none.
    pub(super) fn along(&self, across: f64) -> Option<(f64, f64)> {
        match &self.kind {
            Kind::Parameter(axis) => Some((0.0, count(self.tree.net().size()[*axis]))),
            Kind::Line(rim) => {
                let (a, b) = rim.crossings(across)?;
                Some((a - BEYOND, b + BEYOND))
            }
        }
    }

    /// The contact at a place of a pass.
    pub(super) fn contact(&self, across: f64, along: f64, hint: Option<&Contact>) -> Option<Contact> {
        match &self.kind {
            Kind::Parameter(axis) => self.parameter_track(*axis, across, (along, along)).at(0.0, hint),
            Kind::Line(Rim { axis: 0, .. }) => drop_ball(&self.tree, self.ball, along, across, hint),
            Kind::Line(..) => drop_ball(&self.tree, self.ball, across, along, hint),
        }
    }

    /// Whether the ball touches elsewhere than where it was set down on a parameter line.
    pub(super) fn is_lifted(&self, contact: &Contact, (across, along): (f64, f64)) -> bool {
        const ELSEWHERE: f64 = 1e-6;
        let Kind::Parameter(axis) = self.kind else { return false };
        let [u, v] = if axis == 0 { [along, across] } else { [across, along] };
        (self.tree.net().jet(u, v).p - contact.foot.point).norm() > ELSEWHERE
    }

    fn parameter_track(&self, axis: usize, value: f64, range: (f64, f64)) -> Track {
        self.track(Guide::Parameter { axis, value, range })
    }

    fn track(&self, guide: Guide) -> Track {
        let (radius, cutter) = (self.ball, Cutter::ball(self.ball));
        Track { tree: Arc::clone(&self.tree), radius, cutter, guide }
    }

    /// The stretches of plan pass `k` of those at `places`. A plan pass goes on, around the surface's edge, as far as its
    /// neighbours do and the ball rests: beside their ends nothing else cuts the edge.
    fn stretches(&self, rim: &Rim, places: &[f64], k: usize) -> Vec<(f64, f64)> {
        let own = rim.inside(places[k]);
        let beside = [k.checked_sub(1), Some(k + 1)].into_iter().flatten().filter_map(|i| places.get(i));
        let all = beside.flat_map(|place| rim.inside(*place)).chain(own.iter().copied());
        let at = |along: f64| rim.place(along, places[k]);
        let wanted = outline::united(all.map(|(a, b)| (a - self.beyond(at(a)), b + self.beyond(at(b)))));
        let reach = |from: f64, to: f64| {
            let (a, b) = (at(from), at(to));
            let share = if to == from { 1.0 } else { self.resting(a, b) };
            from + (to - from) * share
        };
        let mut out = Vec::new();
        for (low, high) in wanted {
            let mut within = own.iter().filter(|o| o.0 >= low && o.1 <= high);
            let Some(&(first, mut end)) = within.next() else { continue };
            let mut start = reach(first, low);
            for &(a, b) in within {
                let on = if a - end <= LINK * self.ball { reach(end, a) } else { end };
                if on < a {
                    out.push((start, on));
                    start = a;
                }
                end = b;
            }
            out.push((start, reach(end, high)));
        }
        out
    }

    /// How far a plan pass goes on beyond its end: farther where cusps must be lower, since at a corner of the surface no
    /// neighbour cuts what it leaves.
    fn beyond(&self, end: Point2) -> f64 {
        const MOST: f64 = 0.3;
        if self.shares.is_empty() {
            return BEYOND;
        }
        let share = self.rests(end, None).map_or(1.0, |c| self.share(c.foot.point));
        BEYOND + (1.0 - share) * MOST * self.ball
    }

    /// Where the ball rests over a place; `None` also where it would hang at the side of the surface.
    fn rests(&self, p: Point2, hint: Option<&Contact>) -> Option<Contact> {
        const HANGING: f64 = 0.01;
        drop_ball(&self.tree, self.ball, p.x, p.y, hint).filter(|c| c.normal.z > HANGING)
    }

    /// The share of a way in plan from its start on, along which the ball rests.
    fn resting(&self, from: Point2, to: Point2) -> f64 {
        const PART: f64 = 0.02;
        const MOST: f64 = 4096.0;
        let parts = ((to - from).norm() / (PART * self.ball)).ceil().clamp(1.0, MOST);
        let mut hint = None;
        let mut touches = |share: f64| {
            let found = self.rests(from + (to - from) * share, hint.as_ref());
            hint = found.or(hint);
            found.is_some()
        };
        let mut k = 0.0;
        while k < parts {
            if !touches((k + 1.0) / parts) {
                return outline::border(k / parts, (k + 1.0) / parts, &mut touches);
            }
            k += 1.0;
        }
        1.0
    }

    /// The tracks of pass `k` of those at `places`, with the range that each takes along.
    fn tracks(&self, places: &[f64], k: usize) -> Vec<((f64, f64), Track)> {
        match &self.kind {
            Kind::Parameter(axis) => {
                let range = (0.0, count(self.tree.net().size()[*axis]));
                vec![(range, self.parameter_track(*axis, places[k], range))]
            }
            Kind::Line(rim) => {
                let line = |(a, b): (f64, f64)| {
                    let track = self.line(rim.place(a, places[k]), rim.place(b, places[k]))?;
                    Some(((a, b), track))
                };
                self.stretches(rim, places, k).into_iter().filter_map(line).collect()
            }
        }
    }

    /// How far paths may be off the surface in all, mm.
    pub(super) fn band(&self) -> f64 {
        self.band
    }

    /// A plan line, cut back to where the ball rests at both ends.
    fn line(&self, mut from: Point2, mut to: Point2) -> Option<Track> {
        const TRIES: u32 = 40;
        for _ in 0..TRIES {
            let length = (to - from).norm();
            if length.is_nan() || length <= 1e-3 {
                return None;
            }
            let (a, b) = (self.rests(from, None).is_some(), self.rests(to, None).is_some());
            if a && b {
                return Some(self.track(Guide::Line { from, to }));
            }
            let step = (to - from) / length * (BEYOND.min(0.1 * length));
            if !a {
                from += step;
            }
            if !b {
                to -= step;
            }
        }
        None
    }

    /// The way from the end of one pass to the start of the next, along the surface.
    fn link(&self, from: &Track, to: &Track) -> Option<Track> {
        match (&from.guide, &to.guide) {
            (
                Guide::Parameter { axis, value, range: (_, end) },
                Guide::Parameter { value: next, range: (start, _), .. },
            ) if end == start => Some(self.parameter_track(1 - axis, *end, (*value, *next))),
            (Guide::Curve(before), Guide::Curve(after)) => {
                // The domain is convex: a straight way in the parameters stays on the surface.
                let way = [*before.last()?, *after.first()?];
                let ends = [from.at(1.0, None)?.centre, to.at(0.0, None)?.centre];
                ((ends[1] - ends[0]).norm() <= LINK * self.ball)
                    .then(|| self.track(Guide::Curve(Arc::new(way.to_vec()))))
            }
            (Guide::Line { to: end, .. }, Guide::Line { from: start, .. }) => (self.resting(*end, *start)
                >= 1.0)
                .then(|| self.track(Guide::Line { from: *end, to: *start })),
            _ => None,
        }
    }

    /// The passes as tracks, each with its room, in chains: one pass of a chain lies beside the next.
    fn chains(
        &self,
        surface: &Surface,
        target: Target,
        march: &mut Option<March>,
    ) -> Result<Vec<Chain>, String> {
        if matches!(surface.along, Along::IsoCusp | Along::Const) {
            let both = [self.along_axis(0), self.along_axis(1)];
            let (family, spread) = march::shortest(both, target, surface.along == Along::Const, march)?;
            let rooms = spread.rooms(target);
            let runs: Vec<Vec<(usize, usize)>> =
                spread.lines.iter().map(|line| runs(line, |at| !at.is_nan())).collect();
            let leg = |&(line, k): &(usize, usize)| {
                let (from, to) = runs[line][k];
                (family.bent(&spread.lines[line], (from, to)), rooms[line][from..=to].to_vec())
            };
            // Runs that lie side by side have a column in common.
            let ranges: Vec<Vec<(f64, f64)>> = runs
                .iter()
                .map(|line| line.iter().map(|(from, to)| (count(*from), count(to + 1))).collect())
                .collect();
            return Ok(outline::chained(&ranges)
                .iter()
                .map(|chain| chain.iter().map(leg).collect())
                .collect());
        }
        let spread = spread::spread(self, target)?;
        let places: Vec<f64> = spread.lines.iter().map(|line| line[0]).collect();
        // A chord of a plane pass stays in its plane.
        let rooms = if self.is_plane() { Vec::new() } else { spread.rooms(target) };
        let tracks: Vec<Vec<((f64, f64), Track)>> =
            (0..places.len()).into_par_iter().map(|k| self.tracks(&places, k)).collect();
        let ranges: Vec<Vec<(f64, f64)>> =
            tracks.iter().map(|line| line.iter().map(|(range, _)| *range).collect()).collect();
        let leg = |&(line, k): &(usize, usize)| {
            (tracks[line][k].1.clone(), rooms.get(line).cloned().unwrap_or_default())
        };
        Ok(outline::chained(&ranges).iter().map(|chain| chain.iter().map(leg).collect()).collect())
    }

    /// A pass along a stretch of a curve in the parameters.
    fn bent(&self, line: &Line, (first, last): (usize, usize)) -> Track {
        let (from, to) = self.along(0.0).unwrap_or((0.0, 1.0));
        let at = |k: usize| from + (to - from) * count(k) / count(COLUMNS - 1);
        let across = usize::from(matches!(self.kind, Kind::Parameter(0)));
        let place = |k: usize| if across == 1 { [at(k), line[k]] } else { [line[k], at(k)] };
        self.track(Guide::Curve(Arc::new((first..=last).map(place).collect())))
    }

    /// All passes and the ways between them, in the order they are cut; those that bend follow one another as known, or as
    /// is found to be best.
    pub(super) fn legs(&self, surface: &Surface, march: &mut Option<March>) -> Result<Vec<Leg>, String> {
        let target = match surface.spacing {
            Spacing::Cusp(h) => Target::Cusp(h),
            Spacing::Step(s) => Target::Step(s),
        };
        let mut legs: Vec<Leg> = Vec::new();
        for chain in self.chains(surface, target, march)? {
            self.chain(chain, surface.zigzag, &mut legs);
            if let Some(end) = legs.last_mut() {
                end.last = true;
            }
        }
        if legs.is_empty() { Err("no pass meets the surface".into()) } else { Ok(legs) }
    }

    /// The passes of one chain, and the ways between them.
    fn chain(&self, chain: Chain, zigzag: bool, legs: &mut Vec<Leg>) {
        for (k, (mut track, mut room)) in chain.into_iter().enumerate() {
            if zigzag && k % 2 == 1 {
                track = track.reversed();
                room.reverse();
            }
            let link = match legs.last() {
                Some(before) if zigzag && k > 0 => self.link(&before.track, &track),
                _ => None,
            };
            if let Some(before) = legs.last_mut() {
                before.last = link.is_none();
            }
            legs.extend(link.map(|track| Leg { track, room: Vec::new(), link: true, last: false }));
            legs.push(Leg { track, room, link: false, last: false });
        }
    }
}

/// The runs of columns at which a pass has places, each of two columns at least: first and last.
pub(super) fn runs<T>(columns: &[T], has: impl Fn(&T) -> bool) -> Vec<(usize, usize)> {
    let mut out: Vec<(usize, usize)> = Vec::new();
    for k in (0..columns.len()).filter(|k| has(&columns[*k])) {
        match out.last_mut().filter(|run| run.1 + 1 == k) {
            Some(run) => run.1 = k,
            None => out.push((k, k)),
        }
    }
    out.retain(|run| run.1 > run.0);
    out
}
