//! What the rules of the grammar are called in messages.

use super::grammar::Rule;

/// What may stand at a place, in the user's words; the order is the order in messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Expected {
    /// Something that yields a value.
    Value,
    /// A name.
    Name,
    /// A jump label.
    Label,
    /// The major word that starts a statement.
    Statement,
    /// `,`
    Comma,
    /// `/`, also as the division sign.
    Slash,
    /// `(`
    Open,
    /// `)`
    Close,
    /// `=`
    Equals,
    /// An infix operator.
    Operator,
    /// A structural word.
    Word(&'static str),
    /// The end of the statement.
    End,
}

impl Expected {
    /// In a sentence «expected …».
    pub(super) fn words(self) -> String {
        match self {
            Expected::Value => "a value".to_owned(),
            Expected::Name => "a name".to_owned(),
            Expected::Label => "a label".to_owned(),
            Expected::Statement => "a statement".to_owned(),
            Expected::Comma => "a comma".to_owned(),
            Expected::Slash => "`/`".to_owned(),
            Expected::Open => "`(`".to_owned(),
            Expected::Close => "`)`".to_owned(),
            Expected::Equals => "`=`".to_owned(),
            Expected::Operator => "an operator".to_owned(),
            Expected::Word(word) => format!("`{word}`"),
            Expected::End => "the end of the statement".to_owned(),
        }
    }
}

/// What a rule is for the user; `None` for parts that never show.
pub(super) fn expected(rule: Rule) -> Option<Expected> {
    let expected = match rule {
        Rule::EOI => Expected::End,
        Rule::statement
        | Rule::jump_label
        | Rule::if_arithmetic
        | Rule::if_block
        | Rule::else_if
        | Rule::else_block
        | Rule::end_if
        | Rule::do_loop
        | Rule::end_do
        | Rule::while_loop
        | Rule::end_while
        | Rule::until_loop
        | Rule::end_until
        | Rule::end_macro
        | Rule::call
        | Rule::loop_start
        | Rule::loop_end
        | Rule::jump_to
        | Rule::binding
        | Rule::command => Expected::Statement,
        Rule::label => Expected::Label,
        Rule::selector | Rule::subscripts | Rule::open => Expected::Open,
        Rule::target | Rule::macro_head | Rule::parameter | Rule::name => Expected::Name,
        Rule::definition
        | Rule::arguments
        | Rule::argument
        | Rule::named
        | Rule::expression
        | Rule::negative
        | Rule::positive
        | Rule::not
        | Rule::primary
        | Rule::apply
        | Rule::group
        | Rule::labelled
        | Rule::nested
        | Rule::tuple
        | Rule::number
        | Rule::decimal
        | Rule::string => Expected::Value,
        Rule::comma => Expected::Comma,
        Rule::slash => Expected::Slash,
        Rule::close => Expected::Close,
        Rule::equals => Expected::Equals,
        Rule::plus
        | Rule::minus
        | Rule::times
        | Rule::power
        | Rule::equal
        | Rule::not_equal
        | Rule::less_equal
        | Rule::greater_equal
        | Rule::less
        | Rule::greater
        | Rule::and
        | Rule::or
        | Rule::dot => Expected::Operator,
        Rule::kw_if => Expected::Word("IF"),
        Rule::kw_else_if => Expected::Word("ELSEIF"),
        Rule::kw_else => Expected::Word("ELSE"),
        Rule::kw_end_if => Expected::Word("ENDIF"),
        Rule::kw_do => Expected::Word("DO"),
        Rule::kw_end_do => Expected::Word("ENDDO"),
        Rule::kw_while => Expected::Word("WHILE"),
        Rule::kw_end_while => Expected::Word("ENDWHILE"),
        Rule::kw_until => Expected::Word("UNTIL"),
        Rule::kw_end_until => Expected::Word("ENDUNTIL"),
        Rule::kw_macro => Expected::Word("MACRO"),
        Rule::kw_termac => Expected::Word("TERMAC"),
        Rule::kw_call => Expected::Word("CALL"),
        Rule::kw_loopst => Expected::Word("LOOPST"),
        Rule::kw_loopnd => Expected::Word("LOOPND"),
        Rule::kw_jumpto => Expected::Word("JUMPTO"),
        Rule::WHITESPACE
        | Rule::COMMENT
        | Rule::body
        | Rule::prefix
        | Rule::infix
        | Rule::atom
        | Rule::dotted
        | Rule::word_char
        | Rule::exponent
        | Rule::unit
        | Rule::compound_unit
        | Rule::quoted_single
        | Rule::quoted_double
        | Rule::keyword
        | Rule::compat_two_words
        | Rule::compat_word
        | Rule::compat_no_slash
        | Rule::compat_major
        | Rule::compat_operand => return None,
    };
    Some(expected)
}

/// `a comma, `)` or the end of the statement`.
pub(super) fn list(items: &[Expected]) -> String {
    let words: Vec<String> = items.iter().map(|e| e.words()).collect();
    match words.split_last() {
        None => "something else".to_owned(),
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} or {last}", rest.join(", ")),
    }
}
