//! Operations: what they have in common, `PROFIL` and `ROUGH` of cams.

use crate::arena::Handle;
use crate::diag::codes::semantics as codes;
use crate::diag::{self, Diagnostic};
use crate::geom::curve::{CurveRef, ends};
use crate::geom::{Point2, Side, measure};
use crate::ir::{
    CamEntity, CurveEntity, Cut, Entry, Flank, Interpolation, Profile, ProfileTarget, RoughCam, StepKind,
    StockShape, Tool,
};
use crate::source::Span;
use crate::syntax::ast::Command;
use crate::vocab::{EntityKind, Statement};

use super::Analyser;
use super::matched::{Matched, Typed};
use super::process::Setting;
use super::scope::{Binding, BindingKind};
use super::value::{Entity, Value};

/// Ends within this many mm make a chain closed.
const CLOSED: f64 = 1e-6;
/// Accuracy of the area that tells which way a closed curve runs, mm².
const AREA_ACCURACY: f64 = 1e-6;

impl Analyser<'_> {
    /// `[label =] PROFIL/ …`, `[label =] ROUGH/ …`.
    pub(super) fn operation(&mut self, statement: &'static Statement, command: &Command, span: Span) {
        let label = command.label.as_ref().map(|t| &t.name);
        let free = label.is_none_or(|name| self.may_declare(name));
        let name = label.map(|n| n.text.clone());
        let m = self.arguments(statement, command);
        if let Some(m) = m.and_then(|m| self.tracut_arguments(statement, m)) {
            match statement.word {
                "ROUGH" if m.form == "offset" => self.rough_offset(&m, name),
                "ROUGH" if m.form == "levels" => self.rough_levels(&m, name),
                "ROUGH" => self.rough(&m, name),
                "SURFAC" => self.surfac(&m, name),
                _ => self.profil(&m, name),
            }
        }
        if let Some(label) = label.filter(|_| free) {
            let kind = BindingKind::Entity(EntityKind::Operation, Value::Entity(Entity::Operation));
            self.scope.set(label.upper(), Binding { kind, declared: label.span });
        }
        self.here = span;
    }

    /// The arguments under `TRACUT`: nets are replaced by their images; curves of the plane and cams cannot be yet.
    fn tracut_arguments(&mut self, statement: &Statement, mut m: Matched) -> Option<Matched> {
        let Some(at) = self.state.transform.as_ref().map(|(_, at)| *at) else { return Some(m) };
        if !m.found.iter().any(|f| matches!(f.typed, Typed::Entity(Entity::Net(_)))) {
            let message =
                format!("{} of curves and cams cannot be carried out under TRACUT yet", statement.word);
            self.report(
                Diagnostic::new(&codes::NOT_YET, m.word, message)
                    .label(at, "the transformation begins here")
                    .help("write `TRACUT/ NOMORE` before it"),
            );
            return None;
        }
        for found in &mut m.found {
            if let Typed::Entity(Entity::Net(net)) = &mut found.typed {
                *net = self.under_tracut(*net)?;
            }
        }
        Some(m)
    }

    /// The loaded cutter, after a check of all that a cut needs.
    pub(super) fn ready(&mut self, what: &str, m: &Matched) -> Option<Handle<Tool>> {
        self.needs_tool(what, m.word);
        let tool = match self.state.tool {
            Setting::Set(tool, _) => Some(tool),
            Setting::Unknown | Setting::Unset => None,
        };
        self.needs_spindle(what, m.word);
        self.needs_feed(what, m.word);
        if self.state.band.into == 0.0 && self.state.band.out == 0.0 {
            let mut problem = Diagnostic::new(
                &codes::NO_TOLERANCE,
                m.word,
                "INTOL and OUTTOL are both 0: no path can keep that",
            );
            if let Some(at) = self.state.band_at {
                problem = problem.label(at, "the last of them");
            }
            self.report(problem.help("write `OUTTOL/ 0.01`, for example"));
            return None;
        }
        tool
    }

    fn depth(&mut self, m: &Matched, stock: Option<Handle<crate::ir::Stock>>) -> Option<f64> {
        if let Some(depth) = m.number("depth") {
            return Some(depth);
        }
        let shape = stock.map(|s| self.program.stocks[s].shape.clone());
        match shape {
            Some(StockShape::Round { height: Some(height), .. }) => Some(height),
            Some(StockShape::Block { min, .. }) if min.z < 0.0 => Some(-min.z),
            _ => {
                let message = "how deep? There is no DEPTH, and no stock with a HEIGHT";
                self.report(
                    Diagnostic::new(&codes::NO_DEPTH, m.word, message)
                        .help("write `DEPTH, 10` here, or `HEIGHT, 10` at the STOCK"),
                );
                None
            }
        }
    }

    fn profil(&mut self, m: &Matched, name: Option<String>) {
        let tool = self.ready("PROFIL", m);
        let depth = self.depth(m, self.state.stock);
        let Some(targets) = self.targets(m) else { return };
        for target in &targets {
            if let (Some(tool), ProfileTarget::Cam(cam, flank)) = (tool, target) {
                self.cutter_fits(m, tool, (*cam, *flank), self.state.thick);
            }
        }
        let (Some(tool), Some(depth)) = (tool, depth) else { return };
        for target in targets {
            let profile = Profile {
                name: name.clone(),
                target,
                interpolation: interpolation(m),
                exact_dwells: m.word("dwells").is_some(),
                cut: cut(m),
                tool,
                depth,
                step: m.number("step"),
                leave: self.state.thick,
                entry: entry(m),
                band: self.state.band,
                clearance: self.state.clearance,
            };
            self.step(StepKind::Profile(profile));
        }
        self.moved();
    }

    /// Reports a cutter that cannot cut a flank whole.
    fn cutter_fits(
        &mut self,
        m: &Matched,
        tool: Handle<Tool>,
        (cam, flank): (Handle<CamEntity>, Flank),
        leave: f64,
    ) {
        let radius = self.program.tools[tool].diameter / 2.0 + leave;
        let entity = &self.program.cams[cam];
        let Some(issue) = entity.cam.cutter_issue(flank, radius) else { return };
        let declared = self.program.origins[self.program.tools[tool].origin].span;
        let place = self.program.origins[entity.origin].span;
        let problem = diag::cam::cam(&issue, m.word, self.unit());
        self.report(problem.label(declared, "the cutter").label(place, "the cam"));
    }

    /// After an operation the cutter is somewhere above the part.
    pub(super) fn moved(&mut self) {
        self.state.position = None;
        self.state.at_from = false;
        self.state.rapid = false;
    }

    fn rough(&mut self, m: &Matched, name: Option<String>) {
        let tool = self.ready("ROUGH", m);
        let (Some(Entity::Cam(cam)), Some(Entity::Stock(stock)), Some(step)) =
            (m.entity("cam"), m.entity("stock"), m.number("step"))
        else {
            return;
        };
        let (cam, stock) = (*cam, *stock);
        let (Some(depth), Some(tool)) = (self.depth(m, Some(stock)), tool) else { return };
        let leave = m.number("leave").unwrap_or(0.0);
        self.cutter_fits(m, tool, (cam, Flank::Inner), leave);
        let rough = RoughCam {
            name,
            cam,
            stock,
            radial_step: m.number("width").unwrap_or(step),
            leave,
            depth,
            axial_step: Some(step),
            cut: cut(m),
            tool,
            band: self.state.band,
            clearance: self.state.clearance,
        };
        self.step(StepKind::RoughCam(rough));
        self.moved();
    }

    fn targets(&mut self, m: &Matched) -> Option<Vec<ProfileTarget>> {
        let Some(Typed::Contour(parts)) = m.get("contour").map(|f| f.typed.clone()) else { return None };
        if let [(Value::Entity(Entity::Cam(cam)), _)] = parts.as_slice() {
            return self.cam_targets(m, *cam);
        }
        if m.word("flank").is_some() {
            let message = "INNER and OUTER choose a flank of a groove cam, and this is a curve";
            self.report(
                Diagnostic::new(&codes::NO_SUCH_SIDE, m.span("flank"), message)
                    .help("a curve has the sides IN, OUT, LEFT, RIGHT, ON"),
            );
            return None;
        }
        let mut edges: Vec<(Handle<CurveEntity>, CurveRef)> = Vec::new();
        for (value, span) in &parts {
            edges.push(self.edge(value, *span)?);
        }
        let edges = orient(&edges);
        let cutter = self.side(m, &edges)?;
        let edges = edges.into_iter().map(|(handle, _, reversed)| (handle, reversed)).collect();
        Some(vec![ProfileTarget::Curve { edges, cutter }])
    }

    fn edge(&mut self, value: &Value, span: Span) -> Option<(Handle<CurveEntity>, CurveRef)> {
        let handle = match value {
            Value::Entity(Entity::Line(line)) => Some(line.curve),
            Value::Entity(Entity::Circle(circle)) => Some(circle.curve),
            Value::Entity(Entity::Curve(handle)) => Some(*handle),
            _ => None,
        };
        let Some(handle) = handle else {
            let message =
                format!("a chain is made of lines, circles and curves, not of {}", value.kind_name());
            self.report(Diagnostic::new(&codes::WRONG_KIND, span, message));
            return None;
        };
        Some((handle, self.program.curves[handle].curve.clone()))
    }

    fn cam_targets(&mut self, m: &Matched, cam: Handle<crate::ir::CamEntity>) -> Option<Vec<ProfileTarget>> {
        if m.word("side").is_some() {
            let message =
                "a cam's profile is always cut from outside its material; the side is the cam's own";
            self.report(
                Diagnostic::new(&codes::NO_SUCH_SIDE, m.span("side"), message).help("leave the word out"),
            );
            return None;
        }
        let groove = self.program.cams[cam].cam.definition().groove;
        let flanks: &[Flank] = match (m.word("flank"), groove) {
            (Some("OUTER"), false) => {
                let origin = self.program.origins[self.program.cams[cam].origin].span;
                let message = "this cam has no outer flank: it is no groove cam";
                self.report(
                    Diagnostic::new(&codes::NO_SUCH_SIDE, m.span("flank"), message)
                        .label(origin, "the cam")
                        .help("write GROOVE at the CAM, or leave OUTER out"),
                );
                return None;
            }
            (Some("OUTER"), true) => &[Flank::Outer],
            (Some(_), _) | (None, false) => &[Flank::Inner],
            (None, true) => &[Flank::Inner, Flank::Outer],
        };
        Some(flanks.iter().map(|&flank| ProfileTarget::Cam(cam, flank)).collect())
    }

    /// The side of the directed chain on which the cutter runs; `Some(None)`: on it.
    fn side(&mut self, m: &Matched, edges: &[(Handle<CurveEntity>, CurveRef, bool)]) -> Option<Option<Side>> {
        let closed = is_closed(edges);
        let left_is_in = || turns_left(edges);
        let sided = |inside: bool| if left_is_in() == inside { Side::Left } else { Side::Right };
        match m.word("side") {
            Some("LEFT") => Some(Some(Side::Left)),
            Some("RIGHT") => Some(Some(Side::Right)),
            Some("ON") => Some(None),
            Some(word) if !closed => {
                let message = format!("{word} needs a closed curve, and this one is open");
                self.report(
                    Diagnostic::new(&codes::NO_SUCH_SIDE, m.span("side"), message)
                        .help("LEFT and RIGHT are the sides of an open curve, ON its middle"),
                );
                None
            }
            Some(word) => Some(Some(sided(word == "IN"))),
            None if closed => Some(Some(sided(false))),
            None => Some(None),
        }
    }
}

/// Directs the edges so that each starts where the one before it ends.
fn orient(edges: &[(Handle<CurveEntity>, CurveRef)]) -> Vec<(Handle<CurveEntity>, CurveRef, bool)> {
    let mut result: Vec<(Handle<CurveEntity>, CurveRef, bool)> = Vec::new();
    let mut at: Option<Point2> = None;
    for (i, (handle, curve)) in edges.iter().enumerate() {
        let (start, end) = ends(curve.as_ref());
        let reversed = match (at, edges.get(i + 1)) {
            (Some(at), _) => (end - at).norm() < (start - at).norm(),
            (None, Some((_, next))) => {
                let (a, b) = ends(next.as_ref());
                let gap = |p: Point2| (a - p).norm().min((b - p).norm());
                gap(start) < gap(end)
            }
            (None, None) => false,
        };
        at = Some(if reversed { start } else { end });
        result.push((*handle, curve.clone(), reversed));
    }
    result
}

fn is_closed(edges: &[(Handle<CurveEntity>, CurveRef, bool)]) -> bool {
    let (Some(first), Some(last)) = (edges.first(), edges.last()) else { return false };
    let start = if first.2 { ends(first.1.as_ref()).1 } else { ends(first.1.as_ref()).0 };
    let end = if last.2 { ends(last.1.as_ref()).0 } else { ends(last.1.as_ref()).1 };
    (edges.len() > 1 || first.1.is_closed()) && (end - start).norm() <= CLOSED
}

/// Whether a closed chain runs counter-clockwise.
fn turns_left(edges: &[(Handle<CurveEntity>, CurveRef, bool)]) -> bool {
    let area = |(_, curve, reversed): &(Handle<CurveEntity>, CurveRef, bool)| {
        let area = measure::signed_area(curve.as_ref(), AREA_ACCURACY);
        if *reversed { -area } else { area }
    };
    edges.iter().map(area).sum::<f64>() > 0.0
}

fn interpolation(m: &Matched) -> Interpolation {
    match m.word("interpolation") {
        Some("LINEAR") => Interpolation::Linear,
        Some("CIRCUL") => Interpolation::Circular,
        Some("RTHETA") => Interpolation::RTheta,
        Some("NURBS") => Interpolation::Nurbs,
        _ => Interpolation::Auto,
    }
}

pub(super) fn cut(m: &Matched) -> Cut {
    if m.word("cut") == Some("CONVEN") { Cut::Conventional } else { Cut::Climb }
}

fn entry(m: &Matched) -> Entry {
    let size = m.number("size");
    let kind = m.all("entry").find_map(|f| match f.typed {
        Typed::Word(word) if word != "ENTRY" => Some(word),
        _ => None,
    });
    match kind {
        Some("TANLIN") => Entry::TangentLine(size),
        Some("PLUNGE") => Entry::Plunge,
        _ => Entry::TangentArc(size),
    }
}
