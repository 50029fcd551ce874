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

/// Rounds to 15 significant digits: removes the last-bit noise that a unit conversion leaves, so that
/// `1.1in` and `27.94mm` are the same number.
#[must_use]
pub fn tidy(value: f64) -> f64 {
    if !value.is_finite() {
        return value;
    }
    format!("{value:.14e}").parse().unwrap_or(value)
}

/// A number times the factor of a unit. Where the factor is a short decimal, as 25.4 is, the product is that
/// of the decimals; others, such as 1/60, are left alone.
fn convert(number: f64, factor: f64) -> f64 {
    const DECIMALS: f64 = 1e6;
    let product = number * factor;
    if (factor * DECIMALS).fract() == 0.0 { tidy(product) } else { product }
}

impl Dim {
    fn exponents(self) -> [i8; 6] {
        [self.length, self.angle, self.time, self.force, self.revolution, self.tooth]
    }
    fn from_exponents([length, angle, time, force, revolution, tooth]: [i8; 6]) -> Dim {
        Dim { length, angle, time, force, revolution, tooth }
    }
    fn combine(self, other: Dim, f: impl Fn(i8, i8) -> Option<i8>) -> Option<Dim> {
        let (a, b) = (self.exponents(), other.exponents());
        let mut out = [0i8; 6];
        for ((o, x), y) in out.iter_mut().zip(a).zip(b) {
            *o = f(x, y)?;
        }
        Some(Dim::from_exponents(out))
    }
    /// Dimension of a product; `None` when an exponent leaves ±127.
    #[must_use]
    pub fn times(self, other: Dim) -> Option<Dim> {
        self.combine(other, i8::checked_add)
    }
    /// Dimension of a quotient; `None` when an exponent leaves ±127.
    #[must_use]
    pub fn over(self, other: Dim) -> Option<Dim> {
        self.combine(other, i8::checked_sub)
    }
    /// Dimension of the power `numerator/denominator`; `None` when an exponent would not be whole.
    #[must_use]
    pub fn power(self, numerator: i8, denominator: i8) -> Option<Dim> {
        self.combine(self, |x, _| {
            let n = x.checked_mul(numerator)?;
            (denominator != 0 && n % denominator == 0).then(|| n / denominator)
        })
    }
    /// What a machinist calls it: `length`, `feed per minute`; a formula of base units where no name exists.
    #[must_use]
    pub fn name(self) -> String {
        NAMED.iter().find(|(d, _)| *d == self).map_or_else(
            || format!("quantity in {}", self.formula(LengthUnit::Millimetre)),
            |(_, n)| (*n).into(),
        )
    }
    /// The unit in which a value of this dimension is shown in a program in `unit`.
    #[must_use]
    pub fn symbol(self, unit: LengthUnit) -> String {
        match (self, unit) {
            (Dim::NONE, _) => String::new(),
            (Dim::SPEED, _) => "rpm".into(),
            (Dim::STRESS, LengthUnit::Millimetre) => "MPa".into(),
            _ => self.formula(unit),
        }
    }
    /// How many base units one [`Dim::symbol`] unit is: what a bare number of this dimension is multiplied by.
    #[must_use]
    pub fn factor(self, unit: LengthUnit) -> f64 {
        let mut factor = 1.0;
        for _ in 0..self.length.unsigned_abs() {
            factor *= unit.in_mm();
        }
        if self.length < 0 {
            factor = 1.0 / factor;
        }
        if self.per_minute() { factor / 60.0 } else { factor }
    }
    /// Feeds, speeds and other rates are told per minute.
    fn per_minute(self) -> bool {
        self.time == -1 && (self.length > 0 || self.revolution > 0)
    }
    fn formula(self, unit: LengthUnit) -> String {
        let time = if self.per_minute() { "min" } else { "s" };
        let names = [unit.symbol(), "deg", time, "N", "rev", "tooth"];
        let side = |sign: i8| -> Vec<String> {
            self.exponents()
                .iter()
                .zip(names)
                .filter(|(e, _)| **e != 0 && e.signum() == sign)
                .map(
                    |(e, n)| {
                        if e.unsigned_abs() == 1 { n.into() } else { format!("{n}^{}", e.unsigned_abs()) }
                    },
                )
                .collect()
        };
        let (over, under) = (side(1), side(-1));
        let over = if over.is_empty() && !under.is_empty() { "1".into() } else { over.join("*") };
        under.iter().fold(over, |text, unit| format!("{text}/{unit}"))
    }
}

const NAMED: [(Dim, &str); 14] = [
    (Dim::NONE, "pure number"),
    (Dim::LENGTH, "length"),
    (Dim::AREA, "area"),
    (Dim { length: 3, ..Dim::NONE }, "volume"),
    (Dim::ANGLE, "angle"),
    (Dim::TIME, "time"),
    (Dim::FORCE, "force"),
    (Dim::FEED, "feed per minute"),
    (Dim::FEED_PER_REV, "feed per revolution"),
    (Dim::FEED_PER_TOOTH, "feed per tooth"),
    (Dim::SPEED, "spindle speed"),
    (Dim::STRESS, "stress"),
    (Dim { length: 1, angle: -1, ..Dim::NONE }, "lift per angle"),
    (Dim { length: 1, time: -2, ..Dim::NONE }, "acceleration"),
];

/// A unit: how many base units it is, and its dimension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// Base units (mm, deg, s, N, rev, tooth) in one.
    pub factor: f64,
    /// Its dimension.
    pub dim: Dim,
}

/// Every simple unit suffix of the language, for messages.
pub const UNIT_NAMES: [&str; 21] = [
    "mm", "cm", "m", "um", "in", "ft", "deg", "rad", "rpm", "s", "ms", "min", "N", "kN", "MPa", "GPa", "rev",
    "tooth", "mm/min", "mm/rev", "mm/tooth",
];

/// The unit written as `text`: a simple unit, or products, quotients and powers of them such as `mm/min`,
/// `N/mm2`, `N/mm^2`, `m/s`. Case does not matter. A leading `1` stands for no unit, as in `1/mm`.
#[must_use]
pub fn parse_unit(text: &str) -> Option<Unit> {
    let mut result = Unit { factor: 1.0, dim: Dim::NONE };
    let mut divide = false;
    let mut rest = text;
    loop {
        let end = rest.find(['/', '*']).unwrap_or(rest.len());
        let (part, tail) = rest.split_at(end);
        let part = if part.trim() == "1" {
            Unit { factor: 1.0, dim: Dim::NONE }
        } else {
            parse_factor(part.trim())?
        };
        result = if divide {
            Unit { factor: result.factor / part.factor, dim: result.dim.over(part.dim)? }
        } else {
            Unit { factor: result.factor * part.factor, dim: result.dim.times(part.dim)? }
        };
        match tail.chars().next() {
            None => return Some(result),
            Some(mark) => divide = mark == '/',
        }
        rest = tail.get(1..)?;
    }
}

/// One unit with an optional whole exponent: `mm`, `mm2`, `mm^2`.
fn parse_factor(text: &str) -> Option<Unit> {
    let name_end = text.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(text.len());
    let (name, exponent) = text.split_at(name_end);
    let unit = simple_unit(name)?;
    if exponent.is_empty() {
        return Some(unit);
    }
    let exponent: i8 =
        exponent.strip_prefix('^').unwrap_or(exponent).parse().ok().filter(|e| (1..=9).contains(e))?;
    let factor = (0..exponent).fold(1.0, |f, _| f * unit.factor);
    Some(Unit { factor, dim: unit.dim.power(exponent, 1)? })
}

fn simple_unit(name: &str) -> Option<Unit> {
    let (factor, dim) = match name.to_ascii_lowercase().as_str() {
        "mm" => (1.0, Dim::LENGTH),
        "cm" => (10.0, Dim::LENGTH),
        "m" => (1000.0, Dim::LENGTH),
        "um" => (0.001, Dim::LENGTH),
        "in" | "inch" => (25.4, Dim::LENGTH),
        "ft" => (304.8, Dim::LENGTH),
        "deg" => (1.0, Dim::ANGLE),
        "rad" => (1.0 / DEG, Dim::ANGLE),
        "s" => (1.0, Dim::TIME),
        "ms" => (0.001, Dim::TIME),
        "min" => (60.0, Dim::TIME),
        "n" => (1.0, Dim::FORCE),
        "kn" => (1000.0, Dim::FORCE),
        "mpa" => (1.0, Dim::STRESS),
        "gpa" => (1000.0, Dim::STRESS),
        "rev" => (1.0, Dim { revolution: 1, ..Dim::NONE }),
        "tooth" => (1.0, Dim { tooth: 1, ..Dim::NONE }),
        "rpm" => (1.0 / 60.0, Dim::SPEED),
        _ => return None,
    };
    Some(Unit { factor, dim })
}

impl Quantity {
    /// A bare number.
    #[must_use]
    pub const fn bare(value: f64) -> Quantity {
        Quantity { value, dim: Dim::NONE }
    }
    /// A quantity in base units.
    #[must_use]
    pub const fn new(value: f64, dim: Dim) -> Quantity {
        Quantity { value, dim }
    }
    /// `number` of `unit`.
    #[must_use]
    pub fn of(number: f64, unit: Unit) -> Quantity {
        Quantity { value: convert(number, unit.factor), dim: unit.dim }
    }
    /// Whether it has no dimension.
    #[must_use]
    pub fn is_bare(self) -> bool {
        self.dim == Dim::NONE
    }
    /// The quantity as a value of dimension `dim`: itself when it has it, a bare number read in the unit that
    /// a program in `unit` uses for `dim`; `None` when the dimensions differ.
    #[must_use]
    pub fn land(self, dim: Dim, unit: LengthUnit) -> Option<Quantity> {
        if self.dim == dim {
            Some(self)
        } else if self.is_bare() {
            Some(Quantity { value: convert(self.value, dim.factor(unit)), dim })
        } else {
            None
        }
    }
    /// The number shown to the user, in the unit [`Dim::symbol`].
    #[must_use]
    pub fn in_unit(self, unit: LengthUnit) -> f64 {
        tidy(self.value / self.dim.factor(unit))
    }
    /// For messages: at most six decimals, with its unit.
    #[must_use]
    pub fn show(self, unit: LengthUnit) -> String {
        with_symbol(number(self.in_unit(unit)), &self.dim.symbol(unit))
    }
    /// Without loss: every digit, the unit straight after the number, as the language reads it.
    #[must_use]
    pub fn exact(self, unit: LengthUnit) -> String {
        format!("{}{}", self.in_unit(unit), self.dim.symbol(unit))
    }
}

fn with_symbol(number: String, symbol: &str) -> String {
    if symbol.is_empty() { number } else { format!("{number} {symbol}") }
}

/// A number for messages: at most six decimals, no trailing zeros, no `-0`; very small and very large ones
/// in exponent form.
#[must_use]
pub fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    if !(1e-3..1e12).contains(&value.abs()) {
        let text = format!("{value:.5e}");
        let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        let digits =
            if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits };
        return format!("{digits}e{exponent}");
    }
    let text = format!("{value:.6}");
    text.trim_end_matches('0').trim_end_matches('.').into()
}

/// A length in mm, for messages of a program in `unit`.
#[must_use]
pub fn show_length(mm: f64, unit: LengthUnit) -> String {
    Quantity::new(mm, Dim::LENGTH).show(unit)
}

/// An angle, for messages.
#[must_use]
pub fn show_angle(angle: Angle) -> String {
    Quantity::new(tidy(angle.deg()), Dim::ANGLE).show(LengthUnit::Millimetre)
}

#[cfg(test)]
mod tests;
