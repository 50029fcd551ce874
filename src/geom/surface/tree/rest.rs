//! Where a cutter rests that is let down on the surface: the highest of the heights at which its points hold it.

use super::bend::Bend;
use super::search::{Aim, NOTHING, Search, Spot, solve};
use super::{Foot, SurfaceTree};
use crate::geom::surface::cutter::{Cutter, length};
use crate::geom::surface::drop::Contact;
use crate::geom::surface::patch::SurfaceJet;
use crate::geom::{Point3, Vec3};

/// Nowhere else is the cutter held higher than where it is said to rest by more than this, mm.
const ACCURACY: f64 = 1e-7;
/// Of a sharp cutter, the share of its flat's radius within which its rim is taken for round.
const SHARP: f64 = 0.05;
/// Contacts nearer to an edge, in parameters, are at the edge as far as the search can tell: there the normal is the cutter's.
const EDGE: f64 = 1e-6;
/// Planes steeper than this (n·z) hold no cutter.
const UPRIGHT: f64 = 1e-4;

/// A cutter above a place.
struct Lowering<'a> {
    cutter: &'a Cutter,
    at: [f64; 2],
}

impl Lowering<'_> {
    fn beside(&self, q: Point3) -> [f64; 2] {
        [q.x - self.at[0], q.y - self.at[1]]
    }

    /// Where the cutter touches.
    fn foot(&self, spot: &Spot) -> Foot {
        let distance = self.cutter.corner();
        Foot { patch: spot.patch, uv: spot.uv, point: spot.point, distance, certain: distance }
    }
}

impl Aim for Lowering<'_> {
    fn in_box(&self, low: [f64; 3], high: [f64; 3]) -> f64 {
        let beyond = |i: usize| (low[i] - self.at[i]).max(self.at[i] - high[i]).max(0.0);
        let profile = self.cutter.profile(length(beyond(0), beyond(1)));
        profile.map_or(f64::NEG_INFINITY, |p| high[2] - p.height)
    }
    fn score(&self, q: Point3) -> f64 {
        let [x, y] = self.beside(q);
        let beside = length(x, y);
        // Beside the cutter, what is nearer is the better.
        self.cutter.profile(beside).map_or(10.0 * NOTHING - beside, |p| q.z - p.height)
    }
    fn facing(&self, q: Point3) -> Option<Vec3> {
        let [x, y] = self.beside(q);
        let beside = length(x, y);
        let [across, up] = self.cutter.profile(beside)?.normal;
        let e = if beside > 0.0 { [x / beside, y / beside] } else { [1.0, 0.0] };
        Some(Vec3::new(-across * e[0], -across * e[1], -up))
    }
    fn radial(&self, q: Point3, n: Vec3) -> Option<Vec3> {
        let [x, y] = self.beside(q);
        radial([x, y], n)
    }
    fn plane(&self, n: Vec3) -> Option<(f64, f64)> {
        let offset = self.cutter.support(-n) - n.x * self.at[0] - n.y * self.at[1];
        (n.z > UPRIGHT).then(|| (1.0 / n.z, offset))
    }
    fn step(&self, jet: &SurfaceJet) -> Option<[f64; 2]> {
        self.to_summit(jet).or_else(|| self.to_rim(jet))
    }
    fn sizes(&self) -> [f64; 4] {
        let (corner, flat) = (self.cutter.corner(), self.cutter.flat());
        let small = corner.max(SHARP * flat);
        [4.0 * (corner + flat), 0.4 * (corner + flat), 0.5 * small, 0.15 * small]
    }
    /// With p(ρ) the profile's height above the distance ρ from the axis, the score is z - p(ρ). It is below z - p₁(ρ) with p₁ the
    /// profile's tangent, a cone, however far from the place; near it, p bends away from that.
    fn concave(&self, at: &SurfaceJet, bend: &Bend, half: [f64; 2]) -> Option<[f64; 2]> {
        let [x, y] = self.beside(at.p);
        let beside = length(x, y);
        let about = bend.spread(at, half);
        let far = length(about.x, about.y);
        let ([own, _], _) = self.cutter.slopes(beside, beside)?;
        let e = if beside > 0.0 { [x / beside, y / beside] } else { [1.0, 0.0] };
        let place = Place { at, bend, half, e, beside, far, own };
        let bends = || {
            let ([least, most], round) = self.cutter.slopes((beside - far).max(0.0), beside + far)?;
            place.under(least, most, round)
        };
        place.under(own, own, 0.0).or_else(bends)
    }
}

impl Lowering<'_> {
    /// Towards the highest point under the cutter's flat.
    fn to_summit(&self, jet: &SurfaceJet) -> Option<[f64; 2]> {
        let [x, y] = self.beside(jet.p);
        let flat = self.cutter.flat();
        let curved = jet.uu.z < 0.0 && jet.uu.z * jet.vv.z > jet.uv.z * jet.uv.z;
        if !curved || length(x, y) >= flat {
            return None;
        }
        let step = solve([[jet.uu.z, jet.uv.z], [jet.uv.z, jet.vv.z]], [-jet.u.z, -jet.v.z])?;
        let after = [x + jet.u.x * step[0] + jet.v.x * step[1], y + jet.u.y * step[0] + jet.v.y * step[1]];
        (length(after[0], after[1]) < flat).then_some(step)
    }

    /// The corner touches where its normal is the surface's: the plan normal points to the axis, and the distance
    /// from the axis is that of the corner's point.
    fn to_rim(&self, jet: &SurfaceJet) -> Option<[f64; 2]> {
        let w = jet.u.cross(&jet.v);
        let (w, sense) = if w.z < 0.0 { (-w, -1.0) } else { (w, 1.0) };
        let size = w.norm();
        let n = w / size;
        let m = length(n.x, n.y);
        let (disc, r) = (self.cutter.flat(), self.cutter.corner());
        let [x, y] = self.beside(jet.p);
        let beside = length(x, y);
        if size.is_nan() || size <= 0.0 || beside <= 0.0 {
            return None;
        }
        let column = |r_t: Vec3, w_t: Vec3| {
            let w_t = w_t * sense;
            let n_t = (w_t - n * n.dot(&w_t)) / size;
            let m_t = if m > 0.0 { (n.x * n_t.x + n.y * n_t.y) / m } else { 0.0 };
            let away = (x * r_t.x + y * r_t.y) / beside - r * m_t;
            [away, w_t.x * y + w.x * r_t.y - w_t.y * x - w.y * r_t.x]
        };
        let wu = jet.uu.cross(&jet.v) + jet.u.cross(&jet.uv);
        let wv = jet.uv.cross(&jet.v) + jet.u.cross(&jet.vv);
        let off = [beside - disc - r * m, w.x * y - w.y * x];
        scaled(column(jet.u, wu), column(jet.v, wv), off)
    }
}

/// A place under a cutter, and a rectangle of the surface about it.
struct Place<'a> {
    at: &'a SurfaceJet,
    bend: &'a Bend,
    /// Half widths of the rectangle.
    half: [f64; 2],
    /// Away from the axis.
    e: [f64; 2],
    /// Distance from the axis, and how far the rectangle reaches in plan, mm.
    beside: f64,
    far: f64,
    /// The profile's slope.
    own: f64,
}

impl Place<'_> {
    /// The gradient of z - p(ρ), if that is concave over the rectangle. With e and t the unit vectors away from the axis and
    /// about it, its second derivatives are m·r″ - p″ (e·r′)² - p′/ρ (t·r′)², m = (-p′ e, 1), p′ between `least` and
    /// `most`, p″ at least `round`. Over the rectangle e turns, r′ and p′ change; what that takes of the
    /// squares is bounded by (x + y)² >= 2/3 x² - 2 y². Parameters are such that r′ is e and t in plan at the place itself.
    fn under(&self, least: f64, most: f64, round: f64) -> Option<[f64; 2]> {
        let Place { at, bend, half, e, own, .. } = *self;
        let turn = if most > 0.0 { 1.58 * self.far / self.beside } else { 0.0 };
        let m = Vec3::new(-own * e[0], -own * e[1], 1.0);
        let about_axis = least / (self.beside + self.far);
        let sways = (most - own).max(own - least) + most * turn;
        let lengths = bend.lengths();
        let changes = [0, 1].map(|i| lengths[i] * half[0] + lengths[i + 1] * half[1]);
        let plan = |r: &Vec3| [e[0] * r.x + e[1] * r.y, e[0] * r.y - e[1] * r.x];
        let ([a, b], [c, d]) = (plan(&at.u), plan(&at.v));
        let det = a * d - b * c;
        // (u, v) for steps along e and about the axis.
        let frame = [[d / det, -b / det], [-c / det, a / det]];
        let second = bend.along(m);
        let curved = |p: [f64; 2], q: [f64; 2]| {
            let weights = [p[0] * q[0], p[0] * q[1] + p[1] * q[0], p[1] * q[1]];
            let own = |k: usize| {
                let (lo, hi) = (weights[k] * second[k].lo, weights[k] * second[k].hi);
                let more = weights[k].abs() * sways * lengths[k];
                [lo.min(hi) - more, lo.max(hi) + more]
            };
            [0, 1, 2].map(own).iter().fold([0.0, 0.0], |s, o| [s[0] + o[0], s[1] + o[1]])
        };
        let off = frame.map(|w| {
            let change = w[0].abs() * changes[0] + w[1].abs() * changes[1];
            change + turn * (1.0 + change)
        });
        if !(off[0] < 1.0 && off[1] < 1.0) {
            return None;
        }
        let kept = off.map(|o| 2.0 / 3.0 * (1.0 - o) * (1.0 - o));
        let lost = off.map(|o| 2.0 * o * o);
        let across = curved(frame[0], frame[0])[1] - round * kept[0] + about_axis * lost[0];
        let around = curved(frame[1], frame[1])[1] - about_axis * kept[1] + round * lost[1];
        let [low, high] = curved(frame[0], frame[1]);
        let mixed = high.max(-low);
        let concave = across < 0.0 && around < 0.0 && across * around > mixed * mixed * (1.0 + 1e-9);
        concave.then(|| [m.dot(&at.u), m.dot(&at.v)])
    }
}

/// Newton's step for two equations in different units.
fn scaled(a: [f64; 2], b: [f64; 2], off: [f64; 2]) -> Option<[f64; 2]> {
    let size = length(a[1], b[1]);
    if size.is_nan() || size <= 0.0 {
        return None;
    }
    solve([[a[0], a[1] / size], [b[0], b[1] / size]], [-off[0], -off[1] / size])
}

/// The unit vector in the plane of z and a horizontal direction that is nearest to `n`; it does not point outwards.
pub(super) fn radial([x, y]: [f64; 2], n: Vec3) -> Option<Vec3> {
    let beside = length(x, y);
    let e = [x / beside, y / beside];
    let across = (n.x * e[0] + n.y * e[1]).min(0.0);
    Vec3::new(across * e[0], across * e[1], n.z).try_normalize(1e-9)
}

impl SurfaceTree {
    /// The highest position of a cutter's reference point over a place at which the cutter touches the surface, and where;
    /// `None` where it touches nothing. `hint`: a foot near by.
    #[must_use]
    pub fn rest(&self, cutter: &Cutter, at: [f64; 2], hint: Option<&Foot>) -> Option<Contact> {
        let aim = Lowering { cutter, at };
        let search = Search::new(self, &aim, ACCURACY).run(hint);
        let spot = search.spot.filter(|_| search.best > NOTHING)?;
        // What was given up could hold the cutter higher: then it is held there.
        let height =
            if search.bound() > search.best + 1.01 * ACCURACY { search.bound() } else { search.best };
        let jet = self.net.patches()[spot.patch].jet(spot.uv[0], spot.uv[1]);
        let inside = spot.uv.iter().all(|t| *t > EDGE && *t < 1.0 - EDGE);
        let facing = || aim.facing(spot.point);
        let normal = if inside { jet.normal().or_else(facing) } else { facing().or_else(|| jet.normal()) }?;
        Some(Contact { centre: Point3::new(at[0], at[1], height), normal, foot: aim.foot(&spot) })
    }

    /// A foot that holds a cutter over a place higher than `above`, the first that is found to hold it higher than `enough`, or
    /// else the highest. `Ok(None)`: nothing does. `hint`: a foot near by.
    ///
    /// # Errors
    ///
    /// It was not found out.
    pub fn holder(
        &self,
        cutter: &Cutter,
        at: [f64; 2],
        (above, enough): (f64, f64),
        hint: Option<&Foot>,
    ) -> Result<Option<Foot>, GaveUp> {
        let aim = Lowering { cutter, at };
        let search = Search::new(self, &aim, ACCURACY).above(above).until(enough).run(hint);
        match search.spot.filter(|_| search.best > above.max(NOTHING)) {
            Some(spot) => Ok(Some(aim.foot(&spot))),
            None if search.gave_up() => Err(GaveUp),
            None => Ok(None),
        }
    }
}

/// A search was given up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GaveUp;
