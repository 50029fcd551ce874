//! One level: where the tip may be, how far from the walls, and the rings that clear it.
//!
//! Rings are curves of a constant distance from the walls (the waterline of the surface raised by what is left, and where
//! the cutter must stay over the net, its plan). They are cut from the innermost outwards: every ring has cleared material on
//! its inside, and the waterline is cut last. Where the cutter comes from beside the blank, rings are cut off at its border.

use super::chain::enclosed;
use super::ground::{Grid, Ground, to_segment};
use super::march::{Line, lines};
use crate::geom::Point2;
use crate::math::count;

/// What is cleared without coming out of the stock: the places at a ring's distance from the walls, or farther.
#[derive(Debug, Clone, Default)]
pub(super) struct Pocket {
    pub rings: Vec<Ring>,
    /// Pockets farther from the walls, which are cleared first.
    pub inner: Vec<usize>,
    /// Its place farthest from the walls, and how far that is, mm.
    pub deepest: (Point2, f64),
    /// How far its rings are from the walls, mm.
    pub walls: f64,
    /// A part of it lies beside the blank.
    pub airy: bool,
}

/// A pass.
#[derive(Debug, Clone)]
pub(super) struct Ring {
    /// In order; of a closed one the first is not repeated.
    pub points: Vec<Point2>,
    pub closed: bool,
}

/// A level.
#[derive(Debug)]
pub(super) struct Slice {
    /// Height of the tip, mm.
    pub z: f64,
    pub pockets: Vec<Pocket>,
    /// Those that lie in no other.
    pub outer: Vec<usize>,
    /// Distance of the nodes from the walls, negative in them; empty where there are none.
    pub room: Vec<f64>,
    /// Area in which the tip may be, over the blank, mm².
    pub area: f64,
    /// Ways from a ring into what stands between rings.
    pub spurs: Vec<(Point2, Point2)>,
}

/// How far rings lie apart and how far they reach, and how far beside the blank the cutter is clear of it, mm.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spread {
    pub width: f64,
    /// Everything nearer than this to the path is cleared.
    pub reach: f64,
    pub air: f64,
}

/// Vertices nearer to each other than this part of the grid's step are one.
const SAME: f64 = 0.2;

/// The rings of the level at `z`; `None` where the tip can be nowhere.
pub(super) fn slice(ground: &Ground, z: f64, spread: Spread) -> Option<Slice> {
    let width = spread.width;
    let grid = &ground.grid;
    let values = ground.values(z);
    let walls = lines(grid, &values, &|a, b| ground.root((grid.node(a), grid.node(b)), z));
    let over = |k: usize| values[k] <= 0.0 && ground.blank.distance(grid.node(k)) <= 0.0;
    let area = area(ground, &walls, (0..grid.len()).filter(|k| over(*k)).count());
    if walls.is_empty() {
        return values.first().filter(|v| **v <= 0.0).map(|_| facing(ground, z, spread, area));
    }
    let room = distances(grid, &values, &walls);
    let most = (0..grid.len()).filter(|k| over(*k)).map(|k| room[k]).fold(0.0, f64::max);
    // Floats saturate; a level has far fewer rings than this.
    let last = (most / width).floor().clamp(0.0, 1e5) as usize;
    let mut slice = Slice { z, pockets: Vec::new(), outer: Vec::new(), room, area, spurs: Vec::new() };
    let mut inner: Vec<Option<usize>> = vec![None; grid.len()];
    // The innermost pocket that each node lies in.
    let mut home = inner.clone();
    for number in (0..=last).rev() {
        let from = count(number) * width;
        let over = slice.room.iter().map(|room| from - room).collect();
        inner = slice.layer(ground, over, (number == 0).then_some(&walls), &inner);
        home.iter_mut().zip(&inner).for_each(|(home, own)| *home = home.or(*own));
    }
    slice.outer.extend((0..slice.pockets.len()).filter(|p| inner.contains(&Some(*p))).collect::<Vec<_>>());
    // Rings nearer to each other than they reach leave nothing: from any place the way to the walls crosses one.
    if width > spread.reach {
        slice.cores(ground, spread.reach, &home);
        slice.spurs = slice.between(ground, spread.reach);
    }
    Some(slice)
}

impl Slice {
    /// The pockets at one distance from the walls (`values`: this less each node's), around those farther away; which pocket
    /// each node lies in.
    pub(super) fn layer(
        &mut self,
        ground: &Ground,
        values: Vec<f64>,
        walls: Option<&Vec<Line>>,
        inner: &[Option<usize>],
    ) -> Vec<Option<usize>> {
        let grid = &ground.grid;
        let within: Vec<bool> = (0..grid.len()).map(|k| values[k] <= 0.0 && ground.may_stand(k)).collect();
        let mut label: Vec<Option<usize>> = vec![None; grid.len()];
        for seed in 0..grid.len() {
            if within[seed] && label[seed].is_none() {
                let pocket = self.flood(ground, seed, (&values, &within), (&mut label, inner));
                self.pockets.push(pocket);
            }
        }
        let made;
        let curves = match walls {
            Some(walls) => walls,
            None => {
                made = lines(grid, &values, &|a, b| {
                    let t = values[a] / (values[a] - values[b]);
                    grid.node(a) + (grid.node(b) - grid.node(a)) * t
                });
                &made
            }
        };
        for line in curves {
            for ring in over_blank(ground, line) {
                let beside = || ring.points.iter().flat_map(|p| grid.around(*p)).find_map(|k| label[k]);
                let own = if ground.open { beside() } else { label[line.node] };
                match own.and_then(|p| self.pockets.get_mut(p)) {
                    Some(pocket) => pocket.rings.push(ring),
                    // A corner without a node: only the walls themselves are worth it.
                    None if walls.is_some() => self.lone(ring),
                    None => {}
                }
            }
        }
        label
    }

    /// A piece of wall that has a pocket of its own.
    fn lone(&mut self, ring: Ring) {
        let Some(place) = ring.points.get(ring.points.len() / 2).copied() else { return };
        self.outer.push(self.pockets.len());
        self.pockets.push(Pocket {
            rings: vec![ring],
            deepest: (place, 0.0),
            airy: true,
            ..Pocket::default()
        });
    }

    fn flood(
        &self,
        ground: &Ground,
        seed: usize,
        (values, within): (&[f64], &[bool]),
        (label, inner): (&mut [Option<usize>], &[Option<usize>]),
    ) -> Pocket {
        let grid = &ground.grid;
        let own = Some(self.pockets.len());
        let (deepest, walls) = ((grid.node(seed), self.room[seed]), values[seed] + self.room[seed]);
        let mut pocket = Pocket { deepest, walls, ..Pocket::default() };
        let mut stack = vec![seed];
        label[seed] = own;
        while let Some(k) = stack.pop() {
            if self.room[k] > pocket.deepest.1 {
                pocket.deepest = (grid.node(k), self.room[k]);
            }
            if let Some(child) = inner[k].filter(|c| !pocket.inner.contains(c)) {
                pocket.inner.push(child);
            }
            for next in grid.beside(k) {
                pocket.airy |= values[next] <= 0.0 && !within[next];
                if within[next] && label[next].is_none() {
                    label[next] = own;
                    stack.push(next);
                }
            }
        }
        pocket
    }

    /// Length of the passes along the walls, mm.
    pub(super) fn waterline(&self) -> f64 {
        let own = self.pockets.iter().filter(|p| p.walls <= 0.0 && !self.room.is_empty());
        let rings = own.flat_map(|p| &p.rings).flat_map(|r| pieces(&r.points, r.closed));
        rings.map(|(a, b)| (b - a).norm()).sum()
    }

    /// How far a place is from the walls, mm.
    pub(super) fn room_at(&self, grid: &Grid, p: Point2) -> f64 {
        if self.room.is_empty() { f64::INFINITY } else { grid.between(&self.room, p) }
    }
}

/// Area inside closed walls, islands taken off, mm².
fn whole(walls: &[Line]) -> f64 {
    walls.iter().map(|w| enclosed(&w.points)).sum()
}

/// Area in which the tip may be: inside the walls where they are closed, else by nodes.
fn area(ground: &Ground, walls: &[Line], nodes: usize) -> f64 {
    if !walls.is_empty() && walls.iter().all(|w| w.closed) && !ground.open {
        return whole(walls);
    }
    let (low, high) = ground.blank.bounds();
    let inside =
        |w: &Line| w.closed && w.points.iter().all(|p| (0..2).all(|i| p[i] >= low[i] && p[i] <= high[i]));
    let whole = whole(walls);
    if whole > 0.0 && walls.iter().all(inside) {
        return whole;
    }
    count(nodes) * ground.grid.step * ground.grid.step
}

/// Distance of every node from the walls, mm, negative where the value is positive.
fn distances(grid: &Grid, values: &[f64], walls: &[Line]) -> Vec<f64> {
    let pieces: Vec<_> = walls.iter().flat_map(|wall| pieces(&wall.points, wall.closed)).collect();
    let near = nearest(grid, &pieces);
    (0..grid.len()).map(|k| if values[k] <= 0.0 { near[k].0 } else { -near[k].0 }).collect()
}

/// The pieces of a curve.
pub(super) fn pieces(points: &[Point2], closed: bool) -> impl Iterator<Item = (Point2, Point2)> {
    let count = points.len() - usize::from(!closed && !points.is_empty());
    (0..count).map(|k| (points[k], points[(k + 1) % points.len()]))
}

/// The nearest of some pieces of every node, and how far it is, mm. Each node takes the nearest piece over from its neighbours,
/// until none changes.
pub(super) fn nearest(grid: &Grid, pieces: &[(Point2, Point2)]) -> Vec<(f64, usize)> {
    let [columns, rows] = grid.counts;
    let mut near: Vec<(f64, usize)> = vec![(f64::INFINITY, usize::MAX); grid.len()];
    let off = |k: usize, piece: usize| {
        pieces.get(piece).map_or(f64::INFINITY, |(a, b)| to_segment(*a, *b, grid.node(k)))
    };
    for (n, (a, b)) in pieces.iter().enumerate() {
        let middle = a + (b - a) * 0.5;
        let index = |i: usize| {
            (((middle[i] - grid.low[i]) / grid.step).floor().max(0.0) as usize).min(grid.counts[i] - 2)
        };
        let k = index(0) * rows + index(1);
        for corner in [k, k + 1, k + rows, k + rows + 1] {
            let d = off(corner, n);
            if d < near[corner].0 {
                near[corner] = (d, n);
            }
        }
    }
    // Twice in each of the four directions: what a piece of wall reaches around a corner comes with the second round.
    for round in 0..8 {
        let (down, back) = (round % 2 == 1, round % 4 >= 2);
        for a in 0..columns {
            let i = if down { columns - 1 - a } else { a };
            for b in 0..rows {
                let j = if back { rows - 1 - b } else { b };
                let k = i * rows + j;
                let before_i =
                    if down { (i + 1 < columns).then(|| k + rows) } else { (i > 0).then(|| k - rows) };
                let shift =
                    |n: usize| if back { (j + 1 < rows).then(|| n + 1) } else { (j > 0).then(|| n - 1) };
                for other in [before_i, shift(k), before_i.and_then(shift)].into_iter().flatten() {
                    let piece = near[other].1;
                    if piece == usize::MAX {
                        continue;
                    }
                    for piece in [piece.wrapping_sub(1), piece, piece + 1] {
                        let d = off(k, piece);
                        if d < near[k].0 {
                            near[k] = (d, piece);
                        }
                    }
                }
            }
        }
    }
    near
}

/// The parts of a curve over the blank: all of it where the cutter does not come from outside.
fn over_blank(ground: &Ground, line: &Line) -> Vec<Ring> {
    let points = thinned(line, SAME * ground.grid.step);
    if points.len() < 2 {
        return Vec::new();
    }
    let off: Vec<f64> = points.iter().map(|p| ground.blank.distance(*p)).collect();
    if !ground.open || off.iter().all(|d| *d <= 0.0) {
        return vec![Ring { points, closed: line.closed }];
    }
    let n = points.len();
    let Some(start) = off.iter().position(|d| *d > 0.0) else { return Vec::new() };
    let mut rings: Vec<Ring> = Vec::new();
    let mut run: Vec<Point2> = Vec::new();
    // Round once, from a place outside; an open curve from its start.
    let start = if line.closed { start } else { 0 };
    let steps = if line.closed { n } else { n - 1 };
    if off[start] <= 0.0 {
        run.push(points[start]);
    }
    for step in 0..steps {
        let (a, b) = ((start + step) % n, (start + step + 1) % n);
        let crossing = || points[a] + (points[b] - points[a]) * (off[a] / (off[a] - off[b]));
        match (off[a] <= 0.0, off[b] <= 0.0) {
            (true, true) => run.push(points[b]),
            (false, true) => run = vec![crossing(), points[b]],
            (true, false) => {
                run.push(crossing());
                rings.push(Ring { points: core::mem::take(&mut run), closed: false });
            }
            (false, false) => {}
        }
    }
    rings.extend((!run.is_empty()).then_some(Ring { points: run, closed: false }));
    rings.retain(|r| r.points.len() > 1);
    rings
}

/// The points of a curve without those that almost coincide.
fn thinned(line: &Line, least: f64) -> Vec<Point2> {
    let mut points: Vec<Point2> = Vec::with_capacity(line.points.len());
    for p in &line.points {
        if points.last().is_none_or(|q| (p - q).norm() >= least) {
            points.push(*p);
        }
    }
    if line.closed && points.len() > 2 && (points[0] - points[points.len() - 1]).norm() < least {
        points.pop();
    }
    points
}

/// A level above all of the surface: lines to and fro over the blank, along its longer side.
fn facing(ground: &Ground, z: f64, Spread { width, air, .. }: Spread, area: f64) -> Slice {
    let (low, high) = ground.blank.bounds();
    let size = high - low;
    let axis = usize::from(size.y > size.x);
    let across = 1 - axis;
    let lines = crate::math::ceil_to_usize(size[across] / width).max(1);
    let step = size[across] / count(lines);
    let ring = |k: usize| {
        let at = |along: f64| {
            let mut p = low;
            p[axis] = along;
            p[across] = low[across] + (count(k) + 0.5) * step;
            p
        };
        let mut points = vec![at(low[axis] - air), at(high[axis] + air)];
        if k % 2 == 1 {
            points.reverse();
        }
        Ring { points, closed: false }
    };
    let pocket = Pocket {
        rings: (0..lines).map(ring).collect(),
        deepest: (low + size * 0.5, f64::INFINITY),
        airy: true,
        ..Pocket::default()
    };
    Slice { z, pockets: vec![pocket], outer: vec![0], room: Vec::new(), area, spurs: Vec::new() }
}
