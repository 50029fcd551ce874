//! The way of the cutter through a level: entries, rings, and how one leads to the next.

use super::arcs;
use super::chain::{length, sweep};
use super::ground::Ground;
use super::slice::{Pocket, Ring, Slice};
use crate::geom::surface::Cutter;
use crate::geom::surface::heights::HeightField;
use crate::geom::{Point2, Point3};
use crate::math::{TAU, ceil_to_usize, count, sin_cos};

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

impl Move {
    pub(super) fn end(&self) -> Point3 {
        match self {
            Move::Rapid(p) | Move::Line(p) | Move::Arc { to: p, .. } => *p,
        }
    }
}

/// What the path is made with.
#[derive(Debug, Clone, Copy)]
pub(super) struct Manner {
    /// Distance of rings, mm.
    pub width: f64,
    /// Everything nearer than this to the path is cleared at all of a level's depth, mm.
    pub reach: f64,
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
    /// From the outside inwards, or from the inside outwards; without it, as the cutter comes in best.
    pub inward: Option<bool>,
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

/// A pocket under way: what lies in it is not all cleared yet.
struct Turn {
    pocket: Option<usize>,
    rest: Vec<usize>,
    /// It is cut before what lies in it.
    reversed: bool,
}

/// The path under way.
pub(super) struct Path<'a> {
    pub(super) ground: &'a Ground,
    pub(super) manner: Manner,
    pub moves: Vec<Move>,
    pub tally: Tally,
    /// The tip, while it is down.
    pub(super) at: Option<Point3>,
    pub(super) stock: HeightField,
    /// The closed ring that was cut last from its walls on, as long as the tip is at its end.
    left: Vec<Point2>,
}

/// Chords of arcs leave them by this share of the stock's cells.
const SAGITTA: f64 = 0.02;

/// The ends of chords that leave an arc by no more than `off` mm, the arc's own end last.
pub(super) fn chords(
    from: Point3,
    (to, centre, ccw, turns): (Point3, Point2, bool, u32),
    off: f64,
) -> impl Iterator<Item = Point3> {
    // Of a helix, too, no chord is longer than this angle.
    const LONGEST: f64 = 0.5;
    let (a, b) = (from.xy() - centre, to.xy() - centre);
    let sweep = sweep((a, b), ccw) + TAU * f64::from(turns);
    let r = a.norm();
    let step = (8.0 * off / r.max(1e-9)).sqrt().min(LONGEST);
    let parts = ceil_to_usize(sweep / step).max(1);
    let start = crate::math::atan2(a.y, a.x);
    (1..=parts).map(move |k| {
        if k == parts {
            return to;
        }
        let share = count(k) / count(parts);
        let (s, c) = sin_cos(start + if ccw { sweep } else { -sweep } * share);
        Point3::new(centre.x + r * c, centre.y + r * s, from.z + (to.z - from.z) * share)
    })
}

pub(super) fn over(p: Point2, z: f64) -> Point3 {
    Point3::new(p.x, p.y, z)
}

impl<'a> Path<'a> {
    pub(super) fn new(ground: &'a Ground, manner: Manner, stock: HeightField) -> Path<'a> {
        Path { ground, manner, moves: Vec::new(), tally: Tally::default(), at: None, stock, left: Vec::new() }
    }

    /// Clears a level, the nearest pocket first: inner pockets whole before what is around them, or the other way round.
    pub(super) fn level(&mut self, slice: &Slice) {
        let mut stack = vec![Turn { pocket: None, rest: slice.outer.clone(), reversed: false }];
        while let Some(turn) = stack.last_mut() {
            let Some(index) = self.nearest_pocket(slice, &mut turn.rest) else {
                let done = stack.pop().filter(|turn| !turn.reversed).and_then(|turn| turn.pocket);
                if let Some(pocket) = done.and_then(|index| slice.pockets.get(index)) {
                    self.pocket(slice, pocket, &pocket.inner);
                }
                continue;
            };
            let Some(pocket) = slice.pockets.get(index) else { continue };
            let around = turn.pocket;
            let reversed = if around.is_none() { self.is_reversed(pocket) } else { turn.reversed };
            if reversed {
                self.pocket(slice, pocket, around.as_slice());
            }
            stack.push(Turn { pocket: Some(index), rest: pocket.inner.clone(), reversed });
        }
        self.spurs(slice);
    }

    /// What rings leave between them is cut last: it stands alone then.
    fn spurs(&mut self, slice: &Slice) {
        let mut rest = slice.spurs.clone();
        while let Some(at) = self.last() {
            let off = |n: usize| (rest[n].0 - at.xy()).norm();
            let Some(next) = (0..rest.len()).min_by(|a, b| off(*a).total_cmp(&off(*b))) else { break };
            let (from, to) = rest.swap_remove(next);
            if self.free((from, to), slice.z) {
                self.descend(from, slice.z);
                self.run(&[from, to], (slice.z, slice.z));
            }
        }
    }

    /// Whether a pocket is cleared from its walls on: that is outwards where the cutter comes from beside the blank, and
    /// inwards elsewhere.
    pub(super) fn is_reversed(&self, pocket: &Pocket) -> bool {
        self.manner.inward.is_some_and(|inward| inward != pocket.airy)
    }

    /// Takes the pocket out of the list whose deepest place is nearest to where the tip is.
    fn nearest_pocket(&self, slice: &Slice, rest: &mut Vec<usize>) -> Option<usize> {
        let at = self.last().map_or_else(Point2::origin, |p| p.xy());
        let off =
            |index: usize| slice.pockets.get(index).map_or(f64::INFINITY, |p| (p.deepest.0 - at).norm());
        let best = (0..rest.len()).min_by(|a, b| off(rest[*a]).total_cmp(&off(rest[*b])))?;
        Some(rest.swap_remove(best))
    }

    /// The rings of a pocket, beside others that are cleared.
    fn pocket(&mut self, slice: &Slice, pocket: &Pocket, before: &[usize]) {
        let mut rest: Vec<Ring> = pocket.rings.iter().map(|r| self.directed(pocket, r)).collect();
        let mut cleared: Vec<Point2> = Vec::new();
        for other in before.iter().filter_map(|p| slice.pockets.get(*p)) {
            cleared.extend(other.rings.iter().flat_map(|r| r.points.iter().copied()));
        }
        while !rest.is_empty() {
            let next = self.nearest(&rest);
            let ring = rest.swap_remove(next);
            if !ring.closed {
                self.open_ring(slice, pocket, &ring, &cleared);
                cleared.extend(&ring.points);
            } else if let Some(start) = self.come(slice, pocket, &ring, &cleared) {
                let before = core::mem::take(&mut self.left);
                let cut = self.ring(slice.z, &ring, start, &before);
                cleared.extend(&ring.points);
                if self.is_reversed(pocket) {
                    self.left = cut;
                }
            }
        }
    }

    /// A ring in the direction of travel: material is on the side of the walls, or on the other where the walls are cut before.
    fn directed(&self, pocket: &Pocket, ring: &Ring) -> Ring {
        let mut ring = ring.clone();
        let away = self.is_reversed(pocket) && pocket.walls > 0.0;
        if self.manner.wall_left != away {
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

    pub(super) fn last(&self) -> Option<Point3> {
        self.moves.last().map(Move::end)
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
            self.descend(entry, z);
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

    /// A closed ring, from one of its points round to it; `before`: the ring that was cut last, from its end on, where this lies
    /// beside it in full material.
    fn ring(&mut self, z: f64, ring: &Ring, start: usize, before: &[Point2]) -> Vec<Point2> {
        let mut ring = ring.clone();
        if before.is_empty() || !self.glide(z, before, &mut ring) {
            ring.points.rotate_left(start);
        }
        let mut points = ring.points;
        points.extend(points.first().copied());
        if let Some(from) = self.at.filter(|p| (p.xy() - points[0]).norm() > 1e-9) {
            self.tally.links += (from.xy() - points[0]).norm();
            self.line(over(points[0], z));
        }
        self.run(&points, (z, z));
        points.pop();
        points
    }

    /// Along a chain of points, its height linear in its length.
    pub(super) fn run(&mut self, points: &[Point2], (from, to): (f64, f64)) {
        // Not every control takes arcs that go down between points that are rounded: ways down are straight.
        let pieces = arcs::fit(points, self.manner.tolerance, from == to);
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

    pub(super) fn cutter(&self) -> Cutter {
        self.ground.rest.cutter
    }

    pub(super) fn line(&mut self, to: Point3) {
        let cutter = self.cutter();
        if let Some(from) = self.at {
            self.stock.cut(cutter.reference(from), cutter.reference(to), &cutter);
        }
        self.moves.push(Move::Line(to));
        self.at = Some(to);
    }

    pub(super) fn arc(&mut self, to: Point3, centre: Point2, ccw: bool, turns: u32) {
        let cutter = self.cutter();
        if let Some(from) = self.at {
            let off = SAGITTA * self.stock.cell();
            let mut at = from;
            for p in chords(from, (to, centre, ccw, turns), off) {
                self.stock.cut(cutter.reference(at), cutter.reference(p), &cutter);
                at = p;
            }
        }
        self.moves.push(Move::Arc { to, centre, ccw, turns });
        self.at = Some(to);
    }
}
