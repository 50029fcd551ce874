//! Deterministic elementary functions.
//!
//! Every transcendental function of the crate comes from the `libm` crate, so
//! that the same source gives the same bytes on every machine. `clippy.toml`
//! bans the `std` versions. `sqrt`, `abs`, `floor` and the four operations are
//! exact in IEEE 754 and are used from `std`.

/// π/180: radians in a degree.
pub const DEG: f64 = core::f64::consts::PI / 180.0;
/// A full turn in radians.
pub const TAU: f64 = core::f64::consts::TAU;
/// Half a turn in radians.
pub const PI: f64 = core::f64::consts::PI;

/// Sine of `x` radians.
#[must_use]
pub fn sin(x: f64) -> f64 {
    libm::sin(x)
}
/// Cosine of `x` radians.
#[must_use]
pub fn cos(x: f64) -> f64 {
    libm::cos(x)
}
/// Sine and cosine of `x` radians, in that order.
#[must_use]
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}
/// Tangent of `x` radians.
#[must_use]
pub fn tan(x: f64) -> f64 {
    libm::tan(x)
}
/// Arc sine, radians.
#[must_use]
pub fn asin(x: f64) -> f64 {
    libm::asin(x)
}
/// Arc cosine, radians.
#[must_use]
pub fn acos(x: f64) -> f64 {
    libm::acos(x)
}
/// Arc tangent, radians.
#[must_use]
pub fn atan(x: f64) -> f64 {
    libm::atan(x)
}
/// Angle of the vector (x, y), radians in (-π, π].
#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}
/// Length of the vector (x, y).
#[must_use]
pub fn hypot(x: f64, y: f64) -> f64 {
    libm::hypot(x, y)
}
/// `e^x`.
#[must_use]
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}
/// Natural logarithm.
#[must_use]
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}
/// Logarithm to base 10.
#[must_use]
pub fn log10(x: f64) -> f64 {
    libm::log10(x)
}
/// `x^y`.
#[must_use]
pub fn pow(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}
/// Cube root.
#[must_use]
pub fn cbrt(x: f64) -> f64 {
    libm::cbrt(x)
}
/// A count as a floating-point number; exact up to 2^53, far above any count here.
#[must_use]
#[allow(clippy::cast_precision_loss)]
pub fn count(n: usize) -> f64 {
    n as f64
}
/// The smallest integer not below `x`, for counts; 0 for what is negative or no number.
#[must_use]
pub fn ceil_to_usize(x: f64) -> usize {
    // Float to integer conversion saturates, and NaN gives 0.
    x.ceil() as usize
}
