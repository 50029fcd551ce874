//! Passes as cubic B-splines of the control, with few control points on its grid.
//!
//! [`engine`](crate::lower::fit::nurbs::engine) fits the track in space: what counts is the deviation along the surface's
//! normal, and to the side no more than there is room; along the track a spline may run as it likes. A spline on the grid is
//! checked by its true distance from the surface, Bézier segment by Bézier segment.

use super::vertex::Vertex;
use super::{Chain, Chart, Form, Step, Task};
use crate::cl::spline::segments;
use crate::geom::surface::cutter::bent::Way;
use crate::geom::{Point3, Vec3};
use crate::lower::fit::Knots;
use crate::lower::fit::nurbs::engine::{Course, Deviation, Engine, ROWS};
use crate::lower::fit::nurbs::shares::Shares;
use crate::lower::fit::nurbs::spline::{ORDER, Spline, interval};
use crate::lower::pieces;
use crate::target::{Capabilities, Nurbs, NurbsForm, Position};

/// Parts of the band, on either side, that are left to the rounding of control points: tried in this order, steps of the grid.
const MARGINS: [f64; 2] = [0.4, 1.0];
/// Margins are no less than this share of half the band, so that a curve does not run along its border where a cusp is as
/// high as it may be, and no more than this.
const SHARES: (f64, f64) = (0.15, 0.6);
/// Share of the room to the side that a spline is given before its points are rounded.
const ROOM: f64 = 0.5;
/// Room where none is told, as a multiple of half the band.
const FREE: f64 = 10.0;
/// Turning of one knot interval in the first density, rad.
const TURN: f64 = 0.5;
/// A track is taken to turn by so much in any case, rad.
const STRAIGHT: f64 = 0.05;

/// Why a control cuts no passes by curves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Obstacle {
    None,
    InPlaneOnly,
    Chords,
    Feed,
}

impl Obstacle {
    pub(super) fn text(self, name: &str) -> String {
        match self {
            Obstacle::None => format!("`{name}` has no NURBS"),
            Obstacle::InPlaneOnly => format!("`{name}` has NURBS in the XY plane only"),
            Obstacle::Chords => format!("`{name}` cuts chords of curves"),
            Obstacle::Feed => "their feed is per revolution".to_owned(),
        }
    }
}

/// The form in which the control takes curves in space; `by_turn`: the feed is per revolution.
pub(super) fn form(capabilities: &Capabilities, by_turn: bool) -> Result<NurbsForm, Obstacle> {
    let form = capabilities.nurbs.ok_or(Obstacle::None)?;
    match (capabilities.nurbs_in_space, capabilities.fits_curves(), by_turn) {
        (false, ..) => Err(Obstacle::InPlaneOnly),
        (true, false, _) => Err(Obstacle::Chords),
        (true, true, true) => Err(Obstacle::Feed),
        (true, true, false) => Ok(form),
    }
}

/// The chain of curves of a pass, and lines where it is straight; `None` where that takes as many blocks as `most`, or a part
/// of it cannot be had so.
pub(super) fn chain(
    task: &Task<'_>,
    chart: &Chart,
    (head, tail): (Vertex, Vertex),
    (form, capabilities): (NurbsForm, &Capabilities),
    most: usize,
) -> Option<Chain> {
    let mut out = vec![Step { to: head.steps, form: Form::Line }];
    let mut from = head;
    let all = chart.pieces();
    for (k, piece) in all.iter().enumerate() {
        let to = match k + 1 == all.len() {
            true => tail,
            false => task.between(chart, piece.1, 0.5 * (task.low + task.high))?,
        };
        if from.steps == to.steps {
            continue;
        }
        let ends = (chart.t(piece.0), chart.t(piece.1));
        if task.aside(&from, &to, ends) && task.holds(&from, to.steps) {
            out.push(Step { to: to.steps, form: Form::Line });
        } else {
            let left = most.checked_sub(blocks(&out, form) + form.more_blocks())?;
            for curve in fitted((task, chart), *piece, [from, to], (form, left))? {
                let fits = pieces::fits(&curve, capabilities.ranges.coefficient);
                let end = curve.end().filter(|_| fits)?;
                out.push(Step { to: [end.x, end.y, end.z], form: Form::Curve(Box::new(curve)) });
            }
        }
        from = to;
    }
    Some(out)
}

/// The curves along a piece, of no more than `most` control points (or pieces).
fn fitted(
    (task, chart): (&Task<'_>, &Chart),
    piece: (usize, usize),
    ends: [Vertex; 2],
    (form, most): (NurbsForm, usize),
) -> Option<Vec<Nurbs>> {
    let knots = knots(form);
    if most < knots.blocks(1) {
        return None;
    }
    let half = 0.5 * (task.high - task.low);
    for steps in MARGINS {
        let margin = (steps * task.lattice.step).clamp(SHARES.0 * half, SHARES.1 * half);
        let along = Along::new(task, chart, piece, ends, (form, margin));
        match (Engine { course: &along, knots, most, haste: true }).fit(&along.first_shares()) {
            Ok((_, curves)) => return Some(curves),
            // A narrower band takes more of them.
            Err(needed) if needed > half => return None,
            Err(_) => {}
        }
    }
    None
}

fn knots(form: NurbsForm) -> Knots {
    match form {
        NurbsForm::G062 { knot_decimals } => Knots::Printed { decimals: u32::from(knot_decimals) },
        NurbsForm::G052 => Knots::Uniform,
        NurbsForm::Pieces { finer, .. } => Knots::Pieces { finer },
    }
}

/// Blocks of a chain.
pub(super) fn blocks(chain: &Chain, form: NurbsForm) -> usize {
    let of = |step: &Step| match (&step.form, form) {
        (Form::Curve(curve), NurbsForm::G062 { .. } | NurbsForm::G052) => {
            curve.points.len() + form.more_blocks()
        }
        _ => 1,
    };
    chain.iter().map(of).sum()
}

/// A smooth piece of a track, by its length.
struct Along<'a> {
    task: &'a Task<'a>,
    chart: &'a Chart,
    /// First station.
    first: usize,
    places: Vec<Place>,
    ends: [Vertex; 2],
    form: NurbsForm,
    /// Left of half the band to the rounding of control points, mm.
    margin: f64,
}

/// A station.
#[derive(Debug, Clone, Copy)]
struct Place {
    /// Length from the start, mm.
    s: f64,
    centre: Point3,
    /// Unit vectors: the surface's normal, and along the track.
    normal: Vec3,
    way: Vec3,
}

impl<'a> Along<'a> {
    fn new(
        task: &'a Task<'a>,
        chart: &'a Chart,
        (first, last): (usize, usize),
        ends: [Vertex; 2],
        (form, margin): (NurbsForm, f64),
    ) -> Along<'a> {
        let centre = |i: usize| chart.contact(i).centre;
        let mut s = 0.0;
        let place = |i: usize| {
            s += if i > first { (centre(i) - centre(i - 1)).norm() } else { 0.0 };
            let chord = centre((i + 1).min(last)) - centre(i.saturating_sub(1).max(first));
            let way = chord.try_normalize(0.0).unwrap_or_default();
            Place { s, centre: centre(i), normal: chart.contact(i).normal, way }
        };
        let places = (first..=last).map(place).collect();
        Along { task, chart, first, places, ends, form, margin }
    }

    /// First density of knots: a share for the turning of the way and of the normal.
    fn first_shares(&self) -> Shares {
        let length = self.length().max(f64::MIN_POSITIVE);
        let (mut stations, mut sums) = (Vec::new(), Vec::new());
        let mut sum = 0.0;
        let mut before: Option<&Place> = None;
        for place in &self.places {
            if let Some(before) = before {
                let turn = (place.way - before.way).norm() + (place.normal - before.normal).norm();
                sum += (0.5 * turn + STRAIGHT * (place.s - before.s) / length) / TURN;
            }
            stations.push(place.s);
            sums.push(sum);
            before = Some(place);
        }
        Shares { stations, sums }
    }

    /// The place at a length, between stations.
    fn at(&self, s: f64) -> Place {
        let j = self.places.partition_point(|p| p.s <= s).clamp(1, self.places.len() - 1);
        self.mixed(j, s)
    }

    /// The place at a length before station `j`.
    fn mixed(&self, j: usize, s: f64) -> Place {
        let (a, b) = (&self.places[j - 1], &self.places[j]);
        let share = if b.s > a.s { ((s - a.s) / (b.s - a.s)).clamp(0.0, 1.0) } else { 0.0 };
        let mix = |a: Vec3, b: Vec3| (a + (b - a) * share).try_normalize(0.0).unwrap_or(a);
        let centre = a.centre + (b.centre - a.centre) * share;
        Place {
            s: a.s + (b.s - a.s) * share,
            centre,
            normal: mix(a.normal, b.normal),
            way: mix(a.way, b.way),
        }
    }

    /// The place of the track beside a point, from about station `j` on, which is moved there.
    fn foot(&self, p: Point3, j: &mut usize) -> Place {
        let beyond = |i: usize| {
            let place = &self.places[i];
            (p - place.centre).dot(&place.way)
        };
        let last = self.places.len() - 1;
        while *j < last && beyond(*j) > 0.0 {
            *j += 1;
        }
        while *j > 1 && beyond(*j - 1) < 0.0 {
            *j -= 1;
        }
        let (before, after) = (beyond(*j - 1), -beyond(*j));
        let share = if before + after > 0.0 { (before / (before + after)).clamp(0.0, 1.0) } else { 0.0 };
        let (a, b) = (self.places[*j - 1].s, self.places[*j].s);
        self.mixed(*j, a + (b - a) * share)
    }

    /// Parameter of the track at a length.
    fn t(&self, s: f64) -> f64 {
        let j = self.places.partition_point(|p| p.s <= s).clamp(1, self.places.len() - 1);
        let (a, b) = (self.places[j - 1].s, self.places[j].s);
        let share = if b > a { ((s - a) / (b - a)).clamp(0.0, 1.0) } else { 0.0 };
        let (from, to) = (self.chart.t(self.first + j - 1), self.chart.t(self.first + j));
        from + (to - from) * share
    }

    /// Direction to the side of the track, and the room there.
    fn side(&self, place: &Place) -> Option<(Vec3, f64)> {
        if self.task.lattice.kept().is_some() {
            return None;
        }
        if self.task.room.is_empty() {
            let side = place.normal.cross(&place.way).try_normalize(1e-9)?;
            return Some((side, FREE * self.half()));
        }
        let t = self.t(place.s);
        let in_plan = self.task.track.guide.plan(self.task.track.tree.net(), t).is_some();
        let up = if in_plan { Vec3::z() } else { place.normal };
        let side = up.cross(&place.way).try_normalize(1e-9)?;
        Some((side, self.task.room_at(t)))
    }

    fn without_kept(&self, mut direction: Vec3) -> Vec3 {
        if let Some(kept) = self.task.lattice.kept() {
            direction[kept] = 0.0;
        }
        direction
    }

    /// Deviations, and whether the spline runs forward there.
    fn measured(&self, spline: &Spline<3>) -> Vec<(Deviation<3>, bool)> {
        let mut out: Vec<(Deviation<3>, bool)> = Vec::new();
        let middle = 0.5 * (self.task.low + self.task.high);
        let mut near = 1;
        for i in ORDER - 1..spline.points.len() {
            let (a, b) = (spline.knots[i], spline.knots[i + 1]);
            if b <= a {
                continue;
            }
            for k in u32::from(!out.is_empty())..=ROWS {
                let t = a + (b - a) * f64::from(k) / f64::from(ROWS);
                let jet = spline.jet(interval(&spline.knots, t).min(i), t);
                let foot = self.foot(jet.p, &mut near);
                let from = jet.p - foot.centre;
                let aside = self.side(&foot).map(|(side, room)| (side, from.dot(&side), room * ROOM));
                let (across, off) = (self.without_kept(foot.normal), from.dot(&foot.normal) - middle);
                out.push((Deviation { interval: i, t, across, off, aside }, jet.d.dot(&foot.way) > 0.0));
            }
        }
        out
    }

    /// Control points on the grid, as curves of the control.
    fn on_grid(&self, spline: &Spline<3>) -> Option<Vec<Nurbs>> {
        let lattice = &self.task.lattice;
        if let NurbsForm::Pieces { finer, .. } = self.form {
            return self.in_pieces(spline, finer);
        }
        let mut steps: Vec<[i64; 3]> =
            spline.points.iter().map(|p| lattice.nearest(*p)).collect::<Option<_>>()?;
        let last = steps.len() - 1;
        (steps[0], steps[last]) = (self.ends[0].steps, self.ends[1].steps);
        let point = |[x, y, z]: [i64; 3]| (Position { x, y, z, r: 0 }, 1.0);
        let points = steps.into_iter().map(point).collect();
        Some(vec![Nurbs { order: ORDER as u8, points, knots: spline.knots.clone(), finer: 0 }])
    }

    fn in_pieces(&self, spline: &Spline<3>, finer: u8) -> Option<Vec<Nurbs>> {
        let lattice = &self.task.lattice;
        let parts: Vec<[Point3; ORDER]> = segments(&spline.points, &spline.knots).collect();
        let mut from = self.ends[0].steps;
        let mut out = Vec::new();
        for (i, part) in parts.iter().enumerate() {
            let to =
                if i + 1 == parts.len() { self.ends[1].steps } else { lattice.nearest(part[ORDER - 1])? };
            let points = pieces::rounded(part, [from, to], lattice.step, finer)?;
            out.push(pieces::nurbs(points, 0, finer));
            from = to;
        }
        Some(out)
    }

    /// The centres of a curve's control points, mm.
    fn centres(&self, curve: &Nurbs) -> Vec<Point3> {
        let (lattice, fine) = (&self.task.lattice, curve.fine_steps() as f64);
        let at = |p: &Position| {
            let [x, y, z] = [p.x, p.y, p.z].map(|v| v as f64 / fine * lattice.step);
            lattice.raised(Point3::new(x, y, z))
        };
        curve.points.iter().map(|(p, _)| at(p)).collect()
    }

    /// Whether curves on the grid stay in the band, and beside the track no farther than there is room.
    fn holds(&self, curves: &[Nurbs]) -> bool {
        curves.iter().all(|curve| {
            let spline = Spline { points: self.centres(curve), knots: curve.knots.clone() };
            let beside = self.measured(&spline).iter().all(|(q, forward)| {
                *forward && q.aside.is_none_or(|(_, off, room)| off.abs() * ROOM <= room)
            });
            beside && segments(&spline.points, &spline.knots).all(|segment| self.follows(&segment))
        })
    }

    fn follows(&self, [a, b, c, d]: &[Point3; ORDER]) -> bool {
        let at = |x: f64| {
            let y = 1.0 - x;
            let shares = [y * y * y, 3.0 * x * y * y, 3.0 * x * x * y, x * x * x];
            let sum = [a, b, c, d].iter().zip(shares).map(|(p, share)| p.coords * share).sum::<Vec3>();
            Point3::from(sum)
        };
        let bend = |p: &Point3, q: &Point3, r: &Point3| ((p - q) + (r - q)).norm();
        let bend = 6.0 * bend(a, b, c).max(bend(b, c, d));
        let mut near = self.places.partition_point(|p| (p.centre - a).dot(&p.way) < 0.0);
        near = near.min(self.places.len() - 1);
        self.task.follows(&Way { at: &at, bend }, &self.chart.contact(self.first + near).foot)
    }
}

impl Course<3> for Along<'_> {
    type Printed = Vec<Nurbs>;

    fn length(&self) -> f64 {
        self.places.last().map_or(0.0, |p| p.s)
    }

    fn half(&self) -> f64 {
        0.5 * (self.task.high - self.task.low)
    }

    fn limit(&self) -> f64 {
        self.half() - self.margin
    }

    fn middle(&self, s: f64) -> Point3 {
        let place = self.at(s);
        let n = self.task.lattice.sideways(place.normal);
        place.centre + n * (0.5 * (self.task.low + self.task.high) / n.dot(&place.normal).max(0.05))
    }

    fn ends(&self) -> [Point3; 2] {
        self.ends.map(|end| end.centre)
    }

    fn deviations(&self, spline: &Spline<3>) -> Vec<Deviation<3>> {
        self.measured(spline).into_iter().map(|(deviation, _)| deviation).collect()
    }

    fn print(&self, spline: &Spline<3>) -> Option<Vec<Nurbs>> {
        self.on_grid(spline).filter(|curves| self.holds(curves))
    }
}
