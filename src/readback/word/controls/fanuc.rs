//! Fanuc 30i milling, G-code system of machining centres.

use super::super::block::letters;
use super::super::codes::{CycleKind, G, Group, M, Mode};
use super::super::cubic::Cubic;
use super::super::iso;
use super::super::rules::{
    ArcEnd, Cycles, Dwell, FeedReset, Frame, Language, RadiusWord, RotaryFeed, Rules, Unpointed,
};
use crate::readback::FeedMode;

pub(in crate::readback::word) const RULES: Rules = Rules {
    name: "fanuc",
    language: Language::Iso,
    frame: Frame::PercentAndNumber,
    parentheses: true,
    semicolon_comment: false,
    comment_may_stay_open: false,
    comment_may_nest: false,
    comment_character: |c| c.is_ascii_uppercase() || c.is_ascii_digit() || b" .,=_-+/*#:[]<>&'".contains(&c),
    comment_complaint: "the control's character set has no",
    active_comments: &[],
    percent_allowed: true,
    lower_case: false,
    slash_anywhere: false,
    checksum: false,
    line_end: 0,
    line_limit: None,
    limit_counts_all: true,
    addresses: [[0; 4]; 6],
    whole_numbers: letters(b"NOTDHSLMP"),
    unpointed: Unpointed::Least,
    largest_length: Some((99_999.999, 9999.9999)),
    largest_n: 99_999_999.0,
    largest_t: 99_999_999.0,
    largest_inverse: 99_999.999,
    most_m: 1,
    g,
    m,
    dwell: [Some((b'P', Dwell::Milliseconds)), Some((b'X', Dwell::ByPoint))],
    cycles: Some(CYCLES),
    tool_change: true,
    length_offset: true,
    length_by_d: false,
    radius_word: RadiusWord::Needed,
    length_word: b'H',
    length_needs_h: true,
    work_offset: true,
    offset_word: None,
    most_offsets: 48.0,
    reference_needs_axis: true,
    starts_at_rapid: false,
    repeat_motion: false,
    feed_modes: true,
    feed_reset: FeedReset::Change,
    rotary_feed: RotaryFeed::UnitsAsDegrees,
    blends: false,
    exact_code: "G61",
    radius_wins: true,
    stop_stands: false,
    shaky_half_circle: true,
    arc_offsets: *b"IJK",
    arc_radius: b'R',
    arc_absolute: false,
    arc_turns: false,
    cubic: Cubic::None,
    arc_needs_end: false,
    arc_end: ArcEnd::Spiral,
    arc_mode_stated: false,
    stated_difference: None,
    largest_difference: |_, _| 0.01,
    arc_complaint: "alarm PS0020, over tolerance of radius",
    full_circle_fuzz: 0.0,
    smallest_radius: 0.0,
    no_feed: "alarm PS0011, no feed commanded",
    unused: "no code in the block uses it",
};

/// Pecks and dwells in milliseconds; the distance back is parameter 5114 or 5115.
pub(in crate::readback::word) const CYCLES: Cycles = Cycles {
    level: b'R',
    bottom: b'Z',
    after: None,
    peck: b'Q',
    pecks_counted: false,
    dwell_word: b'P',
    dwell: Dwell::Milliseconds,
    with_dwell: &[
        CycleKind::Dwell,
        CycleKind::Tap { left: false },
        CycleKind::Tap { left: true },
        CycleKind::BoreDwell,
        CycleKind::Fine,
    ],
    clearance: 0.5,
    return_height: false,
    returns_to_level: None,
    repeats: Some(b'K'),
    needs_motion: false,
    starts_to_r: false,
    higher_return: false,
    bore_dwell_feeds_back: false,
};

pub(in crate::readback::word) fn g(tenths: u16) -> Option<G> {
    Some(match tenths {
        62 => G::Motion(Mode::NurbsKnots),
        430 => G::LengthOn,
        541 => G::WorkOffset(0),
        640 => G::NoEffect(Group::Path),
        800 => G::CycleEnd,
        950 => G::Feed(FeedMode::PerRevolution),
        150 | 501 | 500 | 670 | 690 | 131 => G::NoEffect(Group::Other),
        50 | 51 | 80 => G::NoEffect(Group::Once),
        970 => G::NoEffect(Group::Speed),
        980 | 990 => G::Return { to_r: tenths == 990 },
        410 | 420 => return iso::radius(tenths),
        _ => return iso::rs274(tenths).or_else(|| iso::cycle(tenths)).or_else(|| unfollowed(tenths)),
    })
}

fn unfollowed(tenths: u16) -> Option<G> {
    Some(G::Unfollowed(match tenths {
        24 | 34 | 330 => Group::Motion,
        71 | 90 | 100 | 110 | 270 | 290 | 310 | 520 | 600 | 650 | 920 => Group::Once,
        431 | 434 | 435 | 440 => Group::Length,
        620 | 630 => Group::Path,
        870 | 880 => Group::Motion,
        960 => Group::Speed,
        121 | 160 | 510 | 511 | 660 | 680 => Group::Other,
        _ => return None,
    }))
}

pub(in crate::readback::word) fn m(tenths: u16) -> Option<M> {
    Some(match tenths {
        60 => M::ToolChange,
        290 | 480 | 490 => M::NoEffect,
        190 | 980 | 990 | 1980 => M::Unfollowed,
        _ => return iso::m(tenths),
    })
}
