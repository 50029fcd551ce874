//! The evaluated program as text, for `--emit ir` and snapshots.
//!
//! One line a node. Lengths are mm and angles degrees, whatever the program's unit is; numbers have the fewest
//! digits that read back to the same value after removal of the last-bit noise of unit conversion.

use core::fmt::Write as _;

use super::{
    Along, CamEntity, Coolant, CurveEntity, Cut, CutterKind, Entry, Feed, Flank, Interpolation, Machine,
    NetEntity, Origin, PassShape, Profile, ProfileTarget, Program, RoughCam, RoughNet, Spacing, Spindle,
    StepKind, Stock, StockShape, Surface, Tool,
};
use crate::arena::Handle;
use crate::geom::cam::Rotation;
use crate::geom::curve::{ends, spans};
use crate::geom::follower::{ArmSide, Follower};
use crate::geom::{Point2, Point3, Side, measure};
use crate::source::SourceMap;
use crate::units::{LengthUnit, tidy};

/// Accuracy of the lengths that are printed for curves, mm.
const LENGTH_ACCURACY: f64 = 1e-9;

/// The whole program.
#[must_use]
pub fn print(program: &Program, sources: &SourceMap) -> String {
    let mut printer = Printer { program, sources, text: String::new() };
    printer.program();
    printer.text
}

struct Printer<'a> {
    program: &'a Program,
    sources: &'a SourceMap,
    text: String,
}

impl Printer<'_> {
    fn line(&mut self, origin: Option<Handle<Origin>>, text: &str) {
        let place = origin.map_or_else(String::new, |o| self.place(o));
        // Writing to a string does not fail.
        let _ = writeln!(self.text, "{text}{place}");
    }

    /// `  @ file:line`, with the lines of the calls that led there.
    fn place(&self, origin: Handle<Origin>) -> String {
        let origin = &self.program.origins[origin];
        let line = |span: crate::source::Span| {
            let file = self.sources.file(span.file);
            format!("{}:{}", file.name, file.line_column(span.start).0)
        };
        let calls: String = origin.calls.iter().rev().map(|&c| format!(" < {}", line(c))).collect();
        format!("  @ {}{calls}", line(origin.span))
    }

    fn program(&mut self) {
        let program = self.program;
        if let Some(title) = &program.title {
            self.line(None, &format!("title {title}"));
        }
        let unit = if program.units == LengthUnit::Inch { "inch" } else { "mm" };
        self.line(None, &format!("units {unit}"));
        for machine in &program.machines {
            self.line(Some(machine.origin), &machine_text(machine));
        }
        for (handle, tool) in program.tools.iter() {
            self.line(Some(tool.origin), &format!("tool {handle:?} {}", tool_text(tool)));
        }
        for (handle, stock) in program.stocks.iter() {
            self.line(Some(stock.origin), &format!("stock {handle:?} {}", stock_text(stock)));
        }
        for (handle, curve) in program.curves.iter() {
            self.line(Some(curve.origin), &format!("curve {handle:?} {}", curve_text(curve)));
        }
        for (handle, net) in program.nets.iter() {
            self.line(Some(net.origin), &format!("net {handle:?} {}", net_text(net)));
        }
        for (handle, cam) in program.cams.iter() {
            self.cam(handle, cam);
        }
        for step in &program.steps {
            let text = step_text(&step.kind);
            self.line(Some(step.origin), &format!("step {text}"));
        }
    }

    fn cam(&mut self, handle: Handle<CamEntity>, entity: &CamEntity) {
        let definition = entity.cam.definition();
        let rotation = if definition.rotation == Rotation::Clockwise { "clw" } else { "cclw" };
        let groove = if definition.groove { " groove" } else { "" };
        let speed = definition.speed.map_or_else(String::new, |s| format!(" speed {}", num(s)));
        self.line(
            Some(entity.origin),
            &format!(
                "cam {handle:?} {} base {} {rotation}{groove}{speed} maxpa {}",
                entity.name,
                num(definition.base),
                num(definition.max_pressure_angle.deg())
            ),
        );
        self.line(None, &format!("  follower {}", follower_text(&definition.follower)));
        for window in definition.motion.breaks().windows(2) {
            let (a, b) = (window[0], window[1]);
            let span = definition.motion.span_of(0.5 * (a + b));
            let (from, to) = (definition.motion.at_in(span, a), definition.motion.at_in(span, b));
            let kind = if definition.motion.is_dwell(span) { "dwell" } else { "move" };
            self.line(
                None,
                &format!(
                    "  {kind} {} to {}: lift {} to {}",
                    num(a.to_degrees()),
                    num(b.to_degrees()),
                    lift(&definition.follower, from.s),
                    lift(&definition.follower, to.s)
                ),
            );
        }
    }
}

/// A number without conversion noise.
fn num(value: f64) -> String {
    let value = tidy(value);
    if value == 0.0 { "0".into() } else { format!("{value}") }
}

fn lift(follower: &Follower, value: f64) -> String {
    // Twelve digits: laws leave the last bits to rounding at a segment's end.
    let shown = if follower.oscillates() { value.to_degrees() } else { value };
    let rounded = (shown * 1e9).round() / 1e9;
    num(rounded)
}

fn point(p: &Point3) -> String {
    format!("({}, {}, {})", num(p.x), num(p.y), num(p.z))
}

fn point2(p: Point2) -> String {
    let round = |v: f64| num((v * 1e9).round() / 1e9);
    format!("({}, {})", round(p.x), round(p.y))
}

fn machine_text(machine: &Machine) -> String {
    let mut text = format!("machine {}", machine.post);
    if let Some(rotary) = machine.rotary {
        let letter = rotary.letter.map_or_else(|| "default".into(), |c| c.to_string());
        let sense = if rotary.reversed { " reversed" } else { "" };
        text.push_str(&format!(" rotary {letter}{sense}"));
    }
    for (key, value) in &machine.options {
        match value {
            Some(value) => text.push_str(&format!(" {key}={value}")),
            None => text.push_str(&format!(" {key}")),
        }
    }
    text
}

fn tool_text(tool: &Tool) -> String {
    let kind = match tool.kind {
        CutterKind::Flat => "flat",
        CutterKind::Ball => "ball",
        CutterKind::Bull => "bull",
        CutterKind::Taper => "taper",
        CutterKind::Drill => "drill",
    };
    let [e, f, a, b, h] = tool.profile;
    let mut text = format!(
        "{} {kind} d {} r {} e {} f {} a {} b {} h {}",
        tool.name,
        num(tool.diameter),
        num(tool.corner),
        num(e),
        num(f),
        num(a.to_degrees()),
        num(b.to_degrees()),
        num(h)
    );
    let numbers = [
        ("number", tool.number.map(f64::from)),
        ("flutes", tool.flutes.map(f64::from)),
        ("helix", tool.helix.map(|a| a.deg())),
        ("length", tool.length),
        ("stick-out", tool.stick_out),
    ];
    for (name, value) in numbers {
        if let Some(value) = value {
            text.push_str(&format!(" {name} {}", num(value)));
        }
    }
    if let Some(material) = &tool.material {
        text.push_str(&format!(" material {material}"));
    }
    text
}

fn stock_text(stock: &Stock) -> String {
    match &stock.shape {
        StockShape::Round { radius, height } => {
            let height = height.map_or_else(String::new, |h| format!(" height {}", num(h)));
            format!("{} round radius {}{height}", stock.name, num(*radius))
        }
        StockShape::Block { min, max } => format!("{} block {} to {}", stock.name, point(min), point(max)),
    }
}

fn curve_text(entity: &CurveEntity) -> String {
    let curve = entity.curve.as_ref();
    let (from, to) = ends(curve);
    let closed = if curve.is_closed() { " closed" } else { "" };
    let length = measure::length(curve, LENGTH_ACCURACY);
    let name = if entity.name.is_empty() { "(unnamed)" } else { &entity.name };
    format!(
        "{name} {} spans from {} to {} length {}{closed}",
        spans(curve).count(),
        point2(from),
        point2(to),
        num((length * 1e6).round() / 1e6)
    )
}

fn follower_text(follower: &Follower) -> String {
    let side = |side: &ArmSide| if *side == ArmSide::Left { "left" } else { "right" };
    match follower {
        Follower::TranslatingRoller { radius, offset } => {
            format!("translating roller radius {} offset {}", num(*radius), num(*offset))
        }
        Follower::TranslatingFlat { offset } => format!("translating flat offset {}", num(*offset)),
        Follower::OscillatingRoller { radius, arm, pivot, side: s } => {
            format!(
                "oscillating roller radius {} arm {} pivot {} {}",
                num(*radius),
                num(*arm),
                num(*pivot),
                side(s)
            )
        }
        Follower::OscillatingFlat { pivot, offset, side: s } => {
            format!("oscillating flat pivot {} offset {} {}", num(*pivot), num(*offset), side(s))
        }
    }
}

fn step_text(kind: &StepKind) -> String {
    match kind {
        StepKind::BeginCycle(asked) => cycle(asked),
        StepKind::Hole(p) => format!("hole {} {} {}", num(p.x), num(p.y), num(p.z)),
        StepKind::EndCycle => "cycle off".into(),
        StepKind::LoadTool(tool) => format!("load tool {tool:?}"),
        StepKind::Spindle(Spindle::Off) => "spindle off".into(),
        StepKind::Spindle(Spindle::On { rpm, clockwise, .. }) => {
            format!("spindle {} rpm {}", num(*rpm), if *clockwise { "clw" } else { "cclw" })
        }
        StepKind::Feed(Feed::PerMinute(f)) => format!("feed {} mm/min", num(*f)),
        StepKind::Feed(Feed::PerRevolution(f)) => format!("feed {} mm/rev", num(*f)),
        StepKind::Feed(Feed::PerTooth(f)) => format!("feed {} mm/tooth", num(*f)),
        StepKind::Coolant(coolant) => match coolant {
            Coolant::Off => "coolant off".into(),
            Coolant::Flood => "coolant flood".into(),
            Coolant::Mist => "coolant mist".into(),
            Coolant::Through { .. } => "coolant through the tool".into(),
        },
        StepKind::Compensation(None) => "compensation off".into(),
        StepKind::Compensation(Some(on)) => format!("compensation {on}"),
        StepKind::Dwell(seconds) => format!("dwell {} s", num(*seconds)),
        StepKind::Stop => "stop".into(),
        StepKind::OptionalStop => "optional stop".into(),
        StepKind::Comment(text) => format!("comment {text}"),
        StepKind::Insert(text) => format!("insert {text}"),
        StepKind::From(p) => format!("from {}", point(p)),
        StepKind::Goto { to, rapid } => format!("{} {}", if *rapid { "rapid" } else { "goto" }, point(to)),
        StepKind::Profile(profile) => profile_text(profile),
        StepKind::RoughCam(rough) => rough_text(rough),
        StepKind::Surface(surface) => surface_text(surface),
        StepKind::RoughNet(rough) => rough_net_text(rough),
    }
}

fn named(name: Option<&String>) -> String {
    name.map_or_else(String::new, |n| format!(" {n}"))
}

fn net_text(net: &NetEntity) -> String {
    let [rows, columns] = net.net.size();
    let mut text = format!("{} {rows} x {columns} patches", net.name);
    for patch in net.net.patches() {
        let [m, n] = patch.degree();
        let rational = if patch.is_rational() { " rational" } else { "" };
        let _ = write!(text, "; degree {m} {n}{rational}");
        for k in 0..(m + 1) * (n + 1) {
            let (i, j) = (k / (n + 1), k % (n + 1));
            let _ = write!(text, " {}", point(&patch.pole(i, j)));
            if patch.is_rational() {
                let _ = write!(text, "*{}", num(patch.weight(i, j)));
            }
        }
    }
    text
}

fn surface_text(surface: &Surface) -> String {
    let along = match surface.along {
        Along::U => "u",
        Along::V => "v",
        Along::X => "x",
        Along::Y => "y",
        Along::IsoCusp => "isocusp",
        Along::Const => "const",
    };
    let shape = match surface.shape {
        PassShape::Lines => "",
        PassShape::Arcs => " arcs",
        PassShape::Curves => " curves",
    };
    let spacing = match surface.spacing {
        Spacing::Cusp(h) => format!("cusp {}", num(h)),
        Spacing::Step(s) => format!("step {}", num(s)),
    };
    format!(
        "{}{} {:?} {} {along}{shape} {spacing} {} tool {:?} leave {} intol {} outtol {} clearance {}",
        if surface.rough { "rough surface" } else { "surface" },
        named(surface.name.as_ref()),
        surface.net,
        if surface.zigzag { "zigzag" } else { "oneway" },
        if surface.avoid { "avoid" } else { "check" },
        surface.tool,
        num(surface.leave),
        num(surface.band.into),
        num(surface.band.out),
        num(surface.clearance)
    )
}

fn rough_net_text(rough: &RoughNet) -> String {
    format!(
        "rough levels{} {:?} {:?} step {} width {} leave {} ramp {} {} tool {:?} intol {} outtol {} clearance {}",
        named(rough.name.as_ref()),
        rough.net,
        rough.stock,
        num(rough.step),
        num(rough.width),
        num(rough.leave),
        num(rough.ramp),
        cut_text(rough.cut),
        rough.tool,
        num(rough.band.into),
        num(rough.band.out),
        num(rough.clearance)
    )
}

const fn cut_text(cut: Cut) -> &'static str {
    match cut {
        Cut::Climb => "climb",
        Cut::Conventional => "conventional",
    }
}

fn profile_text(profile: &Profile) -> String {
    let target = match &profile.target {
        ProfileTarget::Cam(cam, Flank::Inner) => format!("cam {cam:?} inner"),
        ProfileTarget::Cam(cam, Flank::Outer) => format!("cam {cam:?} outer"),
        ProfileTarget::Curve { edges, cutter } => {
            let edges: Vec<String> = edges
                .iter()
                .map(|(h, reversed)| format!("{}{h:?}", if *reversed { "-" } else { "" }))
                .collect();
            let side = match cutter {
                Some(Side::Left) => "left",
                Some(Side::Right) => "right",
                None => "on",
            };
            format!("curves {} {side}", edges.join(" "))
        }
    };
    let interpolation = match profile.interpolation {
        Interpolation::Linear => "linear",
        Interpolation::Circular => "circular",
        Interpolation::RTheta => "r-theta",
        Interpolation::Nurbs => "nurbs",
        Interpolation::Auto => "auto",
    };
    let sized = |name: &str, size: Option<f64>| match size {
        Some(size) => format!("{name} {}", num(size)),
        None => name.to_owned(),
    };
    let entry = match profile.entry {
        Entry::TangentArc(size) => sized("tangent-arc", size),
        Entry::TangentLine(size) => sized("tangent-line", size),
        Entry::Plunge => "plunge".into(),
    };
    format!(
        "profile{} {target} {interpolation}{} {} tool {:?} depth {}{} leave {} entry {entry} band -{} +{} clearance {}",
        named(profile.name.as_ref()),
        if profile.exact_dwells { " exact-dwells" } else { "" },
        cut_text(profile.cut),
        profile.tool,
        num(profile.depth),
        profile.step.map_or_else(String::new, |s| format!(" step {}", num(s))),
        num(profile.leave),
        num(profile.band.into),
        num(profile.band.out),
        num(profile.clearance)
    )
}

fn rough_text(rough: &RoughCam) -> String {
    format!(
        "rough{} cam {:?} stock {:?} {} tool {:?} radial {} leave {} depth {}{} band -{} +{} clearance {}",
        named(rough.name.as_ref()),
        rough.cam,
        rough.stock,
        cut_text(rough.cut),
        rough.tool,
        num(rough.radial_step),
        num(rough.leave),
        num(rough.depth),
        rough.axial_step.map_or_else(String::new, |s| format!(" axial {}", num(s))),
        num(rough.band.into),
        num(rough.band.out),
        num(rough.clearance)
    )
}

fn cycle(asked: &crate::ir::DrillCycle) -> String {
    let c = &asked.cycle;
    let mut text =
        format!("cycle {} depth {} clearance {}", c.kind.name().text(), num(c.depth), num(c.clearance));
    for (name, value) in [("return", asked.return_to), ("peck", c.peck), ("dwell", c.dwell)] {
        if let Some(value) = value {
            text += &format!(" {name} {}", num(value));
        }
    }
    if let super::CycleKind::Tap { pitch, left } = c.kind {
        text += &format!(" pitch {}{}", num(pitch), if left { " left" } else { "" });
    }
    match (asked.own_feed, c.feed) {
        (true, Feed::PerMinute(f)) => text + &format!(" feed {} mm/min", num(f)),
        (true, Feed::PerRevolution(f)) => text + &format!(" feed {} mm/rev", num(f)),
        _ => text,
    }
}
