//! The cutter's path, seen from above.

use super::Figure;
use super::blocks::{Detail, Stroke, Use, strokes};
use super::canvas::{Anchor, Canvas, Pen, Pixel, label};
use super::chart::Scale;
use super::theme;
use super::world::View;
use crate::geom::Point2;
use crate::geom::curve::CurveRef;
use crate::target::TargetProgram;
use crate::units::LengthUnit;

/// What is drawn.
#[derive(Debug, Clone)]
pub struct PathView<'a> {
    /// The program's title.
    pub title: String,
    /// The lowered program.
    pub program: &'a TargetProgram,
    /// Unit of the axes.
    pub units: LengthUnit,
    /// Finished edges of the part, filled where they are closed.
    pub part: Vec<CurveRef>,
    /// Radius of the blank about the origin, mm.
    pub blank: Option<f64>,
    /// For every piece of the program: whether it is roughing.
    pub rough: Vec<bool>,
}

const WIDTH: f64 = 1180.0;
const HEIGHT: f64 = 1236.0;
const AT: Pixel = (84.0, 112.0);
const SIZE: Pixel = (1060.0, 1030.0);

const CONTOUR: Pen = Pen::solid(theme::PATH, 1.8);
const ROUGH: Pen = Pen::solid(theme::ROUGH, 1.2);
const LINK: Pen = Pen::solid(theme::LEAD, 1.5);
const RAPID: Pen = Pen::dashed(theme::RAPID, 1.1, "7 5");
const PART: Pen = Pen::solid(theme::PROFILE, 1.6);
const BLANK: Pen = Pen::dashed(theme::STOCK, 1.4, "9 5");

/// Draws a cutter path.
#[must_use]
pub fn path(view: &PathView) -> Figure {
    let strokes = strokes(view.program, Detail::Picture);
    let world = world(view, &strokes);
    let mut canvas = Canvas::default();
    canvas.text((36.0, 48.0), &view.title, theme::TITLE);
    canvas.text((36.0, 74.0), &subtitle(view, &strokes), theme::SUBTITLE);
    grid(&mut canvas, view.units, &world, (AT, SIZE));
    canvas.clipped(AT, SIZE, |c| panel(c, view, &world, &strokes));
    canvas.rect(AT, SIZE, "none", Some(theme::AXIS));
    legend(&mut canvas, view, &strokes);
    Figure { svg: canvas.document(WIDTH, HEIGHT, &view.title) }
}

fn subtitle(view: &PathView, strokes: &[Stroke]) -> String {
    let count = |what: Use| strokes.iter().filter(|s| s.what == what).count();
    format!(
        "{} · {} contour blocks · {} leads and links · {} rapids",
        view.program.capabilities.name,
        count(Use::Cut),
        count(Use::Link) + count(Use::Plunge),
        count(Use::Rapid)
    )
}

fn world(view: &PathView, strokes: &[Stroke]) -> View {
    let (mut low, mut high) =
        (Point2::new(f64::INFINITY, f64::INFINITY), Point2::new(f64::NEG_INFINITY, f64::NEG_INFINITY));
    let mut take = |p: Point2| {
        low = Point2::new(low.x.min(p.x), low.y.min(p.y));
        high = Point2::new(high.x.max(p.x), high.y.max(p.y));
    };
    strokes.iter().flat_map(|s| &s.points).for_each(|p| take(*p));
    for edge in &view.part {
        let (a, b) = crate::geom::measure::bounding_box(edge.as_ref(), 16);
        take(a);
        take(b);
    }
    if let Some(r) = view.blank {
        take(Point2::new(-r, -r));
        take(Point2::new(r, r));
    }
    if !(low.x.is_finite() && high.x.is_finite()) {
        (low, high) = (Point2::new(-1.0, -1.0), Point2::new(1.0, 1.0));
    }
    let margin = 0.05 * (high.x - low.x).max(high.y - low.y).max(1e-3);
    let room = nalgebra::Vector2::new(margin, margin);
    View::fit(low - room, high + room, AT, SIZE)
}

/// Axes of a plan view in the program's unit with a light grid.
pub(super) fn grid(canvas: &mut Canvas, units: LengthUnit, world: &View, (at, size): (Pixel, Pixel)) {
    const SPACING: f64 = 88.0;
    let unit = units.in_mm();
    let per_pixel = 1.0 / (world.scale * unit);
    let x_at = |pixel: f64| (pixel - world.origin.0) * per_pixel;
    let y_at = |pixel: f64| (world.origin.1 - pixel) * per_pixel;
    let step = super::chart::round_step(SPACING * per_pixel);
    let x = Scale::fixed(x_at(at.0), x_at(at.0 + size.0), step);
    let y = Scale::fixed(y_at(at.1 + size.1), y_at(at.1), step);
    let pen = |value: f64| if value == 0.0 { theme::AXIS } else { theme::GRID };
    for value in x.ticks() {
        let place = world.origin.0 + value / per_pixel;
        canvas.line((place, at.1), (place, at.1 + size.1), pen(value));
        canvas.text(
            (place, at.1 + size.1 + 18.0),
            &label(value, x.decimals),
            theme::text(12.0, theme::MUTED, Anchor::Middle),
        );
    }
    for value in y.ticks() {
        let place = world.origin.1 - value / per_pixel;
        canvas.line((at.0, place), (at.0 + size.0, place), pen(value));
        canvas.text((at.0 - 8.0, place + 4.0), &label(value, y.decimals), theme::TICK);
    }
    let name = |axis: &str| format!("{axis}, {}", units.symbol());
    let corner = (at.0 + size.0, at.1 + size.1 + 36.0);
    canvas.text(corner, &name("X"), theme::text(13.0, theme::MUTED, Anchor::End));
    canvas.text((at.0, at.1 - 8.0), &name("Y"), theme::text(13.0, theme::MUTED, Anchor::End));
}

fn panel(canvas: &mut Canvas, view: &PathView, world: &View, strokes: &[Stroke]) {
    let edges: Vec<String> = view.part.iter().map(|e| world.curve(e.as_ref())).collect();
    let closed: String =
        view.part.iter().zip(&edges).filter(|(e, _)| e.is_closed()).map(|(_, d)| d.as_str()).collect();
    canvas.fill(&closed, theme::PART);
    for edge in &edges {
        canvas.stroke(edge, PART);
    }
    if let Some(r) = view.blank {
        canvas.circle(world.point(Point2::origin()), r * world.scale, "none", Some(BLANK));
    }
    for (rank, pen) in [(0, ROUGH), (1, RAPID), (2, LINK), (3, CONTOUR)] {
        for run in runs(view, strokes, rank) {
            canvas.stroke(&world.polyline(&run), pen);
        }
    }
    vertices(canvas, view, world, strokes);
    marks(canvas, world, strokes);
}

/// Drawing order: what is more important lies above.
fn rank(view: &PathView, stroke: &Stroke) -> u8 {
    match stroke.what {
        Use::Rapid => 1,
        Use::Link | Use::Plunge => 2,
        Use::Cut if is_rough(view, stroke) => 0,
        Use::Cut => 3,
    }
}

fn is_rough(view: &PathView, stroke: &Stroke) -> bool {
    stroke.piece.and_then(|p| view.rough.get(p.0 as usize)).copied().unwrap_or(false)
}

/// Neighbouring strokes of one rank as one polyline; those that repeat one at another height are left out.
fn runs(view: &PathView, strokes: &[Stroke], wanted: u8) -> Vec<Vec<Point2>> {
    let mut runs: Vec<Vec<Point2>> = Vec::new();
    let mut connected = false;
    for stroke in strokes {
        let counts = rank(view, stroke) == wanted && stroke.what != Use::Plunge;
        if counts {
            match runs.last_mut().filter(|_| connected) {
                Some(run) => run.extend(stroke.points.iter().skip(1)),
                None => runs.push(stroke.points.clone()),
            }
        }
        connected = counts;
    }
    runs
}

/// Ends of contour blocks.
fn vertices(canvas: &mut Canvas, view: &PathView, world: &View, strokes: &[Stroke]) {
    let of = |rough: bool| -> Vec<Pixel> {
        let cut = strokes.iter().filter(|s| s.what == Use::Cut && is_rough(view, s) == rough);
        cut.filter_map(|s| s.points.last()).map(|p| world.point(*p)).collect()
    };
    canvas.dots(&of(true), 3.4, theme::ROUGH);
    canvas.dots(&of(false), 5.6, theme::PATH);
}

/// Where the cutter goes down, and where the program starts.
fn marks(canvas: &mut Canvas, world: &View, strokes: &[Stroke]) {
    for s in strokes.iter().filter(|s| s.what == Use::Plunge) {
        if let Some(p) = s.points.last() {
            canvas.circle(world.point(*p), 4.2, "#ffffff", Some(LINK));
        }
    }
}

fn legend(canvas: &mut Canvas, view: &PathView, strokes: &[Stroke]) {
    let cuts = |rough: bool| strokes.iter().any(|s| s.what == Use::Cut && is_rough(view, s) == rough);
    let entries = [
        (PART, "part", !view.part.is_empty()),
        (BLANK, "blank", view.blank.is_some()),
        (ROUGH, "roughing", cuts(true)),
        (CONTOUR, "contour, dots at the ends of blocks", cuts(false)),
        (LINK, "leads and links, rings where the cutter plunges", true),
        (RAPID, "rapids", strokes.iter().any(|s| s.what == Use::Rapid)),
    ];
    let (mut x, y) = (AT.0, AT.1 + SIZE.1 + 66.0);
    for (pen, text, _) in entries.iter().filter(|e| e.2) {
        canvas.line((x, y - 5.0), (x + 34.0, y - 5.0), *pen);
        canvas.text((x + 42.0, y), text, theme::text(13.0, theme::INK, Anchor::Start));
        x += 42.0 + 6.3 * text.chars().count() as f64 + 24.0;
    }
}
