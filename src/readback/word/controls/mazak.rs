//! Mazak EIA, from a published post and a programming manual.

use super::super::codes::{G, Group};
use super::super::rules::{Dwell, Rules};
use super::fanuc;

/// At most 248 characters in a block; a decimal point on an integer address is dropped, which changes its meaning.
pub(super) const RULES: Rules = Rules {
    name: "mazak",
    line_limit: Some(248),
    g,
    dwell: [Some((b'P', Dwell::Milliseconds)), Some((b'X', Dwell::ByPoint))],
    largest_difference: |_, _| 0.005,
    arc_complaint: "the arc's end is off its circle",
    no_feed: "no feed commanded",
    ..fanuc::RULES
};

fn g(tenths: u16) -> Option<G> {
    Some(match tenths {
        62 => return None,
        611 => G::ExactPath,
        // High-speed machining: G5 P2, P0.
        50 => G::NoEffect(Group::Once),
        _ => return fanuc::g(tenths),
    })
}
