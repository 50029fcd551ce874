//! Messages about motions and cams, in the program's units.

use super::Diagnostic;
use super::codes::cam as codes;
use crate::geom::cam::{CamIssue, Flank};
use crate::geom::motion::{MotionIssue, Order};
use crate::source::Span;
use crate::units::{Angle, LengthUnit};

/// What a lift is measured in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LiftUnit {
    /// A length: the program's unit.
    Length(LengthUnit),
    /// An angle, of an oscillating follower.
    Angle,
}

impl LiftUnit {
    /// A lift (mm or rad) or its derivative of order 0 to 2 (per rad), per degree of cam angle.
    fn show(self, value: f64, order: u32) -> String {
        let per = (0..order).fold(1.0, |p, _| p * crate::math::DEG);
        let power = ["", "/deg", "/deg²"].get(order as usize).copied().unwrap_or("");
        match self {
            LiftUnit::Length(unit) => {
                format!("{} {}{power}", number(value * per / unit.in_mm()), unit.symbol())
            }
            LiftUnit::Angle => format!("{} deg{power}", number(value * per / crate::math::DEG)),
        }
    }
}

/// The message for an issue of a motion. `segment` gives the place of a segment (or row of a table) by index,
/// where there is one; `statement` is the `MOTION` statement.
#[must_use]
pub fn motion(
    issue: &MotionIssue,
    statement: Span,
    segment: impl Fn(usize) -> Option<Span>,
    unit: LiftUnit,
) -> Diagnostic {
    let at = |index: usize| segment(index).unwrap_or(statement);
    match issue {
        MotionIssue::Empty => Diagnostic::new(&codes::NOT_POSITIVE, statement, "the motion has no segment"),
        MotionIssue::SegmentAngle { segment, angle } => {
            let message = format!("a segment needs an angle over 0, this one has {}", degrees(*angle));
            Diagnostic::new(&codes::NOT_POSITIVE, at(*segment), message)
        }
        MotionIssue::SegmentLift { segment, lift } => {
            let message =
                format!("a rise or return needs a lift over 0, this one has {}", unit.show(*lift, 0));
            Diagnostic::new(&codes::NOT_POSITIVE, at(*segment), message)
        }
        MotionIssue::AnglesDoNotClose { sum, missing } => angles(statement, *sum, *missing),
        MotionIssue::LiftDoesNotClose { rises, returns } => lifts(statement, *rises, *returns, unit),
        MotionIssue::PolyUndetermined { segment, conditions } => poly(at(*segment), *conditions),
        MotionIssue::Discontinuity { at, order, before, after } => {
            jump(statement, *at, *order, (*before, *after), unit)
        }
        MotionIssue::NegativeLift { at, lift } => Diagnostic::new(
            &codes::NEGATIVE_LIFT,
            statement,
            format!("the lift falls to {} at cam angle {}", unit.show(*lift, 0), degrees(*at)),
        )
        .note("BASE is the radius at lift 0, so the profile's smallest radius will be less"),
        table => table_message(table, statement, at, unit),
    }
}

fn angles(statement: Span, sum: Angle, missing: Angle) -> Diagnostic {
    let (word, amount) =
        if missing.rad() > 0.0 { ("missing", missing) } else { ("too much", Angle::radians(-missing.rad())) };
    let message =
        format!("the motion's angles add up to {}, not 360 deg: {} {word}", degrees(sum), degrees(amount));
    let help = if missing.rad() > 0.0 {
        format!("add `DWELL, {}` or widen a segment", number(missing.deg()))
    } else {
        format!("take {} off one or more segments", degrees(amount))
    };
    Diagnostic::new(&codes::ANGLES_DO_NOT_CLOSE, statement, message).help(help)
}

fn lifts(statement: Span, rises: f64, returns: f64, unit: LiftUnit) -> Diagnostic {
    let message = format!(
        "the follower does not come back: it rises by {} and returns by {}, {} apart",
        unit.show(rises, 0),
        unit.show(returns, 0),
        unit.show((rises - returns).abs(), 0)
    );
    Diagnostic::new(&codes::LIFT_DOES_NOT_CLOSE, statement, message)
        .help("make the rises and the returns equal in sum")
}

fn poly(at: Span, conditions: usize) -> Diagnostic {
    let message =
        format!("{conditions} conditions do not determine a polynomial of {conditions} coefficients here");
    Diagnostic::new(&codes::POLY_UNDETERMINED, at, message)
        .note("a polynomial of few conditions has no high derivative that a condition could set")
        .help("give velocities before accelerations, and accelerations before jerks")
}

fn jump(statement: Span, at: Angle, order: Order, (before, after): (f64, f64), unit: LiftUnit) -> Diagnostic {
    let (code, name, n) = match order {
        Order::Lift => (&codes::MOTION_JUMPS, "lift", 0),
        Order::Velocity => (&codes::MOTION_JUMPS, "velocity", 1),
        Order::Acceleration => (&codes::ACCELERATION_JUMPS, "acceleration", 2),
    };
    let message = format!(
        "the {name} jumps at cam angle {} from {} to {}",
        degrees(at),
        unit.show(before, n),
        unit.show(after, n)
    );
    let diagnostic = Diagnostic::new(code, statement, message);
    match order {
        Order::Acceleration => diagnostic
            .note("the follower feels a shock there, and the profile's curvature jumps")
            .help("use a law that starts and ends without acceleration, such as MODSIN, CYCLO or P345"),
        _ => diagnostic
            .help("use a law that starts and ends at rest, such as MODSIN, or blend with POLY segments whose V0 and V1 meet"),
    }
}

fn table_message(
    issue: &MotionIssue,
    statement: Span,
    at: impl Fn(usize) -> Span,
    unit: LiftUnit,
) -> Diagnostic {
    let (span, message, help) = match issue {
        MotionIssue::TableTooShort { rows, need } => {
            (statement, format!("the table has {rows} rows, {need} are needed"), "add rows")
        }
        MotionIssue::TableNotAscending { row, angle, before } => (
            at(*row),
            format!("row {} of the table has angle {} after {}", row + 1, degrees(*angle), degrees(*before)),
            "put the rows in order of ascending angle, each angle once",
        ),
        MotionIssue::TableValue { row } => (
            at(*row),
            format!("row {} of the table has no usable number", row + 1),
            "give an angle and a lift",
        ),
        MotionIssue::TableSpan { span } => (
            statement,
            format!("the table runs over {}, not over one turn", degrees(*span)),
            "end one turn after the first row, or say PERIODIC and leave the last row out",
        ),
        MotionIssue::TableEnds { first, last } => (
            statement,
            format!(
                "the table starts with lift {} and ends, a turn later, with {}",
                unit.show(*first, 0),
                unit.show(*last, 0)
            ),
            "give the first and the last row the same lift",
        ),
        _ => (statement, "the motion cannot be used".to_owned(), "check its segments"),
    };
    Diagnostic::new(&codes::TABLE, span, message).help(help)
}

/// The message for an issue of a cam; `statement` is the `CAM` statement (or, for a cutter, the operation).
#[must_use]
pub fn cam(issue: &CamIssue, statement: Span, unit: LengthUnit) -> Diagnostic {
    let mm = |value: f64| length(value, unit);
    match issue {
        CamIssue::NotPositive { what, value } => Diagnostic::new(
            &codes::NOT_POSITIVE,
            statement,
            format!("the {what} must be over 0 and at most 1e9, it is {}", number(*value)),
        ),
        CamIssue::GrooveNeedsRoller => {
            Diagnostic::new(&codes::GROOVE_NEEDS_ROLLER, statement, "a flat face cannot run in a groove")
                .help("use a ROLLER follower, or leave GROOVE out")
        }
        CamIssue::OffsetTooLarge { offset, limit } => {
            let message = format!(
                "the follower's offset of {} does not reach the base circle: it must be under {}",
                mm(offset.abs()),
                mm(*limit)
            );
            Diagnostic::new(&codes::DOES_NOT_REACH, statement, message).help("enlarge BASE or reduce OFFSET")
        }
        CamIssue::ArmDoesNotReach { base, smallest, largest } => {
            let message = format!("the arm does not reach a base circle of radius {}", mm(*base));
            let help = format!(
                "with this arm and pivot, BASE must be over {} and under {}",
                mm(smallest.max(0.0)),
                mm(*largest)
            );
            Diagnostic::new(&codes::DOES_NOT_REACH, statement, message).help(help)
        }
        CamIssue::SwingsTooFar { at, angle, limit } => {
            let message = format!(
                "the follower swings to {} at cam angle {}, its linkage ends at {}",
                degrees(*angle),
                degrees(*at),
                degrees(*limit)
            );
            Diagnostic::new(&codes::DOES_NOT_REACH, statement, message)
                .help("reduce the lift or BASE, or move the pivot away")
        }
        CamIssue::Undercut { .. } => undercut(issue, statement, unit),
        CamIssue::SelfIntersection { flank, offset, at, first, second } => {
            let line = if *offset == 0.0 {
                name(*flank).to_owned()
            } else {
                format!("curve {} off the {}", mm(*offset), name(*flank))
            };
            let message = format!(
                "the {line} crosses itself at ({}, {}): cam angles {} and {}",
                mm(at.x),
                mm(at.y),
                degrees(*first),
                degrees(*second)
            );
            Diagnostic::new(&codes::PROFILE_CROSSES, statement, message)
                .help("enlarge BASE or spread the motion over more angle")
        }
        CamIssue::PressureAngle { at, angle, limit, smallest_base } => {
            let message = format!(
                "the pressure angle reaches {} at cam angle {}, over the limit of {}",
                degrees(*angle),
                degrees(*at),
                degrees(*limit)
            );
            base_help(Diagnostic::new(&codes::PRESSURE_ANGLE, statement, message), *smallest_base, unit)
        }
        CamIssue::CutterTooLarge { flank, radius, limit } => {
            let place = limit.at.map_or(String::new(), |at| format!(" at cam angle {}", degrees(at)));
            let message = format!(
                "a cutter of radius {} (with what it leaves) does not fit the {}{place}: it must be under {}",
                mm(*radius),
                name(*flank),
                mm(limit.radius)
            );
            Diagnostic::new(&codes::CUTTER_TOO_LARGE, statement, message).help(format!(
                "use a cutter of diameter {} or less",
                length(round_down(2.0 * limit.radius, unit), unit)
            ))
        }
    }
}

fn undercut(issue: &CamIssue, statement: Span, unit: LengthUnit) -> Diagnostic {
    let CamIssue::Undercut { flank, at, from, to, radius, roller, smallest_base } = issue else {
        return Diagnostic::new(&codes::UNDERCUT, statement, "the cam is undercut");
    };
    let worst = if *roller > 0.0 {
        let (radius, roller) = (length(*radius, unit), length(*roller, unit));
        format!("the pitch curve's radius of curvature is {radius}, the roller's radius {roller}")
    } else {
        format!("the profile's radius of curvature is {}", length(*radius, unit))
    };
    let message = format!(
        "the {} is undercut from cam angle {} to {}: at {} {worst}",
        name(*flank),
        degrees(*from),
        degrees(*to),
        degrees(*at)
    );
    base_help(Diagnostic::new(&codes::UNDERCUT, statement, message), *smallest_base, unit)
}

fn base_help(diagnostic: Diagnostic, smallest: Option<f64>, unit: LengthUnit) -> Diagnostic {
    match smallest {
        Some(base) => diagnostic.help(format!(
            "`BASE, {}` is the smallest that works with this follower and motion",
            number(round_up(base, unit) / unit.in_mm())
        )),
        None => diagnostic.help("no BASE works with this follower and motion: move the pivot, or spread the motion over more angle"),
    }
}

const fn name(flank: Flank) -> &'static str {
    match flank {
        Flank::Inner => "profile",
        Flank::Outer => "groove's outer flank",
    }
}

/// Three decimals of the unit that are not less than the value.
fn round_up(mm: f64, unit: LengthUnit) -> f64 {
    (mm / unit.in_mm() * 1000.0).ceil() / 1000.0 * unit.in_mm()
}

/// Three decimals of the unit that are not more than the value.
fn round_down(mm: f64, unit: LengthUnit) -> f64 {
    (mm / unit.in_mm() * 1000.0).floor() / 1000.0 * unit.in_mm()
}

fn length(mm: f64, unit: LengthUnit) -> String {
    format!("{} {}", number(mm / unit.in_mm()), unit.symbol())
}

fn degrees(angle: Angle) -> String {
    format!("{} deg", number(angle.deg()))
}

/// At most four decimals, more for small numbers; no trailing zeros, no `-0`.
fn number(value: f64) -> String {
    let decimals = if value != 0.0 && value.abs() < 0.01 { 8 } else { 4 };
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".into() } else { text.into() }
}

#[cfg(test)]
mod tests;
