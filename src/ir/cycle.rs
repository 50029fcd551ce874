//! Drilling cycles.

use super::Feed;

/// A drilling cycle, with everything that a hole needs but its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cycle {
    /// How the hole is made.
    pub kind: CycleKind,
    /// Depth below the hole's point, mm, > 0.
    pub depth: f64,
    /// Clearance level above the hole's point (R), mm, >= 0.
    pub clearance: f64,
    /// Where the tool goes after each hole.
    pub retract: RetractTo,
    /// Largest depth of one peck, mm; asked for by `Deep` and `ChipBreak`.
    pub peck: Option<f64>,
    /// Depth of the first peck, mm, where it differs.
    pub first_peck: Option<f64>,
    /// Dwell at the bottom, s.
    pub dwell: Option<f64>,
    /// Feed into the hole. For tapping it follows from the pitch and is not read.
    pub feed: Feed,
}

/// Kinds of cycle. In brackets the code of the word-address controls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CycleKind {
    /// To the bottom at feed, back at rapid (G81).
    Drill,
    /// As `Drill`, with a dwell at the bottom: spot facing, counterboring (G82).
    Dwell,
    /// By pecks, each retracted to the clearance level (G83).
    Deep,
    /// By pecks, the chip broken by a short retract (G73).
    ChipBreak,
    /// Tapping: out with the spindle reversed (G84, left-hand G74).
    Tap {
        /// Pitch, mm.
        pitch: f64,
        /// Left-hand thread.
        left: bool,
    },
    /// Boring and reaming: in and out at feed (G85).
    Bore,
    /// As `Bore`, with a dwell at the bottom (G89).
    BoreDwell,
    /// In at feed, the spindle stops, out at rapid (G86).
    BoreStop,
    /// In at feed, the spindle stops oriented, the tool moves off the wall, out at rapid (G76).
    BoreOrient {
        /// Move off the wall, mm.
        shift: f64,
    },
}

/// Where the tool goes after each hole.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RetractTo {
    /// To the clearance level (G99).
    Clearance,
    /// To the height at which the cycle began (G98).
    Initial,
}

/// A kind of cycle as a control's list of cycles names it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CycleName {
    /// [`CycleKind::Drill`].
    Drill,
    /// [`CycleKind::Dwell`].
    Dwell,
    /// [`CycleKind::Deep`].
    Deep,
    /// [`CycleKind::ChipBreak`].
    ChipBreak,
    /// [`CycleKind::Tap`], right-hand.
    Tap,
    /// [`CycleKind::Tap`], left-hand.
    TapLeft,
    /// [`CycleKind::Bore`].
    Bore,
    /// [`CycleKind::BoreDwell`].
    BoreDwell,
    /// [`CycleKind::BoreStop`].
    BoreStop,
    /// [`CycleKind::BoreOrient`].
    BoreOrient,
}

impl CycleName {
    /// All names.
    pub const ALL: [CycleName; 10] = [
        CycleName::Drill,
        CycleName::Dwell,
        CycleName::Deep,
        CycleName::ChipBreak,
        CycleName::Tap,
        CycleName::TapLeft,
        CycleName::Bore,
        CycleName::BoreDwell,
        CycleName::BoreStop,
        CycleName::BoreOrient,
    ];

    /// The name as data files spell it.
    #[must_use]
    pub fn text(self) -> &'static str {
        match self {
            CycleName::Drill => "drill",
            CycleName::Dwell => "dwell",
            CycleName::Deep => "deep",
            CycleName::ChipBreak => "chip-break",
            CycleName::Tap => "tap",
            CycleName::TapLeft => "tap-left",
            CycleName::Bore => "bore",
            CycleName::BoreDwell => "bore-dwell",
            CycleName::BoreStop => "bore-stop",
            CycleName::BoreOrient => "bore-orient",
        }
    }

    /// The name spelt so.
    #[must_use]
    pub fn by_text(text: &str) -> Option<CycleName> {
        CycleName::ALL.into_iter().find(|n| n.text() == text)
    }
}

impl CycleKind {
    /// Its name.
    #[must_use]
    pub fn name(self) -> CycleName {
        match self {
            CycleKind::Drill => CycleName::Drill,
            CycleKind::Dwell => CycleName::Dwell,
            CycleKind::Deep => CycleName::Deep,
            CycleKind::ChipBreak => CycleName::ChipBreak,
            CycleKind::Tap { left: false, .. } => CycleName::Tap,
            CycleKind::Tap { left: true, .. } => CycleName::TapLeft,
            CycleKind::Bore => CycleName::Bore,
            CycleKind::BoreDwell => CycleName::BoreDwell,
            CycleKind::BoreStop => CycleName::BoreStop,
            CycleKind::BoreOrient { .. } => CycleName::BoreOrient,
        }
    }
}
