//! grblHAL, from its list of supported codes: Grbl with cycles, turns in arcs and tools.

use super::super::codes::{CycleKind, G, Group, M};
use super::super::cubic::Cubic;
use super::super::iso;
use super::super::rules::{Cycles, Dwell, Rules};
use super::{grbl, linuxcnc};

/// Tool tables are an option of the build, so that cuts need neither M6 nor G43.
pub(super) const RULES: Rules = Rules {
    name: "grblhal",
    g,
    m,
    cycles: Some(CYCLES),
    arc_turns: true,
    cubic: Cubic::Chords,
    ..grbl::RULES
};

const CYCLES: Cycles = Cycles {
    with_dwell: &[CycleKind::Dwell, CycleKind::BoreStop, CycleKind::BoreDwell],
    dwell: Dwell::Seconds,
    bore_dwell_feeds_back: false,
    ..linuxcnc::CYCLES
};

fn g(tenths: u16) -> Option<G> {
    Some(match tenths {
        730 | 810 | 820 | 830 | 850 | 860 | 890 => return iso::cycle(tenths),
        980 | 990 => G::Return { to_r: tenths == 990 },
        430 => G::LengthOn,
        591..=593 => G::WorkOffset(tenths - 584),
        970 => G::NoEffect(Group::Speed),
        500 => G::NoEffect(Group::Other),
        51 | 330 | 760 => G::Unfollowed(Group::Motion),
        432 => G::Unfollowed(Group::Length),
        510 => G::Unfollowed(Group::Other),
        _ => return grbl::g(tenths),
    })
}

fn m(tenths: u16) -> Option<M> {
    Some(match tenths {
        60 => M::ToolChange,
        _ => return iso::m(tenths),
    })
}
