//! `PLANE/`, `MATRIX/`, and what is made of planes.

use std::rc::Rc;

use crate::diag::Diagnostic;
use crate::diag::codes::semantics;
use crate::source::Span;
use crate::units::{Dim, Quantity};

use super::Analyser;
use super::geometry::TOUCH;
use super::matched::{Found, Matched, Typed};
use super::transform::{Transform, cross, dot, minus, norm, unit};
use super::value::{Entity, PlaneValue, Value};

impl Analyser<'_> {
    /// `PLANE/ …`.
    pub(super) fn plane(&mut self, m: &Matched) -> Option<Value> {
        let (normal, point) = match m.form {
            "coefficients" | "canonical" => return self.plane_by_coefficients(m),
            "points" => {
                let (p, q, r) = (m.vector("point")?.v, m.vector("second")?.v, m.vector("third")?.v);
                (cross(minus(q, p), minus(r, p)), p)
            }
            "parallel through" => (plane_of(m, "plane")?.normal, m.vector("point")?.v),
            "parallel" => return self.parallel_plane(m),
            "normal" => (m.vector("vector")?.v, m.vector("point")?.v),
            "perpendicular to two" => {
                let (a, b) = (plane_of(m, "plane")?, plane_of(m, "second plane")?);
                (cross(a.normal, b.normal), m.vector("point")?.v)
            }
            "perpendicular through two" => {
                let (p, q) = (m.vector("point")?.v, m.vector("second")?.v);
                (cross(minus(q, p), plane_of(m, "plane")?.normal), p)
            }
            _ => {
                let distance = m.number("distance").unwrap_or(0.0);
                let normal = axis_of(m.word("base")?);
                return Some(Self::plane_value(normal, distance));
            }
        };
        // The sine of the angle between the two directions that span the normal, where there are two.
        let size = norm(normal);
        match unit(normal).filter(|_| size > TOUCH) {
            Some(n) => Some(Self::plane_value(n, dot(n, point))),
            None => self.fail_geometry(
                m.word,
                "no plane is fixed by these: points in a line, parallel planes, or a vector of length 0",
            ),
        }
    }

    fn plane_value(normal: [f64; 3], distance: f64) -> Value {
        Value::Entity(Entity::Plane(Rc::new(PlaneValue { normal, distance })))
    }

    fn plane_by_coefficients(&mut self, m: &Matched) -> Option<Value> {
        let normal = [m.number("a")?, m.number("b")?, m.number("c")?];
        let size = norm(normal);
        match unit(normal) {
            Some(n) => Some(Self::plane_value(n, m.number("d")? / size)),
            None => self.fail_geometry(m.word, "a, b and c are all 0, and no plane has that normal"),
        }
    }

    fn parallel_plane(&mut self, m: &Matched) -> Option<Value> {
        let plane = plane_of(m, "plane")?;
        let word = m.word("which")?;
        let axis = match word.as_bytes().first() {
            Some(b'X') => 0,
            Some(b'Y') => 1,
            _ => 2,
        };
        let component = plane.normal[axis];
        if component.abs() < TOUCH {
            let message = format!("{word} does not decide: the plane runs along that axis");
            return self.fail_geometry(m.span("which"), message);
        }
        let up = (component > 0.0) == word.ends_with("LARGE");
        let distance = m.number("distance")?;
        let distance = if up { plane.distance + distance } else { plane.distance - distance };
        Some(Self::plane_value(plane.normal, distance))
    }

    /// The point of three planes, by Cramer's rule.
    pub(super) fn planes_meet(&mut self, m: &Matched) -> Option<[f64; 3]> {
        let (a, b, c) = (plane_of(m, "plane")?, plane_of(m, "second")?, plane_of(m, "third")?);
        let (bc, ca, ab) = (cross(b.normal, c.normal), cross(c.normal, a.normal), cross(a.normal, b.normal));
        let determinant = dot(a.normal, bc);
        if determinant.abs() < TOUCH {
            return self.fail_geometry(m.word, "the three planes have no single point in common");
        }
        let part = |i: usize| (a.distance * bc[i] + b.distance * ca[i] + c.distance * ab[i]) / determinant;
        Some([part(0), part(1), part(2)])
    }

    /// A point and the direction of the line of two planes, seen along Z.
    pub(super) fn planes_line(&mut self, m: &Matched) -> Option<([f64; 2], [f64; 2])> {
        let (a, b) = (plane_of(m, "plane")?, plane_of(m, "second")?);
        let direction = cross(a.normal, b.normal);
        let size = dot(direction, direction);
        if size < TOUCH * TOUCH {
            return self.fail_geometry(m.word, "the two planes are parallel and do not meet");
        }
        if direction[0].abs() < TOUCH && direction[1].abs() < TOUCH {
            return self
                .fail_geometry(m.word, "the two planes meet in a line along Z: seen from above, a point");
        }
        let (p, q) = (cross(b.normal, direction), cross(direction, a.normal));
        let at = |i: usize| (a.distance * p[i] + b.distance * q[i]) / size;
        Some(([at(0), at(1)], [direction[0], direction[1]]))
    }

    /// `MATRIX/ …`.
    pub(super) fn matrix(&mut self, m: &Matched) -> Option<Value> {
        let map = match m.form {
            "steps" if m.found.is_empty() => {
                let message =
                    "MATRIX wants TRANSL, XYROT, YZROT, ZXROT, SCALE, MIRROR or other contents here";
                self.report(
                    Diagnostic::new(&semantics::MISSING_VALUE, m.word, message)
                        .help("for example `M1 = MATRIX/ XYROT, 90, TRANSL, 10, 0, 0`"),
                );
                return None;
            }
            "steps" => steps(&m.found),
            "mirror" => {
                let plane = plane_of(m, "plane")?;
                Transform::mirror(plane.normal, plane.distance)
            }
            "inverse" => match matrix_of(m, "matrix")?.inverse() {
                Some(inverse) => inverse,
                None => {
                    return self
                        .fail_geometry(m.span("matrix"), "this matrix flattens space and has no inverse");
                }
            },
            "product" => matrix_of(m, "matrix")?.after(&matrix_of(m, "second")?),
            "frame" => self.frame(m)?,
            _ => self.elements(m)?,
        };
        Some(Value::Entity(Entity::Matrix(Rc::new(map))))
    }

    fn frame(&mut self, m: &Matched) -> Option<Transform> {
        let (x, y) = (unit(m.vector("x axis")?.v), unit(m.vector("y side")?.v));
        let axes = x.zip(y).and_then(|(x, y)| {
            let z = cross(x, y);
            (norm(z) > TOUCH).then(|| unit(z)).flatten().map(|z| [x, cross(z, x), z])
        });
        match axes {
            Some(axes) => Some(Transform::frame(axes, m.vector("point")?.v)),
            None => self.fail_geometry(
                m.word,
                "the two vectors of a frame must have lengths and must not be parallel",
            ),
        }
    }

    /// Twelve elements; every fourth is a length.
    fn elements(&mut self, m: &Matched) -> Option<Transform> {
        let found: Vec<(Quantity, Span)> = m
            .all("element")
            .filter_map(|f| match f.typed {
                Typed::Quantity(q) => Some((q, f.span)),
                _ => None,
            })
            .collect();
        let mut map = Transform::IDENTITY;
        for (row, elements) in map.0.iter_mut().zip(found.chunks(4)) {
            for (column, (slot, (q, span))) in row.iter_mut().zip(elements).enumerate() {
                let dim = if column == 3 { Dim::LENGTH } else { Dim::NONE };
                let Some(landed) = self.land(*q, dim, *span) else {
                    let wanted = if column == 3 { "a length" } else { "a pure number" };
                    let message =
                        format!("this element of a MATRIX is {wanted}, and this is {}", self.show(*q));
                    self.report(Diagnostic::new(&semantics::WRONG_DIMENSION, *span, message));
                    return None;
                };
                *slot = landed.value;
            }
        }
        Some(map)
    }
}

/// `TRANSL, x, y, XYROT, a …`: the first written acts first.
fn steps(found: &[Found]) -> Transform {
    let mut map = Transform::IDENTITY;
    let mut rest = found;
    while let Some((first, values)) = rest.split_first() {
        let is_step = |f: &Found| matches!(f.typed, Typed::Word(_)) && f.name != "mirror plane";
        let count = values.iter().take_while(|f| !is_step(f)).count();
        let (own, after) = values.split_at(count);
        rest = after;
        if let Typed::Word(word) = first.typed {
            map = step(word, own).after(&map);
        }
    }
    map
}

fn step(word: &str, values: &[Found]) -> Transform {
    let number = |i: usize| match values.get(i).map(|f| &f.typed) {
        Some(Typed::Number(x)) => *x,
        _ => 0.0,
    };
    match word {
        "TRANSL" => Transform::shift([number(0), number(1), number(2)]),
        "XYROT" => Transform::turn(0, 1, number(0)),
        "YZROT" => Transform::turn(1, 2, number(0)),
        "ZXROT" => Transform::turn(2, 0, number(0)),
        "SCALE" => Transform::scale([number(0); 3]),
        _ => match values.first().map(|f| &f.typed) {
            Some(Typed::Word(plane)) => Transform::mirror(axis_of(plane), 0.0),
            _ => Transform::IDENTITY,
        },
    }
}

/// Normal of a coordinate plane.
fn axis_of(plane: &str) -> [f64; 3] {
    match plane {
        "YZPLAN" => [1.0, 0.0, 0.0],
        "ZXPLAN" => [0.0, 1.0, 0.0],
        _ => [0.0, 0.0, 1.0],
    }
}

fn plane_of(m: &Matched, name: &str) -> Option<PlaneValue> {
    match m.entity(name)? {
        Entity::Plane(plane) => Some(**plane),
        _ => None,
    }
}

fn matrix_of(m: &Matched, name: &str) -> Option<Transform> {
    match m.entity(name)? {
        Entity::Matrix(matrix) => Some(**matrix),
        _ => None,
    }
}
