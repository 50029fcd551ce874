//! Parts of a curve, and closed curves with another start.

use std::sync::Arc;

use super::{Chain, CurveRef, Frenet, PlanarCurve, Shape, into_domain, span_of};

/// A piece of a curve between two parameters, in the base's own parameter.
#[derive(Debug, Clone)]
pub struct Part {
    base: CurveRef,
    breaks: Vec<f64>,
    /// The base's span in which this part starts.
    first_span: usize,
}

impl Part {
    /// From `from` to `to` (`from < to`), both within the base's domain; `None` when that is empty.
    #[must_use]
    pub fn new(base: CurveRef, from: f64, to: f64) -> Option<Part> {
        let (a, b) = base.domain();
        let (from, to) = (from.max(a), to.min(b));
        if from.partial_cmp(&to) != Some(core::cmp::Ordering::Less) {
            return None;
        }
        let inner = base.breaks().iter().copied().filter(|u| from < *u && *u < to);
        let breaks = [from].into_iter().chain(inner).chain([to]).collect();
        let first_span = span_of(base.breaks(), from);
        Some(Part { base, breaks, first_span })
    }
}

impl PlanarCurve for Part {
    fn domain(&self) -> (f64, f64) {
        (self.breaks[0], self.breaks[self.breaks.len() - 1])
    }
    fn at(&self, u: f64) -> Frenet {
        self.at_in(span_of(&self.breaks, u), u)
    }
    fn at_in(&self, span: usize, u: f64) -> Frenet {
        self.base.at_in(self.first_span + span, u)
    }
    fn breaks(&self) -> &[f64] {
        &self.breaks
    }
    fn shape(&self, span: usize) -> Shape {
        self.base.shape(self.first_span + span)
    }
    fn is_closed(&self) -> bool {
        self.base.is_closed() && self.domain() == self.base.domain()
    }
}

/// A closed curve started at parameter `u` (brought into the domain); an open curve is returned as it is.
///
/// The new parameter starts at 0.
#[must_use]
pub fn restarted(curve: &CurveRef, u: f64) -> CurveRef {
    let (a, b) = curve.domain();
    let u = into_domain(curve.as_ref(), u);
    let parts = (Part::new(curve.clone(), u, b), Part::new(curve.clone(), a, u));
    let (true, (Some(tail), Some(head))) = (curve.is_closed(), parts) else {
        return curve.clone();
    };
    let (first, last) = super::ends(curve.as_ref());
    let closing_error = crate::math::hypot(first.x - last.x, first.y - last.y);
    match Chain::new(vec![Arc::new(tail), Arc::new(head)], closing_error) {
        Ok(chain) => Arc::new(chain),
        Err(_) => curve.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::curve::ends;
    use crate::geom::curve::testing::{assert_frenet_matches_differences, egg};

    #[test]
    fn a_restarted_curve_is_the_same_loop_from_another_point() {
        let start = egg().at(1.7);
        let moved = restarted(&egg(), 1.7);
        assert!(moved.is_closed());
        assert_eq!(ends(moved.as_ref()).0, start.p);
        assert_frenet_matches_differences(moved.as_ref(), 1e-3);
        let (a, b) = egg().domain();
        assert!(((moved.domain().1 - moved.domain().0) - (b - a)).abs() < 1e-12);
    }

    #[test]
    fn a_part_keeps_the_parameter() {
        let part = Part::new(egg(), 0.5, 2.5).expect("not empty");
        assert_eq!(part.at(1.1), egg().at(1.1));
        assert!(!part.is_closed());
        assert!(Part::new(egg(), 2.0, 2.0).is_none());
    }
}
