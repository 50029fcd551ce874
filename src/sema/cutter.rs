//! Cutters and stocks.

use crate::arena::Handle;
use crate::diag::Diagnostic;
use crate::diag::codes::semantics as codes;
use crate::geom::Point3;
use crate::ir::{CutterKind, Stock, StockShape, Tool};
use crate::math;
use crate::source::Span;
use crate::syntax::ast::Command;
use crate::units::{Angle, show_angle};
use crate::vocab::Statement;

use super::Analyser;
use super::matched::Matched;
use super::process::{Setting, radians};
use super::value::{Entity, Value};

impl Analyser<'_> {
    /// `T1 = CUTTER/ …`.
    pub(super) fn cutter(&mut self, m: &Matched, name: &str) -> Option<Handle<Tool>> {
        let d = m.number("d")?;
        let shape = if m.form == "kind" { self.by_kind(m, d)? } else { self.by_seven(m, d)? };
        let whole = |name: &str| {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            m.number(name).map(|n| n as u32)
        };
        let tool = Tool {
            name: name.to_owned(),
            kind: shape.kind,
            diameter: d,
            corner: shape.corner,
            profile: shape.profile,
            number: whole("number"),
            flutes: whole("flutes"),
            helix: m.number("helix").map(Angle::degrees),
            length: m.number("length"),
            stick_out: m.number("stick"),
            material: m.text("material").map(str::to_owned),
            words: String::new(),
            origin: self.origin(self.here),
        };
        if let Some(number) = tool.number {
            self.check_number(m, number, name)?;
        }
        Some(self.program.tools.push(tool))
    }

    fn check_number(&mut self, m: &Matched, number: u32, name: &str) -> Option<()> {
        let here = self.here;
        let taken =
            self.program.tools.iter().map(|(_, t)| t).find(|t| t.number == Some(number) && t.name != name);
        let Some((other, span)) = taken.map(|t| (t.name.clone(), self.program.origins[t.origin].span)) else {
            return Some(());
        };
        if span == here {
            return Some(());
        }
        let message = format!("{other} has the tool number {number} already");
        self.report(Diagnostic::new(&codes::ALREADY_DECLARED, m.span("number"), message).label(span, other));
        None
    }

    fn by_kind(&mut self, m: &Matched, d: f64) -> Option<Shape> {
        let given = m.number("r");
        let r = given.unwrap_or(0.0);
        let shape = match m.word("kind") {
            Some("BALL") => {
                if let Some(r) = given.filter(|r| (r - d / 2.0).abs() > SHAPE_TOLERANCE) {
                    let message = format!(
                        "the corner radius of a ball cutter is half its diameter, {}, and this is {}",
                        self.show_length(d / 2.0),
                        self.show_length(r)
                    );
                    self.report(
                        Diagnostic::new(&codes::CUTTER_SHAPE, m.span("r"), message).help("leave it out"),
                    );
                    return None;
                }
                Shape::plain(CutterKind::Ball, d, d / 2.0)
            }
            Some("BULL") => {
                if given.is_none() {
                    let message = "a bull cutter needs its corner radius";
                    self.report(
                        Diagnostic::new(&codes::MISSING_VALUE, m.span("d"), message)
                            .help("write it after the diameter: `CUTTER/ BULL, 16, 2`"),
                    );
                    return None;
                }
                Shape::plain(CutterKind::Bull, d, r)
            }
            Some("DRILL") => Shape::plain(CutterKind::Drill, d, 0.0),
            Some("TAPER") => {
                let angle = radians(m.number("angle").unwrap_or(0.0));
                let plain = Shape::plain(CutterKind::Taper, d, r);
                Shape { profile: [plain.profile[0], plain.profile[1], 0.0, angle, 0.0], ..plain }
            }
            _ => Shape::plain(CutterKind::Flat, d, r),
        };
        self.corner_fits(m, d, shape.corner)?;
        Some(shape)
    }

    fn by_seven(&mut self, m: &Matched, d: f64) -> Option<Shape> {
        let r = m.number("r").unwrap_or(0.0);
        let alpha = self.slope(m, "a")?;
        let beta = match m.number("angle") {
            Some(angle) if m.number("b").is_none() => radians(angle),
            _ => self.slope(m, "b")?,
        };
        self.corner_fits(m, d, r)?;
        let e = m.number("e").unwrap_or(d / 2.0 - r);
        let f = m.number("f").unwrap_or(r);
        let kind = if alpha != 0.0 || beta != 0.0 {
            CutterKind::Taper
        } else if (r - d / 2.0).abs() <= SHAPE_TOLERANCE {
            CutterKind::Ball
        } else if r > 0.0 {
            CutterKind::Bull
        } else {
            CutterKind::Flat
        };
        Some(Shape { kind, corner: r, profile: [e, f, alpha, beta, m.number("h").unwrap_or(0.0)] })
    }

    /// α or β in radians.
    fn slope(&mut self, m: &Matched, name: &str) -> Option<f64> {
        let angle = radians(m.number(name).unwrap_or(0.0));
        if angle.abs() < math::PI / 2.0 {
            return Some(angle);
        }
        let message = format!(
            "the angle of a cutter's edge lies between -90 and 90 deg, and this is {}",
            show_angle(Angle::radians(angle))
        );
        self.report(Diagnostic::new(&codes::CUTTER_SHAPE, m.span(name), message));
        None
    }

    fn corner_fits(&mut self, m: &Matched, d: f64, r: f64) -> Option<()> {
        if r <= d / 2.0 + SHAPE_TOLERANCE {
            return Some(());
        }
        let message = format!(
            "a corner radius of {} does not fit a cutter of {} diameter: at most {}",
            self.show_length(r),
            self.show_length(d),
            self.show_length(d / 2.0)
        );
        self.report(Diagnostic::new(&codes::CUTTER_SHAPE, m.span("r"), message));
        None
    }

    /// APT's `CUTTER/ d` without a label: the cutter from here on.
    pub(super) fn unlabelled_cutter(&mut self, statement: &'static Statement, command: &Command, span: Span) {
        let Some(mut m) = self.arguments(statement, command) else {
            self.state.tool = Setting::Unknown;
            return;
        };
        if let Some(number) = self.state.pending_number.take()
            && m.number("number").is_none()
        {
            let typed = super::matched::Typed::Number(f64::from(number));
            m.found.push(super::matched::Found { name: "number", span: m.word, typed });
        }
        match self.cutter(&m, "CUTTER") {
            Some(tool) => self.load_tool(tool, span),
            None => self.state.tool = Setting::Unknown,
        }
    }

    /// `B1 = STOCK/ …`.
    pub(super) fn stock(&mut self, m: &Matched, name: &str) -> Option<Value> {
        if m.form == "stl" {
            let message = "STOCK/ STL is a form that this version does not carry out yet";
            self.report(
                Diagnostic::new(&codes::NOT_YET, m.span("shape"), message).help("use ROUND or BLOCK"),
            );
            return None;
        }
        let shape = if m.form == "round" {
            StockShape::Round { radius: m.number("radius")?, height: m.number("height") }
        } else {
            let (a, b) = (m.vector("corner")?.v, m.vector("opposite")?.v);
            if let Some(axis) = (0..3).find(|&i| a[i] == b[i]) {
                let message = format!(
                    "a block has an extent in {}; both corners are at the same",
                    ["x", "y", "z"][axis]
                );
                self.report(Diagnostic::new(&codes::OUT_OF_RANGE, m.span("opposite"), message));
                return None;
            }
            let pick = |f: fn(f64, f64) -> f64| Point3::new(f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2]));
            StockShape::Block { min: pick(f64::min), max: pick(f64::max) }
        };
        let origin = self.origin(self.here);
        let stock = self.program.stocks.push(Stock { name: name.to_owned(), shape, origin });
        self.state.stock = Some(stock);
        Some(Value::Entity(Entity::Stock(stock)))
    }
}

/// Radii and diameters that agree within this many mm agree: rounding of unit conversion.
const SHAPE_TOLERANCE: f64 = 1e-9;

struct Shape {
    kind: CutterKind,
    corner: f64,
    profile: [f64; 5],
}

impl Shape {
    fn plain(kind: CutterKind, d: f64, r: f64) -> Shape {
        Shape { kind, corner: r, profile: [d / 2.0 - r, r, 0.0, 0.0, 0.0] }
    }
}
