//! CL files: cutter location data that CAM systems write, as text.
//!
//! # Contract
//! - [`Reader`] takes the text record by record and gives CL data in chunks ([`Reader::chunk`]), so that the length
//!   of a file is no bound on memory. The chunks of one file share tools and operations; records and their origins
//!   are each chunk's own.
//! - The bulk of a file is `GOTO` records; [`scan`] reads them byte by byte and is tested against the grammar
//!   (`grammar/cl.pest`), which reads everything else. [`lines`] joins continuation lines before.
//! - Nothing is dropped in silence: a record that is not known is an error with its line, a post word that changes what
//!   the machine does and cannot be carried out is one, too; [`Options::lenient`] makes warnings of both.
//! - Arcs are trusted as far as their points lie on them ([`circle`]).

use crate::diag::did_you_mean;

mod catia;
mod circle;
mod cycle;
mod frame;
mod grammar;
pub mod lines;
mod motion;
mod nci;
mod nci_drill;
mod nurbs;
mod process;
mod producer;
mod reader;
pub mod scan;
mod state;
#[cfg(test)]
mod tests;
mod told;
mod tool;
mod unit;
mod words;

pub use producer::Producer;
pub use reader::Reader;
pub(crate) use told::told_once;

/// How a CL file is to be read.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// The system that wrote it; found out when not given.
    pub producer: Option<Producer>,
    /// Makes warnings of unknown records and of words that cannot be carried out.
    pub lenient: bool,
    /// Post words that the file lacks (`SPINDL`, `FEDRAT`, `UNITS`), as given with `-D NAME=VALUE`.
    pub defines: Vec<(String, String)>,
    /// What stands behind column 72 of a line is no part of the record (`--card-columns`).
    pub card_columns: bool,
}

/// The producer called so, or what is wrong with the name.
///
/// # Errors
/// A sentence that lists the names.
pub fn producer_named(name: &str) -> Result<Producer, String> {
    Producer::ALL.into_iter().find(|p| p.name().eq_ignore_ascii_case(name)).ok_or_else(|| {
        let names = Producer::ALL.map(Producer::name);
        let near = did_you_mean(name, names).map_or_else(String::new, |n| format!("; did you mean `{n}`?"));
        format!("no producer `{name}` is known; there are {}{near}", names.join(", "))
    })
}

/// The producer of a file that is a CL file: by its name's extension, or by what stands in it.
#[must_use]
pub fn recognise(name: &str, text: &str) -> Option<Producer> {
    producer::recognise(name, text)
}
