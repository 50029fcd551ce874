//! Pairs of the grammar to the syntax tree. Precedence is here.

use std::sync::LazyLock;

use pest::iterators::{Pair, Pairs};
use pest::pratt_parser::{Assoc, Op, PrattParser};

use super::ast::{
    Arg, ArgKind, BinaryOp, CallArgument, Command, Expr, ExprKind, Name, Parameter, Statement, StatementKind,
    Target, UnaryOp,
};
use super::grammar::Rule;
use super::{limits, slips};
use crate::diag::Diagnostic;
use crate::diag::codes::syntax as codes;
use crate::source::{FileId, Span};
use crate::vocab;

/// Loosest first. A sign binds tighter than a power and powers group from the right, as in APT; `NOT` binds
/// looser than a comparison.
static PRATT: LazyLock<PrattParser<Rule>> = LazyLock::new(|| {
    use Assoc::{Left, Right};
    PrattParser::new()
        .op(Op::infix(Rule::or, Left))
        .op(Op::infix(Rule::and, Left))
        .op(Op::prefix(Rule::not))
        .op(Op::infix(Rule::equal, Left)
            | Op::infix(Rule::not_equal, Left)
            | Op::infix(Rule::less, Left)
            | Op::infix(Rule::less_equal, Left)
            | Op::infix(Rule::greater, Left)
            | Op::infix(Rule::greater_equal, Left))
        .op(Op::infix(Rule::plus, Left) | Op::infix(Rule::minus, Left))
        .op(Op::infix(Rule::times, Left) | Op::infix(Rule::slash, Left))
        .op(Op::infix(Rule::power, Right))
        .op(Op::prefix(Rule::negative) | Op::prefix(Rule::positive))
});

/// Builds the trees of one statement; the mistakes it finds are in `mistakes`.
pub(super) struct Builder<'a> {
    pub(super) file: FileId,
    /// Byte of the statement's first character in the file.
    pub(super) offset: usize,
    /// Bytes in the file at which a line ended in `,` `/` `=` inside this statement.
    pub(super) joints: &'a [usize],
    pub(super) mistakes: Vec<Diagnostic>,
    /// Operators that the current argument may still have.
    pub(super) operators: usize,
}

type PairOf<'i> = Pair<'i, Rule>;

impl Builder<'_> {
    fn span(&self, pair: &PairOf<'_>) -> Span {
        let s = pair.as_span();
        Span::new(self.file, self.offset + s.start(), self.offset + s.end())
    }

    fn name(&self, pair: &PairOf<'_>) -> Name {
        Name { text: pair.as_str().to_owned(), span: self.span(pair) }
    }

    /// The statement that `pairs` (of rule `statement`) hold.
    pub(super) fn statement(&mut self, span: Span, pairs: Pairs<'_, Rule>) -> Statement {
        let mut jump_label = None;
        let mut kind = StatementKind::Bad { declares: None };
        for pair in pairs {
            match pair.as_rule() {
                Rule::jump_label => jump_label = pair.into_inner().next().map(|p| self.name(&p)),
                Rule::EOI => {}
                _ => kind = self.body(pair),
            }
        }
        if !self.mistakes.is_empty() {
            kind = StatementKind::Bad { declares: declared(&kind) };
        }
        Statement { span, jump_label, kind }
    }

    fn body(&mut self, pair: PairOf<'_>) -> StatementKind {
        match pair.as_rule() {
            Rule::if_arithmetic => self.arithmetic_if(pair),
            Rule::if_block => StatementKind::If(self.condition(pair)),
            Rule::else_if => StatementKind::ElseIf(self.condition(pair)),
            Rule::else_block => StatementKind::Else,
            Rule::end_if => StatementKind::EndIf,
            Rule::do_loop => self.do_loop(pair),
            Rule::end_do => StatementKind::EndDo,
            Rule::while_loop => StatementKind::While(self.condition(pair)),
            Rule::end_while => StatementKind::EndWhile,
            Rule::until_loop => StatementKind::Until(self.condition(pair)),
            Rule::end_until => StatementKind::EndUntil,
            Rule::end_macro => StatementKind::TerMac,
            Rule::call => self.call(pair),
            Rule::loop_start => StatementKind::LoopStart,
            Rule::loop_end => StatementKind::LoopEnd,
            Rule::jump_to => match of_rule(pair.into_inner(), Rule::label).next() {
                Some(label) => StatementKind::JumpTo(self.name(&label)),
                None => StatementKind::Bad { declares: None },
            },
            Rule::binding => self.binding(pair),
            Rule::command => self.command(pair),
            _ => StatementKind::Bad { declares: None },
        }
    }

    fn condition(&mut self, pair: PairOf<'_>) -> Expr {
        let span = self.span(&pair);
        match of_rule(pair.into_inner(), Rule::expression).next() {
            Some(expression) => self.argument_expression(expression),
            None => Expr { span, kind: ExprKind::Tuple(Vec::new()) },
        }
    }

    fn arithmetic_if(&mut self, pair: PairOf<'_>) -> StatementKind {
        let span = self.span(&pair);
        let mut value = None;
        let mut labels = Vec::new();
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::selector => value = Some(self.condition(part)),
                Rule::label => labels.push(self.name(&part)),
                _ => {}
            }
        }
        if labels.len() != 3 {
            self.mistakes.push(
                Diagnostic::new(
                    &codes::ARITHMETIC_IF,
                    span,
                    format!("an arithmetic IF takes three labels, this one has {}", labels.len()),
                )
                .help("write `IF (e) negative, zero, positive`, or `IF/ condition` … `ENDIF`"),
            );
        }
        match value {
            Some(value) => StatementKind::ArithmeticIf { value, labels },
            None => StatementKind::Bad { declares: None },
        }
    }

    fn do_loop(&mut self, pair: PairOf<'_>) -> StatementKind {
        let mut variable = None;
        let mut bounds = Vec::new();
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::name => variable = Some(self.name(&part)),
                Rule::expression => bounds.push(self.argument_expression(part)),
                _ => {}
            }
        }
        let mut bounds = bounds.into_iter();
        match (variable, bounds.next(), bounds.next()) {
            (Some(variable), Some(from), Some(to)) => {
                StatementKind::Do { variable, from, to, step: bounds.next() }
            }
            _ => StatementKind::Bad { declares: None },
        }
    }

    fn call(&mut self, pair: PairOf<'_>) -> StatementKind {
        let mut name = None;
        let mut arguments = Vec::new();
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::name => name = Some(self.name(&part)),
                Rule::argument => arguments.push(self.call_argument(part)),
                _ => {}
            }
        }
        match name {
            Some(name) => StatementKind::Call { name, arguments },
            None => StatementKind::Bad { declares: None },
        }
    }

    fn call_argument(&mut self, pair: PairOf<'_>) -> CallArgument {
        let arg = self.argument(pair);
        match arg.kind {
            ArgKind::Named { name, value } => CallArgument { name: Some(name), value: lone(value) },
            kind => CallArgument { name: None, value: Arg { span: arg.span, kind } },
        }
    }

    fn binding(&mut self, pair: PairOf<'_>) -> StatementKind {
        let mut target = None;
        for part in pair.into_inner() {
            match (part.as_rule(), target.take()) {
                (Rule::target, _) => target = Some(self.target(part)),
                (Rule::macro_head, Some(t)) => return self.macro_head(t, part),
                (Rule::definition, Some(t)) => return self.definition(t, part),
                (Rule::expression, Some(t)) => {
                    return StatementKind::Assign { target: t, value: self.argument_expression(part) };
                }
                (_, t) => target = t,
            }
        }
        StatementKind::Bad { declares: target.map(|t| t.name) }
    }

    fn target(&mut self, pair: PairOf<'_>) -> Target {
        let mut name = Name { text: String::new(), span: self.span(&pair) };
        let mut subscripts = Vec::new();
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::name => name = self.name(&part),
                Rule::subscripts => {
                    for e in of_rule(part.into_inner(), Rule::expression) {
                        subscripts.push(self.argument_expression(e));
                    }
                }
                _ => {}
            }
        }
        Target { name, subscripts }
    }

    fn macro_head(&mut self, target: Target, pair: PairOf<'_>) -> StatementKind {
        let mut parameters = Vec::new();
        for parameter in of_rule(pair.into_inner(), Rule::parameter) {
            let mut parts = parameter.into_inner();
            let Some(name) = parts.next().map(|p| self.name(&p)) else { continue };
            let default = of_rule(parts, Rule::expression).next();
            let default = default.map(|e| lone(self.argument_expression(e)));
            parameters.push(Parameter { name, default });
        }
        StatementKind::Macro { name: target.name, parameters }
    }

    /// `name = word / arguments`: a declaration when `word` starts statements or there are several arguments,
    /// otherwise a division.
    fn definition(&mut self, target: Target, pair: PairOf<'_>) -> StatementKind {
        let Some(parts) = SlashParts::of(pair.into_inner()) else {
            return StatementKind::Bad { declares: Some(target.name) };
        };
        if parts.divides() {
            return StatementKind::Assign { target, value: self.division(parts) };
        }
        StatementKind::Command(self.slash_command(Some(target), parts))
    }

    fn slash_command(&mut self, label: Option<Target>, parts: SlashParts<'_>) -> Command {
        Command {
            label,
            prefixes: Vec::new(),
            word: self.name(&parts.word),
            slash: Some(self.span(&parts.slash)),
            args: parts.arguments.into_iter().map(|a| self.argument(a)).collect(),
        }
    }

    /// `word / argument`, read as an expression after all.
    fn division(&mut self, parts: SlashParts<'_>) -> Expr {
        let tail = parts.arguments.into_iter().flat_map(Pair::into_inner).flat_map(Pair::into_inner);
        let tokens: Vec<_> = [parts.word, parts.slash].into_iter().chain(tail).collect();
        self.operators = limits::OPERATORS;
        self.tokens(tokens)
    }

    fn command(&mut self, pair: PairOf<'_>) -> StatementKind {
        let mut words = Vec::new();
        let mut slash = None;
        let mut args = Vec::new();
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::name => words.push(self.name(&part)),
                Rule::slash => slash = Some(self.span(&part)),
                Rule::arguments => args = self.arguments(part),
                _ => {}
            }
        }
        match words.pop() {
            Some(word) => StatementKind::Command(Command { label: None, prefixes: words, word, slash, args }),
            None => StatementKind::Bad { declares: None },
        }
    }

    fn arguments(&mut self, pair: PairOf<'_>) -> Vec<Arg> {
        let arguments: Vec<_> = of_rule(pair.into_inner(), Rule::argument).collect();
        arguments.into_iter().map(|a| self.argument(a)).collect()
    }

    fn argument(&mut self, pair: PairOf<'_>) -> Arg {
        let span = self.span(&pair);
        let Some(inner) = pair.into_inner().next() else {
            return Arg { span, kind: ArgKind::Expr(Expr { span, kind: ExprKind::Tuple(Vec::new()) }) };
        };
        if inner.as_rule() == Rule::named {
            return self.named(span, inner);
        }
        self.refuse_open_definition(&inner);
        lone(self.argument_expression(inner))
    }

    fn named(&mut self, span: Span, pair: PairOf<'_>) -> Arg {
        let mut name = Name { text: String::new(), span };
        let mut value = Expr { span, kind: ExprKind::Tuple(Vec::new()) };
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::name => name = self.name(&part),
                Rule::expression => {
                    if self.refuse_open_definition(&part) {
                        continue;
                    }
                    value = self.argument_expression(part);
                }
                _ => {}
            }
        }
        Arg { span, kind: ArgKind::Named { name, value } }
    }

    /// `…, POINT/ 1` among arguments: a definition without parentheses, or the next statement behind a line
    /// that ends in a comma by mistake.
    fn refuse_open_definition(&mut self, expression: &PairOf<'_>) -> bool {
        let mut tokens = expression.clone().into_inner();
        let word = tokens.next().and_then(bare_name);
        let slash = tokens.next().filter(|t| t.as_rule() == Rule::slash);
        let Some(word) = word.filter(|w| slash.is_some() && vocab::is_statement_word(w.as_str())) else {
            return false;
        };
        let at = self.offset + word.as_span().start();
        let diagnostic = match self.joints.iter().rfind(|&&j| j < at) {
            Some(&joint) => slips::unfinished_line(Span::new(self.file, joint, joint + 1), self.span(&word)),
            None => Diagnostic::new(
                &codes::UNEXPECTED,
                self.span(&word),
                format!(
                    "a definition inside another statement stands in parentheses: `({}/ …)`",
                    word.as_str()
                ),
            ),
        };
        if self.mistakes.is_empty() {
            self.mistakes.push(diagnostic);
        }
        true
    }

    /// An expression at the top of an argument, with its own budget of operators.
    fn argument_expression(&mut self, pair: PairOf<'_>) -> Expr {
        self.operators = limits::OPERATORS;
        self.expression(pair)
    }

    fn expression(&mut self, pair: PairOf<'_>) -> Expr {
        self.tokens(pair.into_inner().collect())
    }

    /// Operands and operators in a row, to a tree.
    fn tokens(&mut self, tokens: Vec<PairOf<'_>>) -> Expr {
        let operands = tokens.iter().filter(|t| is_operand(t.as_rule())).count();
        let operators = tokens.len() - operands;
        let span = match (tokens.first(), tokens.last()) {
            (Some(first), Some(last)) => self.span(first).to(self.span(last)),
            _ => Span::new(self.file, self.offset, self.offset),
        };
        if operators > self.operators || operands == 0 {
            if self.mistakes.is_empty() {
                self.mistakes.push(limits::too_many_operators(span));
            }
            return Expr { span, kind: ExprKind::Tuple(Vec::new()) };
        }
        self.operators -= operators;
        let operands: Vec<_> = tokens
            .into_iter()
            .map(|t| {
                if is_operand(t.as_rule()) {
                    Token::Operand(self.operand(t.clone()), t)
                } else {
                    Token::Operator(t)
                }
            })
            .collect();
        climb(self.file, self.offset, operands)
    }

    fn operand(&mut self, pair: PairOf<'_>) -> Expr {
        match pair.as_rule() {
            Rule::primary => self.primary(pair),
            Rule::name => Expr { span: self.span(&pair), kind: ExprKind::Name(self.name(&pair)) },
            _ => self.atom(pair),
        }
    }

    fn primary(&mut self, pair: PairOf<'_>) -> Expr {
        let span = self.span(&pair);
        let mut parts = pair.into_inner();
        let mut value = match parts.next() {
            Some(atom) => self.atom(atom),
            None => Expr { span, kind: ExprKind::Tuple(Vec::new()) },
        };
        for member in of_rule(parts, Rule::name) {
            if self.operators == 0 {
                self.mistakes.push(limits::too_many_operators(span));
                break;
            }
            self.operators -= 1;
            let member = self.name(&member);
            let span = value.span.to(member.span);
            value = Expr { span, kind: ExprKind::Member { base: Box::new(value), member } };
        }
        value
    }

    fn atom(&mut self, pair: PairOf<'_>) -> Expr {
        let span = self.span(&pair);
        let kind = match pair.as_rule() {
            Rule::number => self.number(pair),
            Rule::string => ExprKind::Text(inner_text(pair)),
            Rule::apply => self.apply(pair),
            Rule::group => self.group(pair),
            _ => ExprKind::Tuple(Vec::new()),
        };
        Expr { span, kind }
    }

    fn number(&mut self, pair: PairOf<'_>) -> ExprKind {
        let written = pair.as_str().to_owned();
        let span = self.span(&pair);
        let mut value = 0.0;
        let mut unit = None;
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::decimal => value = part.as_str().parse().unwrap_or(f64::NAN),
                Rule::unit => unit = Some(self.name(&part)),
                _ => {}
            }
        }
        if let Some(meant) = slips::letter_o(&written) {
            self.mistakes.push(
                Diagnostic::new(
                    &codes::BAD_NUMBER,
                    span,
                    format!("`{written}` has the letter O where the digit 0 is meant"),
                )
                .help(format!("write `{meant}`")),
            );
        } else if !value.is_finite() {
            self.mistakes.push(Diagnostic::new(
                &codes::BAD_NUMBER,
                span,
                format!("the number {written} is too large; the largest is about 1.7E308"),
            ));
        }
        ExprKind::Number { value, unit }
    }

    fn apply(&mut self, pair: PairOf<'_>) -> ExprKind {
        let mut parts = pair.into_inner();
        let Some(name) = parts.next().map(|p| self.name(&p)) else { return ExprKind::Tuple(Vec::new()) };
        let args: Vec<Expr> = {
            let expressions: Vec<_> = of_rule(parts, Rule::expression).collect();
            expressions.into_iter().map(|e| self.expression(e)).collect()
        };
        if args.is_empty() { ExprKind::Name(name) } else { ExprKind::Apply { name, args } }
    }

    fn group(&mut self, pair: PairOf<'_>) -> ExprKind {
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::labelled => return self.labelled(part),
                Rule::nested => return self.nested(part),
                Rule::tuple => return self.tuple(part),
                _ => {}
            }
        }
        ExprKind::Tuple(Vec::new())
    }

    fn labelled(&mut self, pair: PairOf<'_>) -> ExprKind {
        let mut inner = pair.into_inner();
        let label = inner.next().map(|p| Target { name: self.name(&p), subscripts: Vec::new() });
        let Some(parts) = SlashParts::of(inner) else { return ExprKind::Tuple(Vec::new()) };
        let budget = self.operators;
        let command = self.slash_command(label, parts);
        self.operators = budget;
        ExprKind::Nested(Box::new(command))
    }

    /// `(word / arguments)`: a definition, a tuple that starts with a division, or a division.
    fn nested(&mut self, pair: PairOf<'_>) -> ExprKind {
        let Some(parts) = SlashParts::of(pair.into_inner()) else { return ExprKind::Tuple(Vec::new()) };
        if vocab::is_statement_word(parts.word.as_str()) || parts.has_named() {
            let budget = self.operators;
            let command = self.slash_command(None, parts);
            self.operators = budget;
            return ExprKind::Nested(Box::new(command));
        }
        let mut rest = parts.arguments.into_iter();
        let first = rest.next().into_iter().flat_map(Pair::into_inner).flat_map(Pair::into_inner);
        let first = self.tokens([parts.word, parts.slash].into_iter().chain(first).collect());
        let rest: Vec<Expr> = rest.flat_map(Pair::into_inner).map(|e| self.expression(e)).collect();
        if rest.is_empty() {
            return ExprKind::Paren(Box::new(first));
        }
        ExprKind::Tuple(core::iter::once(first).chain(rest).collect())
    }

    fn tuple(&mut self, pair: PairOf<'_>) -> ExprKind {
        let parts: Vec<_> = of_rule(pair.into_inner(), Rule::expression).collect();
        let mut items: Vec<Expr> = parts.into_iter().map(|e| self.expression(e)).collect();
        match items.pop() {
            Some(only) if items.is_empty() => ExprKind::Paren(Box::new(only)),
            Some(last) => {
                items.push(last);
                ExprKind::Tuple(items)
            }
            None => ExprKind::Tuple(items),
        }
    }
}

/// An operand with its tree, or an operator.
enum Token<'i> {
    Operand(Expr, PairOf<'i>),
    Operator(PairOf<'i>),
}

/// Precedence climbing by pest's Pratt parser. The operands' trees are taken in order: the parser asks for
/// each exactly once, from left to right.
fn climb(file: FileId, offset: usize, tokens: Vec<Token<'_>>) -> Expr {
    let mut trees = Vec::new();
    let mut pairs = Vec::new();
    for token in tokens {
        match token {
            Token::Operand(tree, pair) => {
                trees.push(tree);
                pairs.push(pair);
            }
            Token::Operator(pair) => pairs.push(pair),
        }
    }
    let span = |pair: &PairOf<'_>| {
        let s = pair.as_span();
        Span::new(file, offset + s.start(), offset + s.end())
    };
    let mut trees = trees.into_iter();
    // The primary rules are not operators of the table, which is how the Pratt parser knows an operand.
    PRATT
        .map_primary(|pair| {
            let empty = Expr { span: span(&pair), kind: ExprKind::Tuple(Vec::new()) };
            trees.next().unwrap_or(empty)
        })
        .map_prefix(|op, operand| Expr {
            span: span(&op).to(operand.span),
            kind: ExprKind::Unary { op: unary(op.as_rule()), op_span: span(&op), operand: Box::new(operand) },
        })
        .map_infix(|left, op, right| Expr {
            span: left.span.to(right.span),
            kind: ExprKind::Binary {
                op: binary(op.as_rule()),
                op_span: span(&op),
                left: Box::new(left),
                right: Box::new(right),
            },
        })
        .parse(pairs.into_iter())
}

fn unary(rule: Rule) -> UnaryOp {
    match rule {
        Rule::negative => UnaryOp::Minus,
        Rule::not => UnaryOp::Not,
        _ => UnaryOp::Plus,
    }
}

fn binary(rule: Rule) -> BinaryOp {
    match rule {
        Rule::or => BinaryOp::Or,
        Rule::and => BinaryOp::And,
        Rule::equal => BinaryOp::Equal,
        Rule::not_equal => BinaryOp::NotEqual,
        Rule::less => BinaryOp::Less,
        Rule::less_equal => BinaryOp::LessEqual,
        Rule::greater => BinaryOp::Greater,
        Rule::greater_equal => BinaryOp::GreaterEqual,
        Rule::plus => BinaryOp::Add,
        Rule::minus => BinaryOp::Subtract,
        Rule::times => BinaryOp::Multiply,
        Rule::power => BinaryOp::Power,
        _ => BinaryOp::Divide,
    }
}

fn is_operand(rule: Rule) -> bool {
    matches!(rule, Rule::primary | Rule::name)
}

fn of_rule<'i>(pairs: impl Iterator<Item = PairOf<'i>>, rule: Rule) -> impl Iterator<Item = PairOf<'i>> {
    pairs.filter(move |p| p.as_rule() == rule)
}

/// `word / arguments` taken apart.
struct SlashParts<'i> {
    word: PairOf<'i>,
    slash: PairOf<'i>,
    arguments: Vec<PairOf<'i>>,
}

impl<'i> SlashParts<'i> {
    /// From pairs that hold a name, a slash and perhaps arguments.
    fn of(pairs: impl Iterator<Item = PairOf<'i>>) -> Option<Self> {
        let (mut word, mut slash, mut arguments) = (None, None, Vec::new());
        for pair in pairs {
            match pair.as_rule() {
                Rule::name => word = Some(pair),
                Rule::slash => slash = Some(pair),
                Rule::arguments => arguments.extend(of_rule(pair.into_inner(), Rule::argument)),
                _ => {}
            }
        }
        Some(SlashParts { word: word?, slash: slash?, arguments })
    }

    /// Whether this is the quotient of a name and an expression.
    fn divides(&self) -> bool {
        self.arguments.len() == 1 && !self.has_named() && !vocab::is_statement_word(self.word.as_str())
    }

    fn has_named(&self) -> bool {
        let mut inner = self.arguments.iter().filter_map(|a| a.clone().into_inner().next());
        inner.any(|p| p.as_rule() == Rule::named)
    }
}

/// The name, if this operand is nothing but a name.
fn bare_name(primary: PairOf<'_>) -> Option<PairOf<'_>> {
    let atom = only(primary.into_inner())?;
    let name = only(atom.into_inner())?;
    (name.as_rule() == Rule::name).then_some(name)
}

fn only<'i>(mut pairs: Pairs<'i, Rule>) -> Option<PairOf<'i>> {
    let first = pairs.next()?;
    pairs.next().is_none().then_some(first)
}

fn inner_text(pair: PairOf<'_>) -> String {
    pair.into_inner().next().map(|p| p.as_str().to_owned()).unwrap_or_default()
}

/// An expression as an argument: a definition alone in its parentheses is a definition.
fn lone(value: Expr) -> Arg {
    let span = value.span;
    let kind = match value.kind {
        ExprKind::Nested(command) => ArgKind::Nested(command),
        kind => ArgKind::Expr(Expr { span, kind }),
    };
    Arg { span, kind }
}

/// The name that a statement declares.
fn declared(kind: &StatementKind) -> Option<Name> {
    match kind {
        StatementKind::Command(command) => command.label.as_ref().map(|t| t.name.clone()),
        StatementKind::Assign { target, .. } => Some(target.name.clone()),
        StatementKind::Macro { name, .. } => Some(name.clone()),
        StatementKind::Bad { declares } => declares.clone(),
        _ => None,
    }
}
