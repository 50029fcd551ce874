//! The way of the cutter through a level: entries, rings, and how one leads to the next.

use super::arcs;
use super::chain::{around, closest, enclosed, length, pair, place_towards, sweep};
use super::ground::{Ground, Hints};
use super::slice::{Pocket, Ring, Slice};
use crate::geom::surface::Cutter;
use crate::geom::surface::heights::HeightField;
use crate::geom::{Point2, Point3, Vec2};
use crate::math::{TAU, ceil_to_usize, count, hypot, sin_cos};

/// A move of the tip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Move {
    Rapid(Point3),
    Line(Point3),
    /// About a vertical axis; `turns` full ones beyond the sweep to the end.
    Arc {
        to: Point3,
        centre: Point2,
        ccw: bool,
        turns: u32,
    },
}

/// What the path is made with.
#[derive(Debug, Clone, Copy)]
pub(super) struct Manner {
    /// Distance of rings, mm.
    pub width: f64,
    /// How far beside the blank the cutter is clear of it, mm.
    pub air: f64,
    /// Height at which rapids run across, mm.
    pub safe: f64,
    /// Tangent of the steepest way down into material.
    pub ramp: f64,
    /// The path may leave the rings by this, mm.
    pub tolerance: f64,
    /// Walls are to the left of travel.
    pub wall_left: bool,
}

/// What a path takes.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Tally {
    /// Rings, mm.
    pub rings: f64,
    /// Ways down into material, mm.
    pub entries: f64,
    /// Ways at feed between rings, mm.
    pub links: f64,
    /// Pockets entered down their own ring, for want of room for a helix.
    pub along_ring: u32,
    /// How wide the narrowest way down is, as the radius of its path, mm.
    pub narrowest: Option<f64>,
    /// Pockets left out because there is no room to go down, and the largest extent of one, mm.
    pub skipped: (u32, f64),
}

/// The path under way.
pub(super) struct Path<'a> {
    ground: &'a Ground,
    manner: Manner,
    pub moves: Vec<Move>,
    pub tally: Tally,
    /// The tip, while it is down.
    at: Option<Point3>,
    stock: HeightField,
}

/// A rapid stops so far above the stock, mm.
const GAP: f64 = 0.5;
/// Rings smaller than this share of the cutter's radius are not missed.
const TRIFLE: f64 = 0.1;
/// Steps on the way out of the blank at most.
const MOST_STEPS: u32 = 2000;
/// The cutter is looked at larger by this share of the stock's cells.
const LARGER: f64 = 0.25;
/// A way down starts so far above what is left of the stock, mm.
const ABOVE: f64 = 0.05;
/// Helix radius: at most this share of the cutter's, of the room, and at least this share of the cutter's.
const HELIX: (f64, f64, f64) = (0.5, 0.9, 0.15);
/// Rings shorter than this share of the cutter's radius, or than so many times that of its flat, are no room to go down along.
const SHORTEST: (f64, f64) = (0.2, 1.0);

fn over(p: Point2, z: f64) -> Point3 {
    Point3::new(p.x, p.y, z)
}

impl<'a> Path<'a> {
    pub(super) fn new(ground: &'a Ground, manner: Manner, stock: HeightField) -> Path<'a> {
        Path { ground, manner, moves: Vec::new(), tally: Tally::default(), at: None, stock }
    }

    /// Clears a level.
    pub(super) fn level(&mut self, slice: &Slice) {
        // Inner pockets first, each whole before the next.
        let mut stack: Vec<(usize, bool)> = slice.outer.iter().rev().map(|p| (*p, false)).collect();
        while let Some((index, ready)) = stack.pop() {
            let Some(pocket) = slice.pockets.get(index) else { continue };
            if ready {
                self.pocket(slice, pocket);
            } else {
                stack.push((index, true));
                stack.extend(pocket.inner.iter().rev().map(|p| (*p, false)));
            }
        }
    }

    /// Up, if the tip is down.
    pub(super) fn lift(&mut self) {
        if let Some(p) = self.at.take() {
            self.moves.push(Move::Rapid(over(p.xy(), self.manner.safe)));
        }
    }

    /// The rings of a pocket, whose inner pockets are cleared.
    fn pocket(&mut self, slice: &Slice, pocket: &Pocket) {
        let mut rest: Vec<Ring> = pocket.rings.iter().map(|r| self.directed(r)).collect();
        let mut cleared: Vec<Point2> = Vec::new();
        for inner in pocket.inner.iter().filter_map(|p| slice.pockets.get(*p)) {
            cleared.extend(inner.rings.iter().flat_map(|r| r.points.iter().copied()));
        }
        while !rest.is_empty() {
            let next = self.nearest(&rest);
            let ring = rest.swap_remove(next);
            if !ring.closed {
                self.open_ring(slice, pocket, &ring, &cleared);
                cleared.extend(&ring.points);
            } else if let Some(start) = self.come(slice, pocket, &ring, &cleared) {
                self.ring(slice.z, &ring, start);
                cleared.extend(&ring.points);
            }
        }
    }

    fn directed(&self, ring: &Ring) -> Ring {
        let mut ring = ring.clone();
        if self.manner.wall_left {
            ring.points.reverse();
        }
        ring
    }

    /// The ring that comes nearest to where the tip is; the first one while it is up.
    fn nearest(&self, rings: &[Ring]) -> usize {
        let Some(at) = self.at.or_else(|| self.last()) else { return 0 };
        let off = |ring: &Ring| {
            let ends = if ring.closed { ring.points.len() } else { 1 };
            ring.points.iter().take(ends).map(|p| (p - at.xy()).norm()).fold(f64::INFINITY, f64::min)
        };
        let best = rings.iter().enumerate().min_by(|a, b| off(a.1).total_cmp(&off(b.1)));
        best.map_or(0, |(i, _)| i)
    }

    fn last(&self) -> Option<Point3> {
        self.moves.last().map(|m| match m {
            Move::Rapid(p) | Move::Line(p) | Move::Arc { to: p, .. } => *p,
        })
    }

    /// A curve that ends at the blank's border: from outside where that is free, else from within the pocket.
    fn open_ring(&mut self, slice: &Slice, pocket: &Pocket, ring: &Ring, cleared: &[Point2]) {
        let z = slice.z;
        let mut points = ring.points.clone();
        let (Some(first), Some(last)) = (points.first().copied(), points.last().copied()) else { return };
        let outside = self.outside(first, z).or_else(|| {
            points.reverse();
            self.outside(last, z)
        });
        if let Some(entry) = outside {
            self.through_air(entry, z);
            self.tally.links += (entry - points[0]).norm();
            self.line(over(points[0], z));
        } else {
            let ends = Ring { points: vec![first, last], closed: false };
            let Some(start) = self.come(slice, pocket, &ends, cleared) else { return };
            let Some(at) = self.at.map(|p| p.xy()) else { return };
            // It was turned round above: now its last point leads.
            if start == 0 {
                points.reverse();
            }
            if (at - points[0]).norm() > 1e-9 {
                if !self.stays(slice, (at, points[0])) {
                    self.lift();
                    return self.skip(&ring.points);
                }
                self.tally.links += (at - points[0]).norm();
                self.line(over(points[0], z));
            }
        }
        self.run(&points, (z, z));
    }

    /// The nearest place beside the blank at which the cutter is clear of the stock and from which the way is free: straight
    /// away from the blank, or askew.
    fn outside(&self, p: Point2, z: f64) -> Option<Point2> {
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

    /// Whether the tip may run straight between two places.
    fn free(&self, (from, to): (Point2, Point2), z: f64) -> bool {
        let parts = ceil_to_usize((to - from).norm() / (0.5 * self.ground.grid.step)).max(1);
        let mut hints = Hints::default();
        (1..=parts).all(|k| {
            let p = from + (to - from) * (count(k) / count(parts));
            self.ground.value(p, z, &mut hints) <= 0.0
        })
    }

    /// To a place beside the blank: straight, while the way is clear of it, else over it.
    fn through_air(&mut self, to: Point2, z: f64) {
        let clear = |from: Point3| {
            let parts = ceil_to_usize((to - from.xy()).norm() / 0.5).max(1);
            (0..=parts).all(|k| {
                let p = from.xy() + (to - from.xy()) * (count(k) / count(parts));
                self.top_at(p).is_none_or(|top| top <= z - 1e-3)
            }) && self.free((from.xy(), to), z.min(from.z))
        };
        match self.at {
            Some(from) if (from.z - z).abs() < 1e-9 && clear(from) => {
                self.moves.push(Move::Rapid(over(to, z)));
                self.at = Some(over(to, z));
            }
            _ => self.descend(to, z),
        }
    }

    /// From above down to a place that is clear of material.
    fn descend(&mut self, to: Point2, z: f64) {
        self.lift();
        let safe = self.manner.safe;
        self.moves.push(Move::Rapid(over(to, safe)));
        let height = self.top_at(to).map_or(z, |top| (top + GAP).max(z)).min(safe);
        if height < safe {
            self.moves.push(Move::Rapid(over(to, height)));
        }
        self.at = Some(over(to, height));
        if height > z {
            self.tally.links += height - z;
            self.line(over(to, z));
        }
    }

    /// Height of the tip at which the cutter touches the stock.
    fn top_at(&self, p: Point2) -> Option<f64> {
        // A little larger: the control rounds.
        let cutter = self.cutter().grown(LARGER * self.stock.cell());
        let height = self.stock.clear_height(p, &cutter);
        height.is_finite().then_some(height - cutter.lift())
    }

    /// Comes down to the level at a ring or near it; where on the ring to begin. `None` where the pocket is left out.
    fn come(&mut self, slice: &Slice, pocket: &Pocket, ring: &Ring, cleared: &[Point2]) -> Option<usize> {
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

    /// Whether a straight way keeps out of the walls.
    fn stays(&self, slice: &Slice, (from, to): (Point2, Point2)) -> bool {
        let length = (to - from).norm();
        let parts = ceil_to_usize(length / (0.5 * self.ground.grid.step)).max(1);
        length <= 3.0 * self.manner.width
            && (0..parts).all(|k| {
                let p = from + (to - from) * (count(k) / count(parts));
                slice.room_at(&self.ground.grid, p) >= -0.02 * self.ground.grid.step
            })
            && self.free((from, from + (to - from) * 0.95), slice.z)
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
        self.through_air(end, z);
        Some(start)
    }

    /// Down into full material: by a helix in the pocket's deepest place, or along the ring.
    fn enter(&mut self, slice: &Slice, pocket: &Pocket, ring: &Ring) -> Option<usize> {
        let radius = self.ground.rest.radius;
        let (most, share, least) = HELIX;
        let (centre, room) = pocket.deepest;
        let helix = (share * room).min(most * radius);
        if helix >= least * radius && self.free((centre, centre), slice.z) {
            let start = closest(&ring.points, centre);
            self.helix(slice.z, (centre, helix), ring.points[start]);
            return Some(start);
        }
        let length = around(&ring.points);
        if length < (SHORTEST.0 * radius).max(SHORTEST.1 * self.cutter().flat()) {
            self.skip(&ring.points);
            return None;
        }
        self.tally.along_ring += 1;
        Some(self.ramp(slice.z, ring, length))
    }

    /// Notes that a ring is left out, if it is worth a word.
    fn skip(&mut self, points: &[Point2]) {
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

    /// A closed ring, from one of its points round to it.
    fn ring(&mut self, z: f64, ring: &Ring, start: usize) {
        let n = ring.points.len();
        let points: Vec<Point2> = (0..=n).map(|k| ring.points[(start + k) % n]).collect();
        if let Some(from) = self.at.filter(|p| (p.xy() - points[0]).norm() > 1e-9) {
            self.tally.links += (from.xy() - points[0]).norm();
            self.line(over(points[0], z));
        }
        self.run(&points, (z, z));
    }

    /// Along a chain of points, its height linear in its length.
    fn run(&mut self, points: &[Point2], (from, to): (f64, f64)) {
        let pieces = arcs::fit(points, self.manner.tolerance);
        let Some(mut at) = points.first().copied() else { return };
        let mut lengths = Vec::with_capacity(pieces.len());
        for piece in &pieces {
            lengths.push(length(at, piece));
            at = piece.to;
        }
        let whole: f64 = lengths.iter().sum();
        let mut gone = 0.0;
        for (piece, length) in pieces.iter().zip(lengths) {
            gone += length;
            let z = from + (to - from) * (gone / whole.max(1e-12)).min(1.0);
            match piece.arc {
                None => self.line(over(piece.to, z)),
                Some((centre, ccw)) => self.arc(over(piece.to, z), centre, ccw, 0),
            }
        }
        self.tally.rings += whole;
    }

    fn cutter(&self) -> Cutter {
        self.ground.rest.cutter
    }

    fn line(&mut self, to: Point3) {
        let cutter = self.cutter();
        if let Some(from) = self.at {
            self.stock.cut(cutter.reference(from), cutter.reference(to), &cutter);
        }
        self.moves.push(Move::Line(to));
        self.at = Some(to);
    }

    fn arc(&mut self, to: Point3, centre: Point2, ccw: bool, turns: u32) {
        let cutter = self.cutter();
        if let Some(from) = self.at {
            let (a, b) = (from.xy() - centre, to.xy() - centre);
            let sweep = sweep((a, b), ccw) + TAU * f64::from(turns);
            let parts = ceil_to_usize(sweep / 0.2).max(1);
            let at = |k: usize| {
                let share = count(k) / count(parts);
                let angle = crate::math::atan2(a.y, a.x) + if ccw { sweep } else { -sweep } * share;
                let (s, c) = sin_cos(angle);
                let r = a.norm();
                let z = from.z + (to.z - from.z) * share;
                cutter.reference(Point3::new(centre.x + r * c, centre.y + r * s, z))
            };
            for k in 0..parts {
                self.stock.cut(at(k), at(k + 1), &cutter);
            }
        }
        self.moves.push(Move::Arc { to, centre, ccw, turns });
        self.at = Some(to);
    }
}
