//! `CIRCLE/`.

use std::rc::Rc;
use std::sync::Arc;

use crate::geom::curve::CircularArc;
use crate::geom::{Point2, cross};

use super::Analyser;
use super::geometry::{Ray, TOUCH, circle_circle, line_circle, meet, pick};
use super::matched::Matched;
use super::value::{CircleValue, Entity, Value};

impl Analyser<'_> {
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
            "two lines" => self.between_lines(m),
            "three lines" => self.among_lines(m),
            "canonical" => self.canonical_circle(m),
            _ => self.touching(m),
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

    /// The circle that touches three lines, on the side said of each: nᵢ · c - r = nᵢ · pᵢ.
    fn among_lines(&mut self, m: &Matched) -> Option<([f64; 3], f64)> {
        let mut rows = [[0.0; 4]; 3];
        for (row, (line, which)) in
            rows.iter_mut().zip([("line", "which"), ("second", "second which"), ("third", "third which")])
        {
            let ray = Self::ray(m, line)?;
            let n = self.sided(m, which, ray)?;
            *row = [n.x, n.y, -1.0, n.dot(&ray.p.coords)];
        }
        let solution = cramer(&rows);
        match solution.filter(|s| s[2] > 0.0) {
            Some([x, y, r]) => Some(([x, y, 0.0], r)),
            None => self.fail_geometry(m.word, "no circle touches the three lines on these sides"),
        }
    }

    fn canonical_circle(&mut self, m: &Matched) -> Option<([f64; 3], f64)> {
        if m.number("i")? != 0.0 || m.number("j")? != 0.0 || m.number("k")? == 0.0 {
            return self.fail_geometry(
                m.span("i"),
                "the axis of a circle is (0, 0, 1): it lies parallel to the XY plane",
            );
        }
        Some(([m.number("x")?, m.number("y")?, m.number("z")?], m.number("r")?))
    }

    /// Circles of a given radius that touch two things: their centres are where the two loci meet.
    fn touching(&mut self, m: &Matched) -> Option<([f64; 3], f64)> {
        let r = m.number("r")?;
        let (which, first, second) = match m.form {
            "line and point" => {
                let (ray, p) = (Self::ray(m, "line")?, Self::xy(m, "point")?);
                // The point lies on one side of the line, and so does the centre.
                let side = if cross(ray.u, p - ray.p) >= 0.0 { 1.0 } else { -1.0 };
                let n = crate::geom::left(ray.u) * side;
                ("which", Locus::Line(Ray { p: ray.p + n * r, u: ray.u }), Locus::around(p, r))
            }
            "line and circle" => {
                let (ray, circle) = (Self::ray(m, "line")?, Self::disc(m, "circle")?);
                let n = self.sided(m, "which", ray)?;
                let line = Locus::Line(Ray { p: ray.p + n * r, u: ray.u });
                ("second which", line, Locus::touching(&circle, m.word("touch")?, r))
            }
            "two circles" => {
                let (a, b) = (Self::disc(m, "circle")?, Self::disc(m, "second")?);
                let first = Locus::touching(&a, m.word("touch")?, r);
                ("which", first, Locus::touching(&b, m.word("second touch")?, r))
            }
            _ => {
                let (p, q) = (Self::xy(m, "point")?, Self::xy(m, "second")?);
                ("which", Locus::around(p, r), Locus::around(q, r))
            }
        };
        let centres = first.meet(&second);
        if centres.is_empty() {
            let message = format!("no circle of radius {} touches both like this", self.show_length(r));
            return self.fail_geometry(m.word, message);
        }
        let word = m.word(which)?;
        match pick(&centres, word) {
            Some(c) => Some(([c.x, c.y, 0.0], r)),
            None => self.fail_geometry(
                m.span(which),
                format!("{word} does not decide: both centres are alike in it"),
            ),
        }
    }
}

/// Where the centre of a circle may lie.
enum Locus {
    Line(Ray),
    Circle(Point2, f64),
}

impl Locus {
    fn around(p: Point2, distance: f64) -> Locus {
        Locus::Circle(p, distance)
    }
    /// Centres of circles of radius `r` that touch `circle` from inside or outside.
    fn touching(circle: &CircleValue, how: &str, r: f64) -> Locus {
        let centre = Point2::new(circle.centre[0], circle.centre[1]);
        let distance = if how == "IN" { (circle.radius - r).abs() } else { circle.radius + r };
        Locus::Circle(centre, distance)
    }
    fn meet(&self, other: &Locus) -> Vec<Point2> {
        match (self, other) {
            (Locus::Line(a), Locus::Line(b)) => meet(*a, *b).into_iter().collect(),
            (Locus::Line(ray), Locus::Circle(c, r)) | (Locus::Circle(c, r), Locus::Line(ray)) => {
                line_circle(*ray, *c, *r)
            }
            (Locus::Circle(a, ra), Locus::Circle(b, rb)) => circle_circle((*a, *ra), (*b, *rb)),
        }
    }
}

/// Solves three equations a x + b y + c z = d by Cramer's rule; `None` when they do not fix one solution.
fn cramer(rows: &[[f64; 4]; 3]) -> Option<[f64; 3]> {
    let determinant = |columns: [usize; 3]| {
        let [a, b, c] = rows.map(|row| columns.map(|i| row[i]));
        a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    let whole = determinant([0, 1, 2]);
    (whole.abs() > TOUCH).then(|| {
        [determinant([3, 1, 2]) / whole, determinant([0, 3, 2]) / whole, determinant([0, 1, 3]) / whole]
    })
}
