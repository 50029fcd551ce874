//! Interval arithmetic with first derivatives in (u, v), for proven bounds over parameter boxes.
//!
//! Bounds are widened by a relative [`WIDENING`] per operation instead of directed rounding; that is more
//! than the rounding of one IEEE operation and far below what the callers resolve.

use core::ops::{Add, Mul, Neg, Sub};

/// Relative widening per operation: eight units in the last place.
pub const WIDENING: f64 = 8.0 * f64::EPSILON;

/// A closed interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub lo: f64,
    /// Upper end.
    pub hi: f64,
}

impl Interval {
    /// The interval of one number.
    #[must_use]
    pub const fn point(x: f64) -> Interval {
        Interval { lo: x, hi: x }
    }
    /// The interval between two numbers in any order.
    #[must_use]
    pub fn hull(a: f64, b: f64) -> Interval {
        Interval { lo: a.min(b), hi: a.max(b) }
    }
    /// The smallest interval that holds both.
    #[must_use]
    pub fn union(self, other: Interval) -> Interval {
        Interval { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }
    /// What both have in common; `self` when rounding makes that empty.
    #[must_use]
    pub fn meet(self, other: Interval) -> Interval {
        let (lo, hi) = (self.lo.max(other.lo), self.hi.min(other.hi));
        if lo <= hi { Interval { lo, hi } } else { self }
    }
    /// Largest absolute value.
    #[must_use]
    pub fn magnitude(self) -> f64 {
        self.lo.abs().max(self.hi.abs())
    }
    /// Width.
    #[must_use]
    pub fn width(self) -> f64 {
        self.hi - self.lo
    }
    /// Widened by `ulps` units in the last place of its largest value: what was computed without intervals.
    #[must_use]
    pub fn slackened(self, ulps: f64) -> Interval {
        let slack = self.magnitude() * f64::EPSILON * ulps;
        Interval { lo: self.lo - slack, hi: self.hi + slack }
    }
    fn widened(self) -> Interval {
        let slack = self.magnitude() * WIDENING;
        Interval { lo: self.lo - slack, hi: self.hi + slack }
    }
    /// Square, never negative.
    #[must_use]
    pub fn square(self) -> Interval {
        let hi = self.magnitude() * self.magnitude();
        let lo = if self.lo <= 0.0 && self.hi >= 0.0 { 0.0 } else { self.lo.abs().min(self.hi.abs()) };
        let low = lo * lo;
        Interval { lo: low * (1.0 - WIDENING), hi: hi * (1.0 + WIDENING) }
    }
    /// Square root; what is below zero counts as zero.
    #[must_use]
    pub fn sqrt(self) -> Interval {
        Interval {
            lo: self.lo.max(0.0).sqrt() * (1.0 - WIDENING),
            hi: self.hi.max(0.0).sqrt() * (1.0 + WIDENING),
        }
    }
    /// 1/x; the whole line when 0 is inside.
    #[must_use]
    pub fn recip(self) -> Interval {
        if self.lo <= 0.0 && self.hi >= 0.0 {
            return Interval { lo: f64::NEG_INFINITY, hi: f64::INFINITY };
        }
        Interval { lo: 1.0 / self.hi, hi: 1.0 / self.lo }.widened()
    }
}

impl Add for Interval {
    type Output = Interval;
    fn add(self, o: Interval) -> Interval {
        Interval { lo: self.lo + o.lo, hi: self.hi + o.hi }.widened()
    }
}
impl Sub for Interval {
    type Output = Interval;
    fn sub(self, o: Interval) -> Interval {
        Interval { lo: self.lo - o.hi, hi: self.hi - o.lo }.widened()
    }
}
impl Neg for Interval {
    type Output = Interval;
    fn neg(self) -> Interval {
        Interval { lo: -self.hi, hi: -self.lo }
    }
}
impl Mul for Interval {
    type Output = Interval;
    fn mul(self, o: Interval) -> Interval {
        let p = [self.lo * o.lo, self.lo * o.hi, self.hi * o.lo, self.hi * o.hi];
        // 0 · ∞ is 0 here: an unbounded factor of an exact zero.
        let clean = p.map(|x| if x.is_nan() { 0.0 } else { x });
        let lo = clean.iter().copied().fold(f64::INFINITY, f64::min);
        let hi = clean.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Interval { lo, hi }.widened()
    }
}

/// A value over a box with its gradient over the same box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual {
    /// Value.
    pub value: Interval,
    /// ∂/∂u.
    pub u: Interval,
    /// ∂/∂v.
    pub v: Interval,
}

impl Dual {
    /// √x.
    #[must_use]
    pub fn sqrt(self) -> Dual {
        let value = self.value.sqrt();
        let half = (value + value).recip();
        Dual { value, u: self.u * half, v: self.v * half }
    }
    /// 1/x.
    #[must_use]
    pub fn recip(self) -> Dual {
        let value = self.value.recip();
        let slope = -(value.square());
        Dual { value, u: self.u * slope, v: self.v * slope }
    }
    /// k x.
    #[must_use]
    pub fn scale(self, k: f64) -> Dual {
        let k = Interval::point(k);
        Dual { value: self.value * k, u: self.u * k, v: self.v * k }
    }
    /// x².
    #[must_use]
    pub fn square(self) -> Dual {
        let two = self.value + self.value;
        Dual { value: self.value.square(), u: two * self.u, v: two * self.v }
    }
}
impl Add for Dual {
    type Output = Dual;
    fn add(self, o: Dual) -> Dual {
        Dual { value: self.value + o.value, u: self.u + o.u, v: self.v + o.v }
    }
}
impl Sub for Dual {
    type Output = Dual;
    fn sub(self, o: Dual) -> Dual {
        Dual { value: self.value - o.value, u: self.u - o.u, v: self.v - o.v }
    }
}
impl Mul for Dual {
    type Output = Dual;
    fn mul(self, o: Dual) -> Dual {
        Dual {
            value: self.value * o.value,
            u: self.u * o.value + self.value * o.u,
            v: self.v * o.value + self.value * o.v,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operations_enclose() {
        let a = Interval { lo: -1.0, hi: 2.0 };
        let b = Interval { lo: 3.0, hi: 4.0 };
        let p = a * b;
        assert!(p.lo <= -4.0 && p.hi >= 8.0 && p.width() < 12.0 + 1e-12);
        assert_eq!(a.square().lo, 0.0);
        assert!(a.recip().hi.is_infinite());
        assert!(b.recip().lo <= 0.25 && b.recip().hi >= 1.0 / 3.0);
        assert!((a - a).lo <= -3.0);
    }
}
