//! What templates can read.

use minijinja::value::{Serde, Value};
use serde::Serialize;

use super::events::Events;
use crate::ir::{CutterKind, Spindle, Tool};
use crate::math;
use crate::target::BlockKind;
use crate::target::number;
use crate::units::LengthUnit;

/// Decimals of a cutter's angles, degrees.
const ANGLE_DECIMALS: u8 = 4;

/// What every template can read.
#[derive(Serialize)]
pub(super) struct Context<'a> {
    post: PostContext<'a>,
    program: ProgramContext,
    tools: Value,
    rotary: Option<String>,
    safe_start: String,
    options: &'a std::collections::BTreeMap<String, String>,
    /// Whether the spindle turns.
    spindle_on: bool,
    /// Whether coolant flows.
    coolant_on: bool,
    /// The tool being changed to, in tool-change blocks.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tool: Option<ToolContext>,
    /// Whether it is the first tool of the program.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub first: Option<bool>,
    /// The spindle command that follows the tool change: `rpm` and `code`; `rpm` is 0 when there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spindle: Option<SpindleContext>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub operation: Option<OperationContext>,
    /// The drilling cycle, in its templates.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cycle: Option<CycleContext>,
}

/// A drilling cycle; numbers as the control's words spell them, empty where the cycle has none.
#[derive(Serialize)]
pub(super) struct CycleContext {
    pub kind: &'static str,
    /// Levels, in the spelling of the word `z`.
    pub z: String,
    pub r: String,
    pub surface: String,
    pub initial: String,
    pub after: String,
    /// Distances, in the spelling of the word `z` without its sign.
    pub depth: String,
    pub clearance: String,
    pub above: String,
    pub peck: String,
    /// Number of equal pecks.
    pub pecks: String,
    pub shift: String,
    pub pitch: String,
    /// In the unit of `cycle-dwell`.
    pub dwell: String,
    pub feed: String,
    /// `clearance` or `initial`.
    pub retract: &'static str,
    pub rpm: i64,
}

#[derive(Serialize)]
struct PostContext<'a> {
    name: &'a str,
    title: &'a str,
}

#[derive(Serialize)]
struct ProgramContext {
    /// Cleaned for comments; empty when there is none.
    title: String,
    /// Letters and digits only.
    name: String,
    number: u32,
    units: &'static str,
}

#[derive(Serialize, Clone, Default)]
pub(super) struct ToolContext {
    number: u32,
    name: String,
    kind: &'static str,
    diameter: String,
    corner: String,
    cutter: String,
    tip: String,
    taper: String,
    height: String,
    text: String,
    words: String,
}

#[derive(Serialize)]
pub(super) struct SpindleContext {
    pub rpm: i64,
    pub code: String,
}

#[derive(Serialize)]
pub(super) struct OperationContext {
    pub name: String,
    /// Whether it is the first of the program.
    pub first: bool,
    /// The tool in the spindle.
    pub tool: ToolContext,
}

impl<'a> Events<'a> {
    pub(super) fn context(&self) -> Context<'a> {
        let dialect = self.writer.dialect;
        Context {
            post: PostContext { name: &dialect.name, title: &dialect.spec.post.title },
            program: self.program_context(),
            tools: self.tools(),
            rotary: self.program.capabilities.rotary.map(|r| r.letter.to_string()),
            safe_start: self.safe_start(),
            options: &self.program.capabilities.options,
            spindle_on: self.spindle_on,
            coolant_on: self.coolant_on,
            tool: None,
            first: None,
            spindle: None,
            operation: None,
            cycle: None,
        }
    }

    /// All tools. They stay the same, and a program may have thousands of changes.
    fn tools(&self) -> Value {
        let list = || {
            let tools: Vec<ToolContext> =
                self.program.tools.iter().map(|tool| self.tool_context(tool)).collect();
            Value::from(Serde(tools))
        };
        self.tools.get_or_init(list).clone()
    }

    fn program_context(&self) -> ProgramContext {
        let spec = &self.writer.dialect.spec;
        let title = self.program.title.as_deref().unwrap_or_default();
        let name: String = title
            .chars()
            .filter(char::is_ascii_alphanumeric)
            .take(spec.file.name_max)
            .collect::<String>()
            .to_uppercase();
        ProgramContext {
            title: spec.comments.clean(title),
            name: if name.is_empty() { "PART".into() } else { name },
            number: spec.file.number,
            units: match self.unit() {
                LengthUnit::Millimetre => "mm",
                LengthUnit::Inch => "inch",
            },
        }
    }

    pub(super) fn tool_context(&self, tool: &Tool) -> ToolContext {
        let grid = &self.program.capabilities.grid;
        let length = |mm: f64| {
            number::steps(mm / grid.unit.in_mm(), grid.linear_decimals)
                .map_or_else(String::new, |s| number::plain(s, grid.linear_decimals))
        };
        let kind = match tool.kind {
            CutterKind::Flat => "flat",
            CutterKind::Ball => "ball",
            CutterKind::Bull => "bull",
            CutterKind::Taper => "taper",
            CutterKind::Drill => "drill",
        };
        let number = tool.number.unwrap_or(0);
        let name = self.writer.dialect.spec.comments.clean(&tool.name);
        let called = format!("T{number}");
        let label = if name.eq_ignore_ascii_case(&called) { called } else { format!("{called} {name}") };
        // A CL file may say nothing of its cutters.
        let text =
            if tool.diameter > 0.0 { format!("{label}, {kind}, D={}", length(tool.diameter)) } else { label };
        let degrees = |radians: f64| {
            number::steps(radians / math::DEG, ANGLE_DECIMALS)
                .map_or_else(String::new, |s| number::plain(s, ANGLE_DECIMALS))
        };
        let [e, f, tip, taper, height] = tool.profile;
        let (diameter, corner) = (length(tool.diameter), length(tool.corner));
        // The numbers that diameter and corner say already are left out.
        let plain = [e, f] == [tool.diameter / 2.0 - tool.corner, tool.corner] || [e, f] == [0.0; 2];
        let cutter = if plain && [tip, taper, height] == [0.0; 3] {
            format!("{diameter}, {corner}")
        } else {
            let shape = [length(e), length(f), degrees(tip), degrees(taper), length(height)];
            format!("{diameter}, {corner}, {}", shape.join(", "))
        };
        let tip = if kind == "drill" && tip > 0.0 { math::PI - 2.0 * tip } else { tip };
        let (tip, taper, height) = (degrees(tip), degrees(taper), length(height));
        let words = tool.words.clone();
        ToolContext { number, name, kind, diameter, corner, cutter, tip, taper, height, text, words }
    }

    fn safe_start(&self) -> String {
        let spec = &self.writer.dialect.spec;
        let separator = &spec.line.separator;
        let lines: Vec<String> = spec
            .safe_start
            .iter()
            .map(|line| {
                let options = &self.program.capabilities.options;
                let groups = line.iter().filter_map(|g| spec.groups.get(g));
                // An option that counts too far has been refused with the capabilities.
                let starts = groups.filter_map(|g| g.chosen(self.unit(), options));
                let codes: Vec<String> = starts.filter(|code| !code.is_empty()).collect();
                codes.join(separator)
            })
            .collect();
        lines.join("\n")
    }

    /// The spindle command before the next tool change.
    pub(super) fn spindle_after(&self, index: usize) -> SpindleContext {
        let rest = self.program.blocks.get(index + 1..).unwrap_or_default();
        let found = rest
            .iter()
            .take_while(|b| !matches!(b.kind, BlockKind::ToolChange(_) | BlockKind::Motion(_)))
            .find_map(|b| if let BlockKind::Spindle(spindle) = b.kind { Some(spindle) } else { None });
        match found {
            Some(Spindle::On { rpm, clockwise, .. }) => {
                let code = self.spindle_code(clockwise).to_owned();
                SpindleContext { rpm: number::steps(rpm, 0).unwrap_or(0), code }
            }
            _ => SpindleContext { rpm: 0, code: String::new() },
        }
    }
}
