//! Extreme values of smooth functions of one variable.

/// Where a smooth function is largest on [a, b], and its value there: `samples` equal steps, then golden
/// section between the neighbours of the best one, to the rounding of the argument.
///
/// A maximum between two samples that its neighbours outshine is missed: choose the step well below the
/// function's shortest wave.
pub(crate) fn maximum(f: impl Fn(f64) -> f64, a: f64, b: f64, samples: usize) -> (f64, f64) {
    let n = samples.max(2);
    let at = |i: usize| if i >= n { b } else { a + (b - a) * i as f64 / n as f64 };
    let mut best = (0, f(a));
    for i in 1..=n {
        let value = f(at(i));
        if value > best.1 {
            best = (i, value);
        }
    }
    let refined = golden(&f, at(best.0.saturating_sub(1)), at((best.0 + 1).min(n)));
    if refined.1 > best.1 { refined } else { (at(best.0), best.1) }
}

/// Golden-section search for a maximum on [a, b].
pub(crate) fn golden(f: impl Fn(f64) -> f64, a: f64, b: f64) -> (f64, f64) {
    /// 1/φ to the 48th is 1e-10: beyond that, values near a maximum differ by less than rounding.
    const STEPS: usize = 48;
    Section::about_maximum(f, (a, b), STEPS).best()
}

/// What golden section leaves of an interval: its ends and the two places within, with their values.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Section {
    pub ends: (f64, f64),
    pub inner: [(f64, f64); 2],
}

impl Section {
    /// Narrows an interval about a maximum of a function with one hill, by 1/φ a step.
    pub(crate) fn about_maximum(f: impl Fn(f64) -> f64, (a, b): (f64, f64), steps: usize) -> Section {
        const RATIO: f64 = 0.618_033_988_749_894_9;
        let (mut lo, mut hi) = (a, b);
        let (mut x, mut y) = (hi - RATIO * (hi - lo), lo + RATIO * (hi - lo));
        let (mut fx, mut fy) = (f(x), f(y));
        for _ in 0..steps {
            if fx >= fy {
                (hi, y, fy) = (y, x, fx);
                x = hi - RATIO * (hi - lo);
                fx = f(x);
            } else {
                (lo, x, fx) = (x, y, fy);
                y = lo + RATIO * (hi - lo);
                fy = f(y);
            }
        }
        Section { ends: (lo, hi), inner: [(x, fx), (y, fy)] }
    }

    /// The better of the places within, and its value.
    pub(crate) fn best(&self) -> (f64, f64) {
        let [x, y] = self.inner;
        if x.1 >= y.1 { x } else { y }
    }
}

/// A root of `f` in [a, b], at whose ends it has different signs (or is 0), by bisection to rounding.
pub(crate) fn root(f: impl Fn(f64) -> f64, a: f64, b: f64) -> f64 {
    const STEPS: usize = 60;
    let (mut lo, mut hi) = (a, b);
    let rising = f(a) <= 0.0 && f(b) >= 0.0;
    for _ in 0..STEPS {
        let mid = 0.5 * (lo + hi);
        if (f(mid) < 0.0) == rising {
            lo = mid;
        } else {
            hi = mid;
        }
    }
    0.5 * (lo + hi)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{PI, cos, sin};

    #[test]
    fn finds_inner_and_boundary_maxima() {
        let (x, y) = maximum(sin, 0.0, 3.0, 7);
        assert!((x - PI / 2.0).abs() < 1e-7 && (y - 1.0).abs() < 1e-15);
        assert_eq!(maximum(|x| x, 0.0, 3.0, 7), (3.0, 3.0));
        assert_eq!(maximum(|x| -x, 0.0, 3.0, 7).0, 0.0);
    }

    #[test]
    fn roots_are_found_to_rounding_in_both_directions() {
        assert!((root(cos, 0.0, 3.0) - PI / 2.0).abs() < 1e-15);
        assert!((root(|x| -cos(x), 0.0, 3.0) - PI / 2.0).abs() < 1e-15);
    }
}
