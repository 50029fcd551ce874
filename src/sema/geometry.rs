//! Points, vectors, lines, circles, curves.

use std::rc::Rc;
use std::sync::Arc;

use crate::arena::Handle;
use crate::diag::Diagnostic;
use crate::diag::codes::{geometry as codes, semantics};
use crate::geom::curve::{Bezier, CircularArc, CurveRef, Segment, bezier_chain};
use crate::geom::{Point2, Vec2, cross, left};
use crate::ir::CurveEntity;
use crate::math::{self, hypot};
use crate::source::Span;
use crate::syntax::ast::BinaryOp;
use crate::units::{Dim, Quantity};

use super::Analyser;
use super::matched::{Matched, Typed};
use super::process::radians;
use super::value::{CircleValue, Entity, LineValue, Value, Vector};

/// Relative size below which a determinant or distance counts as zero.
const TOUCH: f64 = 1e-9;

/// A line as a point and a unit direction, mm.
#[derive(Clone, Copy)]
struct Ray {
    p: Point2,
    u: Vec2,
}

impl Analyser<'_> {
    fn impossible(&mut self, at: Span, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(&codes::UNDEFINED_GEOMETRY, at, message)
    }

    fn fail_geometry<T>(&mut self, at: Span, message: impl Into<String>) -> Option<T> {
        let problem = self.impossible(at, message);
        self.report(problem);
        None
    }

    fn xy(m: &Matched, name: &str) -> Option<Point2> {
        let v = m.vector(name)?.v;
        Some(Point2::new(v[0], v[1]))
    }

    fn ray(m: &Matched, name: &str) -> Option<Ray> {
        match m.entity(name)? {
            Entity::Line(line) => Some(ray_of(line)),
            _ => None,
        }
    }

    fn disc(m: &Matched, name: &str) -> Option<CircleValue> {
        match m.entity(name)? {
            Entity::Circle(circle) => Some(**circle),
            _ => None,
        }
    }

    /// `POINT/ …`.
    pub(super) fn point(&mut self, m: &Matched) -> Option<Value> {
        let v = match m.form {
            "coordinates" => [m.number("x")?, m.number("y")?, m.number("z").unwrap_or(0.0)],
            "point" => m.vector("point")?.v,
            "lines" => self.lines_meet(m)?,
            "circles" => self.circle_meets(m)?,
            "center" => Self::disc(m, "circle")?.centre,
            "on circle" => {
                let c = Self::disc(m, "circle")?;
                let (sin, cos) = math::sin_cos(radians(m.number("angle")?));
                [c.centre[0] + c.radius * cos, c.centre[1] + c.radius * sin, c.centre[2]]
            }
            _ => {
                let (sin, cos) = math::sin_cos(radians(m.number("angle")?));
                let r = m.number("r")?;
                [r * cos, r * sin, 0.0]
            }
        };
        Some(Value::Vector(Vector { v, dim: Dim::LENGTH }))
    }

    fn lines_meet(&mut self, m: &Matched) -> Option<[f64; 3]> {
        let (a, b) = (Self::ray(m, "line")?, Self::ray(m, "second")?);
        match meet(a, b) {
            Some(p) => Some([p.x, p.y, 0.0]),
            None => self.fail_geometry(m.word, "the two lines are parallel and do not meet"),
        }
    }

    /// Intersections with a circle; the modifier chooses.
    fn circle_meets(&mut self, m: &Matched) -> Option<[f64; 3]> {
        let points = match (m.entity("first")?, m.entity("second")?) {
            (Entity::Line(a), Entity::Line(b)) => meet(ray_of(a), ray_of(b)).into_iter().collect(),
            (Entity::Line(line), Entity::Circle(c)) | (Entity::Circle(c), Entity::Line(line)) => {
                line_circle(ray_of(line), c)
            }
            (Entity::Circle(a), Entity::Circle(b)) => circle_circle(a, b),
            _ => Vec::new(),
        };
        if points.is_empty() {
            return self.fail_geometry(m.word, "the two do not meet");
        }
        let chosen = pick(&points, m.word("which").unwrap_or(""));
        match chosen {
            Some(p) => Some([p.x, p.y, 0.0]),
            None => {
                let word = m.word("which").unwrap_or("").to_owned();
                let other = if word.starts_with('X') { "YLARGE or YSMALL" } else { "XLARGE or XSMALL" };
                let problem = self
                    .impossible(
                        m.span("which"),
                        format!("{word} does not decide: both points are alike in it"),
                    )
                    .help(format!("use {other}"));
                self.report(problem);
                None
            }
        }
    }

    /// `VECTOR/ …`.
    pub(super) fn vector_entity(&mut self, m: &Matched) -> Option<Value> {
        let place = |name: &str| m.span(name);
        match m.form {
            "components" => {
                let numbers: Vec<(Quantity, Span)> = ["x", "y", "z"]
                    .iter()
                    .filter_map(|n| match m.get(n) {
                        Some(f) => match f.typed {
                            Typed::Quantity(q) => Some((q, f.span)),
                            _ => None,
                        },
                        None => None,
                    })
                    .collect();
                Some(self.vector(&numbers))
            }
            "points" => {
                let (a, b) = (m.vector("point")?, m.vector("to")?);
                Some(self.binary(
                    BinaryOp::Subtract,
                    m.word,
                    (Value::Vector(b), place("to")),
                    (Value::Vector(a), place("point")),
                ))
            }
            "vector" => Some(Value::Vector(m.vector("vector")?)),
            "times" => {
                let Some(Typed::Quantity(k)) = m.get("factor").map(|f| f.typed.clone()) else { return None };
                let v = (Value::Vector(m.vector("vector")?), place("vector"));
                Some(self.binary(BinaryOp::Multiply, m.word, (Value::Number(k), place("factor")), v))
            }
            "polar" => {
                let (sin, cos) = math::sin_cos(radians(m.number("angle")?));
                let r = m.number("size")?;
                Some(Value::Vector(Vector { v: [r * cos, r * sin, 0.0], dim: Dim::LENGTH }))
            }
            form => self.vector_function(m, form),
        }
    }

    fn vector_function(&mut self, m: &Matched, form: &str) -> Option<Value> {
        let name = if form == "cross" { "CROSS" } else { "UNIT" };
        let function = crate::vocab::find_function(name)?;
        let mut arguments = vec![(Value::Vector(m.vector("vector")?), m.span("vector"))];
        if let Some(second) = m.vector("second") {
            arguments.push((Value::Vector(second), m.span("second")));
        }
        self.function_value(function, &arguments, m.word)
    }

    /// `LINE/ …`.
    pub(super) fn line(&mut self, m: &Matched, name: &str) -> Option<Value> {
        let (from, to) = self.line_points(m)?;
        let Some(segment) = Segment::new(from, to) else {
            let at = if m.form == "points" { m.span("to") } else { m.word };
            return self
                .fail_geometry(at, "a line goes through two different points, and these are the same");
        };
        let curve = self.add_curve(name, Arc::new(segment));
        let line = LineValue { from: [from.x, from.y], to: [to.x, to.y], curve };
        Some(Value::Entity(Entity::Line(Rc::new(line))))
    }

    fn line_points(&mut self, m: &Matched) -> Option<(Point2, Point2)> {
        let along = |p: Point2, u: Vec2| Some((p, p + u));
        match m.form {
            "coordinates" => Some((
                Point2::new(m.number("x1")?, m.number("y1")?),
                Point2::new(m.number("x2")?, m.number("y2")?),
            )),
            "points" => Some((Self::xy(m, "point")?, Self::xy(m, "to")?)),
            "angle" => {
                let base = Self::ray(m, "line").map_or(0.0, |r| math::atan2(r.u.y, r.u.x));
                along(Self::xy(m, "point")?, direction(base + radians(m.number("angle")?)))
            }
            "tangent" => self.tangent(m),
            "tangents" => self.tangents(m),
            "parallel" => {
                let ray = Self::ray(m, "line")?;
                let d = m.number("distance")?;
                let side = self.sided(m, "which", ray)?;
                along(ray.p + side * d, ray.u)
            }
            "parallel through" => along(Self::xy(m, "point")?, Self::ray(m, "line")?.u),
            "perpendicular" => along(Self::xy(m, "point")?, left(Self::ray(m, "line")?.u)),
            _ => {
                let u =
                    if m.word("axis") == Some("YAXIS") { Vec2::new(0.0, 1.0) } else { Vec2::new(1.0, 0.0) };
                along(Point2::origin(), u)
            }
        }
    }

    /// The unit normal of a line towards `XLARGE` and the like.
    fn sided(&mut self, m: &Matched, name: &str, ray: Ray) -> Option<Vec2> {
        let word = m.word(name)?;
        let n = left(ray.u);
        let component = if word.starts_with('X') { n.x } else { n.y };
        if component.abs() < TOUCH {
            let other = if word.starts_with('X') { "YLARGE or YSMALL" } else { "XLARGE or XSMALL" };
            let at = m.span(name);
            let problem = self
                .impossible(at, format!("{word} does not decide: the line runs along that axis"))
                .help(format!("use {other}"));
            self.report(problem);
            return None;
        }
        let positive = word.ends_with("LARGE");
        Some(if (component > 0.0) == positive { n } else { -n })
    }

    fn tangent(&mut self, m: &Matched) -> Option<(Point2, Point2)> {
        let (p, c) = (Self::xy(m, "point")?, Self::disc(m, "circle")?);
        let centre = Point2::new(c.centre[0], c.centre[1]);
        let to = centre - p;
        let distance = hypot(to.x, to.y);
        if distance < c.radius * (1.0 - TOUCH) {
            let message = format!(
                "the point lies inside the circle, {} from its centre, and no tangent goes through it",
                self.show_length(distance)
            );
            return self.fail_geometry(m.span("point"), message);
        }
        // The circle's centre lies on the left of the line when the circle is asked for on the right of its centre.
        let swing = math::asin((c.radius / distance).min(1.0));
        let sign = if m.word("side") == Some("LEFT") { 1.0 } else { -1.0 };
        let u = direction(math::atan2(to.y, to.x) + sign * swing);
        let length = to.dot(&u).max(c.radius);
        Some((p, p + u * length))
    }

    /// Tangent to two circles; the line runs from the first to the second, and touches each on the side said.
    fn tangents(&mut self, m: &Matched) -> Option<(Point2, Point2)> {
        let (a, b) = (Self::disc(m, "circle")?, Self::disc(m, "second")?);
        let sign = |name: &str| if m.word(name) == Some("LEFT") { 1.0 } else { -1.0 };
        let (ra, rb) = (sign("side") * a.radius, sign("second side") * b.radius);
        let (pa, pb) = (Point2::new(a.centre[0], a.centre[1]), Point2::new(b.centre[0], b.centre[1]));
        let d = pb - pa;
        let distance = hypot(d.x, d.y);
        let sine = (ra - rb) / distance;
        if distance == 0.0 || sine.abs() > 1.0 {
            return self.fail_geometry(
                m.word,
                "the circles have no such common tangent: one lies too far inside the other",
            );
        }
        // The touching points lie at signed distances ra, rb to the left of the centres.
        let u = direction(math::atan2(d.y, d.x) - math::asin(sine));
        Some((pa + left(u) * ra, pb + left(u) * rb))
    }

    /// `CIRCLE/ …`.
    pub(super) fn circle(&mut self, m: &Matched, name: &str) -> Option<Value> {
        let (centre, radius) = self.circle_data(m)?;
        let c = Point2::new(centre[0], centre[1]);
        let Some(arc) = CircularArc::circle(c, radius, 0.0, true) else {
            return self.fail_geometry(m.word, "the circle would have no radius");
        };
        let curve = self.add_curve(name, Arc::new(arc));
        Some(Value::Entity(Entity::Circle(Rc::new(CircleValue { centre, radius, curve }))))
    }

    fn circle_data(&mut self, m: &Matched) -> Option<([f64; 3], f64)> {
        match m.form {
            "coordinates" | "coordinates in space" => {
                Some(([m.number("x")?, m.number("y")?, m.number("z").unwrap_or(0.0)], m.number("r")?))
            }
            "three points" => self.through_three(m),
            "center radius" => Some((m.vector("point")?.v, m.number("r")?)),
            "center line" => {
                let (p, ray) = (Self::xy(m, "point")?, Self::ray(m, "line")?);
                Some((m.vector("point")?.v, cross(ray.u, p - ray.p).abs()))
            }
            "center circle" => {
                let (p, c) = (Self::xy(m, "point")?, Self::disc(m, "circle")?);
                let distance = (p - Point2::new(c.centre[0], c.centre[1])).norm();
                let large = m.word("size") == Some("LARGE");
                let radius = if large { distance + c.radius } else { (distance - c.radius).abs() };
                Some((m.vector("point")?.v, radius))
            }
            "center point" => {
                let (p, q) = (Self::xy(m, "point")?, Self::xy(m, "through")?);
                Some((m.vector("point")?.v, (q - p).norm()))
            }
            _ => self.between_lines(m),
        }
    }

    fn through_three(&mut self, m: &Matched) -> Option<([f64; 3], f64)> {
        let points = (Self::xy(m, "point")?, Self::xy(m, "second")?, Self::xy(m, "third")?);
        match CircularArc::through(points.0, points.1, points.2) {
            Some(arc) => Some(([arc.centre().x, arc.centre().y, m.vector("point")?.v[2]], arc.radius())),
            None => {
                self.fail_geometry(m.word, "the three points lie on a line, and no circle goes through them")
            }
        }
    }

    fn between_lines(&mut self, m: &Matched) -> Option<([f64; 3], f64)> {
        let (a, b, r) = (Self::ray(m, "line")?, Self::ray(m, "second")?, m.number("r")?);
        let (na, nb) = (self.sided(m, "which", a)?, self.sided(m, "second which", b)?);
        let (a, b) = (Ray { p: a.p + na * r, u: a.u }, Ray { p: b.p + nb * r, u: b.u });
        match meet(a, b) {
            Some(p) => Some(([p.x, p.y, 0.0], r)),
            None => self
                .fail_geometry(m.word, "the two lines are parallel: no one circle of this radius is meant"),
        }
    }

    /// `BEZIER/ …`.
    pub(super) fn bezier(&mut self, m: &Matched, name: &str) -> Option<Value> {
        let points: Vec<Point2> = m
            .all("control point")
            .filter_map(|f| match f.typed {
                Typed::Vector(v) => Some(Point2::new(v.v[0], v.v[1])),
                _ => None,
            })
            .collect();
        let count = points.len();
        let curve: Option<CurveRef> = if m.word("chain").is_some() {
            if count % 3 != 1 {
                let message = format!("a chain of cubics has 3 m + 1 control points, and these are {count}");
                self.report(Diagnostic::new(&semantics::OUT_OF_RANGE, m.span("chain"), message));
                return None;
            }
            bezier_chain(&points).ok().map(|c| Arc::new(c) as CurveRef)
        } else {
            Bezier::new(points).map(|b| Arc::new(b) as CurveRef)
        };
        match curve {
            Some(curve) => Some(Value::Entity(Entity::Curve(self.add_curve(name, curve)))),
            None => {
                self.fail_geometry(m.word, "all control points are the same, or there are too many of them")
            }
        }
    }

    fn add_curve(&mut self, name: &str, curve: CurveRef) -> Handle<CurveEntity> {
        let origin = self.origin(self.here);
        self.program.curves.push(CurveEntity { name: name.to_owned(), curve, origin })
    }
}

fn ray_of(line: &LineValue) -> Ray {
    let d = Vec2::new(line.to[0] - line.from[0], line.to[1] - line.from[1]);
    Ray { p: Point2::new(line.from[0], line.from[1]), u: d / hypot(d.x, d.y) }
}

fn direction(angle: f64) -> Vec2 {
    let (sin, cos) = math::sin_cos(angle);
    Vec2::new(cos, sin)
}

fn meet(a: Ray, b: Ray) -> Option<Point2> {
    let determinant = cross(a.u, b.u);
    (determinant.abs() > TOUCH).then(|| a.p + a.u * (cross(b.p - a.p, b.u) / determinant))
}

fn line_circle(ray: Ray, circle: &CircleValue) -> Vec<Point2> {
    let centre = Point2::new(circle.centre[0], circle.centre[1]);
    let foot = ray.p + ray.u * (centre - ray.p).dot(&ray.u);
    let distance = (foot - centre).norm();
    let scale = circle.radius * TOUCH;
    if distance > circle.radius + scale {
        return Vec::new();
    }
    let half = (circle.radius * circle.radius - distance * distance).max(0.0).sqrt();
    if half <= scale { vec![foot] } else { vec![foot - ray.u * half, foot + ray.u * half] }
}

fn circle_circle(a: &CircleValue, b: &CircleValue) -> Vec<Point2> {
    let (pa, pb) = (Point2::new(a.centre[0], a.centre[1]), Point2::new(b.centre[0], b.centre[1]));
    let d = pb - pa;
    let distance = hypot(d.x, d.y);
    if distance == 0.0 {
        return Vec::new();
    }
    let u = d / distance;
    let along = (distance * distance + a.radius * a.radius - b.radius * b.radius) / (2.0 * distance);
    // The common chord, cut with the first circle.
    line_circle(Ray { p: pa + u * along, u: left(u) }, a)
}

/// The point that the modifier means; `None` when it does not decide.
fn pick(points: &[Point2], word: &str) -> Option<Point2> {
    let key = |p: &Point2| if word.starts_with('X') { p.x } else { p.y };
    let (first, second) = (points.first()?, points.get(1));
    let Some(second) = second else { return Some(*first) };
    let (a, b) = (key(first), key(second));
    if (a - b).abs() <= TOUCH * (second - first).norm() {
        return None;
    }
    let larger = word.ends_with("LARGE");
    Some(if (a > b) == larger { *first } else { *second })
}
