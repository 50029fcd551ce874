//! Points, vectors, lines, and what geometry of the plane is made of.

use std::rc::Rc;
use std::sync::Arc;

use crate::arena::Handle;
use crate::diag::Diagnostic;
use crate::diag::codes::{geometry as codes, semantics};
use crate::geom::curve::{CurveRef, Segment};
use crate::geom::{Point2, Vec2, cross, left};
use crate::ir::CurveEntity;
use crate::math::{self, DEG, hypot};
use crate::source::Span;
use crate::syntax::ast::BinaryOp;
use crate::units::{Dim, Quantity};

use super::Analyser;
use super::functions::sin_cos_degrees;
use super::matched::{Matched, Typed};
use super::patterns::pattern_of;
use super::value::{CircleValue, Entity, LineValue, Value, Vector};

/// Relative size below which a determinant or distance counts as zero.
pub(super) const TOUCH: f64 = 1e-9;

/// A line as a point and a unit direction, mm.
#[derive(Clone, Copy)]
pub(super) struct Ray {
    pub(super) p: Point2,
    pub(super) u: Vec2,
}

impl Analyser<'_> {
    /// «This geometry does not exist».
    pub(super) fn impossible(&mut self, at: Span, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(&codes::UNDEFINED_GEOMETRY, at, message)
    }

    /// Reports geometry that does not exist.
    pub(super) fn fail_geometry<T>(&mut self, at: Span, message: impl Into<String>) -> Option<T> {
        let problem = self.impossible(at, message);
        self.report(problem);
        None
    }

    /// The x and y of a point.
    pub(super) fn xy(m: &Matched, name: &str) -> Option<Point2> {
        let v = m.vector(name)?.v;
        Some(Point2::new(v[0], v[1]))
    }

    /// A line.
    pub(super) fn ray(m: &Matched, name: &str) -> Option<Ray> {
        match m.entity(name)? {
            Entity::Line(line) => Some(ray_of(line)),
            _ => None,
        }
    }

    /// A circle.
    pub(super) fn disc(m: &Matched, name: &str) -> Option<CircleValue> {
        match m.entity(name)? {
            Entity::Circle(circle) => Some(**circle),
            _ => None,
        }
    }

    /// `POINT/ …`.
    pub(super) fn point(&mut self, m: &Matched) -> Option<Value> {
        let v = match m.form {
            "coordinates" | "canonical" => [m.number("x")?, m.number("y")?, m.number("z").unwrap_or(0.0)],
            "planes" => self.planes_meet(m)?,
            "of pattern" => self.point_of_pattern(m)?,
            "point" => m.vector("point")?.v,
            "lines" => self.lines_meet(m)?,
            "circles" => self.circle_meets(m)?,
            "center" => Self::disc(m, "circle")?.centre,
            "on circle" => {
                let c = Self::disc(m, "circle")?;
                let (sin, cos) = sin_cos_degrees(m.number("angle")?);
                [c.centre[0] + c.radius * cos, c.centre[1] + c.radius * sin, c.centre[2]]
            }
            _ => {
                let (sin, cos) = sin_cos_degrees(m.number("angle")?);
                let (a, b) = (m.number("r")? * cos, m.number("r")? * sin);
                match m.word("plane") {
                    Some("YZPLAN") => [0.0, a, b],
                    Some("ZXPLAN") => [b, 0.0, a],
                    _ => [a, b, 0.0],
                }
            }
        };
        Some(Value::Vector(Vector { v, dim: Dim::LENGTH }))
    }

    fn point_of_pattern(&mut self, m: &Matched) -> Option<[f64; 3]> {
        let points = pattern_of(m, "pattern")?;
        let number = crate::math::ceil_to_usize(m.number("which")?);
        let found = number.checked_sub(1).and_then(|i| points.get(i)).copied();
        if found.is_none() {
            let message = format!("the pattern has {} points, and none with this number", points.len());
            self.report(Diagnostic::new(&semantics::OUT_OF_RANGE, m.span("which"), message));
        }
        found
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
                line_circle(ray_of(line), centre_of(c), c.radius)
            }
            (Entity::Circle(a), Entity::Circle(b)) => {
                circle_circle((centre_of(a), a.radius), (centre_of(b), b.radius))
            }
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
                let (sin, cos) = sin_cos_degrees(m.number("angle")?);
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
            "coordinates" | "coordinates in space" => Some((
                Point2::new(m.number("x1")?, m.number("y1")?),
                Point2::new(m.number("x2")?, m.number("y2")?),
            )),
            "points" => Some((Self::xy(m, "point")?, Self::xy(m, "to")?)),
            "angle" => {
                let base = Self::ray(m, "line").map_or(0.0, |r| math::atan2(r.u.y, r.u.x) / DEG);
                along(Self::xy(m, "point")?, direction(base + m.number("angle")?))
            }
            "angle to axis" => {
                let base = if m.word("axis") == Some("YAXIS") { 90.0 } else { 0.0 };
                along(Self::xy(m, "point")?, direction(base + m.number("angle")?))
            }
            "slope" => along(Self::xy(m, "point")?, sloping(m.number("slope")?)),
            "angle intercept" | "angle intercept axis" => along(intercept(m)?, direction(m.number("angle")?)),
            "slope intercept" | "slope intercept axis" => along(intercept(m)?, sloping(m.number("slope")?)),
            "planes" => {
                let (p, d) = self.planes_line(m)?;
                along(Point2::new(p[0], p[1]), Vec2::new(d[0], d[1]).normalize())
            }
            "canonical" => self.canonical_line(m),
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
                let d = m.number("distance").unwrap_or(0.0);
                if m.word("axis") == Some("YAXIS") {
                    along(Point2::new(d, 0.0), Vec2::new(0.0, 1.0))
                } else {
                    along(Point2::new(0.0, d), Vec2::new(1.0, 0.0))
                }
            }
        }
    }

    /// a x + b y = d, directed with (a, b) on its right, as APT's canonical form is.
    fn canonical_line(&mut self, m: &Matched) -> Option<(Point2, Point2)> {
        let (a, b, c) = (m.number("a")?, m.number("b")?, m.number("c")?);
        let size = hypot(a, b);
        if c != 0.0 || size == 0.0 {
            let message = "a line stands along Z: c is 0, and a and b are not both 0";
            return self.fail_geometry(m.span(if c == 0.0 { "a" } else { "c" }), message);
        }
        let n = Vec2::new(a / size, b / size);
        let foot = Point2::from(n * (m.number("d")? / size));
        Some((foot, foot + left(n)))
    }

    /// The unit normal of a line towards `XLARGE` and the like.
    pub(super) fn sided(&mut self, m: &Matched, name: &str, ray: Ray) -> Option<Vec2> {
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
        let u = direction((math::atan2(to.y, to.x) + sign * swing) / DEG);
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
        let u = direction((math::atan2(d.y, d.x) - math::asin(sine)) / DEG);
        Some((pa + left(u) * ra, pb + left(u) * rb))
    }

    /// A curve of the program.
    pub(super) fn add_curve(&mut self, name: &str, curve: CurveRef) -> Handle<CurveEntity> {
        let origin = self.origin(self.here);
        self.program.curves.push(CurveEntity { name: name.to_owned(), curve, origin })
    }
}

/// The unit vector with this rise per run.
fn sloping(slope: f64) -> Vec2 {
    Vec2::new(1.0, slope).normalize()
}

/// The point of an axis, the Y axis if none is said.
fn intercept(m: &Matched) -> Option<Point2> {
    let at = m.number("intercept")?;
    Some(if m.word("axis") == Some("XAXIS") { Point2::new(at, 0.0) } else { Point2::new(0.0, at) })
}

fn centre_of(circle: &CircleValue) -> Point2 {
    Point2::new(circle.centre[0], circle.centre[1])
}

/// A line as a ray.
pub(super) fn ray_of(line: &LineValue) -> Ray {
    let d = Vec2::new(line.to[0] - line.from[0], line.to[1] - line.from[1]);
    Ray { p: Point2::new(line.from[0], line.from[1]), u: d / hypot(d.x, d.y) }
}

/// The unit vector at an angle in degrees.
pub(super) fn direction(degrees: f64) -> Vec2 {
    let (sin, cos) = sin_cos_degrees(degrees);
    Vec2::new(cos, sin)
}

/// Where two lines meet, unless they are parallel.
pub(super) fn meet(a: Ray, b: Ray) -> Option<Point2> {
    let determinant = cross(a.u, b.u);
    (determinant.abs() > TOUCH).then(|| a.p + a.u * (cross(b.p - a.p, b.u) / determinant))
}

/// Where a line meets a circle: no, one or two points.
pub(super) fn line_circle(ray: Ray, centre: Point2, radius: f64) -> Vec<Point2> {
    let foot = ray.p + ray.u * (centre - ray.p).dot(&ray.u);
    let distance = (foot - centre).norm();
    let scale = radius * TOUCH;
    if distance > radius + scale {
        return Vec::new();
    }
    let half = (radius * radius - distance * distance).max(0.0).sqrt();
    if half <= scale { vec![foot] } else { vec![foot - ray.u * half, foot + ray.u * half] }
}

/// Where two circles, each by centre and radius, meet: no, one or two points.
pub(super) fn circle_circle((a, ra): (Point2, f64), (b, rb): (Point2, f64)) -> Vec<Point2> {
    let d = b - a;
    let distance = hypot(d.x, d.y);
    if distance == 0.0 {
        return Vec::new();
    }
    let u = d / distance;
    let along = (distance * distance + ra * ra - rb * rb) / (2.0 * distance);
    // The common chord, cut with the first circle.
    line_circle(Ray { p: a + u * along, u: left(u) }, a, ra)
}

/// The point that the modifier means; `None` when it does not decide.
pub(super) fn pick(points: &[Point2], word: &str) -> Option<Point2> {
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
