//! Okuma OSP machining centres, from a published post and programming manuals.

use super::super::block::letters;
use super::super::codes::{G, Group, M};
use super::super::rules::{Cycles, Dwell, Frame, Rules, Unpointed};
use super::fanuc;

/// Work offsets are G15 H, tool lengths G56 H (G53 cancels them), cycles return to the height of G71 by M53.
pub(super) const RULES: Rules = Rules {
    name: "okuma",
    frame: Frame::Name,
    whole_numbers: letters(b"NTDHSM"),
    unpointed: Unpointed::Setting,
    largest_n: 99_999.0,
    most_m: 8,
    most_offsets: 100.0,
    g,
    m,
    dwell: [Some((b'F', Dwell::Seconds)), None],
    cycles: Some(CYCLES),
    length_needs_h: true,
    radius_wins: false,
    largest_difference: |_, _| 0.02,
    arc_complaint: "alarm B 2252, the arc's radii differ",
    no_feed: "no feed commanded",
    ..fanuc::RULES
};

const CYCLES: Cycles =
    Cycles { dwell: Dwell::Seconds, return_height: true, repeats: Some(b'L'), ..fanuc::CYCLES };

fn g(tenths: u16) -> Option<G> {
    Some(match tenths {
        150 => G::WorkOffset(0),
        160 => G::MachineCoordinates,
        560 => G::LengthOn,
        530 => G::LengthOff,
        710 => G::ReturnHeight,
        930 | 541 | 62 | 280 | 430 | 490 | 540 | 550 | 570..=590 | 980 | 990 => return None,
        1310 => G::NoEffect(Group::Other),
        _ => return fanuc::g(tenths),
    })
}

fn m(tenths: u16) -> Option<M> {
    Some(match tenths {
        530 | 540 => M::CycleReturn { to_r: tenths == 540 },
        520 => M::Unfollowed,
        _ => return fanuc::m(tenths),
    })
}
