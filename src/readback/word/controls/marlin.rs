//! Marlin and Smoothieware, from their command references.

use super::super::codes::{G, Group, M, Mode};
use super::super::iso;
use super::super::rules::{ArcEnd, Dwell, FeedReset, Frame, Rules};
use super::grbl;

/// Codes must be repeated (keeping the last motion is an option of the build), arcs end at their end point's angle, and
/// M30 would delete a file.
pub(super) const RULES: Rules = Rules {
    name: "marlin",
    frame: Frame::Free,
    parentheses: false,
    comment_character: |c| (b' '..0x7f).contains(&c),
    comment_complaint: "the host may stop at",
    percent_allowed: false,
    lower_case: false,
    slash_anywhere: false,
    checksum: true,
    line_limit: Some(96),
    limit_counts_all: true,
    largest_n: 2_147_483_647.0,
    g,
    m,
    dwell: [Some((b'S', Dwell::Seconds)), Some((b'P', Dwell::Milliseconds))],
    work_offset: false,
    starts_at_rapid: false,
    repeat_motion: true,
    feed_modes: false,
    feed_reset: FeedReset::Change,
    arc_needs_end: false,
    arc_end: ArcEnd::Angle,
    largest_difference: |_, _| f64::INFINITY,
    full_circle_fuzz: 0.0,
    smallest_radius: 0.0,
    no_feed: "no feed commanded",
    unused: "no code in the block uses it",
    ..grbl::RULES
};

/// Smoothieware, `grbl_mode` off: P counts milliseconds.
pub(super) const SMOOTHIEWARE: Rules = Rules { name: "smoothieware", line_limit: None, g: smoothie, ..RULES };

/// Smoothieware, `grbl_mode` on: P counts seconds.
pub(super) const SMOOTHIEWARE_GRBL: Rules = Rules {
    name: "smoothieware-grbl",
    dwell: [Some((b'P', Dwell::Seconds)), Some((b'S', Dwell::Seconds))],
    ..SMOOTHIEWARE
};

fn g(tenths: u16) -> Option<G> {
    Some(match tenths {
        200 | 210 => G::Units { inch: tenths == 200 },
        280 => G::Reference,
        50 | 60 => G::Unfollowed(Group::Motion),
        100 | 110 | 270 | 290 | 300 | 382..=385 | 920 => G::Unfollowed(Group::Once),
        800 => G::Motion(Mode::None),
        _ => return iso::g(tenths).or_else(|| iso::offset(tenths)),
    })
}

/// Smoothieware knows Grbl's modes beside Marlin's.
fn smoothie(tenths: u16) -> Option<G> {
    Some(match tenths {
        400 => G::RadiusOff,
        490 => G::LengthOff,
        940 => G::NoEffect(Group::Feed),
        50 => return None,
        _ => return g(tenths),
    })
}

fn m(tenths: u16) -> Option<M> {
    Some(match tenths {
        // Motors off, wait for moves to finish, absolute E: nothing that moves.
        180 | 840 | 820 | 4000 => M::NoEffect,
        // M30 deletes a file, and no code ends a program.
        20 | 300 => return None,
        _ => return iso::m(tenths),
    })
}
