//! What tells one word-address control from another, as this reader sees it.

use super::codes::{CycleKind, G, M};

/// The frame of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::readback) enum Frame {
    /// `%` first and last, O number after the first.
    PercentAndNumber,
    /// O and at most four letters and digits first, M2 or M30 last; `%` is no part of it.
    Name,
    /// As [`Frame::PercentPairOrEnd`] with M2 or M30 in any case; an O number may stand first.
    OptionalNumber,
    /// If it starts with `%` it must end with one; else M2 or M30 must stand in it.
    PercentPairOrEnd,
    /// Nothing first, M2 or M30 last.
    End,
    /// None.
    Free,
}

/// What a length without a decimal point means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::readback) enum Unpointed {
    /// Whole units, as on paper.
    Whole,
    /// Least increments: 0.001 mm, 0.0001 in, 0.001 deg.
    Least,
    /// One or the other, by a setting of the control.
    Setting,
}

/// What a dwell's number counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::readback) enum Dwell {
    /// Seconds.
    Seconds,
    /// Milliseconds.
    Milliseconds,
    /// Seconds with a decimal point, milliseconds without.
    ByPoint,
    /// Revolutions of the spindle.
    Revolutions,
}

impl Dwell {
    /// Seconds of `value`; `None` where the spindle must turn and doesn't.
    pub(super) fn seconds(self, value: f64, pointed: bool, speed: f64) -> Option<f64> {
        match self {
            Dwell::Seconds => Some(value),
            Dwell::Milliseconds => Some(value / 1000.0),
            Dwell::ByPoint => Some(if pointed { value } else { value / 1000.0 }),
            Dwell::Revolutions => (speed > 0.0).then(|| 60.0 * value / speed),
        }
    }
}

/// When the feed in force is forgotten.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::readback) enum FeedReset {
    /// When the feed mode changes.
    Change,
    /// At every G93, G94, G95.
    EveryWord,
}

/// What F means when a linear and a rotary axis move together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::readback) enum RotaryFeed {
    /// The speed of the linear axes if one moves, else degrees a minute.
    LinearAxes,
    /// One degree counts as one unit of length.
    UnitsAsDegrees,
    /// One degree counts as one millimetre, in inch programs too.
    MillimetresAsDegrees,
}

/// What the control makes of an arc whose end is not on its circle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::readback) enum ArcEnd {
    /// A radius that changes with the angle, within the control's limit.
    Spiral,
    /// The arc ends at the end point's angle with the start's radius, and a line leads on to the point.
    Angle,
}

/// How drilling cycles are programmed and worked off.
#[derive(Debug)]
pub(in crate::readback) struct Cycles {
    /// Unit of the dwell word P.
    pub dwell: Dwell,
    /// Cycles that take a dwell.
    pub with_dwell: &'static [CycleKind],
    /// The distance by which chips are broken, and before the last depth at which the rapid down stops, mm: a setting of
    /// the control at its usual value.
    pub clearance: f64,
    /// The height of return is said by G71 Z and M53 (Okuma), not by G98.
    pub return_height: bool,
    /// Letter of the repeat count.
    pub repeats: u8,
    /// G99 is in force before G98 or G99 is said.
    pub starts_to_r: bool,
    /// A cycle block must move an axis.
    pub needs_motion: bool,
    /// A hole below the initial height is reached at `R` or the initial height, whichever is higher, under G98.
    pub higher_return: bool,
    /// G89 goes all the way back at feed.
    pub bore_dwell_feeds_back: bool,
}

/// Ways to cut a line into words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::readback) enum Language {
    /// Letters with numbers.
    Iso,
    /// SINUMERIK: also names, `=` and calls.
    Sinumerik,
}

/// How a control words its faults and what it refuses.
#[derive(Debug)]
pub(in crate::readback) struct Rules {
    /// Name, as in `--post` data's `control`.
    pub name: &'static str,
    /// How lines are cut.
    pub language: Language,
    /// Program frame.
    pub frame: Frame,
    /// `(` starts a comment.
    pub parentheses: bool,
    /// `;` starts a comment.
    pub semicolon_comment: bool,
    /// A comment that is not closed ends with its line.
    pub comment_may_stay_open: bool,
    /// `(` inside a comment is nothing special.
    pub comment_may_nest: bool,
    /// Characters a comment may hold.
    pub comment_character: fn(u8) -> bool,
    /// What is wrong with one that it may not.
    pub comment_complaint: &'static str,
    /// Comments that begin so are commands.
    pub active_comments: &'static [&'static str],
    /// A lone `%` is part of the frame.
    pub percent_allowed: bool,
    /// Lower-case letters are words.
    pub lower_case: bool,
    /// `/` is skipped wherever it stands; else it must be the first of the block.
    pub slash_anywhere: bool,
    /// A checksum `*nn` may close a numbered line.
    pub checksum: bool,
    /// Longest block, if there is a limit.
    pub line_limit: Option<usize>,
    /// The limit counts comments and blanks too.
    pub limit_counts_all: bool,
    /// Letters whose numbers must not carry a point.
    pub whole_numbers: &'static [u8],
    /// What numbers without a point mean.
    pub unpointed: Unpointed,
    /// Largest length in a word, in the unit in force, if there is a limit: mm, inch.
    pub largest_length: Option<(f64, f64)>,
    /// Largest sequence number.
    pub largest_n: f64,
    /// Largest tool number.
    pub largest_t: f64,
    /// Largest inverse time feed.
    pub largest_inverse: f64,
    /// Most M codes in a block.
    pub most_m: usize,
    /// G code in tenths to its meaning; `None`: the control does not know it.
    pub g: fn(u16) -> Option<G>,
    /// M code in tenths to its meaning.
    pub m: fn(u16) -> Option<M>,
    /// Dwell words in order of precedence, with their units.
    pub dwell: &'static [(u8, Dwell)],
    /// Drilling cycles, if the control has them.
    pub cycles: Option<&'static Cycles>,
    /// Tools are changed by `T M6`, so that a cut without one is wrong.
    pub tool_change: bool,
    /// Tool length is taken in by G43, so that a cut without it is wrong.
    pub length_offset: bool,
    /// Lengths are taken in by D words, D0 leaves them out.
    pub length_by_d: bool,
    /// G43 needs an H word.
    pub length_needs_h: bool,
    /// Work offsets are selected by the program, so that moving without one leaves it to what was in force.
    pub work_offset: bool,
    /// A word that selects a work offset by itself.
    pub offset_word: Option<u8>,
    /// Largest number of further work offsets.
    pub most_offsets: f64,
    /// G28 must name an axis.
    pub reference_needs_axis: bool,
    /// The control starts with G0 in force; otherwise no motion code is.
    pub starts_at_rapid: bool,
    /// The motion code must be repeated in every block.
    pub repeat_motion: bool,
    /// There are feed modes that a program must choose from.
    pub feed_modes: bool,
    /// When the feed is forgotten.
    pub feed_reset: FeedReset,
    /// F with a linear and a rotary axis.
    pub rotary_feed: RotaryFeed,
    /// A path tolerance must be asked for (G61, G64 P): without, the deviation has no bound.
    pub blends: bool,
    /// The code of the exact path, for messages.
    pub exact_code: &'static str,
    /// R and I J K in one arc: `true`, R wins; `false`, it is a fault.
    pub radius_wins: bool,
    /// An arc by R of nearly half a turn can't be computed reliably.
    pub shaky_half_circle: bool,
    /// `P` in an arc is a number of turns.
    pub arc_turns: bool,
    /// An arc needs an end word in its plane.
    pub arc_needs_end: bool,
    /// What becomes of an end beside the circle.
    pub arc_end: ArcEnd,
    /// G90.1 or G91.1 must be stated before an arc: the control's default is a setting.
    pub arc_mode_stated: bool,
    /// Largest difference of an arc's radii, mm, at this (larger) radius, and whether the program is in inches.
    pub largest_difference: fn(f64, bool) -> f64,
    /// What the control says when an arc's radii differ by more.
    pub arc_complaint: &'static str,
    /// Sweep below which an arc is a full circle, radians.
    pub full_circle_fuzz: f64,
    /// Smallest radius of an arc, mm.
    pub smallest_radius: f64,
    /// What it says to motion without feed.
    pub no_feed: &'static str,
    /// What it says to a word that no code of the block uses.
    pub unused: &'static str,
}
