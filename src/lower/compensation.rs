//! Compensation of the cutter's radius by the control: what it is told, and where it may begin and end.
//!
//! Controls begin and end it on straight moves in the plane, keep it on lines and arcs of the XY plane, and refuse curves,
//! drilling cycles, changes of side and turning tables under it. CL data say when it is wanted; it is said right before the
//! first straight move in X or Y after that, or before the straight lead of a contour, at its depth.

use super::emit::Emitter;
use crate::cl::{Cl, Contour, Lead, RecordKind};
use crate::diag::codes::{foreign, lowering};
use crate::geom::Side;
use crate::ir::{Compensation, at_origin};
use crate::target::{BlockKind, Motion, Plane, Register, axes};

/// What of it has been said, and what it waits for.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Compensating {
    /// What the CL data want from the next move in X or Y on.
    wanted: Option<Compensation>,
    /// What is in force.
    now: Option<Compensation>,
    /// It is to begin on a lead, not on the way there.
    pub held: bool,
    /// X, Y and the table where the last move ended.
    at: [Option<i64>; 3],
    /// Number of the tool in the spindle.
    tool: Option<u32>,
    /// It was told that the control has none.
    told: bool,
}

impl Compensating {
    /// Where a new tool is nobody knows.
    pub(super) fn changes_to(&mut self, tool: Option<u32>) {
        (self.tool, self.at) = (tool, [None; 3]);
    }
}

/// For each record whether compensation is wanted there; empty where it never is.
pub(super) fn wanted(cl: &Cl) -> Vec<bool> {
    let begins = |kind: &RecordKind| matches!(kind, RecordKind::Compensation(Some(_)));
    if !cl.records.iter().any(|record| begins(&record.kind)) {
        return Vec::new();
    }
    let follow = |on: &mut bool, kind: &RecordKind| {
        if let RecordKind::Compensation(wanted) = kind {
            *on = wanted.is_some();
        }
        Some(*on)
    };
    cl.records.iter().map(|record| &record.kind).scan(false, follow).collect()
}

impl Emitter<'_> {
    /// `CUTCOM/`.
    pub(super) fn compensation(&mut self, wanted: Option<Compensation>) {
        if let Some(on) = wanted.filter(|_| !core::mem::replace(&mut self.compensating.told, true)) {
            self.tell_compensation(on);
        }
        if self.capabilities.compensation.is_none() || self.compensating.wanted == wanted {
            return;
        }
        if wanted.is_some() && self.compensating.now.is_some_and(|now| Some(now) != wanted) {
            let help = "write CUTCOM/ OFF and a straight move in X or Y before it";
            self.not_compensated("changes its side or its register while it is in force", help);
        }
        self.compensating.wanted = wanted;
        // A post that reads CL data waits itself.
        if self.capabilities.whole_points {
            self.say_compensation();
        }
    }

    /// What is wanted comes into force.
    fn say_compensation(&mut self) {
        let Some(register) = self.capabilities.compensation else { return };
        let Compensating { wanted, tool, .. } = self.compensating;
        let said = wanted.map(|on| Compensation { register: register.said(on.register, tool), ..on });
        self.compensating.now = wanted;
        self.event(BlockKind::Compensation(said));
    }

    /// Once for a program; a post that reads CL data tells it itself.
    fn tell_compensation(&mut self, on: Compensation) {
        let name = &self.capabilities.name;
        let (code, message, help) = match self.capabilities.compensation {
            None => (
                &foreign::NO_COMPENSATION,
                format!("`{name}` says no cutter compensation: the path is written as the points say"),
                foreign::NO_COMPENSATION_HELP,
            ),
            Some(_) if self.capabilities.whole_points => return,
            Some(register) => {
                let which = match (register, on.register) {
                    (Register::OfTool, Some(n)) => {
                        format!("the radius of its tool, not by that in register {n},")
                    }
                    (Register::OfTool, None) => "the radius of its tool".to_owned(),
                    _ => "the radius in its register".to_owned(),
                };
                let message =
                    format!("`{name}` moves this path by {which} where it is not 0: the proof is for 0");
                (&foreign::COMPENSATED, message, foreign::COMPENSATED_HELP)
            }
        };
        self.complain_of(at_origin(code, &self.cl.origins, self.origin, message).help(help));
    }

    /// Where the program changes the tool, drills or ends, nothing is compensated.
    pub(super) fn ends_compensation(&mut self, before: &str) {
        if self.compensating.wanted.take().is_some() {
            let help = "write CUTCOM/ OFF before the cutter's way out";
            self.not_compensated(&format!("is still in force before {before}"), help);
        }
        if self.compensating.now.is_some() {
            self.say_compensation();
        }
    }

    /// Before a motion is pushed.
    pub(super) fn compensates(&mut self, motion: &Motion) {
        let state = self.compensating;
        let (to, moved) = match motion {
            Motion::Rapid { to, axes } => (*to, *axes),
            Motion::Line { to, .. } | Motion::Arc { to, .. } => (*to, axes::X | axes::Y | axes::ROTARY),
            Motion::Nurbs { .. } => (self.here(), axes::X | axes::Y | axes::ROTARY),
        };
        let ends = [(to.x, axes::X), (to.y, axes::Y), (to.r, axes::ROTARY)];
        let mut goes = [false; 3];
        for (i, (end, _)) in ends.into_iter().enumerate().filter(|(_, (_, axis))| moved & axis != 0) {
            goes[i] = state.at[i] != Some(end);
            self.compensating.at[i] = Some(end);
        }
        if state.wanted.is_none() && state.now.is_none() {
            return;
        }
        let [x, y, turns] = goes;
        match motion {
            Motion::Arc { .. } if state.wanted != state.now && !state.held => {
                let what = if state.wanted.is_some() { "begins" } else { "ends" };
                let help =
                    "put a straight move in X or Y, longer than the radius, between CUTCOM and the arc";
                self.not_compensated(&format!("{what} on an arc"), help);
            }
            Motion::Arc { plane: Plane::Zx | Plane::Yz, .. } => {
                let help = "end it before, or cut the arc by lines";
                self.not_compensated("is in force on an arc out of the XY plane", help);
            }
            Motion::Nurbs { .. } => {
                let help = "write LINEAR or CIRCUL in place of NURBS";
                self.not_compensated("is in force on a curve", help);
            }
            _ if turns && state.at[2].is_some() => {
                let help = "end it before the table turns";
                self.not_compensated("is in force while the table turns", help);
            }
            _ => {}
        }
        let moves = x || y || matches!(motion, Motion::Arc { .. } | Motion::Nurbs { .. });
        if moves && state.wanted != state.now && !state.held {
            self.say_compensation();
        }
    }

    /// A radius above 0 moves the cutter off the part, never into it.
    pub(super) fn compensates_beside(&mut self, contour: &Contour) {
        let side = self.compensating.wanted.map(|on| on.side);
        if contour.entry == Lead::None || side != Some(contour.part) {
            return;
        }
        let (side, other) = match contour.part {
            Side::Left => ("left", "RIGHT"),
            Side::Right => ("right", "LEFT"),
        };
        let message = format!(
            "cutter compensation to the {side} moves the cutter into the part, which lies {side} of this cut"
        );
        let help = format!("write CUTCOM/ {other}, or cut the other way round");
        let code = &lowering::COMPENSATION;
        self.complain_of(at_origin(code, &self.cl.origins, self.origin, message).help(help));
    }

    fn not_compensated(&mut self, how: &str, help: &str) {
        let message = format!("cutter compensation {how}, which no control carries out as it is meant");
        let code = &lowering::COMPENSATION;
        self.complain_of(at_origin(code, &self.cl.origins, self.origin, message).help(help));
    }
}
