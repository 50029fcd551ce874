//! The faces of a file, and the net of one of them.

use std::collections::BTreeMap;

use crate::geom::Point3;
use crate::geom::surface::Net;

use super::super::bounds::Boundary;
use super::super::{Face, Import, Notice, Trouble, choose, net_of};
use super::part21::Exchange;
use super::value::{Instance, Value};
use super::{splines, units};

/// Types of faces; their last but one parameter is the surface.
const FACES: [&str; 2] = ["ADVANCED_FACE", "FACE_SURFACE"];
/// Curves that wrap another one.
const WRAPPED: usize = 8;
/// Edges of a face that are looked at.
const MOST_EDGES: usize = 1000;
/// Points that are looked at inside every span of an edge.
const INSIDE: u32 = 7;

/// A face's place in the file, if it is one, and its surface's.
struct Found {
    face: Option<usize>,
    surface: usize,
}

/// The net of a face; see [`super::super::Document::net`].
pub(in crate::cad) fn net(file: &Exchange, wanted: Option<usize>) -> Result<Import, Trouble> {
    let found = find(file)?;
    let what = if found.iter().any(|f| f.face.is_some()) { "face" } else { "surface" };
    let faces = classified(file, &found)?;
    let index = choose(&faces, what, wanted)?;
    let Some(found) = found.get(index) else { return Err(file.wrong(0, "face")) };
    let of = found.face.unwrap_or(found.surface);
    let unit = units::length_unit(file, of)?;
    let surface = splines::surface(file, found.surface, unit.unwrap_or(1.0))?;
    let net = net_of(&surface, file.line(found.surface))?;
    let mut notices = Vec::new();
    if unit.is_none() {
        notices.push(Notice::NoUnit);
    }
    if let Some(face) = found.face {
        notices.extend(trimmed(file, face, unit.unwrap_or(1.0), &net)?);
    }
    if (0..file.len()).any(|at| matches!(file.keyword(at), "ITEM_DEFINED_TRANSFORMATION" | "MAPPED_ITEM")) {
        notices.push(Notice::Placed);
    }
    Ok(Import { net, face: index + 1, notices })
}

/// What lies under the faces; a surface that several share is looked at once.
fn classified(file: &Exchange, found: &[Found]) -> Result<Vec<Face>, Trouble> {
    let mut known: BTreeMap<usize, Face> = BTreeMap::new();
    let mut faces = Vec::with_capacity(found.len());
    for f in found {
        if let Some(face) = known.get(&f.surface) {
            faces.push(face.clone());
            continue;
        }
        let surface = file.instance(f.surface)?;
        let is_spline = splines::is_surface(&surface);
        let face = Face { kind: if is_spline { String::new() } else { kind(&surface) }, is_spline };
        known.insert(f.surface, face.clone());
        faces.push(face);
    }
    Ok(faces)
}

/// The faces in the order of the file; without any, its B-spline surfaces.
fn find(file: &Exchange) -> Result<Vec<Found>, Trouble> {
    let mut found = Vec::new();
    for place in (0..file.len()).filter(|&p| FACES.contains(&file.keyword(p))) {
        let face = file.instance(place)?;
        let surface = face.all().iter().rev().nth(1).and_then(Value::reference);
        let id = surface.ok_or_else(|| file.wrong(place, "surface"))?;
        let surface = file.place(id).ok_or_else(|| file.dangling(id, place))?;
        found.push(Found { face: Some(place), surface });
    }
    if !found.is_empty() {
        return Ok(found);
    }
    for place in 0..file.len() {
        let several = file.keyword(place).is_empty();
        if (several
            || file.keyword(place).ends_with("_SURFACE_WITH_KNOTS")
            || file.keyword(place).ends_with("_SURFACE"))
            && file.body(place).contains("_SURFACE")
            && splines::is_surface(&file.instance(place)?)
        {
            found.push(Found { face: None, surface: place });
        }
    }
    Ok(found)
}

/// The name of a surface's type.
fn kind(surface: &Instance<'_>) -> String {
    let names: Vec<&str> = surface.names().collect();
    names
        .iter()
        .rev()
        .find(|n| n.ends_with("SURFACE"))
        .or(names.first())
        .map_or_else(String::new, |n| (*n).to_owned())
}

/// What to say of the face's edges.
fn trimmed(file: &Exchange, face: usize, unit: f64, net: &Net) -> Result<Option<Notice>, Trouble> {
    let instance = file.instance(face)?;
    let bounds = instance.all().iter().rev().nth(2).and_then(Value::references).unwrap_or_default();
    let mut boundary = Boundary { holes: bounds.len() > 1, ..Boundary::default() };
    for bound in bounds.iter().take(1) {
        let (at, bound) = file.get(*bound, face)?;
        let Some(id) = bound.all().get(1).and_then(Value::reference) else {
            return Err(file.wrong(at, "loop"));
        };
        let (at, edges) = file.get(id, at)?;
        match edges.of("EDGE_LOOP").and_then(|v| v.first()).and_then(Value::references) {
            Some(edges) if edges.len() <= MOST_EDGES => {
                for id in edges {
                    edge(file, (id, at), unit, &mut boundary)?;
                }
            }
            _ => boundary.unknown = true,
        }
    }
    Ok(boundary.notice(net))
}

/// Adds the ends of an `ORIENTED_EDGE` and points between them.
fn edge(file: &Exchange, (id, from): (u64, usize), unit: f64, to: &mut Boundary) -> Result<(), Trouble> {
    if !to.may_read(file.size(id)) {
        return Ok(());
    }
    let (at, oriented) = file.get(id, from)?;
    let Some(id) = oriented.of("ORIENTED_EDGE").and_then(|v| v.get(2)).and_then(Value::reference) else {
        return Err(file.wrong(at, "edge"));
    };
    if !to.may_read(file.size(id)) {
        return Ok(());
    }
    let (at, edge) = file.get(id, at)?;
    let Some([Value::Reference(a), Value::Reference(b), Value::Reference(curve), ..]) = edge.of("EDGE_CURVE")
    else {
        to.unknown = true;
        return Ok(());
    };
    let ends = [vertex(file, *a, at, unit)?, vertex(file, *b, at, unit)?];
    to.corners.extend(ends);
    let curve = match unwrapped(file, (*curve, at), to)? {
        Some(place) => curve_points(file, place, unit, ends)?,
        None => None,
    };
    match curve {
        Some(points) => to.inner.extend(points),
        None => to.unknown = true,
    }
    Ok(())
}

fn vertex(file: &Exchange, id: u64, from: usize, unit: f64) -> Result<Point3, Trouble> {
    let (at, vertex) = file.small(id, from)?;
    let point = vertex.of("VERTEX_POINT").and_then(|v| v.first()).and_then(Value::reference);
    splines::point(file, point.ok_or_else(|| file.wrong(at, "point"))?, at, unit)
}

/// The curve in space inside curves on surfaces; `None` where that is too much to read.
fn unwrapped(
    file: &Exchange,
    (mut id, mut from): (u64, usize),
    to: &mut Boundary,
) -> Result<Option<usize>, Trouble> {
    const WRAPPERS: [&str; 3] = ["SURFACE_CURVE", "SEAM_CURVE", "INTERSECTION_CURVE"];
    for _ in 0..WRAPPED {
        if !to.may_read(file.size(id)) {
            return Ok(None);
        }
        let (at, curve) = file.get(id, from)?;
        if !WRAPPERS.iter().any(|w| curve.is(w)) {
            return Ok(Some(at));
        }
        let inner = curve.all().get(1).and_then(Value::reference);
        (id, from) = (inner.ok_or_else(|| file.wrong(at, "curve"))?, at);
    }
    Ok(None)
}

/// Points of an edge's curve between its ends; `None` where the curve is of another kind.
fn curve_points(
    file: &Exchange,
    place: usize,
    unit: f64,
    ends: [Point3; 2],
) -> Result<Option<Vec<Point3>>, Trouble> {
    if file.instance(place)?.is("LINE") {
        let at = |t: f64| Point3::from(ends[0].coords * (1.0 - t) + ends[1].coords * t);
        return Ok(Some((1..8).map(|k| at(f64::from(k) / 8.0)).collect()));
    }
    let spline = splines::curve(file, place, unit)?;
    Ok(spline.and_then(|s| s.samples(INSIDE)).map(|points| between(points, ends)))
}

/// The points between those that are nearest to the ends of the edge: the curve may be longer than the edge.
fn between(points: Vec<Point3>, ends: [Point3; 2]) -> Vec<Point3> {
    let nearest = |end: &Point3, points: &[Point3], first: bool| {
        let far = |i: &usize| (points[*i] - end).norm();
        let all = 0..points.len();
        let best = all.clone().map(|i| far(&i)).fold(f64::INFINITY, f64::min);
        let near = |i: &usize| far(i) <= best + 1e-9;
        if first { all.clone().find(near) } else { all.clone().rev().find(near) }
    };
    if (ends[0] - ends[1]).norm() == 0.0 {
        return points;
    }
    match (nearest(&ends[0], &points, true), nearest(&ends[1], &points, false)) {
        (Some(a), Some(b)) => {
            let (a, b) = (a.min(b), a.max(b));
            // The samples next to the ends may lie beyond them.
            points.get(a + 1..b).map_or_else(Vec::new, <[Point3]>::to_vec)
        }
        _ => points,
    }
}
