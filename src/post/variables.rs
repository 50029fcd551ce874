//! The variables of templates: one table for checking post files and for their documentation.

/// A variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Variable {
    /// Its name, with a point where it is a member.
    pub name: &'static str,
    /// Which templates have it.
    pub scope: Scope,
}

/// Where a variable exists.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    /// In all templates.
    Everywhere,
    /// In the blocks of a tool change and `with-first-z`.
    ToolChange,
    /// In the template at the start of an operation.
    Operation,
}

/// All variables but the members of `options`, which a post names itself.
pub const VARIABLES: &[Variable] = &[
    everywhere("post"),
    everywhere("post.name"),
    everywhere("post.title"),
    everywhere("program"),
    everywhere("program.title"),
    everywhere("program.name"),
    everywhere("program.number"),
    everywhere("program.units"),
    everywhere("tools"),
    everywhere("rotary"),
    everywhere("safe_start"),
    everywhere("options"),
    everywhere("spindle_on"),
    everywhere("coolant_on"),
    tool_change("tool"),
    tool_change("tool.number"),
    tool_change("tool.name"),
    tool_change("tool.kind"),
    tool_change("tool.diameter"),
    tool_change("tool.corner"),
    tool_change("tool.text"),
    tool_change("first"),
    tool_change("spindle"),
    tool_change("spindle.rpm"),
    tool_change("spindle.code"),
    Variable { name: "operation", scope: Scope::Operation },
    Variable { name: "operation.name", scope: Scope::Operation },
];

const fn everywhere(name: &'static str) -> Variable {
    Variable { name, scope: Scope::Everywhere }
}

const fn tool_change(name: &'static str) -> Variable {
    Variable { name, scope: Scope::ToolChange }
}

/// The variables of templates with this scope.
pub fn of(scope: Scope) -> impl Iterator<Item = &'static str> {
    VARIABLES.iter().filter(move |v| v.scope == Scope::Everywhere || v.scope == scope).map(|v| v.name)
}
