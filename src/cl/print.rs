//! CL data as APT CL text (`--emit cl`).
//!
//! One flavour, statement per line:
//! - coordinates and feeds in the program's unit, rounded to [`DECIMALS`] decimals and printed as the shortest
//!   number that reads back the same; never `-0`;
//! - `RAPID` on its own line arms the next `GOTO`;
//! - an arc is `CIRCLE/ xc, yc, zc, i, j, k, r` followed by one `GOTO` to its end; it turns about the axis
//!   (i, j, k) by the right-hand rule, so k = -1 is clockwise. A full circle ends where it starts;
//! - a pass over a surface is printed as points of its exact track, evenly spread, after a `$$` comment;
//! - a curve that is neither line nor arc is printed as `GOTO` points whose chords stay within
//!   [`CHORD_TOLERANCE`] of it, after a `$$` comment that says so. This is a listing tolerance only: the
//!   compiler itself carries the exact curve on.

use core::fmt::Write as _;

use super::lead::{self, LeadPath};
use super::spline::{self, Spline};
use super::{
    Circle, Cl, Contour, Cycle, CycleKind, Effort, Lead, Operation, Pass, Record, RecordKind, RetractTo,
};
use crate::geom::curve::{PlanarCurve, Shape};
use crate::geom::surface::Guide;
use crate::geom::{Point2, Point3, Side};
use crate::ir::{Compensation, Coolant, Feed, Spindle, Tool};
use crate::units::LengthUnit;

/// Largest distance of a printed chord from its curve, mm.
pub const CHORD_TOLERANCE: f64 = 0.001;
/// Decimals kept of every printed number.
pub const DECIMALS: u32 = 9;
/// Chords of a listed pass over a surface.
const PASS_POINTS: u32 = 24;
/// Chords of one smooth span at most, so that a degenerate curve cannot print for ever.
const MAX_CHORDS: u32 = 100_000;

/// The whole program.
#[must_use]
pub fn print(cl: &Cl) -> String {
    let mut printer = Printer { out: String::new(), cl, scale: cl.units.in_mm(), tolerance: None };
    printer.program();
    printer.out
}

/// The text of every record, in order.
#[must_use]
pub fn records(cl: &Cl) -> Vec<String> {
    let one = |record: &Record| {
        let mut printer = Printer { out: String::new(), cl, scale: cl.units.in_mm(), tolerance: None };
        printer.record(record);
        printer.out
    };
    cl.records.iter().map(one).collect()
}

/// A number as CL text prints it.
#[must_use]
pub fn number(value: f64) -> String {
    const UNIT: f64 = 1e9;
    let scaled = value * UNIT;
    // Beyond 2^53 there is nothing to round.
    let rounded = if scaled.abs() < 9e15 { scaled.round() / UNIT } else { value };
    if rounded == 0.0 { "0".to_owned() } else { rounded.to_string() }
}

struct Printer<'a> {
    out: String,
    cl: &'a Cl,
    scale: f64,
    /// Tolerance of arcs that the text has given last, mm.
    tolerance: Option<f64>,
}

impl Printer<'_> {
    fn program(&mut self) {
        if let Some(title) = &self.cl.title {
            self.line(format_args!("PARTNO {title}"));
        }
        self.line(format_args!("UNITS/ {}", unit_word(self.cl.units)));
        for record in &self.cl.records {
            self.record(record);
        }
        self.line(format_args!("FINI"));
    }

    fn line(&mut self, text: core::fmt::Arguments<'_>) {
        // Writing to a String cannot fail.
        let _ = writeln!(self.out, "{text}");
    }

    fn record(&mut self, record: &Record) {
        match &record.kind {
            RecordKind::BeginOperation(index) => self.begin(*index),
            RecordKind::EndOperation(index) => self.end(*index),
            RecordKind::LoadTool(tool) => self.tool(&self.cl.tools[*tool]),
            RecordKind::Spindle(spindle) => self.spindle(*spindle),
            RecordKind::Feed(feed) => self.feed(*feed),
            RecordKind::Coolant(coolant) => {
                self.line(format_args!("COOLNT/ {}", coolant_word(*coolant)));
            }
            RecordKind::Compensation(on) => self.line(format_args!("CUTCOM/ {}", compensation_words(*on))),
            RecordKind::Dwell(seconds) => self.line(format_args!("DELAY/ {}", number(*seconds))),
            RecordKind::Stop => self.line(format_args!("STOP")),
            RecordKind::OptionalStop => self.line(format_args!("OPSTOP")),
            RecordKind::Comment(text) => self.line(format_args!("PPRINT {text}")),
            RecordKind::Insert(text) => self.line(format_args!("INSERT {text}")),
            RecordKind::From(p) => self.move_to("FROM", *p),
            RecordKind::Rapid(p) => self.rapid(*p),
            RecordKind::Linear(p) => self.move_to("GOTO", *p),
            RecordKind::Circle(circle) => self.arc(circle),
            RecordKind::Spline(spline) => self.spline(spline),
            RecordKind::Pass(pass) => self.pass(pass),
            RecordKind::Contour(contour) => self.contour(contour),
            RecordKind::BeginCycle(cycle) => self.cycle(cycle),
            RecordKind::Hole(p) => self.move_to("GOTO", *p),
            RecordKind::EndCycle => self.line(format_args!("CYCLE/ OFF")),
        }
    }

    fn begin(&mut self, index: u32) {
        let Some(operation) = self.cl.operations.get(index as usize) else { return };
        let (kind, name) = (operation.kind, &operation.name);
        let kind = if name.starts_with(kind) { String::new() } else { format!("{kind} ") };
        self.line(format_args!("$$ OPERATION {}: {kind}{name}", index + 1));
        self.tolerance(operation);
        if let Some(effort) = operation.effort {
            self.effort(&effort);
        }
    }

    fn tolerance(&mut self, operation: &Operation) {
        let least = operation.band.into.min(operation.band.out);
        self.tolerance = Some(if least > 0.0 { least } else { operation.band.into.max(operation.band.out) });
        let (into, out) = (self.length(operation.band.into), self.length(operation.band.out));
        self.line(format_args!("INTOL/ {into}"));
        self.line(format_args!("OUTTOL/ {out}"));
    }

    fn effort(&mut self, effort: &Effort) {
        let (engaged, links) = (self.length(round3(effort.engaged)), self.length(round3(effort.links)));
        let bound = self.length(round3(effort.bound));
        self.line(format_args!("$$ PATH {engaged} IN THE STOCK, {links} BETWEEN PASSES, BOUND {bound}"));
    }

    fn end(&mut self, index: u32) {
        self.line(format_args!("$$ END OF OPERATION {}", index + 1));
    }

    fn tool(&mut self, tool: &Tool) {
        let (d, r) = (self.length(tool.diameter), self.length(tool.corner));
        let [e, f, a, b, h] = tool.profile;
        // The further numbers of a cutter that its diameter and corner say all about are left out.
        if [e, f, a, b, h] == [tool.diameter / 2.0 - tool.corner, tool.corner, 0.0, 0.0, 0.0]
            || tool.profile == [0.0; 5]
        {
            self.line(format_args!("CUTTER/ {d}, {r}"));
        } else {
            let (e, f, h) = (self.length(e), self.length(f), self.length(h));
            let (a, b) = (number(a.to_degrees()), number(b.to_degrees()));
            self.line(format_args!("CUTTER/ {d}, {r}, {e}, {f}, {a}, {b}, {h}"));
        }
        let words = if tool.words.is_empty() { String::new() } else { format!(", {}", tool.words) };
        match tool.number {
            Some(n) => self.line(format_args!("LOADTL/ {n}{words} $$ {}", tool.name)),
            None => self.line(format_args!("LOADTL/ {}{words}", tool.name)),
        }
    }

    fn spindle(&mut self, spindle: Spindle) {
        match spindle {
            Spindle::Off => self.line(format_args!("SPINDL/ OFF")),
            Spindle::On { rpm, clockwise, range } => {
                let sense = if clockwise { "CLW" } else { "CCLW" };
                let range = range.word().map_or_else(String::new, |word| format!(", RANGE, {word}"));
                self.line(format_args!("SPINDL/ {}, {sense}{range}", number(rpm)));
            }
        }
    }

    fn feed(&mut self, feed: Feed) {
        let (value, word) = self.feed_words(feed);
        self.line(format_args!("FEDRAT/ {value}, {word}"));
    }

    fn feed_words(&self, feed: Feed) -> (String, &'static str) {
        let (value, mm, inch) = match feed {
            Feed::PerMinute(v) => (v, "MMPM", "IPM"),
            Feed::PerRevolution(v) => (v, "PERREV", "PERREV"),
            Feed::PerTooth(v) => (v, "PERTOO", "PERTOO"),
        };
        let word = if self.cl.units == LengthUnit::Inch { inch } else { mm };
        (self.length(value), word)
    }

    /// An arc or helix: centre, axis, radius; `TIMES, n` for n - 1 full turns more; then its end.
    fn arc(&mut self, circle: &Circle) {
        if self.tolerance.is_some_and(|t| (t - circle.tolerance).abs() > 1e-12) {
            self.tolerance = Some(circle.tolerance);
            self.line(format_args!("TOLER/ {}", self.length(circle.tolerance)));
        }
        let (x, y, z) =
            (self.length(circle.centre.x), self.length(circle.centre.y), self.length(circle.centre.z));
        let (i, j, k) = (number(circle.axis.x), number(circle.axis.y), number(circle.axis.z));
        let spoke = circle.to - circle.centre;
        let radius = self.length((spoke - circle.axis * spoke.dot(&circle.axis)).norm());
        let times = if circle.turns > 0 { format!(", TIMES, {}", circle.turns + 1) } else { String::new() };
        self.line(format_args!("CIRCLE/ {x}, {y}, {z}, {i}, {j}, {k}, {radius}{times}"));
        self.move_to("GOTO", circle.to);
    }

    fn cycle(&mut self, cycle: &Cycle) {
        let mut text = format!("CYCLE/ {}, FEDTO, {}", cycle_word(cycle.kind), self.length(cycle.depth));
        if let Some(peck) = cycle.peck {
            let _ = write!(text, ", STEP, {}", self.length(peck));
        }
        if let Some(first) = cycle.first_peck {
            let _ = write!(text, ", 1STPECK, {}", self.length(first));
        }
        match cycle.kind {
            CycleKind::Tap { pitch, left } => {
                let hand = if left { "CCLW" } else { "CLW" };
                let _ = write!(text, ", PITCH, {}, {hand}", self.length(pitch));
            }
            CycleKind::BoreOrient { shift } => _ = write!(text, ", ORIENT, {}", self.length(shift)),
            _ => {}
        }
        if !matches!(cycle.kind, CycleKind::Tap { .. }) {
            let (value, word) = self.feed_words(cycle.feed);
            let _ = write!(text, ", {word}, {value}");
        }
        let _ = write!(text, ", CLEAR, {}", self.length(cycle.clearance));
        if cycle.retract == RetractTo::Initial {
            text.push_str(", RETURN, ON");
        }
        if let Some(dwell) = cycle.dwell {
            let _ = write!(text, ", DWELL, {}", number(dwell));
        }
        self.line(format_args!("{text}"));
    }

    /// A length (or a feed) in the program's unit.
    fn length(&self, mm: f64) -> String {
        number(mm / self.scale)
    }

    fn move_to(&mut self, word: &str, p: Point3) {
        let (x, y, z) = (self.length(p.x), self.length(p.y), self.length(p.z));
        self.line(format_args!("{word}/ {x}, {y}, {z}"));
    }

    fn rapid(&mut self, p: Point3) {
        self.line(format_args!("RAPID"));
        self.move_to("GOTO", p);
    }

    fn contour(&mut self, contour: &Contour) {
        let (first, last) = contour.curve.domain();
        let start = first_parameter(contour);
        let spans = contour.curve.breaks().len().saturating_sub(1);
        let at_start = contour.curve.at(start);
        let at_end = if contour.curve.is_closed() {
            at_start
        } else {
            contour.curve.at_in(spans.saturating_sub(1), last)
        };
        for z in &contour.levels {
            let path = lead::entry(contour.entry, &at_start, contour.part);
            self.approach(contour, path.from(), *z);
            self.lead(&path, *z);
            self.line(format_args!("$$ CONTOUR {}", describe(contour)));
            if start > first {
                self.walk(contour.curve.as_ref(), start, last, *z);
                self.walk(contour.curve.as_ref(), first, start, *z);
            } else {
                self.walk(contour.curve.as_ref(), first, last, *z);
            }
            let path = lead::exit(contour.exit, &at_end, contour.part);
            self.lead(&path, *z);
            if contour.exit != Lead::None {
                self.rapid(at_height(path.to(), contour.clearance));
            }
        }
    }

    /// As NX writes it: the first control point is where the cutter is, and of the knots there are those after the first
    /// [`spline::ORDER`], the last one once, as shares of the whole.
    fn spline(&mut self, spline: &Spline) {
        self.line(format_args!("NURBS/"));
        let knots = spline.knots();
        let (first, last) = (knots[0], knots[knots.len() - 1]);
        for knot in knots.get(spline::ORDER..=spline.points().len()).unwrap_or_default() {
            self.line(format_args!("KNOT/ {}", (knot - first) / (last - first)));
        }
        for p in spline.points().iter().skip(1) {
            self.move_to("CNTRL", *p);
        }
    }

    /// A pass over a surface, as points whose chords stay near the exact track of the tip.
    fn pass(&mut self, pass: &Pass) {
        let what = match pass.track.guide {
            Guide::Parameter { axis: 0, value, .. } | Guide::Over { axis: 0, value, .. } => {
                format!("ALONG U AT V {}", number(value))
            }
            Guide::Parameter { value, .. } | Guide::Over { value, .. } => {
                format!("ALONG V AT U {}", number(value))
            }
            Guide::Line { .. } => "OVER A STRAIGHT LINE".to_owned(),
            Guide::Curve(_) | Guide::Plan(_) => "OVER A CURVE".to_owned(),
        };
        self.line(format_args!("$$ PASS {what}"));
        let mut contact = None;
        for k in 0..=PASS_POINTS {
            contact = pass.track.at(f64::from(k) / f64::from(PASS_POINTS), contact.as_ref());
            if let Some(c) = &contact {
                self.move_to("GOTO", Point3::new(c.centre.x, c.centre.y, c.centre.z - pass.tip));
            }
        }
    }

    /// From above down to the level, or straight to the first point.
    fn approach(&mut self, contour: &Contour, p: Point2, z: f64) {
        if contour.entry == Lead::None {
            return self.move_to("GOTO", at_height(p, z));
        }
        self.rapid(at_height(p, contour.clearance));
        if contour.approach < contour.clearance {
            self.rapid(at_height(p, contour.approach));
        }
        self.move_to("GOTO", at_height(p, z));
    }

    fn lead(&mut self, path: &LeadPath, z: f64) {
        match *path {
            LeadPath::Point(_) => {}
            LeadPath::Line { to, .. } => self.move_to("GOTO", at_height(to, z)),
            LeadPath::Arc { to, centre, radius, ccw, .. } => self.circle(centre, radius, ccw, to, z),
        }
    }

    fn circle(&mut self, centre: Point2, radius: f64, ccw: bool, to: Point2, z: f64) {
        let (x, y, h) = (self.length(centre.x), self.length(centre.y), self.length(z));
        let (k, r) = (if ccw { 1 } else { -1 }, self.length(radius));
        self.line(format_args!("CIRCLE/ {x}, {y}, {h}, 0, 0, {k}, {r}"));
        self.move_to("GOTO", at_height(to, z));
    }

    /// The part of the curve from `from` to `to`, span by span.
    fn walk(&mut self, curve: &dyn PlanarCurve, from: f64, to: f64, z: f64) {
        for (span, pair) in curve.breaks().windows(2).enumerate() {
            let (a, b) = (pair[0].max(from), pair[1].min(to));
            if a >= b {
                continue;
            }
            match curve.shape(span) {
                Shape::Line => self.move_to("GOTO", at_height(curve.at_in(span, b).p, z)),
                Shape::Arc { centre, radius, ccw } => {
                    self.circle(centre, radius, ccw, curve.at_in(span, b).p, z);
                }
                Shape::General => self.chords(curve, span, (a, b), z),
            }
        }
    }

    fn chords(&mut self, curve: &dyn PlanarCurve, span: usize, (a, b): (f64, f64), z: f64) {
        let mut u = a;
        for _ in 0..MAX_CHORDS {
            u = chord_end(curve, span, u, b);
            self.move_to("GOTO", at_height(curve.at_in(span, u).p, z));
            if u >= b {
                return;
            }
        }
    }
}

/// Parameter at which the chord from `u` ends, found by halving the step until the curve's points at a
/// quarter, half and three quarters of it are within [`CHORD_TOLERANCE`] of the chord.
fn chord_end(curve: &dyn PlanarCurve, span: usize, u: f64, last: f64) -> f64 {
    /// Steps below this share of the span are taken as they are.
    const SMALLEST: f64 = 1e-6;
    let at = curve.at_in(span, u);
    let sagitta_step = (8.0 * CHORD_TOLERANCE / at.k.abs().max(1e-6)).sqrt();
    let speed = at.speed.abs().max(1e-9);
    let mut step = (sagitta_step / speed).min(last - u);
    let smallest = SMALLEST * (last - u);
    while step > smallest && chord_error(curve, span, u, u + step) > CHORD_TOLERANCE {
        step *= 0.75;
    }
    if u + step * 1.001 >= last { last } else { u + step }
}

fn chord_error(curve: &dyn PlanarCurve, span: usize, u: f64, v: f64) -> f64 {
    let (p, q) = (curve.at_in(span, u).p, curve.at_in(span, v).p);
    let chord = q - p;
    let length = chord.norm();
    [0.25, 0.5, 0.75]
        .into_iter()
        .map(|x| {
            let d = curve.at_in(span, u + (v - u) * x).p - p;
            if length > 0.0 { (crate::geom::cross(chord, d) / length).abs() } else { d.norm() }
        })
        .fold(0.0, f64::max)
}

/// Where a contour starts: its preferred start when it is closed.
fn first_parameter(contour: &Contour) -> f64 {
    let (first, last) = contour.curve.domain();
    match contour.start {
        Some(start) if contour.curve.is_closed() && (first..last).contains(&start) => start,
        _ => first,
    }
}

fn describe(contour: &Contour) -> String {
    let spans = contour.curve.breaks().len().saturating_sub(1);
    let exact = (0..spans).filter(|s| contour.curve.shape(*s) != Shape::General).count();
    let side = if contour.part == Side::Left { "LEFT" } else { "RIGHT" };
    let closed = if contour.curve.is_closed() { "CLOSED" } else { "OPEN" };
    let how = interpolation_word(contour);
    format!("{how}, {closed}, PART ON THE {side}, {exact} OF {spans} SPANS EXACT LINES OR ARCS")
}

fn interpolation_word(contour: &Contour) -> &'static str {
    use crate::ir::Interpolation::{Auto, Circular, Linear, Nurbs, RTheta};
    match contour.interpolation {
        Linear => "LINEAR",
        Circular => "CIRCUL",
        RTheta => "RTHETA",
        Nurbs => "NURBS",
        Auto => "AUTO",
    }
}

fn cycle_word(kind: CycleKind) -> &'static str {
    match kind {
        CycleKind::Drill => "DRILL",
        CycleKind::Dwell => "FACE",
        CycleKind::Deep => "DEEP",
        CycleKind::ChipBreak => "BRKCHP",
        CycleKind::Tap { .. } => "TAP",
        CycleKind::Bore | CycleKind::BoreDwell => "REAM",
        CycleKind::BoreStop => "BORE, DRAG",
        CycleKind::BoreOrient { .. } => "BORE",
    }
}

fn unit_word(unit: LengthUnit) -> &'static str {
    match unit {
        LengthUnit::Millimetre => "MM",
        LengthUnit::Inch => "INCH",
    }
}

/// `CUTCOM/` with what is behind it.
fn compensation_words(on: Option<Compensation>) -> String {
    let Some(Compensation { side, register }) = on else { return "OFF".to_owned() };
    let side = if side == Side::Left { "LEFT" } else { "RIGHT" };
    register.map_or_else(|| side.to_owned(), |n| format!("{side}, {n}"))
}

fn coolant_word(coolant: Coolant) -> &'static str {
    match coolant {
        Coolant::Off => "OFF",
        Coolant::Flood => "FLOOD",
        Coolant::Mist => "MIST",
        Coolant::Through { .. } => "THRU",
    }
}

fn at_height(p: Point2, z: f64) -> Point3 {
    Point3::new(p.x, p.y, z)
}

/// Rounded to 1 um, for comments.
fn round3(mm: f64) -> f64 {
    (mm * 1000.0).round() / 1000.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_the_shortest_that_read_back_and_never_minus_zero() {
        let cases =
            [(0.1 + 0.2, "0.3"), (-0.0, "0"), (-1e-12, "0"), (28.0, "28"), (1e20, "100000000000000000000")];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
    }
}
