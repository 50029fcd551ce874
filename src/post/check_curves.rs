//! Checks of curves in the form of cubic pieces.

use super::check::at;
use super::dialect::Dialect;
use super::pattern::Coefficient;
use crate::diag::{Diagnostic, codes};
use crate::units::LengthUnit;

/// The words of the axes, and where they end.
const AXES: [&str; 3] = ["x", "y", "z"];

/// A block says the whole piece, in numbers of one grid, and nothing is said that would never be printed.
pub(super) fn check(dialect: &Dialect, errors: &mut Vec<Diagnostic>) {
    if dialect.spec.nurbs.knots != "pieces" {
        return;
    }
    let mut say = |path: &str, message: String| {
        errors.push(at(dialect, path, &codes::post::BAD_PATTERN, message));
    };
    let nurbs = &dialect.spec.nurbs;
    let frame =
        [("begin", &nurbs.begin), ("rest", &nurbs.rest), ("end", &nurbs.end), ("between", &nurbs.between)];
    for (key, _) in frame.into_iter().filter(|(_, items)| !items.is_empty()) {
        let path = format!("nurbs.{key}");
        say(
            &path,
            format!("`nurbs.{key}` is never printed: a piece is one block, `nurbs.point`; it must be []"),
        );
    }
    for axis in 0..AXES.len() {
        if let Some(problem) = unsaid(&nurbs.point, axis) {
            say("nurbs.point", problem);
        }
    }
    for unit in [LengthUnit::Millimetre, LengthUnit::Inch] {
        if let Some((word, problem)) = coarse(dialect, unit) {
            say(&format!("words.{word}.decimals"), problem);
        }
    }
    errors.dedup_by(|a, b| a.message == b.message && a.primary == b.primary);
}

/// What a pattern leaves open of a piece along an axis: with its start it takes three numbers that do not follow from each
/// other. Z may be left out as a whole.
fn unsaid(items: &[String], axis: usize) -> Option<String> {
    let name = AXES[axis];
    let own = |item: &String| match Coefficient::by_name(item) {
        Some(c) if c.axis == axis => Some([c.shares[1], c.shares[2], c.shares[3]]),
        None if item == name => Some([0, 0, 1]),
        _ => None,
    };
    let said: Vec<[i64; 3]> = items.iter().filter_map(own).collect();
    let independent = |[a, b, c]: [[i64; 3]; 3]| {
        let cross = [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]];
        a.iter().zip(cross).map(|(a, b)| a * b).sum::<i64>() != 0
    };
    let whole = said.iter().any(|a| said.iter().any(|b| said.iter().any(|c| independent([*a, *b, *c]))));
    let left_out = axis == 2 && said.is_empty();
    (!whole && !left_out).then(|| {
        format!(
            "the pattern does not say the whole piece along {}: with its end (`{name}` or `end-{name}`) it takes `leave-{name}` and `arrive-{name}`, `a2-{name}` and `a3-{name}`, or `k1-{name}` to `k3-{name}`",
            name.to_uppercase()
        )
    })
}

/// The first coefficient whose decimals are not those of all, or fewer than those of the axes.
fn coarse(dialect: &Dialect, unit: LengthUnit) -> Option<(&'static str, String)> {
    let spec = &dialect.spec;
    let linear = spec.decimals("x", unit);
    let of = |c: &Coefficient| spec.decimals(c.name, unit);
    let most = spec.coefficients().map(|c| of(&c)).max()?.max(linear);
    let odd = spec.coefficients().find(|c| of(c) != most)?;
    Some((
        odd.name,
        format!(
            "`{}` has {} decimals in {} programs, another coefficient or `x` has {most}: coefficients have the same decimals as each other and no fewer than axes",
            odd.name,
            of(&odd),
            unit.symbol()
        ),
    ))
}
