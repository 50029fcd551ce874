//! What stands in front of a pass that roughs a surface at one go.

use crate::arena::Handle;
use crate::diag::Diagnostic;
use crate::diag::codes::planning::{ROUGH_MATERIAL, ROUGH_TOO_DEEP};
use crate::geom::Point3;
use crate::geom::surface::SurfaceTree;
use crate::ir::{Origin, Surface, Tool};
use crate::plan::Planner;

/// Places of a patch in each direction at which the depth is looked at.
const PLACES: u32 = 32;

impl Planner<'_> {
    /// Tells how deep the blank stands over the surface, and warns where that is more than the cutter can take.
    pub(super) fn material(
        &mut self,
        surface: &Surface,
        name: &str,
        tree: &SurfaceTree,
        origin: Handle<Origin>,
    ) {
        let Some((top, lowest)) = surface.stock_top.zip(lowest(tree)) else { return };
        let depth = top - lowest.z - surface.leave;
        if depth.is_nan() || depth <= 0.0 {
            return;
        }
        let cutter = &self.program.tools[surface.tool];
        let message = format!(
            "{name} takes up to {} of material at one go, at X {}, Y {}: the blank reaches up to Z {}",
            self.show(depth),
            self.show(lowest.x),
            self.show(lowest.y),
            self.show(top)
        );
        let (takes, why) = most(cutter);
        if depth <= takes {
            let diagnostic = Diagnostic::new(&ROUGH_MATERIAL, self.span(origin), message);
            return self.report(diagnostic, origin);
        }
        let diagnostic = Diagnostic::new(&ROUGH_TOO_DEEP, self.span(origin), message)
            .label(self.span(cutter.origin), format!("{why} {}", self.show(takes)))
            .help("clear it in levels first: `ROUGH/ net, LEVELS, STOCK, …, STEP, …`");
        self.report(diagnostic, origin);
    }
}

/// How deep a cutter can cut, mm, and where that is said.
fn most(cutter: &Tool) -> (f64, &'static str) {
    let height = Some(cutter.profile[4]).filter(|h| *h > 0.0);
    match [height, cutter.length].into_iter().flatten().min_by(f64::total_cmp) {
        Some(length) => (length, "the cutter is only as long as"),
        None => (cutter.diameter, "no LENGTH is declared; the cutter takes its diameter,"),
    }
}

/// The lowest of many points of the surface.
fn lowest(tree: &SurfaceTree) -> Option<Point3> {
    let points = tree.net().patches().iter().flat_map(|patch| {
        (0..(PLACES + 1) * (PLACES + 1)).map(move |k| {
            let [u, v] = [k / (PLACES + 1), k % (PLACES + 1)].map(|i| f64::from(i) / f64::from(PLACES));
            patch.point(u, v)
        })
    });
    points.min_by(|a, b| a.z.total_cmp(&b.z))
}
