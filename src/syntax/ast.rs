//! The syntax tree: statements with byte spans, comments kept.
//!
//! The tree knows next to no vocabulary: whether `FLAT` is a minor word or somebody's variable is decided in
//! `sema`. The one question asked of the vocabulary is [`crate::vocab::is_statement_word`], because `R = D/2`
//! divides and `C = CIRCLE/ 2` declares: `name = WORD/ …` and `(WORD/ …)` with a statement word are commands;
//! `name = x/ a, b` with several arguments is a command too, of a word that `sema` will not know. Blocks (`MACRO … TERMAC`,
//! `IF … ENDIF`, `DO … ENDDO`) are a flat run of statements here; `sema` matches
//! them, so that one bad line never loses a block.

use crate::source::{FileId, Span};

/// One parsed file.
#[derive(Debug, Clone, PartialEq)]
pub struct Program {
    /// The file.
    pub file: FileId,
    /// Statements in order. A statement that could not be parsed is [`StatementKind::Bad`].
    pub statements: Vec<Statement>,
    /// `$$` comments in order; the text is the span's, `$$` included.
    pub comments: Vec<Span>,
}

/// A word: letters, digits, `_`. Compare with [`Name::is`]; words are case-blind.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Name {
    /// As written.
    pub text: String,
    /// Where.
    pub span: Span,
}

impl Name {
    /// Whether this is `word`, in any case.
    #[must_use]
    pub fn is(&self, word: &str) -> bool {
        self.text.eq_ignore_ascii_case(word)
    }
    /// Upper case, for look-ups.
    #[must_use]
    pub fn upper(&self) -> String {
        self.text.to_ascii_uppercase()
    }
}

/// One logical statement.
#[derive(Debug, Clone, PartialEq)]
pub struct Statement {
    /// From its first to its last mark, continuation included.
    pub span: Span,
    /// `LA1)` in front of it: target of `JUMPTO` and of the arithmetic IF; may be all digits.
    pub jump_label: Option<Name>,
    /// What it is.
    pub kind: StatementKind,
}

/// The shapes of a statement.
#[derive(Debug, Clone, PartialEq)]
pub enum StatementKind {
    /// `[label =] MAJOR[/ args]` — declaration, command or call. Also `X = Y` when the right side is a
    /// lone word with no slash is [`StatementKind::Assign`], not this.
    Command(Command),
    /// `name = expression`, `name(i) = expression`.
    Assign {
        /// The variable.
        target: Target,
        /// The value.
        value: Expr,
    },
    /// `PARTNO text`, `REMARK text`, `PPRINT text`, `INSERT text`, `TITLES text`: literal rest of line.
    Text {
        /// The word.
        word: Name,
        /// The text, without the blanks (or slash) after the word.
        text: String,
        /// Where the text is.
        text_span: Span,
    },
    /// `IF/ cond` (also without slash).
    If(Expr),
    /// `ELSEIF/ cond`.
    ElseIf(Expr),
    /// `ELSE`.
    Else,
    /// `ENDIF`.
    EndIf,
    /// APT's `IF (e) a, b, c`: jumps to a label when e is negative, zero, positive.
    ArithmeticIf {
        /// The selector.
        value: Expr,
        /// The three labels.
        labels: Vec<Name>,
    },
    /// `DO/ i = from, to[, step]`.
    Do {
        /// Loop variable.
        variable: Name,
        /// First value.
        from: Expr,
        /// Last value, inclusive.
        to: Expr,
        /// Step; 1 when absent.
        step: Option<Expr>,
    },
    /// `ENDDO`.
    EndDo,
    /// `WHILE/ cond`.
    While(Expr),
    /// `ENDWHILE`.
    EndWhile,
    /// `UNTIL/ cond`: repeats up to its `ENDUNTIL` as long as the condition is false, tested first.
    Until(Expr),
    /// `ENDUNTIL`.
    EndUntil,
    /// `name = MACRO/ A, B=2` or `name = MACRO`.
    Macro {
        /// The macro's name.
        name: Name,
        /// Parameters with their defaults.
        parameters: Vec<Parameter>,
    },
    /// `TERMAC`.
    TerMac,
    /// `CALL/ name[, arg = value …]`.
    Call {
        /// The macro.
        name: Name,
        /// Arguments; positional ones have no name.
        arguments: Vec<CallArgument>,
    },
    /// `LOOPST`.
    LoopStart,
    /// `LOOPND`.
    LoopEnd,
    /// `JUMPTO/ label`.
    JumpTo(Name),
    /// Could not be parsed; its errors have been reported.
    Bad {
        /// The name it would have declared, if that much could be read: later uses of that name are not
        /// mistakes of their own.
        declares: Option<Name>,
    },
}

/// A macro parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: Name,
    /// Its default, if it has one.
    pub default: Option<Arg>,
}

/// An argument of `CALL`.
#[derive(Debug, Clone, PartialEq)]
pub struct CallArgument {
    /// The parameter named, if any.
    pub name: Option<Name>,
    /// The value: an expression, or any word (APT hands over even `TLLFT`).
    pub value: Arg,
}

/// `[label =] MAJOR[/ args]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Command {
    /// `label =`, possibly subscripted.
    pub label: Option<Target>,
    /// Compound motion `TLRGT, GORGT/ …`: the words before the last.
    pub prefixes: Vec<Name>,
    /// The major word.
    pub word: Name,
    /// The slash, if written.
    pub slash: Option<Span>,
    /// Arguments, in order.
    pub args: Vec<Arg>,
}

/// The left side of `=`.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// The name.
    pub name: Name,
    /// `(i[, j…])`.
    pub subscripts: Vec<Expr>,
}

/// One argument between commas. A lone word is an [`ExprKind::Name`]: `sema` decides by the vocabulary
/// table whether it is a minor word or a variable.
#[derive(Debug, Clone, PartialEq)]
pub struct Arg {
    /// Its span.
    pub span: Span,
    /// What it is.
    pub kind: ArgKind,
}

/// The shapes of an argument.
#[derive(Debug, Clone, PartialEq)]
pub enum ArgKind {
    /// An expression, a word included.
    Expr(Expr),
    /// `name = value` inside an argument list (`PARAM/ D = 25mm`, `CALL/ M, A = 3`).
    Named {
        /// The name.
        name: Name,
        /// The value.
        value: Expr,
    },
    /// A nested definition `(POINT/ 1, 2)`, or with a label `(P1 = POINT/ 1, 2)`, alone between the commas.
    Nested(Box<Command>),
}

/// An expression.
#[derive(Debug, Clone, PartialEq)]
pub struct Expr {
    /// Where.
    pub span: Span,
    /// What.
    pub kind: ExprKind,
}

/// The shapes of an expression.
#[derive(Debug, Clone, PartialEq)]
pub enum ExprKind {
    /// A number as written with its unit suffix, if any: `25.4mm` is (25.4, Some("mm")).
    Number {
        /// Value.
        value: f64,
        /// Unit suffix as written.
        unit: Option<Name>,
    },
    /// A string, quotes removed.
    Text(String),
    /// A word: variable, entity, or minor word.
    Name(Name),
    /// `f(a, b)`: function call or subscript; `sema` tells them apart. A subscript may be `ALL` or a range.
    Apply {
        /// Function or subscripted name.
        name: Name,
        /// Arguments.
        args: Vec<Expr>,
    },
    /// `a.MEMBER`.
    Member {
        /// The entity.
        base: Box<Expr>,
        /// The member.
        member: Name,
    },
    /// `(x, y)` or `(x, y, z)`.
    Tuple(Vec<Expr>),
    /// A nested definition inside an expression: `DIST((POINT/ 1, 2), P1)`. Alone as an argument of a statement
    /// it is [`ArgKind::Nested`].
    Nested(Box<Command>),
    /// `(e)`; kept because APT's precedence warnings and the formatter need it.
    Paren(Box<Expr>),
    /// `-e`, `+e`, `NOT e`.
    Unary {
        /// Operator.
        op: UnaryOp,
        /// Where it stands.
        op_span: Span,
        /// Operand.
        operand: Box<Expr>,
    },
    /// `a op b`.
    Binary {
        /// Operator.
        op: BinaryOp,
        /// Where it stands.
        op_span: Span,
        /// Left operand.
        left: Box<Expr>,
        /// Right operand.
        right: Box<Expr>,
    },
}

/// Prefix operators.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UnaryOp {
    /// `-`
    Minus,
    /// `+`
    Plus,
    /// `NOT`
    Not,
}

/// Infix operators, loosest first: OR, AND, comparison, sum, product, power.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BinaryOp {
    /// `OR`
    Or,
    /// `AND`
    And,
    /// `==`, `.EQ.`
    Equal,
    /// `<>`, `.NE.`
    NotEqual,
    /// `<`
    Less,
    /// `<=`
    LessEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterEqual,
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
    /// `**`
    Power,
}
