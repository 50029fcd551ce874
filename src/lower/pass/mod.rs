//! Passes over surfaces as straight lines in space, with vertices on the control's grid.
//!
//! The deviation of a chord from the surface, as the ball sees it, depends on the curvature of the track along the
//! surface's normal. So the track is *developed* ([`chart`]): laid out as a plane curve with that curvature, about which
//! the band is a ribbon of constant width. The fewest links of the ribbon give the vertices; these are taken back
//! to space, set on the grid, and every link is checked by its true distance from the surface. What fails is tried
//! again in a narrower ribbon, and links that still fail are cut in two.
//!
//! Where they are asked for and the control has them, passes are [`arcs`] or [`curves`], if these are fewer blocks.

mod anchors;
mod arcs;
mod chart;
mod curves;
mod vertex;

use std::sync::Arc;

use rayon::prelude::*;

use super::circle;
use super::contour::cannot_fit;
use super::fit::ribbon;
use crate::cl::{Cl, Pass, Record, RecordKind};
use crate::diag::codes::lowering as codes;
use crate::diag::{Code, Sink};
use crate::geom::surface::cutter::bent::{self, Way};
use crate::geom::surface::cutter::stays;
use crate::geom::surface::swept::Question;
use crate::geom::surface::{Contact, Foot, Guide, Track};
use crate::geom::{Point2, Point3, Vec3, cross};
use crate::ir::{Feed, PassShape, at_origin};
use crate::target::{Capabilities, Nurbs, NurbsForm, Plane};
use chart::Chart;
use vertex::{Lattice, Vertex};

/// A fitted pass: where it starts, and its blocks.
pub(super) type Chain = Vec<Step>;

/// A block of a pass.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Step {
    /// Its end, in steps of the grid.
    pub to: [i64; 3],
    /// What leads there.
    pub form: Form,
}

/// What a block of a pass draws.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Form {
    Line,
    /// Its plane, centre minus start along the plane's axes, in centre steps, and whether it is clockwise.
    Arc(Plane, [i64; 2], bool),
    /// A curve of the control; its table position is told when it is cut.
    Curve(Box<Nurbs>),
}

/// Parts of the band, on either side, that are left to the rounding of vertices: tried in this order, steps of the grid.
const MARGINS: [f64; 6] = [0.02, 0.15, 0.3, 0.5, 0.9, 1.5];
/// Slack of the check, mm; far below what verification allows.
const SLACK: f64 = 4e-7;
/// Vertices on the grid may be so far to the side of a track, in steps.
const GRID: f64 = 2.0;
/// Where a cutter touches in leaps, links about the leaps are cut in any case: another margin is tried if more than one link
/// in so many was.
const FEW: usize = 12;
/// Distances off the track at which vertices are tried where the gates of a ribbon cross, as shares of the band.
const OFFS: [f64; 3] = [0.5, 0.1, 0.9];
/// Where walls that a cutter touches at once are so steep to one another (the cosine between their normals), a vertex off one of
/// them may be within the other.
const SHARP: f64 = 0.3;
/// Cuts of one failing link at most.
const DEEPEST: u32 = 12;

/// Why a pass cannot be fitted, and where the tip is.
#[derive(Debug, Clone, Copy)]
struct Trouble {
    at: Point3,
    lost: bool,
}

/// What passes may be made of besides lines.
#[derive(Debug, Clone, Copy, Default)]
struct Allowed {
    arcs: bool,
    curves: Option<NurbsForm>,
}

/// Fits all passes of a program, in parallel; one entry a record, `None` where it is no pass.
pub(super) fn fit_all(cl: &Cl, capabilities: &Capabilities, sink: &mut Sink) -> Vec<Option<Arc<Chain>>> {
    let tasks: Vec<Option<Fittable<'_>>> = cl
        .records
        .par_iter()
        .map(|record| match &record.kind {
            RecordKind::Pass(pass) => Some(Task::new(pass, capabilities)),
            _ => None,
        })
        .collect();
    let (tasks, allowed) = (joined(tasks), allowed(cl, capabilities, sink));
    let fitted: Vec<Option<Result<Chain, Trouble>>> = tasks
        .into_par_iter()
        .zip(allowed)
        .map(|(task, allowed)| Some(task?.and_then(|task| fit(&task, allowed, capabilities))))
        .collect();
    let mut told = Vec::new();
    let mut out = Vec::with_capacity(fitted.len());
    for (record, result) in cl.records.iter().zip(fitted) {
        out.push(match result {
            Some(Ok(chain)) => Some(Arc::new(chain)),
            Some(Err(trouble)) => {
                let span = cl.origins[record.origin].span;
                if let (RecordKind::Pass(pass), false) = (&record.kind, told.contains(&span)) {
                    told.push(span);
                    sink.push(no_pass(cl, record.origin, pass, trouble, capabilities));
                }
                None
            }
            None => None,
        });
    }
    out
}

/// What the passes may be made of, one entry a record; tells of operations that ask for what the control does not have.
fn allowed(cl: &Cl, capabilities: &Capabilities, sink: &mut Sink) -> Vec<Allowed> {
    let (mut told, mut feed) = (Vec::new(), None);
    let mut of = |record: &Record| {
        let pass = match &record.kind {
            RecordKind::Pass(pass) => pass,
            RecordKind::Feed(own) => {
                feed = Some(*own);
                return Allowed::default();
            }
            _ => return Allowed::default(),
        };
        let by_turn = matches!(feed, Some(Feed::PerRevolution(_))) && capabilities.feed_per_revolution;
        let (allowed, missing) = allowed_for(pass, capabilities, by_turn);
        let span = cl.origins[record.origin].span;
        if let Some((code, why)) = missing.filter(|_| !told.contains(&span)) {
            told.push(span);
            let instead = if allowed.arcs { "arcs" } else { "lines" };
            let message = format!("the passes are cut by {instead}: {why}");
            sink.push(at_origin(code, &cl.origins, record.origin, message));
        }
        allowed
    };
    cl.records.iter().map(&mut of).collect()
}

/// What a pass may be made of, and why that is not what it asks for.
fn allowed_for(
    pass: &Pass,
    capabilities: &Capabilities,
    by_turn: bool,
) -> (Allowed, Option<(&'static Code, String)>) {
    let (plane, name) = (arcs::plane_of(&pass.track.guide), &capabilities.name);
    let has = |plane: Plane| capabilities.arcs && capabilities.planes.contains_key(&plane);
    let arcs = Allowed { arcs: plane.is_some_and(has), curves: None };
    match pass.shape {
        PassShape::Lines => (Allowed::default(), None),
        PassShape::Arcs => {
            let missing = plane.filter(|plane| !has(*plane));
            let why =
                |plane: Plane| format!("`{name}` has no arcs in the {} plane", circle::plane_name(plane));
            (arcs, missing.map(|plane| (&codes::ARC_AS_LINES, why(plane))))
        }
        PassShape::Curves => match curves::form(capabilities, by_turn) {
            Ok(form) => (Allowed { arcs: false, curves: Some(form) }, None),
            Err(obstacle) => (arcs, Some((&codes::NO_NURBS, obstacle.text(name)))),
        },
    }
}

fn no_pass(
    cl: &Cl,
    origin: crate::arena::Handle<crate::ir::Origin>,
    pass: &Pass,
    trouble: Trouble,
    capabilities: &Capabilities,
) -> crate::diag::Diagnostic {
    let p = trouble.at;
    let place = format!("({:.4}, {:.4}, {:.4}) mm", p.x, p.y, p.z);
    let message = if trouble.lost {
        format!("the pass loses the surface near {place}: the cutter touches nothing there")
    } else {
        format!("no lines on the grid of the control keep a pass within its tolerance near {place}")
    };
    cannot_fit(cl, origin, pass.band, message, capabilities)
}

/// Passes that follow on one another meet in one vertex, where either's band allows the other's.
fn joined(mut tasks: Vec<Option<Fittable<'_>>>) -> Vec<Option<Fittable<'_>>> {
    for i in 1..tasks.len() {
        let (before, after) = tasks.split_at_mut(i);
        let (Some(Some(Ok(one))), Some(Some(Ok(next)))) = (before.last_mut(), after.first_mut()) else {
            continue;
        };
        let (tail, head) = (one.ends[1].steps, next.ends[0].steps);
        // Passes that keep to a plane take no vertex beside it: two of them may meet where their planes do.
        let corner = |z: i64| {
            let mut steps = [tail[0], tail[1], z];
            if let Some(kept) = next.lattice.kept() {
                steps[kept] = head[kept];
            }
            steps
        };
        let both = [tail, head, corner(tail[2]), corner(head[2])]
            .into_iter()
            .find_map(|steps| one.end_at(1, steps).zip(next.end_at(0, steps)));
        if let Some((end, start)) = both {
            one.ends[1] = end;
            next.ends[0] = start;
        }
    }
    tasks
}

/// A pass that can be fitted, or why it cannot.
type Fittable<'a> = Result<Task<'a>, Trouble>;

/// What a pass is fitted with.
struct Task<'a> {
    track: Track,
    /// Exact contacts at its ends.
    contacts: [Contact; 2],
    /// Vertices there.
    ends: [Vertex; 2],
    lattice: Lattice,
    /// Radius of the ball that rounds the cutter, with what it leaves, mm.
    ball: f64,
    /// Range of the distance from the exact track along the normal, mm.
    low: f64,
    high: f64,
    room: &'a [f64],
}

fn fit(task: &Task<'_>, allowed: Allowed, capabilities: &Capabilities) -> Result<Chain, Trouble> {
    let ([first, last], [head, tail]) = (task.contacts, task.ends);
    let chart = Chart::new(&task.track, 0.015 * (task.high - task.low), (first, last))
        .ok_or_else(|| lost(&task.track))?;
    let lines = task.best(&chart, head, tail);
    let ends = (head, tail);
    let (bent, blocks) = match allowed {
        Allowed { curves: Some(form), .. } => {
            let most = lines.as_ref().map_or(usize::MAX, Vec::len);
            let chain = curves::chain(task, &chart, ends, (form, capabilities), most);
            let blocks = chain.as_ref().map_or(0, |chain| curves::blocks(chain, form));
            (chain, blocks)
        }
        Allowed { arcs: true, .. } => {
            let chain = arcs::chain(task, &chart, ends, capabilities);
            let blocks = chain.as_ref().map_or(0, Vec::len);
            (chain, blocks)
        }
        Allowed { .. } => (None, 0),
    };
    match (bent, lines) {
        (Some(bent), Ok(lines)) => Ok(if blocks < lines.len() { bent } else { lines }),
        (Some(bent), Err(_)) => Ok(bent),
        (None, lines) => lines,
    }
}

/// A pass that loses the surface, told at its middle.
fn lost(track: &Track) -> Trouble {
    Trouble { at: track.at(0.5, None).map_or_else(Point3::origin, |c| c.centre), lost: true }
}

impl<'a> Task<'a> {
    fn new(pass: &'a Pass, capabilities: &Capabilities) -> Result<Task<'a>, Trouble> {
        let step = capabilities.grid.linear_step();
        let share = capabilities.path_tolerance.map_or(0.0, |p| p.share);
        let reserved = share * pass.band.into.min(pass.band.out);
        let (low, high) = (reserved - pass.band.into, pass.band.out - reserved);
        let lattice = Lattice::new(step, pass.tip, &pass.track.guide);
        let track = lattice.snapped(&pass.track);
        let (Some(first), Some(last)) = (track.at(0.0, None), track.at(1.0, None)) else {
            return Err(lost(&track));
        };
        let ends = [(first, 0.0), (last, 1.0)].map(|(c, t)| {
            let aslant = direction(&track, &lattice, c.normal, t);
            lattice.vertex(&c, 0.5 * (low + high), (low, high), aslant)
        });
        let [Some(head), Some(tail)] = ends else { return Err(Trouble { at: first.centre, lost: false }) };
        let (contacts, ends) = ([first, last], [head, tail]);
        let (ball, room) = (pass.track.radius, pass.room.as_slice());
        Ok(Task { track, contacts, ends, lattice, ball, low, high, room })
    }

    /// A vertex given for the start (0) or the end (1), where the band holds it.
    fn end_at(&self, end: usize, steps: [i64; 3]) -> Option<Vertex> {
        self.lattice.given(&self.contacts[end], steps, (self.low, self.high), self.ends[end].steps)
    }

    /// The fewest blocks over all margins.
    fn best(&self, chart: &Chart, head: Vertex, tail: Vertex) -> Result<Chain, Trouble> {
        let mut best: Option<Vec<Vertex>> = None;
        let mut trouble = Trouble { at: head.centre, lost: false };
        for margin in MARGINS {
            let margin = (margin * self.lattice.step).min(0.45 * (self.high - self.low));
            let vertices = self.vertices(chart, margin, head, tail);
            match self.repaired(chart, &vertices) {
                Ok((chain, cuts)) => {
                    let bearable = if self.is_round() { 0 } else { chain.len() / FEW };
                    if best.as_ref().is_none_or(|b| chain.len() < b.len()) {
                        best = Some(chain);
                    }
                    if cuts <= bearable {
                        break;
                    }
                }
                Err(at) => trouble = at,
            }
        }
        let line = |v: &Vertex| Step { to: v.steps, form: Form::Line };
        best.map(|chain| chain.iter().map(line).collect()).ok_or(trouble)
    }

    fn is_round(&self) -> bool {
        self.track.cutter.is_ball()
    }

    /// The vertices of a path with the fewest links in the ribbon that `margin` leaves.
    fn vertices(&self, chart: &Chart, margin: f64, head: Vertex, tail: Vertex) -> Vec<Vertex> {
        let mut out = vec![head];
        for piece in chart.pieces() {
            let (low, high) = (self.low + margin, self.high - margin);
            let (start, end) =
                (out.last().copied().unwrap_or(head), (piece.1 == chart.len() - 1).then_some(tail));
            let end = end.or_else(|| self.between(chart, piece.1, 0.5 * (low + high)));
            let from = chart.place(piece.0, start.off.clamp(low, high));
            let to = chart.place(piece.1, end.map_or(0.5 * (low + high), |v| v.off).clamp(low, high));
            let ribbon = chart.ribbon(piece, low, high);
            let knots = ribbon::fewest(&ribbon, from, to);
            match knots {
                Some(knots) => {
                    for knot in knots {
                        out.extend(self.knot(chart, piece.0, knot.at, knot.next));
                    }
                }
                None => self.stations(chart, piece, (low, high), &mut out),
            }
            out.extend(end);
        }
        out.dedup_by(|b, a| a.steps == b.steps);
        out
    }

    /// The vertex in which the pieces before and after a station meet.
    fn between(&self, chart: &Chart, station: usize, off: f64) -> Option<Vertex> {
        let (contact, t) = (chart.contact(station), chart.t(station));
        let after = chart.contact((station + 1).min(chart.len() - 1));
        let sharp = contact.normal.dot(&after.normal) < SHARP;
        let range = (self.low, self.high);
        let corner = self.lattice.midway(contact.normal, after.normal).filter(|_| sharp);
        match corner.and_then(|n| self.lattice.vertex(&contact, off, range, n)) {
            Some(vertex) => Some(Vertex { t, ..vertex }),
            None => self.vertex(&contact, off, t),
        }
    }

    /// Where the gates of the ribbon cross: vertices at stations, each as far on as a straight way holds, at one of a
    /// few distances off the track.
    fn stations(
        &self,
        chart: &Chart,
        (first, last): (usize, usize),
        (low, high): (f64, f64),
        out: &mut Vec<Vertex>,
    ) {
        let mut from = first;
        while from + 1 < last {
            let Some(start) = out.last().copied() else { return };
            let reached =
                OFFS.map(|share| self.farthest(chart, &start, (from, last), low + share * (high - low)));
            let Some((station, vertex)) = reached.into_iter().flatten().max_by_key(|(station, _)| *station)
            else {
                return;
            };
            out.push(vertex);
            from = station;
        }
    }

    /// The farthest station before `last` that a straight way reaches so far off the track, or the next one.
    fn farthest(
        &self,
        chart: &Chart,
        start: &Vertex,
        (from, last): (usize, usize),
        off: f64,
    ) -> Option<(usize, Vertex)> {
        let at = |i: usize| self.vertex(&chart.contact(i), off, chart.t(i));
        let holds = |i: usize| at(i).is_some_and(|v| self.holds(start, v.steps));
        let near = reached((from, last), 1, holds);
        at(near).map(|vertex| (near, vertex))
    }

    /// A knot of the chart in space, on the grid.
    fn knot(&self, chart: &Chart, first: usize, at: Point2, next: usize) -> Option<Vertex> {
        let (t, off, hint) = chart.locate(first + next, at);
        let contact = self.track.at(t, Some(&hint))?;
        let mut vertex = self.vertex(&contact, off, t)?;
        vertex.t = t;
        Some(vertex)
    }

    /// The vertex near a contact, at a parameter of the track, that is about so far off it.
    ///
    /// Over a way in plan a vertex moves aslant to the normal, and its distance from the surface is not quite what the
    /// normal tells: it is set right where that leaves the band.
    fn vertex(&self, contact: &Contact, off: f64, t: f64) -> Option<Vertex> {
        const TRIES: u32 = 4;
        let range = (self.low, self.high);
        let aslant = direction(&self.track, &self.lattice, contact.normal, t);
        let mut vertex = self.lattice.vertex(contact, off.clamp(self.low, self.high), range, aslant)?;
        if aslant == contact.normal {
            return Some(vertex);
        }
        for _ in 0..TRIES {
            let off = self.off(&vertex);
            let beyond = off - off.clamp(self.low, self.high);
            if beyond.abs() <= SLACK {
                break;
            }
            let nearer = vertex.off - beyond - 0.5 * self.lattice.step * beyond.signum();
            vertex = self.lattice.vertex(contact, nearer.clamp(self.low, self.high), range, aslant)?;
        }
        Some(vertex)
    }

    /// How far the cutter is off the track's distance from the surface at a vertex, mm.
    fn off(&self, vertex: &Vertex) -> f64 {
        let (tree, place) = (&self.track.tree, vertex.centre);
        let far = self.ball + 2.0 * self.high;
        let foot = if self.track.cutter.is_ball() {
            tree.nearest(place, Some(&vertex.foot))
        } else {
            tree.near(&self.track.cutter, (place, place), far, SLACK, Some(&vertex.foot))
        };
        foot.distance - self.ball
    }

    /// The chain with failing links cut in two until they hold; with the number of cuts that a narrower ribbon might save.
    fn repaired(&self, chart: &Chart, vertices: &[Vertex]) -> Result<(Vec<Vertex>, usize), Trouble> {
        let mut out: Vec<Vertex> =
            vec![*vertices.first().ok_or(Trouble { at: Point3::origin(), lost: true })?];
        let mut cuts = 0;
        let mut places: Vec<f64> = chart.parameters(vertices);
        places.reverse();
        let mut rest: Vec<(Vertex, u32)> = vertices.iter().skip(1).rev().map(|v| (*v, 0)).collect();
        let mut from_t = places.pop().unwrap_or(0.0);
        let mut rest_t = places;
        while let (Some(&(to, depth)), Some(&to_t)) = (rest.last(), rest_t.last()) {
            let from = out[out.len() - 1];
            let same = from.steps == to.steps;
            let beside = same || self.aside(&from, &to, (from_t, to_t));
            if same || beside && self.holds(&from, to.steps) {
                out.push(to);
                rest.pop();
                rest_t.pop();
                from_t = to_t;
                continue;
            }
            let t = 0.5 * (from_t + to_t);
            let middle = self.track.at(t, None);
            let middle = middle.and_then(|c| self.vertex(&c, 0.5 * (self.low + self.high), t));
            let Some(middle) = middle.filter(|_| depth < DEEPEST) else {
                return Err(Trouble { at: from.centre, lost: false });
            };
            cuts += usize::from(beside || self.is_round());
            if let Some(last) = rest.last_mut() {
                last.1 = depth + 1;
            }
            rest.push((middle, depth + 1));
            rest_t.push(t);
        }
        out.dedup_by(|b, a| a.steps == b.steps);
        Ok((out, cuts))
    }

    /// Whether the straight way between two vertices stays beside the track no farther than there is room.
    ///
    /// Where the axis runs over a curve in plan that is told there, else along the surface.
    fn aside(&self, from: &Vertex, to: &Vertex, (a, b): (f64, f64)) -> bool {
        const PLACES: u32 = 6;
        if self.room.is_empty() {
            return true;
        }
        let (p, q) = (self.lattice.centre(from.steps), self.lattice.centre(to.steps));
        let Some(along) = (q - p).try_normalize(0.0) else { return true };
        let mut hint = None;
        (1..PLACES).all(|k| {
            let t = a + (b - a) * f64::from(k) / f64::from(PLACES);
            let beside = if let Some(plan) = self.track.guide.plan(self.track.tree.net(), t) {
                let way = along.xy().try_normalize(0.0).unwrap_or_default();
                cross(way, plan - p.xy())
            } else {
                hint = self.track.at(t, hint.as_ref());
                let Some(contact) = &hint else { return false };
                (contact.centre - p).dot(&along.cross(&contact.normal))
            };
            beside.abs() <= self.room_at(t)
        })
    }

    /// Room at a parameter, and never less than what vertices on the grid take.
    fn room_at(&self, t: f64) -> f64 {
        let last = self.room.len() - 1;
        let x = t.clamp(0.0, 1.0) * crate::math::count(last);
        let i = (x.floor() as usize).min(last);
        let (a, b) = (self.room[i], self.room[(i + 1).min(last)]);
        a.min(b).max(GRID * self.lattice.step)
    }

    /// The band, as distances of the ball's centre.
    fn question(&self) -> Question {
        Question { enough: self.ball + self.low, little: self.ball + self.high, accuracy: SLACK }
    }

    /// Whether the straight way from a vertex to a place on the grid stays in the band.
    fn holds(&self, from: &Vertex, to: [i64; 3]) -> bool {
        let (question, track) = (self.question(), &self.track);
        let way = (self.lattice.centre(from.steps), self.lattice.centre(to));
        stays(&track.tree, &track.cutter, way, &question, &from.foot)
    }

    /// Whether a bent way of the centre stays in the band; `foot` is near its start.
    fn follows(&self, way: &Way<'_>, foot: &Foot) -> bool {
        let (question, track) = (self.question(), &self.track);
        bent::along(&track.tree, &track.cutter, way, &question, Some(foot)).is_some_and(|found| {
            found.least.distance >= question.enough - 2.0 * SLACK
                && found.most.distance <= question.little + 2.0 * SLACK
        })
    }
}

/// The farthest station before `last` that is reached from `from`, looked for in strides that double from `stride` on and then
/// by halves; at least the next one.
fn reached((from, last): (usize, usize), stride: usize, reaches: impl Fn(usize) -> bool) -> usize {
    let (mut near, mut step) = (from + 1, stride.max(1));
    while near + step < last && reaches(near + step) {
        near += step;
        step *= 2;
    }
    let mut far = (near + step).min(last);
    while far > near + 1 {
        let middle = near + (far - near) / 2;
        if reaches(middle) {
            near = middle;
        } else {
            far = middle;
        }
    }
    near
}

/// Where vertices lie off a track: along the normal, but in the vertical plane of a way in plan.
fn direction(track: &Track, lattice: &Lattice, normal: Vec3, t: f64) -> Vec3 {
    const NEAR: f64 = 1e-4;
    let net = track.tree.net();
    let (before, after) = ((t - NEAR).max(0.0), (t + NEAR).min(1.0));
    let (Some(a), Some(b)) = (track.guide.plan(net, before), track.guide.plan(net, after)) else {
        return lattice.sideways(normal);
    };
    let Some(way) = (b - a).try_normalize(1e-12) else { return normal };
    let across = Vec3::new(-way.y, way.x, 0.0);
    (normal - across * normal.dot(&across)).try_normalize(1e-9).unwrap_or(normal)
}

/// Whether a guide is a straight line along x (0) or y (1).
fn axis_of(guide: &Guide) -> Option<usize> {
    match guide {
        Guide::Line { from, to } if from.y == to.y => Some(0),
        Guide::Line { from, to } if from.x == to.x => Some(1),
        _ => None,
    }
}
