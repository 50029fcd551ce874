//! The variables of templates: one table that checking, «did you mean» and the documentation read.

/// Which templates can read a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    /// All of them; header and footer read nothing else.
    Everywhere,
    /// Start of an operation.
    Operation,
    /// Blocks of a tool change.
    ToolChange,
    /// Drilling cycles.
    Cycle,
}

/// A variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Variable {
    /// Dotted name.
    pub name: &'static str,
    /// Where it can be read.
    pub scope: Scope,
    /// What it is.
    pub doc: &'static str,
}

const fn row(scope: Scope, name: &'static str, doc: &'static str) -> Variable {
    Variable { name, scope, doc }
}

use Scope::{Cycle, Everywhere, Operation, ToolChange};

/// All variables; `options.NAME` besides, for every name in `[options]`.
pub const VARIABLES: &[Variable] = &[
    row(Everywhere, "post.name", "name of the post"),
    row(Everywhere, "post.title", "`post.title`"),
    row(Everywhere, "program.title", "`PARTNO`, made harmless for comments; empty when there is none"),
    row(
        Everywhere,
        "program.name",
        "its letters and digits, upper case, at most `file.name-max`; `PART` without any",
    ),
    row(Everywhere, "program.number", "`file.number`"),
    row(Everywhere, "program.units", "`mm` or `inch`"),
    row(Everywhere, "tools", "all tools, each as `tool` in tool changes"),
    row(Everywhere, "rotary", "letter of the rotary axis, or none"),
    row(Everywhere, "safe_start", "start codes of all groups in `safe-start`, line by line"),
    row(Everywhere, "spindle_on", "whether the spindle turns here"),
    row(Everywhere, "coolant_on", "whether coolant flows here"),
    row(Operation, "operation.name", "name of the operation, made harmless for comments"),
    row(Operation, "operation.first", "whether it is the first of the program"),
    row(Operation, "operation.tool", "the tool in the spindle, as `tool` in tool changes"),
    row(ToolChange, "tool.number", "number of the tool, 0 without one"),
    row(ToolChange, "tool.name", "name of the tool, made harmless for comments"),
    row(ToolChange, "tool.kind", "`flat`, `ball`, `bull`, `taper` or `drill`"),
    row(ToolChange, "tool.diameter", "diameter in the program's unit"),
    row(ToolChange, "tool.corner", "corner radius in the program's unit"),
    row(
        ToolChange,
        "tool.cutter",
        "the numbers of `CUTTER/`: diameter and corner, all seven where they say more",
    ),
    row(
        ToolChange,
        "tool.tip",
        "angle of the bottom against the level in degrees; of a drill, its point angle; 0 where that is not known",
    ),
    row(ToolChange, "tool.taper", "angle of the side against the axis, degrees"),
    row(
        ToolChange,
        "tool.words",
        "what a CL file says of its change besides the number: `ADJUST, 4, LENGTH, 120`",
    ),
    row(ToolChange, "tool.height", "height of the cutter in the program's unit, 0 where that is not known"),
    row(ToolChange, "tool.text", "number, name, kind and diameter in one line"),
    row(ToolChange, "first", "whether it is the first tool of the program"),
    row(ToolChange, "spindle.rpm", "speed of the spindle command that follows, 0 without one"),
    row(ToolChange, "spindle.code", "its code, empty without one"),
    row(Cycle, "cycle.kind", "kind of the cycle: `drill`, `deep` …"),
    row(Cycle, "cycle.z", "bottom of the hole"),
    row(Cycle, "cycle.r", "clearance level"),
    row(Cycle, "cycle.surface", "surface that depth and clearance count from"),
    row(Cycle, "cycle.initial", "height at which the cycle begins"),
    row(
        Cycle,
        "cycle.after",
        "height to which the tool goes after each hole: that of `cycle.r` or `cycle.initial`",
    ),
    row(Cycle, "cycle.depth", "surface to bottom, positive"),
    row(Cycle, "cycle.clearance", "surface to clearance level"),
    row(Cycle, "cycle.above", "surface to the height at which the cycle begins"),
    row(Cycle, "cycle.peck", "largest depth of one peck; empty without one"),
    row(
        Cycle,
        "cycle.pecks",
        "number of equal pecks from `cycle.r` to `cycle.z`, none deeper than `cycle.peck`; empty without one",
    ),
    row(Cycle, "cycle.shift", "move off the wall of an oriented boring cycle; empty in others"),
    row(Cycle, "cycle.pitch", "pitch of a thread; empty in other cycles"),
    row(Cycle, "cycle.dwell", "dwell at the bottom, in the unit of `[cycle-dwell]`; empty without one"),
    row(Cycle, "cycle.feed", "feed into the hole, as the feed word spells it"),
    row(Cycle, "cycle.retract", "`clearance` or `initial`"),
    row(Cycle, "cycle.rpm", "speed of the spindle"),
];

/// The variables of templates with this scope, and the tables that hold them.
pub fn of(scope: Scope) -> impl Iterator<Item = &'static str> {
    let known = VARIABLES.iter().filter(move |v| v.scope == Scope::Everywhere || v.scope == scope);
    known.map(|v| v.name).chain(["options"])
}

/// Whether a name is a variable of this scope, or a table of some.
#[must_use]
pub fn is_known(name: &str, scope: Scope) -> bool {
    let table = |known: &str| known.strip_prefix(name).is_some_and(|rest| rest.starts_with('.'));
    // A tool in a table of tools has the members of a tool.
    let of_tool = |name: &str| {
        let member = name.strip_prefix("operation.tool.").filter(|_| scope == Scope::Operation);
        member.is_some_and(|m| VARIABLES.iter().any(|v| v.name.strip_prefix("tool.") == Some(m)))
    };
    of(scope).any(|known| known == name || table(known)) || of_tool(name)
}
