//! Surfaces as cells: what is nearest to the eye in each cell of a rectangle, drawn as runs of one colour.

use core::fmt::Write as _;
use std::collections::BTreeMap;

use super::camera::Camera;
use super::colour::Rgb;
use super::mesh::{Mesh, Place};
use crate::geom::{Point3, Vec3};
use crate::plot::canvas::{Canvas, Pixel};

/// Size of a cell, units of the drawing.
const CELL: f64 = 1.25;
/// Steps of light between the darkest and the brightest.
const LIGHTS: f64 = 22.0;

/// What is seen in a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Seen {
    depth: f64,
    /// Brightness, 0 to 1.
    light: f64,
    /// What is left there, mm.
    left: Option<f64>,
}

/// A rectangle of cells.
#[derive(Debug)]
pub(super) struct Raster {
    at: Pixel,
    columns: usize,
    rows: usize,
    cells: Vec<Option<Seen>>,
}

/// A corner of a triangle on the canvas.
#[derive(Debug, Clone, Copy)]
struct Corner {
    x: f64,
    y: f64,
    seen: Seen,
}

impl Raster {
    /// What a camera sees of surfaces in a rectangle.
    pub(super) fn new(meshes: &[&Mesh], camera: &Camera, at: Pixel, size: Pixel) -> Raster {
        let count = |length: f64| crate::math::ceil_to_usize(length / CELL).max(1);
        let (columns, rows) = (count(size.0), count(size.1));
        let mut raster = Raster { at, columns, rows, cells: vec![None; columns * rows] };
        let lamp = (camera.eye + Vec3::new(-0.35, 0.1, 0.5)).normalize();
        let corner = |place: &Place| {
            let (x, y) = camera.point(place.p);
            let light = (0.25 + 0.75 * place.n.dot(&lamp).abs()).clamp(0.0, 1.0);
            let left = place.left.map(|l| l.height);
            let seen = Seen { depth: camera.depth(place.p), light, left };
            Corner { x: (x - at.0) / CELL, y: (y - at.1) / CELL, seen }
        };
        for grid in meshes.iter().flat_map(|m| &m.grids) {
            for i in 1..grid.rows {
                for j in 1..grid.columns {
                    let places = [(i - 1, j - 1), (i - 1, j), (i, j - 1), (i, j)].map(|(a, b)| grid.at(a, b));
                    let [Some(a), Some(b), Some(c), Some(d)] = places else { continue };
                    let [a, b, c, d] = [a, b, c, d].map(corner);
                    raster.triangle(a, b, c);
                    raster.triangle(b, d, c);
                }
            }
        }
        raster
    }

    fn triangle(&mut self, a: Corner, b: Corner, c: Corner) {
        let twice = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
        if twice.abs() < 1e-12 {
            return;
        }
        let range = |low: f64, high: f64, most: usize| {
            // Floats saturate: what lies outside counts to the border.
            (((low - 0.5).ceil().max(0.0)) as usize, (high - 0.5).floor().min(crate::math::count(most) - 1.0))
        };
        let (x0, x1) = range(a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x), self.columns);
        let (y0, y1) = range(a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y), self.rows);
        if x1 < 0.0 || y1 < 0.0 {
            return;
        }
        for row in y0..=(y1 as usize) {
            for column in x0..=(x1 as usize) {
                let (x, y) = (crate::math::count(column) + 0.5, crate::math::count(row) + 0.5);
                let v = ((x - a.x) * (c.y - a.y) - (c.x - a.x) * (y - a.y)) / twice;
                let w = ((b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y)) / twice;
                if v >= -1e-9 && w >= -1e-9 && v + w <= 1.0 + 1e-9 {
                    self.take(
                        row * self.columns + column,
                        blend([&a.seen, &b.seen, &c.seen], [1.0 - v - w, v, w]),
                    );
                }
            }
        }
    }

    fn take(&mut self, index: usize, seen: Seen) {
        if let Some(cell) = self.cells.get_mut(index)
            && cell.is_none_or(|old| old.depth < seen.depth)
        {
            *cell = Some(seen);
        }
    }

    /// Whether a point is not hidden by a surface that lies more than `slack` (mm) before it.
    pub(super) fn shows(&self, camera: &Camera, p: Point3, slack: f64) -> bool {
        let (x, y) = camera.point(p);
        let (column, row) = ((x - self.at.0) / CELL, (y - self.at.1) / CELL);
        if column < 0.0 || row < 0.0 || column as usize >= self.columns || row as usize >= self.rows {
            return true;
        }
        let cell = self.cells.get(row as usize * self.columns + column as usize).copied().flatten();
        cell.is_none_or(|seen| seen.depth <= camera.depth(p) + slack)
    }

    /// Draws the cells in the colours that `paint` gives to what is left and the light.
    pub(super) fn draw(&self, canvas: &mut Canvas, paint: impl Fn(Option<f64>, f64) -> Rgb) {
        let colours: Vec<Option<Rgb>> = self
            .cells
            .iter()
            .map(|c| c.map(|seen| paint(seen.left, (seen.light * LIGHTS).round() / LIGHTS)))
            .collect();
        let across = self.runs(&colours, false);
        let down = self.runs(&colours, true);
        let size = |runs: &BTreeMap<Rgb, String>| runs.values().map(String::len).sum::<usize>();
        let runs = if size(&down) < size(&across) { down } else { across };
        canvas.cells(self.at, CELL, &runs);
    }

    /// Path data of runs of one colour, along rows or down columns, in cells.
    fn runs(&self, colours: &[Option<Rgb>], down: bool) -> BTreeMap<Rgb, String> {
        let mut runs: BTreeMap<Rgb, String> = BTreeMap::new();
        let (lines, length) = if down { (self.columns, self.rows) } else { (self.rows, self.columns) };
        for line in 0..lines {
            let at = |k: usize| {
                let index = if down { k * self.columns + line } else { line * self.columns + k };
                colours.get(index).copied().flatten()
            };
            let mut first = 0;
            for k in 1..=length {
                let colour = at(first);
                if k < length && at(k) == colour {
                    continue;
                }
                if let Some(colour) = colour {
                    let data = runs.entry(colour).or_default();
                    // Writing to a string cannot fail.
                    let _ = if down {
                        write!(data, "M{line}.5 {first}v{}", k - first)
                    } else {
                        write!(data, "M{first} {line}.5h{}", k - first)
                    };
                }
                first = k;
            }
        }
        runs
    }
}

fn blend(seen: [&Seen; 3], shares: [f64; 3]) -> Seen {
    let mix = |of: fn(&Seen) -> f64| -> f64 { seen.iter().zip(shares).map(|(s, w)| of(s) * w).sum() };
    let known = seen.iter().all(|s| s.left.is_some());
    Seen {
        depth: mix(|s| s.depth),
        light: mix(|s| s.light),
        left: known.then(|| mix(|s| s.left.unwrap_or(0.0))),
    }
}
