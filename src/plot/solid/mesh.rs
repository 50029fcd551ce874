//! A finished surface as a grid of places with what is left on each.

use rayon::prelude::*;

use super::scene::Scene;
use crate::cl::{Finish, Operation};
use crate::geom::surface::Patch;
use crate::geom::{Point3, Vec3};
use crate::verify::{Left, Remaining, Sweep};

/// A place of the surface.
#[derive(Debug, Clone, Copy)]
pub(in crate::plot) struct Place {
    pub(in crate::plot) p: Point3,
    pub(in crate::plot) n: Vec3,
    /// The largest of those measured about this place, by magnitude; `None` where nothing is cut.
    pub(in crate::plot) left: Option<Left>,
    /// Area that it stands for, mm².
    pub(in crate::plot) area: f64,
}

/// A patch: places row by row, a row runs in v.
#[derive(Debug, Clone)]
pub(in crate::plot) struct Grid {
    pub(in crate::plot) rows: usize,
    pub(in crate::plot) columns: usize,
    pub(in crate::plot) places: Vec<Place>,
}

/// The surface of one operation.
#[derive(Debug, Clone)]
pub(in crate::plot) struct Mesh {
    /// Index of the operation.
    pub(in crate::plot) operation: usize,
    pub(in crate::plot) grids: Vec<Grid>,
}

/// Measurements about a place in each direction.
const WITHIN: usize = 3;

/// The meshes of all operations that finish a surface, of `places` places each at most; measured only when `measured`.
pub(in crate::plot) fn meshes(scene: &Scene<'_>, places: usize, measured: bool) -> Vec<Mesh> {
    scene
        .finished()
        .map(|(index, operation, finish)| {
            let own = scene.strokes.iter().zip(&scene.moves);
            let own = own.filter(|(s, _)| measured && s.operation.is_some_and(|o| o as usize == index));
            let moves: Vec<_> = own.map(|(_, (line, cut))| (*line, cut)).collect();
            let sweep = Sweep::new(finish, &moves);
            let remaining = measured.then(|| Remaining::new(operation, &sweep, allowed(operation, finish)));
            Mesh { operation: index, grids: grids(finish, places, remaining.as_ref()) }
        })
        .collect()
}

/// What may be left on a surface, mm; where no height of cusps was asked for, a guess from what the eye wants to see.
pub(in crate::plot) fn allowed(operation: &Operation, finish: &Finish) -> f64 {
    finish.cusp.unwrap_or(0.02 * finish.radius) + operation.band.out
}

fn grids(finish: &Finish, places: usize, remaining: Option<&Remaining<'_>>) -> Vec<Grid> {
    let patches = finish.tree.net().patches();
    let sizes: Vec<[f64; 2]> = patches.iter().map(extent).collect();
    let area: f64 = sizes.iter().map(|s| s[0] * s[1]).sum();
    let spacing = (area / crate::math::count(places.max(1))).sqrt().max(1e-9);
    let count = |length: f64| crate::math::ceil_to_usize(length / spacing).clamp(8, 2000);
    patches
        .iter()
        .enumerate()
        .map(|(index, patch)| {
            let [rows, columns] = sizes.get(index).map_or([8; 2], |s| s.map(count));
            grid(patch, index, [rows + 1, columns + 1], remaining)
        })
        .collect()
}

/// Lengths of a patch in u and in v: the longest of a few parameter lines.
fn extent(patch: &Patch) -> [f64; 2] {
    const LINES: usize = 5;
    const STEPS: usize = 24;
    let share = |i: usize, n: usize| crate::math::count(i) / crate::math::count(n);
    [0, 1].map(|axis| {
        let length = |k: usize| -> f64 {
            let at = |i: usize| {
                let (along, across) = (share(i, STEPS), share(k, LINES - 1));
                if axis == 0 { patch.point(along, across) } else { patch.point(across, along) }
            };
            (0..STEPS).map(|i| (at(i + 1) - at(i)).norm()).sum()
        };
        (0..LINES).map(length).fold(0.0, f64::max)
    })
}

fn grid(patch: &Patch, index: usize, [rows, columns]: [usize; 2], remaining: Option<&Remaining<'_>>) -> Grid {
    let step = [rows, columns].map(|n| 1.0 / crate::math::count(n.max(2) - 1));
    let row = |i: usize| -> Vec<Place> {
        let mut near = Vec::new();
        (0..columns)
            .map(|j| {
                let uv = [crate::math::count(i) * step[0], crate::math::count(j) * step[1]];
                let jet = patch.jet(uv[0], uv[1]);
                let left = remaining.and_then(|r| largest(r, index, uv, step, &mut near));
                let area = jet.area_vector().norm() * step[0] * step[1];
                Place { p: jet.p, n: jet.normal().unwrap_or_else(Vec3::z), left, area }
            })
            .collect()
    };
    let rows_of_places: Vec<Vec<Place>> = (0..rows).into_par_iter().map(row).collect();
    Grid { rows, columns, places: rows_of_places.concat() }
}

/// The largest by magnitude of a few places about one, so that a grid wider than the passes shows their ridges still.
fn largest(
    remaining: &Remaining<'_>,
    patch: usize,
    uv: [f64; 2],
    step: [f64; 2],
    near: &mut Vec<u32>,
) -> Option<Left> {
    let shift = |k: usize, axis: usize| {
        let by = crate::math::count(k) / crate::math::count(WITHIN) - 0.5 + 0.5 / crate::math::count(WITHIN);
        (uv[axis] + by * step[axis]).clamp(0.0, 1.0)
    };
    let mut most = Some(remaining.at(patch, uv, near)?);
    if most.is_some_and(|m| m.height > remaining.little()) {
        // Far from the surface no ridge matters.
        return most;
    }
    for k in 0..WITHIN * WITHIN {
        let left = remaining.at(patch, [shift(k / WITHIN, 0), shift(k % WITHIN, 1)], near)?;
        if most.is_none_or(|m| left.height.abs() > m.height.abs()) {
            most = Some(left);
        }
    }
    most
}

impl Mesh {
    /// All places.
    pub(in crate::plot) fn places(&self) -> impl Iterator<Item = &Place> {
        self.grids.iter().flat_map(|g| &g.places)
    }
}

impl Grid {
    pub(in crate::plot) fn at(&self, row: usize, column: usize) -> Option<&Place> {
        self.places.get(row * self.columns + column)
    }
    /// Places around the edge, in order.
    pub(in crate::plot) fn outline(&self) -> Vec<Point3> {
        let (last_row, last) = (self.rows - 1, self.columns - 1);
        let top = (0..last).map(|j| (0, j));
        let right = (0..last_row).map(|i| (i, last));
        let bottom = (0..last).map(|j| (last_row, last - j));
        let left = (0..=last_row).map(|i| (last_row - i, 0));
        top.chain(right).chain(bottom).chain(left).filter_map(|(i, j)| self.at(i, j)).map(|p| p.p).collect()
    }
}
