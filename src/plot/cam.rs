//! The cam: profile, pitch curve, follower, cutter path, figures, and the diagrams beside it.

use super::Figure;
use super::canvas::{Anchor, Canvas, Pen, Pixel, label};
use super::world::View;
use super::{diagrams, follower, theme};
use crate::geom::Point2;
use crate::geom::cam::{Cam, Extreme, Flank, Rotation};
use crate::geom::curve::CurveRef;
use crate::geom::follower::Follower;
use crate::math::{DEG, PI, sin_cos};
use crate::units::LengthUnit;

/// What is drawn.
#[derive(Debug, Clone)]
pub struct CamView<'a> {
    /// The cam's name.
    pub name: &'a str,
    /// The cam.
    pub cam: &'a Cam,
    /// Unit of the figures.
    pub units: LengthUnit,
    /// Radius of the blank, mm.
    pub blank: Option<f64>,
    /// Cutter-centre paths along it.
    pub tracks: Vec<Track>,
}

/// A cutter-centre path.
#[derive(Debug, Clone)]
pub struct Track {
    /// The exact curve.
    pub curve: CurveRef,
    /// Where the emitted blocks begin and end, mm; may be empty.
    pub vertices: Vec<Point2>,
    /// For the legend.
    pub label: String,
}

const WIDTH: f64 = 1480.0;
const HEIGHT: f64 = 1040.0;
const PANEL: Pixel = (36.0, 96.0);
const PANEL_SIZE: Pixel = (760.0, 730.0);
const DIAGRAMS: Pixel = (880.0, 118.0);
const DIAGRAMS_SIZE: Pixel = (564.0, 858.0);

const PROFILE: Pen = Pen::solid(theme::PROFILE, 2.6);
const PITCH: Pen = Pen::dashed(theme::PITCH, 1.3, "12 4 2 4");
const BASE: Pen = Pen::dashed(theme::PITCH, 1.0, "3 4");
const TRACK: Pen = Pen::solid(theme::PATH, 1.3);
const BLANK: Pen = Pen::dashed(theme::STOCK, 1.4, "9 5");

/// Draws a cam.
#[must_use]
pub fn cam(view: &CamView) -> Figure {
    let mut canvas = Canvas::default();
    canvas.text((36.0, 48.0), &title(view), theme::TITLE);
    canvas.text((36.0, 74.0), &subtitle(view), theme::SUBTITLE);
    let world = world(view);
    canvas.clipped(PANEL, PANEL_SIZE, |c| panel(c, view, &world));
    canvas.rect(PANEL, PANEL_SIZE, "none", Some(theme::AXIS));
    scale_bar(&mut canvas, view, &world);
    legend(&mut canvas, view);
    table(&mut canvas, view);
    diagrams::draw(&mut canvas, view.cam, view.units, DIAGRAMS, DIAGRAMS_SIZE);
    Figure { svg: canvas.document(WIDTH, HEIGHT, &title(view)) }
}

fn title(view: &CamView) -> String {
    let kind = if view.cam.definition().groove { "groove cam" } else { "plate cam" };
    let follower = match view.cam.definition().follower {
        Follower::TranslatingRoller { .. } => "translating roller",
        Follower::TranslatingFlat { .. } => "translating flat face",
        Follower::OscillatingRoller { .. } => "oscillating roller",
        Follower::OscillatingFlat { .. } => "oscillating flat face",
    };
    format!("{}: {kind}, {follower}", view.name)
}

fn length(view: &CamView, mm: f64) -> String {
    let decimals = if view.units == LengthUnit::Inch { 4 } else { 3 };
    let text = label(mm / view.units.in_mm(), decimals);
    let text = text.trim_end_matches('0').trim_end_matches('.');
    format!("{text} {}", view.units.symbol())
}

fn subtitle(view: &CamView) -> String {
    let d = view.cam.definition();
    let mut parts = vec![format!("base radius {}", length(view, d.base))];
    match d.follower {
        Follower::TranslatingRoller { radius, offset } => {
            parts.push(format!("roller radius {}", length(view, radius)));
            parts.extend((offset != 0.0).then(|| format!("offset {}", length(view, offset))));
        }
        Follower::TranslatingFlat { offset } => {
            parts.extend((offset != 0.0).then(|| format!("offset {}", length(view, offset))));
        }
        Follower::OscillatingRoller { radius, arm, pivot, .. } => {
            parts.push(format!("roller radius {}", length(view, radius)));
            parts.push(format!("arm {}", length(view, arm)));
            parts.push(format!("pivot at {}", length(view, pivot)));
        }
        Follower::OscillatingFlat { pivot, offset, .. } => {
            parts.push(format!("pivot at {}", length(view, pivot)));
            parts.extend((offset != 0.0).then(|| format!("face offset {}", length(view, offset))));
        }
    }
    parts.push(match d.rotation {
        Rotation::Clockwise => "turns clockwise".into(),
        Rotation::CounterClockwise => "turns counter-clockwise".into(),
    });
    parts.extend(d.speed.map(|rpm| format!("{} rpm", label(rpm, usize::from(rpm.fract() != 0.0)))));
    parts.join(" · ")
}

/// The farthest of what is drawn round the centre, mm.
fn outer_radius(view: &CamView) -> f64 {
    let f = view.cam.figures();
    let flank = f.outer.as_ref().unwrap_or(&f.inner).farthest.value;
    let pitch = f.inner.farthest.value + view.cam.definition().follower.roller();
    let reach = |t: &Track| {
        let (low, high) = crate::geom::measure::bounding_box(t.curve.as_ref(), 16);
        [low.x, low.y, high.x, high.y].iter().fold(0.0_f64, |m, v| m.max(v.abs()))
    };
    let tracks = view.tracks.iter().map(reach).fold(0.0, f64::max);
    flank.max(pitch).max(tracks).max(view.blank.unwrap_or(0.0))
}

fn world(view: &CamView) -> View {
    const ROOM_FOR_LABELS: f64 = 1.2;
    let r = ROOM_FOR_LABELS * outer_radius(view);
    let (mut low, mut high) = (Point2::new(-r, -r), Point2::new(r, r));
    for p in follower::extent(view.cam) {
        low = Point2::new(low.x.min(p.x), low.y.min(p.y));
        high = Point2::new(high.x.max(p.x), high.y.max(p.y));
    }
    let inset = 10.0;
    let at = (PANEL.0 + inset, PANEL.1 + inset);
    View::fit(low, high, at, (PANEL_SIZE.0 - 2.0 * inset, PANEL_SIZE.1 - 2.0 * inset))
}

fn panel(canvas: &mut Canvas, view: &CamView, world: &View) {
    dial(canvas, view, world);
    flanks(canvas, view, world);
    let d = view.cam.definition();
    let centre = world.point(Point2::origin());
    canvas.circle(centre, d.base * world.scale, "none", Some(BASE));
    if d.follower.has_roller() {
        canvas.circle(centre, (d.base + d.follower.roller()) * world.scale, "none", Some(BASE));
        canvas.stroke(&world.curve(view.cam.pitch().as_ref()), PITCH);
    }
    for track in &view.tracks {
        canvas.stroke(&world.curve(track.curve.as_ref()), TRACK);
        let dots: Vec<Pixel> = track.vertices.iter().map(|p| world.point(*p)).collect();
        canvas.dots(&dots, 5.0, theme::PATH);
    }
    if let Some(radius) = view.blank {
        canvas.circle(centre, radius * world.scale, "none", Some(BLANK));
    }
    hub(canvas, view, world);
    follower::draw(canvas, world, view.cam);
}

fn flanks(canvas: &mut Canvas, view: &CamView, world: &View) {
    let inner = world.curve(view.cam.flank(Flank::Inner).as_ref());
    if view.cam.definition().groove {
        let outer = world.curve(view.cam.flank(Flank::Outer).as_ref());
        let plate = Pen::solid(theme::PART, 26.0);
        canvas.stroke(&outer, plate);
        canvas.fill(&inner, theme::PART);
        canvas.fill(&format!("{outer}{inner}"), "#ffffff");
        canvas.stroke(&outer, PROFILE);
    } else {
        canvas.fill(&inner, theme::PART);
    }
    canvas.stroke(&inner, PROFILE);
}

/// A ring of angles round the cam.
fn dial(canvas: &mut Canvas, view: &CamView, world: &View) {
    let radius = outer_radius(view) * 1.06;
    let point = |degrees: f64, r: f64| {
        let (s, c) = sin_cos(degrees * DEG);
        world.point(Point2::new(r * c, r * s))
    };
    canvas.circle(world.point(Point2::origin()), radius * world.scale, "none", Some(theme::GRID));
    let pixel = 1.0 / world.scale;
    for i in 0..72 {
        let degrees = f64::from(i) * 5.0;
        let major = i % 6 == 0;
        let inner = if major { 0.0 } else { radius };
        let pen = if major { theme::GRID } else { theme::AXIS };
        canvas.line(point(degrees, inner), point(degrees, radius + 5.0 * pixel), pen);
        if major {
            let mut p = point(degrees, radius + 20.0 * pixel);
            if degrees == 0.0 {
                // Beside the follower, not under it.
                p.1 += if view.cam.follower_at_zero().tip.y * world.scale > 12.0 { 16.0 } else { -26.0 };
            }
            let text = format!("{}°", label(degrees, 0));
            canvas.text((p.0, p.1 + 4.0), &text, theme::text(12.0, theme::MUTED, Anchor::Middle));
        }
    }
}

/// Axes of the hub and the sense of rotation.
fn hub(canvas: &mut Canvas, view: &CamView, world: &View) {
    let (x, y) = world.point(Point2::origin());
    let pen = Pen::dashed(theme::INK, 0.9, "14 3 3 3");
    let arm = 0.62 * view.cam.definition().base * world.scale;
    canvas.line((x - arm, y), (x + arm, y), pen);
    canvas.line((x, y - arm), (x, y + arm), pen);
    canvas.circle((x, y), 4.0, "#ffffff", Some(Pen::solid(theme::INK, 1.2)));
    let clockwise = view.cam.definition().rotation == Rotation::Clockwise;
    turning_arrow(canvas, (x, y), 0.42 * view.cam.definition().base * world.scale, clockwise);
}

fn turning_arrow(canvas: &mut Canvas, centre: Pixel, radius: f64, clockwise: bool) {
    const STEPS: u32 = 24;
    let sign = if clockwise { 1.0 } else { -1.0 };
    // Pixels have y downwards: growing angles turn clockwise on the picture.
    let start = if clockwise { -0.85 * PI } else { -0.15 * PI };
    let at = |angle: f64, r: f64| {
        let (s, c) = sin_cos(angle);
        (centre.0 + r * c, centre.1 + r * s)
    };
    let end = start + sign * 0.7 * PI;
    let points: Vec<Pixel> =
        (0..=STEPS).map(|i| at(start + (end - start) * f64::from(i) / f64::from(STEPS), radius)).collect();
    canvas.stroke(&super::world::polyline(&points), Pen::solid(theme::INK, 1.6));
    let head = 11.0 / radius;
    let tip = at(end + sign * head * 0.5, radius);
    let barbs = [at(end - sign * head * 0.6, radius + 5.0), at(end - sign * head * 0.6, radius - 5.0)];
    canvas.fill(&format!("{}Z", super::world::polyline(&[tip, barbs[0], barbs[1]])), theme::INK);
}

fn scale_bar(canvas: &mut Canvas, view: &CamView, world: &View) {
    let unit = view.units.in_mm();
    let bar = super::chart::round_step(90.0 / world.scale / unit);
    let (x, y) = (PANEL.0 + 18.0, PANEL.1 + PANEL_SIZE.1 - 16.0);
    let end = x + bar * unit * world.scale;
    let pen = Pen::solid(theme::INK, 1.4);
    canvas.line((x, y), (end, y), pen);
    for at in [x, end] {
        canvas.line((at, y - 5.0), (at, y + 5.0), pen);
    }
    let text = length(view, bar * unit);
    canvas.text((0.5 * (x + end), y - 9.0), &text, theme::text(12.0, theme::INK, Anchor::Middle));
}

fn legend(canvas: &mut Canvas, view: &CamView) {
    let d = view.cam.definition();
    let mut entries: Vec<(Pen, bool, String)> =
        vec![(PROFILE, false, if d.groove { "flanks" } else { "profile" }.into())];
    if d.follower.has_roller() {
        entries.push((PITCH, false, "pitch curve".into()));
        entries.push((BASE, false, "base and prime circle".into()));
    } else {
        entries.push((BASE, false, "base circle".into()));
    }
    entries.extend(view.blank.map(|_| (BLANK, false, "blank".into())));
    let tracks: Vec<String> = view.tracks.iter().map(|t| t.label.clone()).collect();
    if !tracks.is_empty() {
        let dots = view.tracks.iter().any(|t| !t.vertices.is_empty());
        entries.push((TRACK, dots, tracks.join(", ")));
    }
    let (mut x, y) = (PANEL.0 + 2.0, PANEL.1 + PANEL_SIZE.1 + 26.0);
    for (pen, dots, text) in entries {
        canvas.line((x, y - 5.0), (x + 34.0, y - 5.0), pen);
        if dots {
            canvas.dots(&[(x + 4.0, y - 5.0), (x + 30.0, y - 5.0)], 5.0, pen.color);
        }
        canvas.text((x + 42.0, y), &text, theme::text(13.0, theme::INK, Anchor::Start));
        x += 42.0 + 7.1 * text.chars().count() as f64 + 26.0;
    }
}

/// Key figures in three columns.
fn table(canvas: &mut Canvas, view: &CamView) {
    const COLUMN: f64 = 258.0;
    const ROW: f64 = 46.0;
    let top = PANEL.1 + PANEL_SIZE.1 + 62.0;
    for (i, (name, value)) in table_rows(view).into_iter().enumerate() {
        let (column, row) = ((i % 3) as f64, (i / 3) as f64);
        let (x, y) = (PANEL.0 + column * COLUMN, top + row * ROW);
        canvas.text((x, y), &name, theme::text(12.0, theme::MUTED, Anchor::Start));
        canvas.text((x, y + 19.0), &value, theme::text(15.0, theme::INK, Anchor::Start));
    }
}

fn table_rows(view: &CamView) -> Vec<(String, String)> {
    let f = view.cam.figures();
    let mm = view.units.in_mm();
    let at = |e: Extreme, value: String| format!("{value} at {}°", label(e.at.deg(), 1));
    let radius = |e: Option<Extreme>| e.map_or("none".to_owned(), |e| at(e, length(view, e.value)));
    let area = format!("{} {}²", label(f.inner.area / (mm * mm), 1), view.units.symbol());
    let mut rows = vec![
        ("profile length".to_owned(), length(view, f.inner.length)),
        (
            "profile radius".to_owned(),
            format!("{} to {}", length(view, f.inner.nearest.value), length(view, f.inner.farthest.value)),
        ),
        ("area".to_owned(), area),
        (
            "largest pressure angle".to_owned(),
            at(f.pressure_angle, format!("{}°", label(f.pressure_angle.value / DEG, 3))),
        ),
        ("smallest convex radius".to_owned(), radius(f.inner.convex)),
        ("smallest concave radius".to_owned(), radius(f.inner.concave)),
    ];
    rows.extend(view.cam.smallest_base().map(|base| {
        let limit = super::canvas::decimal(view.cam.definition().max_pressure_angle.deg(), 2);
        (format!("smallest base radius for {limit}°"), length(view, base))
    }));
    rows.extend(f.face.map(|face| ("face width needed".to_owned(), length(view, face.width()))));
    for track in &view.tracks {
        let blocks = if track.vertices.is_empty() {
            length(view, crate::geom::measure::length(track.curve.as_ref(), 1e-3))
        } else {
            let count =
                track.vertices.len() - usize::from(track.curve.is_closed() || track.vertices.len() > 1);
            format!(
                "{count} blocks, {}",
                length(view, crate::geom::measure::length(track.curve.as_ref(), 1e-3))
            )
        };
        rows.push((track.label.clone(), blocks));
    }
    rows.truncate(9);
    rows
}
