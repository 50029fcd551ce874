//! Feeds in the words of the control.

use crate::arena::{Arena, Handle};
use crate::diag::{Diagnostic, codes};
use crate::ir::at_origin;
use crate::ir::{Feed, Origin};
use crate::target::number;
use crate::target::{Capabilities, FeedWord, RotaryFeed};

/// Why a feed cannot be given.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum FeedTrouble {
    /// No FEDRAT before the first cut.
    Missing,
    /// Per revolution, and the spindle stands still.
    NoSpindle,
    /// The number is zero after rounding, or larger than the word takes.
    Range {
        /// What was asked for, in words.
        asked: String,
        /// Decimals of the word.
        decimals: u8,
    },
}

impl FeedTrouble {
    pub fn diagnostic(&self, origins: &Arena<Origin>, origin: Handle<Origin>) -> Diagnostic {
        match self {
            FeedTrouble::Missing => {
                at_origin(&codes::lowering::FEED_RANGE, origins, origin, "no feed is given before this cut")
                    .help("put FEDRAT/ before it")
            }
            FeedTrouble::NoSpindle => at_origin(
                &codes::lowering::NO_SPINDLE_FOR_FEED,
                origins,
                origin,
                "a feed per revolution needs a turning spindle",
            )
            .help("put SPINDL/ before it, or give the feed per minute"),
            FeedTrouble::Range { asked, decimals } => at_origin(
                &codes::lowering::FEED_RANGE,
                origins,
                origin,
                format!("the feed of {asked} does not fit the control's F word ({decimals} decimals)"),
            ),
        }
    }
}

/// Feed per minute, whatever was programmed; `rpm` 0 when the spindle stands.
pub(super) fn per_minute(feed: Option<Feed>, rpm: f64) -> Result<f64, FeedTrouble> {
    match feed {
        None => Err(FeedTrouble::Missing),
        Some(Feed::PerMinute(value)) => Ok(value),
        Some(Feed::PerRevolution(value) | Feed::PerTooth(value)) if rpm > 0.0 => Ok(value * rpm),
        Some(_) => Err(FeedTrouble::NoSpindle),
    }
}

/// The word for a move of the linear axes alone.
pub(super) fn linear(
    feed: Option<Feed>,
    rpm: f64,
    capabilities: &Capabilities,
) -> Result<FeedWord, FeedTrouble> {
    match feed {
        Some(Feed::PerRevolution(value)) if capabilities.feed_per_revolution => {
            if rpm <= 0.0 {
                return Err(FeedTrouble::NoSpindle);
            }
            let grid = &capabilities.grid;
            let decimals = grid.feed_per_revolution_decimals;
            fit(value / grid.unit.in_mm(), decimals, capabilities.ranges.feed_per_revolution)
                .map(FeedWord::PerRevolution)
                .ok_or_else(|| FeedTrouble::Range { asked: format!("{value} mm/rev"), decimals })
        }
        _ => minute_word(per_minute(feed, rpm)?, capabilities),
    }
}

/// The word for `value` mm/min.
pub(super) fn minute_word(value: f64, capabilities: &Capabilities) -> Result<FeedWord, FeedTrouble> {
    let grid = &capabilities.grid;
    let decimals = grid.feed_decimals;
    fit(value / grid.unit.in_mm() * grid.feed_scale, decimals, capabilities.ranges.feed_per_minute)
        .map(FeedWord::PerMinute)
        .ok_or_else(|| FeedTrouble::Range { asked: format!("{value:.3} mm/min"), decimals })
}

/// A move of a linear and the rotary axis: what it does, for its feed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PolarMove {
    /// Length of the path in the part, mm.
    pub length: f64,
    /// Travel of the linear axis, mm.
    pub linear: f64,
    /// Travel of the rotary axis, degrees.
    pub rotary: f64,
}

/// The word that makes the cutter follow `step` at `value` mm/min along the path in the part.
pub(super) fn polar(
    value: f64,
    step: &PolarMove,
    capabilities: &Capabilities,
) -> Result<FeedWord, FeedTrouble> {
    let grid = &capabilities.grid;
    if step.length <= 0.0 {
        return minute_word(value, capabilities);
    }
    if capabilities.inverse_time {
        let decimals = grid.inverse_time_decimals;
        return fit(value / step.length, decimals, capabilities.ranges.inverse_time)
            .map(FeedWord::InverseTime)
            .ok_or_else(|| FeedTrouble::Range {
                asked: format!("{value:.3} mm/min over {:.4} mm", step.length),
                decimals,
            });
    }
    let minutes = step.length / value;
    let unit = grid.unit.in_mm();
    let rate = match capabilities.rotary_feed {
        RotaryFeed::LinearAxes if step.linear > 0.0 => step.linear / unit / minutes,
        RotaryFeed::LinearAxes => step.rotary / minutes,
        RotaryFeed::UnitsAsDegrees => crate::math::hypot(step.linear / unit, step.rotary) / minutes,
    };
    let decimals = grid.feed_decimals;
    fit(rate * grid.feed_scale, decimals, capabilities.ranges.feed_per_minute)
        .map(FeedWord::PerMinute)
        .ok_or_else(|| FeedTrouble::Range { asked: format!("{rate:.4} units a minute"), decimals })
}

/// A positive number of steps within the word.
fn fit(value: f64, decimals: u8, range: i64) -> Option<i64> {
    number::steps(value, decimals).filter(|steps| (1..=range).contains(steps))
}
