//! Mach3 and Mach4, from what is known of their settings.

use super::super::codes::{G, Group, Mode};
use super::super::rules::{Cycles, Dwell, FeedReset, Frame, Rules, Unpointed};
use super::linuxcnc;

/// With `G04 Dwell param in Milliseconds` off. What I J K count from is a setting, too, so that an arc needs G90.1 or
/// G91.1; without G61 (or under G64) corners are cut without a bound.
pub(super) const RULES: Rules = Rules {
    name: "mach3",
    frame: Frame::OptionalNumber,
    comment_character: |c| (b' '..0x7f).contains(&c),
    active_comments: &["MSG,"],
    line_limit: None,
    largest_n: 99_999.0,
    largest_t: 253.0,
    unpointed: Unpointed::Whole,
    most_m: 4,
    g,
    cycles: Some(SECONDS),
    arc_turns: false,
    arc_mode_stated: true,
    feed_reset: FeedReset::Change,
    largest_difference: |_, inch| if inch { 0.005_08 } else { 0.002 },
    arc_complaint: "Radius to end of arc differs from radius to start",
    ..linuxcnc::RULES
};

/// With `G04 Dwell param in Milliseconds` on.
pub(super) const MILLISECONDS: Rules = Rules {
    name: "mach3-ms",
    dwell: [Some((b'P', Dwell::Milliseconds)), None],
    cycles: Some(CYCLES),
    ..RULES
};

const SECONDS: Cycles = Cycles { bore_dwell_feeds_back: false, ..linuxcnc::CYCLES };
const CYCLES: Cycles = Cycles { dwell: Dwell::Milliseconds, ..SECONDS };

fn g(tenths: u16) -> Option<G> {
    Some(match tenths {
        52 | 53 | 74 | 591..=593 | 740 | 760 | 80 | 611 => return None,
        800 => G::Motion(Mode::None),
        150 | 500 => G::NoEffect(Group::Other),
        _ => return linuxcnc::g(tenths),
    })
}
