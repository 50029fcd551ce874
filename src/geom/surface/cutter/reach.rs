//! Whether a cutter comes to a place at all, wherever it is let down.
//!
//! Over a place a in plan the cutter goes down to the height H(a) at which it rests, and since it has no end upwards, it
//! takes there whatever it could take higher up. With p its profile it takes a point q if
//! H(a) + p(|q − a|) − q.z <= 0 somewhere. Any point s of the surface holds it: H(a) >= s.z − p(|s − a|), a concave
//! function of a about a convex tool; p(|q − a|) is convex and lies above its tangents. So the least over a square of places
//! is bounded at the square's corners, and squares are cut up until a place is found or all of them are known to hold the
//! cutter above q.

use std::collections::BinaryHeap;

use super::{Cutter, length};
use crate::geom::surface::tree::rest::GaveUp;
use crate::geom::surface::tree::{Foot, SurfaceTree};
use crate::geom::{Point2, Point3, Vec2};

/// Whether some place lets a cutter come to a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reach {
    /// One was found.
    Somewhere,
    /// Proven: none does.
    Nowhere,
    /// It was not found out.
    Unknown,
}

/// A cutter that is let down on a surface to come to its points.
pub struct Reacher<'a> {
    tree: &'a SurfaceTree,
    /// The cutter with the hull that is to stay free of the surface, and without.
    hull: Cutter,
    bare: Cutter,
    /// Points of the surface that have held the cutter, the last ones first to be asked.
    held: Vec<Point3>,
    hint: Option<Foot>,
    /// From the last point to where the cutter took it.
    took: Option<Vec2>,
}

/// Places at which the cutter is let down for one answer, at most.
const MOST: u32 = 150;
/// Points that are remembered.
const REMEMBERED: usize = 48;
/// What holds the cutter higher by less does not count, mm.
const COUNTS: f64 = 1e-7;
/// Squares are not cut below this share of the cutter's radius.
const SMALLEST: f64 = 1e-4;

/// A square of places of the cutter's axis.
struct Square {
    /// The least height of the cutter above the point, from below, mm.
    bound: f64,
    middle: Point2,
    half: f64,
}

impl PartialEq for Square {
    fn eq(&self, other: &Square) -> bool {
        self.bound.total_cmp(&other.bound).is_eq()
    }
}
impl Eq for Square {}
impl PartialOrd for Square {
    fn partial_cmp(&self, other: &Square) -> Option<core::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Square {
    fn cmp(&self, other: &Square) -> core::cmp::Ordering {
        other.bound.total_cmp(&self.bound)
    }
}

/// A plane below the profile over a square.
struct Tangent {
    at: Point2,
    height: f64,
    slope: Vec2,
}

impl<'a> Reacher<'a> {
    /// A cutter that is to leave `leave` mm on the surface.
    #[must_use]
    pub fn new(tree: &'a SurfaceTree, cutter: &Cutter, leave: f64) -> Reacher<'a> {
        Reacher { tree, hull: cutter.grown(leave), bare: *cutter, held: Vec::new(), hint: None, took: None }
    }

    /// Whether the cutter, resting somewhere on the surface, takes a point.
    pub fn comes_to(&mut self, q: Point3) -> Reach {
        // As at a point near by, for a start.
        if let Some(beside) = self.took.take()
            && self.takes(q.xy() + beside, q, 0.0)
        {
            self.took = Some(beside);
            return Reach::Somewhere;
        }
        let (low, high) = self.tree.bounds();
        // Of a taper, places count at which its end is no deeper than the surface.
        let reach = self.bare.radius_at((high.z.max(q.z) - low.z).max(0.0) + self.hull.corner());
        let whole = Square { bound: f64::NEG_INFINITY, middle: q.xy(), half: reach };
        let mut open = BinaryHeap::from([whole]);
        let mut left = MOST;
        while let Some(square) = open.pop() {
            let tangents = self.tangents(&square, q, reach);
            if tangents.is_empty() || self.is_held(&square, &tangents, q) {
                continue;
            }
            if left == 0 || square.half < SMALLEST * reach {
                return Reach::Unknown;
            }
            left -= 1;
            if self.takes(square.middle, q, square.half) {
                self.took = Some(square.middle - q.xy());
                return Reach::Somewhere;
            }
            let bound = self.bound(&square, &tangents, q);
            let bound = if bound > COUNTS { bound } else { bound.max(self.eroded(&square, &tangents, q)) };
            if bound <= COUNTS {
                open.extend(square.quarters(bound));
            }
        }
        Reach::Nowhere
    }

    /// Lets the cutter down over a place: whether it takes the point there. What holds it higher than needed by `enough` is
    /// not asked about any further.
    fn takes(&mut self, at: Point2, q: Point3, enough: f64) -> bool {
        let height = self.height(at, q);
        self.holder(self.hull, at, height, enough) == Ok(None) && height.is_some()
    }

    /// The height of the cutter over a place at which it takes a point, if it can.
    fn height(&self, at: Point2, q: Point3) -> Option<f64> {
        self.bare.profile((q.xy() - at).norm()).map(|p| q.z - p.height)
    }

    /// Lets a cutter down over a place to a height: what holds it above, which is remembered.
    fn holder(
        &mut self,
        cutter: Cutter,
        at: Point2,
        height: Option<f64>,
        enough: f64,
    ) -> Result<Option<Foot>, GaveUp> {
        let height = height.unwrap_or(f64::NEG_INFINITY);
        let held = self.tree.holder(&cutter, at.into(), (height, height + enough), self.hint.as_ref());
        if let Ok(Some(foot)) = held {
            self.hint = Some(foot);
            self.remember(foot.point);
        }
        held
    }

    fn remember(&mut self, s: Point3) {
        if self.held.len() >= REMEMBERED {
            self.held.remove(0);
        }
        self.held.push(s);
    }

    /// Whether a point that is known holds the cutter over a whole square.
    fn is_held(&mut self, square: &Square, tangents: &[Tangent], q: Point3) -> bool {
        let holds = |s: &Point3| self.above(*s, square, tangents, q) > COUNTS;
        let Some(found) = self.held.iter().rposition(holds) else { return false };
        let last = self.held.len() - 1;
        self.held.swap(found, last);
        true
    }

    /// The bound by the point that has been found last.
    fn bound(&self, square: &Square, tangents: &[Tangent], q: Point3) -> f64 {
        self.held.last().map_or(f64::NEG_INFINITY, |s| self.above(*s, square, tangents, q))
    }

    /// The bound by a point that holds a cutter which lies inside of this one over all places of the square.
    fn eroded(&mut self, square: &Square, tangents: &[Tangent], q: Point3) -> f64 {
        let away = square.half * core::f64::consts::SQRT_2;
        if away >= self.hull.disc {
            return f64::NEG_INFINITY;
        }
        let narrow = Cutter { disc: self.hull.disc - away, ..self.hull };
        match self.holder(narrow, square.middle, self.height(square.middle, q), square.half) {
            Ok(Some(_)) => self.bound(square, tangents, q),
            _ => f64::NEG_INFINITY,
        }
    }

    /// How high above `q` a point of the surface holds the cutter over all places of a square, from below.
    fn above(&self, s: Point3, square: &Square, tangents: &[Tangent], q: Point3) -> f64 {
        let mut best = f64::NEG_INFINITY;
        let held = square.corners().map(|c| {
            let profile = self.hull.profile((s.xy() - c).norm());
            (c, profile.map_or(f64::NEG_INFINITY, |p| s.z - p.height))
        });
        for tangent in tangents {
            let at =
                |(c, height): (Point2, f64)| height + tangent.height + tangent.slope.dot(&(c - tangent.at));
            best = held.into_iter().map(at).fold(f64::INFINITY, f64::min).max(best);
        }
        best - q.z
    }

    /// Planes below the profile about `q` over a square; none where all of it is too far from the point.
    fn tangents(&self, square: &Square, q: Point3, reach: f64) -> Vec<Tangent> {
        let nearest = square.nearest(q.xy());
        let beside = (nearest - q.xy()).norm();
        let Some(least) = self.bare.profile(beside).filter(|_| beside <= reach) else { return Vec::new() };
        let mut out = vec![Tangent { at: nearest, height: least.height, slope: Vec2::zeros() }];
        for at in [nearest, square.middle] {
            let away = at - q.xy();
            let Some(profile) = self.bare.profile(length(away.x, away.y)) else { continue };
            let ([across, up], Some(e)) = (profile.normal, away.try_normalize(0.0)) else { continue };
            if across > 0.0 && up < 0.0 {
                out.push(Tangent { at, height: profile.height, slope: e * (-across / up) });
            }
        }
        out
    }
}

impl Square {
    fn corners(&self) -> [Point2; 4] {
        let at = |x: f64, y: f64| self.middle + Vec2::new(x, y) * self.half;
        [at(-1.0, -1.0), at(-1.0, 1.0), at(1.0, -1.0), at(1.0, 1.0)]
    }
    fn nearest(&self, p: Point2) -> Point2 {
        let [x, y] = [0, 1].map(|i| p[i].clamp(self.middle[i] - self.half, self.middle[i] + self.half));
        Point2::new(x, y)
    }
    fn quarters(&self, bound: f64) -> [Square; 4] {
        let half = 0.5 * self.half;
        let at = |x: f64, y: f64| Square { bound, middle: self.middle + Vec2::new(x, y) * half, half };
        [at(-1.0, -1.0), at(-1.0, 1.0), at(1.0, -1.0), at(1.0, 1.0)]
    }
}
