//! Two views of a job on one sheet, from above and from the side, with what belongs below them.

use super::camera::Camera;
use super::cutter;
use super::mesh::Mesh;
use super::raster::Raster;
use super::scene::{Scene, Stroke, USES, Use, corners};
use crate::geom::Point3;
use crate::ir::StockShape;
use crate::plot::Figure;
use crate::plot::canvas::{Anchor, Canvas, Pen, Pixel, label};
use crate::plot::page::name_of;
use crate::plot::theme;
use crate::plot::world::{View, polyline};

const WIDTH: f64 = 1400.0;
const TOP: f64 = 112.0;
const PLAN: f64 = 84.0;
const SIDE: f64 = 756.0;
const PANEL: f64 = 608.0;

/// A view with its rectangle and what hides things in it.
pub(super) struct Panel {
    pub(super) camera: Camera,
    pub(super) at: Pixel,
    pub(super) size: Pixel,
    pub(super) raster: Raster,
}

/// A sheet with both views framed; what is drawn in them is the caller's.
pub(super) struct Sheet<'a> {
    pub(super) scene: &'a Scene<'a>,
    pub(super) canvas: Canvas,
    pub(super) plan: Panel,
    pub(super) side: Panel,
    /// Where the space below the views begins.
    pub(super) below: f64,
}

impl<'a> Sheet<'a> {
    /// The views of surfaces, as high as they need to be.
    pub(super) fn new(scene: &'a Scene<'a>, meshes: &[&Mesh]) -> Sheet<'a> {
        let bounds = scene.bounds();
        let shape = bounds.1 - bounds.0;
        let height = (PANEL * shape.y / shape.x.max(1e-6)).clamp(0.62 * PANEL, PANEL);
        let panel = |camera: Camera, left: f64| {
            let (at, size) = ((left, TOP), (PANEL, height));
            let camera = camera.fit(bounds, at, size);
            Panel { camera, at, size, raster: Raster::new(meshes, &camera, at, size) }
        };
        let (plan, side) = (panel(Camera::plan(), PLAN), panel(Camera::oblique(), SIDE));
        let mut canvas = Canvas::default();
        canvas.text((36.0, 48.0), &scene.title, theme::TITLE);
        let world = View { origin: plan.camera.origin, scale: plan.camera.scale };
        crate::plot::path::grid(&mut canvas, scene.units, &world, (plan.at, plan.size));
        let above = theme::text(13.0, theme::MUTED, Anchor::End);
        canvas.text((PLAN + PANEL, TOP - 8.0), "from above", above);
        canvas.text((SIDE + PANEL, TOP - 8.0), "from the front left", above);
        Sheet { scene, canvas, plan, side, below: TOP + height + 64.0 }
    }

    /// Draws in both views, clipped to them.
    pub(super) fn views(&mut self, draw: impl Fn(&mut Canvas, &Panel)) {
        for panel in [&self.plan, &self.side] {
            self.canvas.clipped(panel.at, panel.size, |c| draw(c, panel));
            self.canvas.rect(panel.at, panel.size, "none", Some(theme::AXIS));
        }
    }

    /// Axes' directions and a length to compare with, in the side view.
    pub(super) fn compass(&mut self) {
        let (panel, unit) = (&self.side, self.scene.units.in_mm());
        let at = (panel.at.0 + 58.0, panel.at.1 + panel.size.1 - 46.0);
        let zero = panel.camera.point(Point3::origin());
        let axes = [
            ("X", Point3::new(1.0, 0.0, 0.0)),
            ("Y", Point3::new(0.0, 1.0, 0.0)),
            ("Z", Point3::new(0.0, 0.0, 1.0)),
        ];
        for (name, unit) in axes {
            let end = panel.camera.point(unit);
            let way = |length: f64| {
                let k = length / panel.camera.scale;
                (at.0 + (end.0 - zero.0) * k, at.1 + (end.1 - zero.1) * k)
            };
            self.canvas.line(at, way(34.0), Pen::solid(theme::MUTED, 1.3));
            let place = way(45.0);
            let text = theme::text(12.0, theme::INK, Anchor::Middle);
            self.canvas.text((place.0, place.1 + 4.0), name, text);
        }
        let step = crate::plot::chart::round_step(80.0 / (panel.camera.scale * unit));
        let length = step * unit * panel.camera.scale;
        let right = (panel.at.0 + panel.size.0 - 18.0, panel.at.1 + panel.size.1 - 18.0);
        self.canvas.line((right.0 - length, right.1), right, Pen::solid(theme::INK, 2.0));
        let decimals = if step < 1.0 { 3 } else { 0 };
        let text = format!("{} {}", label(step, decimals), self.scene.units.symbol());
        let middle = (right.0 - 0.5 * length, right.1 - 7.0);
        self.canvas.text(middle, &text, theme::text(12.0, theme::INK, Anchor::Middle));
    }

    pub(super) fn subtitle(&mut self, text: &str) {
        self.canvas.text((36.0, 74.0), text, theme::SUBTITLE);
    }

    pub(super) fn finish(self, height: f64) -> Figure {
        Figure { svg: self.canvas.document(WIDTH, height, &self.scene.title) }
    }
}

/// Post, cutters, time.
pub(super) fn summary(scene: &Scene<'_>) -> String {
    let unit = scene.units.in_mm();
    let lengths = scene.strokes.iter().filter(|s| s.what != Use::Rapid).map(|s| s.length);
    let tools: Vec<String> = scene.tools.iter().map(|t| cutter::words(t, scene.units)).collect();
    format!(
        "{} · {} · {} lines · {} {} at feed · {} estimated",
        scene.post,
        tools.join(", "),
        scene.certificate.lines,
        label(lengths.sum::<f64>() / unit, 1),
        scene.units.symbol(),
        clock(scene.certificate.time.total())
    )
}

/// Hours, minutes and seconds.
pub(super) fn clock(seconds: f64) -> String {
    let whole = seconds.round().max(0.0) as u64;
    let (h, m, s) = (whole / 3600, whole / 60 % 60, whole % 60);
    if h > 0 { format!("{h} h {m:02} min") } else { format!("{m} min {s:02} s") }
}

/// The pen of a use; cuts become thinner where they lie close together.
pub(super) fn pen(what: Use, cut: f64) -> Pen {
    match what {
        Use::Rapid => Pen::dashed(theme::RAPID, 1.1, "7 5"),
        Use::Rough => Pen::solid(theme::ROUGH, cut),
        Use::Entry => Pen::solid(theme::ENTRY, 1.4),
        Use::Link => Pen::solid(theme::LEAD, 1.4),
        Use::Cut => Pen::solid(theme::PATH, cut),
    }
}

/// The path in a view; what a surface hides is left out.
pub(super) fn paths(canvas: &mut Canvas, panel: &Panel, scene: &Scene<'_>) {
    let (low, high) = scene.bounds();
    let slack = 0.004 * (high - low).norm();
    let cut = width(panel, scene);
    for what in USES {
        let mut data = String::new();
        for run in runs(scene, what) {
            seen(panel, run, slack, &mut data);
        }
        canvas.stroke(&data, pen(what, cut));
    }
}

/// Points of neighbouring moves of one use.
fn runs<'s>(scene: &'s Scene<'_>, what: Use) -> impl Iterator<Item = &'s [Point3]> {
    let joined = move |a: &Stroke, b: &Stroke| a.what == b.what && a.to == b.from;
    let chunks = scene.strokes.chunk_by(joined).filter(move |c| c.first().is_some_and(|s| s.what == what));
    chunks.filter_map(|c| {
        let (first, last) = (c.first()?, c.last()?);
        scene.points.get(first.from as usize..=last.to as usize)
    })
}

/// Adds the parts of a run that are seen, without points that nobody can tell apart.
fn seen(panel: &Panel, run: &[Point3], slack: f64, data: &mut String) {
    const STEP: f64 = 3.0;
    let mut part = Part::default();
    for pair in run.windows(2) {
        let (a, b) = (panel.camera.point(pair[0]), panel.camera.point(pair[1]));
        let steps = (apart(a, b) / STEP).ceil().clamp(1.0, 2000.0) as usize;
        for i in 0..=steps {
            let share = crate::math::count(i) / crate::math::count(steps);
            let p = pair[0] + (pair[1] - pair[0]) * share;
            if panel.raster.shows(&panel.camera, p, slack) {
                part.take(panel.camera.point(p), i == steps);
            } else {
                part.end(data);
            }
        }
    }
    part.end(data);
}

fn apart(a: Pixel, b: Pixel) -> f64 {
    crate::math::hypot(a.0 - b.0, a.1 - b.1)
}

/// A part of a path that is seen from end to end.
#[derive(Debug, Default)]
struct Part {
    kept: Vec<Pixel>,
    /// The last pixel, where it need not be kept for itself.
    last: Option<Pixel>,
}

impl Part {
    fn take(&mut self, pixel: Pixel, corner: bool) {
        const LEAST: f64 = 0.45;
        let new = self.kept.last().is_none_or(|kept| corner && apart(*kept, pixel) >= LEAST);
        self.last = (!new).then_some(pixel);
        self.kept.extend(new.then_some(pixel));
    }
    fn end(&mut self, data: &mut String) {
        self.kept.extend(self.last.take());
        if self.kept.len() > 1 {
            data.push_str(&polyline(&self.kept));
        }
        self.kept.clear();
    }
}

/// Width of cuts: a third of the distance between neighbours, as far as the eye likes it.
fn width(panel: &Panel, scene: &Scene<'_>) -> f64 {
    let (low, high) = scene.bounds();
    let cuts = scene.strokes.iter().filter(|s| matches!(s.what, Use::Cut | Use::Rough));
    let length: f64 = cuts.map(|s| s.length).sum();
    let spacing = (high.x - low.x) * (high.y - low.y) / length.max(1e-9) * panel.camera.scale;
    (0.33 * spacing).clamp(0.35, 1.6)
}

/// Edges of blanks.
pub(super) fn blanks(canvas: &mut Canvas, panel: &Panel, scene: &Scene<'_>) {
    const PEN: Pen = Pen::dashed(theme::STOCK, 1.2, "9 5");
    for stock in &scene.stocks {
        let (low, high) = corners(stock);
        let point = |x: f64, y: f64, z: f64| panel.camera.point(Point3::new(x, y, z));
        let ring = |z: f64| -> Vec<Pixel> {
            if let StockShape::Round { radius, .. } = stock {
                let at = |k: usize| crate::math::sin_cos(crate::math::TAU * crate::math::count(k) / 96.0);
                return (0..=96).map(at).map(|(s, c)| point(radius * c, radius * s, z)).collect();
            }
            let corners =
                [(low.x, low.y), (high.x, low.y), (high.x, high.y), (low.x, high.y), (low.x, low.y)];
            corners.map(|(x, y)| point(x, y, z)).to_vec()
        };
        for z in [low.z, high.z] {
            canvas.stroke(&polyline(&ring(z)), PEN);
        }
        let ends = ring(low.z).into_iter().zip(ring(high.z)).take(4);
        if matches!(stock, StockShape::Block { .. }) {
            ends.for_each(|(a, b)| canvas.line(a, b, PEN));
        }
    }
}

/// Edges of surfaces, and of the part at both its heights.
pub(super) fn edges(canvas: &mut Canvas, panel: &Panel, meshes: &[&Mesh]) {
    let pen = Pen::solid(theme::PROFILE, 1.2);
    for grid in meshes.iter().flat_map(|m| &m.grids) {
        let pixels: Vec<Pixel> = grid.outline().into_iter().map(|p| panel.camera.point(p)).collect();
        canvas.stroke(&polyline(&pixels), pen);
    }
}

/// Moves, length and time of each use, with its pen.
pub(super) fn table(sheet: &mut Sheet<'_>) -> f64 {
    let (scene, unit) = (sheet.scene, sheet.scene.units.in_mm());
    let mut y = sheet.below;
    let columns = [PLAN + 300.0, PLAN + 440.0, PLAN + 580.0];
    let heads = ["moves".to_owned(), format!("length, {}", scene.units.symbol()), "time".to_owned()];
    for (x, head) in columns.into_iter().zip(heads) {
        sheet.canvas.text((x, y), &head, theme::text(13.0, theme::MUTED, Anchor::End));
    }
    for what in USES.into_iter().rev() {
        let own: Vec<&Stroke> = scene.strokes.iter().filter(|s| s.what == what).collect();
        if own.is_empty() {
            continue;
        }
        y += 22.0;
        let mut line = pen(what, 1.8);
        line.width = line.width.max(1.8);
        sheet.canvas.line((PLAN, y - 5.0), (PLAN + 34.0, y - 5.0), line);
        sheet.canvas.text((PLAN + 44.0, y), name_of(what), theme::text(14.0, theme::INK, Anchor::Start));
        let sum = |of: fn(&Stroke) -> f64| own.iter().map(|s| of(s)).sum::<f64>();
        let cells = [own.len().to_string(), label(sum(|s| s.length) / unit, 1), clock(sum(|s| s.seconds))];
        for (x, cell) in columns.into_iter().zip(cells) {
            sheet.canvas.text((x, y), &cell, theme::text(14.0, theme::INK, Anchor::End));
        }
    }
    y
}
