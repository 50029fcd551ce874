//! Grbl 1.1, from its list of supported codes and its error codes.

use super::super::codes::{G, Group, M, Mode, Plane};
use super::super::rules::{ArcEnd, Dwell, FeedReset, Frame, Language, RotaryFeed, Rules, Unpointed};
use crate::readback::FeedMode;

pub(super) const RULES: Rules = Rules {
    name: "grbl",
    language: Language::Iso,
    frame: Frame::Free,
    parentheses: true,
    semicolon_comment: true,
    comment_may_stay_open: true,
    comment_may_nest: true,
    comment_character: |c| c < 0x80 && !matches!(c, b'?' | b'!' | b'~' | 0x18),
    comment_complaint: "the control acts at once on",
    active_comments: &[],
    percent_allowed: false,
    lower_case: true,
    slash_anywhere: true,
    checksum: false,
    line_limit: Some(79),
    limit_counts_all: false,
    whole_numbers: &[],
    unpointed: Unpointed::Whole,
    largest_length: None,
    largest_n: 10_000_000.0,
    largest_t: 255.0,
    largest_inverse: f64::INFINITY,
    most_m: 4,
    g,
    m,
    dwell: &[(b'P', Dwell::Seconds)],
    cycles: None,
    tool_change: false,
    length_offset: false,
    length_by_d: false,
    length_needs_h: false,
    work_offset: true,
    reference_needs_axis: false,
    starts_at_rapid: true,
    repeat_motion: false,
    feed_modes: true,
    feed_reset: FeedReset::Change,
    rotary_feed: RotaryFeed::LinearAxes,
    blends: false,
    exact_code: "G61",
    radius_wins: false,
    shaky_half_circle: false,
    arc_turns: false,
    arc_needs_end: true,
    arc_end: ArcEnd::Spiral,
    arc_mode_stated: false,
    largest_difference,
    arc_complaint: "error:33, invalid target: the arc's radii differ",
    full_circle_fuzz: 5e-7,
    smallest_radius: 0.0,
    no_feed: "error:22, undefined feed rate",
    unused: "error:36, unused value word",
};

/// 0.5 mm, or 0.005 mm and 0.1 % of the radius.
fn largest_difference(radius: f64, _inch: bool) -> f64 {
    (0.001 * radius).clamp(0.005, 0.5)
}

pub(super) fn g(tenths: u16) -> Option<G> {
    Some(match tenths {
        0 => G::Motion(Mode::Rapid),
        10 => G::Motion(Mode::Linear),
        20 => G::Motion(Mode::Arc { clockwise: true }),
        30 => G::Motion(Mode::Arc { clockwise: false }),
        40 => G::Dwell,
        170 => G::Plane(Plane::Xy),
        180 => G::Plane(Plane::Zx),
        190 => G::Plane(Plane::Yz),
        200 => G::Units { inch: true },
        210 => G::Units { inch: false },
        280 | 300 => G::Reference,
        400 => G::RadiusOff,
        490 => G::LengthOff,
        530 => G::MachineCoordinates,
        610 => G::ExactPath,
        800 => G::Motion(Mode::None),
        900 => G::Distance { incremental: false },
        910 => G::Distance { incremental: true },
        911 => G::ArcDistance { incremental: true },
        930 => G::Feed(FeedMode::InverseTime),
        940 => G::Feed(FeedMode::PerMinute),
        382..=385 => G::Unfollowed(Group::Motion),
        431 => G::Unfollowed(Group::Length),
        100 | 281 | 301 | 920 | 921 => G::Unfollowed(Group::Once),
        _ => return super::fanuc::offset(tenths),
    })
}

pub(super) fn m(tenths: u16) -> Option<M> {
    Some(match tenths {
        0 => M::Stop { optional: false },
        10 => M::Stop { optional: true },
        20 | 300 => M::End,
        30 => M::SpindleOn { clockwise: true },
        40 => M::SpindleOn { clockwise: false },
        50 => M::SpindleOff,
        70 | 80 => M::CoolantOn { mist: tenths == 70 },
        90 => M::CoolantOff,
        _ => return None,
    })
}
