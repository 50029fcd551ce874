//! `BEZIER/`, `SPLINE/`, `TABCYL/`.

use std::sync::Arc;

use crate::diag::Diagnostic;
use crate::diag::codes::semantics;
use crate::geom::curve::{Bezier, CurveRef, Ends, Spline, SplineError, bezier_chain};
use crate::geom::{Point2, Vec2};
use crate::source::Span;

use super::Analyser;
use super::geometry::direction;
use super::matched::{Matched, Typed};
use super::value::{Entity, Value};

/// A point of a spline, and the slope prescribed there.
struct Node {
    point: Point2,
    span: Span,
    slope: Option<(f64, Span)>,
}

impl Analyser<'_> {
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
        if !self.charge(count) {
            return None;
        }
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

    /// `SPLINE/ …`.
    pub(super) fn spline(&mut self, m: &Matched, name: &str) -> Option<Value> {
        let mut nodes = points_of(m);
        let closed = m.word("periodic").is_some();
        let ends = match (m.number("first angle"), m.number("last angle")) {
            (Some(_), Some(_)) if closed => {
                let message = "a closed spline has no ends whose direction could be given";
                self.report(Diagnostic::new(&semantics::WORDS_EXCLUDE, m.span("angles"), message));
                return None;
            }
            (Some(a), Some(b)) => Ends::Clamped(Some(direction(a)), Some(direction(b))),
            _ if closed => Ends::Periodic,
            _ => Ends::Natural,
        };
        let returns = nodes.len() > 1 && nodes.first().map(|n| n.point) == nodes.last().map(|n| n.point);
        if closed && returns {
            nodes.pop();
        }
        self.through(m, name, &nodes, ends)
    }

    /// `TABCYL/ NOZ, SPLINE, …`.
    pub(super) fn tabcyl(&mut self, m: &Matched, name: &str) -> Option<Value> {
        let nodes = self.tabcyl_nodes(m)?;
        let last = nodes.len().saturating_sub(1);
        for (i, node) in nodes.iter().enumerate() {
            if let Some((_, span)) = node.slope.filter(|_| i != 0 && i != last) {
                let message = "a SLOPE can be given at the first and at the last point only";
                self.report(Diagnostic::new(&semantics::NOT_YET, span, message));
                return None;
            }
        }
        let ahead = |i: usize, from: usize, to: usize| {
            let node = nodes.get(i)?;
            let (slope, _) = node.slope?;
            let travel = nodes.get(to)?.point.x - nodes.get(from)?.point.x;
            Some(Vec2::new(1.0, slope) * if travel < 0.0 { -1.0 } else { 1.0 })
        };
        let start = ahead(0, 0, 1);
        let end = if last > 0 { ahead(last, last - 1, last) } else { None };
        self.through(m, name, &nodes, Ends::Clamped(start, end))
    }

    fn tabcyl_nodes(&mut self, m: &Matched) -> Option<Vec<Node>> {
        let mut nodes: Vec<Node> = Vec::new();
        let mut x: Option<(f64, Span)> = None;
        for found in &m.found {
            match (&found.typed, found.name) {
                (Typed::Vector(v), _) => {
                    nodes.push(Node { point: Point2::new(v.v[0], v.v[1]), span: found.span, slope: None });
                }
                (Typed::Number(value), "coordinate") => match x.take() {
                    None => x = Some((*value, found.span)),
                    Some((x, span)) => nodes.push(Node { point: Point2::new(x, *value), span, slope: None }),
                },
                (Typed::Number(slope), "slope") => {
                    if let Some(node) = nodes.last_mut() {
                        node.slope = Some((*slope, found.span));
                    }
                }
                _ => {}
            }
        }
        if let Some((_, span)) = x {
            let message = "the coordinates of TABCYL stand in pairs, and this x has no y";
            self.report(Diagnostic::new(&semantics::MISSING_VALUE, span, message));
            return None;
        }
        Some(nodes)
    }

    fn through(&mut self, m: &Matched, name: &str, nodes: &[Node], ends: Ends) -> Option<Value> {
        let points: Vec<Point2> = nodes.iter().map(|n| n.point).collect();
        if !self.charge(points.len()) {
            return None;
        }
        match Spline::new(&points, ends) {
            Ok(spline) => {
                let curve: CurveRef = Arc::new(spline);
                Some(Value::Entity(Entity::Curve(self.add_curve(name, curve))))
            }
            Err(SplineError::TooFewPoints { have, need }) => {
                self.fail_geometry(m.word, format!("this curve needs {need} points at least, and has {have}"))
            }
            Err(SplineError::Coincident { index }) => {
                let at = nodes.get(index).map_or(m.word, |n| n.span);
                self.fail_geometry(at, "this point is the same as the one before it")
            }
            Err(SplineError::NoTangent) => self.fail_geometry(m.word, "an end has no direction"),
        }
    }
}

fn points_of(m: &Matched) -> Vec<Node> {
    m.all("point")
        .filter_map(|f| match f.typed {
            Typed::Vector(v) => Some(Node { point: Point2::new(v.v[0], v.v[1]), span: f.span, slope: None }),
            _ => None,
        })
        .collect()
}
