//! R-theta moves: machine X is the radius, Y is 0, the rotary axis is the cutter's polar angle in the part.

use super::feed::PolarMove;
use crate::math::{DEG, hypot};
use crate::target::Grid;

/// Steps of a full turn.
pub(super) fn full_turn(grid: &Grid) -> i64 {
    // 360 · 10^decimals is exact.
    (360.0 / grid.rotary_step()).round() as i64
}

/// The multiple of a full turn nearest to `value`.
pub(super) fn nearest_turn(value: i64, grid: &Grid) -> i64 {
    let turn = full_turn(grid);
    (value + turn / 2).div_euclid(turn) * turn
}

/// The same, but no farther from 0 than `most`, where that is a full turn or more.
pub(super) fn nearest_turn_within(value: i64, most: i64, grid: &Grid) -> i64 {
    let turns = most / full_turn(grid) * full_turn(grid);
    nearest_turn(value, grid).clamp(-turns, turns)
}

/// What to add to the angles of a chain that starts at `start` and runs from `least` to `greatest`, so that it starts as near
/// as possible to `at` and no angle is farther from 0 than `most`: a table that has turned as far as its word counts turns
/// back. A chain that fits nowhere starts nearest to `at`.
pub(super) fn shift(start: i64, (least, greatest): (i64, i64), at: i64, most: i64, grid: &Grid) -> i64 {
    let turn = full_turn(grid);
    let (low, high) = (-(most + least).div_euclid(turn) * turn, (most - greatest).div_euclid(turn) * turn);
    let near = nearest_turn(at - start, grid);
    if low <= high { near.clamp(low, high) } else { near }
}

/// Length of the Archimedean spiral between two polar positions (radius and angle in steps), by Gauss-Legendre
/// quadrature of √(ρ² + (dρ/dθ)²); exact for circles and radial lines.
pub(super) fn spiral(from: [i64; 2], to: [i64; 2], grid: &Grid) -> PolarMove {
    let radius = [from[0], to[0]].map(|v| v as f64 * grid.linear_step());
    let degrees = (to[1] - from[1]) as f64 * grid.rotary_step();
    let sweep = (degrees * DEG).abs();
    let rise = radius[1] - radius[0];
    // Relative error is below 1e-12 for pieces of at most an eighth of a turn.
    let pieces = ((sweep / (crate::math::PI / 4.0)).ceil() as usize).clamp(1, 1 << 16);
    let width = 1.0 / pieces as f64;
    let length = (0..pieces)
        .map(|i| {
            let middle = (i as f64 + 0.5) * width;
            let part: f64 = GAUSS
                .iter()
                .map(|&(x, w)| w * hypot((radius[0] + rise * (middle + x * width / 2.0)) * sweep, rise))
                .sum();
            part * width / 2.0
        })
        .sum();
    PolarMove { length, linear: rise.abs(), rotary: degrees.abs() }
}

/// Nodes and weights of five-point Gauss-Legendre quadrature on [-1, 1].
const GAUSS: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::LengthUnit;

    fn grid() -> Grid {
        Grid {
            unit: LengthUnit::Millimetre,
            linear_decimals: 3,
            rotary_decimals: 3,
            centre_decimals: 3,
            feed_decimals: 1,
            feed_per_revolution_decimals: 3,
            inverse_time_decimals: 4,
            feed_scale: 1.0,
        }
    }

    #[test]
    fn circles_and_radial_lines_have_their_lengths() {
        let circle = spiral([10_000, 0], [10_000, 360_000], &grid());
        assert!((circle.length - 20.0 * crate::math::PI).abs() < 1e-11);
        let radial = spiral([10_000, 5_000], [12_000, 5_000], &grid());
        assert!((radial.length - 2.0).abs() < 1e-14);
    }
    #[test]
    fn a_spiral_from_the_centre_has_the_closed_form_length() {
        // ρ = a θ from 0 to one turn: L = a/2 (θ √(1+θ²) + asinh θ), a = 10 mm / 2π.
        let theta = crate::math::TAU;
        let closed =
            10.0 / theta / 2.0 * (theta * hypot(1.0, theta) + crate::math::ln(theta + hypot(1.0, theta)));
        let got = spiral([0, 0], [10_000, 360_000], &grid()).length;
        assert!((got - closed).abs() < 1e-6, "{got} {closed}");
    }
    #[test]
    fn turns_are_found_both_ways() {
        assert_eq!(nearest_turn(359_000, &grid()), 360_000);
        assert_eq!(nearest_turn(-181_000, &grid()), -360_000);
        assert_eq!(shift(350_000, (350_000, 710_000), 5_000, 99_999_999, &grid()), -360_000);
    }
    #[test]
    fn a_table_that_has_turned_as_far_as_its_word_counts_turns_back() {
        let grid = grid();
        let most = 99_999_999;
        let shift = |at| shift(1_000, (1_000, 361_000), at, most, &grid);
        assert_eq!(shift(99_361_000), 99_360_000);
        assert_eq!(shift(99_721_000), 99_360_000, "one turn back");
        assert_eq!(shift(-99_999_000), -99_720_000);
        let whole = |start, ends, at| super::shift(start, ends, at, 360_000, &grid);
        assert_eq!(whole(90_000, (90_000, 450_000), 90_000), -360_000);
        assert_eq!(whole(0, (0, 360_000), 360_000), 0);
        assert_eq!(whole(0, (-100_000, 900_000), 700_000), 720_000, "it fits nowhere");
        assert_eq!(nearest_turn_within(99_999_000, most, &grid), 99_720_000);
        assert_eq!(nearest_turn_within(350_000, 360_000, &grid), 360_000);
        assert_eq!(nearest_turn_within(350_000, 100_000, &grid), 0);
    }
}
