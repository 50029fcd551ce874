//! A net as triangles: binary STL within a chord tolerance, without cracks.
//!
//! Every patch is halved, in the direction that bends more, until triangles inside a cell are near enough; the ends of
//! neighbouring cells on a cell's side become corners of its triangles, so that no edge has a gap.

use std::collections::BTreeSet;

use crate::geom::surface::{Net, Patch};
use crate::geom::{Point3, Vec3};
use crate::math::count;

/// Halvings of a patch in one direction, at most; half a step of the lattice is left for a cell's middle.
const DEEPEST: u32 = 15;
/// Steps of the lattice across a patch.
const LATTICE: u64 = 1 << (DEEPEST + 1);
/// Triangles of a file, at most.
pub const MOST_TRIANGLES: usize = 5_000_000;

/// A place on the lattice of the whole net.
type Place = (u64, u64);

/// A rectangle of the lattice.
#[derive(Debug, Clone, Copy)]
struct Cell {
    from: Place,
    to: Place,
}

/// The net would need more than [`MOST_TRIANGLES`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TooFine;

/// The bytes of a binary STL file, in mm. No triangle is farther from its part of the surface than `tolerance` (mm); the
/// format's 32 bits add their rounding. Normals point up (+z) where the surface does.
///
/// # Errors
/// [`TooFine`].
pub fn write(net: &Net, tolerance: f64) -> Result<Vec<u8>, TooFine> {
    let mut triangles = triangles(net, tolerance)?;
    let up: f64 = triangles.iter().map(|t| area(t).z).sum();
    if up < 0.0 {
        triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
    let mut bytes = vec![0_u8; 80];
    for (byte, letter) in bytes.iter_mut().zip(b"partwright, mm") {
        *byte = *letter;
    }
    let number = u32::try_from(triangles.len()).map_err(|_| TooFine)?;
    bytes.extend(number.to_le_bytes());
    for triangle in &triangles {
        let normal = area(triangle);
        let length = normal.norm();
        let normal = if length > 0.0 { normal / length } else { normal };
        for v in core::iter::once(&normal).chain(triangle.iter()) {
            for x in [v.x, v.y, v.z] {
                bytes.extend(single(x).to_le_bytes());
            }
        }
        bytes.extend([0, 0]);
    }
    Ok(bytes)
}

#[allow(clippy::cast_possible_truncation)]
fn single(x: f64) -> f32 {
    // Adding 0 makes -0 a plain 0.
    x as f32 + 0.0
}

fn area(t: &[Vec3; 3]) -> Vec3 {
    (t[1] - t[0]).cross(&(t[2] - t[0]))
}

fn triangles(net: &Net, tolerance: f64) -> Result<Vec<[Vec3; 3]>, TooFine> {
    let cells = cells(net, tolerance)?;
    let mut rows: BTreeSet<Place> = BTreeSet::new();
    for c in &cells {
        rows.extend([c.from, c.to, (c.from.0, c.to.1), (c.to.0, c.from.1)]);
    }
    let columns: BTreeSet<Place> = rows.iter().map(|p| (p.1, p.0)).collect();
    let point = |(u, v): Place| {
        let p = net.jet(part(u), part(v)).p;
        Vec3::new(f64::from(single(p.x)), f64::from(single(p.y)), f64::from(single(p.z)))
    };
    let mut out = Vec::new();
    for cell in &cells {
        let ring = ring(cell, &rows, &columns);
        let around: Vec<Vec3> = ring.iter().map(|p| point(*p)).collect();
        let mut add = |t: [Vec3; 3]| {
            if t[0] != t[1] && t[1] != t[2] && t[2] != t[0] {
                out.push(t);
            }
        };
        if let [a, b, c, d] = around.as_slice() {
            add([*a, *b, *c]);
            add([*a, *c, *d]);
        } else {
            let middle = point((cell.from.0.midpoint(cell.to.0), cell.from.1.midpoint(cell.to.1)));
            for (k, a) in around.iter().enumerate() {
                add([middle, *a, around[(k + 1) % around.len()]]);
            }
        }
        if out.len() > MOST_TRIANGLES {
            return Err(TooFine);
        }
    }
    Ok(out)
}

/// A place of the lattice as a parameter of the net; exact.
#[allow(clippy::cast_precision_loss)]
fn part(k: u64) -> f64 {
    k as f64 / LATTICE as f64
}

/// The corners of all cells on the sides of one, counter-clockwise in (u, v). `rows` holds (u, v), `columns` (v, u).
fn ring(cell: &Cell, rows: &BTreeSet<Place>, columns: &BTreeSet<Place>) -> Vec<Place> {
    let (Cell { from: (u0, v0), to: (u1, v1) }, mut ring) = (*cell, Vec::new());
    ring.extend(columns.range((v0, u0)..(v0, u1)).map(|(v, u)| (*u, *v)));
    ring.extend(rows.range((u1, v0)..(u1, v1)));
    ring.extend(columns.range((v1, u0 + 1)..=(v1, u1)).rev().map(|(v, u)| (*u, *v)));
    ring.extend(rows.range((u0, v0 + 1)..=(u0, v1)).rev());
    ring
}

/// Cells inside which any triangle is near enough.
fn cells(net: &Net, tolerance: f64) -> Result<Vec<Cell>, TooFine> {
    let columns = net.size()[1];
    let mut out = Vec::new();
    for (k, patch) in net.patches().iter().enumerate() {
        let place = |n: usize| (n as u64).saturating_mul(LATTICE);
        let corner = (place(k / columns), place(k % columns));
        let mut open = vec![((0, LATTICE), (0, LATTICE))];
        while let Some((u, v)) = open.pop() {
            let at = |(a, b): Place| (part(a), part(b));
            let [uu, uv, vv] = bends(&patch.restrict(at(u), at(v)));
            // A triangle lies in a circle of radius 1/√2 of the cell's own unit square; linear interpolation errs by at
            // most half its square times the second derivative (Waldron 1998, "The error in linear interpolation at
            // the vertices of a simplex").
            let error = 0.25 * (uu.max(vv) + uv);
            let (can_u, can_v) = (u.1 - u.0 > 2, v.1 - v.0 > 2);
            if error <= tolerance || !(can_u || can_v) {
                out.push(Cell {
                    from: (corner.0 + u.0, corner.1 + v.0),
                    to: (corner.0 + u.1, corner.1 + v.1),
                });
            } else if can_u && (uu >= vv || !can_v) {
                let middle = u.0.midpoint(u.1);
                open.extend([((u.0, middle), v), ((middle, u.1), v)]);
            } else {
                let middle = v.0.midpoint(v.1);
                open.extend([(u, (v.0, middle)), (u, (middle, v.1))]);
            }
            if out.len() + open.len() > MOST_TRIANGLES / 2 {
                return Err(TooFine);
            }
        }
    }
    Ok(out)
}

/// Bounds of |∂²r/∂u²|, |∂²r/∂u∂v|, |∂²r/∂v²| over a patch, mm: from the control nets of the homogeneous derivatives,
/// the origin moved to the patch so that weights count as little as they may.
fn bends(patch: &Patch) -> [f64; 3] {
    let [p, q] = patch.degree();
    let columns = q + 1;
    let centre = Point3::from(
        (0..=p)
            .flat_map(|i| (0..=q).map(move |j| (i, j)))
            .fold(Vec3::zeros(), |s, (i, j)| s + patch.pole(i, j).coords)
            / count((p + 1) * columns),
    );
    let lifted: Vec<(Vec3, f64)> =
        patch.homogeneous().iter().map(|h| (h.xyz() - centre.coords * h.w, h.w)).collect();
    let radius = lifted.iter().map(|(r, w)| r.norm() / w).fold(0.0, f64::max);
    let least = lifted.iter().map(|(_, w)| *w).fold(f64::INFINITY, f64::min);
    // Largest (position, weight) of a difference of order (a, b), as a derivative.
    let largest = |a: usize, b: usize| -> (f64, f64) {
        if p < a || q < b {
            return (0.0, 0.0);
        }
        let factor = |n: usize, order: usize| (0..order).map(|k| count(n - k)).product::<f64>();
        let mut best = (0.0_f64, 0.0_f64);
        for i in 0..=p - a {
            for j in 0..=q - b {
                let (r, w) = difference(&lifted, columns, (i, j), (a, b));
                best = (best.0.max(r.norm()), best.1.max(w.abs()));
            }
        }
        let factor = factor(p, a) * factor(q, b);
        (best.0 * factor, best.1 * factor)
    };
    let first = |(r, w): (f64, f64)| (r + w * radius) / least;
    let (u, v) = (largest(1, 0), largest(0, 1));
    let (du, dv) = (first(u), first(v));
    let (uu, uv, vv) = (largest(2, 0), largest(1, 1), largest(0, 2));
    [
        (uu.0 + 2.0 * u.1 * du + uu.1 * radius) / least,
        (uv.0 + u.1 * dv + v.1 * du + uv.1 * radius) / least,
        (vv.0 + 2.0 * v.1 * dv + vv.1 * radius) / least,
    ]
}

/// The forward difference of order (a, b) at (i, j); orders up to 2.
fn difference(
    poles: &[(Vec3, f64)],
    columns: usize,
    (i, j): (usize, usize),
    (a, b): (usize, usize),
) -> (Vec3, f64) {
    const SIGNED: [&[f64]; 3] = [&[1.0], &[-1.0, 1.0], &[1.0, -2.0, 1.0]];
    let mut sum = (Vec3::zeros(), 0.0);
    for (k, x) in SIGNED[a].iter().enumerate() {
        for (l, y) in SIGNED[b].iter().enumerate() {
            let (r, w) = poles[(i + k) * columns + j + l];
            sum = (sum.0 + r * (x * y), sum.1 + w * x * y);
        }
    }
    sum
}

#[cfg(test)]
mod tests;
