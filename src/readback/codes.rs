//! Meanings of G and M codes, and the modal groups they belong to.

use super::FeedMode;

/// Working planes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Plane {
    /// G17.
    Xy,
    /// G18.
    Zx,
    /// G19.
    Yz,
}

/// Motions that stay in force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mode {
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
}

/// What a G code means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum G {
    /// A motion.
    Motion(Mode),
    /// G5.3: the curve that G5.2 opened is cut.
    NurbsEnd,
    /// G4.
    Dwell,
    /// Plane.
    Plane(Plane),
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
    /// G43.
    LengthOn,
    /// G49.
    LengthOff,
    /// G53.
    MachineCoordinates,
    /// G28/G30.
    Reference,
    /// G54 …
    WorkOffset,
    /// G61, G61.1.
    ExactPath,
    /// G64.
    Blend,
    /// G97, G98, G99, G69, G50, G5.1 Q0 and the like: no effect on the path in the form they are understood in.
    NoEffect(Group),
    /// The control knows it, this reader does not follow it.
    Unfollowed(Group),
}

/// Modal groups: two codes of one group in a block contradict each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Group {
    /// One-shot codes.
    Once,
    /// Motion.
    Motion,
    /// Plane.
    Plane,
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
    pub(super) fn name(self) -> &'static str {
        match self {
            Group::Once => "the one-shot codes",
            Group::Motion => "the motion codes",
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
    pub(super) fn group(self) -> Group {
        match self {
            G::Motion(_) | G::NurbsEnd => Group::Motion,
            G::Dwell | G::MachineCoordinates | G::Reference => Group::Once,
            G::Plane(_) => Group::Plane,
            G::Units { .. } => Group::Units,
            G::Distance { .. } => Group::Distance,
            G::ArcDistance { .. } => Group::ArcDistance,
            G::Feed(_) => Group::Feed,
            G::RadiusOff => Group::Radius,
            G::LengthOn | G::LengthOff => Group::Length,
            G::WorkOffset => Group::Offset,
            G::ExactPath | G::Blend => Group::Path,
            G::NoEffect(group) | G::Unfollowed(group) => group,
        }
    }
}

/// What an M code means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum M {
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
    CoolantOn,
    /// M9.
    CoolantOff,
    /// M48 and the like.
    NoEffect,
    /// The control knows it, this reader does not follow it.
    Unfollowed,
}

impl M {
    /// Index of its modal group among the M codes.
    pub(super) fn group(self) -> u8 {
        match self {
            M::Stop { .. } | M::End => 0,
            M::SpindleOn { .. } | M::SpindleOff => 1,
            M::ToolChange => 2,
            M::CoolantOn | M::CoolantOff => 3,
            M::NoEffect => 5,
            M::Unfollowed => 6,
        }
    }
}
