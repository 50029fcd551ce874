//! The pest parser made from `grammar/partwright.pest`.

#![allow(missing_docs)]

use pest_derive::Parser;

/// The generated parser.
#[derive(Parser)]
#[grammar = "../grammar/partwright.pest"]
pub struct Grammar;
