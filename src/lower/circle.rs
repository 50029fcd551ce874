//! CL circles: arcs and helices in the planes the control has, else lines within the tolerance.

use core::f64::consts::FRAC_1_SQRT_2;

use super::arc::{Legal, centre_per_linear, legalise};
use super::emit::Emitter;
use crate::cl::Circle;
use crate::diag::codes;
use crate::geom::{Point2, Point3, Vec3};
use crate::math::{TAU, acos, atan2, ceil_to_usize, hypot, sin_cos};
use crate::target::{FeedWord, GridArc, Motion, Plane, Position};

/// Largest component of a unit vector beside an axis that still counts as along it.
const ALONG: f64 = 1e-6;
/// Angles below this, radians, between start and end of a circle mean a full turn.
const NO_ANGLE: f64 = 1e-9;
/// Lines for one circle at most.
const MOST_LINES: usize = 200_000;
/// Centre steps by which a centre may slide along the bisector of its chord.
const SLIDE: i32 = 24;

/// A helix: angle, height and radius linear in the parameter 0..1.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Helix {
    centre: Point3,
    axis: Vec3,
    /// Unit vectors at the start's radius and a quarter turn on.
    frame: [Vec3; 2],
    /// Start and end radius, mm.
    pub(crate) radius: (f64, f64),
    /// Start and end height over the centre, mm.
    pub(crate) height: (f64, f64),
    /// Angle turned, radians, > 0.
    pub(crate) sweep: f64,
}

impl Helix {
    /// From `from` along `circle`; `None` when the start lies on the axis.
    pub(crate) fn new(from: Point3, circle: &Circle) -> Option<Helix> {
        let axis = circle.axis;
        let (a, b) = (from - circle.centre, circle.to - circle.centre);
        let height = (a.dot(&axis), b.dot(&axis));
        let (ra, rb) = (a - axis * height.0, b - axis * height.1);
        let radius = (ra.norm(), rb.norm());
        if !(radius.0 > 0.0 && radius.1 > 0.0) {
            return None;
        }
        let u = ra / radius.0;
        let v = axis.cross(&u);
        let angle = atan2(rb.dot(&v), rb.dot(&u));
        let angle = if angle <= NO_ANGLE { angle + TAU } else { angle };
        let sweep = angle.min(TAU) + TAU * f64::from(circle.turns);
        Some(Helix { centre: circle.centre, axis, frame: [u, v], radius, height, sweep })
    }

    /// The point at parameter x.
    pub(crate) fn at(&self, x: f64) -> Point3 {
        let (s, c) = sin_cos(self.sweep * x);
        let r = self.radius.0 + (self.radius.1 - self.radius.0) * x;
        let h = self.height.0 + (self.height.1 - self.height.0) * x;
        self.centre + (self.frame[0] * c + self.frame[1] * s) * r + self.axis * h
    }

    /// Bound of the second derivative, mm.
    pub(super) fn bend(&self) -> f64 {
        let change = (self.radius.1 - self.radius.0).abs();
        self.radius.0.max(self.radius.1) * self.sweep * self.sweep + 2.0 * change * self.sweep
    }

    /// The plane it turns in and whether it is clockwise there.
    fn plane(&self) -> Option<(Plane, bool)> {
        [Plane::Xy, Plane::Zx, Plane::Yz].into_iter().find_map(|plane| {
            let [first, second, third] = plane.axes();
            let flat = self.axis[first].abs() <= ALONG && self.axis[second].abs() <= ALONG;
            flat.then_some((plane, self.axis[third] < 0.0))
        })
    }
}

/// Why a circle is not cut by arcs.
enum Reason {
    Tilted,
    NoArcs,
    NoPlane(Plane),
    NoHelix,
    NotOnGrid,
}

impl Reason {
    fn text(&self, name: &str) -> String {
        match self {
            Reason::Tilted => "its axis is along none of X, Y and Z".to_owned(),
            Reason::NoArcs => format!("`{name}` has no arcs"),
            Reason::NoPlane(plane) => format!("`{name}` has no arcs in the {} plane", plane_name(*plane)),
            Reason::NoHelix => format!("`{name}` has no helices"),
            Reason::NotOnGrid => "no arc with printed numbers is near enough to it".to_owned(),
        }
    }
}

pub(super) fn plane_name(plane: Plane) -> &'static str {
    match plane {
        Plane::Xy => "XY",
        Plane::Zx => "ZX",
        Plane::Yz => "YZ",
    }
}

impl Emitter<'_> {
    /// A circle from where the cutter is.
    pub(super) fn circle(&mut self, circle: &Circle) {
        let Some(helix) = self.exact.and_then(|from| Helix::new(from, circle)) else {
            let message = "an arc from nowhere: the cutter is on its axis, or its place is not known";
            return self.complain(&codes::lowering::CANNOT_FIT, message.into());
        };
        let feed = self.linear_feed();
        let end = self.round(circle.to);
        match self.arcs(&helix, circle, end) {
            Ok(parts) => parts.into_iter().for_each(|part| self.part(part, feed)),
            Err(reason) => self.lines(&helix, circle, end, feed, &reason),
        }
        self.exact = Some(circle.to);
    }

    pub(super) fn part(&mut self, (to, arc): Part, feed: FeedWord) {
        match arc {
            None => self.line(to, feed),
            Some((plane, centre, clockwise)) => {
                self.at = [to.x, to.y, to.z, to.r].map(Some);
                self.push(Motion::Arc { to, plane, centre, clockwise, feed });
            }
        }
    }

    /// The arcs of a helix: whole turns, then the rest.
    fn arcs(&self, helix: &Helix, circle: &Circle, end: [i64; 3]) -> Result<Vec<Part>, Reason> {
        let capabilities = self.capabilities;
        let (plane, clockwise) = helix.plane().ok_or(Reason::Tilted)?;
        if !capabilities.arcs {
            return Err(Reason::NoArcs);
        }
        let Some(of_plane) = capabilities.planes.get(&plane) else { return Err(Reason::NoPlane(plane)) };
        let here = self.here();
        let start = [here.x, here.y, here.z];
        let [first, second, third] = plane.axes();
        let rises = start[third] != end[third];
        if rises && !of_plane.helix {
            return Err(Reason::NoHelix);
        }
        let flat = |p: [i64; 3]| [p[first], p[second]];
        let mut parts = Vec::new();
        let mut from = start;
        for turn in 0..=circle.turns {
            let last = turn == circle.turns;
            let x = if last { 1.0 } else { TAU * f64::from(turn + 1) / helix.sweep };
            let mut to = if last { end } else { start };
            if !last {
                to[third] = start[third] + share(end[third] - start[third], x);
            }
            let arc = self.grid_arc(helix, circle, plane, (flat(from), flat(to)), clockwise)?;
            self.helical(arc, plane, (from, to), &mut parts)?;
            from = to;
        }
        Ok(parts)
    }

    /// An arc between grid points about the best centre on the grid.
    fn grid_arc(
        &self,
        helix: &Helix,
        circle: &Circle,
        plane: Plane,
        (start, to): ([i64; 2], [i64; 2]),
        clockwise: bool,
    ) -> Result<GridArc, Reason> {
        let grid = &self.capabilities.grid;
        let step = grid.centre_step();
        let scale = centre_per_linear(self.capabilities);
        let [first, second, _] = plane.axes();
        let hub = Point2::new(helix.centre[first] / step, helix.centre[second] / step);
        let wanted = (helix.radius.0 / step, helix.radius.1 / step);
        let centre = centre(start, to, hub, scale).ok_or(Reason::NotOnGrid)?;
        let arc = GridArc { start, to, centre, clockwise };
        // A place between on the grid is off the arc by half the diagonal of a cell at most, and so is what it draws.
        let between =
            if self.capabilities.by_middle(plane) { FRAC_1_SQRT_2 * grid.linear_step() } else { 0.0 };
        let off = deviation(&arc, hub, wanted, scale) * step + between;
        let mismatch = {
            let (r0, r1) = arc.radii(scale);
            (r0 - r1).abs() * step
        };
        let good = off <= self.left(circle) && mismatch <= self.capabilities.radius_tolerance;
        if good { Ok(arc) } else { Err(Reason::NotOnGrid) }
    }

    /// The legal parts of an arc, with their share of the third axis.
    fn helical(
        &self,
        arc: GridArc,
        plane: Plane,
        (from, to): ([i64; 3], [i64; 3]),
        parts: &mut Vec<Part>,
    ) -> Result<(), Reason> {
        let [first, second, third] = plane.axes();
        let rise = to[third] - from[third];
        let scale = centre_per_linear(self.capabilities);
        let legal = if rise != 0 && arc.start == arc.to {
            let [a, b] = arc.halves(scale);
            let mut legal = legalise(a, plane, self.capabilities).map_err(|_| Reason::NotOnGrid)?;
            legal.extend(legalise(b, plane, self.capabilities).map_err(|_| Reason::NotOnGrid)?);
            legal
        } else {
            legalise(arc, plane, self.capabilities).map_err(|_| Reason::NotOnGrid)?
        };
        let whole = arc.sweep(scale);
        let mut turned = 0.0;
        let count = legal.len();
        let r = self.here().r;
        for (index, part) in legal.into_iter().enumerate() {
            let (end, drawn) = match part {
                Legal::Line(end) => (end, None),
                Legal::Arc(a) => {
                    turned += a.sweep(scale);
                    (a.to, Some((plane, a.centre, a.clockwise)))
                }
            };
            let x = if index + 1 == count {
                1.0
            } else if drawn.is_some() {
                turned / whole
            } else {
                crate::math::count(index + 1) / crate::math::count(count)
            };
            let mut p = [0; 3];
            (p[first], p[second]) = (end[0], end[1]);
            p[third] = from[third] + share(rise, x);
            parts.push((Position { x: p[0], y: p[1], z: p[2], r }, drawn));
        }
        Ok(())
    }

    /// What the control's own smoothing leaves of a circle's tolerance, mm.
    fn left(&self, circle: &Circle) -> f64 {
        circle.tolerance * (1.0 - self.capabilities.path_tolerance.map_or(0.0, |p| p.share))
    }

    /// Chords within the tolerance; vertices lie on the circle, rounded to the grid.
    fn lines(&mut self, helix: &Helix, circle: &Circle, end: [i64; 3], feed: FeedWord, reason: &Reason) {
        let step = self.capabilities.grid.linear_step();
        // Half the diagonal of a grid cell is lost by rounding.
        let rounding = 0.5 * step * 3.0_f64.sqrt();
        let sagitta = self.left(circle) - rounding;
        if sagitta < 0.1 * rounding {
            let message = format!(
                "lines on a grid of {step} mm cannot follow an arc within {} mm; {}",
                self.left(circle),
                reason.text(&self.capabilities.name)
            );
            return self.complain(&codes::lowering::CANNOT_FIT, message);
        }
        let radius = helix.radius.0.max(helix.radius.1);
        let angle = 2.0 * acos((1.0 - sagitta / radius).clamp(-0.5, 1.0));
        let count = ceil_to_usize(helix.sweep / angle).clamp(1, MOST_LINES);
        let half = 0.5 * helix.sweep / crate::math::count(count);
        let deviation = radius * (1.0 - crate::math::cos(half)) + rounding;
        let message = format!(
            "the arc of radius {radius:.4} mm is cut by {count} lines, at most {deviation:.4} mm off: {}",
            reason.text(&self.capabilities.name)
        );
        self.complain(&codes::lowering::ARC_AS_LINES, message);
        let turn = self.here().r;
        for index in 1..=count {
            let [x, y, z] = if index == count {
                end
            } else {
                self.round(helix.at(crate::math::count(index) / crate::math::count(count)))
            };
            self.line(Position { x, y, z, r: turn }, feed);
        }
    }
}

/// A part of a circle: its end, and plane, centre and sense when it is an arc.
pub(super) type Part = (Position, Option<(Plane, [i64; 2], bool)>);

/// The share `x` of a whole number of steps, rounded.
fn share(steps: i64, x: f64) -> i64 {
    (steps as f64 * x).round() as i64
}

/// Centre minus start, in centre steps, near `hub` (in centre steps) with the least difference of the radii: a
/// centre may slide along the bisector of the chord.
pub(super) fn centre(start: [i64; 2], to: [i64; 2], hub: Point2, scale: i64) -> Option<[i64; 2]> {
    let s = [(start[0] * scale) as f64, (start[1] * scale) as f64];
    let e = [((to[0] - start[0]) * scale) as f64, ((to[1] - start[1]) * scale) as f64];
    let base = [hub.x - s[0], hub.y - s[1]];
    if !base.iter().all(|v| v.abs() < 9e15) {
        return None;
    }
    let length = hypot(e[0], e[1]);
    if length == 0.0 {
        return Some(base.map(|v| v.round() as i64));
    }
    let along = [e[0] / length, e[1] / length];
    let lean = (base[0] * along[0] + base[1] * along[1]) - length / 2.0;
    let on_bisector = [base[0] - lean * along[0], base[1] - lean * along[1]];
    let candidate = |k: i32| {
        let t = f64::from(k) * 0.5;
        let c = [(on_bisector[0] - along[1] * t).round(), (on_bisector[1] + along[0] * t).round()];
        let mismatch = (hypot(c[0], c[1]) - hypot(c[0] - e[0], c[1] - e[1])).abs();
        // Half a step of mismatch weighs as much as sliding all the way.
        (mismatch + t.abs() / f64::from(SLIDE), k.abs(), c)
    };
    let best = (-SLIDE..=SLIDE).map(candidate).min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))?;
    Some(best.2.map(|v| v as i64))
}

/// Largest distance of a printed arc from the circle about `hub` whose radius goes linearly over `wanted`, in centre
/// steps; looked for at the ends and between.
fn deviation(arc: &GridArc, hub: Point2, wanted: (f64, f64), scale: i64) -> f64 {
    const LOOKS: i32 = 16;
    let sweep = arc.sweep(scale) * if arc.clockwise { -1.0 } else { 1.0 };
    let (r0, r1) = arc.radii(scale);
    let centre =
        [(arc.start[0] * scale + arc.centre[0]) as f64, (arc.start[1] * scale + arc.centre[1]) as f64];
    let from = atan2(-arc.centre[1] as f64, -arc.centre[0] as f64);
    (0..=LOOKS)
        .map(|i| {
            let x = f64::from(i) / f64::from(LOOKS);
            let (s, c) = sin_cos(from + sweep * x);
            let r = r0 + (r1 - r0) * x;
            let p = [centre[0] + r * c, centre[1] + r * s];
            let exact = if arc.start == arc.to { wanted.0 } else { wanted.0 + (wanted.1 - wanted.0) * x };
            (hypot(p[0] - hub.x, p[1] - hub.y) - exact).abs()
        })
        .fold(0.0, f64::max)
}
