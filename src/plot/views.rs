//! From a compiled program to what is drawn of it.

use super::blocks::{Detail, Stroke, Use, strokes};
use super::{CamView, DeviationView, Figure, PathView, PieceDeviation, PlotError, Track};
use crate::cl::Cl;
use crate::geom::Side;
use crate::geom::cam::Flank;
use crate::geom::curve::{CurveRef, spans};
use crate::geom::measure::arc_length;
use crate::geom::project::Projector;
use crate::ir::{self, Interpolation, StockShape};
use crate::target::{Piece, PieceId, TargetProgram};

/// What of a program is drawn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum What {
    /// A cam by name, or the first one.
    Cam(Option<String>),
    /// The cutter's path.
    Path,
    /// Deviation of the blocks from the exact curves.
    Deviation,
}

/// Draws a compiled program. Without a lowered program a cam is drawn without its blocks, and nothing else is.
///
/// # Errors
/// [`PlotError`] when the program has nothing of the kind.
pub fn draw(
    what: &What,
    program: &ir::Program,
    cl: Option<&Cl>,
    target: Option<&TargetProgram>,
) -> Result<Figure, PlotError> {
    match what {
        What::Cam(name) => draw_cam(name.as_deref(), program, cl, target),
        What::Path => draw_path(program, cl, target.ok_or(PlotError::NoPath)?),
        What::Deviation => draw_deviation(program, cl, target.ok_or(PlotError::NoContour)?),
    }
}

fn draw_cam(
    name: Option<&str>,
    program: &ir::Program,
    cl: Option<&Cl>,
    target: Option<&TargetProgram>,
) -> Result<Figure, PlotError> {
    let mut cams = program.cams.iter().map(|(_, c)| c);
    let entity = match name {
        None => cams.next().ok_or(PlotError::NoCam)?,
        Some(name) => {
            cams.find(|c| c.name.eq_ignore_ascii_case(name)).ok_or_else(|| PlotError::UnknownCam {
                name: name.to_owned(),
                have: program.cams.iter().map(|(_, c)| c.name.clone()).collect(),
            })?
        }
    };
    let only = program.cams.len() == 1;
    let tracks = target.filter(|_| only).map_or_else(Vec::new, |t| tracks(cl, t));
    Ok(super::cam(&CamView {
        name: &entity.name,
        cam: &entity.cam,
        units: program.units,
        blank: blank(program),
        tracks,
    }))
}

/// The first round blank.
fn blank(program: &ir::Program) -> Option<f64> {
    program.stocks.iter().find_map(|(_, stock)| match stock.shape {
        StockShape::Round { radius, .. } => Some(radius),
        StockShape::Block { .. } => None,
    })
}

fn is_rough(cl: Option<&Cl>, piece: &Piece) -> bool {
    cl.and_then(|c| c.operations.get(piece.operation as usize)).is_some_and(|o| o.kind == "ROUGH")
}

/// One track for every finishing contour at its last height.
fn tracks(cl: Option<&Cl>, target: &TargetProgram) -> Vec<Track> {
    let strokes = strokes(target, Detail::Picture);
    let last = last_levels(cl, target);
    last.into_iter().filter_map(|id| track(target, &strokes, id)).collect()
}

/// The pieces of finishing operations, of equal curves the one cut last.
fn last_levels(cl: Option<&Cl>, target: &TargetProgram) -> Vec<PieceId> {
    let mut kept: Vec<usize> = Vec::new();
    for (i, piece) in target.pieces.iter().enumerate().filter(|(_, p)| !is_rough(cl, p)) {
        kept.retain(|&k| !std::sync::Arc::ptr_eq(&target.pieces[k].curve, &piece.curve));
        kept.push(i);
    }
    kept.into_iter().map(|i| PieceId(i as u32)).collect()
}

fn track(target: &TargetProgram, strokes: &[Stroke], id: PieceId) -> Option<Track> {
    let piece = target.pieces.get(id.0 as usize)?;
    let cuts: Vec<&Stroke> = strokes.iter().filter(|s| s.piece == Some(id) && s.what == Use::Cut).collect();
    let first = cuts.first().and_then(|s| s.points.first()).copied();
    let vertices = first.into_iter().chain(cuts.iter().filter_map(|s| s.points.last()).copied()).collect();
    Some(Track {
        curve: piece.curve.clone(),
        vertices,
        label: format!("cutter path, {}", words(piece.interpolation)),
    })
}

const fn words(interpolation: Interpolation) -> &'static str {
    match interpolation {
        Interpolation::Linear => "lines",
        Interpolation::Circular => "arcs",
        Interpolation::RTheta => "R-theta",
        Interpolation::Nurbs => "NURBS",
        Interpolation::Auto => "automatic",
    }
}

fn title(program: &ir::Program) -> String {
    program.title.clone().filter(|t| !t.trim().is_empty()).unwrap_or_else(|| "Cutter path".into())
}

fn draw_path(program: &ir::Program, cl: Option<&Cl>, target: &TargetProgram) -> Result<Figure, PlotError> {
    if strokes(target, Detail::Picture).is_empty() {
        return Err(PlotError::NoPath);
    }
    let rough = target.pieces.iter().map(|p| is_rough(cl, p)).collect();
    let part = part_edges(program);
    Ok(super::path(&PathView {
        title: title(program),
        program: target,
        units: program.units,
        part,
        blank: blank(program),
        rough,
    }))
}

/// The flanks of all cams, and all curves that a profile follows.
pub(super) fn part_edges(program: &ir::Program) -> Vec<CurveRef> {
    let flanks = program.cams.iter().flat_map(|(_, c)| {
        let flanks: &[Flank] = c.cam.definition().flanks();
        flanks.iter().map(|f| c.cam.flank(*f)).collect::<Vec<_>>()
    });
    let followed = program.steps.iter().filter_map(|s| match &s.kind {
        ir::StepKind::Profile(p) => Some(&p.target),
        _ => None,
    });
    let curves = followed.flat_map(|t| match t {
        ir::ProfileTarget::Curve { edges, .. } => {
            edges.iter().map(|(h, _)| program.curves[*h].curve.clone()).collect()
        }
        ir::ProfileTarget::Cam(..) => Vec::new(),
    });
    flanks.chain(curves).collect()
}

fn draw_deviation(
    program: &ir::Program,
    cl: Option<&Cl>,
    target: &TargetProgram,
) -> Result<Figure, PlotError> {
    const MOST: usize = 8;
    let strokes = strokes(target, Detail::Measure);
    let mut pieces: Vec<PieceDeviation> = last_levels(cl, target)
        .into_iter()
        .filter_map(|id| piece_deviation(program, cl, target, &strokes, id))
        .filter(|p| !p.runs.is_empty())
        .collect();
    pieces.truncate(MOST);
    if pieces.is_empty() {
        return Err(PlotError::NoContour);
    }
    let subtitle =
        format!("{}: deviation of the emitted blocks from the exact cutter path", target.capabilities.name);
    Ok(super::deviation(&DeviationView { title: title(program), subtitle, units: program.units, pieces }))
}

fn piece_deviation(
    program: &ir::Program,
    cl: Option<&Cl>,
    target: &TargetProgram,
    strokes: &[Stroke],
    id: PieceId,
) -> Option<PieceDeviation> {
    let piece = target.pieces.get(id.0 as usize)?;
    let operation = cl.and_then(|c| c.operations.get(piece.operation as usize));
    let z = super::canvas::decimal(piece.z / program.units.in_mm(), 4);
    let name = operation.map_or_else(|| "contour".to_owned(), |o| o.name.clone());
    let along = Along::new(&piece.curve);
    let sign = if piece.part == Side::Left { -1.0 } else { 1.0 };
    let projector = Projector::new(piece.curve.as_ref(), 256);
    let cuts: Vec<&Stroke> = strokes.iter().filter(|s| s.piece == Some(id) && s.what == Use::Cut).collect();
    let runs = cuts.iter().flat_map(|s| block_deviation(s, &projector, &along, sign)).collect();
    Some(PieceDeviation {
        name: format!("{name}, Z{z}, {}", words(piece.interpolation)),
        band: (piece.band.into, piece.band.out),
        length: along.total(),
        count: cuts.len(),
        runs,
        lower_bound: piece.lower_bound,
    })
}

/// One block as (arc length, deviation); cut in two where it passes the start of a closed curve.
fn block_deviation(stroke: &Stroke, projector: &Projector, along: &Along, sign: f64) -> Vec<Vec<(f64, f64)>> {
    let half = 0.5 * along.total();
    let mut runs: Vec<Vec<(f64, f64)>> = vec![Vec::new()];
    for p in &stroke.points {
        let foot = projector.nearest(*p);
        let here = (along.at(foot.u), sign * foot.deviation);
        let jumps = runs.last().and_then(|r| r.last()).is_some_and(|last| (last.0 - here.0).abs() > half);
        if jumps {
            runs.push(Vec::new());
        }
        if let Some(run) = runs.last_mut() {
            run.push(here);
        }
    }
    runs.retain(|r| r.len() > 1);
    runs
}

/// Arc length by parameter, from a table.
struct Along {
    table: Vec<(f64, f64)>,
}

impl Along {
    fn new(curve: &CurveRef) -> Along {
        const PER_SPAN: usize = 48;
        const ACCURACY: f64 = 1e-4;
        let mut table = vec![(curve.domain().0, 0.0)];
        let mut sum = 0.0;
        for (_, a, b) in spans(curve.as_ref()) {
            for i in 0..PER_SPAN {
                let at = |i: usize| a + (b - a) * i as f64 / PER_SPAN as f64;
                sum += arc_length(curve.as_ref(), at(i), at(i + 1), ACCURACY);
                table.push((at(i + 1), sum));
            }
        }
        Along { table }
    }
    fn total(&self) -> f64 {
        self.table.last().map_or(0.0, |t| t.1)
    }
    fn at(&self, u: f64) -> f64 {
        let next = self.table.partition_point(|t| t.0 <= u).clamp(1, self.table.len() - 1);
        let (a, b) = (self.table[next - 1], self.table[next]);
        a.1 + (b.1 - a.1) * ((u - a.0) / (b.0 - a.0)).clamp(0.0, 1.0)
    }
}
