//! Integrals of smooth functions of one variable.

/// Positive nodes of the 15-point Kronrod rule on [−1, 1]; every second one is a node of the 7-point Gauss rule.
const NODES: [f64; 7] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_4,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_47,
];
/// Weights of the Kronrod rule, the last for the node 0.
const KRONROD: [f64; 8] = [
    0.022_935_322_010_529_224,
    0.063_092_092_629_978_55,
    0.104_790_010_322_250_18,
    0.140_653_259_715_525_92,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_4,
    0.204_432_940_075_298_9,
    0.209_482_141_084_727_83,
];
#[allow(clippy::excessive_precision, reason = "digits as tabulated")]
/// Weights of the Gauss rule, the last for the node 0.
const GAUSS: [f64; 4] =
    [0.129_484_966_168_869_7, 0.279_705_391_489_276_7, 0.381_830_050_505_118_93, 0.417_959_183_673_469_4];

/// ∫ f over [a, b] with an estimated error up to `accuracy` (of the integral itself), by halving intervals
/// until the Gauss and Kronrod rules agree.
///
/// The smallest useful accuracy is the integral's rounding. A function that is not smooth, or not finite, costs
/// no more than a fixed number of intervals; its integral is then as good as these make it.
pub(crate) fn integral(f: &impl Fn(f64) -> f64, a: f64, b: f64, accuracy: f64) -> f64 {
    const MOST_INTERVALS: usize = 4096;
    let mut open = vec![(a, b, accuracy)];
    let (mut sum, mut intervals) = (0.0, 0);
    while let Some((a, b, accuracy)) = open.pop() {
        intervals += 1;
        let (kronrod, gauss) = rules(f, a, b);
        let rounding = 8.0 * f64::EPSILON * kronrod.abs();
        let agree = (kronrod - gauss).abs() <= accuracy.max(rounding);
        if agree || intervals >= MOST_INTERVALS || !kronrod.is_finite() {
            sum += kronrod;
        } else {
            let mid = 0.5 * (a + b);
            open.extend([(mid, b, 0.5 * accuracy), (a, mid, 0.5 * accuracy)]);
        }
    }
    sum
}

/// The 15-point Kronrod and the 7-point Gauss value.
fn rules(f: &impl Fn(f64) -> f64, a: f64, b: f64) -> (f64, f64) {
    let (centre, half) = (0.5 * (a + b), 0.5 * (b - a));
    let middle = f(centre);
    let (mut kronrod, mut gauss) = (KRONROD[7] * middle, GAUSS[3] * middle);
    for (i, node) in NODES.iter().enumerate() {
        let pair = f(centre - half * node) + f(centre + half * node);
        kronrod += KRONROD[i] * pair;
        if i % 2 == 1 {
            gauss += GAUSS[i / 2] * pair;
        }
    }
    (kronrod * half, gauss * half)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{exp, sin};

    #[test]
    fn the_rules_integrate_polynomials_of_their_degrees() {
        for power in 0..=22 {
            let f = |x: f64| (0..power).fold(1.0, |p, _| p * x);
            let exact = 1.0 / f64::from(power + 1);
            let (kronrod, gauss) = rules(&f, 0.0, 1.0);
            assert!((kronrod - exact).abs() < 1e-15, "degree {power}");
            assert!(power > 13 || (gauss - exact).abs() < 1e-15, "degree {power}");
        }
    }

    #[test]
    fn functions_without_an_integral_end_too() {
        assert!(integral(&|_| f64::NAN, 0.0, 1.0, 1e-12).is_nan());
        let noise = |x: f64| sin(1e9 * x);
        assert!(integral(&noise, 0.0, 1.0, 1e-15).abs() < 1.0);
    }

    #[test]
    fn a_tighter_accuracy_gives_a_tighter_integral() {
        let f = |x: f64| exp(-50.0 * x * x) + sin(20.0 * x);
        let exact = integral(&f, -1.0, 2.0, 1e-15);
        let error = |accuracy| (integral(&f, -1.0, 2.0, accuracy) - exact).abs();
        assert!(error(1e-2) <= 1e-2 && error(1e-6) <= 1e-6 && error(1e-11) <= 1e-11);
        assert!(error(1e-11) <= error(1e-1));
    }
}
