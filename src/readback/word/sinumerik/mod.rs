//! Siemens SINUMERIK 840D sl, from its programming manuals and published posts.
//!
//! Its blocks are cut by a lexer of their own and executed by the same machine as all word-address programs. Names of the
//! language (`SUPA`, `COMPCAD` …) stand among the G codes, from 1000 up.

use super::block::{Block, letters};
use super::codes::{G, Group, M, Mode};
use super::controls::fanuc;
use super::iso;
use super::machine::Machine;
use super::motion::Target;
use super::rules::{Cycles, Dwell, FeedReset, Frame, Language, RotaryFeed, Rules};
use crate::readback::out::Out;
use crate::readback::{FeedMode, Follow, TracePath};

mod cycles;
mod lexer;
mod poly;
mod through;

pub(super) use cycles::Modal;
pub(in crate::readback::word) use lexer::read;

impl Machine<'_> {
    /// A block along a curve that is made of its words; where none can be made of them, that is a fault.
    fn along<S: Follow>(
        &mut self,
        block: &Block,
        (axes, used): (u32, &mut u32),
        out: &mut Out<'_, S>,
        path: impl FnOnce(&Self, &Target, &mut Out<'_, S>) -> Result<TracePath, String>,
    ) {
        *used |= axes;
        let target = self.target(block, out);
        if !self.feed_is_there(block, out) {
            return self.arrive(&target);
        }
        match path(self, &target, out) {
            Ok(path) => {
                let from = self.departure(&target);
                self.emit(path, from, &target, false, out);
            }
            Err(fault) => {
                out.fault(fault);
                self.arrive(&target);
            }
        }
    }
}

/// Words of a block that no other control has.
#[derive(Debug, Clone, Default)]
pub(in crate::readback) struct Words {
    /// Letters whose value is in `AC()`.
    pub absolute: u32,
    /// Letters whose value is in `IC()`.
    pub incremental: u32,
    /// `I1=`, `J1=`, `K1=`: a place between the ends of a circle, and whether it says that it is absolute or not.
    pub between: [Option<(f64, Option<bool>)>; 3],
    /// `TURN=`.
    pub turns: Option<f64>,
    /// `SD=`: degree of a spline.
    pub degree: Option<f64>,
    /// `PW=`: weight of a control point.
    pub weight: Option<f64>,
    /// `PL=`: length of a parameter interval.
    pub interval: Option<f64>,
    /// `PO[X]=(…)` and `X=PO(…)`.
    pub polynomials: Option<Box<poly::Polynomials>>,
    /// `CTOL=`, `ADIS=`, in the unit in force.
    pub tolerance: Option<f64>,
    /// `T="…"`.
    pub tool: Option<String>,
    /// `MCALL` stands in the block.
    pub modal_call: bool,
    /// A call with its arguments.
    pub call: Option<Call>,
}

/// `NAME(1,2,,4)`.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::readback) struct Call {
    /// In upper case.
    pub name: String,
    /// Numbers; `None` for those left out.
    pub arguments: Vec<Option<f64>>,
}

/// F is in the dwell's block, with S for revolutions; lengths are taken in by D.
pub(in crate::readback) const RULES: Rules = Rules {
    name: "sinumerik",
    language: Language::Sinumerik,
    frame: Frame::End,
    parentheses: false,
    semicolon_comment: true,
    comment_character: |c| c >= b' ' || c == b'\t',
    comment_complaint: "the control stops at",
    lower_case: true,
    line_limit: Some(512),
    whole_numbers: letters(b"NTDM"),
    unpointed: super::rules::Unpointed::Whole,
    largest_length: Some((999_999.999, 99_999.999_9)),
    largest_t: 32_000.0,
    largest_inverse: f64::INFINITY,
    most_m: 5,
    g,
    m,
    dwell: [Some((b'F', Dwell::Seconds)), Some((b'S', Dwell::Revolutions))],
    cycles: Some(CYCLES),
    tool_change: true,
    length_offset: true,
    length_by_d: true,
    radius_word: super::rules::RadiusWord::None,
    length_word: b'D',
    feed_reset: FeedReset::Change,
    rotary_feed: RotaryFeed::MillimetresAsDegrees,
    blends: true,
    exact_code: "G60",
    radius_wins: false,
    stop_stands: false,
    shaky_half_circle: false,
    arc_turns: false,
    largest_difference: |_, _| 0.01,
    arc_complaint: "alarm 14040, error in end point of circle",
    no_feed: "alarm 10860, feedrate not programmed",
    unused: "no code in the block uses it",
    ..fanuc::RULES
};

/// Only the distances back matter here; the words are the calls'.
const CYCLES: Cycles = Cycles { clearance: 1.0, ..fanuc::CYCLES };

/// Names of the language and the codes they stand for here, in tenths.
const KEYWORDS: [(&str, u16); 30] = [
    ("SUPA", 10_000),
    ("COMPOF", 10_010),
    ("COMPON", 10_020),
    ("COMPCURV", 10_021),
    ("COMPCAD", 10_022),
    ("SOFT", 10_030),
    ("BRISK", 10_031),
    ("DRIVE", 10_032),
    ("FFWON", 10_040),
    ("FFWOF", 10_041),
    ("CFC", 10_050),
    ("CFTCP", 10_051),
    ("CFIN", 10_052),
    ("FNORM", 10_060),
    ("NORM", 10_070),
    ("KONT", 10_071),
    ("DIAMOF", 10_080),
    ("STOPRE", 10_090),
    ("TRAFOOF", 10_100),
    ("CUT2D", 10_110),
    ("ORIWKS", 10_120),
    ("BSPLINE", 10_200),
    ("POLY", 10_210),
    ("ASPLINE", 10_220),
    ("CSPLINE", 10_221),
    ("CIP", 10_230),
    ("CT", 10_231),
    ("TRAORI", 10_300),
    ("TRANSMIT", 10_301),
    ("ROT", 10_310),
];

/// Code of a name.
fn keyword(name: &str) -> Option<u16> {
    KEYWORDS.iter().find(|(n, _)| *n == name).map(|(_, code)| *code)
}

/// Name of a code, if it has one.
pub(super) fn name(code: u16) -> Option<&'static str> {
    KEYWORDS.iter().find(|(_, c)| *c == code).map(|(n, _)| *n)
}

fn g(tenths: u16) -> Option<G> {
    Some(match tenths {
        90 => G::NoEffect(Group::Once),
        400 => G::RadiusOff,
        1530 | 10_000 => G::MachineCoordinates,
        540..=570 if tenths.is_multiple_of(10) => G::WorkOffset((tenths - 530) / 10),
        5050..=5990 if tenths.is_multiple_of(10) => G::WorkOffset((tenths - 5000) / 10),
        410 | 420 => return iso::radius(tenths),
        600 => G::ExactPath,
        6010 | 6020 | 6030 => G::NoEffect(Group::Other),
        640..=645 | 6410 | 6420 | 6430 | 6440 | 6450 => G::Blend,
        710 | 7100 => G::Units { inch: false },
        7000 => G::Units { inch: true },
        10_200 => G::Motion(Mode::BSpline),
        10_210 => G::Motion(Mode::Polynomial),
        10_230 => G::Motion(Mode::Through),
        930 => G::Feed(FeedMode::InverseTime),
        940 => G::Feed(FeedMode::PerMinute),
        950 => G::Feed(FeedMode::PerRevolution),
        970 => G::NoEffect(Group::Speed),
        4500 | 4510 => G::NoEffect(Group::Other),
        10_010 | 10_030..=10_120 => G::NoEffect(Group::Other),
        10_020..=10_022 => G::Compressor,
        _ => return iso::g(tenths).or_else(|| unfollowed(tenths)),
    })
}

fn unfollowed(tenths: u16) -> Option<G> {
    Some(G::Unfollowed(match tenths {
        50 | 70 | 330 | 10_220..=10_221 | 10_231 => Group::Motion,
        700 => Group::Units,
        250 | 260 | 740 | 750 | 1100 | 1110 | 1120 => Group::Once,
        960 => Group::Speed,
        5000 => Group::Offset,
        10_300..=10_310 => Group::Other,
        _ => return None,
    }))
}

fn m(tenths: u16) -> Option<M> {
    Some(match tenths {
        60 => M::ToolChange,
        400..=450 => M::NoEffect,
        170 | 190 | 700 => M::Unfollowed,
        _ => return iso::m(tenths),
    })
}
