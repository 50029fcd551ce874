//! What rings leave between them where they lie farther apart than they reach: cores inside the innermost, and eyes at their
//! corners.
//!
//! From a place at a distance r from the walls the way to the nearest wall crosses every ring that is nearer to the walls,
//! the last of them r - k w away. Rings that reach as far as they lie apart leave nothing, therefore. Else something is left
//! where the next ring inwards is farther than that: it has a corner there, or is missing, or is cut off by the blank's border.

use super::ground::Ground;
use super::slice::{Slice, nearest, pieces};
use crate::geom::{Point2, Vec2, nearest_on_way};
use crate::math::count;

/// Parts of a step of the grid that are looked at.
const PARTS: usize = 4;
/// Ways into what is left, at most, in one level.
const MOST_SPURS: usize = 10_000;

impl Slice {
    /// Adds a ring in the middle of each innermost pocket that its ring does not clear, `reach` farther in. `home`: the innermost pocket of
    /// every node.
    pub(super) fn cores(&mut self, ground: &Ground, reach: f64, home: &[Option<usize>]) {
        let is_core = |p: usize| {
            self.pockets.get(p).is_some_and(|p| p.inner.is_empty() && p.deepest.1 > p.walls + reach)
        };
        let cores: Vec<bool> = (0..self.pockets.len()).map(is_core).collect();
        let over = |(room, home): (&f64, &Option<usize>)| match home.filter(|p| cores[*p]) {
            Some(p) => self.pockets[p].walls + reach - room,
            None => f64::INFINITY,
        };
        let values: Vec<f64> = self.room.iter().zip(home).map(over).collect();
        let before = self.pockets.len();
        let own = self.layer(ground, values, None, &vec![None; home.len()]);
        let mut placed = vec![false; self.pockets.len()];
        for (own, home) in own.iter().zip(home) {
            if let (Some(own), Some(home)) = (*own, *home)
                && own >= before
                && !placed[own]
            {
                placed[own] = true;
                self.pockets[home].inner.push(own);
            }
        }
    }

    /// Ways from the rings to what they do not reach: each into the place that is farthest from all before it.
    pub(super) fn between(&self, ground: &Ground, reach: f64) -> Vec<(Point2, Point2)> {
        let rings = self.pockets.iter().flat_map(|p| &p.rings);
        let pieces: Vec<(Point2, Point2)> = rings.flat_map(|r| pieces(&r.points, r.closed)).collect();
        let reach = reach - within(ground.grid.step);
        let mut left = self.unreached(ground, (&pieces, reach));
        let mut spurs = Vec::new();
        while let Some((to, _, from)) = left.iter().max_by(|a, b| a.1.total_cmp(&b.1)).copied() {
            spurs.push((from, to));
            if spurs.len() >= MOST_SPURS {
                break;
            }
            for (p, off, foot) in &mut left {
                let q = nearest_on_way(from, to, *p);
                if (q - *p).norm() < *off {
                    (*off, *foot) = ((q - *p).norm(), q);
                }
            }
            left.retain(|(_, off, _)| *off > reach);
        }
        spurs
    }

    /// Places farther than `reach` from some pieces, with how far they are and their nearest place on them.
    fn unreached(
        &self,
        ground: &Ground,
        (pieces, reach): (&[(Point2, Point2)], f64),
    ) -> Vec<(Point2, f64, Point2)> {
        let grid = &ground.grid;
        let near = nearest(grid, pieces);
        let part = grid.step / count(PARTS);
        let mut found = Vec::new();
        let around = core::f64::consts::FRAC_1_SQRT_2 * grid.step;
        for k in (0..grid.len()).filter(|k| self.room[*k] > 0.0 && near[*k].0 > reach - around) {
            let own: Vec<usize> = grid.beside(k).chain([k]).map(|n| near[n].1).collect();
            for n in 0..PARTS * PARTS {
                let [x, y] = [n / PARTS, n % PARTS].map(|i| (count(i) + 0.5) * part - 0.5 * grid.step);
                let p = grid.node(k) + Vec2::new(x, y);
                let feet = own.iter().filter_map(|n| pieces.get(*n)).map(|(a, b)| nearest_on_way(*a, *b, p));
                let foot = feet.min_by(|a, b| (a - p).norm().total_cmp(&(b - p).norm()));
                if let Some(foot) = foot.filter(|q| (q - p).norm() > reach)
                    && ground.blank.distance(p) <= 0.0
                {
                    found.push((p, (foot - p).norm(), foot));
                }
            }
        }
        found
    }
}

/// Between the places that are looked at none is farther from one of them than this, mm.
fn within(step: f64) -> f64 {
    core::f64::consts::FRAC_1_SQRT_2 * step / count(PARTS)
}

/// The largest distance of rings beside each other, mm, at which nothing stands along them: `reach` less what the grid's step
/// leaves unknown of it and of the rings.
pub(super) fn widest(reach: f64, step: f64) -> f64 {
    const RINGS: f64 = 0.1;
    2.0 * (reach - within(step) - RINGS * step)
}
