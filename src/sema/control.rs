//! What programs ask of a control that has more than these posts give it: its own cutter compensation, tool axes.
//! CL files are read the same way ([`crate::clfile`]).

use crate::diag::Diagnostic;
use crate::diag::codes::foreign;

use super::Analyser;
use super::matched::Matched;

/// Sine of the largest angle between tool axis and Z that is none.
const ALONG_Z: f64 = 1e-6;

impl Analyser<'_> {
    /// `CUTCOM/`: points are the cutter's centre, a control's own compensation on top is not written.
    pub(super) fn cutcom(&mut self, m: &Matched) {
        if m.form != "on" || core::mem::replace(&mut self.state.compensation_told, true) {
            return;
        }
        let message =
            "the path is written as the points say, without the control's own compensation (G41, G42)";
        self.report(
            Diagnostic::new(&foreign::NO_COMPENSATION, m.word, message).help(foreign::NO_COMPENSATION_HELP),
        );
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
