//! Carrying out statements: order, conditions, loops, jumps.

use core::ops::Range;
use std::rc::Rc;

use crate::diag::codes::semantics as codes;
use crate::diag::{Diagnostic, did_you_mean};
use crate::source::Span;
use crate::syntax::ast::{Expr, Name, Statement, StatementKind};
use crate::units::{Quantity, number};

use super::blocks::{Code, Link};
use super::scope::{Binding, BindingKind};
use super::value::Value;
use super::{Analyser, End, limits};

/// A counting loop that is being carried out.
struct Count {
    variable: Name,
    from: Quantity,
    step: f64,
    passes: u64,
}

/// A loop that is being carried out.
struct Loop {
    start: usize,
    end: usize,
    done: u64,
    /// Repetitions of mistakes before it.
    repeats: u64,
    count: Option<Count>,
}

/// Slack in the number of passes of a counting loop: `DO/ X = 0, 1, 0.1` has eleven.
const COUNT_SLACK: f64 = 1e-9;

impl Analyser<'_> {
    /// Carries out the statements `range` of `code`.
    pub(super) fn run(&mut self, code: &Rc<Code>, range: Range<usize>) {
        let mut loops: Vec<Loop> = Vec::new();
        let mut at = range.start;
        while at < range.end && self.ended.is_none() {
            let Some(statement) = code.program.statements.get(at) else { return };
            if !self.count_statement(statement.span) {
                return;
            }
            at = self.statement(code, statement, at, &mut loops).unwrap_or(at + 1);
        }
        if self.ended == Some(End::Fini) {
            self.after_fini(code, at, range.end);
        }
    }

    fn count_statement(&mut self, span: Span) -> bool {
        self.here = span;
        self.executed += 1;
        if self.report.repeats() > limits::REPEATS {
            self.limit(format!("the mistakes above have come again more than {} times", limits::REPEATS));
            return false;
        }
        self.within_statements()
    }

    /// Counts work that is done by one statement on many points or elements; whether it may go on.
    pub(super) fn charge(&mut self, items: usize) -> bool {
        self.executed = self.executed.saturating_add(items as u64);
        self.within_statements()
    }

    fn within_statements(&mut self) -> bool {
        if self.executed <= limits::STATEMENTS {
            return true;
        }
        self.limit(format!(
            "more than {} statements have been carried out, points and elements counted singly",
            limits::STATEMENTS
        ));
        false
    }

    fn after_fini(&mut self, code: &Rc<Code>, at: usize, end: usize) {
        let rest = code.program.statements.get(at..end).unwrap_or(&[]);
        if let (Some(first), true) = (rest.first(), self.calls.is_empty() && self.include.depth() == 0) {
            let problem = Diagnostic::new(
                &codes::AFTER_FINI,
                first.span,
                "this stands after FINI and is not carried out",
            );
            self.report(problem);
        }
    }

    /// Carries out one statement; returns where to go on if that is not the next one.
    fn statement(
        &mut self,
        code: &Rc<Code>,
        statement: &Statement,
        at: usize,
        loops: &mut Vec<Loop>,
    ) -> Option<usize> {
        let link = code.links.get(at).copied().unwrap_or(Link::None);
        match &statement.kind {
            StatementKind::Command(command) => self.command(command, statement.span),
            StatementKind::Assign { target, value } => self.assign(target, value),
            StatementKind::Text { word, text, .. } => self.text(word, text),
            StatementKind::Call { name, arguments } => self.call(name, arguments, statement.span),
            StatementKind::Bad { declares } => {
                if let Some(name) = declares {
                    self.scope.poison(name);
                }
                self.state.forget();
                return self.skip_lost_block(code, link, at);
            }
            StatementKind::If(condition) => return self.branch(code, condition, link, at),
            // Reached by running on from the branch before: the IF is done.
            StatementKind::ElseIf(_) | StatementKind::Else => {
                if let Link::Branch { end, .. } = link {
                    return Some(end);
                }
            }
            StatementKind::Do { variable, from, to, step } => {
                return self.start_count(code, (variable, from, to, step.as_ref()), link, at, loops);
            }
            StatementKind::While(condition) => {
                return self.start_while(code, condition, true, link, at, loops);
            }
            StatementKind::Until(condition) => {
                return self.start_while(code, condition, false, link, at, loops);
            }
            StatementKind::EndDo | StatementKind::EndWhile | StatementKind::EndUntil => {
                return self.next_pass(link, loops);
            }
            StatementKind::Macro { name, parameters } => {
                return self.define_macro(code, (name, parameters), link, at);
            }
            StatementKind::JumpTo(label) => return self.jump(code, label, at, loops),
            StatementKind::ArithmeticIf { value, labels } => {
                return self.arithmetic_if(code, value, labels, at, loops);
            }
            StatementKind::EndIf
            | StatementKind::TerMac
            | StatementKind::LoopStart
            | StatementKind::LoopEnd => {}
        }
        None
    }

    /// `IF`: evaluates conditions until one holds; returns where to go on.
    fn branch(&mut self, code: &Rc<Code>, first: &Expr, link: Link, at: usize) -> Option<usize> {
        let Link::Branch { mut next, end } = link else { return None };
        let value = self.evaluate(first);
        let mut truth = self.condition(&(value, first.span));
        let mut at = at;
        loop {
            match truth {
                None => {
                    self.poison_block(code, at + 1..end);
                    return Some(end);
                }
                Some(true) => return Some(at + 1),
                Some(false) if next == end => return Some(end),
                Some(false) => {}
            }
            at = next;
            if let Some(Link::Branch { next: after, .. }) = code.links.get(at) {
                next = *after;
            }
            truth = match code.program.statements.get(at).map(|s| &s.kind) {
                Some(StatementKind::ElseIf(condition)) => {
                    let value = self.evaluate(condition);
                    self.condition(&(value, condition.span))
                }
                _ => Some(true),
            };
        }
    }

    /// The beginning of a block could not be read: its body is not carried out.
    fn skip_lost_block(&mut self, code: &Rc<Code>, link: Link, at: usize) -> Option<usize> {
        let (Link::Start { end } | Link::Branch { end, .. }) = link else { return None };
        self.poison_block(code, at + 1..end);
        Some(end + 1)
    }

    /// Poisons what a block that cannot be carried out would have declared.
    fn poison_block(&mut self, code: &Rc<Code>, range: Range<usize>) {
        for statement in code.program.statements.get(range).unwrap_or(&[]) {
            match &statement.kind {
                StatementKind::Command(command) => {
                    if let Some(label) = &command.label {
                        self.scope.poison(&label.name);
                    }
                }
                StatementKind::Assign { target, .. } => self.scope.poison(&target.name),
                StatementKind::Macro { name, .. } => self.scope.poison(name),
                StatementKind::Bad { declares: Some(name) } => self.scope.poison(name),
                _ => {}
            }
        }
        self.state.forget();
    }

    fn start_while(
        &mut self,
        code: &Rc<Code>,
        condition: &Expr,
        runs_on: bool,
        link: Link,
        at: usize,
        loops: &mut Vec<Loop>,
    ) -> Option<usize> {
        let Link::Start { end } = link else { return None };
        if loops.last().is_none_or(|l| l.start != at) {
            loops.push(Loop { start: at, end, done: 0, repeats: self.report.repeats(), count: None });
        }
        let value = self.evaluate(condition);
        let truth = self.condition(&(value, condition.span));
        if truth.is_none() {
            self.poison_block(code, at + 1..end);
        }
        if truth == Some(runs_on) && self.within_limit(loops) {
            return None;
        }
        loops.pop();
        Some(end + 1)
    }

    /// Counts a pass of the innermost loop.
    fn within_limit(&mut self, loops: &mut [Loop]) -> bool {
        let Some(innermost) = loops.last_mut() else { return false };
        innermost.done += 1;
        if innermost.done <= limits::LOOP_PASSES {
            return true;
        }
        let problem = Diagnostic::new(
            &codes::LOOP_LIMIT,
            self.here,
            format!("this loop has run {} times without an end", limits::LOOP_PASSES),
        )
        .help("does anything inside it change its condition?");
        self.report(problem);
        self.ended = Some(End::Limit);
        false
    }

    fn start_count(
        &mut self,
        code: &Rc<Code>,
        (variable, from, to, step): (&Name, &Expr, &Expr, Option<&Expr>),
        link: Link,
        at: usize,
        loops: &mut Vec<Loop>,
    ) -> Option<usize> {
        let Link::Start { end } = link else {
            self.scope.poison(variable);
            return None;
        };
        match self.count(variable, from, to, step) {
            Some(count) if count.passes > 0 => {
                self.set_variable(variable, Value::Number(count.from));
                loops.push(Loop {
                    start: at,
                    end,
                    done: 1,
                    repeats: self.report.repeats(),
                    count: Some(count),
                });
                None
            }
            Some(_) => Some(end + 1),
            None => {
                self.scope.poison(variable);
                self.poison_block(code, at + 1..end);
                Some(end + 1)
            }
        }
    }

    fn count(&mut self, variable: &Name, from: &Expr, to: &Expr, step: Option<&Expr>) -> Option<Count> {
        let first = self.number_of(from)?;
        let last = self.number_of(to)?;
        let (first, last) = self.level(to.span, (first, from.span), (last, to.span))?;
        let (step, step_span) = match step {
            Some(expr) => {
                let value = self.number_of(expr)?;
                let (value, _) = self.level(expr.span, (value, expr.span), (first, from.span))?;
                (value.value, expr.span)
            }
            None => (Quantity::bare(1.0).land(first.dim, self.unit())?.value, from.span),
        };
        if step == 0.0 {
            let problem =
                Diagnostic::new(&codes::OUT_OF_RANGE, step_span, "a step of 0 never reaches the end");
            self.report(problem);
            return None;
        }
        let passes = ((last.value - first.value) / step + COUNT_SLACK).floor() + 1.0;
        if passes > limits::LOOP_PASSES as f64 {
            let message =
                format!("this loop would run {} times; the limit is {}", number(passes), limits::LOOP_PASSES);
            let problem = Diagnostic::new(&codes::LOOP_LIMIT, self.here, message);
            self.report(problem);
            return None;
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let passes = passes.max(0.0) as u64;
        Some(Count { variable: variable.clone(), from: first, step, passes })
    }

    fn number_of(&mut self, expr: &Expr) -> Option<Quantity> {
        match self.evaluate(expr) {
            Value::Number(q) => Some(q),
            Value::Poison => None,
            other => {
                let message = format!("a number is wanted here, and this is {}", other.kind_name());
                self.report(Diagnostic::new(&codes::WRONG_KIND, expr.span, message));
                None
            }
        }
    }

    fn next_pass(&mut self, link: Link, loops: &mut Vec<Loop>) -> Option<usize> {
        let Link::End { start } = link else { return None };
        let innermost = loops.last_mut().filter(|l| l.start == start)?;
        if self.report.repeats() > innermost.repeats + limits::LOOP_REPEATS {
            loops.pop();
            self.state.forget();
            return None;
        }
        let Some(count) = &innermost.count else { return Some(start) };
        if innermost.done >= count.passes {
            loops.pop();
            return None;
        }
        #[allow(clippy::cast_precision_loss)]
        let value = crate::units::tidy(count.from.value + count.step * innermost.done as f64);
        let (variable, value) = (count.variable.clone(), Value::number(value, count.from.dim));
        innermost.done += 1;
        self.set_variable(&variable, value);
        Some(start + 1)
    }

    fn set_variable(&mut self, name: &Name, value: Value) {
        let target = crate::syntax::ast::Target { name: name.clone(), subscripts: Vec::new() };
        self.assign_value(&target, value);
    }

    fn jump(&mut self, code: &Rc<Code>, label: &Name, at: usize, loops: &mut Vec<Loop>) -> Option<usize> {
        let arena = code.arenas.get(at).copied().flatten();
        let Some(&to) = code.labels.get(&(arena, label.upper())) else {
            let problem = self.no_label(code, arena, label);
            self.report(problem);
            return self.leave_arena(code, arena);
        };
        while loops.last().is_some_and(|l| !(l.start < to && to <= l.end)) {
            loops.pop();
        }
        Some(to)
    }

    /// After a jump that goes nowhere, running on could go round for ever: the rest of the stretch is left out.
    fn leave_arena(&mut self, code: &Rc<Code>, arena: Option<usize>) -> Option<usize> {
        match arena.and_then(|a| code.links.get(a)) {
            Some(Link::Start { end }) => Some(*end),
            _ => None,
        }
    }

    fn no_label(&self, code: &Rc<Code>, arena: Option<usize>, label: &Name) -> Diagnostic {
        let problem =
            Diagnostic::new(&codes::JUMP, label.span, format!("there is no jump label {} here", label.text));
        let elsewhere = code.labels.iter().find(|((_, name), _)| *name == label.upper());
        if let Some((_, &i)) = elsewhere
            && let Some(other) = code.program.statements.get(i).and_then(|s| s.jump_label.as_ref())
        {
            return problem
                .label(other.span, "this one stands in another loop, macro or file part")
                .help("a jump stays inside its LOOPST … LOOPND or its macro");
        }
        let near: Vec<&str> =
            code.labels.keys().filter(|(a, _)| *a == arena).map(|(_, n)| n.as_str()).collect();
        match did_you_mean(&label.text, near) {
            Some(near) => problem.help(format!("did you mean `{near}`?")),
            None => problem.help(format!("a label stands before a statement: `{}) …`", label.text)),
        }
    }

    fn arithmetic_if(
        &mut self,
        code: &Rc<Code>,
        selector: &Expr,
        labels: &[Name],
        at: usize,
        loops: &mut Vec<Loop>,
    ) -> Option<usize> {
        let arena = code.arenas.get(at).copied().flatten();
        if labels.len() != 3 {
            let span = labels.first().map_or(selector.span, |l| l.span);
            let message =
                format!("IF (…) takes three labels, for negative, zero and positive; {} given", labels.len());
            self.report(Diagnostic::new(&codes::JUMP, span, message));
            return self.leave_arena(code, arena);
        }
        let Some(q) = self.number_of(selector) else { return self.leave_arena(code, arena) };
        let index = if q.value < 0.0 {
            0
        } else if q.value == 0.0 {
            1
        } else {
            2
        };
        self.jump(code, labels.get(index)?, at, loops)
    }

    /// Sets a variable or an element; see [`Analyser::assign`].
    pub(super) fn bind_parameter(&mut self, name: &Name, value: Value) -> (String, Binding) {
        (name.upper(), Binding { kind: BindingKind::Variable(value), declared: name.span })
    }
}
