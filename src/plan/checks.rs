//! Checks of the cutter's form and reach against a cut.

use super::Planner;
use crate::arena::Handle;
use crate::diag::Diagnostic;
use crate::diag::codes::planning::{DRILL_MILLS, HOLDER_RUBS, ROUNDED_END, TAPERED_WALL, TOO_DEEP};
use crate::ir::{CutterKind, Origin, Tool};

impl Planner<'_> {
    /// Whether the cutter can cut a wall of this depth, mm; says what is wrong or worth knowing.
    pub(super) fn check_cutter(&mut self, tool: Handle<Tool>, depth: f64, origin: Handle<Origin>) -> bool {
        let cutter = &self.program.tools[tool];
        let cuts = self.check_end(cutter, origin);
        self.check_holder(cutter, depth, origin);
        self.check_reach(cutter, depth, origin) && cuts
    }

    fn check_end(&mut self, cutter: &Tool, origin: Handle<Origin>) -> bool {
        let declared = self.span(cutter.origin);
        let diagnostic = match cutter.kind {
            CutterKind::Flat => return true,
            CutterKind::Ball | CutterKind::Bull => {
                let corner = match cutter.kind {
                    CutterKind::Ball => cutter.diameter / 2.0,
                    _ => cutter.corner,
                };
                let corner = self.show(corner);
                let message = format!(
                    "cutter {} has a rounded end: the lowest {corner} of the wall keep a fillet of that radius",
                    cutter.name
                );
                Diagnostic::new(&ROUNDED_END, self.span(origin), message)
                    .help(format!("add {corner} to DEPTH where the wall must be straight to its foot"))
            }
            CutterKind::Drill => {
                let message = format!("{} is a drill, which cuts with its point only", cutter.name);
                Diagnostic::new(&DRILL_MILLS, self.span(origin), message)
                    .help("load an end mill, or drill holes with `CYCLE/ DRILL`")
            }
            CutterKind::Taper => {
                let message = format!("cutter {} is tapered: the wall will slope by its angle", cutter.name);
                Diagnostic::new(&TAPERED_WALL, self.span(origin), message)
                    .help("the contour is exact at the height where the cutter has its nominal diameter")
            }
        };
        let cuts = cutter.kind != CutterKind::Drill;
        self.report(diagnostic.label(declared, "the cutter is declared here"), origin);
        cuts
    }

    fn check_holder(&mut self, cutter: &Tool, depth: f64, origin: Handle<Origin>) {
        let Some(stick) = cutter.stick_out.filter(|s| *s < depth) else { return };
        let message = format!(
            "the cut is {} deep, but cutter {} sticks out only {}",
            self.show(depth),
            cutter.name,
            self.show(stick)
        );
        let declared = self.span(cutter.origin);
        let diagnostic = Diagnostic::new(&HOLDER_RUBS, self.span(origin), message)
            .label(declared, "the cutter is declared here")
            .help("clamp the cutter longer, or cut less deep");
        self.report(diagnostic, origin);
    }

    /// The seventh parameter is the height of the cutter's cutting part, `LENGTH` that of the whole cutter.
    fn check_reach(&mut self, cutter: &Tool, depth: f64, origin: Handle<Origin>) -> bool {
        let height = Some(cutter.profile[4]).filter(|h| *h > 0.0);
        let reach = [height, cutter.length].into_iter().flatten().fold(f64::INFINITY, f64::min);
        if depth <= reach {
            return true;
        }
        let message = format!(
            "the cut is {} deep, but cutter {} is only {} long",
            self.show(depth),
            cutter.name,
            self.show(reach)
        );
        let declared = self.span(cutter.origin);
        let diagnostic = Diagnostic::new(&TOO_DEEP, self.span(origin), message)
            .label(declared, "the cutter is declared here")
            .help(format!("take a longer cutter, or a DEPTH of at most {}", self.show(reach)));
        self.report(diagnostic, origin);
        false
    }
}
