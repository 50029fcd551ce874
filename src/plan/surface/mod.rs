//! Finishing of surfaces: passes of a cutter over a net.
//!
//! [`family`] says what the passes of an operation are, [`spread`] how close straight ones lie, [`march`] where those run that
//! bend, [`entry`] how the cutter comes onto the surface. Passes stay exact tracks: `lower` fits them.

mod apart;
mod bends;
mod entry;
mod extent;
mod family;
mod lanes;
mod march;
mod material;
mod outline;
mod ridge;
mod scale;
mod spread;

use std::sync::Arc;

use super::Planner;
use crate::arena::Handle;
use crate::cl::{Finish, Guard, Operation, Pass, RecordKind};
use crate::diag::Diagnostic;
use crate::diag::codes::planning as codes;
use crate::geom::Point3;
use crate::geom::surface::curvature::{Concavity, most_concave};
use crate::geom::surface::{Contact, Cutter, SurfaceTree, Track};
use crate::ir::{Band, CutterKind, NetEntity, Origin, PassShape, Spacing, Surface};
use family::{Family, Leg};

/// Accuracy of the smallest concave radius, mm.
const RADIUS_ACCURACY: f64 = 1e-6;
/// The approach is at rapid down to so far above the surface and the blank, mm, clearance permitting.
const ABOVE: f64 = 2.0;

impl Planner<'_> {
    pub(super) fn surface(&mut self, surface: &Surface, origin: Handle<Origin>) {
        let name = self.operation_name(kind(surface), surface.name.as_deref());
        let ready = self.ready(&name, Some(surface.tool), origin);
        let entity = &self.program.nets[surface.net];
        let tool = &self.program.tools[surface.tool];
        // Tools of another shape were refused with the statement.
        let radius = tool.diameter / 2.0;
        let cutter = tool.solid().unwrap_or_else(|| Cutter::ball(radius));
        let net = &self.program.nets[surface.net].net;
        if let Some(why) = extent::refused(net, surface.spacing, &cutter, self.program.units) {
            return self.no_passes(&why, origin);
        }
        let reach = radius + surface.leave + surface.band.out;
        let tree = Arc::new(SurfaceTree::new(entity.net.clone(), reach));
        let reachable = self.upright((surface.net, &tree), origin);
        let clear = self.clears((surface.clearance, surface.leave, surface.stock_top), &tree, origin);
        let fits =
            reachable && self.fits(surface, &cutter, origin) && self.rests((surface, &tree), &cutter, origin);
        if !(fits && clear && ready.is_some()) {
            return;
        }
        if surface.rough {
            self.material(surface, &name, &tree, origin);
        }
        let operation = self.cl.operations.len();
        let shares = self.closer.of(operation);
        let mut march = self.closer.march(operation);
        let (legs, band) = match cutter.is_ball() {
            false => {
                let (hull, band) = lanes::within(&cutter, surface.leave, surface.band);
                (lanes::legs(surface, &tree, (hull, &cutter), &shares, &mut march), band)
            }
            true => {
                let family = Family::new(surface, Arc::clone(&tree), radius, shares);
                (family.legs(surface, &mut march), surface.band)
            }
        };
        let legs = match legs {
            _ if tree.is_exhausted() => return self.too_uneven(surface.net, origin),
            Ok(legs) => legs,
            Err(why) => return self.no_passes(&why, origin),
        };
        let finish =
            Finish { tree, radius, cutter, leave: surface.leave, cusp: cusp(surface.spacing), march };
        self.passes((surface, band), &name, finish, &legs, origin);
    }

    /// The cutter against the smallest concave radius.
    fn fits(&mut self, surface: &Surface, cutter: &Cutter, origin: Handle<Origin>) -> bool {
        let concavity = most_concave(&self.program.nets[surface.net].net, RADIUS_ACCURACY);
        let ball = cutter.corner() + surface.leave;
        if concavity.curvature * ball <= 1.0 {
            return true;
        }
        let code = if surface.avoid { &codes::SURFACE_LIFTED } else { &codes::SURFACE_TOO_HOLLOW };
        let diagnostic = self.too_hollow(surface, &concavity, ball, code, origin);
        self.report(diagnostic, origin);
        surface.avoid
    }

    /// A cutter with a flat or a cone against all of the surface, at many places.
    fn rests(
        &mut self,
        (surface, tree): (&Surface, &SurfaceTree),
        cutter: &Cutter,
        origin: Handle<Origin>,
    ) -> bool {
        if cutter.is_ball() {
            return true;
        }
        let Some(spot) = lanes::deepest(tree, &cutter.grown(surface.leave)) else { return true };
        let code = if surface.avoid { &codes::SURFACE_LIFTED } else { &codes::SURFACE_TOO_HOLLOW };
        let (tool, net) = (&self.program.tools[surface.tool], &self.program.nets[surface.net]);
        let (p, [u, v]) = (spot.at, spot.uv);
        let message = format!(
            "{}, set on {} at ({}, {}, {}), u {u:.4}, v {v:.4}, would go {} into it elsewhere",
            tool.name,
            net.name,
            self.show(p.x),
            self.show(p.y),
            self.show(p.z),
            self.show(spot.depth)
        );
        let mut diagnostic = Diagnostic::new(code, self.span(origin), message)
            .label(self.span(tool.origin), "the cutter")
            .label(self.span(net.origin), "the surface")
            .help("a smaller cutter leaves less there, a ball-end cutter least");
        if surface.avoid {
            diagnostic = diagnostic.note("the path is lifted there: nothing is gouged, and material stays");
        }
        self.report(diagnostic, origin);
        surface.avoid
    }

    fn too_hollow(
        &self,
        surface: &Surface,
        concavity: &Concavity,
        ball: f64,
        code: &'static crate::diag::Code,
        origin: Handle<Origin>,
    ) -> Diagnostic {
        let (p, net) = (concavity.point, &self.program.nets[surface.net]);
        let round = self.program.tools[surface.tool].kind == CutterKind::Ball;
        let left = if surface.leave > 0.0 { " (with what it leaves)" } else { "" };
        let message = format!(
            "{} of radius {}{left} does not fit {}: its smallest concave radius is {}, at ({}, {}, {}), u {:.6}, v {:.6}",
            if round { "a ball" } else { "a corner" },
            self.show(ball),
            net.name,
            self.show(concavity.proven_radius()),
            self.show(p.x),
            self.show(p.y),
            self.show(p.z),
            concavity.at[0],
            concavity.at[1]
        );
        let largest = concavity.proven_radius() - surface.leave;
        let help = if largest > 0.0 {
            match round {
                true => {
                    format!(
                        "the largest ball-end cutter that fits has a diameter of {}",
                        self.show(2.0 * largest)
                    )
                }
                false => format!("the largest corner radius that fits is {}", self.show(largest)),
            }
        } else {
            format!("no ball-end cutter fits with {} left on the surface", self.show(surface.leave))
        };
        let declared = self.span(self.program.tools[surface.tool].origin);
        let diagnostic = Diagnostic::new(code, self.span(origin), message)
            .label(declared, "the cutter")
            .label(self.span(net.origin), "the surface")
            .help(help);
        if surface.avoid {
            return diagnostic.note("the path is lifted there: nothing is gouged, and material stays");
        }
        diagnostic
    }

    /// Every place must have a normal towards the tool.
    pub(super) fn upright(
        &mut self,
        (net, tree): (Handle<NetEntity>, &SurfaceTree),
        origin: Handle<Origin>,
    ) -> bool {
        if tree.is_upright() {
            return true;
        }
        let Some((p, [u, v])) = overhang(tree) else { return true };
        let net = &self.program.nets[net];
        let message = format!(
            "{} folds over, stands upright or has no normal at ({}, {}, {}), u {u:.4}, v {v:.4}: a cutter from above cannot reach it",
            net.name,
            self.show(p.x),
            self.show(p.y),
            self.show(p.z)
        );
        let diagnostic = Diagnostic::new(&codes::OVERHANG, self.span(origin), message)
            .label(self.span(net.origin), "the surface")
            .help("poles that coincide, change their order or lie on top of each other do that");
        self.report(diagnostic, origin);
        false
    }

    /// The clearance plane must be above the surface with what is left on it, and above the blank.
    pub(super) fn clears(
        &mut self,
        (clearance, leave, stock_top): (f64, f64, Option<f64>),
        tree: &SurfaceTree,
        origin: Handle<Origin>,
    ) -> bool {
        let top = tree.bounds().1.z + leave;
        let highest = top.max(stock_top.unwrap_or(top));
        if clearance > highest {
            return true;
        }
        let message = format!(
            "the clearance plane is at Z {}, and the surface or its blank reaches up to Z {}",
            self.show(clearance),
            self.show(highest)
        );
        let help = format!(
            "write `CLEARP/ {}`",
            crate::cl::print::number((highest + 5.0).ceil() / self.program.units.in_mm())
        );
        let diagnostic = Diagnostic::new(&codes::CLEARANCE_TOO_LOW, self.span(origin), message).help(help);
        self.report(diagnostic, origin);
        false
    }

    /// Bounds on the surface tell too little for its distances to be found in bearable time.
    pub(super) fn too_uneven(&mut self, net: Handle<NetEntity>, origin: Handle<Origin>) {
        let net = &self.program.nets[net];
        let message = format!(
            "distances from {} take more work than can be done: its poles or its weights are too uneven for bounds to tell where it is near",
            net.name
        );
        let diagnostic = Diagnostic::new(&codes::NO_PASSES, self.span(origin), message)
            .label(self.span(net.origin), "the surface")
            .help("weights that differ by less, or poles that lie more evenly, describe nearly the same surface; a net of several patches does so for steep ones");
        self.report(diagnostic, origin);
    }

    fn no_passes(&mut self, why: &str, origin: Handle<Origin>) {
        let diagnostic = Diagnostic::new(&codes::NO_PASSES, self.span(origin), why.to_owned())
            .help("give a larger height of cusps or step, or another direction of passes");
        self.report(diagnostic, origin);
    }

    fn passes(
        &mut self,
        (surface, band): (&Surface, Band),
        name: &str,
        finish: Finish,
        legs: &[Leg],
        origin: Handle<Origin>,
    ) {
        let top = finish.tree.bounds().1.z + surface.leave;
        let top = top.max(surface.stock_top.unwrap_or(top));
        let heights = Heights { clearance: surface.clearance, approach: surface.clearance.min(top + ABOVE) };
        let tip = finish.cutter.lift();
        let bottom = finish.tree.bounds().0.z;
        let guard = Guard { surface: Some(finish), top, bottom, ..Guard::default() };
        let operation = Operation {
            name: name.to_owned(),
            kind: kind(surface),
            origin,
            band: surface.band,
            guard,
            effort: None,
        };
        let index = self.begin(operation, origin);
        for run in legs.split_inclusive(|leg| leg.last) {
            self.run((run, band, surface.shape), tip, heights, origin);
        }
        self.emit(RecordKind::EndOperation(index), origin);
    }

    /// One stay on the surface: onto it, along it, off it.
    fn run(
        &mut self,
        (run, band, shape): (&[Leg], Band, PassShape),
        tip: f64,
        heights: Heights,
        origin: Handle<Origin>,
    ) {
        let (Some(first), Some(last)) = (run.first(), run.last()) else { return };
        let way_in = entry::onto(&first.track);
        let tips = |points: &[Point3]| -> Vec<Point3> {
            points.iter().map(|p| Point3::new(p.x, p.y, p.z - tip)).collect()
        };
        let way_in = tips(&way_in);
        if let Some(start) = way_in.first() {
            self.rapid(Point3::new(start.x, start.y, heights.clearance), origin);
            self.rapid(Point3::new(start.x, start.y, heights.approach.max(start.z)), origin);
        }
        for p in &way_in {
            self.linear(*p, origin);
        }
        for leg in run {
            let pass =
                Pass { track: leg.track.clone(), tip, band, link: leg.link, shape, room: leg.room.clone() };
            self.emit(RecordKind::Pass(Box::new(pass)), origin);
        }
        let mut way_out = tips(&entry::onto(&last.track.reversed()));
        way_out.reverse();
        for p in &way_out {
            self.linear(*p, origin);
        }
        if let Some(end) = way_out.last() {
            self.rapid(Point3::new(end.x, end.y, heights.clearance), origin);
        }
    }
}

/// Tip heights of the travel to and from the surface, mm.
#[derive(Debug, Clone, Copy)]
struct Heights {
    clearance: f64,
    approach: f64,
}

/// The statement's word.
fn kind(surface: &Surface) -> &'static str {
    if surface.rough { "ROUGH" } else { "SURFAC" }
}

fn cusp(spacing: Spacing) -> Option<f64> {
    match spacing {
        Spacing::Cusp(h) => Some(h),
        Spacing::Step(_) => None,
    }
}

/// A place where the surface has no normal that points up, found among many.
fn overhang(tree: &SurfaceTree) -> Option<(Point3, [f64; 2])> {
    const PLACES: u32 = 48;
    const LEAST: f64 = 1e-3;
    let net = tree.net();
    for (index, patch) in net.patches().iter().enumerate() {
        let columns = net.size()[1];
        let corner = [crate::math::count(index / columns), crate::math::count(index % columns)];
        let mut sense = 0.0;
        for k in 0..=PLACES * (PLACES + 2) {
            let [u, v] = [k / (PLACES + 1), k % (PLACES + 1)].map(|i| f64::from(i) / f64::from(PLACES));
            let jet = patch.jet(u, v);
            let w = jet.u.cross(&jet.v);
            let upright = w.z.abs() > LEAST * w.norm() && w.z * sense >= 0.0;
            if !upright {
                return Some((jet.p, [corner[0] + u, corner[1] + v]));
            }
            sense = w.z.signum();
        }
    }
    None
}

/// The contact where a track begins.
fn start_of(track: &Track) -> Option<Contact> {
    track.at(0.0, None)
}
