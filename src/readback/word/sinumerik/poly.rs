//! `POLY`: polynomials of up to the fifth degree, over one another where a denominator is said.

use super::super::block::Block;
use super::super::machine::Machine;
use super::super::motion::{ROTARY, Target};
use crate::geom::Point2;
use crate::readback::out::Out;
use crate::readback::polynomial::{bernstein, bezier};
use crate::readback::{Follow, TracePath};

/// Highest degree.
pub(super) const DEGREE: usize = 5;
/// Shortest and longest parameter interval.
const INTERVALS: core::ops::RangeInclusive<f64> = 0.0001..=99_999.999_9;

/// The `PO` words of a block.
#[derive(Debug, Clone, Default)]
pub(in crate::readback) struct Polynomials {
    /// Coefficients of the second to the fifth power for X, Y and Z; their ends are axis words.
    pub axes: [Option<Vec<f64>>; 3],
    /// End and coefficients of the denominator.
    pub denominator: Option<Vec<f64>>,
}

impl Polynomials {
    /// Whether there is one.
    pub(in crate::readback::word) fn any(&self) -> bool {
        self.denominator.is_some() || self.axes.iter().any(Option::is_some)
    }
}

impl Machine<'_> {
    /// A block under POLY: axes without a polynomial go evenly.
    pub(in crate::readback::word) fn polynomial<S: Follow>(
        &mut self,
        block: &Block,
        axes: u32,
        used: &mut u32,
        out: &mut Out<'_, S>,
    ) {
        self.along(block, (axes, used), out, |machine, target, _| machine.polynomial_path(block, target));
    }

    fn polynomial_path(&self, block: &Block, target: &Target) -> Result<TracePath, String> {
        let from = self.departure(target);
        let words = block.words.as_ref();
        let told = words.and_then(|w| w.polynomials.as_deref());
        let Some(told) = told.filter(|p| p.any()) else {
            if target.moved[ROTARY] {
                return Err("the rotary axis under POLY is not followed by this reader".to_owned());
            }
            let place = |at: &[f64; 4]| self.in_part(at[0], at[1], at[ROTARY]);
            return Ok(TracePath::Line { from: place(&from), to: place(&target.to) });
        };
        if target.moved[ROTARY] || !self.state.known[..3].iter().all(|k| *k) {
            return Err("POLY with the rotary axis, or from a position that is not known".to_owned());
        }
        let interval = words.and_then(|w| w.interval).unwrap_or(1.0);
        if !INTERVALS.contains(&interval) {
            return Err(format!(
                "PL={interval}: an interval is {} to {} long",
                INTERVALS.start(),
                INTERVALS.end()
            ));
        }
        let below = told.denominator.as_deref().map_or_else(
            || vec![1.0],
            |given| {
                whole(
                    1.0,
                    given.first().copied().unwrap_or(1.0),
                    given.get(1..).unwrap_or_default(),
                    interval,
                )
            },
        );
        let end: f64 = below.iter().sum();
        let unit = self.unit();
        let mut above: Vec<Vec<f64>> = Vec::new();
        for (axis, given) in told.axes.iter().enumerate() {
            if !target.moved[axis] {
                // It stays where it is, whatever the denominator.
                above.push(below.iter().map(|b| b * from[axis]).collect());
                continue;
            }
            if given.is_none() && told.denominator.is_some() {
                return Err(
                    "an axis without PO under a denominator is not followed by this reader".to_owned()
                );
            }
            let given: Vec<f64> = given.iter().flatten().map(|a| a * unit).collect();
            above.push(whole(from[axis], target.to[axis] * end, &given, interval));
        }
        let degree = above.iter().chain([&below]).map(Vec::len).max().unwrap_or(2) - 1;
        let weights = bernstein(&below, degree);
        if !weights.iter().all(|w| *w > 0.0) {
            return Err("POLY with a denominator that may be 0 is not followed by this reader".to_owned());
        }
        let along: Vec<Vec<f64>> = above.iter().map(|c| bernstein(c, degree)).collect();
        let place = |(i, w): (usize, &f64)| {
            let at = |axis: usize| along.get(axis).and_then(|v| v.get(i)).copied().unwrap_or(0.0) / w;
            (self.in_part(at(0), at(1), from[ROTARY]), at(2))
        };
        let points: Vec<(Point2, f64)> = weights.iter().enumerate().map(place).collect();
        Ok(bezier(&points, weights))
    }
}

/// Coefficients over 0..1 of a polynomial from `start` to `end`, given those of the second power on over 0..`interval`: the
/// control makes the first one from the end.
fn whole(start: f64, end: f64, given: &[f64], interval: f64) -> Vec<f64> {
    let mut power = interval;
    let scaled: Vec<f64> = given
        .iter()
        .map(|a| {
            power *= interval;
            a * power
        })
        .collect();
    let first = end - start - scaled.iter().sum::<f64>();
    let mut all = vec![start, first];
    all.extend(scaled);
    all
}
