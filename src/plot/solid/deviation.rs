//! What is left on a surface, as colours on it, with its distribution and its proven extremes.

use super::colour::{BEYOND, Range, UNCUT};
use super::marks::{Mark, marks};
use super::mesh::{Mesh, meshes};
use super::scene::Scene;
use super::sheet::{self, Panel, Sheet};
use crate::plot::canvas::{Anchor, Canvas, Pen, Pixel, label};
use crate::plot::chart::{Chart, Scale};
use crate::plot::deviation::small;
use crate::plot::{Figure, PlotError, theme};

/// Places of a surface, over all its patches.
const PLACES: usize = 90_000;
/// Colours between the ends of the scale.
const COLOURS: f64 = 36.0;
/// Steps of light in the side view.
const LIGHTS: f64 = 9.0;
/// Bars of the distribution.
const BARS: usize = 48;

const LEFT: f64 = 84.0;
const WIDTH: f64 = 608.0;
const MARKS: f64 = 756.0;

/// Draws what is left on the surface of the last operation that finishes one.
pub(super) fn deviation(scene: &Scene<'_>) -> Result<Figure, PlotError> {
    let meshes = meshes(scene, PLACES, true);
    let mesh = meshes.last().ok_or(PlotError::NoSurface)?;
    let operation = scene.cl.operations.get(mesh.operation).ok_or(PlotError::NoSurface)?;
    let finish = operation.guard.surface.as_ref().ok_or(PlotError::NoSurface)?;
    let range = Range::of(operation, finish, mesh);
    let found = marks(scene, mesh.operation);
    let mut sheet = Sheet::new(scene, &[mesh]);
    sheet.subtitle(&format!("{} · what {} leaves on the surface", sheet::summary(scene), operation.name));
    let step = (range.high - range.low) / COLOURS;
    let steps = |left: Option<f64>| {
        range.colour(left.map(|v| if range.holds(v) { (v / step).round() * step } else { v }))
    };
    let is_side = |panel: &Panel| panel.at.0 > LEFT;
    sheet.views(|canvas, panel| {
        let side = is_side(panel);
        panel.raster.draw(canvas, |left, light| {
            let light = if side { 0.55 + 0.45 * (light * LIGHTS).round() / LIGHTS } else { 1.0 };
            steps(left).map(|c| (f64::from(c) * light).round() as u8)
        });
        sheet::edges(canvas, panel, &[mesh]);
        places(canvas, panel, &found);
    });
    sheet.compass();
    let below = sheet.below;
    let end = distribution(&mut sheet, mesh, &range, below);
    let listed = list(&mut sheet, &found, below);
    Ok(sheet.finish(end.max(listed) + 30.0))
}

/// Letters where the extremes are.
fn places(canvas: &mut Canvas, panel: &Panel, marks: &[Mark]) {
    for mark in marks {
        let at = panel.camera.point(mark.at);
        canvas.circle(at, 3.0, theme::INK, None);
        let flag = (at.0 + 13.0, at.1 - 13.0);
        canvas.line(at, flag, Pen::solid(theme::INK, 1.2));
        canvas.circle(flag, 9.5, "#ffffff", Some(Pen::solid(theme::INK, 1.2)));
        let text = theme::text(12.0, theme::INK, Anchor::Middle);
        canvas.text((flag.0, flag.1 + 4.3), &mark.letter.to_string(), text);
    }
}

/// Share of the area by what is left, over the colours.
fn distribution(sheet: &mut Sheet<'_>, mesh: &Mesh, range: &Range, top: f64) -> f64 {
    const HEIGHT: f64 = 120.0;
    let (factor, unit) = small(sheet.scene.units);
    let shares = shares(mesh, range);
    let most = shares.bars.iter().copied().fold(1e-9, f64::max);
    let at: Pixel = (LEFT, top);
    let x = Scale::between(range.low * factor, range.high * factor);
    let chart = Chart { at, size: (WIDTH, HEIGHT), x, y: Scale::between(0.0, 100.0 * most) };
    let canvas = &mut sheet.canvas;
    chart.axes(canvas, false);
    let width = (range.high - range.low) * factor / crate::math::count(BARS);
    for (k, share) in shares.bars.iter().enumerate() {
        let from = range.low * factor + width * crate::math::count(k);
        let (a, b) = (chart.point(from, 100.0 * share), chart.point(from + width, 0.0));
        canvas.rect(a, (b.0 - a.0 - 1.0, b.1 - a.1), theme::PITCH, None);
    }
    bar(canvas, &chart, range, factor);
    for value in chart.x.ticks() {
        let p = chart.point(value, 0.0);
        let text = theme::text(12.0, theme::MUTED, Anchor::Middle);
        canvas.text((p.0, p.1 + 40.0), &label(value, chart.x.decimals), text);
    }
    let caption = theme::text(13.0, theme::MUTED, Anchor::Start);
    canvas.text((at.0, at.1 - 8.0), "% of the area", caption);
    let text = format!("left on the surface, {unit}; below 0 the cutter has gone into it");
    let middle = theme::text(13.0, theme::MUTED, Anchor::Middle);
    canvas.text((at.0 + 0.5 * WIDTH, at.1 + HEIGHT + 60.0), &text, middle);
    let foot = beyond(canvas, &shares, (at.0, at.1 + HEIGHT + 84.0));
    foot.max(at.1 + HEIGHT + 66.0)
}

/// The colours under the distribution.
fn bar(canvas: &mut Canvas, chart: &Chart, range: &Range, factor: f64) {
    const STEPS: usize = 190;
    let width = (range.high - range.low) / crate::math::count(STEPS);
    for k in 0..STEPS {
        let from = range.low + width * crate::math::count(k);
        let (a, b) = (chart.point(from * factor, 0.0), chart.point((from + width) * factor, 0.0));
        let [r, g, b_] = range.colour(Some(from + 0.5 * width));
        canvas.rect((a.0, a.1 + 8.0), (b.0 - a.0 + 0.3, 16.0), &format!("#{r:02x}{g:02x}{b_:02x}"), None);
    }
    let (a, b) = (chart.point(range.low * factor, 0.0), chart.point(range.high * factor, 0.0));
    canvas.rect((a.0, a.1 + 8.0), (b.0 - a.0, 16.0), "none", Some(theme::AXIS));
}

/// What the scale does not show, where there is any.
fn beyond(canvas: &mut Canvas, shares: &Shares, at: Pixel) -> f64 {
    let entries = [
        (BEYOND[0], shares.below, "deeper"),
        (BEYOND[1], shares.above, "more left"),
        (UNCUT, shares.uncut, "not cut"),
    ];
    let mut x = at.0;
    for ([r, g, b], share, name) in entries.into_iter().filter(|e| e.1 > 0.0) {
        canvas.rect((x, at.1 - 11.0), (14.0, 14.0), &format!("#{r:02x}{g:02x}{b:02x}"), Some(theme::AXIS));
        let text = format!("{name}: {} % of the area", label(100.0 * share, 2));
        canvas.text((x + 21.0, at.1), &text, theme::text(13.0, theme::INK, Anchor::Start));
        x += 205.0;
    }
    if x > at.0 { at.1 + 6.0 } else { at.1 - 18.0 }
}

/// Shares of the area.
struct Shares {
    bars: Vec<f64>,
    below: f64,
    above: f64,
    uncut: f64,
}

fn shares(mesh: &Mesh, range: &Range) -> Shares {
    let whole: f64 = mesh.places().map(|p| p.area).sum::<f64>().max(f64::MIN_POSITIVE);
    let mut shares = Shares { bars: vec![0.0; BARS], below: 0.0, above: 0.0, uncut: 0.0 };
    for place in mesh.places() {
        let share = place.area / whole;
        match place.left.map(|l| l.height) {
            None => shares.uncut += share,
            Some(v) if !range.holds(v) && v < 0.0 => shares.below += share,
            Some(v) if !range.holds(v) => shares.above += share,
            Some(v) => {
                let at = (v - range.low) / (range.high - range.low) * crate::math::count(BARS);
                let last = shares.bars.len() - 1;
                if let Some(bar) = shares.bars.get_mut((at.max(0.0) as usize).min(last)) {
                    *bar += share;
                }
            }
        }
    }
    shares
}

/// The extremes in words: value, place, line and its text.
fn list(sheet: &mut Sheet<'_>, marks: &[Mark], top: f64) -> f64 {
    let scene = sheet.scene;
    let (factor, unit) = small(scene.units);
    let number = |v: f64| label(v / scene.units.in_mm(), 3);
    let mut y = top;
    let head = "proven extremes, measured on the text of the program";
    sheet.canvas.text((MARKS, y - 8.0), head, theme::text(13.0, theme::MUTED, Anchor::Start));
    for mark in marks {
        y += 18.0;
        let text = format!("{}   {} {} {unit}", mark.letter, mark.name, label(mark.value * factor, 2));
        sheet.canvas.text((MARKS, y), &text, theme::text(14.0, theme::INK, Anchor::Start));
        y += 18.0;
        let at = format!("X {}  Y {}  Z {}", number(mark.at.x), number(mark.at.y), number(mark.at.z));
        let text = format!("{at} · line {}: {}", mark.line, scene.line(mark.line).trim());
        sheet.canvas.text((MARKS + 22.0, y), &text, theme::text(13.0, theme::MUTED, Anchor::Start));
        y += 6.0;
    }
    if marks.is_empty() {
        sheet.canvas.text(
            (MARKS, y + 18.0),
            "none above 0.001 µm",
            theme::text(14.0, theme::INK, Anchor::Start),
        );
        y += 18.0;
    }
    y
}
