//! What a program does in space, from the text that was proven: every move of the read-back with its line and use, the
//! surfaces it finishes, its blank and its cutters.

use crate::cl::{Cl, Finish, Operation, RecordKind};
use crate::driver::Output;
use crate::geom::curve::CurveRef;
use crate::geom::{Point2, Point3};
use crate::ir::{self, StockShape, Tool};
use crate::plot::PlotError;
use crate::readback::{self, EventKind, TraceMove, TracePath};
use crate::target::{Block, TargetProgram};
use crate::units::LengthUnit;
use crate::verify::{self, Certificate, RAPID_RATE};

/// What a move is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::plot) enum Use {
    /// At rapid.
    Rapid,
    /// Bulk stock is cut.
    Rough,
    /// Onto the part and off it.
    Entry,
    /// Between passes, at feed.
    Link,
    /// Along what is to be made.
    Cut,
}

/// All uses, in the order of their numbers.
pub(in crate::plot) const USES: [Use; 5] = [Use::Rapid, Use::Rough, Use::Entry, Use::Link, Use::Cut];

/// One move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::plot) struct Stroke {
    pub(in crate::plot) what: Use,
    /// Line of the text, from 1.
    pub(in crate::plot) line: u32,
    /// First and last of [`Scene::points`].
    pub(in crate::plot) from: u32,
    pub(in crate::plot) to: u32,
    pub(in crate::plot) length: f64,
    pub(in crate::plot) seconds: f64,
    /// mm/min; 0 at rapid.
    pub(in crate::plot) feed: f64,
    pub(in crate::plot) tool: u32,
    /// Index of the operation.
    pub(in crate::plot) operation: Option<u32>,
}

/// Everything that pictures in space show.
#[derive(Debug)]
pub(in crate::plot) struct Scene<'a> {
    pub(in crate::plot) title: String,
    pub(in crate::plot) post: &'a str,
    pub(in crate::plot) units: LengthUnit,
    pub(in crate::plot) text: &'a str,
    pub(in crate::plot) certificate: &'a Certificate,
    pub(in crate::plot) cl: &'a Cl,
    /// Tip positions; a move goes from its first to its last.
    pub(in crate::plot) points: Vec<Point3>,
    pub(in crate::plot) strokes: Vec<Stroke>,
    /// Moves of the read-back, as many as `strokes`.
    pub(in crate::plot) moves: Vec<(u32, TraceMove)>,
    pub(in crate::plot) tools: &'a [Tool],
    pub(in crate::plot) stocks: Vec<StockShape>,
    /// Edges of the part, and the heights between which they are walls.
    pub(in crate::plot) edges: Vec<CurveRef>,
}

impl<'a> Scene<'a> {
    /// The scene of a proven output.
    ///
    /// # Errors
    /// [`PlotError::NoPath`] when there is no proven text or it moves nothing.
    pub(in crate::plot) fn new(
        program: Option<&ir::Program>,
        cl: Option<&'a Cl>,
        output: &'a Output,
    ) -> Result<Scene<'a>, PlotError> {
        let parts = (cl, output.target.as_ref(), output.proven.as_ref());
        let (Some(cl), Some(target), Some(proven)) = parts else { return Err(PlotError::NoPath) };
        let certificate = proven.certificate();
        let setup = verify::setup(target);
        let trace = readback::run(proven.text().as_bytes(), &certificate.control, &setup)
            .map_err(|e| PlotError::Render(e.to_string()))?;
        let mut scene = Scene {
            title: title(cl),
            post: &output.post,
            units: cl.units,
            text: proven.text(),
            certificate,
            cl,
            points: Vec::new(),
            strokes: Vec::new(),
            moves: Vec::new(),
            tools: &target.tools,
            stocks: program.map_or_else(Vec::new, stocks),
            edges: program.map_or_else(Vec::new, crate::plot::views::part_edges),
        };
        let blocks = Blocks::new(cl, target, &output.lines);
        for event in trace.events {
            if let EventKind::Move(cut) = event.kind {
                scene.take(event.line, cut, &blocks);
            }
        }
        if scene.strokes.is_empty() { Err(PlotError::NoPath) } else { Ok(scene) }
    }

    /// Takes a move, if it is known where it starts and if it goes anywhere.
    fn take(&mut self, line: u32, cut: TraceMove, blocks: &Blocks<'_>) {
        let length = cut.length();
        if !cut.known.iter().all(|k| *k) || cut.parked || length <= 0.0 {
            return;
        }
        let start = cut.start();
        if self.points.last().is_none_or(|p| (p - start).norm() > NEAR) {
            self.points.push(start);
        }
        let from = self.points.len() - 1;
        self.points.extend(beyond_start(&cut));
        let index = |i: usize| u32::try_from(i).unwrap_or(u32::MAX);
        let block = blocks.of(line);
        let operation = blocks.operation(block);
        let feed = cut.feed.unwrap_or(0.0);
        let rate = if cut.rapid || feed <= 0.0 { RAPID_RATE } else { feed };
        self.strokes.push(Stroke {
            what: self.usage(&cut, block, operation),
            line,
            from: index(from),
            to: index(self.points.len() - 1),
            length,
            seconds: 60.0 * length / rate,
            feed: if cut.rapid { 0.0 } else { feed },
            tool: cut.tool,
            operation,
        });
        self.moves.push((line, cut));
    }

    fn usage(&self, cut: &TraceMove, block: Option<&Block>, operation: Option<u32>) -> Use {
        if cut.rapid {
            return Use::Rapid;
        }
        let Some(block) = block else { return Use::Cut };
        let operation = operation.and_then(|o| self.cl.operations.get(o as usize));
        let rough = operation.is_some_and(|o| o.kind.contains("ROUGH"));
        let level = cut.z.0 - cut.z.1;
        let plunges = level > 0.0 && level >= 0.999 * cut.length();
        let record = block.record.and_then(|r| self.cl.records.get(r as usize)).map(|r| &r.kind);
        match record {
            _ if cut.in_cycle => Use::Cut,
            Some(RecordKind::Pass(pass)) if pass.link => Use::Link,
            Some(RecordKind::Pass(_)) => Use::Cut,
            Some(RecordKind::Contour(_)) if block.piece.is_none() => Use::Entry,
            _ if plunges => Use::Entry,
            _ if rough => Use::Rough,
            Some(RecordKind::Linear(_)) if operation.is_some_and(over_surface) => Use::Entry,
            _ => Use::Cut,
        }
    }

    /// Tip positions of a move.
    pub(in crate::plot) fn path(&self, stroke: &Stroke) -> &[Point3] {
        self.points.get(stroke.from as usize..=stroke.to as usize).unwrap_or_default()
    }

    /// Least and greatest coordinates of the moves at feed, the surfaces, the edges and the blanks.
    pub(in crate::plot) fn bounds(&self) -> (Point3, Point3) {
        let mut bounds = Bounds::default();
        for stroke in self.strokes.iter().filter(|s| s.what != Use::Rapid) {
            self.path(stroke).iter().for_each(|p| bounds.take(*p));
        }
        for finish in self.cl.operations.iter().filter_map(|o| o.guard.surface.as_ref()) {
            let (low, high) = finish.tree.bounds();
            bounds.take(low);
            bounds.take(high);
        }
        for stock in &self.stocks {
            let (low, high) = corners(stock);
            bounds.take(low);
            bounds.take(high);
        }
        bounds.or_unit()
    }

    /// A line of the text, without its end.
    pub(in crate::plot) fn line(&self, number: u32) -> &'a str {
        (number as usize).checked_sub(1).and_then(|n| self.text.lines().nth(n)).unwrap_or("")
    }

    /// Operations whose proof tells what they leave on a surface, with their index.
    pub(in crate::plot) fn finished(&self) -> impl Iterator<Item = (usize, &'a Operation, &'a Finish)> {
        let proofs = self.certificate.operations.iter().map(|o| o.surface.is_some());
        let operations = self.cl.operations.iter().enumerate().zip(proofs);
        let proven = operations.filter_map(|(operation, proven)| proven.then_some(operation));
        proven.filter_map(|(i, o)| o.guard.surface.as_ref().map(|f| (i, o, f)))
    }

    /// Whether a move goes up or down while it goes across, or a surface is finished: a plan view does not show it all.
    pub(in crate::plot) fn is_solid(&self) -> bool {
        self.cl.operations.iter().any(over_surface)
            || self.moves.iter().any(|(_, m)| !m.rapid && !m.in_cycle && climbs(m))
    }
}

/// Ends of moves are one point when they are nearer than this, mm.
const NEAR: f64 = 1e-9;

fn over_surface(operation: &Operation) -> bool {
    operation.guard.surface.is_some()
}

/// Whether a move changes its height on the way across, helical entries apart.
fn climbs(cut: &TraceMove) -> bool {
    match &cut.path {
        TracePath::Line { from, to } => (cut.z.1 - cut.z.0).abs() > 1e-6 && (to - from).norm() > 1e-6,
        TracePath::Tilted(_) | TracePath::Space(_) => true,
        _ => false,
    }
}

fn title(cl: &Cl) -> String {
    cl.title.clone().filter(|t| !t.trim().is_empty()).unwrap_or_else(|| "Cutter path".into())
}

fn stocks(program: &ir::Program) -> Vec<StockShape> {
    program.stocks.iter().map(|(_, s)| s.shape.clone()).collect()
}

/// Lowest and highest corner of a blank; a round without a height is flat.
pub(in crate::plot) fn corners(stock: &StockShape) -> (Point3, Point3) {
    match stock {
        StockShape::Block { min, max } => (*min, *max),
        StockShape::Round { radius, height } => {
            (Point3::new(-radius, -radius, -height.unwrap_or(0.0)), Point3::new(*radius, *radius, 0.0))
        }
    }
}

/// Points of a move behind its start, as many as the eye needs.
fn beyond_start(cut: &TraceMove) -> Vec<Point3> {
    const TURN: f64 = 0.06;
    const MOST: f64 = 4000.0;
    let steps = |turn: f64| (turn.abs() / TURN).ceil().clamp(1.0, MOST) as usize;
    let share = |i: usize, n: usize| crate::math::count(i) / crate::math::count(n);
    let level = |p: Point2, x: f64| Point3::new(p.x, p.y, cut.z.0 + (cut.z.1 - cut.z.0) * x);
    let polar = |centre: Point2, r: f64, a: f64| {
        let (s, c) = crate::math::sin_cos(a);
        Point2::new(centre.x + r * c, centre.y + r * s)
    };
    let mut points: Vec<Point3> = match &cut.path {
        TracePath::Line { .. } => Vec::new(),
        TracePath::Arc { from, to, centre, sweep } => {
            let (a, b) = (from - centre, to - centre);
            let (start, r0, r1) = (crate::math::atan2(a.y, a.x), a.norm(), b.norm());
            let n = steps(*sweep);
            let at = |x: f64| level(polar(*centre, r0 + (r1 - r0) * x, start + sweep * x), x);
            (1..n).map(|i| at(share(i, n))).collect()
        }
        TracePath::Tilted(arc) => {
            let n = steps(arc.sweep);
            (1..n).map(|i| arc.at(share(i, n))).collect()
        }
        TracePath::Space(curve) => {
            let n = (curve.points.len() * 8).min(MOST as usize);
            (1..n).map(|i| curve.at(share(i, n))).collect()
        }
        TracePath::Spiral { radius, angle } => {
            let n = steps(angle.1 - angle.0);
            let at = |x: f64| {
                let mix = |(a, b): (f64, f64)| a + (b - a) * x;
                level(polar(Point2::origin(), mix(*radius), mix(*angle)), x)
            };
            (1..n).map(|i| at(share(i, n))).collect()
        }
        TracePath::Nurbs { order, points, weights, knots } => {
            let n = (points.len() * 8).min(MOST as usize);
            let ends = (knots.get(usize::from(*order).saturating_sub(1)), knots.get(points.len()));
            let (u0, u1) = (ends.0.copied().unwrap_or(0.0), ends.1.copied().unwrap_or(1.0));
            let at = |x: f64| {
                let u = u0 + (u1 - u0) * x;
                level(readback::nurbs_point(usize::from(*order), points, weights, knots, u), x)
            };
            (1..n).map(|i| at(share(i, n))).collect()
        }
    };
    points.push(cut.end());
    points
}

/// Blocks by line, and the operation of each record.
struct Blocks<'a> {
    target: &'a TargetProgram,
    /// Lines and block, of those that print anything.
    lines: Vec<((u32, u32), usize)>,
    operations: Vec<Option<u32>>,
}

impl<'a> Blocks<'a> {
    fn new(cl: &Cl, target: &'a TargetProgram, lines: &[(u32, u32)]) -> Blocks<'a> {
        let printed = lines.iter().enumerate().filter(|(_, (a, b))| b > a);
        let mut inside = None;
        let operations = cl.records.iter().map(|record| {
            match record.kind {
                RecordKind::BeginOperation(o) => inside = Some(o),
                RecordKind::EndOperation(_) => inside = None,
                _ => {}
            }
            inside
        });
        Blocks { target, lines: printed.map(|(i, l)| (*l, i)).collect(), operations: operations.collect() }
    }
    fn of(&self, line: u32) -> Option<&'a Block> {
        let next = self.lines.partition_point(|((first, _), _)| *first <= line);
        let (range, block) = self.lines.get(next.checked_sub(1)?)?;
        self.target.blocks.get(*block).filter(|_| line < range.1)
    }
    fn operation(&self, block: Option<&Block>) -> Option<u32> {
        let record = block?.record?;
        self.operations.get(record as usize).copied().flatten()
    }
}

/// A box that grows.
#[derive(Debug, Clone, Copy)]
pub(in crate::plot) struct Bounds {
    low: Point3,
    high: Point3,
}

impl Default for Bounds {
    fn default() -> Self {
        Bounds { low: Point3::from([f64::INFINITY; 3]), high: Point3::from([f64::NEG_INFINITY; 3]) }
    }
}

impl Bounds {
    pub(in crate::plot) fn take(&mut self, p: Point3) {
        self.low = self.low.inf(&p);
        self.high = self.high.sup(&p);
    }
    /// The box, or one of two millimetres about the origin when nothing was taken.
    pub(in crate::plot) fn or_unit(self) -> (Point3, Point3) {
        let some = (0..3).all(|i| self.low[i].is_finite() && self.high[i].is_finite());
        if some { (self.low, self.high) } else { (Point3::from([-1.0; 3]), Point3::from([1.0; 3])) }
    }
}
