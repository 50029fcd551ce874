//! What tells one word-address control from another, as this reader sees it.

use super::codes::{CycleKind, G, M};
pub(in crate::readback) use super::compensation::RadiusWord;

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
    /// `%` and a number on the first line, M2 or M30 last.
    PercentName,
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
    /// Hundredths of a second.
    Hundredths,
    /// Revolutions of the spindle.
    Revolutions,
}

/// Dwell words in order of precedence, with their units.
pub(in crate::readback) type Dwells = [Option<(u8, Dwell)>; 2];

impl Dwell {
    /// Seconds of `value`; `None` where the spindle must turn and doesn't.
    pub(super) fn seconds(self, value: f64, pointed: bool, speed: f64) -> Option<f64> {
        match self {
            Dwell::Seconds => Some(value),
            Dwell::Milliseconds => Some(value / 1000.0),
            Dwell::Hundredths => Some(value / 100.0),
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
#[derive(Debug, Clone, Copy)]
pub(in crate::readback) struct Cycles {
    /// Word of the height where feed begins.
    pub level: u8,
    /// Word of the bottom.
    pub bottom: u8,
    /// Word of the height to which the tool goes after a hole, where there is one.
    pub after: Option<u8>,
    /// Word of the depth of a peck, or of their number.
    pub peck: u8,
    /// That word is the number of equal pecks between the height where feed begins and the bottom.
    pub pecks_counted: bool,
    /// Word of the dwell, and its unit.
    pub dwell_word: u8,
    /// Unit of the dwell word.
    pub dwell: Dwell,
    /// Cycles that take a dwell.
    pub with_dwell: &'static [CycleKind],
    /// The distance by which chips are broken, and before the last depth at which the rapid down stops, mm: a setting of
    /// the control at its usual value.
    pub clearance: f64,
    /// The height of return is said by G71 Z and M53 (Okuma), not by G98.
    pub return_height: bool,
    /// Word of the repeat count.
    pub repeats: Option<u8>,
    /// The tool always goes back to R, or to the initial height; `None`: as G98 and G99 say.
    pub returns_to_level: Option<bool>,
    /// G99 is in force before G98 or G99 is said.
    pub starts_to_r: bool,
    /// A cycle block must move an axis.
    pub needs_motion: bool,
    /// A hole below the initial height is reached at `R` or the initial height, whichever is higher, under G98.
    pub higher_return: bool,
    /// G89 goes all the way back at feed.
    pub bore_dwell_feeds_back: bool,
}

/// The letters an address may be, and behind them places for longer addresses.
pub(in crate::readback) const LETTERS: u8 = b'Z' + 1;
/// Longer addresses that a machine may have.
pub(in crate::readback) const ADDRESSES: usize = 6;
/// Characters of one.
pub(in crate::readback) const ADDRESS: usize = 4;

/// Ways to cut a line into words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::readback) enum Language {
    /// Letters with numbers.
    Iso,
    /// SINUMERIK: also names, `=` and calls.
    Sinumerik,
}

/// How a control words its faults and what it refuses.
#[derive(Debug, Clone, Copy)]
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
    /// Character that ends every line but a lone `%`, 0 for none.
    pub line_end: u8,
    /// Longest block, if there is a limit.
    pub line_limit: Option<usize>,
    /// The limit counts comments and blanks too.
    pub limit_counts_all: bool,
    /// Letters whose numbers must not carry a point.
    pub whole_numbers: u32,
    /// Addresses of more than one character, zeros behind; they count as letters from [`LETTERS`] on.
    pub addresses: [[u8; ADDRESS]; ADDRESSES],
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
    /// Dwell words.
    pub dwell: Dwells,
    /// Drilling cycles, if the control has them.
    pub cycles: Option<Cycles>,
    /// Tools are changed by `T M6`, so that a cut without one is wrong.
    pub tool_change: bool,
    /// Tool length is taken in by G43, so that a cut without it is wrong.
    pub length_offset: bool,
    /// Lengths are taken in by D words, D0 leaves them out.
    pub length_by_d: bool,
    /// Word of the radius for cutter compensation.
    pub radius_word: RadiusWord,
    /// Word of the length offset that G43 takes in.
    pub length_word: u8,
    /// G43 needs it.
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
    /// A stop of the program stops the spindle and the coolant, and nothing starts them again by itself.
    pub stop_stands: bool,
    /// An arc by R of nearly half a turn can't be computed reliably.
    pub shaky_half_circle: bool,
    /// Words of an arc's centre along X, Y and Z.
    pub arc_offsets: [u8; 3],
    /// Word of an arc's radius.
    pub arc_radius: u8,
    /// They count from the program's zero, without G90.1.
    pub arc_absolute: bool,
    /// What G5 is.
    pub cubic: super::cubic::Cubic,
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
    /// The same for a machine that says it itself, mm.
    pub stated_difference: Option<f64>,
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

impl Rules {
    /// The address that counts as this letter.
    pub(super) fn address(&self, letter: u8) -> String {
        let longer = letter.checked_sub(LETTERS).and_then(|i| self.addresses.get(usize::from(i)));
        match longer {
            Some(name) => name.iter().take_while(|c| **c != 0).copied().map(char::from).collect(),
            None => char::from(letter).to_string(),
        }
    }
    /// Addresses of more than one character, with what they count as.
    pub(super) fn longer_addresses(&self) -> impl Iterator<Item = (&[u8], u8)> {
        let said = |name: &'_ [u8; ADDRESS]| name.iter().position(|c| *c == 0).unwrap_or(ADDRESS);
        (LETTERS..).zip(&self.addresses).filter_map(move |(letter, name)| {
            name.get(..said(name)).filter(|name| !name.is_empty()).map(|name| (name, letter))
        })
    }
    /// Whether the radii of an arc may differ so, mm.
    pub(super) fn arc_fits(&self, difference: f64, radius: f64, inch: bool) -> bool {
        difference <= self.stated_difference.unwrap_or_else(|| (self.largest_difference)(radius, inch))
    }
}
