//! `partwright post show`.

use super::super::args::post::PostShowArgs;
use super::super::messages::Messages;
use super::super::{Status, print};
use super::confidence;
use crate::diag::Diagnostic;
use crate::post::{self, Dialect};
use crate::source::SourceMap;

/// Prints a post: what its own file says, or all of it.
pub fn show(args: &PostShowArgs, messages: Messages) -> Result<Status, Diagnostic> {
    let overrides = args.overrides.pairs()?;
    let (dialect, sources) = match super::load(&args.post, &overrides, messages) {
        Ok(loaded) => loaded,
        Err(status) => return Ok(status),
    };
    let body = if args.resolved {
        dialect.resolved_text(&sources)
    } else {
        format!("\n{}", own_text(&args.post, &sources))
    };
    print(&(head(&dialect) + &body))
}

/// Who the post is, as comments.
fn head(dialect: &Dialect) -> String {
    format!(
        "# {}: {}\n# inherits: {}\n# how sure: {} ({})\n# read back as: {}\n\
         # repeats: written out, without subprograms\n",
        dialect.name(),
        dialect.title(),
        dialect.lineage().join(" > "),
        confidence(dialect.confidence()),
        dialect.basis(),
        dialect.control(),
    )
}

/// The text of the post file itself.
fn own_text(name: &str, sources: &SourceMap) -> String {
    post::builtin_text(name)
        .map(str::to_owned)
        .or_else(|| sources.iter().next().map(|(_, file)| file.text.to_string()))
        .unwrap_or_default()
}
