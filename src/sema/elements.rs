//! Subscripted names: setting and reading elements, one or several.

use std::rc::Rc;

use crate::diag::Diagnostic;
use crate::diag::codes::semantics as codes;
use crate::source::Span;
use crate::syntax::ast::{Expr, ExprKind, Name, Target};
use crate::vocab::EntityKind;

use super::declare::what;
use super::scope::{Array, Binding, BindingKind, Element};
use super::value::Value;
use super::{Analyser, limits};

impl Analyser<'_> {
    /// Sets `name(i)`: a variable, or a declared thing of `kind`.
    pub(super) fn set_element(&mut self, target: &Target, kind: Option<EntityKind>, value: Value) {
        let Some(subscripts) = self.subscripts(&target.subscripts) else {
            return self.scope.poison(&target.name);
        };
        let name = &target.name;
        let key = name.upper();
        if self.scope.get(&key).is_none() {
            if !self.check_reserved(name) || !self.room_for_names() {
                return;
            }
            let array = BindingKind::Array(Rc::new(Array::default()));
            self.scope.set(key.clone(), Binding { kind: array, declared: name.span });
        }
        let Some(binding) = self.scope.get(&key) else { return };
        let declared = binding.declared;
        let array = match &binding.kind {
            BindingKind::Array(array) => array,
            BindingKind::Poison => return,
            other => {
                let message = format!("{} is {} and not subscripted", name.text, what(other));
                self.report(
                    Diagnostic::new(&codes::SUBSCRIPT, name.span, message).label(declared, "declared here"),
                );
                return;
            }
        };
        let (size, old) = (array.size, array.items.get(&subscripts).cloned());
        if !self.check_size(name, size, declared, &subscripts)
            || !self.may_replace(name, &subscripts, old.as_ref(), kind)
        {
            return;
        }
        if old.is_none() && self.room_for_names() {
            self.scope.count_element();
        }
        if let Some(Binding { kind: BindingKind::Array(array), .. }) = self.scope.get_mut(&key) {
            Rc::make_mut(array).items.insert(subscripts, Element { value, declared: name.span, kind });
        }
    }

    fn may_replace(
        &mut self,
        name: &Name,
        subscripts: &[i64],
        old: Option<&Element>,
        kind: Option<EntityKind>,
    ) -> bool {
        let Some(old) = old else { return true };
        if (old.kind.is_none() && kind.is_none())
            || old.declared == name.span
            || matches!(old.value, Value::Poison)
        {
            return true;
        }
        let what = old.kind.map_or("a variable", EntityKind::name);
        let message = format!("{}({}) is {what} already", name.text, shown(subscripts));
        self.report(
            Diagnostic::new(&codes::ALREADY_DECLARED, name.span, message).label(old.declared, "first here"),
        );
        false
    }

    fn check_size(&mut self, name: &Name, size: Option<i64>, declared: Span, subscripts: &[i64]) -> bool {
        let largest = size.unwrap_or(i64::MAX);
        if subscripts.first().is_none_or(|&s| s >= 1 && s <= largest) {
            return true;
        }
        let message = format!("{} has no element {}", name.text, shown(subscripts));
        let problem = Diagnostic::new(&codes::SUBSCRIPT, name.span, message);
        let problem = match size {
            Some(size) => problem.label(declared, format!("its subscripts run from 1 to {size}")),
            None => problem.note("subscripts start at 1"),
        };
        self.report(problem);
        false
    }

    /// The subscripts as whole numbers: as in APT, what is behind the point does not count.
    fn subscripts(&mut self, exprs: &[Expr]) -> Option<Vec<i64>> {
        let mut result = Vec::new();
        for expr in exprs {
            match self.evaluate(expr) {
                Value::Number(q) if q.is_bare() && q.value.abs() < 1e15 => {
                    #[allow(clippy::cast_possible_truncation)]
                    result.push((q.value + SUBSCRIPT_SLACK).floor() as i64);
                }
                Value::Poison => return None,
                Value::Word(word) => {
                    let message =
                        format!("several elements ({word}) stand only among arguments and in lists");
                    self.report(Diagnostic::new(&codes::SUBSCRIPT, expr.span, message));
                    return None;
                }
                other => {
                    let message = format!("a subscript is a pure number, not {}", other.kind_name());
                    self.report(Diagnostic::new(&codes::SUBSCRIPT, expr.span, message));
                    return None;
                }
            }
        }
        Some(result)
    }

    /// The value of `name(i)`.
    pub(super) fn element(&mut self, name: &Name, array: &Array, declared: Span, args: &[Expr]) -> Value {
        let Some(subscripts) = self.subscripts(args) else { return Value::Poison };
        if !self.check_size(name, array.size, declared, &subscripts) {
            return Value::Poison;
        }
        if let Some(element) = array.items.get(&subscripts) {
            return element.value.clone();
        }
        let message = format!("{}({}) has not been set", name.text, shown(&subscripts));
        self.report(
            Diagnostic::new(&codes::SUBSCRIPT, name.span, message).label(declared, "subscripted here"),
        );
        Value::Poison
    }

    /// The elements that `P(ALL)`, `P(2, THRU, 5)`, `P(ALL, DECR, 1)` stand for, in order; `None` when the
    /// subscripts name one element (or `name` has none).
    pub(super) fn inclusive(&mut self, name: &Name, args: &[Expr]) -> Option<Vec<Element>> {
        let words: Vec<Option<&Name>> = args.iter().map(lone_name).collect();
        let is = |i: usize, word: &str| words.get(i).copied().flatten().is_some_and(|n| n.is(word));
        if !(is(0, "ALL") || is(1, "THRU")) {
            return None;
        }
        let Some(Binding { kind: BindingKind::Array(array), declared }) = self.scope.get(&name.upper())
        else {
            return None;
        };
        let (array, declared) = (array.clone(), *declared);
        let largest = array.items.keys().filter_map(|k| k.first()).max().copied().unwrap_or(0);
        let all = is(0, "ALL");
        let step_at = if all { 1 } else { 3 };
        let step = match (is(step_at, "INCR"), is(step_at, "DECR")) {
            (false, false) if args.len() == step_at => Some(1),
            (true, _) | (_, true) if args.len() == step_at + 2 => {
                let size = self.whole_subscript(args.get(step_at + 1)?);
                size.map(|s| if is(step_at, "DECR") { -s } else { s })
            }
            _ => return Some(self.inclusive_form(name)),
        };
        let ends = if all {
            Some((1, array.size.unwrap_or(largest)))
        } else {
            let (first, last) =
                (self.whole_subscript(args.first()?), self.bound(args.get(2)?, &array, largest));
            first.zip(last)
        };
        let (Some(step), Some((first, last))) = (step, ends) else { return Some(poisoned(declared)) };
        Some(self.run_of(name, &array, declared, (first, last, step)))
    }

    /// The last subscript of `THRU`; `ALL` is the largest there is.
    fn bound(&mut self, expr: &Expr, array: &Array, largest: i64) -> Option<i64> {
        if lone_name(expr).is_some_and(|n| n.is("ALL")) {
            return Some(array.size.unwrap_or(largest));
        }
        self.whole_subscript(expr)
    }

    fn whole_subscript(&mut self, expr: &Expr) -> Option<i64> {
        self.subscripts(core::slice::from_ref(expr))?.first().copied()
    }

    fn inclusive_form(&mut self, name: &Name) -> Vec<Element> {
        let message = format!("these subscripts of {} cannot be read", name.text);
        let text = &name.text;
        self.report(Diagnostic::new(&codes::SUBSCRIPT, name.span, message).help(format!(
            "write `{text}(ALL)`, `{text}(2, THRU, 5)`, or one of them with `, INCR, 2` or `, DECR, 1`"
        )));
        poisoned(name.span)
    }

    /// The elements from `first` to `last`; a negative step takes them in the opposite order.
    fn run_of(
        &mut self,
        name: &Name,
        array: &Array,
        declared: Span,
        (first, last, step): (i64, i64, i64),
    ) -> Vec<Element> {
        if step == 0 {
            let message = format!("a step of 0 never reaches the end of {}", name.text);
            self.report(Diagnostic::new(&codes::SUBSCRIPT, name.span, message));
            return poisoned(declared);
        }
        let (from, to) = if step < 0 && first < last { (last, first) } else { (first, last) };
        let count = (to - from) / step + 1;
        if count > limits::SUBSCRIPT_RUN {
            self.limit(format!("a run of more than {} elements", limits::SUBSCRIPT_RUN));
            return poisoned(declared);
        }
        if !self.charge(usize::try_from(count).unwrap_or(0)) {
            return poisoned(declared);
        }
        let mut elements = Vec::new();
        for subscript in (0..count).map(|i| from + i * step) {
            let key = vec![subscript];
            if !self.check_size(name, array.size, declared, &key) {
                return poisoned(declared);
            }
            match array.items.get(&key) {
                Some(element) => elements.push(element.clone()),
                None => {
                    let message = format!("{}({subscript}) has not been set", name.text);
                    self.report(
                        Diagnostic::new(&codes::SUBSCRIPT, name.span, message)
                            .label(declared, "subscripted here"),
                    );
                    return poisoned(declared);
                }
            }
        }
        elements
    }
}

/// What stands for elements that failed.
fn poisoned(declared: Span) -> Vec<Element> {
    vec![Element { value: Value::Poison, declared, kind: None }]
}

/// The lone word that an expression is.
fn lone_name(expr: &Expr) -> Option<&Name> {
    match &expr.kind {
        ExprKind::Name(name) => Some(name),
        _ => None,
    }
}

/// A subscript this little below a whole number is that number.
const SUBSCRIPT_SLACK: f64 = 1e-9;

fn shown(subscripts: &[i64]) -> String {
    subscripts.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}
