//! The control's modal state, and what a block asks to change of it.

use super::codes::{G, M, Mode};
use super::rules::Rules;
use crate::readback::curve::Plane;
use crate::readback::{FeedMode, Washing};

/// What a block asks for, group by group.
#[derive(Debug, Default)]
pub(in crate::readback) struct Plan {
    pub groups: u32,
    pub m_groups: u8,
    pub motion: Option<Mode>,
    pub cycle_end: bool,
    pub nurbs_end: bool,
    pub once: Option<G>,
    pub plane: Option<Plane>,
    pub inch: Option<bool>,
    pub incremental: Option<bool>,
    pub arc_incremental: Option<bool>,
    pub feed: Option<FeedMode>,
    pub length: Option<bool>,
    pub radius: Option<G>,
    pub path: Option<G>,
    pub compressor: bool,
    pub offset: Option<u16>,
    pub return_to_r: Option<bool>,
    pub coolant: Option<M>,
    pub loose: bool,
    pub stop: Option<M>,
    pub spindle: Option<M>,
    pub tool_change: bool,
    /// A code that this reader does not follow: the block's words can't be judged.
    pub unfollowed: bool,
}

/// Modal state of the control.
#[derive(Debug)]
pub(in crate::readback) struct State {
    /// X, Y, Z in mm and the rotary axis in degrees, as programmed.
    pub position: [f64; 4],
    /// Which of them are known.
    pub known: [bool; 4],
    /// Z has not moved since it went to the reference point or in machine coordinates.
    pub parked: bool,
    pub motion: Mode,
    pub plane: Plane,
    pub plane_stated: bool,
    pub inch: Option<bool>,
    pub incremental: Option<bool>,
    pub arc_incremental: bool,
    pub arc_mode_stated: bool,
    pub feed_mode: Option<FeedMode>,
    /// mm/min, mm/rev or 1/min.
    pub feed: Option<f64>,
    pub length: bool,
    pub radius: super::compensation::Radius,
    /// mm; infinite when the control may cut corners as it likes.
    pub path_tolerance: f64,
    pub path_stated: bool,
    /// mm, by CYCLE832 or CTOL.
    pub contour_tolerance: Option<f64>,
    /// A cycle that was called is at work.
    pub in_call: bool,
    pub speed: f64,
    pub direction: f64,
    pub tool: u32,
    pub coolant: Washing,
    pub work_offset: Option<u16>,
    pub cycle: super::cycle::Sticky,
    pub prepared: Option<u32>,
    /// Where a G5 without I and J leaves its start: against the last one's P and Q, mm.
    pub cubic_leg: Option<crate::geom::Vec2>,
    pub ended: bool,
    pub assumed: u16,
}

impl State {
    /// A control after power-on.
    pub(super) fn new(rules: &Rules) -> Self {
        State {
            position: [0.0; 4],
            known: [false; 4],
            parked: false,
            motion: if rules.starts_at_rapid { Mode::Rapid } else { Mode::None },
            plane: Plane::Xy,
            plane_stated: false,
            inch: None,
            incremental: None,
            arc_incremental: !rules.arc_absolute,
            arc_mode_stated: !rules.arc_mode_stated,
            feed_mode: if rules.feed_modes { None } else { Some(FeedMode::PerMinute) },
            feed: None,
            length: false,
            radius: super::compensation::Radius::default(),
            path_tolerance: if rules.blends { f64::INFINITY } else { 0.0 },
            path_stated: !rules.blends,
            contour_tolerance: None,
            in_call: false,
            speed: 0.0,
            direction: 0.0,
            tool: 0,
            coolant: Washing::default(),
            work_offset: None,
            cycle: super::cycle::Sticky::default(),
            prepared: None,
            cubic_leg: None,
            ended: false,
            assumed: 0,
        }
    }
}
