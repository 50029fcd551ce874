//! How fast the distance from a surface can bend along a straight way.
//!
//! The distance d from *some* surface has a second derivative along a straight way of at most 1/d (in the sense of
//! semiconcave functions); from a mild one it has far less, because the foot glides along. Let the centre be x(s) = x₀ + e s
//! with the foot q₀ = r(u₀, v₀), an inner point, so that x₀ - q₀ is normal. The point r((u₀, v₀) + w s) with J w the
//! tangential part of e follows it, and d(x(s)) is no more than its distance g(s) from x(s), where δ = x - r has
//! g'' = |δ' × δ|²/|δ|³ - δ·r̈/|δ|. With |r̈| ≤ B, δ' = α n + ε₁ and δ = (d₀ + α s) n + ε₂, |ε₁| ≤ B |s|, |ε₂| ≤ B s²/2:
//!
//! g'' ≤ B + P²/d_min, P = (B h²/2 + B h (d + h) + B² h³/2)/d_min
//!
//! over a way of the length h on which d stays between d_min and d. It takes that the followed point stays within its
//! patch, which it does where the feet are farther from the patches' edges than it can go. The parameters' rates are
//! w = (a·e, b·e) with the dual basis a, b of r_u, r_v (a·r_u = b·r_v = 1, a·r_v = b·r_u = 0, both in the tangent
//! plane): a way along u hardly moves v.

use super::slide::sizes;
use super::{SurfaceTree, box_distance, hull};
use crate::geom::surface::interval::Interval;
use crate::geom::surface::patch::Patch;
use crate::geom::{Point3, Vec3};

/// Pieces of an edge of a patch.
const PIECES: u32 = 16;
/// The followed point goes no farther than this times as far as the centre.
const FASTER: f64 = 2.0;

/// A piece of a patch, or of its edge.
#[derive(Debug, Clone, Copy)]
struct Box3 {
    low: [f64; 3],
    high: [f64; 3],
}

impl Box3 {
    fn new(hull: &[Interval; 3]) -> Box3 {
        Box3 { low: hull.map(|i| i.lo), high: hull.map(|i| i.hi) }
    }
    fn distance(&self, x: Point3) -> f64 {
        box_distance(&self.low, &self.high, x)
    }
    fn with(&self, other: &Box3) -> Box3 {
        Box3 {
            low: core::array::from_fn(|i| self.low[i].min(other.low[i])),
            high: core::array::from_fn(|i| self.high[i].max(other.high[i])),
        }
    }
}

/// A vector that lies in a box.
#[derive(Debug, Clone, Copy)]
struct Loose {
    middle: Vec3,
    half: Vec3,
}

impl Loose {
    fn new(range: [Interval; 3]) -> Loose {
        let widened = range.map(|i| i.slackened(4.0));
        Loose {
            middle: Vec3::from(widened.map(|i| 0.5 * (i.lo + i.hi))),
            half: Vec3::from(widened.map(|i| 0.5 * (i.hi - i.lo))) * (1.0 + 1e-12),
        }
    }

    /// The largest component along a unit vector.
    fn along(&self, e: Vec3) -> f64 {
        self.middle.dot(&e).abs() + self.half.dot(&e.abs())
    }
}

/// Bounds over a piece of a patch.
#[derive(Debug, Clone, Copy)]
struct Swing {
    /// |r_uu|, |r_uv|, |r_vv|, mm.
    second: [f64; 3],
    /// |w_u| and |w_v| for J w of length 1, 1/mm.
    rate: [f64; 2],
    /// The dual basis of r_u and r_v, 1/mm.
    dual: [Loose; 2],
}

impl Swing {
    fn new(derivatives: &[[Interval; 3]; 5]) -> Swing {
        let ([ru, rv, ..], [u, v, uu, uv, vv]) = (derivatives, sizes(derivatives));
        let normal = cross(ru, rv);
        let least = |i: Interval| if i.lo > 0.0 { i.lo } else { (-i.hi).max(0.0) };
        let area = normal.map(|i| least(i) * least(i)).iter().sum::<f64>().sqrt();
        let inverse = (normal[0].square() + normal[1].square() + normal[2].square()).recip();
        let dual = [cross(rv, &normal), cross(&normal, ru)].map(|d| Loose::new(d.map(|i| i * inverse)));
        Swing {
            second: [uu, uv, vv],
            rate: [v, u].map(|x| if area > 0.0 { x / area } else { f64::INFINITY }),
            dual,
        }
    }

    /// |w_u| and |w_v| for the tangential part of a unit vector.
    fn rates(&self, e: Vec3) -> [f64; 2] {
        // What is not a number is no bound: the other one stands.
        core::array::from_fn(|i| self.rate[i].min(self.dual[i].along(e)))
    }
}

fn cross(a: &[Interval; 3], b: &[Interval; 3]) -> [Interval; 3] {
    let part = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    [part(1, 2), part(2, 0), part(0, 1)]
}

/// Bounds over several pieces, for one way.
#[derive(Debug, Clone, Copy, Default)]
struct Fold {
    second: [f64; 3],
    rate: [f64; 2],
}

impl Fold {
    fn with(&self, other: &Swing, e: Vec3) -> Fold {
        let rates = other.rates(e);
        Fold {
            second: core::array::from_fn(|i| self.second[i].max(other.second[i])),
            rate: core::array::from_fn(|i| self.rate[i].max(rates[i])),
        }
    }

    /// B, 1/mm.
    fn bend(&self) -> f64 {
        let ([uu, uv, vv], [a, b]) = (self.second, self.rate);
        uu * a * a + 2.0 * uv * a * b + vv * b * b
    }
}

/// Things with boxes in groups of neighbours, each with the box of all.
#[derive(Debug, Clone)]
struct Grouped<T> {
    all: Vec<(Box3, T)>,
    groups: Vec<Box3>,
}

/// Of a group.
const GROUP: usize = 16;

impl<T> Grouped<T> {
    const EMPTY: Grouped<T> = Grouped { all: Vec::new(), groups: Vec::new() };

    fn add(&mut self, place: Box3, thing: T) {
        match self.groups.last_mut().filter(|_| !self.all.len().is_multiple_of(GROUP)) {
            Some(group) => *group = group.with(&place),
            None => self.groups.push(place),
        }
        self.all.push((place, thing));
    }

    /// What is no farther from `x` than `limit`.
    fn within(&self, x: Point3, limit: f64) -> impl Iterator<Item = &T> {
        let groups = self.groups.iter().zip(self.all.chunks(GROUP));
        let things =
            groups.filter(move |(group, _)| group.distance(x) <= limit).flat_map(|(_, things)| things);
        things.filter(move |(place, _)| place.distance(x) <= limit).map(|(_, thing)| thing)
    }

    /// The distance of the nearest, or `limit` where all are farther.
    fn nearest(&self, x: Point3, limit: f64) -> f64 {
        self.groups.iter().zip(self.all.chunks(GROUP)).fold(limit, |least, (group, things)| {
            let far = group.distance(x) >= least;
            let things = if far { &[] } else { things };
            things.iter().map(|(place, _)| place.distance(x)).fold(least, f64::min)
        })
    }
}

/// What is known of one patch: its pieces, and the pieces of its edges.
#[derive(Debug, Clone)]
pub(super) struct Swings {
    whole: Box3,
    pieces: Grouped<Swing>,
    edges: Grouped<()>,
}

impl Swings {
    pub(super) fn new(patch: &Patch) -> Swings {
        let part = |k: u32| f64::from(k) / f64::from(PIECES);
        let mut edges = Grouped::EMPTY;
        for end in [0.0, 1.0] {
            for axis in [0, 1] {
                for k in 0..PIECES {
                    let (along, end) = ((part(k), part(k + 1)), (end, end));
                    let (u, v) = if axis == 0 { (along, end) } else { (end, along) };
                    edges.add(Box3::new(&hull(&patch.restrict(u, v))), ());
                }
            }
        }
        Swings { whole: Box3::new(&hull(patch)), pieces: Grouped::EMPTY, edges }
    }

    pub(super) fn add(&mut self, hull: &[Interval; 3], derivatives: &[[Interval; 3]; 5]) {
        self.pieces.add(Box3::new(hull), Swing::new(derivatives));
    }
}

/// Bounds for all feet of a straight way.
#[derive(Debug, Clone, Copy)]
pub struct Glide {
    /// B, 1/mm.
    bend: f64,
    /// The middle of the way, mm along it, and no edge of a patch is nearer to it than this, mm.
    middle: f64,
    free: f64,
}

impl Glide {
    /// Bound of the second derivative of the distance between the places `from` and `to` of the way, where the distance
    /// stays between `least` and `most`; `None` where a foot may come to an edge.
    #[must_use]
    pub fn bound(&self, (from, to): (f64, f64), (least, most): (f64, f64)) -> Option<f64> {
        let h = to - from;
        let aside = (0.5 * (from + to) - self.middle).abs() + 0.5 * h;
        let turn = h * self.bend;
        if turn > FASTER - 1.0 || self.free - aside <= most + FASTER * h {
            return None;
        }
        let p = (0.5 * turn * h + turn * (most + h) + 0.5 * turn * turn * h) / least;
        Some(self.bend + p * p / least)
    }
}

impl SurfaceTree {
    /// For ways of this `length` and direction about `middle`, where the surface is no farther than `most` from any place of
    /// it; `None` where the surface is too wild.
    #[must_use]
    pub fn glide(&self, middle: Point3, (along, length): (Vec3, f64), most: f64) -> Option<Glide> {
        let around = 0.5 * length + most + FASTER * length;
        // Edges beyond all that is near do not matter.
        let (mut swing, mut free) = (Fold::default(), 2.0 * around);
        for patch in self.glides.iter().filter(|p| p.whole.distance(middle) <= around) {
            swing = patch.pieces.within(middle, around).fold(swing, |s, p| s.with(p, along));
            free = patch.edges.nearest(middle, free);
        }
        let bend = swing.bend();
        (bend.is_finite() && free > most).then_some(Glide { bend, middle: 0.5 * length, free })
    }
}
