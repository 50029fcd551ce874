//! Names and what they stand for.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::blocks::Code;
use super::value::Value;
use crate::source::Span;
use crate::syntax::ast;
use crate::vocab::EntityKind;

/// What a name stands for.
#[derive(Debug, Clone)]
pub struct Binding {
    /// What.
    pub kind: BindingKind,
    /// Where it was declared or first set.
    pub declared: Span,
}

/// Kinds of names.
#[derive(Debug, Clone)]
pub enum BindingKind {
    /// A variable; it may be set again.
    Variable(Value),
    /// A `PARAM`.
    Parameter(Value),
    /// A declared thing.
    Entity(EntityKind, Value),
    /// A subscripted name.
    Array(Rc<Array>),
    /// A macro.
    Macro(Rc<MacroDefinition>),
    /// Its declaration failed.
    Poison,
}

/// A subscripted name.
#[derive(Debug, Clone, Default)]
pub struct Array {
    /// Largest subscript, from `RESERV`.
    pub size: Option<i64>,
    /// The elements that have been set: value, where, and whether it is a declared thing.
    pub items: BTreeMap<Vec<i64>, Element>,
}

/// An element of a subscripted name.
#[derive(Debug, Clone)]
pub struct Element {
    /// Its value.
    pub value: Value,
    /// Where it was declared or first set.
    pub declared: Span,
    /// What was declared; `None` for a variable.
    pub kind: Option<EntityKind>,
}

/// A macro.
#[derive(Debug)]
pub struct MacroDefinition {
    /// Its name as declared.
    pub name: Rc<str>,
    /// Where.
    pub span: Span,
    /// Parameters.
    pub parameters: Vec<ast::Parameter>,
    /// The file its body lies in.
    pub code: Rc<Code>,
    /// Statements of its body.
    pub body: core::ops::Range<usize>,
}

/// All names: one global space, and the parameters of the macros being carried out.
#[derive(Debug, Default)]
pub struct Scope {
    globals: BTreeMap<String, Binding>,
    /// Parameters of each call, innermost last.
    frames: Vec<BTreeMap<String, Binding>>,
    elements: usize,
}

impl Scope {
    /// What `name` (upper case) stands for.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Binding> {
        self.frames.last().and_then(|f| f.get(name)).or_else(|| self.globals.get(name))
    }
    /// The binding to change.
    pub fn get_mut(&mut self, name: &str) -> Option<&mut Binding> {
        if let Some(frame) = self.frames.last_mut()
            && frame.contains_key(name)
        {
            return frame.get_mut(name);
        }
        self.globals.get_mut(name)
    }
    /// Sets a global name.
    pub fn set(&mut self, name: String, binding: Binding) {
        self.globals.insert(name, binding);
    }
    /// Sets `name` to poison unless it stands for something.
    pub fn poison(&mut self, name: &ast::Name) {
        let key = name.upper();
        if self.get(&key).is_none() {
            self.set(key, Binding { kind: BindingKind::Poison, declared: name.span });
        }
    }
    /// Starts a call with these parameters.
    pub fn enter(&mut self, parameters: BTreeMap<String, Binding>) {
        self.frames.push(parameters);
    }
    /// Ends the innermost call.
    pub fn leave(&mut self) {
        self.frames.pop();
    }
    /// Every name in reach, for «did you mean».
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.frames.last().into_iter().flat_map(BTreeMap::keys).chain(self.globals.keys()).map(String::as_str)
    }
    /// Names and elements in all.
    #[must_use]
    pub fn len(&self) -> usize {
        self.globals.len() + self.elements
    }
    /// Counts a new element of a subscripted name.
    pub fn count_element(&mut self) {
        self.elements += 1;
    }
}
