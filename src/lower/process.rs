//! Spindle, coolant and stops of a program.

use super::emit::Emitter;
use crate::cl::RecordKind;
use crate::diag::codes;
use crate::ir::{Coolant, Spindle, at_origin};
use crate::target::BlockKind;

impl Emitter<'_> {
    pub(super) fn spindle(&mut self, spindle: Spindle) {
        self.standing = false;
        if matches!(spindle, Spindle::On { .. }) {
            self.spinning = Some(spindle);
        }
        self.rpm = match spindle {
            Spindle::Off => 0.0,
            Spindle::On { rpm, .. } => rpm,
        };
        if let (Spindle::On { rpm, .. }, Some((low, high))) = (spindle, self.capabilities.spindle)
            && !(low..=high).contains(&rpm)
        {
            let message = format!("the spindle turns at {low} to {high} rev/min, not at {rpm}");
            self.complain(&codes::lowering::SPINDLE_RANGE, message);
        }
        self.event(BlockKind::Spindle(spindle));
    }

    pub(super) fn coolant(&mut self, coolant: Coolant) {
        let possible = match coolant {
            Coolant::Off => self.capabilities.flood || self.capabilities.mist || self.capabilities.through,
            Coolant::Flood => self.capabilities.flood,
            Coolant::Mist => self.capabilities.mist,
            Coolant::Through { .. } => self.capabilities.through,
        };
        if possible {
            return self.switch_coolant(coolant);
        }
        let other = match coolant {
            Coolant::Through { needed: true } => return self.no_through(),
            Coolant::Mist | Coolant::Through { .. } if self.capabilities.flood => Some(Coolant::Flood),
            Coolant::Flood if self.capabilities.mist => Some(Coolant::Mist),
            _ => None,
        };
        let name = &self.capabilities.name;
        if coolant != Coolant::Off {
            let instead = if other.is_some() { "the other kind is used" } else { "none is switched on" };
            let message = format!("`{name}` cannot switch this coolant; {instead}");
            self.complain(&codes::lowering::COOLANT, message);
        }
        if let Some(other) = other {
            self.switch_coolant(other);
        }
    }

    fn no_through(&mut self) {
        let message = format!("`{}` has no word for coolant through the tool", self.capabilities.name);
        let help = "a post of your machine says it, for M51 and M59 with `control = \"fanuc M51=through M59=through-off\"` in \
                    [post], `through = \"M51\"` and `through-off = \"M59\"` in [coolant]; a CL file with --lenient takes flood";
        let code = &codes::lowering::NO_THROUGH;
        self.complain_of(at_origin(code, &self.cl.origins, self.origin, message).help(help));
    }

    /// Flood and mist are switched on one by one, and off together: one does not replace the other.
    fn switch_coolant(&mut self, coolant: Coolant) {
        let off = Coolant::Off;
        if self.coolant != off && coolant != off && coolant != self.coolant {
            self.event(BlockKind::Coolant(off));
        }
        self.dry = false;
        self.coolant = coolant;
        self.event(BlockKind::Coolant(coolant));
    }

    /// A stop of the program: at many controls spindle and coolant stop with it, and do not start again by themselves.
    pub(super) fn stop(&mut self, optional: bool) {
        if optional && !self.capabilities.optional_stop {
            let message = format!("`{}` has no optional stop; it stops here always", self.capabilities.name);
            self.complain(&codes::lowering::OPTIONAL_STOP, message);
        }
        let optional = optional && self.capabilities.optional_stop;
        self.event(if optional { BlockKind::OptionalStop } else { BlockKind::Stop });
        (self.standing, self.dry) = (self.capabilities.restart, self.capabilities.restart);
    }

    /// What a stop of the program or a tool change may have stopped is said again before something moves.
    pub(super) fn restart(&mut self, next: &RecordKind) {
        if !(self.standing || self.dry) || !(next.moves() || matches!(next, RecordKind::BeginCycle(_))) {
            return;
        }
        if let (true, true, Some(on)) = (self.standing, self.rpm > 0.0, self.spinning) {
            self.event(BlockKind::Spindle(on));
        }
        if self.dry && self.coolant != Coolant::Off {
            self.event(BlockKind::Coolant(self.coolant));
        }
        (self.standing, self.dry) = (false, false);
    }
}
