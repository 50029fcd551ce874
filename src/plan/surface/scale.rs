//! Parameters of a net and its rim by their length in plan.

use crate::geom::Point2;
use crate::geom::surface::{Net, Rim};
use crate::math::count;

/// Places across and along at which the plan's width is measured.
const ACROSS: usize = 256;
const ALONG: u32 = 24;

/// The values of one parameter by the widest way up to them.
pub(super) struct Scale {
    range: (f64, f64),
    sums: Vec<f64>,
}

impl Scale {
    /// That of a parameter (0: u).
    pub(super) fn new(net: &Net, rim: &Rim, parameter: usize) -> Scale {
        let (first, last) = rim.range(net, parameter);
        let across = |k: usize| first + (last - first) * count(k) / count(ACROSS);
        let range = rim.range(net, 1 - parameter);
        let place = |k: usize, i: u32| -> Point2 {
            let along = range.0 + (range.1 - range.0) * f64::from(i) / f64::from(ALONG);
            rim.place(net, if parameter == 1 { [along, across(k)] } else { [across(k), along] })
        };
        let widest =
            |k: usize| (0..=ALONG).map(|i| (place(k + 1, i) - place(k, i)).norm()).fold(0.0, f64::max);
        let mut sums = vec![0.0];
        for k in 0..ACROSS {
            sums.push(sums[k] + widest(k));
        }
        Scale { range: (first, last), sums }
    }

    /// The whole width, mm.
    pub(super) fn width(&self) -> f64 {
        self.sums[ACROSS]
    }

    /// The parameter so far from the first one, mm.
    pub(super) fn value(&self, wanted: f64) -> f64 {
        let (first, last) = self.range;
        let across = |k: usize| first + (last - first) * count(k) / count(ACROSS);
        let k = self.sums.partition_point(|s| *s < wanted).clamp(1, ACROSS);
        let width = self.sums[k] - self.sums[k - 1];
        let share = if width > 0.0 { ((wanted - self.sums[k - 1]) / width).clamp(0.0, 1.0) } else { 0.0 };
        across(k - 1) + (across(k) - across(k - 1)) * share
    }
}
