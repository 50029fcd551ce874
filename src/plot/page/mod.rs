//! One HTML page of what happens in space, to be turned and walked through: no server, no other file, no network.
//!
//! `viewer.js` is ours; `three.min.js` is made of three.js (MIT, its notice stands in it) by `bundle`. Numbers go in as
//! base64 of little-endian arrays, texts as JSON in which no `<` is left.

use serde::Serialize;

use super::PlotError;
use super::deviation::small;
use super::solid::colour::{BEYOND, INTO, LEFT, Range, Rgb, UNCUT};
use super::solid::mesh::{Mesh, meshes};
use super::solid::scene::{Scene, USES, Use, corners};
use super::solid::{cutter, marks};
use crate::geom::Point3;
use crate::ir::StockShape;

/// Places of a surface, over all its patches.
const PLACES: usize = 60_000;

/// Everything the viewer shows.
#[derive(Serialize)]
struct Data<'a> {
    title: &'a str,
    post: &'a str,
    /// Symbol of the unit, and mm in it.
    unit: (&'static str, f64),
    /// The same for small lengths.
    small: (&'static str, f64),
    /// Names of uses, and whether they are shown at first.
    uses: Vec<&'static str>,
    operations: Vec<&'a str>,
    points: String,
    line: String,
    from: String,
    to: String,
    what: String,
    operation: String,
    tool: String,
    feed: String,
    /// When each move ends, s.
    time: String,
    length: f64,
    surfaces: Vec<Surface>,
    ramp: Ramp,
    tools: Vec<Cutter<'a>>,
    stocks: Vec<Blank>,
    /// Edges of the part, x and y.
    edges: Vec<String>,
    /// Heights between which the edges are walls, mm.
    walls: (f64, f64),
}

#[derive(Serialize)]
struct Surface {
    operation: usize,
    patches: Vec<Patch>,
    /// Ends of the scale, mm; nothing when nothing was measured.
    range: Option<(f64, f64)>,
    marks: Vec<MarkOf>,
}

#[derive(Serialize)]
struct Patch {
    rows: usize,
    columns: usize,
    points: String,
    /// What is left, mm; not a number where nothing is cut.
    left: Option<String>,
    /// The line that decides it.
    line: Option<String>,
}

#[derive(Serialize)]
struct MarkOf {
    letter: char,
    name: &'static str,
    value: f64,
    at: [f64; 3],
    line: u32,
}

#[derive(Serialize)]
struct Ramp {
    into: [Rgb; 5],
    left: [Rgb; 5],
    beyond: [Rgb; 2],
    uncut: Rgb,
}

#[derive(Serialize)]
struct Cutter<'a> {
    number: u32,
    name: &'a str,
    outline: Vec<(f64, f64)>,
}

#[derive(Serialize)]
struct Blank {
    low: [f64; 3],
    high: [f64; 3],
    round: bool,
}

/// The page of a scene; with `measured` the surfaces are coloured by what is left on them.
///
/// # Errors
/// [`PlotError::NoSurface`] when what is left is asked for and no surface is finished.
pub(super) fn page(scene: &Scene<'_>, measured: bool) -> Result<String, PlotError> {
    let meshes = meshes(scene, PLACES, measured);
    if measured && meshes.is_empty() {
        return Err(PlotError::NoSurface);
    }
    let data = script_json(&data(scene, &meshes, measured))?;
    let text = script_json(&scene.text)?;
    let page = include_str!("page.html")
        .split("<!--")
        .map(|part| match part.split_once("-->") {
            Some(("TITLE", rest)) => crate::trace_page::escape(&scene.title) + rest,
            Some(("DATA", rest)) => data.clone() + rest,
            Some(("TEXT", rest)) => text.clone() + rest,
            Some(("THREE", rest)) => include_str!("three.min.js").to_owned() + rest,
            Some(("VIEWER", rest)) => include_str!("viewer.js").to_owned() + rest,
            _ => part.to_owned(),
        })
        .collect();
    Ok(page)
}

/// JSON that cannot end its script element.
fn script_json(value: &impl Serialize) -> Result<String, PlotError> {
    let text = serde_json::to_string(value).map_err(|e| PlotError::Render(e.to_string()))?;
    Ok(text.replace('<', "\\u003c"))
}

fn data<'a>(scene: &'a Scene<'_>, meshes: &[Mesh], measured: bool) -> Data<'a> {
    let strokes = &scene.strokes;
    let mut clock = 0.0;
    let times = strokes.iter().map(|s| {
        clock += s.seconds;
        clock
    });
    let times = floats(times);
    let (factor, name) = small(scene.units);
    Data {
        title: &scene.title,
        post: scene.post,
        unit: (scene.units.symbol(), scene.units.in_mm()),
        small: (name, 1.0 / factor),
        uses: USES.map(name_of).to_vec(),
        operations: scene.cl.operations.iter().map(|o| o.name.as_str()).collect(),
        points: floats(scene.points.iter().flat_map(|p| [p.x, p.y, p.z])),
        line: integers(strokes.iter().map(|s| s.line)),
        from: integers(strokes.iter().map(|s| s.from)),
        to: integers(strokes.iter().map(|s| s.to)),
        what: base64(strokes.iter().map(|s| s.what as u8)),
        operation: integers(strokes.iter().map(|s| s.operation.unwrap_or(u32::MAX))),
        tool: integers(strokes.iter().map(|s| s.tool)),
        feed: floats(strokes.iter().map(|s| s.feed)),
        time: times,
        length: strokes.iter().filter(|s| s.what != Use::Rapid).map(|s| s.length).sum(),
        surfaces: meshes.iter().map(|m| surface(scene, m, measured)).collect(),
        ramp: Ramp { into: INTO, left: LEFT, beyond: BEYOND, uncut: UNCUT },
        tools: cutters(scene),
        stocks: scene.stocks.iter().map(blank).collect(),
        edges: scene.edges.iter().map(|e| edge(e.as_ref())).collect(),
        walls: walls(scene),
    }
}

/// The name of a use, for people.
pub(super) const fn name_of(what: Use) -> &'static str {
    match what {
        Use::Rapid => "rapids",
        Use::Rough => "roughing",
        Use::Entry => "entries and exits",
        Use::Link => "links between passes",
        Use::Cut => "cuts",
    }
}

fn surface(scene: &Scene<'_>, mesh: &Mesh, measured: bool) -> Surface {
    let operation = scene.cl.operations.get(mesh.operation);
    let finish = operation.and_then(|o| o.guard.surface.as_ref().map(|f| (o, f)));
    let range = finish.filter(|_| measured).map(|(o, f)| Range::of(o, f, mesh));
    let patches = mesh.grids.iter().map(|grid| {
        let places = &grid.places;
        let lefts = || floats(places.iter().map(|p| p.left.map_or(f64::NAN, |l| l.height)));
        let lines = || integers(places.iter().map(|p| p.left.map_or(0, |l| l.line)));
        Patch {
            rows: grid.rows,
            columns: grid.columns,
            points: floats(places.iter().flat_map(|p| [p.p.x, p.p.y, p.p.z])),
            left: measured.then(lefts),
            line: measured.then(lines),
        }
    });
    let marks = marks::marks(scene, mesh.operation).into_iter().map(|m| MarkOf {
        letter: m.letter,
        name: m.name,
        value: m.value,
        at: xyz(m.at),
        line: m.line,
    });
    Surface {
        operation: mesh.operation,
        patches: patches.collect(),
        range: range.map(|r| (r.low, r.high)),
        marks: if measured { marks.collect() } else { Vec::new() },
    }
}

fn cutters<'a>(scene: &'a Scene<'_>) -> Vec<Cutter<'a>> {
    let cutter = |t: &'a crate::ir::Tool| Cutter {
        number: t.number.unwrap_or(0),
        name: &t.name,
        outline: cutter::outline(t),
    };
    scene.tools.iter().map(cutter).collect()
}

fn xyz(p: Point3) -> [f64; 3] {
    [p.x, p.y, p.z]
}

fn blank(stock: &StockShape) -> Blank {
    let (low, high) = corners(stock);
    Blank { low: xyz(low), high: xyz(high), round: matches!(stock, StockShape::Round { .. }) }
}

/// Points of an edge.
fn edge(curve: &dyn crate::geom::curve::PlanarCurve) -> String {
    const PER_SPAN: usize = 24;
    let share = |i: usize| crate::math::count(i) / crate::math::count(PER_SPAN);
    let spans = crate::geom::curve::spans(curve);
    let points = spans
        .into_iter()
        .flat_map(|(span, a, b)| (0..=PER_SPAN).map(move |i| curve.at_in(span, a + (b - a) * share(i)).p));
    floats(points.flat_map(|p| [p.x, p.y]))
}

/// From the lowest cut to Z0, or as high as is cut.
fn walls(scene: &Scene<'_>) -> (f64, f64) {
    let cuts = scene.strokes.iter().filter(|s| matches!(s.what, Use::Cut | Use::Rough));
    let heights = cuts.flat_map(|s| scene.path(s)).map(|p| p.z);
    let low = heights.fold(0.0, f64::min);
    (low, 0.0)
}

fn floats(values: impl Iterator<Item = f64>) -> String {
    base64(values.flat_map(|v| (v as f32).to_le_bytes()))
}

fn integers(values: impl Iterator<Item = u32>) -> String {
    base64(values.flat_map(u32::to_le_bytes))
}

/// Bytes as base64, padded (RFC 4648).
fn base64(bytes: impl Iterator<Item = u8>) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::new();
    let mut bytes = bytes.peekable();
    while bytes.peek().is_some() {
        let group = [bytes.next(), bytes.next(), bytes.next()];
        let bits = group.iter().fold(0u32, |bits, b| bits << 8 | u32::from(b.unwrap_or(0)));
        let given = group.iter().flatten().count();
        for k in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * k) & 63) as usize];
            out.push(if k <= given { char::from(digit) } else { '=' });
        }
    }
    out
}

#[cfg(test)]
pub(super) mod tests;
