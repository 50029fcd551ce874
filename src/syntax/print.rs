//! The syntax tree as text, one statement a line: what `--emit ast` prints.

use core::fmt::{self, Write};

use super::ast::{
    Arg, ArgKind, BinaryOp, CallArgument, Command, Expr, ExprKind, Name, Parameter, Program, Statement,
    StatementKind, Target, UnaryOp,
};
use crate::source::SourceMap;

/// Prints a program; `sources` gives the line numbers.
#[must_use]
pub fn print(program: &Program, sources: &SourceMap) -> String {
    let mut out = String::new();
    let file = sources.file(program.file);
    for statement in &program.statements {
        let (line, column) = file.line_column(statement.span.start);
        let printed = write!(out, "{line}:{column} ").and_then(|()| write_statement(&mut out, statement));
        // Writing to a String cannot fail.
        debug_assert!(printed.is_ok());
        out.push('\n');
    }
    out
}

fn write_statement(out: &mut String, statement: &Statement) -> fmt::Result {
    if let Some(label) = &statement.jump_label {
        write!(out, "{}) ", label.text)?;
    }
    write_kind(out, &statement.kind)
}

fn write_kind(out: &mut String, kind: &StatementKind) -> fmt::Result {
    match kind {
        StatementKind::Command(command) => write_command(out, command),
        StatementKind::Assign { target, value } => {
            out.write_str("assign ")?;
            write_target(out, target)?;
            out.write_str(" = ")?;
            write_expr(out, value)
        }
        StatementKind::Text { word, text, .. } => write!(out, "text {} {text:?}", word.upper()),
        StatementKind::If(condition) => write_condition(out, "if", condition),
        StatementKind::ElseIf(condition) => write_condition(out, "elseif", condition),
        StatementKind::Else => out.write_str("else"),
        StatementKind::EndIf => out.write_str("endif"),
        StatementKind::ArithmeticIf { value, labels } => {
            write_condition(out, "if-sign", value)?;
            labels.iter().try_for_each(|l| write!(out, " {}", l.text))
        }
        StatementKind::Do { variable, from, to, step } => write_do(out, variable, from, to, step.as_ref()),
        StatementKind::EndDo => out.write_str("enddo"),
        StatementKind::While(condition) => write_condition(out, "while", condition),
        StatementKind::EndWhile => out.write_str("endwhile"),
        StatementKind::Until(condition) => write_condition(out, "until", condition),
        StatementKind::EndUntil => out.write_str("enduntil"),
        StatementKind::Macro { name, parameters } => {
            write!(out, "macro {}", name.text)?;
            parameters.iter().try_for_each(|p| write_parameter(out, p))
        }
        StatementKind::TerMac => out.write_str("termac"),
        StatementKind::Call { name, arguments } => {
            write!(out, "call {}", name.text)?;
            arguments.iter().try_for_each(|a| write_call_argument(out, a))
        }
        StatementKind::LoopStart => out.write_str("loopst"),
        StatementKind::LoopEnd => out.write_str("loopnd"),
        StatementKind::JumpTo(label) => write!(out, "jumpto {}", label.text),
        StatementKind::Bad { declares } => match declares {
            Some(name) => write!(out, "bad {}", name.text),
            None => out.write_str("bad"),
        },
    }
}

fn write_condition(out: &mut String, word: &str, condition: &Expr) -> fmt::Result {
    write!(out, "{word} ")?;
    write_expr(out, condition)
}

fn write_do(out: &mut String, variable: &Name, from: &Expr, to: &Expr, step: Option<&Expr>) -> fmt::Result {
    write!(out, "do {} = ", variable.text)?;
    write_expr(out, from)?;
    out.write_str(" to ")?;
    write_expr(out, to)?;
    if let Some(step) = step {
        out.write_str(" step ")?;
        write_expr(out, step)?;
    }
    Ok(())
}

fn write_command(out: &mut String, command: &Command) -> fmt::Result {
    out.write_str("command ")?;
    if let Some(label) = &command.label {
        write_target(out, label)?;
        out.write_str(" = ")?;
    }
    for prefix in &command.prefixes {
        write!(out, "{}, ", prefix.text)?;
    }
    write!(out, "{}{}", command.word.text, if command.slash.is_some() { "/" } else { "" })?;
    write_args(out, &command.args)
}

fn write_args(out: &mut String, args: &[Arg]) -> fmt::Result {
    for (i, arg) in args.iter().enumerate() {
        out.write_str(if i == 0 { " " } else { ", " })?;
        write_arg(out, arg)?;
    }
    Ok(())
}

fn write_arg(out: &mut String, arg: &Arg) -> fmt::Result {
    match &arg.kind {
        ArgKind::Expr(expr) => write_expr(out, expr),
        ArgKind::Named { name, value } => {
            write!(out, "{}: ", name.text)?;
            write_expr(out, value)
        }
        ArgKind::Nested(command) => write_nested(out, command),
    }
}

fn write_nested(out: &mut String, command: &Command) -> fmt::Result {
    out.write_char('{')?;
    write_command(out, command)?;
    out.write_char('}')
}

fn write_parameter(out: &mut String, parameter: &Parameter) -> fmt::Result {
    write!(out, " {}", parameter.name.text)?;
    match &parameter.default {
        Some(default) => {
            out.write_str(": ")?;
            write_arg(out, default)
        }
        None => Ok(()),
    }
}

fn write_call_argument(out: &mut String, argument: &CallArgument) -> fmt::Result {
    out.write_char(' ')?;
    if let Some(name) = &argument.name {
        write!(out, "{}: ", name.text)?;
    }
    write_arg(out, &argument.value)
}

fn write_target(out: &mut String, target: &Target) -> fmt::Result {
    out.write_str(&target.name.text)?;
    if target.subscripts.is_empty() {
        return Ok(());
    }
    out.write_char('[')?;
    write_list(out, &target.subscripts)?;
    out.write_char(']')
}

fn write_list(out: &mut String, items: &[Expr]) -> fmt::Result {
    for (i, item) in items.iter().enumerate() {
        if i > 0 {
            out.write_str(", ")?;
        }
        write_expr(out, item)?;
    }
    Ok(())
}

/// Operators in prefix form, so that grouping shows: `(+ 1 (* 2 3))`; written parentheses are `[…]`.
fn write_expr(out: &mut String, expr: &Expr) -> fmt::Result {
    match &expr.kind {
        ExprKind::Number { value, unit } => {
            write!(out, "{value}{}", unit.as_ref().map_or("", |u| u.text.as_str()))
        }
        ExprKind::Text(text) => write!(out, "{text:?}"),
        ExprKind::Name(name) => out.write_str(&name.text),
        ExprKind::Apply { name, args } => {
            write!(out, "{}(", name.text)?;
            write_list(out, args)?;
            out.write_char(')')
        }
        ExprKind::Member { base, member } => {
            write_expr(out, base)?;
            write!(out, ".{}", member.text)
        }
        ExprKind::Tuple(items) => {
            out.write_str("<")?;
            write_list(out, items)?;
            out.write_char('>')
        }
        ExprKind::Nested(command) => write_nested(out, command),
        ExprKind::Paren(inner) => {
            out.write_char('[')?;
            write_expr(out, inner)?;
            out.write_char(']')
        }
        ExprKind::Unary { op, operand, .. } => {
            write!(out, "({} ", unary(*op))?;
            write_expr(out, operand)?;
            out.write_char(')')
        }
        ExprKind::Binary { op, left, right, .. } => {
            write!(out, "({} ", binary(*op))?;
            write_expr(out, left)?;
            out.write_char(' ')?;
            write_expr(out, right)?;
            out.write_char(')')
        }
    }
}

fn unary(op: UnaryOp) -> &'static str {
    match op {
        UnaryOp::Minus => "neg",
        UnaryOp::Plus => "pos",
        UnaryOp::Not => "not",
    }
}

fn binary(op: BinaryOp) -> &'static str {
    match op {
        BinaryOp::Or => "or",
        BinaryOp::And => "and",
        BinaryOp::Equal => "==",
        BinaryOp::NotEqual => "<>",
        BinaryOp::Less => "<",
        BinaryOp::LessEqual => "<=",
        BinaryOp::Greater => ">",
        BinaryOp::GreaterEqual => ">=",
        BinaryOp::Add => "+",
        BinaryOp::Subtract => "-",
        BinaryOp::Multiply => "*",
        BinaryOp::Divide => "/",
        BinaryOp::Power => "**",
    }
}
