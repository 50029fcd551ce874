//! `ROUGH` of a net in levels: planes through the surface raised by what is left, cleared one by one from above.
//!
//! [`ground`] knows Z(x, y), how low the tip may come; [`slice`] makes of a plane the region {Z <= z} and the rings that clear
//! it; [`path`] joins them. The region is planned with a margin beyond what is left. It covers what a grid cannot see: between
//! nodes g apart no peak of Z is higher than g²/4R above them, because Z is an upper envelope of cutters turned upside
//! down, and a peak of it is the top of one (R its rounding; a flat one as wide as that is seen by a node); it covers chords
//! between points of the waterline and the tolerance of the arcs, too.

mod arcs;
mod between;
mod chain;
mod entry;
mod glide;
mod ground;
mod link;
mod march;
mod path;
mod slice;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use super::Planner;
use super::profile::part_side;
use super::state::Ready;
use crate::arena::Handle;
use crate::cl::{Circle, Clearing, Effort, Finish, Guard, Level, Operation, RecordKind};
use crate::diag::Diagnostic;
use crate::diag::codes::planning as codes;
use crate::geom::surface::heights::{Blank, HeightField};
use crate::geom::surface::{Cutter, Island, Standing, SurfaceTree};
use crate::geom::{Point2, Point3, Side, Vec3};
use crate::ir::{Origin, RoughNet, StockShape};
use crate::math::count;
use ground::{Ground, Rest};
use path::{Manner, Move, Path, Tally};
use slice::Spread;

/// Air between cutter and blank where the cutter goes down beside it, mm.
const CLEAR: f64 = 1.0;
/// Rapids run across so far above the blank, mm, clearance permitting.
const ABOVE: f64 = 2.0;
/// Margin of the plan beyond what is left: share of the radius, and at least, mm.
const MARGIN: (f64, f64) = (0.01, 0.02);
/// Shares of the margin for the path beside the rings, and for arcs on the grid of the control.
const FIT: f64 = 0.4;
const GRID: f64 = 0.2;
/// Arcs may always be off by this, mm.
const ROUNDING: f64 = 0.004;
/// Rings are this share of the step apart: what their tolerance leaves of it.
const APART: f64 = 0.985;
/// Cells of the stock, as a share of the radius.
pub(crate) const CELLS: f64 = 0.05;
/// Cells in which islands are looked for, as a share of the radius.
pub(crate) const ISLANDS: f64 = 0.1;
/// Islands no larger than a square of this share of the radius are not told.
const TRIFLE: f64 = 0.2;
/// Chords of arcs where they are, mm.
const CHORDS: f64 = 2e-3;
/// Levels at most.
const MOST_LEVELS: f64 = 2000.0;

/// A plan: where the cutter goes, and what it clears.
struct Plan {
    moves: Vec<Move>,
    tally: Tally,
    levels: Vec<Level>,
    /// What stands at some levels, with their heights.
    islands: Vec<(f64, Island)>,
    /// Length of all waterlines, mm.
    waterlines: f64,
}

/// The plan's measures.
struct Job {
    ground: Ground,
    manner: Manner,
    stock: HeightField,
    /// Top of the blank and lowest height of the tip, mm.
    top: f64,
    low: f64,
    margin: f64,
}

impl Planner<'_> {
    pub(super) fn rough_net(&mut self, rough: &RoughNet, origin: Handle<Origin>) {
        let name = self.operation_name("ROUGH", rough.name.as_deref());
        let ready = self.ready(&name, Some(rough.tool), origin);
        // Tools of another shape were refused with the statement.
        let tool = &self.program.tools[rough.tool];
        let cutter = tool.solid().unwrap_or_else(|| Cutter::ball(tool.diameter / 2.0));
        let radius = cutter.radius();
        let reach = radius * (1.0 + MARGIN.0) + rough.leave + 1.0;
        let tree = Arc::new(SurfaceTree::new(self.program.nets[rough.net].net.clone(), reach));
        let (blank, top) = blank(&self.program.stocks[rough.stock].shape);
        let upright = self.upright((rough.net, &tree), origin);
        let clear = self.clears((rough.clearance, rough.leave, Some(top)), &tree, origin);
        let wide = self.wide(rough, &cutter, origin);
        let (true, true, true, Some(ready)) = (upright, clear, wide, ready) else { return };
        let wall_left = part_side(rough.cut, ready.clockwise) == Side::Left;
        let Some(job) = job(rough, (Arc::clone(&tree), cutter), (blank, top), wall_left) else {
            return self.no_stock(rough, top, None, origin);
        };
        if job.low >= top {
            return self.no_stock(rough, top, Some(job.low), origin);
        }
        let plan = clear_all(&job, rough);
        if tree.is_exhausted() {
            return self.too_uneven(rough.net, origin);
        }
        let finish = Finish { tree, radius, cutter, leave: rough.leave, cusp: None, march: None };
        self.emit_clearing(rough, (&name, ready), &job, (&plan, finish), origin);
        self.tell_islands((&name, rough), &plan, origin);
        self.tell_entries(&name, &plan.tally, origin);
        self.tell_teeth((&name, rough), (&cutter, &plan.tally), origin);
    }

    /// Rings must overlap at the top of a level.
    fn wide(&mut self, rough: &RoughNet, solid: &Cutter, origin: Handle<Origin>) -> bool {
        let most = 2.0 * solid.half_width(rough.step);
        if rough.width <= most {
            return true;
        }
        let cutter = &self.program.tools[rough.tool];
        let message = format!(
            "passes {} apart leave walls between them: cutter {} is {} wide at a depth of {}",
            self.show(rough.width),
            cutter.name,
            self.show((most * 1000.0).floor() / 1000.0),
            self.show(rough.step)
        );
        let diagnostic = Diagnostic::new(&codes::ROUGH_TOO_WIDE, self.span(origin), message)
            .label(self.span(cutter.origin), "the cutter")
            .help(format!(
                "write a WIDTH of at most {}; half of the cutter's width is usual",
                self.show((most * 1000.0).floor() / 1000.0)
            ));
        self.report(diagnostic, origin);
        false
    }

    /// There is nothing to clear: the blank ends below the surface, or beside it.
    fn no_stock(&mut self, rough: &RoughNet, top: f64, low: Option<f64>, origin: Handle<Origin>) {
        let (stock, net) = (&self.program.stocks[rough.stock], &self.program.nets[rough.net]);
        let message = match low {
            Some(low) => format!(
                "there is nothing to clear: stock {} reaches up to Z {}, and the cutter on {} with {} left comes down to Z {}",
                stock.name,
                self.show(top),
                net.name,
                self.show(rough.leave),
                self.show(low)
            ),
            None => {
                format!("there is nothing to clear: stock {} does not lie under {}", stock.name, net.name)
            }
        };
        let diagnostic = Diagnostic::new(&codes::NOTHING_TO_CLEAR, self.span(origin), message)
            .label(self.span(stock.origin), "the blank")
            .label(self.span(net.origin), "the surface")
            .help("declare the blank as it lies about the surface, in the same coordinates");
        self.report(diagnostic, origin);
    }

    fn emit_clearing(
        &mut self,
        rough: &RoughNet,
        (name, ready): (&str, Ready),
        job: &Job,
        (plan, finish): (&Plan, Finish),
        origin: Handle<Origin>,
    ) {
        let area: f64 = plan.levels.iter().map(|l| l.area).sum();
        let length = plan.tally.rings + plan.tally.entries + plan.tally.links;
        let effort = Effort {
            engaged: plan.tally.rings + plan.tally.entries,
            links: plan.tally.links,
            time: ready.per_minute().map(|feed| length / feed * 60.0),
            area: area / count(plan.levels.len().max(1)),
            engagement: rough.width,
            levels: u32::try_from(plan.levels.len()).unwrap_or(u32::MAX),
            bound: area / rough.width,
        };
        let clearing = Clearing {
            blank: job.ground.blank,
            top: job.top,
            step: rough.step,
            margin: job.margin,
            levels: plan.levels.clone(),
        };
        let top = finish.tree.bounds().1.z.max(job.top);
        let guard = Guard {
            surface: Some(finish),
            clearing: Some(clearing),
            top,
            bottom: job.low,
            ..Guard::default()
        };
        let band = rough.band;
        let operation =
            Operation { name: name.to_owned(), kind: "ROUGH", origin, band, guard, effort: Some(effort) };
        let index = self.begin(operation, origin);
        let tolerance = (GRID * job.margin).max(ROUNDING) + band.into.min(band.out);
        let mut last = None;
        for step in &plan.moves {
            if last.is_none()
                && let Move::Rapid(p) = step
            {
                self.rapid(Point3::new(p.x, p.y, rough.clearance), origin);
            }
            last = Some(self.emit_step(step, tolerance, origin));
        }
        if let Some(p) = last {
            self.rapid(Point3::new(p.x, p.y, rough.clearance), origin);
        }
        self.emit(RecordKind::EndOperation(index), origin);
        self.tell_effort(name, &effort, plan, origin);
    }

    fn emit_step(&mut self, step: &Move, tolerance: f64, origin: Handle<Origin>) -> Point3 {
        match *step {
            Move::Rapid(p) => {
                self.rapid(p, origin);
                p
            }
            Move::Line(p) => {
                self.linear(p, origin);
                p
            }
            Move::Arc { to, centre, ccw, turns } => {
                let axis = Vec3::new(0.0, 0.0, if ccw { 1.0 } else { -1.0 });
                let centre = Point3::new(centre.x, centre.y, to.z);
                self.emit(
                    RecordKind::Circle(Box::new(Circle { to, centre, axis, turns, tolerance })),
                    origin,
                );
                to
            }
        }
    }

    fn tell_effort(&mut self, name: &str, effort: &Effort, plan: &Plan, origin: Handle<Origin>) {
        let tenth = |v: f64| (v * 10.0).round() / 10.0;
        let time = effort.time.map_or(String::new(), |t| format!(", {t:.0} s at the feed"));
        let message = format!(
            "{name}: {} of path in the stock, {} of it on the way down, and {} between passes{time}, in {} level{}",
            self.show(tenth(effort.engaged)),
            self.show(tenth(plan.tally.entries)),
            self.show(tenth(effort.links)),
            effort.levels,
            if effort.levels == 1 { "" } else { "s" }
        );
        let feed = effort.time.map(|t| t / (effort.engaged + effort.links).max(1e-9));
        let least = feed.map_or(String::new(), |per| format!(", {:.0} s at the feed", per * effort.bound));
        let areas: Vec<String> = plan.levels.iter().map(|l| format!("{:.1}", tenth(l.area))).collect();
        let diagnostic = Diagnostic::new(&codes::ROUGHING_FIGURES, self.span(origin), message)
            .note(format!(
                "cleared area {:.1} mm²; over the step that is {}{least}",
                plan.levels.iter().map(|l| tenth(l.area)).sum::<f64>(),
                self.show(tenth(effort.bound))
            ))
            .note(format!(
                "{} of waterlines: a pass along a wall has half of its step only on one side",
                self.show(tenth(plan.waterlines))
            ))
            .note(format!("areas of the levels, mm²: {}", areas.join(", ")));
        self.report(diagnostic, origin);
    }

    /// What stands where no way leads to, or where there is no way down.
    fn tell_islands(&mut self, (name, rough): (&str, &RoughNet), plan: &Plan, origin: Handle<Origin>) {
        let largest = plan.islands.iter().max_by(|a, b| a.1.area.total_cmp(&b.1.area));
        let trifle = TRIFLE * self.program.tools[rough.tool].diameter / 2.0;
        let Some((z, island)) = largest.filter(|l| l.1.area > trifle * trifle) else { return };
        let levels = plan.levels.iter().filter(|l| l.standing > 0.0).count();
        let message = format!(
            "{name}: {:.2} mm² of stock stand untouched at {levels} of {} levels, in {} places; the largest is {:.2} mm² at X {}, Y {}, Z {}",
            plan.levels.iter().map(|l| l.standing).sum::<f64>(),
            plan.levels.len(),
            plan.islands.len(),
            island.area,
            self.show((island.place.x * 1000.0).round() / 1000.0),
            self.show((island.place.y * 1000.0).round() / 1000.0),
            self.show(*z)
        );
        let tool = &self.program.tools[rough.tool];
        let diagnostic = Diagnostic::new(&codes::STOCK_STANDS, self.span(origin), message)
            .label(self.span(tool.origin), "the cutter")
            .note("the tip may stand there, but there is no way down, or no free way to it")
            .help("a smaller cutter or a steeper RAMP reaches there; finishing meets this stock otherwise");
        self.report(diagnostic, origin);
    }

    /// How near to the axis end teeth must reach, where the cutter is none that always has them there.
    fn tell_teeth(
        &mut self,
        (name, rough): (&str, &RoughNet),
        (cutter, tally): (&Cutter, &Tally),
        origin: Handle<Origin>,
    ) {
        let Some(narrowest) = tally.narrowest.filter(|r| !cutter.is_ball() && *r < cutter.radius()) else {
            return;
        };
        let tool = &self.program.tools[rough.tool];
        let message = format!(
            "{name}: the narrowest way down into material has a radius of {}: end teeth of {} must reach nearer to the axis",
            self.show((narrowest * 1000.0).round() / 1000.0),
            tool.name
        );
        let diagnostic = Diagnostic::new(&codes::TEETH_AT_CENTRE, self.span(origin), message)
            .label(self.span(tool.origin), "the cutter")
            .note("a cutter that cuts to its centre may go down so");
        self.report(diagnostic, origin);
    }

    /// Where there is no room for a helix, or none at all.
    fn tell_entries(&mut self, name: &str, tally: &Tally, origin: Handle<Origin>) {
        if tally.along_ring > 0 {
            let message = format!(
                "{name}: {} of its pockets have no room for a helix; the cutter goes down along their first ring",
                tally.along_ring
            );
            self.report(Diagnostic::new(&codes::NO_ROOM_FOR_HELIX, self.span(origin), message), origin);
        }
        let (left_out, largest) = tally.skipped;
        if left_out > 0 {
            let message = format!(
                "{name}: {left_out} pockets are too small to go down into, the largest {} across; they are left to finishing",
                self.show(largest)
            );
            let diagnostic = Diagnostic::new(&codes::NO_ROOM_FOR_HELIX, self.span(origin), message)
                .help("a smaller cutter or a steeper RAMP reaches into them");
            self.report(diagnostic, origin);
        }
    }
}

/// Outline and top of a blank.
fn blank(shape: &StockShape) -> (Blank, f64) {
    match *shape {
        StockShape::Round { radius, .. } => (Blank::Disc { radius }, 0.0),
        StockShape::Block { min, max } => (Blank::Block { low: min.xy(), high: max.xy() }, max.z),
    }
}

fn job(
    rough: &RoughNet,
    (tree, cutter): (Arc<SurfaceTree>, Cutter),
    (blank, top): (Blank, f64),
    wall_left: bool,
) -> Option<Job> {
    let radius = cutter.radius();
    let step = ground::spacing(radius, &blank, &tree);
    let margin = (MARGIN.0 * radius).max(MARGIN.1).max(step * step / radius);
    let safe = rough.clearance.min(top.max(tree.bounds().1.z + rough.leave) + ABOVE);
    let rest = Rest::new(tree, cutter, rough.leave + margin);
    let stock = HeightField::new(&blank, top, CELLS * radius);
    let reach = cutter.half_width(rough.step) - FIT * margin;
    let manner = Manner {
        // Half of it is reached in any case.
        width: (APART * rough.width).min(between::widest(reach, step).max(0.5 * APART * rough.width)),
        reach,
        air: radius + CLEAR + 2.0 * stock.cell(),
        safe,
        ramp: crate::math::tan(rough.ramp),
        tolerance: FIT * margin,
        wall_left,
        inward: rough.inward,
    };
    let ground = Ground::new(rest, blank, step, manner.air);
    let low = ground.lowest()?;
    Some(Job { ground, manner, stock, top, low, margin })
}

fn clear_all(job: &Job, rough: &RoughNet) -> Plan {
    let Job { ground, manner, stock, top, low, margin } = job;
    let cutter = ground.rest.cutter;
    let mut path = Path::new(ground, *manner, stock.clone());
    let kept = (cutter, rough.leave + margin);
    let mut standing = Standing::new(&ground.rest.tree, kept, ground.blank, ISLANDS * cutter.radius());
    let (mut levels, mut islands, mut waterlines) = (Vec::new(), Vec::new(), 0.0);
    let spread = Spread { width: manner.width, reach: manner.reach, air: manner.air };
    for z in heights((*top, *low), rough.step) {
        let Some(slice) = slice::slice(ground, z, spread) else { continue };
        let before = path.moves.len();
        path.level(&slice);
        let found = standing.after(z, &ways(&path.moves[before..], z), cutter.half_width(rough.step));
        levels.push(Level { z, area: slice.area, standing: found.iter().fold(0.0, |sum, i| sum + i.area) });
        waterlines += slice.waterline();
        islands.extend(found.into_iter().map(|island| (z, island)));
    }
    path.lift();
    Plan { moves: path.moves, tally: path.tally, levels, islands, waterlines }
}

/// The straight ways of moves along a level.
fn ways(moves: &[Move], z: f64) -> Vec<(Point2, Point2)> {
    let mut ways = Vec::new();
    let mut at: Option<Point3> = None;
    for step in moves {
        let to = step.end();
        let points: Vec<Point3> = match (at, *step) {
            (Some(from), Move::Arc { to, centre, ccw, turns }) => {
                path::chords(from, (to, centre, ccw, turns), CHORDS).collect()
            }
            (Some(_), Move::Line(p)) => vec![p],
            _ => Vec::new(),
        };
        for p in points {
            let from = at.replace(p).unwrap_or(p);
            if (from.z - z).abs() < 1e-9 && (p.z - z).abs() < 1e-9 {
                ways.push((from.xy(), p.xy()));
            }
        }
        at = Some(to);
    }
    ways
}

/// Heights of the levels from the top of the blank to the lowest height of the tip; the last step may be shorter.
fn heights((top, low): (f64, f64), step: f64) -> Vec<f64> {
    let whole = ((top - low) / step).clamp(0.0, MOST_LEVELS);
    let levels = (whole - 1e-9).ceil().max(1.0);
    // At most MOST_LEVELS.
    (1..=levels as u32).map(|k| (top - f64::from(k) * step).max(low)).collect()
}
