//! Cutter compensation: G40, G41, G42. Moves stay as programmed; what controls refuse under it is refused.

use super::block::{Block, bit};
use super::codes::G;
use super::machine::Machine;
use super::state::Plan;
use crate::readback::curve::Plane;
use crate::readback::out::Out;
use crate::readback::{Compensated, Follow, TracePath};

/// Which words name the register of the radius.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::readback) enum RadiusWord {
    /// D, in force until the next one; without one there is no radius.
    Needed,
    /// D; without it the radius is that of the tool in the spindle. It may begin and end on an arc, and may not be said twice.
    Free,
    /// None: the radius belongs to the tool's edge.
    None,
}

/// State of the compensation.
#[derive(Debug, Default)]
pub(in crate::readback) struct Radius {
    /// What is in force.
    pub on: Option<Compensated>,
    /// The next move in the plane begins or ends it.
    due: bool,
    /// Register that was named last.
    register: Option<u32>,
}

impl Machine<'_> {
    /// G40, G41, G42 and the D beside them.
    pub(super) fn radius<S: Follow>(
        &mut self,
        block: &Block,
        plan: &Plan,
        used: &mut u32,
        out: &mut Out<'_, S>,
    ) {
        let begins = matches!(plan.radius, Some(G::Radius { .. }));
        let word = self.rules.radius_word;
        if word != RadiusWord::None && (begins || self.state.radius.on.is_some()) {
            self.register(block, used, out);
        }
        match plan.radius {
            Some(G::RadiusOff) => {
                self.state.radius.due |= self.state.radius.on.is_some();
                self.state.radius.on = None;
            }
            Some(G::Radius { side }) => {
                if self.state.radius.on.is_some() && word == RadiusWord::Free {
                    out.fault("cutter compensation while it is on");
                }
                if self.state.plane != Plane::Xy {
                    out.fault("cutter compensation in another plane than G17 is not followed by this reader");
                }
                let register = self.state.radius.register.filter(|_| word != RadiusWord::None);
                if word == RadiusWord::Needed && register.is_none() {
                    out.fault("cutter compensation without D: there is no radius");
                }
                let on = Some(Compensated { side, register });
                self.state.radius.due |= self.state.radius.on != on;
                self.state.radius.on = on;
            }
            _ => {}
        }
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn register<S: Follow>(&mut self, block: &Block, used: &mut u32, out: &mut Out<'_, S>) {
        let Some(d) = block.get(b'D') else {
            // Without D the radius is that of the tool.
            if self.rules.radius_word == RadiusWord::Free && self.state.radius.on.is_none() {
                self.state.radius.register = None;
            }
            return;
        };
        *used |= bit(b'D');
        if d.fract() != 0.0 || !(0.0..=9999.0).contains(&d) {
            return out.fault(format!("D{d} is no register of a radius"));
        }
        let register = d as u32;
        let known = self.setup.tools.as_ref().is_none_or(|tools| tools.contains(&register));
        if self.rules.radius_word == RadiusWord::Free && register != 0 && !known {
            out.fault(format!("D{register} is not in the tool table"));
        }
        self.state.radius.register = Some(register);
        if let Some(on) = &mut self.state.radius.on {
            on.register = Some(register);
        }
    }

    /// Where the position is lost nothing is left to end.
    pub(super) fn forget_compensation(&mut self) {
        self.state.radius.due = false;
    }

    /// What a move may not be while the compensation begins, is in force or ends; `from_afar` in the plane, from where nobody
    /// knows.
    pub(super) fn compensates<S: Follow>(
        &mut self,
        path: &TracePath,
        (in_cycle, from_afar): (bool, bool),
        out: &mut Out<'_, S>,
    ) {
        let radius = &mut self.state.radius;
        if radius.on.is_none() && !radius.due {
            return;
        }
        let due = radius.due;
        match path {
            TracePath::Line { from, to } if !in_cycle => radius.due &= from == to && !from_afar,
            _ if in_cycle && radius.on.is_some() => out.fault("a drilling cycle under cutter compensation"),
            // The way to a hole is straight.
            _ if in_cycle => radius.due = false,
            TracePath::Arc { .. } if due => {
                radius.due = false;
                if self.rules.radius_word != RadiusWord::Free {
                    out.fault("cutter compensation begins or ends on an arc");
                }
            }
            TracePath::Line { .. } | TracePath::Arc { .. } => {}
            TracePath::Tilted(_) => out.fault("an arc out of the XY plane under cutter compensation"),
            TracePath::Spiral { .. } => out.fault("a turning table under cutter compensation"),
            TracePath::Nurbs { .. } | TracePath::Space(_) => {
                out.fault("a curve under cutter compensation");
            }
        }
    }

    /// What leaves the part's frame needs the compensation ended.
    pub(super) fn not_compensated<S: Follow>(&self, what: &str, out: &mut Out<'_, S>) {
        if self.state.radius.on.is_some() {
            out.fault(format!("{what} under cutter compensation"));
        }
    }
}
