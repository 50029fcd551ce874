//! Where the knots of a spline lie: at equal shares of a density along the curve.

/// Cumulative share of knots as a function of the station from the start of the spline, piecewise linear.
#[derive(Debug, Clone)]
pub(in crate::lower) struct Shares {
    /// Stations from 0 on, mm.
    pub stations: Vec<f64>,
    /// Shares up to them, from 0 on.
    pub sums: Vec<f64>,
}

impl Shares {
    /// All of it.
    pub fn total(&self) -> f64 {
        self.sums[self.sums.len() - 1]
    }

    /// Station at share x of the total.
    pub fn station(&self, x: f64) -> f64 {
        let want = x * self.total();
        let j = self.sums.partition_point(|v| *v <= want).clamp(1, self.sums.len() - 1);
        let (a, b) = (self.sums[j - 1], self.sums[j]);
        let f = if b > a { ((want - a) / (b - a)).min(1.0) } else { 0.0 };
        self.stations[j - 1] + f * (self.stations[j] - self.stations[j - 1])
    }

    /// The density multiplied by `factors` of `n` equal shares.
    pub fn scaled(&self, factors: &[f64]) -> Shares {
        let n = factors.len();
        let total = self.total();
        let mut stations = vec![self.stations[0]];
        let mut sums = vec![0.0];
        let pieces = 8 * n;
        for j in 1..=pieces {
            let x = j as f64 / pieces as f64;
            let middle = (j as f64 - 0.5) / pieces as f64 * n as f64;
            stations.push(self.station(x));
            sums.push(sums[j - 1] + smooth(factors, middle) * total / pieces as f64);
        }
        Shares { stations, sums }
    }
}

/// Linear interpolation of values given at the middles of unit intervals.
fn smooth(values: &[f64], x: f64) -> f64 {
    let y = (x - 0.5).clamp(0.0, values.len() as f64 - 1.0);
    let i = (y as usize).min(values.len().saturating_sub(2));
    let f = y - i as f64;
    values[i] * (1.0 - f) + values[(i + 1).min(values.len() - 1)] * f
}
