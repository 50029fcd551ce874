//! The tube about a curve as a sequence of gates, in grid coordinates.
//!
//! A *station* is an exact point of the curve; a *gate* is the piece of its normal that lies in the band. Between
//! neighbouring stations the boundary of the tube differs from the chord of the gates' ends by less than the
//! sampling error, which is taken off the band (or added to it, for lower bounds) on the side where it matters.
//! Everything that searches works on [`Gates`], in units of the grid, so that a legal vertex is a pair of integers.

use super::{FitError, Grid, Tube};
use crate::geom::curve::{Frenet, PlanarCurve, Shape};
use crate::geom::{Point2, Vec2, cross};
use crate::math;

/// Slack of the band for the rounding of double precision, mm.
pub const ROUNDING: f64 = 1e-9;
/// Tangents that differ by less, rad, are taken for the same.
const SMOOTH: f64 = 1e-7;
/// Largest turn of the tangent between two stations, rad.
const TURN: f64 = 0.1;
/// Turn of the normal between two gates of a corner's fan, rad.
const FAN: f64 = 0.08;
/// An offset towards the centre of curvature goes no further than this part of the radius.
const CENTRE: f64 = 0.9;
/// A tip moves no farther than the boundaries beside it, over this.
const STEEPEST: f64 = 0.2;
/// Smallest sampling error that is resolved, mm.
const FINEST: f64 = 1e-9;
/// More stations than this are not a path but a mistake in the tolerance.
const MOST_STATIONS: usize = 6_000_000;
/// More links than this, too.
const MOST_LINKS: f64 = 400_000.0;

/// The plane in which a primitive is a straight line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Plane {
    /// x and y, both in steps of this many mm.
    Xy {
        /// mm per grid unit.
        step: f64,
    },
    /// Radius and polar angle (in this order: it keeps left on the left).
    Polar {
        /// mm per grid unit of the radius.
        step: f64,
        /// Degrees per grid unit of the angle.
        angle_step: f64,
    },
}

impl Plane {
    /// The plane of straight lines.
    #[must_use]
    pub fn xy(grid: &Grid) -> Plane {
        Plane::Xy { step: grid.step }
    }
    /// The plane of Archimedean spirals.
    #[must_use]
    pub fn polar(grid: &Grid) -> Plane {
        Plane::Polar { step: grid.step, angle_step: grid.angle_step }
    }
    /// Grid coordinates of a point, the angle nearest to that of `near`.
    #[must_use]
    pub fn to_grid(self, p: Point2, near: Vec2) -> Vec2 {
        match self {
            Plane::Xy { step } => p.coords / step,
            Plane::Polar { step, angle_step } => {
                let turn = 360.0 / angle_step;
                let angle = math::atan2(p.y, p.x) / math::DEG / angle_step;
                let angle = angle + ((near.y - angle) / turn).round() * turn;
                Vec2::new(math::hypot(p.x, p.y) / step, angle)
            }
        }
    }
    /// The point of the part, mm, at these grid coordinates.
    #[must_use]
    pub fn to_part(self, v: Vec2) -> Point2 {
        match self {
            Plane::Xy { step } => Point2::from(v * step),
            Plane::Polar { step, angle_step } => {
                let (sin, cos) = math::sin_cos(v.y * angle_step * math::DEG);
                Point2::new(v.x * step * cos, v.x * step * sin)
            }
        }
    }
    /// How far one lap about a closed curve moves the grid coordinates.
    fn lap(self, ccw: bool) -> Vec2 {
        match self {
            Plane::Xy { .. } => Vec2::zeros(),
            Plane::Polar { angle_step, .. } => {
                Vec2::new(0.0, if ccw { 1.0 } else { -1.0 } * (360.0 / angle_step).round())
            }
        }
    }
    /// Curvature that counts for the length of a primitive, 1/mm: a chord of length s leaves the curve by κs²/8.
    fn curvature(self, f: &Frenet) -> f64 {
        match self {
            Plane::Xy { .. } => f.k.abs(),
            Plane::Polar { .. } => {
                // r'' = (r² + 2r'² − κ(r² + r'²)^1.5)/r of the curve as r(θ); its sagitta seen along the normal
                let r = f.p.coords.norm().max(1e-12);
                let sin = (cross(f.p.coords, f.t) / r).abs().max(1e-9);
                let cos = f.p.coords.dot(&f.t) / r;
                let (k, slope) = (f.k * cross(f.p.coords, f.t).signum(), cos / sin);
                let second = r * (1.0 + 2.0 * slope * slope - k * r / (sin * sin * sin));
                second.abs() * sin * sin * sin / (r * r)
            }
        }
    }
}

/// A point of the curve whose normal is a gate.
#[derive(Debug, Clone, Copy)]
pub struct Station {
    /// Parameter.
    pub u: f64,
    /// Span between breaks.
    pub span: usize,
    /// Frenet data; at a corner's fan the tangent is turned between those of the spans, and the speed is 0.
    pub frenet: Frenet,
    /// Number of the smooth run it belongs to; a corner's fan is a run of its own.
    run: u32,
}

/// A break of the tangent.
#[derive(Debug, Clone, Copy)]
pub struct Corner {
    /// Last station of the span before.
    pub first: usize,
    /// First station of the span after (one lap further when the corner is the seam of a closed curve).
    pub last: usize,
    /// Where.
    pub point: Point2,
    /// Sum of the two tangents, normalised.
    pub along: Vec2,
    /// Sine of half the turn, positive for a left turn.
    pub half_sin: f64,
}

impl Corner {
    /// Unit bisector, to the left.
    #[must_use]
    pub fn bisector(&self) -> Vec2 {
        crate::geom::left(self.along)
    }
    /// Cosine of half the turn.
    fn half_cos(&self) -> f64 {
        (1.0 - self.half_sin * self.half_sin).max(0.0).sqrt()
    }
}

/// A curve as stations.
#[derive(Debug)]
pub struct Stations {
    /// In order; a closed curve's first station is not repeated.
    pub stations: Vec<Station>,
    /// Tangent breaks in order.
    pub corners: Vec<Corner>,
    /// Whether the curve is closed.
    pub closed: bool,
    /// Plane the spacing is made for.
    pub plane: Plane,
    /// Number of primitives that a smooth curve of this length and curvature takes, about.
    pub estimate: f64,
}

/// Which way the sampling error is counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Guard {
    /// The gates' tube lies inside the true one: for paths.
    Inside,
    /// The gates' tube contains the true one: for lower bounds.
    Outside,
}

/// The tube as gates: ends of the pieces of normal, in grid units.
#[derive(Debug, Clone)]
pub struct Gates {
    /// Left ends.
    pub l: Vec<Vec2>,
    /// Right ends.
    pub r: Vec<Vec2>,
    /// What one lap adds; zero for an open curve.
    pub lap: Vec2,
    /// Whether indices wrap.
    pub closed: bool,
}

impl Gates {
    /// Gates of one lap.
    #[must_use]
    pub fn len(&self) -> usize {
        self.l.len()
    }
    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.l.is_empty()
    }
    /// Left end of gate `i`, which may be laps further on a closed curve.
    #[inline]
    #[must_use]
    pub fn left(&self, i: usize) -> Vec2 {
        pick(&self.l, i, self.lap)
    }
    /// Right end of gate `i`.
    #[inline]
    #[must_use]
    pub fn right(&self, i: usize) -> Vec2 {
        pick(&self.r, i, self.lap)
    }
}

#[inline]
fn pick(points: &[Vec2], mut i: usize, lap: Vec2) -> Vec2 {
    let n = points.len();
    if i < n {
        return points[i];
    }
    let mut shift = Vec2::zeros();
    while i >= n {
        i -= n;
        shift += lap;
    }
    points[i] + shift
}

impl Stations {
    /// Stations of the tube's curve, so dense that chords of the tube's boundaries err by about `error` times its width.
    ///
    /// # Errors
    /// [`FitError::BadCurve`] at cusps and non-finite points, [`FitError::NotStarShaped`] in the polar plane,
    /// [`FitError::BandTooNarrow`] when the band is beyond what double precision can follow.
    pub fn new(tube: &Tube, plane: Plane, error: Option<f64>) -> Result<Stations, FitError> {
        let estimate = estimate(tube, plane)?;
        let have = tube.left + tube.right;
        if estimate > MOST_LINKS {
            let share = estimate / MOST_LINKS;
            let needed = have.max(FINEST) * share * share;
            let at = checked(tube.curve, 0, tube.curve.domain().0)?.p;
            return Err(FitError::BandTooNarrow { needed, have, at });
        }
        let error = error.unwrap_or_else(|| error_for(estimate));
        let sagitta = (error * (tube.left + tube.right)).max(FINEST);
        let mut sampler = Sampler {
            tube,
            plane,
            eight: 8.0 * sagitta,
            out: Stations {
                stations: Vec::new(),
                corners: Vec::new(),
                closed: tube.curve.is_closed(),
                plane,
                estimate,
            },
            run: 0,
        };
        sampler.run()?;
        Ok(sampler.out)
    }

    /// Gates for the part `scale` of the band about its middle.
    #[must_use]
    pub fn gates(&self, tube: &Tube, scale: f64, guard: Guard) -> Gates {
        let (middle, half) = ((tube.left - tube.right) / 2.0, (tube.left + tube.right) / 2.0 * scale);
        let slack = if guard == Guard::Inside { ROUNDING } else { 2.0 * ROUNDING };
        let (l, tips_l) = self.boundary(middle + half + slack, 1.0, guard);
        let (r, tips_r) = self.boundary(middle - half - slack, -1.0, guard);
        let ccw = self.stations.first().is_some_and(|s| cross(s.frenet.p.coords, s.frenet.t) > 0.0);
        let lap = if self.closed { self.plane.lap(ccw) } else { Vec2::zeros() };
        let mut gates = Gates { l: Vec::new(), r: Vec::new(), lap, closed: self.closed };
        self.map(&l, &r, &mut gates);
        let (shift_l, shift_r) =
            (self.guard(&gates.l, lap, 1.0, guard, &tips_l), self.guard(&gates.r, lap, -1.0, guard, &tips_r));
        for i in 0..gates.l.len() {
            gates.l[i] = dyadic(gates.l[i] + shift_l[i]);
            gates.r[i] = dyadic(gates.r[i] + shift_r[i]);
        }
        gates
    }

    /// The boundary at signed distance `d`, in mm, and the stations whose offsets end at the tip of a corner; `side` +1
    /// for the left boundary, -1 for the right.
    fn boundary(&self, d: f64, side: f64, guard: Guard) -> (Vec<Point2>, Vec<Tip>) {
        let mut points: Vec<Point2> = self
            .stations
            .iter()
            .map(|s| s.frenet.p + s.frenet.n() * clamp_to_centre(d, s.frenet.k))
            .collect();
        let trim = |corner| self.trim(corner, d, side, guard, &mut points);
        let tips = self.corners.iter().filter_map(trim).collect();
        (points, tips)
    }

    /// On the inner side of a corner the offsets of both spans end at the bisector.
    fn trim(&self, corner: &Corner, d: f64, side: f64, guard: Guard, points: &mut [Point2]) -> Option<Tip> {
        let inner = corner.half_sin.signum();
        if d * inner <= 0.0 {
            return None;
        }
        let cos = corner.half_cos().max(1e-3);
        // the far boundary may be as far from the corner itself as from its spans; the near one must clear both spans
        let far = side == inner;
        let reach = if far && guard == Guard::Inside { d } else { d / cos };
        // normals with a nearer foot end at the bisector before the offset
        let foot = d.abs() * corner.half_sin.abs() / cos;
        let tip = corner.point + corner.bisector() * reach;
        let n = self.stations.len();
        for i in corner.first..=corner.last {
            points[i % n] = tip;
        }
        let near =
            |i: usize| (self.stations[i % n].frenet.p - corner.point).norm() < foot * BEYOND.0 + BEYOND.1;
        let run = |i: usize| self.stations[i % n].run;
        let mut first = corner.first;
        while first > 0 && near(first - 1) && run(first - 1) == run(corner.first) {
            first -= 1;
            points[first] = tip;
        }
        let mut last = corner.last;
        while (self.closed || last + 1 < n)
            && near(last + 1)
            && run(last + 1) == run(corner.last)
            && last < corner.last + n
        {
            last += 1;
            points[last % n] = tip;
        }
        Some(Tip { first, last })
    }

    /// Both boundaries in grid coordinates, angles running on.
    fn map(&self, l: &[Point2], r: &[Point2], gates: &mut Gates) {
        let mut near = Vec2::zeros();
        gates.l.reserve_exact(l.len());
        gates.r.reserve_exact(r.len());
        for (l, r) in l.iter().zip(r) {
            let l = self.plane.to_grid(*l, near);
            near = l;
            gates.l.push(l);
            gates.r.push(self.plane.to_grid(*r, near));
        }
    }

    /// How far each point of a boundary must move for the chords to lie inside (outside) the true tube.
    fn guard(&self, points: &[Vec2], lap: Vec2, side: f64, guard: Guard, tips: &[Tip]) -> Vec<Vec2> {
        let n = points.len();
        let inwards = if guard == Guard::Inside { 1.0 } else { -1.0 };
        let share = if guard == Guard::Inside { 0.29 } else { 0.4 };
        let mut sagitta = vec![0.0_f64; n];
        let mut normal = vec![Vec2::zeros(); n];
        for i in 0..n {
            let Some((before, after)) = self.neighbours(points, lap, i) else { continue };
            let chord = after - before;
            let length = chord.norm();
            if length > 0.0 {
                let unit = chord / length;
                // bulge to the inside of the tube, positive
                let bulge = -side * cross(unit, points[i] - before);
                sagitta[i] = (share * bulge * inwards).max(0.0);
                normal[i] = crate::geom::left(unit) * (-side * inwards);
            }
        }
        let mut shifts: Vec<Vec2> = (0..n)
            .map(|i| {
                let around = |k: usize| sagitta[k % n];
                let most = around(i).max(around(i + n - 1)).max(around(i + 1));
                let direction = if normal[i] == Vec2::zeros() { self.toward(&normal, i) } else { normal[i] };
                direction * most
            })
            .collect();
        for tip in tips {
            self.shift_tip(tip, &mut shifts);
        }
        shifts
    }

    /// A tip moves to where the boundaries on both sides of it move: its gates stay in order.
    fn shift_tip(&self, tip: &Tip, shifts: &mut [Vec2]) {
        let n = shifts.len();
        let before =
            if self.closed || tip.first > 0 { shifts[(tip.first + n - 1) % n] } else { Vec2::zeros() };
        let after = if self.closed || tip.last + 1 < n { shifts[(tip.last + 1) % n] } else { Vec2::zeros() };
        let unit = |v: Vec2| if v == Vec2::zeros() { v } else { v.normalize() };
        let (a, b) = (unit(before), unit(after));
        let along = unit(a + b);
        let slant = along.dot(&if a == Vec2::zeros() { b } else { a }).max(STEEPEST);
        let shift = along * (before.norm().max(after.norm()) / slant);
        for i in tip.first..=tip.last {
            shifts[i % n] = shift;
        }
    }

    /// Normal of the nearest neighbour that has one.
    fn toward(&self, normal: &[Vec2], i: usize) -> Vec2 {
        let n = normal.len();
        let (before, after) = (normal[(i + n - 1) % n], normal[(i + 1) % n]);
        if before == Vec2::zeros() { after } else { before }
    }

    /// The points before and after `i` on the same smooth run.
    fn neighbours(&self, points: &[Vec2], lap: Vec2, i: usize) -> Option<(Vec2, Vec2)> {
        let n = points.len();
        if n < 3 || (!self.closed && (i == 0 || i + 1 == n)) {
            return None;
        }
        let (before, after) = ((i + n - 1) % n, (i + 1) % n);
        let same = |k: usize| self.stations[k].run == self.stations[i].run;
        let seam = |k: usize| (i == 0 && k == n - 1 || i == n - 1 && k == 0) && !self.seam_corner();
        if !((same(before) || seam(before)) && (same(after) || seam(after))) {
            return None;
        }
        let p = if i == 0 { points[before] - lap } else { points[before] };
        let q = if i + 1 == n { points[after] + lap } else { points[after] };
        Some((p, q))
    }

    /// Whether a closed curve has a corner where it closes.
    fn seam_corner(&self) -> bool {
        self.corners.last().is_some_and(|c| c.last >= self.stations.len())
    }
}

/// Stations whose offsets end at the tip where those of a corner's sides meet; the last may be a lap further on.
#[derive(Debug, Clone, Copy)]
struct Tip {
    first: usize,
    last: usize,
}

/// Stations up to this times the foot of a tip, and mm beyond, end at the tip too: there are none just beyond it.
const BEYOND: (f64, f64) = (1.0 + 4e-6, 16.0 * ROUNDING);

/// Gates are rounded to this part of a grid unit, so that a lap is added to them exactly.
const DYADIC: f64 = 16_777_216.0;

fn dyadic(v: Vec2) -> Vec2 {
    v.map(|x| (x * DYADIC).round() / DYADIC)
}

/// An offset no further than the centre of curvature allows.
fn clamp_to_centre(d: f64, k: f64) -> f64 {
    if d * k > CENTRE { CENTRE / k } else { d }
}

/// Sampling error by the number of primitives: finer where time allows.
fn error_for(estimate: f64) -> f64 {
    match estimate {
        e if e < 20.0 => 1e-4,
        e if e < 2_000.0 => 1e-3,
        e if e < 20_000.0 => 2.5e-3,
        _ => 1e-2,
    }
}

/// ∫√(κ/8w) ds: the number of primitives of a smooth curve in a band of width w.
fn estimate(tube: &Tube, plane: Plane) -> Result<f64, FitError> {
    let breaks = tube.curve.breaks();
    let per_span = if breaks.len() > 256 { 2 } else { 12 };
    let width = (tube.left + tube.right).max(FINEST);
    let mut sum = 0.0;
    for (span, pair) in breaks.windows(2).enumerate() {
        let du = (pair[1] - pair[0]) / f64::from(per_span);
        for i in 0..per_span {
            let u = pair[0] + du * (f64::from(i) + 0.5);
            let f = checked(tube.curve, span, u)?;
            sum += (plane.curvature(&f) / (8.0 * width)).sqrt() * f.speed * du;
        }
    }
    Ok(sum)
}

/// Frenet data, refused where they are not those of a regular curve.
pub(super) fn checked(curve: &dyn PlanarCurve, span: usize, u: f64) -> Result<Frenet, FitError> {
    let f = curve.at_in(span, u);
    let finite = f.p.x.is_finite() && f.p.y.is_finite() && f.t.x.is_finite() && f.t.y.is_finite();
    if finite && f.k.is_finite() && f.speed.is_finite() && f.speed >= 0.0 {
        Ok(f)
    } else {
        Err(FitError::BadCurve { u })
    }
}

struct Sampler<'a> {
    tube: &'a Tube<'a>,
    plane: Plane,
    /// Eight times the sagitta allowed, mm.
    eight: f64,
    out: Stations,
    run: u32,
}

impl Sampler<'_> {
    fn run(&mut self) -> Result<(), FitError> {
        let breaks = self.tube.curve.breaks();
        if breaks.len() < 2 {
            return Err(FitError::BadCurve { u: self.tube.curve.domain().0 });
        }
        let spans = breaks.len() - 1;
        let joints = self.joints(breaks)?;
        for span in 0..spans {
            let (turn_before, turn_after) = (joints[span], joints[span + 1]);
            self.span(span, (breaks[span], breaks[span + 1]), (turn_before, turn_after))?;
            let last = span + 1 == spans;
            if turn_after.abs() > SMOOTH {
                self.corner(span, (span + 1) % spans, turn_after, last)?;
            } else if last && !self.out.closed {
                self.push(span, breaks[span + 1])?;
            }
        }
        Ok(())
    }

    /// Turn of the tangent at each break, rad; the ends of an open curve have none.
    fn joints(&self, breaks: &[f64]) -> Result<Vec<f64>, FitError> {
        let (curve, spans) = (self.tube.curve, breaks.len() - 1);
        let mut turns = vec![0.0; spans + 1];
        for (i, turn) in turns.iter_mut().enumerate() {
            let seam = i == 0 || i == spans;
            if seam && !self.out.closed {
                continue;
            }
            let before = if i == 0 { spans - 1 } else { i - 1 };
            let a = checked(curve, before, breaks[before + 1])?;
            let b = checked(curve, i % spans, breaks[i % spans])?;
            *turn = math::atan2(cross(a.t, b.t), a.t.dot(&b.t));
            if turn.abs() > math::PI - 1e-3 {
                return Err(FitError::BadCurve { u: breaks[i] });
            }
        }
        Ok(turns)
    }

    fn push(&mut self, span: usize, u: f64) -> Result<Frenet, FitError> {
        let f = checked(self.tube.curve, span, u)?;
        self.star_shaped(&f)?;
        self.put(u, span, f)?;
        Ok(f)
    }

    fn put(&mut self, u: f64, span: usize, frenet: Frenet) -> Result<(), FitError> {
        if self.out.stations.len() >= MOST_STATIONS {
            let have = self.tube.left + self.tube.right;
            return Err(FitError::BandTooNarrow { needed: have.max(FINEST) * 100.0, have, at: frenet.p });
        }
        self.out.stations.push(Station { u, span, frenet, run: self.run });
        Ok(())
    }

    /// In the polar plane the whole tube must turn about the origin in one sense.
    fn star_shaped(&self, f: &Frenet) -> Result<(), FitError> {
        if matches!(self.plane, Plane::Xy { .. }) {
            return Ok(());
        }
        let arm = cross(f.p.coords, f.t);
        let sense = self.out.stations.first().map_or(arm, |s| cross(s.frenet.p.coords, s.frenet.t));
        let clear = arm.abs() > self.tube.left.max(self.tube.right) + 1e-6 * f.p.coords.norm();
        if clear && arm * sense > 0.0 { Ok(()) } else { Err(FitError::NotStarShaped { at: f.p }) }
    }

    /// Stations of one span, its first end included, its last end only where a corner follows.
    fn span(&mut self, span: usize, (start, end): (f64, f64), turns: (f64, f64)) -> Result<(), FitError> {
        let straight =
            matches!(self.tube.curve.shape(span), Shape::Line) && matches!(self.plane, Plane::Xy { .. });
        let first = checked(self.tube.curve, span, start)?;
        let stops = self.stops((start, end), &first, span, turns)?;
        let mut u = start;
        self.push(span, u)?;
        for stop in stops {
            if straight {
                u = stop;
                if u < end || turns.1.abs() > SMOOTH {
                    self.push(span, u)?;
                }
            } else {
                self.steps(span, &mut u, stop, stop >= end && turns.1.abs() <= SMOOTH)?;
            }
        }
        Ok(())
    }

    /// Parameters where a station must be: those where the inner offset meets the bisector of a corner, and the end.
    fn stops(
        &self,
        (start, end): (f64, f64),
        first: &Frenet,
        span: usize,
        turns: (f64, f64),
    ) -> Result<Vec<f64>, FitError> {
        let last = checked(self.tube.curve, span, end)?;
        // a little more than where the offsets of both spans meet, rounding slack included
        let widest = (self.tube.left.max(self.tube.right) + 4.0 * ROUNDING) * (1.0 + 1e-6);
        let foot = |turn: f64| widest * math::tan(turn.abs() / 2.0);
        let mut stops = Vec::with_capacity(3);
        if turns.0.abs() > SMOOTH && first.speed > 0.0 {
            stops.push(start + foot(turns.0) / first.speed);
        }
        if turns.1.abs() > SMOOTH && last.speed > 0.0 {
            stops.push(end - foot(turns.1) / last.speed);
        }
        stops.retain(|u| *u > start && *u < end);
        stops.sort_by(f64::total_cmp);
        stops.push(end);
        Ok(stops)
    }

    /// Stations after `u` up to `stop`; the one at `stop` is left out when `open` (the next span begins with it).
    fn steps(&mut self, span: usize, u: &mut f64, stop: f64, open: bool) -> Result<(), FitError> {
        let mut f = checked(self.tube.curve, span, *u)?;
        let mut previous = f.speed * (stop - *u) / 8.0;
        if previous <= 0.0 {
            previous = f64::INFINITY;
        }
        while *u < stop {
            let ds = self.step_length(&f).min(2.0 * previous);
            let whole = stop - *u;
            let mut du = if f.speed > 0.0 { (ds / f.speed).min(whole) } else { whole / 16.0 };
            let pieces = (whole / du).ceil();
            if pieces <= 4.0 {
                du = whole / pieces;
            }
            let (next, chord) = self.shorten(span, *u, &mut du, &f)?;
            *u = if du >= whole * (1.0 - 1e-9) { stop } else { *u + du };
            previous = chord.max(1e-12);
            f = next;
            if *u < stop || !open {
                self.push(span, *u)?;
            }
        }
        Ok(())
    }

    /// Halves the step until the curvature at its end allows it.
    fn shorten(&self, span: usize, u: f64, du: &mut f64, f: &Frenet) -> Result<(Frenet, f64), FitError> {
        loop {
            let next = checked(self.tube.curve, span, u + *du)?;
            let chord = (next.p - f.p).norm();
            let curvature = self.plane.curvature(f).max(self.plane.curvature(&next));
            let fits = curvature * chord * chord <= 1.7 * self.eight && next.k.abs() * chord <= 2.0 * TURN;
            if fits || u + *du * 0.5 <= u {
                return Ok((next, chord));
            }
            *du *= 0.5;
        }
    }

    fn step_length(&self, f: &Frenet) -> f64 {
        let by_curvature = (self.eight / self.plane.curvature(f).max(1e-12)).sqrt();
        let by_turn = TURN / f.k.abs().max(1e-12);
        let by_angle = match self.plane {
            Plane::Xy { .. } => f64::INFINITY,
            Plane::Polar { .. } => TURN * f.p.coords.norm(),
        };
        by_curvature.min(by_turn).min(by_angle)
    }

    /// The fan of gates about a corner between span `before` (whose last station is there) and span `after`.
    fn corner(&mut self, before: usize, after: usize, turn: f64, last: bool) -> Result<(), FitError> {
        let breaks = self.tube.curve.breaks();
        let a = checked(self.tube.curve, before, breaks[before + 1])?;
        let b = checked(self.tube.curve, after, breaks[after])?;
        let first = self.out.stations.len() - 1;
        let pieces = (turn.abs() / FAN).ceil().max(1.0) as u32;
        self.run += 1;
        for i in 1..pieces {
            let (sin, cos) = math::sin_cos(turn * f64::from(i) / f64::from(pieces));
            let t = a.t * cos + crate::geom::left(a.t) * sin;
            let frenet = Frenet { p: a.p, t, speed: 0.0, k: 0.0 };
            self.star_shaped(&frenet)?;
            self.put(breaks[before + 1], before, frenet)?;
        }
        self.run += 1;
        let _ = last;
        self.out.corners.push(Corner {
            first,
            last: self.out.stations.len(),
            point: a.p,
            along: (a.t + b.t).normalize(),
            half_sin: math::sin(turn / 2.0),
        });
        Ok(())
    }
}
