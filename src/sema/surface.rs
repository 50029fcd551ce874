//! `NET` and `SURFAC`.

use crate::arena::Handle;
use crate::diag::Diagnostic;
use crate::diag::codes::{geometry, planning, semantics as codes};
use crate::geom::Point3;
use crate::geom::surface::curvature::most_concave;
use crate::geom::surface::net::uneven;
use crate::geom::surface::{Net, NetIssue};
use crate::ir::{
    Along, CutterKind, NetEntity, PassShape, RoughNet, Spacing, StepKind, StockShape, Surface, Tool,
};
use crate::math::{DEG, count};
use crate::source::Span;
use crate::units::{Dim, Quantity};

use super::include::unreadable_file;
use super::matched::{Matched, Typed};
use super::transform::Transform;
use super::value::{Entity, Value};
use super::{Analyser, limits};

/// Patches that meet at a smaller angle are smooth enough, degrees.
const SMOOTH: f64 = 0.01;
/// Steepest way down into material, degrees.
const RAMP: f64 = 3.0;
/// Height of the cusps of a roughing pass as a share of what it leaves.
const ROUGH_CUSP: f64 = 0.2;
/// Accuracy of the smallest concave radius, mm.
pub(super) const RADIUS_ACCURACY: f64 = 1e-9;

/// The poles of a net as they were given.
#[derive(Debug, Default)]
struct Poles {
    rows: usize,
    columns: usize,
    points: Vec<Point3>,
    weights: Option<Vec<f64>>,
}

impl Analyser<'_> {
    /// `N1 = NET/ …`.
    pub(super) fn net(&mut self, m: &Matched, name: &str) -> Option<Value> {
        let net = match m.form {
            "cad" => self.net_cad(m)?,
            "moved" => self.net_moved(m)?,
            "file" => {
                let poles = self.net_file(m)?;
                self.net_of_poles(&poles, m.span("file"))?
            }
            _ => self.net_of_poles(&listed(m), m.word)?,
        };
        self.check_joints(&net, m.word);
        let origin = self.origin(self.here);
        let handle = self.program.nets.push(NetEntity { name: name.to_owned(), net, declared: true, origin });
        Some(Value::Entity(Entity::Net(handle)))
    }

    fn net_of_poles(&mut self, poles: &Poles, at: Span) -> Option<Net> {
        let made = Net::new(poles.rows, poles.columns, &poles.points, poles.weights.as_deref());
        made.map_err(|issue| self.report(unsound(&issue, at))).ok()
    }

    /// `NET/ N1, TRFORM, M1`.
    fn net_moved(&mut self, m: &Matched) -> Option<Net> {
        let (Some(Entity::Net(net)), Some(Entity::Matrix(map))) = (m.entity("net"), m.entity("matrix"))
        else {
            return None;
        };
        let (net, map) = (*net, map.clone());
        self.moved_net(net, &map, m.span("matrix"))
    }

    /// The image of a net; a map that flattens space gives none.
    fn moved_net(&mut self, net: Handle<NetEntity>, map: &Transform, at: Span) -> Option<Net> {
        if map.inverse().is_none() {
            return self
                .fail_geometry(at, "this matrix flattens space: the image of a net would be no surface");
        }
        let image = |p: Point3| Point3::from(map.point([p.x, p.y, p.z]));
        let moved = self.program.nets[net].net.map(image);
        moved.map_err(|issue| self.report(unsound(&issue, at))).ok()
    }

    /// A net as `TRACUT` has it: its exact image.
    pub(super) fn under_tracut(&mut self, net: Handle<NetEntity>) -> Option<Handle<NetEntity>> {
        let Some((map, at)) = self.state.transform.clone() else { return Some(net) };
        if let Some((_, _, image)) = self.images.iter().find(|(n, m, _)| *n == net && *m == *map) {
            return Some(*image);
        }
        let moved = self.moved_net(net, &map, at)?;
        let (name, origin) = (self.program.nets[net].name.clone(), self.program.nets[net].origin);
        let image = self.program.nets.push(NetEntity { name, net: moved, declared: false, origin });
        self.images.push((net, *map, image));
        Some(image)
    }

    /// Warns of the worst joint that is not smooth.
    fn check_joints(&mut self, net: &Net, at: Span) {
        let joints = net.joints();
        let sharp: Vec<_> = joints.iter().filter(|j| j.angle.deg() > SMOOTH).collect();
        let Some(worst) = sharp.iter().max_by(|a, b| a.angle.rad().total_cmp(&b.angle.rad())) else { return };
        let [row, column] = worst.patch;
        let (next, p) = (if worst.axis == 0 { [row + 1, column] } else { [row, column + 1] }, worst.at);
        let message = format!(
            "patches {}, {} and {}, {} of this net meet at an angle of {:.4} deg at ({}, {}, {})",
            row + 1,
            column + 1,
            next[0] + 1,
            next[1] + 1,
            worst.angle.deg(),
            self.show_length(p.x),
            self.show_length(p.y),
            self.show_length(p.z)
        );
        let more =
            format!("{} of {} joints have a crease of more than {SMOOTH} deg", sharp.len(), joints.len());
        self.report(Diagnostic::new(&geometry::CREASE, at, message).note(more).help(
            "put the poles on both sides of the joint and the joint's own pole on one line for a smooth surface",
        ));
    }

    fn net_file(&mut self, m: &Matched) -> Option<Poles> {
        let path = m.text("file")?.to_owned();
        let at = m.span("file");
        let from = self.sources.file(at.file).name.clone();
        let text = match self.files.read(Some(&from), &path) {
            Ok((name, text)) => {
                self.sources.add(name, text.as_str());
                text
            }
            Err(error) => {
                let problem = unreadable_file(&path, &error, at);
                self.report(problem);
                return None;
            }
        };
        match read_poles(&text, &|x| Quantity::bare(x).land(Dim::LENGTH, self.program.units).map(|q| q.value))
        {
            Ok(poles) => Some(poles),
            Err((line, what)) => {
                let message = format!("{path}, line {line}: {what}");
                self.report(Diagnostic::new(&geometry::NET_SHAPE, at, message).help(
                    "a heading `x,y,z` or `x,y,z,w`, then one pole a line; an empty line ends a row of poles",
                ));
                None
            }
        }
    }

    /// `N1.MINRADIUS` and the like.
    pub(super) fn net_member(&self, net: Handle<NetEntity>, name: &str) -> Option<Value> {
        let net = &self.program.nets[net].net;
        match name {
            "ROWS" => Some(Value::bare(count(net.size()[0]))),
            "COLUMNS" => Some(Value::bare(count(net.size()[1]))),
            _ => {
                let radius = most_concave(net, RADIUS_ACCURACY).proven_radius();
                radius.is_finite().then(|| Value::number(radius, Dim::LENGTH))
            }
        }
    }

    /// `SURFAC/ …`.
    pub(super) fn surfac(&mut self, m: &Matched, name: Option<String>) {
        let tool = self.ready("SURFAC", m);
        let spacing = self.spacing(m);
        let tool = tool.and_then(|tool| self.solid(m, tool));
        let shape = match m.word("interpolation") {
            Some("CIRCUL") => PassShape::Arcs,
            Some("NURBS") => PassShape::Curves,
            _ => PassShape::Lines,
        };
        if shape != PassShape::Lines && !self.may_bend(m, shape, tool) {
            return;
        }
        let Some(Entity::Net(net)) = m.entity("net") else { return };
        let net = *net;
        let (Some(tool), Some(spacing)) = (tool, spacing) else { return };
        let leave = m.number("leave").unwrap_or(self.state.thick);
        if !self.has_room(m, tool, leave) {
            return;
        }
        let surface = Surface {
            name,
            net,
            zigzag: m.word("order") != Some("ONEWAY"),
            along: along(m),
            spacing,
            avoid: !m.all("gouge").any(|f| matches!(f.typed, Typed::Word("CHECK"))),
            tool,
            leave,
            band: self.state.band,
            clearance: self.state.clearance,
            stock_top: self.stock_top(),
            rough: false,
            shape,
        };
        self.step(StepKind::Surface(surface));
        self.moved();
    }

    /// `ROUGH/ net, OFFSET, leave …`.
    pub(super) fn rough_offset(&mut self, m: &Matched, name: Option<String>) {
        let tool = self.ready("ROUGH", m).and_then(|tool| self.solid(m, tool));
        let (Some(tool), Some(Entity::Net(net)), Some(leave)) = (tool, m.entity("net"), m.number("leave"))
        else {
            return;
        };
        let cusp = m.number("cusp").unwrap_or(ROUGH_CUSP * leave);
        let surface = Surface {
            name,
            net: *net,
            zigzag: m.word("order") != Some("ONEWAY"),
            along: along(m),
            spacing: m.number("step").map_or(Spacing::Cusp(cusp), Spacing::Step),
            avoid: true,
            tool,
            leave,
            band: self.state.band,
            clearance: self.state.clearance,
            stock_top: self.stock_top(),
            rough: true,
            shape: PassShape::Lines,
        };
        self.step(StepKind::Surface(surface));
        self.moved();
    }

    /// `ROUGH/ net, LEVELS, STOCK, b, STEP, s …`.
    pub(super) fn rough_levels(&mut self, m: &Matched, name: Option<String>) {
        let tool = self.ready("ROUGH", m).and_then(|tool| self.solid(m, tool));
        let (Some(tool), Some(Entity::Net(net)), Some(Entity::Stock(stock)), Some(step)) =
            (tool, m.entity("net"), m.entity("stock"), m.number("step"))
        else {
            return;
        };
        let rough = RoughNet {
            name,
            net: *net,
            stock: *stock,
            step,
            width: m.number("width").unwrap_or(step),
            leave: m.number("leave").unwrap_or(self.state.thick),
            ramp: m.number("ramp").unwrap_or(RAMP) * DEG,
            cut: super::operation::cut(m),
            inward: m.word("order").map(|word| word == "IN"),
            tool,
            band: self.state.band,
            clearance: self.state.clearance,
        };
        self.step(StepKind::RoughNet(rough));
        self.moved();
    }

    /// Top of the blank.
    fn stock_top(&self) -> Option<f64> {
        self.state.stock.map(|s| match self.program.stocks[s].shape {
            StockShape::Round { .. } => 0.0,
            StockShape::Block { max, .. } => max.z,
        })
    }

    fn spacing(&mut self, m: &Matched) -> Option<Spacing> {
        if let Some(step) = m.number("step") {
            return Some(Spacing::Step(step));
        }
        let cusp = m.number("cusp").or(self.state.cusp);
        if cusp.is_none() {
            let message = "how close are the passes? There is neither a height of cusps nor a STEP";
            self.report(
                Diagnostic::new(&codes::NO_SPACING, m.word, message)
                    .help("write `CUSP, 0.01` or `STEP, 0.5` here, or `CUSP/ 0.01` above"),
            );
        }
        cusp.map(Spacing::Cusp)
    }

    /// The cutter, if its shape is known.
    fn solid(&mut self, m: &Matched, tool: Handle<Tool>) -> Option<Handle<Tool>> {
        let cutter = &self.program.tools[tool];
        if cutter.solid().is_some() {
            return Some(tool);
        }
        let (message, help) = if cutter.kind == CutterKind::Taper {
            let what = "a tapered cutter has an angle and a level bottom";
            (
                format!("the shape of {} is not known: {what}", cutter.name),
                "give its angle: `CUTTER/ TAPER, 6, 1, ANGLE, 5`",
            )
        } else {
            let does = if m.form == "levels" { "rough" } else { "finish" };
            (
                format!(
                    "{} does not {does} surfaces: its shape is none that rests on its corner",
                    cutter.name
                ),
                "ball-end, flat, bull-nose and tapered cutters do: `CUTTER/ BULL, 10, 1`",
            )
        };
        self.no_cutter(m, tool, message, help)
    }

    /// Whether passes may be arcs or curves: arcs lie in planes, and a sharp corner touches the surface leap by leap.
    fn may_bend(&mut self, m: &Matched, shape: PassShape, tool: Option<Handle<Tool>>) -> bool {
        let sharp = tool
            .map(|tool| &self.program.tools[tool])
            .filter(|cutter| cutter.solid().is_some_and(|solid| solid.corner() <= 0.0));
        let (message, help) = if shape == PassShape::Arcs && !matches!(along(m), Along::X | Along::Y) {
            (
                "passes along U and V and bent ones do not lie in planes: no arc follows them".to_owned(),
                "write `X` or `Y` for passes in planes, `NURBS` for curves in space, or `LINEAR`",
            )
        } else if let Some(cutter) = sharp {
            (
                format!("{} has a sharp corner, whose path over a surface is no smooth one", cutter.name),
                "write `LINEAR`, or take a cutter with a corner radius",
            )
        } else {
            return true;
        };
        self.report(Diagnostic::new(&planning::NO_ARCS, m.word, message).help(help));
        false
    }

    /// Whether the band has room for a path: a sharp corner has no hull inside of itself, so that `INTOL` alone gives it none.
    fn has_room(&mut self, m: &Matched, tool: Handle<Tool>, leave: f64) -> bool {
        let cutter = &self.program.tools[tool];
        let rounded = cutter.solid().is_none_or(|solid| solid.corner() + leave > 0.0);
        if rounded || self.state.band.out > 0.0 {
            return true;
        }
        let message = format!("{} has a sharp corner, and OUTTOL is 0: no path can keep that", cutter.name);
        let mut problem = Diagnostic::new(&codes::NO_TOLERANCE, m.word, message);
        if let Some(at) = self.state.band_at {
            problem = problem.label(at, "the last of INTOL and OUTTOL");
        }
        self.report(problem.help("write `OUTTOL/ 0.01`, for example, or take a cutter with a corner radius"));
        false
    }

    fn no_cutter<T>(&mut self, m: &Matched, tool: Handle<Tool>, message: String, help: &str) -> Option<T> {
        let declared = self.program.origins[self.program.tools[tool].origin].span;
        self.report(
            Diagnostic::new(&planning::NO_BALL, m.word, message).label(declared, "the cutter").help(help),
        );
        None
    }
}

fn along(m: &Matched) -> Along {
    match m.word("along") {
        Some("V") => Along::V,
        Some("X") => Along::X,
        Some("Y") => Along::Y,
        Some("ISOCSP") => Along::IsoCusp,
        Some("CONST") => Along::Const,
        _ => Along::U,
    }
}

/// The poles of the statement itself.
fn listed(m: &Matched) -> Poles {
    // Counts were checked to lie between 2 and 1000.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let whole = |name: &str| m.number(name).unwrap_or(0.0) as usize;
    let points = m.all("pole").filter_map(|f| match f.typed {
        Typed::Vector(v) => Some(Point3::new(v.v[0], v.v[1], v.v[2])),
        _ => None,
    });
    let weights: Vec<f64> = m
        .all("weight")
        .filter_map(|f| match f.typed {
            Typed::Number(w) => Some(w),
            _ => None,
        })
        .collect();
    Poles {
        rows: whole("rows"),
        columns: whole("columns"),
        points: points.collect(),
        weights: m.word("weights").map(|_| weights),
    }
}

/// Poles of a CSV text; on failure the line and what is wrong with it.
fn read_poles(text: &str, length: &dyn Fn(f64) -> Option<f64>) -> Result<Poles, (usize, String)> {
    let mut poles = Poles::default();
    let mut weights = Vec::new();
    let (mut fields, mut in_row) = (0, 0);
    for (i, line) in text.lines().enumerate().map(|(i, l)| (i + 1, l.trim())) {
        if line.starts_with('#') {
            continue;
        }
        if line.is_empty() {
            end_row(&mut poles, &mut in_row).map_err(|e| (i, e))?;
            continue;
        }
        if fields == 0 {
            let names: Vec<String> = line.split(',').map(|f| f.trim().to_ascii_lowercase()).collect();
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            fields = match names.as_slice() {
                ["x", "y", "z"] => 3,
                ["x", "y", "z", "w"] => 4,
                _ => return Err((i, "the heading is neither `x,y,z` nor `x,y,z,w`".into())),
            };
            continue;
        }
        if poles.points.len() >= limits::TABLE_ROWS {
            return Err((i, format!("the net has more than {} poles", limits::TABLE_ROWS)));
        }
        let numbers = numbers(line, fields).map_err(|e| (i, e))?;
        let at = |k: usize| numbers.get(k).copied().and_then(length).unwrap_or(0.0);
        poles.points.push(Point3::new(at(0), at(1), at(2)));
        weights.extend(numbers.get(3));
        in_row += 1;
    }
    let last = text.lines().count().max(1);
    end_row(&mut poles, &mut in_row).map_err(|e| (last, e))?;
    if poles.points.is_empty() {
        return Err((last, "the file has no poles".into()));
    }
    poles.weights = (fields == 4).then_some(weights);
    Ok(poles)
}

fn numbers(line: &str, fields: usize) -> Result<Vec<f64>, String> {
    let mut numbers = Vec::with_capacity(fields);
    for field in line.split(',').map(str::trim) {
        match field.parse::<f64>() {
            Ok(x) if x.is_finite() => numbers.push(x),
            _ => return Err(format!("`{field}` is not a number")),
        }
    }
    if numbers.len() == fields {
        return Ok(numbers);
    }
    Err(format!("there are {} numbers in place of {fields}", numbers.len()))
}

fn end_row(poles: &mut Poles, in_row: &mut usize) -> Result<(), String> {
    let length = core::mem::take(in_row);
    if length == 0 {
        return Ok(());
    }
    if poles.rows > 0 && length != poles.columns {
        return Err(format!("this row has {length} poles, those before it {}", poles.columns));
    }
    poles.rows += 1;
    poles.columns = length;
    Ok(())
}

fn unsound(issue: &NetIssue, at: Span) -> Diagnostic {
    let (message, help) = match issue {
        NetIssue::Size { rows, columns } => (
            format!("{rows} x {columns} poles are no net"),
            "up to 16 x 16 poles are one patch; more must be (3m+1) x (3n+1), for m x n bicubic patches",
        ),
        NetIssue::Count { wanted, given } => (
            format!(
                "the net wants {wanted} poles, each with its weight where there are weights, and has {given}"
            ),
            "give the poles row by row",
        ),
        NetIssue::Uneven { least, most } => {
            (uneven(*least, *most), "weights say how much a pole draws: from 0.1 to 10 is usual")
        }
        NetIssue::NotFinite => (
            "a pole or weight of the net is not a finite number, or a weight is not positive".into(),
            "correct it",
        ),
    };
    Diagnostic::new(&geometry::NET_SHAPE, at, message).help(help)
}
