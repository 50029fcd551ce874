//! Where along a closed curve a depth is exceeded.

use super::super::room::Samples;
use crate::geom::curve::Frenet;
use crate::math::TAU;

/// An interval of a closed curve's parameter; `to` may lie past the domain's end by less than a turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Interval {
    pub from: f64,
    pub to: f64,
}

/// A function along a closed curve, sampled, with its zero-crossing sets.
pub(super) struct Level<'a> {
    samples: &'a Samples,
    /// The value at every sample.
    values: Vec<f64>,
}

/// Where a function is positive.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Positive {
    Nowhere,
    Everywhere,
    /// In order along the curve.
    Within(Vec<Interval>),
}

impl<'a> Level<'a> {
    pub fn new(samples: &'a Samples, value: impl Fn(&Frenet) -> f64) -> Level<'a> {
        let values = samples.points.iter().map(|(_, f)| value(f)).collect();
        Level { samples, values }
    }

    pub fn greatest(&self) -> f64 {
        self.values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
    }

    pub fn least(&self) -> f64 {
        self.values.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Where the function exceeds `threshold`; crossings by straight interpolation between samples.
    pub fn above(&self, threshold: f64) -> Positive {
        if self.least() > threshold {
            return Positive::Everywhere;
        }
        let mut ups = Vec::new();
        let mut downs = Vec::new();
        for (pair, values) in self.samples.points.windows(2).zip(self.values.windows(2)) {
            let (a, b) = (values[0] - threshold, values[1] - threshold);
            if (a > 0.0) != (b > 0.0) {
                let u = pair[0].0 + (pair[1].0 - pair[0].0) * a / (a - b);
                if b > 0.0 { ups.push(u) } else { downs.push(u) }
            }
        }
        self.pair(&ups, &downs)
    }

    fn pair(&self, ups: &[f64], downs: &[f64]) -> Positive {
        let turn = self.turn();
        let intervals: Vec<Interval> = ups
            .iter()
            .filter_map(|&from| {
                let next = downs.iter().copied().find(|d| *d >= from);
                let to = next.or_else(|| downs.first().map(|d| d + turn))?;
                Some(Interval { from, to })
            })
            .collect();
        if intervals.is_empty() { Positive::Nowhere } else { Positive::Within(intervals) }
    }

    /// Length of the domain.
    fn turn(&self) -> f64 {
        match (self.samples.points.first(), self.samples.points.last()) {
            (Some((a, _)), Some((b, _))) => b - a,
            _ => TAU,
        }
    }
}

impl Interval {
    /// Whether `other` lies within, on a closed curve of domain length `turn`.
    pub fn holds(&self, other: &Interval, turn: f64) -> bool {
        [-turn, 0.0, turn].iter().any(|shift| other.from + shift >= self.from && other.to + shift <= self.to)
    }
}
