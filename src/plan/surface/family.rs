//! The passes of an operation: which curves they follow, and how one leads to the next.

use std::sync::Arc;

use rayon::prelude::*;

use super::march;
use super::ridge::Target;
use super::spread::{self, COLUMNS, Line};
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

/// The edges of the surface as plan passes along an axis (0: x) see them.
#[derive(Debug)]
pub(super) struct Rim {
    pub axis: usize,
    pub places: Vec<RimPlace>,
    /// The centres in plan: the outline of the offset surface.
    outline: Vec<Point2>,
}

/// A place on an edge, with the centre of the ball that touches there.
#[derive(Debug)]
pub(super) struct RimPlace {
    pub point: Point3,
    pub normal: Vec3,
    pub centre: Point3,
}

/// How far a plan pass goes on beyond the outline of the offset surface, mm.
const BEYOND: f64 = 0.005;
/// Plan passes begin so far inside the outline, as a share of the ball's radius: what that leaves is far below a
/// micron.
const INSET: f64 = 0.005;
/// Passes that end and begin farther apart than so many radii are joined above the surface.
const LINK: f64 = 6.0;
/// Outline points on an edge of a patch.
const EDGE: u32 = 400;

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
            Kind::Line(Rim { axis, outline, .. }) => {
                // At its very border the outline has no length.
                let (a, b) = range(outline.iter().map(|p| p[1 - axis]));
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
            Kind::Line(Rim { axis, outline, .. }) => {
                let (a, b) = crossings(outline, *axis, across)?;
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

    fn parameter_track(&self, axis: usize, value: f64, range: (f64, f64)) -> Track {
        self.track(Guide::Parameter { axis, value, range })
    }

    fn track(&self, guide: Guide) -> Track {
        let (radius, cutter) = (self.ball, Cutter::ball(self.ball));
        Track { tree: Arc::clone(&self.tree), radius, cutter, guide }
    }

    /// The track of pass `k` of those at `places`; none where the line meets no surface, several where it leaves it in
    /// between. A plan pass goes on, around the surface's edge, as far as its neighbours do: beside their ends nothing else
    /// cuts the edge.
    fn pass(&self, places: &[f64], k: usize) -> Vec<Track> {
        let Some(across) = places.get(k).copied() else { return Vec::new() };
        let Some((mut a, mut b)) = self.along(across) else { return Vec::new() };
        for near in [k.checked_sub(1), Some(k + 1)].into_iter().flatten() {
            if let Some((c, d)) = places.get(near).and_then(|w| self.along(*w)) {
                (a, b) = (a.min(c), b.max(d));
            }
        }
        match &self.kind {
            Kind::Parameter(axis) => vec![self.parameter_track(*axis, across, (a, b))],
            Kind::Line(Rim { axis: 0, .. }) => self.lines(Point2::new(a, across), Point2::new(b, across)),
            Kind::Line(..) => self.lines(Point2::new(across, a), Point2::new(across, b)),
        }
    }

    /// A plan line, cut to where the ball rests.
    fn lines(&self, from: Point2, to: Point2) -> Vec<Track> {
        const CLOSE: f64 = 1e-3;
        let length = (to - from).norm();
        if length.is_nan() || length <= CLOSE {
            return Vec::new();
        }
        let held = self.held(from, to);
        let parts = held.len() - 1;
        let at = |share: f64| from + (to - from) * share;
        let place = |k: usize| count(k) / count(parts);
        // Where the ball begins to rest between a place where it does not and one where it does.
        let edge = |mut off: f64, mut on: f64| {
            while (on - off).abs() * length > CLOSE {
                let middle = 0.5 * (off + on);
                *(if self.rests(at(middle), None).is_some() { &mut on } else { &mut off }) = middle;
            }
            on
        };
        let mut out = Vec::new();
        let mut k = 0;
        while k <= parts {
            let end = (k..=parts).find(|i| !held[*i]).unwrap_or(parts + 1);
            if end > k + 1 {
                let start = if k == 0 { 0.0 } else { edge(place(k - 1), place(k)) };
                let stop = if end > parts { 1.0 } else { edge(place(end), place(end - 1)) };
                out.push(self.track(Guide::Line { from: at(start), to: at(stop) }));
            }
            k = end + 1;
        }
        out
    }

    /// Whether the ball rests, at equal distances along a plan line.
    fn held(&self, from: Point2, to: Point2) -> Vec<bool> {
        const APART: f64 = 0.25;
        let parts = ((to - from).norm() / (APART * self.ball)).clamp(32.0, 1024.0).ceil() as usize;
        let mut hint: Option<Contact> = None;
        let at = |k: usize| {
            hint = self.rests(from + (to - from) * (count(k) / count(parts)), hint.as_ref());
            hint.is_some()
        };
        (0..=parts).map(at).collect()
    }

    /// Where the ball rests over a place; `None` also where it would hang at the side of the surface.
    fn rests(&self, p: Point2, hint: Option<&Contact>) -> Option<Contact> {
        const HANGING: f64 = 0.01;
        drop_ball(&self.tree, self.ball, p.x, p.y, hint).filter(|c| c.normal.z > HANGING)
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
            (Guide::Line { to: end, .. }, Guide::Line { from: start, .. }) => self
                .held(*end, *start)
                .iter()
                .all(|held| *held)
                .then(|| self.track(Guide::Line { from: *end, to: *start })),
            _ => None,
        }
    }

    /// The passes as tracks, each with its room, in chains: one pass of a chain lies beside the next.
    fn chains(&self, surface: &Surface, target: Target) -> Result<Vec<Chain>, String> {
        if matches!(surface.along, Along::IsoCusp | Along::Const) {
            let both = [self.along_axis(0), self.along_axis(1)];
            let (family, spread) = march::shortest(both, target, surface.along == Along::Const)?;
            let rooms = spread.rooms(target, true);
            let leg = |s: &Stretch| {
                let room = rooms[s.line][s.from..=s.to].to_vec();
                (family.bent(&spread.lines[s.line], s), room)
            };
            return Ok(stretches(spread.lines.iter().enumerate().map(|(k, l)| runs(k, l)).collect())
                .iter()
                .map(|chain| chain.iter().map(leg).collect())
                .collect());
        }
        let spread = spread::spread(self, target)?;
        let places: Vec<f64> = spread.lines.iter().map(|line| line[0]).collect();
        let tracks: Vec<Vec<Track>> =
            (0..places.len()).into_par_iter().map(|k| self.pass(&places, k)).collect();
        if self.is_plane() {
            return Ok(beside(tracks));
        }
        Ok(vec![tracks.into_iter().flatten().zip(spread.rooms(target, false)).collect()])
    }

    /// A pass along a stretch of a curve in the parameters.
    fn bent(&self, line: &Line, stretch: &Stretch) -> Track {
        let (from, to) = self.along(0.0).unwrap_or((0.0, 1.0));
        let at = |k: usize| from + (to - from) * count(k) / count(COLUMNS - 1);
        let across = usize::from(matches!(self.kind, Kind::Parameter(0)));
        let place = |k: usize| if across == 1 { [at(k), line[k]] } else { [line[k], at(k)] };
        self.track(Guide::Curve(Arc::new((stretch.from..=stretch.to).map(place).collect())))
    }

    /// All passes and the ways between them, in the order they are cut.
    pub(super) fn legs(&self, surface: &Surface) -> Result<Vec<Leg>, String> {
        let target = match surface.spacing {
            Spacing::Cusp(h) => Target::Cusp(h),
            Spacing::Step(s) => Target::Step(s),
        };
        let mut legs: Vec<Leg> = Vec::new();
        for chain in self.chains(surface, target)? {
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
            legs.extend(link.map(|track| Leg { track, room: Vec::new(), last: false }));
            legs.push(Leg { track, room, last: false });
        }
    }
}

/// A stretch of a pass, by its first and last columns.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Stretch {
    line: usize,
    from: usize,
    to: usize,
}

/// Plan passes, line by line, in chains of such that lie beside one another.
fn beside(lines: Vec<Vec<Track>>) -> Vec<Chain> {
    /// Stretches are compared to so many parts of a millimetre.
    const PARTS: f64 = 1e3;
    let ends = |track: &Track| match &track.guide {
        Guide::Line { from, to } if from.y == to.y => (from.x, to.x),
        Guide::Line { from, to } => (from.y, to.y),
        _ => (0.0, 0.0),
    };
    let least = range(lines.iter().flatten().map(|track| ends(track).0)).0;
    // Floats saturate.
    let place = |x: f64| ((x - least) * PARTS).max(0.0) as usize;
    let open = lines.iter().enumerate().map(|(line, tracks)| {
        let stretch = |track: &Track| {
            let (from, to) = ends(track);
            Stretch { line, from: place(from), to: place(to) }
        };
        tracks.iter().rev().map(stretch).collect()
    });
    let track = |s: &Stretch| {
        let own = lines.get(s.line).and_then(|tracks| tracks.iter().find(|t| place(ends(t).0) == s.from));
        own.map(|track| (track.clone(), Vec::new()))
    };
    stretches(open.collect()).iter().map(|chain| chain.iter().filter_map(track).collect()).collect()
}

/// Stretches, line by line and the last of each first, in chains of such that lie beside one another.
fn stretches(mut open: Vec<Vec<Stretch>>) -> Vec<Vec<Stretch>> {
    let mut chains = Vec::new();
    for first in 0..open.len() {
        while let Some(start) = open[first].pop() {
            let mut chain = vec![start];
            let mut last = start;
            while let Some(beside) = open.get_mut(last.line + 1) {
                let shared = |s: &Stretch| (s.to.min(last.to) + 1).saturating_sub(s.from.max(last.from));
                let best =
                    (0..beside.len()).filter(|i| shared(&beside[*i]) > 0).max_by_key(|i| shared(&beside[*i]));
                let Some(i) = best else { break };
                last = beside.remove(i);
                chain.push(last);
            }
            chains.push(chain);
        }
    }
    chains
}

/// The stretches of one line, of two columns at least, the last first.
fn runs(line: usize, across: &Line) -> Vec<Stretch> {
    let mut out: Vec<Stretch> = Vec::new();
    for k in (0..across.len()).filter(|k| !across[*k].is_nan()) {
        match out.last_mut().filter(|s| s.to + 1 == k) {
            Some(stretch) => stretch.to = k,
            None => out.push(Stretch { line, from: k, to: k }),
        }
    }
    out.retain(|s| s.to > s.from);
    out.reverse();
    out
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)))
}

impl Rim {
    /// Places along the four edges of the net, in order around it.
    fn new(axis: usize, tree: &SurfaceTree, ball: f64) -> Rim {
        let net = tree.net();
        let [rows, columns] = net.size().map(count);
        let corners = [[0.0, 0.0], [rows, 0.0], [rows, columns], [0.0, columns]];
        let mut places = Vec::new();
        for (k, from) in corners.iter().enumerate() {
            let to = corners[(k + 1) % 4];
            for i in 0..EDGE {
                let t = f64::from(i) / f64::from(EDGE);
                let jet = net.jet(from[0] + (to[0] - from[0]) * t, from[1] + (to[1] - from[1]) * t);
                if let Some(normal) = jet.normal() {
                    places.push(RimPlace { point: jet.p, normal, centre: jet.p + normal * ball });
                }
            }
        }
        let outline = places.iter().map(|p| Point2::new(p.centre.x, p.centre.y)).collect();
        Rim { axis, places, outline }
    }
}

/// First and last crossing of a closed outline with a line along `axis`.
pub(super) fn crossings(outline: &[Point2], axis: usize, across: f64) -> Option<(f64, f64)> {
    let mut found = (f64::INFINITY, f64::NEG_INFINITY);
    for (i, p) in outline.iter().enumerate() {
        let q = outline[(i + 1) % outline.len()];
        let (a, b) = (p[1 - axis] - across, q[1 - axis] - across);
        if a * b > 0.0 {
            continue;
        }
        let share = if a == b { 0.0 } else { a / (a - b) };
        let at = p[axis] + (q[axis] - p[axis]) * share;
        found = (found.0.min(at), found.1.max(at));
    }
    (found.0 < found.1).then_some(found)
}
