//! Feeds: modes, units, rotary tables, rapids.

use super::super::judge::Finding;
use super::super::sheet::Sheet;
use super::super::trial::Trial;
use super::{Try, number, row};
use crate::ir::{Feed, Interpolation};
use crate::readback::{FeedMode, TracePath};
use crate::units::LengthUnit;

pub(in super::super) const MODES: Try = row(
    "feeds",
    "per minute, per revolution, per minute again",
    || {
        Sheet::mm()
            .line(10.0, 0.0, 5.0)
            .feed(Feed::PerRevolution(0.2))
            .line(20.0, 0.0, 5.0)
            .feed(Feed::PerMinute(300.0))
            .line(30.0, 0.0, 5.0)
    },
    modes,
);
pub(in super::super) const INCH: Try = row(
    "feeds",
    "10 inch a minute in an inch program",
    || Sheet::new(LengthUnit::Inch).feed(Feed::PerMinute(254.0)).line(25.4, 0.0, 5.0),
    inch,
);
pub(in super::super) const SMALL: Try =
    row("feeds", "0.01 mm a minute", || Sheet::mm().feed(Feed::PerMinute(0.01)).line(1.0, 0.0, 5.0), small);
pub(in super::super) const ROTARY: Try = row(
    "feeds",
    "feed along the part with a rotary table",
    || Sheet::mm().with_rotary().contour(Interpolation::RTheta, &[-1.0]),
    rotary,
);
pub(in super::super) const RAPID: Try = row(
    "feeds",
    "rapid that moves all axes",
    || Sheet::mm().rapid(10.0, 20.0, 8.0).rapid(30.0, 0.0, 6.0),
    rapid,
);

/// Feeds of the cuts in mm/min; per revolution they are speed times feed.
fn feeds(trial: &Trial) -> Vec<f64> {
    trial.cuts().filter_map(|m| m.feed).collect()
}

fn modes(trial: &Trial) -> Finding {
    let feeds = feeds(trial);
    let wanted = [300.0, 200.0, 300.0];
    let right = trial.cuts().zip(wanted).all(|(cut, feed)| trial.feeds_at(cut, feed));
    if !right || feeds.len() != wanted.len() {
        return Finding::wrong(format!("feeds are {feeds:?} mm/min instead of 300, 200 and 300"));
    }
    if trial.cuts().any(|m| m.feed_mode == FeedMode::PerRevolution) {
        Finding::right("300, 200 and 300 mm/min; F is said again after every change")
    } else {
        Finding::expressed("300, 200 and 300 mm/min, all per minute")
    }
}

fn inch(trial: &Trial) -> Finding {
    match feeds(trial).as_slice() {
        [only] if trial.cuts().all(|cut| trial.feeds_at(cut, 254.0)) => {
            Finding::right(format!("{} mm/min", number(*only)))
        }
        other => Finding::wrong(format!("feeds are {other:?} mm/min instead of 254")),
    }
}

fn small(trial: &Trial) -> Finding {
    match feeds(trial).as_slice() {
        [only] if (only - 0.01).abs() < 1e-6 => Finding::right("0.01 mm/min"),
        [only] if *only > 0.0 => Finding::expressed(format!("{} mm/min, the smallest feed", number(*only))),
        other => Finding::wrong(format!("feeds are {other:?} mm/min")),
    }
}

fn rotary(trial: &Trial) -> Finding {
    let cuts: Vec<f64> =
        trial.cuts().filter(|m| matches!(m.path, TracePath::Spiral { .. })).filter_map(|m| m.feed).collect();
    if cuts.is_empty() {
        return Finding::expressed("the table does not turn");
    }
    let least = cuts.iter().copied().fold(f64::INFINITY, f64::min);
    let most = cuts.iter().copied().fold(0.0, f64::max);
    let mode = trial.cuts().any(|m| m.feed_mode == FeedMode::InverseTime);
    let mode = if mode { "inverse time" } else { "per minute" };
    Finding::right(format!("{} to {} mm/min along the part, {mode}", number(least), number(most)))
}

fn rapid(trial: &Trial) -> Finding {
    let slanted = trial.moves().find(|m| {
        let (from, to) = (m.start(), m.end());
        from.z != to.z && (from.x != to.x || from.y != to.y)
    });
    match slanted {
        None => Finding::right("never Z together with another axis: rapids need not be straight"),
        Some(_) if trial.cl_data => Finding::not_applicable(
            "CL data say where a rapid goes; the post that reads them says by which axes first",
        ),
        Some(m) => Finding::wrong(format!("moves from {} to {} at once", m.start(), m.end())),
    }
}
