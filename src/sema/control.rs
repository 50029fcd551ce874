//! What programs ask of a control that has more than these posts give it: its own cutter compensation, tool axes.
//! CL files are read the same way ([`crate::clfile`]).

use crate::diag::Diagnostic;
use crate::diag::codes::foreign;
use crate::geom::Side;
use crate::ir::{Compensation, StepKind};

use super::Analyser;
use super::matched::Matched;

/// Sine of the largest angle between tool axis and Z that is none.
const ALONG_Z: f64 = 1e-6;

impl Analyser<'_> {
    /// `CUTCOM/`: the control moves the path by what its register holds.
    pub(super) fn cutcom(&mut self, m: &Matched) {
        if m.form != "on" {
            return self.step(StepKind::Compensation(None));
        }
        let side = match m.word("side") {
            Some("LEFT") => Some(Side::Left),
            Some("RIGHT") => Some(Side::Right),
            _ => None,
        };
        let named = m.number("register").map(|n| n as u32);
        let Some(on) = Compensation::asked(side, named, self.state.last_compensation) else {
            let problem = Diagnostic::new(&foreign::BAD_RECORD, m.word, foreign::NO_SIDE);
            return self.report(problem.help("write LEFT or RIGHT"));
        };
        if let Some(plane @ ("YZPLAN" | "ZXPLAN")) = m.word("plane") {
            let message = format!("CUTCOM in the plane {plane} cannot be carried out");
            return self.report(Diagnostic::new(&foreign::NOT_CARRIED_OUT, m.word, message));
        }
        self.state.last_compensation = Some(on);
        // The image of a path that is mirrored has the cutter on its other side.
        let mirrored = self.state.transform.as_ref().is_some_and(|(map, _)| map.mirrors_plan());
        let side = if mirrored { on.side.opposite() } else { on.side };
        self.step(StepKind::Compensation(Some(Compensation { side, ..on })));
    }

    /// `TLAXIS/` and the last three numbers of `GOTO/`: along Z, or an error, once for a program.
    pub(super) fn tool_axis(&mut self, m: &Matched) {
        let axis = match m.vector("vector") {
            Some(v) => Some(v.v),
            None => m.number("i").zip(m.number("j")).zip(m.number("k")).map(|((i, j), k)| [i, j, k]),
        };
        let Some(axis @ [i, j, k]) = axis else { return };
        let length = axis.iter().map(|c| c * c).sum::<f64>().sqrt();
        let upright = k > 0.0 && i.abs() <= ALONG_Z * length && j.abs() <= ALONG_Z * length;
        if upright || core::mem::replace(&mut self.state.axis_told, true) {
            return;
        }
        let message = format!(
            "the tool axis is ({i}, {j}, {k}), off Z: it needs rotary axes, and the posts are for three"
        );
        let help = "set up the part so that the tool axis is Z";
        self.report(Diagnostic::new(&foreign::TOOL_AXIS, m.word, message).help(help));
    }
}
