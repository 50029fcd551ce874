//! Target program to text: dialect files and one fast table-driven writer.
//!
//! # Contract
//! - A dialect is data: a `*.post.toml` file that inherits from others ([`schema`] is the table of its keys,
//!   [`load`] resolves it). User files and built-in ones go the same way.
//! - The writer prints the integers of the target program and nothing else: no number is computed here, and all
//!   of them are printed by [`crate::target::number`].
//! - Motion runs on flat tables ([`pattern`]); start, end, tool change and operations go through templates
//!   ([`template`]), motion never does.
//! - User text leaves through [`comment`] and cannot get out of its comment; `INSERT` is verbatim, one line.

mod check;
mod check_curves;
pub mod comment;
mod compensation;
mod context;
mod curves;
mod cycles;
pub mod dialect;
mod events;
#[cfg(test)]
pub(crate) mod examples;
mod inspect;
mod json_schema;
mod lint;
mod load;
mod motion;
mod options;
pub mod pattern;
pub mod schema;
mod spec;
mod table;
pub mod template;
#[cfg(test)]
mod tests;
pub mod tree;
pub mod variables;
mod write;
mod writer;

mod capabilities;

pub use dialect::Dialect;
pub use inspect::{Place, Setting};
pub use json_schema::json_schema;
pub use lint::lint;
pub use load::{builtin_names, builtin_text, load, load_with};
pub(crate) use load::{is_override, override_key};
pub use write::{Parts, Written, write};
