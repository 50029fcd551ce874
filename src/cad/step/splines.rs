//! B-spline surfaces and curves, in all their spellings: with knots, uniform, quasi-uniform, Bezier; rational or not.

use crate::geom::Point3;
use crate::geom::surface::{SplineCurve, SplineSurface};

use super::super::Trouble;
use super::part21::Exchange;
use super::value::{Instance, Value};

/// Control points of one surface or curve, at most.
const MOST_POLES: usize = 250_000;
/// Control points of an edge's curve, at most: with more it is not looked at.
const MOST_OF_CURVE: usize = 1000;
/// Largest degree that is looked at; nets stop far below.
const HIGHEST: usize = 1000;

/// Where the knots come from when they are not given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Knots {
    Given,
    Uniform,
    QuasiUniform,
    Bezier,
}

/// Endings of the type names of surfaces and curves.
const SPELLINGS: [(&str, &str, Knots); 4] = [
    ("B_SPLINE_SURFACE_WITH_KNOTS", "B_SPLINE_CURVE_WITH_KNOTS", Knots::Given),
    ("UNIFORM_SURFACE", "UNIFORM_CURVE", Knots::Uniform),
    ("QUASI_UNIFORM_SURFACE", "QUASI_UNIFORM_CURVE", Knots::QuasiUniform),
    ("BEZIER_SURFACE", "BEZIER_CURVE", Knots::Bezier),
];

fn spelling(instance: &Instance<'_>, surface: bool) -> Option<(&'static str, Knots)> {
    let rows = SPELLINGS.iter().map(|(s, c, knots)| (if surface { *s } else { *c }, *knots));
    rows.into_iter().find(|(name, _)| instance.is(name))
}

/// Whether an instance is a B-spline surface.
pub(super) fn is_surface(instance: &Instance<'_>) -> bool {
    spelling(instance, true).is_some()
}

/// Values of `base` in a complex instance, or those of the simple instance; with those of `own` behind them.
fn parts<'i>(i: &'i Instance<'i>, base: &str, own: &str) -> Option<(&'i [Value<'i>], &'i [Value<'i>])> {
    if i.is_complex() {
        return Some((i.of(base)?, i.of(own)?));
    }
    let split = if base == "B_SPLINE_SURFACE" { 7 } else { 5 };
    let values = i.of(own)?;
    Some((values.get(..split)?, values.get(split..)?))
}

/// The surface at a place; lengths are multiplied by `unit`.
pub(super) fn surface(file: &Exchange, place: usize, unit: f64) -> Result<SplineSurface, Trouble> {
    let instance = file.instance(place)?;
    let wrong = |what: &str| file.wrong(place, what);
    let (name, form) = spelling(&instance, true).ok_or_else(|| wrong("B-spline surface"))?;
    let (base, own) =
        parts(&instance, "B_SPLINE_SURFACE", name).ok_or_else(|| wrong("full list of parameters"))?;
    let degree = |i: usize| base.get(i).and_then(Value::count).filter(|d| *d <= HIGHEST);
    let (Some(p), Some(q)) = (degree(0), degree(1)) else { return Err(wrong("degree")) };
    let rows = base.get(2).and_then(Value::list).ok_or_else(|| wrong("rows of control points"))?;
    let mut ids: Vec<u64> = Vec::new();
    let mut columns = None;
    for row in rows {
        let row = row.references().ok_or_else(|| wrong("row of control points"))?;
        if columns.is_some_and(|c| c != row.len()) || ids.len() + row.len() > MOST_POLES {
            return Err(wrong("rows of equally many control points, 250000 at most,"));
        }
        columns = Some(row.len());
        ids.extend(row);
    }
    let columns = columns.unwrap_or(0);
    let poles = points(file, &ids, place, unit)?;
    let knots = |axis: usize, degree: usize, count: usize| {
        let given = own.get(axis).zip(own.get(axis + 2));
        knots_of(form, degree, count, given).ok_or_else(|| wrong("knots and multiplicities"))
    };
    let knots = [knots(0, p, rows.len())?, knots(1, q, columns)?];
    let weights = match instance.of("RATIONAL_B_SPLINE_SURFACE") {
        Some(values) => Some(weight_rows(values).ok_or_else(|| wrong("rows of weights"))?),
        None => None,
    };
    Ok(SplineSurface { degree: [p, q], knots, poles, weights })
}

fn weight_rows(values: &[Value<'_>]) -> Option<Vec<f64>> {
    let rows: Option<Vec<Vec<f64>>> = values.first()?.list()?.iter().map(Value::numbers).collect();
    Some(rows?.concat())
}

/// The curve at a place, if it is a B-spline curve that is not too long.
pub(super) fn curve(file: &Exchange, place: usize, unit: f64) -> Result<Option<SplineCurve>, Trouble> {
    let instance = file.instance(place)?;
    let Some((name, form)) = spelling(&instance, false) else { return Ok(None) };
    // A first look, so that nothing long is read point by point.
    if file.body(place).matches('#').count() > MOST_OF_CURVE {
        return Ok(None);
    }
    let wrong = |what: &str| file.wrong(place, what);
    let (base, own) =
        parts(&instance, "B_SPLINE_CURVE", name).ok_or_else(|| wrong("full list of parameters"))?;
    let degree = base.first().and_then(Value::count).filter(|d| *d <= HIGHEST);
    let ids = base.get(1).and_then(Value::references);
    let (Some(degree), Some(ids)) = (degree, ids) else { return Err(wrong("degree and control points")) };
    let poles = points(file, &ids, place, unit)?;
    let knots = knots_of(form, degree, poles.len(), own.first().zip(own.get(1)))
        .ok_or_else(|| wrong("knots and multiplicities"))?;
    let weights = match instance.of("RATIONAL_B_SPLINE_CURVE") {
        Some(values) => Some(values.first().and_then(Value::numbers).ok_or_else(|| wrong("weights"))?),
        None => None,
    };
    Ok(Some(SplineCurve { degree, knots, poles, weights }))
}

/// The points of these ids.
fn points(file: &Exchange, ids: &[u64], from: usize, unit: f64) -> Result<Vec<Point3>, Trouble> {
    ids.iter().map(|id| point(file, *id, from, unit)).collect()
}

/// A `CARTESIAN_POINT` of space.
pub(super) fn point(file: &Exchange, id: u64, from: usize, unit: f64) -> Result<Point3, Trouble> {
    let (place, instance) = file.small(id, from)?;
    let coordinates = instance.of("CARTESIAN_POINT").and_then(|v| v.first()).and_then(Value::numbers);
    match coordinates.as_deref() {
        Some([x, y, z]) => Ok(Point3::new(x * unit, y * unit, z * unit)),
        _ => Err(file.wrong(place, "point of three coordinates")),
    }
}

/// Knots, each as often as its multiplicity says.
fn knots_of(
    form: Knots,
    degree: usize,
    poles: usize,
    given: Option<(&Value<'_>, &Value<'_>)>,
) -> Option<Vec<f64>> {
    let count = crate::math::count;
    let wanted = poles.checked_add(degree)?.checked_add(1)?;
    match form {
        Knots::Given => {
            let (multiplicities, values) = given?;
            let (multiplicities, values) = (multiplicities.list()?, values.numbers()?);
            if multiplicities.len() != values.len() {
                return None;
            }
            let mut knots = Vec::new();
            for (m, knot) in multiplicities.iter().zip(values) {
                let m = m.count()?;
                // One more than wanted shows that the counts do not fit.
                knots.extend(core::iter::repeat_n(knot, m.min(wanted + 1 - knots.len().min(wanted))));
            }
            Some(knots)
        }
        Knots::Uniform => Some((0..wanted).map(count).collect()),
        Knots::QuasiUniform => {
            let spans = poles.checked_sub(degree)?;
            Some((0..wanted).map(|i| count(i.saturating_sub(degree).min(spans))).collect())
        }
        Knots::Bezier => {
            let spans = poles.checked_sub(1)?.checked_div(degree)?;
            let inner = |i: usize| i.checked_sub(1).map_or(0, |i| i / degree).min(spans);
            (poles == spans * degree + 1).then(|| (0..wanted).map(|i| count(inner(i))).collect())
        }
    }
}
