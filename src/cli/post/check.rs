//! `partwright post check`.

use super::super::args::post::PostCheckArgs;
use super::super::messages::{self, Messages, to_stderr};
use super::super::{Status, build};
use crate::diag::{Diagnostic, Severity};
use crate::{post, selftest};

/// Checks posts one after the other; the worst decides how the run ends.
pub fn check(args: &PostCheckArgs, messages: Messages) -> Result<Status, Diagnostic> {
    messages::check_deny(&args.deny)?;
    let overrides = args.overrides.pairs()?;
    let mut status = Status::Done;
    for name in &args.posts {
        let one = match super::load(name, &overrides, messages) {
            Ok((dialect, mut sources)) => {
                let mut findings = post::lint(&dialect, &mut sources);
                // A post that says what it does not mean is tried out only when it says something.
                if findings.iter().all(|f| f.severity != Severity::Error) {
                    findings.extend(selftest::findings(&dialect, name));
                }
                messages::deny(&mut findings, &args.deny);
                messages.show(&findings, &sources);
                if findings.is_empty() && messages.for_people() {
                    to_stderr(&format!("{name}: nothing to complain about\n"));
                }
                let wrong = findings.iter().any(|f| f.severity == Severity::Error);
                if wrong { Status::Errors } else { Status::Done }
            }
            Err(status) => status,
        };
        status = build::worse(status, one);
    }
    Ok(status)
}
