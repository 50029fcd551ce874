//! Centroid M-series mills, from a published post.

use super::super::block::letters;
use super::super::codes::{G, Group};
use super::super::rules::{Cycles, Dwell, Frame, Rules, Unpointed};
use super::fanuc;

/// Dwells are in seconds, work offsets G54 to G59 or E1 to E18.
pub(super) const RULES: Rules = Rules {
    name: "centroid",
    frame: Frame::OptionalNumber,
    semicolon_comment: true,
    comment_character: |c| (b' '..0x7f).contains(&c),
    whole_numbers: letters(b"NOTDHSLM"),
    unpointed: Unpointed::Setting,
    offset_word: Some(b'E'),
    most_offsets: 18.0,
    g,
    dwell: [Some((b'P', Dwell::Seconds)), None],
    cycles: Some(CYCLES),
    radius_wins: false,
    largest_difference: |_, _| 0.005,
    arc_complaint: "the arc's end is off its circle",
    no_feed: "no feed commanded",
    ..fanuc::RULES
};

const CYCLES: Cycles = Cycles { dwell: Dwell::Seconds, repeats: Some(b'L'), ..fanuc::CYCLES };

fn g(tenths: u16) -> Option<G> {
    Some(match tenths {
        62 | 541 | 930 => return None,
        1870 => G::NoEffect(Group::Path),
        _ => return fanuc::g(tenths),
    })
}
