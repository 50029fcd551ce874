//! LinuxCNC, from its G-code reference and the behaviour of its interpreter.

use super::super::codes::{CycleKind, G, Group, M, Mode};
use super::super::cubic::Cubic;
use super::super::iso;
use super::super::rules::{
    ArcEnd, Cycles, Dwell, FeedReset, Frame, Language, RadiusWord, RotaryFeed, Rules, Unpointed,
};
use crate::readback::FeedMode;

pub(super) const RULES: Rules = Rules {
    name: "linuxcnc",
    language: Language::Iso,
    frame: Frame::PercentPairOrEnd,
    parentheses: true,
    semicolon_comment: true,
    comment_may_stay_open: false,
    comment_may_nest: false,
    comment_character: |c| c != 0,
    comment_complaint: "the control stops at",
    active_comments: &[
        "DEBUG,",
        "PRINT,",
        "LOG,",
        "LOGOPEN,",
        "LOGAPPEND,",
        "LOGCLOSE",
        "PROBEOPEN",
        "PROBECLOSE",
    ],
    percent_allowed: true,
    lower_case: true,
    slash_anywhere: false,
    checksum: false,
    line_end: 0,
    line_limit: Some(255),
    limit_counts_all: true,
    addresses: [[0; 4]; 6],
    whole_numbers: 0,
    unpointed: Unpointed::Whole,
    largest_length: None,
    largest_n: 99_999_999.0,
    largest_t: 2_147_483_647.0,
    largest_inverse: f64::INFINITY,
    most_m: 4,
    g,
    m,
    dwell: [Some((b'P', Dwell::Seconds)), None],
    cycles: Some(CYCLES),
    tool_change: true,
    length_offset: true,
    length_by_d: false,
    radius_word: RadiusWord::Free,
    length_word: b'H',
    length_needs_h: false,
    work_offset: true,
    offset_word: None,
    most_offsets: 48.0,
    reference_needs_axis: false,
    starts_at_rapid: false,
    repeat_motion: false,
    feed_modes: true,
    feed_reset: FeedReset::EveryWord,
    rotary_feed: RotaryFeed::LinearAxes,
    blends: true,
    exact_code: "G61",
    radius_wins: false,
    stop_stands: false,
    shaky_half_circle: false,
    arc_turns: true,
    cubic: Cubic::Exact,
    arc_needs_end: false,
    arc_end: ArcEnd::Spiral,
    arc_offsets: *b"IJK",
    arc_radius: b'R',
    arc_absolute: false,
    arc_mode_stated: false,
    stated_difference: None,
    // The manual's bound, which is tighter than the source's.
    largest_difference: iso::radius_difference,
    arc_complaint: "Radius to end of arc differs from radius to start",
    full_circle_fuzz: 1e-6,
    smallest_radius: 0.001_27,
    no_feed: "with zero feed rate",
    unused: "no code in the block uses it",
};

/// The distance back is a setting of 0.010 in; newer versions take a D word for it, which older ones refuse.
pub(super) const CYCLES: Cycles = Cycles {
    level: b'R',
    bottom: b'Z',
    after: None,
    peck: b'Q',
    pecks_counted: false,
    dwell_word: b'P',
    dwell: Dwell::Seconds,
    with_dwell: &[
        CycleKind::Dwell,
        CycleKind::Tap { left: false },
        CycleKind::Tap { left: true },
        CycleKind::BoreStop,
        CycleKind::BoreDwell,
    ],
    clearance: 0.254,
    return_height: false,
    returns_to_level: None,
    repeats: Some(b'L'),
    needs_motion: true,
    starts_to_r: true,
    higher_return: true,
    bore_dwell_feeds_back: true,
};

pub(super) fn g(tenths: u16) -> Option<G> {
    Some(match tenths {
        52 => G::Motion(Mode::NurbsPoints),
        53 => G::NurbsEnd,
        430 => G::LengthOn,
        591..=593 => G::WorkOffset(tenths - 584),
        611 => G::ExactPath,
        640 => G::Blend,
        800 => G::CycleEnd,
        901 => G::ArcDistance { incremental: false },
        911 => G::ArcDistance { incremental: true },
        950 => G::Feed(FeedMode::PerRevolution),
        970 => G::NoEffect(Group::Speed),
        980 | 990 => G::Return { to_r: tenths == 990 },
        80 => G::NoEffect(Group::Other),
        410 | 420 => return iso::radius(tenths),
        760 => return unfollowed(tenths),
        _ => {
            return iso::rs274(tenths).or_else(|| iso::cycle(tenths)).or_else(|| unfollowed(tenths));
        }
    })
}

fn unfollowed(tenths: u16) -> Option<G> {
    Some(G::Unfollowed(match tenths {
        50 | 51 | 330 | 331 | 382..=385 | 760 | 870 | 880 => Group::Motion,
        70 => Group::Other,
        100 | 281 | 301 | 520 | 920..=923 => Group::Once,
        411 | 421 => Group::Radius,
        431 | 432 => Group::Length,
        171 | 181 | 191 => Group::Plane,
        960 => Group::Speed,
        _ => return None,
    }))
}

fn m(tenths: u16) -> Option<M> {
    Some(match tenths {
        60 => M::ToolChange,
        480 | 490 | 500 | 510 | 520 | 530 => M::NoEffect,
        190 | 600..=730 | 980 | 990 | 1000..=1990 => M::Unfollowed,
        _ => return iso::m(tenths),
    })
}
