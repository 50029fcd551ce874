//! Comments: nothing of a user's text gets out.

use super::super::judge::Finding;
use super::super::sheet::Sheet;
use super::super::trial::Trial;
use super::{Try, row};
use crate::cl::RecordKind;

pub(in super::super) const LONG: Try = row(
    "comments",
    "comment of 300 characters",
    || comment(&"a long remark that goes on and on, ".repeat(9)),
    harmless,
);
pub(in super::super) const BRACKETS: Try = row(
    "comments",
    "comment with brackets, %, ; and line ends",
    || comment("a) G0 X99 (b % c ; d\nG0 X98\r\nM30 \0 e"),
    harmless,
);
pub(in super::super) const ACTIVE: Try =
    row("comments", "comment that a control would obey", || comment("MSG, DEBUG, PRINT, LOG"), harmless);
pub(in super::super) const FOREIGN: Try =
    row("comments", "comment with letters outside ASCII", || comment("Nocken für Öl, 凸轮, 10°"), harmless);
pub(in super::super) const TITLE: Try = Try {
    whole: true,
    ..row(
        "comments",
        "title with brackets, %, and line ends",
        || Sheet::mm().title("a) (b % c\nM30").watch(),
        title,
    )
};

fn comment(text: &str) -> Sheet {
    Sheet::mm().add(RecordKind::Comment(text.to_owned())).line(1.0, 0.0, 5.0)
}

/// The machine makes the one move that follows, and nothing else.
fn harmless(trial: &Trial) -> Finding {
    let (events, moves) = (trial.events().count(), trial.cuts().count());
    if events == 1 && moves == 1 {
        Finding::right("the machine makes the next move and nothing else")
    } else {
        Finding::wrong(format!("the machine does {events} things, {moves} of them cuts, instead of one cut"))
    }
}

fn title(trial: &Trial) -> Finding {
    match trial.trace.faults.first() {
        None => Finding::right("the machine reads the program without complaint"),
        Some(fault) => Finding::wrong(format!("line {}: {}", fault.line, fault.message)),
    }
}
