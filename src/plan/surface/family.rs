//! The passes of an operation: which curves they follow, and how one leads to the next.

use std::sync::Arc;

use super::ridge::Target;
use super::spread::{self, COLUMNS, Line};
use crate::geom::Point2;
use crate::geom::surface::{Contact, Cutter, Guide, SurfaceTree, Track, drop_ball};
use crate::ir::{Along, Spacing, Surface};
use crate::math::count;

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
    kind: Kind,
}

#[derive(Debug)]
enum Kind {
    /// Parameter lines along this axis.
    Parameter(usize),
    /// Plan lines along this axis (0: x), and the plan outline of the offset surface.
    Line(usize, Vec<Point2>),
}

/// How far a plan pass goes on beyond the outline of the offset surface, mm.
const BEYOND: f64 = 0.005;
/// Plan passes begin so far inside the outline, as a share of the ball's radius: what that leaves is far below a
/// micron.
const INSET: f64 = 0.005;
/// Outline points on an edge of a patch.
const EDGE: u32 = 400;

impl Family {
    pub(super) fn new(surface: &Surface, tree: Arc<SurfaceTree>, radius: f64) -> Family {
        let ball = radius + surface.leave;
        let kind = match surface.along {
            Along::U | Along::IsoCusp => Kind::Parameter(0),
            Along::V => Kind::Parameter(1),
            Along::X => Kind::Line(0, outline(&tree, ball)),
            Along::Y => Kind::Line(1, outline(&tree, ball)),
        };
        Family { tree, ball, leave: surface.leave, kind }
    }

    /// Whether passes lie in planes: their chords do so, too.
    pub(super) fn is_plane(&self) -> bool {
        matches!(self.kind, Kind::Line(..))
    }

    /// Range of *across*.
    pub(super) fn across(&self) -> (f64, f64) {
        match &self.kind {
            Kind::Parameter(axis) => (0.0, count(self.tree.net().size()[1 - axis])),
            Kind::Line(axis, outline) => {
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
            Kind::Line(axis, outline) => {
                let (a, b) = crossings(outline, *axis, across)?;
                Some((a - BEYOND, b + BEYOND))
            }
        }
    }

    /// The contact at a place of a pass.
    pub(super) fn contact(&self, across: f64, along: f64, hint: Option<&Contact>) -> Option<Contact> {
        match &self.kind {
            Kind::Parameter(axis) => self.parameter_track(*axis, across, (along, along)).at(0.0, hint),
            Kind::Line(0, _) => drop_ball(&self.tree, self.ball, along, across, hint),
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

    /// The track of pass `k` of those at `places`; `None` where the line meets no surface. A plan pass goes on, around
    /// the surface's edge, as far as its neighbours do: beside their ends nothing else cuts the edge.
    fn pass(&self, places: &[f64], k: usize) -> Option<Track> {
        let across = *places.get(k)?;
        let (mut a, mut b) = self.along(across)?;
        for near in [k.checked_sub(1), Some(k + 1)].into_iter().flatten() {
            if let Some((c, d)) = places.get(near).and_then(|w| self.along(*w)) {
                (a, b) = (a.min(c), b.max(d));
            }
        }
        Some(match &self.kind {
            Kind::Parameter(axis) => self.parameter_track(*axis, across, (a, b)),
            Kind::Line(0, _) => self.line(Point2::new(a, across), Point2::new(b, across))?,
            Kind::Line(..) => self.line(Point2::new(across, a), Point2::new(across, b))?,
        })
    }

    /// A plan line, cut back to where the ball touches at both ends.
    fn line(&self, mut from: Point2, mut to: Point2) -> Option<Track> {
        const TRIES: u32 = 40;
        for _ in 0..TRIES {
            let length = (to - from).norm();
            if length.is_nan() || length <= 1e-3 {
                return None;
            }
            let touches = |p: Point2| drop_ball(&self.tree, self.ball, p.x, p.y, None).is_some();
            let (a, b) = (touches(from), touches(to));
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
            (Guide::Curve(from), Guide::Curve(to)) => {
                let ([along, value], [start, next]) = (*from.last()?, *to.first()?);
                (along == start).then(|| self.parameter_track(1, along, (value, next)))
            }
            (Guide::Line { to: end, .. }, Guide::Line { from: start, .. }) => {
                Some(self.track(Guide::Line { from: *end, to: *start }))
            }
            _ => None,
        }
    }

    /// The passes as tracks, each with its room.
    fn tracks(&self, surface: &Surface, target: Target) -> Result<Vec<(Track, Vec<f64>)>, String> {
        let curved = surface.along == Along::IsoCusp;
        let spread = spread::spread(self, target, curved)?;
        if self.is_plane() {
            let places: Vec<f64> = spread.lines.iter().map(|line| line[0]).collect();
            return Ok((0..places.len())
                .filter_map(|k| Some((self.pass(&places, k)?, Vec::new())))
                .collect());
        }
        let rooms = spread.rooms(target);
        let track = |line: &Line| if curved { self.bent(line) } else { self.straight(line[0]) };
        Ok(spread.lines.iter().map(track).zip(rooms).collect())
    }

    /// A pass along a parameter line.
    fn straight(&self, across: f64) -> Track {
        let Kind::Parameter(axis) = self.kind else { return self.bent(&vec![across; COLUMNS]) };
        self.parameter_track(axis, across, self.along(across).unwrap_or((0.0, 1.0)))
    }

    /// A pass along a curve in the parameters.
    fn bent(&self, line: &Line) -> Track {
        let (from, to) = self.along(line[0]).unwrap_or((0.0, 1.0));
        let at = |k: usize| from + (to - from) * count(k) / count(COLUMNS - 1);
        let places = line.iter().enumerate().map(|(k, across)| [at(k), *across]).collect();
        self.track(Guide::Curve(Arc::new(places)))
    }

    /// All passes and the ways between them, in the order they are cut.
    pub(super) fn legs(&self, surface: &Surface) -> Result<Vec<Leg>, String> {
        let target = match surface.spacing {
            Spacing::Cusp(h) => Target::Cusp(h),
            Spacing::Step(s) => Target::Step(s),
        };
        let mut tracks = self.tracks(surface, target)?;
        if tracks.is_empty() {
            return Err("no pass meets the surface".into());
        }
        if surface.zigzag {
            for (track, room) in tracks.iter_mut().skip(1).step_by(2) {
                *track = track.reversed();
                room.reverse();
            }
        }
        let mut legs: Vec<Leg> = Vec::with_capacity(2 * tracks.len());
        for (track, room) in tracks {
            let link = match legs.last() {
                Some(before) if surface.zigzag => self.link(&before.track, &track),
                _ => None,
            };
            if let Some(before) = legs.last_mut() {
                before.last = link.is_none();
            }
            legs.extend(link.map(|track| Leg { track, room: Vec::new(), last: false }));
            legs.push(Leg { track, room, last: false });
        }
        if let Some(end) = legs.last_mut() {
            end.last = true;
        }
        Ok(legs)
    }
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)))
}

/// Plan points of the ball's centre along the four edges of the net, in order around it.
fn outline(tree: &SurfaceTree, ball: f64) -> Vec<Point2> {
    let net = tree.net();
    let [rows, columns] = net.size().map(count);
    let corners = [[0.0, 0.0], [rows, 0.0], [rows, columns], [0.0, columns]];
    let mut points = Vec::new();
    for (k, from) in corners.iter().enumerate() {
        let to = corners[(k + 1) % 4];
        for i in 0..EDGE {
            let t = f64::from(i) / f64::from(EDGE);
            let jet = net.jet(from[0] + (to[0] - from[0]) * t, from[1] + (to[1] - from[1]) * t);
            if let Some(n) = jet.normal() {
                points.push(Point2::new(jet.p.x + ball * n.x, jet.p.y + ball * n.y));
            }
        }
    }
    points
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
