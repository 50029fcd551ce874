//! `partwright post selftest`.

use super::super::args::post::{PostSelftestArgs, TextOrJson};
use super::super::messages::Messages;
use super::super::{Status, print};
use crate::diag::Diagnostic;
use crate::selftest;
use crate::units::LengthUnit;

/// Tries a post on every row and prints the matrix.
pub fn selftest(args: &PostSelftestArgs, messages: Messages) -> Result<Status, Diagnostic> {
    let overrides = args.overrides.pairs()?;
    let (dialect, _) = match super::load(&args.post, &overrides, messages) {
        Ok(loaded) => loaded,
        Err(status) => return Ok(status),
    };
    let units = if args.inch { LengthUnit::Inch } else { LengthUnit::Millimetre };
    let matrix = selftest::run(&dialect, units);
    print(&match args.format {
        TextOrJson::Json => serde_json::to_string_pretty(&matrix).unwrap_or_default() + "\n",
        TextOrJson::Text => selftest::print::text(&matrix),
    })?;
    Ok(if matrix.passed() { Status::Done } else { Status::NotProven })
}
