//! Curves travelled the other way.

use super::{CurveRef, Frenet, PlanarCurve, Shape, span_of};

/// The same curve travelled the other way, over the same domain: u becomes first + last − u.
#[derive(Debug, Clone)]
pub struct Reversed {
    base: CurveRef,
    breaks: Vec<f64>,
    sum: f64,
}

impl Reversed {
    /// `base` the other way.
    #[must_use]
    pub fn new(base: CurveRef) -> Reversed {
        let (first, last) = base.domain();
        let sum = first + last;
        let mut breaks: Vec<f64> = base.breaks().iter().rev().map(|b| sum - b).collect();
        if let [a, .., b] = breaks.as_mut_slice() {
            (*a, *b) = (first, last);
        }
        Reversed { base, breaks, sum }
    }
    /// The curve travelled its own way.
    #[must_use]
    pub fn base(&self) -> &CurveRef {
        &self.base
    }
    /// The base's index of this curve's span, and the other way round.
    fn mirrored(&self, span: usize) -> usize {
        (self.breaks.len() - 2).saturating_sub(span)
    }
}

impl PlanarCurve for Reversed {
    fn domain(&self) -> (f64, f64) {
        self.base.domain()
    }
    fn at(&self, u: f64) -> Frenet {
        self.at_in(span_of(&self.breaks, u), u)
    }
    fn at_in(&self, span: usize, u: f64) -> Frenet {
        let (a, b) = self.base.domain();
        self.base.at_in(self.mirrored(span), (self.sum - u).clamp(a, b)).reversed()
    }
    fn breaks(&self) -> &[f64] {
        &self.breaks
    }
    fn shape(&self, span: usize) -> Shape {
        match self.base.shape(self.mirrored(span)) {
            Shape::Arc { centre, radius, ccw } => Shape::Arc { centre, radius, ccw: !ccw },
            other => other,
        }
    }
    fn is_closed(&self) -> bool {
        self.base.is_closed()
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::geom::curve::ends;
    use crate::geom::curve::testing::{assert_frenet_matches_differences, egg};

    #[test]
    fn twice_reversed_is_the_same_curve() {
        let once: CurveRef = Arc::new(Reversed::new(egg()));
        let twice = Reversed::new(once.clone());
        for i in 0..=20 {
            let u = f64::from(i) / 20.0 * egg().domain().1;
            assert!((twice.at(u).p - egg().at(u).p).norm() < 1e-12);
        }
        assert_frenet_matches_differences(once.as_ref(), 1e-3);
        assert_eq!(ends(once.as_ref()).0, ends(egg().as_ref()).1);
    }
}
