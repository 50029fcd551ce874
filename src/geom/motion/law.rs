//! The classic motion laws, as one table.

use std::sync::OnceLock;

use super::Lift;
use super::form::{Form, Piece, universal};
use crate::math::PI;

/// A classic motion law: the normalised rise from 0 to 1 over x from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Law(u8);

/// What the table says of a law.
struct Row {
    name: &'static str,
    aliases: &'static [&'static str],
    title: &'static str,
    source: &'static str,
    curve: Curve,
}

/// How a law is defined.
enum Curve {
    /// Makino's universal curve with these zone ends.
    Universal([f64; 6]),
    /// A polynomial, constant first.
    Polynomial([f64; 8]),
    /// c0 + c1 cos(πx) + c2 cos(2πx).
    Cosines([f64; 3]),
}

const MAKINO: &str = "Makino, universal cam curve";
const CHEN: &str = "Chen, Mechanics and Design of Cam Mechanisms (1982)";

/// Second zone end of the trapecloid for a first zone of 1/8: the long constant deceleration vanishes.
const TRAPECLOID: f64 = (2.0 - 6.0 / 8.0 + PI / 8.0) / (2.0 + PI);

/// Second zone end of the one-dwell modified trapezoid whose deceleration is `m` times its acceleration,
/// zones of 1/8: from V(1) = 0.
const fn one_dwell_trapezoid(m: f64) -> f64 {
    (m * (0.25 / PI + 0.75) - 0.5 / PI + 0.125) / (1.0 + m)
}

const fn one_dwell_trapezoid_zones(m: f64) -> [f64; 6] {
    let b = one_dwell_trapezoid(m);
    [0.125, b, b + 0.125, b + 0.125, b + 0.25, 1.0]
}

/// Zones of the modified constant velocity curve whose constant velocity takes `share` of the time; the
/// acceleration's short and long parts are as 1 to 3.
const fn modified_constant_velocity(share: f64) -> [f64; 6] {
    let side = (1.0 - share) / 2.0;
    [side / 4.0, side / 4.0, side, 1.0 - side, 1.0 - side / 4.0, 1.0 - side / 4.0]
}

#[rustfmt::skip]
const TABLE: &[Row] = &[
    Row { name: "CV", aliases: &[], title: "constant velocity", source: CHEN,
        curve: Curve::Polynomial([0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]) },
    Row { name: "CA", aliases: &["PARAB", "PB"], title: "constant acceleration (parabolic)", source: MAKINO,
        curve: Curve::Universal([0.0, 0.5, 0.5, 0.5, 0.5, 1.0]) },
    Row { name: "SHM", aliases: &["SH"], title: "simple harmonic", source: MAKINO,
        curve: Curve::Universal([0.0, 0.0, 0.5, 0.5, 1.0, 1.0]) },
    Row { name: "DBLHAR", aliases: &["DH"], title: "double harmonic", source: CHEN,
        curve: Curve::Cosines([0.375, -0.5, 0.125]) },
    Row { name: "DBLHARREV", aliases: &["RDH"], title: "double harmonic, reversed", source: CHEN,
        curve: Curve::Cosines([0.625, -0.5, -0.125]) },
    Row { name: "CUBIC", aliases: &["P23"], title: "cubic 2-3 polynomial", source: CHEN,
        curve: Curve::Polynomial([0.0, 0.0, 3.0, -2.0, 0.0, 0.0, 0.0, 0.0]) },
    Row { name: "P345", aliases: &[], title: "3-4-5 polynomial", source: CHEN,
        curve: Curve::Polynomial([0.0, 0.0, 0.0, 10.0, -15.0, 6.0, 0.0, 0.0]) },
    Row { name: "P4567", aliases: &[], title: "4-5-6-7 polynomial", source: CHEN,
        curve: Curve::Polynomial([0.0, 0.0, 0.0, 0.0, 35.0, -84.0, 70.0, -20.0]) },
    Row { name: "CYCLO", aliases: &["CY", "CLO"], title: "cycloidal", source: MAKINO,
        curve: Curve::Universal([0.25, 0.25, 0.5, 0.5, 0.75, 0.75]) },
    Row { name: "MODTRAP", aliases: &["MT"], title: "modified trapezoid", source: MAKINO,
        curve: Curve::Universal([0.125, 0.375, 0.5, 0.5, 0.625, 0.875]) },
    Row { name: "MODSIN", aliases: &["MS"], title: "modified sine", source: MAKINO,
        curve: Curve::Universal([0.125, 0.125, 0.5, 0.5, 0.875, 0.875]) },
    Row { name: "MCV50", aliases: &["MCV"], title: "modified constant velocity, 50 %", source: MAKINO,
        curve: Curve::Universal(modified_constant_velocity(0.5)) },
    Row { name: "MCV33", aliases: &[], title: "modified constant velocity, 33 %", source: MAKINO,
        curve: Curve::Universal(modified_constant_velocity(1.0 / 3.0)) },
    Row { name: "MCV20", aliases: &[], title: "modified constant velocity, 20 %", source: MAKINO,
        curve: Curve::Universal(modified_constant_velocity(0.2)) },
    Row { name: "ASYCYCLO", aliases: &["ACY"], title: "asymmetric cycloidal, 2 : 3", source: MAKINO,
        curve: Curve::Universal([0.2, 0.2, 0.4, 0.4, 0.7, 0.7]) },
    Row { name: "ASYTRAP", aliases: &["AMT"], title: "asymmetric modified trapezoid, 2 : 3", source: MAKINO,
        curve: Curve::Universal([0.1, 0.3, 0.4, 0.4, 0.55, 0.85]) },
    Row { name: "TRAPEC", aliases: &["TR"], title: "trapecloid", source: MAKINO,
        curve: Curve::Universal([0.125, TRAPECLOID, TRAPECLOID + 0.125, TRAPECLOID + 0.125, TRAPECLOID + 0.25, TRAPECLOID + 0.25]) },
    Row { name: "TRAPECREV", aliases: &["RTR"], title: "trapecloid, reversed", source: MAKINO,
        curve: Curve::Universal([0.75 - TRAPECLOID, 0.75 - TRAPECLOID, 0.875 - TRAPECLOID, 0.875 - TRAPECLOID, 1.0 - TRAPECLOID, 0.875]) },
    Row { name: "ONECYCLO", aliases: &["OCY", "OCY1"], title: "one-dwell cycloidal, m = 1", source: MAKINO,
        curve: Curve::Universal([0.25, 0.25, 0.5, 0.5, 1.0, 1.0]) },
    Row { name: "ONECYCLO23", aliases: &["OCY23"], title: "one-dwell cycloidal, m = 2/3", source: MAKINO,
        curve: Curve::Universal([0.2, 0.2, 0.4, 0.4, 1.0, 1.0]) },
    Row { name: "ONETRAP", aliases: &["OMT", "OMT1"], title: "one-dwell modified trapezoid, m = 1", source: MAKINO,
        curve: Curve::Universal(one_dwell_trapezoid_zones(1.0)) },
    Row { name: "ONETRAP23", aliases: &["OMT23"], title: "one-dwell modified trapezoid, m = 2/3", source: MAKINO,
        curve: Curve::Universal(one_dwell_trapezoid_zones(2.0 / 3.0)) },
    Row { name: "FERGUSON", aliases: &["OMTF"], title: "one-dwell modified trapezoid of Ferguson", source: MAKINO,
        curve: Curve::Universal([0.125, 0.375, 0.5, 0.5, 0.625, 1.0]) },
    Row { name: "ONESIN", aliases: &["OMS"], title: "one-dwell modified sine", source: MAKINO,
        curve: Curve::Universal([0.125, 0.125, 0.5, 0.5, 1.0, 1.0]) },
    Row { name: "ONETRAPEC", aliases: &["OTR"], title: "one-dwell trapecloid", source: MAKINO,
        curve: Curve::Universal([0.125, TRAPECLOID, TRAPECLOID + 0.125, TRAPECLOID + 0.125, 1.0, 1.0]) },
    Row { name: "NODTRAP", aliases: &["NMT"], title: "no-dwell modified trapezoid", source: MAKINO,
        curve: Curve::Universal([0.0, 0.375, 0.5, 0.5, 0.625, 1.0]) },
    Row { name: "NC2", aliases: &["NMCV"], title: "no-dwell modified constant velocity", source: MAKINO,
        curve: Curve::Universal([0.0, 0.0, 0.25, 0.75, 1.0, 1.0]) },
];

const COUNT: usize = TABLE.len();

const ALL: [Law; COUNT] = {
    let mut all = [Law(0); COUNT];
    let mut i = 0;
    while i < COUNT {
        all[i] = Law(i as u8);
        i += 1;
    }
    all
};

/// Largest and smallest values of a normalised motion. A jerk is infinite where the acceleration jumps inside
/// the motion; jumps against what comes before and after it are the neighbours' business.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peaks {
    /// Largest velocity.
    pub v: f64,
    /// Largest acceleration.
    pub a_max: f64,
    /// Smallest (most negative) acceleration.
    pub a_min: f64,
    /// Largest jerk.
    pub j_max: f64,
    /// Smallest jerk.
    pub j_min: f64,
}

impl Law {
    /// Constant velocity.
    pub const CV: Law = Law(0);
    /// Modified sine.
    pub const MODSIN: Law = Law(10);

    /// The law with this name or alias, case-blind.
    #[must_use]
    pub fn by_name(name: &str) -> Option<Law> {
        let same = |other: &&str| other.eq_ignore_ascii_case(name);
        Law::all().iter().copied().find(|law| same(&law.name()) || law.row().aliases.iter().any(same))
    }
    /// Every law, in the table's order.
    #[must_use]
    pub fn all() -> &'static [Law] {
        &ALL
    }
    /// Name in the language.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.row().name
    }
    /// Other names in the language.
    #[must_use]
    pub fn aliases(self) -> &'static [&'static str] {
        self.row().aliases
    }
    /// What it is, in a few words.
    #[must_use]
    pub fn title(self) -> &'static str {
        self.row().title
    }
    /// Where it is defined.
    #[must_use]
    pub fn source(self) -> &'static str {
        self.row().source
    }
    fn row(self) -> &'static Row {
        &TABLE[usize::from(self.0) % COUNT]
    }
    /// The closed forms, zone by zone.
    pub(crate) fn pieces(self) -> &'static [Piece] {
        static PIECES: OnceLock<Vec<Vec<Piece>>> = OnceLock::new();
        let all = PIECES.get_or_init(|| TABLE.iter().map(|row| row.curve.pieces()).collect());
        &all[usize::from(self.0) % COUNT]
    }
    /// Whether it starts or ends, but not both, without acceleration: a law for a dwell on one side.
    #[must_use]
    pub fn dwells_at_one_end(self) -> bool {
        const AT_REST: f64 = 1e-9;
        (self.at(0.0).a.abs() < AT_REST) != (self.at(1.0).a.abs() < AT_REST)
    }
    /// Normalised lift and derivatives at x in 0…1; outside, those of the nearer end.
    #[must_use]
    pub fn at(self, x: f64) -> Lift {
        let x = x.clamp(0.0, 1.0);
        let pieces = self.pieces();
        let index = pieces.partition_point(|p| p.from <= x).saturating_sub(1);
        pieces.get(index).map_or(Lift::default(), |p| p.at(x))
    }
    /// Peaks of the normalised motion.
    #[must_use]
    pub fn peaks(self) -> Peaks {
        let jump_limit = 1e-9;
        let mut peaks = Peaks { v: 0.0, a_max: 0.0, a_min: 0.0, j_max: 0.0, j_min: 0.0 };
        let pieces = self.pieces();
        for piece in pieces {
            peaks.v = peaks.v.max(largest(piece, |l| l.v));
            peaks.a_max = peaks.a_max.max(largest(piece, |l| l.a));
            peaks.a_min = peaks.a_min.min(-largest(piece, |l| -l.a));
            peaks.j_max = peaks.j_max.max(largest(piece, |l| l.j));
            peaks.j_min = peaks.j_min.min(-largest(piece, |l| -l.j));
        }
        for w in pieces.windows(2) {
            let jump = w[1].at(w[1].from).a - w[0].at(w[0].to).a;
            if jump > jump_limit {
                peaks.j_max = f64::INFINITY;
            }
            if jump < -jump_limit {
                peaks.j_min = f64::NEG_INFINITY;
            }
        }
        peaks
    }
}

/// Largest value of `f` on a piece: sampled, then refined between the neighbours of the best sample.
fn largest(piece: &Piece, f: impl Fn(Lift) -> f64) -> f64 {
    let value = |x: f64| f(piece.at(x));
    crate::geom::extremum::maximum(value, piece.from, piece.to, 32).1
}

impl Curve {
    fn pieces(&self) -> Vec<Piece> {
        let whole = |form: Form| vec![Piece { from: 0.0, to: 1.0, form }];
        match self {
            Curve::Universal(zones) => universal(*zones),
            Curve::Polynomial(c) => whole(Form::Polynomial(*c)),
            Curve::Cosines([c0, c1, c2]) => whole(Form::Cosines { c0: *c0, c1: *c1, c2: *c2 }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const INF: f64 = f64::INFINITY;

    /// Peaks in the literature: name, Vm, Am+, Am−, Jm+, Jm−, with half a unit of their last digit.
    #[rustfmt::skip]
    #[allow(clippy::approx_constant, reason = "figures as printed")]
    const LITERATURE: &[(&str, [f64; 5], f64)] = &[
        ("CV", [1.0, 0.0, 0.0, 0.0, 0.0], 1e-12),
        ("CA", [2.0, 4.0, -4.0, 0.0, -INF], 1e-12),
        ("SHM", [1.57080, 4.93480, -4.93480, 0.0, -15.503], 5e-4),
        ("DBLHAR", [2.04052, 5.55165, -9.86960, 20.575, -42.414], 5e-4),
        ("DBLHARREV", [2.04052, 9.86960, -5.55165, 20.575, -42.414], 5e-4),
        ("CUBIC", [1.5, 6.0, -6.0, 0.0, -12.0], 1e-9),
        ("P345", [1.875, 5.77350, -5.77350, 60.0, -30.0], 5e-6),
        ("P4567", [2.1875, 7.51319, -7.51319, 42.0, -52.5], 5e-6),
        ("CYCLO", [2.0, 6.28319, -6.28319, 39.4784, -39.4784], 5e-5),
        ("MODTRAP", [2.0, 4.88812, -4.88812, 61.4260, -61.4260], 5e-5),
        ("MODSIN", [1.75960, 5.52796, -5.52796, 69.4664, -23.1555], 5e-5),
        ("MCV50", [1.27526, 8.01268, -8.01268, 201.381, -67.127], 5e-4),
        ("MCV33", [1.40409, 6.61660, -6.61660, 124.72, -41.57], 5e-3),
        ("MCV20", [1.52754, 5.99863, -5.99863, 94.23, -31.41], 5e-3),
        ("ASYCYCLO", [2.0, 7.85398, -5.23599, 61.685, -61.685], 5e-4),
        ("ASYTRAP", [2.0, 6.11015, -4.07344, 95.978, -95.978], 5e-4),
        ("TRAPEC", [2.18216, 6.17044, -6.17044, 77.540, -77.540], 5e-4),
        ("TRAPECREV", [2.18216, 6.17044, -6.17044, 77.540, -77.540], 5e-4),
        ("ONECYCLO", [1.75960, 5.52796, -5.52796, 34.733, -34.733], 5e-4),
        ("ONECYCLO23", [1.71830, 6.74773, -4.49849, 52.997, -52.997], 5e-4),
        ("ONETRAP", [1.91691, 4.43866, -4.43866, 55.78, -55.78], 5e-3),
        ("ONETRAP23", [1.91627, 5.54649, -3.69766, 69.70, -69.70], 5e-3),
        ("FERGUSON", [1.91672, 4.68458, -4.21648, 58.87, -58.87], 5e-3),
        ("ONESIN", [1.65985, 5.21457, -5.21457, 65.528, -21.843], 5e-4),
        ("ONETRAPEC", [1.73643, 4.91007, -4.91007, 61.702, -61.702], 5e-4),
        ("NODTRAP", [1.84010, 4.04793, -4.04793, 0.0, -50.868], 5e-4),
        ("NC2", [1.22203, 7.67825, -7.67825, 0.0, -48.244], 5e-4),
    ];

    #[test]
    fn peaks_are_those_of_the_literature() {
        assert_eq!(LITERATURE.len(), Law::all().len());
        for (name, expected, tolerance) in LITERATURE {
            let law = Law::by_name(name).expect("in the table");
            let p = law.peaks();
            for (got, want) in [p.v, p.a_max, p.a_min, p.j_max, p.j_min].into_iter().zip(expected) {
                assert!(got == *want || (got - want).abs() <= *tolerance, "{name}: {got} for {want}");
            }
        }
    }

    #[test]
    fn every_law_rises_from_0_to_1_and_its_derivatives_match_differences() {
        for law in Law::all() {
            assert!(law.at(0.0).s.abs() < 1e-15 && (law.at(1.0).s - 1.0).abs() < 1e-14, "{}", law.name());
            for piece in law.pieces() {
                for i in 1..8 {
                    let x = piece.from + (piece.to - piece.from) * f64::from(i) / 8.0;
                    let h = 1e-6;
                    let (lo, mid, hi) = (law.at(x - h), law.at(x), law.at(x + h));
                    assert!(((hi.s - lo.s) / (2.0 * h) - mid.v).abs() < 1e-8, "{} v({x})", law.name());
                    assert!(((hi.v - lo.v) / (2.0 * h) - mid.a).abs() < 1e-7, "{} a({x})", law.name());
                    assert!(((hi.a - lo.a) / (2.0 * h) - mid.j).abs() < 1e-6, "{} j({x})", law.name());
                }
            }
        }
    }

    #[test]
    fn lift_and_velocity_are_continuous_between_zones_and_end_at_rest() {
        for law in Law::all().iter().filter(|l| l.name() != "CV") {
            for w in law.pieces().windows(2) {
                let (a, b) = (w[0].at(w[0].to), w[1].at(w[1].from));
                assert!((a.s - b.s).abs() < 1e-14 && (a.v - b.v).abs() < 1e-13, "{}", law.name());
            }
            assert!(law.at(0.0).v.abs() < 1e-13 && law.at(1.0).v.abs() < 1e-13, "{}", law.name());
        }
    }

    #[test]
    fn dwell_to_dwell_laws_start_and_end_without_acceleration() {
        for name in [
            "P345", "P4567", "CYCLO", "MODTRAP", "MODSIN", "MCV50", "MCV33", "MCV20", "ASYCYCLO", "ASYTRAP",
            "TRAPEC",
        ] {
            let law = Law::by_name(name).expect("in the table");
            assert!(law.at(0.0).a.abs() < 1e-12 && law.at(1.0).a.abs() < 1e-12, "{name}");
        }
    }

    #[test]
    fn names_and_aliases_are_unique_and_case_blind() {
        let mut names: Vec<&str> =
            Law::all().iter().flat_map(|l| l.aliases().iter().copied().chain([l.name()])).collect();
        names.sort_unstable();
        assert!(names.windows(2).all(|w| w[0] != w[1]));
        assert_eq!(Law::by_name("modsin"), Some(Law::MODSIN));
        assert_eq!(Law::by_name("MS"), Some(Law::MODSIN));
        assert_eq!(Law::CV.name(), "CV");
        assert_eq!(Law::by_name("SPLINE"), None);
    }
}
