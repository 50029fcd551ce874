//! `partwright post`.

use std::path::Path;

use super::Status;
use super::args::post::PostVerb;
use super::disk::Disk;
use super::messages::Messages;
use crate::diag::Diagnostic;
use crate::post::{self, Dialect};
use crate::source::SourceMap;

mod check;
mod list;
mod new;
mod selftest;
mod show;
mod trace;

/// Dispatches.
pub fn post(verb: &PostVerb, messages: Messages) -> Result<Status, Diagnostic> {
    match verb {
        PostVerb::List(args) => list::list(args),
        PostVerb::Show(args) => show::show(args, messages),
        PostVerb::Check(args) => check::check(args, messages),
        PostVerb::New(args) => new::new(args, messages),
        PostVerb::Selftest(args) => selftest::selftest(args, messages),
        PostVerb::Trace(args) => trace::trace(args, messages),
    }
}

/// Loads a post; errors are shown, and `Err` is how the run ends.
fn load(
    name: &str,
    overrides: &[(String, String)],
    messages: Messages,
) -> Result<(Dialect, SourceMap), Status> {
    let mut sources = SourceMap::default();
    let disk = Disk::for_main(Path::new(name));
    match post::load_with(name, overrides, &disk, &mut sources) {
        Ok(dialect) => Ok((dialect, sources)),
        Err(errors) => {
            messages.show(&errors, &sources);
            Err(super::build::status_of(&errors))
        }
    }
}

/// How sure a post is, in words.
fn confidence(word: &str) -> &'static str {
    match word {
        "interpreter" => "checked by the control's own interpreter or its source",
        "manual" => "from the manual",
        _ => "from published posts, not checked on a control",
    }
}
