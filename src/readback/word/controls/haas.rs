//! Haas mill, next generation control, from its published post and code lists.

use super::super::block::letters;
use super::super::codes::{G, Group, M};
use super::super::rules::{Cycles, Dwell, Rules};
use super::fanuc;

/// P of a dwell is in seconds with a decimal point and in milliseconds without; F under G93 ends at 9999; M0 and M1 stop the
/// spindle and the coolant.
pub(super) const RULES: Rules = Rules {
    name: "haas",
    whole_numbers: letters(b"NOTDHSLM"),
    most_offsets: 99.0,
    largest_t: 200.0,
    largest_inverse: 9999.0,
    g,
    m,
    dwell: [Some((b'P', Dwell::ByPoint)), None],
    cycles: Some(CYCLES),
    radius_wins: false,
    stop_stands: true,
    largest_difference: |_, _| 0.005,
    arc_complaint: "the arc's end is off its circle",
    no_feed: "alarm 309, no feed commanded",
    ..fanuc::RULES
};

const CYCLES: Cycles = Cycles { dwell: Dwell::ByPoint, repeats: Some(b'L'), ..fanuc::CYCLES };

fn g(tenths: u16) -> Option<G> {
    Some(match tenths {
        62 | 501 | 131 | 150 => return None,
        1540 => G::WorkOffset(0),
        1870 => G::Smoothing,
        120 | 130 => G::Unfollowed(Group::Once),
        1030 => G::NoEffect(Group::Once),
        1070 | 1120 | 1130 | 2340 | 2350 | 2540 | 2550 => G::Unfollowed(Group::Other),
        _ => return fanuc::g(tenths),
    })
}

fn m(tenths: u16) -> Option<M> {
    Some(match tenths {
        // Air blast, through-spindle and through-tool air, chip conveyor.
        830 | 840 | 730 | 740 | 310 | 330 => M::NoEffect,
        880 => M::ThroughOn,
        890 => M::ThroughOff,
        90 => M::WashOff,
        970 => M::Unfollowed,
        _ => return fanuc::m(tenths),
    })
}
