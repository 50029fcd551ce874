//! First guesses: joints at equal shares of the cube root of the curvature's change.

use super::chain::{Chain, Hold, Joint, Member};
use super::optimise::natural_halves;
use super::stretch::Stretch;

/// Largest turning of one arc in a first guess, radians.
const MOST_TURN: f64 = 3.6;
/// Share of the mean density that counts everywhere, so that joints exist where the curvature stands still.
const FLOOR: f64 = 0.02;

/// Density of joints along a stretch: the cube root of the curvature's variation, smoothed over a window.
#[derive(Debug)]
pub(in crate::lower::fit) struct Density {
    /// Integral up to every sample.
    pub sums: Vec<f64>,
}

impl Density {
    /// Density with the variation smoothed over `window` mm to either side.
    pub fn new(stretch: &Stretch<'_>, window: f64) -> Density {
        let samples = &stretch.samples;
        let n = samples.len();
        let mut variation = vec![0.0; n];
        let mut turning = vec![0.0; n];
        for j in 1..n {
            variation[j] = variation[j - 1] + (samples[j].k - samples[j - 1].k).abs();
            let ds = samples[j].s - samples[j - 1].s;
            turning[j] = turning[j - 1] + 0.5 * ds * (samples[j].k.abs() + samples[j - 1].k.abs());
        }
        let seam = if stretch.closed { (samples[0].k - samples[n - 1].k).abs() } else { 0.0 };
        let lap = Lap { stretch, variation: &variation, seam };
        let density: Vec<f64> = samples
            .iter()
            .map(|q| {
                let (a, b) = lap.window(q.s, window);
                crate::math::cbrt((lap.at(b) - lap.at(a)).max(0.0) / (b - a).max(1e-300))
            })
            .collect();
        let mut sums = vec![0.0; n];
        for j in 1..n {
            let ds = samples[j].s - samples[j - 1].s;
            sums[j] = sums[j - 1] + 0.5 * ds * (density[j] + density[j - 1]);
        }
        let total = sums[n - 1].max(1e-9);
        for j in 0..n {
            let length = samples[j].s / stretch.length().max(1e-300);
            sums[j] += FLOOR * total * (length + turning[j] / turning[n - 1].max(1e-300));
        }
        Density { sums }
    }

    /// Total.
    pub fn total(&self) -> f64 {
        self.sums.last().copied().unwrap_or(0.0)
    }

    /// Share of the total up to (unwrapped) station `s`.
    pub fn share(&self, stretch: &Stretch<'_>, s: f64) -> f64 {
        let laps = if stretch.closed { (s / stretch.length()).floor() } else { 0.0 };
        let w = s - laps * stretch.length();
        let j = stretch.interval(stretch.wrap(w));
        let (a, b) = (&stretch.samples[j], &stretch.samples[j + 1]);
        let f = ((w - a.s) / (b.s - a.s)).clamp(0.0, 1.0);
        laps + (self.sums[j] + f * (self.sums[j + 1] - self.sums[j])) / self.total()
    }

    /// Station at share `x` of the total; closed stretches wrap.
    pub fn station(&self, stretch: &Stretch<'_>, x: f64) -> f64 {
        let laps = if stretch.closed { x.floor() } else { 0.0 };
        let want = (x - laps).clamp(0.0, 1.0) * self.total();
        let j = self.sums.partition_point(|v| *v <= want).clamp(1, self.sums.len() - 1);
        let (a, b) = (self.sums[j - 1], self.sums[j]);
        let f = if b > a { ((want - a) / (b - a)).min(1.0) } else { 0.0 };
        let (s0, s1) = (stretch.samples[j - 1].s, stretch.samples[j].s);
        s0 + f * (s1 - s0) + laps * stretch.length()
    }
}

/// Variation of curvature as a function of the station, over laps of a closed stretch.
struct Lap<'a> {
    stretch: &'a Stretch<'a>,
    variation: &'a [f64],
    seam: f64,
}

impl Lap<'_> {
    fn window(&self, s: f64, window: f64) -> (f64, f64) {
        if self.stretch.closed {
            (s - window, s + window)
        } else {
            ((s - window).max(0.0), (s + window).min(self.stretch.length()))
        }
    }

    fn at(&self, s: f64) -> f64 {
        let length = self.stretch.length();
        let laps = if self.stretch.closed { (s / length).floor() } else { 0.0 };
        let total = self.variation[self.variation.len() - 1] + self.seam;
        let w = (s - laps * length).clamp(0.0, length);
        let samples = &self.stretch.samples;
        let j = samples.partition_point(|q| q.s <= w).clamp(1, samples.len() - 1);
        let h = samples[j].s - samples[j - 1].s;
        let f = if h > 0.0 { (w - samples[j - 1].s) / h } else { 1.0 };
        laps * total + self.variation[j - 1] + f * (self.variation[j] - self.variation[j - 1])
    }
}

/// Fewest arcs a first guess needs for its turning.
pub(super) fn least(stretch: &Stretch<'_>) -> usize {
    let turning: f64 =
        stretch.samples.windows(2).map(|w| 0.5 * (w[1].s - w[0].s) * (w[0].k.abs() + w[1].k.abs())).sum();
    let by_turning = (turning / MOST_TURN).ceil() as usize;
    by_turning.max(if stretch.closed { 2 } else { 1 })
}

/// Chain of `n` arcs with joints on the middle of the band at equal shares of the density, shifted by `phase` arcs.
pub(super) fn spread(stretch: &Stretch<'_>, density: &Density, n: usize, phase: f64, middle: f64) -> Chain {
    let count = if stretch.closed { n } else { n + 1 };
    let joints = (0..count)
        .map(|j| {
            if stretch.closed {
                let s = density.station(stretch, (j as f64 + phase) / n as f64);
                return Joint::on(stretch, s, middle, Hold::Free);
            }
            let end = j == 0 || j == n;
            let x = if end { j as f64 } else { j as f64 + phase };
            let s = density.station(stretch, x / n as f64);
            Joint::on(stretch, s, middle, if end { Hold::Station } else { Hold::Free })
        })
        .collect();
    let mut chain = Chain { joints, members: vec![Member::Arc(0.0); n], closed: stretch.closed };
    natural_halves(&mut chain);
    chain
}
