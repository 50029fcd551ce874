//! `ROUGH` of a plate cam: from a blank to the contour with its allowance.
//!
//! Two plans are made, and the quicker one that keeps the radial depth is taken:
//! - **rings** ([`rings`]): curves parallel to the contour, each cut only where the blank reaches out of it, from
//!   the outermost inwards and to and fro, then once round the contour. The radial depth is the ring spacing
//!   everywhere, so every pass but its ends cuts at full depth;
//! - **circles** ([`circles`]): the plan of Kim & Yang (1991), section 3.4: circles about the cam's centre,
//!   cut only where they lie outside the contour, to and fro, then once round the contour.
//!
//! Both start with full circles where the blank is larger than the cam's largest radius, and leave an allowance.

mod circles;
mod moves;
mod passes;
mod rings;
mod slot;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use super::Planner;
use super::levels::levels;
use super::profile::{APPROACH, guard, part_side, rough_contour};
use super::room::Samples;
use super::state::Ready;
use crate::arena::Handle;
use crate::cl::{Effort, Operation, RecordKind, Wall};
use crate::diag::Diagnostic;
use crate::diag::codes::planning::{NO_ROUGHING_PLAN, ROUGHING_FIGURES, STOCK_NOT_ROUND, STOCK_TOO_SMALL};
use crate::geom::curve::{CurveRef, Frenet, Offset, Reversed};
use crate::geom::{Point2, Point3, Side, Vec2};
use crate::ir::{Band, Flank, Origin, RoughCam, StockShape};
use moves::{Move, Plan};

/// Air between cutter and blank where the cutter goes down, mm.
const CLEAR: f64 = 1.0;
/// Passes of one level at most.
const MOST_PASSES: usize = 1000;
/// Radius by which a blank may seem too small, mm: less than any blank is made to.
const BLANK_SLACK: f64 = 1e-3;

/// What a plan is made for: one level of one cam.
pub(super) struct Job {
    /// The finished profile, directed as the pass round the contour travels.
    pub profile: CurveRef,
    /// Its samples.
    pub samples: Samples,
    /// The part's side of it.
    pub part: Side,
    /// Radius of the blank, mm.
    pub blank: f64,
    /// Distance from the centre at which the cutter is clear of the blank as it comes, mm.
    pub outside: f64,
    /// Cutter radius, mm.
    pub cutter: f64,
    /// Largest radial depth of cut, mm.
    pub step: f64,
    /// Stock left on the profile, mm.
    pub leave: f64,
    /// Tolerance of the operation.
    pub band: Band,
}

impl Job {
    /// Largest and smallest distance of the profile from the centre, mm.
    fn reach(&self) -> (f64, f64) {
        let radii = self.samples.points.iter().map(|(_, f)| f.p.coords.norm());
        radii.fold((0.0, f64::INFINITY), |(most, least), r| (f64::max(most, r), f64::min(least, r)))
    }

    /// Area between the blank and the profile with its allowance, mm².
    fn area(&self) -> f64 {
        let blank = core::f64::consts::PI * self.blank * self.blank;
        blank - enclosed(&self.samples, self.part.opposite(), self.leave)
    }

    /// The curve at `distance` mm outside the profile.
    fn parallel(&self, distance: f64) -> CurveRef {
        Arc::new(Offset::new(self.profile.clone(), self.part.opposite().sign() * distance))
    }

    /// Unit normal of the profile away from the part.
    fn outward(&self, f: &Frenet) -> Vec2 {
        f.n() * self.part.opposite().sign()
    }
}

/// Area within the curve at `offset` mm to the side `away` of a sampled closed curve, mm².
fn enclosed(samples: &Samples, away: Side, offset: f64) -> f64 {
    let twice: f64 = samples
        .points
        .windows(2)
        .map(|pair| {
            let [a, b] = [pair[0].1, pair[1].1].map(|f| f.p.coords + f.n() * (away.sign() * offset));
            crate::geom::cross(a, b)
        })
        .sum();
    0.5 * twice.abs()
}

impl Planner<'_> {
    pub(super) fn rough(&mut self, rough: &RoughCam, origin: Handle<Origin>) {
        let what = self.operation_name("ROUGH", rough.name.as_deref());
        let ready = self.ready(&what, Some(rough.tool), origin);
        let reaches = self.check_cutter(rough.tool, rough.depth, origin);
        let part = part_side(rough.cut, ready.is_none_or(|r| r.clockwise));
        if self.program.cams[rough.cam].cam.definition().groove {
            return self.rough_groove(rough, part, (&what, ready.filter(|_| reaches)), origin);
        }
        let job = self.job(rough, part, origin);
        let (Some(ready), true, Some(job)) = (ready, reaches, job) else { return };
        match best_plan(&job) {
            Some(plan) => {
                let least = (job.area(), job.area() / job.step);
                self.emit_plan(rough, job.blank, (&plan, least), (&what, ready), origin);
            }
            None => self.no_plan(rough, origin),
        }
    }

    /// A groove is slotted; its blank only has to be there.
    fn rough_groove(
        &mut self,
        rough: &RoughCam,
        part: Side,
        (name, ready): (&str, Option<Ready>),
        origin: Handle<Origin>,
    ) {
        let cutter = self.program.tools[rough.tool].diameter / 2.0;
        let flanks = [Flank::Inner, Flank::Outer];
        let fits = flanks.iter().all(|f| self.cutter_fits_cam(rough.cam, *f, (cutter, rough.leave), origin));
        let blank = self.blank(rough, origin);
        let (Some(ready), true, Some(blank)) = (ready, fits, blank) else { return };
        let count = levels(rough.depth, rough.axial_step).len() as f64;
        let groove = slot::Groove {
            cam: &self.program.cams[rough.cam].cam,
            cutter,
            leave: rough.leave,
            step: rough.radial_step,
            drop: rough.depth / count,
            part,
            band: rough.band,
        };
        let plan = slot::plan(&groove);
        let width = 2.0 * (groove.cam.definition().follower.roller() - rough.leave);
        let area = groove.length() * width;
        let least = (area, area / (2.0 * cutter));
        self.emit_plan(rough, blank, (&plan, least), (name, ready), origin);
    }

    fn no_plan(&mut self, rough: &RoughCam, origin: Handle<Origin>) {
        let message = format!(
            "no roughing plan of at most {MOST_PASSES} passes clears the blank with radial steps of {}",
            self.show(rough.radial_step)
        );
        let diagnostic = Diagnostic::new(&NO_ROUGHING_PLAN, self.span(origin), message)
            .help("take a larger STEP (or WIDTH); a cam that is not seen whole from its centre cannot be roughed by circles");
        self.report(diagnostic, origin);
    }

    fn job(&mut self, rough: &RoughCam, part: Side, origin: Handle<Origin>) -> Option<Job> {
        let entity = &self.program.cams[rough.cam];
        let flank = entity.cam.flank(Flank::Inner);
        let material = entity.cam.material(Flank::Inner);
        let profile: CurveRef = if material == part { flank } else { Arc::new(Reversed::new(flank)) };
        let cutter = self.program.tools[rough.tool].diameter / 2.0;
        let blank = self.blank(rough, origin)?;
        let job = Job {
            samples: Samples::new(profile.as_ref()),
            profile,
            part,
            blank,
            outside: blank + cutter + CLEAR,
            cutter,
            step: rough.radial_step,
            leave: rough.leave,
            band: rough.band,
        };
        let large_enough = self.check_blank(rough, &job, origin);
        let fits = self.cutter_fits_cam(rough.cam, Flank::Inner, (cutter, rough.leave), origin);
        (large_enough && fits).then_some(job)
    }

    fn blank(&mut self, rough: &RoughCam, origin: Handle<Origin>) -> Option<f64> {
        let stock = &self.program.stocks[rough.stock];
        if let StockShape::Round { radius, .. } = stock.shape {
            return Some(radius);
        }
        let message =
            format!("stock {} is a block, but a plate cam is roughed from a round blank", stock.name);
        let declared = self.span(stock.origin);
        let diagnostic = Diagnostic::new(&STOCK_NOT_ROUND, self.span(origin), message)
            .label(declared, "the blank is declared here")
            .help(format!(
                "declare the round that the block holds: `{} = STOCK/ ROUND, 42, HEIGHT, 10`",
                stock.name
            ));
        self.report(diagnostic, origin);
        None
    }

    fn check_blank(&mut self, rough: &RoughCam, job: &Job, origin: Handle<Origin>) -> bool {
        let (most, _) = job.reach();
        let need = most + job.leave;
        if job.blank >= need - BLANK_SLACK {
            return true;
        }
        let stock = &self.program.stocks[rough.stock];
        let allowance = if job.leave > 0.0 {
            format!(" with {} left on it", self.show(job.leave))
        } else {
            String::new()
        };
        let message = format!(
            "the blank has a radius of {}, but the cam{allowance} reaches {}, {} more",
            self.show(job.blank),
            self.show(need),
            self.show(need - job.blank)
        );
        let declared = self.span(stock.origin);
        let diagnostic = Diagnostic::new(&STOCK_TOO_SMALL, self.span(origin), message)
            .label(declared, "the blank is declared here")
            .help(format!("a blank of at least {} radius is needed", self.show(need)));
        self.report(diagnostic, origin);
        false
    }

    fn emit_plan(
        &mut self,
        rough: &RoughCam,
        blank: f64,
        (plan, least): (&Plan, (f64, f64)),
        (name, ready): (&str, Ready),
        origin: Handle<Origin>,
    ) {
        let heights = levels(rough.depth, rough.axial_step);
        let effort = effort(plan, least, heights.len(), ready);
        let mut guard = guard(self.walls(rough), rough.depth);
        guard.blank_radius = Some(blank);
        let operation = Operation {
            name: name.to_owned(),
            kind: "ROUGH",
            origin,
            band: rough.band,
            guard,
            effort: Some(effort),
        };
        let index = self.begin(operation, origin);
        let mut above = 0.0;
        for z in heights {
            for step in &plan.moves {
                self.emit_move(step, (above, z), rough.clearance, origin);
            }
            above = z;
        }
        self.emit(RecordKind::EndOperation(index), origin);
        self.note_effort(name, &effort, origin);
    }

    fn walls(&self, rough: &RoughCam) -> Vec<Wall> {
        let cam = &self.program.cams[rough.cam].cam;
        let radius = self.program.tools[rough.tool].diameter / 2.0;
        let wall = |flank: &Flank| Wall { centre: cam.centre(*flank, radius), part: cam.material(*flank) };
        cam.definition().flanks().iter().map(wall).collect()
    }

    fn emit_move(&mut self, step: &Move, (above, z): (f64, f64), clearance: f64, origin: Handle<Origin>) {
        match step {
            Move::Down(p) => {
                self.rapid(Point3::new(p.x, p.y, clearance), origin);
                self.rapid(Point3::new(p.x, p.y, z), origin);
            }
            Move::Up(p) => {
                self.linear(Point3::new(p.x, p.y, z), origin);
                self.rapid(Point3::new(p.x, p.y, clearance), origin);
            }
            Move::Ramp(points) => self.ramp(points, (above, z), clearance, origin),
            Move::Link(p) => self.linear(Point3::new(p.x, p.y, z), origin),
            Move::Cut { curve, part, band } => {
                let contour = rough_contour(curve.clone(), *part, *band, z, clearance);
                self.emit(RecordKind::Contour(Box::new(contour)), origin);
            }
        }
    }

    fn ramp(
        &mut self,
        points: &[(Point2, f64)],
        (above, z): (f64, f64),
        clearance: f64,
        origin: Handle<Origin>,
    ) {
        let Some((first, _)) = points.first() else { return };
        self.rapid(Point3::new(first.x, first.y, clearance), origin);
        self.rapid(Point3::new(first.x, first.y, clearance.min(APPROACH)), origin);
        self.linear(Point3::new(first.x, first.y, above), origin);
        for (p, share) in points.iter().skip(usize::from(points.len() > 1)) {
            self.linear(Point3::new(p.x, p.y, above + (z - above) * share), origin);
        }
    }

    fn note_effort(&mut self, name: &str, effort: &Effort, origin: Handle<Origin>) {
        let short = |mm: f64| self.show((mm * 10.0).round() / 10.0);
        let time = effort.time.map_or(String::new(), |t| format!(", {:.0} s at the feed", t));
        let message = format!(
            "{name}: {} of path in the stock and {} between passes{time}, in {} level{}",
            short(effort.engaged),
            short(effort.links),
            effort.levels,
            if effort.levels == 1 { "" } else { "s" }
        );
        let diagnostic = Diagnostic::new(&ROUGHING_FIGURES, self.span(origin), message)
            .note(format!(
                "{} of path are the least for this area and step: {} mm² a level",
                short(effort.bound),
                (effort.area * 10.0).round() / 10.0
            ))
            .note(format!("the cutter meets at most {} across the feed", self.show(effort.engagement)));
        self.report(diagnostic, origin);
    }
}

/// The band of the pass round the contour: it may not go deeper into the allowance than half of it.
fn contour_band(job: &Job, loose: Band) -> Band {
    if job.leave > 0.0 { Band { into: loose.into.min(0.5 * job.leave), out: loose.out } } else { job.band }
}

/// `least`: area of a level, mm², and the least path for it, mm.
fn effort(plan: &Plan, (area, least): (f64, f64), count: usize, ready: Ready) -> Effort {
    let levels = u32::try_from(count).unwrap_or(u32::MAX);
    let times = f64::from(levels);
    let (engaged, links) = (plan.engaged * times, plan.links * times);
    Effort {
        engaged,
        links,
        time: ready.per_minute().map(|feed| (engaged + links) / feed * 60.0),
        area,
        engagement: plan.engagement,
        levels,
        bound: least * times,
    }
}

/// The plan with the shortest path at feed among those that keep the radial depth; where none does, the one that
/// comes nearest to it.
fn best_plan(job: &Job) -> Option<Plan> {
    /// How much more than the step the cutter may meet, as a share of it.
    const MORE: f64 = 1.05;
    let excess = |plan: &Plan| (plan.engagement - MORE * job.step).max(0.0);
    let plans = [rings::plan(job), circles::plan(job)];
    plans
        .into_iter()
        .flatten()
        .min_by(|a, b| excess(a).total_cmp(&excess(b)).then(a.length().total_cmp(&b.length())))
}
