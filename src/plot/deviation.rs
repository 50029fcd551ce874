//! Deviation of the emitted blocks from the exact curve, along the curve.

use super::Figure;
use super::canvas::{Anchor, Canvas, Pen, Pixel, label};
use super::chart::{Chart, Scale};
use super::theme;
use crate::units::LengthUnit;

/// What is drawn.
#[derive(Debug, Clone)]
pub struct DeviationView {
    /// The program's title.
    pub title: String,
    /// Which controller.
    pub subtitle: String,
    /// Unit of the figures.
    pub units: LengthUnit,
    /// One diagram each.
    pub pieces: Vec<PieceDeviation>,
}

/// Deviation along one contour. Positive is left on the part, negative is into it.
#[derive(Debug, Clone)]
pub struct PieceDeviation {
    /// Operation, height, interpolation.
    pub name: String,
    /// Band, mm: into the part, left on it; both positive.
    pub band: (f64, f64),
    /// Length of the curve, mm.
    pub length: f64,
    /// Number of blocks.
    pub count: usize,
    /// Run by run (a block, or its part before or after the curve's start): arc length from the curve's start
    /// and deviation, mm.
    pub runs: Vec<Vec<(f64, f64)>>,
    /// Proven least number of blocks, if known.
    pub lower_bound: Option<u32>,
}

const WIDTH: f64 = 1400.0;
const LEFT: f64 = 84.0;
const TOP: f64 = 126.0;
const PANEL: f64 = 240.0;
const GAP: f64 = 92.0;

/// Draws deviations.
#[must_use]
pub fn deviation(view: &DeviationView) -> Figure {
    let mut canvas = Canvas::default();
    canvas.text((36.0, 48.0), &view.title, theme::TITLE);
    canvas.text((36.0, 74.0), &view.subtitle, theme::SUBTITLE);
    for (i, piece) in view.pieces.iter().enumerate() {
        panel(&mut canvas, view, piece, (LEFT, TOP + i as f64 * (PANEL + GAP)));
    }
    let height = TOP + view.pieces.len().max(1) as f64 * (PANEL + GAP) - 24.0;
    Figure { svg: canvas.document(WIDTH, height, &view.title) }
}

/// Small units of deviation: micrometres, or ten-thousandths of an inch.
pub(super) const fn small(units: LengthUnit) -> (f64, &'static str) {
    match units {
        LengthUnit::Millimetre => (1000.0, "µm"),
        LengthUnit::Inch => (10_000.0 / 25.4, "0.0001 in"),
    }
}

fn panel(canvas: &mut Canvas, view: &DeviationView, piece: &PieceDeviation, at: Pixel) {
    let (factor, unit) = small(view.units);
    let mm = view.units.in_mm();
    let (low, high) = extremes(piece);
    let (low_y, high_y) = ((-piece.band.0).min(low) * factor, piece.band.1.max(high) * factor);
    let room = 0.1 * (high_y - low_y);
    let y = Scale::between(low_y - room, high_y + room);
    let length = piece.length / mm;
    let x = Scale::fixed(0.0, length, super::chart::round_step(length / 16.0));
    let chart = Chart { at, size: (WIDTH - LEFT - 36.0, PANEL), x, y };
    chart.axes(canvas, true);
    chart.shade_y(canvas, -piece.band.0 * factor, piece.band.1 * factor, "#2f9e6e1f");
    for limit in [-piece.band.0, piece.band.1] {
        chart.horizontal(canvas, limit * factor, Pen::dashed(theme::LIMIT, 1.2, "7 4"));
    }
    block_ends(canvas, &chart, piece, mm);
    for block in &piece.runs {
        let points: Vec<(f64, f64)> = block.iter().map(|&(s, d)| (s / mm, d * factor)).collect();
        chart.curve(canvas, &points, Pen::solid(theme::PROFILE, 1.5));
    }
    let bound = piece.lower_bound.map_or(String::new(), |b| format!(", no fewer than {b} are possible"));
    let figure = format!(
        "{} blocks{bound} · left on the part {} {unit} · into it {} {unit}",
        piece.count,
        label(high.max(0.0) * factor, 2),
        label((-low).max(0.0) * factor, 2),
    );
    chart.caption(canvas, &piece.name, &figure, theme::PROFILE);
    let axis = format!("deviation, {unit}");
    canvas.text((at.0, at.1 - 26.0), &axis, theme::text(12.0, theme::MUTED, Anchor::Start));
    let below = (at.0 + chart.size.0 / 2.0, at.1 + PANEL + 36.0);
    let text = format!("along the exact cutter-centre curve, {}", view.units.symbol());
    canvas.text(below, &text, theme::text(13.0, theme::MUTED, Anchor::Middle));
}

/// Ticks where blocks meet.
fn block_ends(canvas: &mut Canvas, chart: &Chart, piece: &PieceDeviation, mm: f64) {
    let pen = Pen::solid(theme::PATH, 1.0);
    for block in &piece.runs {
        if let Some(&(s, _)) = block.first() {
            let p = chart.point(s / mm, chart.y.low);
            canvas.line(p, (p.0, p.1 - 7.0), pen);
        }
    }
}

fn extremes(piece: &PieceDeviation) -> (f64, f64) {
    let values = piece.runs.iter().flatten().map(|p| p.1);
    values.fold((0.0_f64, 0.0_f64), |(low, high), d| (low.min(d), high.max(d)))
}
