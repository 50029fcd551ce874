//! Depth levels.

/// Tip heights from Z0 down to `-depth`, mm: equal steps of at most `step`, the last exactly `-depth`.
/// Without a step, one level.
pub(super) fn levels(depth: f64, step: Option<f64>) -> Vec<f64> {
    /// A depth that is a whole number of steps up to rounding takes that many.
    const ROUNDING: f64 = 1e-9;
    /// More levels than this are no plan.
    const MOST: f64 = 10_000.0;
    let wanted = step.filter(|s| *s > 0.0).map_or(1.0, |s| (depth / s - ROUNDING).ceil());
    let count = wanted.clamp(1.0, MOST) as u32;
    (1..=count).map(|i| if i == count { -depth } else { -depth * f64::from(i) / f64::from(count) }).collect()
}

#[cfg(test)]
mod tests {
    use super::levels;

    #[test]
    fn steps_are_equal_and_the_last_level_is_exact() {
        assert_eq!(levels(10.0, None), [-10.0]);
        assert_eq!(levels(10.0, Some(5.0)), [-5.0, -10.0]);
        assert_eq!(levels(10.0, Some(20.0)), [-10.0]);
        let three = levels(10.0, Some(4.0));
        assert_eq!(three.len(), 3);
        assert_eq!(three[2], -10.0);
        assert!((three[0] + 10.0 / 3.0).abs() < 1e-15);
        assert_eq!(levels(0.3, Some(0.1)).len(), 3);
    }
}
