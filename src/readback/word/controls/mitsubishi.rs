//! Mitsubishi M70, M80 and M700V, from published posts and a programming manual.

use super::super::codes::G;
use super::super::rules::{Cycles, Rules, Unpointed};
use super::fanuc;

/// Whether a number without a point counts units or least increments is parameter 1078.
pub(super) const RULES: Rules = Rules {
    name: "mitsubishi",
    unpointed: Unpointed::Setting,
    g,
    cycles: Some(CYCLES),
    largest_difference: |_, _| 0.005,
    arc_complaint: "alarm P70, the arc's end is off its circle",
    no_feed: "alarm P62, no feed commanded",
    ..fanuc::RULES
};

const CYCLES: Cycles = Cycles { repeats: Some(b'L'), ..fanuc::CYCLES };

fn g(tenths: u16) -> Option<G> {
    Some(match tenths {
        611 => G::ExactPath,
        _ => return fanuc::g(tenths),
    })
}
