//! How the cutter comes down to a level.

use super::chain::{around, closest, enclosed, pair, place_towards};
use super::path::{Path, over};
use super::slice::{Pocket, Ring, Slice};
use crate::geom::{Point2, Vec2};
use crate::math::{TAU, ceil_to_usize, hypot, sin_cos};

/// Steps on the way out of the blank at most.
const MOST_STEPS: u32 = 2000;
/// Rings smaller than this share of the cutter's radius are not missed.
const TRIFLE: f64 = 0.1;
/// A way down starts so far above what is left of the stock, mm.
const ABOVE: f64 = 0.05;
/// Helix radius: at most this share of the cutter's, of the room, and at least this share of the cutter's.
const HELIX: (f64, f64, f64) = (0.5, 0.9, 0.15);
/// Radius of a ball's helix at most, as a share of the distance of rings.
const EYE: f64 = 0.6;
/// Rings shorter than this share of the cutter's radius, or than so many times that of its flat, are no room to go down along.
const SHORTEST: (f64, f64) = (0.2, 1.0);

impl Path<'_> {
    /// Comes down to the level at a ring or near it; where on the ring to begin. `None` where the pocket is left out.
    pub(super) fn come(
        &mut self,
        slice: &Slice,
        pocket: &Pocket,
        ring: &Ring,
        cleared: &[Point2],
    ) -> Option<usize> {
        let z = slice.z;
        if let Some(at) = self.at.filter(|p| (p.z - z).abs() < 1e-9) {
            let start = closest(&ring.points, at.xy());
            if self.stays(slice, (at.xy(), ring.points[start])) {
                return Some(start);
            }
        }
        if let Some((place, start)) = pair(cleared, &ring.points)
            && self.stays(slice, (place, ring.points[start]))
        {
            self.descend(place, z);
            return Some(start);
        }
        if pocket.airy
            && let Some(start) = self.enter_from_outside(z, ring)
        {
            return Some(start);
        }
        self.enter(slice, pocket, ring)
    }

    /// The nearest place beside the blank at which the cutter is clear of the stock and from which the way is free: straight
    /// away from the blank, or askew.
    pub(super) fn outside(&self, p: Point2, z: f64) -> Option<Point2> {
        const ASKEW: [f64; 7] = [0.0, 0.35, -0.35, 0.7, -0.7, 1.05, -1.05];
        const FINEST: f64 = 0.05;
        let out = self.ground.blank.outward(p);
        let step = FINEST * self.ground.rest.radius;
        let clear = |q: Point2| self.top_at(q).is_none_or(|top| top <= z - 1e-3);
        ASKEW.into_iter().find_map(|angle| {
            let (s, c) = sin_cos(angle);
            let way = Vec2::new(c * out.x - s * out.y, s * out.x + c * out.y);
            let places = (0..=MOST_STEPS).map(|k| p + way * (step * f64::from(k)));
            let end = places
                .take_while(|q| self.ground.blank.distance(*q) <= self.manner.air + step)
                .find(|q| clear(*q))?;
            self.free((p, end), z).then_some(end)
        })
    }

    /// To a ring from beside the blank, where it is nearest to that.
    fn enter_from_outside(&mut self, z: f64, ring: &Ring) -> Option<usize> {
        let off = |k: &usize| self.ground.blank.distance(ring.points[*k]);
        let mut places: Vec<usize> = (0..ring.points.len()).collect();
        places.sort_by(|a, b| off(b).total_cmp(&off(a)));
        const TRIES: usize = 8;
        let stride = (places.len() / TRIES).max(1);
        let (start, end) = places
            .into_iter()
            .step_by(stride)
            .find_map(|k| self.outside(ring.points[k], z).map(|end| (k, end)))?;
        self.descend(end, z);
        Some(start)
    }

    /// Down into full material: by a helix in the pocket's deepest place, or along the ring.
    fn enter(&mut self, slice: &Slice, pocket: &Pocket, ring: &Ring) -> Option<usize> {
        let radius = self.ground.rest.radius;
        let (most, share, least) = HELIX;
        let (centre, room) = pocket.deepest;
        // In the middle of a ball's helix no more is to stay than between rings.
        let eye = if self.cutter().is_ball() { EYE * self.manner.width } else { f64::INFINITY };
        let helix = (share * room).min(most * radius).min(eye.max(least * radius));
        let first = self.is_reversed(pocket);
        if !first && helix >= least * radius && self.free((centre, centre), slice.z) {
            let start = closest(&ring.points, centre);
            self.helix(slice.z, (centre, helix), ring.points[start]);
            return Some(start);
        }
        let length = around(&ring.points);
        if length < (SHORTEST.0 * radius).max(SHORTEST.1 * self.cutter().flat()) {
            self.skip(&ring.points);
            return None;
        }
        self.tally.along_ring += u32::from(!first);
        Some(self.ramp(slice.z, ring, length))
    }

    /// Notes that a ring is left out, if it is worth a word.
    pub(super) fn skip(&mut self, points: &[Point2]) {
        let (low, high) = points
            .iter()
            .fold((Point2::new(f64::MAX, f64::MAX), Point2::new(f64::MIN, f64::MIN)), |(a, b), p| {
                (a.inf(p), b.sup(p))
            });
        let extent = (high - low).norm();
        if extent >= TRIFLE * self.ground.rest.radius {
            let skipped = &mut self.tally.skipped;
            *skipped = (skipped.0 + 1, skipped.1.max(extent));
        }
    }

    /// Height from which material may stand around some places.
    fn top_around(&self, places: &[Point2], z: f64) -> f64 {
        let cutter = self.cutter();
        let tops = places.iter().map(|p| self.stock.likely_height(*p, &cutter) - cutter.lift() + ABOVE);
        tops.fold(z, f64::max).min(self.manner.safe)
    }

    /// Down by a helix that ends towards a place.
    fn helix(&mut self, z: f64, (centre, radius): (Point2, f64), towards: Point2) {
        const PLACES: u32 = 8;
        // An arc that is shorter than this share of a turn is made longer by so much.
        const LEAST: f64 = 0.05;
        let ccw = !self.manner.wall_left;
        let end = place_towards(centre, towards, radius);
        let back = |turns: f64| {
            let (s, c) = sin_cos(if ccw { -TAU * turns } else { TAU * turns });
            let arm = end - centre;
            centre + Vec2::new(c * arm.x - s * arm.y, s * arm.x + c * arm.y)
        };
        let places: Vec<Point2> = (0..PLACES).map(|k| back(f64::from(k) / f64::from(PLACES))).collect();
        let top = self.top_around(&places, z);
        if top <= z {
            return self.descend(end, z);
        }
        let turns = ((top - z) / (TAU * radius * self.manner.ramp)).clamp(LEAST, 10_000.0);
        let turns = if turns.fract() < LEAST { turns + LEAST } else { turns };
        self.descend(back(turns.fract()), top);
        self.tally.entries += hypot(TAU * radius * turns, top - z);
        self.narrow(radius);
        // At most 10 001.
        self.arc(over(end, z), centre, ccw, turns.floor() as u32);
    }

    /// Down along a ring: to the end of the way that the slope asks for, round and round if need be. Where on the ring the
    /// tip is then.
    fn ramp(&mut self, z: f64, ring: &Ring, length: f64) -> usize {
        let top = self.top_around(&ring.points, z);
        let first = self.last().map_or(0, |p| closest(&ring.points, p.xy()));
        self.descend(ring.points[first], top);
        if top <= z {
            return first;
        }
        let need = (top - z) / self.manner.ramp;
        let n = ring.points.len();
        let mut points = vec![ring.points[first]];
        let (mut k, mut gone) = (first, 0.0);
        // Whole vertices: a little more than is needed.
        let most = ceil_to_usize(need / length).saturating_add(1).saturating_mul(n);
        for _ in 0..most {
            let next = (k + 1) % n;
            gone += (ring.points[next] - ring.points[k]).norm();
            points.push(ring.points[next]);
            k = next;
            if gone >= need {
                break;
            }
        }
        self.tally.entries += gone;
        // Of a circle half its radius, of a long ring half its width.
        self.narrow(enclosed(&ring.points).abs() / length);
        self.run(&points, (top, z));
        self.tally.rings -= gone;
        k
    }

    fn narrow(&mut self, radius: f64) {
        self.tally.narrowest = Some(self.tally.narrowest.map_or(radius, |r| r.min(radius)));
    }
}
