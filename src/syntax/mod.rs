//! Source text to [`ast`]: statement splitter, pest grammar, Pratt parser.

pub mod ast;
