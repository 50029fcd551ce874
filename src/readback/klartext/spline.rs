//! `SPL`: cubic polynomials in a parameter that runs from 1 at the block's start to 0 at its end (an option of the iTNC 530).

use super::Reader;
use super::blocks::Asked;
use super::motion::ROTARY;
use crate::geom::Point2;
use crate::readback::Follow;
use crate::readback::out::Out;
use crate::readback::polynomial::{bernstein, bezier};

/// How far a spline may start from the end of the contour before it, mm.
const GAP: f64 = 0.001;
/// What of that is lost in arithmetic, mm.
const SLACK: f64 = 1e-9;
/// Degree of the polynomials.
const DEGREE: usize = 3;
/// Largest digits of a coefficient, and how many of them stand after the point.
const LARGEST: f64 = 9.999_999_99;
const DECIMALS: usize = 8;
/// Largest exponent of a coefficient.
const EXPONENT: i32 = 255;
const AXES: [&str; 3] = ["X", "Y", "Z"];

/// The `K` words of a block: for X, Y and Z those of the third, second and first power.
#[derive(Debug, Default, Clone)]
pub(super) struct Coefficients {
    axes: [[Option<f64>; DEGREE]; 3],
}

impl Coefficients {
    /// Takes a coefficient in; says what is wrong with its place in the block. `name` is `K3X` and the like.
    pub(super) fn put(&mut self, name: &str, value: f64) -> Result<(), String> {
        let (power, letter) = name.split_at(name.len().min(2));
        let axis = AXES.iter().position(|a| *a == letter);
        let place = ["K3", "K2", "K1"].iter().position(|p| *p == power);
        let slot = axis.zip(place).and_then(|(a, p)| Some((self.axes.get_mut(a)?, p)));
        let Some((axis, place)) = slot else { return Err(format!("{name} is no coefficient of X, Y or Z")) };
        let before = axis.iter().take(place).all(Option::is_some);
        let after = axis.iter().skip(place).all(Option::is_none);
        if let Some(slot) = axis.get_mut(place) {
            *slot = Some(value);
        }
        (before && after)
            .then_some(())
            .ok_or_else(|| format!("{name}: the coefficients of an axis stand in the order K3, K2, K1"))
    }
}

/// `-4.688E-002`, `2.5`; the exponent may stand behind a blank, then it is `more`.
///
/// # Errors
/// What the control does not take.
pub(super) fn coefficient(
    text: &str,
    more: Option<&str>,
    value_of: fn(&str) -> Option<f64>,
) -> Result<f64, String> {
    let (digits, exponent) = match (text.split_once('E'), more) {
        (Some((digits, exponent)), _) => (digits, Some(exponent)),
        (None, more) => (text, more),
    };
    let bad = || format!("{text} is no coefficient of a spline");
    let value = value_of(digits).ok_or_else(bad)?;
    let decimals = digits.split_once('.').map_or(0, |(_, fraction)| fraction.len());
    if value.abs() > LARGEST || decimals > DECIMALS {
        return Err(format!(
            "{digits}: a coefficient has one digit before the point and {DECIMALS} after it, and an exponent where that is too small"
        ));
    }
    let power: i32 = exponent.map_or(Ok(0), str::parse).map_err(|_| bad())?;
    if power.abs() > EXPONENT {
        return Err(format!("E{power}: exponents go from -{EXPONENT} to {EXPONENT}"));
    }
    // The decimal number itself, not a product that is rounded twice.
    Ok(format!("{digits}e{power}").parse().unwrap_or(value))
}

impl Reader<'_> {
    /// `SPL`.
    pub(super) fn spline<S: Follow>(&mut self, asked: &Asked, out: &mut Out<'_, S>) {
        let to = self.target(asked, out);
        match self.spline_fault(asked) {
            Some(fault) => {
                out.fault(fault);
                return self.arrive(to, asked);
            }
            None if !self.feed_is_there(out) => return self.arrive(to, asked),
            None => {}
        }
        let from = self.state.position;
        let mut control = [[0.0; DEGREE + 1]; 3];
        for ((axis, points), k) in control.iter_mut().enumerate().zip(&asked.spline.axes) {
            let [third, second, first] = k.map(|v| v.unwrap_or(0.0) * self.unit());
            let mut along = bernstein(&[to[axis], first, second, third], DEGREE);
            // The parameter falls.
            along.reverse();
            for (point, value) in points.iter_mut().zip(along) {
                *point = value;
            }
            let gap = (points[0] - from[axis]).abs();
            if gap > GAP + SLACK {
                let u = self.unit();
                let (starts, stands) = (points[0] / u, from[axis] / u);
                out.fault(format!(
                    "the spline starts at {}{starts:.6}, the tool is at {stands:.6}",
                    AXES[axis]
                ));
            }
        }
        let [x, y, z] = control;
        let place = |i: usize| {
            let mut at = from;
            (at[0], at[1]) = (x[i], y[i]);
            (self.in_part(&at), z[i])
        };
        let points: Vec<(Point2, f64)> = (0..=DEGREE).map(place).collect();
        let path = bezier(&points, vec![1.0; DEGREE + 1]);
        self.emit(path, from, to, asked, out);
    }

    fn spline_fault(&self, asked: &Asked) -> Option<String> {
        if asked.rapid || asked.polar.is_some() || asked.clockwise.is_some() || asked.radius.is_some() {
            return Some("FMAX or words of a circle in an SPL block".to_owned());
        }
        if asked.axes[ROTARY].is_some() || asked.m.iter().any(|m| matches!(m, 91 | 92)) {
            return Some(
                "SPL with a rotary axis or in machine coordinates is not followed by this reader".to_owned(),
            );
        }
        if !asked.moves() {
            return Some("SPL without its end point".to_owned());
        }
        for ((name, end), k) in AXES.iter().zip(&asked.axes).zip(&asked.spline.axes) {
            match (end, k.iter().filter(|k| k.is_some()).count()) {
                (None, 0) | (Some((_, false)), DEGREE) => {}
                (Some((_, true)), _) => return Some(format!("I{name} in an SPL block: its end is absolute")),
                (Some(_), _) => {
                    return Some(format!("SPL with {name} and without K3{name}, K2{name} and K1{name}"));
                }
                (None, _) => return Some(format!("coefficients of {name} in an SPL block without {name}")),
            }
        }
        if !self.state.known[..3].iter().all(|k| *k) {
            return Some("SPL from a position that is not known".to_owned());
        }
        None
    }
}
