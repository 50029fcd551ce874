//! Material that must not be touched: walls of the finished part, and stock in the way of rapids.

use std::sync::Arc;

use rayon::prelude::*;

use super::clearance::{Clearance, nearest_to_origin};
use super::finding::{Finding, Text};
use super::path::Primitive;
use super::rail::Rail;
use super::{ACCURACY, Case, Placed};
use crate::cl::{Guard, Operation};
use crate::diag::codes::{planning, verification as codes};
use crate::geom::curve::{CurveRef, PlanarCurve};

/// The rails of all exact curves of a program, each made once. A curve is known by its address.
pub(super) struct Rails<'a> {
    rails: Vec<(usize, Rail<'a>)>,
}

fn address(curve: &CurveRef) -> usize {
    Arc::as_ptr(curve).cast::<()>().addr()
}

impl<'a> Rails<'a> {
    pub(super) fn new(case: &Case<'a>) -> Self {
        let walls = case.cl.operations.iter().flat_map(|o| o.guard.walls.iter().map(|w| &w.centre));
        let mut curves: Vec<(usize, &'a dyn PlanarCurve)> = case
            .target
            .pieces
            .iter()
            .map(|p| &p.curve)
            .chain(walls)
            .map(|c| (address(c), c.as_ref()))
            .collect();
        curves.sort_by_key(|(address, _)| *address);
        curves.dedup_by_key(|(address, _)| *address);
        Rails { rails: curves.into_par_iter().map(|(address, curve)| (address, Rail::new(curve))).collect() }
    }

    /// The rail of a curve that the program refers to.
    pub(super) fn of(&self, curve: &CurveRef) -> Option<&Rail<'a>> {
        let wanted = address(curve);
        let at = self.rails.binary_search_by_key(&wanted, |(address, _)| *address).ok()?;
        self.rails.get(at).map(|(_, rail)| rail)
    }
}

/// The guards of all operations.
pub(super) struct Guards<'a, 'r> {
    case: &'a Case<'a>,
    rails: &'r Rails<'a>,
}

impl<'a, 'r> Guards<'a, 'r> {
    pub(super) fn new(case: &'a Case<'a>, rails: &'r Rails<'a>) -> Self {
        Guards { case, rails }
    }

    /// Checks a move against its operation's guard; before the first operation, against the first one's.
    pub(super) fn check(&self, placed: &Placed<'_>) -> Vec<Finding> {
        let context = self.case.context(placed.block);
        let operation = self.case.cl.operations.get(context.operation.unwrap_or(0));
        let Some(operation) = operation else { return Vec::new() };
        let guard = &operation.guard;
        let (a, b) = placed.cut.z;
        let lowest = if placed.cut.known[2] { a.min(b) } else { b };
        if lowest >= guard.top - ACCURACY {
            return Vec::new();
        }
        if placed.cut.parked {
            return Vec::new();
        }
        if !placed.cut.known[2] {
            return self.dive(placed).into_iter().collect();
        }
        let primitives = Primitive::of(&placed.cut.path);
        let mut found: Vec<Finding> = self.walls(operation, placed, &primitives).into_iter().collect();
        if placed.cut.rapid {
            found.extend(self.rapid(guard, placed, &primitives));
        }
        found
    }

    /// A rapid from an unknown height down to below the part's top: nobody knows what is on the way.
    fn dive(&self, placed: &Placed<'_>) -> Option<Finding> {
        placed.cut.rapid.then(|| {
            let text = Text::default()
                .words("a rapid goes down to Z ")
                .length(placed.cut.z.1)
                .words(", below the part's top, from a place that is not known");
            self.blocked(placed, text)
        })
    }

    /// No move below the part's top is deeper in a wall than the operation may cut.
    fn walls(&self, operation: &Operation, placed: &Placed<'_>, primitives: &[Primitive]) -> Option<Finding> {
        let floor = -operation.band.into - ACCURACY;
        let deepest = operation
            .guard
            .walls
            .iter()
            .filter_map(|wall| {
                self.rails.of(&wall.centre).map(|rail| Clearance { rail, part: wall.part, floor })
            })
            .filter(|clearance| !clearance.rail.degenerate)
            .flat_map(|clearance| primitives.iter().filter_map(move |p| clearance.gouge(p)))
            .min_by(|a, b| a.clearance.total_cmp(&b.clearance))?;
        let text = Text::default()
            .words(if placed.cut.rapid { "a rapid goes " } else { "the cutter goes " })
            .length(-deepest.clearance)
            .words(" into the finished wall at ")
            .point(deepest.at.x, deepest.at.y)
            .words(format!("; {} may go ", operation.name))
            .length(operation.band.into);
        let code = if self.case.is_written(placed.block) { &planning::MOVE_CUTS_PART } else { &codes::GOUGE };
        Some(Finding::new(code, placed.line, placed.block, text))
    }

    /// Below the part's top a rapid may go straight up, straight down where the cutter has been as deep before, or
    /// beside the blank.
    fn rapid(&self, guard: &Guard, placed: &Placed<'_>, primitives: &[Primitive]) -> Option<Finding> {
        if guard.clearing.is_some() {
            // What is left of the blank is known there: `surface::clearing` looks at all of it.
            return None;
        }
        let cut = placed.cut;
        let in_plane = primitives.iter().any(|p| p.bounds()[0] > 0.0);
        if !in_plane && cut.z.1 >= cut.z.0 {
            return None;
        }
        if !in_plane && self.been_as_deep(placed) {
            return None;
        }
        let text = Text::default();
        let Some(blank) = guard.blank_radius else {
            return Some(self.blocked(
                placed,
                text.words(
                    "a rapid below the part's top, and no round blank is declared that it could be clear of",
                ),
            ));
        };
        let clear = blank + self.cutter_radius(placed);
        let nearest = primitives.iter().map(nearest_to_origin).fold(f64::INFINITY, f64::min);
        (nearest < clear - ACCURACY).then(|| {
            let text = text
                .words("a rapid at Z ")
                .length(cut.z.0.min(cut.z.1))
                .words(" comes to ")
                .length(nearest)
                .words(" from the axis of the blank; blank and cutter reach to ")
                .length(clear);
            self.blocked(placed, text)
        })
    }

    /// A rapid that the program itself asks for is the program's mistake.
    fn blocked(&self, placed: &Placed<'_>, text: Text) -> Finding {
        let code = if self.case.is_written(placed.block) {
            &planning::RAPID_THROUGH_STOCK
        } else {
            &codes::RAPID_IN_STOCK
        };
        Finding::new(code, placed.line, placed.block, text)
    }

    /// Whether the cutter stood at this place of the plane, as deep or deeper, before this line.
    fn been_as_deep(&self, placed: &Placed<'_>) -> bool {
        let end = placed.cut.end();
        self.case.moves.iter().take(placed.index).rev().any(|p| {
            let q = p.cut.end();
            !p.cut.rapid && (q.xy() - end.xy()).norm() <= ACCURACY && q.z <= end.z + ACCURACY
        })
    }

    fn cutter_radius(&self, placed: &Placed<'_>) -> f64 {
        let tool = self.case.context(placed.block).tool;
        tool.and_then(|t| self.case.target.tools.get(t as usize)).map_or(0.0, |t| t.diameter / 2.0)
    }
}
