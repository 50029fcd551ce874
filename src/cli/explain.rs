//! `partwright explain`.

use super::messages::unknown_code;
use crate::diag::{Diagnostic, codes};

/// The page of a code, or the list of all codes.
pub fn explain(code: Option<&str>) -> Result<String, Diagnostic> {
    match code {
        None => Ok(codes::all().map(|c| format!("{}  {}\n", c.id, c.title)).collect()),
        Some(id) => match codes::find(id.trim()) {
            Some(code) => Ok(code.page.to_owned()),
            None => Err(unknown_code(id)),
        },
    }
}
