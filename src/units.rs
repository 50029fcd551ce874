//! Quantities with dimensions, and the unit newtypes of public signatures.
//!
//! Inside the compiler length is millimetres, angle radians, time seconds and
//! force newtons. A [`Quantity`] is what an expression of the language evaluates
//! to; its base units are mm, **degrees**, s, N, revolutions and teeth, so that
//! `30deg` prints as the user wrote it. The edge from a quantity to an [`Angle`]
//! is the only place that converts.

use crate::math::DEG;

/// A plane angle.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default, serde::Serialize)]
pub struct Angle(f64);

impl Angle {
    /// From radians.
    #[must_use]
    pub const fn radians(value: f64) -> Self {
        Angle(value)
    }
    /// From degrees.
    #[must_use]
    pub fn degrees(value: f64) -> Self {
        Angle(value * DEG)
    }
    /// In radians.
    #[must_use]
    pub const fn rad(self) -> f64 {
        self.0
    }
    /// In degrees.
    #[must_use]
    pub fn deg(self) -> f64 {
        self.0 / DEG
    }
}

/// The program's unit of length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, serde::Serialize)]
pub enum LengthUnit {
    /// Millimetre.
    #[default]
    Millimetre,
    /// Inch, 25.4 mm.
    Inch,
}

impl LengthUnit {
    /// Millimetres in one unit.
    #[must_use]
    pub const fn in_mm(self) -> f64 {
        match self {
            LengthUnit::Millimetre => 1.0,
            LengthUnit::Inch => 25.4,
        }
    }
    /// `mm` or `in`.
    #[must_use]
    pub const fn symbol(self) -> &'static str {
        match self {
            LengthUnit::Millimetre => "mm",
            LengthUnit::Inch => "in",
        }
    }
}

/// Exponents of the base dimensions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub struct Dim {
    /// Length, mm.
    pub length: i8,
    /// Plane angle, degree.
    pub angle: i8,
    /// Time, s.
    pub time: i8,
    /// Force, N.
    pub force: i8,
    /// Spindle revolutions.
    pub revolution: i8,
    /// Cutter teeth.
    pub tooth: i8,
}

impl Dim {
    /// A pure number.
    pub const NONE: Dim = Dim { length: 0, angle: 0, time: 0, force: 0, revolution: 0, tooth: 0 };
    /// mm.
    pub const LENGTH: Dim = Dim { length: 1, ..Dim::NONE };
    /// mm².
    pub const AREA: Dim = Dim { length: 2, ..Dim::NONE };
    /// Degrees.
    pub const ANGLE: Dim = Dim { angle: 1, ..Dim::NONE };
    /// Seconds.
    pub const TIME: Dim = Dim { time: 1, ..Dim::NONE };
    /// Newtons.
    pub const FORCE: Dim = Dim { force: 1, ..Dim::NONE };
    /// mm/s: feed per minute, surface speed.
    pub const FEED: Dim = Dim { length: 1, time: -1, ..Dim::NONE };
    /// mm/rev.
    pub const FEED_PER_REV: Dim = Dim { length: 1, revolution: -1, ..Dim::NONE };
    /// mm/tooth.
    pub const FEED_PER_TOOTH: Dim = Dim { length: 1, tooth: -1, ..Dim::NONE };
    /// rev/s.
    pub const SPEED: Dim = Dim { revolution: 1, time: -1, ..Dim::NONE };
    /// N/mm² = MPa.
    pub const STRESS: Dim = Dim { force: 1, length: -2, ..Dim::NONE };
}

/// A number with a dimension, in base units (mm, deg, s, N, rev, tooth).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity {
    /// The value in base units.
    pub value: f64,
    /// The dimension; [`Dim::NONE`] is a bare number.
    pub dim: Dim,
}
