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
//! patch, which it does where the feet are farther from the patches' edges than it can go.

use super::slide::sizes;
use super::{SurfaceTree, box_distance, hull};
use crate::geom::Point3;
use crate::geom::surface::interval::Interval;
use crate::geom::surface::patch::Patch;

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
}

/// Bounds over a piece of a patch.
#[derive(Debug, Clone, Copy)]
struct Swing {
    /// |r_uu|, |r_uv|, |r_vv|, mm.
    second: [f64; 3],
    /// |w_u| and |w_v| for J w of length 1, 1/mm.
    rate: [f64; 2],
}

impl Swing {
    const NONE: Swing = Swing { second: [0.0; 3], rate: [0.0; 2] };

    fn new(derivatives: &[[Interval; 3]; 5]) -> Swing {
        let ([ru, rv, ..], [u, v, uu, uv, vv]) = (derivatives, sizes(derivatives));
        let cross = |a: usize, b: usize| ru[a] * rv[b] - ru[b] * rv[a];
        let least = |i: Interval| if i.lo > 0.0 { i.lo } else { (-i.hi).max(0.0) };
        let area =
            [cross(1, 2), cross(2, 0), cross(0, 1)].map(|i| least(i) * least(i)).iter().sum::<f64>().sqrt();
        Swing { second: [uu, uv, vv], rate: [v / area, u / area] }
    }

    fn with(&self, other: &Swing) -> Swing {
        Swing {
            second: core::array::from_fn(|i| self.second[i].max(other.second[i])),
            rate: core::array::from_fn(|i| self.rate[i].max(other.rate[i])),
        }
    }

    /// B, 1/mm.
    fn bend(&self) -> f64 {
        let ([uu, uv, vv], [a, b]) = (self.second, self.rate);
        uu * a * a + 2.0 * uv * a * b + vv * b * b
    }
}

/// What is known of one patch: its pieces, and the pieces of its edges.
#[derive(Debug, Clone)]
pub(super) struct Swings {
    whole: Box3,
    pieces: Vec<(Box3, Swing)>,
    edges: Vec<Box3>,
}

impl Swings {
    pub(super) fn new(patch: &Patch) -> Swings {
        let part = |k: u32| f64::from(k) / f64::from(PIECES);
        let ends = [0.0, 1.0];
        let pieces = (0..PIECES).flat_map(|k| ends.map(|end| ((part(k), part(k + 1)), (end, end))));
        let edges = pieces
            .flat_map(|(along, end)| [(along, end), (end, along)])
            .map(|(u, v)| Box3::new(&hull(&patch.restrict(u, v))))
            .collect();
        Swings { whole: Box3::new(&hull(patch)), pieces: Vec::new(), edges }
    }

    pub(super) fn add(&mut self, hull: &[Interval; 3], derivatives: &[[Interval; 3]; 5]) {
        self.pieces.push((Box3::new(hull), Swing::new(derivatives)));
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
    /// For ways of this `length` about `middle`, where the surface is no farther than `most` from any place of it; `None`
    /// where the surface is too wild.
    #[must_use]
    pub fn glide(&self, middle: Point3, length: f64, most: f64) -> Option<Glide> {
        let around = 0.5 * length + most + FASTER * length;
        let (mut swing, mut free) = (Swing::NONE, f64::INFINITY);
        for patch in self.glides.iter().filter(|p| p.whole.distance(middle) <= around) {
            let near = patch.pieces.iter().filter(|p| p.0.distance(middle) <= around);
            swing = near.fold(swing, |s, p| s.with(&p.1));
            free = patch.edges.iter().map(|e| e.distance(middle)).fold(free, f64::min);
        }
        let bend = swing.bend();
        (bend.is_finite() && free > most).then_some(Glide { bend, middle: 0.5 * length, free })
    }
}
