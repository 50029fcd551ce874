//! What stands in the parameters of entities: B-spline surfaces and curves, transformations.

use crate::geom::Point3;
use crate::geom::surface::{SplineCurve, SplineSurface};

use super::super::Trouble;
use super::records::{Drawing, Parameter};

/// Transformations on top of one another, at most.
const DEEPEST: usize = 16;
/// Largest index and degree that is looked at; what is larger has no parameters in any file.
const HIGHEST: f64 = 1e6;

/// Control points of an edge's curve, at most: with more it is not looked at.
const MOST_OF_CURVE: usize = 1000;

/// A surface, and the part of its parameters that is meant where it is not all.
pub(super) struct Surface {
    pub surface: SplineSurface,
    pub partial: bool,
}

/// Parameters, taken one after the other.
struct Reader<'a> {
    file: &'a Drawing,
    index: usize,
    values: Vec<Parameter>,
    at: usize,
}

impl<'a> Reader<'a> {
    fn new(file: &'a Drawing, index: usize) -> Result<Reader<'a>, Trouble> {
        Ok(Reader { file, index, values: file.parameters(index)?, at: 0 })
    }
    fn wrong(&self, what: &str) -> Trouble {
        let kind = self.file.entries().get(self.index).map_or(0, |e| e.kind);
        let message = format!("entity {kind} has no {what} where one must stand (parameter {})", self.at + 1);
        Trouble::file(self.file.line(self.index), message)
    }
    fn number(&mut self) -> Result<f64, Trouble> {
        let value = match self.values.get(self.at) {
            Some(Parameter::Number(x)) => *x,
            Some(Parameter::Default) => 0.0,
            _ => return Err(self.wrong("number")),
        };
        self.at += 1;
        Ok(value)
    }
    fn count(&mut self) -> Result<usize, Trouble> {
        let x = self.number()?;
        let fits = (0.0..=HIGHEST).contains(&x) && x.fract() == 0.0;
        if fits { Ok(crate::math::ceil_to_usize(x)) } else { Err(self.wrong("count")) }
    }
    /// So many numbers; more than there are parameters are never asked memory for.
    fn numbers(&mut self, count: usize) -> Result<Vec<f64>, Trouble> {
        if count > self.values.len().saturating_sub(self.at) {
            return Err(self.wrong(&format!("list of {count} numbers")));
        }
        (0..count).map(|_| self.number()).collect()
    }
}

/// The rows of a matrix: three factors and a shift.
type Matrix = [[f64; 4]; 3];

/// What an entity's transformation does to a point, its own unit and mm included.
fn placed(file: &Drawing, index: usize, points: Vec<Point3>) -> Result<Vec<Point3>, Trouble> {
    let mut points = points;
    let mut pointer = file.entries().get(index).map_or(0, |e| e.matrix);
    for _ in 0..DEEPEST {
        if pointer == 0 {
            let unit = file.unit().unwrap_or(1.0);
            return Ok(points.into_iter().map(|p| p * unit).collect());
        }
        let at =
            file.index(f64::from(pointer)).filter(|i| file.entries().get(*i).is_some_and(|e| e.kind == 124));
        let Some(at) = at else {
            return Err(Trouble::file(
                file.line(index),
                format!("directory line {pointer} is no transformation"),
            ));
        };
        let m = matrix(file, at)?;
        let image = |p: &Point3| Point3::from(m.map(|r| r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3]));
        points = points.iter().map(image).collect();
        pointer = file.entries().get(at).map_or(0, |e| e.matrix);
    }
    Err(Trouble::file(file.line(index), "transformations refer to one another without end"))
}

fn matrix(file: &Drawing, index: usize) -> Result<Matrix, Trouble> {
    let mut r = Reader::new(file, index)?;
    let mut rows = [[0.0; 4]; 3];
    for row in &mut rows {
        for element in row.iter_mut() {
            *element = r.number()?;
        }
    }
    Ok(rows)
}

/// The rational B-spline surface (128) at an index, in mm.
pub(super) fn surface(file: &Drawing, index: usize) -> Result<Surface, Trouble> {
    let mut r = Reader::new(file, index)?;
    let (k1, k2, m1, m2) = (r.count()?, r.count()?, r.count()?, r.count()?);
    let [_, _, polynomial, _, _] = [r.number()?, r.number()?, r.number()?, r.number()?, r.number()?];
    let knots = [r.numbers(k1 + m1 + 2)?, r.numbers(k2 + m2 + 2)?];
    let (rows, columns) = (k1 + 1, k2 + 1);
    let weights = r.numbers(rows.saturating_mul(columns))?;
    let numbers = r.numbers(rows.saturating_mul(columns).saturating_mul(3))?;
    let points = numbers.chunks_exact(3).map(|c| Point3::new(c[0], c[1], c[2])).collect();
    let points = placed(file, index, points)?;
    // In the file the index of u runs fastest; a net's rows run in v.
    let order = || (0..rows).flat_map(|i| (0..columns).map(move |j| j * rows + i));
    let poles = order().filter_map(|k| points.get(k).copied()).collect();
    let weights: Vec<f64> = order().filter_map(|k| weights.get(k).copied()).collect();
    let range = r.numbers(4).ok();
    let partial = range.is_some_and(|range| is_partial(&range, &knots, [m1, m2]));
    let weights = (polynomial == 0.0).then_some(weights);
    Ok(Surface { surface: SplineSurface { degree: [m1, m2], knots, poles, weights }, partial })
}

/// Whether the range (u0, u1, v0, v1) leaves out a part of the surface.
fn is_partial(range: &[f64], knots: &[Vec<f64>; 2], degree: [usize; 2]) -> bool {
    const SAME: f64 = 1e-9;
    knots.iter().zip(degree).zip(range.chunks(2)).any(|((knots, degree), range)| {
        let last = knots.len().checked_sub(degree + 1).and_then(|i| knots.get(i));
        match (knots.get(degree), last, range) {
            (Some(a), Some(b), [from, to]) if from < to => {
                let same = SAME * (b - a).abs();
                *from > a + same || *to < b - same
            }
            _ => false,
        }
    })
}

/// Points of a curve in space, its ends first and last; `None` for kinds that are not looked at.
pub(super) fn curve_points(
    file: &Drawing,
    index: usize,
    inside: u32,
) -> Result<Option<Vec<Point3>>, Trouble> {
    let kind = file.entries().get(index).map_or(0, |e| e.kind);
    let mut r = Reader::new(file, index)?;
    let points = match kind {
        110 => {
            let ends = r.numbers(6)?;
            let end = |i: usize| {
                ends.get(3 * i..3 * i + 3).map_or(Point3::origin(), |c| Point3::new(c[0], c[1], c[2]))
            };
            let at = |t: f64| Point3::from(end(0).coords * (1.0 - t) + end(1).coords * t);
            Some((0..=inside + 1).map(|k| at(f64::from(k) / f64::from(inside + 1))).collect())
        }
        126 => {
            let (k, m) = (r.count()?, r.count()?);
            if k > MOST_OF_CURVE {
                return Ok(None);
            }
            let [_, _, polynomial, _] = [r.number()?, r.number()?, r.number()?, r.number()?];
            let knots = r.numbers(k + m + 2)?;
            let weights = r.numbers(k + 1)?;
            let numbers = r.numbers(3 * (k + 1))?;
            let poles = numbers.chunks_exact(3).map(|c| Point3::new(c[0], c[1], c[2])).collect();
            let weights = (polynomial == 0.0).then_some(weights);
            SplineCurve { degree: m, knots, poles, weights }.samples(inside)
        }
        _ => None,
    };
    points.map(|p| placed(file, index, p)).transpose()
}

/// All parameters of an entity that are numbers; what is left out or a text counts as 0.
pub(super) fn numbers(file: &Drawing, index: usize) -> Result<Vec<f64>, Trouble> {
    let number = |p: &Parameter| if let Parameter::Number(x) = p { *x } else { 0.0 };
    Ok(file.parameters(index)?.iter().map(number).collect())
}
