//! Meanings of G and M codes, and the modal groups they belong to.

use crate::readback::FeedMode;

/// Motions that stay in force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::readback) enum Mode {
    /// No motion code in force (G80).
    None,
    /// G0.
    Rapid,
    /// G1.
    Linear,
    /// G2, G3.
    Arc {
        /// G2.
        clockwise: bool,
    },
    /// G5.2: control points follow.
    NurbsPoints,
    /// G06.2: knots and control points follow.
    NurbsKnots,
    /// BSPLINE: control points with PW follow, until another motion.
    BSpline,
    /// G5: a cubic piece in each block.
    Cubic,
    /// POLY: a polynomial in each block.
    Polynomial,
    /// CIP: a circle through a place between.
    Through,
    /// A drilling cycle.
    Cycle(CycleKind),
}

/// What a drilling cycle does at the bottom of a hole and on the way there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::readback) enum CycleKind {
    /// G81: down at feed, up at rapid.
    Drill,
    /// G82: as G81 with a dwell.
    Dwell,
    /// G83: in pecks, out of the hole after each.
    Deep,
    /// G73: in pecks, back by a little after each.
    ChipBreak,
    /// G84 (right), G74 (left): up at feed with the spindle reversed.
    Tap {
        /// G74.
        left: bool,
    },
    /// G85: up at feed.
    Bore,
    /// G89: as G85 with a dwell.
    BoreDwell,
    /// G86: spindle stopped at the bottom, up at rapid.
    BoreStop,
    /// G76: spindle stopped and oriented, tool moved off the wall by Q, up at rapid.
    Fine,
}

/// What a G code means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::readback) enum G {
    /// A motion.
    Motion(Mode),
    /// G80 where another motion may stand beside it, and wins.
    CycleEnd,
    /// G5.3: the curve that G5.2 opened is cut.
    NurbsEnd,
    /// G4.
    Dwell,
    /// Plane.
    Plane(crate::readback::curve::Plane),
    /// G20/G21.
    Units {
        /// G20.
        inch: bool,
    },
    /// G90/G91.
    Distance {
        /// G91.
        incremental: bool,
    },
    /// G90.1/G91.1.
    ArcDistance {
        /// G91.1.
        incremental: bool,
    },
    /// G93–G95.
    Feed(FeedMode),
    /// G40.
    RadiusOff,
    /// G41, G42.
    Radius {
        /// The side of the path to which the cutter is moved.
        side: crate::geom::Side,
    },
    /// G43.
    LengthOn,
    /// G49.
    LengthOff,
    /// G53.
    MachineCoordinates,
    /// G28/G30.
    Reference,
    /// G54 … by number from 1; 0: the number is in a word.
    WorkOffset(u16),
    /// G98 (back to the initial height) and G99 (back to R).
    Return {
        /// G99.
        to_r: bool,
    },
    /// G71 Z: the height that M53 returns to (Okuma).
    ReturnHeight,
    /// G61, G61.1.
    ExactPath,
    /// G64.
    Blend,
    /// COMPCAD and the like: the path is replaced by a smooth one within the contour tolerance.
    Compressor,
    /// G187 P E: E is how far corners may be rounded (Haas).
    Smoothing,
    /// G97, G98, G99, G69, G50, G5.1 Q0 and the like: no effect on the path in the form they are understood in.
    NoEffect(Group),
    /// The control knows it, this reader does not follow it.
    Unfollowed(Group),
}

/// Modal groups: two codes of one group in a block contradict each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::readback) enum Group {
    /// One-shot codes.
    Once,
    /// Motion.
    Motion,
    /// Plane.
    Plane,
    /// G80, where it is apart from the motions.
    CycleEnd,
    /// G90 G91.
    Distance,
    /// G90.1 G91.1.
    ArcDistance,
    /// Feed mode.
    Feed,
    /// Units.
    Units,
    /// Cutter radius compensation.
    Radius,
    /// Tool length.
    Length,
    /// Return level of cycles.
    Return,
    /// Work offset.
    Offset,
    /// Path control.
    Path,
    /// Spindle speed mode.
    Speed,
    /// Groups of one code each, which contradict nothing.
    Other,
}

impl Group {
    /// What the messages call it.
    pub(in crate::readback) fn name(self) -> &'static str {
        match self {
            Group::Once => "the one-shot codes",
            Group::Motion => "the motion codes",
            Group::CycleEnd => "the end of cycles",
            Group::Plane => "the planes",
            Group::Distance => "G90 and G91",
            Group::ArcDistance => "G90.1 and G91.1",
            Group::Feed => "the feed modes",
            Group::Units => "G20 and G21",
            Group::Radius => "cutter compensation",
            Group::Length => "tool length",
            Group::Return => "G98 and G99",
            Group::Offset => "the work offsets",
            Group::Path => "path control",
            Group::Speed => "G96 and G97",
            Group::Other => "its group",
        }
    }
}

impl G {
    /// Its modal group.
    pub(in crate::readback) fn group(self) -> Group {
        match self {
            G::Motion(_) | G::NurbsEnd => Group::Motion,
            G::CycleEnd => Group::CycleEnd,
            G::Dwell | G::MachineCoordinates | G::Reference | G::ReturnHeight => Group::Once,
            G::Plane(_) => Group::Plane,
            G::Units { .. } => Group::Units,
            G::Distance { .. } => Group::Distance,
            G::ArcDistance { .. } => Group::ArcDistance,
            G::Feed(_) => Group::Feed,
            G::RadiusOff | G::Radius { .. } => Group::Radius,
            G::LengthOn | G::LengthOff => Group::Length,
            G::WorkOffset(_) => Group::Offset,
            G::Return { .. } => Group::Return,
            G::ExactPath | G::Blend | G::Smoothing => Group::Path,
            G::Compressor => Group::Other,
            G::NoEffect(group) | G::Unfollowed(group) => group,
        }
    }
}

/// What an M code means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::readback) enum M {
    /// M0, M1.
    Stop {
        /// M1.
        optional: bool,
    },
    /// M2, M30.
    End,
    /// M3, M4.
    SpindleOn {
        /// M3.
        clockwise: bool,
    },
    /// M5.
    SpindleOff,
    /// M6.
    ToolChange,
    /// M7, M8.
    CoolantOn {
        /// M7.
        mist: bool,
    },
    /// M9.
    CoolantOff,
    /// M9 where coolant through the tool has a code of its own to end it.
    WashOff,
    /// M88 and the like: coolant through the tool.
    ThroughOn,
    /// M89 and the like.
    ThroughOff,
    /// M53 and M54: cycles return to the height of G71, or to R (Okuma).
    CycleReturn {
        /// M54.
        to_r: bool,
    },
    /// M48 and the like.
    NoEffect,
    /// The control knows it, this reader does not follow it.
    Unfollowed,
}

impl M {
    /// Index of its modal group among the M codes.
    pub(in crate::readback) fn group(self) -> u8 {
        match self {
            M::Stop { .. } | M::End => 0,
            M::SpindleOn { .. } | M::SpindleOff => 1,
            M::ToolChange => 2,
            M::CoolantOn { .. } | M::CoolantOff | M::WashOff | M::ThroughOn | M::ThroughOff => 3,
            M::NoEffect => 5,
            M::CycleReturn { .. } => 7,
            M::Unfollowed => 6,
        }
    }
}
