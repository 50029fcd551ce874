//! The faces of an IGES file: trimmed surfaces (144), bounded surfaces (143), faces (510), or its B-spline surfaces.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use crate::geom::surface::Net;

use super::super::bounds::Boundary;
use super::super::{Face, Import, Notice, Trouble, choose, net_of};
use super::entities::{self, curve_points, numbers};
use super::records::Drawing;

const SPLINE: u32 = 128;
/// Points that are looked at inside every span of an edge.
const INSIDE: u32 = 7;
/// Bytes of the parameters of all faces, at most: as many as the largest file has.
const WORK: usize = 512 * 1024 * 1024;
/// Curves of a boundary that are looked at.
const MOST: usize = 1000;

/// The net of a face; see [`super::super::Document::net`].
pub(in crate::cad) fn net(file: &Drawing, wanted: Option<usize>) -> Result<Import, Trouble> {
    let found = find(file)?;
    let what = if found.iter().any(|f| f.0.is_some()) { "face" } else { "surface" };
    let kind = |i: usize| file.entries().get(i).map_or(0, |e| e.kind);
    let faces: Vec<Face> = found
        .iter()
        .map(|f| Face { kind: format!("surface of type {}", kind(f.1)), is_spline: kind(f.1) == SPLINE })
        .collect();
    let index = choose(&faces, what, wanted)?;
    let Some((face, surface)) = found.get(index).copied() else {
        return Err(Trouble::file(1, "there is no face"));
    };
    let spline = entities::surface(file, surface)?;
    let net = net_of(&spline.surface, file.line(surface))?;
    let mut notices = Vec::new();
    if file.unit().is_none() {
        notices.push(Notice::NoUnit);
    }
    if spline.partial {
        notices.push(Notice::Trimmed);
    } else if let Some(face) = face {
        notices.extend(trimmed(file, face, &net)?);
    }
    Ok(Import { net, face: index + 1, notices })
}

/// Faces with their surfaces; without any, the B-spline surfaces.
fn find(file: &Drawing) -> Result<Vec<(Option<usize>, usize)>, Trouble> {
    let mut found = Vec::new();
    let (mut free, mut work) = (Vec::new(), 0_usize);
    for (i, entry) in file.entries().iter().enumerate() {
        let at = match entry.kind {
            144 | 510 => 0,
            143 => 1,
            SPLINE => {
                free.push((None, i));
                continue;
            }
            _ => continue,
        };
        work = work.saturating_add(file.size(i));
        if work > WORK {
            return Err(Trouble::file(file.line(i), "the parameters of the faces overlap"));
        }
        let surface = numbers(file, i)?.get(at).and_then(|p| file.index(*p));
        let surface = surface.ok_or_else(|| Trouble::file(file.line(i), "this face names no surface"))?;
        found.push((Some(i), surface));
    }
    Ok(if found.is_empty() { free } else { found })
}

fn trimmed(file: &Drawing, face: usize, net: &Net) -> Result<Option<Notice>, Trouble> {
    let kind = file.entries().get(face).map_or(0, |e| e.kind);
    let own = numbers(file, face)?;
    let field = |n: usize| own.get(n).copied().unwrap_or(0.0);
    let mut boundary = Boundary::default();
    match kind {
        144 => {
            // Surface, whether the outer boundary is another than the surface's own, number of holes, outer boundary.
            if field(1) == 0.0 && field(2) == 0.0 {
                return Ok(None);
            }
            boundary.holes = field(2) > 0.0;
            match file.index(field(3)) {
                // A curve on a surface (142); its curve in space is the fourth of its parameters.
                Some(curve) => {
                    let curve = numbers(file, curve)?.get(3).copied();
                    chain(file, curve.unwrap_or(0.0), &mut boundary)?;
                }
                None => boundary.unknown = true,
            }
        }
        143 => {
            // Type, surface, number of boundaries, boundaries.
            boundary.holes = field(2) > 1.0;
            match file.index(field(3)) {
                Some(at) => boundary_141(file, at, &mut boundary)?,
                None => boundary.unknown = true,
            }
        }
        _ => {
            // Surface, number of loops, whether the first is the outer one, loops (508).
            boundary.holes = field(1) > 1.0;
            match file.index(field(3)) {
                Some(at) => loop_508(file, at, &mut boundary)?,
                None => boundary.unknown = true,
            }
        }
    }
    Ok(boundary.notice(net))
}

/// The edges of a loop (508): number of edges, then of each its type (0: an edge, 1: a vertex), its list of edges (504),
/// its place in that, its sense, the number of its curves in parameters, and two fields for each of those.
fn loop_508(file: &Drawing, index: usize, to: &mut Boundary) -> Result<(), Trouble> {
    let own = numbers(file, index)?;
    let field = |n: usize| own.get(n).copied().unwrap_or(0.0);
    let mut lists: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    let mut at = 1_usize;
    for _ in 0..crate::math::ceil_to_usize(field(0)).min(MOST) {
        if field(at) == 0.0 {
            let Some(list) = file.index(field(at + 1)).filter(|i| to.may_read(file.size(*i))) else {
                to.unknown = true;
                return Ok(());
            };
            let edges = match lists.entry(list) {
                Entry::Occupied(known) => known.into_mut(),
                Entry::Vacant(new) => new.insert(numbers(file, list)?),
            };
            // A list of edges: their number, then of each its curve and its two vertices, each with its place in a list.
            let place = crate::math::ceil_to_usize(field(at + 2)).saturating_sub(1);
            let curve = place.checked_mul(5).and_then(|n| edges.get(n + 1)).copied();
            chain(file, curve.unwrap_or(0.0), to)?;
        }
        let more = crate::math::ceil_to_usize(field(at + 4)).min(MOST);
        at += 5 + 2 * more;
    }
    Ok(())
}

/// The curves of a boundary (141): type, preference, surface, number of curves, then of each its curve in space, its
/// sense, the number of its curves in parameters, and those.
fn boundary_141(file: &Drawing, index: usize, to: &mut Boundary) -> Result<(), Trouble> {
    let own = numbers(file, index)?;
    let field = |n: usize| own.get(n).copied().unwrap_or(0.0);
    let mut at = 4_usize;
    for _ in 0..crate::math::ceil_to_usize(field(3)).min(MOST) {
        chain(file, field(at), to)?;
        at = at.saturating_add(3).saturating_add(crate::math::ceil_to_usize(field(at.saturating_add(2))));
    }
    Ok(())
}

/// Adds a curve, or those of a composite curve (102).
fn chain(file: &Drawing, pointer: f64, to: &mut Boundary) -> Result<(), Trouble> {
    let mut parts = vec![pointer];
    if let Some(index) = file.index(pointer)
        && file.entries().get(index).is_some_and(|e| e.kind == 102)
    {
        let own = numbers(file, index)?;
        let count = own.first().map_or(0, |n| crate::math::ceil_to_usize(*n)).min(MOST);
        parts = own.into_iter().skip(1).take(count).collect();
    }
    for part in parts {
        let index = file.index(part).filter(|i| to.may_read(file.size(*i)));
        let points = index.map(|i| curve_points(file, i, INSIDE)).transpose()?.flatten();
        match points.as_deref() {
            Some([first, inner @ .., last]) => {
                to.corners.extend([*first, *last]);
                to.inner.extend_from_slice(inner);
            }
            _ => to.unknown = true,
        }
    }
    Ok(())
}
