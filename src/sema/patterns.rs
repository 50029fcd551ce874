//! `PATERN/`, and which of a pattern's points a motion takes.

use std::collections::BTreeSet;
use std::rc::Rc;

use crate::diag::Diagnostic;
use crate::diag::codes::semantics as codes;
use crate::source::Span;
use crate::units::{Dim, Quantity};

use super::functions::sin_cos_degrees;
use super::matched::{Found, Matched, Typed};
use super::transform::minus;
use super::value::{CircleValue, Entity, Value};
use super::{Analyser, limits};

/// One point on the way along a pattern.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stop {
    /// The point, mm.
    pub point: [f64; 3],
    /// How far the way to the next one is raised, mm.
    pub raised: Option<f64>,
}

impl Analyser<'_> {
    /// `PATERN/ …`.
    pub(super) fn pattern(&mut self, m: &Matched) -> Option<Value> {
        let points = match m.form {
            "from to" => {
                let (a, b) = (m.vector("point")?.v, m.vector("end")?.v);
                let last = m.number("count")? - 1.0;
                spread(m.number("count")?, |i| between(a, b, i / last))
            }
            "vector" => {
                let (a, v) = (m.vector("point")?.v, self.displacement(m)?);
                spread(m.number("count")?, |i| along(a, v, i))
            }
            "linear" => {
                let (a, u) = (m.vector("point")?.v, self.direction_of_rows(m)?);
                self.steps(m, Dim::LENGTH)?.into_iter().map(|s| along(a, u, s)).collect()
            }
            "arc" => {
                let circle = circle_of(m)?;
                let (from, sweep) = (m.number("start")?, sweep(m)?);
                let last = m.number("count")? - 1.0;
                spread(m.number("count")?, |i| on_circle(&circle, from + sweep * (i / last)))
            }
            "arc steps" => {
                let (circle, from) = (circle_of(m)?, m.number("start")?);
                let sign = if m.word("sense") == Some("CLW") { -1.0 } else { 1.0 };
                self.steps(m, Dim::ANGLE)?.into_iter().map(|s| on_circle(&circle, from + sign * s)).collect()
            }
            "random" => parts(m),
            _ => self.rows(m)?,
        };
        if points.len() > limits::PATTERN_POINTS {
            self.limit(format!("a pattern has more than {} points", limits::PATTERN_POINTS));
            return None;
        }
        self.charge(points.len()).then(|| Value::Entity(Entity::Pattern(points.into())))
    }

    /// The vector of equal steps, mm.
    fn displacement(&mut self, m: &Matched) -> Option<[f64; 3]> {
        let v = m.vector("vector")?;
        match v.land(Dim::LENGTH, self.unit()) {
            Some(landed) => {
                self.note_bare(v, m.span("vector"));
                Some(landed.v)
            }
            None => {
                let message =
                    format!("the steps of a pattern are lengths, and this is {}", v.show(self.unit()));
                self.report(Diagnostic::new(&codes::WRONG_DIMENSION, m.span("vector"), message));
                None
            }
        }
    }

    fn direction_of_rows(&mut self, m: &Matched) -> Option<[f64; 3]> {
        let v = m.vector("vector")?.v;
        match super::transform::unit(v) {
            Some(u) => Some(u),
            None => self.fail_geometry(m.span("vector"), "a vector of length 0 has no direction"),
        }
    }

    /// Parallel rows, to and fro.
    fn rows(&mut self, m: &Matched) -> Option<Vec<[f64; 3]>> {
        let base = pattern_of(m, "pattern")?;
        let shifts: Vec<[f64; 3]> = match m.form {
            "rows" => {
                let v = self.displacement(m)?;
                spread(m.number("count")?, |i| v.map(|x| x * i))
            }
            "row steps" => {
                let u = self.direction_of_rows(m)?;
                self.steps(m, Dim::LENGTH)?.into_iter().map(|s| u.map(|x| x * s)).collect()
            }
            _ => {
                let second = pattern_of(m, "second")?;
                let first = second.first().copied()?;
                second.iter().map(|p| minus(*p, first)).collect()
            }
        };
        if base.len().saturating_mul(shifts.len()) > limits::PATTERN_POINTS {
            self.limit(format!("a pattern has more than {} points", limits::PATTERN_POINTS));
            return None;
        }
        let mut points = Vec::with_capacity(base.len() * shifts.len());
        for (i, shift) in shifts.iter().enumerate() {
            let moved = base.iter().map(|p| along(*p, *shift, 1.0));
            if i % 2 == 0 { points.extend(moved) } else { points.extend(moved.rev()) }
        }
        Some(points)
    }

    /// `INCR, 1, 2` and `INCR, 3, AT, 1.5`, several times: distances of the points from the first one.
    fn steps(&mut self, m: &Matched, dim: Dim) -> Option<Vec<f64>> {
        let mut steps: Vec<f64> = Vec::new();
        let mut open: Vec<(Quantity, Span)> = Vec::new();
        for found in &m.found {
            match (&found.typed, found.name) {
                (Typed::Quantity(q), "increment") => open.push((*q, found.span)),
                (Typed::Word("INCR"), _) => steps.extend(self.distances(&core::mem::take(&mut open), dim)?),
                (Typed::Number(each), "each") => {
                    let count = self.repetitions(&core::mem::take(&mut open), found.span)?;
                    if steps.len() + count > limits::PATTERN_POINTS {
                        self.limit(format!("a pattern has more than {} points", limits::PATTERN_POINTS));
                        return None;
                    }
                    steps.extend(core::iter::repeat_n(*each, count));
                }
                _ => {}
            }
        }
        steps.extend(self.distances(&open, dim)?);
        let mut at = 0.0;
        let mut places = vec![0.0];
        places.extend(steps.into_iter().map(|s| {
            at += s;
            at
        }));
        Some(places)
    }

    fn distances(&mut self, open: &[(Quantity, Span)], dim: Dim) -> Option<Vec<f64>> {
        let mut distances = Vec::with_capacity(open.len());
        for &(q, span) in open {
            match self.land(q, dim, span) {
                Some(landed) => distances.push(landed.value),
                None => {
                    let message = format!(
                        "the increments of this pattern are {}s, and this is {}",
                        dim.name(),
                        self.show(q)
                    );
                    self.report(Diagnostic::new(&codes::WRONG_DIMENSION, span, message));
                    return None;
                }
            }
        }
        Some(distances)
    }

    /// The number before `AT`.
    fn repetitions(&mut self, open: &[(Quantity, Span)], at: Span) -> Option<usize> {
        let most = limits::PATTERN_POINTS;
        match open {
            [(q, _)]
                if q.is_bare()
                    && q.value.fract() == 0.0
                    && (1.0..=crate::math::count(most)).contains(&q.value) =>
            {
                Some(crate::math::ceil_to_usize(q.value))
            }
            _ => {
                let span = open.first().map_or(at, |(_, span)| *span);
                let message =
                    format!("before AT stands one whole number from 1 to {most}: how many increments");
                self.report(
                    Diagnostic::new(&codes::OUT_OF_RANGE, span, message).help("write `INCR, 3, AT, 1.5`"),
                );
                None
            }
        }
    }

    /// The points of `GOTO/ pattern, …` in the order of travel.
    pub(super) fn stops(&mut self, m: &Matched) -> Option<Vec<Stop>> {
        let points = pattern_of(m, "pattern")?;
        let inverse = m.word("order").is_some();
        let constant = m.word("count").is_some();
        let mut order: Vec<usize> = (0..points.len()).collect();
        if inverse {
            order.reverse();
        }
        // What a number in the statement stands for: a place in the order of travel, or in the pattern.
        let number_of = |place: usize, index: usize| if constant { index + 1 } else { place + 1 };
        let lists = self.lists(m, points.len())?;
        let mut stops = Vec::new();
        for (place, &index) in order.iter().enumerate() {
            let number = number_of(place, index);
            let kept =
                lists.retain.as_ref().is_none_or(|r| r.contains(&number)) && !lists.omit.contains(&number);
            if let (true, Some(&point)) = (kept, points.get(index)) {
                let raised = lists.avoid.contains(&number).then_some(lists.height);
                stops.push(Stop { point, raised });
            }
        }
        Some(stops)
    }

    fn lists(&mut self, m: &Matched, count: usize) -> Option<Lists> {
        let mut lists = Lists { height: m.number("height").unwrap_or(0.0), ..Lists::default() };
        let mut target = "";
        let mut thru = false;
        let mut last: Option<usize> = None;
        for found in &m.found {
            match found.typed {
                Typed::Word("THRU") => thru = true,
                Typed::Word(word) => {
                    (target, thru, last) = (word, false, None);
                    if word == "RETAIN" {
                        lists.retain.get_or_insert_with(BTreeSet::new);
                    }
                }
                Typed::Number(number) if found.name == "which" => {
                    let number = crate::math::ceil_to_usize(number);
                    if number > count {
                        return self.no_such_point(found, count);
                    }
                    let from = if thru { last.map_or(number, |l| l + 1) } else { number };
                    lists.of(target).extend(from..=number);
                    (thru, last) = (false, Some(number));
                }
                _ => {}
            }
        }
        Some(lists)
    }

    fn no_such_point<T>(&mut self, found: &Found, count: usize) -> Option<T> {
        let message = format!("the pattern has {count} points, and none with this number");
        self.report(Diagnostic::new(&codes::OUT_OF_RANGE, found.span, message));
        None
    }
}

/// Numbers of points by what is to be done with them.
#[derive(Default)]
struct Lists {
    omit: BTreeSet<usize>,
    retain: Option<BTreeSet<usize>>,
    avoid: BTreeSet<usize>,
    height: f64,
}

impl Lists {
    fn of(&mut self, word: &str) -> &mut BTreeSet<usize> {
        match word {
            "RETAIN" => self.retain.get_or_insert_with(BTreeSet::new),
            "AVOID" => &mut self.avoid,
            _ => &mut self.omit,
        }
    }
}

/// Points with the numbers 0, 1, … below `count`.
fn spread(count: f64, point: impl Fn(f64) -> [f64; 3]) -> Vec<[f64; 3]> {
    (0..crate::math::ceil_to_usize(count)).map(|i| point(crate::math::count(i))).collect()
}

fn along(p: [f64; 3], v: [f64; 3], k: f64) -> [f64; 3] {
    [p[0] + v[0] * k, p[1] + v[1] * k, p[2] + v[2] * k]
}

/// The point at fraction `t`; exactly the ends for 0 and 1.
fn between(a: [f64; 3], b: [f64; 3], t: f64) -> [f64; 3] {
    if t == 1.0 { b } else { along(a, minus(b, a), t) }
}

/// The signed angle in degrees from the first to the last point; a full circle when they are the same.
fn sweep(m: &Matched) -> Option<f64> {
    let turn = m.number("end angle")? - m.number("start")?;
    let positive = turn - 360.0 * (turn / 360.0).floor();
    Some(match m.word("sense") {
        Some("CLW") => positive - 360.0,
        _ if positive == 0.0 => 360.0,
        _ => positive,
    })
}

fn on_circle(circle: &CircleValue, degrees: f64) -> [f64; 3] {
    let (sin, cos) = sin_cos_degrees(degrees);
    [circle.centre[0] + circle.radius * cos, circle.centre[1] + circle.radius * sin, circle.centre[2]]
}

/// The points and patterns of `RANDOM`, one after the other.
fn parts(m: &Matched) -> Vec<[f64; 3]> {
    let mut points = Vec::new();
    for found in m.all("part") {
        match &found.typed {
            Typed::Vector(v) => points.push(v.v),
            Typed::Entity(Entity::Pattern(more)) if points.len() <= limits::PATTERN_POINTS => {
                points.extend(more.iter().copied());
            }
            _ => {}
        }
    }
    points
}

fn circle_of(m: &Matched) -> Option<CircleValue> {
    match m.entity("circle")? {
        Entity::Circle(circle) => Some(**circle),
        _ => None,
    }
}

/// The pattern in this slot.
pub(super) fn pattern_of(m: &Matched, name: &str) -> Option<Rc<[[f64; 3]]>> {
    match m.entity(name)? {
        Entity::Pattern(points) => Some(points.clone()),
        _ => None,
    }
}
