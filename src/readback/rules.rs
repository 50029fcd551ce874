//! What tells one word-address control from another, as this reader sees it.

use super::codes::{G, M};

/// The frame of a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Frame {
    /// `%` first and last, O number after the first.
    PercentAndNumber,
    /// If it starts with `%` it must end with one; else M2 or M30 must stand in it.
    PercentPairOrEnd,
    /// None.
    Free,
}

/// How a control words its faults and what it refuses.
#[derive(Debug)]
pub(super) struct Rules {
    /// Name, as in `--post` data's `control`.
    pub name: &'static str,
    /// Program frame.
    pub frame: Frame,
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
    /// Longest block, if there is a limit.
    pub line_limit: Option<usize>,
    /// The limit counts comments and blanks too.
    pub limit_counts_all: bool,
    /// Letters whose numbers must not carry a point.
    pub whole_numbers: &'static [u8],
    /// Numbers without a point are in least increments (0.001 mm, 0.0001 in, 0.001 deg).
    pub least_increments: bool,
    /// Largest sequence number.
    pub largest_n: f64,
    /// Largest tool number.
    pub largest_t: f64,
    /// Most M codes in a block.
    pub most_m: usize,
    /// G code in tenths to its meaning; `None`: the control does not know it.
    pub g: fn(u16) -> Option<G>,
    /// M code in tenths to its meaning.
    pub m: fn(u16) -> Option<M>,
    /// Dwell word `P` in seconds per unit.
    pub dwell_p: f64,
    /// Dwell word `X`, seconds, is understood.
    pub dwell_x: bool,
    /// Tools are changed by `T M6`, so that a cut without one is wrong.
    pub tool_change: bool,
    /// Tool length is taken in by G43, so that a cut without it is wrong.
    pub length_offset: bool,
    /// The control starts with G0 in force; otherwise no motion code is.
    pub starts_at_rapid: bool,
    /// A path tolerance must be asked for (G61, G64 P): without, the deviation has no bound.
    pub blends: bool,
    /// R and I J K in one arc: `true`, R wins; `false`, it is a fault.
    pub radius_wins: bool,
    /// `P` in an arc is a number of turns.
    pub arc_turns: bool,
    /// An arc needs an end word in its plane.
    pub arc_needs_end: bool,
    /// Largest difference of an arc's radii, mm, at this (larger) radius.
    pub largest_difference: fn(f64) -> f64,
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
